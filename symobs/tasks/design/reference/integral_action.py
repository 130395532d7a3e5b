"""Integral action:  u = −K x + k_I ξ,  ξ' = r − y,  so that y follows a constant reference r exactly.

Plant and integrator together are ẋ = Â x̂ + B̂ u + [0; I] r with Â = [A 0; −C 0], B̂ = [B; −D] (in discrete time [A 0; −C I]),
and [K, −k_I] is a state feedback of them.  Their poles can be assigned arbitrarily if and only if (A, B) is controllable
and rank [A B; C D] = n + p (rank [A − I, B; C D] in discrete time).  Where that rank is lower no gains make y follow
every constant r, not even if the pole of the integrators that cannot be moved is a desired one.
"""

from __future__ import annotations

from dataclasses import replace
from functools import cached_property
from typing import TYPE_CHECKING, Any, ClassVar, Self

from symobs.exact import Matrix, Scalar, kernel, rank
from symobs.exact.core.generators import identities
from symobs.exact.linear_algebra.transfer_function import Realisation
from symobs.formula.tree import Environment, Evaluated, Literal
from symobs.formula.tree.term import Term, block, identity
from symobs.ground.dataclass import dataclass
from symobs.ground.errors import CertificateRejected
from symobs.proof.derivation.builder import Builder, predicate, relation
from symobs.stability.criteria.stability import stability
from symobs.system import StateSpace
from symobs.system.conditions import joined, nonzero, vanishing_factors
from symobs.system.specification import DesiredPolynomial, desired_polynomial, in_common_field
from symobs.tasks.analysis.page_parts import case_steps, given, say_stability
from symobs.tasks.analysis.strata.loci import distance_from, loci
from symobs.tasks.analysis.strata.rank_stratification import maximal_minors
from symobs.tasks.analysis.strata.strata import found_once, outside, region_of, solved
from symobs.tasks.design.block_diagrams import draw_integral_action
from symobs.tasks.design.full_order.state_feedback import StateFeedbackDesign
from symobs.tasks.design.gain.gain_cases import design_of, places_where
from symobs.tasks.design.gain.gain_design import FEEDBACK, letters_of
from symobs.tasks.design.gain.gain_kind import AssignedGain
from symobs.tasks.design.gain.gain_page import say_as_required
from symobs.tasks.design.gain.small_gain_page import compare_with_simple, small_gain_terms
from symobs.tasks.design.gain.structured_gain_page import write_structured
from symobs.tasks.design.named_gains import gain_letters
from symobs.tasks.design.pole_cautions import caution_poles
from symobs.tasks.design.readability import OUTPUT_DERIVATIVE, UNKNOWN_ENTRIES
from symobs.tasks.design.unassignable import say_unassignable
from symobs.tasks.result import Case, Result, equality, holds, method, page_of, poles_of, task
from symobs.tasks.result import choose as choose_method

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from symobs.formula.tree import Relation
    from symobs.proof.certificate.claims import Certificate, Claim
    from symobs.system.conditions import Condition
    from symobs.system.specification import Name, Poles, PolynomialText


#: What is reported of the feedback of plant and integrator.
_REPORTED = ("poles", "stable", "stable_if", "fixed_modes", "family")


@dataclass
class IntegralAction(Result):
    """K and k_I with det(sI − [A − BK, B k_I; −C + DK, −D k_I]) = φ(s), or the proof that there are none.

    `loop` is the state feedback of plant and integrator together, with its own claims.  `w` is a row with
    w [A B; C D] = 0 where there is one: a zero at the origin, which the integrator's pole would cancel.
    """

    loop: StateFeedbackDesign

    task: ClassVar[str] = "integral_action"
    answered_by = ("K", "k_I")
    gains = ("K", "k_I")
    gains_are_one = True
    letters = {
        "K": "K",
        "k_I": "k_I",
        "polynomial": "chi_cl",
        "closed_loop_matrix": "A_cl",
    }
    panels = ("plane", "responses")

    @classmethod
    def of(cls, plant: StateSpace, desired: DesiredPolynomial, method_name: str) -> Self:
        """Return the design, or the negative result."""
        loop = design_of(
            StateFeedbackDesign, extended(plant), desired, "ackermann" if plant.inputs == 1 else "sylvester"
        )
        return cls.of_loop(plant, loop, method_name)

    @classmethod
    def of_loop(cls, plant: StateSpace, loop: StateFeedbackDesign, method_name: str) -> Self:
        """Return the design that a feedback of plant and integrator is."""
        left = kernel(system_matrix(plant).T, plant.ideal)
        gain, n, every = None if left.shape[1] else loop.answer["K"], plant.order, range(plant.inputs)
        answer = {
            "K": None if gain is None else gain.select(every, range(n)),
            "k_I": None if gain is None else -gain.select(every, range(n, n + plant.outputs)),
            "polynomial": loop.answer["polynomial"],
            "w": left.select(range(left.shape[0]), [0]).T if left.shape[1] else None,
        }
        return cls(plant, method_name, answer, loop)

    def with_gains(self, gains: Mapping[str, Matrix]) -> Self:
        """Return the design with other gains; one that is not given stays."""
        design = self.loop.with_answer(self.loop.letter, self._whole(gains))
        return self.of_loop(self.plant, design, self.method)

    def following_from(self, gains: Mapping[str, Matrix]) -> Self:
        """Return the design of given gains; one that is not given stays."""
        given = self.loop.of_given(self.loop.plant, self._whole(gains))
        placed = DesiredPolynomial(self.plant.variable, (given.answer["polynomial"],))
        return self.of_loop(self.plant, replace(given, kind=AssignedGain(placed)), self.method)

    def design_of(self, gain: str) -> StateFeedbackDesign:  # noqa: ARG002 - one for both
        """Return the feedback of plant and integrator together."""
        return self.loop

    def _whole(self, gains: Mapping[str, Matrix]) -> Matrix:
        first, second = (gains.get(name, self.answer[name]) for name in self.gains)
        if first is None or second is None:
            raise CertificateRejected("there are no such gains")
        return Matrix.block([[first, -second]])

    def claims(self) -> Iterator[Claim]:
        """Yield the polynomial of the closed loop, that it is at rest where y = r, and the rank of [A B; C D]."""
        K, k_I, w, plant = (*(self.answer[name] for name in ("K", "k_I", "w")), self.plant)
        if (K is None) != (w is not None or self.loop.answer["K"] is None) or (K is None) != (k_I is None):
            message = "there are gains exactly where plant and integrator have a feedback and the outputs can follow"
            raise CertificateRejected(message)
        if self.answer["polynomial"] != self.desired.polynomial:  # also where there are no gains to have it
            raise CertificateRejected("the polynomial is the one asked for")
        values = letters_of(plant) | {"D": plant.matrices.D, "K": K, "k_I": k_I, "w": w}
        known = {name: value for name, value in values.items() if value is not None}
        relations = identities([part for part in (K, k_I) if part is not None])[1]
        e = Environment(variable=plant.variable, values=known, relations=relations)
        whole, size = _system(e, plant), extended_order(plant)
        if w is None:
            beside = replace(e, relations=(*relations, *outside(self.distances)), signs=plant.symbols.signs)
            yield equality(whole.apply("rank"), size, beside)
        else:
            yield holds(e, "w {whole} = 0", whole=whole)
            yield holds(e, "w !== 0")
        if K is not None:
            both = block([[e["K"], -e["k_I"]]])
            yield equality(both, self.loop.answer["K"], e, "[K, -k_I] is the feedback of plant and integrator")
            closed = block(closed_loop(e, plant))
            pencil = closed.pencil
            yield equality(pencil.apply("det"), self.answer["polynomial"], e)

    @cached_property
    def blocked(self) -> tuple[tuple[Scalar, ...], ...]:
        """Systems of equations where [A B; C D] loses rank that it has in general; none where it always has it."""
        if self.answer["w"] is not None or not self.plant.field.names:
            return ()
        region = region_of(self.plant)
        minors = [minor.numerator for minor in maximal_minors(system_matrix(self.plant).T)]
        found = loci(region.simplest_first(minor for minor in minors if not minor.is_zero), region)
        return tuple(locus.equations for locus in found)

    @cached_property
    def distances(self) -> tuple[Scalar, ...]:
        """Polynomials that are 0 exactly where [A B; C D] loses rank."""
        return tuple(distance_from(equations) for equations in self.blocked)

    @cached_property
    def assumed(self) -> tuple[Scalar, ...]:
        """What must not vanish for plant and integrator to be controllable."""
        known = self.loop.test.holds_where if self.loop.test.answer["rank"] == self.loop.plant.order else ()
        return tuple(condition.expression for condition in known if condition.kind == "existence")

    @property
    def all_certificates(self) -> tuple[Certificate, ...]:
        """The certificates of the feedback of plant and integrator, and of the gains."""
        return (*self.loop.all_certificates, *self.certificates)

    @property
    def desired(self) -> DesiredPolynomial:
        """The polynomial that is to be assigned."""
        assert self.loop.desired is not None  # noqa: S101 - the feedback is asked for by its polynomial
        return self.loop.desired

    @property
    def verdict(self) -> str:
        """`no` where there are no gains."""
        return "no" if self.answer["K"] is None else super().verdict

    @cached_property
    def holds_where(self) -> tuple[Condition, ...]:
        """Also where the outputs can follow: the factors of what keeps away from where [A B; C D] loses rank."""
        known = super().holds_where
        if self.answer["K"] is None:
            return known
        return joined(known, nonzero("existence", vanishing_factors(self.distances, self.plant.symbols.signs)))

    @cached_property
    def case_tree(self) -> tuple[Case, ...]:
        """The design where other modes than in general are beyond any gain, or none are."""

        def on(there: StateSpace, values: dict[str, Scalar]) -> Result:
            return found_once(type(self), there, self.desired.substitute(values), self.method).with_gains_of(
                self, values
            )

        return solved(self.plant, places_where(self.loop), on)

    @cached_property
    def fields(self) -> Mapping[str, Any]:
        """K, k_I, whether (and where) the rank condition holds, the closed loop in (x, ξ), and what the feedback reports."""
        own = {"K": self.answer["K"], "k_I": self.answer["k_I"], "solvable": self.answer["w"] is None}
        own["solvable_if"] = [" or ".join(f"{e} != 0" for e in equations) for equations in self.blocked]
        closed = None if self.answer["K"] is None else self.loop.fields["closed_loop_matrix"]
        own |= {"polynomial": self.answer["polynomial"], "closed_loop_matrix": closed}
        reported = {name: self.loop.report[name] for name in _REPORTED}
        return own | reported | ({"family": None} if closed is None else {})

    @property
    def free_signals(self) -> Mapping[str, int]:
        """The reference and the integral of its error."""
        return {"r_in": self.plant.outputs, "xi_I": self.plant.outputs}

    @property
    def systems(self) -> Mapping[str, Realisation]:
        """The plant, and the loop from r to y."""
        plant, gain = self.plant, self.loop.answer["K"]
        if gain is None or self.answer["K"] is None:
            return super().systems
        m, p = plant.matrices, plant.outputs
        seen = (Matrix.block([[m.C, Matrix.zeros(p, p)]]) - m.D @ gain).normal()
        enters = Matrix.block([[Matrix.zeros(plant.order, p)], [Matrix.identity(p)]])
        loop = Realisation(self.fields["closed_loop_matrix"].normal(), enters, seen, Matrix.zeros(p, p))
        return {**super().systems, "servo": loop}


def extended(plant: StateSpace) -> StateSpace:
    """Return plant and integrator together, with the states (x, ξ) and the input u."""
    m, n, p = plant.matrices, plant.order, plant.outputs
    own = Matrix.identity(p) if plant.is_discrete else Matrix.zeros(p, p)
    A = Matrix.block([[m.A, Matrix.zeros(n, p)], [-m.C, own]])
    found = StateSpace(A, Matrix.block([[m.B], [-m.D]]), dt=plant.dt, symbols=plant.symbols)
    return plant.beside(found.restricted(plant.equations, plant.nonzero))


def system_matrix(plant: StateSpace) -> Matrix:
    """Return [A B; C D], in discrete time [A − I, B; C D]."""
    m = plant.matrices
    first = m.A - Matrix.identity(plant.order) if plant.is_discrete else m.A
    return Matrix.block([[first, m.B], [m.C, m.D]])


def _system(e: Environment, plant: StateSpace) -> Term:
    A, B, C, D = (e[name] for name in "ABCD")
    return block([[A - identity(plant.order, e) if plant.is_discrete else A, B], [C, D]])


def closed_loop(e: Environment, plant: StateSpace) -> list[list[Term]]:
    """Return the blocks of [A − BK, B k_I; −C + DK, −D k_I], with I − D k_I in discrete time."""
    A, B, C, D, K, k_I = (e[name] for name in ("A", "B", "C", "D", "K", "k_I"))
    p, one = plant.outputs, identity(plant.outputs, e)
    if not plant.matrices.has_feedthrough:
        return [[A - B @ K, B @ k_I], [-C, one if plant.is_discrete else Term(Literal(Matrix.zeros(p, p)), e)]]
    return [[A - B @ K, B @ k_I], [D @ K - C, one - D @ k_I if plant.is_discrete else -D @ k_I]]


@method("integral_action/extended_state", source="davison1976; ogata2010, ch. 10")
def extended_state(plant: StateSpace, desired: DesiredPolynomial) -> IntegralAction:
    """[K, −k_I] is the state feedback of the plant with ξ' = r − y as a further state."""
    return IntegralAction.of(plant, desired, "extended_state")


def extended_order(plant: StateSpace, _: object = None) -> int:
    """Return the number of poles of plant and integrator, n + p."""
    return plant.order + plant.outputs


@task
@poles_of(poles=extended_order)
def integral_action(
    plant: StateSpace,
    *,
    poles: Poles = None,
    polynomial: PolynomialText = None,
    choose: Name = "auto",
    method: Name = "auto",
) -> Result:
    """Let y follow constant references by u = −K x + k_I ξ, ξ' = r − y, with n + p given poles.

    plant         n states, m inputs, p outputs, D allowed; in discrete time ξ(k + 1) = ξ(k) + r − y(k)
    poles         the n + p poles of plant and integrator, closed under conjugation; or
    polynomial    φ, monic of degree n + p
    choose        which gain of several inputs: "simple" or "small", as for `state_feedback`
    Returns K (m×n), k_I (m×p), solvable (rank [A B; C D] = n + p, in discrete time rank [A − I, B; C D]; with parameters
    exactly where all of solvable_if holds), polynomial,
    closed_loop_matrix in (x, ξ), poles, stable; `family` where the gains [K, −k_I] are not unique.  The verdict is `no`
    where that rank is lower or φ cannot be assigned.  Raises `InputError` for wrong poles.
    Source: E. J. Davison (1976); K. Ogata, Modern Control Engineering, 5th ed., ch. 10.
    """
    plant = plant.knowing(poles, polynomial)
    plant.require("B", "C", task="integral_action")
    desired = desired_polynomial(plant, poles, polynomial, degree=extended_order(plant), choose=choose)
    assert desired is not None  # noqa: S101 - required
    plant, (desired,) = in_common_field(plant, desired)
    found: Result = choose_method("integral_action", method, "extended_state").solve(plant, desired)
    return found.asked(method)


# The page of integral action: plant and integrator together, the rank condition, the gains, the closed loop.


@page_of(IntegralAction)
def write_integral_action(page: Builder, design: IntegralAction) -> None:
    """Write the data, the extended plant, the gains and the closed loop."""
    given(page, ("control", design.desired))
    with page.section("integral_action"):
        _extended(page)
        _design(page, design)
        if design.answer["K"] is not None:
            page.equal(
                page.line("[x; xi_I]' = A_cl [x; xi_I] + {enters} r_in", enters=_enters(page)), say="integral_closed"
            )
            if not page.plant.is_discrete:
                draw_integral_action(page)
            _at_rest(page, design)
            caution_poles(page, design.desired, "phi_c", "servo")
        page.steps += case_steps(page, design, _case)


def _case(page: Builder, design: IntegralAction) -> None:
    """Write what is found on a stratum."""
    page.set("phi_c", design.desired.polynomial)
    _name_extended(page)
    _design(page, design, is_case=True)


def _extended(page: Builder) -> None:
    """Write ξ' = r − y, and both equations together."""
    kind = "discrete" if page.plant.is_discrete else "continuous"
    xi, error = page["xi_I"], page["r_in - y"]
    page.dynamics("xi_I", xi + error if page.plant.is_discrete else error, say=f"integral_state_{kind}")
    plant, m = page.plant, page.plant.matrices
    n, p = plant.order, plant.outputs
    corner = page.identity(p) if plant.is_discrete else page.value(Matrix.zeros(p, p))
    parts = page("[A, {p}; -C, {corner}]", p=Matrix.zeros(n, p), corner=corner)
    page.define("A_hat", parts, say="integral_extended")
    below = page["-D"] if m.has_feedthrough else page.value(Matrix.zeros(p, plant.inputs))
    page.define("B_hat", page("[B; {below}]", below=below))
    driven = page("B_hat u + {enters} r_in", enters=_enters(page))
    page.equal(page.line("[x; xi_I]' = A_hat [x; xi_I] + {driven}", driven=driven), say="integral_together")


def _name_extended(page: Builder) -> None:
    """Let the letters of the extended plant stand for its matrices."""
    m = extended(page.plant).matrices
    page.set("A_hat", m.A)
    page.set("B_hat", m.B)


def _enters(page: Builder) -> Term:
    """Return what r is multiplied by: [0; I], of one output the column."""
    order, outputs = page.plant.order, page.plant.outputs
    zero = Matrix.zeros(order, outputs)
    if outputs == 1:
        return page.value(Matrix.block([[zero], [Matrix.identity(outputs)]]))
    return block([[page.value(zero)], [page.identity(outputs)]])


def _design(page: Builder, design: IntegralAction, *, is_case: bool = False) -> None:
    """Write the rank condition, and the gains or the reason why there are none."""
    assumed = design.assumed
    if assumed:
        page.assume("integral_provided", *assumed)
    _say_condition(page, design)
    if design.answer["K"] is None:
        if design.loop.answer["K"] is None:
            _impossible(page, design)
        return
    conditions = [c.expression for c in design.holds_where if c.kind != "domain" and c.expression not in assumed]
    if conditions:
        page.assume("integral_provided", *conditions)
    _gains(page, design)
    if design.fields["family"] is not None:
        page.remark("integral_family")
    if not is_case:
        page.signal("u", "(-K) x + k_I xi_I", say="integral_law")
    _closed_loop(page)


def _system_matrix(page: Builder) -> Term:
    A, plant = page["A"], page.plant
    D = page["D"] if plant.matrices.has_feedthrough else page.value(plant.matrices.D)
    return block([[page["A - I"] if plant.is_discrete else A, page["B"]], [page["C"], D]])


def _controllability(page: Builder) -> Relation:
    """Return rank [B, AB, …] = n, or by how much it is less."""
    A, B, order = page["A"], page["B"], page.plant.order
    tested = block([[A**k @ B if k else B for k in range(order)]])
    found = rank(tested.value, page.plant.ideal)
    whole = tested.apply("rank")
    return relation(whole, order) if found == order else relation(whole, found, "<", order)


def _say_condition(page: Builder, design: IntegralAction) -> None:
    """Say whether plant and integrator are controllable, and by which rank."""
    plant = page.plant
    size, place = plant.order + plant.outputs, "one" if plant.is_discrete else "origin"
    whole, controllable = _system_matrix(page), _controllability(page)
    if design.answer["w"] is not None:
        page.set("w_0", design.answer["w"])
        annuls = page.line("w_0 {whole} = 0", whole=whole)
        page.conclude("integral_blocked", row=page.line("w_0 = #"), annuls=annuls)
    elif len(controllable.operators) > 1:
        page.conclude("integral_uncontrollable", rank=controllable)
    else:
        found = relation(whole.apply("rank"), size)
        page.conclude(f"integral_possible_{place}", controllable=controllable, rank=found)


def _impossible(page: Builder, design: IntegralAction) -> None:
    """Write that the modes of plant and integrator that no gain moves are not among the desired poles."""
    pair = design.loop.pair
    page.set("N_K", pair.kernel)
    page.set("X_K", pair.restricted)
    fixed = page["det(pencil(X_K))"]
    say_unassignable(
        page,
        ("integral_impossible", "integral_unassignable"),
        page["phi_c"],
        design.desired.polynomial,
        fixed,
        design.case_tree,
        fixed=Evaluated(fixed.formula, Literal(design.loop.fixed_polynomial)),
    )


def _gains(page: Builder, design: IntegralAction) -> None:
    """Write [K, −k_I] of the extended plant, and its parts."""
    plant, gain = page.plant, design.loop.answer["K"]
    _both(page, gain)
    whole = page["A_hat"], page["B_hat"]
    compared = plant.inputs == 1 and design.fields["family"] is None and _compare(page, gain, design.desired)
    terms, say = small_gain_terms(page, design.loop, FEEDBACK, *whole)
    if not terms and plant.inputs > 1 and design.loop.fixed_polynomial.is_one:
        found = write_structured(page, FEEDBACK, gain, *whole, page["phi_c"], lambda K: _both(page, K))
        say = "gain_follows" if found else say
    both = _both(page, gain)
    page.equal(relation(both, *terms, gain), say=say or ("hence_gain" if compared else "integral_gains"))
    compare_with_simple(page, design.loop, FEEDBACK, *whole)
    page.equal("K = #", "k_I = #", say="integral_parts", answer=True)
    loop = page["det(pencil(A_hat) + B_hat [K, -k_I])"]
    say_as_required(page, design.desired, loop, page.value(design.desired.polynomial))
    if not design.desired.is_numeric:
        say_stability(page, loop)


def _both(page: Builder, gain: Matrix) -> Term:
    """Let K and k_I be the parts of a gain of plant and integrator, and return [K, −k_I]."""
    rows, order = range(gain.shape[0]), page.plant.order
    page.set("K", gain.select(rows, range(order)))
    page.set("k_I", -gain.select(rows, range(order, gain.shape[1])))
    return page["[K, -k_I]"]


def _compare(page: Builder, gain: Matrix, desired: DesiredPolynomial) -> bool:
    """Compare the coefficients of det(sI − Â + B̂ k), linear in k, with those of φ; return whether they are short enough."""
    if len(gain.entries) > UNKNOWN_ENTRIES:
        return False
    before = page.environment
    row = page.value(gain_letters(page, "K", gain))
    variable = page.plant.variable
    loop = page("det(pencil(A_hat) + B_hat {row})", row=row)
    coefficients = loop.scalar.coefficients(variable)
    if sum(coefficient.size for coefficient in coefficients) > OUTPUT_DERIVATIVE:
        page.environment = before
        return False
    page.equal(relation(loop, page.value(loop.scalar)), say="integral_unknown")
    pairs = zip(coefficients[1:], desired.polynomial.coefficients(variable)[1:], strict=True)
    page.equal(*(relation(have, want) for have, want in pairs if not have.is_constant), say="compare")
    return True


def _closed_loop(page: Builder) -> None:
    """Write the matrix of the closed loop in (x, ξ)."""
    plant = page.plant
    page.define("A_cl", block(closed_loop(page.environment, plant)), say="integral_loop")


def _at_rest(page: Builder, design: IntegralAction) -> None:
    """Write the gain at rest, which is one: the last rows of the closed loop are r − y."""
    plant, A_cl = page.plant, page["A_cl"]
    zero = design.desired.polynomial.substitute({plant.variable: Scalar.of(int(plant.is_discrete))})
    if zero.is_zero:
        return
    C = page["C"]
    corner, seen = page.value(Matrix.zeros(plant.outputs, plant.outputs)), C
    if plant.matrices.has_feedthrough:
        seen, corner = page["C - D K"], page["D k_I"]
    rest = (page["I - A_cl"] if plant.is_discrete else -A_cl).inverse
    gain = block([[seen, corner]]) @ rest @ _enters(page)
    at_rest = relation(gain, Matrix.identity(plant.outputs))
    asked, discrete = design.desired, plant.is_discrete
    if asked.is_numeric and stability(asked.polynomial, plant.variable, {}, discrete=discrete).verdict == "yes":
        has_poles = page.line("det(pencil(A_cl)) = phi_c")
        page.conclude("integral_rest_stable", has_poles, predicate("stable", page["phi_c"]), gain=at_rest)
    else:
        page.conclude("integral_rest", gain=at_rest)
