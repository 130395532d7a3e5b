"""The observer-based compensator  x̂' = (A − BK − LC + LDK) x̂ + L y,  u = −K x̂,  in transfer form U = −F(s) Y."""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING, Any, Self

from symobs.exact import Matrix, Scalar, controller, modulo, transfer
from symobs.exact.linear_algebra.transfer_function import Realisation
from symobs.formula.tree import Environment
from symobs.ground.dataclass import dataclass
from symobs.ground.errors import CertificateRejected, InputError, together
from symobs.system.specification import (
    GainText,
    Name,
    Poles,
    PolynomialText,
    desired_polynomial,
    in_common_field,
    read_gain,
    reject_both,
)
from symobs.tasks.design.compensator.output_feedback import Asked, OutputFeedback
from symobs.tasks.design.full_order.observer import ObserverDesign
from symobs.tasks.design.full_order.state_feedback import StateFeedbackDesign
from symobs.tasks.design.gain.gain_cases import half_of, places_where
from symobs.tasks.design.gain.gain_design import letters_of
from symobs.tasks.design.reduced_order.reduced_order_observer import completed
from symobs.tasks.result import Result, equality, method, poles_of, task
from symobs.tasks.result import choose as choose_method

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence

    from symobs.proof.certificate.claims import Claim
    from symobs.system import StateSpace
    from symobs.tasks.analysis.strata.strata import Place
    from symobs.tasks.design.compensator.minimal_order_compensator import MinimalOrderCompensator


@dataclass
class CompensatorDesign(OutputFeedback):
    """Both gains and F: det(sI − A + BK) = φ_c, det(sI − A + LC) = φ_o, F(s) = K (sI − A + BK + LC − LDK)⁻¹ L."""

    estimator: ObserverDesign

    @classmethod
    def design(cls, plant: StateSpace, asked: Sequence[Asked], name: str) -> Self:
        """Return the compensator for these polynomials, or with these gains."""
        feedback = half_of(StateFeedbackDesign, plant, asked[0])
        return cls.of(feedback, half_of(ObserverDesign, plant, asked[1]), name)

    @classmethod
    def of(cls, feedback: StateFeedbackDesign, estimator: ObserverDesign, method_name: str) -> Self:
        """Return the compensator of two designs for one plant."""
        plant = feedback.plant
        K, L = feedback.answer["K"], estimator.answer["L"]
        F: Scalar | Matrix | None = None
        if K is not None and L is not None and plant.inputs == plant.outputs == 1:
            numerator, denominator = own_transfer(feedback, estimator)
            F = plant.simplified(numerator / denominator)
        elif K is not None and L is not None:
            F = realised(plant, K, L).function(plant.variable)
        return cls(plant, method_name, {"K": K, "L": L, "F": F}, feedback, estimator)

    def _environment(self) -> Environment:
        values = letters_of(self.plant) | {name: self.answer[name] for name in ("K", "L", "F")}
        values["D"] = self.plant.matrices.D
        return Environment(variable=self.plant.variable, values=values)

    def claims(self) -> Iterator[Claim]:
        """Yield: K and L are the certified gains of the two designs; F is K times the resolvent times L."""
        if self.exists != (self.feedback.answer["K"] is not None and self.estimator.answer["L"] is not None):
            raise CertificateRejected("there is a compensator exactly where there are both gains")
        e = self._environment()
        yield from self.certified(e)
        if self.exists:
            A, B, C, D, K, L, F = (e[name] for name in "ABCDKLF")
            moved = A.pencil + B @ K + L @ C
            if self.plant.matrices.has_feedthrough:
                moved = moved - L @ D @ K
            yield equality(F, K @ moved.inverse @ L, e)

    @property
    def _estimator_places(self) -> tuple[Place, ...]:
        return places_where(self.estimator)

    @property
    def coupling(self) -> Matrix:
        """K."""
        K: Matrix = self.answer["K"]
        return K

    @property
    def error_input(self) -> tuple[Matrix, Matrix]:
        """B − LD and I."""
        m, L = self.plant.matrices, self.answer["L"]
        return (m.B - L @ m.D).normal(), Matrix.identity(self.plant.inputs)

    @cached_property
    def realisation(self) -> Realisation:
        """A − BK − LC + LDK, L, K, 0."""
        return realised(self.plant, self.answer["K"], self.answer["L"])

    @cached_property
    def own_transfer(self) -> tuple[Scalar, Scalar]:
        """The compensator's numerator and det(sI − A + BK + LC − LDK), nothing cancelled between them."""
        return own_transfer(self.feedback, self.estimator)

    @cached_property
    def error_coordinates(self) -> Matrix:
        """[A − BK, BK; 0, A − LC] in (x, e)."""
        m, K, L = self.plant.matrices, self.answer["K"], self.answer["L"]
        zero, fed = Matrix.zeros(self.plant.order, self.plant.order), m.B @ K
        return Matrix.block([[m.A - fed, fed], [zero, m.A - L @ m.C]])

    @cached_property
    def estimate_coordinates(self) -> Matrix:
        """[A, −BK; LC, A − BK − LC] in (x, x̂)."""
        m, K, L = self.plant.matrices, self.answer["K"], self.answer["L"]
        return Matrix.block([[m.A, -(m.B @ K)], [L @ m.C, m.A - m.B @ K - L @ m.C]])


@dataclass
class KnownState(OutputFeedback):
    """The law u = −K x of a state that is measured: a loop without an observer."""

    estimator: None  # type: ignore[assignment]

    @classmethod
    def design(cls, plant: StateSpace, asked: Sequence[Asked], name: str) -> Self:
        """Return the loop for this polynomial, or with this gain."""
        return cls.of(half_of(StateFeedbackDesign, plant, asked[0]), None, name)

    @classmethod
    def of(cls, feedback: StateFeedbackDesign, estimator: None, method_name: str) -> Self:
        """Return the loop of a state feedback."""
        answer = {"K": feedback.answer["K"], "L": None, "F": None}
        return cls(feedback.plant, method_name, answer, feedback, estimator)

    def claims(self) -> Iterator[Claim]:
        """Yield that K is the certified gain."""
        values = letters_of(self.plant) | {"K": self.answer["K"]}
        yield from self.certified(Environment(variable=self.plant.variable, values=values))

    def with_answer(self, name: str, value: object) -> Self:
        """Return the loop with another gain."""
        return self.of(self.feedback.with_answer(name, value), None, self.method).in_place_of(self)

    def following_from(self, gains: Mapping[str, Matrix]) -> Self:
        """Return the loop of a given gain."""
        return self.of(self.feedback.following_from(gains), None, self.method)

    @property
    def halves(self) -> tuple[StateFeedbackDesign, ...]:
        """The state feedback alone."""
        return (self.feedback,)

    @property
    def exists(self) -> bool:
        """Whether there is a K."""
        return self.answer["K"] is not None

    @property
    def _estimator_places(self) -> tuple[Place, ...]:
        return ()

    @cached_property
    def error_coordinates(self) -> Matrix:
        """A − BK."""
        m = self.plant.matrices
        closed: Matrix = m.A - m.B @ self.answer["K"]
        return closed

    @property
    def systems(self) -> Mapping[str, Realisation]:
        """The plant."""
        return self.feedback.systems


def realised(plant: StateSpace, K: Matrix, L: Matrix) -> Realisation:
    """Return F in state space: A − BK − LC + LDK, L, K, 0."""
    m = plant.matrices
    matrix = m.A - m.B @ K - L @ m.C
    whole = matrix + L @ (m.D @ K) if m.has_feedthrough else matrix
    return Realisation(whole.normal(), L, K, Matrix.zeros(plant.inputs, plant.outputs))


def own_transfer(feedback: StateFeedbackDesign, estimator: ObserverDesign) -> tuple[Scalar, Scalar]:
    """Return the compensator's numerator and det(sI − A + BK + LC − LDK), nothing cancelled between them."""
    m, K, L = feedback.plant.matrices, feedback.answer["K"], estimator.answer["L"]
    if feedback.plant.equations:  # the gains place the poles on the stratum only
        own = modulo(realised(feedback.plant, K, L).A, feedback.plant.ideal)
        return transfer(own, L, K, Scalar.of(0), feedback.plant.variable)
    closed = feedback.answer["polynomial"] * estimator.answer["polynomial"]
    return controller(m.A, m.B, m.C, m.D[0, 0], K, L, closed, feedback.plant.variable)


@method("compensator/separation", source="luenberger1964; luenberger1971")
def separation(plant: StateSpace, control: Asked, observer: Asked) -> CompensatorDesign:
    """Design K as if x were known, design the observer of order n, use x̂ for x."""
    return CompensatorDesign.design(plant, (control, observer), "separation")


@method("compensator/duality", source="kalman1960")
def duality(plant: StateSpace, control: Asked, observer: Asked) -> CompensatorDesign:
    """Place the eigenvalues of Aᵀ − CᵀLᵀ and of A − BK side by side, transpose; then use x̂ for x."""
    if not plant.inputs == plant.outputs == 1:
        message = f"the method duality needs one input and one output, the plant has {plant.inputs} and {plant.outputs}"
        raise InputError(message, where="specification.method", repair="leave the method out, or write separation")
    return CompensatorDesign.design(plant, (control, observer), "duality")


@method("compensator/minimal_order", source="luenberger1971; kailath1980, ch. 4")
def minimal_order(plant: StateSpace, control: Asked, observer: Asked) -> MinimalOrderCompensator:
    """Design K as if x were known, estimate the unmeasured states only, use x̂ for x."""
    from symobs.tasks.design.compensator.minimal_order_compensator import MinimalOrderCompensator  # noqa: PLC0415 - paid for where used

    return MinimalOrderCompensator.design(plant, (control, observer), "minimal_order")


#: The method of each kind of observer.
_METHODS = {"full": "separation", "minimal": "minimal_order"}


def _is_minimal(observer: str, method_name: str) -> bool:
    return "minimal" in (observer, method_name.removesuffix("_order"))


def observer_order(plant: StateSpace, asked: Mapping[str, Any]) -> int:
    """Return the number of poles of the observer that is asked for: n, or n − p."""
    return plant.order - (plant.outputs if _is_minimal(asked["observer"], asked["method"]) else 0)


@task
@poles_of(observer_poles=observer_order)
def compensator(
    plant: StateSpace,
    *,
    control_poles: Poles = None,
    control_polynomial: PolynomialText = None,
    observer_poles: Poles = None,
    observer_polynomial: PolynomialText = None,
    K: GainText = None,
    L: GainText = None,
    observer: Name = "full",
    choose: Name = "auto",
    method: Name = "auto",
) -> Result:
    """Design the observer-based compensator U = −F(s) Y, with an observer of full order n or of minimal order n − p.

    full      F(s) = K (sI − A + BK + LC − LDK)⁻¹ L, strictly proper
    minimal   F(s) = W [K₂ (sI − F + G W K₂)⁻¹ (H − G W N) + N],  N = K₁ + K₂ L,  W = (I − N D)⁻¹,  [K₁ K₂] = K T⁻¹, for
              ż = F z + G u + H y; proper, its direct term W N

    plant                                   n states, m inputs, p outputs, D allowed
    control_poles or control_polynomial     the n poles of A − BK
    observer_poles or observer_polynomial   the n poles of A − LC, or the n − p poles of F
    K, L                                    given gains (m×n, n×p) instead of poles, from LQR, a Kalman filter or
                                            anywhere; the poles are found, an unstable loop is cautioned against
    observer                                `full` or `minimal`; there L cannot be given
    choose                                  which gains of several inputs or outputs: "simple" or "small", as for
                                            `state_feedback`
    Returns K, L, F, F_stable, closed_loop_polynomial, closed_loop ((I + PF)⁻¹ P, F in the return path),
    closed_loop_matrix in (x, e) or (x, e₂) and closed_loop_matrix_estimate in (x, x̂) or (x, z).  Where I − N D is
    singular everywhere the verdict is `no`.  Raises `InputError` for wrong poles or shapes.
    Source: D. G. Luenberger (1964, 1971); T. Kailath, Linear Systems, ch. 4.
    """
    control, estimate = (control_poles, control_polynomial), (observer_poles, observer_polynomial)
    found = observer_based(
        plant,
        task="compensator",
        control=control,
        estimate=estimate,
        observer=observer,
        method_name=method,
        gains=(K, L),
        choose=choose,
    )
    return found.asked(method)


def observer_based(
    plant: StateSpace,
    *,
    task: str,
    control: tuple[object, object],
    estimate: tuple[object, object],
    observer: str,
    method_name: str = "auto",
    gains: tuple[object, object] = (None, None),
    choose: str = "auto",
) -> OutputFeedback:
    """Return the compensator for the poles, polynomial or gain of each loop."""
    if gains[1] is not None:
        reject_both("K", gains[0], None if choose == "auto" else choose, None, other="choose")
    plant = plant.knowing(*control, *estimate, *gains)
    plant.require("B", "C", task=task)

    def wanted(loop: str, given: tuple[object, object], degree: int) -> Asked | None:
        gain, letter, shape = {
            "control": (gains[0], "K", (plant.inputs, plant.order)),
            "observer": (gains[1], "L", (plant.order, plant.outputs)),
        }[loop]
        if gain is not None:
            reject_both(letter, gain, *given, other=f"{loop}_poles")
            return read_gain(gain, plant, letter, shape)
        names = f"{loop}_poles", f"{loop}_polynomial"
        return desired_polynomial(plant, *given, names=names, degree=degree, choose=choose)

    def of_observer() -> Asked | None:
        try:
            return wanted("observer", estimate, estimated) if observer in _METHODS else None
        except InputError as error:
            other, orders = "full" if minimal else "minimal", (plant.order, plant.order - plant.outputs)
            if error.facts.get("given") == orders[not minimal]:
                error.repair += f', or write observer = "{other}"'
            raise

    minimal, estimated = (
        _is_minimal(observer, method_name),
        observer_order(plant, {"observer": observer, "method": method_name}),
    )
    _, _, chosen, control_wish, observer_wish = together(
        lambda: _require_kind(observer, plant, method_name),
        lambda: _require_place(gains, method_name, minimal=minimal),
        lambda: choose_method("compensator", method_name, _METHODS.get(observer, "separation")),
        lambda: wanted("control", control, plant.order),
        of_observer,
    )
    plant, (control_wish, observer_wish) = in_common_field(plant, control_wish, observer_wish)
    found: OutputFeedback = chosen.solve(plant, control_wish, observer_wish)
    return found


def of_known_state(
    plant: StateSpace, *, task: str, control: tuple[object, object], gain: object, choose: str = "auto"
) -> KnownState:
    """Return the loop u = −K x for the control poles, their polynomial or a gain."""
    plant = plant.knowing(*control, gain)
    plant.require("B", "C", task=task)
    asked: Asked | None
    if gain is not None:
        reject_both("K", gain, *control, other="control_poles")
        reject_both("K", gain, None if choose == "auto" else choose, None, other="choose")
        asked = read_gain(gain, plant, "K", (plant.inputs, plant.order))
    else:
        asked = desired_polynomial(plant, *control, names=("control_poles", "control_polynomial"), choose=choose)
    plant, (asked,) = in_common_field(plant, asked)
    return KnownState.design(plant, (asked,), "state_feedback")


def _require_kind(observer: str, plant: StateSpace, method_name: str) -> None:
    """Raise `InputError` for an unknown kind of observer, one that contradicts the method, or one of order 0."""
    if observer not in _METHODS:
        message = f"{observer[:40]!r} is not a kind of observer"
        raise InputError(message, where="specification.observer", repair='write "full" or "minimal"')
    if observer == "minimal" and method_name in {"separation", "duality"}:
        message = f"the method {method_name} has an observer of full order"
        raise InputError(
            message, where="specification.method", repair='leave the method out, or write observer = "full"'
        )
    if _is_minimal(observer, method_name) and plant.order == plant.outputs:
        completed(plant.matrices.C)  # raises where C is singular
        message = "the outputs show the whole state, nothing is left to estimate"
        raise InputError(message, where="specification.observer", repair="use state_feedback with x = C⁻¹ (y − D u)")


def _require_place(gains: tuple[object, object], method_name: str, *, minimal: bool) -> None:
    """Raise `InputError` where gains are given that the kind of observer, or the method, has no place for."""
    if minimal and gains[1] is not None:
        message = "the gain of an observer of minimal order depends on its coordinates, so L cannot be given here"
        raise InputError(message, where="specification.L", repair='give observer_poles, or write observer = "full"')
    if method_name == "duality" and any(gain is not None for gain in gains):
        message = "the method duality places poles, but a gain is given"
        raise InputError(message, where="specification.method", repair="leave the method out")
