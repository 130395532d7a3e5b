"""K, L and F of the cart-pole with eight symbolic poles."""

from __future__ import annotations

from typing import TYPE_CHECKING

from tests.programs.benchmarks import designs, models
from tests.programs.benchmarks.measuring import Row, medians

if TYPE_CHECKING:
    from collections.abc import Iterator

    from tests.programs.benchmarks.measuring import Settings

PLACE = 1


def rows(settings: Settings) -> Iterator[Row]:
    """Yield symobs beside giac, Maxima and SymPy."""
    work = "cart-pole, 13 symbols: K, L, F"
    yield from designs.beside_systems(work, "cart_pole_", models.cart_pole, ">= 40", settings)
    calls = [("compensator_field", "cart_pole")]
    yield from designs.beside_sympy(work, calls, models.cart_pole, settings.limit)
    yield Row("its conditions, when asked for", medians(5, {"": lambda: designs.conditions(models.cart_pole)})[""])
