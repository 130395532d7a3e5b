"""Parts of pages that several tasks share: the data, and the determinant or rank that decides a test."""

from __future__ import annotations

import itertools
from typing import TYPE_CHECKING, cast

from symobs.exact import Matrix, rank, roots_of, unit_rows
from symobs.formula.phrases.languages import StateChoice
from symobs.formula.tree import Conjunction, Roots
from symobs.formula.tree.term import block
from symobs.formula.tree.written import stacked
from symobs.proof.derivation import CaseStep, Conclude, Equal, Step
from symobs.proof.derivation.builder import Builder, differs, relation, sentence, shows
from symobs.proof.derivation.wording_check import relation_fits
from symobs.system.conditions import vanishing_factors
from symobs.tasks.analysis.page_parts import (
    HIDDEN,
    WRITTEN_UP_TO,
    conditions_of,
    determinant_form,
    environment_on,
    given,
    hidden_polynomial,
    undecided,
)

if TYPE_CHECKING:
    from collections.abc import Sequence

    from symobs.exact import Scalar
    from symobs.formula.tree.term import Term
    from symobs.tasks.analysis.rank.rank_test import RankResult
    from symobs.tasks.result import Case, Result


#: Up to this order the test matrix of several outputs (inputs) in numbers is written whole, as books do.
WHOLE_UP_TO = 3
#: So many sets of rows are tried, of so many outputs (inputs).
_TRIED, _MOST_ROWS = 60, 9
#: More sets of states are not named in one sentence.
NAMED_SETS = 6


def given_here(page: Builder, result: RankResult) -> None:
    """State the data, and on the page of a case alone where it lies."""
    where = () if result.piece is None else result.piece.conditions
    if result.piece is not None:
        page.where(*result.piece.relations(c.expression for c in result.domain))
    given(page, where=where)


def write_test(page: Builder, letter: str, result: RankResult, kind: str) -> bool:
    """Define 𝒪 or 𝒞 block by block and say its rank; return whether it is known to be full for all parameters.

    Of several outputs (inputs) n independent rows (columns) are enough where the rank is full, and elsewhere the first
    blocks that have the rank.
    """
    (row, of), order = (("C", "A") if kind == "observability" else ("B", "A")), page.plant.order
    across = kind == "controllability"
    whole = stacked(row, of, order, across=across)
    chosen = _enough(result)
    if not chosen:
        blocks = _blocks_of_rank(result)
        if blocks < order:
            page.set(letter, page[whole].value)
            first = page.define(f"{letter}_nu", stacked(row, of, blocks, across=across), say=f"first_blocks_{kind}")
            power = page[of] ** blocks
            parts = [first, power @ page[row] if across else page[row] @ power]
            more = block([parts] if across else [[part] for part in parts])
            page.conclude(f"later_blocks_{kind}", rank=relation(more.apply("rank"), first.apply("rank")))
        else:
            page.define(letter, whole, say=f"{kind}_matrix")
        return square_test(page, letter, result, kind)
    page.set(letter, page[whole].value)
    first = _chosen_rows(page, result, chosen, row, across=across)
    page.define(f"{letter}_n", first, say=f"some_rows_{kind}")
    determinant = page[f"det({letter}_n)"]
    page.equal(relation(determinant, determinant_form(page, determinant.scalar), "!=", 0))
    page.conclude(f"independent_{kind}")
    return True


def _chosen_rows(page: Builder, result: RankResult, chosen: Sequence[int], row: str, *, across: bool) -> Term:
    """Return [C; CA; …] where whole blocks are chosen, else single rows [c₁; c₂; c₁A; …]; B, b₁ and columns across."""
    width = result.answer["matrix"].shape[0] // page.plant.order
    powers = sorted({index // width for index in chosen})
    if len(chosen) == len(powers) * width:
        parts = [(page[row], power) for power in powers]
    else:
        values = page[row].value.T if across else page[row].value
        used = sorted({index % width for index in chosen})
        lines = {index: values.select([index], range(values.shape[1])) for index in used}
        letters = {i: page.set(f"{row.lower()}_{i + 1}", line.T if across else line) for i, line in lines.items()}
        parts = [(letters[index % width], index // width) for index in chosen]
    A = page["A"]
    terms = [part if not power else A**power @ part if across else part @ A**power for part, power in parts]
    return block([terms] if across else [[term] for term in terms])


def _enough(result: RankResult) -> tuple[int, ...]:
    """Return n rows of the test matrix that are independent for all parameters; none where the whole matrix is shown."""
    matrix, order = result.answer["matrix"], result.plant.order
    is_short = order <= WHOLE_UP_TO and not matrix.names
    is_needed = order < matrix.shape[0] <= _MOST_ROWS * order and not is_short and result.piece is None
    if not is_needed or result.verdict != "yes" or result.is_too_long:
        return ()
    rows = [index for index, row in enumerate(matrix.rows) if any(row)]
    first = (tuple(result.answer["rows"]), *itertools.islice(itertools.combinations(rows, order), _TRIED))
    for chosen in sorted(first, key=lambda rows: rows[-1]):
        determinant = matrix.select(chosen, range(order)).determinant()
        if determinant and not vanishing_factors([determinant], result.plant.symbols.signs):
            return chosen
    return ()


def _blocks_of_rank(result: RankResult) -> int:
    """Return how many blocks of the test matrix have its rank; all of them where the whole matrix is shown."""
    matrix, order = result.answer["matrix"], result.plant.order
    width = matrix.shape[0] // order
    if matrix.names or order <= WHOLE_UP_TO or width < 2 or result.piece is not None or result.verdict != "no":
        return order
    blocks = (count for count in range(1, order) if _rank_of(matrix, count * width) == result.answer["rank"])
    return next(blocks, order)


def _rank_of(matrix: Matrix, count: int) -> int:
    return rank(matrix.select(range(count), range(matrix.shape[1])))


def square_test(page: Builder, letter: str, result: RankResult, kind: str) -> bool:
    """Decide the test of a matrix: by its determinant where it is square, by its rank otherwise.

    Factors of the determinant that can vanish become conditions from here on.  Return whether the rank is full for all
    parameters from here on, not for generic ones.
    """
    determinant, order = result.test_determinant, page.plant.order
    if result.answer["rank"] < order:
        _deficient(page, letter, result, kind)
        return False
    if determinant is None:
        _outside_drops(page, [c.expression for c in result.holds_where if c.kind == "existence"])
        rank = page.line(f"rank({letter}) = {{value}}", value=result.answer["rank"])
        is_said = result.verdict == "yes" or bool(page.environment.relations)
        is_full = is_said and relation_fits(f"full_rank_{kind}", rank, page.environment)
        page.conclude(f"{'full' if is_full else 'generic'}_rank_{kind}", rank=rank)
        return is_full
    signs = page.plant.symbols.signs
    if determinant.size > WRITTEN_UP_TO:
        page.conclude(f"long_{kind}", count=str(determinant.numerator.size - 1))
        return False
    det = page[f"det({letter})"]
    shown = determinant_form(page, determinant)
    open_factors = vanishing_factors([determinant], signs)
    if not open_factors or not result.case_tree:
        page.equal(relation(det, shown, "!=", 0))
        page.conclude(f"yes_{kind}")
        return True
    page.equal(relation(det, shown))
    page.assume(f"provided_{kind}", *open_factors)
    return True


def assume_rank(page: Builder, say: str, test: RankResult, known: Result) -> None:
    """Assume that a rank is full where a design has no need of it: what is known are the conditions of the design."""
    told = {condition.expression for condition in known.holds_where}
    more = [c.expression for c in test.holds_where if c.kind != "domain" and c.expression not in told]
    if more:
        page.assume(say, *more)


def rank_cases(page: Builder, letter: str, result: RankResult, kind: str) -> None:
    """Say what rank and kernel are on every stratum where they are not the generic ones."""
    page.steps += [_rank_case(page, letter, case, kind) for case in result.case_tree]


def _rank_case(page: Builder, letter: str, case: Case, kind: str) -> Step:
    if case.result is None or environment_on(page, conditions_of(case), case.substitution) is None:
        return undecided(page, case)
    result = cast("RankResult", case.result)
    answer, matrix = result.answer, page[letter] if kind == "observability" else page[f"{letter}.T"]
    steps: list[Step] = []
    if not answer["rank"]:
        steps.append(Conclude(sentence("case_zero", {}), (relation(page[letter], page[letter].value * 0),)))
    else:
        rank = page.line(f"rank({letter}) = {{value}}", value=answer["rank"])
        steps.append(Conclude(sentence("case_rank", {"rank": rank})))
    N, vectors = answer["kernel"], answer["kernel"].shape[1]
    if answer["rank"] and vectors:
        zero = Matrix.zeros(matrix.value.shape[0], vectors)
        words = sentence(f"kernel_{kind}" if vectors == 1 else f"kernel_basis_{kind}", {})
        steps.append(Equal((relation(matrix @ page.value(N), zero),), words))
    steps += repair(page, letter, result, kind)
    return CaseStep(conditions_of(case), tuple(case.substitution.items()), tuple(steps))


def repair(page: Builder, letter: str, result: RankResult, kind: str) -> list[Step]:
    """Say which states would have to be measured (actuated) too: with their unit rows below, the rank is n."""
    sets, order = result.repaired, page.plant.order
    if not 0 < len(sets) <= NAMED_SETS:
        return []
    test, A = (page[letter], page["A"]) if kind == "observability" else (page[f"{letter}.T"], page["A.T"])
    facts = []
    for numbers in sets:
        rows = page.value(unit_rows(order, tuple(number - 1 for number in numbers)))
        below = [[rows], *([rows @ A**k] for k in range(1, order))]
        facts.append(relation(block([[test], *below]).apply("rank"), order))
    if result.piece is not None:  # a rank on a stratum may be beyond what the check of a page can see
        relations = result.piece.relations(c.expression for c in result.domain)
        values = {letter: result.answer["matrix"] if kind == "observability" else result.answer["matrix"].T}
        e = page.environment.extended_by(values=values | {"A": result.plant.matrices.A}).with_relations(relations)
        if not shows(facts, e):
            return []
    words = "one" if len(sets[0]) == 1 else "several"
    return [Conclude(sentence(f"repair_{words}_{kind}", {"states": StateChoice(sets)}), tuple(facts))]


def _deficient(page: Builder, letter: str, result: RankResult, kind: str) -> None:
    _outside_drops(page, _distances(result))
    is_said = not result.case_tree or bool(page.environment.relations)
    tell_deficient(page, letter, result.answer["rank"], kind, everywhere=is_said)
    matrix = page[letter] if kind == "observability" else page[f"{letter}.T"]
    zero = Matrix.zeros(matrix.value.shape[0], 1)
    unseen = [relation(matrix @ page.value(vector), zero) for vector in result.kernel_vectors]
    page.equal(*unseen, say=f"kernel_{kind}" if len(unseen) == 1 else f"kernel_several_{kind}")
    page.steps += outside_cases(page, result, repair(page, letter, result, kind))
    letters = HIDDEN[kind]
    page.set(letters[0], result.answer["kernel"])
    page.set(letters[1], result.answer["restricted"])
    polynomial = result.answer["restricted"].characteristic_polynomial(page.plant.variable)
    page.conclude(
        f"modes_{kind}",
        modes=Roots(
            hidden_polynomial(page, letters[1]).formula,
            roots_of(polynomial, page.plant.variable),
        ),
    )


def tell_deficient(page: Builder, letter: str, rank: int, kind: str, *, everywhere: bool = True) -> None:
    """Say that a rank is below the order, and whether it is this one for all parameters or for generic ones."""
    found = page.line(f"rank({letter}) = {{value}} < {{order}}", value=rank, order=page.plant.order)
    key = "no" if everywhere and relation_fits(f"no_{kind}", found, page.environment) else "generic_low"
    page.conclude(f"{key}_{kind}", rank=found)


def outside_cases(page: Builder, result: Result, steps: list[Step]) -> list[Step]:
    """Return steps as a case of what holds in general, where there are others.

    None where these are everywhere, or too long for the check to be left out.
    """
    apart = _distances(result)
    if not apart or not steps:
        return steps if apart == () else []
    where = Conjunction(tuple(map(differs, apart)))
    return [] if environment_on(page, where) is None else [CaseStep(where, (), tuple(steps))]


def _outside_drops(page: Builder, apart: Sequence[Scalar] | None) -> None:
    """Assume on a stratum, of which a rank is said at every point, that it is outside the cases where it is another."""
    if page.environment.relations and apart:
        page.assume("outside_drops", *apart)


def _distances(result: Result) -> tuple[Scalar, ...] | None:
    """Return what is 0 exactly in the cases; None where one of them is everywhere."""
    from symobs.tasks.analysis.strata.strata import distances, systems_of  # noqa: PLC0415 - it needs the strata, which need pages

    systems = systems_of(result.case_tree)
    return None if systems is None else distances(systems)
