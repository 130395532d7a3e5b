"""The page of detectability and stabilizability.

Without parameters it follows the definition: the rank of [A − λI; C] at the eigenvalues that are not stable.  With
parameters it goes through ker 𝒪 and the polynomial of the fixed modes.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from symobs.exact import EIGENVALUE
from symobs.formula.tree import Conjunction, HoldsExactlyWhere
from symobs.proof.certificate.claims import verify
from symobs.proof.derivation import CaseStep, Conclude
from symobs.proof.derivation.builder import Builder, predicate, relation, sentence
from symobs.proof.derivation.facts.restriction import on_stratum
from symobs.stability.criteria.stability import stability
from symobs.stability.inequalities.written_form import as_inequality
from symobs.tasks.analysis.modes.detectability import HiddenStability
from symobs.tasks.analysis.modes.modes import stable_modes
from symobs.tasks.analysis.modes.modes_page import (
    at_eigenvalues,
    fixed_modes,
    meeting_steps,
    show_hidden,
    show_spectrum,
    stack_of,
)
from symobs.tasks.analysis.page_parts import (
    as_written,
    given,
    hidden_polynomial,
    say_stability,
    set_anew,
    stratum_of,
    undecided,
)
from symobs.tasks.analysis.rank.rank_page import square_test
from symobs.tasks.result import page_of

if TYPE_CHECKING:
    from symobs.formula.tree.term import Term
    from symobs.proof.derivation import Step
    from symobs.tasks.result import Case


@page_of(HiddenStability)
def write_page(page: Builder, result: HiddenStability) -> None:
    """Write the page."""
    given(page)
    with page.section(result.task):
        parametric = any(part.matrix.names - {EIGENVALUE} for part in result.spectrum)
        direct = all(part.witness is not None for part in result.spectrum)
        if parametric or result.meaning == "lyapunov" or not direct:
            _through_the_kernel(page, result)
        else:
            _at_eigenvalues(page, result)


def _time(page: Builder) -> str:
    return "discrete" if page.plant.is_discrete else "continuous"


def _at_eigenvalues(page: Builder, result: HiddenStability) -> None:
    """Look at the eigenvalues that are not stable, one by one."""
    plant = page.plant
    show_spectrum(page, result)
    page.conclude(f"asks_{result.task}_{_time(page)}")
    unstable = [
        part
        for part in result.spectrum
        if not all(stable_modes(part.roots, plant.symbols.signs, discrete=plant.is_discrete))
    ]
    if unstable:
        at_eigenvalues(page, result, unstable)
    else:
        page.conclude("only_stable", predicate("stable", page["chi"]))
    if result.test.answer["rank"] == plant.order:
        page.conclude(f"no_fixed_modes_{result.kind}")
        page.conclude(f"yes_{result.task}")
        return
    fixed_modes(page, result)
    _hidden_modes(page, result, result.test.answer["kernel"].shape[1])


def _hidden_modes(page: Builder, result: HiddenStability, count: int) -> None:
    """Write the polynomial of the fixed modes and judge it."""
    about = hidden_polynomial(page, count)
    page.conclude_silently(relation(page["N"], result.test.answer["kernel"]))
    page.equal(relation(about, result.answer["fixed_polynomial"]), say="fixed_polynomial")
    _judge(page, result, about)


def _judge(page: Builder, result: HiddenStability, about: Term) -> None:
    """State whether the fixed modes, the roots of `about`, are stable in the chosen meaning."""
    plant, time = page.plant, _time(page)
    found = stability(
        result.answer["fixed_polynomial"], plant.variable, plant.symbols.signs, discrete=plant.is_discrete
    )
    if result.meaning == "lyapunov":
        page.remark("means_lyapunov")
    fact = predicate("stable" if found.verdict == "yes" else "unstable", about)
    if found.verdict == "yes":
        page.conclude(f"stable_{time}", fact)
    elif result.meaning == "lyapunov" and found.verdict == "no":
        _beyond_or_marginal(page, result, about)
        if result.hidden.verdict == "yes":
            fact = predicate("marginal", page["mu"])
        elif result.hidden.annuls is None:
            fact = predicate("beyond", about)
    elif found.verdict == "conditional":
        _where(page, result, about)
        return
    else:
        page.conclude(f"unstable_{time}", fact)
    if result.hidden.verdict == "yes" or (result.hidden.verdict == "no" and result.grows_where == ()):
        page.conclude(f"{result.hidden.verdict}_{result.task}", fact)
    elif result.grows_where:
        page.conclude(f"grows_{result.task}")


def _where(page: Builder, result: HiddenStability, about: Term) -> None:
    """State exactly where the fixed modes are stable; in the weaker meaning also the undecided parameters."""
    signs, conditions = page.plant.symbols.signs, result.hidden.where
    if all(condition.operator == ">=" for condition in conditions):
        solved = [as_inequality(condition.expression, signs) for condition in conditions]
        where = tuple(relation(left, f"{operator}=", right) for left, operator, right in solved)
        page.conclude("marginal_if", where=HoldsExactlyWhere(predicate("marginal", about), where))
        page.conclude(f"exactly_there_{result.task}")
        return
    say_stability(page, about)  # of the polynomial as the page has it, which equations may make a shorter one
    page.conclude(f"exactly_there_{result.task}" if result.meaning == "asymptotic" else "boundary_undecided")


def _beyond_or_marginal(page: Builder, result: HiddenStability, about: Term) -> None:
    time, annuls = _time(page), result.hidden.annuls
    if annuls is None:
        if result.hidden.verdict == "no":
            page.conclude(f"beyond_{time}", predicate("beyond", about))
        else:
            page.remark("lyapunov_undecided")
        return
    mu = page.set("mu", annuls)
    zero = page.value(result.test.answer["restricted"] * 0)
    image = page["X"].apply("mu_at")
    if result.hidden.verdict == "yes":
        if result.meetings:
            page.assume("apart_provided", *result.meetings)
        page.conclude(f"marginal_{time}", predicate("marginal", mu))
        page.conclude("semisimple", relation(image, zero), polynomial=relation(mu, annuls))
        return
    grows = relation(image, "!=", zero)
    words = Conclude(sentence("grows", {"polynomial": relation(mu, annuls)}), (grows,))
    apart = [as_written(condition) for condition in result.grows_where or ()]
    if result.grows_where is not None and verify(grows, page.environment)[0]:
        page.steps.append(words)
    elif apart and verify(grows, on_stratum(Conjunction(tuple(apart)), {}, page.environment))[0]:
        page.steps.append(CaseStep(Conjunction(tuple(apart)), (), (words,)))
    else:
        page.remark("lyapunov_undecided")


# -- through the kernel ------------------------------------------------------------------------------------------------


def _through_the_kernel(page: Builder, result: HiddenStability) -> None:
    """Find the hidden modes as those of A on ker 𝒪, which needs no eigenvalue."""
    page.conclude(f"means_{result.task}")
    observing = result.kind == "observability"
    letter, say = ("O", "observability_matrix") if observing else ("Ctr", "controllability_matrix")
    page.define(letter, stack_of(page, result.kind), say=say)
    square_test(page, letter, result.test, result.kind)
    _generic(page, result)
    _cases(page, letter, result)


def _generic(page: Builder, result: HiddenStability) -> None:
    hidden_ones = result.plant.order - result.test.answer["rank"]
    if not hidden_ones:
        page.conclude(f"seen_{result.task}")
        return
    if "N" not in page.environment.values:  # the rank test has another letter for what the input does not move
        page.set("N", result.test.answer["kernel"])
        page.set("X", result.test.answer["restricted"])
    show_hidden(page, result, "on_kernel")
    _hidden_modes(page, result, hidden_ones)


def _cases(page: Builder, letter: str, result: HiddenStability) -> None:
    """Write the hidden modes and their stability on every stratum, and the ranks at repeated eigenvalues."""
    weaker = result.meaning == "lyapunov"
    for case in (*result.rank_cases, *(result.meeting_cases if weaker else ())):
        page.steps.append(undecided(page, case) if case.result is None else _case(page, letter, case))
    if not weaker:
        page.steps += meeting_steps(page, result)


def _case(page: Builder, letter: str, case: Case) -> Step:
    found: Any = case.result
    inner = Builder(found.plant)
    values = {name: getattr(found.plant.matrices, name) for name in "ABC" if name in page.environment.values}
    inner.environment = page.environment.extended_by(values=values)
    test = found.test.answer
    inner.conclude("case_rank", rank=relation(inner[letter].apply("rank"), test["rank"]))
    if test["kernel"].shape[1]:
        inner.set("N", test["kernel"])
        inner.set("X", test["restricted"])
    _generic(inner, found)
    _cases(inner, letter, found)
    anew = set_anew(page.environment, inner.environment)
    return CaseStep(stratum_of(case), tuple(case.substitution.items()), tuple(inner.steps), anew=anew)
