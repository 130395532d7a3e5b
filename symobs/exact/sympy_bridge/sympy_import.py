"""SymPy, imported whole or not at all.

Its import takes a while, and an interrupt or a time limit may end it.  Python then forgets the package but keeps those of
its modules that were ready, which the next import does not bind to the package again: a session would be without
`sympy.polys` for good.
"""

from __future__ import annotations

import sys

__all__ = ["sympy"]

_BEFORE = frozenset(sys.modules)

try:
    import sympy
except BaseException:
    for name in sys.modules.keys() - _BEFORE:
        if name.partition(".")[0] in {"sympy", "mpmath"}:
            del sys.modules[name]
    raise
