"""Every value of the worked examples' derivations and answers equals a computation with plain SymPy matrices.

The problems are written out a second time here, by hand; nothing in this file asks symobs how to compute.
"""

from __future__ import annotations

import random
from dataclasses import dataclass, field
from functools import cache, cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest
import sympy
from sympy import Matrix, Rational, symbols

from symobs import problem
from tests.plain_sympy import (
    Reader,
    Tally,
    ackermann,
    canonical_transformation,
    characteristic,
    facts_in,
    inverse,
    is_stable,
    is_zero,
    observability_matrix,
    response,
    values_of,
)

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from symobs.method import Result

FOLDER = Path(__file__).parents[1] / "worked_examples"
SYMBOLIC, AT_POINTS = "symbolic", "at points"

s, z = symbols("s z")
omega, b, p, q, h1, h2, k1, k2, c, d = symbols("omega b p q h1 h2 k1 k2 c d")
M, m, l, g = symbols("M m l g")
p1, p2, p3, p4, q1, q2, q3, q4 = symbols("p1:5 q1:5")


@dataclass(frozen=True)
class Hand:
    """One worked example by hand: the plant, and the polynomials or gains its specification asks for."""

    A: Any
    C: Any = None
    B: Any = None
    D: Any = None
    control: Any = None
    observer: Any = None
    K: Any = None
    L: Any = None
    signs: Mapping[str, str] = field(default_factory=dict)
    variable: Any = s
    large: bool = False

    @property
    def discrete(self) -> bool:
        return self.variable == z

    def at(self, point: Mapping[Any, Any]) -> Hand:
        """Return the problem at one point of its parameters."""
        moved = {
            name: None if value is None else value.subs(point)
            for name, value in vars(self).items()
            if name in {"A", "B", "C", "D", "control", "observer", "K", "L"}
        }
        return Hand(**moved, signs=self.signs, variable=self.variable)

    # -- answers, found by textbook formulas ---------------------------------------------------------------------------

    @cached_property
    def feedthrough(self) -> Any:
        return sympy.zeros(1, 1) if self.D is None else self.D

    @cached_property
    def feedback_gain(self) -> Any:
        return ackermann(self.A.T, self.B.T, self.control, self.variable).T if self.K is None else self.K

    @cached_property
    def observer_gain(self) -> Any:
        return ackermann(self.A, self.C, self.observer, self.variable) if self.L is None else self.L

    @cached_property
    def plant_transfer(self) -> Any:
        return response(self.A, self.B, self.C, self.variable) + self.feedthrough[0]

    @cached_property
    def compensator_matrix(self) -> Any:
        K, L = self.feedback_gain, self.observer_gain
        return self.A - self.B * K - L * self.C + L * self.feedthrough * K

    @cached_property
    def compensator(self) -> Any:
        return response(self.compensator_matrix, self.observer_gain, self.feedback_gain, self.variable)

    @cached_property
    def loop(self) -> Any:
        return sympy.cancel(self.plant_transfer / (1 + self.plant_transfer * self.compensator))

    @cached_property
    def loop_matrix(self) -> Any:
        BK, LC = self.B * self.feedback_gain, self.observer_gain * self.C
        return Matrix([[self.A - BK, BK], [sympy.zeros(*self.A.shape), self.A - LC]])

    @cached_property
    def loop_matrix_estimate(self) -> Any:
        BK, LC = self.B * self.feedback_gain, self.observer_gain * self.C
        return Matrix([[self.A, -BK], [LC, self.A - BK - LC]])


third_order = {"A": Matrix([[-7, 1, 15], [-2, 0, 5], [-2, 0, 4]]), "B": Matrix([65, -5, 30]), "C": Matrix([[1, 0, -2]])}
servo = {"A": Matrix([[0, 1], [0, -1]]), "B": Matrix([0, 1]), "C": Matrix([[1, 0]])}
mass = {"A": Matrix([[0, 1], [0, 0]]), "B": Matrix([0, 1]), "C": Matrix([[1, 0]])}
hanging = {"A": Matrix([[0, 1], [-(omega**2), -b]]), "B": Matrix([0, 1]), "C": Matrix([[0, 1]])}
upright = {"A": Matrix([[0, 1], [omega**2, -b]]), "B": Matrix([0, 1]), "C": Matrix([[0, 1]])}
pendulum = {"omega": "positive", "b": "positive"}
hidden = {"A": Matrix([[0, 1], [-2, -3]]), "C": Matrix([[1, c]]), "signs": {"c": "real"}}
cart_pole = {
    "A": Matrix([[0, 1, 0, 0], [0, -b / M, -m * g / M, 0], [0, 0, 0, 1], [0, b / (M * l), (M + m) * g / (M * l), 0]]),
    "B": Matrix([0, 1 / M, 0, -1 / (M * l)]),
    "C": Matrix([[1, 0, 0, 0]]),
    "signs": dict.fromkeys("M m l g b p1 p2 p3 p4 q1 q2 q3 q4".split(), "positive"),
}

PROBLEMS = {
    "servo_observer": Hand(**servo, observer=(s + 10) ** 2),
    "output_feedback_servo": Hand(**servo, control=(s + 2) ** 2, observer=(s + 10) ** 2),
    "servo_feedthrough": Hand(**servo, D=Matrix([[1]]), control=(s + 2) ** 2, observer=(s + 10) ** 2),
    "servo_feedthrough_parametric": Hand(
        **servo, D=Matrix([[d]]), control=(s + 2) ** 2, observer=(s + 10) ** 2, signs={"d": "real"}
    ),
    "double_integrator_observer": Hand(**mass, observer=(s + 1) * (s + 2)),
    "double_integrator_output_feedback": Hand(**mass, control=s**2 + 2 * s + 2, observer=(s + 1) * (s + 2)),
    "third_order_observer": Hand(**third_order, observer=(s + 5) * (s + 6) * (s + 7)),
    "third_order_plant": Hand(**third_order, control=(s + 3) * (s + 4) * (s + 5)),
    "pendulum_hanging": Hand(**hanging, observer=s**2 + p * s + q, signs=pendulum | {"p": "real", "q": "real"}),
    "pendulum_hanging_given_gain": Hand(**hanging, L=Matrix([h1, h2]), signs=pendulum | {"h1": "real", "h2": "real"}),
    "pendulum_upright": Hand(**upright, observer=s**2 + p * s + q, signs=pendulum | {"p": "real", "q": "real"}),
    "pendulum_upright_given_gain": Hand(**upright, L=Matrix([h1, h2]), signs=pendulum | {"h1": "real", "h2": "real"}),
    "pendulum_state_feedback": Hand(
        A=hanging["A"], B=hanging["B"], K=Matrix([[-k1, -k2]]), signs=pendulum | {"k1": "real", "k2": "real"}
    ),
    "fixed_mode_wanted": Hand(**hidden, observer=(s + 1) * (s + 5)),
    "fixed_modes_all_wanted": Hand(**hidden, observer=(s + 1) * (s + 2)),
    "deadbeat_observer": Hand(A=Matrix([[1, 1], [0, 1]]), C=Matrix([[1, 0]]), observer=z**2, variable=z),
    "cart_pole": Hand(
        **cart_pole,
        control=(s + p1) * (s + p2) * (s + p3) * (s + p4),
        observer=(s + q1) * (s + q2) * (s + q3) * (s + q4),
        large=True,
    ),
}


def points(name: str, count: int) -> Iterator[dict[Any, Any]]:
    """Yield points of a problem's parameters that their declared signs allow, the same in every run."""
    chance = random.Random(name)  # noqa: S311 - points that repeat
    for _ in range(count):
        point = {}
        for parameter, sign in PROBLEMS[name].signs.items():
            size = Rational(chance.randint(1, 40), chance.randint(1, 9))
            point[sympy.Symbol(parameter)] = size if sign == "positive" or chance.random() < 0.5 else -size
        yield point


@cache
def results(name: str) -> tuple[Result, ...]:
    text = (FOLDER / f"{name}.toml").read_text(encoding="utf-8")
    return problem.read(text, name).solve()


def known_letters(hand: Hand) -> dict[str, tuple[Any, ...]]:
    """Return what the letters of a derivation must be worth."""
    A, B, C, s_ = hand.A, hand.B, hand.C, hand.variable
    known: dict[str, tuple[Any, ...]] = {"A": (A,), "chi": (characteristic(A, s_),), "D": (hand.feedthrough,)}
    rates = {"x": A}
    transformations = []
    if B is not None:
        reach = observability_matrix(A.T, B.T).T
        known |= {"B": (B,), "Ctr": (reach,)}
        rates["u"] = B
        if hand.control is not None or hand.K is not None:
            known["K"] = (hand.feedback_gain,)
            transformations.append(canonical_transformation(A, reach, s_))
    if C is not None:
        seen = observability_matrix(A, C)
        known |= {"C": (C,), "O": (seen,)}
        known["y"] = ({"x": C, "u": hand.feedthrough} if hand.D is not None else {"x": C},)
        if hand.observer is not None or hand.L is not None:
            known["L"] = (hand.observer_gain,)
            transformations.append(canonical_transformation(A, seen.T, s_))
    known["x'"] = (rates,)
    known["V"] = tuple(transformations)
    known["V_inv"] = tuple(inverse(V) for V in transformations if not is_zero(V.det()))
    for letter, stem, polynomial in (("phi_c", "alpha_", hand.control), ("phi_o", "beta_", hand.observer)):
        if polynomial is not None:
            known |= {letter: (polynomial,), f"{letter}_at": (polynomial,)}
            coefficients = sympy.Poly(polynomial, s_).all_coeffs()
            known |= {f"{stem}{k}": (coefficients[k],) for k in range(1, len(coefficients))}
    if B is not None and C is not None:
        known["P"] = (hand.plant_transfer,)
    if "K" in known and "L" in known:
        known |= {
            "A_c": (hand.compensator_matrix,),
            "F": (hand.compensator,),
            "A_cl": (hand.loop_matrix,),
            "G_cl": (hand.loop,),
        }
    return known


def read(name: str, result: Result, way: str) -> Tally:
    """Walk one derivation, with symbols or at three points of its parameters; return what was compared."""
    hand, derivation = PROBLEMS[name], result.derivation

    def samples() -> Iterator[dict[Any, Any]]:
        return points(name, 60)

    if way == SYMBOLIC:
        return Reader(derivation, known_letters(hand), samples).read()
    tallies = []
    for point in points(name, 3):
        names = {str(parameter): value for parameter, value in point.items()}
        tallies.append(Reader(derivation, known_letters(hand.at(point)), samples, names).read())
    assert tallies[0] == tallies[1] == tallies[2]
    return tallies[0]


@pytest.mark.parametrize("name", PROBLEMS)
def test_every_line_of_every_derivation(name: str, capsys: pytest.CaptureFixture[str]) -> None:
    hand, total, lines = PROBLEMS[name], Tally(), 0
    for result in results(name):
        tally = read(name, result, AT_POINTS if hand.large else SYMBOLIC)
        facts = list(facts_in(result.derivation.steps))
        assert tally.compared + len(tally.introduced) == values_of(facts)
        lines += len(facts)
        total = Tally(*(a + b for a, b in zip(vars(total).values(), vars(tally).values(), strict=True)))
    with capsys.disabled():
        print(f"\n{name}: {lines} lines, {total}")
