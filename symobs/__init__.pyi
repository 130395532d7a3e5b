"""What type checkers and editors know of `symobs`; `python -m tests.programs.typed_face` writes it."""

from collections.abc import Mapping, Sequence
from decimal import Decimal
from fractions import Fraction
from typing import Any, TypeAlias, overload

from sympy import Expr, ImmutableMatrix
from sympy.matrices import MatrixBase

from symobs.applications.batch import batch as batch
from symobs.applications.batch.sweep import sweep as sweep
from symobs.applications.checking import check as check
from symobs.applications.variants import variants as variants
from symobs.cli.shared.time_and_memory import bounded as bounded
from symobs.ground.errors import BudgetExceeded as BudgetExceeded
from symobs.ground.errors import CertificateRejected as CertificateRejected
from symobs.ground.errors import DerivationRejected as DerivationRejected
from symobs.ground.errors import ExpressionError as ExpressionError
from symobs.ground.errors import InexactInput as InexactInput
from symobs.ground.errors import InputError as InputError
from symobs.ground.errors import OpenEquality as OpenEquality
from symobs.ground.errors import OutOfBudget as OutOfBudget
from symobs.ground.errors import ProblemErrors as ProblemErrors
from symobs.ground.errors import ShapeMismatch as ShapeMismatch
from symobs.ground.errors import SymobsError as SymobsError
from symobs.ground.errors import TypesettingError as TypesettingError
from symobs.ground.errors import Undecided as Undecided
from symobs.ground.errors import UnknownName as UnknownName
from symobs.ground.errors import UsageError as UsageError
from symobs.live import live as live
from symobs.system import StateSpace as StateSpace
from symobs.system.linearize import linearize as linearize
from symobs.tasks.analysis.equilibria.equilibria import Equilibria as _Equilibria
from symobs.tasks.analysis.lyapunov.lyapunov import LyapunovSolution as _LyapunovSolution
from symobs.tasks.analysis.modes.detectability import Detectability as _Detectability
from symobs.tasks.analysis.modes.detectability import Stabilizability as _Stabilizability
from symobs.tasks.analysis.modes.pbh import PopovBelevitchHautus as _PopovBelevitchHautus
from symobs.tasks.analysis.rank.observability import Controllability as _Controllability
from symobs.tasks.analysis.rank.observability import Observability as _Observability
from symobs.tasks.analysis.realization.canonical_form import CanonicalForm as _CanonicalForm
from symobs.tasks.analysis.realization.characteristic_polynomial import CharacteristicPolynomial as _CharacteristicPolynomial
from symobs.tasks.analysis.realization.dual import Dual as _Dual
from symobs.tasks.analysis.realization.kalman_decomposition import Decomposition as _Decomposition
from symobs.tasks.analysis.realization.transfer_function import TransferFunction as _TransferFunction
from symobs.tasks.analysis.stability_region.stability_region import StabilityRegion as _StabilityRegion
from symobs.tasks.analysis.time_response.gramian import Gramian as _Gramian
from symobs.tasks.analysis.time_response.initial_state import InitialState as _InitialState
from symobs.tasks.analysis.time_response.initial_state_covariance import InitialStateCovariance as _InitialStateCovariance
from symobs.tasks.analysis.time_response.matrix_exponential import MatrixExponential as _MatrixExponential
from symobs.tasks.analysis.time_response.minimum_energy_input import MinimumEnergyInput as _MinimumEnergyInput
from symobs.tasks.analysis.time_response.response_in_time import Response as _Response
from symobs.tasks.analysis.time_varying.time_varying_observability import TimeVaryingObservability as _TimeVaryingObservability
from symobs.tasks.design.compensator.output_feedback import OutputFeedback as _OutputFeedback
from symobs.tasks.design.disturbance.disturbance_observer import DisturbanceObserver as _DisturbanceObserver
from symobs.tasks.design.disturbance.unknown_input_observer import UnknownInputObserver as _UnknownInputObserver
from symobs.tasks.design.full_order.observer import ObserverDesign as _ObserverDesign
from symobs.tasks.design.full_order.state_feedback import StateFeedbackDesign as _StateFeedbackDesign
from symobs.tasks.design.margins.margins import Margins as _Margins
from symobs.tasks.design.optimal.kalman import OptimalFilter as _OptimalFilter
from symobs.tasks.design.optimal.lqr import OptimalFeedback as _OptimalFeedback
from symobs.tasks.design.pole_advice.pole_advice import PoleAdvice as _PoleAdvice
from symobs.tasks.design.reduced_order.reduced_order_observer import ReducedOrderObserver as _ReducedOrderObserver
from symobs.tasks.design.reference.feedforward import FeedforwardDesign as _FeedforwardDesign
from symobs.tasks.design.reference.integral_action import IntegralAction as _IntegralAction
from symobs.tasks.design.reference.output_regulation import OutputRegulation as _OutputRegulation
from symobs.tasks.design.reference.tracking import TrackingDesign as _TrackingDesign
from symobs.tasks.design.root_locus.root_locus import RootLocus as _RootLocus
from symobs.tasks.result.result import Result as _Result

_Number: TypeAlias = str | float | complex | Fraction | Decimal | Expr
_IsPlant: TypeAlias = _CanonicalFormResult | _DecompositionResult | _DualResult | _ZeroOrderHoldResult
_Plant: TypeAlias = StateSpace | _IsPlant | tuple[Sequence[_Number], Sequence[_Number]] | Mapping[str, Any]
_Matrix: TypeAlias = str | Sequence[object] | MatrixBase

TASK_PACKAGES: tuple[str, ...]
FORMAT_PACKAGE: str
PICTURES: str
FUNCTIONS: dict[str, str]
SYNONYMS: dict[str, str]
__version__: str

class _CanonicalFormResult(_CanonicalForm):
    """What `canonical_form` returns."""

    @property
    def kind(self) -> str: ...
    @property
    def T(self) -> ImmutableMatrix: ...
    @property
    def A(self) -> ImmutableMatrix: ...
    @property
    def B(self) -> ImmutableMatrix: ...
    @property
    def C(self) -> ImmutableMatrix: ...
    @property
    def D(self) -> ImmutableMatrix: ...
    @property
    def polynomial(self) -> Expr: ...

def canonical_form(
    plant: _Plant,
    *,
    kind: str | None = None,
    T: _Matrix | None = None,
    method: str = "auto",
    floats: str | None = None,
    pade: int | str | None = None,
) -> _CanonicalFormResult:
    """Return the controllable, observable or modal canonical form, x̄ = T x, or the plant in given coordinates."""

class _CharacteristicPolynomialResult(_CharacteristicPolynomial):
    """What `characteristic_polynomial` returns."""

    @property
    def polynomial(self) -> Expr: ...
    @property
    def factors(self) -> tuple[Any, ...]: ...
    @property
    def roots(self) -> tuple[Any, ...]: ...
    @property
    def stable(self) -> str: ...
    @property
    def stable_if(self) -> tuple[str, ...]: ...

def characteristic_polynomial(
    plant: _Plant,
    *,
    method: str = "auto",
    floats: str | None = None,
    pade: int | str | None = None,
) -> _CharacteristicPolynomialResult:
    """Return χ(s) = det(sI − A), its factors and its roots with multiplicity."""

class _CompensatorResult(_OutputFeedback):
    """What `compensator` returns."""

    @property
    def K(self) -> ImmutableMatrix: ...
    @property
    def L(self) -> ImmutableMatrix: ...
    @property
    def F(self) -> Expr | ImmutableMatrix: ...
    @property
    def F_stable(self) -> str: ...
    @property
    def F_stable_if(self) -> tuple[str, ...]: ...
    @property
    def F_cancels_where(self) -> tuple[Any, ...]: ...
    @property
    def compensator_stable(self) -> str: ...
    @property
    def compensator_matrix(self) -> ImmutableMatrix: ...
    @property
    def closed_loop_polynomial(self) -> Expr: ...
    @property
    def closed_loop(self) -> Expr | ImmutableMatrix: ...
    @property
    def closed_loop_unity(self) -> Expr: ...
    @property
    def closed_loop_matrix(self) -> ImmutableMatrix: ...
    @property
    def closed_loop_matrix_estimate(self) -> ImmutableMatrix: ...
    @property
    def family(self) -> Mapping[str, Any]: ...
    @property
    def T(self) -> ImmutableMatrix: ...
    @property
    def direct_term(self) -> ImmutableMatrix: ...
    @property
    def poles(self) -> tuple[Any, ...]: ...
    @property
    def stable(self) -> str: ...
    @property
    def stable_if(self) -> tuple[Any, ...]: ...

def compensator(
    plant: _Plant,
    *,
    control_poles: str | Sequence[_Number] | Mapping[str, Any] | MatrixBase | None = None,
    control_polynomial: str | Expr | None = None,
    observer_poles: str | Sequence[_Number] | Mapping[str, Any] | MatrixBase | None = None,
    observer_polynomial: str | Expr | None = None,
    K: _Matrix | None = None,
    L: _Matrix | None = None,
    observer: str = "full",
    choose: str = "auto",
    method: str = "auto",
    floats: str | None = None,
    pade: int | str | None = None,
) -> _CompensatorResult:
    """Design the observer-based compensator U = −F(s) Y, with an observer of full order n or of minimal order n − p."""

class _ControllabilityResult(_Controllability):
    """What `controllability` returns."""

    @property
    def matrix(self) -> ImmutableMatrix: ...
    @property
    def rank(self) -> int: ...
    @property
    def kernel(self) -> tuple[Any, ...]: ...
    @property
    def uncontrollable_modes(self) -> tuple[Any, ...]: ...
    @property
    def determinant(self) -> Expr: ...
    @property
    def missing_inputs(self) -> tuple[Any, ...]: ...

def controllability(
    plant: _Plant,
    *,
    method: str = "auto",
    floats: str | None = None,
    pade: int | str | None = None,
) -> _ControllabilityResult:
    """Decide whether (A, B) is controllable: rank [B, AB, …, Aⁿ⁻¹B] = n."""

class _DecompositionResult(_Decomposition):
    """What `decomposition` returns."""

    @property
    def T(self) -> ImmutableMatrix: ...
    @property
    def A(self) -> ImmutableMatrix: ...
    @property
    def B(self) -> ImmutableMatrix: ...
    @property
    def C(self) -> ImmutableMatrix: ...
    @property
    def D(self) -> ImmutableMatrix: ...
    @property
    def sizes(self) -> Mapping[str, Any]: ...
    @property
    def minimal_order(self) -> int: ...
    @property
    def transfer_function(self) -> Expr: ...

def decomposition(
    plant: _Plant,
    *,
    method: str = "auto",
    floats: str | None = None,
    pade: int | str | None = None,
) -> _DecompositionResult:
    """Split a plant into four parts: reached and seen, reached and hidden, not reached and seen, neither."""

class _DetectabilityResult(_Detectability):
    """What `detectability` returns."""

    @property
    def meaning(self) -> str: ...
    @property
    def modes(self) -> tuple[Any, ...]: ...
    @property
    def fixed_polynomial(self) -> Expr: ...
    @property
    def polynomial(self) -> Expr: ...
    @property
    def rank(self) -> int: ...

def detectability(
    plant: _Plant,
    *,
    meaning: str = "asymptotic",
    method: str = "auto",
    floats: str | None = None,
    pade: int | str | None = None,
) -> _DetectabilityResult:
    """Decide whether some L makes A − LC stable: whether all unobservable modes are stable."""

class _DisturbanceObserverResult(_DisturbanceObserver):
    """What `disturbance_observer` returns."""

    @property
    def L_x(self) -> ImmutableMatrix: ...
    @property
    def L_w(self) -> ImmutableMatrix: ...
    @property
    def polynomial(self) -> Expr: ...
    @property
    def A(self) -> ImmutableMatrix: ...
    @property
    def B_u(self) -> ImmutableMatrix: ...
    @property
    def B_y(self) -> ImmutableMatrix: ...
    @property
    def poles(self) -> tuple[Any, ...]: ...
    @property
    def stable(self) -> str: ...
    @property
    def stable_if(self) -> tuple[Any, ...]: ...
    @property
    def fixed_modes(self) -> tuple[Any, ...]: ...
    @property
    def family(self) -> Any: ...

def disturbance_observer(
    plant: _Plant,
    *,
    E: _Matrix | None = None,
    S: _Matrix | None = None,
    V: _Matrix | None = None,
    poles: str | Sequence[_Number] | Mapping[str, Any] | MatrixBase | None = None,
    polynomial: str | Expr | None = None,
    choose: str = "auto",
    method: str = "auto",
    floats: str | None = None,
    pade: int | str | None = None,
) -> _DisturbanceObserverResult:
    """Estimate state and disturbance of ẋ = A x + B u + E d, d = V w, ẇ = S w, by the observer of (x, w)."""

class _DualResult(_Dual):
    """What `dual` returns."""

    @property
    def sign(self) -> int: ...
    @property
    def A(self) -> ImmutableMatrix: ...
    @property
    def B(self) -> ImmutableMatrix: ...
    @property
    def C(self) -> ImmutableMatrix: ...
    @property
    def D(self) -> ImmutableMatrix: ...
    @property
    def observability_rank(self) -> int: ...
    @property
    def dual_controllability_rank(self) -> int: ...
    @property
    def controllability_rank(self) -> int: ...
    @property
    def dual_observability_rank(self) -> int: ...

def dual(
    plant: _Plant,
    *,
    sign: int = 1,
    method: str = "auto",
    floats: str | None = None,
    pade: int | str | None = None,
) -> _DualResult:
    """Return the dual plant (± Aᵀ, Cᵀ, Bᵀ, Dᵀ) and the ranks that are equal by duality."""

class _EquilibriaResult(_Equilibria):
    """What `equilibria` returns."""

    @property
    def points(self) -> tuple[Any, ...]: ...
    @property
    def stable(self) -> tuple[str, ...]: ...
    @property
    def stable_if(self) -> tuple[Any, ...]: ...
    @property
    def complete(self) -> bool: ...

def equilibria(
    plant: _Plant,
    *,
    method: str = "auto",
    floats: str | None = None,
    pade: int | str | None = None,
) -> _EquilibriaResult:
    """Return all x, u with f(x, u) = 0 (f(x, u) = x in discrete time), and whether the linearisation at each is stable."""

class _FeedforwardResult(_FeedforwardDesign):
    """What `feedforward` returns."""

    @property
    def F(self) -> Expr: ...
    @property
    def transfer_function(self) -> Expr: ...
    @property
    def K(self) -> ImmutableMatrix: ...
    @property
    def L(self) -> ImmutableMatrix: ...
    @property
    def polynomial(self) -> Expr: ...
    @property
    def closed_loop_matrix(self) -> ImmutableMatrix: ...

def feedforward(
    plant: _Plant,
    *,
    control_poles: str | Sequence[_Number] | Mapping[str, Any] | MatrixBase | None = None,
    control_polynomial: str | Expr | None = None,
    observer_poles: str | Sequence[_Number] | Mapping[str, Any] | MatrixBase | None = None,
    observer_polynomial: str | Expr | None = None,
    K: _Matrix | None = None,
    observer: str = "full",
    choose: str = "auto",
    method: str = "auto",
    floats: str | None = None,
    pade: int | str | None = None,
) -> _FeedforwardResult:
    """Design F in u = −K x + F v, or −K x̂ + F v, so that y = v at rest:  F = [(C − DK)(−A + BK)⁻¹B + D]⁻¹."""

class _GramianResult(_Gramian):
    """What `gramian` returns."""

    @property
    def matrix(self) -> ImmutableMatrix: ...
    @property
    def determinant(self) -> Expr: ...
    @property
    def finite_sum(self) -> ImmutableMatrix: ...
    @property
    def rank(self) -> int: ...
    @property
    def kernel(self) -> tuple[Any, ...]: ...

def gramian(
    plant: _Plant,
    *,
    horizon: _Number | None = None,
    of: str = "auto",
    method: str = "auto",
    floats: str | None = None,
    pade: int | str | None = None,
) -> _GramianResult:
    """Return the Gramian W = ∫₀ᵀ e^{Aᵀt} Cᵀ C e^{At} dt (of = "controllability": ∫₀ᵀ e^{At} B Bᵀ e^{Aᵀt} dt)."""

class _InitialStateResult(_InitialState):
    """What `initial_state` returns."""

    @property
    def x0(self) -> tuple[Any, ...]: ...
    @property
    def kernel(self) -> tuple[Any, ...]: ...

def initial_state(
    plant: _Plant,
    *,
    output: _Number | _Matrix | None = None,
    input: _Number | _Matrix | None = None,
    horizon: _Number | None = None,
    method: str = "auto",
    floats: str | None = None,
    pade: int | str | None = None,
) -> _InitialStateResult:
    """Return the initial state x₀ of an output y(t) under an input u(t), y = C (e^{At} x₀ + x_f) + D u, or that none exists."""

class _InitialStateCovarianceResult(_InitialStateCovariance):
    """What `initial_state_covariance` returns."""

    @property
    def covariance(self) -> ImmutableMatrix: ...
    @property
    def input_part(self) -> ImmutableMatrix: ...
    @property
    def output_part(self) -> ImmutableMatrix: ...

def initial_state_covariance(
    plant: _Plant,
    *,
    Q: _Number | _Matrix | None = None,
    R: _Number | _Matrix | None = None,
    horizon: _Number | None = None,
    method: str = "auto",
    floats: str | None = None,
    pade: int | str | None = None,
) -> _InitialStateCovarianceResult:
    """Return the covariance Σ of the estimate x̂₀ = W⁻¹ ∫ e^{Aᵀt} Cᵀ y dt under white input noise Q and output noise R."""

class _IntegralActionResult(_IntegralAction):
    """What `integral_action` returns."""

    @property
    def K(self) -> ImmutableMatrix: ...
    @property
    def k_I(self) -> ImmutableMatrix: ...
    @property
    def solvable(self) -> bool: ...
    @property
    def solvable_if(self) -> tuple[str, ...]: ...
    @property
    def polynomial(self) -> Expr: ...
    @property
    def closed_loop_matrix(self) -> ImmutableMatrix: ...
    @property
    def poles(self) -> tuple[Any, ...]: ...
    @property
    def stable(self) -> str: ...
    @property
    def stable_if(self) -> tuple[Any, ...]: ...
    @property
    def fixed_modes(self) -> tuple[Any, ...]: ...
    @property
    def family(self) -> Any: ...

def integral_action(
    plant: _Plant,
    *,
    poles: str | Sequence[_Number] | Mapping[str, Any] | MatrixBase | None = None,
    polynomial: str | Expr | None = None,
    choose: str = "auto",
    method: str = "auto",
    floats: str | None = None,
    pade: int | str | None = None,
) -> _IntegralActionResult:
    """Let y follow constant references by u = −K x + k_I ξ, ξ' = r − y, with n + p given poles."""

class _KalmanResult(_OptimalFilter):
    """What `kalman` returns."""

    @property
    def L(self) -> ImmutableMatrix: ...
    @property
    def P(self) -> ImmutableMatrix: ...
    @property
    def polynomial(self) -> Expr: ...
    @property
    def poles(self) -> tuple[Any, ...]: ...
    @property
    def A(self) -> ImmutableMatrix: ...
    @property
    def B_u(self) -> Any: ...
    @property
    def B_y(self) -> ImmutableMatrix: ...
    @property
    def modes(self) -> tuple[Any, ...]: ...

def kalman(
    plant: _Plant,
    *,
    W: _Number | _Matrix | None = None,
    V: _Number | _Matrix | None = None,
    G: _Matrix | None = None,
    N: _Matrix | None = None,
    method: str = "auto",
    floats: str | None = None,
    pade: int | str | None = None,
) -> _KalmanResult:
    """Return the observer gain with the smallest covariance of the error: the steady-state Kalman filter."""

class _LqrResult(_OptimalFeedback):
    """What `lqr` returns."""

    @property
    def K(self) -> ImmutableMatrix: ...
    @property
    def P(self) -> ImmutableMatrix: ...
    @property
    def polynomial(self) -> Expr: ...
    @property
    def poles(self) -> tuple[Any, ...]: ...
    @property
    def closed_loop_matrix(self) -> ImmutableMatrix: ...
    @property
    def modes(self) -> tuple[Any, ...]: ...

def lqr(
    plant: _Plant,
    *,
    Q: _Number | _Matrix | None = None,
    R: _Number | _Matrix | None = None,
    N: _Matrix | None = None,
    method: str = "auto",
    floats: str | None = None,
    pade: int | str | None = None,
) -> _LqrResult:
    """Return the state feedback u = −K x that minimises ∫ xᵀQx + 2xᵀNu + uᵀRu dt, in discrete time Σ."""

class _LyapunovResult(_LyapunovSolution):
    """What `lyapunov` returns."""

    @property
    def P(self) -> ImmutableMatrix: ...
    @property
    def solvable(self) -> str: ...
    @property
    def positive_definite(self) -> str: ...
    @property
    def positive_if(self) -> tuple[str, ...]: ...
    @property
    def minors(self) -> tuple[Any, ...]: ...
    @property
    def determinant(self) -> Expr: ...
    @property
    def homogeneous(self) -> Any: ...

def lyapunov(
    plant: _Plant,
    *,
    Q: _Number | _Matrix | None = None,
    P: _Number | _Matrix | None = None,
    method: str = "auto",
    floats: str | None = None,
    pade: int | str | None = None,
) -> _LyapunovResult:
    """Solve Lyapunov's equation AᵀP + PA = −Q, in discrete time AᵀPA − P = −Q, for a symmetric P."""

class _MarginsResult(_Margins):
    """What `margins` returns."""

    @property
    def gain_down(self) -> Expr: ...
    @property
    def gain_up(self) -> Expr | str: ...
    @property
    def phase_deg(self) -> str: ...
    @property
    def modulus(self) -> str: ...
    @property
    def peak(self) -> str: ...
    @property
    def slowest(self) -> Expr | str: ...
    @property
    def characteristic_function(self) -> str: ...
    @property
    def open_loop_polynomial(self) -> Expr: ...
    @property
    def open_loop_unstable(self) -> int: ...
    @property
    def closed_loop_unstable(self) -> int: ...
    @property
    def encirclements(self) -> int: ...
    @property
    def axis_crossings(self) -> tuple[Any, ...]: ...
    @property
    def phase_crossover(self) -> tuple[str, ...]: ...
    @property
    def gain_crossover(self) -> tuple[str, ...]: ...
    @property
    def delay_margin(self) -> str: ...
    @property
    def closed_loop_polynomial(self) -> Expr: ...

@overload
def margins(design: _StateFeedbackResult | _ObserverResult | _CompensatorResult | _LqrResult | _KalmanResult) -> _MarginsResult: ...
@overload
def margins(
    plant: _Plant,
    *,
    poles: str | Sequence[_Number] | Mapping[str, Any] | MatrixBase | None = None,
    polynomial: str | Expr | None = None,
    K: _Matrix | None = None,
    control_poles: str | Sequence[_Number] | Mapping[str, Any] | MatrixBase | None = None,
    control_polynomial: str | Expr | None = None,
    observer_poles: str | Sequence[_Number] | Mapping[str, Any] | MatrixBase | None = None,
    observer_polynomial: str | Expr | None = None,
    L: _Matrix | None = None,
    observer: str = "full",
    controller: _Number | None = None,
    method: str = "auto",
    floats: str | None = None,
    pade: int | str | None = None,
) -> _MarginsResult: ...

class _MatrixExponentialResult(_MatrixExponential):
    """What `matrix_exponential` returns."""

    @property
    def matrix(self) -> ImmutableMatrix: ...

def matrix_exponential(
    plant: _Plant,
    *,
    method: str = "auto",
    floats: str | None = None,
    pade: int | str | None = None,
) -> _MatrixExponentialResult:
    """Return e^{At} as a real matrix of exponentials, cosines, sines, cosh, sinh and powers of t; Aᵏ in discrete time."""

class _MinimumEnergyInputResult(_MinimumEnergyInput):
    """What `minimum_energy_input` returns."""

    @property
    def input(self) -> Expr | tuple[Any, ...]: ...
    @property
    def energy(self) -> Expr: ...
    @property
    def gramian(self) -> ImmutableMatrix: ...
    @property
    def unreachable(self) -> Any: ...

def minimum_energy_input(
    plant: _Plant,
    *,
    initial: _Matrix | None = None,
    final: _Matrix | None = None,
    horizon: _Number | None = None,
    method: str = "auto",
    floats: str | None = None,
    pade: int | str | None = None,
) -> _MinimumEnergyInputResult:
    """Return the input of least energy ∫ uᵀu dt (Σ uᵀu) from x₀ to x_f: u = Bᵀ e^{Aᵀ(T−t)} W⁻¹ (x_f − e^{AT} x₀)."""

class _ObservabilityResult(_Observability):
    """What `observability` returns."""

    @property
    def matrix(self) -> ImmutableMatrix: ...
    @property
    def rank(self) -> int: ...
    @property
    def kernel(self) -> tuple[Any, ...]: ...
    @property
    def unobservable_modes(self) -> tuple[Any, ...]: ...
    @property
    def determinant(self) -> Expr: ...
    @property
    def missing_measurements(self) -> tuple[Any, ...]: ...

def observability(
    plant: _Plant,
    *,
    method: str = "auto",
    floats: str | None = None,
    pade: int | str | None = None,
) -> _ObservabilityResult:
    """Decide whether (C, A) is observable: rank [C; CA; …; CAⁿ⁻¹] = n."""

class _ObserverResult(_ObserverDesign):
    """What `observer` returns."""

    @property
    def L(self) -> ImmutableMatrix: ...
    @property
    def polynomial(self) -> Expr: ...
    @property
    def A(self) -> ImmutableMatrix: ...
    @property
    def B_u(self) -> ImmutableMatrix: ...
    @property
    def B_y(self) -> ImmutableMatrix: ...
    @property
    def poles(self) -> tuple[Any, ...]: ...
    @property
    def stable(self) -> str: ...
    @property
    def stable_if(self) -> tuple[str, ...]: ...
    @property
    def fixed_modes(self) -> tuple[Any, ...]: ...
    @property
    def family(self) -> Mapping[str, Any]: ...

def observer(
    plant: _Plant,
    *,
    poles: str | Sequence[_Number] | Mapping[str, Any] | MatrixBase | None = None,
    polynomial: str | Expr | None = None,
    L: _Matrix | None = None,
    zero: str | Sequence[object] | None = None,
    member: str = "simple",
    choose: str = "auto",
    method: str = "auto",
    floats: str | None = None,
    pade: int | str | None = None,
) -> _ObserverResult:
    """Design the full-order observer  x̂' = (A − LC) x̂ + (B − LD) u + L y  with det(sI − A + LC) = φ(s)."""

class _OutputRegulationResult(_OutputRegulation):
    """What `output_regulation` returns."""

    @property
    def Pi(self) -> ImmutableMatrix: ...
    @property
    def Gamma(self) -> ImmutableMatrix: ...
    @property
    def K(self) -> ImmutableMatrix: ...
    @property
    def F(self) -> ImmutableMatrix: ...
    @property
    def solvable(self) -> bool: ...
    @property
    def blocked_modes(self) -> tuple[Any, ...]: ...
    @property
    def fixed_modes(self) -> tuple[Any, ...]: ...
    @property
    def polynomial(self) -> Expr: ...
    @property
    def closed_loop_matrix(self) -> ImmutableMatrix: ...
    @property
    def L(self) -> ImmutableMatrix: ...

def output_regulation(
    plant: _Plant,
    *,
    S: _Matrix | None = None,
    reference: _Matrix | None = None,
    E: _Matrix | None = None,
    poles: str | Sequence[_Number] | Mapping[str, Any] | MatrixBase | None = None,
    polynomial: str | Expr | None = None,
    K: _Matrix | None = None,
    observer_poles: str | Sequence[_Number] | Mapping[str, Any] | MatrixBase | None = None,
    observer_polynomial: str | Expr | None = None,
    choose: str = "auto",
    method: str = "auto",
    floats: str | None = None,
    pade: int | str | None = None,
) -> _OutputRegulationResult:
    """Let y follow r = Q w, ẇ = S w, in spite of a disturbance E w, by u = −K x + (Γ + KΠ) w, ΠS = AΠ + BΓ + E, CΠ + DΓ = Q."""

class _PbhResult(_PopovBelevitchHautus):
    """What `pbh` returns."""

    @property
    def of(self) -> str: ...
    @property
    def modes(self) -> tuple[Any, ...]: ...
    @property
    def fixed_polynomial(self) -> Expr: ...
    @property
    def polynomial(self) -> Expr: ...

def pbh(
    plant: _Plant,
    *,
    of: str = "auto",
    method: str = "auto",
    floats: str | None = None,
    pade: int | str | None = None,
) -> _PbhResult:
    """Test observability (or controllability) eigenvalue by eigenvalue: rank [A − λI; C] = n for all λ."""

class _PoleAdviceResult(_PoleAdvice):
    """What `pole_advice` returns."""

    @property
    def poles(self) -> tuple[Any, ...]: ...
    @property
    def polynomial(self) -> Expr: ...
    @property
    def zeros_used(self) -> tuple[Any, ...]: ...
    @property
    def warnings(self) -> tuple[str, ...]: ...
    @property
    def sigma(self) -> Expr: ...
    @property
    def omega_d(self) -> Expr: ...

def pole_advice(
    plant: _Plant,
    *,
    radius: _Number | None = None,
    settling_time: _Number | None = None,
    overshoot: _Number | None = None,
    method: str = "auto",
    floats: str | None = None,
    pade: int | str | None = None,
) -> _PoleAdviceResult:
    """Advise observer poles: at the stable zeros of the plant, the rest on a circle or as a dominant pair."""

class _ReducedOrderObserverResult(_ReducedOrderObserver):
    """What `reduced_order_observer` returns."""

    @property
    def L(self) -> ImmutableMatrix: ...
    @property
    def T(self) -> ImmutableMatrix: ...
    @property
    def F(self) -> ImmutableMatrix: ...
    @property
    def G(self) -> ImmutableMatrix: ...
    @property
    def H(self) -> ImmutableMatrix: ...
    @property
    def M(self) -> ImmutableMatrix: ...
    @property
    def polynomial(self) -> Expr: ...
    @property
    def poles(self) -> tuple[Any, ...]: ...
    @property
    def fixed_modes(self) -> tuple[Any, ...]: ...
    @property
    def family(self) -> Any: ...

def reduced_order_observer(
    plant: _Plant,
    *,
    poles: str | Sequence[_Number] | Mapping[str, Any] | MatrixBase | None = None,
    polynomial: str | Expr | None = None,
    T: _Matrix | None = None,
    choose: str = "auto",
    method: str = "auto",
    floats: str | None = None,
    pade: int | str | None = None,
) -> _ReducedOrderObserverResult:
    """Design the observer of order n − p  ż = F z + G u + H y,  x̂ = M [y − D u; z],  with det(sI − F) = φ(s)."""

class _ResponseResult(_Response):
    """What `response` returns."""

    @property
    def state(self) -> ImmutableMatrix: ...
    @property
    def output(self) -> ImmutableMatrix: ...

def response(
    plant: _Plant,
    *,
    initial: _Matrix | None = None,
    input: _Number | _Matrix | None = None,
    impulse: _Matrix | None = None,
    at_time: _Number | None = None,
    method: str = "auto",
    floats: str | None = None,
    pade: int | str | None = None,
) -> _ResponseResult:
    """Return the response x(t) = e^{At} x₀ + ∫₀ᵗ e^{A(t−s)} B u(s) ds and y = C x + D u to an initial state and an input."""

class _RootLocusResult(_RootLocus):
    """What `root_locus` returns."""

    @property
    def polynomial(self) -> Expr: ...
    @property
    def poles(self) -> tuple[Any, ...]: ...
    @property
    def zeros(self) -> tuple[Any, ...]: ...
    @property
    def asymptotes(self) -> Mapping[str, Any]: ...
    @property
    def breakaway(self) -> tuple[Any, ...]: ...
    @property
    def crossings(self) -> tuple[Any, ...]: ...
    @property
    def departure(self) -> tuple[Any, ...]: ...
    @property
    def arrival(self) -> tuple[Any, ...]: ...
    @property
    def stable_if(self) -> tuple[str, ...]: ...

def root_locus(
    plant: _Plant,
    *,
    controller: _Number | None = None,
    gain_sign: int = 1,
    method: str = "auto",
    floats: str | None = None,
    pade: int | str | None = None,
) -> _RootLocusResult:
    """Return the root locus of 1 + k C(s)G(s): the roots of p + k q for k from 0, with landmarks that are exact."""

class _StabilityRegionResult(_StabilityRegion):
    """What `stability_region` returns."""

    @property
    def polynomial(self) -> Expr: ...
    @property
    def parameters(self) -> tuple[str, ...]: ...
    @property
    def routh_table(self) -> tuple[Any, ...]: ...
    @property
    def irredundant(self) -> bool: ...
    @property
    def bounded(self) -> bool: ...
    @property
    def components(self) -> tuple[Any, ...]: ...
    @property
    def sample_points(self) -> tuple[Any, ...]: ...
    @property
    def cells(self) -> tuple[Any, ...]: ...
    @property
    def excluded_points(self) -> tuple[Any, ...]: ...
    @property
    def excluded_curves(self) -> tuple[Any, ...]: ...
    @property
    def intervals(self) -> tuple[Any, ...]: ...
    @property
    def intervals_decimal(self) -> tuple[Any, ...]: ...

def stability_region(
    plant: _Plant | object = None, symbols: Mapping[str, Any] | None = None, dt: object = 0,
    *,
    polynomial: str | Expr | None = None,
    K: _Matrix | None = None,
    L: _Matrix | None = None,
    controller: _Number | None = None,
    parameters: str | Sequence[str] | None = None,
    margin: _Number | None = None,
    radius: _Number | None = None,
    method: str = "auto",
    floats: str | None = None,
    pade: int | str | None = None,
) -> _StabilityRegionResult:
    """Find the parameters for which all roots of χ are stable: exact inequalities, intervals, cells of the plane."""

class _StabilizabilityResult(_Stabilizability):
    """What `stabilizability` returns."""

    @property
    def meaning(self) -> str: ...
    @property
    def modes(self) -> tuple[Any, ...]: ...
    @property
    def fixed_polynomial(self) -> Expr: ...
    @property
    def polynomial(self) -> Expr: ...
    @property
    def rank(self) -> int: ...

def stabilizability(
    plant: _Plant,
    *,
    meaning: str = "asymptotic",
    method: str = "auto",
    floats: str | None = None,
    pade: int | str | None = None,
) -> _StabilizabilityResult:
    """Decide whether some K makes A − BK stable: whether all uncontrollable modes are stable."""

class _StateFeedbackResult(_StateFeedbackDesign):
    """What `state_feedback` returns."""

    @property
    def K(self) -> ImmutableMatrix: ...
    @property
    def polynomial(self) -> Expr: ...
    @property
    def closed_loop_matrix(self) -> ImmutableMatrix: ...
    @property
    def poles(self) -> tuple[Any, ...]: ...
    @property
    def stable(self) -> str: ...
    @property
    def stable_if(self) -> tuple[str, ...]: ...
    @property
    def fixed_modes(self) -> tuple[Any, ...]: ...
    @property
    def family(self) -> Mapping[str, Any]: ...

def state_feedback(
    plant: _Plant,
    *,
    poles: str | Sequence[_Number] | Mapping[str, Any] | MatrixBase | None = None,
    polynomial: str | Expr | None = None,
    K: _Matrix | None = None,
    zero: str | Sequence[object] | None = None,
    member: str = "simple",
    choose: str = "auto",
    method: str = "auto",
    floats: str | None = None,
    pade: int | str | None = None,
) -> _StateFeedbackResult:
    """Design state feedback  u = −K x  with det(sI − A + BK) = φ(s)."""

class _TimeVaryingObservabilityResult(_TimeVaryingObservability):
    """What `time_varying_observability` returns."""

    @property
    def stack(self) -> tuple[Any, ...]: ...
    @property
    def matrix(self) -> ImmutableMatrix: ...
    @property
    def rank(self) -> int: ...
    @property
    def kernel(self) -> tuple[Any, ...]: ...
    @property
    def transition_matrix(self) -> ImmutableMatrix: ...
    @property
    def gramian(self) -> ImmutableMatrix: ...
    @property
    def determinant(self) -> Expr: ...
    @property
    def x0(self) -> tuple[Any, ...]: ...

def time_varying_observability(
    plant: _Plant,
    *,
    interval: str | Sequence[_Number] | None = None,
    output: _Number | _Matrix | None = None,
    input: _Number | _Matrix | None = None,
    method: str = "auto",
    floats: str | None = None,
    pade: int | str | None = None,
) -> _TimeVaryingObservabilityResult:
    """Decide whether ẋ = A(t) x, y = C(t) x is observable, by N₀ = C, N_{k+1} = N_k A + N_k'."""

class _TrackingResult(_TrackingDesign):
    """What `tracking` returns."""

    @property
    def K(self) -> ImmutableMatrix: ...
    @property
    def K_d(self) -> ImmutableMatrix: ...
    @property
    def solvable(self) -> bool: ...
    @property
    def L(self) -> ImmutableMatrix: ...
    @property
    def error_matrix(self) -> ImmutableMatrix: ...
    @property
    def polynomial(self) -> Expr: ...

def tracking(
    plant: _Plant,
    *,
    control_poles: str | Sequence[_Number] | Mapping[str, Any] | MatrixBase | None = None,
    control_polynomial: str | Expr | None = None,
    observer_poles: str | Sequence[_Number] | Mapping[str, Any] | MatrixBase | None = None,
    observer_polynomial: str | Expr | None = None,
    reference_matrix: _Matrix | None = None,
    reference_start: _Matrix | None = None,
    observer: str = "minimal",
    choose: str = "auto",
    method: str = "auto",
    floats: str | None = None,
    pade: int | str | None = None,
) -> _TrackingResult:
    """Track ẋ_d = A_d x_d by u = K (x_d − x̂) − K_d x_d, where A_d − A + BK_d = 0 has a solution."""

class _TransferFunctionResult(_TransferFunction):
    """What `transfer_function` returns."""

    @property
    def transfer_function(self) -> Expr: ...
    @property
    def poles(self) -> tuple[Any, ...]: ...
    @property
    def zeros(self) -> tuple[Any, ...]: ...

def transfer_function(
    plant: _Plant,
    *,
    method: str = "auto",
    floats: str | None = None,
    pade: int | str | None = None,
) -> _TransferFunctionResult:
    """Return P(s) = C (sI − A)⁻¹ B + D in lowest terms, with its poles and zeros."""

class _UnknownInputObserverResult(_UnknownInputObserver):
    """What `unknown_input_observer` returns."""

    @property
    def H(self) -> ImmutableMatrix: ...
    @property
    def T(self) -> ImmutableMatrix: ...
    @property
    def L(self) -> ImmutableMatrix: ...
    @property
    def F(self) -> ImmutableMatrix: ...
    @property
    def B_u(self) -> ImmutableMatrix: ...
    @property
    def B_y(self) -> ImmutableMatrix: ...
    @property
    def solvable(self) -> bool: ...
    @property
    def polynomial(self) -> Expr: ...
    @property
    def poles(self) -> tuple[Any, ...]: ...
    @property
    def stable(self) -> str: ...
    @property
    def stable_if(self) -> tuple[Any, ...]: ...
    @property
    def fixed_modes(self) -> tuple[Any, ...]: ...
    @property
    def family(self) -> Mapping[str, Any]: ...

def unknown_input_observer(
    plant: _Plant,
    *,
    E: _Matrix | None = None,
    poles: str | Sequence[_Number] | Mapping[str, Any] | MatrixBase | None = None,
    polynomial: str | Expr | None = None,
    choose: str = "auto",
    method: str = "auto",
    floats: str | None = None,
    pade: int | str | None = None,
) -> _UnknownInputObserverResult:
    """Estimate the state of ẋ = A x + B u + E d irrespective of d by  ż = F z + B_u u + B_y y,  x̂ = z + H (y − D u)."""

class _ZeroOrderHoldResult(_Result):
    """What `zero_order_hold` returns."""

    @property
    def A(self) -> ImmutableMatrix: ...
    @property
    def B(self) -> ImmutableMatrix: ...
    @property
    def C(self) -> ImmutableMatrix: ...
    @property
    def D(self) -> ImmutableMatrix: ...
    @property
    def stable_if(self) -> tuple[str, ...]: ...
    @property
    def transfer_function(self) -> Expr: ...

def zero_order_hold(
    plant: _Plant,
    *,
    sampling_period: _Number | None = None,
    rule: str | None = None,
    controller: _Number | None = None,
    method: str = "auto",
    floats: str | None = None,
    pade: int | str | None = None,
) -> _ZeroOrderHoldResult:
    """Return the plant behind a zero-order hold, x_{k+1} = A_d x_k + B_d u_k, with A_d = e^{AT}, B_d = ∫₀ᵀ e^{At} B dt."""
