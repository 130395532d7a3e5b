"""The poles advised for an observer and what must hold of them; what parameters change is asked in `pole_advice`."""

from __future__ import annotations

from fractions import Fraction
from functools import cached_property
from typing import TYPE_CHECKING, Any, ClassVar, Self

from symobs.exact import Complex, Factored, Matrix, Root, Scalar, product_of, roots_of
from symobs.exact.core.generators import NotWritten, function, identities
from symobs.exact.time_functions.butterworth import butterworth
from symobs.formula.tree import Environment, Literal
from symobs.formula.tree.term import Term, identity, letter
from symobs.ground.dataclass import dataclass
from symobs.ground.errors import CertificateRejected, InputError
from symobs.proof.certificate.claims import Claim
from symobs.proof.derivation.builder import relation
from symobs.stability.criteria.stability import stability
from symobs.system.specification.pole_patterns import overshoot_of, pair_ratio
from symobs.tasks.design.pole_advice.pole_candidates import (
    PlantZeros,
    as_number,
    needed_of,
    normalised,
    numerator_of,
    pair_poles,
    poles_of,
)
from symobs.tasks.design.pole_advice.pole_warnings import warnings_of
from symobs.tasks.design.pole_placement.single_output import ObserverPair
from symobs.tasks.result import Result

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from symobs.system import StateSpace
    from symobs.tasks.design.pole_advice.pole_warnings import PoleWarning

#: The poles besides a dominant pair begin at this many times its distance from the imaginary axis.
FURTHER_LEFT = 5


@dataclass(frozen=True)
class PoleRequest:
    """A radius, or a settling time and an overshoot."""

    radius: Scalar | None = None
    settling_time: Scalar | None = None
    overshoot: Scalar | None = None


@dataclass(frozen=True, eq=False, repr=False)
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
        z, r, s = (letter(name, e) for name in ("phi_z", "phi_r", "s"))
        yield Claim(relation(numerator_term(e, self.plant), z @ Term(Literal(self.zeros.others), e)), e)
        yield Claim(relation(letter("phi_o", e), z @ r), e)
        if not self.count:
            yield Claim(relation(r, 1), e)
        elif self.request.radius is not None:
            yield Claim(relation(r @ (-s).apply("phi_r_at"), self.circle), e, "phi_r(s) phi_r(-s) is Butterworth's")
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
            raise CertificateRejected(message, repair="please report this: it is a bug of symobs")

    def _claims_of_pair(self, e: Environment) -> Iterator[Claim]:
        """Yield σT = 4, e^{−σT} ≤ 1/50, exp(−πσ/ω) ≤ M, and φ_r as the pair and what lies further left."""
        sigma, omega_d, request = self.answer["sigma"], self.answer["omega_d"], self.request
        assert request.settling_time is not None and request.overshoot is not None  # noqa: S101, PT018
        product = sigma * request.settling_time
        yield Claim(relation(product, 4), e, "sigma*T = 4")
        yield Claim(relation(function("exp", -product), "<=", Scalar.of(Fraction(1, 50))), e)
        if (omega_d is None) != (self.count < 2):
            message = "two poles and more begin with a pair"
            raise CertificateRejected(message, repair="please report this: it is a bug of symobs")
        if omega_d is not None:
            yield Claim(relation(overshoot_of(omega_d / sigma), "<=", request.overshoot), e)
        expected = product_of(dominated(self.count, sigma, omega_d, self.plant.variable))
        yield Claim(relation(letter("phi_r", e), expected), e, "phi_r = (pair)(further left)")

    def _claims_of_fixed_modes(self) -> Iterator[Claim]:
        """Yield the claim that the modes missing among the poles are unobservable."""
        if self.missed.is_one:
            return
        pair, variable = self.pair, self.plant.variable
        m, N, X = self.plant.matrices, self.pair.kernel, self.pair.restricted
        size = N.shape[1]
        e = Environment(variable=variable, values={"A": m.A, "C": m.C, "N": N, "X": X})
        A, C, N_, X_ = (letter(name, e) for name in ("A", "C", "N", "X"))
        yield Claim(relation(C @ N_, Matrix.zeros(1, size)), e, "C*N = 0")
        yield Claim(relation(A @ N_, N_ @ X_), e)
        yield Claim(relation(N_.apply("rank"), size), e)
        pencil = letter("s", e) @ identity(size, e) - X_
        yield Claim(relation(pencil.apply("det"), pair.fixed_polynomial), e, "det(s*I - X) = fixed polynomial")

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
    pencil = letter("s", e) @ identity(plant.order, e) - letter("A", e)
    found = letter("C", e) @ pencil.apply("adj") @ letter("B", e)
    return found + letter("D", e) @ pencil.apply("det") if plant.matrices.has_feedthrough else found


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
