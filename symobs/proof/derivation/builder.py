"""Writing a derivation: a `Builder` collects steps and hands out terms, so that code reads like the textbook's page."""

from __future__ import annotations

import re
import warnings
from contextlib import contextmanager
from dataclasses import replace
from fractions import Fraction
from typing import TYPE_CHECKING, Any, TypeAlias

from symobs.exact import Matrix, Scalar, TooLarge, rounded
from symobs.exact.core.generators import function_named, identities, identities_at, roots_in
from symobs.formula.notation import LETTERS
from symobs.formula.phrases.languages import SPOKEN, Counted, StateChoice
from symobs.formula.tree import (
    Conjunction,
    Decimals,
    Derivative,
    Environment,
    Evaluated,
    Exact,
    Fact,
    Formula,
    HoldsExactlyWhere,
    Identity,
    Letter,
    LetterList,
    Literal,
    Predicate,
    Relation,
    Roots,
    SymbolList,
    evaluate,
)
from symobs.formula.tree.plain_text import plain_relation
from symobs.formula.tree.term import Term
from symobs.formula.tree.written import OPERATORS, written, written_relation
from symobs.ground.errors import DerivationRejected, SymobsWarning
from symobs.proof.certificate.claims import UNREADABLE, as_scalar, can_be_shown, verify
from symobs.proof.derivation.check import Derivation, after, inside_case, with_domain
from symobs.proof.derivation.convention_signs import set_apart
from symobs.proof.derivation.steps import (
    CaseStep,
    Conclude,
    Define,
    Diagram,
    Equal,
    Given,
    Note,
    Plot,
    Section,
    Sentence,
    Step,
    Tabulate,
)
from symobs.system.conditions import SumOfSquares, solved

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping, Sequence

    from symobs.formula.figures import Picture
    from symobs.stability.criteria.routh_table import RouthTable
    from symobs.system import StateSpace

#: What a slot of a sentence may hold besides formulas and words.
FACTS = (Relation, Predicate, Roots, HoldsExactlyWhere, Conjunction, Evaluated, SymbolList, LetterList, *SPOKEN)

Member: TypeAlias = Term | Scalar | Matrix | int
Slot: TypeAlias = Term | Fact | LetterList | Counted | StateChoice | str | Scalar | Matrix | int


def warn_left_out(what: str) -> None:
    """Warn that a page lacks something since its check failed, which is a bug."""
    message = f"{what} is left out: its check failed; please report this: it is a bug of symobs"
    warnings.warn(message, SymobsWarning, stacklevel=3)


def without_failing_cases(written: Derivation) -> Derivation:
    """Return a derivation without the pictures whose check fails, and with such cases named as undecided.

    Raises where another step fails.
    """
    steps, _ = _decided(written.steps, written.start, written)
    return replace(written, steps=steps)


def _decided(
    steps: Sequence[Step], environment: Environment, whole: Derivation
) -> tuple[tuple[Step, ...], Environment]:
    found: list[Step] = []
    for step in steps:
        try:
            environment, kept = after(step, environment, whole.discrete), step
        except (DerivationRejected, *UNREADABLE):
            if isinstance(step, Plot):
                warn_left_out(f"a picture of kind {type(step.picture).__name__}")
                continue
            if isinstance(step, Section):
                inside, environment = _decided(step.steps, environment, whole)
                kept = replace(step, steps=inside)
            elif isinstance(step, CaseStep):
                kept = _decided_case(step, environment, whole)
            else:
                raise
        found.append(kept)
    return tuple(found), environment


def _decided_case(step: CaseStep, environment: Environment, whole: Derivation) -> Step:
    """Return a case without the cases inside that fail, or, where it fails itself, the remark that it is undecided."""
    try:
        inside, _ = _decided(step.steps, inside_case(step, environment), whole)
    except (DerivationRejected, *UNREADABLE) as error:
        if not isinstance(error, TooLarge) and not isinstance(error.__cause__, TooLarge):
            warn_left_out("a case")
        relations = step.when.relations if isinstance(step.when, Conjunction) else (step.when,)
        zeros, others = ([r for r in relations if ("=" in r.operators) is equal] for equal in (True, False))
        if not zeros:
            when, *_ = sorted(others, key=lambda r: "!=" in r.operators)
            kind = "apart" if "!=" in when.operators else "positive"
            return Note(sentence(f"undecided_{kind}", {"when": _difference(when, environment)}))
        first, *further = sorted((_difference(r, environment) for r in zeros), key=lambda value: value.size)
        many = {"count": str(len(further))} if further else {}
        return Note(sentence("undecided_many" if further else "undecided_case", {"when": first, **many}))
    return replace(step, steps=inside)


def _difference(relation: Relation, environment: Environment) -> Scalar:
    """Return the value that a relation compares with 0: positive where one side is greater."""
    left, right = (as_scalar(evaluate(part, environment, Exact(environment))) for part in relation.members)
    return right - left if "<" in relation.operators else left - right


def shows(facts: Iterable[Relation], environment: Environment) -> bool:
    """Return whether lines can be written: not beyond the reach of the check, nor, with a warning, where it fails."""
    for fact in facts:
        if verify(fact, environment)[0]:
            continue
        if can_be_shown(fact, environment):
            warn_left_out(f"the line {plain_relation(fact, environment.variable)}")
        return False
    return True


def formula_of(member: Member) -> Formula:
    """Return the formula of a term, or a value written out."""
    if isinstance(member, Term):
        return member.formula
    return Literal(Scalar.of(member) if isinstance(member, int) else member)


def relation(*members: Member | str) -> Relation:
    """Return a chain: members joined by `=`, or by an operator that stands between them as a text."""
    formulas: list[Formula] = []
    operators: list[str] = []
    for member in members:
        if isinstance(member, str):
            operators.append(member)
            continue
        if formulas and len(operators) < len(formulas):
            operators.append("=")
        formulas.append(formula_of(member))
    return Relation(tuple(formulas), tuple(operators))


def differs(value: Scalar) -> Relation:
    """Return that a value is not 0, solved for a parameter where that is possible; of a sum of squares, that not all are."""
    if isinstance(value, SumOfSquares):
        return relation(Matrix.row(value.parts), "!=", Matrix.zeros(1, len(value.parts)))
    left, right = solved(value)
    return relation(left, "!=", right)


def predicate(name: str, subject: Member) -> Predicate:
    """Return the fact that a property holds."""
    return Predicate(name, formula_of(subject))


def sentence(key: str, slots: Mapping[str, Slot]) -> Sentence:
    """Return a phrase with its slots filled."""
    filled = tuple(
        (
            name,
            slot if isinstance(slot, (str, *FACTS)) else formula_of(slot),
        )
        for name, slot in slots.items()
    )
    return Sentence(key, filled)


#: What a square root of a sum is written as, where it stands in an argument.
_ROOTS = (r"\nu", r"\mu", r"\kappa", r"\eta")


def _roots_of_sums(values: Iterable[Scalar | Matrix]) -> list[str]:
    """Return the names of the roots whose radicand is a sum, those of cosines and sines among the others."""
    found: dict[str, None] = {}
    for value in values:
        for name in sorted(value.names):
            function = function_named(name)
            inner = roots_in(function.argument) if function and function.kind != "sqrt" else ()
            roots = [function] if function and function.kind == "sqrt" else inner
            found |= {root.name: None for root in roots if root.argument.numerator.size > 2}
    return list(found)


class Builder:
    """A derivation in the making: the steps so far and the environment they establish."""

    def __init__(self, plant: StateSpace, further: Mapping[str, int] | None = None) -> None:
        """Start with the free signals x, x̂, u of the plant, further ones with their sizes, and the declared signs."""
        others = dict(further or {})
        self.plant = plant
        self.start = Environment(
            variable=plant.variable,
            signals={"x": None, "x_hat": None, "u": None} | dict.fromkeys(others),
            sizes={"x": plant.order, "x_hat": plant.order, "u": max(plant.inputs, 1)} | others,
            signs=plant.symbols.signs,
            relations=plant.relations,
        )
        self.environment = self.start
        self.steps: list[Step] = []
        self.forms: dict[str, str] = {}
        #: What need not be said again in later cases.
        self.told: set[str] = set()
        self.asked: frozenset[str] = frozenset()
        #: Whether the entries of gains have letters even where they are short.
        self.in_letters = False

    def asked_for(self, specification: Mapping[str, object]) -> None:
        """Take note of the names in a specification: the signs declared of them are assumptions, too.

        That a horizon is positive needs no words.
        """
        asked = [value for name, value in specification.items() if name != "horizon"]
        self.asked = frozenset(re.findall(r"[^\W\d]\w*", str(asked)))

    def where(self, *relations: Scalar) -> None:
        """Let polynomials vanish from the start: what is told holds where they do."""
        self.start = self.start.with_relations(relations)
        self.environment = self.environment.with_relations(relations)

    def with_roots(self, *values: Scalar | Matrix) -> None:
        """Admit square roots: each squared is its radicand from the start."""
        self.where(*identities(values)[1])

    def in_time(self, *values: Scalar | Matrix, at: Scalar | None = None) -> None:
        """Admit functions of time, and what they are at an instant, with their algebraic dependences from the start."""
        self.in_time_by(*identities_at(values, at))
        self.name_roots(*values)

    def name_roots(self, *values: Scalar | Matrix) -> None:
        """Write square roots of sums as letters."""
        taken = {*self.plant.symbols.signs, *self.plant.field.names}
        letters = iter([form for form in _ROOTS if form.lstrip("\\") not in taken])
        for root in _roots_of_sums(values):
            self.forms[root] = next(letters, rf"\sqrt{{\cdot}}_{{{len(self.forms)}}}")

    def in_time_by(self, meanings: Mapping[str, Scalar], vanishing: tuple[Scalar, ...]) -> None:
        """Admit functions of time with given algebraic dependences, besides those that are admitted."""
        meanings = {**self.start.coefficients, **meanings}
        self.start = replace(self.start, coefficients=meanings).with_relations(vanishing)
        self.environment = replace(self.environment, coefficients=meanings).with_relations(vanishing)

    def derivation(self) -> Derivation:
        """Return what was written; a parameter with the name of a letter that is used is set without serifs."""
        written = Derivation(
            tuple(self.steps), self.start, {**self.plant.symbols.latex, **self.forms}, self.plant.is_discrete
        )
        return set_apart(written, {*self.environment.values, *self.environment.signals}, LETTERS)

    # -- terms --------------------------------------------------------------------------------------------------------

    def term(self, formula: Formula) -> Term:
        """Return a term in the current environment."""
        return Term(formula, self.environment)

    def __getitem__(self, text: str) -> Term:
        return self.term(Letter(text)) if text.isidentifier() else written(text, self.environment)

    def __call__(self, text: str, **slots: Member | str) -> Term:
        """Return a term written as text; a slot is a value, a term, or the letter of the page for one of the text."""
        return written(text, self.environment, **slots)

    def line(self, text: str, **slots: Member | str) -> Relation:
        """Return a relation written as text, with slots."""
        return written_relation(text, self.environment, **slots)

    def value(self, value: Scalar | Matrix | int) -> Term:
        """Return a value written out."""
        return self.term(formula_of(value))

    def decimals(self, value: Scalar | Matrix) -> tuple[str, Term] | tuple[()]:
        """Return what shows a value in decimals at the end of a chain; nothing where they would not help a reader."""
        near = rounded(value)
        if near is None:
            return ()
        return "=" if near == value else "≈", self.term(Decimals(near))

    def identity(self, order: int) -> Term:
        """Return I."""
        return self.term(Identity(order))

    @property
    def s(self) -> Term:
        """The variable."""
        return self.term(Letter("s"))

    def defines(self, name: str) -> bool:
        """Return whether a letter is established."""
        return self.environment.defines(name)

    # -- steps --------------------------------------------------------------------------------------------------------

    def given(self, *relations: Relation, silent: bool = False) -> None:
        """State data; where their denominators vanish the plant is not defined."""
        self.steps.append(Given(relations, silent=silent))
        for stated in relations:
            self.environment = with_domain(stated, self.environment)

    def assume(self, key: str, *values: Scalar) -> None:
        """State that polynomials are not zero from here on."""
        factors = [factor for value in values for factor, _ in value.numerator.factors()[1]]
        self.environment = replace(self.environment, nonzero=(*self.environment.nonzero, *factors))
        conditions = tuple(map(differs, values))
        self.steps.append(Given(conditions, sentence(key, {"condition": Conjunction(conditions)})))

    def set(self, name: str, value: Scalar | Matrix) -> Term:
        """Establish a letter by its value, without a display."""
        self.steps.append(Given((relation(self[name], value),), silent=True))
        self.environment = self.environment.extended_by(values={name: value})
        return self[name]

    def define(
        self,
        name: str,
        *members: Member | str,
        say: str = "",
        answer: bool = False,
        silent: bool = False,
        closing: bool = True,
        value: Scalar | Matrix | None = None,
        **slots: Slot,
    ) -> Term:
        """Introduce a letter by a formula; its value is shown last unless `closing` is False, decimals behind it.

        A `value` that is known already is not evaluated here; the check evaluates it.
        """
        members = tuple(self[m] if isinstance(m, str) and m not in OPERATORS else m for m in members)
        chain = [self.value(m) if not isinstance(m, (Term, str)) else m for m in members]
        exact = [m for m in chain if isinstance(m, Term) and not isinstance(m.formula, Decimals)]
        if value is None:
            value = exact[-1].value
        if closing and len(exact) == len(chain) and not isinstance(exact[-1].formula, Literal):
            chain.append(exact[-1].as_value)
        because = sentence(say, slots) if say else None
        self.steps.append(Define(relation(self[name], *chain), because, answer, silent))
        self.environment = self.environment.extended_by(values={name: value})
        return self[name]

    def in_decimals(self, name: str) -> None:
        """Show a letter's value in decimals, where they help a reader."""
        shown = self.decimals(self[name].value)
        if shown:
            self.equal(relation(self[name], *shown), say="in_decimals")

    def conclude_silently(self, *facts: Fact | str) -> None:
        """Hold the page to facts that need no words."""
        self.steps.append(Conclude(None, self._facts(facts)))

    def _facts(self, facts: tuple[Fact | str, ...]) -> tuple[Fact, ...]:
        return tuple(self.line(fact) if isinstance(fact, str) else fact for fact in facts)

    def assume_positive(self, values: Sequence[Scalar]) -> None:
        """State that values are positive throughout; values that are none say nothing."""
        if values:
            self.start, self.environment = (
                replace(each, positive=(*each.positive, *values)) for each in (self.start, self.environment)
            )
            self.conclude("declared", signs=Conjunction(tuple(relation(value, ">", 0) for value in values)))

    def name_coefficient(self, name: str, meaning: Scalar) -> Scalar:
        """Let a generator stand for a longer scalar from here on, without a display."""
        symbol = Scalar.symbol(name)
        self.steps.append(Define(relation(symbol, meaning), silent=True))
        self.environment = self.environment.extended_by(coefficients={name: meaning})
        return symbol

    def signal(self, name: str, formula: Term | str, say: str = "", *, silent: bool = False, **slots: Slot) -> Term:
        """Define a signal by others; a free signal ceases to be free."""
        formula = self[formula] if isinstance(formula, str) else formula
        because = sentence(say, slots) if say else None
        self.steps.append(Define(relation(self[name], formula), because, silent=silent))
        self.environment = self.environment.extended_by(signals={name: formula.formula})
        return self[name]

    def dynamics(self, name: str, formula: Term | str, say: str = "", *, silent: bool = False, **slots: Slot) -> None:
        """Give the derivative (shift) of a free signal."""
        formula = self[formula] if isinstance(formula, str) else formula
        because = sentence(say, slots) if say else None
        target = self.term(Derivative(Letter(name)))
        self.steps.append(Define(relation(target, formula), because, silent=silent))
        self.environment = self.environment.extended_by(dynamics={name: formula.formula})

    def equal(self, *relations: Relation | str, say: str = "", answer: bool = False, **slots: Slot) -> None:
        """Show relations on one display."""
        lines = (self.line(each) if isinstance(each, str) else each for each in relations)
        self.steps.append(Equal(tuple(lines), sentence(say, slots) if say else None, answer))

    def verified(self, key: str, *facts: Fact | str, **slots: Slot) -> None:
        """Show the check of an answer."""
        self.steps.append(Conclude(sentence(key, slots), self._facts(facts), verified=True))

    def conclude(self, key: str, *facts: Fact | str, **slots: Slot) -> None:
        """State a finding."""
        self.steps.append(Conclude(sentence(key, slots), self._facts(facts)))

    def caution(self, key: str, *facts: Fact | str, **slots: Slot) -> None:
        """Warn as an expert would."""
        self.steps.append(Note(sentence(key, slots), self._facts(facts), caution=True))

    def remark(self, key: str, *facts: Fact | str, **slots: Slot) -> None:
        """Remark."""
        self.steps.append(Note(sentence(key, slots), self._facts(facts)))

    def diagram(self, name: str, say: str = "", **labels: Member | Conjunction) -> None:
        """Draw a figure of `flow` with these gains; its signals have their own letters unless others are given."""
        from symobs.formula.figures import with_signals  # noqa: PLC0415 - only pages with a diagram pay for it

        given = {key: label if isinstance(label, Conjunction) else formula_of(label) for key, label in labels.items()}
        because = sentence(say, {}) if say else None
        self.steps.append(Diagram(name, tuple(with_signals(name, given).items()), because))

    def tabulate(
        self, polynomial: Term, variable: str = "", /, say: str = "", *, with_findings: bool = True, **slots: Slot
    ) -> RouthTable:
        """Show Routh's table of a polynomial, in another variable than the page's where one is named.

        The findings of the table are printed below it, unless `with_findings` is False.
        """
        from symobs.proof.derivation.routh_check import findings_of  # noqa: PLC0415 - only pages of regions pay for it
        from symobs.stability.criteria.routh_table import routh_table  # noqa: PLC0415

        variable = variable or self.environment.variable
        coefficients = polynomial.value.coefficients(variable)
        table = routh_table(coefficients, {variable, *self.environment.signs, *self.environment.coefficients})
        findings = findings_of(table, coefficients, variable, self.environment.signs) if with_findings else ()
        because = sentence(say, slots) if say else None
        self.steps.append(Tabulate(polynomial.formula, table, variable, because, findings))
        return table

    def plot(self, picture: Picture, subject: Member, say: str = "", **slots: Slot) -> None:
        """Show where a polynomial is stable, or how its roots move; a picture that its check rejects is left out.

        So is one whose window is too small beside its place, or too large, for floating point.
        """
        whole: tuple[Any, ...] = picture.window
        ends = whole if isinstance(whole[0], tuple) else (whole,)
        if all(
            max(abs(low), abs(high), Fraction(1, 10**280)) < min((high - low) * 10**12, 10**280) for low, high in ends
        ):
            self.steps.append(Plot(picture, formula_of(subject), sentence(say, slots) if say else None))

    @contextmanager
    def section(self, key: str, **slots: Slot) -> Iterator[None]:
        """Write the steps inside under a title."""
        outer, self.steps = self.steps, []
        try:
            yield
        finally:
            inner, self.steps = self.steps, outer
            self.steps.append(Section(sentence(key, slots), tuple(inner)))
