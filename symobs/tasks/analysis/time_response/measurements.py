"""Results about the initial state, and the reading of measured outputs and known inputs."""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING

from symobs.exact.core.generators import all_roots
from symobs.exact.time_functions.quasipolynomial import Table, table_of
from symobs.ground.errors import InputError
from symobs.system.conditions import Condition
from symobs.system.specification import read_signal
from symobs.tasks.analysis.rank.rank_test import minor_claim, rank_claims, rank_environment, rank_losses
from symobs.tasks.analysis.time_response.damping_cases import DampingCases

if TYPE_CHECKING:
    from collections.abc import Iterator

    from symobs.exact import Matrix, Scalar
    from symobs.proof.certificate.claims import Claim
    from symobs.system import StateSpace

_MOST_TERMS = 60


class OfTheInitialState(DampingCases):
    """A result about x(0), which the output determines where the pair (C, A) is observable."""

    @property
    def is_unique(self) -> bool:
        """Whether the pair is observable in general."""
        return bool(self.answer["rank"]["rank"] == self.plant.order)

    @property
    def further_zeros(self) -> tuple[Scalar, ...]:
        """Where the pair may lose rank."""
        return rank_losses(self.answer["rank"], self.plant.symbols.signs)

    @cached_property
    def holds_where(self) -> tuple[Condition, ...]:
        """That no rank is lost is a condition."""
        known = super().holds_where
        beyond = [Condition("existence", f) for f in self.further_zeros if f not in {c.expression for c in known}]
        return (*known, *beyond)

    def observability_claims(self) -> Iterator[Claim]:
        """Yield the rank of the observability matrix and its kernel."""
        test = self.answer["rank"]
        e = rank_environment(self.plant, (self.plant.matrices.A, self.plant.matrices.C), test)
        yield from rank_claims(test, e)
        yield from minor_claim(test, e)


def read_functions(value: object, plant: StateSpace, name: str, count: int) -> tuple[Matrix, Table]:
    """Return a column of `count` functions of t, as a matrix and as sums; raises `InputError`, `ShapeMismatch`."""
    where = f"specification.{name}"
    if value is None:
        message = f"the {name} is missing"
        raise InputError(message, where=where, repair=f'give it as a function of t, {name} = "1 - exp(-t)"')
    found = read_signal(value, plant, name, count, functions=True)
    repair = "write sums of exponentials, sines and cosines times powers of t, such as 2 t exp(-t) sin(3 t)"
    if any("t" in root.argument.names for root in all_roots(found)):
        raise InputError(f"the {name} contains a root of t", where=where, repair=repair)
    try:
        sums = table_of(found)
    except ValueError as error:
        raise InputError(str(error), where=where, repair=repair) from None
    if sum(len(entry.terms) for row in sums for entry in row) > _MOST_TERMS:
        raise InputError("the functions have too many terms", where=where, repair=f"keep to {_MOST_TERMS} terms")
    return found, sums
