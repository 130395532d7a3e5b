"""The question of a problem as a page: its data, and a sentence or two for every task.

The sentences stand beside each task, among its phrases; which of them are said follows from what the specification
contains.  The page is a derivation like any other: what it states is checked, and it is told by the same narrator.
"""

from __future__ import annotations

import itertools
import string
from functools import cached_property, partial
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

from symobs.exact import Matrix, Scalar, factored, root_of_pole
from symobs.formula.expression import parse_polynomial
from symobs.formula.phrases import QUESTIONS
from symobs.formula.phrases.english.question_phrases import UNSAID
from symobs.formula.tree import LetterList, Roots, SymbolList
from symobs.ground.dataclass import dataclass
from symobs.pages.cards import formula_named
from symobs.problem.schema import keys_of
from symobs.problem.validation import gains_from
from symobs.proof.derivation import Note, Section, translated
from symobs.proof.derivation.builder import Builder, relation, sentence
from symobs.system import read_matrix, read_scalar
from symobs.system.reading import has_decimals
from symobs.system.specification import (
    desired_polynomial,
    from_list,
    is_pattern,
    parse_in_steps,
    parse_signal,
    read_entries,
    read_interval,
    read_names,
    read_poles,
    read_quantity,
)
from symobs.system.transfer_function_text import read_transfer_function
from symobs.tasks.analysis.linearisation_page import ask_to_linearise
from symobs.tasks.analysis.page_parts import formula_of_factored, given, state_signs
from symobs.tasks.analysis.time_response.horizons import INFINITE, read_horizon
from symobs.tasks.result import Document
from symobs.tasks.result.in_convention import names_in
from symobs.tasks.result.output_methods import DIGITS
from symobs.tasks.result.registry import result_type

if TYPE_CHECKING:
    from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence

    from symobs.formula.tree.term import Term
    from symobs.problem.validation import Problem
    from symobs.proof.derivation import Derivation, Sentence
    from symobs.proof.derivation.builder import Slot
    from symobs.system import StateSpace
    from symobs.tasks.result import Task

#: Keywords whose matrices stand among the data, and the letters they have there.
_DATA = {"K": "K", "L": "L", "T": "T", "reference_matrix": "A_ref", "reference_start": "x_d0"}
_DATA |= {"E": "E_d", "S": "S_w", "V": "V_w", "reference": "Q_r"}  # of exosystems
#: The letters of weights and intensities, by task and keyword, and how many rows a number stands for as a multiple of I.
_WEIGHTS = {
    ("lqr", "Q"): ("Q_x", "order"),
    ("lqr", "R"): ("R_u", "inputs"),
    ("lqr", "N"): ("N_x", ""),
    ("kalman", "G"): ("G_n", ""),
    ("kalman", "N"): ("N_n", ""),
    ("kalman", "W"): ("W_n", "order"),
    ("kalman", "V"): ("V_n", "outputs"),
    ("lyapunov", "Q"): ("Q_l", "order"),
    ("lyapunov", "P"): ("P_l", "order"),
}
#: Kinds of keyword whose value is a word: the word chooses the sentence.
_WORDS = {"Name", "Sign"}


@dataclass
class Question(Document):
    """A question: a document without results."""

    page: Derivation | None = None
    #: The fields that each task asks for; none means its verdict.
    asked: Mapping[str, tuple[str, ...]] = MappingProxyType({})

    @property
    def letters_asked(self) -> frozenset[str]:
        """The letters of what the tasks ask for."""
        of_the_plant = {
            task: names for task, names in self.asked.items() if task != "unknown_input_observer"
        }  # (C, TA)
        return frozenset(
            result_type(task).letters.get(name, name) for task in of_the_plant for name in self.asked[task]
        )

    @cached_property
    def derivations(self) -> tuple[Derivation, ...]:
        """The page that states data and tasks, in the signs of the convention."""
        return (translated(self.page, self.convention),) if self.page is not None else ()


#: Tasks whose answer may depend on parameters, and is then told with the values for which it is no.
_MAY_DEPEND = {"observability", "controllability", "detectability", "stabilizability"}


def question_of(problem: Problem) -> Question:
    """Return the question of a problem; raises `InputError` where its specification cannot be read."""
    asked = [(task, dict(_values(task, problem))) for task in problem.tasks]
    page = Builder(problem.plant, {"x_d": problem.plant.order} if _has(asked, "reference_matrix") else None)
    page.in_time(*(value for _, values in asked for value in values.values() if isinstance(value, Scalar | Matrix)))
    page.asked_for(problem.specification)
    _state_data(page, asked)
    parts: dict[str, tuple[str, ...]] = {}
    with page.section("tasks" if len(asked) > 1 else "task"):
        if problem.plant.nonlinear is not None and problem.plant.nonlinear.equilibrium:
            ask_to_linearise(page)
        for place, (task, values) in enumerate(asked):
            if len(asked) > 1:
                page.remark("part", letter=_letter_of(place))
            for key in sentences_for(task, tokens_of(task, values, problem)):
                page.steps.append(Note(_filled(page, task, key, values)))
            origins = gains_from(task, values, [each.name for each, _ in asked[:place]])
            for letter, origin in origins.items():
                page.remark(f"uses_{letter}", part=_letter_of(origin))
            parts[task.name] = _parts_asked(task, {*values, *origins}, problem)
            _ask_for(page, task, parts[task.name], problem)
            if task.name in _MAY_DEPEND and problem.plant.field.names:
                page.remark("exceptions_asked")
            if task.name == problem.plant_of:
                page.remark("plant_found", letter=_letter_of(place))
    typed = problem.plant.is_in_decimals or has_decimals([*problem.specification.values()])
    digits = DIGITS if problem.digits is None and typed else problem.digits
    of_page: dict[str, Any] = {
        "page": page.derivation(),
        "asked": parts,
        "digits": digits,
        "language": problem.language,
    }
    return Question(problem.title, problem.source, (), problem.convention, problem.text, **of_page)


def _has(asked: Iterable[tuple[Task, Mapping[str, Any]]], name: str) -> bool:
    return any(name in values for _, values in asked)


def _letter_of(place: int) -> str:
    letters = string.ascii_lowercase
    return letters[place] if place < len(letters) else str(place + 1)


# -- what is given ----------------------------------------------------------------------------------------------------


def _state_data(page: Builder, asked: Iterable[tuple[Task, Mapping[str, Any]]]) -> None:
    """State the plant, or the polynomial, and the matrices of the specification."""
    polynomial = page.plant.polynomial
    if polynomial is None:
        given(page, is_question=True)
    else:
        with page.section("given"):
            page.given(relation(page["chi_p"], polynomial))
            state_signs(page)
    data: dict[str, Any] = {}
    for task, values in asked:
        for name, value in values.items():
            letter, size = _WEIGHTS.get((task.name, name), (_DATA.get(name, ""), ""))
            if letter:
                data[letter] = _as_matrix(value, size, values.get("G"), page.plant)
    stated = page.steps[0]
    if not data or not isinstance(stated, Section):
        return
    with page.section("given"):
        for letter, value in data.items():
            if letter == "A_ref":
                page.set(letter, value)
                page.given(relation(page["x_d"].derivative, page.value(value) @ page["x_d"]))
            else:
                page.given(relation(page[letter], value))


def _as_matrix(value: Any, size: str, entering: object, plant: StateSpace) -> Any:
    """Return a number that stands for a multiple of I as that matrix."""
    if not size or not isinstance(value, Scalar):
        return value
    rows = entering.shape[1] if size == "order" and isinstance(entering, Matrix) else getattr(plant, size)
    return Matrix.identity(rows) * value


# -- what is asked ----------------------------------------------------------------------------------------------------


def tokens_of(task: Task, values: Mapping[str, Any], problem: Problem) -> frozenset[str]:
    """Return the specification of a task, by the keys of its sentences."""
    tokens: set[str] = set()
    for name, value in values.items():
        kind = task.keywords[name]
        if kind in _WORDS:
            tokens |= {f"{name}={value}"} - {f"method={word}" for word in UNSAID}
        elif value == INFINITE:
            tokens.add(f"{name}=inf")
        elif not (name == "polynomial" and problem.plant.polynomial is not None):
            tokens.add(name)
        if kind == "Poles" and value.degree == 1:
            tokens.add(f"{name}=1")
    return frozenset(tokens - {"horizon"} | ({"discrete"} if problem.plant.is_discrete else set()))


def sentences_for(task: Task, tokens: frozenset[str]) -> list[str]:
    """Return the keys of sentences that together cover the specification, the most comprehensive one first."""
    asks = [
        words for words in map(str.split, QUESTIONS) if words[:2] == ["ask", task.name] and tokens.issuperset(words[2:])
    ]
    if not asks:
        return ["asked"]
    best = max(asks, key=lambda words: sum(1 + ("=" in word) for word in words[2:]))
    left = {name: word for word in sorted(tokens - set(best[2:])) for name in [word.partition("=")[0]]}
    said = {word.partition("=")[0] for word in best[2:]}
    further = [left[name] for name in task.keywords if name in left and name not in said]
    also = [key for word in further for key in (f"also {task.name} {word}", f"also {word}") if key in QUESTIONS]
    return [" ".join(best), *dict.fromkeys(key for key in also if QUESTIONS[key])]


def _parts_asked(task: Task, given: Collection[str], problem: Problem) -> tuple[str, ...]:
    """Return the fields that a task asks for: those of `[marking] asked`, else those that answer it."""
    kind = result_type(task.name)
    marked = [part.split(".", 1) for part in problem.marking.asked]
    own = {name: standard for name, (standard, _) in names_in(problem.convention, task.name).items()}
    named = tuple(own.get(name, name) for of, name in marked if of == task.name)
    return named if marked else kind.fields_asked(given)


def _ask_for(page: Builder, task: Task, parts: Sequence[str], problem: Problem) -> None:
    """Say which letters answer a task; what has none is named by its sentence, or by the marks."""
    kind = result_type(task.name)
    of_time = {*kind.functions_of_time.values()}  # their sentences call them by name, in continuous and discrete time
    letters = {name: letter for name, letter in kind.letters.items() if name not in of_time}
    if named := [formula_named(letters[name]) for name in parts if name in letters]:
        page.remark("give", letters=LetterList(tuple(named)))
        if (key := f"means {task.name}") in QUESTIONS:
            page.remark(key)
    without = [name.replace("_", " ") for name in problem.marking.asked and parts if name not in kind.letters]
    if fields := [name for name in without if name not in {"verdict", "conditions"}]:
        page.remark("give_fields", names=", ".join(fields))


def _filled(page: Builder, task: Task, key: str, values: Mapping[str, Any]) -> Sentence:
    """Return a sentence with its slots filled."""
    if key == "asked":
        return sentence(key, {"summary": task.summary})
    slots: dict[str, Slot] = {}
    for _, name, _, _ in string.Formatter().parse(QUESTIONS[key]):
        if name is None:
            continue
        if name in {"start", "end"}:
            slots[name] = page.value(values["interval"][name == "end"])
        else:
            slots[name] = _slot(page, task, name, values[name])
    return sentence(key, slots)


def _slot(page: Builder, task: Task, name: str, value: Any) -> Slot:
    """Return a value as it stands in a sentence."""
    match task.keywords[name]:
        case "Poles":
            own = "phi_o" if name == "observer_poles" or task.name.endswith("observer") else "phi_c"
            # several designs have poles of their own
            letters = itertools.chain((own,), (f"phi_{place}" for place in itertools.count(1)))
            letter = next(x for x in letters if not page.defines(x) or page[x].value == value.polynomial)
            phi = page[letter] if page.defines(letter) else page.set(letter, value.polynomial)
            return Roots(phi.formula, tuple(root_of_pole(pole, page.plant.variable) for pole in value.poles))
        case "PolynomialText":
            form: Term = page.term(formula_of_factored(factored(value, page.plant.variable, monic=False)))
            return form
        case "Names":
            return SymbolList(value)
        case "Entries":
            return ", ".join(f"({row + 1}, {column + 1})" for row, column in value)
    if isinstance(value, Matrix) and value.shape == (1, 1):
        return page.value(value[0, 0])
    return page.value(value)


# -- reading ----------------------------------------------------------------------------------------------------------


def _values(task: Task, problem: Problem) -> Iterator[tuple[str, Any]]:
    """Yield what the specification contains for a task, read."""
    specification = problem.specification_of(task)
    keys = keys_of(task, specification)
    if (
        task.name in {"pbh", "gramian"}
        and "of" not in keys
        and problem.plant.pair_asked_for("auto") == "controllability"
    ):
        yield "of", "controllability"
    parameters = specification.get("parameters")  # to name them declares them
    plant = problem.plant.with_symbols(problem.plant.symbols.naming(parameters, "specification.parameters"))
    for name, kind in task.keywords.items():
        if name in keys and is_pattern(specification[keys[name]]):
            yield name.replace("poles", "polynomial"), _read_pattern(problem, task, name, keys[name])
        elif name in keys:
            yield name, _read(specification[keys[name]], kind, name, plant, task.name)
        elif kind == "Horizon":
            yield name, read_horizon(problem.plant, None)
    if task.name == "stability_region" and "parameters" not in specification:
        parameters = _free_parameters(problem)
        if parameters:
            yield "parameters", parameters


def _read_pattern(problem: Problem, task: Task, name: str, key: str) -> Scalar:
    """Return the polynomial of poles that are given by what they are to do."""
    plant, asked = problem.plant, problem.specification_of(task)
    degree = task.degree(name, plant, asked)
    found = desired_polynomial(plant, asked[key], None, names=(key, key), degree=degree)
    assert found is not None  # noqa: S101 - they are given
    return found.polynomial


def _free_parameters(problem: Problem) -> tuple[str, ...]:
    """Return the parameters of the region where none are named."""
    from symobs.tasks.analysis.stability_region.stability_region import read_question  # noqa: PLC0415 - only questions of regions

    asked = problem.specification_of(next(task for task in problem.tasks if task.name == "stability_region"))
    gains = {"K": asked.get("K"), "L": asked.get("L")}
    limits = asked.get("margin"), asked.get("radius")
    return read_question(problem.plant, gains, None, *limits, asked.get("controller")).parameters


def _read(value: object, kind: str, name: str, plant: StateSpace, task: str) -> Any:
    """Return a value of the specification as the task reads it."""
    where = f"specification.{name}"
    match kind:
        case "Poles":
            poles = read_poles(value, plant.symbols, where)
            return desired_polynomial(plant, value, None, names=(name, name), degree=len(poles))
        case "PolynomialText":
            return parse_polynomial(value, plant.variable, plant.symbols.names, where=where, functions=True)
        case "TransferFunctionText":
            return read_transfer_function(value, plant.symbols, plant.variable, where).value
        case "GainText" | "MatrixText":
            column = name in {"L", "E", "impulse", "initial", "final"}
            return read_matrix(from_list(value, column=column), plant.symbols.seen(value), where, functions=True)
        case "IntervalText":
            return read_interval(value, plant)
        case "SignalText" | "TimeFunctions":
            return (parse_in_steps if plant.is_discrete else partial(parse_signal, functions=True))(
                value, plant.symbols, where
            )
        case "Horizon":
            return read_horizon(plant, value)
        case "Intensity":
            is_matrix = isinstance(value, list) or (isinstance(value, str) and value.strip().startswith("["))
            return (read_matrix if is_matrix else read_scalar)(value, plant.symbols.seen(value), where)
        case "Entries":
            shape = (plant.order, plant.outputs) if task == "observer" else (plant.inputs, plant.order)
            return read_entries(value, name, shape)
        case "Quantity":
            return read_quantity(value, plant, name)
        case "Names":
            return read_names(value, name)
        case _:
            return value
