"""The response x(t) = e^{At} x₀ + ∫₀ᵗ e^{A(t−s)} B u(s) ds, y = C x + D u: its claims and its page.

The answer is held to the differential equation and to the initial state, which have one solution.
"""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING, Any, ClassVar, NotRequired, Self, TypedDict

from symobs.exact import Matrix, Scalar
from symobs.exact.algebraic.enclosure import is_number
from symobs.exact.core.generators import substitute
from symobs.exact.time_functions.matrix_exponential import NoClosedForm
from symobs.exact.time_functions.quasipolynomial import Table, matrix_at, product, table_of
from symobs.formula.tree.written import written
from symobs.ground.dataclass import dataclass
from symobs.proof.derivation.builder import Builder, relation
from symobs.tasks.analysis.page_parts import given
from symobs.tasks.analysis.time_response.damping_cases import (
    DampingAnswer,
    DampingCases,
    Signs,
    exponential_claims,
    rate_of,
    time_environment,
)
from symobs.tasks.analysis.time_response.initial_state import motion_from_rest
from symobs.tasks.analysis.time_response.matrix_exponential import (
    TIME,
    closed_form,
    has_sums,
    motion,
    question_of,
    tell_exponential,
    tell_impulses,
    tell_open_power,
    tell_polynomial,
    tell_question,
)
from symobs.tasks.analysis.time_response.response_plot import InputModel, exosystem, input_model, plot_response
from symobs.tasks.result import holds
from symobs.tasks.result.answers import named_found, those_found

if TYPE_CHECKING:
    from collections.abc import Collection, Iterator, Mapping

    from symobs.exact.time_functions.matrix_exponential import Exponential
    from symobs.formula.tree import Environment
    from symobs.formula.tree.term import Term
    from symobs.proof.certificate.claims import Claim
    from symobs.proof.derivation.builder import Builder
    from symobs.system import StateSpace


class ResponseAsked(TypedDict):
    """The initial state, the input as a function of the instant, its impulse, and an instant."""

    initial: Matrix
    input: Matrix | None
    impulse: Matrix | None
    at_time: Scalar | None


class ResponseAnswer(ResponseAsked, DampingAnswer):
    """State and output; the state after the impulse, e^{At}, and the motion from rest."""

    start: Matrix
    state: Matrix | None
    output: Matrix | None
    exponential: NotRequired[Matrix]
    forced: NotRequired[Matrix]


@dataclass
class Response(DampingCases):
    """x(t) with x′ = A x + B u and x(0) = x₀, which has one solution, and y = C x + D u."""

    answer: ResponseAnswer
    task: ClassVar[str] = "response"
    answered_by = ("state",)
    functions_of_time = {"x": "state", "x(t)": "state", "y": "output", "y(t)": "output"}
    letters = {"state": "x_t", "output": "y_t"}
    #: The letter of time.
    clock: ClassVar[str] = "t"
    main: ClassVar[str] = "state"
    asked_for: ClassVar[tuple[str, ...]] = ("initial", "input", "impulse", "at_time")

    @classmethod
    def fields_asked(cls, given: Collection[str]) -> tuple[str, ...]:
        """Return the response, and its value at an instant that is given."""
        return (*super().fields_asked(given), *(("value",) if "at_time" in given else ()))

    @classmethod
    def of(cls, plant: StateSpace, method_name: str, asked: ResponseAsked, taken: Signs) -> Self:
        """Return the result for a plant."""
        m, v, u = plant.matrices, asked["impulse"], asked["input"]
        start = asked["initial"] if v is None else asked["initial"] + m.B @ v
        answer: ResponseAnswer = {
            "initial": asked["initial"],
            "input": u,
            "impulse": v,
            "at_time": asked["at_time"],
            "start": start,
            "taken": taken,
            "chosen": {},
            "state": None,
            "output": None,
        }
        try:
            found, chosen = closed_form(plant, taken, sums=has_sums(plant))
            forced = _motion_from_rest(plant, found, u)
        except NoClosedForm as error:
            return cls(plant, method_name, {**answer, "question": question_of(error), "factor": error.factor})
        answer |= {"chosen": chosen, "exponential": found.matrix(TIME)}
        if forced is not None:
            answer["forced"] = forced if isinstance(forced, Matrix) else matrix_at(forced, TIME)
        if not found.is_closed:
            state = found.matrix(TIME) @ start + (start * 0 if forced is None else answer["forced"])
            if m.has_output:
                seen = m.C @ state
                answer["output"] = seen + m.D @ u if u is not None and m.has_feedthrough else seen
            return cls(plant, method_name, {**answer, "state": state})
        table = product(found.table(), table_of(start))
        if isinstance(forced, tuple):
            table = _plus(table, forced)
        if m.has_output:
            outputs = product(table_of(m.C), table)
            if u is not None and m.has_feedthrough:
                outputs = _plus(outputs, product(table_of(m.D), table_of(u)))
            answer["output"] = matrix_at(outputs, TIME)
        return cls(plant, method_name, {**answer, "state": matrix_at(table, TIME)})

    @property
    def matrices(self) -> tuple[Matrix | Scalar, ...]:
        """The functions of time, and the initial state."""
        answer = self.answer
        motion = answer.get("exponential"), answer.get("forced"), answer["state"], answer["output"]
        return those_found(answer["initial"], answer["input"], answer["impulse"], *motion, self.value_then)

    def claims(self) -> Iterator[Claim]:
        """Yield the differential equation, the start, and the output."""
        yield from super().claims()
        if self.answer["state"] is None:
            return
        m, k, answer = self.plant.matrices, self.clock, self.answer
        values = {"A": m.A, "B": m.B, "C": m.C, "D": m.D, "x_0": answer["start"]}
        found = {f"x_{k}": answer["state"], f"y_{k}": answer["output"], f"u_{k}": answer["input"]}
        found |= {"exp_At": answer.get("exponential"), "x_f": answer.get("forced")}
        values |= named_found(found)
        e = time_environment(self.plant, values, answer["at_time"] if k == "t" else None)
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
        if answer["at_time"] is not None:
            yield holds(e, "{then} = {value}", then=self.at_instant(e, answer["at_time"]), value=self.value_then)

    @cached_property
    def value_then(self) -> Matrix | None:
        """The output, or the state of a plant without C, at the instant that is asked for."""
        answer, instant = self.answer, self.answer["at_time"]
        moving = answer["state"] if answer["output"] is None else answer["output"]
        return None if instant is None or moving is None else substitute(moving, {self.clock: instant}).normal()

    @property
    def called(self) -> Mapping[str, str]:
        """The functions of time, and the value at the instant: y(5)."""
        letter, instant = "x" if self.answer["output"] is None else "y", self.answer["at_time"]
        return super().called if instant is None else {**super().called, f"{letter}({instant})": "value"}

    def at_instant(self, e: Environment, instant: Scalar) -> Term:
        """Return y(T), or x(T)."""
        letter = f"{'x' if self.answer['output'] is None else 'y'}_{self.clock}"
        return e[letter].at(self.clock, instant)

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
        found = {"state": self.answer["state"], "output": self.answer["output"]}
        if self.answer["at_time"] is not None:
            found["value"] = self.value_then
        return {**found, **({"question": asked} if asked else {})}

    @cached_property
    def input_model(self) -> InputModel | None:
        """The exosystem of an input in numbers."""
        return None if self.answer["input"] is None else input_model(self.answer["input"])

    @property
    def is_drawn(self) -> bool:
        """Whether a picture can show the response: it is one function, in numbers."""
        m, u, start = self.plant.matrices, self.answer["input"], self.answer["start"]
        data = m.A, m.B, m.C, m.D, start
        if self.answer["state"] is None or self.plant.relations or any(part.names for part in data):
            return False
        return u is None or u.is_zero or self.input_model is not None

    @property
    def free_signals(self) -> Mapping[str, int]:
        """The state of the exosystem."""
        return {"w_e": self.input_model.S.shape[0]} if self.is_drawn and self.input_model else {}

    def write(self, page: Builder) -> None:
        """Write the matrix exponential, what is given, the forced response, state and output, the check."""
        page.in_time(*self.everything(), at=self.answer["at_time"])
        given(page)
        with page.section("response"):
            tell_polynomial(page)
            self.write_branches(page, write_branch)
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


def write_branch(page: Builder, result: Response) -> None:
    """Write one branch."""
    answer, k, in_steps = result.answer, result.clock, result.clock == "k"
    state, instant = answer["state"], answer["at_time"]
    if state is None:
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
    x = page.define(f"x_{k}", *members, state, say=say, answer=True, closing=False)
    if answer["output"] is not None:
        shown = result.seen, _entry(answer["output"])
        page.define(f"y_{k}", *shown, say="response_output", answer=True, closing=False)
    if instant is not None and result.value_then is not None:
        then = relation(result.at_instant(page.environment, instant), _entry(result.value_then))
        page.equal(then, say="response_at_time", answer=True)
    moved = page.line(f"{{rate}} = {result.moved}", rate=result.rate(page.environment))
    page.verified("steps_checked" if in_steps else "response_checked", moved, start=relation(x.at(k, 0), x_0))


def _forced(page: Builder, value: Matrix) -> Term:
    """Define the motion from rest, which is held to its differential equation without words."""
    x_f = page.define("x_f", value, say="output_forced", closing=False)
    rate = page.line("{rate} = A x_f + B u_t", rate=rate_of(x_f))
    page.conclude_silently(rate, page.line("{start} = 0", start=page["x_f(t = 0)"]))
    return x_f
