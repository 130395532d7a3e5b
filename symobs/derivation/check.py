"""Derivations, and the check without which none is shown (trusted).

`Derivation.check` walks the steps in order, builds the environment from what is given and defined, and verifies every
link of every relation, also those inside sentences; a false line raises `DerivationRejected`, and so does a letter
that was not established before.  Renderers accept checked derivations only.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, NoReturn, TypeAlias

from symobs.certificate import verify
from symobs.conditions import never_zero
from symobs.derivation.steps import (
    Case,
    Conclude,
    Define,
    Diagram,
    Equal,
    Given,
    Note,
    Section,
    Sentence,
    Solve,
    Step,
)
from symobs.errors import DerivationRejected
from symobs.exact import Matrix, Scalar, roots_are
from symobs.formula import (
    Derivative,
    Environment,
    Exact,
    Exactly,
    Fact,
    Formula,
    Letter,
    Literal,
    Predicate,
    Relation,
    Roots,
    Signal,
    Together,
    evaluate,
    letters,
)
from symobs.formula.plain import plain_relation
from symobs.stability import stability

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

Value: TypeAlias = Scalar | Matrix | Signal


@dataclass(frozen=True)
class Derivation:
    """Steps that start from an environment with free signals and declared signs only."""

    steps: tuple[Step, ...]
    start: Environment
    symbols: Mapping[str, str] = field(default_factory=dict)
    discrete: bool = False

    @property
    def variable(self) -> str:
        """The variable of polynomials, `s` or `z`."""
        return self.start.variable

    def check(self) -> Environment:
        """Verify every line; return what is established at the end.  Raises `DerivationRejected`."""
        known = self.__dict__.get("_checked")
        if known is None:
            known = _walk(self.steps, self.start, self.discrete)
            object.__setattr__(self, "_checked", known)
        environment: Environment = known
        return environment


def _walk(steps: tuple[Step, ...], environment: Environment, discrete: bool) -> Environment:  # noqa: FBT001
    for step in steps:
        environment = _after(step, environment, discrete)
    return environment


def _after(step: Step, environment: Environment, discrete: bool) -> Environment:  # noqa: FBT001
    """Verify one step and return the environment after it."""
    match step:
        case Given(relations):
            for relation in relations:
                environment = _introduce(relation, environment)
        case Define(relation):
            environment = _introduce(relation, environment)
        case Equal(relations):
            for relation in relations:
                _fact(relation, environment, discrete)
        case Solve(equation, solution):
            environment = _introduce(solution, environment)
            _fact(equation, environment, discrete)
        case Conclude(facts=facts) | Note(facts=facts):
            for fact in facts:
                _fact(fact, environment, discrete)
        case Diagram(_, labels):
            for place, label in labels:
                _fact(Relation((Letter(DRAWN[place]), label), ("=",)), environment, discrete)
        case Case(when, substitution, inside):
            _walk(inside, _on_stratum(when, dict(substitution), environment), discrete)
        case Section(title, inside):
            _sentence(title, environment, discrete)
            environment = _walk(inside, environment, discrete)
    _sentence(getattr(step, "sentence", None), environment, discrete)
    return environment


def _sentence(sentence: Sentence | None, environment: Environment, discrete: bool) -> None:  # noqa: FBT001
    if sentence is None:
        return
    for _, slot in sentence.slots:
        if isinstance(slot, (Relation, Predicate, Roots, Exactly, Together)):
            _fact(slot, environment, discrete)
        elif not isinstance(slot, str):
            _established(slot, environment)


def _fact(fact: Fact, environment: Environment, discrete: bool) -> None:  # noqa: FBT001
    """Verify a relation or a property; a property must hold whatever the named coefficients stand for."""
    if isinstance(fact, Relation):
        for member in fact.members:
            _established(member, environment)
        if verify(fact, environment)[0] == "":
            _reject(plain_relation(fact, environment.variable))
        return
    if isinstance(fact, Together):
        for part in fact.relations:
            _fact(part, environment, discrete)
        return
    environment = replace(environment, coefficients={})
    if isinstance(fact, Roots):
        polynomial = evaluate(fact.polynomial, environment, Exact(environment))
        if not roots_are(polynomial, environment.variable, fact.values):
            _reject(f"the roots of {polynomial} are {', '.join(map(str, fact.values))}")
        return
    if isinstance(fact, Exactly):
        polynomial = evaluate(fact.property.subject, environment, Exact(environment))
        found = stability(polynomial, environment.variable, environment.signs, discrete=discrete)
        said = {_positive_part(relation, environment) for relation in fact.where}
        if fact.property.name != "stable" or found.verdict != "conditional" or said != set(found.positive):
            _reject(f"{polynomial} is stable exactly where {', '.join(f'{value} > 0' for value in said)}")
        return
    _established(fact.subject, environment)
    value = evaluate(fact.subject, environment, Exact(environment))
    if isinstance(value, Matrix) and value.shape == (1, 1):
        value = value[0, 0]
    if fact.name not in PREDICATES or not PREDICATES[fact.name](value, environment, discrete):
        _reject(f"{fact.name}({value})")


def _positive_part(relation: Relation, environment: Environment) -> Scalar:
    """Return what a strict inequality says is positive."""
    left, right = (evaluate(member, environment, Exact(environment)) for member in relation.members)
    difference: Scalar = left - right if relation.operators == (">",) else right - left
    return difference


def _introduce(relation: Relation, environment: Environment) -> Environment:
    """Verify the links after the first member and let the first member mean the rest; `!=` states an assumption."""
    target, *rest = relation.members
    for member in rest:
        _established(member, environment)
    if relation.operators[0] == "!=":
        _established(target, environment)
        assumed = evaluate(target, environment, Exact(environment))
        factors = [factor for factor, _ in assumed.numerator.factors()[1]]
        return replace(environment, assumed=(*environment.assumed, *factors))
    anew = isinstance(target, Letter) and target.name in environment.values  # written anew, not given another meaning
    agreeing = relation if anew else Relation(tuple(rest), relation.operators[1:])
    if len(agreeing.members) > 1 and verify(agreeing, environment)[0] == "":
        _reject(plain_relation(relation, environment.variable))
    return _meaning(target, rest, environment)


def _meaning(target: Formula, rest: list[Formula], environment: Environment) -> Environment:
    match target:
        case Derivative(Letter(name)):
            return environment.having(dynamics={name: rest[0]})
        case Literal(value) if isinstance(value, Scalar) and len(value.names) == 1:
            (name,) = value.names
            meaning = evaluate(rest[-1], environment, Exact(replace(environment, coefficients={})))
            return environment.having(coefficients={name: meaning})
        case Letter(name):
            last = next((member for member in reversed(rest) if isinstance(member, Literal)), rest[0])
            value = evaluate(last, environment, Exact(environment))
            if isinstance(value, Signal):
                return environment.having(signals={name: rest[0]})
            if isinstance(last, Literal):
                value = last.value
            return environment.having(values={name: value})
        case _:
            return _reject("only a letter, a derivative or a named coefficient can be introduced")


def _established(formula: Formula, environment: Environment) -> None:
    for name in letters(formula):
        if not environment.knows(name):
            _reject(f"{name} is used before it is established")


def _on_stratum(when: Relation, substitution: dict[str, Scalar], environment: Environment) -> Environment:
    """Return the environment on a stratum, after verifying that the substitution lies on it."""
    replaced = {}
    for name, value in environment.values.items():
        try:
            replaced[name] = value.substitute(substitution)
        except ZeroDivisionError:  # the letter means nothing on this stratum
            continue
    inside = replace(environment, values=replaced)
    members = tuple(
        Literal(member.value.substitute(substitution)) if isinstance(member, Literal) else member
        for member in when.members
    )
    if verify(Relation(members, when.operators), inside)[0] == "":
        _reject(plain_relation(when, environment.variable))
    return inside


def _reject(line: str) -> NoReturn:
    message = f"the line {line} is not true"
    raise DerivationRejected(message, repair="please report this: it is a bug of symobs", line=line)


# -- properties that no equation states -------------------------------------------------------------------------------


def _verdict(value: Scalar, environment: Environment, discrete: bool) -> str:  # noqa: FBT001
    polynomial = value.denominator if not value.is_polynomial_in(environment.variable) else value
    return stability(polynomial, environment.variable, environment.signs, discrete=discrete).verdict


def _degrees(value: Scalar, environment: Environment) -> tuple[int, int]:
    return value.degree(environment.variable), value.denominator.degree(environment.variable)


#: The letter whose value each box of a diagram shows.
DRAWN = {"plant": "P", "compensator": "F"}

PREDICATES: dict[str, Callable[[Scalar, Environment, bool], bool]] = {
    "stable": lambda value, environment, discrete: _verdict(value, environment, discrete) == "yes",
    "unstable": lambda value, environment, discrete: _verdict(value, environment, discrete) == "no",
    "strictly_proper": lambda value, environment, _: _degrees(value, environment)[0] < _degrees(value, environment)[1],
    "never_zero": lambda value, environment, _: never_zero(value, environment.signs),
}
