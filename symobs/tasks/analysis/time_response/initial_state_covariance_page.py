"""The page of the covariance of the initial state."""

from __future__ import annotations

from typing import TYPE_CHECKING

from symobs.exact import Matrix, Scalar
from symobs.exact.core.generators import derivative, substitute
from symobs.formula.tree import Literal, Power
from symobs.formula.tree.calculus import since_start
from symobs.proof.derivation.builder import relation
from symobs.system.conditions import never_zero
from symobs.tasks.analysis.time_response.initial_state_covariance import InitialStateCovariance
from symobs.tasks.analysis.time_response.matrix_exponential import (
    closed_form,
    tell_exponential,
    tell_polynomial,
    tell_question,
)
from symobs.tasks.result import page_of

if TYPE_CHECKING:
    from symobs.proof.derivation.builder import Builder


@page_of(InitialStateCovariance)
def write_covariance(page: Builder, result: InitialStateCovariance) -> None:
    """Write e^{At}, the Gramian, the two integrals, the covariance and the best horizon."""
    values = list(result.everything())
    page.in_time(*values, *(substitute(value, {"t": result.answer["horizon"]}) for value in values))
    result.state_data(page)
    with page.section("covariance"):
        if result.answer["called_t"]:
            page.remark("horizon_called_t")
        if result.verdict != "no":
            page.remark("estimator_with_input" if result.plant.matrices.has_input else "estimator")
            _tell_noise(result, page)
        tell_polynomial(page)
        result.write_branches(page, _write_branch)


def _write_branch(page: Builder, result: InitialStateCovariance) -> None:
    """Write one branch: noise, Gramian, the two integrals, the parts, the sum."""
    answer = result.answer
    if result.verdict == "no":
        tell_unobservable(result, page)
        return
    if answer.get("question") is not None:
        if answer["factor"] is None:
            page.remark("inverse_too_long")
        else:
            tell_question(page, answer["factor"])
        return
    found, _ = closed_form(result.plant, {**answer["taken"], **answer["chosen"]})
    tell_exponential(page, found, answer["exponential"])
    values = {name: _entry(value) for name, value in result.values_by_letter().items()}
    horizon = answer["horizon"]
    has_input = answer["Q"] is not None
    Phi, C, R = page["exp_At"], page["C"], page["R"]
    gramian = since_start((Phi.T @ C.T @ C @ Phi).formula, Literal(answer["gramian"]), horizon)
    W = page.define("W", page.term(gramian), values["W"], say="gramian_is", closing=False)
    noise = since_start((Phi.T @ C.T @ R @ C @ Phi).formula, Literal(answer["R_primitive"]), horizon)
    S_R = page.define(
        "S_R", page.term(noise), values["S_R"], say="estimate_is" if has_input else "estimate_of_output", closing=False
    )
    if has_input:
        page.set("Phi_m", values["Phi_m"])
        page.set("W_t", values["W_t"])
        page.conclude_silently(relation(page["Phi_m"] @ Phi, page.identity(result.plant.order)))
        V = page.define(
            "V_t", (W - page["W_t"]) @ page["Phi_m"] @ page["B"], values["V_t"], say="estimate_input", closing=False
        )
        driven = since_start((V @ page["Q"] @ V.T).formula, Literal(answer["Q_primitive"]), horizon)
        page.define("S_Q", page.term(driven), values["S_Q"], say="estimate_input_integral", closing=False)
    output = page.set("Cov_R", values["Cov_R"])
    page.conclude_silently(relation(W @ output @ W, S_R))
    page.equal(
        relation(output, W.inverse @ S_R @ W.inverse, values["Cov_R"]),
        say="parts_of_covariance" if has_input else "covariance_of_output",
    )
    total = output
    if has_input:
        part = page.set("Cov_Q", values["Cov_Q"])
        page.equal(relation(part, W.inverse @ page["S_Q"] @ W.inverse, values["Cov_Q"]), say="input_part")
        total = output + part
    page.define("Cov", total, values["Cov"], say="covariance_is", answer=True, closing=False)
    _tell_horizons(result, page)
    if has_input and any(result.answer["S_Q"].entries):
        page.remark("not_minimum_variance")


def _tell_noise(result: InitialStateCovariance, page: Builder) -> None:
    """Say what corrupts the data."""
    Q, R = result.answer["Q"], result.answer["R"]
    known = {name: _entry(value) for name, value in (("Q", Q), ("R", R)) if value is not None}
    given = [relation(page[name], page.set(name, value).as_value) for name, value in known.items()]
    page.equal(*given, say="noise_output_only" if Q is None else "noise")


def _entry(value: Matrix | Scalar) -> Matrix | Scalar:
    """Return the entry of a 1×1 matrix, which is written without brackets."""
    return value[0, 0] if isinstance(value, Matrix) and value.shape == (1, 1) else value


def tell_unobservable(result: InitialStateCovariance, page: Builder) -> None:
    """Say that there is no estimate."""
    rank = result.answer["rank"]
    page.set("O", rank["matrix"])
    found = relation(page["O"].apply("rank"), rank["rank"], "<", result.plant.order)
    page.conclude("no_observability", rank=found)


def _tell_horizons(result: InitialStateCovariance, page: Builder) -> None:
    """Say where each variance is stationary, with the derivative that vanishes there."""
    signs = {**result.plant.symbols.signs, "T": "positive"}
    covariance: Matrix = result.answer["covariance"]
    if any(text is not None for text in result.best_horizon):
        page.remark("horizon_tradeoff")
    for index, text in enumerate(result.best_horizon):
        if text is None:
            continue
        rate = derivative(covariance[index, index], "T")
        factor = next(f for f, _ in rate.numerator.factors()[1] if not never_zero(f, signs))
        lead, *rest = factor.coefficients("T")
        power = page.term(Power(Literal(Scalar.symbol("T")), len(rest)))
        bracket = power - page.value(-rest[-1] / lead)
        unit = page.value(Matrix.unit(result.plant.order, index))
        variance = page.set(f"var_{index + 1}", covariance[index, index])
        page.conclude_silently(relation(unit.T @ page["Cov"] @ unit, variance))
        front = page.value(rate / factor * lead)
        page.remark(
            "best_horizon",
            number=str(index + 1),
            variance=relation(variance, variance.value),
            rate=relation(variance.derivative_by("T"), front * bracket),
        )
