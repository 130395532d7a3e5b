"""Feedforward for unit DC gain: u = −K x + F v, or −K x̂ + F v, with y = v at rest; v does not excite the observer."""

from __future__ import annotations

from dataclasses import replace
from functools import cached_property
from typing import TYPE_CHECKING, Any, ClassVar, Self

from symobs.exact import Matrix, Scalar, kernel, rank, transfer_matrix
from symobs.exact.linear_algebra.transfer_function import Realisation
from symobs.formula.tree import Environment
from symobs.formula.tree.term import Term, block, identity
from symobs.ground.dataclass import dataclass
from symobs.ground.errors import CertificateRejected
from symobs.proof.derivation import CaseStep, Conclude
from symobs.proof.derivation.builder import Builder, relation, sentence
from symobs.system.conditions import joined, nonzero, vanishing_factors
from symobs.tasks.analysis.page_parts import factored_form, formula_of_factored
from symobs.tasks.analysis.strata.rank_stratification import maximal_minors
from symobs.tasks.analysis.strata.strata import common_places, places
from symobs.tasks.design import readability
from symobs.tasks.design.block_diagrams import draw_feedforward, draw_state_feedforward
from symobs.tasks.design.compensator.compensator import KnownState, observer_based, observer_order, of_known_state
from symobs.tasks.design.compensator.compensator_page import caution_law
from symobs.tasks.design.compensator.minimal_order_compensator import MinimalOrderCompensator
from symobs.tasks.design.compensator.minimal_order_compensator_page import (
    is_ill_posed,
    partitioned_gain,
    write_both_gains,
)
from symobs.tasks.design.compensator.of_loop import OfLoop
from symobs.tasks.design.gain.gain_design import FEEDBACK, OBSERVER, letters_of
from symobs.tasks.result import Result, equality, holds, method, page_of, poles_of, task
from symobs.tasks.result import choose as choose_method

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from symobs.proof.certificate.claims import Claim
    from symobs.system import StateSpace
    from symobs.system.conditions import Condition
    from symobs.system.specification import GainText, Name, Poles, PolynomialText
    from symobs.tasks.analysis.strata.strata import Place
    from symobs.tasks.design.compensator.output_feedback import OutputFeedback
    from symobs.tasks.result import Case


@dataclass
class FeedforwardDesign(OfLoop):
    """F with T = (C − DK)(sI − A + BK)⁻¹BF + DF and T(0) = I (T(1) = I in discrete time), or why there is none.

    `loop` is the state feedback, or the compensator, whose gains are used, with its own claims.  Where there is no F, `w` is
    a row with w G = 0 for the gain G at rest from the input, or `stuck` a state with (A − BK) x = 0 (x in discrete time):
    the loop has a mode that never comes to rest.
    """

    loop: OutputFeedback

    task: ClassVar[str] = "feedforward"
    answered_by = ("F",)
    gains: ClassVar[tuple[str, ...]] = ("K", "L")
    claimed = ("F",)
    letters = {
        "F": "F_v",
        "transfer_function": "T_v",
        "K": "K",
        "L": "L",
        "polynomial": "chi_cl",
        "closed_loop_matrix": "A_cl",
    }
    panels = ("plane", "responses")
    cards: ClassVar[tuple[str, ...]] = ("F", "K", "L", "transfer_function")

    @classmethod
    def of(cls, loop: OutputFeedback, method_name: str) -> Self:
        """Return the feedforward of a loop, or the negative result."""
        plant = loop.plant
        answer: dict[str, Any] = dict.fromkeys(("F", "transfer_function", "w", "stuck"))
        if loop.exists:
            stuck = kernel(moving_at_rest(loop), plant.ideal)
            G = None if stuck.shape[1] else gain_at_rest(loop)
            left = Matrix.zeros(1, 0) if G is None else kernel(G.T, plant.ideal)
            if G is None:
                answer["stuck"] = stuck.select(range(plant.order), [0])
            elif left.shape[1]:
                answer["w"] = left.select(range(left.shape[0]), [0]).T
            else:
                F = (G.inverse() if plant.inputs == plant.outputs else G.T @ (G @ G.T).inverse()).normal()
                T = response(loop, F).function(plant.variable)
                single = F.shape == (1, 1)
                answer |= {"F": F[0, 0] if single else F, "transfer_function": T[0, 0] if single else T}
        return cls(plant, method_name, answer, loop)

    def with_answer(self, name: str, value: object) -> Self:
        """Return the design with another F, and what v does to y then."""
        if name != "F" or not isinstance(value, Matrix):
            return super().with_answer(name, value)
        single, T = value.shape == (1, 1), response(self.loop, value).function(self.plant.variable)
        answer = {"F": value[0, 0] if single else value, "transfer_function": T[0, 0] if single else T}
        return replace(self, answer={**self.answer, **answer})

    def claims(self) -> Iterator[Claim]:
        """Yield what v does to y, that y = v at rest, and that the error has no part in it; or that no F exists."""
        K, F, w, stuck = self.loop.answer["K"], self.answer["F"], self.answer["w"], self.answer["stuck"]
        have = self.loop.exists
        reasons = sum(value is not None for value in (F, w, stuck))
        if reasons != int(have) or (F is None) != (self.answer["transfer_function"] is None):
            message = "there is a feedforward exactly where both gains exist and the gain at rest has full rank"
            raise CertificateRejected(message)
        if not have:
            return
        m = self.plant.matrices
        values = letters_of(self.plant) | {"D": m.D, "K": K, "F": F, "w": w, "T_v": self.answer["transfer_function"]}
        values |= {"x_0": stuck}
        if not isinstance(self.loop, KnownState):
            values |= {"A_cl": self.loop.error_coordinates, "K_e": self.loop.coupling}
        restored = {
            name: Matrix.of(v.rows) if isinstance(v, Matrix) else v for name, v in values.items()
        }  # as unpickled
        e = Environment(variable=self.plant.variable, values=restored)
        A, B, C, D = (e[name] for name in "ABCD")
        K_ = e["K"]
        order, one = self.plant.order, identity(self.plant.order, e)
        if stuck is not None:
            still = A @ e["x_0"] - B @ K_ @ e["x_0"]
            there = e["x_0"] if self.plant.is_discrete else Matrix.zeros(order, 1)
            yield equality(still, there, e, "a mode never comes to rest")
            yield holds(e, "x_0 !== 0")
            return
        rest = (one - A + B @ K_ if self.plant.is_discrete else B @ K_ - A).inverse
        at_rest = (C - D @ K_) @ rest @ B + D
        if w is not None:
            yield holds(e, "w {at_rest} = 0", at_rest=at_rest)
            yield holds(e, "w !== 0")
            return
        F_ = e["F"]
        yield holds(e, "{at_rest} F = I", at_rest=at_rest)
        yield holds(e, "T_v = (C - D K) (s I - A + B K)^-1 B F + D F")
        if isinstance(self.loop, KnownState):
            return
        errors = self.loop.error_coordinates.shape[0] - order
        zero = e.extended_by(values={"O_e": Matrix.zeros(errors, self.plant.outputs)})
        A_cl, K_e, nothing = zero["A_cl"], zero["K_e"], zero["O_e"]
        seen = block([[C - D @ K_, D @ K_e]])
        driven = block([[B @ F_], [nothing]])
        whole = seen @ A_cl.pencil.inverse @ driven + D @ F_
        yield holds(zero, "T_v = {whole}", "the whole loop with its error responds alike", whole=whole)

    @property
    def systems(self) -> Mapping[str, Realisation]:
        """Those of the loop, which is closed from v to y."""
        if self.answer["F"] is None:
            return self.loop.systems
        F = self.answer["F"]
        return {
            **self.loop.systems,
            "closed_loop": response(self.loop, F if isinstance(F, Matrix) else Matrix.of([[F]])),
        }

    @cached_property
    def gain_at_rest(self) -> Matrix:
        """G = (C − DK)(−A + BK)⁻¹B + D."""
        return gain_at_rest(self.loop)

    @property
    def verdict(self) -> str:
        """`no` where either gain, or F, does not exist; as the loop's where there is none."""
        return self.loop.verdict if not self.loop.exists else "no" if self.answer["F"] is None else super().verdict

    @property
    def existence(self) -> tuple[Scalar, ...]:
        """What must not vanish besides: det (−A + BK), and det G, or det GGᵀ where there are more inputs than outputs."""
        if self.answer["F"] is None:
            return ()
        G = self.gain_at_rest
        square = G if self.plant.inputs == self.plant.outputs else G @ G.T
        return moving_at_rest(self.loop).determinant(), square.determinant()

    @cached_property
    def holds_where(self) -> tuple[Condition, ...]:
        """The conditions of the gains and of F."""
        factors = vanishing_factors([value.numerator for value in self.existence], self.plant.symbols.signs)
        return joined(super().holds_where, nonzero("existence", factors))

    own_first = True

    @property
    def own_places(self) -> tuple[Place, ...]:
        """The strata where nothing comes to rest, or G loses its rank, its minors of the highest order being 0 together."""
        if self.answer["F"] is None:
            return ()
        moving = self.existence[0].numerator
        lost = [minor.numerator for minor in maximal_minors(self.gain_at_rest.T)]
        if len(lost) == 1:
            return places(self.plant, [moving, *lost])
        return (*places(self.plant, [moving]), *common_places(self.plant, lost))

    @cached_property
    def fields(self) -> Mapping[str, Any]:
        """The fields of the contract, the gains and the loop's polynomial."""
        loop = self.loop
        found = {name: self.answer[name] for name in ("F", "transfer_function")}
        found |= {name: loop.answer[name] for name in self.gains}
        if self.answer["F"] is None:
            return found | {"fixed_modes": loop.unmoved_modes}
        return found | {"polynomial": loop.loop_polynomial, "closed_loop_matrix": loop.error_coordinates}

    @property
    def free_signals(self) -> Mapping[str, int]:
        """The new input, and the free signals of the loop."""
        return {"v_r": self.plant.outputs, **self.loop.free_signals}


@dataclass
class StateFeedforward(FeedforwardDesign):
    """The feedforward of u = −K x + F v."""

    loop: KnownState

    gains = ("K",)
    letters = {name: letter for name, letter in FeedforwardDesign.letters.items() if name != "L"} | {
        "closed_loop_matrix": "A - B K"
    }
    cards = ("F", "K", "transfer_function")


def moving_at_rest(loop: OutputFeedback) -> Matrix:
    """Return −A + BK, in discrete time I − A + BK: what must be regular for the loop to come to rest."""
    m = loop.plant.matrices
    moving: Matrix = m.B @ loop.answer["K"] - m.A
    return moving + Matrix.identity(loop.plant.order) if loop.plant.is_discrete else moving


def gain_at_rest(loop: OutputFeedback) -> Matrix:
    """Return (C − DK)(−A + BK)⁻¹B + D, in discrete time (C − DK)(I − A + BK)⁻¹B + D."""
    m, K = loop.plant.matrices, loop.answer["K"]
    found: Matrix = ((m.C - m.D @ K) @ moving_at_rest(loop).solve(m.B) + m.D).normal()
    return found


def response(loop: OutputFeedback, F: Matrix) -> Realisation:
    """Return v → y: A − BK, BF, C − DK, DF."""
    m, K = loop.plant.matrices, loop.answer["K"]
    return Realisation((m.A - m.B @ K).normal(), (m.B @ F).normal(), (m.C - m.D @ K).normal(), (m.D @ F).normal())


@method("feedforward/static", source="chen1999, ch. 8")
def static(loop: OutputFeedback) -> FeedforwardDesign:
    """F = [(C − DK)(−A + BK)⁻¹B + D]⁻¹."""
    return (StateFeedforward if isinstance(loop, KnownState) else FeedforwardDesign).of(loop, "static")


@task
@poles_of(observer_poles=observer_order)
def feedforward(
    plant: StateSpace,
    *,
    control_poles: Poles = None,
    control_polynomial: PolynomialText = None,
    observer_poles: Poles = None,
    observer_polynomial: PolynomialText = None,
    K: GainText = None,
    observer: Name = "full",
    choose: Name = "auto",
    method: Name = "auto",
) -> Result:
    """Design F in u = −K x + F v, or −K x̂ + F v, so that y = v at rest:  F = [(C − DK)(−A + BK)⁻¹B + D]⁻¹.

    plant                                   n states, m inputs, p ≤ m outputs, D allowed
    control_poles or control_polynomial     the n poles of A − BK
    observer_poles or observer_polynomial   the n poles of A − LC, or the n − p poles of the observer; without them x is
                                            measured, and there is no observer
    K                                       a given m×n gain instead of control poles
    observer                                `full` or `minimal`
    choose                                  which gains of several inputs or outputs: "simple" or "small", as for
                                            `state_feedback`
    Returns F (m×p; with more inputs than outputs the smallest one), transfer_function v → y, K, L, polynomial (control
    times observer) and closed_loop_matrix in (x, e) or (x, e₂), without an observer A − BK.  Where the plant has a zero
    at 0 (in discrete time at 1), or a control pole stands there, the verdict is `no`.  Raises `InputError` for wrong poles or
    shapes.
    Source: C.-T. Chen, Linear System Theory and Design, 3rd ed., ch. 8.
    """
    control, estimate = (control_poles, control_polynomial), (observer_poles, observer_polynomial)
    loop: OutputFeedback
    if observer_poles is None and observer_polynomial is None and observer == "full":
        loop = of_known_state(plant, task="feedforward", control=control, gain=K, choose=choose)
    else:
        loop = observer_based(
            plant,
            task="feedforward",
            control=control,
            estimate=estimate,
            observer=observer,
            gains=(K, None),
            choose=choose,
        )
    found: Result = choose_method("feedforward", method, "static").solve(loop)
    return found.asked(method)


# The page of the feedforward.


@page_of(FeedforwardDesign)
def write_feedforward(page: Builder, design: FeedforwardDesign) -> None:
    """Write the gains, the loop with its new input, and F."""
    loop = design.loop
    minimal = isinstance(loop, MinimalOrderCompensator)
    write_both_gains(page, loop)
    if any(half.answer[half.letter] is None for half in loop.halves):
        return
    if is_ill_posed(page, loop):
        return
    with page.section("feedforward"):
        if design.answer["F"] is None:
            _impossible(page, design)
            return
        _loop(page, design, minimal=minimal)
        _gain(page, design)
        if isinstance(loop, KnownState):
            draw_state_feedforward(page)
            return
        caution_law(page, loop)
        draw_feedforward(page, minimal=minimal)


def _at_rest(page: Builder) -> Term:
    """Return (C − DK)(−A + BK)⁻¹B + D, in discrete time (C − DK)(I − A + BK)⁻¹B + D."""
    B, C = page["B"], page["C"]
    closed = page["B K - A"]
    if page.plant.is_discrete:
        closed = page["I - A + B K"]
    if not page.plant.matrices.has_feedthrough:
        return C @ closed.inverse @ B
    return page("(C - D K) {inverse} B + D", inverse=closed.inverse)


def _impossible(page: Builder, design: FeedforwardDesign) -> None:
    """Write that the loop never comes to rest, or the gain at rest has dependent rows, whatever K is."""
    if design.answer["stuck"] is not None:
        x = page.set("x_0", design.answer["stuck"])
        moved = page["(A - B K) x_0"]
        there = x if page.plant.is_discrete else page.value(Matrix.zeros(page.plant.order, 1))
        page.conclude("no_rest", state=page.line("x_0 = #"), still=relation(moved, there))
        return
    page.define("G_0", _at_rest(page), say="gain_at_rest")
    m = page.plant.matrices
    whole = rank(transfer_matrix(m.A, m.B, m.C, m.D, page.plant.variable)[0])
    if not whole:
        page.conclude(
            "no_feedforward_none", relation(_response(page), Matrix.zeros(page.plant.outputs, page.plant.inputs))
        )
        return
    if page["G_0"].value.shape == (1, 1):
        page.conclude("no_feedforward_single", "G_0 = 0")
        return
    page.set("w_0", design.answer["w"])
    slots = {"row": page.line("w_0 = #"), "vanishes": page.line("w_0 G_0 = 0")}
    found = relation(_response(page).apply("rank"), whole)
    if whole < page.plant.outputs:
        page.conclude("no_feedforward_low", rank=found, **slots)
    else:
        page.conclude("no_feedforward_zero", found, **slots)


def _response(page: Builder) -> Term:
    """Return C(sI − A)⁻¹B + D."""
    response = page["C pencil(A)^-1 B"]
    return page["C pencil(A)^-1 B + D"] if page.plant.matrices.has_feedthrough else response


def _loop(page: Builder, design: FeedforwardDesign, *, minimal: bool) -> None:
    """Write u = −K x̂ + F v, and what becomes of state, error and output."""
    plant, m = page.plant, page.plant.matrices
    F = design.answer["F"]
    page.set("F_v", F if isinstance(F, Matrix) else Matrix.of([[F]]))
    if isinstance(design.loop, KnownState):
        _loop_of_state(page, design.loop)
        return
    if minimal:
        partitioned_gain(page)
        page.signal(
            "u",
            "(-K_1) x_1 - K_2 x_2_hat + F_v v_r",
            say="feedforward_law",
        )
    else:
        page.signal("u", "(-K) x_hat + F_v v_r", say="feedforward_law")
    C, K = page["C"], page["K"]
    x, v, error = page["x"], page["v_r"], page["e_2" if minimal else "e"]
    coupling = page["K_2"] if minimal else K
    own = page["A_22 - L A_12"] if minimal else page["A - L C"]
    lines = [
        page.line("x' = (A - B K) x + B {coupling} {error} + B F_v v_r", coupling=coupling, error=error),
        relation(error.derivative, own @ error),
    ]
    output = C @ x
    if m.has_feedthrough:
        output = page("(C - D K) x + D {coupling} {error} + D F_v v_r", coupling=coupling, error=error)
    page.equal(*lines, relation(page["y"], output), say="feedforward_loop")
    errors = design.loop.error_coordinates.shape[0] - plant.order
    zero = page.value(Matrix.zeros(errors, plant.order))
    page.define(
        "A_cl",
        page("[A - B K, B {coupling}; {zero}, {own}]", coupling=coupling, zero=zero, own=own),
        silent=True,
        closing=False,
    )
    state, driven = (
        page("[x; {error}]", error=error),
        page("[B F_v; {value}]", value=Matrix.zeros(errors, plant.outputs)),
    )
    page.conclude_silently(relation(state.derivative, page["A_cl"] @ state + driven @ v))
    determinant = page["det(pencil(A_cl))"]
    of_rest = page["pencil(A_22) + L A_12"] if minimal else None
    of_error = OBSERVER.error_determinant(page) if of_rest is None else of_rest.apply("det")
    parts_of = FEEDBACK.error_determinant(page) @ of_error
    product = page.term(formula_of_factored(design.loop.loop_polynomial))
    page.equal(relation(determinant, parts_of, product), say="feedforward_polynomial")


def _loop_of_state(page: Builder, loop: KnownState) -> None:
    """Write u = −K x + F v, and what becomes of state and output."""
    C, x = page["C"], page["x"]
    page.signal("u", "(-K) x + F_v v_r", say="feedforward_law")
    output = page["(C - D K) x + D F_v v_r"] if page.plant.matrices.has_feedthrough else C @ x
    rate = page.line("x' = (A - B K) x + B F_v v_r")
    page.equal(rate, relation(page["y"], output), say="feedforward_state")
    product = page.term(formula_of_factored(loop.loop_polynomial))
    page.equal(relation(FEEDBACK.error_determinant(page), product), say="feedforward_state_polynomial")


def _gain(page: Builder, design: FeedforwardDesign) -> None:
    """Write F from the gain at rest, and the transfer function from v to y."""
    plant, m = page.plant, page.plant.matrices
    F_v = page["F_v"]
    factors = vanishing_factors([value.numerator for value in design.existence], plant.symbols.signs)
    if factors:
        page.assume("feedforward_assumed", *factors)
    page.define("G_0", _at_rest(page), say="gain_at_rest")
    G = page["G_0"]
    if plant.inputs == plant.outputs:
        page.equal("F_v = G_0^-1 = #", say="feedforward_gain", answer=True)
    else:
        page.equal("F_v = G_0.T (G_0 G_0.T)^-1 = #", say="feedforward_smallest", answer=True)
    one = page.identity(plant.outputs) if plant.outputs > 1 else page["1"]
    page.verified("as_required", check=relation(G @ F_v, one))
    response = page["C (pencil(A) + B K)^-1 B F_v"]
    if m.has_feedthrough:
        response = page["(C - D K) (pencil(A) + B K)^-1 B F_v + D F_v"]
    T = design.answer["transfer_function"]
    say = "feedforward_state_response" if isinstance(design.loop, KnownState) else "feedforward_response"
    if isinstance(T, Scalar):
        page.define("T_v", response, factored_form(page, T), say=say, answer=True, closing=False)
    else:
        shown = [page.value(T)] if T.size <= readability.MATRIX else []
        page.define("T_v", response, *shown, say=say, answer=True, closing=False)
    page.conclude_silently(relation(page["T_v"], T))
    page.steps += [_without(case, G) for case in design.case_tree if _is_without(case)]


def _is_without(case: Case) -> bool:
    """Return whether there is no F on a stratum because the only gain at rest is 0 there."""
    w = None if case.result is None else case.result.answer.get("w")
    return w is not None and w.shape == (1, 1) and len(case.when) == 1


def _without(case: Case, G: Term) -> CaseStep:
    """Return that there is no F on a stratum."""
    step = Conclude(sentence("no_feedforward_single", {}), (relation(G, Matrix.zeros(*G.value.shape)),))
    return CaseStep(relation(case.when[0].expression, 0), tuple(case.substitution.items()), (step,))
