"""Verdicts on answers in control, with the standard library alone: a gain is right where its claim holds.

`judge(question, given)` takes the data of a question and the texts of an answer, and never raises.  Where a question has
symbols, everything is computed at two points drawn from the answer itself: an identity that fails holds at neither, but for
a chance below 2^-50.  The verdicts, slips and credits are those of `symobs check`.
"""

from __future__ import annotations

from fractions import Fraction
from typing import TYPE_CHECKING, Any

from symobs.applications.grader.values import (
    DECIMAL,
    ONE,
    TYPED,
    Poly,
    Ratio,
    UnreadableError,
    divided_by,
    number,
    plus,
    points,
    poly,
    read,
    scaled,
    times,
)

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence

    #: Rows of numbers, of functions, and of texts; the data of a part of a question.
    Rows = list[list[Fraction]]
    Functions = list[list[Ratio]]
    Texts = Sequence[Sequence[str]]
    Part = Mapping[str, Any]
    Verdict = tuple[str, str, str]

#: What a verdict may be called.
WORDS = {
    "yes": "yes",
    "true": "yes",
    "ja": "yes",
    "no": "no",
    "false": "no",
    "nein": "no",
    "conditional": "conditional",
}

# -- matrices of numbers -------------------------------------------------------------------------------------------------


def product(X: Rows, Y: Rows) -> Rows:
    """Return X Y."""
    columns = list(zip(*Y, strict=True))
    return [[sum((a * b for a, b in zip(row, column, strict=True)), Fraction(0)) for column in columns] for row in X]


def minus(X: Rows, Y: Rows) -> Rows:
    """Return X - Y."""
    return [[a - b for a, b in zip(*rows, strict=True)] for rows in zip(X, Y, strict=True)]


def negative(X: Rows) -> Rows:
    """Return -X."""
    return [[-a for a in row] for row in X]


def transpose(X: list[list[Any]]) -> list[list[Any]]:
    """Return the transpose."""
    return [list(column) for column in zip(*X, strict=True)]


def size(X: list[list[Any]]) -> tuple[int, int]:
    """Return the numbers of rows and columns."""
    return len(X), len(X[0])


def faddeev_leverrier(A: Rows) -> tuple[Poly, list[Rows]]:
    """Return det(sI - A), from the lowest power, and the matrices of adj(sI - A) by the power of s."""
    n = len(A)
    one = [[Fraction(int(i == j)) for j in range(n)] for i in range(n)]
    coefficients, M, matrices = [Fraction(1)], one, [one]
    for k in range(1, n + 1):
        AM = product(A, M)
        c = -sum((AM[i][i] for i in range(n)), Fraction(0)) / k
        coefficients.append(c)
        M = [[AM[i][j] + c * one[i][j] for j in range(n)] for i in range(n)]
        matrices.append(M)
    return poly(reversed(coefficients)), list(reversed(matrices[:-1]))


def transfer(A: Rows, B: Rows, C: Rows, D: Rows) -> Ratio:
    """Return C (sI - A)^-1 B + D of one input and one output."""
    chi, adjugate = faddeev_leverrier(A)
    return divided_by(plus(poly(product(product(C, M), B)[0][0] for M in adjugate), scaled(chi, D[0][0])), chi)


# -- gains ---------------------------------------------------------------------------------------------------------------


def closed(part: Part, value: Rows) -> Poly:
    """Return det(sI - A + LC) of the observer problem that a gain belongs to."""
    gain = transpose(value) if part["transposed"] else value
    return faddeev_leverrier(minus(part["A"], product(gain, part["C"])))[0]


def is_right(part: Part, value: Rows) -> bool:
    """Return whether the claim of a gain holds: det(sI - A + LC) is the polynomial, and zeros are where they are asked for."""
    return (
        size(value) == size(part["right"])
        and closed(part, value) == part["phi"]
        and all(not value[i][j] for i, j in part["zero"])
    )


def judge_gain(part: Part, value: Rows, texts: Texts, *, exact: bool) -> Verdict:
    """Return verdict, slip and reason of a gain in the standard sign; `exact` says that numbers may be shown."""
    letter, right = part["letter"], part["right"]
    if size(value) != size(right):
        if is_right(part, transpose(value)):
            return "wrong", "transposed", f"the transpose of {letter} is right"
        return "wrong", "", "{} is {}x{} here, yours is {}x{}".format(letter, *size(right), *size(value))
    if is_right(part, value):
        return "right", "", ""
    if is_right(part, negative(value)):
        return "wrong", "sign", f"the sign of {letter}"
    if is_right(part, transpose(value)):
        return "wrong", "transposed", f"the transpose of {letter} is right"
    if rounds(texts, negative(value) if part["turned"] else value, negative(right) if part["turned"] else right):
        return "wrong", "rounded", f"{letter} is rounded, and its exact value is asked for"
    mine = closed(part, value)
    found = list(corrected(part, value, mine))
    if len(found) == 1:
        (i, j, entry) = found[0]
        said = f"entry ({i + 1},{j + 1})"
        entry = -entry if part["turned"] else entry
        return (
            "wrong",
            "entry",
            f"{said} should be {entry} with the others as they are" if exact else f"{said} is wrong",
        )
    if found:
        return "wrong", "entry", "one of several slips in a single entry"
    off = [k for k in range(len(mine)) if mine[k] != part["phi"][k]]
    if len(off) > 1 and part["other"] is not None and mine == part["other"]:
        return "wrong", "other_half", f"{letter} places the poles of the other half"
    shown = f" is {written(mine, part['variable'])}," if exact else " is"
    return "wrong", "", f"with your {letter} the polynomial{shown} not the one asked for"


def corrected(part: Part, value: Rows, mine: Poly) -> Iterator[tuple[int, int, Fraction]]:
    """Yield each entry whose change alone makes a gain right, with its value: the polynomial is affine in it."""
    wanted = plus(part["phi"], scaled(mine, -1))
    for i, row in enumerate(value):
        for j, entry in enumerate(row):
            other = [list(line) for line in value]
            other[i][j] = Fraction(0)
            if not any(any(line) for line in other):  # to tell the entry would be to tell the gain
                continue
            other[i][j] = entry + 1
            change = plus(closed(part, other), scaled(mine, -1))
            if change and wanted:
                other[i][j] = entry + wanted[-1] / change[-1]
                if is_right(part, other):
                    yield i, j, other[i][j]


def rounds(texts: Texts, value: Rows, right: Rows) -> bool:
    """Return whether the entries written as decimals round the right ones, and all others are right."""
    found = False
    for row in zip(texts, value, right, strict=True):
        for text, mine, exact in zip(*row, strict=True):
            match = DECIMAL.fullmatch(text.translate(TYPED))
            if match is None or (match[3] is None and match[4] is None):
                if mine != exact:
                    return False
                continue
            found = True
            if abs(mine - exact) > Fraction(10) ** (int(match[4] or 0) - len(match[3] or "")) / 2:
                return False
    return found


def written(p: Poly, variable: str) -> str:
    """Return a monic polynomial as text."""
    terms = []
    for power in range(len(p) - 1, -1, -1):
        name = "" if not power else variable if power == 1 else f"{variable}^{power}"
        if p[power]:
            factor = "" if name and abs(p[power]) == 1 else f"{abs(p[power])} " if name else str(abs(p[power]))
            terms.append(("- " if p[power] < 0 else "+ ") + factor + name)
    return " ".join(terms).removeprefix("+ ")


# -- the compensator -----------------------------------------------------------------------------------------------------


def compensator(part: Part, K: Rows, L: Rows) -> Ratio:
    """Return F = K (sI - A + BK + LC - LDK)^-1 L."""
    A, B, C, D = (part[name] for name in "ABCD")
    inner = minus(minus(A, product(B, K)), product(L, minus(C, product(D, K))))
    return transfer(inner, L, K, [[Fraction(0)]])


def closes_the_loop(part: Part, F: Ratio) -> bool:
    """Return whether F, proper and of no larger order than the observer, gives the loop its polynomial."""
    above, below = F
    chi = faddeev_leverrier(part["A"])[0]
    if len(above) > len(below) or len(below) - 1 > part["order"]:
        return False
    P, Q = transfer(*(part[name] for name in "ABCD"))
    loop = divided_by(times(chi, plus(times(Q, below), times(P, above))), Q)
    return loop == (part["phi"], ONE)


def judge_compensator(
    part: Part, F: Ratio, gains: Mapping[str, tuple[str, Rows]], marks: Mapping[str, Any]
) -> tuple[str, str, str, Fraction]:
    """Return verdict, slip, reason and what the credit is multiplied by; `gains` are the student's, with their parts."""
    kinds = {name: gains[name][0] if name in gains else "" for name in "KL"}
    right = {name: gains[name][1] if kinds[name] == "right" else part[f"right_{name}"] for name in "KL"}
    wrong = [name for name in "KL" if kinds[name] == "wrong"]
    exact = compensator(part, right["K"], right["L"])
    opposite = (scaled(F[0], -1), F[1])
    taken = (F, opposite) if marks["sign_of_F"] == "either" else (F,)
    if exact in taken:
        return "right", "", "", Fraction(1)
    if wrong and compensator(part, *(gains[name][1] if name in wrong else right[name] for name in "KL")) in taken:
        easy = any(is_degenerate(gains[name][1], right[name]) for name in wrong) or max(map(len, F)) < 2
        said = "it follows from your earlier result"
        if easy and marks["guard"]:
            return "follows", "", f"{said}, which makes this part too easy to count", Fraction(0)
        return "follows", "", said, Fraction(marks["follow_through"])
    if not gains and closes_the_loop(part, F):
        return "right", "", "another compensator with the same closed-loop polynomial", Fraction(1)
    if opposite == exact:
        return "wrong", "sign_convention", "-F is right with positive feedback", Fraction(1)
    return "wrong", "", f"this is not the {part['letter']} of your gains" if gains else "", Fraction(1)


def is_degenerate(mine: Rows, right: Rows) -> bool:
    """Return whether a wrong gain makes easy what follows: zero, much emptier than the right one, or one entry alone."""
    filled, wanted = (sum(bool(entry) for row in matrix for entry in row) for matrix in (mine, right))
    return filled == 0 or 2 * filled < wanted or filled == 1 < wanted


# -- other values --------------------------------------------------------------------------------------------------------


def judge_value(part: Part, value: Functions, texts: Texts) -> Verdict:
    """Return verdict, slip and reason of a value that is the only right one."""
    right, letter = part["right"], part["letter"]
    if value == right:
        return "right", "", ""
    if size(value) != size(right):
        turned = transpose(value) == right
        return "wrong", "transposed" if turned else "", f"the transpose of {letter} is right" if turned else ""
    if not part["exact"] and rounds_to(texts, value, right):
        return "wrong", "rounded", f"{letter} is rounded, and its exact value is asked for"
    if [[(scaled(a, -1), b) for a, b in row] for row in value] == right:
        return "wrong", "sign", f"-{letter} is right"
    if transpose(value) == right:
        return "wrong", "transposed", f"the transpose of {letter} is right"
    off = [(i, j) for i, row in enumerate(right) for j, entry in enumerate(row) if value[i][j] != entry]
    if len(off) == 1 and size(right) != (1, 1):
        return "wrong", "entry", f"entry ({off[0][0] + 1},{off[0][1] + 1}) is wrong"
    return "wrong", "", ""


def rounds_to(texts: Texts, value: Functions, right: Functions) -> bool:
    """Return whether a matrix without the variable rounds the right one."""
    try:
        mine, exact = ([[number(entry) for entry in row] for row in matrix] for matrix in (value, right))
    except UnreadableError:
        return False
    return rounds(texts, mine, exact)


# -- the whole answer ----------------------------------------------------------------------------------------------------


def judge(question: Mapping[str, Any], given: Mapping[str, Texts]) -> dict[str, dict[str, Any]]:
    """Return for each part of a question its verdict, slip, reason and credit; `given` holds rows of texts by part."""
    at = [_judged(question, given, point) for point in points(question, given)]
    return {
        name: found if all(other[name]["verdict"] == found["verdict"] for other in at) else _outcome("wrong")
        for name, found in at[0].items()
    }


def score(question: Mapping[str, Any], outcomes: Mapping[str, Mapping[str, Any]]) -> Fraction:
    """Return the share of the marks, an exact fraction."""
    weights = {part["name"]: Fraction(part["weight"]) for part in question["parts"]}
    got = sum((weights[name] * outcome["credit"] for name, outcome in outcomes.items()), Fraction(0))
    return got / sum(weights.values())


def _outcome(verdict: str, slip: str = "", reason: str = "", credit: Fraction | int = 0) -> dict[str, Any]:
    return {"verdict": verdict, "slip": slip, "reason": reason, "credit": credit}


def _judged(
    question: Mapping[str, Any], given: Mapping[str, Texts], point: Mapping[str, Ratio]
) -> dict[str, dict[str, Any]]:
    """Return the outcomes at one point."""
    found: dict[str, dict[str, Any]] = {}
    gains: dict[str, tuple[str, Rows]] = {}
    for part in sorted(question["parts"], key=lambda part: part["kind"] != "gain"):
        texts = given.get(part["name"])
        if not texts or not any(cell.strip() for row in texts for cell in row):
            found[part["name"]] = _outcome("missing")
            continue
        try:
            found[part["name"]] = _part(question["marks"], _at(part, point), texts, point, gains)
        except UnreadableError as error:
            found[part["name"]] = _outcome("unreadable", reason=str(error))
        except Exception:  # noqa: BLE001 - a grader that raises traps a student
            found[part["name"]] = _outcome("unreadable", reason="this could not be read")
    return {part["name"]: found[part["name"]] for part in question["parts"]}


def _part(
    marks: Mapping[str, Any],
    part: Part,
    texts: Texts,
    point: Mapping[str, Ratio],
    gains: dict[str, tuple[str, Rows]],
) -> dict[str, Any]:
    """Return the outcome of one part that was given; gains are kept for what follows from them."""
    factor = Fraction(1)
    if part["kind"] == "word":
        word = WORDS.get(texts[0][0].strip().strip('"').lower())
        if word is None:
            raise UnreadableError("write yes, no or conditional")
        verdict, slip, reason = "right" if word == part["right"] else "wrong", "", ""
    else:
        variable = {part["variable"]: (poly([0, 1]), ONE)} if part["function"] else {}
        value = [[read(cell, {**point, **variable}) for cell in row] for row in texts]
        if any(len(row) != len(value[0]) for row in value):
            raise UnreadableError("the rows have different lengths")
        if part["kind"] == "gain":
            gain = [[number(entry) for entry in row] for row in value]
            gain = negative(gain) if part["turned"] else gain
            verdict, slip, reason = judge_gain(part, gain, texts, exact=not point)
            fits = size(gain) == size(part["right"])
            gains[part["part"]] = (verdict if fits else "misshapen", gain)
        elif part["kind"] == "compensator":
            task = part["part"].partition(".")[0]
            own = {name: gains[f"{task}.{name}"] for name in "KL" if f"{task}.{name}" in gains}
            verdict, slip, reason, factor = judge_compensator(part, value[0][0], own, marks)
        else:
            verdict, slip, reason = judge_value(part, value, texts)
    if slip == "rounded" and marks["decimals"] == "accept" and part["kind"] == "value":
        verdict = "right"
    credit = Fraction(1) if verdict in {"right", "follows"} else Fraction(marks["credit"].get(slip, 0))
    return _outcome(verdict, slip, reason, credit * factor)


def _at(part: Part, point: Mapping[str, Ratio]) -> dict[str, Any]:
    """Return the data of a part with values in place of texts."""

    def matrix(rows: Texts) -> Rows:
        return [[number(read(cell, point)) for cell in row] for row in rows]

    made = dict(part)
    for name in ("A", "B", "C", "D", "right_K", "right_L"):
        if name in part:
            made[name] = matrix(part[name])
    for name in ("phi", "other"):
        if part.get(name) is not None:
            made[name] = poly(number(read(cell, point)) for cell in reversed(part[name]))
    if part["kind"] == "gain":
        made["right"] = matrix(part["right"])
    elif part["kind"] == "value":
        variable = {part["variable"]: (poly([0, 1]), ONE)}
        made["right"] = [[read(cell, {**point, **variable}) for cell in row] for row in part["right"]]
    return made
