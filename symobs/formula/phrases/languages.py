"""The languages of pages: each is data, its phrases and its words, under the keys of the English ones.

A language other than English is a folder beside this module: `words.toml` with the tables `WORDS` and `COUNTS`, and for
each module `NAME_phrases.py` of the package a file `NAME.toml` with its phrases.  What a phrase asserts, demands and
rests on is declared once, with the English one, and holds in every language.
"""

from __future__ import annotations

import re
import string
import sys
from datetime import date, datetime
from functools import cache, cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

from symobs.formula.phrases.catalogue import COUNTS, PHRASES, WORDS, phrases_of_modules
from symobs.formula.phrases.literature import reference, short_reference
from symobs.ground.dataclass import dataclass
from symobs.ground.errors import UsageError

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Mapping


# What a slot of a sentence holds where a language has words for it: numbers of things, and a choice of states.


@dataclass
class Counted:
    """How many of a thing there are, or which one is meant: `thing` is a key of `COUNTS`; `among` how many there are in all."""

    thing: str
    count: int
    among: int = 0


@dataclass
class StateChoice:
    """Sets of states, counted from 1, any one of which will do; all are of the same size."""

    sets: tuple[tuple[int, ...], ...]


#: What languages put into words.
SPOKEN = (Counted, StateChoice)
_FOLDER = Path(__file__).parent
_WORDS = "words.toml"
#: Words of a phrase for one root in its slot, and for several: `the <mode|modes> {roots}`.
COUNTED = re.compile(r"<([^<|>]*)\|([^<|>]*)>")
_PLACES = {"ch.": "chapter", "sec.": "section"}


@dataclass
class Language:
    """The phrases and words of one language."""

    phrases: Mapping[str, str]
    words: Mapping[str, str]
    counts: Mapping[str, Mapping[str, str]]

    @property
    def code(self) -> str:
        """The code of the language, as HTML has it."""
        return self.words["code"]

    @cached_property
    def numbers(self) -> list[str]:
        """Numbers in words, from 0."""
        return self.words["numbers"].split()

    @property
    def has_comma(self) -> bool:
        """Whether decimals have a comma, so that a list of them needs semicolons."""
        return self.words["decimal_mark"] == ","

    def put(self, spoken: Counted | StateChoice) -> str:
        """Return in words what a slot holds."""
        if isinstance(spoken, StateChoice):
            return self._states(spoken.sets)
        forms, count = self.counts[spoken.thing], spoken.count
        is_all = 0 < count == spoken.among and "all" in forms
        form = forms["all"] if is_all else forms.get(str(count), forms["other"])
        word = self.numbers[count] if count < len(self.numbers) else str(count)
        return form.format(word=word, digits=count)

    def _states(self, sets: tuple[tuple[int, ...], ...]) -> str:
        """Return `state 1 or state 2`, `one of the states 1, 2 and 4`, or `states 1 and 3, or 2 and 3`."""
        words = self.words
        if len(sets[0]) > 1:
            return words["states"].format(choices=words["or_states"].join(self.listed(map(str, each)) for each in sets))
        singles = [str(number) for (number,) in sets]
        if len(singles) > 2:
            return words["one_of_states"].format(numbers=self.listed(singles))
        return words["or"].join(words["state"].format(number=number) for number in singles)

    def listed(self, items: Iterator[str] | list[str]) -> str:
        """Return `1`, `1 and 2`, `1, 2 and 3`."""
        *rest, last = items
        return f"{', '.join(rest)}{self.words['and']}{last}" if rest else last

    def decimal(self, text: str) -> str:
        """Return a decimal number with the mark of the language."""
        return text.replace(".", self.words["decimal_mark"])

    def day(self, value: date) -> str:
        """Return a date, and the time of day where it has one: `8 December 2026, 12:00`."""
        months = self.words["months"].split()
        told = self.words["date"].format(day=value.day, month=months[value.month - 1], year=value.year)
        if not isinstance(value, datetime):
            return told
        return self.words["date_and_time"].format(date=told, time=f"{value:%H:%M}")

    def reference(self, key: str, *, short: bool) -> str:
        """Return one entry of the literature in standard form, or on one line."""
        return (short_reference if short else reference)(key, self.words)

    def place(self, text: str) -> str:
        """Return the place in a work, `ch. 3`."""
        return " ".join(self.words[_PLACES[word]] if word in _PLACES else word for word in text.split(" "))


ENGLISH = Language(PHRASES, WORDS, COUNTS)


def languages() -> tuple[str, ...]:
    """Return the codes of all languages, English first."""
    return (ENGLISH.code, *sorted(_folders()))


@cache
def _folders() -> dict[str, Path]:
    """Return the folders of the languages beside English, by code."""
    return {_table(path)["WORDS"]["code"]: path.parent for path in _FOLDER.glob(f"*/{_WORDS}")}


def language_named(code: str, where: str = "language") -> Language:
    """Return a language by its code; raises `UsageError` naming those that exist."""
    if code == ENGLISH.code:
        return ENGLISH
    if code not in languages():
        message, repair = f"{str(code)[:40]!r} is not a language of pages", f"use one of {', '.join(languages())}"
        raise UsageError(message, where=where, repair=repair)
    return _read(_folders()[code])


@cache
def _read(folder: Path) -> Language:
    """Return the language of a folder, a phrase that it lacks in English; raises ValueError where words are missing."""
    words, wanted = _table(folder / _WORDS), phrases_of_modules()
    phrases = {key: text for of_module in wanted.values() for key, text in of_module.items()}
    phrases |= {key: text for name in wanted for key, text in _table(folder / f"{name}.toml").items()}
    found = Language(phrases, words.get("WORDS", {}), words.get("COUNTS", {}))
    is_known = phrases.keys() == {key for of_module in wanted.values() for key in of_module}
    if not is_known or found.words.keys() != WORDS.keys() or found.counts.keys() != COUNTS.keys():
        raise ValueError("\n".join(faults(folder)))
    return found


def _table(path: Path) -> dict[str, Any]:
    import tomllib  # noqa: PLC0415 - pages in English do not pay for it

    return tomllib.loads(path.read_text("utf-8")) if path.is_file() else {}


def faults(folder: Path) -> Iterator[str]:
    """Yield what is missing or wrong in the folder of a language, each with the file and what to write there.

    Every phrase has the slots, the formulas and the forms for one and for several of the English one.
    """
    package = Path(sys.modules[__name__.partition(".")[0]].__file__ or "").parent.parent
    for name, wanted in phrases_of_modules().items():
        path = folder / f"{name}.toml"
        place = path.relative_to(package) if path.is_relative_to(package) else path
        found = _table(path)
        for key, english in wanted.items():
            if key not in found:
                yield f"{place}: write a translation of  {_toml(key)} = {_toml(english)}"
            elif wrong := [of for of, parts in _PARTS.items() if parts(found[key]) != parts(english)]:
                yield f"{place}: {_toml(key)} differs in its {' and '.join(wrong)} from {_toml(english)}"
        yield from (f"{place}: take out {_toml(key)}, which is no phrase" for key in found.keys() - wanted)
    words = _table(folder / _WORDS)
    place = (folder / _WORDS).relative_to(package) if folder.is_relative_to(package) else folder / _WORDS
    tables: dict[str, Mapping[str, object]] = {"WORDS": WORDS, "COUNTS": COUNTS}
    for table, of_table in tables.items():
        for key in of_table.keys() - words.get(table, {}).keys():
            yield f"{place}: write a translation of  {_toml(key)} in [{table}], in English {of_table[key]!r}"
        yield from (f"{place}: take {key} out of [{table}]" for key in words.get(table, {}).keys() - of_table.keys())
    yield from (
        f"{place}: write the form other of {key}" for key, of in words.get("COUNTS", {}).items() if "other" not in of
    )


def _slots(phrase: str) -> list[str]:
    return sorted({name for _, name, _, _ in string.Formatter().parse(phrase) if name})


def _formulas(phrase: str) -> list[str]:
    return sorted({re.sub(r"\s+", " ", part) for part in phrase.split("$")[1::2]})


#: What every translation of a phrase has in common with it.
_PARTS: dict[str, Callable[[str], object]] = {
    "slots": _slots,
    "formulas": _formulas,
    "forms for one and several": lambda phrase: bool(COUNTED.search(phrase)),
    "place of a citation (§)": lambda phrase: "§" in phrase,
}


def _toml(text: str) -> str:
    escaped = text.replace("\\", "\\\\").replace('"', '\\"')
    return f'"{escaped}"'
