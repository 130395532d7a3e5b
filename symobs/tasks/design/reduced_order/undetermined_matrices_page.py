"""The reduced-order observer with undetermined matrices: x̂₂ = z + L x₁, ż = F z + G u + H y with undetermined F, G, H."""

from __future__ import annotations

from typing import TYPE_CHECKING

from symobs.exact import Matrix
from symobs.proof.derivation.builder import Builder, relation
from symobs.tasks.design.full_order.observer_existence_page import undetermined
from symobs.tasks.design.pole_placement.fresh_names import fresh_names, taken_names

if TYPE_CHECKING:
    from symobs.tasks.design.reduced_order.reduced_order_observer import ReducedOrderObserver


def write_undetermined(page: Builder, design: ReducedOrderObserver) -> None:
    """Write the error of the ansatz, collected by signals, and the choice of F, G and H that frees it of x and u."""
    m, name = page.plant.matrices, "w_o" if page.plant.is_discrete else "z_o"
    letters = iter(fresh_names("l_", len(design.answer["L"].entries), taken_names(page)))
    entries = [[page.name_coefficient(next(letters), entry) for entry in row] for row in design.answer["L"].rows]
    page.set("L", Matrix.of(entries))
    for letter, stem in (("F_z", "f_"), ("H_z", "h_"), ("G_z", "g_")):
        value = design.answer[letter[0]]
        if value is not None:
            undetermined(page, letter, stem, value)
    L, F, H, z, x_1, x_2, u = (page[key] for key in ("L", "F_z", "H_z", name, "x_1", "x_2", "u"))
    page.signal("x_2_hat", z + L @ x_1, silent=True)
    rate = F @ z + page["G_z"] @ u if m.has_input else F @ z
    page.dynamics(
        name, rate + H @ page["y"], say="undetermined_ansatz", estimate=relation(page["x_2_hat"], z + L @ x_1)
    )
    page.signal("e_2", x_2 - page["x_2_hat"], silent=True)
    fed = page["A_21"] - L @ page["A_11"] + F @ L
    moving = F @ page["e_2"] + (fed - H) @ x_1 + (page["A_22"] - L @ page["A_12"] - F) @ x_2
    choice = [relation(F, page["A_22"] - L @ page["A_12"]), relation(H, F @ L + page["A_21"] - L @ page["A_11"])]
    if m.has_input:
        wanted = page["B_2"] - L @ page["B_1"]
        wanted = wanted - H @ page["D"] if m.has_feedthrough else wanted
        moving = moving + (wanted - page["G_z"]) @ u
        choice.insert(1, relation(page["G_z"], wanted))
    error = relation(page["e_2"], x_2 - page["x_2_hat"])
    page.equal(relation(page["e_2"].derivative, moving), say="undetermined_error", error=error)
    page.equal(*choice, say="undetermined_choice")
    page.equal(relation(page["e_2"].derivative, F @ page["e_2"]), say="undetermined_left")
