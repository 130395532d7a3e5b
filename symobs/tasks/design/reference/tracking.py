"""Tracking of a reference ẋ_d = A_d x_d:  u = K (x_d − x̂) − K_d x_d,  error e_d = x_d − x.

ė_d = (A − BK) e_d + (A_d − A + BK_d) x_d − BK e, so the reference has no part in the error where A_d − A + BK_d = 0.
"""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING, Any, ClassVar, Self

from symobs.exact import Matrix, independent_rows, solve_or_refute
from symobs.formula.tree import Environment
from symobs.formula.tree.written import stacked
from symobs.ground.dataclass import dataclass
from symobs.ground.errors import CertificateRejected, InputError
from symobs.system.specification import read_gain
from symobs.tasks.analysis.page_parts import formula_of_factored, in_blocks
from symobs.tasks.analysis.strata.strata import common_places, places
from symobs.tasks.design.block_diagrams import draw_tracking
from symobs.tasks.design.compensator.compensator import observer_based, observer_order
from symobs.tasks.design.compensator.compensator_page import caution_law
from symobs.tasks.design.compensator.minimal_order_compensator_page import (
    is_ill_posed,
    partitioned_gain,
    write_both_gains,
)
from symobs.tasks.design.compensator.of_loop import OfLoop
from symobs.tasks.design.reduced_order.reduced_order_observer import ReducedOrderObserver
from symobs.tasks.result import Result, holds, method, page_of, poles_of, task
from symobs.tasks.result import choose as choose_method

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from symobs.proof.certificate.claims import Claim
    from symobs.proof.derivation.builder import Builder
    from symobs.system import StateSpace
    from symobs.system.specification import MatrixText, Name, Poles, PolynomialText
    from symobs.tasks.analysis.strata.strata import Place
    from symobs.tasks.design.compensator.output_feedback import OutputFeedback


@dataclass
class TrackingDesign(OfLoop):
    """K_d with A_d − A + BK_d = 0, or with (A_d − A + BK_d) V = 0 for one trajectory; or why there is none.

    `loop` is the compensator whose gains are used, with its own claims.  The columns of V are x_d(0), A_d x_d(0), …, and
    span what the trajectory passes through.  `w` is None, or a row with w B = 0 and w (A − A_d) ≠ 0 (w (A − A_d) V ≠ 0).
    """

    loop: OutputFeedback
    reference: Matrix
    start: Matrix | None

    inputs = ("reference", "start")
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

    def claims(self) -> Iterator[Claim]:
        """Yield that the reference has no part in the error, or that no K_d makes it so; and the error's polynomial."""
        K_d, w = self.answer["K_d"], self.answer["w"]
        if (K_d is None) == (w is None):
            raise CertificateRejected("there is a K_d exactly where no row shows that there is none")
        e = self.meanings(A_d=self.reference, V=self.passed)
        if self.start is not None:
            yield from self._passed_through(e)
        if w is not None:
            yield holds(e, "w*B = 0")
            yield holds(e, "w*(A - A_d) !== 0" if self.start is None else "w*(A - A_d)*V !== 0")
        else:
            yield holds(e, "A_d - A + B*K_d = 0" if self.start is None else "(A_d - A + B*K_d)*V = 0")
        if self.has_gains:
            own = Environment(variable=self.plant.variable, values={"A": self.matrix_of_errors})
            phi = self.loop.loop_polynomial.value
            yield holds(own, "det(pencil(A)) = {phi}", phi=phi)

    def _passed_through(self, e: Environment) -> Iterator[Claim]:
        """Yield that V holds the start and is carried into itself by A_d: V Z = [x_d(0), A_d V]."""
        assert self.start is not None  # noqa: S101 - the caller's branch
        V = self.passed
        rows = independent_rows(V)
        target = Matrix.block([[self.start, self.reference @ V]])
        Z = V.select(rows, range(V.shape[1])).solve(target.select(rows, range(target.shape[1])))
        yield holds(e, "V {Z} = {target}", Z=Z, target=target)

    @cached_property
    def passed(self) -> Matrix:
        """V: a basis of the space spanned by the trajectory; I for every trajectory."""
        return trajectory(self.reference, self.start)

    @property
    def has_gains(self) -> bool:
        """Whether K and L exist, and the control law can be solved for u."""
        return self.loop.exists

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

    @property
    def own_places(self) -> tuple[Place, ...]:
        """Where K_d is another one, or a reference can be followed after all."""
        if self.answer["w"] is None:
            known = {condition.expression for condition in self.loop.holds_where}
            own = [c.expression for c in self.own_conditions if c.kind == "claim" and c.expression not in known]
            return places(self.plant, own)
        left = (self.answer["w"] @ (self.plant.matrices.A - self.reference) @ self.passed).normal()
        obstacles = [entry.numerator for entry in left.entries if not entry.is_zero]
        return () if any(entry.is_constant for entry in obstacles) else common_places(self.plant, obstacles)

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
    choose: Name = "auto",
    method: Name = "auto",
) -> Result:
    """Track ẋ_d = A_d x_d by u = K (x_d − x̂) − K_d x_d, where A_d − A + BK_d = 0 has a solution.

    plant                                   n states, m inputs, p outputs, D allowed
    control_poles or control_polynomial     the n poles of A − BK
    observer_poles or observer_polynomial   the n − p poles of the observer, or n with observer = `full`
    reference_matrix                        A_d, n×n; the plant's own A where it is left out
    reference_start                         x_d(0): then only this trajectory is to be followed
    observer                                `minimal` or `full`
    choose                                  which gains of several inputs or outputs: "simple" or "small", as for
                                            `state_feedback`
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
        choose=choose,
    )
    found: Result = choose_method("tracking", method, "reference_model").solve(loop, reference, start)
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
    page.dynamics("x_d", "A_ref x_d", silent=True)
    page.equal("x_d' = A_ref x_d", "A_ref = #", say="reference")


def _law(page: Builder, design: TrackingDesign) -> None:
    """Write u = K (x_d − x̂) − K_d x_d, and the equation of the error."""
    page.set("K_d", design.answer["K_d"])
    minimal = isinstance(design.loop.estimator, ReducedOrderObserver)
    if minimal:
        partitioned_gain(page)
    shown = page["K_1 x_1 + K_2 x_2_hat" if minimal else "K x_hat"]
    page.signal("u", page("K x_d - {shown} - K_d x_d", shown=shown), silent=True)
    page.equal(page.line("u = K (x_d - x_hat) - K_d x_d = (K - K_d) x_d - {shown}", shown=shown), say="tracking_law")
    page.signal("e_d", "x_d - x", silent=True)
    through = "B K_2 e_2" if minimal else "B K e"
    error = page.line("e_d = x_d - x")
    page.equal(f"e_d' = (A - B K) e_d + (A_ref - A + B K_d) x_d - {through}", say="tracking_error", error=error)


def _gain(page: Builder, design: TrackingDesign) -> None:
    """Write A_d − A + BK_d = 0, for every reference or for what one trajectory passes through."""
    columns = design.passed.shape[1]
    if design.start is not None:
        page.set("x_d0", design.start)
        passes = stacked("x_d0", "A_ref", columns, across=True)
        page.define("V_d", passes, say="tracking_condition_one", start=page.line("x_d0 = #"))
    if design.answer["K_d"] is None:
        page.set("w_d", design.answer["w"])
        left = "w_d (A - A_ref)" + ("" if design.start is None else " V_d")
        page.conclude(
            "tracking_impossible" if design.start is None else "tracking_impossible_one",
            page.line(f"{left} !== 0"),
            row=page.line("w_d = #"),
            annuls=page.line("w_d B = 0"),
            left=page.line(f"{left} = #"),
        )
        return
    if not page.defines("K_d"):
        page.set("K_d", design.answer["K_d"])
    held = "A_ref - A + B K_d" if design.start is None else "(A_ref - A + B K_d) V_d"
    condition = page.line(f"{held} = [{{zero}}]", zero=Matrix.zeros(page.plant.order, columns))
    page.equal(condition, say="tracking_condition" if design.start is None else "tracking_condition_then")
    page.equal("K_d = #", say="tracking_solved", answer=True)
    if design.answer["K_d"].is_zero:
        page.conclude("tracking_no_feedforward", page.line("K_d = 0"))


def _errors(page: Builder, design: TrackingDesign) -> None:
    """Write the block triangular matrix of both errors, and its polynomial."""
    minimal = isinstance(design.loop.estimator, ReducedOrderObserver)
    order, size = page.plant.order, design.matrix_of_errors.shape[0]
    own, through = ("A_22 - L A_12", "B K_2") if minimal else ("A - L C", "B K")
    one, parts = design.start is not None, [order, size - order]
    whole = page(f"[A - B K, -({through}); {{zero}}, {own}]", zero=Matrix.zeros(size - order, order))
    divided = in_blocks(page, whole.value, parts, parts)
    say = "tracking_errors_one" if one else ""
    page.define("A_e", whole, divided, say=say, silent=not one, closing=False)
    if not one:
        state = "[e_d; e_2]" if minimal else "[e_d; e]"
        chain = page.line(f"{state}' = {{whole}} {state} = {{divided}} {state}", whole=whole, divided=divided)
        page.equal(chain, say="tracking_errors", answer=True)
    polynomial = page.term(formula_of_factored(design.loop.loop_polynomial))
    page.equal(page.line("det(pencil(A_e)) = {polynomial}", polynomial=polynomial), say="tracking_polynomial")
