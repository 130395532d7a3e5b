"""The closed kinds of steps a derivation is made of.

A step says something about letters established before it, and carries the sentence that gives its reason.
"""

from __future__ import annotations

from dataclasses import fields
from typing import TYPE_CHECKING, Any, TypeAlias, get_args

from symobs.formula.phrases import slots_of
from symobs.formula.tree import (
    Conjunction,
    Evaluated,
    Formula,
    HoldsExactlyWhere,
    LetterList,
    Literal,
    Predicate,
    Relation,
    Roots,
    RoundedRoots,
    children,
)
from symobs.ground.dataclass import dataclass

if TYPE_CHECKING:
    from collections.abc import Iterator

    from symobs.exact import Matrix, Scalar
    from symobs.formula.figures import Label, Picture
    from symobs.formula.phrases.languages import Counted, StateChoice
    from symobs.formula.tree import Fact
    from symobs.stability.criteria.routh_table import RouthTable


@dataclass
class Sentence:
    """A phrase of `phrases.PHRASES`, its slots filled by formulas, facts, text, or what a language puts into words."""

    key: str
    slots: tuple[tuple[str, Formula | Fact | LetterList | Counted | StateChoice | str], ...] = ()

    def __post_init__(self) -> None:
        """Refuse slots that do not match the phrase."""
        given, wanted = {name for name, _ in self.slots}, slots_of(self.key)
        if given != wanted:
            message = f"the phrase {self.key!r} has the slots {sorted(wanted)}, not {sorted(given)}"
            raise ValueError(message)


@dataclass
class Given:
    """Data of the problem, or with `!=` a condition assumed: each relation introduces its first member.

    `silent` data are established without a display of their own.
    """

    relations: tuple[Relation, ...]
    sentence: Sentence | None = None
    silent: bool = False


@dataclass
class Define:
    """A new letter (or the dynamics of a new signal): members[0] is introduced, the others must agree."""

    relation: Relation
    sentence: Sentence | None = None
    answer: bool = False
    silent: bool = False


@dataclass
class Equal:
    """Relations between established values, on one display."""

    relations: tuple[Relation, ...]
    sentence: Sentence | None = None
    answer: bool = False


@dataclass
class Conclude:
    """A finding; `verified` marks a check the reader is shown; without sentence it only binds the page."""

    sentence: Sentence | None
    facts: tuple[Fact, ...] = ()
    verified: bool = False


@dataclass
class Note:
    """A remark; `caution` marks a warning.  It contains established letters only."""

    sentence: Sentence
    facts: tuple[Fact, ...] = ()
    caution: bool = False


@dataclass
class Diagram:
    """A block diagram: a figure of `flow` by its name, with the gains and signals that label it.

    Labels may be wider than the page; a format then draws the letters that the figure has for them.
    """

    name: str
    labels: tuple[tuple[str, Label], ...]
    sentence: Sentence | None = None


@dataclass
class Tabulate:
    """Routh's table of a polynomial in `variable`; the findings printed below are among those of `findings_of`."""

    polynomial: Formula
    table: RouthTable
    variable: str
    sentence: Sentence | None = None
    findings: tuple[Sentence, ...] = ()


@dataclass
class Inequalities:
    """A property holds exactly where some inequalities do: shown on a display of their own."""

    fact: HoldsExactlyWhere
    sentence: Sentence | None = None
    answer: bool = False


@dataclass
class RegionSummary:
    """The region of one or two parameters (`names`) in which a polynomial is stable, in words and in parts.

    The findings are among those of `findings_of_region`; the parts are all of its intervals, or bounds of the second
    parameter over intervals of the first, or are left out.
    """

    polynomial: Formula
    names: tuple[str, ...]
    findings: tuple[Sentence, ...] = ()
    parts: tuple[tuple[Relation, ...], ...] = ()
    sentence: Sentence | None = None


@dataclass
class Plot:
    """A picture of where `subject`, a polynomial, is stable, or of its roots as a parameter moves."""

    picture: Picture
    subject: Formula
    sentence: Sentence | None = None


@dataclass
class CaseStep:
    """A case: the steps that hold on a stratum; `when` holds there because of `substitution`.

    Several equations and inequations stand together.  Without a substitution the steps hold modulo the equations.  The
    letters in `anew` have no meaning there until they are introduced again.
    """

    when: Relation | Conjunction
    substitution: tuple[tuple[str, Scalar], ...]
    steps: tuple[Step, ...]
    sentence: Sentence | None = None
    anew: tuple[str, ...] = ()


@dataclass
class Section:
    """A titled run of steps; sections nest."""

    title: Sentence
    steps: tuple[Step, ...]


Step: TypeAlias = (
    Given
    | Define
    | Equal
    | Conclude
    | Note
    | Diagram
    | Plot
    | Tabulate
    | Inequalities
    | RegionSummary
    | CaseStep
    | Section
)

#: What has parts of its own besides formulas.
WITH_PARTS = (
    *get_args(Step),
    Sentence,
    Predicate,
    Roots,
    RoundedRoots,
    HoldsExactlyWhere,
    Conjunction,
    Relation,
    Evaluated,
)
_PARTS: dict[Any, tuple[str, ...]] = {kind: tuple(part.name for part in fields(kind)) for kind in WITH_PARTS}


def everything_in(item: Any) -> Iterator[Any]:
    """Yield a step, or several, and everything in it: sentences, facts, formulas and their parts."""
    left = [item]
    while left:
        item = left.pop()
        yield item
        if isinstance(item, Formula):
            left += reversed(children(item))
        elif isinstance(item, tuple):
            left += reversed(item)
        elif isinstance(item, WITH_PARTS):
            left += reversed([getattr(item, name) for name in _PARTS[type(item)]])


def relations(steps: Any) -> Iterator[Relation]:
    """Yield all relations of steps, those inside sentences and cases too."""
    return (part for part in everything_in(steps) if isinstance(part, Relation))


def literals(steps: Any) -> Iterator[Scalar | Matrix]:
    """Yield all values that are written out."""
    return (part.value for part in everything_in(steps) if isinstance(part, Literal))
