"""The picture of a class: what became of each part, and which slips were made where, as bars."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

from symobs.pages.drawings.scene import FONT_SIZE, Rectangle, Scene, Stroke, TextLabel
from symobs.pages.drawings.svg import measure_for, svg
from symobs.pages.printers.text_printer import TextPrinter

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

#: In points: the height of a row and of its bar, the longest bar, and what is left free around and between.
_ROW, _BAR, _LONGEST, _MARGIN, _GAP = 15.0, 9.0, 220.0, 6.0, 5.0


class Bar(NamedTuple):
    """A row: a part with how many were right, or what became of some of the others."""

    text: str
    number: int
    is_part: bool = False


def picture(found: Mapping[str, Any]) -> str:
    """Return the summary of a class as an SVG file: of each part how many were right, and what went wrong."""
    printer, bars = TextPrinter(), list(_bars(found))
    measure = measure_for(printer)
    beside = max((measure(bar.text)[0] for bar in bars), default=0.0) + _GAP
    scale = _LONGEST / max(1, found["students"])
    shades, texts = [], []
    for place, bar in enumerate(bars):
        y = -_ROW * (place + 0.5)
        texts.append(TextLabel(bar.text, (0.0 if bar.is_part else beside, y), "west" if bar.is_part else "east"))
        length = beside + _GAP + scale * bar.number
        low, high = y - _BAR / 2, y + _BAR / 2
        shades.append(((beside + _GAP, low), (length, low), (length, high), (beside + _GAP, high)))
        texts.append(TextLabel(str(bar.number), (length + _GAP, y), "west"))
    height = _ROW * len(bars)
    frame = Rectangle(0.0, -height, beside + 2 * _GAP + _LONGEST + 4 * FONT_SIZE, 0.0)
    axis = Stroke(((beside + _GAP, 0.0), (beside + _GAP, -height)), "tick")
    scene = Scene(frame, frame.grown(_MARGIN), tuple(shades), (axis,), texts=tuple(texts))
    return svg(scene, printer, f"What became of the answers of {found['students']} students", alone=True) + "\n"


def _bars(found: Mapping[str, Any]) -> Iterator[Bar]:
    """Yield the rows, a part and what went wrong in it."""
    for part, verdicts in found["parts"].items():
        yield Bar(f"{part}: right", verdicts.get("right", 0), is_part=True)
        slips = [(entry["slip"].replace("_", " "), entry["count"]) for entry in found["slips"][part]]
        unexplained = verdicts.get("wrong", 0) - sum(count for _, count in slips)
        others = [("wrong, without a known slip", unexplained)]
        others += [(verdict, count) for verdict, count in verdicts.items() if verdict not in {"right", "wrong"}]
        for text, count in sorted([*slips, *others], key=lambda row: (-row[1], row[0])):
            if count:
                yield Bar(text, count)
