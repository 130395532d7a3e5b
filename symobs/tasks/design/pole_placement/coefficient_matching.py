"""Matching coefficients: det(sI − A + l c) is affine in the entries of l, so l solves a linear system."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from symobs.exact import Matrix

if TYPE_CHECKING:
    from symobs.system.specification import DesiredPolynomial
    from symobs.tasks.design.pole_placement.single_output import ObserverPair


class Matching(NamedTuple):
    """The system M l = r: row k compares the coefficients of sⁿ⁻ᵏ."""

    M: Matrix
    r: Matrix

    @property
    def solution(self) -> Matrix:
        """Return l; raises ZeroDivisionError where the pair is not observable."""
        return self.M.solve(self.r).normal()


def matching(pair: ObserverPair, desired: DesiredPolynomial) -> Matching:
    """Return the system; column i is the change of the polynomial of A by a one in row i of l."""
    order, variable = pair.A.shape[0], pair.variable
    own = pair.A.characteristic_polynomial(variable).coefficients(variable)[1:]
    columns = []
    for i in range(order):
        moved = (pair.A - Matrix.unit(order, i) @ pair.c).characteristic_polynomial(variable)
        found = moved.coefficients(variable)[1:]
        columns.append([new - old for new, old in zip(found, own, strict=True)])
    M = Matrix.of([list(row) for row in zip(*columns, strict=True)])
    r = Matrix.column([coefficient - old for coefficient, old in zip(desired.coefficients, own, strict=True)])
    return Matching(M, r)


def matched_gain(pair: ObserverPair, desired: DesiredPolynomial) -> Matrix:
    """Return l."""
    return matching(pair, desired).solution
