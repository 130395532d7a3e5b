"""The lines of a derivation: the first false one, and what follows from it."""

from __future__ import annotations

import re
from collections.abc import Mapping
from contextlib import suppress
from dataclasses import field, replace
from itertools import pairwise
from typing import TYPE_CHECKING, Any, cast

from symobs.applications.audit.auditor import EquationAuditor, printed_entries
from symobs.applications.audit.differences import Reason, WrongEntries, as_matrix, wrong_entries
from symobs.applications.audit.evaluation import Misfit, common, equal, value_of
from symobs.applications.audit.slips import SearchBudget
from symobs.applications.checking.answers import Answer, Step, as_conditions, as_value, has_decimals, read_like
from symobs.applications.checking.handwriting import EIGENVALUES, in_letters, named_entries
from symobs.applications.checking.motion_lines import of_motion
from symobs.applications.checking.parts import OF_THE_PLANT, exists, field_called, is_of_time, part_of_task
from symobs.applications.checking.regions import (
    SOME_PIECES,
    compare,
    conditions_on,
    is_implied,
    part_described,
    read_conditions,
    rounded_on,
)
from symobs.applications.checking.report import Line
from symobs.applications.checking.rounded import rounds_a_root
from symobs.exact import Matrix, Scalar, TooLarge
from symobs.exact.algebraic.rounded_decimals import polynomial_of
from symobs.formula.expression import parse_poles, parse_scalar
from symobs.formula.expression.syntax import SyntaxNode, letters_of
from symobs.ground.dataclass import dataclass
from symobs.ground.errors import (
    BudgetExceeded,
    CertificateRejected,
    InputError,
    NotShown,
    ProblemErrors,
    SymobsError,
    UnknownName,
)
from symobs.problem.expect import found_in, met, names_of
from symobs.proof.certificate.claims import UNREADABLE
from symobs.tasks.analysis.rank.observability import controllability_rank, observability_rank
from symobs.tasks.analysis.time_response.initial_state import InitialState
from symobs.tasks.result.in_convention import ResultInConvention

if TYPE_CHECKING:
    from collections.abc import Callable, Collection, Iterable, Iterator, Sequence
    from fractions import Fraction

    from symobs.applications.audit.auditor import PrintedEntry
    from symobs.applications.checking.judgement import TaskJudgement
    from symobs.applications.checking.regions import Union
    from symobs.formula.convention import Convention
    from symobs.problem import Problem
    from symobs.problem.fields import Milestone
    from symobs.tasks.analysis.stability_region.stability_region import StabilityRegion
    from symobs.tasks.result import Result


# The auditor of a derivation's lines: that of printed equations, with the student's values in place of letters.


@dataclass(frozen=False)
class LineAuditor(EquationAuditor):
    """An auditor that tells whether a line is true, and what it defines."""

    def members(self, entry: PrintedEntry) -> tuple[SyntaxNode, ...]:
        """Return the members of a line, its conditions and its own letters being set."""
        self.environments, self.kept, self.gaps, self.where = {}, {}, [], entry.condition
        self.let = {name: self._members(text)[0] for name, text in entry.let.items()}
        return self._members(entry.relation)

    def is_true(self, entry: PrintedEntry) -> bool:
        """Return whether a line holds in general; raises `UnknownName` for a letter without a meaning."""
        members = self.members(entry)
        reading = self.reading(members[0], members[-1])
        for name in {*letters_of(*members)} - {*self.let}:
            with suppress(Misfit):
                self._value(SyntaxNode("letter", text=name), reading)
        for left, right in pairwise(members):  # what is not evaluated is not false
            with suppress(Misfit):
                common(self._value(left, reading), self._value(right, reading))
        wrong = [pair for pair in pairwise(members) if not self.true(*pair)]
        for pair in wrong:
            with suppress(Misfit):
                equal(*common(*(self._value(side, reading) for side in pair)), self.symbols)  # raises where it is open
        return not wrong

    def defined(self, entry: PrintedEntry) -> tuple[str, Scalar | Matrix] | None:
        """Return the letter that a line defines, and its value; None for any other line."""
        members = self.members(entry)
        letter, last = members[0], members[-1]
        plain = {*self.symbols, *self.let, self.problem.plant.variable, "t"}
        if letter.kind != "letter" or letter.text in plain or not set(letters_of(last)) <= plain:
            return None
        try:
            value = value_of(last, self.reading(letter, last))
        except Misfit:
            return None
        known = self.values.get(letter.text)
        if isinstance(known, Scalar) and isinstance(value, Matrix) and value.shape == (1, 1):
            value = value[0, 0]
        return (letter.text, value) if isinstance(value, (Scalar, Matrix)) else None

    def letters(self, entry: PrintedEntry) -> set[str]:
        """Return the letters of a line."""
        return {*letters_of(*self.members(entry), *self.let.values())}

    def explained(self, entry: PrintedEntry) -> tuple[str, Reason]:
        """Return the correction of a false line, empty where none is found, and the reason."""
        return next(((v.right, v.reason) for _, v in self.read(entry) if not v.holds), ("", Reason()))


def auditor(
    problem: Problem,
    results: Sequence[Result],
    convention: Convention,
    budget: SearchBudget,
    values: Mapping[str, Any],
) -> LineAuditor:
    """Return an auditor in which some letters have values of their own."""
    found = LineAuditor(problem, results, convention, budget)
    found.values = {**found.values, **values}
    return found


# Lines that say what a function of time is, x(t) = [...], y(t) = ... and exp(A t) = [...]: held against the answer
# itself.


def of_function_of_time(
    step: Step, views: Sequence[ResultInConvention], audited: Callable[[Step], Line]
) -> Line | None:
    """Return the line x(t) = ... = ... with its verdict, None for any other line; members with letters are `audited`."""
    name, *members = (side.strip() for side in step.relation.split("="))
    view = next((view for view in views if is_of_time([view.result], name)), None)
    if view is None or not members or not exists(view.result, field_called(view.result, name)):
        return None
    found = [
        _of_member(step, name, member, view) or audited(replace(step, relation=f"{name} = {member}"))
        for member in members
    ]
    worst = next((line for line in found if line.verdict != "true"), found[0])
    return replace(worst, relation=step.relation)


def _of_member(step: Step, name: str, member: str, view: ResultInConvention) -> Line | None:
    """Return whether a function equals a member that is written out in t; None for a member in letters."""
    field = field_called(view.result, name)
    try:
        if met(view, field, as_value(member), step.where):
            return Line(step.where, step.relation, "true")
        right = found_in(view, field)
        mine = read_like(right, as_value(member), names_of(view), "t", step.where)
    except (NotShown, TooLarge) as error:
        return Line(step.where, step.relation, "undecided", reason=str(error))
    except SymobsError:
        if "exp" not in f"{name} {member}":
            return None
        reason = "only functions of t that are written out can be compared here"
        return Line(step.where, step.relation, "undecided", reason=reason)
    assert mine is not None  # noqa: S101 - a function of time is a matrix or a number
    own, exact = as_matrix(mine), as_matrix(right)
    if own.shape != exact.shape:
        rows, columns = (f"{a}x{b}" for a, b in (exact.shape, own.shape))
        return Line(step.where, step.relation, "false", reason=f"{name} is {rows} here, yours is {columns}")
    wrong = Reason((WrongEntries(tuple(wrong_entries(own, exact, whole=name))),))
    reason = wrong.hint() or "its sides are not equal"
    return Line(step.where, step.relation, "false", right=f"{name} = {right}", reason=reason)


# The lines of a derivation: true with the right values, following from earlier wrong ones, or false.
#
# A line that defines a letter binds it for the lines behind it. A gain that meets its claim takes the place of the
# right one; a wrong value is what later lines may follow from.


#: What a line may raise that is too large to be decided, or that the correction of a false one could not confirm.
_OPEN = (NotShown, TooLarge, BudgetExceeded)
#: Tasks whose values are right in many ways, though they design no gain.
_CHOSEN = ("dual", "initial_state")
_ORDER = re.compile(r"[<>]")


@dataclass(frozen=False)
class _Derivation:
    """What the lines so far have defined: right gains, and the values of letters that are not right."""

    problem: Problem
    views: Sequence[ResultInConvention]
    symbols: Mapping[str, Scalar]
    right: dict[str, Result]
    budget: SearchBudget = field(default_factory=SearchBudget)
    bound: dict[str, tuple[Any, str]] = field(default_factory=dict)
    rightly: set[str] = field(default_factory=set)

    def auditor_of_right(self) -> LineAuditor:
        """Return the auditor with the right values."""
        known = {**self.symbols, **self._entries(self.right.values())}
        return auditor(self.problem, list(self.right.values()), self.views[0].convention, self.budget, known)

    def _entries(self, results: Iterable[Result]) -> dict[str, Scalar]:
        """Return the entries of gains and matrices by their letters, l1, l2, p11, ..."""
        found: dict[str, Scalar] = {}
        for result in results:
            found |= named_entries(ResultInConvention(result, self.views[0].convention))
        return found

    def auditor_of_own(self) -> LineAuditor:
        """Return the auditor with the student's values of letters, and with what follows from the student's gains."""
        results, follows = [], dict[str, Any]()
        for view in self.views:
            result = self.right[view.task]
            named = {view.standard(letter): value for letter, (value, _) in self.bound.items()}
            standard = {name: -value if sign < 0 else value for (name, sign), value in named.items()}
            gains = {k: value for k, value in standard.items() if k in result.gains and isinstance(value, Matrix)}
            leads = {k: value for k, value in standard.items() if k in result.leads}
            with suppress(SymobsError, ArithmeticError, ValueError, AttributeError, TypeError):
                result = result.following_from(gains) if gains else result
                found = result.consequences(leads) if leads else {}
                follows |= {view.letter_of(k): v for k, v in found.items() if isinstance(v, (Scalar, Matrix))}
            results.append(result)
        own = {letter: value for letter, (value, _) in self.bound.items()}
        known = {**self.symbols, **self._entries(results), **follows, **own}
        return auditor(self.problem, results, self.views[0].convention, self.budget, known)

    def origins(self, letters: set[str]) -> tuple[str, ...]:
        """Return the lines that bound the letters of a line, or those that bound gains."""
        named = [where for letter, (_, where) in self.bound.items() if letter in letters]
        return tuple(dict.fromkeys(named or [where for _, where in self.bound.values()]))

    def is_gain(self, letter: str) -> bool:
        """Return whether a letter is that of a gain, of which the part of the answer says why it is wrong."""
        return any(view.standard(letter)[0] in view.result.gains for view in self.views)

    def takes(self, letter: str, value: Any) -> bool:
        """Return whether a value of a gain meets its claim; then it takes the place of the right one."""
        for view in self.views:
            name, sign = view.standard(letter)
            right = self.right.get(view.task)
            if right is None or name not in right.gains or not isinstance(value, Matrix):
                continue
            known = right.fields.get(name)
            if not isinstance(known, Matrix) or known.shape != value.shape:
                continue
            try:
                self.right[view.task] = right.with_gains({name: -value if sign < 0 else value})
            except CertificateRejected:
                continue
            return True
        return False


def judge_lines(
    problem: Problem,
    views: Sequence[ResultInConvention],
    judged: Mapping[str, TaskJudgement],
    answer: Answer,
    milestones: Sequence[Milestone],
) -> tuple[tuple[Line, ...], tuple[tuple[str, Fraction, bool], ...]]:
    """Return the lines of an answer with their verdicts, and the milestones with whether they are met."""
    symbols = {name: Scalar.symbol(name) for name in answer.symbols}
    state = _Derivation(problem, views, symbols, {task: each.right for task, each in judged.items()})
    if not answer.loose:
        for each in judged.values():
            for part in each.parts:
                if part.verdict == "wrong" and part.name in each.right.gains and part.value is not None:
                    view = next(view for view in views if view.task == each.right.task)
                    value = -part.value if view.standard(part.letter)[1] < 0 else part.value
                    state.bound[part.letter] = (value, "the answer")
    chosen = {
        part.letter
        for each in judged.values()
        for part in each.parts
        if part.verdict == "right" and part.name in each.right.in_coordinates
    }
    lines = tuple(
        _judged(state, step, answer) for step in answer.steps if not _states_a_part(step, answer, views, chosen)
    )
    right = {part.letter for each in judged.values() for part in each.parts if part.verdict == "right"}
    met = tuple((each.relation, each.points, _is_met(each, lines, right | state.rightly)) for each in milestones)
    return lines, met


def judge_milestone(problem: Problem, views: Sequence[ResultInConvention], milestone: Milestone) -> Line:
    """Return a milestone as a line with its verdict, given the problem's own answers as far as nobody could choose others.

    Where an answer may be chosen, its letters mean nothing here: such a milestone is no line that could be called false.
    """
    letter = milestone.relation.partition("=")[0].strip()
    if letter in OF_THE_PLANT and any(exists(view.result, letter) for view in views):
        return Line("", milestone.relation, "undecided")  # the plant's letter, and that of an answer
    right = {view.task: view.result for view in views if _is_unique(view.result)}
    return _judged(_Derivation(problem, views, {}, right), Step(milestone.relation, ""), Answer())


def _is_unique(result: Result) -> bool:
    """Return whether only one answer is right: no coordinates are chosen, and one signal alone is fed back to all modes."""
    if result.task in _CHOSEN or result.in_coordinates or result.claimed:
        return False
    plant = result.plant
    shapes = {"K": (1, plant.order), "L": (plant.order, 1)}
    whole = {"K": controllability_rank, "L": observability_rank}
    return all(
        name in shapes
        and isinstance(gain := result.fields.get(name), Matrix)
        and gain.shape == shapes[name]
        and whole[name](plant).answer["rank"] == plant.order
        for name in result.gains
    )


def _states_a_part(step: Step, answer: Answer, views: Sequence[ResultInConvention], chosen: set[str]) -> bool:
    """Return whether a line only repeats a part of the answer.

    Its letter is the plant's, A = [...] of a canonical form, or it is right in coordinates that the student has `chosen`.
    """
    letter, _, value = (side.strip() for side in step.relation.partition("="))
    given = [entry.get(letter) for entry in (answer.values, *answer.values.values()) if isinstance(entry, Mapping)]
    if letter in chosen:
        return value in given
    if answer.loose and part_of_task(letter, views) is not None:
        return True
    if len(answer.repeated.get(letter, ())) == sum(exists(view.result, letter) for view in views) > 1:
        return value in answer.repeated[letter]  # P of lqr, P of kalman
    return letter in OF_THE_PLANT and value in given and any(exists(view.result, letter) for view in views)


def _is_too_long(error: SymobsError) -> bool:
    """Return whether a line has no other fault than its length, so that it may be true or false."""
    return isinstance(error, ProblemErrors) and all(isinstance(each, BudgetExceeded) for each in error.errors)


def _without_place(error: SymobsError) -> str:
    """Return what is wrong with a line; its place is that of the line."""
    errors = error.errors if isinstance(error, ProblemErrors) else (error,)
    for each in errors:
        each.where = ""
        if isinstance(each, UnknownName) and not each.repair.startswith("did you mean"):
            each.repair = "use the letters of the problem; your own ones belong to symbols or let of an answer file"
    return "\n".join(map(str, errors))


def is_of_conditions(relation: str) -> bool:
    """Return whether a line is one of conditions, and no equation."""
    return bool(_ORDER.search(relation)) and " where " not in relation


def _judged(state: _Derivation, step: Step, answer: Answer) -> Line:
    """Return a line with its verdict."""
    if (line := of_motion(step.relation, state.problem.plant)) is not None:
        return replace(line, where=step.where)
    written, variable = step.relation, state.problem.plant.variable
    names = {*state.problem.plant.symbols.signs, *state.symbols, variable}
    step = replace(step, relation=in_letters(written, names, variable))
    if is_of_conditions(step.relation):
        return _of_conditions(state, step)
    if (line := _of_an_eigenvalue(state, step, names)) is not None:
        return replace(line, relation=written)
    if (line := _of_a_measurement(state, step)) is not None:
        return replace(line, relation=written)
    of_time = of_function_of_time(step, state.views, lambda member: _audited(state, member, answer))
    return replace(of_time or _audited(state, step, answer), relation=written)


_OUTPUT = re.compile(r"\s*(?:y|(ẏ))(?:_?(\d))?\s*('*)\s*\(\s*([^()=]+?)\s*\)\s*=\s*([^=]+)")


def _of_a_measurement(state: _Derivation, step: Step) -> Line | None:
    """Return whether a line y(0) = 3 or y'(0) = -1 says what was measured; None for any other line, or where nothing was."""
    found = _OUTPUT.fullmatch(step.relation)
    result = next((each for each in state.right.values() if isinstance(each, InitialState)), None)
    if found is None or result is None:
        return None
    names = names_of(ResultInConvention(result, state.views[0].convention))
    try:
        at = parse_scalar(found[4], names, where=step.where, functions=True)
        value = result.measured(at, len(found[3]) + bool(found[1]))
        if value is None:
            return None
        right: Any = value if found[2] is None and value.shape[0] > 1 else value[int(found[2] or 1) - 1, 0]
        mine = read_like(right, as_value(found[5]), names, "t", step.where)
        assert mine is not None  # noqa: S101 - the right one is a matrix or a number
        own, exact = as_matrix(mine), as_matrix(right)
    except (*_OPEN, IndexError, SymobsError):
        return None
    is_true = own.shape == exact.shape and not wrong_entries(own, exact)
    reason = "" if is_true else "this was not measured"
    return Line(step.where, step.relation, "true" if is_true else "false", reason=reason)


_NUMBERED = re.compile(rf"\s*((?:{EIGENVALUES})_?\d)\s*=\s*([^=]+)")


def _of_an_eigenvalue(state: _Derivation, step: Step, names: Collection[str]) -> Line | None:
    """Return whether a line lambda_1 = -2 names an eigenvalue of A, of a loop, or of an answer; None for any other line."""
    found = _NUMBERED.fullmatch(step.relation)
    if found is None or found[1] in names:
        return None
    variable = state.problem.plant.variable
    try:
        roots = parse_poles(found[2], functions=True)
        pair = dict.fromkeys((*roots, *(root.conjugate() for root in roots)))
        factor = polynomial_of([*pair], variable)
        known = [value for result in state.right.values() for value in _polynomials(result)]
    except (InputError, ValueError, TypeError, TooLarge):
        return None
    is_one, reason = any((polynomial / factor).is_polynomial_in(variable) for polynomial in known), ""
    if not is_one and has_decimals(found[2]) and any(rounds_a_root(found[2], each, variable) for each in known):
        is_one, reason = state.problem.marking.decimals == "accept", "this is rounded, and an exact value is asked for"
    elif not is_one:
        reason = "this is no eigenvalue here"
    return Line(step.where, step.relation, "true" if is_one else "false", reason="" if is_one else reason)


def _polynomials(result: Result) -> Iterator[Scalar]:
    """Yield the characteristic polynomials of A, of the loop, and of square answers."""
    fields, variable = result.fields, result.plant.variable
    answers = [fields.get(name) for name in (*result.answered_by, *result.leads, "closed_loop_matrix", "A")]
    for value in (fields.get("polynomial"), result.plant.matrices.A, *answers):
        if isinstance(value, Scalar) and value.is_polynomial_in(variable):
            yield value
        elif isinstance(value, Matrix) and value.shape[0] == value.shape[1] and variable not in value.names:
            yield value.characteristic_polynomial(variable)


def _audited(state: _Derivation, step: Step, answer: Answer) -> Line:
    """Return a line of letters with its verdict."""
    try:
        entry = _entry(state, step, answer)
        right = state.auditor_of_right()
        true = right.is_true(entry)
        defined = right.defined(entry)
        if defined is not None and not true and state.takes(*defined):
            true = True
        if true:
            if defined is not None:
                state.bound.pop(defined[0], None)
                state.rightly.add(defined[0])
            return Line(step.where, step.relation, "true")
        return _not_true(state, step, entry, right, defined)
    except _OPEN as error:
        return Line(step.where, step.relation, "undecided", reason=str(error))
    except SymobsError as error:
        verdict = "undecided" if _is_too_long(error) else "unreadable"
        return Line(step.where, step.relation, verdict, reason=_without_place(error))
    except UNREADABLE:
        return Line(step.where, step.relation, "undecided", reason="this line cannot be evaluated")


def _not_true(
    state: _Derivation, step: Step, entry: PrintedEntry, right: LineAuditor, defined: tuple[str, Any] | None
) -> Line:
    """Return a line that is not true: it follows from earlier lines that are wrong, or is false itself."""
    desk = right
    if state.bound:
        own = state.auditor_of_own()
        if defined is not None:  # a letter that was bound before is bound anew, by what it follows from
            before = state.bound.pop(defined[0], None)
            own = state.auditor_of_own() if state.bound else right
            if before is not None and not state.bound:
                state.bound[defined[0]] = before
        if state.bound and own.is_true(entry):
            origins = state.origins(own.letters(entry) - ({defined[0]} if defined else set()))
            if defined is not None:
                state.bound[defined[0]] = (defined[1], step.where)
            return Line(step.where, step.relation, "follows", origins)
        desk = own
    is_gain = defined is not None and state.is_gain(defined[0])
    try:
        corrected, why = desk.explained(entry)
    except (CertificateRejected, *UNREADABLE):  # the search for the cause found none that stands
        corrected, why = "", Reason()
    matrix = defined[1] if defined is not None else None
    is_alone = isinstance(matrix, Matrix) and sum(not x.is_zero for x in matrix.entries) < 2
    reason = why.hint(is_gain=is_gain, is_alone=is_alone) or ("" if is_gain else "its sides are not equal")
    if desk is not right:
        reason = ", ".join(filter(None, (reason, _with_own(state, entry, right, corrected))))
    if defined is not None:
        state.bound[defined[0]] = (defined[1], step.where)
    return Line(step.where, step.relation, "false", right=corrected or None, reason=reason)


def _with_own(state: _Derivation, entry: PrintedEntry, right: LineAuditor, corrected: str) -> str:
    """Return with which values of the student a correction holds, empty where it holds with the right ones as well."""
    with suppress(SymobsError, *UNREADABLE):
        if corrected and right.is_true(replace(entry, relation=corrected.partition(" where ")[0])):
            return ""
    letters = right.letters(entry) - {entry.relation.partition("=")[0].strip()}
    own = [letter for letter in state.bound if letter in letters]
    if not own and corrected:
        own = [letter for letter in state.bound if state.is_gain(letter)]
    return f"with your {' and '.join(own)}" if own else ""


def _entry(state: _Derivation, step: Step, answer: Answer) -> PrintedEntry:
    """Return a line as the audit reads it; raises `ProblemErrors` where it cannot."""
    table: dict[str, Any] = {"relation": step.relation, "let": {**answer.let, **step.let}}
    (entry,) = printed_entries([table], state.views[0].convention, state.problem.plant.symbols.signs)
    return entry


def _of_conditions(state: _Derivation, step: Step) -> Line:
    """Return a line of conditions: true where the region implies them; a line may have one of its pieces."""
    view = next((view for view in state.views if view.task == "stability_region"), None)
    if view is None:
        return Line(step.where, step.relation, "unreadable", reason="no region is asked for here")
    names = names_of(view)
    known = None if names is None else {**dict.fromkeys(view.result.question.parameters, "real"), **names}
    try:
        if not hasattr(view.result, "critical"):  # with a dead time its ends are no algebraic numbers
            same = met(view, "stable_if", as_conditions(step.relation), step.where)
            return Line(step.where, step.relation, "true" if same else "undecided")
        region, marking = cast("StabilityRegion", view.result), state.problem.marking
        if marking.decimals == "accept" and has_decimals(step.relation):
            union = rounded_on(region, step.relation, known, marking.digits, step.where)
        else:
            union = conditions_on(region, step.relation, known, step.where)
        verdict = _of_union(region, union, known)
        part = part_described(region, union) if verdict == "false" else ""
    except _OPEN as error:
        return Line(step.where, step.relation, "undecided", reason=str(error))
    except SymobsError as error:
        return Line(step.where, step.relation, "unreadable", reason=_without_place(error))
    return Line(step.where, step.relation, "undecided" if part == SOME_PIECES else verdict, reason=part)


def _of_union(region: StabilityRegion, union: Union, known: Mapping[str, str] | None) -> str:
    """Return whether a region implies conditions, as the verdict on a line."""
    if region.region is not None:
        return "true" if is_implied(region, union) else "false"
    ours = read_conditions(list(region.fields["stable_if"]), known)
    found = compare(region, tuple((*mine, *theirs) for mine in ours for theirs in union))
    return {"right": "true", "wrong": "false"}.get(found.verdict, "undecided")


def _is_met(milestone: Milestone, lines: Sequence[Line], right: set[str]) -> bool:
    """Return whether a milestone is among the true lines, or defines a letter that was rightly defined."""
    sides = _sides(milestone.relation)
    letter = milestone.relation.split("=")[0].strip()
    return letter in right or any(line.verdict == "true" and _sides(line.relation) == sides for line in lines)


def _sides(relation: str) -> frozenset[str]:
    return frozenset(re.sub(r"\s+", "", side) for side in relation.split("="))
