"""Derivations, and the check without which none is shown (trusted).

`Derivation.check` walks the steps in order, builds the environment from what is given and defined, and verifies every
link of every relation, also those inside sentences; a false line raises `DerivationRejected`, and so does a letter
that was not established before.  Renderers accept checked derivations only.
"""

from __future__ import annotations

from dataclasses import field, replace
from typing import TYPE_CHECKING, TypeAlias, assert_never

from symobs.exact import Ideal, Matrix, Scalar, TooLarge, product_of
from symobs.exact.core.generators import stands_inside
from symobs.exact.numerals.rounded_roots import are_rounded_roots
from symobs.formula.phrases import ASSERTS, NAMING
from symobs.formula.phrases.languages import SPOKEN
from symobs.formula.tree import (
    ROOT_DIGITS,
    Apply,
    Conjunction,
    Derivative,
    Environment,
    Evaluated,
    Exact,
    Fact,
    Formula,
    HoldsExactlyWhere,
    Letter,
    LetterList,
    Literal,
    Predicate,
    Relation,
    Roots,
    RoundedRoots,
    Signal,
    SymbolList,
    evaluate,
    letters,
    roots_written,
)
from symobs.formula.tree.plain_text import plain, plain_relation
from symobs.ground.dataclass import dataclass
from symobs.ground.errors import DerivationRejected
from symobs.proof.certificate.claims import UNREADABLE, as_scalar, verify
from symobs.proof.derivation.facts import (
    BUG,
    PREDICATES,
    are_roots,
    difference_of,
    is_exactly,
    on_stratum,
    polynomial_of,
    reject,
    subjects,
)
from symobs.proof.derivation.sentence_context import SentenceContext
from symobs.proof.derivation.steps import (
    CaseStep,
    Conclude,
    Define,
    Diagram,
    Equal,
    Given,
    Inequalities,
    Note,
    Plot,
    RegionSummary,
    Section,
    Sentence,
    Step,
    Tabulate,
    literals,
)
from symobs.proof.derivation.wording_check import (
    demands,
    formula_in,
    meets_obligations,
    reject_other_map,
    relation_fits,
    with_limit,
)
from symobs.stability.criteria.stability import monic
from symobs.system.conditions import vanishing_factors

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from symobs.formula.figures import Picture

Value: TypeAlias = Scalar | Matrix | Signal


@dataclass
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
        """Verify every line; return the final environment.  Raises `DerivationRejected`."""
        known: Environment | None = self.__dict__.get("_checked")
        if known is None:
            known = after_all(self.steps, self.start, self.discrete)
            if (broken := _broken_promise(self.steps)) is not None:
                reject(f"{broken}, which promises cases that do not follow,")
            object.__setattr__(self, "_checked", known)
        return known


def after_all(steps: tuple[Step, ...], environment: Environment, discrete: bool) -> Environment:  # noqa: FBT001
    """Verify steps one after the other and return the environment after them."""
    for step in steps:
        try:
            environment = after(step, environment, discrete)
        except TooLarge:
            raise
        except UNREADABLE as error:
            message = f"a step of kind {type(step).__name__} cannot be read: {error}"
            raise DerivationRejected(message, repair=BUG, line=str(step)) from error
    return environment


def _broken_promise(steps: tuple[Step, ...]) -> str | None:
    """Return the phrase of a sentence that promises cases after which there are none, nor one that is undecided."""
    broken = None
    for step in _in_order(steps):
        key = getattr(getattr(step, "sentence", None), "key", "")
        if isinstance(step, CaseStep) or demands(key, "leaves_undecided"):
            broken = None
        elif demands(key, "promises_cases"):
            broken = key
    return broken


def _in_order(steps: tuple[Step, ...]) -> Iterator[Step]:
    """Yield the steps of a derivation, those of its sections among them."""
    for step in steps:
        yield step
        yield from _in_order(step.steps) if isinstance(step, Section) else ()


def inside_case(step: CaseStep, environment: Environment) -> Environment:
    """Return the environment inside a case, after verifying that its substitution describes it."""
    stratum = on_stratum(step.when, dict(step.substitution), environment)
    return replace(stratum, values={name: value for name, value in stratum.values.items() if name not in step.anew})


def after(step: Step, environment: Environment, discrete: bool) -> Environment:  # noqa: FBT001
    """Verify one step and return the environment after it."""
    match step:
        case Given(relations, sentence):
            said = [slot for _, slot in sentence.slots] if sentence else []
            stated = {part for slot in said for part in (slot.relations if isinstance(slot, Conjunction) else (slot,))}
            for relation in relations:
                if relation.operators == ("!=",) and (not sentence or relation in stated):
                    environment = _assume(relation, environment)
                else:
                    environment = with_domain(relation, _introduce(relation, environment))
        case Define(relation):
            environment = _introduce(relation, environment)
        case Equal(relations):
            for relation in relations:
                _fact(relation, environment, discrete)
        case Conclude(facts=facts) | Note(facts=facts):
            for fact in facts:
                _fact(fact, environment, discrete)
        case Diagram(name, labels):
            from symobs.proof.derivation.figures_check import equations_of  # noqa: PLC0415 - only pages with a diagram pay for it

            for relation in equations_of(name, dict(labels), environment):
                _fact(relation, environment, discrete)
        case Tabulate():
            environment = _tabulated(step, environment, discrete)
        case Inequalities(fact):
            _fact(fact, environment, discrete)
        case RegionSummary(polynomial):
            _about_letters(polynomial, environment)
            value = as_scalar(evaluate(polynomial, environment, Exact(environment)))
            from symobs.proof.derivation.region_check import is_survey  # noqa: PLC0415 - only pages of regions pay for it

            if not is_survey(step, value, environment, discrete=discrete):
                reject(f"that this is the region of {plain(polynomial, environment.variable)}")
        case Plot(picture, subject):
            _drawn(picture, subject, environment, discrete)
        case CaseStep(steps=inside):
            after_all(inside, inside_case(step, environment), discrete)
        case Section(title, inside):
            _sentence(title, environment, discrete)
            _owed(title, step, environment)
            environment = after_all(inside, environment, discrete)
        case _:
            assert_never(step)
    sentence = getattr(step, "sentence", None)
    if sentence is not None:
        _sentence(sentence, environment, discrete)
        _owed(sentence, step, environment)
        environment = with_limit(sentence, environment)
    shown = _displayed(step, sentence)
    return replace(environment, shown=shown) if shown else environment


def _displayed(step: Step, sentence: Sentence | None) -> tuple[Fact, ...]:
    """Return the relations that a step displays, and the facts in its sentence."""
    own = () if getattr(step, "silent", False) else getattr(step, "relations", (getattr(step, "relation", None),))
    slots = () if sentence is None else (slot for _, slot in sentence.slots)
    return tuple(part for part in (*slots, *own) if isinstance(part, (Relation, HoldsExactlyWhere)))


def _tabulated(step: Tabulate, environment: Environment, discrete: bool) -> Environment:  # noqa: FBT001
    """Verify a table and its polynomial; define Δₙ₋₁ for this table."""
    polynomial, variable = step.polynomial, step.variable
    _about_letters(polynomial, environment)
    value = as_scalar(evaluate(polynomial, environment, Exact(environment)))
    from symobs.proof.derivation.routh_check import is_tabulated, last_determinant  # noqa: PLC0415 - only pages of regions pay for it

    if stands_inside(environment.variable, value) or not is_tabulated(step, value, environment):
        reject(f"that this is the table of {plain(polynomial, environment.variable)} in {variable}")
    if step.sentence is not None and "polynomial" in dict(step.sentence.slots):
        _fact(Relation((formula_in(step.sentence, "polynomial"), polynomial), ("=",)), environment, discrete)
    return environment.extended_by(values=last_determinant(value, variable))


def _drawn(picture: Picture, subject: Formula, environment: Environment, discrete: bool) -> None:  # noqa: FBT001
    """Reject a plot that is false of its polynomial."""
    from symobs.proof.derivation.plot_check import faults, relations_of  # noqa: PLC0415 - only pages of regions pay for it

    for formula in (subject, *(member for relation in relations_of(picture) for member in relation.members)):
        _established(formula, environment)
    if not letters(subject) - {"s"} and not isinstance(subject, Apply):
        reject(f"a picture of {plain(subject, environment.variable)}, which is no letter's,")
    fault = next(faults(picture, subject, environment, discrete=discrete), None)
    if fault is not None:
        reject(f"{fault}, in a picture,")


def _sentence(sentence: Sentence, environment: Environment, discrete: bool) -> None:  # noqa: FBT001
    for _, slot in sentence.slots:
        if not relation_fits(sentence.key, slot, environment):
            reject(f"{slot}, which is not what {sentence.key} speaks of,")
        if isinstance(slot, (Relation, Predicate, Roots, HoldsExactlyWhere, Conjunction, Evaluated, SymbolList)):
            _fact(slot, environment, discrete)
        elif not isinstance(slot, (str, LetterList, *SPOKEN)):
            _established(slot, environment)
            if next(literals(slot), None) is not None and sentence.key not in NAMING:
                reject(f"{plain(slot, environment.variable)}, a value in a sentence without what it is the value of,")


def _owed(sentence: Sentence, step: Step, environment: Environment) -> None:
    """Reject a sentence that asserts, rests on or applies what its step does not contain, whatever kind of step it is."""
    facts = step.facts if isinstance(step, Conclude | Note) else ()
    asserted = ASSERTS.get(sentence.key, ())
    if not {fact.name for fact in facts if isinstance(fact, Predicate)}.issuperset(asserted):
        reject(f"{sentence.key}, which rests on {', '.join(asserted)},")
    introduced = step.relation if isinstance(step, Define) else None
    shown = step.relations if isinstance(step, Equal) else ()
    if not meets_obligations(
        sentence.key, SentenceContext((*facts, *shown), environment, dict(sentence.slots), introduced)
    ):
        reject(f"{sentence.key}, which rests on another fact, number or equation,")
    reject_other_map(sentence, introduced, environment)


def _about_letters(formula: Formula, environment: Environment) -> None:
    """Reject a property of written-out values only, which are no quantity of the problem."""
    _established(formula, environment)
    if not letters(formula) - {"s"}:
        reject(f"a property of {plain(formula, environment.variable)}, which is no letter's,")


def _fact(fact: Fact, environment: Environment, discrete: bool) -> None:  # noqa: FBT001
    """Verify a relation or a property; what holds whatever named coefficients stand for is seen first."""
    if isinstance(fact, Relation):
        for member in fact.members:
            _established(member, environment)
        if verify(fact, environment)[0] == "":
            reject(plain_relation(fact, environment.variable))
        return
    if isinstance(fact, SymbolList):
        _established(Literal(product_of(map(Scalar.symbol, fact.names))), environment)
        return
    if isinstance(fact, Conjunction):
        for part in fact.relations:
            _fact(part, environment, discrete)
        return
    if isinstance(fact, Evaluated):
        _fact(Relation((fact.formula, fact.value), ("=",)), environment, discrete)
        return
    free = replace(environment, coefficients={})
    if isinstance(fact, Roots):
        environment = free
        _about_letters(fact.polynomial, environment)
        value = as_scalar(evaluate(fact.polynomial, environment, Exact(environment)))
        polynomial = polynomial_of(value, environment)
        if polynomial is not value:
            polynomial = monic(polynomial, environment.variable)
        if not are_roots(fact.values, polynomial, environment):
            reject(f"the roots of {polynomial} are {', '.join(map(str, fact.values))}")
        if isinstance(fact, RoundedRoots) and not are_rounded_roots(fact.values, fact.texts, ROOT_DIGITS):
            reject(f"that the roots are about {fact.texts}")
        return
    if isinstance(fact, HoldsExactlyWhere):
        _about_letters(fact.property.subject, environment)
        found = evaluate(fact.property.subject, environment, Exact(environment))
        if stands_inside(environment.variable, found):
            from symobs.proof.derivation.region_check import delayed_intervals  # noqa: PLC0415 - only pages of regions pay for it

            if fact.property.name != "stable" or delayed_intervals(found, environment) != (fact.where,):
                reject(f"that {found} is {fact.property.name} exactly there")
            return
        values: Scalar | tuple[Scalar, ...] = subjects(fact.property.name, found, environment.variable)
        if fact.property.name != "positive_definite" and isinstance(values, tuple):
            (value,) = values
            values = polynomial_of(value, environment)
        if not is_exactly(fact, values, environment, discrete=discrete):
            reject(
                f"{found} is {fact.property.name} exactly where "
                f"{', '.join(plain_relation(relation, environment.variable) for relation in fact.where)}"
            )
        return
    _about_letters(fact.subject, environment)
    if not any(_has_property(fact, here, discrete) for here in (free, environment)):
        reject(f"{fact.name}({evaluate(fact.subject, environment, Exact(environment))})")


def _has_property(fact: Predicate, environment: Environment, discrete: bool) -> bool:  # noqa: FBT001
    found = evaluate(fact.subject, environment, Exact(environment))
    parts = subjects(fact.name, found, environment.variable)
    return all(PREDICATES[fact.name](part, environment, discrete) for part in parts)


def _introduce(relation: Relation, environment: Environment) -> Environment:
    """Verify the links after the first member and let the first member mean the rest."""
    target, *rest = relation.members
    for member in rest:
        _established(member, environment)
    if relation.operators[0] != "=":
        reject(plain_relation(relation, environment.variable))
    anew = isinstance(target, Letter) and target.name in environment.values  # written anew, not given another meaning
    agreeing = relation if anew else Relation(tuple(rest), relation.operators[1:])
    if len(agreeing.members) > 1 and verify(agreeing, environment)[0] == "":
        reject(plain_relation(relation, environment.variable))
    return _meaning(target, rest, environment)


def with_domain(relation: Relation, environment: Environment) -> Environment:
    """Assume the denominators of the data are nonzero; elsewhere the plant is undefined."""
    denominators = [value.common_denominator() for value in literals(relation.members)]
    factors = vanishing_factors(denominators, environment.signs)
    return replace(environment, domain=tuple(dict.fromkeys((*environment.domain, *factors))))


def _assume(relation: Relation, environment: Environment) -> Environment:
    """Let the factors of a difference, which there must be, be different from 0 from here on."""
    difference = difference_of(relation, environment).numerator
    if difference in Ideal.where(environment.relations):
        reject(plain_relation(relation, environment.variable))
    return replace(environment, nonzero=(*environment.nonzero, *(f for f, _ in difference.factors()[1])))


def _meaning(target: Formula, rest: list[Formula], environment: Environment) -> Environment:
    match target:
        case Derivative(Letter(name)) if _is_free(name, environment):
            return environment.extended_by(dynamics={name: rest[0]})
        case Literal(value) if str(value) in value.names:
            (name,) = value.names
            _new_name(name, environment)
            meaning = evaluate(rest[-1], environment, Exact(replace(environment, coefficients={})))
            return environment.extended_by(coefficients={name: meaning})
        case Letter(name) if name not in environment.signals or _is_free(name, environment):
            last = next((member for member in reversed(rest) if isinstance(member, Literal)), rest[0])
            value = evaluate(last, environment, Exact(environment))
            if isinstance(value, Signal):
                return environment.extended_by(signals={name: rest[0]})
            if name == "s" or name in environment.signals:
                reject(f"{name}, which stands for something else, as a name for a value")
            if isinstance(last, Literal):
                value = last.value
            return environment.extended_by(values={name: value})
        case _:
            return reject("only a letter, a derivative or a named coefficient can be introduced")


def _is_free(name: str, environment: Environment) -> bool:
    """Return whether a signal has neither a definition nor a derivative: only such a one can be given either."""
    return environment.signals[name] is None and name not in environment.dynamics


def _new_name(name: str, environment: Environment) -> None:
    """Reject a coefficient's name that stands for something already: a parameter would lose its generality."""
    used = [*environment.values.values(), *environment.coefficients.values()]
    if name in environment.signs or name in environment.coefficients or any(name in value.names for value in used):
        reject(f"{name}, which means something already, as a name for a coefficient")


def _established(formula: Formula, environment: Environment) -> None:
    """Reject letters that are not established, and roots of what may be negative: they would not be real."""
    for name in letters(formula):
        if not environment.defines(name):
            reject(f"{name} is used before it is established")
    for root in roots_written(formula):
        _fact(Relation((Literal(root.argument), Literal(Scalar.of(0))), (">=",)), environment, discrete=False)
