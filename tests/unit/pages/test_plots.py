"""Pictures on paper, on the web and on terminals: everything is there, inside, and over nothing else."""

from __future__ import annotations

import re
import subprocess
import sys
import xml.etree.ElementTree as ET
from dataclasses import replace
from fractions import Fraction
from itertools import combinations, pairwise
from typing import TYPE_CHECKING

import pytest

import symobs
from symobs.exact import Scalar
from symobs.formula.figures import Curve, End, LinePicture, MarkedPoint, RegionPicture
from symobs.formula.phrases import PHRASES
from symobs.formula.phrases.languages import ENGLISH
from symobs.formula.tree import Environment, Letter, Relation, Roots
from symobs.ground.errors import UsageError
from symobs.pages.drawings.curve_labels import chained, clipped, clipped_area, thinned
from symobs.pages.drawings.plot_file import drawn_by_matplotlib
from symobs.pages.drawings.plot_layout import plot_scene, ticks
from symobs.pages.drawings.scene import Rectangle, Scene, below, words_of
from symobs.pages.drawings.svg import measure_for as measure_svg
from symobs.pages.drawings.svg import svg, svg_file, svg_scene
from symobs.pages.drawings.text import sketch
from symobs.pages.drawings.tikz import measure_for as measure_latex
from symobs.pages.drawings.tikz import tikz_file, tikz_scene
from symobs.pages.formats.latex import LatexArticle, LatexFragment
from symobs.pages.formats.text import WIDTH, Text
from symobs.pages.page.plot_captions import caption
from symobs.pages.printers.latex_printer import LatexPrinter
from symobs.pages.printers.text_printer import TextPrinter
from symobs.proof.derivation import Derivation, Plot
from tests.kit import tabled
from tests.support.problems.render_examples import document, say
from tests.support.regions import drawn_by_hand as hand
from tests.support.regions.drawn_by_hand import ALL, equation, h1, h2

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    from symobs.formula.figures import Picture
    from symobs.pages.drawings.scene import Measure

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


@pytest.mark.parametrize("name", ["hyperbola", "annulus", "three_components", "fifth_order"])
def test_every_area_and_every_boundary_is_there(name: str) -> None:
    picture = ALL[name][0]()
    assert isinstance(picture, RegionPicture)
    equations = {curve.equation for curve in picture.curves if curve.boundary}
    for scene, _ in scenes(name):
        labelled = {text.content for text in scene.texts if isinstance(text.content, Relation)}
        assert labelled | set(scene.numbered) == equations
        assert len(scene.shades) == len(picture.areas)
        assert all(scene.frame.grown(0.01).holds(Rectangle(x, y, x, y)) for area in scene.shades for x, y in area)
        numbers = [text.content for text in scene.texts if str(text.content).startswith("(")]
        assert numbers == [f"({place})" for place in range(1, len(scene.numbered) + 1)]
        assert len(scene.signs) == sum(mark.kind == "excluded" for mark in picture.marks)  # no test points of the proof


def test_many_curves_carry_numbers() -> None:
    corners = [(Fraction(0), Fraction(0)), (Fraction(1), Fraction(0)), (Fraction(1), Fraction(1))]
    curves = tuple(
        Curve(
            tuple((Fraction(x, 10), Fraction(j, 100) + Fraction(j * x, 1000)) for x in range(11)),
            equation(1000 * h2, 10 * j + 10 * j * h1 + h1**5 - h1**5),
        )
        for j in range(1, 9)
    )
    window = ((Fraction(0), Fraction(1)), (Fraction(0), Fraction(1)))
    crowded = RegionPicture(("h1", "h2"), window, (tuple(corners),), curves)
    scene = tikz_scene(crowded, LatexPrinter())
    assert len(scene.numbered) >= 5
    told = [part for part in below(caption(crowded), scene, ENGLISH) if isinstance(part, str)]
    assert any(part.endswith(f"{PHRASES['picture_curves']} (1) ") for part in told)


def test_a_scene_shows_the_window_only() -> None:
    picture = hand.hyperbola()
    window = ((Fraction(1), Fraction(2)), (Fraction(1), Fraction(2)))
    scene = tikz_scene(replace(picture, window=window, marks=()), LatexPrinter())
    frame = scene.frame.grown(0.01)
    assert all(frame.holds(Rectangle(x, y, x, y)) for area in scene.shades for x, y in area)
    curves = [stroke for stroke in scene.strokes if stroke.style == "boundary"]
    assert all(frame.holds(Rectangle(x, y, x, y)) for stroke in curves for x, y in stroke.points)


def test_long_windows_are_not_strips() -> None:
    window = ((Fraction(0), Fraction(1000)), (Fraction(0), Fraction(1)))
    scene = tikz_scene(replace(hand.hyperbola(), window=window, marks=()), LatexPrinter())
    assert scene.frame.top > 100
    poles = tikz_scene(replace(hand.second_order(), window=(window[0], (Fraction(-1), Fraction(1)))), LatexPrinter())
    assert poles.frame.top >= 100


@tabled
def test_ticks_are_round(low: float, high: float, labels: list[str]) -> None:
    assert [label for _, label in ticks(low, high)] == labels


def test_lines_are_clipped_thinned_and_joined() -> None:
    box = Rectangle(0, 0, 10, 10)
    assert list(clipped([(-5, 5), (5, 5), (5, 20), (8, 20), (8, 5)], box)) == [
        ((0, 5), (5, 5), (5, 10)),
        ((8, 10), (8, 5)),
    ]
    assert list(clipped([(-5, 5), (-1, 20)], box)) == []
    assert set(clipped_area([(-5, -5), (5, -5), (5, 5), (-5, 5)], box)) == {(0, 5), (0, 0), (5, 0), (5, 5)}
    assert clipped_area([(1, 1), (1, 2), (2, 2)], box) == ((2, 2), (1, 2), (1, 1))
    assert clipped_area([(-5, -5), (-4, -5), (-4, -4)], box) == ()
    assert thinned([(float(x), 0.0) for x in range(9)]) == ((0, 0), (8, 0))
    assert thinned([(0, 0), (4, 3), (0, 0)]) == ((0, 0), (4, 3), (0, 0))
    assert chained([((0, 0), (1, 0)), ((2, 0), (1, 0.1)), ((5, 5), (6, 6))]) == [
        ((5, 5), (6, 6)),
        ((2, 0), (1, 0.1), (1, 0), (0, 0)),
    ]


# -- captions ---------------------------------------------------------------------------------------------------------


def words(picture: Picture) -> str:
    printer = TextPrinter()
    parts = caption(picture)
    return "".join(part if isinstance(part, str) else printer.inline(part) for part in parts)  # type: ignore[arg-type]


def test_captions_say_what_is_shown() -> None:
    assert words(hand.pendulum()).startswith("Shaded: stable values of (h₁, h₂), boundary excluded. ")
    assert "test points" not in words(hand.pendulum())
    assert words(hand.pendulum()).endswith("Plotted for b = 1, ω = 1.")
    assert "Open circles: excluded points." in words(hand.ring_hole())
    assert words(replace(hand.ring_hole(), areas=(), marks=())) == (
        "No value of (h₁, h₂) in the range shown is stable."
    )
    window = Fraction(0), Fraction(1)
    assert words(LinePicture("k", window, ((None, None),))) == "All values of k shown are stable."
    assert words(LinePicture("k", window, ())) == "No value of k shown is stable."
    assert "Thick interval: stable values of k, endpoints excluded" in words(hand.interval())
    assert "Shaded half-plane: Re s < -1/2." in words(hand.third_order())
    assert "The shaded disc has radius 1." in words(hand.sampled())


def test_curves_that_divide_only_are_left_out_where_they_are_many() -> None:
    picture = hand.pendulum()
    lines = tuple(
        Curve(((Fraction(-3), Fraction(y)), (Fraction(3), Fraction(y))), equation(h2, y), boundary=False)
        for y in range(-2, 3)
    )
    few, many = (replace(picture, curves=(*picture.curves[:1], *lines[:n])) for n in (3, 5))
    assert "Dashed: curves" in words(few)
    assert "Dashed: curves" not in words(many)


# -- LaTeX ------------------------------------------------------------------------------------------------------------


@pytest.mark.slow
def test_all_pictures_are_typeset_without_a_fault(require_tool: Callable[[str], str], tmp_path: Path) -> None:
    pages = [page(name) for name in ALL]
    bodies = [LatexFragment().render(document(each)) for each in pages]
    article = LatexArticle().render(document(*pages, title="Pictures"))
    head, rest = article.split(r"\begin{document}")
    alone = "\n\n".join(tikz_file(ALL[name][0](), printers(name)[0]) for name in ALL)
    whole = head + r"\begin{document}" + alone + "\n".join(bodies) + rest
    (tmp_path / "page.tex").write_text(whole, encoding="utf-8")
    command = [require_tool("pdflatex"), "-interaction=nonstopmode", "-no-shell-escape", "page.tex"]
    subprocess.run(command, cwd=tmp_path, capture_output=True, check=False)
    log = (tmp_path / "page.log").read_text(encoding="latin-1")
    assert "Output written" in log
    assert FAULTS.findall(log) == []


def test_tikz_is_loaded_where_a_picture_is() -> None:
    assert r"\usepackage{tikz}" in LatexArticle().render(document(page("interval")))
    assert "pgfplots" not in LatexArticle().render(document(page("interval")))


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


def test_svg_sets_scripts_as_text() -> None:
    source = svg(svg_scene(hand.annulus(), TextPrinter()), TextPrinter())
    root = read(source)
    assert '<tspan font-style="italic">h</tspan><tspan dy="1.8" font-size="6.48">1</tspan>' in source
    written = ["".join(element.itertext()) for element in root.iter(f"{SVG}text")]
    assert {"h1", "h2", "h12 + h22 = 5", "−2"} <= set(written)
    poles = svg(svg_scene(hand.second_order(), TextPrinter()), TextPrinter())
    assert '>Re <tspan font-style="italic">s</tspan>' in poles


def test_svg_of_a_file_carries_the_caption() -> None:
    root = read(svg_file(hand.three_components(), TextPrinter()))
    written = " ".join("".join(element.itertext()) for element in root.iter(f"{SVG}text"))
    assert "boundary excluded." in written
    assert "Curve (1) is h13 +" in written


# -- matplotlib -------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("name", ["three_components", "four_pieces", "sampled"])
def test_matplotlib_draws_the_same(name: str) -> None:
    latex, text = printers(name)
    picture = ALL[name][0]()
    png = drawn_by_matplotlib(picture, "png", latex, text)
    assert png.startswith(b"\x89PNG\r\n\x1a\n")
    assert png == drawn_by_matplotlib(picture, "png", latex, text)
    assert drawn_by_matplotlib(picture, "pdf", latex, text).startswith(b"%PDF-")


def test_latex_that_matplotlib_does_not_know_is_plain_text() -> None:
    latex, text = LatexPrinter(symbols={"k": r"\unheardof{k}"}), TextPrinter()
    assert drawn_by_matplotlib(hand.interval(), "png", latex, text).startswith(b"\x89PNG")


def test_without_matplotlib_the_repair_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "matplotlib", None)
    monkeypatch.setitem(sys.modules, "matplotlib.figure", None)
    with pytest.raises(UsageError, match="pip install matplotlib"):
        drawn_by_matplotlib(hand.interval(), "png", LatexPrinter(), TextPrinter())


# -- terminals --------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("name", ALL)
def test_a_terminal_shows_a_sketch(name: str) -> None:
    shown = Text().render(document(page(name))).splitlines()
    assert max(map(len, shown)) <= WIDTH
    assert any(mark in line for line in shown for mark in "#━x")


def test_the_sketch_of_a_hyperbola() -> None:
    shown = Text().render(document(page("hyperbola"))).splitlines()
    rows = [line.partition("│")[2] for line in shown if "│" in line]
    assert len(rows) == 17
    assert {len(row) for row in rows} == {41}
    assert rows[-1] == "." * 41
    assert rows[0] == "." * 8 + "#" * 33
    assert rows[8] == "." * 10 + "#" * 31


@tabled
def test_a_line_is_drawn_as_it_is(last: str, line: str) -> None:
    """Both are stable where h k < 1, but on h = 0 s² + s + 1 is stable and s² + s is not."""
    result = symobs.stability_region(polynomial=f"s^2 + (1 - h k) s + {last}", parameters=("h", "k"))
    shown = str(result.to("text"))
    rows = re.findall(r" │([#.]{41})$", shown, re.MULTILINE)
    top, bottom = (float(end) for end in re.findall(r"^ *([-.\d]+) │[#.]", shown, re.MULTILINE))
    left, right = map(float, re.findall(r"─ h\n +(\S+) +(\S+)\n", shown)[0])
    assert len(rows) == 17
    for number, row in enumerate(rows):
        k = top + (bottom - top) * (number + 0.5) / 17
        for column, character in enumerate(row):
            h = left + (right - left) * (column + 0.5) / 41
            assert character == (line if column == 20 else "#" if h * k < 1 else "."), (h, k)


def test_the_sketch_of_a_line() -> None:
    shown = Text().render(document(page("four_pieces"))).strip().splitlines()
    assert shown[0].strip() == "━━━━━━━━━━━○──────────○━━━━○━━━━━━━━━━━━━━━━○○━━━━━━━━━━━━━━━ k"
    assert [line.split() for line in shown[1:3]] == [["-2", "0", "1", "4"], ["13/3"]]
    window = Fraction(-1), Fraction(1)
    whole = sketch(LinePicture("k", window, ((None, None),)), TextPrinter(), 80).splitlines()
    assert whole[0] == "━" * 61 + " k"
    assert whole[1].split() == ["-1.0", "-0.5", "0", "0.5", "1.0"]


def test_a_sentence_opens_the_caption_of_a_picture(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(PHRASES, "test_look", "The picture shows it.")
    derivation = page("interval")
    (step,) = derivation.steps
    assert isinstance(step, Plot)
    told = replace(derivation, steps=(replace(step, sentence=say("look")),))
    latex = LatexFragment().render(document(told))
    assert "Figure~1. The picture shows it. Thick interval" in latex
    assert latex.index("tikzpicture") < latex.index("Figure~1.")


def test_a_caption_holds_no_lists() -> None:
    with pytest.raises(TypeError):
        words_of((Roots(Letter("chi"), ()),), str, lambda _: [])


def test_marks_and_ends_may_be_anything_that_is_allowed() -> None:
    chi_line = LinePicture(
        "k",
        (Fraction(-1), Fraction(1)),
        ((None, End(Fraction(0), "≈0")),),
        ((Fraction(1, 2), "excluded"),),
    )
    assert "$" in tikz_file(chi_line, LatexPrinter())
    region = replace(hand.hyperbola(), marks=(MarkedPoint((Fraction(3), Fraction(3)), "excluded"),))
    assert "circle[radius=2.3]" in tikz_file(region, LatexPrinter())


def test_open_ends_are_drawn_from_left_to_right() -> None:
    ends = [End(Fraction(k * k, 7), Scalar.of(k)) for k in range(12)]  # a set of these is in another order
    picture = LinePicture("k", (Fraction(-1), Fraction(18)), tuple(pairwise(ends)))
    places = [sign.place[0] for sign in plot_scene(picture, lambda _: (4.0, 4.0), ENGLISH).signs if sign.kind == "ring"]
    assert list(set(places)) != sorted(places)
    assert places == sorted(places)
