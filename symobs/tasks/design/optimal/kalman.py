"""The steady-state Kalman filter: the observer gain with the smallest covariance of the error, dual to the regulator."""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING, Any, ClassVar

from symobs.exact import Matrix
from symobs.exact.floating.riccati import Enclosure, digits_after_measurement
from symobs.exact.floating.riccati_check import Regulator
from symobs.ground.dataclass import dataclass
from symobs.ground.errors import ShapeMismatch
from symobs.system import read_matrix
from symobs.system.specification import from_list, read_gain
from symobs.tasks.design.full_order.observer import ObserverDesign
from symobs.tasks.design.optimal.optimal_gain import OptimalGain, design_optimal, in_normal_form
from symobs.tasks.design.optimal.optimal_page import write_optimal
from symobs.tasks.result import Result, method, page_of, task
from symobs.tasks.result.control_systems import Controller, observer_of

if TYPE_CHECKING:
    from collections.abc import Mapping

    from symobs.system import StateSpace
    from symobs.system.conditions import Condition
    from symobs.system.specification import Intensity, MatrixText, Name


@dataclass
class OptimalFilter(OptimalGain):
    """L and P with AP + PAᵀ + GWGᵀ = LVLᵀ and LV = PCᵀ; in discrete time APAᵀ − P + GWGᵀ = L(V + CPCᵀ)Lᵀ."""

    task: ClassVar[str] = "kalman"
    answered_by = ("L",)
    only_value = ("L", "P")
    claimed = ("L",)
    letters = {"L": "L", "P": "P_x", "polynomial": "chi_L", "poles": "chi_L"}
    cards = ("L", "P", "polynomial")
    letter: ClassVar[str] = "L"
    design_kind = ObserverDesign
    of_loop = ("A", "B_u", "B_y")

    @staticmethod
    def regulator_of(plant: StateSpace, weights: Mapping[str, Matrix]) -> Regulator:
        """Return the regulator of (Aᵀ, Cᵀ) with the weights GWGᵀ and V."""
        m, G = plant.matrices, weights["G"]
        crossed = (G @ weights["N"]).normal()
        return Regulator(m.A.T, m.C.T, (G @ weights["W"] @ G.T).normal(), weights["V"], crossed, plant.is_discrete)

    @staticmethod
    def equations(*, discrete: bool, cross: bool = True) -> tuple[str, str]:
        """Return Riccati's equation and that of L; `shared` is G N."""
        beside = " + shared" if cross else ""
        if discrete:
            return "A*P*A.T - P + noise = L*(V + C*P*C.T)*L.T", f"L*(V + C*P*C.T) = A*P*C.T{beside}"
        return "A*P + P*A.T + noise = L*V*L.T", f"L*V = P*C.T{beside}"

    @cached_property
    def fields(self) -> Mapping[str, Any]:
        """Those of the gain; in discrete time also gain and covariance after the measurement."""
        if not self.plant.is_discrete:
            return super().fields
        P, C = self.answer["P"], self.plant.matrices.C
        gain = covariance = None
        if P is not None:
            gain = in_normal_form((C @ P @ C.T + self.weights["V"]).solve(C @ P)).T
            covariance = in_normal_form(P - gain @ C @ P)
        return {**super().fields, "L_filter": gain, "P_filter": covariance}

    def _decimals(self, digits: Enclosure | None) -> dict[str, Any]:
        found = super()._decimals(digits)
        if digits is not None and self.plant.is_discrete:
            after = digits_after_measurement(digits, self.plant.matrices.C, self.weights["V"])
            if after is not None:
                found |= {name: [*map(list, rows)] for name, rows in zip(("L_filter", "P_filter"), after, strict=True)}
        return found

    @property
    def controller(self) -> Controller | None:
        """(u, y) → x̂."""
        return observer_of(self)


page_of(OptimalFilter)(write_optimal)


@method("kalman/riccati", source="kalman1961; kucera1972")
def by_riccati(plant: StateSpace, weights: Mapping[str, Matrix], needed: tuple[Condition, ...] = ()) -> OptimalFilter:
    """Solve Riccati's equation of the dual regulator for P; then L = PCᵀV⁻¹."""
    return OptimalFilter.of(plant, weights, "riccati", needed)


@task
def kalman(
    plant: StateSpace,
    *,
    W: Intensity = None,
    V: Intensity = None,
    G: MatrixText = None,
    N: MatrixText = None,
    method: Name = "auto",
) -> Result:
    """Return the observer gain with the smallest covariance of the error: the steady-state Kalman filter.

    plant    ẋ = Ax + Bu + Gw, y = Cx + Du + v (x_{k+1} in discrete time), n states, p outputs
    W        intensity (in discrete time covariance) of w, symmetric, positive semidefinite; q stands for q I
    V        p×p, that of v, symmetric, positive definite; r stands for r I
    G        n×k, what w acts through; I where it is left out
    N        k×p, E[w vᵀ], with GWGᵀ − GN V⁻¹ (GN)ᵀ positive semidefinite; 0 where it is left out: w and v are independent
    Returns L (with x̂′ = A x̂ + Bu + L(y − C x̂ − Du); in discrete time the predictor's, from y(k) to x̂(k + 1)), P (the
    covariance of the error, in discrete time of x(k) − x̂(k) before y(k) is known; the stabilising solution of Riccati's
    equation), in discrete time L_filter = P Cᵀ(C P Cᵀ + V)⁻¹ and P_filter = P − L_filter C P after y(k) is known,
    A − LC, B − LD and L as A, B_u and B_y, polynomial and poles of A − LC: exact where square roots write them, else None;
    `decimals` with certain digits of L and P where the data are numbers; verdict `no` with the `modes` that the output does
    not show, or that lie on the boundary and are not driven by the noise;
    undecided, with the `question`, where with parameters no square roots write P.
    A sign that a parameter alone in the diagonal of W or V needs is a condition.
    Raises `InputError` for intensities of other signs, `ShapeMismatch`; `Undecided` for too many states.
    Source: R. E. Kalman and R. S. Bucy (1961); V. Kučera (1972).
    """
    plant = plant.knowing(W, V, G, N)
    plant.require("C", task="kalman")
    entering = Matrix.identity(plant.order) if G is None else _read_entering(G, plant)
    given, shape = {"W": (W, entering.shape[1]), "V": (V, plant.outputs)}, (entering.shape[1], plant.outputs)
    shared = Matrix.zeros(*shape) if N is None else read_gain(N, plant, "N", shape)
    return design_optimal(OptimalFilter, plant, given, {"G": entering, "N": shared}, method)


def _read_entering(value: object, plant: StateSpace) -> Matrix:
    """Return G with as many rows as there are states; raises `ShapeMismatch`."""
    found = read_matrix(from_list(value, column=True), plant.symbols.seen(value), "specification.G")
    if found.shape[0] != plant.order:
        message = f"G is {found.shape[0]}×{found.shape[1]}, expected {plant.order} rows"
        raise ShapeMismatch(message, where="specification.G", repair="write a row for each state")
    return found
