"""The step that finds a gain factor by factor: some entries, the zeros among them, are held, letters are the others."""

from __future__ import annotations

from itertools import chain, combinations, count, islice
from math import isqrt
from typing import TYPE_CHECKING

from symobs.exact import Factored, Matrix, Scalar, rank
from symobs.proof.derivation.builder import relation
from symobs.stability.criteria.stability import monic
from symobs.tasks.analysis.page_parts import formula_of_factored, letters_apart_from_data
from symobs.tasks.design.named_gains import entry_letters, gain_letters

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from symobs.formula.tree.term import Term
    from symobs.proof.derivation.builder import Builder
    from symobs.tasks.design.gain.gain_design import PlacementProblem

#: Among so many entries some are held at their values besides the zeros: so many choices are looked at in all.
_UNKNOWN_UP_TO, _TRIED = 12, 300


def write_structured(
    page: Builder,
    side: PlacementProblem,
    value: Matrix,
    A: Term,
    moved: Term,
    phi: Term,
    give: Callable[[Matrix], Term] | None = None,
    say: str = "structured_gain",
) -> bool:
    """Write the equations of a gain, where its polynomial with letters for the entries splits so; return whether it does.

    A and `moved` are the terms of A and of B or C, phi that of the desired polynomial.  `give` lets the letters of the
    page stand for a gain with unknown entries, and returns its term.
    """
    variable = page.plant.variable
    found = next(_forms(page, side, value, A.value, moved.value), None)
    if found is None:
        return False
    fixed, parts, letters = found
    named = page[side.gain].value if give is not None and page.defines(side.gain) else value
    are_named = named != value and named.substitute(page.environment.coefficients) == value
    unknown = named if are_named else gain_letters(page, side.gain, value, _kept(fixed))
    names = unknown.names - value.names
    parts = [
        (factor.substitute({old: Scalar.symbol(new) for old, new in _renamed(letters, unknown)}), power)
        for factor, power in parts
    ]
    if give is None:
        gain = page.define(side.gain, unknown, say=say)
    else:
        gain = give(unknown)
        page.equal(relation(gain, unknown), say=say)
    fed_back = gain @ moved if side.is_dual else moved @ gain
    closed = A - fed_back
    page.equal(relation(closed, letters_apart_from_data(page, closed.value)))
    factors = page.term(formula_of_factored(Factored(Scalar.of(1), tuple(parts))))
    pencil = page("det(pencil({A}) + {fed_back})", A=A, fed_back=fed_back)
    page.equal(relation(pencil, factors), say="polynomial_of_unknown")
    meanings = {
        str(name): entry for name, entry in zip(unknown.entries, value.entries, strict=True) if str(name) in names
    }
    wanted = [factor.substitute(meanings) for factor, _ in parts]
    if len(parts) > 1:
        asked = Factored(Scalar.of(1), tuple((factor, 1) for factor in wanted))
        page.equal(relation(phi, page.term(formula_of_factored(asked))), say="structured_wish")
    pairs = [
        pair
        for (factor, _), wish in zip(parts, wanted, strict=True)
        for pair in zip(factor.coefficients(variable), wish.coefficients(variable), strict=True)
    ]
    lines = [relation(have, want) for have, want in pairs if have.names & names]
    page.equal(*lines, say="equal_factors" if len(parts) > 1 else "equal_coefficients")
    return True


def is_held(
    page: Builder, side: PlacementProblem, value: Matrix, A: Term, moved: Term
) -> Callable[[Scalar], bool] | None:
    """Return which entries of a gain are no unknowns of its equations; nothing where it is not written so."""
    found = next(_forms(page, side, value, A.value, moved.value), None)
    return None if found is None else _kept(found[0])


def _kept(fixed: list[Scalar]) -> Callable[[Scalar], bool]:
    return lambda entry: any(entry is each for each in fixed)


def _renamed(letters: Matrix, unknown: Matrix) -> Iterator[tuple[str, str]]:
    """Yield the letters of the first gain with those of the other in their places."""
    for old, new in zip(letters.entries, unknown.entries, strict=True):
        if old != new:
            yield str(old), str(new)


def _forms(
    page: Builder, side: PlacementProblem, value: Matrix, A: Matrix, moved: Matrix
) -> Iterator[tuple[list[Scalar], list[tuple[Scalar, int]], Matrix]]:
    """Yield entries that are held, such that the polynomial splits into factors that determine the others, and the gain."""
    zero, others = _parted(value)
    variable = page.plant.variable
    if len(others) > _UNKNOWN_UP_TO:
        return
    fewest = max(0, len(others) - A.shape[0])  # as many letters as coefficients
    choices = chain.from_iterable(combinations(others, held) for held in range(fewest, len(others)))
    for held in islice(choices, _TRIED):
        fixed = [*zero, *held]
        letters = entry_letters(page, side.gain, value, _kept(fixed))
        names = letters.names - value.names
        fed = letters @ moved if side.is_dual else moved @ letters
        if not _may_split(A, fed, names, variable):
            continue
        polynomial = (A - fed).characteristic_polynomial(variable)
        parts = [(monic(factor, variable), power) for factor, power in polynomial.factors()[1]]
        apart = sum(len(factor.names & names) for factor, _ in parts) == len(names) > 0
        if apart and all(power == 1 and _is_solved_by_comparison(factor, names, variable) for factor, power in parts):
            yield fixed, parts, letters


def _may_split(A: Matrix, fed: Matrix, letters: frozenset[str], variable: str) -> bool:
    """Return whether, for numbers in place of all names, the polynomial splits or depends on the letters linearly."""
    names = sorted(A.names | fed.names)
    trial = {name: Scalar.of(number) for name, number in zip(names, _primes(), strict=False)}
    polynomials = []
    for factor in (0, 1, 2):
        numbers = {name: number * (factor if name in letters else 1) for name, number in trial.items()}
        polynomials.append((A.substitute(numbers) - fed.substitute(numbers)).characteristic_polynomial(variable))
    nothing, once, twice = polynomials
    return len(once.factors()[1]) > 1 or (twice - once - once + nothing).is_zero


def _primes() -> Iterator[int]:
    """Yield numbers that have no relation to each other."""
    return (number for number in count(101) if all(number % divisor for divisor in range(2, isqrt(number) + 1)))


def _parted(value: Matrix) -> tuple[list[Scalar], list[Scalar]]:
    """Return the entries that are zero, and the others."""
    return [e for e in value.entries if e.is_zero], [e for e in value.entries if not e.is_zero]


def _is_solved_by_comparison(factor: Scalar, names: frozenset[str], variable: str) -> bool:
    """Return whether the coefficients of a monic polynomial are linear in letters and determine them."""
    inside = sorted(factor.names & names)
    coefficients = factor.coefficients(variable)
    if any(sum(power for name, power in term if name in names) > 1 for c in coefficients for _, term in c.terms()):
        return False
    if any(c.denominator.names & names for c in coefficients):
        return False
    nothing = dict.fromkeys(inside, Scalar.of(0))
    slopes = [
        [c.substitute({**nothing, name: Scalar.of(1)}) - c.substitute(nothing) for name in inside] for c in coefficients
    ]
    return not inside or rank(Matrix.of(slopes)) == len(inside)
