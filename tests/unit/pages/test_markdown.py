r"""Markdown: what programs that read it would change is not there, and its mathematics is that of the LaTeX pages."""

from __future__ import annotations

import re

from symobs.exact import Matrix, Scalar
from symobs.formula.tree import Environment, Letter, Literal, Relation
from symobs.pages.formats.markdown import Markdown, paragraph, plain, portable
from symobs.proof.derivation import Define, Derivation
from tests.kit import tabled
from tests.support.examples import document_of
from tests.support.problems.steps import document

s, b = Scalar.symbol("s"), Scalar.symbol("b")
#: Everything in dollars, displays first.
MATHEMATICS = re.compile(r"\$\$ (.+?) \$\$|\$([^$]+)\$")


def formulas(page: str) -> list[str]:
    without_code = re.sub(r"```text\n.*?\n```", "", page, flags=re.DOTALL)
    return [display or inline for display, inline in MATHEMATICS.findall(without_code)]


def test_an_answer_is_boxed_a_check_marked_a_caution_quoted_and_a_loop_drawn() -> None:
    page = Markdown().render(document_of("output_feedback_servo"))
    assert r"\boxed{\begin{bmatrix}4&3\end{bmatrix}} $$" in page
    assert "> **Remark.** Since" in page
    assert sum(line.startswith("✓ ") for line in page.splitlines()) == 2  # one for each gain
    sketches = re.findall(r"\n\n```text\n(.*?)\n```\n\n", page, flags=re.DOTALL)
    assert any("┌" in sketch and "(319s + 400)/(s² + 23s + 161)" in sketch for sketch in sketches)


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


def test_a_symbol_of_several_letters_keeps_its_spaces() -> None:
    mass = Scalar.symbol("mass")
    steps = (Define(Relation((Letter("A"), Literal(Matrix.of([[mass * b]]))), ("=",))),)
    page = Markdown().render(document(Derivation(steps, Environment())))
    assert r"b\thinspace \mathit{mass}" in page
