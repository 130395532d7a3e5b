"""An answer with its symbols replaced by numbers, so that numeric systems can judge what was found with parameters.

Half of the answers with cases are judged in one of these: a point of its stratum is drawn, one symbol solved for.
"""

from __future__ import annotations

from dataclasses import dataclass
from random import Random
from typing import TYPE_CHECKING, Any

import mpmath
import numpy as np

from tests.programs.campaign.asked import Asked, Untold, is_discrete, listed, rows
from tests.programs.campaign.numbers import (
    TINY,
    UnreadableError,
    array,
    from_roots,
    holds,
    polynomial,
    ratio,
    real,
    roots_of,
    sides,
    value,
    vector,
)

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from tests.programs.campaign.asked import Tables
    from tests.programs.campaign.numbers import Numbers, Ratio

_TRIES = 30
_SIZES = [real(p) / q for p in (1, 2, 3, 4, 5, 7) for q in (1, 2, 3)]


@dataclass(frozen=True)
class Case:
    """A problem and an answer without symbols: `answer` holds texts, `point` the values of the names in them."""

    asked: Asked
    answer: Tables
    point: Mapping[str, Any]

    @property
    def task(self) -> str:
        return self.asked.task

    @property
    def verdict(self) -> str:
        return str(self.answer["verdict"])

    @property
    def discrete(self) -> bool:
        return is_discrete(self.asked.problem)

    @property
    def variable(self) -> str:
        return "z" if self.discrete else "s"

    @property
    def specification(self) -> Tables:
        return self.asked.specification

    def plant(self, letter: str) -> Numbers:
        """Return a matrix of the plant; D is 0 where it is left out."""
        plant = self.asked.plant
        if letter == "D" and "D" not in plant:
            return np.zeros((len(rows(plant["C"])), len(rows(plant["B"])[0])), dtype=complex)
        return array(rows(plant[letter]), 0, self.point)

    def has(self, name: str) -> bool:
        return self.answer.get(name) is not None

    def matrix(self, name: str, columns: int = 0) -> Numbers:
        """Return a matrix of the answer."""
        return array(self.answer[name], columns, self.point)

    def number(self, text: object) -> Any:
        return value(text, self.point)

    def row(self, texts: Sequence[object]) -> Numbers:
        """Return a list of the answer."""
        return vector([value(text, self.point) for text in texts])

    def polynomial(self, text: object) -> Numbers:
        """Return the coefficients of a polynomial in s or z."""
        return vector(polynomial(text, self.point, self.variable))

    def polynomial_of(self, roots: Sequence[object]) -> Numbers:
        """Return the coefficients of the monic polynomial with these roots."""
        return vector(from_roots([value(root, self.point) for root in roots]))

    def ratio(self, text: object) -> Ratio:
        return ratio(text, self.point, self.variable)

    def values(self, text: Any, places: Sequence[complex]) -> Numbers:
        """Return a matrix of transfer functions at some places, one below the other."""
        table = text if isinstance(text, list) else [[text]]
        entries = [[self.ratio(entry) for entry in row] for row in table]
        return np.array([[complex(entry.at(s)) for entry in row] for s in places for row in entries])

    def desired(self, prefix: str = "") -> Numbers:
        """Return the desired polynomial, from the specification alone."""
        asked = self.specification
        if f"{prefix}polynomial" in asked:
            text = str(asked[f"{prefix}polynomial"]).replace("^", "**")
            return vector(polynomial(text, self.point, self.variable, monic=True))
        poles = asked.get(f"{prefix}poles") or ""
        return self.polynomial_of(listed(poles) if poles else [])


def at_a_point(asked: Asked) -> Case | Untold:
    """Return the answer at a point that its own seed draws."""
    random = Random(f"point of {asked.seed}")  # noqa: S311 - test points, no secrets
    signs = {name: _sign(given) for name, given in asked.problem.get("symbols", {}).items()}
    if not signs:
        return Case(asked, asked.answer, {})
    cases = [case for case in _flat(asked.answer) if case.get("verdict") not in {None, "undecided"}]
    for _ in range(_TRIES):
        chosen = random.choice(cases) if cases and random.random() < 0.5 else None
        try:
            point = _point(random, signs, chosen["when"] if chosen else ())
            if point is None or not _defined(asked, point):
                continue
            answer = {**asked.answer, **(chosen or {"verdict": _generic(asked.answer)})}
            conditions = answer.get("conditions", ()) if chosen is None else chosen.get("conditions", ())
            met = all(holds(relation, point) for relation in conditions)
            others = (
                case["when"]
                for case in _flat(asked.answer)
                if chosen is None or not {*case["when"]} <= {*chosen["when"]}
            )
            if met and not any(all(holds(relation, point) for relation in when) for when in others):
                return Case(asked, answer, point)
        except ZeroDivisionError:
            continue
        except UnreadableError as error:
            return Untold(f"not read: {error}")
    return Untold("no point was found where the answer holds")


def _flat(answer: Tables) -> list[Tables]:
    """Return all cases, those within cases with everything that leads there."""
    found = []
    for case in answer.get("cases", ()):
        found.append(case)
        found += [{**case, **inner, "when": [*case["when"], *inner["when"]]} for inner in _flat(case)]
    return found


def _sign(given: Any) -> str:
    return str(given["sign"] if isinstance(given, dict) else given)


def _generic(answer: Tables) -> str:
    """A design is possible wherever its conditions hold."""
    return "yes" if answer["verdict"] == "conditional" else str(answer["verdict"])


def _defined(asked: Asked, point: Mapping[str, Any]) -> bool:
    """Tell whether the plant and the desired polynomial exist there; raises ZeroDivisionError where they do not."""
    for text in asked.plant.values():
        if isinstance(text, str):
            array(rows(text), 0, point)
    return True


def _number(random: Random, sign: str) -> Any:
    size = random.choice(_SIZES)
    if sign in {"positive", "nonnegative"}:
        return size
    if sign in {"negative", "nonpositive"}:
        return -size
    return random.choice([-size, size])


def allowed(sign: str, number: Any) -> bool:
    """Tell whether a real number has a declared sign."""
    fits = {
        "positive": number > TINY,
        "negative": number < -TINY,
        "nonnegative": number > -TINY,
        "nonpositive": number < TINY,
        "nonzero": abs(number) > TINY,
    }
    return bool(fits.get(sign, True))


def _point(random: Random, signs: Mapping[str, str], when: Sequence[str]) -> dict[str, Any] | None:
    """Draw a value for each symbol; one of each equation is solved for."""
    point = {name: _number(random, sign) for name, sign in signs.items()}
    equations = [relation for relation in when if sides(relation)[1] == "=="]
    names = list(signs)
    random.shuffle(names)
    for relation in equations:
        left, _, right = sides(relation)
        for name in names:
            found = ratio(f"({left}) - ({right})", {k: v for k, v in point.items() if k != name}, name)
            roots = [root.real for root in roots_of(found.over) if abs(root.imag) < TINY]
            fitting = [root for root in roots if allowed(signs[name], root)]
            if fitting:
                point[name] = random.choice(fitting)
                break
        else:
            return None
    return point if all(holds(relation, point) for relation in when) else None


def shown(point: Mapping[str, Any]) -> str:
    """Return a point in short."""
    return ", ".join(f"{name} = {mpmath.nstr(number, 12)}" for name, number in point.items())
