"""Answers that are right in many ways: compensators without gains, and what is right in coordinates of the student's choice.

For the coordinates that the student took a result of the task's own type is made; what it claims decides, and the
other values of the student are compared with those that it has there.
"""

from __future__ import annotations

from contextlib import suppress
from dataclasses import replace
from itertools import product
from typing import TYPE_CHECKING, Any

from symobs.exact import Matrix, Scalar, kernel
from symobs.exact.linear_algebra.transfer_function import pole_and_zero_polynomial
from symobs.ground.errors import CertificateRejected
from symobs.tasks.analysis.rank.rank_test import power_rows
from symobs.tasks.analysis.realization.canonical_form import CanonicalForm
from symobs.tasks.analysis.realization.kalman_decomposition import Decomposition
from symobs.tasks.design.compensator.output_feedback import OutputFeedback
from symobs.tasks.design.reduced_order.reduced_order_observer import ReducedOrderObserver
from symobs.tasks.result.answers import named_found

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from symobs.tasks.result import Result


def closes_the_loop(result: Result, F: Matrix | Scalar | None) -> bool:
    """Return whether det(sI − A) · (poles of F) · det(I + PF) = φ_c φ_o, F proper and of no larger order than the observer."""
    if not isinstance(result, OutputFeedback):
        return False
    variable = result.plant.variable
    matrix = Matrix.of([[F]]) if isinstance(F, Scalar) else F
    assert isinstance(matrix, Matrix)  # noqa: S101 - the right F exists, and is read like it
    P = result.plant_function
    plant = P if isinstance(P, Matrix) else Matrix.of([[P]])
    if matrix.shape != (result.plant.inputs, result.plant.outputs):
        return False
    if any(entry.numerator.degree(variable) > entry.denominator.degree(variable) for entry in matrix.entries):
        return False
    poles, _ = pole_and_zero_polynomial(matrix, variable)
    if poles.degree(variable) > result.own_matrix.shape[0]:
        return False
    chi = result.plant.matrices.A.characteristic_polynomial(variable)
    loop = (Matrix.identity(plant.shape[0]) + plant @ matrix).determinant()
    return bool(chi * poles * loop == result.loop_polynomial.value)


# -- coordinates ---------------------------------------------------------------------------------------------------------


#: Orders up to which the coordinates of a modal form without T are looked for: they are the square of it in unknowns.
_MOST_STATES = 8
#: A result in the coordinates of an answer, and what is said of them.
Found = tuple["Result", str]


def in_coordinates(result: Result, given: Mapping[str, Matrix]) -> Iterator[Found]:
    """Yield results of the same task in coordinates that may be those of the given matrices, the likeliest first."""
    if isinstance(result, ReducedOrderObserver):
        yield from _reduced(result, given)
    elif isinstance(result, CanonicalForm):
        yield from _canonical(result, given)
    elif isinstance(result, Decomposition) and (T := given.get("T")) is not None:
        for matrix, said in _both_directions(T, result.plant.order):
            with suppress(CertificateRejected):
                there = replace(result, answer={**result.answer, **_moved(result, matrix)})
                yield Replaced(there, {"T": T}), said  # type: ignore[misc]


def _both_directions(T: Matrix, order: int) -> Iterator[tuple[Matrix, str]]:
    """Yield T, and T⁻¹ with what is to be said of it, where T is regular."""
    if T.shape == (order, order) and not T.determinant().is_zero:
        yield T, ""
        yield T.inverse().normal(), "you gave T^-1: here the new state is T x"


def _moved(result: Result, T: Matrix) -> dict[str, Any]:
    """Return the plant in the coordinates T x."""
    m, S = result.plant.matrices, T.inverse().normal()
    return {
        "T": T,
        "inverse": S,
        "A": (T @ m.A @ S).normal(),
        "B": (T @ m.B).normal(),
        "C": (m.C @ S).normal(),
    }


# -- canonical forms --------------------------------------------------------------------------------------------------


def _canonical(result: CanonicalForm, given: Mapping[str, Matrix]) -> Iterator[Found]:
    """Yield the form in the four layouts in use; the modal form in the order and scaling of the given matrices."""
    own, form = result.answer["T"], result.answer["A"]
    if own is None or form is None:
        return
    if result.kind == "modal":
        if "T" not in given:
            for wrong in (None, *"CBA"):  # one of the matrices may be wrong, and the others right together
                T = _modal_coordinates(result, {name: value for name, value in given.items() if name != wrong})
                if T is not None:
                    yield Replaced(result, _moved(result, T)), ""  # type: ignore[misc]
            return
        for T, said in _both_directions(given["T"], result.plant.order):
            moved = _moved(result, T)
            if _same_blocks(moved["A"], form):
                yield Replaced(result, {**moved, "T": given["T"]}), said  # type: ignore[misc]
        return
    for turn, layout in _layouts(result, form):
        T = (turn @ own).normal()
        moved = _moved(result, T)
        yield Replaced(result, moved), layout  # type: ignore[misc]
        if "T" in given and given["T"] == T.inverse():
            inverse = f"{layout}; " if layout else ""
            yield Replaced(result, {**moved, "T": given["T"]}), f"{inverse}you gave T^-1: here the new state is T x"  # type: ignore[misc]


def _modal_coordinates(result: CanonicalForm, given: Mapping[str, Matrix]) -> Matrix | None:
    """Return a regular T with T A = Ā T, T B = B̄ and C̄ T = C for the matrices given of a modal form; None without one.

    With a last unknown beside the entries of T the equations are homogeneous: a T is a solution in which it is 1.
    """
    m, n, answer = result.plant.matrices, result.plant.order, result.answer
    right = named_found({"A": answer["A"], "B": answer["B"], "C": answer["C"]})
    form = given.get("A", right["A"])
    sizes = all(value.shape == right[name].shape for name, value in given.items() if name in {"A", "B", "C"})
    if n > _MOST_STATES or not sizes or not _same_blocks(form, right["A"]):
        return None
    one, rows = Matrix.identity(n), []
    for i, j in product(range(n), range(n)):
        unit = one.select(range(n), [i]) @ one.select([j], range(n))
        found = [unit @ m.A - form @ unit]
        found += [unit @ m.B] if "B" in given else []
        found += [(given["C"] @ unit).T] if "C" in given else []
        rows.append([entry for each in found for entry in each.entries])
    last = [Scalar.of(0)] * (n * n)
    last += [-entry for entry in given["B"].entries] if "B" in given else []
    last += [-entry for entry in m.C.T.entries] if "C" in given else []
    solutions = kernel(Matrix.of([*rows, last]).T)
    for step in (1, 3):  # a sum with other weights, where the first one happens to be singular
        weights = Matrix.column([1 + step * k * k for k in range(solutions.shape[1])])
        entries = (solutions @ weights).entries if solutions.shape[1] else ()
        if not entries or entries[-1].is_zero:
            return None
        T = Matrix.of([[entries[i * n + j] / entries[-1] for j in range(n)] for i in range(n)])
        if not T.determinant().is_zero:
            return T
    return None


class Replaced:
    """A result with some fields in place of its own: those of other coordinates, or what follows from wrong parts."""

    def __init__(self, result: Result, moved: Mapping[str, Any]) -> None:
        self.result = result
        self.fields = {**result.fields, **moved}
        self.claimed = tuple(name for name in result.claimed if name not in moved)

    def __getattr__(self, name: str) -> Any:
        return getattr(self.result, name)


def _layouts(result: CanonicalForm, A: Matrix) -> Iterator[tuple[Matrix, str]]:
    """Yield the changes of coordinates to the layouts in use: χ in the last or first row, or in the last or first column."""
    n, one = result.plant.order, Matrix.identity(result.plant.order)
    is_controllable = result.kind == "controllable"
    names = ("row", "column") if is_controllable else ("column", "row")
    reverse = Matrix.of([[int(i + j == n - 1) for j in range(n)] for i in range(n)])
    yield one, ""
    yield reverse, f"the coefficients stand in the first {names[0]} here"
    B, C = result.answer["B"], result.answer["C"]
    if is_controllable and B is not None:
        other = power_rows(A.T, B.T).T.inverse().normal()
    elif C is not None:
        other = power_rows(A, C)
    else:
        return
    yield other, f"the coefficients stand in the last {names[1]} here"
    yield reverse @ other, f"the coefficients stand in the first {names[1]} here"


def _same_blocks(found: Matrix, right: Matrix) -> bool:
    """Return whether a matrix consists of the same diagonal blocks in some order; blocks of order 2 may be transposed."""
    mine, theirs = _blocks(found), _blocks(right)
    for block in mine:
        match = block if block in theirs or block.shape[0] > 2 else block.T
        if match not in theirs:
            return False
        theirs.remove(match)
    return True


def _blocks(matrix: Matrix) -> list[Matrix]:
    """Return the diagonal blocks of a matrix, as fine as neighbours allow."""
    found, inside, outside = [], [], list(range(matrix.shape[0]))
    while outside:
        inside.append(outside.pop(0))
        if matrix.select(inside, outside).is_zero and matrix.select(outside, inside).is_zero:
            found.append(matrix.select(inside, inside))
            inside = []
    return found


# -- observers of reduced order ---------------------------------------------------------------------------------------


def _reduced(result: ReducedOrderObserver, given: Mapping[str, Matrix]) -> Iterator[Found]:
    """Yield the observer whose state is the estimate of P x; P are the lower rows of M⁻¹, or solve P A − F P = H C."""
    plant, n, p = result.plant, result.plant.order, result.plant.outputs
    M = given.get("M")
    if M is not None and M.shape == (n, n) and not M.determinant().is_zero:
        P = M.inverse().normal().select(range(p, n), range(n))
    elif {"F", "H"} <= given.keys():
        solved = _estimated(result, given["F"], given["H"])
        if solved is None:
            return
        P = solved
    else:
        return
    T = Matrix.block([[plant.matrices.C], [P]])
    if T.determinant().is_zero:
        return
    try:
        there = ReducedOrderObserver.of(plant, result.desired, T, result.method)
        inner = there.inner.with_answer("L", Matrix.zeros(n - p, p))
        yield type(result).assembled(plant, inner, result.desired, T, result.method), ""
    except CertificateRejected:
        return


def _estimated(result: ReducedOrderObserver, F: Matrix, H: Matrix) -> Matrix | None:
    """Return P of P A − F P = H C, None where the sizes do not fit or it is not the only one."""
    A, C = result.plant.matrices.A, result.plant.matrices.C
    n, p = result.plant.order, result.plant.outputs
    r = n - p
    if F.shape != (r, r) or H.shape != (r, p):
        return None
    right = H @ C
    rows = []
    for i in range(r):
        for j in range(n):
            row = [Scalar.of(0)] * (r * n)
            for k in range(n):
                row[i * n + k] = row[i * n + k] + A[k, j]
            for k in range(r):
                row[k * n + j] = row[k * n + j] - F[i, k]
            rows.append(row)
    system = Matrix.of(rows)
    if system.determinant().is_zero:
        return None
    found = system.solve(Matrix.column([right[i, j] for i in range(r) for j in range(n)]))
    return Matrix.of([[found[i * n + j, 0] for j in range(n)] for i in range(r)])
