"""Gains with zeros in given places: the coefficients of det(sI − A + LC) − φ in the other entries, solved exactly.

An unknown that occurs linearly is eliminated, an equation in one unknown is solved by its rational roots, and where
neither helps an unknown is given small values in turn.  That no gain exists is shown by the equations themselves: 1
lies in their ideal.
"""

from __future__ import annotations

from contextlib import suppress
from fractions import Fraction
from math import floor
from typing import TYPE_CHECKING

from symobs.exact import EIGENVALUE, AlgebraicExtension, Ideal, Matrix, Scalar, TooLarge, modulo
from symobs.exact.core.generators import identities
from symobs.ground.dataclass import dataclass
from symobs.tasks.design.pole_placement.multiple_outputs import chain_gains

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from symobs.exact.algebraic.real_algebraic import RealNumber
    from symobs.system.specification import DesiredPolynomial
    from symobs.tasks.design.pole_placement.single_output import ObserverPair

#: The values that a free unknown is given in turn, and the terms of equations that may be looked at in all.
VALUES = (0, 1, -1, 2, -2, 3, -3, 5, -5, 10)
TERMS_LOOKED_AT = 6_000
#: The degrees of the roots that a solution may contain, one after the other.
DEGREES = (1, 2, 12)
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


def equations_for(pair: ObserverPair, desired: DesiredPolynomial, gain: Matrix) -> tuple[Scalar, ...]:
    """Return what must vanish: the coefficients of det(sI − A + LC) less those of φ."""
    found = (pair.A - gain @ pair.c).normal().characteristic_polynomial(pair.variable)
    coefficients = found.coefficients(pair.variable)[1:]
    return tuple(
        own - desired_coefficient for own, desired_coefficient in zip(coefficients, desired.coefficients, strict=True)
    )


def obstacles(equations: Sequence[Scalar]) -> tuple[Scalar, ...] | None:
    """Return polynomials in the parameters alone that vanish wherever the equations have a solution; (1,) for nowhere.

    They are what eliminating all unknowns leaves; None where that is too much work, and nothing is known.
    """
    from symobs.exact.ideals import triangular  # noqa: PLC0415 - only patterns that are hard to meet pay for it

    unknowns = _unknowns_in(equations)
    with suppress(TooLarge):
        if Ideal.of(equations).is_whole:
            return (Scalar.of(1),)
    try:
        found = triangular(equations, unknowns)
    except TooLarge:
        return None
    return tuple(value for value in found if not value.names.intersection(unknowns))


@dataclass
class RootGain:
    """A gain whose entries are polynomials in λ, a real root of an irreducible polynomial in λ."""

    gain: Matrix
    polynomial: Scalar
    root: RealNumber

    @property
    def bounds(self) -> tuple[Scalar, Scalar]:
        """Short decimals on either side of the root, between which the polynomial changes its sign once."""
        from symobs.exact.algebraic.real_algebraic import roots_of_scalar  # noqa: PLC0415 - only irrational gains pay for it

        digits, (name,) = 1, self.polynomial.names
        while True:
            unit, (low, high) = 10**digits, self.root.interval()
            ends = Fraction(floor(low * unit), unit), Fraction(floor(high * unit) + 1, unit)
            if sum(ends[0] < other.interval()[0] < ends[1] for other in roots_of_scalar(self.polynomial, name)) == 1:
                return Scalar.of(ends[0]), Scalar.of(ends[1])
            digits += 1


def with_zeros(
    pair: ObserverPair, desired: DesiredPolynomial, zero: Sequence[tuple[int, int]]
) -> Matrix | RootGain | None:
    """Return a gain with zeros in these places, None where none was found.

    Its entries are rational where such a gain is found, otherwise they contain a square root, or a root of higher degree.
    """
    general = unknown_gain(pair.A.shape[0], pair.c.shape[0], zero)
    equations = equations_for(pair, desired, general)
    with suppress(TooLarge):
        if Ideal.of(equations).is_whole:
            return None
    for gain in chain_gains(pair, desired) if pair.is_observable else ():
        if all(gain[place].is_zero for place in zero) and all(e.is_zero for e in equations_for(pair, desired, gain)):
            return gain
    unknowns = [name for name in general.field.names if name in general.names]
    rest = dict.fromkeys(unknowns, Scalar.of(0))
    for degree in DEGREES:
        search = Search(frozenset(unknowns), degree)
        solution = search.solve(equations)
        if solution is None:
            continue
        found = general.substitute({**rest, **solution}).normal()
        return found if search.root is None else _in_root(found, *search.root)
    return None


def _in_root(gain: Matrix, factor: Scalar, name: str) -> Matrix | RootGain:
    """Return a gain in a root of a polynomial: with its closed form where it has one."""
    from symobs.exact.algebraic.real_algebraic import roots_of_scalar  # noqa: PLC0415 - only irrational gains pay for it

    field = AlgebraicExtension(factor, name)
    reduced = Matrix.of([[field.reduce(entry) for entry in row] for row in gain.rows], gain.shape[1])
    root = roots_of_scalar(factor, name)[0]
    closed = root.closed_form()
    if closed is None:
        as_root = {name: Scalar.symbol(EIGENVALUE)}
        return RootGain(reduced.substitute(as_root), factor.substitute(as_root), root)
    found = reduced.substitute({name: closed})
    return modulo(found, Ideal.of(identities(found.entries)[1]))


def _unknowns_in(equations: Sequence[Scalar]) -> tuple[str, ...]:
    names = set().union(*(equation.names for equation in equations)) if equations else set()
    return tuple(sorted(name for name in names if name.startswith(_UNKNOWN)))


class Search:
    """A search for a solution of polynomial equations: rational, or in one real root of a degree up to a bound."""

    def __init__(self, unknowns: frozenset[str], degree: int = 1) -> None:
        """Count what is looked at; remember the polynomial whose root the solution contains."""
        self.unknowns = unknowns
        self.degree = degree
        self.left = TERMS_LOOKED_AT
        self.root: tuple[Scalar, str] | None = None

    def solve(self, equations: Sequence[Scalar], *, eliminated: bool = False) -> dict[str, Scalar] | None:
        """Return values of the unknowns, those left out being free; None where none were found."""
        open_ = sorted({e.numerator for e in equations if not e.is_zero}, key=lambda e: (e.size, str(e)))
        self.left -= sum(e.size for e in open_)
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
        involved = sorted(self.unknowns.intersection(name for e in open_ for name in e.names))
        if not eliminated and len(involved) <= len(open_):
            from symobs.exact.ideals import triangular  # noqa: PLC0415 - only patterns that are hard to meet pay for it

            with suppress(TooLarge):
                return self.solve(triangular(open_, involved), eliminated=True)
        name = min(involved, key=lambda n: (-max(e.degree(n) for e in open_), -sum(n in e.names for e in open_), n))
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
        """Try the rational roots of an equation in one unknown, then, if allowed, a real root of a factor."""
        factors = [factor for factor, _ in equation.factors()[1] if name in factor.names]
        for factor in factors:
            if factor.degree(name) == 1:
                lead, constant = factor.coefficients(name)
                found = self._put(equations, {name: -constant / lead})
                if found is not None:
                    return found
        for factor in factors:
            if (
                1 < factor.degree(name) <= self.degree
                and factor.names == {name}
                and self._allows(factor, name, equations)
            ):
                self.root = factor, name
                return {name: Scalar.symbol(name)}
        return None

    def _allows(self, factor: Scalar, name: str, equations: Sequence[Scalar]) -> bool:
        """Return whether a factor has a real root, and all equations hold for its roots."""
        from symobs.exact.algebraic.real_algebraic import roots_of_scalar  # noqa: PLC0415 - only irrational gains pay for it

        field = AlgebraicExtension(factor, name)
        return all(e.names == {name} and field.reduce(e).is_zero for e in equations) and bool(
            roots_of_scalar(factor, name)
        )

    def _put(self, equations: Sequence[Scalar], values: Mapping[str, Scalar]) -> dict[str, Scalar] | None:
        """Substitute values and solve the rest; values may contain unknowns that are solved for later."""
        try:
            rest = self.solve([equation.substitute(values) for equation in equations])
        except ZeroDivisionError:
            return None
        if rest is None:
            return None
        free = {name: rest.get(name, Scalar.of(0)) for value in values.values() for name in value.names & self.unknowns}
        try:
            return {**rest, **free, **{name: value.substitute(free) for name, value in values.items()}}
        except ZeroDivisionError:
            return None
