"""The worked examples: each file is a test of itself, and a value spoiled in it is noticed."""

from __future__ import annotations

import json
import re
from itertools import product
from typing import TYPE_CHECKING, Any

import pytest
import sympy

from symobs.formula.expression import parse_matrix, parse_scalar
from symobs.problem.expect import mismatches
from symobs.tasks.result import formats, render
from tests.support.examples import EXAMPLES as FILES
from tests.support.examples import document_of, problem_of, results_of
from tests.support.paths import ROOT
from tests.support.sampling import every
from tests.support.second_reader import sympy_scalar

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Mapping
    from pathlib import Path

    from symobs.problem import Problem
    from symobs.tasks.result import Result
    from symobs.tasks.result.in_convention import ResultInConvention

pytestmark = pytest.mark.slow

#: The rows of the catalogue of sources; a line may name two that share a heading.
ROWS = [
    row.split(" / ")
    for row in (ROOT / "tests/support/problems/catalogue_ids.txt").read_text("utf-8").splitlines()
    if not row.startswith("#")
]
#: No example stands for more rows than this.
MOST_ROWS = 6
every_file = pytest.mark.parametrize("path", FILES, ids=lambda path: path.stem)


def solved(path: Path) -> tuple[Problem, tuple[Result, ...]]:
    return problem_of(path.stem), results_of(path.stem)


def test_all_rows_are_covered() -> None:
    covered = {row for path in FILES for row in solved(path)[0].ids}
    named = {row for line in ROWS for row in line}
    assert len(ROWS) == 53
    assert named - covered == set()
    assert covered - named == set(), "an example names a row that the catalogue does not have"


@every_file
def test_stands_for_few_rows(path: Path) -> None:
    ids = solved(path)[0].ids
    assert len(ids) == len(set(ids)) <= MOST_ROWS


#: The documents whose rows the catalogue lists, by the names that readers know them by.
DOCUMENTS = (
    "Observability, Observers and Feedback Compensators",
    "N. Sukavanam",
    "Reduced-Order Observer Design",
    "Full-State Observer Notes and Example",
    "Handwritten lecture notes",
)


@every_file
def test_says_what_it_is(path: Path) -> None:
    found, _ = solved(path)
    assert found.title
    assert found.source
    assert found.expect
    assert all(re.fullmatch(r"S[0-4]-[A-Z][\w.-]+", row) for row in found.ids)
    assert bool(found.ids) == found.source.startswith(DOCUMENTS)
    assert re.search(r"\bS[0-4]\b", found.source) is None


@every_file
def test_meets_its_expectations(path: Path) -> None:
    found, results = solved(path)
    assert [result.task for result in results] == [task.name for task in found.tasks]
    assert mismatches(found.viewed(results), found.expect) == []


@pytest.mark.parametrize(
    ("path", "name"),
    [(path, "latex") for path in FILES] + every(4, product(FILES, ["fragment", "text", "json"])),
    ids=lambda each: getattr(each, "stem", each),
)
def test_renders(path: Path, name: str) -> None:
    found, results = solved(path)
    page = render(document_of(path.stem), name)
    assert isinstance(page, str)
    if name == "json":
        whole = json.loads(page)
        assert (whole["schema"], whole["title"]) == ("symobs/1", found.title)
        return
    assert name == "fragment" or found.title.split()[0] in page
    braces = r"|[{}]" if name == "text" and "{" not in found.convention.brackets else ""
    assert not re.search(r"\bNone\b|Scalar\(|Matrix\(|<symobs" + braces, page)
    assert "│ =" not in page, "a left side is not an answer"
    for result in results:
        assert result.derivation.check() is not None


def test_boxes_of_a_drawing_hold_fractions() -> None:
    """The widths of the boxes are those of fractions, so written as quotients in a line they would overlap."""
    found, results = solved(next(path for path in FILES if path.stem == "output_feedback_servo"))
    page = str(render(found.document(results), "fragment"))
    assert r"{$\displaystyle \frac{1}{s(s+1)}$}" in page
    assert r"{$\displaystyle \frac{319s+400}{s^2+23s+161}$}" in page


# -- a spoiled expectation is noticed ----------------------------------------------------------------------------------


def spoiled(value: Any, key: str, names: Mapping[str, str]) -> Iterator[Any]:
    """Yield a value of `[expect]` with each of its entries changed in turn."""
    if isinstance(value, bool):
        yield not value
    elif isinstance(value, int):
        yield value + 1
    elif isinstance(value, dict):
        for name, entry in value.items():
            for change in spoiled(entry, name, names):
                yield value | {name: change}
    elif key in {"intervals", "intervals_decimal"}:
        yield from spoiled_intervals(value)
    elif isinstance(value, list) and (not value or not isinstance(value[0], list)):
        yield from spoiled_list(value, key, names)
    elif value in ("yes", "no", "conditional"):
        yield from (other for other in ("yes", "no", "conditional") if other != value)
    elif isinstance(value, list) or value.startswith("["):
        others = {name: sign for name, sign in names.items() if name != "t"} | {"s": "real"}
        read = parse_matrix(value, others, variable="t", functions=True)
        rows = [[str(entry) for entry in row] for row in read.rows]
        for i, row in enumerate(rows):
            for j, entry in enumerate(row):
                if key == "kernel" and entry != "0":
                    continue  # it may remain a multiple of the vector
                yield [*rows[:i], [*row[:j], f"{entry} + 1", *row[j + 1 :]], *rows[i + 1 :]]
    else:
        yield f"{value} + 1"


def opposite(relation: str) -> str:
    """Return a relation that excludes the one given."""
    left, operator, right = re.split(r"\s(!=|<|>|==)\s", relation)
    return f"{left} { {'!=': '==', '>': '<', '<': '>', '==': '!='}[operator] } {right}"


def spoiled_intervals(value: list[list[str]]) -> Iterator[list[list[str]]]:
    """Yield a list of pairs with one end moved or at infinity, and with a pair left out or added."""
    for i, pair in enumerate(value):
        for j, end in enumerate(pair):
            moved = "1234" if end in {"oo", "-oo"} else f"{end} + 1"
            for other in {moved, "oo" if j else "-oo"} - {end}:
                yield [*value[:i], [*pair[:j], other, *pair[j + 1 :]], *value[i + 1 :]]
        yield [*value[:i], *value[i + 1 :]]
    yield [*value, ["1234", "1235"]]


def spoiled_list(value: list[Any], key: str, names: Mapping[str, str]) -> Iterator[Any]:
    """Yield a list of roots, relations or vectors with one entry changed, left out or added."""
    relations = key in {"conditions", "stable_if", "positive_if", "best_horizon"}
    if not relations:
        yield [*value, [1, 0, 0] if key == "kernel" else -1234]
    elif key == "stable_if":  # a set: what is added has to take something away from it
        if value != ["False"]:
            yield [*value, opposite(value[0]) if value else f"{next(iter(names), 1)} > 0"]
    elif names:
        yield [*value, f"{next(iter(names))} != 1234"]
    for i, entry in enumerate(value):
        changes: list[Any] = [-1234]
        if isinstance(entry, dict):
            changes += spoiled(entry, key, names)
        if entry == "False":
            changes = [f"{next(iter(names), 1)} > 0"]
        elif relations:
            changes = [opposite(entry), f"{entry} + 1"]
        for change in changes:
            yield [*value[:i], change, *value[i + 1 :]]
        yield [*value[:i], *value[i + 1 :]]


def every_spoiled(found: Problem) -> Iterator[tuple[str, dict[str, Any]]]:
    """Yield the file's expectations, each with one change, and the place of the change."""
    assert found.plant is not None
    names, whole = found.plant.symbols.signs, dict(found.expect)
    names = {**names, "t": "real", "t0": "real"} if found.plant.is_time_varying else names
    tasks = {task.name for task in found.tasks}
    for key, entry in whole.items():
        table = entry if key in tasks else {key: entry}
        for name, value in table.items():
            for change in spoiled(value, name, names):
                changed = {**table, name: change}
                yield (f"{key}.{name}", whole | {key: changed}) if key in tasks else (name, whole | changed)


@pytest.mark.parametrize("path", every(6, FILES), ids=lambda path: path.stem)
def test_every_spoiled_value_is_noticed(path: Path, record_property: Callable[[str, object], None]) -> None:
    found, solutions = solved(path)
    results = found.viewed(solutions)
    count = 0
    for place, expect in every_spoiled(found):
        lines = mismatches(results, expect)
        if is_member(results[-1], place, expect):  # as good an answer; at most what follows from it differs
            assert not any(f"expect.{place}:" in line for line in lines)
            continue
        if not lines and results[-1].standard(place.rpartition(".")[2])[0] in results[-1].result.claimed:
            continue  # many values meet such a claim, which the lies about the answer hold to fractions
        others = [line for line in lines if f"expect.{place}:" not in line]
        assert len(lines) - len(others) == 1, (place, expect)
        assert not others or is_of_family(results[-1], place), others  # they followed from the gain expected
        count += 1
    record_property("spoiled values", count)
    print(f"{path.stem}: {count} spoiled values, all noticed")  # noqa: T201 - shown by pytest -s
    assert count > len(found.expect) / 2


def is_of_family(viewed: ResultInConvention, place: str) -> bool:
    """Tell whether an expected answer is a gain that is not unique."""
    letter, _ = viewed.standard(place.rpartition(".")[2])
    if letter == "H" and viewed.result.task == "unknown_input_observer":
        return True
    return letter in {"K", "L"} and viewed.result.fields.get("family") is not None


def is_member(viewed: ResultInConvention, place: str, expect: Mapping[str, Any]) -> bool:
    """Tell whether a spoiled gain meets the claim all the same, there being many: by SymPy's own determinant."""
    if not is_of_family(viewed, place):
        return False
    result, own = viewed.result, place.rpartition(".")[2]
    letter, sign = viewed.standard(own)
    entry = expect.get(result.task, expect)[own]
    gain = sign * rows(*[[sympy_scalar(parse_scalar(x), {}) for x in row] for row in entry])
    if letter == "H":
        E = rows(*[[sympy_scalar(entry, {}) for entry in row] for row in result.disturbance_input.rows])
        return bool((gain * result.plant.C * E - E).expand().is_zero_matrix)
    part, variable = part_with(result, letter), sympy.Symbol(result.plant.variable)
    A, moved = part.plant.A, gain * part.plant.C if letter == "L" else part.plant.B * gain
    if part.task == "reduced_order_observer":
        known = part.plant.C.rows
        whole = part.T * A * part.T.inv()
        A, moved = whole[known:, known:], gain * whole[:known, known:]
    if part.task == "unknown_input_observer":
        A = part.T * A
    found = (variable * sympy.eye(A.rows) - A + moved).det(method="berkowitz")
    return bool(sympy.expand(found - part.polynomial) == 0)


def rows(*entries: list[Any]) -> Any:
    return sympy.ImmutableMatrix(list(entries))


def part_with(result: Any, letter: str) -> Any:
    """Return the design that a gain belongs to."""
    if result.task != "compensator":
        return result
    return result.feedback if letter == "K" else result.estimator


def test_each_format_is_rendered_here() -> None:
    assert set(formats()) >= {"latex", "fragment", "text", "json"}
