"""The initial state from the output, and from output and input with feedthrough.

With ỹ = y − C x_f − D u, where x_f is the motion from rest, ỹ = C e^{At} x₀, so W x₀ = ∫ e^{Aᵀt} Cᵀ ỹ dt.  The value and
the derivatives of ỹ at 0 give the only candidate; whether it explains the data at all times is then asked exactly.
"""

from __future__ import annotations

from functools import cached_property
from math import factorial
from typing import TYPE_CHECKING, Any, ClassVar, Required, Self, TypedDict

from symobs.exact import Matrix, Scalar, kernel
from symobs.exact.core.generators import all_roots, function_named, normal_form, substitute, symbols_in
from symobs.exact.time_functions.matrix_exponential import NoClosedForm
from symobs.exact.time_functions.quasipolynomial import (
    Table,
    determinant,
    integral,
    matrix_at,
    product,
    table_of,
    transposed,
)
from symobs.formula.tree import Environment, Evaluated, Literal
from symobs.formula.tree.calculus import since_start
from symobs.formula.tree.term import Term, block, letter
from symobs.ground.dataclass import dataclass
from symobs.ground.errors import InputError, ShapeMismatch
from symobs.proof.certificate.claims import Claim
from symobs.proof.derivation.builder import relation
from symobs.system.conditions import Condition, never_zero, vanishing_factors
from symobs.system.specification import parse_in_steps
from symobs.tasks.analysis.rank.rank_test import rank_answer
from symobs.tasks.analysis.time_response.damping_cases import (
    Signs,
    exponential_claims,
    from_zero,
    rate_of,
    time_environment,
)
from symobs.tasks.analysis.time_response.horizons import (
    OfTheInitialState,
    OfTheInitialStateAnswer,
    over_horizon,
    read_functions,
    read_horizon,
)
from symobs.tasks.analysis.time_response.matrix_exponential import (
    TIME,
    closed_form,
    question_of,
    require_continuous,
    tell_exponential,
    tell_polynomial,
    tell_question,
)
from symobs.tasks.result import Case, Result, choose, holds, method, page_of, task
from symobs.tasks.result.answers import named_found, those_found

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from symobs.proof.derivation.builder import Builder
    from symobs.system import StateSpace
    from symobs.system.specification import Horizon, Name, TimeFunctions
    from symobs.tasks.analysis.strata.strata import RankAnswer
    from symobs.tasks.analysis.time_response.damping_cases import Signs


def difference(left: Table, right: Table) -> Table:
    """Return left − right."""
    return tuple(tuple(a - b for a, b in zip(p, q, strict=True)) for p, q in zip(left, right, strict=True))


def motion_from_rest(exponential: Table, B: Matrix, u: Table) -> Table:
    """Return ∫₀ᵗ e^{A(t−s)} B u(s) ds."""
    backwards = tuple(tuple(entry.reversed() for entry in row) for row in exponential)
    return product(exponential, integral(product(backwards, product(table_of(B), u))))


def derivatives_at_zero(free: Table, count: int) -> list[Scalar]:
    """Return the values of ỹ, ỹ′, … at 0, output by output within each derivative."""
    found: list[Scalar] = []
    rows = [row[0] for row in free]
    for _ in range(count):
        found += [entry.at_zero for entry in rows]
        rows = [entry.derivative() for entry in rows]
    return found


class Measured(TypedDict):
    """Output and input, as functions of t or a column for each sample."""

    output: Matrix
    input: Matrix | None


class InitialStateAsked(Measured):
    """What is measured over a horizon."""

    horizon: Scalar


class Solved(TypedDict, total=False):
    """x₀; or the only candidate and what its output leaves; or a row w with w 𝒪 = 0 that refutes the data."""

    x0: Required[Matrix | None]
    candidate: Matrix
    rest: Matrix
    row: Matrix
    start: Matrix
    refuted: tuple[Scalar, ...]


class InitialStateAnswer(Measured, Solved, OfTheInitialStateAnswer, total=False):
    """Beside x₀ or what refutes the data the motions, and both integrals as functions of t; for samples 𝒪 x₀ = r."""

    horizon: Scalar
    exponential: Matrix
    forced: Matrix
    free: Matrix
    gramian_function: Matrix
    moment_function: Matrix
    stack: Matrix
    right: Matrix
    residual: Matrix


@dataclass
class InitialState(OfTheInitialState):
    """x₀ with y = C (e^{At} x₀ + x_f) + D u, where x_f′ = A x_f + B u and x_f(0) = 0; or the proof that there is none."""

    answer: InitialStateAnswer
    task: ClassVar[str] = "initial_state"
    answered_by = ("x0",)
    only_value = ("x0",)
    letters = {"x0": "x_0"}
    main: ClassVar[str] = "x0"
    asked_for: ClassVar[tuple[str, ...]] = ("output", "input", "horizon")

    @classmethod
    def of(cls, plant: StateSpace, method_name: str, asked: InitialStateAsked, taken: Signs) -> Self:
        """Return the result for a plant."""
        m = plant.matrices
        test = rank_answer(m.A, m.C)
        u_t, y_t, horizon = asked["input"], asked["output"], asked["horizon"]
        shared: InitialStateAnswer = {
            "horizon": horizon,
            "output": y_t,
            "input": u_t,
            "x0": None,
            "taken": taken,
            "chosen": {},
            "rank": test,
        }
        try:
            found, chosen = closed_form(plant, taken)
        except NoClosedForm as error:
            return cls(plant, method_name, {**shared, "question": question_of(error), "factor": error.factor})
        table = found.table()
        free, seen = table_of(y_t), product(table_of(m.C), table)
        answer: InitialStateAnswer = {**shared, "chosen": chosen, "exponential": matrix_at(table, TIME)}
        if u_t is not None:
            u = table_of(u_t)
            rest = motion_from_rest(table, m.B, u)
            free = difference(free, product(table_of(m.C), rest))
            if m.has_feedthrough:
                free = difference(free, product(table_of(m.D), u))
            answer["forced"] = matrix_at(rest, TIME)
        answer["free"] = matrix_at(free, TIME)
        weighted = product(transposed(seen), free)
        answer |= {
            "gramian_function": matrix_at(integral(product(transposed(seen), seen)), TIME),
            "moment_function": matrix_at(integral(weighted), TIME),
        }
        return cls(plant, method_name, {**answer, **_solved(test, derivatives_at_zero(free, plant.order), seen, free)})

    @property
    def named_data(self) -> Mapping[str, Any]:
        """The initial state."""
        found = self.answer["x0"]
        return {} if found is None else dict.fromkeys(("x0", "x_0"), found)

    def measured(self, at: Scalar, derivative: int = 0) -> Matrix | None:
        """Return the output that was measured, or a derivative of it, at an instant; None where nothing was measured."""
        table = table_of(self.answer["output"])
        for _ in range(derivative):
            table = tuple(tuple(entry.derivative() for entry in row) for row in table)
        return matrix_at(table, at)

    @property
    def matrices(self) -> tuple[Matrix | Scalar, ...]:
        """The functions of time."""
        answer = self.answer
        motions = answer["output"], answer["input"], answer.get("exponential"), answer.get("forced"), answer.get("free")
        integrals = answer.get("gramian_function"), answer.get("moment_function")
        return those_found(*motions, *integrals, answer.get("rest"), answer["x0"])

    @property
    def verdict(self) -> str:
        """`no` where nothing explains the data, or more than one state does."""
        if self.answer.get("question") is None and (self.answer["x0"] is None or not self.is_unique):
            return "no"
        return super().verdict

    @property
    def further_zeros(self) -> tuple[Scalar, ...]:
        """Where the pair may lose rank, and where what refutes the data may not."""
        plain = (factor for factor in self._refuting_factors if not _has_functions(factor))
        return tuple(dict.fromkeys((*super().further_zeros, *plain)))

    @cached_property
    def case_tree(self) -> tuple[Case, ...]:
        """Those of all results in time; and undecided ones where what refutes the data vanishes with roots or functions."""
        beyond = filter(_has_functions, self._refuting_factors)
        return (*super().case_tree, *(Case((Condition("existence", f, "=="),), {}, None) for f in beyond))

    @property
    def _refuting_factors(self) -> tuple[Scalar, ...]:
        """What vanishes where the data are not refuted; a root by itself does not, as the sign of its argument is taken."""
        found = vanishing_factors(self.answer.get("refuted", ()), self.plant.symbols.signs)
        roots = {root.value for root in all_roots(*found)}
        return tuple(factor for factor in found if factor not in roots)

    def _values(self) -> dict[str, Matrix]:
        m, answer = self.plant.matrices, self.answer
        values = {
            "A": m.A,
            "B": m.B,
            "C": m.C,
            "D": m.D,
            "O": answer["rank"]["matrix"],
            "exp_At": answer["exponential"],
        }
        values |= {"W_t": answer["gramian_function"], "r_t": answer["moment_function"]}
        given = {"y_t": answer["output"], "u_t": answer["input"], "x_f": answer.get("forced"), "y_0": answer["free"]}
        return values | named_found(given | {"x_0": answer["x0"], "candidate": answer.get("candidate")})

    def claims(self) -> Iterator[Claim]:
        """Yield the motion from rest, the output explained, the moment equations, and what excludes others."""
        yield from super().claims()
        if self.answer.get("question") is None:
            e = time_environment(self.plant, self._values(), self.end)
            yield from self._about_motion(e)
            yield from self._about_state(e)
        yield from self.observability_claims()

    def _about_motion(self, e: Environment) -> Iterator[Claim]:
        free = letter("y_t", e)
        yield from exponential_claims(e)
        if "x_f" in e.values:
            x_f, u = letter("x_f", e), letter("u_t", e)
            yield holds(e, "{rate} = A x_f + B u_t", rate=rate_of(e["x_f"]))
            yield holds(e, "x_f(t = 0) = 0")
            free = free - letter("C", e) @ x_f
            if self.plant.matrices.has_feedthrough:
                free = free - letter("D", e) @ u
        yield holds(e, "y_0 = {free}", "what the input adds is taken away", free=free)

    def _about_state(self, e: Environment) -> Iterator[Claim]:
        free = letter("y_0", e)
        if "x_0" in e.values:
            yield holds(e, "{free} = C exp_At x_0", free=free)
            yield from from_zero(["W_t", "r_t"], e)
            yield self._moments(e)
            return
        at_zero = []
        for _ in range(self.plant.order):
            at_zero.append(free.at("t", 0))
            free = rate_of(free)
        start = block([[part] for part in at_zero])
        if "candidate" in e.values:
            yield holds(e, "O candidate = {start}", "the candidate follows from the derivatives at 0", start=start)
            yield holds(e, "y_0 !== C exp_At candidate", "its output is not the one measured")
            return
        row = Term(Literal(self.answer["row"]), e)
        yield holds(e, "{row} O = 0", row=row)
        yield Claim(relation(row @ start, "!==", 0), e)

    def _moments(self, e: Environment) -> Claim:
        """Return W x₀ = ∫ e^{Aᵀt} Cᵀ ỹ dt, both integrals with their primitives."""
        Phi, C, horizon = letter("exp_At", e), letter("C", e), self.answer["horizon"]
        gramian = since_start((Phi.T @ C.T @ C @ Phi).formula, letter("W_t", e).formula, horizon)
        right = since_start((Phi.T @ C.T @ letter("y_0", e)).formula, letter("r_t", e).formula, horizon)
        return Claim(relation(Term(gramian, e) @ letter("x_0", e), Term(right, e)), e)

    @cached_property
    def fields(self) -> Mapping[str, Any]:
        """The state, and the kernel where it is not the only one."""
        x0, N = self.answer["x0"], self.answer["rank"]["kernel"]
        asked = self.answer.get("question")
        vectors = [list(N.select(range(N.shape[0]), [j]).entries) for j in range(N.shape[1])]
        found = {"x0": None if x0 is None else list(x0.entries), "kernel": vectors}
        return {**found, **({"question": asked} if asked else {})}


def _has_functions(value: Scalar) -> bool:
    return any(function_named(name) for name in value.names)


def _solved(test: RankAnswer, start: list[Scalar], seen: Table, free: Table) -> Solved:
    """Return x₀; or the only candidate and what its output leaves; or a row w with w 𝒪 = 0 that refutes the data."""
    O = test["matrix"]
    right = Matrix.column(start)
    rows, columns = test["rows"], test["columns"]
    order = O.shape[1]
    values = [Scalar.of(0)] * order
    if columns:
        solution = O.select(rows, columns).solve(right.select(rows, [0]))
        for place, index in enumerate(columns):
            values[index] = normal_form(solution[place, 0])
    state = Matrix.column(values)
    left = [normal_form(entry) for entry in (O @ state - right).entries]
    if any(not entry.is_zero for entry in left):
        null = kernel(O.T)
        for vector in (null.select(range(null.shape[0]), [j]) for j in range(null.shape[1])):
            if not normal_form((vector.T @ right)[0, 0]).is_zero:
                return {"x0": None, "row": vector.T, "start": right, "refuted": ((vector.T @ right)[0, 0],)}
    rest = difference(free, product(seen, table_of(state)))
    if any(not entry.is_zero for row in rest for entry in row):
        return {"x0": None, "candidate": state, "rest": matrix_at(rest, TIME), "refuted": tuple(_refuting(rest))}
    return {"x0": state}


def _refuting(rest: Table) -> Iterator[Scalar]:
    """Yield values one of which vanishes wherever all these functions do.

    A term of one of them vanishes with its coefficient, or another becomes the same function of t.
    """
    terms = next(entry.terms for row in rest for entry in row if not entry.is_zero)
    key, coefficient = next(iter(terms.items()))
    yield coefficient
    if key.wave == "sin":
        yield key.frequency
    for other in terms:
        if other.power == key.power and other.rate != key.rate:
            yield key.rate - other.rate
        elif other.power == key.power and other.frequency != key.frequency:
            yield key.frequency**2 - other.frequency**2


@method("initial_state/moments", source="kalman1963a")
def moments(plant: StateSpace, asked: InitialStateAsked) -> InitialState:
    """Take the input's part away, take the candidate from the derivatives at 0, hold it to the data at all times."""
    return InitialState.of(plant, "moments", asked, {})


@task
def initial_state(
    plant: StateSpace,
    *,
    output: TimeFunctions = None,
    input: TimeFunctions = None,  # noqa: A002 - the specification's word
    horizon: Horizon = None,
    method: Name = "auto",
) -> Result:
    """Return the initial state x₀ of an output y(t) under an input u(t), y = C (e^{At} x₀ + x_f) + D u, or that none exists.

    plant    n states, p outputs; B where an input is given
    output   y(t): sums of exponentials, sines and cosines times powers of t, one for each output
    input    u(t), likewise; 0 where it is left out
    horizon  the end of the interval of measurement, "T" if left out
    In discrete time output and input are samples from k = 0 on, "1, 3", n of them or more; a row for each of several.
    Returns x0, kernel; the residual of samples that no state explains.  Verdict no where no state explains the data, and
    where more than one does.  Raises `InputError` where C (or B) is missing, for other functions of t, for an infinite
    horizon and for too few samples; `ShapeMismatch`.
    Source: R. E. Kalman, Y. C. Ho and K. S. Narendra (1963).
    """
    plant.require("C", task="initial_state")
    if plant.is_discrete:
        return _of_samples(plant, output, input, horizon, method)
    require_continuous(plant, "initial_state")
    y, _ = read_functions(output, plant, "output", plant.outputs)
    u = None
    if input is not None:
        plant.require("B", task="initial_state")
        u, _ = read_functions(input, plant, "input", plant.inputs)
    end = read_horizon(plant, horizon)
    if isinstance(end, str):
        message = "the interval of measurement is finite"
        raise InputError(message, where="specification.horizon", repair='write "T", or a number above 0')
    asked: InitialStateAsked = {"output": y, "input": u, "horizon": end}
    return over_horizon(lambda: choose("initial_state", method, "moments").solve(plant, asked))


def _of_samples(plant: StateSpace, output: object, given: object, horizon: object, method_name: str) -> Result:
    """Return the initial state of samples, in discrete time."""
    if horizon is not None:
        message = "in discrete time the samples say how long was measured"
        raise InputError(message, where="specification.horizon", repair="leave the horizon out")
    plant = plant.knowing(output, given)
    y = read_samples(output, plant, "output", plant.outputs)
    if y.shape[1] < plant.order:
        message = f"{y.shape[1]} samples of the output, and {plant.order} states"
        raise InputError(message, where="specification.output", repair=f"give {plant.order} samples or more")
    u = None
    if given is not None:
        plant.require("B", task="initial_state")
        u = read_samples(given, plant, "input", plant.inputs)
        if u.shape[1] < y.shape[1]:  # the last one may be missing, or all from one on: they are 0
            u = Matrix.block([[u, Matrix.zeros(plant.inputs, y.shape[1] - u.shape[1])]])
    choose("initial_state", method_name, "moments")
    asked: Measured = {"output": y, "input": u}
    return InitialStateOfSamples.of(plant, "moments", asked, {}).asked(method_name)


# The page of the initial state: free output, forced output, moments, solution, check.


#: The order of det W(T) grows like the square of the number of states, and so does the search for it.
_WARNED_UP_TO = 3


@page_of(InitialState)
def write_initial_state(page: Builder, result: InitialState) -> None:
    """Write the document's five steps."""
    page.in_time(*result.everything(), at=result.end)
    result.state_data(page)
    with page.section("initial_state"):
        tell_polynomial(page)
        result.write_branches(page, _write_branch)


def _write_branch(page: Builder, result: InitialState) -> None:
    """Write one branch."""
    answer = result.answer
    if answer.get("question") is not None:
        tell_question(page, answer["factor"])
        return
    found, _ = closed_form(result.plant, {**answer["taken"], **answer["chosen"]})
    tell_exponential(page, found, answer["exponential"])
    y = page.set("y_t", answer["output"])
    data = [relation(y, _entry(answer["output"]))]
    if answer["input"] is not None:
        u = page.set("u_t", answer["input"])
        data.append(relation(u, _entry(answer["input"])))
    page.equal(*data, say="measured")
    free = _tell_forced(result, page)
    if answer["x0"] is None:
        _tell_refusal(result, page, free)
        return
    _tell_moments(result, page, free, answer["x0"])


def _entry(matrix: Matrix) -> Matrix | Scalar:
    """Return the entry of a 1×1 matrix, else the matrix."""
    return matrix[0, 0] if matrix.shape == (1, 1) else matrix


def _tell_forced(result: InitialState, page: Builder) -> Term:
    """Write the motion from rest and ỹ; return ỹ."""
    answer, y = result.answer, page["y_t"]
    if answer["input"] is None:
        page.equal("C exp_At = #", say="output_of_exponential")
        page.set("y_0", answer["output"])
        return y
    page.define("x_f", answer["forced"], say="output_forced", closing=False)
    moved = page["y_t - C x_f"]
    if result.plant.matrices.has_feedthrough:
        moved = page("{moved} - D u_t", moved=moved)
    equation = page.line("{rate} = A x_f + B u_t", rate=rate_of(page["x_f"]))
    start = page.line("x_f(t = 0) = 0")
    page.conclude_silently(start)
    told: dict[str, Any] = {"say": "output_solution", "equation": equation}
    if answer["forced"].is_zero:
        page.conclude_silently(equation)
        told = {"say": "output_at_rest"}
    return page.define("y_0", moved, _entry(answer["free"]), closing=False, **told)


def _tell_moments(result: InitialState, page: Builder, free: Term, x0: Matrix) -> None:
    answer = result.answer
    C, Phi, horizon = page["C"], page["exp_At"], answer["horizon"]
    end = {"t": horizon}
    if not result.is_unique:
        page.define("x_0", x0, say="initial_not_unique", answer=True, closing=False)
        N = answer["rank"]["kernel"]
        say = "initial_kernel" if N.shape[1] == 1 else "initial_kernel_several"
        page.equal(page.line("C exp_At x_0 = {free}", free=free), say=say)
        for j in range(N.shape[1]):
            v = page.value(N.select(range(N.shape[0]), [j]))
            page.equal(relation(C @ Phi @ v, _entry(Matrix.zeros(C.value.shape[0], 1))))
        return
    gramian = since_start(page["exp_At.T C.T C exp_At"].formula, Literal(answer["gramian_function"]), horizon)
    right = since_start(page("exp_At.T C.T {free}", free=free).formula, Literal(answer["moment_function"]), horizon)
    page.define("W", page.term(gramian), substitute(answer["gramian_function"], end), say="moments", closing=False)
    page.define("r_0", page.term(right), substitute(answer["moment_function"], end), say="moments_right", closing=False)
    page.define("x_0", x0, say="initial_found", answer=True, closing=False)
    page.verified(
        "initial_checked",
        moments=page.line("W x_0 = r_0"),
        output=page.line("C exp_At x_0 = {free}", free=free),
    )
    _warn_of_short_horizons(result, page)


def _warn_of_short_horizons(result: InitialState, page: Builder) -> None:
    """Say how fast det W(T) vanishes as T → 0, by its Taylor polynomial there; W(t) is held to its derivative and start.

    Of order Tⁿ it is where W itself is nearly T CᵀC with C of full rank: no reason to warn.
    """
    if result.plant.order > _WARNED_UP_TO:
        return
    function = result.answer["gramian_function"]
    rates = [determinant(table_of(function))]
    while rates[-1].at_zero.is_zero:
        rates.append(rates[-1].derivative())
    power, last = len(rates) - 1, rates[-1].at_zero
    if power == result.plant.order or not never_zero(last, page.plant.symbols.signs):
        return
    end = Scalar.symbol("T")
    page.set("W_t", function)
    start = page.line("W_t(t = 0) = 0")
    page.conclude_silently(page.line("{rate} = exp_At.T C.T C exp_At", rate=rate_of(page["W_t"])), start)
    det = page.set("det_W", function.determinant())
    page.conclude_silently(page.line("{value} = det(W_t)", value=det))
    taylor = det.at("t", 0)
    for k in range(1, power + 1):
        det = rate_of(det)
        taylor = taylor + det.at("t", 0) * (end**k / factorial(k))
    leading = page.value(last * end**power / factorial(power))
    page.caution("short_horizon", leading=Evaluated(taylor.formula, leading.formula))


def _tell_refusal(result: InitialState, page: Builder, free: Term) -> None:
    """Show the candidate and what its output leaves, or the row that refutes the data."""
    answer = result.answer
    rates = [free]
    for _ in range(result.plant.order - 1):
        rates.append(rate_of(rates[-1]))
    if "candidate" in answer:
        page.define("x_0", answer["candidate"], say="initial_candidate", closing=False, free=free)
        rest = relation(free - page["C exp_At x_0"], _entry(answer["rest"]), "!==", _entry(answer["rest"] * 0))
        page.remark("initial_refused", rest=rest)
        return
    page.set("O", answer["rank"]["matrix"])
    w, start = page.set("v", answer["row"].T), page.set("r_0", answer["start"])
    at_zero = block([[rate.at("t", 0)] for rate in rates])
    zero = page.line("v.T O = 0")
    page.equal(relation(start, at_zero, answer["start"]), say="initial_start")
    rest = page.line("v.T r_0 = # !== 0")
    page.remark("initial_inconsistent", row=relation(w, answer["row"].T), zero=zero, rest=rest)


# In discrete time: the samples less the forced output are O x₀ = r with O = [C; CA; …]; a row w with w O = 0 refutes others.


#: The forced output of N samples is a sum of N² products.
MOST_SAMPLES = 60


def read_samples(value: object, plant: StateSpace, name: str, rows: int) -> Matrix:
    """Return samples, a column for each instant; raises `InputError`, and `ShapeMismatch` for other than `rows` rows."""
    where = f"specification.{name}"
    if value is None:
        message = f"the samples of the {name} are missing"
        raise InputError(message, where=where, repair=f'give them from k = 0 on, {name} = "1, 3"')
    found = parse_in_steps(value, plant.symbols, where)
    if "k" in symbols_in(found):
        raise InputError(f"the samples of the {name} depend on k", where=where, repair="give the value at each instant")
    if rows == 1 and found.shape[1] == 1:
        found = found.T
    if found.shape[0] != rows:
        message = f"{found.shape[0]} rows of samples of the {name}, but {rows} are expected"
        raise ShapeMismatch(message, where=where, repair="give a row for each signal, an entry for each instant")
    if found.shape[1] > MOST_SAMPLES:
        raise InputError(f"{found.shape[1]} samples of the {name}", where=where, repair=f"keep to {MOST_SAMPLES}")
    return found


@dataclass
class InitialStateOfSamples(InitialState):
    """x₀ with O x₀ = r, the samples without the forced output; or the proof that there is none."""

    @classmethod
    def of(cls, plant: StateSpace, method_name: str, asked: Measured, taken: Signs) -> Self:
        """Return the result for a plant."""
        m, y, u = plant.matrices, asked["output"], asked["input"]
        test = rank_answer(m.A, m.C)
        rows, state = [m.C], Matrix.zeros(plant.order, 1)
        right: list[Scalar] = []
        for k in range(y.shape[1]):
            sample = _column(y, k) - m.C @ state
            if u is not None:
                sample = sample - m.D @ _column(u, k)
                state = (m.A @ state + m.B @ _column(u, k)).normal()
            right += sample.entries
            rows.append((rows[-1] @ m.A).normal())
        O, r = Matrix.block([[row] for row in rows[:-1]]), Matrix.column(list(map(normal_form, right)))
        answer: InitialStateAnswer = {
            "output": y,
            "input": u,
            "rank": test,
            "taken": taken,
            "chosen": {},
            "stack": O,
            "right": r,
            "x0": None,
        }
        values = [Scalar.of(0)] * plant.order
        if test["columns"]:
            solution = test["matrix"].select(test["rows"], test["columns"]).solve(r.select(test["rows"], [0]))
            for place, index in enumerate(test["columns"]):
                values[index] = normal_form(solution[place, 0])
        candidate = Matrix.column(values)
        residual = Matrix.column([normal_form(entry) for entry in (r - O @ candidate).entries])
        if residual.is_zero:
            return cls(plant, method_name, {**answer, "x0": candidate})
        null = kernel(O.T)
        for j in range(null.shape[1]):
            w = _column(null, j).T
            value = normal_form((w @ r)[0, 0])
            if not value.is_zero:
                return cls(plant, method_name, {**answer, "row": w, "residual": residual, "refuted": (value,)})
        raise ArithmeticError("a residual that no row refutes")

    def measured(self, at: Scalar, derivative: int = 0) -> Matrix | None:
        """Return the sample of the output at an instant, None where there is none."""
        y, number = self.answer["output"], at.fraction() if at.is_constant else None
        is_sampled = not derivative and number is not None and number.denominator == 1 and 0 <= number < y.shape[1]
        return _column(y, int(number)) if is_sampled and number is not None else None

    @property
    def matrices(self) -> tuple[Matrix | Scalar, ...]:
        """The samples and the state."""
        return those_found(self.answer["output"], self.answer["input"], self.answer["x0"])

    def claims(self) -> Iterator[Claim]:
        """Yield the stacked equations, and that the state solves them or that a row refutes them."""
        m, answer = self.plant.matrices, self.answer
        values = {"A": m.A, "B": m.B, "C": m.C, "D": m.D, "O": answer["stack"], "r_0": answer["right"]}
        values |= {} if answer["x0"] is None else {"x_0": answer["x0"]}
        e = Environment(variable=self.plant.variable, values=values, signs=self.plant.symbols.signs)
        yield holds(e, "O = {value}", value=block([[row] for row in self.seen(e)]))
        yield holds(
            e,
            "r_0 = {value}",
            "r is the output without that of the input",
            value=block([[sample] for sample in self.free(e)]),
        )
        if answer["x0"] is not None:
            yield holds(e, "O x_0 = r_0")
        else:
            w = Term(Literal(answer["row"]), e)
            yield holds(e, "{w} O = 0", w=w)
            yield holds(e, "{w} r_0 !== 0", w=w)
        yield from self.observability_claims()

    def seen(self, e: Environment) -> list[Term]:
        """Return C Aᵏ for each sample."""
        A, C = letter("A", e), letter("C", e)
        return [C @ A**k if k else C for k in range(self.answer["output"].shape[1])]

    def free(self, e: Environment) -> list[Term]:
        """Return y(k) − Σ C A^(k−1−i) B u(i) − D u(k)."""
        A, B, C, D, y, u = *(letter(name, e) for name in "ABCD"), self.answer["output"], self.answer["input"]
        inputs = [] if u is None else [_column(u, i) for i in range(u.shape[1])]
        found = []
        for k in range(y.shape[1]):
            sample = Term(Literal(_column(y, k)), e)
            for i, moved in enumerate(inputs[:k]):
                if moved.is_zero:
                    continue
                power = C @ A ** (k - 1 - i) if k - 1 - i else C
                sample = sample - power @ B @ Term(Literal(moved), e)
            if inputs and self.plant.matrices.has_feedthrough and not inputs[k].is_zero:
                sample = sample - D @ Term(Literal(inputs[k]), e)
            found.append(sample)
        return found

    @cached_property
    def fields(self) -> Mapping[str, Any]:
        """The state, the kernel where it is not the only one, and what is left where there is none."""
        residual = self.answer.get("residual")
        return {**super().fields, **({} if residual is None else {"residual": list(residual.entries)})}


def _column(table: Matrix, index: int) -> Matrix:
    return table.select(range(table.shape[0]), [index])


@page_of(InitialStateOfSamples)
def write_initial_state_of_samples(page: Builder, result: InitialStateOfSamples) -> None:
    """Write the stacked equations, and their solution or why there is none."""
    page.in_time(*result.everything())
    result.state_data(page)
    with page.section("initial_state"):
        result.write_branches(page, _write_samples)


def _write_samples(page: Builder, result: InitialStateOfSamples) -> None:
    """Write one branch."""
    answer = result.answer
    page.define("O", block([[row] for row in result.seen(page.environment)]), say="samples_stacked")
    samples = block([[sample] for sample in result.free(page.environment)])
    say = "samples_right" if answer["input"] is None else "samples_right_input"
    members = [samples] if answer["input"] is not None else []
    r = page.define("r_0", *members, answer["right"], say=say, closing=False)
    page.conclude_silently(relation(r, samples))
    if answer["x0"] is None:
        w = page.set("v", answer["row"].T)
        zero = page.line("v.T O = 0")
        rest = page.line("v.T r_0 = # !== 0")
        page.remark("samples_inconsistent", row=relation(w, answer["row"].T), zero=zero, rest=rest)
        return
    page.define(
        "x_0",
        answer["x0"],
        say="samples_found" if result.is_unique else "initial_not_unique",
        answer=True,
        closing=False,
    )
    if not result.is_unique:
        N = answer["rank"]["kernel"]
        say = "samples_kernel" if N.shape[1] == 1 else "samples_kernel_several"
        zeros = [page.line("O {j} = 0", j=_column(N, j)) for j in range(N.shape[1])]
        page.equal(*zeros, say=say)
    page.verified("samples_checked", check=page.line("O x_0 = r_0"))
