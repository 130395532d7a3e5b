"""The smallest gain of a family: the least sum of squares under det(sI − A + LC) = φ(s), with what proves it.

Let d₁, …, dₙ be the coefficients of det(sI − A + LC) − φ(s) and l the entries of L.  Where multipliers λₖ make
lᵀl + Σ λₖ dₖ a polynomial of degree 2 that is convex and has its lowest point at L, every other gain, for which all dₖ
vanish too, is at least as large: that is the certificate, whatever found the multipliers.  Where C has rank 2 every dₖ
has degree 2.  Of second order the multipliers always exist; of higher order mostly, and where not see `stationary`.
"""

from __future__ import annotations

from functools import lru_cache
from typing import TYPE_CHECKING

from symobs.certificate import Claim
from symobs.conditions import sign_of
from symobs.design.stationary import LeastStationary, bezout, least_stationary
from symobs.design.zeros import equations_for, unknown_gain
from symobs.exact import EIGENVALUE, Extension, Ideal, Matrix, Scalar, modulo
from symobs.exact.functions import identities, partial, square_root
from symobs.exact.least_norm import Quadratic, shortest
from symobs.formula import Environment, Literal
from symobs.formula.term import Term, identity, letter
from symobs.page import relation
from symobs.record import dataclass

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence

    from symobs.design.assignment import Pair
    from symobs.specification import DesiredPolynomial

#: The multiplier in which the others are written while it is looked for; no parameter's name begins so.
_MU = "_mu"
#: The bits of a polynomial whose roots are looked for: isolating them cannot be interrupted.
_LONGEST = 800
#: What is certain of a number that is not negative.
NOT_NEGATIVE = frozenset(("positive", "nonnegative", "zero"))


@dataclass(frozen=True)
class Smallest:
    """A gain and the multipliers λₖ that prove it the smallest, those of the highest coefficients first."""

    gain: Matrix
    multipliers: tuple[Scalar, ...]


class NotFound(ArithmeticError):
    """No gain is proved to be the smallest; the text says why."""


def stacked(gain: Matrix) -> Matrix:
    """Return the entries of a gain of the observer problem, column under column."""
    return Matrix.column([gain[i, j] for j in range(gain.shape[1]) for i in range(gain.shape[0])])


def unstacked(entries: Sequence[Scalar], rows: int) -> Matrix:
    """Return the gain with these entries."""
    columns = len(entries) // rows
    return Matrix.of([[entries[j * rows + i] for j in range(columns)] for i in range(rows)], columns)


def quadratics(pair: Pair, desired: DesiredPolynomial) -> tuple[Quadratic, ...]:
    """Return the coefficients of det(sI − A + LC) − φ(s), highest first, as polynomials of degree 2 in the entries of L.

    Raises `NotFound` where one is of higher degree.
    """
    general = unknown_gain(pair.A.shape[0], pair.c.shape[0], ())
    names = [next(iter(entry.names)) for entry in stacked(general).entries]
    return tuple(_quadratic(equation, names) for equation in equations_for(pair, desired, general))


def _quadratic(polynomial: Scalar, names: Sequence[str]) -> Quadratic:
    zero = dict.fromkeys(names, Scalar.of(0))
    slopes = [_partial(polynomial, name) for name in names]
    form = Matrix.of([[_partial(slope, name) / 2 for name in names] for slope in slopes])
    if form.names.intersection(names):
        message = "it is found only where the rank of C (of B) is at most 2"
        raise NotFound(message)
    return Quadratic(form, Matrix.column([slope.substitute(zero) for slope in slopes]), polynomial.substitute(zero))


def _partial(polynomial: Scalar, name: str) -> Scalar:
    return partial(polynomial, name) if name in polynomial.field.position else Scalar.of(0)


def hessian(forms: Sequence[Quadratic], multipliers: Sequence[Scalar]) -> Matrix:
    """Return I + Σ λₖ Qₖ, half the second derivative of lᵀl + Σ λₖ dₖ."""
    total = Matrix.identity(forms[0].form.shape[0])
    for quadratic, multiplier in zip(forms, multipliers, strict=True):
        total = total + quadratic.form * multiplier
    return total.normal()


def rising(matrix: Matrix, variable: str) -> tuple[Scalar, ...]:
    """Return the coefficients of det(sI + M) after the first: of a symmetric M none is negative where M ≥ 0, and only there."""
    return (-matrix).normal().characteristic_polynomial(variable).coefficients(variable)[1:]


def smallest(pair: Pair, desired: DesiredPolynomial, signs: Mapping[str, str]) -> Smallest | LeastStationary:
    """Return the smallest gain; raises `NotFound` with the reason where none is proved to be it."""
    return _smallest(pair, desired, tuple(sorted(signs.items())))


@lru_cache(maxsize=64)
def _smallest(
    pair: Pair, desired: DesiredPolynomial, declared: tuple[tuple[str, str], ...]
) -> Smallest | LeastStationary:
    """Do what `smallest` says: the answer is looked for once, its claims and its page ask again for the multipliers."""
    signs = dict(declared)
    order, outputs = pair.A.shape[0], pair.c.shape[0]
    if desired.polynomial == pair.A.characteristic_polynomial(pair.variable):
        return Smallest(Matrix.zeros(order, outputs), (Scalar.of(0),) * order)
    if pair.equations:
        message = "it is not looked for where the parameters obey equations that cannot be solved for one of them"
        raise NotFound(message)
    forms = quadratics(pair, desired)
    if order == 2:
        return _of_second_order(forms, signs)
    if pair.A.names or pair.c.names or not desired.is_numeric:
        message = "with parameters it is found only for plants of second order"
        raise NotFound(message)
    found = shortest(forms)
    if found is None:
        edge = _at_edge(forms, order)
        if edge is not None:
            return edge
        least = least_stationary(pair, desired, forms)
        if least is None:
            others = (
                "its stationary points are too many to be compared"
                if bezout(desired)
                else "where a pole is asked for twice the smallest gain need not be one of its stationary points"
            )
            message = f"no multipliers make the Lagrangian convex, or their degrees are above 24, and {others}"
            raise NotFound(message)
        return least
    root, values = found
    entries = _at_root(values, EIGENVALUE, root.scalar())
    return Smallest(unstacked(entries[: order * outputs], order), tuple(entries[order * outputs :]))


def _at_edge(forms: Sequence[Quadratic], order: int) -> Smallest | None:
    """Return a smallest gain where H is singular, None where there is none."""
    from symobs.design.edge import at_edge  # noqa: PLC0415 - few gains need it
    from symobs.exact.edge_norm import multipliers_at_edge  # noqa: PLC0415 - the same

    found = multipliers_at_edge(forms)
    if found is None:
        return None
    root, multipliers = found
    H = hessian(forms, multipliers)
    field = Extension(root.minimal_polynomial(EIGENVALUE), EIGENVALUE)
    if not field.reduce(H.determinant()).is_zero:
        return None
    entries = at_edge(forms, H, root, multipliers)
    if entries is None:
        return None
    return Smallest(unstacked(entries, order), tuple(_at_root(multipliers, EIGENVALUE, root.scalar())))


def _at_root(values: Sequence[Scalar], name: str, root: Scalar) -> list[Scalar]:
    """Return polynomials in a generator at a root, square roots in normal form."""
    at = Matrix.column([value.substitute({name: root}) for value in values])
    relations = identities(at.entries)[1]
    return list(modulo(at, Ideal.of(relations)).entries) if relations else list(at.entries)


# -- the certificate ---------------------------------------------------------------------------------------------------


@dataclass(frozen=True)
class Proof:
    """What proves a gain the smallest, for a change M of it with free entries m.

    deviation   dₖ(L + M), highest first
    hessian     H
    rising      the coefficients of det(sI + H) after the first
    """

    change: Matrix
    deviation: tuple[Scalar, ...]
    hessian: Matrix
    rising: tuple[Scalar, ...]


def proof_of(pair: Pair, desired: DesiredPolynomial, gain: Matrix, multipliers: Sequence[Scalar]) -> Proof:
    """Return the parts of the proof for a gain of the observer problem; dₖ(L) = 0 is taken for granted."""
    relations = identities([gain, *multipliers])[1]
    ideal = Ideal.of(relations) if relations else None
    forms, l = quadratics(pair, desired), stacked(gain)
    change = unknown_gain(*gain.shape, ())
    m = stacked(change)
    slopes = [modulo((q.form @ l * 2 + q.slope).normal(), ideal) for q in forms]
    deviation = tuple((m.T @ (q.form @ m + slope))[0, 0] for q, slope in zip(forms, slopes, strict=True))
    H = hessian(forms, multipliers)
    return Proof(change, deviation, H, modulo(Matrix.row(rising(H, "s")), ideal).entries)


def smallest_claims(
    pair: Pair, desired: DesiredPolynomial, gain: Matrix, multipliers: Sequence[Scalar], signs: Mapping[str, str]
) -> Iterator[Claim]:
    """Yield that a convex polynomial of degree 2 is lᵀl on the family and has its lowest point at the gain."""
    if not any(multipliers):
        e = Environment(variable=pair.variable)
        yield Claim(relation(gain, Matrix.zeros(*gain.shape)), e, "L = 0, which no other gain falls below")
        return
    proof, s = proof_of(pair, desired, gain, multipliers), Scalar.symbol(pair.variable)
    relations = identities([gain, *multipliers])[1]
    values: dict[str, Scalar | Matrix] = {
        "A": pair.A,
        "C": pair.c,
        "L": gain,
        "phi": desired.polynomial,
        "Q_g": proof.hessian,
    }
    e = Environment(variable=pair.variable, values=values, relations=relations, signs=signs)
    order, M = pair.A.shape[0], Term(Literal(proof.change), e)
    pencil = letter("s", e) @ identity(order, e) - letter("A", e) + (letter("L", e) + M) @ letter("C", e)
    deviation = sum((d * s ** (order - 1 - k) for k, d in enumerate(proof.deviation)), Scalar.of(0))
    says = "det(s*I - A + (L + M)*C) - phi(s) = d1*s**(n - 1) + ... + dn for every M"
    yield Claim(relation(pencil.apply("det"), letter("phi", e) + Term(Literal(deviation), e)), e, says)
    l, m, H = Term(Literal(stacked(gain)), e), Term(Literal(stacked(proof.change)), e), letter("Q_g", e)
    weighted = sum((d * weight for d, weight in zip(proof.deviation, multipliers, strict=True)), Scalar.of(0))
    says = "|L + M|**2 + sum of lambda_k*d_k = |L|**2 + m.T*H*m for every M"
    lagrangian = (l + m).T @ (l + m) + Term(Literal(weighted), e)
    yield Claim(relation(lagrangian, l.T @ l + m.T @ H @ m), e, says)
    yield Claim(relation(H, H.T), e, "H = H.T")
    size = proof.hessian.shape[0]
    polynomial = sum((c * s ** (size - 1 - k) for k, c in enumerate(proof.rising)), s**size)
    yield Claim(relation((letter("s", e) @ identity(size, e) + H).apply("det"), polynomial), e, "det(s*I + H) is known")
    free = Environment(variable=pair.variable, signs=signs)
    for value in proof.rising:
        yield Claim(relation(value, ">=", 0), free, "no coefficient of det(s*I + H) is negative")


# -- second order ------------------------------------------------------------------------------------------------------


def _of_second_order(forms: Sequence[Quadratic], signs: Mapping[str, str]) -> Smallest:
    """Return the smallest gain of a plant of second order.

    d₁ is linear, so that λ₁ follows from μ = λ₂, and l with it; what is left is one equation for μ.  Where none of its
    roots serves, the multipliers are those for which H is singular.
    """
    linear, quadratic = forms
    mu = Scalar.symbol(_MU)
    H = hessian(forms, (Scalar.of(0), mu))
    ways = H.solve(Matrix.block([[linear.slope, quadratic.slope]])) * Scalar.rational(-1, 2)
    towards, own = (ways.select(range(ways.shape[0]), [k]) for k in (0, 1))
    first = -((linear.slope.T @ own)[0, 0] * mu + linear.constant) / (linear.slope.T @ towards)[0, 0]
    ell = (towards * first + own * mu).normal()
    secular = quadratic.at(ell)
    factors = [mu] if secular.is_zero else [f for f, _ in secular.numerator.factors()[1] if _MU in f.names]
    coefficients = rising(H, "s")
    for factor, root in _roots(factors):
        try:
            reduced = [Extension(factor, _MU).reduce(value) for value in (*ell.entries, first, mu, *coefficients)]
        except ZeroDivisionError:
            continue
        values = _at_root(reduced, _MU, root)
        if all(sign_of(value, signs) in NOT_NEGATIVE for value in values[-len(coefficients) :]):
            size = ell.shape[0]
            return Smallest(unstacked(values[:size], 2), tuple(values[size : size + 2]))
    if any(names - {_MU} for names in (secular.names, H.names)):
        message = "no gain that is a rational function of the parameters is proved to be the smallest for all of them"
        raise NotFound(message)
    return _at_singular_hessian(forms, H)


def _roots(factors: Sequence[Scalar]) -> Iterator[tuple[Scalar, Scalar]]:
    """Yield each factor with its real roots; of one that contains parameters only where it is linear."""
    from symobs.exact.real import roots_of_scalar  # noqa: PLC0415 - only this member of a family pays for it

    for factor in sorted(factors, key=lambda f: (f.degree(_MU), f.size)):
        if factor.lengths()[0] > _LONGEST:
            message = "its entries are roots of polynomials with too many digits"
            raise NotFound(message)
        if factor.degree(_MU) == 1:
            lead, constant = factor.coefficients(_MU)
            yield factor, -constant / lead
        elif factor.names == {_MU}:
            for root in roots_of_scalar(factor, _MU):
                yield factor, root.scalar()


def _at_singular_hessian(forms: Sequence[Quadratic], H: Matrix) -> Smallest:
    """Return a smallest gain where H is singular: of a sphere of gains of one size, a member with a short radius vector."""
    linear, quadratic = forms
    size = H.shape[0]
    mu, half = Scalar.symbol(_MU), Scalar.rational(1, 2)
    system = Matrix.block(
        [
            [H, linear.slope * half, quadratic.slope * (mu * half)],
            [linear.slope.T, Matrix.of([[0, linear.constant]])],
        ]
    )
    factors = [f for f, _ in H.determinant().numerator.factors()[1] if _MU in f.names]
    for factor, root in _roots(factors):
        field = Extension(factor, _MU)
        _, kernel = field.echelon(system)
        columns = [kernel.select(range(size + 2), [j]) for j in range(kernel.shape[1])]
        own = [column for column in columns if not column[size + 1, 0].is_zero]
        if not own:
            continue
        scaled = (own[0] * field.inverse(own[0][size + 1, 0])).normal()
        moving = [column for column in columns if column[size + 1, 0].is_zero]
        listed = [field.reduce(entry) for column in (scaled, *moving) for entry in column.entries]
        values = _at_root(listed, _MU, root)
        start, *others = (Matrix.column(values[k : k + size + 2]) for k in range(0, len(values), size + 2))
        found = _on_sphere(
            quadratic, start.select(range(size), [0]), [w.select(range(size), [0]) for w in others], root
        )
        if found is not None:
            return Smallest(unstacked(found.entries, 2), (start[size, 0], root))
    message = "no gain is proved to be the smallest"
    raise NotFound(message)


def _on_sphere(quadratic: Quadratic, start: Matrix, ways: Sequence[Matrix], mu: Scalar) -> Matrix | None:
    """Return a point start + Σ tᵢ wᵢ where the second equation holds; there xᵀQx = −xᵀx/μ along the wᵢ.

    The centre comes first, then a way from it whose length is rational where there is one.
    """
    centre = start
    if ways:
        W = Matrix.block([list(ways)])
        pull = W.T @ (quadratic.form @ start * 2 + quadratic.slope)
        centre = (start + W @ (W.T @ W).solve(pull) * (mu / 2)).normal()
    height = quadratic.at(centre)
    if height.is_zero:
        return centre
    lengths = [(height * mu / (way.T @ way)[0, 0], way) for way in ways]
    reached = [centre + way * square_root(square) for square, way in lengths if sign_of(square, {}) == "positive"]
    simplest = min(reached, key=lambda x: (bool(x.names), sum(map(bool, x.entries))), default=None)
    return None if simplest is None else simplest.normal()
