"""Parts of pages that several tasks share: the data, and the determinant or rank that decides a test."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, cast

from symobs.analysis.missing import in_words
from symobs.certificate import verify
from symobs.conditions import vanishing_factors
from symobs.derivation import Case as CaseStep
from symobs.derivation import Conclude, Equal, Note, Step
from symobs.derivation.words import fits
from symobs.exact import Factored, Matrix, Scalar, factored, places, root_of_pole, roots_of, unit_rows
from symobs.formula import Decimals, Exactly, Literal, Negative, Power, Product, Quotient, Roots, Together
from symobs.formula.term import block
from symobs.page import Page, predicate, relation, sentence
from symobs.stability import as_inequality, stability

if TYPE_CHECKING:
    from symobs.analysis.rank_result import RankResult
    from symobs.conditions import Condition
    from symobs.formula import Formula, Relation
    from symobs.formula.term import Term
    from symobs.method import Case
    from symobs.specification import DesiredPolynomial


#: A polynomial of more terms is not written out among words.
WRITTEN_UP_TO = 200
#: More sets of states are not named in one sentence.
NAMED_SETS = 6
#: A row of a matrix that is longer than this, written in one line, does not fit beside others.
_WIDEST = 80
#: More decimals of the data are not told as fractions.
_DECIMALS = 4


def given(page: Page, *desired: tuple[str, DesiredPolynomial | None]) -> None:
    """State the plant, and the poles or polynomials asked for under their names (`control`, `observer`, …)."""
    plant, m = page.plant, page.plant.matrices
    with page.section("given"):
        if plant.origin is not None:
            from symobs.analysis.cancelled_poles import state_transfer_function  # noqa: PLC0415 - it stands on this module

            state_transfer_function(page)
        page.set("A", m.A)
        relations = []
        rate = _as_given(page, m.A) @ page["x"]
        if m.has_input:
            page.set("B", m.B)
            rate = rate + _as_given(page, m.B) @ page["u"]
        relations.append(relation(page["x"].derivative, rate))
        page.environment = page.environment.having(dynamics={"x": rate.formula})
        if m.has_output:
            page.set("C", m.C)
            output = _as_given(page, m.C) @ page["x"]
            if m.has_feedthrough:
                page.set("D", m.D)
                output = output + _as_given(page, m.D) @ page["u"]
            relations.append(relation(page["y"], output))
            page.environment = page.environment.having(signals={"y": output.formula})
        page.given(*relations)
        _hold_to_letters(page)
        if plant.is_from_floats:
            page.remark("from_floats")
        _say_decimals(page)
        state_signs(page)
        for name, wish in desired:
            if wish is not None:
                _asked(page, name, wish)


def _as_given(page: Page, matrix: Matrix) -> Term:
    """Return a matrix of the data: in decimals where the data are, and all its entries can be."""
    if page.plant.is_in_decimals and all(places(entry) is not None for entry in matrix.entries):
        return page.term(Decimals(matrix))
    return page.value(matrix)


def _say_decimals(page: Page) -> None:
    """Say which fractions the decimals of the data are, where they are few."""
    m, plant = page.plant.matrices, page.plant
    entries = [entry for matrix in (m.A, m.B, m.C, m.D) for entry in matrix.entries if places(entry)]
    sizes = dict.fromkeys(-entry if entry.fraction() < 0 else entry for entry in entries)
    if plant.is_in_decimals and 0 < len(sizes) <= _DECIMALS:
        page.remark("exact_decimals", numbers=Together(tuple(relation(page.term(Decimals(v)), v) for v in sizes)))


def _hold_to_letters(page: Page) -> None:
    """Bind what is displayed to the letters: ẋ = A x + B u, y = C x + D u, and P to its realisation."""
    m, x, u = page.plant.matrices, page["x"], page["u"]
    rate = page["A"] @ x + page["B"] @ u if m.has_input else page["A"] @ x
    facts = [relation(x.derivative, rate)]
    if m.has_output:
        output = page["C"] @ x + page["D"] @ u if m.has_feedthrough else page["C"] @ x
        facts.append(relation(page["y"], output))
    if page.plant.origin is not None:
        resolvent = (page.s @ page.identity(page.plant.order) - page["A"]).inverse
        response = page["C"] @ resolvent @ page["B"]
        facts.append(relation(page["P"], response + page["D"] if m.has_feedthrough else response))
    page.conclude_silently(*facts)


def _asked(page: Page, name: str, wish: DesiredPolynomial) -> None:
    """State the poles or the polynomial asked for."""
    phi = page.set(f"phi_{name[0]}", wish.polynomial)
    if wish.poles:
        roots = tuple(root_of_pole(pole, page.plant.variable) for pole in wish.poles)
        page.conclude(f"{name}_{'pole' if len(roots) == 1 else 'poles'}", poles=Roots(phi.formula, roots))
    else:
        page.conclude(f"{name}_polynomial", polynomial=relation(phi, wish.polynomial))


def state_signs(page: Page) -> None:
    """Say which parameters have a declared sign."""
    by_sign: dict[str, list[str]] = {}
    used = page.plant.field.names
    for name, sign in page.plant.symbols.signs.items():
        if name in used and sign != "real":
            by_sign.setdefault(sign, []).append(name)
    facts = {"positive": ">", "negative": "<", "nonnegative": ">=", "nonpositive": "<=", "nonzero": "!="}
    declared = [relation(Scalar.symbol(name), facts[sign], 0) for sign, names in by_sign.items() for name in names]
    if declared:
        page.conclude("declared", signs=Together(tuple(declared)))


def is_narrow(*matrices: Matrix) -> bool:
    """Whether matrices can be read on a page: the widest row, with its fractions in one line."""
    return all(sum(len(str(entry)) for entry in row) <= _WIDEST for matrix in matrices for row in matrix.rows)


def factored_form(page: Page, value: Scalar) -> Term:
    """Return a scalar written as a product or quotient of its factors in the variable."""
    return page.term(formula_of_factored(factored(value, page.plant.variable, monic=False)))


def formula_of_factored(form: Factored) -> Formula:
    """Return the formula of a factored form: unit and powers, over powers."""
    above = [_power(f, p) for f, p in form.factors if p > 0]
    below = [_power(f, -p) for f, p in form.factors if p < 0]
    unit = form.unit
    if below and not unit.denominator.is_one:
        below.insert(0, Literal(unit.denominator))
        unit = unit.numerator
    negative = bool(above or below) and unit.is_constant and unit.fraction() < 0
    if negative:
        unit = -unit
    if not unit.is_one or not above:
        above.insert(0, Literal(unit))
    top = above[0] if len(above) == 1 else Product(tuple(above))
    whole = top if not below else Quotient(top, below[0] if len(below) == 1 else Product(tuple(below)))
    return Negative(whole) if negative else whole


def _power(factor: Scalar, exponent: int) -> Formula:
    return Literal(factor) if exponent == 1 else Power(Literal(factor), exponent)


def determinant_form(page: Page, value: Scalar) -> Term:
    """Return a determinant as its irreducible factors where it has several, else as it is."""
    unit, factors = value.factors()
    if len(factors) < 2 and all(power == 1 for _, power in factors):
        return page.value(value)
    return page.term(formula_of_factored(Factored(unit, factors)))


def square_test(page: Page, letter: str, result: RankResult, kind: str) -> None:
    """Decide the test of a matrix: by its determinant where it is square, by its rank otherwise.

    Factors of the determinant that can vanish become conditions from here on.
    """
    determinant, order = result.test_determinant, page.plant.order
    if result.answer["rank"] < order:
        _deficient(page, letter, result, kind)
        return
    if determinant is None:
        key = "full_rank" if result.verdict == "yes" else "generic_rank"
        page.conclude(f"{key}_{kind}", rank=relation(page[letter].apply("rank"), result.answer["rank"]))
        return
    signs = page.plant.symbols.signs
    if determinant.size > WRITTEN_UP_TO:
        page.conclude(f"long_{kind}", count=str(determinant.numerator.size - 1))
        return
    det = page[letter].apply("det")
    shown = determinant_form(page, determinant)
    open_factors = vanishing_factors([determinant], signs)
    if not open_factors:
        page.equal(relation(det, shown, "!=", 0))
        page.conclude(f"yes_{kind}")
        return
    page.equal(relation(det, shown))
    page.assume(f"provided_{kind}", *open_factors)


def rank_cases(page: Page, letter: str, result: RankResult, kind: str) -> None:
    """Say what rank and kernel are on every stratum where they are not the generic ones."""
    page.steps += [_rank_case(page, letter, case, kind) for case in result.case_tree]


def conditions_of(case: Case) -> Relation | Together:
    """Return the equations and inequations of a case; p = q is written for p − q = 0 of two terms."""
    relations = tuple(as_written(condition) for condition in case.when)
    return relations[0] if len(relations) == 1 and len(case.substitution) == 1 else Together(relations)


def stratum_of(case: Case) -> Relation | Together:
    """Return what a case says of the parameters: a single equation as p = 0."""
    return relation(case.when[0].expression, 0) if len(case.when) == 1 else conditions_of(case)


def as_written(condition: Condition) -> Relation:
    """Return a condition with p = q for p − q = 0 of two terms."""
    value, operator = condition.expression, condition.operator.replace("==", "=")
    terms = value.terms()
    if [coefficient > 0 for coefficient, _ in terms] in ([True, False], [False, True]):
        first, second = (
            math.prod((Scalar.symbol(name) ** power for name, power in powers), start=Scalar.of(abs(coefficient)))
            for coefficient, powers in sorted(terms, key=lambda term: term[0] < 0)
        )
        return relation(first, operator, second)
    return relation(value, operator, 0)


def _rank_case(page: Page, letter: str, case: Case, kind: str) -> Step:
    if case.result is None:
        return undecided(page, case)
    result = cast("RankResult", case.result)
    answer, matrix = result.answer, page[letter] if kind == "observability" else page[letter].T
    steps: list[Step] = []
    if not answer["rank"]:
        steps.append(Conclude(sentence("case_zero", {}), (relation(page[letter], page[letter].value * 0),)))
    else:
        rank = relation(page[letter].apply("rank"), answer["rank"])
        steps.append(Conclude(sentence("case_rank", {"rank": rank})))
    N, vectors = answer["kernel"], answer["kernel"].shape[1]
    if answer["rank"] and vectors:
        zero = Matrix.zeros(matrix.value.shape[0], vectors)
        words = sentence(f"kernel_{kind}" if vectors == 1 else f"kernel_basis_{kind}", {})
        steps.append(Equal((relation(matrix @ page.value(N), zero),), words))
    steps += repair(page, letter, result, kind)
    return CaseStep(conditions_of(case), tuple(case.substitution.items()), tuple(steps))


def repair(page: Page, letter: str, result: RankResult, kind: str) -> list[Step]:
    """Say which states would have to be measured (actuated) too: with their unit rows below, the rank is n."""
    sets, order = result.repaired, page.plant.order
    if not 0 < len(sets) <= NAMED_SETS:
        return []
    test, A = (page[letter], page["A"]) if kind == "observability" else (page[letter].T, page["A"].T)
    facts = []
    for numbers in sets:
        rows = page.value(unit_rows(order, tuple(number - 1 for number in numbers)))
        below = [[rows], *([rows @ A**k] for k in range(1, order))]
        facts.append(relation(block([[test], *below]).apply("rank"), order))
    if result.piece is not None:  # a rank on a stratum may be beyond what the check of a page can see
        relations = result.piece.relations(c.expression for c in result.domain)
        values = {letter: result.answer["matrix"] if kind == "observability" else result.answer["matrix"].T}
        e = page.environment.having(values=values | {"A": result.plant.matrices.A}).under(relations)
        if not all(verify(fact, e)[0] for fact in facts):
            return []
    words = "one" if len(sets[0]) == 1 else "several"
    return [Conclude(sentence(f"repair_{words}_{kind}", {"states": in_words(sets)}), tuple(facts))]


def undecided(page: Page, case: Case) -> Step:
    """Return the remark that names a part of the parameters that the page does not decide."""
    if not case.when:
        return Note(sentence("undecided_rank", {}))
    simplest, *others = sorted((condition.expression for condition in case.when), key=lambda value: value.size)
    if simplest.size > WRITTEN_UP_TO:
        return Note(sentence("undecided_long", {"count": str(simplest.numerator.size - 1)}))
    first = page.value(simplest)
    if len(others) > 1 or any(other.size > WRITTEN_UP_TO for other in others):
        return Note(sentence("undecided_many", {"when": first, "count": str(len(others))}))
    if others:
        return Note(sentence("undecided_together", {"when": first, "other": page.value(others[0])}))
    return Note(sentence("undecided_case", {"when": first}))


def _deficient(page: Page, letter: str, result: RankResult, kind: str) -> None:
    rank = result.answer["rank"]
    told = relation(page[letter].apply("rank"), rank, "<", page.plant.order)
    key = "no" if not result.case_tree and fits(f"no_{kind}", told, page.environment) else "generic_low"
    page.conclude(f"{key}_{kind}", rank=told)
    matrix = page[letter] if kind == "observability" else page[letter].T
    for vector in result.kernel_vectors:
        zero = Matrix.zeros(matrix.value.shape[0], 1)
        page.equal(relation(matrix @ page.value(vector), zero), say=f"kernel_{kind}")
    page.steps += _outside_cases(result, repair(page, letter, result, kind))
    letters = HIDDEN[kind]
    page.set(letters[0], result.answer["kernel"])
    page.set(letters[1], result.answer["restricted"])
    polynomial = result.answer["restricted"].characteristic_polynomial(page.plant.variable)
    page.conclude(
        f"modes_{kind}",
        *hidden(page, kind == "observability", letters),
        modes=Roots(
            hidden_polynomial(page, len(result.kernel_vectors), letters[1]).formula,
            roots_of(polynomial, page.plant.variable),
        ),
    )


def _outside_cases(result: RankResult, steps: list[Step]) -> list[Step]:
    """Return steps as a case of what holds in general, where there are others; none where these are everywhere."""
    from symobs.analysis.meetings import distances, systems_of  # noqa: PLC0415 - it needs the strata, which need pages

    systems = systems_of(result.case_tree)
    if not systems or not steps:
        return steps if systems == () else []
    apart = tuple(relation(distance, "!=", 0) for distance in distances(systems))
    return [CaseStep(Together(apart), (), tuple(steps))]


#: The letters of what is not seen, and of what is not moved: a page may speak of both.
HIDDEN = {"observability": ("N", "X"), "controllability": ("N_K", "X_K")}


def hidden(page: Page, is_observer: bool, letters: tuple[str, str] = ("N", "X")) -> tuple[Relation, ...]:  # noqa: FBT001
    """Return that the columns of N are a basis of an invariant subspace never seen (never moved): CN = 0, AN = NX."""
    N, X = (page[name] for name in letters)
    A, row = (page["A"], page["C"]) if is_observer else (page["A"].T, page["B"].T)
    count = N.value.shape[1]
    zero = Matrix.zeros(row.value.shape[0], count)
    return relation(row @ N, zero), relation(A @ N, N @ X), relation(N.apply("rank"), count)


def hidden_polynomial(page: Page, order: int, name: str = "X") -> Term:
    """Return det(sI − X): the polynomial of the hidden modes."""
    return (page.s @ page.identity(order) - page[name]).apply("det")


def say_stability(page: Page, about: Term) -> None:
    """Say whether the polynomial that a term means is stable, or exactly where."""
    plant, polynomial = page.plant, about.scalar
    found = stability(polynomial, plant.variable, plant.symbols.signs, discrete=plant.is_discrete)
    time = "discrete" if plant.is_discrete else "continuous"
    if found.verdict == "yes":
        page.conclude(f"stable_{time}", predicate("stable", about))
    elif found.verdict == "no":
        page.conclude(f"unstable_{time}", predicate("unstable", about))
    else:
        inequalities = [as_inequality(value, plant.symbols.signs) for value in found.positive]
        where = tuple(relation(left, operator, right) for left, operator, right in inequalities)
        page.conclude(f"stable_if_{time}", where=Exactly(predicate("stable", about), where))
