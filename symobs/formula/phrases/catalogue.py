"""Every sentence a derivation can say, collected from the tables that lie beside the tasks: all prose stands in these.

A phrase is plain text with slots in braces, filled by a formula or fact (set as mathematics) or by a word; between dollar
signs stand formulas in the letters of `notation` that only name things.  Steps name a phrase by its key; a step whose
slots do not match its phrase cannot be made.  A task's sentences, what they owe and rest on, and how its question is put,
stand in modules `…_phrases.py` of its folder that contain nothing but tables; those of all pages stand in `english`.
These are the phrases in English; `languages` reads them in the others.
"""

from __future__ import annotations

import os
import string
import sys
from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

_PACKAGE = __name__.partition(".")[0]
_SUFFIX = "_phrases.py"


def _listed(folder: str, package: str) -> Iterator[str]:
    """Yield the dotted names of the modules of phrases in a folder and in those below it."""
    with os.scandir(folder) as entries:
        found = sorted(entries, key=lambda entry: entry.name)
    for entry in found:
        if entry.name.endswith(_SUFFIX):
            yield f"{package}.{entry.name.removesuffix('.py')}"
        elif "." not in entry.name and entry.name != "__pycache__" and entry.is_dir():
            yield from _listed(entry.path, f"{package}.{entry.name}")


_FOLDERS: list[str] = sys.modules[_PACKAGE].__path__  # type: ignore[assignment]
_MODULES = [import_module(name) for folder in _FOLDERS for name in _listed(folder, _PACKAGE)]


def _collected(name: str) -> dict[str, Any]:
    """Return what the modules call `name`, joined; raises ValueError for the same key twice."""
    joined: dict[str, Any] = {}
    for module in _MODULES:
        for key, value in dict(getattr(module, name, {})).items():
            if key in joined:
                raise ValueError(f"the phrase {key!r} is written twice")
            joined[key] = value
    return joined


#: How tasks are asked for on a sheet: their keys say when a sentence is said, as `english.question_phrases` explains.
QUESTIONS: dict[str, str] = _collected("QUESTIONS")

PHRASES: dict[str, str] = {**_collected("PHRASES"), **QUESTIONS}


def _table(name: str) -> dict[str, Any]:
    """Return what the modules say of phrases under `name`; raises ValueError where there is no such phrase."""
    table = _collected(name)
    _require_phrases(name, table)
    return table


def _listing(name: str) -> frozenset[str]:
    """Return the phrases that the modules list under `name`; raises ValueError where there is no such phrase."""
    listing = frozenset(key for module in _MODULES for key in getattr(module, name, ()))
    _require_phrases(name, listing)
    return listing


def _require_phrases(name: str, keys: Iterable[str]) -> None:
    for key in keys:
        if key not in PHRASES:
            raise ValueError(f"{name} speaks of {key!r}, which is no phrase")


#: The properties that a phrase asserts: a step that says it must have them among its facts, and so have been checked.
ASSERTS: dict[str, tuple[str, ...]] = _table("ASSERTS")

#: The obligation that the words of a phrase carry, by its name in `derivation.wording_check`: a step that says it is
#: rejected where its relation, its facts or its definition do not meet it.
DEMANDS: dict[str, str] = _table("DEMANDS")
for _key in PHRASES:  # what is said of one kind of time is said of no other
    for _time in ("continuous", "discrete"):
        if _key.endswith(f"_{_time}"):
            DEMANDS[_key] = ", ".join([*filter(None, [DEMANDS.get(_key)]), f"{_time}_time"])

#: The theorem (a key of `THEOREMS`) that a phrase appeals to.
RESTS_ON: dict[str, str] = _table("RESTS_ON")

#: The theorems that phrases may appeal to, each with the literature where it is proved: keys of `literature`.
THEOREMS: dict[str, str] = _collected("THEOREMS")

#: The block diagrams of pages, as `formula.figures` reads them: grid, routes, signals, letters, optional boxes.
FIGURES: dict[str, dict[str, Any]] = _collected("FIGURES")

#: Phrases that name a value and claim nothing of it: in all others a value stands with what it is the value of.
NAMING: frozenset[str] = _listing("NAMING").union(QUESTIONS)

#: Phrases that go on with the sentence before them, in every language; all others begin one.
CONTINUES = _listing("CONTINUES")

#: Phrases that begin a new paragraph wherever they stand.
OPENS = _listing("OPENS")

#: Phrases that only explain, and refer to nothing but what was just shown: a shorter page leaves them out.
EXPLAINS = _listing("EXPLAINS")

#: Titles of sections whose own sections stand side by side on the page, row by row.
BESIDE = _listing("BESIDE")

#: How a table of special cases says a phrase: what goes before the table, and what stands in the last cell of a row.
ROWS: dict[str, str] = _table("ROWS")
_require_phrases("ROWS", (key for row in ROWS.values() for key in row.split()))

#: Phrases before a display that says what the short names stand for in which answers are written: no page goes without.
SPELLS_OUT = _listing("SPELLS_OUT")
#: The words of pages that belong to no phrase, and how many of a thing there are: `english.words_phrases` explains both.
WORDS: dict[str, str] = _collected("WORDS")
COUNTS: dict[str, dict[str, str]] = _collected("COUNTS")


def phrases_of_modules() -> dict[str, dict[str, str]]:
    """Return the phrases of each module `NAME_phrases`, under NAME: the files of another language have these names."""
    found: dict[str, dict[str, str]] = {}
    for module in _MODULES:
        phrases = {**getattr(module, "PHRASES", {}), **getattr(module, "QUESTIONS", {})}
        if phrases:
            found[module.__name__.rpartition(".")[2].removesuffix("_phrases")] = phrases
    return found


def slots_of(key: str) -> frozenset[str]:
    """Return the names of the slots of a phrase."""
    return frozenset(name for _, name, _, _ in string.Formatter().parse(PHRASES[key]) if name)
