"""Choice of the derivation for a gain: canonical form for small plants, else a general formula."""

from __future__ import annotations

from typing import TYPE_CHECKING

from symobs.design.page_parts import readability

if TYPE_CHECKING:
    from symobs.system import StateSpace


def page_style(method_name: str, plant: StateSpace, *, several: bool = False) -> str:
    """Return the method whose page is printed: canonical form for small plants unless one was asked for."""
    if method_name != "auto":
        return method_name
    if several:
        return "sylvester"
    readable = (
        readability.CANONICAL_FORM_ORDER if not plant.field.names else readability.PARAMETRIC_CANONICAL_FORM_ORDER
    )
    return "canonical_form" if plant.order <= readable else "ackermann"
