"""The worked examples as pages: in HTML and Markdown, and in a browser that shows them on wide and narrow screens."""

from __future__ import annotations

import random
import re
import unicodedata
import xml.etree.ElementTree as ET
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest

from symobs.formula.convention import STANDARD, convention_named
from symobs.formula.notation import GREEK
from symobs.formula.tree import Formula, Letter, Relation
from symobs.pages.formats.html import page
from symobs.pages.page.blocks import CaseBlock, Display, Drawing, Heading, PictureBlock, TableBlock, Verified, every
from symobs.pages.page.narrator import narrate, printer_for
from symobs.pages.printers.latex_printer import LatexPrinter
from symobs.pages.printers.mathml import MathmlPrinter
from symobs.tasks.result import render
from tests.kit import tabled, tables
from tests.pages.test_worked_examples import solved
from tests.support.examples import EXAMPLES as FILES
from tests.support.examples import document_of
from tests.support.sampling import every as sampled
from tests.support.tools.browser import Watched
from tests.unit.pages.test_html import faults, local, parsed
from tests.unit.pages.test_markdown import formulas
from tests.unit.pages.test_printers import hostile_members

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from symobs.pages.page.blocks import Block
    from symobs.tasks.result import Document

pytestmark = pytest.mark.slow


def some(start: int) -> pytest.MarkDecorator:
    """Ask one example in two, from another start for another test."""
    return pytest.mark.parametrize("name", [path.stem for path in sampled(2, FILES, start)])


# -- the same mathematics ---------------------------------------------------------------------------------------------

_COMMANDS = tables(Path(__file__))["commands"]
_COMMANDS |= {"not": "≢", "equiv": "", "sim": "\N{TILDE OPERATOR}", "ast": "\N{ASTERISK OPERATOR}", "pm": "±"}
_COMMANDS |= {"approx": "≈", "int": "∫", "sum": "∑", "cdot": "⋅", "times": "×", "ldots": "..."}
_COMMANDS |= {
    name: unicodedata.lookup(f"GREEK {'SMALL' if name.islower() else 'CAPITAL'} LETTER {name.upper()}")
    for name in GREEK
    if name.lower() != "lambda"
}
_SAID = {"det", "sin", "cos", "sinh", "cosh", "arccos", "arcsin", "arctan"}
_UNSEEN = {"\u2061", "\u2062", "\xa0", " "}


def glyphs_of_latex(source: str) -> str:
    """The characters that LaTeX would set, in order; no accents, no spaces, matrices as their entries in brackets."""
    lines = r"\\hline|\\rule\{0pt\}\{[\d.]+ex\}"
    source = re.sub(
        rf"\\begin\{{array\}}\{{[c|]+\}}|\\end\{{array\}}|{lines}|\\(?:left|right)\.|\\\\\[\d+pt\]", "", source
    )
    source = re.sub(r"\\(?:begin|end)\{bmatrix\}", lambda m: "[" if "begin" in m[0] else "]", source)
    glyphs = ""
    for command, sign in re.findall(r"\\([A-Za-z]+)|(\\.|.)", source.replace(r"\\", "")):
        if command:
            glyphs += command if command in _SAID else _COMMANDS.get(command, "")
        elif sign[0] != "\\" and sign not in "{}^_& ~":
            glyphs += sign
    return glyphs.replace("-", "−").replace("'", "′").replace("*", "\N{ASTERISK OPERATOR}")


def glyphs_of_mathml(node: ET.Element) -> str:
    """The characters of elements, in order, without accents."""
    if node.tag == "mover":
        return glyphs_of_mathml(node[0])
    inside = (node.text or "") + "".join(map(glyphs_of_mathml, node))
    return "".join(c for c in unicodedata.normalize("NFKC", inside) if c not in _UNSEEN)


def formulas_in(blocks: Sequence[Block]) -> Iterator[Formula | Relation]:
    for block in every(blocks):
        if isinstance(block, Display):
            yield from block.relations
        for inline in (*getattr(block, "inlines", ()), *getattr(block, "label", ())):
            if isinstance(inline, Formula | Relation):
                yield inline


def differing(document: Document) -> Iterator[tuple[str, str]]:
    """The formulas of a document whose MathML shows other characters than their LaTeX; at least one is looked at."""
    latex, mathml = printer_for(document, LatexPrinter), printer_for(document, MathmlPrinter)
    formulas = list(formulas_in(narrate(document)))
    assert formulas
    for formula in formulas:
        shown = ET.fromstring(f"<math>{mathml.unbroken(formula)}</math>")  # noqa: S314 - our own output
        pair = glyphs_of_mathml(shown), glyphs_of_latex(latex.unbroken(formula))
        if pair[0] != pair[1]:
            yield pair


@some(0)
def test_every_formula_has_the_characters_that_it_has_in_latex(name: str) -> None:
    assert list(differing(document_of(name))) == []


@tabled
@pytest.mark.parametrize("name", ["output_feedback_servo", "servo_minimal_order", "servo_tracking"])
def test_formulas_in_the_letters_of_other_books(name: str, convention: str) -> None:
    found, results = solved(next(path for path in FILES if path.stem == name))
    document = found.document(results, convention_named(convention))
    assert list(differing(document)) == []
    standard, here = (str(render(found.document(results, kind), "html")) for kind in (STANDARD, document.convention))
    assert list(faults(here)) == []
    assert (standard == here) == document.convention.is_standard


# -- pages ------------------------------------------------------------------------------------------------------------


@some(0)
def test_every_example_is_a_page_of_html(name: str) -> None:
    document = document_of(name)
    html = str(render(document, "html"))
    blocks = list(every(narrate(document)))
    assert list(faults(html)) == []
    assert list(faults(str(render(document, "html_fragment")))) == []
    nodes = list(parsed(html).iter())
    kinds = [node.get("class") for node in nodes]
    tables = sum(isinstance(block, TableBlock) for block in blocks)
    displays = sum(isinstance(block, Display) for block in blocks)
    assert displays <= kinds.count("display") <= displays + tables
    assert kinds.count("case") == sum(isinstance(block, CaseBlock) for block in blocks)
    assert kinds.count("answer") == sum(isinstance(block, Display) and block.boxed for block in blocks)
    assert kinds.count("verified") == sum(isinstance(block, Verified) for block in blocks)
    headings = [node for node in nodes if re.fullmatch("h[2-6]", local(node))]
    assert len(headings) == sum(isinstance(block, Heading) for block in blocks)
    assert len({node.get("id") for node in headings}) == len(headings)
    pictures = [node for node in nodes if local(node) == "svg" or node.get("role") == "img"]
    assert len(pictures) == sum(isinstance(block, PictureBlock | Drawing) for block in blocks)
    assert not re.search(
        r"\bNone\b|Scalar\(|Matrix\(|symobs\.|\\[a-z]", re.sub(r"<style>.*?</style>", "", html, flags=re.DOTALL)
    )


@some(1)
def test_every_example_is_markdown(name: str) -> None:
    document = document_of(name)
    markdown = str(render(document, "markdown"))
    displays = sum(isinstance(block, Display) for block in every(narrate(document)))
    assert markdown.startswith("# ")
    in_cells = markdown.count(r"$\displaystyle ")
    assert markdown.count("$$ ") + in_cells >= displays
    without_lines = re.sub(r"\\begin\{array\}\{[c|]+\}", "", markdown)
    assert [
        found for found in formulas(without_lines) if re.search(r"\\[^A-Za-z]|[<>|]|answer|allowbreak", found)
    ] == []
    rows = [line for line in markdown.splitlines() if line.startswith("|")]
    assert not any("{array}" in row for row in rows)  # a line of a matrix would end the cell of a table
    assert markdown.count("$") % 2 == 0
    assert not re.search(r"\bNone\b|Scalar\(|Matrix\(", markdown)


# -- in a browser -----------------------------------------------------------------------------------------------------

WIDE, NARROW, PAPER = 1000, 360, 612  # pixels; paper is A4 without its margins
MEASURED = """(() => {
  const box = element => element.getBoundingClientRect();
  const all = (selector, wrong) => [...document.querySelectorAll(selector)].filter(wrong)
    .map(element => element.textContent.slice(0, 60));
  const fenced = table => [table.previousElementSibling, table.nextElementSibling]
    .every(fence => fence && box(fence).height >= 0.9 * box(table).height);
  const root = document.documentElement;
  return {
    beyond: root.scrollWidth - root.clientWidth,
    unseen: all('math, svg, pre', element => box(element).width < 2 || box(element).height < 2),
    low: all('mtable:not([class])', table => !fenced(table)),
    merged: all('mover', over => '.¯'.includes(over.lastElementChild.textContent[0])
      && box(over.firstElementChild).top - box(over.lastElementChild).bottom < 1),
    ragged: all('mtable.aligned > mtr > mtd:first-child',
      cell => cell.lastElementChild && box(cell).right - box(cell.lastElementChild).right > 2),
    cut: all('p, .display, .table, pre, figure', element => element.scrollWidth > element.clientWidth),
    hidden: all('p, .display', element => element.scrollHeight > element.clientHeight + 1),
    colours: getComputedStyle(document.body).color + getComputedStyle(root).backgroundColor,
  };
})()"""


def test_every_example_shows_in_a_browser(chromium: Any, tmp_path: Path) -> None:
    browser = Watched(chromium)
    for name in [path.stem for path in sampled(3, FILES)]:
        path = tmp_path / f"{name}.html"
        path.write_text(str(render(document_of(name), "html")), "utf-8")
        browser.show(WIDE)
        browser.open(path)
        assert browser.complaints == [], name
        assert browser.requests == [path.as_uri()], name
        wide: dict[str, Any] = browser.page.evaluate(MEASURED)
        assert wide["beyond"] == 0, name
        assert [wide[fault] for fault in ("unseen", "low", "merged", "ragged", "hidden")] == [[]] * 5, name
        browser.show(NARROW)
        assert browser.page.evaluate(MEASURED)["beyond"] == 0, name
        browser.show(PAPER, "print")
        paper: dict[str, Any] = browser.page.evaluate(MEASURED)
        assert (paper["beyond"], paper["cut"]) == (0, []), name
    browser.show(WIDE)
    light: str = browser.page.evaluate(MEASURED)["colours"]
    browser.show(WIDE, scheme="dark")
    dark: str = browser.page.evaluate(MEASURED)["colours"]
    assert light != dark


def test_no_formula_is_wider_than_its_page(chromium: Any, tmp_path: Path) -> None:
    """Polynomials of hundreds of terms, numbers of hundreds of digits, wide matrices: displayed, and in running text."""
    printer, source = MathmlPrinter(), random.Random(4)  # noqa: S311
    shown = [
        f'<div class="display">{printer.display([Relation((Letter("A"), member), ("=",))])}</div>'
        if place % 2
        else f"<p>In a line {printer.inline(member)}, and on.</p>"
        for place, member in enumerate(hostile_members(source))
        if place % 5 < 2
    ]
    path = tmp_path / "hostile.html"
    path.write_text(page("Hostile", "\n".join(shown)), "utf-8")
    browser = Watched(chromium)
    browser.open(path)
    for width, media in ((WIDE, "screen"), (PAPER, "print")):
        browser.show(width, media)
        measured = browser.page.evaluate(MEASURED)
        assert (measured["beyond"], measured["cut"], measured["unseen"]) == (0, [], [])
    browser.show(NARROW)
    assert browser.page.evaluate(MEASURED)["beyond"] == 0


def test_the_browser_would_say_what_is_wrong(chromium: Any, tmp_path: Path) -> None:
    path = tmp_path / "wrong.html"
    path.write_text(
        "<!DOCTYPE html><meta charset='utf-8'><p style='width:2000px'>wide</p><math></math>"
        "<math><mrow><mo stretchy='false'>[</mo><mtable><mtr><mtd>1</mtd></mtr><mtr><mtd>2</mtd></mtr></mtable>"
        "<mo>]</mo></mrow></math><img src='http://127.0.0.1:9/x.png'><script>console.log('x')</script>",
        encoding="utf-8",
    )
    browser = Watched(chromium)
    browser.show(WIDE)
    browser.open(path)
    assert len(browser.complaints) == 2
    assert browser.requests == [path.as_uri(), "http://127.0.0.1:9/x.png"]
    measured = browser.page.evaluate(MEASURED)
    assert measured["beyond"] > 0
    assert (measured["unseen"], measured["low"]) == ([""], ["12"])
