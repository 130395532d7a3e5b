"""Pages of higher order leave out what nobody reads: adjugates of long polynomials, large matrices of long fractions."""

from __future__ import annotations

import symobs


def latex(order: int, *, fractions: bool = False) -> str:
    """Return the page of a compensator for s^-n, with poles at -1, or at -1/7 where the fractions are to be long."""
    A = [[int(j == i + 1) for j in range(order)] for i in range(order)]
    plant = symobs.StateSpace(A, [[int(i == order - 1)] for i in range(order)], [[1] + [0] * (order - 1)])
    poles = [f"-{k + 1}{'/7' * fractions}" for k in range(order)]
    return str(symobs.compensator(plant, control_poles=poles, observer_poles=poles).to("latex"))


def test_an_adjugate_that_fits_is_written() -> None:
    assert r"\begin{bmatrix}s^2+" in latex(3)  # of adj(sI - A_c), 3x3


def test_stages_of_a_high_order_are_left_out() -> None:
    page = latex(7, fractions=True)
    start = page.index("F(s)")
    stages = page[start : page.index("strictly proper")]
    assert "s^6" in stages
    assert r"s^5&" not in stages  # of an adjugate; K, sI - A_c and L fit
    assert r"A_{\mathrm{cl}}=\begin{bmatrix}A-BK&BK\\0&A-LC\end{bmatrix},\qquad" in page
