"""Live under its public name: `symobs.live(…)` in a notebook, `symobs.live.answer`, `python -m symobs.live.site`."""

from __future__ import annotations

import sys
from types import ModuleType
from typing import TYPE_CHECKING, Any

from symobs.applications.live import __path__ as __path__  # noqa: PLC0414 - `python -m` finds the site below this name
from symobs.applications.live import answer, live

if TYPE_CHECKING:
    from symobs.applications.live.notebook import LiveWidget

__all__ = ["answer", "live"]


class _Called(ModuleType):
    """A module that is called as its function of the same name."""

    def __call__(self, *arguments: Any, **keywords: Any) -> LiveWidget:
        """Return the widget."""
        return live(*arguments, **keywords)


sys.modules[__name__].__class__ = _Called
