"""Derivations: closed kinds of steps, and the check without which none is shown.

A step says something about letters established before it.  `Derivation.check` walks the steps in order, builds the
environment from what is given and defined, and re-evaluates every member of every relation, also those inside
sentences; a false line raises `DerivationRejected`.  Renderers accept checked derivations only.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypeAlias, Union

from symobs.formula import Fact, Formula, Relation


@dataclass(frozen=True, slots=True)
class Sentence:
    """A phrase of `phrases.PHRASES` with its slots filled by formulas, facts or plain words."""

    key: str
    slots: tuple[tuple[str, Formula | Fact | str], ...] = ()


@dataclass(frozen=True, slots=True)
class Given:
    """Data of the problem: each relation introduces its first member."""

    relations: tuple[Relation, ...]
    sentence: Sentence | None = None


@dataclass(frozen=True, slots=True)
class Define:
    """A new letter (or the dynamics of a new signal): members[0] is introduced, the others must agree."""

    relation: Relation
    sentence: Sentence | None = None
    answer: bool = False


@dataclass(frozen=True, slots=True)
class Equal:
    """Relations among what is established, shown on one display."""

    relations: tuple[Relation, ...]
    sentence: Sentence | None = None
    answer: bool = False


@dataclass(frozen=True, slots=True)
class Solve:
    """`unknown` = solution because the equation then holds."""

    equation: Relation
    solution: Relation
    sentence: Sentence | None = None


@dataclass(frozen=True, slots=True)
class Conclude:
    """A finding in a sentence; `verified` marks the check of an answer that the reader is shown."""

    sentence: Sentence
    facts: tuple[Fact, ...] = ()
    verified: bool = False


@dataclass(frozen=True, slots=True)
class Note:
    """A remark; `caution` where an expert would warn.  It may speak of established letters only."""

    sentence: Sentence
    facts: tuple[Fact, ...] = ()
    caution: bool = False


@dataclass(frozen=True, slots=True)
class Diagram:
    """A block diagram drawn from a named description (`loop`: plant above, compensator in the return path)."""

    name: str
    labels: tuple[tuple[str, Formula], ...]


@dataclass(frozen=True, slots=True)
class Case:
    """What is true where a condition of the main line fails; its steps hold in the stratum's own environment."""

    when: Relation
    steps: tuple[Step, ...]
    sentence: Sentence | None = None


@dataclass(frozen=True, slots=True)
class Section:
    """A titled run of steps; sections nest."""

    title: Sentence
    steps: tuple[Step, ...]


Step: TypeAlias = Union[Given, Define, Equal, Solve, Conclude, Note, Diagram, Case, Section]
