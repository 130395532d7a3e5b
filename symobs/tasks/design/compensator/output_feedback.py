"""Output feedback with an observer of either kind: the two gains and the closed loop."""

from __future__ import annotations

from functools import cached_property, partial
from typing import TYPE_CHECKING, Any, ClassVar, Self, TypeAlias

from symobs.exact import Factored, Matrix, Scalar, factored, pole_and_zero_polynomial, resultant, roots_of, transfer
from symobs.exact.linear_algebra.transfer_function import Realisation, closed, transfer_matrix
from symobs.formula.tree import Environment, HoldsExactlyWhere, Literal, Quotient, Roots
from symobs.formula.tree.term import Term, identity
from symobs.ground.dataclass import dataclass
from symobs.ground.errors import CertificateRejected
from symobs.ground.on_demand import OnDemand
from symobs.proof.certificate.claims import Certificate, Claim, check
from symobs.proof.derivation.builder import predicate, relation
from symobs.stability.criteria.stability import monic, no_stable_compensator, stability, stable_somewhere
from symobs.stability.inequalities.simplify import as_inequality
from symobs.system.conditions import Condition, sign_of, vanishing_factors
from symobs.tasks.analysis.page_parts import cancelled, over
from symobs.tasks.analysis.strata.strata import places, solved
from symobs.tasks.design.gain.gain_cases import places_where
from symobs.tasks.design.gain.gain_design import letters_of
from symobs.tasks.result import Case, Result, equality
from symobs.tasks.result.control_systems import Controller

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Mapping, Sequence

    from symobs.exact import Root
    from symobs.proof.derivation.builder import Builder
    from symobs.system import StateSpace
    from symobs.system.specification import DesiredPolynomial
    from symobs.tasks.analysis.strata.strata import Place
    from symobs.tasks.design.full_order.observer import ObserverDesign
    from symobs.tasks.design.full_order.state_feedback import StateFeedbackDesign
    from symobs.tasks.design.gain.gain_design import GainDesign
    from symobs.tasks.design.reduced_order.reduced_order_observer import ReducedOrderObserver


#: What one half of a compensator is asked for by: its polynomial, or its gain.
Asked: TypeAlias = "DesiredPolynomial | Matrix"
#: The Hurwitz determinants of a compensator with more terms than this take seconds, and only points are tried.
_DECIDABLE_TERMS = 400


#: What an answer has none of where there is no loop.
_OF_A_LOOP = (
    "F_stable",
    "F_stable_if",
    "F_cancels_where",
    "closed_loop_polynomial",
    "closed_loop",
    "closed_loop_matrix",
    "closed_loop_matrix_estimate",
)


#: What follows from K, L and F, and the property that finds it.
_FOUND = {
    "F_stable": "own_stability", "F_stable_if": "own_stability_where", "F_cancels_where": "cancellations",
    "compensator_stable": "law_stability", "compensator_matrix": "own_matrix",
    "closed_loop_polynomial": "loop_polynomial", "closed_loop": "loop", "closed_loop_unity": "unity_loop",
    "closed_loop_matrix": "error_coordinates", "closed_loop_matrix_estimate": "estimate_coordinates", "family": "families",
}  # fmt: skip


@dataclass
class OutputFeedback(Result):
    """U = −F(s) Y from a state feedback and an observer, each with its own claims.

    Where one of the two is impossible there is no F.
    """

    feedback: StateFeedbackDesign
    estimator: ObserverDesign | ReducedOrderObserver

    task: ClassVar[str] = "compensator"
    answered_by = ("K", "L", "F")
    gains = ("K", "L")
    letters = {
        "K": "K",
        "L": "L",
        "F": "F",
        "closed_loop_polynomial": "chi_cl",
        "closed_loop": "G_cl",
        "closed_loop_matrix": "A_cl",
        "compensator_matrix": "A_c",
        "T": "T",
    }
    panels = ("plane", "responses")
    cards = ("K", "L", "F", "closed_loop_polynomial")

    # -- what a subclass says ----------------------------------------------------------------------------------------

    @classmethod
    def design(cls, plant: StateSpace, asked: Sequence[Asked], name: str) -> Self:
        """Return the compensator for the polynomial, or with the gain, of each half: feedback, estimator."""
        raise NotImplementedError

    @classmethod
    def of(cls, feedback: StateFeedbackDesign, estimator: Any, method_name: str) -> Self:
        """Return the compensator of two designs for one plant."""
        raise NotImplementedError

    @cached_property
    def realisation(self) -> Realisation:
        """F in state space."""
        raise NotImplementedError

    @property
    def coupling(self) -> Matrix:
        """What multiplies the estimation error in u: K, or K₂ with an observer of minimal order."""
        raise NotImplementedError

    @property
    def error_input(self) -> tuple[Matrix, Matrix]:
        """What v moves the error by where it is added to u = −F y, and what of it is left in u."""
        raise NotImplementedError

    @cached_property
    def error_coordinates(self) -> Matrix:
        """The loop in (x, e) or (x, e₂)."""
        raise NotImplementedError

    @cached_property
    def estimate_coordinates(self) -> Matrix:
        """The loop in (x, x̂) or (x, z)."""
        raise NotImplementedError

    @cached_property
    def own_transfer(self) -> tuple[Scalar, Scalar]:
        """F as numerator over denominator, normalised so that χ · denominator + n · numerator is φ_c φ_o for P = n/χ.

        For one input and one output.
        """
        raise NotImplementedError

    def with_answer(self, name: str, value: object) -> Self:
        """Return the compensator with another gain, and with the F that follows from it."""
        if name not in {"K", "L"}:
            return super().with_answer(name, value)
        feedback = self.feedback.with_answer(name, value) if name == "K" else self.feedback
        estimator = self.estimator.with_answer(name, value) if name == "L" else self.estimator
        return type(self).of(feedback, estimator, self.method).in_place_of(self)

    def following_from(self, gains: Mapping[str, Matrix]) -> Self:
        """Return the compensator of given gains."""
        halves = self.feedback.following_from(gains), self.estimator.following_from(gains)
        return self.of(*halves, self.method)

    def design_of(self, gain: str) -> GainDesign:
        """Return the state feedback for K, the observer for L."""
        return self.feedback if gain == "K" else self.estimator.design_of(gain)

    @property
    def halves(self) -> tuple[StateFeedbackDesign | ObserverDesign | ReducedOrderObserver, ...]:
        """The designs of the gains."""
        return self.feedback, self.estimator

    @property
    def unmoved_modes(self) -> tuple[Root, ...]:
        """The modes that no gain moves."""
        return tuple(mode for half in self.halves for mode in half.unmoved_modes)

    @property
    def exists(self) -> bool:
        """Whether there is a compensator."""
        return self.answer["F"] is not None

    def certified(self, environment: Environment) -> Iterator[Claim]:
        """Yield that K and L are the certified gains of the two designs, which are for this plant."""
        for design in self.halves:
            if design.plant is not self.plant and letters_of(design.plant) != letters_of(self.plant):
                raise CertificateRejected(f"{design.letter} is a gain for another plant")
            own, certified = self.answer[design.letter], design.answer[design.letter]
            if own is not certified:
                yield equality(own, certified, environment, f"{design.letter} is the certified gain")

    @property
    def all_certificates(self) -> tuple[Certificate, ...]:
        """The certificates of both gains and of F."""
        return (*(each for half in self.halves for each in half.certificates), *self.certificates)

    # -- what follows ------------------------------------------------------------------------------------------------

    @property
    def verdict(self) -> str:
        """`no` where either gain does not exist; `undecided` where other gains may do what these do not."""
        if not self.exists:
            return "undecided" if self.other_gains_may_do else "no"
        return super().verdict

    @property
    def other_gains_may_do(self) -> bool:
        """Whether only the gains that were chosen, of many with the same poles, leave the law unsolved for u."""
        return False

    @cached_property
    def holds_where(self) -> tuple[Condition, ...]:
        """The conditions of both gains."""
        return tuple({c.expression: c for half in self.halves for c in half.holds_where}.values())

    @cached_property
    def gain_places(self) -> tuple[Place, ...]:
        """Every stratum where (A, B) or (C, A) loses its rank, each of them once."""
        found = (*places_where(self.feedback), *self._estimator_places)
        return tuple({frozenset(place.when): place for place in found}.values())

    @property
    def _estimator_places(self) -> tuple[Place, ...]:
        """The strata of the estimator."""
        raise NotImplementedError

    @cached_property
    def case_tree(self) -> tuple[Case, ...]:
        """The whole compensator on the strata of the gains, and where an unstable F may lose poles."""
        cancelled = places(self.plant, self._cancelling) if self._may_lose_poles else ()
        asked = {frozenset(place.when): place for place in (*self.gain_places, *cancelled)}
        return solved(self.plant, asked.values(), self.on)

    @property
    def _may_lose_poles(self) -> bool:
        """Whether F is unstable only where none of its poles cancels."""
        return self.exists and self._own_stability == "no" and not self._is_unavoidably_unstable

    @cached_property
    def _cancelling(self) -> tuple[Scalar, ...]:
        """What vanishes where poles of F cancel against its zeros; of a matrix that is not asked."""
        F, variable = self.answer["F"], self.plant.variable
        if not self.is_single or self.plant.equations or not F:
            return ()
        return vanishing_factors([resultant(F.numerator, F.denominator, variable)], self.plant.symbols.signs)

    def on(self, plant: StateSpace, values: dict[str, Scalar]) -> Self:
        """Return the compensator on a stratum."""
        asked = tuple(half.substitute(values) for half in self.asked_for[2:])
        kind, name = type(self), self.method
        found: Self = plant.once((kind, *asked, name), lambda: kind.design(plant, asked, name))
        return found

    @property
    def asked_for(self) -> tuple[Any, ...]:
        """The specification of a compensator: its kind and method, and the polynomial or the gain of each half."""
        return type(self), self.method, *(half.desired or half.answer[half.letter] for half in self.halves)

    @property
    def has_given_gain(self) -> bool:
        """Whether one of the gains is given, so that its poles are found, not desired."""
        return any(half.desired is None for half in self.halves)

    @property
    def is_single(self) -> bool:
        """Whether there are one input and one output."""
        return self.plant.inputs == self.plant.outputs == 1

    @property
    def own_matrix(self) -> Matrix:
        """The matrix of the compensator's own state."""
        return self.realisation.A

    @cached_property
    def plant_transfer(self) -> tuple[Scalar, Scalar]:
        """The plant's transfer function as numerator over characteristic polynomial, nothing cancelled; single only."""
        m = self.plant.matrices
        return transfer(m.A, m.B, m.C, m.D[0, 0], self.plant.variable)

    @cached_property
    def plant_function(self) -> Scalar | Matrix:
        """P(s)."""
        if self.is_single:
            numerator, characteristic = self.plant_transfer
            return numerator / characteristic
        m = self.plant.matrices
        return Realisation(m.A, m.B, m.C, m.D).function(self.plant.variable)

    @cached_property
    def loop(self) -> Factored | tuple[tuple[Factored, ...], ...]:
        """(I + PF)⁻¹ P: the plant with F in the return path, checked against its definition."""
        return self.single_loop if self.is_single else self.loop_of_several

    @cached_property
    def loop_of_several(self) -> tuple[tuple[Factored, ...], ...]:
        """The entries of (I + PF)⁻¹ P = [(C − DK)(sI − A + BK)⁻¹B + D] [W + K₂(sI − E)⁻¹V], E and V those of the error.

        What is added to u moves the error, too: ė = E e + V v, u = −K x + K₂ e + W v.
        """
        m, variable, K = self.plant.matrices, self.plant.variable, self.answer["K"]
        V, W = self.error_input
        first, second = range(m.A.shape[0]), range(m.A.shape[0], self.error_coordinates.shape[0])
        A, E = (self.error_coordinates.select(part, part).normal() for part in (first, second))
        above, below = transfer_matrix(A, m.B, (m.C - m.D @ K).normal(), m.D, variable)
        further, own = transfer_matrix(E, V, self.coupling, W, variable)
        product, characteristic = above @ further, below * own
        whole = Matrix.of([[entry / characteristic for entry in row] for row in product.rows])
        values = {"P": self.plant_function, "F": self.answer["F"], "G_cl": whole}
        e = Environment(variable=variable, values=values)
        P, F, G = (e[name] for name in ("P", "F", "G_cl"))
        check(equality((identity(self.plant.outputs, e) + P @ F) @ G, P, e.with_relations(self.plant.relations)))
        return tuple(tuple(factored(entry, variable, monic=False) for entry in row) for row in whole.rows)

    @cached_property
    def single_loop(self) -> Factored:
        """P/(1 + PF)."""
        numerator, characteristic = self.plant_transfer
        P, F = numerator / characteristic, self.answer["F"]
        _, own = self.own_transfer
        polynomial = self.loop_polynomial
        value = numerator * own / polynomial.value
        kept = value.denominator.degree(self.plant.variable) == polynomial.value.degree(self.plant.variable)
        form = over(numerator, own, polynomial) if kept else factored(value, self.plant.variable, monic=False)
        e = Environment(variable=self.plant.variable, values={"P": P, "F": F, "G_cl": value})
        P_, F_, one = e["P"], e["F"], Term(relation(1, 1).members[0], e)
        check(equality(e["G_cl"], P_ / (one + P_ @ F_), e.with_relations(self.plant.relations)))
        return form

    @cached_property
    def unity_loop(self) -> Factored:
        """PF/(1 + PF): from the reference to y with F before the plant and unity feedback; one input, one output."""
        numerator, _ = self.plant_transfer
        own, _ = self.own_transfer
        polynomial, variable = self.loop_polynomial, self.plant.variable
        value = numerator * own / polynomial.value
        kept = value.denominator.degree(variable) == polynomial.value.degree(variable)
        e = Environment(variable=variable, values={"P": self.plant_function, "F": self.answer["F"], "G_r": value})
        P, F, one = e["P"], e["F"], Term(relation(1, 1).members[0], e)
        check(equality(e["G_r"], P @ F / (one + P @ F), e.with_relations(self.plant.relations)))
        return cancelled(numerator, own, polynomial, variable) if kept else factored(value, variable, monic=False)

    @cached_property
    def loop_polynomial(self) -> Factored:
        """φ_c φ_o, with its desired factors."""
        factors: dict[Scalar, int] = {}
        for design in self.halves:
            for factor, power in _factors_of(design):
                factors[factor] = factors.get(factor, 0) + power
        return Factored(Scalar.of(1), tuple(factors.items()))

    @property
    def own_stability(self) -> str:
        """Whether F itself is stable; `conditional` with a stable and an unstable point found, else `undecided`.

        An unstable pole may cancel: where that is no case of its own, nothing is said.
        """
        F, found = self.answer["F"], self._own_stability
        names = F.names.difference(F.field.numbers.names)
        untold = self.plant.equations or (not self.is_single and names != {self.plant.variable})
        return "undecided" if untold and self._may_lose_poles else found

    @cached_property
    def _own_stability(self) -> str:
        """Whether F in general is stable."""
        plant, F = self.plant, self.answer["F"]
        variable, signs, discrete = plant.variable, plant.symbols.signs, plant.is_discrete
        denominator = F.common_denominator()
        if denominator.names > {variable} and self._is_unavoidably_unstable:
            return "no"
        if F.size <= _DECIDABLE_TERMS:
            verdict = stability(denominator, variable, signs, discrete=discrete).verdict
            if verdict != "conditional":
                return verdict
        met = stable_somewhere(denominator, variable, signs, discrete=discrete)
        return "conditional" if len(met) == 2 else "undecided"

    @property
    def own_stability_where(self) -> list[str] | None:
        """The inequalities that hold exactly where F is stable, if this is conditional and F is not too long."""
        plant, F = self.plant, self.answer["F"]
        if self.own_stability != "conditional" or F.size > _DECIDABLE_TERMS:
            return None
        signs = plant.symbols.signs
        found = stability(F.common_denominator(), plant.variable, signs, discrete=plant.is_discrete)
        return found.inequalities(signs) or None

    @cached_property
    def cancellations(self) -> tuple[Condition, ...] | None:
        """Where numerator and denominator of F have a common root, so that its poles are others than in general."""
        F, variable, signs = self.answer["F"], self.plant.variable, self.plant.symbols.signs
        if self.own_stability != "conditional" or not isinstance(F, Scalar) or F.size > _DECIDABLE_TERMS:
            return None
        met = resultant(F.numerator, F.denominator, variable) if F.degree(variable) > 0 else F.numerator
        return tuple(Condition("case", factor, "==") for factor in vanishing_factors([met], signs)) or None

    @cached_property
    def law_stability(self) -> str:
        """Whether the compensator by itself is stable, with the modes that F does not show."""
        return law_stability(self.answer["F"], self.own_matrix, self.plant, self.own_stability)

    @cached_property
    def _is_unavoidably_unstable(self) -> bool:
        """Whether nothing stable stabilises the plant, and the loop's polynomial has only positive coefficients."""
        plant = self.plant
        signs = plant.symbols.signs
        if plant.is_discrete or not self.is_single:
            return False
        wanted = (c for factor, _ in self.loop_polynomial.factors for c in factor.coefficients(plant.variable))
        numerator, characteristic = self.plant_transfer
        return all(sign_of(c, signs) == "positive" for c in wanted) and no_stable_compensator(
            numerator / characteristic, plant.variable, signs
        )

    @property
    def asked_fields(self) -> Mapping[str, Any]:
        """K, L and F."""
        return {name: self.answer[name] for name in ("K", "L", "F")}

    @cached_property
    def fields(self) -> Mapping[str, Any]:
        """The fields of the contract."""
        answers = self.asked_fields
        if not self.exists:
            return {**answers, **dict.fromkeys(_OF_A_LOOP), "fixed_modes": self.unmoved_modes}
        poles = self._found_poles if self.has_given_gain else {}
        known = {name: partial(table.get, name) for table in (answers, poles) for name in table}
        found: dict[str, Callable[[], Any]] = {name: partial(getattr, self, place) for name, place in _FOUND.items()}
        if not self.is_single:
            found["closed_loop_unity"] = lambda: None
        return OnDemand({name: (known | found)[name] for name in (*answers, *found, *poles)})

    @property
    def _found_poles(self) -> Mapping[str, Any]:
        """The poles of the loop and its stability under a given gain."""
        plant, whole = self.plant, self.loop_polynomial.value
        verdict_of_loop = stability(whole, plant.variable, plant.symbols.signs, discrete=plant.is_discrete)
        return {
            "poles": roots_of(whole, plant.variable),
            "stable": verdict_of_loop.verdict,
            "stable_if": verdict_of_loop.inequalities(plant.symbols.signs),
        }

    @property
    def systems(self) -> Mapping[str, Realisation]:
        """The plant, the observer, F, and the plant with F in the return path: u = v − F y."""
        if not self.exists:
            return super().systems
        m, own = self.plant.matrices, self.estimator.systems
        loop = closed(Realisation(m.A, m.B, m.C, m.D), self.realisation)
        return {**own, "compensator": self.realisation, "closed_loop": loop}

    @property
    def controller(self) -> Controller | None:
        """Y → u = −F y."""
        if not self.exists:
            return None
        A, B, C, D = self.realisation
        sizes = (("y", self.plant.outputs),), ("u", self.plant.inputs)
        return Controller("compensator", Realisation(A, B, -C, -D), *sizes, returns=True, gains=("K", "L"))

    @property
    def families(self) -> Mapping[str, Any] | None:
        """The general gains where they are not unique."""
        found = {d.letter: d.gain_family for d in (self.feedback, self.estimator) if d.gain_family is not None}
        return found or None


def _factors_of(design: GainDesign | ReducedOrderObserver) -> tuple[tuple[Scalar, int], ...]:
    if design.desired is not None:
        return design.desired.grouped()
    return factored(design.answer["polynomial"], design.plant.variable).factors


# The modes of a compensator's own state that cancel in F: F may be stable where the law by itself is not.


#: A polynomial of more terms is not decided.
_TERMS = 400
#: The most inputs, or outputs, from all of whose minors the poles of F are found.
_MOST = 3


def hidden_modes(F: Matrix | Scalar, own_matrix: Matrix, variable: str) -> tuple[Scalar, Scalar] | None:
    """Return the polynomial of F's poles, and that of the modes which cancel in F; None where they are too long.

    `own_matrix` is the state matrix of the compensator that F belongs to.
    """
    if isinstance(F, Matrix):
        if F.size > _TERMS or max(F.shape) > _MOST:
            return None
        poles = pole_and_zero_polynomial(F, variable)[0]
    else:
        poles = F.denominator
    if poles.size > _TERMS:
        return None
    own = own_matrix.characteristic_polynomial(variable)
    return poles, monic((own / poles).numerator, variable)


def law_stability(F: Matrix | Scalar, own_matrix: Matrix, plant: StateSpace, stability_of_poles: str) -> str:
    """Return whether the compensator by itself is stable: its poles, and the modes that cancel in F."""
    found = hidden_modes(F, own_matrix, plant.variable)
    if found is None:
        return "undecided"
    hidden = stability(found[1], plant.variable, plant.symbols.signs, discrete=plant.is_discrete).verdict
    if "no" in (hidden, stability_of_poles):
        return "no"
    return stability_of_poles if hidden == "yes" else hidden


def caution_hidden(page: Builder, F: Matrix | Scalar, own_matrix: Matrix) -> None:
    """Warn where a mode that cancels in F is not stable, surely or for some parameters."""
    plant = page.plant
    found = hidden_modes(F, own_matrix, plant.variable)
    if found is None or found[1].degree(plant.variable) < 1:
        return
    poles, hidden = found
    hidden_stability = stability(hidden, plant.variable, plant.symbols.signs, discrete=plant.is_discrete)
    if hidden_stability.verdict == "yes":
        return
    own = page["det(pencil(A_c))"]
    rest = page.term(Quotient(own.formula, Literal(monic(poles, plant.variable))))
    if rest.value != hidden:
        return
    modes = Roots(rest.formula, roots_of(hidden, plant.variable))
    time = "discrete" if plant.is_discrete else "continuous"
    if hidden_stability.verdict == "no":
        page.caution(f"hides_{time}", predicate("unstable", rest), relation(rest, hidden), modes=modes)
        return
    solved = [as_inequality(value, plant.symbols.signs) for value in hidden_stability.positive]
    where = HoldsExactlyWhere(predicate("stable", rest), tuple(relation(*parts) for parts in solved))
    page.caution("some_hidden", relation(rest, hidden), modes=modes, where=where)
