"""A class whose students have different variants, and which of these was harder."""

from __future__ import annotations

import csv
import hashlib
import json
from fractions import Fraction
from typing import TYPE_CHECKING, Any

import pytest

from symobs.applications.batch.jobs import canonical, digest
from symobs.applications.variants.search import as_text, responses_of
from symobs.problem import parse
from tests.kit import tabled
from tests.support.tools.command_line import Run, inside

if TYPE_CHECKING:
    from pathlib import Path

PROBLEM = """title = "Gains"
task = "observer"
[variants]
construct = { kind = "observer", order = 2 }
[marking]
total = 4
"""
#: A = [0 1; 0 0], C = [1 0] and the poles −a, −b: L = [a + b; a b].
POLES = {"v001": (1, 2), "v002": (3, 5), "v003": (2, 7)}


def manifest() -> dict[str, Any]:
    """A manifest as `symobs variants` writes it."""
    variants = []
    for name, (a, b) in POLES.items():
        plant = {"A": "[0 1; 0 0]", "B": "[0; 1]", "C": "[1 0]"}
        data = {"title": name, "task": "observer", "plant": plant, "marking": {"total": 4}}
        data["specification"] = {"observer_poles": f"{-a}, {-b}"}
        variants.append(
            {"id": hashlib.sha256(name.encode()).hexdigest()[:12], "file": f"variants/{name}.toml", "data": data}
        )
    return {"schema": "symobs-variants/1", "problem": digest(canonical(parse(PROBLEM))), "variants": variants}


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    (tmp_path / "problem.toml").write_text(PROBLEM, "utf-8")
    (tmp_path / "SET").mkdir()
    (tmp_path / "SET" / "manifest.json").write_text(json.dumps(manifest()), "utf-8")
    return tmp_path


def run(folder: Path, table: str, *more: str, manifest: str = "SET") -> Run:
    (folder / "class.csv").write_text(table, "utf-8")
    arguments = ["problem.toml", "--submissions", "class.csv", "--variants", manifest, "-o", "OUT", *more]
    return inside("check", *arguments, folder=folder)


def marks(folder: Path) -> dict[str, tuple[str, str, str]]:
    with (folder / "OUT" / "marks.csv").open(encoding="utf-8") as file:
        return {row["student"]: (row["variant"], row["verdict"], row["score"]) for row in csv.DictReader(file)}


def test_each_answer_is_held_against_its_variant_however_that_is_named(folder: Path) -> None:
    key = manifest()["variants"][1]["id"]
    table = f"""student,variant,L
a,v001,[3; 2]
b,2,[8; 15]
c,variants/v003.toml,[9; 14]
d,{key},[8; 15]
e,V002,[3; 2]
f,v001,[8; 15]
g,v9,[3; 2]
h,,[3; 2]
"""
    found = run(folder, table, "--feedback", manifest="SET/manifest.json")
    assert found.code == 0
    assert found.err.splitlines() == [
        "g is not counted in the mean: variant: there is no variant v9; write v001 to v003",
        "h is not counted in the mean: variant: it is not said which variant this is; write v001 to v003",
    ]
    assert marks(folder) == {
        "a": ("v001", "right", "4.00"),
        "b": ("v002", "right", "4.00"),
        "c": ("v003", "right", "4.00"),
        "d": ("v002", "right", "4.00"),
        "e": ("v002", "wrong", "0.00"),
        "f": ("v001", "wrong", "0.00"),
        "g": ("v9", "unreadable", ""),
        "h": ("", "unreadable", ""),
    }
    reports = [json.loads(line) for line in (folder / "OUT" / "results.jsonl").read_text("utf-8").splitlines()]
    assert [report["title"] for report in reports[:3]] == ["v001", "v002", "v003"]
    assert [report["parts"][0]["reason"] for report in reports[6:]] == [
        "variant: there is no variant v9; write v001 to v003",
        "variant: it is not said which variant this is; write v001 to v003",
    ]
    assert reports[4]["parts"][0]["effect"]["polynomial"] == "s**2 + 3*s + 2"
    assert len(list((folder / "OUT" / "feedback").iterdir())) == 8
    summary = json.loads((folder / "OUT" / "summary.json").read_text("utf-8"))
    assert summary["title"] == "Gains"
    assert (summary["mean"], summary["without_variant"]) == ("8/3", ["g", "h"])  # (4 + 4 + 4 + 4 + 0 + 0)/6
    assert list(summary["variants"]) == ["v001", "v002", "v003"]
    assert summary["variants"]["v002"] == {"students": 3, "mean": "8/3", "mean_decimal": "2.67", "squares": "32/3"}
    assert "| v003 | 1 | 4.00 |" in (folder / "OUT" / "summary.md").read_text("utf-8")


def test_the_assignment_beside_the_manifest_says_who_has_which(folder: Path) -> None:
    (folder / "SET" / "assignment.csv").write_text("student,variant\na,v002\n'=b,v003\n", "utf-8")
    assert run(folder, "student,L\na,[8; 15]\n=b,[9; 14]\nc,[3; 2]\n").code == 0
    assert marks(folder) == {
        "a": ("v002", "right", "4.00"),
        "'=b": ("v003", "right", "4.00"),
        "c": ("", "unreadable", ""),
    }
    assert run(folder, "student,variant,L\na,v001,[8; 15]\n").code == 0  # what is handed in goes before
    assert marks(folder) == {"a": ("v001", "wrong", "0.00")}


@tabled
def test_a_manifest_that_cannot_be_used_is_refused(folder: Path, written: str, message: str) -> None:
    (folder / "SET" / "manifest.json").write_text(written, "utf-8")
    found = run(folder, "student,variant,L\na,v001,[3; 2]\n")
    assert (found.code, message in found.err) == (3, True), found.err
    assert not (folder / "OUT").exists()


def test_a_class_in_which_nobody_says_the_variant_is_refused(folder: Path) -> None:
    found = run(folder, "student,L\na,[3; 2]\nb,[3; 2]\n")
    assert (found.code, "no submission says which variant it answers" in found.err) == (3, True)
    (folder / "SET" / "assignment.csv").write_text("name,v\na,v002\n", "utf-8")
    found = run(folder, "student,L\na,[3; 2]\n")
    assert (found.code, "the columns student and variant are expected" in found.err) == (3, True)
    one = inside("check", "problem.toml", "class.csv", "--variants", "SET", folder=folder)
    assert (one.code, "name the file of the variant" in one.err) == (2, True)
    assert run(folder, "student,variant,L\na,1,[3; 2]\n", manifest="nowhere").code == 3


# -- which variant was harder -----------------------------------------------------------------------------------------


def summary_of(**scores: list[int]) -> str:
    """A summary with these marks by variant."""
    variants = {}
    for name, own in scores.items():
        mean = Fraction(sum(own), len(own))
        squares = sum((score - mean) ** 2 for score in own)
        variants[name] = {"students": len(own), "mean": str(mean), "mean_decimal": "", "squares": str(squares)}
    return json.dumps({"schema": "symobs-check-summary/1", "variants": variants})


def test_a_variant_that_is_off_by_more_than_three_standard_errors_is_named() -> None:
    """Marks 7 and 9 in turn: variance 1 · n/(n − 1) within a variant; by hand 9 · 16/14 · (1/4 + 1/12) > 3² > ..."""
    usual = [7, 9, 7, 9]
    for low, word in (([5, 7, 5, 7], "same"), ([4, 6, 4, 6], "harder"), ([10, 12, 10, 12], "easier")):
        # means 8, 8, 8 and 6, 5, 11: s² = 16/(16 − 4) = 4/3, the bound 9 · 4/3 · (1/4 + 1/12) = 4
        found = {each.name: each.compared for each in responses_of(summary_of(a=usual, b=usual, c=usual, d=low), "")}
        assert found == {"a": "same", "b": "same", "c": "same", "d": word}
    listed = responses_of(summary_of(a=usual, b=usual, c=usual, dd=[4, 6, 4, 6]), "")
    assert as_text(listed).splitlines() == [
        "a      4 students      8.00 marks",
        "b      4 students      8.00 marks",
        "c      4 students      8.00 marks",
        "dd     4 students      5.00 marks  harder than the others",
        "1 of 4 variants differs from the others by more than 3 standard errors",
    ]
