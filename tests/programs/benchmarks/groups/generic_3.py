"""L of the generic third-order plant, three symbolic poles."""

from __future__ import annotations

from typing import TYPE_CHECKING

from tests.programs.benchmarks import designs, models

if TYPE_CHECKING:
    from collections.abc import Iterator

    from tests.programs.benchmarks.measuring import Row, Settings
    from tests.programs.benchmarks.models import Model

PLACE = 3


def rows(settings: Settings) -> Iterator[Row]:
    """Yield symobs beside giac, Maxima, FLINT alone and SymPy."""
    work = "generic 3x3, 15 symbols: L"
    yield from designs.beside_systems(work, "generic_", _plant, ">= 50", settings)
    yield from designs.beside_flint(work, 3, 5 * settings.repetitions, "", _plant)
    yield from designs.beside_sympy(work, [("generic_field", "3"), ("generic_ring",)], _plant, settings.limit)


def _plant() -> Model:
    return models.generic(3)
