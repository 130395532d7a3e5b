"""Moodle, R/exams, QTI and notebooks: each export read by a reader of the test's own, and held against `check`."""

from __future__ import annotations

import io
import json
import random
import re
from contextlib import redirect_stdout
from fractions import Fraction
from math import prod
from typing import Any
from xml.etree.ElementTree import Element, fromstring
from zipfile import ZipFile

import pytest

import symobs
from symobs.applications.export import PLATFORMS, ExerciseSet, export
from tests.kit import tabled
from tests.support.tools.exported import checked, held, random_answer, right

QTI = ("servo_observer", "triple_pole_two_outputs", "third_order_matching", "detectable", "two_inputs_feedback")
CLOZE = ("servo_observer", "third_order_matching", "detectable", "third_order_observer", "servo_observer_feedthrough")


# -- Moodle -----------------------------------------------------------------------------------------------------------


def gaps_of(text: str) -> list[tuple[int, str, str]]:
    """The gaps of a cloze text by its grammar: weight, type, and what follows."""
    found = re.findall(r"(?<!\\)\{([0-9]*):([A-Z_]+):((?:\\.|[^}\\])*)\}", text)
    return [(int(weight or 1), kind, inside) for weight, kind, inside in found]


def cloze_right(gap: tuple[int, str, str], cell: str) -> bool:
    """Whether a gap takes an answer: `=19:0` is 19 with tolerance 0, `=yes~no` is a choice."""
    _, kind, inside = gap
    if kind == "MULTICHOICE":
        return f"={cell}" in inside.split("~")
    number, tolerance = inside.removeprefix("=").split(":")
    assert Fraction(tolerance) == 0
    return Fraction(cell) == Fraction(number)


@pytest.mark.parametrize("name", CLOZE)
def test_a_moodle_quiz_takes_what_check_takes(name: str) -> None:
    each, draw = held(name), random.Random(name)  # noqa: S311
    quiz = fromstring(str(export("moodle", [each])[""]))  # noqa: S314
    assert [question.get("type") for question in quiz] == ["category", "cloze"]
    gaps = gaps_of(quiz[1].findtext("questiontext/text", ""))
    assert len(gaps) == sum(prod(part.shape) for part in each.first.parts)
    for answer in [
        {part.name: right(part) for part in each.first.parts},
        *(random_answer(each.first, draw, exact=True) for _ in range(5)),
    ]:
        told, left = checked(each.first, answer), iter(gaps)
        for part in each.first.parts:
            cells = [str(number(cell)) if part.kind != "word" else cell for row in answer[part.name] for cell in row]
            taken = sum(cloze_right(next(left), cell) for cell in cells) == len(cells)
            assert taken == (told[part.name][0] == "right"), (part.name, answer)


def number(cell: str) -> Fraction:
    """The value of a sum or product of numbers in parentheses, as random answers have it."""
    cell = cell.replace(" ", "")
    match = re.fullmatch(r"-?\(([^()]*)\)([+*])?\(?([^()]*)\)?", cell)
    if match is None:
        return Fraction(cell)
    first = Fraction(match[1]) * (-1 if cell.startswith("-") else 1)
    return first + Fraction(match[3]) if match[2] == "+" else first * Fraction(match[3] or 1)


# -- R/exams ----------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("name", CLOZE)
def test_an_r_exams_file_has_one_solution_one_type_and_one_point_a_gap(name: str) -> None:
    each = held(name)
    files = {name: str(text) for name, text in export("rexams", [each]).items()}
    (text,) = [text for name, text in files.items() if name.endswith(".Rmd")]
    assert re.findall(r"^(\S.*)\n[=-]{5,}$", text, re.MULTILINE) == [
        "Question",
        "Answerlist",
        "Solution",
        "Meta-information",
    ]
    meta = dict(re.findall(r"^(ex[a-z]+): (.*)$", text, re.MULTILINE))
    columns = {key: meta[key].split("|") for key in ("exsolution", "exclozetype", "expoints")}
    cells = [str(cell) for part in each.first.parts for row in part.right for cell in row]
    expected = [str(["yes", "no", "conditional"].index(cell)) if cell in {"yes", "no"} else cell for cell in cells]
    found = [
        str(value.index("1")) if kind == "schoice" else value
        for value, kind in zip(columns["exsolution"], columns["exclozetype"], strict=True)
    ]
    assert (found, meta["extol"], set(columns["expoints"])) == (expected, "0", {"1"})
    listed = text.split("----------\n")[1].split("Solution\n")[0].count("\n* ")
    assert listed == sum(3 if kind == "schoice" else 1 for kind in columns["exclozetype"])
    assert "`" not in text


# -- QTI --------------------------------------------------------------------------------------------------------------


def item_of(each: ExerciseSet, platform: str = "qti") -> Element:
    """The item of a package, its names without their space."""
    content = export(platform, [each])[""]
    assert isinstance(content, bytes)
    with ZipFile(io.BytesIO(content)) as package:
        assert package.testzip() is None
        (name,) = [name for name in package.namelist() if name.startswith("items/")]
        assert f'href="{name}"' in package.read("imsmanifest.xml").decode()
        return fromstring(re.sub(r' xmlns="[^"]*"', "", package.read(name).decode(), count=1))  # noqa: S314


def processed(item: Element, responses: dict[str, Any]) -> dict[str, Any]:
    """The outcomes of response processing, as the standard says, with floats as a player has them."""
    values: dict[str, Any] = {}
    for declared in item.findall("qti-outcome-declaration"):
        default = declared.findtext("qti-default-value/qti-value")
        values[str(declared.get("identifier"))] = None if default is None else float(default)

    def value(e: Element) -> Any:
        match e.tag.removeprefix("qti-"):
            case "variable":
                name = str(e.get("identifier"))
                return responses.get(name) if name in responses else values.get(name)
            case "base-value":
                return e.text if e.get("base-type") == "identifier" else float(str(e.text))
            case "sum":
                return sum(value(each) for each in e)
            case "product":
                return prod(value(each) for each in e)
            case "divide":
                return value(e[0]) / value(e[1])
            case "and":
                return all(value(each) for each in e)
            case "not":
                return not value(e[0])
            case "is-null":
                return value(e[0]) is None
            case "equal":
                assert e.get("tolerance-mode") == "exact"
                return value(e[0]) == value(e[1])
            case "match":
                return value(e[0]) == value(e[1])
        raise AssertionError(e.tag)

    processing = item.find("qti-response-processing")
    assert processing is not None
    for rule in processing:
        if rule.tag == "qti-set-outcome-value":
            values[str(rule.get("identifier"))] = value(rule[0])
            continue
        for branch in rule:
            if value(branch[0]):
                for action in branch[1:]:
                    values[str(action.get("identifier"))] = value(action[0])
                break
    return values


@tabled
def test_an_item_gives_full_marks_where_check_does(name: str) -> None:
    each, draw = held(name), random.Random(name)  # noqa: S311
    item = item_of(each)
    answers = [{part.name: right(part) for part in each.first.parts}]
    answers += [random_answer(each.first, draw, exact=True) for _ in range(8)]
    if name == "triple_pole_two_outputs":
        answers.append({"L": [["0", "1"], ["0", "2"], ["0", "6"]]})
    for answer in answers:
        told = checked(each.first, answer)
        responses: dict[str, Any] = {}
        for k, part in enumerate(each.first.parts, 1):
            cells = [cell for row in answer[part.name] for cell in row]
            responses |= (
                {f"P{k}": cells[0]}
                if part.kind == "word"
                else {f"P{k}R{i}": float(number(cell)) for i, cell in enumerate(cells, 1)}
            )
        found = processed(item, responses)
        for k, part in enumerate(each.first.parts, 1):
            verdict, credit = told[part.name]
            assert (found[f"S{k}"] == 1) == (verdict == "right"), answer
            assert found[f"S{k}"] in {0, float(credit or 0)}  # of the slips the sign and the other half
        weights = [Fraction(part.data["weight"]) for part in each.first.parts]
        assert found["SCORE"] == sum(found[f"S{k}"] * w for k, w in enumerate(weights, 1))


# -- notebooks --------------------------------------------------------------------------------------------------------


def notebook_of(each: ExerciseSet) -> dict[str, Any]:
    (content,) = export("ipynb", [each]).values()
    found: dict[str, Any] = json.loads(content)
    return found


def graded_cell(each: ExerciseSet, assigned: dict[str, Any]) -> tuple[float, str]:
    """The value of the last expression of the test cell, as nbgrader takes it, and what is printed."""
    source = notebook_of(each)["cells"][2]["source"]
    lines = source.splitlines()
    assert lines[-1] == "### END HIDDEN TESTS"
    names: dict[str, Any] = dict(assigned)
    with redirect_stdout(io.StringIO()) as printed:
        exec(compile("\n".join(lines[:-2]), "cell", "exec"), names)  # noqa: S102
        value = eval(lines[-2], names)  # noqa: S307
    return value, printed.getvalue()


def test_a_notebook_gives_the_marks_of_check() -> None:
    each = held("output_feedback_servo")
    ours = {
        part.name: f"[{'; '.join(' '.join(row) for row in right(part))}]"
        for part in each.first.parts
        if part.kind == "gain"
    }
    F = right(each.first.parts[2])[0][0]
    assert graded_cell(each, {**ours, "F": F})[0] == 3
    assert graded_cell(each, {**ours, "F": f"-({F})"})[0] == 2.5
    assert graded_cell(each, {"K": ours["K"], "L": [[1], [2]]})[0] == 1
    marks, printed = graded_cell(each, {"F": F})
    assert (marks, "missing: K, L" in printed) == (1, True)
    with pytest.raises(RuntimeError, match="marked by hand"):
        graded_cell(each, {"K": "[1 (", "F": F})
    assert graded_cell(each, {})[0] == 0


def test_a_checker_that_is_overwritten_marks_nothing() -> None:
    each, done = held("servo_observer"), symobs.check
    wrong = {"L": "[1; 2]", "symobs": symobs, "json": None}
    try:
        symobs.check = lambda *_, **__: pytest.fail("this one is not asked")
        assert graded_cell(each, wrong)[0] == 0
        assert graded_cell(each, {"L": "[19; 81]"})[0] == 1
    finally:
        symobs.check = done


@pytest.mark.parametrize("platform", PLATFORMS)
def test_the_solution_goes_with_the_question(platform: str) -> None:
    """It is told by a sentence of the derivation that no question holds; a notebook prints it beside the marks."""
    each = held("third_order_matching")
    if platform == "ipynb":
        told = graded_cell(each, {"L": "[1; 2; 3]"})[1]
    else:
        files = export(platform, [each])
        told = "".join(map(_as_text, files.values()))
    assert "as required" in re.sub(r"\s+", " ", told)


def _as_text(content: str | bytes) -> str:
    if isinstance(content, str):
        return content
    with ZipFile(io.BytesIO(content)) as package:
        return "".join(package.read(name).decode() for name in package.namelist())


def test_tables_of_items_have_bodies() -> None:
    """The rows of a table stand in a body in QTI 2.1 and 3.0."""
    for platform in ("qti", "qti21"):
        tables = list(item_of(held("servo_observer"), platform).iter("table"))
        assert tables
        assert all(child.tag in {"caption", "tbody"} for table in tables for child in table)


#: The attributes that MathML 3 gives to the elements of formulas, and all of them a class.
_OF_MATHML_3 = {
    "math": {"display"},
    "mi": {"mathvariant"},
    "mo": {"form", "separator", "stretchy"},
    "mover": {"accent"},
    "mspace": {"width", "height", "depth"},
    "mstyle": {"displaystyle", "scriptlevel"},
    "mtable": {"displaystyle"},
}


@pytest.mark.parametrize("name", ["disturbance_not_seen", "time_varying_rotation", "unknown_input_not_decoupled"])
def test_formulas_of_items_have_the_attributes_of_mathml_3(name: str) -> None:
    for platform in ("qti", "qti21"):
        item = item_of(held(name), platform)
        parts = [(e.tag.partition("}")[2], {*e.attrib} - {"class"}) for e in item.iter() if "MathML" in e.tag]
        assert all(attributes <= _OF_MATHML_3.get(tag, set()) for tag, attributes in parts)
        assert {"displaystyle", "scriptlevel"} & {a for tag, attributes in parts if tag == "mstyle" for a in attributes}


def test_a_notebook_is_one_of_format_4_5_and_says_the_same_every_time() -> None:
    each = held("servo_observer")
    found = notebook_of(each)
    assert (found["nbformat"], found["nbformat_minor"]) == (4, 5)
    graded = [cell["metadata"]["nbgrader"] for cell in found["cells"]]
    assert [(g["grade"], g["locked"], g["solution"], g.get("points")) for g in graded] == [
        (False, True, False, None),
        (False, False, True, None),
        (True, True, False, 1.0),
    ]
    assert export("ipynb", [each]) == export("ipynb", [held("servo_observer")])


def test_items_of_2_1_are_the_same_in_other_names() -> None:
    new, old = item_of(held("servo_observer")), item_of(held("servo_observer"), "qti21")
    assert old.tag == "assessmentItem"
    ours = [
        re.sub(r"qti-|-", "", e.tag).lower() for e in new.iter() if e.tag != "qti-content-body"
    ]  # 3.0 wraps what is told
    assert ours == [e.tag.lower() for e in old.iter()]
    assert [e.get("toleranceMode") for e in old.iter("equal")] == ["exact"] * 4
