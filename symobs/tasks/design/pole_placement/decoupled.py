"""The decoupled member of the family: each output error (each input's part) obeys an equation of its own.

A gain decouples where the orders of 𝒪(A − LC, cᵢ) add up to n.
"""

from __future__ import annotations

from itertools import permutations
from typing import TYPE_CHECKING

from symobs.exact import Matrix, rank
from symobs.exact.core.generators import NotWritten
from symobs.formula.tree import Environment, Literal
from symobs.formula.tree.term import Term
from symobs.ground.errors import InputError
from symobs.proof.certificate.claims import Claim
from symobs.proof.derivation.builder import relation
from symobs.tasks.analysis.rank.rank_test import power_rows
from symobs.tasks.design.pole_placement.brunovsky_chains import BrunovskyChains, cost, split_polynomial

if TYPE_CHECKING:
    from collections.abc import Iterator

    from symobs.system.specification import DesiredPolynomial
    from symobs.tasks.design.pole_placement.single_output import ObserverPair


class NotDecoupled(InputError, NotWritten):
    """No gain found decouples; a case of a result is undecided there."""


def decoupled_gain(pair: ObserverPair, desired: DesiredPolynomial) -> Matrix:
    """Return the simplest gain that gives each chain factors of φ of its own and decouples the outputs.

    Raises `NotDecoupled` where a mode is fixed or no chains decouple.
    """
    where = "specification.member"
    if not pair.is_observable:
        message = "a decoupled gain is looked for where no mode is fixed"
        raise NotDecoupled(message, where=where, repair="leave member out, or give zero")
    found, tried = [], set()
    for order in permutations(range(pair.c.shape[0])):
        chains = BrunovskyChains.of(pair.A, pair.c, order)
        if chains.by_output in tried:
            continue  # in another order the same chains share the same factors
        tried.add(chains.by_output)
        for share in split_polynomial(desired.factors, chains.lengths, pair.variable):
            gain = chains.gain(chains.shared(share, "nothing"), pair.c.shape[0])
            if sum(rank(rows) for rows in _own_rows(pair, gain)) == pair.A.shape[0]:
                found.append(gain)
    if not found:
        message = "no chains of the plant decouple the outputs with these poles"
        raise NotDecoupled(message, where=where, repair="leave member out, or say with zero what is to vanish")
    return min(found, key=cost)


def decoupled_claim(pair: ObserverPair, gain: Matrix) -> Claim:
    """Return the claim that the orders of the output errors add up to n."""
    e = Environment(variable=pair.variable)
    first, *others = (Term(Literal(rows), e).apply("rank") for rows in _own_rows(pair, gain))
    added = relation(sum(others, start=first), pair.A.shape[0])
    return Claim(added, e, "the orders of the output errors add up to n")


def _own_rows(pair: ObserverPair, gain: Matrix) -> Iterator[Matrix]:
    """Yield 𝒪(A − LC, cᵢ) for each output."""
    closed = (pair.A - gain @ pair.c).normal()
    for i in range(pair.c.shape[0]):
        yield power_rows(closed, pair.c.select([i], range(pair.A.shape[0])))
