"""The plant behind a zero-order hold, from one sampling instant to the next:  A_d = e^{AT},  B_d = ∫₀ᵀ e^{At} B dt.

Exponentials, cosines and sines of the period are independent letters with their relations, as everywhere.
"""

from __future__ import annotations

from dataclasses import replace
from functools import cached_property
from typing import TYPE_CHECKING, Any, ClassVar, Self

from symobs.exact import Matrix
from symobs.exact.core.generators import substitute
from symobs.exact.time_functions.matrix_exponential import NoClosedForm
from symobs.exact.time_functions.quasipolynomial import integral, matrix_at, product, table_of
from symobs.formula.tree import Literal
from symobs.formula.tree.calculus import since_start
from symobs.formula.tree.term import Term, letter
from symobs.ground.dataclass import dataclass
from symobs.ground.errors import InputError
from symobs.system import StateSpace
from symobs.system.transfer_function_text import read_transfer_function
from symobs.tasks.analysis.time_response.damping_cases import (
    DampingCases,
    Signs,
    exponential_claims,
    from_zero,
    rate_of,
    time_environment,
)
from symobs.tasks.analysis.time_response.horizons import over_horizon, read_horizon
from symobs.tasks.analysis.time_response.matrix_exponential import (
    TIME,
    closed_form,
    has_sums,
    motion,
    question_of,
    require_continuous,
    tell_exponential,
    tell_polynomial,
    tell_question,
)
from symobs.tasks.analysis.time_response.sampling_rules import RULES, SampledController, SampledPlant
from symobs.tasks.result import Result, choose, holds, method, task

if TYPE_CHECKING:
    from collections.abc import Callable, Collection, Iterator, Mapping

    from symobs.exact import Scalar
    from symobs.exact.time_functions.matrix_exponential import Exponential
    from symobs.formula.tree import Environment
    from symobs.proof.certificate.claims import Claim
    from symobs.proof.derivation.builder import Builder
    from symobs.system.specification import Horizon, Name, TransferFunctionText
    from symobs.system.transfer_function_text import WrittenTransferFunction


@dataclass
class ZeroOrderHold(DampingCases):
    """A_d = Φ(T) with Φ′ = A Φ and Φ(0) = I, and B_d = ∫₀ᵀ Φ(t) B dt."""

    task: ClassVar[str] = "zero_order_hold"
    letters = {"A": "A_zoh", "B": "B_zoh", "C": "C_zoh", "D": "D_zoh"}
    answered_by = ("A", "B")
    only_value = ("A", "B")
    main: ClassVar[str] = "A_d"
    asked_for: ClassVar[tuple[str, ...]] = ("horizon",)

    @classmethod
    def of(cls, plant: StateSpace, method_name: str, asked: Mapping[str, Any], taken: Signs) -> Self:
        """Return the result for a plant; `asked` holds the sampling period."""
        period = asked["horizon"]
        shared = {"horizon": period, "taken": taken, "chosen": {}}
        try:
            found, chosen = closed_form(plant, taken, sums=has_sums(plant))
            driven = _driven(plant, found)
        except NoClosedForm as error:
            nothing = {"A_d": None, "B_d": None, "question": question_of(error), "factor": error.factor}
            return cls(plant, method_name, {**shared, **nothing})
        at_period = {"A_d": found.matrix(period), "B_d": driven(period)}
        answer = {"exponential": found.matrix(TIME), "driven": driven(TIME)}
        return cls(plant, method_name, {**shared, **answer, **at_period, "chosen": chosen})

    @classmethod
    def fields_asked(cls, given: Collection[str]) -> tuple[str, ...]:
        """Return A and B behind a hold, all four matrices by a rule, and the transfer function of a controller."""
        if "controller" in given:
            return ("transfer_function",)
        return ("A", "B", "C", "D") if "rule" in given else cls.answered_by

    @property
    def matrices(self) -> tuple[Matrix | Scalar, ...]:
        """The functions of time, at the period too."""
        names = ("exponential", "driven", "A_d", "B_d")
        return tuple(self.answer[name] for name in names if self.answer.get(name) is not None)

    def claims(self) -> Iterator[Claim]:
        """Yield the differential equation and its start, the value at the period, and the integral."""
        yield from super().claims()
        if self.answer["A_d"] is None:
            return
        m, period = self.plant.matrices, self.answer["horizon"]
        values = {"A": m.A, "B": m.B, "exp_At": self.answer["exponential"], "driven": self.answer["driven"]}
        values |= {f"{name} at T": substitute(values[name], {"t": period}) for name in ("exp_At", "driven")}
        e = time_environment(self.plant, {**values, "A_zoh": self.answer["A_d"], "B_zoh": self.answer["B_d"]})
        Phi = letter("exp_At", e)
        yield from exponential_claims(e)
        yield holds(e, "A_zoh = {period}", period=Phi.at("t", period))
        yield from from_zero(["driven"], e)
        whole = Term(_integral(e, letter("driven", e), period), e)
        yield holds(e, "B_zoh = {whole}", whole=whole)

    @property
    def sampled(self) -> StateSpace:
        """The discrete-time plant x_{k+1} = A_d x_k + B_d u_k, y_k = C x_k + D u_k.

        Its sampling period is the number T, or left open.  Raises `InputError` where there is no closed form, and where
        the sign of a discriminant that is not known decides.
        """
        if self.answer["A_d"] is None:
            message = f"there is no sampled plant in closed form: what is open is {self.answer['question']}"
            raise InputError(message, where="plant.A", repair="put numbers in, and sample those")
        for delta in (*self.answer["chosen"], *self.answer["taken"]):
            message = f"the sampled plant is another one for each sign of {delta}"
            raise InputError(message, where="symbols", repair="declare signs that decide it, or put numbers in")
        m, period = self.plant.matrices, self.answer["horizon"]
        C, D = m.C if m.has_output else None, m.D if m.has_output and m.has_feedthrough else None
        symbols = self.plant.symbols
        if str(period) in period.names and symbols.sign(str(period)) == "real":
            symbols = replace(symbols, signs={**symbols.signs, str(period): "positive"})
        dt = period.fraction() if period.is_constant else True
        return StateSpace(self.answer["A_d"], self.answer["B_d"], C, D, dt=dt, symbols=symbols)

    @property
    def as_plant(self) -> StateSpace:
        """The sampled plant."""
        return self.sampled

    @cached_property
    def fields(self) -> Mapping[str, Any]:
        """The matrices of the sampled plant; where there are none, the question that is open."""
        m, asked = self.plant.matrices, self.answer.get("question")
        found = {"A": self.answer["A_d"], "B": self.answer["B_d"], "C": m.C, "D": m.D}
        return {**found, **({"question": asked} if asked else {})}

    def write(self, page: Builder) -> None:
        """Write the matrix exponential, its value at the period, the integral, the check."""
        page.in_time(*self.everything())
        self.state_data(page)
        with page.section("zero_order_hold"):
            tell_polynomial(page)
            self.write_branches(page, _write_branch)


def _driven(plant: StateSpace, found: Exponential) -> Callable[[Scalar], Matrix]:
    """Return ∫₀ᵗ e^{As} B ds as a function of t; beside sums over roots the motion of x′ = A x + B u, u′ = 0, u(0) = I."""
    A, B = plant.matrices.A, plant.matrices.B
    if found.is_closed:
        table = integral(product(found.table(), table_of(B)))
        return lambda time: matrix_at(table, time)
    n, m = B.shape
    whole = Matrix.block([[A, B], [Matrix.zeros(m, n), Matrix.zeros(m, m)]])
    moved = motion(plant, whole, Matrix.block([[Matrix.zeros(n, m)], [Matrix.identity(m)]]))
    return lambda time: moved.matrix(time).select(range(n), range(m))


def _integral(e: Environment, primitive: Term | Matrix, period: Scalar) -> Any:
    """Return ∫₀ᵀ e^{At} B dt with its primitive."""
    known = Literal(primitive) if isinstance(primitive, Matrix) else primitive.formula
    return since_start((letter("exp_At", e) @ letter("B", e)).formula, known, period)


def _write_branch(page: Builder, result: ZeroOrderHold) -> None:
    """Write one branch."""
    answer, period = result.answer, result.answer["horizon"]
    if answer.get("question") is not None:
        tell_question(page, answer["factor"])
        page.remark("zero_order_hold_not_given")
        return
    found, _ = closed_form(result.plant, {**answer["taken"], **answer["chosen"]}, sums=has_sums(result.plant))
    tell_exponential(page, found, answer["exponential"])
    Phi = page["exp_At"]
    page.define("A_zoh", Phi.at("t", period), answer["A_d"], say="zero_order_hold_held", answer=True, closing=False)
    whole = page.term(_integral(page.environment, answer["driven"], period))
    page.define("B_zoh", whole, answer["B_d"], say="zero_order_hold_integral", answer=True, closing=False)
    start = page.line("exp_At(t = 0) = I")
    balance = page.line("A B_zoh = (A_zoh - I) B")
    page.verified(
        "zero_order_hold_checked",
        page.line("{rate} = A exp_At", rate=rate_of(page["exp_At"])),
        start=start,
        balance=balance,
    )


@method("zero_order_hold/integral", source="astrom1997, ch. 2")
def by_integral(plant: StateSpace, period: Any) -> ZeroOrderHold:
    """Integrate the entries of e^{At} B as sums of tⁿ e^{αt} cos βt and sin βt: B_d = ∫₀ᵀ e^{At} B dt, A_d = e^{AT}."""
    return ZeroOrderHold.of(plant, "integral", {"horizon": period}, {})


@task
def zero_order_hold(
    plant: StateSpace,
    *,
    sampling_period: Horizon = None,
    rule: Name | None = None,
    controller: TransferFunctionText = None,
    method: Name = "auto",
) -> Result:
    """Return the plant behind a zero-order hold, x_{k+1} = A_d x_k + B_d u_k, with A_d = e^{AT}, B_d = ∫₀ᵀ e^{At} B dt.

    plant            n states, continuous time; B must be given
    sampling_period  T > 0, the sampling period: a symbol or a number ("T" if left out)
    rule             instead of the hold what replaces s: `tustin` 2(z − 1)/(T(z + 1)), `forward` (z − 1)/T,
                     `backward` (z − 1)/(T z)
    controller       with a rule F(s), improper ones too: transfer_function is F(z)
    Returns A, B, C, D of the sampled plant; with the rule `forward` stable_if, where it is stable.  In Python `sampled` is
    the plant behind the hold, for every task in discrete time: e^{−T}, cos T and sin T beside T are independent letters.
    Where the sign of a discriminant decides between oscillation and none, conditions hold the branch that is shown and
    cases the others.  Modes of a plant in numbers that have no closed form stand in sums over roots, `RootSum`, with
    `decimals` beside; undecided where such modes have parameters.
    Raises `InputError` in discrete time, and for a period that is not positive or infinite.
    Source: K. J. Åström and B. Wittenmark, Computer-Controlled Systems, 3rd ed., ch. 2.
    """
    plant.require("B", task="zero_order_hold")
    require_continuous(plant, "zero_order_hold")
    plant = plant.knowing(sampling_period)
    T = read_horizon(plant, sampling_period, "sampling_period")
    if isinstance(T, str):
        message = "the sampling period inf is no number"
        raise InputError(message, where="specification.sampling_period", repair='write "T", or a number above 0')
    if controller is not None:
        plant = plant.knowing(controller)
        controller = read_transfer_function(controller, plant.symbols, plant.variable, "specification.controller")
    if rule is None and controller is not None:
        message, repair = "a controller is carried over by a rule", 'give rule = "tustin", "forward" or "backward"'
        raise InputError(message, where="specification.rule", repair=repair)
    if rule is not None:
        return _by_rule(plant, rule, T, controller).asked(method)
    return over_horizon(lambda: choose("zero_order_hold", method, "integral").solve(plant, T), "sampling_period")


def _by_rule(plant: StateSpace, rule: str, T: Scalar, controller: WrittenTransferFunction | None) -> Result:
    """Return the plant or the controller that a rule makes; raises `InputError` for no rule."""
    if rule not in RULES:
        raise InputError(f"{rule!r} is no rule", where="specification.rule", repair=f"write {', '.join(RULES)}")
    signs = {**plant.symbols.signs, **{name: "positive" for name in T.names if str(T) == name}}
    plant = plant.with_symbols(replace(plant.symbols, signs=signs))
    if controller is None:
        return SampledPlant.of(plant, rule, T)
    return SampledController.of(plant, rule, T, controller)
