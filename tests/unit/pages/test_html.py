"""HTML: the pages are well-formed and closed to the outside, and hostile text stays text."""

from __future__ import annotations

import re
import xml.etree.ElementTree as ET
from typing import TYPE_CHECKING

import pytest
from hypothesis import given
from hypothesis import strategies as st

from symobs.exact import Scalar
from symobs.pages.formats.html import Html, HtmlFragment, HtmlWriter, page, plain, style
from symobs.pages.page.blocks import Heading, Paragraph, Title, Verified, every
from symobs.pages.page.narrator import narrate
from symobs.pages.printers.mathml import MathmlPrinter
from tests.support.examples import document_of
from tests.support.problems.steps import document, with_a_case

if TYPE_CHECKING:
    from collections.abc import Iterator

s = Scalar.symbol("s")
MATHEMATICS = {"math", "mrow", "mi", "mn", "mo", "mtext", "mspace", "msqrt", "mtable", "mtr", "mtd", "mfrac"}
MATHEMATICS |= {"msub", "msup", "msubsup", "mover", "munder"}
DRAWN = {"svg", "title", "style", "path", "circle", "rect", "line", "text", "tspan", "g"}
WORDS = {"html", "head", "meta", "body", "main", "div", "h1", "h2", "h3", "h4", "p", "strong", "pre", "table", "tr"}
WORDS |= {"th", "td", "figure", "figcaption", "nav", "ol", "li", "a", "span"}
ATTRIBUTES = {"class", "id", "style", "display", "displaystyle", "scriptlevel", "mathvariant", "accent", "stretchy"}
ATTRIBUTES |= {"form", "fence", "separator", "symmetric", "minsize", "maxsize", "lspace", "rspace", "width", "height"}
ATTRIBUTES |= {"depth", "scope", "role", "aria-label", "lang", "charset", "content", "name", "http-equiv", "href"}


pytestmark = pytest.mark.usefixtures("own_phrases")


def local(node: ET.Element) -> str:
    return node.tag.rpartition("}")[2]


def parsed(html: str) -> ET.Element:
    return ET.fromstring(html)  # noqa: S314 - our own output


def faults(html: str) -> Iterator[str]:
    """What does not belong on a page of ours: an element or attribute that could load, run or submit anything."""
    drawn: set[ET.Element] = set()
    for node in parsed(html).iter():
        tag = local(node)
        if tag == "svg":
            drawn |= set(node.iter())
        if tag not in MATHEMATICS | WORDS | DRAWN:
            yield f"element {tag}"
        for name, value in node.attrib.items():
            goes_out = "href" in name and not (tag == "a" and value.startswith("#"))
            if name.startswith("on") or goes_out or name in {"src", "srcset", "action"} or "url(" in value:
                yield f"attribute {name}={value}"
            if node not in drawn and name not in ATTRIBUTES:
                yield f"attribute {name}"


def words_of(node: ET.Element) -> str:
    return "".join(node.itertext())


# -- text from outside ------------------------------------------------------------------------------------------------

HOSTILE = [
    "</title><script>alert(1)</script>",
    "<img src=x onerror=alert(1)>",
    "</style><style>*{display:none}</style>",
    "$body $style ${title} $$ %s {0} {{ 7*7 }}",
    "]]> <!-- <![CDATA[ &lt; &amp;amp; &#x3c;",
    '" onload=\'x\' style="position:fixed"',
    "\x00\x07\x1b[31m \u202ereversed\u202c \ufffe",
    "Łódź, 東京, 😀, x\u0302, −1 ≤ ½",
]


@pytest.mark.parametrize("text", HOSTILE, ids=range(len(HOSTILE)))
@pytest.mark.parametrize("kind", [Html, HtmlFragment])
def test_hostile_text_is_shown_and_does_nothing(text: str, kind: type[Html | HtmlFragment]) -> None:
    html = kind().render(document(with_a_case(), title=text, source=text))
    assert list(faults(html)) == []
    plain_page = kind().render(document(with_a_case(), title="A", source="A"))
    assert [local(node) for node in parsed(html).iter()] == [local(node) for node in parsed(plain_page).iter()]
    heading = next(node for node in parsed(html).iter() if local(node) in {"h1", "h2"})
    shown = words_of(heading).replace("“", '"').replace("”", '"').replace("\N{RIGHT SINGLE QUOTATION MARK}", "'")
    assert shown == re.sub("[\x00-\x1f\u202a-\u202e\ufffe]", "", text).strip()


@given(st.text())
def test_any_text_can_stand_on_a_page(text: str) -> None:
    assert "<" not in plain(text)
    parsed(page(text, f"<p>{plain(text)}</p>"))


# -- pages ------------------------------------------------------------------------------------------------------------


def test_a_page_says_its_language_and_forbids_itself_the_network() -> None:
    root = parsed(Html().render(document(title="A page")))
    assert root.get("lang") == "en"
    assert next(words_of(node) for node in root.iter() if local(node) == "title") == "A page"
    policy = next(node.get("content") for node in root.iter() if node.get("http-equiv") == "Content-Security-Policy")
    assert policy == "default-src 'none'; style-src 'unsafe-inline'"
    assert "prefers-color-scheme: dark" in Html().render(document())
    assert "@media print" in style()


def test_parts_of_one_page_have_ids_of_their_own() -> None:
    blocks = narrate(document(*document_of("output_feedback_servo").derivations, with_a_case()))
    parts = [HtmlWriter(MathmlPrinter(), prefix=f"p{k}-", level=2).body(blocks) for k in (1, 2)]
    root = parsed(page("Two", "\n".join(parts)))
    ids = [node.get("id") for node in root.iter() if node.get("id")]
    assert len(ids) == len(set(ids)) == 2 * sum(isinstance(block, Heading) for block in every(blocks))
    assert all(re.fullmatch(r"p[12]-[\w-]+", found) for found in ids if found)
    assert {local(node) for node in root.iter() if re.fullmatch("h[1-6]", local(node))} == {"h3"}


def test_what_a_reader_cannot_see_is_told() -> None:
    writer = HtmlWriter(MathmlPrinter())
    assert writer.block(Verified(("as required.",))) == '<p class="verified">as required.</p>'
    assert writer.block(Title("", "", ())) == ""
    assert writer.block(Paragraph(("a < b",))) == "<p>a &lt; b</p>"
