"""Single modes, duality, decomposition: identities that hold for every plant, and another system's opinion (PARI)."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
import sympy
from hypothesis import given, settings

import symobs
from symobs.exact import Scalar, stable_roots
from symobs.ground.errors import InputError
from symobs.stability.criteria.stability import is_beyond, is_marginal, on_boundary
from symobs.tasks.analysis.modes import modes
from tests.kit import scalar, tabled, tables
from tests.support.problems.strategies import Sample, plants
from tests.support.sampling import tried

numeric = plants(("dense", "hidden", "defective"))
s = sympy.Symbol("s")


def plant_of(sample: Sample) -> Any:
    return symobs.StateSpace(sample.A, sample.B, sample.C)


# -- identities ----------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("missing", ["input", "output"])
@given(numeric)
@settings(max_examples=tried(100))
def test_without_input_or_output_there_are_two_parts(missing: str, sample: Sample) -> None:
    """As many states are reached (seen) as the rank of the test matrix says, and none of the others drives (shows) them."""
    plant = plant_of(sample)
    order, A, B, C = sample.order, plant.A, plant.B, plant.C
    if missing == "output":
        found: Any = symobs.decomposition(symobs.StateSpace(sample.A, sample.B))
        test, names = sympy.Matrix.hstack(*(A**k * B for k in range(order))), ["c", "no c"]
    else:
        found = symobs.decomposition(symobs.StateSpace(sample.A, None, sample.C))
        test, names = sympy.Matrix.vstack(*(C * A**k for k in range(order))), ["o", "no o"]
    first = test.rank()
    assert dict(found.sizes) == dict(zip(names, [first, order - first], strict=True))
    assert "transfer_function" not in found.fields
    assert found.T * A == found.A * found.T
    assert found.T.rank() == order
    if missing == "output":
        assert found.B == found.T * B
        assert found.A[first:, :first].is_zero_matrix is not False
        assert found.B[first:, :].is_zero_matrix is not False
    else:
        assert C == found.C * found.T
        assert found.A[:first, first:].is_zero_matrix is not False
        assert found.C[:, first:].is_zero_matrix is not False


def test_a_decomposition_without_output_has_its_cases_and_its_sentences() -> None:
    found = symobs.decomposition(symobs.StateSpace("[0 1; -2 -3]", "[1; b]"))
    assert {str(case.when[0]): case.result.sizes["no c"] for case in found.cases} == {
        "Eq(b + 1, 0)": 1,
        "Eq(b + 2, 0)": 1,
    }
    text = found.to("text")
    assert "controllable; uncontrollable" in text
    assert "observable" not in text
    with pytest.raises(InputError, match="B"):
        symobs.decomposition(symobs.StateSpace("[0 1; -2 -3]"))


@given(plants(("dense", "hidden", "defective", "parametric"), largest=4))
@settings(max_examples=tried(30))
def test_the_modal_form_is_similar_and_block_diagonal(sample: Sample) -> None:
    plant = plant_of(sample)
    found: Any = symobs.canonical_form(plant, kind="modal")
    T = found.T
    assert all(sympy.cancel(entry) == 0 for entry in found.A * T - T * plant.A)
    assert sympy.cancel(T.det()) != 0
    largest = max(map(len, found.A.connected_components()))
    factors = sympy.factor_list(plant.A.charpoly(s).as_expr(), s)[1]
    assert largest <= max(sympy.degree(factor, s) * power for factor, power in factors if factor.has(s))


# -- eigenvalues of every kind -------------------------------------------------------------------------------------------

CUBIC = "[0 1 0 0; 0 0 1 0; 1 1 0 0; 0 0 0 -1]"


def test_eigenvalues_without_closed_form_are_named_and_told_apart() -> None:
    """x³ − x − 1 has one positive root and two of negative real part −0.66."""
    modes = symobs.pbh(symobs.StateSpace(CUBIC, None, "[0 0 0 1]")).fields["modes"]
    assert [str(mode["eigenvalue"]) for mode in modes] == ["-1", *(f"CRootOf(s**3 - s - 1, {k})" for k in range(3))]
    assert [mode["stable"] for mode in modes] == [True, False, True, True]
    assert [(mode["rank"], mode["observable"]) for mode in modes] == [(4, True), *[(3, False)] * 3]
    assert str(modes[1]["matrix"][0][0]) == "-CRootOf(s**3 - s - 1, 0)"


@tabled
def test_each_eigenvalue_is_stable_or_not(A: str, dt: int, stable: dict[str, bool]) -> None:
    modes = symobs.pbh(symobs.StateSpace(A, None, "[1 0]", dt=dt)).fields["modes"]
    assert {str(mode["eigenvalue"]): mode["stable"] for mode in modes} == stable


# -- detectability -------------------------------------------------------------------------------------------------------


@tabled
def test_detectable_or_not(A: str, C: str, meaning: str, verdict: str) -> None:
    result = symobs.detectability(symobs.StateSpace(A, None, C), meaning=meaning)
    assert result.verdict == verdict
    dual = symobs.StateSpace(symobs.StateSpace(A).A.T, symobs.StateSpace(A, None, C).C.T)
    assert symobs.stabilizability(dual, meaning=meaning).verdict == verdict
    assert result.derivation.check() is not None


def test_conditions_of_detectability() -> None:
    at = symobs.StateSpace("[a 0; 0 1]", None, "[0 1]")
    assert list(map(str, symobs.detectability(at).holds_where)) == ["-a > 0"]
    assert list(map(str, symobs.detectability(at, meaning="lyapunov").holds_where)) == ["-a >= 0"]
    lost = symobs.detectability(symobs.StateSpace("[0 1; 2 1]", None, "[1 c]"))
    assert [str(c) for c in lost.holds_where] == ["2*c + 1 != 0"]


x = Scalar.symbol("s")


@tabled
def test_what_lies_on_the_boundary_and_beyond(
    polynomial: str,
    discrete: bool,  # noqa: FBT001
    boundary: bool | str,  # noqa: FBT001
    marginal: bool,  # noqa: FBT001
    beyond: bool,  # noqa: FBT001
) -> None:
    if boundary != "open":
        assert on_boundary(scalar(polynomial), "s", {}, discrete=discrete) == boundary
    assert is_marginal(scalar(polynomial), "s", {}, discrete=discrete) == marginal
    assert is_beyond(scalar(polynomial), "s", {}, discrete=discrete) == beyond


# -- nothing false gets through ------------------------------------------------------------------------------------------


@tabled
def test_pages_of_plants_that_are_never_controllable_or_observable(A: str, rest: str) -> None:
    """What the input never moves has a letter of its own in the rank test, and the page speaks of both."""
    result = symobs.stabilizability(symobs.StateSpace(A, rest))
    assert result.derivation.check().defines("N")
    dual = symobs.detectability(symobs.StateSpace(A, None, rest.replace(";", "")))
    assert dual.derivation.check().defines("N")
    assert dual.verdict == result.verdict


# -- which root is stable ---------------------------------------------------------------------------------------------

#: Irreducible, lowest coefficient first, with roots on both sides of the axis or on it; the last two are self-reciprocal.
MIXED = tables(Path(__file__))["mixed"]


@pytest.mark.parametrize("coefficients", MIXED)
@pytest.mark.parametrize("discrete", [False, True])
def test_roots_are_told_apart_in_the_order_of_sympy(coefficients: tuple[int, ...], *, discrete: bool) -> None:
    x = sympy.Symbol("s")
    polynomial = sympy.Poly(coefficients[::-1], x)
    assert polynomial.is_irreducible
    wanted = []
    for k in range(polynomial.degree()):
        value = sympy.CRootOf(polynomial, k).evalf(12)
        wanted.append(bool((abs(value) - 1 if discrete else sympy.re(value)) < -1e-9))
    factor = sum((Scalar.symbol("s") ** k * c for k, c in enumerate(coefficients)), Scalar.of(0))
    assert stable_roots(factor, "s", discrete=discrete) == tuple(wanted)


def test_roots_are_told_apart_without_sympy_s_own_refinement(monkeypatch: pytest.MonkeyPatch) -> None:
    """SymPy isolates them quickly and takes seconds to enclose them."""
    monkeypatch.delattr(sympy.CRootOf, "eval_rational")
    s = Scalar.symbol("s")
    assert stable_roots(s**4 - 12 * s**3 + 106 * s**2 - 36 * s + 3606, "s", discrete=False) == (
        True,
        True,
        False,
        False,
    )


def test_a_root_beside_the_boundary_is_told_from_one_on_it() -> None:
    """Parts of 10⁻⁴⁰ decide."""
    s = Scalar.symbol("s")
    assert stable_roots(10**40 * (s**2 + 1) + s, "s", discrete=False) == (True, True)
    assert stable_roots(10**40 * (s**2 + 1) - s, "s", discrete=False) == (False, False)
    assert stable_roots(s**2 + 1, "s", discrete=False) == (False, False)
    assert stable_roots(10**40 * s**2 + s + 10**40 - 1, "s", discrete=True) == (True, True)
    assert stable_roots(10**40 * s**2 + s + 10**40, "s", discrete=True) == (False, False)


def test_a_mode_that_grows_on_strata_that_are_not_known_is_undecided(monkeypatch: pytest.MonkeyPatch) -> None:
    """x₁ grows like k t, but not at k = 0: where it is not known that this is the only exception, no is not said."""
    plant, asked = ("[0 k; 0 0]", None, "[0 0]"), {"meaning": "lyapunov"}
    assert symobs.detectability(symobs.StateSpace(*plant), **asked).verdict == "conditional"
    monkeypatch.setattr(modes, "constancy", lambda *_: None)
    found = symobs.detectability(symobs.StateSpace(*plant), **asked)
    assert found.verdict == "undecided"
    assert "is not detectable" not in found.to("text")


@given(plants(("dense", "hidden", "defective", "parametric"), largest=3))
@settings(max_examples=tried(50))
def test_a_plant_in_other_coordinates_is_a_plant(sample: Sample) -> None:
    """C (sI − A)⁻¹ B is the same in all coordinates, transposed for the dual; what the coordinates need is kept."""
    plant = plant_of(sample)
    own = symobs.transfer_function(plant).transfer_function
    for found in (symobs.decomposition(plant), symobs.canonical_form(plant, kind="modal"), symobs.dual(plant)):
        there = symobs.transfer_function(found)
        assert sympy.cancel(there.transfer_function - own) == 0
        if found.task != "dual":
            assert set(found.conditions) <= set(there.conditions)
    twice = plant * symobs.dual(plant)
    assert sympy.cancel(symobs.transfer_function(twice).transfer_function - own**2) == 0


def test_what_is_no_plant_in_any_coordinates_is_refused() -> None:
    hidden = symobs.StateSpace("[-1 0; 0 -2]", "[1; 0]", "[1 1]")
    with pytest.raises(InputError, match="no controllable canonical form"):
        symobs.observability(symobs.canonical_form(hidden, kind="controllable"))
    with pytest.raises(InputError, match="a plant is expected"):
        symobs.observability(symobs.pbh(hidden))  # type: ignore[arg-type]


def test_a_design_in_canonical_form_says_where_that_is() -> None:
    """For C = [1 c] the observable form is there unless (c − 1)(2c − 1) = 0, and L is φ less χ: no letter is left in it."""
    found = symobs.canonical_form(symobs.StateSpace("[0 1; -2 -3]", "[0; 1]", "[1 c]"), kind="observable")
    design = symobs.observer(found, poles=[-5, -6])
    assert list(design.L) == [28, 8]
    assert {str(condition) for condition in design.conditions} == {"Ne(2*c - 1, 0)", "Ne(c - 1, 0)"}
    assert "c ≠ 1/2" in design.to("text")
    lag, there = symobs.StateSpace([[-1]], [[1]], [[1]]), found.as_plant
    assert there is not None
    for plant in (there * lag, lag * there, there + lag, lag - there, -there, 2 * there, there**2, there.feedback(lag)):
        assert plant.nonzero == there.nonzero


def test_each_eigenvalue_of_two_masses_has_a_condition_of_its_own() -> None:
    """In phase (λ = 0) the masses are seen where a + b ≠ 0, in antiphase (λ² = −2k) where a ≠ b."""
    A = "[0 1 0 0; -k 0 k 0; 0 0 0 1; k 0 -k 0]"
    plant = symobs.StateSpace(A, C="[a 0 b 0]", symbols={"k": "positive", "a": "real", "b": "real"})
    page = str(symobs.pbh(plant).to("text"))
    for said in ("Case λ = 0, a ≠ -b.", "Case λ² + 2k = 0, a ≠ b.", "for a ≠ -b, a ≠ b; the remaining cases"):
        assert said in page
    assert "det 𝒪" not in page
