"""Functions of parameters beside hidden modes, in equations of cases, and in desired poles: a page for every answer."""

from __future__ import annotations

from typing import Any

import sympy

import symobs
from tests.kit import tabled

S = symobs.StateSpace


@tabled
def test_conditions_cases_and_page(
    task: str, data: dict[str, Any], asked: Any, conditions: list[str], cases: list[str]
) -> None:
    result = getattr(symobs, task)(symobs.StateSpace(**data), **asked)
    alternatives = (each.args if isinstance(each, sympy.Or) else (each,) for each in result.conditions)
    assert [" or ".join(sorted(str(part.lhs) for part in parts)) for parts in alternatives] == conditions
    assert not cases or [str(case.when[0].lhs) for case in result.cases] == cases
    assert result.to("latex")
    assert result.to_json()


def test_a_rank_that_drops_where_a_cosine_vanishes_has_a_page() -> None:
    """Where cos b = 0 the sine is 1 or -1: two cases, of which the page has to know that they are all."""
    found = symobs.observability(symobs.StateSpace("[a 0; b*exp(a) 0]", C="[cos(b) 0; 1-exp(b) -1]"))
    assert [[str(relation.lhs) for relation in case.when] for case in found.cases] == [
        ["cos(b)", f"sin(b) {sign} 1", "a*exp(b) - a + b*exp(a)"] for sign in "+-"
    ]
    assert found.to("text").count("Case ") == 2


@tabled
def test_pages_beside_letters_and_roots(task: str, data: dict[str, Any], asked: dict[str, str]) -> None:
    assert getattr(symobs, task)(S(**data), **asked).to("text")


def test_an_input_has_the_exponentials_of_its_plant() -> None:
    """By hand, W₂λ = d with 𝒞₂ = [−1, e^b − 1; sin b, (a − 1) sin b]: u = 𝒞₂⁻¹ d, and det 𝒞₂ = (2 − a − e^b) sin b."""
    plant = S("[1-exp(b) 0; sin(b) a]", "[-1; sin(b)]", dt=True)
    page = symobs.minimum_energy_input(plant, final=["1", "1"], horizon="2").to("text")
    assert "Case 1 + cos(b) ≠ 0, cos(b) ≠ 1, a ≠ 2 - exp(b)." in page
    assert "(1/((a - 2)sin(b) + exp(b)sin(b)))" in page
    assert "not decided" not in page


def test_an_equation_that_factors_beside_another_leaves_its_case_undecided() -> None:
    """Where c e^x = 1, (c − cos y)(sin y − e^x) = c sin y − 1 − cos y sin y + e^x cos y is a product: two sets, two ranks."""
    plant = S("[0 0; exp(x) c*sin(y)]", "[exp(-x)-c -1; 0 exp(-x)]", "[c-cos(y) 0]", dt=True)
    found = symobs.output_regulation(plant, S="[1]", reference="[2]", poles="-1/2-3*I, -1/2+3*I")
    assert found.to_json()

    def undecided(result: Any) -> int:
        return sum(1 if case.result is None else undecided(case.result) for case in result.cases)

    assert undecided(found) == 1
