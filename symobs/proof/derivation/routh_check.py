"""Findings of Routh's table, and the check of a step with such a table (trusted)."""

from __future__ import annotations

from typing import TYPE_CHECKING

from symobs.exact import Ideal, Scalar, remainder
from symobs.exact import from_coefficients as polynomial_from
from symobs.formula.phrases.languages import Counted
from symobs.formula.tree import Literal, Relation
from symobs.proof.derivation.steps import Sentence
from symobs.stability.criteria.routh_table import (
    imaginary_axis_roots,
    is_routh_table,
    right_half_plane_roots,
    sign_changes,
)
from symobs.stability.criteria.stability import hurwitz_matrix
from symobs.system.conditions import sign_of

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence

    from symobs.formula.tree import Environment
    from symobs.proof.derivation.steps import Tabulate
    from symobs.stability.criteria.routh_table import RouthTable

#: Of polynomials with more parameters the determinant that decides with the last coefficient is not written.
MOST_PARAMETERS = 2


def is_tabulated(step: Tabulate, value: Scalar, environment: Environment) -> bool:
    """Return whether a step shows the table of a polynomial with this value, and its findings are those of the table."""
    variable, table = step.variable, step.table
    taken = {*environment.signs, *environment.coefficients}
    if variable in taken or table.epsilon in taken or table.epsilon == variable:
        return False
    if value.degree(variable) < 1 or not value.is_polynomial_in(variable):
        return False
    coefficients = value.coefficients(variable)
    if not is_routh_table(table, coefficients) or _divides_by_zero(table, environment):
        return False
    return set(step.findings) <= set(findings_of(table, coefficients, variable, environment.signs))


def _divides_by_zero(table: RouthTable, environment: Environment) -> bool:
    """Return whether an entry of the first column vanishes by the relations."""
    known = Ideal.where(environment.relations)
    return any(entry.numerator in known for entry in table.first_column)


def findings_of(
    table: RouthTable, coefficients: Sequence[Scalar], variable: str, signs: Mapping[str, str]
) -> tuple[Sentence, ...]:
    """Return the findings of Routh's table: replaced zeros, and the location of the roots.

    Numbers of roots are stated where a count that knows nothing of the table finds the same.
    """
    found = list(_replaced(table, coefficients, variable))
    if all(c.is_constant for c in coefficients):
        return (*found, _counted(table, coefficients))
    return (*found, *_with_parameters(table, signs))


def _replaced(table: RouthTable, coefficients: Sequence[Scalar], variable: str) -> Iterator[Sentence]:
    if table.epsilon:
        yield Sentence("routh_epsilon", (("epsilon", _positive(table.epsilon)),))
    zero_rows = [row for row in table.rows if row.origin == "auxiliary"]
    if zero_rows:
        yield Sentence("routh_zero_row")
        auxiliary = table.auxiliary(zero_rows[0], variable)
        if remainder(polynomial_from(coefficients, variable), auxiliary, variable)[1].is_zero:
            yield Sentence("routh_divides", (("auxiliary", Literal(auxiliary)),))


def _positive(epsilon: str) -> Relation:
    return Relation((Literal(Scalar.symbol(epsilon)), Literal(Scalar.of(0))), (">",))


def _counted(table: RouthTable, coefficients: Sequence[Scalar]) -> Sentence:
    """Return where the roots of a polynomial without parameters lie."""
    changes, right, axis = sign_changes(table), right_half_plane_roots(coefficients), imaginary_axis_roots(coefficients)
    slots = {
        "changes": Counted("sign_changes", changes),
        "right": Counted("root_lies", right),
        "axis": Counted("root_lies", axis),
    }
    if changes != right:
        small = ("epsilon", Literal(Scalar.symbol(table.epsilon)))
        return Sentence("routh_misleads", (small, ("right", slots["right"]), ("axis", slots["axis"])))
    if axis:
        return Sentence("routh_changes_axis", tuple(slots.items()))
    if changes == 0:  # no root on the right, none on the axis
        return Sentence("routh_positive" if coefficients[0].fraction() > 0 else "routh_negative")
    return Sentence("routh_changes", tuple((name, slots[name]) for name in ("changes", "right")))


def _with_parameters(table: RouthTable, signs: Mapping[str, str]) -> Iterator[Sentence]:
    """Yield the conditions of the table for all roots in the left half-plane."""
    leading, *_ = column = table.first_column
    sign = sign_of(leading, signs)
    is_certain = sign in {"positive", "negative"}
    if not table.is_regular:
        if is_certain or sign == "nonzero":
            yield Sentence("routh_not_stable")
    elif is_certain and all(sign_of(entry, signs) == sign for entry in column):
        yield Sentence(f"routh_{sign}")
    elif is_certain:
        yield Sentence(f"routh_criterion_{sign}")
    else:
        nonzero = Relation((Literal(leading), Literal(Scalar.of(0))), ("!=",))
        yield Sentence("routh_criterion_where", (("leading", nonzero),))


def last_determinant(polynomial: Scalar, variable: str) -> dict[str, Scalar]:
    """Return the value of Δₙ₋₁ for the table of a polynomial with one or two parameters: Hurwitz' determinant."""
    order, parameters = polynomial.degree(variable), polynomial.names - {variable}
    if order < 2 or not 1 <= len(parameters) <= MOST_PARAMETERS:
        return {}
    rows = range(order - 1)
    return {f"Delta_{order - 1}": hurwitz_matrix(polynomial.coefficients(variable)).select(rows, rows).determinant()}
