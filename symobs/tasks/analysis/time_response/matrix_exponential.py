"""The matrix exponential e^{At} in closed form: exponentials, cosines, sines, cosh, sinh, powers of t; never complex."""

from __future__ import annotations

from functools import cached_property, reduce
from operator import add
from typing import TYPE_CHECKING, Any, ClassVar, Self

from symobs.exact import Matrix, Scalar, factored
from symobs.exact.algebraic.root_sum import RootSum
from symobs.exact.core.generators import function_named, functions_in
from symobs.exact.time_functions.matrix_exponential import (
    Exponential,
    Mode,
    NoClosedForm,
    exponential,
)
from symobs.exact.time_functions.matrix_power import INSTANT, matrix_power
from symobs.exact.time_functions.quasipolynomial import rate_parts
from symobs.formula.tree import Identity, Letter, Literal, Negative, Power, Product, Sum
from symobs.formula.tree.term import Term, letter
from symobs.ground.dataclass import dataclass
from symobs.ground.errors import InputError
from symobs.proof.derivation.builder import Builder, relation
from symobs.system.conditions import vanishing_factors
from symobs.tasks.analysis.page_parts import formula_of_factored, given, is_narrow
from symobs.tasks.analysis.time_response.damping_cases import (
    DampingAnswer,
    DampingCases,
    Signs,
    exponential_claims,
    rate_of,
    time_environment,
    with_signs,
)
from symobs.tasks.result import Result, choose, holds, method, task

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from symobs.exact import Matrix
    from symobs.formula.tree import Formula
    from symobs.formula.tree.term import Term
    from symobs.proof.certificate.claims import Claim
    from symobs.proof.derivation.builder import Builder
    from symobs.system import StateSpace
    from symobs.system.specification import Name

TIME = Scalar.symbol("t")
#: Sums of up to this many matrices are shown before the entries.
_SHOWN_SUM = 4
#: Behind the sum of more than two states the entries are shown up to this many characters in a row.
_ENTRIES = 130


def closed_form(plant: StateSpace, taken: Signs, *, sums: bool = False) -> tuple[Exponential, Signs]:
    """Return e^{At} and the signs that were chosen, with `sums` over roots if need be.  Raises `NoClosedForm`."""
    return with_signs(
        plant,
        taken,
        lambda sign: exponential(plant.matrices.A, plant.variable, sign, sums=sums, simplified=plant.simplified),
    )


def has_sums(plant: StateSpace) -> bool:
    """Return whether sums over roots may stand in answers beyond e^{At}: where the modes are numbers."""
    return not plant.equations and not plant.matrices.A.names


def motion(plant: StateSpace, whole: Matrix, start: Matrix) -> Exponential:
    """Return e^{Mt} V for the matrix M of a larger system in which that of the plant stands.  Raises `NoClosedForm`."""
    found: Exponential
    found, _ = with_signs(
        plant,
        {},
        lambda sign: exponential(whole, plant.variable, sign, sums=True, start=start, simplified=plant.simplified),
    )
    return found


def question_of(error: NoClosedForm) -> str:
    """Return what would have to be known."""
    if error.factor is None:
        return f"the exponential of a matrix of more than {error.most} states"
    return f"the roots of {error.factor}"


def require_continuous(plant: StateSpace, task_name: str) -> None:
    """Raise `InputError` in discrete time, and where t is a parameter."""
    if plant.is_discrete:
        message = f"{task_name} belongs to continuous time"
        raise InputError(
            message, where="plant.dt", repair="leave dt out; in discrete time the powers of A take its place"
        )
    if "t" in plant.field.names and "t" in plant.matrices.A.names:
        message = "t is the time and cannot be a parameter of the plant"
        raise InputError(message, where="plant.A", repair="give the parameter another name")


class MatrixExponentialAnswer(DampingAnswer):
    """Φ(t), or Aᵏ in discrete time."""

    matrix: Matrix | None


@dataclass
class MatrixExponential(DampingCases):
    """Φ(t) with Φ′ = A Φ and Φ(0) = I, which has one solution."""

    answer: MatrixExponentialAnswer
    task: ClassVar[str] = "matrix_exponential"
    answered_by = ("matrix",)
    only_value = ("matrix",)
    functions_of_time = {"exp(At)": "matrix"}
    letters = {"matrix": "exp_At"}

    @classmethod
    def of(cls, plant: StateSpace, method_name: str, _: Mapping[str, Any], taken: Signs) -> Self:
        """Return the result for a plant."""
        try:
            found, chosen = closed_form(plant, taken, sums=not plant.equations)
        except NoClosedForm as error:
            answer: MatrixExponentialAnswer = {"matrix": None, "taken": taken, "chosen": {}}
            return cls(plant, method_name, {**answer, "question": question_of(error), "factor": error.factor})
        return cls(plant, method_name, {"matrix": found.matrix(TIME), "taken": taken, "chosen": chosen})

    def claims(self) -> Iterator[Claim]:
        """Yield the differential equation and the start."""
        yield from super().claims()
        if self.answer["matrix"] is None:
            return
        e = time_environment(self.plant, {"A": self.plant.matrices.A, "exp_At": self.answer["matrix"]})
        yield from exponential_claims(e)

    @cached_property
    def denominators(self) -> tuple[Scalar, ...]:
        """Beside those of the entries, the discriminants of polynomials over whose roots a sum goes."""
        if self.answer["matrix"] is None:
            return ()
        sums = [f for f in _functions(self.answer["matrix"]) if isinstance(f, RootSum)]
        found = vanishing_factors([f.discriminant for f in sums], self.plant.symbols.signs)
        return tuple(dict.fromkeys((*super().denominators, *found)))

    @cached_property
    def fields(self) -> Mapping[str, Any]:
        """The matrix in t; where there is none, the question that is open."""
        asked = self.answer.get("question")
        return {"matrix": self.answer["matrix"], **({"question": asked} if asked else {})}

    def write(self, page: Builder) -> None:
        """Write the characteristic polynomial, the sum of functions and matrices, the entries, the check."""
        page.in_time(*self.everything())
        given(page)
        with page.section("matrix_exponential"):
            tell_polynomial(page)
            self.write_branches(page, _write_branch)


def _write_branch(page: Builder, result: MatrixExponential) -> None:
    """Write one branch."""
    if result.answer["matrix"] is None:
        tell_question(page, result.answer["factor"])
        return
    signs = {**result.answer["taken"], **result.answer["chosen"]}
    found, _ = closed_form(result.plant, signs, sums=not result.plant.equations)
    tell_exponential(page, found, result.answer["matrix"], answer=True)
    start = page.line("exp_At(t = 0) = I")
    page.verified("exponential_start", rate=page.line("{rate} = A exp_At", rate=rate_of(page["exp_At"])), start=start)


def tell_polynomial(page: Builder) -> None:
    """Write the characteristic polynomial with its factors."""
    polynomial = page.plant.matrices.A.characteristic_polynomial(page.plant.variable)
    form = factored(polynomial, page.plant.variable)
    members = [page["det(s I - A)"], page.value(polynomial)]
    if len(polynomial.terms()) > 1 and (len(form.factors) > 1 or form.factors[0][1] > 1):
        members.append(page.term(formula_of_factored(form)))
    page.define("chi", *members, say="exponential_modes", closing=False)


def tell_question(page: Builder, factor: Scalar | None) -> None:
    """State the undecided question."""
    if factor is None:
        page.remark("too_many_states", order=str(page.plant.order))
    else:
        page.remark("no_closed_form", factor=factor, degree=str(factor.degree(page.plant.variable)))


def tell_exponential(page: Builder, found: Exponential, matrix: Matrix, *, answer: bool = False) -> None:
    """Define e^{At}: the sum over the modes where it is short, then the entries, then the roots."""
    count = sum(len(own) for _, _, own in found.parts)
    is_shown = not found.is_closed or 1 < count <= _SHOWN_SUM
    members: list[Term | Matrix] = [page.term(_sum_of_modes(found))] if is_shown else []
    say = "exponential_sum" if members and "exponential_sum" not in page.told else "exponential_here"
    page.told.add(say)
    if found.is_closed and (not members or found.order == 2 or is_narrow(matrix, within=_ENTRIES)):
        members.append(matrix)
    page.define("exp_At", *members, say=say, answer=answer, closing=False)
    tell_roots(page, matrix)


def tell_roots(page: Builder, *values: Matrix) -> None:
    """Define the letters of square roots."""
    for name in page.forms:
        used = any(name in v.names or any(name in f.argument.names for f in _functions(v)) for v in values)
        root = function_named(name)
        if used and root is not None:
            square = page.term(Power(Literal(Scalar.symbol(name)), 2))
            page.conclude("root_named", root=relation(square, page.term(_term_by_term(root.argument))))


def _term_by_term(value: Scalar) -> Formula:
    """Return ω² − b²/4, a sum of its terms."""
    terms: list[Formula] = []
    for coefficient, powers in sorted(value.terms(), key=lambda term: term[0] < 0):
        monomial = Scalar.of(abs(coefficient)) / value.denominator
        for name, power in powers:
            monomial = monomial * Scalar.symbol(name) ** power
        terms.append(Negative(Literal(monomial)) if coefficient < 0 else Literal(monomial))
    return Sum(tuple(terms)) if len(terms) > 1 else terms[0]


def _functions(value: Matrix) -> list[Any]:
    return [f for name in value.names if (f := function_named(name)) is not None]


def _sum_of_modes(found: Exponential) -> Formula:
    """Return Σ function · matrix; a single pair on two states in the letters A and I, in the functions of the entries."""
    mode = found.parts[0][0]
    is_pair = found.order == 2 and len(found.parts) == 1 and len(mode.start) == 2
    if is_pair and isinstance(mode, Mode) and (mode.oscillates or rate_parts(mode.rate)[1].is_zero):
        still = Mode(Scalar.of(0), mode.discriminant, mode.oscillates)
        C, S = still.values(0, TIME)
        shifted = _shifted(mode.rate)
        inside = Sum((Product((Literal(C), Identity(2))), Product((Literal(S), shifted))))
        rate = found_rate(mode.rate)
        return inside if rate is None else Product((rate, inside))
    terms = []
    for mode, power, matrices in found.parts:
        for value, matrix in zip(mode.values(power, TIME), matrices, strict=True):
            if matrix.is_zero:
                continue
            terms.append(Literal(matrix) if value.is_one else Product((Literal(value), Literal(matrix))))
    return Sum(tuple(terms)) if len(terms) > 1 else terms[0]


def found_rate(rate: Scalar) -> Formula | None:
    """Return e^{σt}, None where it is 1."""
    from symobs.exact.core.generators import function  # noqa: PLC0415

    return None if rate.is_zero else Literal(function("exp", rate * TIME))


def _shifted(rate: Scalar) -> Formula:
    """Return A − σI."""
    if rate.is_zero:
        return Letter("A")
    negative = rate.terms()[0][0] > 0
    size = rate if negative else -rate
    amount: Formula = Identity(2) if size.is_one else Product((Literal(size), Identity(2)))
    return Sum((Letter("A"), Negative(amount) if negative else amount))


@method("matrix_exponential/derivatives", source="leonard1996")
def derivatives(plant: StateSpace) -> MatrixExponential:
    """Solve Σᵢ fᵢ⁽ᵏ⁾(0) Mᵢ = Aᵏ for the matrices of e^{At} = Σ fᵢ(t) Mᵢ."""
    return MatrixExponential.of(plant, "derivatives", {}, {})


@task
def matrix_exponential(plant: StateSpace, *, method: Name = "auto") -> Result:
    """Return e^{At} as a real matrix of exponentials, cosines, sines, cosh, sinh and powers of t; Aᵏ in discrete time.

    plant    n states; only A matters
    Returns matrix, in t; in discrete time in k, of λᵏ, real and imaginary parts of (σ + iω)ᵏ, powers of k and, where A is
    singular, δ(k, j).  Where the sign of a discriminant decides between oscillation and none, conditions hold the
    branch that is shown and cases the others.  An irreducible factor q of χ of degree 3 or more brings sums over its roots,
    Σ λʲ e^{λt}/q′(λ), in SymPy's syntax `RootSum`; where parameters make two of the roots equal it is undecided.
    Raises `InputError` where t, or k in discrete time, is a parameter of A.
    Source: I. E. Leonard (1996).
    """
    if plant.is_discrete:
        require_no_instant(plant)
        name = choose("matrix_exponential", method, "derivatives").name
        return MatrixPower.of(plant, name, {}, {}).asked(method)
    require_continuous(plant, "matrix_exponential")
    return choose("matrix_exponential", method, "derivatives").solve(plant)


# In discrete time: the powers Aᵏ in closed form, Aᵏ⁺¹ = A Aᵏ and A⁰ = I.


def require_no_instant(plant: StateSpace) -> None:
    """Raise `InputError` where k is a parameter of the plant."""
    if "k" in plant.matrices.symbols:
        message = "k is the number of the instant and cannot be a parameter of the plant"
        raise InputError(message, where="plant.A", repair="give the parameter another name")


def following(term: Term) -> Term:
    """Return the value of a function of k at the next instant."""
    return term.at("k", INSTANT + 1)


def powers_of(A: Matrix, variable: str) -> Matrix:
    """Return Aᵏ.  Raises `NoClosedForm`."""
    return reduce(add, (matrix * value for value, matrix in matrix_power(A, variable))).normal()


@dataclass
class MatrixPower(MatrixExponential):
    """Aᵏ."""

    functions_of_time = {"A^k": "matrix"}
    letters = {"matrix": "A_k"}

    @classmethod
    def of(cls, plant: StateSpace, method_name: str, _: Mapping[str, Any], taken: Signs) -> Self:
        """Return the result for a plant."""
        answer: MatrixExponentialAnswer = {"matrix": None, "taken": taken, "chosen": {}}
        try:
            return cls(plant, method_name, {**answer, "matrix": powers_of(plant.matrices.A, plant.variable)})
        except NoClosedForm as error:
            return cls(plant, method_name, {**answer, "question": question_of(error), "factor": error.factor})

    def claims(self) -> Iterator[Claim]:
        """Yield the recursion and the start."""
        yield from super(MatrixExponential, self).claims()
        if self.answer["matrix"] is None:
            return
        e = time_environment(self.plant, {"A": self.plant.matrices.A, "A_k": self.answer["matrix"]})
        power = letter("A_k", e)
        yield holds(e, "{power} = A A_k", power=following(power))
        yield holds(e, "A_k(k = 0) = I")

    @property
    def denominators(self) -> tuple[Scalar, ...]:
        """Those of the entries."""
        return super(MatrixExponential, self).denominators

    def write(self, page: Builder) -> None:
        """Write the characteristic polynomial, the sum of functions and matrices, the entries, the check."""
        page.in_time(*self.everything())
        given(page)
        with page.section("matrix_power"):
            tell_polynomial(page)
            self.write_branches(page, _write_power)


def _write_power(page: Builder, result: MatrixPower) -> None:
    """Write one branch."""
    if result.answer["matrix"] is None:
        tell_open_power(page, result.answer["factor"])
        return
    power = tell_power(page, result.plant.matrices.A, result.answer["matrix"], answer=True)
    start = page.line("{k} = I", k=power.at("k", 0))
    page.verified("power_start", rate=relation(following(power), page["A"] @ power), start=start)


def tell_open_power(page: Builder, factor: Scalar | None) -> None:
    """State the undecided question."""
    if factor is None:
        page.remark("too_many_states_power", order=str(page.plant.order))
    else:
        page.remark("no_closed_power", factor=factor, degree=str(factor.degree(page.plant.variable)))


def tell_power(page: Builder, A: Matrix, value: Matrix, *, answer: bool = False) -> Term:
    """Define Aᵏ: the sum over the modes where it is short, then the entries."""
    parts = matrix_power(A, page.plant.variable)
    members: list[Term | Matrix] = []
    if 1 < len(parts) <= _SHOWN_SUM:
        members = [page.term(Sum(tuple(Product((Literal(f), Literal(matrix))) for f, matrix in parts)))]
    say = "power_sum" if members else "power_here"
    power = page.define("A_k", *members, value, say=say, answer=answer, closing=False)
    tell_impulses(page, value)
    return power


def tell_impulses(page: Builder, value: Matrix) -> None:
    """Say what δ(k, j) is, where it occurs."""
    if any(found.kind == "KroneckerDelta" for found in functions_in([value])):
        page.remark("power_delta")
