"""A derivation in another convention, line by line: what it says there was written down by hand."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import pytest

from symobs.exact import Matrix, Scalar
from symobs.formula.convention import STANDARD, Convention
from symobs.formula.tree import (
    Environment,
    Formula,
    Letter,
    Negative,
    Product,
    Sum,
    SymbolList,
)
from symobs.ground.errors import DerivationRejected, UsageError
from symobs.proof.derivation import (
    Conclude,
    Define,
    Derivation,
    Equal,
    Given,
    Note,
    Section,
    Sentence,
    convention_signs,
    sign_translation,
    translated,
)
from symobs.proof.derivation.convention_signs import set_apart
from tests.support.problems.steps import START, literal, said

pytestmark = pytest.mark.usefixtures("own_phrases")

A, C, K, L, P, X, ESTIMATE = (Letter(name) for name in ("A", "C", "K", "L", "P", "x", "x_hat"))
a, h1, k1, l1, l2, m1, m2, r1, s = (
    Scalar.symbol(name) for name in ("a", "h1", "k1", "l1", "l2", "m1", "m2", "r1", "s")
)
GAIN = Matrix.column([5, 7])
PLANT = Given((said(A, Matrix.of([[0, 1], [-2, -3]])), said(C, Matrix.of([[1, 0]]))), silent=True)
L_IS = Define(said(L, GAIN))
ERROR = said(Sum((A, Negative(Product((L, C))))), Matrix.of([[-5, 1], [-9, -3]]))

#: u = K x̂ and A + M C; A + L C; other letters alone.
PLUS = Convention("plus", feedback_sign=1, observer_sign=1, letters={"L": "M_s"})
ONLY_SIGNS = Convention("signs", observer_sign=1)
ONLY_LETTERS = Convention("letters", letters={"L": "H", "K": "R"})


def plain_words(key: str = "test_plain", **slots: Any) -> Sentence:
    return Sentence(key, tuple(slots.items()))


def steps_in(convention: Convention, *steps: Any, start: Environment = START) -> tuple[Any, ...]:
    return translated(Derivation(steps, start), convention).steps


# -- signs ---------------------------------------------------------------------------------------------------------------


def test_a_page_stays_as_it_is_where_no_sign_and_no_letter_of_an_entry_changes() -> None:
    derivation = Derivation((PLANT, L_IS), START)
    assert translated(derivation, STANDARD) is derivation
    assert translated(derivation, ONLY_LETTERS) == derivation
    wrong = Derivation((PLANT, Define(said(L, GAIN, Matrix.column([5, 8])))), START)
    for convention in (STANDARD, PLUS):
        with pytest.raises(DerivationRejected, match=r"the line L = \[5; 7\] = \[5; 8\]"):
            translated(wrong, convention)


def test_a_gain_that_means_the_negative() -> None:
    assert steps_in(PLUS, PLANT, L_IS, Equal((ERROR,))) == (
        PLANT,
        Define(said(L, Matrix.column([-5, -7]))),
        Equal((said(Sum((A, Product((L, C)))), Matrix.of([[-5, 1], [-9, -3]])),)),
    )


# -- what is held against what ------------------------------------------------------------------------------------------


def test_a_translation_that_turns_nothing_is_rejected(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(convention_signs, "in_signs", lambda steps, _: steps)
    with pytest.raises(DerivationRejected, match="L in another convention"):
        steps_in(PLUS, PLANT, L_IS)


def test_every_line_is_checked_again(monkeypatch: pytest.MonkeyPatch) -> None:
    one_more = Equal((said(A, Matrix.of([[0, 1], [-2, -4]])),))
    monkeypatch.setattr(convention_signs, "in_signs", lambda _, __: (PLANT, Define(said(L, -GAIN)), one_more))
    with pytest.raises(DerivationRejected, match="is not true"):
        steps_in(PLUS, PLANT, L_IS)


BEFORE = Environment(
    values={"A": Matrix.of([[1]]), "K": Matrix.of([[2]]), "L": Matrix.of([[3]])},
    signals={"x": None, "x_hat": None, "u": Negative(Product((K, X)))},
    sizes={"x": 1, "x_hat": 1},
    dynamics={"x": Product((A, X)), "x_hat": Product((Sum((A, Negative(L))), ESTIMATE))},
)
AFTER = replace(
    BEFORE,
    values={"A": Matrix.of([[1]]), "K": Matrix.of([[-2]]), "L": Matrix.of([[-3]])},
    signals={"x": None, "x_hat": None, "u": Product((K, X))},
    dynamics={"x": Product((A, X)), "x_hat": Product((Sum((A, L)), ESTIMATE))},
)
GAINS = frozenset({"K", "L"})


def test_every_letter_means_what_it_meant_or_its_negative() -> None:
    convention_signs._hold_against(BEFORE, AFTER, GAINS)
    convention_signs._hold_against(BEFORE, BEFORE, frozenset())
    lost = {name: value for name, value in AFTER.values.items() if name != "K"}
    for values in (
        BEFORE.values,
        AFTER.values | {"A": Matrix.of([[-1]])},  # type: ignore[operator]
        AFTER.values | {"K": Matrix.of([[2]])},  # type: ignore[operator]
        AFTER.values | {"L": Matrix.of([[4]])},  # type: ignore[operator]
        lost,
    ):
        with pytest.raises(DerivationRejected):
            convention_signs._hold_against(BEFORE, replace(AFTER, values=values), GAINS)
    with pytest.raises(DerivationRejected, match="the line L in another convention"):
        convention_signs._hold_against(BEFORE, AFTER, frozenset({"K"}))


def test_every_signal_means_what_it_meant() -> None:
    for signals in (
        {**AFTER.signals, "u": Negative(Product((K, X)))},
        {**AFTER.signals, "u": None},
        {**AFTER.signals, "x_hat": X},
        {"x": None, "x_hat": None},
    ):
        with pytest.raises(DerivationRejected, match="in another convention"):
            convention_signs._hold_against(BEFORE, replace(AFTER, signals=signals), GAINS)
    free = replace(BEFORE, dynamics={})
    convention_signs._hold_against(free, replace(AFTER, dynamics={}), GAINS)
    for signals in ({**AFTER.signals, "x_hat": X}, {**AFTER.signals, "u": None}):
        with pytest.raises(DerivationRejected, match="in another convention"):
            convention_signs._hold_against(free, replace(AFTER, signals=signals, dynamics={}), GAINS)
    for dynamics in (
        {**AFTER.dynamics, "x": Product((L, X))},
        {**AFTER.dynamics, "x_hat": BEFORE.dynamics["x_hat"]},
        {"x": AFTER.dynamics["x"]},
    ):
        with pytest.raises(DerivationRejected, match="in another convention"):
            convention_signs._hold_against(BEFORE, replace(AFTER, dynamics=dynamics), GAINS)


# -- letters ---------------------------------------------------------------------------------------------------------------


def test_no_page_writes_two_things_alike() -> None:
    two = (PLANT, L_IS, Define(said(P, Product((C, L)))))
    for letters in (
        {"L": "A"},
        {"A": "L"},
        {"L": "x"},
        {"x_hat": "A"},
        {"x_hat": "x"},
        {"L": "Q", "A": "Q"},
        {"A": "Q", "L": "C"},
    ):
        with pytest.raises(UsageError, match="for two things of this page"):
            steps_in(Convention("book", letters=letters), *two)
    for fine in ({"L": "K"}, {"L": "L"}, {"x_hat": "q"}, {"K": "A"}, {"L": "A", "A": "L"}):
        assert steps_in(Convention("book", letters=fine), *two) == two
    message = "the convention book writes A for two things of this page: (.*gain.* and .*matrix|.*matrix.* and .*gain)"
    with pytest.raises(UsageError, match=message):
        steps_in(Convention("book", letters={"L": "A"}), *two)
    equal = (PLANT, Define(said(L, C)))
    assert steps_in(Convention("book", letters={"L": "C"}), *equal) == equal
    own = (*two, Define(said(Letter("no_letter_of_ours"), 7)))
    assert steps_in(Convention("book", letters={"L": "N"}), *own) == own


def test_parameters_that_are_printed_like_a_letter_are_set_apart() -> None:
    mass, matrix = Scalar.symbol("M"), Scalar.symbol("A")
    plant = Given((said(A, Matrix.of([[mass, 1], [matrix, -3]])), said(C, Matrix.of([[1, 0]]))), silent=True)
    derivation = Derivation((plant, L_IS), START)
    both = translated(derivation, PLUS)
    told = [Note(plain_words("without_serifs", parameter=SymbolList((name,)))) for name in "AM"]
    assert both.steps == (plant, Define(said(L, -GAIN)))
    assert both.symbols == {"A": r"\mathsf{A}"}
    alike = replace(PLUS, letters={"L": "M"})
    assert translated(derivation, alike).symbols == {"A": r"\mathsf{A}", "M": r"\mathsf{M}"}
    section = Section(plain_words(), (plant, L_IS))
    first, _ = translated(Derivation((section, Equal((said(L, GAIN),))), START), alike).steps
    assert isinstance(first, Section)
    assert first.steps == (plant, Define(said(L, -GAIN)), *told)
    assert set_apart(derivation, [], {}) is derivation


def test_the_variable_of_polynomials_is_no_parameter() -> None:
    start = Environment(variable="z", signals={"x_hat": None}, sizes={"x_hat": 1})
    z = Scalar.symbol("z")
    derivation = Derivation((Define(said(Letter("chi"), z**2 + z + a)),), start, discrete=True)
    assert translated(derivation, Convention("book", letters={"x_hat": "z"})) == derivation


# -- unknown entries --------------------------------------------------------------------------------------------------------


def own(convention: Convention, *steps: Any, final: Environment | None = None, reduced: bool = False) -> Any:
    found = final or Environment()
    return sign_translation.with_own_unknowns(steps, found, convention, reduced=reduced)


def sought(letter: Formula, *entries: Scalar) -> Conclude:
    return Conclude(None, (said(letter, Matrix.column(list(entries))),))


def test_unknown_entries_are_called_after_their_letter() -> None:
    assert own(PLUS, sought(L, l1, l2)) == (sought(L, -m1, -m2),)
    assert own(ONLY_LETTERS, sought(L, l1)) == (sought(L, h1),)
    assert own(ONLY_LETTERS, sought(K, k1)) == (sought(K, r1),)
    assert own(ONLY_SIGNS, sought(L, l1, l2)) == (sought(L, -l1, -l2),)
    assert own(ONLY_SIGNS, sought(K, k1)) == (sought(K, k1),)
    assert own(PLUS, sought(L, l1), sought(A, l1, l2)) == (sought(L, -m1), sought(A, -m1, l2))
    both = own(replace(PLUS, letters={"L": "M", "K": "R"}), sought(K, k1), sought(L, l1))
    assert both == (sought(K, -r1), sought(L, -m1))


@pytest.mark.parametrize(("row", "is_gain"), [([5, 7], False), ([5, 8], True)])
def test_data_that_are_equal_to_a_gain_keep_their_sign(row: list[int], is_gain: bool) -> None:  # noqa: FBT001
    """Where no data are equal to it the gain that is written out is the new one."""
    plant = Given((said(A, Matrix.of([[0, 1], [-2, -3]])), said(C, Matrix.of([row]))), silent=True)
    written, turned = (Product((literal(Matrix.of([row])), literal(gain))) for gain in (GAIN, -GAIN))
    found = steps_in(PLUS, plant, L_IS, Define(said(Letter("P"), Product((C, L)), written)))
    expected = Negative(turned) if is_gain else written
    assert found[2] == Define(said(Letter("P"), Negative(Product((C, L))), expected))


def test_the_minus_of_unknown_entries_goes_into_the_matrix_before_them() -> None:
    def replaced(entry: Scalar) -> Any:
        product = Product((literal(Matrix.of([[1, 2]])), literal(Matrix.column([l1, entry]))))
        return sign_translation._substituted(product, {"l1": -m1, "l2": -m2})

    assert replaced(l2) == Product((literal(Matrix.of([[-1, -2]])), literal(Matrix.column([m1, m2]))))
    assert replaced(a) == Product((literal(Matrix.of([[1, 2]])), literal(Matrix.column([-m1, a]))))
