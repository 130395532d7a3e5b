"""The narrator: what follows what on a page."""

from __future__ import annotations

import re

import pytest

from symobs import observer
from symobs.exact import Matrix, Scalar
from symobs.formula.phrases import CONTINUES, PHRASES, WORDS
from symobs.formula.tree import Environment, Letter, Negative, Product, Sum, Transpose
from symobs.ground.errors import DerivationRejected, ProblemErrors, UsageError
from symobs.pages.page import narrator
from symobs.pages.page.blocks import Block, CaseBlock, Display, Paragraph, Title, every
from symobs.pages.page.narrator import narrate
from symobs.pages.page.prose import filled, with_reference
from symobs.problem.validation import validate
from symobs.proof.derivation import Derivation, Equal, Given, Note, Sentence, Step
from tests.kit import SERVO, tabled
from tests.support.problems.steps import OWN_PHRASES, document, said, with_a_case

A, C = Letter("A"), Letter("C")
A_IS_ONE, A_IS_TWO = said(A, Matrix.of([[1]])), said(A, Matrix.of([[2]]))
C_IS_ONE = said(C, Matrix.of([[1]]))
ONE = said(1, 1)
TWO = said(2, 2)


@pytest.fixture(autouse=True)
def _phrases(monkeypatch: pytest.MonkeyPatch) -> None:
    phrases = OWN_PHRASES | {
        "test_small": "and so on",
        "test_large": "Now",
        "test_about": "with {A} as it is.",
        "test_title": "A title.",
        "test_refers": "By {law:number} this is {law}.",
    }
    for key, phrase in phrases.items():
        monkeypatch.setitem(PHRASES, key, phrase)
    monkeypatch.setattr(narrator, "CONTINUES", CONTINUES | {"test_small", "test_about"})


def derivation(*steps: Step) -> Derivation:
    return Derivation(steps, Environment())


def told(*steps: Step) -> tuple[Block, ...]:
    return narrate(document(derivation(*steps)))[1:]


def test_a_derivation_with_a_false_line_is_not_told() -> None:
    with pytest.raises(DerivationRejected, match="the line 1 = 2"):
        told(Equal((said(1, 2),)))


@tabled
def test_the_source_is_a_sentence(source: str, shown: str) -> None:
    title = narrate(document(source=source))[0]
    assert title == Title("", shown, ())


# -- sources and the problem in words -----------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("inlines", "shown"),
    [
        (("It is observable.",), ("It is observable\u00a0[2, ch. 3].",)),
        (("By duality", ONE, " holds§, so"), ("By duality", ONE, " holds\u00a0[2, ch. 3], so")),
        (("The error", ONE), ("The error", ONE, "\u00a0[2, ch. 3]")),
        (("is driven by",), ("is driven by\u00a0[2, ch. 3]",)),
    ],
)
def test_a_sentence_has_the_number_of_its_source(inlines: tuple[object, ...], shown: tuple[object, ...]) -> None:
    assert with_reference(inlines, "[2, ch. 3]") == shown  # type: ignore[arg-type]


def test_numbers_in_the_text_are_those_of_the_sources() -> None:
    page = str(observer(SERVO, poles=[-10, -10]).to("text"))
    words, _, sources = page.partition("References\n")
    cited = re.findall(r"\[(\d)(?:[;,] [^\]]*)?\]", words.partition("Observer\n")[2])
    listed = re.findall(r"^\[(\d)\]", sources, re.MULTILINE)
    assert listed == sorted(listed)
    assert [number for number in cited if number in listed][:2] == ["1", "3"]
    assert set(cited) <= set(listed)
    assert "[1] Kalman (1963), SIAM J. Control 1, 152–192." in sources


def test_literature_is_told_as_asked_for() -> None:
    design = observer(SERVO, poles=[-10, -10])
    full, none = (str(design.to("text", references=how)) for how in ("full", "none"))
    assert "[1] R. E. Kalman, Mathematical description of linear dynamical systems" in " ".join(full.split())
    assert "References" not in none
    with pytest.raises(UsageError, match="is no way to cite"):
        design.to("text", references="long")


def test_words_that_are_no_text_are_refused() -> None:
    with pytest.raises(ProblemErrors, match="text: a text is expected"):
        validate({"text": 3, "task": "observability", "plant": {"A": "[-1]", "C": "[1]"}})


# -- numbers of equations ---------------------------------------------------------------------------------------------


def test_an_equation_has_a_number_where_a_later_sentence_refers_to_it() -> None:
    refers = Sentence("test_refers", (("law", A_IS_TWO),))
    steps: list[Step] = [
        Given((A_IS_TWO,)),
        Equal((ONE,)),
        Equal((A_IS_TWO,)),
        Note(refers),
        Equal((A_IS_TWO,)),
        Equal((TWO,)),
    ]
    blocks = narrate(document(Derivation(tuple(steps), Environment())))
    displays = [block for block in every(blocks) if isinstance(block, Display)]
    assert [(shown.relations, shown.number) for shown in displays] == [
        ((A_IS_TWO,), 1),
        ((ONE, A_IS_TWO), 0),
        ((A_IS_TWO, TWO), 0),
    ]
    (said,) = [block for block in blocks if isinstance(block, Paragraph)]
    assert said.inlines == ("By (1) this is ", A_IS_TWO, ".")
    (whole,) = [narrate(document(Derivation((Given((A_IS_TWO, C_IS_ONE)), Note(refers)), Environment())))]
    assert not any(shown.number for shown in every(whole) if isinstance(shown, Display))
    assert Paragraph(("By ", A_IS_TWO, " this is ", A_IS_TWO, ".")) in whole


def test_a_condition_keeps_its_place() -> None:
    b = Scalar.symbol("b")
    condition = said(b, "!=", 0)
    assert told(Equal((ONE,)), Given((condition,))) == (Display((ONE, condition), closing="."),)
    about = Sentence("test_about", (("A", condition),))
    assert told(Given((condition,), about)) == (Paragraph(("with ", condition, " as it is."), continues=True),)


def test_a_case_says_when_it_holds_and_keeps_its_own_data() -> None:
    block = narrate(document(with_a_case()))[-1]
    assert isinstance(block, CaseBlock)
    assert block.label[0] == f"{WORDS['case']} "
    assert block.blocks == (
        Paragraph((PHRASES["test_case"],)),
        Display((said(C, Matrix.of([[1, 0]])),), closing="."),
    )


@pytest.mark.parametrize(
    ("written", "formula"),
    [
        ("A", A),
        ("A - L C", Sum((A, Negative(Product((Letter("L"), C)))))),
        ("−U", Negative(Letter("U"))),
        ("Aᵀ", Transpose(A)),
        ("u = −K x_hat", said(Letter("u"), Negative(Product((Letter("K"), Letter("x_hat")))))),
    ],
)
def test_a_name_between_dollars_is_mathematics(written: str, formula: object, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(PHRASES, "test_named", f"Here ${written}$ is named.")
    assert filled(Sentence("test_named")) == ("Here ", formula, " is named.")
