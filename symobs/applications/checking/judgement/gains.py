"""Results with other gains: those of a student, right or wrong.

A gain that meets its claim replaces that of the result.  From any other the rest follows as well: a design with a given
gain claims no poles, so that F of a compensator, a closed loop or an observer follows from what the student computed before.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

from symobs.applications.checking.judgement.parts import GAINS
from symobs.exact import Matrix
from symobs.ground.errors import CertificateRejected
from symobs.system.specification import DesiredPolynomial
from symobs.tasks.design.compensator.output_feedback import OutputFeedback
from symobs.tasks.design.disturbance.disturbance_observer import DisturbanceObserver
from symobs.tasks.design.disturbance.unknown_input_observer import UnknownInputObserver
from symobs.tasks.design.full_order.observer import ObserverDesign
from symobs.tasks.design.gain.gain_design import GainDesign
from symobs.tasks.design.gain.gain_kind import AssignedGain
from symobs.tasks.design.reduced_order.reduced_order_observer import ReducedOrderObserver
from symobs.tasks.design.reference.feedforward import FeedforwardDesign, response
from symobs.tasks.design.reference.integral_action import IntegralAction
from symobs.tasks.design.reference.tracking import TrackingDesign

if TYPE_CHECKING:
    from collections.abc import Mapping

    from symobs.tasks.result import Result


def with_gain(result: Result, name: str, gain: Matrix) -> Result:
    """Return the result with another gain; raises `CertificateRejected` where its claim does not hold."""
    if isinstance(result, (FeedforwardDesign, TrackingDesign)):
        return _remade(result, result.loop.with_answer(name, gain))
    if isinstance(result, (DisturbanceObserver, IntegralAction)):
        return with_gains(result, {name: gain})
    return result.with_answer(name, gain)


def with_gains(result: DisturbanceObserver | IntegralAction, gains: Mapping[str, Matrix]) -> Result:
    """Return the result with other gains; raises `CertificateRejected` where the claim does not hold for both."""
    design = design_with(result, "")
    return _of_larger(result, design.with_answer(design.letter, _whole(result, gains)))


def _whole(result: DisturbanceObserver | IntegralAction, gains: Mapping[str, Matrix]) -> Matrix:
    """Return [K, −k_I] or [L_x; L_w]; a gain that is not given is that of the result."""
    first, second = (gains.get(name, result.answer[name]) for name in GAINS[result.task])
    if first is None or second is None:
        message = "there are no such gains"
        raise CertificateRejected(message, repair="please report this: it is a bug of symobs")
    return Matrix.block([[first, -second]] if isinstance(result, IntegralAction) else [[first], [second]])


def _of_larger(result: DisturbanceObserver | IntegralAction, design: Any) -> Result:
    """Return the result whose gains are those of the plant with further states."""
    if isinstance(result, IntegralAction):
        return result.of_loop(result.plant, design, result.method)
    return result.of_inner(result.plant, result.exosystem, design, result.method)


def with_claimed(result: Result, name: str, value: Matrix) -> Result:
    """Return the result with another K_d, feedforward F or H; raises `CertificateRejected` where its claim does not hold."""
    if not isinstance(result, FeedforwardDesign):
        return result.with_answer(name, value)
    response_to = response(result.loop, value).function(result.plant.variable)
    single = value.shape == (1, 1)
    answer = {"F": value[0, 0] if single else value, "transfer_function": response_to[0, 0] if single else response_to}
    return replace(result, answer={**result.answer, **answer})


def from_gains(result: Result, gains: Mapping[str, Matrix]) -> Result:
    """Return the result that follows from given gains, wherever they place the poles."""
    if isinstance(result, (FeedforwardDesign, TrackingDesign)):
        loop = from_gains(result.loop, gains)
        assert isinstance(loop, OutputFeedback)  # noqa: S101 - of the same type as before
        return _remade(result, loop)
    if isinstance(result, OutputFeedback):
        feedback, estimator = (from_gains(half, gains) for half in (result.feedback, result.estimator))
        return result.of(feedback, estimator, result.method)  # type: ignore[arg-type]
    if isinstance(result, ReducedOrderObserver):
        if "L" not in gains:
            return result
        inner = ObserverDesign.of_given(result.inner.plant, gains["L"])
        placed = DesiredPolynomial(result.plant.variable, (inner.answer["polynomial"],))
        return result.assembled(result.plant, inner, placed, result.answer["T"], result.method)
    if isinstance(result, UnknownInputObserver):
        if "L" not in gains:
            return result
        assert result.inner is not None  # noqa: S101 - without it there is no gain to be judged
        inner = ObserverDesign.of_given(result.inner.plant, gains["L"])
        placed = DesiredPolynomial(result.plant.variable, (inner.answer["polynomial"],))
        return result.with_gain(inner, placed)
    if isinstance(result, (DisturbanceObserver, IntegralAction)):
        design = design_with(result, "")
        given = design.of_given(design.plant, _whole(result, gains))
        placed = DesiredPolynomial(result.plant.variable, (given.answer["polynomial"],))
        return _of_larger(result, replace(given, kind=AssignedGain(placed)))
    assert isinstance(result, GainDesign)  # noqa: S101 - there is no other result with gains
    return result.of_given(result.plant, gains[result.letter]) if result.letter in gains else result


def design_with(result: Result, name: str) -> GainDesign:
    """Return the design that owns the claim of a gain of a result."""
    if isinstance(result, (FeedforwardDesign, TrackingDesign)):
        return design_with(result.loop, name)
    if isinstance(result, OutputFeedback):
        return design_with(result.feedback if name == "K" else result.estimator, name)
    if isinstance(result, ReducedOrderObserver):
        return result.inner
    if isinstance(result, UnknownInputObserver):
        assert result.inner is not None  # noqa: S101 - without it there is no gain to be judged
        return result.inner
    if isinstance(result, DisturbanceObserver):
        return result.inner
    if isinstance(result, IntegralAction):
        return result.loop
    assert isinstance(result, GainDesign)  # noqa: S101 - there is no other result with gains
    return result


def _remade(result: FeedforwardDesign | TrackingDesign, loop: OutputFeedback) -> Result:
    if isinstance(result, TrackingDesign):
        return result.of(loop, result.reference, result.start, result.method)
    return result.of(loop, result.method)
