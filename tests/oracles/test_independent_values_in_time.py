"""Every value of the pages and answers in functions of time equals a computation with SymPy and quadrature."""

from __future__ import annotations

from itertools import islice
from typing import TYPE_CHECKING, Any

import mpmath
import pytest
import sympy

from symobs.tasks.result.output_methods import to_sympy
from tests.oracles.test_independent_values import ROOTS, VERDICTS, same
from tests.support.examples import results_of
from tests.support.problems.problems_by_hand import compare, s
from tests.support.problems.problems_in_time import NAMES_IN_TIME, VARYING
from tests.support.problems.problems_in_time import in_time as hand_of
from tests.support.sampling import every
from tests.support.second_reader import numeric, walks

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from tests.support.second_reader import Reader

pytestmark = pytest.mark.slow

#: Letters that a page in functions of time is free to choose, or that the lines which follow bind: a solution of
#: Lyapunov's equation, a vector of the kernel, a basis of it.
CHOSEN = {"P_l", "v", "N", "X"}
#: An impulse is an input that is no function of t; a step is the output of an exosystem, with which the motion is checked.
NO_FUNCTION = {"impulse_response": {"u"}, "step_response": {"u", "w_e'"}}


def points(name: str) -> list[dict[Any, Any]]:
    """Return points that the declared signs allow, with values for the times."""
    times = {
        sympy.Symbol(letter): sympy.Rational(k, 7)
        for k, letter in enumerate(("t", "t0", "sigma", "x10", "x20", "s"), 3)
    }
    return [times | point for point in hand_of(name).points(name, 40)]


def agree(found: Any, wanted: Any, points: Iterable[Mapping[Any, Any]]) -> bool:
    """Tell whether two values of SymPy are the same at three points, with 50 digits."""
    left, right = (list(part) if isinstance(part, sympy.MatrixBase) else [part] for part in (found, wanted))
    with mpmath.workdps(50):
        return len(left) == len(right) and all(
            abs(numeric(a, point) - numeric(b, point)) < mpmath.mpf(10) ** -25
            for point in islice(points, 3)
            for a, b in zip(left, right, strict=True)
        )


@pytest.mark.parametrize("name", every(4, NAMES_IN_TIME))
def test_every_line_of_every_page_in_time(name: str) -> None:
    known: dict[tuple[Any, ...], Mapping[str, Any]] = {}
    hand = hand_of(name)

    def known_to(reader: Reader) -> Mapping[str, Any]:
        point = reader.point(hand.signs) if reader.meanings.keys() & hand.signs.keys() else {}
        key = tuple(point.values())
        if key not in known:
            known[key] = hand.at(point).letters()
        return known[key]

    for result in results_of(name):
        for reader, _ in walks(result.derivation, known_to, range(3), {}):
            assert reader.compared
            assert set(reader.unknown) <= CHOSEN | NO_FUNCTION.get(name, set())


@pytest.mark.parametrize("name", every(4, NAMES_IN_TIME, 1))
def test_every_answer_in_time(name: str) -> None:
    hand = hand_of(name)
    for result in results_of(name):
        expected = hand.answers(result.task)
        assert set(result.fields) - VERDICTS - {"best_horizon"} == set(expected)
        chosen = (
            [(to_sympy(c.expression, {}), c.operator) for c in result.holds_where]
            if result.answer.get("chosen")
            else []
        )
        allowed = [p for p in points(name) if all(compare(value.subs(p), operator) for value, operator in chosen)]
        for field_name, wanted in expected.items():
            found = to_sympy(result.fields[field_name], {})
            if field_name in ROOTS or not isinstance(found, (sympy.MatrixBase, sympy.Expr)):
                assert same(field_name, found, tuple(wanted) if field_name == "x0" else wanted, s, {}), field_name
            else:
                assert agree(found, wanted, allowed), (name, field_name)


@pytest.mark.parametrize("name", VARYING)
def test_every_line_and_answer_where_the_plant_varies(name: str) -> None:
    (result,), known = results_of(name), VARYING[name]
    positive = [
        {sympy.Symbol(name): sympy.Rational(k, 3) for name in ("t", "t0", "T", "a", "b", "omega")} for k in range(1, 6)
    ]
    for reader, _ in walks(result.derivation, lambda _: known, range(3), {}):
        assert reader.compared
        assert reader.unknown == []
    fields = {"matrix": "O", "transition_matrix": "Phi", "gramian": "W", "x0": "x_0"}
    for field_name, letter in fields.items():
        if field_name in result.fields:
            found = to_sympy(result.fields[field_name], {})
            assert agree(sympy.Matrix(found), known[letter], positive), field_name
    assert [to_sympy(block, {}) for block in result.fields["stack"]] == [known["N_0"], known["N_1"]]
    assert ("W" in known) == ("determinant" in result.fields)
    assert "W" not in known or agree(to_sympy(result.fields["determinant"], {}), known["W"].det(), positive)
    assert result.fields["rank"] == known["O"].rank() == 2 - len(result.fields["kernel"])
