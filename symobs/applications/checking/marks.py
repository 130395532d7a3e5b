"""From verdicts to parts with their credit, and why those that are wrong are so."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from typing import TYPE_CHECKING, Any

from symobs.applications.checking.answers.values import text_of
from symobs.applications.checking.faults.compensators import other_values
from symobs.applications.checking.faults.fault import Explained
from symobs.applications.checking.faults.gains import explain_gain
from symobs.applications.checking.faults.values import explain_value
from symobs.applications.checking.report.data import Part
from symobs.exact import Factored, Matrix, Scalar
from symobs.formula.expression import parse_matrix
from symobs.ground.errors import SymobsError
from symobs.problem.expect import found_in, shown_value
from symobs.problem.expect.structure import factored_table
from symobs.problem.expect.time_functions import agrees
from symobs.tasks.design.compensator.output_feedback import OutputFeedback
from symobs.tasks.result.in_convention import ResultInConvention

if TYPE_CHECKING:
    from symobs.applications.checking.judgement.judge import Judged, TaskJudgement
    from symobs.problem.marking import Marking
    from symobs.tasks.result import Result


def part_of(
    view: ResultInConvention, judgement: TaskJudgement, judged: Judged, marking: Marking, *, counts: bool
) -> Part:
    """Return a part with its credit, its slip, and the right value, which the report may not show."""
    name = f"{view.task}.{judged.name}"
    weight = marking.parts.get(name, Fraction(1)) if counts else Fraction(0)
    right = _right(view, judgement.right if judged.there is None else judged.there, judged.letter)
    part = Part(name, judged.letter, judged.verdict, weight, Fraction(0), text_of(judged.given), hints=judged.hints)
    part = replace(part, right=right, reason=judged.reason)
    match judged.verdict:
        case "right":
            return replace(part, credit=Fraction(1), effect=_effect(view, judgement, judged))
        case "undecided":
            return replace(part, credit=None)
        case "follows":
            origins = tuple(f"{view.task}.{origin}" for origin in judged.origins)
            return _followed(replace(part, origins=origins), judgement, judged, marking)
        case "wrong":
            return _explained(part, view, judgement, judged, marking)
    return part


def missing(view: ResultInConvention, name: str, marking: Marking) -> Part:
    """Return a part that the answer lacks."""
    letter = next((own for own, (standard, _) in view.names.items() if standard == name), name)
    part = f"{view.task}.{name}"
    right = _right(view, view.result, letter)
    return Part(part, letter, "missing", marking.parts.get(part, Fraction(1)), Fraction(0), right=right)


def _right(view: ResultInConvention, result: Result, letter: str) -> str | None:
    try:
        return shown_value(found_in(ResultInConvention(result, view.convention), letter))
    except KeyError:
        return None


# -- what follows -----------------------------------------------------------------------------------------------------


def _followed(part: Part, judgement: TaskJudgement, judged: Judged, marking: Marking) -> Part:
    """Return a part that is right from the student's own earlier one, without credit where that made it easy."""
    if marking.guard and any(_is_degenerate(judgement, name) for name in judged.origins):
        hint = "that makes this part too easy to count"
        return replace(part, credit=Fraction(0), hints=(*part.hints, hint))
    if marking.guard and judged.name == "F" and isinstance(judged.value, (Matrix, Scalar)):
        variable = judgement.right.plant.variable
        if judgement.right.task == "compensator" and variable not in judged.value.names:
            return replace(part, credit=Fraction(0), hints=(*part.hints, "it follows, but F is constant there"))
    return replace(part, credit=marking.follow_through)


def _is_degenerate(judgement: TaskJudgement, name: str) -> bool:
    """Return whether the student's wrong gain makes easy what follows: zero, much emptier than the right one, or a unit."""
    assert judgement.own is not None  # noqa: S101 - something follows from it
    mine, right = judgement.own.fields.get(name), judgement.right.fields.get(name)
    if not isinstance(mine, Matrix) or not isinstance(right, Matrix):
        return False
    filled, wanted = (sum(not entry.is_zero for entry in matrix.entries) for matrix in (mine, right))
    return filled == 0 or 2 * filled < wanted or (filled == 1 < wanted)


# -- what is wrong ----------------------------------------------------------------------------------------------------


def _effect(view: ResultInConvention, judgement: TaskJudgement, judged: Judged) -> dict[str, str]:
    if judged.name not in view.result.gains:
        return {}
    design = judgement.right.design_of(judged.name)
    return {"polynomial": str(design.answer["polynomial"]), "stable": design.stability.verdict}


def _explained(
    part: Part, view: ResultInConvention, judgement: TaskJudgement, judged: Judged, marking: Marking
) -> Part:
    """Return a part that is wrong with its slip, where one reproduces it."""
    if judged.separation is not None:
        slip, point = judged.separation.slip or None, judged.separation.point
        credit = marking.credit.get(slip or "", Fraction(0))
        place = None if point is None else {name: str(value) for name, value in point.items()}
        return replace(part, slip=slip, place=place, credit=credit)
    found = _explanation(view, judgement, judged)
    reasons = tuple(fault.reason for fault in found.alternatives)
    slips = [fault.slip for fault in found.alternatives] or [found.slip or ""]
    credit = min(marking.credit.get(slip, Fraction(0)) for slip in slips)
    said = found.reason or part.reason
    if not said and "polynomial" in found.effect:
        said = f"with your {judged.letter} the polynomial is {found.effect['polynomial']}, not the one asked for"
    if not said and (view.task, judged.name) == ("compensator", "F") and judgement.has_gains:
        said = f"this is not the {judged.letter} of your gains"
    return replace(
        part,
        slip=found.slip,
        place=found.place,
        reason=said,
        alternatives=reasons,
        effect=found.effect,
        credit=credit,
    )


def _explanation(view: ResultInConvention, judgement: TaskJudgement, judged: Judged) -> Explained:
    """Return why a value is wrong, as far as it is a matrix or a number."""
    if judged.value is None:
        return Explained()
    is_part = view.result.gains_are_one
    if is_part and view.standard(judged.letter)[1] < 0:
        return Explained()  # what is said of a value has its standard sign
    if judged.name in view.result.gains and isinstance(judged.value, Matrix) and not is_part:
        design = judgement.right.design_of(judged.name)
        turned = view.standard(judged.letter)[1] < 0
        right = design.answer[design.letter]
        rounded = right is not None and _rounds(judged, right, turned=turned)
        other = other_polynomial(judgement.right, judged.name)
        return explain_gain(design, judged.value, judged.letter, other, turned=turned, rounded=rounded)
    right = _exact((judgement.right if judged.there is None else judged.there).fields.get(judged.name))
    value = judged.value
    if right is None:
        return Explained()
    if judged.name in view.result.in_coordinates and view.task != "reduced_order_observer":
        return _without_coordinates(value, right, judged.letter) if isinstance(right, Matrix) else Explained()
    if isinstance(right, Scalar) and isinstance(value, Matrix) and value.shape == (1, 1):
        value = value[0, 0]
    variable = "t" if view.in_time else view.plant.variable
    in_loop = (view.task, judged.name) == ("compensator", "F")
    others = other_values(judgement.right) if in_loop else []
    return explain_value(value, right, judged.letter, variable, others, rounded=judged.rounded, in_loop=in_loop)


def _without_coordinates(value: Matrix | Scalar, right: Matrix, letter: str) -> Explained:
    """Return why a matrix is wrong in any coordinates: its size, or that it has no inverse."""
    rows, columns = value.shape if isinstance(value, Matrix) else (1, 1)
    if (rows, columns) != right.shape:
        sizes = f"{right.shape[0]}x{right.shape[1]} here, yours is {rows}x{columns}"
        return Explained(None, f"{letter} is {sizes}")
    if letter == "T" and isinstance(value, Matrix) and value.determinant().is_zero:
        return Explained(None, f"{letter} has no inverse")
    return Explained()


def _exact(right: Any) -> Matrix | Scalar | None:
    table = factored_table(right)
    if table is not None:
        return table
    if isinstance(right, Factored):
        return right.value
    if isinstance(right, int) and not isinstance(right, bool):
        return Scalar.of(right)
    return right if isinstance(right, (Matrix, Scalar)) else None


def _rounds(judged: Judged, right: Matrix, *, turned: bool) -> bool:
    """Return whether the decimals of a gain round the right one."""
    try:
        read = parse_matrix(judged.given, None, rounding=True)
    except SymobsError:
        return False
    return read.shape == right.shape and read != judged.value and agrees(-read if turned else read, right)


def other_polynomial(result: Result, name: str) -> Scalar | None:
    """Return the polynomial of the other half of a compensator, where it has the same degree."""
    loop = result if isinstance(result, OutputFeedback) else getattr(result, "loop", None)
    if not isinstance(loop, OutputFeedback):
        return None
    own, other = loop.design_of(name), loop.design_of("L" if name == "K" else "K")
    phi, second = own.answer["polynomial"], other.answer["polynomial"]
    variable = result.plant.variable
    return second if second != phi and second.degree(variable) == phi.degree(variable) else None
