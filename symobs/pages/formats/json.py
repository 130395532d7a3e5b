"""The JSON of results: schema `symobs/1`."""

from __future__ import annotations

import json
from collections.abc import Mapping
from datetime import date
from json.encoder import encode_basestring
from typing import TYPE_CHECKING, Any, ClassVar

from symobs.exact import Matrix
from symobs.exact.numerals.written_digits import DATA_DIGITS
from symobs.formula.convention import STANDARD, Convention
from symobs.pages.page.sheet import decimal_of
from symobs.system.motion import with_primes
from symobs.tasks.result import Case, Result, output_format
from symobs.tasks.result.in_convention import ResultInConvention
from symobs.tasks.result.output_methods import signs, to_json

if TYPE_CHECKING:
    from collections.abc import Sequence

    from symobs.pages.page.sheet import Sheet
    from symobs.system import StateSpace
    from symobs.tasks.result import Document

SCHEMA = "symobs/1"
#: The texts at the head of a sheet.
_HEAD = ("course", "term", "number", "due", "instructor", "text")


@output_format
class Json:
    """One object a document, one object a task in it."""

    name: ClassVar[str] = "json"
    suffix: ClassVar[str] = ".json"

    def render(self, document: Document) -> str:
        """Return the document as indented JSON."""
        results = [result_object(result, document.convention) for result in document.results]
        return _written({"schema": SCHEMA, "title": document.title, "results": results})

    def part(self, document: Document) -> Any:
        """Return the objects of a solution's results, or a question as text."""
        if document.results:
            return [result_object(result, document.convention) for result in document.results]
        from symobs.pages.formats.text import Text  # noqa: PLC0415 - only for questions

        return Text().part(document)

    def sheet(self, sheet: Sheet) -> str:
        """Return the sheet as indented JSON, one object a problem."""
        problems = []
        for entry in sheet.entries:
            problem: dict[str, Any] = {"file": entry.file, "title": entry.title}
            problem |= {"version": entry.version} if entry.version else {}
            if entry.points:
                problem["points"] = [decimal_of(points) for points in entry.points]
            if entry.hint and sheet.has_questions:
                problem["hint"] = entry.hint
            if entry.answer and sheet.has_questions:
                problem["answer"] = entry.answer
            if sheet.has_questions:
                problem["question"] = entry.question
            if sheet.has_solutions:
                problem["results"] = entry.solution
            problems.append(problem | ({"failure": entry.failure} if entry.failure else {}))
        head = {name: told for name in _HEAD if (told := getattr(sheet.header, name))}
        if isinstance(due := sheet.header.due, date):
            head["due"] = due.isoformat()
        return _written({"schema": SCHEMA, "title": sheet.title, **head, "problems": problems})


def given_up(document: Document, tasks: Sequence[str], method: str, signs: Mapping[str, str], reason: str = "") -> str:
    """Return the JSON of tasks of which some are beyond their budget or the limits: those are undecided, without claims."""
    empty: dict[str, list[str]] = {"conditions": [], "condition_kinds": [], "cases": [], "certificates": []}
    names = {"symbols": dict(sorted(signs.items())), "in_convention": {"name": document.convention.name}}
    found = {result.task: result_object(result, document.convention) for result in document.results}
    undecided = {"method": method, "verdict": "undecided", **empty, **names}
    undecided |= {"reason": reason} if reason else {}
    results = [found.get(task, {"task": task, **undecided}) for task in tasks]
    return _written({"schema": SCHEMA, "title": document.title, "results": results})


def _written(whole: Mapping[str, object]) -> str:
    """Return indented JSON."""
    return _indented(whole, "\n") + "\n"


def _indented(value: object, line: str) -> str:
    """Return the text of `json.dumps(indent=2)`, by the fast encoder."""
    if isinstance(value, str):
        return encode_basestring(value)
    inner = line + "  "
    if isinstance(value, dict) and value:
        pairs = [f"{inner}{_encoded(key)}: {_indented(entry, inner)}" for key, entry in value.items()]
        return f"{{{','.join(pairs)}{line}}}"
    if isinstance(value, (list, tuple)) and value:
        return f"[{','.join([inner + _indented(entry, inner) for entry in value])}{line}]"
    return _encoded(value)


_encoded = json.JSONEncoder(ensure_ascii=False).encode


def result_object(result: Result, convention: Convention = STANDARD) -> dict[str, Any]:
    """Return the object of one result: common fields, its own fields, and its forms in a convention."""
    own = ResultInConvention(result, convention).renamed_fields
    fields = result.fields
    # What stands under two names, as a gain and its input matrix, is written out once: a long one takes half a second.
    different = {id(value): value for value in fields.values()}
    written = {number: to_json(value, result.symbols) for number, value in different.items()}
    answers = {name: written[id(value)] for name, value in fields.items()}
    differing = {name: to_json(value, result.symbols) for name, value in own.items() if value is not fields.get(name)}
    in_convention = {name: value for name, value in differing.items() if name not in answers or answers[name] != value}
    return {
        "task": result.task,
        "method": result.method,
        "page_method": result.printed_method,
        "verdict": result.verdict,
        "conditions": [to_json(condition) for condition in result.holds_where],
        "condition_kinds": [condition.kind for condition in result.holds_where],
        "cases": [_case_object(case, answers) for case in result.case_tree],
        "certificates": [{"claim": c.claim, "how": c.how, "bound": c.bound} for c in result.all_certificates],
        "symbols": result.symbols,
        "plant": _plant_object(result.plant),
        "specification": {name: _given(value) for name, value in result.specification.items()},
        **({"scope": result.scope} if result.scope else {}),
        **answers,
        "decimals": result.decimals,
        "in_convention": {"name": convention.name, **in_convention},
    }


def answer_object(result: Result) -> dict[str, Any]:
    """Return the answer alone: verdict, conditions, and the fields of the answer."""
    return {
        "task": result.task,
        "method": result.method,
        "verdict": result.verdict,
        "conditions": [to_json(condition) for condition in result.holds_where],
        "certificates": [{"claim": c.claim, "how": c.how, "bound": c.bound} for c in result.all_certificates],
        **{name: to_json(value, result.symbols) for name, value in result.asked_fields.items()},
    }


def _plant_object(plant: StateSpace) -> dict[str, Any]:
    """Return the data: the matrices there are, the sampling time, and the names with their signs."""
    if plant.polynomial is not None:
        data: dict[str, Any] = {"polynomial": to_json(plant.polynomial)}
    else:
        m = plant.matrices
        present = {"A": True, "B": m.has_input, "C": m.has_output, "D": m.has_input and m.has_output}
        data = {name: to_json(getattr(m, name)) for name, is_there in present.items() if is_there}
    if (given := plant.nonlinear) is not None:
        data = data if given.equilibrium else {}  # it is not linearised
        functions = {"f": to_json(given.f)} | ({} if given.h is None else {"h": to_json(given.h)})
        named = with_primes if given.motion is not None else str
        point = {named(name): str(value) for name, value in given.equilibrium}
        states = [named(name) for name in given.states]
        data |= {**functions, "states": states, "inputs": [*given.inputs], "equilibrium": point}
        if given.motion is not None:
            data["rates"] = {named(name): name for name in given.states if named(name) != name}
    dt = plant.dt if isinstance(plant.dt, int) else str(plant.dt)
    data |= {"rounded_to": DATA_DIGITS} if plant.is_rounded else {}
    data |= {} if plant.delay is None else {"delay": to_json(plant.delay)}
    if plant.approximates is not None:
        delay, order = plant.approximates
        data["approximates"] = {"delay": to_json(delay), "pade": order}
    return {**data, "dt": dt, "symbols": signs(plant, [plant.polynomial])}


def _given(value: Any) -> Any:
    """Return a part of a specification as it was given; what JSON has no form for as its text."""
    if value is None or isinstance(value, (str, int)):
        return value
    if isinstance(value, Mapping):
        return {str(key): _given(entry) for key, entry in value.items()}
    if isinstance(value, (list, tuple)):
        return [_given(entry) for entry in value]
    if isinstance(value, Matrix):
        return to_json(value)
    return _given(value.tolist()) if hasattr(value, "tolist") else str(value)


def _case_object(case: Case, outer: dict[str, Any]) -> dict[str, Any]:
    """Return a stratum: its conditions, and the fields that differ there."""
    when = [to_json(condition) for condition in case.when]
    if case.result is None:
        return {"when": when, "verdict": "undecided"}
    inner = {name: to_json(value, case.result.symbols) for name, value in case.result.fields.items()}
    # What the stratum does not have is said to be missing: a reader would take it from around the case.
    missing = dict.fromkeys(name for name, value in outer.items() if name not in inner and value is not None)
    differing = missing | {name: value for name, value in inner.items() if outer.get(name) != value}
    nested = [_case_object(deeper, missing | inner) for deeper in case.result.case_tree]
    certificates = [{"claim": c.claim, "how": c.how, "bound": c.bound} for c in case.result.all_certificates]
    whole = {"when": when, "verdict": case.result.verdict, **differing, "certificates": certificates}
    if case.result.verdict == "conditional":
        whole["conditions"] = [to_json(condition) for condition in case.result.holds_where]
        whole["condition_kinds"] = [condition.kind for condition in case.result.holds_where]
    return {**whole, "cases": nested} if nested else whole
