"""Every error symobs raises.

One base, `SymobsError`.  An error is made from facts, which stay attributes: what is wrong (`message`), the
place (`where`), and what to write instead (`repair`).  Each class also derives from the built-in a caller would expect.

A mathematical "no" (not observable, poles not assignable) is never an exception: it is a result with a verdict.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence


_REPORT = "please report this: it is a bug of symobs"


class SymobsError(Exception):
    """Base of all errors; `exit_code` is what the command line returns for it."""

    exit_code = 3
    #: What helps where nothing else is said.
    usual_repair = ""

    def __init__(self, message: str, *, where: str = "", repair: str = "", **facts: object) -> None:
        """Keep the facts: the message, the place, and the repair."""
        super().__init__(message)
        self.message = message
        self.where = where
        self.repair = repair or self.usual_repair
        self.facts = facts

    def __str__(self) -> str:
        """Return `where: message; repair` on one line, without unknown parts and with control characters escaped."""
        place = f"{self.where}: " if self.where else ""
        repair = f"; {self.repair}" if self.repair else ""
        return _printable(f"{place}{self.message}{repair}")

    def __reduce__(self) -> tuple[object, ...]:
        """Pickle by facts, so that an error crosses process borders whole."""
        return (_rebuild, (type(self), self.message, self.where, self.repair, self.facts))


def _printable(text: str) -> str:
    """Return a text with nonprinting characters, except line ends, escaped."""
    return "".join(c if c.isprintable() or c == "\n" else c.encode("unicode_escape").decode("ascii") for c in text)


def _rebuild(kind: type[SymobsError], message: str, where: str, repair: str, facts: dict[str, object]) -> SymobsError:
    return kind(message, where=where, repair=repair, **facts)


class InputError(SymobsError, ValueError):
    """Input that cannot be used."""


class ExpressionError(InputError):
    """A text does not follow the grammar of expressions."""


class UnknownName(ExpressionError):
    """A text uses a name that is not declared."""


class BudgetExceeded(ExpressionError):
    """A text, or its value, exceeds the limits of size."""


class OpenEquality(BudgetExceeded):
    """Whether two values are equal is not decided: neither is said."""

    exit_code = 5


class InexactInput(InputError, TypeError):
    """A floating-point number in place of an exact one."""


class ShapeMismatch(InputError):
    """Matrices whose sizes do not fit together, or rows of different lengths."""


class ProblemErrors(InputError):
    """All errors of one problem file together."""

    def __init__(self, errors: tuple[SymobsError, ...], *, where: str = "") -> None:
        """Keep every error of the file, in its order."""
        self.errors: tuple[SymobsError, ...] = tuple(
            each for error in errors for each in (error.errors if isinstance(error, ProblemErrors) else (error,))
        )
        super().__init__(f"{len(self.errors)} error{'s' if len(self.errors) != 1 else ''}", where=where)

    def __str__(self) -> str:
        """Return one line an error."""
        return "\n".join(str(error) for error in self.errors)

    def __reduce__(self) -> tuple[object, ...]:
        """Pickle by the errors it holds."""
        return (type(self), (self.errors,))


def together(*actions: Callable[[], Any]) -> tuple[Any, ...]:
    """Return the values of all actions; errors of several are raised together."""
    values: list[Any] = []
    errors: list[SymobsError] = []
    for action in actions:
        try:
            values.append(action())
        except ProblemErrors as several:
            errors += several.errors
        except InputError as error:
            errors.append(error)
    raise_all(errors)
    return tuple(values)


def raise_all(errors: Sequence[SymobsError]) -> None:
    """Raise one error, or several as `ProblemErrors`; nothing where there is none."""
    if errors:
        raise errors[0] if len(errors) == 1 else ProblemErrors(tuple(errors))


class UsageError(SymobsError):
    """Unknown usage of the command line."""

    exit_code = 2


class OutOfBudget(SymobsError):
    """The allowed time or memory is exhausted; `facts["left"]` is the partial outcome, or None."""

    exit_code = 5


class TypesettingError(SymobsError):
    """TeX is missing, failed, or ran out of time."""

    exit_code = 6


class CertificateRejected(SymobsError):
    """A result does not meet its own claim: a bug of symobs, never of the input, unless it is `Undecided`."""

    exit_code = 1
    usual_repair = _REPORT


class Undecided(CertificateRejected):
    """A result is beyond the limits of what can be computed or checked; the message is the reason."""

    exit_code = 5
    usual_repair = ""


class DerivationRejected(SymobsError):
    """A line of a derivation is false: always a bug of symobs, never of the input."""

    exit_code = 1
    usual_repair = _REPORT


class WrongKind(TypeError, ValueError):
    """A formula without a value: an operand is of another kind, such as a matrix in place of a number."""


class NotShown(ArithmeticError):
    """The truth of a formula at every point is undecided within the limits."""


class SymobsWarning(UserWarning):
    """A line or a figure is left out of a page because its check failed."""


def reason_of(error: Exception) -> str:
    """Return in words of a user why a file cannot be read or written."""
    if isinstance(error, UnicodeDecodeError):
        return f"byte {error.start} is not UTF-8"
    return getattr(error, "strerror", None) or " ".join(str(error).split())
