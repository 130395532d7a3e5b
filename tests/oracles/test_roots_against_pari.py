"""Gains for plants with √2, √3 and √5 in their entries, held against PARI/GP in decimals of 200 digits."""

from __future__ import annotations

import random
import shutil
import subprocess

import pytest

import symobs as so
from tests.support.sampling import FULL

pytestmark = pytest.mark.skipif(shutil.which("gp") is None, reason="needs gp")

_PROGRAM = r"""
default(realprecision, 200);
rows(A, C) = {my(O = matrix(#A, #A), row = C); for(i = 1, #A, O[i,] = row; row = row * A); O};
phi(A, P) = {my(M = matid(#A)); for(i = 1, #A, M = M * (A - P[i] * matid(#A))); M};
right(A, C, P, L) = vecmax(abs(phi(A, P) * matsolve(rows(A, C), matid(#A)[, #A]) - L)) < 1e-150;
check(A, C, P, L) = if(abs(matdet(rows(A, C))) < 1e-150, "no", if(right(A, C, P, L), "yes", "wrong"));
"""


def _number(dice: random.Random) -> str:
    whole, first, second = (dice.randint(-3, 3) for _ in range(3))
    return f"({whole} + {first}*sqrt({dice.choice((2, 8, 3))}) + {second}*sqrt({dice.choice((5, 6))})/2)"


def _plant(dice: random.Random) -> tuple[list[list[str]], list[str]]:
    """A plant of order 2 or 3; some of order 2 have cA = λc, so that a mode is hidden by construction."""
    order = dice.choice((2, 2, 3))
    A = [[_number(dice) for _ in range(order)] for _ in range(order)]
    c = [_number(dice) for _ in range(order - 1)] + [f"({dice.randint(1, 4)} + sqrt(2))"]
    if order == 2 and dice.random() < 0.3:
        p, q, rate = *c, _number(dice)
        A[1] = [f"({rate}*{p} - {p}*{A[0][0]})/{q}", f"({rate}*{q} - {p}*{A[0][1]})/{q}"]
    return A, c


def _answers(count: int, seed: int) -> tuple[list[str], str]:
    dice, script, verdicts = random.Random(seed), [_PROGRAM], []  # noqa: S311 - repeatable
    for _ in range(count):
        A, c = _plant(dice)
        poles = [f"-{_number(dice)}^2 - 1" for _ in c]
        plant = so.StateSpace(A, C=[c])
        found = so.observer(plant, poles=poles)
        gain = [str(entry) for entry in found.L] if found.verdict == "yes" else ["0"] * len(c)
        verdicts.append(found.verdict)
        rows = ";".join(",".join(row) for row in A)
        script.append(f"print(check([{rows}], [{','.join(c)}], [{','.join(poles)}], [{','.join(gain)}]~))")
    return verdicts, "\n".join(script).replace("**", "^") + "\n"


@pytest.mark.slow
def test_gains_with_roots() -> None:
    verdicts, script = _answers(200 if FULL else 40, 2)
    done = subprocess.run(["gp", "-q", "-f"], input=script, capture_output=True, text=True, timeout=300, check=True)
    assert done.stdout.split() == verdicts
    assert {"yes", "no"} <= set(verdicts)
