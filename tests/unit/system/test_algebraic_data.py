"""Roots of numbers as data: what is read, what is refused and why, verdicts, conditions and lies."""

from __future__ import annotations

import random
from typing import Any

import pytest
import sympy

import symobs as so
from symobs.exact import Matrix, Scalar
from symobs.exact.core.generators import square_root
from symobs.formula.tree import Environment
from symobs.formula.tree.term import letter
from symobs.problem import read
from symobs.proof.certificate.claims import verify
from symobs.proof.derivation.builder import relation
from tests.kit import tabled

k = sympy.Symbol("k", real=True)


def _observability(C: str) -> Any:
    return so.observability(so.StateSpace("[0 1; 2 0]", C=C))


@tabled
def test_a_hidden_zero_decides_the_verdict(C: str, verdict: str) -> None:
    """With eigenvalues ±√2 the row [c 1] misses a mode if and only if c² = 2."""
    assert _observability(C).verdict == verdict


def test_conditions_are_exact() -> None:
    """det 𝒪 = k² − 2 for C = [k 1]; beside √2 in the data it has two factors, and one of them is positive for k > 0."""
    plant = so.StateSpace("[0 1; 2 0]", C="[k 1]", symbols={"k": "positive"})
    (condition,) = so.observability(plant).conditions
    assert condition == sympy.Ne(condition.lhs, 0, evaluate=False)
    assert condition.lhs == sympy.Symbol("k") ** 2 - 2
    beside = so.StateSpace("[0 1; 2 0]", C="[sqrt(2)*k 2]", symbols={"k": "positive"})
    found = so.observability(beside)
    assert found.verdict == "conditional"
    assert [case.result.verdict for case in found.cases] == ["no"]


@tabled
def test_what_is_no_number_is_refused(entry: str, reason: str) -> None:
    with pytest.raises(so.InputError, match=reason):
        so.StateSpace(f"[0 1; {entry} -1]", C="[1 0]")


@tabled
def test_numbers_that_have_a_root(text: str, same: str) -> None:
    assert so.StateSpace(f"[{text}]").A == so.StateSpace(f"[{same}]").A


def test_regions_are_refused_beside_roots() -> None:
    with pytest.raises(so.InputError, match=r"the data contain sqrt\(2\)"):
        so.stability_region("s^2 + sqrt(2) h s + 1")


def test_a_false_equation_is_seen_at_points() -> None:
    """Claims too long to be checked exactly are checked modulo primes; one wrong sign of one root is seen there."""
    dice, root = random.Random(1), square_root(Scalar.of(2))  # noqa: S311 - repeatable
    names = [Scalar.symbol(name) for name in "abcdefgh"]

    def entry() -> Scalar:
        return sum((dice.randint(-9, 9) * name + root * dice.randint(1, 9) for name in names), Scalar.of(0))

    A, B = (Matrix.of([[entry() for _ in range(3)] for _ in range(3)]) for _ in range(2))
    right = A @ B
    wrong = right.substitute({root.field.names[0]: -root})
    for product, how in ((right, "random point"), (wrong, "")):
        environment = Environment(values={"A": A, "B": B, "P": product})
        a, b, p = (letter(name, environment) for name in "ABP")
        method, bound = verify(relation(a @ b, p), environment)
        assert how in method if how else method == ""
        assert bound < 2**-50


_FILE = """
task = "observer"
[symbols]
k = "positive"
[constants]
{constants}
[plant]
A = "[0 1; r*k -1]"
C = "[1 h]"
[specification]
poles = "-2 + 2 r i, -2 - 2 r i"
"""


@tabled
def test_a_wrong_constant_is_told_at_its_place(constants: str, reason: str) -> None:
    with pytest.raises(so.ProblemErrors, match=rf"constants\..*{reason}"):
        read(_FILE.format(constants=constants))
