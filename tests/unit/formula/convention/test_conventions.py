"""One mathematics in the letters and signs of several books: pages, input, expected answers, JSON."""

from __future__ import annotations

import json
import tomllib
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from symobs.exact import Matrix
from symobs.formula.convention import convention_named, conventions
from symobs.formula.convention.convention import ALIASES, read_convention
from symobs.formula.tree import (
    Apply,
    Environment,
    Exact,
    Formula,
    Letter,
    Literal,
    Negative,
    Power,
    Product,
    SignReversal,
    Sum,
    Transpose,
    evaluate,
)
from symobs.ground.errors import InputError, ProblemErrors, UsageError
from symobs.problem import parse, read, validate
from symobs.problem.expect import mismatches
from symobs.tasks.result import Document, render
from tests.kit import tabled, tables
from tests.support.sampling import every
from tests.support.tools.command_line import EXAMPLES, inside

if TYPE_CHECKING:
    from symobs.problem import Problem

#: The table that opens the catalogue: the law, the observer matrix, the pair (a dash there: as in the standard).
TABLE = tables(Path(__file__))["table"]
#: The gains of the double integrator with poles −1 ± i and −1, −2: S1 prints M = [−3; −2] and u = Kx with K = [−2 −2].
GAINS = tables(Path(__file__))["gains"]
PLANT = """
[plant]
A = "[0 1; 0 0]"
B = "[0; 1]"
C = "[1 0]"
"""
DESIGN = (
    'task = "compensator"\n' + PLANT + '[specification]\ncontrol_polynomial = "s^2+2s+2"\nobserver_poles = [-1, -2]\n'
)


def problem(text: str, convention: str, expect: dict[str, Any] | None = None) -> Problem:
    """The problem of a text, in a convention, with these expected answers."""
    return validate({**parse(text), "convention": convention, "expect": expect or {}})


def page(found: Problem, format_name: str = "text") -> str:
    return str(render(found.document(found.solve()), format_name))


def unmet(found: Problem) -> list[str]:
    return mismatches(found.viewed(found.solve()), found.expect)


def test_the_profiles_are_those_of_the_table() -> None:
    written = {name: (found.law, found.observer_matrix, found.pair) for name, found in conventions().items()}
    assert written == {ALIASES.get(name, name): tuple(laws) for name, laws in TABLE.items()}
    assert {name: convention_named(name).name for name in ALIASES} == ALIASES


@pytest.mark.parametrize("name", TABLE)
def test_one_problem_in_all_conventions(name: str) -> None:
    found = problem(DESIGN, name, GAINS[name])
    assert unmet(found) == []
    (result,) = found.solve()
    assert (str(result.answer["K"]), str(result.answer["L"])) == ("[2 2]", "[3; 2]")
    for letter, text in GAINS[name].items():
        spoiled = problem(DESIGN, name, {**GAINS[name], letter: text.replace("2", "7")})
        assert [line.split(":")[0] for line in unmet(spoiled)] == [f"expect.{letter}"]


LINES = tables(Path(__file__))["lines"]


@pytest.mark.parametrize("name", TABLE)
def test_pages_speak_the_letters_of_their_book(name: str) -> None:
    """S1's slides at 25:11 and 28:08 and S4's last section print these lines."""
    told = " ".join(page(problem(DESIGN, name)).split())
    for line in LINES[name]:
        assert " ".join(line.split()) in told
    if name in {"S1", "S4"}:
        assert "L C" not in told
        assert "(C, A)" not in told


@pytest.mark.slow
@pytest.mark.parametrize("path", every(4, EXAMPLES), ids=lambda path: path.stem)
def test_every_page_holds_in_every_convention(path: Path) -> None:
    """Each translated line is checked again before it is told."""
    found = read(path.read_text("utf-8"))
    results = found.solve()
    for name in ("S1", "S2", "S4"):
        assert render(Document(found.title, found.source, results, convention_named(name)), "text")


def test_json_and_python_stay_standard() -> None:
    (shown,) = json.loads(page(problem(DESIGN, "S1"), "json"))["results"]
    assert (shown["K"], shown["L"]) == ([["2", "2"]], [["3"], ["2"]])
    own = shown["in_convention"]
    assert (own["name"], own["K"], own["M"]) == ("plusK-plusMC", [["-2", "-2"]], [["-3"], ["-2"]])
    assert "L" not in own
    (result,) = problem(DESIGN, "S1").solve()
    assert "A + M C" in str(result.to("text", convention="S1"))
    assert "A - L C" in str(result.to("text"))


# -- the same in other letters ----------------------------------------------------------------------------------------


def matrices(rows: int, columns: int) -> st.SearchStrategy[Matrix]:
    entries = st.lists(st.integers(-3, 3), min_size=rows * columns, max_size=rows * columns)
    return entries.map(lambda found: Matrix.of([found[i * columns : (i + 1) * columns] for i in range(rows)]))


SQUARE: st.SearchStrategy[Formula] = st.recursive(
    st.sampled_from([Letter("A"), Letter("K"), Letter("L"), Literal(Matrix.of([[1, 2], [3, 4]]))]),
    lambda inner: st.one_of(
        st.builds(Negative, inner),
        st.builds(Transpose, inner),
        st.builds(lambda *terms: Sum(terms), inner, inner, inner),
        st.builds(lambda *factors: Product(factors), inner, inner),
        st.builds(Power, inner, st.integers(2, 3)),
        st.builds(lambda one: Apply("adj", one), inner),
        st.builds(lambda one: Product((Apply("det", one), one)), inner),
    ),
    max_leaves=8,
)


@given(SQUARE, matrices(2, 2), matrices(2, 2), matrices(2, 2))
def test_a_formula_is_worth_the_same_in_other_signs(formula: Formula, A: Matrix, K: Matrix, L: Matrix) -> None:
    before = Environment(values={"A": A, "K": K, "L": L})
    for names in (frozenset({"L"}), frozenset({"K", "L"})):
        after = Environment(values={"A": A, "K": -K if "K" in names else K, "L": -L})
        turned = SignReversal(names, (L, L.T, K)).whole(formula)
        assert evaluate(turned, after, Exact(after)) == evaluate(formula, before, Exact(before))


# -- a user's own -----------------------------------------------------------------------------------------------------

OWN = """
name = "lecture"
title = "our lecture"
feedback = "u = R x_hat"
observer = "A + N C"
pair = "[A, C]"
[letters]
e = "epsilon"
phi_o = "p_o"
"""


def test_a_convention_of_one_s_own(tmp_path: Path) -> None:
    (tmp_path / "lecture.toml").write_text(OWN, "utf-8")
    file = tmp_path / "problem.toml"
    expect = '[expect]\nR = "[-2 -2]"\nN = "[-3; -2]"\n'
    file.write_text('convention = "lecture"\n' + DESIGN + expect, "utf-8")
    run = inside("solve", str(file), "--format", "text")
    assert (run.code, run.err) == (0, "")
    for line in ("u = R x̂", "A + N C", "ε = x - x̂", "[A, C] is observable", "p_o(s)"):
        assert line in run.out
    latex = inside("solve", str(file), "--convention", str(tmp_path / "lecture.toml")).out
    assert r"\varepsilon" in latex or r"\epsilon" in latex
    assert inside("solve", str(file), "--convention", "S1", "--format", "text").out.count("A + M C") > 1


def test_every_error_of_a_convention_is_told_at_once() -> None:
    wrong = """
    name = "my book"
    feedback = "u = x_hat"
    observer = "A - L"
    pair = "[A, C)"
    colour = "red"
    [letters]
    ee = "x"
    e = "2"
    """
    with pytest.raises(ProblemErrors) as caught:
        read_convention(tomllib.loads(wrong), "book.toml")
    places = [error.where.removeprefix("book.toml, ") for error in caught.value.errors]
    assert places == ["colour", "name", "feedback", "observer", "pair", "letters.ee", "letters.e"]
    assert all(error.repair for error in caught.value.errors)
    with pytest.raises(ProblemErrors, match="C would stand for L and for C"):
        read_convention({"name": "b", "observer": "A + C C"}, "book.toml")


def test_a_convention_that_does_not_exist(tmp_path: Path) -> None:
    with pytest.raises(UsageError, match="use one of standard, minusK-minusLC"):
        convention_named("S9")
    with pytest.raises(ProblemErrors, match='convention: "S9" is not a convention'):
        read('convention = "S9"\n' + DESIGN)
    with pytest.raises(ProblemErrors, match="a name is expected"):
        read("convention = 4\n" + DESIGN)
    with pytest.raises(ProblemErrors, match="no convention can be read"):
        convention_named(str(tmp_path / "none.toml"))
    assert inside("solve", str(EXAMPLES[0]), "--convention", "S9").code == 2
    (tmp_path / "evil.toml").write_text("x = " + "[" * 10_000, "utf-8")
    with pytest.raises(
        ProblemErrors, match=r"evil\.toml: no convention can be read: line 1: brackets are nested more than 100"
    ):
        convention_named(str(tmp_path / "evil.toml"))
    (tmp_path / "dots.toml").write_text("a." * 9_000 + "a = 1", "utf-8")
    with pytest.raises(ProblemErrors, match="a dotted key has more than 10 parts"):  # tomllib would take 400 MB
        convention_named(str(tmp_path / "dots.toml"))
    (tmp_path / "secret.toml").write_text(OWN, "utf-8")
    for named in ("../secret", f"{tmp_path}/secret.toml.toml", "../secret.toml"):
        with pytest.raises(ProblemErrors, match="is not a convention"):
            read(f'convention = "{named}"\n' + DESIGN, folder=tmp_path / "inner")


@tabled
def test_the_letter_of_a_gain_is_a_letter(law: dict[str, str]) -> None:
    """What TeX cannot set, and what would not fit on a line, is no letter in a law either."""
    with pytest.raises(ProblemErrors, match="this cannot be read"):
        read_convention({"name": "own"} | law, "own.toml")


def test_messages_name_the_letter_of_the_file() -> None:
    with pytest.raises(ProblemErrors) as caught:
        problem('task = "observer"\n' + PLANT + '[specification]\nM = "[1 2 3]"\n', "S1").solve()
    assert caught.value.errors[0].where == "specification.M"
    with pytest.raises(ProblemErrors, match="L and M are the same gain"):
        problem('task = "observer"\n' + PLANT + '[specification]\nM = "[1; 2]"\nL = "[1; 2]"\n', "S1")
    with pytest.raises(InputError, match="unknown key"):
        problem('task = "observer"\n' + PLANT + '[specification]\nM = "[1; 2]"\n', "S0")
