"""Comparison of results with expected answers, as mathematics and not as text."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Mapping, Sequence
from itertools import chain
from typing import TYPE_CHECKING, Any

from symobs.exact import Complex, Factored, Matrix, Root, Scalar, TooLarge, rank
from symobs.exact.core.generators import roots_in, symbols_in
from symobs.formula.expression import parse_matrix, parse_poles, parse_scalar
from symobs.formula.expression.source import shown
from symobs.ground.errors import CertificateRejected, InputError, ProblemErrors, SymobsError
from symobs.problem.expect.conditions import conditions_agree
from symobs.problem.expect.roots import (
    COUNTED,
    is_number,
    key_of,
    numbers_agree,
    read_roots,
    root_rounds_to,
    roots_round_to,
    rounded_roots,
)
from symobs.problem.expect.structure import RELATION, agree, factored_table, factors_agree
from symobs.problem.expect.time_functions import agrees, functions_agree
from symobs.system.conditions import Condition

if TYPE_CHECKING:
    from symobs.tasks.result.in_convention import Answered

_NOT_RATIONAL = re.compile(r"sqrt|CRootOf|oo")
_FUNCTION = re.compile(r"\b(exp|sin|cos|sinh|cosh)\b|\bt\b")
_WORD = re.compile(r"[A-Za-z]+")
_MOST_SHOWN = 200


def mismatches(results: Sequence[Answered], expect: Mapping[str, Any]) -> list[str]:
    """Return one line for each expected answer not met; raises `ProblemErrors` for unreadable ones.

    `[expect.TASK]` belongs to one task; other keys belong to every task that has the field, and at least one must.
    """
    lines: list[str] = []
    errors: list[SymobsError] = []
    for result in results:
        expected = {key: (entry, f"expect.{key}") for key, entry in expect.items() if key in available(result)}
        own = expect.get(result.task)
        if isinstance(own, Mapping):
            expected |= {key: (entry, f"expect.{result.task}.{shown(key, 40)}") for key, entry in own.items()}
        lines += _held_against(result, expected, errors)
    known = sorted({name for result in results for name in available(result)})
    found = applicable(results, expect)
    strange = [key for key in expect if key not in found]
    errors += [_no_field(f"expect.{shown(key, 40)}", "no task here has such a field", known) for key in strange]
    if errors:
        raise ProblemErrors(tuple(errors))
    return lines


def applicable(results: Sequence[Answered], expect: Mapping[str, Any]) -> dict[str, Any]:
    """Return the expected answers of these results."""
    tasks = {result.task for result in results}
    fields = {name for result in results for name in available(result)}
    return {
        key: entry for key, entry in expect.items() if key in fields or (key in tasks and isinstance(entry, Mapping))
    }


def _held_against(result: Answered, expected: Mapping[str, tuple[Any, str]], errors: list[SymobsError]) -> list[str]:
    """Return the lines for one result; with a nonunique answer, the others are compared given the expected one."""
    lines: list[str] = []
    chosen = result
    for name, (entry, where) in expected.items():
        chosen = _with_member(chosen, name, entry, where) if name in result.answer else chosen
    for name, (entry, where) in expected.items():
        if name not in available(result):
            errors.append(_no_field(where, f"{result.task} has no such field", available(result)))
            continue
        try:
            if not met(chosen, name, entry, where):
                found = shown_value(found_in(chosen, name))
                lines.append(
                    f"{where}: expected {shown(shown_value(entry), _MOST_SHOWN)}, found {shown(found, _MOST_SHOWN)}"
                )
        except SymobsError as error:
            errors.append(error)
        except TooLarge as error:
            errors.append(InputError(str(error), where=where, repair="write it by the functions of the answer"))
    return lines


def _with_member(result: Answered, name: str, entry: Any, where: str) -> Answered:
    """Return the result with the expected gain of its family, else the result itself."""
    answer = result.answer[name]
    if not isinstance(answer, Matrix) or result.fields.get("family") is None:
        return result
    try:
        wanted = parse_matrix(entry, names_of(result), where=where)
        other = wanted.shape == answer.shape and wanted != answer
        return result.with_answer(name, wanted) if other else result
    except (CertificateRejected, InputError):  # no member, or unreadable, which `met` will say
        return result


def unreadable(expect: Mapping[str, Any], names: Any, variable: str) -> list[SymobsError]:
    """Return the errors of expected answers that are not expressions, without solving."""
    known = None if names is None else {**names, variable: "real", "t": "real", "t0": "real", "t1": "real"}
    errors: list[SymobsError] = []
    waiting: list[tuple[str, Any]] = [("expect", expect)]
    while waiting:
        where, value = waiting.pop()
        if isinstance(value, Mapping):
            waiting += [(f"{where}.{shown(key, 40)}", entry) for key, entry in value.items()]
        elif isinstance(value, list):
            waiting += [(f"{where}[{i}]", entry) for i, entry in enumerate(value)]
        elif isinstance(value, str) and not _WORD.fullmatch(value) and not _NOT_RATIONAL.search(value):
            sides = RELATION.match(value)
            try:
                for part in (sides[1], sides[3]) if sides else (value,):
                    if part.lstrip().startswith("[") or _FUNCTION.search(part):
                        others = known and {name: sign for name, sign in known.items() if name != "t"}
                        parse_matrix(part, others, variable="t", where=where, functions=True)
                    else:
                        parse_poles(part, known, where=where)
            except SymobsError as error:
                errors.append(error)
    return errors


# -- one field ------------------------------------------------------------------------------------------------------


def _no_field(where: str, message: str, known: Sequence[str]) -> InputError:
    return InputError(message, where=where, repair=f"known fields are {', '.join(known)}")


def available(result: Answered) -> list[str]:
    """Return the names of the fields of a result."""
    return ["verdict", "conditions", *result.fields]


def found_in(result: Answered, name: str) -> Any:
    """Return the value of a field of a result."""
    if name == "verdict":
        return result.verdict
    if name == "conditions":
        return result.holds_where
    return result.fields[name]


def names_of(result: Answered) -> Any:
    """Return the declared names, and the names introduced by answers, such as t and t0."""
    declared, plant = result.plant.symbols.names, result.plant
    if declared is None:
        return None
    exact = [value for value in result.answer.values() if isinstance(value, (Matrix, Scalar))]
    if plant.is_time_varying:
        used = {plant.variable}.union(*map(symbols_in, exact))
    else:
        used = {name for value in exact for name in value.names} - {plant.variable}
    used = {name for name in used if name.isidentifier()}  # generators such as exp(-t) are no names
    if result.in_time:  # t is the variable there
        used -= {"t"}
    return {**dict.fromkeys(sorted(used), "real"), **declared}


def shown_value(value: Any) -> str:
    """Return a value as text."""
    if isinstance(value, Mapping):
        return "{" + ", ".join(f"{key} = {shown_value(entry)}" for key, entry in value.items()) + "}"
    if isinstance(value, (list, tuple)):
        return "[" + ", ".join(shown_value(entry) for entry in value) + "]"
    return "none" if value is None else str(value)


def met(result: Answered, name: str, expected: Any, where: str) -> bool:
    """Return whether an expected answer equals that of the result."""
    found, names, variable = found_in(result, name), names_of(result), result.plant.variable
    in_time = result.in_time or result.plant.is_time_varying
    has_functions = any(not function.square for function in result.plant.field.functions.values())
    if in_time and isinstance(found, (Matrix, Scalar)):
        names = names and {name: sign for name, sign in names.items() if name != "t"}
        read = parse_matrix if isinstance(found, Matrix) else parse_scalar
        return functions_agree(read(expected, names, variable="t", where=where, functions=True, rounding=True), found)
    if isinstance(found, Matrix):
        known = names if names is None or variable not in found.names else {**names, variable: "real"}
        if has_functions:
            return functions_agree(parse_matrix(expected, known, where=where, functions=True, rounding=True), found)
        return agrees(parse_matrix(expected, known, where=where, rounding=True), found)
    table = factored_table(found)
    if table is not None:
        known = None if names is None else {**names, variable: "real"}
        return agrees(parse_matrix(expected, known, where=where, rounding=True), table)
    if isinstance(found, Mapping):
        return agree(found, expected, names, where)
    if isinstance(found, (Scalar, Factored)):
        value = found.value if isinstance(found, Factored) else found
        free = None if names is not None and variable in names else variable
        if has_functions or roots_in(value):
            read_as = parse_scalar(expected, names, variable=free, where=where, functions=True, rounding=True)
            return functions_agree(read_as, value)
        return agrees(parse_scalar(expected, names, variable=free, where=where, rounding=True), value)
    if isinstance(found, int) and not isinstance(found, bool):
        return parse_scalar(expected, names, where=where) == Scalar.of(found)
    if found is None or isinstance(found, (str, bool)):
        return isinstance(expected, type(found)) and bool(found == expected)
    if isinstance(found, (list, tuple)):
        wanted = expected if isinstance(expected, list) else [expected]
        if name == "kernel" and found and wanted:
            return _same_span(list(found), wanted, names, where)
        return _lists_agree(list(found), wanted, result, where)
    raise InputError(f"the field {name} cannot be compared", where=where, repair="leave it out")


def _lists_agree(found: list[Any], expected: list[Any], result: Answered, where: str) -> bool:
    names, variable = names_of(result), result.plant.variable
    if not found or not expected:
        return not found and not expected
    if all(isinstance(entry, Root) for entry in found):
        rounded = rounded_roots(expected, names, where)
        if rounded:
            return roots_round_to(rounded, found, variable)
        return Counter(map(key_of, found)) == Counter(map(key_of, read_roots(expected, names, variable, where)))
    if all(isinstance(entry, (Complex, Root)) for entry in found):
        return numbers_agree(found, expected, names, where)
    if all(_is_relation(entry) for entry in found):
        return conditions_agree(found, expected, names, where, result.plant.symbols.signs)
    if all(isinstance(entry, Mapping) and "eigenvalue" in entry for entry in found):
        return _modes_agree(found, expected, result, where)
    if all(isinstance(entry, list) and all(isinstance(number, int) for number in entry) for entry in found):
        return sorted(found) == sorted(expected)
    if result.in_time and all(isinstance(entry, Scalar) for entry in found):
        read = [
            parse_scalar(entry, names, variable="t", where=where, functions=True, rounding=True) for entry in expected
        ]
        return len(read) == len(found) and all(map(functions_agree, read, found))
    if all(isinstance(entry, Scalar) for entry in found):
        read = [parse_scalar(entry, names, where=f"{where}[{i}]", rounding=True) for i, entry in enumerate(expected)]
        return len(read) == len(found) and all(map(agrees, read, found))
    if all(isinstance(entry, Matrix) for entry in found):
        alike = len(found) == len(expected)
        return alike and all(
            _is_matrix(entry, value, names, where) for entry, value in zip(expected, found, strict=True)
        )
    if all(isinstance(entry, list) and all(isinstance(end, str) for end in entry) for entry in found):
        return _intervals_agree(found, expected, names, where)
    if all(isinstance(entry, (list, tuple)) and list(map(type, entry)) == [Scalar, int] for entry in found):
        return factors_agree([(factor, power) for factor, power in found], expected, names, where)
    return agree(found, expected, names, where)


def _is_relation(entry: Any) -> bool:
    return isinstance(entry, Condition) or (
        isinstance(entry, str) and (entry == "False" or bool(RELATION.match(entry)))
    )


def _intervals_agree(found: list[list[str]], expected: list[Any], names: Any, where: str) -> bool:
    """Return whether intervals have the expected ends: -oo, oo, CRootOf(polynomial, index), or a closed form."""
    if len(found) != len(expected) or not all(isinstance(pair, list) and len(pair) == 2 for pair in expected):
        return False
    pairs = zip((end for pair in found for end in pair), (end for pair in expected for end in pair), strict=True)
    return all(_is_end(end, str(wanted), names, where) for end, wanted in pairs)


def _is_end(found: str, expected: str, names: Any, where: str) -> bool:
    if {found, expected} & {"oo", "-oo"}:
        return found == expected
    counted = COUNTED.fullmatch(found), COUNTED.fullmatch(expected)
    if counted[0] and counted[1]:
        polynomials = [parse_scalar(match[1], names, where=where).numerator.factors()[1] for match in counted if match]
        return polynomials[0] == polynomials[1] and int(counted[0][2]) == int(counted[1][2])
    if counted[0] or counted[1]:
        return False
    return functions_agree(
        parse_scalar(expected, names, where=where, functions=True, rounding=True),
        parse_scalar(found, names, where=where, functions=True),
    )


def _is_matrix(expected: Any, found: Matrix, names: Any, where: str) -> bool:
    """Return whether an entry of a list is this matrix; a number alone is not."""
    if not isinstance(expected, (str, list)):
        return False
    return agrees(parse_matrix(expected, names, where=where, rounding=True), found)


# -- modes ----------------------------------------------------------------------------------------------------------


def _modes_agree(found: list[Any], expected: list[Any], result: Answered, where: str) -> bool:
    """Return whether each expected mode matches a different mode found, in the given keys."""
    waiting = list(found)
    for i, wanted in enumerate(expected):
        place = f"{where}[{i}]"
        match = next((mode for mode in waiting if _is_mode(mode, wanted, result, place)), None)
        if match is None:
            return False
        waiting.remove(match)
    return not waiting


def _is_mode(mode: Mapping[str, Any], wanted: Any, result: Answered, where: str) -> bool:
    if not isinstance(wanted, Mapping) or not set(wanted) <= set(mode):
        return False
    names, variable = names_of(result), result.plant.variable
    for key, entry in wanted.items():
        value = mode[key]
        if isinstance(value, Root):
            rounded = rounded_roots([entry], names, f"{where}.{key}")
            if rounded:
                if len(rounded) != 1 or not root_rounds_to(rounded[0], value):
                    return False
            elif Counter(map(key_of, read_roots([entry], names, variable, f"{where}.{key}"))) != Counter(
                [key_of(value)]
            ):
                return False
        elif key == "conditions":
            if not _lists_agree(value, entry if isinstance(entry, list) else [entry], result, f"{where}.{key}"):
                return False
        elif isinstance(value, list):
            if not _tables_agree(value, entry, names, f"{where}.{key}"):
                return False
        elif type(value) is not type(entry) or value != entry:
            return False
    return True


def _tables_agree(found: list[list[Any]], expected: Any, names: Any, where: str) -> bool:
    """Return whether a matrix, possibly complex, equals the expected one."""
    table = [[str(cell) for cell in row] for row in found]
    if not isinstance(expected, list) or [len(row) if isinstance(row, list) else 0 for row in expected] != [
        len(row) for row in table
    ]:
        return bool(parse_matrix(expected, names, where=where) == parse_matrix(table, names, where=where))
    for left, right in zip(chain(*table), chain(*expected), strict=True):
        if left != right:
            one, other = (parse_poles([cell], names, where=where, functions=True)[0] for cell in (left, right))
            if not is_number(one, other):
                return False
    return True


# -- vectors --------------------------------------------------------------------------------------------------------


def _same_span(found: list[list[Scalar]], expected: list[Any], names: Any, where: str) -> bool:
    if len(found) != len(expected):
        return False
    wanted = [parse_matrix([entry] if not isinstance(entry, str) else entry, names, where=where) for entry in expected]
    rows = [Matrix.row(vector) for vector in found]
    columns = [row if row.shape[0] == 1 else row.T for row in wanted]
    if any(row.shape != rows[0].shape for row in columns):
        return False
    together = Matrix.block([[row] for row in [*rows, *columns]])
    return rank(together) == rank(Matrix.block([[row] for row in columns])) == len(rows)
