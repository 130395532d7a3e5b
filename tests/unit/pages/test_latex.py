r"""LaTeX and terminal text: what is escaped, what TeX makes of it, and how a user changes the page."""

from __future__ import annotations

import re
import subprocess
from typing import TYPE_CHECKING

import pytest

import symobs
from symobs.exact import Matrix, Scalar
from symobs.formula.tree import Block, Environment, Formula, Letter, Literal, Negative, Numeral
from symobs.pages.formats.latex import LatexArticle, typeset
from symobs.pages.formats.templates import fill
from symobs.pages.formats.text import WIDTH, Text
from symobs.pages.printers.latex_printer import LETTERS, LatexPrinter, escape
from symobs.proof.derivation import Define, Derivation, Diagram, Equal, Note
from tests.kit import SERVO, tabled
from tests.support.examples import document_of
from tests.support.problems.steps import HandWritten, document, said, with_a_case

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path
s = Scalar.symbol("s")
FAULTS = re.compile(
    r"^(?:! .*|(?:LaTeX|Package|Class).*Warning.*|(?:Over|Under)full .*|Missing character.*)", re.MULTILINE
)


pytestmark = pytest.mark.usefixtures("own_phrases")


@pytest.fixture(name="faults")
def faults_in_log(require_tool: Callable[[str], str], tmp_path: Path) -> Callable[[str], list[str]]:
    """Typeset a document; what TeX finds wrong with it."""
    pdflatex = require_tool("pdflatex")

    def run(source: str) -> list[str]:
        (tmp_path / "page.tex").write_text(source, "utf-8")
        command = [pdflatex, "-interaction=nonstopmode", "-no-shell-escape", "page.tex"]
        subprocess.run(command, cwd=tmp_path, capture_output=True, check=False)
        log = (tmp_path / "page.log").read_text(encoding="latin-1")
        assert "Output written" in log
        return FAULTS.findall(log)

    return run


def a_loop(plant: Scalar, compensator: Scalar) -> list[Define | Equal | Diagram | Note]:
    """Both letters, and the loop drawn with what they stand for."""
    labels: dict[str, Formula] = {
        "r": Letter("r_in"),
        "u": Letter("u"),
        "y": Letter("y"),
        "P": Literal(plant),
        "F": Negative(Literal(compensator)),
        "response": Literal(plant / (1 + plant * compensator)),
    }
    known = (
        Define(said(Letter(name), value), silent=True) for name, value in zip("PF", (plant, compensator), strict=True)
    )
    return [*known, Diagram("loop", tuple(labels.items()))]


def page_with(*steps: Define | Equal | Diagram | Note, title: str = "") -> HandWritten:
    return document(Derivation(steps, Environment(signals={"u": None, "y": None})), title=title)


# -- text from outside ------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("text", "latex"),
    [
        (r"\input{x}", r"\textbackslash{}input\{x\}"),
        ("50% of $x_1^2$ & #~", r"50\% of \symbol{36}x\_1\textasciicircum{}2\symbol{36} \& \#\textasciitilde{}"),
        ("a < b | c > d", r"a \textless{} b \textbar{} c \textgreater{} d"),
        ('say "yes"', "say ``yes''"),
        ("a -- b", "a -{}- b"),
        ("?`!`", r"?\`{}!\`{}"),
        ("two\nlines\t\x00and\x07 \x1b[31mmore", "two lines and [31mmore"),
        ("Schrödinger, Łukasiewicz", "Schrödinger, Łukasiewicz"),
        ("o\u0308", "ö"),
        ("state x\u0302 and ẋ of ω", r"state $\hat x$ and $\dot x$ of $\omega$"),
        ("1 − 2 – 3", "1 $-$ 2 -- 3"),
        ("a\N{NO-BREAK SPACE}[1]", "a~[1]"),
        ("ω₀ Rₐ x₁", r"$\omega$$_0$ R$_a$ x$_1$"),
        ("漢 \ud800 \U0001f600", "? ? ?"),
        ("\u202eright to left\u200b", "right to left"),
        ("a\u0301\u0302\u0303", "?"),
    ],
)
def test_escape(text: str, latex: str) -> None:
    assert escape(text) == latex


def test_a_long_word_may_break() -> None:
    assert escape("x" * 60) == r"\allowbreak{}".join(["x" * 20] * 3)


def test_every_letter_kept_is_typeset(faults: Callable[[str], list[str]]) -> None:
    characters = [*sorted(LETTERS), *map(chr, range(0x20, 0x7F))]
    shown = [chr(code) for code in range(0xA1, 0x2300) if escape(chr(code)) not in {"", "?"}]
    words = "\n".join(escape(character) for character in [*characters, *shown])
    for style in ("", r"\bfseries "):
        values = {"title": "", "source": "", "conventions": "", "body": style + words, "drawings": False, "babel": ""}
        source = fill("article.tex", values)
        assert faults(source) == []


# -- pages ------------------------------------------------------------------------------------------------------------


def test_the_page_to_aim_at_is_typeset_without_a_fault(faults: Callable[[str], list[str]]) -> None:
    assert faults(LatexArticle().render(document_of("output_feedback_servo"))) == []


def test_a_page_in_another_language_is_typeset_without_a_fault(faults: Callable[[str], list[str]]) -> None:
    """With the hyphenation of the language or, where TeX has none, without any: never with the English one, its first."""
    plant = SERVO
    source = symobs.compensator(plant, control_poles=[-2, -2], observer_poles=[-10, -10]).to_latex(language="de")
    assert "ngerman" in source
    english = r"\ifnum\language=0 \ifnum\hyphenpenalty<10000 \errmessage{hyphenated as English}\fi\fi"
    assert faults(source.replace(r"\end{document}", f"{english}\n\\end{{document}}")) == []


@tabled
def test_a_loop_fits_its_page_whatever_its_labels(degree: int, faults: Callable[[str], list[str]]) -> None:
    long = sum((Scalar.of(10**5 + k) * s**k for k in range(degree)), s**degree)
    for plant, compensator in ((1 / s, 1 / long), (1 / long, 1 / s), (1 / long, 1 / long)):
        assert faults(LatexArticle().render(page_with(*a_loop(plant, compensator)))) == []


# -- templates --------------------------------------------------------------------------------------------------------


def test_a_user_replaces_one_block(tmp_path: Path, faults: Callable[[str], list[str]]) -> None:
    own = r"""\BLOCK{extends "article.tex"}
\BLOCK{block preamble}
\VAR{super()}
\usepackage{fancyhdr}
\BLOCK{endblock}
\BLOCK{block end}
%# not on the page
\textit{\VAR{title}: the end}
\BLOCK{endblock}
"""
    (tmp_path / "sheet.tex").write_text(own, "utf-8")
    latex = typeset(document(with_a_case(), title="100 %"), "sheet.tex", folder=tmp_path)
    assert r"\textit{100 \%: the end}" in latex
    assert latex.count("fancyhdr") == 1
    assert "not on the page" not in latex
    assert faults(latex) == []


def test_marks_of_templates_in_a_title_mean_nothing() -> None:
    latex = LatexArticle().render(document(title=r"\VAR{body} \BLOCK{raw} %% x"))
    assert r"\textbackslash{}VAR\{body\} \textbackslash{}BLOCK\{raw\} \%\% x" in latex


# -- terminals --------------------------------------------------------------------------------------------------------


def test_text_keeps_to_its_width() -> None:
    text = Text().render(document(*document_of("output_feedback_servo").derivations, with_a_case(), title="word " * 60))
    assert max(len(line) for line in text.splitlines()) <= WIDTH
    assert text.endswith("\n")


def test_nothing_in_a_title_steers_the_terminal() -> None:
    text = Text().render(document(title="\x1b[2J\x1b]0;x\x07clear\u202e\r\nnext \ud800"))
    assert text.splitlines()[0] == "[2J]0;xclear next ?"


# -- matrices and the words between displays --------------------------------------------------------------------------


def test_blocks_of_numbers_in_decimals_are_one_matrix_with_lines_between_them() -> None:
    third = Numeral(Scalar.of(1) / 3, "0.33333")
    rows = (
        (Literal(Matrix.of([[1, 2]])), Block(((third,),))),
        (Literal(Matrix.of([[3, 4]])), Block(((Negative(third),),))),
    )
    assert LatexPrinter().typeset(Block(rows)).source == (
        r"\left[\begin{array}{cc|c}1&2&0.33333\\\hline 3&4&-0.33333\rule{0pt}{2.4ex}\end{array}\right]"
    )
    names = (Block(((Letter("A"),),)), Block(((Letter("B"),),)))
    assert r"\hline" not in LatexPrinter().typeset(Block((names, names))).source
