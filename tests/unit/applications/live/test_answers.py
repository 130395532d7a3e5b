"""The protocol: what every want returns, what is refused, and that an answer is the one of `symobs solve`."""

from __future__ import annotations

import itertools
import json
import subprocess
import sys
import tomllib
from fractions import Fraction
from pathlib import Path
from typing import Any
from urllib.parse import parse_qsl

import mpmath
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from jsonschema import Draft202012Validator  # type: ignore[import-untyped]
from scipy.signal import dstep  # type: ignore[import-untyped]
from scipy.signal import step as step_response

from symobs.applications.live import answer
from symobs.applications.live.assets import MOST_BYTES
from symobs.applications.live.request import SHORT, parsed
from symobs.applications.live.time_responses import _last_above
from symobs.pages.formats.json import result_object
from symobs.problem import validate
from symobs.tasks.result import result_type, tasks
from tests.kit import tabled, tables
from tests.support.live_link import problem_of
from tests.support.sampling import every
from tests.support.tools.command_line import EXAMPLES, SAFETY, environment

SERVO: dict[str, Any] = tables(Path(__file__))["servo"]
DETECTABLE: dict[str, Any] = tables(Path(__file__))["detectable"]
SMALL = [path for path in EXAMPLES if path.stem not in {"cart_pole", "region_three_gains"}]
_TEXT = {"type": "string"}
_CARD = {
    "type": "object",
    "properties": {"name": _TEXT, "mathml": _TEXT, "latex": _TEXT, "says": _TEXT},
    "required": ["name", "mathml"],
}
_ERROR = {"type": "object", "required": ["where", "message", "repair"], "additionalProperties": _TEXT}
_LINE = tables(Path(__file__))["line"]
SCHEMA = Draft202012Validator(
    {
        "type": "object",
        "required": ["schema", "id", "status"],
        "properties": {
            "schema": {"const": "symobs-live/1"},
            "status": {"enum": ["done", "no", "bad", "undecided", "bug"]},
            "errors": {"type": "array", "minItems": 1, "items": _ERROR},
            "cards": {"type": "array", "items": _CARD},
            "claims": {"type": "integer"},
            "courses": {
                "type": ["object", "null"],
                "required": ["end", "parts", "window", "lines"],
                "properties": {"lines": {"type": "array", "items": _LINE}},
            },
        },
    }
)


def asked(problem: object, want: str = "answer", **more: object) -> dict[str, Any]:
    """The response to a request, which keeps the schema and is JSON."""
    found = answer({"schema": "symobs-live/1", "id": 7, "want": want, "problem": problem, **more})
    SCHEMA.validate(json.loads(json.dumps(found)))
    assert found["id"] == 7
    assert more.get("moving") or all({"latex", "says"} <= card.keys() for card in found.get("cards", ()))
    return found


def data_of(path: Path) -> dict[str, Any]:
    return tomllib.loads(path.read_text("utf-8"), parse_float=str)


@pytest.mark.slow
@pytest.mark.parametrize("path", SMALL, ids=lambda path: path.stem)
def test_an_answer_is_that_of_solve(path: Path) -> None:
    data = data_of(path)
    name = data["tasks"][-1] if "tasks" in data else data["task"]
    found = asked(data, courses={"count": 9}, cases=True)
    (result,) = validate({**data, "expect": {}}, name).solve()
    own = result_object(result)
    assert found["status"] == (result.verdict if result.verdict in {"no", "undecided"} else "done")
    assert found["verdict"] == own["verdict"]
    assert found["claims"] == len(own["certificates"])
    if result.task != "equilibria":  # whose conditions are those of each point
        assert [each["text"] for each in found["conditions"]] == own["conditions"]
    assert {key: own[key] for key in found["result"]} == found["result"]
    assert len(found["cases"]) == len(own["cases"])


@pytest.mark.slow
@pytest.mark.parametrize("path", every(6, SMALL), ids=lambda path: path.stem)
def test_every_want_is_answered(path: Path) -> None:
    data = data_of(path)
    for detail in ("full", "outline", "answer"):
        assert '<div class="symobs">' in asked(data, "page", detail=detail)["html"]
    view = asked(data, "view")["view"]
    assert view["panels"]
    for form in ("latex", "toml", "python", "json", "html"):
        assert asked(data, "export", **{"as": form})["text"]
    again = asked(tomllib.loads(asked(data, "export", **{"as": "toml"})["text"], parse_float=str))
    assert again["result"] == asked(data)["result"]


def test_the_servo() -> None:
    found = asked(SERVO, cards=["K", "L", "F"], courses={"start": "1, 1", "estimate": "0, 0", "count": 129})
    assert found["result"]["K"] == [["4", "3"]]
    assert found["result"]["L"] == [["19"], ["81"]]
    assert [card["latex"] for card in found["cards"][:2]] == [
        r"K=\begin{bmatrix}4&3\end{bmatrix}",
        r"L=\begin{bmatrix}19\\81\end{bmatrix}",
    ]
    assert [card["says"] for card in found["cards"][:1]] == ["K equals [4 3]"]
    # ω = 2 and ζ = 1; ln 50 / 2 = 1.956.
    assert found["readouts"][0] == {
        "handle": "control_poles.0", "exact": "ωₙ = 2", "damping": "1", "settles": "1.96",
    }  # fmt: skip


def test_responses_are_within_their_bound() -> None:
    found = asked(SERVO, courses={"start": "1, -1/2", "estimate": "1/4, 0", "end": "3", "count": 33})
    parts, lines = found["courses"]["parts"], found["courses"]["lines"]
    loop = mpmath.matrix([[0, 1, 0, 0], [0, -1, -4, -3], [19, 0, -19, 1], [81, 0, -85, -4]])  # (x, x̂) by hand
    with mpmath.workdps(50):
        count = len(lines[0]["heights"])
        assert (count - 1) % 32 == 0
        for k in range(count):
            state = mpmath.expm(loop * mpmath.mpf(3 * k) / (count - 1)) * mpmath.matrix([1, -0.5, 0.25, 0])
            for place, line in enumerate(lines):
                assert abs(line["heights"][k] - parts * state[place]) <= 1
    assert [(line["signal"], line["component"], line["dashed"]) for line in lines] == [
        ("x", 1, False), ("x", 2, False), ("x_hat", 1, True), ("x_hat", 2, True),
    ]  # fmt: skip


@tabled
@pytest.mark.parametrize("task", ["observer", "reduced_order_observer"])
def test_roots_in_the_data_have_responses(task: str, dt: dict[str, str]) -> None:
    plant = {"A": "[0 1; sqrt(2)/4 -1/2]", "C": "[1 sqrt(3)/2]", **dt}
    poles = {"observer": "-1/2, -1/3", "reduced_order_observer": "-1/2"}[task]
    found = asked({"task": task, "plant": plant, "specification": {"poles": poles}}, courses={"end": "6", "count": 33})
    table = mpmath.matrix(
        [[_decimal(entry) for entry in row] for row in found["result"]["A" if task == "observer" else "F"]]
    )
    start = mpmath.matrix([1, 1]) if task == "observer" else None
    lines, parts = found["courses"]["lines"], found["courses"]["parts"]
    last = len(lines[0]["heights"]) - 1
    if start is None:
        start = mpmath.matrix([mpmath.mpf(line["heights"][0]) / parts for line in lines])
    for k in range(last + 1):
        state = (table**k if dt else mpmath.expm(table * mpmath.mpf(6 * k) / last)) * start
        for place, line in enumerate(lines):
            assert abs(line["heights"][k] - parts * state[place]) <= 2
    marks = sorted(float(mark["re"]) for mark in found["marks"])
    # s² + s/2 − √2/4 = 0
    assert marks == pytest.approx([-(1 + (1 + 4 * 2**0.5) ** 0.5) / 4, ((1 + 4 * 2**0.5) ** 0.5 - 1) / 4], abs=1e-6)


#: y and u after a step, as numerators over one denominator, by hand for the plant 1/(s(s + 1)): G_r and G_r s(s + 1) of the
#: compensator; 4 and 4 s(s + 1) over (s + 2)²; 12 and 12 s(s + 1) over (s + 2)²(s + 3) of the integral action.
_STEPS = {
    "compensator": ([319, 400], [2, 2, 10, 10], {"control_poles": "-2, -2", "observer_poles": "-10, -10"}),
    "feedforward": ([4], [2, 2], {"control_poles": "-2, -2", "observer_poles": "-10"} | {"observer": "minimal"}),
    "integral_action": ([12], [2, 2, 3], {"poles": "-2, -2, -3"}),
}


@pytest.mark.parametrize("task", _STEPS)
def test_output_and_input_after_a_step_of_the_reference(task: str) -> None:
    numerator, poles, specification = _STEPS[task]
    found = asked(
        {**SERVO, "task": task, "specification": specification}, courses={"step": True, "end": "4", "count": 33}
    )
    denominator = [mpmath.mpf(1)]
    for pole in poles:
        denominator = [a + pole * b for a, b in zip([*denominator, 0], [0, *denominator], strict=True)]
    for own, factor in (("y", [1]), ("u", [1, 1, 0])):
        (line,) = (found["courses"] if own == "y" else found["courses"]["effort"])["lines"]
        parts = (found["courses"] if own == "y" else found["courses"]["effort"])["parts"]
        top = np.polymul(numerator, factor)
        last = len(line["heights"]) - 1
        assert line["signal"] == own
        for k in range(1, last + 1):
            time = mpmath.mpf(4 * k) / last
            value = mpmath.invertlaplace(
                lambda s, top=top: mpmath.polyval(list(map(int, top)), s) / mpmath.polyval(denominator, s) / s, time
            )
            assert abs(line["heights"][k] - parts * value) <= 2, (own, k)
    (line,) = found["courses"]["lines"]
    assert (float(line["overshoot"]) > 0) == (task == "compensator")
    assert asked({**SERVO, "task": task, "specification": specification}, courses={})["courses"]["effort"]["lines"]


def _decimal(entry: str) -> Any:
    return eval(entry, {"sqrt": mpmath.sqrt}) + mpmath.mpf(0)  # noqa: S307 - our own answer


def test_what_moves_has_as_many_instants_as_were_asked_for_and_what_rests_those_it_needs() -> None:
    fast = {**SERVO, "specification": {"control_poles": "-1, -20", "observer_poles": "-40, -40"}}
    moving, resting = (asked(fast, moving=is_moving, courses={}) for is_moving in (True, False))
    coarse, fine = (found["courses"]["lines"] for found in (moving, resting))
    assert {len(line["heights"]) for line in coarse} == {129}
    step = (len(fine[0]["heights"]) - 1) // 128
    assert step > 1
    for slow, quick in zip(coarse, fine, strict=True):
        assert all(abs(a - b) <= 1 for a, b in zip(slow["heights"], quick["heights"][::step], strict=True))
    assert [card["mathml"] for card in moving["cards"]] == [card["mathml"] for card in resting["cards"]]
    assert not any("latex" in card for card in moving["cards"])
    assert all(card["latex"] and card["says"] for card in resting["cards"])


def test_a_deadbeat_loop_is_drawn_until_it_rests() -> None:
    """Seven poles at 0 take seven steps: A^7 = 0."""
    shift = "; ".join(" ".join("1" if j == i + 1 else "0" for j in range(7)) for i in range(7))
    plant = {"A": f"[{shift}]", "B": "[0; 0; 0; 0; 0; 0; 1]", "dt": True}
    found = asked(
        {"task": "state_feedback", "plant": plant, "specification": {"poles": "0, 0, 0, 0, 0, 0, 0"}}, courses={}
    )
    first = found["courses"]["lines"][0]["heights"]
    assert len(first) > 8
    assert first[:7] == [1000] * 7
    assert not any(first[7:])


def test_a_discrete_response_is_drawn_until_it_has_settled() -> None:
    """x(k) of a triple pole at 1/2 falls as k² 2⁻ᵏ."""
    plant = {"A": "[0 1 0; 0 0 1; 0 0 0]", "B": "[0; 0; 1]", "dt": True}
    found = asked({"task": "state_feedback", "plant": plant, "specification": {"poles": "1/2, 1/2, 1/2"}}, courses={})
    lines = [line for line in found["courses"]["lines"] if line["signal"] == "x"]
    assert all("settles" in line for line in lines)
    loop, state, peaks = np.array([[0, 1, 0], [0, 0, 1], [1 / 8, -3 / 4, 3 / 2]]), np.ones(3), list[list[float]]()
    for _ in range(60):
        peaks.append(list(abs(state)))
        state = loop @ state
    for line, course in zip(lines, np.array(peaks).T, strict=True):
        last = np.nonzero(course > 0.02 * max(course))[0][-1]
        assert last <= float(line["settles"]) <= last + 1


def test_answers_do_not_depend_on_those_before_them() -> None:
    """The plant is kept from question to question, and what was printed; the same matrices stand for several plants here."""
    from symobs.applications.live import answering, request  # noqa: PLC0415 - what they keep is emptied here
    from symobs.pages import cards  # noqa: PLC0415

    A, named = (
        {"A": "[0 1; 0 -a]", "B": "[0; 1]", "C": "[1 0]"},
        {"control_poles": "-2, -2", "observer_poles": "-3, -3"},
    )
    whole = {"task": "compensator", "plant": A, "specification": named, "symbols": {"a": "positive"}}
    problems = [
        whole,
        {**whole, "symbols": {"a": {"sign": "negative", "latex": "\\alpha"}}},
        {**whole, "convention": "u = K x_hat, A + M C"},
        {**whole, "plant": {**A, "dt": True}, "specification": {"control_poles": "0, 0", "observer_poles": "0, 0"}},
        {**whole, "symbols": {}, "constants": {"a": "2"}},
        {**whole, "task": "observer", "specification": {"poles": "-3, -3"}},
        {**whole, "language": "de"},
    ]

    def fresh(problem: dict[str, Any]) -> dict[str, Any]:
        request._plants.clear()
        answering._solved.clear()
        cards._memory.cache_clear()
        return asked(problem)

    wanted = [fresh(problem) for problem in problems]
    assert len({json.dumps(each) for each in wanted}) == len(problems)
    for order in (range(len(problems)), reversed(range(len(problems)))):
        for place in order:
            answering._solved.clear()
            assert asked(problems[place]) == wanted[place]


@tabled
def test_peak_and_settling_are_those_of_the_whole_response(poles: str) -> None:
    chain = {"A": "[0 1 0; 0 0 1; 0 0 0]", "C": "[1 0 0]"}
    found = asked({"task": "observer", "plant": chain, "specification": {"poles": poles}}, courses={})
    error = np.array([[float(Fraction(entry)) for entry in row] for row in found["result"]["A"]])
    end, count = float(found["courses"]["end"]), 40_001
    times = np.linspace(0, 2 * end, count)
    step = np.array(mpmath.expm(mpmath.matrix(error * times[1])).tolist(), float)
    states = [np.ones(3)]
    for _ in times[1:]:
        states.append(step @ states[-1])
    for line, values in zip(found["courses"]["lines"], np.array(states).T, strict=True):
        seen = values[: count // 2 + 1]
        peak = seen[np.argmax(np.abs(seen))]
        settled = times[np.nonzero(np.abs(values) > 0.02 * abs(peak))[0][-1]]
        assert float(line["peak"]) == pytest.approx(peak, rel=6e-3)
        drawn = end / (len(line["heights"]) - 1)
        assert ("settles" in line) == (settled < end)
        if settled < end:
            assert -1e-3 * end <= float(line["settles"]) - settled <= drawn + 1e-2 * settled


def test_of_a_measured_state_there_is_no_estimate() -> None:
    servo = {"A": "[0 1; 0 -1]", "B": "[0; 1]", "C": "[1 0]"}
    found = asked({"task": "feedforward", "plant": servo, "specification": {"control_poles": "-2, -2"}}, courses={})
    assert [line["signal"] for line in found["courses"]["lines"]] == ["x", "x"]


def test_a_value_takes_the_place_of_its_symbol() -> None:
    general = asked(DETECTABLE, cases=True)
    assert general["verdict"] == "conditional"
    assert [case["at"] for case in general["cases"]] == [{"c": "1/2"}, {"c": "1"}]
    there = asked(DETECTABLE, at={"c": "1"}, cards_at=True)
    assert there["status"] == "no"
    kernel = next(card for card in there["cards"] if card["name"] == "kernel")
    assert kernel["says"] == "N equals [-1; 1]"  # C x = x₁ + x₂ = 0
    assert asked(DETECTABLE, at={"c": "1"}, cards_at=True, cases=True)["cases"] == general["cases"]


@tabled
def test_a_value_that_cannot_be_is_refused(at: dict[str, object], where: str, message: str) -> None:
    found = asked(DETECTABLE, at=at)
    assert found["status"] == "bad"
    assert found["errors"][0]["where"].startswith(where)
    assert message in found["errors"][0]["message"]


@pytest.mark.parametrize("poles", ["-1e400+2i, -1e400-2i", "-1e-400+1e-400i, -1e-400-1e-400i", "-1e400, -2"])
def test_what_no_screen_can_draw_is_undecided(poles: str) -> None:
    specification = {"control_poles": poles, "observer_poles": "-3, -4"}
    found = answer({"schema": "symobs-live/1", "problem": {**SERVO, "specification": specification}})
    assert (found["status"], found["message"]) == ("undecided", "a number is too large or too small to be drawn")


def test_goals_are_held_against_poles_and_gains() -> None:
    poles = {"control_poles": "-2, -2", "observer_poles": "-5+5i, -5-5i"}
    # The modes settle in ln 50 / 2 = 1.956, the pair overshoots by 100 e^(-π) = 4.32 %, L = (9, 41).
    met = {"settling": "1.96", "overshoot": "4.33", "gain": "41"}
    missed = {"settling": "1.95", "overshoot": "4.32", "gain": "40.99"}
    found: dict[str, Any] = {}
    for goal, expected in ((met, True), (missed, False)):
        found = asked({**SERVO, "specification": poles}, goal=goal)["goal"]
        assert {name: each["met"] for name, each in found.items()} == dict.fromkeys(goal, expected)
    found = asked({**SERVO, "specification": poles}, goal=missed)["goal"]
    assert float(found["settling"]["re"]) == pytest.approx(-np.log(50) / 1.95, rel=1e-5)
    assert float(found["overshoot"]["slope"]) == pytest.approx(-np.pi / np.log(0.0432), rel=1e-5)
    # after a step F(s)G(s)/(1 + F(s)G(s)) has a zero, and overshoots although its poles do not: here from SciPy
    told = asked(SERVO, goal={"settling": "2.3", "overshoot": "4"}, courses={"step": True})["goal"]
    times, heights = step_response(([319, 400], [1, 24, 184, 480, 400]), T=np.linspace(0, 12, 120_001))
    late = times[np.nonzero(abs(heights - 1) > max(abs(heights - 1)) / 50)[0][-1]]
    assert {name: each["met"] for name, each in told.items()} == {
        "settling": False,
        "overshoot": True,
        "reference": True,
    }
    assert float(told["overshoot"]["value"]) == pytest.approx(100 * (max(heights) - 1), abs=6e-3)
    assert float(told["settling"]["value"]) == pytest.approx(late, rel=0.01)
    # modes close to each other have not settled where the slowest one alone has: K = (65/4, 7), L = (19, 81)
    told = asked(
        {**SERVO, "specification": {**poles, "control_poles": "-4+i/2, -4-i/2", "observer_poles": "-10, -10"}},
        goal={"settling": "1.6", "overshoot": "15"},
        courses={"step": True},
    )["goal"]
    loop = np.array([[0, 1, 0, 0], [0, -1, -65 / 4, -7], [19, 0, -19, 1], [81, 0, -81 - 65 / 4, -8]])
    system = (loop, np.array([[0], [0], [-19], [-81]]), np.array([[1, 0, 0, 0]]), np.array([[0]]))
    times, heights = step_response(system, T=np.linspace(0, 6, 120_001))
    late = times[np.nonzero(abs(heights - 1) > max(abs(heights - 1)) / 50)[0][-1]]
    assert {name: each["met"] for name, each in told.items()} == {
        "settling": False,
        "overshoot": True,
        "reference": True,
    }
    assert float(told["overshoot"]["value"]) == pytest.approx(100 * (max(heights) - 1), abs=6e-2)
    assert float(told["settling"]["value"]) == pytest.approx(late, rel=0.01)
    # where a mode grows nothing settles, and where the peak is an undershoot or the final value 0 nothing is read off
    double: dict[str, Any] = {"task": "feedforward", "plant": {"A": "[0 1; 0 0]", "B": "[0; 1]", "C": "[1 0]"}}
    lag = {"A": "[0 1; -1 -1]", "B": "[0; 1]", "C": "[0 1]"}
    for plant, placed, outcome in (
        (double["plant"], "-1/10+12i, -1/10-12i", None),
        (double["plant"], "1/10+3i, 1/10-3i", False),
        (double["plant"], "1, -2", False),
        (double["plant"] | {"C": "[-1/5 1]"}, "-1/2+3i, -1/2-3i", None),
        (lag, "-1+5i, -1-5i", None),
    ):
        problem = {**double, "plant": plant, "specification": {"control_poles": placed}}
        if plant is lag:
            problem |= {"task": "compensator", "specification": {"control_poles": placed, "observer_poles": "-3, -4"}}
        told = asked(problem, goal={"overshoot": "10", "phase": "30"}, courses={"step": True})["goal"]
        assert told["overshoot"]["met"] is outcome
        assert told["phase"].keys() >= {"met", "value"}
    for wrong, where in (({"gain": "0"}, "goal.gain"), ({"gain": 1}, "goal"), ({"speed": "1"}, "goal")):
        assert asked(SERVO, goal=wrong)["errors"][0]["where"] == where


_LOOPS: dict[str, tuple[dict[str, Any], dict[str, str]]] = {
    "compensator": (SERVO["plant"], SERVO["specification"]),
    "state_feedback": (
        {"A": "[0 1 0; 0 0 1; 0 -2 -3]", "B": "[0; 0; 1]"},
        {"poles": "-2+2*sqrt(3)*j, -2-2*sqrt(3)*j, -10"},
    ),
    "observer": ({"A": "[3 1; 0 1/4]", "C": "[1 0]", "dt": 1}, {"poles": "1/2, 1/3"}),
}


@pytest.mark.parametrize("seed", range(20))
def test_where_y_ends_after_a_step_is_a_goal(seed: int) -> None:
    draw = np.random.default_rng(seed)
    order, sampled = 2 + seed % 3, seed % 4 == 3
    poles = {
        name: [Fraction(int(k), 20) if sampled else -Fraction(int(k), 2) for k in draw.integers(1, 12, order)]
        for name in ("control_poles", "observer_poles")
    }
    rank, a, b, c = 0, np.eye(order, dtype=int), np.eye(order, 1, dtype=int), np.eye(1, order, dtype=int)
    while rank < 2 * order:
        a = draw.integers(-2, 3, (order, order))
        a[:, 0] *= seed % 5 != 0  # an integrator, and y ends at r
        powers = [np.linalg.matrix_power(a, k) for k in range(order)]
        rank = sum(map(np.linalg.matrix_rank, (np.hstack([p @ b for p in powers]), np.vstack([c @ p for p in powers]))))
        b, c = (draw.integers(-2, 3, shape) for shape in ((order, 1), (1, order))) if rank < 2 * order else (b, c)
    written = {
        name: f"[{'; '.join(' '.join(str(int(entry)) for entry in row) for row in table)}]"
        for name, table in zip("ABC", (a, b, c), strict=True)
    }
    plant = {**written, **({"dt": 1} if sampled else {})}
    problem = {
        "task": "compensator",
        "plant": plant,
        "specification": {name: ", ".join(map(str, values)) for name, values in poles.items()},
    }
    told = asked(problem, courses={"step": True})
    assert told["status"] == "done"
    k, gain = (np.array([[float(Fraction(x)) for x in row] for row in told["result"][name]]) for name in "KL")
    loop = np.block([[a, -b @ k], [gain @ c, a - b @ k - gain @ c]])
    entering = np.vstack([np.zeros((order, 1)), -gain])
    row = np.hstack([c, np.zeros((1, order))])
    if sampled:
        _, heights = dstep((loop, entering, row, np.zeros((1, 1)), 1), n=400)
        end = heights[0][-1, 0]
    else:
        _, heights = step_response((loop, entering, row, np.zeros((1, 1))), T=np.linspace(0, 60, 3001))
        end = heights[-1]
    (shown,) = told["courses"]["ends"]
    assert float(shown) == pytest.approx(end, rel=6e-3, abs=1e-4)
    assert told["goal"]["reference"] == {"met": bool(abs(end - 1) < 1e-9), "value": shown}
    assert float(told["courses"]["window"][1][1]) >= 1  # the reference is in the picture


def test_where_a_loop_is_not_stable_y_ends_nowhere() -> None:
    told = asked(
        {**SERVO, "specification": {"control_poles": "1, -2", "observer_poles": "-3, -4"}}, courses={"step": True}
    )
    assert told["goal"]["reference"] == {"met": False, "value": ""}


def test_the_largest_gain_is_said_beside_its_limit() -> None:
    told = asked(
        {**SERVO, "specification": {"control_poles": "-2, -2", "observer_poles": "-10, -10"}}, goal={"gain": "80"}
    )
    assert told["goal"]["gain"] == {"met": False, "value": "81"}  # K = (4, 3), L = (19, 81)


def test_a_root_is_no_letter_of_a_region() -> None:
    plant = {"A": "[0 1; sqrt(2) -1]", "B": "[0; 1]", "C": "[1 0]"}
    problem, _ = problem_of(asked({**SERVO, "plant": plant}, "begin", task="stability_region")["link"])
    assert problem["specification"]["parameters"] == "k1, k2"
    assert set(problem["symbols"]) == {"k1", "k2"}
    problem["specification"]["parameters"] = ["k1", "k2"]
    (error,) = asked(problem)["errors"]
    assert error["message"].startswith("the data contain sqrt(2)")


def _table(text: str) -> Any:
    return np.array([[float(Fraction(entry)) for entry in row.split()] for row in text.strip("[]").split(";")])


@pytest.mark.parametrize("task", _LOOPS)
def test_the_frequency_response_is_that_of_the_loop(task: str) -> None:
    plant, specification = _LOOPS[task]
    told = asked({"task": task, "plant": plant, "specification": specification}, loop="rest", goal={"phase": "60"})
    a, *others = (_table(plant[name]) for name in "ABC" if name in plant)
    gains = [np.array(told["result"][name], dtype=object) for name in "KL" if name in told["result"]]
    k, *rest = (np.vectorize(lambda entry: float(Fraction(entry)))(gain) for gain in gains)
    if task == "compensator":
        b, c, gain = *others, *rest
        a = np.block([[a, 0 * a], [gain @ c, a - b @ k - gain @ c]])
        b, c = np.vstack([b, 0 * b]), np.hstack([0 * k, k])
    else:
        b, c = (others[0], k) if task == "state_feedback" else (k, others[0])

    def loop_at(frequency: float) -> complex:
        s = np.exp(1j * frequency) if "dt" in plant else 1j * frequency
        return complex((c @ np.linalg.solve(s * np.eye(len(a)) - a, b)).item())

    loop = told["loop"]
    low, high = map(float, loop["magnitude"]["window"][0])
    phases = loop["phase"]["lines"][0]["heights"]
    for place, magnitude in enumerate(loop["magnitude"]["lines"][0]["heights"]):
        value = loop_at(10 ** (low + (high - low) * place / (len(phases) - 1)))
        assert magnitude / 1000 == pytest.approx(20 * np.log10(abs(value)), abs=2e-3)
        assert np.exp(1j * np.pi * phases[place] / 180000) == pytest.approx(value / abs(value), abs=1e-4)
    assert max(abs(one - other) for one, other in itertools.pairwise(phases)) < 30_000
    values = np.array([loop_at(frequency) for frequency in np.logspace(low, high, 20001)])
    crossed = np.nonzero(np.diff(np.sign(abs(values) - 1)))[0]  # the angle to −1 where the locus meets the unit circle
    margin = min(abs(np.degrees(np.angle(-values[crossed]))))
    assert told["goal"]["phase"] == {"met": margin > 60, "value": f"{margin:.3g}"}
    assert float(loop["says"].rpartition("≈ ")[2].rstrip("°")) == pytest.approx(margin, abs=0.05)


def test_a_value_keeps_the_declared_sign() -> None:
    problem = {**DETECTABLE, "symbols": {"c": "positive"}}
    found = asked(problem, at={"c": "-1"}, cards_at=True)
    assert [error["message"] for error in found["errors"]] == ["c is positive"]
    assert asked(problem, at={"c": "2"}, cards_at=True)["status"] == "done"


def test_the_stability_of_a_point_is_exact() -> None:
    # s³ + 2 s² + 3 s + k is stable exactly for 0 < k < 6; at 6 it is (s + 2)(s² + 3).
    specification = {"polynomial": "s^3 + 2 s^2 + 3 s + k", "parameters": ["k"]}
    problem = {"task": "stability_region", "specification": specification, "symbols": {"k": "real"}}
    verdicts = {k: asked(problem, "point", at={"k": k})["verdict"] for k in ("0", "1/1000000", "6", "5999999/1000000")}
    assert verdicts == {"0": "boundary", "1/1000000": "stable", "6": "boundary", "5999999/1000000": "stable"}
    edge = asked(problem, "point", at={"k": "6"})
    assert edge["boundary"][0]["latex"] == "k-6=0"
    for root, true in zip(sorted(edge["roots"], key=lambda r: float(r["re"][0])), (-2, 0, 0), strict=True):
        assert float(root["re"][0]) <= true <= float(root["re"][1])
    pair = [root for root in edge["roots"] if float(root["im"][0]) > 0]
    assert len(pair) == 1
    assert float(pair[0]["im"][0]) ** 2 <= 3 <= float(pair[0]["im"][1]) ** 2
    assert asked(problem, "point", at={})["errors"][0]["message"] == "a value is missing for k"


@tabled
def test_a_request_that_cannot_be_is_refused_at_its_place(change: dict[str, Any], where: str) -> None:
    found = asked(SERVO, **{"courses": {}, **change}) if "problem" not in change else asked(change["problem"])
    if "schema" in change or "want" in change:
        found = answer({"schema": "symobs-live/1", "id": 7, "problem": SERVO, **change})
    assert found["status"] == "bad"
    assert where in [error["where"] for error in found["errors"]]


def test_the_size_of_a_request_is_bounded() -> None:
    for body in (b" " * (MOST_BYTES + 1), b"[" * 5000, b"\xff", b"{", b'{"a": 1' + b"0" * 5000 + b"}"):
        with pytest.raises(Exception, match=r"longer|JSON|UTF-8"):
            parsed(body)
    deep: Any = "x"
    for _ in range(30):
        deep = [deep]
    assert "nested" in asked({**SERVO, "text": deep})["errors"][0]["message"]


_LEAVES = st.none() | st.booleans() | st.integers() | st.floats() | st.text(max_size=30)
_ANY = st.recursive(_LEAVES, lambda s: st.lists(s, max_size=4) | st.dictionaries(st.text(max_size=12), s, max_size=4))
_KEYS = st.sampled_from(["want", "problem", "task", "at", "cards", "courses", "detail", "as", "cases", "id", "format"])


@settings(max_examples=100, deadline=None)
@given(_ANY | st.dictionaries(_KEYS, _ANY, max_size=6))
def test_no_request_is_a_bug(request: Any) -> None:
    whole = {"schema": "symobs-live/1", "problem": SERVO, **request} if isinstance(request, dict) else request
    found = answer(whole)
    assert found["status"] in {"bad", "done", "no"}
    SCHEMA.validate(json.loads(json.dumps(found, allow_nan=False)))


@settings(max_examples=60, deadline=None)
@given(
    st.sampled_from(["A", "B", "C", "control_poles", "observer_poles"]), st.text("01a-+*/^()[];, .i'\"\\", max_size=14)
)
def test_no_text_of_a_user_is_a_bug(key: str, text: str) -> None:
    table = "plant" if len(key) == 1 else "specification"
    found = answer({"schema": "symobs-live/1", "problem": {**SERVO, table: {**SERVO[table], key: text}}, "courses": {}})
    assert found["status"] in {"bad", "done", "no", "undecided"}


def test_an_answer_imports_nothing_heavy() -> None:
    code = f"""
import sys
from symobs.applications.live import answer
found = answer({{"schema": "symobs-live/1", "problem": {SERVO!r}, "courses": {{}}}})
assert found["status"] == "done", found
print(*sys.modules, sep="\\n")
"""
    run = subprocess.run(
        [sys.executable, "-c", code], env=environment(), capture_output=True, text=True, timeout=SAFETY, check=True
    )
    heavy = {"sympy", "numpy", "jinja2", "click", "mpmath", "http.server", "multiprocessing", "matplotlib"}
    assert set(run.stdout.split()) & heavy == set()


#: Beside the plant of an empty page: of two inputs and outputs, of letters, without input or output, in discrete time.
_PLANTS: list[dict[str, Any]] = tables(Path(__file__))["plants"]
_SHOWN = {"task": "observer", "specification": {"poles": "-4, -4"}}


@pytest.mark.parametrize("task", sorted(tasks()))
def test_every_task_begins_with_a_working_default_and_a_sentence(task: str) -> None:
    for shown in ({}, SERVO, *({**_SHOWN, **plant} for plant in _PLANTS)):
        problem, _ = problem_of(asked(shown, "begin", task=task)["link"])
        found = asked(problem)
        if shown in ({}, SERVO):
            expected = "no" if task == "lyapunov" else "done"  # the servo has a pole at 0
            assert found["status"] == expected, (shown, found)
            assert found["cards"] or task in {
                "equilibria",
                "lyapunov",
                "margins",
                "root_locus",
            }  # the sentence is the answer
        if found["status"] == "bad":  # only what the plant itself does not allow
            assert {error["where"].partition(".")[0] for error in found["errors"]} <= {"plant", "design"}, (
                shown,
                found,
            )
        else:
            assert found["says"][0].isupper(), (shown, found)


@tabled
def test_an_answer_is_said_in_a_sentence(
    task: str, plant: dict[str, str], specification: dict[str, str], says: str
) -> None:
    assert asked({"task": task, "plant": plant, "specification": specification})["says"] == says


def test_inequalities_are_among_the_answers() -> None:
    # s³ + 2 s² + 3 s + k is stable exactly for 0 < k < 6.
    specification = {"polynomial": "s^3 + 2 s^2 + 3 s + k", "parameters": ["k"]}
    found = asked({"task": "stability_region", "specification": specification, "symbols": {"k": "real"}})
    assert [card["latex"] for card in found["cards"] if card["name"].startswith("stable_if")] == ["0<k<6"]


@pytest.mark.parametrize("task", ["lqr", "kalman", "compensator", "margins", "feedforward"])
def test_a_task_of_a_file_has_the_gains_of_the_tasks_before_it(task: str) -> None:
    """K = [1 √3] of the double integrator with unit weights, from s⁴ + s² + 1 = (s² + √3 s + 1)(s² − √3 s + 1) and P."""
    problem = {
        "tasks": ["lqr", "kalman", "compensator", "margins", "feedforward"],
        "plant": {"A": "[0 1; 0 0]", "B": "[0; 1]", "C": "[1 0]"},
        "specification": {"lqr": {"Q": "1", "R": "1"}, "kalman": {"W": "1", "V": "1"}},
    }
    found: Any = answer({"schema": "symobs-live/1", "id": 1, "want": "answer", "problem": problem, "task": task})
    assert (found["status"], found["result"]["task"]) == ("done", task)
    if task == "compensator":
        assert found["result"]["K"] == [["1", "sqrt(3)"]]


def test_the_start_names_tasks_and_examples() -> None:
    found = answer({"schema": "symobs-live/1", "want": "start"})
    assert len(json.dumps(found)) < 2**20
    assert {"compensator", "observer"} <= found["tasks"].keys()
    names = {example["name"] for example in found["examples"]}
    assert "output_feedback_servo" in names
    panelled = {name for name in tasks() if result_type(name).panels}
    assert panelled - {"controllability"} <= {example["task"] for example in found["examples"]}
    for example in found["examples"]:
        told = dict(parse_qsl(example["link"]))
        assert told.pop("task") == example["task"]
        assert told.keys() - {SHORT.get(key, key) for key in found["tasks"][example["task"]]} <= {
            "v", "A", "B", "C", "D", "transfer_function", "dt", "delay", "symbols", "convention", "H",
        }  # fmt: skip  # H is L in the letters of one convention


@pytest.mark.parametrize("task", sorted(tasks()))
def test_the_sentence_of_every_task_is_german_on_a_german_page(task: str) -> None:
    link = asked({"language": "de"}, "begin", task=task)["link"]
    assert "language=de" in link
    problem, _ = problem_of(link)
    german, english = asked(problem), asked({**problem, "language": "en"})
    assert german["status"] == english["status"] != "bad"
    assert german["says"][0].isupper()
    assert german["says"] != english["says"]
    assert german["cards"] or task in {"equilibria", "lyapunov", "margins", "root_locus"}  # no matrix answers them


@tabled
def test_poles_follow_a_given_gain(
    task: str, specification: dict[str, str], moved: list[str], poles: dict[str, list[list[int]]]
) -> None:
    problem = {"task": task, "plant": SERVO["plant"], "specification": specification}
    view, found = asked(problem, "view")["view"], asked(problem)
    assert [group["gain"] for group in view["sets"]] == moved
    assert view["given"] == [name for name in "KL" if name in specification]
    told: dict[str, list[list[float]]] = {}
    for mark in found["marks"]:
        if mark["kind"] not in {"plant", "F"}:
            told.setdefault(mark["kind"], []).append([float(mark["re"]), float(mark["im"])])
    assert {kind: sorted(places) for kind, places in told.items()} == poles


def test_goals_are_held_against_the_poles_of_a_given_gain() -> None:
    # K = (1/4, 0) leads to a double pole at −1/2, whose modes settle in 2 ln 50 = 7.82 whatever the observer does
    specification = {"K": "[1/4 0]", "observer_poles": "-10, -10"}
    found = asked({**SERVO, "specification": specification}, goal={"settling": "5"})["goal"]["settling"]
    assert found["met"] is False
    assert found["value"] == "7.82"


def test_poles_of_an_optimal_loop_follow_the_weight() -> None:
    # s^4 + q for the double integrator: for q = 4 the stable roots are -1 ± i.
    plant = {"A": "[0 1; 0 0]", "B": "[0; 1]"}
    problem = {
        "task": "lqr",
        "plant": plant,
        "specification": {"Q": "[q 0; 0 0]", "R": "1"},
        "symbols": {"q": "positive"},
    }
    marks = [mark for mark in asked(problem, at={"q": "4"}, cards_at=True)["marks"] if mark["kind"] == "loop"]
    assert sorted((float(mark["re"]), float(mark["im"])) for mark in marks) == [(-1, -1), (-1, 1)]


@given(st.lists(st.integers(-60, 60), min_size=3, max_size=12), st.integers(0, 80), st.booleans())
def test_the_last_segment_above_a_band_is_the_last_of_all(line: list[int], band: int, is_continuous: bool) -> None:  # noqa: FBT001
    """Each segment bulges by an eighth of the larger second difference at its ends, rounded up; an end has none."""
    second = [a - 2 * b + c for a, b, c in zip(line, line[1:], line[2:], strict=False)]
    bends = [second[0], *second, second[-1]]
    bulges = [max(abs(a), abs(b)) // 8 + 1 if is_continuous else 0 for a, b in itertools.pairwise(bends)]
    most = [max(abs(a), abs(b)) + bulge for a, b, bulge in zip(line, line[1:], bulges, strict=False)]
    wanted = max((k + 1 for k, each in enumerate(most) if each > band), default=0)
    assert _last_above(band, line, is_continuous=is_continuous) == wanted
