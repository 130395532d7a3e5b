"""What advice on poles claims, checked at a point with 60 digits: the plant's zeros, Butterworth's identity, the pair."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from symobs.exact import Root
from tests.support.algebra import CONTEXT, characteristic, digits, multiply, subtract
from tests.support.derivations import World

if TYPE_CHECKING:
    from fractions import Fraction

    from tests.support.claims.claims import Setting

_NEAR = CONTEXT.mpf(10) ** -12


def number(value: Any) -> Any:
    """Return a value of the point with 60 digits."""
    return digits(getattr(value, "parts", [value])[0])


def coefficients(world: World, value: Any) -> list[Any]:
    """Return the coefficients of a factored polynomial, highest first, multiplied out here."""
    total = [number(world.scalar(value.unit))]
    for factor, power in value.factors:
        part = [number(c) for c in reversed(world.coefficients(factor))]
        for _ in range(power):
            total = product(total, part)
    return total


def product(left: list[Any], right: list[Any]) -> list[Any]:
    found = [CONTEXT.mpf(0)] * (len(left) + len(right) - 1)
    for i, a in enumerate(left):
        for j, b in enumerate(right):
            found[i + j] += a * b
    return found


def near(left: list[Any], right: list[Any]) -> bool:
    size = max([1, *map(abs, left), *map(abs, right)])
    return len(left) == len(right) and all(abs(a - b) <= _NEAR * size for a, b in zip(left, right, strict=True))


def value_of(polynomial: list[Any], at: Any) -> Any:
    return CONTEXT.polyval(polynomial, at)


def numerator(at: Setting) -> list[Fraction]:
    """Return C adj(sI − A) B + D det(sI − A)."""
    chi, moved = characteristic(at.A), characteristic(subtract(at.A, multiply(at.B, at.C)))
    return [b - a + at.D[0][0] * a for a, b in zip(chi, moved, strict=True)]  # det(sI − A + BC) = χ + C adj(sI − A) B


def places(world: World, poles: Any) -> list[Any]:
    """Return complex numbers; of roots without a form those of their factor, each once."""
    found, seen = [], set()
    for pole in poles:
        if not isinstance(pole, Root):
            found.append(CONTEXT.mpc(number(world.scalar(pole.real)), number(world.scalar(pole.imaginary))))
        elif pole.is_closed:
            radicand = number(world.scalar(pole.radicand))
            found.append(number(world.scalar(pole.centre)) + pole.sign * CONTEXT.sqrt(radicand))
        elif (pole.factor, pole.index) not in seen:
            seen.add((pole.factor, pole.index))
            every = CONTEXT.polyroots([number(c) for c in reversed(world.coefficients(pole.factor))], extraprec=200)
            found.append(sorted(every, key=lambda z: (z.imag != 0, z.real, z.imag))[pole.index])
    return found


def assert_all_are_used(warnings: list[str], above: list[Any], count: int) -> None:
    """Hold the number of zeros that are used to that of the numerator's roots in the left half-plane."""
    open_words = ("on both sides", "depends on", "are all the zeros")
    if any(words in warning for warning in warnings for words in open_words):
        return
    while above and not above[0]:
        above = above[1:]
    roots = CONTEXT.polyroots(above, maxsteps=500, extraprec=400, error=False) if len(above) > 1 else []
    assert sum(root.real < -(10**-6) for root in roots) <= count <= sum(root.real < 10**-6 for root in roots)


def advice_holds(result: Any, at: Setting) -> None:
    world = World(0, result.plant.variable, result.plant.symbols.signs, meanings=dict(at.point))
    whole = coefficients(world, result.fields["polynomial"])
    poles, zeros = places(world, result.fields["poles"]), places(world, result.fields["zeros_used"])
    assert len(poles) == len(at.A) == len(whole) - 1
    rebuilt = [CONTEXT.mpf(1)]
    for pole in poles:
        rebuilt = product(rebuilt, [1, -pole])
    assert near(rebuilt, whole)
    above = [digits(c) for c in numerator(at)]
    for zero in zeros:
        assert zero.real < 0
        assert abs(value_of(above, zero)) <= _NEAR * sum(abs(c) * (1 + abs(zero)) ** len(above) for c in above)
    others = poles[len(zeros) :]
    if result.request.radius is not None:
        assert_all_are_used(result.fields["warnings"], above, len(zeros))
        radius, count = number(world.scalar(result.request.radius)), len(others)
        wanted = [(-1) ** count, *[0] * (2 * count - 1), radius ** (2 * count)] if count else [CONTEXT.mpf(2)]
        mirrored = [CONTEXT.mpf((-1) ** count)]  # p(-s) = (-1)^N prod (s + pole)
        for pole in others:
            mirrored = product(product(mirrored, [1, -pole]), [1, pole])
        assert not count or near(mirrored, wanted)
        assert radius <= 0 or all(pole.real < 0 for pole in others)
        return
    sigma = 4 / number(world.scalar(result.request.settling_time))
    assert near([number(world.scalar(result.fields["sigma"]))], [sigma])
    assert all(pole.real <= -sigma for pole in poles)
    for pole in others:
        if pole.imag:
            assert CONTEXT.exp(CONTEXT.pi * pole.real / abs(pole.imag)) <= number(
                world.scalar(result.request.overshoot)
            )
            assert pole.real == -sigma
        else:
            assert pole.real <= -5 * sigma or len(others) == 1
