"""What a result and the registries refuse, one check at a time: each fails where one check is left out or weaker."""

from __future__ import annotations

import pickle
from dataclasses import FrozenInstanceError, replace
from typing import TYPE_CHECKING, Any, ClassVar

import pytest

from symobs import StateSpace, compensator, observability, observer, reduced_order_observer
from symobs.exact import Matrix, Scalar
from symobs.formula.tree import Environment, Letter
from symobs.ground.errors import CertificateRejected, DerivationRejected
from symobs.proof.certificate.claims import Certificate, Claim, Statement
from symobs.proof.derivation import Define, Derivation
from symobs.tasks.result import (
    Case,
    Result,
)
from tests.kit import SERVO, tabled
from tests.support.problems.steps import A, F, said

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from symobs.proof.derivation.builder import Builder


class Squared(Result):
    """The square of a number, which its page shows."""

    task: ClassVar[str] = "squared"

    def claims(self) -> Iterator[Claim | Statement]:
        yield Claim(said(self.answer["square"], self.answer["number"] ** 2), Environment(), "a square")
        yield Statement("shown", lambda: "by hand")

    def write(self, page: Builder) -> None:
        page.steps = [Define(said(F, self.answer["square"]))]


def squared(number: Scalar, square: Scalar, plant: StateSpace = SERVO) -> Squared:
    return Squared(plant, "by hand", {"number": number, "square": square})


# -- a result -----------------------------------------------------------------------------------------------------------


def test_a_result_holds_or_is_not() -> None:
    number = Scalar.of(3)
    found = squared(number, number * 3)
    assert found.certificates == (Certificate("a square: 9 = 9", "exact", "0"), Certificate("shown", "by hand", "0"))
    assert found.all_certificates == found.certificates
    with pytest.raises(CertificateRejected, match="a square"):
        squared(number, number)
    with pytest.raises(CertificateRejected, match="the answer of squared is no answer") as caught:
        Squared(SERVO, "by hand", {"number": number})
    assert isinstance(caught.value.__cause__, LookupError)
    with pytest.raises(CertificateRejected, match="the claim a square"):
        found.with_answer("square", number)
    with pytest.raises(CertificateRejected, match="the answer of squared is no answer: 'square'"):
        replace(found, answer={})
    other = found.with_answer("number", -number)
    assert dict(other.answer) == {"number": -number, "square": Scalar.of(9)}
    assert type(other) is Squared


def test_a_result_cannot_be_changed() -> None:
    given = {"number": Scalar.of(3), "square": Scalar.of(9)}
    found = Squared(SERVO, "by hand", given)
    given["number"] = Scalar.of(4)
    assert found.answer["number"] == Scalar.of(3)
    with pytest.raises(TypeError):
        found.answer["number"] = Scalar.of(4)  # type: ignore[index]
    with pytest.raises(FrozenInstanceError):
        found.answer = given  # type: ignore[misc]
    with pytest.raises(FrozenInstanceError):
        Case((), {}, found).result = None  # type: ignore[misc]


def test_a_result_is_neither_true_nor_false() -> None:
    with pytest.raises(TypeError, match=r"ask for its verdict: observability\(\.\.\.\)\.verdict == 'yes'"):
        bool(observability(SERVO))


@pytest.mark.parametrize(
    ("asked", "letter"),
    [
        (lambda: observer(SERVO, poles=[-1, -2], method="existence"), "L"),
        (lambda: compensator(SERVO, control_poles=[-1, -2], observer_poles=[-3, -4], method="duality"), "K"),
        (lambda: reduced_order_observer(SERVO, poles=[-1], method="undetermined"), "L"),
    ],
)
def test_another_answer_keeps_the_page_asked_for(asked: Callable[[], Result], letter: str) -> None:
    found = asked()
    other = found.with_answer(letter, found.answer[letter])
    assert other.page_method == replace(found).page_method == found.page_method != "auto"
    assert pickle.loads(pickle.dumps(other)).to_latex() == found.to_latex()  # noqa: S301 - our own bytes


def test_a_result_read_back_is_checked_again() -> None:
    found = squared(Scalar.of(3), Scalar.of(9)).asked("by head")
    read = pickle.loads(pickle.dumps(found))  # noqa: S301 - our own bytes
    assert (dict(read.answer), read.method, read.page_method) == (dict(found.answer), "by hand", "by head")
    assert read.certificates == found.certificates
    assert read == found
    assert found.asked("auto").page_method == "auto"
    assert found.page_method == "by head"
    made, _ = found.__reduce__()
    with pytest.raises(CertificateRejected, match="the claim a square"):
        made(answer={**found.answer, "square": Scalar.of(8)})


def test_the_relations_of_the_plant_hold_for_its_results() -> None:
    """On a stratum h = 1 the square of h is 1."""
    h = Scalar.symbol("h")
    with pytest.raises(CertificateRejected, match="the claim a square"):
        squared(h, Scalar.of(1))
    inside = StateSpace("[0 1; 0 -h]", "[0; 1]", "[1 0]").restricted([h - 1])
    assert squared(h, Scalar.of(1), inside).certificates[0].how == "exact"


# -- its page -----------------------------------------------------------------------------------------------------------


class Elsewhere(Squared):
    """A result whose page speaks of a matrix of its own."""

    letter: ClassVar[str] = "A"
    value: ClassVar[Any] = Matrix.identity(2)

    def write(self, page: Builder) -> None:
        page.steps = [Define(said(Letter(self.letter), self.value))]


@tabled
def test_a_page_speaks_of_the_plant_s_own_data(letter: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(Elsewhere, "letter", letter)
    number = {"number": Scalar.of(3), "square": Scalar.of(9)}
    with pytest.raises(DerivationRejected, match=f"the page speaks of another {letter}") as caught:
        _ = Elsewhere(SERVO, "by hand", number).derivation
    assert caught.value.facts["line"] == letter
    own = getattr(SERVO.matrices, letter)
    monkeypatch.setattr(Elsewhere, "value", own)
    assert isinstance(Elsewhere(SERVO, "by hand", number).derivation, Derivation)


def test_a_page_is_checked() -> None:
    class Lying(Squared):
        def write(self, page: Builder) -> None:
            page.steps = [Define(said(F, A))]

    lying = Lying(SERVO, "by hand", {"number": Scalar.of(3), "square": Scalar.of(9)})
    with pytest.raises(DerivationRejected, match="before it is established"):
        _ = lying.derivation
    assert squared(Scalar.of(3), Scalar.of(9)).derivation.steps == (Define(said(F, 9)),)

    class Driven(Squared):
        free_signals = {"v": 1}  # noqa: RUF012 - a property there

        def write(self, page: Builder) -> None:
            page.steps = [Define(said(Letter("y"), Letter("v")))]

    assert Driven(SERVO, "m", {"number": Scalar.of(3), "square": Scalar.of(9)}).derivation.check().defines("y")


# -- registries ---------------------------------------------------------------------------------------------------------
