"""The worked examples in functions of time written out a second time, with what their letters and answers must be worth.

Nothing in this file asks symobs for anything.  Integrals are left to quadrature.
"""

from __future__ import annotations

import random
from dataclasses import dataclass, field, replace
from functools import cache
from typing import TYPE_CHECKING, Any

import sympy
from sympy import Matrix, Rational, cos, exp, sin, sqrt, symbols

from tests.support.problems.problems_by_hand import (
    IN_TIME,
    TASKS,
    characteristic,
    fixed,
    observability_matrix,
    response,
    s,
)
from tests.support.problems.second_reading import given

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

t, t0, T, sigma, x10, x20, a, b, omega = symbols("t t0 T sigma x10 x20 a b omega")


def exponential(A: Any, time: Any) -> Any:
    """Return e^{A t}: for two states by their mean rate and half the distance of their rates, else by Jordan's form."""
    if A.rows == 1:
        return Matrix([[exp(A[0, 0] * time)]])
    if A.rows == 2:
        mean = A.trace() / 2
        square, shifted = sympy.expand(A.det() - mean**2), A - mean * sympy.eye(2)
        if square == 0:
            return exp(mean * time) * (sympy.eye(2) + shifted * time)
        turn = sqrt(square)
        return exp(mean * time) * (sympy.eye(2) * cos(turn * time) + shifted * (sin(turn * time) / turn))
    return sympy.Matrix(A * time).exp()


def integral(value: Any, name: Any, lower: Any, upper: Any) -> Any:
    return value.applyfunc(lambda entry: sympy.Integral(entry, (name, lower, upper)))


def generic(value: Any) -> Any:
    """Return what an integral is where no rate vanishes, which SymPy gives first."""
    return value.args[0].expr if isinstance(value, sympy.Piecewise) else value


@dataclass(frozen=True)
class InTime:
    """A worked example by hand: the plant, and what is asked about it."""

    A: Any
    C: Any
    B: Any = None
    signs: Mapping[str, str] = field(default_factory=dict)
    horizon: Any = T
    output: Any = None
    input: Any = None
    x0: Any = None
    Q: Any = None
    R: Any = None
    moves: bool = False
    is_held: bool = False

    def at(self, values: Mapping[str, Any]) -> InTime:
        """Return the problem with parameters replaced."""
        replaced = {sympy.Symbol(name): value for name, value in values.items()}
        return replace(self, A=self.A.subs(replaced), C=self.C.subs(replaced))

    # -- answers -------------------------------------------------------------------------------------------------------

    @property
    def gramian(self) -> Any:
        """Return W, over all time by Lyapunov's equation."""
        seen = self.C * exponential(self.A, t)
        if self.horizon != sympy.oo:
            return integral(seen.T * seen, t, 0, self.horizon)
        unknown = Matrix(self.A.rows, self.A.rows, symbols(f"p:{self.A.rows**2}"))
        solved = sympy.solve(list(self.A.T * unknown + unknown * self.A + self.C.T * self.C), list(unknown))
        return unknown.subs(solved)

    @property
    def forced(self) -> Any:
        """Return the motion from rest."""
        if self.input is None:
            return sympy.zeros(self.A.rows, 1)
        return integral(exponential(self.A, t - sigma) * self.B * self.input, sigma, 0, t)

    @property
    def held(self) -> Any:
        """Return what a constant input does over the horizon: the integral of e^{At} B."""
        return integral(exponential(self.A, sigma) * self.B, sigma, 0, self.horizon)

    @property
    def moved(self) -> Any:
        """Return the state: e^{At} x₀ and the motion from rest."""
        return exponential(self.A, t) * self.x0 + self.forced

    @property
    def moment(self) -> Any:
        return integral((self.C * exponential(self.A, t)).T * self.free, t, 0, self.horizon)

    @property
    def free(self) -> Any:
        """Return the output of the initial state alone: C e^{At} x₀."""
        return self.C * exponential(self.A, t) * self.x0

    @property
    def finite_sum(self) -> Any:
        O = observability_matrix(self.A, self.C)
        return O.T * O

    @property
    def spread(self) -> Any:
        """Return V = e^{Aᵀt} W(T − t) B."""
        rest = replace(self, horizon=self.horizon - t).gramian_by(sigma)
        return exponential(self.A, t).T * rest * self.B

    def gramian_by(self, name: Any) -> Any:
        seen = self.C * exponential(self.A, name)
        return (seen.T * seen).applyfunc(
            lambda entry: generic(sympy.integrate(sympy.expand(entry), (name, 0, self.horizon)))
        )

    @property
    def parts(self) -> dict[str, Any]:
        """Return the integrals of the covariance and its parts."""
        W = self.gramian_by(t)
        S_R = W * self.R
        S_Q = integral(self.spread * self.Q * self.spread.T, t, 0, self.horizon)
        return {"W": W, "S_R": S_R, "S_Q": S_Q, "Cov_R": W.inv() * S_R * W.inv(), "Cov_Q": W.inv() * S_Q * W.inv()}

    def letters(self) -> dict[str, Any]:
        """Return what the letters of a page must be worth."""
        known: dict[str, Any] = {"A": self.A, "C": self.C, "chi": characteristic(self.A, s), "x'": {"x": self.A}}
        known |= {"exp_At": exponential(self.A, t), "M": self.finite_sum, "O": observability_matrix(self.A, self.C)}
        known |= {"y": {"x": self.C}}
        if self.B is not None:
            known |= {"B": self.B, "x'": {"x": self.A, "u": self.B}, "P": response(self.A, self.B, self.C, s)}
        if self.is_held:
            return known | {"A_zoh": exponential(self.A, self.horizon), "B_zoh": self.held}
        if self.R is not None:
            parts = self.parts
            known |= parts | {"Q": self.Q, "R": self.R, "V_t": self.spread, "Cov": parts["Cov_R"] + parts["Cov_Q"]}
            known |= {"Phi_m": exponential(self.A, -t), "W_t": replace(self, horizon=t).gramian_by(sigma)}
            known |= {f"var_{k + 1}": known["Cov"][k, k] for k in range(self.A.rows)}
            return known
        if self.moves:
            return known | {
                "x_0": self.x0,
                "u_t": self.input,
                "x_f": self.forced,
                "x_t": self.moved,
                "y_t": self.C * self.moved,
            }
        known |= {"W": self.gramian}
        if self.horizon != sympy.oo:
            known |= {"Phi_T": exponential(self.A, self.horizon)}
        if self.output is not None:
            known |= {"y_t": self.output, "x_0": self.x0, "y_0": self.free, "r_0": self.moment}
            known |= {"u_t": self.input, "x_f": self.forced}
            known |= {"W_t": replace(self, horizon=t).gramian_by(sigma)}
            known |= {"det_W": known["W_t"].det()}
        return known

    def answers(self, task: str) -> dict[str, Any]:
        """Return every field of a task's answer by the textbook's formula."""
        O = observability_matrix(self.A, self.C)
        match task:
            case "matrix_exponential":
                return {"matrix": exponential(self.A, t)}
            case "gramian":
                W = self.gramian
                rank = {"rank": O.rank(), "kernel": tuple(tuple(v) for v in O.nullspace())}
                return {"matrix": W, "determinant": W.det(), "finite_sum": self.finite_sum, **rank}
            case "zero_order_hold":
                return {"A": exponential(self.A, T), "B": self.held, "C": self.C, "D": sympy.zeros(1, 1)}
            case "response":
                return {"state": self.moved, "output": self.C * self.moved}
            case "initial_state":
                return {"x0": self.x0, "kernel": tuple(tuple(v) for v in O.nullspace())}
            case "initial_state_covariance":
                parts = self.parts
                whole = parts["Cov_R"] + parts["Cov_Q"]
                return {"covariance": whole, "input_part": parts["Cov_Q"], "output_part": parts["Cov_R"]}
            case "characteristic_polynomial":
                chi = characteristic(self.A, s)
                return {"polynomial": chi, "factors": chi, "roots": chi}
            case "transfer_function":
                P = response(self.A, self.B, self.C, s)
                return {"transfer_function": P, "poles": P.as_numer_denom()[1], "zeros": P.as_numer_denom()[0]}
        assert task == "observability"
        hidden = sympy.roots(fixed(self.A, self.C, s), s, multiple=True)
        found = {
            "matrix": O,
            "rank": O.rank(),
            "kernel": (),
            "unobservable_modes": tuple(hidden),
            "determinant": O.det(),
        }
        return found | {"missing_measurements": ()}

    def points(self, name: str, count: int) -> Iterator[dict[Any, Any]]:
        """Yield small points that the declared signs allow, the same in every run."""
        chance = random.Random(name)  # noqa: S311 - points that repeat
        for _ in range(count):
            point = {sympy.Symbol(parameter): Rational(chance.randint(1, 40), 16) for parameter in self.signs}
            yield {k: -v if self.signs[str(k)] == "real" and chance.random() < 0.5 else v for k, v in point.items()}


#: The examples in functions of time.
NAMES_IN_TIME = [name for name, tasks in TASKS.items() if {*tasks} & IN_TIME]


@cache
def in_time(name: str) -> InTime:
    """Return a worked example by hand."""
    found = given(name)
    tasks = {*found["tasks"]}
    more: dict[str, Any] = {"moves": "response" in tasks, "is_held": "zero_order_hold" in tasks}
    more |= {"C": Matrix([[1, 0]])} if "C" not in found else {}
    if more["moves"]:  # from rest; an impulse leaves the state B
        impulse = "input" not in found
        more |= {"x0": found["B"] if impulse else 0 * found["B"], "input": Matrix([0]) if impulse else found["input"]}
    elif "output" in found:
        more |= {"x0": Matrix([x10, x20])}
    return InTime(**{key: value for key, value in found.items() if key in InTime.__dataclass_fields__} | more)


# -- plants in which the time stands -----------------------------------------------------------------------------------

DECAYED, TURNED = exp(-t) * Matrix([[1, t + t**2 / 2]]), (t**2 - t0**2) / 2
FADED, ROTATED = exp(-t) * Matrix([[1, t]]), Matrix([[cos(omega * t), sin(omega * t)]])
#: What the letters of pages about time-varying plants must be worth.
VARYING: dict[str, dict[str, Any]] = {
    "time_varying_integrator": {
        "A": Matrix([[0, t], [0, 0]]),
        "B": Matrix([0, 1]),
        "C": Matrix([[1, 0]]),
        "x'": {"x": Matrix([[0, t], [0, 0]]), "u": Matrix([0, 1])},
        "y": {"x": Matrix([[1, 0]])},
        "M": Matrix([[0, (t**2 - t0**2) / 2], [0, 0]]),
        "Phi": Matrix([[1, (t**2 - t0**2) / 2], [0, 1]]),
        "W": Matrix([[T, T**3 / 6], [T**3 / 6, T**5 / 20]]),
        "N_0": Matrix([[1, 0]]),
        "N_1": Matrix([[0, t]]),
        "O": sympy.diag(1, t),
        "t_start": sympy.Integer(0),
        "t_end": T,
        "y_t": a + b * t**2 / 2 + t**3 / 3,
        "u_t": sympy.Integer(1),
        "x_u": Matrix([t**3 / 3, t]),
        "xi": a + b * t**2 / 2,
        "x_0": Matrix([a, b]),
        "x_t": Matrix([a + b * t**2 / 2 + t**3 / 3, b + t]),
    },
    "frozen_time_misleads": {
        "A": Matrix([[0, 1], [0, 0]]),
        "C": Matrix([[1, -t]]),
        "x'": {"x": Matrix([[0, 1], [0, 0]])},
        "y": {"x": Matrix([[1, -t]])},
        "M": Matrix([[0, t - t0], [0, 0]]),
        "Phi": Matrix([[1, t - t0], [0, 1]]),
        "W": Matrix([[T, -T], [-T, T]]),
        "N_0": Matrix([[1, -t]]),
        "N_1": Matrix([[0, 0]]),
        "O": Matrix([[1, -t], [0, 0]]),
        "V": Matrix([t, 1]),
        "X": Matrix([0]),
        "v": Matrix([1, 1]),
        "t_start": sympy.Integer(1),
        "t_end": 1 + T,
    },
    "time_varying_decay": {
        "A": Matrix([[-1, 1 + t], [0, -1]]),
        "C": Matrix([[1, 0]]),
        "x'": {"x": Matrix([[-1, 1 + t], [0, -1]])},
        "y": {"x": Matrix([[1, 0]])},
        "Phi": exp(t0 - t) * Matrix([[1, t - t0 + (t**2 - t0**2) / 2], [0, 1]]),
        "W": integral(DECAYED.T * DECAYED, t, 0, T).doit(),
        "N_0": Matrix([[1, 0]]),
        "N_1": Matrix([[-1, 1 + t]]),
        "O": Matrix([[1, 0], [-1, 1 + t]]),
        "t_start": sympy.Integer(0),
        "t_end": T,
        "y_t": exp(-t) * (a + b * t + b * t**2 / 2),
        "xi": exp(-t) * (a + b * t + b * t**2 / 2),
        "x_0": Matrix([a, b]),
        "x_t": exp(-t) * Matrix([a + b * (t + t**2 / 2), b]),
    },
    "time_varying_rotation": {
        "A": Matrix([[0, t], [-t, 0]]),
        "C": Matrix([[1, 0]]),
        "x'": {"x": Matrix([[0, t], [-t, 0]])},
        "y": {"x": Matrix([[1, 0]])},
        "Phi": Matrix([[cos(TURNED), sin(TURNED)], [-sin(TURNED), cos(TURNED)]]),
        "N_0": Matrix([[1, 0]]),
        "N_1": Matrix([[0, t]]),
        "O": sympy.diag(1, t),
    },
    "time_varying_fading_sensor": {
        "A": Matrix([[0, 1], [0, 0]]),
        "C": Matrix([[exp(-t), 0]]),
        "x'": {"x": Matrix([[0, 1], [0, 0]])},
        "y": {"x": Matrix([[exp(-t), 0]])},
        "M": Matrix([[0, t - t0], [0, 0]]),
        "Phi": Matrix([[1, t - t0], [0, 1]]),
        "W": integral(FADED.T * FADED, t, 0, 1).doit(),
        "N_0": Matrix([[exp(-t), 0]]),
        "N_1": Matrix([[-exp(-t), exp(-t)]]),
        "O": exp(-t) * Matrix([[1, 0], [-1, 1]]),
        "A_1": Matrix([[0, 1], [0, 0]]),
        "C_1": Matrix([[1, -t]]),
        "t_start": sympy.Integer(0),
        "t_end": sympy.Integer(1),
        "y_t": exp(-t) * (2 + 3 * t),
        "xi": exp(-t) * (2 + 3 * t),
        "x_0": Matrix([2, 3]),
        "x_t": Matrix([2 + 3 * t, 3]),
    },
    "time_varying_rotating_sensor": {
        "A": sympy.zeros(2, 2),
        "C": ROTATED,
        "x'": {"x": sympy.zeros(2, 2)},
        "y": {"x": ROTATED},
        "Phi": sympy.eye(2),
        "W": sympy.eye(2) / 2
        + Matrix([[sin(2 * omega), 1 - cos(2 * omega)], [1 - cos(2 * omega), -sin(2 * omega)]]) / (4 * omega),
        "N_0": ROTATED,
        "N_1": ROTATED.diff(t),
        "O": ROTATED.col_join(ROTATED.diff(t)),
        "t_start": sympy.Integer(0),
        "t_end": sympy.Integer(1),
    },
}
