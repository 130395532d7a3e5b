"""What the result of each task claims, checked in plain fractions at a point, from plant and specification there."""

from __future__ import annotations

import importlib
from dataclasses import dataclass
from fractions import Fraction
from pathlib import Path
from typing import TYPE_CHECKING, Any

from symobs.exact import Factored, Matrix, Scalar
from symobs.formula.expression import parse_polynomial
from symobs.system.specification import read_poles
from tests.support.algebra import (
    Point,
    Polynomial,
    Rows,
    assignable,
    at_number,
    characteristic,
    coefficients_at,
    determinant,
    identity,
    inverse,
    is_hurwitz,
    is_schur,
    matrix_at,
    multiply,
    observability_rows,
    plus,
    product,
    random_fraction,
    rank_of,
    response,
    seeded,
    subtract,
    transposed,
    value_at,
)
from tests.support.claims import claims_with_dead_time
from tests.support.claims.claims_in_time import FUNCTIONS_OF_TIME
from tests.support.claims.claims_of_advice import advice_holds
from tests.support.claims.claims_of_modes import MODES
from tests.support.derivations import times
from tests.support.paths import ROOT
from tests.support.regions.region_answers import holds as relations_hold

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator, Mapping

    from symobs.exact import Complex
    from symobs.system import StateSpace
    from symobs.system.conditions import Condition
    from symobs.tasks.result import Result

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


def beside(*lines: list[Rows]) -> Rows:
    """Put blocks together."""
    return [[entry for block in line for entry in block[i]] for line in lines for i in range(len(line[0]))]


def table_at(value: Any, variable: str, s: Fraction, point: Point) -> Rows:
    """Return the value of a transfer function, or of a matrix of them, as a table."""
    if isinstance(value, Matrix):
        return matrix_at(value, {**point, variable: s})
    rows = value if isinstance(value, tuple) else ((value,),)
    return [[rational_at(entry, variable, s, point) for entry in row] for row in rows]


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
    general = family["K" if feedback else "L"] if family else None
    for draw in range(2):
        if general is None:  # the gain is unique, or its family too large to be written down
            break
        free = {name: random_fraction(seeded((draw, name))) for name in family["parameters"]}
        try:
            member = matrix_at(general, {**at.point, **free})
        except ZeroDivisionError:  # X is singular there; a family without X has no such places
            assert "X" in family
            continue
        gain_holds(result, at, prefix, member)
    stability_holds(result, at, coefficients_at(result.fields["polynomial"], result.plant.variable, at.point))


def stability_holds(result: Any, at: Setting, polynomial: Polynomial) -> None:
    """Hold `stable`, and where it is said to be, against Routh's scheme at the point."""
    stable = at.is_stable(polynomial)
    if result.fields["stable"] == "conditional":
        names = sorted(at.point)
        assert stable == relations_hold(result.fields["stable_if"], names)([at.point[name] for name in names])
    else:
        assert stable == (result.fields["stable"] == "yes")


def minimal_order_holds(result: Any, at: Setting) -> None:
    """Hold F(s) to the loop: with x̂ = T⁻¹ [x₁; z + L x₁] the state x, z obeys one matrix, and P/(1 + PF) has its poles."""
    design_holds(result.feedback, at, "control_")
    reduced_order_holds(result.estimator, at, "observer_")
    if result.answer["K"] is None or result.answer["L"] is None:
        assert result.answer["F"] is None
        return
    K = matrix_at(result.answer["K"], at.point)
    F_z, G, H, M = (matrix_at(result.estimator.fields[name], at.point) for name in "FGHM")
    KM, outputs = multiply(K, M), len(at.C)
    N, through = [row[:outputs] for row in KM], [row[outputs:] for row in KM]
    solving = subtract(identity(len(K)), multiply(N, at.D))
    if result.answer["F"] is None:
        assert not determinant(solving)
        return
    W = inverse(solving)
    zero = [[Fraction(0)] * len(at.A) for _ in F_z]
    in_error = beside([subtract(at.A, multiply(at.B, K)), multiply(at.B, through)], [zero, F_z])
    u_x, u_z, driven = times(Fraction(-1), multiply(N, at.C)), times(Fraction(-1), through), plus(G, multiply(H, at.D))
    in_estimate = beside(
        [plus(at.A, multiply(at.B, u_x)), multiply(at.B, u_z)],
        [plus(multiply(H, at.C), multiply(driven, u_x)), plus(F_z, multiply(driven, u_z))],
    )
    own = subtract(F_z, multiply(G, multiply(W, through)))
    assert matrix_at(result.fields["direct_term"], at.point) == multiply(W, N)

    def F(s: Fraction) -> Rows:
        above = plus(response(F_z, H, through, s), N)
        return multiply(inverse(plus(solving, response(F_z, G, through, s))), above)

    loop_holds(result, at, (own, in_error, in_estimate), F)


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
    BK, LC, LDK = multiply(at.B, K), multiply(L, at.C), multiply(L, multiply(at.D, K))
    own = plus(subtract(subtract(at.A, BK), LC), LDK)
    zero = [[Fraction(0)] * len(at.A) for _ in at.A]
    in_error = beside([subtract(at.A, BK), BK], [zero, subtract(at.A, LC)])
    in_estimate = beside([at.A, subtract(zero, BK)], [LC, subtract(subtract(at.A, BK), LC)])
    loop_holds(result, at, (own, in_error, in_estimate), lambda s: response(own, L, K, s))


def loop_holds(result: Any, at: Setting, matrices: tuple[Rows, Rows, Rows], F: Callable[[Fraction], Rows]) -> None:
    """Hold the matrices of compensator and loop, F(s) and the loop (I + PF)⁻¹ P to what they must be."""
    variable = result.plant.variable
    for name, matrix in zip(
        ("compensator_matrix", "closed_loop_matrix", "closed_loop_matrix_estimate"), matrices, strict=True
    ):
        assert matrix_at(result.fields[name], at.point) == matrix
    asked = [at.wanted[part] for part in ("control_", "observer_") if part in at.wanted]
    whole = product(asked) if len(asked) == 2 else characteristic(matrices[1])  # a gain may be given
    if not at.point or len(at.A) < 4:  # large matrices at many points take long
        assert characteristic(matrices[1]) == characteristic(matrices[2]) == whole
    for s in at.probes:
        assert rational_at(result.fields["closed_loop_polynomial"], variable, s, at.point) == at_number(whole, s)
        try:
            F_s, P = F(s), plus(response(at.A, at.B, at.C, s), at.D)
        except ZeroDivisionError:  # a pole
            continue
        assert table_at(result.fields["F"], variable, s, at.point) == F_s
        if at_number(whole, s):
            G = table_at(result.fields["closed_loop"], variable, s, at.point)
            assert multiply(plus(identity(len(P)), multiply(P, F_s)), G) == P
    if "stable" in result.fields:  # of given gains
        stability_holds(result, at, whole)
    F_stable_holds(result, at)


def F_stable_holds(result: Any, at: Setting) -> None:
    """Hold the verdict on the compensator itself against Routh's scheme at the point."""
    F, variable = result.fields["F"], result.plant.variable
    entries = F.entries if isinstance(F, Matrix) else [F]
    denominator = product([coefficients_at(entry.denominator, variable, at.point) for entry in entries])
    if result.fields["F_stable"] in {"yes", "no"} and denominator[0]:
        assert at.is_stable(denominator) == (result.fields["F_stable"] == "yes")


def feedforward_holds(result: Any, at: Setting) -> None:
    """Hold F to G F = I for the gain G at rest, and T to its definition; with both gains and no F, G has dependent rows."""
    loop = result.loop
    if not loop.exists:
        assert result.answer["F"] is None
        return
    K = matrix_at(loop.answer["K"], at.point)
    closed = subtract(at.A, multiply(at.B, K))
    seen = subtract(at.C, multiply(at.D, K))
    rest = Fraction(int(at.discrete))
    if result.answer["stuck"] is not None:
        assert not at_number(characteristic(closed), rest)
        return
    G = response(closed, at.B, seen, rest)[0][0] + at.D[0][0]
    if result.answer["F"] is None:
        assert not G
        return
    F = value_at(result.fields["F"], at.point)
    assert G * F == 1
    for s in at.probes:
        if at_number(characteristic(closed), s):
            expected = (response(closed, at.B, seen, s)[0][0] + at.D[0][0]) * F
            assert rational_at(result.fields["transfer_function"], result.plant.variable, s, at.point) == expected


def tracking_holds(result: Any, at: Setting) -> None:
    """Hold K_d to (A_d − A + BK_d) V = 0, V = I or x_d(0), A_d x_d(0), …; the errors' matrix to control times observer."""
    design_holds(result.loop.feedback, at, "control_")
    reduced_order_holds(result.loop.estimator, at, "observer_")
    A_d = matrix_at(result.reference, at.point)
    passed = [[Fraction(int(i == j)) for j in range(len(A_d))] for i in range(len(A_d))]
    if result.start is not None:
        columns = [matrix_at(result.start, at.point)]
        for _ in A_d:
            columns.append(multiply(A_d, columns[-1]))
        passed = [[column[i][0] for column in columns] for i in range(len(A_d))]
    wanted = multiply(subtract(at.A, A_d), passed)
    if result.fields["K_d"] is None:
        assert not result.fields["solvable"]
        both = [[*b, *w] for b, w in zip(at.B, wanted, strict=True)]
        assert rank_of(both) > rank_of(at.B)
        return
    assert multiply(multiply(at.B, matrix_at(result.fields["K_d"], at.point)), passed) == wanted
    if None not in (result.fields["K"], result.fields["L"]):
        whole = product([at.wanted["control_"], at.wanted["observer_"]])
        assert characteristic(matrix_at(result.fields["error_matrix"], at.point)) == whole


def integral_holds(result: Any, at: Setting) -> None:
    """Hold the closed loop to φ and, at rest, to y = r; and what is solvable to the rank of [A B; C D]."""
    n, p = len(at.A), len(at.C)
    first = subtract(at.A, identity(n)) if at.discrete else at.A
    whole = [[*a, *b] for a, b in zip([*first, *at.C], [*at.B, *at.D], strict=True)]
    assert result.fields["solvable"] == (rank_of(whole) == n + p)
    own = identity(p) if at.discrete else [[Fraction(0)] * p for _ in range(p)]
    below = [[*(-c for c in row), *right] for row, right in zip(at.C, own, strict=True)]
    A = [*([*row, *([Fraction(0)] * p)] for row in at.A), *below]
    B = [*at.B, *([-d for d in row] for row in at.D)]
    if result.fields["K"] is None:
        assert not assignable(transposed(A), transposed(B), at.wanted[""])
        return
    K, k_I = (matrix_at(result.fields[name], at.point) for name in ("K", "k_I"))
    closed = subtract(A, multiply(B, [[*row, *(-g for g in right)] for row, right in zip(K, k_I, strict=True)]))
    assert characteristic(closed) == at.wanted[""]
    assert matrix_at(result.fields["closed_loop_matrix"], at.point) == closed
    moving = subtract(identity(n + p), closed) if at.discrete else [[-entry for entry in row] for row in closed]
    if determinant(moving):
        state = multiply(inverse(moving), [[Fraction(int(i == n + j)) for j in range(p)] for i in range(n + p)])
        u = [
            [b - a for a, b in zip(*rows, strict=True)]
            for rows in zip(multiply(K, state[:n]), multiply(k_I, state[n:]), strict=True)
        ]
        assert plus(multiply(at.C, state[:n]), multiply(at.D, u)) == identity(p)


def rank_holds(result: Result, at: Setting) -> None:
    dual = result.task == "controllability"
    A, C = at.pair(dual=dual)
    rows = observability_rows(A, C)
    found = matrix_at(result.fields["matrix"], at.point)
    assert (transposed(found) if dual else found) == rows
    assert rank_of(rows) == result.fields["rank"]
    assert (result.verdict == "no") == (rank_of(rows) < len(A))
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
            expected = plus(response(at.A, at.B, at.C, s), at.D)
            assert table_at(result.fields["transfer_function"], result.plant.variable, s, at.point) == expected


def reduced_order_holds(result: Any, at: Setting, prefix: str = "") -> None:
    """P A − F P = H C, G = P B − H D, M [C; P] = I, det(sI − F) = φ(s), or fixed modes that are not wanted."""
    if result.answer["L"] is None:
        assert result.fields["fixed_modes"]
        assert rank_of(observability_rows(at.A, at.C)) < len(at.A)
        return
    T, L, F, H, M = (matrix_at(result.fields[name], at.point) for name in "TLFHM")
    assert T[: len(at.C)] == at.C
    P = subtract(T[len(at.C) :], multiply(L, at.C))
    assert subtract(multiply(P, at.A), multiply(F, P)) == multiply(H, at.C)
    if result.plant.matrices.has_input:
        assert matrix_at(result.fields["G"], at.point) == subtract(multiply(P, at.B), multiply(H, at.D))
    assert multiply(M, [*at.C, *P]) == identity(len(at.A))
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


def region_holds(result: Any, at: Setting) -> None:
    """The inequalities hold at the point exactly if all roots are stable there, those of A moved by the margin."""
    if result.plant.delay is not None:
        claims_with_dead_time.region_holds(result, at)
        return
    names, question = sorted(at.point), result.question
    boundary = question.boundary
    gains = [(at.B, question.K), (question.L, at.C)]
    moved = [
        multiply(*(part if isinstance(part, list) else matrix_at(part, at.point) for part in pair))
        for pair, gain in zip(gains, (question.K, question.L), strict=True)
        if gain is not None
    ]
    inside = relations_hold(result.stable_if, names)([at.point[name] for name in names])
    stable = [
        at.is_stable(characteristic(shifted(subtract(at.A, part) if part else at.A, boundary)))
        for part in moved or [[]]
    ]
    assert inside == all(stable)


def shifted(A: Rows, boundary: Any) -> Rows:
    """Return A + αI, or A divided by the radius."""
    margin, radius = boundary.margin.fraction(), boundary.radius.fraction()
    return [[entry / radius + margin * (i == j) for j, entry in enumerate(row)] for i, row in enumerate(A)]


class _Checks(dict[str, "Callable[[Any, Setting], None]"]):
    """The checks by task; that of a further task is `holds` in a file of its own, found by its name."""

    def __missing__(self, task: str) -> Callable[[Any, Setting], None]:
        path = Path(__file__).with_name(f"claims_of_{task}.py")
        to_write = path.relative_to(ROOT)
        assert path.exists(), f"nothing checks the claims of {task}: write {to_write} with `holds(result, at)`"
        self[task] = importlib.import_module(".".join(to_write.with_suffix("").parts)).holds
        return self[task]


HOLDS = _Checks(
    {
        "observer": design_holds,
        "state_feedback": design_holds,
        "compensator": compensator_holds,
        "feedforward": feedforward_holds,
        "tracking": tracking_holds,
        "integral_action": integral_holds,
        "observability": rank_holds,
        "controllability": rank_holds,
        "characteristic_polynomial": polynomial_holds,
        "transfer_function": transfer_holds,
        "reduced_order_observer": reduced_order_holds,
        "pole_advice": advice_holds,
        "stability_region": region_holds,
        **FUNCTIONS_OF_TIME,
        **MODES,
    }
)
