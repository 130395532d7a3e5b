"""The worked examples as pages: in HTML and Markdown, and in a browser that shows them on wide and narrow screens."""

from __future__ import annotations

import re
import unicodedata
import xml.etree.ElementTree as ET
from typing import TYPE_CHECKING, Any

from symobs.formula import Formula, Relation
from symobs.method import render
from symobs.notation import GREEK
from symobs.render.blocks import CaseBlock, Display, Drawing, Heading, PictureBlock, TableBlock, every
from symobs.render.latex_printer import LatexPrinter
from symobs.render.mathml_printer import MathmlPrinter
from symobs.render.narrator import narrate, printer_for
from tests.browser import Browser
from tests.test_html import faults, local, parsed
from tests.test_markdown import formulas
from tests.test_worked_examples import FILES, solved

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Sequence
    from pathlib import Path

    from symobs.method import Document
    from symobs.render.blocks import Block


def documents() -> Iterator[tuple[str, Document]]:
    for path in FILES:
        found, results = solved(path)
        yield path.stem, found.document(results)


# -- the same mathematics ---------------------------------------------------------------------------------------------

_COMMANDS = {"varphi": "φ", "varepsilon": "ε", "lambda": "λ", "Lambda": "Λ", "le": "≤", "ge": "≥", "neq": "≠"}
_COMMANDS |= {"not": "≢", "equiv": "", "sim": "\N{TILDE OPERATOR}", "ast": "\N{ASTERISK OPERATOR}", "pm": "±"}
_COMMANDS |= {"int": "∫", "sum": "∑", "cdot": "⋅", "times": "×", "ldots": "..."}
_COMMANDS |= {
    name: unicodedata.lookup(f"GREEK {'SMALL' if name.islower() else 'CAPITAL'} LETTER {name.upper()}")
    for name in GREEK
    if name.lower() != "lambda"
}
_SAID = {"det", "sin", "cos", "sinh", "cosh"}
_UNSEEN = {"\u2061", "\u2062", "\xa0", " "}


def glyphs_of_latex(source: str) -> str:
    """The characters that LaTeX would set, in order; no accents, no spaces, matrices as their entries in brackets."""
    source = re.sub(r"\\begin\{array\}\{c+\}|\\end\{array\}|\\(?:left|right)\.|\\\\\[\d+pt\]", "", source)
    source = re.sub(r"\\(?:begin|end)\{bmatrix\}", lambda m: "[" if "begin" in m[0] else "]", source)
    glyphs = ""
    for command, sign in re.findall(r"\\([A-Za-z]+)|(\\.|.)", source.replace(r"\\", "")):
        if command:
            glyphs += command if command in _SAID else _COMMANDS.get(command, "")
        elif sign[0] != "\\" and sign not in "{}^_& ~":
            glyphs += sign
    return glyphs.replace("-", "−").replace("'", "′")


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


def test_every_formula_has_the_characters_that_it_has_in_latex() -> None:
    seen = 0
    for name, document in documents():
        latex, mathml = printer_for(document, LatexPrinter), printer_for(document, MathmlPrinter)
        for formula in formulas_in(narrate(document)):
            shown = ET.fromstring(f"<math>{mathml.unbroken(formula)}</math>")  # noqa: S314 - our own output
            assert glyphs_of_mathml(shown) == glyphs_of_latex(latex.unbroken(formula)), name
            seen += 1
    assert seen > 2500


# -- pages ------------------------------------------------------------------------------------------------------------


def test_every_example_is_a_page_of_html() -> None:
    for name, document in documents():
        page = str(render(document, "html"))
        blocks = list(every(narrate(document)))
        assert list(faults(page)) == [], name
        assert list(faults(str(render(document, "html_fragment")))) == [], name
        nodes = list(parsed(page).iter())
        kinds = [node.get("class") for node in nodes]
        tables = sum(isinstance(block, TableBlock) for block in blocks)
        displays = sum(isinstance(block, Display) for block in blocks)
        assert displays <= kinds.count("display") <= displays + tables, name
        assert kinds.count("case") == sum(isinstance(block, CaseBlock) for block in blocks), name
        assert kinds.count("answer") == sum(isinstance(block, Display) and block.boxed for block in blocks), name
        headings = [node for node in nodes if re.fullmatch("h[2-6]", local(node))]
        assert len(headings) == sum(isinstance(block, Heading) for block in blocks), name
        assert len({node.get("id") for node in headings}) == len(headings), name
        pictures = [node for node in nodes if local(node) == "svg" or node.get("role") == "img"]
        assert len(pictures) == sum(isinstance(block, PictureBlock | Drawing) for block in blocks), name
        assert not re.search(
            r"\bNone\b|Scalar\(|Matrix\(|symobs\.|\\[a-z]", re.sub(r"<style>.*?</style>", "", page, flags=re.DOTALL)
        ), name


def test_every_example_is_markdown() -> None:
    for name, document in documents():
        page = str(render(document, "markdown"))
        displays = sum(isinstance(block, Display) for block in every(narrate(document)))
        assert page.startswith("# "), name
        assert page.count("$$ ") >= displays, name
        assert [found for found in formulas(page) if re.search(r"\\[^A-Za-z]|[<>|]|answer|allowbreak", found)] == [], (
            name
        )
        assert page.count("$") % 2 == 0, name
        assert not re.search(r"\bNone\b|Scalar\(|Matrix\(", page), name


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
    ragged: all('mtable.aligned > mtr > mtd:first-child',
      cell => cell.lastElementChild && box(cell).right - box(cell.lastElementChild).right > 2),
    cut: all('p, .display, .table, pre, figure', element => element.scrollWidth > element.clientWidth),
    hidden: all('p, .display', element => element.scrollHeight > element.clientHeight + 1),
    colours: getComputedStyle(document.body).color + getComputedStyle(root).backgroundColor,
  };
})()"""


def test_every_example_shows_in_a_browser(require_tool: Callable[[str], str], tmp_path: Path) -> None:
    with Browser(require_tool("chromium")) as browser:
        for name, document in documents():
            page = tmp_path / f"{name}.html"
            page.write_text(str(render(document, "html")), encoding="utf-8")
            browser.media()
            browser.size(WIDE)
            browser.open(page)
            assert browser.complaints() == [], name
            assert browser.requests() == [page.as_uri()], name
            wide: dict[str, Any] = browser.value(MEASURED)
            assert wide["beyond"] == 0, name
            assert [wide[fault] for fault in ("unseen", "low", "ragged", "hidden")] == [[], [], [], []], name
            browser.size(NARROW)
            assert browser.value(MEASURED)["beyond"] == 0, name
            browser.media("print")
            browser.size(PAPER)
            paper: dict[str, Any] = browser.value(MEASURED)
            assert (paper["beyond"], paper["cut"]) == (0, []), name
        browser.media()
        light: str = browser.value(MEASURED)["colours"]
        browser.media(dark=True)
        dark: str = browser.value(MEASURED)["colours"]
        assert light != dark


def test_the_browser_would_say_what_is_wrong(require_tool: Callable[[str], str], tmp_path: Path) -> None:
    page = tmp_path / "wrong.html"
    page.write_text(
        "<!DOCTYPE html><meta charset='utf-8'><p style='width:2000px'>wide</p><math></math>"
        "<math><mrow><mo stretchy='false'>[</mo><mtable><mtr><mtd>1</mtd></mtr><mtr><mtd>2</mtd></mtr></mtable>"
        "<mo>]</mo></mrow></math><img src='http://127.0.0.1:9/x.png'><script>console.log('x')</script>",
        encoding="utf-8",
    )
    with Browser(require_tool("chromium")) as browser:
        browser.size(WIDE)
        browser.open(page)
        assert len(browser.complaints()) == 2
        assert browser.requests() == [page.as_uri(), "http://127.0.0.1:9/x.png"]
        measured = browser.value(MEASURED)
        assert measured["beyond"] > 0
        assert (measured["unseen"], measured["low"]) == ([""], ["12"])
