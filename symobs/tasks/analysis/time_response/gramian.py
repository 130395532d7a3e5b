"""Gramians  W = ∫₀ᵀ e^{Aᵀt} Cᵀ C e^{At} dt  in closed form, their determinant and kernel, and the finite sum beside them.

The controllability Gramian is that of (Bᵀ, Aᵀ).  In discrete time W is the sum over the horizon's steps.
"""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING, Any, ClassVar, NotRequired, Self, TypedDict

from symobs.exact import Matrix, Scalar, modulo, product_of
from symobs.exact.core.generators import function_named, substitute
from symobs.exact.time_functions.matrix_exponential import NoClosedForm
from symobs.exact.time_functions.quasipolynomial import (
    Table,
    determinant,
    integral,
    matrix_at,
    product,
    table_of,
    transposed,
)
from symobs.formula.phrases.languages import Counted
from symobs.formula.tree import Conjunction, HoldsExactlyWhere, Literal, Quotient
from symobs.formula.tree.calculus import since_start
from symobs.formula.tree.term import Term, identity, letter
from symobs.ground.dataclass import dataclass
from symobs.ground.errors import InputError
from symobs.proof.certificate.claims import Claim
from symobs.proof.derivation import CaseStep, Conclude
from symobs.proof.derivation.builder import predicate, relation, sentence
from symobs.stability.criteria.stability import StabilityVerdict, stability
from symobs.stability.inequalities.simplify import as_inequality
from symobs.system.conditions import Condition, vanishing_factors
from symobs.tasks.analysis.page_parts import HIDDEN, hidden_polynomial, redefined_letters, stratum_of
from symobs.tasks.analysis.rank.rank_test import (
    minor_claim,
    power_rows,
    rank_answer,
    rank_claims,
    rank_environment,
    rank_losses,
)
from symobs.tasks.analysis.strata.strata import distances, systems_of
from symobs.tasks.analysis.time_response.damping_cases import (
    DampingAnswer,
    DampingCases,
    Signs,
    exponential_claims,
    from_zero,
    inside_case,
    rate_of,
    reject,
    time_environment,
    vanishing_denominators,
)
from symobs.tasks.analysis.time_response.horizons import (
    INFINITE,
    infinite_gramian,
    lyapunov,
    lyapunov_operator,
    over_horizon,
    read_horizon,
    steps_gramian,
    symmetric,
    upper_entries,
)
from symobs.tasks.analysis.time_response.matrix_exponential import (
    TIME,
    closed_form,
    has_sums,
    motion,
    question_of,
    require_continuous,
    tell_exponential,
    tell_polynomial,
    tell_question,
)
from symobs.tasks.result import Case, Result, choose, holds, method, page_of, task
from symobs.tasks.result.answers import those_found

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from symobs.formula.tree import Environment
    from symobs.proof.derivation.builder import Builder
    from symobs.system import StateSpace
    from symobs.system.specification import Horizon, Name
    from symobs.tasks.analysis.strata.strata import RankAnswer


KINDS_OF = ("observability", "controllability")
#: Determinants of entries with more terms than this together are left out.
_MOST_TERMS = 60
#: Up to this order there is always one.
_ALWAYS_WITH_DETERMINANT = 2


def pair_of(plant: StateSpace, of: str) -> tuple[Matrix, Matrix]:
    """Return (A, C), or (Aᵀ, Bᵀ) for controllability."""
    m = plant.matrices
    return (m.A, m.C) if of == "observability" else (m.A.T, m.B.T)


def _pair_seen(A: Matrix, C: Matrix, plant: StateSpace, end: Scalar | None) -> tuple[Matrix, Matrix]:
    """Return the pair whose observability matrix has the kernel of W.

    It is (A, C), since the rank of [C; CA; …] has stopped growing after n rows; over fewer steps than states it is
    (0, [C; CA; …]) with as many rows as steps.
    """
    if not plant.is_discrete or end is None or end.fraction() >= plant.order:
        return A, C
    rows = power_rows(A, C)
    return A * 0, rows.select(range(int(end.fraction()) * C.shape[0]), range(plant.order))


class GramianAsked(TypedDict):
    """What is observed or controlled, and the horizon, `inf` for all time."""

    of: str
    horizon: Scalar | str


class GramianAnswer(GramianAsked, DampingAnswer):
    """W, also as a function of t, e^{At} (its transpose for controllability), and the polynomial of what is seen."""

    rank: RankAnswer
    finite_sum: Matrix
    matrix: Matrix | None
    determinant: Scalar | None
    function: NotRequired[Matrix]
    exponential: NotRequired[Matrix]
    seen: NotRequired[Scalar]


@dataclass
class Gramian(DampingCases):
    """W with W = ∫ of its integrand (checked by differentiation), its determinant, Σ (Aᵀ)ᵏ Cᵀ C Aᵏ, and the kernel."""

    answer: GramianAnswer
    task: ClassVar[str] = "gramian"
    answered_by = ("matrix",)
    only_value = ("matrix", "determinant")
    leads = ("matrix",)
    letters = {"matrix": "W", "determinant": "det W", "finite_sum": "M", "kernel": "N"}
    asked_for: ClassVar[tuple[str, ...]] = ("horizon",)

    @classmethod
    def of(cls, plant: StateSpace, method_name: str, asked: GramianAsked, taken: Signs) -> Self:
        """Return the result for a plant."""
        A, C = pair_of(plant, asked["of"])
        end = _instant(asked["horizon"])
        found = rank_answer(*_pair_seen(A, C, plant, end), plant.ideal)
        O = modulo(power_rows(A, C), plant.ideal)
        shared: GramianAnswer = {
            "of": asked["of"],
            "horizon": asked["horizon"],
            "taken": taken,
            "chosen": {},
            "rank": found,
            "finite_sum": (O.T @ O).normal(),
            "matrix": None,
            "determinant": None,
        }
        if end is None:
            return cls(plant, method_name, {**shared, **infinite_gramian(plant, A, C, found)})
        if plant.is_discrete:
            W = steps_gramian(A, C, end)
            return cls(plant, method_name, {**shared, "matrix": W, "determinant": W.determinant()})
        try:
            exponential, chosen = closed_form(plant, taken, sums=has_sums(plant))
            W_t = None if exponential.is_closed else _with_sums(plant, A, C)
        except NoClosedForm as error:
            return cls(plant, method_name, {**shared, "question": question_of(error), "factor": error.factor})
        shared["chosen"] = chosen
        if W_t is not None:
            return cls(plant, method_name, {**shared, "matrix": substitute(W_t, {"t": end}), "function": W_t})
        table = exponential.table() if asked["of"] == "observability" else transposed(exponential.table())
        seen = product(table_of(C), table)
        integrals = integral(product(transposed(seen), seen))
        answer: GramianAnswer = {
            **shared,
            "matrix": matrix_at(integrals, end),
            "determinant": _determinant(integrals, end),
            "function": matrix_at(integrals, TIME),
            "exponential": matrix_at(table, TIME),
        }
        return cls(plant, method_name, answer)

    @property
    def matrices(self) -> tuple[Matrix | Scalar, ...]:
        """The functions of time, at the horizon too."""
        answer = self.answer
        return those_found(answer["matrix"], answer["determinant"], answer.get("function"), answer.get("exponential"))

    @property
    def verdict(self) -> str:
        """`no` where an integral over all time does not exist, not even where less is seen."""
        if not self.has_answer:
            return "conditional" if self._kept else "no"
        return super().verdict

    @property
    def is_over_steps(self) -> bool:
        """Whether W is a sum over a number of steps, which its own determinant and kernel describe."""
        return self.plant.is_discrete and self.end is not None

    @property
    def has_answer(self) -> bool:
        """Whether the generic observable part decays, if it must."""
        return self.decay.verdict != "no"

    @cached_property
    def _kept(self) -> tuple[Case, ...]:
        """The cases with a convergent infinite-horizon integral, where the generic observable part does not decay."""
        if self.has_answer:
            return ()
        return tuple(case for case in self.case_tree if case.result is not None and case.result.verdict != "no")

    @cached_property
    def decay(self) -> StabilityVerdict:
        """Whether the observable part decays, which the infinite horizon requires."""
        if "seen" not in self.answer:
            return StabilityVerdict("yes")
        plant = self.plant
        return stability(self.answer["seen"], plant.variable, plant.symbols.signs, discrete=plant.is_discrete)

    @cached_property
    def holds_where(self) -> tuple[Condition, ...]:
        """Also the conditions for an integral over all time to exist."""
        if systems := systems_of(self._kept):
            return (*self.domain, Condition("existence", product_of(distances(systems)), "=="))
        exists = self.decay.positive if self.answer["matrix"] is not None else ()
        beyond = [Condition("existence", value, ">") for value in exists]
        return (*super().holds_where, *beyond)

    @cached_property
    def denominators(self) -> tuple[Scalar, ...]:
        """Also those of what is seen: on a curve its coefficients may have poles, where it decays or not anew."""
        divided = [*self.matrices, self.answer["seen"]] if "seen" in self.answer else self.matrices
        return vanishing_denominators(divided, self.plant)

    @property
    def further_zeros(self) -> tuple[Scalar, ...]:
        """Where the kernel may be another one, and more of what grows unseen."""
        return rank_losses(self.answer["rank"], self.plant.symbols.signs)

    def claims(self) -> Iterator[Claim]:
        """Yield the integral, symmetry, determinant, finite sum, rank and kernel."""
        yield from super().claims()
        A, C = pair_of(self.plant, self.answer["of"])
        found, W = self.answer["rank"], self.answer["matrix"]
        pair = _pair_seen(A, C, self.plant, self.end)
        e = rank_environment(self.plant, pair, found)
        yield from rank_claims(found, e)
        yield from minor_claim(found, e)
        values: dict[str, Any] = {"A": A, "C": C, "M": self.answer["finite_sum"]}
        plain = time_environment(self.plant, values)
        a, c, m = letter("A", plain), letter("C", plain), letter("M", plain)
        total = c.T @ c
        for k in range(1, self.plant.order):
            total = total + (a.T) ** k @ c.T @ c @ a**k
        yield holds(plain, "M = {total}", total=total)
        kernel = found["kernel"]
        if kernel.shape[1] and pair == (A, C):
            zero = Matrix.zeros(*kernel.shape)
            yield Claim(relation(m @ Term(Literal(kernel), plain), zero), plain)
        if self.end is None:
            yield from self._about_decay(e)
        if W is None:
            return
        values |= {"W": W, **({"N": kernel} if kernel.shape[1] else {})}
        if self.answer["determinant"] is None and self.plant.order <= _ALWAYS_WITH_DETERMINANT:
            reject("the determinant of a small Gramian is missing")
        if self.answer["determinant"] is not None:
            values["determinant"] = self.answer["determinant"]
        if "function" in self.answer:
            values["primitive"] = self.answer["function"]
        if "exponential" in self.answer:
            values["exp_At"] = self.answer["exponential"]
        e = time_environment(self.plant, values, self.end)
        yield from self._about_gramian(e)

    def _about_decay(self, e: Environment) -> Iterator[Claim]:
        """Yield the claims on the observable part; if it surely grows the integral does not exist."""
        count, seen = self.answer["rank"]["restricted"].shape[0], Term(Literal(self.answer["seen"]), e)

        def polynomial(name: str, order: int) -> Term:
            return (letter("s", e) @ identity(order, e) - letter(name, e)).apply("det")

        product = polynomial("X", count) * seen if count else seen
        yield Claim(relation(polynomial("A", self.plant.order), product), e)
        if self.answer["matrix"] is not None and self.decay.verdict not in {"yes", "conditional"}:
            reject("an integral over all time of what does not decay is none")

    def _about_gramian(self, e: Any) -> Iterator[Claim]:
        A, C = letter("A", e), letter("C", e)
        end = self.end
        if end is None and self.plant.is_discrete:
            yield holds(e, "A.T W A - W + C.T C = 0")
        elif end is None:
            yield holds(e, "A.T W + W A + C.T C = 0")
        elif "exponential" in self.answer:
            Phi = letter("exp_At", e)
            yield from exponential_claims(e)
            integrand = Phi.T @ C.T @ C @ Phi
            yield from from_zero(["primitive"], e)
            whole = Term(since_start(integrand.formula, letter("primitive", e).formula, end), e)
            yield holds(e, "W = {whole}", whole=whole)
        elif "function" in self.answer:
            moving = letter("primitive", e)
            yield from from_zero(["primitive"], e)
            balance = relation(rate_of(moving), A.T @ moving + moving @ A + C.T @ C)
            yield Claim(balance, e)
            yield holds(e, "W = {horizon}", "W at the horizon", horizon=moving.at("t", end))
        else:
            total = C.T @ C
            for k in range(1, int(end.fraction())):
                total = total + (A.T) ** k @ C.T @ C @ A**k
            yield holds(e, "W = {total}", total=total)
        yield holds(e, "W = W.T")
        if self.answer["determinant"] is not None:
            yield holds(e, "det(W) = determinant")
        if "N" in e.values:
            yield holds(e, "W N = 0")

    @property
    def named_data(self) -> Mapping[str, Any]:
        """W."""
        return {"W": self.answer["matrix"]}

    def consequences(self, given: Mapping[str, Any]) -> Mapping[str, Any]:
        """Return the determinant of another W."""
        W = given["matrix"]
        return {"determinant": W.determinant()} if W.shape[0] == W.shape[1] else {}

    @cached_property
    def fields(self) -> Mapping[str, Any]:
        """Matrix, determinant, finite sum, rank and kernel."""
        kernel = self.answer["rank"]["kernel"]
        vectors = [list(kernel.select(range(kernel.shape[0]), [j]).entries) for j in range(kernel.shape[1])]
        asked = self.answer.get("question")
        found: dict[str, object] = {"matrix": self.answer["matrix"], "determinant": self.answer["determinant"]}
        found |= {"finite_sum": self.answer["finite_sum"], "rank": self.answer["rank"]["rank"], "kernel": vectors}
        return {**found, **({"question": asked} if asked else {})}


def _with_sums(plant: StateSpace, A: Matrix, C: Matrix) -> Matrix:
    """Return W(t) with W′ = AᵀW + WA + CᵀC and W(0) = 0, in sums over the roots that the modes of this equation have.

    The motion of its n(n+1)/2 different entries beside a constant.  Raises `NoClosedForm` where these are too many.
    """
    constant = upper_entries(C.T @ C).normal()
    count = constant.shape[0]
    operator = lyapunov_operator(A, discrete=False)
    whole = Matrix.block([[operator, constant], [Matrix.zeros(1, count + 1)]])
    found = motion(plant, whole, Matrix.unit(count + 1, count)).matrix(TIME)
    return symmetric(found.select(range(count), [0]))


def _instant(horizon: object) -> Scalar | None:
    """Return the horizon where it is finite."""
    return horizon if isinstance(horizon, Scalar) else None


def _determinant(W: Table, horizon: Scalar) -> Scalar | None:
    """Return det W as a sum of functions, None where it would be long."""
    if len(W) > _ALWAYS_WITH_DETERMINANT and sum(len(entry.terms) for row in W for entry in row) > _MOST_TERMS:
        return None
    return determinant(W).value_at(horizon)


@method("gramian/integral", source="kalman1963a")
def by_integral(plant: StateSpace, of: str, horizon: Scalar | str) -> Gramian:
    """Integrate the entries of e^{Aᵀt} Cᵀ C e^{At} as sums of tⁿ e^{αt} cos βt and sin βt; over all time by Lyapunov."""
    return Gramian.of(plant, "integral", {"of": of, "horizon": horizon}, {})


@task
def gramian(plant: StateSpace, *, horizon: Horizon = None, of: Name = "auto", method: Name = "auto") -> Result:
    """Return the Gramian W = ∫₀ᵀ e^{Aᵀt} Cᵀ C e^{At} dt (of = "controllability": ∫₀ᵀ e^{At} B Bᵀ e^{Aᵀt} dt).

    plant    n states; C (or B) must be given; without `of` it is observability where there is a C
    horizon  T > 0, a symbol or a number ("T" if left out), or "inf"; in discrete time a number of steps (n if left out)
    Returns matrix, determinant, finite_sum (Σ (Aᵀ)ᵏ Cᵀ C Aᵏ), rank, kernel; verdict no where the integral over all time
    does not exist.  Raises `InputError` where the horizon is not one.
    Source: R. E. Kalman, Y. C. Ho and K. S. Narendra (1963); R. W. Brockett (1970).
    """
    of = plant.pair_asked_for(of)
    if of not in KINDS_OF:
        message = f"{of[:40]!r} is not a kind of Gramian"
        raise InputError(message, where="specification.of", repair="write observability or controllability")
    plant.require("C" if of == "observability" else "B", task="gramian")
    end = read_horizon(plant, horizon)
    if not plant.is_discrete:
        require_continuous(plant, "gramian")
    return over_horizon(lambda: choose("gramian", method, "integral").solve(plant, of, end))


# The page of a Gramian, in the order of the document: e^{At}, C e^{At}, the integral, the finite sum, the kernel.


#: Lyapunov's equation is shown beside the branches for plants of up to this order.
_LYAPUNOV_UP_TO = 3


@page_of(Gramian)
def write_gramian(page: Builder, result: Gramian) -> None:
    """Write the whole page."""
    page.in_time(*result.everything(), at=result.end)
    result.state_data(page)
    is_dual = result.answer["of"] == "controllability"
    if is_dual:
        page.environment = page.environment.extended_by(values={})
    with page.section(f"gramian_{result.answer['of']}"):
        if "function" in result.answer or result.answer.get("factor") is not None:
            tell_polynomial(page)
        if result.answer["chosen"]:
            _tell_lyapunov(result, page)
        result.write_branches(page, _write_branch)
    if not result.is_over_steps and (result.answer["matrix"] is not None or result.decay.verdict == "no"):
        with page.section("finite_sum"):
            _tell_finite_sum(result, page)


def _letters(result: Gramian, page: Builder) -> tuple[Term, Term]:
    """Return the terms A and C of the pair: (Aᵀ, Bᵀ) for controllability."""
    if result.answer["of"] == "observability":
        return page["A"], page["C"]
    return page["A.T"], page["B.T"]


def _square(row: Term) -> Term:
    """Return CᵀC, or BBᵀ where the row is Bᵀ."""
    formula = row.formula
    inner = getattr(formula, "operand", None)
    return (row._with(inner) if inner is not None else row.T) @ row  # noqa: SLF001


def _transposed(term: Term) -> Term:
    inner = getattr(term.formula, "operand", None)
    return term._with(inner) if inner is not None else term.T  # noqa: SLF001


def _tell_lyapunov(result: Gramian, page: Builder) -> None:
    """Define P where Lyapunov's equation has one solution: it serves every branch."""
    if result.plant.order > _LYAPUNOV_UP_TO or any(map(function_named, result.plant.field.names)):
        return
    A, C = _letters(result, page)
    P = lyapunov(A.value, C.value.T @ C.value, result.plant)
    if P is None:
        return
    page.set("P_l", P)
    letter = page["P_l"]
    equation = relation(_transposed(A) @ letter + letter @ A, -_square(C))
    page.equal(relation(letter, P), say="lyapunov", equation=equation)
    if vanishing_factors([P.common_denominator()], result.plant.symbols.signs):
        page.remark("lyapunov_denominator")


def _write_branch(page: Builder, result: Gramian) -> None:
    """Write one branch: e^{At}, its output C e^{At}, the integral."""
    answer, end, W = result.answer, result.end, result.answer["matrix"]
    A, C = _letters(result, page)
    if end is None:
        _tell_infinite(result, page, A, C)
        return
    if W is None:
        tell_question(page, answer.get("factor"))
        return
    if "function" in answer and "exponential" not in answer:
        moving = page.set("W_t", answer["function"])
        equation = relation(rate_of(moving), _transposed(A) @ moving + moving @ A + _square(C))
        start = page.line("W_t(t = 0) = 0")
        held = moving.at("t", end)
        page.define(
            "W",
            held,
            W,
            say="gramian_by_sums",
            answer=True,
            closing=False,
            equation=equation,
            start=start,
        )
        return
    if "exponential" not in answer:
        total = _square(C)
        for k in range(1, int(end.fraction())):
            total = total + _transposed(A) ** k @ _square(C) @ A**k
        page.define("W", total, say="gramian_steps", answer=True, steps=Counted("step", int(end.fraction())))
        _tell_kernel_over_steps(result, page)
        return
    found, _ = closed_form(result.plant, {**answer["taken"], **answer["chosen"]})
    is_dual = answer["of"] == "controllability"
    shown = answer["exponential"].T if is_dual else answer["exponential"]
    tell_exponential(page, found, shown)
    seen = page["exp_At B"] if is_dual else page["C exp_At"]
    page.equal(relation(seen, seen.as_value), say="input_through_exponential" if is_dual else "output_of_exponential")
    integrand = page("{seen} B.T exp_At.T", seen=seen) if is_dual else page("exp_At.T C.T {seen}", seen=seen)
    whole = page.term(since_start(integrand.formula, Literal(answer["function"]), end))
    if page.defines("P_l") and not is_dual and result.plant.admits(page["P_l"].value):
        page.set("Phi_T", substitute(shown, {"t": end}))
        page.set("W", W)
        page.equal(page.line("W = {whole} = P_l - Phi_T.T P_l Phi_T", whole=whole), say="gramian_by_lyapunov")
        page.equal(relation(page["W"], W), say="gramian_in_case", answer=True)
    else:
        page.define("W", whole, W, say="gramian_integral", answer=True, closing=False)
    if answer["determinant"] is not None:
        page.equal(page.line("det(W) = {determinant}", determinant=answer["determinant"]), say="gramian_determinant")


def _tell_infinite(result: Gramian, page: Builder, A: Term, C: Term) -> None:
    """Write the integral over all time: what decays, Lyapunov's equation, its solution."""
    answer, value = result.answer, result.answer["matrix"]
    if "question" in answer:
        page.remark("gramian_open", question=answer["question"])
        return
    seen = define_seen(result, page)
    if value is None:
        page.conclude(f"gramian_diverges_{answer['of']}", predicate("unstable", seen))
        return
    W = page.set("W", value)
    moved = _transposed(A) @ W @ A - W if result.plant.is_discrete else _transposed(A) @ W + W @ A
    equation = relation(moved, -_square(C))
    where = result.decay.positive
    if where:
        found = [as_inequality(value, result.plant.symbols.signs) for value in where]
        listed = tuple(relation(left, operator, right) for left, operator, right in found)
        page.conclude("gramian_exists_if", where=HoldsExactlyWhere(predicate("stable", seen), listed))
    else:
        page.conclude(f"gramian_infinite_{answer['of']}", predicate("stable", seen))
    count = answer["rank"]["kernel"].shape[1]
    if count:
        nothing = relation(W @ page[HIDDEN[answer["of"]][0]], answer["rank"]["kernel"] * 0)
        page.conclude("lyapunov_with_kernel", nothing, equation=equation, nothing=nothing)
    else:
        page.conclude("lyapunov_alone", equation=equation)
    page.equal(relation(W, value), answer=True)
    if answer["determinant"] is not None:
        page.equal(page.line("det(W) = {determinant}", determinant=answer["determinant"]), say="gramian_determinant")


def define_seen(result: Gramian, page: Builder) -> Term:
    """Return χ, or the polynomial of the observable (controllable) part: the quotient by that of the other modes."""
    kernel, of = result.answer["rank"]["kernel"], result.answer["of"]
    tell_polynomial(page)
    if not kernel.shape[1]:
        return page["chi"]
    letters = HIDDEN[of]
    page.set(letters[0], kernel)
    page.set(letters[1], result.answer["rank"]["restricted"])
    seen = page.term(Quotient(page["chi"].formula, hidden_polynomial(page, letters[1]).formula))
    shown = relation(seen, result.answer["seen"]), relation(page[letters[0]], kernel)
    page.equal(*shown, say=f"part_{of}")
    return seen


def _tell_finite_sum(result: Gramian, page: Builder) -> None:
    """Write Σ (Aᵀ)ᵏ Cᵀ C Aᵏ and its kernel, also in the cases."""
    A, C = _letters(result, page)
    total = _square(C)
    for k in range(1, result.plant.order):
        total = total + _transposed(A) ** k @ _square(C) @ A**k
    page.define("M", total, say="finite_sum_is")
    _tell_kernel(result, page)
    known = result.answer["rank"]["kernel"].shape[1]
    for case in result.case_tree:
        found = case.result
        if isinstance(found, Gramian) and found.answer["rank"]["kernel"].shape[1] > known:
            there = inside_case(page, found.plant, case.substitution)
            before = there.environment
            if found.answer["matrix"] is not None:
                there.set("W", found.answer["matrix"])
            _tell_kernel(found, there)
            if len(there.steps) > 1:
                anew = redefined_letters(before, there.environment)
                page.steps.append(
                    CaseStep(stratum_of(case), tuple(case.substitution.items()), tuple(there.steps), anew=anew)
                )


def _tell_kernel_over_steps(result: Gramian, page: Builder) -> None:
    """Write the determinant of W, and that its kernel is trivial or which vectors span it."""
    of, kernel, W = result.answer["of"], result.answer["rank"]["kernel"], page["W"]
    if not kernel.shape[1]:
        _tell_nonsingular(
            f"steps_nonsingular_{of}", "W", result, page, known=result.further_zeros if result.case_tree else ()
        )
        return
    page.equal("det(W) = 0", say="gramian_determinant")
    v = page.set("N" if kernel.shape[1] > 1 else "v", kernel)
    page.equal(relation(v, kernel), relation(W @ v, kernel * 0), say=f"steps_kernel_{of}")


def _tell_nonsingular(key: str, name: str, result: Gramian, page: Builder, known: tuple[Scalar, ...] = ()) -> None:
    """Write that a matrix has a nonzero determinant, as a case unless its factors are known not to vanish."""
    value = page[name].value.determinant()
    stated = page.line(f"det({name}) = {{value}}", value=value)
    says = Conclude(sentence(key, {"determinant": stated}), (relation(value, "!=", 0),))
    factors = vanishing_factors([value], result.plant.symbols.signs)
    apart = Conjunction(tuple(relation(factor, "!=", 0) for factor in factors))
    page.steps.append(says if set(factors) <= set(known) else CaseStep(apart, (), (says,)))


def _tell_kernel(result: Gramian, page: Builder) -> None:
    """Write the kernel of the finite sum with its vector, or that there is none."""
    M, kernel = page["M"], result.answer["rank"]["kernel"]
    is_elsewhere = result.plant.is_discrete and not page.defines("W")  # what W is is told in cases
    if not kernel.shape[1]:
        key = "kernel_none_controllability" if result.answer["of"] == "controllability" else "kernel_none"
        is_somewhere = result.answer["horizon"] == INFINITE and bool(result.decay.positive)
        key = "kernel_none_of_sum" if result.answer["matrix"] is None or is_somewhere or is_elsewhere else key
        _tell_nonsingular(key, "M", result, page)
        return
    if result.answer["matrix"] is None or result.answer["of"] == "controllability" or is_elsewhere:
        return
    several = kernel.shape[1] > 1
    is_known = several and page.defines("N") and page["N"].value == kernel
    v = page["N"] if is_known else page.set("N" if several else "v", kernel)
    zero = Matrix.zeros(page["C"].value.shape[0], kernel.shape[1])
    nothing = Matrix.zeros(*kernel.shape)
    page.equal(relation(v, v.value), say="kernel_shared")
    if page.defines("exp_At"):
        unseen = page.line("C exp_At {v} = {zero}", v=v, zero=zero)  # what it says is shown
        page.equal(unseen, say="kernel_unseen_several" if several else "kernel_unseen")
    shown = [relation(page["W"] @ v, nothing)] if page.defines("W") else []
    say = "kernel_of_gramian" if page.defines("exp_At") else "kernel_annihilated"
    page.equal(*shown, relation(M @ v, nothing), say=say)
