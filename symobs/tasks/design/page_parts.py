"""Parts shared by the pages of designs: block diagrams, component equations, time responses and remarks on poles."""

from __future__ import annotations

from fractions import Fraction
from math import ceil, lcm, log
from operator import mul
from typing import TYPE_CHECKING

from symobs.exact import Matrix, Scalar, remainder
from symobs.formula.figures import PlottedResponse, TimeResponse
from symobs.formula.tree import (
    Conjunction,
    Evaluated,
    Letter,
    Literal,
    Negative,
    Predicate,
    Quotient,
    Relation,
    children,
)
from symobs.formula.tree.term import Term, block
from symobs.proof.certificate.claims import verify
from symobs.proof.derivation import CaseStep, Conclude
from symobs.proof.derivation.builder import Builder, differs, predicate, relation, sentence
from symobs.proof.derivation.facts import PREDICATES
from symobs.proof.derivation.wording_check import Said, rests
from symobs.stability.criteria.stability import is_beyond, is_marginal, stability
from symobs.tasks.analysis.page_parts import environment_on, is_narrow, spread
from symobs.tasks.analysis.strata.strata import distances, systems_of
from symobs.tasks.analysis.time_response.courses import TIMES, Signals, plot_courses, rounded_up, rows_of, window_of
from symobs.tasks.design.pole_placement.sylvester import fresh_names, taken_names

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Sequence

    from symobs.formula.tree import Environment, Formula
    from symobs.proof.derivation.builder import Member, Slot
    from symobs.system.specification import DesiredPolynomial
    from symobs.tasks.result import Case


# Block diagrams of pages, with gains and signs from the formulas of the page.


def draw_copy(page: Builder) -> None:
    """Draw the observer as a copy of the plant: y − ŷ through L."""
    m = page.plant.matrices
    page.signal("y_hat", "C x_hat", silent=True)
    gains: dict[str, Member] = {name: page[name] for name in ("A", "C", "L")}
    if m.has_input:
        gains["B"] = page["B"]
    if m.has_feedthrough:
        gains["D"] = page["-D"]
    page.diagram("observer_copy", say="drawn_copy", **gains)


def draw_collected(page: Builder) -> None:
    """Draw the observer as one loop around A − LC."""
    gains: dict[str, Member] = {"A": page["A - L C"], "L": page["L"]}
    if page.plant.matrices.has_input:
        gains["B"] = _driven(page)
    say = "drawn_collected" if "B" in gains else "drawn_collected_free"
    page.diagram("observer_closed", say=say, **gains)


def draw_compensator(page: Builder) -> None:
    """Draw plant, observer and feedback: in full with one input, one output and no feedthrough, else the plant as one box."""
    A, C, K, L = (page[name] for name in "ACKL")
    plant = page.plant
    if plant.inputs == plant.outputs == 1 and not plant.matrices.has_feedthrough:
        page.signal("y_hat", "C x_hat", silent=True)
        page.diagram("observer_compensator", say="drawn_compensator", A=A, B=page["B"], C=C, K=-K, L=L)
        return
    gains = {"A": page["A - L C"], "B": _driven(page), "K": -K, "L": L}
    page.diagram("observer_controller", say="drawn_compensator", Plant=_plant(page), **gains)


def _whole(page: Builder, label: Member) -> Member:
    """Return what stands in a box with its own minus inside: one in front of it would be read as a sign of the figure."""
    match label:
        case Term(Negative(Quotient(above, below))):
            return page.term(Quotient(Negative(above), below))
        case Term(Negative()):
            return page.value(label.value)
    return label


def draw_loop(page: Builder, plant: Member, compensator: Term) -> None:
    """Draw the compensator in the return path."""
    page.diagram("loop", say="drawn_loop", P=_whole(page, plant), F=-compensator, response=page["G_cl"])


def draw_unity_loop(page: Builder, plant: Member, compensator: Member) -> None:
    """Draw the compensator before the plant, unity feedback."""
    page.diagram("unity_loop", say="drawn_unity_loop", P=_whole(page, plant), F=compensator, response=page["G_r"])


def draw_feedforward(page: Builder, *, minimal: bool) -> None:
    """Draw feedback from the estimate, and the feedforward."""
    observer = _minimal_order_observer(page) if minimal else _observer(page)
    gains = {"K": page["-K"], "F": page["F_v"]}
    say = "drawn_feedforward_minimal" if minimal else "drawn_feedforward"
    page.diagram("estimated_state_feedback", say=say, Plant=_plant(page), Observer=observer, **gains)


def draw_state_feedforward(page: Builder) -> None:
    """Draw feedback from the state, and the feedforward."""
    gains = {"K": page["-K"], "F": page["F_v"]}
    page.diagram("state_feedforward", say="drawn_state_feedforward", Plant=_plant(page), **gains)


def draw_integral_action(page: Builder) -> None:
    """Draw feedback from the state and from the integral of the control error."""
    page.diagram("integral_loop", say="drawn_integral", Plant=_plant(page), K=page["-K"], Ki=page["k_I"])


def draw_tracking(page: Builder, *, minimal: bool) -> None:
    """Draw the generator of the reference, K and K_d, plant and observer."""
    observer = _minimal_order_observer(page) if minimal else _observer(page)
    gains = {"K": page["K"], "Kd": page["-K_d"], "Ad": page["A_ref"]}
    say = "drawn_tracking_minimal" if minimal else "drawn_tracking"
    page.diagram("tracking_loop", say=say, Plant=_plant(page), Observer=observer, **gains)


def draw_minimal_order(page: Builder) -> None:
    """Draw the observer of what is not measured, and the estimate put together; a feedthrough is taken off the output."""
    gains: dict[str, Member] = {name[0]: page[name] for name in ("F_z", "H_z", "M_z")}
    if page.plant.matrices.has_input:
        gains["G"] = page["G_z"]
    figure = "minimal_order_observer"
    if page.plant.matrices.has_feedthrough:
        figure, gains["D"] = "minimal_order_feedthrough", page["-D"]
        gains["G"] = page["G_z + H_z D"]  # H is fed what is measured of the state
    page.diagram(figure, say="drawn_minimal_order", z=_state(page), **gains)


def _driven(page: Builder) -> Term:
    return page["B - L D"] if page.plant.matrices.has_feedthrough else page["B"]


def _plant(page: Builder) -> Conjunction:
    output = page["C x"]
    if page.plant.matrices.has_feedthrough:
        output = output + page["D u"]
    return Conjunction((page.line("x' = A x + B u"), relation(page["y"], output)))


def _observer(page: Builder) -> Conjunction:
    x_hat = page["x_hat"]
    rate = page("(A - L C) x_hat + {driven} u + L y", driven=_driven(page))
    return Conjunction((relation(x_hat.derivative, rate),))


def _minimal_order_observer(page: Builder) -> Conjunction:
    z, y = _state(page), page["y"]
    rate = page("F_z {z} + G_z u + H_z y", z=z)
    known = page["y - D u"] if page.plant.matrices.has_feedthrough else y
    estimate = page["M_z"] @ block([[known], [z]])
    return Conjunction((relation(z.derivative, rate), relation(page["x_hat"], estimate)))


def _state(page: Builder) -> Term:
    """Return z, but w in discrete time, where z is the variable."""
    return page["w_o" if page.plant.is_discrete else "z_o"]


# Courses over time on pages: how the estimate converges, where the plant has numbers and a picture can show it.


#: Modes that differ in speed by more cannot be seen in one picture; with more responses none can be told from another.
_SPREAD, _RESPONSES = 15.0, 6


#: In discrete time: the radius below which all modes are dead at once, and how many instants are drawn.
_DEAD, _FEWEST, _SAMPLES = 1e-9, 5, 30


def plot_error(page: Builder, name: str, matrix: Term) -> None:
    """Plot the estimation error from the start x = (1, …, 1), x̂ = 0, for ė = matrix e."""
    size = matrix.value.shape[0]
    _plot(page, (name,), matrix, [(name, Matrix.identity(size), False)], "plot_error")


def plot_estimate(page: Builder, error: str, matrix: Term, unseen: Matrix) -> None:
    """State and estimate of the closed loop from that start: x̂ = x − (unseen) · error."""
    order = page.plant.order
    state = Matrix.block([[Matrix.identity(order), Matrix.zeros(order, unseen.shape[1])]])
    estimate = Matrix.block([[Matrix.identity(order), -unseen]])
    _plot(page, ("x", error), matrix, [("x", state, False), ("x_hat", estimate, True)], "plot_estimate")


def _plot(page: Builder, states: tuple[str, ...], matrix: Term, signals: Signals, say: str) -> None:
    """Plot, unless the page has parameters or a picture would show nothing."""
    value = matrix.value
    responses = sum(table.shape[0] for _, table, _ in signals)
    if value.names or page.plant.relations or responses > _RESPONSES:
        return
    if page.plant.is_discrete:
        _plot_samples(page, states, matrix, signals, say)
        return
    from symobs.exact.time_functions.matrix_exponential import spectral_abscissae  # noqa: PLC0415 - only pages with responses pay for it

    slowest, fastest = spectral_abscissae(value)
    if slowest >= 0 or fastest < _SPREAD * slowest * (1 + 1e-9):
        return
    end = rounded_up(TIMES / -slowest)
    plot_courses(page, states, _starts(page, states), matrix, signals, end, say)


def _plot_samples(page: Builder, states: tuple[str, ...], matrix: Term, signals: Signals, say: str) -> None:
    """Plot the exact values at 0, 1, 2, …, until they are small, unless that takes too many."""
    from symobs.exact.time_functions.matrix_exponential import spectral_radius  # noqa: PLC0415 - only pages with responses pay for it

    largest, size = spectral_radius(matrix.value), matrix.value.shape[0]
    last = size + 1 if largest < _DEAD else ceil(TIMES / -log(largest)) if largest < 1 else _SAMPLES + 1
    if last > _SAMPLES:
        return
    table, state = rows_of(matrix.value), (Fraction(1),) * size
    states_there = []
    for _ in range(max(last, _FEWEST) + 1):
        states_there.append(state)
        state = tuple(sum(map(mul, row, state), Fraction(0)) for row in table)
    found = [
        (
            name,
            index if part.shape[0] > 1 else 0,
            row,
            [sum(map(mul, row, s), Fraction(0)) for s in states_there],
            dashed,
        )
        for name, part, dashed in signals
        for index, row in enumerate(rows_of(part), 1)
    ]
    parts = lcm(*(height.denominator for _, _, _, heights, _ in found for height in heights))
    made = tuple(
        PlottedResponse(name, index, row, tuple(int(height * parts) for height in heights), dashed)
        for name, index, row, heights, dashed in found
    )
    window = window_of(Fraction(len(states_there) - 1), made, parts)
    page.plot(TimeResponse(states, _starts(page, states), made, window, parts, discrete=True), matrix, say=say)


def _starts(page: Builder, states: tuple[str, ...]) -> tuple[tuple[Fraction, ...], ...]:
    return tuple((Fraction(1),) * page.term(Letter(name)).value.size for name in states)


# Cautions about desired poles: an estimation error that grows or does not decay.


def caution_poles(page: Builder, desired: DesiredPolynomial, phi: str, of: str) -> None:
    """Warn where the desired polynomial, the value of `phi`, is surely not stable; of: observer, state_feedback, servo."""
    plant, signs = page.plant, page.plant.symbols.signs
    polynomial, discrete = desired.polynomial, page.plant.is_discrete
    if page[phi].value != polynomial or stability(polynomial, plant.variable, signs, discrete=discrete).verdict != "no":
        return
    time, subject = "discrete" if discrete else "continuous", page[phi]
    facts = [predicate("unstable", subject)]
    if is_beyond(polynomial, plant.variable, signs, discrete=discrete):
        facts.append(predicate("beyond", subject))
        key, of = "grows", of if of == "observer" else "state_feedback"
    elif of == "servo":  # whatever the gains, a constant reference may drive the integral of the error without end
        key = "lasts"
    elif is_marginal(polynomial, plant.variable, signs, discrete=discrete):
        facts.append(predicate("marginal", subject))
        key = "stays"
        moved = page["s - 1"] if discrete else page.s
        rest = subject / moved
        if of == "state_feedback" and _is_stable(rest.scalar, page):
            facts.append(predicate("stable", rest))
            key = "drifts"
    else:
        key = "lasts"
    page.caution(f"{key}_{of}_{time}", *facts)


def _is_stable(rest: Scalar, page: Builder) -> bool:
    """Return whether a quotient is a polynomial and surely stable."""
    plant = page.plant
    if not rest.is_polynomial_in(plant.variable):
        return False
    return stability(rest, plant.variable, plant.symbols.signs, discrete=plant.is_discrete).verdict == "yes"


# The finding that no gain assigns a polynomial: everywhere, outside some cases, or where a remainder is not zero.


def over_fixed(page: Builder, phi: Term, polynomial: Scalar, fixed: Term) -> tuple[Term, tuple[Relation, ...]]:
    """Return φ over the polynomial of the fixed modes, and what binds φ to its letter.

    A property holds whatever the letters of coefficients stand for: where there are some, φ is written out.
    """
    if not page.environment.coefficients:
        return phi / fixed, ()
    return page.value(polynomial) / fixed, (relation(phi, polynomial),)


def say_unassignable(
    page: Builder,
    keys: tuple[str, str],
    phi: Term,
    polynomial: Scalar,
    fixed: Term,
    cases: Sequence[Case],
    /,
    **slots: Slot,
) -> None:
    """State that φ is no multiple of the polynomial of the fixed modes.

    Where parameters make it one on cases with an equation each, or the modes are others there, it is said outside them;
    where more than one equation does, with the remainder.
    """
    quotient, bound = over_fixed(page, phi, polynomial, fixed)
    never = predicate("not_polynomial", quotient)
    said = Conclude(sentence(keys[0], slots), (*bound, never))
    left = _with_remainder(page, keys[1], phi, fixed)
    everywhere, lines, others = None, _outside_lines(cases), _outside(cases)
    for step, where in ((said, everywhere), (said, lines), (left, everywhere), (said, others), (left, others)):
        if where is not None and not where.relations:
            continue
        environment = page.environment if where is None else environment_on(page, where)
        if environment is not None and _holds(step, environment):
            page.steps.append(step if where is None else CaseStep(where, (), (step,)))
            return
    page.remark("assignable_open")


def _with_remainder(page: Builder, key: str, phi: Term, fixed: Term) -> Conclude:
    """Return the statement that φ is a multiple only where its remainder vanishes."""
    whole, rest = remainder(phi.scalar, fixed.scalar, page.plant.variable)
    left = phi - page.value(whole) @ fixed
    slots = {
        "fixed": Evaluated(fixed.formula, Literal(fixed.scalar)),
        "polynomial": Evaluated(phi.formula, Literal(phi.scalar)),
        "rest": Evaluated(left.formula, Literal(rest)),
    }
    return Conclude(sentence(key, slots), (predicate("strictly_proper", page.value(rest) / fixed),))


def _outside_lines(cases: Sequence[Case]) -> Conjunction:
    """Return that parameters are outside the cases that have a gain; nothing where one has several equations, or none."""
    systems = systems_of(case for case in cases if not _is_unassignable(case))
    if systems is None or any(len(system) > 1 for system in systems):
        return Conjunction(())
    return _apart(equation for (equation,) in dict.fromkeys(systems))


def _outside(cases: Sequence[Case]) -> Conjunction:
    """Return that parameters are outside all cases; nothing where one of them is everywhere."""
    systems = systems_of(cases)
    return _apart(() if systems is None else distances(systems))


def _apart(values: Iterable[Scalar]) -> Conjunction:
    return Conjunction(tuple(map(differs, values)))


def _is_unassignable(case: Case) -> bool:
    """Return whether a case, and all within it, has no gain either."""
    return case.result is not None and case.result.verdict == "no" and not case.result.case_tree


def _holds(step: Conclude, environment: Environment) -> bool:
    """Return whether all that a finding rests on holds at every point of a stratum."""
    for fact in step.facts:
        if isinstance(fact, Relation):
            if not verify(fact, environment)[0]:
                return False
        elif isinstance(fact, Predicate):
            value = Term(fact.subject, environment).scalar
            if not PREDICATES[fact.name](value, environment, False):  # noqa: FBT003 - it is of no time
                return False
    said = step.sentence
    return said is None or rests(said.key, Said(step.facts, environment, dict(said.slots)))


# Limits of readability on design pages: larger matrices and polynomials are named by letters, or left to JSON.
#
# Sizes are numbers of terms, orders those of the plant, unless it is said otherwise.


# -- the method that is printed where none was asked for ---------------------------------------------------------------

#: Up to these orders the matrices of the canonical form are easier to read than Ackermann's formula.
CANONICAL_FORM_ORDER = 4


PARAMETRIC_CANONICAL_FORM_ORDER = 2


# -- gains -------------------------------------------------------------------------------------------------------------

#: A longer coefficient of φ gets a letter of its own.
COEFFICIENT = 4


#: A gain with a longer row, written in one line, has letters for its entries.
GAIN = 40


#: The longest row-reduced form, and the most null vectors: there are no more letters for them.
REDUCED_FORM = 150


NULL_VECTORS = 9


#: Of the family of gains: X and what parts the spectra, det X, the general gain, X of one member.
FAMILY_SOLUTION = 40


FAMILY_DETERMINANT = 24


GENERAL_GAIN = 40


MEMBER_SOLUTION = 120


#: The condition on parameters under which a gain has its zeros.
ZERO_CONDITION = 60


#: Up to this order the blocks of a test matrix fit one of two columns.
COLUMN_ORDER = 3


# -- observers ---------------------------------------------------------------------------------------------------------

#: A system of this order is written component by component where no entry is longer.
COMPONENTS_ORDER = 2


COMPONENT = 4


#: Up to this order the blocks of a partitioned plant stand in one matrix.
BLOCKS_ORDER = 2


#: The observer whose right-hand side contains the derivative of the output.
OUTPUT_DERIVATIVE = 80


#: With no more unknown entries the observer is also shown before its gain is found.
UNKNOWN_ENTRIES = 2


# -- compensators ------------------------------------------------------------------------------------------------------

#: With a longer F(s) the page works with letters for the entries of the gains and the coefficients of F.
COMPENSATOR = 24


#: A matrix of numbers or rational functions.
MATRIX = 60


#: The conditions under which F is stable, together.
STABILITY_CONDITIONS = 40


#: At this order products of the gains have room beside their values.
PRODUCTS_ORDER = 2


#: Up to this order sums of products of matrices stand beside their values, and a loop in a second set of coordinates.
WRITTEN_OUT_ORDER = 3


#: The loop before it is simplified; up to this order it is also written before its factors.
LOOP = 16


LOOP_ORDER = 4


#: At this order the matrix itself shows that it is not a multiple of I.
OFFSET_ORDER = 2


# Gains: a long one is a matrix of letters, in which the page goes on.


#: The letters for the entries of gains; one that the data use, too, is passed over.
_ENTRIES = {"K": ("k", "f", "g"), "L": ("l", "h", "g")}


def entry_letters(page: Builder, gain: str, value: Matrix, kept: Callable[[Scalar], bool]) -> Matrix:
    """Return a gain with letters that are free for its entries, but for those that are kept."""
    taken = taken_names(page)
    data = {name.rstrip("0123456789").partition("_")[0] for name in taken - page.environment.coefficients.keys()}
    stem = next((letter for letter in _ENTRIES[gain[0]] if letter not in data), _ENTRIES[gain[0]][0])
    names = iter(fresh_names(f"{stem}_", len(value.entries), taken))
    return Matrix.of([[e if kept(e) else Scalar.symbol(next(names)) for e in row] for row in value.rows])


def gain_letters(page: Builder, gain: str, value: Matrix, kept: Callable[[Scalar], bool] = lambda _: False) -> Matrix:
    """Return a gain with letters that stand for its entries from here on, but for those that are kept."""
    letters = entry_letters(page, gain, value, kept)
    for letter, entry in zip(letters.entries, value.entries, strict=True):
        if not kept(entry):
            page.name_coefficient(str(letter), entry)
    return letters


def _is_brief(formula: Formula) -> bool:
    """Return whether matrices written out in a formula are narrow."""
    if isinstance(formula, Literal):
        return not isinstance(formula.value, Matrix) or is_narrow(formula.value, within=GAIN)
    return all(map(_is_brief, children(formula)))


def define_gain(
    page: Builder, gain: str, *members: Term | Matrix, say: str = "", transposed: bool = False, answer: bool = True
) -> Term:
    """Introduce a gain (`transposed`, through its transpose); a long one with letters, and what they stand for."""
    *before, last = (page.value(member) if isinstance(member, Matrix) else member for member in members)
    value = last.value.T if transposed else last.value
    if not value.names or (is_narrow(value, within=GAIN) and not page.in_letters):
        shown, before = value, [*before, last]
    elif page.defines(gain) and page[gain].value.substitute(page.environment.coefficients) == value:
        shown = page[gain].value
    else:
        shown = gain_letters(page, gain, value, lambda entry: entry.is_constant)
        before = [member for member in [*before, last] if _is_brief(member.formula)]
    meanings = [
        relation(name, entry) for name, entry in zip(shown.entries, value.entries, strict=True) if name != entry
    ]
    if page.defines(gain) and page[gain].value == shown and 1 in shown.shape:
        page.equal(*meanings, say=say)
        return page[gain]
    if transposed:
        page.set(gain, shown)
        closing = [] if meanings else [last.as_value]
        page.equal(relation(page[f"{gain}.T"], *before, *closing), relation(page[gain], shown), say=say, answer=answer)
    else:
        page.define(gain, *(before if before and not meanings else [*before, shown]), say=say, answer=answer)
    if meanings:
        page.equal(*meanings, say="with_coefficients")
    return page[gain]


# Sums of matrices times signals with their numbers, and equations component by component beside the matrix form.


def stand_in_line(page: Builder, *names: str) -> bool:
    """Return whether matrices of as many rows fit beside one another."""
    return is_narrow(Matrix.block([[page[name].value for name in names]]))


def summed(pairs: list[tuple[Term, Term]]) -> Term:
    """Return Σ matrix · signal, as letters."""
    total = pairs[0][0] @ pairs[0][1]
    for matrix, signal in pairs[1:]:
        total = total + matrix @ signal
    return total


def combination(page: Builder, pairs: list[tuple[Term, Term]]) -> Term:
    """Return the sum with numbers: what is zero is left out, and a 1×1 matrix is a number."""
    total: Term | None = None
    for matrix, signal in pairs:
        value = matrix.value
        if value.is_zero:
            continue
        single = value[0, 0] if value.shape == (1, 1) else None
        negative = single is not None and single.is_constant and single.fraction() < 0
        if single is not None:
            size = -single if negative else single
            part = signal if size.is_one else page.value(size) * signal
        else:
            part = spread(page, value) @ signal
        part = -part if negative and total is None else part
        total = part if total is None else total - part if negative else total + part
    return summed(pairs) if total is None else total


def write_components(page: Builder, driven: Term | None) -> None:
    """Write x̂' = (A − LC) x̂ + (B − LD) u + L y row by row, and check that x̂ = x is a solution."""
    L = page["L"]
    closed = page["A - L C"]
    sources = [(L, page["y"])] if driven is None else [(driven, page["u"]), (L, page["y"])]
    entries = [entry for matrix in (closed, *(matrix for matrix, _ in sources)) for entry in matrix.value.entries]
    if (
        page.plant.order != COMPONENTS_ORDER
        or page.plant.outputs > 1
        or any(entry.size - 1 > COMPONENT for entry in entries)
    ):
        return
    x_hat = page["x_hat"]
    parts = []
    for i in range(page.plant.order):
        unit = page.value(Matrix.unit(page.plant.order, i).T)
        parts.append(page.signal(f"x_hat_{i + 1}", unit @ x_hat, silent=True))
    rows = []
    for i, part in enumerate(parts):
        pairs = [(page.value(Matrix.of([[closed.value[i, j]]])), other) for j, other in enumerate(parts)]
        pairs += [(page.value(matrix.value.select([i], range(matrix.value.shape[1]))), s) for matrix, s in sources]
        rows.append(relation(part.derivative, combination(page, pairs)))
    page.equal(*rows, say="in_components")
    right = page["(A - L C) x"]
    for matrix, signal in sources:
        right = right + matrix @ signal
    page.verified("right_estimate_stays", consistent=page.line("{right} = x'", right=right))
