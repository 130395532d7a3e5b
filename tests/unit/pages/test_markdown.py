r"""Markdown: what programs that read it would change is not there, and its mathematics is that of the LaTeX pages."""

from __future__ import annotations

import re

import pytest

from symobs.exact import Matrix, Scalar
from symobs.exact.algebraic.polynomial_roots import roots_of
from symobs.formula.phrases import PHRASES
from symobs.formula.tree import Environment, Letter, Literal, Relation, Roots
from symobs.pages.formats.markdown import Markdown, MarkdownWriter, paragraph, plain, portable
from symobs.pages.page.blocks import CaseBlock, Caution, Display, Paragraph, References
from symobs.pages.printers.latex_printer import LatexPrinter
from symobs.proof.derivation import Define, Derivation
from tests.kit import tabled
from tests.support.problems import render_examples as example
from tests.support.problems.render_examples import document

s, b = Scalar.symbol("s"), Scalar.symbol("b")
K, L = Letter("K"), Letter("L")
#: Everything in dollars, displays first.
MATHEMATICS = re.compile(r"\$\$ (.+?) \$\$|\$([^$]+)\$")


@pytest.fixture(autouse=True)
def _phrases(monkeypatch: pytest.MonkeyPatch) -> None:
    for key, phrase in example.PHRASES.items():
        monkeypatch.setitem(PHRASES, key, phrase)


def writer() -> MarkdownWriter:
    return MarkdownWriter(LatexPrinter())


def formulas(page: str) -> list[str]:
    without_code = re.sub(r"```text\n.*?\n```", "", page, flags=re.DOTALL)
    return [display or inline for display, inline in MATHEMATICS.findall(without_code)]


def test_the_page_to_aim_at() -> None:
    page = Markdown().render(example.target_document())
    lines = page.splitlines()
    assert lines[0] == "# Output feedback of 1/(s(s+1)) with a full-order observer"
    assert [line for line in lines if line.startswith("## ")] == [
        "## Given",
        "## 1. State feedback",
        "## 2. Observer",
        "## 3. Compensator",
        "## 4. Closed loop",
    ]
    assert sum(line.startswith("✓ ") for line in lines) == 2
    assert r"=\boxed{\begin{bmatrix}4&3\end{bmatrix}} $$" in page
    assert "> **Remark.** The double pole at $-2$ is defective" in page
    (sketch,) = re.findall(r"\n\n```text\n(.*?)\n```\n\n", page, flags=re.DOTALL)
    assert "┌" in sketch
    assert "(319s + 400)/(s² + 23s + 161)" in sketch


def test_mathematics_has_no_backslash_before_punctuation_and_no_angle_brackets() -> None:
    page = Markdown().render(example.target_document())
    found = formulas(page)
    assert len(found) > 30
    assert [formula for formula in found if re.search(r"\\[^A-Za-z]|[<>|\n]", formula)] == []


def test_portable_mathematics_is_the_same_mathematics() -> None:
    latex = r"a<b\,\mathit{c}\;\{d\}\\[3pt]\left.e\right|_{t=0}\\\ f>\answer{g}\allowbreak h\leq1\allowbreak\ 2"
    wanted = (
        r"a\lt b\thinspace \mathit{c}\thickspace \lbrace d\rbrace \cr \left.e\right\vert _{t=0}"
        r"\cr \space f\gt \boxed{g}h\leq1\space 2"
    )
    assert portable(latex) == wanted


@tabled
def test_text_is_escaped(text: str, markdown: str) -> None:
    assert plain(text) == markdown


@tabled
def test_a_paragraph_begins_no_list(line: str, markdown: str) -> None:
    assert paragraph(line) == markdown


def test_a_case_is_a_quotation_with_its_displays_on_one_line() -> None:
    page = writer().block(
        CaseBlock(("Case ",), (Paragraph(("so",)), Display((Relation((K, L), ("=",)),), closing=".")))
    )
    assert page == "> **Case **\n>\n> so\n>\n> $$ K=L. $$"


def test_references_are_no_warnings() -> None:
    assert writer().block(Caution("Remark.", ("x",))).startswith("> **Remark.** ")
    assert writer().block(References("References", ("x",))) == "**References**\n\n- \\[1\\] x"


def test_rows_of_a_display_are_aligned() -> None:
    wide = Matrix.of([[10**9 + k + 3 * j for k in range(5)] for j in range(2)])
    relations = tuple(Relation((letter, Literal(wide)), ("=",)) for letter in (K, L))
    display = writer().display(relations)
    assert display.startswith(r"$$ \begin{aligned}K&=\begin{bmatrix}1000000000&")
    assert r"\end{bmatrix},\cr L&=\begin{bmatrix}" in display
    assert display.endswith(r"\end{bmatrix}.\end{aligned} $$")


def test_roots_without_a_form_are_a_set() -> None:
    sentence = writer().sentence(("The poles are ", Roots(Letter("phi"), roots_of(s**5 - s - 1, "s")), "."))
    assert sentence == r"The poles are $\lbrace s:s^5-s-1=0\rbrace$."


def test_a_symbol_of_several_letters_keeps_its_spaces() -> None:
    mass = Scalar.symbol("mass")
    steps = (Define(Relation((Letter("A"), Literal(Matrix.of([[mass * b]]))), ("=",))),)
    page = Markdown().render(document(Derivation(steps, Environment())))
    assert r"b\thinspace \mathit{mass}" in page
