"""The stream `variants/1` is the one of its definition, written here a second time, and will never be another one."""

from __future__ import annotations

import hashlib
from pathlib import Path

import pytest

from symobs.applications.variants.drawing import Draw, Draws
from symobs.applications.variants.parameters import Parameter, read_parameter
from tests.kit import tables

SEEDS = (0, 7, 2**63 - 1)


def word(seed: int, candidate: int, name: str, k: int) -> int:
    text = "symobs-variants/1\n" + str(seed) + "\n" + str(candidate) + "\n" + name + "\n" + str(k)
    return int.from_bytes(hashlib.sha256(text.encode()).digest()[:8], "big")


def test_words_are_those_of_the_definition() -> None:
    for seed in SEEDS:
        for candidate in (0, 1, 12345):
            draw = Draw(seed, candidate, "plant poles")
            assert [draw.word() for _ in range(20)] == [word(seed, candidate, "plant poles", k) for k in range(20)]


def test_a_choice_without_replacement_is_that_of_fisher_and_yates_from_the_top() -> None:
    for candidate in range(50):
        left = list(range(9))
        for k, last in enumerate(range(8, 4, -1)):
            other = word(3, candidate, "p", k) % (last + 1)
            left[last], left[other] = left[other], left[last]
        assert Draw(3, candidate, "p").some_of(range(9), 4) == left[5:]


KINDS = tables(Path(__file__))["kinds"]
#: SHA-256 of 200 draws of each kind for each of the seeds: a difference means that variants of old seeds are lost.
FROZEN = tables(Path(__file__))["frozen"]


def drawn(kind: str) -> list[str]:
    found = read_parameter(kind, KINDS[kind], lambda *told: pytest.fail(str(told)))
    assert isinstance(found, Parameter)
    return [str(found.drawn(Draws(seed, c)[kind])) for seed in SEEDS for c in range(200)]


@pytest.mark.parametrize("kind", KINDS)
def test_draws_are_frozen(kind: str) -> None:
    text = "\n".join(drawn(kind))
    assert hashlib.sha256(text.encode()).hexdigest()[:16] == FROZEN[kind]
