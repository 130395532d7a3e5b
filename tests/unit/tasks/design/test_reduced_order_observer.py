"""The reduced-order observer: printed values, the equations it must satisfy in plain SymPy, what is refused, its page."""

from __future__ import annotations

import pickle

import pytest
from sympy import Matrix

import symobs
from symobs import StateSpace
from symobs.exact import Ideal, Scalar
from symobs.exact import Matrix as Exact
from symobs.ground.errors import CertificateRejected, InputError
from symobs.pages.formats.json import result_object
from symobs.tasks.design.reduced_order.reduced_order_observer import completed
from tests.kit import tabled, text_of

THIRD_ORDER = StateSpace("[-7 1 15; -2 0 5; -2 0 4]", "[65; -5; 30]", "[1 0 -2]")


def test_discrete_time_with_feedthrough() -> None:
    plant = StateSpace("[1 1; 0 1]", "[0; 1]", "[1 0]", "[3]", dt=True)
    found = symobs.reduced_order_observer(plant, poles=[0])
    assert (Matrix([1]), Matrix([0]), Matrix([-1]), Matrix([4])) == (found.L, found.F, found.H, found.G)
    text = found.to("text")
    assert "wₖ₊₁" in text
    assert "contains the output one step ahead" in text


@tabled
def test_what_does_not_fit_is_refused(arguments: dict[str, str], where: str) -> None:
    with pytest.raises(InputError) as caught:
        symobs.reduced_order_observer(THIRD_ORDER, **arguments)
    assert caught.value.where == where
    assert caught.value.repair


@tabled
def test_nothing_left_to_estimate(A: str, C: str, poles: list[int], said: str) -> None:
    with pytest.raises(InputError, match=said):
        symobs.reduced_order_observer(StateSpace(A, C=C), poles=poles)


DEPENDENT = StateSpace(
    "[0 a-1 0; 0 a-1 -1; a*b 1 1]", "[1; 0; -1]", "[0 0 b; 0 b b+1]", symbols={"a": "real", "b": "real"}
)


def test_where_outputs_depend_on_each_other_there_is_no_observer_of_that_order() -> None:
    """Rank C is 1 for b = 0 and 2 elsewhere; with any one row P the three rows of [C; P] depend on each other."""
    found = symobs.reduced_order_observer(DEPENDENT, poles=[-4])
    (case,) = (case for case in found.case_tree if [str(c) for c in case.when] == ["b == 0"])
    assert case.result is not None
    there = result_object(case.result)
    assert there["verdict"] == "no"
    assert [there[name] for name in "LTFGHM"] == [None] * 6
    assert there["cases"] == []
    w = case.result.answer["w"]
    assert not w.is_zero
    assert (w @ case.result.plant.matrices.C).is_zero
    assert "one output is a linear combination of the others" in text_of(case.result)
    assert pickle.loads(pickle.dumps(case.result)) == case.result  # noqa: S301 - our own


def test_a_row_that_shows_nothing_is_no_proof_that_outputs_depend_on_each_other() -> None:
    found = symobs.reduced_order_observer(DEPENDENT, poles=[-4])
    (there,) = (case.result for case in found.case_tree if [str(c) for c in case.when] == ["b == 0"])
    assert there is not None
    row = type(there.answer["w"]).of
    for wrong in (row([[0, 0]]), row([[0, 1]])):
        with pytest.raises(CertificateRejected, match=r"the claim w !== 0|the claim w\*C = 0"):
            there.with_answer("w", wrong)
    with pytest.raises(CertificateRejected, match="outputs that depend on each other leave no observer of order n - p"):
        there.with_answer("M", row([[0, 0], [1, 0], [0, 1]]))


def test_a_compensator_of_minimal_order_needs_independent_outputs() -> None:
    found = symobs.compensator(DEPENDENT, control_poles=[-1, -2, -3], observer_poles=[-4], observer="minimal")
    (there,) = (case.result for case in found.case_tree if [str(c) for c in case.when] == ["b == 0"])
    assert there is not None
    assert (there.verdict, there.answer["F"], there.answer["L"]) == ("no", None, None)


def test_coordinates_on_a_stratum_are_regular_there() -> None:
    """The first entry of C vanishes on the curve a² = a + 1: there another column is completed."""
    a = Scalar.symbol("a")
    curve, C = Ideal.of([a**2 - a - 1]), Exact.of([[a**2 - a - 1, a, 0]])
    assert completed(C).determinant() in curve
    assert completed(C, curve).determinant() not in curve


def test_the_gain_of_several_outputs_follows_from_its_equations() -> None:
    """A₂₂ = diag(−1, 0) and A₁₂ = I: the poles −4 and −5 ask for 3 and 5, by hand."""
    plant = symobs.StateSpace("[0 0 1 0; 0 0 0 1; -2 1 -1 0; 1 -1 0 0]", "[0; 0; 1; 0]", "[1 0 0 0; 0 1 0 0]")
    page = text_of(symobs.reduced_order_observer(plant, poles="-4, -5"))
    assert "l₂ = 5, l₁ + 1 = 4" in page
    assert "With several outputs the gain is not unique." in page
