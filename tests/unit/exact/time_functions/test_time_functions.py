"""Functions of time against numeric computation: mpmath's exponential and quadrature, SymPy's derivative and integral."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from itertools import product
from typing import Any

import mpmath
import pytest
import sympy
from hypothesis import given
from hypothesis import strategies as st

import symobs
from symobs.exact import Matrix, Scalar
from symobs.exact.core.generators import derivative, function
from symobs.exact.time_functions.quasipolynomial import Key, Quasipolynomial, quasi_of
from symobs.ground.errors import CertificateRejected, DerivationRejected, InputError, ShapeMismatch
from symobs.proof.derivation import CaseStep, Section
from symobs.tasks.result.output_methods import to_sympy
from tests.kit import tabled
from tests.support.claims.claims import HOLDS, Setting

t, T = sympy.symbols("t T")
mpmath.mp.dps = 30


def numeric(value: Any, point: dict[str, str]) -> Any:
    """Return a kernel value at a point as an mpmath number or matrix."""
    found = to_sympy(value, {})
    numbers = {sympy.Symbol(name): sympy.Rational(text) for name, text in point.items()}
    if isinstance(found, sympy.MatrixBase):
        cells = [sympy.N(found[i, j].subs(numbers), 30) for i, j in product(range(found.rows), range(found.cols))]
        return mpmath.matrix(found.rows, found.cols) + mpmath.matrix(
            [cells[i * found.cols : (i + 1) * found.cols] for i in range(found.rows)]
        )
    return mpmath.mpf(sympy.N(found.subs(numbers), 30))


def close(left: Any, right: Any) -> bool:
    return bool(mpmath.norm(mpmath.matrix(left) - mpmath.matrix(right), mpmath.inf) < mpmath.mpf(10) ** -15)


@tabled
def test_what_stays_open_about_a_covariance_is_named(A: str, C: str, asked: str) -> None:
    plant = symobs.StateSpace(A, None, C, symbols={"k": "positive", "c": "positive"})
    result = symobs.initial_state_covariance(plant, R="1")
    assert result.verdict == "undecided"
    assert asked in result.question


# -- random plants -----------------------------------------------------------------------------------------------------

entry = st.integers(-3, 3)


# -- branches ----------------------------------------------------------------------------------------------------------


def test_a_discriminant_that_cannot_be_negative_is_not_called_negative() -> None:
    for text, symbols in (("b", {"b": "nonnegative"}), ("b^2 + c^2", None)):
        result = symobs.matrix_exponential(symobs.StateSpace(f"[0 1; {text} 0]", symbols=symbols))
        (condition,) = result.holds_where
        assert (str(condition.expression), condition.operator) == (text.replace("^", "**"), ">")
        assert result.matrix.has(sympy.cosh)
        assert [case.when[0].operator for case in result.case_tree] == ["=="]
        assert result.derivation.check() is not None


def test_roots_are_of_what_is_known_not_to_be_negative() -> None:
    """The branch of one sign is not the answer, nor its page the page, of the other."""
    result = symobs.matrix_exponential(symobs.StateSpace("[0 1; a 0]"))
    (delta,) = result.answer["chosen"]
    assert result.answer["chosen"] == {delta: "negative"}
    for chosen in ({delta: "positive"}, {}):
        with pytest.raises(CertificateRejected, match=r"the claim sqrt\(-a\) is real"):
            result.with_answer("chosen", chosen)
    under, over = (case for case in _cases(result.derivation.steps) if case.when.operators != ("=",))
    for case, operator in ((under, ">"), (over, "<")):
        swapped = replace(case, when=replace(case.when, operators=(operator,)))
        with pytest.raises(DerivationRejected, match=r"the line -a >= 0|the line a >= 0"):
            replace(result.derivation, steps=_with(result.derivation.steps, case, swapped)).check()


def _cases(steps: Any) -> list[Any]:
    found = [step for step in steps if isinstance(step, CaseStep)]
    return found + [case for step in steps if isinstance(step, Section) for case in _cases(step.steps)]


def _with(steps: Any, old: Any, new: Any) -> Any:
    return tuple(
        replace(step, steps=_with(step.steps, old, new)) if isinstance(step, Section) else new if step is old else step
        for step in steps
    )


def test_every_case_names_all_the_signs_it_stands_on() -> None:
    result = symobs.matrix_exponential(symobs.StateSpace("[0 1 0 0; a 0 0 0; 0 0 0 1; 0 0 b 0]"))
    said = {tuple(map(str, case.when)) for case in result.case_tree}
    assert said == {("a > 0",), ("a < 0", "b > 0"), ("a == 0",), ("b == 0",)}
    point = {"t": "1/2", "a": "-2/3", "b": "3/5"}
    (case,) = (case for case in result.case_tree if len(case.when) == 2)
    A = mpmath.matrix([[0, 1, 0, 0], [mpmath.mpf(-2) / 3, 0, 0, 0], [0, 0, 0, 1], [0, 0, mpmath.mpf(3) / 5, 0]])
    assert case.result is not None
    assert close(numeric(case.result.fields["matrix"], point), mpmath.expm(A / 2))
    assert result.derivation.check() is not None


def test_what_stands_on_the_rank_or_on_decay_is_not_said_without_them() -> None:
    grows = symobs.gramian(symobs.StateSpace("[1]", C="[1]"), horizon="inf")
    assert (grows.verdict, grows.matrix) == ("no", None)
    solved = Scalar.rational(-1, 2)
    with pytest.raises(CertificateRejected, match="decay"):
        replace(grows, answer={**grows.answer, "matrix": Matrix.of([[solved]]), "determinant": solved})
    decays = symobs.gramian(symobs.StateSpace("[-1]", C="[1]"), horizon="inf")
    for name in ("matrix", "determinant"):
        with pytest.raises(CertificateRejected, match="missing"):
            decays.with_answer(name, None)
    finite = symobs.gramian(symobs.StateSpace("[-1 0; 0 1]", C="[0 1]"), horizon="T")
    other = {**finite.answer["rank"], "matrix": Matrix.identity(2), "rank": 2}
    with pytest.raises(CertificateRejected, match=r"the claim the blocks are C, C\*A, \.\.\., C\*A\*\*\(n - 1\)"):
        finite.with_answer("rank", other)


def test_equal_rates_are_a_case() -> None:
    result = symobs.matrix_exponential(symobs.StateSpace("[0 1; -a*b a+b]"))
    assert result.verdict == "conditional"
    (case,) = result.case_tree
    assert case.result is not None
    value = numeric(case.result.fields["matrix"], {"a": "2/3", "b": "2/3", "t": "1/2"})
    rate = mpmath.mpf(2) / 3
    assert close(value, mpmath.expm(mpmath.matrix([[0, 1], [-(rate**2), 2 * rate]]) / 2))


def test_what_has_no_closed_form_says_so() -> None:
    plant = symobs.StateSpace("[0 1 0; 0 0 1; -a -1 0]", C="[1 0 0]")
    for result in (symobs.gramian(plant), symobs.initial_state(plant, output="1")):
        assert result.verdict == "undecided"
        assert "s**3 + s + a" in result.question
        assert result.derivation.check() is not None


def test_a_horizon_may_be_a_multiple_of_pi() -> None:
    """S0-Ex4.3-GRAM at T = 2π: π [1 0 1; 0 1 0; 1 0 3] with determinant 2π³; other horizons against the formulas in T."""
    plant = symobs.StateSpace("[0 -1 0; 1 0 1; 0 0 0]", C="[1 0 0]")
    whole = symobs.gramian(plant, horizon="2*pi")
    assert whole.matrix == sympy.pi * sympy.Matrix([[1, 0, 1], [0, 1, 0], [1, 0, 3]])
    assert whole.determinant == 2 * sympy.pi**3
    assert (whole.verdict, whole.conditions, whole.cases) == ("yes", (), ())
    assert r"\int_0^{2\pi}" in whole.to("fragment")
    general = symobs.gramian(plant).matrix
    for text in ("pi/2", "pi/3", "3*pi/4", "5*pi/6", "7*pi/6", "11*pi/4"):
        found = symobs.gramian(plant, horizon=text).matrix
        wanted = general.subs(sympy.Symbol("T"), parse_pi(text))
        assert all(sympy.simplify(entry) == 0 for entry in found - wanted)


def parse_pi(text: str) -> sympy.Expr:
    above, _, below = text.partition("/")
    return sympy.Rational(int(above.split("*")[0]) if "*" in above else 1, int(below)) * sympy.pi


@tabled
def test_horizons_that_are_refused(horizon: str) -> None:
    """π/5 because cos(2π/5) is not written here; it is refused, and the repair says to keep T."""
    with pytest.raises(InputError) as refused:
        symobs.gramian(symobs.StateSpace("[0 1; -1 0]", C="[1 0]"), horizon=horizon)
    assert refused.value.repair


# -- other Gramians ------------------------------------------------------------------------------------------------------


@tabled
def test_gramians_over_all_time(A: str, C: str, dt: int, verdict: str) -> None:
    """Held to Lyapunov's equation in plain fractions; what is hidden may grow."""
    plant = symobs.StateSpace(A, C=C, dt=dt)
    result = symobs.gramian(plant, horizon="inf")
    assert result.verdict == verdict
    assert result.derivation.check() is not None
    HOLDS["gramian"](result, Setting.of(plant, {}, {"a": Fraction(3, 2)}))


# -- initial states ------------------------------------------------------------------------------------------------------


def test_data_that_nothing_explains_are_refused() -> None:
    servo = symobs.StateSpace("[0 1; 0 -1]", "[0; 1]", "[1 0]", "[2]")
    assert symobs.initial_state(servo, output="1 + t^2").verdict == "no"
    assert symobs.initial_state(servo, output="t + 1 + exp(-t)", input="1").x0 == (0, 0)
    assert symobs.initial_state(servo, output="t + 1 + 2*exp(-t)", input="1").x0 == (1, -1)
    twice = symobs.initial_state(symobs.StateSpace("[0 1; -1 0]", C="[1 0; 1 0]"), output=["cos(t)", "sin(t)"])
    assert twice.verdict == "no"
    assert twice.fields["x0"] is None
    assert twice.derivation.check() is not None
    hidden = symobs.initial_state(symobs.StateSpace("[-1 0; 0 1]", C="[0 1]"), output="3*exp(t)")
    assert (hidden.verdict, hidden.x0, len(hidden.kernel)) == ("no", (0, 3), 1)


def test_a_state_that_does_not_explain_the_data_is_rejected() -> None:
    result = symobs.initial_state(symobs.StateSpace("[0 1; -1 0]", C="[1 0]"), output=sympy.sin(t))
    assert result.x0 == (0, 1)
    with pytest.raises(CertificateRejected, match=r"the claim y_0 = C\*exp_At\*x_0 does not hold"):
        result.with_answer("x0", Matrix.column([Scalar.of(0), Scalar.of(2)]))


@tabled
def test_what_is_no_sum_of_exponentials_is_refused(output: str) -> None:
    with pytest.raises(InputError):
        symobs.initial_state(symobs.StateSpace("[0 1; 0 0]", C="[1 0]", symbols={}), output=output)


def test_wrong_questions_are_refused() -> None:
    plant = symobs.StateSpace("[0 1; 0 0]", "[0; 1]", "[1 0]")
    with pytest.raises(ShapeMismatch, match=r"specification\.output: output has 2×1 entries, expected a column of 1"):
        symobs.initial_state(plant, output=["1", "t"])
    with pytest.raises(InputError, match=r"specification\.horizon: the horizon -1 is not positive"):
        symobs.gramian(plant, horizon="-1")
    with pytest.raises(InputError, match=r"specification\.R: the intensity R of the output noise is missing"):
        symobs.initial_state_covariance(plant, Q="1")


# -- the kernel ----------------------------------------------------------------------------------------------------------

terms = st.tuples(st.integers(0, 2), st.integers(-2, 2), st.sampled_from(["", "cos", "sin"]), st.integers(1, 3), entry)


def quasi(drawn: list[tuple[int, int, str, int, int]]) -> Quasipolynomial:
    return Quasipolynomial.of(
        (Key(n, Scalar.of(rate), wave, Scalar.of(w if wave else 0)), Scalar.of(c)) for n, rate, wave, w, c in drawn
    )


@given(st.lists(terms, max_size=3), st.lists(terms, max_size=3))
def test_sums_multiply_and_integrate_as_functions_do(left: Any, right: Any) -> None:
    f, g, time = quasi(left), quasi(right), Scalar.symbol("t")
    expression = to_sympy(f.value_at(time), {})
    point = {t: sympy.Rational(3, 5)}
    together = to_sympy((f * g).value_at(time), {}).subs(point)
    assert abs(sympy.N((expression * to_sympy(g.value_at(time), {})).subs(point) - together, 30)) < 1e-20
    assert f.integral().derivative() == f
    assert f.integral().at_zero.is_zero
    rate = to_sympy(f.derivative().value_at(time), {}).subs(point)
    assert abs(sympy.N(sympy.diff(expression, t).subs(point) - rate, 30)) < 1e-20
    assert quasi_of(f.value_at(time)) == f
    assert derivative(f.value_at(time)) == f.derivative().value_at(time)


def test_functions_of_time_keep_their_frequencies() -> None:
    """cos 900t is not written in cos t, e^{-900t} not in e^{-t}; cosh is two exponentials; cos a cos b is a sum."""
    time, half = Scalar.symbol("t"), Scalar.of(Fraction(1, 2))
    value = function("cos", time * 900) * function("cos", time) + time * function("cosh", time * 2) / function(
        "exp", time * 900
    )
    zero, one = Scalar.of(0), Scalar.of(1)
    assert quasi_of(value).terms == {
        Key(0, zero, "cos", Scalar.of(899)): half,
        Key(0, zero, "cos", Scalar.of(901)): half,
        Key(1, Scalar.of(-898), "", zero): half,
        Key(1, Scalar.of(-902), "", zero): half,
    }
    for text in (function("exp", time * time), one / time, function("cos", time) / function("cos", time * 2)):
        with pytest.raises(ValueError, match="is not a sum of exponentials, sines and cosines times powers of t"):
            quasi_of(text)


# -- lengths -------------------------------------------------------------------------------------------------------------


@tabled
def test_a_horizon_that_may_be_zero_is_said_to_be_positive(asked: dict[str, Any]) -> None:
    """At T = 0 the Gramian is 0 and sees nothing, though the finite sum has rank 2."""
    plant = symobs.StateSpace("[0 1; 0 0]", C="[1 0]", **asked)
    results = (
        symobs.gramian(plant, horizon="T"),
        symobs.initial_state(plant, horizon="T", output="t"),
        symobs.initial_state_covariance(plant, horizon="T", R="1"),
    )
    for result in results:
        assert [(c.kind, str(c)) for c in result.holds_where] == [("domain", "T > 0")]
        assert "Throughout, we assume $T>0$." in result.to_latex()


# -- exponents and angles far apart ----------------------------------------------------------------------------------


def test_a_constant_exponent_is_that_of_a_quotient() -> None:
    """At T = 1 the determinant holds e² e^{(2a+6)/(a+1)}, which is (e^{(2a+4)/(a+1)})², by 1 = (a + 1)/(a + 1)."""
    result = symobs.gramian(symobs.StateSpace("[1 0; 0 (a+3)/(a+1)]", C="[1 1]"), horizon="1")
    assert result.to_latex()
    found = to_sympy(result.answer["determinant"], {}).subs(sympy.Symbol("a"), 1)
    e_t = sympy.Matrix([[sympy.exp(t), sympy.exp(2 * t)]])
    W = (e_t.T * e_t).applyfunc(lambda entry: sympy.integrate(entry, (t, 0, 1)))
    assert abs(sympy.N(found - W.det(), 30)) < 1e-20


FAR_APART = (
    lambda: symobs.matrix_exponential(symobs.StateSpace("[-0.12345 0; 0 -5.6789]")),
    lambda: symobs.matrix_exponential(symobs.StateSpace("[-0.5 1; 0 -5000000]")),
    lambda: symobs.matrix_exponential(symobs.StateSpace("[0 1.234 0 0; -1.234 0 0 0; 0 0 0 5.678; 0 0 -5.678 0]")),
    lambda: symobs.gramian(symobs.StateSpace("[-0.12345 0; 0 -5.6789]", C="[1 1]"), horizon="T"),
    lambda: symobs.response(symobs.StateSpace("[-1]", "[1]", "[1]"), input="sin(314.159*t)+sin(1000*t)"),
    lambda: symobs.response(
        symobs.StateSpace.from_transfer_function("1/((0.0123*s+1)*(0.4567*s+1)*(7.891*s+1))"), input="1"
    ),
)


@pytest.mark.parametrize("solve", FAR_APART)
def test_exponents_and_angles_far_apart(solve: Any) -> None:
    """Plants with time constants and frequencies of several digits have their answers and their pages."""
    result = solve()
    assert result.verdict == "yes"
    assert result.to_json()
    assert result.to_latex()
