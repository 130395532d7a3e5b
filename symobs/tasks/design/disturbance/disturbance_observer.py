"""The disturbance observer: plant and model of the disturbance together, ẋ = A x + B u + E d, d = V w, ẇ = S w.

With Â = [A EV; 0 S] and Ĉ = [C 0] it is the observer of (x, w), whose poles can be assigned arbitrarily if and only if (Ĉ, Â)
is observable.  For a constant d (S = 0, V = I) that is: (C, A) is observable and rank [A E; C 0] = n + q; for a single d,
(C, A) and (V, S) are observable and no eigenvalue of S is a zero of (A, E, C).
"""

from __future__ import annotations

from dataclasses import replace
from functools import cached_property
from typing import TYPE_CHECKING, Any, ClassVar, Self

from symobs.exact import Matrix, modulo, rank, roots_of
from symobs.exact.linear_algebra.transfer_function import Realisation
from symobs.formula.tree import Environment, Literal, Roots
from symobs.formula.tree.term import Term, block
from symobs.ground.dataclass import dataclass
from symobs.ground.errors import CertificateRejected
from symobs.proof.derivation.builder import Builder, predicate, relation
from symobs.system import StateSpace
from symobs.system.conditions import joined
from symobs.system.specification import DesiredPolynomial, desired_polynomial, in_common_field
from symobs.tasks.analysis.page_parts import case_steps, given, say_stability
from symobs.tasks.analysis.rank.rank_page import assume_rank
from symobs.tasks.analysis.strata.strata import found_once, solved
from symobs.tasks.design.disturbance.disturbance_input import Exosystem, read_disturbance_input, read_exosystem
from symobs.tasks.design.full_order.observer import ObserverDesign, model_and_innovation
from symobs.tasks.design.gain.gain_cases import design_of, places_beside
from symobs.tasks.design.gain.gain_design import OBSERVER, letters_of
from symobs.tasks.design.gain.gain_kind import AssignedGain
from symobs.tasks.design.gain.gain_page import say_as_required
from symobs.tasks.design.gain.small_gain_page import compare_with_simple, small_gain_terms
from symobs.tasks.design.named_gains import define_gain
from symobs.tasks.design.pole_cautions import caution_poles
from symobs.tasks.design.unassignable import say_unassignable
from symobs.tasks.result import Case, Result, equality, holds, method, page_of, poles_of, task
from symobs.tasks.result import choose as choose_method
from symobs.tasks.result.control_systems import Controller

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from symobs.exact import Scalar
    from symobs.formula.tree import Relation
    from symobs.proof.certificate.claims import Certificate, Claim
    from symobs.system.conditions import Condition
    from symobs.system.specification import MatrixText, Name, Poles, PolynomialText


#: The matrices of the model, by the letters of the page.
_LETTERS = {"E_d": "E", "S_w": "S", "V_w": "V"}


@dataclass
class DisturbanceObserver(Result):
    """L_x and L_w with det(sI − [A − L_x C, EV; −L_w C, S]) = φ(s), or the proof that there are none.

    `inner` is the observer of plant and exosystem together, with its own claims.
    """

    exosystem: Exosystem
    inner: ObserverDesign

    task: ClassVar[str] = "disturbance_observer"
    answered_by = ("L_x", "L_w")
    gains = ("L_x", "L_w")
    gains_are_one = True
    letters = {"L_x": "L_x", "L_w": "L_w", "polynomial": "phi", "poles": "phi"}

    @classmethod
    def of(cls, plant: StateSpace, exosystem: Exosystem, desired: DesiredPolynomial, method_name: str) -> Self:
        """Return the observer, or the negative result."""
        several = "ackermann" if plant.outputs == 1 else "sylvester"
        inner = design_of(ObserverDesign, with_exosystem(plant, exosystem), desired, several)
        return cls.of_inner(plant, exosystem, inner, method_name)

    @classmethod
    def of_inner(cls, plant: StateSpace, exosystem: Exosystem, inner: ObserverDesign, method_name: str) -> Self:
        """Return the observer that one of plant and exosystem together is."""
        gain, n, every = inner.answer["L"], plant.order, range(plant.outputs)
        answer = {
            "L_x": None if gain is None else gain.select(range(n), every),
            "L_w": None if gain is None else gain.select(range(n, n + exosystem.order), every),
            "polynomial": inner.answer["polynomial"],
        }
        return cls(plant, method_name, answer, exosystem, inner)

    def with_gains(self, gains: Mapping[str, Matrix]) -> Self:
        """Return the design with other gains; one that is not given stays."""
        design = self.inner.with_answer(self.inner.letter, self._whole(gains))
        return self.of_inner(self.plant, self.exosystem, design, self.method)

    def following_from(self, gains: Mapping[str, Matrix]) -> Self:
        """Return the design of given gains; one that is not given stays."""
        given = self.inner.of_given(self.inner.plant, self._whole(gains))
        placed = DesiredPolynomial(self.plant.variable, (given.answer["polynomial"],))
        design = replace(given, kind=AssignedGain(placed))
        return self.of_inner(self.plant, self.exosystem, design, self.method)

    def design_of(self, gain: str) -> ObserverDesign:  # noqa: ARG002 - one for both
        """Return the observer of plant and exosystem together."""
        return self.inner

    def _whole(self, gains: Mapping[str, Matrix]) -> Matrix:
        first, second = (gains.get(name, self.answer[name]) for name in self.gains)
        if first is None or second is None:
            raise CertificateRejected("there are no such gains")
        return Matrix.block([[first], [second]])

    def claims(self) -> Iterator[Claim]:
        """Yield that the observer of plant and exosystem has the desired poles, and that it is theirs."""
        L_x, L_w, plant = self.answer["L_x"], self.answer["L_w"], self.plant
        if (L_x is None) != (self.inner.answer["L"] is None) or (L_x is None) != (L_w is None):
            raise CertificateRejected("there are gains exactly where plant and exosystem have an observer")
        values = letters_of(plant) | {name: getattr(self.exosystem, of) for name, of in _LETTERS.items()}
        values |= {"phi": self.answer["polynomial"]}
        gains = {} if L_x is None else {"L_x": L_x, "L_w": L_w}
        e = Environment(variable=plant.variable, values=values | gains)
        whole = block(extended(e, plant, self.exosystem))
        yield equality(whole, self.inner.plant.matrices.A, e, "the inner observer is one for A_hat")
        yield holds(e, "phi = {polynomial}", "the polynomial is the one asked for", polynomial=self.desired.polynomial)
        if L_x is not None:
            both = block([[e["L_x"]], [e["L_w"]]])
            yield equality(both, self.inner.answer["L"], e)
            seen = block([[e["L_x"] @ e["C"]], [e["L_w"] @ e["C"]]])
            wide = Matrix.block([[Matrix.identity(plant.order), Matrix.zeros(plant.order, self.exosystem.order)]])
            pencil = whole.pencil + seen @ Term(Literal(wide), e)
            yield holds(e, "{det} = phi", det=pencil.apply("det"))

    @property
    def all_certificates(self) -> tuple[Certificate, ...]:
        """The certificates of the observer of plant and exosystem, and of the gains."""
        return (*self.inner.all_certificates, *self.certificates)

    @property
    def desired(self) -> DesiredPolynomial:
        """The polynomial that is to be assigned."""
        assert self.inner.desired is not None  # noqa: S101 - the observer is asked for by its polynomial
        return self.inner.desired

    @property
    def verdict(self) -> str:
        """`no` where there are no gains."""
        return "no" if self.answer["L_x"] is None else super().verdict

    @property
    def data(self) -> Mapping[str, Scalar | Matrix]:
        """The matrices of the plant, and those of the exosystem."""
        return {**super().data, **{name: getattr(self.exosystem, of) for name, of in _LETTERS.items()}}

    @property
    def further_data(self) -> tuple[Matrix, ...]:
        """The matrices of the exosystem."""
        return self.exosystem

    @cached_property
    def holds_where(self) -> tuple[Condition, ...]:
        """The conditions of the gains, and of the pair."""
        return joined(super().holds_where, (c for c in self.inner.holds_where if c.kind == "existence"))

    @cached_property
    def case_tree(self) -> tuple[Case, ...]:
        """The design where other modes than in general are beyond any gain, or none are."""

        def on(there: StateSpace, values: dict[str, Scalar]) -> Result:
            exosystem = Exosystem(*(modulo(part.substitute(values), there.ideal) for part in self.exosystem))
            desired = self.desired.substitute(values)
            return found_once(type(self), there, exosystem, desired, self.method).with_gains_of(self, values)

        return solved(self.plant, places_beside(self, self.inner), on)

    @cached_property
    def fields(self) -> Mapping[str, Any]:
        """The gains, the matrices of the observer of (x, w), and what it reports."""
        inner = self.inner.fields
        own = {name: self.answer[name] for name in ("L_x", "L_w", "polynomial")}
        return own | {name: inner[name] for name in ("A", "B_u", "B_y")} | dict(self.inner.report)

    @property
    def free_signals(self) -> Mapping[str, int]:
        """The disturbance, the state of its model, and the estimate of that."""
        order = self.exosystem.order
        return {"d": self.exosystem.E.shape[1], "w_e": order, "w_hat": order}

    @property
    def systems(self) -> Mapping[str, Realisation]:
        """The plant, and the observer (u, y) → (x̂, d̂)."""
        m, found, (_, S, V) = self.plant.matrices, self.inner.fields, self.exosystem
        if found["A"] is None:
            return super().systems
        driven = Matrix.block([[found["B_u"], found["B_y"]]]) if m.has_input else found["B_y"]
        n, order, q = self.plant.order, S.shape[0], V.shape[0]
        shown = Matrix.block([[Matrix.identity(n), Matrix.zeros(n, order)], [Matrix.zeros(q, n), V]])
        own = Realisation(found["A"].normal(), driven.normal(), shown, Matrix.zeros(n + q, driven.shape[1]))
        return {**super().systems, "disturbance_observer": own}

    @property
    def controller(self) -> Controller | None:
        """(u, y) → (x̂, d̂)."""
        system, plant = self.systems.get("disturbance_observer"), self.plant
        if system is None:
            return None
        inputs = (("u", plant.inputs), ("y", plant.outputs)) if plant.inputs else (("y", plant.outputs),)
        output = ("estimate", system.C.shape[0])
        return Controller("disturbance_observer", system, inputs, output, returns=False, gains=("L_x", "L_w"))


def with_exosystem(plant: StateSpace, exosystem: Exosystem) -> StateSpace:
    """Return plant and exosystem together, with the states (x, w)."""
    m, n, order = plant.matrices, plant.order, exosystem.order
    A = Matrix.block([[m.A, (exosystem.E @ exosystem.V).normal()], [Matrix.zeros(order, n), exosystem.S]])
    B = Matrix.block([[m.B], [Matrix.zeros(order, plant.inputs)]]) if m.has_input else None
    C = Matrix.block([[m.C, Matrix.zeros(plant.outputs, order)]])
    found = StateSpace(A, B, C, m.D if m.has_feedthrough else None, dt=plant.dt, symbols=plant.symbols)
    return plant.beside(found.restricted(plant.equations, plant.nonzero))


def extended(e: Environment, plant: StateSpace, exosystem: Exosystem) -> list[list[Term]]:
    """Return the blocks of [A EV; 0 S], of [A E; 0 S] where d = w and V has no letter."""
    A, E, S = (e[name] for name in ("A", "E_d", "S_w"))
    return [
        [A, E @ e["V_w"] if e.defines("V_w") else E],
        [Term(Literal(Matrix.zeros(exosystem.order, plant.order)), e), S],
    ]


@method("disturbance_observer/extended_state", source="johnson1971; francis1976")
def extended_state(plant: StateSpace, exosystem: Exosystem, desired: DesiredPolynomial) -> DisturbanceObserver:
    """[L_x; L_w] is the observer gain of the plant with the states of the exosystem as further states."""
    return DisturbanceObserver.of(plant, exosystem, desired, "extended_state")


def extended_order(plant: StateSpace, asked: Mapping[str, Any]) -> int:
    """Return the number of poles of plant and exosystem."""
    E = read_disturbance_input(plant, asked.get("E"))
    return plant.order + read_exosystem(plant, E, asked.get("S"), asked.get("V")).order


@task
@poles_of(poles=extended_order)
def disturbance_observer(
    plant: StateSpace,
    *,
    E: MatrixText = None,
    S: MatrixText = None,
    V: MatrixText = None,
    poles: Poles = None,
    polynomial: PolynomialText = None,
    choose: Name = "auto",
    method: Name = "auto",
) -> Result:
    """Estimate state and disturbance of ẋ = A x + B u + E d, d = V w, ẇ = S w, by the observer of (x, w).

    plant         n states, p outputs, D allowed; B may be missing
    E             n×q: how the disturbance d enters
    S             r×r; left out, d is constant: S = 0, in discrete time S = I.  [0 omega; -omega 0] is a sinusoid
    V             q×r; left out, d consists of the first q entries of w
    poles         the n + r poles, closed under conjugation; or
    polynomial    φ, monic of degree n + r
    choose        which gain of several outputs: "simple" or "small", as for `observer`
    Returns L_x (n×p), L_w (r×p), the observer's A ([A − L_x C, EV; −L_w C, S]), B_u, B_y in (x, w), fixed_modes, poles,
    stable; `family` where the gains are not unique.  The verdict is `no` where φ cannot be assigned.
    Raises `InputError` for wrong poles or shapes.
    Source: C. D. Johnson (1971); B. A. Francis and W. M. Wonham (1976).
    """
    plant = plant.knowing(E, S, V, poles, polynomial)
    plant.require("C", task="disturbance_observer")
    exosystem = read_exosystem(plant, read_disturbance_input(plant, E), S, V)
    desired = desired_polynomial(plant, poles, polynomial, degree=plant.order + exosystem.order, choose=choose)
    assert desired is not None  # noqa: S101 - required
    plant, (desired, *parts) = in_common_field(plant, desired, *exosystem)
    exosystem = Exosystem(*parts)
    return (
        choose_method("disturbance_observer", method, "extended_state").solve(plant, exosystem, desired).asked(method)
    )


# The page of the disturbance observer: plant and exosystem together, observability, the gain, observer and error.


@page_of(DisturbanceObserver)
def write_disturbance_observer(page: Builder, design: DisturbanceObserver) -> None:
    """Write the data, plant and exosystem together, the gain, and the observer."""
    given(page, ("observer", design.desired), disturbed=design.exosystem.E)
    with page.section("disturbance_observer"):
        _together(page, design)
        write_gain_of_both(page, design)
        if design.answer["L_x"] is not None:
            _observer(page, design)
        page.steps += case_steps(page, design, _case)


def _case(page: Builder, design: DisturbanceObserver) -> None:
    """Write the design on a stratum."""
    for name, value in zip(("E_d", "S_w", "V_w"), design.exosystem, strict=True):
        page.set(name, value)
    page.set("phi_o", design.desired.polynomial)
    name_extended(page, design, silent=True)
    write_gain_of_both(page, design)


def _together(page: Builder, design: DisturbanceObserver) -> None:
    """Write ẇ = S w and d = V w, and both equations together."""
    _, S, V = design.exosystem
    page.set("S_w", S)
    page.set("V_w", V)
    page.dynamics("w_e", "S_w w_e", silent=True)
    page.signal("d", "V_w w_e", silent=True)
    if _is_constant(design):
        generated = [page.line("w_e' = S_w w_e"), relation(page["S_w"], S)]
        page.equal(*generated, "d = w_e", say="disturbance_constant")
    else:
        generated = [page.line("w_e' = #S_w w_e")]
        page.equal(*generated, "d = #V_w w_e", say="disturbance_model")
    write_both_together(page, design)


def write_both_together(page: Builder, design: DisturbanceObserver) -> None:
    """Write plant and exosystem as one system."""
    plant, m, S = page.plant, page.plant.matrices, design.exosystem.S
    name_extended(page, design)
    state = page["[x; w_e]"]
    rate, seen = page["A_hat [x; w_e]"], page["C_hat [x; w_e]"]
    if m.has_input:
        below = page.value(Matrix.zeros(S.shape[0], plant.inputs))
        page.define("B_hat", page("[B; {below}]", below=below))
        rate = page["A_hat [x; w_e] + B_hat u"]
    seen = page["C_hat [x; w_e]"]
    seen = page("{seen} + D u", seen=seen) if m.has_feedthrough else seen
    page.equal(relation(state.derivative, rate), relation(page["y"], seen), say="disturbance_together")


def name_extended(page: Builder, design: DisturbanceObserver, *, silent: bool = False) -> None:
    """Define Â = [A EV; 0 S] and Ĉ = [C 0]."""
    outputs, order = page.plant.outputs, design.exosystem.order
    whole = block(extended(page.environment, page.plant, design.exosystem))
    page.define("A_hat", whole, say="" if silent else "disturbance_extended", silent=silent)
    page.define("C_hat", page("[C, {order}]", order=Matrix.zeros(outputs, order)), silent=silent)


def _is_constant(design: DisturbanceObserver) -> bool:
    """Return whether the disturbance is constant: d = w, with S = 0, in discrete time S = I."""
    _, S, V = design.exosystem
    order = S.shape[0]
    still = Matrix.identity(order) if design.plant.is_discrete else Matrix.zeros(order, order)
    return still == S and Matrix.identity(order) == V


def write_gain_of_both(page: Builder, design: DisturbanceObserver) -> None:
    """Write whether plant and exosystem are observable, and the gain or the reason why there is none."""
    pair, plant, C, A = design.inner.pair, page.plant, page["C_hat"], page["A_hat"]
    order = plant.order + design.exosystem.order
    conditions = [c.expression for c in design.holds_where if c.kind != "domain"]
    if conditions:
        page.assume("disturbance_provided", *conditions)
    tested = block([[C @ A**k if k else C] for k in range(order)])
    if pair.is_observable:
        assume_rank(page, "disturbance_provided", design.inner.test, design)
        page.conclude("disturbance_observable", rank=relation(tested.apply("rank"), order))
        _zeros(page, design)
    else:
        page.set("N", pair.kernel)
        page.set("X", pair.restricted)
        fixed = page["det(pencil(X))"]
        roots = Roots(fixed.formula, roots_of(design.inner.fixed_polynomial, plant.variable))
        if design.answer["L_x"] is None:
            keys, polynomial = ("disturbance_impossible", "disturbance_unassignable"), design.desired.polynomial
            say_unassignable(page, keys, page["phi_o"], polynomial, fixed, design.case_tree, modes=roots)
            _zeros(page, design)
            return
        page.conclude("disturbance_fixed", predicate("polynomial", page["phi_o / det(pencil(X))"]), modes=roots)
    terms, say = small_gain_terms(page, design.inner, OBSERVER, A, C)
    L = define_gain(page, "L", *terms, design.inner.answer["L"], say=say or "disturbance_gain")
    compare_with_simple(page, design.inner, OBSERVER, A, C)
    pencil = page("det(pencil(A_hat) + {L} C_hat)", L=L)
    say_as_required(page, design.desired, pencil, page.value(design.desired.polynomial))
    caution_poles(page, design.desired, "phi_o", "observer")
    if not design.desired.is_numeric:
        say_stability(page, pencil)
    if design.fields["family"] is not None:
        page.remark("disturbance_family")


def _zeros(page: Builder, design: DisturbanceObserver) -> None:
    """Say what observability of plant and exosystem means for the zeros of the plant from d to y."""
    plant, A, E = page.plant, page["A"], page["E_d"]
    q, n = E.value.shape[1], plant.order
    if not _is_constant(design):
        if q == 1 and design.inner.pair.is_observable:
            page.remark("disturbance_zeros_model")
        return
    first = page["A - I"] if plant.is_discrete else A
    whole = page("[{first}, E_d; C, {q}]", first=first, q=Matrix.zeros(plant.outputs, q))
    found, place = rank(whole.value, plant.ideal), "one" if plant.is_discrete else "origin"
    if design.inner.pair.is_observable:
        page.remark(f"disturbance_zeros_{place}", rank=relation(whole.apply("rank"), n + q))
    elif (
        q <= plant.outputs and found < n + q and rank(page("[{first}; C]", first=first).value, plant.ideal) == n
    ):  # so that d is not 0 in its kernel
        page.remark(f"disturbance_blocked_{place}", rank=relation(whole.apply("rank"), found, "<", n + q))


def _observer(page: Builder, design: DisturbanceObserver) -> None:
    """Write the observer, the estimate of the disturbance, and the error equation."""
    estimate = page["V_w w_hat"]
    page.signal("d_hat", estimate, silent=True)
    shown = page.line("d_hat = V_w w_hat = #V_w w_hat")
    write_observer_of_both(page, design, page["E_d V_w w_hat"], shown, say="disturbance_equation")


def write_observer_of_both(
    page: Builder, design: DisturbanceObserver, driven: Term, *shown: Relation, say: str
) -> None:
    """Write the observer of plant and exosystem, where E d̂ drives the estimate, and the error equation."""
    L, A_hat = page["L"], page["A_hat"]
    for name, value in (("L_x", design.answer["L_x"]), ("L_w", design.answer["L_w"])):
        page.set(name, value)
    page.conclude_silently("L = [L_x; L_w]")
    model, innovation = model_and_innovation(page)
    page.dynamics("x_hat", model + driven + page["L_x"] @ innovation, silent=True)
    page.dynamics("w_hat", page("S_w w_hat + L_w {innovation}", innovation=innovation), silent=True)
    state = page["[x_hat; w_hat]"]
    rate = A_hat @ state
    left = page["y - C_hat [x_hat; w_hat]"]
    if page.plant.matrices.has_input:
        rate = page("{rate} + B_hat u", rate=rate)
        left = page("{left} - D u", left=left) if page.plant.matrices.has_feedthrough else left
    page.equal(relation(state.derivative, rate + L @ left), *shown, say=say)
    page.signal("e", "x - x_hat", silent=True)
    page.signal("e_w", "w_e - w_hat", silent=True)
    both = (page.line("e = x - x_hat"), page.line("e_w = w_e - w_hat"))
    page.equal(
        "[e; e_w]' = (A_hat - L C_hat) [e; e_w] = #(A_hat - L C_hat) [e; e_w]",
        say="disturbance_error",
        state=both[0],
        other=both[1],
    )
