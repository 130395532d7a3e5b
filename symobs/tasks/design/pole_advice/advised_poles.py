"""The poles advised for an observer and what must hold of them; what parameters change is asked in `pole_advice`."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from functools import cached_property
from typing import TYPE_CHECKING, Any, ClassVar, Self

from symobs.exact import (
    Complex,
    Factored,
    Root,
    Scalar,
    apply_polynomial,
    factored,
    from_coefficients,
    product_of,
    roots_of,
    transfer,
)
from symobs.exact.algebraic.enclosure import is_number, sign_of_number
from symobs.exact.core.generators import NotWritten, function, function_named, identities, square_root
from symobs.exact.time_functions.antiderivative import butterworth, butterworth_angles, twice_cosine
from symobs.formula.phrases import PHRASES
from symobs.formula.phrases.languages import COUNTED
from symobs.formula.tree import Environment, Literal
from symobs.formula.tree.term import Term
from symobs.ground.dataclass import dataclass
from symobs.ground.errors import CertificateRejected, InputError
from symobs.proof.certificate.claims import Claim
from symobs.proof.derivation.builder import relation
from symobs.stability.criteria.stability import is_beyond, no_stable_compensator, on_boundary, stability
from symobs.system.conditions import Condition, sign_of, vanishing_factors
from symobs.system.specification.pole_patterns import overshoot_of, pair_ratio
from symobs.tasks.analysis.rank.observability import Controllability, Observability
from symobs.tasks.analysis.strata.loci import loci
from symobs.tasks.analysis.strata.strata import carried, equations_of_locus, region_of, strata
from symobs.tasks.design.pole_placement.single_output import ObserverPair
from symobs.tasks.result import Case, Result, equality, holds

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from symobs.system import StateSpace


# Candidate observer poles: stable plant zeros, Butterworth points, and a dominant pair for a given overshoot.


#: Why a zero is not used that is a place for a pole under conditions on the parameters.
OPEN = frozenset({"zero_open", "zero_slow_open"})


@dataclass
class PlantZeros:
    """A plant's numerator as a unit and monic factors: those with stable roots, and the others, each with the reason."""

    unit: Scalar
    used: tuple[tuple[Scalar, int], ...]
    unused: tuple[tuple[Scalar, int, str], ...]

    @staticmethod
    def of(numerator: Scalar, plant: StateSpace, sigma: Scalar | None, taken: tuple[Scalar, ...] = ()) -> PlantZeros:
        """Sort the zeros: those in Re s < 0, with σ in Re s < −σ, are used, and those `taken` for being there."""
        used: list[tuple[Scalar, int]] = []
        unused: list[tuple[Scalar, int, str]] = []
        if numerator.is_zero:
            return PlantZeros(numerator, (), ())
        form = factored(numerator, plant.variable)
        for factor, power in form.factors:
            for part in _parts(factor, plant.variable):
                reason = "" if part in taken else _reason(part, plant, sigma)
                if reason:
                    unused.append((part, power, reason))
                else:
                    used.append((part, power))
        return PlantZeros(form.unit, tuple(used), tuple(unused))

    @property
    def polynomial(self) -> Scalar:
        """The product of the factors that are used."""
        return product_of(factor**power for factor, power in self.used)

    @property
    def others(self) -> Scalar:
        """What is left of the numerator."""
        return self.unit * product_of(factor**power for factor, power, _ in self.unused)


def _parts(factor: Scalar, variable: str) -> tuple[Scalar, ...]:
    """Return an irreducible factor, or its two linear ones where its roots are real numbers on both sides of 0."""
    coefficients = factor.coefficients(variable)
    if len(coefficients) != 3 or factor.names != {variable} or coefficients[2].fraction() >= 0:
        return (factor,)
    s, centre = Scalar.symbol(variable), -coefficients[1] / 2
    distance = square_root(centre**2 - coefficients[2])
    return s - centre + distance, s - centre - distance


def _reason(factor: Scalar, plant: StateSpace, sigma: Scalar | None) -> str:
    """Return why the roots of a factor are no places for poles; nothing where they are."""
    signs, variable = plant.symbols.signs, plant.variable
    verdict = stability(factor, variable, signs, discrete=False).verdict
    further = (
        verdict
        if sigma is None
        else stability(_moved(factor, sigma, variable), variable, signs, discrete=False).verdict
    )
    if verdict == "yes":
        return {"yes": "", "no": "zero_slow", "conditional": "zero_slow_open"}[further]
    if factor == Scalar.symbol(variable):
        return "zero_at_origin"
    if on_boundary(factor, variable, signs, discrete=False):
        return "zero_on_axis"
    if verdict == further == "conditional":
        return "zero_open"
    far = factor.substitute({variable: -Scalar.symbol(variable)})
    lead = far.coefficients(variable)[0]
    if stability(far / lead, variable, signs, discrete=False).verdict == "yes":
        return "zero_right"
    return "zero_mixed" if _on_both_sides(factor, variable, signs) else "zero_never"


def _on_both_sides(factor: Scalar, variable: str, signs: Mapping[str, str]) -> bool:
    """Return whether an irreducible factor surely has roots on both sides of the axis, and not all of them on one.

    With numbers for coefficients what is neither stable, nor on the axis, nor all on the right.  With parameters this is
    seen of two roots whose product is negative.
    """
    lead, *_, last = factor.coefficients(variable)
    if factor.names == {variable}:
        return is_beyond(factor, variable, signs, discrete=False)
    return factor.degree(variable) == 2 and sign_of(last / lead, signs) == "negative"


def needed_of(factor: Scalar, signs: Mapping[str, str], sigma: Scalar | None, variable: str) -> tuple[Scalar, ...]:
    """Return what must be positive for the roots of a factor to be places for poles, where that is open."""
    moved = factor if sigma is None else _moved(factor, sigma, variable)
    return stability(moved, variable, signs, discrete=False).positive


def _moved(factor: Scalar, sigma: Scalar, variable: str) -> Scalar:
    """Return the factor whose roots lie σ further right."""
    return factor.substitute({variable: Scalar.symbol(variable) - sigma})


def normalised(factor: Scalar, radius: Scalar, variable: str) -> Scalar:
    """Return a factor of a polynomial in s and ω₀ in units of ω₀."""
    return factor.substitute({variable: Scalar.symbol(variable) * radius}) / radius ** factor.degree(variable)


def poles_of(count: int, radius: Scalar) -> tuple[Complex, ...]:
    """Return Butterworth's poles as complex numbers: −ω₀ where N is odd, then the pairs."""
    found = [Complex.of(-radius)] if count % 2 else []
    for turns in butterworth_angles(count):
        pole = Complex(-radius * twice_cosine(turns) / 2, radius * twice_cosine(Fraction(1, 2) - turns) / 2)
        found += [pole, pole.conjugate()]
    return tuple(found)


def pair_poles(count: int, sigma: Scalar, omega_d: Scalar | None) -> tuple[Complex, ...]:
    """Return −σ ± iω, or −σ where one pole is left."""
    if omega_d is None:
        return (Complex.of(-sigma),) if count else ()
    pole = Complex(-sigma, omega_d)
    return pole, pole.conjugate()


def as_number(root: Root) -> Complex | Root:
    """Return a root as a complex number with square roots, as it is where its radicand has no sign or no form."""
    if not root.is_closed:
        return root
    if root.radicand.is_zero:
        return Complex.of(root.centre)
    if not root.radicand.is_constant:
        return root
    size = root.radicand.fraction()
    distance = square_root(Scalar.of(abs(size))) * root.sign
    if size > 0:
        return Complex.of(root.centre + distance)
    return Complex(root.centre, distance)


def numerator_of(plant: StateSpace) -> Scalar:
    """Return C adj(sI − A) B + D det(sI − A), nothing cancelled."""
    m = plant.matrices
    found = transfer(m.A, m.B, m.C, m.D[0, 0], plant.variable)[0]
    if not plant.equations:
        return found
    return from_coefficients([plant.simplified(c) for c in found.coefficients(plant.variable)], plant.variable)


# Parameter values at which the advice changes: zeros on the axis or lost, modes that become unobservable.


def cases_of(advice: AdvisedPoles) -> tuple[Case, ...]:
    """Return the advice where zeros are stable that need not be, and on the strata where zeros or modes are lost."""
    return (*_of_open_zeros(advice), *_of_strata(advice))


def existence_of(plant: StateSpace, numerator: Scalar) -> tuple[Condition, ...]:
    """Return the conditions for as many zeros as in general, and for a plant all of whose modes are seen and moved."""
    tests = [test.of(plant, "rank") for test in (Observability, Controllability)]
    found = [c for test in tests for c in test.holds_where if c.kind == "existence"]
    return tuple(dict.fromkeys((*(Condition("existence", f) for f in _lead(plant, numerator)), *found)))


def _lead(plant: StateSpace, numerator: Scalar) -> tuple[Scalar, ...]:
    return vanishing_factors([numerator.coefficients(plant.variable)[0]], plant.symbols.signs) if numerator else ()


def _of_open_zeros(advice: AdvisedPoles) -> Iterator[Case]:
    """Yield, for each factor whose roots are places for poles under conditions only, the advice under these.

    Within it the factors before stay unused: where those are stable too, their own case comes first.
    """
    taken = advice.taken
    opened = [factor for factor, _, reason in advice.zeros.unused if reason in OPEN]
    after = opened[opened.index(advice.passed) + 1 :] if advice.passed in opened else opened
    for factor in after:
        conditions = tuple(
            Condition("claim", value, ">")
            for value in needed_of(factor, advice.plant.symbols.signs, advice.answer["sigma"], advice.plant.variable)
        )
        try:
            there = type(advice).of(advice.plant, advice.request, advice.method, (*taken, factor))
        except InputError:  # a circle that square roots do not write
            yield Case(conditions, {}, None)
        else:
            yield Case(conditions, {}, there)


def _of_strata(advice: AdvisedPoles) -> tuple[Case, ...]:
    """Return the advice on every stratum where a zero is lost, or a mode is not seen or not moved."""
    if advice.taken:
        return ()  # they are those of the advice in general
    plant = advice.plant

    def solve(there: StateSpace, values: Mapping[str, Scalar]) -> AdvisedPoles:
        request, radius = advice.request, advice.request.radius
        moved = request if radius is None else replace(request, radius=radius.substitute(values))
        try:
            return type(advice).of(there, moved, advice.method)
        except InputError as error:
            raise NotWritten(str(error)) from error

    found = strata(plant, _lead(plant, advice.numerator), solve)
    for test in (Observability, Controllability):
        found += carried(plant, test.of(plant, "rank").case_tree, solve)
    found += tuple(_of_kept_modes(advice))
    return tuple({case.when: case for case in found}.values())


def _of_kept_modes(advice: AdvisedPoles) -> Iterator[Case]:
    """Yield where modes that no gain moves are among the poles after all: there nothing is decided here."""
    if advice.missed.is_one:
        return
    rest = advice.pair.divided(advice.answer["polynomial"].value)[1]
    left = [c.numerator for c in rest.coefficients(advice.plant.variable) if not c.is_zero]
    if not any(c.is_constant for c in left) and not any(function_named(name) for c in left for name in c.names):
        for locus in loci(left, region_of(advice.plant)):
            yield Case(equations_of_locus(locus), {}, None)


# Warnings about observer poles; each one is also a sentence of the page.


#: Zero and pole are near each other where they differ by less than this part of the zero.
_NEAR = 10
#: A gain is huge where an entry is more than this many times the largest of A, and of 1.
_HUGE = 100


@dataclass
class PoleWarning:
    """A phrase with what stands in its slots: a factor of the numerator, a pole of the plant, a number."""

    key: str
    slots: tuple[tuple[str, Scalar], ...] = ()
    variable: str = "s"

    def __str__(self) -> str:
        several = any(name == "zero" and value.degree(self.variable) > 1 for name, value in self.slots)
        phrase = COUNTED.sub(lambda words: words[2 if several else 1], PHRASES[self.key])
        return phrase.replace("$", "").format(**{name: self._text(name, v) for name, v in self.slots})

    def _text(self, name: str, value: Scalar) -> str:
        if name == "pole":
            return f"{self.variable} = {value}"
        if name == "zero" and value.degree(self.variable) == 1:
            return f"{self.variable} = {-value.coefficients(self.variable)[1]}"
        return f"{value} = 0" if name == "zero" else str(value)


def warnings_of(
    plant: StateSpace, zeros: PlantZeros, polynomial: Factored, pair: ObserverPair, missed: Scalar
) -> tuple[PoleWarning, ...]:
    """Return the warnings: of zeros that are no places for poles, cancellations, the compensator, the gain, fixed modes."""
    return (
        *_of_zeros(zeros, plant.variable),
        *_of_cancellations(plant, zeros),
        *_of_compensator(plant),
        *_of_gain(plant, polynomial, pair),
        *([] if missed.is_one else [PoleWarning("modes_missed", (("polynomial", missed),))]),
    )


def _of_zeros(zeros: PlantZeros, variable: str) -> Iterator[PoleWarning]:
    if zeros.unit.is_zero:
        yield PoleWarning("no_response")
    for factor, _, reason in zeros.unused:
        alone = reason == "zero_at_origin" or factor.degree(variable) == 1
        yield PoleWarning(reason if alone or reason == "zero_slow" else f"{reason}s", (("zero", factor),), variable)


def _of_cancellations(plant: StateSpace, zeros: PlantZeros) -> Iterator[PoleWarning]:
    """Compare the rational zeros with the rational poles."""
    chi = plant.matrices.A.characteristic_polynomial(plant.variable)
    if zeros.unit.is_zero or chi.names != {plant.variable}:
        return
    factors = [*(f for f, _ in zeros.used), *(f for f, _, _ in zeros.unused)]
    poles = {root.centre for root in roots_of(chi, plant.variable) if root.factor.degree(plant.variable) == 1}
    for factor in factors:
        zero = -factor.coefficients(plant.variable)[1]
        if factor.degree(plant.variable) != 1 or not zero.is_constant:
            continue
        for pole in sorted(poles, key=lambda p: p.fraction()):
            distance = abs(zero.fraction() - pole.fraction())
            if _NEAR * distance < abs(zero.fraction()) or not distance:
                key = "nearly_cancels" if distance else "cancels"
                yield PoleWarning(key, (("zero", factor), ("pole", pole)), plant.variable)


def _of_compensator(plant: StateSpace) -> Iterator[PoleWarning]:
    """Warn where no compensator that is stable itself can stabilise the plant."""
    P = numerator_of(plant) / plant.matrices.A.characteristic_polynomial(plant.variable)
    if P and no_stable_compensator(P, plant.variable, plant.symbols.signs):
        yield PoleWarning("always_unstable")


def _of_gain(plant: StateSpace, polynomial: Factored, pair: ObserverPair) -> Iterator[PoleWarning]:
    """Warn of a gain with an entry far beyond those of the plant, where all are numbers."""
    A = plant.matrices.A
    if A.names or plant.matrices.C.names or not pair.is_observable:
        return
    factors = [factor for factor, power in polynomial.factors for _ in range(power)]
    if any(not is_number(c) for factor in factors for c in factor.coefficients(plant.variable)):
        return
    gain = apply_polynomial(factors, plant.variable, A, pair.krylov.solve_last())
    limit = _HUGE * max(Fraction(1), *(abs(entry.fraction()) for entry in A.entries))
    for entry in gain.entries:
        if "positive" in (sign_of_number(entry - limit), sign_of_number(-entry - limit)):
            yield PoleWarning("huge_gain", (("limit", Scalar.of(limit)),))
            return


#: The poles besides a dominant pair begin at this many times its distance from the imaginary axis.
FURTHER_LEFT = 5


@dataclass
class PoleRequest:
    """A radius, or a settling time and an overshoot."""

    radius: Scalar | None = None
    settling_time: Scalar | None = None
    overshoot: Scalar | None = None


@dataclass
class AdvisedPoles(Result):
    """φ = φ_z φ_r: φ_z has the plant's stable zeros, φ_r the remaining N poles.

    With a radius ω₀ φ_r(s) φ_r(−s) = ω₀^{2N} + (−1)^N s^{2N}; with a settling time T and an overshoot M φ_r begins with a
    pair −σ ± iω, σ = 4/T, exp(−πσ/ω) ≤ M.
    """

    request: PoleRequest
    #: Factors of the numerator whose roots are places for poles under conditions: here these hold.
    taken: tuple[Scalar, ...] = ()

    task: ClassVar[str] = "pole_advice"
    answered_by = ("poles",)
    letters = {"polynomial": "phi", "sigma": "sigma_d", "omega_d": "omega_d"}

    @classmethod
    def of(cls, plant: StateSpace, request: PoleRequest, method_name: str, taken: tuple[Scalar, ...] = ()) -> Self:
        """Return the advice; raises `InputError` where a circle's poles have no square roots."""
        sigma = None if request.settling_time is None else 4 / request.settling_time
        zeros = PlantZeros.of(numerator_of(plant), plant, sigma, taken)
        count = plant.order - zeros.polynomial.degree(plant.variable)
        omega_d = None
        if request.radius is not None:
            rest = on_circle(count, request.radius, plant.variable)
        else:
            assert sigma is not None and request.overshoot is not None  # noqa: S101, PT018 - one of two ways to ask
            omega_d = sigma * pair_ratio(request.overshoot) if count > 1 else None
            rest = dominated(count, sigma, omega_d, plant.variable)
        one = Scalar.of(1)
        answer: dict[str, Any] = {"zeros": zeros.polynomial, "sigma": sigma, "omega_d": omega_d}
        answer["rest"] = Factored(one, tuple((factor, 1) for factor in rest))
        together = dict(zeros.used)
        for factor in rest:
            together[factor] = together.get(factor, 0) + 1
        answer["polynomial"] = Factored(one, tuple(together.items()))
        return cls(plant, method_name, answer, request, taken)

    @cached_property
    def zeros(self) -> PlantZeros:
        """The plant's zeros: those that are used, and why the others are not."""
        return PlantZeros.of(self.numerator, self.plant, self.answer["sigma"], self.taken)

    @cached_property
    def numerator(self) -> Scalar:
        """C adj(sI − A) B + D det(sI − A), nothing cancelled."""
        return numerator_of(self.plant)

    @property
    def passed(self) -> Scalar | None:
        """The last of the factors that are taken for stable."""
        return self.taken[-1] if self.taken else None

    @property
    def count(self) -> int:
        """The number N of poles that are not at zeros."""
        zeros: Scalar = self.answer["zeros"]
        return self.plant.order - zeros.degree(self.plant.variable)

    # -- claims ------------------------------------------------------------------------------------------------------

    def claims(self) -> Iterator[Claim]:
        """Yield that φ_z divides the numerator and is stable, what φ_r is, that φ is their product, and fixed modes."""
        variable, m, answer = self.plant.variable, self.plant.matrices, self.answer
        rest, zeros = answer["rest"].value, answer["zeros"]
        self._hold_to_the_left(rest)
        values = {**{name: getattr(m, name) for name in "ABCD"}, "phi_z": zeros, "phi_r": rest}
        values["phi_o"] = answer["polynomial"].value
        e = Environment(variable=variable, values=values, signs=self.plant.symbols.signs)
        e = e.with_relations(identities([zeros, rest])[1])
        z = e["phi_z"]
        yield equality(numerator_term(e, self.plant), z @ Term(Literal(self.zeros.others), e), e)
        yield holds(e, "phi_o = phi_z phi_r")
        if not self.count:
            yield holds(e, "phi_r = 1")
        elif self.request.radius is not None:
            yield holds(e, "phi_r phi_r_at(-s) = {circle}", "phi_r(s) phi_r(-s) is Butterworth's", circle=self.circle)
        else:
            yield from self._claims_of_pair(e)
        yield from self._claims_of_fixed_modes()

    @property
    def circle(self) -> Scalar:
        """ω₀^{2N} + (−1)^N s^{2N}."""
        radius, count = self.request.radius, self.count
        assert radius is not None  # noqa: S101 - asked only where there is one
        power = Scalar.symbol(self.plant.variable) ** (2 * count)
        return radius ** (2 * count) + (power if count % 2 == 0 else -power)

    def _hold_to_the_left(self, rest: Scalar) -> None:
        """Reject poles in the right half-plane: of zeros, and of φ_r in units of the radius."""
        signs, variable = self.plant.symbols.signs, self.plant.variable
        factors = [factor for factor, _ in self.answer["rest"].factors]
        if self.request.radius is not None:
            factors = [normalised(factor, self.request.radius, variable) for factor in factors]
        used = [factor for factor, _ in self.zeros.used]
        held = [f for f in (*used, *factors) if f not in self.taken]
        stable = all(stability(f, variable, signs, discrete=False).verdict == "yes" for f in held)
        stable = stable and all(needed_of(f, signs, self.answer["sigma"], variable) for f in self.taken)
        whole = rest.degree(variable) == self.count and rest.coefficients(variable)[0].is_one
        if not stable or not whole or self.answer["zeros"] != self.zeros.polynomial:
            message = "the poles advised are the stable zeros and as many more in the left half-plane as are missing"
            raise CertificateRejected(message)

    def _claims_of_pair(self, e: Environment) -> Iterator[Claim]:
        """Yield σT = 4, e^{−σT} ≤ 1/50, exp(−πσ/ω) ≤ M, and φ_r as the pair and what lies further left."""
        sigma, omega_d, request = self.answer["sigma"], self.answer["omega_d"], self.request
        assert request.settling_time is not None and request.overshoot is not None  # noqa: S101, PT018
        product = sigma * request.settling_time
        yield equality(product, 4, e)
        yield Claim(relation(function("exp", -product), "<=", Scalar.of(Fraction(1, 50))), e)
        if (omega_d is None) != (self.count < 2):
            raise CertificateRejected("two poles and more begin with a pair")
        if omega_d is not None:
            yield Claim(relation(overshoot_of(omega_d / sigma), "<=", request.overshoot), e)
        expected = product_of(dominated(self.count, sigma, omega_d, self.plant.variable))
        yield holds(e, "phi_r = {expected}", expected=expected)

    def _claims_of_fixed_modes(self) -> Iterator[Claim]:
        """Yield the claim that the modes missing among the poles are unobservable."""
        if self.missed.is_one:
            return
        pair, variable = self.pair, self.plant.variable
        m, N, X = self.plant.matrices, self.pair.kernel, self.pair.restricted
        size = N.shape[1]
        e = Environment(variable=variable, values={"A": m.A, "C": m.C, "N": N, "X": X})
        yield holds(e, "C N = 0")
        yield holds(e, "A N = N X")
        yield holds(e, "rank(N) = {size}", size=size)
        yield holds(e, "det(pencil(X)) = {fixed_polynomial}", fixed_polynomial=pair.fixed_polynomial)

    # -- what follows ------------------------------------------------------------------------------------------------

    @cached_property
    def pair(self) -> ObserverPair:
        """(A, C)."""
        m = self.plant.matrices
        return ObserverPair(m.A, m.C, self.plant.variable, self.plant.equations)

    @cached_property
    def missed(self) -> Scalar:
        """The polynomial of the unobservable modes where it does not divide φ, else 1."""
        if self.pair.is_observable or self.pair.divided(self.answer["polynomial"].value)[1].is_zero:
            return Scalar.of(1)
        return self.pair.fixed_polynomial

    @cached_property
    def places(self) -> tuple[Complex | Root, ...]:
        """All n poles, with multiplicity: the zeros first."""
        radius, sigma = self.request.radius, self.answer["sigma"]
        if radius is not None:
            return (*self.places_used, *poles_of(self.count, radius))
        pair = pair_poles(self.count, sigma, self.answer["omega_d"])
        return (*self.places_used, *pair, *(Complex.of(-place) for place in further_left(self.count, sigma)))

    @cached_property
    def places_used(self) -> tuple[Complex | Root, ...]:
        """The zeros at which poles are put, with multiplicity."""
        return tuple(
            as_number(root)
            for factor, power in self.zeros.used
            for _ in range(power)
            for root in roots_of(factor, self.plant.variable)
        )

    @cached_property
    def cautions(self) -> tuple[PoleWarning, ...]:
        """What an expert would warn of."""
        return warnings_of(self.plant, self.zeros, self.answer["polynomial"], self.pair, self.missed)

    @cached_property
    def fields(self) -> Mapping[str, Any]:
        """The fields of the contract; σ and ω of the pair where there is one."""
        found = {"poles": list(self.places), "polynomial": self.answer["polynomial"]}
        found |= {"zeros_used": list(self.places_used), "warnings": [str(warning) for warning in self.cautions]}
        if self.request.radius is None:
            found |= {"sigma": self.answer["sigma"], "omega_d": self.answer["omega_d"]}
        return found


def numerator_term(e: Environment, plant: StateSpace) -> Term:
    """Return C adj(sI − A) B + D det(sI − A) as a formula."""
    pencil = e["A"].pencil
    found = e["C"] @ pencil.apply("adj") @ e["B"]
    return found + e["D"] @ pencil.apply("det") if plant.matrices.has_feedthrough else found


def on_circle(count: int, radius: Scalar, variable: str) -> tuple[Scalar, ...]:
    """Return Butterworth's factors; raises `InputError` where square roots do not write them."""
    try:
        return butterworth(count, radius, variable)
    except NotWritten:
        message = f"the {count} poles on a circle are not written with square roots"
        repair = "give settling_time and overshoot instead of radius, or name the poles yourself"
        raise InputError(message, where="specification.radius", repair=repair) from None


def further_left(count: int, sigma: Scalar) -> tuple[Scalar, ...]:
    """Return 5σ, 6σ, …: how far left the poles besides a pair are."""
    return tuple(sigma * (FURTHER_LEFT + k) for k in range(count - 2))


def dominated(count: int, sigma: Scalar, omega_d: Scalar | None, variable: str) -> tuple[Scalar, ...]:
    """Return (s + σ)² + ω² and factors further left; s + σ where one pole is left."""
    s = Scalar.symbol(variable)
    if omega_d is None:
        return (s + sigma,) if count else ()
    return ((s + sigma) ** 2 + omega_d**2, *(s + place for place in further_left(count, sigma)))
