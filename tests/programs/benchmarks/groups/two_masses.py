"""K, L and F of two coupled masses with eight symbolic poles."""

from __future__ import annotations

from typing import TYPE_CHECKING

from tests.programs.benchmarks import designs, models

if TYPE_CHECKING:
    from collections.abc import Iterator

    from tests.programs.benchmarks.measuring import Row, Settings

PLACE = 2


def rows(settings: Settings) -> Iterator[Row]:
    """Yield symobs beside giac, Maxima and SymPy."""
    work = "two masses, 12 symbols: K, L, F"
    yield from designs.beside_systems(work, "two_masses_", models.two_masses, "", settings)
    yield from designs.beside_sympy(work, [("compensator_field", "two_masses")], models.two_masses, settings.limit)
