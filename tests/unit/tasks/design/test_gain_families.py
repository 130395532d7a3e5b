"""Several outputs and inputs: the spectrum, the family and its dimension, members found again, zeros, what is refused.

Judged by plain fractions and by SymPy; nothing here asks symobs whether symobs is right.
"""

from __future__ import annotations

import random
from contextlib import suppress
from fractions import Fraction
from itertools import pairwise, permutations
from math import prod
from typing import Any

import pytest
import sympy
from sympy import Matrix, Rational

import symobs
from symobs.exact import Scalar
from symobs.ground.errors import CertificateRejected, InputError
from symobs.tasks.design.pole_placement import decoupled
from symobs.tasks.design.pole_placement.brunovsky_chains import split_polynomial
from symobs.tasks.result import methods
from tests.kit import tabled
from tests.support.independent_algebra.plain import (
    characteristic,
    matrix_at,
    multiply,
    observability_rows,
    rank_of,
    subtract,
)
from tests.support.sampling import FULL

pytestmark = pytest.mark.slow

PLANTS = 500 if FULL else 30
SINGLE = 2_000 if FULL else 60

s = sympy.Symbol("s")

TRIPLE = symobs.StateSpace("[0 1 0; 0 0 1; 1 2 3]", C="[1 0 0; 0 0 1]")
CHAINS = symobs.StateSpace("[0 1 0; 0 0 0; 0 0 0]", "[0 0; 1 0; 0 1]")
MASSES = symobs.StateSpace(
    "[0 1 0 0; -k/m -d/m k/m d/m; 0 0 0 1; k/m d/m -k/m -d/m]",
    C="[1 0 0 0; 0 1 0 0]",
    symbols={"k": "positive", "d": "positive", "m": "positive"},
)


def integers(chance: random.Random, rows: int, columns: int, largest: int = 3) -> list[list[int]]:
    return [[chance.randint(-largest, largest) for _ in range(columns)] for _ in range(rows)]


def poles(chance: random.Random, order: int) -> list[str]:
    """Draw repeated, complex and distinct poles, as many as the order."""
    found: list[str] = []
    while len(found) < order:
        left = order - len(found)
        kind = chance.choice(["real", "again", "pair"])
        if kind == "pair" and left > 1:
            a, b = chance.randint(-4, 0), chance.randint(1, 3)
            found += [f"{a}+{b}i", f"{a}-{b}i"]
        elif kind == "again" and found and "i" not in found[-1]:
            found.append(found[-1])
        else:
            found.append(str(chance.randint(-5, 0)))
    return found


def wanted(listed: list[str]) -> list[Fraction]:
    """Multiply the poles out, in SymPy."""
    roots = [sympy.sympify(pole.replace("i", "*I")) for pole in listed]  # noqa: TID251 - texts of this file
    product = sympy.Poly(sympy.expand(sympy.prod(s - root for root in roots)), s)
    return [Fraction(int(c.p), int(c.q)) for c in product.all_coeffs()]


def turned(table: list[Any]) -> list[Any]:
    return [list(column) for column in zip(*table, strict=True)]


def fractions(matrix: Any) -> list[list[Fraction]]:
    return [[Fraction(int(x.p), int(x.q)) for x in matrix.row(i)] for i in range(matrix.rows)]


# -- the spectrum is exact ---------------------------------------------------------------------------------------------


@pytest.mark.parametrize("number", range(PLANTS))
def test_the_spectrum_is_exact_and_hidden_modes_are_told(number: int) -> None:
    chance = random.Random(f"several {number}")  # noqa: S311 - the same in every run
    order, outputs = chance.randint(1, 6), chance.randint(2, 3)
    A, C = integers(chance, order, order), integers(chance, outputs, order, 2)
    if order > 1 and chance.random() < 0.2:  # a state that no output shows
        for i, row in enumerate([*A, *C]):
            row[0] = row[0] if i == 0 else 0
    listed = poles(chance, order)
    phi = wanted(listed)
    plain_A, plain_C = ([[Fraction(x) for x in row] for row in table] for table in (A, C))
    rank = rank_of(observability_rows(plain_A, plain_C))
    for method in ("auto", "row_reduced_echelon"):
        found = symobs.observer(symobs.StateSpace(A, None, C), poles=listed, method=method)
        back = symobs.state_feedback(symobs.StateSpace(turned(A), turned(C)), poles=listed, method=method)
        assert found.verdict == back.verdict
        assert (found.verdict == "yes") or rank < order
        if found.verdict == "no":
            assert found.fixed_modes
            continue
        assert found.L.T == back.K
        assert characteristic(subtract(plain_A, multiply(fractions(found.L), plain_C))) == phi
        family = found.fields["family"]
        assert len(family["parameters"]) == rank * (outputs - 1) + (order - rank) * outputs
        if family["L"] is not None and order < 5:
            point = {name: Fraction(chance.randint(-9, 9)) for name in family["parameters"]}
            with suppress(ZeroDivisionError):  # X is singular there
                member = matrix_at(family["L"], point)
                assert characteristic(subtract(plain_A, multiply(member, plain_C))) == phi


def test_a_triple_pole_that_numeric_placement_refuses() -> None:
    signal = pytest.importorskip("scipy.signal")
    numpy = pytest.importorskip("numpy")
    A, C = (numpy.array(part.tolist(), dtype=float) for part in (TRIPLE.A, TRIPLE.C))
    with pytest.raises(ValueError, match="more than rank"):
        signal.place_poles(A.T, C.T, [-1.0, -1.0, -1.0])
    for method in ("sylvester", "row_reduced_echelon"):
        L = symobs.observer(TRIPLE, poles=[-1, -1, -1], method=method).L
        assert sympy.expand((s * sympy.eye(3) - TRIPLE.A + L * TRIPLE.C).det() - (s + 1) ** 3) == 0


# -- the family ----------------------------------------------------------------------------------------------------------

FAMILIES = {
    "two of three": (TRIPLE, "-1, -1, -1"),
    "irreducible": (TRIPLE, "-1+1i, -1-1i, -2"),
    "spectra meet": (symobs.StateSpace("[0 1; 0 0]", C="[1 0; 0 1]"), "0, 0"),
    "not cyclic": (symobs.StateSpace("[1 0 0; 0 1 0; 0 0 2]", C="[1 0 1; 0 1 1]"), "-1, 1, 2"),
    "outputs depend": (symobs.StateSpace("[0 1; 2 3]", C="[1 0; 2 0]"), "-1, -2"),
    "three outputs": (symobs.StateSpace("[1 2 0; 0 1 1; 3 0 1]", C="[1 0 0; 0 1 0; 1 1 1]"), "-1, -2, -3"),
}
families = pytest.mark.parametrize("name", FAMILIES)


@families
def test_the_family_meets_the_claim_and_has_its_dimension(name: str) -> None:
    plant, listed = FAMILIES[name]
    found = symobs.observer(plant, poles=listed)
    L, names = found.family["L"], [sympy.Symbol(n) for n in found.family["parameters"]]
    n, p = L.shape
    phi, chance = wanted([pole.strip() for pole in listed.split(",")]), random.Random(name)  # noqa: S311
    for _ in range(8):
        point = {symbol: Rational(chance.randint(-30, 30), chance.randint(1, 9)) for symbol in names}
        member = L.subs(point)
        assert not member.has(sympy.zoo, sympy.nan)
        assert characteristic(fractions(plant.A - member * plant.C)) == phi
    assert found.family["dimension"] == len(names) == n * (p - 1)
    point = {symbol: Rational(k * k + 2, 3 * k + 4) for k, symbol in enumerate(names)}
    jacobian = Matrix([[entry.diff(symbol).subs(point) for symbol in names] for entry in L])
    assert jacobian.rank() == n * (p - 1)


@families
def test_sylvesters_equation_is_what_the_family_says(name: str) -> None:
    plant, listed = FAMILIES[name]
    family = symobs.observer(plant, poles=listed).family
    F, G, X, L, shift = (family[key] for key in ("F", "G", "X", "L", "shift"))
    shift = sympy.zeros(*L.shape) if shift is None else shift
    A, chance = plant.A - shift * plant.C, random.Random(name)  # noqa: S311 - the same in every run
    assert (A.T * X - X * F - plant.C.T * G).applyfunc(sympy.expand).is_zero_matrix
    for _ in range(5):
        point = {symbol: Rational(chance.randint(-30, 30), chance.randint(1, 9)) for symbol in G.free_symbols}
        assert ((L - shift).subs(point).T * X.subs(point) - G.subs(point)).is_zero_matrix
    together = sympy.gcd(A.charpoly(s).as_expr(), F.charpoly(s).as_expr())
    assert not together.has(s)


@pytest.mark.parametrize("name", ["two of three", "irreducible", "three outputs", "not cyclic"])
def test_random_cyclic_members_are_found_again(name: str) -> None:
    """With G = LᵀX and X⁻¹ = [r; rM; …], r the row of Lᵀ that is held and M = (A − LC)ᵀ."""
    plant, listed = FAMILIES[name]
    family = symobs.observer(plant, poles=listed).family
    F, G, L = (family[key] for key in ("F", "G", "L"))
    shift = sympy.zeros(*L.shape) if family["shift"] is None else family["shift"]
    A, order = plant.A - shift * plant.C, plant.A.rows
    chance, again = random.Random(name), 0  # noqa: S311 - the same in every run
    for _ in range(6):
        free = Matrix(integers(chance, plant.C.rows, order, 5))
        unknown = Matrix(order, order, sympy.symbols(f"x:{order * order}"))
        solved = sympy.solve(list(A.T * unknown - unknown * F - plant.C.T * free), list(unknown), dict=True)[0]
        X = unknown.subs(solved)
        if X.det() == 0:
            continue
        member = shift + (free * X.inv()).T
        weights = Matrix([[int(G.row(i) == Matrix([[1] + [0] * (order - 1)])) for i in range(G.rows)]])
        rows, M = [weights * (member - shift).T], (plant.A - member * plant.C).T
        for _ in range(order - 1):
            rows.append(rows[-1] * M)
        W = Matrix.vstack(*rows)
        if sum(weights) != 1 or W.det() == 0:
            continue
        found = (member - shift).T * W.inv()
        values = {G[i, j]: found[i, j] for i in range(G.rows) for j in range(order) if G[i, j].is_Symbol}
        assert L.subs(values) == member
        again += 1
    assert again >= 4


def test_the_parametric_family_at_points() -> None:
    found = symobs.observer(MASSES, poles=[-1, -1, -2, -2])
    assert {str(condition) for condition in found.conditions} == set()
    for values in ((2, 3, 1), (1, Rational(1, 2), 4)):
        point = dict(zip(sympy.symbols("k d m"), values, strict=True))
        A, L = MASSES.A.subs(point), found.L.subs(point)
        assert sympy.expand((s * sympy.eye(4) - A + L * MASSES.C).det() - (s + 1) ** 2 * (s + 2) ** 2) == 0
        free = {sympy.Symbol(name): k + 2 for k, name in enumerate(found.family["parameters"])}
        member = found.family["L"].subs(point | free)
        assert sympy.expand((s * sympy.eye(4) - A + member * MASSES.C).det() - (s + 1) ** 2 * (s + 2) ** 2) == 0


def test_hidden_modes_stay_and_the_others_are_assigned() -> None:
    plant = symobs.StateSpace("[-1 0 0; 0 1 2; 0 0 3]", C="[0 1 0; 0 0 1]")
    found = symobs.observer(plant, poles=[-1, -2, -3])
    assert (found.verdict, found.fixed_modes) == ("yes", (-1,))
    names = [sympy.Symbol(n) for n in found.family["parameters"]]
    assert found.family["dimension"] == len(names) == 2 * 1 + 1 * 2
    L = found.family["L"]
    member = L.subs({name: 3 * k + 1 for k, name in enumerate(names)})
    assert sympy.expand((s * sympy.eye(3) - plant.A + member * plant.C).det() - (s + 1) * (s + 2) * (s + 3)) == 0
    jacobian = Matrix([[entry.diff(x).subs({y: k + 2 for k, y in enumerate(names)}) for x in names] for entry in L])
    assert jacobian.rank() == 4
    denied = symobs.observer(plant, poles=[-4, -2, -3])
    assert (denied.verdict, denied.L, denied.fixed_modes) == ("no", None, (-1,))


def test_a_gain_outside_the_family_is_rejected() -> None:
    found = symobs.observer(TRIPLE, poles=[-1, -1, -1])
    other = symobs.observer(TRIPLE, L="[1 0; 3 0; -2 5]").answer["L"]
    assert found.with_answer("L", other).answer["L"] == other
    wrong = symobs.observer(TRIPLE, L="[1 0; 3 0; -2 6]").answer["L"]
    with pytest.raises(CertificateRejected):
        found.with_answer("L", wrong)


# -- zeros -----------------------------------------------------------------------------------------------------------------


@tabled
def test_zeros_are_met_where_they_can_be_and_refused_where_they_cannot(pattern: str) -> None:
    signs = [row.split() for row in pattern.strip("[]").split(";")]
    unknown = Matrix(3, 2, lambda i, j: sympy.Symbol(f"l{i}{j}") if signs[i][j] == "*" else 0)
    error = (s * sympy.eye(3) - TRIPLE.A + unknown * TRIPLE.C).det() - (s + 1) ** 3
    basis = sympy.groebner(sympy.Poly(sympy.expand(error), s).coeffs(), *unknown.free_symbols)
    found = symobs.observer(TRIPLE, poles=[-1, -1, -1], zero=pattern)
    if basis.exprs == [1]:
        assert (found.verdict, found.L) == ("no", None)
        assert any("ideal" in certificate.claim for certificate in found.certificates)
        assert "no common solution" in " ".join(found.to("text").split())
        return
    assert found.verdict == "yes"
    assert all(found.L[i, j] == 0 for i in range(3) for j in range(2) if signs[i][j] == "0")
    assert sympy.expand((s * sympy.eye(3) - TRIPLE.A + found.L * TRIPLE.C).det() - (s + 1) ** 3) == 0
    moved = [list(row) for row in found.answer["L"].rows]
    place = next((i, j) for i in range(3) for j in range(2) if signs[i][j] == "0")
    moved[place[0]][place[1]] = moved[place[0]][place[1]] + 1
    with pytest.raises(CertificateRejected):
        found.with_answer("L", type(found.answer["L"]).of(moved))


def test_zeros_of_a_feedback_decouple_two_chains() -> None:
    found = symobs.state_feedback(CHAINS, poles=[-2, -2, -2], zero="(1, 3), (2, 1), (2, 2)")
    assert Matrix([[4, 4, 0], [0, 0, 2]]) == found.K
    assert symobs.state_feedback(CHAINS, poles=[-2, -2, -2], zero=[[1, 3], [2, 1], [2, 2]]).K == found.K
    assert symobs.state_feedback(CHAINS, poles=[-2, -2, -2], zero="[0 * *; 0 * *]").verdict == "no"


@tabled
def test_what_is_no_entry_is_refused(zero: Any) -> None:
    with pytest.raises(InputError) as caught:
        symobs.observer(TRIPLE, poles=[-1, -1, -1], zero=zero)
    assert caught.value.where == "specification.zero"
    assert caught.value.repair


@pytest.mark.parametrize("name", ["ackermann", "canonical_form", "coefficient_matching", "companion_form"])
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
    words = " ".join(str(found.to("text")).split())
    assert "The output errors are decoupled, each satisfying an equation of its own, by the gain" in words
    back = symobs.state_feedback(symobs.StateSpace("[0 0; 0 0]", "[1 0; 0 1]"), poles=[-1, -1], member="decoupled")
    words = " ".join(str(back.to("text")).split())
    assert "The inputs are decoupled, each driving a separate subsystem, by the gain" in words


@pytest.mark.parametrize("arguments", [{}, {"zero": "(1, 1)"}, {"L": "[1 2; 3 4]"}])
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


# -- one output: every road leads to the same gain ------------------------------------------------------------------------


@pytest.mark.parametrize("block", range(0, SINGLE, 20))
def test_all_methods_agree_for_one_output(block: int) -> None:
    for number in range(block, block + 20):
        chance = random.Random(f"single {number}")  # noqa: S311 - the same in every run
        parameters = chance.randint(0, 3)
        order = chance.randint(1, 3 if parameters else 5)
        A = [[str(x) for x in row] for row in integers(chance, order, order)]
        C = [[str(x) for x in row] for row in integers(chance, 1, order)]
        for name in "abc"[:parameters]:
            target = chance.choice([*A, *C])
            target[chance.randrange(order)] = chance.choice([name, f"{name} + 1", f"2*{name}", f"-{name}"])
        symbols = dict.fromkeys("abc"[:parameters], "real")
        listed = poles(chance, order)
        plant = symobs.StateSpace(A, None, C, symbols=symbols)
        dual = symobs.StateSpace(turned(A), turned(C), symbols=symbols)
        gains, verdicts = set(), set()
        for method in sorted(m.name for m in methods("observer").values()):
            found = symobs.observer(plant, poles=listed, method=method)
            gain = found.answer["L"]
            verdicts.add(found.verdict)
            gains.add(str(gain))
            if f"state_feedback/{method}" in methods("state_feedback"):
                back = symobs.state_feedback(dual, poles=listed, method=method)
                assert back.answer["K"] == (None if gain is None else gain.T)
                verdicts.add(back.verdict)
        assert len(gains) == len(verdicts) == 1, (A, C, listed)


# -- sharing the factors of a polynomial -------------------------------------------------------------------------------


@pytest.mark.parametrize("roots", ["aabbcc", "abcabc", "aaaaaa", "abcdef"])
@pytest.mark.parametrize("lengths", [(6,), (4, 2), (2, 2, 2), (3, 1, 2)])
def test_factors_are_shared_in_every_way_once(roots: str, lengths: tuple[int, ...]) -> None:
    """Found by all orders of the factors, cut at the lengths."""
    s = Scalar.symbol("s")
    factors = [s + ord(root) for root in roots]
    ends = [sum(lengths[:k]) for k in range(len(lengths) + 1)]
    wanted = {tuple("".join(sorted(order[low:high])) for low, high in pairwise(ends)) for order in permutations(roots)}
    polynomials = {
        part: prod((s + ord(root) for root in part), start=Scalar.of(1)).coefficients("s")[1:]
        for ways in wanted
        for part in ways
    }
    found = [tuple(map(tuple, share)) for share in split_polynomial(factors, lengths, "s")]
    assert len(set(found)) == len(found) or roots == "abcabc"  # equal factors that do not stand together
    assert set(found) == {tuple(polynomials[part] for part in ways) for ways in wanted}
    assert all(not coefficient.field.names for share in found for part in share for coefficient in part)


def test_the_same_chains_are_not_shared_out_again(monkeypatch: pytest.MonkeyPatch) -> None:
    """Two double integrators: two orders of the outputs, the same chains, and three ways to share -1, -1, -2, -2."""
    tried: list[object] = []
    own_rows = decoupled._own_rows

    def noted(pair: Any, gain: Any) -> Any:
        tried.append(gain)
        return own_rows(pair, gain)

    monkeypatch.setattr(decoupled, "_own_rows", noted)
    plant = symobs.StateSpace("[0 1 0 0; 0 0 0 0; 0 0 0 1; 0 0 0 0]", None, "[1 0 0 0; 0 0 1 0]")
    symobs.observer(plant, poles=[-1, -1, -2, -2], member="decoupled")
    *looked_at, claimed = tried
    assert len(looked_at) == len(set(looked_at)) == 3
    assert claimed in looked_at
