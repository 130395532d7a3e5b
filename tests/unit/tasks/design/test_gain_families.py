"""Several outputs and inputs: the spectrum, the family and its dimension, members found again, zeros, what is refused.

Judged by plain fractions and by SymPy; nothing here asks symobs whether symobs is right.
"""

from __future__ import annotations

import random
from fractions import Fraction
from pathlib import Path
from typing import Any

import pytest
import sympy
from sympy import Matrix, Rational

import symobs
from symobs.ground.errors import CertificateRejected, InputError
from tests.kit import tabled, tables, text_of
from tests.support.algebra import (
    characteristic,
)

pytestmark = pytest.mark.slow


s = sympy.Symbol("s")

TRIPLE = symobs.StateSpace("[0 1 0; 0 0 1; 1 2 3]", C="[1 0 0; 0 0 1]")
CHAINS = symobs.StateSpace("[0 1 0; 0 0 0; 0 0 0]", "[0 0; 1 0; 0 1]")


def wanted(listed: list[str]) -> list[Fraction]:
    """Multiply the poles out, in SymPy."""
    roots = [sympy.sympify(pole.replace("i", "*I")) for pole in listed]  # noqa: TID251 - texts of this file
    product = sympy.Poly(sympy.expand(sympy.prod(s - root for root in roots)), s)
    return [Fraction(int(c.p), int(c.q)) for c in product.all_coeffs()]


def fractions(matrix: Any) -> list[list[Fraction]]:
    return [[Fraction(int(x.p), int(x.q)) for x in matrix.row(i)] for i in range(matrix.rows)]


# -- the spectrum is exact ---------------------------------------------------------------------------------------------


# -- the family ----------------------------------------------------------------------------------------------------------

FAMILIES = tables(Path(__file__))["families"]


@pytest.mark.parametrize("name", FAMILIES)
def test_the_family_meets_the_claim_and_has_its_dimension(name: str) -> None:
    A, C, listed = FAMILIES[name]
    plant = symobs.StateSpace(A, C=C)
    found = symobs.observer(plant, poles=listed)
    L, names = found.family["L"], [sympy.Symbol(n) for n in found.family["parameters"]]
    n, p = L.shape
    phi, chance = wanted([pole.strip() for pole in listed.split(",")]), random.Random(name)  # noqa: S311
    for _ in range(3):
        point = {symbol: Rational(chance.randint(-30, 30), chance.randint(1, 9)) for symbol in names}
        member = L.subs(point)
        assert not member.has(sympy.zoo, sympy.nan)
        assert characteristic(fractions(plant.A - member * plant.C)) == phi
    assert found.family["dimension"] == len(names) == n * (p - 1)
    point = {symbol: Rational(k * k + 2, 3 * k + 4) for k, symbol in enumerate(names)}
    jacobian = Matrix([[entry.diff(symbol).subs(point) for symbol in names] for entry in L])
    assert jacobian.rank() == n * (p - 1)


def test_a_gain_outside_the_family_is_rejected() -> None:
    found = symobs.observer(TRIPLE, poles=[-1, -1, -1])
    other = symobs.observer(TRIPLE, L="[1 0; 3 0; -2 5]").answer["L"]
    assert found.with_answer("L", other).answer["L"] == other
    wrong = symobs.observer(TRIPLE, L="[1 0; 3 0; -2 6]").answer["L"]
    with pytest.raises(CertificateRejected):
        found.with_answer("L", wrong)


# -- zeros -----------------------------------------------------------------------------------------------------------------


@tabled
def test_what_is_no_entry_is_refused(zero: Any) -> None:
    with pytest.raises(InputError) as caught:
        symobs.observer(TRIPLE, poles=[-1, -1, -1], zero=zero)
    assert caught.value.where == "specification.zero"
    assert caught.value.repair


@tabled
def test_methods_for_one_output_say_so(name: str) -> None:
    with pytest.raises(InputError, match="needs one output"):
        symobs.observer(TRIPLE, poles=[-1, -1, -1], method=name)
    with pytest.raises(InputError, match="needs one input"):
        symobs.state_feedback(CHAINS, poles=[-1, -1, -1], method=name)


# -- members with a name ---------------------------------------------------------------------------------------------------


def orders_seen(A: Any, C: Any) -> list[int]:
    """Return the ranks of the observability matrices of the outputs one by one."""
    return [Matrix.vstack(*[C[i, :] * A**k for k in range(A.rows)]).rank() for i in range(C.rows)]


def test_decoupled_output_errors_obey_equations_of_their_own() -> None:
    A = [[0, 1, 0, 0], [3, -1, 2, 0], [0, 0, 0, 1], [1, 0, 4, 2]]
    plant = symobs.StateSpace(A, C=[[1, 0, 0, 0], [0, 0, 1, 0]])
    found = symobs.observer(plant, poles=[-1, -1, -2, -2], member="decoupled")
    assert sorted(orders_seen(plant.A - found.L * plant.C, plant.C)) == [2, 2]
    assert max(orders_seen(plant.A, plant.C)) > 2
    assert "decoupled" in found.to("text")
    other = symobs.observer(plant, poles=[-1, -1, -2, -2]).with_answer("L", found.answer["L"]).answer["L"]
    assert other == found.answer["L"]
    back = symobs.state_feedback(symobs.StateSpace(plant.A.T, plant.C.T), poles=[-1, -1, -2, -2], member="decoupled")
    assert back.K == found.L.T
    mixed = symobs.observer(plant, poles=[-1, -1, -2, -2], zero="[* 0; * 0; * 0; * 0]").answer["L"]
    with pytest.raises(CertificateRejected, match="add up"):
        found.with_answer("L", mixed)


def test_a_decoupled_gain_that_lies_in_no_chart_is_written() -> None:
    """A = 0 and C = I leave A − LC = −L: every output decays by itself, and the closed-loop matrix is not cyclic."""
    plant = symobs.StateSpace("[0 0; 0 0]", C="[1 0; 0 1]")
    found = symobs.observer(plant, poles=[-1, -1], member="decoupled")
    assert sympy.eye(2) == found.L
    words = text_of(found)
    assert "The output errors are decoupled, each satisfying an equation of its own, by the gain" in words
    back = symobs.state_feedback(symobs.StateSpace("[0 0; 0 0]", "[1 0; 0 1]"), poles=[-1, -1], member="decoupled")
    words = text_of(back)
    assert "The inputs are decoupled, each driving a separate subsystem, by the gain" in words


@tabled
@pytest.mark.parametrize("member", ["nearest", "smallest"])
def test_members_that_are_not_known_are_refused(member: str, arguments: dict[str, str]) -> None:
    asked = arguments if "L" in arguments else {"poles": [-1, -1, -1], **arguments}
    with pytest.raises(InputError, match=f"'{member}' is no member .*write one of simple, decoupled") as caught:
        symobs.observer(TRIPLE, member=member, **asked)
    assert caught.value.where == "specification.member"


def test_a_member_is_not_asked_for_together_with_zeros() -> None:
    with pytest.raises(InputError, match="both member and zero") as caught:
        symobs.observer(TRIPLE, poles=[-1, -1, -1], member="decoupled", zero="(1, 1)")
    assert caught.value.where == "specification.member"
