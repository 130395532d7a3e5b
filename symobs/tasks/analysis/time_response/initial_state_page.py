"""The page of the initial state: free output, forced output, moments, solution, check."""

from __future__ import annotations

from math import factorial
from typing import TYPE_CHECKING, Any

from symobs.exact import Matrix, Scalar
from symobs.exact.core.generators import substitute
from symobs.exact.time_functions.quasipolynomial import determinant, table_of
from symobs.formula.tree import Evaluated, Literal
from symobs.formula.tree.calculus import since_start
from symobs.formula.tree.term import block
from symobs.proof.derivation.builder import relation
from symobs.system.conditions import never_zero
from symobs.tasks.analysis.time_response.damping_cases import rate_of
from symobs.tasks.analysis.time_response.horizons import INFINITE
from symobs.tasks.analysis.time_response.initial_state import InitialState
from symobs.tasks.analysis.time_response.matrix_exponential import (
    closed_form,
    tell_exponential,
    tell_polynomial,
    tell_question,
)
from symobs.tasks.result import page_of

if TYPE_CHECKING:
    from symobs.formula.tree.term import Term
    from symobs.proof.derivation.builder import Builder

#: The order of det W(T) grows like the square of the number of states, and so does the search for it.
_WARNED_UP_TO = 3


@page_of(InitialState)
def write_initial_state(page: Builder, result: InitialState) -> None:
    """Write the document's five steps."""
    values = list(result.everything())
    if result.answer["horizon"] != INFINITE:
        values += [substitute(value, {"t": result.answer["horizon"]}) for value in values]
    page.in_time(*values)
    result.state_data(page)
    with page.section("initial_state"):
        tell_polynomial(page)
        result.write_branches(page, _write_branch)


def _write_branch(page: Builder, result: InitialState) -> None:
    """Write one branch."""
    answer = result.answer
    if answer.get("question") is not None:
        tell_question(page, answer["factor"])
        return
    found, _ = closed_form(result.plant, {**answer["taken"], **answer["chosen"]})
    tell_exponential(page, found, answer["exponential"])
    y = page.set("y_t", answer["output"])
    data = [relation(y, _entry(answer["output"]))]
    if answer["input"] is not None:
        u = page.set("u_t", answer["input"])
        data.append(relation(u, _entry(answer["input"])))
    page.equal(*data, say="measured")
    free = _tell_forced(result, page)
    if answer["x0"] is None:
        _tell_refusal(result, page, free)
        return
    _tell_moments(result, page, free)


def _entry(matrix: Matrix) -> Matrix | Scalar:
    """Return the entry of a 1×1 matrix, else the matrix."""
    return matrix[0, 0] if matrix.shape == (1, 1) else matrix


def _tell_forced(result: InitialState, page: Builder) -> Term:
    """Write the motion from rest and ỹ; return ỹ."""
    answer, A, C, y = result.answer, page["A"], page["C"], page["y_t"]
    if answer["input"] is None:
        page.equal(relation(C @ page["exp_At"], (C @ page["exp_At"]).as_value), say="output_of_exponential")
        page.set("y_0", answer["output"])
        return y
    x_f = page.define("x_f", answer["forced"], say="output_forced", closing=False)
    moved = y - C @ x_f
    if result.plant.matrices.has_feedthrough:
        moved = moved - page["D"] @ page["u_t"]
    equation = relation(rate_of(x_f), A @ x_f + page["B"] @ page["u_t"])
    start = relation(x_f.at("t", 0), Matrix.zeros(result.plant.order, 1))
    page.conclude_silently(start)
    told: dict[str, Any] = {"say": "output_solution", "equation": equation}
    if answer["forced"].is_zero:
        page.conclude_silently(equation)
        told = {"say": "output_at_rest"}
    return page.define("y_0", moved, _entry(answer["free"]), closing=False, **told)


def _tell_moments(result: InitialState, page: Builder, free: Term) -> None:
    answer = result.answer
    C, Phi, horizon = page["C"], page["exp_At"], answer["horizon"]
    end = {"t": horizon}
    x0: Matrix = answer["x0"]
    if not result.is_unique:
        page.define("x_0", x0, say="initial_not_unique", answer=True, closing=False)
        N = answer["rank"]["kernel"]
        say = "initial_kernel" if N.shape[1] == 1 else "initial_kernel_several"
        page.equal(relation(C @ Phi @ page["x_0"], free), say=say)
        for j in range(N.shape[1]):
            v = page.value(N.select(range(N.shape[0]), [j]))
            page.equal(relation(C @ Phi @ v, _entry(Matrix.zeros(C.value.shape[0], 1))))
        return
    gramian = since_start((Phi.T @ C.T @ C @ Phi).formula, Literal(answer["gramian_function"]), horizon)
    right = since_start((Phi.T @ C.T @ free).formula, Literal(answer["moment_function"]), horizon)
    W = page.define("W", page.term(gramian), substitute(answer["gramian_function"], end), say="moments", closing=False)
    r = page.define(
        "r_0", page.term(right), substitute(answer["moment_function"], end), say="moments_right", closing=False
    )
    page.define("x_0", x0, say="initial_found", answer=True, closing=False)
    page.verified(
        "initial_checked",
        moments=relation(W @ page["x_0"], r),
        output=relation(C @ Phi @ page["x_0"], free),
    )
    _warn_of_short_horizons(result, page)


def _warn_of_short_horizons(result: InitialState, page: Builder) -> None:
    """Say how fast det W(T) vanishes as T → 0, by its Taylor polynomial there; W(t) is held to its derivative and start.

    Of order Tⁿ it is where W itself is nearly T CᵀC with C of full rank: no reason to warn.
    """
    if result.plant.order > _WARNED_UP_TO:
        return
    function = result.answer["gramian_function"]
    rates = [determinant(table_of(function))]
    while rates[-1].at_zero.is_zero:
        rates.append(rates[-1].derivative())
    power, last = len(rates) - 1, rates[-1].at_zero
    if power == result.plant.order or not never_zero(last, page.plant.symbols.signs):
        return
    C, Phi, end = page["C"], page["exp_At"], Scalar.symbol("T")
    W = page.set("W_t", function)
    start = relation(W.at("t", 0), Matrix.zeros(*function.shape))
    page.conclude_silently(relation(rate_of(W), Phi.T @ C.T @ C @ Phi), start)
    det = page.set("det_W", function.determinant())
    page.conclude_silently(relation(det, W.apply("det")))
    taylor = det.at("t", 0)
    for k in range(1, power + 1):
        det = rate_of(det)
        taylor = taylor + det.at("t", 0) * (end**k / factorial(k))
    leading = page.value(last * end**power / factorial(power))
    page.caution("short_horizon", leading=Evaluated(taylor.formula, leading.formula))


def _tell_refusal(result: InitialState, page: Builder, free: Term) -> None:
    """Show the candidate and what its output leaves, or the row that refutes the data."""
    answer, C, Phi = result.answer, page["C"], page["exp_At"]
    rates = [free]
    for _ in range(result.plant.order - 1):
        rates.append(rate_of(rates[-1]))
    if "candidate" in answer:
        x0 = page.define("x_0", answer["candidate"], say="initial_candidate", closing=False, free=free)
        rest = relation(free - C @ Phi @ x0, _entry(answer["rest"]), "!==", _entry(answer["rest"] * 0))
        page.remark("initial_refused", rest=rest)
        return
    page.set("O", answer["rank"]["matrix"])
    w, start = page.set("v", answer["row"].T), page.set("r_0", answer["start"])
    at_zero = block([[rate.at("t", 0)] for rate in rates])
    zero = relation(w.T @ page["O"], Matrix.zeros(1, result.plant.order))
    page.equal(relation(start, at_zero, answer["start"]), say="initial_start")
    rest = relation(page["v"].T @ start, (page["v"].T @ start).as_value, "!==", 0)
    page.remark("initial_inconsistent", row=relation(w, answer["row"].T), zero=zero, rest=rest)
