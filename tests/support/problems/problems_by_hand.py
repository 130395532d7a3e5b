"""The worked examples written out a second time, by hand, with their answers by textbook formulas in plain SymPy.

Nothing in this file asks symobs for anything.
"""

from __future__ import annotations

import random
from dataclasses import dataclass, field, replace
from functools import cache, cached_property
from typing import TYPE_CHECKING, Any

import sympy
from sympy import Matrix, Rational, symbols

from tests.support.problems.second_reading import FOLDER, given, tasks_of

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping
    from typing import Self

# -- linear algebra ----------------------------------------------------------------------------------------------------


def is_zero(expression: Any) -> bool:
    """Whether a rational expression is 0."""
    return bool(sympy.expand(sympy.together(expression).as_numer_denom()[0]) == 0)


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

    @classmethod
    def read(cls, name: str, **own: Any) -> Self:
        """Return the problem of a worked example; what its file does not say is given."""
        found = given(name)
        tasks, wanted = found["tasks"], found.get("poles")
        found |= {"follows": "feedforward" in tasks, "large": name == "cart_pole"}
        found |= (
            {"control" if {"state_feedback", "integral_action"} & {*tasks} else "observer": wanted}
            if wanted is not None
            else {}
        )
        for gain, polynomial in (("K", "control"), ("L", "observer")):
            if polynomial in own:
                found.pop(gain, None)
        return cls(**{key: value for key, value in found.items() if key in cls.__dataclass_fields__} | own)

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


def entries(stem: str, gain: Any) -> dict[str, Any]:
    return {f"{stem}_{k}": value for k, value in enumerate(gain, 1)}


@dataclass(frozen=True, kw_only=True)
class MinimalOrder(Hand):
    """An observer of order n − p in the coordinates T = [C; R], and with control poles the compensator with it.

    `observer` has degree n − p.  With `is_open` the page makes the estimate of z and of open matrices F, G, H.
    """

    is_open: bool = False

    @cached_property
    def R(self) -> Any:
        """Unit rows for the states beside the pivots of C."""
        pivots = self.C.rref()[1]
        return sympy.eye(self.A.rows).extract(
            [k for k in range(self.A.rows) if k not in pivots], list(range(self.A.rows))
        )

    @cached_property
    def T(self) -> Any:
        return self.C.col_join(self.R)

    @cached_property
    def blocks(self) -> dict[str, Any]:
        """Return the blocks of T A T⁻¹ and T B."""
        k, A = self.C.rows, self.T * self.A * self.T.inv()
        found = {"A_11": A[:k, :k], "A_12": A[:k, k:], "A_21": A[k:, :k], "A_22": A[k:, k:]}
        if self.B is not None:
            B = self.T * self.B
            found |= {"B_1": B[:k, :], "B_2": B[k:, :]}
        return found

    # -- the observer --------------------------------------------------------------------------------------------------

    @cached_property
    def observer_gain(self) -> Any:
        parts = self.blocks
        return ackermann(parts["A_22"], parts["A_12"], self.observer, self.variable) if self.L is None else self.L

    @cached_property
    def F(self) -> Any:
        return self.blocks["A_22"] - self.observer_gain * self.blocks["A_12"]

    @cached_property
    def H(self) -> Any:
        return self.F * self.observer_gain + self.blocks["A_21"] - self.observer_gain * self.blocks["A_11"]

    @cached_property
    def G(self) -> Any:
        """B₂ − L B₁, less what y − D u takes with it."""
        if self.B is None:
            return None
        return self.blocks["B_2"] - self.observer_gain * self.blocks["B_1"] - self.H * self.feedthrough

    @cached_property
    def M(self) -> Any:
        L = self.observer_gain
        lift = Matrix([[sympy.eye(L.cols), sympy.zeros(L.cols, L.rows)], [L, sympy.eye(L.rows)]])
        return self.T.inv() * lift

    # -- the compensator -----------------------------------------------------------------------------------------------

    @cached_property
    def parts_of_gain(self) -> tuple[Any, Any]:
        """Return K₁ and K₂."""
        moved = self.feedback_gain * self.T.inv()
        return moved[:, : self.C.rows], moved[:, self.C.rows :]

    @cached_property
    def N(self) -> Any:
        K_1, K_2 = self.parts_of_gain
        return K_1 + K_2 * self.observer_gain

    @cached_property
    def unsolved(self) -> Any:
        """I − N D, which the input is multiplied by in the control law."""
        return sympy.eye(self.B.cols) - self.N * self.feedthrough

    @cached_property
    def W(self) -> Any:
        return inverse(self.unsolved)

    @cached_property
    def compensator_matrix(self) -> Any:
        return self.F - self.G * self.W * self.parts_of_gain[1]

    @cached_property
    def compensator_input(self) -> Any:
        return self.H - self.G * self.W * self.N

    @cached_property
    def compensator(self) -> Any:
        state, direct = self.W * self.parts_of_gain[1], self.W * self.N
        return response(self.compensator_matrix, self.compensator_input, state, self.variable, direct)

    @cached_property
    def loop(self) -> Any:
        return return_path(self.plant_transfer, self.compensator)

    @cached_property
    def loop_matrix(self) -> Any:
        """(x, e₂), from u = −K x + K₂ e₂."""
        B, K, K_2 = self.B, self.feedback_gain, self.parts_of_gain[1]
        return Matrix([[self.A - B * K, B * K_2], [sympy.zeros(self.F.rows, self.A.rows), self.F]])

    @cached_property
    def loop_matrix_estimate(self) -> Any:
        """(x, z), from u = −N C x − K₂ z, put into ẋ = A x + B u and ż = F z + G u + H (C x + D u)."""
        A, B, C, D, K_2 = self.A, self.B, self.C, self.feedthrough, self.parts_of_gain[1]
        u_x, u_z, driven = -self.N * C, -K_2, self.G + self.H * D
        return Matrix([[A + B * u_x, B * u_z], [self.H * C + driven * u_x, self.F + driven * u_z]])

    @property
    def families(self) -> dict[str, Any] | None:
        """Return (A, B, polynomial) of each gain that is not unique, (A₂₂ᵀ, A₁₂ᵀ, φ) of L."""
        found = {"K": (self.A, self.B, self.control)} if self.B.cols > 1 else {}
        pair = (self.blocks["A_22"].T, self.blocks["A_12"].T, self.observer)
        return (found | ({"L": pair} if self.C.rows > 1 else {})) or None

    # -- what is compared ----------------------------------------------------------------------------------------------

    @property
    def decisive(self) -> Any:
        """What must not vanish."""
        found = super().decisive
        return found if self.control is None else found * self.unsolved.det()

    def letters(self) -> dict[str, Any]:
        """Return what the letters of a page must be worth."""
        A, B, C, R, L, parts = self.A, self.B, self.C, self.R, self.observer_gain, self.blocks
        one, size = sympy.eye(L.rows), L.cols
        known = {"A": A, "C": C, "D": self.feedthrough, "chi": characteristic(A, self.variable)}
        known |= {"O": observability_matrix(A, C), "R": R, "T": self.T, "L": L, "phi_o": self.observer, **parts}
        known |= {"F_z": self.F, "H_z": self.H, "M_z": self.M, "x_1": {"x": C}, "x_2": {"x": R}, **entries("l", L)}
        known |= {"e_2": {"x": R, "x_2_hat": -one}, "z_o": {"x_2_hat": one, "x": -L * C}}
        known["x_hat"] = {"x": self.M[:, :size] * C - self.M[:, size:] * L * C, "x_2_hat": self.M[:, size:]}
        # x̂₂' = A₂₁x₁ + A₂₂x̂₂ + B₂u + L(ẋ₁ − A₁₁x₁ − B₁u − A₁₂x̂₂), with ẋ₁ = C(Ax + Bu) and so ẋ₁ − B₁u = CAx
        known["x_2_hat'"] = {"x": parts["A_21"] * C + L * (C * A - parts["A_11"] * C), "x_2_hat": self.F}
        known |= {"x'": {"x": A}, "y": {"x": C}}
        if B is None:
            return known
        known |= {"B": B, "G_z": self.G, "x'": {"x": A, "u": B}, "P": self.plant_transfer}
        known["x_2_hat'"]["u"] = parts["B_2"]
        known["y"]["u"] = self.feedthrough
        if self.is_open:
            known |= self.letters_of_open_matrices()
        return known if self.control is None else known | self.letters_of_compensator()

    def letters_of_open_matrices(self) -> dict[str, Any]:
        """x̂₂ = z + L x₁ and ż = F z + G u + H y, the entries of F, G, H still letters; no feedthrough."""
        L, C, (first, second) = self.observer_gain, self.C, (slice(None, self.C.rows), slice(self.C.rows, None))
        one = sympy.eye(L.rows)
        known: dict[str, Any] = {"x_2_hat": {"z_o": one, "x": L * C}, "e_2": {"x": self.R - L * C, "z_o": -one}}
        known["z_o'"] = {"z_o": self.F, "u": self.G, "x": self.H * C}
        known["x_hat"] = {"x": self.M[:, first] * C, "z_o": self.M[:, second]}
        return known | entries("f", self.F) | entries("g", self.G) | entries("h", self.H)

    def letters_of_compensator(self) -> dict[str, Any]:
        K, (K_1, K_2), phi = self.feedback_gain, self.parts_of_gain, self.control
        known = {"K": K, "phi_c": phi, "Ctr": observability_matrix(self.A.T, self.B.T).T, "K_1": K_1, "K_2": K_2}
        known |= {"u": {"x": -K_1 * self.C, "x_2_hat": -K_2}, "K_y": self.N, "W_u": single(self.W)}
        known |= {"A_c": self.compensator_matrix, "B_c": self.compensator_input, "F": self.compensator}
        known |= {"A_cl": self.loop_matrix, "G_cl": self.loop, "G_r": self.unity_loop}
        if self.B.cols > 1:
            known |= sylvester_letters(self.A, self.B, K, phi, self.variable, "c")
        else:
            known["V_c"] = canonical_transformation(self.A, known["Ctr"], self.variable)
        return known

    def answers(self, task: str) -> dict[str, Any]:
        """Return every field of a task's answer by the textbook's formula."""
        if task == "reduced_order_observer":
            polynomial = characteristic(self.F, self.variable)
            own = {"L": self.observer_gain, "T": self.T, "F": self.F, "G": self.G, "H": self.H, "M": self.M}
            return own | {"polynomial": polynomial, "poles": polynomial, "fixed_modes": (), "family": None}
        assert task == "compensator"
        return {
            "K": self.feedback_gain,
            "L": self.observer_gain,
            "F": self.compensator,
            "T": self.T,
            "direct_term": self.W * self.N,
            "compensator_matrix": self.compensator_matrix,
            "closed_loop": self.loop,
            "closed_loop_unity": self.unity_loop,
            "closed_loop_polynomial": characteristic(self.loop_matrix, self.variable),
            "closed_loop_matrix": self.loop_matrix,
            "closed_loop_matrix_estimate": self.loop_matrix_estimate,
            "family": self.families,
        }


@dataclass(frozen=True, kw_only=True)
class Tracking(MinimalOrder):
    """u = K (x_d − x̂) − K_d x_d for ẋ_d = A_d x_d; `passed` is what one trajectory passes through."""

    reference: Any
    passed: Any = None
    row: Any = None

    @cached_property
    def K_d(self) -> Any:
        """B⁺ (A − A_d), None where that does not solve B K_d = A − A_d; 0 where A and A_d agree on the trajectory."""
        if self.passed is not None:
            assert (self.A - self.reference) * self.passed == sympy.zeros(*self.passed.shape)
            return sympy.zeros(self.B.cols, self.A.rows)
        found = (self.B.T * self.B).inv() * self.B.T * (self.A - self.reference)
        return found if self.B * found == self.A - self.reference else None

    @cached_property
    def errors(self) -> Any:
        """[A − BK, −BK₂; 0, F]."""
        B, K_2 = self.B, self.parts_of_gain[1]
        return Matrix([[self.A - B * self.feedback_gain, -B * K_2], [sympy.zeros(self.F.rows, self.A.rows), self.F]])

    def letters(self) -> dict[str, Any]:
        known = super().letters()
        one, (K_1, K_2) = sympy.eye(self.A.rows), self.parts_of_gain
        known |= {"A_ref": self.reference, "x_d'": {"x_d": self.reference}, "A_e": self.errors, "K_d": self.K_d}
        known |= {"e_d": {"x_d": one, "x": -one}, "V_d": self.passed, "w_d": self.row}
        known["x_d0"] = None if self.passed is None else self.passed[:, 0]
        if self.K_d is not None:
            known["u"] = {"x_d": self.feedback_gain - self.K_d, "x": -K_1 * self.C, "x_2_hat": -K_2}
        return {name: value for name, value in known.items() if value is not None}

    def answers(self, task: str) -> dict[str, Any]:
        """Return every field of the answer."""
        assert task == "tracking"
        return {
            "K": self.feedback_gain,
            "L": self.observer_gain,
            "K_d": self.K_d,
            "solvable": self.K_d is not None,
            "error_matrix": self.errors,
            "polynomial": characteristic(self.errors, self.variable),
        }


@dataclass(frozen=True)
class Integral(Hand):
    """u = −K x + k_I ξ with ξ' = r − y, for plants without feedthrough."""

    @cached_property
    def extended(self) -> tuple[Any, Any]:
        """Return [A 0; −C 0] and [B; 0]."""
        A, B, C = self.A, self.B, self.C
        n, p = A.rows, C.rows
        wide = sympy.BlockMatrix([[A, sympy.zeros(n, p)], [-C, sympy.zeros(p, p)]]).as_explicit()
        return wide, B.col_join(sympy.zeros(p, B.cols))

    @property
    def decisive(self) -> Any:
        """det [A B; C D], which is what must not vanish where that is square and (A, B) is controllable elsewhere."""
        return self.whole.det()

    @cached_property
    def whole(self) -> Any:
        """[A B; C D]."""
        return sympy.BlockMatrix([[self.A, self.B], [self.C, self.feedthrough]]).as_explicit()

    @cached_property
    def gains(self) -> tuple[Any, Any]:
        """Return K and k_I."""
        A_hat, B_hat = self.extended
        both = ackermann(A_hat.T, B_hat.T, self.control, self.variable).T
        return both[:, : self.A.rows], -both[:, self.A.rows :]

    @cached_property
    def closed(self) -> Any:
        """Return [A − BK, B k_I; −C, 0]."""
        A_hat, B_hat = self.extended
        K, k_I = self.gains
        return A_hat - B_hat * K.row_join(-k_I)

    def letters(self) -> dict[str, Any]:
        """Return what the letters of the page must be worth."""
        A_hat, B_hat = self.extended
        known = {"A": self.A, "B": self.B, "C": self.C, "D": self.feedthrough, "phi_c": self.control}
        known |= {"A_hat": A_hat, "B_hat": B_hat, "x'": {"x": self.A, "u": self.B}, "y": {"x": self.C}}
        known["xi_I'"] = {"r_in": sympy.eye(self.C.rows), "x": -self.C}
        if observability_matrix(A_hat.T, B_hat.T).det() == 0:
            return known
        K, k_I = self.gains
        return known | {"K": K, "k_I": k_I, "A_cl": self.closed, "u": {"x": -K, "xi_I": k_I}}

    def answers(self, task: str) -> dict[str, Any]:
        """Return every field of the answer."""
        assert task == "integral_action"
        K, k_I = self.gains
        found = characteristic(self.closed, self.variable)
        lost = sympy.factor_list(self.decisive)[1]
        return {
            "K": K,
            "k_I": k_I,
            "solvable": self.whole.rank() == self.A.rows + self.C.rows,
            "solvable_if": tuple(f"{factor} != 0" for factor, _ in lost),
            "polynomial": found,
            "poles": found,
            "closed_loop_matrix": self.closed,
            "fixed_modes": (),
            "family": None,
        }


@dataclass(frozen=True)
class Disturbed(Hand):
    """ẋ = A x + B u + E d without feedthrough, and the observer ż = F z + T B u + (L + F H) y, x̂ = z + H y."""

    E: Any = None

    def at(self, point: Mapping[Any, Any]) -> Self:
        """Return the problem at one point of its parameters."""
        return replace(super().at(point), E=self.E.subs(point))

    @property
    def decisive(self) -> Any:
        """Nothing: C E vanishes nowhere, or everywhere."""
        return sympy.Integer(1)

    @cached_property
    def H(self) -> Any:
        """E (CE)⁺, None where rank C E < rank E."""
        seen = self.C * self.E
        return self.E * inverse(seen.T * seen) * seen.T if seen.rank() == self.E.rank() else None

    def matrices(self) -> dict[str, Any]:
        """Return T, T A, F, and what multiplies y, where L places the poles."""
        T = sympy.eye(self.A.rows) - self.H * self.C
        F = T * self.A - self.L * self.C
        assert is_zero(characteristic(F, self.variable) - self.observer)
        found = {"T": T, "A_T": T * self.A, "F": F, "B_y": self.L + F * self.H}
        return {name: value.applyfunc(sympy.cancel) for name, value in found.items()}

    def letters(self) -> dict[str, Any]:
        """Return what the letters of the page must be worth."""
        rates = {"x": self.A, "d": self.E} | ({} if self.B is None else {"u": self.B})
        known = {"A": self.A, "C": self.C, "E_d": self.E, "phi_o": sympy.expand(self.observer), "x'": rates}
        known |= {"y": {"x": self.C}} | ({} if self.B is None else {"B": self.B, "D": self.feedthrough})
        if self.H is None:
            return known
        m, one = self.matrices(), sympy.eye(self.A.rows)
        known |= {"H_d": self.H, "T_d": m["T"], "A_T": m["A_T"], "F_d": m["F"], "L": self.L, "L_y": m["B_y"]}
        known["z_o'"] = {"z_o": m["F"], "x": m["B_y"] * self.C} | ({} if self.B is None else {"u": m["T"] * self.B})
        known["x_hat"] = {"z_o": one, "x": self.H * self.C}
        return known | {"e": {"x": m["T"], "z_o": -one}}

    def answers(self, task: str) -> dict[str, Any]:
        """Return every field of the answer."""
        assert task == "unknown_input_observer"
        found: dict[str, Any] = dict.fromkeys(("H", "T", "L", "F", "B_u", "B_y"))
        found |= {"solvable": self.H is not None, "polynomial": sympy.expand(self.observer)}
        if self.H is None:
            return found
        m = self.matrices()
        zeros = sympy.roots(fixed(m["A_T"], self.C, self.variable), self.variable, multiple=True)
        found |= {"H": self.H, "L": self.L, "B_u": None if self.B is None else m["T"] * self.B}
        return found | {n: m[n] for n in ("T", "F", "B_y")} | {"poles": self.observer, "fixed_modes": tuple(zeros)}


@dataclass(frozen=True)
class Modelled(Hand):
    """ẋ = A x + B u + E d, d = V w, ẇ = S w for one output, without feedthrough."""

    E: Any = None
    S: Any = field(default_factory=lambda: Matrix([[0]]))

    def at(self, point: Mapping[Any, Any]) -> Self:
        """Return the problem at one point of its parameters."""
        return replace(super().at(point), E=self.E.subs(point), S=self.S.subs(point))

    @property
    def decisive(self) -> Any:
        """The determinant of the observability matrix of plant and exosystem."""
        A, C, _ = self.extended
        return observability_matrix(A, C).det()

    @cached_property
    def extended(self) -> tuple[Any, Any, Any]:
        """Return [A EV; 0 S], [C 0] and V."""
        V = sympy.eye(self.S.rows)[: self.E.cols, :]
        A = self.A.row_join(self.E * V).col_join(sympy.zeros(self.S.rows, self.A.rows).row_join(self.S))
        return A, self.C.row_join(sympy.zeros(self.C.rows, self.S.rows)), V

    @cached_property
    def gain(self) -> Any:
        """The gain of Ackermann's formula; None where plant and exosystem are not observable."""
        A, C, _ = self.extended
        return None if self.decisive == 0 else ackermann(A, C, self.observer, self.variable)

    def letters(self) -> dict[str, Any]:
        """Return what the letters of the page must be worth."""
        (A, C, V), n, order = self.extended, self.A.rows, self.S.rows
        known = {"A": self.A, "C": self.C, "E_d": self.E, "S_w": self.S, "V_w": V, "A_hat": A, "C_hat": C}
        known |= {"phi_o": sympy.expand(self.observer), "y": {"x": self.C}, "d": {"w_e": V}, "w_e'": {"w_e": self.S}}
        driven = {} if self.B is None else {"u": self.B}
        known["x'"] = {"x": self.A, "d": self.E} | driven
        if self.B is not None:
            known |= {"B": self.B, "D": self.feedthrough}
            known["B_hat"] = self.B.col_join(sympy.zeros(order, self.B.cols))
        if self.gain is None:
            return known
        L_x, L_w = self.gain[:n, :], self.gain[n:, :]
        known |= {"L": self.gain, "L_x": L_x, "L_w": L_w, "d_hat": {"w_hat": V}}
        known["x_hat'"] = {"x_hat": self.A - L_x * self.C, "w_hat": self.E * V, "x": L_x * self.C} | driven
        known["w_hat'"] = {"w_hat": self.S, "x_hat": -L_w * self.C, "x": L_w * self.C}
        known["e"] = {"x": sympy.eye(n), "x_hat": -sympy.eye(n)}
        return known | {"e_w": {"w_e": sympy.eye(order), "w_hat": -sympy.eye(order)}}

    def answers(self, task: str) -> dict[str, Any]:
        """Return every field of the answer."""
        assert task == "disturbance_observer"
        A, C, _ = self.extended
        zeros = sympy.roots(fixed(A, C, self.variable), self.variable, multiple=True)
        found = dict.fromkeys(("L_x", "L_w", "A", "B_u", "B_y", "family")) | {"fixed_modes": tuple(zeros)}
        found |= {"polynomial": sympy.expand(self.observer), "poles": self.observer}
        if self.gain is None:
            return found
        n = self.A.rows
        driven = None if self.B is None else self.B.col_join(sympy.zeros(self.S.rows, self.B.cols))
        own = {"L_x": self.gain[:n, :], "L_w": self.gain[n:, :], "A": A - self.gain * C}
        return found | own | {"B_u": driven, "B_y": self.gain}


# -- the worked examples -----------------------------------------------------------------------------------------------

#: Examples with several outputs or inputs, whose gains are not unique: `test_gain_families` holds them to the claim itself.
FAMILIES = {
    "two_masses_parametric",
    "triple_pole_two_outputs",
    "two_masses_zeros",
    "hidden_state_two_outputs",
    "two_inputs_feedback",
}
IN_TIME = {"matrix_exponential", "gramian", "response", "zero_order_hold", "initial_state", "initial_state_covariance"}
TASKS = {path.stem: tasks_of(path.stem) for path in sorted(FOLDER.glob("*.toml"))}
#: Examples of tasks whose claims are held to equations of their own: `tests.support.claims`.
CLAIMED = {
    name
    for name, tasks in TASKS.items()
    if {*tasks} & {"kalman", "lqr", "lyapunov", "margins", "minimum_energy_input", "output_regulation"}
}
#: The examples that are held to the formulas here: no regions, no families, nothing in functions of time.
BY_HAND = [
    name
    for name, tasks in TASKS.items()
    if not {*tasks} & {"stability_region", "time_varying_observability", *IN_TIME} and name not in FAMILIES | CLAIMED
]
_OF_TASK: dict[str, type[Hand]] = {
    "reduced_order_observer": MinimalOrder,
    "tracking": Tracking,
    "minimal": MinimalOrder,
}
_OF_TASK |= {"integral_action": Integral, "unknown_input_observer": Disturbed, "disturbance_observer": Modelled}


@cache
def hand(name: str) -> Hand:
    """Return a worked example by hand."""
    kind = next((_OF_TASK[task] for task in TASKS[name] if task in _OF_TASK), Hand)
    return kind.read(name, **own(name))


def own(name: str) -> dict[str, Any]:
    """Return what the file of an example does not say: of gains that are not unique one is given."""
    v, omega_0 = symbols("v omega_0")
    if name.startswith("two_masses_") and name != "two_masses_sum_measured":
        found = {"K": Matrix([[8, 5, 0, 0], [1, 0, 1, 3]])}
        gains = {
            "two_masses_minimal_order": [[5, 0], [0, 6]],
            "two_masses_minimal_order_feedthrough": [[5, 0], [5, -6]],
            "two_masses_output_feedback": [[10, 0], [27, 1], [0, 12], [0, 35]],
            "two_masses_feedthrough": [[11, 0], [33, 0], [11, -11], [30, -28]],
        }
        return found | {"L": Matrix(gains[name])}
    match name:
        case "servo_optimal_gains":
            return {"control": (s + 1) ** 2, "observer": (s + 2) ** 2}
        case "unknown_input_observer":
            return {"L": Matrix([[2, 0], [0, -12], [0, 6]])}
        case "motor_unknown_load":
            return {"L": Matrix([sympy.Symbol("p"), 0])}
        case "scaled_output_minimal_observer":
            return {"is_open": True}
        case "servo_minimal_order_feedthrough":
            return {"shrunk": 40}  # F is stable left of 1/31 and right of 13/40
        case "cart_tracking":
            return {"passed": Matrix([[0, v], [0, 0], [0, 0], [v, 0]]), "signs": {"v": "nonzero"}}
        case "cart_tracking_impossible":
            return {"row": Matrix([[0, 0, -1, -1]])}
        case "pendulum_linearised":
            g, l, b, theta, omega, u = symbols("g l b theta omega u")
            matrices = {"A": Matrix([[0, 1], [g / l, -b]]), "B": Matrix([0, 1]), "C": Matrix([[1, 0]])}
            f = Matrix([omega, -g / l * sympy.sin(theta) - b * omega + u])
            return {**matrices, "functions": {"f_x": f, "h_x": Matrix([theta])}}
        case "third_order_pole_advice":
            return {"advice": Advice((s + 2) * (s + 3), s + omega_0)}
        case "butterworth_pole_advice":
            return {"advice": Advice(s + 2, s**2 + sympy.sqrt(2) * omega_0 * s + omega_0**2)}
        case "four_on_a_circle_pole_advice":
            pairs = [2 * f(sympy.pi / 8).rewrite(sympy.sqrt) * omega_0 * s for f in (sympy.sin, sympy.cos)]
            return {"advice": Advice(sympy.Integer(1), sympy.prod(s**2 + pair + omega_0**2 for pair in pairs))}
        case "dominant_pair_pole_advice":
            rest = ((s + 2) ** 2 + Rational(52, 25) ** 2) * (s + 10) * (s + 12)
            omega_d = 2 * sympy.floor(100 * sympy.pi / sympy.log(20)) / 100
            return {"advice": Advice(s + 10, rest, sympy.Integer(2), Rational(1, 20), omega_d)}
    return {}


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
        if point.get(sympy.Symbol("c")) not in {Rational(1, 2), 1}:
            yield point
