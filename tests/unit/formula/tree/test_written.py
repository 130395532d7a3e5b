"""Formulas as text: what is read, what is refused, and that a formula's own text reads back as the formula."""

from __future__ import annotations

import ast
import re
from typing import TYPE_CHECKING

import pytest
from hypothesis import given
from hypothesis import strategies as st

from symobs.exact import Matrix, Scalar
from symobs.formula.tree import (
    Apply,
    At,
    Block,
    Derivative,
    Environment,
    Identity,
    Letter,
    Literal,
    Negative,
    Power,
    Product,
    Quotient,
    Relation,
    Sum,
    Transpose,
)
from symobs.formula.tree.plain_text import plain
from symobs.formula.tree.term import factors_of, terms_of
from symobs.formula.tree.written import read_formula, read_relation, stacked, written, written_relation
from tests.support.paths import ROOT

if TYPE_CHECKING:
    from pathlib import Path

    from symobs.formula.tree import Formula

A, B, K, P, x = map(Letter, ("A", "B", "K", "P", "x"))
ZERO, ONE, TWO = (Literal(Scalar.of(k)) for k in range(3))
PLANT = Environment(values={"A": Matrix.of([[0, 1], [2, 3]]), "b": Scalar.symbol("b"), "c": Matrix.of([[1, 0]])})


@pytest.mark.parametrize(
    ("text", "formula"),
    [
        ("A - B K", Sum((A, Negative(Product((B, K)))))),
        ("A − (B + K)", Sum((A, Negative(Sum((B, K)))))),
        ("A + (B + K)", Sum((A, B, K))),
        ("-A B", Negative(Product((A, B)))),
        ("(-A)*B", Product((Negative(A), B))),
        ("A (B K)", Product((A, B, K))),
        ("A/B K", Product((Quotient(A, B), K))),
        ("A/(B K)", Quotient(A, Product((B, K)))),
        ("A.T P", Product((Transpose(A), P))),
        ("(A P)ᵀ", Transpose(Product((A, P)))),
        ("A^2 B**3", Product((Power(A, 2), Power(B, 3)))),
        ("A^1", A),
        ("A^-1", Power(A, -1)),
        ("A**(-1)", Power(A, -1)),
        ("x'", Derivative(x)),
        ("d/dt0 x.T", Derivative(Transpose(x), "t0")),
        ("P(t = T + 1)", At(P, "t", Scalar.symbol("T") + 1)),
        ("P(s) A", Product((P, A))),
        ("P (A)", Product((P, A))),
        ("det(A)", Apply("det", A)),
        ("chi_at(-A)", Apply("chi_at", Negative(A))),
        ("[A, B; K, 1]", Block(((A, B), (K, ONE)))),
        ("[x; K]'", Derivative(Block(((x,), (K,))))),
    ],
)
def test_a_text_is_read(text: str, formula: object) -> None:
    assert read_formula(text) == formula


@pytest.mark.parametrize(
    "text", ["", "A +", "A B)", "(A", "[A, B", "A^x", "A $ B", "A =", "= A", "d/dt", "P(t =", "2.5"]
)
def test_what_is_no_formula_is_refused(text: str) -> None:
    with pytest.raises(ValueError, match="is no formula"):
        read_formula(text)
    with pytest.raises(ValueError, match="is no formula"):
        read_relation(text)


def test_parts_have_the_shape_of_their_place() -> None:
    def last(text: str) -> object:
        return written_relation(text, PLANT).members[-1]

    assert last("A = 0") == Literal(Matrix.zeros(2, 2))
    assert last("c A = 0") == Literal(Matrix.zeros(1, 2))
    assert last("c.T !== 0") == Literal(Matrix.zeros(2, 1))
    assert last("b = 0") == last("det(A) = 0") == ZERO
    assert last("A = A + I") == Sum((Letter("A"), Identity(2)))
    assert last("c c.T = I") == Identity(1)
    assert last("b = det(s I - c c.T)") == Apply(
        "det",
        Sum((Product((Letter("s"), Identity(1))), Negative(Product((Letter("c"), Transpose(Letter("c"))))))),
    )
    assert written("pencil(A)", PLANT).formula == (PLANT["A"].pencil).formula


def test_slots_hold_values_terms_and_letters() -> None:
    assert written("{m} A", PLANT, m=2).formula == Product((TWO, A))
    assert written("{m} + b", PLANT, m=PLANT["A"] + PLANT["c"]).formula == Sum((A, Letter("c"), Letter("b")))
    assert written("P A", PLANT, P="P_l").formula == Product((Letter("P_l"), A))
    assert written_relation("A = #", PLANT).members == (A, Literal(PLANT.values["A"]))
    assert written("#A c.T", PLANT).formula == Product((Literal(PLANT.values["A"]), Transpose(Letter("c"))))
    with pytest.raises(KeyError, match="m"):
        written("{m} A", PLANT)


def test_a_text_without_open_parts_is_one_object() -> None:
    assert written_relation("A P = B", PLANT) is written_relation("A P = B", Environment())
    assert written_relation("z = P", Environment(variable="z")).members[0] == Letter("s")


def test_a_chain_is_one_relation() -> None:
    assert read_relation("A = B !== P >= 0") == Relation((A, B, P, ZERO), ("=", "!==", ">="))


def test_rows_are_stacked() -> None:
    assert read_formula(stacked("K", "A", 3)) == read_formula("[K; K A; K A^2]")
    assert read_formula(stacked("B", "A", 3, across=True)) == read_formula("[B, A B, A^2 B]")


def _further(inner: st.SearchStrategy[Formula]) -> st.SearchStrategy[Formula]:
    several = st.lists(inner, min_size=2, max_size=3)
    return st.one_of(
        several.map(lambda parts: Sum(tuple(term for part in parts for term in terms_of(part)))),
        several.map(lambda parts: Product(tuple(factor for part in parts for factor in factors_of(part)))),
        several.map(lambda parts: Block((tuple(parts), tuple(parts)))),
        st.builds(Quotient, inner, inner),
        st.builds(Power, inner, st.sampled_from([-2, -1, 2, 3])),
        st.builds(Derivative, inner, st.sampled_from(["t", "t0"])),
        st.builds(At, inner, st.just("t"), st.sampled_from([Scalar.of(0), Scalar.symbol("T") / 2 - 1])),
        st.builds(Apply, st.sampled_from(["det", "adj", "chi_at"]), inner),
        *(st.builds(kind, inner) for kind in (Negative, Transpose)),
    )


@given(st.recursive(st.sampled_from([A, B, x, Letter("x_hat"), TWO, Identity(0)]), _further, max_leaves=12))
def test_the_text_of_a_formula_reads_back(formula: Formula) -> None:
    """Whatever is inside whatever else: the parentheses that are printed are those that are needed."""
    assert read_formula(plain(formula, "s")) == formula


def test_every_text_in_the_program_is_a_formula() -> None:
    """Texts with parts that are put together when they are used are read where they are."""
    wrong, read = [], 0
    for path in (ROOT / "symobs").rglob("*.py"):
        for text in _texts_in(path):
            read += 1
            try:
                read_relation(text) if re.search(r"[=<>~]|!=", re.sub(r"\(\w+ = [^()]*\)", "", text)) else read_formula(
                    text
                )
            except ValueError as error:
                wrong.append(f"{path}: {error}")
    assert not wrong
    assert read > 10


def _texts_in(path: Path) -> list[str]:
    found = []
    for node in ast.walk(ast.parse(path.read_text("utf-8"))):
        if isinstance(node, ast.Subscript) and getattr(node.value, "id", "") == "page":
            parts = [node.slice]
        elif isinstance(node, ast.Call):
            name = getattr(node.func, "attr", getattr(node.func, "id", ""))
            if name == "holds":
                parts = node.args[1:2]
            elif name in {"written", "written_relation", "page"} or (name == "line" and node.args):
                parts = node.args[:1]
            elif (
                name in {"equal", "conclude_silently"}
                and getattr(getattr(node.func, "value", None), "id", "") == "page"
            ):
                parts = node.args
            else:
                continue
        else:
            continue
        found += [part.value for part in parts if isinstance(part, ast.Constant) and isinstance(part.value, str)]
    return found
