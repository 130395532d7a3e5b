"""The response in discrete time: x(k + 1) = A x(k) + B u(k), where u is the output of a system of its own.

Plant and input together have powers.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Self

from symobs.exact import Matrix, Scalar, companion
from symobs.exact.core.generators import function_named, substitute
from symobs.exact.time_functions.matrix_exponential import NoClosedForm
from symobs.exact.time_functions.matrix_power import PowerOf, matrix_power
from symobs.ground.dataclass import dataclass
from symobs.proof.derivation.builder import Builder
from symobs.tasks.analysis.page_parts import given
from symobs.tasks.analysis.time_response.matrix_exponential import (
    following,
    powers_of,
    question_of,
    tell_polynomial,
    tell_power,
)
from symobs.tasks.analysis.time_response.response_in_time import Response, write_branch

if TYPE_CHECKING:
    from symobs.formula.tree import Environment
    from symobs.formula.tree.term import Term
    from symobs.proof.derivation.builder import Builder
    from symobs.system import StateSpace
    from symobs.tasks.analysis.time_response.damping_cases import Signs
    from symobs.tasks.analysis.time_response.response_in_time import ResponseAnswer, ResponseAsked


@dataclass
class ResponseInSteps(Response):
    """x(k) with x(k + 1) = A x(k) + B u(k) and x(0) = x₀, and y = C x + D u."""

    functions_of_time = {"x": "state", "x(k)": "state", "y": "output", "y(k)": "output"}
    letters = {"state": "x_k", "output": "y_k"}
    clock = "k"

    @classmethod
    def of(cls, plant: StateSpace, method_name: str, asked: ResponseAsked, taken: Signs) -> Self:
        """Return the result for a plant."""
        m, start, u = plant.matrices, asked["initial"], asked["input"]
        answer: ResponseAnswer = {
            "initial": start,
            "input": u,
            "impulse": None,
            "at_time": asked["at_time"],
            "start": start,
            "taken": taken,
            "chosen": {},
            "state": None,
            "output": None,
        }
        A, z = m.A, start
        if u is not None:
            A, z = _with_input(m.A, m.B, start, u, plant.variable)
        try:
            parts = matrix_power(A, plant.variable)
        except NoClosedForm as error:
            return cls(plant, method_name, {**answer, "question": question_of(error), "factor": error.factor})
        state, rows = Matrix.zeros(plant.order, 1), range(plant.order)
        for value, matrix in parts:
            state = state + (matrix @ z).select(rows, [0]) * value
        state, output = state.normal(), None
        if m.has_output:
            output = (m.C @ state if u is None else m.C @ state + m.D @ u).normal()
        return cls(plant, method_name, {**answer, "state": state, "output": output})

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
            self.write_branches(page, write_branch)


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
