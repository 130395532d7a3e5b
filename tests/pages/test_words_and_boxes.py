"""What a lecturer would mark on a page: a sentence said twice, an integral in discrete time, a condition that says nothing."""

from __future__ import annotations

import symobs
from symobs import StateSpace, characteristic_polynomial, decomposition, detectability, gramian, observability
from tests.kit import tabled, text_of


def test_two_vectors_of_a_kernel_are_told_in_one_display() -> None:
    page = text_of(observability(StateSpace(A="[-1 0 0; 0 -2 0; 0 0 -3]", C="[1 0 0]")))
    assert page.count("The following vectors lie in the unobservable subspace:") == 1
    assert "The following vector lies" not in page
    assert "The pair becomes observable if states 2 and 3 are also measured." in page


@tabled
def test_a_gramian_of_discrete_time_is_no_integral(A: str, says: str) -> None:
    page = text_of(gramian(StateSpace(A=A, C="[1 0]", dt=True), horizon="inf"))
    assert says in page
    assert "integral" not in page


@tabled
def test_no_condition_beside_one_that_implies_it(A: str, conditions: str) -> None:
    plant = StateSpace(A=A, C="[0 0 1]", symbols={"a": "real", "b": "negative"})
    page = text_of(detectability(plant))
    assert conditions in page


@tabled
def test_roots_on_a_vertical_line_are_written_with_i(A: str, roots: str) -> None:
    page = text_of(characteristic_polynomial(StateSpace(A=A, C="[1 0]", symbols={"w": "positive"})))
    assert f"roots are {roots}" in page


def test_the_boxes_of_a_case_are_as_few_as_those_of_a_section() -> None:
    plant = StateSpace(
        A="[-1 0 0 0; 1 -2 0 0; 0 0 -3 a; 0 0 0 -4]", B="[1; 0; 1; 0]", C="[0 1 1 0]", symbols={"a": "real"}
    )
    generic, case = decomposition(plant).to_latex().split("Case ", 1)
    assert generic.count(r"\answer{") == 1
    assert case.count(r"\answer{") == 1


@tabled
def test_the_roots_that_a_given_gain_leaves(K: str, roots: str) -> None:
    page = text_of(symobs.state_feedback(symobs.StateSpace("[0 1 0; 0 0 1; -2 -3 1]", B="[0; 0; 1]"), K=K))
    assert f"Its {roots}. " in page


def test_no_member_of_a_chain_is_printed_twice() -> None:
    page = text_of(symobs.observer(symobs.StateSpace("[1]", C="[1]"), poles=[-2]))
    assert "V_o⁻¹ = 3," in page


def test_no_fraction_in_the_numerator_of_a_loop() -> None:
    cart = symobs.StateSpace(
        "[0 1 0 0; 0 0 -m*g/M 0; 0 0 0 1; 0 0 (M+m)*g/(l*M) 0]", B="[0; 1/M; 0; -1/(M*l)]", C="[1 0 0 0]"
    )
    page = symobs.compensator(cart, control_poles=[-1] * 4, observer_poles=[-2] * 4).to_latex()
    assert r"\frac{(ls^2-g)\det(sI-A_{\mathrm c})}{lM\varphi" in page


@tabled
def test_a_loop_that_no_gain_places_is_told_whatever_is_repeated(poles: str, observer: str) -> None:
    plant = symobs.StateSpace("[1 0; 0 2]", B="[1; 0]", C="[1 1]")
    of_observer = "-3, -4" if observer == "full" else "-3"
    design = symobs.compensator(plant, control_poles=poles, observer_poles=of_observer, observer=observer)
    assert design.K is None
    assert "2 is not among the desired poles" in text_of(design)


def test_a_kernel_everywhere_beside_a_sum_that_exists_in_cases() -> None:
    plant = symobs.StateSpace("[-a -a a; -a a 1; 1 a 1]", C="[a 0 0]", dt=True)
    page = text_of(symobs.gramian(plant, horizon="inf"))
    assert "among the symmetric solutions it is the one with W N = [0; 0; 0]" in page
    assert page.count("have the same kernel") == 1  # where a = 0
