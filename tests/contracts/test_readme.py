"""README.md and the guide do what they say: Python gives the values in its comments, shell lines run on the problem file."""

from __future__ import annotations

import re
import shlex
from typing import TYPE_CHECKING, Any

import pytest
import sympy

from symobs.tasks.result import tasks
from tests.kit import tabled
from tests.support.paths import ROOT
from tests.support.tools.command_line import fresh

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

README, GUIDE = ((ROOT / path).read_text("utf-8") for path in ("README.md", "docs/guide.md"))
#: What a page of the repository links to, from its own folder.
LINK = re.compile(r"\]\((?!https?:)([^)#\s]+)\)")


def blocks(language: str, text: str = README + GUIDE) -> list[str]:
    return re.findall(rf"^```{language}\n(.*?)^```", text, re.MULTILINE | re.DOTALL)


def promised() -> list[tuple[str, str]]:
    """Every line `expression  # comment` of the Python blocks."""
    return re.findall(r"^(design\.\S+?) +# (.+)$", "\n".join(blocks("python")), re.MULTILINE)


def test_the_table_of_the_readme_names_every_task() -> None:
    assert {name for name in tasks() if f"`{name}`" not in README} == set()


def test_python_gives_the_values_in_its_comments() -> None:
    names: dict[str, Any] = {}
    compared = 0
    for block in blocks("python"):
        exec(block, names)  # noqa: S102 - the text of our own README
        for expression, comment in re.findall(r"^(design\.\S+?) +# (.+)$", block, re.MULTILINE):
            value = eval(expression, names)  # noqa: S307
            exact = re.match(r"Matrix\(.*\)|\(.*\)/\(.*?\)(?=,|$)", comment)
            if exact:
                difference = eval(exact[0], {"Matrix": sympy.Matrix, "s": sympy.Symbol("s")}) - value  # noqa: S307
                assert sympy.simplify(difference) == difference * 0, expression
                compared += 1
    assert compared == 3
    design = names["design"]
    c = sympy.Symbol("c")
    assert sympy.simplify(design.L - sympy.Matrix([-3, 6]) / (2 * c - 1)) == sympy.zeros(2, 1)
    assert [str(condition) for condition in design.conditions] == ["Ne(2*c - 1, 0)"]
    survivors = [case for case in design.cases if case.result is not None and case.result.verdict == "yes"]
    assert [case.when for case in survivors] == [(sympy.Eq(c - 1, 0),)]
    assert names["several"].family["parameters"] == ("g1", "g2", "g3")
    assert names["zeros"].L[:, 1].is_zero_matrix
    minimal, s, d = names["minimal"], sympy.Symbol("s"), sympy.Symbol("d")
    assert sympy.simplify(minimal.F - (31 * s + 40) / ((1 - 31 * d) * s + 13 - 40 * d)) == 0
    assert sympy.simplify(minimal.direct_term[0] - 31 / (1 - 31 * d)) == 0
    assert [str(condition) for condition in minimal.conditions] == ["Ne(31*d - 1, 0)"]
    for name in ("region", "pendulum"):
        (comment,) = re.findall(rf"^{name}\.stable_if  # (.*)$", GUIDE, re.MULTILINE)
        assert list(names[name].stable_if) == eval(comment)  # noqa: S307
    (component,) = names["region"].components
    assert (component["bounded"], component["parts"][0]["h1"]) == (True, ("3", "8"))


def test_every_promised_value_is_on_a_line_of_its_own() -> None:
    assert len(promised()) == 8


def test_the_set_up_is_two_commands_of_one_line() -> None:
    section = README.split("\n## Set-up\n")[1].split("\n## ")[0]
    assert [len(block.splitlines()) for block in blocks("sh", section)] == [1, 1]


@pytest.mark.slow
def test_shell_lines_run_on_the_problem_file(require_tool: Callable[[str], str], tmp_path: Path) -> None:
    require_tool("latexmk")
    require_tool("pdflatex")
    _, lecture, _ = blocks("toml")
    (tmp_path / "lecture.toml").write_text(lecture, "utf-8")
    lines = [line for block in blocks("sh") for line in block.splitlines() if line.startswith("symobs ")]
    assert len(lines) == 33
    for line in lines:
        words = shlex.split(line, comments=True)
        target = words.pop() if ">" in words else ""
        run = fresh(*words[1 : -1 if target else None], folder=tmp_path)
        assert (run.code, run.err) == (0, ""), line
        assert run.out or "-o" in line
        if target:
            (tmp_path / target).write_text(run.out, "utf-8")
    assert (tmp_path / "region.svg").read_bytes() == (ROOT / ".github/pictures/region.svg").read_bytes()
    assert (tmp_path / "page.html").read_bytes().startswith(b"<!DOCTYPE html>")
    assert (tmp_path / "page.pdf").read_bytes().startswith(b"%PDF")


def test_the_template_replaces_one_block(tmp_path: Path) -> None:
    problem, *_ = blocks("toml")
    (template,) = blocks("tex")
    (tmp_path / "problem.toml").write_text(problem, "utf-8")
    (tmp_path / "article.tex").write_text(template, "utf-8")
    run = fresh("solve", "problem.toml", "--templates", ".", folder=tmp_path)
    assert (run.code, run.err) == (0, "")
    assert run.out.index(r"\usepackage{charter}") < run.out.index(r"\begin{document}")


def test_the_error_in_what_is_printed_is_found_as_shown(tmp_path: Path) -> None:
    mass = ROOT / "worked_examples" / "double_integrator_observer.toml"
    *_, printed = blocks("toml")
    (shown,) = blocks("text")
    (tmp_path / "printed.toml").write_text(f"{mass.read_text(encoding='utf-8')}\n{printed}", "utf-8")
    run = fresh("audit", "printed.toml", folder=tmp_path)
    assert (run.code, run.err) == (4, "")
    assert shown in run.out


@tabled
def test_every_link_leads_somewhere(page: str) -> None:
    text = (ROOT / page).read_text("utf-8")
    links = LINK.findall(text)
    assert links
    assert [link for link in links if not (ROOT / page).parent.joinpath(link).exists()] == []
