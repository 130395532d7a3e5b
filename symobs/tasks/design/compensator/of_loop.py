"""A result that stands on a loop of state feedback or of an observer: a reference followed, a filter before the loop."""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING, Any, ClassVar, Self

from symobs.system.conditions import joined
from symobs.tasks.analysis.strata.strata import solved
from symobs.tasks.result import Result

if TYPE_CHECKING:
    from collections.abc import Mapping

    from symobs.exact import Matrix, Scalar
    from symobs.proof.certificate.claims import Certificate
    from symobs.system import StateSpace
    from symobs.system.conditions import Condition
    from symobs.tasks.analysis.strata.strata import Place
    from symobs.tasks.design.compensator.output_feedback import OutputFeedback
    from symobs.tasks.design.gain.gain_design import GainDesign
    from symobs.tasks.result import Case


class OfLoop(Result):
    """A result that stands on a loop: `of(loop, *inputs, method)`; the gains, their claims and strata are the loop's."""

    loop: OutputFeedback
    #: What is given beside the loop, by the names of the fields, in the order of `of`.
    inputs: ClassVar[tuple[str, ...]] = ()
    #: Whether its own strata stand before those of the gains.
    own_first: ClassVar[bool] = False

    def _of(self, loop: OutputFeedback, *given: Any) -> Self:
        made: Self = type(self).of(loop, *given, self.method)  # type: ignore[attr-defined]
        return made

    @property
    def _given(self) -> tuple[Any, ...]:
        return tuple(getattr(self, name) for name in self.inputs)

    def with_gains(self, gains: Mapping[str, Matrix]) -> Self:
        """Return the result whose loop has other gains."""
        return self._of(self.loop.with_gains(gains), *self._given)

    def following_from(self, gains: Mapping[str, Matrix]) -> Self:
        """Return the result whose loop has given gains."""
        return self._of(self.loop.following_from(gains), *self._given)

    def design_of(self, gain: str) -> GainDesign:
        """Return the design of one half of the loop."""
        return self.loop.design_of(gain)

    @property
    def has_reduced_observer(self) -> bool:
        """The loop's estimator may be one."""
        return self.loop.has_reduced_observer

    @property
    def all_certificates(self) -> tuple[Certificate, ...]:
        """The certificates of the loop and its own."""
        return (*self.loop.all_certificates, *self.certificates)

    @property
    def own_conditions(self) -> tuple[Condition, ...]:
        """The conditions of its own answer."""
        return super().holds_where

    @cached_property
    def holds_where(self) -> tuple[Condition, ...]:
        """Its own conditions and those of the gains."""
        return joined(self.own_conditions, self.loop.holds_where)

    @property
    def own_places(self) -> tuple[Place, ...]:
        """The strata besides those of the gains."""
        return ()

    @cached_property
    def case_tree(self) -> tuple[Case, ...]:
        """The strata of the gains, and its own."""

        def on(plant: StateSpace, values: dict[str, Scalar]) -> Result:
            loop = self.loop.on(plant, values)
            given = [None if part is None else part.substitute(values) for part in self._given]
            key = (type(self), self.method, *given, *loop.asked_for)
            found: Result = plant.once(key, lambda: self._of(loop, *given))
            return found

        parts = (self.own_places, self.loop.gain_places)
        asked = {place.when: place for part in (parts if self.own_first else parts[::-1]) for place in part}
        return solved(self.plant, asked.values(), on)
