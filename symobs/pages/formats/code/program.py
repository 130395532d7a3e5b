"""The observer or compensator of a document as the difference equation that a program runs, with what is proved of it.

ξ⁺ = A ξ + B w,  v = C ξ + D w  with doubles A, B, C, D: the inputs w in their order, the output v.  Nothing is written
unless the loop with exactly these doubles is proved stable.
"""

from __future__ import annotations

from collections import Counter
from decimal import Decimal, localcontext
from difflib import get_close_matches
from fractions import Fraction
from typing import TYPE_CHECKING, Any, NamedTuple

from symobs.exact import Matrix, Scalar
from symobs.exact.core.generators import symbols_in
from symobs.exact.floating.margin_search import disc_margin, half_plane_margin, size_of
from symobs.exact.floating.sampled import HOLDS, Sampled, nearest_double, rounded_matrix
from symobs.exact.floating.stability_margin import STEPS, deviation, is_in_disc, is_left_of, loop_matrix, own_matrix
from symobs.exact.linear_algebra.transfer_function import Realisation
from symobs.formula.expression import parse_scalar
from symobs.formula.expression.source import shown
from symobs.ground.errors import CertificateRejected, InputError, UsageError
from symobs.tasks.result import Result
from symobs.tasks.result.control_systems import Controller, require_numbers
from symobs.tasks.result.in_convention import ResultInConvention
from symobs.tasks.result.output_methods import to_json

if TYPE_CHECKING:
    from collections.abc import Callable

    from symobs.system import StateSpace
    from symobs.tasks.result import Document


_HOLD_NAMES = {"zoh": "zero-order hold", "tustin": "the bilinear map"}
_WHERE_MISSING = "use observer, reduced_order_observer or compensator"


class CodeProgram(NamedTuple):
    """The language-independent program: sizes, doubles, comments; `period` is None in continuous time."""

    name: str
    inputs: tuple[tuple[str, int], ...]
    output: tuple[str, int]
    numbers: Realisation
    period: Fraction | None
    lines: tuple[str, ...]
    #: What inputs and output are where a nonlinear plant rests: the equation is one of deviations from these.
    at_rest: tuple[tuple[float, ...], tuple[float, ...]] | None = None

    def slots(self, table: Callable[[list[list[str]]], str], comment: str = "") -> dict[str, object]:
        """Return what the templates of all languages name: sizes, signals, matrices as `table` writes them, comments."""
        (order, width), (output, outputs) = self.numbers.B.shape, self.output
        matrices = {name: table(in_doubles(getattr(self.numbers, name))) for name in "ABCD"}
        return matrices | {
            "lines": "\n".join(comment + line for line in self.lines),
            "name": self.name,
            "kind": self.name.capitalize(),
            "order": order,
            "width": width,
            "output": output,
            "outputs": outputs,
            "sizes": ", ".join(f"{name}: {size}" for name, size in self.inputs),
        }


def program_of(document: Document, *, in_continuous_time: bool = False) -> CodeProgram:
    """Return the program of the one result of a document that has one.

    Raises `UsageError` where none or several have, or the period does not fit, and `InputError` for letters without a
    value, for a plant with feedthrough, and where the loop with rounded numbers is not proved stable.
    """
    result, controller = _of_document(document)
    require_numbers(controller.system, "code")
    require_numbers(_gains(result, controller).values(), "code")
    plant = result.plant
    period = _period(document, plant, in_continuous_time=in_continuous_time)
    if controller.returns and plant.matrices.has_feedthrough:
        message = "the plant has feedthrough D: y would have to be measured while u, which depends on it, is applied"
        raise InputError(message, where="plant.D", repair="take y without D u, or model the delay as a state")
    sampled = Sampled(controller.system, period, document.hold)
    numbers = sampled.rounded()
    lines = [
        _what(document, controller, plant, period),
        *(line for name, gain in _gains(result, controller).items() for line in _gain(name, gain)),
        _proof(plant, controller, numbers, period),
        *_deviation(controller, sampled, numbers, plant, period),
    ]
    at_rest = _at_rest(controller, plant)
    if at_rest is not None:
        lines.insert(1, _where_it_rests(controller, at_rest))
    return CodeProgram(controller.name, controller.inputs, controller.output, numbers, period, tuple(lines), at_rest)


def _at_rest(controller: Controller, plant: StateSpace) -> tuple[tuple[float, ...], tuple[float, ...]] | None:
    """Return the inputs and the output of a program at the equilibrium of a nonlinear plant; None for a linear one.

    What the equilibrium leaves free is measured from where the plant is to rest: 0.
    """
    given = plant.nonlinear
    if given is None:
        return None
    free = dict.fromkeys(given.free, Scalar.of(0))
    point = {name: free.get(name, value).substitute(free) for name, value in given.equilibrium}
    of = {"x_hat": [point[name] for name in given.states], "u": [point[name] for name in given.inputs]}
    of["y"] = [] if given.h is None else [*given.h.substitute(point).entries]
    require_numbers([Matrix.column(values) for values in of.values() if values], "code")

    def doubles(name: str, size: int) -> tuple[float, ...]:
        return tuple(map(nearest_double, (of.get(name, []) + [Scalar.of(0)] * size)[:size]))

    inputs = tuple(value for name, size in controller.inputs for value in doubles(name, size))
    return inputs, doubles(*controller.output)


def _where_it_rests(controller: Controller, at_rest: tuple[tuple[float, ...], tuple[float, ...]]) -> str:
    (inputs, output), place, told = at_rest, 0, []
    for name, size in controller.inputs:
        told.append(f"{name} = {[*inputs[place : place + size]]}")
        place += size
    told.append(f"{controller.output[0]} = {[*output]}")
    return f"The plant rests at {', '.join(told)}: the equation is one of deviations from there."


def _of_document(document: Document) -> tuple[Result, Controller]:
    found = [(result, result.controller) for result in document.results]
    having = [(result, controller) for result, controller in found if controller is not None]
    if len(having) > 1:
        names = ", ".join(result.task for result, _ in having)
        raise UsageError(f"several results can be a program: {names}", where="--format", repair="choose one by --task")
    if having:
        return having[0]
    negative = next((result for result, _ in found if type(result).controller is not Result.controller), None)
    if negative is not None:
        message = f"there is no {negative.task} to write: its verdict is {negative.verdict}"
        raise InputError(message, where=negative.task, repair="look at its page for the reason")
    names = ", ".join(result.task for result, _ in found) or "this document"
    raise UsageError(f"{names} has no observer and no compensator", where="--format", repair=_WHERE_MISSING)


def _period(document: Document, plant: StateSpace, *, in_continuous_time: bool) -> Fraction | None:
    """Return the period, None for a plant in discrete time, or where the language has continuous time."""
    if document.hold not in HOLDS:
        repair = f"use one of {', '.join(HOLDS)}"
        raise UsageError(f"{document.hold[:40]!r} is no way to sample", where="--hold", repair=repair)
    if plant.is_discrete:
        if document.period is not None:
            raise UsageError("the plant is in discrete time already", where="--period", repair="leave the period out")
        return None
    if document.period is None:
        if in_continuous_time:
            return None
        message = "a program runs in discrete time"
        repair = 'give the period, for example --period 1/100, in Python period="1/100"'
        raise UsageError(message, where="--period", repair=repair)
    value = parse_scalar(document.period, {}, where="--period")
    if not value.is_constant or value.fraction() <= 0:
        raise UsageError(f"{value} is not a period", where="--period", repair="give a positive number such as 1/100")
    return value.fraction()


def _gains(result: Result, controller: Controller) -> dict[str, Matrix]:
    loop = {name: result.answer.get(name) for name in controller.gains}
    return {name: gain for name, gain in loop.items() if isinstance(gain, Matrix)}


# -- what is said of it -----------------------------------------------------------------------------------------------


def _what(document: Document, controller: Controller, plant: StateSpace, period: Fraction | None) -> str:
    inputs = " and ".join(name for name, _ in controller.inputs)
    order = controller.system.A.shape[0]
    what = f"{controller.name.capitalize()} of order {order}: {controller.output[0]} from {inputs}"
    if period is not None:
        return f"{what}, with the period {period}, by {_HOLD_NAMES[document.hold]}."
    dt = f" with the period {plant.dt}" if isinstance(plant.dt, Fraction) else ""
    return f"{what}, in discrete time{dt}." if plant.is_discrete else f"{what}, in continuous time."


def _gain(name: str, gain: Matrix) -> list[str]:
    """Return the gain in doubles, and how far they are from its entries."""
    rows = "; ".join(" ".join(repr(nearest_double(entry)) for entry in row) for row in gain.rows)
    off = [_distance(entry) for entry in gain.entries]
    largest = max(off, default=Fraction(0))
    return [f"{name} = [{rows}], " + (f"rounded by at most {above(largest)}." if largest else "exactly.")]


def _distance(value: Scalar) -> Fraction:
    """Return a bound of the distance of a number from its nearest double: half a unit in the last place, or 0."""
    near = Fraction(nearest_double(value))
    if value.is_constant:
        return abs(value.fraction() - near)
    return abs(near) / 2**52


def _proof(plant: StateSpace, controller: Controller, numbers: Realisation, period: Fraction | None) -> str:
    """Return the margin of stability of the loop with these doubles; raises `InputError` where it is not proved stable."""
    if controller.returns:
        m = plant.matrices
        enclosed = loop_matrix(Realisation(m.A, m.B, m.C, m.D), period, numbers)
        of = "the plant with this program" if period is None else "the sampled plant with this program"
    else:
        enclosed, of = own_matrix(numbers), "the matrix of this program"
    in_disc = plant.is_discrete or period is not None
    margin = disc_margin(enclosed) if in_disc else half_plane_margin(enclosed)
    if margin is None:
        message = f"with these rounded numbers {of} is not proved stable"
        repair = "choose a shorter period, or other poles" if period is not None else "choose other poles"
        raise InputError(message, where=controller.name, repair=repair)
    if not (is_in_disc(enclosed, margin) if in_disc else is_left_of(enclosed, margin, size_of(enclosed))):
        raise CertificateRejected(f"the margin {margin} of {of} is not proved")
    bound = f"|z| < {_exact_decimal(1 - margin)}" if in_disc else f"Re s < -{_exact_decimal(margin)}"
    return f"Proved for exactly these doubles: every eigenvalue of {of} has {bound}."


def _deviation(
    controller: Controller, sampled: Sampled, numbers: Realisation, plant: StateSpace, period: Fraction | None
) -> list[str]:
    """Return how far the program stays from exact arithmetic."""
    if period is None and not plant.is_discrete:
        return []
    bound = deviation(sampled, numbers)
    if bound is None:
        return [f"In {STEPS} steps rounding errors may grow beyond any bound in double precision."]
    steps = "at every step" if bound.always else f"in the first {STEPS} steps"
    output = f"{controller.output[0]} differs {steps} by at most {bound.output!r} from exact arithmetic"
    return [f"For inputs of modulus at most 1, from the state 0, {output}."]


def above(value: Fraction) -> str:
    """Return a decimal of two digits that is not below a positive number."""
    with localcontext() as context:
        context.prec, context.rounding = 2, "ROUND_UP"
        return f"{Decimal(value.numerator) / Decimal(value.denominator):.1e}"


def _exact_decimal(value: Fraction) -> str:
    """Return a terminating decimal in full."""
    with localcontext() as context:
        context.prec = 60
        return f"{Decimal(value.numerator) / Decimal(value.denominator):f}"


def in_doubles(matrix: Matrix) -> list[list[str]]:
    """Return the entries of a matrix of doubles in the shortest decimals that name them."""
    return [[repr(float(entry.fraction())) for entry in row] for row in rounded_matrix(matrix).rows]


# The answers of a document alone: exact, or as doubles.


class Answer(NamedTuple):
    """An answer of a task; `value` is None where it does not exist."""

    task: str
    name: str
    value: Any


def chosen_answers(document: Document, *, as_numbers: bool = False) -> list[Answer]:
    """Return the requested answers in the document's convention; raises `UsageError` for unknown names.

    Where several results have a name, it is that of each of them.
    """
    every = [answer for result in document.results for answer in _answers(result, document, as_numbers=as_numbers)]
    known = dict.fromkeys(answer.name for answer in every)
    for name in document.printed:
        if name not in known:
            near = get_close_matches(name, known, 1)
            named = dict.fromkeys(answer.name for answer in every if answer.value is not None)
            repair = f"did you mean {near[0]}?" if near else f"use {', '.join(named)}"
            raise UsageError(f"there is no answer {shown(name, 40)}", where="--print", repair=repair)
    printed = dict.fromkeys(document.printed)
    return [answer for name in printed for answer in every if answer.name == name]


def _answers(result: Result, document: Document, *, as_numbers: bool = False) -> list[Answer]:
    """Return what --print may name: the fields of a result, its verdict, and its conditions."""
    view = ResultInConvention(result, document.convention)
    fields = view.numbers if as_numbers else view.fields
    digits = {name: result.decimals[name] for name in result.fields if fields[name] is None and name in result.decimals}
    named = {**fields, **digits, "verdict": result.verdict, "conditions": result.holds_where}
    return [Answer(result.task, name, value) for name, value in named.items()]


def _told_apart(answers: list[Answer], mark: str) -> list[Answer]:
    """Return the answers, those of equal names named after their tasks, too."""
    number = Counter(answer.name for answer in answers)
    return [
        answer._replace(name=f"{answer.task}{mark}{answer.name}") if number[answer.name] > 1 else answer
        for answer in answers
    ]


def exact_answers(document: Document) -> str:
    """Return the answers as exact texts, NAME = VALUE; of one that does not exist the verdict and the fixed modes."""
    verdicts = {}
    for result in document.results:
        fixed = result.fields.get("fixed_modes")
        verdicts[result.task] = result.verdict + (f", fixed_modes = {_text(fixed)}" if fixed else "")
    return "".join(
        f"{answer.name} = {_text(answer.value)}\n"
        if answer.value is not None
        else f"{answer.name}: none, verdict = {verdicts[answer.task]}\n"
        for answer in _told_apart(chosen_answers(document), ".")
    )


def _text(value: Any) -> str:
    if isinstance(value, Matrix):
        return str(value)
    plain = to_json(value)
    return plain if isinstance(plain, str) else str(plain).replace("'", "")


def number_rows(document: Document, wanted: str) -> dict[str, list[list[str]]]:
    """Return the rows of the requested numeric answers, in the shortest decimals of their doubles.

    Raises `InputError` where one that is asked for has letters without a value, and where none is made of numbers;
    `UsageError` where one named is no number.
    """
    variables = {result.plant.variable for result in document.results} | {"t"}
    if document.printed:
        found = [answer for answer in chosen_answers(document, as_numbers=True) if answer.value is not None]
        for _, name, value in found:
            if not _is_table(value) or symbols_in(_matrix(value)) & variables:
                message = f"{name} is not made of numbers"
                raise UsageError(message, where="--print", repair="leave --format out, or write --format text")
    else:
        found = [Answer(r.task, *field) for r in document.results for field in r.numbers.items() if _is_table(field[1])]
        inside = [symbols_in(_matrix(answer.value)) & variables for answer in found]
        left_out = [answer.name for answer, letters in zip(found, inside, strict=True) if letters]
        found = [answer for answer, letters in zip(found, inside, strict=True) if not letters]
        if not found:
            listed = f"{', '.join(left_out)} contain{'s' if len(left_out) == 1 else ''}"
            said = f"{listed} {' and '.join(sorted(set().union(*inside)))}" if left_out else "no answer is made of them"
            repair = "write --format text for exact expressions"
            raise InputError(f"{wanted} needs numbers, and {said}", where="--format", repair=repair)
    tables = {answer.name: _matrix(answer.value) for answer in _told_apart(found, "_")}
    require_numbers(tables.values(), wanted)
    return {
        name: [[repr(nearest_double(entry)) for entry in row] for row in table.rows] for name, table in tables.items()
    }


def _is_table(value: Any) -> bool:
    return isinstance(value, (Matrix, Scalar)) or (isinstance(value, int) and not isinstance(value, bool))


def _matrix(value: Any) -> Matrix:
    return value if isinstance(value, Matrix) else Matrix.of([[Scalar.of(value)]])
