"""The figures of docs/believe.md, measured and drawn anew: `python -m tests.programs.believe`, some minutes.

`changed.svg` shows what became of answers and lines that were changed on purpose, in one worked example of each of some
tasks; a change that is neither refused nor proved to be true ends the program.  `cost.svg` shows what the checks take of the
processor time of a page.
"""

from __future__ import annotations

import random
import sys
from contextlib import contextmanager
from pathlib import Path
from time import process_time
from typing import TYPE_CHECKING, Any

import symobs
from symobs.proof.derivation import Derivation
from symobs.tasks.result import result
from tests.support.examples import results_of
from tests.support.tampering.lies import Count, try_answers, try_lines, try_witnesses
from tests.support.tampering.mutations import parts_of

if TYPE_CHECKING:
    from collections.abc import Iterator

FOLDER = Path(__file__).parents[2] / "docs" / "figures"
#: An example of each task that is shown, and the name of the task as the figure has it.
SHOWN = {
    "third_order_plant": "observability",
    "cart_pendulum_feedback": "state feedback",
    "servo_observer": "observer",
    "servo_minimal_order": "compensator",
    "lqr": "optimal gain",
    "region_two_intervals": "stability region",
    "margins_compensator": "margins",
}
_ORDERS, _OF_EACH, _SEED = range(2, 9), 5, 20_263
_COLOURS = {"refused": "#3b6ea5", "another truth": "#b9cde3"}


def counted(example: str) -> tuple[Count, Count]:
    """Return what became of the changed answers and of the changed lines of an example."""
    answers, lines = Count(), Count()
    for found in results_of(example):
        for where, part in parts_of(found):
            try_answers(part, where, answers)
            try_witnesses(part, where, answers)
        try_lines(found, lines)
    if answers.lies or lines.lies:
        sys.exit(f"{example}: not refused, and not proved to be true: {answers.lies + lines.lies}")
    return answers, lines


@contextmanager
def timed(owner: Any, name: str, spent: list[float]) -> Iterator[None]:
    """Add up the processor time of a function while this lasts."""
    plain = getattr(owner, name)

    def measured(*values: Any, **named: Any) -> Any:
        begin = process_time()
        try:
            return plain(*values, **named)
        finally:
            spent.append(process_time() - begin)

    setattr(owner, name, measured)
    try:
        yield
    finally:
        setattr(owner, name, plain)


def costs(order: int, generator: random.Random) -> tuple[float, float, float, float]:
    """Return the seconds of finding a compensator, checking its claims, writing its page, and checking the lines."""
    entries = [[generator.randint(-3, 3) for _ in range(order)] for _ in range(order)]
    plant = symobs.StateSpace(entries, [generator.randint(1, 3) for _ in range(order)], [[1] + [0] * (order - 1)])
    poles = [-k for k in range(1, order + 1)]
    claims, lines = list[float](), list[float]()
    with timed(result, "check_all", claims), timed(Derivation, "check", lines):
        begin = process_time()
        found = symobs.compensator(plant, control_poles=poles, observer_poles=[2 * pole for pole in poles])
        middle = process_time()
        found.to("latex")
        end = process_time()
    return middle - begin - sum(claims), sum(claims), end - middle - sum(lines), sum(lines)


def draw_changed(found: dict[str, tuple[Count, Count]]) -> None:
    """Draw what became of the changes of answers and of lines, and say how many there were."""
    from matplotlib.figure import Figure  # noqa: PLC0415 - an extra

    figure = Figure(figsize=(7, 2.8), layout="constrained")
    for place, (title, axes) in enumerate(
        zip(("answers", "lines of pages"), figure.subplots(1, 2, sharey=True), strict=True)
    ):
        for row, counts in enumerate(reversed(found.values())):
            count, left = counts[place], 0.0
            for kind, number in (("refused", count.rejected), ("another truth", count.true)):
                share = 100 * number / count.tried
                axes.barh(row, share, left=left, color=_COLOURS[kind], label=kind if not row else None)
                left += share
            axes.text(1, row, f"{count.tried} changed", va="center", color="white", fontsize=8)
        axes.set_yticks(range(len(found)), [*reversed(found)])
        axes.set_xlabel(f"changed {title}, %")
        axes.set_xlim(0, 100)
    figure.legend(*axes.get_legend_handles_labels(), loc="outside upper center", ncols=2, frameon=False)
    save(figure, "changed")


def draw_costs(found: dict[int, list[float]]) -> None:
    """Draw the shares of finding, checking and writing in the processor time, by the order of the plant."""
    from matplotlib.figure import Figure  # noqa: PLC0415 - an extra

    figure = Figure(figsize=(7, 2.6), layout="constrained")
    axes = figure.subplots()
    kinds = ("finding the answer", "checking its claims", "writing the page", "checking its lines")
    below = [0.0] * len(found)
    for part, (kind, colour) in enumerate(zip(kinds, ("#b9cde3", "#3b6ea5", "#e8d8b0", "#b5892f"), strict=True)):
        shares = [100 * times[part] / sum(times) for times in found.values()]
        axes.bar([str(order) for order in found], shares, bottom=below, color=colour, label=kind, width=0.7)
        below = [low + share for low, share in zip(below, shares, strict=True)]
    axes.set_xlabel("order of the plant")
    axes.set_ylabel("processor time, %")
    figure.legend(loc="outside right center", frameon=False, reverse=True)
    save(figure, "cost")


def save(figure: Any, name: str) -> None:
    """Write a figure, the same bytes for the same numbers."""
    figure.savefig(FOLDER / f"{name}.svg", metadata={"Date": None})


def main() -> None:
    """Measure, and write both figures."""
    import matplotlib as mpl  # noqa: PLC0415 - an extra

    mpl.use("svg")
    mpl.rcParams.update(
        {"svg.hashsalt": "symobs", "font.size": 9, "axes.spines.top": False, "axes.spines.right": False}
    )
    FOLDER.mkdir(exist_ok=True)
    draw_changed({name: counted(example) for example, name in SHOWN.items()})
    generator = random.Random(_SEED)  # noqa: S311 - plants for a figure
    costs(2, generator)  # what is loaded late is no part of a page
    spent = {order: [costs(order, generator) for _ in range(_OF_EACH)] for order in _ORDERS}
    draw_costs({order: list(map(sum, zip(*each, strict=True))) for order, each in spent.items()})


if __name__ == "__main__":
    main()
