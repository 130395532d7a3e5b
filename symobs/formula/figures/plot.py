"""Plots as data, in coordinates of the plane, before any format draws them."""

from __future__ import annotations

from fractions import Fraction
from typing import TYPE_CHECKING, TypeAlias

from symobs.ground.dataclass import dataclass

if TYPE_CHECKING:
    from symobs.exact import Scalar
    from symobs.formula.tree import Formula, Relation

#: A point of a picture.  Coordinates are rational: what is drawn can be held against what is exact.
Place: TypeAlias = "tuple[Fraction, Fraction]"
Interval: TypeAlias = "tuple[Fraction, Fraction]"


@dataclass(frozen=True)
class Curve:
    """A segment of the curve of `equation`, either a `boundary` of the region or a dividing curve."""

    points: tuple[Place, ...]
    equation: Relation
    boundary: bool = True


@dataclass(frozen=True)
class MarkedPoint:
    """A marked point: `stable` or `unstable` (a sample of a cell), or `excluded` (a hole of the region)."""

    place: Place
    kind: str


@dataclass(frozen=True)
class RegionPicture:
    """A region of two parameters inside a window: filled areas (closed polygons), curves, marks.

    `drawn_for` are the values given to other symbols, since a picture needs numbers.
    """

    axes: tuple[str, str]
    window: tuple[Interval, Interval]
    areas: tuple[tuple[Place, ...], ...]
    curves: tuple[Curve, ...]
    marks: tuple[MarkedPoint, ...] = ()
    drawn_for: tuple[tuple[str, Scalar], ...] = ()


@dataclass(frozen=True)
class End:
    """An end of an interval on a line: its position, and its label."""

    place: Fraction
    label: Scalar | str


@dataclass(frozen=True)
class LinePicture:
    """Open intervals of one parameter; a missing end lies beyond the window."""

    axis: str
    window: Interval
    pieces: tuple[tuple[End | None, End | None], ...]
    marks: tuple[tuple[Fraction, str], ...] = ()
    drawn_for: tuple[tuple[str, Scalar], ...] = ()


@dataclass(frozen=True)
class PoleMap:
    """A root locus: the paths of the poles over a range of a parameter, with begin and end marked.

    The stability boundary is the imaginary axis moved left by `margin`, or in discrete time the circle of radius `radius`.
    `along` are the values of the parameter at the points of each path.
    """

    variable: str
    moved: str
    values: Interval
    paths: tuple[tuple[Place, ...], ...]
    window: tuple[Interval, Interval]
    discrete: bool = False
    margin: Fraction | None = None
    radius: Fraction | None = None
    along: tuple[tuple[Fraction, ...], ...] = ()
    drawn_for: tuple[tuple[str, Scalar], ...] = ()


@dataclass(frozen=True)
class PlottedResponse:
    """The time response of one signal component: `row` times the state.

    `component` counts from 1, and is 0 where the signal has no other; a `dashed` response is an estimate.
    `heights` are its values, in whole parts of one, at equal distances from the begin of the window to its end.
    """

    signal: str
    component: int
    row: tuple[Fraction, ...]
    heights: tuple[int, ...]
    dashed: bool = False


@dataclass(frozen=True)
class TimeResponse:
    """Time responses: the stacked `states` satisfy a linear equation, with initial states `starts`.

    Heights of responses are counted in `parts` of one.  In `discrete` time they stand at 0, 1, 2, … and are exact.
    """

    states: tuple[str, ...]
    starts: tuple[tuple[Fraction, ...], ...]
    responses: tuple[PlottedResponse, ...]
    window: tuple[Interval, Interval]
    parts: int
    drawn_for: tuple[tuple[str, Scalar], ...] = ()
    discrete: bool = False

    def points(self, response: PlottedResponse) -> list[Place]:
        """Return the points of one of the responses."""
        begin, end = self.window[0]
        step = (end - begin) / (len(response.heights) - 1)
        return [(begin + k * step, Fraction(height, self.parts)) for k, height in enumerate(response.heights)]


#: What stands on a page, and is checked with it.
Picture: TypeAlias = RegionPicture | LinePicture | PoleMap | TimeResponse


#: A line through values that were rounded to binary numbers; values of a sweep are exact, what joins them is not.
Run: TypeAlias = "tuple[tuple[float, float], ...]"


@dataclass(frozen=True)
class SweepCurves:
    """Columns of a sweep over one name: of each its name, the lines through its values, and the gaps without any.

    Columns that are `infinite` at all points are only named.
    """

    axis: str
    columns: tuple[tuple[Formula | str, tuple[Run, ...], tuple[tuple[float, float], ...]], ...]
    window: tuple[float, float]
    points: int
    infinite: tuple[Formula | str, ...] = ()


@dataclass(frozen=True)
class SweepMap:
    """A column of a sweep over two names: lines of equal values; in the rectangles `gaps` there are none."""

    axes: tuple[str, str]
    column: Formula | str
    window: tuple[tuple[float, float], tuple[float, float]]
    levels: tuple[tuple[Fraction, tuple[Run, ...]], ...]
    points: int
    gaps: tuple[Run, ...] = ()


Drawn: TypeAlias = Picture | SweepCurves | SweepMap
