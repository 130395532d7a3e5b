"""What sentences say of polynomials, their roots, and how many of a thing there are (trusted)."""

from __future__ import annotations

from fractions import Fraction
from itertools import dropwhile, takewhile
from typing import TYPE_CHECKING, Any

from symobs.exact import Scalar, from_coefficients, rank
from symobs.exact.core.generators import function
from symobs.exact.time_functions.matrix_power import modes_of
from symobs.formula.phrases.languages import Counted
from symobs.formula.tree import (
    Derivative,
    Exact,
    Formula,
    Letter,
    Literal,
    Power,
    Product,
    Quotient,
    Relation,
    Roots,
    Sum,
    SymbolList,
    evaluate,
)
from symobs.formula.tree.calculus import TIME
from symobs.proof.certificate.claims import as_scalar
from symobs.proof.derivation.facts import PREDICATES
from symobs.proof.derivation.sentence_context import (
    SentenceContext,
    characteristic_of,
    is_shown_in,
    is_value,
    letter_of,
    number_of,
)
from symobs.proof.derivation.steps import everything_in
from symobs.proof.derivation.wording_of_equations import sums
from symobs.proof.derivation.wording_of_pairs import ranked_matrix

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from symobs.formula.tree import Environment


def one_higher(value: Fraction) -> Fraction:
    """Return a positive number with its third digit one higher.  Raises ValueError for another number."""
    if value <= 0:
        raise ValueError(value)
    unit = Fraction(1)
    while value >= 1000 * unit:
        unit *= 10
    while value < 100 * unit:
        unit /= 10
    return value + unit


def exponential(exponent: Callable[[Mapping[str, Any]], Scalar]) -> Callable[[Relation, Environment], bool]:
    """Return the check that a relation begins with e to this power, given by the values of the letters."""

    def is_said(relation: Relation, environment: Environment) -> bool:
        stated = evaluate(relation.members[0], environment, Exact(environment))
        return bool(stated == function("exp", exponent(environment.values)))

    return is_said


def is_of_loop(said: SentenceContext, name: str) -> bool:
    """Return whether a property of the loop's polynomial φ_c φ_o is among the facts."""
    here, loop = said.environment, Product((Letter("phi_c"), Letter("phi_o")))
    return any(is_shown_in(here, subject, "=", loop) for subject in said.subjects(name))


def shows_it(said: SentenceContext) -> bool:
    """Return whether the properties, or roots, are of a polynomial that was displayed, or spoken of, last before."""
    last = [member for fact in said.environment.shown if isinstance(fact, Relation) for member in fact.members]
    about = [*said.subjects(), *(told.polynomial for told in said.of(Roots))]
    return bool(about) and all(subject in last for subject in about)


def is_defective(said: SentenceContext) -> bool:
    """Return whether a pole of φ_c is met more often than a matrix X lacks in rank, φ_c(s + pole) being det(sI − X)."""
    ranked = [ranked_matrix(fact) for fact in said.facts if isinstance(fact, Relation)]
    matrices = [formula for formula in ranked if formula is not None]
    poles = [root.centre for told in said.of(Roots) for root in told.values]
    environment = said.environment
    if len(matrices) != 1 or len(poles) != 1 or "phi_c" not in environment.values:
        return False
    (matrix,), (pole,), variable = matrices, poles, environment.variable
    X, phi = (evaluate(formula, environment, Exact(environment)) for formula in (matrix, Letter("phi_c")))
    polynomial = phi.substitute({variable: Scalar.symbol(variable) + pole})
    if X.characteristic_polynomial(variable) != polynomial:
        return False
    times = sum(1 for _ in takewhile(lambda c: c.is_zero, reversed(polynomial.coefficients(variable))))
    lacking: int = polynomial.degree(variable) - rank(X)
    told = tuple(said.slots[name] for name in ("mode", "times"))
    return lacking < times and told == tuple(map(Literal, modes_of_double(pole, variable)))


def modes_of_double(pole: Scalar, variable: str) -> tuple[Scalar, Scalar]:
    """Return e^{λt} and t e^{λt}, in discrete time λᵏ and k λᵏ."""
    if variable == "z":
        first, second = modes_of((Scalar.symbol("z") - pole) ** 2, "z")
        return first, second
    mode = function("exp", pole * Scalar.symbol(TIME))
    return mode, Scalar.symbol(TIME) * mode


def is_of_damping(said: SentenceContext) -> bool:
    """Return whether the factor s² + 2ζω s + ω² is there, of the damping ratio and the frequency told."""
    damping, frequency, s = said.slots["damping"], said.slots["frequency"], Letter("s")
    if not isinstance(damping, Formula) or not isinstance(frequency, Formula):
        return False
    pair = Sum((Power(s, 2), Product((number_of(2), damping, frequency, s)), Power(frequency, 2)))
    return pair in everything_in(said.slots["pair"])


def shares_roots(said: SentenceContext, of: str, phi: str) -> bool:
    """Return whether the polynomials of the roots told divide φ and det(sI − A)."""
    here, both = said.environment, (letter_of(phi), characteristic_of(of, said.environment))
    return all(
        is_value(here, "polynomial", Quotient(each, told.polynomial)) for told in said.of(Roots) for each in both
    )


def degree_of(relation: Relation | None, environment: Environment) -> int | None:
    """Return the degree of the polynomial that a definition introduces, None where there is no such."""
    if relation is None:
        return None
    value = as_scalar(evaluate(relation.members[0], environment, Exact(environment)))
    return len(value.coefficients(environment.variable)) - 1


def counts_degree(said: SentenceContext) -> bool:
    """Return whether the number told is the degree of what is introduced."""
    return said.slots["count"] == Counted("number", degree_of(said.introduced, said.environment) or 0)


def counts_dominant(said: SentenceContext) -> bool:
    """Return whether beside the pair −σ ± iω the nearest root has the real part −factor σ."""
    factor, relation, environment = said.slots["factor"], said.introduced, said.environment
    if not counts_degree(said) or relation is None or not isinstance(factor, Counted):
        return False
    whole = as_scalar(evaluate(relation.members[0], environment, Exact(environment)))
    sigma, omega = (as_scalar(environment.values[name]) for name in ("sigma_d", "omega_d"))
    s = Scalar.symbol(environment.variable)
    others = whole / ((s + sigma) * (s + sigma) + omega * omega)
    moved = others.substitute({environment.variable: s - sigma * factor.count}).coefficients(environment.variable)
    left = tuple(reversed([*dropwhile(lambda c: c.is_zero, reversed(moved))]))
    is_stable = PREDICATES["stable"](from_coefficients(left, environment.variable), environment, False)  # noqa: FBT003
    return factor == Counted("number", factor.count) and len(left) < len(moved) and is_stable


def counts_names(said: SentenceContext) -> bool:
    """Return whether as many names are told as are counted."""
    names = said.slots["names"]
    return isinstance(names, SymbolList) and said.slots["vary"] == Counted("varies", len(names.names))


def counts_steps(said: SentenceContext) -> bool:
    """Return whether W is the sum over the steps that are counted."""
    steps = said.slots["steps"]
    return isinstance(steps, Counted) and steps == Counted("step", steps.count) and sums(said, "W", steps.count)


def substitutes_law(said: SentenceContext) -> bool:
    """Return whether the slots are equations for the input and for the rate of the estimate."""
    firsts = [slot.members[0] for slot in (said.slots["law"], said.slots["rate"]) if isinstance(slot, Relation)]
    return firsts == [Letter("u"), Derivative(Letter("x_hat"))]
