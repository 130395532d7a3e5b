"""Text from outside stays text, wherever it stands and whatever typesets or shows it: a part of the corpus, for real.

All of it: `python -m tests.support.tampering.injection`.
"""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any

import pytest

from symobs.applications.audit import Audited, Finding, report
from symobs.formula.convention.convention import read_convention
from symobs.ground.errors import InputError, ProblemErrors
from symobs.pages.formats.pdf import compiled
from symobs.system import Symbols
from tests.kit import tabled
from tests.support.tampering import injection
from tests.support.tampering.injection import SECRET, TEXTS, corpus, printable, problem
from tests.support.tools.browser import Watched
from tests.support.tools.command_line import inside

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence
    from pathlib import Path

    RequireTool = Callable[[str], str]

pytestmark = pytest.mark.slow


def part(folder: Path, step: int) -> list[str]:
    """Every text of the corpus that is a multiple of `step` away from the first, so that all kinds are among them."""
    return [text for text in corpus(folder) if printable(text)][::step]


def article(lines: Sequence[str]) -> str:
    packages = r"\usepackage{amsmath,amssymb,mathtools}"
    return "\n\n".join([rf"\documentclass{{article}}{packages}\begin{{document}}", *lines, r"\end{document}"])


# -- titles, sources and words ----------------------------------------------------------------------------------------


def test_a_pdf_shows_hostile_texts_and_does_nothing(require_tool: RequireTool, tmp_path: Path) -> None:
    for tool in ("pdflatex", "pdftotext"):
        require_tool(tool)
    assert list(injection.faults_of_pdf(part(tmp_path, 83), tmp_path)) == []


def test_a_web_page_shows_hostile_texts_and_does_nothing(chromium: Any, tmp_path: Path) -> None:
    assert list(injection.faults_of_web(part(tmp_path, 83), tmp_path, Watched(chromium))) == []


def test_markdown_shows_hostile_texts_and_means_nothing(tmp_path: Path) -> None:
    assert list(injection.faults_of_markdown(part(tmp_path, 41), tmp_path)) == []


@tabled
def test_a_text_that_is_not_escaped_is_noticed(
    text: str, monkeypatch: pytest.MonkeyPatch, require_tool: RequireTool, tmp_path: Path
) -> None:
    require_tool("pdflatex")
    monkeypatch.setattr("symobs.pages.formats.latex.escape", str)
    text = text.replace("CANARY", str(tmp_path / "canary")).replace("OWNED", str(tmp_path / "owned"))
    assert list(injection.faults_of_pdf([text], tmp_path)) != []


def test_slides_and_documents_of_others_show_hostile_texts(require_tool: RequireTool, tmp_path: Path) -> None:
    require_tool("pdflatex")
    texts = part(tmp_path, 401)
    names = injection.files(texts, tmp_path)
    slides = inside("sheet", *names, "--title", texts[0], "--format", "beamer", folder=tmp_path)
    assert slides.code == 0, slides.err
    fragments = [inside("solve", name, "--format", "fragment", folder=tmp_path).out for name in names]
    for page in (slides.out, article(fragments)):
        words = injection.words_of(compiled(page))
        assert SECRET not in words
        assert injection.lost(texts, words) == []


# -- names of files ---------------------------------------------------------------------------------------------------


def test_a_file_without_a_title_is_titled_by_its_name(require_tool: RequireTool, tmp_path: Path) -> None:
    require_tool("pdflatex")
    texts = [text for text in TEXTS if printable(text) and "/" not in text and 0 < len(text.encode()) < 200]
    texts = [text for text in texts if "CANARY" not in text and "OWNED" not in text and text.strip() == text][::3]
    for text in texts:
        (tmp_path / f"{text}.toml").write_text(problem(""), "utf-8")
    names = [f"./{text}.toml" for text in texts]
    before = set(tmp_path.iterdir())
    run = inside("sheet", *names, "--questions", "-o", "out.pdf", folder=tmp_path)
    assert run.code == 0, run.err
    assert list(injection.faults_of_folder(tmp_path, before)) == []
    words = injection.words_of((tmp_path / "out.pdf").read_bytes())
    shown = [text for text in texts if "." not in text]  # the rest has a suffix before its suffix
    assert injection.lost(shown, words) == []


# -- what stands inside formulas --------------------------------------------------------------------------------------


def test_the_printed_form_of_a_symbol_is_a_letter_or_refused(require_tool: RequireTool, tmp_path: Path) -> None:
    require_tool("pdflatex")
    taken: list[str] = []
    for text in corpus(tmp_path):
        try:
            taken.append(Symbols.of({"b": {"latex": text}}).latex["b"])
        except InputError:
            continue
    assert all(set("\\%#$&~^") & set(text) <= {"\\", "^"} and "^^" not in text for text in taken), taken
    words = injection.words_of(compiled(article([f"${text}$" for text in taken] or ["x"])))
    assert SECRET not in words


def test_hostile_texts_name_no_symbol_and_no_letter(tmp_path: Path) -> None:
    for text in corpus(tmp_path):
        for declared in (lambda t: Symbols.of({t: "real"}), lambda t: read_convention({"name": t}, "own.toml")):
            try:
                declared(text)
            except InputError:
                continue
            assert text.replace("_", "").replace("-", "").isalnum(), text
        for letter in ("K", "e", "phi_o"):
            table = {"name": "own", "letters": {letter: text}, "feedback": f"u = {text} x_hat"}
            with pytest.raises(ProblemErrors):
                read_convention(table, "own.toml")


# -- templates and audits ---------------------------------------------------------------------------------------------


def test_what_reaches_a_template_of_the_user_is_escaped(require_tool: RequireTool, tmp_path: Path) -> None:
    require_tool("pdflatex")
    body = "\\VAR{title}\n\n\\VAR{source}\n\n\\VAR{title}\\VAR{source}\n\n\\textbf{\\VAR{title}} \\VAR{body}"
    own = tmp_path / "own"
    own.mkdir()
    (own / "article.tex").write_text(article([body]).replace(r"\begin{document}", _COMMANDS), "utf-8")
    pages: list[str] = []
    head, texts = "", part(tmp_path, 301)
    for text in texts:
        (tmp_path / "p.toml").write_text(problem(text, text), "utf-8")
        run = inside("solve", "p.toml", "--templates", "own", folder=tmp_path)
        assert run.code == 0, run.err
        head, _, rest = run.out.partition(r"\begin{document}")
        pages.append(rest.rpartition(r"\end{document}")[0])
    words = injection.words_of(compiled("\n\n".join([head, r"\begin{document}", *pages, r"\end{document}"])))
    assert SECRET not in words
    assert injection.lost(texts, words) == []


_COMMANDS = (
    r"\newcommand{\answer}[1]{#1}\newcommand{\verified}[1]{#1}\newcommand{\caution}[2]{#1 #2}"
    r"\newenvironment{inset}{}{}\begin{document}"
)


def test_an_audit_shows_hostile_texts(tmp_path: Path) -> None:
    for text in corpus(tmp_path):
        found = {text: Audited(text, 1, (Finding(text, text, text, text, text),))}
        rows = [line for line in report(found, "markdown").splitlines() if line.startswith("| ")][1:]
        (row,) = rows
        cells = row.removeprefix("| ").removesuffix(" |").split(" | ")
        assert len(cells) == 5, row
        for cell in cells:
            inside_code = cell.startswith("`") and cell.endswith("`") and "`" not in cell[1:-1]
            assert inside_code or not injection.MEANS.search(cell), cell
        written = report(found, "text")
        assert all(character.isprintable() or character == "\n" for character in written)
        json.loads(report(found, "json"))
