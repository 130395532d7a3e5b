"""Sums of matrices times signals with their numbers, and equations component by component beside the matrix form."""

from __future__ import annotations

from typing import TYPE_CHECKING

from symobs.exact import Matrix
from symobs.proof.derivation.builder import Builder, relation
from symobs.tasks.analysis.page_parts import is_narrow, letters_apart_from_data
from symobs.tasks.design.readability import COMPONENT, COMPONENTS_ORDER

if TYPE_CHECKING:
    from symobs.formula.tree.term import Term


def stand_in_line(page: Builder, *names: str) -> bool:
    """Return whether matrices of as many rows fit beside one another."""
    return is_narrow(Matrix.block([[page[name].value for name in names]]))


def summed(pairs: list[tuple[Term, Term]]) -> Term:
    """Return Σ matrix · signal, as letters."""
    total = pairs[0][0] @ pairs[0][1]
    for matrix, signal in pairs[1:]:
        total = total + matrix @ signal
    return total


def combination(page: Builder, pairs: list[tuple[Term, Term]]) -> Term:
    """Return the sum with numbers: what is zero is left out, and a 1×1 matrix is a number."""
    total: Term | None = None
    for matrix, signal in pairs:
        value = matrix.value
        if value.is_zero:
            continue
        single = value[0, 0] if value.shape == (1, 1) else None
        negative = single is not None and single.is_constant and single.fraction() < 0
        if single is not None:
            size = -single if negative else single
            part = signal if size.is_one else page.value(size) * signal
        else:
            part = letters_apart_from_data(page, value) @ signal
        part = -part if negative and total is None else part
        total = part if total is None else total - part if negative else total + part
    return summed(pairs) if total is None else total


def write_components(page: Builder, driven: Term | None) -> None:
    """Write x̂' = (A − LC) x̂ + (B − LD) u + L y row by row, and check that x̂ = x is a solution."""
    L = page["L"]
    closed = page["A - L C"]
    sources = [(L, page["y"])] if driven is None else [(driven, page["u"]), (L, page["y"])]
    entries = [entry for matrix in (closed, *(matrix for matrix, _ in sources)) for entry in matrix.value.entries]
    if (
        page.plant.order != COMPONENTS_ORDER
        or page.plant.outputs > 1
        or any(entry.size - 1 > COMPONENT for entry in entries)
    ):
        return
    x_hat = page["x_hat"]
    parts = []
    for i in range(page.plant.order):
        unit = page.value(Matrix.unit(page.plant.order, i).T)
        parts.append(page.signal(f"x_hat_{i + 1}", unit @ x_hat, silent=True))
    rows = []
    for i, part in enumerate(parts):
        pairs = [(page.value(Matrix.of([[closed.value[i, j]]])), other) for j, other in enumerate(parts)]
        pairs += [(page.value(matrix.value.select([i], range(matrix.value.shape[1]))), s) for matrix, s in sources]
        rows.append(relation(part.derivative, combination(page, pairs)))
    page.equal(*rows, say="in_components")
    right = page["(A - L C) x"]
    for matrix, signal in sources:
        right = right + matrix @ signal
    page.verified("right_estimate_stays", consistent=page.line("{right} = x'", right=right))
