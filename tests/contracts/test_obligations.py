"""What sentences owe is declared beside their words: nothing declared may be lost, and nothing unknown be declared.

The tables beside it hold what was declared when each sentence was written.  They may grow; a sentence leaves them only
with its words, or where its words no longer say so.
"""

from __future__ import annotations

import ast
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

from symobs.formula.phrases import ASSERTS, DEMANDS, PHRASES
from symobs.proof.derivation import check, wording_check
from symobs.proof.derivation.facts import PREDICATES
from tests.kit import tables

if TYPE_CHECKING:
    from types import ModuleType

#: Obligations, and the sentences that owe them.
DEMANDED = tables(Path(__file__))["demanded"]

#: Properties, and the sentences that assert them.
ASSERTED = tables(Path(__file__))["asserted"]

OWED = [(key, obligation) for obligation, keys in DEMANDED.items() for key in keys.split()]
ASSERTING = [(key, properties) for properties, keys in ASSERTED.items() for key in keys.split()]


@pytest.mark.parametrize(("key", "obligation"), OWED)
def test_no_obligation_is_lost(key: str, obligation: str) -> None:
    assert DEMANDS.get(key) == obligation, f"{key!r} says {PHRASES.get(key)!r} and owes {obligation}"


@pytest.mark.parametrize(("key", "properties"), ASSERTING)
def test_no_property_is_lost(key: str, properties: str) -> None:
    assert set(properties.split()) <= set(ASSERTS.get(key, ())), f"{key!r} says {PHRASES.get(key)!r}"


def test_every_check_is_owed_by_a_sentence() -> None:
    owed = {name for text in DEMANDS.values() for name, *_ in wording_check.obligations(text)}
    assert owed == wording_check.OBLIGATIONS


def test_every_property_that_is_asserted_can_be_checked() -> None:
    assert {name for names in ASSERTS.values() for name in names} <= PREDICATES.keys()


def test_an_unknown_obligation_is_refused_with_its_phrase() -> None:
    with pytest.raises(ValueError, match=r"'full_rank': 'says_rank_ful'"):
        wording_check.require_known({**DEMANDS, "full_rank": "says_rank_ful"})


@pytest.mark.parametrize("module", [check, wording_check], ids=["check", "wording_check"])
def test_the_checker_knows_no_phrase(module: ModuleType) -> None:
    tree = ast.parse(Path(str(module.__file__)).read_text("utf-8"))
    assert not {node.value for node in ast.walk(tree) if isinstance(node, ast.Constant)} & PHRASES.keys()
