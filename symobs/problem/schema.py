"""The keys of a problem file, and the JSON schema made of them and of the registry."""

from __future__ import annotations

from collections.abc import Mapping
from itertools import islice
from typing import TYPE_CHECKING, Any

from symobs.formula.convention import conventions
from symobs.problem.fields import ANY_TABLE, MARKING, TEXT, by_name, list_of, table
from symobs.problem.file_tables import Errors, nearest, report_unknown, table_of
from symobs.system import StateSpace, Symbols, read_scalar
from symobs.system.conditions import SIGNS
from symobs.system.dead_time import ORDERS
from symobs.system.linearize import linearize, without_equilibrium
from symobs.system.reading import read_time
from symobs.system.specification import CHOICES, KINDS
from symobs.system.transfer_function_text import REALISATIONS
from symobs.tasks.result import result_type, tasks
from symobs.tasks.result.in_convention import names_in
from symobs.tasks.result.output_methods import MOST_DIGITS

if TYPE_CHECKING:
    from collections.abc import Collection, Iterator

    from symobs.tasks.result.registry import Task


TOP: dict[str, dict[str, Any]] = {
    "title": {"description": "the title of the page", "type": "string"},
    "id": {"description": "ids of the problem", "type": ["array", "string"], "items": {"type": "string"}},
    "source": {"description": "where the problem comes from", "type": "string"},
    "text": {"description": "the problem in words, printed under the title", "type": "string"},
    "task": {"description": "one task"},
    "tasks": {"description": "several tasks, instead of task"},
    "plant_of": {
        "description": "a task whose answer is the plant of the tasks after it: canonical_form, zero_order_hold, …",
        "type": "string",
    },
    "convention": {
        "description": 'the convention the file is written in: standard, a law such as "u = K x_hat, A + M C", or a name',
        "type": "string",
        "pattern": "^[A-Za-z][A-Za-z0-9_-]{0,39}$",
    },
    "language": {"description": "the language of the page: en or de", "type": "string"},
    "digits": {
        "description": "significant digits of a page in decimals; 5 where data are typed as decimals",
        "type": "integer",
        "minimum": 1,
        "maximum": MOST_DIGITS,
    },
    "exact": {"description": "true: a page of exact numbers, however the data are typed", "type": "boolean"},
    "symbols": {"description": 'every free name: name = "positive", or name = { sign = "positive", latex = "b" }'},
    "constants": {
        "description": 'names for numbers: r = "sqrt(3)", c = "cos(pi/6)"; a text may use them',
        "type": "object",
        "additionalProperties": {"type": ["string", "integer"]},
    },
    "plant": {"description": "A, B, C, D, or transfer_function, or f or equations of motion with an equilibrium; dt"},
    "specification": {"description": "what the tasks need"},
    "values": {"description": "values of symbols, k = 4: the answers are those at these values"},
    "expect": {"description": "answers to hold the results against; [expect.TASK] for one task", "type": "object"},
    "printed": {"description": "what a source prints, for symobs audit: [[printed]], one an entry"},
    "marking": {"description": "what counts of an answer, for symobs check"},
    "variants": {"description": "how many problems like this one are drawn, for symobs variants", "type": "object"},
    "variant": {"description": "the id of the variant that this problem is", "type": "string"},
}


#: What one entry of [[printed]] may say.
_PRINTED = {
    "where": TEXT.about("the place in the source"),
    "erratum": TEXT.about("the id of the erratum, where it is a known one"),
    "convention": TEXT.about("the convention of its letters, where it is not the file's"),
    "relation": TEXT.about('an equation: "A + M C = [-3 1; -2 0]"'),
    "let": by_name(TEXT).about("letters of this entry alone, and what they stand for"),
    "expect": ANY_TABLE.about("instead of relation: answers as in [expect]"),
}


PRINTED = list_of(table(_PRINTED), 200)
MOTION = ("coordinates", "equations", "kinetic", "potential", "forces")
NONLINEAR = ("f", "h", "states", "inputs", "equilibrium", *MOTION)
PLANT = ("A", "B", "C", "D", "transfer_function", "realisation", *NONLINEAR, "dt", "delay", "pade")
#: A compensator has poles for each of its halves; a task that is one half reads them where nothing else is said of it.
_HALVES: dict[tuple[str, ...], str] = {("K",): "control", ("L",): "observer"}


def kinds_of(task: Task) -> dict[str, str]:
    """Return the kinds of the keys of a specification that a task reads."""
    half = _HALVES.get(result_type(task.name).gains)
    shared = {f"{half}_{name}": task.keywords[name] for name in ("poles", "polynomial")} if half else {}
    return {**task.keywords, **shared}


def keys_of(task: Task, specification: Mapping[str, Any]) -> dict[str, str]:
    """Return the keywords of a task that a specification gives, each with the key it stands under."""
    found = {name: name for name in task.keywords if name in specification}
    if not found.keys() & {"poles", "polynomial", "K", "L"} and (half := _HALVES.get(result_type(task.name).gains)):
        shared = {name: f"{half}_{name}" for name in ("poles", "polynomial")}
        found |= {name: key for name, key in shared.items() if key in specification}
    return found


#: What keys are called elsewhere, and in German.
_OTHER_WORDS = {
    "aufgabe": "task",
    "titel": "title",
    "strecke": "plant",
    "system": "plant",
    "vorgabe": "specification",
    "spezifikation": "specification",
    "polstellen": "poles",
    "pole": "poles",
    "eigenwerte": "poles",
    "eigenvalues": "poles",
    "desired_poles": "poles",
    "estimator_poles": "observer_poles",
    "controller_poles": "control_poles",
    "feedback_poles": "control_poles",
    "regler_pole": "control_poles",
    "beobachter_pole": "observer_poles",
    "ts": "dt",
    "sampling_time": "dt",
    "x0": "initial",
}


def repair_of(key: str, known: Collection[str], where: str) -> str:
    """Return what to do about a key that is not known where it stands: most are, elsewhere."""
    plain = _OTHER_WORDS.get(key.lower(), key.rstrip("s"))
    longer = (name for name in known if len(key) > 2 and name.startswith(plain))
    near = plain if plain in known else next(longer, None) or nearest(key, known)
    of = [task.name for task in tasks().values() if key in task.keywords]
    if key == "problem" and not where:
        return "the file of a sheet is for `symobs sheet`"
    if key in PLANT:
        return "it belongs to [plant]"
    if of:
        return f"it belongs to the task {of[0]}" if where == "specification" else "it belongs to [specification]"
    if key in TOP and where in {"plant", "specification"}:
        return "it belongs to the top of the file, above the first table"
    return f"did you mean {near}?" if near else f"known keys are {', '.join(known)}"


def schema() -> dict[str, Any]:
    """Return the JSON schema of a problem file, read from the registry."""
    known = sorted(tasks())
    number_or_text: dict[str, Any] = {"type": ["number", "string"]}
    row = {"type": "array", "items": number_or_text}
    matrix = {"type": ["string", "array"], "items": row}
    column_or_row = {"type": ["string", "array"], "items": {"anyOf": [row, number_or_text]}}  # one list may be either
    names = {"type": ["string", "array"], "items": {"type": "string"}}
    sign = {"enum": list(SIGNS)}
    details = {"sign": sign, "latex": {"type": "string"}}
    symbol = {"type": "object", "properties": details, "additionalProperties": False}
    plant = (
        {"A": matrix}
        | dict.fromkeys("BCD", column_or_row)
        | {
            "transfer_function": {"description": 'instead of A, B, C, D: "1/(s*(s + 1))"', **number_or_text},
            "realisation": {"description": "the coordinates of a transfer function", "enum": list(REALISATIONS)},
            "f": {"description": 'instead of A and B: "[omega; g/l*sin(theta) + u]"', **column_or_row},
            "h": {"description": 'with f, instead of C and D: "theta"', **column_or_row},
            "states": {"description": 'the states of f in their order: "theta, omega"', **names},
            "inputs": {"description": 'the inputs of f: "u"', **names},
            "equilibrium": {
                "description": "where f and h are linearised: values of states and inputs; those left out are found",
                "type": "object",
                "additionalProperties": number_or_text,
            },
            "coordinates": {"description": "instead of f: the coordinates of equations of motion", **names},
            "equations": {"description": "the equations of motion: \"m*x'' + k*x = F\"", **names},
            "kinetic": {"description": "instead of equations: the kinetic energy", **number_or_text},
            "potential": {"description": "with kinetic: the potential energy", **number_or_text},
            "forces": {
                "description": 'with kinetic: the generalised force along each coordinate: { x = "F" }',
                "type": "object",
                "additionalProperties": number_or_text,
            },
            "delay": {"description": 'a dead time at the input: "1/2"', **number_or_text},
            "pade": {"description": "the order of its Padé approximation", "enum": list(ORDERS)},
            "dt": {
                "description": "0: continuous; true, or the period: discrete",
                "type": ["number", "boolean", "string"],
            },
        }
    )
    keywords: dict[str, Any] = {}
    for name in known:
        for keyword, kind in kinds_of(tasks()[name]).items():
            words = {"enum": list(CHOICES[keyword])} if keyword in CHOICES and kind == "Name" else {}
            keywords.setdefault(keyword, {**KINDS[kind], **words, "tasks": []})["tasks"].append(name)
    for convention in conventions().values():
        for own, (name, _) in names_in(convention).items():
            if own not in keywords and name in keywords:
                keywords[own] = {**keywords[name], "description": f"{name}, in the convention {convention.name}"}
    properties: dict[str, Any] = {
        **TOP,
        "task": {"enum": known},
        "tasks": {"type": "array", "items": {"enum": known}, "minItems": 1, "uniqueItems": True},
        "symbols": {"type": "object", "additionalProperties": {"anyOf": [sign, symbol]}},
        "values": {"type": "object", "additionalProperties": number_or_text},
        "plant": {
            "type": "object",
            "properties": plant,
            "additionalProperties": False,
        },
        "specification": {"type": "object", "properties": keywords, "additionalProperties": False},
        "marking": MARKING.schema,
        "printed": {
            **PRINTED.schema,
            "items": {
                **PRINTED.schema["items"],
                "oneOf": [{"required": ["relation"]}, {"required": ["expect"]}],
            },
        },
    }
    return {
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "title": "symobs problem",
        "type": "object",
        "properties": {name: {**TOP[name], **found} for name, found in properties.items()},
        "additionalProperties": False,
        "oneOf": [{"required": ["task"]}, {"required": ["tasks"]}],
        "anyOf": [
            _has("plant", "A"),
            _has("plant", "transfer_function"),
            _has("plant", "f"),
            _has("plant", "equations"),
            _has("plant", "kinetic"),
            _has("specification", "polynomial"),
        ],
    }


def _has(table: str, key: str) -> dict[str, Any]:
    """Return that a key stands in a table."""
    return {"required": [table], "properties": {table: {"type": "object", "required": [key]}}}


def missing_poles(wanted: Collection[Task], given: object) -> Iterator[tuple[str, str, str]]:
    """Yield message, place and repair for the poles that tasks need and a specification gives in no way."""
    known = given if isinstance(given, Mapping) else {}
    asked = {name: task for task in wanted for name in task.keywords if name.endswith("poles")}
    for name, task in asked.items():
        gains = {"poles": "KLMH", "control_poles": "K", "observer_poles": "L"}.get(name, "")
        instead = (name, f"{name.removesuffix('poles')}polynomial", *gains)
        if not any(other in known or other in keys_of(task, known) for other in instead):
            yield f"{name} are missing", f"specification.{name}", f'give {name} = "-1, -2" or {instead[1]}'


# The table [plant] of a problem file: matrices, a transfer function, or a nonlinear plant with an equilibrium.


_MAX_CELLS = 1000


def period_of(data: Mapping[str, Any], symbols: Symbols, errors: Errors) -> object:
    """Return dt, 0 where it is none."""
    table = data.get("plant")
    with errors:
        dt: object = table.get("dt", 0) if isinstance(table, Mapping) else 0
        read_time(dt, symbols)
        return dt
    return 0


def plant_of(
    data: Mapping[str, Any], symbols: Symbols, dt: object, errors: Errors, *, optional: bool, moving: bool = False
) -> StateSpace | None:
    """Return the plant, None where it cannot be had; where it is `optional` a polynomial does instead.

    Where nothing but its equilibria is asked for, a nonlinear plant stays as it is, `moving`, without one.
    """
    table = table_of(data, "plant", errors)
    if not isinstance(data.get("plant", {}), Mapping):
        return None
    report_unknown(table, PLANT, "plant", errors, repair_of)
    given = [name for name in "ABCD" if name in table]
    nonlinear = {name: table[name] for name in NONLINEAR if name in table}
    lag = {name: table[name] for name in ("delay", "pade") if name in table}
    forms = [*given[:1], *(name for name in ("transfer_function",) if name in table), *list(nonlinear)[:1]]
    if len(forms) > 1:
        errors.note(f"both {forms[-1]} and {forms[0]} are given", "plant", "keep one of them")
    elif nonlinear and "delay" in table:
        repair = "give the matrices A, B, C of its linearisation"
        errors.note("a dead time is given for a nonlinear plant", "plant.delay", repair)
    elif nonlinear:
        with errors:
            return (without_equilibrium if moving else linearize)(**nonlinear, dt=dt, symbols=symbols)
    elif "realisation" in table and "transfer_function" not in table:
        errors.note("there is nothing to realise", "plant.realisation", "it belongs to transfer_function: leave it out")
    elif "transfer_function" in table:
        with errors:
            written = table["transfer_function"], dt
            return StateSpace.from_transfer_function(
                *written, symbols=symbols, realisation=table.get("realisation"), **lag
            )
    elif optional and not given and "polynomial" in (specification := table_of(data, "specification", errors)):
        with errors:
            known = symbols.naming(specification.get("parameters"), "specification.parameters")
            return StateSpace.from_polynomial(specification["polynomial"], dt, symbols=known)
    elif "A" not in table:
        errors.note("the state matrix is missing", "plant.A", 'give it, for example A = "[0 1; 0 -1]"')
    else:
        with errors:
            B, C, D = (table.get(name) for name in "BCD")
            return StateSpace(table["A"], B, C, D, dt, symbols=symbols, **lag)
        others = Errors()
        for name in given:
            read_cells(table[name], symbols.with_time(), f"plant.{name}", others)
        errors.add_elsewhere(others)
    return None


def with_order_in_plant(data: Mapping[str, Any]) -> Mapping[str, Any]:
    """Return a file with the order of a Padé approximation in [plant], where it may stand in [specification], too."""
    specification, plant = data.get("specification"), data.get("plant")
    if not (isinstance(specification, Mapping) and isinstance(plant, Mapping) and "pade" in specification):
        return data
    left = {name: value for name, value in specification.items() if name != "pade"}
    return {**data, "specification": left, "plant": {"pade": specification["pade"], **plant}}


def read_cells(value: object, symbols: Symbols, where: str, errors: Errors) -> None:
    """Note every unreadable cell of a matrix in lists; reading the matrix as a whole stops at the first."""
    rows = value if isinstance(value, list) else []
    cells = ((i, j, cell) for i, row in enumerate(rows) if isinstance(row, list) for j, cell in enumerate(row))
    for i, j, cell in islice(cells, _MAX_CELLS):
        with errors:
            read_scalar(cell, symbols, f"{where}[{i}][{j}]")
