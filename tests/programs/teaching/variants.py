"""What constructions promise of every candidate, and that no two variants are one plant."""

from __future__ import annotations

import itertools
import re
import time
from collections import defaultdict
from fractions import Fraction
from typing import TYPE_CHECKING, Any

import sympy as sp

from symobs.applications.variants.acceptance import candidate, cheap, keys_of
from symobs.applications.variants.constructions import CONSTRUCTIONS, Made
from symobs.applications.variants.drawing import Draws
from symobs.applications.variants.table import read_table
from tests.support.independent_algebra.plain_fractions import determinant, eliminate, inverse, times
from tests.unit.applications.variants.test_constructions import (
    desired,
    h1,
    h2,
    linear_forms,
    observability,
    s,
    table,
    turned,
)

if TYPE_CHECKING:
    from symobs.applications.variants.acceptance import Candidate

CANDIDATES, SEED = 500, 29
_OF_GAINS = ("compensator", "observer", "state_feedback", "canonical_form")
#: The task of a construction where it has not its name.
_TASKS = {"member": "observer", "gain": "observer", "ranks": "detectability", "modal": "canonical_form"}
_TASKS |= {"second_order": "compensator", "region": "stability_region", "compensator": "compensator"}


def main(count: int, only: str) -> bool:
    """Print a line a construction; False where one does not keep its promise."""
    whole = True
    for kind in CONSTRUCTIONS:
        if only and kind != only:
            continue
        began = time.process_time()
        held = sum(keeps(kind, number) for number in range(CANDIDATES))
        first = time.process_time() - began
        accepted, tried = distinct_ones(kind, count)
        same = pairs_that_are_one(accepted)
        seconds = time.process_time() - began - first
        print(
            f"{kind}: {held} of {CANDIDATES} keep the promise ({first:.1f} s); {len(accepted)} of {tried} accepted, "
            f"{same} pairs are one plant ({seconds:.1f} s)",
            flush=True,
        )
        whole &= held == CANDIDATES and len(accepted) == count and not same
    return whole


def made(kind: str, number: int) -> Made:
    """The candidate of a number, with the shape that nothing is said about."""
    make, usual = CONSTRUCTIONS[kind]
    return make(Draws(SEED, number), usual)


# -- promises ---------------------------------------------------------------------------------------------------------


def keeps(kind: str, number: int) -> bool:
    """Whether a candidate keeps the promise of its construction, in plain fractions and by SymPy."""
    found = made(kind, number)
    if kind == "region":
        return _whole_corners(found)
    A, B, C = (table(found.plant[name]) for name in "ABC")
    if any(entry.denominator > 1 for rows in (A, B, C) for row in rows for entry in row):
        return False
    if kind in _OF_GAINS:
        return _whole_gains(A, B, C, found)
    if kind in {"member", "gain"}:
        return _whole_member(A, C, found, number)
    roots = sp.Poly(sp.Matrix(A).charpoly(s).as_expr(), s).ground_roots()
    if kind == "second_order":
        return A[0] == [0, 1] and all(root.is_integer for root in roots)
    if sum(roots.values()) < len(A) or not all(root.is_integer for root in roots):
        return False
    return kind in {"decomposition", "ranks"} or _whole_vectors(sp.Matrix(A), list(roots))


def _whole_gains(A: Any, B: Any, C: Any, found: Made) -> bool:
    seen, driven = observability(A, C), turned(observability(turned(A), turned(B)))
    last = [[Fraction(i == len(A) - 1)] for i in range(len(A))]
    L = times(times(desired(A, found.specification["observer_poles"].pairs), inverse(seen)), last)
    K = times(times(turned(last), inverse(driven)), desired(A, found.specification["control_poles"].pairs))
    units = abs(determinant(seen)) == abs(determinant(driven)) == 1
    return units and all(entry.denominator == 1 for row in (*K, *L) for entry in row)


def _whole_member(A: Any, C: Any, found: Made, number: int) -> bool:
    """Whether the whole L that was drawn gives the asked polynomial, and C has independent rows."""
    n, p, draw = len(A), len(C), Draws(SEED, number)["L"]
    L = sp.Matrix(n, p, lambda _i, _j: draw.below(5) - 2)
    phi = sp.prod(s - pole for pole, _ in found.specification["observer_poles"].pairs)
    closed = (sp.Matrix(A) - L * sp.Matrix(C)).charpoly(s).as_expr()
    return bool(eliminate(C, n)[0] == p and sp.expand(closed - phi) == 0)


def _whole_vectors(A: sp.Matrix, roots: list[sp.Integer]) -> bool:
    vectors = [(A - root * sp.eye(A.rows)).nullspace()[0] for root in roots]
    scaled = [vector * sp.ilcm(*(entry.q for entry in vector)) for vector in vectors]
    primitive = [vector / sp.igcd(*vector) for vector in scaled]
    return bool(len(roots) == A.rows and abs(sp.Matrix.hstack(*primitive).det()) == 1)


def _whole_corners(found: Made) -> bool:
    middle, last = linear_forms(found.specification["polynomial"])
    sides = [1 + middle + last, 1 - middle + last, 1 - last]
    corners = [sp.linsolve([sides[i] for i in pair], [h1, h2]) for pair in ((0, 1), (0, 2), (1, 2))]
    return all(value.is_integer for corner in corners for value in next(iter(corner)))


# -- variants that are distinct ---------------------------------------------------------------------------------------


def distinct_ones(kind: str, count: int) -> tuple[list[Candidate], int]:
    """The first candidates that the cheap tests and the keys of data and coordinates accept, and how many were tried."""
    task = _TASKS.get(kind, kind)
    shape = f'construct = {{ kind = "{kind}"{_WIDER.get(kind, "")} }}'
    form = {"canonical_form": "controllable", "modal": "modal"}.get(kind)
    asked_form = f'[specification]\nkind = "{form}"\n' if form else ""
    text = f'title = "t"\ntask = "{task}"\n{asked_form}[variants]\n{shape}\n[variants.constraints]\n'
    found: list[Candidate] = []
    keys: set[str] = set()
    number = 0
    asked = read_table(text)
    while len(found) < count and number < 100 * count:
        each = candidate(asked, 7, number)
        number += 1
        if cheap(asked, each).reason is None and not (own := keys_of(each, [], "data")) & keys:
            keys |= own
            found.append(each)
    return found, number


#: Intervals from which a thousand can be drawn, where the usual ones are narrow.
_WIDER = {
    "gramian": ", plant_poles = [-9, -1], steps = 3",
    "matrix_exponential": ", plant_poles = [-9, 9], steps = 3",
    "modal": ", plant_poles = [-6, 6]",
    "ranks": ", plant_poles = [-9, 9], steps = 3",
    "second_order": ", plant_poles = [-9, 9]",
}


def pairs_that_are_one(found: list[Candidate]) -> int:
    """How many pairs are one plant with the states renumbered or turned, asked for the same; none of our keys takes part."""
    alike = defaultdict(list)
    for each in found:
        alike[_invariant(each)].append(each)
    return sum(_one(first, second) for group in alike.values() for first, second in itertools.combinations(group, 2))


def _invariant(each: Candidate) -> str:
    """What renumbering and turning states leaves as it is."""
    asked = str(
        sorted(
            (key, sorted(re.split(r",\s*", str(value)))) for key, value in each.data.get("specification", {}).items()
        )
    )
    sizes = {name: sorted(abs(entry) for row in rows for entry in row) for name, rows in each.matrices.items()}
    return f"{asked} {sorted(sizes.items())}"


def _one(first: Candidate, second: Candidate) -> bool:
    if "A" not in first.matrices:
        return bool(first.data["specification"] == second.data["specification"])
    n = len(first.matrices["A"])
    wanted = second.matrices
    for order in itertools.permutations(range(n)):
        for signs in itertools.product((1, -1), repeat=n):
            moved = [
                [signs[i] * signs[j] * first.matrices["A"][order[i]][order[j]] for j in range(n)] for i in range(n)
            ]
            if moved != [list(row) for row in wanted["A"]]:
                continue
            columns = [
                [signs[i] * column[order[i]] for i in range(n)] for column in zip(*first.matrices["B"], strict=True)
            ]
            rows = [[signs[i] * row[order[i]] for i in range(n)] for row in first.matrices["C"]]
            if _up_to_signs(columns, list(map(list, zip(*wanted["B"], strict=True)))) and _up_to_signs(
                rows, list(map(list, wanted["C"]))
            ):
                return True
    return False


def _up_to_signs(mine: list[list[int]], others: list[list[int]]) -> bool:
    return all(a in (b, [-entry for entry in b]) for a, b in zip(mine, others, strict=True))
