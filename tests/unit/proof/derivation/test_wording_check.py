"""What the relation in a sentence must say so that the sentence speaks of it, and the facts that a verdict rests on."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest

import symobs
from symobs.exact import Matrix, Scalar
from symobs.exact.core.generators import PI, function
from symobs.formula.phrases.languages import Counted, StateChoice
from symobs.formula.tree import (
    Apply,
    Environment,
    Identity,
    Letter,
    Literal,
    Negative,
    Predicate,
    Product,
    Relation,
    Sum,
)
from symobs.ground.errors import DerivationRejected
from symobs.proof.derivation.sentence_context import SentenceContext
from symobs.proof.derivation.wording_check import meets_obligations as rests_on
from symobs.proof.derivation.wording_check import relation_fits
from symobs.proof.derivation.wording_of_polynomials import one_higher
from tests.kit import SERVO, tabled, tables
from tests.support.problems.steps import said
from tests.support.tampering.mutations import lines_of

if TYPE_CHECKING:
    from symobs.proof.derivation import Derivation


def meets_obligations(key: str, facts: tuple[Any, ...], here: Environment) -> bool:
    return rests_on(key, SentenceContext(facts, here))


#: Two rows of rank 1, and three rows of rank 2.
LOW, HIGH = Literal(Matrix.of([[1, 2, 3], [2, 4, 6]])), Literal(Matrix.of([[1, 0], [0, 1], [1, 1]]))
HERE = Environment()


def rank(of: Literal, *more: Any) -> Relation:
    return said(Apply("rank", of), *more)


FULL = rank(HIGH, 2)
LOWER = (rank(LOW, "<", 2), rank(LOW, 1), rank(LOW, 1, 2, "=", "<"))
#: True, but of no rank, of another number, or with more behind it.
BESIDE = (
    said(1, 1),
    said(1, "<", 2),
    said(Apply("det", Literal(Matrix.of([[1]]))), 1),
    said(Apply("det", Literal(Matrix.of([[0]]))), "<", 1),
    rank(HIGH, "<", 3),
    rank(LOW, "<", 3),
    rank(HIGH, 2, 2),
    rank(HIGH, 2, 3, "=", "<"),
    rank(LOW, 1, 1),
    rank(LOW, 1, 3, "=", "<"),
    rank(LOW, ">", 0),
    rank(LOW, "!=", 2),
    rank(LOW, 1, 2, 3, "=", "<", "<"),
)

SAID_OF_FULL = ["disturbance_zeros_origin", "disturbance_zeros_one"]
SAID_OF_LOWER = ["disturbance_blocked_origin", "disturbance_blocked_one"]


@pytest.mark.parametrize("key", SAID_OF_FULL)
def test_a_full_rank_is_said_to_be_full(key: str) -> None:
    assert relation_fits(key, FULL, HERE) is True
    assert relation_fits(key, rank(HIGH, Matrix.of([[2]])), HERE) is True
    for other in (*LOWER, *BESIDE):
        assert relation_fits(key, other, HERE) is False


@pytest.mark.parametrize("key", SAID_OF_LOWER)
def test_a_lower_rank_is_said_to_be_lower(key: str) -> None:
    for lower in LOWER:
        assert relation_fits(key, lower, HERE) is True
    for other in (FULL, *BESIDE):
        assert relation_fits(key, other, HERE) is False


def pair(of: str, A: Matrix, row: list[Any], *more: Any) -> tuple[Relation, Environment]:
    """The rank of the test matrix [C; CA] of a pair, or [B, AB] of its dual, and the environment of the pair."""
    C = Matrix.of([row])
    O = Matrix.block([[C], [C @ A]])
    if of == "observability":
        return rank(Literal(O), *more), Environment(values={"A": A, "C": C})
    return rank(Literal(O.T), *more), Environment(values={"A": A.T, "B": C.T})


@pytest.mark.parametrize("of", ["observability", "controllability"])
def test_a_rank_that_is_said_of_a_pair_is_that_of_its_own_test_matrix(of: str) -> None:
    h, I = Scalar.symbol("h"), Matrix.identity(2)
    full, here = pair(of, Matrix.of([[0, 1], [0, 0]]), [1, 0], 2)
    falling, there = pair(of, I * 2, [1, 0], "<", 2)
    exceptional, somewhere = pair(of, Matrix.of([[0, 1], [0, 0]]), [h, 0], 2)  # not at h = 0
    assert not relation_fits(f"full_rank_{of}", exceptional, somewhere)
    assert relation_fits(f"generic_rank_{of}", exceptional, somewhere)
    for key in (f"full_rank_{of}", f"generic_rank_{of}"):
        assert relation_fits(key, full, here)
        assert not relation_fits(key, full, HERE)
        assert not relation_fits(key, rank(Literal(I * 2), 2), here)  # the rank of another matrix
    gain = "observer" if of == "observability" else "state_feedback"
    for key in (f"yes_{of}", f"pbh_yes_{of}", f"no_fixed_modes_{of}", f"assignable_{gain}", f"any_{gain}"):
        assert meets_obligations(key, (), here)
        assert not any(meets_obligations(key, (full,), e) for e in (there, somewhere, HERE))
    assert meets_obligations(f"pbh_no_{of}", (), there)
    assert not meets_obligations(f"pbh_no_{of}", (falling,), here)
    low, generic = f"no_{of}", f"generic_low_{of}"
    for A, row in ((I * 2, [1, h]), (I * h, [h, 1])):  # of rank 1 for all h
        assert relation_fits(low, *pair(of, A, row, "<", 2))
        assert not relation_fits(low, pair(of, A, row, "<", 2)[0], here)
    falls = pair(of, I * 0, [h, 0], "<", 2)  # of rank 0 at h = 0
    assert not relation_fits(low, *falls)
    assert relation_fits(generic, *falls)
    assert not relation_fits(generic, full, here)


def test_a_fact_about_one_matrix_is_not_carried_to_another_without_its_ground() -> None:
    A, C = Matrix.of([[-2, 1, 0], [0, 1, 2], [0, 0, 0]]), Matrix.of([[0, -1, 2]])
    rows = [C, C @ A, C @ A @ A]
    M = Matrix.block([[row] for row in rows]).T @ Matrix.block([[row] for row in rows])
    W = Matrix.of([[0, 0, 0], [0, 2, 0], [0, 0, 8]])  # C'C + A'C'C A
    v = Matrix.column([1, 0, 0])
    data: dict[str, Any] = {"A": A, "C": C, "M": M, "W": W, "v": v}
    here = Environment(variable="z", values=data)
    flow = Environment(values=data | {"exp_At": A})
    assert meets_obligations("finite_sum_is", (), here)
    assert not meets_obligations("finite_sum_is", (), here.extended_by(values={"M": W}))
    assert not meets_obligations(
        "kernel_none", (), here
    )  # a sum of two powers is neither an integral nor over all time
    assert not meets_obligations("kernel_shared", (), here)
    assert meets_obligations("kernel_shared", (), flow)
    assert not meets_obligations("kernel_shared", (), flow.extended_by(values={"M": W}))
    assert meets_obligations("steps_kernel_observability", (), here)
    assert not meets_obligations(
        "steps_kernel_observability", (), here.extended_by(values={"v": Matrix.column([0, 1, 0])})
    )
    assert not meets_obligations(
        "steps_kernel_observability", (), here.extended_by(values={"W": W * 0})
    )  # more than v is in it
    assert not meets_obligations("steps_nonsingular_observability", (), here)
    assert meets_obligations("steps_nonsingular_observability", (), here.extended_by(values={"W": Matrix.identity(3)}))


# -- exponentials ---------------------------------------------------------------------------------------------------------

POLES = Environment(values={"sigma_d": Scalar.of(2), "omega_d": Scalar.of(3), "T_s": Scalar.of(5)})
EXPONENTS = {
    "decayed": Scalar.of(-10),
    "overshoot_held": Scalar.symbol(PI) * Fraction(-2, 3),
    "overshoot_close": -Scalar.symbol(PI) / Fraction(151, 100),  # of 3/2, its third digit one higher
}


@pytest.mark.parametrize("key", EXPONENTS)
def test_an_exponential_is_that_of_the_letters(key: str) -> None:
    assert relation_fits(key, said(function("exp", EXPONENTS[key]), "<", 1), POLES) is True
    for other in (*{*EXPONENTS.values()} - {EXPONENTS[key]}, -EXPONENTS[key], Scalar.of(-1)):
        assert relation_fits(key, said(function("exp", other), "<", 1), POLES) is False
    assert relation_fits(key, said(0, "<", 1), POLES) is False


@tabled
def test_the_third_digit_is_one_higher(value: str, higher: str) -> None:
    assert one_higher(Fraction(value)) == Fraction(higher)


@pytest.mark.parametrize("value", ["0", "-1"])
def test_only_what_is_positive_has_a_third_digit(value: str) -> None:
    with pytest.raises(ValueError, match=value):
        one_higher(Fraction(value))


# -- facts ------------------------------------------------------------------------------------------------------------------


def property_of(name: str) -> Predicate:
    return Predicate(name, Letter("chi"))


STABLE = property_of("stable")
NOTHING = (property_of("never_zero"), said(1, 1))


@tabled
def test_a_verdict_rests_on_the_unobservable_modes(verdict: str, of: str) -> None:
    """State 1 is not seen: its mode, 1/2 or −1, has nothing to do with the mode that is."""
    yes, no = f"yes_{verdict}", f"no_{verdict}"
    for mode, seen in ((-1, 3), (1, -3)):
        A, N, X = Matrix.of([[mode, 0], [0, seen]]), Matrix.column([1, 0]), Matrix.of([[mode]])
        here = pair(of, A, [0, 1], 2)[1].extended_by(values={"N": N, "X": X, "chi": Scalar.symbol("s") - seen})
        pencil = Sum((Product((Letter("s"), Identity(1))), Negative(Letter("X"))))
        own = [Predicate(name, Apply("det", pencil)) for name in ("stable", "unstable")]
        other = [property_of(name) for name in ("stable", "unstable", "marginal", "beyond")]
        assert meets_obligations(yes, (own[0],), here)  # that it is stable is a fact of the step
        assert meets_obligations(no, (own[1],), here)
        for facts in ((), NOTHING, *((fact,) for fact in other)):
            assert not meets_obligations(yes, facts, here)
            assert not meets_obligations(no, facts, here)
        for lie in ({"N": Matrix.column([0, 1])}, {"X": X * 2}, {"N": Matrix.zeros(2, 0), "X": Matrix.zeros(0, 0)}):
            assert not meets_obligations(yes, (own[0],), here.extended_by(values=lie))
    assert meets_obligations(yes, (), pair(of, Matrix.of([[0, 1], [0, 0]]), [1, 0], 2)[1])
    assert not meets_obligations(yes, (STABLE,), pair(of, Matrix.identity(2), [1, 0], 2)[1])


@tabled
def test_other_states_than_those_whose_rows_were_added_are_rejected(sets: tuple[tuple[int, ...], ...]) -> None:
    """With C = [0 1 1] and A = diag(1, 2, 3) state 1 has to be measured, and no other."""
    result: Any = symobs.observability(symobs.StateSpace("[1 0 0; 0 2 0; 0 0 3]", None, "[0 1 1]"))

    def changed(step: Any) -> Any:
        if hasattr(step, "steps"):
            return replace(step, steps=tuple(map(changed, step.steps)))
        words = getattr(step, "sentence", None)
        if words is None or not words.key.startswith("repair"):
            return step
        return replace(step, sentence=replace(words, slots=(("states", StateChoice(sets)),)))

    result.derivation.check()
    with pytest.raises(DerivationRejected, match="rests on another fact"):
        replace(result.derivation, steps=tuple(map(changed, result.derivation.steps))).check()


COUNTING = tables(Path(__file__))["counting"]


def counted(key: str) -> Derivation:
    """Return a page with a sentence that counts."""
    task, plant, asked, _ = COUNTING[key]
    written: Derivation = getattr(symobs, task)(symobs.StateSpace(**plant), **asked).derivation
    return written


def line_saying(key: str, derivation: Derivation) -> tuple[Any, Any]:
    """Return the line with a sentence, and its step."""
    lines = lines_of(derivation)
    (line,) = [each for each in lines if getattr(getattr(each.step, "sentence", None), "key", "") == key]
    line.told(line.step).check()
    return line, line.step


@pytest.mark.parametrize("key", COUNTING)
def test_what_is_counted_in_words_is_counted_in_the_step(key: str) -> None:
    counting = {*COUNTING[key][-1]}
    line, step = line_saying(key, counted(key))
    slots = dict(step.sentence.slots)
    assert {name for name, slot in slots.items() if isinstance(slot, Counted)} == counting
    for name in counting:
        for other in (slots[name].count - 1, slots[name].count + 1):
            told = tuple({**slots, name: replace(slots[name], count=other)}.items())
            with pytest.raises(DerivationRejected, match="number or equation"):
                line.told(replace(step, sentence=replace(step.sentence, slots=told))).check()


@tabled
def test_several_poles_are_not_told_as_one(said: str, instead: str) -> None:
    line, step = line_saying(said, counted(said))
    with pytest.raises(DerivationRejected, match="number or equation"):
        line.told(replace(step, sentence=replace(step.sentence, key=instead, slots=()))).check()


def test_the_equations_that_are_substituted_are_those_of_the_input_and_of_the_observer() -> None:
    plant = SERVO
    derivation = symobs.compensator(plant, control_poles=[-2, -2], observer_poles=[-10, -10]).derivation
    line, step = line_saying("observer_closed_matrix", derivation)
    slots = dict(step.sentence.slots)
    told = {"law": slots["rate"], "rate": slots["law"]}
    with pytest.raises(DerivationRejected, match="or equation"):
        line.told(replace(step, sentence=replace(step.sentence, slots=tuple(told.items())))).check()


# -- how many, and none ----------------------------------------------------------------------------------------------------


def test_gains_are_as_many_as_the_sentence_says() -> None:
    """Of n p entries the n coefficients leave n p − n free; a mode that is not seen leaves one more."""
    A, two, one = Matrix.of([[0, 1], [0, 0]]), Matrix.identity(2), Matrix.of([[1, 0]])
    seen = {C: Environment(values={"A": A, "C": C}) for C in (two, one)}
    unseen = Environment(values={"A": A * 0, "C": one})
    for here, count in ((seen[two], 2), (seen[one], 0), (unseen, 1)):
        for told in range(4):
            said_of = SentenceContext((), here, {"count": str(told)})
            assert rests_on("dimension_observer", said_of) is (told == count)
        assert meets_obligations("family_observer", (), here) is (count > 0)
    assert meets_obligations("row_reduced_unique_observer", (), seen[one])
    assert not meets_obligations("row_reduced_unique_observer", (), seen[two])


def test_a_pattern_of_zeros_has_no_gain_only_where_the_coefficients_say_so() -> None:
    """With L = [l; 0] det(sI − A + LC) is s² − (a − l) s, with L = [0; l] s² − a s + l; φ = s² + 3 s + 2."""
    s, a = (Scalar.symbol(name) for name in "sa")
    here = Environment(values={"A": Matrix.of([[a, 1], [0, 0]]), "C": Matrix.of([[1, 0]]), "phi_o": s**2 + 3 * s + 2})
    dual = Environment(
        values={"A": here.values["A"].T, "B": here.values["C"].T, "phi_c": here.values["phi_o"]}  # type: ignore[union-attr]
    )

    def held(places: str, e: Environment = here, **when: Any) -> bool:
        return rests_on(
            "impossible_zero_unless" if when else "impossible_zero", SentenceContext((), e, {"places": places, **when})
        )

    assert held("(2, 1)")
    assert held("(1, 2)", dual)
    assert not held("(1, 1)")
    assert held("(1, 1)", when=Literal(a + 3))
    for other in (a, a + 2):
        assert not held("(1, 1)", when=Literal(other))
    assert not held("")
