"""The linear-quadratic regulator: u = −K x minimises the integral (the sum) of xᵀQx + 2xᵀNu + uᵀRu."""

from __future__ import annotations

from typing import TYPE_CHECKING, ClassVar

from symobs.exact import Matrix
from symobs.exact.floating.riccati_check import Regulator
from symobs.ground.dataclass import dataclass
from symobs.system.specification import read_gain
from symobs.tasks.design.full_order.state_feedback import StateFeedbackDesign
from symobs.tasks.design.optimal.optimal_gain import OptimalGain, design_optimal
from symobs.tasks.design.optimal.optimal_page import write_optimal
from symobs.tasks.result import Result, method, page_of, task

if TYPE_CHECKING:
    from collections.abc import Mapping

    from symobs.system import StateSpace
    from symobs.system.conditions import Condition
    from symobs.system.specification import Intensity, MatrixText, Name


@dataclass
class OptimalFeedback(OptimalGain):
    """K and P with AᵀP + PA + Q = KᵀRK and RK = BᵀP + Nᵀ; in discrete time AᵀPA − P + Q = Kᵀ(R + BᵀPB)K."""

    task: ClassVar[str] = "lqr"
    answered_by = ("K",)
    only_value = ("K", "P")
    claimed = ("K",)
    letters = {"K": "K", "P": "P_x", "polynomial": "chi_K", "poles": "chi_K"}
    cards = ("K", "P", "polynomial")
    letter: ClassVar[str] = "K"
    design_kind = StateFeedbackDesign
    of_loop = ("closed_loop_matrix",)

    @staticmethod
    def regulator_of(plant: StateSpace, weights: Mapping[str, Matrix]) -> Regulator:
        """Return the problem itself."""
        m = plant.matrices
        return Regulator(m.A, m.B, weights["Q"], weights["R"], weights["N"], plant.is_discrete)

    @staticmethod
    def equations(*, discrete: bool, cross: bool = True) -> tuple[str, str]:
        """Return Riccati's equation and that of K."""
        coupled = ("B.T*P*A" if discrete else "B.T*P") + (" + N.T" if cross else "")
        if discrete:
            return "A.T*P*A - P + Q = K.T*(R + B.T*P*B)*K", f"(R + B.T*P*B)*K = {coupled}"
        return "A.T*P + P*A + Q = K.T*R*K", f"R*K = {coupled}"


page_of(OptimalFeedback)(write_optimal)


@method("lqr/riccati", source="kalman1960b; kucera1972")
def by_riccati(plant: StateSpace, weights: Mapping[str, Matrix], needed: tuple[Condition, ...] = ()) -> OptimalFeedback:
    """Solve Riccati's equation for P by the stable factor of the polynomial of H; then K = R⁻¹(BᵀP + Nᵀ)."""
    return OptimalFeedback.of(plant, weights, "riccati", needed)


@task
def lqr(
    plant: StateSpace,
    *,
    Q: Intensity = None,
    R: Intensity = None,
    N: MatrixText = None,
    method: Name = "auto",
) -> Result:
    """Return the state feedback u = −K x that minimises ∫ xᵀQx + 2xᵀNu + uᵀRu dt, in discrete time Σ.

    plant    n states, m inputs
    Q        n×n, symmetric, positive semidefinite; q stands for q I
    R        m×m, symmetric, positive definite; r stands for r I
    N        n×m, a cross weight with Q − N R⁻¹ Nᵀ positive semidefinite; 0 where it is left out
    Returns K, P (the stabilising solution of Riccati's equation: the least cost from x₀ is x₀ᵀ P x₀), polynomial and poles of
    A − BK: exact where square roots write them, else None; `decimals` with certain digits of K and P where the data are
    numbers; verdict `no` with the `modes` that no input moves, or that lie on the boundary and are hidden from the cost;
    undecided, with the `question`, where with parameters no square roots write P.
    A sign that a parameter alone in the diagonal of Q or R needs is a condition.
    Raises `InputError` for weights of other signs, `ShapeMismatch`; `Undecided` for too many states.
    Source: R. E. Kalman (1960); V. Kučera (1972); S. S. L. Chang (1961), A. M. Letov (1960).
    """
    plant = plant.knowing(Q, R, N)
    plant.require("B", task="lqr")
    n, m = plant.order, plant.inputs
    cross = Matrix.zeros(n, m) if N is None else read_gain(N, plant, "N", (n, m))
    return design_optimal(OptimalFeedback, plant, {"Q": (Q, n), "R": (R, m)}, {"N": cross}, method)
