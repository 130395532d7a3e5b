"""Equivalence of conjunctions of relations."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from symobs.exact.algebraic.rounded_decimals import decimals_in
from symobs.problem.expect.structure import relation, relations_agree

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from symobs.exact import Scalar


def conditions_agree(
    found: Iterable[Any], expected: Iterable[Any], names: Any, where: str, signs: Mapping[str, str]
) -> bool:
    """Return whether two conjunctions of relations are proved equivalent."""
    ours = {relation(str(entry), names, where) for entry in found}
    theirs = {relation(entry, names, where) for entry in expected}
    if any(decimals_in(value) for value, _ in theirs):
        pairs = [(mine, other) for other in theirs for mine in ours if relations_agree(other, mine)]
        return {mine for mine, _ in pairs} == ours and {other for _, other in pairs} == theirs
    return ours == theirs or (_implies(ours, theirs, signs) and _implies(theirs, ours, signs))


def _implies(
    given: Iterable[tuple[Scalar, str]], wanted: Iterable[tuple[Scalar, str]], signs: Mapping[str, str]
) -> bool:
    """Return whether relations follow from others; new ones must be strict, and follow from the strict ones."""
    from symobs.stability.inequalities.simplify import prove_value  # noqa: PLC0415 - only where two lists are not the same

    given = set(given)
    known = [value if operator == ">" else value**2 for value, operator in given if operator in {">", "!="}]
    return all(
        operator in {">", "!="} and prove_value(value if operator == ">" else value**2, known, signs) is not None
        for value, operator in set(wanted) - given
    )
