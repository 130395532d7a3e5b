"""Three ways to mark the same answers: within 1 % of the printed gain, equal to it, and by its claim.

The first is what PrairieLearn's matrix element does by itself (numpy's allclose with rtol 1e-2 and atol 1e-8), the second
AlgEquiv of STACK with the printed gain, computed by Maxima; what is true is computed in plain fractions.
"""

from __future__ import annotations

import random
import re
import shutil
import subprocess
from fractions import Fraction
from typing import TYPE_CHECKING, NamedTuple

from symobs.applications.checking import Checked
from tests.support.problems.answered import THIRD_ORDER, TWO_OUTPUTS

if TYPE_CHECKING:
    Rows = list[list[Fraction]]


class Asked(NamedTuple):
    """A problem with its plant in plain numbers, the coefficients asked for from the lowest, and its printed gain."""

    name: str
    problem: str
    part: str
    A: Rows
    C: Rows
    phi: list[int]


def _table(text: str) -> Rows:
    return [[Fraction(entry) for entry in row.split()] for row in text.strip("[]").split(";")]


ASKED = (
    Asked("two outputs", TWO_OUTPUTS, "observer.L", _table("0 1 0;0 0 1;1 2 3"), _table("1 0 0;0 0 1"), [1, 3, 3, 1]),
    Asked("one output", THIRD_ORDER, "compensator.L", _table("1 2 0;0 -1 3;1 0 2"), _table("1 1 0"), [210, 107, 18, 1]),
)


def main(count: int, only: str) -> bool:
    """Print for each problem and way how many valid gains are refused and wrong ones accepted; True where ours errs nowhere."""
    flawless = True
    for asked in ASKED:
        if only and only != asked.name:
            continue
        checked = Checked.of(asked.problem)
        printed = _table(str(checked.results[0].fields["L"]).replace(",", " "))
        given = [drawn(asked, printed, random.Random(f"{asked.name} {k}")) for k in range(count)]  # noqa: S311
        true = [is_valid(asked, gain) for gain in given]
        ways = {
            "within 1 % of the printed gain": [near(each, printed) for each in given],
            "AlgEquiv with the printed gain": by_maxima(given, printed) if shutil.which("maxima") else [],
            "the claim, by symobs check": [_checked(checked, asked, each) for each in given],
        }
        print(f"{asked.name}: {count} answers, {sum(true)} of them valid")
        for name, found in ways.items():
            if not found:
                continue
            refused = sum(valid and not taken for valid, taken in zip(true, found, strict=True))
            accepted = sum(taken and not valid for valid, taken in zip(true, found, strict=True))
            print(f"  {name}: {refused} valid ones refused, {accepted} wrong ones accepted", flush=True)
            flawless &= not name.startswith("the claim") or refused == accepted == 0
    return flawless


def drawn(asked: Asked, printed: Rows, draw: random.Random) -> Rows:
    """A gain: the printed one, another valid one, one that is off by less than 1 %, with a slip, or any."""
    rows = [list(row) for row in printed]
    kind = draw.randrange(5)
    if kind == 1:
        return another(asked, draw)
    if kind == 2:
        base = another(asked, draw) if draw.random() < 0.5 else rows
        return [[entry * (1 + Fraction(draw.randrange(1, 10), 1000)) for entry in row] for row in base]
    if kind == 3:
        i, j = draw.randrange(len(rows)), draw.randrange(len(rows[0]))
        rows[i][j] += draw.choice([-1, 1, 2])
        return rows
    return [[Fraction(draw.randrange(-20, 21)) for _ in row] for row in rows] if kind == 4 else rows


def another(asked: Asked, draw: random.Random) -> Rows:
    """A valid gain: all columns but one at random, the last one by Ackermann's formula; that may be the printed one."""
    n, p = len(asked.A), len(asked.C)
    while True:
        L = [[Fraction(draw.randrange(-3, 4)) for _ in range(p)] for _ in range(n)]
        rest = [[*row[: p - 1], Fraction(0)] for row in L]
        closed = minus(asked.A, times(rest, asked.C))
        found = ackermann(closed, asked.C[-1], asked.phi)
        if found is not None:
            return [[*row[: p - 1], found[i]] for i, row in enumerate(rest)]


def ackermann(A: Rows, c: list[Fraction], phi: list[int]) -> list[Fraction] | None:
    """φ(A) 𝒪⁻¹ e_n, None where 𝒪 is singular: solved by elimination."""
    n, rows, last = len(A), [], [c]
    for _ in range(n):
        rows.append(last[0])
        last = times(last, A)
    table = [[*row, Fraction(i == n - 1)] for i, row in enumerate(rows)]
    for k in range(n):
        pivot = next((i for i in range(k, n) if table[i][k]), None)
        if pivot is None:
            return None
        table[k], table[pivot] = table[pivot], table[k]
        table[k] = [entry / table[k][k] for entry in table[k]]
        for i in range(n):
            if i != k:
                table[i] = [a - table[i][k] * b for a, b in zip(table[i], table[k], strict=True)]
    x = [[row[n]] for row in table]
    total = [[Fraction(0)] for _ in range(n)]
    for coefficient in reversed(phi):
        total = [[a[0] + coefficient * b[0]] for a, b in zip(times(A, total), x, strict=True)]
    return [row[0] for row in total]


def is_valid(asked: Asked, L: Rows) -> bool:
    """Whether det(sI − A + LC) is φ: its value at n + 1 points, by elimination in plain fractions."""
    closed, n = minus(asked.A, times(L, asked.C)), len(asked.A)
    for at in range(n + 1):
        table = [[(at if i == j else 0) - entry for j, entry in enumerate(row)] for i, row in enumerate(closed)]
        if determinant(table) != sum(value * at**k for k, value in enumerate(asked.phi)):
            return False
    return True


def near(gain: Rows, printed: Rows) -> bool:
    """|a − b| ≤ 1e-8 + 1e-2 |b| entry by entry, in floats."""
    pairs = ((float(a), float(b)) for rows in zip(gain, printed, strict=True) for a, b in zip(*rows, strict=True))
    return all(abs(a - b) <= 1e-8 + 1e-2 * abs(b) for a, b in pairs)


def by_maxima(given: list[Rows], printed: Rows) -> list[bool]:
    """Whether the difference simplifies to the zero matrix in Maxima."""

    def matrix(rows: Rows) -> str:
        return f"matrix({','.join('[' + ','.join(map(str, row)) + ']' for row in rows)})"

    lines = [f"ta: {matrix(printed)}$"]
    lines += [
        f'print("EQUAL", is(ratsimp({matrix(gain)}-ta)=zeromatrix({len(gain)},{len(gain[0])})))$' for gain in given
    ]
    done = subprocess.run(
        ["maxima", "--very-quiet"], input="\n".join(lines), capture_output=True, text=True, check=True, timeout=300
    )
    found = re.findall(r"EQUAL (true|false)", done.stdout)
    assert len(found) == len(given), done.stdout[-2000:]
    return [word == "true" for word in found]


def _checked(checked: Checked, asked: Asked, gain: Rows) -> bool:
    report = checked.report({"L": [[str(entry) for entry in row] for row in gain]})
    return next(part.verdict for part in report.parts if part.part == asked.part) == "right"


def times(X: Rows, Y: Rows) -> Rows:
    """X Y."""
    columns = list(zip(*Y, strict=True))
    return [[sum((a * b for a, b in zip(row, column, strict=True)), Fraction(0)) for column in columns] for row in X]


def minus(X: Rows, Y: Rows) -> Rows:
    """X − Y."""
    return [[a - b for a, b in zip(*rows, strict=True)] for rows in zip(X, Y, strict=True)]


def determinant(table: Rows) -> Fraction:
    """By elimination."""
    rows, found = [list(row) for row in table], Fraction(1)
    for k in range(len(rows)):
        pivot = next((i for i in range(k, len(rows)) if rows[i][k]), None)
        if pivot is None:
            return Fraction(0)
        if pivot != k:
            rows[k], rows[pivot], found = rows[pivot], rows[k], -found
        found *= rows[k][k]
        for i in range(k + 1, len(rows)):
            factor = rows[i][k] / rows[k][k]
            rows[i] = [a - factor * b for a, b in zip(rows[i], rows[k], strict=True)]
    return found
