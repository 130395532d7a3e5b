"""What leaves the library of large answers: the same as SymPy and the plain encoders would make, bounded and made once."""

from __future__ import annotations

import random

import pytest
import sympy

import symobs
from symobs.exact import Scalar
from symobs.exact.sympy_bridge.conversion import scalar_to_sympy
from symobs.ground.errors import UsageError

NAMES = ["a", "b", "x_1", "zeta", "A", "s"]


def polynomial(rng: random.Random, names: list[str], terms: int, degree: int) -> Scalar:
    total = Scalar.of(0)
    for _ in range(terms):
        term = Scalar.of(rng.choice([1, -1, 2, -3, 7, 12]))
        for _ in range(rng.randrange(degree + 1)):
            term = term * Scalar.symbol(rng.choice(names))
        total = total + term
    return total


def by_sympy(value: Scalar, objects: dict[str, sympy.Symbol]) -> sympy.Expr:
    """The expression as SymPy's own operators build it."""

    def built(part: Scalar) -> sympy.Expr:
        powers = ([objects.get(name, sympy.Symbol(name)) ** k for name, k in pairs] for _, pairs in part.terms())
        numbers = (sympy.Integer(number) for number, _ in part.terms())
        return sympy.Add(*(sympy.Mul(number, *factors) for number, factors in zip(numbers, powers, strict=True)))

    return built(value.numerator) / built(value.denominator)


@pytest.mark.parametrize("seed", range(24))
def test_long_expressions_are_those_of_sympy(seed: int) -> None:
    rng = random.Random(seed)  # noqa: S311 - only for variety
    names = NAMES[: rng.randrange(2, 7)]
    objects = [{}, {"a": sympy.Symbol("a", positive=True)}, {"b": sympy.Dummy("b")}][seed % 3]
    value = polynomial(rng, names, rng.choice([60, 120, 200]), 6)
    below = [Scalar.of(1), Scalar.of(6), polynomial(rng, names, 3, 4), polynomial(rng, names, 90, 4)][seed % 4]
    value = value / below
    found, expected = scalar_to_sympy(value, objects), by_sympy(value, objects)
    assert found == expected
    assert sympy.srepr(found) == sympy.srepr(expected)
    assert str(found - expected) == "0"


def test_what_is_shown_of_a_large_answer_is_short() -> None:
    entries = [[f"a{row}{column}" for column in range(3)] for row in range(3)]
    design = symobs.observer(symobs.StateSpace(entries, C=[["c0", "c1", "c2"]]), poles=["p0", "p1", "p2"])
    terms = sum(entry.numerator.size + entry.denominator.size for entry in design.answer["L"].entries)
    assert terms > 500
    assert repr(design).startswith("ObserverDesign(L=<")
    assert len(repr(design)) < 300
    assert "holds_where" not in vars(design)  # nothing was worked out for it


def test_options_that_no_page_has_are_refused_with_those_that_it_has() -> None:
    result = symobs.observability(symobs.StateSpace("[0 1; 0 0]", C="[1 0]"))
    with pytest.raises(UsageError, match=r"^details: no page has this option; known options are convention, detail, "):
        result.to("html", details=True)  # type: ignore[call-overload]
    with pytest.raises(UsageError, match=r"^language: '3' is not a language of pages; use one of en, "):
        result.to_html(language=3)  # type: ignore[arg-type]


def test_a_notebook_shows_answers_in_a_line_and_a_plant_as_its_equations() -> None:
    plant = symobs.StateSpace("[0 1; -omega^2 0]", "[0; 1]", "[1 0]", symbols={"omega": "positive"})
    shown = symobs.observer(plant, poles="-1, -1")._repr_mimebundle_()
    assert set(shown) == {"text/plain", "text/markdown", "text/html"}  # LaTeX would need TikZ, which nbconvert lacks
    assert shown["text/plain"].count("\n") == 0
    assert plant._repr_latex_() == (
        r"$\displaystyle \dot{x} = \left[\begin{matrix}0 & 1\\- \omega^{2} & 0\end{matrix}\right] x + "
        r"\left[\begin{matrix}0\\1\end{matrix}\right] u,\qquad y = \left[\begin{matrix}1 & 0\end{matrix}\right] x$"
    )
    discrete = symobs.StateSpace("[1]", "[1]", dt=True)._repr_latex_()
    assert discrete.startswith(r"$\displaystyle x(k+1) = ")
    assert discrete.endswith("u(k)$")
