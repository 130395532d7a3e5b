"""Whatever text a reader gets, it is read or refused with an error of symobs: nothing else is raised."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import symobs
from symobs.applications.audit.equations import read_relation
from symobs.exact import Scalar
from symobs.formula.expression import declared_name, parse_matrix, parse_poles, parse_polynomial, parse_scalar
from symobs.problem import parse, validate
from symobs.system.specification import read_entries, read_names

if TYPE_CHECKING:
    from collections.abc import Callable

_ATOMS = st.sampled_from(
    [
        "1",
        "2.5",
        "1e-3",
        "a",
        "omega",
        "h1",
        "i",
        "j2",
        "I",
        "s",
        "t",
        "pi",
        "9" * 50,
        "0",
        "__",
        "√",
        "−",
        "²",
        "\x00",
        "λ",
    ]
)


def _larger(part: st.SearchStrategy[str]) -> st.SearchStrategy[str]:
    """Texts one rule of the grammar above their parts, and what is next to it."""
    several = st.lists(part, min_size=1, max_size=3)
    signs = st.sampled_from(["+", "-", " - ", " -", "*", "/", "^", "**", " ", "", ",", ";", "=", "'", "("])
    return st.one_of(
        st.tuples(part, signs, part).map("".join),
        st.tuples(st.sampled_from(["-", "sqrt", "exp", "cos", "eval", "det", ""]), part).map(
            lambda b: f"{b[0]}({b[1]})"
        ),
        st.lists(several.map(" ".join), min_size=1, max_size=3).map(lambda rows: f"[{'; '.join(rows)}]"),
    )


TEXTS = st.recursive(_ATOMS, _larger, max_leaves=12) | st.text(max_size=40)
NAMES = {"a": "real", "omega": "positive", "h1": "real"}
READERS: dict[str, Callable[[str], Any]] = {
    "scalar": parse_scalar,
    "matrix": lambda text: parse_matrix(text, NAMES, functions=True),
    "poles": parse_poles,
    "declared poles": lambda text: parse_poles(text, NAMES),
    "polynomial": lambda text: parse_polynomial(text, "s", NAMES),
    "name": declared_name,
    "names": lambda text: read_names(text, "parameters"),
    "entries": lambda text: read_entries(text, "zero", (2, 3)),
    "relation": lambda text: read_relation(text, "printed"),
    "plant": symobs.StateSpace.from_transfer_function,
    "file": lambda text: validate(parse(text)),
    "toml": lambda text: validate(parse(f'task = "observer"\n[plant]\nA = {json.dumps(text)}\nC = "[1 0]"')),
    "json": lambda text: validate(parse(json.dumps({"task": text, "plant": {"A": [[text]]}, text: 1}))),
}


@pytest.mark.parametrize("name", READERS)
@given(TEXTS)
@settings(max_examples=60)
def test_a_text_is_read_or_refused(name: str, text: str) -> None:
    try:
        value = READERS[name](text)
    except symobs.SymobsError:
        return
    if name == "scalar" and isinstance(value, Scalar):
        assert parse_scalar(str(value)) == value
