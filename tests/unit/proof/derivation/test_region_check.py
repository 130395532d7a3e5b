"""What a page may say of a region: worked out by hand here, and every other sentence or part is refused."""

from __future__ import annotations

from dataclasses import replace

import pytest

from symobs.exact import Scalar
from symobs.exact.core.generators import square_root
from symobs.formula.phrases.languages import ENGLISH, Counted
from symobs.formula.tree import Conjunction, Environment, Letter, Literal, Relation
from symobs.formula.tree.plain_text import plain_relation
from symobs.proof.derivation import region_check
from symobs.proof.derivation.region_check import (
    are_the_parts,
    findings_of_conditions,
    findings_of_region,
    holds_exactly,
    interval_relations,
    is_survey,
    region_of,
)
from symobs.proof.derivation.steps import RegionSummary, Sentence
from symobs.stability.regions.region import LineRegion, PlaneRegion
from tests.kit import scalar, tabled
from tests.support.problems.steps import said

s, z, h, k, m, a = (Scalar.symbol(name) for name in "szhkma")
IN_S = Environment(signs={"a": "positive"})
CHI = Letter("chi")


def words(sentence: Sentence) -> tuple[str, ...]:
    """Return the key of a sentence, and what stands in its slots."""
    return (sentence.key, *(written(slot) for _, slot in sentence.slots))


def written(slot: object) -> str:
    """Return what stands in a slot as plain text."""
    return (
        str(slot.value)
        if isinstance(slot, Literal)
        else ENGLISH.put(slot)
        if isinstance(slot, Counted)
        else plain_relation(slot, "s")
        if isinstance(slot, Relation)
        else "; ".join(map(written, slot.relations))
        if isinstance(slot, Conjunction)
        else str(slot)
    )


def found(polynomial: Scalar, known: Environment = IN_S) -> list[tuple[str, ...]]:
    region = region_of(polynomial, known, discrete=known.variable == "z")
    assert region is not None
    return [words(sentence) for sentence in findings_of_region(region)]


ROOT_OF_TWO = square_root(Scalar.of(2))
IN_ONE = "in exactly one cell all roots are stable"


@tabled
def test_what_is_said_of_intervals(text: str, findings: list[list[str]], intervals: list[str]) -> None:
    polynomial = scalar(text)
    assert found(polynomial) == [tuple(finding) for finding in findings]
    region = region_of(polynomial, IN_S, discrete=False)
    assert isinstance(region, LineRegion)
    parts = interval_relations(region)
    assert [", ".join(plain_relation(relation, "s") for relation in part) for part in parts] == intervals
    step = RegionSummary(CHI, ("h",), findings_of_region(region), tuple(parts))
    assert is_survey(step, polynomial, IN_S, discrete=False)
    assert is_survey(replace(step, parts=()), polynomial, IN_S, discrete=False)
    assert is_survey(replace(step, findings=()), polynomial, IN_S, discrete=False)
    for lie in (Sentence("region_empty"), Sentence("connected_bounded"), Sentence("box_bounded")):
        if lie not in step.findings:
            assert not is_survey(replace(step, findings=(*step.findings, lie)), polynomial, IN_S, discrete=False)
    for other in ((*parts, (said(h, ">", 7),)), parts[1:], [(said(h, ">", 7),)]):
        if other:
            assert not is_survey(replace(step, parts=tuple(other)), polynomial, IN_S, discrete=False)


@tabled
def test_what_is_said_of_pieces_of_a_plane(polynomial: str, said: list[list[str]]) -> None:
    told = found(scalar(polynomial))
    assert all(tuple(finding) in told for finding in said)
    for key in ("hole", "curve_missing", "region_empty"):
        assert [list(finding) for finding in told if finding[0] == key] == [each for each in said if each[0] == key]


def test_the_lines_of_a_division_are_those_over_whose_points_its_pieces_are_stacked() -> None:
    """With the lines h = ±2, 0 there would be sixteen pieces of Jury's triangle; with k = ±1 there are nine."""
    triangle, in_z = z**2 + h * z + k, Environment(variable="z")
    region = region_of(triangle, in_z, discrete=True)
    assert isinstance(region, PlaneRegion)
    first, *others = findings_of_region(region)
    assert words(first) == ("cells_decide_discrete", "k", "the plane", "nine cells", IN_ONE)
    lines = dict(first.slots) | {"lines": Literal(h)}
    step = RegionSummary(CHI, ("h", "k"), (Sentence(first.key, tuple(lines.items())), *others), ())
    assert is_survey(replace(step, findings=(first, *others)), triangle, in_z, discrete=True)
    assert not is_survey(step, triangle, in_z, discrete=True)


def test_only_pieces_that_the_signs_allow_are_counted() -> None:
    known = Environment(signs={"a": "positive", "k": "positive"})
    assert found(s**2 + h * s + a, known) == [
        ("cells_decide", "a", "the admissible part of the plane", "two cells", IN_ONE),
        ("connected_unbounded",),
    ]
    assert found(s + a + k, known) == [("region_everywhere", "SymbolList(names=('a', 'k'))")]
    assert found(s + (a - k) ** 2, known)[-1] == ("curve_missing", "a - k = 0")


def test_parts_of_a_plane_are_its_own() -> None:
    polynomial = s**2 + h * s + k
    region = region_of(polynomial, IN_S, discrete=False)
    assert isinstance(region, PlaneRegion)
    right = ((said(h, ">", 0), said(k, ">", 0)),)
    assert are_the_parts(region, right)
    step = RegionSummary(CHI, ("h", "k"), (), right)
    assert is_survey(step, polynomial, IN_S, discrete=False)
    wrong: tuple[tuple[tuple[Relation, ...], ...], ...] = (
        ((said(h, ">", 0),),),
        ((said(k, ">", 0), said(h, ">", 0)),),
        ((said(h, ">", 1), said(k, ">", 0)),),
        (*right, *right),
    )
    for parts in wrong:
        assert not are_the_parts(region, parts)
        assert not is_survey(replace(step, parts=parts), polynomial, IN_S, discrete=False)
    for check in ("are_parts", "are_whole"):
        with pytest.MonkeyPatch.context() as patch:
            patch.setattr(region_check, check, lambda *_: False)
            assert not are_the_parts(region, right)


def test_a_region_is_of_its_own_parameters_and_kind_of_time() -> None:
    given: tuple[tuple[str, ...], ...] = ((), ("h",), ("h", "k"))
    for names in given:
        assert region_of(s + h, IN_S, discrete=False, names=names) is not None
    others: tuple[tuple[str, ...], ...] = (("k",), ("h", "s"))
    for names in others:
        assert region_of(s + h, IN_S, discrete=False, names=names) is None
        assert not is_survey(RegionSummary(CHI, names, (), ((said(h, ">", 0),),)), s + h, IN_S, discrete=False)
    both = region_of(s**2 + h * s + k, IN_S, discrete=False, names=("k", "h"))
    assert isinstance(both, PlaneRegion)
    assert both.names == ("k", "h")
    assert region_of((s + h) * (s + k) * (s + m), IN_S, discrete=False) is None
    assert found(z + h, Environment(variable="z")) == [
        ("zeros_decide", "h = -1; h = 1", "three intervals", "one of them")
    ]


def test_a_region_that_is_not_proved_is_not_told(monkeypatch: pytest.MonkeyPatch) -> None:
    step = RegionSummary(CHI, ("h",), (), ((said(h, ">", 0),),))
    monkeypatch.setattr(region_check, "is_region", lambda *_: False)
    assert not is_survey(step, s + h, IN_S, discrete=False)
    assert not is_survey(replace(step, parts=()), s + h, IN_S, discrete=False)


BOX = (s + h) * (s + k) * (s + m)


def said_of(polynomial: Scalar, known: Environment = IN_S) -> list[str]:
    told = findings_of_conditions(polynomial, known, ("h", "k", "m"), discrete=known.variable == "z")
    return [sentence.key for sentence in told]


@tabled
def test_what_is_known_by_inequalities_only(polynomial: str, signs: dict[str, str], keys: list[str]) -> None:
    variable = "z" if "z" in polynomial else "s"
    assert said_of(scalar(polynomial), Environment(variable=variable, signs=signs)) == keys


def test_no_other_sentence_is_said_of_a_box() -> None:
    step = RegionSummary(CHI, ("h", "k", "m"), (Sentence("box_unbounded"),))
    assert is_survey(step, BOX, IN_S, discrete=False)
    for findings in (
        (),
        (Sentence("box_bounded"),),
        (Sentence("region_empty"),),
        (*step.findings, Sentence("region_empty")),
    ):
        assert not is_survey(replace(step, findings=findings), BOX, IN_S, discrete=False)
    assert not is_survey(replace(step, parts=((said(h, ">", 0),),)), BOX, IN_S, discrete=False)


def test_what_is_not_proved_by_inequalities_is_not_told(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(region_check, "is_stable_where", lambda *_, **__: False)
    assert said_of(BOX) == said_of((s - 1) * BOX) == []


@tabled
def test_inequalities_describe_the_region(polynomial: str, where: list[tuple[str, str]], *, expected: bool) -> None:
    region = region_of(scalar(polynomial), IN_S, discrete=False)
    assert region is not None
    assert holds_exactly(region, tuple((scalar(value), operator) for value, operator in where)) == expected


def test_what_the_sign_of_a_parameter_says_need_not_be_said() -> None:
    for sign, polynomial, inequality, more in (
        ("positive", s**2 + s * (h + 1) + 2 - h, 2 - h, h),
        ("negative", s**2 + s * (1 - h) + 2 + h, 2 + h, -h),
    ):
        region = region_of(polynomial, Environment(signs={"h": sign}), discrete=False)
        assert isinstance(region, LineRegion)
        assert holds_exactly(region, ((inequality, ">"),))
        assert holds_exactly(region, ((inequality, ">"), (more, ">")))
        assert not holds_exactly(region, ((inequality - 1, ">"),))


def test_nor_where_the_other_end_is_irrational() -> None:
    for sign, kept, left_out in (("positive", ROOT_OF_TWO - h, h), ("negative", h + ROOT_OF_TWO, -h)):
        region = region_of(s + 2 - h**2, Environment(signs={"h": sign}), discrete=False)
        assert isinstance(region, LineRegion)
        assert holds_exactly(region, ((kept, ">"),))
        assert not holds_exactly(region, ((left_out, ">"),))
        assert not holds_exactly(region, ((kept + 1, ">"),))
        with pytest.MonkeyPatch.context() as patch:
            patch.setattr(region_check, "is_region", lambda *_: False)
            assert not holds_exactly(region, ((kept, ">"),))
