"""What an answer with parameters says at a point: every branch that covers it, held to the answer of the plant there."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import mpmath

from tests.programs.campaign.asked import is_discrete, rows
from tests.programs.campaign.branch import CROOT
from tests.programs.campaign.numbers import (
    TINY,
    Ratio,
    UnreadableError,
    array,
    from_roots,
    polynomial,
    ratio,
    real,
    roots_of,
    value,
)
from tests.programs.campaign.points import NotRational, holds

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from tests.programs.campaign.asked import Tables
    from tests.programs.strata_oracle.points import Point

#: Where functions of the variable are compared, and the time at which functions of time are.
_PLACES = (mpmath.mpf(13) / 10, mpmath.mpf(-37) / 10)
_TIME = mpmath.mpf(3) / 10
_NEAR = mpmath.mpf(10) ** -15


@dataclass(frozen=True)
class Branch:
    """The fields that an answer has on one branch, its verdict at the point, and the relations that lead there."""

    fields: Tables
    verdict: str
    when: tuple[str, ...]


class Contradiction(Exception):
    """An answer says something of a point that is not so."""


def relations(answer: Tables) -> Iterator[str]:
    """Yield every polynomial that stands in a condition or a case."""
    for text in answer.get("conditions", []):
        yield _side(text)
    for case in answer.get("cases", []):
        yield from map(_side, case["when"])
        yield from relations(case)


def _side(relation: str) -> str:
    for sign in ("!=", "==", ">=", "<=", ">", "<"):
        if sign in relation:
            left, right = relation.split(sign)
            return left if right.strip() == "0" else f"({left})-({right})"
    return relation


def branches(answer: Tables, point: Point, when: tuple[str, ...] = ()) -> list[Branch] | None:
    """Return the branches that cover a point, the verdict being that of the point; None where there is no plant.

    Raises `Contradiction` where a relation has no value at the point.
    """
    try:
        stated = [
            (kind, text, holds(text, point))
            for kind, text in zip(answer.get("condition_kinds", []), answer.get("conditions", []), strict=True)
        ]
        inside = [c for c in answer.get("cases", []) if all(holds(text, point) for text in c["when"])]
    except ZeroDivisionError as error:
        raise Contradiction("a relation of the answer is a fraction without a value here") from error
    if any(kind == "domain" and not true for kind, _, true in stated):
        return None
    found: list[Branch] = []
    for case in inside:
        inherited = {**answer, "cases": [], "conditions": [], "condition_kinds": [], **case}
        found += branches(inherited, point, (*when, *case["when"])) or []
    if found:
        return found
    broken = [(kind, text) for kind, text, true in stated if not true]
    verdict = str(answer["verdict"])
    if verdict == "undecided" or (not broken and verdict != "conditional"):
        return [Branch(answer, verdict, when)]
    if not broken:
        return [Branch(answer, "yes", when)]
    if all(kind == "existence" and "!=" not in text for kind, text in broken):
        return [Branch(answer, "no", when)]
    return []


# -- one branch against the plant at the point ---------------------------------------------------------------------------


@dataclass(frozen=True)
class Held:
    """A branch at a point, and the answer of the plant there."""

    problem: Tables
    point: dict[str, Any]
    said: Tables
    there: Tables

    @property
    def variable(self) -> str:
        return "z" if is_discrete(self.problem) else "s"

    def same(self, *names: str) -> None:
        """Demand that integers and booleans are the same."""
        for name in names:
            if self.said.get(name) != self.there.get(name):
                raise Contradiction(f"{name} is {self.there.get(name)}, not {self.said.get(name)}")

    def same_matrices(self, *names: str) -> None:
        """Demand that numbers are the same; what one of them does not hold is not compared."""
        for name in names:
            ours, theirs = (side.get(name) for side in (self.said, self.there))
            if ours is None or theirs is None:
                continue
            pairs = zip(_flat(ours), _flat(theirs), strict=False)
            if len(_flat(ours)) != len(_flat(theirs)) or any(not self._near(a, b) for a, b in pairs):
                raise Contradiction(f"{name} is {theirs}, not {ours}")

    def _near(self, ours: str, theirs: str) -> bool:
        place = {**self.point, "t": _TIME}
        for s in _PLACES:
            try:
                there = value(theirs, {**place, self.variable: s})
            except ZeroDivisionError:
                continue
            if abs(value(ours, {**place, self.variable: s}) - there) > _NEAR * (1 + abs(there)):
                return False
        return True

    def same_roots(self, *names: str) -> None:
        """Demand that lists of roots are those of the same polynomial."""
        for name in names:
            ours, theirs = self.said.get(name), self.there.get(name)
            if ours is not None and theirs is not None:
                self._same_coefficients(name, self._from_roots(ours), self._from_roots(theirs))

    def _from_roots(self, texts: list[str]) -> list[Any]:
        """Return the polynomial of roots; roots without a closed form come in whole sets, whose product it is."""
        whole = Counter(match.group(1) for text in texts if (match := CROOT.fullmatch(text)))
        found = from_roots([value(text, self.point) for text in texts if not CROOT.fullmatch(text)])
        for text, count in whole.items():
            once = polynomial(text, self.point, self.variable, monic=True)
            for _ in range(count // (len(once) - 1)):
                found = product(found, once)
        return found

    def same_polynomials(self, *names: str) -> None:
        """Demand that polynomials are the same."""
        for name in names:
            if self.said.get(name) is not None and self.there.get(name) is not None:
                ours, theirs = (polynomial(side[name], self.point, self.variable) for side in (self.said, self.there))
                self._same_coefficients(name, ours, theirs)

    def _same_coefficients(self, name: str, ours: list[Any], theirs: list[Any]) -> None:
        same = len(ours) == len(theirs) and all(
            abs(a - b) <= _NEAR * (1 + abs(b)) for a, b in zip(ours, theirs, strict=True)
        )
        if not same:
            raise Contradiction(f"{name} is {self.there[name]}, not {self.said[name]}")

    def matrix(self, letter: str) -> Any:
        """Return a matrix of the plant, or else of the branch, in numbers."""
        plant = self.problem["plant"]
        table = rows(plant[letter]) if letter in plant else self.said[letter]
        return mpmath.matrix([[value(entry, self.point) for entry in row] for row in table])

    def assigns(self, matrix: Any) -> None:
        """Demand that a closed-loop matrix has the polynomial that the plant at the point is given."""
        wanted = polynomial(self.there["polynomial"], {}, self.variable)
        for place in _PLACES:
            found = mpmath.det(place * mpmath.eye(matrix.rows) - matrix)
            asked = mpmath.polyval(wanted, place)
            if abs(found - asked) > _NEAR * (1 + abs(asked)):
                raise Contradiction("the closed loop has another polynomial than the one asked for")


def product(left: list[Any], right: list[Any]) -> list[Any]:
    """Return the coefficients of a product of polynomials."""
    return (Ratio(left) * Ratio(right)).over


def _flat(value_: Any) -> list[str]:
    return [text for each in value_ for text in _flat(each)] if isinstance(value_, list) else [str(value_)]


def _rank_test(held: Held) -> None:
    held.same("rank")
    held.same_polynomials("determinant")
    held.same_roots("unobservable_modes", "uncontrollable_modes")
    table = array(held.said["matrix"], 0, held.point)
    table = table if held.problem["task"] == "observability" else table.T
    kernel = array(held.said["kernel"], table.shape[1], held.point)
    if len(kernel) != table.shape[1] - held.there["rank"] or abs(table @ kernel.T).max(initial=0) > 1e-9:
        raise Contradiction("the kernel is another one")


def _modes(held: Held) -> None:
    held.same_polynomials("fixed_polynomial")

    def told(side: Tables) -> list[tuple[Any, ...]]:
        flag = "observable" if "observable" in (side["modes"] or [{"observable": 0}])[0] else "controllable"
        found = []
        for mode in side["modes"]:
            number = mpmath.mpmathify(value(mode["eigenvalue"], held.point))
            place = (round(float(number.real), 8) + 0.0, round(float(number.imag), 8) + 0.0)
            found.append((place, mode[flag], mode.get("rank"), mode["stable"]))
        return sorted(found, key=str)

    ours, theirs = told(held.said), told(held.there)
    if len(ours) != len(theirs):
        raise Contradiction(f"the modes are {theirs}, not {ours}")
    for mode, there in zip(ours, theirs, strict=True):
        if mode[:3] != there[:3] or (isinstance(mode[3], bool) and isinstance(there[3], bool) and mode[3] != there[3]):
            raise Contradiction(f"the modes are {theirs}, not {ours}")


def _gain(held: Held) -> None:
    letter = "K" if held.problem["task"] == "state_feedback" else "L"
    held.same_roots("fixed_modes")
    if held.said.get(letter) is None:
        return
    gain = held.matrix(letter)
    taken = held.matrix("B") * gain if letter == "K" else gain * held.matrix("C")
    held.assigns(held.matrix("A") - taken)
    if {held.said["stable"], held.there["stable"]} == {"yes", "no"}:
        raise Contradiction(f"stable is {held.there['stable']}")


def _reduced(held: Held) -> None:
    held.same_roots("fixed_modes")
    if held.said.get("L") is None:
        return
    held.assigns(mpmath.matrix([[value(entry, held.point) for entry in row] for row in held.said["F"]]))


def _loop(held: Held) -> None:
    held.same_polynomials("closed_loop_polynomial", "polynomial")
    if held.said.get("F") is None or isinstance(held.said["F"], list):
        return
    if "F_stable" in held.said:
        _stable_compensator(held)


def _stable_compensator(held: Held) -> None:
    """Demand that F is stable exactly where its poles in lowest terms are, if they are not on the boundary."""
    said = held.said["F_stable"]
    said = said if isinstance(said, str) else said.get("verdict")
    found = ratio(held.said["F"], held.point, held.variable)
    poles = _lowest_poles(found.over, found.under)
    outside = [1 - abs(p) if held.variable == "z" else -p.real for p in poles]
    if any(abs(bar) < _NEAR for bar in outside) or said not in {"yes", "no"}:
        return
    if (said == "yes") != all(bar > 0 for bar in outside):
        raise Contradiction(f"F_stable is {said}, and the poles of F are {[mpmath.nstr(p, 5) for p in poles]}")


def _lowest_poles(above: list[Any], below: list[Any]) -> list[Any]:
    zeros, poles = list(roots_of(above)), list(roots_of(below))
    if not any(abs(c) > TINY for c in above):
        return []
    for zero in zeros:
        near = min(poles, key=lambda pole: abs(pole - zero), default=None)
        if near is not None and abs(near - zero) < real(10) ** -8:
            poles.remove(near)
    return poles


def _transfer(held: Held) -> None:
    held.same_matrices("transfer_function")
    held.same_roots("poles", "zeros")


def _canonical(held: Held) -> None:
    if held.problem["specification"]["kind"] != "modal":
        held.same_matrices("A", "B", "C", "D")


def _nothing(_held: Held) -> None:
    """Hold the verdict alone."""


def _characteristic(held: Held) -> None:
    held.same_polynomials("polynomial")
    held.same_roots("roots")


def _decomposition(held: Held) -> None:
    held.same("sizes", "minimal_order")
    held.same_matrices("transfer_function")


def _gramian(held: Held) -> None:
    held.same("rank")
    held.same_matrices("matrix", "determinant", "finite_sum")


_HELD: dict[str, Callable[[Held], None]] = {
    "observability": _rank_test,
    "controllability": _rank_test,
    "detectability": _modes,
    "stabilizability": _modes,
    "pbh": _modes,
    "characteristic_polynomial": _characteristic,
    "transfer_function": _transfer,
    "canonical_form": _canonical,
    "dual": lambda held: held.same(
        "observability_rank", "controllability_rank", "dual_observability_rank", "dual_controllability_rank"
    ),
    "decomposition": _decomposition,
    "matrix_exponential": lambda held: held.same_matrices("matrix"),
    "gramian": _gramian,
    "state_feedback": _gain,
    "observer": _gain,
    "reduced_order_observer": _reduced,
    "compensator": _loop,
    "feedforward": _loop,
    "tracking": lambda held: held.same("solvable"),
}


def hold(problem: Tables, point: Point, branch: Branch, there: Tables) -> None:
    """Hold a branch to the answer of the plant at a point; raises `Contradiction`.

    A gain that is one of many may exist where the one chosen first leads to nothing: what follows from it is not compared.
    """
    if branch.verdict != there["verdict"]:
        raise Contradiction(f"the verdict is {there['verdict']}, not {branch.verdict}")
    numbers = {name: real(number.numerator) / number.denominator for name, number in point.items()}
    try:
        _HELD.get(problem["task"], _nothing)(Held(problem, numbers, branch.fields, there))
    except ZeroDivisionError as error:
        raise Contradiction(f"a field has no value: {error}") from error
    except (UnreadableError, NotRational):
        return
