"""How a table looks: in LaTeX it fits the line, on a terminal it stands in columns, and names stand for what they name."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from symobs.exact import Scalar, from_coefficients
from symobs.formula.tree import Environment, Exact, Letter, Literal, evaluate
from symobs.pages.formats.latex import LatexFragment
from symobs.pages.formats.text import Text
from symobs.pages.page.blocks import Paragraph, TableBlock
from symobs.pages.page.narrator import narrate
from symobs.pages.printers.text_printer import TextPrinter
from symobs.pages.tables import fitted
from symobs.proof.derivation import Define, Derivation, Sentence, Tabulate
from symobs.proof.derivation.routh_check import findings_of
from symobs.stability.criteria.routh_table import routh_table
from tests.kit import tabled
from tests.support.problems.steps import document, said

if TYPE_CHECKING:
    from tests.support.problems.steps import HandWritten

s = Scalar.symbol("s")
CHI = Letter("chi")


def polynomial(*coefficients: int | str) -> Scalar:
    """The polynomial with these coefficients; a text is a parameter's name."""
    return from_coefficients([Scalar.symbol(c) if isinstance(c, str) else Scalar.of(c) for c in coefficients], "s")


def derivation(value: Scalar, *, with_findings: bool = True, **forms: str) -> Derivation:
    coefficients = value.coefficients("s")
    table = routh_table(coefficients)
    findings = findings_of(table, coefficients, "s", {}) if with_findings else ()
    steps = (
        Define(said(CHI, value)),
        Tabulate(CHI, table, "s", Sentence("routh_table", (("polynomial", CHI),)), findings),
    )
    return Derivation(steps, Environment(), forms)


def page(*values: Scalar, with_findings: bool = False) -> HandWritten:
    return document(*(derivation(value, with_findings=with_findings) for value in values))


def text(*coefficients: int | str) -> list[str]:
    """The lines of a table on a terminal, and what follows it."""
    lines = Text().render(page(polynomial(*coefficients))).splitlines()
    return lines[next(k for k, line in enumerate(lines) if "│" in line) :]


def block_of(value: Scalar) -> TableBlock:
    (block,) = (block for block in narrate(page(value)) if isinstance(block, TableBlock))
    return block


# -- names ----------------------------------------------------------------------------------------------------------------

WIDE = [
    polynomial(1, "h1", "h2", "h3", "h4", "h5", "h6"),
    polynomial("p", "b", "c", "d", "f", "g", "h", "k"),
    polynomial("a", "a1", "a2", "a3", "a4", "a5", "a6"),
    polynomial(3, 0, 1, 5, 2, 7, 1, 2, 9, 4, 3),
    polynomial(*(10**k + 7**k for k in range(9))),
    polynomial(1, "h1", "h2", "h3", 1, "h5", "h6", "h7", "h8", "h9"),
    (s**2 + Scalar.symbol("b1") ** 2 + Scalar.symbol("kappa")) ** 2 * polynomial(1, "h1", "h2", "h3", "h4"),
    (polynomial(1, "m", "n")) ** 3 * polynomial("k", 1, "l"),
    polynomial(*range(1, 42)),
    s**4 + s**2 * sum((Scalar.symbol(f"h{k}") * k for k in range(1, 15)), Scalar.of(1)) + Scalar.symbol("k"),
    polynomial(*(int(f"{k}" * 30) for k in range(1, 10))),
]


@pytest.mark.slow
@tabled
@pytest.mark.parametrize("value", WIDE, ids=str)
def test_names_stand_for_what_they_name(value: Scalar, width: float) -> None:
    """What is told below, put into the table from above to below, gives the table back."""
    block, printer = block_of(value), TextPrinter(width=int(width))
    found = fitted(block, printer, lambda _: width - 6, 2, width)
    meanings: dict[str, Scalar] = {}
    known = set().union(*(entry.names for row in block.table.rows for entry in row.entries))
    for relation in found.legend:
        name, meaning = relation.members
        assert isinstance(name, Literal)
        assert isinstance(name.value, Scalar)
        ((letter,),) = (name.value.names,)
        assert letter not in known | meanings.keys()
        unfolded = evaluate(
            meaning, Environment(coefficients=dict(meanings)), Exact(Environment(coefficients=meanings))
        )
        assert isinstance(unfolded, Scalar)
        meanings[letter] = unfolded
    by_glyph = {printer.leaf(Scalar.symbol(name)).line: meaning for name, meaning in meanings.items()}
    for row, written in zip(block.table.rows, found.rows, strict=True):
        for entry, box in zip(row.entries, written, strict=True):
            assert box.line == printer.scalar(entry).line or by_glyph[box.line] == entry


def test_no_name_is_one_of_a_parameter() -> None:
    value = polynomial("b", "a1", "a2", "c3", "d", "f", "a6")
    letters = {
        name.value.names
        for relation in fitted(block_of(value), TextPrinter(), lambda _: 20, 2, 20).legend
        if isinstance(name := relation.members[0], Literal)
    }
    assert letters
    assert {min(names)[0] for names in letters}.isdisjoint("abcdf")
    declared = TextPrinter(symbols={"h": "b", "kappa": r"c_{\mathrm{m}}"})
    wide = polynomial(1, "h", "kappa", "h3", "h4", "h5", "h6")
    told = fitted(block_of(wide), declared, lambda _: 20, 2, 20).legend
    assert {str(r.members[0].value)[0] for r in told if isinstance(r.members[0], Literal)}.isdisjoint("bc")


# -- what is said ---------------------------------------------------------------------------------------------------------


def test_the_page_says_what_the_table_says_and_names_the_theorem() -> None:
    *_, table, finding, sources = narrate(page(polynomial(1, 2, 3, 1), with_findings=True))
    assert isinstance(table, TableBlock)
    assert finding == Paragraph(
        (
            "All entries of the first column are positive, so all roots lie in the open left half-plane\N{NO-BREAK SPACE}[1].",
        )
    )
    assert "Routh (1877), A Treatise" in str(sources)


def test_powers_stand_left_of_a_rule() -> None:
    written = LatexFragment().render(page(polynomial(1, "h1", "h2", 1)))
    assert (
        "\\begin{array}{c|cc}\n"
        r"s^3&1&h_{2}\\s^2&h_{1}&1\\[4pt]s^1&\dfrac{h_{1}h_{2}-1}{h_{1}}&\\[12pt]s^0&1&"
        "\n\\end{array}"
    ) in written
