"""What observer gains and feedback gains have in common: the result type with its claims, and the choice of answer.

A − L C and (A − B K)ᵀ = Aᵀ − Kᵀ Bᵀ are one problem; `Side` says which letters it is written in.
"""

from __future__ import annotations

from dataclasses import field
from functools import cache, cached_property
from typing import TYPE_CHECKING, Any, ClassVar, Self, TypeAlias

from symobs._dataclass import dataclass
from symobs.certificate.claims import Claim, Statement
from symobs.derivation.builder import relation
from symobs.design.gain.zero_pattern_claims import excluded_claims, in_root_claims, in_root_report
from symobs.design.pole_placement.decoupled import decoupled_claim, decoupled_gain
from symobs.design.pole_placement.fresh_names import fresh_names
from symobs.design.pole_placement.gain_family import Family
from symobs.design.pole_placement.multiple_outputs import SeveralOutputs
from symobs.design.pole_placement.zero_pattern import (
    RootGain,
    contradict,
    equations_for,
    obstacles,
    unknown_gain,
    with_zeros,
)
from symobs.errors import CertificateRejected, InputError
from symobs.exact import Field, Matrix, Root, Scalar, independent_rows, roots_of
from symobs.exact.kernel.generators import identities
from symobs.formula import Environment, Literal, Relation
from symobs.formula.term import Term, identity, letter
from symobs.result import Case, Result
from symobs.stability.criteria.stability import StabilityVerdict, stability

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Mapping

    from symobs.analysis.rank.rank_test import RankResult
    from symobs.design.pole_placement.single_output import Pair
    from symobs.specification import DesiredPolynomial
    from symobs.system import StateSpace

#: Entries of a gain: (row, column), from 0.
Places: TypeAlias = tuple[tuple[int, int], ...]


@dataclass(frozen=True, eq=False, repr=False)
class GainDesign(Result):
    """A gain with det(sI − A + LC) = φ(s) (det(sI − A + BK) = φ(s)), or the proof that there is none.

    The answer is `gain` (None where φ cannot be assigned) and `polynomial`; `desired` is None where the gain was given.
    """

    desired: DesiredPolynomial | None
    working: Pair | None = field(default=None, compare=False)
    zero: Places = ()
    #: Whether the member of the family is asked for whose output errors (whose inputs' parts) are decoupled.
    decoupled: bool = False
    #: A gain with zeros as asked for whose entries no square roots write: it stands beside the answer None.
    in_root: RootGain | None = None

    letter: ClassVar[str]
    rank_test: ClassVar[type[RankResult]]

    # -- the dual sides ----------------------------------------------------------------------------------------------

    @staticmethod
    def pair(plant: StateSpace) -> Pair:
        """Return (A, C) of the observer problem this is, or is dual to."""
        raise NotImplementedError

    @staticmethod
    def oriented(gain: Matrix) -> Matrix:
        """Return a gain of the observer problem as this task's gain, and the other way round."""
        raise NotImplementedError

    @staticmethod
    def moved(environment: Environment) -> Term:
        """Return what the gain takes from A: LC or BK."""
        raise NotImplementedError

    @classmethod
    @cache
    def assignment(cls, order: int) -> Relation:
        """Return the claim of the type: det(sI − A + LC) = φ(s)."""
        e = Environment()
        pencil = letter("s", e) @ identity(order, e) - letter("A", e) + cls.moved(e)
        return relation(pencil.apply("det"), letter("phi", e))

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
        """Return the design that assigns φ, with zeros or decoupled as asked for, or the negative result."""
        pair = working_pair(cls.pair(plant), desired)
        found: Matrix | RootGain | None
        if decoupled:
            found = decoupled_gain(pair, desired)
        else:
            found = with_zeros(pair, desired, cls.places(zero)) if zero else pair.gain(desired)
        gain, in_root = (None, found) if isinstance(found, RootGain) else (found, None)
        answer = {cls.letter: None if gain is None else cls.oriented(gain), "polynomial": desired.polynomial}
        return cls(plant, method_name, answer, desired, pair, zero, decoupled, in_root)

    @classmethod
    def places(cls, zero: Places) -> Places:
        """Return places of this task's gain as places of that of the observer problem."""
        return zero if cls.letter == "L" else tuple((j, i) for i, j in zero)

    @classmethod
    def by_column(
        cls,
        plant: StateSpace,
        desired: DesiredPolynomial,
        method_name: str,
        column: Callable[[Pair, DesiredPolynomial], Matrix],
    ) -> Self:
        """Return the design whose gain a method for one output (input) finds; with hidden modes there is the common way only.

        Raises `InputError` where there are several.
        """
        pair = cls.pair(plant)
        require_one(pair.c.shape[0], "output" if cls.letter == "L" else "input", method_name)
        return cls.by_method(plant, desired, method_name, column)

    @classmethod
    def by_method(
        cls,
        plant: StateSpace,
        desired: DesiredPolynomial,
        method_name: str,
        gain: Callable[[Pair, DesiredPolynomial], Matrix | None],
    ) -> Self:
        """Return the design whose gain a method finds where all is seen; the common way where it is not, or finds none."""
        pair = cls.pair(plant)
        found = gain(pair, desired) if pair.is_observable else None
        if found is None:
            return cls.of(plant, desired, method_name)
        answer = {cls.letter: cls.oriented(found), "polynomial": desired.polynomial}
        return cls(plant, method_name, answer, desired)

    @classmethod
    def of_given(cls, plant: StateSpace, gain: Matrix) -> Self:
        """Return the design with a given gain, its polynomial found."""
        e = Environment(variable=plant.variable, values=letters_of(plant) | {cls.letter: gain})
        closed = letter("A", e) - cls.moved(e)
        polynomial = closed.value.normal().characteristic_polynomial(plant.variable)
        return cls(plant, "given", {cls.letter: gain, "polynomial": polynomial}, None)

    # -- claims ------------------------------------------------------------------------------------------------------

    def claims(self) -> Iterator[Claim | Statement]:
        """Yield det(sI − A + LC) = φ(s) for the gain and its family, or the proof that no gain exists."""
        gain, phi, own = self.answer[self.letter], self.answer["polynomial"], self.pair(self.plant)
        if (self._pair.A, self._pair.c) != (own.A, own.c):
            message = "the witness speaks of another plant"
            raise CertificateRejected(message, repair="please report this: it is a bug of symobs")
        if self.desired is not None and phi is not self.desired.polynomial:
            e = Environment(variable=self.plant.variable)
            yield Claim(relation(phi, self.desired.polynomial), e, "the polynomial is the one asked for")
        if gain is None:
            if self.in_root is not None:
                yield from in_root_claims(self, self.in_root)
            elif not self.zero or not self.divides:
                yield from self._impossible()
            else:
                yield from excluded_claims(self)
            return
        yield self.assigned(gain)
        if self.decoupled:
            yield decoupled_claim(self._pair, self.oriented(gain))
        if self.zero:
            e = Environment(variable=self.plant.variable)
            entries = Matrix.row([gain[i, j] for i, j in self.zero])
            yield Claim(relation(entries, Matrix.zeros(1, len(self.zero))), e, f"zeros in {self.letter} as asked for")
        if self.gain_family is not None and self.gain_family[self.letter] is not None:
            yield self.assigned(self.gain_family[self.letter])
            if self.chart is None:
                yield from self._free_along_kernel(gain, self.gain_family)
        if self.chart is not None:
            yield from self.chart.claims(self.oriented, self.gain_family)

    def assigned(self, gain: Matrix, relations: tuple[Scalar, ...] = ()) -> Claim:
        """Return the claim that a gain assigns φ, where some polynomials vanish."""
        phi = self.answer["polynomial"]
        values = letters_of(self.plant) | {self.letter: gain, "phi": phi}
        relations = (*relations, *identities(gain.entries)[1])
        e = Environment(variable=self.plant.variable, values=values, relations=relations)
        return Claim(self.assignment(self.plant.order), e)

    def _free_along_kernel(self, gain: Matrix, family: Mapping[str, Any]) -> Iterator[Claim]:
        """Yield L = L₀ + N g with N of full rank: no parameter of the family is idle."""
        N, names = self._pair.kernel, family["parameters"]
        e = Environment(variable=self.plant.variable)
        free = Matrix.column([Scalar.symbol(name) for name in names])
        general = (gain + self.oriented(N @ free)).normal()
        yield Claim(relation(family[self.letter], general), e, f"{self.letter} is free along the kernel")
        yield self._of_full_rank(N, e)

    def _of_full_rank(self, N: Matrix, e: Environment) -> Claim:
        minor = N.select(independent_rows(N, self._pair.ideal), range(N.shape[1]))
        return Claim(relation(Term(Literal(minor), e).apply("det"), "!==", 0), e, "N has full rank")

    def _impossible(self) -> Iterator[Claim]:
        """C N = 0 and A N = N X make det(sI − X) a factor of every det(sI − A + LC); it does not divide φ."""
        pair, variable = self._pair, self.plant.variable
        quotient, rest = pair.divided(self.answer["polynomial"])
        N, X = pair.kernel, pair.restricted
        values = {"A": pair.A, "C": pair.c, "N": N, "X": X, "phi": self.answer["polynomial"]}
        e = Environment(variable=variable, values=values)
        A, C, kernel, restricted = (letter(name, e) for name in ("A", "C", "N", "X"))
        pencil = letter("s", e) @ identity(X.shape[0], e) - restricted
        yield Claim(relation(C @ kernel, Matrix.zeros(pair.c.shape[0], N.shape[1])), e, "C*N = 0")
        yield Claim(relation(A @ kernel, kernel @ restricted), e, "A*N = N*X")
        yield Claim(relation(N.shape[1], X.shape[0], "!==", 0), e, "X has the order of the kernel")
        yield self._of_full_rank(N, e)
        yield Claim(relation(pencil.apply("det"), pair.fixed_polynomial), e, "det(s*I - X) = fixed polynomial")
        phi = letter("phi", e)
        yield Claim(relation(phi, pair.fixed_polynomial * quotient + rest), e, "phi = fixed polynomial * q + r")
        yield Claim(relation(Term(Literal(rest), e), "!==", 0), e, "r is not zero")

    @cached_property
    def _pair(self) -> Pair:
        """The pair of the plant, over the working context where the design has one."""
        return self.working or self.pair(self.plant)

    # -- what follows ------------------------------------------------------------------------------------------------

    @property
    def verdict(self) -> str:
        """`no` where φ cannot be assigned; `undecided` where no gain was found with the zeros asked for."""
        if self.in_root is not None:
            return "yes"
        if self.answer[self.letter] is None:
            return "undecided" if self.zero and self.divides and not self.needed else "no"
        return super().verdict

    @cached_property
    def test(self) -> RankResult:
        """The rank test of the pair."""
        return self.rank_test.of(self.plant, "rank")

    @property
    def divides(self) -> bool:
        """Whether the fixed modes are among the poles asked for."""
        pair = self._pair
        return pair.is_observable or pair.divided(self.answer["polynomial"])[1].is_zero

    @cached_property
    def equations(self) -> tuple[Scalar, ...]:
        """What the entries that are not to vanish must satisfy."""
        assert self.desired is not None  # noqa: S101 - zeros are asked for together with poles
        pair = self._pair
        general = unknown_gain(pair.A.shape[0], pair.c.shape[0], self.places(self.zero))
        return tuple(value for value in equations_for(pair, self.desired, general) if value)

    @cached_property
    def needed(self) -> tuple[Scalar, ...]:
        """What must vanish for a gain to have its zeros where they are asked for: 1 where none has, whatever the parameters."""
        return (Scalar.of(1),) if contradict(self.equations) else obstacles(self.equations)

    @property
    def can_be_found(self) -> bool:
        """Whether a search for a gain with the zeros asked for ends with one."""
        assert self.desired is not None  # noqa: S101 - zeros are asked for together with poles
        return with_zeros(self._pair, self.desired, self.places(self.zero)) is not None

    @property
    def existence(self) -> tuple[Scalar, ...]:
        """What decides where a gain exists: det 𝒪 (det 𝒞), or what the fixed modes leave of φ where that is 0."""
        if self.desired is None:
            return ()
        if self._pair.is_observable:
            return tuple(self.plant.simplified(value) for value in self._pair.decisive)
        return self._obstacles if self.answer[self.letter] is None else ()

    @cached_property
    def _obstacles(self) -> tuple[Scalar, ...]:
        """The coefficients of φ modulo the fixed polynomial, as far as parameters can make them vanish."""
        rest = self._pair.divided(self.answer["polynomial"])[1]
        found = [c.numerator for c in rest.coefficients(self.plant.variable) if not c.is_zero]
        return () if any(c.is_constant for c in found) else tuple(found)

    @cached_property
    def fixed_polynomial(self) -> Scalar:
        """The polynomial of the modes that no gain moves."""
        return Scalar.of(1) if self._pair.is_observable else self._pair.fixed_polynomial

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
            return chart.fields(self.letter, self.oriented)
        if gain is None or self.desired is None or self._pair.is_observable:
            return None
        N = self._pair.kernel
        names = fresh_names("g", N.shape[1], self._taken)
        free = Matrix.column([Scalar.symbol(name) for name in names])
        return {"parameters": names, self.letter: (gain + self.oriented(N @ free)).normal(), "dimension": len(names)}

    @cached_property
    def chart(self) -> Family | None:
        """The family of gains for several outputs (inputs), the gain of the answer in it; None for one."""
        gain, pair = self.answer[self.letter], self._pair
        if gain is None or self.desired is None or not isinstance(pair, SeveralOutputs) or identities([gain])[1]:
            return None
        names = fresh_names("g", pair.freedom, self._taken)
        return Family.of(pair, self.desired, names, self.oriented(gain))

    @property
    def _taken(self) -> tuple[str, ...]:
        """The names that a parameter of the family cannot have."""
        named = self.answer[self.letter].field.names, self.answer["polynomial"].field.names
        return (*self.plant.field.names, *self.plant.symbols.signs, *named[0], *named[1])

    @cached_property
    def case_tree(self) -> tuple[Case, ...]:
        """What is true on the strata where modes, gain, or whether there is one are others than in general."""
        from symobs.design.gain.gain_cases import cases_of, cases_of_given  # noqa: PLC0415 - of many in a loop none is asked

        return cases_of(self, self.desired) if self.desired is not None else cases_of_given(self)

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
            "family": self.gain_family,
            **({"zero": [[i + 1, j + 1] for i, j in self.zero]} if self.zero else {}),
            **({"in_root": in_root_report(self, self.in_root)} if self.in_root is not None else {}),
        }


def working_pair(pair: Pair, desired: DesiredPolynomial) -> Pair:
    """Return the pair over one context: plant and specification together."""
    names = {name for factor in desired.factors for name in factor.field.names} - {desired.variable}
    working = Field.of((*pair.A.field.names, *pair.c.field.names, *names))
    return type(pair)(pair.A.within(working), pair.c.within(working), pair.variable, pair.equations)


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


def require_one(count: int, what: str, name: str) -> None:
    """Raise `InputError` where a method for one output (input) is asked about several."""
    if count != 1:
        message = f"the method {name} needs one {what}, the plant has {count}"
        repair = "write sylvester or row_reduced_echelon, which take several"
        raise InputError(message, where="specification.method", repair=repair)
