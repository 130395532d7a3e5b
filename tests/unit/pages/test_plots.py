"""Pictures on paper, on the web and on terminals: everything is there, inside, and over nothing else."""

from __future__ import annotations

import re
import subprocess
import sys
import xml.etree.ElementTree as ET
from itertools import combinations
from typing import TYPE_CHECKING

import pytest

import symobs
from symobs.formula.tree import Environment, Letter, Relation
from symobs.ground.errors import UsageError
from symobs.pages.drawings.curve_labels import clipped
from symobs.pages.drawings.plot_file import drawn_by_matplotlib, saved
from symobs.pages.drawings.svg import measure_for as measure_svg
from symobs.pages.drawings.svg import svg, svg_file, svg_scene
from symobs.pages.drawings.tikz import measure_for as measure_latex
from symobs.pages.drawings.tikz import tikz_file, tikz_scene
from symobs.pages.formats.latex import LatexArticle, LatexFragment
from symobs.pages.formats.text import WIDTH, Text
from symobs.pages.printers.latex_printer import LatexPrinter
from symobs.pages.printers.text_printer import TextPrinter
from symobs.proof.derivation import Derivation, Plot
from tests.kit import tabled
from tests.support.problems.steps import document
from tests.support.regions import drawn_by_hand as hand
from tests.support.regions.drawn_by_hand import ALL
from tests.support.tampering.mutations import lines_of

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    from symobs.formula.figures import Picture
    from symobs.pages.drawings.scene import Measure, Rectangle, Scene

FAULTS = re.compile(r"^(?:! .*|(?:LaTeX|Package|Class).*Warning.*|Overfull .*|Missing character.*)", re.MULTILINE)
SVG = "{http://www.w3.org/2000/svg}"


def page(name: str, picture: Picture | None = None) -> Derivation:
    make, chi, discrete = ALL[name]
    start = Environment(variable="z" if discrete else "s", values={"chi": chi}, signs={"b": "positive"})
    return Derivation((Plot(picture or make(), Letter("chi")),), start, discrete=discrete)


def read(source: str) -> ET.Element:
    return ET.fromstring(source)  # noqa: S314 - what we wrote ourselves


def printers(name: str) -> tuple[LatexPrinter, TextPrinter]:
    variable = "z" if ALL[name][2] else "s"
    return LatexPrinter(variable), TextPrinter(variable)


def scenes(name: str) -> list[tuple[Scene, Measure]]:
    latex, text = printers(name)
    picture = ALL[name][0]()
    return [(tikz_scene(picture, latex), measure_latex(latex)), (svg_scene(picture, text), measure_svg(text))]


# -- scenes -----------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("name", ALL)
def test_no_text_overlaps_another_or_leaves_the_picture(name: str) -> None:
    for scene, measure in scenes(name):
        boxes = [text.box(measure(text.content)) for text in scene.texts]
        assert all(scene.whole.holds(box) for box in boxes)
        assert not any(a.meets(b) for a, b in combinations(boxes, 2))


@tabled
def test_labels_stand_inside_the_frame_beside_every_line(name: str) -> None:
    for scene, measure in scenes(name):
        labels = [text for text in scene.texts if isinstance(text.content, Relation) or str(text.content)[0] == "("]
        for label in labels:
            box = label.box(measure(label.content))
            assert scene.frame.holds(box)
            for stroke in scene.strokes:
                assert not any(_meets(line, box) for line in [stroke.points])


def _meets(line: tuple[tuple[float, float], ...], box: Rectangle) -> bool:
    return any(clipped(line, box))


# -- LaTeX ------------------------------------------------------------------------------------------------------------


@pytest.mark.slow
def test_all_pictures_are_typeset_without_a_fault(require_tool: Callable[[str], str], tmp_path: Path) -> None:
    pages = [page(name) for name in ALL]
    bodies = [LatexFragment().render(document(each)) for each in pages]
    article = LatexArticle().render(document(*pages, title="Pictures"))
    head, rest = article.split(r"\begin{document}")
    alone = "\n\n".join(tikz_file(ALL[name][0](), printers(name)[0]) for name in ALL)
    whole = head + r"\begin{document}" + alone + "\n".join(bodies) + rest
    (tmp_path / "page.tex").write_text(whole, "utf-8")
    command = [require_tool("pdflatex"), "-interaction=nonstopmode", "-no-shell-escape", "page.tex"]
    subprocess.run(command, cwd=tmp_path, capture_output=True, check=False)
    log = (tmp_path / "page.log").read_text(encoding="latin-1")
    assert "Output written" in log
    assert FAULTS.findall(log) == []


# -- SVG --------------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("name", ALL)
def test_svg_is_whole_and_needs_nothing_else(name: str) -> None:
    text = printers(name)[1]
    picture = ALL[name][0]()
    for source in (svg(svg_scene(picture, text), text, "a < b"), svg_file(picture, text)):
        root = read(source)
        assert root.tag == f"{SVG}svg"
        assert root.find(f"{SVG}title") is not None
        assert {element.tag for element in root.iter()} <= {
            f"{SVG}{tag}" for tag in ("svg", "title", "style", "path", "circle", "text", "tspan")
        }
        assert source.count("http") == 1
        assert "url(" not in source


# -- matplotlib -------------------------------------------------------------------------------------------------------


@tabled
def test_matplotlib_draws_the_same(name: str) -> None:
    latex, text = printers(name)
    picture = ALL[name][0]()
    png = saved(drawn_by_matplotlib([picture], latex, text), "png")
    assert png.startswith(b"\x89PNG\r\n\x1a\n")
    assert png == saved(drawn_by_matplotlib([picture], latex, text), "png")
    assert saved(drawn_by_matplotlib([picture], latex, text), "pdf").startswith(b"%PDF-")


@pytest.mark.parametrize("place", ["10^20", "10^40"])
def test_a_region_that_floating_point_cannot_draw_has_a_page_without_a_picture(place: str) -> None:
    """The roots are real and negative between two lines that are 1 apart."""
    polynomial = f"(s+a-{place})*(s+{place}+1-a)*(s+b)*(s+1-b)"
    result = symobs.stability_region(polynomial=polynomial, parameters=("a", "b"))
    for name in ("text", "latex", "html"):
        assert len(str(result.to(name))) > 1000
    assert not [line for line in lines_of(result.derivation) if isinstance(line.step, Plot)]


def test_without_matplotlib_the_repair_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "matplotlib", None)
    monkeypatch.setitem(sys.modules, "matplotlib.figure", None)
    with pytest.raises(UsageError, match="pip install matplotlib"):
        drawn_by_matplotlib([hand.interval()], LatexPrinter(), TextPrinter())


# -- terminals --------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("name", ALL)
def test_a_terminal_shows_a_sketch(name: str) -> None:
    shown = Text().render(document(page(name))).splitlines()
    assert max(map(len, shown)) <= WIDTH
    assert any(mark in line for line in shown for mark in "#━x")


def test_the_numbers_beside_a_sketch_are_round_and_stand_at_their_places() -> None:
    """x₁ = (1 + 2e⁻ᵗ − e⁻²ᵗ)/2 falls from 1 to 1/2, x₂ = e⁻²ᵗ − e⁻ᵗ begins at 0."""
    plant = symobs.StateSpace("[0 1; -2 -3]", "[0; 1]", "[1 0]")
    shown = str(symobs.response(plant, initial="[1; 0]", input="1").to("text"))
    beside = dict(re.findall(r"^ +(\S+) ┤(.*)$", shown, re.MULTILINE))
    assert list(beside) == ["1.0", "0.5", "0"]
    assert [beside[number][place] for number, place in (("1.0", 0), ("0.5", -1), ("0", 0))] == ["*", "*", "o"]
    ((axis, numbers),) = re.findall(r"^ +└(\S+) t\n +(.*)$", shown, re.MULTILINE)
    assert axis.count("┬") == len(numbers.split())
    assert [float(number) for number in numbers.split()] == [0, 2, 4, 6]


@tabled
def test_a_line_is_drawn_as_it_is(last: str, line: str) -> None:
    """Both are stable where h k < 1, but on h = 0 s² + s + 1 is stable and s² + s is not."""
    result = symobs.stability_region(polynomial=f"s^2 + (1 - h k) s + {last}", parameters=("h", "k"))
    shown = str(result.to("text"))
    rows = re.findall(r" [│┤]([#.]{41})$", shown, re.MULTILINE)
    (plot,) = (line.step for line in lines_of(result.derivation) if isinstance(line.step, Plot))
    (left, right), (bottom, top) = (map(float, ends) for ends in plot.picture.window)  # type: ignore[arg-type]
    assert len(rows) == 17
    for number, row in enumerate(rows):
        k = top + (bottom - top) * (number + 0.5) / 17
        for column, character in enumerate(row):
            h = left + (right - left) * (column + 0.5) / 41
            assert character == (line if column == 20 else "#" if h * k < 1 else "."), (h, k)
