"""What problems that tests write out by hand in SymPy are compared with."""

from __future__ import annotations

from typing import Any

import sympy


def is_zero(expression: Any) -> bool:
    """Whether a rational expression is 0."""
    return bool(sympy.expand(sympy.together(expression).as_numer_denom()[0]) == 0)
