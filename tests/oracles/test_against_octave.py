"""Observers and compensators against Octave's control package: its `acker`, `ss`, `tf` and `feedback`.

Octave is given the plant and the poles alone, and makes the gains, the coordinates and the loops itself.  With one
output, or one input, the gain is unique and every number of it has to agree.
"""

from __future__ import annotations

import random
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
import sympy

import symobs
from tests.kit import tables
from tests.support.tools import octave

if TYPE_CHECKING:
    from collections.abc import Callable

    from tests.support.tools.octave import Numbers, Reply

pytestmark = pytest.mark.slow

#: The plants of the sources, with poles for feedback and observer; the minimal order takes as many as it needs.
PLANTS: dict[str, tuple[list[str], str, str]] = tables(Path(__file__))["plants"]

_PLANT = "A = {A}; B = {B}; C = {C}; D = {D}; pc = [{control}]; po = [{observer}]; n = rows(A); p = rows(C);"

_FULL = """
K = acker(A, B, pc); L = acker(A', C', po)';
E = ss(A - B*K - L*C + L*D*K, L, K, zeros(1, 1));
"""

#: Unit rows of the columns of C without a pivot, then the observer of the states that are not measured.
_MINIMAL = """
[~, pivots] = rref(C); R = eye(n)(setdiff(1:n, pivots), :); T = [C; R];
At = T*A/T; Bt = T*B; m = 1:p; r = p+1:n;
K = acker(A, B, pc); L = acker(At(r, r)', At(m, r)', po)';
F = At(r, r) - L*At(m, r); H = At(r, m) - L*At(m, m) + F*L; G = Bt(r, :) - L*Bt(m, :) - H*D;
M = T \\ [eye(p), zeros(p, n-p); L, eye(n-p)];
N1 = K*M(:, m); N2 = K*M(:, r); W = inv(1 - N1*D);
E = ss(F - G*W*N2, H - G*W*N1, W*N2, W*N1);
say("T", T); say("F", F); say("G", G); say("H", H); say("M", M);
"""

#: The same for both: the compensator −E in the return path of the plant.
_LOOP = """
say("K", K); say("L", L);
[num, den] = tfdata(tf(E), "v"); say("num", num); say("den", den);
say("loop", poly(pole(feedback(ss(A, B, C, D), E))));
"""


def drawn(generator: random.Random) -> tuple[list[str], str, str]:
    """Draw a plant that is far from uncontrollable and unobservable, for its gains are to be small, and its poles."""
    while True:
        order = generator.randint(2, 4)
        sizes = ((order, order), (order, 1), (1, order))
        parts = [[[generator.randint(-3, 3) for _ in range(columns)] for _ in range(rows)] for rows, columns in sizes]
        A, B, C = map(sympy.Matrix, parts)
        if all(
            abs(sympy.Matrix.hstack(*[X**k * Y for k in range(order)]).det()) > order**2
            for X, Y in ((A, B), (A.T, C.T))
        ):
            texts = ["; ".join(" ".join(map(str, row)) for row in part) for part in parts]
            control = ", ".join(map(str, generator.sample(range(-6, 0), order)))
            observer = ", ".join(map(str, generator.sample(range(-9, 0), order)))
            return [f"[{text}]" for text in (*texts, generator.choice(["0", "1/50"]))], control, observer


GENERATOR = random.Random(4)  # noqa: S311 - test problems, no secrets
CASES = {**PLANTS, **{f"drawn {k}": drawn(GENERATOR) for k in range(20)}}
ARRANGED = [(name, kind) for name in CASES for kind in ("full", "minimal")]


def poles_of(name: str, kind: str) -> tuple[str, str]:
    _, control, observer = CASES[name]
    kept = observer.split(", ")
    return control, ", ".join(kept[: len(kept) - (kind == "minimal")])


def question(name: str, kind: str) -> str:
    control, observer = poles_of(name, kind)
    plant = _PLANT.format(**dict(zip("ABCD", CASES[name][0], strict=True)), control=control, observer=observer)
    return plant + (_FULL if kind == "full" else _MINIMAL) + _LOOP


@pytest.fixture(name="replies", scope="module")
def all_replies(require_tool: Callable[[str], str]) -> dict[tuple[str, str], Reply]:
    require_tool(octave.COMMAND)
    replies = octave.ask([question(*arranged) for arranged in ARRANGED])
    return dict(zip(ARRANGED, replies, strict=True))


def numbers(values: Any) -> Numbers:
    table = sympy.Matrix(values)
    return np.array(table.evalf(20).tolist(), dtype=complex).reshape(table.shape)


def coefficients(expression: Any) -> Numbers:
    return np.array([complex(c) for c in sympy.Poly(expression, sympy.Symbol("s")).all_coeffs()])


def close(ours: Numbers, theirs: Numbers, within: float = 1e-6) -> bool:
    return ours.shape == theirs.shape and bool(np.all(np.abs(ours - theirs) <= within * np.max(np.abs(theirs))))


@pytest.mark.parametrize(("name", "kind"), ARRANGED)
def test_a_compensator_is_the_one_octave_builds(name: str, kind: str, replies: dict[Any, Reply]) -> None:
    theirs = replies[name, kind]
    assert isinstance(theirs, dict), theirs
    control, observer = poles_of(name, kind)
    plant = symobs.StateSpace(*CASES[name][0])
    found = symobs.compensator(plant, control_poles=control, observer_poles=observer, observer=kind)
    assert close(numbers(found.K), theirs["K"])
    assert close(numbers(found.L), theirs["L"])
    over, under = sympy.fraction(sympy.cancel(found.F))
    num, den = coefficients(over), coefficients(under)
    assert close(num / den[0], trimmed(theirs["num"] / theirs["den"][0, 0], len(num)))
    assert close(den / den[0], theirs["den"][0] / theirs["den"][0, 0])
    assert close(coefficients(found.closed_loop_polynomial), theirs["loop"][0])


def trimmed(row: Numbers, length: int) -> Numbers:
    """Return the last coefficients; those before are 0 but for rounding."""
    first, last = row[0, : row.size - length], row[0, row.size - length :]
    assert np.all(np.abs(first) <= 1e-9 * np.max(np.abs(last)))
    return last


@pytest.mark.parametrize("name", CASES)
def test_a_reduced_order_observer_is_the_one_octave_builds(name: str, replies: dict[Any, Reply]) -> None:
    theirs = replies[name, "minimal"]
    assert isinstance(theirs, dict), theirs
    found = symobs.reduced_order_observer(symobs.StateSpace(*CASES[name][0]), poles=poles_of(name, "minimal")[1])
    for letter in "LTFGHM":
        assert close(numbers(getattr(found, letter)), theirs[letter]), letter


def test_a_wrong_number_would_be_seen(replies: dict[Any, Reply]) -> None:
    """Octave's numbers are sharp enough: a gain that is off by a hundred-thousandth of itself disagrees."""
    for theirs in replies.values():
        assert isinstance(theirs, dict), theirs
        assert not close(theirs["L"] * (1 + 1e-5), theirs["L"])
        assert not close(theirs["K"] * (1 + 1e-5), theirs["K"])
