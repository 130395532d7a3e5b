"""The result type of observer gains and feedback gains, with its claims.

A − L C and (A − B K)ᵀ = Aᵀ − Kᵀ Bᵀ are one problem; `PlacementProblem` says in which letters it is written.
"""

from __future__ import annotations

from dataclasses import field, replace
from functools import cache, cached_property
from typing import TYPE_CHECKING, Any, ClassVar, Self

from symobs.exact import EIGENVALUE, Matrix, Root, Scalar, roots_of
from symobs.exact.core.generators import identities
from symobs.formula.tree import Environment, Relation
from symobs.formula.tree.term import Term, identity
from symobs.ground.dataclass import dataclass
from symobs.ground.errors import CertificateRejected, InputError
from symobs.proof.certificate.claims import Claim, Statement
from symobs.proof.derivation.builder import relation
from symobs.stability.criteria.stability import StabilityVerdict, stability
from symobs.system.specification import desired_polynomial, in_common_field, read_entries, read_gain, reject_both
from symobs.tasks.analysis.page_parts import HIDDEN
from symobs.tasks.analysis.strata.strata import region_of
from symobs.tasks.design import readability
from symobs.tasks.design.gain.gain_claims import (
    claims_of_kernel_family,
    excluded_claims,
    has_real_root,
    unassignable_claims,
    zeros_claim,
)
from symobs.tasks.design.gain.gain_kind import (
    AlgebraicGain,
    AssignedGain,
    DecoupledGain,
    GainWithZeros,
    GivenGain,
    NoGainWithZeros,
    SmallGain,
    UnassignableGain,
)
from symobs.tasks.design.pole_placement.choice import small_gain
from symobs.tasks.design.pole_placement.multiple_outputs import (
    Family,
    MultiOutputPair,
    decoupled_claim,
    decoupled_gain,
)
from symobs.tasks.design.pole_placement.sylvester import fresh_names
from symobs.tasks.design.pole_placement.zero_pattern import RootGain, equations_for, obstacles, unknown_gain, with_zeros
from symobs.tasks.result import Result, equality
from symobs.tasks.result import choose as choose_method

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Mapping

    from symobs.proof.derivation.builder import Builder
    from symobs.system import StateSpace
    from symobs.system.specification import DesiredPolynomial, Entries, GainText, Name, Poles, PolynomialText
    from symobs.tasks.analysis.rank.rank_test import RankResult
    from symobs.tasks.design.gain.gain_kind import AskedGain, GainKind, Places
    from symobs.tasks.design.pole_placement.single_output import ObserverPair


@dataclass
class GainDesign(Result):
    """A gain with det(sI − A + LC) = φ(s) (det(sI − A + BK) = φ(s)), or the proof that there is none.

    The answer is the gain by its letter (None where there is none to write) and `polynomial`.
    """

    #: What the gain is: by it the claims, the verdict and the page are told apart.
    kind: GainKind
    #: (A, C) of the observer problem that this is or is dual to, over one field with the desired polynomial.
    pair: ObserverPair = field(compare=False)

    letter: ClassVar[str]
    rank_test: ClassVar[type[RankResult]]

    # -- the dual sides ----------------------------------------------------------------------------------------------

    @staticmethod
    def dual_pair(plant: StateSpace) -> ObserverPair:
        """Return (A, C) of the observer problem that this task is or is dual to."""
        raise NotImplementedError

    @staticmethod
    def transpose_for_task(gain: Matrix) -> Matrix:
        """Return a gain of the observer problem as this task's gain, and the other way round."""
        raise NotImplementedError

    @staticmethod
    def gain_term(environment: Environment) -> Term:
        """Return the term subtracted from A: LC or BK."""
        raise NotImplementedError

    @classmethod
    @cache
    def assignment(cls, order: int) -> Relation:
        """Return the claim of the type: det(sI − A + LC) = φ(s)."""
        e = Environment()
        pencil = e["s"] @ identity(order, e) - e["A"] + cls.gain_term(e)
        return relation(pencil.apply("det"), e["phi"])

    @property
    def gain(self) -> Matrix | None:
        """L or K; None where there is none to write."""
        found: Matrix | None = self.answer[self.letter]
        return found

    # -- construction ------------------------------------------------------------------------------------------------

    @classmethod
    def of(
        cls,
        plant: StateSpace,
        desired: DesiredPolynomial,
        method_name: str,
        zero: Places = (),
        *,
        decoupled: bool = False,
    ) -> Self:
        """Return the design that assigns φ, decoupled or with zeros where that is requested, or the negative result."""
        pair = cls.dual_pair(plant).over_field_of(desired)
        if decoupled:
            return cls._of_kind(plant, method_name, DecoupledGain(desired), pair, decoupled_gain(pair, desired))
        if zero:
            return cls._of_kind(plant, method_name, *cls._with_zeros(pair, desired, zero))
        gain = pair.gain(desired)
        if gain is None:
            return cls._of_kind(plant, method_name, UnassignableGain(desired), pair, None)
        if (small := small_gain(pair, desired, gain)) is not None:
            return cls._of_kind(plant, method_name, SmallGain(desired, gain, small.vectors), pair, small.gain)
        return cls._of_kind(plant, method_name, AssignedGain(desired), pair, gain)

    @classmethod
    def _with_zeros(
        cls, pair: ObserverPair, desired: DesiredPolynomial, zero: Places
    ) -> tuple[AskedGain, ObserverPair, Matrix | None]:
        """Return the kind of a gain with zeros in the given places, and the gain if one was found."""
        match with_zeros(pair, desired, cls.places(zero)):
            case None if pair.can_assign(desired.polynomial):
                return NoGainWithZeros(desired, zero), pair, None
            case None:
                return UnassignableGain(desired, zero), pair, None
            case RootGain() as found:
                return AlgebraicGain(desired, zero, found), pair, None
            case gain:
                return GainWithZeros(desired, zero), pair, gain

    @classmethod
    def _of_kind(
        cls, plant: StateSpace, method_name: str, kind: AskedGain, pair: ObserverPair, gain: Matrix | None
    ) -> Self:
        """Return the design with a gain of the observer problem, or none."""
        own = None if gain is None else cls.transpose_for_task(gain)
        answer = {cls.letter: own, "polynomial": kind.desired.polynomial}
        return cls(plant, method_name, answer, kind=kind, pair=pair)

    @classmethod
    def places(cls, zero: Places) -> Places:
        """Return places of this task's gain as places of that of the observer problem."""
        return zero if cls.letter == "L" else tuple((j, i) for i, j in zero)

    @classmethod
    def by_method(
        cls,
        plant: StateSpace,
        desired: DesiredPolynomial,
        method_name: str,
        gain: Callable[[ObserverPair, DesiredPolynomial], Matrix | None],
    ) -> Self:
        """Return the design whose gain a method finds where all is seen; the common way where it is not, or finds none."""
        pair = cls.dual_pair(plant)
        found = gain(pair, desired) if pair.is_observable else None
        if found is None:
            return cls.of(plant, desired, method_name)
        return cls._of_kind(plant, method_name, AssignedGain(desired), pair, found)

    @classmethod
    def of_given(cls, plant: StateSpace, gain: Matrix) -> Self:
        """Return the design with a given gain, its polynomial found."""
        e = Environment(variable=plant.variable, values=letters_of(plant) | {cls.letter: gain})
        closed = e["A"] - cls.gain_term(e)
        polynomial = closed.value.normal().characteristic_polynomial(plant.variable)
        answer = {cls.letter: gain, "polynomial": polynomial}
        return cls(plant, "given", answer, kind=GivenGain(), pair=cls.dual_pair(plant))

    # -- claims ------------------------------------------------------------------------------------------------------

    def following_from(self, gains: Mapping[str, Matrix]) -> Self:
        """Return the design that a given gain is."""
        return self.of_given(self.plant, gains[self.letter]) if self.letter in gains else self

    def design_of(self, gain: str) -> Self:  # noqa: ARG002 - it has one
        """Return this design."""
        return self

    def claims(self) -> Iterator[Claim | Statement]:
        """Yield det(sI − A + LC) = φ(s) for the gain and its family, or the proof that no gain exists."""
        gain, phi, own, kind = (
            self.answer[self.letter],
            self.answer["polynomial"],
            self.dual_pair(self.plant),
            self.kind,
        )
        if (self.pair.A, self.pair.c) != (own.A, own.c):
            raise CertificateRejected("the witness speaks of another plant")
        if kind.exists != (gain is not None):
            raise CertificateRejected(f"a design has a gain {self.letter} exactly where its kind says so")
        e = Environment(variable=self.plant.variable)
        if kind.desired is not None and phi is not kind.desired.polynomial:
            yield equality(phi, kind.desired.polynomial, e, "the polynomial is the one asked for")
        match kind:
            case UnassignableGain():
                yield from unassignable_claims(self.pair, phi)
                return
            case NoGainWithZeros(desired, zero):
                yield from excluded_claims(
                    self.pair, desired, self.places(zero), self.equations, self.needed, self.letter
                )
                return
            case AlgebraicGain(zero=zero, found=found):
                algebraic = self.transpose_for_task(found.gain)
                yield self.assigned(algebraic, (found.polynomial,))
                yield has_real_root(found, e)
                yield zeros_claim(algebraic, zero, self.letter, e)
                return
        yield self.assigned(gain)
        match kind:
            case DecoupledGain():
                yield decoupled_claim(self.pair, self.transpose_for_task(gain))
            case GainWithZeros(zero=zero):
                yield zeros_claim(gain, zero, self.letter, e)
        if self.gain_family is not None and self.gain_family[self.letter] is not None:
            yield self.assigned(self.gain_family[self.letter])
            if self.chart is None:
                names, general = self.gain_family["parameters"], self.gain_family[self.letter]
                yield from claims_of_kernel_family(
                    self.pair, gain, general, names, self.transpose_for_task, self.letter
                )
        if self.chart is not None:
            yield from self.chart.claims(self.transpose_for_task, self.gain_family)

    def assigned(self, gain: Matrix, relations: tuple[Scalar, ...] = ()) -> Claim:
        """Return the claim that a gain assigns φ, where some polynomials vanish."""
        phi = self.answer["polynomial"]
        values = letters_of(self.plant) | {self.letter: gain, "phi": phi}
        relations = (*relations, *identities(gain.entries)[1])
        e = Environment(variable=self.plant.variable, values=values, relations=relations)
        return Claim(self.assignment(self.plant.order), e)

    # -- what follows ------------------------------------------------------------------------------------------------

    @property
    def desired(self) -> DesiredPolynomial | None:
        """The polynomial that is to be assigned; None where the gain was given."""
        return self.kind.desired

    @property
    def zero(self) -> Places:
        """The entries of the gain that are to vanish."""
        return self.kind.zero

    @property
    def decoupled(self) -> bool:
        """Whether the decoupled member of the family is requested: one equation for each output (input)."""
        return isinstance(self.kind, DecoupledGain)

    @property
    def verdict(self) -> str:
        """`no` where there is no gain; `undecided` where none was found that has zeros in the given places."""
        match self.kind:
            case AlgebraicGain():
                return "yes"
            case UnassignableGain():
                return "no"
            case NoGainWithZeros():
                return "no" if self.needed else "undecided"
            case _:
                return super().verdict

    @cached_property
    def test(self) -> RankResult:
        """The rank test of the pair."""
        return self.rank_test.of(self.plant, "rank")

    @property
    def divides(self) -> bool:
        """Whether the fixed modes are among the desired poles."""
        return self.pair.can_assign(self.answer["polynomial"])

    @cached_property
    def equations(self) -> tuple[Scalar, ...]:
        """What must vanish for a gain with zeros in the given places: polynomials in its other entries."""
        assert self.desired is not None  # noqa: S101 - zeros are asked for together with poles
        general = unknown_gain(self.pair.A.shape[0], self.pair.c.shape[0], self.places(self.zero))
        return tuple(value for value in equations_for(self.pair, self.desired, general) if value)

    @cached_property
    def needed(self) -> tuple[Scalar, ...] | None:
        """What vanishes wherever there is a gain with zeros in the given places, (1,) if none exists; None if not known."""
        return obstacles(self.equations)

    @property
    def existence(self) -> tuple[Scalar, ...]:
        """The existence condition of a gain: det 𝒪 (det 𝒞), or φ modulo the fixed polynomial where that is 0."""
        match self.kind:
            case GivenGain():
                return ()
            case _ if self.pair.is_observable:
                return tuple(self.plant.simplified(value) for value in self.pair.decisive)
            case UnassignableGain():
                return self._obstacles
            case _:
                return ()

    @cached_property
    def _obstacles(self) -> tuple[Scalar, ...]:
        """The coefficients of φ modulo the fixed polynomial, if parameters can make all of them vanish."""
        rest = self.pair.divided(self.answer["polynomial"])[1]
        found = [c.numerator for c in rest.coefficients(self.plant.variable) if not c.is_zero]
        return () if any(c.is_constant for c in found) else tuple(found)

    @cached_property
    def fixed_polynomial(self) -> Scalar:
        """The polynomial of the modes that no gain moves."""
        return Scalar.of(1) if self.pair.is_observable else self.pair.fixed_polynomial

    @cached_property
    def unmoved_modes(self) -> tuple[Root, ...]:
        """The modes that no gain moves."""
        if self.fixed_polynomial.is_one:
            return ()
        return roots_of(self.fixed_polynomial, self.plant.variable)

    @cached_property
    def gain_family(self) -> dict[str, Any] | None:
        """The general gain where it is not unique: `parameters` and the gain with them; None where it is unique."""
        gain, chart = self.answer[self.letter], self.chart
        if chart is not None:
            return chart.fields(self.letter, self.transpose_for_task)
        if gain is None or self.desired is None or self.pair.is_observable:
            return None
        N = self.pair.kernel
        names = fresh_names("g", N.shape[1], self._taken)
        free = Matrix.column([Scalar.symbol(name) for name in names])
        return {
            "parameters": names,
            self.letter: (gain + self.transpose_for_task(N @ free)).normal(),
            "dimension": len(names),
        }

    @cached_property
    def chart(self) -> Family | None:
        """The family of gains for several outputs (inputs), the gain of the answer in it; None for one."""
        gain, pair = self.answer[self.letter], self.pair
        if gain is None or self.desired is None or not isinstance(pair, MultiOutputPair) or identities([gain])[1]:
            return None
        names = fresh_names("g", pair.freedom, self._taken)
        return Family.of(pair, self.desired, names, self.transpose_for_task(gain))

    @property
    def _taken(self) -> tuple[str, ...]:
        """The names that a parameter of the family cannot have."""
        named = self.answer[self.letter].field.names, self.answer["polynomial"].field.names
        return (*self.plant.field.names, *self.plant.symbols.signs, *named[0], *named[1])

    @cached_property
    def stability(self) -> StabilityVerdict:
        """Whether the polynomial is stable, or where."""
        plant = self.plant
        return stability(self.answer["polynomial"], plant.variable, plant.symbols.signs, discrete=plant.is_discrete)

    @cached_property
    def roots(self) -> tuple[Root, ...]:
        """The roots of the polynomial."""
        return roots_of(self.answer["polynomial"], self.plant.variable)

    @property
    def report(self) -> Mapping[str, Any]:
        """Poles, stability and fixed modes: the fields both tasks share."""
        return {
            "poles": self.roots,
            "stable": self.stability.verdict,
            "stable_if": self.stability.inequalities(self.plant.symbols.signs),
            "fixed_modes": self.unmoved_modes,
            "family": self.reported_family,
            **({"zero": [[i + 1, j + 1] for i, j in self.zero]} if self.zero else {}),
            **self._algebraic_report,
        }

    @property
    def reported_family(self) -> Mapping[str, Any] | None:
        """The family, and where no member of it has a value although the answer holds."""
        family, chart = self.gain_family, self.chart
        if family is None or chart is None or "scope" not in family:
            return family
        region = region_of(self.plant)
        held = region.nonzero.union(condition.expression for condition in self.holds_where)
        return family | {"scope": chart.scope(replace(region, nonzero=held))}

    @property
    def _algebraic_report(self) -> Mapping[str, Any]:
        """The root, an interval around it, and the gain in x for the root, where the gain is algebraic."""
        if not isinstance(self.kind, AlgebraicGain):
            return {}
        found = self.kind.found
        x = {EIGENVALUE: Scalar.symbol("x")}
        gain = self.transpose_for_task(found.gain).substitute(x)
        interval = list(found.bounds)
        return {"in_root": {"polynomial": found.polynomial.substitute(x), "interval": interval, self.letter: gain}}


def letters_of(plant: StateSpace) -> dict[str, Scalar | Matrix]:
    """Return the plant's matrices by their letters."""
    m = plant.matrices
    values: dict[str, Scalar | Matrix] = {"A": m.A}
    if m.has_input:
        values["B"] = m.B
    if m.has_output:
        values["C"] = m.C
    if m.has_input and m.has_output:
        values["D"] = m.D
    return values


# The common part of both gain tasks: reading the specification, choosing the method and its page.


#: The members of the family of gains that can be asked for by name.
MEMBERS = ("simple", "decoupled")


def design_gain(
    kind: type[GainDesign],
    plant: StateSpace,
    *,
    poles: Poles,
    polynomial: PolynomialText,
    given: GainText,
    zero: Entries,
    member: Name,
    choose: Name,
    method: Name,
) -> Result:
    """Return the design: with a given gain, with zeros, the requested member of the family, or by a method."""
    if member not in MEMBERS:
        message = f"{member[:40]!r} is no member of the family that has a name"
        raise InputError(message, where="specification.member", repair=f"write one of {', '.join(MEMBERS)}")
    gain, is_observer = kind.letter, kind.letter == "L"
    plant = plant.knowing(poles, polynomial, given)
    plant.require("C" if is_observer else "B", task=kind.task)
    reject_both(gain, given, poles, polynomial)
    reject_both(gain, given, zero, None, other="zero")
    reject_both(gain, given, None if member == "simple" else member, None, other="member")
    chosen_by = None if choose == "auto" else choose
    for name, value in ((gain, given), ("zero", zero), ("member", None if member == "simple" else member)):
        reject_both(name, value, chosen_by, None, other="choose")
    several = plant.outputs if is_observer else plant.inputs
    shape = (plant.order, several) if is_observer else (several, plant.order)
    if given is not None:
        return kind.of_given(plant, read_gain(given, plant, gain, shape))
    desired = desired_polynomial(plant, poles, polynomial, choose=choose)
    assert desired is not None  # noqa: S101 - required
    plant, (desired,) = in_common_field(plant, desired)
    chosen = choose_method(kind.task, method, "ackermann" if several == 1 else "sylvester")
    if member != "simple":
        reject_both("member", member, zero, None, other="zero")
        return kind.of(plant, desired, chosen.name, decoupled=True).asked(method)
    if zero is not None:
        return kind.of(plant, desired, chosen.name, read_entries(zero, "zero", shape)).asked(method)
    return chosen.solve(plant, desired).asked(method)


def page_style(method_name: str, plant: StateSpace, *, several: bool = False) -> str:
    """Return the method of the page: by default canonical form for small plants."""
    if method_name != "auto":
        return method_name
    if several:
        return "sylvester"
    readable = (
        readability.CANONICAL_FORM_ORDER if not plant.field.names else readability.PARAMETRIC_CANONICAL_FORM_ORDER
    )
    return "canonical_form" if plant.order <= readable else "ackermann"


# The letters and phrases of one side of pole placement: observers of (C, A) and state feedback of (A, B) are dual.


@dataclass
class PlacementProblem:
    """The words and letters of one side of pole placement."""

    kind: str
    gain: str
    matrix: str
    test: str
    index: str
    coefficient: str

    @property
    def hidden(self) -> tuple[str, str]:
        """The letters of the hidden subspace, different for the two sides."""
        return HIDDEN[self.test]

    @property
    def phi(self) -> str:
        """The letter of the desired polynomial."""
        return f"phi_{self.index}"

    @property
    def is_dual(self) -> bool:
        """Whether a gain is found for (Aᵀ, Cᵀ) and transposed."""
        return self.gain == "L"

    def pair(self, page: Builder) -> tuple[Term, Term]:
        """Return (Aᵀ, Cᵀ) or (A, B), for which a row is found."""
        return (page["A.T"], page["C.T"]) if self.is_dual else (page["A"], page["B"])

    def closed_loop_matrix(self, page: Builder) -> Term:
        """Return A − LC or A − BK."""
        return page["A"] - self._gain_term(page)

    def error_determinant(self, page: Builder) -> Term:
        """Return det(sI − A + LC) or det(sI − A + BK)."""
        return page("det(pencil(A) + {gain_term})", gain_term=self._gain_term(page))

    def _gain_term(self, page: Builder) -> Term:
        return page["L C"] if self.is_dual else page["B K"]


OBSERVER = PlacementProblem("observer", "L", "O", "observability", "o", "beta_")
FEEDBACK = PlacementProblem("state_feedback", "K", "Ctr", "controllability", "c", "alpha_")
