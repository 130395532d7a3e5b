"""Pages in decimals: every printed decimal is the correct rounding of the exact value, and nothing else passes."""

from __future__ import annotations

import re
import warnings
from dataclasses import fields, is_dataclass, replace
from decimal import ROUND_HALF_EVEN, Context, Decimal
from fractions import Fraction
from functools import cache
from itertools import islice, pairwise
from typing import TYPE_CHECKING, Any

import pytest
import sympy
from hypothesis import given
from hypothesis import strategies as st

from symobs import (
    StateSpace,
    compensator,
    gramian,
    matrix_exponential,
    observer,
    reduced_order_observer,
    stability_region,
    state_feedback,
    transfer_function,
)
from symobs.exact import Scalar, is_correctly_written, roots_of, significant
from symobs.exact.core.generators import function
from symobs.exact.numerals.rounded_roots import are_rounded_roots
from symobs.exact.numerals.written_digits import rounded_roots
from symobs.formula.tree import (
    HoldsExactlyWhere,
    Letter,
    Literal,
    Negative,
    Numeral,
    Predicate,
    Product,
    Quotient,
    Relation,
    RoundedRoots,
)
from symobs.formula.tree.plain_text import plain, plain_relation
from symobs.ground.errors import DerivationRejected, ProblemErrors, SymobsWarning, UsageError
from symobs.pages.decimals.formulas import InDecimals
from symobs.pages.decimals.steps import in_decimals
from symobs.pages.printers.latex_printer import LatexPrinter
from symobs.problem import validate
from symobs.proof.derivation import CaseStep, Conclude, Define, Diagram, Equal, Given, Inequalities, Section, Sentence
from symobs.proof.derivation.decimals_check import check_decimals
from tests.kit import tabled, text_of

if TYPE_CHECKING:
    from collections.abc import Iterator

    from symobs.tasks.result import Result

#: The pitch of an aircraft, from the control tutorials of the University of Michigan.
PITCH = "[-0.313 56.7 0; -0.0139 -0.426 0; 0 56.7 0]", "[0.232; 0.0203; 0]", "[0 0 1]"


@cache
def pitch() -> Result:
    return compensator(StateSpace(*PITCH), control_poles="-1, -1+i, -1-i", observer_poles="-5, -5+2i, -5-2i")


@cache
def swinging() -> Result:
    """A pendulum of length 1 m with friction: its poles are −0.175 ± i√(9.81 − 0.175²), its zero −10/3."""
    return transfer_function(StateSpace("[0 1; -9.81 -0.35]", "[0; 1.7]", "[1 0.3]"))


@cache
def regulator() -> Result:
    """Ogata, Modern Control Engineering: regulator with observed-state feedback for A = [0 1; 20.6 0]."""
    plant = StateSpace("[0 1; 20.6 0]", "[0; 1]", "[1 0]")
    return compensator(plant, control_poles="-1.8+2.4j, -1.8-2.4j", observer_poles="-8, -8")


def number(text: str) -> Scalar:
    return Scalar.of(Fraction(text))


# -- one number --------------------------------------------------------------------------------------------------------


@tabled
def test_how_a_number_is_written(exact: str, digits: int, shown: str) -> None:
    assert significant(number(exact), digits) == shown
    assert is_correctly_written(number(exact), shown, digits)


@given(st.fractions(min_value=Fraction(1, 10**9), max_value=10**9, max_denominator=10**9), st.integers(1, 12))
def test_a_rounded_number_is_that_of_the_decimal_module_and_no_other(exact: Fraction, digits: int) -> None:
    value = Scalar.of(exact)
    text = significant(value, digits)
    assert text is not None
    assert is_correctly_written(value, text, digits)
    assert not any(is_correctly_written(value, wrong, digits) for wrong in other_last_digits(text))
    if Fraction(text) != exact:
        there = Context(prec=digits, rounding=ROUND_HALF_EVEN)
        assert Fraction(text) == Fraction(there.divide(Decimal(exact.numerator), Decimal(exact.denominator)))


@tabled
def test_too_few_digits_too_many_and_other_texts_are_refused(text: str) -> None:
    assert not is_correctly_written(number("1/3"), text, 5)


def test_just_below_a_power_of_ten_the_last_digit_counts_less() -> None:
    assert significant(number("999961/100000"), 5) == "9.9996"
    assert not is_correctly_written(number("999961/100000"), "10.000", 5)


def other_last_digits(text: str) -> Iterator[str]:
    """Yield a text with each other digit in its last place."""
    digits, mark, power = text.partition("e")
    for digit in "0123456789":
        if digit != digits[-1]:
            yield f"{digits[:-1]}{digit}{mark}{power}"


# -- roots ---------------------------------------------------------------------------------------------------------------


@tabled
def test_roots_in_decimals_are_those_of_another_program(coefficients: str) -> None:
    numbers = coefficients.split()
    text = " + ".join(f"({number}) s^{len(numbers) - place}" for place, number in enumerate(numbers, 1))
    value = StateSpace.from_polynomial(text).polynomial
    assert value is not None
    roots = roots_of(value, "s")
    texts = rounded_roots(roots, 6)
    assert texts is not None
    wanted = sympy.Poly([sympy.Rational(number) for number in numbers], sympy.Symbol("s")).nroots(n=40, maxsteps=300)
    there = sorted((to_six(sympy.re(root)), to_six(sympy.im(root))) for root in wanted)
    assert sorted((float(real), float(imaginary or 0)) for real, imaginary, _ in texts) == there
    for place, (real, imaginary, rounded) in enumerate(texts):
        for wrong in other_last_digits(real):
            others = (*texts[:place], (wrong, imaginary, rounded), *texts[place + 1 :])
            assert not are_rounded_roots(roots, others, 6)


def to_six(part: sympy.Expr) -> float:
    return float(f"{Decimal(str(part)):.6g}")


def test_whether_a_root_is_rounded_is_part_of_the_text() -> None:
    s = Scalar.symbol("s")
    roots = roots_of((s + Fraction(1, 2)) * (s + Fraction(1, 3)), "s")
    texts = rounded_roots(roots, 5)
    assert texts is not None
    assert {text[0]: text[2] for text in texts} == {"-0.5": False, "-0.33333": True}
    assert not are_rounded_roots(roots, tuple((real, imaginary, not rounded) for real, imaginary, rounded in texts), 5)


# -- whole pages ---------------------------------------------------------------------------------------------------------


def leaves(step: Any) -> Iterator[Any]:
    """Yield the steps that contain no other."""
    if isinstance(step, (Section, CaseStep)):
        for inner in step.steps:
            yield from leaves(inner)
    else:
        yield step


def spoiled(part: Any) -> Iterator[Any]:
    """Yield a step with the last digit of one decimal changed, in each place and in each way."""
    if isinstance(part, Numeral):
        yield from (Numeral(part.value, text) for text in other_last_digits(part.text))
    elif isinstance(part, RoundedRoots):
        for place, (real, imaginary, rounded) in enumerate(part.texts):
            for text in other_last_digits(real):
                yield replace(part, texts=(*part.texts[:place], (text, imaginary, rounded), *part.texts[place + 1 :]))
            for text in other_last_digits(imaginary) if imaginary else ():
                yield replace(part, texts=(*part.texts[:place], (real, text, rounded), *part.texts[place + 1 :]))
    elif isinstance(part, tuple):
        for place, inner in enumerate(part):
            yield from ((*part[:place], other, *part[place + 1 :]) for other in spoiled(inner))
    elif is_dataclass(part):
        for each in fields(part):
            yield from (replace(part, **{each.name: other}) for other in spoiled(getattr(part, each.name)))  # type: ignore[type-var]


def exact_and_shown(result: Result) -> Iterator[tuple[Any, Any]]:
    """Yield the steps of a page with what stands for them on a page in decimals."""
    derivation = result.derivation
    shown = [leaf for step in in_decimals(derivation, derivation.steps, 5) for leaf in leaves(step)]
    exact = [leaf for step in derivation.steps for leaf in leaves(step)]
    yield from zip(
        (leaf for leaf in exact if key_of(leaf) not in {"in_decimals", "exact_decimals"}),
        (leaf for leaf in shown if key_of(leaf) != "rounded_digits"),
        strict=True,
    )


def key_of(step: Any) -> str:
    sentence = getattr(step, "sentence", None)
    return "" if sentence is None else str(sentence.key)


def test_right_decimals_are_accepted_and_a_thousand_wrong_last_digits_rejected() -> None:
    planted = 0
    for result in (pitch(), swinging(), regulator()):
        for exact, shown in exact_and_shown(result):
            check_decimals(exact, shown, "s", 5)
            for wrong in islice(spoiled(shown), 60):
                with pytest.raises(DerivationRejected):
                    check_decimals(exact, wrong, "s", 5)
                planted += 1
    assert planted >= 1000


def test_no_member_of_a_chain_is_printed_twice_and_differences_stay() -> None:
    plant = StateSpace("[0 1; 20.6 0]", "[0; 1]", "[1 0]")
    poles: dict[str, Any] = {"control_poles": "-1.8+2.4j, -1.8-2.4j", "observer_poles": "-8", "observer": "minimal"}
    loops = compensator(plant, **poles), state_feedback(plant, poles="-1.8+2.4j, -1.8-2.4j")
    lines: list[list[str]] = []
    for _, shown in (pair for result in loops for pair in exact_and_shown(result)):
        for relation in (shown.relation,) if isinstance(shown, Define) else getattr(shown, "relations", ()):
            lines += [[LatexPrinter().inline(member) for member in relation.members]]
    assert not [line for line in lines if any(one == other for one, other in pairwise(line))]
    assert any(
        r"\begin{bmatrix}9-(-20.6)&3.6-0\end{bmatrix}" in member.replace("small", "b")
        for line in lines
        for member in line
    )


def test_a_rounded_number_in_a_comparison_is_said_to_be_one() -> None:
    """Not 0.018316 ≤ 0.02 alone: e^{−4} ≈ 0.018316 ≤ 0.02."""
    bound = Relation((Literal(function("exp", Scalar.of(-4))), Literal(number("1/50"))), ("<=",))
    shown = InDecimals("s", 5).relation(bound)
    assert plain_relation(shown, "s") == "1/(exp(1)**4) ≈ 0.018316 <= 0.02"
    check_decimals(bound, shown, "s", 5)
    check_decimals(bound, bound, "s", 5)
    between = Relation((Literal(number("0")), Literal(number("1/3")), Literal(number("2/3"))), ("<", "<"))
    assert plain_relation(InDecimals("s", 5).relation(between), "s") == "0 < 1/3 ≈ 0.33333 < 2/3 ≈ 0.66667"
    check_decimals(between, InDecimals("s", 5).relation(between), "s", 5)
    silent = Relation(shown.members[1:], ("<=",))
    other = Relation((Literal(function("exp", Scalar.of(-5))), *shown.members[1:]), shown.operators)
    for lie in (silent, other, Relation(shown.members, ("=", "<=")), Relation(shown.members, ("<=", "<="))):
        with pytest.raises(DerivationRejected):
            check_decimals(bound, lie, "s", 5)


def test_the_ends_of_a_region_have_their_decimals_beside() -> None:
    """s² + (0.7 − 0.3k) s + 0.11 + 0.6k is stable for −11/60 < k < 7/3, where both coefficients are positive."""
    region = stability_region(polynomial="s^2 + (0.7 - 0.3*k)*s + 0.11 + 0.6*k", parameters=["k"])
    assert r"\answer{-0.18333\approx-\frac{11}{60}<k<\frac{7}{3}\approx2.3333}" in region.to_latex()
    one = stability_region(polynomial="s^2 + 0.7*s + 0.2*k - 0.3", parameters=["k"])
    assert r"\answer{k>1.5}" in one.to_latex()


BOUND = Literal(Scalar.symbol("k")), Literal(number("1/3"))
NEAR = Numeral(number("1/3"), "0.33333")


@pytest.mark.parametrize(
    "lie",
    [
        Relation((BOUND[0], NEAR), (">",)),  # without the exact end
        Relation((BOUND[0], NEAR), ("≈",)),
        Relation((*BOUND, Numeral(number("1/3"), "0.33334")), (">", "≈")),
        Relation((NEAR, *BOUND), ("≈", ">")),  # beside the parameter
    ],
)
def test_a_bound_is_not_rounded_without_the_exact_one(lie: Relation) -> None:
    def region(bound: Relation) -> Inequalities:
        return Inequalities(HoldsExactlyWhere(Predicate("stable", Letter("chi")), (bound,)), None, answer=True)

    exact = region(Relation(BOUND, (">",)))
    check_decimals(exact, region(Relation((*BOUND, NEAR), (">", "≈"))), "s", 5)
    with pytest.raises(DerivationRejected):
        check_decimals(exact, region(lie), "s", 5)


def test_the_sign_at_a_junction_is_that_of_the_exact_figure() -> None:
    """Where an exact gain has a minus sign at its junction, the decimals have it there, never in the box alone."""
    poles: dict[str, Any] = {"control_poles": "-1.8+2.4j, -1.8-2.4j", "observer_poles": "-8", "observer": "minimal"}
    result = compensator(StateSpace("[0 1; 20.6 0]", "[0; 1]", "[1 0]"), **poles)
    figures = [pair for pair in exact_and_shown(result) if isinstance(pair[0], Diagram) and pair[0].name == "loop"]
    ((exact, shown),) = figures
    gain = dict(shown.labels)["F"]
    assert plain(gain, "s") == "-(58.4*s + 310.96)/(s + 11.6)"
    in_the_box = Quotient(Negative(gain.operand.numerator), gain.operand.denominator)  # the same value, but no sign
    labels = tuple((place, in_the_box if place == "F" else label) for place, label in shown.labels)
    with pytest.raises(DerivationRejected, match="without the sign"):
        check_decimals(exact, replace(shown, labels=labels), "s", 5)


THIRD = Numeral(number("1/3"), "0.33333")
A_THIRD = Relation((Letter("A"), Literal(number("1/3"))), ("=",))


@pytest.mark.parametrize(
    ("exact", "shown"),
    [
        (Equal((A_THIRD,)), Equal((Relation((Letter("A"), THIRD), ("=",)),))),  # it is rounded
        (Equal((A_THIRD,)), Equal((Relation((Letter("B"), THIRD), ("≈",)),))),  # of another letter
        (Equal((A_THIRD,)), Equal((Relation((Letter("A"), Negative(THIRD)), ("≈",)),))),
        (Equal((A_THIRD,)), Equal((Relation((Letter("A"), Numeral(number("2/3"), "0.66667")), ("≈",)),))),
        (Equal((A_THIRD,)), Equal((Relation((Letter("A"), Literal(number("1/3"))), ("≈",)),))),  # it is exact
        (Equal((A_THIRD,)), Equal((Relation((Letter("A"), THIRD, THIRD, THIRD), ("≈", "≈", "≈")),))),
        (Equal((A_THIRD,)), Define(Relation((Letter("A"), THIRD), ("≈",)))),
        (Equal((A_THIRD,)), Equal((A_THIRD, A_THIRD))),
        (Given((A_THIRD,)), Given((Relation((Letter("A"), THIRD), ("≈",)),))),  # data are not rounded
        (
            CaseStep(A_THIRD, (), ()),
            CaseStep(Relation((Letter("A"), THIRD), ("≈",)), (), ()),  # nor what conditions an answer
        ),
        (
            Conclude(Sentence("undecided_case", (("when", Literal(number("1/3"))),))),
            Conclude(Sentence("undecided_case", (("when", THIRD),))),  # nothing says that it is rounded
        ),
        (
            Equal((Relation((Letter("A"), Literal(number("1/3")), Literal(number("333332/1000000"))), ("=", ">")),)),
            Equal(
                (Relation((Letter("A"), THIRD, Numeral(number("333332/1000000"), "0.33333")), ("≈", ">")),)
            ),  # not of what is read
        ),
        (
            Equal((Relation((Letter("A"), Product((Letter("B"), Literal(number("1/3"))))), ("=",)),)),
            Equal((Relation((Letter("A"), Product((THIRD, Letter("B")))), ("≈",)),)),
        ),
    ],
)
def test_what_else_is_not_the_same_line_in_decimals(exact: Any, shown: Any) -> None:
    with pytest.raises(DerivationRejected):
        check_decimals(exact, shown, "s", 5)


def test_the_page_of_the_aircraft_is_one_of_decimals() -> None:
    """The gains by SymPy: K = eᵀ 𝒞⁻¹ φ(A), Lᵀ of the dual pair."""
    A, B, C = (sympy.Matrix(read(text)) for text in PITCH)
    K = ackermann(A, B, "(x + 1)*(x**2 + 2*x + 2)")
    L = ackermann(A.T, C.T, "(x + 5)*(x**2 + 10*x + 29)")
    page = str(pitch().to("text"))
    for gain in (K, L, [*(A - B * K - L.T * C)]):
        for entry in gain:
            size = f"{Context(prec=5).divide(Decimal(abs(entry.p)), Decimal(int(entry.q))):f}"
            assert size in page
    assert "exact values rounded to 5 significant digits" in page
    assert re.search(r"\d{12}|\d/\d{3}", page.partition("References")[0]) is None  # no fraction in the flow


def read(text: str) -> list[list[sympy.Rational]]:
    return [[sympy.Rational(entry) for entry in row.split()] for row in text.strip("[]").split(";")]


def ackermann(A: sympy.Matrix, B: sympy.Matrix, polynomial: str) -> sympy.Matrix:
    reached = sympy.Matrix.hstack(*(A**k * B for k in range(A.rows)))
    coefficients = sympy.Poly(polynomial, sympy.Symbol("x")).all_coeffs()
    value = sum((c * A**k for k, c in enumerate(reversed(coefficients))), sympy.zeros(A.rows))
    return reached.inv()[-1, :] * value


def test_published_decimals_stand_on_the_page() -> None:
    """Ogata prints K = [29.6 3.6], L = [16; 84.6] and the controller (778.2s + 3690.7)/(s² + 19.6s + 151.2)."""
    page = str(regulator().to("latex"))
    assert r"\answer{\begin{bmatrix}29.6&3.6\end{bmatrix}}" in page
    assert r"\answer{\begin{bmatrix}16\\84.6\end{bmatrix}}" in page
    assert r"\approx\answer{\frac{778.16s+3690.7}{s^2+19.6s+151.2}}" in page
    assert r"778.2s+3691}{s^2+19.6s+151.2}" in str(regulator().to("latex", digits=4))


@tabled
def test_every_format_shows_the_same_decimals(name: str) -> None:
    page = str(swinging().to(name))
    assert "≈" in page or r"\approx" in page
    assert "-0.175" in page.replace("<mo>−</mo><mn>", "-")
    assert "3.1272" in page
    assert "3.3333" in page
    assert "3.127" in str(swinging().to(name, digits=4))


def test_exact_and_digits_choose() -> None:
    plant = StateSpace("[0 1; -1/3 0]", C="[1 0]")
    thirds = observer(plant, poles="-1, -2")
    assert "≈" not in str(thirds.to("text"))
    assert thirds.to("latex") == thirds.to("latex", exact=True)
    in_three = str(thirds.to("text", digits=3))
    assert "1.67" in in_three
    assert "-1/3" in in_three  # what is given is not rounded
    assert "1/3" not in in_three.partition("1. Observer")[2].replace("5/3", "")
    typed = state_feedback(StateSpace("[0 1; -0.3 0.7]", "[0; 3]"), poles="-1, -2")
    assert "≈" in str(typed.to("text"))
    assert "(1/30)[17  37]" in str(typed.to("text", exact=True))
    assert "≈" in str(
        observer(StateSpace("[0 1; -1 -3]", C="[3 0]"), poles="-1.7, -2").to("text")
    )  # typed in the poles
    assert "17/30" in str(typed.to("json"))
    with pytest.raises(UsageError, match="keep one of them"):
        typed.to("text", digits=4, exact=True)
    with pytest.raises(UsageError, match="from 1 to 40"):
        typed.to("text", digits=0)


def test_a_root_of_a_composite_number_is_rounded_too() -> None:
    """The modes of the exponential have the discriminant 1265 = 5 · 11 · 23; sinh(ωt)/ω, ω = √1265/20, stands in it."""
    plant = StateSpace("[0.5 0.1; 1 -3]")
    with warnings.catch_warnings():
        warnings.simplefilter("error", SymobsWarning)
        page = str(matrix_exponential(plant).to("latex"))
    one = 20 / Decimal(1265).sqrt()
    assert page.count(f"{one.quantize(Decimal('1.00000'))}") == 2
    assert f"{(one / 10).quantize(Decimal('1.000000'))}" in page


def test_a_short_exact_answer_stands_before_its_decimals() -> None:
    plant = StateSpace("[0 0 0 1; 0 0 1 0; 0 10.78 0 0; 0 -0.98 0 0]", "[0; 0; -1; 1]", "[1 0 0 0]")
    page = str(reduced_order_observer(plant, poles="-20, -20+20i, -20-20i").to("latex"))
    assert (
        r"\\[4pt]-\frac{832340}{49}\\[4pt]60\end{bmatrix}\approx\answer{\begin{bmatrix}-1643.7\\-16987\\60\end{bmatrix}}"
        in page
    )
    assert "Numerically" not in page


def test_conditions_stay_exact() -> None:
    plant = StateSpace("[0 1 0; 0 0 1; -1.37 -0.35 -2.3]", C="[1 0.3 0]", symbols={"h": "real"})
    page = str(stability_region(plant, L="[h; 1; 2.3]").to("text"))
    assert "5.97 - 0.061 h" in page  # an exact polynomial
    assert "h < 5970/61" in page


def test_a_file_chooses_too() -> None:
    data = {
        "task": "state_feedback",
        "plant": {"A": "[0 1; -0.3 0.7]", "B": "[0; 3]"},
        "specification": {"poles": "-1, -2"},
    }
    assert digits_of({**data, "digits": 3}) == 3
    assert digits_of({**data, "exact": True}) == 0
    assert digits_of(data) is None
    for wrong, where in (
        ({"digits": 2.5}, "digits"),
        ({"digits": 3, "exact": True}, "digits"),
        ({"exact": 1}, "exact"),
    ):
        with pytest.raises(ProblemErrors) as raised:
            validate({**data, **wrong})
        assert [error.where for error in raised.value.errors] == [where]


def digits_of(data: dict[str, Any]) -> int | None:
    problem = validate(data)
    return problem.document(problem.solve()).digits


def test_parametric_values_have_decimal_coefficients() -> None:
    plant = StateSpace("[0 1; -1.37*k -0.35]", "[0; 1.7]", "[1 0.3*k]", symbols={"k": "positive"})
    page = text_of(observer(plant, poles="-4.5, -6"))
    assert "det 𝒪 = 0.1233 k³ - 0.105 k + 1 ≠ 0" in page
    assert "(3.3333 k² - 65.693 k + 82.320)/(k³ - 0.85158 k + 8.1103)" in page


def test_functions_of_time_are_compared_by_what_is_known_of_them() -> None:
    """∫ e^{−2at} dt contains the square of e^{−aT}, written as e^{−2aT}."""
    plant = StateSpace("[-a]", C="[0.3]", symbols={"a": "positive", "T": "positive"})
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        page = text_of(gramian(plant, horizon="T"))
    assert "0.045 - 0.045 exp(-2T a)" in page.replace("a T", "T a") or "0.09" in page


def test_a_line_whose_decimals_fail_their_check_stays_exact(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("symobs.pages.decimals.formulas.significant", lambda *_: "0.5")
    design = state_feedback(StateSpace("[0 1; -0.3 0.7]", "[0; 3]"), poles="-1, -2")
    with pytest.warns(SymobsWarning, match="a line in decimals is left out"):
        page = str(design.to("text"))
    assert "(1/30)[17  37]" in page


def test_captions_of_a_page_in_decimals_have_decimals() -> None:
    """The damping k - 1/4 vanishes at k = 0.25; the ends of what is drawn around it are no whole numbers."""
    plant = StateSpace("[0 1; -3/2 1/4]", "[0; 1]", "[0 1]", symbols={"k": "real"})
    result = stability_region(plant, K="[0 k]", parameters=["k"])
    for name in ("text", "latex", "markdown"):
        exact, decimals = (
            " ".join(str(result.to(name, **how)).replace("$", "").split()).partition("move from the crosses")[2]
            for how in ({"exact": True}, {"digits": 5})
        )
        told = [page.partition("upper end")[0] for page in (exact, decimals)]
        assert ["0.3" in each for each in told] == [False, True]
        assert ["3/10" in each or r"\frac{3}{10}" in each for each in told] == [True, False]
