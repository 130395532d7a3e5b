"""The smallest gain of a family: against minimisation in floating point, lies about it, the pages, what is refused.

The minimisation knows nothing of symobs: it projects from many starting points, and finds at best the same value.
"""

from __future__ import annotations

import json
import random
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
import sympy
from sympy import Matrix, Rational

import symobs
from symobs.design import smallest
from symobs.errors import CertificateRejected, InputError
from symobs.exact.enclosure import near

if TYPE_CHECKING:
    from collections.abc import Iterator

s = sympy.Symbol("s")


# -- a judge in floating point -----------------------------------------------------------------------------------------


def coefficients(A: Any, C: Any, L: Any) -> tuple[Any, Any]:
    """Return the coefficients of det(sI − A + LC) and their derivatives by the entries of L, by Faddeev's recursion."""
    order = len(A)
    X, B, found, rows = A - L @ C, np.eye(order), [1.0], []
    for k in range(1, order + 1):
        rows.append((C @ B).T.ravel())
        moved = X @ B
        found.append(-np.trace(moved) / k)
        B = moved + found[-1] * np.eye(order)
    return np.array(found[1:]), np.array(rows)


def least_found(A: Any, C: Any, phi: Any, seed: int, starts: int = 8) -> float:
    """Return the least sum of squares that projected steps from many starting points come to."""
    chance = np.random.default_rng(seed)
    shape, best = (len(A), len(C)), np.inf
    for _ in range(starts):
        x = chance.normal(size=shape).ravel() * chance.choice([0.3, 1.0, 3.0])
        for step in [0.3] * 80 + [0.7] * 40:
            off, J = coefficients(A, C, x.reshape(shape))
            target = J.T @ np.linalg.lstsq(J @ J.T, J @ x - (off - phi), rcond=None)[0]
            x = x + step * (target - x)
            if not np.isfinite(x).all() or np.abs(x).max() > 1e6:
                break
        else:
            off, _ = coefficients(A, C, x.reshape(shape))
            if np.abs(off - phi).max() < 1e-9:
                best = min(best, float(x @ x))
    return best


def drawn(order: int, outputs: int, number: int) -> tuple[list[list[int]], list[list[int]], list[int]]:
    """Draw an observable plant whose C has rank 2, and poles."""
    chance = random.Random(f"smallest {order} {outputs} {number}")  # noqa: S311 - the same in every run
    while True:
        A = [[chance.randint(-3, 3) for _ in range(order)] for _ in range(order)]
        C = [[chance.randint(-2, 2) for _ in range(order)] for _ in range(outputs)]
        if outputs > 2:
            C[2] = [a - b for a, b in zip(C[0], C[1], strict=True)]
        stack = np.vstack([np.array(C) @ np.linalg.matrix_power(np.array(A), k) for k in range(order)])
        if np.linalg.matrix_rank(C) == 2 and np.linalg.matrix_rank(stack) == order:
            return A, C, [-chance.randint(0, 4) for _ in range(order)]


def numbers(found: Any) -> Any:
    """Return the gain in floating point."""
    return np.array([[float(near(entry) or 0) for entry in row] for row in found.answer["L"].rows])


def size_of(found: Any) -> float:
    return float((numbers(found) ** 2).sum())


def judged(A: list[list[int]], C: list[list[int]], poles: list[int], seed: int) -> Any:
    """Return the smallest gain, held against the minimisation."""
    found = symobs.observer(symobs.StateSpace(A, C=C), poles=poles, member="smallest")
    phi = np.poly(poles)
    assert np.allclose(np.poly(np.array(A) - numbers(found) @ np.array(C)), phi, atol=1e-6)
    best = least_found(np.array(A, float), np.array(C, float), phi[1:], seed)
    own = size_of(found)
    assert own <= best + 1e-7 * (1 + best)
    assert best <= own + 1e-4 * (1 + own)
    return found


@pytest.mark.parametrize("number", range(8))
@pytest.mark.parametrize("outputs", [2, 3])
def test_no_gain_of_second_order_is_smaller(number: int, outputs: int) -> None:
    judged(*drawn(2, outputs, number), seed=number)


@pytest.mark.parametrize("number", range(6))
def test_no_gain_of_third_order_is_smaller(number: int) -> None:
    A, C, poles = drawn(3, 2, number)
    judged(A, C, poles, number)


def test_the_least_stationary_gain_where_no_multipliers_prove_it() -> None:
    A, C, poles = drawn(3, 2, 2)
    found = judged(A, C, poles, 2)
    claims = [certificate.claim for certificate in found.certificates]
    assert any("Lagrange" in claim for claim in claims)
    assert any("one root between 0 and" in claim for claim in claims)
    assert "least eigenvalue" in " ".join(found.to("text").split())
    other = symobs.observer(symobs.StateSpace(A, C=C), poles=poles)
    with pytest.raises(CertificateRejected):
        found.with_answer("L", other.answer["L"])


#: Plants with many zeros, for which H is singular: a circle of gains is smallest.
EDGES: list[tuple[list[list[int]], list[list[int]], list[int]]] = [
    ([[0, 0, -1], [0, 0, 0], [0, 0, 0]], [[0, 1, 0], [1, 0, 0]], [0, 0, -3]),
    ([[0, 2, 0], [0, -3, 0], [0, 0, 0]], [[1, 0, 0], [0, 0, 1]], [-1, -2, -3]),
    ([[1, 0, 0], [0, 0, 0], [0, -1, 0]], [[0, 0, 1], [1, 0, 0]], [-3, -4, -3]),
]


@pytest.mark.parametrize("number", range(len(EDGES)))
def test_one_of_a_circle_of_smallest_gains(number: int) -> None:
    found = judged(*EDGES[number], number)
    found.to("latex")
    turned = found.with_answer("L", found.answer["L"].substitute({}))
    assert turned.verdict == "yes"


def test_interior_multipliers_from_a_plant_whose_zero_gain_is_degenerate() -> None:
    found = judged([[-1, 2, 0], [0, 0, 0], [0, 0, 0]], [[1, 0, 0], [0, 0, 1]], [0, -2, -3], 1)
    assert Matrix([[2, 0], [0, 0], [0, 2]]) == found.L


# -- answers known by hand -----------------------------------------------------------------------------------------------

#: Plant, poles, and the least sum of squares.  With A = 0 and C = I a gain with trace t and determinant d is t/2 I plus
#: a turn of size x and a stretch of size y with x² − y² = d − t²/4; its squares add up to t²/2 + 2 (x² + y²).
KNOWN = [
    ("[0 0; 0 0]", ["i", "-i"], 2),
    ("[0 0; 0 0]", ["1", "-1"], 2),
    ("[0 0; 0 0]", ["-1", "-3"], 10),
    ("[0 0; 0 0]", ["-2", "-2"], 8),
    ("[0 1; -1 0]", ["-1+i", "-1-i"], 2),  # both poles move left by 1: the identity does it
    ("[3 0; 0 3]", ["-1", "-1"], 32),
    ("[0 1; 0 0]", ["0", "0"], 0),
]


@pytest.mark.parametrize(("A", "poles", "squares"), KNOWN)
def test_answers_known_by_hand(A: str, poles: list[str], squares: int) -> None:
    found = symobs.observer(symobs.StateSpace(A, C="[1 0; 0 1]"), poles=poles, member="smallest")
    assert sum(entry**2 for entry in found.L) == squares
    found.to("latex")


def test_a_gain_that_leaves_the_poles_is_zero_whatever_C() -> None:
    plant = symobs.StateSpace("[-1 1 0; 0 -2 1; 0 0 -3]", C="[1 0 0; 0 1 0; 0 0 1]")
    found = symobs.observer(plant, poles=[-1, -2, -3], member="smallest")
    assert sympy.zeros(3, 3) == found.L
    assert "no gain is needed" in " ".join(found.to("text").split())
    with pytest.raises(CertificateRejected):
        found.with_answer(
            "L",
            symobs.observer(plant, poles=[-1, -2, -3]).answer["L"]
            + type(found.answer["L"]).of([[0, 0, 1]] + [[0] * 3] * 2),
        )


def test_a_double_pole_of_two_measured_states_with_parameters() -> None:
    plant = symobs.StateSpace("[0 omega; 0 0]", C="[1 0; 0 1]", symbols={"omega": "positive", "p": "positive"})
    found = symobs.observer(plant, poles=["-p", "-p"], member="smallest")
    assert sympy.Symbol("p") * sympy.eye(2) == found.L
    assert found.verdict == "yes"
    found.to("latex")


# -- what it looks like --------------------------------------------------------------------------------------------------

INTEGRATORS = symobs.StateSpace("[0 1; 0 0]", C="[1 0; 0 1]")


def test_the_gain_of_two_integrators() -> None:
    found = symobs.observer(INTEGRATORS, poles=[-1, -2], member="smallest")
    a, b, c, d, k, m = unknowns = sympy.symbols("a b c d k m")
    L = Matrix([[a, b], [c, d]])
    error = sympy.Poly((s * sympy.eye(2) - INTEGRATORS.A + L).det() - (s + 1) * (s + 2), s).coeffs()
    lagrangian = sum(entry**2 for entry in L) + k * error[0] + m * error[1]
    basis = sympy.groebner([*(sympy.diff(lagrangian, x) for x in unknowns[:4]), *error], *unknowns, order="lex")
    in_m = sympy.Poly(basis.exprs[-1], m)
    sizes = []
    for root in in_m.real_roots():
        point = sympy.solve([e.subs(m, root) for e in basis.exprs[:-1]], unknowns[:5], dict=True)
        sizes += [sum(sympy.N(v[x], 30) ** 2 for x in (a, b, c, d)) for v in point]
    assert abs(min(sizes) - size_of(found)) < 1e-14


def test_state_feedback_is_the_transpose() -> None:
    plant = symobs.StateSpace(INTEGRATORS.A.T, INTEGRATORS.C.T)
    back = symobs.state_feedback(plant, poles=[-1, -2], member="smallest")
    assert back.K == symobs.observer(INTEGRATORS, poles=[-1, -2], member="smallest").L.T
    for text in (back.to("latex"), back.to("text"), back.to("html")):
        assert isinstance(text, str)
        assert "CRootOf" not in text


def test_json_holds_what_sympy_reads() -> None:
    found = symobs.observer(INTEGRATORS, poles=[-1, -2], member="smallest")
    told = json.loads(found.to("json"))
    told = told["results"][0] if "results" in told else told
    x = sympy.Symbol("x")
    entry = sympy.parse_expr(told["L"][0][1], local_dict={"x": x, "CRootOf": sympy.CRootOf})  # noqa: TID251 - our own
    assert abs(sympy.N(entry, 30) - sympy.N(found.L[0, 1], 30)) < 1e-25


def test_a_long_gain_is_shown_in_decimals_and_goes_on_in_letters() -> None:
    plant = symobs.StateSpace("[0 1 0; 0 0 1; 1 2 3]", C="[1 0 0; 0 0 1]")
    text = symobs.observer(plant, poles=[-1, -1, -1], member="smallest").to("text")
    assert "too long to be written out" in " ".join(text.split())
    assert "l₁₁" in text
    assert "CRootOf" not in text


# -- lies ----------------------------------------------------------------------------------------------------------------


def test_other_gains_with_the_same_poles_are_rejected() -> None:
    found = symobs.observer(INTEGRATORS, poles=[-1, -2], member="smallest")
    for other in ("[3 1; -2 0]", "[1 1; 0 2]", "[1 0; 0 2]"):
        given = symobs.observer(INTEGRATORS, L=other)
        if given.answer["polynomial"] != found.answer["polynomial"]:
            continue
        with pytest.raises(CertificateRejected):
            found.with_answer("L", given.answer["L"])


def real_members() -> Iterator[Any]:
    """Yield the gain with every other real root of the polynomial of μ in its place."""
    found = symobs.observer(INTEGRATORS, poles=[-1, -2], member="smallest").answer["L"]
    from symobs.exact.functions import known  # noqa: PLC0415 - a look behind the result
    from symobs.exact.real import real_roots  # noqa: PLC0415 - the same

    (name,) = found.names
    own: Any = known(name)
    for root in real_roots(own.number.polynomial):
        if root != own.number:
            yield found.substitute({name: root.scalar()})


def test_a_stationary_gain_that_is_not_the_smallest_is_rejected() -> None:
    found = symobs.observer(INTEGRATORS, poles=[-1, -2], member="smallest")
    others = list(real_members())
    assert others
    for other in others:
        assert found.assigned(other) is not None  # the claim can be made: it assigns the poles
        with pytest.raises(CertificateRejected):
            found.with_answer("L", other)


@pytest.mark.parametrize("place", [0, 1])
def test_other_multipliers_are_rejected(place: int, monkeypatch: pytest.MonkeyPatch) -> None:
    true: Any = smallest.smallest

    def lying(*arguments: Any) -> Any:
        found = true(*arguments)
        changed = [m + (1 if k == place else 0) for k, m in enumerate(found.multipliers)]
        return replace(found, multipliers=tuple(changed))

    monkeypatch.setattr("symobs.design.smallest.smallest", lying)
    with pytest.raises(CertificateRejected, match="every M"):
        symobs.observer(INTEGRATORS, poles=[-1, -2], member="smallest")


def test_multipliers_whose_matrix_has_a_negative_eigenvalue_are_rejected(monkeypatch: pytest.MonkeyPatch) -> None:
    """A greatest stationary value: everything is true of it but the signs."""
    plant = symobs.StateSpace("[0 0; 0 0]", C="[1 0; 0 1]")
    matrix = type(symobs.observer(plant, poles=[-1, -3], member="smallest").answer["L"])
    scalar = matrix.of([[Rational(1, 1).p]])[0, 0]
    far = smallest.Smallest(matrix.of([[2, 1], [1, 2]]), (scalar * 0, scalar * 4))
    monkeypatch.setattr("symobs.design.smallest.smallest", lambda *_: far)
    with pytest.raises(CertificateRejected):
        symobs.observer(plant, poles=[-1, -3], member="smallest")


# -- what is refused -----------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("A", "C", "poles", "reason"),
    [
        ("[0 1 0; 0 0 1; 1 2 3]", "[1 0 0; 0 1 0; 0 0 1]", ["-1", "-1", "-2"], "at most 2"),
        ("[0 1 0; 0 0 1; 1 2 a]", "[1 0 0; 0 1 0]", ["-1", "-1", "-2"], "second order"),
        ("[0 a; -a 0]", "[1 0; 0 1]", ["-p", "-q"], "for all of them"),
        ("[1e200 1; 0 1]", "[1 0; 0 1]", ["-1", "-2"], "too many digits"),
        ("[1e200 1 0; 0 1 0; 0 1 0]", "[1 0 0; 0 0 1]", ["-1", "-2", "-3"], "not known exactly"),
    ],
)
def test_what_is_refused_says_why(A: str, C: str, poles: list[str], reason: str) -> None:
    with pytest.raises(InputError, match=reason) as caught:
        symobs.observer(symobs.StateSpace(A, C=C), poles=poles, member="smallest")
    assert caught.value.where == "specification.member"
