"""Derivations, and the check without which none is shown (trusted).

`Derivation.check` walks the steps in order, builds the environment from what is given and defined, and verifies every
link of every relation, also those inside sentences; a false line raises `DerivationRejected`, and so does a letter
that was not established before.  Renderers accept checked derivations only.
"""

from __future__ import annotations

from contextlib import suppress
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any, NoReturn, TypeAlias, assert_never

from symobs.certificate import SENSELESS, as_scalar, verify
from symobs.conditions import never_zero
from symobs.derivation.pictures import faults, relations_of
from symobs.derivation.properties import PREDICATES, polynomial_of, subjects
from symobs.derivation.regions import is_exactly, is_survey
from symobs.derivation.steps import (
    Case,
    Conclude,
    Define,
    Diagram,
    Equal,
    Given,
    Note,
    Plot,
    Section,
    Sentence,
    Solve,
    Step,
    Survey,
    Tabulate,
    Where,
)
from symobs.derivation.tables import is_tabulated
from symobs.errors import DerivationRejected
from symobs.exact import Ideal, Matrix, Scalar, apart_from_zero, product_of, roots_are
from symobs.exact.functions import substitute
from symobs.formula import (
    Apply,
    Derivative,
    Environment,
    Exact,
    Exactly,
    Fact,
    Formula,
    Letter,
    Literal,
    Names,
    Predicate,
    Relation,
    Roots,
    Shown,
    Signal,
    Together,
    children,
    evaluate,
    letters,
    roots_written,
)
from symobs.formula.plain import plain, plain_relation
from symobs.phrases import ASSERTS, NAMING
from symobs.pointwise import never_together_zero
from symobs.stability import monic

if TYPE_CHECKING:
    from collections.abc import Mapping

    from symobs.picture import Picture

Value: TypeAlias = Scalar | Matrix | Signal
_BUG = "please report this: it is a bug of symobs"


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
        known: Environment | None = self.__dict__.get("_checked")
        if known is None:
            known = _walk(self.steps, self.start, self.discrete)
            object.__setattr__(self, "_checked", known)
        return known


#: The letter that a label of a diagram must agree with, where the page has it.
_LABELS = {"plant": "P", "compensator": "F"}


def _walk(steps: tuple[Step, ...], environment: Environment, discrete: bool) -> Environment:  # noqa: FBT001
    for step in steps:
        try:
            environment = _after(step, environment, discrete)
        except SENSELESS as error:
            message = f"a step of kind {type(step).__name__} cannot be read: {error}"
            raise DerivationRejected(message, repair=_BUG, line=str(step)) from error
    return environment


def _after(step: Step, environment: Environment, discrete: bool) -> Environment:  # noqa: FBT001
    """Verify one step and return the environment after it."""
    match step:
        case Given(relations, sentence):
            said = [slot for _, slot in sentence.slots] if sentence else []
            stated = {part for slot in said for part in (slot.relations if isinstance(slot, Together) else (slot,))}
            for relation in relations:
                if relation.operators == ("!=",) and (not sentence or relation in stated):
                    environment = _assume(relation, environment)
                else:
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
            _asserted(step.sentence, facts)
        case Diagram(_, labels):
            for name, label in labels:
                _established(label, environment)
                if environment.knows(_LABELS.get(name, "")):
                    _fact(Relation((Letter(_LABELS[name]), label), ("=",)), environment, discrete)
        case Tabulate(polynomial, variable=variable):
            _about_letters(polynomial, environment)
            value = as_scalar(evaluate(polynomial, environment, Exact(environment)))
            if not is_tabulated(step, value, environment):
                _reject(f"that this is the table of {plain(polynomial, environment.variable)} in {variable}")
        case Where(fact):
            _fact(fact, environment, discrete)
        case Survey(polynomial):
            _about_letters(polynomial, environment)
            value = as_scalar(evaluate(polynomial, environment, Exact(environment)))
            if not is_survey(step, value, environment, discrete=discrete):
                _reject(f"that this is the region of {plain(polynomial, environment.variable)}")
        case Plot(picture, subject):
            _drawn(picture, subject, environment, discrete)
        case Case(when, substitution, inside, anew=anew):
            stratum = _on_stratum(when, dict(substitution), environment)
            kept = {name: value for name, value in stratum.values.items() if name not in anew}
            _walk(inside, replace(stratum, values=kept), discrete)
        case Section(title, inside):
            _sentence(title, environment, discrete)
            environment = _walk(inside, environment, discrete)
        case _:
            assert_never(step)
    _sentence(getattr(step, "sentence", None), environment, discrete)
    return environment


def _drawn(picture: Picture, subject: Formula, environment: Environment, discrete: bool) -> None:  # noqa: FBT001
    """Reject a picture that shows what is not true of the polynomial."""
    for formula in (subject, *(member for relation in relations_of(picture) for member in relation.members)):
        _established(formula, environment)
    if not letters(subject) - {"s"} and not isinstance(subject, Apply):
        _reject(f"a picture of {plain(subject, environment.variable)}, which is no letter's,")
    for fault in faults(picture, subject, environment, discrete=discrete):
        _reject(f"{fault}, in a picture,")


def _sentence(sentence: Sentence | None, environment: Environment, discrete: bool) -> None:  # noqa: FBT001
    if sentence is None:
        return
    for _, slot in sentence.slots:
        if isinstance(slot, (Relation, Predicate, Roots, Exactly, Together, Shown, Names)):
            _fact(slot, environment, discrete)
        elif not isinstance(slot, str):
            _established(slot, environment)
            if _has_values(slot) and sentence.key not in NAMING:
                _reject(f"{plain(slot, environment.variable)}, a value in a sentence without what it is the value of,")


def _asserted(sentence: Sentence | None, facts: tuple[Fact, ...]) -> None:
    """Reject a sentence that asserts a property which is not among the facts of its step."""
    checked = {fact.name for fact in facts if isinstance(fact, Predicate)}
    if sentence is not None and not checked.issuperset(ASSERTS.get(sentence.key, ())):
        _reject(f"{sentence.key}, which rests on {', '.join(ASSERTS[sentence.key])},")


def _has_values(formula: Formula) -> bool:
    return isinstance(formula, Literal) or any(_has_values(part) for part in children(formula))


def _about_letters(formula: Formula, environment: Environment) -> None:
    """Reject a property of what is written out only: it would say nothing about the problem."""
    _established(formula, environment)
    if not letters(formula) - {"s"}:
        _reject(f"a property of {plain(formula, environment.variable)}, which is no letter's,")


def _fact(fact: Fact, environment: Environment, discrete: bool) -> None:  # noqa: FBT001
    """Verify a relation or a property; a property must hold whatever the named coefficients stand for."""
    if isinstance(fact, Relation):
        for member in fact.members:
            _established(member, environment)
        if verify(fact, environment)[0] == "":
            _reject(plain_relation(fact, environment.variable))
        return
    if isinstance(fact, Names):
        _established(Literal(product_of(map(Scalar.symbol, fact.names))), environment)
        return
    if isinstance(fact, Together):
        for part in fact.relations:
            _fact(part, environment, discrete)
        return
    if isinstance(fact, Shown):
        _fact(Relation((fact.formula, fact.value), ("=",)), environment, discrete)
        return
    environment = replace(environment, coefficients={})
    if isinstance(fact, Roots):
        _about_letters(fact.polynomial, environment)
        value = as_scalar(evaluate(fact.polynomial, environment, Exact(environment)))
        polynomial = polynomial_of(value, environment)
        if polynomial is not value:
            polynomial = monic(polynomial, environment.variable)
        if not roots_are(polynomial, environment.variable, fact.values):
            _reject(f"the roots of {polynomial} are {', '.join(map(str, fact.values))}")
        return
    if isinstance(fact, Exactly):
        _about_letters(fact.property.subject, environment)
        found = evaluate(fact.property.subject, environment, Exact(environment))
        (value,) = subjects(fact.property.name, found, environment.variable)
        polynomial = polynomial_of(value, environment)
        if not is_exactly(fact, polynomial, environment, discrete=discrete):
            where = ", ".join(plain_relation(relation, environment.variable) for relation in fact.where)
            _reject(f"{polynomial} is {fact.property.name} exactly where {where}")
        return
    _about_letters(fact.subject, environment)
    found = evaluate(fact.subject, environment, Exact(environment))
    parts = subjects(fact.name, found, environment.variable)
    if fact.name not in PREDICATES or not all(PREDICATES[fact.name](part, environment, discrete) for part in parts):
        _reject(f"{fact.name}({found})")


def _introduce(relation: Relation, environment: Environment) -> Environment:
    """Verify the links after the first member and let the first member mean the rest."""
    target, *rest = relation.members
    for member in rest:
        _established(member, environment)
    if relation.operators[0] != "=":
        _reject(plain_relation(relation, environment.variable))
    anew = isinstance(target, Letter) and target.name in environment.values  # written anew, not given another meaning
    agreeing = relation if anew else Relation(tuple(rest), relation.operators[1:])
    if len(agreeing.members) > 1 and verify(agreeing, environment)[0] == "":
        _reject(plain_relation(relation, environment.variable))
    return _meaning(target, rest, environment)


def _assume(relation: Relation, environment: Environment) -> Environment:
    """Let the factors of a difference, which there must be, be different from 0 from here on."""
    left, right = (as_scalar(evaluate(member, environment, Exact(environment))) for member in relation.members)
    if left == right:
        _reject(plain_relation(relation, environment.variable))
    return replace(environment, assumed=(*environment.assumed, *(f for f, _ in (left - right).numerator.factors()[1])))


def _meaning(target: Formula, rest: list[Formula], environment: Environment) -> Environment:
    match target:
        case Derivative(Letter(name)) if _is_free(name, environment):
            return environment.having(dynamics={name: rest[0]})
        case Literal(value) if isinstance(value, Scalar) and str(value) in value.names:
            (name,) = value.names
            _new_name(name, environment)
            meaning = evaluate(rest[-1], environment, Exact(replace(environment, coefficients={})))
            return environment.having(coefficients={name: meaning})
        case Letter(name) if name not in environment.signals or _is_free(name, environment):
            last = next((member for member in reversed(rest) if isinstance(member, Literal)), rest[0])
            value = evaluate(last, environment, Exact(environment))
            if isinstance(value, Signal):
                return environment.having(signals={name: rest[0]})
            if name == "s" or name in environment.signals:
                _reject(f"{name}, which stands for something else, as a name for a value")
            if isinstance(last, Literal):
                value = last.value
            return environment.having(values={name: value})
        case _:
            return _reject("only a letter, a derivative or a named coefficient can be introduced")


def _is_free(name: str, environment: Environment) -> bool:
    """Whether a signal has neither a definition nor a derivative: only such a one can be given either."""
    return name in environment.signals and environment.signals[name] is None and name not in environment.dynamics


def _new_name(name: str, environment: Environment) -> None:
    """Reject a coefficient's name that stands for something already: a parameter would lose its generality."""
    used = [*environment.values.values(), *environment.coefficients.values()]
    if name in environment.signs or name in environment.coefficients or any(name in value.names for value in used):
        _reject(f"{name}, which means something already, as a name for a coefficient")


def _established(formula: Formula, environment: Environment) -> None:
    """Reject letters that are not established, and roots of what may be negative: they would not be real."""
    for name in letters(formula):
        if not environment.knows(name):
            _reject(f"{name} is used before it is established")
    for root in roots_written(formula):
        _fact(Relation((Literal(root.argument), Literal(Scalar.of(0))), (">=",)), environment, discrete=False)


def _on_stratum(when: Relation | Together, substitution: dict[str, Scalar], environment: Environment) -> Environment:
    """Return the environment on a stratum, after verifying that the substitution describes it.

    Without a substitution the single equation itself is what is known inside: that a polynomial of the parameters
    vanishes, or that λ is an eigenvalue.  Otherwise a single `when` has one factor that can vanish, linear in the one
    name put in: another equation would hold elsewhere too.  Of several equations and inequations it is verified that
    each value put in follows from them.
    """
    if not substitution and isinstance(when, Relation) and when.operators in {("<",), (">",), ("!=",)}:
        left, right = (as_scalar(evaluate(member, environment, Exact(environment))) for member in when.members)
        if when.operators == ("!=",):
            return environment  # it narrows, and nothing is put in: all stays true
        return replace(
            environment, above=(*environment.above, left - right if when.operators == (">",) else right - left)
        )
    if not substitution and isinstance(when, Relation) and when.operators == ("=",):
        left, right = (as_scalar(evaluate(member, environment, Exact(environment))) for member in when.members)
        inside = replace(environment, relations=(*environment.relations, left - right), assumed=())
        return (
            inside if not Ideal.of(inside.relations).is_whole else _reject(plain_relation(when, environment.variable))
        )
    named, lost = dict(substitution), set[str]()
    for name, value in environment.coefficients.items():
        try:
            named[name] = _there(value, substitution, lost)
        except ZeroDivisionError:
            lost.add(name)
    replaced = {}
    for name, known in environment.values.items():
        with suppress(ZeroDivisionError):  # the letter means nothing on this stratum
            replaced[name] = _there(known, substitution, lost)
    above = tuple(value.substitute(substitution) for value in environment.above)
    moved = (value.substitute(substitution).numerator for value in environment.relations)
    relations = tuple(value for value in moved if value)
    inside = replace(environment, values=replaced, coefficients=named, assumed=(), above=above, relations=relations)
    if isinstance(when, Together):
        return inside.under(_left_of(when, substitution, environment))
    left, right = (as_scalar(evaluate(member, environment, Exact(environment))) for member in when.members)
    factors = [f for f, _ in (left - right).numerator.factors()[1] if not never_zero(f, environment.signs)]
    says_no_more = [f.degree(name) for f in factors for name in substitution] == [1] and when.operators == ("=",)
    if not says_no_more or verify(when, inside)[0] == "":
        _reject(plain_relation(when, environment.variable))
    return inside


def _there(value: Any, substitution: Mapping[str, Scalar], lost: set[str]) -> Any:
    """Return a value on a stratum; raises ZeroDivisionError where it has none, or rests on what has none."""
    if lost.intersection(value.names):
        raise ZeroDivisionError
    return substitute(value, substitution)


def _left_of(when: Together, substitution: dict[str, Scalar], environment: Environment) -> tuple[Scalar, ...]:
    """Return what of the equations (1 − w p = 0 for an inequation of p) is left when parameters are put in.

    What is said of the stratum is held to them, and so to each of its points.
    """
    equations: list[Scalar] = []
    excluded: list[Scalar] = []
    for relation in when.relations:
        left, right = (as_scalar(evaluate(member, environment, Exact(environment))) for member in relation.members)
        if relation.operators == ("=",):
            equations.append((left - right).numerator)
        elif relation.operators == ("!=",):
            excluded.append(left - right)
        else:
            _reject(plain_relation(relation, environment.variable))
    relations = [apart_from_zero(value) for value in excluded]
    known = Ideal.of((*equations, *relations, *environment.relations))
    for name, value in substitution.items():
        solved = (Scalar.symbol(name) * value.denominator - value.numerator) in known
        if not solved or not never_together_zero([value.denominator], (*equations, *relations), environment.signs):
            _reject(f"{name} = {value}")
    left_over = [equation.substitute(substitution).numerator for equation in equations]
    return (*(value for value in left_over if value), *(apart_from_zero(v.substitute(substitution)) for v in excluded))


def _reject(line: str) -> NoReturn:
    message = f"the line {line} is not true"
    raise DerivationRejected(message, repair=_BUG, line=line)
