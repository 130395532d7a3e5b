"""Pages of higher order leave out what nobody reads: adjugates of long polynomials, large matrices of long fractions."""

from __future__ import annotations

import itertools
import re
from typing import TYPE_CHECKING

import numpy as np
import pytest

import symobs
from symobs.pages.formats.beamer import linked
from symobs.tasks.result import render
from tests.support.examples import EXAMPLES, document_of

if TYPE_CHECKING:
    from pathlib import Path


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


# -- long gains have letters ------------------------------------------------------------------------------------------

#: Of a display, a line that begins with a gain or the matrices of an observer, A − LC among them.
_HEAD = re.compile(r"(?:\\frac\{d\}\{dt\})?\s*([A-Za-z\\]+)[^&=]*&?=")


def named_by_stars(latex: str) -> set[str]:
    """Return the letters in whose displays an entry is named by a star."""
    found: set[str] = set()
    for display in re.findall(r"\\begin\{(?:align|gather)\*\}(.*?)\\end\{(?:align|gather)\*\}", latex, re.DOTALL):
        head = ""
        for line in re.split(r"\\\\\[3pt\]\n", display):
            begun = _HEAD.match(line.strip())
            head = begun[1] if begun and not line.startswith("&") else head
            if r"\ast_" in line:
                found.add(head)
    return found


@pytest.mark.slow
@pytest.mark.parametrize("path", EXAMPLES, ids=lambda path: path.stem)
def test_no_gain_of_a_worked_example_has_a_star(path: Path) -> None:
    page = str(render(document_of(path.stem), "latex"))
    assert named_by_stars(page).isdisjoint({"K", "L", "F", "G", "H", r"\dot"})


SIGNS = dict.fromkeys(["m_s", "m_u", "k_s", "k_t", "c", "m_1", "m_2", "k"], "positive")
QUARTER_CAR = symobs.StateSpace(
    "[0 1 0 0; -k_s/m_s -c/m_s k_s/m_s c/m_s; 0 0 0 1; k_s/m_u c/m_u -(k_s+k_t)/m_u -c/m_u]",
    "[0; 1/m_s; 0; -1/m_u]",
    "[1 0 0 0]",
    symbols=SIGNS,
)
TWO_MASSES = symobs.StateSpace(
    "[0 1 0 0; -k/m_1 -c/m_1 k/m_1 c/m_1; 0 0 0 1; k/m_2 c/m_2 -k/m_2 -c/m_2]",
    "[0; 1/m_1; 0; 0]",
    "[1 0 0 0]",
    symbols=SIGNS,
)


def test_long_gains_have_letters_in_which_the_page_goes_on() -> None:
    """A − LC, F, G, H and F(s) are printed in the letters; k is a spring, hence f for the feedback."""
    observer = symobs.observer(QUARTER_CAR, poles="-10, -10, -10, -10")
    loop = symobs.compensator(
        TWO_MASSES, control_poles="-1, -1, -2, -2", observer_poles="-5, -5, -5", observer="minimal"
    )
    pages = [str(design.to("text")) for design in (observer, loop)]
    assert not any("*" in page for page in pages)
    assert not any(named_by_stars(str(design.to("latex"))) for design in (observer, loop))
    assert re.search(r"⎡ +-l₁ +1 +0 +0⎤", pages[0])
    assert pages[0].count("-k_s/m_s - l₂") == 1
    assert "K = [K₁  K₂] = [f₁  f₂  f₃  f₄]" in pages[1]


# -- functions of time -------------------------------------------------------------------------------------------------


def test_a_boxed_exponential_has_no_named_entries() -> None:
    page = symobs.matrix_exponential(symobs.StateSpace("[0 1 0; 0 0 1; -10 -9 -4]")).to("latex")
    assert r"\answer{" in page
    assert (
        r"(e^{At})_{" not in page
    )  # 1/10 (e^{-t} (7 sin 2t - 4 cos 2t) + 4 e^{-2t}) and others: the sum of modes is boxed


def test_the_number_e_has_no_exponent_and_a_fraction_of_it_no_needless_signs() -> None:
    plant = symobs.StateSpace("[0 1 0; 0 -1 1; 0 0 -2]", "[0; 0; 1]")
    found = symobs.minimum_energy_input(plant, initial="0, 0, 0", final="1, 0, 0", horizon="1")
    page = found.to("latex")
    assert "e^{1}" not in page
    assert r"\frac{2+8e+2e^{2}}{2+2e-e^{2}}" in page  # -2 - 8 e - 2 e^2 over e^2 - 2 e - 2


def test_sums_over_the_same_roots_are_one_sum() -> None:
    """Two masses with damping: N(λ)/(λ q′(λ)) is the residue of P(s)/s, and -λ n(λ) = N(λ) modulo q, N = s² + s + 1."""
    plant = symobs.StateSpace("[0 1 0 0; -2 -1 1 0; 0 0 0 1; 1 0 -1 -1]", "[0; 1; 0; 0]", "[1 0 0 0]")
    found = symobs.response(plant, input="1")
    roots = np.roots([1, 2, 4, 3, 1])
    n, residue = np.polyval([1, 2, 3, 2], roots), np.polyval([1, 1, 1], roots) / roots
    assert np.allclose(-n, residue)
    page = found.to("latex", exact=True)
    answer = page.partition("y(t)=")[2].partition(r"\]")[0]
    assert answer.count(r"\sum") == 1
    assert r"1-\sum" in answer
    assert r"(\lambda^3+2\lambda^2+3\lambda+2)e^{\lambda t}" in answer
    assert "x(t)_{" not in page  # no named entries in the box of the state


def test_powers_of_A_end_where_the_rank_is_full() -> None:
    """Two sensors on five states: C, CA and the second row of CA² have rank 5 (the observability indices are 2 and 3)."""
    A, C = "[0 1 0 0 0; -2 -1 1 0 0; 0 0 0 1 0; 1 0 -1 -1 1; 0 0 0 0 -2]", "[1 0 0 0 0; 0 0 1 0 0]"
    page = symobs.observer(symobs.StateSpace(A, C=C), poles=[-4, -4, -5, -5, -6]).to("text")
    assert "Selected rows of the observability matrix form the matrix" in page
    assert "c₂ A²" in page
    assert "A³" not in page
    assert "A⁴" not in page


def test_a_gain_of_few_signs_is_boxed_itself() -> None:
    symbols = dict.fromkeys(["g", "l", "m", "zeta", "omega"], "positive")
    plant = symobs.StateSpace("[0 1; g/l 0]", "[0; 1/(m*l^2)]", symbols=symbols)
    page = symobs.state_feedback(plant, polynomial="s^2 + 2*zeta*omega*s + omega^2").to("text")
    assert "k₁" not in page
    assert "2l² m ω ζ" in page


def test_no_slide_begins_with_a_sign() -> None:
    """K = [p − …] V⁻¹ and its value stay together; a sum of four tall matrices is made smaller."""
    letters = dict.fromkeys(["g", "l", "m", "zeta", "omega"], "positive")
    pendulum = symobs.StateSpace("[0 1; g/l 0]", "[0; 1/(m*l^2)]", symbols=letters)
    slides = symobs.state_feedback(pendulum, polynomial="s^2 + 2*zeta*omega*s + omega^2").to("beamer")
    rows = str(slides).split("\n")
    begins = [before for before, row in itertools.pairwise(rows) if row.startswith(("&=", r"&\approx"))]
    assert begins
    assert all(r"\\*" in before for before in begins)
    A = "[0 1 0 0; -2 -1 1 0; 0 0 0 1; 1 0 -1 -1]"
    plant = symobs.StateSpace(A, "[0; 1; 0; 0]", "[1 0 0 0]")
    rows = str(symobs.response(plant, input=1).to("beamer")).split("\n")
    tall = [i for i, row in enumerate(rows) if r"\sum" in row and row.count(r"\begin{bmatrix}") == 1]
    assert len(tall) == 4
    begun = max(i for i in range(tall[0]) if rows[i] == r"\begin{fitted}")
    assert r"\end{fitted}" not in rows[begun : tall[-1]]


@pytest.mark.parametrize(("height", "lefts"), [(3, ["K", "", ""]), (5, ["K", "", "K"]), (6, ["K", "K", "K"])])
def test_a_chain_of_several_slides_begins_again_with_its_left_side(height: int, lefts: list[str]) -> None:
    """A slide has ten lines: three matrices of three rows, two of five, one of six."""
    table = r"\begin{bmatrix}" + r"\\".join("1" * height) + r"\end{bmatrix}"
    rows = (rf"{left}&={table}\\[3pt]" for left in ("K", "", ""))
    written, is_whole = linked("\n".join([r"\begin{align*}", *rows, r"\end{align*}"]))
    assert is_whole
    assert [line.partition("&=")[0] for line in written.split("\n")[1:-1]] == lefts


def test_a_tall_answer_of_a_case_is_made_smaller_too() -> None:
    """e^{At} of a spinning top is a sum of four matrices, in the case that h is not 2; the case h = 2 has a slide, too."""
    plant = symobs.StateSpace("[0 1 0 0; 1 0 0 -h; 0 0 0 1; 0 h 1 0]", symbols={"h": "positive"})
    slides = str(symobs.matrix_exponential(plant).to("beamer"))
    assert r"\answer{" in slides.partition(r"\begin{fitted}")[2].partition(r"\end{fitted}")[0]


# -- what is used -----------------------------------------------------------------------------------------------------


def test_a_matrix_behind_a_bar_fits_its_line() -> None:
    """The Jacobian of a ball on a beam: its longest entry has a name, the equations behind the bar are one."""
    page = str(render(document_of("ball_and_beam"), "latex"))
    (jacobian,) = (line for line in page.split("\n") if r"\dot{\alpha}^2}{7}" in line and "right|" in line)
    assert r"\ast_{1}" in jacobian
    assert r"_{r=\alpha=\dot{r}=\dot{\alpha}=\tau=0}" in jacobian


CARTS = symobs.StateSpace(
    "[0 1 0 0 0 0; -1 -1 1 0 0 0; 0 0 0 1 0 0; 1 0 -2 -1 1 0; 0 0 0 0 0 1; 0 0 1 0 -1 -1]",
    C="[1 0 -1 0 0 0; 0 0 1 0 -1 0]",
)


def test_an_answer_no_shows_the_blocks_that_have_the_rank() -> None:
    """Of three carts and two distances C and CA have rank 4, that of the whole matrix; no zeros are written out."""
    page = str(symobs.observability(CARTS).to("text"))
    assert "Since rank[𝒪_ν; C·A²] = rank 𝒪_ν" in page
    assert "C A³" not in page
    assert page.count(" = 0") == 2
    dual = str(symobs.controllability(symobs.StateSpace(CARTS.A.T, CARTS.C.T)).to("text"))
    assert "Since rank[𝒞_ν A²·B] = rank 𝒞_ν" in dual


def test_a_deadbeat_error_vanishes_by_an_equation() -> None:
    plant = symobs.StateSpace("[1 1 1/2; 0 1 1; 0 0 1]", C="[1 0 0]", dt=1)
    assert "(A - L C)³ = 0." in str(symobs.observer(plant, poles=[0, 0, 0]).to("text"))


def test_digits_of_an_optimal_gain_follow_the_roots_of_its_polynomial() -> None:
    """-s^6 + 28 s^4 - 100 s^2 + 1226, by Ogata's example; its roots by numpy."""
    found = sorted(np.roots([-1, 0, 28, 0, -100, 0, 1226]), key=lambda root: root.real)
    page = str(render(document_of("lqr_third_order"), "text"))
    told = re.search(r"Its roots are (.*?)\. With", page.replace("\n", " "))
    assert told
    numbers = [float(number) for number in re.findall(r"[0-9.]+", told[1].replace("-", ""))]
    assert np.allclose(numbers[0], found[-1].real, atol=1e-4)
    assert np.allclose(numbers[1:3], [abs(found[1].real), abs(found[1].imag)], atol=1e-4)


def test_conditions_have_no_factors_of_known_sign() -> None:
    """omega^2 (zeta^2 - 1) < 0 is zeta < 1 where both are positive; the roots are -zeta omega ± omega √(zeta^2 - 1)."""
    signs = dict.fromkeys(["zeta", "omega"], "positive")
    plant = symobs.StateSpace("[0 1; -omega^2 -2*zeta*omega]", symbols=signs)
    page = str(symobs.matrix_exponential(plant).to("text"))
    assert [line.strip() for line in page.splitlines() if "Case" in line] == [
        "Case ζ < 1.",
        "Case ζ > 1.",
        "Case ζ = 1.",
    ]
    assert "-ω ζ ± ω √(ζ² - 1)" in str(symobs.characteristic_polynomial(plant).to("text"))


def test_a_gain_of_six_states_is_found_by_parts() -> None:
    """With three entries held the polynomial of three oscillators and two outputs splits into a square and a quartic one."""
    A = "[0 1 0 0 0 0; -2 0 1 0 0 0; 0 0 0 1 0 0; 1 0 -2 0 1 0; 0 0 0 0 0 1; 0 0 1 0 -2 0]"
    plant = symobs.StateSpace(A, C="[1 0 0 0 0 0; 0 0 0 0 1 0]")
    page = str(symobs.observer(plant, poles=[-2, -2, -3, -3, -4, -4]).to("text"))
    assert "We look for a gain of the following form" in page
    assert "Equating the coefficients factor by factor" in page
    assert "X_o" not in page


def test_a_sum_over_a_number_is_taken_apart() -> None:
    """From (s + l + 1/10), not (s + (10 l + 1)/10)."""
    plant = symobs.StateSpace("[0 1 0 0; 0 -1/5 2 0; 0 0 0 1; 0 1/10 -6 -1/10]", C="[1 0 0 0; 0 0 1 0]")
    page = str(symobs.reduced_order_observer(plant, poles=[-4, -5]).to("text"))
    assert "(s + l₂ + 1/10)(s + l₁ + 1/5)" in page


@pytest.mark.parametrize("task", ["integral_action", "unknown_input_observer"])
def test_the_check_of_a_gain_ends_with_the_desired_factors(task: str) -> None:
    if task == "integral_action":
        plant = symobs.StateSpace("[-2 1; 1 -3]", "[1 0; 0 2]", "[1 0; 0 1]")
        page = str(symobs.integral_action(plant, poles=[-1, -2, -3, -4]).to("text"))
    else:
        page = str(render(document_of("unknown_input_observer"), "text"))
    check = " ".join(page.partition("✓")[2].split("\n\n")[0].split())
    assert check.endswith(f"{'(s + 1)' if task == 'integral_action' else ''}(s + 2)(s + 3)(s + 4), as required.")


def test_the_hamiltonian_matrix_of_a_filter_has_no_transposes_of_transposes() -> None:
    plant = symobs.StateSpace("[0 1; 0 -1/2]", C="[1 0; 0 1]")
    page = str(symobs.kalman(plant, W="1", V="[1 0; 0 1/4]", G="[0; 1]").to("latex"))
    assert r"(C^{\mathsf T})" not in page
    assert r"-C^{\mathsf T}V^{-1}C" in page


def test_the_square_of_a_root_is_what_stands_under_it() -> None:
    """det [0 b; b 0] with b = -2 √(cg/m)/d_0 is -4 cg/(d_0² m)."""
    page = str(render(document_of("magnetic_levitation"), "text"))
    assert "det 𝒞 = -4c g/(d₀² m) ≠ 0" in page
    assert "(√" not in page


# -- what is stated below a title -------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("name", "law"),
    [
        ("lqr_third_order", "u = -K x."),
        ("cruise_control_integral_action", "u = -K x + k_I ξ."),
        ("output_regulation", "u = -K x + F w."),
        ("output_feedback_servo", "u = -K x̂,"),
        ("root_locus_ogata", ""),
    ],
)
def test_a_page_with_a_gain_states_its_law_and_no_other_page_does(name: str, law: str) -> None:
    page = str(render(document_of(name), "text"))
    assert ("Notation:" in page) == bool(law)
    assert f"Notation: {law}" in page or not law


def test_both_gains_of_integral_action_stand_in_one_display() -> None:
    page = str(render(document_of("cruise_control_integral_action"), "latex"))
    (display,) = (part for part in re.findall(r"\\\[.*?\\\]", page) if r"K=\answer" in part)
    assert r"\qquad k_{\mathrm I}=\answer" in display


def test_bases_have_no_common_factors_and_begin_positively() -> None:
    """Of this plant (1, -2, 0) and e₃ are hidden, by hand; the reached part is the whole space."""
    plant = symobs.StateSpace("[0 1 0; -2 -3 0; 0 0 1]", "[0; 1; 1]", "[2 1 0]")
    inverse = symobs.decomposition(plant).T.inv()
    for place in range(3):
        numbers = [int(entry) for entry in inverse.col(place)]
        assert np.gcd.reduce(numbers) == 1
        assert next(number for number in numbers if number) > 0
    page = str(symobs.pbh(plant).to("text"))
    assert "⎡ 1⎤\n        ⎡A - λ I⎤ ⎢-2⎥ = 0" in page


def test_references_stay_with_the_figure_or_the_display_before_them_on_a_slide() -> None:
    """The last frame of an observer ends with a figure, that of an observer of an unknown input with a display."""
    for name, end in (("third_order_at_zeros", "endparpenalty"), ("motor_unknown_load", "postdisplaypenalty")):
        slides = str(render(document_of(name), "beamer"))
        before, _, after = slides.rpartition("\\par\\nopagebreak\n\\begin{fitted}\n\\begin{references}")
        assert after
        assert rf"{end}" in before.rpartition("\\begin{frame}")[2]
