"""The page of feedback: what a student sees, as HTML with MathML and without any script."""

from __future__ import annotations

from typing import TYPE_CHECKING

from symobs.applications.checking.report.pages import LONGEST, beginning, names_of, of_numbers, result, sentences
from symobs.formula.expression import parse_matrix
from symobs.formula.tree import Literal
from symobs.ground.errors import SymobsError
from symobs.pages.formats.html import page, plain
from symobs.pages.printers.mathml.mathml_printer import MathmlPrinter

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from symobs.applications.checking.report.data import Line, Part, ReportData

_STYLE = """<style>
.judged { border-left: 0.3rem solid var(--pale); padding: 0.1rem 0 0.1rem 1rem; margin: 1.2rem 0; }
.judged.right { border-color: #2c7a3f; } .judged.wrong, .judged.unreadable { border-color: #b3372b; }
.judged.follows { border-color: #b07d12; }
.judged h2 { margin: 0; font-size: 1.15rem; } .judged p { margin: 0.35rem 0; overflow-x: auto; }
.derivation { padding-left: 0; list-style: none; } .derivation li { margin: 0.6rem 0; }
.derivation code { overflow-wrap: anywhere; } .derivation .false .word, .derivation .unreadable .word { font-weight: bold; }
.score { font-size: 1.1rem; }
</style>"""
#: The words for the verdicts on parts and lines: colour alone says nothing.
_WORDS = {
    "right": "✓ right",
    "follows": "✓ follows from your earlier result",
    "wrong": "✗ wrong",
    "missing": "– missing",
    "unreadable": "? cannot be read",
    "undecided": "? to be marked by hand",
    "true": "✓",
    "false": "✗ false",
}


def html(report: ReportData) -> str:
    """Return a report as a page of its own."""
    title = report.title or "Feedback"
    head = [f"<h1>{plain(title)}</h1>"]
    head += [f"<p>{plain(report.student)}</p>"] if report.student else []
    head += [f'<p class="score"><strong>{plain(result(report))}</strong></p>']
    names = names_of(report)
    parts = [line for part in report.parts for line in _part(part, names)]
    hints = [f"<p>{plain(hint)}</p>" for hint in report.hints]
    lines = ["<h2>Your derivation</h2>", '<ol class="derivation">', *map(_line, report.lines), "</ol>"]
    solution = ["<h2>Solution</h2>", report.page] if report.page else []
    return page(title, "\n".join([_STYLE, *head, *parts, *hints, *(lines if report.lines else []), *solution]))


def _part(part: Part, names: Mapping[str, str]) -> Iterator[str]:
    """Yield the section of a part."""
    yield f'<section class="judged {part.verdict}">'
    credit = part.credit is not None and part.weight > 0 and 0 < part.credit < 1
    extra = f", {part.credit} of its marks" if credit else ""
    yield f"<h2>{plain(names[part.part])}: {_WORDS[part.verdict]}{extra}</h2>"
    if part.given:
        yield f"<p>You gave {_math(part.given)}</p>"
    for said in sentences(part, names, effect=False):
        yield f"<p>{plain(_sentence(said))}</p>"
    if part.effect and part.verdict == "wrong":
        stable = {"no": ", and not stable", "yes": ""}.get(part.effect.get("stable", ""), "")
        polynomial = _math(part.effect["polynomial"]) + (", not the one asked for" if part.slip is None else "")
        yield f"<p>With your {plain(part.letter)} the characteristic polynomial is {polynomial}{stable}.</p>"
    if part.right is not None and part.verdict != "right":
        yield f"<p>Right is {_math(part.right)}</p>"
    yield "</section>"


def _line(line: Line) -> str:
    """Return a line of the derivation as an item of the list."""
    said = f"<br/>{plain(_sentence(line.reason))}" if line.reason else ""
    origins = f" {plain(' and '.join(line.origins))}" if line.origins else ""
    word = f"✓ follows from{origins}" if line.verdict == "follows" else _WORDS[line.verdict]
    right = f"<br/>right: <code>{plain(of_numbers(line.right))}</code>" if line.right else ""
    code = f"<code>{plain(beginning(line.relation))}</code>"
    return f'<li class="{line.verdict}">{plain(line.where)}: {code} <span class="word">{word}</span>{said}{right}</li>'


def _sentence(said: str) -> str:
    """Return what is said as a sentence; one that begins with a letter of mathematics keeps it."""
    text = of_numbers(said)
    return (text[0].upper() if len(text) > 1 and text[1].isalpha() else text[0]) + text[1:] + "."


def _math(text: str) -> str:
    """Return a value as MathML, or as it was written where it is no expression."""
    if len(text) > LONGEST:
        return f"<code>{plain(beginning(text))}</code>"
    try:
        value = parse_matrix(text, None, functions=True)
    except SymobsError:
        return f"<code>{plain(beginning(text))}</code>"
    return MathmlPrinter().inline(Literal(value[0, 0] if value.shape == (1, 1) else value))
