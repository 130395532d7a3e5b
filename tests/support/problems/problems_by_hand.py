"""The worked examples written out a second time, by hand, with their answers by textbook formulas in plain SymPy.

Nothing in this file asks symobs for anything.
"""

from __future__ import annotations

import random
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any

import sympy
from sympy import Matrix, Rational, symbols

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping
    from typing import Self

# -- linear algebra ----------------------------------------------------------------------------------------------------


def is_zero(expression: Any) -> bool:
    """Whether a rational expression is 0."""
    numerator = sympy.together(expression).as_numer_denom()[0]
    return bool(sympy.expand(numerator) == 0)


def observability_matrix(A: Any, C: Any) -> Any:
    return sympy.Matrix.vstack(*[C * A**k for k in range(A.rows)])


def polynomial_at(polynomial: Any, variable: sympy.Symbol, A: Any) -> Any:
    total = sympy.zeros(A.rows, A.rows)
    for coefficient in sympy.Poly(polynomial, variable).all_coeffs():
        total = total * A + coefficient * sympy.eye(A.rows)
    return total


def inverse(matrix: Any) -> Any:
    """Return adj / det: no pivot has to be known not to vanish."""
    return (matrix.adjugate() / matrix.det(method="berkowitz")).applyfunc(sympy.cancel)


def ackermann(A: Any, C: Any, polynomial: Any, variable: sympy.Symbol) -> Any:
    """Return φ(A) 𝒪⁻¹ eₙ."""
    last = sympy.eye(A.rows)[:, -1]
    return (polynomial_at(polynomial, variable, A) * (inverse(observability_matrix(A, C)) * last)).applyfunc(
        sympy.cancel
    )


def characteristic(A: Any, s: Any) -> Any:
    return sympy.expand((s * sympy.eye(A.rows) - A).det(method="berkowitz"))


def response(A: Any, B: Any, C: Any, s: Any, D: Any = None) -> Any:
    """Return C (sI − A)⁻¹ B + D, of one input and one output a scalar."""
    pencil = s * sympy.eye(A.rows) - A
    found = C * pencil.adjugate() * B / pencil.det(method="berkowitz")
    return single((found if D is None else found + D).applyfunc(sympy.cancel))


def single(matrix: Any) -> Any:
    """Return the entry of a 1×1 matrix, any other matrix as it is."""
    return matrix[0] if matrix.shape == (1, 1) else matrix


def return_path(P: Any, F: Any) -> Any:
    """Return (I + P F)⁻¹ P: the plant with F in its return path, negative feedback."""
    P, F = (part if isinstance(part, sympy.MatrixBase) else sympy.Matrix([[part]]) for part in (P, F))
    return single((inverse(sympy.eye(P.rows) + P * F) * P).applyfunc(sympy.cancel))


def common_denominator(function: Any) -> Any:
    """Return the least common denominator of a rational function, or of the entries of a matrix of them."""
    entries = list(function) if isinstance(function, sympy.MatrixBase) else [function]
    return sympy.lcm_list([sympy.fraction(sympy.cancel(entry))[1] for entry in entries])


def companion(polynomial: Any, variable: sympy.Symbol) -> Any:
    """Return the matrix with ones above its diagonal whose last row makes this its characteristic polynomial."""
    ascending = sympy.Poly(polynomial, variable).monic().all_coeffs()[:0:-1]
    order = len(ascending)
    return sympy.Matrix(order, order, lambda i, j: -ascending[j] if i == order - 1 else int(j == i + 1))


#: What the free entries of G are in the comparison: a solution with letters in it is too large for SymPy.
FREE_ENTRIES = {f"g{k}": Rational(sympy.prime(k + 4), sympy.prime(k + 2)) for k in range(1, 17)}


def sylvester_letters(A: Any, B: Any, gain: Any, polynomial: Any, variable: sympy.Symbol, side: str) -> dict[str, Any]:
    """Return F, G, X of AX − XF = BG: in general, one row of G held at e₁ᵀ, others free; and of one gain K, where KX = G.

    A − BK = XFX⁻¹ leaves X free up to polynomials in F, which the row that is held fixes.
    """
    F, n = companion(polynomial, variable), A.rows
    held = sympy.eye(n)[0, :]
    G = held.col_join(sympy.Matrix(B.cols - 1, n, list(FREE_ENTRIES.values())[: n * (B.cols - 1)]))
    shifted = sympy.kronecker_product(sympy.eye(n), A) - sympy.kronecker_product(F.T, sympy.eye(n))
    X = sympy.Matrix(n, n, list(shifted.LUsolve((B * G).T.reshape(n * n, 1)))).T
    unknown = sympy.Matrix(n, n, sympy.symbols(f"x1:{n * n + 1}"))
    equations = [*((A - B * gain) * unknown - unknown * F), *((gain * unknown)[0, :] - held)]
    own = unknown.subs(sympy.solve(equations, list(unknown), dict=True)[0])
    assert not own.free_symbols
    found = {"F": F, "G": G, "X": X}
    return {f"{letter}_{side}": value for letter, value in found.items()} | {
        f"X_{side}1": own,
        f"G_{side}1": gain * own,
    }


def canonical_transformation(A: Any, test: Any, s: Any) -> Any:
    """Return the controllability matrix times the Hankel matrix of χ, constant coefficient excluded."""
    order = A.rows
    ascending = sympy.Poly(characteristic(A, s), s).all_coeffs()[::-1]
    hankel = sympy.Matrix(order, order, lambda i, j: ascending[i + j + 1] if i + j < order else 0)
    return test * hankel


def is_stable(polynomial: Any, variable: sympy.Symbol, *, discrete: bool) -> bool:
    """Whether all roots of a polynomial with numbers for coefficients are stable, by numeric roots."""
    roots = sympy.Poly(polynomial, variable).sqf_part().nroots(n=30, maxsteps=500)
    return all(abs(r) < 1 if discrete else sympy.re(r) < 0 for r in roots)


def compare(difference: Any, operator: str) -> bool:
    """Tell whether difference operator 0 holds for a number."""
    match operator:
        case "!=":
            return bool(difference != 0)
        case "<":
            return bool(difference < 0)
        case ">":
            return bool(difference > 0)
        case "<=":
            return bool(difference <= 0)
        case ">=":
            return bool(difference >= 0)
    raise AssertionError(operator)


def pencil(A: Any, C: Any, value: Any) -> Any:
    """Return [A − λI; C]."""
    return sympy.Matrix.vstack(A - value * sympy.eye(A.rows), C)


def modes(A: Any, C: Any) -> list[tuple[Any, int]]:
    """Return each eigenvalue of A with the rank of its pencil, with multiplicity."""
    found = A.eigenvals(multiple=True)
    return [(value, pencil(A, C, value).rank()) for value in found]


def fixed(A: Any, C: Any, s: Any) -> Any:
    """Return the characteristic polynomial of A on ker 𝒪, from its action on a basis."""
    kernel = observability_matrix(A, C).nullspace()
    if not kernel:
        return sympy.Integer(1)
    N = sympy.Matrix.hstack(*kernel)
    return characteristic((N.T * N).inv() * N.T * A * N, s)


# -- problems ----------------------------------------------------------------------------------------------------------

s, z = symbols("s z")
omega, b, p, q, h1, h2, k1, k2, c, d, theta = symbols("omega b p q h1 h2 k1 k2 c d theta")
M, m, l, g = symbols("M m l g")
a, k, m1, m2, R1, R2, C1, C2 = symbols("a k m1 m2 R1 R2 C1 C2")
omega_0, omega_c, zeta_c, gamma, mu1, mu2 = symbols("omega_0 omega_c zeta_c gamma mu1 mu2")
p1, p2, p3, p4, q1, q2, q3, q4 = symbols("p1:5 q1:5")


@dataclass(frozen=True)
class Advice:
    """Where poles are put by hand: the polynomials of the zeros used and of the rest; with a pair what was asked for."""

    zeros: Any
    rest: Any
    settling_time: Any = None
    overshoot: Any = None
    omega_d: Any = None


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
    sign: int = 1
    follows: bool = False
    functions: Mapping[str, Any] = field(default_factory=dict)
    shrunk: int = 1  # by what sample points are divided
    advice: Advice | None = None

    @property
    def discrete(self) -> bool:
        return bool(self.variable == z)

    def at(self, point: Mapping[Any, Any]) -> Self:
        """Return the problem at one point of its parameters."""
        names = ("A", "B", "C", "D", "control", "observer", "K", "L")
        given = {name: getattr(self, name) for name in names if getattr(self, name) is not None}
        return replace(self, large=False, **{name: value.subs(point) for name, value in given.items()})

    @property
    def is_several(self) -> bool:
        return max(1 if part is None else min(part.shape) for part in (self.B, self.C)) > 1

    @property
    def decisive(self) -> Any:
        """What must not vanish where parameters may make it vanish."""
        test = observability_matrix(self.A, self.C)
        return test.det() if test.is_square else sympy.Integer(1)

    # -- answers, found by textbook formulas ---------------------------------------------------------------------------

    @cached_property
    def feedthrough(self) -> Any:
        if self.D is not None:
            return self.D
        return sympy.zeros(1 if self.C is None else self.C.rows, 1 if self.B is None else self.B.cols)

    @cached_property
    def feedback_gain(self) -> Any:
        return ackermann(self.A.T, self.B.T, self.control, self.variable).T if self.K is None else self.K

    @cached_property
    def observer_gain(self) -> Any:
        return ackermann(self.A, self.C, self.observer, self.variable) if self.L is None else self.L

    @cached_property
    def plant_transfer(self) -> Any:
        return response(self.A, self.B, self.C, self.variable, self.feedthrough)

    @property
    def families(self) -> dict[str, Any] | None:
        """Return (A, B, polynomial) of each gain that is not unique, (Aᵀ, Cᵀ, φ) of L."""
        found = {"K": (self.A, self.B, self.control)} if self.B.cols > 1 else {}
        return (found | ({"L": (self.A.T, self.C.T, self.observer)} if self.C.rows > 1 else {})) or None

    @cached_property
    def compensator_matrix(self) -> Any:
        K, L = self.feedback_gain, self.observer_gain
        return self.A - self.B * K - L * self.C + L * self.feedthrough * K

    @cached_property
    def compensator(self) -> Any:
        return response(self.compensator_matrix, self.observer_gain, self.feedback_gain, self.variable)

    @cached_property
    def loop(self) -> Any:
        return return_path(self.plant_transfer, self.compensator)

    @cached_property
    def unity_loop(self) -> Any:
        if self.B.cols > 1 or self.C.rows > 1:
            return None
        through = self.plant_transfer * self.compensator
        return sympy.cancel(through / (1 + through))

    @cached_property
    def gain_at_rest(self) -> Any:
        """Return (C − DK)(−A + BK)⁻¹B + D."""
        K, D = self.feedback_gain, self.feedthrough
        return ((self.C - D * K) * (self.B * K - self.A).inv() * self.B + D).applyfunc(sympy.cancel)

    @cached_property
    def followed(self) -> Any:
        """Return v → y with F the inverse of the gain at rest."""
        K, D, F = self.feedback_gain, self.feedthrough, self.gain_at_rest.inv()[0]
        return sympy.cancel(F * (response(self.A - self.B * K, self.B, self.C - D * K, self.variable) + D[0]))

    @cached_property
    def loop_matrix(self) -> Any:
        BK = self.B * self.feedback_gain
        if self.observer is None and self.L is None:
            return self.A - BK
        LC = self.observer_gain * self.C
        return Matrix([[self.A - BK, BK], [sympy.zeros(*self.A.shape), self.A - LC]])

    @cached_property
    def loop_matrix_estimate(self) -> Any:
        BK, LC = self.B * self.feedback_gain, self.observer_gain * self.C
        return Matrix([[self.A, -BK], [LC, self.A - BK - LC]])


def canonical(numerator: Any, denominator: Any) -> dict[str, Any]:
    """Return the controllable canonical form of a strictly proper function with a monic denominator."""
    above, below = (sympy.Poly(sympy.expand(part), s).all_coeffs() for part in (numerator, denominator))
    order = len(below) - 1
    A = sympy.zeros(order, order)
    A[:-1, 1:] = sympy.eye(order - 1)
    A[-1, :] = sympy.Matrix([[-c for c in reversed(below[1:])]])
    ascending = [*reversed(above), *([0] * (order - len(above)))]
    return {"A": A, "B": sympy.eye(order)[:, -1], "C": sympy.Matrix([ascending])}


third_order = {"A": Matrix([[-7, 1, 15], [-2, 0, 5], [-2, 0, 4]]), "B": Matrix([65, -5, 30]), "C": Matrix([[1, 0, -2]])}
servo = {"A": Matrix([[0, 1], [0, -1]]), "B": Matrix([0, 1]), "C": Matrix([[1, 0]])}
mass = {"A": Matrix([[0, 1], [0, 0]]), "B": Matrix([0, 1]), "C": Matrix([[1, 0]])}
hanging = {"A": Matrix([[0, 1], [-(omega**2), -b]]), "B": Matrix([0, 1]), "C": Matrix([[0, 1]])}
upright = {"A": Matrix([[0, 1], [omega**2, -b]]), "B": Matrix([0, 1]), "C": Matrix([[0, 1]])}
tanks = {
    "A": Matrix([[-4, 1], [4, -4]]) / 100,
    "B": Matrix([1, 0]),
    "C": Matrix([[0, 1]]),
}
cart = {
    "A": Matrix([[0, 0, 0, 1], [0, 0, 1, 0], [0, Rational(539, 50), 0, 0], [0, -Rational(49, 50), 0, 0]]),
    "B": Matrix([0, 0, -1, 1]),
}
pendulum = {"omega": "positive", "b": "positive"}
hidden = {"A": Matrix([[0, 1], [-2, -3]]), "C": Matrix([[1, c]]), "signs": {"c": "real"}}
cart_pole = {
    "A": Matrix([[0, 1, 0, 0], [0, -b / M, -m * g / M, 0], [0, 0, 0, 1], [0, b / (M * l), (M + m) * g / (M * l), 0]]),
    "B": Matrix([0, 1 / M, 0, -1 / (M * l)]),
    "C": Matrix([[1, 0, 0, 0]]),
    "signs": dict.fromkeys(["M", "m", "l", "g", "b", *(f"{x}{k}" for x in "pq" for k in range(1, 5))], "positive"),
}

PROBLEMS = {
    "servo_observer": Hand(**servo, observer=(s + 10) ** 2),
    "servo_optimal_gains": Hand(**servo, control=(s + 1) ** 2, observer=(s + 2) ** 2),
    "servo_with_irrational_poles": Hand(
        Matrix([[0, 1, 0], [0, 0, 1], [0, -2, -3]]), B=Matrix([0, 0, 1]), control=((s + 2) ** 2 + 12) * (s + 10)
    ),
    "coupled_masses_irrational": Hand(
        Matrix([[0, 1, 0, 0], [-1, 0, 0, 0], [0, 0, 0, 1], [0, 0, -3, 0]]),
        Matrix([[1, 0, 1 / sympy.sqrt(3), 0]]),
        observer=(s**2 + sympy.sqrt(3) * s + 1) * (s**2 + 2 * sympy.sqrt(3) * s + 3),
    ),
    "sensor_at_a_node": Hand(Matrix([[0, 1], [2, 0]]), Matrix([[sympy.sqrt(2) * k, 1]]), signs={"k": "positive"}),
    "output_feedback_servo": Hand(**servo, control=(s + 2) ** 2, observer=(s + 10) ** 2),
    "servo_feedthrough": Hand(**servo, D=Matrix([[1]]), control=(s + 2) ** 2, observer=(s + 10) ** 2),
    "servo_feedthrough_parametric": Hand(
        **servo, D=Matrix([[d]]), control=(s + 2) ** 2, observer=(s + 10) ** 2, signs={"d": "real"}
    ),
    "double_integrator_observer": Hand(**mass, observer=(s + 1) * (s + 2)),
    "double_integrator_output_feedback": Hand(**mass, control=s**2 + 2 * s + 2, observer=(s + 1) * (s + 2)),
    "servo_companion_form": Hand(**servo, observer=(s + 1) * (s + 2)),
    "pendulum_output_feedback": Hand(
        **hanging,
        control=s**2 + (b - k2) * s + omega**2 - k1,
        observer=s**2 + (b + h2) * s + omega**2 * (1 - h1),
        signs=pendulum | dict.fromkeys(["k1", "k2", "h1", "h2"], "real"),
    ),
    "third_order_observer": Hand(**third_order, observer=(s + 5) * (s + 6) * (s + 7)),
    "third_order_plant": Hand(**third_order, control=(s + 3) * (s + 4) * (s + 5)),
    "pendulum_hanging": Hand(**hanging, observer=s**2 + p * s + q, signs=pendulum | {"p": "real", "q": "real"}),
    "pendulum_hanging_given_gain": Hand(**hanging, L=Matrix([h1, h2]), signs=pendulum | {"h1": "real", "h2": "real"}),
    "pendulum_upright": Hand(**upright, observer=s**2 + p * s + q, signs=pendulum | {"p": "real", "q": "real"}),
    "pendulum_upright_given_gain": Hand(**upright, L=Matrix([h1, h2]), signs=pendulum | {"h1": "real", "h2": "real"}),
    "pendulum_linearised": Hand(
        Matrix([[0, 1], [g / l, -b]]),
        Matrix([[1, 0]]),
        Matrix([0, 1]),
        observer=(s + 3) * (s + 4),
        signs=dict.fromkeys("bgl", "positive"),
        functions={
            "f_x": Matrix([omega, -g / l * sympy.sin(theta) - b * omega + symbols("u")]),
            "h_x": Matrix([theta]),
        },
    ),
    "pendulum_state_feedback": Hand(
        A=hanging["A"], B=hanging["B"], K=Matrix([[-k1, -k2]]), signs=pendulum | {"k1": "real", "k2": "real"}
    ),
    "third_order_row_reduction": Hand(**third_order, observer=(s + 5) * (s + 6) * (s + 7)),
    "third_order_pole_kept": Hand(**third_order, observer=(s + 1) * (s + 6) * (s + 7)),
    "third_order_double_pole": Hand(**third_order, observer=(s + 5) ** 2 * (s + 1)),
    "third_order_complex_pair": Hand(A=third_order["A"], B=third_order["B"], control=(s**2 + 4 * s + 5) * (s + 1)),
    "third_order_matching": Hand(**third_order, observer=(s + 5) * (s + 6) * (s + 7)),
    "third_order_at_zeros": Hand(
        **third_order, observer=(s + 2) * (s + 3) * (s + omega_0), signs={"omega_0": "positive"}
    ),
    "third_order_at_zeros_and_ten": Hand(**third_order, observer=(s + 2) * (s + 3) * (s + 10)),
    "third_order_pole_advice": Hand(
        **third_order, advice=Advice((s + 2) * (s + 3), s + omega_0), signs={"omega_0": "positive"}
    ),
    "butterworth_pole_advice": Hand(
        **canonical(s + 2, s * (s + 1) * (s + 4)),
        advice=Advice(s + 2, s**2 + sympy.sqrt(2) * omega_0 * s + omega_0**2),
        signs={"omega_0": "positive"},
    ),
    "four_on_a_circle_pole_advice": Hand(
        **canonical(s - 1, s**4),
        advice=Advice(
            sympy.Integer(1),
            (s**2 + 2 * sympy.sin(sympy.pi / 8).rewrite(sympy.sqrt) * omega_0 * s + omega_0**2)
            * (s**2 + 2 * sympy.cos(sympy.pi / 8).rewrite(sympy.sqrt) * omega_0 * s + omega_0**2),
        ),
        signs={"omega_0": "positive"},
    ),
    "dominant_pair_pole_advice": Hand(
        **canonical((s + 1) * (s + 10), s**2 * (s**2 + 4) * (s + 3)),
        advice=Advice(
            s + 10,
            ((s + 2) ** 2 + Rational(52, 25) ** 2) * (s + 10) * (s + 12),
            settling_time=sympy.Integer(2),
            overshoot=Rational(1, 20),
            omega_d=2 * sympy.floor(100 * sympy.pi / sympy.log(20)) / 100,
        ),
    ),
    "double_integrator_companion": Hand(**mass, observer=(s + 1) * (s + 2)),
    "double_integrator_pole_placement": Hand(
        **mass,
        control=(s + mu1) * (s + mu2),
        observer=(s + mu1) * (s + mu2),
        signs={"mu1": "positive", "mu2": "positive"},
    ),
    "tanks_observer": Hand(**tanks, observer=(s + Rational(1, 5)) ** 2),
    "tanks_observer_parametric": Hand(
        **tanks, observer=(s + p1) * (s + p2), signs={"p1": "positive", "p2": "positive"}
    ),
    "cart_pendulum_unmeasured_part": Hand(
        A=cart["A"][1:, 1:],
        B=cart["B"][1:, :],
        C=Matrix([[0, 0, 1]]),
        observer=s**3 + 60 * s**2 + 1600 * s + 16000,
    ),
    "cart_pendulum_feedback": Hand(**cart, control=(s + 1) * (s + 2) * (s + 3) * (s + 4)),
    "servo_feedforward": Hand(**servo, control=(s + 2) ** 2, observer=(s + 10) ** 2, follows=True),
    "vehicle_steering_feedforward": Hand(
        A=Matrix([[0, 1], [0, 0]]),
        B=Matrix([gamma, 1]),
        C=Matrix([[1, 0]]),
        control=s**2 + 2 * zeta_c * omega_c * s + omega_c**2,
        signs={"gamma": "positive", "omega_c": "positive", "zeta_c": "positive"},
        follows=True,
    ),
    "third_order_feedforward": Hand(
        **third_order,
        control=(s + 3) * (s + 4) * (s + 5),
        observer=(s + 5) * (s + 6) * (s + 7),
        follows=True,
    ),
    "servo_observer_feedthrough": Hand(**servo, D=Matrix([[d]]), observer=(s + 10) ** 2, signs={"d": "real"}),
    "pendulum_observer_existence": Hand(
        **hanging, observer=s**2 + p * s + q, signs=pendulum | {"p": "real", "q": "real"}
    ),
    "dual_servo": Hand(**servo),
    "dual_reversed": Hand(**hanging, signs=pendulum, sign=-1),
    "eigenvalue_test_servo": Hand(A=servo["A"], C=servo["C"]),
    "eigenvalue_test_third_order": Hand(A=Matrix([[0, -1, 0], [1, 0, 1], [0, 0, 0]]), C=Matrix([[1, 0, 0]])),
    "detectable": Hand(A=sympy.diag(-1, 1), C=Matrix([[0, 1]])),
    "not_detectable": Hand(A=sympy.diag(1, -1), C=Matrix([[0, 1]])),
    "boundary_mode": Hand(A=Matrix([[0, 1], [0, -b]]), C=Matrix([[0, 1]]), signs={"b": "positive"}),
    "boundary_mode_lyapunov": Hand(A=Matrix([[0, 1], [0, -b]]), C=Matrix([[0, 1]]), signs={"b": "positive"}),
    "canonical_form_servo": Hand(**servo),
    "four_parts": Hand(
        A=Matrix([[-2, 0, 1, 1], [3, -2, -2, 1], [2, 0, -3, 1], [-1, 0, 1, -3]]),
        B=Matrix([1, 0, 1, 0]),
        C=Matrix([[0, 0, 1, 1]]),
    ),
    "fixed_mode_wanted": Hand(**hidden, observer=(s + 1) * (s + 5)),
    "fixed_modes_all_wanted": Hand(**hidden, observer=(s + 1) * (s + 2)),
    "deadbeat_observer": Hand(A=Matrix([[1, 1], [0, 1]]), C=Matrix([[1, 0]]), observer=z**2, variable=z),
    "bridge_circuit": Hand(
        A=sympy.diag(-1 / (R1 * C1), -1 / (R2 * C2)),
        C=Matrix([[1, -1]]),
        signs=dict.fromkeys(["R1", "R2", "C1", "C2"], "positive"),
    ),
    "two_masses_sum_measured": Hand(
        A=Matrix([[0, 1, 0, 0], [-(k1 + k) / m1, 0, k / m1, 0], [0, 0, 0, 1], [k / m2, 0, -(k2 + k) / m2, 0]]),
        C=Matrix([[1, 0, 1, 0]]),
        signs=dict.fromkeys(["m1", "m2", "k1", "k2"], "positive") | {"k": "nonnegative"},
    ),
    "pendulum_angle_and_rate_combined": Hand(
        A=hanging["A"], C=Matrix([[a, c]]), signs=pendulum | {"a": "real", "c": "real"}
    ),
    "three_modes_one_sum": Hand(
        A=sympy.diag(a, b, c), C=Matrix([[1, 1, 1]]), signs={"a": "real", "b": "real", "c": "real"}
    ),
    "cart_pole": Hand(
        **cart_pole,
        control=(s + p1) * (s + p2) * (s + p3) * (s + p4),
        observer=(s + q1) * (s + q2) * (s + q3) * (s + q4),
        large=True,
    ),
}


#: Examples with several outputs or inputs, whose gains are not unique: `test_gain_families` holds them to the claim itself.
FAMILIES = {
    "two_masses_parametric",
    "triple_pole_two_outputs",
    "two_masses_zeros",
    "hidden_state_two_outputs",
    "two_inputs_feedback",
}


def points(name: str, hand: Hand, count: int) -> Iterator[dict[Any, Any]]:
    """Yield points that the declared signs allow and that lose no observability, the same in every run."""
    chance = random.Random(name)  # noqa: S311 - points that repeat
    for _ in range(count if hand.signs else 1):
        point = {}
        for parameter, sign in hand.signs.items():
            size = Rational(chance.randint(1, 40), chance.randint(1, 9) * hand.shrunk)
            point[sympy.Symbol(parameter)] = (
                size if sign in {"positive", "nonnegative"} or chance.random() < 0.5 else -size
            )
        if point.get(c) not in {Rational(1, 2), 1}:
            yield point
