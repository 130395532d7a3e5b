"""Lyapunov's equation  AᵀP + PA = −Q,  in discrete time  AᵀPA − P = −Q,  for a symmetric P.

It has one solution for every Q if and only if no λᵢ + λⱼ (no λᵢ λⱼ − 1) vanishes, that is det χ(−A) ≠ 0 (det χ*(A) ≠ 0 with
χ*(z) = zⁿ χ(1/z)).  Where it has none there is a symmetric X with A X + X Aᵀ = 0 (A X Aᵀ = X) and tr Q X ≠ 0.
"""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING, Any, ClassVar, Self

from symobs.exact import (
    Matrix,
    Scalar,
    TooLarge,
    from_coefficients,
    modulo,
    primitive,
    primitive_kernel,
    solve_or_refute,
)
from symobs.formula.tree import HoldsExactlyWhere
from symobs.ground.dataclass import dataclass
from symobs.ground.errors import CertificateRejected, InputError, Undecided
from symobs.proof.certificate.claims import Claim
from symobs.proof.derivation.builder import Builder, predicate, relation
from symobs.proof.derivation.facts import leading_minors
from symobs.stability.criteria.stability import StabilityVerdict, stability
from symobs.stability.inequalities.simplify import as_inequality, cleared, simplify
from symobs.system.conditions import sign_of, vanishing_factors
from symobs.system.specification import in_common_field, read_symmetric
from symobs.tasks.analysis.page_parts import case_steps, determinant_form, given
from symobs.tasks.analysis.strata.strata import PutAgain
from symobs.tasks.analysis.time_response.horizons import (
    MOST_STATES,
    MOST_WITH_PARAMETERS,
    lyapunov_operator,
    symmetric,
    upper_entries,
)
from symobs.tasks.result import Result, choose, holds, method, page_of, task

if TYPE_CHECKING:
    from collections.abc import Collection, Iterator, Mapping, Sequence

    from symobs.formula.tree import Environment
    from symobs.system import StateSpace
    from symobs.system.specification import Intensity, Name


@dataclass
class LyapunovSolution(PutAgain):
    """P with AᵀP + PA = −Q, the only one where det χ(−A) ≠ 0.

    Where that vanishes, N ≠ 0 with AᵀN + NA = 0 may be added to P, or an X with AX + XAᵀ = 0 and tr QX ≠ 0 excludes a P.
    """

    weight: Matrix

    inputs = ("weight",)
    task: ClassVar[str] = "lyapunov"
    answered_by = ("P", "positive_definite")
    only_value = ("P", "positive_definite")
    claimed: ClassVar[tuple[str, ...]] = ("P",)
    leads = ("P",)
    letters = {"P": "P_l", "Q": "Q_l", "minors": "Delta"}
    cards = ("P",)

    @classmethod
    def fields_asked(cls, given: Collection[str]) -> tuple[str, ...]:
        """Return what is asked for: P, where that is given Q, and whether it is positive definite."""
        return ("Q", "positive_definite") if "P" in given else super().fields_asked(given)

    @classmethod
    def of(cls, plant: StateSpace, Q: Matrix, method_name: str) -> Self:
        """Return the solution, or why there is none or more than one."""
        A, ideal = plant.matrices.A, plant.ideal
        answer: dict[str, Any] = dict.fromkeys(("P", "N", "X"))
        answer["determinant"] = plant.simplified(_image(plant).determinant())
        operator = lyapunov_operator(A, discrete=plant.is_discrete)
        found, row = solve_or_refute(operator, -upper_entries(Q), ideal)
        if found is None:
            answer["X"] = _as_matrix(row)
        else:
            answer["P"] = modulo(symmetric(found).normal(), ideal)
            if answer["determinant"].is_zero:
                null = primitive_kernel(operator, ideal)
                if not null.shape[
                    1
                ]:  # the relations have several parts, and 0 is a power of what vanishes on one of them
                    message = "where the relations hold the equations have different ranks"
                    raise TooLarge(message)
                answer["N"] = symmetric(null.select(range(null.shape[0]), [0]))
        return cls(plant, method_name, answer, Q)

    def claims(self) -> Iterator[Claim]:
        """Yield the equation of P and its symmetry; that it is the only one, or not; or that there is none."""
        P, N, X, determinant = (self.answer[name] for name in ("P", "N", "X", "determinant"))
        if (P is None) != (X is not None) or (N is None) != (not determinant.is_zero or P is None):
            message = (
                "there is no P exactly where an X shows that there is none, and one P where the determinant is not 0"
            )
            raise CertificateRejected(message)
        e = self.meanings(Q=self.weight, image=_image(self.plant))
        yield holds(e, "Q = Q.T")
        yield holds(e, "det(image) = determinant", "determinant of the image of A")
        if not determinant.is_zero:
            yield holds(e, "determinant !== 0")
        if X is not None:
            yield holds(e, f"{self.transposed} = 0")
            yield holds(e, "X = X.T")
            yield holds(e, "{trace} !== 0", trace=self.obstacle)
            return
        yield holds(e, f"{self.left} = -Q")
        yield holds(e, "P = P.T")
        if N is not None:
            yield holds(e, f"{self.left.replace('P', 'N')} = 0")
            yield holds(e, "N = N.T")
            yield holds(e, "N !== 0")
        yield from self._about_minors(e)

    @property
    def named_data(self) -> Mapping[str, Any]:
        """Q and P."""
        return {"Q": self.weight, "P": self.answer["P"]}

    def consequences(self, given: Mapping[str, Any]) -> Mapping[str, Any]:
        """Return the minors of another symmetric P, and whether it is positive definite."""
        P = given["P"]
        if P.shape != self.weight.shape or P != P.T:
            return {}
        minors, signs = leading_minors(P), self.plant.symbols.signs
        found = _all_positive(minors, signs)
        return {"minors": [*minors], "positive_definite": found.verdict, "positive_if": found.inequalities(signs)}

    @property
    def left(self) -> str:
        """The left side of the equation."""
        return "A.T*P*A - P" if self.plant.is_discrete else "A.T*P + P*A"

    @property
    def transposed(self) -> str:
        """The left side of the equation of X."""
        return "A*X*A.T - X" if self.plant.is_discrete else "A*X + X*A.T"

    def _about_minors(self, e: Environment) -> Iterator[Claim]:
        """Yield the signs from which it follows whether P is positive definite."""
        of_Q, found = self.has_definite_weight, self.definite
        if of_Q or found.verdict == "yes":
            minors = leading_minors(self.weight) if of_Q else self.leading
            yield from (Claim(relation(m, ">", 0), e, "a leading principal minor is positive") for m in minors)
        elif self.lowest_minor is not None:
            yield Claim(
                relation(self.leading[self.lowest_minor], "<=", 0), e, "a leading principal minor is not positive"
            )

    @property
    def verdict(self) -> str:
        """`no` where there is no solution or more than one."""
        return "no" if self.is_singular else super().verdict

    @property
    def is_singular(self) -> bool:
        """Whether there is no P or more than one."""
        return bool(self.answer["determinant"].is_zero)

    @cached_property
    def leading(self) -> tuple[Scalar, ...]:
        """The leading principal minors of P, none where there is no P or more than one."""
        P = self.answer["P"]
        return () if P is None or self.answer["N"] is not None else leading_minors(P)

    @property
    def has_definite_weight(self) -> bool:
        """Whether Q is certainly positive definite: P is then, exactly where A is stable."""
        signs = self.plant.symbols.signs
        return all(sign_of(minor, signs) == "positive" for minor in leading_minors(self.weight))

    @cached_property
    def stability(self) -> StabilityVerdict:
        """Whether A is asymptotically stable."""
        plant = self.plant
        chi = plant.matrices.A.characteristic_polynomial(plant.variable)
        return stability(chi, plant.variable, plant.symbols.signs, discrete=plant.is_discrete)

    @property
    def lowest_minor(self) -> int | None:
        """The place of a minor that is never positive, where there is one."""
        return next((k for k, m in enumerate(self.leading) if sign_of(m, self.plant.symbols.signs) in _NEVER), None)

    @cached_property
    def definite(self) -> StabilityVerdict:
        """Whether P is positive definite: yes, no, or what must be positive for it to be."""
        signs = self.plant.symbols.signs
        if self.leading and self.has_definite_weight:
            return self.stability
        return _all_positive(self.leading, signs) if self.leading else StabilityVerdict("no")

    @property
    def existence(self) -> tuple[Scalar, ...]:
        """The determinant that vanishes where the solution is not unique."""
        return () if self.is_singular else (self.answer["determinant"],)

    @property
    def obstacle(self) -> Scalar | None:
        """Tr QX, which would be 0 if there were a P."""
        return None if self.answer["X"] is None else trace(self.weight, self.answer["X"])

    @cached_property
    def fields(self) -> Mapping[str, Any]:
        """P, whether it is the only solution, and whether it is positive definite, or exactly where."""
        P, definite, signs = self.answer["P"], self.definite, self.plant.symbols.signs
        found = {"P": P, "solvable": self.verdict, "positive_definite": definite.verdict if self.leading else None}
        found |= {"positive_if": definite.inequalities(signs) if self.leading else None, "minors": list(self.leading)}
        return found | {"determinant": self.answer["determinant"], "homogeneous": self.answer["N"]}


@dataclass
class LyapunovWeight(LyapunovSolution):
    """Q = −(AᵀP + PA) of a given symmetric P, and whether it is positive definite."""

    given: Matrix

    inputs = ("given",)
    answered_by = ("Q", "positive_definite")
    only_value = ("Q", "positive_definite")
    claimed = ()
    leads = ("Q",)
    cards = ("Q",)

    @classmethod
    def of(cls, plant: StateSpace, P: Matrix, method_name: str) -> Self:
        """Return the Q of a P."""
        A = plant.matrices.A
        left = A.T @ P @ A - P if plant.is_discrete else A.T @ P + P @ A
        Q = modulo((-left).normal(), plant.ideal)
        return cls(plant, method_name, {"Q": Q, "P": P}, Q, P)

    def claims(self) -> Iterator[Claim]:
        """Yield the equation, the symmetry of P, and the signs of the minors of Q."""
        e = self.meanings()
        yield holds(e, f"{self.left} = -Q")
        yield holds(e, "P = P.T")
        yield from self._about_minors(e)

    @property
    def named_data(self) -> Mapping[str, Any]:
        """P."""
        return {"P": self.given}

    def consequences(self, given: Mapping[str, Any]) -> Mapping[str, Any]:
        """Return the minors of another symmetric Q, and whether it is positive definite."""
        found = super().consequences({"P": given["Q"]})
        return {name: found[name] for name in ("minors", "positive_definite") if name in found}

    @property
    def is_singular(self) -> bool:
        """Never: there is one Q for every P."""
        return False

    @cached_property
    def leading(self) -> tuple[Scalar, ...]:
        """The leading principal minors of Q."""
        return leading_minors(self.weight)

    @cached_property
    def definite(self) -> StabilityVerdict:
        """Whether Q is positive definite: yes, no, or what must be positive for it to be."""
        return _all_positive(self.leading, self.plant.symbols.signs)

    @property
    def existence(self) -> tuple[Scalar, ...]:
        """Nothing: there is one Q for every P."""
        return ()

    @property
    def obstacle(self) -> Scalar | None:
        """Nothing: there is one Q for every P."""
        return None

    @cached_property
    def fields(self) -> Mapping[str, Any]:
        """Q, P, and whether Q is positive definite, or exactly where."""
        definite, signs = self.definite, self.plant.symbols.signs
        found = {"Q": self.weight, "P": self.given, "positive_definite": definite.verdict}
        return found | {"positive_if": definite.inequalities(signs), "minors": list(self.leading)}


#: Signs of what is positive nowhere.
_NEVER = {"negative", "nonpositive", "zero"}


def _all_positive(minors: Sequence[Scalar], signs: Mapping[str, str]) -> StabilityVerdict:
    """Return whether all minors are positive: yes, no, or what must be positive for them to be."""
    if any(sign_of(minor, signs) in _NEVER for minor in minors):
        return StabilityVerdict("no")
    needed = tuple(minor for minor in minors if sign_of(minor, signs) != "positive")
    found = simplify(needed, signs, ask=False)
    if found.verdict == "no":  # several minors contradict each other, and none does alone
        return StabilityVerdict("conditional", tuple(map(cleared, needed)))
    return StabilityVerdict(found.verdict, found.positive)


def _as_matrix(row: Matrix | None) -> Matrix:
    """Return the symmetric X for which tr X S is a row times the entries of S on and above the diagonal, up to a factor."""
    assert row is not None  # noqa: S101 - where there is no solution there is a row
    whole = symmetric(row.T * 2, Scalar.of(1) / 2)
    return symmetric(Matrix.column(primitive(upper_entries(whole).entries)))


def _image(plant: StateSpace) -> Matrix:
    """Return χ(−A), in discrete time χ*(A): its determinant is the product of all −λᵢ − λⱼ, of all 1 − λᵢ λⱼ."""
    A, variable = plant.matrices.A, plant.variable
    coefficients = A.characteristic_polynomial(variable).coefficients(variable)
    moved, total = (A, coefficients[::-1]) if plant.is_discrete else (-A, coefficients)
    found = Matrix.zeros(*A.shape)
    for coefficient in total:
        found = found @ moved + Matrix.identity(A.shape[0]) * coefficient
    return modulo(found.normal(), plant.ideal)


def trace(Q: Matrix, X: Matrix) -> Scalar:
    """Return tr Q X of symmetric matrices: the sum of the products of their entries."""
    return (Matrix.row(Q.entries) @ Matrix.column(X.entries))[0, 0]


@method("lyapunov/entries", source="kalman1960a")
def by_entries(plant: StateSpace, Q: Matrix) -> LyapunovSolution:
    """Solve the linear equations of the entries of P on and above the diagonal."""
    return LyapunovSolution.of(plant, Q, "entries")


@task
def lyapunov(plant: StateSpace, *, Q: Intensity = None, P: Intensity = None, method: Name = "auto") -> Result:
    """Solve Lyapunov's equation AᵀP + PA = −Q, in discrete time AᵀPA − P = −Q, for a symmetric P.

    plant    A with n states
    Q        n×n, symmetric; q stands for q I, and I where it is left out
    P        n×n, symmetric, in the place of Q: the Q that belongs to it is found, and whether that is positive definite
    Returns P, solvable (yes, no, conditional: whether there is one and only one P; where there are several P is one of them),
    positive_definite (yes, no, conditional), positive_if (conditions for it), minors (the leading principal ones), determinant
    (0 where some λᵢ + λⱼ, λᵢ λⱼ − 1, is 0) and homogeneous (where P is not unique, what may be added to it).
    Of a given P these are Q, positive_definite, positive_if and minors of Q.
    Raises `InputError` where Q or P is not symmetric, or both are given, `ShapeMismatch`; `Undecided` for too many states.
    Source: R. E. Kalman and J. E. Bertram (1960); P. Lancaster and M. Tismenetsky, The Theory of Matrices, ch. 12, 13.
    """
    if Q is not None and P is not None:
        message = "both Q and P are given, and each follows from the other"
        raise InputError(message, where="specification.P", repair="keep one of them")
    plant = plant.knowing(Q, P)
    order = plant.order
    if P is not None:
        plant, (tried,) = in_common_field(plant, read_symmetric(P, plant, "P", order))
        return LyapunovWeight.of(plant, tried, choose("lyapunov", method, "entries").name).asked(method)
    weight = Matrix.identity(order) if Q is None else read_symmetric(Q, plant, "Q", order)
    if order > (MOST_WITH_PARAMETERS if plant.matrices.A.names else MOST_STATES):
        raise Undecided(f"lyapunov is undecided: {order} states are too many")
    plant, (weight,) = in_common_field(plant, weight)
    return choose("lyapunov", method, "entries").solve(plant, weight).asked(method)


# The page: the equation, when its solution is unique, P and its check, the leading principal minors.


#: The left side is written out in the entries of P for plants of up to this order.
_WRITTEN_OUT_UP_TO = 3


@page_of(LyapunovWeight)
def write_weight(page: Builder, result: LyapunovWeight) -> None:
    """Write the page of the Q that belongs to a P."""
    given(page)
    with page.section("lyapunov_equation"):
        time = "discrete" if page.plant.is_discrete else "continuous"
        page.define("P_l", page.value(result.given), say=f"lyapunov_tried_{time}", closing=False)
        _weigh(page, result)
        page.steps += case_steps(page, result, _weigh_again)


def _weigh_again(page: Builder, result: LyapunovWeight) -> None:
    page.set("P_l", result.given)
    _weigh(page, result)


def _weigh(page: Builder, result: LyapunovWeight) -> None:
    """Write Q, its minors, and what follows for it and for the stability of A."""
    left = result.left.replace("P", "P_l")
    page.define("Q_l", page(f"-({left})"), page.value(result.weight), say="lyapunov_weight", answer=True, closing=False)
    _tell_definiteness(page, result, "Q_l")
    if result.has_definite_weight:
        page.set("chi", page.plant.matrices.A.characteristic_polynomial(page.plant.variable))
        _tell_stability(page, result)


@page_of(LyapunovSolution)
def write_lyapunov(page: Builder, result: LyapunovSolution) -> None:
    """Write the whole page."""
    given(page)
    with page.section("lyapunov_equation"):
        time = "discrete" if page.plant.is_discrete else "continuous"
        page.define("Q_l", page.value(result.weight), say=f"lyapunov_sought_{time}", closing=False)
        _solve(page, result)
        page.steps += case_steps(page, result, _case)


def _case(page: Builder, result: LyapunovSolution) -> None:
    page.set("Q_l", result.weight)
    _solve(page, result)


def _solve(page: Builder, result: LyapunovSolution) -> None:
    _tell_uniqueness(page, result)
    if result.answer["X"] is not None:
        _tell_refusal(page, result)
        return
    _tell_entries(page, result)
    if result.answer["N"] is not None:
        page.set("N_l", result.answer["N"])
    say = "lyapunov_solution" if result.answer["N"] is None else "lyapunov_one_of_many"
    page.define("P_l", page.value(result.answer["P"]), say=say, answer=True, closing=False)
    page.verified("lyapunov_checked", equation=page.line(f"{result.left} = -Q_l", P="P_l"))
    if result.answer["N"] is not None:
        page.equal("N_l = #", page.line(f"{result.left} = 0", P="N_l"), say="lyapunov_added")
        return
    _tell_definiteness(page, result)
    if result.has_definite_weight:
        _tell_stability(page, result)


def _tell_uniqueness(page: Builder, result: LyapunovSolution) -> None:
    """Write χ, and the determinant that says whether the solution is unique."""
    plant = page.plant
    polynomial = plant.matrices.A.characteristic_polynomial(plant.variable)
    page.define("chi", "det(s I - A)", page.value(polynomial), say="lyapunov_polynomial", closing=False)
    found = result.answer["determinant"]
    if plant.is_discrete:
        reversed_polynomial = from_coefficients(polynomial.coefficients(plant.variable)[::-1], plant.variable)
        page.define("chi_r", page.value(reversed_polynomial), say="lyapunov_reversed", closing=False)
    image = "det(chi_r_at(A))" if plant.is_discrete else "det(chi_at(-A))"
    form = determinant_form(page, found)
    time = "discrete" if plant.is_discrete else "continuous"
    if found.is_zero:
        page.conclude(f"lyapunov_singular_{time}", determinant=page.line(f"{image} = 0"))
        return
    factors = vanishing_factors([found], plant.symbols.signs)
    if factors:
        page.conclude(f"lyapunov_regular_if_{time}", determinant=page.line(f"{image} = {{form}}", form=form))
        page.assume("lyapunov_provided", *factors)
    else:
        page.conclude(f"lyapunov_regular_{time}", determinant=page.line(f"{image} = {{form}} != 0", form=form))


def _tell_entries(page: Builder, result: LyapunovSolution) -> None:
    """Write the left side in the entries of P, for plants of few states."""
    order = page.plant.order
    unknown = [f"p{i + 1}{j + 1}" for i in range(order) for j in range(i, order)]
    if order > _WRITTEN_OUT_UP_TO or {*unknown} & {
        *page.plant.symbols.signs,
        *page.environment.coefficients,
        *page.plant.field.names,
    }:
        return
    P = symmetric(Matrix.column([Scalar.symbol(name) for name in unknown]))
    page.equal(page.line(f"{result.left.replace('P', '{P}')} = #", P=P), say="lyapunov_written_out")


def _tell_refusal(page: Builder, result: LyapunovSolution) -> None:
    """Write the X with tr QX ≠ 0 that shows that there is no solution."""
    page.set("X_l", result.answer["X"])
    page.equal("X_l = #", page.line(f"{result.transposed} = 0", X="X_l"), say="lyapunov_obstacle")
    time = "discrete" if page.plant.is_discrete else "continuous"
    page.conclude(f"lyapunov_impossible_{time}", trace=page.value(trace(result.weight, result.answer["X"])))


def _tell_definiteness(page: Builder, result: LyapunovSolution, letter: str = "P_l") -> None:
    """Write the leading principal minors of P, or of Q, and what follows for it."""
    signs, P, lowest = page.plant.symbols.signs, page[letter], result.lowest_minor
    of = "" if letter == "P_l" else "_weight"
    for k, minor in enumerate(result.leading, 1):
        page.set(f"Delta_{k}", minor)
    page.equal(
        *(relation(page[f"Delta_{k}"], determinant_form(page, m)) for k, m in enumerate(result.leading, 1)),
        say=f"lyapunov{of}_minors",
    )
    of_Q = result.has_definite_weight and not of
    if lowest is not None:
        page.conclude(f"lyapunov{of}_not_definite", minor=relation(page[f"Delta_{lowest + 1}"], "<=", 0))
    elif all(sign_of(minor, signs) == "positive" for minor in result.leading):
        page.conclude(f"lyapunov{of}_definite", predicate("positive_definite", P))
    elif not of_Q:
        where = tuple(relation(*as_inequality(value, signs)) for value in result.definite.positive)
        page.conclude(f"lyapunov{of}_definite_if", where=HoldsExactlyWhere(predicate("positive_definite", P), where))


def _tell_stability(page: Builder, result: LyapunovSolution) -> None:
    """Write what a positive definite Q says of the stability of A."""
    signs, stable = page.plant.symbols.signs, result.stability
    positive, chi = predicate("positive_definite", page["Q_l"]), page["chi"]
    if stable.verdict == "conditional":
        where = tuple(relation(*as_inequality(value, signs)) for value in stable.positive)
        page.conclude("lyapunov_stable_if", positive, where=HoldsExactlyWhere(predicate("stable", chi), where))
        return
    is_stable = stable.verdict == "yes"
    page.conclude(
        "lyapunov_stable" if is_stable else "lyapunov_unstable",
        positive,
        predicate("stable" if is_stable else "unstable", chi),
    )
