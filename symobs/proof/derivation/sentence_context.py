"""Where a sentence stands, what it says, and whether relations of letters hold there (trusted)."""

from __future__ import annotations

from dataclasses import field, replace
from typing import TYPE_CHECKING, Any, TypeAlias

from symobs.exact import Ideal, Scalar
from symobs.formula.tree import (
    Apply,
    Block,
    Derivative,
    Exact,
    Formula,
    HoldsExactlyWhere,
    Identity,
    Letter,
    Literal,
    Negative,
    Power,
    Predicate,
    Product,
    Relation,
    Sum,
    Transpose,
    evaluate,
)
from symobs.formula.tree.calculus import TIME
from symobs.formula.tree.term import Term
from symobs.formula.tree.written import written, written_relation
from symobs.ground.dataclass import dataclass
from symobs.proof.certificate.claims import as_scalar, verify
from symobs.proof.derivation.facts import PREDICATES

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from symobs.formula.phrases.languages import Counted, StateChoice
    from symobs.formula.tree import Environment, Fact, LetterList


_Slots: TypeAlias = "Mapping[str, Formula | Fact | LetterList | Counted | StateChoice | str]"
#: The name under which it is remembered that stability is meant in the sense of Lyapunov from here on.
WEAKER = "stable in the sense of Lyapunov"


@dataclass
class SentenceContext:
    """Where a sentence stands: the facts and relations of its step, and what fills its slots."""

    facts: Sequence[Fact]
    environment: Environment
    slots: _Slots = field(default_factory=dict)
    introduced: Relation | None = None

    def subjects(self, *names: str) -> list[Formula]:
        """Return what has one of these properties, or any, also what has it exactly where something holds."""
        facts = [fact.property if isinstance(fact, HoldsExactlyWhere) else fact for fact in self.of(*_PROPERTIES)]
        return [fact.subject for fact in facts if isinstance(fact, Predicate) and (not names or fact.name in names)]

    def of(self, *kinds: type) -> list[Any]:
        """Return the facts and the slots of some kinds."""
        return [part for part in (*self.facts, *self.slots.values()) if isinstance(part, kinds)]

    def holds(self, *texts: str, **slots: Any) -> bool:
        """Return whether relations written as text hold where the sentence stands."""
        return all(
            _is_shown_true(written_relation(text, self.environment, **slots), self.environment) for text in texts
        )

    def stack(self, row: str, of: str) -> Term:
        """Return the term of the observability matrix."""
        return Term(stack_of(row, of, self.environment), self.environment)

    def told(self, slot: str) -> Term:
        """Return the term in a slot; raises TypeError where there is none."""
        found = self.slots[slot]
        if not isinstance(found, Formula):
            raise TypeError(slot)
        return Term(found, self.environment)

    def size(self, text: str) -> tuple[int, int]:
        """Return the rows and columns of a term; raises TypeError where it stands for no matrix."""
        return written(text, self.environment).value.shape  # type: ignore[no-any-return]


def _is_shown_true(relation: Relation, environment: Environment) -> bool:
    left, right = relation.members[0], relation.members[-1]
    return (relation.operators == ("=",) and left == right) or verify(relation, environment)[0] != ""


_PROPERTIES = (Predicate, HoldsExactlyWhere)


# -- what is asserted, in letters --------------------------------------------------------------------------------------


def letter_of(text: str) -> Formula:
    """Return the formula of a letter, of its transpose, or of a difference of letters."""
    if "−" in text:
        first, second = text.split("−")
        return Sum((Letter(first), Negative(Letter(second))))
    return Transpose(Letter(text[:-1])) if text.endswith("ᵀ") else Letter(text)


def number_of(value: int) -> Formula:
    """Return a number as a formula."""
    return Literal(Scalar.of(value))


def sizes_of(of: str, environment: Environment) -> tuple[int, int]:
    """Return the rows and columns of a letter; raises TypeError where it stands for no matrix."""
    return evaluate(letter_of(of), environment, Exact(environment)).shape  # type: ignore[no-any-return]


def is_shown_in(environment: Environment, left: Formula, operator: str, right: Formula) -> bool:
    """Return whether a relation of two formulas can be shown."""
    same = operator == "=" and left == right
    return same or verify(Relation((left, right), (operator,)), environment)[0] != ""


def vanishes(environment: Environment, formula: Formula) -> bool:
    """Return whether a formula is 0."""
    return is_shown_in(environment, formula, "=", Product((number_of(0), formula)))


def is_not_zero(environment: Environment, formula: Formula) -> bool:
    """Return whether a formula is not 0: nowhere, or where that cannot be seen not everywhere."""
    return is_shown_in(environment, formula, "!==", Product((number_of(0), formula)))


def stack_of(row: str, of: str, environment: Environment) -> Formula:
    """Return [C; CA; …; CAⁿ⁻¹]; where A and C depend on time, each block is the last one times A plus its derivative."""
    first, A, order = letter_of(row), letter_of(of), sizes_of(of, environment)[0]
    if environment.variable != TIME:
        powers = [A, *(Power(A, k) for k in range(2, order))][: order - 1]
        return Block(((first,), *((Product((first, power)),) for power in powers)))
    blocks = [first]
    while len(blocks) < order:
        blocks.append(Sum((Product((blocks[-1], A)), Derivative(blocks[-1]))))
    return Block(tuple((block,) for block in blocks))


def characteristic_of(of: str, environment: Environment) -> Formula:
    """Return det(sI − A)."""
    unknown = Product((Letter("s"), Identity(sizes_of(of, environment)[0])))
    return Apply("det", Sum((unknown, Negative(letter_of(of)))))


def is_value(here: Environment, name: str, formula: Formula) -> bool:
    """Return whether a formula has a property, whatever the names of coefficients stand for."""
    value = as_scalar(evaluate(formula, here, Exact(here)))
    return PREDICATES[name](value, replace(here, coefficients={}), here.variable == "z")


def ideal(relations: tuple[Scalar, ...]) -> Ideal | None:
    """Return the ideal of relations, None where there are none."""
    return Ideal.of(relations) if relations else None


def are_about(said: SentenceContext, formula: Formula, *names: str) -> bool:
    """Return whether all properties with these names are said of a formula, and there are some."""
    found = said.subjects(*names)
    return bool(found) and all(is_shown_in(said.environment, subject, "=", formula) for subject in found)
