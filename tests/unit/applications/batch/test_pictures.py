"""Pictures of sweeps: lines through the values of the table, gaps where it has none, and what no picture can show."""

from __future__ import annotations

import re
from fractions import Fraction
from math import dist, hypot, isclose, pi
from typing import TYPE_CHECKING

import pytest

import symobs
from symobs.applications.batch.sweep.picture import _level, _round_levels, picture_of
from symobs.formula.figures import SweepMap
from tests.kit import tabled
from tests.support.tools.command_line import inside
from tests.unit.applications.batch.test_sweep import problem

if TYPE_CHECKING:
    from pathlib import Path

#: L = [−3; 6]/(2c − 1): none at c = 1/2, and at c = 1 the hidden mode is asked for, a case of its own.
HIDDEN = problem("observer", "c:real", 'A = "[0 1; -2 -3]"\nC = "[1 c]"', 'poles = "-1, -5"')
PLANE = problem("observer", "c:real d:real", 'A = "[0 1; -2 -3]"\nC = "[1 c+d]"', 'poles = "-1, -5"')


def test_lines_of_equal_values_are_where_the_values_are() -> None:
    """Of a plane they are straight, whole and exact; of a cone closed and as long as a circle."""
    xs, ys = [k / 7 for k in range(15)], [k / 5 for k in range(11)]
    plane: list[list[float | None]] = [[x + 2 * y for y in ys] for x in xs]
    (run,) = _level(xs, ys, plane, 2.5)
    assert all(isclose(x + 2 * y, 2.5) for x, y in run)
    assert isclose(dist(run[0], run[-1]), hypot(2, 1)) or isclose(dist(run[0], run[-1]), sum(map(dist, run, run[1:])))
    fine = [k / 20 for k in range(-30, 31)]
    cone: list[list[float | None]] = [[hypot(x, y) for y in fine] for x in fine]
    (circle,) = _level(fine, fine, cone, 1.01)
    assert circle[0] == circle[-1]
    assert all(abs(hypot(*place) - 1.01) < 1e-3 for place in circle)
    assert abs(sum(map(dist, circle, circle[1:])) - 2 * pi * 1.01) < 0.01
    saddle: list[list[float | None]] = [[x * y for y in (-1.0, 1.0)] for x in (-1.0, 1.0)]
    corners = [{x + y for x, y in run} for run in _level([-1.0, 1.0], [-1.0, 1.0], saddle, 0.0)]
    assert sorted(corners, key=min) == [{-1.0}, {1.0}]  # round the corners that lie above
    torn = [[None if abs(x) < 0.1 else value for value in row] for x, row in zip(fine, cone, strict=True)]
    assert len(list(_level(fine, fine, torn, 1.01))) == 2
    assert _round_levels([k / 100 for k in range(801)]) == [Fraction(k) for k in range(1, 8)]


@pytest.mark.slow
def test_pictures_are_written_beside_tables_and_instead_of_them(tmp_path: Path) -> None:
    (tmp_path / "h.toml").write_text(HIDDEN, encoding="utf-8")
    (tmp_path / "p.toml").write_text(PLANE, encoding="utf-8")
    run = ["--in-process", "--quiet"]
    both = ["--out", "h.csv", "--plot", "h.svg"]
    assert inside("sweep", "h.toml", "--over", "c=0:1/8:2", *both, *run, folder=tmp_path).code == 0
    assert len((tmp_path / "h.csv").read_text(encoding="utf-8").splitlines()) == 18
    shown = re.sub("<[^>]*>", "", (tmp_path / "h.svg").read_text(encoding="utf-8"))
    assert "Checked values at 17 points" in shown
    assert "Shaded: no finite value, or a case of its own." in shown
    over = ["--over", "c=1:1/8:3, d=1:1/8:3", "--columns", "L[2,1]"]
    assert inside("sweep", "p.toml", *over, "--plot", "p.tex", *run, folder=tmp_path).code == 0
    assert "Lines of equal $L_{21}$" in (tmp_path / "p.tex").read_text(encoding="utf-8")
    assert sorted(path.name for path in tmp_path.iterdir()) == ["h.csv", "h.svg", "h.toml", "p.tex", "p.toml"]
    table = symobs.sweep(PLANE, "c=1:1/8:3, d=1:1/8:3", columns="L[2,1]", workers=1)
    picture = picture_of(table)
    assert isinstance(picture, SweepMap)
    for level, runs in picture.levels:  # 6/(2(c + d) − 1)
        assert all(abs(6 / (2 * (c + d) - 1) - float(level)) < 0.02 for run in runs for c, d in run)


@tabled
def test_what_no_picture_shows_is_said_before_any_work(words: list[str], says: str, tmp_path: Path) -> None:
    (tmp_path / "p.toml").write_text(PLANE, encoding="utf-8")
    left = inside("sweep", "p.toml", *words, "--each", folder=tmp_path)
    assert left.code == 2
    assert says in left.err
    assert [path.name for path in tmp_path.iterdir()] == ["p.toml"]
