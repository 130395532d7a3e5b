"""The response  x(t) = e^{At} x₀ + ∫₀ᵗ e^{A(t−s)} B u(s) ds,  y = C x + D u,  of a plant in closed form.

The answer is held to the differential equation and to the initial state, which have one solution.
"""

from __future__ import annotations

from fractions import Fraction
from functools import cached_property
from math import lcm, pi
from typing import TYPE_CHECKING, Any, ClassVar, NamedTuple, Self, TypeAlias

from symobs.exact import Matrix, Scalar, companion
from symobs.exact.algebraic.enclosure import is_number
from symobs.exact.core.generators import function_named, functions_in, normal_form, substitute, symbols_in
from symobs.exact.time_functions.matrix_exponential import NoClosedForm
from symobs.exact.time_functions.matrix_power import PowerOf, matrix_power
from symobs.exact.time_functions.quasipolynomial import Quasipolynomial, Table, matrix_at, product, table_of
from symobs.formula.figures import PlottedResponse, TimeResponse
from symobs.formula.tree.written import written
from symobs.ground.dataclass import dataclass
from symobs.ground.errors import InputError, ShapeMismatch
from symobs.proof.derivation.builder import Builder, relation
from symobs.system.specification import parse_in_steps, read_gain
from symobs.tasks.analysis.page_parts import given
from symobs.tasks.analysis.time_response.damping_cases import (
    DampingCases,
    Signs,
    exponential_claims,
    rate_of,
    time_environment,
)
from symobs.tasks.analysis.time_response.horizons import read_functions
from symobs.tasks.analysis.time_response.initial_state import MOST_SAMPLES, motion_from_rest
from symobs.tasks.analysis.time_response.matrix_exponential import (
    TIME,
    closed_form,
    following,
    has_sums,
    motion,
    powers_of,
    question_of,
    require_continuous,
    require_no_instant,
    tell_exponential,
    tell_impulses,
    tell_open_power,
    tell_polynomial,
    tell_power,
    tell_question,
)
from symobs.tasks.result import Result, choose, holds, method, task

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence

    from symobs.exact.time_functions.matrix_exponential import Exponential
    from symobs.formula.figures import Interval
    from symobs.formula.tree import Environment, Relation
    from symobs.formula.tree.term import Term
    from symobs.proof.certificate.claims import Claim
    from symobs.proof.derivation.builder import Builder, Slot
    from symobs.system import StateSpace
    from symobs.system.specification import MatrixText, Name, TimeFunctions


# Courses over time in a picture: responses of a system with numbers from its initial state, by segments that fit.


#: The slowest mode has fallen to e⁻⁶, a quarter of a per cent, at the end.
TIMES = 6.0


#: How many segments are drawn, more where a response changes fast at first: none passes by the values between its ends at
#: more than this part of the window.
_STEPS, _BETWEEN, _PARTS = (400, 800, 1600), Fraction(1, 110), 10**6


_ROUND = (Fraction(1), Fraction(3, 2), Fraction(2), Fraction(3), Fraction(4), Fraction(5), Fraction(6), Fraction(8))


#: Signals, each with its rows as a matrix times the state, and whether it is dashed.
Signals: TypeAlias = "Sequence[tuple[str, Matrix, bool]]"


def plot_courses(
    page: Builder,
    states: tuple[str, ...],
    starts: tuple[tuple[Fraction, ...], ...],
    matrix: Term,
    signals: Signals,
    end: Fraction,
    say: str,
    **slots: Slot,
) -> None:
    """Plot signals of a system with these states and their starts up to an end, unless no segments fit or all is at rest."""
    from symobs.exact.time_functions.matrix_exponential import state_response  # noqa: PLC0415
    from symobs.proof.derivation.plot_check import is_slow  # noqa: PLC0415 - only pages with responses pay for it

    if not is_slow(matrix.value, end / (2 * _STEPS[0])):  # a mode would turn unseen between two instants
        return
    start = tuple(part for parts in starts for part in parts)
    for steps in _STEPS:
        try:
            between = state_response(matrix.value, start, end / (2 * steps), 2 * steps + 1, _PARTS)
        except ArithmeticError:
            return
        courses = [
            (name, index if table.shape[0] > 1 else 0, row, course(row, between), dashed)
            for name, table, dashed in signals
            for index, row in enumerate(rows_of(table), 1)
        ]
        made = tuple(PlottedResponse(name, at, row, course[::2], dashed) for name, at, row, course, dashed in courses)
        window = window_of(end, made, _PARTS)
        if window[1][0] == window[1][1]:
            return
        if all(_is_smooth(course, window[1]) for _, _, _, course, _ in courses):
            page.plot(TimeResponse(states, starts, made, window, _PARTS), matrix, say=say, **slots)
            return


def _is_smooth(heights: Sequence[int], edges: Interval) -> bool:
    """Return whether segments from every other instant to the next pass close by the values between them."""
    allowed = int(2 * _BETWEEN * (edges[1] - edges[0]) * _PARTS)
    triples = zip(heights[::2], heights[1::2], heights[2::2], strict=False)
    return all(abs(a - 2 * v + b) <= allowed for a, v, b in triples)


def window_of(end: Fraction, responses: Sequence[PlottedResponse], parts: int) -> tuple[Interval, Interval]:
    """Return a window with a little room above and below."""
    low, high = min(min(each.heights) for each in responses), max(max(each.heights) for each in responses)
    edge = Fraction(high - low, 20)
    return (Fraction(0), end), ((low - edge) / parts, (high + edge) / parts)


def rows_of(table: Matrix) -> list[tuple[Fraction, ...]]:
    """Return the rows of a matrix of numbers."""
    return [tuple(entry.fraction() for entry in row) for row in table.rows]


def course(row: Sequence[Fraction], states: Sequence[Sequence[int]]) -> tuple[int, ...]:
    """Return row · state, in whole parts, at all instants; `states` are the courses of the components of the state."""
    common = lcm(*(part.denominator for part in row))
    first, *others = [(int(part * common), state) for part, state in zip(row, states, strict=True) if part] or [
        (0, states[0])
    ]
    total = first[1] if first[0] == 1 else [first[0] * value for value in first[1]]
    for factor, state in others:
        total = [value + factor * more for value, more in zip(total, state, strict=True)]
    return tuple(total) if common == 1 else tuple([value // common for value in total])


def rounded_up(value: float) -> Fraction:
    """Return a round number that is not smaller."""
    power = Fraction(1)
    while power * 10 <= value:
        power *= 10
    while power > value:
        power /= 10
    return next((factor * power for factor in _ROUND if factor * power >= value), 10 * power)


# The picture of a response: the input is the output of an exosystem, so state and input have a linear equation.


#: More courses cannot be told from one another.
_MOST_COURSES = 6


#: What is drawn of an undamped oscillation, in periods; of growth, in time constants; and where nothing has a time scale.
_PERIODS, _GROWTHS, _ANY = 3, 3.0, Fraction(10)


_NEAR_ZERO = 1e-9


class InputModel(NamedTuple):
    """ẇ = S w, u = V w, w(0) = w₀, with w the inputs and their derivatives, also as functions of t."""

    S: Matrix
    V: Matrix
    start: Matrix
    w: Matrix


def input_model(u: Matrix) -> InputModel | None:
    """Return the exosystem of an input that is not 0; None where it is no system of rational numbers."""
    if u.is_zero:
        return None
    found = exosystem(u)
    return None if found.S.names or found.start.names else found


def exosystem(u: Matrix) -> InputModel:
    """Return the least exosystem of each input, of which one at least is not 0."""
    blocks: list[tuple[Matrix, list[Scalar]]] = []
    functions: list[list[Scalar]] = []
    for (entry,) in table_of(u):
        if entry.is_zero:
            blocks.append((Matrix.zeros(0, 0), []))
            continue
        coefficients = [normal_form(c) for c in _annihilator(entry).coefficients("s")]
        start, derivative = [], entry
        for _ in coefficients[1:]:
            start.append(derivative.at_zero)
            functions.append([derivative.value_at(Scalar.symbol("t"))])
            derivative = derivative.derivative()
        blocks.append((companion(coefficients[1:]), start))
    sizes = [len(start) for _, start in blocks]
    zeros = [[Matrix.zeros(a, b) for b in sizes] for a in sizes]
    S = Matrix.block([[*row[:i], blocks[i][0], *row[i + 1 :]] for i, row in enumerate(zeros) if sizes[i]])
    first = [sum(sizes[:i]) if size else None for i, size in enumerate(sizes)]
    V = Matrix.of([[Scalar.of(int(j == at)) for j in range(sum(sizes))] for at in first])
    return InputModel(S, V, Matrix.column([value for _, start in blocks for value in start]), Matrix.of(functions))


def _annihilator(entry: Quasipolynomial) -> Scalar:
    """Return the least polynomial q with q(d/dt) u = 0."""
    powers: dict[tuple[Scalar, Scalar], int] = {}
    for key in entry.terms:
        mode = key.rate, key.frequency
        powers[mode] = max(powers.get(mode, 0), key.power + 1)
    found, s = Scalar.of(1), Scalar.symbol("s")
    for (rate, frequency), power in powers.items():
        factor = s - rate if frequency.is_zero else (s - rate) ** 2 + frequency**2
        found = found * factor**power
    return found


def plot_response(page: Builder, begins: Matrix, model: InputModel | None) -> None:
    """Plot state and output from x(0); plant and input have numbers."""
    order = page.plant.order
    states: tuple[str, ...] = ("x",)
    starts: tuple[tuple[Fraction, ...], ...] = (_numbers(begins),)
    whole, row, say = page["A"], Matrix.identity(order), ""
    slots: dict[str, Relation] = {}
    if model is not None:
        w, V, S = page["w_e"], page.value(model.V), page.value(model.S)
        page.dynamics("w_e", S @ w, silent=True)
        page.signal("u", V @ w, silent=True)
        functions = page.value(model.w)
        page.conclude_silently(
            relation(rate_of(functions), S @ functions),
            relation(functions.at("t", 0), model.start),
            relation(page["u_t"], V @ functions),
        )
        whole = page("[A, B {V}; {value}, {S}]", V=V, value=Matrix.zeros(model.S.shape[0], order), S=S)
        row = Matrix.block([[row, Matrix.zeros(order, model.S.shape[0])]])
        states, starts = ("x", "w_e"), (*starts, _numbers(model.start))
        slots = {"input": relation(page["u"], w if Matrix.identity(V.value.shape[1]) == model.V else V @ w)}
        say = "plot_response_constant"
        if not model.S.is_zero:
            slots["exosystem"] = relation(w.derivative, S @ w)
            say = "plot_response_forced"
    elif page.plant.matrices.has_input:
        page.signal("u", page("{value} x", value=Matrix.zeros(page.plant.inputs, order)), silent=True)
    if signals := _signals(page.plant, row, model):
        plot_courses(page, states, starts, whole, signals, _end(whole.value), say, **slots)


def _signals(plant: StateSpace, row: Matrix, model: InputModel | None) -> Signals:
    """Return the state, and the output where it is no component of the state, up to a number of courses."""
    m, order = plant.matrices, plant.order
    found = [("x", row, False)] if order <= _MOST_COURSES else []
    if m.has_output and m.C.shape[0] <= _MOST_COURSES - (order if found else 0):
        seen = m.C @ row
        if model is not None and m.has_feedthrough:
            seen = seen + Matrix.block([[Matrix.zeros(m.C.shape[0], order), m.D @ model.V]])
        if not found or not set(rows_of(seen)) <= set(rows_of(row)):
            found.append(("y", seen, False))
    return found


def _numbers(start: Matrix) -> tuple[Fraction, ...]:
    return tuple(entry.fraction() for entry in start.entries)


def _end(matrix: Matrix) -> Fraction:
    """Return when decay is over, or oscillation and growth have been seen."""
    from symobs.exact.time_functions.matrix_exponential import eigenvalues_near  # noqa: PLC0415 - only pages with responses pay for it

    found = eigenvalues_near(matrix)
    near = _NEAR_ZERO * max(map(abs, found))
    if (fastest := max(root.real for root in found)) > near:
        return rounded_up(_GROWTHS / fastest)
    times = [TIMES / -root.real for root in found if root.real < -near]
    times += [2 * pi * _PERIODS / abs(root.imag) for root in found if abs(root.real) <= near < abs(root.imag)]
    return rounded_up(max(times)) if times else _ANY


@dataclass
class Response(DampingCases):
    """x(t) with x′ = A x + B u and x(0) = x₀, which has one solution, and y = C x + D u."""

    task: ClassVar[str] = "response"
    answered_by = ("state",)
    functions_of_time = {"x": "state", "x(t)": "state", "y": "output", "y(t)": "output"}
    letters = {"state": "x_t", "output": "y_t"}
    #: The letter of time.
    clock: ClassVar[str] = "t"
    main: ClassVar[str] = "state"
    asked_for: ClassVar[tuple[str, ...]] = ("initial", "input", "impulse")

    @classmethod
    def of(cls, plant: StateSpace, method_name: str, asked: Mapping[str, Any], taken: Signs) -> Self:
        """Return the result for a plant; `asked` holds the initial state, the input in t, and the strength of its impulse."""
        v = asked["impulse"]
        start = asked["initial"] if v is None else asked["initial"] + plant.matrices.B @ v
        shared = {**{name: asked[name] for name in cls.asked_for}, "start": start, "taken": taken, "chosen": {}}
        try:
            found, chosen = closed_form(plant, taken, sums=has_sums(plant))
            forced = _motion_from_rest(plant, found, asked["input"])
        except NoClosedForm as error:
            nothing = {"state": None, "output": None, "question": question_of(error), "factor": error.factor}
            return cls(plant, method_name, {**shared, **nothing})
        m, answer = plant.matrices, {**shared, "chosen": chosen, "exponential": found.matrix(TIME), "output": None}
        if forced is not None:
            answer["forced"] = forced if isinstance(forced, Matrix) else matrix_at(forced, TIME)
        if not found.is_closed:
            state = found.matrix(TIME) @ start + (start * 0 if forced is None else answer["forced"])
            if m.has_output:
                seen = m.C @ state
                through = forced is not None and m.has_feedthrough
                answer["output"] = seen + m.D @ asked["input"] if through else seen
            return cls(plant, method_name, {**answer, "state": state})
        table = product(found.table(), table_of(start))
        if isinstance(forced, tuple):
            table = _plus(table, forced)
        if m.has_output:
            outputs = product(table_of(m.C), table)
            if forced is not None and m.has_feedthrough:
                outputs = _plus(outputs, product(table_of(m.D), table_of(asked["input"])))
            answer["output"] = matrix_at(outputs, TIME)
        return cls(plant, method_name, {**answer, "state": matrix_at(table, TIME)})

    @property
    def matrices(self) -> tuple[Matrix | Scalar, ...]:
        """The functions of time, and the initial state."""
        names = ("initial", "input", "impulse", "exponential", "forced", "state", "output")
        return tuple(self.answer[name] for name in names if self.answer.get(name) is not None)

    def claims(self) -> Iterator[Claim]:
        """Yield the differential equation, the start, and the output."""
        yield from super().claims()
        if self.answer["state"] is None:
            return
        m, k, answer = self.plant.matrices, self.clock, self.answer
        names = {f"x_{k}": "state", f"y_{k}": "output", f"u_{k}": "input", "x_0": "start"}
        names |= {"exp_At": "exponential", "x_f": "forced"}
        values: dict[str, Any] = {"A": m.A, "B": m.B, "C": m.C, "D": m.D}
        values |= {name: answer[key] for name, key in names.items() if answer.get(key) is not None}
        e = time_environment(self.plant, values)
        if "exp_At" in values:
            yield from exponential_claims(e)
        if "x_f" in values:
            yield holds(e, "x_t = exp_At x_0 + x_f")
        yield holds(e, f"{{rate}} = {self.moved}", rate=self.rate(e))
        yield holds(e, "{begun} = x_0", begun=e[f"x_{k}"].at(k, 0))
        if k == "t":
            begun = _begun(self, e, leave_out_rest=False)
            yield holds(e, "x_0 = {begun}", "x0 is the initial state and what the impulse adds", begun=begun)
        if answer["output"] is not None:
            yield holds(e, f"y_{k} = {self.seen}")

    def rate(self, e: Environment) -> Term:
        """Return x′."""
        return rate_of(e["x_t"])

    @property
    def moved(self) -> str:
        """A x + B u."""
        return f"A x_{self.clock}" + (f" + B u_{self.clock}" if self.answer["input"] is not None else "")

    @property
    def seen(self) -> str:
        """C x + D u."""
        through = self.answer["input"] is not None and self.plant.matrices.has_feedthrough
        return f"C x_{self.clock}" + (f" + D u_{self.clock}" if through else "")

    def tell_motion(self, page: Builder) -> str:
        """Write the matrix exponential; return its letter."""
        taken = {**self.answer["taken"], **self.answer["chosen"]}
        tell_exponential(page, closed_form(self.plant, taken, sums=has_sums(self.plant))[0], self.answer["exponential"])
        return "exp_At"

    @cached_property
    def fields(self) -> Mapping[str, Any]:
        """State and output in t; where there is none, the question that is open."""
        asked = self.answer.get("question")
        found = {name: self.answer[name] for name in ("state", "output")}
        return {**found, **({"question": asked} if asked else {})}

    @cached_property
    def input_model(self) -> InputModel | None:
        """The exosystem of an input in numbers."""
        return None if self.answer["input"] is None else input_model(self.answer["input"])

    @property
    def is_drawn(self) -> bool:
        """Whether a picture can show the response: it is one function, in numbers."""
        m, u, start = self.plant.matrices, self.answer["input"], self.answer["start"]
        data = [part for part in (m.A, m.B, m.C, m.D, start) if part is not None]
        if self.answer["state"] is None or self.plant.relations or any(part.names for part in data):
            return False
        return u is None or u.is_zero or self.input_model is not None

    @property
    def free_signals(self) -> Mapping[str, int]:
        """The state of the exosystem."""
        return {"w_e": self.input_model.S.shape[0]} if self.is_drawn and self.input_model else {}

    def write(self, page: Builder) -> None:
        """Write the matrix exponential, what is given, the forced response, state and output, the check."""
        page.in_time(*self.everything())
        given(page)
        with page.section("response"):
            tell_polynomial(page)
            self.write_branches(page, _write_branch)
            if self.is_drawn:
                plot_response(page, self.answer["start"], self.input_model)


def _motion_from_rest(plant: StateSpace, found: Exponential, u: Matrix | None) -> Table | Matrix | None:
    """Return ∫₀ᵗ e^{A(t−s)} B u(s) ds; beside sums over roots it is the motion of the plant and the exosystem of u.

    Raises `NoClosedForm` where that has parameters.
    """
    B = plant.matrices.B
    if u is None or u.is_zero:
        return None if u is None else B @ u
    if found.is_closed:
        return motion_from_rest(found.table(), B, table_of(u))
    S, V, start, _ = exosystem(u)
    if not all(map(is_number, S.entries)):
        raise NoClosedForm(plant.matrices.A.characteristic_polynomial(plant.variable))
    (n, _), m = B.shape, S.shape[0]
    whole = Matrix.block([[plant.matrices.A, B @ V], [Matrix.zeros(m, n), S]])
    moved = motion(plant, whole, Matrix.block([[Matrix.zeros(n, 1)], [start]]))
    return moved.matrix(TIME).select(range(n), range(1))


def _plus(left: Table, right: Table) -> Table:
    return tuple(tuple(a + b for a, b in zip(p, q, strict=True)) for p, q in zip(left, right, strict=True))


def _begun(result: Response, e: Environment, *, leave_out_rest: bool = True) -> Term:
    """Return the initial state plus B v, what an impulse of strength v adds to it."""
    before, v = result.answer["initial"], result.answer["impulse"]
    if v is None:
        return written("{before}", e, before=before)
    added = written("B" if v == Matrix.identity(1) else "B {v}", e, v=v)
    return added if leave_out_rest and before.is_zero else written("{before} + {added}", e, before=before, added=added)


def _entry(matrix: Matrix) -> Matrix | Scalar:
    """Return the entry of a 1×1 matrix, else the matrix."""
    return matrix[0, 0] if matrix.shape == (1, 1) else matrix


def _write_branch(page: Builder, result: Response) -> None:
    """Write one branch."""
    answer, k, in_steps = result.answer, result.clock, result.clock == "k"
    if answer.get("question") is not None:
        (tell_open_power if in_steps else tell_question)(page, answer["factor"])
        page.remark("response_not_given")
        return
    motion = result.tell_motion(page)
    begins, has_impulse, u = answer["start"], answer["impulse"] is not None, None
    from_rest = begins.is_zero and not has_impulse
    x_0 = page.value(begins) if from_rest else page.set("x_0", begins)
    if answer["input"] is not None:
        u = relation(page.set(f"u_{k}", answer["input"]), _entry(answer["input"]))
        if in_steps:
            tell_impulses(page, answer["input"])
    if has_impulse:
        chain = [_begun(result, page.environment), _entry(begins)]
        page.equal(relation(x_0, *chain), say="response_impulse")
        if u is not None:
            page.equal(u, say="response_beside")
    elif u is None:
        page.equal(relation(x_0, _entry(begins)), say="response_free")
    elif from_rest:
        page.equal(u, say="response_from_rest")
    else:
        page.equal(relation(x_0, _entry(begins)), u, say="response_driven")
    members, say = [] if from_rest and not in_steps else [page(f"{motion} {{x_0}}", x_0=x_0)] if motion else [], ""
    if u is None:
        say = "response_state_free" if members else "output_forced"
    elif in_steps:
        say = "steps_state"
    elif from_rest:
        say = "output_forced"
    else:
        members, say = [members[0] + _forced(page, answer["forced"])], "response_state"
    x = page.define(f"x_{k}", *members, answer["state"], say=say, answer=True, closing=False)
    if answer["output"] is not None:
        shown = result.seen, _entry(answer["output"])
        page.define(f"y_{k}", *shown, say="response_output", answer=True, closing=False)
    moved = page.line(f"{{rate}} = {result.moved}", rate=result.rate(page.environment))
    page.verified("steps_checked" if in_steps else "response_checked", moved, start=relation(x.at(k, 0), x_0))


def _forced(page: Builder, value: Matrix) -> Term:
    """Define the motion from rest, which is held to its differential equation without words."""
    x_f = page.define("x_f", value, say="output_forced", closing=False)
    rate = page.line("{rate} = A x_f + B u_t", rate=rate_of(x_f))
    page.conclude_silently(rate, page.line("{start} = 0", start=page["x_f(t = 0)"]))
    return x_f


@method("response/superposition", source="kailath1980, ch. 2; ogata2010, ch. 9")
def superposition(plant: StateSpace, asked: Mapping[str, Any]) -> Response:
    """Add e^{At} x₀ and the motion from rest, ∫₀ᵗ e^{A(t−s)} B u(s) ds."""
    return Response.of(plant, "superposition", asked, {})


@task
def response(
    plant: StateSpace,
    *,
    initial: MatrixText = None,
    input: TimeFunctions = None,  # noqa: A002 - the specification's word
    impulse: MatrixText = None,
    method: Name = "auto",
) -> Result:
    """Return the response x(t) = e^{At} x₀ + ∫₀ᵗ e^{A(t−s)} B u(s) ds and y = C x + D u to an initial state and an input.

    plant    n states; B where an input is given, C where the output is asked for
    initial  x₀; 0 where it is left out
    input    u(t) for t ≥ 0: sums of exponentials, sines and cosines times powers of t, one for each input, such as 1 for
             a step and t for a ramp; none where it is left out
             In discrete time an expression in k, "1 + k*(1/2)^k", or a sequence "1, 0, 2", which is 0 behind its end.
    impulse  the strength v of an impulse v δ(t), one for each input, which moves the state to x₀ + B v at t = 0
    Returns state, output, in t (in k).  Where the sign of a discriminant decides between oscillation and none, and where an
    input is in resonance, conditions hold the branch that is shown and cases the others; undecided where the modes have no
    closed form.  Raises `InputError` where nothing is given, for other functions of t, and where the impulse goes through to
    the output; `ShapeMismatch`.
    Source: T. Kailath, Linear Systems, ch. 2; K. Ogata, Modern Control Engineering, 5th ed., ch. 9.
    """
    plant = plant.knowing(initial, input, impulse)
    if not plant.is_discrete:
        require_continuous(plant, "response")
    if initial is None and input is None and impulse is None:
        message = "nothing moves the plant: neither an initial state nor an input is given"
        raise InputError(message, where="specification.input", repair='give input = "1" for a step, or initial')
    if plant.is_discrete:
        choose("response", method, "superposition")
        return response_in_steps(plant, initial, input, impulse).asked(method)
    size = (plant.order, 1)
    start = Matrix.zeros(*size) if initial is None else read_gain(initial, plant, "initial", size)
    v = None
    if impulse is not None:
        plant.require("B", task="response")
        v = read_gain(impulse, plant, "impulse", (plant.inputs, 1))
        if plant.matrices.has_feedthrough and not (plant.matrices.D @ v).is_zero:
            message = "the impulse goes through D to the output, which is then no function of t"
            raise InputError(
                message, where="specification.impulse", repair="leave C and D out: the state is a function of t"
            )
    u = None
    if input is not None:
        plant.require("B", task="response")
        u, _ = read_functions(input, plant, "input", plant.inputs)
    return choose("response", method, "superposition").solve(plant, {"initial": start, "input": u, "impulse": v})


# In discrete time: x(k + 1) = A x(k) + B u(k), where u is the output of a system of its own; together they have powers.


@dataclass
class ResponseInSteps(Response):
    """x(k) with x(k + 1) = A x(k) + B u(k) and x(0) = x₀, and y = C x + D u."""

    functions_of_time = {"x": "state", "x(k)": "state", "y": "output", "y(k)": "output"}
    letters = {"state": "x_k", "output": "y_k"}
    clock = "k"

    @classmethod
    def of(cls, plant: StateSpace, method_name: str, asked: Mapping[str, Any], taken: Signs) -> Self:
        """Return the result for a plant; `asked` holds the initial state and the input in k."""
        m, start, u = plant.matrices, asked["initial"], asked["input"]
        shared = {"initial": start, "input": u, "impulse": None, "start": start, "taken": taken, "chosen": {}}
        A, z = m.A, start
        if u is not None:
            A, z = _with_input(m.A, m.B, start, u, plant.variable)
        try:
            parts = matrix_power(A, plant.variable)
        except NoClosedForm as error:
            nothing = {"state": None, "output": None, "question": question_of(error), "factor": error.factor}
            return cls(plant, method_name, {**shared, **nothing})
        state, rows = Matrix.zeros(plant.order, 1), range(plant.order)
        for value, matrix in parts:
            state = state + (matrix @ z).select(rows, [0]) * value
        state, output = state.normal(), None
        if m.has_output:
            output = (m.C @ state if u is None else m.C @ state + m.D @ u).normal()
        return cls(plant, method_name, {**shared, "state": state, "output": output})

    def rate(self, e: Environment) -> Term:
        """Return x(k + 1)."""
        return following(e["x_k"])

    def tell_motion(self, page: Builder) -> str:
        """Write the powers of A where nothing else moves the plant."""
        A = self.plant.matrices.A
        if self.answer["input"] is not None:
            return ""
        tell_power(page, A, powers_of(A, page.plant.variable))
        return "A_k"

    @property
    def is_drawn(self) -> bool:
        """No picture is drawn."""
        return False

    def write(self, page: Builder) -> None:
        """Write the powers of A, what is given, state and output, the check."""
        page.in_time(*self.everything())
        given(page)
        with page.section("response"):
            tell_polynomial(page)
            self.write_branches(page, _write_branch)


def _with_input(A: Matrix, B: Matrix, start: Matrix, u: Matrix, variable: str) -> tuple[Matrix, Matrix]:
    """Return the matrix of plant and input system together, and the initial state of both."""
    polynomial = _input_polynomial(u, variable)
    size, inputs = polynomial.degree(variable), u.shape[0]
    S = companion(polynomial.coefficients(variable)[1:])
    samples = [substitute(u, {"k": Scalar.of(at)}) for at in range(size)]
    begun = Matrix.column([samples[at][i, 0] for i in range(inputs) for at in range(size)])
    own = Matrix.of(
        [
            [S[i % size, j % size] if i // size == j // size else Scalar.of(0) for j in range(inputs * size)]
            for i in range(inputs * size)
        ]
    )
    first = Matrix.of([[int(j == i * size) for j in range(inputs * size)] for i in range(inputs)])
    zero = Matrix.zeros(inputs * size, A.shape[0])
    return Matrix.block([[A, B @ first], [zero, own]]).normal(), Matrix.block([[start], [begun]])


def _input_polynomial(u: Matrix, variable: str) -> Scalar:
    """Return the polynomial of the input system: (z − λ)ʲ⁺¹ for kʲ λᵏ, and zʲ⁺¹ for δ(k, j)."""
    z, counts = Scalar.symbol(variable), dict[Scalar, int]()
    for entry in u.entries:
        for _, powers in entry.numerator.terms():
            degree = next((power for name, power in powers if name == "k"), 0)
            found = [function for name, _ in powers if isinstance(function := function_named(name), PowerOf)]
            mode = z - (found[0].base if found else 1)
            if found and found[0].kind == "KroneckerDelta":
                mode, degree = z, int(found[0].base.fraction())
            counts[mode] = max(counts.get(mode, 0), degree + 1)
    total = Scalar.of(1)
    for mode, count in counts.items():
        total = total * mode**count
    return total if counts else z


# What is given.


def response_in_steps(plant: StateSpace, initial: object, given_input: object, impulse: object) -> ResponseInSteps:
    """Return the response to an initial state and an input; raises `InputError`, `ShapeMismatch`."""
    require_no_instant(plant)
    if impulse is not None:
        message = "an impulse in discrete time is an input"
        raise InputError(message, where="specification.impulse", repair='write the sequence input = "1, 0"')
    size = (plant.order, 1)
    start = Matrix.zeros(*size) if initial is None else read_gain(initial, plant, "initial", size)
    if "k" in start.names:
        message = "the initial state does not depend on the instant k"
        raise InputError(message, where="specification.initial", repair="give the values at k = 0")
    u = None
    if given_input is not None:
        plant.require("B", task="response")
        u = _read_input(given_input, plant)
    return ResponseInSteps.of(plant, "superposition", {"initial": start, "input": u}, {})


def _read_input(value: object, plant: StateSpace) -> Matrix:
    """Return the inputs as functions of k: a sequence, which is 0 behind its end, or an expression for each."""
    where = "specification.input"
    table = parse_in_steps(value, plant.symbols, where)
    if table.shape == (1, plant.inputs) or (plant.inputs == 1 and table.shape[1] == 1):
        table = table.T
    if table.shape[0] != plant.inputs or table.shape[1] > MOST_SAMPLES:
        message = f"{table.shape[0]}×{table.shape[1]} entries of the input, for {plant.inputs} inputs"
        raise ShapeMismatch(message, where=where, repair="write an expression in k, or a sequence, for each input")
    if table.shape[1] > 1:
        impulses = [PowerOf.of("KroneckerDelta", Scalar.of(at)) for at in range(table.shape[1])]
        moving = "k" in symbols_in(table)
        table = (table @ Matrix.column(impulses)).normal()
        if moving:
            raise InputError(
                "the entries of a sequence depend on k", where=where, repair="give numbers, or one expression"
            )
    _require_sums(table, where)
    return table


def _require_sums(table: Matrix, where: str) -> None:
    """Raise `InputError` for other functions of k than sums of powers of k times λᵏ."""
    for entry in table.entries:
        several = any(
            sum(power for name, power in powers if isinstance(function_named(name), PowerOf)) > 1
            for _, powers in entry.numerator.terms()
        )
        moving = [f for f in functions_in([entry]) if "k" in f.symbols and not isinstance(f, PowerOf)]
        below = any(name == "k" or isinstance(function_named(name), PowerOf) for name in entry.denominator.names)
        if (
            several
            or below
            or moving
            or any("k" in f.base.names for f in functions_in([entry]) if isinstance(f, PowerOf))
        ):
            message = f"the input {entry} is no sum of powers of k times powers of numbers to the k"
            raise InputError(message, where=where, repair='write for example "1 + k*(1/2)^k", or a sequence "1, 0, 2"')
