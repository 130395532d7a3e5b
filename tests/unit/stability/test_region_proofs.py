"""Proofs about regions: what is proved is true, what is tampered with is refused, and what is left open says so."""

from __future__ import annotations

import ast
import sys
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import symobs
from symobs.exact import Scalar, from_coefficients
from symobs.stability.criteria.stability_conditions import stable_where
from symobs.stability.inequalities import z3_backend
from symobs.stability.inequalities.decision import decide_empty, equivalence_of, implies
from symobs.stability.inequalities.proof import Combined, Equivalence, Opposite, ProvedByZ3, Step, proves, refutes
from symobs.stability.inequalities.proof_steps import UNIT, contradiction
from symobs.stability.inequalities.prover import prove, prove_by_opposite, refute
from symobs.stability.inequalities.sample_points import find_point, point_where_zero
from symobs.stability.inequalities.simplify import simplify
from symobs.stability.inequalities.z3_backend import QUESTION, Resources, none_by_z3, point_by_z3
from tests.kit import tabled
from tests.support.independent_algebra.plain import has_sign, random_fraction, seeded, value_at
from tests.support.paths import ROOT

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
PROVED: list[tuple[Scalar, list[Scalar], dict[str, str]]] = [
    (x + y, [x, y], {}),
    (x + 2, [x - 1], {}),
    (y + b, [x, x * (y + b)], AB),
    (x * y - b, [x - b, y - 1], AB),
    (x**2 + y**2 - 1, [x - 1], {}),
    (x, [x + y, x - y], {}),
    (x**2 * y - 1, [x * y - 1, x - 1], {}),
    (x * y + z - 1, [x * y + z - 2], {}),
    (x, [x**3 - 1], {}),
    (x, [a * x - b], AB),
    (-x, [a * x + b, -b * x], AB),
    (x + a, [x + b, a - b], AB),
    (x, [x - a**2], {}),
    (x, [y, z, c, x * (y * z) - y**2 - x**2 * c], {}),  # Liénard and Chipart's a₂ from the others
    (x, [x * y - 1, y], {}),
    (y, [x * y - 1, x], {}),
    (2 - x, [1 - x**2], {}),
    (x**2, [x**2 - a], AB),
]
NOT_PROVED: list[tuple[Scalar, list[Scalar], dict[str, str]]] = [
    (x - y, [x, y], {}),
    (x, [x + y], AB),
    (y, [x * y - 1], {}),
    (x, [a * x + b], AB),
    (x, [x * y], {}),
    (x**2, [y], {}),
    (x + a, [x + b], AB),
]


@pytest.mark.parametrize(("goal", "known", "signs"), PROVED, ids=str)
def test_what_follows_is_proved_and_true(goal: Scalar, known: list[Scalar], signs: dict[str, str]) -> None:
    steps = prove(goal, known, signs)
    assert steps is not None
    assert proves(steps, known, [goal], signs)
    for point in points(signs):
        assert value_at(goal, point) > 0 or not positive_at(known, point)
    for number in range(len(known)):
        fewer = known[:number] + known[number + 1 :]
        less = prove(goal, fewer, signs)
        assert less is None or proves(less, fewer, [goal], signs)


@pytest.mark.parametrize(("goal", "known", "signs"), NOT_PROVED, ids=str)
def test_what_does_not_follow_is_not_proved(goal: Scalar, known: list[Scalar], signs: dict[str, str]) -> None:
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
@settings(max_examples=80)
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


@pytest.mark.parametrize("more", ["", "*(s + b)"])
def test_a_region_beside_another_symbol_is_that_of_the_roots(more: str) -> None:
    """By Hurwitz s³ + (a² + a − 2) s² + (a + 3) s + 3 is stable where the cubic is positive: where a > 1.18."""
    symbols = {"a": "real", "b": "real"}
    text = f"(s^3 + (a^2 + a - 2)*s^2 + (a + 3)*s + 3){more}"
    found = symobs.stability_region(text, symbols=symbols, parameters="b")
    assert found.stable_if == [*(["b > 0"] if more else []), "a**3 + 4*a**2 + a - 9 > 0"]
    for k in range(-60, 61):
        at = k / 10 + 0.05
        stable = max(np.roots([1, at**2 + at - 2, at + 3, 3]).real) < 0
        assert stable == (at**3 + 4 * at**2 + at - 9 > 0)


def test_a_factor_of_which_only_one_sign_is_possible() -> None:
    steps = prove_by_opposite(x - 1, (x - 1) * (x + y), [x + y + 3, x - 2 - y], {})
    assert steps is None  # x = −1/2, y = −1
    product = (x + 1) * (x + y**2 + 2)
    found = prove_by_opposite(x + 1, product, [x + 3], {})
    assert found is None  # x = −5/2, y = 0
    known = [x + y, (x - 1) * y]
    (steps) = prove_by_opposite(y, known[1], [x + y - 1], {})
    assert steps is not None  # were y < 0, x < 1, but x > 1 − y
    assert isinstance(steps[0], Opposite)
    assert proves(steps, [x + y - 1, known[1]], [y], {})
    assert not proves(steps, [x + y, known[1]], [y], {})
    assert not proves([replace(steps[0], multiple=x + y - 1)], [x + y - 1, known[1]], [y], {})
    weak = [Opposite(x, x * y, (contradiction(-x),))]
    assert proves(weak, [x * y], [x], {"x": "nonnegative"})
    assert not proves(weak, [y], [x], {"x": "nonnegative"})  # x = 0 is open
    assert not proves([replace(steps[0], value=x - 1)], [x + y - 1, known[1]], [x - 1], {})


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
    texts: list[tuple[list[Any], dict[str, str]]] = [
        ([1, 1 + h1, 2 + h2, 1 + h1 * h2], {}),
        ([1, h2, 2 + h1, h2, h1], {}),
        ([1, b + h2, a**2 * (1 - h1)], AB),
        ([1, h1**2 - 1, 1 - h2**2], {}),
        ([1, h1, -1 - h1**2, 1 + h2**2], {}),
        ([a * b, a * h1, b * h1 * h2], {"a": "nonnegative"}),
        ([1, x * (y + b), x], AB),
    ]
    return [
        (stable_where(from_coefficients([Scalar.of(t) for t in text], "s"), "s", signs).equivalence, signs)
        for text, signs in texts
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


def test_z3_is_asked_again() -> None:
    pytest.importorskip("z3")
    known = [x * y + 1, x**3 + 2 * x**2 + x * y**2 - x * y - 4 * x + 2 * y**2 - 9]
    assert proves([ProvedByZ3(x + 2, tuple(known))], known, [x + 2], {})
    assert not proves([ProvedByZ3(x + 2, tuple(known))], known[:1], [x + 2], {})
    assert not proves([ProvedByZ3(x + 1, tuple(known))], known, [x + 1], {})


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


@pytest.mark.parametrize(
    ("raw", "signs", "expected"),
    [
        ([c * (1 - x)], {"c": "negative"}, [x - 1]),
        ([c * (1 - x)], {"c": "nonpositive"}, [x - 1, -c]),
        ([c**2 * (1 - x) ** 3], {}, [1 - x, c**2]),
        ([c**3 * (1 - x) ** 2 / y], {"c": "positive"}, [y, (x - 1) ** 2]),
        ([x * (y + b), x], AB, [x, y + b]),
        ([x * y * z, x - 1, y + b * x], AB, [x - 1, y * z, b * x + y]),
        ([(x - y) ** 2, x], {}, [x, (x - y) ** 2]),
        ([(x - y) ** 2, x - y - 1], {}, [x - y - 1]),
        ([(x - 1) * (x + 1), x + 3 * a], AB, [x**2 - 1, x + 3 * a]),
        ([1 - x**2], {}, [1 - x, 1 + x]),
        ([(x**2 + 1) * (x + a), x**2 - 2 * x + 3], {}, [x + a]),
    ],
    ids=str,
)
def test_lists_made_short(raw: list[Scalar], signs: dict[str, str], expected: list[Scalar]) -> None:
    found = simplify(raw, signs)
    assert set(found.positive) == set(expected)
    assert found.equivalence.holds(signs)
    assert found.irredundant


def test_what_is_dropped_is_told() -> None:
    found = simplify([x - 1, y - 1, x * y - 1, x + y], {})
    assert set(found.positive) == {x - 1, y - 1}
    assert set(found.dropped) == {(x * y - 1, "products"), (x + y, "products")}
    assert found.verdict == "conditional"
    assert simplify([a, a + b], AB).verdict == "yes"
    beside = simplify([x * y, y - 1], {}, beside=[x - 1])
    assert set(beside.positive) == {y - 1}
    assert beside.equivalence.holds({})


# -- decisions -----------------------------------------------------------------------------------------------------------

EMPTY = [
    [x, -x - y, y],
    [x**2 - 2, 2 - x**3, x],
    [-((x - y) ** 2)],
    [x * y - 1, -x - y, x - 5],
    [zero],
    [x, -x],
]
NOT_EMPTY = [
    [x, -1 - x**2 - y],
    [1 - x**2 - y**2, x + y - 1],
    [x**2 - 2, x, 3 - x**2],
    [],
    [(x - y) ** 2],
    [x * y - 100],
]


@pytest.mark.parametrize("conditions", EMPTY, ids=str)
def test_empty_is_proved(conditions: list[Scalar]) -> None:
    found = decide_empty(conditions, {})
    assert found.verdict == "yes"
    assert found.point is None
    assert refutes(found.steps, conditions, {})
    assert not refutes(found.steps, [v + 1000 for v in conditions], {})
    assert not refutes((), conditions, {}) or zero in conditions


def test_empty_by_z3() -> None:
    """A disc and a half-plane that do not meet: no products of the two prove it."""
    pytest.importorskip("z3")
    conditions = [1 - x**2 - y**2, x + y - 2]
    assert decide_empty(conditions, {}).verdict == "undecided"
    found = simplify(conditions, {})
    assert found.verdict == "no"
    assert found.equivalence.holds({})
    assert simplify(conditions, {}, ask=False).verdict == "conditional"


@pytest.mark.parametrize("conditions", NOT_EMPTY, ids=str)
def test_not_empty_has_a_point(conditions: list[Scalar]) -> None:
    found = decide_empty(conditions, {})
    assert found.verdict == "no"
    assert found.point is not None
    assert positive_at(conditions, found.point)


def test_the_same_region_told_in_two_ways() -> None:
    proof = equivalence_of([x, x * y - 1], [y, x * y - 1], {})
    assert proof is not None
    assert proof.holds({})
    for first, second in (([x, x * y - 1], [y, x * y - 2]), ([x * y - 1], [x, x * y - 1]), ([x], [x, y**2])):
        assert equivalence_of(first, second, {}) is None


@pytest.mark.parametrize(
    ("sign", "impossible"),
    [("positive", x), ("negative", -x), ("nonnegative", x + 1), ("nonpositive", 1 - x), ("nonzero", x**2)],
)
def test_z3_knows_the_signs(sign: str, impossible: Scalar) -> None:
    pytest.importorskip("z3")
    assert [none_by_z3([], signs, not_above=impossible) for signs in ({"x": sign}, {})] == [True, False]


def test_z3_is_not_asked_what_it_cannot_know() -> None:
    root = Scalar.symbol("pi")
    assert not none_by_z3([-root], {})
    assert not none_by_z3([x**40, -x], {"x": "positive"})


#: A question that z3 does not settle within one allowance (Motzkin's polynomial with a fourth variable is never negative).
HARD = x**4 * y**2 + x**2 * y**4 + z**6 + c**6 + 2 * c**4 * z**2 - 3 * x**2 * y**2 * z**2 + x * y * z * c**3 / 7


def test_z3_is_bounded_by_its_own_count_and_by_no_clock(monkeypatch: pytest.MonkeyPatch) -> None:
    """The same question costs the same whenever it is asked; a list that has spent its share asks no more."""
    pytest.importorskip("z3")

    def stopped() -> float:
        message = "a clock was read"
        raise AssertionError(message)

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
            for node in ast.walk(ast.parse(path.read_text(encoding="utf-8")))
            if isinstance(node, ast.Import | ast.ImportFrom)
            for alias in node.names
        }
        assert not imported & {"time", "datetime", "signal", "subprocess", "shutil", "os"}, path


def test_points() -> None:
    assert find_point([x, -x], {}) is None
    found = point_where_zero(x * y - 1, [x - 2], {"y": "positive"})
    assert found is not None
    assert found["x"] * found["y"] == 1
    assert found["x"] > 2
