"""`--plot PATH`: the picture of a result in a file, whole or not at all, beside the result itself."""

from __future__ import annotations

import sys
from dataclasses import replace
from typing import TYPE_CHECKING

import pytest

from symobs.ground.errors import DerivationRejected
from symobs.pages.drawings.plot_file import picture_file
from symobs.tasks.analysis.rank.observability import Observability
from tests.kit import tabled
from tests.support.regions import drawn_by_hand as hand
from tests.support.tools.command_line import inside

if TYPE_CHECKING:
    from pathlib import Path

    from symobs.formula.figures import Picture
    from symobs.proof.derivation.builder import Builder

PLANT = '[plant]\nA = "[0 1; 0 -1]"\nB = "[0; 1]"\nC = "[1 0]"\n'
PROBLEM = f'tasks = ["controllability", "observability"]\n{PLANT}'.encode()


@pytest.fixture(name="pictured")
def a_task_with_a_picture(monkeypatch: pytest.MonkeyPatch) -> Picture:
    """Let the page of observability show the interval of k in which a third-order loop is stable."""
    picture = hand.interval()
    write = Observability.write

    def with_picture(result: Observability, page: Builder) -> None:
        write(result, page)
        page.plot(picture, page.set("chi", hand.INTERVAL))

    monkeypatch.setattr(Observability, "write", with_picture)
    monkeypatch.setattr(Observability, "picture", property(lambda _: picture))
    return picture


@pytest.mark.parametrize(
    ("suffix", "beginning"), [("svg", b"<svg "), ("tex", b"% Needs tikz"), ("png", b"\x89PNG"), ("PDF", b"%PDF-")]
)
def test_the_first_picture_is_written_beside_the_result(
    suffix: str, beginning: bytes, pictured: Picture, tmp_path: Path
) -> None:
    run = inside("solve", "-", "--format", "json", "--plot", f"map.{suffix}", folder=tmp_path, stdin=PROBLEM)
    assert (run.code, run.err) == (0, "")
    assert run.out == inside("solve", "-", "--format", "json", folder=tmp_path, stdin=PROBLEM).out
    assert (tmp_path / f"map.{suffix}").read_bytes().startswith(beginning)
    assert [path.name for path in tmp_path.iterdir()] == [f"map.{suffix}"]
    assert pictured is not None


@tabled
def test_a_file_of_no_format_is_refused_before_anything_is_solved(path: str, said: str, tmp_path: Path) -> None:
    run = inside("solve", "-", "--plot", path, folder=tmp_path, stdin=PROBLEM)
    assert (run.code, run.out) == (2, "")
    assert said in run.err
    task = inside("observability", "--A", "[0]", "--C", "[1]", "--plot", path, folder=tmp_path)
    assert (task.code, task.out, task.err) == (2, "", run.err)


def test_a_missing_matplotlib_is_said_before_anything_is_solved(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path, pictured: Picture
) -> None:
    monkeypatch.setitem(sys.modules, "matplotlib", None)
    monkeypatch.setitem(sys.modules, "matplotlib.figure", None)
    run = inside("solve", "-", "--plot", "map.png", folder=tmp_path, stdin=PROBLEM)
    assert (run.code, run.out) == (2, "")
    assert "pip install matplotlib, or name a file that ends in .svg or .tex" in run.err
    assert inside("solve", "-", "--plot", "map.svg", folder=tmp_path, stdin=PROBLEM).code == 0
    assert pictured is not None


def test_a_picture_that_the_page_does_not_show_is_not_drawn(monkeypatch: pytest.MonkeyPatch, pictured: Picture) -> None:
    from symobs import StateSpace, observability  # noqa: PLC0415 - after the page was changed

    result = observability(StateSpace("[0 1; 0 -1]", C="[1 0]"))
    assert picture_file([result], "map.svg").startswith(b"<svg")
    other = replace(hand.interval(), marks=())
    monkeypatch.setattr(Observability, "picture", property(lambda _: other))
    with pytest.raises(DerivationRejected, match="the page shows another picture"):
        picture_file([result], "map.svg")
    assert pictured is not None
