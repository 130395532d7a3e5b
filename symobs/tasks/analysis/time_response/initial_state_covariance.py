"""The covariance of the reconstructed initial state under white noise.

x̂₀ = W⁻¹ ∫ e^{Aᵀt} Cᵀ ỹ dt with W = W(T).  Output noise of intensity R contributes W⁻¹ ∫ e^{Aᵀt} Cᵀ R C e^{At} dt W⁻¹, input
noise of intensity Q contributes W⁻¹ ∫ V Q Vᵀ dt W⁻¹ with V(t) = e^{Aᵀt} W(T − t) B = (W(T) − W(t)) e^{−At} B.
"""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING, Any, ClassVar, Required, Self, TypedDict

from symobs.exact import Matrix, Scalar
from symobs.exact.core.generators import derivative, identities, roots_in, substitute
from symobs.exact.time_functions.matrix_exponential import NoClosedForm
from symobs.exact.time_functions.quasipolynomial import (
    Quasipolynomial,
    Table,
    determinant,
    integral,
    matrix_at,
    product,
    quasi_of,
    table_of,
    transposed,
)
from symobs.formula.tree import Literal, Power
from symobs.formula.tree.calculus import since_start
from symobs.formula.tree.term import Term, letter
from symobs.ground.dataclass import dataclass
from symobs.ground.errors import InputError
from symobs.proof.derivation.builder import relation
from symobs.system.conditions import Condition, never_zero, sign_of
from symobs.system.specification import read_symmetric
from symobs.tasks.analysis.rank.rank_page import tell_deficient
from symobs.tasks.analysis.rank.rank_test import rank_answer
from symobs.tasks.analysis.time_response.damping_cases import Signs, exponential_claims, from_zero, time_environment
from symobs.tasks.analysis.time_response.horizons import (
    OfTheInitialState,
    OfTheInitialStateAnswer,
    over_horizon,
    read_horizon,
    stationary,
)
from symobs.tasks.analysis.time_response.matrix_exponential import (
    TIME,
    closed_form,
    question_of,
    require_continuous,
    tell_exponential,
    tell_polynomial,
    tell_question,
)
from symobs.tasks.result import Result, choose, holds, method, page_of, task
from symobs.tasks.result.answers import named_found, those_found

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from symobs.formula.tree import Environment
    from symobs.proof.certificate.claims import Claim
    from symobs.proof.derivation.builder import Builder
    from symobs.system import StateSpace
    from symobs.system.specification import Horizon, Intensity, Name


#: Orders for which the inverse of a Gramian in closed form is still readable.
_MOST_STATES = 4
#: Gramians of more terms than this are not inverted.
_MOST_TERMS = 16
END = Scalar.symbol("T")


class CovarianceAsked(TypedDict):
    """The intensities Q (None: no input noise) and R, the horizon, and whether that is called t."""

    Q: Matrix | None
    R: Matrix
    horizon: Scalar
    called_t: bool


class CovarianceParts(TypedDict, total=False):
    """The covariance and its parts; W and the integrals S_R and S_Q, also as functions of t; e^{At}, e^{−At}, V(t)."""

    covariance: Required[Matrix | None]
    input_part: Matrix
    output_part: Matrix
    exponential: Matrix
    backwards: Matrix
    gramian: Matrix
    W: Matrix
    R_primitive: Matrix
    S_R: Matrix
    V: Matrix
    Q_primitive: Matrix
    S_Q: Matrix


class CovarianceAnswer(CovarianceAsked, CovarianceParts, OfTheInitialStateAnswer):
    """What is asked, the signs and the test of observability beside the parts."""


@dataclass
class InitialStateCovariance(OfTheInitialState):
    """Σ = Σ_R + Σ_Q with W Σ_R W = S_R and W Σ_Q W = S_Q, the two integrals checked by differentiation."""

    answer: CovarianceAnswer
    task: ClassVar[str] = "initial_state_covariance"
    answered_by = ("covariance",)
    only_value = ("covariance",)
    letters = {"covariance": "Cov", "input_part": "Cov_Q", "output_part": "Cov_R"}
    main: ClassVar[str] = "covariance"
    asked_for: ClassVar[tuple[str, ...]] = ("Q", "R", "horizon")

    @classmethod
    def of(cls, plant: StateSpace, method_name: str, asked: CovarianceAsked, taken: Signs) -> Self:
        """Return the result for a plant."""
        m = plant.matrices
        test = rank_answer(m.A, m.C)
        shared: CovarianceAnswer = {
            "Q": asked["Q"],
            "R": asked["R"],
            "horizon": asked["horizon"],
            "called_t": asked["called_t"],
            "rank": test,
            "taken": taken,
            "chosen": {},
            "covariance": None,
        }
        if test["rank"] < plant.order:
            return cls(plant, method_name, shared)
        if plant.order > _MOST_STATES:
            question = f"the inverse of the Gramian of {plant.order} states, more than {_MOST_STATES}"
            return cls(plant, method_name, {**shared, "question": question, "factor": None})
        try:
            found, chosen = closed_form(plant, taken)
        except NoClosedForm as error:
            return cls(plant, method_name, {**shared, "question": question_of(error), "factor": error.factor})
        if question := too_long(plant.matrices.A, plant.matrices.C, found.table()):
            return cls(plant, method_name, {**shared, "question": question, "factor": None, "chosen": chosen})
        return cls(plant, method_name, {**shared, "chosen": chosen, **_parts(plant, found.table(), asked)})

    @property
    def matrices(self) -> tuple[Matrix | Scalar, ...]:
        """The functions of time and of the horizon."""
        answer = self.answer
        parts = answer["covariance"], answer.get("input_part"), answer.get("output_part")
        ends = answer.get("W"), answer.get("S_R"), answer.get("S_Q"), answer.get("V")
        motions = answer.get("exponential"), answer.get("backwards"), answer.get("gramian")
        return those_found(*parts, *ends, *motions, answer.get("R_primitive"), answer.get("Q_primitive"))

    @property
    def verdict(self) -> str:
        """`no` where the pair is not observable."""
        return super().verdict if self.is_unique else "no"

    @property
    def further_zeros(self) -> tuple[Scalar, ...]:
        """Where the pair is not observable; nothing more is said of one that never is."""
        return super().further_zeros if self.is_unique else ()

    @cached_property
    def stated(self) -> tuple[Condition, ...]:
        """The horizon is positive: that it is not 0 is no further condition, and 0 no case."""
        return tuple(c for c in super().stated if c.kind == "domain" or c.expression.names != {"T"})

    def claims(self) -> Iterator[Claim]:
        """Yield the integrals, the two parts between Gramians, and their sum."""
        yield from super().claims()
        yield from self.observability_claims()
        if self.answer["covariance"] is None:
            return
        yield from self._about_parts(time_environment(self.plant, self.values_by_letter(), self.answer["horizon"]))

    def values_by_letter(self) -> dict[str, Matrix]:
        """Return the values of the letters of claims and page."""
        m, answer = self.plant.matrices, self.answer
        found = {"exp_At": answer.get("exponential"), "Phi_m": answer.get("backwards"), "W_t": answer.get("gramian")}
        found |= {"W": answer.get("W"), "S_R": answer.get("S_R"), "S_Q": answer.get("S_Q")}
        found |= {"Cov": answer["covariance"], "Cov_R": answer.get("output_part"), "Cov_Q": answer.get("input_part")}
        found |= {"V_t": answer.get("V"), "R_t": answer.get("R_primitive"), "Q_t": answer.get("Q_primitive")}
        found |= {"Q": answer["Q"], "R": answer["R"]}
        values, horizon = {"A": m.A, "B": m.B, "C": m.C, **named_found(found)}, answer["horizon"]
        return values | {f"{n} at T": substitute(v, {"t": horizon}) for n, v in list(values.items())}

    def _about_parts(self, e: Environment) -> Iterator[Claim]:
        Phi, C, R = (letter(name, e) for name in ("exp_At", "C", "R"))
        horizon = self.answer["horizon"]
        yield from exponential_claims(e)
        yield from from_zero(["W_t", "R_t", "Q_t"], e)
        whole = since_start((Phi.T @ C.T @ C @ Phi).formula, letter("W_t", e).formula, horizon)
        yield holds(e, "W = {whole}", whole=Term(whole, e))
        noise = since_start((Phi.T @ C.T @ R @ C @ Phi).formula, letter("R_t", e).formula, horizon)
        yield holds(e, "S_R = {noise}", noise=Term(noise, e))
        yield holds(e, "W Cov_R W = S_R")
        total = letter("Cov_R", e)
        if "V_t" in e.values:
            V, Q = letter("V_t", e), letter("Q", e)
            yield holds(e, "Phi_m exp_At = I")
            yield holds(e, "V_t = (W - W_t) Phi_m B")
            driven = since_start((V @ Q @ V.T).formula, letter("Q_t", e).formula, horizon)
            yield holds(e, "S_Q = {driven}", driven=Term(driven, e))
            yield holds(e, "W Cov_Q W = S_Q")
            total = total + letter("Cov_Q", e)
        yield holds(e, "Cov = {total}", total=total)

    @cached_property
    def best_horizon(self) -> list[str | None]:
        """For each component the equation of the horizon with the least variance, None where it is not a simple one."""
        found = self.answer["covariance"]
        if found is None or self.answer["horizon"] != END:
            return []
        name = "t" if self.answer["called_t"] else "T"
        signs = {**self.plant.symbols.signs, name: "positive"}
        return [stationary(self._as_called(found[i, i]), name, signs) for i in range(self.plant.order)]

    def _as_called(self, value: Any) -> Any:
        """Return a value in the name that the horizon was given."""
        return substitute(value, {"T": TIME}) if value is not None and self.answer["called_t"] else value

    @cached_property
    def fields(self) -> Mapping[str, Any]:
        """The covariance, its two parts, the best horizon."""
        asked = self.answer.get("question")
        answer = self.answer
        parts = {"covariance": answer["covariance"], "input_part": answer.get("input_part")}
        parts |= {"output_part": answer.get("output_part")}
        found: dict[str, Any] = {name: self._as_called(part) for name, part in parts.items()}
        found["best_horizon"] = self.best_horizon
        return {**found, **({"question": asked} if asked else {})}


def too_long(A: Matrix, C: Matrix, table: Table) -> str:
    """Return the question that stays open where the Gramian of (A, C), with e^{At}, cannot be inverted readably."""
    order = A.shape[0]
    if A.names and any(roots_of_frequencies(entry) for row in table for entry in row):
        return (
            f"the inverse of the {order}x{order} Gramian, whose functions have square roots of the parameters in them"
        )
    seen = product(table_of(C), table)
    terms = sum(len(entry.terms) for row in product(transposed(seen), seen) for entry in row)
    return (
        f"the inverse of the {order}x{order} Gramian, of {terms} terms, more than {_MOST_TERMS}"
        if terms > _MOST_TERMS
        else ""
    )


def roots_of_frequencies(value: Quasipolynomial) -> bool:
    """Return whether a root stands in a rate or a frequency."""
    return any(roots_in(key.rate) or roots_in(key.frequency) for key in value.terms)


def _parts(plant: StateSpace, exponential: Table, asked: CovarianceAsked) -> CovarianceParts:
    """Return the integrals with their primitives and the parts of the covariance."""
    m, horizon = plant.matrices, asked["horizon"]
    seen = product(table_of(m.C), exponential)
    W = integral(product(transposed(seen), seen))
    noisy = integral(product(transposed(seen), product(table_of(asked["R"]), seen)))
    ends = {"T": horizon}
    W_end, S_R = (_in_end(matrix_at(table, END)) for table in (W, noisy))
    answer: CovarianceParts = {
        "covariance": None,
        "exponential": matrix_at(exponential, TIME),
        "gramian": matrix_at(W, TIME),
        "W": substitute(matrix_at(W, END), ends),
        "R_primitive": matrix_at(noisy, TIME),
        "S_R": substitute(matrix_at(noisy, END), ends),
    }
    inverse = _Inverse(W_end)
    output_part = inverse.times(_scalar_of(asked["R"])) or inverse.between(S_R)
    total = output_part
    if asked["Q"] is not None:
        backwards = tuple(tuple(entry.reversed() for entry in row) for row in exponential)
        whole = table_of(matrix_at(W, END))
        left = tuple(tuple(a - b for a, b in zip(p, q, strict=True)) for p, q in zip(whole, W, strict=True))
        V = product(left, product(backwards, table_of(m.B)))
        driven = integral(product(V, product(table_of(asked["Q"]), transposed(V))))
        S_Q = _in_end(matrix_at(driven, END))
        input_part = inverse.between(S_Q)
        total = output_part + input_part
        answer |= {
            "backwards": matrix_at(backwards, TIME),
            "V": substitute(matrix_at(V, TIME), ends),
            "Q_primitive": substitute(matrix_at(driven, TIME), ends),
            "S_Q": substitute(matrix_at(S_Q, END), ends),
            "input_part": substitute(input_part, ends),
        }
    return {**answer, "output_part": substitute(output_part, ends), "covariance": substitute(total, ends)}


def _in_end(matrix: Matrix) -> Table:
    """Return the entries as sums of functions of T."""
    return tuple(tuple(quasi_of(entry, "T") for entry in row) for row in matrix.rows)


def _scalar_of(R: Matrix) -> Scalar | None:
    """Return r where R = r I."""
    r = R[0, 0]
    return r if Matrix.identity(R.shape[0]) * r == R else None


class _Inverse:
    """W⁻¹ = adj W / det W, products taken as sums of functions, quotients reduced in the exponentials they have."""

    def __init__(self, W: Table) -> None:
        self.determinant = determinant(W)
        order = len(W)
        minor = [
            [
                tuple(tuple(e for c, e in enumerate(row) if c != j) for r, row in enumerate(W) if r != i)
                for j in range(order)
            ]
            for i in range(order)
        ]
        one = Quasipolynomial.constant(Scalar.of(1))
        cofactors = [[determinant(m) if m else one for m in row] for row in minor]
        self.adjugate = tuple(
            tuple(-cofactors[j][i] if (i + j) % 2 else cofactors[j][i] for j in range(order)) for i in range(order)
        )

    def times(self, factor: Scalar | None) -> Matrix | None:
        """Return r W⁻¹."""
        if factor is None:
            return None
        return _over(matrix_at(self.adjugate, END) * factor, self.determinant.value_at(END))

    def between(self, middle: Table) -> Matrix:
        """Return W⁻¹ S W⁻¹."""
        top = product(self.adjugate, product(middle, self.adjugate))
        below = self.determinant * self.determinant
        return _over(matrix_at(top, END), below.value_at(END))


def _over(top: Matrix, below: Scalar) -> Matrix:
    """Return a quotient, its exponentials written in a common one so that what both share cancels."""
    meanings, _ = identities([top, below], falling=True)
    base = {name: value for name, value in meanings.items() if not value.names & {name} and name.startswith("exp(")}
    return Matrix.of([[entry.substitute(base) / below.substitute(base) for entry in row] for row in top.rows])


def read_intensity(value: object, plant: StateSpace, name: str, size: int) -> Matrix | None:
    """Return a symmetric matrix; a single value q stands for q I.  Raises `InputError`, `ShapeMismatch`."""
    if value is None:
        return None
    found = read_symmetric(value, plant, name, size)
    for i in range(size):
        if sign_of(found[i, i], plant.symbols.signs) == "negative":
            raise InputError(
                f"{name} has a negative entry on its diagonal",
                where=f"specification.{name}",
                repair="variances are not negative",
            )
    return found


@method("initial_state_covariance/gramian", source="least-squares estimate; kalman1961")
def gramian_estimate(plant: StateSpace, asked: CovarianceAsked) -> InitialStateCovariance:
    """Propagate white noise through the estimate W⁻¹ ∫ e^{Aᵀt} Cᵀ ỹ dt, entry by entry in closed form."""
    return InitialStateCovariance.of(plant, "gramian", asked, {})


@task
def initial_state_covariance(
    plant: StateSpace, *, Q: Intensity = None, R: Intensity = None, horizon: Horizon = None, method: Name = "auto"
) -> Result:
    """Return the covariance Σ of the estimate x̂₀ = W⁻¹ ∫ e^{Aᵀt} Cᵀ y dt under white input noise Q and output noise R.

    plant    n ≤ 3 states, p outputs; B where Q is given; continuous time
    Q, R     intensities: symmetric m×m and p×p, or one value for a multiple of I; Q left out: no input noise
    horizon  T > 0, a symbol or a number, "T" if left out; called t, it stands so in the answers, and as T in the derivation
    Returns covariance, input_part, output_part, best_horizon (for each component the equation of its least variance).
    Verdict no where the pair (C, A) is not observable.  Raises `InputError` where C, R (or B) is missing, in discrete
    time, for an intensity that is not symmetric and for an infinite horizon; `ShapeMismatch`.
    Source: derived on the page; R. E. Kalman and R. S. Bucy (1961) for the optimal estimate.
    """
    plant.require("C", task="initial_state_covariance")
    require_continuous(plant, "initial_state_covariance")
    if Q is not None:
        plant.require("B", task="initial_state_covariance")
    intensity = read_intensity(R, plant, "R", plant.outputs)
    if intensity is None:
        message = "the intensity R of the output noise is missing"
        raise InputError(message, where="specification.R", repair='give it, for example R = "r"')
    end = read_horizon(plant, horizon)
    if isinstance(end, str):
        raise InputError("the horizon is finite here", where="specification.horizon", repair='write "T", or a number')
    driving = read_intensity(Q, plant, "Q", max(plant.inputs, 1))
    called_t = end == TIME  # the integrands contain the time, too: beside it the end of the horizon is T
    if called_t and any("T" in part.field.names for part in (plant, intensity, driving) if part is not None):
        message = "the horizon cannot be called t where T is a parameter: t is the time, and T stands for its end"
        raise InputError(message, where="specification.horizon", repair="give the parameter another name")
    asked: CovarianceAsked = {"Q": driving, "R": intensity, "horizon": END if called_t else end, "called_t": called_t}
    return over_horizon(lambda: choose("initial_state_covariance", method, "gramian").solve(plant, asked))


# The page of the covariance of the initial state.


@page_of(InitialStateCovariance)
def write_covariance(page: Builder, result: InitialStateCovariance) -> None:
    """Write e^{At}, the Gramian, the two integrals, the covariance and the best horizon."""
    page.in_time(*result.everything(), at=result.answer["horizon"])
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
    gramian = since_start(page["exp_At.T C.T C exp_At"].formula, Literal(answer["gramian"]), horizon)
    page.define("W", page.term(gramian), values["W"], say="gramian_is", closing=False)
    noise = since_start(page["exp_At.T C.T R C exp_At"].formula, Literal(answer["R_primitive"]), horizon)
    page.define(
        "S_R", page.term(noise), values["S_R"], say="estimate_is" if has_input else "estimate_of_output", closing=False
    )
    if has_input:
        page.set("Phi_m", values["Phi_m"])
        page.set("W_t", values["W_t"])
        page.conclude_silently("Phi_m exp_At = I")
        page.define("V_t", "(W - W_t) Phi_m B", values["V_t"], say="estimate_input", closing=False)
        driven = since_start(page["V_t Q V_t.T"].formula, Literal(answer["Q_primitive"]), horizon)
        page.define("S_Q", page.term(driven), values["S_Q"], say="estimate_input_integral", closing=False)
    output = page.set("Cov_R", values["Cov_R"])
    page.conclude_silently("W Cov_R W = S_R")
    page.equal(
        page.line("Cov_R = W^-1 S_R W^-1 = {value}", value=values["Cov_R"]),
        say="parts_of_covariance" if has_input else "covariance_of_output",
    )
    total = output
    if has_input:
        part = page.set("Cov_Q", values["Cov_Q"])
        page.equal(page.line("Cov_Q = W^-1 S_Q W^-1 = {value}", value=values["Cov_Q"]), say="input_part")
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
    tell_deficient(page, "O", rank["rank"], "observability")


def _tell_horizons(result: InitialStateCovariance, page: Builder) -> None:
    """Say where each variance is stationary, with the derivative that vanishes there."""
    signs = {**result.plant.symbols.signs, "T": "positive"}
    covariance = result.answer["covariance"]
    if covariance is None:
        return
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
