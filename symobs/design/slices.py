"""Members of the family with a property asked for: output errors decoupled, or the smallest norm.

Decoupled: the orders of 𝒪(A − LC, cᵢ) add up to n, so each output error obeys an equation of its own.  Smallest: where
the rows of C are multiples of one, C = v c, the product L v is unique and L = (L v) vᵀ/(vᵀv) is the smallest; what is
done for other C stands in `smallest`.
"""

from __future__ import annotations

from itertools import permutations
from typing import TYPE_CHECKING

from symobs.analysis.rank_result import power_rows
from symobs.certificate import Claim, Statement
from symobs.design.chains import Chains, cost, shares
from symobs.errors import InputError
from symobs.exact import Matrix, kernel, rank
from symobs.exact.functions import NotWritten
from symobs.formula import Environment, Literal
from symobs.formula.term import Term
from symobs.page import relation

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from symobs.design.assignment import Pair
    from symobs.specification import DesiredPolynomial

MEMBERS = ("simple", "decoupled", "smallest")


class NoMember(InputError, NotWritten):
    """A member of a family that is not found, or not known exactly; a case of a result is undecided there."""


def member(pair: Pair, desired: DesiredPolynomial, wish: str, signs: Mapping[str, str]) -> Matrix:
    """Return the gain asked for; raises `InputError` where it is not found, or not known exactly."""
    if wish not in MEMBERS:
        message = f"{wish[:40]!r} is no member of the family that has a name"
        raise InputError(message, where="specification.member", repair=f"write one of {', '.join(MEMBERS)}")
    if not pair.is_observable:
        message = f"a {wish} gain is looked for where no mode is fixed"
        raise InputError(message, where="specification.member", repair="leave member out, or give zero")
    found = _decoupled(pair, desired) if wish == "decoupled" else _smallest(pair, desired, signs)
    if isinstance(found, Matrix):
        return found
    raise NoMember(found, where="specification.member", repair="leave member out, or say with zero what is to vanish")


def _decoupled(pair: Pair, desired: DesiredPolynomial) -> Matrix | str:
    """Return the simplest gain that gives each chain factors of φ of its own and decouples the outputs, or why not."""
    found, tried = [], set()
    for order in permutations(range(pair.c.shape[0])):
        chains = Chains.of(pair.A, pair.c, order)
        if chains.by_output in tried:
            continue  # in another order the same chains share the same factors
        tried.add(chains.by_output)
        for share in shares(desired.factors, chains.lengths, pair.variable):
            gain = chains.gain(chains.shared(share, "nothing"), pair.c.shape[0])
            if sum(rank(rows) for rows in _own_rows(pair, gain)) == pair.A.shape[0]:
                found.append(gain)
    return min(found, key=cost, default="no chains of the plant decouple the outputs with these poles")


def _own_rows(pair: Pair, gain: Matrix) -> Iterator[Matrix]:
    """Yield 𝒪(A − LC, cᵢ) for each output."""
    closed = (pair.A - gain @ pair.c).normal()
    for i in range(pair.c.shape[0]):
        yield power_rows(closed, pair.c.select([i], range(pair.A.shape[0])))


def _smallest(pair: Pair, desired: DesiredPolynomial, signs: Mapping[str, str]) -> Matrix | str:
    """Return (L v) vᵀ/(vᵀv) where C = v c, otherwise what multipliers prove, or why there is nothing."""
    if rank(pair.c) > 1:
        from symobs.design.smallest import NotFound, smallest  # noqa: PLC0415 - few gains are asked to be the smallest

        try:
            return smallest(pair, desired, signs).gain
        except NotFound as reason:
            return f"of these gains the smallest is not known exactly: {reason}"
    some = pair.gain(desired)
    assert some is not None  # noqa: S101 - the pair is observable
    row = next(i for i, line in enumerate(pair.c.rows) if any(line))
    place = next(j for j, entry in enumerate(pair.c.rows[row]) if entry)
    v = Matrix.column([line[place] / pair.c[row, place] for line in pair.c.rows])
    size = (v.T @ v)[0, 0]
    return (some @ v @ v.T * (1 / size)).normal()


def member_claims(
    pair: Pair, desired: DesiredPolynomial, gain: Matrix, wish: str, signs: Mapping[str, str]
) -> Iterator[Claim | Statement]:
    """Yield what makes the gain the one asked for."""
    e = Environment(variable=pair.variable)
    if wish == "decoupled":
        first, *others = (Term(Literal(rows), e).apply("rank") for rows in _own_rows(pair, gain))
        yield Claim(
            relation(sum(others, start=first), pair.A.shape[0]), e, "the orders of the output errors add up to n"
        )
    elif rank(pair.c) > 1:
        from symobs.design.smallest import smallest, smallest_claims  # noqa: PLC0415 - few gains are asked to be it
        from symobs.design.stationary import LeastStationary, stationary_claims  # noqa: PLC0415 - the same

        found = smallest(pair, desired, signs)
        if isinstance(found, LeastStationary):
            yield from stationary_claims(pair, desired, gain, found)
        else:
            yield from smallest_claims(pair, desired, gain, found.multipliers, signs)
    else:
        W = kernel(pair.c.T)
        yield Claim(relation(Term(Literal(pair.c), e).apply("rank"), 1), e, "rank C = 1, so that L*C is unique")
        yield Claim(relation(gain @ W, Matrix.zeros(gain.shape[0], W.shape[1])), e, "L*W = 0 wherever W.T*C = 0")
