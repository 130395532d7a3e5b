"""From the tables of a file to a problem that can be run; every error of the file is found in one pass."""

from __future__ import annotations

import re
from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import field, replace
from difflib import get_close_matches
from typing import TYPE_CHECKING, Any

from symobs import SYNONYMS
from symobs.formula.convention import STANDARD, Convention, convention_named
from symobs.formula.expression import comma_between_digits, declared_name, parse_polynomial, typed_name, without_comma
from symobs.formula.expression.names import NAME
from symobs.formula.expression.source import shown
from symobs.formula.phrases.languages import ENGLISH, language_named
from symobs.ground.dataclass import dataclass
from symobs.ground.errors import InputError, ProblemErrors, SymobsError, Undecided, UnknownName, UsageError
from symobs.problem.expect import unreadable
from symobs.problem.fields import FLAG, TEXT, Marking, list_of, read_marking
from symobs.problem.file_tables import Decimal, Errors, came, check_text, report_unknown, table_of, with_constants
from symobs.problem.file_tables import checked_text as text_of
from symobs.problem.schema import (
    PRINTED,
    TOP,
    keys_of,
    kinds_of,
    missing_poles,
    period_of,
    plant_of,
    read_cells,
    repair_of,
    with_order_in_plant,
)
from symobs.system import StateSpace, Symbols, read_matrix, read_scalar
from symobs.system.reading import read_time
from symobs.system.specification import as_typed, from_list, is_pattern, parse_signal, read_poles
from symobs.system.specification.pole_patterns import OTHERS, named_parts, require_positive
from symobs.system.transfer_function_text import read_transfer_function
from symobs.tasks.result import Document, Result, Task, methods, result_type, task_named, tasks
from symobs.tasks.result.in_convention import ResultInConvention, names_in
from symobs.tasks.result.output_methods import digits_asked

if TYPE_CHECKING:
    from pathlib import Path

_MAX_SYMBOLS = 400
_MAX_CELLS = 1000

#: In place of a table of symbols: every well-formed name is a real symbol, as on the command line without a file.
OPEN = object()


@dataclass
class Problem:
    """A validated problem: everything but the answers."""

    title: str
    source: str
    ids: tuple[str, ...]
    tasks: tuple[Task, ...]
    plant: StateSpace
    specification: Mapping[str, Any]
    expect: Mapping[str, Any] = field(default_factory=dict)
    convention: Convention = STANDARD
    text: str = ""
    printed: tuple[Mapping[str, Any], ...] = ()
    values: Mapping[str, Any] = field(default_factory=dict)  # of symbols: the results are those there
    marking: Marking = Marking()
    digits: int | None = None  # of the numbers on the page, as a document has them
    language: str = ENGLISH.code
    plant_of: str = ""  # the task whose answer is the plant of those after it
    own: Mapping[str, Mapping[str, Any]] = field(default_factory=dict)  # by task, what is specified for it alone

    def follows(self, name: str) -> bool:
        """Return whether a task is one of the plant that another task finds."""
        names = [task.name for task in self.tasks]
        return bool(self.plant_of) and (self.plant_of not in names or names.index(name) > names.index(self.plant_of))

    def solve(self, report: Callable[[str, tuple[Result, ...]], None] | None = None) -> tuple[Result, ...]:
        """Run every task; `report` receives the name of the next one and the results so far.

        All errors of all tasks are raised together; else the first `Undecided`, with the results of the other tasks.
        """
        results: list[Result] = []
        errors = Errors()
        undecided: list[Undecided] = []
        named = task_named(self.plant_of) if self.plant_of else None
        first = [] if named is None or named in self.tasks else [named]
        plant: Any = self.plant
        for task in (*first, *self.tasks):
            if report is not None:
                report(task.name, tuple(results))
            specification = self.specification_of(task)
            own, keys = Errors(), keys_of(task, specification)
            asked = {name: specification[keys[name]] for name in keys}
            places_of_gains = gains_from(task, asked, [result.task for result in results])
            gains = {letter: results[place].numbers[letter] for letter, place in places_of_gains.items()}
            is_exact = all(results[place].fields[letter] is not None for letter, place in places_of_gains.items())
            with own:
                try:
                    there = plant if is_exact or None in gains.values() else _rounded(plant)
                    found = task.function(there, **asked, **{letter: K for letter, K in gains.items() if K is not None})
                    if task.name == self.plant_of:
                        plant = found
                    if task not in first:
                        results.append(found.at(self.values) if self.values else found)
                except Undecided as error:
                    undecided.append(error)
                    if task.name == self.plant_of:
                        break
            if own.found and task.name == self.plant_of:
                errors.found += own.found
                break
            places = {
                name: f"{task.name}.{key}" if key in self.own.get(task.name, ()) else key for name, key in keys.items()
            }
            own.move({f"specification.{name}": f"specification.{place}" for name, place in places.items()})
            errors.found += own.found
        if errors.found:
            known = self.plant.symbols, self.plant.variable
            _read_alone(self.specification, _kinds(self.tasks), self.expect, *known, errors)
            raise errors.together(self.convention)
        if undecided:
            undecided[0].facts["results"] = tuple(results)
            raise undecided[0]
        return tuple(results)

    def specification_of(self, task: Task) -> Mapping[str, Any]:
        """Return the specification of a task, its own before that of all; a method is for those tasks that have it."""
        shared, own = self.specification, self.own.get(task.name, {})
        name = shared.get("method")
        if name not in {None, "auto"}:  # the methods of all tasks are looked at only where one is named
            having = [each for each in self.tasks if f"{each.name}/{name}" in methods(each.name)]
            if task not in having and having:
                shared = {key: value for key, value in shared.items() if key != "method"}
        return {**shared, **own} if own else shared

    def viewed(self, results: tuple[Result, ...]) -> tuple[ResultInConvention, ...]:
        """Return the results in the file's convention."""
        return tuple(ResultInConvention(result, self.convention) for result in results)

    def document(self, results: tuple[Result, ...], convention: Convention | None = None) -> Document:
        """Return the document for a format, in the file's convention or in another one."""
        chosen = convention or self.convention
        return Document(self.title, self.source, results, chosen, self.text, digits=self.digits, language=self.language)


def validate(
    data: Mapping[str, Any], only: str | None = None, folder: Path | None = None, known: StateSpace | None = None
) -> Problem:
    """Return the problem of a file's tables; `only` names a task to run instead of the file's own.

    `folder` is where a convention of the user's own may lie, and `known` the plant, where it was read from the same tables
    before: what was found out about it is not found out again.  Raises `ProblemErrors` with every error found.
    """
    _refuse_other_kinds(data)
    data, errors = with_order_in_plant(data), Errors()
    report_unknown(data, TOP, "", errors, repair_of)
    title, source, text = (text_of(data, name, errors) for name in ("title", "source", "text"))
    ids = list_of(TEXT).read(data.get("id", []), "id", errors)
    convention = read_convention(data, folder, errors)
    language = _language(data, errors)
    asked = _tasks(data, errors, required=only is None)
    wanted = asked if only is None else tuple(filter(None, [task_named(only)]))
    plant_task = _plant_task(data, asked, only, errors)
    symbols = Symbols() if data.get("symbols") is OPEN else _symbols(table_of(data, "symbols", errors), errors)
    symbols = with_constants(table_of(data, "constants", errors), symbols, errors)
    dt = period_of(data, symbols, errors)
    if known is None:
        is_optional = bool(wanted) and all(task.works_without_plant for task in wanted)
        is_moving = {task.name for task in wanted} == {"equilibria"}
        known = plant_of(data, symbols, dt, errors, optional=is_optional, moving=is_moving)
    plant = known
    specification, own = _specification(data, (*asked, *wanted), convention, symbols, errors)
    kinds = _kinds((*asked, *wanted))
    for table in (specification, *own.values()):
        for name, value in table.items():
            with errors:
                table[name] = as_typed(name, kinds[name], value, plant)
    if language_named(language).has_comma:
        _require_clear_commas(specification, kinds, errors)
    expect = table_of(data, "expect", errors)
    printed = _printed(data.get("printed", []), errors)
    values = table_of(data, "values", errors)
    digits = _digits(data, errors)
    marking = read_marking(data.get("marking", {}), [task.name for task in asked], errors)
    check_text(data.get("variant", ""), "variant", errors)
    if not errors.found and plant is not None:
        about = title, source, ids, wanted, plant, specification, expect, convention, text, printed, values, marking
        return Problem(*about, digits, language, plant_task, own)
    if plant is not None and wanted and not any(error.where.startswith("constants") for error in errors.found):
        with errors:
            tried = Problem(title, source, ids, wanted, plant, specification, expect, convention)
            replace(tried, values=values, plant_of=plant_task, own=own).solve()
            moving = plant.nonlinear.states + plant.nonlinear.inputs if plant.nonlinear is not None else ()
            errors.found += unreadable(expect, symbols.naming(moving, "plant").names, plant.variable)
    else:
        _read_alone(specification, _kinds(wanted), expect, symbols, read_time(dt, symbols).variable, errors)
        for missing in missing_poles(wanted, data.get("specification")):
            errors.note(*missing)
    errors.found = _without_consequences(errors.found, data)
    raise errors.together(convention)


def _without_consequences(found: Sequence[SymobsError], data: Mapping[str, Any]) -> list[SymobsError]:
    """Return errors without those of names that a faulty declaration was to declare: they are mended with it."""
    meant, refused = _meant_to_be_declared(data)
    names = {*map(str, _listed_tasks(data))}
    misspelt = [
        f"{error.where.rpartition('.')[0]}.{near[1]}".lstrip(".") if near[1] not in names else "specification"
        for error in found
        if error.message == "unknown key" and (near := re.match(r"did you mean (\w+)\?", error.repair or ""))
    ]

    def follows(error: SymobsError) -> bool:
        is_unknown = isinstance(error, UnknownName) and error.facts.get("name") in meant
        is_told = not error.where.startswith("symbols") and any(
            error.message.startswith(f'"{name}" ') for name in refused
        )
        is_missing = "missing" in error.message or error.message == "no task is named"
        is_misspelt = is_missing and any(error.where == key or error.where.startswith(f"{key}.") for key in misspelt)
        return is_unknown or is_told or is_misspelt

    return [error for error in found if not follows(error)]


def _meant_to_be_declared(data: Mapping[str, Any]) -> tuple[set[str], list[str]]:
    """Return the names in declarations that are no table, no name, a list or elsewhere, and the keys that are no names."""
    table = data.get("symbols", {})
    plant = data.get("plant")
    elsewhere = [data.get("symbol"), plant.get("symbols") if isinstance(plant, Mapping) else None]
    texts = [str(other) for other in elsewhere if other is not None]
    refused: list[str] = []
    if not isinstance(table, Mapping):
        return {*NAME.findall(" ".join([*texts, str(table)]))}, []
    for name, entry in list(table.items())[:_MAX_SYMBOLS]:
        try:
            declared_name(name)
        except InputError:
            refused.append(name)
        texts += [str(entry)] if isinstance(entry, list) else []
    return {*NAME.findall(" ".join([*texts, *refused]))}, refused


def _rounded(plant: Any) -> StateSpace:
    """Return a plant, or that of the task which finds it, as one whose page says that its data are rounded."""
    found = plant.as_plant if isinstance(plant, Result) else plant
    assert isinstance(found, StateSpace)  # noqa: S101 - what finds a plant has one
    return found.with_rounding()


#: Keywords that say which gain a task has, by its letter.
_SAYS = {
    "K": {"K", "control_poles", "control_polynomial", "poles", "polynomial", "controller"},
    "L": {"L", "observer_poles", "observer_polynomial", "poles", "polynomial", "controller"},
}
#: The tasks whose gain is that of the tasks after them.
_FINDS = {"state_feedback": "K", "lqr": "K", "observer": "L", "kalman": "L"}


def gains_from(task: Task, asked: Collection[str], earlier: Sequence[str]) -> dict[str, int]:
    """Return the gains that a task of a file needs and is not given, each with the place of the earlier task that finds it."""
    found: dict[str, int] = {}
    for place, name in enumerate(earlier if task.name not in _FINDS else ()):
        letter = _FINDS.get(name, "")
        if letter in task.keywords and not _SAYS[letter] & set(asked):
            found[letter] = place
    return found


def _refuse_other_kinds(data: Mapping[str, Any]) -> None:
    """Raise `ProblemErrors` for a file of many problems, or of a sheet: what else it lacks follows from that."""
    errors = Errors()
    if "variants" in data:
        repair = "solve one with `symobs solve FILE --variant 1`, or write them with `symobs variants FILE -o FOLDER`"
        errors.note("this file stands for many problems", "variants", repair)
    elif isinstance(data.get("problem"), list) and not {"task", "tasks", "plant"} & data.keys():
        errors.note("this file describes a sheet", "problem", "put it on paper with `symobs sheet FILE`")
    if errors.found:
        raise errors.together()


def _digits(data: Mapping[str, Any], errors: Errors) -> int | None:
    """Return the digits of the numbers on the page: 0 for exact ones, None by default."""
    exact = FLAG.read(data.get("exact", False), "exact", errors)
    if exact is None:
        return None
    try:
        return digits_asked(data.get("digits"), exact=exact)
    except UsageError as error:
        errors.note(error.message, "digits", error.repair)
        return None


def _printed(value: object, errors: Errors) -> tuple[Mapping[str, Any], ...]:
    """Return what a source prints, of the right shape; its equations are read by the audit alone."""
    found: tuple[Mapping[str, Any], ...] = PRINTED.read(value, "printed", errors)
    for i, entry in enumerate(value if isinstance(value, list) else [value]):
        if isinstance(entry, Mapping) and ("relation" in entry) == ("expect" in entry):
            repair = 'write relation = "L = [19; 81]"'
            errors.note("one of relation and expect is expected", f"printed[{i}]", repair)
    return found


def _listed_tasks(data: Mapping[str, Any]) -> list[Any]:
    value = data.get("tasks", data.get("task", []))
    return value if isinstance(value, list) else [value]


def _tasks(data: Mapping[str, Any], errors: Errors, *, required: bool) -> tuple[Task, ...]:
    key = "tasks" if "tasks" in data else "task"
    if "task" in data and "tasks" in data:
        errors.note("both task and tasks are given", "tasks", "keep one of them")
    value = data.get(key, [])
    if value == [] and required:
        errors.note("no task is named", key, f'write for example task = "observer"; {_listed()}')
    found: dict[str, Task] = {}
    for i, name in enumerate(_listed_tasks(data)):
        where = f"{key}[{i}]" if isinstance(value, list) else key
        if not isinstance(name, str):
            errors.note(f"the name of a task is expected, but {came(name)} came", where, _listed())
        elif (task := task_named(name)) is None:
            errors.note(f'"{shown(name, 40)}" is not a task', where, _listed(name))
        elif name in found:
            errors.note(f"the task {name} is named twice", where, "keep one of them")
        else:
            found[name] = task
    return tuple(found.values())


def _plant_task(data: Mapping[str, Any], asked: Sequence[Task], only: str | None, errors: Errors) -> str:
    """Return the task whose answer is the plant of those after it; none where the file, or the task to run, names none."""
    name, names = data.get("plant_of", ""), [task.name for task in asked]
    able = [task for task in names if result_type(task).as_plant is not Result.as_plant]
    if name == "":
        return ""
    if name not in names or name not in able:
        message = (
            f"{came(name) if not isinstance(name, str) else shown(name, 40)} is no task here whose answer is a plant"
        )
        some = "canonical_form, decomposition, dual or zero_order_hold"
        repair = f"write {' or '.join(able)}" if able else f"name {some} among the tasks"
        errors.note(message, "plant_of", repair)
        return ""
    if name == names[-1]:
        errors.note(f"no task comes after {name}", "plant_of", "name the tasks that are about its plant after it")
    return "" if only in names[: names.index(name) + 1] else str(name)


def _listed(name: str = "") -> str:
    other = re.sub(r"[^a-z]+", "_", name.lower())
    near = [SYNONYMS[other]] if other in SYNONYMS else get_close_matches(name, tasks(), 1)
    return f"{f'did you mean {near[0]}? ' if near else ''}known tasks are {', '.join(sorted(tasks()))}"


def _symbols(table: Mapping[str, Any], errors: Errors) -> Symbols:
    """Return the symbols; one that is declared wrongly is still known, where its name can be one."""
    if len(table) > _MAX_SYMBOLS:
        errors.note(f"{len(table)} symbols are declared, more than {_MAX_SYMBOLS}", "symbols", "declare what is used")
    kept: dict[str, Any] = {}
    for name in list(table)[:_MAX_SYMBOLS]:
        with errors:
            typed = declared_name(typed_name(name), f"symbols.{shown(name, 40)}")
            if typed in kept:
                raise InputError(
                    f"{typed} is declared twice", where=f"symbols.{shown(name, 40)}", repair="keep one of them"
                )
            kept[typed] = "real"
            entry, before = table[name], len(errors.found)
            for part in [{key: value} for key, value in entry.items()] if isinstance(entry, Mapping) else [entry]:
                with errors:
                    Symbols.of({name: part})
            if len(errors.found) == before:
                kept[typed] = entry
    return Symbols.of(kept)


def read_convention(data: Mapping[str, Any], folder: Path | None, errors: Errors) -> Convention:
    """Return the convention the file is written in, the standard one where it names none that exists."""
    name = data.get("convention", STANDARD.name)
    if not isinstance(name, str) or isinstance(name, Decimal):
        errors.note(f"a name is expected, but {came(name)} came", "convention", 'write convention = "standard"')
        return STANDARD
    try:
        return convention_named(re.sub(r"(\.toml)+\Z", "", name), folder)  # a file names no path
    except UsageError as error:
        errors.note(error.message, "convention", error.repair)
    except ProblemErrors as wrong:
        errors.found += wrong.errors
    return STANDARD


def _language(data: Mapping[str, Any], errors: Errors) -> str:
    """Return the code of the language of the page, English where the file names none that exists."""
    code = data.get("language", ENGLISH.code)
    if not isinstance(code, str) or isinstance(code, Decimal):
        errors.note(f"a name is expected, but {came(code)} came", "language", 'write language = "de"')
        return ENGLISH.code
    try:
        return language_named(code).code
    except UsageError as error:
        errors.note(error.message, "language", error.repair)
        return ENGLISH.code


def _specification(
    data: Mapping[str, Any],
    wanted: Collection[Task],
    convention: Convention,
    symbols: Symbols,
    errors: Errors,
) -> tuple[dict[str, Any], dict[str, dict[str, Any]]]:
    """Return the part of the specification that the tasks use, and by name of a task what is for it alone."""
    table = table_of(data, "specification", errors)
    by_name = {task.name: task for task in wanted if isinstance(table.get(task.name), Mapping)}
    own = {
        name: _read_specification(table[name], f"specification.{name}", (task,), convention, symbols, errors)
        for name, task in by_name.items()
    }
    shared = {name: value for name, value in table.items() if name not in own}
    for name in [name for name, value in shared.items() if isinstance(value, Mapping) and name not in _kinds(wanted)]:
        if near := get_close_matches(name, [task.name for task in wanted], 1):
            errors.note("unknown key", f"specification.{name}", f"did you mean {near[0]}?")
            del shared[name]
    return _read_specification(shared, "specification", wanted, convention, symbols, errors), own


def _read_specification(
    table: Mapping[str, Any],
    place: str,
    wanted: Collection[Task],
    convention: Convention,
    symbols: Symbols,
    errors: Errors,
) -> dict[str, Any]:
    """Return the part of a table that the tasks use, in standard letters and signs."""
    kinds = _kinds(wanted)
    named = {own: pair for own, pair in names_in(convention).items() if pair[0] in kinds}
    report_unknown(table, {**kinds, **dict.fromkeys(named, "GainText")}, place, errors, repair_of)
    gains: dict[str, Any] = {}
    for own, (name, sign) in named.items():
        if own in table:
            gains[name] = table[own]
            with errors:
                where = f"{place}.{own}"
                known = symbols.naming(table.get("parameters"), "specification.parameters")
                gains[name] = table[own] if sign > 0 else -read_matrix(table[own], known, where)
            if own != name and name in table and name not in named:
                message = f"{name} and {own} are the same gain in the convention {convention.name}"
                errors.note(message, f"{place}.{name}", "keep one of them")
    table = {**{name: value for name, value in table.items() if name not in named}, **gains}
    found: dict[str, Any] = {}
    for name in [name for name in table if name in kinds]:
        if kinds[name] == "Name" and (not isinstance(table[name], str) or isinstance(table[name], Decimal)):
            message = f"a name is expected, but {came(table[name])} came"
            errors.note(message, f"{place}.{name}", "write it in quotes")
        else:
            found[name] = table[name]
    return found


def _require_clear_commas(specification: Mapping[str, Any], kinds: Mapping[str, str], errors: Errors) -> None:
    """Note poles with a comma between digits in a file whose language has decimal commas: 1,5 is a number there, too."""
    for name in [name for name in specification if kinds[name] == "Poles"]:
        if (comma := comma_between_digits(specification[name])) and ";" not in specification[name]:
            repair = f"write {without_comma(comma)}, or a space behind a comma between two poles"
            errors.note(f"{comma} may be one number or two", f"specification.{name}", repair)


def _kinds(wanted: Collection[Task]) -> dict[str, str]:
    """Return the kinds of the keywords of these tasks, or of all where none is named: the same word may mean two."""
    return {name: kind for task in wanted or tasks().values() for name, kind in kinds_of(task).items()}


def _read_alone(
    specification: Mapping[str, Any],
    kinds: Mapping[str, str],
    expect: Mapping[str, Any],
    symbols: Symbols,
    variable: str,
    errors: Errors,
) -> None:
    """Note what cannot be read even by itself: where there is an error already, the tasks do not come to read it."""
    others = Errors()
    for name, value in specification.items():
        where = f"specification.{name}"
        with others:
            match kinds.get(name):
                case "Poles" if is_pattern(value):
                    for part, given in named_parts(value, where).items():
                        with others:
                            read: Any = (read_poles if part == OTHERS else read_scalar)(
                                given, symbols, f"{where}.{part}"
                            )
                            require_positive(part, read, symbols.signs, f"{where}.{part}")
                case "Poles":
                    for i, pole in enumerate(value[:_MAX_CELLS] if isinstance(value, list) else ()):
                        with others:
                            (read_poles if isinstance(pole, str) else read_scalar)(pole, symbols, f"{where}[{i}]")
                    read_poles(value, symbols, where)
                case "PolynomialText":
                    parse_polynomial(value, variable, symbols.names, where=where, functions=True)
                case "TransferFunctionText":
                    read_transfer_function(value, symbols, variable, where)
                case "IntervalText":
                    read_poles(value, symbols, where)
                case "GainText" | "MatrixText":
                    read_cells(value, symbols, where, others)
                    read_matrix(from_list(value, column=True), symbols, where)
                case "SignalText" | "TimeFunctions" as kind:
                    parse_signal(value, symbols, where, functions=kind == "TimeFunctions")
    others.found += unreadable(expect, symbols.names, variable)
    errors.add_elsewhere(others)
