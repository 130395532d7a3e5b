"""Plants as people give them: fractions that are not in lowest terms, flat lists, systems of other programs."""

from __future__ import annotations

import re
from fractions import Fraction
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
import sympy
from sympy.physics.control import (
    Feedback,
    MIMOFeedback,
    MIMOParallel,
    MIMOSeries,
    Parallel,
    Series,
    TransferFunction,
    TransferFunctionMatrix,
)
from sympy.physics.control import StateSpace as SymPyStateSpace

import symobs
from symobs import StateSpace
from symobs.ground.errors import CertificateRejected, InputError
from symobs.problem import read
from symobs.system import other_programs
from tests.kit import SERVO, tabled, text_of

b, p, s, z = sympy.symbols("b p s z")


def observability_page(transfer_function: object, dt: object = 0) -> str:
    return text_of(symobs.observability(StateSpace.from_transfer_function(transfer_function, dt)))


@pytest.mark.parametrize(
    ("function", "dt", "said"),
    [
        ("(s+1)/((s+1)(s+2))", 0, "The pole -1 cancels; what follows refers to the transfer function in lowest terms."),
        ("(s-1)/((s-1)(s+2))", 0, "Remark. The pole 1 cancels; .* it does not lie in the open left half-plane"),
        (
            "(z-1/2)/((z-1/2) z)",
            1,
            "The pole 1/2 cancels; what follows refers to the transfer function in lowest terms.",
        ),
        ("(z-2)/((z-2) z)", 1, "Remark. The pole 2 cancels; .* it does not lie inside the unit circle"),
        ("s(s+1)/(s^2 (s+1)^2)", 0, "Remark. The poles 0, -1 cancel; .* not all lie in the open left half-plane"),
        ("(s+b)/((s+b)(s+2))", 0, "Remark. The pole -b cancels; .* stable if and only if b > 0"),
        ("1/(s+1) - s/(s+1)^2 - 1/(s+1)^2 + 1/s", 0, "The poles -1, -1 cancel"),
        ((s**2 - 1) / (s**2 + s - 2), 0, "Remark. The pole 1 cancels"),
        ([[1, -1], [1, 1, -2]], 0, "Remark. The pole 1 cancels"),
    ],
)
def test_a_pole_that_cancels_is_a_finding(function: object, dt: int, said: str) -> None:
    """The expected poles are those of the written denominator that are none of the function's."""
    assert re.search(said, observability_page(function, dt))


@pytest.mark.parametrize(
    "function", ["b(s+1)/(b(s+2))", b * (s**2 - 1) / (b * s**2 + b * s - 2 * b), [["b", "b"], ["b", "2*b"]]]
)
def test_what_a_fraction_divides_by_stays_a_condition(function: object) -> None:
    plant = StateSpace.from_transfer_function(function, symbols={"b": "real"})
    for result in (
        symobs.observability(plant),
        symobs.transfer_function(plant),
        symobs.observer(plant, poles=[-3]),
        symobs.observer(plant, poles=["-b"]),
    ):
        assert list(result.conditions) == [sympy.Ne(b, 0, evaluate=False)]
        assert result.verdict == "yes"
        assert "The cancelled factor is nonzero, since the function is undefined elsewhere: b ≠ 0" in " ".join(
            str(result.to("text")).split()
        )
    positive = StateSpace.from_transfer_function(function, symbols={"b": "positive"})
    assert not symobs.observability(positive).conditions


# -- systems of other programs ----------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    "system",
    [
        ([1], [1, 1, 0]),
        TransferFunction(1, s * (s + 1), s),
        TransferFunction(1, p * (p + 1), p),
        Series(TransferFunction(1, s, s), TransferFunction(1, s + 1, s)),
        SymPyStateSpace(SERVO.A, SERVO.B, SERVO.C),
    ],
)
def test_systems_of_sympy_and_coefficients_are_plants(system: Any) -> None:
    """The characteristic polynomial of the error is (s + 1)(s + 2): trace and determinant of A - L C."""
    result = symobs.observer(system, poles=[-1, -2])
    error = SERVO.A - result.L * SERVO.C
    assert (error.trace(), error.det()) == (-3, 2)


def test_a_connection_that_is_given_as_a_function_has_its_repair() -> None:
    parts = TransferFunction(1, s, s), TransferFunction(1, s + 1, s)
    with pytest.raises(InputError, match="Series") as caught:
        symobs.StateSpace.from_transfer_function(Series(*parts))
    assert "where a plant is expected" in caught.value.repair


def of_state(pole: int) -> SymPyStateSpace:
    """1/(s + pole) in state space."""
    return SymPyStateSpace(sympy.Matrix([[-pole]]), sympy.Matrix([[1]]), sympy.Matrix([[1]]), sympy.Matrix([[0]]))


def function(pole: int) -> TransferFunction:
    return TransferFunction(1, s + pole, s)


MATRIX = TransferFunctionMatrix([[function(1), function(2)], [function(3), function(1)]])
OTHER = TransferFunctionMatrix([[TransferFunction(1, 1, s), function(2)], [function(3), TransferFunction(s, s + 1, s)]])
TWO = SymPyStateSpace(sympy.Matrix([[-1, 1], [0, -2]]), sympy.eye(2), sympy.eye(2), sympy.zeros(2, 2))
G = [1 / (s + pole) for pole in (0, 1, 2, 3)]
M = sympy.Matrix([[G[1], G[2]], [G[3], G[1]]])
N = sympy.Matrix([[1, G[2]], [G[3], s * G[1]]])
T = sympy.Matrix([[G[1], G[1] * G[2]], [0, G[2]]])


@pytest.mark.parametrize(
    ("system", "right", "order"),
    [
        (Series(of_state(1), of_state(2), of_state(3)), G[1] * G[2] * G[3], 3),
        (Series(function(1), function(2), function(3)), G[1] * G[2] * G[3], 3),
        (Series(of_state(1), function(2), of_state(3)), G[1] * G[2] * G[3], 3),
        (Series(TransferFunction(b, 1, s), of_state(1), of_state(2)), b * G[1] * G[2], 2),
        (Parallel(of_state(1), of_state(2), of_state(3)), G[1] + G[2] + G[3], 3),
        (Parallel(function(1), Series(function(2), function(3))), G[1] + G[2] * G[3], 3),
        (Feedback(function(1), function(2)), G[1] / (1 + G[1] * G[2]), 2),
        (Feedback(Series(of_state(1), of_state(2), of_state(3)), function(3), 1), None, 4),
        (Feedback(of_state(1), TransferFunction(1, 1, s)), G[2], 1),
        (MIMOSeries(MATRIX, OTHER), N * M, None),
        (MIMOParallel(MATRIX, OTHER), M + N, None),
        (MIMOFeedback(MATRIX, OTHER), (sympy.eye(2) + M * N).inv() * M, None),
        (MIMOSeries(TWO, MATRIX, TWO), T * M * T, None),
    ],
)
def test_connections_of_sympy_have_all_their_parts(system: Any, right: Any, order: int | None) -> None:
    right = G[1] * G[2] * G[3] / (1 - G[1] * G[2] * G[3] ** 2) if right is None else right
    found = symobs.transfer_function(system)
    difference = sympy.Matrix([[found.transfer_function]] if order else found.transfer_function) - sympy.Matrix(
        [[right]] if order else right
    )
    assert difference.subs(b, 7).applyfunc(sympy.cancel).is_zero_matrix
    assert order in (None, found.plant.order)


def test_a_connection_that_is_another_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(other_programs, "_in_series", lambda first, *_: first)
    with pytest.raises(CertificateRejected, match="another value at a point"):
        symobs.transfer_function(Series(of_state(1), of_state(2)))


def test_systems_of_python_control_are_plants() -> None:
    control = pytest.importorskip("control")
    for system in (control.tf([1], [1, 1, 0]), control.ss([[0, 1], [0, -1]], [[0], [1]], [[1, 0]], [[0]])):
        result = symobs.observer(system, poles=[-1, -2])
        error = SERVO.A - result.L * SERVO.C
        assert (error.trace(), error.det()) == (-3, 2)
        assert "shortest decimals" in text_of(result)
    assert "shortest decimals" not in text_of(symobs.observer(SERVO, poles=[-1, -2]))
    sampled = symobs.observability(control.tf([1], [1, 0.5], 0.1)).plant
    assert (sampled.A, sampled.dt) == (sympy.Matrix([[-sympy.Rational(1, 2)]]), sympy.Rational(1, 10))


@pytest.mark.parametrize("entry", [np.nan, 1j])
def test_what_is_no_system_of_finite_numbers_is_refused(entry: complex) -> None:
    one = np.array([[1.0]])
    with pytest.raises(InputError) as caught:
        StateSpace.from_control(SimpleNamespace(A=one * entry, B=one, C=one, D=one, dt=0))
    assert caught.value.where == "plant.A"
    assert caught.value.repair


@pytest.mark.parametrize(
    ("system", "reason"),
    [
        ("1/s", 'a value of type str came; .*from_transfer_function\\("1/'),
        (1 / s, "a plant is expected, but a value of type Pow came"),
        (3, "a plant is expected, but a value of type int came"),
        (TransferFunction(s**2, s + 1, s), "is not proper: degree 2 over degree 1"),
        (([1], [0]), "the denominator is 0"),
    ],
)
def test_what_is_no_plant_is_refused(system: Any, reason: str) -> None:
    with pytest.raises(InputError, match=reason):
        symobs.observability(system)


# -- parameters replaced ----------------------------------------------------------------------------------------------


@tabled
def test_values_that_cannot_be_are_refused(values: dict[Any, Any], said: str) -> None:
    plant = StateSpace("[p 1; 0 b]", symbols={"p": "real", "b": "positive"})
    with pytest.raises(InputError, match=said):
        plant.substitute(values)


def test_transfer_functions_of_other_programs_are_read() -> None:
    """Two lists of coefficients, and SciPy's and MATLAB's matrix of numerators over a common denominator."""
    read = StateSpace.from_transfer_function
    assert read([1, 3], [1, 3, 2]) == read(([1, 3], [1, 3, 2])) == read([1, 3], [1, 3, 2], 0)
    assert read([1], [2, 1], "1/2").dt == read([1], [2, 1], dt="1/2").dt == Fraction(1, 2)
    lag = symobs.transfer_function(read(([[1, 0], [1, 1]], [1, 1]))).transfer_function
    s = sympy.Symbol("s")
    assert lag == sympy.Matrix([[1, 0], [1, 1]]) / (s + 1)
    with pytest.raises(InputError, match="dead time is not rational; write a Padé approximation"):
        read("exp(-s)/(s+1)")


def test_a_sampling_period_may_be_a_symbol_that_is_positive() -> None:
    held = StateSpace("[exp(-T)]", "[1]", "[1]", dt="T", symbols={"T": "positive"})
    assert (held.is_discrete, held.dt, held.substitute({"T": "1/2"}).dt) == (True, "T", Fraction(1, 2))
    assert symobs.observability(held).at(T=2).plant.dt == 2
    assert '"dt": "T"' in symobs.observability(held).to("json")
    with pytest.raises(InputError, match="T is not a sampling period"):
        StateSpace("[1]", dt="T", symbols={"T": "real"})


# -- the coordinates of a transfer function ----------------------------------------------------------------------------


@tabled
def test_a_transfer_function_is_realised_in_the_coordinates_asked_for(written: str) -> None:
    """C (sI − A)⁻¹ B + D is the function in all of them; the dual of the controllable form, and blocks of the factors."""
    wanted = sympy.sympify(written.replace("^", "**"))  # noqa: TID251 - texts of this file
    plain, observable, modal = (
        StateSpace.from_transfer_function(written, realisation=kind) for kind in ("controllable", "observable", "modal")
    )
    for plant in (plain, observable, modal):
        n = plant.A.rows
        found = (plant.C * (s * sympy.eye(n) - plant.A).inv() * plant.B + plant.D)[0]
        assert sympy.cancel(found - wanted) == 0
    assert (observable.A, observable.B, observable.C) == (plain.A.T, plain.C.T, plain.B.T)
    factors = sympy.factor_list(sympy.fraction(sympy.cancel(wanted))[1], s)[1]
    for factor, power in factors:
        degree = sympy.degree(factor, s) * power
        assert any(
            sympy.expand(block.charpoly(s).as_expr() - sympy.Poly(factor**power, s).monic().as_expr()) == 0
            and modal.A[first : first + degree, :first].is_zero_matrix is not False
            and modal.A[first : first + degree, first + degree :].is_zero_matrix is not False
            for first in range(modal.A.rows - degree + 1)
            for block in [modal.A[first : first + degree, first : first + degree]]
        )
    assert sorted(modal.B) == [0] * (modal.B.rows - len(factors)) + [1] * len(factors)


def test_a_page_says_which_realisation_it_has_and_values_keep_it() -> None:
    plant = StateSpace.from_transfer_function("1/((s + a)*(s + 2))", realisation="modal")
    found = symobs.observability(plant)
    assert "A realisation in modal form is" in found.to("text")
    assert [str(condition) for condition in found.conditions] == ["Ne(a - 2, 0)"]
    assert "A realisation in modal form is" in found.at(a=3).to("text")
    text = 'task = "observability"\n[plant]\ntransfer_function = "1/(s^2 + s)"\nrealisation = "observable"\n'
    (read_there,) = read(text).solve()
    assert "observable canonical form" in read_there.to("text")


@tabled
def test_coordinates_that_there_are_not_are_refused(function: str, kind: str, words: str) -> None:
    with pytest.raises(InputError, match=words):
        StateSpace.from_transfer_function(function, realisation=kind)
