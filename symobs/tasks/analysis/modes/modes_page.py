"""Parts of pages about single modes: the spectrum, the pencil at each eigenvalue, the modes that cannot be moved."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from symobs.exact import EIGENVALUE, Matrix, Scalar, factored, roots_of
from symobs.formula.tree import Conjunction, Roots
from symobs.formula.tree.term import block
from symobs.proof.certificate.claims import verify
from symobs.proof.derivation import CaseStep, Conclude, Equal, Step
from symobs.proof.derivation.builder import Builder, relation, sentence, shows
from symobs.proof.derivation.facts.restriction import on_stratum
from symobs.tasks.analysis.factored_form import formula_of_factored
from symobs.tasks.analysis.page_parts import as_written, conditions_of, set_anew, undecided
from symobs.tasks.analysis.strata.rank_stratification import maximal_minors
from symobs.tasks.analysis.strata.repeated_eigenvalues import holds_where

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    from symobs.formula.tree import Environment
    from symobs.formula.tree.term import Term
    from symobs.system.conditions import Condition
    from symobs.tasks.analysis.modes.modes import Eigenvalues, ModeResult


def show_spectrum(page: Builder, result: ModeResult) -> None:
    """Write χ with its factors, and its roots."""
    plant, chi = page.plant, result.answer["polynomial"]
    pencil = page.s @ page.identity(plant.order) - page["A"]
    form = factored(chi, plant.variable)
    product = page.term(formula_of_factored(form))
    members = [pencil.apply("det"), page.value(chi)]
    if len(form.factors) > 1 or form.factors[0][1] > 1:
        members.append(product)
    page.define("chi", *members, say="eigenvalue_polynomial", closing=False)
    page.conclude("eigenvalues", roots=Roots(page["chi"].formula, roots_of(chi, plant.variable)))
    if any(not part.roots[0].is_closed for part in result.spectrum):
        page.remark("eigenvalues_open")


def pencil_of(page: Builder, result: ModeResult, value: Scalar | None = None) -> Term:
    """Return [A − λI; C], or [A − λI, B], as a formula."""
    eigenvalue = page.value(Scalar.symbol(EIGENVALUE) if value is None else value)
    shifted = page["A"] - eigenvalue @ page.identity(page.plant.order)
    if result.kind == "observability":
        return block([[shifted], [page["C"]]])
    return block([[shifted, page["B"]]])


def at_eigenvalues(page: Builder, result: ModeResult, parts: Iterable[Eigenvalues]) -> None:
    """Write one matrix and one rank for each eigenvalue, and where the rank is too low the vectors that show it.

    With parameters they hold under the conditions that are told with the eigenvalue.
    """
    wanted = {part.factor for part in parts}
    for part, found, where in result.parts:
        if part.factor in wanted and part.witness is not None and where is not None:
            page.steps += _at(page, result, part, found, holds_where(where))


def _at(page: Builder, result: ModeResult, part: Eigenvalues, rank: int, conditions: list[Condition]) -> list[Step]:
    dual = result.kind == "controllability"
    unknown = page.value(Scalar.symbol(EIGENVALUE))
    pencil, matrix = pencil_of(page, result), part.matrix.T if dual else part.matrix
    at = relation(unknown, part.value) if len(part.roots) == 1 else relation(part.relation, 0)
    ranks = relation(pencil.apply("rank"), page.value(matrix).apply("rank"), rank)
    when = Conjunction((at, *map(as_written, conditions))) if conditions else at
    if part.matrix.names - {EIGENVALUE} and not shows([ranks], on_stratum(when, {}, page.environment)):
        return []  # it is shown by the minors of X − λI, and too long to be shown by those of the whole matrix
    steps: list[Step] = [Equal((ranks,))]
    singular = (page["A"] - unknown @ page.identity(page.plant.order)).apply("det")
    steps.append(Conclude(None, (relation(pencil, matrix), relation(singular, 0))))
    kernel: Matrix = part.witness[2]  # type: ignore[index]
    shown = kernel.shape[1] if _are_independent(kernel, on_stratum(when, {}, page.environment)) else 0
    for j in range(shown):
        v = page.value(kernel.select(range(page.plant.order), [j]))
        zero = Matrix.zeros(part.matrix.shape[0], 1)
        image = relation(v.T @ pencil, zero.T) if dual else relation(pencil @ v, zero)
        steps.append(Equal((image,), sentence(f"pbh_low_{result.kind}", {}) if not j else None))
    return [CaseStep(when, (), tuple(steps))]


def _are_independent(vectors: Matrix, here: Environment) -> bool:
    """Return whether eigenvectors are independent at every point, none of them 0."""
    minors = Matrix.column(maximal_minors(vectors)) if vectors.shape[1] else Matrix.of([[1]])
    return bool(verify(relation(minors, "!=", minors * 0), here)[0])


def meeting_steps(page: Builder, result: ModeResult) -> Iterator[Step]:
    """Yield a case for each stratum on which only eigenvectors are others than in general, with the ranks there."""
    for case in result.meeting_cases:
        if case.result is None:
            yield undecided(page, case)
            continue
        found: Any = case.result
        inner = Builder(found.plant)
        values = {name: getattr(found.plant.matrices, name) for name in "ABC" if name in page.environment.values}
        inner.environment = page.environment.extended_by(values=values)
        at_eigenvalues(inner, found, [part for part, rank, _ in found.parts if rank < found.plant.order])
        inner.steps += meeting_steps(inner, found)
        anew = set_anew(page.environment, inner.environment)
        yield CaseStep(
            conditions_of(case), tuple(case.substitution.items()), tuple(inner.steps), sentence("ranks_meet", {}), anew
        )


def fixed_modes(page: Builder, result: ModeResult) -> None:
    """Establish N and X with A N = N X, C N = 0, and write the polynomial of the fixed modes."""
    test = result.test
    page.set("N", test.answer["kernel"])
    page.set("X", test.answer["restricted"])
    show_hidden(page, result, "fixed_modes")


def show_hidden(page: Builder, result: ModeResult, words: str) -> None:
    """Show N and X, which are established, and what makes the eigenvalues of X the fixed modes."""
    test = result.test
    A = page["A"] if result.kind == "observability" else page["A"].T
    page.equal(
        relation(page["N"], test.answer["kernel"]),
        relation(A @ page["N"], page["N"] @ page["X"]),
        relation(page["X"], test.answer["restricted"]),
        say=f"{words}_{result.kind}",
    )


def stack_of(page: Builder, kind: str) -> Term:
    """Return [C; CA; …] or [B, AB, …] as a formula."""
    powers = range(1, page.plant.order)
    if kind == "observability":
        return block([[page["C"]], *([page["C"] @ page["A"] ** k] for k in powers)])
    return block([[page["B"], *(page["A"] ** k @ page["B"] for k in powers)]])
