"""Existence of a real point where polynomials are all positive, by z3 (the extra `verify`).

z3 is not required.  It is bounded by its own count of resources, never by a clock: the same question has the same answer
on every machine.
"""

from __future__ import annotations

from fractions import Fraction
from typing import TYPE_CHECKING, Any

from symobs.exact.core.generators import PI, function_named

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from symobs.exact import Scalar

#: What one question may cost, and all questions about one list together, in z3's own count of resources.  Questions
#: about regions cost up to 7,000; a tenth of a second is some 100,000, of hard questions fewer.
QUESTION, TOGETHER = 200_000, 800_000
#: z3 is not asked about more terms, nor about higher degrees: what it does before it counts again grows with both.
_TERMS, _DEGREE = 2_000, 24


class Resources:
    """The remaining resources of z3 for one list."""

    def __init__(self, left: int = TOGETHER) -> None:
        """Start with all resources."""
        self.left = left


def names_of(values: Sequence[Scalar]) -> list[str]:
    """Return the names that occur, in order."""
    return sorted(set().union(*(value.names for value in values)))


def is_free(name: str) -> bool:
    """Return whether a generator is a symbol that may take any value of its sign: not √2, not π."""
    return name != PI and function_named(name) is None


def point_by_z3(
    positive: Sequence[Scalar],
    signs: Mapping[str, str],
    *,
    not_above: Scalar | None = None,
    resources: Resources | None = None,
) -> tuple[str, Mapping[str, Fraction]]:
    """Return `no` if all are positive at no point with these signs, else `maybe` with z3's point, if any.

    What it costs is taken from the resources, of which one question gets no more than `QUESTION`.  A point comes back
    rounded where it is no rational number: who needs it has to look.
    """
    values = [*positive, *([] if not_above is None else [not_above])]
    if not _is_small(values, _TERMS, _DEGREE):
        return "maybe", {}
    try:
        import z3
    except ImportError:
        return "maybe", {}

    resources = resources or Resources(QUESTION)
    allowed = min(QUESTION, resources.left)
    if allowed <= 0:
        return "maybe", {}
    context = z3.Context()
    solver = z3.SolverFor("QF_NRA", ctx=context)
    solver.set("rlimit", allowed)
    symbols = {name: z3.Real(f"x{k}", context) for k, name in enumerate(names_of(values))}
    tests = {"positive": lambda x: x > 0, "negative": lambda x: x < 0, "nonzero": lambda x: x != 0}
    tests |= {"nonnegative": lambda x: x >= 0, "nonpositive": lambda x: x <= 0}
    for name, symbol in symbols.items():
        if signs.get(name, "real") in tests:
            solver.add(tests[signs[name]](symbol))
    for value in positive:
        solver.add(_in_z3(value, symbols, z3, context) > 0)
    if not_above is not None:
        solver.add(_in_z3(not_above, symbols, z3, context) <= 0)
    try:
        verdict = str(solver.check())
        resources.left -= _cost(solver.statistics())
        if verdict != "sat":
            return ("no" if verdict == "unsat" else "maybe"), {}
        model = solver.model()
        return "maybe", {name: _fraction(model.evaluate(s, model_completion=True), z3) for name, s in symbols.items()}
    except z3.Z3Exception:
        return "maybe", {}


def _cost(statistics: Any) -> int:
    """Return the resources used by a query."""
    return int(statistics.get_key_value("rlimit count"))


def none_by_z3(positive: Sequence[Scalar], signs: Mapping[str, str], *, not_above: Scalar | None = None) -> bool:
    """Return whether z3 proves that no point makes all positive and one value nonpositive."""
    return point_by_z3(positive, signs, not_above=not_above)[0] == "no"


def _is_small(values: Sequence[Scalar], terms: int, degree: int) -> bool:
    return (
        sum(value.size for value in values) <= terms
        and all(value.degrees()[0] <= degree for value in values)
        and all(value.denominator.is_constant and all(map(is_free, value.names)) for value in values)
    )


def _in_z3(value: Scalar, symbols: Mapping[str, Any], z3: Any, context: Any) -> Any:
    terms = []
    for coefficient, powers in value.each_term():
        product = z3.RealVal(coefficient, context)
        for name, exponent in powers:
            for _ in range(exponent):
                product = product * symbols[name]
        terms.append(product)
    return z3.Sum(terms) if terms else z3.RealVal(0, context)


def _fraction(value: Any, z3: Any) -> Fraction:
    found = value.approx(20) if z3.is_algebraic_value(value) else value
    return Fraction(found.numerator_as_long(), found.denominator_as_long())
