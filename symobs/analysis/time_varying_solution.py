"""What has a closed form for a time-varying plant: Φ, its Gramian, the states never seen, the initial state."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from symobs.analysis.intervals import END
from symobs.analysis.transition import START, TIME, antiderivative_since, transition
from symobs.exact import Matrix, Scalar, kernel

if TYPE_CHECKING:
    from collections.abc import Mapping

    from symobs.system import StateSpace


@dataclass(frozen=True)
class Asked:
    """What is asked beside the plant: the interval, and the output and input from which x₀ is to be found."""

    interval: tuple[Scalar, Scalar] | None = None
    output: Matrix | None = None
    input: Matrix | None = None

    @property
    def start(self) -> Scalar:
        """The initial instant; t₀ where no interval is given."""
        return self.interval[0] if self.interval else Scalar.symbol(START)

    @property
    def end(self) -> Scalar:
        """The last instant; t₁ where no interval is given."""
        return self.interval[1] if self.interval else Scalar.symbol(END)

    def substitute(self, values: Mapping[str, Scalar]) -> Asked:
        """Return the same with parameters replaced."""
        interval = (self.start.substitute(values), self.end.substitute(values)) if self.interval else None
        output = None if self.output is None else self.output.substitute(values)
        return Asked(interval, output, None if self.input is None else self.input.substitute(values))


def closed_form(plant: StateSpace, asked: Asked) -> dict[str, Any]:
    """Return Φ with what follows from it, None for each that has no closed form here."""
    names = ("transition_matrix", "kernel", "gramian", "gramian_in_time", "forced", "x0", "candidate", "moment")
    answer: dict[str, Any] = dict.fromkeys(names)
    found = transition(plant.matrices.A)
    if found is None:
        return answer
    answer["transition_matrix"] = found.matrix
    try:
        Phi = found.matrix.substitute({START: asked.start})
        seen = (plant.matrices.C @ Phi).normal()
        answer["kernel"] = _constant_kernel(seen)
        answer["gramian_in_time"] = G = antiderivative_since((seen.T @ seen).normal(), asked.start)
        answer["gramian"] = None if G is None else G.substitute({TIME: asked.end})
    except ZeroDivisionError:  # the interval begins or ends where A has a pole
        return answer
    if asked.output is not None:
        answer |= _initial_state(plant, asked, Phi, seen, answer["gramian"])
    return answer


def _constant_kernel(seen: Matrix) -> Matrix:
    """Return a basis of the constant v with C Φ v = 0: the coefficients of all powers of t vanish."""
    numerator = seen * seen.common_denominator()
    rows: list[list[Scalar]] = []
    for row in numerator.rows:
        height = max(entry.degree(TIME) for entry in row) + 1
        table = [[*([Scalar.of(0)] * height), *entry.coefficients(TIME)][-height:] for entry in row]
        rows += [list(line) for line in zip(*table, strict=True)]
    return kernel(Matrix.of(rows, seen.shape[1]))


def _initial_state(
    plant: StateSpace, asked: Asked, Phi: Matrix, seen: Matrix, gramian: Matrix | None
) -> dict[str, Matrix | None]:
    """Return the forced part f of the state and x₀ = W⁻¹ ∫ Φᵀ Cᵀ ξ with ξ = y − C f − D u; where y is not its output, why."""
    m, n = plant.matrices, plant.order
    forced: Matrix | None = Matrix.zeros(n, 1)
    xi = asked.output
    assert xi is not None  # noqa: S101 - asked by the caller
    if asked.input is not None:
        driven = antiderivative_since((Phi.inverse() @ m.B @ asked.input).normal(), asked.start)
        forced = None if driven is None else (Phi @ driven).normal()
        xi = None if forced is None else (xi - m.C @ forced - m.D @ asked.input).normal()
    if xi is None or gramian is None or gramian.determinant().is_zero:
        return {"forced": forced}
    moment = antiderivative_since((seen.T @ xi).normal(), asked.start)
    if moment is None:
        return {"forced": forced}
    x0 = gramian.solve(moment.substitute({TIME: asked.end})).normal()
    if (seen @ x0 - xi).is_zero:
        return {"forced": forced, "x0": x0}
    return {"forced": forced, "candidate": x0, "moment": moment}
