"""The verdict on each part of an answer to one task: the claims of the result decide, taken on the student's values."""

from __future__ import annotations

from contextlib import suppress
from dataclasses import field, replace
from typing import TYPE_CHECKING, Any

from symobs._dataclass import dataclass
from symobs.analysis.realization.coordinates import BLOCKS
from symobs.checking.answers.lists import has_two_readings
from symobs.checking.answers.values import (
    VERDICTS,
    decimal_comma,
    exact,
    has_decimal_commas,
    has_decimals,
    read_like,
)
from symobs.checking.judgement.as_asked import as_asked, is_listed, shape_of, two_readings
from symobs.checking.judgement.coordinates import in_coordinates
from symobs.checking.judgement.gains import design_with, from_gains, with_claimed, with_gain, with_gains
from symobs.checking.judgement.other_compensators import closes_the_loop
from symobs.checking.judgement.parts import CLAIMED, GAINS, IN_COORDINATES, OF_GAIN, TOGETHER, exists, in_order
from symobs.checking.judgement.regions import region_verdict
from symobs.errors import (
    CertificateRejected,
    InputError,
    NotShown,
    ProblemErrors,
    SymobsError,
    UnknownName,
)
from symobs.exact import Matrix, Scalar, TooLarge
from symobs.expect import found_in, met, names_of
from symobs.expression import parse_matrix
from symobs.expression.source import shown
from symobs.result.in_convention import ResultInConvention

if TYPE_CHECKING:
    from collections.abc import Mapping

    from symobs.checking.judgement.regions import Separation
    from symobs.problem.marking import Marking
    from symobs.result import Result

#: What is raised where a question about a value is too large to be decided.
UNDECIDED = (NotShown, TooLarge)
#: So many faults of one value are named.
_MOST_SAID = 3
#: Fields for which that of another name does as well, and what is said then.
_EITHER = {
    "closed_loop_matrix": ("closed_loop_matrix_estimate", "in the state and its estimate"),
    "closed_loop_matrix_estimate": ("closed_loop_matrix", "in the state and the error"),
}


@dataclass(frozen=True)
class Judged:
    """A part of an answer with its verdict: right, follows, wrong, missing, unreadable, undecided.

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


@dataclass(frozen=True)
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
        """Whether a gain is given from which others follow."""
        return any(part.name in GAINS.get(self.right.task, ()) and part.value is not None for part in self.parts)


@dataclass()
class _Task:
    """The judgement of one task as it is made."""

    view: ResultInConvention
    names: Any
    marking: Marking
    right: Result
    gains: dict[str, Matrix] = field(default_factory=dict)
    wrong: tuple[str, ...] = ()
    own: Result | None = None
    #: Whether one of two gains is given that are not unique, and right or wrong together.
    is_half: bool = False


def judge_task(
    view: ResultInConvention, given: Mapping[str, Any], symbols: tuple[str, ...], marking: Marking
) -> TaskJudgement:
    """Return the verdict on each given part, by its name in the student's convention."""
    declared = names_of(view)
    names = declared if declared is None else {**declared, **dict.fromkeys(symbols, "real")}
    task = _Task(view, names, marking, view.result)
    given = {letter: as_asked(view, letter, value) for letter, value in given.items()}
    standard = {view.standard(letter)[0]: letter for letter in given}
    parts: dict[str, Judged] = {}
    if view.task in TOGETHER:
        task.is_half = view.fields["family"] is not None and not standard.keys() >= {*GAINS[view.task]}
        task.right = _together(task, task.right, {name: (standard[name], given[standard[name]]) for name in standard})
    for name in in_order(list(standard)):
        if name in GAINS.get(view.task, ()):
            parts[name] = _gain(task, name, standard[name], given[standard[name]])
        elif name == "H" and (view.task, name) in CLAIMED:
            parts[name] = _judged(task, name, standard[name], given[standard[name]])
    if "L" not in standard and (name := OF_GAIN.get(view.task, "")) in standard:
        task.right = _with_gain_behind(task, name, standard[name], given[standard[name]])
    if task.wrong:
        with suppress(SymobsError, ArithmeticError, ValueError, AttributeError, TypeError):
            task.own = from_gains(task.right, task.gains)
    together = [name for name in standard if name in IN_COORDINATES.get(view.task, ())]
    if together:
        parts |= _in_coordinates(task, {name: (standard[name], given[standard[name]]) for name in together})
    for name, letter in standard.items():
        if name not in parts:
            parts[name] = _judged(task, name, letter, given[letter])
    return TaskJudgement(tuple(parts[name] for name in standard), task.right, task.own)


def unreadable(name: str, letter: str, given: Any, error: SymobsError) -> Judged:
    """Return the part that cannot be read, with the place and the repair."""
    errors = error.errors if isinstance(error, ProblemErrors) else (error,)
    comma = decimal_comma(given)
    repair = f"write {comma.replace(',', '.')} with a decimal point" if comma else _repair(errors[0])
    said = "; ".join(filter(None, (*(each.message for each in errors[:_MOST_SAID]), repair)))
    return Judged(name, letter, "unreadable", given, reason=str(SymobsError(said)))


def _repair(error: SymobsError) -> str:
    """Return what a student can do, who declares no names in the problem file."""
    if not isinstance(error, UnknownName):
        return error.repair
    near, known = error.facts.get("nearest"), error.facts.get("declared")
    if not isinstance(known, tuple) or not known:
        return "write numbers alone"
    question = f'did you mean "{near}"? ' if near else ""
    return f"{question}write it with the letters known here: {', '.join(known)}"


# -- gains ------------------------------------------------------------------------------------------------------------


def _gain(task: _Task, name: str, letter: str, given: Any) -> Judged:
    """Return the verdict on a gain: it is right where the claim of the design holds for it."""
    _, sign = task.view.standard(letter)
    if task.right.fields.get("solvable") is False and not exists(task.right, name):  # nothing is left to place poles of
        return Judged(name, letter, "wrong", given, reason=f"there is no {letter} here")
    try:
        read = parse_matrix(given, task.names, where=letter)
    except SymobsError as error:
        return unreadable(name, letter, given, error)
    value = -read if sign < 0 else read
    shape = shape_of(task.right, name)
    if value.shape != shape:
        if has_decimal_commas(given, task.names, shape):
            return unreadable(name, letter, given, two_readings())
        rows, columns = (f"{a}x{b}" for a, b in (shape, value.shape))
        task.wrong = (*task.wrong, name)
        return Judged(name, letter, "wrong", given, value, reason=f"{letter} is {rows} here, yours is {columns}")
    task.gains[name] = value
    try:
        own = task.right.fields.get(name)
        other = task.right if value == own else with_gain(task.right, name, value)
    except CertificateRejected as rejected:
        if task.is_half:
            return Judged(
                name,
                letter,
                "undecided",
                given,
                value,
                reason=f"{' and '.join(GAINS[task.view.task])} are right together: give both",
            )
        task.wrong = (*task.wrong, name)
        claim = str(rejected.facts.get("claim", ""))
        return Judged(name, letter, "wrong", given, value, claims=((claim, False, "exact"),) if claim else ())
    except UNDECIDED as error:
        return Judged(name, letter, "undecided", given, value, reason=str(error))
    known = {condition.expression for condition in task.right.holds_where}
    new = [c.expression for c in other.holds_where if c.expression not in known]
    hints = (f"not defined where {' or '.join(f'{value} = 0' for value in new)}",) if new else ()
    task.right = other
    claims = tuple((c.claim, True, c.how) for c in other.all_certificates[:1])
    return Judged(name, letter, "right", given, value, hints, claims=claims)


def _together(task: _Task, right: Any, given: Mapping[str, tuple[str, Any]]) -> Result:
    """Return the result with the student's two gains where their claim holds for both, else what is right."""
    gains: dict[str, Matrix] = {}
    for name in GAINS[right.task]:
        if name not in given or right.answer[name] is None:
            return right
        letter, written = given[name]
        with suppress(SymobsError):
            read = parse_matrix(written, task.names, where=letter)
            gains[name] = -read if task.view.standard(letter)[1] < 0 else read
    if any(gains.get(name) is None or gains[name].shape != shape_of(right, name) for name in GAINS[right.task]):
        return right
    with suppress(CertificateRejected, *UNDECIDED):
        return with_gains(right, gains)
    return right


def _with_gain_behind(task: _Task, name: str, letter: str, given: Any) -> Result:
    """Return the result with the L in the student's A − L C, where that places the poles; else what is right."""
    with suppress(SymobsError, ArithmeticError, ValueError):
        value, pair = _value(task, name, letter, given), design_with(task.right, "L").plant.matrices
        if isinstance(value, Matrix) and value.shape == pair.A.shape:
            L = (pair.A - value) @ pair.C.T @ (pair.C @ pair.C.T).inverse()
            return with_gain(task.right, "L", L.normal())
    return task.right


# -- what follows from them -------------------------------------------------------------------------------------------


def _judged(task: _Task, name: str, letter: str, given: Any) -> Judged:
    """Return the verdict on a value: against the right gains, then against the student's own."""
    if not exists(task.right, name):
        return Judged(name, letter, "wrong", given, reason=f"there is no {letter} here")
    if (task.view.task, name) == ("stability_region", "stable_if"):
        return _region(task, name, letter, given)
    right = task.right.fields.get(name)
    if name == "verdict" or isinstance(right, bool) or (isinstance(right, str) and right in VERDICTS):
        word = VERDICTS.get(str(given).strip().strip('"').lower())
        if word is None:
            error = InputError(f'"{shown(str(given), 40)}" is no verdict', repair="write yes, no or conditional")
            return unreadable(name, letter, given, error)
        given = word == "yes" if isinstance(right, bool) else word
    is_of_numbers = name != "sizes" and is_listed(task.view, letter)
    if is_of_numbers and has_two_readings(given):
        return unreadable(name, letter, given, two_readings())
    part = Judged(name, letter, "wrong", given)
    try:
        part = replace(part, value=_value(task, name, letter, given))
        found = _holds(task, task.right, part)
        if found is not None:
            return replace(part, verdict="right", hints=found)
        if task.own is not None and exists(task.own, name) and (found := _holds(task, task.own, part)) is not None:
            return replace(part, verdict="follows", hints=found, origins=task.wrong)
        if name == "F" and view_is_free(task) and closes_the_loop(task.right, part.value):
            return replace(part, verdict="right", hints=("another compensator with the same closed-loop polynomial",))
        rounded = has_decimals(given) and _met(task, task.right, part, given)
        if rounded and task.marking.decimals == "accept":
            return replace(part, verdict="right", hints=("rounded",))
        if isinstance(right, Matrix) and has_decimal_commas(given, task.names, right.shape) and part.value is not None:
            raise two_readings()
        if is_of_numbers and has_two_readings(given, len(right or ())):
            raise two_readings()
    except UNDECIDED as error:
        return replace(part, verdict="undecided", reason=str(error))
    except SymobsError as error:
        return unreadable(name, letter, given, error)
    return replace(part, rounded=rounded)


def view_is_free(task: _Task) -> bool:
    """Return whether a compensator is given without gains."""
    return task.view.task == "compensator" and not task.gains and not task.wrong


def _value(task: _Task, name: str, letter: str, given: Any) -> Matrix | Scalar | None:
    """Return the value of a part as a matrix or a number, with the standard sign."""
    variable = "t" if task.view.in_time else task.view.plant.variable
    if task.right.plant.is_time_varying:
        return None
    read = read_like(found_in(task.right, name), given, task.names, variable, letter)
    return -read if read is not None and task.view.standard(letter)[1] < 0 else read


def _holds(task: _Task, result: Result, part: Judged) -> tuple[str, ...] | None:
    """Return the hints on a value that is right for a result, None where it is not."""
    if (task.view.task, part.name) in CLAIMED:
        matrix = part.value if isinstance(part.value, Matrix) or part.value is None else Matrix.of([[part.value]])
        if matrix is None:
            return None
        try:
            found = with_claimed(result, part.name, matrix)
        except CertificateRejected:
            return None
        task.right = found if result is task.right else task.right
        return ()
    if _met(task, result, part, exact(part.given)):
        return ()
    other, said = _EITHER.get(part.name, ("", ""))
    if other and exists(result, other) and _met(task, result, replace(part, name=other), exact(part.given)):
        return (said,)
    if part.name == "matrix" and isinstance(part.value, Matrix) and _same_rows(task, result, part.value):
        return ("the rows of a block stand in another order",)
    if part.name == "F" and task.marking.sign_of_F == "either" and part.value is not None:
        right = result.fields["F"]
        return ("with the other sign",) if part.value == -right else None
    return None


def _met(task: _Task, result: Result, part: Judged, given: Any) -> bool:
    """Return whether a value equals that of a result."""
    letter = part.letter if task.view.standard(part.letter)[0] == part.name else part.name
    return met(ResultInConvention(result, task.view.convention), letter, given, part.letter)


def _same_rows(task: _Task, result: Result, value: Matrix) -> bool:
    """Return whether an observability matrix has its rows, or a controllability matrix its columns, permuted in blocks."""
    tests = {"observability": result.plant.outputs, "controllability": result.plant.inputs}
    width, right = tests.get(task.view.task, 0), result.fields.get("matrix")
    if not width or not isinstance(right, Matrix) or value.shape != right.shape:
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


def _in_coordinates(task: _Task, given: Mapping[str, tuple[str, Any]]) -> dict[str, Judged]:
    """Return the verdicts on values that are right together, in coordinates that the student chose."""
    parts: dict[str, Judged] = {}
    for name, (letter, written) in given.items():
        in_a_row = name == "sizes" and isinstance(written, list) and len(written) == len(BLOCKS)
        entry = dict(zip(BLOCKS, written, strict=True)) if in_a_row else written
        try:
            parts[name] = Judged(name, letter, "wrong", entry, _value(task, name, letter, entry))
        except SymobsError as error:
            parts[name] = unreadable(name, letter, entry, error)
        value, right = parts[name].value, task.right.fields.get(name)
        if not isinstance(value, Matrix) or not isinstance(right, Matrix) or value.shape == right.shape:
            continue
        if has_decimal_commas(entry, task.names, right.shape):
            parts[name] = unreadable(name, letter, entry, two_readings())
    readable = {name: part for name, part in parts.items() if part.verdict != "unreadable"}
    matrices = {name: part.value for name, part in readable.items() if isinstance(part.value, Matrix)}
    best: set[str] = set()
    there, said = task.right, ""
    for result, remark in [(task.right, ""), *in_coordinates(task.right, matrices)]:
        held = {name for name, part in readable.items() if _is_met(task, result, part, exact(part.given))}
        if len(held) > len(best):
            best, there, said = held, result, remark
    hints = (said,) if said else ()
    for name, part in readable.items():
        if name in best:
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
    except InputError:
        return False


# -- regions ----------------------------------------------------------------------------------------------------------


def _region(task: _Task, name: str, letter: str, given: Any) -> Judged:
    """Return the verdict on a region given by conditions."""
    part = Judged(name, letter, "wrong", given)
    try:
        found = region_verdict(task.right, given, task.names)
    except UNDECIDED as error:
        return replace(part, verdict="undecided", reason=str(error))
    except InputError as error:
        return unreadable(name, letter, given, error)
    return replace(part, verdict=found.verdict, separation=found, reason=found.reason)
