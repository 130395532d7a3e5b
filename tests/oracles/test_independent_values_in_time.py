"""Every value of the pages and answers in functions of time equals a computation with SymPy and quadrature."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import pytest
import sympy

from symobs.tasks.result.output_methods import to_sympy
from tests.oracles.test_independent_values import ROOTS, VERDICTS, same
from tests.support.examples import results_of
from tests.support.problems.problems_by_hand import s
from tests.support.problems.problems_in_time import NAMES_IN_TIME, VARYING
from tests.support.problems.problems_in_time import in_time as hand_of
from tests.support.sampling import every
from tests.support.second_reader import Reader, facts_in, values_of

if TYPE_CHECKING:
    from collections.abc import Iterator

    from symobs.tasks.result import Result

pytestmark = pytest.mark.slow

#: Letters that a page in functions of time is free to choose, or that the lines which follow bind: a solution of
#: Lyapunov's equation, a vector of the kernel, a basis of it.
CHOSEN = {"P_l", "v", "N", "X"}
#: An impulse is an input that is no function of t.
NO_FUNCTION = {"impulse_response": {"u"}}


def in_time(name: str, result: Result) -> Reader:
    """Return the reader of a page in functions of time."""
    hand = hand_of(name)

    def samples() -> Iterator[dict[Any, Any]]:
        return hand.points(name, 40)

    return Reader(result.derivation, hand.letters(), samples, known_at=lambda values: hand.at(values).letters())


@pytest.mark.parametrize("name", every(4, NAMES_IN_TIME))
def test_every_line_of_every_page_in_time(name: str) -> None:
    for result in results_of(name):
        facts, reader = list(facts_in(result.derivation.steps)), in_time(name, result)
        tally = reader.read()
        assert tally.compared + len(tally.unknown) >= values_of(facts)
        assert set(tally.unknown) <= CHOSEN | NO_FUNCTION.get(name, set())
        print(f"{name}, {result.task}: {len(facts)} lines, {tally.compared} values")  # noqa: T201 - shown by pytest -s
        assert tally.compared >= len(facts) > 0


@pytest.mark.parametrize("name", every(4, NAMES_IN_TIME, 1))
def test_every_answer_in_time(name: str) -> None:
    hand = hand_of(name)
    for result in results_of(name):
        reader, expected = in_time(name, result), hand.answers(result.task)
        assert set(result.fields) - VERDICTS - {"best_horizon"} == set(expected)
        if result.answer.get("chosen"):
            signs = [(to_sympy(c.expression, {}), c.operator) for c in result.holds_where]
            reader.narrowed = signs
        for field_name, wanted in expected.items():
            found = to_sympy(result.fields[field_name], {})
            if field_name in ROOTS or not isinstance(found, (sympy.MatrixBase, sympy.Expr)):
                assert same(field_name, found, tuple(wanted) if field_name == "x0" else wanted, s, {}), field_name
            else:
                assert reader.agree(found, wanted), (name, field_name)


@pytest.mark.parametrize("name", VARYING)
def test_every_line_and_answer_where_the_plant_varies(name: str) -> None:
    (result,), known = results_of(name), VARYING[name]
    said = facts_in(result.derivation.steps)
    facts = [fact for fact in said if getattr(fact, "operators", ()) != ("!=",)]  # what is assumed has no value
    positive = [{sympy.Symbol(name): sympy.Rational(k, 3) for name in ("T", "omega")} for k in range(1, 6)]
    reader = Reader(result.derivation, known, lambda: iter(positive))
    tally = reader.read()
    assert tally.compared + len(tally.unknown) >= values_of(facts)
    assert tally.unknown == []
    fields = {"matrix": "O", "transition_matrix": "Phi", "gramian": "W", "x0": "x_0"}
    for field_name, letter in fields.items():
        if field_name in result.fields:
            found = to_sympy(result.fields[field_name], {})
            assert reader.agree(sympy.Matrix(found), known[letter]), field_name
    assert [to_sympy(block, {}) for block in result.fields["stack"]] == [known["N_0"], known["N_1"]]
    assert ("W" in known) == ("determinant" in result.fields)
    assert "W" not in known or reader.agree(to_sympy(result.fields["determinant"], {}), known["W"].det())
    assert result.fields["rank"] == known["O"].rank() == 2 - len(result.fields["kernel"])
