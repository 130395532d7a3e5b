"""What a lecturer would mark on a page: a sentence said twice, an answer boxed twice, a fraction within a fraction."""

from __future__ import annotations

import symobs
from symobs import StateSpace, decomposition, observability
from tests.kit import text_of


def test_two_vectors_of_a_kernel_are_told_in_one_display() -> None:
    page = text_of(observability(StateSpace(A="[-1 0 0; 0 -2 0; 0 0 -3]", C="[1 0 0]")))
    assert page.count("The following vectors lie in the unobservable subspace:") == 1
    assert "The following vector lies" not in page


def test_the_boxes_of_a_case_are_as_few_as_those_of_a_section() -> None:
    plant = StateSpace(
        A="[-1 0 0 0; 1 -2 0 0; 0 0 -3 a; 0 0 0 -4]", B="[1; 0; 1; 0]", C="[0 1 1 0]", symbols={"a": "real"}
    )
    generic, case = decomposition(plant).to_latex().split("Case ", 1)
    assert generic.count(r"\answer{") == 1
    assert case.count(r"\answer{") == 1


def test_no_fraction_in_the_numerator_of_a_loop() -> None:
    cart = symobs.StateSpace(
        "[0 1 0 0; 0 0 -m*g/M 0; 0 0 0 1; 0 0 (M+m)*g/(l*M) 0]", B="[0; 1/M; 0; -1/(M*l)]", C="[1 0 0 0]"
    )
    page = symobs.compensator(cart, control_poles=[-1] * 4, observer_poles=[-2] * 4).to_latex()
    assert r"\frac{(ls^2-g)\det(sI-A_{\mathrm c})}{lM\varphi" in page


def test_a_kernel_everywhere_beside_a_sum_that_exists_in_cases() -> None:
    plant = symobs.StateSpace("[-a -a a; -a a 1; 1 a 1]", C="[a 0 0]", dt=True)
    page = text_of(symobs.gramian(plant, horizon="inf"))
    assert "among the symmetric solutions it is the one with W N = 0" in page
    assert page.count("have the same kernel") == 1  # where a = 0
