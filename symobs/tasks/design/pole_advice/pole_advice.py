"""Advice on observer poles: the stable zeros of the plant, the rest on a Butterworth circle or as a dominant pair."""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING

from symobs.ground.dataclass import dataclass
from symobs.ground.errors import InputError
from symobs.system.conditions import Condition, sign_of
from symobs.system.specification import read_quantity
from symobs.system.specification.pole_patterns import overshoot_within
from symobs.tasks.design.pole_advice.advised_poles import AdvisedPoles, PoleRequest
from symobs.tasks.design.pole_advice.pole_candidates import (
    needed_of,
)
from symobs.tasks.result import Case, Result, choose, method, task

if TYPE_CHECKING:
    from symobs.system import StateSpace
    from symobs.system.specification import Name, Quantity


@dataclass(frozen=True, eq=False, repr=False)
class PoleAdvice(AdvisedPoles):
    """Advised poles, with their conditions on parameters and the advice elsewhere."""

    @property
    def verdict(self) -> str:
        """`no` where unobservable modes are not among the poles: no gain moves them there."""
        if not self.missed.is_one:
            return "no"
        return "conditional" if self.case_tree else super().verdict

    @cached_property
    def holds_where(self) -> tuple[Condition, ...]:
        """The conditions of the plant and the zeros, that the radius is positive, and that zeros and modes are all there."""
        signs, radius = self.plant.symbols.signs, self.request.radius
        own = [*super().holds_where]
        if radius is not None and self.count and sign_of(radius, signs) != "positive":
            own.append(Condition("claim", radius.numerator * radius.denominator, ">"))
        for factor in self.taken:
            needed = needed_of(factor, signs, self.answer["sigma"], self.plant.variable)
            own += [Condition("claim", value, ">") for value in needed]
        listed = {condition.expression for condition in own}
        return (*own, *(c for c in self._existence if c.expression not in listed))

    @cached_property
    def _existence(self) -> tuple[Condition, ...]:
        """The conditions for as many zeros as in general, and for a plant all of whose modes are seen and moved."""
        if not self.plant.field.names:
            return ()
        from symobs.tasks.design.pole_advice.pole_advice_cases import existence_of  # noqa: PLC0415 - only plants with parameters pay for it

        return existence_of(self.plant, self.numerator)

    @cached_property
    def case_tree(self) -> tuple[Case, ...]:
        """The advice where zeros are stable that need not be, and where zeros or modes are lost."""
        if not self.plant.field.names:
            return ()
        from symobs.tasks.design.pole_advice.pole_advice_cases import cases_of  # noqa: PLC0415 - only plants with parameters pay for it

        return cases_of(self)


@method("pole_advice/butterworth", source="doyle1979; butterworth1930; brogan1991, pp. 532–533")
def on_a_circle(plant: StateSpace, request: PoleRequest) -> PoleAdvice:
    """Stable zeros, then a Butterworth circle of the radius given."""
    if request.radius is None:
        raise InputError("butterworth needs a radius", where="specification.radius", repair='give radius = "omega_0"')
    return PoleAdvice.of(plant, request, "butterworth")


@method("pole_advice/dominant_pair", source="second-order step response, 2 % settling time 4/σ")
def with_a_pair(plant: StateSpace, request: PoleRequest) -> PoleAdvice:
    """Stable zeros that are fast enough, a pair for settling time and overshoot, the others further left."""
    if request.settling_time is None:
        message, repair = (
            "dominant_pair needs settling_time and overshoot",
            'give settling_time = 2, overshoot = "0.05"',
        )
        raise InputError(message, where="specification.settling_time", repair=repair)
    return PoleAdvice.of(plant, request, "dominant_pair")


@task
def pole_advice(
    plant: StateSpace,
    *,
    radius: Quantity = None,
    settling_time: Quantity = None,
    overshoot: Quantity = None,
    method: Name = "auto",
) -> Result:
    """Advise observer poles: at the stable zeros of the plant, the rest on a circle or as a dominant pair.

    plant                         n states, one input, one output, continuous time
    radius                        ω₀ > 0, a symbol or a number: φ_r(s) φ_r(−s) = ω₀^{2N} + (−1)^N s^{2N}, N poles remaining
    settling_time and overshoot   numbers T > 0 and 0 < M < 1 instead of a radius: −σ ± iω with σ = 4/T (2 %) and
                                  exp(−πσ/ω) ≤ M, zeros only where Re s < −σ, other poles at −5σ, −6σ, …
    Returns poles (with multiplicity), polynomial (factored), zeros_used, warnings.  The verdict is `no` where modes that
    no observer moves are not among the poles.  Raises `InputError` in discrete time, for several inputs or outputs, and
    where N poles on a circle are not written with square roots (N = 7, 9, 11, …).
    Source: J. C. Doyle and G. Stein (1979); W. L. Brogan, Modern Control Theory, 3rd ed., pp. 532–533.
    """
    plant.require("B", "C", task="pole_advice")
    if (plant.inputs, plant.outputs) != (1, 1):
        message = f"the plant has {plant.inputs} inputs and {plant.outputs} outputs"
        raise InputError(message, where="plant", repair="keep one input and one output")
    if plant.is_discrete:
        message = "a Butterworth circle and a settling time 4/σ are of continuous time"
        raise InputError(
            message, where="plant.dt", repair="leave dt out, or take observer with all poles at 0 (deadbeat)"
        )
    request = _wish(plant, radius, settling_time, overshoot)
    plant = plant.knowing(radius)
    found: Result = choose("pole_advice", method, "dominant_pair" if request.radius is None else "butterworth").solve(
        plant, request
    )
    return found.asked(method)


def _wish(plant: StateSpace, radius: object, settling_time: object, overshoot: object) -> PoleRequest:
    """Return the request: a radius, or settling time and overshoot; raises `InputError` for anything else."""
    where = "specification.radius"
    if radius is not None:
        if settling_time is not None or overshoot is not None:
            raise InputError(
                "a radius is given beside settling_time or overshoot", where=where, repair="keep one of them"
            )
        return PoleRequest(read_quantity(radius, plant, "radius"))
    if settling_time is None or overshoot is None:
        message = "radius is missing" if settling_time is overshoot else "settling_time and overshoot belong together"
        repair = 'give radius = "omega_0", or settling_time = 2 and overshoot = "0.05"'
        raise InputError(message, where=where if settling_time is overshoot else "specification", repair=repair)
    found = [read_quantity(v, plant, n) for n, v in (("settling_time", settling_time), ("overshoot", overshoot))]
    for name, value in zip(("settling_time", "overshoot"), found, strict=True):
        if not value.is_constant:
            message = f"{name} is {value}, not a number"
            raise InputError(message, where=f"specification.{name}", repair="give a number, or a radius as a symbol")
    return PoleRequest(None, found[0], overshoot_within(found[1], "specification.overshoot"))
