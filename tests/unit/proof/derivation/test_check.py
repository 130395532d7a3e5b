"""Every kind of step is checked: a false line, a letter nobody introduced, a case off its stratum are rejected."""

from __future__ import annotations

import pytest

from symobs.exact import Matrix, Scalar
from symobs.formula.tree import (
    Apply,
    Conjunction,
    Derivative,
    Evaluated,
    Formula,
    HoldsExactlyWhere,
    Identity,
    Letter,
    Literal,
    Negative,
    Power,
    Predicate,
    Product,
    Quotient,
    Relation,
    Roots,
    Sum,
    Transpose,
)
from symobs.proof.derivation import (
    CaseStep,
    Conclude,
    Define,
    Diagram,
    Equal,
    Given,
    Note,
    Section,
    Sentence,
    Step,
)
from tests.support.problems.steps import (
    A_IS,
    C_IS,
    CHI,
    COMPANION,
    ESTIMATE,
    START,
    A,
    B,
    C,
    E,
    F,
    L,
    S,
    U,
    X,
    Y,
    a,
    b,
    c,
    checked,
    literal,
    refused,
    s,
    said,
    slot,
)

pytestmark = pytest.mark.usefixtures("own_phrases")


# -- what is introduced ------------------------------------------------------------------------------------------------


def test_letters_mean_what_they_were_introduced_as() -> None:
    known = checked(A_IS, CHI, Define(said(Letter("F"), Quotient(Literal(s), Letter("chi")))))
    assert known.values["A"] == COMPANION
    assert known.values["chi"] == s**2 + 3 * s + 2
    assert known.values["F"] == s / (s**2 + 3 * s + 2)


def test_a_letter_nobody_introduced_is_refused_wherever_it_stands() -> None:
    strange = Letter("O")
    one = said(1, 1)
    for step in (
        Given((said(A, strange),)),
        Given((said(strange, "!=", 0),)),
        Define(said(A, strange)),
        Equal((said(strange, strange),)),
        Conclude(None, (Predicate("stable", strange),)),
        Conclude(None, (Roots(strange, ()),)),
        Conclude(None, (HoldsExactlyWhere(Predicate("stable", strange), ()),)),
        Conclude(None, (Conjunction((one, said(strange, 1))),)),
        Conclude(slot(strange)),
        Note(slot(Evaluated(strange, literal(1)))),
        Diagram("loop", (("P", strange), ("F", strange), ("response", strange))),
        Section(slot(strange), ()),
        CaseStep(said(strange, 0), (), ()),
    ):
        refused(step)


def test_links_after_the_first_are_checked_and_what_is_written_anew_must_agree() -> None:
    checked(Define(said(F, Power(literal(a), 2), a * a)))
    refused(Define(said(F, Power(literal(a), 2), a)), match="is not true")
    checked(A_IS, A_IS)
    refused(A_IS, Given((said(A, Matrix.identity(2)),)))


@pytest.mark.parametrize("target", [Transpose(A), Literal(a * b), Literal(Scalar.of(2)), Literal(COMPANION)])
def test_only_letters_derivatives_and_new_names_can_be_introduced(target: Formula) -> None:
    refused(Define(Relation((target, literal(1)), ("=",))))


def test_a_named_coefficient_is_a_new_name_that_stands_for_one_thing() -> None:
    d = Scalar.symbol("d")
    known = checked(Define(said(d, a + 1)), Equal((said(d, a + 1), said(d * d, (a + 1) ** 2))))
    assert known.coefficients == {"d": a + 1}
    refused(Define(said(2 * d, a + 1)))
    refused(Define(said(d + 1, a + 1)))
    refused(Define(said(d, a + 1)), Equal((said(d, a),)))
    refused(Define(said(d, a + 1)), Define(said(d, a + 2)))
    refused(Define(said(a, 5)), match="means something already")
    refused(C_IS, Define(said(c, 5)), match="means something already")
    refused(Given((said(C, Matrix.of([[b, 1]])),)), Define(said(b, 5)), match="means something already")
    refused(Define(said(d, b)), Define(said(b, 5)), match="means something already")


# -- conditions --------------------------------------------------------------------------------------------------------


def test_an_assumption_is_the_one_that_is_said() -> None:
    first, second = said(c, "!=", 1), said(c, "!=", 2)
    checked(Given((first,), slot(first)))
    checked(Given((first, second), slot(Conjunction((first, second)))))
    refused(Given((first,), slot(Conjunction((first, second)))))
    refused(Given((first, second), slot(first)))
    refused(Given((second,), Sentence("test_plain")))


# -- signals -----------------------------------------------------------------------------------------------------------


def loop(estimate: Formula) -> tuple[Step, ...]:
    return (
        A_IS,
        C_IS,
        Given((said(B, Matrix.of([[0], [1]])), said(L, Matrix.of([[a], [1]])))),
        Given((said(Derivative(X), Sum((Product((A, X)), Product((B, U))))), said(Y, Product((C, X))))),
        Define(said(Derivative(ESTIMATE), estimate)),
        Define(said(E, Sum((X, Negative(ESTIMATE))))),
    )


INNOVATION = Sum((Y, Negative(Product((C, ESTIMATE)))))
OBSERVER = loop(Sum((Product((A, ESTIMATE)), Product((B, U)), Product((L, INNOVATION)))))
ERROR = said(Derivative(E), Product((Sum((A, Negative(Product((L, C))))), E)))


def test_a_signal_is_defined_or_given_a_derivative_once() -> None:
    again = Define(said(E, Sum((ESTIMATE, Negative(X)))))
    other_rate = Define(said(Derivative(X), Product((A, X))))
    for step in (again, other_rate, Define(said(X, ESTIMATE)), Define(said(Derivative(E), E)), Define(said(U, 1))):
        refused(*OBSERVER, step)
    refused(Define(said(S, 1)))
    refused(Define(said(Derivative(Letter("absent")), X)))


def test_a_free_signal_ceases_to_be_free() -> None:
    known = checked(*OBSERVER, Define(said(U, Negative(Product((Transpose(B), ESTIMATE))))), Equal((ERROR,)))
    assert known.signals["u"] is not None
    assert START.signals["u"] is None


# -- cases -------------------------------------------------------------------------------------------------------------


# -- derivations -------------------------------------------------------------------------------------------------------


def test_only_steps_are_steps() -> None:
    refused("a line of prose", match="cannot be read")  # type: ignore[arg-type]


@pytest.mark.parametrize(
    "formula",
    [
        Sum((A, Identity(3))),
        Product((A, Literal(Matrix.of([[1, 2, 3]])))),
        Quotient(literal(1), literal(0)),
        Derivative(U),
        Derivative(A),
        Apply("phi_at", A),
        Power(Literal(Matrix.zeros(2, 2)), -1),
    ],
)
def test_a_formula_that_makes_no_sense_is_refused(formula: Formula) -> None:
    refused(A_IS, Equal((Relation((formula, formula), ("=",)),)))
    refused(A_IS, Define(Relation((F, formula), ("=",))))
    refused(A_IS, Conclude(None, (Predicate("stable", Product((formula, A))),)))


def test_a_signal_in_terms_of_itself_is_refused() -> None:
    refused(Define(Relation((U, Sum((U, U))), ("=",))), Equal((said(U, U),)))
