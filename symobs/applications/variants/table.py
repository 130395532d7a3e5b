"""The table `[variants]` of a problem file: parameters, construction, constraints, what is distinct and what is alike."""

from __future__ import annotations

from collections.abc import Mapping
from fractions import Fraction
from typing import TYPE_CHECKING, Any, NamedTuple

from symobs.applications.variants.constructions import CONSTRUCTIONS
from symobs.applications.variants.drawing import VERSION
from symobs.applications.variants.parameters import (
    RELATION,
    Parameter,
    count_of,
    interval,
    letters_in,
    letters_of,
    placeholders,
    read_parameter,
)
from symobs.formula.expression import declared_name
from symobs.formula.expression.source import shown
from symobs.ground.errors import InputError, ProblemErrors, SymobsError
from symobs.problem import parse
from symobs.problem.fields import FLAG, by_name, is_integer, one_of, single, table
from symobs.problem.file_tables import Errors, report_unknown

if TYPE_CHECKING:
    from symobs.applications.variants.parameters import Note


# The table `[variants.constraints]`: what must hold of a variant, each key with its kind of value.


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
    "stable_compensator": FLAG.about("whether the compensator, F(s), is stable"),
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


KEYS = ("construct", "distinct", "difficulty", "attempts", "version", "parameters", "constraints")
LIKE = ("this", "base")
ATTEMPTS = 20_000
LOAD = Fraction(1, 5)
#: Letters with a meaning of their own in the texts of a file.
_TAKEN = {"i", "j", "s", "t", "z"}


class Table(NamedTuple):
    """A problem of which there are many: its tables without `[variants]`, and what that says."""

    base: Mapping[str, Any]
    parameters: Mapping[str, Parameter]
    when: tuple[str, ...] = ()
    construct: str | None = None
    shape: Mapping[str, Any] = {}
    constraints: Mapping[str, Any] = {}
    distinct: str = "both"
    like: str = "this"
    load: Fraction = LOAD
    attempts: int = ATTEMPTS


def read_table(text: str, where: str = "problem") -> Table:
    """Return what a file with `[variants]` says; raises `ProblemErrors` with every error of that table."""
    data = parse(text, where)
    errors = Errors()
    note = errors.note
    table = data.get("variants")
    if table is None:
        repair = 'write [variants] with construct = "compensator", or [variants.parameters]'
        raise InputError("the file has no table [variants]", where=where, repair=repair)
    if not isinstance(table, Mapping):
        raise InputError("a table is expected", where="variants", repair="write [variants] and its keys below")
    report_unknown(table, KEYS, "variants", errors)
    if table.get("version", VERSION) != VERSION:
        note("there is no such version", "variants.version", f"write version = {VERSION}")
    base = {key: value for key, value in data.items() if key != "variants"}
    construct, shape = _construct(table, note)
    if construct is not None and not any(error.where.startswith("variants.construct") for error in errors.found):
        _enough(construct, shape, note)
    like, load = _difficulty(table.get("difficulty", {}), note)
    _without_plant(base, construct, like, note)
    parameters, when = _parameters(table.get("parameters", {}), base, note)
    given = table.get("parameters")
    for place, name in placeholders(base):
        if not isinstance(given, Mapping) or name not in given:
            note(
                f"{{{name}}} is no parameter",
                place,
                f"declare {name} in [variants.parameters], or leave the braces out",
            )
    if construct is None and not parameters and not errors.found:
        repair = f"give construct, one of {', '.join(CONSTRUCTIONS)}, or [variants.parameters]"
        note("nothing is drawn", "variants", repair)
    distinct = one_of("data", "answers", "both").read(table.get("distinct", "both"), "variants.distinct", errors)
    attempts = count_of({"attempts": ATTEMPTS, **table}, "attempts", "variants", note, most=10**7)
    constraints = read_constraints(table.get("constraints", {}), errors)
    if errors.found:
        raise ProblemErrors(tuple(errors.found))
    return Table(base, parameters, when, construct, shape, constraints, distinct, like, load, attempts)


def _construct(table: Mapping[str, Any], note: Note) -> tuple[str | None, dict[str, Any]]:
    """Return the name of the construction and its shape."""
    given = table.get("construct")
    if given is None:
        return None, {}
    asked = {"kind": given} if isinstance(given, str) else given
    kind = asked.get("kind") if isinstance(asked, Mapping) else None
    if kind not in CONSTRUCTIONS:
        note("this is no construction", "variants.construct", f"write one of {', '.join(CONSTRUCTIONS)}")
        return None, {}
    shape = {**CONSTRUCTIONS[kind][1]}
    for key, value in asked.items():
        where = f"variants.construct.{shown(key, 40)}"
        if key == "kind":
            continue
        if key not in shape:
            note("unknown key", where, f"the shape of {kind} has {', '.join(shape)}")
        elif isinstance(shape[key], str):
            words = {
                "of": ("observer", "state_feedback"),
                "region": ("triangle", "wedge", "curve"),
                "hidden": ("stable", "unstable"),
            }
            if value not in words[key]:
                note("this is no choice", where, f"write one of {', '.join(words[key])}")
        elif key == "sizes":
            if not (isinstance(value, list) and len(value) == 4 and all(is_integer(v) and 0 <= v <= 4 for v in value)):
                note("four whole numbers are expected", where, "write sizes = [1, 1, 1, 0]")
            elif not sum(value) or value[0] + value[2] == 0 or value[0] + value[1] == 0:
                note("no input or no output is left", where, "write sizes = [1, 1, 1, 0]")
        elif isinstance(shape[key], list):
            interval(value, where, note)
        else:
            least = 0 if key in {"pairs", "steps"} else 1
            count_of(asked, key, "variants.construct", note, least, 6 if key == "order" else 20)
        shape[key] = value
    return kind, shape


def _enough(kind: str, shape: Mapping[str, Any], note: Note) -> None:
    """Note a shape that nothing has."""
    if "plant_poles" not in shape or not isinstance(shape["plant_poles"], list) or len(shape["plant_poles"]) != 2:
        return
    order = sum(shape["sizes"]) if "sizes" in shape else shape.get("order", 2) - 2 * shape.get("pairs", 0)
    low, high = shape["plant_poles"]
    there = high - low + 1
    if kind == "ranks":
        hidden = shape["sizes"][1]
        there = min(there, order + (-low if shape["hidden"] == "stable" else high) - hidden)
    if order < 0 or there < order:
        where = "variants.construct.plant_poles"
        note("there are not so many distinct poles", where, "widen it, or lower the order")
    if "outputs" in shape and shape["outputs"] > shape["order"]:
        note("more outputs than states", "variants.construct.outputs", "lower it")


def _difficulty(table: object, note: Note) -> tuple[str, Fraction]:
    """Return what variants are alike to, and by how much their loads may differ."""
    where = "variants.difficulty"
    if not isinstance(table, Mapping):
        note("a table is expected", where, 'write { like = "this", load = "20%" }')
        return "this", LOAD
    for key in table:
        if key not in {"like", "load"}:
            note("unknown key", f"{where}.{shown(key, 40)}", "known keys are like, load")
    like, load = table.get("like", "this"), table.get("load", "20%")
    if like not in LIKE:
        note("this is no choice", f"{where}.like", f"write one of {', '.join(LIKE)}")
    digits = str(load).removesuffix("%")
    if not str(load).endswith("%") or not digits.isdecimal() or len(digits) > 3:
        note("a percentage is expected", f"{where}.load", 'write load = "20%"')
        return like, LOAD
    return like, Fraction(int(digits), 100)


def _without_plant(base: Mapping[str, Any], construct: str | None, like: str, note: Note) -> None:
    """Note a plant that stands in the file although it is constructed."""
    plant = base.get("plant", {})
    if construct is None or not isinstance(plant, Mapping):
        if like == "base":
            note("there is no plant of the file's own", "variants.difficulty.like", 'write like = "this"')
        return
    for name in ("A", "B", "C", "transfer_function"):
        if name in plant and like != "base":
            note("the construction makes the plant", f"plant.{name}", "leave it out, or leave construct out")


def _parameters(table: object, base: Mapping[str, Any], note: Note) -> tuple[dict[str, Parameter], tuple[str, ...]]:
    """Return the parameters, by name in order, and the relations among them."""
    where = "variants.parameters"
    if not isinstance(table, Mapping):
        note("a table is expected", where, f"write [{where}] and its keys below")
        return {}, ()
    when = table.get("when", [])
    if not isinstance(when, list) or not all(isinstance(each, str) for each in when):
        note("a list of relations is expected", f"{where}.when", 'write when = ["a < b"]')
        when = []
    symbols = base.get("symbols")
    used = letters_in(base)
    found: dict[str, Parameter] = {}
    for name in sorted(set(table) - {"when"}):
        place = f"{where}.{shown(name, 40)}"
        try:
            declared_name(name, place)
        except SymobsError as error:
            note(error.message, place, error.repair)
            continue
        if name in _TAKEN:
            note(f'"{name}" has a meaning of its own', place, "write another name")
        if isinstance(symbols, Mapping) and name in symbols:
            note(f"{name} is declared as a symbol, too", place, "keep one of the two declarations")
        if name not in used:
            note("this parameter is not used", place, "use it in [plant] or [specification], or leave it out")
        parameter = read_parameter(name, table[name], note)
        if parameter is not None:
            found[name] = parameter
    for i, relation in enumerate(when):
        _read_relation(relation, set(table) - {"when"}, f"{where}.when[{i}]", note)
    return found, tuple(when)


def _read_relation(relation: str, parameters: set[str], where: str, note: Note) -> None:
    """Note a relation that has not two sides in the parameters."""
    match = RELATION.match(relation)
    if match is None or not (match[1].strip() and match[3].strip()):
        note(f'"{shown(relation, 60)}" is no relation', where, 'write when = ["a < b"]')
        return
    for name in sorted({name for side in match.groups()[::2] for name in letters_of(side)} - parameters - {"sqrt"}):
        known = ", ".join(sorted(parameters)) or "none"
        note(f"{name} is no parameter", where, f"use those of [variants.parameters]: {known}")
