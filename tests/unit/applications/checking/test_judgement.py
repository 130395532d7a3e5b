"""The check of answers: claims decide, so any valid answer is right and nothing else is."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import pytest
import sympy as sp

from symobs.applications.checking import Checked, CheckReport, check
from symobs.ground.errors import InputError, ProblemErrors
from symobs.pages.cards import CardPrinter, cards
from symobs.problem import read
from symobs.problem.expect import found_in, mismatches
from symobs.tasks.result.output_methods import to_json
from tests.kit import tabled
from tests.support.paths import ROOT
from tests.support.problems.answered import SERVO, THIRD_ORDER, A, F, K, L, S, text

if TYPE_CHECKING:
    from collections.abc import Iterator

EXAMPLES = ROOT / "worked_examples"


def one(report: CheckReport, name: str) -> Any:
    """The part of this field."""
    return next(part for part in report.parts if part.part.endswith(f".{name}"))


def own_answer(checked: Checked) -> dict[str, dict[str, Any]]:
    """The answers of symobs itself, in the letters of the file."""
    answer: dict[str, dict[str, Any]] = {}
    for view, name in checked.asked(checked.views()):
        letter = next((own for own, (standard, _) in view.names.items() if standard == name), name)
        found = to_json(found_in(view, letter))
        decimals = getattr(view.result, "decimals", {})  # where no square root writes it
        answer.setdefault(view.task, {})[letter] = decimals[name] if found is None else found
    return answer


@pytest.mark.slow
def test_our_own_answer_is_right_in_every_worked_example() -> None:
    tasks = set()
    for path in sorted(EXAMPLES.glob("*.toml")):
        checked = Checked.of(read(path.read_text("utf-8"), path.name, EXAMPLES))
        tasks |= {result.task for result in checked.results}
        report = checked.report(own_answer(checked))
        too_long = path.stem == "cart_pole"  # its F has 35,615 characters
        assert report.verdict == ("unreadable" if too_long else "right"), (path.name, report.to_text())
        printed = {part: checked.report(latex) for part, latex in _printed(checked)} if not too_long else {}
        found = {part.part: part.verdict for name, each in printed.items() for part in each.parts if part.part == name}
        assert path.stem in _NOT_WRITTEN_SO or {*found.values()} <= {"right"}, (path.name, found)
    assert len(tasks) == 36


#: A sequence as a column, and cos 2√… without brackets.
_NOT_WRITTEN_SO = {"minimum_energy_sequence", "pendulum_gramian"}


def _printed(checked: Checked) -> Iterator[tuple[str, str]]:
    """Yield the parts that are asked for with the LaTeX that shows them."""
    convention = checked.problem.convention
    for view, field in checked.asked(checked.views()):
        printer = CardPrinter(view.result, convention)
        for card in cards(view.result, [field], convention):
            yield f"{view.task}.{field}", printer.latex(card) + "\n"


# -- gains: the claim decides -----------------------------------------------------------------------------------------


def test_a_single_value_is_the_one_part_that_is_asked_for() -> None:
    problem = '[plant]\nA = "[0 1; 0 -1]"\nC = "[1 0]"\n[specification]\npoles = "-10, -10"\n'
    assert check(f'task = "observer"\n{problem}', sp.Matrix([19, 81])).verdict == "right"
    with pytest.raises(InputError, match="3 parts are asked for"):
        check(SERVO, sp.Matrix([19, 81]))


def test_what_no_task_has_is_an_error_with_the_known_fields() -> None:
    with pytest.raises(ProblemErrors, match=r"answer\.M: no task here has such a field; known: .*K, L, F"):
        check(SERVO, {"M": "[19; 81]"})


def test_both_gains_of_integral_action_have_the_sign_of_the_convention() -> None:
    report = check(read(TWO_INTEGRATORS), {"K": "[-3 -1; 0 -3]", "k_I": "[2 0; 0 2]"}, convention="plusK-plusMC")
    assert [part.verdict for part in report.parts] == ["right", "right"]


def test_decimals_are_exact() -> None:
    plant = 'task = "transfer_function"\n[plant]\nA = "[-1/3]"\nB = "[1]"\nC = "[1/3]"\n'
    wrong = check(plant, {"transfer_function": "0.333/(s + 0.333)"}).parts[0]
    assert (wrong.verdict, wrong.slip, wrong.credit) == ("wrong", "rounded", sp.Rational(1, 2))
    assert check(plant, {"transfer_function": "1/(3 s + 1)"}).verdict == "right"
    one_percent_off = check(plant, {"transfer_function": "1.01/(3 s + 1)"}).parts[0]
    assert (one_percent_off.verdict, one_percent_off.slip) == ("wrong", "one_coefficient")
    accepted = f'{plant}[marking]\ndecimals = "accept"\n'
    assert check(accepted, {"transfer_function": "0.333/(s + 0.333)"}).verdict == "right"


# -- what follows -----------------------------------------------------------------------------------------------------


def test_what_follows_from_a_wrong_gain() -> None:
    wrong = L + sp.Matrix([1, 0, 0])
    R = S * sp.eye(3) - A
    B, C = sp.Matrix([1, 0, 2]), sp.Matrix([[1, 1, 0]])
    followed = sp.cancel((K * (R + B * K + wrong * C).inv() * wrong)[0])
    report = check(THIRD_ORDER, {"K": text(K), "L": text(wrong), "F": str(followed)})
    part = one(report, "F")
    assert (part.verdict, part.origins, part.credit) == ("follows", ("compensator.L",), 1)
    assert (report.verdict, report.score) == ("wrong", sp.Rational(5, 2))  # K 1, L 1/2 for one entry, F 1
    right_all_the_same = check(THIRD_ORDER, {"K": text(K), "L": text(wrong), "F": str(F)})
    assert one(right_all_the_same, "F").verdict == "right"


def test_another_compensator_with_the_same_closed_loop_is_right() -> None:
    """F = (a s² + b s + c)/(s² + d s + e) closes s (s + 1) to (s + 2)²(s + 10)² for every a: a proper one, too."""
    a, b, c, d, e = sp.symbols("a b c d e")
    loop = sp.Poly(S * (S + 1) * (S**2 + d * S + e) + a * S**2 + b * S + c - (S + 2) ** 2 * (S + 10) ** 2, S)
    found = sp.solve([equation.subs(a, 5) for equation in loop.all_coeffs()], [b, c, d, e])
    proper = f"(5 s^2 + {found[b]} s + {found[c]})/(s^2 + {found[d]} s + {found[e]})"
    part = one(check(SERVO, {"F": proper}), "F")
    assert (part.verdict, part.hints) == ("right", ("another compensator with the same closed-loop polynomial",))


@tabled
def test_functions_far_apart_are_compared(entry: str) -> None:
    problem = 'task = "matrix_exponential"\n[plant]\nA = "[0 1; -2 -3]"\n'
    part = check(problem, {"matrix": f"[({entry}) 0; 0 1]"}).parts[0]
    assert part.verdict == "wrong"
    expected = read(f'{problem}[expect]\nmatrix = "[({entry}) 0; 0 1]"\n')
    assert mismatches(expected.viewed(expected.solve()), expected.expect)


# -- coordinates ------------------------------------------------------------------------------------------------------


def test_rows_of_a_block_may_be_permuted_and_kernels_have_any_basis() -> None:
    problem = 'task = "observability"\n[plant]\nA = "[0 1 0; 0 0 0; 0 0 0]"\nC = "[1 0 0; 1 1 0]"\n'
    problem += '[marking]\nasked = ["observability.matrix", "observability.kernel"]\n'
    report = check(problem, {"matrix": "[1 1 0; 1 0 0; 0 1 0; 0 1 0; 0 0 0; 0 0 0]", "kernel": ["[0; 0; -7]"]})
    assert report.verdict == "right"
    assert "another order" in report.parts[0].hints[0]
    assert check(problem, {"kernel": ["[0; 1; 0]"]}).parts[1].verdict == "wrong"


TWO_INTEGRATORS = """
task = "integral_action"
plant = { A = "[0 0; 0 0]", B = "[1 0; 0 1]", C = "[1 0; 0 1]" }
specification = { poles = "-1, -1, -2, -2" }
"""


@tabled
def test_the_gains_of_integral_action_are_judged_together(problem: str, answer: dict[str, str], verdicts: str) -> None:
    report = check(read(problem), answer)
    assert " ".join(one(report, name).verdict for name in ("K", "k_I")) == verdicts
    if "undecided" in verdicts:
        part = one(report, "K")
        assert (part.given, part.reason) == ("[3 1; 0 3]", "K and k_I are right together: give both")
