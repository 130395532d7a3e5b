"""The powers Aᵏ in k: at the first instants they are the products of A, in SymPy's numbers."""

from __future__ import annotations

import random
from typing import Any

import pytest
import sympy

import symobs
from symobs import StateSpace
from symobs.ground.errors import InputError, SymobsError
from symobs.problem import read
from symobs.problem.expect import mismatches
from symobs.problem.question import question_of
from symobs.tasks.result import render
from tests.kit import tabled
from tests.support.sampling import seeds

k = sympy.Symbol("k")
#: Matrices of one to three states: a real, a double, a nilpotent, a turning and an irrational pair of modes.
_BLOCKS = ("[r]", "[0]", "[r, 1; 0, r]", "[0, 1; 0, 0]", "[r, q; -q, r]", "[0, 1; 1, r]", "[0, 1; q, 0]")
#: All are drawn where there is time.
SEEDS = seeds(15)


def drawn(chance: random.Random) -> Any:
    """Return a block diagonal matrix in other coordinates."""
    blocks: list[Any] = []
    while sum(block.rows for block in blocks) < chance.randint(1, 3):
        r, q = (sympy.Rational(chance.choice([-3, -2, -1, 1, 2]), chance.choice([1, 2, 3])) for _ in range(2))
        rows = [
            [{"r": r, "q": q, "-q": -q}.get(entry.strip(), entry.strip()) for entry in row.split(",")]
            for row in chance.choice(_BLOCKS)[1:-1].split(";")
        ]
        blocks.append(sympy.Matrix([[sympy.Rational(entry) for entry in row] for row in rows]))
    whole = sympy.diag(*blocks)
    T = sympy.eye(whole.rows) + sympy.Matrix(whole.rows, whole.rows, lambda i, j: chance.randint(-2, 2) if i < j else 0)
    return T * whole * T.inv()


@pytest.mark.parametrize("seed", SEEDS)
def test_the_powers_are_the_products(seed: int) -> None:
    A = drawn(random.Random(seed))  # noqa: S311 - repeats
    found = symobs.matrix_exponential(StateSpace([[str(entry) for entry in row] for row in A.tolist()], dt=True))
    assert found.verdict == "yes"
    for at in (0, 1, 2, 3, 7):
        difference = found.matrix.subs(k, at) - A**at
        assert max(abs(complex(entry)) for entry in difference) < 1e-9 * (1 + max(map(abs, A**at)))


def test_powers_with_parameters_have_their_cases() -> None:
    a, b = sympy.symbols("a b")
    found = symobs.matrix_exponential(StateSpace("[a 0; 1 b]", dt=True))
    assert found.matrix == sympy.Matrix([[a**k, 0], [(a**k - b**k) / (a - b), b**k]])
    (double,) = found.cases
    assert str(double.when[0]) == "Eq(a - b, 0)"
    assert double.result.matrix[1, 0] == k * b**k / b
    (singular,) = double.result.cases
    assert singular.result.matrix[1, 0] == sympy.KroneckerDelta(k, 1)
    for kind in ("text", "latex", "html", "json"):
        found.to(kind)
    text = found.to("text")
    assert "(k/b)bᵏ" in text
    assert "δ is 1 where its arguments are equal" in text


def test_powers_without_closed_form_are_undecided() -> None:
    found = symobs.matrix_exponential(StateSpace("[0 1 0; 0 0 1; -1/3 0 1]", dt=True))
    assert found.verdict == "undecided"
    assert "The powers of A are not given" in found.to("text")


def test_the_instant_is_no_parameter() -> None:
    with pytest.raises(InputError, match="k is the number of the instant"):
        symobs.matrix_exponential(StateSpace("[k]", dt=True))


# -- the response in steps ---------------------------------------------------------------------------------------------


@pytest.mark.parametrize("seed", SEEDS)
def test_the_response_follows_the_recursion(seed: int) -> None:
    """The state is A x + B u step by step, for sequences, powers of k times powers of numbers, and no input at all."""
    chance = random.Random(seed)  # noqa: S311 - repeats
    A = drawn(chance)
    n = A.rows
    B, C, start = (sympy.Matrix(r, c, lambda *_: chance.randint(-2, 2)) for r, c in ((n, 1), (1, n), (n, 1)))
    r, d = sympy.Rational(chance.choice([-2, -1, 1, 3]), chance.choice([1, 2])), chance.randint(0, 2)
    given: Any = {
        0: (None, lambda _: 0),
        1: ("3, 0, -1, 1/2", lambda at: [3, 0, -1, sympy.Rational(1, 2)][at] if at < 4 else 0),
        2: (f"1 + k^{d}*({r})^k", lambda at: 1 + sympy.Integer(at) ** d * r**at),
        3: ("k^2 - 2", lambda at: at**2 - 2),
    }
    text, value = given[chance.randrange(4)]
    asked: Any = {"initial": [[str(entry)] for entry in start]} | ({} if text is None else {"input": text})
    a, b, c = ([[str(entry) for entry in row] for row in matrix.tolist()] for matrix in (A, B, C))
    found = symobs.response(StateSpace(a, b, c, [[str(d)]], dt=True), **asked)
    state = start
    for at in range(7):
        scale = 1e-9 * (1 + max(map(abs, state)))
        assert max(abs(complex(entry)) for entry in sympy.Matrix(found.state).subs(k, at) - state) < scale
        seen = (C * state)[0] + d * value(at)
        assert abs(complex(sympy.Matrix([found.output]).subs(k, at)[0] - seen)) < 10 * scale * (1 + abs(seen))
        state = A * state + B * value(at)


def test_a_resonant_input_is_a_case_and_pages_are_checked() -> None:
    a, b = sympy.symbols("a b")
    found = symobs.response(StateSpace("[a]", "[1]", "[1]", dt=True), input="b^k")
    assert sympy.simplify(found.state[0] - (a**k - b**k) / (a - b)) == 0
    (resonant,) = found.cases
    assert resonant.result.state[0] == k * b**k / b
    text = symobs.response(StateSpace("[1/2]", "[1]", "[1]", dt=True), input="1, 0, 2").to("text")
    assert "u(k) = δ(k, 0) + 2δ(k, 2)" in text
    assert "The state satisfies the difference equation" in text
    free = symobs.response(StateSpace("[1/2]", "[1]", "[1]", dt=True), initial="[4]")
    assert "x(k) = Aᵏ x₀" in free.to("text")


def test_values_and_questions_read_what_the_task_reads() -> None:
    """C bᵏ + 1 drives x(k + 1) = a x + u: at a = 2, b = 3, c = 5 that is 5 (3ᵏ − 2ᵏ) + 2ᵏ − 1."""
    plant = StateSpace("[a]", "[1]", "[1]", dt=True)
    found = symobs.response(plant, input="c*b^k + 1").at(a=2, b=3, c=5)
    assert sympy.expand(found.state[0] - (5 * 3**k - 4 * 2**k - 1)) == 0
    samples = symobs.initial_state(StateSpace("[0 1; -1/2 1]", None, "[1 0]", dt=True), output="1, y")
    assert list(samples.at(y=3).x0) == [1, 3]
    text = 'task = "response"\n[plant]\nA = "[1/2]"\nB = "[1]"\ndt = true\n[specification]\ninput = "1, 0, 2"\n'
    assert "The input from k = 0 on is [1 0 2]" in str(render(question_of(read(text)), "text"))


@tabled
def test_powers_of_k_are_read_where_an_answer_is_expected(A: str, powers: str, *, is_met: bool) -> None:
    data = f'task = "matrix_exponential"\n[symbols]\na = "real"\n[plant]\nA = "{A}"\ndt = true\n'
    found = read(f'{data}[expect]\nmatrix = "{powers}"\n')
    assert (not mismatches(found.solve(), found.expect)) == is_met


def test_sequences_that_are_equal_at_first_are_undecided() -> None:
    """Re iᵏ = cos πk/2: both are 1, 0, −1, 0, …, and nothing here says that of all k."""
    data = 'task = "matrix_exponential"\n[plant]\nA = "[0 1; -1 0]"\ndt = true\n'
    cosine, sine = "cos(pi*k/2)", "sin(pi*k/2)"
    found = read(f'{data}[expect]\nmatrix = "[{cosine} {sine}; -{sine} {cosine}]"\n')
    with pytest.raises(SymobsError, match="equal at the first 12 instants"):
        mismatches(found.solve(), found.expect)


def test_an_exponent_that_is_no_number_of_steps_is_refused() -> None:
    plant = StateSpace("[1/2]", "[1]", "[1]", dt=True)
    for given in ("2^(k^2)", "k^k", "i^k"):
        with pytest.raises(InputError, match="is no number of steps"):
            symobs.response(plant, input=given)
