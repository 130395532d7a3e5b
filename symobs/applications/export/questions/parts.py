"""The parts of an exported question: what decides about each, as data of the grader."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from symobs.applications.checking.marks import other_polynomial
from symobs.exact import Factored, Matrix, Scalar
from symobs.ground.dataclass import dataclass
from symobs.ground.errors import InputError
from symobs.problem.expect.structure import factored_table
from symobs.tasks.design.compensator.compensator import CompensatorDesign
from symobs.tasks.design.gain.gain_kind import AssignedGain, GainWithZeros

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from symobs.tasks.design.gain.gain_design import GainDesign
    from symobs.tasks.result.in_convention import ResultInConvention

#: Fields of which one value is right, and nothing else of the task bears on it.
VALUES = {
    ("characteristic_polynomial", "polynomial"),
    ("controllability", "rank"),
    ("decomposition", "minimal_order"),
    ("gramian", "determinant"),
    ("gramian", "matrix"),
    ("initial_state", "x0"),
    ("initial_state_covariance", "covariance"),
    ("matrix_exponential", "matrix"),
    ("observability", "rank"),
    ("transfer_function", "transfer_function"),
}
#: The slips that a grader finds; the marks of a question may credit no others.
SLIPS = ("sign", "sign_convention", "transposed", "entry", "rounded", "other_half")
_ELSEWHERE = "leave it out with --asked, or have the answers checked by symobs check"


@dataclass(frozen=True)
class ExportedPart:
    """A part of a question.

    name      of its input: a letter, or `task_letter` where two parts have one letter
    letter    what the convention of the problem calls it
    free      how many parameters the right values have: 0 where there is one
    right     one right value as the convention writes it, row by row
    data      what the grader knows of it
    """

    name: str
    part: str
    letter: str
    kind: str
    free: int
    right: tuple[tuple[Scalar | str, ...], ...]
    data: Mapping[str, Any]

    @property
    def shape(self) -> tuple[int, int]:
        """The numbers of rows and columns."""
        return len(self.right), len(self.right[0])

    @property
    def is_function(self) -> bool:
        """Whether the variable may stand in the value."""
        return bool(self.data["function"])

    @property
    def numbers(self) -> tuple[tuple[Scalar, ...], ...] | None:
        """The right entries, None where they are not all numbers."""
        entries = [entry for row in self.right for entry in row]
        plain = all(isinstance(entry, Scalar) and entry.is_constant for entry in entries)
        return self.right if plain and not self.is_function else None  # type: ignore[return-value]


def exported_part(view: ResultInConvention, field: str, name: str, weight: str) -> ExportedPart:
    """Return a part of a question; raises `InputError` where no grader outside symobs can hold it."""
    letter = next((own for own, (standard, _) in view.names.items() if standard == field), field)
    made: dict[str, Any] = {
        "name": name,
        "part": f"{view.task}.{field}",
        "letter": letter,
        "weight": weight,
        "function": False,
    }
    made["variable"] = "t" if view.in_time else view.plant.variable
    if field == "verdict":
        word = view.result.verdict
        if word == "undecided":
            raise _refused(made["part"], "what is right is undecided")
        return _part(made | {"kind": "word", "symbolic": False, "right": word}, ((word,),))
    if view.result.gains_are_one and field in view.result.gains:
        both = " and ".join(view.result.gains)
        raise _refused(made["part"], f"an exported grader does not hold {both}, which are right together")
    if field in view.result.gains:
        return _gain(view, field, made)
    if isinstance(view.result, CompensatorDesign) and field == "F":
        return _compensator(view, made)
    if (view.task, field) in VALUES:
        return _value(view, field, made)
    raise _refused(made["part"], "an exported grader does not hold what decides about it")


def _part(data: dict[str, Any], right: Any, free: int = 0) -> ExportedPart:
    return ExportedPart(data["name"], data["part"], data["letter"], data["kind"], free, right, data)


def _refused(part: str, why: str) -> InputError:
    return InputError(why, where=part, repair=_ELSEWHERE)


# -- gains ------------------------------------------------------------------------------------------------------------


def _gain(view: ResultInConvention, field: str, made: dict[str, Any]) -> ExportedPart:
    """Return a gain: right where det(sI − A + LC) of its observer problem is the polynomial."""
    design = view.result.design_of(field)
    gain = design.answer[design.letter]
    if gain is None or not isinstance(design.kind, (AssignedGain, GainWithZeros)) or design.pair.equations:
        raise _refused(made["part"], "no gain is asked for that its polynomial alone makes right")
    pair, s = design.dual_pair(design.plant), view.plant.variable
    phi, other = design.answer["polynomial"], other_polynomial(view.result, field)
    sign = view.standard(made["letter"])[1]
    data = made | {
        "kind": "gain",
        "A": texts(pair.A.rows),
        "C": texts(pair.c.rows),
        "transposed": design.letter == "K",
        "phi": [str(entry) for entry in phi.coefficients(s)],
        "other": None if other is None else [str(entry) for entry in other.coefficients(s)],
        "zero": [list(place) for place in design.kind.zero],
        "turned": sign < 0,
        "right": texts(gain.rows),
    }
    _require_rational(view, made["part"], (*pair.A.entries, *pair.c.entries, phi, *gain.entries))
    given = (*pair.A.entries, *pair.c.entries, phi, *gain.entries)
    return _part(data | {"symbolic": _has_symbols(given, s)}, (-gain if sign < 0 else gain).rows, _parameters(design))


def _parameters(design: GainDesign) -> int:
    family = design.gain_family
    return 0 if family is None else len(family["parameters"])


def _compensator(view: ResultInConvention, made: dict[str, Any]) -> ExportedPart:
    """Return F(s) of one input and output with a full-order observer: it follows from the gains."""
    result = view.result
    F, m, s = result.fields["F"], result.plant.matrices, result.plant.variable
    value = F.value if isinstance(F, Factored) else F
    if not isinstance(value, Scalar) or result.has_reduced_observer:
        raise _refused(made["part"], "an exported grader holds F of one input, one output and a full-order observer")
    K, L = result.answer["K"], result.answer["L"]
    phi = result.loop_polynomial.value
    matrices = {"A": m.A, "B": m.B, "C": m.C, "D": m.D, "right_K": K, "right_L": L}
    _require_rational(view, made["part"], [entry for matrix in matrices.values() for entry in matrix.entries])
    data = made | {
        "kind": "compensator",
        "symbolic": _has_symbols((value,), s),
        "function": True,
        "order": result.own_matrix.shape[0],
        "phi": [str(entry) for entry in phi.coefficients(s)],
        **{name: texts(matrix.rows) for name, matrix in matrices.items()},
    }
    return _part(data, ((value,),), 0)


# -- other values -----------------------------------------------------------------------------------------------------


def _value(view: ResultInConvention, field: str, made: dict[str, Any]) -> ExportedPart:
    """Return a value that is the only right one."""
    found = view.result.fields[field]
    table = factored_table(found)
    value = found.value if isinstance(found, Factored) else found if table is None else table
    whole = isinstance(value, int) and not isinstance(value, bool)
    matrix = value if isinstance(value, Matrix) else None
    if matrix is None and not whole and not isinstance(value, Scalar):
        raise _refused(made["part"], "this is no matrix and no number")
    rows = matrix.rows if matrix is not None else ((Scalar.of(value),),)
    entries = [entry for row in rows for entry in row]
    _require_rational(view, made["part"], entries, made["variable"])
    function = any(made["variable"] in entry.names for entry in entries)
    data = made | {"kind": "value", "function": function, "exact": whole, "right": texts(rows)}
    data["symbolic"] = _has_symbols(entries, made["variable"])
    return _part(data, tuple(map(tuple, rows)))


def texts(rows: Iterable[Iterable[Scalar]]) -> list[list[str]]:
    """Return entries as exact texts."""
    return [[str(entry) for entry in row] for row in rows]


def _has_symbols(values: Iterable[Scalar], variable: str) -> bool:
    return any(value.names - {variable} for value in values)


def _require_rational(
    view: ResultInConvention, part: str, values: Iterable[Scalar], variable: str | None = None
) -> None:
    """Raise `InputError` where a value holds a root, an exponential or another number that is not rational."""
    declared = view.plant.symbols.names
    known = {*(declared or ()), variable or view.plant.variable}
    for value in values:
        strange = sorted(name for name in value.names if name not in known)
        if strange:
            message = f"its data hold {strange[0]}, and an exported grader computes with fractions alone"
            raise _refused(part, message)
