"""The plants and specifications that are timed, as the texts a user writes, with fresh names each time."""

from __future__ import annotations

import itertools
from dataclasses import dataclass
from fractions import Fraction
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Mapping

_SERIAL = itertools.count()


@dataclass(frozen=True)
class Model:
    """A plant as text, what is asked of it, and the plain name of each symbol."""

    A: str
    B: str | None
    C: str
    control_poles: tuple[str, ...]
    observer_poles: tuple[str, ...]
    plain: Mapping[str, str]


def cart_pole() -> Model:
    """An inverted pendulum on a cart: states position, velocity, angle, angular velocity; eight symbolic poles."""
    names = _fresh(["M", "m", "l", "g", "b", *_numbered("p", 4), *_numbered("q", 4)])
    A = "[0 1 0 0; 0 -{b}/{M} -{m}*{g}/{M} 0; 0 0 0 1; 0 {b}/({M}*{l}) ({M} + {m})*{g}/({M}*{l}) 0]"
    return Model(
        A.format(**names),
        "[0; 1/{M}; 0; -1/({M}*{l})]".format(**names),
        "[1 0 0 0]",
        tuple(f"-{names[name]}" for name in _numbered("p", 4)),
        tuple(f"-{names[name]}" for name in _numbered("q", 4)),
        _reversed(names),
    )


def two_masses() -> Model:
    """Two masses, a spring and a damper; the force acts on one, the place of the other is measured; eight symbolic poles."""
    names = _fresh(["m1", "m2", "k", "d", *_numbered("p", 4), *_numbered("q", 4)])
    A = "[0 0 1 0; 0 0 0 1; -{k}/{m1} {k}/{m1} -{d}/{m1} {d}/{m1}; {k}/{m2} -{k}/{m2} {d}/{m2} -{d}/{m2}]"
    return Model(
        A.format(**names),
        "[0; 0; 1/{m1}; 0]".format(**names),
        "[0 1 0 0]",
        tuple(f"-{names[name]}" for name in _numbered("p", 4)),
        tuple(f"-{names[name]}" for name in _numbered("q", 4)),
        _reversed(names),
    )


def generic(order: int) -> Model:
    """A plant whose A and C are made of different symbols, with symbolic observer poles."""
    entries = [[f"a{i}{j}" for j in range(1, order + 1)] for i in range(1, order + 1)]
    names = _fresh([*itertools.chain(*entries), *_numbered("c", order), *_numbered("p", order)])
    return Model(
        "[" + "; ".join(" ".join(names[entry] for entry in row) for row in entries) + "]",
        None,
        "[" + " ".join(names[name] for name in _numbered("c", order)) + "]",
        (),
        tuple(f"-{names[name]}" for name in _numbered("p", order)),
        _reversed(names),
    )


def rational(order: int) -> tuple[list[list[Fraction]], list[list[Fraction]], list[int]]:
    """Return the dense rational A and C of `pari/*.gp`, and the poles −1 … −n."""
    indices = range(1, order + 1)
    A = [
        [Fraction((i**3 + 7 * i * j**2 + 5 * i * j + 11 * j) % 101 - 50, (3 * i + j**2) % 7 + 1) for j in indices]
        for i in indices
    ]
    C = [[Fraction((j**3 + 3 * j) % 101 - 50) for j in indices]]
    return A, C, [-k for k in indices]


def _numbered(stem: str, count: int) -> list[str]:
    return [f"{stem}{k}" for k in range(1, count + 1)]


def _fresh(names: list[str]) -> dict[str, str]:
    """Return each name with a suffix that no earlier model had."""
    suffix = f"_{next(_SERIAL)}"
    return {name: name + suffix for name in names}


def _reversed(names: Mapping[str, str]) -> dict[str, str]:
    return {fresh: name for name, fresh in names.items()}
