"""L of the generic fourth-order plant, four symbolic poles: 41,448 terms an entry."""

from __future__ import annotations

from typing import TYPE_CHECKING

from tests.programs.benchmarks import designs, models
from tests.programs.benchmarks.measuring import Row, Settings

if TYPE_CHECKING:
    from collections.abc import Iterator

    from tests.programs.benchmarks.models import Model

PLACE = 4


def rows(settings: Settings) -> Iterator[Row]:
    """Yield symobs beside FLINT alone, giac, Maxima and SymPy, each of which runs once."""
    work = "generic 4x4, 24 symbols: L"
    yield from designs.beside_flint(work, 4, settings.repetitions, "<= 4", _plant)
    yield from designs.beside_systems(work, "generic4_", _plant, "", Settings(1, settings.limit))
    yield from designs.beside_sympy(work, [("generic_field", "4")], _plant, settings.limit)
    yield Row("its conditions, when asked for", designs.conditions(_plant))


def _plant() -> Model:
    return models.generic(4)
