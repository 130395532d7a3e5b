"""The stream `variants/1` is the one of its definition, written here a second time, and will never be another one."""

from __future__ import annotations

import hashlib
import re
from collections import Counter
from fractions import Fraction
from itertools import pairwise

import pytest

from symobs.applications.variants.drawing import Draw, Draws
from symobs.applications.variants.parameters import Parameter, read_parameter

SEEDS = (0, 7, 2**63 - 1)


def word(seed: int, candidate: int, name: str, k: int) -> int:
    text = "symobs-variants/1\n" + str(seed) + "\n" + str(candidate) + "\n" + name + "\n" + str(k)
    return int.from_bytes(hashlib.sha256(text.encode()).digest()[:8], "big")


def test_words_are_those_of_the_definition() -> None:
    for seed in SEEDS:
        for candidate in (0, 1, 12345):
            draw = Draw(seed, candidate, "plant poles")
            assert [draw.word() for _ in range(20)] == [word(seed, candidate, "plant poles", k) for k in range(20)]


def test_words_above_the_last_multiple_are_left_out() -> None:
    bound = 2**63 + 1  # nearly half of all words are above it
    for candidate in range(20):
        kept = [each for k in range(200) if (each := word(7, candidate, "x", k)) < bound]
        draw = Draw(7, candidate, "x")
        assert [draw.below(bound) for _ in range(50)] == kept[:50]


def test_a_choice_without_replacement_is_that_of_fisher_and_yates_from_the_top() -> None:
    for candidate in range(50):
        left = list(range(9))
        for k, last in enumerate(range(8, 4, -1)):
            other = word(3, candidate, "p", k) % (last + 1)
            left[last], left[other] = left[other], left[last]
        assert Draw(3, candidate, "p").some_of(range(9), 4) == left[5:]


KINDS = {
    "integers": {"integers": [-5, 5], "except": [0]},
    "set": {"set": ["1/2", 1, "2"]},
    "range": {"range": "1/2:1/3:4"},
    "poles": {"poles": 3, "from": [-6, -1], "distinct": True},
    "pairs": {"poles": 4, "from": [-4, 4], "complex": True},
    "matrix": {"matrix": [2, 3], "integers": [-3, 3], "zeros": 3},
    "unimodular": {"unimodular": 3, "steps": 2},
}
#: SHA-256 of 200 draws of each kind for each of the seeds: a difference means that variants of old seeds are lost.
FROZEN = {
    "integers": "156c80ac37d99a16",
    "set": "a5e5d5051f9c5b16",
    "range": "c58b4816935f30d8",
    "poles": "8de044cf7ca477d5",
    "pairs": "db62f01e76e03997",
    "matrix": "394b4480f0918169",
    "unimodular": "7353335844555184",
}


def drawn(kind: str) -> list[str]:
    found = read_parameter(kind, KINDS[kind], lambda *told: pytest.fail(str(told)))
    assert isinstance(found, Parameter)
    return [str(found.drawn(Draws(seed, c)[kind])) for seed in SEEDS for c in range(200)]


@pytest.mark.parametrize("kind", KINDS)
def test_draws_are_frozen(kind: str) -> None:
    text = "\n".join(drawn(kind))
    assert hashlib.sha256(text.encode()).hexdigest()[:16] == FROZEN[kind]


def complex_of(pole: str) -> complex:
    real, sign, imaginary = re.fullmatch(r"(-\d+)([+-])(\d*)i", pole).groups()  # type: ignore[union-attr]
    return complex(int(real), int(f"{sign}{imaginary or 1}"))


def test_draws_are_what_the_table_says() -> None:
    values = Counter(drawn("integers"))
    assert set(values) == {str(n) for n in range(-5, 6) if n}
    assert max(values.values()) < 2 * min(values.values())
    assert set(drawn("range")) == {str(Fraction(1, 2) + Fraction(k, 3)) for k in range(11)}
    for poles in drawn("poles"):
        numbers = [int(pole) for pole in poles.split(", ")]
        assert all(-1 >= first > second >= -6 for first, second in pairwise(numbers))
    for poles in drawn("pairs"):
        first, second, third, fourth = (complex_of(pole) for pole in poles.split(", "))
        assert first.conjugate() == second
        assert third.conjugate() == fourth
        assert first.real < 0
    for rows in drawn("matrix"):
        entries = [int(entry) for entry in re.findall(r"-?\d+", rows)]
        assert entries.count(0) >= 3
        assert max(map(abs, entries)) <= 3
