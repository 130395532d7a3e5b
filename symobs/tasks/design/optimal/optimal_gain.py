"""The gain that minimises a quadratic cost: the stabilising solution P of Riccati's equation, and what follows from it.

The Kalman filter of (A, C) with noise W, V is dual to it: the regulator of (Aᵀ, Cᵀ) with the weights W, V.
P exists if and only if (A, B) is stabilizable and no mode on the boundary is hidden from the cost.  Its loop has for its
polynomial the stable factor of that of the Hamiltonian matrix H; where square roots write it, p(H) [I; P] = 0 is linear in P.
"""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from functools import cached_property
from typing import TYPE_CHECKING, Any, ClassVar, NamedTuple, Self, TypedDict

from symobs.exact import (
    Ideal,
    Matrix,
    Root,
    Scalar,
    TooLarge,
    apart_from_zero,
    from_coefficients,
    independent_rows,
    primitive_kernel,
    product_of,
    roots_of,
    solve_or_refute,
)
from symobs.exact.algebraic.enclosure import is_number
from symobs.exact.core.generators import all_roots, identities
from symobs.exact.floating.riccati import enclosed_solution, hamiltonian
from symobs.formula.tree import Environment
from symobs.formula.tree.term import identity
from symobs.ground.dataclass import dataclass
from symobs.ground.errors import CertificateRejected, InputError, Undecided
from symobs.proof.certificate.claims import Claim, Statement
from symobs.proof.certificate.pointwise import never_together_zero
from symobs.proof.derivation.facts import leading_minors
from symobs.stability.criteria.stability import essential, monic, on_boundary, stability
from symobs.system.conditions import Condition, joined, nonzero, real_consequences, sign_of, vanishing_factors
from symobs.system.specification import in_common_field, read_symmetric
from symobs.tasks.analysis.modes.modes import polynomial_of
from symobs.tasks.analysis.strata.strata import common_places, places, solved
from symobs.tasks.design.optimal.spectral_factor import NoFactor, reduced, stable_factors, with_signs
from symobs.tasks.result import Case, Result, choose, equality, holds
from symobs.tasks.result.answers import named_found, those_found

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator, Mapping

    from symobs.exact.floating.riccati import Enclosure
    from symobs.exact.floating.riccati_check import Regulator
    from symobs.exact.linear_algebra.transfer_function import Realisation
    from symobs.formula.tree.term import Term
    from symobs.system import StateSpace
    from symobs.tasks.analysis.strata.strata import Place
    from symobs.tasks.design.gain.gain_design import GainDesign

#: With more states the proof of the digits takes seconds; with parameters no square roots write the factor in general.
MOST_STATES, MOST_WITH_PARAMETERS = 12, 2
#: Numbers over more square roots than these (of primes, and of sums of those) are not computed with: fields grow by 2 to each.
_MOST_ROOTS = 4
#: With more states no exact solution is looked for.
_EXACT_UP_TO = 6
#: An exact solution whose entries have more terms says less than its digits.
_MOST_TERMS, _MOST_TERMS_WITH_PARAMETERS = 60, 40


class Obstacle(NamedTuple):
    """N and X with row N = 0 and of N = N X, of which the polynomial is unstable, or on the boundary."""

    kind: str
    N: Matrix
    X: Matrix
    polynomial: Scalar


class GainByLetter(TypedDict, total=False):
    """K of a regulator, or L of a filter."""

    K: Matrix | None
    L: Matrix | None


class OptimalAnswer(GainByLetter):
    """P, the polynomial of the loop and its factors where square roots write them; digits; an obstacle, or an open question."""

    P: Matrix | None
    polynomial: Scalar | None
    factors: tuple[Scalar, ...] | None
    digits: Enclosure | None
    obstacle: Obstacle | None
    question: str | None


@dataclass
class OptimalGain(Result):
    """P and the gain with their equations, and a stable loop; or why there is none."""

    answer: OptimalAnswer
    weights: Mapping[str, Matrix]
    #: The signs that parameters need for the weights to have theirs, beyond the declared ones.
    needed: tuple[Condition, ...] = ()

    leads = ("P", "K", "L")
    letter: ClassVar[str]
    design_kind: ClassVar[type[GainDesign]]
    #: What stands beside the gain among the answers.
    of_loop: ClassVar[tuple[str, ...]]
    panels = ("plane",)

    @staticmethod
    def regulator_of(plant: StateSpace, weights: Mapping[str, Matrix]) -> Regulator:
        """Return the regulator that this problem is or is dual to."""
        raise NotImplementedError

    @classmethod
    def turned(cls, matrix: Matrix) -> Matrix:
        """Return a gain of the regulator as this task's gain, and the other way round."""
        return matrix if cls.letter == "K" else matrix.T

    @classmethod
    def loop(cls, of: Callable[[str], Term]) -> Term:
        """Return A − BK or A − LC."""
        return of("A") - (of("B") @ of("K") if cls.letter == "K" else of("L") @ of("C"))

    @staticmethod
    def equations(*, discrete: bool, cross: bool = True) -> tuple[str, str]:
        """Return Riccati's equation and that of the gain; `noise` is G W Gᵀ."""
        raise NotImplementedError

    # -- construction ------------------------------------------------------------------------------------------------

    @classmethod
    def of(
        cls, plant: StateSpace, weights: Mapping[str, Matrix], method_name: str, needed: tuple[Condition, ...] = ()
    ) -> Self:
        """Return the optimal gain, exact and in certain digits, or the obstacle, or the question that is open."""
        regulator = cls.regulator_of(plant, weights)
        answer: OptimalAnswer = {
            **cls._by_letter(None),
            "P": None,
            "polynomial": None,
            "factors": None,
            "digits": None,
            "obstacle": None,
            "question": None,
        }
        reason = ""
        try:
            answer["obstacle"] = _obstacle(regulator, plant)
            if answer["obstacle"] is not None:
                return cls(plant, method_name, answer, weights, needed)
            found = _exact_solution(regulator, plant)
            gain = cls._by_letter(cls.turned(found.gain))
            answer = {**answer, **gain, "P": found.P, "polynomial": found.polynomial, "factors": found.factors}
        except NoFactor as error:
            reason = str(error)
        if is_numeric(regulator):
            answer["digits"] = enclosed_solution(regulator)
            reason = "no precision that is tried proves the digits"
        if answer["P"] is None and answer["digits"] is None:
            answer["question"] = reason
        return cls(plant, method_name, answer, weights, needed)

    @classmethod
    def _by_letter(cls, gain: Matrix | None) -> GainByLetter:
        return {"K": gain} if cls.letter == "K" else {"L": gain}

    @property
    def gain(self) -> Matrix | None:
        """K, or L."""
        return self.answer["K"] if self.letter == "K" else self.answer["L"]

    @property
    def exact(self) -> Solution | None:
        """P, K or L, the polynomial of the loop and its factors, where square roots write them."""
        answer = self.answer
        P, gain, polynomial, factors = answer["P"], self.gain, answer["polynomial"], answer["factors"]
        if P is None or gain is None or polynomial is None or factors is None:
            return None
        return Solution(P, gain, polynomial, factors)

    @cached_property
    def regulator(self) -> Regulator:
        """The regulator that this problem is or is dual to."""
        return self.regulator_of(self.plant, self.weights)

    @property
    def data(self) -> Mapping[str, Scalar | Matrix]:
        """The gain and P besides the plant's matrices: pages speak of these."""
        return {**super().data, **named_found({self.letter: self.gain, "P_x": self.answer["P"]})}

    @property
    def named_data(self) -> Mapping[str, Any]:
        """The weights, or the intensities, and P."""
        return {**self.weights, "P": self.answer["P"]}

    def consequences(self, given: Mapping[str, Any]) -> Mapping[str, Any]:
        """Return the gain of another P, and the polynomial, the poles and the loop of that, or of another gain."""
        r, P = self.regulator, given.get("P")
        gain = given.get(self.letter)
        if gain is None and P is not None and P.shape == r.A.shape:
            weight, coupled = (r.R + r.B.T @ P @ r.B, r.B.T @ P @ r.A) if r.discrete else (r.R, r.B.T @ P)
            gain = self.turned(weight.solve(coupled + r.N.T).normal())
        if gain is None or gain.shape != self.shape_of_gain:
            return {}
        found = self.design_kind.of_given(self.plant, gain)
        polynomial = found.answer["polynomial"]
        own = {name: found.fields[name] for name in (*self.of_loop, "polynomial")}
        return {self.letter: gain, **own, "poles": roots_of(polynomial, self.plant.variable)}

    @property
    def shape_of_gain(self) -> tuple[int, int]:
        """The size of K, or of L."""
        n, m = self.regulator.B.shape
        return (m, n) if self.letter == "K" else (n, m)

    # -- claims ------------------------------------------------------------------------------------------------------

    def values(self) -> dict[str, Matrix | Scalar]:
        """Return the data and the exact answers by their letters; `noise` is GWGᵀ."""
        m = self.plant.matrices
        found = {"A": m.A, **self.weights, **named_found({self.letter: self.gain, "P": self.answer["P"]})}
        found |= {"B": m.B} if self.letter == "K" else {"C": m.C, "noise": self.regulator.Q, "shared": self.regulator.N}
        return {**found}

    def claims(self) -> Iterator[Claim | Statement]:
        """Yield the signs of the weights; Riccati's equation, the gain and a stable loop, or the obstacle; the digits."""
        answer, digits, exact, regulator = self.answer, self.answer["digits"], self.exact, self.regulator
        if exact is None and any((self.gain, answer["P"], answer["polynomial"], answer["factors"])):
            raise CertificateRejected("the gain, P and the polynomial with its factors are there together")
        has_P = exact is not None or digits is not None
        if [has_P, answer["obstacle"] is not None, answer["question"] is not None].count(True) != 1:
            raise CertificateRejected("there is a P, an obstacle, or an open question")
        signs = self.plant.symbols.signs
        yield Statement(
            "the weight of the input is positive definite", lambda: _shown(_is_definite(regulator.R, signs))
        )
        weight = regulator.uncrossed[2]
        yield Statement(
            "the weight of the state is positive semidefinite", lambda: _shown(is_semidefinite(weight, signs))
        )
        if answer["obstacle"] is not None:
            yield from self._about_obstacle(answer["obstacle"])
            return
        if digits is not None:
            yield Statement(
                "the digits are those of the stabilising solution", lambda: _shown(digits.is_proved(regulator))
            )
        if exact is not None:
            yield from self._about_exact(exact.polynomial, exact.factors)

    def _about_exact(self, polynomial: Scalar, factors: tuple[Scalar, ...]) -> Iterator[Claim | Statement]:
        values, plant = self.values(), self.plant
        values["p"] = polynomial
        signs = with_signs(plant.symbols.signs, *values.values())
        relations = identities(values.values())[1]
        e = Environment(variable=plant.variable, values=values, signs=signs, relations=relations)

        def of(name: str) -> Term:
            return e[name]

        yield holds(e, "P = P.T")
        for equation in self.equations(discrete=plant.is_discrete):
            yield holds(e, equation)
        pencil = e["s"] @ identity(plant.order, e) - self.loop(of)
        yield equality(pencil.apply("det"), of("p"), e, "the polynomial is that of the loop")
        v = plant.variable
        is_stable = stability(polynomial, v, signs, discrete=plant.is_discrete).verdict == "yes"
        yield Statement("the loop is asymptotically stable", lambda: _shown(is_stable))
        are_monic = all(factor.coefficients(v)[0].is_one for factor in factors)
        yield Statement("the factors are monic", lambda: _shown(are_monic))
        moved = [to_disc(factor, v) for factor in factors] if plant.is_discrete else factors
        yield equality(of("p"), product_of(moved), e, "the polynomial is the product of the factors")
        if not is_numeric(self.regulator):
            even, s = self.even, Scalar.symbol(plant.variable)
            p = product_of(factors)
            whole = p * p.substitute({plant.variable: -s})
            e = Environment(variable=plant.variable, relations=identities([p, even])[1])
            yield equality(whole, even * (-1) ** plant.order, e, "p(s)*p(-s) is the polynomial of H")

    def _about_obstacle(self, found: Obstacle) -> Iterator[Claim | Statement]:
        regulator, plant = self.regulator, self.plant
        A, _, Q = regulator.uncrossed
        row, of = (regulator.B.T, regulator.A.T) if found.kind == "uncontrollable" else (Q, A)
        e = Environment(variable=plant.variable, values={"row": row, "of": of, "N": found.N, "X": found.X})
        yield holds(e, "row*N = 0", "N is hidden")
        yield holds(e, "of*N = N*X", "N is invariant")
        yield holds(e, f"rank(N) = {found.N.shape[1]}", "N has full rank")
        yield holds(e, "det(pencil(X)) = {modes}", "the polynomial of the hidden modes", modes=found.polynomial)
        signs, variable, discrete = plant.symbols.signs, plant.variable, plant.is_discrete
        if found.kind == "uncontrollable":
            is_unstable = stability(found.polynomial, variable, signs, discrete=discrete).verdict == "no"
            yield Statement("it is not stable", lambda: _shown(is_unstable))
        else:
            factors = [f for f, _ in found.polynomial.numerator.factors()[1] if f.degree(variable)]
            on = all(on_boundary(f, variable, signs, discrete=discrete) for f in factors)
            yield Statement("its roots are on the boundary", lambda: _shown(on and bool(factors)))

    # -- what follows ------------------------------------------------------------------------------------------------

    @property
    def verdict(self) -> str:
        """`no` where there is an obstacle."""
        if self.answer["question"] is not None:
            return "undecided"
        return "no" if self.answer["obstacle"] is not None else super().verdict

    @cached_property
    def as_given(self) -> GainDesign | None:
        """The gain as a given one: exact, else its certain digits, with which the loop is stable; None where there is none."""
        gain = self.numbers[self.letter]
        return None if gain is None else self.design_kind.of_given(self.plant, gain)

    @property
    def loop_matrix(self) -> Matrix | None:
        """A − BK, or A − LC, of the gain as it is given."""
        found: Matrix | None = self.numbers[self.of_loop[0]]
        return found

    @property
    def systems(self) -> Mapping[str, Realisation]:
        """Those of the gain as it is given."""
        return super().systems if self.as_given is None else self.as_given.systems

    @cached_property
    def even(self) -> Scalar:
        """The polynomial of the Hamiltonian matrix."""
        return hamiltonian(self.regulator).characteristic_polynomial(self.plant.variable)

    @property
    def existence(self) -> tuple[Scalar, ...]:
        """What vanishes where controllability is lost, or where the polynomial of H may have a root on the axis."""
        if self.answer["P"] is None or is_numeric(self.regulator):
            return ()
        regulator, plant = self.regulator, self.plant
        (A, S, Q), signs, one = regulator.uncrossed, plant.symbols.signs, Matrix.identity(plant.order)
        found = [self.even.coefficients(plant.variable)[-1].numerator]
        if plant.is_discrete:  # the pencil at 1 and -1: in the polynomial of H their common factors are cancelled
            pencils = (Matrix.block([[one * z - A, S * z], [Q, A.T * z - one]]) for z in (1, -1))
            found = [pencil.determinant().numerator for pencil in pencils]
        if plant.order == 2 and sign_of(Q[0, 0] + Q[1, 1], signs) != "positive":  # where Q = 0 a pair ± iω is hidden
            _, a, b = A.characteristic_polynomial(plant.variable).coefficients(plant.variable)
            is_pair = plant.is_discrete or sign_of(b, signs) not in {"negative", "nonpositive", "zero"}
            found += [(b - 1 if plant.is_discrete else a) ** 2 + Q[0, 0] + Q[1, 1]] if is_pair else []
        beside: list[Scalar] = []
        if regulator.B.shape[1] == 1:
            determinant = Matrix.block([[regulator.B, regulator.A @ regulator.B][: plant.order]]).determinant()
            beside += [] if determinant.is_zero else [determinant]
        known = [apart_from_zero(value) for value in beside]
        found = [value for value in found if not _never_beside(value.numerator, known, signs)]
        return tuple(plant.simplified(value) for value in (*found, *beside))

    @property
    def further_data(self) -> tuple[Matrix, ...]:
        """The weights."""
        return tuple(self.weights.values())

    @cached_property
    def domain(self) -> tuple[Condition, ...]:
        """That of the plant, and the signs that the weights need."""
        return (*super().domain, *self.needed)

    @cached_property
    def holds_where(self) -> tuple[Condition, ...]:
        """The domain, existence, and the denominators of the answer."""
        values = those_found(self.gain, self.answer["P"])
        signs = with_signs(self.plant.symbols.signs, *values)
        found = nonzero("existence", vanishing_factors(self.existence, signs))
        below = vanishing_factors([value.common_denominator() for value in values], signs)
        return joined((*self.domain, *found), nonzero("claim", below))

    @cached_property
    def case_tree(self) -> tuple[Case, ...]:
        """The question again where the pair is not controllable, or a mode may be hidden on the boundary."""

        def on(there: StateSpace, values: dict[str, Scalar]) -> Result | None:
            weights = {name: weight.substitute(values) for name, weight in self.weights.items()}
            there_signs, regulator = there.symbols.signs, self.regulator_of(there, weights)
            known = _is_definite(regulator.R, there_signs) and is_semidefinite(regulator.uncrossed[2], there_signs)
            if there.equations or not known:  # ranks and signs are not known there
                return None
            found = type(self).of(there, weights, self.method)
            return None if found.answer["question"] is not None else found

        asked: list[Place] = []
        for condition in self.holds_where:
            if condition.kind != "domain":
                each = real_consequences(condition.expression, self.plant.symbols.signs)
                asked += common_places(self.plant, each) if each else places(self.plant, [condition.expression])
        found = solved(self.plant, {frozenset(place.when): place for place in asked}.values(), on)
        return tuple(self._with_roots_beside(found))

    def _with_roots_beside(self, cases: Iterable[Case]) -> Iterator[Case]:
        """Yield the cases; those whose square roots are too many to be decided beside the others are undecided."""
        beside = self.all_values
        for case in cases:
            more = [] if case.result is None else case.result.values_with_cases
            if more and not _are_decidable([*beside, *more]):
                yield replace(case, result=None)
                continue
            beside = [*beside, *more]
            yield case

    @property
    def all_values(self) -> list[Scalar | Matrix]:
        """The data, the exact answers, and the factors of the polynomial."""
        return [*self.values().values(), *(self.answer["factors"] or ())]

    @cached_property
    def values_with_cases(self) -> list[Scalar | Matrix]:
        """These, and those of the cases."""
        inner = (case.result for case in self.case_tree if case.result is not None)
        return [*self.all_values, *(value for found in inner for value in found.values_with_cases)]

    @property
    def hidden_modes(self) -> tuple[Root, ...]:
        """The modes that are the obstacle."""
        found, plant = self.answer["obstacle"], self.plant
        v, signs, discrete = plant.variable, plant.symbols.signs, plant.is_discrete
        factors = [] if found is None else [f for f, _ in found.polynomial.numerator.factors()[1] if f.degree(v)]
        bad = [factor for factor in factors if stability(factor, v, signs, discrete=discrete).verdict != "yes"]
        return roots_of(product_of(bad), v) if bad else ()

    @cached_property
    def fields(self) -> Mapping[str, Any]:
        """The gain, P, the polynomial of the loop and its poles; the modes that are an obstacle."""
        answer, plant = self.answer, self.plant
        v, factors, poles = plant.variable, answer["factors"], None
        if factors is not None:
            moved = [to_disc(factor, v) for factor in factors] if plant.is_discrete else factors
            poles = tuple(root for factor in moved for root in roots_of(factor, v))
        gain, asked, m = self.gain, answer["question"], plant.matrices
        found: dict[str, Any] = {
            self.letter: gain,
            "P": answer["P"],
            "polynomial": answer["polynomial"],
            "poles": poles,
        }
        if self.letter == "K":
            found["closed_loop_matrix"] = None if gain is None else (m.A - m.B @ gain).normal()
        else:
            found["A"] = None if gain is None else (m.A - gain @ m.C).normal()
            found |= {"B_u": None if gain is None or not m.has_input else (m.B - gain @ m.D).normal(), "B_y": gain}
        return {**found, "modes": self.hidden_modes, **({} if asked is None else {"question": asked})}

    @cached_property
    def numbers(self) -> Mapping[str, Any]:
        """The fields, and where no square roots write them the certain digits of gain and P as rational numbers."""
        digits = self.decimals if self.gain is None else {}
        exact = {name: Matrix.of([[Fraction(e) for e in row] for row in rows]) for name, rows in digits.items()}
        of_gain = self.design_kind.of_given(self.plant, exact[self.letter]).fields if exact else {}
        return {**self.fields, **{name: of_gain[name] for name in self.of_loop if name in of_gain}, **exact}

    @property
    def decimals(self) -> dict[str, Any]:
        """Certain digits of the gain and of P, where the data are numbers: to half a unit of the last place."""
        return self._decimals(self.answer["digits"])

    def decimals_to(self, digits: int) -> dict[str, Any]:
        """Return so many certain digits of the gain and of P, or those that there are."""
        found = self.answer["digits"]
        return self._decimals((found and enclosed_solution(self.regulator, digits)) or found)

    def _decimals(self, digits: Enclosure | None) -> dict[str, Any]:
        if digits is None:
            return {}
        columns = [*map(list, zip(*digits.K, strict=True))]
        gain = [list(row) for row in digits.K] if self.letter == "K" else columns
        return {self.letter: gain, "P": [list(row) for row in digits.P]}


def _shown(holds: bool) -> str:  # noqa: FBT001 - the outcome of a check
    return "exact" if holds else ""


def is_numeric(regulator: Regulator) -> bool:
    """Return whether all data are numbers."""
    parts = (regulator.A, regulator.B, regulator.Q, regulator.R, regulator.N)
    return all(is_number(entry) for part in parts for entry in part.entries)


# -- what is asked of the weights --------------------------------------------------------------------------------------


def _never_beside(value: Scalar, known: Iterable[Scalar], signs: Mapping[str, str]) -> bool:
    """Return whether it is seen that a value vanishes nowhere where relations hold."""
    try:
        return never_together_zero([value], known, signs)
    except TooLarge:
        return False


def _is_definite(matrix: Matrix, signs: Mapping[str, str]) -> bool:
    return all(sign_of(minor, signs) == "positive" for minor in leading_minors(matrix))


def is_semidefinite(matrix: Matrix, signs: Mapping[str, str]) -> bool:
    """Return whether det(sI + M) has no negative coefficient."""
    return all(sign_of(c, signs) in {"positive", "nonnegative", "zero"} for c in _sums_of_minors(matrix))


def _sums_of_minors(matrix: Matrix) -> tuple[Scalar, ...]:
    return (-matrix).characteristic_polynomial("s").coefficients("s")


def design_optimal(
    kind: type[OptimalGain],
    plant: StateSpace,
    given: Mapping[str, tuple[object, int]],
    further: Mapping[str, Matrix],
    method: str,
) -> Result:
    """Return the design for weights that are given, with their sizes, and further matrices.

    Raises `InputError` where a weight is missing or has not its sign, and `Undecided` for too many states.
    """
    for name, (value, size) in given.items():
        if value is None:
            message = f"the weight {name} is missing"
            raise InputError(message, where=f"specification.{name}", repair=f"give a symmetric {size}×{size} matrix")
    if plant.order > MOST_STATES:
        raise Undecided(f"{kind.task} is undecided: {plant.order} states are too many")
    read = [read_symmetric(value, plant, name, size) for name, (value, size) in given.items()]
    plant, found = in_common_field(plant, *read, *further.values())
    weights = dict(zip((*given, *further), found, strict=True))
    symbols, signs = plant.symbols, _needed_signs(weights, plant.symbols.signs)
    plant = plant.with_symbols(replace(symbols, signs={**symbols.signs, **signs})) if signs else plant
    _require_signs(kind.regulator_of(plant, weights), weights, plant.symbols.signs)
    needed = (Condition("domain", Scalar.symbol(name), _RELATIONS[sign]) for name, sign in signs.items())
    return choose(kind.task, method, "riccati").solve(plant, weights, (*needed,)).asked(method)


#: What a weight asks of a parameter that stands alone in its diagonal, by what is declared of it.
_OF_STATE, _OF_INPUT = (
    {"real": "nonnegative", "nonzero": "positive"},
    dict.fromkeys(("real", "nonzero", "nonnegative"), "positive"),
)
_RELATIONS = {"nonnegative": ">=", "positive": ">"}


def _needed_signs(weights: Mapping[str, Matrix], signs: Mapping[str, str]) -> dict[str, str]:
    """Return the signs that parameters need which stand alone in the diagonal of a weight: of [q 0; 0 p], q and p."""
    found: dict[str, str] = {}
    for matrix, by_sign in zip(weights.values(), (_OF_STATE, _OF_INPUT), strict=False):
        for k in range(matrix.shape[0]):
            entry = essential(matrix[k, k], signs)
            sign = by_sign.get(sign_of(entry, {**signs, **found}))
            if sign and entry.names and entry == Scalar.symbol(min(entry.names)):
                found[min(entry.names)] = sign
    return found


_DECIDED = {
    "positive definite": "declare signs of the symbols that decide it, or put numbers in",
    "positive semidefinite": "declare signs of the symbols that decide it, write HᵀH of some H, or put numbers in",
}


def _require_signs(regulator: Regulator, weights: Mapping[str, Matrix], signs: Mapping[str, str]) -> None:
    """Refuse weights of the input that are not positive definite, of the state that are not positive semidefinite."""
    state, of_input, *_ = weights
    checks = (
        (of_input, weights[of_input], leading_minors(weights[of_input]), "positive definite", {"positive"}),
        (
            state,
            weights[state],
            _sums_of_minors(weights[state]),
            "positive semidefinite",
            {"positive", "nonnegative", "zero"},
        ),
    )
    for name, matrix, values, wanted, allowed in checks:
        open_value = next((value for value in values if sign_of(value, signs) not in allowed), None)
        if open_value is None:
            continue
        where = f"specification.{name}"
        if not open_value.names or sign_of(open_value, signs) in {"negative", "zero", "nonpositive"}:
            message = f"{name} is not {wanted}"
            size = matrix.shape[0]
            raise InputError(message, where=where, repair=f"give a symmetric {wanted} {size}×{size} matrix")
        message = f"{name} is not known to be {wanted}: the sign of {open_value} is open"
        raise InputError(message, where=where, repair=_DECIDED[wanted])
    if not regulator.N.is_zero and not is_semidefinite(regulator.uncrossed[2], signs):
        message = "Q - N R^-1 N^T is not known to be positive semidefinite"
        raise InputError(message, where="specification.N", repair="give a smaller N, or declare signs that decide it")


# -- the obstacle ------------------------------------------------------------------------------------------------------


def _obstacle(regulator: Regulator, plant: StateSpace) -> Obstacle | None:
    """Return unstable modes that no input moves, else modes on the boundary that the cost does not contain, if any.

    Raises `NoFactor` where that depends on the parameters.
    """
    signs, variable, discrete = plant.symbols.signs, plant.variable, plant.is_discrete
    hidden = _hidden(regulator.B.T, regulator.A.T, variable)
    if hidden is not None:
        found = stability(hidden[2], variable, signs, discrete=discrete)
        if found.verdict == "no":
            return Obstacle("uncontrollable", *hidden)
        if found.verdict != "yes":
            raise NoFactor(f"whether all roots of {hidden[2]} are stable depends on the parameters")
    A, _, Q = regulator.uncrossed
    hidden = _hidden(Q, A, variable)
    if hidden is None:
        return None
    N, X, polynomial = hidden
    for factor, _ in polynomial.numerator.factors()[1]:
        if factor.degree(variable) and on_boundary(factor, variable, signs, discrete=discrete):
            part = primitive_kernel(polynomial_of(monic(factor, variable), variable, X), None)
            inner = _restricted(X, part)
            whole = (N @ part).normal()
            return Obstacle("unseen", whole, inner, inner.characteristic_polynomial(variable))
    return None


def _hidden(row: Matrix, of: Matrix, variable: str) -> tuple[Matrix, Matrix, Scalar] | None:
    """Return N and X with row N = 0 and of N = N X, N as large as can be, and the polynomial of X; None without such."""
    rows = [row]
    for _ in range(of.shape[0] - 1):
        rows.append((rows[-1] @ of).normal())
    N = primitive_kernel(Matrix.block([[part] for part in rows]), None)
    if not N.shape[1]:
        return None
    X = _restricted(of, N)
    return N, X, X.characteristic_polynomial(variable)


def _restricted(of: Matrix, N: Matrix) -> Matrix:
    rows, columns = independent_rows(N), range(N.shape[1])
    return N.select(rows, columns).solve((of @ N).select(rows, columns)).normal()


# -- the exact solution ------------------------------------------------------------------------------------------------


def to_disc(polynomial: Scalar, variable: str, *, reduce: bool = True) -> Scalar:
    """Return the monic polynomial with the roots z = (1 + w)/(1 − w)."""
    z, coefficients = Scalar.symbol(variable), polynomial.coefficients(variable)
    order = len(coefficients) - 1
    moved = sum((c * (z - 1) ** (order - k) * (z + 1) ** k for k, c in enumerate(coefficients)), Scalar.of(0))
    lead, *rest = moved.coefficients(variable)
    quotients = [c / lead for c in rest]
    return from_coefficients([Scalar.of(1), *(map(reduced, quotients) if reduce else quotients)], variable)


class Solution(NamedTuple):
    """P, the gain, the polynomial of its loop, and the factors of that of H, in s or w."""

    P: Matrix
    gain: Matrix
    polynomial: Scalar
    factors: tuple[Scalar, ...]


def _exact_solution(regulator: Regulator, plant: StateSpace) -> Solution:
    """Return P from p(H) [I; P] = 0; raises `NoFactor`."""
    n, variable, signs = plant.order, plant.variable, plant.symbols.signs
    if n > (_EXACT_UP_TO if is_numeric(regulator) else MOST_WITH_PARAMETERS):
        raise NoFactor(f"with parameters a closed form is looked for up to order {MOST_WITH_PARAMETERS}")
    H = hamiltonian(regulator)
    in_parameters = not is_numeric(regulator)
    whole = regulator.discrete and in_parameters
    factors = stable_factors(H.characteristic_polynomial(variable), variable, signs, whole=whole)
    if sum(factor.degree(variable) for factor in factors) != n:
        raise NoFactor("the polynomial has roots on the boundary")
    if not in_parameters and len({root.name for factor in factors for root in all_roots(factor)}) > _MOST_ROOTS:
        raise NoFactor("its closed form is too long")
    product = Matrix.identity(2 * n)
    for factor in factors:
        product = in_normal_form(product @ polynomial_of(factor, variable, H))
    left, right = product.select(range(2 * n), range(n, 2 * n)), product.select(range(2 * n), range(n))
    relations = identities(factors)[1]
    try:
        P, _ = solve_or_refute(left, -right, Ideal.of(relations) if relations else None)
    except TooLarge as error:
        raise NoFactor("its closed form is too long") from error
    if P is None:
        raise NoFactor("the polynomial has roots on the boundary")
    P = in_normal_form(P)
    A, B, R, N = regulator.A, regulator.B, regulator.R, regulator.N
    weight, coupled = (R + B.T @ P @ B, B.T @ P @ A) if regulator.discrete else (R, B.T @ P)
    gain = in_normal_form(in_normal_form(weight).solve(coupled + N.T))
    loop = (A - B @ gain).characteristic_polynomial(variable)
    polynomial = from_coefficients([reduced(c) for c in loop.coefficients(variable)], variable)
    if in_parameters:  # 1 − π = 2σ/(1 + σ) is seen to be positive, and it would not with the root in the numerator
        polynomial = product_of(factors)
        polynomial = to_disc(polynomial, variable, reduce=False) if regulator.discrete else polynomial
        if stability(polynomial, variable, with_signs(signs, polynomial), discrete=regulator.discrete).verdict != "yes":
            raise NoFactor("the declared signs do not show that the loop is stable")
    most = _MOST_TERMS if is_numeric(regulator) else _MOST_TERMS_WITH_PARAMETERS
    if max(entry.size for entry in (*P.entries, *gain.entries)) > most or not _are_decidable([P, gain, *factors]):
        raise NoFactor("its closed form is too long")
    return Solution(P, gain, polynomial, factors)


def _are_decidable(values: Iterable[Scalar | Matrix]) -> bool:
    """Return whether it can be decided what vanishes where the square roots of some values are what they are."""
    try:
        return not Ideal.where(identities(values)[1]).is_whole
    except TooLarge:
        return False


def in_normal_form(matrix: Matrix) -> Matrix:
    """Return a matrix with the normal forms of its entries, roots in roots among them."""
    return Matrix.of([[reduced(entry) for entry in row] for row in matrix.normal().rows], matrix.shape[1])
