"""Parts shared by the pages of analysis and design: the given data, cases, factored forms and stability."""

from __future__ import annotations

from fractions import Fraction
from itertools import accumulate
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

from symobs.exact import (
    AlgebraicExtension,
    Factored,
    Matrix,
    Scalar,
    TooLarge,
    decimal_places,
    factored,
    product_of,
    root_of_pole,
    roots_of,
    transfer,
)
from symobs.exact.algebraic.dead_time_margins import pade_error
from symobs.exact.core.generators import NotWritten, all_roots, exponentials_in, symbols_named
from symobs.exact.numerals.written_digits import DATA_DIGITS
from symobs.formula.tree import (
    Conjunction,
    Decimals,
    HoldsExactlyWhere,
    Literal,
    Negative,
    Power,
    Product,
    Quotient,
    Roots,
)
from symobs.formula.tree.term import block
from symobs.ground.errors import DerivationRejected
from symobs.proof.derivation import CaseStep, Note, Step
from symobs.proof.derivation.builder import Builder, differs, predicate, relation, sentence
from symobs.proof.derivation.facts import on_stratum, polynomial_of
from symobs.stability.criteria.stability import monic, stability
from symobs.stability.inequalities.simplify import as_inequality
from symobs.system.conditions import Condition, sign_of, solved, vanishing_factors
from symobs.system.reading import is_identity
from symobs.system.transfer_function_text import REALISATIONS
from symobs.system.transfer_matrix import WrittenTransferMatrix

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence

    from symobs.formula.tree import Environment, Formula, Relation
    from symobs.formula.tree.term import Term
    from symobs.system.specification import DesiredPolynomial
    from symobs.tasks.result import Case, Result


# Rational functions as products of powers of their irreducible factors.


def factored_form(page: Builder, value: Scalar) -> Term:
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


def over(numerator: Scalar, own: Scalar, polynomial: Factored) -> Factored:
    """Return numerator · own / Π factors with the desired factors in the denominator, none of them made monic."""
    unit, above = numerator.factors()
    sign = _sign(own)
    below = tuple((factor, -power) for factor, power in polynomial.factors)
    return Factored(unit * sign, (*above, (own * sign, 1), *below))


def _sign(polynomial: Scalar) -> int:
    """Return the sign that a polynomial is printed with, as a factor."""
    return -1 if sign_of(polynomial.factors()[0], {}) == "negative" else 1


def cancelled(numerator: Scalar, own: Scalar, polynomial: Factored, variable: str) -> Factored:
    """Return the same, with the parameters that `own` divides by cancelled against those in front of the numerator."""
    form = over(numerator, own, polynomial)
    if own.denominator.is_constant:
        return form
    unit, above = numerator.factors()
    whole = product_of(factor**power for factor, power in above if variable not in factor.names) * own
    number, below = whole.denominator.factors()
    rest = ((factor, power) for factor, power in above if variable in factor.names)
    sign = _sign(whole.numerator)
    parts = (*rest, (whole.numerator * sign, 1), *((factor, -power) for factor, power in below))
    return Factored(unit * sign / number, (*parts, *(f for f in form.factors if f[1] < 0 and variable in f[0].names)))


def case_steps(page: Builder, result: Result, write: Callable[[Builder, Any], None]) -> Iterator[Step]:
    """Yield a case for each stratum of a result; `write` tells what the result is there."""
    for case in result.case_tree:
        here = environment_on(page, stratum_of(case), case.substitution)
        if case.result is None or here is None:
            yield undecided(page, case)
            continue
        found = case.result
        inner = Builder(found.plant)
        matrices = {name: getattr(found.plant.matrices, name) for name in "ABCD" if name in here.values}
        inner.environment = here.extended_by(values=matrices)
        write(inner, found)
        inner.steps += case_steps(inner, found, write)
        anew = redefined_letters(here, inner.environment)
        yield CaseStep(stratum_of(case), tuple(case.substitution.items()), tuple(inner.steps), anew=anew)


def environment_on(
    page: Builder, when: Relation | Conjunction, substitution: Mapping[str, Scalar] = MappingProxyType({})
) -> Environment | None:
    """Return what the letters of a page mean on a stratum; None where the check does not see that it is described right."""
    try:
        return on_stratum(when, dict(substitution), page.environment)
    except (TooLarge, DerivationRejected, NotWritten):
        return None


def redefined_letters(outer: Environment, inner: Environment) -> tuple[str, ...]:
    """Return the letters, other than the data's, that a case gives a value that they have not outside."""
    return tuple(name for name, value in inner.values.items() if name not in "ABCD" and value != outer.values.get(name))


#: A polynomial of more terms is not written out among words.
WRITTEN_UP_TO = 200
#: A row of a matrix that is longer than this, written in one line, does not fit beside others.
_WIDEST = 80
#: More decimals of the data are not told as fractions.
_DECIMALS = 4


def given(
    page: Builder,
    *desired: tuple[str, DesiredPolynomial | None],
    where: Iterable[Condition] = (),
    disturbed: Matrix | None = None,
    by: str = "d",
    is_question: bool = False,
) -> None:
    """State the plant, and the desired poles or polynomials by name (`control`, `observer`, …).

    `where` says further of which parameters the page speaks; `disturbed` is the E of ẋ = A x + B u + E d, `by` the letter of d.
    What an answer about a linearisation says of the plant itself is said with the answer, not with an `is_question`, and so are
    the matrices of a linearisation.
    """
    plant, m = page.plant, page.plant.matrices
    with page.section("given"):
        if plant.origin is not None:
            state_transfer_function(page)
        if plant.nonlinear is not None:
            from symobs.tasks.analysis import linearisation_page  # noqa: PLC0415 - of such plants alone

            if not plant.nonlinear.equilibrium:
                linearisation_page.state_nonlinear(page, plant.nonlinear, is_question=is_question)
                state_signs(page)
                return
            linearisation_page.state_linearisation(page, is_question=is_question)
        page.set("A", m.A)
        relations = []
        rate = _as_given(page, m.A) @ page["x"]
        if m.has_input:
            page.set("B", m.B)
            rate = rate + _as_given(page, m.B) @ page["u"]
        if disturbed is not None:
            page.set("E_d", disturbed)
            rate = rate + _as_given(page, disturbed) @ page[by]
        relations.append(page.line("x' = {rate}", rate=rate))
        page.environment = page.environment.extended_by(dynamics={"x": rate.formula})
        if m.has_output:
            page.set("C", m.C)
            output = _as_given(page, m.C) @ page["x"]
            if m.has_feedthrough:
                page.set("D", m.D)
                output = output + _as_given(page, m.D) @ page["u"]
            relations.append(relation(page["y"], output))
            page.environment = page.environment.extended_by(signals={"y": output.formula})
        is_found = plant.nonlinear is not None and is_question  # by the student
        page.given(*relations, silent=is_found)
        _hold_to_letters(page, by)
        _state_dead_time(page)
        if plant.is_from_floats:
            page.remark("from_floats")
        if plant.is_rounded:
            page.remark("data_rounded", digits=str(DATA_DIGITS))
        if not is_found:
            _say_decimals(page)
        state_signs(page)
        if plant.nonlinear is not None and not is_question:
            page.remark("linearisation_proves")
            page.remark("linearisation_leaves_open")
        _state_stratum(page, where)
        for name, desired_polynomial in desired:
            if desired_polynomial is not None:
                _asked(page, name, desired_polynomial)


def _state_dead_time(page: Builder) -> None:
    """State the dead time at the input, or what stands for it."""
    plant = page.plant
    if plant.delay is not None:
        page.remark("dead_time", time=relation(page.set("T_t", plant.delay), plant.delay))
    if plant.delays:
        page.remark("dead_time_steps", number=str(plant.delays))
    if plant.approximates is None:
        return
    delay, order = plant.approximates
    page.remark("dead_time_pade", time=relation(page.set("T_p", delay), delay), order=str(order))
    if plant.inputs == plant.outputs == 1 and not {*plant.matrices.symbols, *delay.names}:
        m = plant.matrices
        for told in pade_error(*transfer(m.A, m.B, m.C, m.D[0, 0], plant.variable), delay, order):
            slots = {name: page.term(Decimals(Scalar.of(Fraction(text)))) for name, text in told.items()}
            page.remark("dead_time_pade_error", order=str(order), **slots)


def _as_given(page: Builder, matrix: Matrix) -> Term:
    """Return a matrix of the data: in decimals where the data are, and all its entries can be."""
    places = [decimal_places(entry) for entry in matrix.entries]
    if page.plant.is_in_decimals and any(places) and None not in places:
        return page.term(Decimals(matrix))
    return page.value(matrix)


def _say_decimals(page: Builder) -> None:
    """Say which fractions the decimals of the data are, where they are few."""
    m, plant = page.plant.matrices, page.plant
    entries = [entry for matrix in (m.A, m.B, m.C, m.D) for entry in matrix.entries if decimal_places(entry)]
    sizes = dict.fromkeys(-entry if entry.fraction() < 0 else entry for entry in entries)
    if plant.is_in_decimals and 0 < len(sizes) <= _DECIMALS:
        page.remark("exact_decimals", numbers=Conjunction(tuple(relation(page.term(Decimals(v)), v) for v in sizes)))


def _hold_to_letters(page: Builder, by: str) -> None:
    """Bind what is displayed to the letters: ẋ = A x + B u, y = C x + D u, and P to its realisation."""
    m, x = page.plant.matrices, page["x"]
    rate = page["A x + B u"] if m.has_input else page["A x"]
    if page.defines("E_d"):
        rate = page(f"{{rate}} + E_d {by}", rate=rate)
    facts = [relation(x.derivative, rate)]
    if m.has_output:
        output = page["C x + D u"] if m.has_feedthrough else page["C x"]
        facts.append(relation(page["y"], output))
    if page.plant.origin is not None:
        response = page["C pencil(A)^-1 B"]
        facts.append(relation(page["P"], page["C pencil(A)^-1 B + D"] if m.has_feedthrough else response))
    page.conclude_silently(*facts)


def _asked(page: Builder, name: str, desired_polynomial: DesiredPolynomial) -> None:
    """State the desired poles or the desired polynomial."""
    phi = page.set(f"phi_{name[0]}", desired_polynomial.polynomial)
    if desired_polynomial.poles:
        roots = tuple(root_of_pole(pole, page.plant.variable) for pole in desired_polynomial.poles)
        page.conclude(f"{name}_{'pole' if len(roots) == 1 else 'poles'}", poles=Roots(phi.formula, roots))
    else:
        page.conclude(f"{name}_polynomial", polynomial=relation(phi, desired_polynomial.polynomial))
    if desired_polynomial.pattern is not None:
        from symobs.tasks.analysis.pole_pattern_page import say_pattern  # noqa: PLC0415 - only such poles pay for it

        say_pattern(page, phi, desired_polynomial)


def state_signs(page: Builder) -> None:
    """Say which parameters have a declared sign."""
    by_sign: dict[str, list[str]] = {}
    used = {*page.asked}.union(*map(symbols_named, page.plant.field.names))
    for name, sign in page.plant.symbols.signs.items():
        if name in used and sign != "real":
            by_sign.setdefault(sign, []).append(name)
    facts = {"positive": ">", "negative": "<", "nonnegative": ">=", "nonpositive": "<=", "nonzero": "!="}
    declared = [relation(Scalar.symbol(name), facts[sign], 0) for sign, names in by_sign.items() for name in names]
    if declared:
        page.conclude("declared", signs=Conjunction(tuple(declared)))


def _state_stratum(page: Builder, further: Iterable[Condition]) -> None:
    """Say, on the page of a case alone, of which parameters it speaks."""
    plant = page.plant
    here = [Condition("existence", value, "==") for value in plant.equations if not is_identity(value)]
    apart = vanishing_factors(plant.nonzero, plant.symbols.signs)
    if plant.equations:
        here += [Condition("existence", value) for value in apart]
    elif apart:
        page.assume("stratum", *apart)
    here += further
    if here:
        page.conclude("stratum", condition=Conjunction(tuple(map(as_written, here))))


def in_blocks(page: Builder, value: Matrix, heights: Sequence[int], widths: Sequence[int]) -> Term:
    """Return a matrix divided into blocks, between which pages draw lines; blocks without rows or columns are left out."""
    parts = [
        [range(end - size, end) for size, end in zip(sizes, accumulate(sizes), strict=True) if size]
        for sizes in (heights, widths)
    ]
    return block(
        [[letters_apart_from_data(page, value.select(rows, columns)) for columns in parts[1]] for rows in parts[0]]
    )


def letters_apart_from_data(page: Builder, value: Matrix) -> Term:
    """Return a matrix written out, the letters in an entry apart from the data where it is shorter: −k/m − l₁."""
    letters = page.environment.coefficients.keys() & value.names
    if not letters:
        return page.value(value)
    nothing = dict.fromkeys(letters, Scalar.of(0))
    rows = []
    for row in value.rows:
        line = []
        for entry in row:
            data = entry if letters & entry.denominator.names else entry.substitute(nothing)
            added = entry - data
            is_shorter = not data.is_zero and len(f"{data}{added}") < len(str(entry))
            line.append(page("{data} + {added}", data=data, added=added) if is_shorter else page.value(entry))
        rows.append(line)
    return block(rows)


def is_narrow(*matrices: Matrix, within: int = _WIDEST) -> bool:
    """Return whether matrices can be read on a page: the widest row, with its fractions in one line."""
    return all(sum(len(str(entry)) for entry in row) <= within for matrix in matrices for row in matrix.rows)


def determinant_form(page: Builder, value: Scalar) -> Term:
    """Return a determinant as its irreducible factors where it has several, else as it is; the square of √x is x."""
    for root in all_roots(value):
        square = root.value**2 - root.argument  # 0 where the arithmetic knows it
        if root.kind == "sqrt" and not square.is_zero and root.name not in value.denominator.names:
            value = AlgebraicExtension(square, root.name).reduce(value)
    unit, factors = value.factors()
    if exponentials_in(value.denominator) or (len(factors) < 2 and all(power == 1 for _, power in factors)):
        return page.value(value)
    return page.term(formula_of_factored(Factored(unit, factors)))


def conditions_of(case: Case) -> Relation | Conjunction:
    """Return the equations and inequations of a case, solved where that is possible."""
    relations = tuple(as_written(condition) for part in case.when for condition in _left_of(part, case))
    return relations[0] if len(relations) == 1 and len(case.substitution) == 1 else Conjunction(relations)


def _left_of(condition: Condition, case: Case) -> list[Condition]:
    """Return what an inequation of a case says beside its equations; an equation, itself."""
    if condition.operator != "!=" or case.result is None:
        return [condition]
    there = condition.expression.substitute(case.substitution)
    signs = case.result.plant.symbols.signs
    return [Condition(condition.kind, factor, "!=") for factor in vanishing_factors([there], signs)]


def stratum_of(case: Case) -> Relation | Conjunction:
    """Return the conditions of a case, a single one alone."""
    return as_written(case.when[0]) if len(case.when) == 1 else conditions_of(case)


def as_written(condition: Condition) -> Relation:
    """Return a condition, solved where that is possible."""
    operator = condition.operator.replace("==", "=")
    if operator == "!=":
        return differs(condition.expression)
    left, right = solved(condition.expression, operator)
    return relation(left, operator, right)


def undecided(page: Builder, case: Case) -> Step:
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


#: The letters of what is not seen, and of what is not moved: a page may speak of both.
HIDDEN = {"observability": ("N", "X"), "controllability": ("N_K", "X_K")}


def unobservable_relations(
    page: Builder, letters: tuple[str, str] = ("N", "X"), *, is_observer: bool
) -> tuple[Relation, ...]:
    """Return that the columns of N are a basis of an invariant subspace never seen (never moved): CN = 0, AN = NX."""
    N, X = (page[name] for name in letters)
    A, row = (page["A"], page["C"]) if is_observer else (page["A.T"], page["B.T"])
    count = N.value.shape[1]
    zero = Matrix.zeros(row.value.shape[0], count)
    return relation(row @ N, zero), relation(A @ N, N @ X), relation(N.apply("rank"), count)


def hidden_polynomial(page: Builder, name: str = "X") -> Term:
    """Return det(sI − X): the polynomial of the hidden modes."""
    return page[f"det(s I - {name})"]


def say_stability(page: Builder, about: Term) -> None:
    """Say whether the polynomial that a term means is stable, or exactly where."""
    plant, signs = page.plant, {**page.plant.symbols.signs, **page.environment.signs}
    polynomial = polynomial_of(about.scalar.substitute(page.environment.coefficients), page.environment)
    found = stability(polynomial, plant.variable, signs, discrete=plant.is_discrete)
    time = "discrete" if plant.is_discrete else "continuous"
    if found.verdict == "yes":
        page.conclude(f"stable_{time}", predicate("stable", about))
    elif found.verdict == "no":
        page.conclude(f"unstable_{time}", predicate("unstable", about))
    else:
        inequalities = [as_inequality(value, signs) for value in found.positive]
        where = tuple(relation(left, operator, right) for left, operator, right in inequalities)
        page.conclude(f"stable_if_{time}", where=HoldsExactlyWhere(predicate("stable", about), where))


# The transfer function a plant is given by, as the page states it: what cancels in it is a finding.


def state_transfer_function(page: Builder) -> None:
    """State P, as it is written where that is not in lowest terms, and what cancels in it."""
    plant, written = page.plant, page.plant.written
    assert written is not None  # noqa: S101 - the caller has looked
    cancelled = monic(written.cancelled, plant.variable)
    if isinstance(written, WrittenTransferMatrix):
        page.given(relation(page["P"], _written_out(page, written)))
    elif written.cancelled.is_one and not written.apart:
        page.given(relation(page["P"], factored_form(page, written.value)))
    else:
        above, below = (factored_form(page, part) for part in (written.above, written.below))
        page.given(relation(page["P"], above / below, factored_form(page, written.value)))
    page.environment = page.environment.extended_by(values={"P": written.value})
    apart = vanishing_factors(written.apart, plant.symbols.signs)
    if apart:
        page.assume("lowest_terms_parameters", *apart)
    if not written.cancelled.is_one:
        _say_cancelled(page, cancelled, written.below)
    kind = "minimal" if isinstance(written, WrittenTransferMatrix) else written.realisation
    page.remark("realised" if kind == REALISATIONS[0] else f"realised_{kind}")


def _written_out(page: Builder, written: WrittenTransferMatrix) -> Term:
    """Return the matrix with its entries factored."""
    return block([[factored_form(page, entry.value) for entry in row] for row in written.rows])


def _say_cancelled(page: Builder, cancelled: Scalar, below: Scalar) -> None:
    """Say which poles cancel, and warn where they are not surely stable."""
    plant = page.plant
    c = page.set("c_P", cancelled)
    rest = page.value(below / cancelled)
    poles = Roots(c.formula, roots_of(cancelled, plant.variable))
    facts = (relation(below, c * rest),)
    cancelled_stability = stability(cancelled, plant.variable, plant.symbols.signs, discrete=plant.is_discrete)
    if cancelled_stability.verdict == "yes":
        page.remark("lowest_terms", *facts, poles=poles)
    elif cancelled_stability.verdict == "no":
        time = "discrete" if plant.is_discrete else "continuous"
        page.caution(f"lowest_terms_unstable_{time}", predicate("unstable", c), *facts, poles=poles)
    else:
        solved = [as_inequality(value, plant.symbols.signs) for value in cancelled_stability.positive]
        where = HoldsExactlyWhere(predicate("stable", c), tuple(relation(*parts) for parts in solved))
        page.caution("lowest_terms_where", *facts, poles=poles, where=where)
