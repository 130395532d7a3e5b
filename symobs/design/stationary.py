"""The smallest gain as the least of all stationary ones, where no multipliers prove it.

Where φ has no multiple root and (C, A) is observable, every closed-loop matrix is cyclic and the derivatives of the
coefficients d₁, …, dₙ are independent at every gain of the family: the smallest one, which exists, solves Lagrange's
equations.  Their solutions are finitely many as a rule; the sums of squares at all of them are eigenvalues of one
matrix M, and a gain whose sum is the only eigenvalue between 0 and a number above it is the smallest.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from symobs.certificate import Claim, Statement
from symobs.design.zeros import equations_for, unknown_gain
from symobs.exact import EIGENVALUE, Field, Ideal, Matrix, Scalar, TooLarge, modulo
from symobs.exact.functions import identities, partial
from symobs.formula import Environment, Literal
from symobs.formula.term import Term
from symobs.page import relation
from symobs.record import dataclass

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence
    from fractions import Fraction

    from symobs.design.assignment import Pair
    from symobs.exact.least_norm import Quadratic
    from symobs.exact.quotient import Quotient
    from symobs.specification import DesiredPolynomial

#: What the multipliers of Lagrange's equations are called; no parameter's name begins so.
_MULTIPLIER = "_y"


@dataclass(frozen=True)
class LeastStationary:
    """A gain, Lagrange's equations for all of them, what they say of the sum of squares, and a number just above it."""

    gain: Matrix
    unknowns: Matrix
    equations: tuple[Scalar, ...]
    quotient: Quotient
    above: Fraction

    def polynomial(self, variable: str) -> Scalar:
        """Return the polynomial whose roots are the sums of squares."""
        return self.quotient.matrix.characteristic_polynomial(variable)


def lagrange_equations(pair: Pair, desired: DesiredPolynomial) -> tuple[Matrix, list[str], tuple[Scalar, ...]]:
    """Return the unknown entries, column under column, the names of all unknowns, and 2 l + Σ λₖ ∂dₖ/∂l = 0, dₖ = 0."""
    general = unknown_gain(pair.A.shape[0], pair.c.shape[0], ())
    entries = [general[i, j] for j in range(general.shape[1]) for i in range(general.shape[0])]
    multipliers = [Scalar.symbol(f"{_MULTIPLIER}{k}") for k in range(pair.A.shape[0])]
    names = [next(iter(entry.names)) for entry in (*entries, *multipliers)]
    field = Field.of(names)
    deviations = [d.numerator.within(field) for d in equations_for(pair, desired, general)]
    stationary = [
        2 * entry + sum((m * partial(d, name) for m, d in zip(multipliers, deviations, strict=True)), Scalar.of(0))
        for entry, name in zip(entries, names, strict=False)
    ]
    return Matrix.column(entries), names, tuple(e.numerator.within(field) for e in (*stationary, *deviations))


def least_stationary(pair: Pair, desired: DesiredPolynomial, forms: Sequence[Quadratic]) -> LeastStationary | None:
    """Return the least stationary gain, None where the solutions are too many, or this is not known to be the smallest."""
    from symobs.exact.least_norm import at_sum_of_squares  # noqa: PLC0415 - few gains need it
    from symobs.exact.quotient import near_zero, quotient  # noqa: PLC0415 - the same
    from symobs.exact.real import roots_of_scalar  # noqa: PLC0415 - the same

    if bezout(desired) is None:
        return None
    unknowns, names, equations = lagrange_equations(pair, desired)
    squares = (unknowns.T @ unknowns)[0, 0]
    try:
        found = quotient(equations, squares, names)
    except TooLarge:
        return None
    polynomial = found.matrix.characteristic_polynomial("s")
    root = next((root for root in roots_of_scalar(polynomial, "s") if root.interval()[0] > 0), None)
    start = None if root is None else near_zero(found, root)
    if root is None or start is None:
        return None
    entries = at_sum_of_squares(forms, start, root)
    if entries is None:
        return None
    order = pair.A.shape[0]
    at = [entry.substitute({EIGENVALUE: root.scalar()}) for entry in entries[: unknowns.shape[0]]]
    gain = Matrix.of([[at[j * order + i] for j in range(len(at) // order)] for i in range(order)])
    return LeastStationary(gain, unknowns, equations, found, root.between()[1])


def bezout(desired: DesiredPolynomial) -> tuple[Scalar, Scalar, Scalar] | None:
    """Return a, b and φ′ with a φ + b φ′ = 1, None where φ has a multiple root."""
    phi, variable = desired.polynomial, desired.variable
    slope = partial(phi, variable)
    table = _sylvester(phi, slope, variable)
    if table.determinant().is_zero:
        return None
    degree = phi.degree(variable)
    solved = table.T.solve(Matrix.unit(2 * degree - 1, 2 * degree - 2)).entries
    s = Scalar.symbol(variable)
    first, second = solved[: degree - 1], solved[degree - 1 :]
    a = sum((c * s ** (degree - 2 - k) for k, c in enumerate(first)), Scalar.of(0))
    b = sum((c * s ** (degree - 1 - k) for k, c in enumerate(second)), Scalar.of(0))
    return a, b, slope


def _sylvester(phi: Scalar, slope: Scalar, variable: str) -> Matrix:
    """Return Sylvester's matrix: the coefficients of sᵏ φ and sᵏ φ′ as rows."""
    degree = phi.degree(variable)
    own, its = phi.coefficients(variable), slope.coefficients(variable)
    size = 2 * degree - 1
    rows = [[Scalar.of(0)] * k + list(own) + [Scalar.of(0)] * (size - k - len(own)) for k in range(degree - 1)]
    rows += [[Scalar.of(0)] * k + list(its) + [Scalar.of(0)] * (size - k - len(its)) for k in range(degree)]
    return Matrix.of(rows)


def stationary_claims(
    pair: Pair, desired: DesiredPolynomial, gain: Matrix, found: LeastStationary
) -> Iterator[Claim | Statement]:
    """Yield that Lagrange's equations are necessary, what they say of the sum of squares, and that of the gain is the least."""
    from symobs.exact.real import roots_between  # noqa: PLC0415 - few gains need it

    variable = pair.variable
    free = Environment(variable=variable)
    rows = [pair.c @ pair.A**k for k in range(pair.A.shape[0])]
    stack = Term(Literal(Matrix.block([[row] for row in rows])), free)
    yield Claim(relation(stack.apply("rank"), pair.A.shape[0]), free, "rank O = n")
    parts = bezout(desired)
    assert parts is not None  # noqa: S101 - the gain was looked for only where there is no multiple root
    a, b, slope = (Term(Literal(part), free) for part in parts)
    phi = Term(Literal(desired.polynomial), free)
    yield Claim(relation(a @ phi + b @ slope, 1), free, "phi has no multiple root")
    under = Environment(variable=variable, relations=found.equations)
    x, monomials = Term(Literal(found.unknowns), under), Term(Literal(found.quotient.monomials), under)
    M = found.quotient.matrix
    says = "b*|L|**2 = M*b wherever Lagrange's equations hold"
    yield Claim(relation(monomials @ (x.T @ x), Term(Literal(M), under) @ monomials), under, says)
    yield Claim(relation(found.quotient.monomials[0, 0], 1), free, "b begins with 1")
    u = found.polynomial(variable)
    l = Matrix.column([gain[i, j] for j in range(gain.shape[1]) for i in range(gain.shape[0])])
    values: dict[str, Scalar | Matrix] = {"u": u, "M": M}
    e = Environment(variable=variable, values=values, relations=identities([gain])[1])
    size = M.shape[0]
    pencil = Term(Literal(Matrix.identity(size) * Scalar.symbol(variable)), free) - Term(Literal(M), free)
    yield Claim(relation(pencil.apply("det"), u), free, "det(s*I - M) = u(s)")
    total = (l.T @ l).normal()
    square = (modulo(total, Ideal.of(e.relations)) if e.relations else total)[0, 0]
    yield Claim(relation(Term(Literal(l), e).T @ Term(Literal(l), e), square), e, "|L|**2 is known")
    yield Claim(relation(Term(Literal(square), e).apply("u_at"), 0), e, "u(|L|**2) = 0")
    yield Claim(relation(square, ">", 0), free, "|L|**2 > 0")
    yield Claim(relation(square, "<", Scalar.of(found.above)), free, f"|L|**2 < {found.above}")
    yield Statement(
        f"u has one root between 0 and {found.above}, and 0 is none",
        lambda: "by Sturm's theorem" if roots_between(u, variable, found.above) == 1 else "",
    )
