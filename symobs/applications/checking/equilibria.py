"""The verdict on a list of equilibria, and on what is said of the stability of each.

A point is right where it is one of those of the result, angles modulo 2π; where it is none f decides: a point at which f
is not 0 is wrong, and of one at which it is 0 it is said that it is one of many, or that it is undecided.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any, NamedTuple

from symobs.applications.checking.answers import exact, has_decimals
from symobs.applications.checking.points import Point, Reader
from symobs.applications.checking.wording import verdict_of
from symobs.exact import Scalar, TooLarge
from symobs.exact.core.generators import PI, NotWritten, functions_in
from symobs.formula.expression.source import shown
from symobs.ground.errors import InputError, NotShown
from symobs.problem.agreement import functions_agree
from symobs.problem.expect import conditions_agree, names_of
from symobs.system.motion import simplified, with_primes

if TYPE_CHECKING:
    from collections.abc import Mapping

    from symobs.problem.fields import Marking
    from symobs.tasks.result.in_convention import ResultInConvention

_TURN = 2 * Scalar.symbol(PI)


class PointsVerdict(NamedTuple):
    """The verdict on a list of points or on what is said of their stability, with the slip and the reason."""

    verdict: str
    slip: str = ""
    reason: str = ""


class Judge:
    """Holds points against those of a result; `order` are the numbers of the right ones for those of the student."""

    def __init__(self, view: ResultInConvention, marking: Marking) -> None:
        self.view, self.marking, self.reader = view, marking, Reader(view)
        self.result: Any = view.result
        self.signs = self.result.signs_at_rest
        self.read: list[Point] = []
        self.order: list[int | None] = []

    def points(self, given: Any) -> PointsVerdict:
        """Return the verdict on a list of points; raises `InputError` where it cannot be read."""
        best: tuple[PointsVerdict, list[Point], list[int | None]] | None = None
        for way in self.reader.read(given):
            found = self._of(way)
            if best is None or found.verdict == "right":
                best = (found, self.read, self.order)
        assert best is not None  # noqa: S101 - there is a reading, or an error
        found, self.read, self.order = best
        if (
            found.verdict == "wrong"
            and self.marking.decimals != "accept"
            and not self.reader.are_rounded
            and has_decimals(given)
        ):
            other = Judge(self.view, replace(self.marking, decimals="accept"))
            if other.points(given).verdict in {"right", "undecided"}:
                return PointsVerdict("wrong", "rounded", "the values are rounded, and exact ones are asked for")
        return found

    def _of(self, points: list[Point]) -> PointsVerdict:
        self.read, self.order = [], []
        undecided = ""
        for point in points:
            for values in self.reader.values_of(point, self.view, self.marking):
                self.read.append(point)
                try:
                    self.order.append(self._number_of(values))
                    why = self._why_not(point, values) if self.order[-1] is None else self._conditions(point)
                except (TooLarge, NotShown, NotWritten) as error:
                    undecided, why = (
                        f"whether {point} is an equilibrium is not decided: {error}",
                        PointsVerdict("right"),
                    )
                    self.order.append(None)
                except ZeroDivisionError:
                    why = PointsVerdict("wrong", "no_equilibrium", f"f is not defined at {point}")
                if why.verdict == "wrong":
                    return why
                undecided = undecided or (why.reason if why.verdict == "undecided" else "")
        left = len(self.reader.points) - len({number for number in self.order if number is not None})
        if undecided:
            return PointsVerdict("undecided", "", undecided)
        if left:
            said = "these are equilibria, " if self.read else ""
            said += f"but {left} of {len(self.reader.points)} {'is' if left == 1 else 'are'} missing"
            return PointsVerdict("wrong", "point_missing", said.removeprefix("but ") if not self.read else said)
        if not self.result.found.are_all:
            return PointsVerdict("undecided", "", "these are equilibria; whether they are all is not proved")
        return PointsVerdict("right")

    def _number_of(self, values: Mapping[str, Scalar]) -> int | None:
        """Return the number of the right point that has these values."""
        for number, right in enumerate(self.reader.points):
            if all(self._equal(values[name], right[name], name) for name in right):
                return number
        return None

    def _equal(self, mine: Scalar, right: Scalar, name: str) -> bool:
        if mine == right:
            return True
        if Scalar.symbol(name) in (mine, right):
            return False
        turns = (0, 1, -1, 2, -2) if self._is_angle(name) else (0,)
        return any(functions_agree(mine, right + _TURN * turn, self.signs) for turn in turns)

    def _is_angle(self, name: str) -> bool:
        """Return whether a state stands inside of cosines and sines alone, with a whole factor."""
        for entry in self.result.given.f.entries:
            if name in entry.names:
                return False
            for f in functions_in([entry]):
                if name in f.symbols:
                    is_wave = f.kind in {"cos", "sin"} and f.argument.degree(name) == 1
                    if (
                        not is_wave
                        or not (lead := f.argument.coefficients(name)[0]).is_constant
                        or lead.fraction().denominator != 1
                    ):
                        return False
        return True

    def _why_not(self, point: Point, values: Mapping[str, Scalar]) -> PointsVerdict:
        """Return why a point that is none of the right ones is wrong: f is not 0, or it is one of many."""
        known = {name: value for name, value in values.items() if value != Scalar.symbol(name)}
        rest = self.result.given.at_rest(known, is_discrete=self.result.plant.is_discrete)
        zero = Scalar.of(0)
        if self.reader.are_rounded and has_decimals([*point.values.values()]):
            return PointsVerdict("wrong", "no_equilibrium", f"{point} is no equilibrium to the digits given")
        if not all(functions_agree(simplified(entry), zero, self.signs) for entry in rest):
            return PointsVerdict("wrong", "no_equilibrium", f"{point} is no equilibrium: f is not 0 there")
        family = next((right for right in self.reader.points if self._is_member(values, right)), None)
        if family is not None:
            free = ", ".join(with_primes(name) for name, value in family.items() if value == Scalar.symbol(name))
            return PointsVerdict("wrong", "point_missing", f"{point} is one of many: {free} may have any value")
        return PointsVerdict("undecided", "", f"{point} is an equilibrium; which of those found it is is not decided")

    def _is_member(self, values: Mapping[str, Scalar], right: Mapping[str, Scalar]) -> bool:
        free = {name: values[name] for name, value in right.items() if value == Scalar.symbol(name)}
        return bool(free) and all(
            self._equal(values[n], v.substitute(free), n) for n, v in right.items() if n not in free
        )

    def _conditions(self, point: Point) -> PointsVerdict:
        """Return whether the conditions of a right point are those that it needs, where they are given."""
        number = self.order[-1]
        if not point.conditions or number is None:
            return PointsVerdict("right")
        wanted = self.result.fields["conditions"][number]
        if conditions_agree(
            wanted, [exact(each) for each in point.conditions], names_of(self.view), "points", self.signs
        ):
            return PointsVerdict("right")
        return PointsVerdict("wrong", "condition_wrong", f"{point}: it is an equilibrium, but under another condition")

    def stability(self, given: Any) -> PointsVerdict:
        """Return the verdict on what is said of the stability of each point, in the order of the student's points."""
        rights = self.result.fields["stable"]
        words = [given] if isinstance(given, str) and "," not in given else given
        words = words.split(",") if isinstance(words, str) else words
        if not isinstance(words, (list, tuple)):
            raise InputError("a word for each point is expected", where="stable", repair="write stable = yes, no")
        said = [verdict_of(str(word).strip(' []"'), "stable") for word in words]
        if None in said:
            strange = shown(str(words[said.index(None)]), 40)
            raise InputError(
                f'"{strange}" is no verdict', where="stable", repair="write yes, no or conditional for each point"
            )
        order = self.order if self.read else [*range(len(rights))]
        if len(said) != len(order):
            return PointsVerdict("wrong", "", f"{len(said)} verdicts for {len(order)} points")
        is_open = False
        for k, (word, number) in enumerate(zip(said, order, strict=True)):
            if number is None or word == rights[number]:
                continue
            if rights[number] == "undecided":
                is_open = True
                continue
            at = f" at {self.read[k]}" if self.read else f" at point {k + 1}"
            return PointsVerdict("wrong", "", f"the stability{at} is another")
        for point, number in zip(self.read, order, strict=False):
            if number is not None and point.stable_if and not self._same_stable_if(point, number):
                return PointsVerdict("wrong", "condition_wrong", f"the stability at {point} needs another condition")
        if is_open:
            return PointsVerdict("undecided", "", "whether the linearisation is stable is not decided")
        if left := len(rights) - len({*order} - {None}):
            reason = f"the stability of {left} of {len(rights)} equilibria is missing"
            return PointsVerdict("wrong", "point_missing", reason)
        return PointsVerdict("right")

    def _same_stable_if(self, point: Point, number: int) -> bool:
        wanted = self.result.fields["stable_if"][number]
        known = names_of(self.view)
        return conditions_agree(wanted, [exact(each) for each in point.stable_if], known, "stable", self.signs)

    @property
    def stability_said(self) -> list[str] | None:
        """What is said behind the points of their stability; None where it is not said of each."""
        words = [point.stable for point in self.read]
        return words if all(words) else None
