"""What an oracle is given: a problem as its file holds it, and the answer of symobs as its JSON holds it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, TypeAlias

#: A problem file as tables of texts: `task`, `symbols`, `plant`, `specification`.
Tables: TypeAlias = dict[str, Any]


@dataclass(frozen=True)
class Asked:
    """One problem and our answer to it: the object of the one task in the JSON, whatever its verdict.

    `problem` holds exactly one `task`.  Matrices in it are texts of one shape, rows between semicolons and entries
    without blanks inside, so that `rows` reads them: "[0 1; -omega^2 2*a]".
    """

    kind: str
    seed: int
    problem: Tables
    answer: Tables

    @property
    def task(self) -> str:
        return str(self.problem["task"])

    @property
    def verdict(self) -> str:
        return str(self.answer["verdict"])

    @property
    def plant(self) -> Tables:
        return dict(self.problem["plant"])

    @property
    def specification(self) -> Tables:
        return dict(self.problem.get("specification", {}))


@dataclass(frozen=True)
class Untold:
    """An oracle could not tell whether an answer is right: what stood in its way."""

    reason: str


#: None: the oracle agrees.  A text: where it does not, in one line.
Difference: TypeAlias = str | Untold | None


def rows(text: str) -> list[list[str]]:
    """Return the entries of a matrix of a problem, as texts with ** for powers."""
    inner = text.strip().removeprefix("[").removesuffix("]")
    return [row.replace("^", "**").split() for row in inner.split(";") if row.strip()]


def text_of(table: list[list[str]]) -> str:
    """Return a matrix as a problem holds it."""
    return f"[{'; '.join(' '.join(row) for row in table)}]"


def listed(text: str) -> list[str]:
    """Return the entries of a comma-separated text of a problem, with ** for powers."""
    return [part.strip().replace("^", "**") for part in text.split(",")]


def is_discrete(problem: Tables) -> bool:
    return problem["plant"].get("dt", 0) not in {0, "0"}


def to_toml(problem: Tables) -> str:
    """Return the problem file: strings, integers, booleans and lists of these, in tables."""
    top = [f"{key} = {_value(value)}" for key, value in problem.items() if not isinstance(value, Mapping)]
    tables = [
        "\n".join([f"[{name}]", *(f"{key} = {_value(value)}" for key, value in table.items())])
        for name, table in problem.items()
        if isinstance(table, Mapping) and table
    ]
    return "\n\n".join(["\n".join(top), *tables]) + "\n"


def _value(value: object) -> str:
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, int):
        return str(value)
    if isinstance(value, list):
        return f"[{', '.join(_value(each) for each in value)}]"
    text = str(value)
    if set('"\\\n') & set(text):
        raise ValueError(text)
    return f'"{text}"'
