"""Output regulation:  ẋ = A x + B u + E w,  ẇ = S w,  y → r = Q w,  by  u = −K x + (Γ + KΠ) w.

Where Π and Γ solve the regulator equations  Π S = A Π + B Γ + E,  C Π + D Γ = Q,  x − Π w obeys ẋ = (A − BK) x, and
y − r = (C − DK)(x − Π w).  They have a solution for every E and Q if and only if rank [A − λI, B; C, D] = n + p at the
eigenvalues λ of S.  Where they have none there are U and V with U A + V C = S U, U B + V D = 0 and tr UE ≠ tr VQ.
"""

from __future__ import annotations

import itertools
import math
from functools import cached_property
from typing import TYPE_CHECKING, Any, ClassVar, NamedTuple, Self, TypedDict

from symobs.exact import (
    EIGENVALUE,
    Ideal,
    Matrix,
    Scalar,
    TooLarge,
    kernel,
    modulo,
    product_of,
    rank,
    resultant,
    roots_of,
    solve_or_refute,
)
from symobs.exact.linear_algebra.transfer_function import Realisation
from symobs.formula.tree import Environment, Roots
from symobs.ground.dataclass import dataclass
from symobs.ground.errors import CertificateRejected, InputError, Undecided
from symobs.proof.derivation.builder import Builder, predicate, relation
from symobs.stability.criteria.stability import stability
from symobs.system.conditions import Condition, vanishing_factors
from symobs.system.specification import desired_polynomial, in_common_field, read_gain, reject_both
from symobs.tasks.analysis.page_parts import case_steps, given
from symobs.tasks.analysis.strata.strata import common_places, places, solved
from symobs.tasks.design.compensator.compensator import KnownState
from symobs.tasks.design.disturbance.disturbance_input import Exosystem, read_generator
from symobs.tasks.design.disturbance.disturbance_observer import (
    DisturbanceObserver,
    name_extended,
    write_both_together,
    write_gain_of_both,
    write_observer_of_both,
)
from symobs.tasks.design.gain.gain_cases import places_beside
from symobs.tasks.design.gain.gain_design import FEEDBACK, page_style
from symobs.tasks.design.gain.gain_page import write_gain
from symobs.tasks.design.pole_cautions import caution_poles
from symobs.tasks.result import Case, Result, holds, method, page_of, poles_of, task
from symobs.tasks.result import choose as choose_method
from symobs.tasks.result.answers import named_found
from symobs.tasks.result.control_systems import Controller

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from symobs.exact import Root
    from symobs.proof.certificate.claims import Certificate, Claim
    from symobs.system import StateSpace
    from symobs.system.specification import DesiredPolynomial, GainText, MatrixText, Name, Poles, PolynomialText
    from symobs.tasks.analysis.strata.strata import Place
    from symobs.tasks.design.gain.gain_design import GainDesign


#: The regulator equations are solved for up to this many unknown entries, without and with parameters.
_MOST_ENTRIES, _MOST_WITH_PARAMETERS = 120, 40


class Exogenous(NamedTuple):
    """S, Q and E of  ẇ = S w,  r = Q w,  ẋ = A x + B u + E w."""

    S: Matrix
    Q: Matrix
    E: Matrix

    @property
    def order(self) -> int:
        """The number of states of the exosystem."""
        return self.S.shape[0]

    @property
    def disturbs(self) -> bool:
        """Whether the exosystem acts on the state."""
        return not self.E.is_zero


#: The matrices of the exosystem by the letters of the page.
_LETTERS = {"S_w": "S", "Q_r": "Q", "E_d": "E"}


class RegulatorSolution(TypedDict):
    """Π and Γ that solve the regulator equations, or U and V that show that there are none."""

    Pi: Matrix | None
    Gamma: Matrix | None
    U: Matrix | None
    V: Matrix | None


class RegulatorLaw(TypedDict):
    """K, and F = Γ + KΠ."""

    K: Matrix | None
    F: Matrix | None


class RegulationAnswer(RegulatorSolution, RegulatorLaw):
    """The factors of χ_S at whose roots rows of [A − λI, B; C, D] are dependent, each with such a row; None: not known."""

    blocked: tuple[tuple[Scalar, Matrix], ...] | None


@dataclass
class OutputRegulation(Result):
    """Π and Γ that solve the regulator equations and K, or why there are none; with an observer of (x, w) where asked for.

    `loop` is the state feedback and `estimator` the observer, each with its own claims.
    """

    answer: RegulationAnswer
    exogenous: Exogenous
    loop: KnownState
    estimator: DisturbanceObserver | None

    task: ClassVar[str] = "output_regulation"
    answered_by = ("Pi", "Gamma", "K")
    only_value = ("Pi", "Gamma")
    gains: ClassVar[tuple[str, ...]] = ("K",)
    claimed = ("Pi", "Gamma")
    leads = ("Pi", "Gamma")
    letters: ClassVar[Mapping[str, str]] = {"Pi": "Pi_w", "Gamma": "Gamma_w", "K": "K", "F": "F_w"}
    cards: ClassVar[tuple[str, ...]] = ("K", "Pi", "Gamma", "F")

    @classmethod
    def of(
        cls, exogenous: Exogenous, loop: KnownState, estimator: DisturbanceObserver | None, method_name: str
    ) -> Self:
        """Return the regulator, or the negative result."""
        plant, found = loop.plant, solution(loop.plant, exogenous, {})
        law, blocked = _law(loop, found), _blocked(plant, exogenous.S)
        return cls(plant, method_name, {**found, "blocked": blocked, **law}, exogenous, loop, estimator)

    def has_one_value(self, name: str) -> bool:
        """Whether Π and Γ are unique: no more inputs than outputs, and no eigenvalue of S is a zero of the plant."""
        is_unique = self.answer["blocked"] == () and self.plant.inputs <= self.plant.outputs
        return super().has_one_value(name) and is_unique

    def with_answer(self, name: str, value: object) -> Self:
        """Return the regulator with another K or L, or another Π (Γ) and the Γ (Π) that belongs to it."""
        if name in self.gains and isinstance(value, Matrix):
            return self.with_gains({name: value})
        sought = {"Pi": self.answer["Pi"], "Gamma": self.answer["Gamma"]}
        if name not in sought or not isinstance(value, Matrix):
            return super().with_answer(name, value)
        own = sought[name]
        if own is None or value.shape != own.shape:
            message = f"{name} is {value.shape[0]}×{value.shape[1]}"
            raise CertificateRejected(message, repair="give one of the shape of the answer")
        found = solution(self.plant, self.exogenous, {name: value})
        if found["Pi"] is None:
            return super().with_answer(name, value)
        answer: RegulationAnswer = {**self.answer, "Pi": found["Pi"], "Gamma": found["Gamma"]}
        answer = {**answer, **_law(self.loop, answer)}
        return type(self)(self.plant, self.method, answer, self.exogenous, self.loop, self.estimator).in_place_of(self)

    def with_gains(self, gains: Mapping[str, Matrix]) -> Self:
        """Return the regulator with other gains, which have to place the same poles."""
        loop = self.loop.with_gains({"K": gains["K"]}) if "K" in gains else self.loop
        estimator = self.estimator
        if estimator is not None and "L" in gains:
            estimator = estimator.with_gains(self._parts(gains["L"]))
        return self._with(loop, estimator)

    def following_from(self, gains: Mapping[str, Matrix]) -> Self:
        """Return the regulator of given gains."""
        loop = self.loop.following_from({"K": gains["K"]}) if "K" in gains else self.loop
        estimator = self.estimator
        if estimator is not None and "L" in gains:
            estimator = estimator.following_from(self._parts(gains["L"]))
        return self._with(loop, estimator)

    @property
    def named_data(self) -> Mapping[str, Any]:
        """S, Q_r, also called Q, and E of the exosystem, Π and Γ."""
        S, Q, E = self.exogenous
        return {"S": S, "Q_r": Q, "Q": Q, "E": E, "Pi": self.answer["Pi"], "Gamma": self.answer["Gamma"]}

    def consequences(self, given: Mapping[str, Any]) -> Mapping[str, Any]:
        """Return Γ with B Γ = ΠS − AΠ − E in the rows that B reaches, for another Π, and F = Γ + KΠ."""
        m, (S, _, E) = self.plant.matrices, self.exogenous
        Pi, Gamma, K = given.get("Pi", self.answer["Pi"]), given.get("Gamma"), self.answer["K"]
        if Pi is None or Pi.shape != E.shape:
            return {}
        if Gamma is None:
            reached = m.B.T @ m.B
            if reached.determinant().is_zero:
                return {}
            Gamma = reached.solve(m.B.T @ (Pi @ S - m.A @ Pi - E)).normal()
        own = K is not None and Gamma.shape == (K.shape[0], Pi.shape[1])
        return {"Gamma": Gamma, **({"F": (Gamma + K @ Pi).normal()} if own else {})}

    def _with(self, loop: KnownState, estimator: DisturbanceObserver | None) -> Self:
        answer: RegulationAnswer = {**self.answer, **_law(loop, self.answer)}
        return type(self)(self.plant, self.method, answer, self.exogenous, loop, estimator).in_place_of(self)

    def _parts(self, L: Matrix) -> dict[str, Matrix]:
        """Return L_x and L_w."""
        n, every = self.plant.order, range(L.shape[1])
        return {"L_x": L.select(range(n), every), "L_w": L.select(range(n, L.shape[0]), every)}

    def design_of(self, gain: str) -> GainDesign:
        """Return the state feedback for K, the observer of plant and exosystem for L."""
        return self.estimator.inner if gain == "L" and self.estimator is not None else self.loop.feedback

    def claims(self) -> Iterator[Claim]:
        """Yield the regulator equations, or that they have no solution; F; and where the plant has blocking zeros."""
        answer, plant = self.answer, self.plant
        Pi, U, K, F = answer["Pi"], answer["U"], answer["K"], answer["F"]
        if (
            (Pi is None) != (answer["Gamma"] is None)
            or (Pi is None) != (U is not None and answer["V"] is not None)
            or (F is None) != (Pi is None or K is None)
            or self.loop.plant is not plant
            or (self.estimator is not None and self.estimator.plant is not plant)
        ):
            message = "the regulator equations have a solution exactly where nothing shows that they have none"
            raise CertificateRejected(message)
        e = self.meanings(**self.exogenous._asdict())
        if K is not self.loop.answer["K"]:
            yield holds(e, "K = {value}", "K is the certified gain", value=self.loop.answer["K"])
        if U is not None:
            yield holds(e, "U*A + V*C = S*U")
            yield holds(e, "U*B + V*D = 0")
            yield holds(e, "{trace} !== 0", trace=None if self.refutation is None else self.refutation[-1])
        else:
            yield holds(e, "A*Pi + B*Gamma + E = Pi*S")
            yield holds(e, "C*Pi + D*Gamma = Q")
            if F is not None:
                yield holds(e, "F = Gamma + K*Pi")
        yield from _blocking_claims(plant, self.exogenous.S, answer["blocked"])

    @property
    def refutation(self) -> tuple[Matrix, Matrix, Scalar] | None:
        """U, V, and tr UE − tr VQ, which would be 0 if the regulator equations had a solution."""
        (_, Q, E), U, V = self.exogenous, self.answer["U"], self.answer["V"]
        return None if U is None or V is None else (U, V, trace(U, E) - trace(V, Q))

    @property
    def has_law(self) -> bool:
        """Whether the equations have a solution and all gains exist."""
        return self.answer["F"] is not None and (self.estimator is None or self.estimator.answer["L_x"] is not None)

    @property
    def all_certificates(self) -> tuple[Certificate, ...]:
        """The certificates of the gains and of the solution."""
        observer = () if self.estimator is None else self.estimator.all_certificates
        return (*self.loop.all_certificates, *observer, *self.certificates)

    @property
    def verdict(self) -> str:
        """`no` where the equations have no solution or a gain does not exist."""
        return super().verdict if self.has_law else "no"

    @property
    def data(self) -> Mapping[str, Scalar | Matrix]:
        """The matrices of the plant, and those of the exosystem."""
        return {**super().data, **{name: getattr(self.exogenous, of) for name, of in _LETTERS.items()}}

    @property
    def further_data(self) -> tuple[Matrix, ...]:
        """The matrices of the exosystem."""
        return self.exogenous

    @cached_property
    def holds_where(self) -> tuple[Condition, ...]:
        """The conditions of the solution and of the gains."""
        found = {condition.expression: condition for condition in (*self.loop.holds_where, *super().holds_where)}
        if self.estimator is not None:
            found = {c.expression: c for c in self.estimator.holds_where} | found
        found |= {condition.expression: condition for condition in self.domain}
        return tuple(found.values())

    @cached_property
    def case_tree(self) -> tuple[Case, ...]:
        """The strata of the gains, those of the solution, and where there is one after all."""

        def on(there: StateSpace, values: dict[str, Scalar]) -> Result:
            exogenous = Exogenous(*(modulo(part.substitute(values), there.ideal) for part in self.exogenous))
            loop = self.loop.on(there, values)
            desired = None if self.estimator is None else self.estimator.desired.substitute(values)
            found: Result = there.once(
                (type(self), self.method, exogenous, desired, *loop.asked_for),
                lambda: type(self).of(exogenous, loop, _estimator(there, exogenous, desired), self.method),
            )
            return found

        places_asked = {frozenset(place.when): place for place in self._places}
        beside = {frozenset(place.when): place for place in _drops(self.plant, self.exogenous.S)}
        also = [place for when, place in beside.items() if when not in places_asked]
        more = (case for case in solved(self.plant, also, on) if not self._is_blocked_alike(case))
        return (*solved(self.plant, places_asked.values(), on), *more)

    def _is_blocked_alike(self, case: Case) -> bool:
        """Return whether the same eigenvalues are zeros of the plant in a case, as far as that is known."""
        if not isinstance(case.result, OutputRegulation):
            return True
        own, there = (result.answer["blocked"] for result in (self, case.result))
        return own is not None and there is not None and [f for f, _ in own] == [f for f, _ in there]

    @property
    def _places(self) -> tuple[Place, ...]:
        further = () if self.estimator is None else places_beside(self, self.estimator.inner)
        found = (*self.loop.gain_places, *further)
        if self.refutation is not None:
            obstacle = self.refutation[-1].numerator
            return found if obstacle.is_constant else (*found, *common_places(self.plant, [obstacle]))
        known = {condition.expression for condition in self.loop.holds_where}
        own = [c.expression for c in super().holds_where if c.kind == "claim" and c.expression not in known]
        return (*found, *places(self.plant, own))

    @cached_property
    def fields(self) -> Mapping[str, Any]:
        """Π, Γ, K, F = Γ + KΠ, whether the equations have a solution, and the eigenvalues of S that are zeros of the plant."""
        answer = self.answer
        found: dict[str, Any] = {"Pi": answer["Pi"], "Gamma": answer["Gamma"], "K": answer["K"], "F": answer["F"]}
        found["solvable"] = answer["Pi"] is not None
        found["blocked_modes"] = self._blocked_roots
        found["fixed_modes"] = self.loop.unmoved_modes
        if self.estimator is not None:
            inner = self.estimator.inner
            found |= {"L": inner.answer["L"], "fixed_modes": (*found["fixed_modes"], *inner.unmoved_modes)}
        closed = self.closed_loop
        polynomial = None
        if closed is not None:
            polynomial = self.loop.feedback.answer["polynomial"]
            if self.estimator is not None:
                polynomial = polynomial * self.estimator.answer["polynomial"]
        return found | {"polynomial": polynomial, "closed_loop_matrix": closed}

    @property
    def _blocked_roots(self) -> tuple[Root, ...] | None:
        """The eigenvalues λ of S with rank [A − λI, B; C, D] < n + p; None where that is not known."""
        blocked = self.answer["blocked"]
        if blocked is None:
            return None
        return tuple(root for factor, _ in blocked for root in roots_of(factor, self.plant.variable))

    @property
    def closed_loop(self) -> Matrix | None:
        """A − BK, with an observer [A − BK, B [K, −F]; 0, Â − LĈ] in (x − Πw, e, e_w); None where there is no law."""
        m, K, F = self.plant.matrices, self.answer["K"], self.answer["F"]
        if K is None or F is None or not self.has_law:
            return None
        own = (m.A - m.B @ K).normal()
        if self.estimator is None:
            return own
        error = self.estimator.inner.fields["A"]
        zero = Matrix.zeros(error.shape[0], self.plant.order)
        return Matrix.block([[own, (m.B @ Matrix.block([[K, -F]])).normal()], [zero, error]])

    @property
    def free_signals(self) -> Mapping[str, int]:
        """The state of the exosystem, and its estimate."""
        return dict.fromkeys(("w_e", "w_hat"), self.exogenous.order)


@dataclass
class EstimatedOutputRegulation(OutputRegulation):
    """The regulator u = −K x̂ + (Γ + KΠ) ŵ with an observer of plant and exosystem."""

    estimator: DisturbanceObserver

    gains = ("K", "L")
    letters: ClassVar[Mapping[str, str]] = {
        **OutputRegulation.letters,
        "L": "L",
        "polynomial": "chi_cl",
        "closed_loop_matrix": "A_cl",
    }
    cards = ("K", "L", "Pi", "Gamma", "F")

    @property
    def controller(self) -> Controller | None:
        """Y → u = −K x̂ + F ŵ."""
        K, F = self.answer["K"], self.answer["F"]
        if K is None or F is None or not self.has_law:
            return None
        inner, law = self.estimator.inner, Matrix.block([[-K, F]])
        found = inner.fields
        own = Realisation(
            (found["A"] + found["B_u"] @ law).normal(),
            found["B_y"],
            law,
            Matrix.zeros(law.shape[0], self.plant.outputs),
        )
        sizes = (("y", self.plant.outputs),), ("u", self.plant.inputs)
        return Controller("compensator", own, *sizes, returns=True, gains=self.gains)


def trace(left: Matrix, right: Matrix) -> Scalar:
    """Return the trace of a product: the sum of the products of entries."""
    return (Matrix.row(left.T.entries) @ Matrix.column(right.entries))[0, 0]


def _law(loop: KnownState, answer: RegulatorSolution) -> RegulatorLaw:
    """Return K, and F = Γ + KΠ where there is a law."""
    K, Pi, Gamma = loop.answer["K"], answer["Pi"], answer["Gamma"]
    return {"K": K, "F": None if K is None or Pi is None or Gamma is None else (Gamma + K @ Pi).normal()}


def solution(plant: StateSpace, exogenous: Exogenous, known: Mapping[str, Matrix]) -> RegulatorSolution:
    """Return Π and Γ, some of them known, that solve the regulator equations, or else U and V."""
    m, (S, Q, E) = plant.matrices, exogenous
    n, q = plant.order, exogenous.order
    shapes = {name: shape for name, shape in (("Pi", (n, q)), ("Gamma", (plant.inputs, q))) if name not in known}

    def moved(parts: Mapping[str, Matrix]) -> Matrix:
        Pi = parts.get("Pi", Matrix.zeros(n, q))
        Gamma = parts.get("Gamma", Matrix.zeros(plant.inputs, q))
        over, under = Pi @ S - m.A @ Pi - m.B @ Gamma, m.C @ Pi + m.D @ Gamma
        return Matrix.column([*over.normal().entries, *under.normal().entries])

    units = [
        moved({name: Matrix.of([[int((i, j) == (k, l)) for l in range(q)] for k in range(rows)], q)})
        for name, (rows, _) in shapes.items()
        for i in range(rows)
        for j in range(q)
    ]
    right = Matrix.column([*E.entries, *Q.entries]) - moved(known)
    found, row = solve_or_refute(Matrix.block([units]), right.normal(), plant.ideal)
    if found is None:
        assert row is not None  # noqa: S101 - where there is no solution there is a row
        entries, size = row.entries, n * q
        U = Matrix.of([entries[i * q : i * q + q] for i in range(n)], q).T
        V = -Matrix.of([entries[size + i * q : size + i * q + q] for i in range(plant.outputs)], q).T
        return {"Pi": None, "Gamma": None, "U": U, "V": V}
    values, parts = list(modulo(found.normal(), plant.ideal).entries), dict(known)
    for name, (rows, _) in shapes.items():
        parts[name] = Matrix.of([values[i * q : i * q + q] for i in range(rows)], q)
        values = values[rows * q :]
    return {"Pi": parts["Pi"], "Gamma": parts["Gamma"], "U": None, "V": None}


def _pencil(plant: StateSpace, factor: Scalar) -> tuple[Matrix, tuple[Scalar, ...]]:
    """Return [A − λI, B; C, D] at the roots λ of a factor, and what vanishes there."""
    m, variable = plant.matrices, plant.variable
    if factor.degree(variable) == 1:
        lead, constant = factor.coefficients(variable)
        at, vanishing = -constant / lead, []
    else:
        at = Scalar.symbol(EIGENVALUE)
        vanishing = [factor.substitute({variable: at})]
    return Matrix.block([[m.A - Matrix.identity(plant.order) * at, m.B], [m.C, m.D]]).normal(), tuple(vanishing)


def _blocked(plant: StateSpace, S: Matrix) -> tuple[tuple[Scalar, Matrix], ...] | None:
    """Return the factors of χ_S at whose roots [A − λI, B; C, D] has dependent rows, and a row w ≠ 0 with w [ … ] = 0."""
    found = []
    chi = plant.simplified(S.characteristic_polynomial(plant.variable))
    try:
        for found_factor, _ in chi.numerator.factors()[1]:
            if not found_factor.degree(plant.variable):
                continue
            factor = found_factor / found_factor.coefficients(plant.variable)[0]
            matrix, relations = _pencil(plant, factor)
            ideal = Ideal.of((*plant.equations, *relations)) if plant.equations or relations else None
            left = kernel(matrix.T, ideal)
            if left.shape[1]:
                found.append((factor, left.select(range(left.shape[0]), [0]).T))
    except TooLarge:
        return None
    return tuple(found)


#: Of more minors that decide whether an eigenvalue is a zero none is looked at.
_MINORS = 12


def _drops(plant: StateSpace, S: Matrix) -> Iterator[Place]:
    """Yield strata on which an eigenvalue of S may be a zero of the plant that is none in general, where these are few."""
    chi, variable = plant.simplified(S.characteristic_polynomial(plant.variable)), plant.variable
    for found, _ in chi.numerator.factors()[1]:
        if not found.degree(variable):
            continue
        matrix, relations = _pencil(plant, found / found.coefficients(variable)[0])
        rows, columns = matrix.shape
        if plant.equations or rows > columns or math.comb(columns, rows) > _MINORS or not matrix.names:
            continue
        chosen = itertools.combinations(range(columns), rows)
        minors = [matrix.select(range(rows), each).determinant().numerator for each in chosen]
        if relations:  # at all roots of the factor together
            minors = [resultant(minor, relations[0].numerator, EIGENVALUE) for minor in minors if not minor.is_zero]
        minors = [minor for minor in minors if not minor.is_zero]
        if minors and not any(minor.is_constant for minor in minors):
            yield from places(plant, minors) if len(minors) == 1 else common_places(plant, minors)


def _blocking_claims(
    plant: StateSpace, S: Matrix, blocked: tuple[tuple[Scalar, Matrix], ...] | None
) -> Iterator[Claim]:
    """Yield that the factors are factors of χ_S, at whose roots rows of [A − λI, B; C, D] are dependent."""
    for factor, row in blocked or ():
        matrix, relations = _pencil(plant, factor)
        e = Environment(variable=plant.variable, values={"w": row, "S_w": S}, relations=relations)
        rest = S.characteristic_polynomial(plant.variable) / factor
        if not plant.equations and not rest.is_polynomial_in(plant.variable):
            raise CertificateRejected(f"{factor} is no factor of the characteristic polynomial of S")
        yield holds(e, "w {pencil} = 0", f"where {factor} = 0", pencil=matrix)
        yield holds(e, "w !== 0")


def _estimator(
    plant: StateSpace, exogenous: Exogenous, desired: DesiredPolynomial | None
) -> DisturbanceObserver | None:
    """Return the observer of plant and exosystem, where one is asked for."""
    if desired is None:
        return None
    whole = Exosystem(exogenous.E, exogenous.S, Matrix.identity(exogenous.order))
    return DisturbanceObserver.of(plant, whole, desired, "extended_state")


@method("output_regulation/regulator_equations", source="francis1977; trentelman2001, ch. 9")
def regulator_equations(exogenous: Exogenous, loop: KnownState, desired: DesiredPolynomial | None) -> OutputRegulation:
    """Solve the regulator equations as linear equations of the entries of Π and Γ; u = −K x + (Γ + KΠ) w."""
    kind = OutputRegulation if desired is None else EstimatedOutputRegulation
    return kind.of(exogenous, loop, _estimator(loop.plant, exogenous, desired), "regulator_equations")


def extended_order(plant: StateSpace, asked: Mapping[str, Any]) -> int:
    """Return the number of poles of an observer of plant and exosystem."""
    return plant.order + read_exogenous(plant, asked.get("S"), asked.get("reference"), asked.get("E")).order


def read_exogenous(plant: StateSpace, S: object, reference: object, E: object) -> Exogenous:
    """Return S, Q and E; raises `InputError`, `ShapeMismatch`."""
    for name, value, example in (("S", S, "[0 1; -1 0]"), ("reference", reference, "[1 0]")):
        if value is None:
            message = f"{name} is missing"
            repair = f'give {name} = "{example}", for example: r = Q w is to be followed, w\' = S w'
            raise InputError(message, where=f"specification.{name}", repair=repair)
    generator = read_generator(plant, S)
    q = generator.shape[0]
    Q = read_gain(reference, plant, "reference", (plant.outputs, q))
    disturbs = Matrix.zeros(plant.order, q) if E is None else read_gain(E, plant, "E", (plant.order, q))
    return Exogenous(generator, Q, disturbs)


@task
@poles_of(observer_poles=extended_order)
def output_regulation(
    plant: StateSpace,
    *,
    S: MatrixText = None,
    reference: MatrixText = None,
    E: MatrixText = None,
    poles: Poles = None,
    polynomial: PolynomialText = None,
    K: GainText = None,
    observer_poles: Poles = None,
    observer_polynomial: PolynomialText = None,
    choose: Name = "auto",
    method: Name = "auto",
) -> Result:
    """Let y follow r = Q w, ẇ = S w, in spite of a disturbance E w, by u = −K x + (Γ + KΠ) w, ΠS = AΠ + BΓ + E, CΠ + DΓ = Q.

    plant                                   n states, m inputs, p outputs, D allowed
    S                                       q×q: [0 omega; -omega 0] generates sinusoids, [0] constants
    reference                               Q, p×q: r = Q w
    E                                       n×q: how w disturbs the state; 0 where it is left out
    poles or polynomial, or K               the n poles of A − BK, or a given m×n gain
    observer_poles or observer_polynomial   the n + q poles of an observer of (x, w) from y; without them x and w are known
    choose                                  which gains of several inputs or outputs: "simple" or "small", as for
                                            `state_feedback`
    Returns Pi (n×q), Gamma (m×q), solvable, K, F (Γ + KΠ, of w), blocked_modes (the eigenvalues λ of S with
    rank [A − λI, B; C, D] < n + p: zeros of the plant), fixed_modes, polynomial, closed_loop_matrix in x − Πw, and with an
    observer L ((n + q)×p), polynomial and matrix of the whole loop.  The verdict is `no` where the equations have no
    solution, or a gain does not exist.  Raises `InputError` for wrong poles or shapes; `Undecided` for too many entries.
    Source: B. A. Francis (1977); H. L. Trentelman, A. A. Stoorvogel, M. Hautus, Control Theory for Linear Systems, ch. 9.
    """
    plant = plant.knowing(S, reference, E, poles, polynomial, K, observer_poles, observer_polynomial)
    plant.require("B", "C", task="output_regulation")
    exogenous = read_exogenous(plant, S, reference, E)
    if K is not None:
        reject_both("K", K, poles, polynomial)
    gain = None if K is None else read_gain(K, plant, "K", (plant.inputs, plant.order))
    asked = desired_polynomial(plant, poles, polynomial, choose=choose) if gain is None else gain
    names = ("observer_poles", "observer_polynomial")
    desired = desired_polynomial(
        plant,
        observer_poles,
        observer_polynomial,
        names=names,
        degree=plant.order + exogenous.order,
        required=False,
        choose=choose,
    )
    entries, letters = exogenous.order * (plant.order + plant.inputs), plant.field.names
    if entries > (_MOST_WITH_PARAMETERS if letters else _MOST_ENTRIES):
        raise Undecided(f"output_regulation is undecided: {entries} unknown entries are too many")
    plant, (asked, desired, *parts) = in_common_field(plant, asked, desired, *exogenous)
    loop = KnownState.design(plant, (asked,), "state_feedback")
    found: Result = choose_method("output_regulation", method, "regulator_equations").solve(
        Exogenous(*parts), loop, desired
    )
    return found.asked(method)


# The page: the gain, the exosystem, the regulator equations, the law, the deviation from Πw; with an observer of (x, w).


@page_of(OutputRegulation)
def write_output_regulation(page: Builder, design: OutputRegulation) -> None:
    """Write the whole page."""
    loop, exogenous, estimator = design.loop, design.exogenous, design.estimator
    asked = ("control", loop.feedback.desired), ("observer", None if estimator is None else estimator.desired)
    given(page, *asked, disturbed=exogenous.E if exogenous.disturbs else None, by="w_e")
    with page.section("state_feedback"):
        write_gain(page, loop.feedback, FEEDBACK, page_style("auto", page.plant, several=page.plant.inputs > 1))
    with page.section("output_regulation"):
        _exosystem(page, design)
        _solution(page, design)
        if design.answer["F"] is not None and estimator is None:
            _state_law(page, design)
    if estimator is not None:
        with page.section("regulation_observer"):
            _observer(page, design, estimator)
    page.steps += case_steps(page, design, _case)


def _case(page: Builder, design: OutputRegulation) -> None:
    """Write what is found on a stratum."""
    for name, of in _LETTERS.items():
        if page.defines(name) or name != "E_d":
            page.set(name, getattr(design.exogenous, of))
    _solution(page, design)
    if design.answer["F"] is not None and design.answer["K"] is not None:
        page.set("K", design.answer["K"])
        page.define("F_w", "Gamma_w + K Pi_w", say="regulation_gain")
    if design.estimator is not None:
        page.set("phi_o", design.estimator.desired.polynomial)
        name_extended(page, design.estimator, silent=True)
        write_gain_of_both(page, design.estimator)


def _exosystem(page: Builder, design: OutputRegulation) -> None:
    """Write ẇ = S w and r = Q w."""
    S, Q, E = design.exogenous
    page.set("S_w", S)
    page.set("Q_r", Q)
    if design.estimator is not None and not page.defines("E_d"):
        page.set("E_d", E)
    page.dynamics("w_e", "S_w w_e", silent=True)
    page.signal("r_w", "Q_r w_e", silent=True)
    page.equal(
        "w_e' = S_w w_e = #S_w w_e",
        "r_w = Q_r w_e = #Q_r w_e",
        say="regulation_exosystem_E" if design.exogenous.disturbs else "regulation_exosystem",
    )
    which = ("E" if design.exogenous.disturbs else "") + ("D" if page.plant.matrices.has_feedthrough else "")
    page.remark(f"regulation_sought_{which}" if which else "regulation_sought")


def _solution(page: Builder, design: OutputRegulation) -> None:
    """Write the regulator equations and their solution, or what shows that there is none."""
    m, refutation = page.plant.matrices, design.refutation
    if refutation is not None:
        _impossible(page, design, *refutation)
        return
    found = named_found({"Pi_w": design.answer["Pi"], "Gamma_w": design.answer["Gamma"]})
    known = {condition.expression for condition in design.domain}
    below = [part.common_denominator() for part in found.values()]
    factors = [f for f in vanishing_factors(below, page.plant.symbols.signs) if f not in known]
    if factors:
        page.assume("regulation_provided", *factors)
    for name, part in found.items():
        page.set(name, part)
    page.equal("Pi_w = #", "Gamma_w = #", say="regulation_solution", answer=True)
    E, D = " + E_d" if design.exogenous.disturbs else "", " + D Gamma_w" if m.has_feedthrough else ""
    state, output = page.line(f"A Pi_w + B Gamma_w{E} = Pi_w S_w"), page.line(f"C Pi_w{D} = Q_r")
    page.verified("regulation_checked", state=state, output=output)


def _impossible(page: Builder, design: OutputRegulation, U: Matrix, V: Matrix, obstacle: Scalar) -> None:
    """Write U and V, and the zeros of the plant among the eigenvalues of S."""
    plant = page.plant
    n, p, q = plant.order, plant.outputs, design.exogenous.order
    page.set("U_r", U)
    page.set("V_r", V)
    page.equal("U_r = #", "V_r = #", say="regulation_obstacle")
    D = page["D"] if plant.matrices.has_feedthrough else plant.matrices.D
    annuls = page.line("[U_r, V_r] [A, B; C, {D}] = [S_w U_r, {zero}]", D=D, zero=Matrix.zeros(q, plant.inputs))
    disturbed = design.exogenous.disturbs
    found = page.value(obstacle if disturbed else -obstacle)
    page.conclude("regulation_impossible_E" if disturbed else "regulation_impossible", annuls=annuls, trace=found)
    blocked = design.answer["blocked"]
    if not blocked:
        return
    roots = product_of(factor for factor, _ in blocked)
    pencil = page("[A - s I, B; C, {D}]", D=D)
    of_S = page["det(pencil(S_w))"].scalar
    is_zero = rank(pencil.value, plant.ideal) == n + p
    page.conclude(
        "regulation_zeros" if is_zero else "regulation_rank",
        modes=Roots(page("det(pencil(S_w)) / {rest}", rest=of_S / roots).formula, roots_of(roots, plant.variable)),
        pencil=pencil,
        size=page.value(n + p),
    )


def _state_law(page: Builder, design: OutputRegulation) -> None:
    """Write u = −K x + F w, and that x − Πw obeys the closed loop."""
    page.define("F_w", "Gamma_w + K Pi_w", say="regulation_gain", answer=True)
    page.signal("u", "(-K) x + F_w w_e", say="regulation_law")
    _deviation(page, design)


def _deviation(page: Builder, design: OutputRegulation) -> None:
    """Write the equation of x − Πw and the control error, and whether they vanish."""
    through = page.plant.matrices.has_feedthrough
    page.signal("x_w", "x - Pi_w w_e", silent=True)
    rate, seen = "(A - B K) x_w", "(C - D K) x_w" if through else "C x_w"
    if design.estimator is not None:
        rate += " + B (K e - F_w e_w)"
        seen += " + D (K e - F_w e_w)" if through else ""
    deviation = page.line("x_w = x - Pi_w w_e")
    page.equal(f"x_w' = {rate}", f"y - r_w = {seen}", say="regulation_deviation", deviation=deviation)
    desired = design.loop.feedback.desired
    if desired is not None:
        caution_poles(page, desired, "phi_c", "state_feedback")
    if design.estimator is None and _is_surely_stable(design):
        loop = relation(FEEDBACK.error_determinant(page), page["phi_c"])
        page.conclude("regulation_reached", loop, predicate("stable", page["phi_c"]))


def _is_surely_stable(design: OutputRegulation) -> bool:
    """Return whether the desired polynomials are stable numbers."""
    plant = design.plant
    halves = [design.loop.feedback.desired, *([] if design.estimator is None else [design.estimator.desired])]
    return all(
        half is not None
        and half.is_numeric
        and stability(half.polynomial, plant.variable, {}, discrete=plant.is_discrete).verdict == "yes"
        for half in halves
    )


def _observer(page: Builder, design: OutputRegulation, estimator: DisturbanceObserver) -> None:
    """Write the observer of plant and exosystem, the law, and the whole loop."""
    write_both_together(page, estimator)
    write_gain_of_both(page, estimator)
    if not design.has_law:
        return
    write_observer_of_both(page, estimator, page["E_d w_hat"], say="regulation_estimates")
    page.define("F_w", "Gamma_w + K Pi_w", say="regulation_gain", answer=True)
    page.signal("u", "(-K) x_hat + F_w w_hat", say="regulation_law")
    _deviation(page, design)
    zero = Matrix.zeros(design.plant.order + design.exogenous.order, design.plant.order)
    loop = page("[A - B K, [B K, (-B) F_w]; {zero}, A_hat - L C_hat]", zero=zero)
    page.define("A_cl", loop, say="regulation_loop")
    if design.loop.feedback.desired is None:
        return
    whole = page.line("det(pencil(A_cl)) = phi_c phi_o")
    page.equal(whole, say="regulation_polynomial")
    if _is_surely_stable(design):
        page.conclude("regulation_reached_estimated", whole, predicate("stable", page["phi_c phi_o"]))
