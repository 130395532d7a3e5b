"""Facts on their own and in sentences: equations, properties, roots, regions, values, and what a sentence asserts."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import pytest

from symobs.exact import Matrix, Root, Scalar, roots_of
from symobs.exact.core.generators import function, identities
from symobs.formula.phrases import ASSERTS, PHRASES
from symobs.formula.tree import (
    Apply,
    Conjunction,
    Environment,
    Evaluated,
    Fact,
    Formula,
    HoldsExactlyWhere,
    Letter,
    Literal,
    Negative,
    Power,
    Predicate,
    Product,
    Quotient,
    Relation,
    Roots,
    RoundedRoots,
    Sum,
    Transpose,
)
from symobs.proof.certificate.claims import verify
from symobs.proof.derivation import CaseStep, Conclude, Define, Diagram, Equal, Given, Note, Sentence
from symobs.proof.derivation.facts import on_stratum
from tests.kit import tabled
from tests.support.problems.steps import (
    A_IS,
    C_IS,
    CHI,
    COMPANION,
    START,
    A,
    C,
    F,
    P,
    S,
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

if TYPE_CHECKING:
    from collections.abc import Mapping


pytestmark = pytest.mark.usefixtures("own_phrases")

t = Scalar.symbol("t")


# -- facts in sentences ------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("fact", "false"),
    [
        (said(Apply("det", A), 2), said(Apply("det", A), 3)),
        (Conjunction((said(1, 1), said(a, ">", 0))), Conjunction((said(a, ">", 0), said(c, ">", 0)))),
        (Evaluated(Apply("det", A), literal(2)), Evaluated(Apply("det", A), literal(-2))),
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
            RoundedRoots(
                Sum((Letter("chi"), literal(-3 * s - 4))),
                roots_of(s**2 - 2, "s"),
                (("1.4142", "", True), ("-1.4142", "", True)),
            ),
            RoundedRoots(
                Sum((Letter("chi"), literal(-3 * s - 4))),
                roots_of(s**2 - 2, "s"),
                (("1.4142", "", True), ("-1.4143", "", True)),
            ),
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
    refused(A_IS, C_IS, CHI, CaseStep(said(c, 0), (("c", Scalar.of(0)),), (), slot(false)))


def test_a_property_belongs_to_a_letter() -> None:
    for fact in (
        Predicate("stable", Literal(s + 1)),
        Predicate("stable", Sum((S, literal(1)))),
        Roots(Literal(s + 1), roots_of(s + 1, "s")),
        HoldsExactlyWhere(Predicate("stable", Literal(s + c)), (said(c, ">", 0),)),
    ):
        refused(Conclude(None, (fact,)), match="no letter's")


def test_a_value_in_a_sentence_stands_with_what_it_is_the_value_of() -> None:
    checked(A_IS, Note(slot(A)))
    checked(A_IS, Note(slot("a word")))
    refused(A_IS, Note(slot(literal(2))), match="without what it is the value of")
    refused(A_IS, Note(slot(Sum((A, Literal(COMPANION))))), match="without what it is the value of")


def test_a_region_is_the_whole_region() -> None:
    phi = Define(said(Letter("phi"), literal(s**2 + a * s + c - 1)))
    stable = Predicate("stable", Letter("phi"))
    checked(phi, Conclude(slot(HoldsExactlyWhere(stable, (said(c, ">", 1),)))))
    for lie in ((said(c, ">", 0),), (said(c, ">", 1), said(c, ">", 0)), ()):
        refused(phi, Conclude(slot(HoldsExactlyWhere(stable, lie))))
    refused(phi, Conclude(slot(HoldsExactlyWhere(replace(stable, name="unstable"), (said(c, ">", 1),)))))


def test_a_fraction_has_the_region_and_the_roots_of_its_denominator() -> None:
    F_is = Define(said(F, literal(1 / (c * s + 1))))
    checked(F_is, Conclude(slot(HoldsExactlyWhere(Predicate("stable", F), (said(c, ">", 0),)))))
    checked(F_is, Conclude(None, (Roots(F, roots_of(c * s + 1, "s")),)))
    refused(F_is, Conclude(None, (Predicate("stable", F),)))
    refused(F_is, Conclude(None, (Predicate("unstable", F),)))


def test_stability_is_that_of_the_time_domain() -> None:
    start = replace(START, variable="z")
    plant = Given((said(P, literal((Scalar.symbol("z") - 1) / (Scalar.symbol("z") * (Scalar.symbol("z") - 2)))),))
    refused(plant, Conclude(None, (Predicate("no_stable_compensator", P),)), start=start, discrete=True)
    slow, z = Define(said(Letter("phi"), literal(Scalar.symbol("z") - Scalar.rational(1, 2)))), Letter("phi")
    checked(slow, Conclude(None, (Predicate("stable", z),)), start=start, discrete=True)
    refused(slow, Conclude(None, (Predicate("stable", z),)), start=start, discrete=False)


@tabled
def test_a_sentence_that_asserts_a_property_has_it_among_its_facts(key: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(PHRASES, key, "It is so.")
    facts: Mapping[str, Fact] = {
        "stable": Predicate("stable", Letter("chi")),
        "unstable": Predicate("unstable", Negative(Sum((Letter("chi"), literal(-9))))),
        "marginal": Predicate("marginal", Letter("chi")),
        "beyond": Predicate("beyond", Negative(Sum((Letter("chi"), literal(-9))))),
        "strictly_proper": Predicate("strictly_proper", Power(Letter("chi"), -1)),
        "polynomial": Predicate("polynomial", Letter("chi")),
        "not_polynomial": Predicate("not_polynomial", Power(Letter("chi"), -1)),
        "no_stable_compensator": Predicate("no_stable_compensator", P),
    }
    plant = Given((said(P, literal((s - 1) / (s * (s - 2)))),))
    needed = tuple(facts[name] for name in ASSERTS[key])
    checked(A_IS, CHI, plant, Conclude(Sentence(key), needed))
    refused(A_IS, CHI, plant, Conclude(Sentence(key), needed[1:]), match="rests on")
    refused(A_IS, CHI, plant, Note(Sentence(key), needed[:-1]), match="rests on")


# -- diagrams ----------------------------------------------------------------------------------------------------------


def test_the_labels_of_a_diagram_are_what_its_letters_mean() -> None:
    known = (Given((said(P, 1 / s), said(F, 2 / (s + 1)))),)
    loop = (s + 1) / (s**2 + s + 2)
    true: dict[str, Formula] = {"P": literal(1 / s), "F": Negative(F), "response": literal(loop)}
    checked(*known, Diagram("loop", tuple(true.items())))
    wrong: list[dict[str, Formula]] = [
        {"P": literal(2 / s)},
        {"F": F},
        {"F": Negative(P)},
        {"response": literal(2 * loop)},
        {"controller": F},
    ]
    for change in wrong:
        refused(*known, Diagram("loop", tuple({**true, **change}.items())))
    for name in true:
        refused(*known, Diagram("loop", tuple((key, label) for key, label in true.items() if key != name)))
    refused(Diagram("loop", tuple({**true, "F": literal(-2 / (s + 1))}.items())))
    refused(*known, Diagram("unity_loop", tuple(true.items())))


def test_roots_without_closed_form_are_held_to_their_factor() -> None:
    quintic = s**5 - s - 1
    phi = Define(said(Letter("phi"), literal(quintic)))
    roots = roots_of(quintic, "s")
    checked(phi, Conclude(None, (Roots(Letter("phi"), roots),)))
    refused(phi, Conclude(None, (Roots(Letter("phi"), roots[1:]),)))
    other = tuple(Root(root.factor + 1, "s", root.centre, root.radicand, 1, root.index) for root in roots)
    refused(phi, Conclude(None, (Roots(Letter("phi"), other),)))


def test_a_matrix_of_rational_functions_is_stable_where_all_its_poles_are() -> None:
    G = Letter("G_cl")

    def given(*entries: Scalar) -> Given:
        return Given((said(G, Literal(Matrix.row(entries))),))

    stable, unstable = given(1 / (s + 1), s / (s + 2)), given(1 / (s + 1), 1 / (s - 2))
    checked(stable, Conclude(None, (Predicate("stable", G),)))
    refused(stable, Conclude(None, (Predicate("unstable", G),)))
    refused(stable, Conclude(None, (Predicate("strictly_proper", G),)))
    refused(stable, Conclude(None, (Predicate("polynomial", G),)))
    checked(unstable, Conclude(None, (Predicate("unstable", G),)))
    checked(unstable, Conclude(None, (Predicate("strictly_proper", G),)))
    refused(unstable, Conclude(None, (Predicate("stable", G),)))


@pytest.mark.parametrize(
    ("kind", "arguments", "value", "true"),
    [
        # e^{at/(a+1)} and e^{t/(a+1)} at a = 2: the one is the square of the other
        ("exp", (a * t / (a + 1), t / (a + 1)), 2, Power(Letter("y"), 2)),
        # cos ab and cos b at a = 2: cos 2b = 2 cos² b − 1
        ("cos", (a * b, b), 2, Sum((Product((literal(2), Power(Letter("y"), 2))), literal(-1)))),
    ],
)
def test_functions_that_depend_on_each_other_on_a_stratum_are_known_to(
    kind: str, arguments: tuple[Scalar, Scalar], value: int, true: Formula
) -> None:
    first, second = (function(kind, argument) for argument in arguments)
    meanings, vanishing = identities([first, second])
    outside = Environment(values={"x": first, "y": second}, coefficients=meanings, relations=vanishing)
    inside = on_stratum(said(a, value), {"a": Scalar.of(value)}, outside)
    assert verify(Relation((Letter("x"), true), ("=",)), inside)[0]
    assert verify(Relation((Letter("x"), true), ("!==",)), inside)[0] == ""
    assert verify(Relation((Letter("x"), Letter("y")), ("=",)), inside)[0] == ""
