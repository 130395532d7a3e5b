"""Tracking of a reference ẋ_d = A_d x_d:  u = K (x_d − x̂) − K_d x_d,  error e_d = x_d − x.

ė_d = (A − BK) e_d + (A_d − A + BK_d) x_d − BK e, so the reference has no part in the error where A_d − A + BK_d = 0.
"""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING, Any, ClassVar, Self

from symobs.exact import Matrix, Scalar, independent_rows, solve_or_refute
from symobs.formula.tree import Environment
from symobs.formula.tree.term import block
from symobs.ground.dataclass import dataclass
from symobs.ground.errors import CertificateRejected, InputError
from symobs.proof.certificate.claims import Certificate, Claim
from symobs.proof.derivation.builder import Builder, relation
from symobs.system.conditions import joined
from symobs.system.specification import read_gain
from symobs.tasks.analysis.page_parts import formula_of_factored, in_blocks
from symobs.tasks.analysis.strata.strata import common_places, places, solved
from symobs.tasks.design.compensator.compensator import observer_based, observer_order
from symobs.tasks.design.compensator.compensator_page import caution_law
from symobs.tasks.design.compensator.minimal_order_compensator_page import (
    is_ill_posed,
    partitioned_gain,
    write_both_gains,
)
from symobs.tasks.design.gain.gain_design import letters_of
from symobs.tasks.design.page_parts import draw_tracking
from symobs.tasks.design.reduced_order.reduced_order_observer import ReducedOrderObserver
from symobs.tasks.result import Case, Result, choose, equality, method, page_of, poles_of, task

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from symobs.system import StateSpace
    from symobs.system.conditions import Condition
    from symobs.system.specification import MatrixText, Name, Poles, PolynomialText
    from symobs.tasks.analysis.strata.strata import Place
    from symobs.tasks.design.compensator.output_feedback import OutputFeedback
    from symobs.tasks.design.gain.gain_design import GainDesign


@dataclass
class TrackingDesign(Result):
    """K_d with A_d − A + BK_d = 0, or with (A_d − A + BK_d) V = 0 for one trajectory; or why there is none.

    `loop` is the compensator whose gains are used, with its own claims.  The columns of V are x_d(0), A_d x_d(0), …, and
    span what the trajectory passes through.  `w` is None, or a row with w B = 0 and w (A − A_d) ≠ 0 (w (A − A_d) V ≠ 0).
    """

    loop: OutputFeedback
    reference: Matrix
    start: Matrix | None

    task: ClassVar[str] = "tracking"
    answered_by = ("K_d",)
    gains = ("K", "L")
    claimed = ("K_d",)
    letters = {
        "K": "K",
        "K_d": "K_d",
        "L": "L",
        "error_matrix": "A_e",
        "polynomial": "chi_cl",
    }
    panels = ("plane",)
    cards = ("K", "K_d", "L")

    @classmethod
    def of(cls, loop: OutputFeedback, reference: Matrix, start: Matrix | None, method_name: str) -> Self:
        """Return the tracking design, or the negative result."""
        B, ideal = loop.plant.matrices.B, loop.plant.ideal
        passed = trajectory(reference, start)
        wanted = ((loop.plant.matrices.A - reference) @ passed).normal()
        Y, w = solve_or_refute(B, wanted, ideal)
        answer: dict[str, Any] = {"K_d": None, "w": w}
        if Y is not None:
            square = passed.shape[0] == passed.shape[1]
            back = passed.inverse() if square else (passed.T @ passed).inverse() @ passed.T
            answer["K_d"] = (Y @ back).normal()
        return cls(loop.plant, method_name, answer, loop, reference, start)

    def with_gains(self, gains: Mapping[str, Matrix]) -> Self:
        """Return the design whose loop has other gains."""
        return self.of(self.loop.with_gains(gains), self.reference, self.start, self.method)

    def following_from(self, gains: Mapping[str, Matrix]) -> Self:
        """Return the design whose loop has given gains."""
        return self.of(self.loop.following_from(gains), self.reference, self.start, self.method)

    def design_of(self, gain: str) -> GainDesign:
        """Return the design of one half of the loop."""
        return self.loop.design_of(gain)

    @property
    def has_reduced_observer(self) -> bool:
        """The loop's estimator may be one."""
        return self.loop.has_reduced_observer

    def claims(self) -> Iterator[Claim]:
        """Yield that the reference has no part in the error, or that no K_d makes it so; and the error's polynomial."""
        K_d, w = self.answer["K_d"], self.answer["w"]
        if (K_d is None) == (w is None):
            raise CertificateRejected("there is a K_d exactly where no row shows that there is none")
        values = letters_of(self.plant) | {"A_ref": self.reference, "V_d": self.passed, "K_d": K_d, "w": w}
        e = Environment(variable=self.plant.variable, values=values)
        A, B, A_ref, V = (e[name] for name in ("A", "B", "A_ref", "V_d"))
        if self.start is not None:
            yield from self._passed_through(e)
        everywhere = self.start is None
        if w is not None:
            row = e["w"]
            left = row @ (A - A_ref) if everywhere else row @ (A - A_ref) @ V
            yield equality(row @ B, Matrix.zeros(1, self.plant.inputs), e, "w*B = 0")
            zero = Matrix.zeros(1, self.passed.shape[1])
            yield Claim(
                relation(left, "!==", zero), e, "w*(A - A_d) is not 0" if everywhere else "w*(A - A_d)*V is not 0"
            )
        else:
            left = A_ref - A + B @ e["K_d"]
            zero = Matrix.zeros(self.plant.order, self.passed.shape[1])
            said = "A_d - A + B*K_d = 0" if everywhere else "(A_d - A + B*K_d)*V = 0"
            yield equality(left if everywhere else left @ V, zero, e, said)
        if self.has_gains:
            values = {"A_e": self.matrix_of_errors, "phi": self.loop.loop_polynomial.value}
            own = Environment(variable=self.plant.variable, values=values)
            pencil = own["A_e"].pencil
            yield equality(pencil.apply("det"), own["phi"], own, "det(s*I - error matrix) = phi_c*phi_o")

    def _passed_through(self, e: Environment) -> Iterator[Claim]:
        """Yield that V holds the start and is carried into itself by A_d: V Z = [x_d(0), A_d V]."""
        assert self.start is not None  # noqa: S101 - the caller's branch
        V = self.passed
        rows = independent_rows(V)
        target = Matrix.block([[self.start, self.reference @ V]])
        Z = V.select(rows, range(V.shape[1])).solve(target.select(rows, range(target.shape[1])))
        inside = e.extended_by(values={"Z": Z, "x_d0": target})
        yield equality(inside["V_d"] @ inside["Z"], inside["x_d0"], inside, "V*Z = [x_d(0), A_d*V]")

    @cached_property
    def passed(self) -> Matrix:
        """V: a basis of the space spanned by the trajectory; I for every trajectory."""
        return trajectory(self.reference, self.start)

    @property
    def has_gains(self) -> bool:
        """Whether K and L exist, and the control law can be solved for u."""
        return self.loop.exists

    @property
    def all_certificates(self) -> tuple[Certificate, ...]:
        """The certificates of the loop and of K_d."""
        return (*self.loop.all_certificates, *self.certificates)

    @cached_property
    def matrix_of_errors(self) -> Matrix:
        """[A − BK, −BK; 0, A − LC] in (e_d, e), or [A − BK, −BK₂; 0, F] in (e_d, e₂)."""
        whole, order = self.loop.error_coordinates, self.plant.order
        first, second = range(order), range(order, whole.shape[0])
        return Matrix.block(
            [
                [whole.select(first, first), -whole.select(first, second)],
                [whole.select(second, first), whole.select(second, second)],
            ]
        )

    @property
    def verdict(self) -> str:
        """`no` where a gain or K_d does not exist; as the loop's where there is none."""
        if not self.has_gains:
            return self.loop.verdict
        return "no" if self.answer["K_d"] is None else super().verdict

    @cached_property
    def holds_where(self) -> tuple[Condition, ...]:
        """The conditions of the gains and of K_d."""
        return joined(super().holds_where, self.loop.holds_where)

    @cached_property
    def case_tree(self) -> tuple[Case, ...]:
        """The strata of the gains, and where a reference that cannot be followed otherwise can."""

        def on(plant: StateSpace, values: dict[str, Scalar]) -> Result:
            start = None if self.start is None else self.start.substitute(values)
            loop, reference = self.loop.on(plant, values), self.reference.substitute(values)
            found: Result = plant.once(
                (type(self), self.method, reference, start, *loop.asked_for),
                lambda: type(self).of(loop, reference, start, self.method),
            )
            return found

        return solved(self.plant, self._places, on)

    @property
    def _places(self) -> tuple[Place, ...]:
        """The strata of the gains, and where K_d is another one or a reference can be followed after all."""
        if self.answer["w"] is None:
            known = {condition.expression for condition in self.loop.holds_where}
            own = [c.expression for c in super().holds_where if c.kind == "claim" and c.expression not in known]
            found = (*self.loop.gain_places, *places(self.plant, own))
            return tuple({place.when: place for place in found}.values())
        left = (self.answer["w"] @ (self.plant.matrices.A - self.reference) @ self.passed).normal()
        obstacles = [entry.numerator for entry in left.entries if not entry.is_zero]
        if any(entry.is_constant for entry in obstacles):
            return self.loop.gain_places
        return (*self.loop.gain_places, *common_places(self.plant, obstacles))

    @cached_property
    def fields(self) -> Mapping[str, Any]:
        """The fields of the contract, and L."""
        loop = self.loop
        found = {"K": loop.answer["K"], "K_d": self.answer["K_d"], "solvable": self.answer["K_d"] is not None}
        found |= {"L": loop.answer["L"]}
        if not self.has_gains:
            found |= {"error_matrix": None, "polynomial": None}
            return found | {"fixed_modes": loop.unmoved_modes}
        return found | {"error_matrix": self.matrix_of_errors, "polynomial": loop.loop_polynomial}

    @property
    def free_signals(self) -> Mapping[str, int]:
        """The reference, and the free signals of the loop."""
        return {"x_d": self.plant.order, **self.loop.free_signals}


def trajectory(reference: Matrix, start: Matrix | None) -> Matrix:
    """Return independent columns among x_d(0), A_d x_d(0), …; I where no start is given."""
    order = reference.shape[0]
    if start is None:
        return Matrix.identity(order)
    columns = [start]
    for _ in range(order - 1):
        columns.append((reference @ columns[-1]).normal())
    every = Matrix.block([columns])
    return every.select(range(order), independent_rows(every.T))


@method("tracking/reference_model", source="francis1976")
def reference_model(loop: OutputFeedback, reference: Matrix, start: Matrix | None) -> TrackingDesign:
    """B K_d = A − A_d, solved in independent rows and columns of B."""
    return TrackingDesign.of(loop, reference, start, "reference_model")


@task
@poles_of(observer_poles=observer_order)
def tracking(
    plant: StateSpace,
    *,
    control_poles: Poles = None,
    control_polynomial: PolynomialText = None,
    observer_poles: Poles = None,
    observer_polynomial: PolynomialText = None,
    reference_matrix: MatrixText = None,
    reference_start: MatrixText = None,
    observer: Name = "minimal",
    method: Name = "auto",
) -> Result:
    """Track ẋ_d = A_d x_d by u = K (x_d − x̂) − K_d x_d, where A_d − A + BK_d = 0 has a solution.

    plant                                   n states, m inputs, p outputs, D allowed
    control_poles or control_polynomial     the n poles of A − BK
    observer_poles or observer_polynomial   the n − p poles of the observer, or n with observer = `full`
    reference_matrix                        A_d, n×n; the plant's own A where it is left out
    reference_start                         x_d(0): then only this trajectory is to be followed
    observer                                `minimal` or `full`
    Returns K, K_d (m×n), solvable (rank [B, A − A_d] = rank B), error_matrix in (e_d, e₂) or (e_d, e), polynomial
    (control times observer) and L.  Raises `InputError` for wrong poles or shapes.
    Source: B. A. Francis and W. M. Wonham (1976).
    """
    plant = plant.knowing(reference_matrix, reference_start)
    order = plant.order
    m = plant.matrices
    reference = (
        m.A if reference_matrix is None else read_gain(reference_matrix, plant, "reference_matrix", (order, order))
    )
    start = None if reference_start is None else read_gain(reference_start, plant, "reference_start", (order, 1))
    if start is not None and not any(start.entries):
        message = "reference_start is 0, where the reference stays for ever"
        raise InputError(
            message, where="specification.reference_start", repair="give a start that is not 0, or leave it out"
        )
    loop = observer_based(
        plant,
        task="tracking",
        control=(control_poles, control_polynomial),
        estimate=(observer_poles, observer_polynomial),
        observer=observer,
    )
    found: Result = choose("tracking", method, "reference_model").solve(loop, reference, start)
    return found.asked(method)


# The page of tracking.


@page_of(TrackingDesign)
def write_tracking(page: Builder, design: TrackingDesign) -> None:
    """Write the reference, the gains, K_d and the errors."""
    loop = design.loop
    write_both_gains(page, loop)
    if is_ill_posed(page, loop):
        return
    with page.section("tracking"):
        _reference(page, design)
        if design.has_gains and design.answer["K_d"] is not None:
            _law(page, design)
        _gain(page, design)
        if design.has_gains and design.answer["K_d"] is not None:
            caution_law(page, loop)
            draw_tracking(page, minimal=isinstance(loop.estimator, ReducedOrderObserver))
            _errors(page, design)


def _reference(page: Builder, design: TrackingDesign) -> None:
    """Write ẋ_d = A_d x_d."""
    page.set("A_ref", design.reference)
    page.dynamics("x_d", page["A_ref"] @ page["x_d"], silent=True)
    page.equal(
        relation(page["x_d"].derivative, page["A_ref"] @ page["x_d"]),
        relation(page["A_ref"], design.reference),
        say="reference",
    )


def _law(page: Builder, design: TrackingDesign) -> None:
    """Write u = K (x_d − x̂) − K_d x_d, and the equation of the error."""
    page.set("K_d", design.answer["K_d"])
    minimal = isinstance(design.loop.estimator, ReducedOrderObserver)
    if minimal:
        partitioned_gain(page)
        shown = page["K_1"] @ page["x_1"] + page["K_2"] @ page["x_2_hat"]
    else:
        shown = page["K"] @ page["x_hat"]
    page.signal("u", page["K"] @ page["x_d"] - shown - page["K_d"] @ page["x_d"], silent=True)
    both = (page["K"] - page["K_d"]) @ page["x_d"] - shown
    page.equal(
        relation(page["u"], page["K"] @ (page["x_d"] - page["x_hat"]) - page["K_d"] @ page["x_d"], both),
        say="tracking_law",
    )
    page.signal("e_d", page["x_d"] - page["x"], silent=True)
    A, B, K = (page[name] for name in "ABK")
    through = B @ page["K_2"] @ page["e_2"] if minimal else B @ K @ page["e"]
    page.equal(
        relation(
            page["e_d"].derivative,
            (A - B @ K) @ page["e_d"] + (page["A_ref"] - A + B @ page["K_d"]) @ page["x_d"] - through,
        ),
        say="tracking_error",
        error=relation(page["e_d"], page["x_d"] - page["x"]),
    )


def _gain(page: Builder, design: TrackingDesign) -> None:
    """Write A_d − A + BK_d = 0, for every reference or for what one trajectory passes through."""
    A, B = page["A"], page["B"]
    order, columns = design.passed.shape
    if design.start is not None:
        page.set("x_d0", design.start)
        passes = block([[page["A_ref"] ** k @ page["x_d0"] if k else page["x_d0"] for k in range(columns)]])
        page.define("V_d", passes, say="tracking_condition_one", start=relation(page["x_d0"], design.start))
    V = page["V_d"] if design.start is not None else None
    if design.answer["K_d"] is None:
        page.set("w_d", design.answer["w"])
        w = page["w_d"]
        left = w @ (A - page["A_ref"]) if V is None else w @ (A - page["A_ref"]) @ V
        page.conclude(
            "tracking_impossible" if V is None else "tracking_impossible_one",
            relation(left, "!==", Matrix.zeros(1, columns)),
            row=relation(w, w.as_value),
            annuls=relation(w @ B, Matrix.zeros(1, page.plant.inputs)),
            left=relation(left, left.as_value),
        )
        return
    if not page.defines("K_d"):
        page.set("K_d", design.answer["K_d"])
    K_d = page["K_d"]
    zero = block([[page.value(Matrix.zeros(order, columns))]])
    condition = page["A_ref"] - A + B @ K_d
    page.equal(
        relation(condition if V is None else condition @ V, zero),
        say="tracking_condition" if V is None else "tracking_condition_then",
    )
    page.equal(relation(K_d, K_d.as_value), say="tracking_solved", answer=True)
    if K_d.value.is_zero:
        page.conclude("tracking_no_feedforward", relation(K_d, Matrix.zeros(*K_d.value.shape)))


def _errors(page: Builder, design: TrackingDesign) -> None:
    """Write the block triangular matrix of both errors, and its polynomial."""
    minimal = isinstance(design.loop.estimator, ReducedOrderObserver)
    A, B, C, K, L = (page[name] for name in "ABCKL")
    order, size = page.plant.order, design.matrix_of_errors.shape[0]
    own = page["A_22"] - L @ page["A_12"] if minimal else A - L @ C
    through = B @ page["K_2"] if minimal else B @ K
    zero = page.value(Matrix.zeros(size - order, order))
    one = design.start is not None
    whole, parts = block([[A - B @ K, -through], [zero, own]]), [order, size - order]
    page.define(
        "A_e",
        whole,
        in_blocks(page, whole.value, parts, parts),
        say="tracking_errors_one" if one else "",
        silent=not one,
        closing=False,
    )
    if not one:
        state = block([[page["e_d"]], [page["e_2" if minimal else "e"]]])
        page.equal(
            relation(state.derivative, whole @ state, in_blocks(page, whole.value, parts, parts) @ state),
            say="tracking_errors",
            answer=True,
        )
    determinant = page["A_e"].pencil.apply("det")
    page.equal(
        relation(determinant, page.term(formula_of_factored(design.loop.loop_polynomial))), say="tracking_polynomial"
    )
