"""What a writer leaves out since its check failed is told by a warning, which is an error in these tests."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import pytest

import symobs
from symobs.exact import Matrix, Scalar, TooLarge
from symobs.formula.tree import Environment, Formula, Literal, Power, Relation
from symobs.formula.tree.term import Term
from symobs.ground.errors import DerivationRejected, SymobsWarning
from symobs.proof.certificate.claims import can_be_shown, verify
from symobs.proof.derivation import CaseStep, Equal
from symobs.proof.derivation.builder import Builder, relation, shows, without_failing_cases
from symobs.proof.derivation.steps import Note

if TYPE_CHECKING:
    from collections.abc import Sequence

a, b = Scalar.symbol("a"), Scalar.symbol("b")


def rank_is(rows: Sequence[Sequence[Scalar | int]], rank: int, relations: tuple[Scalar, ...]) -> Any:
    e = Environment(relations=relations)
    return relation(Term(Literal(Matrix.of(rows)), e).apply("rank"), rank), e


def test_a_false_line_is_left_out_with_a_warning() -> None:
    fact, e = rank_is([[1, 0], [0, 1]], 1, ())
    assert can_be_shown(fact, e)
    with pytest.warns(SymobsWarning, match="the line rank.* is left out: its check failed"):
        assert not shows([fact], e)


def test_a_line_beyond_the_reach_of_the_check_is_left_out_by_decision() -> None:
    """diag(a, b) has rank 1 where a b = 0 but for the origin, which the ideal of a b does not leave out."""
    fact, e = rank_is([[a, 0], [0, b]], 1, (a * b,))
    assert verify(fact, e) == ("", 0.0)
    assert not can_be_shown(fact, e)
    assert not shows([fact], e)


def test_a_picture_that_is_not_faithful_is_left_out_with_a_warning(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(
        "symobs.proof.derivation.plot_check.faults", lambda *_, **__: iter(["a curve that is not there"])
    )
    with pytest.warns(SymobsWarning, match="a picture of kind .* is left out: its check failed"):
        symobs.stability_region("s^2 + 2 s + k", parameters=["k"]).to("latex")


def test_a_bug_of_evaluation_is_no_false_claim(monkeypatch: pytest.MonkeyPatch) -> None:
    def broken(*_: Any) -> Any:
        raise AttributeError("a bug")

    monkeypatch.setattr("symobs.proof.certificate.claims.evaluate", broken)
    fact, e = rank_is([[1, a], [0, 1]], 2, (a - b,))
    with pytest.raises(AttributeError, match="a bug"):
        verify(fact, e)


ONE, NOTHING = Literal(Scalar.of(1)), Power(Literal(Scalar.of(0)), -1)


def page_with_a_case(operator: str, shown: Formula) -> tuple[Builder, Equal]:
    """Return a page that says in a case of a, against 0, that 1 is what is shown; and that line."""
    page = Builder(symobs.StateSpace("[a]", "[1]", symbols={"a": "real"}))
    line = Equal((Relation((ONE, shown), ("=",)),))
    page.steps.append(CaseStep(relation(page.value(a), operator, 0), (), (line,)))
    return page, line


def only_note(page: Builder) -> Any:
    """Return the sentence that is left of a page of one case."""
    (step,) = without_failing_cases(page.derivation()).steps
    assert isinstance(step, Note)
    return step.sentence


@pytest.mark.parametrize("shown", [Literal(Scalar.of(2)), NOTHING], ids=["false", "unreadable"])
def test_a_case_whose_check_fails_is_named_as_undecided_and_nothing_else_is(shown: Formula) -> None:
    """The line 1 = 2, or 1 = 1/0, in the case a = 0 is left out with its case; outside a case it stays an error."""
    page, false = page_with_a_case("=", shown)
    with pytest.raises(DerivationRejected):
        page.derivation().check()
    with pytest.warns(SymobsWarning, match="a case is left out"):
        assert only_note(page).key == "undecided_case"
    page.steps.append(false)
    with pytest.warns(SymobsWarning), pytest.raises(DerivationRejected):
        without_failing_cases(page.derivation())


@pytest.mark.parametrize(
    ("operator", "key", "named"),
    [("!=", "undecided_apart", a), (">", "undecided_positive", a), ("<", "undecided_positive", -a)],
)
def test_a_case_of_a_sign_is_named_as_undecided_too(operator: str, key: str, named: Scalar) -> None:
    page, _ = page_with_a_case(operator, Literal(Scalar.of(2)))
    with pytest.warns(SymobsWarning, match="a case is left out"):
        words = only_note(page)
    assert (words.key, words.slots) == (key, (("when", Literal(named)),))


def test_a_case_beyond_the_limits_is_undecided_and_no_bug(monkeypatch: pytest.MonkeyPatch) -> None:
    def too_large(*_: Any) -> Any:
        raise TooLarge("the equations are too long to be decided")

    page, _ = page_with_a_case("=", ONE)
    monkeypatch.setattr("symobs.proof.derivation.check.on_stratum", too_large)
    assert only_note(page).key == "undecided_case"
