"""The time domain as a type: `Continuous`, `TimeVarying` or `Discrete`."""

from __future__ import annotations

from typing import TYPE_CHECKING

from symobs.ground.dataclass import dataclass
from symobs.ground.errors import InputError
from symobs.system.reading import read_scalar

if TYPE_CHECKING:
    from symobs.exact import Scalar
    from symobs.system.symbols import Symbols


@dataclass(frozen=True)
class Continuous:
    """Continuous time: ẋ, the variable s, stability in the open left half-plane."""

    variable = "s"


@dataclass(frozen=True)
class TimeVarying(Continuous):
    """Continuous time t, which the matrices themselves may contain: ẋ = A(t) x + B(t) u."""

    variable = "t"


@dataclass(frozen=True)
class Discrete:
    """Discrete time: x(k+1), the variable z, stability in the open unit disc; `period` if it is known."""

    period: Scalar | None = None
    variable = "z"


TimeDomain = Continuous | Discrete


def read_time(dt: object, symbols: Symbols) -> TimeDomain:
    """Return the time domain of `dt`: 0 is continuous, True or a positive value discrete."""
    if dt is True:
        return Discrete()
    if dt is False or dt is None:
        return Continuous()
    value = read_scalar(str(dt) if isinstance(dt, float) else dt, symbols, "plant.dt")
    if value.is_zero:
        return Continuous()
    if not value.is_constant or value.fraction() <= 0:
        message = f"{value} is not a sampling period"
        raise InputError(message, where="plant.dt", repair="write 0 for continuous time, true or a positive number")
    return Discrete(value)
