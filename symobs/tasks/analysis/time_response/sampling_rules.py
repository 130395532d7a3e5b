"""Plants and controllers in discrete time by a rule that replaces s: forward (z − 1)/T, backward (z − 1)/(T z), Tustin.

With α = 0, 1, 1/2 all three are  s = (z − 1)/(T (1 − α + α z)).
"""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING, Any, ClassVar, Self

from symobs.exact import Matrix, Scalar
from symobs.formula.tree import Environment, Literal
from symobs.formula.tree.term import Term
from symobs.ground.dataclass import dataclass
from symobs.ground.errors import InputError
from symobs.proof.derivation.builder import predicate, relation
from symobs.system import StateSpace
from symobs.system.conditions import joined, nonzero, vanishing_factors
from symobs.tasks.analysis.page_parts import factored_form, given
from symobs.tasks.result import Result, holds

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from symobs.proof.certificate.claims import Claim
    from symobs.proof.derivation.builder import Builder
    from symobs.system.conditions import Condition
    from symobs.system.transfer_function_text import WrittenTransferFunction
    from symobs.tasks.analysis.stability_region.stability_region import StabilityRegion

#: α of each rule.
RULES = {"forward": Scalar.of(0), "backward": Scalar.of(1), "tustin": Scalar.of(1) / 2}


class _Sampled:
    """The task of both, which is not that of their own alone."""

    task: ClassVar[str] = "zero_order_hold"
    letters: ClassVar[Mapping[str, str]] = {"A": "A_zoh", "B": "B_zoh", "C": "C_zoh", "D": "D_zoh"}


@dataclass
class SampledPlant(_Sampled, Result):
    """A_d = M (I + (1 − α) T A), B_d = T M B, C_d = C M, D_d = D + α C B_d with M = (I − α T A)⁻¹."""

    rule: str
    period: Scalar

    answered_by = ("A", "B", "C", "D")
    only_value = ("A", "B", "C", "D")

    @classmethod
    def of(cls, plant: StateSpace, rule: str, period: Scalar) -> Self:
        """Return the sampled plant; raises `InputError` where the rule divides by zero."""
        m, identity, alpha = plant.matrices, Matrix.identity(plant.order), RULES[rule]
        moved = identity - m.A * (alpha * period)
        if moved.determinant().is_zero:
            message = f"1/({alpha}*T) is an eigenvalue of A, where the rule {rule} divides by zero"
            raise InputError(message, where="specification.sampling_period", repair="give another sampling period")
        M = moved.inverse()
        A, B = (M @ (identity + m.A * ((1 - alpha) * period))).normal(), (M @ m.B * period).normal()
        C = (m.C @ M).normal() if m.has_output else None
        D = (m.D + m.C @ B * alpha).normal() if m.has_output else None
        return cls(plant, rule, {"A": A, "B": B, "C": C, "D": D}, rule, period)

    def claims(self) -> Iterator[Claim]:
        """Yield the equations of the four matrices without an inverse."""
        m, answer = self.plant.matrices, self.answer
        values = {"A": m.A, "B": m.B, "A_zoh": answer["A"], "B_zoh": answer["B"]}
        if m.has_output:
            values |= {"C": m.C, "D": m.D, "C_zoh": answer["C"], "D_zoh": answer["D"]}
        e = Environment(variable=self.plant.variable, values=values)
        slots = {"a": RULES[self.rule] * self.period, "b": (1 - RULES[self.rule]) * self.period, "T": self.period}
        yield holds(e, "(I - {a} A) A_zoh = I + {b} A", a=slots["a"], b=slots["b"])
        yield holds(e, "(I - {a} A) B_zoh = {T} B", a=slots["a"], T=slots["T"])
        if m.has_output:
            yield holds(e, "C_zoh (I - {a} A) = C", a=slots["a"])
            yield holds(e, "D_zoh = D + {alpha} C B_zoh", alpha=RULES[self.rule])

    @property
    def as_plant(self) -> StateSpace:
        """The sampled plant; its period is the number T, or left open."""
        dt = self.period.fraction() if self.period.is_constant else True
        A, B, C, D = (self.answer[name] for name in "ABCD")
        return StateSpace(A, B, C, D, dt=dt, symbols=self.plant.symbols)

    @property
    def shifted(self) -> Scalar:
        """(s − T/2)ⁿ χ(1/(s − T/2)): stable exactly where every pole p has |1 + T p| < 1, that is Re 1/p < −T/2."""
        s, n = Scalar.symbol(self.plant.variable), self.plant.order
        coefficients = self.plant.matrices.A.characteristic_polynomial(self.plant.variable).coefficients(
            self.plant.variable
        )
        place, found = s - self.period / 2, Scalar.of(0)
        for power, coefficient in enumerate(coefficients):  # sⁿ⁻ᵏ becomes (s − T/2)ᵏ
            found += coefficient * place**power
        assert n == len(coefficients) - 1  # noqa: S101 - χ is monic of degree n
        return found

    @cached_property
    def region(self) -> StabilityRegion | None:
        """Where the plant that the forward rule makes is stable; None for other rules, and where a pole is 0."""
        if self.rule != "forward" or self.shifted.degree(self.plant.variable) < self.plant.order:
            return None
        names = sorted(self.shifted.names - {self.plant.variable})
        period = [name for name in names if name in self.period.names] or names
        signs = {**self.plant.symbols.signs, **dict.fromkeys(self.period.names, "positive")}
        from symobs.tasks.analysis.stability_region.stability_region import stability_region  # noqa: PLC0415 - rules alone

        found: Any = stability_region(self.shifted, symbols=signs, parameters=period)
        return found  # type: ignore[no-any-return]

    @cached_property
    def fields(self) -> Mapping[str, Any]:
        """The matrices of the sampled plant, and for the forward rule where it is stable."""
        found: dict[str, Any] = {name: self.answer[name] for name in "ABCD"}
        if self.rule == "forward":
            found["stable_if"] = ["False"] if self.region is None else self.region.stable_if
        return found

    def write(self, page: Builder) -> None:
        """Write the four matrices, and what the rule does to stability."""
        given(page)
        m, alpha, T = self.plant.matrices, RULES[self.rule], page.value(self.period)
        with page.section("sampling_rules"):
            a, b = page.value(alpha * self.period), page.value((1 - alpha) * self.period)
            page.remark(f"sampling_{self.rule}")
            explicit = self.rule == "forward"
            A = page("I + {T} A", T=T) if explicit else page("(I - {a} A)^-1", a=a)
            if self.rule == "tustin":
                A = page("(I - {a} A)^-1 (I + {b} A)", a=a, b=b)
            page.define("A_zoh", A, self.answer["A"], say="sampling_matrices", answer=True, closing=False)
            B = page("{T} B", T=T) if explicit else page("(I - {a} A)^-1 {T} B", a=a, T=T)
            page.define("B_zoh", B, self.answer["B"], answer=True, closing=False)
            if m.has_output and not explicit:
                page.define("C_zoh", page("C (I - {a} A)^-1", a=a), self.answer["C"], answer=True, closing=False)
                through = page("{alpha} C B_zoh", alpha=page.value(alpha)) if not alpha.is_one else page["C B_zoh"]
                through = page["D"] + through if m.has_feedthrough else through
                page.define("D_zoh", through, self.answer["D"], answer=True, closing=False)
            elif m.has_output:
                page.remark("sampling_output_kept")
            self._write_response(page)
            self._write_stability(page)

    def _write_response(self, page: Builder) -> None:
        """Write that the transfer function is that of the plant at what s is replaced by."""
        if not self.plant.matrices.has_output:
            return
        z, image, own = page.value(Scalar.symbol("z")), _image(page, self.rule, self.period), self.rule != "forward"
        names = ("C_zoh", "D_zoh") if own else ("C", "D")
        sampled = page(f"{names[0]} ({{z}} I - A_zoh)^-1 B_zoh", z=z)
        plant = page("C ({image} I - A)^-1 B", image=image)
        if own:
            sampled = sampled + page[names[1]]
        if self.plant.matrices.has_feedthrough:
            sampled, plant = (sampled if own else sampled + page["D"]), plant + page["D"]
        page.equal(relation(sampled, plant), say="sampling_response")

    def _write_stability(self, page: Builder) -> None:
        """Write what the rule does to stability."""
        if self.rule != "forward":
            page.remark(f"sampling_{self.rule}_stability")
            return
        chi = self.plant.matrices.A.characteristic_polynomial(page.plant.variable)
        page.define("chi", "det(pencil(A))", chi, say="sampling_poles", closing=False)
        if self.region is None:
            page.remark("sampling_pole_at_zero")
            page.equal(relation(page.value(0).apply("chi_at"), 0))
            return
        place = page.value(Scalar.symbol(page.plant.variable) - self.period / 2)
        product = place**self.plant.order * (page.value(1) / place).apply("chi_at")
        page.define("q_s", product, self.shifted, say="sampling_forward_stability", closing=False)
        if self.shifted.names > {page.plant.variable}:
            from symobs.tasks.analysis.stability_region.stability_region_page import write_line  # noqa: PLC0415

            write_line(page, self.region, "q_s", with_pictures=False)
        elif self.region.verdict == "yes":
            page.conclude("sampling_stable", predicate("stable", page["q_s"]))
        else:
            page.conclude("sampling_not_stable", predicate("unstable", page["q_s"]))


@dataclass
class SampledController(_Sampled, Result):
    """F(z), the transfer function F(s) of a controller with s replaced by the rule."""

    rule: str
    period: Scalar
    written: WrittenTransferFunction

    answered_by = ("transfer_function",)
    only_value = ("transfer_function",)

    @classmethod
    def of(cls, plant: StateSpace, rule: str, period: Scalar, written: WrittenTransferFunction) -> Self:
        """Return F(z); raises `InputError` where it is not proper, or where the rule divides by zero."""
        F = written.value
        image = _value(rule, period)
        parts = [part.substitute({written.variable: image}) for part in (F.numerator, F.denominator)]
        where = "specification.sampling_period"
        if parts[1].is_zero:
            raise InputError(f"the rule {rule} divides by zero", where=where, repair="give another sampling period")
        found = parts[0] / parts[1]
        if found.numerator.degree("z") > found.denominator.degree("z"):
            message = (
                f"by the rule {rule} the controller is not proper: it would need values of its input that lie ahead"
            )
            raise InputError(message, where="specification.rule", repair='write "backward" or "tustin"')
        return cls(plant, rule, {"transfer_function": found}, rule, period, written)

    def claims(self) -> Iterator[Claim]:
        """Yield F(z) d = n, where n and d are numerator and denominator of F at the image of z."""
        F = self.written.value
        values = {"n_F": F.numerator, "d_F": F.denominator, "F_zoh": self.answer["transfer_function"]}
        e = Environment(variable=self.written.variable, values=values)
        image = Term(Literal(_value(self.rule, self.period)), e)
        yield holds(e, "F_zoh {below} = {above}", below=image.apply("d_F_at"), above=image.apply("n_F_at"))

    @cached_property
    def holds_where(self) -> tuple[Condition, ...]:
        """Where F(z) is proper."""
        lead = self.answer["transfer_function"].denominator.coefficients("z")[0]
        return joined(self.domain, nonzero("claim", vanishing_factors([lead], self.plant.symbols.signs)))

    @cached_property
    def fields(self) -> Mapping[str, Any]:
        """The transfer function in z."""
        return {"transfer_function": self.answer["transfer_function"]}

    def write(self, page: Builder) -> None:
        """Write F(s), the image of z, and F(z)."""
        F = self.written.value
        given(page)
        with page.section("sampling_rules"):
            page.set("n_F", F.numerator)
            page.set("d_F", F.denominator)
            page.define(
                "F", page["n_F"] / page["d_F"], factored_form(page, F), say="sampling_controller", closing=False
            )
            page.remark(f"sampling_{self.rule}")
            image = _image(page, self.rule, self.period)
            quotient = image.apply("n_F_at") / image.apply("d_F_at")
            value = self.answer["transfer_function"]
            page.define("F_zoh", quotient, value, say="sampling_controller_is", answer=True, closing=False, image=image)
            if self.rule != "forward":
                page.remark(f"sampling_{self.rule}_stability")
            else:
                page.remark("sampling_forward_disc")


def _value(rule: str, period: Scalar) -> Scalar:
    z, alpha = Scalar.symbol("z"), RULES[rule]
    return (z - 1) / (period * (1 - alpha + alpha * z))


def _image(page: Builder, rule: str, period: Scalar) -> Term:
    """Return what s is replaced by."""
    z, T, one = page.value(Scalar.symbol("z")), page.value(period), page.value(1)
    if rule == "tustin":
        lead = page.value(2 / period) if period.is_constant else page.value(2) / T
        return lead * ((z - one) / (z + one))
    if period.is_constant:
        return page.value(1 / period) * ((z - one) if rule == "forward" else (z - one) / z)
    return (z - one) / (T if rule == "forward" else T @ z)
