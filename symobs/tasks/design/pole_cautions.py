"""Cautions about desired poles: an estimation error that grows or does not decay."""

from __future__ import annotations

from typing import TYPE_CHECKING

from symobs.proof.derivation.builder import Builder, predicate
from symobs.stability.criteria.stability import is_beyond, is_marginal, stability

if TYPE_CHECKING:
    from symobs.exact import Scalar
    from symobs.system.specification import DesiredPolynomial


def caution_poles(page: Builder, desired: DesiredPolynomial, phi: str, of: str) -> None:
    """Warn where the desired polynomial, the value of `phi`, is surely not stable; of: observer, state_feedback, servo."""
    plant, signs = page.plant, page.plant.symbols.signs
    polynomial, discrete = desired.polynomial, page.plant.is_discrete
    if page[phi].value != polynomial or stability(polynomial, plant.variable, signs, discrete=discrete).verdict != "no":
        return
    time, subject = "discrete" if discrete else "continuous", page[phi]
    facts = [predicate("unstable", subject)]
    if is_beyond(polynomial, plant.variable, signs, discrete=discrete):
        facts.append(predicate("beyond", subject))
        key, of = "grows", of if of == "observer" else "state_feedback"
    elif of == "servo":  # whatever the gains, a constant reference may drive the integral of the error without end
        key = "lasts"
    elif is_marginal(polynomial, plant.variable, signs, discrete=discrete):
        facts.append(predicate("marginal", subject))
        key = "stays"
        moved = page["s - 1"] if discrete else page.s
        rest = subject / moved
        if of == "state_feedback" and _is_stable(rest.scalar, page):
            facts.append(predicate("stable", rest))
            key = "drifts"
    else:
        key = "lasts"
    page.caution(f"{key}_{of}_{time}", *facts)


def _is_stable(rest: Scalar, page: Builder) -> bool:
    """Return whether a quotient is a polynomial and surely stable."""
    plant = page.plant
    if not rest.is_polynomial_in(plant.variable):
        return False
    return stability(rest, plant.variable, plant.symbols.signs, discrete=plant.is_discrete).verdict == "yes"
