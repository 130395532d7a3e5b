"""Regions of stability at random: a polynomial with free coefficients, or a plant with a gain some of whose entries are."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from tests.programs.campaign import shapes
from tests.programs.campaign.asked import text_of

if TYPE_CHECKING:
    from random import Random

    from tests.programs.campaign.shapes import Shape

_FORMS = ["{0}", "{0}", "2*{0}+1", "{0}-3", "1-{0}", "{0}+{1}", "{0}*{1}", "{0}^2", "{0}^2-{1}", "{0}/2-1/3"]
#: For coefficients in which symbols with a sign stand beside the free gains.
_WITH_SYMBOLS = ["b+{0}", "b*{0}", "w^2*(1-{0})", "b", "w*{0}-b"]


def drawn(random: Random, shape: Shape) -> dict[str, Any]:
    """Return a specification, with the symbols to declare and the plant in place of the one drawn."""
    names = ["h1", "h2"][: random.choice([1, 1, 2])]
    found = _of_a_plant(random, names) if random.random() < 0.5 else _of_a_polynomial(random, shape, names)
    if random.random() < 0.15:
        found["radius" if shape.discrete else "margin"] = random.choice(["1/2", "1/3"])
    shape.signs = {}
    return found


def _of_a_plant(random: Random, names: list[str]) -> dict[str, Any]:
    """One free gain, or two, among numbers: those of an observer or of a state feedback."""
    order = random.randint(len(names), 3 if len(names) > 1 else 4)
    made = shapes.numeric(random, order, 1, 1)
    entries = [*names, *(str(random.randint(-2, 6)) for _ in range(order - len(names)))]
    random.shuffle(entries)
    gain = {"L": text_of([[entry] for entry in entries])} if random.random() < 0.5 else {"K": text_of([entries])}
    plant = {letter: text_of(getattr(made, letter)) for letter in "ABC"}
    return {**gain, "parameters": ", ".join(names), "symbols": dict.fromkeys(names, "real"), "plant": plant}


def _of_a_polynomial(random: Random, shape: Shape, names: list[str]) -> dict[str, Any]:
    s = "z" if shape.discrete else "s"
    degree = random.randint(1, 3 if len(names) > 1 else 4)
    forms = _FORMS + (_WITH_SYMBOLS if random.random() < 0.2 else [])
    terms = [f"{s}^{degree}"]
    for power in range(degree - 1, -1, -1):
        free = random.random() < 0.6 or power == 0
        form = random.choice(forms).format(random.choice(names), random.choice(names))
        terms.append(f"({form if free else random.randint(1, 6)})*{s}^{power}")
    text = " + ".join(terms)
    used = [name for name in names if name in text] or names[:1]
    symbols = {name: "positive" for name in ("b", "w") if name in text}
    return {
        "polynomial": text,
        "parameters": ", ".join(used),
        "symbols": {**dict.fromkeys(used, "real"), **symbols},
        "plant": {},
    }
