"""The table `[variants.constraints]`: what must hold of a variant, each key with its kind of value."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from symobs.problem.fields import FLAG, by_name, is_integer, one_of, single, table

if TYPE_CHECKING:
    from symobs.problem.noted_errors import Errors

_COUNT = single(
    {"type": "integer", "minimum": 0},
    lambda value: is_integer(value) and value >= 0,
    "a whole number is expected",
    "write {key} = 4",
)
_BOUND = single(
    {"type": "integer", "minimum": 1},
    lambda value: is_integer(value) and value >= 1,
    "a positive whole number is expected",
    "write for example 2",
)
_NAMES = single(
    {"type": "array", "items": {"type": "string", "minLength": 1}},
    lambda value: isinstance(value, list) and all(isinstance(name, str) and name for name in value),
    "a list of names is expected, but {came} came",
    'write ["K", "L"]',
)
_POLYNOMIALS = single(
    {"type": "array", "items": {"enum": ["plant", "closed_loop"]}},
    lambda value: isinstance(value, list) and all(name in ("plant", "closed_loop") for name in value),
    "a list of polynomials is expected",
    'known are "plant" and "closed_loop"',
)
PAGE = {
    "digits": _COUNT.about("the most digits of a number in the derivation"),
    "fractions": _COUNT.about("how many fractions stand in the derivation at most"),
    "lines": _COUNT.about("how many lines it has at most"),
}
CONSTRAINTS = {
    "observable": FLAG.about("whether the plant is observable"),
    "controllable": FLAG.about("whether the plant is controllable"),
    "stable_plant": FLAG.about("whether all poles of the plant are stable"),
    "unstable_plant": FLAG.about("whether a pole of the plant is not stable"),
    "minimal_phase": FLAG.about("whether all zeros are stable"),
    "distinct_poles": FLAG.about("whether the poles of the plant are distinct"),
    "repeated_poles": FLAG.about("whether a pole of the plant is repeated"),
    "real_poles": FLAG.about("whether all poles of the plant are real"),
    "complex_poles": FLAG.about("whether the plant has poles that are not real"),
    "conditions_empty": FLAG.about("whether the answers hold without conditions and cases"),
    "integer": _NAMES.about("fields whose every entry and coefficient is whole"),
    "answers_nonzero": _NAMES.about("fields without an entry 0"),
    "discriminant_square": _POLYNOMIALS.about("of second order, the discriminant is the square of a rational number"),
    # Tables from names, several with spaces between, to a bound; "*" is every matrix and answer.
    "digits": by_name(_BOUND).about("the most digits of a whole number there"),
    "denominators": by_name(_BOUND).about("a number that every denominator there divides"),
    "plant_poles": one_of("rational", "distinct", "square_discriminant").about("the kind of the poles of the plant"),
    "page": table(PAGE).about("bounds of the derivation"),
}
_TABLE = table(CONSTRAINTS)


def read_constraints(value: object, errors: Errors) -> dict[str, Any]:
    """Return the constraints of a file; every error is noted."""
    found: dict[str, Any] = _TABLE.read(value, "variants.constraints", errors) or {}
    for key in ("digits", "denominators"):
        if key in found:
            found[key] = {name: bound for names, bound in found[key].items() for name in names.split()}
    return found
