"""Outputs that a plant can show, and plants that vary with time."""

from __future__ import annotations

from fractions import Fraction
from math import factorial
from typing import TYPE_CHECKING, Any

from tests.programs.campaign.asked import text_of

if TYPE_CHECKING:
    from random import Random

    from tests.programs.campaign.shapes import Shape


def output_of(random: Random, shape: Shape) -> dict[str, Any] | None:
    """Return y(t) = C e^{At} x₀ for a plant made of Jordan blocks, sometimes with a term that cannot be explained."""
    if shape.jordan is None or shape.order > 3:
        return None
    T, blocks, back = shape.jordan
    start = [Fraction(random.randint(-3, 3)) for _ in range(shape.order)]
    inner = [sum((a * b for a, b in zip(row, start, strict=True)), Fraction()) for row in back]
    motion: list[dict[tuple[int, int], Fraction]] = []
    place = 0
    for value, size in blocks:
        for k in range(size):
            terms: dict[tuple[int, int], Fraction] = {}
            for j in range(k, size):
                terms[value, j - k] = inner[place + j] / factorial(j - k)
            motion.append(terms)
        place += size
    seen = [
        [sum((Fraction(c) * T[i][j] for i, c in enumerate(row)), Fraction()) for j in range(shape.order)]
        for row in shape.C
    ]
    outputs = [_combined(row, motion) for row in seen]
    if random.random() < 0.2:
        outputs[0] += random.choice([" + 1", " + t", " + exp(-t)", " + t^4"])
    asked: dict[str, Any] = {"horizon": "T", "symbols": {"T": "positive"}}
    return {**asked, "output": outputs[0] if len(outputs) == 1 else outputs, "input": _nothing(shape.inputs)}


def _nothing(inputs: int) -> Any:
    return "0" if inputs == 1 else ["0"] * inputs


def _combined(row: list[Fraction], motion: list[dict[tuple[int, int], Fraction]]) -> str:
    total: dict[tuple[int, int], Fraction] = {}
    for weight, terms in zip(row, motion, strict=True):
        for key, value in terms.items():
            total[key] = total.get(key, Fraction()) + weight * value
    parts = [f"({value})*t^{power}*exp({rate}*t)" for (rate, power), value in total.items() if value]
    return " + ".join(parts) or "0"


_ENTRIES = ["t", "t^2", "1", "0", "0", "-t", "t+1", "2", "-1", "1/(t^2+1)"]


def time_varying(random: Random, shape: Shape) -> dict[str, Any]:
    """Return a plant some of whose entries depend on t."""
    order, outputs = shape.order, min(shape.outputs, 2)
    shape.signs = {}

    def table(rows: int, columns: int) -> str:
        return text_of([[random.choice(_ENTRIES) for _ in range(columns)] for _ in range(rows)])

    return {"A": table(order, order), "C": table(outputs, order)}
