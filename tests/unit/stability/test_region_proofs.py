"""Proofs about regions: what is proved is true, what is tampered with is refused, and what is left open says so."""

from __future__ import annotations

import ast
import sys
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import symobs
from symobs.exact import Scalar, from_coefficients
from symobs.stability.criteria.stability_conditions import stable_where
from symobs.stability.inequalities import z3_backend
from symobs.stability.inequalities.decision import decide_empty, implies
from symobs.stability.inequalities.proof import Combined, Equivalence, Opposite, ProvedByZ3, Step, proves, refutes
from symobs.stability.inequalities.prover import UNIT, prove, refute
from symobs.stability.inequalities.sample_points import find_point
from symobs.stability.inequalities.simplify import simplify
from symobs.stability.inequalities.z3_backend import QUESTION, Resources, point_by_z3
from tests.kit import scalar, scalars, tabled, tables
from tests.support.algebra import has_sign, random_fraction, seeded, value_at
from tests.support.paths import ROOT
from tests.support.sampling import tried

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence
    from fractions import Fraction

pytestmark = pytest.mark.slow

s, x, y, z, a, b, c = (Scalar.symbol(name) for name in ("s", "x", "y", "z", "a", "b", "c"))
h1, h2 = Scalar.symbol("h1"), Scalar.symbol("h2")
one, zero = Scalar.of(1), Scalar.of(0)
AB = {"a": "positive", "b": "positive"}


def points(signs: Mapping[str, str], count: int = 200, names: str = "abcxyz") -> list[dict[str, Fraction]]:
    generator = seeded((signs, names))
    return [
        {n: random_fraction(generator, signs.get(n, "real")) / 4 for n in [*names, "h1", "h2"]} for _ in range(count)
    ]


def positive_at(values: Sequence[Scalar], point: Mapping[str, Fraction]) -> bool:
    return all(value_at(value, point) > 0 for value in values)


@pytest.fixture
def alone(monkeypatch: pytest.MonkeyPatch) -> None:
    """Without z3."""
    monkeypatch.setitem(sys.modules, "z3", None)


# -- the prover ----------------------------------------------------------------------------------------------------------

#: Goal, what is known, signs.  Each is easily seen by hand.


@tabled
def test_what_follows_is_proved_and_true(goal_text: str, known_texts: list[str], signs: dict[str, str]) -> None:
    goal, known = scalar(goal_text), scalars(known_texts)
    steps = prove(goal, known, signs)
    assert steps is not None
    assert proves(steps, known, [goal], signs)
    for point in points(signs):
        assert value_at(goal, point) > 0 or not positive_at(known, point)
    for number in range(len(known)):
        fewer = known[:number] + known[number + 1 :]
        less = prove(goal, fewer, signs)
        assert less is None or proves(less, fewer, [goal], signs)


@tabled
def test_what_does_not_follow_is_not_proved(goal_text: str, known_texts: list[str], signs: dict[str, str]) -> None:
    goal, known = scalar(goal_text), scalars(known_texts)
    assert prove(goal, known, signs) is None
    found = implies(known, goal, signs)
    assert found.verdict == "no"
    assert found.point is not None
    assert all(has_sign(value, signs.get(name, "real")) for name, value in found.point.items())
    assert positive_at(known, found.point)
    assert not value_at(goal, found.point) > 0


linear = st.builds(lambda p, q, r, t: p * x + q * y + r * a + t, *[st.integers(-2, 2)] * 3, st.integers(-3, 3)).filter(
    lambda v: not v.is_constant
)


@given(
    st.lists(linear | st.builds(lambda u, v: u * v, linear, linear), min_size=1, max_size=3), linear | st.just(x * y)
)
@settings(max_examples=tried(80))
def test_whatever_is_proved_is_true(known: list[Scalar], goal: Scalar) -> None:
    steps = prove(goal, known, AB)
    if steps is not None:
        assert proves(steps, known, [goal], AB)
        for point in points(AB, 60):
            assert value_at(goal, point) > 0 or not positive_at(known, point)
    impossible = refute(known, AB)
    if impossible is not None:
        assert refutes(impossible, known, AB)
        assert not any(positive_at(known, point) for point in points(AB, 60))
        assert find_point(known, AB) is None


#: With u = 1 − a the cubic is −(u³ − 7u² + 12u + 3): negative for u > 0 by its roots, not by its terms.
CUBIC = a**3 + 4 * a**2 + a - 9


def test_a_sign_known_from_roots_alone_makes_no_false_step() -> None:
    known = [-a - 2, 1 - a, a**2 + a - 2, CUBIC]
    steps = refute(known, {"a": "real"})
    assert steps is None or refutes(steps, known, {"a": "real"})


# -- tampering ---------------------------------------------------------------------------------------------------------


def spoiled(step: Step) -> Iterator[Step]:
    """The step with one thing changed, each of which breaks the identity or uses what is not known."""
    unknown = Scalar.symbol("unknown")
    if isinstance(step, Opposite):
        yield replace(step, value=step.value + 1)
        yield replace(step, steps=())
        yield replace(step, multiple=step.multiple + 1)
        return
    if isinstance(step, ProvedByZ3):
        yield replace(step, given=())
        yield replace(step, given=(*step.given, unknown))
        yield replace(step, value=step.value - unknown)
        return
    yield replace(step, value=step.value + 1 if step.multiplier else one)
    yield replace(step, total=step.total[1:])
    for place, (coefficient, factors) in enumerate(step.total):
        if zero in factors:  # 0 > 0: whatever is said follows
            continue
        rest = (*step.total[:place], *step.total[place + 1 :])
        yield replace(step, total=(*rest, (coefficient + 1, factors)))
        yield replace(step, total=(*rest, (coefficient, (*factors, unknown))))
        yield replace(step, total=(*step.total, (one, factors), (-one, factors)))
    for coefficient, factors in step.multiplier:
        yield replace(step, multiplier=((coefficient * 2, factors),))


def regions() -> list[tuple[Equivalence, dict[str, str]]]:
    return [
        (stable_where(from_coefficients(scalars(coefficients), "s"), "s", signs).equivalence, signs)
        for coefficients, signs in tables(Path(__file__))["regions"]
    ]


def test_a_tampered_proof_is_refused() -> None:
    tried, kinds = 0, set[type]()
    for proof, signs in regions():
        assert proof.holds(signs)
        for side in ("forward", "backward"):
            steps = getattr(proof, side)
            for place, step in enumerate(steps):
                kinds.add(type(step))
                rest = (*steps[:place], *steps[place + 1 :])
                for bad in spoiled(step):
                    changed = (*steps[:place], bad, *steps[place + 1 :])
                    # What is spoiled proves nothing false; a step that was not needed may go.
                    assert replace(proof, **{side: changed}).holds(signs) <= replace(proof, **{side: rest}).holds(signs)
                    tried += 1
        if proof.kept:
            assert not replace(proof, kept=(*proof.kept, x - 17)).holds(signs)
        for gone in proof.kept:
            kept = tuple(value for value in proof.kept if value != gone)
            assert not replace(proof, kept=kept).holds(signs) or gone.is_zero
    assert tried > 60
    assert Combined in kinds


@pytest.mark.parametrize(
    "lie",
    [
        Combined(x, UNIT, ((x, ()),)),  # a coefficient of unknown sign
        Combined(x, UNIT, ((one, (x,)),)),  # the conclusion among what is known
        Combined(x**2, ((1 / x**2, ()),), ((one, ()),)),  # not defined at 0
        Combined(x**2, UNIT, ((x**2, ()),)),  # never negative, but 0 at 0
        Combined(x, (), ()),  # 0 = 0
        Combined(-one, ((-one, ()),), ((one, ()),)),  # a negative multiplier
        Combined(x, ((y, ()),), ((one, (x * y,)),)),  # a multiplier of unknown sign
        Combined(zero, UNIT, ((one, ()),)),  # 0 = 1
        Opposite(x, x * y, ()),
        ProvedByZ3(x, ()),
    ],
    ids=str,
)
def test_lies_are_refused(lie: Step) -> None:
    assert not proves([lie], [x * y, y], [lie.value], {})


@pytest.mark.usefixtures("alone")
def test_without_z3_nothing_is_believed() -> None:
    known = [x * y + 1, x**3 + 2 * x**2 + x * y**2 - x * y - 4 * x + 2 * y**2 - 9]
    assert not proves([ProvedByZ3(x + 2, tuple(known))], known, [x + 2], {})
    found = simplify([*known, x + 2], {})
    assert set(found.positive) == {*known, x + 2}
    assert found.dropped == ()
    assert not found.irredundant
    assert implies(known, x + 2, {}).verdict == "undecided"
    assert simplify([(x - y) ** 2, x], {}).irredundant
    assert stable_where(s**2 + (b + h2) * s + 1 - h1, "s", AB).irredundant


@tabled
def test_lists_made_short(raw: list[str], signs: dict[str, str], expected: list[str]) -> None:
    found = simplify(scalars(raw), signs)
    assert set(found.positive) == set(scalars(expected))
    assert found.equivalence.holds(signs)
    assert found.irredundant


# -- decisions -----------------------------------------------------------------------------------------------------------


@tabled
def test_empty_is_proved(texts: list[str]) -> None:
    conditions = scalars(texts)
    found = decide_empty(conditions, {})
    assert found.verdict == "yes"
    assert found.point is None
    assert refutes(found.steps, conditions, {})
    assert not refutes(found.steps, [v + 1000 for v in conditions], {})
    assert not refutes((), conditions, {}) or zero in conditions


@tabled
def test_not_empty_has_a_point(texts: list[str]) -> None:
    conditions = scalars(texts)
    found = decide_empty(conditions, {})
    assert found.verdict == "no"
    assert found.point is not None
    assert positive_at(conditions, found.point)


#: A question that z3 does not settle within one allowance (Motzkin's polynomial with a fourth variable is never negative).
HARD = x**4 * y**2 + x**2 * y**4 + z**6 + c**6 + 2 * c**4 * z**2 - 3 * x**2 * y**2 * z**2 + x * y * z * c**3 / 7


def test_z3_is_bounded_by_its_own_count_and_by_no_clock(monkeypatch: pytest.MonkeyPatch) -> None:
    """The same question costs the same whenever it is asked; a list that has spent its share asks no more."""
    pytest.importorskip("z3")

    def stopped() -> float:
        raise AssertionError("a clock was read")

    for clock in ("monotonic", "perf_counter", "time"):
        monkeypatch.setattr(f"time.{clock}", stopped)
    first, second = Resources(), Resources()
    answers = [point_by_z3([-HARD, x - 1], {}, resources=spent) for spent in (first, second)]
    assert answers[0] == answers[1] == ("maybe", {})
    assert first.left == second.left
    assert first.left == pytest.approx(z3_backend.TOGETHER - QUESTION, rel=0.01)
    easy = [x, -x - 1]
    assert point_by_z3(easy, {})[0] == "no"
    assert point_by_z3(easy, {}, resources=Resources(0)) == ("maybe", {})


@tabled
def test_no_clock_and_no_program_decides_an_answer(folder: str) -> None:
    """The clock, other programs and PATH are for the border: budgets of the command line, and PDF."""
    paths = [*(ROOT / "symobs" / folder).rglob("*.py")]
    assert paths
    for path in paths:
        imported = {
            alias.name.partition(".")[0] if isinstance(node, ast.Import) else (node.module or "").partition(".")[0]
            for node in ast.walk(ast.parse(path.read_text("utf-8")))
            if isinstance(node, ast.Import | ast.ImportFrom)
            for alias in node.names
        }
        assert not imported & {"time", "datetime", "signal", "subprocess", "shutil", "os"}, path


@pytest.mark.usefixtures("alone")
@pytest.mark.parametrize(
    ("polynomial", "sign", "needed"),
    [
        ("s + h1", "nonnegative", "h1 > 0"),
        ("s^2 + h1*s + 1", "nonnegative", "h1 > 0"),
        ("s + h1^2", "nonpositive", "h1 < 0"),
        ("s - h1", "nonpositive", "h1 < 0"),
        ("s^2 + (h1 + 1)*s + h1", "nonnegative", "h1 > 0"),
    ],
)
def test_the_end_of_a_weak_sign_shows_that_a_condition_is_needed(polynomial: str, sign: str, needed: str) -> None:
    """At h1 = 0, which the sign admits, each has a root at 0: so it is not stable everywhere, without another program."""
    found = symobs.stability_region(polynomial=polynomial, parameters=["h1"], symbols={"h1": sign})
    assert (found.verdict, found.stable_if) == ("conditional", [needed])
