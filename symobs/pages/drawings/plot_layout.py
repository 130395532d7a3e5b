"""Layout of plots: frames, ticks and labels."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise
from math import ceil, cos, dist, floor, hypot, log10, pi, sin
from typing import TYPE_CHECKING, assert_never

from symobs.exact import Scalar
from symobs.formula.figures import (
    BodePicture,
    BranchPicture,
    End,
    LinePicture,
    NyquistPicture,
    PoleMap,
    RegionPicture,
    SweepCurves,
    SweepMap,
    TimeResponse,
)
from symobs.formula.tree import Decimals, Literal, Relation
from symobs.pages.drawings.curve_labels import Frame, Surroundings, chained, labelled, segment_in, walk
from symobs.pages.drawings.scene import RADIUS, Rectangle, Scene, Sign, Stroke, TextLabel, whole_of
from symobs.pages.page.plot_captions import drawn, name_of, part, radius_of, symbol, time_axis

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator, Sequence
    from fractions import Fraction

    from symobs.formula.figures import Drawn, Interval, Place, PlottedResponse, Run
    from symobs.formula.phrases.languages import Language
    from symobs.formula.tree import Formula
    from symobs.pages.drawings.scene import Content, Measure, Point

    #: The name of a curve, its range, and its lines in a frame.
    _Panel = tuple[Content, tuple[float, float], Callable[[Frame], list[tuple[Point, ...]]]]
    _Mark = tuple[str, Sequence[Place]]  # in a style

WIDEST, HIGHEST = 270.0, 160.0  # points
_LINE, _LONGEST_END = 290.0, 0.3
_TIME_HEIGHT = 80.0
_SMALLEST_SIDE = 100.0
#: Windows that are not much longer than high are drawn with equal scales.
_EQUAL_UP_TO = 2.0
#: A line of a map that is shorter is a corner of what has no values.
_SHORTEST = 2.0
_TICK, _BEYOND, _LETTER = 3.0, 11.0, 4.0
_TICKS = 5
_CURVES = {True: "boundary", False: "divider"}
#: The styles of the components of a signal; beside an estimate, which is dashed, they differ in width and colour.
_COMPONENTS = ("path", "path 2", "path 3", "path 4")
_BESIDE_ESTIMATE = {False: ("path", "state 2", "state 3"), True: ("estimate", "estimate 2", "estimate 3")}
#: Signals whose largest values differ by more than this factor have an axis each, of this height and distance.
_ONE_AXIS, _PANEL, _BETWEEN_PANELS = 4, 48.0, 26.0
#: From so many signals on the panels stand in two columns, so far apart.
_TWO_COLUMNS, _BETWEEN_COLUMNS = 5, 44.0
#: The height of a panel over the logarithm of the frequency.
_DECADES = 84.0
_SIGNS = {"stable": "dot", "unstable": "cross", "excluded": "ring"}


def plot_scene(picture: Drawn, measure: Measure, language: Language) -> Scene:
    """Return the scene of a plot on paper, its decimals in a language; `measure` gives the size of text in a format."""
    scene = _scene(picture, measure)
    texts = [
        replace(text, content=language.decimal(text.content)) if isinstance(text.content, str) else text
        for text in scene.texts
    ]
    return replace(scene, texts=tuple(texts))


def _scene(picture: Drawn, measure: Measure) -> Scene:
    match picture:
        case RegionPicture():
            return _region(picture, measure)
        case LinePicture():
            return _line(picture, measure)
        case PoleMap():
            return _poles(picture, measure)
        case TimeResponse():
            return _responses(picture, measure)
        case NyquistPicture():
            return _nyquist(picture, measure)
        case BodePicture():
            return _bode(picture, measure)
        case BranchPicture():
            return _branches(picture, measure)
        case SweepCurves():
            return _curves(picture, measure)
        case SweepMap():
            return _map(picture, measure)
        case _:
            assert_never(picture)


def _decimal(interval: Interval) -> tuple[float, float]:
    return float(interval[0]), float(interval[1])


# -- regions ----------------------------------------------------------------------------------------------------------


def _region(picture: RegionPicture, measure: Measure) -> Scene:
    frame = _frame_of(picture.window)
    shades = tuple(part for area in picture.areas for part in frame.areas(area))
    runs: dict[tuple[Relation, bool], list[tuple[Point, ...]]] = {}
    for curve in drawn(picture):
        runs.setdefault((curve.equation, curve.boundary), []).extend(frame.lines(curve.points))
    curves = {key: chained(lines) for key, lines in runs.items() if lines}
    strokes = [Stroke(line, _CURVES[boundary]) for (_, boundary), lines in curves.items() for line in lines]
    signs = tuple(Sign("ring", frame.at(*mark.place)) for mark in picture.marks if mark.kind == "excluded")
    lines = tuple(stroke.points for stroke in strokes)
    pale = tuple(_zero_lines(frame))
    around = Surroundings(frame.box, lines, tuple(_box(sign) for sign in signs), pale, shades)
    boundaries = {equation: tuple(lines) for (equation, boundary), lines in curves.items() if boundary}
    labels, numbered = labelled(boundaries, around, measure)
    axes, written = _axes(frame, (symbol(picture.axes[0]), symbol(picture.axes[1])), measure)
    crossed = [text.box(measure(text.content)).grown(1.0) for text in labels]
    zeros = [Stroke(piece, "zero") for line in pale for piece in _between(line, crossed)]
    texts = (*written, *labels)
    whole = whole_of(axes, texts, measure)
    return Scene(frame.box, whole, shades, (*zeros, *axes, *strokes), (), signs, texts, tuple(numbered))


def _between(line: tuple[Point, Point], boxes: Iterable[Rectangle]) -> list[tuple[Point, Point]]:
    """Return the parts of a horizontal or vertical line outside boxes."""
    pieces = [line]
    for box in boxes:
        crossed = [(piece, segment_in(*piece, box)) for piece in pieces]
        pieces = []
        for piece, inside in crossed:
            pieces += [piece] if inside is None else [(piece[0], inside[0]), (inside[1], piece[1])]
    return [(a, b) for a, b in pieces if a != b]


def _frame_of(window: tuple[Interval, Interval]) -> Frame:
    """Return the frame of a window, with equal scales unless that makes it a strip."""
    horizontal, vertical = map(_decimal, window)
    ratio = (horizontal[1] - horizontal[0]) / (vertical[1] - vertical[0])
    if not 1 / _EQUAL_UP_TO <= ratio <= _EQUAL_UP_TO:
        ratio = WIDEST / HIGHEST
    width = min(WIDEST, ratio * HIGHEST)
    return Frame(horizontal, vertical, width, width / ratio)


def _box(sign: Sign) -> Rectangle:
    x, y = sign.place
    return Rectangle(x, y, x, y).grown(RADIUS.get(sign.kind, 0.0) + 1.0)


# -- axes -------------------------------------------------------------------------------------------------------------


def _axes(
    frame: Frame, names: tuple[Content, ...], measure: Measure, *, decades: bool = False
) -> tuple[list[Stroke], list[TextLabel]]:
    """Return axes on the left and below, with ticks and names; over `decades` the logarithms below are told as numbers."""
    width, height = frame.width, frame.height
    strokes = [Stroke(((0, 0), (width + _BEYOND, 0)), "axis"), Stroke(((0, 0), (0, height + _BEYOND)), "axis")]
    texts = [TextLabel(names[0], (width + _BEYOND + _LETTER, 0), "west")]
    texts += [TextLabel(name, (0, height + _BEYOND + _LETTER - 1), "south") for name in names[1:]]
    for value, label in decade_ticks(*frame.horizontal) if decades else ticks(*frame.horizontal):
        x, _ = frame.at(value, 0)
        strokes.append(Stroke(((x, 0), (x, -_TICK)), "tick"))
        texts.append(TextLabel(label, (x, -_TICK - 3), "north"))
    for value, label in ticks(*frame.vertical, _fitting(height, measure)):
        _, y = frame.at(0, value)
        strokes.append(Stroke(((0, y), (-_TICK, y)), "tick"))
        texts.append(TextLabel(label, (-_TICK - 2, y), "east"))
    return strokes, texts


def decade_ticks(low: float, high: float) -> list[tuple[float, str]]:
    """Return whole logarithms of an interval, every second or third of many, with their numbers; of few halves, too."""
    first, last = ceil(low - 1e-9), floor(high + 1e-9)
    step = 1 + (last - first) // 8
    return [(float(n), f"{10.0**n:g}" if -5 < n < 6 else f"1e{n}") for n in range(first, last + 1, step)]


def _fitting(height: float, measure: Measure) -> int:
    """Return the number of ticks with room above one another."""
    return max(3, min(_TICKS, int(height / (2 * measure("0")[1]))))


def _zero_lines(frame: Frame) -> Iterator[tuple[Point, Point]]:
    """Yield the lines through zero inside the frame."""
    x, y = frame.at(0, 0)
    if 0 < x < frame.width:
        yield (x, 0), (x, frame.height)
    if 0 < y < frame.height:
        yield (0, y), (frame.width, y)


def ticks(low: float, high: float, most: int = _TICKS) -> list[tuple[float, str]]:
    """Return about `most` round numbers of an interval with their texts."""
    raw = (high - low) / most
    power = 10.0 ** floor(log10(raw))
    step = next(factor * power for factor in (1, 2, 5, 10) if factor * power >= raw * (1 - 1e-9))
    digits = max(0, -floor(log10(step) + 1e-9))
    first, last = ceil(low / step - 1e-9), floor(high / step + 1e-9)
    return [(index * step, f"{index * step:.{digits}f}" if index else "0") for index in range(first, last + 1)]


# -- intervals --------------------------------------------------------------------------------------------------------


def _line(picture: LinePicture, measure: Measure) -> Scene:
    """Return a line with thick pieces; labels of ends that would overlap stand on further rows."""
    low, high = _decimal(picture.window)
    frame = Frame((low, high), (0.0, 1.0), _LINE, 1.0)

    def at(value: float | Fraction) -> float:
        return frame.at(value, 0)[0]

    strokes = [Stroke(((0, 0), (_LINE + _BEYOND, 0)), "axis")]
    ends: dict[float, Content] = {}
    for begin, end in picture.pieces:
        strokes.append(Stroke(((at(begin.place if begin else low), 0), (at(end.place if end else high), 0)), "piece"))
        ends |= {at(found.place): _label(found, measure) for found in (begin, end) if found is not None}
    signs = [Sign(_SIGNS[kind], (at(place), 7.0)) for place, kind in picture.marks if kind != "excluded"]
    signs += [
        Sign("ring", (x, 0)) for x in sorted({*ends, *(at(p) for p, kind in picture.marks if kind == "excluded")})
    ]
    texts = [TextLabel(symbol(picture.axis), (_LINE + _BEYOND + _LETTER, 0), "west"), *_rows(ends, measure)]
    strokes += [Stroke((text.place, (text.place[0], 0)), "zero") for text in texts[1:] if text.place[1] < -3 * _TICK]
    covered = [text.box(measure(text.content)) for text in texts]
    for value, label in ticks(low, high):
        text = TextLabel(label, (at(value), -_TICK - 2), "north")
        box = text.box(measure(label))
        if all(abs(at(value) - x) > RADIUS["ring"] for x in ends):
            strokes.append(Stroke(((at(value), 1.5), (at(value), -1.5)), "tick"))
        if not any(box.grown(_LETTER).meets(other) for other in covered):
            texts.append(text)
    whole = whole_of([*strokes, Stroke(((0, 11.0), (0, -_TICK)), "tick")], texts, measure)
    return Scene(frame.box, whole, (), tuple(strokes), (), tuple(signs), tuple(texts))


def _label(end: End, measure: Measure) -> Content:
    """Return the label of an end: the exact number, or a decimal if that is too long."""
    if isinstance(end.label, str):
        return end.label
    exact = Literal(end.label)
    return exact if measure(exact)[0] <= _LONGEST_END * _LINE else f"≈{float(end.place):.4g}"


def _rows(ends: dict[float, Content], measure: Measure) -> Iterator[TextLabel]:
    """Yield the labels of ends below the line, each on the first row without overlap."""
    rows: list[float] = []
    row_height = measure("0")[1] + 2.0
    for x, content in sorted(ends.items(), key=lambda item: item[0]):
        width, height = measure(content)
        row = next((row for row, right in enumerate(rows) if right + _LETTER <= x - width / 2), len(rows))
        rows[row:] = [x + width / 2] if row == len(rows) or row == len(rows) - 1 else [x + width / 2, *rows[row + 1 :]]
        yield TextLabel(content, (x, -_TICK - 2 - row * max(row_height, height)), "north")


# -- poles ------------------------------------------------------------------------------------------------------------


def _poles(picture: PoleMap, measure: Measure) -> Scene:
    """Return the plane of poles with equal scales, the stable part shaded, arrows on the paths."""
    frame = _square_frame(picture.window)
    (left, _), (bottom, top) = frame.horizontal, frame.vertical
    if picture.discrete:
        radius = float(radius_of(picture))
        edge = [(radius * cos(2 * pi * k / 180), radius * sin(2 * pi * k / 180)) for k in range(181)]
        stable = edge[:-1]
    else:
        margin = -float(picture.margin or 0)
        edge = [(margin, bottom), (margin, top)]
        stable = [(left, bottom), (margin, bottom), (margin, top), (left, top)]
    axes, texts = _axes(frame, (part("Re"), part("Im")), measure)
    zeros = [Stroke(line, "zero") for line in _zero_lines(frame)]
    strokes = [*zeros, *axes, *(Stroke(line, "boundary") for line in frame.lines(edge))]
    signs: list[Sign] = []
    for path in picture.paths:
        runs = frame.lines(path)
        strokes += [Stroke(run, "path") for run in runs]
        signs += [arrow for run in runs for arrow in _arrows(run)]
    rings = [path[-1] for path in picture.paths] if picture.zeros is None else picture.zeros
    ends = (*(("cross", path[0]) for path in picture.paths), *(("ring", place) for place in rings))
    placed = ((kind, frame.at(*place)) for kind, place in ends)
    signs += [Sign(kind, place) for kind, place in placed if frame.box.holds(Rectangle(*place, *place))]
    whole = whole_of(strokes, texts, measure)
    return Scene(frame.box, whole, tuple(frame.areas(stable)), tuple(strokes), (), tuple(signs), tuple(texts))


# -- frequency responses ------------------------------------------------------------------------------------------------


def _nyquist(picture: NyquistPicture, measure: Measure) -> Scene:
    """Return the plane with the frequency response, its mirror image dashed, and −1."""
    frame = _square_frame(picture.window)
    axes, texts = _axes(frame, (symbol("Re"), symbol("Im")), measure)
    strokes = [*(Stroke(line, "zero") for line in _zero_lines(frame)), *axes]
    signs = [Sign("cross", frame.at(-1.0, 0.0))]
    for style, sign in (("path", 1), ("path 2", -1)):
        places = [(x, sign * y) for x, y in picture.values]
        for run in frame.lines(places if sign > 0 else reversed(places)):
            strokes.append(Stroke(run, style))
            signs += _arrows(run)
    return Scene(frame.box, whole_of(strokes, texts, measure), (), tuple(strokes), (), tuple(signs), tuple(texts))


def _branches(picture: BranchPicture, measure: Measure) -> Scene:
    """Return a state over a parameter, full where it is stable, the branch points with their values above the frame."""
    frame = _frame_of(picture.window)
    axes, texts = _axes(frame, (symbol(picture.axes[0]), symbol(picture.axes[1])), measure)
    strokes = [*(Stroke(line, "zero") for line in _zero_lines(frame)), *axes]
    signs, right = list[Sign](), frame.at(*(end[0] for end in picture.window))[0] + measure("0")[1]
    for place, value in sorted(picture.marks, key=lambda mark: mark[0][0]):
        x, y = frame.at(*place)
        signs.append(Sign("ring", (x, y)))
        strokes.append(Stroke(((x, 0), (x, frame.height)), "zero"))
        label = _label(End(place[0], value), measure)
        width, _ = measure(label)
        if x - width / 2 > right:
            texts.append(TextLabel(label, (x, frame.height + _LETTER), "south"))
            right = x + width / 2 + _LETTER
    for branch in picture.branches:
        strokes += [Stroke(run, "path" if branch.stable else "estimate 2") for run in frame.lines(branch.points)]
    return Scene(frame.box, whole_of(strokes, texts, measure), (), tuple(strokes), (), tuple(signs), tuple(texts))


def _bode(picture: BodePicture, measure: Measure) -> Scene:
    """Return modulus and phase one below the other over the logarithm of the frequency, with the asymptotes and the margins."""

    def drawn_in(heights: Sequence[Fraction]) -> Callable[[Frame], list[tuple[Point, ...]]]:
        return lambda frame: frame.lines(zip(picture.across, heights, strict=True))

    phases = _decimal((min(picture.phases), max(picture.phases)))
    panels: list[_Panel] = [
        ("dB", _decimal(picture.window[1]), drawn_in(picture.levels)),
        ("deg", (min(phases[0], -180.0), max(phases[1], phases[0] + 1)), drawn_in(picture.phases)),
    ]
    beside: tuple[list[_Mark], list[_Mark]] = [("estimate 2", picture.asymptotes)], []
    if picture.gain_margin is not None:
        beside[0].append(("piece", picture.gain_margin))
    if picture.phase_margin is not None:
        level = picture.phase_margin[1][1]
        beside[1].extend([("piece", picture.phase_margin), ("zero", [(x, level) for x in picture.window[0]])])
    axis = "theta" if picture.discrete else "omega"
    return _stacked(_decimal(picture.window[0]), axis, panels, measure, decades=True, beside=beside)


# -- responses ----------------------------------------------------------------------------------------------------------


def _responses(picture: TimeResponse, measure: Measure) -> Scene:
    """Return signals over time, each with its name beside it, or on an axis of its own."""
    peaks = [max(map(abs, response.heights)) for response in picture.responses]
    alone = not picture.discrete and not any(response.dashed for response in picture.responses)
    if alone and 0 < _ONE_AXIS * min(peaks) < max(peaks):
        return _panels(picture, measure)
    frame = Frame(_decimal(picture.window[0]), _decimal(picture.window[1]), WIDEST, _TIME_HEIGHT)
    counted = replace(frame, vertical=(frame.vertical[0] * picture.parts, frame.vertical[1] * picture.parts))
    lines = [
        tuple(replace(counted, horizontal=(0.0, len(response.heights) - 1.0)).lines(enumerate(response.heights)))
        for response in picture.responses
    ]
    pale = tuple(_zero_lines(frame))
    every = tuple(line for parts in lines for line in parts)
    names = {name_of(response): parts for response, parts in zip(picture.responses, lines, strict=True)}
    labels, numbered = labelled(names, Surroundings(frame.box, every, (), pale, ()), measure)
    axes, written = _axes(frame, (symbol(time_axis(picture)),), measure)
    styles = ["zero" if picture.discrete else _style_of(response, picture) for response in picture.responses]
    sampled = picture.responses if picture.discrete else ()
    signs = tuple(
        Sign("ring" if response.dashed else "dot", frame.at(*place))
        for response in sampled
        for place in picture.points(response)
    )
    strokes = [Stroke(line, style) for style, parts in zip(styles, lines, strict=True) for line in parts]
    texts = (*written, *labels)
    zeros = (Stroke(line, "zero") for line in pale)
    whole = whole_of(axes, texts, measure)
    return Scene(frame.box, whole, (), (*zeros, *axes, *strokes), (), signs, texts, tuple(numbered))


def _style_of(response: PlottedResponse, picture: TimeResponse) -> str:
    """Return the style of a curve: no two of a signal are alike, nor two signals without estimates."""
    if not any(other.dashed for other in picture.responses):
        return _COMPONENTS[picture.responses.index(response) % len(_COMPONENTS)]
    styles = _BESIDE_ESTIMATE[response.dashed]
    return styles[max(0, response.component - 1) % len(styles)]


def _panels(picture: TimeResponse, measure: Measure) -> Scene:
    """Return signals over time one below the other, each on an axis of its own with its name."""

    def drawn_in(response: PlottedResponse) -> Callable[[Frame], list[tuple[Point, ...]]]:
        def lines(frame: Frame) -> list[tuple[Point, ...]]:
            low, high = (edge * picture.parts for edge in frame.vertical)
            counted = replace(frame, horizontal=(0.0, len(response.heights) - 1.0), vertical=(low, high))
            return counted.lines(enumerate(response.heights))

        return lines

    panels: list[_Panel] = []
    for response in picture.responses:
        low, high = (bound(0, bound(response.heights)) / picture.parts for bound in (min, max))
        panels.append((name_of(response), (low, high), drawn_in(response)))
    columns = 2 if len(panels) >= _TWO_COLUMNS else 1
    return _stacked(_decimal(picture.window[0]), time_axis(picture), panels, measure, columns=columns)


def _stacked(
    window: tuple[float, float],
    axis: str,
    panels: Sequence[_Panel],
    measure: Measure,
    *,
    decades: bool = False,
    beside: Sequence[Sequence[_Mark]] = (),
    columns: int = 1,
) -> Scene:
    """Return panels one below the other over one horizontal axis, of logarithms with `decades`, with marks in each."""
    strokes: list[Stroke] = []
    texts: list[TextLabel] = []
    size = _DECADES if decades else _PANEL
    rows, width = -(-len(panels) // columns), (WIDEST - (columns - 1) * _BETWEEN_COLUMNS) / columns
    for place, (name, (low, high), lines) in enumerate(panels):
        column, row = divmod(place, rows)
        right, up = column * (width + _BETWEEN_COLUMNS), (rows - 1 - row) * (size + _BETWEEN_PANELS)
        is_lowest = row == rows - 1 or place == len(panels) - 1
        room = (high - low) / 20
        frame = Frame(window, (low - room, high + room), width, size)
        axes, written = _axes(frame, (symbol(axis), name), measure, decades=decades)
        runs = [Stroke(line, "zero") for line in _zero_lines(frame)] + axes
        runs += [Stroke(line, "path") for line in lines(frame)]
        for style, points in beside[place] if beside else ():
            runs += [Stroke(line, style) for line in frame.lines(points)]
        strokes += [replace(run, points=tuple((x + right, y + up) for x, y in run.points)) for run in runs]
        shown = [text for text in written if is_lowest or (text.anchor != "north" and text is not written[0])]
        texts += [replace(text, place=(text.place[0] + right, text.place[1] + up)) for text in shown]
    height = rows * (size + _BETWEEN_PANELS) - _BETWEEN_PANELS
    whole = whole_of(strokes, texts, measure)
    return Scene(Rectangle(0.0, 0.0, WIDEST, height), whole, (), tuple(strokes), (), (), tuple(texts))


def _square_frame(window: tuple[Interval, Interval]) -> Frame:
    """Return a frame with equal scales, a strip widened on both sides."""
    horizontal, vertical = map(_decimal, window)
    scale = min(WIDEST / (horizontal[1] - horizontal[0]), HIGHEST / (vertical[1] - vertical[0]))
    horizontal, vertical = (_widened(interval, _SMALLEST_SIDE / scale) for interval in (horizontal, vertical))
    width, height = ((high - low) * scale for low, high in (horizontal, vertical))
    return Frame(horizontal, vertical, width, height)


def _widened(interval: tuple[float, float], least: float) -> tuple[float, float]:
    low, high = interval
    more = max(0.0, least - (high - low)) / 2
    return low - more, high + more


def _arrows(run: Sequence[Point]) -> Iterator[Sign]:
    """Yield arrow heads in the middle of a path, or at the thirds of a long one."""
    length = sum(hypot(b[0] - a[0], b[1] - a[1]) for a, b in pairwise(run))
    if length < 4 * RADIUS["ring"]:
        return
    for place, direction, _ in walk(run, length / 2 if length > WIDEST / 2 else length):
        yield Sign("arrow", (place[0] + 2 * direction[0], place[1] + 2 * direction[1]), direction)


# -- sweeps -----------------------------------------------------------------------------------------------------------


def _curves(picture: SweepCurves, measure: Measure) -> Scene:
    """Return columns over one name, one below the other; where there are no values the ground is shaded."""

    def drawn_in(runs: Sequence[Run]) -> Callable[[Frame], list[tuple[Point, ...]]]:
        return lambda frame: [line for run in runs for line in frame.lines(run)]

    panels: list[_Panel] = []
    shades: list[tuple[Point, ...]] = []
    for row, (name, runs, gaps) in enumerate(picture.columns, 1):
        heights = [y for run in runs for _, y in run] or [0.0]
        low, high = min(heights), max(heights)
        room = 0.0 if low < high else abs(low) / 10 or 1.0
        panels.append((name, (low - room, high + room), drawn_in(runs)))
        frame, up = Frame(picture.window, (0.0, 1.0), WIDEST, _PANEL), len(picture.columns) - row
        areas = (area for a, b in gaps for area in frame.areas([(a, 0), (b, 0), (b, 1), (a, 1)]))
        shades += [tuple((x, y + up * (_PANEL + _BETWEEN_PANELS)) for x, y in area) for area in areas]
    return replace(_stacked(picture.window, picture.axis, panels, measure), shades=tuple(shades))


def _map(picture: SweepMap, measure: Measure) -> Scene:
    """Return lines of equal values, each with its value beside it; where there are no values the ground is shaded."""
    frame = Frame(*picture.window, WIDEST, HIGHEST)
    curves: dict[Formula, tuple[tuple[Point, ...], ...]] = {}
    for level, runs in picture.levels:
        seen = (line for run in runs for line in frame.lines(run) if sum(map(dist, line, line[1:])) > _SHORTEST)
        if found := tuple(seen):
            curves[Decimals(Scalar.of(level))] = found
    lines = tuple(line for parts in curves.values() for line in parts)
    shades = tuple(area for gap in picture.gaps for area in frame.areas(gap))
    labels, numbered = labelled(curves, Surroundings(frame.box, lines, (), (), shades), measure)
    axes, written = _axes(frame, (symbol(picture.axes[0]), symbol(picture.axes[1])), measure)
    texts = (*written, *labels)
    strokes = (*axes, *(Stroke(line, "path") for line in lines))
    return Scene(frame.box, whole_of(axes, texts, measure), shades, strokes, (), (), texts, tuple(numbered))
