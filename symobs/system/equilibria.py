"""The equilibria of ẋ = f(x, u): all solutions of f = 0, with their conditions.

Where no step of the search is left a branch is open: the points that were found are equilibria, and whether there are more
is not said.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from symobs.exact import Scalar
from symobs.exact.algebraic.isolation import digits_on, sign_on
from symobs.exact.core.generators import NotWritten, functions_in, normal_form
from symobs.ground.dataclass import dataclass
from symobs.system.conditions import Condition
from symobs.system.equilibrium_search import Branch, Search, turned_back

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping, Sequence

    from symobs.system.equilibrium_search import Enclosure


@dataclass
class Equilibrium:
    """A solution: the value of each unknown, its own name where it is free, and the conditions on the parameters."""

    values: Mapping[str, Scalar]
    conditions: tuple[Condition, ...]
    #: Where one unknown is known by numbers alone: the others are functions of it.
    within: Enclosure | None = None

    @property
    def free(self) -> tuple[str, ...]:
        """The unknowns that the equations leave free."""
        own = "" if self.within is None else self.within.name
        return tuple(name for name, value in self.values.items() if value == Scalar.symbol(name) and name != own)

    def digits(self, name: str, count: int = 12) -> str:
        """Return as many digits of a value as are certain, at most so many, where it is known by numbers."""
        assert self.within is not None  # noqa: S101 - the caller has looked
        return digits_on(self.values[name], self.within.name, self.within.interval, count)


@dataclass
class Equilibria:
    """The solutions that were found, and what is left open: nothing where they are all there are."""

    points: tuple[Equilibrium, ...]
    open_equations: tuple[Scalar, ...]

    @property
    def are_all(self) -> bool:
        """Whether every equilibrium is among the points."""
        return not self.open_equations


def equilibria(equations: Iterable[Scalar], unknowns: Sequence[str], signs: Mapping[str, str]) -> Equilibria:
    """Return the real solutions of equations = 0 for the unknowns; their own signs choose among them."""
    search = Search(unknowns, signs)
    points: list[Equilibrium] = []
    equations = tuple(equations)
    inside = [Condition("domain", f.argument, _DEFINED[f.kind]) for f in functions_in(equations) if f.kind in _DEFINED]
    start = Branch(equations, {}, tuple(inside))
    for branch in search.solutions(start):
        values = {name: branch.values.get(name, Scalar.symbol(name)) for name in unknowns}
        wanted = [
            Condition("claim", value * (-1 if signs[name].startswith(("neg", "nonpos")) else 1), _WANTED[signs[name]])
            for name, value in values.items()
            if signs.get(name, "real") != "real" and value != Scalar.symbol(name)
        ]
        if branch.within is not None:
            name, interval = branch.within.name, branch.within.interval
            if all(sign_on(each.expression, name, interval) > 0 for each in wanted):
                points.append(Equilibrium(values, (), branch.within))
            elif not any(sign_on(each.expression, name, interval) < 0 for each in wanted):
                search.open.append(branch.within.equation)
            continue
        cleared = search.cleared(replace(branch, conditions=(*branch.conditions, *wanted)))
        if cleared is None:
            continue
        values = {name: turned_back(normal_form(search.simplified(value))) for name, value in values.items()}
        point = Equilibrium(values, cleared.conditions)
        points.append(point)
    kept = [
        p for k, p in enumerate(points) if not any(_covers(q, p) for q in (*points[:k], *_freer(points[k + 1 :], p)))
    ]
    return Equilibria(tuple(kept), tuple(dict.fromkeys(search.open)))


def _freer(points: Iterable[Equilibrium], than: Equilibrium) -> Iterator[Equilibrium]:
    return (point for point in points if len(point.free) > len(than.free))


def _covers(family: Equilibrium, point: Equilibrium) -> bool:
    """Return whether a point is a member of a family: its values where the free ones are those of the point."""
    if family.within is not None or point.within is not None:
        return False
    if len(family.free) < len(point.free) or not {*family.conditions} <= {*point.conditions}:
        return False
    free = {name: point.values[name] for name in family.free}
    try:
        return all(value.substitute(free) == point.values[name] for name, value in family.values.items())
    except (ZeroDivisionError, NotWritten):
        return False


#: Where a function is defined: its argument is > 0 or ≥ 0.
_DEFINED = {"sqrt": ">=", "log": ">"}
_WANTED = {"positive": ">", "negative": ">", "nonnegative": ">=", "nonpositive": ">=", "nonzero": "!="}


def real_where(values: Iterable[Scalar], signs: Mapping[str, str]) -> tuple[Scalar, ...]:
    """Return what must be positive for values with roots, logarithms and inverse functions to be real."""
    search, found = Search((), signs), []
    for f in sorted(functions_in(values), key=lambda f: f.text):
        if f.kind in {"sqrt", "log"}:
            found.append(f.argument)
        elif f.kind in {"asin", "acos"}:
            found += [1 - f.argument, 1 + f.argument]
    branch = search.cleared(Branch((), {}, tuple(Condition("domain", value, ">") for value in found)))
    return () if branch is None else tuple(condition.expression for condition in branch.conditions)
