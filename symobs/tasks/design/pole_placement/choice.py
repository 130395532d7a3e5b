"""Which gain is taken where several place the poles: the simple one, or a small one near the best conditioned placement."""

from __future__ import annotations

from typing import TYPE_CHECKING

from symobs.exact import factored, rank
from symobs.tasks.design.pole_placement.multiple_outputs import MultiOutputPair

if TYPE_CHECKING:
    from symobs.exact import Matrix
    from symobs.system.specification import DesiredPolynomial
    from symobs.tasks.design.pole_placement.single_output import ObserverPair
    from symobs.tasks.design.pole_placement.small_gain import Small


def small_gain(pair: ObserverPair, desired: DesiredPolynomial, simple: Matrix) -> Small | None:
    """Return a small gain of an observable pair of several outputs in place of the simple one; None where that stays."""
    if desired.choose == "simple" or why_simple(pair, desired) or not isinstance(pair, MultiOutputPair):
        return None
    from symobs.tasks.design.pole_placement import small_gain as search  # noqa: PLC0415 - NumPy is loaded for it alone

    return search.small_gain(pair, desired, simple, asked=desired.choose == "small")


def why_simple(pair: ObserverPair, desired: DesiredPolynomial) -> str:
    """Return why no small gain is looked for: one output, hidden modes, letters or poles wanted too often; else nothing."""
    if not isinstance(pair, MultiOutputPair):
        return "one"
    if pair.A.names or pair.c.names or not desired.is_numeric:
        return "letters"
    if not pair.is_observable:
        return "hidden"
    repeated = max(power for _, power in factored(desired.polynomial, desired.variable).factors)
    return "repeated" if repeated > rank(pair.c) else ""
