"""The compensator with a minimal-order observer: u = −K x̂ with ż = F z + G u + H y,  x̂ = M [y − D u; z].

With K M = [N K₂] the control law is u = −N (y − D u) − K₂ z: what the outputs show acts at once, so F(s) has a direct term.
"""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING, Any, Self

from symobs.exact import Matrix, Scalar, transfer
from symobs.exact.linear_algebra.transfer_function import Realisation
from symobs.formula.tree import Environment
from symobs.formula.tree.term import identity
from symobs.ground.dataclass import dataclass
from symobs.ground.errors import CertificateRejected
from symobs.ground.on_demand import OnDemand
from symobs.system.conditions import Condition, joined, nonzero, vanishing_factors
from symobs.tasks.analysis.strata.strata import places, solved
from symobs.tasks.design.compensator.output_feedback import Asked, OutputFeedback
from symobs.tasks.design.full_order.state_feedback import StateFeedbackDesign
from symobs.tasks.design.gain.gain_cases import half_of
from symobs.tasks.design.gain.gain_design import letters_of
from symobs.tasks.design.reduced_order.reduced_order_observer import ReducedOrderObserver, reduced_observer_of
from symobs.tasks.result import holds

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence

    from symobs.proof.certificate.claims import Claim
    from symobs.system import StateSpace
    from symobs.tasks.analysis.strata.strata import Place
    from symobs.tasks.result import Case


@dataclass
class MinimalOrderCompensator(OutputFeedback):
    """Both gains and F(s) = (I + K₂ (sI − F)⁻¹ G − N D)⁻¹ (K₂ (sI − F)⁻¹ H + N), K M = [N K₂].

    Where det(I − N D) = 0 the control law cannot be solved for u, and there is no F.
    """

    estimator: ReducedOrderObserver

    @classmethod
    def design(cls, plant: StateSpace, asked: Sequence[Asked], name: str) -> Self:
        """Return the compensator for these polynomials, or with this K, in the coordinates [C; R]."""
        control, observer = asked
        assert not isinstance(observer, Matrix)  # noqa: S101 - the task takes no L of a reduced-order observer
        return cls.of(half_of(StateFeedbackDesign, plant, control), reduced_observer_of(plant, observer), name)

    @classmethod
    def of(cls, feedback: StateFeedbackDesign, estimator: ReducedOrderObserver, method_name: str) -> Self:
        """Return the compensator of two designs for one plant."""
        K, L = feedback.answer["K"], estimator.answer["L"]
        answer: dict[str, Any] = {"K": K, "L": L, "F": None}
        plant = feedback.plant
        have = K is not None and L is not None
        if have and not plant.simplified(well_posedness(plant, K, estimator).numerator).is_zero:
            answer["F"] = _function(plant, K, estimator)
        return cls(plant, method_name, answer, feedback, estimator)

    @property
    def has_reduced_observer(self) -> bool:
        """The estimator is one."""
        return True

    def claims(self) -> Iterator[Claim]:
        """Yield: K and L are the certified gains; F is what u = −K x̂ makes of y, or the law cannot be solved for u."""
        have = self.feedback.answer["K"] is not None and self.estimator.answer["L"] is not None
        if self.exists and not have:
            raise CertificateRejected("there is no compensator without both gains")
        observer = self.estimator.answer
        known = {"F_z": observer["F"], "G_z": observer["G"], "H_z": observer["H"], "M_z": observer["M"]}
        values = letters_of(self.plant) | {"K": self.answer["K"], "L": self.answer["L"], "F": self.answer["F"]} | known
        e = Environment(variable=self.plant.variable, values=values | {"D": self.plant.matrices.D})
        yield from self.certified(e)
        if not have:
            return
        direct, rest = split(self.answer["K"], self.estimator)
        e = e.extended_by(values={"N": direct, "K_2": rest})
        N, K_2, D = (e[name] for name in ("N", "K_2", "D"))
        yield holds(e, "K M_z = [N, K_2]")
        one = identity(self.plant.inputs, e)
        if not self.exists:
            yield holds(e, "det(I - N D) = 0")
            return
        F_z, G = e["F_z"], e["G_z"]
        resolvent = F_z.pencil.inverse
        loop = one + K_2 @ resolvent @ G
        if self.plant.matrices.has_feedthrough:
            loop = loop - N @ D
        yield holds(e, "F = {inverse} (K_2 pencil(F_z)^-1 H_z + N)", inverse=loop.inverse)

    @cached_property
    def well_posedness(self) -> Scalar:
        """det(I − N D): where it is 0 the control law cannot be solved for u."""
        return well_posedness(self.plant, self.answer["K"], self.estimator)

    @property
    def existence(self) -> tuple[Scalar, ...]:
        """What decides, besides the two gains, where there is a compensator."""
        return (self.well_posedness,) if self.exists else ()

    @cached_property
    def holds_where(self) -> tuple[Condition, ...]:
        """The conditions of both gains, and that the control law can be solved for u."""
        factors = vanishing_factors([value.numerator for value in self.existence], self.plant.symbols.signs)
        return joined(super().holds_where, nonzero("existence", factors))

    @property
    def _estimator_places(self) -> tuple[Place, ...]:
        """The strata of the observer, and those where the control law cannot be solved for u."""
        return (*self.estimator.places, *self._ill_posed_places)

    @cached_property
    def _ill_posed_places(self) -> tuple[Place, ...]:
        return places(self.plant, [value.numerator for value in self.existence])

    @cached_property
    def ill_posed(self) -> tuple[Case, ...]:
        """The strata where the control law cannot be solved for u."""
        return solved(self.plant, self._ill_posed_places, self.on)

    @property
    def other_gains_may_do(self) -> bool:
        """Whether both gains exist, not both are the only ones, and the law cannot be solved for u with these."""
        gains = (self.feedback, self.estimator)
        many = self.plant.inputs > 1 or self.plant.outputs > 1
        found = None not in (self.answer["K"], self.answer["L"])
        return not self.exists and found and many and any(design.desired is not None for design in gains)

    # -- what follows ------------------------------------------------------------------------------------------------

    @cached_property
    def split(self) -> tuple[Matrix, Matrix]:
        """N and K₂."""
        return split(self.answer["K"], self.estimator)

    @property
    def coupling(self) -> Matrix:
        """K₂."""
        return self.split[1]

    @property
    def error_input(self) -> tuple[Matrix, Matrix]:
        """G and I − N D."""
        direct = Matrix.identity(self.plant.inputs) - self.split[0] @ self.plant.matrices.D
        return self.estimator.answer["G"], direct.normal()

    @cached_property
    def realisation(self) -> Realisation:
        """F − G W K₂, H − G W N, W K₂, W N, with W = (I − N D)⁻¹."""
        return _realised(self.plant, self.answer["K"], self.estimator)

    @cached_property
    def own_transfer(self) -> tuple[Scalar, Scalar]:
        """K₂ adj(sI − F) H + φ_o N and φ_o det(I − N D) + K₂ adj(sI − F) G, nothing cancelled between them."""
        return _own_transfer(self.plant, self.answer["K"], self.estimator)

    @cached_property
    def error_coordinates(self) -> Matrix:
        """[A − BK, BK₂; 0, F] in (x, e₂)."""
        m, K = self.plant.matrices, self.answer["K"]
        _, K_2 = self.split
        F = self.estimator.answer["F"]
        return Matrix.block([[m.A - m.B @ K, m.B @ K_2], [Matrix.zeros(F.shape[0], self.plant.order), F]])

    @cached_property
    def estimate_coordinates(self) -> Matrix:
        """[A − BNC, −BK₂; HC − (G + HD) NC, F − (G + HD) K₂] in (x, z)."""
        m, (N, K_2), known = self.plant.matrices, self.split, self.estimator.answer
        driven = known["G"] + known["H"] @ m.D
        return Matrix.block(
            [
                [m.A - m.B @ N @ m.C, -(m.B @ K_2)],
                [(known["H"] - driven @ N) @ m.C, known["F"] - driven @ K_2],
            ]
        )

    @cached_property
    def fields(self) -> Mapping[str, Any]:
        """The fields of the contract, the coordinates and the direct term."""
        fields = super().fields
        if not isinstance(fields, OnDemand):
            return fields
        return fields.with_further({"T": lambda: self.estimator.answer["T"], "direct_term": lambda: self.realisation.D})

    @property
    def free_signals(self) -> Mapping[str, int]:
        """The estimate of x₂."""
        return self.estimator.free_signals


def split(K: Matrix, estimator: ReducedOrderObserver) -> tuple[Matrix, Matrix]:
    """Return N and K₂ with K M = [N K₂]."""
    product = (K @ estimator.answer["M"]).normal()
    outputs, inputs = estimator.plant.outputs, range(K.shape[0])
    return product.select(inputs, range(outputs)), product.select(inputs, range(outputs, product.shape[1]))


def well_posedness(plant: StateSpace, K: Matrix, estimator: ReducedOrderObserver) -> Scalar:
    """Return det(I − N D)."""
    N, _ = split(K, estimator)
    return (Matrix.identity(plant.inputs) - N @ plant.matrices.D).determinant()


def _realised(plant: StateSpace, K: Matrix, estimator: ReducedOrderObserver) -> Realisation:
    """Return F in state space."""
    N, K_2 = split(K, estimator)
    F, G, H = (estimator.answer[name] for name in "FGH")
    W = (Matrix.identity(plant.inputs) - N @ plant.matrices.D).inverse()
    direct, through = (W @ N).normal(), (W @ K_2).normal()
    return Realisation((F - G @ through).normal(), (H - G @ direct).normal(), through, direct)


def _function(plant: StateSpace, K: Matrix, estimator: ReducedOrderObserver) -> Scalar | Matrix:
    """Return F(s)."""
    if plant.inputs == plant.outputs == 1:
        numerator, denominator = _own_transfer(plant, K, estimator)
        return numerator / denominator
    return _realised(plant, K, estimator).function(plant.variable)


def _own_transfer(plant: StateSpace, K: Matrix, estimator: ReducedOrderObserver) -> tuple[Scalar, Scalar]:
    """Return K₂ adj(sI − F) H + φ_o N and φ_o (1 − N D) + K₂ adj(sI − F) G."""
    N, K_2 = split(K, estimator)
    F, G, H = (estimator.answer[name] for name in "FGH")
    direct = N[0, 0]
    above, _ = transfer(F, H, K_2, direct, plant.variable)
    below, _ = transfer(F, G, K_2, 1 - direct * plant.matrices.D[0, 0], plant.variable)
    return above, below
