"""Which candidates become variants: the cheap tests, the constraints, the profile and the keys of what is distinct."""

from __future__ import annotations

from collections.abc import Mapping
from functools import lru_cache
from typing import TYPE_CHECKING, Any, NamedTuple

from symobs.applications.batch.jobs import canonical, digest
from symobs.applications.batch.solving import problem_of
from symobs.applications.batch.solving import recheck as recheck_answers
from symobs.applications.checking.parts import asked_of
from symobs.applications.variants.constraints import UNLIKE, beyond, broken, profile, unknown_names
from symobs.applications.variants.constructions import CONSTRUCTIONS
from symobs.applications.variants.drawing import (
    Draws,
    Poly,
    Rows,
    adjugate,
    common_divisor,
    each_signed_permutation,
    evaluated,
    identity,
    krylov,
    of_poles,
    plus,
    primitive,
    quotient,
    rank,
    times,
    transposed,
    trimmed,
)
from symobs.applications.variants.parameters import RELATION, Poles, in_text, matrix_text, text_of, with_values
from symobs.exact import Matrix
from symobs.formula.expression import parse_matrix, parse_poles, parse_polynomial, parse_scalar
from symobs.formula.expression.source import shown
from symobs.ground.errors import CertificateRejected, InputError, SymobsError
from symobs.pages.formats.json import answer_object
from symobs.problem.expect import found_in, mismatches
from symobs.problem.schema import kinds_of
from symobs.tasks.result import task_named
from symobs.tasks.result.output_methods import to_json

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence
    from fractions import Fraction

    from symobs.applications.variants.constructions import Made
    from symobs.applications.variants.parameters import Value
    from symobs.applications.variants.table import Table
    from symobs.problem import Problem
    from symobs.tasks.result import Result
    from symobs.tasks.result.in_convention import ResultInConvention


# A candidate: a problem made from the draws of one number, not yet known to be a variant.


#: The keys that say what one half of a compensator is to be; a file that gives one of them says it itself.
_HALVES = {
    "control_poles": ("control_poles", "control_polynomial", "poles", "polynomial", "K"),
    "observer_poles": ("observer_poles", "observer_polynomial", "poles", "polynomial", "L"),
}


class Candidate(NamedTuple):
    """A problem's tables, the values that were drawn, and its matrices where they are of whole numbers."""

    number: int
    data: Mapping[str, Any]
    values: Mapping[str, Value]
    matrices: Mapping[str, Rows]
    #: Rows, columns and zeros of each matrix of numbers.
    shapes: Mapping[str, tuple[int, int, int]]
    #: The ranks of 𝒞 and 𝒪 that a construction means to have.
    ranks: tuple[int, int] | None = None

    @property
    def is_whole(self) -> bool:
        """Return whether A, and what else there is of a plant, are of whole numbers."""
        given = {name for name in "ABCD" if name in self.data.get("plant", {})}
        return "A" in given and given == set(self.matrices)


def candidate(table: Table, seed: int, number: int) -> Candidate:
    """Return a candidate; raises `InputError` where a matrix stands within an expression."""
    draws = Draws(seed, number)
    values = {name: parameter.drawn(draws[name]) for name, parameter in table.parameters.items()}
    # What is expected beside a plant of the file's own is expected of that alone.
    base = {key: each for key, each in table.base.items() if key != "expect" or table.like != "base"}
    data = with_values(base, values)
    if table.construct is None:
        return _tidied(Candidate(number, data, values, {}, {}))
    made = CONSTRUCTIONS[table.construct][0](draws, table.shape)
    plant = {name: entry for name, entry in data.get("plant", {}).items() if name not in "ABC"}
    if "dt" in made.specification:
        data["plant"] = {"dt": made.specification["dt"], **plant}
    if made.plant:
        data["plant"] = {**{name: matrix_text(rows) for name, rows in made.plant.items()}, **plant}
    data["specification"] = _specified(data, made)
    sizes = table.shape.get("sizes")
    ranks = (sizes[0] + sizes[1], sizes[0] + sizes[2]) if sizes else None
    return _tidied(Candidate(number, data, values, made.plant, {}, ranks))


def base_candidate(table: Table) -> Candidate:
    """Return the problem that the file has of its own."""
    return _tidied(Candidate(-1, with_values(table.base, {}), {}, {}, {}))


def _specified(data: Mapping[str, Any], made: Made) -> dict[str, Any]:
    """Return the specification with what was drawn for it, where the file leaves that open and a task reads it."""
    given = dict(data.get("specification", {}))
    names = tasks_of(data)
    read = {key for name in names if (task := task_named(name)) is not None for key in kinds_of(task)}
    is_reduced = given.get("observer") == "minimal" or "reduced_order_observer" in names
    for key, value in made.specification.items():
        if key not in read or any(other in given for other in _HALVES.get(key, (key,))):
            continue
        if isinstance(value, Poles) and key == "observer_poles" and is_reduced:
            value = Poles(value.pairs[: len(value.pairs) - len(made.plant["C"])])  # noqa: PLW2901
        given[key] = text_of(value) if isinstance(value, Poles) else value
    return given


def tasks_of(data: Mapping[str, Any]) -> list[str]:
    """Return the names of a problem's tasks."""
    value = data.get("tasks", data.get("task", []))
    return [name for name in (value if isinstance(value, list) else [value]) if isinstance(name, str)]


def _tidied(found: Candidate) -> Candidate:
    """Return a candidate whose matrices of numbers are written plainly, and known where they are whole."""
    plant = found.data.get("plant")
    if not isinstance(plant, dict):
        return found
    matrices = dict(found.matrices)
    shapes = {name: _shape(rows) for name, rows in matrices.items()}
    for name in "ABCD":
        if name in plant and name not in matrices:
            entries = _entries(plant[name])
            if entries is None:
                continue
            plant[name] = matrix_text(entries)
            shapes[name] = _shape(entries)
            if all(entry.denominator == 1 for row in entries for entry in row):
                matrices[name] = tuple(tuple(int(entry) for entry in row) for row in entries)
    return found._replace(matrices=matrices, shapes=shapes)


def _shape(rows: Sequence[Sequence[object]]) -> tuple[int, int, int]:
    return len(rows), len(rows[0]), sum(not entry for row in rows for entry in row)


def _entries(value: object) -> tuple[tuple[Any, ...], ...] | None:
    """Return the fractions of a matrix of numbers; None for any other one, and for what cannot be read."""
    try:
        matrix = parse_matrix(value, {})
        return tuple(tuple(entry.fraction() for entry in row) for row in matrix.rows)
    except (SymobsError, ArithmeticError, ValueError):
        return None


# -- what is desired --------------------------------------------------------------------------------------------------


def desired(data: Mapping[str, Any], half: str) -> Poly | None:
    """Return the polynomial desired for control or observer where it has whole coefficients, None otherwise."""
    given = data.get("specification", {})
    alone = len(tasks_of(data)) == 1
    for prefix in (f"{half}_", *([""] if alone else [])):
        if f"{prefix}poles" in given:
            return _of_text(str(_listed(given[f"{prefix}poles"])))
        if f"{prefix}polynomial" in given:
            return _of_polynomial(str(given[f"{prefix}polynomial"]))
    return None


def _listed(value: object) -> object:
    return ", ".join(map(str, value)) if isinstance(value, list) else value


@lru_cache(maxsize=4096)
def _of_text(text: str) -> Poly | None:
    """Return the polynomial of whole poles; those with imaginary parts are left to the engine."""
    try:
        return of_poles((int(part), 0) for part in text.split(","))
    except ValueError:
        return None


@lru_cache(maxsize=4096)
def _of_polynomial(text: str) -> Poly | None:
    try:
        found = [entry.fraction() for entry in parse_polynomial(text, "s", {}).coefficients("s")]
    except (SymobsError, ArithmeticError, ValueError):
        return None
    whole = all(entry.denominator == 1 for entry in found) and found[0] == 1
    return tuple(int(entry) for entry in reversed(found)) if whole else None


def pole_kinds(data: Mapping[str, Any]) -> list[list[Any]]:
    """Return of every list of poles how often each stands there, and whether it is real."""
    given = data.get("specification", {})
    found = []
    for key in sorted(key for key in given if key.endswith("poles")):
        poles = [part.strip() for part in str(_listed(given[key])).split(",")]
        counts = sorted(f"{'complex' if 'i' in pole else 'real'} {poles.count(pole)}" for pole in set(poles))
        found.append([shown(key, 40), *counts])
    return found


def _is_slow(found: Candidate, own: Mapping[str, Any]) -> bool:
    """Return whether an observer's error decays no faster than the loop; both sets of poles may be a file's `own`."""
    given = found.data.get("specification", {})
    halves = [key for key in ("control_poles", "observer_poles") if key in given]
    if len(halves) < 2 or all(given[key] == own.get(key) for key in halves):
        return False
    is_discrete = bool(found.data.get("plant", {}).get("dt"))
    control, observer = (_rates(str(_listed(given[key])), is_discrete) for key in halves)
    return bool(control and observer) and max(observer) >= min(control)


@lru_cache(maxsize=4096)
def _rates(text: str, is_discrete: bool) -> tuple[Fraction, ...]:  # noqa: FBT001 - a key of the cache
    """Return the real parts of poles, in discrete time the squares of their absolute values; none where they are no numbers."""
    try:
        parts = [(pole.real.fraction(), pole.imaginary.fraction()) for pole in parse_poles(text)]
    except (SymobsError, ArithmeticError, ValueError):
        return ()
    return tuple(real**2 + imaginary**2 if is_discrete else real for real, imaginary in parts)


# The cheap tests of a candidate, in Python's whole numbers: they cost a thousandth of solving it.
#
# What they find of gains is compared with what the engine finds; a difference is a bug of symobs.


_DESIGNS = {"compensator", "observer", "state_feedback", "feedforward", "reduced_order_observer"}
#: Which gains of single-input or single-output plants are known beforehand, by task.
_KNOWN = {"compensator": ("K", "L"), "observer": ("L",), "state_feedback": ("K",)}


class Cheap(NamedTuple):
    """Why a candidate is none, or what is known of its answers."""

    reason: str | None = None
    gains: Mapping[str, Rows] = {}


def cheap(table: Table, found: Candidate, kind: Mapping[str, Any] | None = None) -> Cheap:
    """Return what the cheap tests find; `kind` is that of the data of the problem that candidates are to be like."""
    for relation in table.when:
        if not holds(relation, found):
            return Cheap(f"when: {relation}")
    if _is_slow(found, table.base.get("specification", {})):
        return Cheap("the observer is no faster than the control")
    constraints = table.constraints
    digits: Mapping[str, int] = constraints.get("digits", {})
    for name, rows in found.matrices.items():
        if longest(rows) > digits.get(name, digits.get("*", 99)):
            return Cheap(f"{name} has too many digits")
    if kind is not None and kind_of(found) != kind:
        return Cheap(UNLIKE)
    if not found.is_whole:
        return Cheap()
    return _of_plant(found, constraints, digits)


def _of_plant(found: Candidate, constraints: Mapping[str, Any], digits: Mapping[str, int]) -> Cheap:
    """Return what the ranks and the gains say."""
    A, B, C = (found.matrices.get(name) for name in "ABC")
    order = len(A or ())
    if A is None or any(len(row) != order for row in A) or (B and len(B) != order) or (C and len(C[0]) != order):
        return Cheap()
    tasks = set(tasks_of(found.data))
    controllability = _stacked(A, B) if B else None
    observability = transposed(_stacked(transposed(A), transposed(C))) if C else None
    ranks = tuple(rank(each) if each else None for each in (controllability, observability))
    if found.ranks is not None and ranks != found.ranks:
        return Cheap("the parts have other sizes")
    for name, value in zip(("controllable", "observable"), ranks, strict=True):
        wanted = constraints.get(name)
        if value is not None and wanted is not None and wanted != (value == order):
            return Cheap(f"{name} is not {str(wanted).lower()}")
    if found.data.get("specification", {}).get("observer") == "minimal" or "reduced_order_observer" in tasks:
        first = next((entry for entry in (C or ((),))[0] if entry), 0)
        if constraints.get("integer") and first not in {1, -1}:
            return Cheap("[C; R] is not unimodular")
        return Cheap()
    if not tasks & _KNOWN.keys():
        return Cheap()
    return _gains(found, constraints, digits, (controllability, observability), tasks)


def _gains(
    found: Candidate,
    constraints: Mapping[str, Any],
    digits: Mapping[str, int],
    stacks: tuple[Rows | None, Rows | None],
    tasks: set[str],
) -> Cheap:
    """Return the gains of a plant with one input and one output, and whether they are whole and short enough."""
    A, order = found.matrices["A"], len(found.matrices["A"])
    known = {name for task in tasks for name in _KNOWN.get(task, ())}
    halves = {"K": ("control", stacks[0], A), "L": ("observer", stacks[1], transposed(A))}
    gains: dict[str, Rows] = {}
    for name, (half, stack, of) in halves.items():
        phi = desired(found.data, half) if name in known else None
        if stack is None or phi is None or len(phi) != order + 1 or len(stack[0]) != order or len(stack) != order:
            continue
        inverse, determinant, _ = adjugate(stack if name == "K" else transposed(stack))
        if not determinant:
            return Cheap("the poles cannot be placed")
        row = transposed(evaluated(phi, transposed(of), transposed(inverse[-1:])))
        if any(entry % determinant for entry in row[0]):
            if name in constraints.get("integer", ()):
                return Cheap(f"{name} is not whole")
            continue
        gain = tuple(tuple(entry // determinant for entry in each) for each in row)
        gains[name] = gain if name == "K" else transposed(gain)
        if longest(gain) > digits.get(name, digits.get("*", 99)):
            return Cheap(f"{name} has too many digits")
        if name in constraints.get("answers_nonzero", ()) and any(not entry for entry in gain[0]):
            return Cheap(f"{name} has an entry 0")
    if gains.keys() >= {"K", "L"} and "compensator" in tasks:
        fraction = controller(found.matrices, gains["K"], gains["L"])
        if longest(fraction) > digits.get("F", digits.get("*", 99)):
            return Cheap("F has too many digits", gains)
    return Cheap(None, gains)


def _stacked(A: Rows, B: Rows) -> Rows:
    """Return [B, A B, …, Aⁿ⁻¹B]."""
    return krylov(A, B)


def controller(matrices: Mapping[str, Rows], K: Rows, L: Rows) -> tuple[Poly, Poly]:
    """Return numerator and denominator of F = K (sI − A + BK + LC − LDK)⁻¹ L, coprime and primitive."""
    B, C, D = matrices["B"], matrices["C"], matrices.get("D", ((0,),))
    order = len(B)
    M = plus(plus(matrices["A"], times(B, K), -1), times(L, plus(C, times(D, K), -1)), -1)
    # adj(sI − M) = Σ sⁿ⁻¹⁻ᵏ Nₖ with N₀ = I and Nₖ = M Nₖ₋₁ + cₖ I, where cₖ are the coefficients of det(sI − M)
    denominator = adjugate(M)[2]
    numerator, N = [], identity(order)
    for k in range(order):
        numerator.append(times(times(K, N), L)[0][0])
        N = plus(times(M, N), identity(order), denominator[order - 1 - k])
    top = trimmed(tuple(reversed(numerator)))
    if not top:
        return (0,), (1,)
    shared = common_divisor(top, denominator)
    if len(shared) > 1:
        top, denominator = quotient(top, shared), quotient(denominator, shared)
    first, second = primitive(top, denominator)
    return first, second


def longest(rows: Rows | tuple[Poly, ...]) -> int:
    """Return the most digits of an entry."""
    return max((len(str(abs(entry))) for row in rows for entry in row), default=1)


# -- relations --------------------------------------------------------------------------------------------------------


def holds(relation: str, found: Candidate) -> bool:
    """Return whether a relation among the parameters holds; raises `InputError` for what is none."""
    match = RELATION.match(relation)
    if match is None:
        message = f'"{shown(relation, 60)}" is no relation'
        raise InputError(message, where="variants.parameters.when", repair='write when = ["a < b"]')
    left, right = (_number(in_text(side, found.values, "variants.parameters.when")) for side in match.groups()[::2])
    return {
        "!=": left != right,
        "==": left == right,
        "=": left == right,
        ">": left > right,
        "<": left < right,
        ">=": left >= right,
        "<=": left <= right,
    }[match[2]]


@lru_cache(maxsize=65536)
def _number(text: str) -> Fraction:
    return parse_scalar(text.strip(), {}, where="variants.parameters.when").fraction()


# -- kinds of data ----------------------------------------------------------------------------------------------------


def kind_of(found: Candidate) -> dict[str, Any]:
    """Return what of the structure can be seen in the data: shapes, zeros, and the kinds of poles."""
    return {"matrices": found.shapes, "poles": pole_kinds(found.data)}


# When two problems are the same: in their data, in their data but for the coordinates, or in their answers.


#: Orders up to which all 2ⁿ n! signed permutations are gone through.
_PERMUTED_UP_TO = 5


def data_key(found: Candidate) -> str:
    """Return the key of plant and specification, in which the order of the poles does not matter."""
    return digest(canonical({"plant": found.data.get("plant", {}), "specification": _specification(found)}))


def _specification(found: Candidate) -> dict[str, Any]:
    given = found.data.get("specification", {})
    return {key: _sorted(value) if key.endswith("poles") else value for key, value in given.items()}


def _sorted(value: object) -> list[str]:
    parts = value if isinstance(value, list) else str(value).split(",")
    return sorted(str(part).strip() for part in parts)


def coordinate_key(found: Candidate) -> str:
    """Return a key that plants share which differ by a signed permutation of the states, or a sign of inputs or outputs.

    It is the key of the data where the order is larger than 5, or the matrices are not whole.
    """
    A = found.matrices.get("A")
    if A is None or not found.is_whole or len(A) > _PERMUTED_UP_TO:
        return data_key(found)
    inputs = [list(column) for column in zip(*found.matrices.get("B", ()), strict=True)]
    outputs = [list(row) for row in found.matrices.get("C", ())]
    least = min(_moved(A, inputs, outputs))
    return digest(canonical({"least": least, "D": found.matrices.get("D"), "specification": _specification(found)}))


def _moved(A: Sequence[Sequence[int]], *vectors: Sequence[Sequence[int]]) -> Iterator[tuple[Any, ...]]:
    """Yield P A P⁻¹ with the columns of P B and the rows of C P⁻¹, each up to its sign."""
    for places, signs in each_signed_permutation(len(A)):
        moved = [[signs[i] * signs[j] * A[places[i]][places[j]] for j in range(len(A))] for i in range(len(A))]
        others = [
            [max(w, [-x for x in w]) for v in group for w in [[s * v[p] for p, s in zip(places, signs, strict=True)]]]
            for group in vectors
        ]
        yield moved, *others


def keys_of(found: Candidate, answers: Sequence[Any], kind: str) -> set[str]:
    """Return the keys of which two variants may share none."""
    keys = set()
    if kind in {"data", "both"}:
        keys |= {f"data {data_key(found)}", f"coordinates {coordinate_key(found)}"}
    if kind in {"answers", "both"}:
        keys.add(f"answers {digest(canonical(answers))}")
    return keys


# The dear tests of a candidate, as a job of a child process: solved, checked, measured, and written as a file.


def run(payload: Mapping[str, Any]) -> dict[str, Any]:
    """Return the row of a candidate: why it is no variant, or its answers and its profile."""
    problem = problem_of(payload)
    results = problem.solve()
    _agree(payload["gains"], results)
    constraints = payload["constraints"]
    unknown = unknown_names(constraints, results)
    if unknown:
        return {"status": "done", "result": {"reason": "a constraint names no field", "unknown": unknown}}
    reason = broken(constraints, results)
    if reason is not None:
        return {"status": "done", "result": {"reason": reason}}
    found = profile(results, problem.document(results).derivations)
    wrong = mismatches(problem.viewed(results), problem.expect)
    if wrong:
        return {
            "status": "done",
            "result": {"reason": "an expected answer is not met", "unknown": _unmet(payload, wrong)},
        }
    expect = expected(problem, results)
    unmet = mismatches(problem.viewed(results), expect)
    if unmet:
        raise CertificateRejected(f"an answer is not met by its own text: {unmet[0]}")
    result = {
        "reason": beyond(constraints, found),
        "answers": [answer_object(result) for result in results],
        "expect": expect,
        "profile": found,
    }
    return {"status": "done", "result": result}


def _unmet(payload: Mapping[str, Any], wrong: Sequence[str]) -> list[tuple[str, str, str]]:
    """Return place, message and repair of expected answers that a candidate does not meet."""
    tables = [payload["problem"].get(name, {}) for name in ("plant", "specification")]
    drawn = ", ".join(f"{name} = {value}" for table in tables for name, value in table.items())
    told = (text.partition(": ") for text in wrong)
    return [
        (where, f"{message} for {drawn}", "mend it, in letters of [variants.parameters]") for where, _, message in told
    ]


def _agree(gains: Mapping[str, Any], results: Sequence[Result]) -> None:
    """Raise `CertificateRejected` where the cheap test and the engine have found different gains."""
    for name, rows in gains.items():
        for result in results:
            value = to_json(result.fields.get(name))
            if value is not None and value != [[str(entry) for entry in row] for row in rows]:
                raise CertificateRejected(f"{name} is {value}, and in whole numbers {rows}")


def expected(problem: Problem, results: Sequence[Result]) -> dict[str, Any]:
    """Return what is asked for as `[expect]` of a file has it, in the letters of its convention."""
    tables: dict[str, Any] = {}
    for view in problem.viewed(tuple(results)):
        own = {standard: name for name, (standard, _) in view.names.items()}
        found = {own.get(name, name): _value_of(view, own.get(name, name)) for name in asked_of(view.result)}
        tables[view.task] = {name: value for name, value in found.items() if value is not None}
    return tables if len(tables) > 1 else next(iter(tables.values()))


def _value_of(view: ResultInConvention, name: str) -> Any:
    return _written(found_in(view, name))


def _written(value: Any) -> Any:
    """Return a value as a file can hold it; None where it has a part that no file can."""
    if isinstance(value, Matrix):
        return f"[{'; '.join(' '.join(str(entry).replace(' ', '') for entry in row) for row in value.rows)}]"
    if isinstance(value, (list, tuple)):
        parts = [_written(each) for each in value]
        return None if any(part is None for part in parts) else parts
    if isinstance(value, Mapping):
        return {key: part for key, each in value.items() if (part := _written(each)) is not None}
    return to_json(value)


def recheck(payload: Mapping[str, Any], row: Mapping[str, Any]) -> str | None:
    """Return what does not hold of the answers of a candidate, by other code than that which found them."""
    if row.get("status") != "done" or "answers" not in row["result"]:
        return None
    told = {"status": "done", "result": row["result"]["answers"], "key": row["key"]}
    return recheck_answers(payload, told)
