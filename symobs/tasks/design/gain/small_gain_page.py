"""The step of a page that chooses among several gains: near the best conditioned placement, but for one row or column."""

from __future__ import annotations

from math import floor
from typing import TYPE_CHECKING

from symobs.exact import Matrix, Scalar, factored, rank
from symobs.formula.tree import Decimals
from symobs.formula.tree.term import Term, block
from symobs.proof.derivation.builder import Builder, predicate, relation
from symobs.tasks.design.gain.gain_kind import SmallGain
from symobs.tasks.design.pole_placement.brunovsky_chains import cost
from symobs.tasks.design.pole_placement.choice import why_simple
from symobs.tasks.design.pole_placement.multiple_outputs import MultiOutputPair
from symobs.tasks.design.pole_placement.single_output import ObserverPair

if TYPE_CHECKING:
    from fractions import Fraction

    from symobs.tasks.design.gain.gain_design import GainDesign, PlacementProblem


def small_gain_terms(
    page: Builder, design: GainDesign, side: PlacementProblem, A: Term, moved: Term
) -> tuple[list[Term], str]:
    """Write the part of K (of L) that is chosen, and what is left; return the rest of the gain's definition and its words.

    A and `moved` are the terms of A and of B or C for which the design is one.  Nothing is written or returned where the
    gain was not searched for, or has become another one.
    """
    say_why_simple(page, design, side, moved)
    if not isinstance(design.kind, SmallGain):
        return [], ""
    L, vectors = design.transpose_for_task(design.answer[design.letter]), design.kind.vectors
    if vectors is not None:
        Psi, f, _ = vectors
        found = Psi.T.solve(f.T).normal()
        return (_by_eigenvectors(page, side, A, moved, vectors), "small_vectors_follow") if found == L else ([], "")
    left = _left(design, L)
    return ([], "") if left is None else ([_by_one_column(page, design, side, A, moved, left)], "small_follows")


def _by_eigenvectors(
    page: Builder, side: PlacementProblem, A: Term, moved: Term, vectors: tuple[Matrix, Matrix, Matrix]
) -> list[Term]:
    """Write f and the eigenvectors Ψ, and return f Ψ⁻¹."""
    Psi, f, J = vectors
    right, left = (
        page.define(f"f_{side.index}", f, say=f"small_directions_{side.kind}"),
        page.set(f"Psi_{side.index}", Psi),
    )
    A, driven = (A.T, moved.T) if side.is_dual else (A, moved)
    page.equal(
        relation(left, Psi), relation(A @ left - driven @ right, left @ page.value(J)), say=f"small_solved_{side.kind}"
    )
    gain = right @ left.inverse
    return [gain.T if side.is_dual else gain]


def _by_one_column(
    page: Builder, design: GainDesign, side: PlacementProblem, A: Term, moved: Term, left: tuple[int, Matrix]
) -> Term:
    """Write the columns of L but one and the plant with the output of that one, and return how the gain follows."""
    output, L_0 = left
    order, index = A.value.shape[0], side.index
    unit, last = page.value(Matrix.unit(design.pair.c.shape[0], output)), page.value(Matrix.unit(order, order - 1))
    chosen = page.define(f"{side.gain}_0", design.transpose_for_task(L_0), say=f"small_chosen_{side.kind}")
    if side.is_dual:
        shifted = page.define(f"A_{index}0", A - chosen @ moved, say="small_left_observer")
        row = page.define("c_o", unit.T @ moved)
        stack = block([[row @ shifted**k if k else row] for k in range(order)])
        return chosen + shifted.apply("phi_o_at") @ stack.inverse @ last @ unit.T
    shifted = page.define(f"A_{index}0", A - moved @ chosen, say="small_left_state_feedback")
    column = page.define("b_c", moved @ unit)
    stack = block([[shifted**k @ column if k else column for k in range(order)]])
    return chosen + unit @ last.T @ stack.inverse @ shifted.apply("phi_c_at")


def compare_with_simple(page: Builder, design: GainDesign, side: PlacementProblem, A: Term, moved: Term) -> None:
    """Say how large the gain with simple entries is, where it is larger than the one of the page."""
    kind = design.kind
    if not isinstance(kind, SmallGain):
        return
    bound = _rounded_down(_largest(kind.simple))
    if bound > _largest(design.answer[side.gain]):
        simple = page.set(f"{side.gain}_s", design.transpose_for_task(kind.simple))
        pencil = page("det(pencil({A}) + {fed})", A=A, fed=simple @ moved if side.is_dual else moved @ simple)
        page.conclude_silently(relation(pencil, page[side.phi]))
        page.remark(f"small_instead_{side.kind}", bound=page.term(Decimals(Scalar.of(bound))))


def _left(design: GainDesign, L: Matrix) -> tuple[int, Matrix] | None:
    """Return an output whose column of L is determined by the others, which have short numbers, and L without it."""
    pair, (order, outputs) = design.pair, L.shape
    parts = [(L.select(range(order), [output]), output) for output in range(outputs)]
    for column, output in sorted(parts, key=lambda part: cost(part[0]), reverse=True):
        L_0 = (L - column @ Matrix.unit(outputs, output).T).normal()
        left = ObserverPair((pair.A - L_0 @ pair.c).normal(), pair.c.select([output], range(order)), pair.variable)
        if left.is_observable:
            return output, L_0
    return None


def say_why_simple(page: Builder, design: GainDesign, side: PlacementProblem, moved: Term) -> None:
    """Say why the gain is not one with small entries, although that is wanted."""
    desired = design.desired
    if desired is None or desired.choose != "small" or isinstance(design.kind, SmallGain):
        return
    why = why_simple(design.pair, desired)
    if why in {"letters", "hidden"}:
        page.remark(f"small_not_{why}")
    elif not why and isinstance(design.pair, MultiOutputPair):
        from symobs.tasks.design.pole_placement.small_gain import is_small  # noqa: PLC0415 - as in the search

        if not is_small(design.pair, desired, design.transpose_for_task(design.answer[side.gain])):
            page.remark("small_not_found")
    elif why == "repeated":
        factor, power = max(factored(desired.polynomial, desired.variable).factors, key=lambda part: part[1])
        eigenvectors = relation(moved.apply("rank"), rank(moved.value))
        often = predicate("polynomial", page[side.phi] / page.value(factor**power))
        page.remark(f"small_not_repeated_{side.kind}", often, rank=eigenvectors)


def _largest(gain: Matrix) -> Fraction:
    """Return the largest absolute value of an entry of a gain with numbers."""
    return max(abs(entry.fraction()) for entry in gain.entries)


def _rounded_down(number: Fraction) -> int:
    """Return the largest integer that is not larger: one more would be false."""
    return floor(number)
