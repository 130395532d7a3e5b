"""The page of a Gramian, in the order of the document: e^{At}, C e^{At}, the integral, the finite sum, the kernel."""

from __future__ import annotations

from typing import TYPE_CHECKING

from symobs.exact import Matrix, Scalar
from symobs.exact.core.generators import substitute
from symobs.formula.phrases.spoken import Counted
from symobs.formula.tree import Conjunction, HoldsExactlyWhere, Literal, Quotient
from symobs.formula.tree.calculus import since_start
from symobs.proof.derivation import CaseStep, Conclude
from symobs.proof.derivation.builder import predicate, relation, sentence
from symobs.stability.inequalities.written_form import as_inequality
from symobs.system.conditions import vanishing_factors
from symobs.tasks.analysis.page_parts import HIDDEN, hidden_polynomial, stratum_of
from symobs.tasks.analysis.time_response.damping_cases import inside_case
from symobs.tasks.analysis.time_response.gramian import Gramian
from symobs.tasks.analysis.time_response.horizons import INFINITE, lyapunov
from symobs.tasks.analysis.time_response.matrix_exponential import (
    closed_form,
    tell_exponential,
    tell_polynomial,
    tell_question,
)
from symobs.tasks.result import page_of

if TYPE_CHECKING:
    from symobs.formula.tree.term import Term
    from symobs.proof.derivation.builder import Builder

#: Lyapunov's equation is shown beside the branches for plants of up to this order.
_LYAPUNOV_UP_TO = 3


@page_of(Gramian)
def write_gramian(page: Builder, result: Gramian) -> None:
    """Write the whole page."""
    horizon = result.answer["horizon"]
    values = list(result.everything())
    if isinstance(horizon, Scalar):
        values += [substitute(value, {"t": horizon}) for value in values]
    page.in_time(*values)
    result.state_data(page)
    is_dual = result.answer["of"] == "controllability"
    if is_dual:
        page.environment = page.environment.extended_by(values={})
    with page.section(f"gramian_{result.answer['of']}"):
        if "exponential" in result.answer or result.answer.get("factor") is not None:
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
    return page["A"].T, page["B"].T


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
    if result.plant.order > _LYAPUNOV_UP_TO:
        return
    A, C = _letters(result, page)
    P = lyapunov(A.value, C.value, discrete=False)
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
    answer = result.answer
    A, C = _letters(result, page)
    if answer.get("question") is not None:
        if answer["horizon"] == INFINITE:
            page.remark("gramian_open", question=answer["question"])
        else:
            tell_question(page, answer["factor"])
        return
    if answer["horizon"] == INFINITE:
        _tell_infinite(result, page, A, C)
        return
    if "exponential" not in answer:
        total = _square(C)
        for k in range(1, int(answer["horizon"].fraction())):
            total = total + _transposed(A) ** k @ _square(C) @ A**k
        page.define(
            "W", total, say="gramian_steps", answer=True, steps=Counted("step", int(answer["horizon"].fraction()))
        )
        _tell_kernel_over_steps(result, page)
        return
    found, _ = closed_form(result.plant, {**answer["taken"], **answer["chosen"]})
    is_dual = answer["of"] == "controllability"
    shown = answer["exponential"].T if is_dual else answer["exponential"]
    tell_exponential(page, found, shown)
    Phi = page["exp_At"]
    seen = Phi @ page["B"] if is_dual else page["C"] @ Phi
    page.equal(relation(seen, seen.as_value), say="input_through_exponential" if is_dual else "output_of_exponential")
    integrand = seen @ page["B"].T @ Phi.T if is_dual else Phi.T @ page["C"].T @ seen
    whole = page.term(since_start(integrand.formula, Literal(answer["function"]), answer["horizon"]))
    W: Matrix = answer["matrix"]
    if page.defines("P_l") and not is_dual:
        over = page.set("Phi_T", substitute(shown, {"t": answer["horizon"]}))
        page.set("W", W)
        page.equal(relation(page["W"], whole, page["P_l"] - over.T @ page["P_l"] @ over), say="gramian_by_lyapunov")
        page.equal(relation(page["W"], W), say="gramian_in_case", answer=True)
    else:
        page.define("W", whole, W, say="gramian_integral", answer=True, closing=False)
    if answer["determinant"] is not None:
        page.equal(relation(page["W"].apply("det"), answer["determinant"]), say="gramian_determinant")


def _tell_infinite(result: Gramian, page: Builder, A: Term, C: Term) -> None:
    """Write the integral over all time: what decays, Lyapunov's equation, its solution."""
    answer = result.answer
    seen = define_seen(result, page)
    if result.decay.verdict == "no":
        page.conclude(f"gramian_diverges_{answer['of']}", predicate("unstable", seen))
        return
    page.set("W", answer["matrix"])
    W = page["W"]
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
    page.equal(relation(W, answer["matrix"]), answer=True)
    page.equal(relation(W.apply("det"), answer["determinant"]), say="gramian_determinant")


def define_seen(result: Gramian, page: Builder) -> Term:
    """Return χ, or the polynomial of the observable (controllable) part: the quotient by that of the other modes."""
    kernel, of = result.answer["rank"]["kernel"], result.answer["of"]
    tell_polynomial(page)
    if not kernel.shape[1]:
        return page["chi"]
    letters = HIDDEN[of]
    page.set(letters[0], kernel)
    X = page.set(letters[1], result.answer["rank"]["restricted"])
    seen = page.term(Quotient(page["chi"].formula, hidden_polynomial(page, X.value.shape[0], letters[1]).formula))
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
            if found.answer["matrix"] is not None:
                there.set("W", found.answer["matrix"])
            _tell_kernel(found, there)
            if len(there.steps) > 1:
                page.steps.append(CaseStep(stratum_of(case), tuple(case.substitution.items()), tuple(there.steps)))


def _tell_kernel_over_steps(result: Gramian, page: Builder) -> None:
    """Write the determinant of W, and that its kernel is trivial or which vectors span it."""
    of, kernel, W = result.answer["of"], result.answer["rank"]["kernel"], page["W"]
    if not kernel.shape[1]:
        _tell_nonsingular(
            f"steps_nonsingular_{of}", "W", result, page, known=result.further_zeros if result.case_tree else ()
        )
        return
    page.equal(relation(W.apply("det"), 0), say="gramian_determinant")
    v = page.set("N" if kernel.shape[1] > 1 else "v", kernel)
    page.equal(relation(v, kernel), relation(W @ v, kernel * 0), say=f"steps_kernel_{of}")


def _tell_nonsingular(key: str, name: str, result: Gramian, page: Builder, known: tuple[Scalar, ...] = ()) -> None:
    """Write that a matrix has a nonzero determinant, as a case unless its factors are known not to vanish."""
    value = page[name].value.determinant()
    stated = relation(page[name].apply("det"), value)
    says = Conclude(sentence(key, {"determinant": stated}), (relation(value, "!=", 0),))
    factors = vanishing_factors([value], result.plant.symbols.signs)
    apart = Conjunction(tuple(relation(factor, "!=", 0) for factor in factors))
    page.steps.append(says if set(factors) <= set(known) else CaseStep(apart, (), (says,)))


def _tell_kernel(result: Gramian, page: Builder) -> None:
    """Write the kernel of the finite sum with its vector, or that there is none."""
    M, kernel = page["M"], result.answer["rank"]["kernel"]
    if not kernel.shape[1]:
        key = "kernel_none_controllability" if result.answer["of"] == "controllability" else "kernel_none"
        is_somewhere = result.answer["horizon"] == INFINITE and bool(result.decay.positive)
        key = "kernel_none_of_sum" if result.answer["matrix"] is None or is_somewhere else key
        _tell_nonsingular(key, "M", result, page)
        return
    if result.answer["matrix"] is None or result.answer["of"] == "controllability":
        return
    several = kernel.shape[1] > 1
    v = page["N"] if several and page.defines("N") else page.set("N" if several else "v", kernel)
    zero = Matrix.zeros(page["C"].value.shape[0], kernel.shape[1])
    nothing = Matrix.zeros(*kernel.shape)
    page.equal(relation(v, v.value), say="kernel_shared")
    if page.defines("exp_At"):
        unseen = relation(page["C"] @ page["exp_At"] @ v, zero)  # what it says is shown
        page.equal(unseen, say="kernel_unseen_several" if several else "kernel_unseen")
    shown = [relation(page["W"] @ v, nothing)] if page.defines("W") else []
    say = "kernel_of_gramian" if page.defines("exp_At") else "kernel_annihilated"
    page.equal(*shown, relation(M @ v, nothing), say=say)
