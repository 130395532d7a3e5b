"""The picture of equilibria over a parameter: the curves of books, exact branch points, and a check that sees each lie."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from math import acos, pi, sqrt
from typing import TYPE_CHECKING, Any

import pytest

from symobs.exact import Scalar
from symobs.formula.figures import BranchPicture
from symobs.problem import read
from symobs.proof.derivation.plot_check import faults_of_branches

if TYPE_CHECKING:
    from collections.abc import Callable

    from symobs.formula.figures import Branch

HEAD = 'task = "equilibria"\n[plant]\n'
SADDLE_NODE = f'{HEAD}states = "x"\nf = "[r + x^2]"\n[symbols]\nr = "real"\n'
PITCHFORK = f'{HEAD}states = "x, v"\nf = "[v; r*x - x^3 - v]"\n[symbols]\nr = "real"\n'
TRANSCRITICAL = f'{HEAD}states = "x"\nf = "[r*x - x^2]"\n[symbols]\nr = "real"\n'
HOOP = f"""{HEAD}states = "theta, v"
f = "[v; omega^2*sin(theta)*cos(theta) - 50*sin(theta) - v]"
[symbols]
omega = "positive"
"""


def drawn(text: str) -> tuple[BranchPicture, object]:
    """The picture of a problem, and f."""
    (result,) = read(text, "problem").solve()
    assert isinstance(result.picture, BranchPicture)
    return result.picture, result.given.f


ZERO = (lambda _: 0.0, True), (lambda _: 0.0, False)
BOOK = {
    SADDLE_NODE: (0.0, [(lambda r: sqrt(-r), False), (lambda r: -sqrt(-r), True)]),
    PITCHFORK: (0.0, [*ZERO, (sqrt, True), (lambda r: -sqrt(r), True)]),
    TRANSCRITICAL: (0.0, [*ZERO, (lambda r: r, False), (lambda r: r, True)]),
    HOOP: (
        sqrt(50),
        [
            *ZERO,
            (lambda _: pi, False),
            (lambda _: pi, False),
            (lambda w: acos(50 / w**2), True),
            (lambda w: -acos(50 / w**2), True),
        ],
    ),
}


@pytest.mark.parametrize("text", BOOK)
def test_branches_are_those_of_the_book(text: str) -> None:
    picture, f = drawn(text)
    at, curves = BOOK[text]
    assert not [*faults_of_branches(picture, f)]
    assert [(round(float(value), 6), round(float(y), 2)) for (value, y), _ in picture.marks] == [(round(at, 6), 0.0)]
    left = list(curves)
    for branch in picture.branches:
        left.remove(next(curve for curve in left if _is_along(branch, *curve)))
    assert not left


def _is_along(branch: Branch, curve: Callable[[float], float], stable: bool) -> bool:  # noqa: FBT001
    if stable != branch.stable:
        return False
    try:
        return all(abs(curve(float(x)) - float(y)) < 1e-6 for x, y in branch.points)
    except ValueError:
        return False


def _first(picture: BranchPicture, **changes: Any) -> BranchPicture:
    return replace(picture, branches=(replace(picture.branches[0], **changes), *picture.branches[1:]))


LIES: dict[str, Callable[[BranchPicture], BranchPicture]] = {
    "a branch has the other stability": lambda p: _first(p, stable=not p.branches[0].stable),
    "a point lies beside its branch": lambda p: _first(
        p, points=((p.branches[0].points[0][0], Fraction(1, 3)), *p.branches[0].points[1:])
    ),
    "a branch is no equilibrium": lambda p: _first(
        p,
        at=tuple((name, value + Scalar.of(Fraction(1, 3))) for name, value in p.branches[0].at),
        points=tuple((x, y + Fraction(1, 3)) for x, y in p.branches[0].points),
    ),
    "a branch point is elsewhere": lambda p: replace(p, marks=((p.marks[0][0], Scalar.of(1)),)),
    "too few points are a branch": lambda p: _first(p, points=p.branches[0].points[:3]),
}


@pytest.mark.parametrize("lie", LIES)
def test_each_lie_is_seen(lie: str) -> None:
    picture, f = drawn(PITCHFORK)
    assert [*faults_of_branches(LIES[lie](picture), f)]


@pytest.mark.parametrize(
    "text",
    [
        f'{HEAD}states = "x"\nf = "[a + b*x]"\n[symbols]\na = "real"\nb = "positive"\n',
        f'{HEAD}states = "x"\nf = "[2 - x]"\n',
        f'{HEAD}states = "x"\nf = "[r - x]"\n[symbols]\nr = "real"\n',
    ],
)
def test_there_is_no_picture_without_one_parameter_or_a_change(text: str) -> None:
    (result,) = read(text, "problem").solve()
    assert result.picture is None
