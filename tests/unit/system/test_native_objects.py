"""Numbers, floats, transfer matrices and connections as Python, NumPy, SymPy and python-control have them."""

from __future__ import annotations

from decimal import Decimal
from fractions import Fraction
from typing import Any

import control  # type: ignore[import-untyped]
import numpy as np
import pytest
import scipy.signal  # type: ignore[import-untyped]
import sympy
from sympy.physics.control import TransferFunction, TransferFunctionMatrix

import symobs
from symobs import StateSpace
from symobs.ground.errors import InputError, ShapeMismatch, SymobsError
from symobs.tasks.result import tasks
from tests.kit import SERVO, tabled

s, k = sympy.symbols("s k")


# -- numbers ----------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("given", "exact"),
    [
        (Fraction(3, 7), "3/7"),
        (Decimal("0.1"), "1/10"),
        (Decimal("-2.5E-3"), "-1/400"),
        (Decimal(4), "4"),
        (2 + 0j, "2"),
        (np.int8(-3), "-3"),
        (np.complex64(5), "5"),
        (sympy.Rational(2, 3), "2/3"),
    ],
    ids=str,
)
def test_exact_numbers_are_entries(given: Any, exact: str) -> None:
    wanted = sympy.Matrix([[sympy.Rational(exact), 1], [0, 1]])
    for A in ([[given, 1], [0, 1]], np.array([[given, 1], [0, 1]], dtype=object)):
        assert wanted == StateSpace(A).A


@pytest.mark.parametrize(
    "poles",
    [[-2 + 3j, -2 - 3j], np.array([-2 + 3j, -2 - 3j]), (Decimal(-4), Decimal("-3.25")), sympy.Matrix([-1, -13])],
)
def test_poles_may_be_exact_numbers_of_any_kind(poles: Any) -> None:
    """The error's characteristic polynomial from the given poles: trace and determinant of A - L C."""
    error = SERVO.A - symobs.observer(SERVO, poles=poles).L * SERVO.C
    numbers = [complex(pole) for pole in poles]
    assert (float(error.trace()), float(error.det())) == (sum(numbers, 0j).real, float(np.prod(numbers).real))


@pytest.mark.parametrize(
    ("entry", "said"),
    [
        (0.5, '0.5 is a float; write an exact value such as "1/2", or give the plant or the task floats="decimal"'),
        (np.float32(0.5), "0.5 is a float"),
        (1 + 0.5j, "is a float"),
        (2.0**60 + 0j, "is a float"),
        (Decimal("NaN"), "a value of type Decimal is not an exact number"),
        (Decimal("1E+5000"), "more than 1000 digits"),
        (True, "a truth value"),
        (sympy.Function("f")(s), r"f\(s\) is not a rational expression"),
    ],
    ids=str,
)
def test_what_is_no_exact_number_is_refused(entry: Any, said: str) -> None:
    with pytest.raises(InputError, match=said):
        StateSpace([[entry, 1], [0, 1]])


# -- floats, where the caller says so ---------------------------------------------------------------------------------


@pytest.mark.parametrize(
    "given",
    [
        [[0.1, 1.0], [-2.5, 1e-3]],
        np.array([[0.1, 1], [-2.5, 1e-3]]),
        np.array([[0.1, 1], [-2.5, 1e-3]], dtype=np.float32),
        sympy.Matrix([[0.1, 1], [-2.5, 1e-3]]),
        [["0.1", 1], [sympy.Float(-2.5), Decimal("0.001")]],
    ],
)
def test_floats_are_their_shortest_decimals(given: Any) -> None:
    plant = StateSpace(given, floats="decimal")
    tenth, thousandth = sympy.Rational(1, 10), sympy.Rational(1, 1000)
    assert sympy.Matrix([[tenth, 1], [-sympy.Rational(5, 2), thousandth]]) == plant.A
    assert "Floating-point entries are taken as the shortest decimals that represent them." in symobs.pbh(
        StateSpace(given, C=[1, 0], floats="decimal")
    ).to("text")


@pytest.mark.parametrize(
    ("given", "floats", "said"),
    [
        ([[float("nan")]], "decimal", "nan is not a finite number"),
        (np.array([[np.inf]]), "decimal", "inf is not a finite number"),
        ([[1]], "exact", "'exact' is no way to read floats; write floats=\"decimal\""),
    ],
)
def test_floats_that_are_no_numbers_are_refused(given: Any, floats: Any, said: str) -> None:
    with pytest.raises(InputError, match=said):
        StateSpace(given, floats=floats)


# -- transfer matrices ------------------------------------------------------------------------------------------------


@tabled
def test_a_transfer_matrix_has_a_minimal_realisation(texts: list[list[str]], order: int) -> None:
    """Held to SymPy: the function it came from, and both ranks, at a point of the parameters."""
    rows = [[sympy.sympify(text) for text in row] for row in texts]  # noqa: TID251 - texts of this file
    whole = "[" + "; ".join(" ".join(text.replace(" ", "") for text in row) for row in texts) + "]"
    for given in (rows, sympy.Matrix(rows), whole):
        plant = StateSpace.from_transfer_function(given)
        found = plant.C * (s * sympy.eye(plant.order) - plant.A).inv() * plant.B + plant.D
        assert (found - sympy.Matrix(rows)).applyfunc(sympy.simplify) == sympy.zeros(*found.shape)
        assert plant.order == order
        A, B, C = (M.subs({"a": 3, "b": 5}) for M in (plant.A, plant.B, plant.C))
        assert sympy.Matrix.vstack(*(C * A**i for i in range(order))).rank() == order
        assert sympy.Matrix.hstack(*(A**i * B for i in range(order))).rank() == order


def test_transfer_matrices_of_other_programs_are_plants() -> None:
    wanted = sympy.Matrix([[1 / (s + 1), 2 / (s + sympy.Rational(5, 2))]])
    p = sympy.Symbol("p")
    for system in (
        control.tf([[[1], [2]]], [[[1, 1], [1, 2.5]]]),
        TransferFunctionMatrix([[TransferFunction(1, p + 1, p), TransferFunction(4, 2 * p + 5, p)]]),
    ):
        function = symobs.transfer_function(system).transfer_function
        assert (function - wanted).applyfunc(sympy.simplify) == sympy.zeros(1, 2)


@pytest.mark.parametrize(
    ("given", "said"),
    [
        ([["1/s", "1/s"], ["1/s"]], r"rows of different lengths \[1, 2\]"),
        ([["1/s", "s"]], r"transfer_function\[0\]\[1\]: s is not proper"),
        ("[1 2 + s - s]", "the transfer matrix has no pole"),
        ([["1/s", "1/"]], r"transfer_function\[0\]\[1\]: .* is expected"),
        (sympy.Matrix([[1 / s, sympy.sin(s)]]), "is a function of s"),
    ],
)
def test_transfer_matrices_that_are_no_plants_are_refused(given: Any, said: str) -> None:
    with pytest.raises(InputError, match=said):
        StateSpace.from_transfer_function(given)


# -- connections ------------------------------------------------------------------------------------------------------

LAG = StateSpace("[-2]", "[1]", "[2]", "3")
TWO = StateSpace("[1 2; 3 4]", "[1 0; 2 1]", "[1 0]", "[0 1]")


def of_control(plant: StateSpace) -> Any:
    return control.ss(*(np.array(matrix, dtype=float) for matrix in (plant.A, plant.B, plant.C, plant.D)))


@pytest.mark.parametrize(
    "connect",
    [
        lambda ss: ss(SERVO) * ss(LAG),
        lambda ss: ss(LAG) * ss(SERVO),
        lambda ss: ss(SERVO) * ss(TWO),
        lambda ss: ss(SERVO) + ss(LAG),
        lambda ss: ss(TWO) + ss(TWO),
        lambda ss: ss(SERVO).feedback(ss(LAG)),
        lambda ss: ss(LAG).feedback(ss(LAG), 1),
        lambda ss: ss(LAG).feedback(),
        lambda ss: (ss(LAG) * ss(SERVO)).feedback(2),
    ],
)
def test_connections_are_those_of_python_control(connect: Any) -> None:
    mine, theirs = connect(lambda plant: plant), connect(of_control)
    for name in "ABCD":
        assert np.allclose(np.array(getattr(mine, name), dtype=float), getattr(theirs, name)), name


@pytest.mark.parametrize(
    ("connect", "said"),
    [
        (lambda: TWO * SERVO, "plants of 1×2 and 1×1 outputs by inputs cannot be connected in series"),
        (lambda: TWO + SERVO, "cannot be connected in parallel"),
        (lambda: SERVO / 0, "by a number that is not 0"),
        (lambda: SERVO / LAG, "P.feedback"),
        (lambda: SERVO**0, "is no number of plants"),
        (lambda: SERVO.feedback(TWO), "cannot be connected in feedback"),
        (lambda: SERVO * StateSpace([[0]], 1, 1, dt=1), "different sampling periods, 0 and 1"),
        (lambda: LAG.feedback(StateSpace([[0]], 1, 1, "-1/3")), "the loop is algebraic"),
        (lambda: StateSpace([[0]]) * SERVO, "a connection needs B"),
        (lambda: SERVO * StateSpace("[t]", "1", "1"), "varies in time"),
        (
            lambda: (
                StateSpace([["k"]], 1, 1, symbols={"k": "positive"}) + StateSpace([["k"]], 1, 1, symbols={"k": "real"})
            ),
            "k is positive in one plant and real in the other",
        ),
        (lambda: StateSpace([[k]], 1, 1) + StateSpace([[sympy.Dummy("k")]], 1, 1), "two different symbols"),
    ],
)
def test_plants_that_do_not_fit_are_refused(connect: Any, said: str) -> None:
    with pytest.raises(InputError, match=said):
        connect()
    assert issubclass(ShapeMismatch, InputError)


# -- what is none of these --------------------------------------------------------------------------------------------


class Foreign:
    """An object of nobody's."""

    shape, dtype, num, den = (2, 2), "f", 1, 2


@pytest.mark.parametrize(
    "ask",
    [
        lambda: StateSpace(np.zeros((2, 2, 2))),
        lambda: StateSpace([[np.datetime64("2020")]], floats="decimal"),
        lambda: StateSpace([[1]], floats=np.array([1, 2])),  # type: ignore[arg-type]
        lambda: StateSpace(Foreign(), floats="decimal"),
        lambda: StateSpace(sympy.Array([1, 2])),
        lambda: StateSpace.from_transfer_function([]),
        lambda: StateSpace.from_transfer_function(TransferFunction(1, s, s)),
        lambda: StateSpace.from_control(TransferFunction(1, s, s)),
        lambda: StateSpace.from_control(Foreign()),
        lambda: symobs.observer(None, poles=[-1]),  # type: ignore[arg-type]
        lambda: symobs.observer(SERVO, poles=[s, -1]),
        lambda: symobs.observer(SERVO, poles=[-1, -2], member=np.array([1, 2])),  # type: ignore[arg-type]
        lambda: symobs.compensator(SERVO, method=3),  # type: ignore[arg-type]
        lambda: SERVO * object(),
        lambda: SERVO.feedback(np.array([1, 2, 3])),
    ],
)
def test_foreign_objects_are_refused_with_a_reason(ask: Any) -> None:
    with pytest.raises(SymobsError) as caught:
        ask()
    assert str(caught.value)


# -- what may be meant in two ways, and what comes from SciPy ----------------------------------------------------------


@tabled
def test_a_list_of_rows_is_no_pair_of_numerator_and_denominator(rows: Any) -> None:
    with pytest.raises(InputError, match=r"may be a matrix, or a numerator.*symobs\.StateSpace\(A, B, C\)"):
        symobs.characteristic_polynomial(rows)
    assert symobs.characteristic_polynomial(([1, 2], [1, 3])).polynomial == s + 3


@pytest.mark.parametrize("dt", [None, 0.1])
def test_systems_of_scipy_are_plants(dt: float | None) -> None:
    above, below = [0.5, 2.0], [1.0, -0.3, 0.02]
    transfer = scipy.signal.TransferFunction(above, below, **({} if dt is None else {"dt": dt}))
    for system in (transfer, transfer.to_ss()):
        result = symobs.transfer_function(system)
        variable = sympy.Symbol("s" if dt is None else "z")
        wanted = (variable / 2 + 2) / (variable**2 - sympy.Rational(3, 10) * variable + sympy.Rational(1, 50))
        assert sympy.simplify(result.transfer_function - wanted) == 0
        assert "Floating-point entries are taken as the shortest decimals" in result.to("text")
    with pytest.raises(InputError, match=r"convert it by system\.to_tf\(\)"):
        symobs.transfer_function(transfer.to_zpk())


@pytest.mark.parametrize("polynomial", [[1, 9, 20], np.array([1, 9, 20]), np.poly1d([1, 9, 20])])
def test_coefficients_are_no_polynomial_and_the_message_writes_one(polynomial: Any) -> None:
    with pytest.raises(InputError, match=r'a list of coefficients came; write for example "s\^2 \+ 9 s \+ 20"'):
        symobs.observer(SERVO, polynomial=polynomial)


def test_what_other_programs_call_a_task_is_told_its_name() -> None:
    assert set(symobs.SYNONYMS.values()) <= set(tasks())
    with pytest.raises(AttributeError, match="it is called state_feedback here"):
        getattr(symobs, next(name for name in symobs.SYNONYMS if name == "place"))


def test_rows_in_brackets_and_flat_vectors_are_read() -> None:
    plant = StateSpace("[[0, 1], [-2, -3]]", "[[0], [1]]", "[1 0]")
    assert plant == StateSpace("[0 1; -2 -3]", "[0; 1]", "[1 0]")
    assert symobs.state_feedback(plant, poles=np.array([[-1, -4]])).K == symobs.state_feedback(plant, K="2, 2").K
    assert symobs.response(plant, initial="1, 0") == symobs.response(plant, initial="[1; 0]")
