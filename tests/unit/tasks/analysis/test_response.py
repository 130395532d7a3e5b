"""The response to an initial state and an input: python-control, resonance, what is refused."""

from __future__ import annotations

from fractions import Fraction
from typing import Any

import numpy as np
import pytest
import sympy
from scipy.linalg import expm  # type: ignore[import-untyped]

import symobs
from symobs import StateSpace
from symobs.applications.checking import Checked
from symobs.exact import Matrix
from symobs.formula.figures import TimeResponse
from symobs.ground.errors import CertificateRejected, InputError
from symobs.proof.derivation.steps import Plot
from tests.kit import tabled, text_of

t, a, c = sympy.symbols("t a c")


def pictures(result: Any) -> list[TimeResponse]:
    """The pictures on the page of a response, which stand in its last section."""
    steps = [step for section in result.derivation.steps for step in getattr(section, "steps", ())]
    return [step.picture for step in steps if isinstance(step, Plot) and isinstance(step.picture, TimeResponse)]


def test_an_impulse_without_effect_and_a_wrong_one() -> None:
    plant = StateSpace("[-1]", "[1]", "[1]")
    assert "x₀ = B·0 = 0" in symobs.response(plant, impulse=0).to("text")
    found = symobs.response(plant, impulse=1)
    with pytest.raises(CertificateRejected, match="x0 is the initial state and what the impulse adds"):
        found.with_answer("impulse", Matrix.of([[2]]))


def test_what_is_in_resonance_is_a_case() -> None:
    """x' = −a x + e^{−ct}: (e^{−ct} − e^{−at})/(a − c), and t e^{−ct} where a = c."""
    found = symobs.response(StateSpace("[-a]", "[1]", "[1]"), input="exp(-c*t)")
    assert sympy.simplify(found.state[0] - (sympy.exp(-c * t) - sympy.exp(-a * t)) / (a - c)) == 0
    (case,) = found.cases
    assert case.when == (sympy.Eq(a - c, 0),)
    assert sympy.simplify(case.result.state[0].subs(a, c) - t * sympy.exp(-c * t)) == 0
    page = text_of(found)
    assert "Case a = c." in page
    assert "t exp(-c t)" in page


@tabled
def test_an_output_that_no_state_explains_in_general_is_explained_where_it_is(
    data: dict[str, str], where: str, x0: int
) -> None:
    """For ẋ = −a x + u: where there is an initial state, and which, by hand."""
    found = symobs.initial_state(StateSpace("[-a]", "[1]", "[1]"), **data)
    cases = {tuple(map(str, case.when)): case.result for case in found.cases}
    assert found.verdict == "no"
    assert cases[(where,)].x0 == (x0,)
    assert all(result.verdict == "no" for when, result in cases.items() if when != (where,))
    assert "The Gramian is nonsingular" in found.to("text")


def test_outputs_that_contradict_each_other_agree_somewhere() -> None:
    p, q = sympy.symbols("p q")
    found = symobs.initial_state(StateSpace("[0 1; 0 0]", C="[1 0; 0 1]"), output=["p*t", "q"])
    (case,) = found.cases
    assert (found.verdict, case.when, case.result.x0) == ("no", (sympy.Eq(p - q, 0),), (0, q))


@tabled
def test_the_value_at_an_instant(plant: dict[str, Any], asked: dict[str, Any], instant: int | str, said: str) -> None:
    """The output, or the state where there is none, and on a plant with letters in every case."""
    found = symobs.response(StateSpace(**plant), **asked, at_time=instant)
    A, order, discrete = np.array(plant["A"]), len(plant["A"]), "dt" in plant
    whole = np.block([[A, np.array(plant["B"])], [np.zeros((1, order)), np.array([[int(discrete)]])]])
    begins = np.array([*asked.get("initial", [0] * order), asked["input"]])
    moved = np.linalg.matrix_power(whole, int(instant)) if discrete else expm(whole * float(Fraction(instant)))
    expected = np.array(plant.get("C", np.eye(order))) @ (moved @ begins)[:order]
    assert [complex(x).real for x in found.value] == pytest.approx(list(expected), rel=1e-10)
    assert said in text_of(found)


def test_the_value_is_marked_by_its_name() -> None:
    """x' = −x + 1 from 0: 1 − e^{−2} at 2."""
    file = 'task = "response"\n[plant]\nA = "[-1]"\nB = "[1]"\nC = "[1]"\n[specification]\ninput = 1\nat_time = 2\n'
    for value, verdict in (("1 - e^(-2)", "right"), ("1 - e^(-1)", "wrong")):
        report = Checked.of(file).report(f"state = 1 - e^(-t)\ny(2) = {value}")
        assert {part.part: part.verdict for part in report.parts}["response.value"] == verdict
        assert [line for line in report.lines if line.verdict == "unreadable"] == []


def test_the_value_in_a_case() -> None:
    """x' = −a x + e^{−ct} from 0: T e^{−cT} where a = c."""
    T = sympy.Symbol("T", positive=True)
    plant = StateSpace("[-a]", "[1]", "[1]", symbols={"T": "positive", "a": "real", "c": "real"})
    (case,) = symobs.response(plant, input="exp(-c*t)", at_time="T").cases
    (value,), expected = case.result.value, T * sympy.exp(-c * T)
    told = value.subs({symbol: {"a": c, "c": c, "T": T}[symbol.name] for symbol in value.free_symbols})
    assert sympy.simplify(told - expected) == 0


def test_modes_without_a_closed_form_are_undecided() -> None:
    cubic = symobs.response(StateSpace("[0 1 0; 0 0 1; -a -1 -3]", "[0; 0; 1]"), input=1)
    assert (cubic.verdict, cubic.state) == ("undecided", None)
    for language, said in (("en", "the response is not given"), ("de", "die Zeitantwort nicht angegeben")):
        assert said in cubic.to("text", language=language)


@tabled
def test_what_has_no_response_is_refused(plant: dict[str, Any], asked: dict[str, Any], said: str) -> None:
    with pytest.raises(InputError, match=said):
        symobs.response(StateSpace(**{"A": "[-1]", **plant}), **asked)


def test_what_roots_and_functions_leave_open_is_not_told_as_no() -> None:
    """On a = sqrt(c) the state (1, a) explains y = exp(a t), and where exp(a) = 1 the zero state explains y = 0."""
    plant = StateSpace("[0 1; c 0]", C="[1 0]", symbols={"a": "real", "c": "real"})
    found = symobs.initial_state(plant, output="exp(a*t)", horizon="1")
    (above,) = (case.result for case in found.cases if case.when == (c > 0,))
    assert above.verdict == "no"
    explained, *others = above.cases
    assert (str(explained.when[0].lhs), explained.result.x0) == ("a**2 - c", (1, sympy.Symbol("a")))
    assert {str(case.when[0].lhs): case.result for case in others} == {"a - sqrt(c)": None, "a + sqrt(c)": None}
    assert (found.at(a=2, c=4).verdict, found.at(a=2, c=4).x0) == ("yes", (1, 2))
    assert "is not decided here" in found.to("text")
    lag = StateSpace("[-1]", C="[1]", symbols={"a": "real"})
    (case,) = symobs.initial_state(lag, output="(exp(a) - 1)*exp(-2*t)", horizon="1").cases
    assert (str(case.when[0].lhs), case.result) == ("exp(a) - 1", None)


def test_irrational_waves_with_rational_derivatives_are_drawn() -> None:
    """The derivatives of sqrt(2) sin(sqrt(2) t) at 0 are 0, 2, 0, -4, …"""
    (picture,) = pictures(symobs.response(StateSpace("[-1]", "[1]"), input="sqrt(2)*sin(sqrt(2)*t)"))
    assert [list(map(int, start)) for start in picture.starts] == [[0], [0, 2]]
