"""QEPCAD: regions of stability from Liénard and Chipart's inequalities, and where a plant with parameters is observable.

Both sides are written from the problem alone, in plain fractions; that our conditions describe the same set is proved
by z3, and where z3 does not decide by QEPCAD.
"""

from __future__ import annotations

import json
from fractions import Fraction
from itertools import combinations
from typing import TYPE_CHECKING

from tests.programs.campaign.systems import Untold
from tests.support.problems.random_problems import listed, rows
from tests.support.regions import qepcad, region_answers, region_checks
from tests.support.regions.region_algebra import All, Atom, Polynomial, Some
from tests.support.regions.region_algebra import difference as exclusive
from tests.support.regions.region_problem import Problem, characteristic
from tests.support.regions.region_proofs import nothing_in
from tests.support.regions.region_texts import UnreadableError, expression, fraction
from tests.support.regions.region_translation import Translation, conjunction

if TYPE_CHECKING:
    from collections.abc import Iterator

    from tests.programs.campaign.systems import Difference
    from tests.support.problems.random_problems import Tables
    from tests.support.regions.region_algebra import Formula

NAME = "QEPCAD"
COMMAND: str | None = "qepcad"

_SECONDS = 5
_POINTS = 40  # at which the roots themselves are asked besides
_OPERATIONS = {"positive": ">", "negative": "<", "nonnegative": ">=", "nonpositive": "<=", "nonzero": "!="}


def covers(problem: Tables) -> bool:
    """Tell whether the answer describes a set of parameters that QEPCAD can find."""
    if problem["task"] == "stability_region":
        return True
    return problem["task"] in {"observability", "controllability"} and 0 < len(problem["symbols"]) <= 3


def difference(given: Tables, answer: Tables) -> Difference:
    """Judge one answer."""
    try:
        return (_region if given["task"] == "stability_region" else _observable)(given, answer)
    except (UnreadableError, NotImplementedError) as error:
        return Untold(f"not read: {error}")


# -- regions -----------------------------------------------------------------------------------------------------------


def problem_of(asked: Tables) -> Problem:
    """Return the region that is asked for; the polynomial of a plant with a gain is expanded by minors of its rows."""
    given, specification = asked["plant"], asked["specification"]
    variable = "z" if given.get("dt") else "s"
    if "polynomial" in specification:
        text = specification["polynomial"]
    else:
        A = rows(given["A"])
        if "L" in specification:
            L, C = (rows(table) for table in (specification["L"], given["C"]))
            text = characteristic(A, [row[0] for row in L], C[0], variable)
        else:
            K, B = (rows(table) for table in (specification["K"], given["B"]))
            turned = [list(column) for column in zip(*A, strict=True)]
            text = characteristic(turned, K[0], [row[0] for row in B], variable)
    parameters = tuple(listed(specification["parameters"]))
    symbols = {name: sign for name, sign in asked["symbols"].items() if name not in parameters}
    margin, radius = str(specification.get("margin", "0")), str(specification.get("radius", "1"))
    return Problem(str(asked), text, parameters, symbols=symbols, margin=margin, radius=radius)


def _region(given: Tables, said: Tables) -> Difference:
    problem = problem_of(given)
    said = {**said, "sample_points": []} if problem.symbols else said  # those depend on the symbols
    answer = region_answers.from_json(json.dumps({"results": [said]}), problem.parameters)
    if answer.verdict == "undecided":
        return Untold("symobs does not decide")
    wrong = [*region_checks.wrong_by_record(problem, answer), *region_checks.wrong_at_points(problem, answer, _POINTS)]
    if wrong:
        return wrong[0]
    truth = region_checks.truth_of(problem, _SECONDS)
    if truth is None:
        return Untold("no answer in time")
    untold: Difference = None
    for part, proof in region_checks.proofs(problem, answer, truth, _SECONDS):
        if proof.verdict == "different":
            return f"{part} is {proof}, for instance at {proof.point}"
        if proof.verdict != "same":
            untold = Untold(f"{part} is {proof}")
    if answer.empty is not None:
        empty = nothing_in(All((qepcad.assumptions(problem), truth)), limit=_SECONDS)
        if empty.verdict != "not decided" and (empty.verdict == "same") != answer.empty:
            return f"empty is {answer.empty}, and a point is {empty.point}"
    return untold


# -- where parameters leave a plant observable -------------------------------------------------------------------------


def _observable(asked: Tables, answer: Tables) -> Difference:
    (A, C), given = _without_denominators(asked, "AC" if asked["task"] == "observability" else "AB")
    if asked["task"] == "controllability":
        A, C = _turned(A), _turned(C)
    stack, block = list(C), C
    for _ in range(len(A) - 1):
        block = _times(block, A)
        stack += block
    minors = [_determinant([stack[i] for i in chosen]) for chosen in combinations(range(len(stack)), len(A))]
    truth = Some(tuple(Atom(minor, "!=") for minor in minors))
    translation = Translation()
    ours = Some(tuple(conjunction(translation, relations) for relations in _where_yes(answer, [])))
    proof = nothing_in(All((given, exclusive(truth, ours))), translation.definitions, _SECONDS)
    if proof.verdict == "different":
        return f"observable elsewhere than said: {proof}, for instance at {proof.point}"
    return None if proof.verdict == "same" else Untold("no answer in time")


def _where_yes(answer: Tables, path: list[str]) -> Iterator[list[str]]:
    """Yield relations under which full rank is claimed, one list for each branch of the answer."""
    if answer["verdict"] == "undecided":
        raise UnreadableError("symobs does not decide")
    conditions = answer.get("conditions", [])
    if answer["verdict"] in {"yes", "conditional"}:
        yield [*path, *conditions]
    for case in answer.get("cases", []):
        yield from _where_yes(case, [*path, *case["when"]])


def _signs(symbols: Tables) -> Iterator[Formula]:
    for name, given in symbols.items():
        sign = given["sign"] if isinstance(given, dict) else given
        if sign in _OPERATIONS:
            yield Atom(Polynomial.symbol(name), _OPERATIONS[sign])


Matrix = list[list[Polynomial]]


def _without_denominators(asked: Tables, letters: str) -> tuple[list[Matrix], Formula]:
    """Return matrices of the plant, each times what is under its entries, and where there is a plant.

    A factor that does not vanish changes no rank, not even one for each block C Aᵏ.
    """
    found: dict[str, Matrix] = {}
    defined = list(_signs(asked["symbols"]))
    for letter, text in asked["plant"].items():
        if letter in set("ABCD"):
            entries = [[fraction(expression(entry)) for entry in row] for row in rows(text)]
            under = {below.text("*"): below for row in entries for _, below in row}
            defined += [Atom(below, "!=") for below in under.values() if below.constant is None]
            found[letter] = [[above * _others(under, below.text("*")) for above, below in row] for row in entries]
    return [found[letter] for letter in letters], All(tuple(defined))


def _others(under: dict[str, Polynomial], name: str) -> Polynomial:
    whole = Polynomial.of(1)
    for other, below in under.items():
        if other != name:
            whole *= below
    return whole


def _turned(matrix: Matrix) -> Matrix:
    return [list(column) for column in zip(*matrix, strict=True)]


def _times(left: Matrix, right: Matrix) -> Matrix:
    zero = Polynomial.of(0)
    return [[sum((a * b for a, b in zip(row, column, strict=True)), zero) for column in _turned(right)] for row in left]


def _determinant(matrix: Matrix) -> Polynomial:
    """Expand along the rows, each minor of the lower rows once."""
    found: dict[tuple[int, ...], Polynomial] = {(): Polynomial.of(1)}
    for row in reversed(matrix):
        size = len(next(iter(found))) + 1
        larger: dict[tuple[int, ...], Polynomial] = {}
        for columns in combinations(range(len(row)), size):
            total = Polynomial.of(0)
            for place, column in enumerate(columns):
                part = row[column] * found[columns[:place] + columns[place + 1 :]]
                total += part * Fraction((-1) ** place)
            larger[columns] = total
        found = larger
    return found[tuple(range(len(matrix)))]
