"""Answering: a request is read, its problem solved within the process, and what is asked for is returned."""

from __future__ import annotations

import sys
import traceback
from collections import OrderedDict
from collections.abc import Callable, Iterator, Mapping
from dataclasses import replace
from fractions import Fraction
from functools import lru_cache
from typing import TYPE_CHECKING, Any

from symobs.applications.live.assets import SCHEMA, language_asked
from symobs.applications.live.beginning import begun, halves
from symobs.applications.live.frequency_response import frequency_response, shows_loop
from symobs.applications.live.goals import goals_of
from symobs.applications.live.page import export_object, page_object
from symobs.applications.live.request import FieldError, Request, link_of, put_in, read
from symobs.applications.live.sentences import sentence, stability_of
from symobs.applications.live.time_responses import NoResponse, has_step, readout, responses_of
from symobs.exact import Matrix, Scalar
from symobs.exact.algebraic.enclosure import is_number
from symobs.exact.algebraic.root_location import complex_roots, root_boxes, value_at
from symobs.exact.time_functions.matrix_exponential import fraction_near
from symobs.formula.figures import LinePicture, PoleMap, RegionPicture
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
    UnknownName,
)
from symobs.pages.cards import Card, CardPrinter, cards
from symobs.pages.drawings.plot_file import is_shown
from symobs.pages.drawings.svg import svg, svg_scene
from symobs.pages.page.narrator import printer_for
from symobs.pages.printers.text_printer import TextPrinter
from symobs.problem.schema import kinds_of
from symobs.system import Symbols, read_scalar
from symobs.system.conditions import sign_of
from symobs.system.specification import is_pattern, read_poles
from symobs.tasks.analysis.stability_region.stability_region import StabilityRegion
from symobs.tasks.analysis.stability_region.stability_region_page import inequalities
from symobs.tasks.result import Document, result_type, task_named, tasks
from symobs.tasks.result.output_methods import to_json

if TYPE_CHECKING:
    from symobs.formula.phrases.languages import Language
    from symobs.problem import Problem
    from symobs.system import StateSpace
    from symobs.tasks.result import Case, Result


# A point of a stability region: the exact verdict there, the polynomial, and its roots in enclosing decimals.


_PLACES = 4


def numbers(at: Mapping[str, str]) -> dict[str, Fraction]:
    """Return the rational numbers of a point."""
    found = {}
    for name, text in at.items():
        value = read_scalar(text, Symbols.of({}), f"at.{name}")
        if value.names:
            raise FieldError("said_no_rational", f"at.{name}")
        found[name] = value.fraction()
    return found


def point_object(region: Any, at: Mapping[str, str], printer: CardPrinter) -> dict[str, Any]:
    """Return what is true at a point; `region` is a `StabilityRegion`."""
    critical, place = region.critical, numbers(at)
    boundary = critical.boundary
    missing = sorted((critical.polynomial.names | boundary.names) - {boundary.variable} - place.keys())
    if missing:
        raise InputError(f"a value is missing for {', '.join(missing)}", where="at", repair="give it in at")
    if boundary.names:
        values = {name: Scalar.of(place[name]) for name in boundary.names}
        critical = type(critical)(critical.polynomial, boundary.substitute(values), critical.signs)
    if value_at(critical.denominator, place) == 0:
        return {"verdict": "undefined", "roots": []}
    allowed = critical.allows({name: place[name] for name in critical.signs if name in place})
    chi = critical.polynomial.substitute({name: Scalar.of(value) for name, value in place.items()})
    stable = critical.is_stable(place)
    card = Card("polynomial", Relation((Letter("chi_p"), Literal(chi)), ("=",)), chi)
    vanishing = [factor for factor in critical.proper if factor.names <= place.keys() and not value_at(factor, place)]
    zero = Literal(Scalar.of(0))
    boundaries = [Card("boundary", Relation((Literal(factor), zero), ("=",)), factor) for factor in vanishing]
    on_edge = bool(vanishing) and not stable
    verdict = "stable" if stable and allowed else "boundary" if on_edge else "unstable" if allowed else "excluded"
    return {
        "verdict": verdict,
        "cards": [card_object(card, printer)],
        "boundary": [card_object(found, printer) for found in boundaries] if on_edge else [],
        "roots": [_root(box, power) for box, power in root_boxes(_coefficients(chi, boundary.variable), _PLACES)],
    }


def _coefficients(chi: Scalar, variable: str) -> list[Fraction]:
    return [coefficient.fraction() for coefficient in chi.coefficients(variable)]


def _root(box: tuple[Fraction, ...], multiplicity: int) -> dict[str, Any]:
    re_low, re_high, im_low, im_high = (_decimal(part) for part in box)
    return {"re": [re_low, re_high], "im": [im_low, im_high], "multiplicity": multiplicity}


def _decimal(value: Fraction) -> str:
    """Return a decimal of a few places; exact, since it was rounded to them before."""
    whole = abs(value * 10**_PLACES)
    digits = str(int(whole)).rjust(_PLACES + 1, "0")
    return f"{'-' if value < 0 else ''}{digits[:-_PLACES]}.{digits[-_PLACES:]}"


def card_object(card: Card, printer: CardPrinter, *, moving: bool = False) -> dict[str, str]:
    """Return a card in every form; nobody copies or reads aloud what is `moving`."""
    seen = {"name": card.name, "mathml": printer.mathml(card)}
    return seen if moving else {**seen, "latex": printer.latex(card), "says": printer.says(card)}


# -- the picture ------------------------------------------------------------------------------------------------------


def region_object(result: Any, language: Language) -> dict[str, Any]:
    """Return the checked picture of a region, where its plane lies in it, and a point to begin with."""
    picture = result.picture
    parameters = list(result.question.parameters)
    if picture is None or not is_shown(picture, result):
        return {"svg": "", "parameters": parameters, "handle": None}
    printer = printer_for(Document("", "", (result,), language=language.code), TextPrinter)
    scene = svg_scene(picture, printer)
    frame = scene.frame
    found: dict[str, Any] = {
        "svg": svg(scene, printer),
        "box": [
            scene.whole.left,
            -scene.whole.top,
            scene.whole.right - scene.whole.left,
            scene.whole.top - scene.whole.bottom,
        ],
        "frame": [frame.left, -frame.top, frame.right - frame.left, frame.top - frame.bottom],
        "drawn_for": {name: str(value) for name, value in picture.drawn_for},
        "parameters": parameters,
    }
    match picture:
        case RegionPicture():
            stable = [mark.place for mark in picture.marks if mark.kind == "stable"]
            (left, right), (bottom, top) = picture.window
            x, y = stable[0] if stable else ((left + right) / 2, (bottom + top) / 2)
            return found | {
                "kind": "plane",
                "parameters": list(picture.axes),
                "window": [[str(low), str(high)] for low, high in picture.window],
                "handle": [_near(x, (left, right)), _near(y, (bottom, top))],
            }
        case PoleMap():
            region = getattr(result, "region", None)
            samples = list((region if isinstance(region, StabilityRegion) else result).fields.get("sample_points", []))
            low, high = picture.values
            return found | {
                "kind": "locus",
                "window": [[str(a), str(b)] for a, b in picture.window],
                "values": [str(low), str(high)],
                "handle": [_sample(samples, parameters[0], (low, high))],
            }
        case LinePicture():
            low, high = picture.window
            inside = [place for place, kind in picture.marks if kind == "stable"]
            return found | {
                "kind": "line",
                "window": [[str(low), str(high)]],
                "values": [str(low), str(high)],
                "handle": [_near((inside or [(low + high) / 2])[0], (low, high))],
            }
    return found


def _sample(samples: list[Any], name: str, interval: tuple[Fraction, Fraction]) -> str:
    values = [Fraction(str(sample[name])) for sample in samples if isinstance(sample, dict) and name in sample]
    return _near((values or [(interval[0] + interval[1]) / 2])[0], interval)


def _near(value: Fraction, interval: tuple[Fraction, Fraction]) -> str:
    """Return a short number near a value, on a grid of twentieths where the window is wide enough."""
    width = interval[1] - interval[0]
    step = Fraction(1, 20)
    while step * 40 > width:
        step /= 10
    return str(round(value / step) * step)


# What a task shows and what can be moved in it: panels, sets of poles, cards.


@dataclass
class PoleSet:
    """Poles that can be moved: the key of the specification, the word for one of them, their mark, and their gain."""

    key: str
    label: str
    mark: str
    gain: str


_SETS = (
    PoleSet("control_poles", "control_pole", "cross", "K"),
    PoleSet("observer_poles", "observer_pole", "ring", "L"),
)


@lru_cache(maxsize=64)
def pole_sets(task: str) -> tuple[PoleSet, ...]:
    """Return the poles that can be moved: of a task with one gain they are called poles."""
    keywords, kind = tasks()[task].keywords, result_type(task)
    if "plane" not in kind.panels:
        return ()
    control, observer = _SETS
    if "poles" in keywords:
        return (replace(control if "K" in kind.gains else observer, key="poles"),)
    return tuple(found for found in _SETS if found.key in keywords)


def view_object(result: Result, specification: Any) -> dict[str, Any]:
    """Return what the front-end builds a task from."""
    plant, takes = result.plant, kinds_of(tasks()[result.task])
    moved = [found for found in pole_sets(result.task) if not _gives_polynomial(specification, found.key)]
    given = [found.gain for found in moved if found.gain in specification]
    sets = [
        {
            "key": _key_in(specification, found.key),
            "label": found.label,
            "mark": found.mark,
            "gain": found.gain if found.gain in takes and _is_whole(result.fields.get(found.gain), plant) else "",
        }
        for found in moved
        if found.gain not in given
    ]
    return {
        "task": result.task,
        "discrete": plant.is_discrete,
        "order": plant.order,
        "panels": [*result.panels, *["loop"] * shows_loop(result), "cards", "page"],
        "sets": sets,
        "given": given,
        "cards": list(result.cards or result.letters),
        "gains": list(result.gains),
        "step": has_step(result),
    }


def _is_whole(gain: Any, plant: StateSpace) -> bool:
    """Return whether a gain may be given, too: that of an observer of minimal order depends on its coordinates."""
    return isinstance(gain, Matrix) and plant.order in gain.shape


def _key_in(specification: Any, key: str) -> str:
    """Return the key under which a file gives the poles: a half of a compensator may be asked for by its own name."""
    halves = [f"{half}_{key}" for half in ("control", "observer")] if key == "poles" else []
    return next((name for name in halves if name in specification and key not in specification), key)


def _gives_polynomial(specification: Any, key: str) -> bool:
    return key not in specification and key.replace("poles", "polynomial") in specification


#: Solved problems that are kept: those of the tabs that are open, and what a drag comes back to.
_KEPT = 8


@dataclass
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
    except OverflowError:  # exact numbers have no bounds, those of a screen have
        return head | {"status": "undecided", "message": "a number is too large or too small to be drawn"}
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
        elif (name := _declarable(each)) is not None:
            message = language.phrases["said_undeclared"].format(name=name)
            found.append({"where": each.where, "message": message, "repair": "", "undeclared": name})
        else:
            found.append({"where": each.where, "message": each.message, "repair": each.repair, "lang": "en"})
    return found


def _declarable(error: SymobsError) -> str | None:
    """Return a name that only has to be declared; of one that may be a misspelling or a function the error says so."""
    name = str(error.facts.get("name"))
    is_one = isinstance(error, UnknownName) and not error.where.startswith("at.")
    return name if is_one and f'add {name} = "real"' in error.repair else None


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
    given = dict(table) if isinstance(table, Mapping) else {}
    declared = Symbols.of(given | ({"k": "nonnegative"} if asked.data.get("task") == "root_locus" else {}))
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
    notes += _notes(there.result, printer)
    claims, stable = len(result.all_certificates), stability_of(result)
    if asked.names is None and isinstance(result, StabilityRegion):
        found += tuple(Card(f"stable_if_{k}", each, None) for k, each in enumerate(inequalities(result), 1))
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
        "cards": [card_object(card, printer, moving=asked.moving) for card in found],
        "readouts": _readouts(there),
        "marks": _marks(there),
        "says": sentence(result, stable, printer),
        "unstable": [str(pole) for pole in stable.poles] if result.gains and result.verdict != "no" else [],
        "courses": responses,
        "goal": _goals(there, asked, responses),
    }
    if asked.loop != "none":
        whole["loop"] = frequency_response(there.result, language, moving=asked.loop == "moving")
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
    region: Any = found.result.region if found.result.task == "root_locus" else found.result
    if not isinstance(region, StabilityRegion):
        raise InputError("only a stability region has points", where="want", repair='ask for "answer"')
    printer = CardPrinter(found.result, found.problem.convention, language_named(found.problem.language))
    return {"status": "done", **point_object(region, asked.at, printer)}


def _view(asked: Request) -> dict[str, Any]:
    found = _as_given(asked)
    whole = view_object(found.result, found.problem.specification)
    symbols = found.result.plant.symbols
    whole["symbols"] = {name: symbols.sign(name) for name in sorted(symbols.signs)}
    if "region" in found.result.panels:
        whole["region"] = region_object(_there(asked).result, language_named(found.problem.language))
    return {"status": "done", "verdict": found.result.verdict, "view": whole}


def _export(asked: Request) -> dict[str, Any]:
    found = _there(asked) if asked.cards_at else _as_given(asked)
    data = put_in(asked.data, asked.at) if asked.cards_at else asked.data
    text = export_object(found.problem, found.result, asked.export, data, found.result.task)
    return {"status": "done", **text}


def _begin(asked: Request) -> dict[str, Any]:
    """Return the link of the problem on the screen as one of another task, which has an answer."""
    task = None if asked.task is None else task_named(asked.task)
    if task is None:
        raise InputError("the name of a task is expected", where="task", repair='write for example "task": "observer"')
    return {"status": "done", "link": link_of(begun(asked.data, task))}


def _start(_: Request) -> dict[str, Any]:
    from symobs.applications.live.page import examples  # noqa: PLC0415
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
    "begin": _begin,
}


def _goals(there: Solved, asked: Request, responses: dict[str, Any] | None) -> dict[str, dict[str, Any]]:
    """Return what was wanted of the loop: its poles are those that were asked for, and those of given gains."""
    if not asked.goal and not (responses and responses["step"]):
        return {}
    loops = (matrix for _, matrix in _loops_of_given_gains(there))
    poles = [*((re, im) for _, re, im in _placed(there)), *(pole for loop in loops for pole in _eigenvalues(loop))]
    return goals_of(there.result, poles, asked.goal, responses)


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


def _placed(solved: Solved) -> Iterator[tuple[str, Fraction, Fraction]]:
    """Yield every pole that was given as a number, a pair once, with the name of its handle."""
    plant, designs = solved.result.plant, halves(solved.result)
    for group in pole_sets(solved.result.task):
        for key in (group.key, *(f"{half}_{group.key}" for half in ("control", "observer"))):
            given = solved.problem.specification.get(key)
            if given is None or is_pattern(given):
                continue
            asked = getattr(designs.get(key), "desired", None)
            poles = asked.poles if asked else read_poles(given, plant.symbols, f"specification.{key}")
            upper = [pole for pole in poles if pole.imaginary.names or pole.imaginary.fraction() >= 0]
            for place, pole in enumerate(upper):
                if not pole.real.names and not pole.imaginary.names:
                    yield f"{key}.{place}", pole.real.fraction(), pole.imaginary.fraction()


def _readouts(solved: Solved) -> list[dict[str, str]]:
    """Return frequency, damping, overshoot and settling time of every pole that was given as a number."""
    is_discrete = solved.result.plant.is_discrete
    return [{"handle": handle, **readout(*pole, discrete=is_discrete)} for handle, *pole in _placed(solved)]


def _marks(solved: Solved) -> list[dict[str, str]]:
    """Return what is not moved in the plane: poles of the plant, of F, of a loop; decimals for drawing alone."""
    result, plant = solved.result, solved.result.plant
    known: list[tuple[str, Any]] = []
    if plant.polynomial is None and not plant.is_time_varying and "plane" in result.panels:
        known.append(("plant", plant.matrices.A))
        known.append(("F", result.fields.get("compensator_matrix")))
        known.append(("loop", result.loop_matrix))
        known += _loops_of_given_gains(solved)
    return [
        {"kind": kind, "re": f"{float(real):.6f}", "im": f"{float(imaginary):.6f}"}
        for kind, matrix in known
        for real, imaginary in _eigenvalues(matrix)
    ]


def _loops_of_given_gains(solved: Solved) -> Iterator[tuple[str, Matrix]]:
    """Yield the matrix of the loop that a given gain closes, under the word for one of its poles."""
    result, m = solved.result, solved.result.plant.matrices
    for group in pole_sets(result.task):
        gain = result.fields.get(group.gain)
        if group.gain in solved.problem.specification and gain is not None:
            yield group.label, m.A - (m.B @ gain if group.gain == "K" else gain @ m.C)


def _eigenvalues(matrix: Matrix | None) -> list[tuple[Fraction, Fraction]]:
    """Return them rounded; none where an entry is no number."""
    if matrix is None or not all(map(is_number, matrix.entries)):
        return []
    chi = matrix.characteristic_polynomial("s").coefficients("s")
    return complex_roots(list(map(fraction_near, chi)))


#: Designs whose fixed modes are those of a pair.
_PAIRS = {"state_feedback": "(A, B)", "observer": "(C, A)", "reduced_order_observer": "(C, A)"}


def _notes(result: Result, printer: CardPrinter) -> list[str]:
    """Return why there is no design, and what a look at the curves may miss."""
    notes, said = [], printer.language.phrases
    for part in list(halves(result).values()) or [result] if result.verdict == "no" else []:
        if fixed := part.fields.get("fixed_modes") or ():
            kind = f"said_{'fixed' if part.task in _PAIRS else 'unmoved'}_mode{'s' * (len(fixed) > 1)}"
            notes.append(said[kind].format(modes=printer.roots(fixed), pair=_PAIRS.get(part.task)))
    return notes + [said["said_unstable_compensator"]] * (result.fields.get("compensator_stable") == "no")
