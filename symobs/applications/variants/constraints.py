"""The constraints of a file, held against checked results."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import fields, is_dataclass
from difflib import get_close_matches
from fractions import Fraction
from typing import TYPE_CHECKING, Any

from symobs.exact import Factored, Matrix, Scalar
from symobs.exact.algebraic.polynomial_roots import rational_sqrt
from symobs.exact.algebraic.root_location import root_boxes
from symobs.formula.expression.source import shown
from symobs.formula.tree.nodes import Literal
from symobs.proof.derivation.steps import CaseStep, Define, Equal, Given, Section, Tabulate
from symobs.stability.criteria.stability import stability
from symobs.tasks.result import task_named

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator, Sequence

    from symobs.proof.derivation import Derivation
    from symobs.system import StateSpace
    from symobs.tasks.result import Result


# The profile of a solved problem: what a student has to work out, read off the values of its derivation.


_SIGN, _BAR = 2, 3
UNLIKE = "another structure"


def profile(results: Iterable[Result], derivations: Iterable[Derivation]) -> dict[str, Any]:
    """Return structure, load and peak of solved problems.

    load   the sum over all numbers of max(1, digits) + 2 for a sign + 3 for a fraction bar
    peak   the digits of the longest number
    """
    results, derivations = tuple(results), tuple(derivations)
    values = [value for each in derivations for value in _values(each.steps)]
    numbers = [number for value in values for number in numbers_of(value)]
    steps = [_kind(step) for each in derivations for step in _each_step(each.steps)]
    return {
        "load": sum(_load(number) for number in numbers),
        "peak": max((_longest(value) for value in values), default=0),
        "fractions": sum(number.denominator != 1 for number in numbers),
        "lines": sum(len(_relations(step)) for each in derivations for step in _each_step(each.steps)),
        "structure": {
            "tasks": [[result.task, result.method, result.verdict, len(result.case_tree)] for result in results],
            "steps": steps,
        },
    }


def _longest(value: object) -> int:
    """Return the digits of the longest number of a value, which may stand over one common denominator or be reduced."""
    if isinstance(value, Matrix):
        return max((_longest(entry) for entry in value.entries), default=0)
    if not isinstance(value, Scalar):
        return 0
    parts = (value.numerator, value.denominator)
    return max((len(str(abs(factor))) for part in parts for factor, _ in part.terms()), default=1)


def _load(number: Fraction) -> int:
    digits = len(str(abs(number.numerator))) + (len(str(number.denominator)) if number.denominator != 1 else 0)
    return digits + _SIGN * (number < 0) + _BAR * (number.denominator != 1)


def numbers_of(value: object) -> Iterator[Fraction]:
    """Yield the numbers in which a value is written: entries, coefficients; the bar of a quotient is no fraction."""
    if isinstance(value, Matrix):
        for entry in value.entries:
            yield from numbers_of(entry)
    elif isinstance(value, Scalar):
        top, bottom = value.numerator, value.denominator
        if not bottom.names:  # of names it is a quotient, whose coefficients are whole
            constant = bottom.fraction()
            yield from (Fraction(factor) / constant for factor, _ in top.terms()) if top.terms() else (Fraction(0),)
            return
        for part in (top, bottom):
            yield from (Fraction(factor) for factor, _ in part.terms())


def _values(node: object) -> Iterator[object]:
    """Yield every value that is written out in steps."""
    if isinstance(node, Literal):
        yield node.value
    elif isinstance(node, (tuple, list)):
        for each in node:
            yield from _values(each)
    elif isinstance(node, Tabulate):
        yield from (entry for row in node.table.rows for entry in row.entries)
    elif is_dataclass(node) and not isinstance(node, type) and not getattr(node, "silent", False):
        for part in fields(node):
            yield from _values(getattr(node, part.name))


def _each_step(steps: Iterable[Any]) -> Iterator[Any]:
    for step in steps:
        yield step
        if isinstance(step, (Section, CaseStep)):
            yield from _each_step(step.steps)


def _relations(step: Any) -> tuple[Any, ...]:
    if isinstance(step, (Given, Equal)):
        return () if getattr(step, "silent", False) else step.relations
    return (step.relation,) if isinstance(step, Define) and not step.silent else ()


def _kind(step: Any) -> str:
    title = step.title.key if isinstance(step, Section) else ""
    return f"{type(step).__name__} {title}".strip()


# -- what is alike ----------------------------------------------------------------------------------------------------


def unlike(found: Mapping[str, Any], other: Mapping[str, Any], load: Fraction, *, same_peak: bool) -> str | None:
    """Return in what a profile differs from the one it is to be like, None where it is like it."""
    if found["structure"] != other["structure"]:
        return UNLIKE
    if abs(found["load"] - other["load"]) > load * other["load"]:
        return "another load"
    if found["peak"] > other["peak"] + (0 if same_peak else 1) or (same_peak and found["peak"] != other["peak"]):
        return "another longest number"
    return None


#: The constraints that name matrices of the plant, or answers.
_NAMING = ("integer", "answers_nonzero", "digits", "denominators")
_OF_PLANT = ("A", "B", "C", "D")


def broken(constraints: Mapping[str, Any], results: Sequence[Result]) -> str | None:
    """Return the first constraint that checked results do not meet, None where all are met."""
    for result in results:
        if result.verdict == "undecided":
            return f"{result.task} is undecided"
        if result.gains and result.verdict != "yes":
            return "the poles cannot be placed"
    plant = results[0].plant
    for key, test in _FLAGS.items():
        if key in constraints and test(plant, results) != constraints[key]:
            return f"{key} is not {str(constraints[key]).lower()}"
    if "plant_poles" in constraints and not _poles_are(constraints["plant_poles"], plant):
        return f"the plant's poles are not {constraints['plant_poles']}"
    return (
        _not_square(constraints.get("discriminant_square", ()), plant, results)
        or _not_whole(constraints.get("integer", ()), results)
        or _too_long(constraints.get("digits", {}), results)
        or _other_denominators(constraints.get("denominators", {}), results)
        or _zero_entry(constraints.get("answers_nonzero", ()), results)
    )


def unknown_names(constraints: Mapping[str, Any], results: Sequence[Result]) -> list[tuple[str, str, str]]:
    """Return the place, the message and the repair of every name that is neither of the plant nor of an answer."""
    known = list(dict.fromkeys([*_OF_PLANT, *(field for result in results for field in result.asked_fields)]))
    repair = f"known: {', '.join([*known, '*'])}"
    found = []
    for key in _NAMING:
        for name in constraints.get(key, ()):
            if name not in {*known, "*"}:
                near = get_close_matches(name, known, 1)
                question = f"did you mean {near[0]}? " if near else ""
                message = f'neither the plant nor an answer has the field "{shown(name, 40)}"'
                found.append((f"variants.constraints.{key}", message, question + repair))
    return found


def beyond(constraints: Mapping[str, Any], profile: Mapping[str, Any]) -> str | None:
    """Return what of the page is more than the constraints allow."""
    found = {"digits": profile["peak"], "fractions": profile["fractions"], "lines": profile["lines"]}
    page = constraints.get("page", {})
    return next((f"the page has too many {key}" for key, bound in page.items() if found[key] > bound), None)


# -- the plant --------------------------------------------------------------------------------------------------------


def _verdict_of(task: str) -> Callable[[StateSpace, Sequence[Result]], bool]:
    def test(plant: StateSpace, _: Sequence[Result]) -> bool:
        found = task_named(task)
        assert found is not None  # noqa: S101 - it is ours
        return bool(found.function(plant).verdict == "yes")

    return test


def _chi(plant: StateSpace) -> Scalar:
    return plant.matrices.A.characteristic_polynomial(plant.variable)


def _is_stable(plant: StateSpace, _: Sequence[Result] = ()) -> bool:
    return stability(_chi(plant), plant.variable, plant.symbols.signs, discrete=plant.is_discrete).verdict == "yes"


def _is_minimal_phase(plant: StateSpace, _: Sequence[Result]) -> bool:
    """Return whether all zeros of a plant with one input and one output are stable."""
    found = task_named("transfer_function")
    assert found is not None  # noqa: S101 - it is ours
    value = found.function(plant).fields["transfer_function"]
    value = value.value if isinstance(value, Factored) else value
    if isinstance(value, Matrix):
        if value.shape != (1, 1):
            return False
        value = value[0, 0]
    top = value.numerator
    return (
        bool(top) and stability(top, plant.variable, plant.symbols.signs, discrete=plant.is_discrete).verdict == "yes"
    )


def _numbers(polynomial: Scalar, variable: str) -> list[Fraction] | None:
    """Return the coefficients, the leading one first, where they are numbers."""
    try:
        return [entry.fraction() for entry in polynomial.coefficients(variable)]
    except (ArithmeticError, ValueError):
        return None


def _boxes(plant: StateSpace) -> list[tuple[tuple[Fraction, ...], int]]:
    """Return the poles in boxes with their multiplicities; none where the plant has parameters."""
    found = _numbers(_chi(plant), plant.variable)
    return [] if found is None else root_boxes(found, 10)


def _poles_are(kind: str, plant: StateSpace) -> bool:
    chi = _chi(plant)
    if kind == "square_discriminant":
        return _is_square(chi, plant.variable)
    if kind == "distinct":
        return all(count == 1 for _, count in _boxes(plant))
    return all(factor.degree(plant.variable) <= 1 for factor, _ in chi.factors()[1])


def _is_square(polynomial: Scalar, variable: str) -> bool:
    """Return whether the discriminant of a polynomial of second order is the square of a rational number."""
    found = _numbers(polynomial, variable)
    if found is None or len(found) != 3:
        return False
    discriminant = found[1] ** 2 - 4 * found[0] * found[2]
    return discriminant >= 0 and rational_sqrt(discriminant) is not None


_FLAGS: dict[str, Callable[[StateSpace, Sequence[Result]], bool]] = {
    "observable": _verdict_of("observability"),
    "controllable": _verdict_of("controllability"),
    "stable_plant": _is_stable,
    "unstable_plant": lambda plant, _: not _is_stable(plant),
    "stable_compensator": lambda _, results: all(r.fields.get("F_stable", "yes") == "yes" for r in results),
    "minimal_phase": _is_minimal_phase,
    "distinct_poles": lambda plant, _: all(count == 1 for _, count in _boxes(plant)),
    "repeated_poles": lambda plant, _: any(count > 1 for _, count in _boxes(plant)),
    "real_poles": lambda plant, _: all(not box[2] and not box[3] for box, _ in _boxes(plant)),
    "complex_poles": lambda plant, _: any(box[2] or box[3] for box, _ in _boxes(plant)),
    "conditions_empty": lambda _, results: not any(result.holds_where or result.case_tree for result in results),
}


def _not_square(names: Sequence[str], plant: StateSpace, results: Sequence[Result]) -> str | None:
    polynomials = {
        "plant": [_chi(plant)],
        "closed_loop": [f for r in results if isinstance(f := r.fields.get("polynomial"), Scalar)],
    }
    for name in names:
        if not all(_is_square(each, plant.variable) for each in polynomials[name]):
            return f"the discriminant of {name} is no square"
    return None


# -- answers ----------------------------------------------------------------------------------------------------------


def _named(names: Sequence[str], results: Sequence[Result]) -> Iterator[tuple[str, Any]]:
    """Yield matrices of the plant and answers by name; `*` is all of them."""
    plant = results[0].plant.matrices
    for name in names:
        for each in _OF_PLANT:
            if name in {each, "*"}:
                yield each, getattr(plant, each)
        for result in results:
            for field, value in result.asked_fields.items():
                if name in {field, "*"}:
                    yield field, value


def _all_numbers(value: Any, *, monic: bool = False) -> Iterator[Fraction]:
    """Yield the numbers of an answer; with `monic`, a quotient is written with a monic denominator."""
    if isinstance(value, Factored):
        value = value.value
    if isinstance(value, Scalar) and monic and value.denominator.names:
        lead = Fraction(value.denominator.terms()[0][0])
        yield from (number / lead for number in numbers_of(value))
    elif isinstance(value, (Scalar, Matrix)):
        if monic and isinstance(value, Matrix):
            yield from (number for entry in value.entries for number in _all_numbers(entry, monic=True))
        else:
            yield from numbers_of(value)
    elif isinstance(value, int) and not isinstance(value, bool):
        yield Fraction(value)
    elif isinstance(value, Mapping):
        yield from (number for each in value.values() for number in _all_numbers(each, monic=monic))
    elif isinstance(value, (list, tuple)):
        yield from (number for each in value for number in _all_numbers(each, monic=monic))


def _not_whole(names: Sequence[str], results: Sequence[Result]) -> str | None:
    for name, value in _named(names, results):
        if any(number.denominator != 1 for number in _all_numbers(value, monic=True)):
            return f"{name} is not whole"
    return None


def _too_long(bounds: Mapping[str, int], results: Sequence[Result]) -> str | None:
    for name, bound in bounds.items():
        for field, value in _named([name], results):
            longest = max((max(abs(n.numerator), n.denominator) for n in _all_numbers(value)), default=0)
            if len(str(longest)) > bound:
                return f"{field} has too many digits"
    return None


def _other_denominators(bounds: Mapping[str, int], results: Sequence[Result]) -> str | None:
    for name, bound in bounds.items():
        for field, value in _named([name], results):
            if any(bound % number.denominator for number in _all_numbers(value)):
                return f"a denominator in {field} does not divide {bound}"
    return None


def _zero_entry(names: Sequence[str], results: Sequence[Result]) -> str | None:
    for name, value in _named(names, results):
        entries = value.entries if isinstance(value, Matrix) else (value,)
        if any(isinstance(entry, Scalar) and entry.is_zero for entry in entries):
            return f"{name} has an entry 0"
    return None
