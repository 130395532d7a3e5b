"""The verdict on each part of an answer to one task: the claims of the result decide, taken on the student's values."""

from __future__ import annotations

from contextlib import suppress
from dataclasses import field, replace
from typing import TYPE_CHECKING, Any

from symobs.applications.checking.answers import (
    decimal_comma,
    exact,
    has_decimal_commas,
    has_decimals,
    has_two_readings,
    read_like,
)
from symobs.applications.checking.coordinates import Replaced, closes_the_loop, in_coordinates
from symobs.applications.checking.equilibria import Judge
from symobs.applications.checking.parts import (
    as_asked,
    exists,
    is_listed,
    shape_of,
    two_readings,
)
from symobs.applications.checking.regions import Separation, region_verdict
from symobs.applications.checking.rounded import entries_are_right, in_enough_digits, is_as_stable, poles_are_right
from symobs.applications.checking.wording import verdict_of
from symobs.applications.grader.claims import WORDS as VERDICTS
from symobs.exact import Matrix, Scalar, TooLarge
from symobs.exact.core.generators import functions_in
from symobs.formula.expression import parse_matrix, without_comma
from symobs.formula.expression.source import shown
from symobs.ground.dataclass import dataclass
from symobs.ground.errors import CertificateRejected, InputError, NotShown, ProblemErrors, SymobsError, UnknownName
from symobs.problem.agreement import DIFFERENT, EQUAL, OPEN, in_form_of
from symobs.problem.expect import digits_of, found_in, is_digits, met, names_of
from symobs.problem.landmarks import LANDMARKS
from symobs.tasks.result.in_convention import ResultInConvention

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    from symobs.applications.checking.equilibria import PointsVerdict
    from symobs.problem.fields import Marking
    from symobs.tasks.result import Result


#: What is raised where a question about a value is too large to be decided.
UNDECIDED = (NotShown, TooLarge)
#: So many faults of one value are named.
_MOST_SAID = 3


#: Fields for which that of another name does as well, and what is said then.
_EITHER = {
    "closed_loop_matrix": ("closed_loop_matrix_estimate", "in the state and its estimate"),
    "closed_loop_matrix_estimate": ("closed_loop_matrix", "in the state and the error"),
}


@dataclass
class Judged:
    """A part of an answer with its verdict: right, follows, wrong, missing, unreadable, undecided.

    own        the value before it was put into the form that is asked for
    name       the field in the standard convention;  `letter` is what the student's convention calls it
    value      the value in the standard convention, as far as it is a matrix or a number
    origins    the inputs of the student's that a part follows from
    there      the result in the coordinates of the student's, where other parts are right in them alone
    claims     the claims that were tried, and whether they hold
    """

    name: str
    letter: str
    verdict: str
    given: Any = None
    value: Matrix | Scalar | None = None
    hints: tuple[str, ...] = ()
    reason: str = ""
    origins: tuple[str, ...] = ()
    claims: tuple[tuple[str, bool, str], ...] = ()
    rounded: bool = False
    there: Result | None = None
    separation: Separation | None = None
    own: Any = None


@dataclass
class TaskJudgement:
    """The parts of an answer to one task.

    right   the result with those gains of the student's that are right in place of its own
    own     the result that follows from all gains of the student's; None where all are right, or nothing follows
    """

    parts: tuple[Judged, ...]
    right: Result
    own: Result | None

    @property
    def has_gains(self) -> bool:
        """Whether a gain is given from which others of the task follow."""
        return any(part.name in self.right.gains and part.value is not None for part in self.parts)


@dataclass(frozen=False)
class _Task:
    """The judgement of one task as it is made."""

    view: ResultInConvention
    names: Any
    marking: Marking
    right: Result
    gains: dict[str, Matrix] = field(default_factory=dict)
    #: The values of earlier parts besides gains that are wrong.
    leads: dict[str, Any] = field(default_factory=dict)
    wrong: tuple[str, ...] = ()
    own: Result | None = None
    #: Whether one of two gains is given that are not unique, and right or wrong together.
    is_half: bool = False

    @property
    def signs(self) -> Mapping[str, str]:
        """The declared signs."""
        return self.view.plant.symbols.signs


def judge_task(
    view: ResultInConvention, given: Mapping[str, Any], symbols: tuple[str, ...], marking: Marking
) -> TaskJudgement:
    """Return the verdict on each given part, by its name in the student's convention."""
    declared = names_of(view)
    names = declared if declared is None else {**declared, **dict.fromkeys(symbols, "real")}
    task = _Task(view, names, marking, view.result)
    each, unread = list[Judged](), list[Judged]()
    for letter, value in given.items():
        part = Judged(view.standard(letter)[0], letter, "wrong", value, own=value)
        try:
            each.append(replace(part, given=as_asked(view, letter, value)))
        except InputError as error:
            unread.append(_unreadable(part, error))
    asked = {part.name: part for part in each}
    parts: dict[str, Judged] = {}
    if task.right.gains_are_one:
        task.is_half = view.fields["family"] is not None and not asked.keys() >= {*task.right.gains}
        task.right = _together(task, task.right, asked)
    if "H" in asked and "H" in task.right.claimed:  # which the gain is one for
        parts["H"] = _judged(task, asked["H"])
    for name, part in asked.items():
        if name in task.right.gains:
            parts[name] = _gain(task, part)
    if "L" not in asked and (name := task.right.shows_gain) in asked:
        task.right = _with_gain_behind(task, asked[name])
    _follow(task)
    for name in task.right.leads:
        if name in asked and name not in parts:
            parts[name] = _judged(task, asked[name])
            if parts[name].verdict == "wrong" and parts[name].value is not None:
                task.leads[name], task.wrong = parts[name].value, (*task.wrong, name)
                _follow(task)
    if view.task == "equilibria":
        parts |= _points(task, asked)
    parts |= _in_coordinates(task, [part for part in each if part.name in task.right.in_coordinates])
    parts |= {name: _judged(task, part) for name, part in asked.items() if name not in parts}
    return TaskJudgement((*(parts[name] for name in asked), *unread), task.right, task.own)


def _follow(task: _Task) -> None:
    """Find what follows from the parts that are wrong so far, in place of what followed from fewer."""
    if not task.wrong:
        return
    with suppress(SymobsError, ArithmeticError, ValueError, AttributeError, TypeError):
        own = task.right.following_from(task.gains)
        if task.leads:
            own = Replaced(own, {**own.consequences(task.leads), **task.leads})  # type: ignore[assignment]
        task.own = own


def _unreadable(part: Judged, error: SymobsError) -> Judged:
    """Return the part as one that cannot be read, with the place and the repair."""
    errors = error.errors if isinstance(error, ProblemErrors) else (error,)
    comma = decimal_comma(part.given)
    repair = f"write {without_comma(comma)}" if comma else _repair(errors[0])
    said = "; ".join(filter(None, (*(each.message for each in errors[:_MOST_SAID]), repair)))
    return replace(part, verdict="unreadable", reason=str(SymobsError(said)))


def _repair(error: SymobsError) -> str:
    """Return what a student can do, who declares no names in the problem file."""
    if not isinstance(error, UnknownName):
        return error.repair
    near, known = error.facts.get("nearest"), error.facts.get("declared")
    if not known:
        return "write numbers alone"
    question = f'did you mean "{near}"? ' if near else ""
    return f"{question}write it with the letters known here: {', '.join(map(str, known))}"  # type: ignore[call-overload]


# -- gains ------------------------------------------------------------------------------------------------------------


def _gain(task: _Task, part: Judged) -> Judged:
    """Return the verdict on a gain: it is right where the claim of the design holds for it."""
    name, letter = part.name, part.letter
    try:
        value = _gain_in(task, part)
    except SymobsError as error:
        return _unreadable(part, error)
    if not exists(task.right, name) and task.right.fields.get("solvable") is False:  # nothing to place poles of
        return replace(part, reason=f"there is no {letter} here")
    part = replace(part, value=value)
    shape = shape_of(task.right, name)
    if value.shape != shape:
        if has_decimal_commas(part.given, task.names, shape):
            return _unreadable(part, two_readings())
        rows, columns = (f"{a}x{b}" for a, b in (shape, value.shape))
        task.wrong = (*task.wrong, name)
        return replace(part, reason=f"{letter} is {rows} here, yours is {columns}")
    own = task.right.fields.get(name)
    known, why = DIFFERENT, ""
    if own is not None:
        value, known, why = in_form_of(value, own, task.signs)
        part = replace(part, value=value)
    task.gains[name] = value
    try:
        other = task.right if known == EQUAL else task.right.with_gains({name: value})
    except UNDECIDED as error:
        return replace(part, verdict="undecided", reason=str(error))
    except CertificateRejected as rejected:
        try:
            if task.marking.decimals == "accept" and _is_rounded(task, part, value):
                return replace(part, verdict="right", hints=("rounded",))
        except UNDECIDED as error:
            known, why = OPEN, str(error)
        if known == OPEN:
            return replace(part, verdict="undecided", reason=why)
        if task.is_half:
            return replace(
                part, verdict="undecided", reason=f"{' and '.join(task.right.gains)} are right together: give both"
            )
        task.wrong = (*task.wrong, name)
        claim = rejected.facts.get("claim")
        return replace(part, claims=((str(claim), False, "exact"),) if claim else ())
    before = {condition.expression for condition in task.right.holds_where}
    new = [c.expression for c in other.holds_where if c.expression not in before]
    hints = (f"not defined where {' or '.join(f'{value} = 0' for value in new)}",) if new else ()
    task.right = other
    claims = tuple((c.claim, True, c.how) for c in other.all_certificates[:1])
    return replace(part, verdict="right", hints=hints, claims=claims)


def _gain_in(task: _Task, part: Judged) -> Matrix:
    """Return a gain with its sign in the standard convention."""
    read = parse_matrix(part.given, task.names, functions=True)
    return -read if task.view.standard(part.letter)[1] < 0 else read


def rounds(
    view: ResultInConvention, part: Judged, right: Matrix | Scalar | None, names: Any, digits: int | None
) -> bool:
    """Return whether decimals of a gain round the right one, which is given in the standard convention."""
    if not has_decimals(part.given):
        return False
    turned = right is not None and view.standard(part.letter)[1] < 0
    try:
        return entries_are_right(view, part.letter, part.given, -right if turned else right, names, digits)  # type: ignore[operator]
    except UNDECIDED:
        raise
    except SymobsError:
        return False


def _is_rounded(task: _Task, part: Judged, value: Matrix) -> bool:
    """Return whether decimals stand for a right gain, whose loop is stable as it should be.

    Its entries, or the poles placed, are right to the digits asked for; without a number of them the entries are.
    """
    design, digits = task.right.design_of(part.name), task.marking.digits
    right = task.right.fields[part.name]
    near = rounds(task.view, part, right, task.names, digits)
    if not near and digits is not None and has_decimals(part.given):
        near = poles_are_right(design, value, digits)
    return near and is_as_stable(task.right, part.name, value)


def _together(task: _Task, right: Any, given: Mapping[str, Judged]) -> Any:
    """Return the result with the student's two gains where their claim holds for both, else what is right."""
    if right.answer[right.gains[0]] is None or not given.keys() >= {*right.gains}:
        return right
    with suppress(SymobsError, *UNDECIDED):
        gains = {name: _gain_in(task, given[name]) for name in right.gains}
        if all(gain.shape == shape_of(right, name) for name, gain in gains.items()):
            return right.with_gains(gains)
    return right


def _with_gain_behind(task: _Task, part: Judged) -> Result:
    """Return the result with the L in the student's A − L C, where that places the poles; else what is right."""
    with suppress(SymobsError, ArithmeticError, ValueError):
        value, pair = _value(task, part), task.right.design_of("L").plant.matrices
        if isinstance(value, Matrix) and value.shape == pair.A.shape:
            L = (pair.A - value) @ pair.C.T @ (pair.C @ pair.C.T).inverse()
            return task.right.with_gains({"L": L.normal()})
    return task.right


# -- what follows from them -------------------------------------------------------------------------------------------


def _judged(task: _Task, part: Judged) -> Judged:
    """Return the verdict on a value: against the right gains, then against the student's own."""
    name, given = part.name, part.given
    in_digits = is_digits(task.right.fields.get(name))
    if in_digits:
        try:
            return replace(part, verdict="right", hints=("rounded",)) if _met(task, task.right, part, given) else part
        except SymobsError as unread:
            return _unreadable(part, unread)
    if not exists(task.right, name) and name in task.right.decimals:  # digits answer: no closed form
        return _in_digits(task, part)
    if not exists(task.right, name):
        return replace(part, reason=f"there is no {part.letter} here")
    is_transcendental = (task.view.task, name) == ("stability_region", "stable_if") and not hasattr(
        task.right, "critical"
    )
    if (task.view.task, name) == ("stability_region", "stable_if") and not is_transcendental:
        return _region(task, part)
    right = task.right.fields.get(name)
    if name == "verdict" or isinstance(right, bool) or (isinstance(right, str) and right in VERDICTS):
        word = verdict_of(str(given), task.view.task if name == "verdict" else name)
        if word is None:
            error = InputError(f'"{shown(str(given), 40)}" is no verdict', repair="write yes, no or conditional")
            return _unreadable(part, error)
        given = word == "yes" if isinstance(right, bool) else word
        part = replace(part, given=given)
    is_of_numbers = is_listed(task.view, part.letter)
    if is_of_numbers and has_two_readings(given):
        return _unreadable(part, two_readings())
    try:
        part = replace(part, value=_in_form(task, _value(task, part), right))
        found = _holds(task, task.right, part)
        if found is not None:
            return replace(part, verdict="right", hints=found)
        if task.own is not None and exists(task.own, name) and (found := _holds(task, task.own, part)) is not None:
            return replace(part, verdict="follows", hints=found, origins=task.wrong)
        if name == "F" and not task.gains and not task.wrong and closes_the_loop(task.right, part.value):
            return replace(part, verdict="right", hints=("another compensator with the same closed-loop polynomial",))
        rounded = _is_right_rounding(task, part, right)
        if rounded and (task.marking.decimals == "accept" or part.name in LANDMARKS or is_transcendental):
            return replace(part, verdict="right", hints=("rounded",))
        if isinstance(right, Matrix) and has_decimal_commas(given, task.names, right.shape):
            raise two_readings()
        if is_of_numbers and has_two_readings(given, len(right or ())):
            raise two_readings()
    except UNDECIDED as error:
        return replace(part, verdict="undecided", reason=str(error))
    except SymobsError as error:
        return _unreadable(part, error)
    return replace(part, rounded=rounded)


def _in_digits(task: _Task, part: Judged) -> Judged:
    """Return the verdict on a value of which the right one has no closed form: its digits have to be right."""
    try:
        if not entries_are_right(task.view, part.letter, part.given, None, task.names, task.marking.digits):
            return part
        value = parse_matrix(part.given, task.names, functions=True)
        digits = digits_of(task.view, part.letter, _DIGITS_OF_LOOP)
    except UNDECIDED as error:
        return replace(part, verdict="undecided", reason=str(error))
    except SymobsError as error:
        return _unreadable(part, error)
    if task.view.standard(part.letter)[1] < 0:
        value, digits = -value, digits and -digits
    if not is_as_stable(task.right, part.name, value, digits):
        return replace(part, reason=f"the loop of this {part.letter} is not stable")
    return replace(part, verdict="right", hints=("rounded",))


#: The digits of a right gain by which its loop is seen to be stable.
_DIGITS_OF_LOOP = 30


def _is_right_rounding(task: _Task, part: Judged, right: Any) -> bool:
    """Return whether decimals are those of the right value, and a gain among them keeps its loop stable."""
    if not has_decimals(part.given):
        return False
    digits, turned = task.marking.digits, task.view.standard(part.letter)[1] < 0
    if not isinstance(right, (Matrix, Scalar)) or task.right.in_time or task.right.plant.is_time_varying:
        return _met(task, task.right, part, in_enough_digits(part.given, digits))
    if not entries_are_right(task.view, part.letter, part.given, -right if turned else right, task.names, digits):
        return False
    return not isinstance(part.value, Matrix) or is_as_stable(task.right, part.name, part.value * (-1 if turned else 1))


def _value(task: _Task, part: Judged) -> Matrix | Scalar | None:
    """Return the value of a part as a matrix or a number."""
    variable = task.view.argument
    if task.right.plant.is_time_varying:
        return None
    return read_like(found_in(task.right, part.name), part.given, task.names, variable, part.letter)


def _in_form(task: _Task, value: Matrix | Scalar | None, right: Any) -> Matrix | Scalar | None:
    """Return a value whose entries are written as the right ones that they equal, so that the others alone are wrong."""
    if not isinstance(value, (Matrix, Scalar)) or not isinstance(right, (Matrix, Scalar)):
        return value
    return in_form_of(value, right, task.signs)[0] if functions_in([value, right]) else value


def _holds(task: _Task, result: Result, part: Judged) -> tuple[str, ...] | None:
    """Return the hints on a value that is right for a result, None where it is not."""
    if part.name in result.claimed:
        matrix = Matrix.of([[part.value]]) if isinstance(part.value, Scalar) else part.value
        assert isinstance(matrix, Matrix)  # noqa: S101 - the right value exists, and is read like it
        own = result.fields[part.name]
        matrix, known, why = in_form_of(matrix, own, task.signs)
        try:
            found = result if known == EQUAL else result.with_answer(part.name, matrix)
        except UNDECIDED:
            raise
        except CertificateRejected:
            if known == OPEN:
                raise TooLarge(why) from None
            return None
        task.right = found if result is task.right else task.right
        return ()
    if _met(task, result, part, exact(part.given)):
        return ()
    if part.name == "conditions" and isinstance(part.given, list):  # without which there is no plant may go unsaid
        return () if _met(task, result, part, [*exact(part.given), *map(str, result.domain)]) else None
    if part.name in _EITHER:
        other, said = _EITHER[part.name]
        if exists(result, other) and _met(task, result, replace(part, name=other), exact(part.given)):
            return (said,)
    if part.name == "matrix" and isinstance(part.value, Matrix) and _same_rows(task, result, part.value):
        return ("the rows of a block stand in another order",)
    if part.name == "F" and task.marking.sign_of_F == "either" and part.value == -result.fields["F"]:
        return ("with the other sign",)
    return None


def _met(task: _Task, result: Result, part: Judged, given: Any) -> bool:
    """Return whether a value equals that of a result."""
    letter = part.letter if task.view.standard(part.letter)[0] == part.name else part.name
    return met(ResultInConvention(result, task.view.convention), letter, given, part.letter)


def _same_rows(task: _Task, result: Result, value: Matrix) -> bool:
    """Return whether an observability matrix has its rows, or a controllability matrix its columns, permuted in blocks."""
    tests = {"observability": result.plant.outputs, "controllability": result.plant.inputs}
    width, right = tests.get(task.view.task), result.fields["matrix"]
    if width is None or value.shape != right.shape:
        return False
    if task.view.task == "controllability":
        value, right = value.T, right.T
    blocks = [
        sorted(map(str, matrix.rows[i : i + width]))
        for matrix in (value, right)
        for i in range(0, right.shape[0], width)
    ]
    half = len(blocks) // 2
    return blocks[:half] == blocks[half:]


def _in_coordinates(task: _Task, given: Sequence[Judged]) -> dict[str, Judged]:
    """Return the verdicts on values that are right together, in coordinates that the student chose."""
    parts: dict[str, Judged] = {}
    for each in given:
        name, entry = each.name, each.given
        if name == "sizes" and isinstance(entry, list) and len(entry) == len(task.right.fields[name]):
            entry = dict(zip(task.right.fields[name], entry, strict=True))
        part = replace(each, given=entry)
        try:
            parts[name] = replace(part, value=_value(task, part))
        except SymobsError as error:
            parts[name] = _unreadable(part, error)
        right = task.right.fields.get(name)
        if isinstance(right, Matrix) and has_decimal_commas(entry, task.names, right.shape):
            parts[name] = _unreadable(part, two_readings())
    readable = {name: part for name, part in parts.items() if part.verdict != "unreadable"}
    matrices = {name: part.value for name, part in readable.items() if isinstance(part.value, Matrix)}
    held: set[str] = set()
    hints: tuple[str, ...] = ()
    there = task.right
    for result, remark in [(task.right, ""), *in_coordinates(task.right, matrices)]:
        here = {name for name, part in readable.items() if _is_met(task, result, part, exact(part.given))}
        if len(here) > len(held):
            held, there, hints = here, result, (remark,) if remark else ()
    undecided = {name for name, part in readable.items() if name not in held and _is_open(task, there, part)}
    for name, part in readable.items():
        if name in undecided:
            parts[name] = replace(part, verdict="undecided", reason="whether it is the right value is not decided")
        elif name in held:
            parts[name] = replace(part, verdict="right", hints=hints)
        elif task.own is not None and _is_met(task, task.own, part, exact(part.given)):
            parts[name] = replace(part, verdict="follows", origins=task.wrong)
        else:
            rounded = has_decimals(part.given) and _is_met(task, there, part, part.given)
            parts[name] = replace(part, rounded=rounded, there=there)
    return parts


def _is_met(task: _Task, result: Result, part: Judged, given: Any) -> bool:
    try:
        return exists(result, part.name) and _met(task, result, part, given)
    except (InputError, *UNDECIDED):
        return False


def _is_open(task: _Task, result: Result, part: Judged) -> bool:
    """Return whether it is not decided if a value is that of a result."""
    try:
        _ = exists(result, part.name) and _met(task, result, part, exact(part.given))
    except UNDECIDED:
        return True
    except InputError:
        return False
    return False


# -- equilibria -------------------------------------------------------------------------------------------------------


def _points(task: _Task, asked: dict[str, Judged]) -> dict[str, Judged]:
    """Return the verdicts on points and on their stability, which may stand behind the points."""
    judge, parts = Judge(task.view, task.marking), dict[str, Judged]()
    if "points" in asked:
        parts["points"] = _held(judge.points, asked["points"])
        if parts["points"].verdict != "unreadable":
            read = "; ".join(dict.fromkeys(map(str, judge.read)))
            parts["points"] = replace(parts["points"], given=read or "none")
            if "stable" not in asked and (said := judge.stability_said) is not None:
                asked["stable"] = Judged("stable", "stable", "wrong", said, own=said)
    if "stable" in asked:
        parts["stable"] = _held(judge.stability, asked["stable"])
    return parts


def _held(judged: Callable[[Any], PointsVerdict], part: Judged) -> Judged:
    try:
        found = judged(part.given)
    except UNDECIDED as error:
        return replace(part, verdict="undecided", reason=str(error))
    except SymobsError as error:
        return _unreadable(part, error)
    if found.verdict == "wrong":
        return replace(part, separation=Separation("wrong", slip=found.slip), reason=found.reason)
    return replace(part, verdict=found.verdict, reason=found.reason)


# -- regions ----------------------------------------------------------------------------------------------------------


def _region(task: _Task, part: Judged) -> Judged:
    """Return the verdict on a region given by conditions."""
    try:
        found = region_verdict(task.right, part.given, task.names, task.marking)
    except UNDECIDED as error:
        return replace(part, verdict="undecided", reason=str(error))
    except InputError as error:
        return _unreadable(part, error)
    if found.verdict == "right":
        return replace(part, verdict="right", hints=(found.slip,) if found.slip else ())
    return replace(part, verdict=found.verdict, separation=found, reason=found.reason)
