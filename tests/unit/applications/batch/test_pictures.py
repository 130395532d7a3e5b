"""Pictures of sweeps: lines through the values of the table, gaps where it has none, and what no picture can show."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

import pytest

import symobs
from symobs.applications.batch.sweep.picture import picture_of
from symobs.formula.figures import SweepMap
from tests.kit import tabled
from tests.support.tools.command_line import inside
from tests.unit.applications.batch.test_sweep import problem

if TYPE_CHECKING:
    from pathlib import Path

#: L = [−3; 6]/(2c − 1): none at c = 1/2, and at c = 1 the hidden mode is asked for, a case of its own.
HIDDEN = problem("observer", "c:real", 'A = "[0 1; -2 -3]"\nC = "[1 c]"', 'poles = "-1, -5"')
PLANE = problem("observer", "c:real d:real", 'A = "[0 1; -2 -3]"\nC = "[1 c+d]"', 'poles = "-1, -5"')


@pytest.mark.slow
def test_pictures_are_written_beside_tables_and_instead_of_them(tmp_path: Path) -> None:
    (tmp_path / "h.toml").write_text(HIDDEN, "utf-8")
    (tmp_path / "p.toml").write_text(PLANE, "utf-8")
    run = ["--in-process", "--quiet"]
    both = ["--out", "h.csv", "--plot", "h.svg"]
    assert inside("sweep", "h.toml", "--over", "c=0:1/8:2", *both, *run, folder=tmp_path).code == 0
    assert len((tmp_path / "h.csv").read_text("utf-8").splitlines()) == 18
    shown = re.sub("<[^>]*>", "", (tmp_path / "h.svg").read_text("utf-8"))
    assert "Checked values at 17 points" in shown
    assert "Shaded: no finite value, or a case of its own." in shown
    over = ["--over", "c=1:1/8:3, d=1:1/8:3", "--columns", "L[2,1]"]
    assert inside("sweep", "p.toml", *over, "--plot", "p.tex", *run, folder=tmp_path).code == 0
    assert "Lines of equal $L_{21}$" in (tmp_path / "p.tex").read_text("utf-8")
    assert sorted(path.name for path in tmp_path.iterdir()) == ["h.csv", "h.svg", "h.toml", "p.tex", "p.toml"]
    table = symobs.sweep(PLANE, "c=1:1/8:3, d=1:1/8:3", columns="L[2,1]", workers=1)
    picture = picture_of(table)
    assert isinstance(picture, SweepMap)
    for level, runs in picture.levels:  # 6/(2(c + d) − 1)
        assert all(abs(6 / (2 * (c + d) - 1) - float(level)) < 0.02 for run in runs for c, d in run)


@tabled
def test_what_no_picture_shows_is_said_before_any_work(words: list[str], says: str, tmp_path: Path) -> None:
    (tmp_path / "p.toml").write_text(PLANE, "utf-8")
    left = inside("sweep", "p.toml", *words, "--each", folder=tmp_path)
    assert left.code == 2
    assert says in left.err
    assert [path.name for path in tmp_path.iterdir()] == ["p.toml"]
