"""Claims of answers checked again in plain fractions, from the data and the answers as texts alone.

This module imports the standard library and nothing else, reads texts by a parser of its own, and shares no line with
the code that finds answers or checks them first.  It stands alone: it may be copied to where symobs is not.

What has symbols is checked at a random point, which the answer cannot know; a polynomial or a rational function of s at
more values of s than its degree allows to agree by chance.  Values beyond fractions (roots, exponentials) are left out.
"""

from __future__ import annotations

import hashlib
import random
import re
from fractions import Fraction
from typing import TYPE_CHECKING, Any

from symobs.applications.grader.claims import faddeev_leverrier, minus, negative, transfer, transpose
from symobs.applications.grader.claims import product as times
from symobs.applications.grader.values import ONE, UnreadableError, VanishingError, number, poly
from symobs.applications.grader.values import read as read_value

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Mapping, Sequence

    from symobs.applications.grader.values import Ratio

Matrix = list[list[Fraction]]

_MOST_DRAWS = 30
#: A product without its sign, which our texts never have.
_UNSIGNED = re.compile(r"[\w)]\s+[\w(]|\b\d+[A-Za-z_(]")


class Beyond(ArithmeticError):
    """A text that is no rational function of its symbols."""


def fault(task: str, given: Mapping[str, Any], answer: Mapping[str, Any], seed: str) -> str | None:
    """Return the first claim of an answer that does not hold, None where all that is looked at hold.

    given    the matrices A, B, C, D as lists of texts, `variable`, `signs`, and `polynomials` by the name of their half
    answer   the fields of the task, as texts
    """
    if task not in CLAIMS:
        return None
    drawn = random.Random(hashlib.sha256(seed.encode()).digest())  # noqa: S311 - points, no secrets
    for _ in range(_MOST_DRAWS):
        point = {name: _drawn(sign, drawn) for name, sign in sorted(given["signs"].items())}
        try:
            return fault_at(point, task, given, answer)
        except Beyond:
            return None
        except ZeroDivisionError:
            continue  # a denominator vanishes there
    return None


def fault_at(
    point: Mapping[str, Fraction], task: str, given: Mapping[str, Any], answer: Mapping[str, Any]
) -> str | None:
    """Return the first claim that does not hold at a point; raises `ZeroDivisionError` where one is not defined."""
    for says, holds in CLAIMS[task](_Read(point, given, answer)):
        if not holds:
            return says
    return None


def _drawn(sign: str, drawn: random.Random) -> Fraction:
    size = Fraction(drawn.randint(1, 10**6), drawn.randint(1, 10**3))
    if sign in {"negative", "nonpositive"} or (sign in {"real", "nonzero"} and drawn.random() < 1 / 2):
        return -size
    return size


# -- reading ----------------------------------------------------------------------------------------------------------


def ratio(text: str, names: Mapping[str, Fraction], variable: str = "") -> Ratio:
    """Return the value of a text, a function of the variable; raises `Beyond` for other functions and names."""
    letters = {name: (poly([value]), ONE) for name, value in names.items()}
    letters |= {variable: (poly([0, 1]), ONE)} if variable else {}
    if _UNSIGNED.search(text):
        raise Beyond(text)
    try:
        return read_value(text, letters)
    except VanishingError as error:
        raise ZeroDivisionError from error
    except UnreadableError as error:
        raise Beyond(text) from error


def value(text: str, names: Mapping[str, Fraction]) -> Fraction:
    """Return the value of a text such as `(2*a**2 - 1)/(3*b)`."""
    return number(ratio(text, names))


class _Read:
    """Data and answers at a point."""

    def __init__(self, point: Mapping[str, Fraction], given: Mapping[str, Any], answer: Mapping[str, Any]) -> None:
        self.point, self.given, self.answer = point, given, answer
        self.A = self.matrix(given["A"])
        self.n = len(self.A)

    def matrix(self, rows: Sequence[Sequence[str]]) -> Matrix:
        """Return a matrix of texts."""
        return [[value(entry, self.point) for entry in row] for row in rows]

    def data(self, name: str) -> Matrix:
        """Return B, C or D; D is zero where it is not given."""
        if name in self.given:
            return self.matrix(self.given[name])
        return zeros(len(self.given["C"]), len(self.given["B"][0]))

    def answered(self, name: str) -> Matrix | None:
        """Return a matrix of the answer, None where there is none."""
        rows = self.answer.get(name)
        return None if rows is None else self.matrix(rows)

    def function(self, text: str) -> Ratio:
        """Return a text as a function of the variable."""
        return ratio(text, self.point, self.given["variable"])

    def functions(self, name: str) -> list[list[Ratio]]:
        """Return an answer, one text or rows of texts, as functions of the variable."""
        found = self.answer[name]
        return [[self.function(entry) for entry in row] for row in ([[found]] if isinstance(found, str) else found)]

    def wanted(self, half: str) -> str | None:
        """Return the polynomial asked for, None where a gain was given."""
        found: str | None = self.given["polynomials"].get(half)
        return found


def zeros(rows: int, columns: int) -> Matrix:
    """Return a matrix of zeros."""
    return [[Fraction(0)] * columns for _ in range(rows)]


def rank(matrix: Matrix) -> int:
    """Return the rank."""
    rows, found = [list(row) for row in matrix], 0
    for column in range(len(rows[0]) if rows else 0):
        place = next((i for i in range(found, len(rows)) if rows[i][column]), None)
        if place is not None:
            rows[found], rows[place] = rows[place], rows[found]
            for i in range(found + 1, len(rows)):
                factor = rows[i][column] / rows[found][column]
                rows[i] = [x - factor * y for x, y in zip(rows[i], rows[found], strict=True)]
            found += 1
    return found


def transfers(A: Matrix, B: Matrix, C: Matrix, D: Matrix) -> list[list[Ratio]]:
    """Return C (sI − A)⁻¹ B + D."""
    columns = [[[entry] for entry in column] for column in transpose(B)]
    return [
        [transfer(A, b, [c], [[d]]) for b, d in zip(columns, row, strict=True)] for c, row in zip(C, D, strict=True)
    ]


# -- claims -----------------------------------------------------------------------------------------------------------


def _placed(read: _Read, closed: Matrix, half: str, says: str) -> Iterator[tuple[str, bool]]:
    """Yield that the polynomial of a closed loop is the one asked for."""
    wanted = read.wanted(half)
    if wanted is not None:
        yield says, read.function(wanted) == (faddeev_leverrier(closed)[0], ONE)
    if isinstance(own := read.answer.get("polynomial"), str):
        yield f"the polynomial is that of {says}", read.function(own) == (faddeev_leverrier(closed)[0], ONE)


def _state_feedback(read: _Read) -> Iterator[tuple[str, bool]]:
    K = read.answered("K")
    if K is None:
        return
    closed = minus(read.A, times(read.data("B"), K))
    yield from _placed(read, closed, "control", "det(s*I - A + B*K) = phi(s)")
    if read.answer.get("closed_loop_matrix") is not None:
        yield "A - B*K", read.answered("closed_loop_matrix") == closed


def _integral_action(read: _Read) -> Iterator[tuple[str, bool]]:
    """Yield that [K, -k_I] places the poles of A_hat = [A 0; -C 0], B_hat = [B; -D], with I for 0 in discrete time."""
    K, k_I = read.answered("K"), read.answered("k_I")
    if K is None or k_I is None:
        return
    C, p = read.data("C"), len(k_I[0])
    own = [[Fraction(int(i == j and read.given["discrete"])) for j in range(p)] for i in range(p)]
    A = [[*row, *zeros(1, p)[0]] for row in read.A]
    A += [[*left, *right] for left, right in zip(negative(C), own, strict=True)]
    B = [*read.data("B"), *negative(read.data("D"))]
    gain = [[*left, *right] for left, right in zip(K, negative(k_I), strict=True)]
    closed = minus(A, times(B, gain))
    yield from _placed(read, closed, "control", "det(s*I - A_hat + B_hat*[K, -k_I]) = phi(s)")
    if read.answer.get("closed_loop_matrix") is not None:
        yield "A_hat - B_hat*[K, -k_I]", read.answered("closed_loop_matrix") == closed


def _observer(read: _Read) -> Iterator[tuple[str, bool]]:
    L = read.answered("L")
    if L is None:
        return
    closed = minus(read.A, times(L, read.data("C")))
    yield from _placed(read, closed, "observer", "det(s*I - A + L*C) = phi(s)")
    if read.answer.get("A") is not None:
        yield "A - L*C", read.answered("A") == closed
    if read.answer.get("B_u") is not None and "B" in read.given:
        yield "B - L*D", read.answered("B_u") == minus(read.data("B"), times(L, read.data("D")))


def _compensator(read: _Read) -> Iterator[tuple[str, bool]]:
    K, L = read.answered("K"), read.answered("L")
    if K is None or read.answer.get("F") is None:
        return
    B, C, D = read.data("B"), read.data("C"), read.data("D")
    yield from _placed(read, minus(read.A, times(B, K)), "control", "det(s*I - A + B*K) = phi_c(s)")
    if L is None or len(L) != read.n or read.given.get("observer") == "minimal":
        return
    yield from _placed(read, minus(read.A, times(L, C)), "observer", "det(s*I - A + L*C) = phi_o(s)")
    own = minus(minus(read.A, times(B, K)), times(L, minus(C, times(D, K))))
    found = transfers(own, L, K, zeros(len(K), len(C)))
    yield "F = K*(s*I - A + B*K + L*C - L*D*K)**-1*L", read.functions("F") == found


def _ranks(letter: str) -> Callable[[_Read], Iterator[tuple[str, bool]]]:
    def claims(read: _Read) -> Iterator[tuple[str, bool]]:
        A, stacked = read.A, read.data(letter)
        if letter == "B":
            A, stacked = transpose(A), transpose(stacked)
        rows, block = [], stacked
        for _ in range(read.n):
            rows += block
            block = times(block, A)
        whole = rows if letter == "C" else transpose(rows)
        yield f"the matrix of {letter}", read.answered("matrix") == whole
        yield "the rank", rank(rows) == read.answer["rank"]

    return claims


def _characteristic_polynomial(read: _Read) -> Iterator[tuple[str, bool]]:
    if "A" in read.given and isinstance(read.answer.get("polynomial"), str):
        yield "det(s*I - A)", read.function(read.answer["polynomial"]) == (faddeev_leverrier(read.A)[0], ONE)


def _transfer_function(read: _Read) -> Iterator[tuple[str, bool]]:
    found = transfers(read.A, read.data("B"), read.data("C"), read.data("D"))
    yield "C*(s*I - A)**-1*B + D", read.functions("transfer_function") == found


def _coordinates(read: _Read) -> Iterator[tuple[str, bool]]:
    T, A = read.answered("T"), read.answered("A")
    if T is None or A is None:
        return
    yield "T is regular", rank(T) == read.n
    yield "T*A = A_bar*T", times(T, read.A) == times(A, T)
    if read.answer.get("B") is not None and "B" in read.given:
        yield "T*B = B_bar", times(T, read.data("B")) == read.answered("B")
    if read.answer.get("C") is not None and "C" in read.given:
        yield "C = C_bar*T", read.data("C") == times(read.answered("C") or [], T)


#: The claims of each task that is looked at again.
CLAIMS: dict[str, Callable[[_Read], Iterator[tuple[str, bool]]]] = {
    "canonical_form": _coordinates,
    "characteristic_polynomial": _characteristic_polynomial,
    "compensator": _compensator,
    "controllability": _ranks("B"),
    "decomposition": _coordinates,
    "integral_action": _integral_action,
    "observability": _ranks("C"),
    "observer": _observer,
    "state_feedback": _state_feedback,
    "transfer_function": _transfer_function,
}
