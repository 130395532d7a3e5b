"""Every kind of step is checked: a false line, a letter nobody introduced, a value out of nowhere are rejected."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import pytest

from symobs.derivation import (
    Case,
    Conclude,
    Define,
    Derivation,
    Diagram,
    Equal,
    Given,
    Note,
    Section,
    Sentence,
    Solve,
    Step,
)
from symobs.errors import DerivationRejected
from symobs.exact import Matrix, Root, Scalar, roots_of
from symobs.formula import (
    Apply,
    Derivative,
    Environment,
    Exactly,
    Fact,
    Formula,
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
    Shown,
    Sum,
    Together,
    Transpose,
)
from symobs.phrases import ASSERTS, PHRASES

if TYPE_CHECKING:
    from collections.abc import Mapping

A, B, C, F, L, P, S = (Letter(name) for name in ("A", "B", "C", "F", "L", "P", "s"))
X, ESTIMATE, E, U, Y = (Letter(name) for name in ("x", "x_hat", "e", "u", "y"))
s, a, b, c = (Scalar.symbol(name) for name in "sabc")
START = Environment(
    signals={"x": None, "x_hat": None, "u": None},
    sizes={"x": 2, "x_hat": 2, "u": 1},
    signs={"a": "positive", "c": "real"},
)


@pytest.fixture(autouse=True)
def _phrases(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(PHRASES, "test_plain", "And so on.")
    monkeypatch.setitem(PHRASES, "test_slot", "This is {it}.")


def literal(item: Formula | Scalar | Matrix | int) -> Formula:
    if isinstance(item, int):
        return Literal(Scalar.of(item))
    return Literal(item) if isinstance(item, (Scalar, Matrix)) else item


def said(*items: Formula | Scalar | Matrix | int | str) -> Relation:
    members = tuple(literal(item) for item in items if not isinstance(item, str))
    operators = tuple(item for item in items if isinstance(item, str))
    return Relation(members, operators or ("=",) * (len(members) - 1))


def slot(it: Formula | Fact | str) -> Sentence:
    return Sentence("test_slot", (("it", it),))


def checked(*steps: Step, start: Environment = START, discrete: bool = False) -> Environment:
    return Derivation(steps, start, discrete=discrete).check()


def refused(*steps: Step, start: Environment = START, match: str | None = None, discrete: bool = False) -> None:
    with pytest.raises(DerivationRejected, match=match):
        checked(*steps, start=start, discrete=discrete)


COMPANION = Matrix.of([[0, 1], [-2, -3]])
A_IS = Given((said(A, COMPANION),), silent=True)
C_IS = Given((said(C, Matrix.of([[1, c]])),), silent=True)
CHI = Define(said(Letter("chi"), Apply("det", Sum((Product((S, Identity(2))), Negative(A)))), s**2 + 3 * s + 2))


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
        Solve(said(strange, 1), said(A, 1)),
        Conclude(None, (Predicate("stable", strange),)),
        Conclude(None, (Roots(strange, ()),)),
        Conclude(None, (Exactly(Predicate("stable", strange), ()),)),
        Conclude(None, (Together((one, said(strange, 1))),)),
        Conclude(slot(strange)),
        Note(slot(Shown(strange, literal(1)))),
        Diagram("loop", (("plant", strange),)),
        Section(slot(strange), ()),
        Case(said(strange, 0), (), ()),
    ):
        refused(step)


def test_links_after_the_first_are_checked_and_what_is_written_anew_must_agree() -> None:
    checked(Define(said(F, Power(literal(a), 2), a * a)))
    refused(Define(said(F, Power(literal(a), 2), a)), match="is not true")
    checked(A_IS, A_IS)
    refused(A_IS, Given((said(A, Matrix.identity(2)),)))


@pytest.mark.parametrize("operator", ["!=", "!==", "<", ">="])
def test_only_an_equation_introduces(operator: str) -> None:
    refused(Define(said(F, operator, 1)))
    refused(Given((said(F, operator, 1),)))
    refused(Solve(said(1, 1), said(F, operator, 1)))


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


def test_what_solves_an_equation_makes_it_true() -> None:
    unknown = Letter("L")
    assert checked(Solve(said(Product((literal(2), unknown)), 6), said(unknown, 3))).values["L"] == Scalar.of(3)
    refused(Solve(said(Product((literal(2), unknown)), 6), said(unknown, 4)))


# -- conditions --------------------------------------------------------------------------------------------------------


def test_an_assumption_holds_from_there_on() -> None:
    distinct = said(c, "!=", 1)
    refused(Equal((distinct,)))
    assert checked(Given((distinct,)), Equal((distinct, said(2 - 2 * c, "!=", 0)))).assumed == (c - 1,)
    refused(Equal((distinct,)), Given((distinct,)))
    refused(Given((distinct,)), Equal((said(c, "!=", 2),)))


def test_an_assumption_is_the_one_that_is_said() -> None:
    first, second = said(c, "!=", 1), said(c, "!=", 2)
    checked(Given((first,), slot(first)))
    checked(Given((first, second), slot(Together((first, second)))))
    refused(Given((first,), slot(Together((first, second)))))
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
WRONG_SIGN = loop(Sum((Product((A, ESTIMATE)), Product((B, U)), Negative(Product((L, INNOVATION))))))
ERROR = said(Derivative(E), Product((Sum((A, Negative(Product((L, C))))), E)))


def test_an_error_equation_is_checked_on_signals() -> None:
    checked(*OBSERVER, Equal((ERROR,)))
    refused(*WRONG_SIGN, Equal((ERROR,)))
    refused(*OBSERVER, Equal((said(Derivative(E), Product((A, E))),)))
    refused(
        *OBSERVER[:-2], Define(said(E, Sum((X, Negative(ESTIMATE))))), Equal((ERROR,)), match="cannot be read|not true"
    )


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


# -- facts in sentences ------------------------------------------------------------------------------------------------

UNSTABLE = Given((said(A, Matrix.of([[0, 1], [2, 1]])),), silent=True)


@pytest.mark.parametrize(
    ("fact", "false"),
    [
        (said(Apply("det", A), 2), said(Apply("det", A), 3)),
        (Together((said(1, 1), said(a, ">", 0))), Together((said(a, ">", 0), said(c, ">", 0)))),
        (Shown(Apply("det", A), literal(2)), Shown(Apply("det", A), literal(-2))),
        (Predicate("stable", Letter("chi")), Predicate("unstable", Letter("chi"))),
        (Predicate("stable", Power(Letter("chi"), -1)), Predicate("unstable", Power(Letter("chi"), -1))),
        (Predicate("strictly_proper", Power(Letter("chi"), -1)), Predicate("strictly_proper", Letter("chi"))),
        (
            Predicate("not_polynomial", Quotient(Letter("chi"), literal(s))),
            Predicate("polynomial", Quotient(Letter("chi"), literal(s))),
        ),
        (
            Predicate("polynomial", Quotient(Letter("chi"), literal(s + 1))),
            Predicate("not_polynomial", Quotient(Letter("chi"), literal(s + 1))),
        ),
        (Predicate("never_zero", Apply("det", A)), Predicate("never_zero", Product((Apply("det", A), literal(c))))),
        (Predicate("never_zero", Product((C, Transpose(C)))), Predicate("no_such_property", Letter("chi"))),
        (
            Roots(Letter("chi"), roots_of(s**2 + 3 * s + 2, "s")),
            Roots(Letter("chi"), roots_of(s**2 + 3 * s - 4, "s")),
        ),
        (
            Roots(Power(Letter("chi"), -1), roots_of(s**2 + 3 * s + 2, "s")),
            Roots(Power(Letter("chi"), -1), ()),
        ),
    ],
)
def test_a_fact_is_checked_as_such_and_in_a_sentence(fact: Fact, false: Fact) -> None:
    checked(A_IS, C_IS, CHI, Conclude(None, (fact,)), Note(slot(fact)))
    refused(A_IS, C_IS, CHI, Conclude(None, (false,)))
    for step in (Conclude(slot(false)), Note(slot(false)), Equal((), slot(false)), Given((), slot(false))):
        refused(A_IS, C_IS, CHI, step)
    refused(A_IS, C_IS, CHI, Case(said(c, 0), (("c", Scalar.of(0)),), (), slot(false)))


def test_a_property_belongs_to_a_letter() -> None:
    for fact in (
        Predicate("stable", Literal(s + 1)),
        Predicate("stable", Sum((S, literal(1)))),
        Roots(Literal(s + 1), roots_of(s + 1, "s")),
        Exactly(Predicate("stable", Literal(s + c)), (said(c, ">", 0),)),
    ):
        refused(Conclude(None, (fact,)), match="no letter's")


def test_a_property_of_a_matrix_makes_no_sense() -> None:
    refused(A_IS, Conclude(None, (Predicate("stable", A),)), match="cannot be read")


def test_a_value_in_a_sentence_stands_with_what_it_is_the_value_of() -> None:
    checked(A_IS, Note(slot(A)))
    checked(A_IS, Note(slot("a word")))
    refused(A_IS, Note(slot(literal(2))), match="without what it is the value of")
    refused(A_IS, Note(slot(Sum((A, Literal(COMPANION))))), match="without what it is the value of")


def test_a_region_is_the_whole_region() -> None:
    phi = Define(said(Letter("phi"), literal(s**2 + a * s + c - 1)))
    stable = Predicate("stable", Letter("phi"))

    def where(*relations: Relation) -> Conclude:
        return Conclude(slot(Exactly(stable, relations)))

    checked(phi, where(said(c, ">", 1)))
    checked(phi, where(said(1, "<", c)))
    for lie in (said(c, ">=", 1), said(1, "<=", c), said(c, ">", 0), said(c, "<", 1), said(c, "!=", 1)):
        refused(phi, where(lie))
    refused(phi, where(said(c, ">", 1), said(c, ">", 0)))
    refused(phi, where())
    refused(phi, Conclude(slot(Exactly(replace(stable, name="unstable"), (said(c, ">", 1),)))))
    refused(Define(said(Letter("phi"), literal(s + 1))), where())


def test_a_fraction_has_the_region_and_the_roots_of_its_denominator() -> None:
    F_is = Define(said(F, literal(1 / (c * s + 1))))
    checked(F_is, Conclude(slot(Exactly(Predicate("stable", F), (said(c, ">", 0),)))))
    checked(F_is, Conclude(None, (Roots(F, roots_of(c * s + 1, "s")),)))
    refused(F_is, Conclude(None, (Predicate("stable", F),)))
    refused(F_is, Conclude(None, (Predicate("unstable", F),)))


def test_stability_is_that_of_the_time_domain() -> None:
    start = replace(START, variable="z")
    slow, z = Define(said(Letter("phi"), literal(Scalar.symbol("z") - Scalar.rational(1, 2)))), Letter("phi")
    checked(slow, Conclude(None, (Predicate("stable", z),)), start=start, discrete=True)
    refused(slow, Conclude(None, (Predicate("stable", z),)), start=start, discrete=False)


@pytest.mark.parametrize("key", sorted(ASSERTS))
def test_a_sentence_that_asserts_a_property_has_it_among_its_facts(key: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(PHRASES, key, "It is so.")
    facts: Mapping[str, Fact] = {
        "stable": Predicate("stable", Letter("chi")),
        "unstable": Predicate("unstable", Negative(Sum((Letter("chi"), literal(-9))))),
        "strictly_proper": Predicate("strictly_proper", Power(Letter("chi"), -1)),
        "polynomial": Predicate("polynomial", Letter("chi")),
        "not_polynomial": Predicate("not_polynomial", Power(Letter("chi"), -1)),
    }
    needed = tuple(facts[name] for name in ASSERTS[key])
    checked(A_IS, CHI, Conclude(Sentence(key), needed))
    refused(A_IS, CHI, Conclude(Sentence(key), needed[1:]), match="rests on")
    refused(A_IS, CHI, Note(Sentence(key), needed[:-1]), match="rests on")


def test_slots_match_their_phrase() -> None:
    with pytest.raises(ValueError, match=r"has the slots \['it'\], not \[\]"):
        Sentence("test_slot")
    with pytest.raises(ValueError, match=r"has the slots \[\], not \['it'\]"):
        Sentence("test_plain", (("it", "word"),))


# -- diagrams ----------------------------------------------------------------------------------------------------------


def test_the_labels_of_a_diagram_are_what_its_letters_mean() -> None:
    known = (Given((said(P, 1 / s), said(F, 2 / (s + 1)))),)
    checked(*known, Diagram("loop", (("plant", literal(1 / s)), ("compensator", F))))
    refused(*known, Diagram("loop", (("plant", literal(2 / s)), ("compensator", F))))
    refused(*known, Diagram("loop", (("plant", F),)))
    checked(*known, Diagram("loop", (("controller", F),)))
    checked(Diagram("loop", (("plant", literal(2 / s)),)))


# -- cases -------------------------------------------------------------------------------------------------------------


def case(*steps: Step, when: Relation | None = None, at: int = 1) -> Case:
    return Case(when or said(c - 1, 0), (("c", Scalar.of(at)),), steps)


def test_a_case_lies_on_its_stratum_and_nothing_of_it_stays() -> None:
    rank = said(Apply("det", Apply("adj", Product((Transpose(C), C)))), 0)
    known = checked(A_IS, C_IS, case(Equal((said(C, Matrix.of([[1, 1]])),)), Define(said(F, 1))), Equal((rank,)))
    assert "F" not in known.values
    assert known.values["C"] == Matrix.of([[1, c]])
    refused(C_IS, case(Equal((said(C, Matrix.of([[1, c]]), Matrix.of([[1, 2]])),))))
    refused(C_IS, case(at=2))
    refused(C_IS, case(when=said(c, "!==", 2)))
    refused(C_IS, case(when=said(c, 0)))
    refused(C_IS, case(when=said(0, 0)))
    refused(C_IS, case(when=said((c - 1) * (c - 3), 0)))
    refused(C_IS, case(when=said((c - 1) * b, 0)))
    checked(C_IS, case(when=said(2 * a * (c - 1), 0)))
    refused(C_IS, case(when=said(b, 0)))
    refused(C_IS, Case(said(c - 1, 0), (), ()))
    refused(C_IS, Case(said(c - 1, 0), (("c", Scalar.of(1)), ("b", Scalar.of(0))), ()))
    refused(C_IS, case(Equal((said(1, 2),))))


def test_values_written_out_in_a_case_are_on_its_stratum_too() -> None:
    checked(case(Equal((said(c, 1), said(c * c + a, a + 1)))))
    refused(case(Equal((said(c, 2),))))
    checked(Define(said(Scalar.symbol("d"), c + a)), case(Equal((said(Scalar.symbol("d"), a + 1),))))


def test_what_was_assumed_outside_does_not_hold_in_a_case() -> None:
    distinct = said(c, "!=", 1)
    refused(Given((distinct,)), case(Equal((distinct,))))


def test_a_letter_that_means_nothing_on_the_stratum_may_not_be_used_there() -> None:
    pole = Given((said(L, Matrix.of([[1 / (c - 1)], [0]])),))
    checked(pole, case())
    refused(pole, case(Equal((said(L, L),))), match="before it is established")
    checked(pole, case(Define(said(L, Matrix.zeros(2, 1)))))


# -- derivations -------------------------------------------------------------------------------------------------------


def test_sections_share_what_is_established() -> None:
    inner = Section(Sentence("test_plain"), (A_IS, Section(Sentence("test_plain"), (CHI,))))
    assert checked(inner, Equal((said(Letter("chi"), s**2 + 3 * s + 2),))).knows("chi")
    refused(Section(Sentence("test_plain"), (CHI,)), A_IS)
    refused(Section(slot(said(1, 2)), ()))


def test_only_steps_are_steps() -> None:
    refused("a line of prose", match="cannot be read")  # type: ignore[arg-type]


def test_a_derivation_is_checked_once(monkeypatch: pytest.MonkeyPatch) -> None:
    derivation = Derivation((A_IS, CHI), START)
    known = derivation.check()
    monkeypatch.setattr("symobs.derivation.check._walk", None)
    assert derivation.check() is known
    with pytest.raises(TypeError):
        replace(derivation).check()
    assert (derivation.variable, derivation.discrete) == ("s", False)


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


def test_roots_without_closed_form_are_held_to_their_factor() -> None:
    quintic = s**5 - s - 1
    phi = Define(said(Letter("phi"), literal(quintic)))
    roots = roots_of(quintic, "s")
    checked(phi, Conclude(None, (Roots(Letter("phi"), roots),)))
    refused(phi, Conclude(None, (Roots(Letter("phi"), roots[1:]),)))
    other = tuple(Root(root.factor + 1, "s", root.centre, root.radicand, 1, root.index) for root in roots)
    refused(phi, Conclude(None, (Roots(Letter("phi"), other),)))
