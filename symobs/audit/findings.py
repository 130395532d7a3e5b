"""What is wrong among the printed equations of a problem, with the right value and the reason."""

from __future__ import annotations

from dataclasses import field, replace
from itertools import pairwise, product
from typing import TYPE_CHECKING

from symobs.audit import differences
from symobs.audit.alphabet import Letters
from symobs.audit.evaluation import Flexible, Printed, common, equal, holds, is_signal, value_of
from symobs.audit.functions import Misfit, Unknown
from symobs.audit.grammar import Node, letters_of, read_relation
from symobs.audit.letters import INSTANTS, values
from symobs.audit.signals import signals
from symobs.audit.slips import Patience, found_slip
from symobs.audit.spectra import spectral, spectrum_text
from symobs.audit.statements import Statement, statements
from symobs.errors import BudgetExceeded, CertificateRejected, ProblemErrors, SymobsError, UnknownName
from symobs.exact import Matrix, Scalar
from symobs.expect import mismatches
from symobs.formula import Environment, Signal
from symobs.formula.term import Term
from symobs.record import dataclass
from symobs.viewed import Viewed

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from symobs.convention import Convention
    from symobs.method import Result
    from symobs.problem import Problem

_MOST_LETTERS = 3


@dataclass(frozen=True)
class Finding:
    """A printed equation that is false: where it stands, what is printed, what is right, and why."""

    where: str
    erratum: str
    printed: str
    right: str
    reason: str


@dataclass(frozen=True)
class Audited:
    """What the audit of one problem found, among how many printed equations."""

    title: str
    checked: int
    findings: tuple[Finding, ...]


def audit(problem: Problem) -> Audited:
    """Solve a problem and hold every printed equation against the answers.

    Raises `ProblemErrors` with every entry that cannot be read.
    """
    entries = statements(problem.printed, problem.convention)
    results = problem.solve()
    found: list[Finding] = []
    errors: list[SymobsError] = []
    desks: dict[str, _Desk] = {}
    patience = Patience()
    for entry in entries:
        name = entry.convention.name
        desk = desks[name] = desks.get(name) or _Desk(problem, results, entry.convention, patience)
        try:
            found += desk.read(entry)
        except SymobsError as error:
            error.where = error.where or entry.place
            errors.append(error)
    if errors:
        raise ProblemErrors(tuple(errors))
    return Audited(problem.title, len(entries), tuple(found))


@dataclass()
class _Desk:
    """One convention's letters, and the equations found true so far, whose sides later ones may lack."""

    problem: Problem
    results: Sequence[Result]
    convention: Convention
    patience: Patience
    known: list[Node] = field(default_factory=list)
    values: Mapping[str, Scalar | Matrix] = field(init=False)
    let: Mapping[str, Node] = field(init=False, default_factory=dict)
    environments: dict[object, Environment] = field(init=False, default_factory=dict)

    def __post_init__(self) -> None:
        self.values = values(self.problem.plant, self.results, self.convention)

    def read(self, entry: Statement) -> list[Finding]:
        """Return what is wrong with one entry."""
        if entry.expect:
            lines = mismatches([Viewed(result, self.convention) for result in self.results], entry.expect)
            texts = [line.partition(": expected ")[2].partition(", found ") for line in lines]
            return [Finding(entry.where, entry.erratum, came, right, "") for came, _, right in texts]
        self.let, self.environments = entry.let, {}
        findings = []
        for left, right in pairwise(entry.members):
            finding = self._checked(left, right)
            if finding is None:
                self.known += [left, right]
            else:
                equation, reason = self._confirmed(finding[0]), finding[1]
                findings.append(Finding(entry.where, entry.erratum, f"{left} = {right}", equation, reason))
        return findings

    def _confirmed(self, right: str) -> str:
        """Return what is said to be right, read as if it were printed: it must be true.  Too long a text is left out."""
        try:
            members = read_relation(right, "") if right else ()
        except BudgetExceeded:
            return ""
        if any(self._checked(*pair) is not None for pair in pairwise(members)):
            message = f"the equation {right} does not hold"
            raise CertificateRejected(message, repair="please report this: it is a bug of symobs", claim=right)
        return right

    # -- one equation -------------------------------------------------------------------------------------------------

    def environment(self, left: Node, right: Node) -> Environment:
        """Return what the letters mean in an equation: signals depend on which of them it speaks of."""
        inside = letters_of(*(self.let[name] for name in letters_of(left, right) if name in self.let))
        mentioned = (frozenset([*letters_of(left, right), *inside]), frozenset(letters_of(right)))
        if mentioned not in self.environments:
            made = signals(self.problem.plant, self.results, self.convention, *mentioned)
            environment = made.having(values=dict(self.values))
            for name, meaning in self.let.items():
                environment = _with_let(environment, name, meaning)
            self.environments[mentioned] = environment
        return self.environments[mentioned]

    def true(self, left: Node, right: Node) -> bool:
        """Tell whether an equation holds."""
        try:
            return holds(*spectral(left, right), self.environment(left, right))
        except Misfit:
            return False

    def _checked(self, printed_left: Node, printed_right: Node) -> tuple[str, str] | None:
        """Return (the right equation, the reason) of a false equation, None of a true one."""
        environment = self.environment(printed_left, printed_right)
        try:
            left, right = spectral(printed_left, printed_right)
            sides = [self._value(side, environment) for side in (left, right)]
            pair = common(sides[0], sides[1], environment)
        except Misfit as misfit:
            return self._misfit(printed_left, printed_right, str(misfit), environment)
        if equal(*pair):
            return None
        if not letters_of(left) and letters_of(right):
            left, right, pair = right, left, (pair[1], pair[0])
        spectra = (left, right) != (printed_left, printed_right) and (right, left) != (printed_left, printed_right)
        if is_signal(pair[0]):
            return self._signals(left, right, pair, environment)
        return self._values(left, right, pair, environment, spectra=spectra)

    def _value(self, node: Node, environment: Environment) -> Printed:
        try:
            return value_of(node, environment)
        except Unknown as unknown:
            raise self._unknown(unknown.name, environment) from None

    def _unknown(self, name: str, environment: Environment) -> UnknownName:
        from difflib import get_close_matches  # noqa: PLC0415 - needed for messages only

        known = [*environment.values, *environment.signals]
        near = get_close_matches(name, known, 1)
        repair = f'did you mean "{near[0]}"?' if near else "declare it in [symbols], or say in let what it stands for"
        message = (
            f'the letter "{name}" means nothing in the convention {self.convention.name}, with the tasks of this file'
        )
        return UnknownName(message, repair=repair, name=name)

    # -- what is wrong ------------------------------------------------------------------------------------------------

    def _slip(self, left: Node, right: Node, environment: Environment, *, fit: bool = True) -> tuple[str, str] | None:
        fields = {name for result in self.results for name in result.fields if name[0].islower()}
        matrices = {f"{result.task}_matrix" for result in self.results}
        alphabet = Letters(environment, frozenset(fields | matrices), fit=fit)
        found = found_slip(left, right, self.patience.asks(self.true), alphabet)
        return None if found is None else (f"{found[0]} = {found[1]}", found[2])

    def _misfit(self, left: Node, right: Node, message: str, environment: Environment) -> tuple[str, str]:
        slip = self._slip(left, right, environment, fit=False)
        if slip is not None:
            return slip[0], f"{message}; {slip[1]}"
        for side, other in ((left, right), (right, left)):
            try:
                value = self._value(side, environment)
                if side.kind == "call" and side.text == "eigenvalues" and isinstance(value, Term):
                    return spectrum_text(side, value.value, environment.variable), message
                self._value(other, environment)
            except Misfit:
                continue
            if isinstance(value, Term) and letters_of(side) and not is_signal(value):
                return f"{side} = {differences.value_text(value.value)}", message
        return "", message

    def _values(
        self, left: Node, right: Node, pair: tuple[Term, Term], environment: Environment, *, spectra: bool
    ) -> tuple[str, str] | None:
        """Return what is wrong with a value, or with a formula for one; None where only rounding parts them."""
        exact, printed = differences.as_matrix(pair[0].value), differences.as_matrix(pair[1].value)
        decimals = differences.decimals_of(right, exact.shape)
        wrong = differences.wrong_entries(printed, exact, decimals)
        if not wrong:
            return None
        variable = environment.variable
        reason = ""
        if exact.shape == (1, 1):
            reason = differences.polynomial_reason(printed[0, 0], exact[0, 0], variable)
        numbers = self._is_written_out(right, environment)
        plain = bool(reason) and "; " not in reason and not spectra
        if not numbers or not (plain or _is_evident(left, exact, printed, len(wrong))):
            slip = self._slip(left, right, environment)
            if slip is not None:
                return slip
        if spectra:
            return spectrum_text(left, exact[0, 0], variable), "the eigenvalues are others"
        factor = None if numbers else self._missing_factor(left, right)
        if factor is not None:
            return factor
        whole = differences.reasons(printed, exact, decimals, str(left))
        value = exact[0, 0] if isinstance(pair[1].value, Scalar) else exact
        return f"{left} = {differences.value_text(value, decimals)}", reason or whole

    def _is_written_out(self, node: Node, environment: Environment) -> bool:
        """Whether a side has no letters but the problem's own symbols."""
        plain = {*self.problem.plant.symbols.signs, *INSTANTS, environment.variable}
        return set(letters_of(node)) <= plain

    def _missing_factor(self, left: Node, right: Node) -> tuple[str, str] | None:
        """Return the equation with a factor before its left side that an equation above has as a side."""
        for node in reversed(self.known):
            if node.kind == "block" and self.true(Node("product", (node, left)), right):
                fixed = Node("product", (node, left))
                return f"{fixed} = {right}", f"the factor {node} before {left} is missing"
        return None

    def _signals(self, left: Node, right: Node, pair: tuple[Term, Term], environment: Environment) -> tuple[str, str]:
        exact, printed = (self._coefficients(term) for term in pair)
        names = [name for name in {**exact, **printed} if exact.get(name) != printed.get(name)]
        wrong = {
            name: differences.wrong_entries(printed[name], exact[name], {})
            for name in names
            if name in exact and name in printed
        }
        single = len(names) == 1 and len(wrong.get(names[0], ())) == 1
        if not single:
            slip = self._slip(left, right, environment)
            if slip is not None:
                return slip
        term = self._missing_term(left, right, exact, printed, environment)
        if term is not None:
            return term
        reasons = []
        for name in names:
            if name not in printed:
                reasons.append(f"the term {_term_text(exact[name], name)} is missing")
            elif name not in exact:
                reasons.append(f"the term {_term_text(printed[name], name)} does not belong there")
            else:
                whole = f"the coefficient of {name}"
                why = differences.reasons(printed[name], exact[name], {}, whole)
                reasons.append(why if why.startswith(whole) else f"in {whole} {why}")
        terms = " + ".join(_term_text(value, name) for name, value in exact.items()).replace("+ -", "- ") or "0"
        return "" if terms == str(left) else f"{left} = {terms}", "; ".join(reasons)

    def _coefficients(self, term: Term) -> dict[str, Matrix]:
        value = term.value
        assert isinstance(value, Signal)  # noqa: S101 - an invariant of the caller
        return {name: part for name, part in value.coefficients.items() if not part.is_zero}

    def _missing_term(
        self,
        left: Node,
        right: Node,
        exact: Mapping[str, Matrix],
        printed: Mapping[str, Matrix],
        environment: Environment,
    ) -> tuple[str, str] | None:
        """Return the equation with one more term, a product of letters of the equation and one signal."""
        names = [name for name in {**exact, **printed} if exact.get(name) != printed.get(name)]
        if len(names) != 1 or self._has_numbers(right):
            return None
        true, written = self.patience.asks(self.true), self._matrices(letters_of(left, right), environment)
        offered = self._matrices([*written, *environment.values], environment)
        for letters, most in ((written[:6], _MOST_LETTERS), (offered[:16], 2)):
            for chosen in (each for count in range(1, most + 1) for each in product(letters, repeat=count)):
                term = Node("product", tuple(Node("letter", text=name) for name in (*chosen, names[0])))
                terms = right.parts if right.kind == "sum" else (right,)
                for last in (term, Node("negative", (term,))):
                    fixed = Node("sum", (*terms, last))
                    if true(left, fixed):
                        return f"{left} = {fixed}", f"the term {last} is missing"
        return None

    def _matrices(self, names: Sequence[str], environment: Environment) -> list[str]:
        values = environment.values
        return [name for name in dict.fromkeys(names) if isinstance(values.get(name), Matrix)]

    def _has_numbers(self, node: Node) -> bool:
        return node.kind == "number" or any(map(self._has_numbers, node.parts))


def _is_evident(left: Node, exact: Matrix, printed: Matrix, wrong: int) -> bool:
    """Whether it is the numbers on the right that are wrong: a value of a letter, one entry among several, one number.

    A single number says too little to tell which letter was meant instead of another.
    """
    if left.kind == "letter" or (left.kind == "call" and left.text == "size"):
        return True
    alone = exact.shape == (1, 1)
    return (alone and exact[0, 0].is_constant and printed[0, 0].is_constant) or (not alone and wrong == 1)


def _term_text(value: Matrix, name: str) -> str:
    if value.shape == (1, 1):
        scalar = value[0, 0]
        text = differences.value_text(scalar)
        if scalar == Scalar.of(1):
            return name
        return f"-{name}" if scalar == Scalar.of(-1) else f"({text}) {name}" if " " in text else f"{text} {name}"
    return f"{differences.value_text(value)} {name}"


def _with_let(environment: Environment, name: str, meaning: Node) -> Environment:
    """Return the environment in which a letter of the entry stands for a value or a signal."""
    try:
        found = value_of(meaning, environment)
    except (Misfit, Unknown):  # it is another equation that uses this letter, or the letter is reported where it stands
        return environment
    if isinstance(found, Flexible):
        return environment
    if is_signal(found):
        return environment.having(signals={name: found.formula})
    others = {key: formula for key, formula in environment.signals.items() if key != name}
    return replace(environment, signals=others, values={**environment.values, name: found.value})
