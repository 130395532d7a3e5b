"""Modules that are imported when something of them is first used: to discover the tasks is not to load NumPy."""

from __future__ import annotations

from importlib import import_module
from typing import Any


class Later:
    """A module by its name; type checkers see the module itself."""

    def __init__(self, name: str) -> None:
        """Remember the name."""
        self._name = name

    def __getattr__(self, name: str) -> Any:
        """Return an attribute of the module, which is imported now."""
        return getattr(import_module(self._name), name)
