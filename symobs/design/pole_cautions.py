"""What an expert would warn of beside poles that were asked for: an error that grows, or stays."""

from __future__ import annotations

from typing import TYPE_CHECKING

from symobs.page import predicate, relation
from symobs.stability import is_beyond, is_marginal, stability

if TYPE_CHECKING:
    from symobs.design.output_feedback import OutputFeedback
    from symobs.exact import Scalar
    from symobs.page import Page
    from symobs.specification import DesiredPolynomial


def caution_poles(page: Page, desired: DesiredPolynomial, phi: str, of: str) -> None:
    """Warn where the polynomial asked for, which the letter `phi` means, is surely not stable; of: observer or control."""
    plant, signs = page.plant, page.plant.symbols.signs
    polynomial, discrete = desired.polynomial, page.plant.is_discrete
    if page[phi].value != polynomial or stability(polynomial, plant.variable, signs, discrete=discrete).verdict != "no":
        return
    time, subject = "discrete" if discrete else "continuous", page[phi]
    facts = [predicate("unstable", subject)]
    if is_beyond(polynomial, plant.variable, signs, discrete=discrete):
        facts.append(predicate("beyond", subject))
        key = "grows"
    elif is_marginal(polynomial, plant.variable, signs, discrete=discrete):
        facts.append(predicate("marginal", subject))
        key = "stays"
        moved = page.s - page.value(1) if discrete else page.s
        rest = subject / moved
        if of == "state_feedback" and _is_stable(rest.scalar, page):
            facts.append(predicate("stable", rest))
            key = "drifts"
    else:
        key = "lasts"
    page.caution(f"{key}_{of}_{time}", *facts)


def _is_stable(rest: Scalar, page: Page) -> bool:
    """Tell whether what is left of a polynomial is one and surely stable."""
    plant = page.plant
    if not rest.is_polynomial_in(plant.variable):
        return False
    return stability(rest, plant.variable, plant.symbols.signs, discrete=plant.is_discrete).verdict == "yes"


def caution_law(page: Page, loop: OutputFeedback) -> None:
    """Warn where the law is surely unstable by itself, which a loop with stable poles does not show."""
    plant, own = page.plant, loop.own_matrix
    chi = own.characteristic_polynomial(plant.variable)
    minimal = page.knows("F_z")
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
    page.caution(f"law_unstable_{time}", unstable, matrix=relation(page["A_c"], matrix, page["A_c"].shown))
