"""Time-varying plants: N₀ = C, N_{k+1} = N_k A + N_k', the transition matrix, the Gramian, the initial state.

Differentiated k times, y = C Φ(t, t₀) x₀ becomes y⁽ᵏ⁾ = N_k(t) Φ(t, t₀) x₀.  Over the rational functions of t the rows of
N₀, …, N_{n−1} span all further ones, so their rank r there decides: on every interval of time without a pole of A and C
exactly n − r independent initial states give the output 0.  The test at a frozen instant leaves out the derivatives.
"""

from __future__ import annotations

from dataclasses import replace
from functools import cached_property
from itertools import combinations
from typing import TYPE_CHECKING, Any, ClassVar, Self, TypedDict

from symobs.exact import Matrix, Scalar, derivative, echelon, independent_rows, modulo
from symobs.exact.core.generators import substitute
from symobs.exact.time_functions.antiderivative import collected
from symobs.exact.time_functions.quasipolynomial import to_quasipolynomial
from symobs.formula.tree import Environment, Integral, Literal
from symobs.formula.tree.term import Term, block
from symobs.ground.dataclass import dataclass
from symobs.ground.errors import BudgetExceeded
from symobs.proof.certificate.claims import Claim
from symobs.proof.derivation.builder import relation
from symobs.system.conditions import Condition, never_zero, sign_of
from symobs.system.specification import read_interval, read_signal
from symobs.tasks.analysis.rank.rank_test import determinant_term
from symobs.tasks.analysis.strata.loci import distance_from
from symobs.tasks.analysis.strata.strata import common_zeros, losses, strata
from symobs.tasks.analysis.time_response.damping_cases import reject, vanishing_denominators
from symobs.tasks.analysis.time_varying.time_varying_solution import (
    ClosedForms,
    TimeVaryingRequest,
    closed_form,
    dependences,
    has_functions,
    instant_where_not_zero,
    reject_poles,
    reject_sizes_and_names,
)
from symobs.tasks.analysis.time_varying.transition_matrix import START, TERMS_UP_TO, TIME, in_time
from symobs.tasks.result import Case, Result, choose, equality, holds, method, task_in_time
from symobs.tasks.result.answers import named_found, those_found

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from symobs.exact import Ideal
    from symobs.system import StateSpace
    from symobs.system.specification import IntervalText, Name, SignalText


#: A determinant of a Gramian with functions whose products have more terms than this would be read by nobody.
_DETERMINANT_UP_TO = 3_000


def stack_of(A: Matrix, C: Matrix, ideal: Ideal | None = None) -> tuple[Matrix, ...]:
    """Return N₀ = C, N₁ = N₀ A + N₀', …, N_{n−1}; raises `BudgetExceeded` where they grow too long.

    They are simplified where the ideal vanishes, by c² + s² = 1 for example.
    """
    rows = [C]
    for _ in range(A.shape[0] - 1):
        rows.append(modulo((rows[-1] @ A + derivative(rows[-1], TIME)).normal(), ideal))
        if rows[-1].size > TERMS_UP_TO:
            message = f"N_{len(rows) - 1} has {rows[-1].size} terms, more than {TERMS_UP_TO}"
            raise BudgetExceeded(message, where="plant", repair="give some of the parameters values")
    return tuple(rows)


class StackTest(TypedDict):
    """The stack O, its rank r, V with C V = 0 and A V − V' = V X, an r×r minor, and an instant at which it is not 0."""

    matrix: Matrix
    stack: tuple[Matrix, ...]
    rank: int
    hidden: Matrix
    restricted: Matrix
    rows: tuple[int, ...]
    columns: tuple[int, ...]
    free: tuple[int, ...]
    point: Scalar | None


class TimeVaryingAnswer(StackTest, ClosedForms):
    """The rank test, and what has a closed form."""


@dataclass
class TimeVaryingObservability(Result):
    """The stack N₀, …, N_{n−1} with its rank over the functions of t, and with a closed form Φ, Gramian and x₀.

    Claims: N₀ = C, N_{k+1} = N_k A + N_k'; a minor of the order of the rank is not identically 0; C V = 0 and
    A V − V' = V X for V of full rank (whatever starts in V(t₀) stays in V(t), unseen); Φ' = A Φ, Φ(t₀, t₀) = I;
    C Φ v = 0; G' = Φᵀ Cᵀ C Φ, G(start) = 0 for the Gramian G(end); C (Φ x₀ + f) + D u = y with f' = A f + B u, f(start) = 0.
    """

    answer: TimeVaryingAnswer
    asked_for: TimeVaryingRequest

    task: ClassVar[str] = "time_varying_observability"
    letters = {
        "matrix": "O",
        "rank": "rank O",
        "transition_matrix": "Phi_",
        "gramian": "W",
    }

    # -- construction ------------------------------------------------------------------------------------------------

    @classmethod
    def of(cls, plant: StateSpace, asked_for: TimeVaryingRequest, method_name: str) -> Self:
        """Return the result for a plant."""
        A, C = plant.matrices.A, plant.matrices.C
        ideal = plant.ideal
        stack = stack_of(A, C, ideal)
        O = Matrix.block([[row] for row in stack]).normal()
        columns, vectors = echelon(O, ideal)
        V = _beside(vectors, plant.order)
        free, count = independent_rows(V, ideal), range(len(vectors))
        if has_functions(V):
            V = _without_common_factors(V, free, ideal)
        moved = A @ V - derivative(V, TIME)
        X = V.select(free, count).solve(moved.select(free, count)) if vectors else Matrix.zeros(0, 0)
        rows = independent_rows(O.select(range(O.shape[0]), columns), ideal)
        test: StackTest = {
            "matrix": O,
            "stack": stack,
            "rank": len(columns),
            "hidden": V,
            "restricted": modulo(X.normal(), ideal),
            "rows": rows,
            "columns": columns,
            "free": free,
            "point": instant_where_not_zero(plant, asked_for.interval, O.select(rows, columns)),
        }
        return cls(plant, method_name, {**test, **closed_form(plant, asked_for, O, V)}, asked_for)

    # -- claims ------------------------------------------------------------------------------------------------------

    def claims(self) -> Iterator[Claim]:
        """Yield the stack, the rank from below and above, and the closed forms where there are any."""
        m, answer, order = self.plant.matrices, self.answer, self.plant.order
        values: dict[str, Matrix | None] = {
            "A": m.A,
            "B": m.B,
            "C": m.C,
            "D": m.D,
            "O": answer["matrix"],
            "V": answer["hidden"],
            "X": answer["restricted"],
        }
        values |= {f"N_{k}": row for k, row in enumerate(answer["stack"])}
        values |= {"Phi": answer["transition_matrix"], "G": answer["gramian_in_time"], "v": answer["kernel"]}
        values |= {"f": answer["forced"], "x_0": answer["x0"], "y": self.asked_for.output, "u": self.asked_for.input}
        signs = self.plant.symbols.signs
        meant = named_found(values)
        named, zero = dependences([*meant.values(), *self.closed_forms], self.asked_for)
        e = Environment(TIME, meant, signs=signs, coefficients=named, relations=zero)
        yield equality(len(answer["stack"]), order, e, "the stack has n blocks")
        yield holds(e, "N_0 = C")
        for k in range(order - 1):
            row = e[f"N_{k}"]
            yield equality(e[f"N_{k + 1}"], row @ e["A"] + row.derivative, e)
        stacked = block([[e[f"N_{k}"]] for k in range(order)])
        yield holds(e, "O = {stacked}", stacked=stacked)
        yield from self._rank_claims(e)
        if answer["gramian"] is not None and None in (answer["transition_matrix"], answer["gramian_in_time"]):
            reject("the Gramian stands without what it is the integral of")
        if answer["transition_matrix"] is not None:
            yield from self._transition_claims(e)
        if answer["forced"] is not None:
            yield from self._state_claims(e)

    def _rank_claims(self, e: Environment) -> Iterator[Claim]:
        answer, order = self.answer, self.plant.order
        found, hidden, V = answer["rank"], order - answer["rank"], answer["hidden"]
        yield Claim(
            relation(found, len(answer["rows"]), len(answer["columns"])), e, "the minor has the order of the rank"
        )
        sizes = V.shape[1], len(answer["free"]), *answer["restricted"].shape
        yield Claim(relation(hidden, *sizes), e, "the hidden states have the dimension n - rank")
        if found:
            minor = determinant_term(self.answer["matrix"].select(answer["rows"], answer["columns"]), e)
            yield Claim(relation(minor, "!==", 0), e, f"a minor of order {found} of the stack is not identically 0")
            if answer["point"] is not None:
                yield from self._inside_claims(e, answer["point"])
                instant = minor.at(TIME, answer["point"])
                yield Claim(relation(instant, "!=", 0), e, f"it is not 0 at t = {answer['point']}")
        if hidden:
            yield holds(e, "C V = 0")
            yield holds(e, "A V - V' = V X")
            yield Claim(relation(determinant_term(V.select(answer["free"], range(hidden)), e), "!==", 0), e)

    def _inside_claims(self, e: Environment, instant: Scalar) -> Iterator[Claim]:
        """Yield that the instant which shows the rank is one of the interval."""
        asked, point = self.asked_for, Term(Literal(instant), e)
        yield equality(point.derivative, 0, e, "the instant is one")
        if asked.interval is not None:
            e = replace(e, positive=(asked.end - asked.start,))
            yield Claim(relation(point, ">=", asked.start), e, "the instant is not before the interval")
            yield Claim(relation(point, "<=", asked.end), e, "the instant is not after the interval")

    def _transition_claims(self, e: Environment) -> Iterator[Claim]:
        answer, order, asked = self.answer, self.plant.order, self.asked_for
        Phi = e["Phi"]
        yield holds(e, "Phi' = A Phi")
        yield holds(e, "{value} = I", value=Phi.at(TIME, Scalar.symbol(START)))
        seen = e["C"] @ Phi.at(START, asked.start)
        hidden = order - answer["rank"]
        if answer["kernel"] is None and _has_value(Phi.value, asked.start):
            reject("the states that are never seen are missing")
        if answer["kernel"] is not None:
            yield equality(answer["kernel"].shape[1], hidden, e, "there are n - rank vectors v")
        if answer["kernel"] is not None and hidden:
            yield holds(e, "v' = 0")
            yield holds(e, "{seen} v = 0", seen=seen)
            yield holds(e, "det(v.T v) !== 0", "the vectors v are independent")
        if answer["gramian"] is not None:
            G = e["G"]
            yield equality(G.derivative, seen.T @ seen, e)
            yield equality(G.at(TIME, asked.start), Matrix.zeros(order, order), e)
            yield equality(answer["gramian"], G.at(TIME, asked.end), e, "the Gramian is G(end)")

    def _state_claims(self, e: Environment) -> Iterator[Claim]:
        m, start = self.plant.matrices, self.asked_for.start
        f, rate = e["f"], e["A"] @ e["f"]
        if "u" in e.values:
            rate = rate + e["B"] @ e["u"]
        yield equality(f.derivative, rate, e)
        yield equality(f.at(TIME, start), Matrix.zeros(self.plant.order, 1), e)
        if self.answer["x0"] is None:
            yield from self._refusal_claims(e)
        else:
            state = e["Phi"].at(START, start) @ e["x_0"] + f
            seen = e["C"] @ state
            seen = seen + e["D"] @ e["u"] if "u" in e.values and m.has_feedthrough else seen
            yield holds(e, "x_0' = 0")
            yield holds(e, "{seen} = y", seen=seen)

    def _refusal_claims(self, e: Environment) -> Iterator[Claim]:
        """Yield W x = ∫ Φᵀ Cᵀ ξ, which has one solution, for a state x whose output is another one."""
        asked, W, moment = self.asked_for, self.answer["gramian"], self.answer["moment"]
        if self.answer["candidate"] is None:
            return
        if W is None or moment is None:
            reject("the integrals that lead to the only state are missing")
        seen = e["C"] @ e["Phi"].at(START, asked.start)
        xi = e["y"] - e["C"] @ e["f"]
        xi = xi - e["D"] @ e["u"] if "u" in e.values else xi
        state = Term(Literal(self.answer["candidate"]), e)
        limits = (TIME, asked.start, asked.end)
        whole = Term(Integral((seen.T @ xi).formula, Literal(moment), *limits), e)
        yield Claim(relation(Term(Literal(W), e).apply("det"), "!==", 0), e)
        yield equality(Term(Literal(W), e) @ state, whole, e)
        yield equality(state.derivative, Matrix.zeros(self.plant.order, 1), e)
        yield Claim(relation(xi, "!==", seen @ state), e, "the output of x is not the one measured")

    # -- what follows ------------------------------------------------------------------------------------------------

    @cached_property
    def minor(self) -> Scalar:
        """The minor of the order of the rank that shows it; 1 where the rank is 0."""
        chosen = self.answer["matrix"].select(self.answer["rows"], self.answer["columns"])
        return self.plant.simplified(chosen.determinant()) if chosen.shape[0] else Scalar.of(1)

    @property
    def verdict(self) -> str:
        """`no` where the rank is below n, else whether it can drop."""
        if self.answer["rank"] < self.plant.order:
            return "no"
        certain = all(case.result is not None and case.result.verdict == "yes" for case in self.case_tree)
        drops = any(condition.kind == "existence" for condition in self.holds_where)
        return "conditional" if drops or not certain else "yes"

    @property
    def existence(self) -> tuple[Scalar, ...]:
        """What vanishes wherever the minor vanishes identically in t: the divisor of its coefficients, or one of them."""
        coefficients = [*in_time(self.minor.numerator).values()]
        signs = self.plant.symbols.signs
        if any(never_zero(c, signs) for c in coefficients):
            return ()
        return (min(coefficients, key=lambda c: (c.size, str(c))),)

    @cached_property
    def meetings(self) -> tuple[tuple[Scalar, ...], ...]:
        """Where exponents of the minor that differ in general are equal: there its terms are not independent.

        Each is a system of equations, of a difference of rates and a difference or sum of frequencies.
        """
        waves = to_quasipolynomial(self.minor.numerator, TIME)
        if waves is None or not has_functions(self.minor.numerator):
            return ()
        exponents = {(key.rate, key.frequency * turn) for key in waves.terms for turn in (1, -1)}
        found: dict[tuple[Scalar, ...], None] = {}
        for one, other in combinations(sorted(exponents, key=str), 2):
            gaps = (derivative(a - b, TIME).numerator for a, b in zip(one, other, strict=True))
            system = tuple(gap for gap in gaps if not gap.is_zero)
            if system and not any(never_zero(gap, self.plant.symbols.signs) for gap in system):
                found[system] = None
        return tuple(found)

    @cached_property
    def denominators(self) -> tuple[Scalar, ...]:
        """The polynomials in the parameters that Φ, the Gramian and x₀ divide by and the plant does not."""
        m, domain = self.plant.matrices, {condition.expression for condition in self.domain}
        names = (m.A.names | m.B.names | m.C.names) - {TIME}
        found = vanishing_denominators(self.closed_forms, self.plant)
        return tuple(f for f in found if f.names <= names and f not in domain)

    @cached_property
    def holds_where(self) -> tuple[Condition, ...]:
        """The domain, an uncertain length of the interval, what closed forms divide by, the factors at which the rank falls."""
        asked, signs = self.asked_for, self.plant.symbols.signs
        length = () if asked.interval is None else (asked.end - asked.start,)
        known = tuple(Condition("domain", d, ">") for d in length if sign_of(d, signs) != "positive")
        known = (*known, *(Condition("claim", f) for f in self.denominators))
        if self.answer["rank"] < self.plant.order:
            return (*self.domain, *known)
        lost = dict.fromkeys(distance_from(equations) for equations in losses(self.case_tree) if equations)
        return (*self.domain, *known, *(Condition("existence", distance) for distance in lost))

    @cached_property
    def case_tree(self) -> tuple[Case, ...]:
        """The strata where the minor vanishes identically and the rank is another, and those of other closed forms."""

        def solve(plant: StateSpace, values: dict[str, Scalar]) -> Result:
            return type(self).of(plant.in_time(), self.asked_for.substitute(values), self.method)

        single = [system[0] for system in self.meetings if len(system) == 1]
        cases = [*strata(self.plant, (*self.existence, *self.denominators, *single), solve)]
        for system in self.meetings:
            cases += common_zeros(self.plant, system, solve) if len(system) > 1 else ()
        found = {frozenset(case.when): case for case in cases}.values()
        rank, others = self.answer["rank"], set(self.denominators)
        return tuple(
            case
            for case in found
            if not isinstance(case.result, TimeVaryingObservability)
            or case.result.answer["rank"] != rank
            or case.result.case_tree
            or any(condition.expression in others for condition in case.when)
        )

    @property
    def closed_forms(self) -> tuple[Matrix | Scalar, ...]:
        """The matrices that may be functions of time, with the given signals."""
        answer, asked = self.answer, self.asked_for
        found = answer["transition_matrix"], answer["gramian"], answer["gramian_in_time"], answer["forced"]
        of_output = answer["x0"], answer["candidate"], answer["moment"], asked.output, asked.input
        return those_found(*found, *of_output, self.gramian_determinant)

    @property
    def never_seen(self) -> Matrix:
        """The states that are never seen: at the start where Φ is known, else moving with t."""
        found = self.answer["kernel"]
        return self.answer["hidden"] if found is None else found

    @cached_property
    def gramian_determinant(self) -> Scalar | None:
        """The determinant of the Gramian, None where that has no closed form or so many functions that nobody reads it."""
        W = self.answer["gramian"]
        if W is None or (
            has_functions(W) and max(entry.size for entry in W.entries) ** W.shape[0] > _DETERMINANT_UP_TO
        ):
            return None
        return collected(W.determinant())

    @cached_property
    def fields(self) -> Mapping[str, Any]:
        """Stack, rank and kernel; transition matrix, Gramian and its determinant where they have a closed form; x0."""
        answer, basis = self.answer, self.never_seen
        columns = [[basis[i, j] for i in range(basis.shape[0])] for j in range(basis.shape[1])]
        found: dict[str, Any] = {"stack": list(answer["stack"]), "matrix": answer["matrix"]}
        found |= {"rank": answer["rank"], "kernel": columns}
        found |= named_found({"transition_matrix": answer["transition_matrix"], "gramian": answer["gramian"]})
        if self.gramian_determinant is not None:
            found["determinant"] = self.gramian_determinant
        if self.asked_for.output is not None:
            found["x0"] = None if answer["x0"] is None else [*answer["x0"].entries]
        return found

    @property
    def data(self) -> Mapping[str, Scalar | Matrix]:
        """Also the ends of the interval."""
        ends = self.asked_for.interval
        return {**super().data, **({"t_start": ends[0], "t_end": ends[1]} if ends else {})}


def _beside(vectors: tuple[Matrix, ...], order: int) -> Matrix:
    return Matrix.of([[v[i, 0] for v in vectors] for i in range(order)], len(vectors))


def _without_common_factors(V: Matrix, free: tuple[int, ...], ideal: Ideal | None) -> Matrix:
    """Return V with units in some rows where that leaves no function in a denominator, else as it is."""
    units = V.select(free, range(V.shape[1])).inverse()
    plain = modulo((V @ units).normal(), ideal)
    return V if has_functions(plain.common_denominator()) else plain


def _has_value(Phi: Matrix | Scalar, start: Scalar) -> bool:
    """Return whether Φ has a value at the start: it has none where A has a pole there."""
    try:
        substitute(Phi, {START: start})
    except ZeroDivisionError:
        return False
    return True


@method("time_varying_observability/stack", source="silverman1967")
def stack(plant: StateSpace, asked_for: TimeVaryingRequest) -> TimeVaryingObservability:
    """Form N₀ = C, N_{k+1} = N_k A + N_k' and their rank over the rational functions of t."""
    return TimeVaryingObservability.of(plant, asked_for, "stack")


@task_in_time
def time_varying_observability(
    plant: StateSpace,
    *,
    interval: IntervalText = None,
    output: SignalText = None,
    input: SignalText = None,  # noqa: A002 - the contract's word
    method: Name = "auto",
) -> Result:
    """Decide whether ẋ = A(t) x, y = C(t) x is observable, by N₀ = C, N_{k+1} = N_k A + N_k'.

    plant      n states, p ≥ 1 outputs; t in A, B, C is the time: rational in t, cos ωt, sin ωt, e^{at}
    interval   "0, T": the interval of time; without it any interval without a pole of A and C
    output     y(t), in t, exp, cos, sin, from which the initial state is to be found; with
    input      u(t), 0 if left out
    Returns stack (N₀ … N_{n−1}), rank over the functions of t, kernel (initial states never seen); where they have a
    closed form transition_matrix Φ(t, t0), gramian ∫ΦᵀCᵀCΦ dt over the interval and its determinant; x0.
    Raises `InputError` where C is missing, in discrete time, or where a pole of A or C lies in the interval.
    Source: L. M. Silverman and H. E. Meadows (1967).
    """
    plant = plant.knowing(interval, output, input).in_time()
    plant.require("C", task="time_varying_observability")
    reject_sizes_and_names(plant)
    ends = None if interval is None else read_interval(interval, plant)
    if ends is not None:
        reject_poles(plant, ends)
    if input is not None:
        plant.require("B", task="time_varying_observability with an input")
    given = None if output is None else read_signal(output, plant, "output", plant.outputs, functions=True)
    driving = None if input is None else read_signal(input, plant, "input", plant.inputs, functions=True)
    asked_for = TimeVaryingRequest(ends, given, driving)
    return choose("time_varying_observability", method, "stack").solve(plant, asked_for)
