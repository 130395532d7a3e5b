"""Horizons: reading them, and the Gramians over all time and over a number of steps."""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING, NotRequired, TypedDict

from symobs.exact import Matrix, Scalar, modulo, remainder
from symobs.exact.core.generators import NotWritten, all_roots, derivative, function, function_named, functions_in
from symobs.exact.time_functions.quasipolynomial import Table, table_of
from symobs.formula.expression import parse_scalar
from symobs.ground.errors import InputError
from symobs.stability.criteria.stability import stability
from symobs.system import read_scalar
from symobs.system.conditions import Condition, joined, never_zero, nonzero, sign_of
from symobs.system.specification import read_signal
from symobs.tasks.analysis.rank.rank_test import minor_claim, rank_claims, rank_environment, rank_losses
from symobs.tasks.analysis.time_response.damping_cases import DampingAnswer, DampingCases

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Mapping

    from symobs.proof.certificate.claims import Claim
    from symobs.system import StateSpace
    from symobs.tasks.analysis.strata.strata import RankAnswer
    from symobs.tasks.result import Result


INFINITE = "inf"
_MOST_STEPS = 60
#: Lyapunov's equation is solved for up to this many states, without and with parameters.
MOST_STATES, MOST_WITH_PARAMETERS = 12, 4


def read_horizon(plant: StateSpace, value: object, name: str = "horizon") -> Scalar | str:
    """Return `inf`, or the horizon as a scalar: T where none is given.  Raises `InputError`."""
    where, called = f"specification.{name}", "instant" if name == "at_time" else name.replace("_", " ")
    if str(value).strip() in {"inf", "oo", "infinity", "∞"}:  # SymPy's oo too
        return INFINITE
    if value is None:
        return Scalar.of(plant.order) if plant.is_discrete else Scalar.symbol("T")
    if isinstance(value, str):
        found = parse_scalar(value, plant.symbols.names, where=where, functions=True)
    else:
        found = read_scalar(value, plant.symbols.seen(value), where)
    if any(function_named(name) for name in found.names):
        raise InputError(
            f"the {called} {found} is no rational expression", where=where, repair='write "T", 5 or "2*pi"'
        )
    if sign_of(found, plant.symbols.signs) in {"negative", "nonpositive", "zero"}:
        raise InputError(f"the {called} {found} is not positive", where=where, repair='write "T", or a number above 0')
    if "t" in found.names and found != Scalar.symbol("t"):  # the end of the horizon may be called t, as in W(t)
        raise InputError(f"the {called} depends on t", where=where, repair='t is the time; write "t" itself, or "T"')
    if plant.is_discrete and not (found.is_constant and found.fraction().denominator == 1):
        raise InputError(f"{found} is not a number of steps", where=where, repair="write a whole number, or inf")
    if plant.is_discrete and found.fraction() > _MOST_STEPS:
        raise InputError(f"{found} steps are too many", where=where, repair=f"write at most {_MOST_STEPS}, or inf")
    return found


def over_horizon(solve: Callable[[], Result], name: str = "horizon") -> Result:
    """Return a result over a horizon; raises `InputError` where cosines there are not written with square roots."""
    try:
        return solve()
    except NotWritten as error:
        message = f"with this {name} the answer contains a value that has no form here: {error}"
        raise InputError(message, where=f"specification.{name}", repair='write "T" and put the number in') from error


def steps_gramian(A: Matrix, C: Matrix, steps: Scalar) -> Matrix:
    """Return Σ (Aᵀ)ᵏ Cᵀ C Aᵏ over the steps."""
    row, total = C, C.T @ C
    for _ in range(int(steps.fraction()) - 1):
        row = (row @ A).normal()
        total = total + row.T @ row
    return total.normal()


class GramianOfAllTime(TypedDict):
    """The polynomial of what is seen; the integral over all time and its determinant where it exists and is found."""

    seen: Scalar
    matrix: Matrix | None
    determinant: Scalar | None
    question: NotRequired[str]


def infinite_gramian(plant: StateSpace, A: Matrix, C: Matrix, test: RankAnswer) -> GramianOfAllTime:
    """Return the polynomial of the observable part, and the infinite-horizon Gramian if that decays."""
    variable, hidden = plant.variable, test["restricted"]
    seen = A.characteristic_polynomial(variable)
    if hidden.shape[0]:  # on a stratum the factor divides modulo its equations only
        seen = remainder(seen, hidden.characteristic_polynomial(variable), variable)[0]
    seen = plant.simplified(seen)
    found = stability(seen, variable, plant.symbols.signs, discrete=plant.is_discrete)
    nothing: GramianOfAllTime = {"matrix": None, "determinant": None, "seen": seen}
    if found.verdict == "no":
        return nothing
    order = A.shape[0]
    if order > (MOST_WITH_PARAMETERS if (A.names | C.names) else MOST_STATES):
        return {**nothing, "question": f"Lyapunov's equation for {order} states"}
    W = _of_what_is_seen(A, C, test, plant)
    if W is None:
        return {**nothing, "question": "Lyapunov's equation has no unique solution"}
    W = modulo(W, plant.ideal)
    return {"matrix": W, "determinant": W.determinant(), "seen": seen}


def _of_what_is_seen(A: Matrix, C: Matrix, test: RankAnswer, plant: StateSpace) -> Matrix | None:
    """Solve Lyapunov's equation for the part that is seen: with x₁ = Q x, Q rows of 𝒪, A₁ Q = Q A and W = QᵀW₁Q."""
    order = range(A.shape[0])
    if not test["rank"]:
        return Matrix.zeros(*A.shape)
    if test["rank"] == A.shape[0]:
        return lyapunov(A, C.T @ C, plant)
    Q = test["matrix"].select(test["rows"], order)
    square = Q.select(range(Q.shape[0]), test["columns"]).T

    def through(rows: Matrix) -> Matrix:  # Y with Y Q = rows
        return square.solve(rows.select(range(rows.shape[0]), test["columns"]).T).T.normal()

    seen = through(C)
    W = lyapunov(through(Q @ A), seen.T @ seen, plant)
    return None if W is None else (Q.T @ W @ Q).normal()


def lyapunov(A: Matrix, Q: Matrix, plant: StateSpace) -> Matrix | None:
    """Return the symmetric P with AᵀP + PA = −Q (AᵀPA − P = −Q in discrete time), None where it is not unique."""
    operator = lyapunov_operator(A, discrete=plant.is_discrete)
    if plant.ideal is not None and operator.determinant().numerator in plant.ideal:
        return None
    try:
        found = operator.solve(-upper_entries(Q)).normal()
    except ZeroDivisionError:
        return None
    return symmetric(found)


def lyapunov_operator(A: Matrix, *, discrete: bool) -> Matrix:
    """Return the matrix of P ↦ AᵀP + PA (P ↦ AᵀPA − P) on the entries of a symmetric P on and above the diagonal."""
    order = A.shape[0]
    columns = []
    for i, j in _upper(order):
        unit = Matrix.of([[int((r, c) in {(i, j), (j, i)}) for c in range(order)] for r in range(order)])
        columns.append(upper_entries(A.T @ unit @ A - unit if discrete else A.T @ unit + unit @ A))
    return Matrix.block([columns])


def _upper(order: int) -> list[tuple[int, int]]:
    return [(i, j) for i in range(order) for j in range(i, order)]


def upper_entries(P: Matrix) -> Matrix:
    """Return the entries on and above the diagonal, as a column."""
    return Matrix.column([P[place] for place in _upper(P.shape[0])])


def symmetric(entries: Matrix, off_diagonal: Scalar | int = 1) -> Matrix:
    """Return the symmetric matrix with these entries on and above the diagonal, those above it times a factor."""
    order = int((8 * entries.shape[0] + 1) ** 0.5 - 1) // 2
    values = {place: entries[k, 0] for k, place in enumerate(_upper(order))}
    return Matrix.of(
        [[values[min(i, j), max(i, j)] * (1 if i == j else off_diagonal) for j in range(order)] for i in range(order)]
    )


# Stationary points of a variance as a function of the horizon.


def stationary(variance: Scalar, end: str, signs: Mapping[str, str]) -> str | None:
    """Return `T**4 == 140*r/q` where the derivative vanishes at one power of the horizon, else None."""
    if any(function_named(name) for name in variance.names):
        return None
    factors = [f for f, _ in derivative(variance, end).numerator.factors()[1] if not never_zero(f, signs)]
    if len(factors) != 1:
        return None
    lead, *rest = factors[0].coefficients(end)
    if any(not c.is_zero for c in rest[:-1]) or not rest:
        return None
    return f"{end}**{len(rest)} == {-rest[-1] / lead}"


# Results about the initial state, and the reading of measured outputs and known inputs.


_MOST_TERMS = 60


class OfTheInitialStateAnswer(DampingAnswer):
    """The test of observability beside the signs."""

    rank: RankAnswer


class OfTheInitialState(DampingCases):
    """A result about x(0), which the output determines where the pair (C, A) is observable."""

    answer: OfTheInitialStateAnswer

    @property
    def is_unique(self) -> bool:
        """Whether the pair is observable in general."""
        return self.answer["rank"]["rank"] == self.plant.order

    @property
    def further_zeros(self) -> tuple[Scalar, ...]:
        """Where the pair may lose rank."""
        return rank_losses(self.answer["rank"], self.plant.symbols.signs)

    @cached_property
    def holds_where(self) -> tuple[Condition, ...]:
        """That no rank is lost is a condition."""
        return joined(super().holds_where, nonzero("existence", self.further_zeros))

    def observability_claims(self) -> Iterator[Claim]:
        """Yield the rank of the observability matrix and its kernel."""
        test = self.answer["rank"]
        e = rank_environment(self.plant, (self.plant.matrices.A, self.plant.matrices.C), test)
        yield from rank_claims(test, e)
        yield from minor_claim(test, e)


def read_functions(value: object, plant: StateSpace, name: str, count: int) -> tuple[Matrix, Table]:
    """Return a column of `count` functions of t, as a matrix and as sums; raises `InputError`, `ShapeMismatch`."""
    where = f"specification.{name}"
    if value is None:
        message = f"the {name} is missing"
        raise InputError(message, where=where, repair=f'give it as a function of t, {name} = "1 - exp(-t)"')
    found = read_signal(value, plant, name, count, functions=True)
    repair = "write sums of exponentials, sines and cosines times powers of t, such as 2 t exp(-t) sin(3 t)"
    if any("t" in root.argument.names for root in all_roots(found)):
        raise InputError(f"the {name} contains a root of t", where=where, repair=repair)
    try:
        found = _without_phases(found)
        sums = table_of(found)
    except (ValueError, NotWritten) as error:
        raise InputError(str(error), where=where, repair=repair) from None
    if sum(len(entry.terms) for row in sums for entry in row) > _MOST_TERMS:
        raise InputError("the functions have too many terms", where=where, repair=f"keep to {_MOST_TERMS} terms")
    return found, sums


def _without_phases(value: Matrix) -> Matrix:
    """Return sin(ωt + φ) as sin ωt cos φ + cos ωt sin φ, and the cosine likewise; raises `NotWritten`."""
    found: dict[str, Scalar] = {}
    for f in functions_in([value]):
        phase = f.argument.substitute({"t": Scalar.of(0)}) if f.kind in {"sin", "cos"} else Scalar.of(0)
        if phase.is_zero or phase == f.argument:
            continue
        (s, c), (p, q) = ([function(kind, part) for kind in ("sin", "cos")] for part in (f.argument - phase, phase))
        found[f.name] = s * q + c * p if f.kind == "sin" else c * q - s * p
    return value.substitute(found) if found else value
