"""Answering: a request is read, its problem solved within the process, and what is asked for is returned."""

from __future__ import annotations

import sys
import traceback
from collections import OrderedDict
from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any

from symobs.applications.live.assets import SCHEMA, language_asked
from symobs.applications.live.page import export_object, page_object
from symobs.applications.live.point import card_object, point_object, region_object
from symobs.applications.live.request import FieldError, Request, put_in, read
from symobs.applications.live.time_responses import NoResponse, readout, responses_of
from symobs.applications.live.views import pole_sets, view_object
from symobs.exact import Scalar
from symobs.exact.algebraic.root_location import complex_roots
from symobs.formula.phrases.languages import language_named
from symobs.formula.tree import Letter, Literal, Relation
from symobs.ground.dataclass import dataclass
from symobs.ground.errors import (
    CertificateRejected,
    DerivationRejected,
    InputError,
    OutOfBudget,
    ProblemErrors,
    SymobsError,
)
from symobs.pages.cards import Card, CardPrinter, cards
from symobs.problem.schema import kinds_of
from symobs.system import Symbols, read_scalar
from symobs.system.conditions import sign_of
from symobs.system.specification import is_pattern, read_poles
from symobs.tasks.result import tasks
from symobs.tasks.result.conversions import to_json

if TYPE_CHECKING:
    from symobs.formula.phrases.languages import Language
    from symobs.problem import Problem
    from symobs.tasks.result import Case, Result

#: Solved problems that are kept: those of the tabs that are open, and what a drag comes back to.
_KEPT = 8


@dataclass(frozen=True)
class Solved:
    """A problem with the result of its task."""

    problem: Problem
    result: Result


_solved: OrderedDict[str, Solved] = OrderedDict()


def answer(request: object) -> dict[str, Any]:
    """Return the response to a request of the protocol `symobs-live/1`; nothing is raised.

    `status` is `done`, `no` (a mathematical no), `bad` (all errors of the request), `undecided`, or `bug`.
    """
    identity = request.get("id") if isinstance(request, Mapping) else None
    head: dict[str, Any] = {"schema": SCHEMA, "id": identity if isinstance(identity, (int, str)) else None}
    try:
        asked = read(request)
        _require_at(asked)
        return head | _WANTED[asked.want](asked)
    except (CertificateRejected, DerivationRejected) as error:
        return head | _bug(error)
    except OutOfBudget as error:
        return head | {"status": "undecided", "message": error.message}
    except SymobsError as error:
        return head | {"status": "bad", "errors": errors_of(error, language_asked(request))}
    except MemoryError:
        return head | {"status": "undecided", "message": "memory was not enough"}
    except RecursionError:
        return head | {"status": "undecided", "message": "nested too deep"}
    except Exception as error:  # noqa: BLE001 - the last line of defence: a bug of ours, said as such
        return head | _bug(error)


def result_of(request: object) -> Result:
    """Return the result that an answer speaks of: it is remembered from answering."""
    return _there(read(request)).result


def _bug(error: Exception) -> dict[str, Any]:
    """Return the message; the whole goes to standard error, never to who asked."""
    traceback.print_exception(error, file=sys.stderr)
    return {"status": "bug", "message": f"internal error: {type(error).__name__}; please report this"}


def errors_of(error: SymobsError, language: Language) -> list[dict[str, str]]:
    """Return every error with its place and its repair; `lang` says which are in English alone."""
    found = []
    for each in error.errors if isinstance(error, ProblemErrors) else (error,):
        if isinstance(each, FieldError):
            message, repair = each.told(language)
            found.append({"where": each.where, "message": message, "repair": repair})
        else:
            found.append({"where": each.where, "message": each.message, "repair": each.repair, "lang": "en"})
    return found


def _solve(key: str, find: Callable[[], Problem]) -> Solved:
    """Return a solved problem, remembered by what it depends on."""
    if key in _solved:
        _solved.move_to_end(key)
        return _solved[key]
    problem = find()
    found = Solved(problem, problem.solve()[-1])
    _solved[key] = found
    while len(_solved) > _KEPT:
        _solved.popitem(last=False)
    return found


def _as_given(asked: Request) -> Solved:
    return _solve(asked.key, asked.problem)


def _there(asked: Request) -> Solved:
    """Return the problem with the values of `at`."""
    return _solve(asked.key_there, asked.problem_there) if asked.at else _as_given(asked)


def _require_at(asked: Request) -> None:
    """Raise an error for values of names that are no symbols, that cannot be read, or are of another sign."""
    table = asked.data.get("symbols")
    declared = Symbols.of(table) if isinstance(table, Mapping) else Symbols.of({})
    errors: list[SymobsError] = []
    for name, text in asked.at.items():
        where = f"at.{name}"
        try:
            if name not in declared.signs:
                raise InputError("no symbol of the problem", where=where, repair="declare it, or leave it out")
            value = read_scalar(text, declared, where)
            sign = declared.signs[name]
            if not value.names and not _agrees(value, sign):
                raise FieldError("said_other_sign", where, name=name, sign=sign)
        except SymobsError as error:
            errors.append(error)
    if errors:
        raise ProblemErrors(tuple(errors))


def _agrees(value: Scalar, sign: str) -> bool:
    """Return whether a number may stand for a symbol of this sign."""
    found = sign_of(value, {})
    allowed = {
        "positive": {"positive"},
        "negative": {"negative"},
        "nonnegative": {"positive", "zero", "nonnegative"},
        "nonpositive": {"negative", "zero", "nonpositive"},
        "nonzero": {"positive", "negative", "nonzero"},
    }
    return sign not in allowed or found in allowed[sign]


# -- what is wanted ---------------------------------------------------------------------------------------------------


def _answer(asked: Request) -> dict[str, Any]:
    """Return verdict, cards, readouts and responses."""
    there = _there(asked)
    shown = there if asked.cards_at or not asked.at else _as_given(asked)
    result, convention = shown.result, shown.problem.convention
    names = (result.cards or result.letters) if asked.names is None else asked.names
    language = language_named(shown.problem.language)
    printer, found = CardPrinter(result, convention, language), cards(result, names, convention)
    notes, responses = [], None
    if asked.responses is not None:
        try:
            responses = responses_of(there.result, asked.responses)
        except NoResponse as reason:
            notes += [language.phrases[str(reason)]] if str(reason) else []
    notes += _notes(there.result, language)
    claims = len(result.all_certificates)
    whole = {
        "status": _status(result),
        "verdict": result.verdict,
        "result": {
            "task": result.task,
            "method": result.method,
            **{name: to_json(result.fields[name]) for name in names if name in result.fields},
        },
        "claims": claims,
        "conditions": [_condition(found, printer) for found in result.holds_where],
        "cards": [card_object(card, printer) for card in found],
        "readouts": _readouts(there),
        "marks": _marks(there.result),
        "courses": responses,
    }
    if asked.cases:
        given = _as_given(asked).result
        of_given = CardPrinter(given, convention, language)
        whole["cases"] = [_case(case, of_given) for case in given.case_tree]
    return whole | ({"note": " ".join(notes)} if notes else {})


def _page(asked: Request) -> dict[str, Any]:
    found = _there(asked) if asked.cards_at else _as_given(asked)
    return {
        "status": _status(found.result),
        "verdict": found.result.verdict,
        "claims": len(found.result.all_certificates),
        **page_object(found.problem, found.result, asked.detail),
    }


def _point(asked: Request) -> dict[str, Any]:
    found = _as_given(asked)
    if found.result.task != "stability_region":
        raise InputError("only a stability region has points", where="want", repair='ask for "answer"')
    printer = CardPrinter(found.result, found.problem.convention, language_named(found.problem.language))
    return {"status": "done", **point_object(found.result, asked.at, printer)}


def _view(asked: Request) -> dict[str, Any]:
    found = _as_given(asked)
    whole = view_object(found.result, found.problem.specification)
    symbols = found.result.plant.symbols
    whole["symbols"] = {name: symbols.sign(name) for name in sorted(symbols.signs)}
    if found.result.task == "stability_region":
        whole["region"] = region_object(found.result, language_named(found.problem.language))
    return {"status": "done", "verdict": found.result.verdict, "view": whole}


def _export(asked: Request) -> dict[str, Any]:
    found = _there(asked) if asked.cards_at else _as_given(asked)
    data = put_in(asked.data, asked.at) if asked.cards_at else asked.data
    text = export_object(found.problem, found.result, asked.export, data, found.result.task)
    return {"status": "done", **text}


def _start(_: Request) -> dict[str, Any]:
    from symobs.applications.live.examples import examples  # noqa: PLC0415
    from symobs.formula.convention import conventions  # noqa: PLC0415 - asked once

    return {
        "status": "done",
        "tasks": {name: sorted(kinds_of(task)) for name, task in sorted(tasks().items())},
        "conventions": sorted(conventions()),
        "examples": examples(),
    }


_WANTED: dict[str, Callable[[Request], dict[str, Any]]] = {
    "answer": _answer,
    "page": _page,
    "point": _point,
    "view": _view,
    "export": _export,
    "start": _start,
}


# -- parts ------------------------------------------------------------------------------------------------------------


def _status(result: Result) -> str:
    return result.verdict if result.verdict in {"no", "undecided"} else "done"


def _condition(condition: Any, printer: CardPrinter) -> dict[str, str]:
    relation = Relation(
        (Literal(condition.expression), Literal(Scalar.of(0))), (condition.operator.replace("==", "="),)
    )
    return {"text": to_json(condition), "mathml": printer.mathml(Card("condition", relation, None))}


def _case(case: Case, printer: CardPrinter) -> dict[str, Any]:
    """Return a stratum: its conditions, its verdict, and the values that lie on it."""
    at = {name: str(value) for name, value in case.substitution.items()}
    whole: dict[str, Any] = {
        "when": [_condition(condition, printer) for condition in case.when],
        "verdict": "undecided" if case.result is None else case.result.verdict,
        "at": at,
    }
    rank = None if case.result is None else case.result.fields.get("rank")
    equations = [Card("when", Relation((Letter(n), Literal(v)), ("=",)), v) for n, v in case.substitution.items()]
    whole["mathml"] = [printer.mathml(card) for card in equations]
    return whole | ({"rank": rank} if isinstance(rank, int) else {})


def _readouts(solved: Solved) -> list[dict[str, str]]:
    """Return frequency, damping and settling time of every pole that was given as a number, a pair once."""
    found, plant, designs = [], solved.result.plant, _designs(solved.result)
    for group in pole_sets(solved.result.task):
        for key in (group.key, *(f"{half}_{group.key}" for half in ("control", "observer"))):
            given = solved.problem.specification.get(key)
            if given is None or is_pattern(given):
                continue
            asked = designs.get(key)
            poles = asked.poles if asked else read_poles(given, plant.symbols, f"specification.{key}")
            upper = [pole for pole in poles if pole.imaginary.names or pole.imaginary.fraction() >= 0]
            for place, pole in enumerate(upper):
                if pole.real.names or pole.imaginary.names:
                    continue
                read_out = readout(pole.real.fraction(), pole.imaginary.fraction(), discrete=plant.is_discrete)
                found.append({"handle": f"{key}.{place}", **read_out})
    return found


def _designs(result: Result) -> dict[str, Any]:
    """Return the desired polynomials of the two halves of a compensator."""
    halves = {"control_poles": "feedback", "observer_poles": "estimator"}
    return {key: getattr(vars(result)[half], "desired", None) for key, half in halves.items() if half in vars(result)}


def _marks(result: Result) -> list[dict[str, str]]:
    """Return what stands fixed in the plane: the plant's poles, and those of F; decimals for drawing alone."""
    plant = result.plant
    known: list[tuple[str, Any]] = []
    if plant.polynomial is None and not plant.is_time_varying and pole_sets(result.task):
        known.append(("plant", plant.matrices.A))
        known.append(("F", result.fields.get("compensator_matrix")))
    found = []
    for kind, matrix in known:
        if matrix is None or matrix.names:
            continue
        chi = matrix.characteristic_polynomial(plant.variable).coefficients(plant.variable)
        for real, imaginary in complex_roots([entry.fraction() for entry in chi]):
            found.append({"kind": kind, "re": f"{float(real):.6f}", "im": f"{float(imaginary):.6f}"})
    return found


def _notes(result: Result, language: Language) -> list[str]:
    """Return why there is no design, and what a look at the curves may miss."""
    whole: Any = result
    parts = [getattr(whole, name) for name in ("feedback", "estimator") if name in vars(result)] or [result]
    notes = []
    for part in parts if result.verdict == "no" else []:
        fixed = part.fields.get("fixed_modes") or ()
        pair = "(A, B)" if part.task == "state_feedback" else "(C, A)"
        if fixed:
            phrase = language.phrases["said_fixed_modes" if len(fixed) > 1 else "said_fixed_mode"]
            notes.append(phrase.format(modes=", ".join(map(str, fixed)), pair=pair))
    stable = {"compensator_stable": "said_unstable_compensator", "stable": "said_unstable_pole"}
    return notes + [language.phrases[key] for name, key in stable.items() if result.fields.get(name) == "no"]
