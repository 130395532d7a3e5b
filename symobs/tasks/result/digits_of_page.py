"""Number format of a page: exact, or with a number of significant digits."""

from __future__ import annotations

from typing import Any, TypedDict

from symobs.formula.convention import convention_named
from symobs.formula.expression.source import shown
from symobs.ground.errors import UsageError
from symobs.system.reading import has_decimals

#: The significant digits of a page whose data are typed as decimals, and the most that can be asked for.
DIGITS, MOST_DIGITS = 5, 40


class PageOptions(TypedDict, total=False):
    """Options of `result.to`: significant digits, or exact numbers."""

    convention: str
    detail: str
    language: str
    digits: int | None
    exact: bool


def document_options(
    *,
    convention: str = "standard",
    detail: str = "full",
    language: str = "en",
    digits: int | None = None,
    exact: bool = False,
    **unknown: object,
) -> dict[str, Any]:
    """Return the options of a page as those of a document.

    Raises `UsageError` for a convention that does not exist, and for an option that no page has.
    """
    if unknown:
        repair = f"known options are {', '.join(PageOptions.__annotations__)}"
        raise UsageError("no page has this option", where=shown(next(iter(unknown)), 40), repair=repair)
    asked = digits_asked(digits, exact=exact)
    return {"convention": convention_named(convention), "detail": detail, "language": language, "digits": asked}


def digits_asked(digits: object = None, *, exact: bool = False, where: str = "digits") -> int | None:
    """Return the digits of a document: 0 for exact numbers, None by default.

    Raises `UsageError` for what is no number of digits, and where exact numbers are asked for as well.
    """
    if digits is None:
        return 0 if exact else None
    if exact:
        message = "digits and exact numbers are both asked for"
        raise UsageError(message, where=where, repair="keep one of them")
    if isinstance(digits, bool) or not isinstance(digits, int) or not 1 <= digits <= MOST_DIGITS:
        message = f"{shown(str(digits), 40)!r} is not a number of significant digits"
        raise UsageError(message, where=where, repair=f"write a whole number from 1 to {MOST_DIGITS}, for example 5")
    return digits


def shown_digits(document: Any) -> int:
    """Return the significant digits of the numbers of a document, 0 where they are exact."""
    if document.digits is not None:
        return int(document.digits)
    typed = any(
        result.plant.is_in_decimals or has_decimals([*result.specification.values()]) for result in document.results
    )
    return DIGITS if typed else 0
