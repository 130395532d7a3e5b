"""The response in discrete time, x(k + 1) = A x(k) + B u(k), y = C x + D u, in closed form.

An input that is a sequence, or a sum of powers of k times λᵏ, is the output of a system w(k + 1) = S w(k) of its own; the
powers of the matrix of both together give the state.  The answer is held to the recursion and to its start.
"""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Any, Self

from symobs.exact import Matrix, Scalar, companion
from symobs.exact.core.generators import function_named, functions_in, substitute
from symobs.exact.time_functions.matrix_exponential import NoClosedForm
from symobs.exact.time_functions.matrix_power import PowerOf, matrix_power
from symobs.formula.tree.term import letter
from symobs.ground.dataclass import dataclass
from symobs.ground.errors import InputError, ShapeMismatch
from symobs.proof.certificate.claims import Claim
from symobs.proof.derivation.builder import relation
from symobs.system.reading import as_rows, read_matrix
from symobs.system.specification import read_gain
from symobs.tasks.analysis.page_parts import given
from symobs.tasks.analysis.time_response.damping_cases import DampingCases, Signs, time_environment
from symobs.tasks.analysis.time_response.initial_state_of_samples import MOST_SAMPLES
from symobs.tasks.analysis.time_response.matrix_exponential import question_of, tell_polynomial
from symobs.tasks.analysis.time_response.matrix_power import (
    following,
    powers_of,
    require_no_instant,
    tell_impulses,
    tell_open_power,
    tell_power,
)
from symobs.tasks.analysis.time_response.response import Response

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from symobs.formula.tree import Environment
    from symobs.formula.tree.term import Term
    from symobs.proof.derivation.builder import Builder
    from symobs.system import StateSpace

#: A number, a name or a parenthesis to the power k.
_POWER = re.compile(r"(\d+(?:\.\d+)?|[A-Za-z]\w*|\([^()]*\))\s*(?:\^|\*\*)\s*k\b")


@dataclass(frozen=True, eq=False, repr=False)
class ResponseInSteps(Response):
    """x(k) with x(k + 1) = A x(k) + B u(k) and x(0) = x₀, and y = C x + D u."""

    functions_of_time = {"x": "state", "x(k)": "state", "y": "output", "y(k)": "output"}
    letters = {"state": "x_k", "output": "y_k"}

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

    def claims(self) -> Iterator[Claim]:
        """Yield the recursion, the start, and the output."""
        yield from super(Response, self).claims()
        if self.answer["state"] is None:
            return
        m, names = self.plant.matrices, {"x_k": "state", "y_k": "output", "u_k": "input", "x_0": "start"}
        values: dict[str, Any] = {"A": m.A, "B": m.B, "C": m.C, "D": m.D}
        values |= {name: self.answer[key] for name, key in names.items() if self.answer[key] is not None}
        e = time_environment(self.plant, values)
        x = letter("x_k", e)
        yield Claim(relation(following(x), self.moved(e)), e, "x(k + 1) = A*x(k) + B*u(k)")
        yield Claim(relation(x.at("k", 0), letter("x_0", e)), e, "x(0) = x0")
        if "y_k" in values:
            yield Claim(relation(letter("y_k", e), self.seen(e)), e, "y = C*x + D*u")

    def moved(self, e: Environment) -> Term:
        """Return A x + B u."""
        free = letter("A", e) @ letter("x_k", e)
        return free if self.answer["input"] is None else free + letter("B", e) @ letter("u_k", e)

    def seen(self, e: Environment) -> Term:
        """Return C x + D u."""
        seen = letter("C", e) @ letter("x_k", e)
        through = self.answer["input"] is not None and self.plant.matrices.has_feedthrough
        return seen + letter("D", e) @ letter("u_k", e) if through else seen

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
    polynomial = _annihilator(u, variable)
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


def _annihilator(u: Matrix, variable: str) -> Scalar:
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


def _write_branch(page: Builder, result: DampingCases) -> None:
    """Write one branch."""
    assert isinstance(result, ResponseInSteps)  # noqa: S101 - its own branches
    answer, A = result.answer, result.plant.matrices.A
    if answer.get("question") is not None:
        tell_open_power(page, answer["factor"])
        page.remark("response_not_given")
        return
    power = tell_power(page, A, powers_of(A, page.plant.variable)) if answer["input"] is None else None
    begins, u = answer["start"], None
    x_0 = page.value(begins) if begins.is_zero else page.set("x_0", begins)
    if answer["input"] is not None:
        u = relation(page.set("u_k", answer["input"]), _entry(answer["input"]))
        tell_impulses(page, answer["input"])
    if u is None:
        page.equal(relation(x_0, _entry(begins)), say="response_free")
    elif begins.is_zero:
        page.equal(u, say="response_from_rest")
    else:
        page.equal(relation(x_0, _entry(begins)), u, say="response_driven")
    members, say = ([], "steps_state") if power is None else ([power @ x_0], "response_state_free")
    x = page.define("x_k", *members, answer["state"], say=say, answer=True, closing=False)
    e = page.environment
    if answer["output"] is not None:
        page.define("y_k", result.seen(e), _entry(answer["output"]), say="response_output", answer=True, closing=False)
    page.verified("steps_checked", relation(following(x), result.moved(e)), start=relation(x.at("k", 0), x_0))


def _entry(matrix: Matrix) -> Matrix | Scalar:
    """Return the entry of a 1×1 matrix, else the matrix."""
    return matrix[0, 0] if matrix.shape == (1, 1) else matrix


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
    known = plant.symbols.seen(value, "k").naming(["k"], where)
    powers: dict[str, str] = {}

    def lettered(text: object) -> object:
        """Return a text with a letter for each power to the k."""
        if not isinstance(text, str):
            return [lettered(entry) for entry in text] if isinstance(text, (list, tuple)) else text

        def named(found: re.Match[str]) -> str:
            name = f"power_{len(powers)}"
            powers[name] = found[1]
            return f"({name})"

        return _POWER.sub(named, text)

    read = lettered(value if isinstance(value, (str, list, tuple)) or hasattr(value, "shape") else [[value]])
    if isinstance(read, str) and not read.lstrip().startswith("["):
        read = f"[{read}]" if "," in read else [[read]]
    table = read_matrix(as_rows("C", read), known.naming(list(powers), where), where)
    if table.shape == (1, plant.inputs) or (plant.inputs == 1 and table.shape[1] == 1):
        table = table.T
    if table.shape[0] != plant.inputs or table.shape[1] > MOST_SAMPLES:
        message = f"{table.shape[0]}×{table.shape[1]} entries of the input, for {plant.inputs} inputs"
        raise ShapeMismatch(message, where=where, repair="write an expression in k, or a sequence, for each input")
    bases = {name: read_matrix([[text]], known, where)[0, 0] for name, text in powers.items()}
    table = substitute(table, {name: PowerOf.of("power", base) for name, base in bases.items()})
    if table.shape[1] > 1:
        impulses = [PowerOf.of("KroneckerDelta", Scalar.of(at)) for at in range(table.shape[1])]
        moving = "k" in table.names or bool(powers)
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
        moving += [name for name in entry.denominator.names if name == "k" or isinstance(function_named(name), PowerOf)]
        if several or moving or any("k" in f.base.names for f in functions_in([entry]) if isinstance(f, PowerOf)):
            message = f"the input {entry} is no sum of powers of k times powers of numbers to the k"
            raise InputError(message, where=where, repair='write for example "1 + k*(1/2)^k", or a sequence "1, 0, 2"')
