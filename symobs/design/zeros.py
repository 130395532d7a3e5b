"""Gains with zeros in given places: the coefficients of det(sI − A + LC) − φ in the other entries, solved exactly.

An unknown that occurs linearly is eliminated, an equation in one unknown is solved by its rational roots, and where
neither helps an unknown is given small values in turn.  That no gain exists is shown by the equations themselves: 1
lies in their ideal.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from symobs.exact import Ideal, Matrix, Scalar, TooLarge

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from symobs.design.assignment import Pair
    from symobs.specification import DesiredPolynomial

#: The values that a free unknown is given in turn, and the equations that may be looked at in all.
VALUES = (0, 1, -1, 2, -2, 3, -3, 5, -5, 10)
LOOKS = 4_000
#: What the unknown entries are called; no parameter's name begins so.
_UNKNOWN = "_l"


def unknown_gain(order: int, outputs: int, zero: Sequence[tuple[int, int]]) -> Matrix:
    """Return the gain with zeros in these places and unknowns elsewhere."""
    empty = set(zero)
    return Matrix.of(
        [
            [Scalar.of(0) if (i, j) in empty else Scalar.symbol(f"{_UNKNOWN}{i}_{j}") for j in range(outputs)]
            for i in range(order)
        ],
        outputs,
    )


def equations_for(pair: Pair, desired: DesiredPolynomial, gain: Matrix) -> tuple[Scalar, ...]:
    """Return what must vanish: the coefficients of det(sI − A + LC) less those of φ."""
    found = (pair.A - gain @ pair.c).normal().characteristic_polynomial(pair.variable)
    coefficients = found.coefficients(pair.variable)[1:]
    return tuple(own - wish for own, wish in zip(coefficients, desired.coefficients, strict=True))


def contradict(equations: Sequence[Scalar]) -> bool:
    """Whether 1 lies in the ideal of the equations, so that they have no common solution; False where it is not found."""
    try:
        return Ideal.of(equations).is_whole
    except TooLarge:
        return False


def with_zeros(pair: Pair, desired: DesiredPolynomial, zero: Sequence[tuple[int, int]]) -> Matrix | None:
    """Return a gain with zeros in these places, None where none was found."""
    general = unknown_gain(pair.A.shape[0], pair.c.shape[0], zero)
    equations = equations_for(pair, desired, general)
    if contradict(equations):
        return None
    unknowns = [name for name in general.field.names if name in general.names]
    solution = Search(frozenset(unknowns)).solve(equations)
    if solution is None:
        return None
    rest = dict.fromkeys(unknowns, Scalar.of(0))
    return general.substitute({**rest, **solution}).normal()


class Search:
    """A search for a rational solution of polynomial equations."""

    def __init__(self, unknowns: frozenset[str]) -> None:
        """Count what is looked at."""
        self.unknowns = unknowns
        self.left = LOOKS

    def solve(self, equations: Sequence[Scalar]) -> dict[str, Scalar] | None:
        """Return values of the unknowns, those left out being free; None where none were found."""
        open_ = sorted({e.numerator for e in equations if not e.is_zero}, key=lambda e: (e.size, str(e)))
        self.left -= len(open_)
        if not open_:
            return {}
        if self.left < 0 or any(not (e.names & self.unknowns) for e in open_):
            return None
        for equation in open_:
            linear = self._linear(equation)
            if linear is not None:
                return self._put(open_, dict([linear]))
        for equation in open_:
            names = equation.names & self.unknowns
            if len(names) == 1:
                return self._by_roots(open_, equation, next(iter(names)))
        name = min(open_[0].names & self.unknowns, key=lambda n: (-sum(n in e.names for e in open_), n))
        for value in VALUES:
            found = self._put(open_, {name: Scalar.of(value)})
            if found is not None:
                return found
        return None

    def _linear(self, equation: Scalar) -> tuple[str, Scalar] | None:
        """Return (unknown, value) where an unknown occurs linearly with a factor free of unknowns."""
        for name in sorted(equation.names & self.unknowns):
            if equation.degree(name) != 1:
                continue
            lead, constant = equation.coefficients(name)
            if not (lead.names & self.unknowns):
                return name, -constant / lead
        return None

    def _by_roots(self, equations: Sequence[Scalar], equation: Scalar, name: str) -> dict[str, Scalar] | None:
        """Try the rational roots of an equation in one unknown."""
        for factor, _ in equation.factors()[1]:
            if factor.degree(name) == 1:
                lead, constant = factor.coefficients(name)
                found = self._put(equations, {name: -constant / lead})
                if found is not None:
                    return found
        return None

    def _put(self, equations: Sequence[Scalar], values: Mapping[str, Scalar]) -> dict[str, Scalar] | None:
        """Put values in and solve what is left; values may contain unknowns that are found then."""
        try:
            rest = self.solve([equation.substitute(values) for equation in equations])
        except ZeroDivisionError:
            return None
        if rest is None:
            return None
        free = {name: rest.get(name, Scalar.of(0)) for value in values.values() for name in value.names & self.unknowns}
        return {**rest, **free, **{name: value.substitute(free) for name, value in values.items()}}
