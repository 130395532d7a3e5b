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

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Mapping, Sequence

Matrix = list[list[Fraction]]

_TOKEN = re.compile(r"\s*([0-9]+|[A-Za-z_][A-Za-z0-9_]*|\*\*|[-+*/()])")
_MOST_DRAWS = 30
_LARGEST_POWER = 10_000


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


def value(text: str, names: Mapping[str, Fraction]) -> Fraction:
    """Return the value of a text such as `(2*a**2 - 1)/(3*b)`; raises `Beyond` for other functions and names."""
    tokens = [*_tokens(text), ""]
    found, place = _sum(tokens, 0, names)
    if tokens[place]:
        raise Beyond(text)
    return found


def _tokens(text: str) -> list[str]:
    found, place = [], 0
    text = text.rstrip()
    while place < len(text):
        token = _TOKEN.match(text, place)
        if token is None:
            raise Beyond(text)
        found.append(token[1])
        place = token.end()
    return found


def _sum(tokens: Sequence[str], place: int, names: Mapping[str, Fraction]) -> tuple[Fraction, int]:
    total, place = _product(tokens, place, names)
    while tokens[place] in {"+", "-"}:
        sign = 1 if tokens[place] == "+" else -1
        term, place = _product(tokens, place + 1, names)
        total += sign * term
    return total, place


def _product(tokens: Sequence[str], place: int, names: Mapping[str, Fraction]) -> tuple[Fraction, int]:
    total, place = _signed(tokens, place, names)
    while tokens[place] in {"*", "/"}:
        operator = tokens[place]
        factor, place = _signed(tokens, place + 1, names)
        total = total * factor if operator == "*" else total / factor
    return total, place


def _signed(tokens: Sequence[str], place: int, names: Mapping[str, Fraction]) -> tuple[Fraction, int]:
    if tokens[place] in {"+", "-"}:
        found, after = _signed(tokens, place + 1, names)
        return (found if tokens[place] == "+" else -found), after
    base, place = _atom(tokens, place, names)
    if tokens[place] != "**":
        return base, place
    exponent, place = _signed(tokens, place + 1, names)
    if exponent.denominator != 1 or abs(exponent) > _LARGEST_POWER:
        raise Beyond(str(exponent))
    return base ** int(exponent), place


def _atom(tokens: Sequence[str], place: int, names: Mapping[str, Fraction]) -> tuple[Fraction, int]:
    word = tokens[place]
    if word == "(":
        found, place = _sum(tokens, place + 1, names)
        if tokens[place] != ")":
            raise Beyond("a bracket is not closed")
        return found, place + 1
    if word.isdigit():
        return Fraction(int(word)), place + 1
    if word not in names or tokens[place + 1] == "(":
        raise Beyond(word)
    return names[word], place + 1


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

    def function(self, text: str) -> Callable[[Fraction], Fraction]:
        """Return a text as a function of the variable."""
        name = self.given["variable"]
        return lambda at: value(text, {**self.point, name: at})

    def same(self, left: str, right: Callable[[Fraction], Fraction], degree: int) -> bool:
        """Return whether a text agrees with a function at more places than two of this degree can by chance."""
        return all(self.function(left)(at) == right(at) for at in _places(degree + 1))

    def wanted(self, half: str) -> str | None:
        """Return the polynomial asked for, None where a gain was given."""
        found: str | None = self.given["polynomials"].get(half)
        return found


def _places(count: int) -> list[Fraction]:
    """Return values of s that are hardly poles of anything."""
    return [Fraction(10007 * k + 3, 1009) for k in range(1, count + 1)]


# -- matrices ---------------------------------------------------------------------------------------------------------


def zeros(rows: int, columns: int) -> Matrix:
    """Return a matrix of zeros."""
    return [[Fraction(0)] * columns for _ in range(rows)]


def times(a: Matrix, b: Matrix) -> Matrix:
    """Return a b."""
    columns = list(zip(*b, strict=True))
    return [[sum((x * y for x, y in zip(row, column, strict=True)), Fraction(0)) for column in columns] for row in a]


def minus(a: Matrix, b: Matrix) -> Matrix:
    """Return a − b."""
    return [[x - y for x, y in zip(left, right, strict=True)] for left, right in zip(a, b, strict=True)]


def plus(a: Matrix, b: Matrix) -> Matrix:
    """Return a + b."""
    return [[x + y for x, y in zip(left, right, strict=True)] for left, right in zip(a, b, strict=True)]


def pencil(matrix: Matrix, at: Fraction) -> Matrix:
    """Return s I − matrix."""
    return [[(at if i == j else 0) - entry for j, entry in enumerate(row)] for i, row in enumerate(matrix)]


def reduced(matrix: Matrix) -> tuple[Matrix, Fraction, int]:
    """Return the matrix after elimination, the product of its pivots with sign, and its rank."""
    rows, product, rank = [list(row) for row in matrix], Fraction(1), 0
    for column in range(len(rows[0]) if rows else 0):
        place = next((i for i in range(rank, len(rows)) if rows[i][column]), None)
        if place is None:
            continue
        if place != rank:
            rows[rank], rows[place], product = rows[place], rows[rank], -product
        pivot = rows[rank][column]
        product *= pivot
        for i in range(rank + 1, len(rows)):
            if factor := rows[i][column] / pivot:
                rows[i] = [x - factor * y for x, y in zip(rows[i], rows[rank], strict=True)]
        rank += 1
    return rows, product, rank


def determinant(matrix: Matrix) -> Fraction:
    """Return det."""
    _, product, rank = reduced(matrix)
    return product if rank == len(matrix) else Fraction(0)


def inverse_times(matrix: Matrix, right: Matrix) -> Matrix:
    """Return matrix⁻¹ right; raises `ZeroDivisionError` for a singular matrix."""
    n = len(matrix)
    rows, _, rank = reduced([[*row, *more] for row, more in zip(matrix, right, strict=True)])
    if rank < n or any(not rows[i][i] for i in range(n)):
        raise ZeroDivisionError
    found = zeros(n, len(right[0]))
    for i in reversed(range(n)):
        for j in range(len(right[0])):
            known = sum((rows[i][k] * found[k][j] for k in range(i + 1, n)), Fraction(0))
            found[i][j] = (rows[i][n + j] - known) / rows[i][i]
    return found


# -- claims -----------------------------------------------------------------------------------------------------------


def _placed(read: _Read, closed: Matrix, half: str, says: str) -> Iterator[tuple[str, bool]]:
    """Yield that the polynomial of a closed loop is the one asked for."""
    wanted = read.wanted(half)
    if wanted is not None:
        yield says, read.same(wanted, lambda at: determinant(pencil(closed, at)), len(closed))
    if isinstance(read.answer.get("polynomial"), str):
        own = read.answer["polynomial"]
        yield (
            f"the polynomial is that of {says}",
            read.same(own, lambda at: determinant(pencil(closed, at)), len(closed)),
        )


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
    own = pencil(zeros(p, p), Fraction(1)) if read.given["discrete"] else zeros(p, p)
    A = [[*row, *zeros(1, p)[0]] for row in read.A]
    A += [[*left, *right] for left, right in zip(minus(zeros(p, read.n), C), own, strict=True)]
    B = [*read.data("B"), *minus(zeros(p, len(K)), read.data("D"))]
    gain = [[*left, *right] for left, right in zip(K, minus(zeros(len(K), p), k_I), strict=True)]
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
    K, L, F = read.answered("K"), read.answered("L"), read.answer.get("F")
    if K is None or F is None:
        return
    B, C, D = read.data("B"), read.data("C"), read.data("D")
    yield from _placed(read, minus(read.A, times(B, K)), "control", "det(s*I - A + B*K) = phi_c(s)")
    if L is None or len(L) != read.n or read.given.get("observer") == "minimal":
        return
    yield from _placed(read, minus(read.A, times(L, C)), "observer", "det(s*I - A + L*C) = phi_o(s)")
    own = plus(minus(minus(read.A, times(B, K)), times(L, C)), times(L, times(D, K)))
    rows = [[F]] if isinstance(F, str) else F
    for at in _places(2 * read.n + 1):
        found = times(K, inverse_times(pencil(own, at), L))
        printed = [[read.function(entry)(at) for entry in row] for row in rows]
        yield "F = K*(s*I - A + B*K + L*C - L*D*K)**-1*L", printed == found


def _ranks(letter: str) -> Callable[[_Read], Iterator[tuple[str, bool]]]:
    def claims(read: _Read) -> Iterator[tuple[str, bool]]:
        A, stacked = read.A, read.data(letter)
        if letter == "B":
            A, stacked = _transposed(A), _transposed(stacked)
        rows, block = [], stacked
        for _ in range(read.n):
            rows += block
            block = times(block, A)
        whole = rows if letter == "C" else _transposed(rows)
        yield f"the matrix of {letter}", read.answered("matrix") == whole
        yield "the rank", reduced(rows)[2] == read.answer["rank"]

    return claims


def _transposed(matrix: Matrix) -> Matrix:
    return [list(column) for column in zip(*matrix, strict=True)]


def _characteristic_polynomial(read: _Read) -> Iterator[tuple[str, bool]]:
    if "A" in read.given and isinstance(read.answer.get("polynomial"), str):
        own = read.answer["polynomial"]
        yield "det(s*I - A)", read.same(own, lambda at: determinant(pencil(read.A, at)), read.n)


def _transfer_function(read: _Read) -> Iterator[tuple[str, bool]]:
    G = read.answer["transfer_function"]
    rows = [[G]] if isinstance(G, str) else G
    for at in _places(2 * read.n + 1):
        found = plus(times(read.data("C"), inverse_times(pencil(read.A, at), read.data("B"))), read.data("D"))
        yield "C*(s*I - A)**-1*B + D", [[read.function(entry)(at) for entry in row] for row in rows] == found


def _coordinates(read: _Read) -> Iterator[tuple[str, bool]]:
    T, A = read.answered("T"), read.answered("A")
    if T is None or A is None:
        return
    yield "T is regular", determinant(T) != 0
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
