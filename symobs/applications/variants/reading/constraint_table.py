"""The table `[variants.constraints]`: what must hold of a variant, each key with its kind of value."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from symobs.applications.variants.drawing.parameters import is_integer
from symobs.formula.expression.source import shown

if TYPE_CHECKING:
    from symobs.applications.variants.drawing.parameters import Note

#: What is true or false of a variant.
FLAGS = {
    "observable": "whether the plant is observable",
    "controllable": "whether the plant is controllable",
    "stable_plant": "whether all poles of the plant are stable",
    "unstable_plant": "whether a pole of the plant is not stable",
    "minimal_phase": "whether all zeros are stable",
    "distinct_poles": "whether the poles of the plant are distinct",
    "repeated_poles": "whether a pole of the plant is repeated",
    "real_poles": "whether all poles of the plant are real",
    "complex_poles": "whether the plant has poles that are not real",
    "conditions_empty": "whether the answers hold without conditions and cases",
}
#: Lists of names: fields of the results, or polynomials.
LISTS = {
    "integer": "fields whose every entry and coefficient is whole",
    "answers_nonzero": "fields without an entry 0",
    "discriminant_square": "plant, closed_loop: of second order, the discriminant is the square of a rational number",
}
#: Tables from names, several with spaces between, to a bound; "*" is every matrix and answer.
BOUNDS = {
    "digits": "the most digits of a whole number there",
    "denominators": "a number that every denominator there divides",
}
PAGE = {
    "digits": "the most digits of a number in the derivation",
    "fractions": "how many fractions stand in the derivation at most",
    "lines": "how many lines it has at most",
}
PLANT_POLES = ("rational", "distinct", "square_discriminant")
_POLYNOMIALS = ("plant", "closed_loop")


def read_constraints(table: object, note: Note) -> dict[str, Any]:
    """Return the constraints of a file; every error is noted."""
    where = "variants.constraints"
    if not isinstance(table, Mapping):
        note("a table is expected", where, f"write [{where}] and its keys below")
        return {}
    known = (*FLAGS, *LISTS, *BOUNDS, "plant_poles", "page")
    found: dict[str, Any] = {}
    for key, value in table.items():
        place = f"{where}.{shown(key, 40)}"
        if key in FLAGS:
            if not isinstance(value, bool):
                note("true or false is expected", place, f"write {key} = true")
        elif key in LISTS:
            found[key] = _names(value, place, note)
            if key == "discriminant_square" and set(found[key]) - set(_POLYNOMIALS):
                note("no such polynomial", place, f"known are {' and '.join(_POLYNOMIALS)}")
            continue
        elif key in BOUNDS:
            found[key] = _bounds(value, place, note)
            continue
        elif key == "page":
            found[key] = _page(value, place, note)
            continue
        elif key == "plant_poles":
            if value not in PLANT_POLES:
                note("this is no kind of poles", place, f"write one of {', '.join(PLANT_POLES)}")
        else:
            note("unknown key", place, f"known keys are {', '.join(known)}")
        found[key] = value
    return found


def _names(value: object, where: str, note: Note) -> list[str]:
    if isinstance(value, list) and all(isinstance(name, str) and name for name in value):
        return list(value)
    note("a list of names is expected", where, 'write ["K", "L"]')
    return []


def _bounds(value: object, where: str, note: Note) -> dict[str, int]:
    if not isinstance(value, Mapping):
        note("a table from names to numbers is expected", where, 'write { "A B C" = 1, "K L" = 2 }')
        return {}
    for names, bound in value.items():
        if not is_integer(bound) or bound < 1:
            note("a positive whole number is expected", f"{where}.{shown(names, 40)}", "write for example 2")
    return {name: bound for names, bound in value.items() for name in str(names).split() if is_integer(bound)}


def _page(value: object, where: str, note: Note) -> dict[str, int]:
    if not isinstance(value, Mapping):
        note("a table is expected", where, "write { digits = 4, fractions = 0 }")
        return {}
    for key, bound in value.items():
        if key not in PAGE:
            note("unknown key", f"{where}.{shown(key, 40)}", f"known keys are {', '.join(PAGE)}")
        elif not is_integer(bound) or bound < 0:
            note("a whole number is expected", f"{where}.{key}", f"write {key} = 4")
    return {key: bound for key, bound in value.items() if is_integer(bound)}
