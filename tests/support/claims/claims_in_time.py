"""What the results in functions of time claim, checked at a point by numbers of 60 digits and by Taylor coefficients.

e^{At} is mpmath's, Gramians are read off the exponential of a block matrix (C. F. Van Loan, IEEE Trans. Automat. Contr. 23
(1978), 395-404), outputs are compared by their Taylor coefficients, covariances by quadrature.
"""

from __future__ import annotations

from fractions import Fraction
from functools import cache
from typing import TYPE_CHECKING, Any

from mpmath.calculus.quadrature import GaussLegendre

from symobs.formula.tree import Literal
from tests.support.algebra import (
    CONTEXT,
    TOLERANCE,
    Series,
    characteristic,
    determinant,
    digits,
    divided,
    hidden,
    multiply,
    observability_rows,
    plus,
    rank_of,
    transposed,
)
from tests.support.derivations import World

if TYPE_CHECKING:
    from collections.abc import Callable

    from symobs.exact import Matrix, Scalar
    from tests.support.algebra import Rows
    from tests.support.claims.claims import Setting

#: Taylor coefficients that are compared: more than the differential equations of both sides have orders.
_COUNT = 14
#: Gauss-Legendre's rule of this degree is exact to far more digits than are asked for here.
_DEGREE, _FEWER = 4, CONTEXT.mpf(10) ** -20


def world_at(result: Any, at: Setting) -> World:
    return World(0, result.plant.variable, result.plant.symbols.signs, meanings=dict(at.point))


def table(rows: Any) -> Any:
    """Return rows of numbers as a matrix of mpmath."""
    return CONTEXT.matrix([[digits(getattr(entry, "parts", [entry])[0]) for entry in row] for row in rows])


def near(left: Any, right: Any, tolerance: Any = TOLERANCE) -> bool:
    size = max([1, *map(abs, left), *map(abs, right)])
    return bool(max(map(abs, left - right)) <= tolerance * size)


def gramian_of(A: Any, Q: Any, end: Any) -> Any:
    """Return the integral of e^{Aᵀt} Q e^{At} from 0 to an end."""
    n = A.rows
    whole = CONTEXT.matrix(2 * n)
    whole[:n, :n], whole[:n, n:], whole[n:, n:] = -A.T, Q, A
    flow = CONTEXT.expm(whole * end)
    return flow[n:, n:].T * flow[:n, n:]


def same_kernel(vectors: Any, rows: Rows, world: World) -> bool:
    """Whether vectors are a basis of the kernel."""
    found = [[world.value(entry) for entry in vector] for vector in vectors]
    unseen = not found or not any(map(any, multiply(rows, transposed(found))))
    return unseen and len(found) == (rank_of(found) if found else 0) == len(rows[0]) - rank_of(rows)


def exponential_holds(result: Any, at: Setting) -> None:
    """Hold Φ to mpmath's exponential of A t; all of it is real."""
    world = world_at(result, at)
    if result.fields["matrix"] is None:
        assert result.fields["question"]
        return
    found = table(world.value(result.fields["matrix"]))
    assert near(found, CONTEXT.expm(table(at.A) * digits(world.number("t"))))
    assert all(isinstance(entry, CONTEXT.mpf) for entry in found)


def gramian_holds(result: Any, at: Setting) -> None:
    world, horizon = world_at(result, at), result.answer["horizon"]
    A, C = at.pair(dual=result.answer["of"] == "controllability")
    O = observability_rows(A, C)
    assert world.value(result.fields["finite_sum"]) == multiply(transposed(O), O)
    assert result.fields["rank"] == rank_of(O)
    assert same_kernel(result.fields["kernel"], O, world)
    if result.fields["matrix"] is None:
        assert result.verdict == "undecided" or not _decays(A, C, at)
        return
    W, square = world.value(result.fields["matrix"]), multiply(transposed(C), C)
    if horizon == "inf":
        moved = multiply(transposed(A), W)
        image = multiply(moved, A) if at.discrete else moved
        other = W if at.discrete else multiply(W, A)
        sign = -1 if at.discrete else 1
        assert all(image[i][j] + sign * other[i][j] + square[i][j] == 0 for i in range(len(A)) for j in range(len(A)))
        assert _decays(A, C, at)
    elif at.discrete:
        rows = observability_rows_of(A, C, int(horizon.fraction()))
        assert multiply(transposed(rows), rows) == W
    else:
        assert near(table(W), gramian_of(table(A), table(square), digits_of(world, horizon)))
    if result.fields["determinant"] is not None:
        product = digits_in(determinant(W))
        difference = digits_of(world, result.fields["determinant"]) - product
        assert abs(difference) <= _FEWER * (1 + abs(product))


def observability_rows_of(A: Rows, C: Rows, steps: int) -> Rows:
    """Return [C; CA; …] with as many blocks as there are steps."""
    found, rows = [], C
    for _ in range(steps):
        found += rows
        rows = multiply(rows, A)
    return found


def _decays(A: Rows, C: Rows, at: Setting) -> bool:
    """Whether what the output sees decays."""
    whole = characteristic(A)
    is_observable = rank_of(observability_rows(A, C)) == len(A)
    return at.is_stable(whole if is_observable else divided(whole, hidden(A, C))[0])


def digits_in(value: Any) -> Any:
    return digits(getattr(value, "parts", [value])[0])


def digits_of(world: World, value: Scalar) -> Any:
    return digits_in(world.value(value))


def taylor(world: World, value: Matrix, start: Fraction) -> list[Rows]:
    """Return the Taylor coefficients of a matrix of functions of t at an instant, one table each."""
    moving = world.at("t", Series.moving(start, _COUNT)).value(value)
    entries = [[_parts(entry) for entry in row] for row in moving]
    return [[[entry[k] for entry in row] for row in entries] for k in range(_COUNT)]


def _parts(value: Any) -> list[Any]:
    parts = value.parts if isinstance(value, Series) else [value]
    return [Series.make([part]) for part in (*parts, *([Fraction(0)] * (_COUNT - len(parts))))]


def motion(world: World, result: Any, x0: Rows, driven: Matrix | None, start: Fraction) -> list[Rows]:
    """Return the Taylor coefficients of C x + D u for ẋ = A x + B u from x₀."""
    m = result.plant.matrices
    A, B, C, D = (taylor(world, matrix, start) for matrix in (m.A, m.B, m.C, m.D))
    u = None if driven is None else taylor(world, driven, start)
    x, y = [x0], []
    for k in range(_COUNT):
        y.append(_convolved(C, x, k))
        rate = _convolved(A, x, k)
        if u is not None:
            y[k] = plus(y[k], _convolved(D, u, k))
            rate = plus(rate, _convolved(B, u, k))
        x.append([[entry / Fraction(k + 1) for entry in row] for row in rate])
    return y


def _convolved(left: list[Rows], right: list[Rows], k: int) -> Rows:
    total = multiply(left[0], right[k])
    for i in range(1, k + 1):
        total = plus(total, multiply(left[i], right[k - i]))
    return total


def explains(result: Any, world: World, x0: Any, data: tuple[Matrix, Matrix | None], start: Fraction) -> bool:
    """Whether the motion from a state has the output that was given."""
    column = [[world.value(entry)] for entry in x0]
    return motion(world, result, column, data[1], start) == taylor(world, data[0], start)


def nothing_explains(result: Any, world: World, data: tuple[Matrix, Matrix | None], start: Fraction) -> bool:
    """Whether the linear equations for x₀ contradict each other."""
    order = result.plant.order
    zero = [[Fraction(0)] for _ in range(order)]
    rest = motion(world, result, zero, data[1], start)
    right = [row for a, b in zip(taylor(world, data[0], start), rest, strict=True) for row in plus(a, _times(b, -1))]
    columns = [
        motion(world, result, [[Fraction(int(i == j))] for i in range(order)], None, start) for j in range(order)
    ]
    left = [[column[k][i][0] for column in columns] for k in range(_COUNT) for i in range(len(columns[0][0]))]
    return rank_of([row + wanted for row, wanted in zip(left, right, strict=True)]) > rank_of(left)


def _times(rows: Rows, factor: int) -> Rows:
    return [[entry * Fraction(factor) for entry in row] for row in rows]


def initial_state_holds(result: Any, at: Setting) -> None:
    """Hold x₀ to the output by Taylor coefficients; where there is none, the equations for it contradict each other."""
    world, x0 = world_at(result, at), result.fields["x0"]
    assert same_kernel(result.fields["kernel"], observability_rows(at.A, at.C), world)
    data = result.answer["output"], result.answer["input"]
    if x0 is not None:
        assert explains(result, world, x0, data, Fraction(0))
    else:
        assert result.verdict == "undecided" or nothing_explains(result, world, data, Fraction(0))


def covariance_holds(result: Any, at: Setting) -> None:
    """Hold the parts to W⁻¹ ∫ e^{Aᵀt} Cᵀ R C e^{At} dt W⁻¹ and W⁻¹ ∫ V Q Vᵀ dt W⁻¹ with V(s) = e^{Aᵀs} W(T − s) B."""
    world = world_at(result, at)
    if result.fields["covariance"] is None:
        assert result.verdict == "undecided" or rank_of(observability_rows(at.A, at.C)) < len(at.A)
        return
    A, B, C, R = (table(rows) for rows in (at.A, at.B, at.C, world.value(result.answer["R"])))
    end = digits_of(world, result.answer["horizon"])
    inverse = gramian_of(A, C.T * C, end) ** -1
    total = inverse * gramian_of(A, C.T * R * C, end) * inverse
    assert near(table(world.value(result.fields["output_part"])), total, _FEWER)
    if result.answer["Q"] is not None:
        Q = table(world.value(result.answer["Q"]))

        def driven(s: Any) -> Any:
            V = CONTEXT.expm(A * s).T * gramian_of(A, C.T * C, end - s) * B
            return V * Q * V.T

        part = inverse * _integral(driven, end, A.rows, CONTEXT.mnorm(A)) * inverse
        assert near(table(world.value(result.fields["input_part"])), part, _FEWER)
        total = total + part
    assert near(table(world.value(result.fields["covariance"])), total, _FEWER)


@cache
def _rule() -> list[tuple[Any, Any]]:
    return list(GaussLegendre(CONTEXT).calc_nodes(_DEGREE, CONTEXT.prec))


def _integral(f: Callable[[Any], Any], end: Any, order: int, rate: Any = 0) -> Any:
    """The integral from 0 to the end, in pieces on which what changes at this rate does not change much."""
    total, pieces = CONTEXT.matrix(order), 1 + int(rate * end / 4)
    width = end / pieces
    for piece in range(pieces):
        for node, weight in _rule():
            total += f(width * (piece + (node + 1) / 2)) * (weight * width / 2)
    return total


def stack_holds(result: Any, at: Setting) -> None:
    """Hold N₀, N₁, … to derivatives, the rank at the point, Φ to its equation, the Gramian to quadrature, x₀ to the output.

    At single instants the rank is smaller, so the time is one of many at random, whatever the point says.
    """
    world, m, fields = world_at(result, at), result.plant.matrices, result.fields
    for place, name in enumerate(("t", "t0", "t1")):  # near each other: quadrature is of exponentials
        if name == "t" or name not in at.point:
            world = world.at(name, (World(0, "", {"t": "positive"}).number("t") + place) / 16)
    expected: Any = None
    rows: Rows = []
    for k, block in enumerate(fields["stack"]):
        found = world.value(block)
        assert found == (world.value(m.C) if k == 0 else expected)
        expected = plus(multiply(found, world.value(m.A)), world.derivative(Literal(block), "t"))
        rows += found
    assert rank_of(rows) == fields["rank"]
    if "t" not in m.symbols:
        assert rows == observability_rows(at.A, at.C)
    if "transition_matrix" in fields:
        _transition_holds(result, world)


def _transition_holds(result: Any, world: World) -> None:
    Phi, m, asked, order = (
        result.fields["transition_matrix"],
        result.plant.matrices,
        result.asked_for,
        result.plant.order,
    )
    assert world.derivative(Literal(Phi), "t") == multiply(world.value(m.A), world.value(Phi))
    unit = [[Fraction(int(i == j)) for j in range(order)] for i in range(order)]
    assert world.at("t", world.number("t0")).value(Phi) == unit
    start, end = (world.scalar(value) for value in (asked.start, asked.end))

    def seen(instant: Fraction) -> Rows:
        there = world.at("t0", start).at("t", instant)
        return multiply(there.value(m.C), there.value(Phi))

    vectors = [[world.value(entry) for entry in vector] for vector in result.fields["kernel"]]
    assert len(vectors) == order - result.fields["rank"] == (rank_of(vectors) if vectors else 0)
    assert not vectors or not any(map(any, multiply(seen(world.number("t")), transposed(vectors))))
    if "gramian" in result.fields:

        def integrand(instant: Any) -> Any:
            row = table(seen(start + Series.make([instant])))
            return row.T * row

        found = _integral(integrand, digits(end - start), order)
        W = world.value(result.fields["gramian"])
        assert near(table(W), found, _FEWER)
        product = digits_in(determinant(W))
        assert abs(digits_of(world, result.fields["determinant"]) - product) <= _FEWER * (1 + abs(product))
    data = asked.output, asked.input
    if asked.output is not None and result.fields["x0"] is not None:
        assert explains(result, world, result.fields["x0"], data, start)
    elif asked.output is not None and result.answer["candidate"] is not None:
        assert nothing_explains(result, world, data, start)


def response_holds(result: Any, at: Setting) -> None:
    """Hold the Taylor coefficients of state and output to x' = A x + B u, x(0) = x0 and y = C x + D u."""
    world, start = world_at(result, at), Fraction(0)
    if result.fields["state"] is None:
        assert result.fields["question"]
        return
    x, x0, u = taylor(world, result.fields["state"], start), result.answer["initial"], result.answer["input"]
    m = result.plant.matrices
    A, B = taylor(world, m.A, start), taylor(world, m.B, start)
    driven = None if u is None else taylor(world, u, start)
    begins = taylor(world, x0, start)[0]
    if result.answer["impulse"] is not None:
        begins = plus(begins, multiply(B[0], taylor(world, result.answer["impulse"], start)[0]))
    assert x[0] == begins
    for k in range(_COUNT - 1):
        rate = _convolved(A, x, k)
        rate = rate if driven is None else plus(rate, _convolved(B, driven, k))
        assert [[entry * Fraction(k + 1) for entry in row] for row in x[k + 1]] == rate
    if result.fields["output"] is not None:
        assert motion(world, result, x[0], u, start) == taylor(world, result.fields["output"], start)


def rule_holds(result: Any, at: Setting) -> None:
    """Hold C_d (zI − A_d)⁻¹ B_d + D_d, or F(z), to the transfer function at what s is replaced by."""
    world = world_at(result, at)
    T, z = digits_of(world, result.period), CONTEXT.mpc("0.3", "1.7")
    rules = {"forward": (z - 1) / T, "backward": (z - 1) / (T * z), "tustin": 2 / T * (z - 1) / (z + 1)}
    s = rules[result.rule]
    if hasattr(result, "written"):
        F = result.written.value
        above, below = (
            [digits_of(world, c) for c in part.coefficients(result.written.variable)]
            for part in (F.numerator, F.denominator)
        )
        told = result.answer["transfer_function"]
        mine = [[digits_of(world, c) for c in part.coefficients("z")] for part in (told.numerator, told.denominator)]
        left, right = CONTEXT.polyval(mine[0], z), CONTEXT.polyval(above, s) / CONTEXT.polyval(below, s)
        assert near(CONTEXT.matrix([left / CONTEXT.polyval(mine[1], z)]), CONTEXT.matrix([right]))
        return
    A, B = table(at.A), table(at.B)
    C, D = (table(at.C), table(at.D)) if result.fields["C"] is not None else (CONTEXT.eye(A.rows), 0)
    A_d, B_d = table(world.value(result.fields["A"])), table(world.value(result.fields["B"]))
    if result.fields["C"] is None:
        return
    C_d, D_d = table(world.value(result.fields["C"])), table(world.value(result.fields["D"]))
    sampled = C_d * CONTEXT.inverse(z * CONTEXT.eye(A.rows) - A_d) * B_d + D_d
    assert near(sampled, C * CONTEXT.inverse(s * CONTEXT.eye(A.rows) - A) * B + D)


def zero_order_hold_holds(result: Any, at: Setting) -> None:
    """Hold both matrices to mpmath's exponential of [A B; 0 0] T, which is [A_d B_d; 0 I]."""
    if hasattr(result, "rule"):
        rule_holds(result, at)
        return
    world = world_at(result, at)
    if result.fields["A"] is None:
        assert result.fields["question"]
        return
    A, B = table(at.A), table(at.B)
    whole = CONTEXT.matrix(A.rows + B.cols)
    whole[: A.rows, : A.rows], whole[: A.rows, A.rows :] = A, B
    flow = CONTEXT.expm(whole * digits_of(world, result.answer["horizon"]))
    assert near(table(world.value(result.fields["A"])), flow[: A.rows, : A.rows])
    assert near(table(world.value(result.fields["B"])), flow[: A.rows, A.rows :])


FUNCTIONS_OF_TIME: dict[str, Callable[[Any, Setting], None]] = {
    "matrix_exponential": exponential_holds,
    "gramian": gramian_holds,
    "response": response_holds,
    "zero_order_hold": zero_order_hold_holds,
    "initial_state": initial_state_holds,
    "initial_state_covariance": covariance_holds,
    "time_varying_observability": stack_holds,
}
