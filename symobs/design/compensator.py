"""The observer-based compensator  x̂' = (A − BK − LC + LDK) x̂ + L y,  u = −K x̂,  in transfer form U = −F(s) Y."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any, ClassVar, Self

from symobs.analysis.strata import carried
from symobs.certificate import Certificate, Claim, check
from symobs.conditions import sign_of
from symobs.design.gain import GainDesign, letters_of, require_single
from symobs.design.observer import ObserverDesign
from symobs.design.state_feedback import StateFeedbackDesign
from symobs.errors import CertificateRejected, InputError, together
from symobs.exact import Factored, Matrix, Scalar, controller, factored, modulo, transfer
from symobs.formula import Environment
from symobs.formula.term import Term, identity, letter
from symobs.method import Case, Result, choose, method, task
from symobs.page import Page, relation
from symobs.specification import DesiredPolynomial, Name, Poles, PolynomialText, desired_polynomial
from symobs.stability import no_stable_compensator, stability, stable_somewhere

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from symobs.conditions import Condition
    from symobs.system import StateSpace


#: The Hurwitz determinants of a compensator with more terms than this take seconds, and only points are tried.
_DECIDABLE_TERMS = 400


@dataclass(frozen=True, eq=False, repr=False)
class CompensatorDesign(Result):
    """Both gains and F: det(sI − A + BK) = φ_c, det(sI − A + LC) = φ_o, F(s) = K (sI − A + BK + LC − LDK)⁻¹ L.

    `feedback` and `estimator` are the two designs, each with its own claims; where one of them is impossible there
    is no F.
    """

    feedback: StateFeedbackDesign
    estimator: ObserverDesign

    task: ClassVar[str] = "compensator"

    @classmethod
    def of(cls, feedback: StateFeedbackDesign, estimator: ObserverDesign, method_name: str) -> Self:
        """Return the compensator of two designs for one plant."""
        plant = feedback.plant
        K, L = feedback.answer["K"], estimator.answer["L"]
        F = None
        if K is not None and L is not None:
            numerator, denominator = own_transfer(feedback, estimator)
            F = plant.simplified(numerator / denominator)
        return cls(plant, method_name, {"K": K, "L": L, "F": F}, feedback, estimator)

    def with_answer(self, name: str, value: object) -> Self:
        """Return the compensator with another gain, and with the F that follows from it."""
        if name not in {"K", "L"}:
            return super().with_answer(name, value)
        feedback = self.feedback.with_answer(name, value) if name == "K" else self.feedback
        estimator = self.estimator.with_answer(name, value) if name == "L" else self.estimator
        return type(self).of(feedback, estimator, self.method)

    @property
    def _exists(self) -> bool:
        return self.answer["F"] is not None

    def _environment(self) -> Environment:
        values = letters_of(self.plant) | {name: self.answer[name] for name in ("K", "L", "F")}
        values["D"] = self.plant.matrices.D
        return Environment(variable=self.plant.variable, values=values)

    def claims(self) -> Iterator[Claim]:
        """Yield: K and L are the certified gains of the two designs; F is K times the resolvent times L."""
        if self._exists != (self.feedback.answer["K"] is not None and self.estimator.answer["L"] is not None):
            message = "there is a compensator exactly where there are both gains"
            raise CertificateRejected(message, repair="please report this: it is a bug of symobs")
        e = self._environment()
        for design in (self.feedback, self.estimator):
            own, certified = self.answer[design.letter], design.answer[design.letter]
            if own is not certified:
                yield Claim(relation(own, certified), e, f"{design.letter} is the certified gain")
        if self._exists:
            A, B, C, D, K, L, F = (letter(name, e) for name in "ABCDKLF")
            moved = letter("s", e) @ identity(self.plant.order, e) - A + B @ K + L @ C
            if self.plant.matrices.has_feedthrough:
                moved = moved - L @ D @ K
            yield Claim(relation(F, K @ moved.inverse @ L), e)

    @property
    def all_certificates(self) -> tuple[Certificate, ...]:
        """The certificates of both gains and of F."""
        return (*self.feedback.certificates, *self.estimator.certificates, *self.certificates)

    # -- what follows ------------------------------------------------------------------------------------------------

    @property
    def verdict(self) -> str:
        """`no` where either gain does not exist."""
        if not self._exists:
            return "no"
        return super().verdict

    @cached_property
    def holds_where(self) -> tuple[Condition, ...]:
        """The conditions of both gains."""
        both = [*self.feedback.holds_where, *self.estimator.holds_where]
        return tuple({c.expression: c for c in both}.values())

    @cached_property
    def case_tree(self) -> tuple[Case, ...]:
        """Every stratum where (A, B) or (C, A) loses its rank, with the whole compensator there."""
        return carried(self.plant, (*self.feedback.case_tree, *self.estimator.case_tree), self._on)

    def _on(self, plant: StateSpace, values: dict[str, Scalar]) -> CompensatorDesign:
        """Return the compensator on a stratum."""
        control, observer = self.feedback.desired, self.estimator.desired
        assert control is not None and observer is not None  # noqa: S101, PT018 - cases belong to desired polynomials
        feedback = StateFeedbackDesign.of(plant, control.substitute(values), self.method)
        estimator = ObserverDesign.of(plant, observer.substitute(values), self.method)
        return CompensatorDesign.of(feedback, estimator, self.method)

    @cached_property
    def own_matrix(self) -> Matrix:
        """A − BK − LC + LDK."""
        return compensator_matrix(self.plant, self.answer["K"], self.answer["L"]).normal()

    @cached_property
    def own_transfer(self) -> tuple[Scalar, Scalar]:
        """The compensator's numerator and det(sI − A + BK + LC − LDK), nothing cancelled between them."""
        return own_transfer(self.feedback, self.estimator)

    @cached_property
    def plant_transfer(self) -> tuple[Scalar, Scalar]:
        """The plant's transfer function as numerator over characteristic polynomial, nothing cancelled."""
        m = self.plant.matrices
        return transfer(m.A, m.B, m.C, m.D[0, 0], self.plant.variable)

    @cached_property
    def loop(self) -> Factored:
        """P/(1 + PF): the plant with F in the return path, checked against its definition."""
        numerator, characteristic = self.plant_transfer
        P, F = numerator / characteristic, self.answer["F"]
        _, own = self.own_transfer
        polynomial = self.loop_polynomial
        value = numerator * own / polynomial.value
        kept = value.denominator.degree(self.plant.variable) == polynomial.value.degree(self.plant.variable)
        form = _over(numerator, own, polynomial) if kept else factored(value, self.plant.variable)
        e = Environment(variable=self.plant.variable, values={"P": P, "F": F, "G_cl": value})
        P_, F_, one = letter("P", e), letter("F", e), Term(relation(1, 1).members[0], e)
        check(Claim(relation(letter("G_cl", e), P_ / (one + P_ @ F_)), e.under(self.plant.relations)))
        return form

    @cached_property
    def loop_polynomial(self) -> Factored:
        """φ_c φ_o, with the factors that were asked for."""
        factors: dict[Scalar, int] = {}
        for design in (self.feedback, self.estimator):
            for factor, power in _factors_of(design):
                factors[factor] = factors.get(factor, 0) + power
        return Factored(Scalar.of(1), tuple(factors.items()))

    @cached_property
    def error_coordinates(self) -> Matrix:
        """[A − BK, BK; 0, A − LC] in (x, e)."""
        m, K, L = self.plant.matrices, self.answer["K"], self.answer["L"]
        zero = Matrix.zeros(self.plant.order, self.plant.order)
        return Matrix.block([[m.A - m.B @ K, m.B @ K], [zero, m.A - L @ m.C]])

    @cached_property
    def estimate_coordinates(self) -> Matrix:
        """[A, −BK; LC, A − BK − LC] in (x, x̂)."""
        m, K, L = self.plant.matrices, self.answer["K"], self.answer["L"]
        return Matrix.block([[m.A, -(m.B @ K)], [L @ m.C, m.A - m.B @ K - L @ m.C]])

    @cached_property
    def own_stability(self) -> str:
        """Whether F itself is stable; `conditional` with a stable and an unstable point found, else `undecided`."""
        plant, F = self.plant, self.answer["F"]
        variable, signs, discrete = plant.variable, plant.symbols.signs, plant.is_discrete
        if self._is_unavoidably_unstable:
            return "no"
        if F.size <= _DECIDABLE_TERMS:
            verdict = stability(F.denominator, variable, signs, discrete=discrete).verdict
            if verdict != "conditional":
                return verdict
        met = stable_somewhere(F.denominator, variable, signs, discrete=discrete)
        return "conditional" if len(met) == 2 else "undecided"

    @cached_property
    def _is_unavoidably_unstable(self) -> bool:
        """Whether nothing stable stabilises the plant, and the loop's polynomial has only positive coefficients."""
        plant = self.plant
        signs = plant.symbols.signs
        if plant.is_discrete:
            return False
        wanted = (c for factor, _ in self.loop_polynomial.factors for c in factor.coefficients(plant.variable))
        numerator, characteristic = self.plant_transfer
        return all(sign_of(c, signs) == "positive" for c in wanted) and no_stable_compensator(
            numerator / characteristic, plant.variable, signs
        )

    @cached_property
    def fields(self) -> Mapping[str, Any]:
        """The fields of the contract."""
        names = ("K", "L", "F")
        if not self._exists:
            modes = {"fixed_modes": self.feedback.unmoved_modes + self.estimator.unmoved_modes}
            return {name: self.answer[name] for name in names} | modes
        return {
            **{name: self.answer[name] for name in names},
            "F_stable": self.own_stability,
            "compensator_matrix": self.own_matrix,
            "closed_loop_polynomial": self.loop_polynomial,
            "closed_loop": self.loop,
            "closed_loop_matrix": self.error_coordinates,
            "closed_loop_matrix_estimate": self.estimate_coordinates,
            "family": self._families,
        }

    @property
    def _families(self) -> Mapping[str, Any] | None:
        found = {d.letter: d.gain_family for d in (self.feedback, self.estimator) if d.gain_family is not None}
        return found or None

    def write(self, page: Page) -> None:
        """Write the page."""
        from symobs.design.compensator_page import write_compensator  # noqa: PLC0415 - the page stands on this type

        write_compensator(page, self)


def _factors_of(design: GainDesign) -> tuple[tuple[Scalar, int], ...]:
    if design.desired is not None:
        return design.desired.grouped()
    return factored(design.answer["polynomial"], design.plant.variable).factors


def _over(numerator: Scalar, own: Scalar, polynomial: Factored) -> Factored:
    """Return numerator · own / Π factors: the denominator's factors as asked for, and no factor made monic."""
    unit, above = numerator.factors()
    below = tuple((factor, -power) for factor, power in polynomial.factors)
    return Factored(unit, (*above, (own, 1), *below))


def compensator_matrix(plant: StateSpace, K: Matrix, L: Matrix) -> Matrix:
    """Return A − BK − LC + LDK."""
    m = plant.matrices
    matrix = m.A - m.B @ K - L @ m.C
    return matrix + L @ (m.D @ K) if m.has_feedthrough else matrix


def own_transfer(feedback: StateFeedbackDesign, estimator: ObserverDesign) -> tuple[Scalar, Scalar]:
    """Return the compensator's numerator and det(sI − A + BK + LC − LDK), nothing cancelled between them."""
    m, K, L = feedback.plant.matrices, feedback.answer["K"], estimator.answer["L"]
    if feedback.plant.equations:  # the gains place the poles on the stratum only
        own = modulo(compensator_matrix(feedback.plant, K, L), feedback.plant.ideal)
        return transfer(own, L, K, Scalar.of(0), feedback.plant.variable)
    closed = feedback.answer["polynomial"] * estimator.answer["polynomial"]
    return controller(m.A, m.B, m.C, m.D[0, 0], K, L, closed, feedback.plant.variable)


@method("compensator/separation", source="S0, section 4.3: separation principle, (4.23)-(4.29)")
def separation(plant: StateSpace, control: DesiredPolynomial, observer: DesiredPolynomial) -> CompensatorDesign:
    """Design K as if x were known, design the observer, use x̂ for x."""
    feedback = StateFeedbackDesign.of(plant, control, "ackermann")
    estimator = ObserverDesign.of(plant, observer, "ackermann")
    return CompensatorDesign.of(feedback, estimator, "separation")


@task
def compensator(
    plant: StateSpace,
    *,
    control_poles: Poles = None,
    control_polynomial: PolynomialText = None,
    observer_poles: Poles = None,
    observer_polynomial: PolynomialText = None,
    observer: Name = "full",
    method: Name = "auto",
) -> Result:
    """Design the observer-based compensator U = −F(s) Y with F(s) = K (sI − A + BK + LC − LDK)⁻¹ L.

    plant                                   n states, one input, one output, D allowed
    control_poles or control_polynomial     the n poles of A − BK
    observer_poles or observer_polynomial   the n poles of A − LC
    observer                                `full`: order n
    Returns K, L, F, F_stable, closed_loop_polynomial, closed_loop (P/(1 + PF), F in the return path),
    closed_loop_matrix in (x, e) and
    closed_loop_matrix_estimate in (x, x̂).  Raises `InputError` for wrong poles or shapes.
    Source: S0, section 4.3, (4.23)-(4.29).
    """
    plant = plant.knowing(control_poles, control_polynomial, observer_poles, observer_polynomial)
    plant.require("B", "C", task="compensator")
    require_single(plant.inputs, "input", "compensator")
    require_single(plant.outputs, "output", "compensator")

    def wanted(loop: str, poles: object, polynomial: object) -> DesiredPolynomial | None:
        return desired_polynomial(plant, poles, polynomial, names=(f"{loop}_poles", f"{loop}_polynomial"))

    _, chosen, control, estimate = together(
        lambda: _require_full(observer),
        lambda: choose("compensator", method, "separation"),
        lambda: wanted("control", control_poles, control_polynomial),
        lambda: wanted("observer", observer_poles, observer_polynomial),
    )
    found: Result = chosen.solve(plant, control, estimate).asked(method)
    return found


def _require_full(observer: str) -> None:
    if observer != "full":
        message = f"{observer[:40]!r} is not an observer this version designs"
        raise InputError(message, where="specification.observer", repair='write "full"')
