"""The auditor of printed equations in one convention: evaluation, and the cause of every failure."""

from __future__ import annotations

import re
from contextlib import suppress
from dataclasses import field, replace
from itertools import chain, combinations, pairwise, product
from typing import TYPE_CHECKING, Any

from symobs.applications.audit import differences
from symobs.applications.audit.differences import Reason, Remark, WrongEntries, WrongTerm
from symobs.applications.audit.equations import (
    FUNCTIONS,
    INSTANTS,
    NOT_POSITIVE,
    EquationConditions,
    Gap,
    Reading,
    exceptions,
    read_relation,
    signals,
    telling,
    text_of_value,
    values,
)
from symobs.applications.audit.evaluation import (
    Flexible,
    Misfit,
    Printed,
    Unknown,
    as_printed,
    common,
    equal,
    formula_of,
    in_form,
    is_rounded,
    is_spectrum,
    spectral,
    spectrum_text,
    value_of,
)
from symobs.applications.audit.slips import CandidateLetters, SearchBudget, found_slip
from symobs.exact import Matrix, Scalar
from symobs.exact.core.polynomial import product_of
from symobs.formula.convention import Convention, convention_named
from symobs.formula.expression import declared_name
from symobs.formula.expression.source import shown
from symobs.formula.expression.syntax import SyntaxNode, every, letters_of
from symobs.formula.tree import Environment, Signal
from symobs.ground.dataclass import dataclass
from symobs.ground.errors import (
    BudgetExceeded,
    CertificateRejected,
    InputError,
    ProblemErrors,
    SymobsError,
    UnknownName,
    UsageError,
)
from symobs.problem.expect import mismatches
from symobs.proof.certificate.claims import EVALUATION_ERRORS
from symobs.system.conditions import vanishing_factors
from symobs.tasks.result.in_convention import ResultInConvention

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping, Sequence

    from symobs.applications.audit.equations import Kept
    from symobs.problem import Problem
    from symobs.tasks.result import Result


# The `[[printed]]` entries of a file: places and printed equations.


_MOST_LETS = 20
_WHERE = " where"
_FUNCTIONS = {name for name, _ in FUNCTIONS}


@dataclass
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


# Whether a change that makes a printed equation true says what was meant.


def is_plausible(printed: Sequence[SyntaxNode], changed: Sequence[SyntaxNode], reading: Reading) -> bool:
    """Return whether an equation may have been meant as it was changed: by what is in it, not by what is lost.

    A term that vanishes, L (y - C x) for L (y - C x_hat), leaves its factor L free; and a letter that is given by
    signals, u = -K x, was not given by their derivatives, which hold whatever it is.
    """
    if printed[0].kind == "letter" and not _derivatives(printed, reading) and _derivatives(changed, reading):
        return False
    known = {part for side in printed for part in every(side)}
    new = [part for side in changed if not _vanishes(side, reading) for part in every(side) if part not in known]
    return not any(part.kind in {"sum", "product", "negative"} and _vanishes(part, reading) for part in new)


def _derivatives(sides: Sequence[SyntaxNode], reading: Reading) -> bool:
    """Return whether there is a derivative of a signal in an equation."""
    signals = reading.environment.signals
    return any(
        part.kind == "primed" and part.parts[0].text in signals and part.parts[0].kind == "letter"
        for side in sides
        for part in every(side)
    )


def _vanishes(node: SyntaxNode, reading: Reading) -> bool:
    """Return whether a part of an equation is zero."""
    try:
        found = value_of(node, reading)
        return equal(*common(found, Scalar.of(0)), reading.where.signs)
    except (Misfit, *EVALUATION_ERRORS):
        return False


def is_evident(left: SyntaxNode, exact: Matrix, printed: Matrix, wrong: int) -> bool:
    """Return whether the error lies in numbers on the right: a value of a letter, an entry, a number.

    A single number says too little to tell which letter was meant instead of another.
    """
    if left.kind == "letter" or (left.kind == "call" and left.text == "size"):
        return True
    alone = exact.shape == (1, 1)
    return (alone and exact[0, 0].is_constant and printed[0, 0].is_constant) or (not alone and wrong == 1)


_MOST_LETTERS = 3
#: The signs of so many squared factors under roots are tried both ways.
_MOST_SQUARES = 3


def _is_odd(turned: Sequence[Scalar], chosen: Sequence[Scalar]) -> bool:
    """Return whether an odd number of the chosen factors are negative, and so their product."""
    return sum(factor in turned for factor in chosen) % 2 == 1


def _share_nothing(products: Sequence[tuple[Scalar, ...]]) -> bool:
    """Return whether no factor stands in two of the products."""
    factors = [*chain.from_iterable(products)]
    return len(set(factors)) == len(factors)


def _is_multiple(value: Scalar, products: Iterable[tuple[Scalar, ...]]) -> bool:
    """Return whether a value is one of the products times a number."""
    return any((value / product_of(chosen)).is_constant for chosen in products)


def _open_signs(reading: Reading) -> BudgetExceeded:
    """Return the error for an equation that depends on signs about which nothing is known for certain."""
    factors = ", ".join(map(text_of_value, reading.squares))
    message = f"it depends on the signs of {factors} under roots of squares, which are open"
    return BudgetExceeded(message, repair="declare the signs of symbols")


def _unsaid(said: str) -> Reason:
    """Return a reason of which nothing is told without the solution."""
    return Reason((Remark(said, ""),))


def _remark(said: str) -> Reason:
    """Return a reason in the letters and numbers of the equation itself, or on its sizes."""
    return Reason((Remark.harmless(said),))


@dataclass
class Verdict:
    """The correction of an equation that does not hold in general, and the reason.

    `holds` states where it does; `needs` is whether the correction is the equation itself with further conditions.
    """

    right: str
    reason: Reason
    holds: str = ""
    needs: bool = False


@dataclass(frozen=False)
class EquationAuditor:
    """The letters of one convention, and the equations found true so far."""

    problem: Problem
    results: Sequence[Result]
    convention: Convention
    patience: SearchBudget
    known: list[SyntaxNode] = field(default_factory=list)
    notes: dict[str, None] = field(default_factory=dict)
    values: Mapping[str, Scalar | Matrix] = field(init=False)
    telling: frozenset[str] = field(init=False)
    let: Mapping[str, SyntaxNode] = field(init=False, default_factory=dict)
    where: EquationConditions = field(init=False, default_factory=EquationConditions)
    environments: dict[object, Environment] = field(init=False, default_factory=dict)
    kept: dict[tuple[int, str], Kept] = field(init=False, default_factory=dict)
    gaps: list[Gap] = field(init=False, default_factory=list)

    def __post_init__(self) -> None:
        self.values = values(self.problem.plant, self.results, self.convention)
        self.telling = telling(self.problem.plant, self.convention)

    @property
    def symbols(self) -> Mapping[str, str]:
        """The file's own symbols and their signs; they shadow every other meaning of a letter."""
        return self.problem.plant.symbols.signs

    def read(self, entry: PrintedEntry) -> Iterator[tuple[str, Verdict]]:
        """Yield the equations of an entry that do not hold in general."""
        self.environments, self.kept, self.gaps, self.where = {}, {}, [], entry.condition
        self.let = {name: self._members(text)[0] for name, text in entry.let.items()}
        for left, right in pairwise(self._members(entry.relation)):
            verdict = self._checked(left, right)
            if verdict is None:
                self.known += [left, right]
            else:
                if not verdict.holds:
                    verdict = replace(verdict, right=self._confirmed(verdict.right))
                yield self._under(f"{left} = {right}"), verdict

    def _members(self, equation: str) -> tuple[SyntaxNode, ...]:
        """Return the members of an equation; letters whose value depends on the variable may have an argument."""
        variable = self.problem.plant.variable
        functions = {name for name, value in self.values.items() if variable in value.names}
        return read_relation(equation, "", functions, {*self.symbols, variable, *INSTANTS})

    def _under(self, equation: str, *needed: str) -> str:
        """Return an equation with its conditions, and others that it needs."""
        conditions = ", ".join(filter(None, (self.where.text, *needed)))
        return f"{equation} where {conditions}" if conditions else equation

    def _confirmed(self, right: str) -> str:
        """Return a correction after evaluating it like a printed equation; it must hold.  Long texts are left out.

        Where it is true in general only, its conditions are said with it, and it is read again.
        """
        before, equation = self.where, right
        if not right:
            return ""
        try:
            equation, self.where = parted(right, self.symbols, "") if " where " in right else (right, before)
            for pair in pairwise(self._members(equation)):
                verdict = self._checked(*pair)
                if verdict is not None and verdict.right not in {"", right} and (verdict.holds or verdict.needs):
                    return self._confirmed(verdict.right)
                if verdict is not None:
                    raise CertificateRejected(f"the equation {right} does not hold", claim=right)
        except BudgetExceeded:
            return ""
        finally:
            self.where = before
        return right

    # -- one equation -------------------------------------------------------------------------------------------------

    def environment(self, left: SyntaxNode, right: SyntaxNode) -> Environment:
        """Return the environment of an equation; the equations of signals depend on the signals that occur."""
        inside = letters_of(*(self.let[name] for name in letters_of(left, right) if name in self.let))
        names = self.telling.difference(self.symbols, self.let)
        mentioned = tuple(names.intersection([*letters_of(*sides), *inside]) for sides in ((left, right), (right,)))
        if mentioned not in self.environments:
            made = signals(self.problem.plant, self.results, self.convention, *mentioned)
            environment = made.extended_by(values=dict(self.values), signs=dict(self.symbols))
            for name, meaning in self.let.items():
                environment = self._with_let(environment, name, meaning)
            self.environments[mentioned] = environment
        self._note_shadows([*letters_of(left, right), *inside], self.environments[mentioned])
        return self.environments[mentioned]

    def _note_shadows(self, letters: Sequence[str], environment: Environment) -> None:
        """Note the letters of an equation that are declared symbols and also letters of the convention."""
        for name in letters:
            if name in self.symbols and (name in {*self.values, *INSTANTS} or name in environment.signals):
                note = f"{name} is the file's own symbol wherever it is printed, not the {name} of the convention "
                self.notes[note + self.convention.name] = None

    def reading(self, left: SyntaxNode, right: SyntaxNode, turned: Sequence[Scalar] = ()) -> Reading:
        """Return a reading of an equation."""
        reading = Reading(self.environment(left, right), self.where, turned=frozenset(turned))
        reading.gaps += self.gaps
        return reading

    def true(self, left: SyntaxNode, right: SyntaxNode) -> bool:
        """Return whether an equation is seen to hold in general, whatever the signs of what is squared under its roots."""
        reading = self.reading(left, right)
        if "sqrt" not in {part.text for side in (left, right) for part in every(side)}:  # else `squares` are found anew
            reading.kept = self.kept.setdefault((id(reading.environment), self.where.text), {})
        found = self._true(left, right, reading)
        if not reading.squares:
            return found
        try:
            return all(self._turned_is_true(left, right, reading, turned) for turned in self._choices(reading))
        except BudgetExceeded:
            return False

    def _true(self, left: SyntaxNode, right: SyntaxNode, reading: Reading) -> bool:
        try:
            sides = spectral(left, right, self.problem.plant.variable)
            return equal(*common(*(value_of(side, reading) for side in sides)), self.symbols)
        except (Misfit, *EVALUATION_ERRORS):  # InputError is a ValueError
            return False

    def _checked(self, printed_left: SyntaxNode, printed_right: SyntaxNode) -> Verdict | None:
        """Return the correction of an equation that does not hold in general, None for a true one."""
        reading = self.reading(printed_left, printed_right)
        environment = reading.environment
        try:
            left, right = spectral(printed_left, printed_right, environment.variable)
            sides = [self._value(side, reading) for side in (left, right)]
            pair = common(*sides)
        except Misfit as misfit:
            if reading.squares and len(self._gaps(printed_left, printed_right, reading)) > 1:
                raise _open_signs(reading) from None
            return Verdict(*self._misfit(printed_left, printed_right, str(misfit), environment))
        if reading.squares:
            return self._under_signs(printed_left, printed_right, reading)
        if equal(*pair, self.symbols):
            return self._where_it_holds(printed_left, printed_right, reading)
        rounded = [is_rounded(side, reading) for side in (left, right)]
        if (not letters_of(left) and letters_of(right)) or is_spectrum(right) or rounded == [True, False]:
            left, right, pair = right, left, (pair[1], pair[0])
        pair = pair[0], in_form(pair[1], pair[0], self.symbols)
        spectra = (left, right) != (printed_left, printed_right) and (right, left) != (printed_left, printed_right)
        if isinstance(pair[0], Signal):
            return Verdict(*self._signals(left, right, pair, environment))
        found = self._values(left, right, pair, reading, spectra=spectra)
        if found is None:  # only rounding parts them
            return self._where_it_holds(printed_left, printed_right, reading)
        return Verdict(*found)

    def _where_it_holds(self, left: SyntaxNode, right: SyntaxNode, reading: Reading) -> Verdict | None:
        """Return the conditions of a true equation, None if there are none."""
        values = [value for name in letters_of(left, right) if (value := self.values.get(name)) is not None]
        nonzero = vanishing_factors([value.common_denominator() for value in values], reading.where.signs)
        needed, reasons = exceptions(reading, nonzero)
        if not needed:
            return None
        reason = _unsaid(f"true in general only: {'; '.join(reasons)}")
        return Verdict(self._under(f"{left} = {right}", *needed), reason, "in general")

    # -- roots of squares ---------------------------------------------------------------------------------------------

    def _choices(self, reading: Reading) -> list[tuple[Scalar, ...]]:
        """Return which of the squared factors may be negative together; raises `BudgetExceeded` for many of them.

        Where a factor is 0 either sign is right, so that of conditions `>= 0` on products those are used that share none.
        """
        squares = reading.squares
        if len(squares) > _MOST_SQUARES:
            raise _open_signs(reading)
        known = self._known_products(squares)
        choices = [*chain.from_iterable(combinations(squares, count) for count in range(len(squares) + 1))]
        found = [turned for turned in choices if all(_is_odd(turned, chosen) == odd for chosen, odd in known.items())]
        return found or choices  # of conditions that contradict each other nothing is concluded

    def _known_products(self, squares: Sequence[Scalar]) -> dict[tuple[Scalar, ...], bool]:
        """Return the products of squared factors with a known sign, and whether that is below 0."""
        products = chain.from_iterable(combinations(squares, count) for count in range(2, len(squares) + 1))
        signs = {chosen: self.where.sign(product_of(chosen)) for chosen in products}
        weak = [chosen for chosen, sign in signs.items() if sign in {"nonnegative", "nonpositive"}]
        used = weak if _share_nothing(weak) else []
        strict = [chosen for chosen, sign in signs.items() if sign in {"positive", "negative"}]
        return {chosen: signs[chosen] in NOT_POSITIVE for chosen in (*strict, *used)}

    def _turned_is_true(
        self, left: SyntaxNode, right: SyntaxNode, reading: Reading, turned: tuple[Scalar, ...]
    ) -> bool:
        """Return whether an equation holds with these factors negative.

        Raises `BudgetExceeded` where other factors turn up, or where the sides may be equal although that is not shown.
        """
        other = self.reading(left, right, turned)
        found = self._true(left, right, other)
        if not set(other.squares) <= set(reading.squares):
            raise BudgetExceeded("a root of a square stands below another root, and signs are open")
        if not found:
            with suppress(Misfit):
                equal(*common(*(self._value(side, other) for side in (left, right))), self.symbols)
        return found

    def _gaps(self, left: SyntaxNode, right: SyntaxNode, reading: Reading) -> set[object]:
        """Return the sets of exceptions that the possible signs lead to, None where the sides have no value."""
        found: set[object] = set()
        for turned in self._choices(reading):
            other = self.reading(left, right, turned)
            try:
                for side in (left, right):
                    self._value(side, other)
                found.add(frozenset((gap.values, gap.below) for gap in other.gaps))
            except Misfit:
                found.add(None)
        return found

    def _under_signs(self, left: SyntaxNode, right: SyntaxNode, reading: Reading) -> Verdict | None:
        """Return the verdict on an equation with roots of squares whose signs are open.

        Raises `BudgetExceeded` where conditions are left that may decide about them, or exceptions depend on them.
        """
        choices, squares = self._choices(reading), reading.squares
        true = [turned for turned in choices if self._turned_is_true(left, right, reading, turned)]
        if not true and any(is_rounded(side, reading) for side in (left, right)):
            raise _open_signs(reading)
        if not true:
            return Verdict(
                "", _unsaid("the sides are not equal, whatever the signs of what is squared under the roots")
            )
        if len(self._gaps(left, right, reading)) > 1:
            raise _open_signs(reading)
        if len(true) == len(choices):
            return self._where_it_holds(left, right, reading)
        known = self._known_products(squares)
        letters = set().union(*(factor.names for factor in squares))
        if any(letters & value.names and not _is_multiple(value, known) for value in self.where.above):
            raise _open_signs(reading)
        found, rest = dict[tuple[Scalar, ...], bool](), choices
        for chosen in chain.from_iterable(combinations(squares, count) for count in range(1, len(squares) + 1)):
            odd = _is_odd(true[0], chosen)
            left_over = [turned for turned in rest if _is_odd(turned, chosen) == odd]
            if len(left_over) < len(rest) and all(_is_odd(turned, chosen) == odd for turned in true):
                found[chosen], rest = odd, left_over
        is_all = len(rest) == len(true) and _share_nothing([*known, *found])
        if not is_all:  # one choice of signs for which it is true
            found = {(factor,): factor in true[0] for factor in squares}
        needed = [f"{text_of_value(product_of(chosen))} {'<=' if odd else '>='} 0" for chosen, odd in found.items()]
        where = f"{'in general only ' * is_all}where {' and '.join(needed)}"
        reason = _unsaid(f"a root is not negative: true {where}")
        return Verdict(self._under(f"{left} = {right}", *needed), reason, needs=True)

    def _value(self, node: SyntaxNode, reading: Reading) -> Printed:
        try:
            return value_of(node, reading)
        except Unknown as unknown:
            name, environment = unknown.name, reading.environment
        from difflib import get_close_matches  # noqa: PLC0415 - needed for messages only

        near = get_close_matches(name, [*environment.values, *environment.signals], 1)
        repair = f'did you mean "{near[0]}"?' if near else "declare it in [symbols], or say in let what it stands for"
        message = (
            f'the letter "{name}" means nothing in the convention {self.convention.name}, with the tasks of this file'
        )
        raise UnknownName(message, repair=repair, name=name)

    def _with_let(self, environment: Environment, name: str, meaning: SyntaxNode) -> Environment:
        """Return the environment in which a letter of the entry stands for a value or a signal."""
        reading = Reading(environment, self.where)
        try:
            found = value_of(meaning, reading)
        except Misfit:  # it is another equation that uses this letter, or the letter is reported where it stands
            return environment
        self.gaps += [gap for gap in reading.gaps if gap not in self.gaps]
        if reading.squares:
            message = f"{name} contains the root of a square of {text_of_value(reading.squares[0])}, whose sign is open"
            raise BudgetExceeded(message, repair="write its value in the equation, or declare the sign")
        if isinstance(found, Flexible):
            return environment
        if isinstance(found, Signal):
            return environment.extended_by(signals={name: formula_of(found)})
        others = {key: formula for key, formula in environment.signals.items() if key != name}
        return replace(environment, signals=others, values={**environment.values, name: found})

    # -- what is wrong ------------------------------------------------------------------------------------------------

    def _slip(
        self, left: SyntaxNode, right: SyntaxNode, environment: Environment, *, fit: bool = True
    ) -> tuple[str, Reason] | None:
        fields = {name for result in self.results for name in result.fields if name[0].islower()}
        matrices = {f"{result.task}_matrix" for result in self.results}
        alphabet = CandidateLetters(environment, frozenset(fields | matrices), fit=fit)
        true, sides = self.patience.asks(self.true), (left, right)
        found = found_slip(*sides, lambda *new: true(*new) and is_plausible(sides, new, self.reading(*new)), alphabet)
        return None if found is None else (f"{found[0]} = {found[1]}", _remark(found[2]))

    def _misfit(
        self, left: SyntaxNode, right: SyntaxNode, message: str, environment: Environment
    ) -> tuple[str, Reason]:
        slip = self._slip(left, right, environment, fit=False)
        if slip is not None:
            return slip[0], _remark(f"{message}; {slip[1]}")
        for side, other in ((left, right), (right, left)):
            try:
                value = self._value(side, Reading(environment, self.where))
                if is_spectrum(side) and isinstance(value, Scalar):
                    return spectrum_text(side, value, environment.variable), _remark(message)
                self._value(other, Reading(environment, self.where))
            except Misfit:
                continue
            if isinstance(value, (Scalar, Matrix)) and letters_of(side):
                return f"{side} = {differences.value_text(value)}", _remark(message)
        return "", _remark(message)

    def _values(
        self, left: SyntaxNode, right: SyntaxNode, pair: tuple[Any, Any], reading: Reading, *, spectra: bool
    ) -> tuple[str, Reason] | None:
        """Return the error of a value or of a formula for one, None if it differs by rounding only."""
        environment = reading.environment
        exact, printed = map(differences.as_matrix, pair)
        rounded = as_printed(right, reading)
        if (
            rounded is not None and differences.as_matrix(rounded).shape == exact.shape
        ):  # else it is a 0 of another size
            printed = differences.as_matrix(rounded)
        wrong = differences.wrong_entries(printed, exact)
        if not wrong:
            return None
        reason = None
        if exact.shape == (1, 1):
            reason = differences.polynomial_reason(printed[0, 0], exact[0, 0], environment.variable)
        numbers = set(letters_of(right)) <= {*self.symbols, *INSTANTS, environment.variable}
        plain = reason is not None and reason.is_single and not spectra
        evident = numbers and (plain or is_evident(left, exact, printed, len(wrong)))
        slip = None if evident else self._slip(left, right, environment)
        if slip is not None:
            return slip
        if spectra:
            return spectrum_text(left, exact[0, 0], environment.variable), _remark("the eigenvalues are others")
        factor = None if numbers else self._missing_factor(left, right)
        if factor is not None:
            return factor
        whole = differences.reasons(printed, exact, str(left))
        value, alike = (exact[0, 0], printed[0, 0]) if isinstance(pair[1], Scalar) else (exact, printed)
        return f"{left} = {differences.value_text(value, alike)}", reason or whole

    def _missing_factor(self, left: SyntaxNode, right: SyntaxNode) -> tuple[str, Reason] | None:
        """Return the equation with its left side multiplied by a factor from a side of an earlier equation."""
        for node in reversed(self.known):
            fixed = SyntaxNode("product", (node, left))
            if node.kind == "block" and self.true(fixed, right):
                return f"{fixed} = {right}", _remark(f"the factor {node} before {left} is missing")
        return None

    def _signals(
        self, left: SyntaxNode, right: SyntaxNode, pair: tuple[Any, Any], environment: Environment
    ) -> tuple[str, Reason]:
        exact, printed = ({name: part for name, part in side.coefficients.items() if not part.is_zero} for side in pair)
        names = [name for name in {**exact, **printed} if exact.get(name) != printed.get(name)]
        both = exact.keys() & printed.keys()
        single = len(names) == 1 and both.issuperset(names)
        if not single or len(differences.wrong_entries(printed[names[0]], exact[names[0]])) != 1:
            slip = self._slip(left, right, environment)
            if slip is not None:
                return slip
        term = self._missing_term(left, right, names, environment)
        if term is not None:
            return term
        reason = Reason(
            tuple(piece for name in names for piece in _of_signal(name, printed.get(name), exact.get(name)))
        )
        terms = (
            " + ".join(differences.term_text(value, name) for name, value in exact.items()).replace("+ -", "- ") or "0"
        )
        return "" if terms == str(left) else f"{left} = {terms}", reason

    def _missing_term(
        self, left: SyntaxNode, right: SyntaxNode, names: Sequence[str], environment: Environment
    ) -> tuple[str, Reason] | None:
        """Return the equation with one more term, a product of letters of the equation and the one signal that differs."""
        if len(names) != 1 or any(part.kind == "number" for part in every(right)):
            return None
        true = self.patience.asks(self.true)
        matrices = {name for name, value in environment.values.items() if isinstance(value, Matrix)}
        written = [name for name in letters_of(left, right) if name in matrices]
        offered = list(dict.fromkeys([*written, *(name for name in environment.values if name in matrices)]))
        terms = right.parts if right.kind == "sum" else (right,)
        for letters, most in ((written[:6], _MOST_LETTERS), (offered[:16], 2)):
            for chosen in (each for count in range(1, most + 1) for each in product(letters, repeat=count)):
                term = SyntaxNode("product", tuple(SyntaxNode("letter", text=name) for name in (*chosen, names[0])))
                for last in (term, SyntaxNode("negative", (term,))):
                    fixed = SyntaxNode("sum", (*terms, last))
                    if true(left, fixed):
                        return f"{left} = {fixed}", _remark(f"the term {last} is missing")
        return None


def _of_signal(name: str, printed: Matrix | None, exact: Matrix | None) -> Iterator[Remark | WrongTerm | WrongEntries]:
    """Yield what is wrong with the term of a signal."""
    if printed is None or exact is None:
        term = differences.term_text(exact if printed is None else printed, name)  # type: ignore[arg-type]
        yield WrongTerm(name, term, is_missing=printed is None)
        return
    whole = f"the coefficient of {name}"
    for i, piece in enumerate(differences.reasons(printed, exact, whole).pieces):
        inside = f"in {whole} " * (i == 0)
        if isinstance(piece, Remark):
            yield Remark.harmless(f"{inside}{piece.said}", piece.slip)
        elif isinstance(piece, WrongEntries) and exact.shape != (1, 1):
            yield replace(piece, inside=inside)
        elif isinstance(piece, WrongEntries):
            yield WrongEntries(tuple(replace(entry, is_part=True) for entry in piece.entries))


# Findings of the audit of a problem: false equations, right values and reasons.


@dataclass
class Finding:
    """A printed equation that does not hold in general: its place, text, correction and reason.

    `holds` is empty where it is false, `in general` where it fails only where some polynomials vanish.
    """

    where: str
    erratum: str
    printed: str
    right: str
    reason: str
    holds: str = ""


@dataclass
class Audited:
    """The findings for one problem, the number of printed equations, and notes on the reading of letters."""

    title: str
    checked: int
    findings: tuple[Finding, ...]
    notes: tuple[str, ...] = ()

    @property
    def wrong(self) -> tuple[Finding, ...]:
        """The equations that are false."""
        return tuple(finding for finding in self.findings if not finding.holds)


def audit(problem: Problem) -> Audited:
    """Solve a problem and compare every printed equation with the answers.

    Raises `ProblemErrors` with every entry that cannot be read.
    """
    entries = printed_entries(problem.printed, problem.convention, problem.plant.symbols.signs)
    results = problem.solve()
    found: list[Finding] = []
    errors: list[SymobsError] = []
    desks: dict[str, EquationAuditor] = {}
    patience = SearchBudget()
    for entry in entries:
        name = entry.convention.name
        desk = desks[name] = desks.get(name) or EquationAuditor(problem, results, entry.convention, patience)
        try:
            found += _read(entry, desk)
        except SymobsError as error:
            error.where = error.where or entry.place
            errors.append(error)
    if errors:
        raise ProblemErrors(tuple(errors))
    notes = dict.fromkeys(note for desk in desks.values() for note in desk.notes)
    return Audited(problem.title, len(entries), tuple(found), tuple(notes))


def _read(entry: PrintedEntry, desk: EquationAuditor) -> list[Finding]:
    """Return the findings for one entry."""
    if entry.expect:
        lines = mismatches([ResultInConvention(result, desk.convention) for result in desk.results], entry.expect)
        texts = [line.partition(": expected ")[2].partition(", found ") for line in lines]
        return [Finding(entry.where, entry.erratum, came, right, "") for came, _, right in texts]
    return [
        Finding(entry.where, entry.erratum, printed, verdict.right, str(verdict.reason), verdict.holds)
        for printed, verdict in desk.read(entry)
    ]
