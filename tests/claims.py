"""What the result of each task claims, checked in plain fractions at a point, from plant and specification there."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from typing import TYPE_CHECKING, Any

from symobs.exact import Factored, Scalar
from symobs.expression import parse_polynomial
from symobs.specification import read_poles
from tests.claims_in_time import FUNCTIONS_OF_TIME
from tests.claims_of_advice import advice_holds
from tests.claims_of_modes import MODES
from tests.plain import (
    Point,
    Polynomial,
    Rows,
    assignable,
    at_number,
    characteristic,
    coefficients_at,
    faddeev_leverrier,
    is_hurwitz,
    is_schur,
    matrix_at,
    multiply,
    observability_rows,
    product,
    rank_of,
    seeded,
    subtract,
    transposed,
    value_at,
)

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator, Mapping

    from symobs.conditions import Condition
    from symobs.exact import Complex
    from symobs.method import Result
    from symobs.system import StateSpace

#: Values of s at which rational functions are compared; where there are parameters, one of them at each point.
PROBES = (Fraction(7, 3), Fraction(-11, 5), Fraction(23), Fraction(-1, 7), Fraction(5, 2))


@dataclass(frozen=True)
class Setting:
    """A plant and desired polynomials in plain fractions, and the point they belong to."""

    A: Rows
    B: Rows
    C: Rows
    D: Rows
    wanted: Mapping[str, Polynomial]
    point: Point
    discrete: bool

    @staticmethod
    def of(plant: StateSpace, specification: Mapping[str, Any], point: Point) -> Setting:
        """Evaluate plant and specification; raises ZeroDivisionError where one of them does not exist."""
        m = plant.matrices
        A, B, C, D = (matrix_at(part, point) for part in (m.A, m.B, m.C, m.D))
        return Setting(A, B, C, D, dict(wanted(plant, specification, point)), point, plant.is_discrete)

    def is_stable(self, polynomial: Polynomial) -> bool:
        return is_schur(polynomial) if self.discrete else is_hurwitz(polynomial)

    @property
    def probes(self) -> tuple[Fraction, ...]:
        return (seeded(sorted(self.point.items())).choice(PROBES),) if self.point else PROBES

    def pair(self, *, dual: bool) -> tuple[Rows, Rows]:
        """Return (A, C), or (Aᵀ, Bᵀ)."""
        return (transposed(self.A), transposed(self.B)) if dual else (self.A, self.C)


def wanted(plant: StateSpace, specification: Mapping[str, Any], point: Point) -> Iterator[tuple[str, Polynomial]]:
    """Read the desired polynomials off a specification, under their keys' prefix; poles are multiplied out here."""
    for key, value in specification.items():
        prefix = key.removesuffix("poles").removesuffix("polynomial")
        if key.endswith("poles"):
            yield prefix, multiplied_out(read_poles(value, plant.symbols, key), point)
        elif key.endswith("polynomial"):
            yield prefix, coefficients_at(read_polynomial(value, plant, key), plant.variable, point)


def read_polynomial(value: object, plant: StateSpace, where: str) -> Scalar:
    return (
        value
        if isinstance(value, Scalar)
        else parse_polynomial(value, plant.variable, plant.symbols.names, where=where)
    )


def read_once(plant: StateSpace, specification: Mapping[str, Any]) -> dict[str, Any]:
    """Return a specification whose texts are read, for many points."""
    found: dict[str, Any] = {}
    for key, value in specification.items():
        if key.endswith("poles"):
            found[key] = read_poles(value, plant.symbols, key)
        elif key.endswith("polynomial"):
            found[key] = read_polynomial(value, plant, key)
    return found


def multiplied_out(poles: tuple[Complex, ...], point: Point) -> Polynomial:
    zero = (Fraction(0), Fraction(0))
    found = [(Fraction(1), Fraction(0))]
    for pole in poles:
        x, y = value_at(pole.real, point), value_at(pole.imaginary, point)
        times_pole = [zero, *((x * u - y * v, x * v + y * u) for u, v in found)]
        found = [(u - p, v - q) for (u, v), (p, q) in zip([*found, zero], times_pole, strict=True)]
    assert not any(imaginary for _, imaginary in found), "the poles asked for are closed under conjugation"
    return [real for real, _ in found]


def response(A: Rows, B: Rows, C: Rows, s: Fraction) -> Fraction:
    """Return C (sI − A)⁻¹ B at a number s."""
    chi, adjugates = faddeev_leverrier(A)
    return at_number([multiply(multiply(C, part), B)[0][0] for part in adjugates], s) / at_number(chi, s)


def beside(*lines: list[Rows]) -> Rows:
    """Put blocks together."""
    return [[entry for block in line for entry in block[i]] for line in lines for i in range(len(line[0]))]


def rational_at(value: Scalar | Factored, variable: str, s: Fraction, point: Point) -> Fraction:
    """Return the value of a rational function of s; a factored form is evaluated factor by factor."""
    here = {**point, variable: s}
    if isinstance(value, Scalar):
        return value_at(value, here)
    total = value_at(value.unit, here)
    for factor, power in value.factors:
        total *= value_at(factor, here) ** power
    return total


def gain_holds(result: Result, at: Setting, prefix: str, gain: Rows) -> None:
    """Hold a gain against φ: that of the specification, or the polynomial reported for a given gain."""
    moved = multiply(at.B, gain) if result.task == "state_feedback" else multiply(gain, at.C)
    reported = coefficients_at(result.fields["polynomial"], result.plant.variable, at.point)
    assert characteristic(subtract(at.A, moved)) == reported == at.wanted.get(prefix, reported)


def design_holds(result: Result, at: Setting, prefix: str = "") -> None:
    feedback = result.task == "state_feedback"
    found = result.answer["K" if feedback else "L"]
    if found is None:
        assert not assignable(*at.pair(dual=feedback), at.wanted[prefix])
        return
    gain = matrix_at(found, at.point)
    gain_holds(result, at, prefix, gain)
    if feedback:
        assert matrix_at(result.fields["closed_loop_matrix"], at.point) == subtract(at.A, multiply(at.B, gain))
    else:
        assert matrix_at(result.fields["A"], at.point) == subtract(at.A, multiply(gain, at.C))
        assert matrix_at(result.fields["B_y"], at.point) == gain
        if result.plant.matrices.has_input:
            assert matrix_at(result.fields["B_u"], at.point) == subtract(at.B, multiply(gain, at.D))
    family = result.fields["family"]
    for shift in (Fraction(0), Fraction(5, 7)) if family else ():
        free = {name: shift * (k + 1) for k, name in enumerate(family["parameters"])}
        try:
            member = matrix_at(family["K" if feedback else "L"], {**at.point, **free})
        except ZeroDivisionError:  # X is singular there; a family without X has no such places
            assert "X" in family
            continue
        gain_holds(result, at, prefix, member)
    stability_holds(result, at)


def stability_holds(result: Any, at: Setting) -> None:
    """Hold `stable` and the polynomials that must be positive against Routh's scheme at the point."""
    stable = at.is_stable(coefficients_at(result.fields["polynomial"], result.plant.variable, at.point))
    if result.fields["stable"] == "conditional":
        assert stable == all(value_at(value, at.point) > 0 for value in result.stability.positive)
    else:
        assert stable == (result.fields["stable"] == "yes")


def minimal_order_holds(result: Any, at: Setting) -> None:
    """Hold F(s) to the loop: with x̂ = T⁻¹ [x₁; z + L x₁] the state x, z obeys one matrix, and P/(1 + PF) has its poles."""
    design_holds(result.feedback, at, "control_")
    reduced_order_holds(result.estimator, at, "observer_")
    if result.answer["K"] is None or result.answer["L"] is None:
        assert result.answer["F"] is None
        return
    K, L = (matrix_at(result.answer[name], at.point) for name in "KL")
    F_z, G, H, M = (matrix_at(result.estimator.fields[name], at.point) for name in "FGHM")
    KM, ((d,),), estimated = multiply(K, M), at.D, len(F_z)
    direct, through = [row[:1] for row in KM], [row[1:] for row in KM]
    solvable = 1 - direct[0][0] * d
    if result.answer["F"] is None:
        assert not solvable
        return
    zero = [[Fraction(0)] * len(at.A) for _ in range(estimated)]
    in_error = beside([subtract(at.A, multiply(at.B, K)), multiply(at.B, through)], [zero, F_z])
    driven = [[g[0] + h[0] * d] for g, h in zip(G, H, strict=True)]
    fed = multiply(subtract(H, multiply(driven, direct)), at.C)
    nothing = [[Fraction(0)] * estimated for _ in at.A]
    in_estimate = beside(
        [subtract(at.A, multiply(at.B, multiply(direct, at.C))), subtract(nothing, multiply(at.B, through))],
        [fed, subtract(F_z, multiply(driven, through))],
    )
    assert matrix_at(result.fields["closed_loop_matrix"], at.point) == in_error
    assert matrix_at(result.fields["closed_loop_matrix_estimate"], at.point) == in_estimate
    whole = product([at.wanted["control_"], at.wanted["observer_"]])
    assert characteristic(in_error) == characteristic(in_estimate) == whole
    own = subtract(F_z, multiply(G, [[entry / solvable for entry in row] for row in through]))
    assert matrix_at(result.fields["compensator_matrix"], at.point) == own
    assert matrix_at(result.fields["direct_term"], at.point) == [[direct[0][0] / solvable]]
    for s in at.probes:
        assert rational_at(result.fields["closed_loop_polynomial"], result.plant.variable, s, at.point) == at_number(
            whole, s
        )
        try:
            above = response(F_z, H, through, s) + direct[0][0]
            F = above / (solvable + response(F_z, G, through, s))
            P = response(at.A, at.B, at.C, s) + d
        except ZeroDivisionError:  # a pole
            continue
        assert rational_at(result.fields["F"], result.plant.variable, s, at.point) == F
        if at_number(whole, s):
            assert rational_at(result.fields["closed_loop"], result.plant.variable, s, at.point) == P / (1 + P * F)
    assert len(L) == estimated
    F_stable_holds(result, at)


def compensator_holds(result: Any, at: Setting) -> None:
    if result.method == "minimal_order":
        minimal_order_holds(result, at)
        return
    design_holds(result.feedback, at, "control_")
    design_holds(result.estimator, at, "observer_")
    if result.answer["F"] is None:
        assert None in (result.answer["K"], result.answer["L"])
        return
    K, L = (matrix_at(result.answer[name], at.point) for name in "KL")
    variable, F_s = result.plant.variable, result.fields["F"]
    BK, LC, minus_LDK = (
        multiply(at.B, K),
        multiply(L, at.C),
        multiply([[-x for x in row] for row in L], multiply(at.D, K)),
    )
    own = subtract(subtract(subtract(at.A, BK), LC), minus_LDK)
    assert matrix_at(result.fields["compensator_matrix"], at.point) == own
    whole = product([at.wanted["control_"], at.wanted["observer_"]])
    zero = [[Fraction(0)] * len(at.A) for _ in at.A]
    in_error = beside([subtract(at.A, BK), BK], [zero, subtract(at.A, LC)])
    in_estimate = beside([at.A, subtract(zero, BK)], [LC, subtract(subtract(at.A, BK), LC)])
    assert matrix_at(result.fields["closed_loop_matrix"], at.point) == in_error
    assert matrix_at(result.fields["closed_loop_matrix_estimate"], at.point) == in_estimate
    if not at.point:
        assert characteristic(in_error) == characteristic(in_estimate) == whole
    for s in at.probes:
        assert rational_at(result.fields["closed_loop_polynomial"], variable, s, at.point) == at_number(whole, s)
        try:
            F, P = response(own, L, K, s), response(at.A, at.B, at.C, s) + at.D[0][0]
        except ZeroDivisionError:  # a pole
            continue
        assert rational_at(F_s, variable, s, at.point) == F
        if at_number(whole, s):
            assert rational_at(result.fields["closed_loop"], variable, s, at.point) == P / (1 + P * F)
    F_stable_holds(result, at)


def F_stable_holds(result: Any, at: Setting) -> None:
    """Hold the verdict on the compensator itself against Routh's scheme at the point."""
    denominator = coefficients_at(result.fields["F"].denominator, result.plant.variable, at.point)
    if result.fields["F_stable"] in {"yes", "no"} and denominator[0]:
        assert at.is_stable(denominator) == (result.fields["F_stable"] == "yes")


def rank_holds(result: Result, at: Setting) -> None:
    dual = result.task == "controllability"
    A, C = at.pair(dual=dual)
    rows = observability_rows(A, C)
    found = matrix_at(result.fields["matrix"], at.point)
    assert (transposed(found) if dual else found) == rows
    assert rank_of(rows) == result.fields["rank"]
    kernel = [[value_at(entry, at.point) for entry in vector] for vector in result.fields["kernel"]]
    assert rank_of(kernel) == len(kernel) == len(A) - result.fields["rank"]
    assert not kernel or not any(any(row) for row in multiply(rows, transposed(kernel)))


def polynomial_holds(result: Any, at: Setting) -> None:
    chi, variable = characteristic(at.A), result.plant.variable
    assert coefficients_at(result.fields["polynomial"], variable, at.point) == chi
    factors = [coefficients_at(f, variable, at.point) for f, power in result.fields["factors"] for _ in range(power)]
    assert product(factors) == chi
    if result.fields["stable"] != "conditional":
        assert at.is_stable(chi) == (result.fields["stable"] == "yes")


def transfer_holds(result: Result, at: Setting) -> None:
    for s in at.probes:
        if at_number(characteristic(at.A), s):
            expected = response(at.A, at.B, at.C, s) + at.D[0][0]
            assert rational_at(result.fields["transfer_function"], result.plant.variable, s, at.point) == expected


def reduced_order_holds(result: Any, at: Setting, prefix: str = "") -> None:
    """P A − F P = H C, G = P B − H D, M [C; P] = I, det(sI − F) = φ(s), or fixed modes that are not wanted."""
    if result.answer["L"] is None:
        assert result.fields["fixed_modes"]
        assert rank_of(observability_rows(at.A, at.C)) < len(at.A)
        return
    T, L, F, H, M = (matrix_at(result.fields[name], at.point) for name in "TLFHM")
    assert T[:1] == at.C
    P = subtract(T[1:], multiply(L, at.C))
    assert subtract(multiply(P, at.A), multiply(F, P)) == multiply(H, at.C)
    if result.plant.matrices.has_input:
        assert matrix_at(result.fields["G"], at.point) == subtract(multiply(P, at.B), multiply(H, at.D))
    assert multiply(M, [*at.C, *P]) == [[Fraction(int(i == j)) for j in range(len(P) + 1)] for i in range(len(P) + 1)]
    assert characteristic(F) == at.wanted[prefix]


def conditions_hold(conditions: Iterable[Condition], point: Point) -> bool:
    return all(_IS[c.operator](value_at(c.expression, point)) for c in conditions)


_IS: dict[str, Callable[[Fraction], bool]] = {
    "==": lambda value: value == 0,
    "!=": lambda value: value != 0,
    ">": lambda value: value > 0,
    "<": lambda value: value < 0,
    ">=": lambda value: value >= 0,
    "<=": lambda value: value <= 0,
}


def applicable(result: Result, point: Point) -> Iterator[Result]:
    """Yield what a result says of a point: its cases there, their cases in turn; itself where the point is in none.

    A case without a result is undecided and says nothing.
    """
    found = [case.result for case in result.case_tree if conditions_hold(case.when, point)]
    for inner in found:
        if inner is not None:
            yield from applicable(inner, point)
    if not found and conditions_hold(result.holds_where, point):
        yield result


HOLDS: dict[str, Callable[[Any, Setting], None]] = {
    "observer": design_holds,
    "state_feedback": design_holds,
    "compensator": compensator_holds,
    "observability": rank_holds,
    "controllability": rank_holds,
    "characteristic_polynomial": polynomial_holds,
    "transfer_function": transfer_holds,
    "reduced_order_observer": reduced_order_holds,
    "pole_advice": advice_holds,
    **FUNCTIONS_OF_TIME,
    **MODES,
}
