"""Comparison of results with expected answers, as mathematics and not as text."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Mapping, Sequence
from fractions import Fraction
from itertools import chain, repeat
from typing import TYPE_CHECKING, Any

from symobs.exact import Complex, Factored, Matrix, Root, Scalar, TooLarge, product_of, rank, root_of_pole
from symobs.exact.algebraic.polynomial_roots import polynomial_of_roots
from symobs.exact.algebraic.rounded_decimals import decimals_in, polynomial_of, rounds_to, written_out
from symobs.exact.core.generators import symbols_in
from symobs.formula.expression import parse_matrix, parse_poles, parse_scalar
from symobs.formula.expression.source import shown
from symobs.ground.errors import CertificateRejected, InputError, OpenEquality, ProblemErrors, SymobsError
from symobs.problem.agreement import agrees, functions_agree
from symobs.problem.landmarks import LANDMARKS, landmarks_agree
from symobs.system.conditions import Condition, sign_of, vanishing_factors
from symobs.tasks.result.in_convention import ResultInConvention

if TYPE_CHECKING:
    from collections.abc import Iterable

    from symobs.tasks.result.in_convention import Answered


__all__ = [
    "applicable",
    "available",
    "found_in",
    "held_against",
    "is_digits",
    "met",
    "mismatches",
    "names_of",
    "shown_value",
    "unreadable",
]


# Expected roots and numbers: a + b sqrt(c), CRootOf(polynomial, index), sums of square roots.


COUNTED = re.compile(r"\s*CRootOf\((.*),\s*([0-9]+)\)\s*", re.DOTALL)


def key_of(root: Root) -> Any:
    """Return a key independent of the form of a root."""
    exact: Complex | None = root.exact()
    return exact if exact is not None else (root.centre, root.radicand, root.sign, root.factor, root.index)


def read_roots(expected: list[Any], names: Any, variable: str, where: str) -> list[Root]:
    """Return the roots of texts: numbers, a + b sqrt(c), CRootOf(polynomial, index)."""
    roots: list[Root] = []
    for i, entry in enumerate(expected):
        place = f"{where}[{i}]" if len(expected) > 1 else where
        counted = COUNTED.fullmatch(entry) if isinstance(entry, str) else None
        if counted is not None:
            factor, zero = parse_scalar(counted[1], names, variable=variable, where=place), Scalar.of(0)
            roots.append(Root(factor, variable, zero, zero, 1, int(counted[2])))
        elif isinstance(entry, str) and "sqrt" in entry:
            roots += [_surd(part, names, variable, place) for part in entry.strip(" []").split(",")]
        else:
            read = parse_poles(entry if isinstance(entry, str) else [entry], names, where=place)
            roots += [root_of_pole(pole, variable) for pole in read]
    return roots


def rounded_roots(expected: list[Any], names: Any, where: str) -> tuple[Complex, ...]:
    """Return the numbers of a list with decimals, nothing for a list without."""
    if any(isinstance(entry, str) and "CRootOf" in entry for entry in expected):
        return ()
    texts = ", ".join(str(entry).strip(" []") for entry in expected)
    read = parse_poles(texts, names, where=where, functions=True, rounding=True) if "." in texts else ()
    return read if any(decimals_in(root.real) or decimals_in(root.imaginary) for root in read) else ()


def roots_round_to(printed: tuple[Complex, ...], found: list[Root], variable: str) -> bool:
    """Return whether the roots found round to the printed decimals."""
    exact = polynomial_of_roots(variable, tuple(found))
    try:
        return exact is not None and rounds_to(polynomial_of(printed, variable), exact)
    except ValueError:  # one lacks its conjugate
        return False


def root_rounds_to(printed: Complex, found: Root) -> bool:
    """Return whether a root with a closed form rounds to the decimals of a printed number."""
    return found.is_closed and is_number(parse_poles(str(found), functions=True)[0], printed, None)


def _surd(text: str, names: Any, variable: str, where: str) -> Root:
    """Return the root a + b sqrt(c) or a + b sqrt(c) I: sqrt(c) is read as a new name q, with q**2 = c."""
    before, _, behind = text.partition("sqrt")
    end = depth = 0
    while end < len(behind) and (depth or not end):
        depth += (behind[end] == "(") - (behind[end] == ")")
        end += 1
    q = "sqrt_"
    while names is not None and q in names:
        q += "_"
    known = None if names is None else {**names, q: "real"}
    value = parse_poles(before + q + behind[end:], known, where=where)[0]
    square = parse_scalar(behind[:end], names, where=where)
    real, imaginary = (_in_powers(part, q, text, where) for part in (value.real, value.imaginary))
    if not imaginary[0].is_zero or not (real[1] * imaginary[1]).is_zero:
        raise _no_surd(text, where)
    slope = real[1] + imaginary[1]
    radicand = slope**2 * (square if imaginary[1].is_zero else -square)
    sign = -1 if not slope.is_zero and slope.factors()[0].fraction() < 0 else 1
    return Root((Scalar.symbol(variable) - real[0]) ** 2 - radicand, variable, real[0], radicand, sign)


def _in_powers(value: Scalar, q: str, text: str, where: str) -> tuple[Scalar, Scalar]:
    """Return (a, b) with value = a + b q."""
    if not value.is_polynomial_in(q) or value.degree(q) > 1:
        raise _no_surd(text, where)
    *slope, constant = value.coefficients(q) or (Scalar.of(0),)
    return constant, slope[0] if slope else Scalar.of(0)


def _no_surd(text: str, where: str) -> InputError:
    return InputError(f'"{shown(text)}" is not of the form a + b sqrt(c)', where=where, repair="leave it out")


def numbers_agree(found: list[Any], expected: list[Any], names: Any, where: str) -> bool:
    """Return whether complex numbers with square roots, and roots without closed form, are the expected ones."""
    waiting = list(found)
    for i, entry in enumerate(expected):
        counted = isinstance(entry, str) and "CRootOf" in entry
        read = [] if counted else parse_poles([entry], names, where=f"{where}[{i}]", functions=True, rounding=True)
        match = next((n for n in waiting if (str(n) == entry if counted else is_number(n, read[0], names))), None)
        if match is None:
            return False
        waiting.remove(match)
    return not waiting


def is_number(found: Complex | Root, expected: Complex, signs: Any) -> bool:
    """Return whether a complex number equals the expected one as a function of its symbols."""
    if isinstance(found, Root):
        return False
    pairs = (expected.real, found.real), (expected.imaginary, found.imaginary)
    return all(functions_agree(*pair, signs) for pair in pairs)


# Comparison of structured values: tables by the expected keys, lists by entries, down to expressions.


RELATION = re.compile(r"^(.*?)(!=|==|>=|<=|>|<)(.*)$", re.DOTALL)


def agree(found: Any, expected: Any, names: Any, where: str) -> bool:
    """Return whether a value equals the expected one; tables are compared in the given keys."""
    if isinstance(found, Mapping):
        alike = isinstance(expected, Mapping) and set(expected) <= set(found)
        return alike and all(agree(found[key], entry, names, f"{where}.{key}") for key, entry in expected.items())
    if isinstance(found, (list, tuple)):
        if not isinstance(expected, list) or len(expected) != len(found):
            return False
        pairs = enumerate(zip(found, expected, strict=True))
        return all(agree(entry, wanted, names, f"{where}[{i}]") for i, (entry, wanted) in pairs)
    if found is None or isinstance(found, bool) or expected is None or isinstance(expected, (bool, list, Mapping)):
        if isinstance(found, Matrix) and isinstance(expected, list):
            return agrees(parse_matrix(expected, _knowing(names, found), where=where, rounding=True), found, names)
        return type(found) is type(expected) and bool(found == expected)
    if isinstance(found, Matrix):
        if not isinstance(expected, str):
            return False
        return agrees(parse_matrix(expected, _knowing(names, found), where=where, rounding=True), found, names)
    if isinstance(found, (Scalar, Factored, int)):
        value = found.value if isinstance(found, Factored) else Scalar.of(found) if isinstance(found, int) else found
        known = _knowing(names, value)
        wanted = parse_scalar(expected, known, where=where, functions=True, rounding=True, nonlinear=True)
        return functions_agree(wanted, value, names)
    return str(found) == str(expected) or _agree_as_mathematics(str(found), str(expected), names, where)


def relation(text: Any, names: Any, where: str) -> tuple[Scalar, str]:
    """Return a relation as (expression compared with 0, up to a factor, operator)."""
    if text == "False":
        return Scalar.of(0), ">"
    match = RELATION.match(str(text))
    if match is None:
        message = f'"{shown(str(text))}" is not a relation'
        raise InputError(message, where=where, repair='write for example "2*c - 1 != 0"')
    left, operator, right = match.groups()
    difference, subtracted = (
        parse_scalar(side, names, where=where, functions=True, rounding=True) for side in (left, right)
    )
    difference = difference - subtracted
    if operator in {"<", "<="}:
        difference, operator = -difference, operator.replace("<", ">")
    if difference.is_zero or decimals_in(difference):
        return difference, operator
    if operator == "!=":
        factors = (difference.numerator * difference.denominator).factors()[1]
        return product_of(factor for factor, _ in factors), operator
    if operator == ">":  # a/b > 0 says the same as a b > 0
        difference = difference.numerator * difference.denominator
    unit, factors = difference.factors()
    if operator == ">" and unit.fraction() > 0 and all(power % 2 == 0 for _, power in factors):
        return product_of(factor for factor, _ in factors), "!="
    return difference / (unit if operator in {"!=", "=="} else Scalar.of(abs(unit.fraction()))), operator


def relations_agree(expected: tuple[Scalar, str], found: tuple[Scalar, str]) -> bool:
    """Return whether a relation equals the one found up to a factor; its decimals may be rounded."""
    (printed, operator), (exact, other) = expected, found
    if not decimals_in(printed) or exact.is_zero or operator != other:
        return expected == found
    coefficient, powers = exact.terms()[0]
    decimals = decimals_in(printed)
    leads = [
        product_of([Scalar.of(number), *(Scalar.symbol(name) ** power for name, power in each if name in decimals)])
        for number, each in printed.numerator.terms()
        if tuple(pair for pair in each if pair[0] not in decimals) == powers
    ]
    lead = sum(leads, Scalar.of(0))
    same = written_out(lead) * coefficient
    if same.is_zero or (operator in {">", ">="} and same.fraction() < 0):
        return False
    return rounds_to(printed.numerator / lead, exact / Scalar.of(coefficient))


def factors_agree(found: list[tuple[Scalar, int]], expected: list[Any], names: Any, where: str) -> bool:
    """Return whether the factors with their powers equal the expected ones, in any order."""
    read: list[tuple[Scalar, int]] = []
    for i, pair in enumerate(expected):
        if not isinstance(pair, list) or len(pair) != 2 or type(pair[1]) is not int:
            return False
        known = names
        for factor, _ in found:
            known = _knowing(known, factor)
        read.append((parse_scalar(pair[0], known, where=f"{where}[{i}][0]", rounding=True), pair[1]))
    return len(read) == len(found) and all(
        any(power == other and agrees(value, factor, names) for value, other in read) for factor, power in found
    )


def factored_table(found: Any) -> Matrix | None:
    """Return the matrix of a table of factored entries, None for any other value."""
    if not isinstance(found, tuple) or not found or not all(isinstance(row, tuple) and row for row in found):
        return None
    if not all(isinstance(entry, Factored) for row in found for entry in row):
        return None
    return Matrix.of([[entry.value for entry in row] for row in found])


def _knowing(names: Any, value: Scalar | Matrix) -> Any:
    """Return the names with those of an answer added: its variable, free parameters."""
    return None if names is None else {**dict.fromkeys(sorted(symbols_in(value)), "real"), **names}


def _agree_as_mathematics(found: str, expected: str, names: Any, where: str) -> bool:
    """Return whether two texts are equal as expressions, or literally if they are not expressions."""
    try:
        if RELATION.match(found) or RELATION.match(expected):
            return relations_agree(relation(expected, names, where), relation(found, names, where))
        left, right = (
            parse_scalar(text, names, where=where, functions=True, rounding=text == expected)
            for text in (expected, found)
        )
    except SymobsError:
        return False
    return functions_agree(left, right, names)


# Equivalence of conjunctions of relations.


def conditions_agree(
    found: Iterable[Any], expected: Iterable[Any], names: Any, where: str, signs: Mapping[str, str]
) -> bool:
    """Return whether two conjunctions of relations are proved equivalent."""
    texts = [_DIGITS.sub(lambda number: f"({Fraction(number[0])})", str(entry)) for entry in found]
    ours = {each for text in texts for each in _factor_by_factor(relation(text, names, where), signs)}
    theirs = {each for entry in expected for each in _factor_by_factor(relation(entry, names, where), signs)}
    if any(decimals_in(value) for value, _ in theirs):
        theirs = {(v, op) for v, op in theirs if decimals_in(v) or op != ">" or sign_of(v, signs) != "positive"}
        pairs = [(mine, other) for other in theirs for mine in ours if relations_agree(other, mine)]
        return {mine for mine, _ in pairs} == ours and {other for _, other in pairs} == theirs
    return ours == theirs or (_implies(ours, theirs, signs) and _implies(theirs, ours, signs))


def _factor_by_factor(condition: tuple[Scalar, str], signs: Mapping[str, str]) -> Iterable[tuple[Scalar, str]]:
    """Return for a product that must not vanish its factors, without those that the signs keep from it."""
    value, operator = condition
    if operator != "!=" or value.is_zero or decimals_in(value):
        return [condition]
    return [(factor, operator) for factor in vanishing_factors([value], signs)]


def _implies(
    given: Iterable[tuple[Scalar, str]], wanted: Iterable[tuple[Scalar, str]], signs: Mapping[str, str]
) -> bool:
    """Return whether relations follow from others; new ones must be strict, and follow from the strict ones."""
    from symobs.stability.inequalities.simplify import prove_value  # noqa: PLC0415 - only where two lists are not the same

    given = set(given)
    known = [value if operator == ">" else value**2 for value, operator in given if operator in {">", "!="}]
    return all(
        operator in {">", "!="} and prove_value(value if operator == ">" else value**2, known, signs) is not None
        for value, operator in set(wanted) - given
    )


#: A number in certain digits among the conditions found, an end without a closed form: what is expected rounds it.
_DIGITS = re.compile(r"\d+\.\d+")
_NOT_RATIONAL = re.compile(r"sqrt|CRootOf|oo")
_FUNCTION = re.compile(r"\b(exp|log|a?sin|a?cos|atan|sinh|cosh)\b|\bt\b")
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


def held_against(results: Sequence[Answered], expect: Mapping[str, Any]) -> tuple[list[str], bool]:
    """Return the lines of `mismatches`, or those on what is not decided, and whether that is so."""
    try:
        return mismatches(results, expect), False
    except ProblemErrors as error:
        if not all(isinstance(each, OpenEquality) for each in error.errors):
            raise
        return str(error).split("\n"), True


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
        except TooLarge as error:
            errors.append(OpenEquality(str(error), where=where, repair="write it by the functions of the answer"))
        except SymobsError as error:
            errors.append(error)
    return lines


def _with_member(result: Answered, name: str, entry: Any, where: str) -> Answered:
    """Return the result with the expected gain of its family, or value of what many meet, else the result itself."""
    answer, claimed = result.answer[name], result.claimed
    if not isinstance(answer, Matrix) or (result.fields.get("family") is None and name not in claimed):
        return result
    try:
        wanted = parse_matrix(entry, names_of(result), where=where)
        other = wanted.shape == answer.shape and wanted != answer
        return result.with_answer(name, wanted) if other else result
    except (CertificateRejected, InputError):  # no member, or unreadable, which `met` will say
        return result


def unreadable(expect: Mapping[str, Any], names: Any, variable: str) -> list[SymobsError]:
    """Return the errors of expected answers that are not expressions, without solving."""
    time = "k" if variable == "z" else "t"
    known = None if names is None else {**names, **dict.fromkeys((variable, time, "t0", "t1"), "real")}
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
                        others = known and {name: sign for name, sign in known.items() if name != time}
                        parse_matrix(part, others, variable=time, where=where, functions=True, nonlinear=True)
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
    if result.in_time:
        used -= {result.argument}
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
    signs = result.plant.symbols.signs
    if found is None and isinstance(expected, (str, list)):
        near = digits_of(result, name, 2 * len(str(expected)))
        if near is not None:
            return agrees(parse_matrix(expected, names, where=where, rounding=True), near)
    in_time = result.in_time or result.plant.is_time_varying
    if in_time and isinstance(found, (Matrix, Scalar)):
        time = result.argument if result.in_time else "t"
        names = names and {name: sign for name, sign in names.items() if name != time}
        read = parse_matrix if isinstance(found, Matrix) else parse_scalar
        return functions_agree(
            read(expected, names, variable=time, where=where, functions=True, rounding=True), found, signs
        )
    if isinstance(found, Matrix):
        known = names if names is None or variable not in found.names else {**names, variable: "real"}
        return agrees(parse_matrix(expected, known, where=where, functions=True, rounding=True), found, signs)
    table = factored_table(found)
    if table is not None:
        known = None if names is None else {**names, variable: "real"}
        return agrees(parse_matrix(expected, known, where=where, functions=True, rounding=True), table, signs)
    if isinstance(found, Mapping):
        return agree(found, expected, names, where)
    if isinstance(found, (Scalar, Factored)):
        value = found.value if isinstance(found, Factored) else found
        free = None if names is not None and variable in names else variable
        read_as = parse_scalar(expected, names, variable=free, where=where, functions=True, rounding=True)
        return agrees(read_as, value, signs)
    if is_digits(found) and not isinstance(expected, bool):
        return agrees(parse_scalar(expected, names, where=where, rounding=True), Scalar.of(Fraction(found)))
    if isinstance(found, int) and not isinstance(found, bool):
        return parse_scalar(expected, names, where=where) == Scalar.of(found)
    if found is None or isinstance(found, (str, bool)):
        return isinstance(expected, type(found)) and bool(found == expected)
    if isinstance(found, (list, tuple)) and name in LANDMARKS:
        return landmarks_agree(name, list(found), expected, names, where)
    if isinstance(found, (list, tuple)):
        wanted = expected if isinstance(expected, list) else [expected]
        if name == "kernel" and found and wanted:
            return _same_span(list(found), wanted, names, where)
        return _lists_agree(list(found), wanted, result, where)
    raise InputError(f"the field {name} cannot be compared", where=where, repair="leave it out")


def is_digits(value: Any) -> bool:
    """Return whether a field is a number in certain digits, which has no closed form."""
    return isinstance(value, str) and re.fullmatch(r"-?\d+(\.\d+)?", value) is not None


def digits_of(result: Answered, name: str, digits: int) -> Matrix | None:
    """Return a matrix without a closed form to so many certain digits, None where there are none."""
    whole, (own, sign) = (
        (result.result, result.standard(name)) if isinstance(result, ResultInConvention) else (result, (name, 1))
    )
    table = whole.decimals_to(min(digits, _MOST_DIGITS)).get(own) if own in whole.decimals else None
    if not isinstance(table, list) or not all(isinstance(row, list) for row in table):
        return None
    return Matrix.of([[Fraction(entry) * sign for entry in row] for row in table])


#: More digits than these are not computed.
_MOST_DIGITS = 200


def _lists_agree(found: list[Any], expected: list[Any], result: Answered, where: str) -> bool:
    names, variable, signs = names_of(result), result.plant.variable, result.plant.symbols.signs
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
    if all(isinstance(entry, list) and all(map(_is_relation, entry)) for entry in found) and any(found):
        return len(found) == len(expected) and all(
            conditions_agree(ours, theirs if isinstance(theirs, list) else [theirs], names, f"{where}[{i}]", signs)
            for i, (ours, theirs) in enumerate(zip(found, expected, strict=True))
        )
    if all(isinstance(entry, Mapping) and "eigenvalue" in entry for entry in found):
        return _modes_agree(found, expected, result, where)
    if all(isinstance(entry, list) and all(isinstance(number, int) for number in entry) for entry in found):
        return sorted(found) == sorted(expected)
    if result.in_time and all(isinstance(entry, Scalar) for entry in found):
        read = [
            parse_scalar(entry, names, variable=result.argument, where=where, functions=True, rounding=True)
            for entry in expected
        ]
        return len(read) == len(found) and all(map(functions_agree, read, found, repeat(signs)))
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
        names,
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
            if not is_number(one, other, names):
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
