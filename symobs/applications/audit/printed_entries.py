"""The `[[printed]]` entries of a file: places and printed equations."""

from __future__ import annotations

import re
from dataclasses import field
from typing import TYPE_CHECKING, Any

from symobs.applications.audit.equations.grammar import FUNCTIONS, read_relation
from symobs.applications.audit.equations.reading import EquationConditions
from symobs.formula.convention import Convention, convention_named
from symobs.formula.expression import declared_name
from symobs.formula.expression.source import shown
from symobs.formula.expression.syntax_tree import letters_of
from symobs.ground.dataclass import dataclass
from symobs.ground.errors import InputError, ProblemErrors, SymobsError, UsageError

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

_MOST_LETS = 20
_WHERE = " where"
_FUNCTIONS = {name for name, _ in FUNCTIONS}


@dataclass(frozen=True)
class PrintedEntry:
    """A printed entry: an equation of two or more members, or answers in the form of `[expect]`."""

    place: str
    where: str
    erratum: str
    convention: Convention
    relation: str = ""
    condition: EquationConditions = field(default_factory=EquationConditions)
    let: Mapping[str, str] = field(default_factory=dict)
    expect: Mapping[str, Any] = field(default_factory=dict)


def printed_entries(
    entries: Sequence[Mapping[str, Any]], convention: Convention, signs: Mapping[str, str]
) -> list[PrintedEntry]:
    """Return the entries of a file; raises `ProblemErrors` with every unreadable one.

    `signs` are those of the file's own symbols, of which conditions speak.
    """
    found, errors = [], []
    for i, entry in enumerate(entries):
        try:
            found.append(_statement(entry, f"printed[{i}]", convention, signs))
        except SymobsError as error:
            errors.append(error)
    if errors:
        raise ProblemErrors(tuple(errors))
    return found


def _built_in(name: str, place: str) -> Convention:
    try:
        return convention_named(re.sub(r"(\.toml)+\Z", "", name))  # a file names no path
    except UsageError as error:
        raise InputError(error.message, where=f"{place}.convention", repair=error.repair) from None


def _statement(entry: Mapping[str, Any], place: str, convention: Convention, signs: Mapping[str, str]) -> PrintedEntry:
    name = entry.get("convention", convention.name)
    written_in = convention if name == convention.name else _built_in(name, place)
    let = _lets(entry.get("let", {}), f"{place}.let")
    relation, condition = parted(entry.get("relation", ""), signs, f"{place}.relation")
    if "relation" in entry and len(read_relation(relation, f"{place}.relation")) < 2:
        repair = 'write both sides, for example "det(s I - A) = s^2 + 3 s + 2"'
        raise InputError("an equation is expected", where=f"{place}.relation", repair=repair)
    where, erratum = entry.get("where", ""), entry.get("erratum", "")
    return PrintedEntry(place, where, erratum, written_in, relation, condition, let, entry.get("expect", {}))


def parted(text: str, signs: Mapping[str, str], place: str) -> tuple[str, EquationConditions]:
    """Return an equation and its conditions: `rank(O) = 2 where c != 0`."""
    equation, found, condition = text.partition(_WHERE)
    return equation, EquationConditions.of(condition, signs, place) if found else EquationConditions(signs=signs)


def _lets(table: Mapping[str, Any], where: str) -> dict[str, str]:
    """Return the values of the letters defined by the entry."""
    if len(table) > _MOST_LETS:
        raise InputError(f"more than {_MOST_LETS} letters", where=where, repair="print less at once")
    found: dict[str, str] = {}
    for name, written in table.items():
        place = f"{where}.{shown(name, 40)}"
        declared_name(name, place)
        members = read_relation(written, place)
        if len(members) != 1:
            raise InputError("one expression is expected", where=place, repair='leave "=" out')
        if name in _FUNCTIONS or name in letters_of(*members):
            raise InputError(f"{name} cannot stand for this", where=place, repair="take another letter")
        found[name] = written
    return found
