"""What an answer with parameters says at a point: every branch that covers it, held to the answer of the plant there."""

from __future__ import annotations

import ast
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from typing import TYPE_CHECKING, Any

import mpmath
import sympy

from tests.support.algebra import Unreadable, evaluated, holds, is_stable, sides
from tests.support.problems.random_problems import rows

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from tests.support.algebra import Point
    from tests.support.problems.random_problems import Tables

#: Where functions of the variable are compared, and the time at which functions of time are.
_PLACES = (mpmath.mpf(13) / 10, mpmath.mpf(-37) / 10)
_TIME = mpmath.mpf(3) / 10
_NEAR = mpmath.mpf(10) ** -15
_FUNCTIONS = {name: getattr(mpmath, name) for name in ("sqrt", "exp", "sin", "cos", "sinh", "cosh")} | {"Abs": abs}


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
    if relation in {"True", "False"}:
        return "1"
    left, _, right = sides(relation)
    return left if right.strip() == "0" else f"({left})-({right})"


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
    point: Point
    said: Tables
    there: Tables

    @property
    def discrete(self) -> bool:
        return bool(self.problem["plant"].get("dt"))

    @property
    def variable(self) -> str:
        return "z" if self.discrete else "s"

    @cached_property
    def exact(self) -> dict[str, Any]:
        return {name: sympy.Rational(number.numerator, number.denominator) for name, number in self.point.items()}

    def value(self, text: object, **more: Any) -> Any:
        """Return the number that a text is here."""
        names = {name: mpmath.mpf(number.numerator) / number.denominator for name, number in self.point.items()}
        roots = {"CRootOf": self._root, "RootSum": self._root_sum}
        return evaluated(text, {"I": mpmath.j, "pi": mpmath.pi, **names, **more}, _FUNCTIONS | roots, mpmath.mpf)

    def rational(self, text: object) -> Any:
        """Return a rational function of one variable in SymPy."""
        tree = ast.walk(ast.parse(text, mode="eval") if isinstance(text, str) else text)  # type: ignore[arg-type]
        free = {node.id for node in tree if isinstance(node, ast.Name)} - self.point.keys()
        return evaluated(text, {**self.exact, **{name: sympy.Symbol(name) for name in free}}, number=sympy.Integer)

    def _root(self, polynomial: ast.expr, index: ast.expr) -> Any:
        return mpmath.mpmathify(sympy.CRootOf(self.rational(polynomial), int(evaluated(index, {}))).evalf(40))

    def _root_sum(self, polynomial: ast.expr, function: ast.Call) -> Any:
        name, inner = function.args
        roots = sympy.Poly(self.rational(polynomial)).nroots(n=40, maxsteps=500)
        return sum(self.value(inner, **{ast.unparse(name): mpmath.mpmathify(root)}) for root in roots)

    def same(self, *names: str) -> None:
        """Demand that integers and booleans are the same."""
        for name in names:
            if self.said.get(name) != self.there.get(name):
                raise Contradiction(f"{name} is {self.there.get(name)}, not {self.said.get(name)}")

    def same_values(self, *names: str) -> None:
        """Demand that numbers and functions are the same; what one of them does not hold is not compared."""
        for name in names:
            ours, theirs = (side.get(name) for side in (self.said, self.there))
            if ours is None or theirs is None:
                continue
            pairs = list(zip(_flat(ours), _flat(theirs), strict=False))
            if len(_flat(ours)) != len(_flat(theirs)) or not all(self._near(*pair) for pair in pairs):
                raise Contradiction(f"{name} is {theirs}, not {ours}")

    def _near(self, ours: str, theirs: str) -> bool:
        for s in _PLACES:
            try:
                there = self.value(theirs, **{"t": _TIME, self.variable: s})
            except ZeroDivisionError:
                continue
            if abs(self.value(ours, **{"t": _TIME, self.variable: s}) - there) > _NEAR * (1 + abs(there)):
                return False
        return True

    def same_roots(self, *names: str) -> None:
        """Demand that lists of roots are those of the same polynomial."""
        for name in names:
            ours, theirs = self.said.get(name), self.there.get(name)
            if ours is None or theirs is None:
                continue
            values = [
                [mpmath.fprod(s - self.value(root) for root in roots) for s in _PLACES] for roots in (ours, theirs)
            ]
            if len(ours) != len(theirs) or any(abs(a - b) > _NEAR * (1 + abs(b)) for a, b in zip(*values, strict=True)):
                raise Contradiction(f"{name} is {theirs}, not {ours}")

    def matrix(self, letter: str) -> Any:
        """Return a matrix of the plant, or else of the branch, in numbers."""
        plant = self.problem["plant"]
        table = rows(plant[letter]) if letter in plant else self.said[letter]
        return mpmath.matrix([[self.value(entry) for entry in row] for row in table])

    def assigns(self, matrix: Any) -> None:
        """Demand that a closed-loop matrix has the polynomial that the plant at the point is given."""
        for place in _PLACES:
            found = mpmath.det(place * mpmath.eye(matrix.rows) - matrix)
            asked = self.value(self.there["polynomial"], **{self.variable: place})
            if abs(found - asked) > _NEAR * (1 + abs(asked)):
                raise Contradiction("the closed loop has another polynomial than the one asked for")


def _flat(found: Any) -> list[str]:
    return [text for each in found for text in _flat(each)] if isinstance(found, list) else [str(found)]


def _rank_test(held: Held) -> None:
    held.same("rank")
    held.same_values("determinant")
    held.same_roots("unobservable_modes", "uncontrollable_modes")
    table, kernel = held.matrix("matrix"), held.said["kernel"]
    table = table if held.problem["task"] == "observability" else table.T
    vectors = [mpmath.matrix([held.value(entry) for entry in vector]) for vector in kernel]
    if len(kernel) != table.cols - held.there["rank"] or any(mpmath.norm(table * v) > 1e-9 for v in vectors):
        raise Contradiction("the kernel is another one")


def _modes(held: Held) -> None:
    held.same_values("fixed_polynomial")

    def told(side: Tables) -> list[tuple[Any, ...]]:
        flag = "observable" if "observable" in (side["modes"] or [{"observable": 0}])[0] else "controllable"
        found = []
        for mode in side["modes"]:
            number = mpmath.mpmathify(held.value(mode["eigenvalue"]))
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
    held.assigns(held.matrix("F"))


def _loop(held: Held) -> None:
    held.same_values("closed_loop_polynomial", "polynomial")
    if held.said.get("F") is None or isinstance(held.said["F"], list):
        return
    if "F_stable" in held.said:
        _stable_compensator(held)


def _stable_compensator(held: Held) -> None:
    """Demand that F is stable exactly where its poles in lowest terms are."""
    below = sympy.fraction(sympy.cancel(held.rational(held.said["F"])))[1]
    poles = sympy.Poly(below, sympy.Symbol(held.variable))
    stable = is_stable([Fraction(int(c.p), int(c.q)) for c in poles.all_coeffs()], discrete=held.discrete)
    if held.said["F_stable"] in {"yes", "no"} and (held.said["F_stable"] == "yes") != stable:
        raise Contradiction(f"F_stable is {held.said['F_stable']}, and the poles of F are the roots of {below}")


def _transfer(held: Held) -> None:
    held.same_values("transfer_function")
    held.same_roots("poles", "zeros")


def _canonical(held: Held) -> None:
    if held.problem["specification"]["kind"] != "modal":
        held.same_values("A", "B", "C", "D")


def _characteristic(held: Held) -> None:
    held.same_values("polynomial")
    held.same_roots("roots")


def _decomposition(held: Held) -> None:
    held.same("sizes", "minimal_order")
    held.same_values("transfer_function")


def _gramian(held: Held) -> None:
    held.same("rank")
    held.same_values("matrix", "determinant", "finite_sum")


def _regulation(held: Held) -> None:
    held.same("solvable")
    held.same_roots("blocked_modes", "fixed_modes")
    if held.said.get("K") is not None:
        held.assigns(held.matrix("A") - held.matrix("B") * held.matrix("K"))


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
    "matrix_exponential": lambda held: held.same_values("matrix"),
    "gramian": _gramian,
    "state_feedback": _gain,
    "observer": _gain,
    "reduced_order_observer": _reduced,
    "compensator": _loop,
    "feedforward": _loop,
    "tracking": lambda held: held.same("solvable"),
    "lyapunov": lambda held: held.same_values("P", "determinant"),
    "minimum_energy_input": lambda held: held.same_values("energy"),
    "output_regulation": _regulation,
    "lqr": lambda held: held.same_values("P", "K"),
    "kalman": lambda held: held.same_values("P", "L"),
}


def hold(problem: Tables, point: Point, branch: Branch, there: Tables) -> None:
    """Hold a branch to the answer of the plant at a point; raises `Contradiction`.

    A gain that is one of many may exist where the one chosen first leads to nothing: what follows from it is not compared.
    """
    if branch.verdict != there["verdict"]:
        raise Contradiction(f"the verdict is {there['verdict']}, not {branch.verdict}")
    try:
        with mpmath.workdps(50):  # type: ignore[no-untyped-call, unused-ignore]
            if problem["task"] in _HELD:
                _HELD[problem["task"]](Held(problem, point, branch.fields, there))
    except ZeroDivisionError as error:
        raise Contradiction(f"a field has no value: {error}") from error
    except Unreadable:
        return
