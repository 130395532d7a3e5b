"""The unknown-input observer  ż = F z + T B u + (L + F H)(y − D u),  x̂ = z + H (y − D u)  of  ẋ = A x + B u + E d.

With T = I − H C and F = T A − L C the error e = T x − z satisfies ė = F e + T E d, and T E = 0 is H C E = E: such an H exists
if and only if rank C E = rank E.  With H = E [(CE)ᵀ CE]⁻¹ (CE)ᵀ the unobservable modes of (C, T A) are the zeros of (A, E, C),
which are eigenvalues of F whatever H and L are: C v = 0 and A v = s v + E w make F v = T A v = s T v = s v.
"""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING, Any, ClassVar, Self, TypedDict

from symobs.exact import Matrix, Scalar, independent_rows, kernel, modulo, roots_of
from symobs.exact.linear_algebra.transfer_function import Realisation
from symobs.formula.tree import Environment, Roots
from symobs.formula.tree.term import block
from symobs.ground.dataclass import dataclass
from symobs.ground.errors import CertificateRejected
from symobs.proof.derivation.builder import Builder, predicate, relation
from symobs.stability.criteria.stability import stability
from symobs.system import StateSpace
from symobs.system.conditions import joined
from symobs.system.specification import DesiredPolynomial, desired_polynomial, in_common_field
from symobs.tasks.analysis.page_parts import case_steps, given, is_narrow, letters_apart_from_data, say_stability
from symobs.tasks.analysis.rank.rank_page import assume_rank
from symobs.tasks.analysis.strata.rank_stratification import maximal_minors
from symobs.tasks.analysis.strata.strata import common_places, found_once, solved
from symobs.tasks.design.components import combination, stand_in_line, summed
from symobs.tasks.design.disturbance.disturbance_input import read_disturbance_input, with_disturbance
from symobs.tasks.design.error_plots import plot_error
from symobs.tasks.design.full_order.observer import ObserverDesign
from symobs.tasks.design.gain.gain_cases import design_of, places_beside
from symobs.tasks.design.gain.gain_design import OBSERVER, letters_of
from symobs.tasks.design.gain.gain_page import say_as_required
from symobs.tasks.design.gain.small_gain_page import compare_with_simple, small_gain_terms
from symobs.tasks.design.gain.structured_gain_page import write_structured
from symobs.tasks.design.named_gains import define_gain
from symobs.tasks.design.pole_cautions import caution_poles
from symobs.tasks.design.unassignable import say_unassignable
from symobs.tasks.result import Case, Result, equality, holds, method, page_of, task
from symobs.tasks.result import choose as choose_method
from symobs.tasks.result.answers import named_found
from symobs.tasks.result.control_systems import Controller, observer_of

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from symobs.formula.tree.term import Term
    from symobs.proof.certificate.claims import Certificate, Claim
    from symobs.system.conditions import Condition
    from symobs.system.specification import MatrixText, Name, Poles, PolynomialText
    from symobs.tasks.analysis.strata.strata import Place


class UnknownInputMatrices(TypedDict):
    """The matrices of the observer."""

    H: Matrix | None
    T: Matrix | None
    L: Matrix | None
    F: Matrix | None
    B_u: Matrix | None
    B_y: Matrix | None


class UnknownInputAnswer(UnknownInputMatrices):
    """Also φ, and w with C E w = 0 and E w ≠ 0 where there is no H."""

    polynomial: Scalar
    w: Matrix | None


_NONE: UnknownInputMatrices = {"H": None, "T": None, "L": None, "F": None, "B_u": None, "B_y": None}


@dataclass
class UnknownInputObserver(Result):
    """An observer with T E = 0, T A − F T = B_y C, B_u = T B − B_y D, T + H C = I, det(sI − F) = φ(s), or why there is none.

    `inner` is the gain L for the pair (C, T A), with its own claims; None where there is no H, and C E w = 0 with E w ≠ 0.
    """

    answer: UnknownInputAnswer
    desired: DesiredPolynomial
    disturbance_input: Matrix
    inner: ObserverDesign | None

    task: ClassVar[str] = "unknown_input_observer"
    answered_by = ("H", "L")
    gains = ("L",)
    claimed = ("H",)
    shows_gain = "F"
    letters = {
        "H": "H_d",
        "T": "T_d",
        "L": "L",
        "F": "F_d",
        "B_y": "L_y",
        "polynomial": "phi",
        "poles": "phi",
    }

    @classmethod
    def of(cls, plant: StateSpace, E: Matrix, desired: DesiredPolynomial, method_name: str) -> Self:
        """Return the observer, or the negative result."""
        H = decoupling(plant, E)
        if H is None:
            w = unseen_input(plant, E)
            return cls(plant, method_name, {**_NONE, "polynomial": desired.polynomial, "w": w}, desired, E, None)
        inner = design_of(ObserverDesign, decoupled(plant, H), desired)
        return cls.assembled(plant, E, H, inner, desired, method_name)

    @classmethod
    def assembled(
        cls,
        plant: StateSpace,
        E: Matrix,
        H: Matrix,
        inner: ObserverDesign,
        desired: DesiredPolynomial,
        method_name: str,
    ) -> Self:
        """Return the observer with a gain for (C, T A)."""
        m, L = plant.matrices, inner.answer["L"]
        T = (Matrix.identity(plant.order) - H @ m.C).normal()
        answer: UnknownInputAnswer = {**_NONE, "H": H, "T": T, "polynomial": desired.polynomial, "w": None}
        if L is not None:
            F = (inner.plant.matrices.A - L @ m.C).normal()
            B_y = (L + F @ H).normal()
            answer |= {"L": L, "F": F, "B_y": B_y, "B_u": (T @ m.B - B_y @ m.D).normal() if m.has_input else None}
        return cls(plant, method_name, answer, desired, E, inner)

    def with_answer(self, name: str, value: object) -> Self:
        """Return the observer with another L, or with another H and a gain for it, and the matrices that follow."""
        if name == "H" and isinstance(value, Matrix) and self.inner is not None:
            inner = design_of(ObserverDesign, decoupled(self.plant, value), self.desired)
            whole = (self.plant, self.disturbance_input, value, inner, self.desired, self.method)
            return type(self).assembled(*whole).in_place_of(self)
        if name != "L" or self.inner is None:
            return super().with_answer(name, value)
        return self.with_gain(self.inner.with_answer("L", value), self.desired)

    def with_gain(self, inner: ObserverDesign, desired: DesiredPolynomial) -> Self:
        """Return the observer, where there is one, with another gain for (C, T A), which places the roots of a polynomial."""
        E, H = self.disturbance_input, self.answer["H"]
        if H is None:
            return self
        return type(self).assembled(self.plant, E, H, inner, desired, self.method).in_place_of(self)

    def following_from(self, gains: Mapping[str, Matrix]) -> Self:
        """Return the observer of a given L."""
        if "L" not in gains or self.inner is None:
            return self
        inner = ObserverDesign.of_given(self.inner.plant, gains["L"])
        return self.with_gain(inner, DesiredPolynomial(self.plant.variable, (inner.answer["polynomial"],)))

    def design_of(self, gain: str) -> ObserverDesign:
        """Return the gain of the pair (C, T A); raises `KeyError` where there is none."""
        if self.inner is None:
            raise KeyError(gain)
        return self.inner

    @property
    def has_reduced_observer(self) -> bool:
        """Its H is no gain, and is written so where a convention calls the gain H."""
        return True

    def claims(self) -> Iterator[Claim]:
        """Yield that z follows T x whatever u and d are, and where the poles are; or that E d is not seen in the output."""
        plant, answer, inner = self.plant, self.answer, self.inner
        m = plant.matrices
        is_whole = all((part is None) == (answer["L"] is None) for part in (answer["F"], answer["B_y"]))
        has_gain = inner is not None and inner.answer["L"] is not None
        if (
            any((part is None) != (inner is None) for part in (answer["H"], answer["T"]))
            or (answer["w"] is None) != (inner is not None)
            or (answer["L"] is None) == has_gain
            or not is_whole
            or (answer["B_u"] is None) == (has_gain and m.has_input)
        ):
            raise CertificateRejected("there is an observer exactly where there are H and a gain of the pair (C, T A)")
        values = letters_of(plant) | {"E_d": self.disturbance_input, "phi": answer["polynomial"]}
        known = {name: value for name, value in answer.items() if isinstance(value, (Matrix, Scalar))}
        e = Environment(variable=plant.variable, values=values | known)
        A, C = e["A"], e["C"]
        yield holds(e, "phi = {polynomial}", "the polynomial is the one asked for", polynomial=self.desired.polynomial)
        if inner is None:
            yield holds(e, "C E_d w = 0")
            yield holds(e, "E_d w !== 0")
            return
        T = e["T"]
        yield holds(e, "(H C - I) E_d = 0")
        yield holds(e, "T = I - H C")
        yield equality(T @ A, inner.plant.matrices.A, e, "the inner gain is one for T*A")
        yield equality(C, inner.plant.matrices.C, e, "the inner gain is one for C")
        yield holds(e, "phi = {polynomial}", "the inner gain is one for phi(s)", polynomial=inner.answer["polynomial"])
        if answer["L"] is None:
            return
        B_y = e["B_y"]
        yield holds(e, "F = T A - L C")
        yield holds(e, "B_y = L + F H")
        yield holds(e, "T A - F T = B_y C")
        if answer["B_u"] is not None:
            driven = T @ e["B"]
            driven = driven - B_y @ e["D"] if m.has_feedthrough else driven
            yield holds(e, "B_u = {driven}", driven=driven)
        yield holds(e, "det(pencil(F)) = phi")

    @property
    def all_certificates(self) -> tuple[Certificate, ...]:
        """The certificates of the gain for (C, T A) and of the observer."""
        return (*(() if self.inner is None else self.inner.certificates), *self.certificates)

    @property
    def verdict(self) -> str:
        """`no` where d cannot be decoupled, or φ not be assigned."""
        return "no" if self.answer["L"] is None else super().verdict

    @property
    def free_signals(self) -> Mapping[str, int]:
        """The unknown input, and the state of the observer."""
        return {"d": self.disturbance_input.shape[1], "w_o" if self.plant.is_discrete else "z_o": self.plant.order}

    @property
    def data(self) -> Mapping[str, Scalar | Matrix]:
        """The matrices of the plant, and E."""
        return {**super().data, "E_d": self.disturbance_input}

    @property
    def further_data(self) -> tuple[Matrix, ...]:
        """The input matrix E of the disturbance."""
        return (self.disturbance_input,)

    @cached_property
    def holds_where(self) -> tuple[Condition, ...]:
        """The conditions of H, and of the gain."""
        inner = () if self.inner is None else self.inner.holds_where
        return joined(super().holds_where, (c for c in inner if c.kind == "existence"))

    @cached_property
    def case_tree(self) -> tuple[Case, ...]:
        """The whole question again where the rank of E or of C E, or the zeros of (A, E, C), are others than in general."""

        def on(there: StateSpace, values: dict[str, Scalar]) -> Result:
            E, desired = modulo(self.disturbance_input.substitute(values), there.ideal), self.desired.substitute(values)
            return found_once(type(self), there, E, desired, self.method).with_gains_of(self, values)

        return solved(self.plant, self.places, on)

    @property
    def places(self) -> tuple[Place, ...]:
        """The strata where there is another H, or another gain."""
        whole, E = (
            with_disturbance(self.plant, self.disturbance_input),
            independent_columns(self.disturbance_input, self.plant.ideal),
        )
        H = self.answer["H"]
        if self.inner is None or H is None:  # E d would have to be seen, or to vanish
            return common_places(whole, _numerators(maximal_minors(E)))
        beside = places_beside(self, self.inner)
        if H.common_denominator().is_constant:
            return beside
        minors = _numerators(maximal_minors((self.plant.matrices.C @ E).normal()))
        return tuple({place.when: place for place in (*common_places(whole, minors), *beside)}.values())

    @cached_property
    def fields(self) -> Mapping[str, Any]:
        """The matrices of the observer, whether there is an H, and what the gain for (C, T A) reports."""
        own = {name: part for name, part in self.answer.items() if name in _NONE} | {"solvable": self.inner is not None}
        own["polynomial"] = self.answer["polynomial"]
        return own | (dict(self.inner.report) if self.inner is not None else {})

    @property
    def systems(self) -> Mapping[str, Realisation]:
        """The plant, and the observer (u, y) → x̂ with the state z."""
        m, F, B_u = self.plant.matrices, self.answer["F"], self.answer["B_u"]
        driven, shown = self.answer["B_y"], self.answer["H"]
        if F is None or driven is None or shown is None:
            return super().systems
        if B_u is not None:
            driven, shown = Matrix.block([[B_u, driven]]), Matrix.block([[-(shown @ m.D), shown]])
        own = Realisation(F, driven.normal(), Matrix.identity(self.plant.order), shown.normal())
        return {**super().systems, "observer": own}

    @property
    def controller(self) -> Controller | None:
        """(u, y) → x̂."""
        return observer_of(self)


def independent_columns(E: Matrix, ideal: Any = None) -> Matrix:
    """Return columns of E that are independent and span what all of them do."""
    return E.select(range(E.shape[0]), independent_rows(E.T, ideal))


def decoupling(plant: StateSpace, E: Matrix) -> Matrix | None:
    """Return H = E [(CE)ᵀ CE]⁻¹ (CE)ᵀ, E (CE)⁻¹ where C E is square, of independent columns of E; None if rank C E < rank E."""
    E = independent_columns(E, plant.ideal)
    seen = modulo((plant.matrices.C @ E).normal(), plant.ideal)
    outputs, inputs = seen.shape
    if not inputs:
        return Matrix.zeros(plant.order, outputs)
    if len(independent_rows(seen.T, plant.ideal)) < inputs:
        return None
    left = seen.inverse() if inputs == outputs else (seen.T @ seen).inverse() @ seen.T
    return modulo((E @ left).normal(), plant.ideal)


def unseen_input(plant: StateSpace, E: Matrix) -> Matrix:
    """Return a w with C E w = 0 and E w ≠ 0."""
    ideal = plant.ideal
    N = kernel((plant.matrices.C @ E).normal(), ideal)
    columns = (N.select(range(N.shape[0]), [j]) for j in range(N.shape[1]))
    return next(w for w in columns if not modulo((E @ w).normal(), ideal).is_zero)


def decoupled(plant: StateSpace, H: Matrix) -> StateSpace:
    """Return the plant of T x: T A, seen through C."""
    m = plant.matrices
    seen = StateSpace((m.A - H @ m.C @ m.A).normal(), None, m.C, dt=plant.dt, symbols=plant.symbols)
    return plant.beside(seen.restricted(plant.equations, plant.nonzero))


def _numerators(values: list[Scalar]) -> list[Scalar]:
    return [value.numerator for value in values if not value.is_zero]


@method("unknown_input_observer/decoupled", source="darouach1994")
def by_decoupling(plant: StateSpace, E: Matrix, desired: DesiredPolynomial) -> UnknownInputObserver:
    """H decouples d from the error, and L places the poles of T A − L C."""
    return UnknownInputObserver.of(plant, E, desired, "decoupled")


@task
def unknown_input_observer(
    plant: StateSpace,
    *,
    E: MatrixText = None,
    poles: Poles = None,
    polynomial: PolynomialText = None,
    choose: Name = "auto",
    method: Name = "auto",
) -> Result:
    """Estimate the state of ẋ = A x + B u + E d irrespective of d by  ż = F z + B_u u + B_y y,  x̂ = z + H (y − D u).

    plant         n states, p outputs, D allowed; B may be missing
    E             n×q: how the unknown input d enters
    poles         n desired poles, closed under conjugation; or
    polynomial    φ, monic of degree n
    choose        which gain of several outputs: "simple" or "small", as for `observer`
    Returns H (n×p), T (I − HC), L (n×p), F (TA − LC, whose characteristic polynomial is φ), B_u (TB − B_y D), B_y (L + FH),
    solvable (rank CE = rank E), fixed_modes (the zeros of (A, E, C), poles of every such observer) and, where L is not
    unique, its family.  The verdict is `no` where rank CE < rank E, and where φ cannot be assigned.
    Raises `InputError` for wrong poles or shapes.
    Source: M. Darouach, M. Zasadzinski and S. J. Xu (1994); J. Chen and R. J. Patton (1999), ch. 3.
    """
    plant = plant.knowing(E, poles, polynomial)
    plant.require("C", task="unknown_input_observer")
    desired = desired_polynomial(plant, poles, polynomial, choose=choose)
    assert desired is not None  # noqa: S101 - required
    enters = read_disturbance_input(plant, E)
    plant, (desired, enters) = in_common_field(plant, desired, enters)
    return choose_method("unknown_input_observer", method, "decoupled").solve(plant, enters, desired).asked(method)


# The page of the unknown-input observer: rank test, H and T, zeros, gain, observer, and its error equation without d.


@page_of(UnknownInputObserver)
def write_unknown_input_observer(page: Builder, design: UnknownInputObserver) -> None:
    """Write the data, why d can be decoupled or not, the gain, and the observer."""
    given(page, ("observer", design.desired), disturbed=design.disturbance_input)
    with page.section("unknown_input_observer"):
        _design(page, design)
        if design.answer["L"] is not None:
            _observer(page, design)
            plot_error(page, "e", page["F_d"])
        page.steps += case_steps(page, design, _case)


def _case(page: Builder, design: UnknownInputObserver) -> None:
    """Write the design on a stratum: whether d can be decoupled, the zeros, and a gain; the rest is made as in general."""
    page.set("E_d", design.disturbance_input)
    page.set("phi_o", design.desired.polynomial)
    H, L = design.answer["H"], design.answer["L"]
    if H is None:
        _not_decoupled(page, design)
        return
    conditions = [c.expression for c in design.holds_where if c.kind != "domain"]
    if conditions:
        page.assume("uio_provided", *conditions)
    _H, C, _identity = page.set("H_d", H), page["C"], page.identity(page.plant.order)
    page.conclude_silently("(H_d C - I) E_d = 0")
    page.define("T_d", "I - H_d C", silent=True)
    page.define("A_T", "T_d A", silent=True)
    _zeros(page, design)
    if L is not None:
        gain = define_gain(page, "L", L)
        page.define("F_d", page["A_T"] - gain @ C, silent=True)
        page.conclude_silently(page.line("det(s I - F_d) = {polynomial}", polynomial=design.desired.polynomial))


def _design(page: Builder, design: UnknownInputObserver) -> None:
    """Write the rank of C E, H and T, the zeros and the gain; or the reason why there is no observer."""
    E, H, L = _independent(page, design), design.answer["H"], design.answer["L"]
    if H is None:
        _not_decoupled(page, design)
        return
    _decoupled(page, design, E, H)
    _zeros(page, design)
    if L is not None:
        _gain(page, design, L)


def _independent(page: Builder, design: UnknownInputObserver) -> Term:
    """Return E, or the letter of its independent columns."""
    found = independent_columns(design.disturbance_input, design.plant.ideal)
    if found.shape[1] == design.disturbance_input.shape[1] or not found.shape[1]:
        return page["E_d"]
    rank = page.line("rank(E_d) = {shape}", shape=found.shape[1])
    return page.define("E_1", page.value(found), say="uio_independent", closing=False, rank=rank)


def _not_decoupled(page: Builder, design: UnknownInputObserver) -> None:
    """Write that E w is not seen in the output, so that no H has H C E = E."""
    C, E, along, found = page["C"], page["E_d"], "", design.answer["w"]
    unseen, direction = C @ E, E
    if found is not None and found.shape[0] > 1:
        w = page.set("w_0", found)
        page.equal("w_0 = #", say="uio_direction")
        C, E = page["C"], page["E_d"]
        unseen, direction, along = C @ E @ w, E @ w, "_along"
    zero, nothing = (Matrix.zeros(size, 1) for size in (page.plant.outputs, page.plant.order))
    differs = relation(direction, "!==" if direction.value.names else "!=", nothing)
    page.conclude(f"uio_not_decoupled{along}", unseen=relation(unseen, zero), nonzero=differs)


def _decoupled(page: Builder, design: UnknownInputObserver, E: Term, H: Matrix) -> None:
    """Write the rank of C E, a solution H of H C E = E, T = I − H C and T A."""
    C = page["C"]
    conditions = [c.expression for c in design.holds_where if c.kind != "domain"]
    if H.is_zero:
        page.define("H_d", page.value(H), say="uio_nothing", closing=False, answer=True)
        if conditions:
            page.assume("uio_provided", *conditions)
    else:
        seen = C @ E
        page.equal(relation(seen, seen.as_value), say="uio_seen")
        if conditions:
            page.assume("uio_provided", *conditions)
        count = seen.value.shape[1]
        page.conclude("uio_decoupled", rank=relation(seen.apply("rank"), E.apply("rank"), count))
        square = seen.value.shape[0] == count
        left = seen.inverse if square else (seen.T @ seen).inverse @ seen.T
        page.define("H_d", E @ left, say="uio_output_matrix", answer=True)
        page.conclude_silently("(H_d C - I) E_d = 0")
    page.define("T_d", "I - H_d C", say="uio_projection")
    page.define("A_T", "T_d A")


def _zeros(page: Builder, design: UnknownInputObserver) -> None:
    """Write whether (C, T A) is observable: its unobservable modes are the zeros of (A, E, C)."""
    assert design.inner is not None  # noqa: S101 - the caller's branch
    pair, plant, C, A = design.inner.pair, page.plant, page["C"], page["A_T"]
    tested = block([[C @ A**k if k else C] for k in range(plant.order)])
    if pair.is_observable:
        assume_rank(page, "uio_provided", design.inner.test, design)
        page.conclude("uio_observable", rank=relation(tested.apply("rank"), plant.order))
        return
    page.set("N", pair.kernel)
    page.set("X", pair.restricted)
    fixed = page["det(pencil(X))"]
    zeros = Roots(fixed.formula, roots_of(design.inner.fixed_polynomial, plant.variable))
    if design.answer["L"] is not None:
        page.conclude("uio_zeros_desired", predicate("polynomial", page["phi_o / det(pencil(X))"]), zeros=zeros)
        return
    keys, polynomial = ("uio_impossible", "uio_unassignable"), design.desired.polynomial
    say_unassignable(page, keys, page["phi_o"], polynomial, fixed, design.case_tree, zeros=zeros)
    signs, discrete = plant.symbols.signs, plant.is_discrete
    found = stability(design.inner.fixed_polynomial, plant.variable, signs, discrete=discrete).verdict
    if found == "yes":
        page.remark("uio_zeros_stable", predicate("stable", fixed))
    elif found == "no":
        page.remark("uio_zeros_unstable", predicate("unstable", fixed))


def _gain(page: Builder, design: UnknownInputObserver, found: Matrix) -> None:
    """Write L, F = T A − L C, and what multiplies y in the equation of z."""
    assert design.inner is not None  # noqa: S101 - there is a gain
    whole = page["A_T"], page["C"]
    terms, say = small_gain_terms(page, design.inner, OBSERVER, *whole)
    if not terms and design.inner.pair.is_observable and page.plant.outputs > 1:
        is_written = write_structured(page, OBSERVER, found, *whole, page["phi_o"], lambda L: page.set("L", L))
        say = "gain_follows" if is_written else say
    L = define_gain(page, "L", *terms, found, say=say or "uio_gain")
    compare_with_simple(page, design.inner, OBSERVER, *whole)
    state = page("A_T - {L} C", L=L)
    driven = L + state @ page["H_d"]
    is_short = is_narrow(Matrix.block([[state.value, driven.value]]))  # then the observer has the values
    shown = [[] if is_short else [letters_apart_from_data(page, part.value)] for part in (state, driven)]
    page.define("F_d", state, *shown[0], say="uio_state_matrix", closing=False)
    page.define("L_y", "L + F_d H_d", *shown[1], closing=False)
    answer = design.answer
    shown_as = {"H_d": answer["H"], "T_d": answer["T"], "L": found, "F_d": answer["F"], "L_y": answer["B_y"]}
    page.conclude_silently(*(relation(page[name], part) for name, part in named_found(shown_as).items()))
    pencil, asked = page["det(pencil(F_d))"], design.desired
    say_as_required(page, asked, pencil, page.value(asked.polynomial))
    caution_poles(page, asked, "phi_o", "observer")
    if not asked.is_numeric:
        say_stability(page, pencil)
    if design.fields["family"] is not None:
        page.remark("uio_family")


def _observer(page: Builder, design: UnknownInputObserver) -> None:
    """Write the observer, and that its error does not depend on u and d."""
    m, name = page.plant.matrices, "w_o" if page.plant.is_discrete else "z_o"
    z = page[name]
    F, B_y, y = (page[letter] for letter in ("F_d", "L_y", "y"))
    pairs = [(F, z)]
    known = y
    if design.answer["B_u"] is not None:
        driven = page["T_d B - L_y D"] if m.has_feedthrough else page["T_d B"]
        pairs.append((driven, page["u"]))
        known = page["y - D u"] if m.has_feedthrough else y
        page.conclude_silently(relation(driven, design.answer["B_u"]))
    pairs.append((B_y, y))
    page.dynamics(name, summed(pairs), silent=True)
    page.signal(
        "x_hat", f"{name} + H_d C x", silent=True
    )  # y − D u, whose parts D u have no derivatives that are known
    page.equal(
        relation(
            z.derivative, summed(pairs), *([combination(page, pairs)] if stand_in_line(page, "F_d", "L_y") else [])
        ),
        page.line(f"x_hat = {name} + H_d {{known}} = {name} + #H_d {{known}}", known=known),
        say="uio_observer",
        answer=True,
    )
    page.signal("e", "x - x_hat", silent=True)
    error = page.line(f"e = x - x_hat = T_d x - {name}")
    page.equal(
        "e' = F_d e + T_d E_d d = F_d e",
        say="uio_error",
        error=error,
    )
