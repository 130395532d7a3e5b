"""The cheap tests of a candidate, in Python's whole numbers: they cost a thousandth of solving it.

What they find of gains is compared with what the engine finds; a difference is a bug of symobs.
"""

from __future__ import annotations

from functools import lru_cache
from typing import TYPE_CHECKING, Any, NamedTuple

from symobs.applications.variants.acceptance.candidates import desired, pole_kinds, tasks_of
from symobs.applications.variants.acceptance.profile import UNLIKE
from symobs.applications.variants.drawing.integers import (
    Poly,
    Rows,
    adjugate,
    common_divisor,
    evaluated,
    identity,
    krylov,
    plus,
    primitive,
    quotient,
    rank,
    times,
    transposed,
    trimmed,
)
from symobs.applications.variants.reading.substitution import RELATION, in_text
from symobs.formula.expression import parse_scalar
from symobs.formula.expression.source import shown
from symobs.ground.errors import InputError

if TYPE_CHECKING:
    from collections.abc import Mapping
    from fractions import Fraction

    from symobs.applications.variants.acceptance.candidates import Candidate
    from symobs.applications.variants.reading.table import Table

_DESIGNS = {"compensator", "observer", "state_feedback", "feedforward", "reduced_order_observer"}
#: Which gains of single-input or single-output plants are known beforehand, by task.
_KNOWN = {"compensator": ("K", "L"), "observer": ("L",), "state_feedback": ("K",)}


class Cheap(NamedTuple):
    """Why a candidate is none, or what is known of its answers."""

    reason: str | None = None
    gains: Mapping[str, Rows] = {}


def cheap(table: Table, found: Candidate, kind: Mapping[str, Any] | None = None) -> Cheap:
    """Return what the cheap tests find; `kind` is that of the data of the problem that candidates are to be like."""
    for relation in table.when:
        if not holds(relation, found):
            return Cheap(f"when: {relation}")
    constraints = table.constraints
    digits: Mapping[str, int] = constraints.get("digits", {})
    for name, rows in found.matrices.items():
        if longest(rows) > digits.get(name, digits.get("*", 99)):
            return Cheap(f"{name} has too many digits")
    if kind is not None and kind_of(found) != kind:
        return Cheap(UNLIKE)
    if not found.is_whole:
        return Cheap()
    return _of_plant(found, constraints, digits)


def _of_plant(found: Candidate, constraints: Mapping[str, Any], digits: Mapping[str, int]) -> Cheap:
    """Return what the ranks and the gains say."""
    A, B, C = (found.matrices.get(name) for name in "ABC")
    order = len(A or ())
    if A is None or any(len(row) != order for row in A) or (B and len(B) != order) or (C and len(C[0]) != order):
        return Cheap()
    tasks = set(tasks_of(found.data))
    controllability = _stacked(A, B) if B else None
    observability = transposed(_stacked(transposed(A), transposed(C))) if C else None
    ranks = tuple(rank(each) if each else None for each in (controllability, observability))
    if found.ranks is not None and ranks != found.ranks:
        return Cheap("the parts have other sizes")
    for name, value in zip(("controllable", "observable"), ranks, strict=True):
        wanted = constraints.get(name)
        if value is not None and wanted is not None and wanted != (value == order):
            return Cheap(f"{name} is not {str(wanted).lower()}")
    if found.data.get("specification", {}).get("observer") == "minimal" or "reduced_order_observer" in tasks:
        first = next((entry for entry in (C or ((),))[0] if entry), 0)
        if constraints.get("integer") and first not in {1, -1}:
            return Cheap("[C; R] is not unimodular")
        return Cheap()
    if not tasks & _KNOWN.keys():
        return Cheap()
    return _gains(found, constraints, digits, (controllability, observability), tasks)


def _gains(
    found: Candidate,
    constraints: Mapping[str, Any],
    digits: Mapping[str, int],
    stacks: tuple[Rows | None, Rows | None],
    tasks: set[str],
) -> Cheap:
    """Return the gains of a plant with one input and one output, and whether they are whole and short enough."""
    A, order = found.matrices["A"], len(found.matrices["A"])
    known = {name for task in tasks for name in _KNOWN.get(task, ())}
    halves = {"K": ("control", stacks[0], A), "L": ("observer", stacks[1], transposed(A))}
    gains: dict[str, Rows] = {}
    for name, (half, stack, of) in halves.items():
        phi = desired(found.data, half) if name in known else None
        if stack is None or phi is None or len(phi) != order + 1 or len(stack[0]) != order or len(stack) != order:
            continue
        inverse, determinant, _ = adjugate(stack if name == "K" else transposed(stack))
        if not determinant:
            return Cheap("the poles cannot be placed")
        row = transposed(evaluated(phi, transposed(of), transposed(inverse[-1:])))
        if any(entry % determinant for entry in row[0]):
            if name in constraints.get("integer", ()):
                return Cheap(f"{name} is not whole")
            continue
        gain = tuple(tuple(entry // determinant for entry in each) for each in row)
        gains[name] = gain if name == "K" else transposed(gain)
        if longest(gain) > digits.get(name, digits.get("*", 99)):
            return Cheap(f"{name} has too many digits")
        if name in constraints.get("answers_nonzero", ()) and any(not entry for entry in gain[0]):
            return Cheap(f"{name} has an entry 0")
    if gains.keys() >= {"K", "L"} and "compensator" in tasks:
        fraction = controller(found.matrices, gains["K"], gains["L"])
        if longest(fraction) > digits.get("F", digits.get("*", 99)):
            return Cheap("F has too many digits", gains)
    return Cheap(None, gains)


def _stacked(A: Rows, B: Rows) -> Rows:
    """Return [B, A B, …, Aⁿ⁻¹B]."""
    return krylov(A, B)


def controller(matrices: Mapping[str, Rows], K: Rows, L: Rows) -> tuple[Poly, Poly]:
    """Return numerator and denominator of F = K (sI − A + BK + LC − LDK)⁻¹ L, coprime and primitive."""
    B, C, D = matrices["B"], matrices["C"], matrices.get("D", ((0,),))
    order = len(B)
    M = plus(plus(matrices["A"], times(B, K), -1), times(L, plus(C, times(D, K), -1)), -1)
    # adj(sI − M) = Σ sⁿ⁻¹⁻ᵏ Nₖ with N₀ = I and Nₖ = M Nₖ₋₁ + cₖ I, where cₖ are the coefficients of det(sI − M)
    denominator = adjugate(M)[2]
    numerator, N = [], identity(order)
    for k in range(order):
        numerator.append(times(times(K, N), L)[0][0])
        N = plus(times(M, N), identity(order), denominator[order - 1 - k])
    top = trimmed(tuple(reversed(numerator)))
    if not top:
        return (0,), (1,)
    shared = common_divisor(top, denominator)
    if len(shared) > 1:
        top, denominator = quotient(top, shared), quotient(denominator, shared)
    first, second = primitive(top, denominator)
    return first, second


def longest(rows: Rows | tuple[Poly, ...]) -> int:
    """Return the most digits of an entry."""
    return max((len(str(abs(entry))) for row in rows for entry in row), default=1)


# -- relations --------------------------------------------------------------------------------------------------------


def holds(relation: str, found: Candidate) -> bool:
    """Return whether a relation among the parameters holds; raises `InputError` for what is none."""
    match = RELATION.match(relation)
    if match is None:
        message = f'"{shown(relation, 60)}" is no relation'
        raise InputError(message, where="variants.parameters.when", repair='write when = ["a < b"]')
    left, right = (_number(in_text(side, found.values, "variants.parameters.when")) for side in match.groups()[::2])
    return {
        "!=": left != right,
        "==": left == right,
        "=": left == right,
        ">": left > right,
        "<": left < right,
        ">=": left >= right,
        "<=": left <= right,
    }[match[2]]


@lru_cache(maxsize=65536)
def _number(text: str) -> Fraction:
    return parse_scalar(text.strip(), {}, where="variants.parameters.when").fraction()


# -- kinds of data ----------------------------------------------------------------------------------------------------


def kind_of(found: Candidate) -> dict[str, Any]:
    """Return what of the structure can be seen in the data: shapes, zeros, and the kinds of poles."""
    return {"matrices": found.shapes, "poles": pole_kinds(found.data)}
