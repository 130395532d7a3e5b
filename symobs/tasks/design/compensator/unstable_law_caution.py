"""Remark on a compensator that is unstable in open loop."""

from __future__ import annotations

from typing import TYPE_CHECKING

from symobs.proof.derivation.builder import predicate, relation
from symobs.stability.criteria.stability import stability

if TYPE_CHECKING:
    from symobs.proof.derivation.builder import Builder
    from symobs.tasks.design.compensator.output_feedback import OutputFeedback


def caution_law(page: Builder, loop: OutputFeedback) -> None:
    """Warn where the law is surely unstable by itself, which a loop with stable poles does not show."""
    plant, own = page.plant, loop.own_matrix
    chi = own.characteristic_polynomial(plant.variable)
    minimal = page.defines("F_z")
    if chi.names - {plant.variable} or (minimal and plant.matrices.has_feedthrough):
        return
    if stability(chi, plant.variable, {}, discrete=plant.is_discrete).verdict != "no":
        return
    if minimal:
        matrix = page["F_z"] - page["G_z"] @ page["K_2"]
    else:
        A, B, C, K, L = (page[name] for name in "ABCKL")
        matrix = A - B @ K - L @ C
        matrix = matrix + L @ page["D"] @ K if plant.matrices.has_feedthrough else matrix
    page.set("A_c", own)
    determinant = (page.s @ page.identity(own.shape[0]) - page["A_c"]).apply("det")
    time = "discrete" if plant.is_discrete else "continuous"
    unstable = predicate("unstable", determinant)
    page.caution(f"law_unstable_{time}", unstable, matrix=relation(page["A_c"], matrix, page["A_c"].as_value))
