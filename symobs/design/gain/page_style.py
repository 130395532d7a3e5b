"""Choice of the derivation for a gain: canonical form for small plants, else a general formula."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from symobs.system import StateSpace


def page_style(method_name: str, plant: StateSpace, *, several: bool = False) -> str:
    """Return the method whose page is printed: canonical form for small plants unless one was asked for."""
    if method_name != "auto":
        return method_name
    if several:
        return "sylvester"
    readable = _CANONICAL_PAGES if not plant.field.names else _PARAMETRIC_CANONICAL_PAGES
    return "canonical_form" if plant.order <= readable else "ackermann"


#: Up to these orders the matrices of the canonical form are easier to read than Ackermann's formula.
_CANONICAL_PAGES, _PARAMETRIC_CANONICAL_PAGES = 4, 2
