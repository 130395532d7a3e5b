"""The audit: equations in the letters of a source, what is wrong with them, and the reason."""

from __future__ import annotations

import decimal
import json
from fractions import Fraction
from pathlib import Path
from typing import TYPE_CHECKING

import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from symobs.applications.audit import audit, report
from symobs.applications.audit.equations import read_relation
from symobs.ground.errors import BudgetExceeded, CertificateRejected, ProblemErrors, SymobsError
from symobs.problem import read
from tests.kit import tabled, tables
from tests.support.problems.printed import finding, findings, problem
from tests.support.tools.command_line import inside

if TYPE_CHECKING:
    from symobs.formula.expression.syntax import SyntaxNode

# Of the servo 1/(s (s + 1)) with observer poles -10, -10, worked out by hand: L = [19; 81].
RIGHT = tables(Path(__file__))["right"]


@pytest.mark.parametrize("relation", RIGHT)
def test_what_is_right_is_not_reported(relation: str) -> None:
    assert findings(relation) == []


@tabled
def test_what_is_wrong_is_named_with_what_is_right(relation: str, right: str, reason: str) -> None:
    found = finding(relation)
    assert found.right == right
    assert reason in found.reason


def test_an_output_of_a_time_varying_plant_may_be_written_in_either_way() -> None:
    plant = {"A": "[0 1; 0 0]", "C": "[exp(-t) 0]"}
    printed = [{"relation": f"y = [{entry} 0] x"} for entry in ("exp(-t)", "1/exp(t)", "exp(-2*t)")]
    text = problem(tasks=["time_varying_observability"], plant=plant, specification={}, printed=printed)
    assert [found.printed for found in audit(read(text)).wrong] == ["y = [exp(-2 t) 0] x"]


@pytest.mark.parametrize(
    ("let", "relation", "wrong"),
    [
        ({"e": "x_hat - x"}, "e' = (A - L C) e", 0),
        ({"e": "x_hat - x"}, "e' = (A + L C) e", 1),
        ({"e": "x_hat - x"}, "x_hat = x - e", 1),
        ({"x_hat": "x - e"}, "e = x - x_hat", 0),
        ({"x_1": "[1 0] x"}, "y = x_1", 0),
    ],
    ids=str,
)
def test_a_letter_may_be_said_in_the_letters_that_stand_on_it(let: dict[str, str], relation: str, wrong: int) -> None:
    assert len(audit(read(problem(printed=[{"relation": relation, "let": let}]))).findings) == wrong


@pytest.mark.parametrize(
    ("relation", "reason"),
    [
        ("place(A, B, s+1) = [1 1]", "s + 1 is no polynomial of degree 2 that begins with 1"),
        ("place(A, B, A) = [0 0]", "A is 2x2, where a number belongs"),
        ("integral(t, t, 0, [1 2]) = 1/2", "[1 2] is 1x2, where a number belongs"),
    ],
)
def test_a_function_takes_what_it_is_defined_for(relation: str, reason: str) -> None:
    assert finding(relation).reason == reason


def test_an_integral_over_a_pole_is_none() -> None:
    with pytest.raises(ProblemErrors, match="may have a pole between the ends"):
        findings("integral(1/t^2, t, -1, 1) = -2")


def test_where_a_function_has_no_value_its_inverse_is_not_proposed() -> None:
    assert finding("P(-1) = 0").reason == "P(-1) has no value"  # P = 1/(s (s + 1))


def test_each_link_of_a_chain_is_checked() -> None:
    left, right = findings("A - L C = [-19 1; -81 1] = [-19 1; -81 -1]")
    assert left.right == "A - L C = [-19 1; -81 -1]"
    assert "entry (2, 2)" in left.reason
    assert right.printed == "[-19 1; -81 1] = [-19 1; -81 -1]"


# -- every convention in its letters -----------------------------------------------------------------------------------


@tabled
def test_a_convention_has_its_own_letters_and_signs(convention: str, relation: str) -> None:
    assert findings(relation, convention=convention) == []


@tabled
def test_the_sign_of_the_law_is_the_convention_s(convention: str, law: str, closed: str) -> None:
    servo = {"tasks": ["compensator"], "specification": {"control_poles": [-2, -2], "observer_poles": [-10, -10]}}
    assert findings(law, closed, convention=convention, **servo) == []
    turned = law.replace("= -", "= ") if "-" in law else law.replace("= ", "= -")
    assert finding(turned, convention=convention, **servo).right == law


# -- spoiled values ------------------------------------------------------------------------------------------------


SPOILED = [each for each in RIGHT[:5] if each != RIGHT[0]] + ["L = [19; 81]"]


@given(st.data())
@settings(deadline=None, max_examples=40)
def test_exactly_the_entry_that_is_spoiled_is_reported(data: st.DataObject) -> None:
    relation = data.draw(st.sampled_from(SPOILED))
    left, _, matrix = relation.partition(" = ")
    rows = [[Fraction(cell) for cell in row.split()] for row in matrix.strip("[]").split(";")]
    i, j = data.draw(st.integers(0, len(rows) - 1)), data.draw(st.integers(0, len(rows[0]) - 1))
    right = rows[i][j]
    rows[i][j] = data.draw(st.fractions(-200, 200, max_denominator=9))
    assume(rows[i][j] != right)
    printed = "; ".join(" ".join(map(str, row)) for row in rows)
    found = finding(f"{left} = [{printed}]")
    assert found.right == relation
    assert found.reason.startswith(f"entry ({i + 1}, {j + 1}) is {right}, not {rows[i][j]}")
    assert ";" not in found.reason
    assert found.reason.endswith("the sign is wrong") == (rows[i][j] == -right)


@given(
    value=st.fractions(-(10**6), 10**6, max_denominator=10**4),
    places=st.integers(0, 4),
    power=st.integers(-3, 5),
)
@settings(deadline=None, max_examples=60)
def test_decimals_may_be_rounded_but_not_truncated(value: Fraction, places: int, power: int) -> None:
    shifted = decimal.Context(prec=60).divide(decimal.Decimal(value.numerator), decimal.Decimal(value.denominator))
    shifted = shifted.scaleb(-power)
    unit = decimal.Decimal(1).scaleb(-places)
    context = decimal.Context(prec=60)
    rounded = shifted.quantize(unit, decimal.ROUND_HALF_EVEN, context)
    truncated = shifted.quantize(unit, decimal.ROUND_DOWN, context)
    dot = "" if places else "."
    assert findings(f"[7 x_0] = [7 {rounded:f}{dot}e{power}]".replace("x_0", f"({value})")) == []
    if truncated != rounded and abs(shifted - truncated) * 2 != unit:  # of a half either neighbour will do
        (found,) = findings(f"[7 ({value})] = [7 {truncated:f}{dot}e{power}]")
        assert found.reason.endswith("truncated, not rounded")
        assert decimal.Decimal(found.right.split()[-1].strip("]")) == rounded.scaleb(power)


def test_both_neighbours_of_a_half_are_rounded() -> None:
    assert findings("[7 1/8] = [7 0.12]", "[7 1/8] = [7 0.13]") == []
    assert len(findings("[7 1/8] = [7 0.11]")) == 1


# -- whatever is printed -----------------------------------------------------------------------------------------------


LETTERS: list[str] = tables(Path(__file__))["letters"]
SHAPES = ["{}'", "-{}", "{}^-1", "{}^2", "det({})", "rank({})", "size({})", "({} + {})", "{} {}", "[{} {}]", "[{}; {}]"]
SHAPES += ["{} - {}", "{}/{}", "ctrb({}, {})", "obsv({}, {})", "eigenvalues({})", "rref({})", "place({}, {}, {})"]


@st.composite
def expressions(draw: st.DrawFn, depth: int = 3) -> str:
    if depth == 0 or draw(st.booleans()):
        return draw(st.sampled_from(LETTERS))
    shape = draw(st.sampled_from(SHAPES))
    return shape.format(*(f"({draw(expressions(depth=depth - 1))})" for _ in range(shape.count("{}"))))


@pytest.mark.slow
@given(expressions(), expressions())
@settings(deadline=None, max_examples=60)
def test_nothing_that_is_printed_breaks_the_audit(left: str, right: str) -> None:
    try:
        found = findings(f"{left} = {right}")
    except SymobsError:
        return
    assert all(each.printed and (each.right or each.reason) for each in found)
    assert findings(*(each.right for each in found if each.right)) == []  # what is said to be right is right


@given(expressions(), expressions())
@settings(deadline=None, max_examples=80)
def test_an_equation_is_written_as_it_is_read(left: str, right: str) -> None:
    members = read_relation(f"{left} = {right}", "")
    assert read_relation(" = ".join(map(str, members)), "") == members


@pytest.mark.parametrize(
    "relation",
    [
        "((((s^12)^12)^12)^12)^12 = 1",
        "((((((2^12)^12)^12)^12)^12)^12)^12 = 1",
        "L = [" + "1 " * 900 + "]",
        "[" * 101 + "1" + "]" * 101 + " = 1",
        "(" * 900 + "A" + ")" * 900 + " = A",
        "A = " + "A+" * 400 + "A",
        "A = A^99",
    ],
)
def test_what_would_build_too_much_is_refused(relation: str) -> None:
    with pytest.raises(ProblemErrors):
        findings(relation)


def test_a_false_equation_is_never_said_to_be_right(monkeypatch: pytest.MonkeyPatch) -> None:
    def lie(left: SyntaxNode, _right: SyntaxNode, *_: object) -> tuple[SyntaxNode, SyntaxNode, str]:
        return left, left.parts[0], "no reason"

    monkeypatch.setattr("symobs.applications.audit.auditor.found_slip", lie)
    with pytest.raises(ProblemErrors, match="does not hold") as raised:
        findings("A + L C = A - B C")
    assert isinstance(raised.value.errors[0], CertificateRejected)


# -- files that cannot be read -----------------------------------------------------------------------------------------


@tabled
def test_an_entry_that_cannot_be_read_says_where_and_what_to_write(entry: dict[str, object], says: str) -> None:
    with pytest.raises(ProblemErrors) as raised:
        audit(read(problem(printed=[entry])))
    assert says in str(raised.value)


@pytest.mark.parametrize("relation", ["A" + "'" * 1990, "2*" + "-" * 1990 + "A", "A" + "^2" * 990, "1" + "-1" * 990])
def test_a_deep_equation_is_refused(relation: str) -> None:
    with pytest.raises(BudgetExceeded, match="more than 200 parts"):
        read_relation(relation, "")


# -- the command -------------------------------------------------------------------------------------------------------


@pytest.fixture
def files(tmp_path: Path) -> dict[str, str]:
    texts = {
        "right": problem("L = [19; 81]"),
        "wrong": problem("L = [19; 82]"),
        "bad": problem("L = ", "zork = "),
        "worse": '{"title": 3}',
    }
    for name, text in texts.items():
        (tmp_path / f"{name}.json").write_text(text, "utf-8")
    return {name: str(tmp_path / f"{name}.json") for name in texts}


def test_nothing_wrong_is_0_and_findings_are_4(files: dict[str, str]) -> None:
    fine, found = inside("audit", files["right"]), inside("audit", files["right"], files["wrong"])
    assert (fine.code, fine.out, fine.err) == (0, "1 printed equation, nothing wrong.\n", "")
    assert (found.code, found.err) == (4, "")
    assert files["wrong"] in found.out
    assert files["right"] not in found.out
    assert "entry (2, 1) is 81, not 82" in found.out
    assert found.out.endswith("2 printed equations, 1 wrong.\n")


def test_errors_of_all_files_are_told_together(files: dict[str, str]) -> None:
    run = inside("audit", files["bad"], files["wrong"], files["worse"], "nowhere.toml")
    assert (run.code, run.out) == (3, "")
    assert all(any(line.startswith(name) for line in run.lines) for name in (files["bad"], files["worse"], "nowhere"))
    assert sum(line.startswith(files["bad"]) for line in run.lines) == 2


def test_a_convention_of_the_user_s_own_lies_beside_the_file(tmp_path: Path) -> None:
    own = 'name = "lecture"\nfeedback = "u = K x_hat"\nobserver = "A + N C"\n[letters]\ne = "x_bar"\n'
    (tmp_path / "lecture.toml").write_text(own, "utf-8")
    relations = ("N = [-19; -81]", "A + N C = [-19 1; -81 -1]", "x_bar' = (A + N C) x_bar", "N = [19; 81]")
    printed = [{"relation": relation} for relation in relations]
    (tmp_path / "file.json").write_text(problem(convention="lecture", printed=printed), "utf-8")
    run = inside("audit", "file.json", folder=tmp_path)
    assert run.code == 4
    assert "all signs are wrong" in run.out
    assert run.out.endswith("4 printed equations, 1 wrong.\n")


@tabled
def test_every_format_says_what_is_wrong(name: str, files: dict[str, str], tmp_path: Path) -> None:
    target = tmp_path / "found"
    assert inside("audit", files["wrong"], "--format", name, "-o", str(target)).code == 4
    written = target.read_text("utf-8")
    assert "L = [19; 82]" in written
    assert "L = [19; 81]" in written
    assert "entry (2, 1) is 81, not 82" in written
    if name == "json":
        (entry,) = json.loads(written)["files"]
        assert (entry["checked"], len(entry["findings"])) == (1, 1)


def test_a_report_shows_texts_and_does_nothing_else() -> None:
    entry = {
        "relation": "L = [19; 82]",
        "where": "<script>x</script>\n# [a](javascript:b) \u202e`c`",
        "erratum": "**E**",
    }
    found = audit(read(problem(printed=[entry], title="\u202e<b>")))
    row = report({"x_<b>.json": found}, "markdown").splitlines()[2]
    shown = r"| &lt;script&gt;x&lt;/script&gt; \# \[a\](javascript:b) \`c\`, x\_&lt;b&gt;.json | \*\*E\*\* |"
    assert row.startswith(shown)
    assert row.endswith(" |")
    assert "\u202e" not in report({"x": found}, "text")
