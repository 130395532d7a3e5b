"""What is the same for all points of a sweep: answers as formulas in the names that run, and the claims they must meet.

Every point is checked: det(sI − A + BK), det(sI − A + LC) and F(s) are computed there from the data, and compared with
what was asked for.  A point where a formula is not defined, where one of its conditions fails or a case of its own
begins, is solved alone.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from symobs.exact import Matrix, Scalar
from symobs.exact.core.generators import substitute, symbols_in
from symobs.exact.linear_algebra.elimination import (
    PointEvaluator,
    characteristic,
    numbers,
    polynomial,
    reduced_fraction,
    texts,
)
from symobs.formula.expression import parse_scalar
from symobs.ground.errors import CertificateRejected, InputError
from symobs.problem import validate
from symobs.system.specification import desired_polynomial

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence
    from fractions import Fraction

    from symobs.tasks.result import Result

#: The gains that each task has, and the polynomial of each: what is asked for under these names.
GAINS = {"state_feedback": ("K",), "observer": ("L",), "compensator": ("K", "L")}
#: The columns that say how far a loop is from instability; how each point went: done, unstable, undecided.
MARGINS = ("gain_down", "gain_up", "phase_deg", "modulus", "slowest")
MARGINS_STATUS = "margins_status"
_HALF = {"K": "control", "L": "observer"}
_RELATION = re.compile(r"(.+) (!=|==|>=|<=|>|<) 0")
_HOLDS = {
    "!=": lambda value: value != 0,
    "==": lambda value: value == 0,
    ">": lambda value: value > 0,
    "<": lambda value: value < 0,
    ">=": lambda value: value >= 0,
    "<=": lambda value: value <= 0,
}
_NAME = re.compile(r"[0-9]+(?:\.[0-9]*)?(?:[eE][-+]?[0-9]+)?|\.[0-9]+|[A-Za-z][A-Za-z0-9_]*")


class Row:
    """What a sweep says of a point: how it went, which case applies there, and the values by column."""

    __slots__ = ("case", "status", "values")

    def __init__(self, status: str, values: Sequence[str | None], case: int | None = None) -> None:
        self.status, self.values, self.case = status, values, case


class Program:
    """A problem with its swept names, and its answers as formulas where it was solved once."""

    def __init__(
        self, tables: Mapping[str, Any], names: Sequence[str], answer: Mapping[str, Any] | None, *, with_F: bool = True
    ) -> None:
        """Read the problem and the formulas; raises `ValueError` where these are no rational functions of the names."""
        self.tables, self.names = tables, tuple(names)
        self.problem = validate(tables)
        (self.task,) = self.problem.tasks
        plant, self.variable = self.problem.plant, self.problem.plant.variable
        self.n, self.m, self.p = plant.order, plant.inputs, plant.outputs
        self.gains = GAINS.get(self.task.name, ())
        self.with_F = with_F and self.task.name == "compensator" and self.m == self.p == 1
        self.is_once = answer is not None
        if answer is not None:
            self._prepare(answer)

    def _prepare(self, answer: Mapping[str, Any]) -> None:
        m, asked = self.problem.plant.matrices, self.problem.specification
        parts: dict[str, list[Scalar]] = {"A": [*m.A.entries]}
        parts |= {"B": [*m.B.entries]} if self.m else {}
        parts |= {"C": [*m.C.entries]} if self.p else {}
        parts |= {"D": [*m.D.entries]} if self.m and self.p else {}
        for gain in self.gains:
            own = ("poles", "polynomial") if {"poles", "polynomial"} & asked.keys() and len(self.gains) == 1 else ()
            keys = own or tuple(f"{_HALF[gain]}_{kind}" for kind in ("poles", "polynomial"))
            wanted = desired_polynomial(self.problem.plant, *(asked.get(key) for key in keys), required=False)
            if wanted is None:
                raise ValueError("a gain is given, nothing is asked for")
            parts[f"phi_{gain}"] = [Scalar.of(1), *wanted.coefficients]
            parts[gain] = [self._scalar(entry) for row in answer[gain] for entry in row]
        relations = [self._relation(text) for text in answer["conditions"]]
        cases = [[self._relation(text) for text in case["when"]] for case in answer["cases"]]
        self.conditions = [operator for _, operator in relations]
        self.cases = [[operator for _, operator in case] for case in cases]
        parts["conditions"] = [value for value, _ in relations]
        parts["cases"] = [value for case in cases for value, _ in case]
        self.places: dict[str, slice] = {}
        values: list[Scalar] = []
        for name, entries in parts.items():
            self.places[name] = slice(len(values), len(values) + len(entries))
            values += entries
        self.evaluator = PointEvaluator(values, self.names)

    def _scalar(self, text: str) -> Scalar:
        return parse_scalar(text, self.problem.plant.symbols.names, where="a formula")

    def _relation(self, text: str) -> tuple[Scalar, str]:
        found = _RELATION.fullmatch(text)
        if found is None:
            raise ValueError(text)
        return self._scalar(found[1]), found[2]

    # -- columns -----------------------------------------------------------------------------------------------------

    def columns(self) -> list[str]:
        """Return the names of the columns: the entries of the gains, and the coefficients of F."""
        shapes = {"K": (self.m, self.n), "L": (self.n, self.p)}
        found = [f"{g}[{i + 1},{j + 1}]" for g in self.gains for i in range(shapes[g][0]) for j in range(shapes[g][1])]
        if self.with_F:
            found += [f"F.{part}[{k}]" for part in ("num", "den") for k in range(self.n + 1)]
        return found

    # -- points ------------------------------------------------------------------------------------------------------

    def line(self, outer: Sequence[Fraction]) -> None:
        """Fix all names but the last."""
        if self.is_once:
            self.evaluator.on_line(outer)

    def at(self, point: Sequence[Fraction]) -> Row:
        """Return the row of a point on the line, every claim of it checked there."""
        if self.is_once:
            values = self.evaluator.at(point[-1])
            case = self._case(values)
            if case is None and self._is_defined(values):
                found = self._checked(values)
                if found is not None:
                    return Row("done", found)
            return self.alone(point, case)
        return self.alone(point, None)

    def _case(self, values: Sequence[Any]) -> int | None:
        """Return the index of the case that applies at a point, None where the general formula does."""
        given = iter(values[self.places["cases"]])
        for index, operators in enumerate(self.cases):
            here = [next(given) for _ in operators]
            if all(
                value is not None and _HOLDS[operator](value) for value, operator in zip(here, operators, strict=True)
            ):
                return index
        return None

    def _is_defined(self, values: Sequence[Any]) -> bool:
        """Return whether no denominator vanishes and every condition holds at a point."""
        if any(value is None for value in values):
            return False
        pairs = zip(values[self.places["conditions"]], self.conditions, strict=True)
        return all(_HOLDS[operator](value) for value, operator in pairs)

    def _checked(self, values: Sequence[Any]) -> list[str] | None:
        """Return the entries of a point as texts, None where a claim does not hold."""
        get = self.places
        K: Any = None
        L: Any = None
        A = numbers(self.n, self.n, values[get["A"]])
        B: Any = numbers(self.n, self.m, values[get["B"]]) if "B" in get else None
        C: Any = numbers(self.p, self.n, values[get["C"]]) if "C" in get else None
        found: list[str] = []
        for gain in self.gains:
            if gain == "K":
                K = numbers(self.m, self.n, values[get["K"]])
                closed = A - B * K
            else:
                L = numbers(self.n, self.p, values[get["L"]])
                closed = A - L * C
            if characteristic(closed) != polynomial(values[get[f"phi_{gain}"]]):
                return None
            found += map(str, values[get[gain]])
        if self.with_F:
            own = A - B * K - L * C
            if "D" in get and any(values[get["D"]]):
                own += L * numbers(self.p, self.m, values[get["D"]]) * K
            below = characteristic(own)  # det(sI − own + LK) = det(sI − own) (1 + K (sI − own)⁻¹ L)
            above, under = reduced_fraction(characteristic(own - L * K) - below, below)
            found += [*texts(above, self.n + 1), *texts(under, self.n + 1)]
        return found

    # -- a point alone -----------------------------------------------------------------------------------------------

    def alone(self, point: Sequence[Fraction], case: int | None) -> Row:
        """Return the row of a point that is solved by itself: its result has checked its own claims."""
        count = len(self.columns())
        try:
            result = self.solved_at(point)
        except (InputError, ZeroDivisionError):  # a denominator of the data vanishes there
            return Row("undefined", [None] * count, case)
        verdict = result.verdict
        status = {"no": "no", "undecided": "undecided"}.get(verdict, "done")
        if status != "done" or any(result.answer.get(gain) is None for gain in self.gains):
            return Row("no" if status == "done" else status, [None] * count, case)
        if any(symbols_in(result.answer[gain]) for gain in self.gains):
            return Row("undecided", [None] * count, case)  # other names are left in the answer
        found = [str(entry) for gain in self.gains for entry in result.answer[gain].entries]
        if self.with_F:
            F = result.answer["F"]
            below = F.denominator.coefficients(self.variable)
            above = [c / below[0] for c in F.numerator.coefficients(self.variable)]
            for part in (above, [entry / below[0] for entry in below]):
                found += [str(part[-1 - k] if k < len(part) else 0) for k in range(self.n + 1)]
        return Row("done", found, case)

    def solved_at(self, point: Sequence[Fraction]) -> Result:
        """Return the result at a point; raises `CertificateRejected` if the numbers were not put in as they are meant."""
        values = dict(zip(self.names, point, strict=True))
        problem = validate(with_values(self.tables, values))
        scalars = {name: Scalar.of(value) for name, value in values.items()}
        for name in "ABCD":
            general: Matrix = getattr(self.problem.plant.matrices, name)
            if substitute(general, scalars) != getattr(problem.plant.matrices, name):
                raise CertificateRejected(f"the plant of a point has another {name}", repair="please report this")
        (result,) = problem.solve()
        return result


def with_values(tables: Mapping[str, Any], values: Mapping[str, Any]) -> dict[str, Any]:
    """Return the tables of a problem with numbers in place of names, which are declared no more."""
    left = {name: sign for name, sign in tables.get("symbols", {}).items() if name not in values}
    data = {key: value for key, value in tables.items() if key not in {"symbols", "expect", "printed"}}
    for name in ("plant", "specification"):
        if name in data:
            data[name] = _put_in(data[name], values)
    return {**data, "symbols": left}


def names_used(tables: Mapping[str, Any]) -> set[str]:
    """Return the words of the texts of plant and specification."""
    return {
        word for name in ("plant", "specification") for text in _texts(tables.get(name)) for word in _NAME.findall(text)
    }


def _texts(value: Any) -> Iterator[str]:
    if isinstance(value, Mapping):
        value = list(value.values())
    if isinstance(value, list):
        for entry in value:
            yield from _texts(entry)
    elif isinstance(value, str):
        yield value


def _put_in(value: Any, values: Mapping[str, Any]) -> Any:
    """Return a value with numbers in place of names in its texts."""
    if isinstance(value, Mapping):
        return {key: _put_in(entry, values) for key, entry in value.items()}
    if isinstance(value, list):
        return [_put_in(entry, values) for entry in value]
    if type(value) is not str:  # a decimal of the file has no names
        return value
    return _NAME.sub(lambda word: f"({values[word[0]]})" if word[0] in values else word[0], value)
