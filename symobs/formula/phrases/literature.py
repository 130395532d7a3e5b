"""The literature that pages and methods refer to, by short keys; the works stand in the file beside it, in BibTeX's fields."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING

from symobs.formula.phrases.english.words_phrases import WORDS

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

_WORKS = json.loads((Path(__file__).parent / "literature.json").read_text("utf-8"))
#: Key → kind of publication and its fields, as they are to be printed.
LITERATURE: dict[str, tuple[str, dict[str, str]]] = {
    key: (kind, fields) for kind, works in _WORKS.items() for key, fields in works.items()
}


def cited(references: str) -> list[tuple[str, str]]:
    """Return the keys and places in a text such as "kalman1963; kailath1980, ch. 2"."""
    parts = [part.partition(",") for part in references.split(";")]
    return [(key.strip(), place.strip()) for key, _, place in parts]


def written_out(references: str) -> str:
    """Return the references of such a text in full, with the places in them; what is no key stays as it is."""
    return "; ".join(f"{reference(key)}{', ' * bool(place)}{place}" for key, place in cited(references))


def short_reference(key: str, words: Mapping[str, str] = WORDS) -> str:
    """Return authors, year and place of one entry, on one line; of a book the title."""
    if key not in LITERATURE:
        return key
    _, of = LITERATURE[key]
    authors = " ".join(part for part in of["author"].split() if not part.rstrip(",").endswith("."))
    pages = f", {of['pages']}" if of.get("pages") else ""
    volume = f" {of['volume']}" if of.get("volume") else ""
    place = of.get("journal") or of.get("booktitle") or of["title"]
    return f"{authors.replace(' and ', words['authors'])} ({of['year']}), {place}{volume}{pages}"


def reference(key: str, words: Mapping[str, str] = WORDS) -> str:
    """Return one entry in standard form, with the words of a language; what is no key is returned."""
    if key not in LITERATURE:
        return key
    kind, of = LITERATURE[key]
    author = of["author"].replace(" and ", words["authors"])
    pages = f", {of['pages']}" if of.get("pages") else ""
    if kind == "article":
        return f"{author}, {of['title']}, {of['journal']} {of['volume']} ({of['year']}){pages}"
    if kind == "book":
        ordinal = of.get("edition", "")
        edition = words["edition"].format(ordinal=ordinal, number=ordinal.rstrip("dhnrst")) + ", " if ordinal else ""
        return f"{author}, {of['title']}, {edition}{of['publisher']}, {of['year']}"
    return f"{author}, {of['title']}, in: {of['booktitle']}, {of['year']}{pages}"


def bibliography(keys: Iterable[str]) -> str:
    """Return entries as a BibTeX file; what is no key of the literature has none."""
    entries = []
    for key in sorted({key for key in keys if key in LITERATURE}):
        kind, of = LITERATURE[key]
        fields = {name: value.replace("–", "--").replace("&", r"\&") for name, value in of.items() if value}
        fields["author"] = fields["author"].replace(", ", " and ")
        fields["title"] = f"{{{fields['title']}}}"
        lines = "".join(f"  {name} = {{{value}}},\n" for name, value in fields.items())
        entries.append(f"@{kind}{{{key},\n{lines}}}\n")
    return "\n".join(entries)
