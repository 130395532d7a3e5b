"""Gains with zeros in given places: why there is none, and a gain in a root that has no closed form."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from symobs.certificate.claims import Claim
from symobs.derivation.builder import relation
from symobs.errors import CertificateRejected
from symobs.exact import EIGENVALUE, Matrix, Scalar
from symobs.formula import Environment

if TYPE_CHECKING:
    from collections.abc import Iterator

    from symobs.design.gain.gain_design import GainDesign
    from symobs.design.pole_placement.zero_pattern import RootGain


def excluded_claims(design: GainDesign) -> Iterator[Claim]:
    """Yield what vanishes wherever a gain has its zeros where they are asked for: 1, or polynomials in parameters.

    Where there is nothing of that kind the answer says no more than that no gain was found, and none is.
    """
    if not design.needed and design.can_be_found:
        message = f"a gain {design.letter} with these zeros is found"
        raise CertificateRejected(message, repair="please report this: it is a bug of symobs")
    variable = design.plant.variable
    e = Environment(variable=variable, relations=design.equations)
    for value in design.needed:
        says = f"with zeros there, {value} lies in the ideal of the coefficients of det(s*I - A + L*C) - phi(s)"
        yield Claim(relation(value, 0), e, says if design.letter == "L" else says.replace("L*C", "B*K"))
        if not value.is_constant:
            yield Claim(relation(value, "!==", 0), Environment(variable=variable), f"{value} is not 0")


def in_root_claims(design: GainDesign, found: RootGain) -> Iterator[Claim]:
    """Yield that the gain assigns φ for every root of its polynomial, which changes its sign; and its zeros."""
    gain, e = design.oriented(found.gain), Environment(variable=design.plant.variable)
    yield design.assigned(gain, (found.polynomial,))
    low, high = (found.polynomial.substitute({EIGENVALUE: Scalar.of(end)}) for end in found.bounds)
    yield Claim(relation(low * high, "<", 0), e, f"{found.polynomial} has a real root")
    entries = Matrix.row([gain[i, j] for i, j in design.zero])
    yield Claim(relation(entries, Matrix.zeros(1, len(design.zero))), e, f"zeros in {design.letter} as asked for")


def in_root_report(design: GainDesign, found: RootGain) -> dict[str, Any]:
    """Return a gain in a root of a polynomial: the root, an interval around it, and the gain in x for the root."""
    x = {EIGENVALUE: Scalar.symbol("x")}
    low, high = found.bounds
    gain = design.oriented(found.gain).substitute(x)
    return {"polynomial": found.polynomial.substitute(x), "interval": [low, high], design.letter: gain}
