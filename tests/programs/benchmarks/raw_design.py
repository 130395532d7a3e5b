"""K, L and F(s) by FLINT's operations alone, beside symobs: `python -m tests.programs.benchmarks.raw_design`.

The cart-pole with eight symbolic poles on `fmpz_mpoly`, dense rational plants of order 10, 20 and 30 on `fmpz_mat` and
`fmpq_mat`: no reading, no types, no checks.  symobs is timed from the plant to the result, certificates included.
The family of gains for n = 6, p = 2 is timed as well.
"""

from __future__ import annotations

import random
import statistics
import time
from typing import TYPE_CHECKING
from unittest import mock

from flint import Ordering, fmpq_mat, fmpq_poly, fmpz_mat, fmpz_mpoly_ctx

import symobs
import symobs.tasks.result.result
from tests.programs.benchmarks import models
from tests.programs.benchmarks.raw_flint import _dot, _minors

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from flint import fmpz_mpoly

    from tests.programs.benchmarks.models import Model

    Row = Sequence[fmpz_mpoly]
    Fraction = tuple[fmpz_mpoly, fmpz_mpoly]


# -- the cart-pole ----------------------------------------------------------------------------------------------------


def cart_pole(model: Model) -> tuple[float, Fraction]:
    """Return the processor time of K, L and F, and F as (numerator, denominator)."""
    names = list(model.plain.values())
    context = fmpz_mpoly_ctx.get((*names, "s"), Ordering.lex)
    *generators, s = context.gens()
    M, m, length, g, b = generators[:5]
    control, observer = generators[5:9], generators[9:13]
    zero, d = context.constant(0), M * length
    N = [
        [zero, d, zero, zero],
        [zero, -b * length, -m * g * length, zero],
        [zero, zero, zero, d],
        [zero, b, (M + m) * g, zero],
    ]
    B, C = [zero, length, zero, context.constant(-1)], [context.constant(1), zero, zero, zero]
    start = time.process_time()
    K = _gain([list(row) for row in zip(*N, strict=True)], B, control, d)
    K = [_reduced(above * d, below) for above, below in K]
    L = _gain(N, C, observer, d)
    F = _transfer(N, d, (B, C), (_over_one(K), _over_one(L)), (control, observer), s)
    return time.process_time() - start, F


def _gain(N: Sequence[Row], C: Row, poles: Row, d: fmpz_mpoly) -> list[Fraction]:
    """Return Π (N + d p) v / (det · d) for A = N/d: the gain of (A, C)."""
    order = len(C)
    rows = [list(C)]
    for _ in range(order - 1):
        rows.append([_dot(rows[-1], [line[j] for line in N]) for j in range(order)])
    minors, everything = _minors(rows[:-1]), tuple(range(order))
    vector = []
    for j in range(order):
        minor = minors[everything[:j] + everything[j + 1 :]]
        vector.append(-minor if (order - 1 + j) % 2 else minor)
    below = _dot(rows[-1], vector) * d
    for p in poles:
        vector = [_dot([e + d * p if i == j else e for j, e in enumerate(line)], vector) for i, line in enumerate(N)]
    return [_reduced(entry, below) for entry in vector]


def _reduced(above: fmpz_mpoly, below: fmpz_mpoly) -> Fraction:
    common = above.gcd(below)
    return above / common, below / common


def _over_one(entries: list[Fraction]) -> tuple[list[fmpz_mpoly], fmpz_mpoly]:
    common = entries[0][1]
    for _, below in entries[1:]:
        common = common * (below / common.gcd(below))
    return [above * (common / below) for above, below in entries], common


def _bordered(N: Sequence[Row], d: fmpz_mpoly, b: Row, c: Row, s: fmpz_mpoly) -> tuple[fmpz_mpoly, fmpz_mpoly]:
    """Return c adj(sdI − N) b and det(sdI − N)."""
    order = len(c)
    rows = [[*(s * d - e if i == j else -e for j, e in enumerate(row)), b[i]] for i, row in enumerate(N)]
    minors = _minors(rows)
    total = c[0] * 0
    for j, entry in enumerate(c):
        term = entry * minors[(*range(j), *range(j + 1, order + 1))]
        total = total + term if (order - 1 - j) % 2 == 0 else total - term
    return total, minors[tuple(range(order))]


def _transfer(
    N: Sequence[Row],
    d: fmpz_mpoly,
    plant: tuple[Row, Row],
    gains: tuple[tuple[Row, fmpz_mpoly], tuple[Row, fmpz_mpoly]],
    poles: tuple[Row, Row],
    s: fmpz_mpoly,
) -> Fraction:
    """Return n/δ with n = K adj(sI − A) L and χ δ + z n = φ_c φ_o, reduced once."""
    (B, C), ((K, below_K), (L, below_L)) = plant, gains
    n, chi = _bordered(N, d, L, K, s)
    z, _ = _bordered(N, d, B, C, s)
    wanted = s**0
    for p in (*poles[0], *poles[1]):
        wanted = wanted * (s + p)
    cube = d ** (len(C) - 1)
    below = below_K * below_L * cube
    product = wanted * below * cube * d - z * n
    return _reduced(n, product / chi)


# -- numbers ----------------------------------------------------------------------------------------------------------


def numeric(order: int) -> tuple[float, float]:
    """Return the processor times of K, L and F for a dense integer plant: FLINT's, and symobs' with certificates."""
    generator = random.Random(order)  # noqa: S311 - the same plants in every run
    A, B, C = (
        [[generator.randint(-9, 9) for _ in range(columns)] for _ in range(rows)]
        for rows, columns in ((order, order), (order, 1), (1, order))
    )
    control, observer = range(1, order + 1), range(order + 1, 2 * order + 1)
    start = time.process_time()
    K = _numeric_gain(fmpz_mat(A).transpose(), fmpz_mat(B).transpose(), control).transpose()
    L = _numeric_gain(fmpz_mat(A), fmpz_mat(C), observer)
    own = fmpq_mat(fmpz_mat(A)) - fmpq_mat(fmpz_mat(B)) * K - L * fmpq_mat(fmpz_mat(C))
    below = own.charpoly()
    above = (own - L * K).charpoly() - below
    common = fmpq_poly(above).gcd(fmpq_poly(below))
    assert common.degree() >= 0
    raw = time.process_time() - start
    plant = symobs.StateSpace(A, B, C)
    start = time.process_time()
    found = symobs.compensator(plant, control_poles=[-p for p in control], observer_poles=[-p for p in observer])
    own_time = time.process_time() - start
    assert [str(e) for e in found.answer["K"].entries] == [str(K[0, j]) for j in range(order)]
    return raw, own_time


def _numeric_gain(A: fmpz_mat, C: fmpz_mat, poles: Sequence[int]) -> fmpq_mat:
    order = A.nrows()
    rows, row = [], C
    for _ in range(order):
        rows.append([row[0, j] for j in range(order)])
        row = row * A
    solved = fmpz_mat(rows).solve(fmpz_mat(order, 1, [0] * (order - 1) + [1]))
    vector, below = solved.numer_denom()  # type: ignore[attr-defined]
    for p in poles:
        vector = A * vector + vector * p
    return fmpq_mat(vector) / below  # type: ignore[no-any-return]


# -- the table --------------------------------------------------------------------------------------------------------


def _median(work: Callable[[], float], repetitions: int) -> float:
    return statistics.median(work() for _ in range(repetitions))


def _own_cart_pole() -> float:
    model = models.cart_pole()
    plant = symobs.StateSpace(model.A, model.B, model.C)
    start = time.process_time()
    symobs.compensator(plant, control_poles=list(model.control_poles), observer_poles=list(model.observer_poles))
    return time.process_time() - start


def _family() -> float:
    generator = random.Random(6)  # noqa: S311 - the same plant in every run
    A, C = ([[generator.randint(-9, 9) for _ in range(6)] for _ in range(rows)] for rows in (6, 2))
    plant = symobs.StateSpace(A, None, C)
    start = time.process_time()
    found = symobs.observer(plant, poles=[-1, -2, -3, -4, -5, -6])
    taken = time.process_time() - start
    assert found.gain_family is not None
    assert found.gain_family["dimension"] == 6
    return taken


def _unchecked(work: Callable[[], float]) -> float:
    """Return the time without the checks of claims."""
    with mock.patch.object(symobs.tasks.result.result, "check_all", return_value=()):
        return work()


def main() -> None:
    """Print one line a subject: FLINT alone, symobs with and without certificates, and the ratios."""
    _own_cart_pole(), cart_pole(models.cart_pole())
    raw, own = _median(lambda: cart_pole(models.cart_pole())[0], 9), _median(_own_cart_pole, 9)
    bare = _median(lambda: _unchecked(_own_cart_pole), 9)
    words = f"cart-pole, K, L and F(s): FLINT {raw * 1e3:.1f} ms, symobs {own * 1e3:.1f} ms, {own / raw:.2f} times"
    print(f"{words}; without certificates {bare * 1e3:.1f} ms, {bare / raw:.2f} times", flush=True)
    for order in (10, 20, 30):
        raw, own = (statistics.median(times) for times in zip(*(numeric(order) for _ in range(3)), strict=True))
        words = f"numbers, n = {order}, K, L and F(s): FLINT {raw * 1e3:.1f} ms, symobs {own * 1e3:.1f} ms"
        print(f"{words}, {own / raw:.2f} times", flush=True)
    print(f"family of gains, n = 6, p = 2: {_median(_family, 3):.3f} s", flush=True)


if __name__ == "__main__":
    main()
