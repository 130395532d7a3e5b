"""What the check of a derivation refuses, one check at a time: each fails where one check is left out or weaker."""

from __future__ import annotations

from dataclasses import FrozenInstanceError, replace
from typing import Any

import pytest

from symobs.exact import Matrix, Scalar, roots_of
from symobs.exact.core.generators import square_root
from symobs.formula.tree import (
    Apply,
    Conjunction,
    Environment,
    Evaluated,
    HoldsExactlyWhere,
    Letter,
    Literal,
    Negative,
    Predicate,
    Product,
    Quotient,
    Relation,
    Roots,
    Sum,
    SymbolList,
)
from symobs.ground.errors import DerivationRejected
from symobs.proof.derivation import (
    CaseStep,
    Conclude,
    Define,
    Derivation,
    Equal,
    Given,
    Note,
    RegionSummary,
    Section,
    Sentence,
    Step,
    Tabulate,
)
from symobs.stability.criteria.routh_table import routh_table
from tests.support.problems.steps import (
    A_IS,
    C_IS,
    COMPANION,
    START,
    A,
    C,
    F,
    X,
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

chi, phi = Letter("chi"), Letter("phi")
one, two = said(1, 1), said(1, 2)
h, k = Scalar.symbol("h"), Scalar.symbol("k")


def test_what_cannot_be_read_is_refused_with_its_line() -> None:
    strange = Equal((said(Letter("A"), Quotient(literal(1), literal(0))),))
    with pytest.raises(DerivationRejected, match=r"a step of kind Equal cannot be read|is not true"):
        checked(A_IS, strange)
    with pytest.raises(DerivationRejected, match="a step of kind str cannot be read") as caught:
        checked("prose")  # type: ignore[arg-type]
    assert caught.value.facts["line"] == "prose"
    assert caught.value.repair == "please report this: it is a bug of symobs"
    with pytest.raises(FrozenInstanceError):
        Derivation((), START).steps = ()  # type: ignore[misc]


def test_data_mean_nothing_where_a_denominator_vanishes() -> None:
    n = Scalar.symbol("n")

    def domain(*values: Any) -> tuple[Scalar, ...]:
        return checked(*(Given((said(Letter("P"), value),)) for value in values)).domain

    assert domain(1 / h) == (h,)
    assert domain(Matrix.of([[1, 1 / h], [k / n, 1]])) == (h, n)
    assert domain(Sum((literal(1), Sum((literal(1 / h), literal(1 / k))), literal(1 / n)))) == (h, k, n)
    assert domain(h / a) == domain(h) == ()  # a is positive
    two = checked(Given((said(Letter("P"), 1 / h), said(Letter("Q"), 1 / k)))).domain
    assert two == checked(Given((said(Letter("P"), 1 / h),)), Given((said(Letter("Q"), 1 / h / k),))).domain == (h, k)


@pytest.mark.parametrize("terms", [(A, Letter("Q")), (Letter("Q"), A)])
def test_every_letter_of_a_formula_is_established(terms: tuple[Letter, ...]) -> None:
    refused(A_IS, Equal((said(Sum(terms), A),)), match="Q is used before it is established")


# -- every part of a step is read ---------------------------------------------------------------------------------------


@pytest.mark.parametrize("relations", [(one, two), (two, one), (one, two, one)])
def test_every_relation_of_a_step_is_checked(relations: tuple[Relation, ...]) -> None:
    for step in (
        Equal(relations),
        Conclude(None, relations),
        Note(Sentence("test_plain"), relations),
        Equal((one,), slot(Conjunction(relations))),
        Conclude(None, (Conjunction(relations),)),
    ):
        refused(step)
    refused(Section(Sentence("test_plain"), tuple(Equal((relation,)) for relation in relations)))
    refused(*(Equal((relation,)) for relation in relations))


def test_every_slot_of_every_sentence_is_read() -> None:
    false: tuple[Any, ...] = (
        two,
        Conjunction((one, two)),
        Evaluated(literal(1), literal(2)),
        Predicate("stable", chi),
        Roots(chi, ()),
        HoldsExactlyWhere(Predicate("stable", chi), ()),
        SymbolList(("q",)),
        Letter("absent"),
        Literal(Scalar.of(2)),
        Sum((chi, Literal(Scalar.of(2)))),
    )
    start = replace(START, values={"chi": s - 1, "F": Scalar.of(1)})
    for lie in false:
        for step in (
            Given((said(A, 1),), slot(lie)),
            Define(said(A, 1), slot(lie)),
            Equal((one,), slot(lie)),
            Conclude(slot(lie)),
            Note(slot(lie)),
            Section(slot(lie), ()),
        ):
            if isinstance(lie, SymbolList):
                checked(step, start=start)
            else:
                refused(step, start=start)
    both = Sentence("parts", (("measured", "words"), ("unmeasured", two)))
    refused(Note(both), start=start)
    checked(Note(replace(both, slots=(("measured", chi), ("unmeasured", one)))), start=start)


def test_no_root_of_what_may_be_negative_is_written_anywhere() -> None:
    root = Product((literal(0), Literal(square_root(c))))
    for relation in (said(root, 0), said(0, root), said(0, 0, root)):
        refused(Equal((relation,)), match=">= 0")
        refused(
            Define(replace(relation, members=(F, *relation.members), operators=("=", *relation.operators))),
            match=">= 0",
        )
    refused(Note(slot(SymbolList(("a", str(square_root(c)))))), match=">= 0")
    refused(Note(slot(SymbolList((str(square_root(c)), "a")))), match=">= 0")
    checked(Note(slot(SymbolList(("a", str(square_root(a)))))))
    real = Product((literal(0), *(Literal(square_root(k * a)) for k in range(1, 9) if k != 4)))
    checked(Equal((said(real, 0),)))
    refused(Equal((said(Product((real, Literal(square_root(c)))), 0),)), match=">= 0")


def test_a_sentence_may_name_a_value_only_where_it_claims_nothing_of_it() -> None:
    limit = Literal(Scalar.of(-2))
    checked(Note(Sentence("sought_margin", (("names", SymbolList(("h",))), ("limit", limit)))))
    refused(Note(slot(limit)), match="a value in a sentence without what it is the value of")
    refused(Note(slot(Negative(Literal(a)))), match="a value in a sentence")
    checked(A_IS, Note(slot(A)))


def test_a_sentence_rests_on_its_facts() -> None:
    start = replace(START, values={"chi": s + 1, "phi": s - 1}, shown=(said(chi, s + 1), said(phi, s - 1)))
    for sentence, right, wrong in (
        (Sentence("stable_continuous"), Predicate("stable", chi), Predicate("unstable", phi)),
        (Sentence("unstable_continuous"), Predicate("unstable", phi), Predicate("stable", chi)),
    ):
        spoken_of: dict[Any, Step] = {chi: Equal((said(chi, s + 1),)), phi: Note(slot(said(phi, s - 1)))}
        checked(spoken_of.pop(right.subject), Conclude(sentence, (right,)), start=start)
        refused(*spoken_of.values(), Conclude(sentence, (right,)), start=start, match="which rests on")
        checked(Conclude(sentence, (right,)), start=start)
        checked(Conclude(sentence, (one, wrong, right)), start=start)
        for facts in ((), (wrong,), (one,)):
            refused(Conclude(sentence, facts), start=start, match="which rests on")
    refused(Conclude(None, (Predicate("stable", phi),)), start=start, match="stable")


# -- what a boundary is moved by ----------------------------------------------------------------------------------------

NAMES = ("names", SymbolList(("h",)))


def test_a_boundary_is_moved_to_the_limit_that_is_sought() -> None:
    start = replace(START, values={"chi": s + 3})
    sought = Note(Sentence("sought_margin", (NAMES, ("limit", Literal(Scalar.of(-2))))))
    shift = Sum((Letter("s"), Negative(literal(2))))
    move = Define(said(Letter("q_s"), Apply("chi_at", shift), s + 1), Sentence("moved_right", (("by", literal(2)),)))
    known = checked(sought, move, start=start)
    assert known.values["sought margin"] == Scalar.of(-2)
    refused(move, start=start, match="moved_right by 2")
    elsewhere = replace(sought, sentence=Sentence("sought_margin", (NAMES, ("limit", Literal(Scalar.of(-1))))))
    refused(elsewhere, move, start=start, match="moved_right by 2")
    other = replace(sought, sentence=Sentence("sought_margin", (NAMES, ("limit", Literal(Scalar.of(2))))))
    refused(other, move, start=start, match="moved_right by 2")
    told = replace(move, sentence=Sentence("moved_right", (("by", literal(3)),)))
    refused(sought, told, start=start, match="moved_right by 3")
    hidden = replace(move, relation=said(Letter("q_s"), s + 1))
    refused(sought, hidden, start=start, match="moved_right by 2")
    enlarged = Note(Sentence("sought_radius", (NAMES, ("limit", Literal(Scalar.of(-2))))))
    refused(enlarged, move, start=start, match="moved_right by 2")
    refused(Conclude(None), move, start=start, match="moved_right by 2")


def test_a_disc_is_enlarged_to_the_radius_that_is_sought() -> None:
    start = Environment(variable="z", values={"chi": Scalar.symbol("z") + 3})
    sought = Note(Sentence("sought_radius", (NAMES, ("limit", Literal(Scalar.of(2))))))
    scale = Product((Letter("s"), literal(2)))
    value = 2 * Scalar.symbol("z") + 3
    move = Define(said(Letter("q_s"), Apply("chi_at", scale), value), Sentence("enlarged", (("by", literal(2)),)))
    known = checked(sought, move, start=start, discrete=True)
    assert known.values["sought radius"] == Scalar.of(2)
    refused(move, start=start, match="enlarged by 2", discrete=True)
    for limit in (-2, 3):
        other = Note(Sentence("sought_radius", (NAMES, ("limit", Literal(Scalar.of(limit))))))
        refused(other, move, start=start, match="enlarged by 2", discrete=True)
    margin = Note(Sentence("sought_margin", (NAMES, ("limit", Literal(Scalar.of(2))))))
    refused(margin, move, start=start, match="enlarged by 2", discrete=True)
    facts = replace(move, sentence=Sentence("enlarged", (("by", one),)))
    refused(sought, facts, start=start, match="where a formula stands", discrete=True)


@pytest.mark.parametrize("key", ["mapped", "mapped_from_v"])
def test_a_map_is_the_one_applied(key: str) -> None:
    start = replace(START, values={"chi": s + 3})
    image = Sum((Letter("s"), literal(1)))
    move = Define(said(Letter("q_w"), Apply("chi_at", image), s + 4), Sentence(key, (("image", image),)))
    checked(move, start=start)
    other = Sentence(key, (("image", Sum((Letter("s"), literal(2)))),))
    refused(replace(move, sentence=other), start=start, match=f"{key} by")
    refused(Note(Sentence(key, (("image", image),))), start=start, match=f"{key} by")
    checked(Define(said(Letter("q_w"), s + 4), slot("words")), start=start)


OWING = {
    "asserts": (Sentence("only_stable"), "which rests on stable"),
    "needs": (Sentence("yes_detectability"), "which rests on another fact"),
}


@pytest.mark.parametrize(("sentence", "why"), OWING.values(), ids=OWING)
def test_a_sentence_owes_the_same_in_a_step_of_any_kind(sentence: Sentence, why: str) -> None:
    unseen = {"A": COMPANION, "C": COMPANION * 0, "N": Matrix.identity(2), "X": COMPANION}
    start = replace(START, values={"chi": s**2 + 3 * s + 2, **unseen})
    relation, fact = said(Letter("chi"), s**2 + 3 * s + 2), Predicate("stable", Letter("chi"))
    checked(Conclude(sentence, (fact,)), start=start)
    for step in (
        Conclude(sentence),
        Note(sentence),
        Equal((relation,), sentence),
        Given((said(Letter("q_s"), s + 1),), sentence),
        Define(said(Letter("q_s"), s + 1), sentence),
        Section(sentence, (Conclude(None, (fact,)),)),
    ):
        refused(step, start=start, match=why)


# -- tables, regions, pictures ------------------------------------------------------------------------------------------


def test_a_table_is_that_of_its_letter() -> None:
    start = replace(START, values={"chi": s**2 + h * s + 2})
    table = Tabulate(chi, routh_table([Scalar.of(1), h, Scalar.of(2)]), "s")
    known = checked(table, start=start)
    assert known.values["Delta_1"] == h
    told = replace(table, sentence=Sentence("routh_table", (("polynomial", chi),)))
    checked(told, start=start)
    refused(replace(told, sentence=Sentence("routh_table", (("polynomial", A),))), A_IS, start=start)
    refused(A_IS, replace(told, sentence=Sentence("routh_table", (("polynomial", A),))), start=start)
    refused(replace(table, table=routh_table([Scalar.of(1), h, Scalar.of(3)])), start=start, match="the table of chi")
    refused(replace(table, polynomial=Literal(s**2 + h * s + 2)), start=start, match="no letter's")
    refused(replace(table, sentence=slot(two)), start=start)
    refused(table, match="before it is established")
    refused(replace(told, sentence=Sentence("routh_table", (("polynomial", "words"),))), start=start)
    checked(A_IS, replace(table, sentence=slot(A)), start=start)
    checked(table, start=replace(start, values={"chi": Matrix.of([[s**2 + h * s + 2]])}))


def test_a_region_is_that_of_its_letter() -> None:
    start = replace(START, values={"chi": s + h})
    right = (said(h, ">", 0),)
    checked(RegionSummary(chi, ("h",), (), (right,)), start=start)
    refused(RegionSummary(chi, ("h",), (), ((said(h, ">", 1),),)), start=start, match="the region of chi")
    refused(RegionSummary(Literal(s + h), ("h",), (), (right,)), start=start, match="no letter's")
    refused(RegionSummary(phi, ("h",), (), (right,)), start=start, match="before it is established")
    refused(RegionSummary(chi, ("h",), (), (right,), slot(two)), start=start)
    checked(RegionSummary(chi, ("h",), (), (right,)), start=replace(start, values={"chi": Matrix.of([[s + h]])}))


# -- what is introduced -------------------------------------------------------------------------------------------------


def test_what_is_introduced_is_named_by_an_equation() -> None:
    for operator in ("!=", "<", "~", "!=="):
        refused(Define(Relation((F, literal(1), literal(1)), (operator, "="))))
    refused(Define(Relation((F, literal(1), literal(2)), ("=", "="))))
    checked(Define(Relation((F, literal(1), literal(2)), ("=", "<"))))
    refused(Define(Relation((F, literal(2), literal(1)), ("=", "<"))))


def test_a_written_value_stands_as_it_is_written() -> None:
    """A named coefficient in what is written out stays a name."""
    d = Scalar.symbol("d")
    known = checked(Define(said(d, a + 1)), Define(said(F, d * d)))
    assert known.values["F"] == d * d
    product = Product((Literal(d), Literal(d)))
    for members in ((product, d * d), (d * d, product), ((a + 1) ** 2, d * d)):
        assert checked(Define(said(d, a + 1)), Define(said(F, *members))).values["F"] == d * d
    assert checked(Define(said(d, a + 1)), Define(said(F, d * d, (a + 1) ** 2))).values["F"] == (a + 1) ** 2
    known = checked(Define(said(d, a + 1)), Define(said(Scalar.symbol("e"), d * 2)))
    assert known.coefficients["e"] == 2 * d


def test_a_condition_is_of_one_number() -> None:
    start = replace(START, values={"F": Matrix.of([[c]]), "C": Matrix.of([[c, c]])})
    assert checked(Given((said(F, "!=", 0),)), start=start).nonzero == (c,)
    refused(Given((said(C, "!=", 0),)), start=start)


def test_a_letter_of_a_signal_is_no_value() -> None:
    refused(Define(said(X, 1)))
    refused(Define(said(Letter("s"), 1)), match="stands for something else")
    refused(Define(said(Letter("s"), s)))


@pytest.mark.parametrize("step", [Equal((two,)), Conclude(None, (two,))])
def test_what_stands_inside_is_checked(step: Step) -> None:
    refused(Section(Sentence("test_plain"), (step,)))
    refused(Section(Sentence("test_plain"), (Equal((one,)), step)))
    refused(C_IS, CaseStep(said(c - 1, 0), (("c", Scalar.of(1)),), (step,)))


# -- strata -------------------------------------------------------------------------------------------------------------

ON = Environment(signs={"a": "positive", "b": "real", "c": "real", "h": "real", "k": "real"})


def case(when: Relation | Conjunction, *steps: Step, **put_in: Scalar | int) -> CaseStep:
    values = tuple((name, v if isinstance(v, Scalar) else Scalar.of(v)) for name, v in put_in.items())
    return CaseStep(when, values, steps)


def test_a_sentence_speaks_of_its_own_relation() -> None:
    low, high = literal(Matrix.of([[1, 2, 3], [2, 4, 6]])), literal(Matrix.of([[1, 0], [0, 1]]))
    full, lower = said(Apply("rank", high), 2), said(Apply("rank", low), "<", 2)
    for key, right, wrong in (("disturbance_zeros_origin", full, lower), ("disturbance_blocked_origin", lower, full)):
        start = replace(START, values={"C_hat": Matrix.row([int(right == full), 0]), "A_hat": COMPANION})
        checked(Conclude(Sentence(key, (("rank", right),))), start=start)
        for other in (wrong, said(1, 1), literal(2)):
            step = Conclude(Sentence(key, (("rank", other),)))
            refused(step, start=start, match=f"which is not what {key} speaks of")


def test_a_polynomial_has_lost_roots_on_a_stratum_where_its_leading_coefficient_vanishes() -> None:
    start = replace(ON, values={"F": 1 / ((c**2 - b) * s**2 + s + c)})
    curve = Conjunction((said(c**2, b),))
    checked(case(curve, Conclude(None, (Roots(F, roots_of(s + c, "s")),))), start=start)
    checked(case(said(k, 1), Conclude(None, (Roots(F, roots_of((c**2 - b) * s**2 + s + c, "s")),))), start=start)
    refused(case(curve, Conclude(None, (Roots(F, roots_of(s + b, "s")),))), start=start)
    refused(case(said(k, 1), Conclude(None, (Roots(F, roots_of(s + c, "s")),))), start=start)
