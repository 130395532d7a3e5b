"""The observer from its task: x̂' = F x̂ + G u + H y with nothing known of F, G, H but that the error is to vanish."""

from __future__ import annotations

from typing import TYPE_CHECKING

from symobs.exact import Matrix
from symobs.proof.derivation.builder import Builder, relation
from symobs.tasks.design.pole_placement.fresh_names import fresh_names, taken_names

if TYPE_CHECKING:
    from symobs.formula.tree.term import Term


def write_ansatz(page: Builder, gain: Matrix) -> None:
    """Write the error of the ansatz, and the choice of F and G that frees it of x and u."""
    m = page.plant.matrices
    undetermined(page, "F_x", "f_", (m.A - gain @ m.C).normal())
    undetermined(page, "H_x", "h_", gain)
    if m.has_input:
        undetermined(page, "G_x", "g_", (m.B - gain @ m.D).normal() if m.has_feedthrough else m.B)
    A, C, F, H = (page[name] for name in ("A", "C", "F_x", "H_x"))
    model = F @ page["x_hat"]
    if m.has_input:
        model = model + page["G_x"] @ page["u"]
    page.dynamics("x_hat", model + H @ page["y"], say="existence_ansatz")
    page.signal("e", page["x"] - page["x_hat"], silent=True)
    moving = (A - H @ C) @ page["x"] - F @ page["x_hat"]
    choice = [relation(F, A - H @ C)]
    if m.has_input:
        wanted: Term = page["B"] - H @ page["D"] if m.has_feedthrough else page["B"]
        moving = moving + (wanted - page["G_x"]) @ page["u"]
        choice.insert(0, relation(page["G_x"], wanted))
    page.equal(
        relation(page["e"].derivative, moving),
        say="existence_error",
        error=relation(page["e"], page["x"] - page["x_hat"]),
    )
    page.equal(*choice, say="existence_choice")
    page.equal(relation(page["e"].derivative, (A - H @ C) @ page["e"]), say="existence_left")


def write_found(page: Builder) -> None:
    """Write the observer with the matrices found."""
    m, L = page.plant.matrices, page["L"]
    page.conclude_silently(relation(page["H_x"], L))
    closed = page["A"] - L @ page["C"]
    collected, numbers = closed @ page["x_hat"], closed.as_value @ page["x_hat"]
    if m.has_input:
        driven = page["B"] - L @ page["D"] if m.has_feedthrough else page["B"]
        collected, numbers = collected + driven @ page["u"], numbers + driven.as_value @ page["u"]
    page.equal(
        relation(page["x_hat"].derivative, collected + L @ page["y"], numbers + L.as_value @ page["y"]),
        say="existence_observer",
        answer=True,
    )


def undetermined(page: Builder, name: str, stem: str, value: Matrix) -> None:
    """Establish a matrix of letters, which stand for what will be chosen."""
    names = iter(fresh_names(stem, len(value.entries), taken_names(page)))
    page.set(name, Matrix.of([[page.name_coefficient(next(names), entry) for entry in row] for row in value.rows]))
