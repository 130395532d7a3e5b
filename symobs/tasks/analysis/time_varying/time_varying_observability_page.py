"""The page of a time-varying plant: transition matrix, Gramian, rank test with its warning, initial state."""

from __future__ import annotations

from typing import TYPE_CHECKING

from symobs.exact import Matrix, Scalar, antiderivative, product_of, rank
from symobs.exact.core.generators import substitute, symbols_in
from symobs.formula.tree import Conjunction, Evaluated, Integral, Literal
from symobs.formula.tree.term import Term, block
from symobs.proof.derivation import CaseStep, Conclude, Equal
from symobs.proof.derivation.builder import relation, sentence
from symobs.system.conditions import never_zero
from symobs.tasks.analysis.page_parts import determinant_form, given, stratum_of, undecided
from symobs.tasks.analysis.rank.rank_page import outside_cases
from symobs.tasks.analysis.strata.strata import distances, systems_of
from symobs.tasks.analysis.time_varying.time_varying_observability import TimeVaryingObservability
from symobs.tasks.analysis.time_varying.time_varying_solution import dependences, has_functions
from symobs.tasks.analysis.time_varying.transition_matrix import (
    START,
    TIME,
    OpenIntegral,
    antiderivative_since,
    tidied,
    transition,
)
from symobs.tasks.result import page_of

if TYPE_CHECKING:
    from symobs.proof.derivation import Step
    from symobs.proof.derivation.builder import Builder
    from symobs.tasks.result import Case, Result

_DUMMIES = ("sigma", "tau", "rho", "nu")


@page_of(TimeVaryingObservability)
def write(page: Builder, result: TimeVaryingObservability) -> None:
    """Write the page in the order of the theory."""
    asked = result.asked_for
    page.in_time_by(*dependences((*_data(result), *result.closed_forms, *_squares(result)), asked, _dummy(page)))
    given(page)
    if asked.interval is not None:
        ends = {name: page.set(f"t_{name}", value) for name, value in (("start", asked.start), ("end", asked.end))}
        page.conclude("on_interval", **{name: Evaluated(end.formula, Literal(end.value)) for name, end in ends.items()})
    with page.section("transition"):
        _transition(page, result)
    if result.answer["transition_matrix"] is not None:
        with page.section("time_varying_gramian"):
            _gramian(page, result)
    with page.section("time_varying_rank"):
        _rank_test(page, result)
        _frozen(page, result)
    if asked.output is not None:
        with page.section("reconstruction"):
            _initial_state(page, result)


def _data(result: TimeVaryingObservability) -> tuple[Matrix, ...]:
    m = result.plant.matrices
    return m.A, m.B, m.C, m.D, result.answer["matrix"]


def integral(page: Builder, integrand: Term, name: str, lower: Scalar, upper: Scalar, primitive: Matrix) -> Term:
    """Return an integral with its witness."""
    return page.term(Integral(integrand.formula, Literal(primitive), name, lower, upper))


def _dummy(page: Builder) -> str:
    """Return a letter for the variable of integration that means nothing yet."""
    return next(name for name in _DUMMIES if name not in page.plant.field.position)


# -- transition matrix ------------------------------------------------------------------------------------------------


def _transition(page: Builder, result: TimeVaryingObservability) -> None:
    """Say how Φ is found, and check it."""
    Phi = result.answer["transition_matrix"]
    try:
        found = transition(page.plant.matrices.A, page.plant.symbols.signs)
    except OpenIntegral as error:
        page.remark("transition_open_integral", integrand=error.integrand)
        return
    if Phi is None or found is None:
        page.remark("transition_open")
        return
    A = page["A"]
    if found.matrix != Phi:
        page.define("Phi", page.value(Phi), answer=True)
    elif found.kind != "nilpotent":
        page.define("Phi", page.value(Phi), say=f"transition_{found.kind}", answer=True)
    elif not found.terms:
        zero = page.line("A = 0")
        page.define("Phi", page.identity(page.plant.order), say="transition_constant", zero=zero, answer=True)
    elif found.terms[0] @ A.value == A.value @ found.terms[0]:
        _exponential(page, found.terms)
    else:
        _series(page, found.terms)
    rate = page.line("Phi' = A Phi")
    start = page.line("{value} = I", value=page["Phi"].at(TIME, Scalar.symbol(START)))
    page.verified("transition_checked", rate=rate, start=start)
    if result.denominators:
        page.assume("closed_form_if", *result.denominators)


def _integral_of_A(page: Builder, factor: Term | None, value: Matrix) -> Term:
    """Return ∫ A(σ) X(σ) dσ from t₀ to t, whose value is known."""
    name = _dummy(page)
    new = Scalar.symbol(name)
    integrand = page["A"].at(TIME, new)
    if factor is not None:
        integrand = integrand @ factor.at(TIME, new)
    primitive = value.substitute({TIME: new})
    return integral(page, integrand, name, Scalar.symbol(START), Scalar.symbol(TIME), primitive)


def _exponential(page: Builder, terms: tuple[Matrix, ...]) -> None:
    M, order, last = terms[0], page.plant.order, len(terms)
    page.set("M", M)
    commutes = page.line("A M = M A")
    member = _integral_of_A(page, None, M)
    page.equal(
        page.line("M = {member} = {value}", member=member, value=M), say="transition_nilpotent", commutes=commutes
    )
    power = relation(page["M"] ** (last + 1), Matrix.zeros(order, order))
    total, factorial = page["I + M"], 1
    for k in range(2, last + 1):
        factorial *= k
        total = total + page["M"] ** k / factorial
    page.define("Phi", total, say="transition_exponential", power=power, answer=True)


def _series(page: Builder, terms: tuple[Matrix, ...]) -> None:
    order = page.plant.order
    before = None
    for k, term in enumerate(terms, 1):
        member = _integral_of_A(page, before, term)
        page.define(f"Phi_{k}", member, page.value(term), say="peano_baker" if k == 1 else "", closing=False)
        before = page[f"Phi_{k}"]
    total = page.identity(order)
    for k in range(1, len(terms) + 1):
        total = total + page[f"Phi_{k}"]
    end = page.line("A {terms} = 0", terms=page[f"Phi_{len(terms)}"])
    page.define("Phi", total, say="peano_baker_sum", end=end, answer=True)


# -- Gramian ----------------------------------------------------------------------------------------------------------


def _seen(page: Builder, result: TimeVaryingObservability) -> Term:
    """Return C Φ(t, start)."""
    return page["C"] @ page["Phi"].at(START, result.asked_for.start)


def _squares(result: TimeVaryingObservability) -> tuple[Matrix, ...]:
    """Return Φᵀ Cᵀ C Φ where its integral is not known."""
    Phi, found = result.answer["transition_matrix"], result.answer["gramian"]
    if Phi is None or found is not None:
        return ()
    seen = result.plant.matrices.C @ substitute(Phi, {START: result.asked_for.start})
    return (tidied(seen.T @ seen),)


def _gramian(page: Builder, result: TimeVaryingObservability) -> None:
    """Give W with its determinant, and the initial states in its kernel."""
    asked, answer = result.asked_for, result.answer
    if answer["gramian"] is None or answer["gramian_in_time"] is None:
        seen = _seen(page, result)
        (product,), order = _squares(result), page.plant.order
        places = [(i, j) for i in range(order) for j in range(order)]
        open_places = [p for p in places if antiderivative(product[p], TIME) is None]
        if open_places:
            i, j = open_places[0]
            unit = Matrix.identity(order)
            row, column = (page.value(unit.select(range(order), [k])) for k in (i, j))
            entry = row.T @ seen.T @ seen @ column
            page.remark("gramian_open_integral", integrand=Evaluated(entry.formula, Literal(product[i, j])))
        else:
            page.remark("gramian_long")
    else:
        Phi = page["Phi"].at(START, asked.start)
        squared = page("{value} C.T C {Phi}", value=Phi.T, Phi=Phi)
        whole = integral(page, squared, TIME, asked.start, asked.end, answer["gramian_in_time"])
        page.define("W", whole, page.value(answer["gramian"]), say="gramian", answer=True, closing=False)
        if answer["rank"] == page.plant.order and result.gramian_determinant is not None:
            _determinant(page, result.gramian_determinant)
    if answer["kernel"] is None or not answer["kernel"].shape[1]:
        return
    key = "never_seen_start" if answer["gramian"] is None else "gramian_singular"
    page.set("v", answer["kernel"])
    zero = Matrix.zeros(page.plant.outputs, answer["kernel"].shape[1])
    facts = [relation(_seen(page, result) @ page["v"], zero)]
    if answer["gramian"] is not None:
        facts.append(page.line("W v = 0"))
    page.equal(relation(page["v"], answer["kernel"]), *facts, say=key)


def _determinant(page: Builder, value: Scalar) -> None:
    det = page["det(W)"]
    shown = page.value(value) if has_functions(value) else determinant_form(page, value)
    if not has_functions(value) and never_zero(value, page.plant.symbols.signs):
        page.equal(relation(det, shown, "!=", 0))
        page.conclude("gramian_regular")
    else:
        page.equal(relation(det, shown))
        page.conclude("gramian_generic")


# -- rank test --------------------------------------------------------------------------------------------------------


def _rank_test(page: Builder, result: TimeVaryingObservability) -> None:
    """Build N₀, N₁, … and read off the rank over the functions of t."""
    order, answer = page.plant.order, result.answer
    page.define("N_0", "C", say="stack_rule")
    for k in range(order - 1):
        page.define(f"N_{k + 1}", f"N_{k} A + N_{k}'")
    rows = [[page[f"N_{k}"]] for k in range(order)]
    page.define("O", block(rows), say="stack_matrix", answer=True)
    by_functions = has_functions(answer["matrix"])
    if answer["rank"] < order:
        _hidden(page, result)
        page.steps += [_case(page, case) for case in result.case_tree]
        return
    conditions = [c.expression for c in result.holds_where if c.kind == "existence"]
    determinant = page.plant.simplified(answer["matrix"].determinant()) if page.plant.outputs == 1 else None
    if determinant is not None:
        page.equal(page.line("det(O) = {value}", value=determinant_form(page, determinant)))
    if conditions:
        page.assume("stack_yes_if", *conditions)
    elif determinant is not None and answer["point"] is not None:
        instant = page["O"].at(TIME, answer["point"]).apply("det")
        value = determinant.substitute({TIME: answer["point"]})
        key = "stack_yes_at" if result.asked_for.interval is None else "stack_yes_on"
        page.conclude(key, instant=relation(instant, value, "!=", 0))
    elif by_functions:
        minor = _minor(page, answer["rows"])
        page.conclude("stack_yes_minor", minor=relation(minor, "!==", minor.scalar * 0))
    else:
        page.conclude("stack_yes", rank=page.line("rank(O) = {value}", value=answer["rank"]))
    drop = _instant_of_drop(result)
    if drop is not None:
        at_drop = page["O"].at(TIME, drop)
        page.remark("stack_drops", rank=relation(at_drop.apply("rank"), rank(at_drop.value)))
    page.steps += [_case(page, case) for case in result.case_tree]


def _minor(page: Builder, rows: tuple[int, ...]) -> Term:
    """Return the determinant of some rows of the stack, as many as there are states."""
    O = page["O"]
    height, order = O.value.shape
    chosen = O if height == order else page.value(Matrix.identity(height).select(rows, range(height))) @ O
    return chosen.apply("det")


def _instant_of_drop(result: TimeVaryingObservability) -> Scalar | None:
    """Return the first instant that comes to mind at which the stack loses rank, in the interval."""
    O, asked = result.answer["matrix"], result.asked_for
    for instant in (asked.start, asked.end) if asked.interval else map(Scalar.of, (0, 1, -1)):
        try:
            there = O.substitute({TIME: instant})
            if not has_functions(there) and rank(there) < result.answer["rank"]:
                return instant
        except ZeroDivisionError:
            continue
    return None


def _hidden(page: Builder, result: TimeVaryingObservability) -> None:
    """Give the hidden states, which move with t, and why they stay hidden."""
    answer, order = result.answer, page.plant.order
    V, X = answer["hidden"], answer["restricted"]
    if has_functions(answer["matrix"]):
        page.set("V", V)
        zero = Matrix.zeros(answer["matrix"].shape[0], V.shape[1])
        page.conclude("stack_no_states", hidden=page.line("O V = {zero}", zero=zero))
        page.equal(relation(page["V"], V), say="stack_moving")
    else:
        page.conclude("stack_no", rank=page.line("rank(O) = {value} < {order}", value=answer["rank"], order=order))
        page.define("V", page.value(V), say="stack_moving")
    page.set("X", X)
    unseen = page.line("C V = 0")
    stays = page.line("A V - V' = V X = V {value}", value=X)
    page.equal(stays, say="stack_invariant", unseen=unseen)


def _case(page: Builder, case: Case, *, modulo: bool = False) -> Step:
    if not isinstance(case.result, TimeVaryingObservability):
        return undecided(page, case)
    deficient = case.result.answer["rank"] < page.plant.order
    steps: list[Step] = []
    if not has_functions(page["O"].value):
        found = page.line("rank(O) = {value}", value=case.result.answer["rank"])
        steps.append(Conclude(sentence("case_stack" if deficient else "case_stack_yes", {"rank": found})))
    elif deficient:
        steps.append(Conclude(sentence("case_stack_states", {})))
    else:
        minor = _minor(page, case.result.answer["rows"])
        steps.append(Conclude(sentence("case_stack_minor", {"minor": relation(minor, "!==", Scalar.of(0))})))
    if deficient:
        hidden = case.result.answer["hidden"]
        zero = Matrix.zeros(page["O"].value.shape[0], hidden.shape[1])
        steps.append(Equal((page.line("O {hidden} = {zero}", hidden=hidden, zero=zero),)))
    where = stratum_of(case)
    # where equations or inequations hold, modulo which a rank is seen, what is outside has to be known with them
    modulo = modulo or isinstance(where, Conjunction) or bool(case.result.plant.equations)
    steps = outside_cases(page, case.result, steps) if modulo else _outside(case.result, steps)
    steps += [_case(page, inner, modulo=modulo) for inner in case.result.case_tree]
    return CaseStep(where, tuple(case.substitution.items()), tuple(steps))


def _outside(result: Result, steps: list[Step]) -> list[Step]:
    """Return steps as a case of what holds outside of the cases: its rank is told for almost all t, not for each."""
    systems = systems_of(result.case_tree)
    if not systems:
        return [] if systems is None else steps
    return [CaseStep(relation(product_of(distances(systems)), "!=", 0), (), tuple(steps))]


def _frozen(page: Builder, result: TimeVaryingObservability) -> None:
    """Warn of the test at a frozen instant, by this plant where it misleads here, else by another one."""
    A, C, order, found = page["A"], page["C"], page.plant.order, result.answer["rank"]
    frozen = _frozen_test(A, C, order)
    generic = rank(frozen.value, page.plant.ideal)
    if TIME not in symbols_in(A.value) | symbols_in(C.value):
        return
    if (generic < order) != (found < order) and not has_functions(frozen.value):
        key = "frozen_misled_no" if found < order else "frozen_misled_yes"
        page.caution(key, frozen=relation(frozen.apply("rank"), generic))
        return
    for instant in map(Scalar.of, (0, 1, -1)) if found == order else ():
        try:
            there = _frozen_test(A.at(TIME, instant), C.at(TIME, instant), order)
            value = order if has_functions(there.value) else rank(there.value)
        except ZeroDivisionError:
            continue
        if value < order:
            page.caution("frozen_instant", frozen=relation(there.apply("rank"), value))
            return
    _example(page)


def _frozen_test(A: Term, C: Term, order: int) -> Term:
    return block([[C], *([C @ A**k] for k in range(1, order))])


def _example(page: Builder) -> None:
    """Warn by x₁' = x₂, x₂' = 0, y = x₁ − t x₂: observable at every frozen instant, and its output is constant."""
    t = Scalar.symbol(TIME)
    A, C = Matrix.of([[0, 1], [0, 0]]), Matrix.of([[Scalar.of(1), -t]])
    page.set("A_1", A)
    page.set("C_1", C)
    frozen = _frozen_test(page["A_1"], page["C_1"], 2).apply("rank")
    derived = page.line("C_1 A_1 + C_1' = 0")
    page.caution(
        "frozen_example",
        state=relation(page["A_1"], A),
        output=relation(page["C_1"], C),
        frozen=relation(frozen, 2),
        derived=derived,
    )


# -- initial state ----------------------------------------------------------------------------------------------------


def _initial_state(page: Builder, result: TimeVaryingObservability) -> None:
    """Find x₀ from the output: x₀ = W⁻¹ ∫ Φᵀ Cᵀ ξ, ξ the output without its forced part."""
    asked, answer, m = result.asked_for, result.answer, page.plant.matrices
    assert asked.output is not None  # noqa: S101 - asked by the caller
    page.define("y_t", _signal(page, asked.output), say="output_given")
    if answer["forced"] is None or answer["gramian"] is None:
        page.remark("x0_open")
        return
    if asked.input is None:
        page.define("xi", "y_t", say="xi_same")
    else:
        page.define("u_t", _signal(page, asked.input), say="input_given")
        _forced(page, result, answer["forced"])
        xi = page["y_t - C x_u"]
        page.define("xi", page["y_t - C x_u - D u_t"] if m.has_feedthrough else xi, say="xi_forced")
    if answer["x0"] is None:
        if answer["rank"] < page.plant.order:
            page.conclude("x0_not_unique")
        elif answer["candidate"] is None or answer["moment"] is None:
            page.remark("x0_open")
        else:
            _refuse(page, result, answer["moment"])
        return
    seen = _seen(page, result)
    moment = antiderivative_since(tidied((seen.T @ page["xi"]).value), asked.start)
    assert moment is not None  # noqa: S101 - x₀ was found by it
    Phi = page["Phi"].at(START, asked.start)
    whole = integral(page, page("{value} C.T xi", value=Phi.T), TIME, asked.start, asked.end, moment)
    page.define("x_0", page["W^-1"] @ whole, page.value(answer["x0"]), say="x0_formula", answer=True, closing=False)
    free = page["Phi"].at(START, asked.start) @ page["x_0"]
    history = free if asked.input is None else free + page["x_u"]
    page.define("x_t", history, page.value(tidied(history.value)), say="state_history", closing=False)
    output = page["C x_t"]
    if asked.input is not None and m.has_feedthrough:
        output = page("{output} + D u_t", output=output)
    page.verified("x0_checked", output=relation(output, page["y_t"]))


def _refuse(page: Builder, result: TimeVaryingObservability, moment: Matrix) -> None:
    """Give the only state that could explain the output, and what its own output leaves."""
    asked, Phi = result.asked_for, page["Phi"].at(START, result.asked_for.start)
    whole = integral(page, page("{value} C.T xi", value=Phi.T), TIME, asked.start, asked.end, moment)
    page.define("x_0", page["W^-1"] @ whole, say="x0_candidate")
    rest = page("xi - {seen} x_0", seen=_seen(page, result))
    shown = rest.value[0, 0] if isinstance(rest.value, Matrix) and rest.value.shape == (1, 1) else rest.value
    page.conclude("x0_none", rest=relation(rest, shown, "!==", shown * 0))


def _signal(page: Builder, value: Matrix) -> Term:
    """Return a signal written out, without brackets where it has one component."""
    return page.value(value[0, 0] if value.shape == (1, 1) else value)


def _forced(page: Builder, result: TimeVaryingObservability, forced: Matrix) -> None:
    """Give the state that the input alone leads to, as the integral to the present time, and check it."""
    start = result.asked_for.start
    name = _dummy(page)
    new, t = Scalar.symbol(name), Scalar.symbol(TIME)
    moved = page["Phi"].at(START, new)
    integrand = moved @ page["B"].at(TIME, new) @ page["u_t"].at(TIME, new)
    primitive = antiderivative(integrand.value, name)
    if primitive is None:
        page.define("x_u", page.value(forced), say="forced_state")
    else:
        page.define(
            "x_u",
            integral(page, integrand, name, start, t, primitive),
            page.value(forced),
            say="forced_state",
            closing=False,
        )
    rate = page.line("x_u' = A x_u + B u_t")
    page.verified(
        "forced_checked", rate=rate, start=relation(page["x_u"].at(TIME, start), Matrix.zeros(page.plant.order, 1))
    )
