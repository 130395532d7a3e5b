"""The words of the page: those of every language, and those that the script shows, are the same ones."""

from __future__ import annotations

import re

from symobs.applications.live import answer
from symobs.applications.live.answering import pole_sets
from symobs.applications.live.assets import ASSETS, MODULES, script, words
from symobs.formula.phrases.languages import languages
from symobs.tasks.result import tasks
from tests.kit import tabled
from tests.support.paths import ROOT

SITE = ROOT / "symobs" / "applications" / "live" / "site"
FILES = (*(ASSETS / name for name in MODULES), SITE / "start-wasm.js", SITE / "worker.js")
SOURCE = "".join(path.read_text("utf-8") for path in FILES)
#: Words of which the script makes the names: `case_yes`.
MADE = re.findall(r"\[?`(\w+_)\$\{\w+(?:\.\w+)?\}`", SOURCE)


def test_every_word_that_is_shown_is_there_in_every_language() -> None:
    table = words()
    assert list(table) == list(languages())
    for own in table.values():
        assert own.keys() == table["en"].keys()
    shown = set(re.findall(r'\bw\("(\w+)"|(?<!el\.)language\.(\w+)', SOURCE))
    named = {first or second for first, second in shown}
    assert len(named) > 40
    assert named - table["en"].keys() == set()


def test_no_word_is_kept_that_is_not_shown() -> None:
    labels = {pole.label for name in tasks() for pole in pole_sets(name)}
    known = {*labels, *(f"{label}s" for label in labels)}
    assert {
        "case_",
        "point_",
        "pole_of_",
        "detail_",
        "kind_",
        "save_",
        "task_",
        "field_",
        "as_",
        "count_",
        "goal_",
    } == set(MADE)
    for key in words()["en"]:
        found = f'"{key}"' in SOURCE or f".{key}" in SOURCE or key.startswith(tuple(MADE)) or key in known
        assert found, key


def test_every_task_has_a_name() -> None:
    for own in words().values():
        assert {key.removeprefix("task_") for key in own if key.startswith("task_")} == set(tasks())


def test_the_script_has_its_words_before_it_is_asked_for_any() -> None:
    whole = script()
    assert whole.count("Object.assign(LANGUAGES, ") == 1
    assert "Beobachterpole" in whole.splitlines()[-1]


@tabled
def test_answers_speak_the_language_of_their_problem(code: str, note: str, says: str) -> None:
    plant = {"A": "[1 0; 0 -1]", "B": "[0; 1]", "C": "[1 1]"}
    problem = {"task": "state_feedback", "plant": plant, "specification": {"poles": "-2, -2"}, "language": code}
    assert answer({"schema": "symobs-live/1", "problem": problem})["note"] == note
    problem = {"task": "observability", "plant": plant, "language": code}
    assert says in [card["says"] for card in answer({"schema": "symobs-live/1", "problem": problem})["cards"]]
