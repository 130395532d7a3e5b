"""What an answer is held against: the claims of the results, and regions."""

from __future__ import annotations

import re
from contextlib import suppress
from dataclasses import field, replace
from itertools import product
from typing import TYPE_CHECKING, Any

from symobs.applications.checking.answers import (
    VERDICTS,
    as_conditions,
    as_kernel,
    as_list,
    as_value,
    decimal_comma,
    exact,
    has_decimal_commas,
    has_decimals,
    has_two_readings,
    in_a_line,
    read_like,
    value_of,
    verdict_of,
)
from symobs.applications.checking.handwriting import in_letters, with_commas, without_and
from symobs.applications.checking.regions import region_verdict
from symobs.applications.checking.rounded import entries_are_right, in_enough_digits, is_as_stable, poles_are_right
from symobs.exact import Complex, Matrix, Root, Scalar, TooLarge, kernel
from symobs.exact.core.generators import functions_in
from symobs.exact.linear_algebra.transfer_function import pole_and_zero_polynomial
from symobs.formula.expression import parse_matrix, without_comma
from symobs.formula.expression.source import shown
from symobs.ground.dataclass import dataclass
from symobs.ground.errors import CertificateRejected, InputError, NotShown, ProblemErrors, SymobsError, UnknownName
from symobs.problem.agreement import DIFFERENT, EQUAL, OPEN, in_form_of
from symobs.problem.expect import digits_of, found_in, is_digits, met, names_of
from symobs.tasks.analysis.realization.canonical_form import CanonicalForm
from symobs.tasks.analysis.realization.kalman_decomposition import Decomposition
from symobs.tasks.design.compensator.output_feedback import OutputFeedback
from symobs.tasks.design.reduced_order.reduced_order_observer import ReducedOrderObserver
from symobs.tasks.result.in_convention import ResultInConvention

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping, Sequence

    from symobs.applications.checking.regions import Separation
    from symobs.problem.fields import Marking
    from symobs.tasks.result import Result


# The values of an answer in the form that a task asks for: a list, a row or a column, without the letter in front.


def as_asked(view: ResultInConvention, letter: str, value: Any) -> Any:
    """Return a value without the letter that it defines; a list as the list, the row or the column that is asked for."""
    if isinstance(value, str) and (inside := value_of(letter, value)) != value:
        value = as_value(inside)
    name = view.standard(letter)[0]
    if name == "conditions":
        return as_conditions(value)
    if isinstance(value, str):
        value = in_letters(value, *known_names(view))
    elif isinstance(value, list):
        value = [in_letters(entry, *known_names(view)) if isinstance(entry, str) else entry for entry in value]
    if is_listed(view, letter):
        value = as_list(without_and(value))
        return value.split(",") if name == "sizes" and isinstance(value, str) else value
    if name == "kernel":
        return as_kernel(value, view.plant.order)
    right = view.result.fields.get(name)
    shape = shape_of(view.result, name) if name in view.result.gains else getattr(right, "shape", None)
    return value if shape is None else in_a_line(with_commas(value, shape[1]), shape)


def known_names(view: ResultInConvention) -> tuple[set[str], str]:
    """Return the names that an answer may use, and the variable among them."""
    parameters = getattr(getattr(view.result, "question", None), "parameters", ())
    variable = view.argument
    return {*view.plant.symbols.signs, *parameters, variable}, variable


def is_listed(view: ResultInConvention, letter: str) -> bool:
    """Return whether the right value is a list of numbers, which a text writes in brackets."""
    right = view.fields.get(view.standard(letter)[0])
    if not isinstance(right, (list, tuple)) or letter in {"kernel", "stable_if"}:
        return letter == "sizes"
    return all(isinstance(entry, (Scalar, Complex, Root)) for entry in right)


def two_readings() -> InputError:
    """Return the error of a comma between two digits that a decimal may be meant by."""
    return InputError(
        "commas set entries apart", repair="write 2.5 with a decimal point, and semicolons between: 0.5; 2.5"
    )


def shape_of(result: Result, name: str) -> tuple[int, int]:
    """Return the size of a gain."""
    right = result.fields.get(name)
    if isinstance(right, Matrix):
        return right.shape
    n, m, p = result.plant.order, result.plant.inputs, result.plant.outputs
    return (m, n) if name == "K" else (n - p, p) if result.has_reduced_observer else (n, p)


# The parts of an answer: what each task asks for, and which fields are inputs of others.


#: Letters that a derivation keeps for the plant, also where an answer has parts of these names.
OF_THE_PLANT = ("A", "B", "C", "D")


def asked_of(result: Result) -> tuple[str, ...]:
    """Return the fields that a task asks for; the verdict where there is nothing else to be found.

    Where it depends on parameters whether something is so, a rank or a verdict alone does not say for which.
    """
    asked = result.fields_asked(result.specification)
    there = tuple(name for name in asked if exists(result, name) or name in result.decimals)
    depends = result.verdict == "conditional" and {*there} <= {"rank"} and bool(result.holds_where)
    return (*(there or ("verdict",)), *(("conditions",) if depends else ()))


def field_called(result: Result, name: str) -> str:
    """Return the field that a page writes x(t), y(t) or exp(A t); another name as it is."""
    return result.functions_of_time.get(re.sub(r"[\s*]", "", name), name)


def is_of_time(results: Iterable[Result], name: str) -> bool:
    """Return whether a name is that of a function of time, such as x(t), in one of the results."""
    return any(field_called(result, name) != name for result in results)


def exists(result: Result, name: str) -> bool:
    """Return whether a field has a value, or is the verdict."""
    return name in {"verdict", "conditions"} or result.fields.get(name) is not None


# Compensators that are given without gains: any F of no larger order whose closed loop has the poles asked for.


def closes_the_loop(result: Result, F: Matrix | Scalar | None) -> bool:
    """Return whether det(sI − A) · (poles of F) · det(I + PF) = φ_c φ_o, F proper and of no larger order than the observer."""
    if not isinstance(result, OutputFeedback):
        return False
    variable = result.plant.variable
    matrix = Matrix.of([[F]]) if isinstance(F, Scalar) else F
    assert isinstance(matrix, Matrix)  # noqa: S101 - the right F exists, and is read like it
    P = result.plant_function
    plant = P if isinstance(P, Matrix) else Matrix.of([[P]])
    if matrix.shape != (result.plant.inputs, result.plant.outputs):
        return False
    if any(entry.numerator.degree(variable) > entry.denominator.degree(variable) for entry in matrix.entries):
        return False
    poles, _ = pole_and_zero_polynomial(matrix, variable)
    if poles.degree(variable) > result.own_matrix.shape[0]:
        return False
    chi = result.plant.matrices.A.characteristic_polynomial(variable)
    loop = (Matrix.identity(plant.shape[0]) + plant @ matrix).determinant()
    return bool(chi * poles * loop == result.loop_polynomial.value)


# Answers that are right in many coordinates: canonical forms, decompositions, observers of reduced order.
#
# For the coordinates that the student took a result of the task's own type is made; what it claims decides, and the
# other values of the student are compared with those that it has there.


#: Orders up to which the coordinates of a modal form without T are looked for: they are the square of it in unknowns.
_MOST_STATES = 8
#: A result in the coordinates of an answer, and what is said of them.
Found = tuple["Result", str]


def in_coordinates(result: Result, given: Mapping[str, Matrix]) -> Iterator[Found]:
    """Yield results of the same task in coordinates that may be those of the given matrices, the likeliest first."""
    if isinstance(result, ReducedOrderObserver):
        yield from _reduced(result, given)
    elif isinstance(result, CanonicalForm):
        yield from _canonical(result, given)
    elif isinstance(result, Decomposition) and (T := given.get("T")) is not None:
        for matrix, said in _both_directions(T, result.plant.order):
            with suppress(CertificateRejected):
                there = replace(result, answer={**result.answer, **_moved(result, matrix)})
                yield _Other(there, {"T": T}), said  # type: ignore[misc]


def _both_directions(T: Matrix, order: int) -> Iterator[tuple[Matrix, str]]:
    """Yield T, and T⁻¹ with what is to be said of it, where T is regular."""
    if T.shape == (order, order) and not T.determinant().is_zero:
        yield T, ""
        yield T.inverse().normal(), "you gave T^-1: here the new state is T x"


def _moved(result: Result, T: Matrix) -> dict[str, Any]:
    """Return the plant in the coordinates T x."""
    m, S = result.plant.matrices, T.inverse().normal()
    return {
        "T": T,
        "inverse": S,
        "A": (T @ m.A @ S).normal(),
        "B": (T @ m.B).normal(),
        "C": (m.C @ S).normal(),
    }


# -- canonical forms --------------------------------------------------------------------------------------------------


def _canonical(result: CanonicalForm, given: Mapping[str, Matrix]) -> Iterator[Found]:
    """Yield the form in the four layouts in use; the modal form in the order and scaling of the given matrices."""
    if result.kind == "modal":
        if "T" not in given:
            for wrong in (None, *"CBA"):  # one of the matrices may be wrong, and the others right together
                T = _modal_coordinates(result, {name: value for name, value in given.items() if name != wrong})
                if T is not None:
                    yield _Other(result, _moved(result, T)), ""  # type: ignore[misc]
            return
        for T, said in _both_directions(given["T"], result.plant.order):
            moved = _moved(result, T)
            if _same_blocks(moved["A"], result.answer["A"]):
                yield _Other(result, {**moved, "T": given["T"]}), said  # type: ignore[misc]
        return
    for turn, layout in _layouts(result):
        T = (turn @ result.answer["T"]).normal()
        moved = _moved(result, T)
        yield _Other(result, moved), layout  # type: ignore[misc]
        if "T" in given and given["T"] == T.inverse():
            inverse = f"{layout}; " if layout else ""
            yield _Other(result, {**moved, "T": given["T"]}), f"{inverse}you gave T^-1: here the new state is T x"  # type: ignore[misc]


def _modal_coordinates(result: CanonicalForm, given: Mapping[str, Matrix]) -> Matrix | None:
    """Return a regular T with T A = Ā T, T B = B̄ and C̄ T = C for the matrices given of a modal form; None without one.

    With a last unknown beside the entries of T the equations are homogeneous: a T is a solution in which it is 1.
    """
    m, n, right = result.plant.matrices, result.plant.order, result.answer
    form = given.get("A", right["A"])
    sizes = all(value.shape == right[name].shape for name, value in given.items() if name in {"A", "B", "C"})
    if n > _MOST_STATES or not sizes or not _same_blocks(form, right["A"]):
        return None
    one, rows = Matrix.identity(n), []
    for i, j in product(range(n), range(n)):
        unit = one.select(range(n), [i]) @ one.select([j], range(n))
        found = [unit @ m.A - form @ unit]
        found += [unit @ m.B] if "B" in given else []
        found += [(given["C"] @ unit).T] if "C" in given else []
        rows.append([entry for each in found for entry in each.entries])
    last = [Scalar.of(0)] * (n * n)
    last += [-entry for entry in given["B"].entries] if "B" in given else []
    last += [-entry for entry in m.C.T.entries] if "C" in given else []
    solutions = kernel(Matrix.of([*rows, last]).T)
    for step in (1, 3):  # a sum with other weights, where the first one happens to be singular
        weights = Matrix.column([1 + step * k * k for k in range(solutions.shape[1])])
        entries = (solutions @ weights).entries if solutions.shape[1] else ()
        if not entries or entries[-1].is_zero:
            return None
        T = Matrix.of([[entries[i * n + j] / entries[-1] for j in range(n)] for i in range(n)])
        if not T.determinant().is_zero:
            return T
    return None


class _Other:
    """A result with some fields in place of its own: those of other coordinates, or what follows from wrong parts."""

    def __init__(self, result: Result, moved: Mapping[str, Any]) -> None:
        self.result = result
        self.fields = {**result.fields, **moved}
        self.claimed = tuple(name for name in result.claimed if name not in moved)

    def __getattr__(self, name: str) -> Any:
        return getattr(self.result, name)


def _layouts(result: CanonicalForm) -> Iterator[tuple[Matrix, str]]:
    """Yield the changes of coordinates to the layouts in use: χ in the last or first row, or in the last or first column."""
    n, A = result.plant.order, result.answer["A"]
    reverse = Matrix.of([[int(i + j == n - 1) for j in range(n)] for i in range(n)])
    one = Matrix.identity(n)
    if result.kind == "controllable":
        columns = [result.answer["B"]]
        while len(columns) < n:
            columns.append((A @ columns[-1]).normal())
        other, names = Matrix.block([columns]).inverse().normal(), ("row", "column")
    else:
        rows = [result.answer["C"]]
        while len(rows) < n:
            rows.append((rows[-1] @ A).normal())
        other, names = Matrix.block([[row] for row in rows]), ("column", "row")
    yield one, ""
    yield reverse, f"the coefficients stand in the first {names[0]} here"
    yield other, f"the coefficients stand in the last {names[1]} here"
    yield reverse @ other, f"the coefficients stand in the first {names[1]} here"


def _same_blocks(found: Matrix, right: Matrix) -> bool:
    """Return whether a matrix consists of the same diagonal blocks in some order; blocks of order 2 may be transposed."""
    mine, theirs = _blocks(found), _blocks(right)
    for block in mine:
        match = block if block in theirs or block.shape[0] > 2 else block.T
        if match not in theirs:
            return False
        theirs.remove(match)
    return True


def _blocks(matrix: Matrix) -> list[Matrix]:
    """Return the diagonal blocks of a matrix, as fine as neighbours allow."""
    found, inside, outside = [], [], list(range(matrix.shape[0]))
    while outside:
        inside.append(outside.pop(0))
        if matrix.select(inside, outside).is_zero and matrix.select(outside, inside).is_zero:
            found.append(matrix.select(inside, inside))
            inside = []
    return found


# -- observers of reduced order ---------------------------------------------------------------------------------------


def _reduced(result: ReducedOrderObserver, given: Mapping[str, Matrix]) -> Iterator[Found]:
    """Yield the observer whose state is the estimate of P x; P are the lower rows of M⁻¹, or solve P A − F P = H C."""
    plant, n, p = result.plant, result.plant.order, result.plant.outputs
    M = given.get("M")
    if M is not None and M.shape == (n, n) and not M.determinant().is_zero:
        P = M.inverse().normal().select(range(p, n), range(n))
    elif {"F", "H"} <= given.keys():
        solved = _estimated(result, given["F"], given["H"])
        if solved is None:
            return
        P = solved
    else:
        return
    T = Matrix.block([[plant.matrices.C], [P]])
    if T.determinant().is_zero:
        return
    try:
        there = ReducedOrderObserver.of(plant, result.desired, T, result.method)
        inner = there.inner.with_answer("L", Matrix.zeros(n - p, p))
        yield type(result).assembled(plant, inner, result.desired, T, result.method), ""
    except CertificateRejected:
        return


def _estimated(result: ReducedOrderObserver, F: Matrix, H: Matrix) -> Matrix | None:
    """Return P of P A − F P = H C, None where the sizes do not fit or it is not the only one."""
    A, C = result.plant.matrices.A, result.plant.matrices.C
    n, p = result.plant.order, result.plant.outputs
    r = n - p
    if F.shape != (r, r) or H.shape != (r, p):
        return None
    right = H @ C
    rows = []
    for i in range(r):
        for j in range(n):
            row = [Scalar.of(0)] * (r * n)
            for k in range(n):
                row[i * n + k] = row[i * n + k] + A[k, j]
            for k in range(r):
                row[k * n + j] = row[k * n + j] - F[i, k]
            rows.append(row)
    system = Matrix.of(rows)
    if system.determinant().is_zero:
        return None
    found = system.solve(Matrix.column([right[i, j] for i in range(r) for j in range(n)]))
    return Matrix.of([[found[i * n + j, 0] for j in range(n)] for i in range(r)])


# The verdict on each part of an answer to one task: the claims of the result decide, taken on the student's values.


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
        part = Judged(view.standard(letter)[0], letter, "wrong", value)
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
            own = _Other(own, {**own.consequences(task.leads), **task.leads})  # type: ignore[assignment]
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
    if (task.view.task, name) == ("stability_region", "stable_if"):
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
        if rounded and task.marking.decimals == "accept":
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


# -- regions ----------------------------------------------------------------------------------------------------------


def _region(task: _Task, part: Judged) -> Judged:
    """Return the verdict on a region given by conditions."""
    try:
        found = region_verdict(task.right, part.given, task.names)
    except UNDECIDED as error:
        return replace(part, verdict="undecided", reason=str(error))
    except InputError as error:
        return _unreadable(part, error)
    return replace(part, verdict=found.verdict, separation=found, reason=found.reason)
