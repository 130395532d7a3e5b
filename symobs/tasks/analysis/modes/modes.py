"""Modes one by one: which eigenvalues of A an output shows (an input moves), and which of them are stable.

An eigenvalue is handled through its irreducible factor q of χ: what holds in Q(parameters)[λ]/(q) holds for every root
of q, whether or not it has a closed form.  The eigenvectors at λ that C does not see are those of A on ker 𝒪, so with
X = A on ker 𝒪 they span dim ker q(X) / deg q dimensions, and the polynomial of the fixed modes is det(sI − X).
"""

from __future__ import annotations

from dataclasses import replace
from functools import cached_property
from typing import TYPE_CHECKING, Any

from symobs.exact import (
    EIGENVALUE,
    AlgebraicExtension,
    Factored,
    Matrix,
    Root,
    Scalar,
    Shifted,
    echelon,
    factored,
    independent_rows,
    rank,
    remainder,
    roots_of,
    stable_roots,
)
from symobs.formula.tree import Conjunction, Environment, Evaluated, Literal, Relation, Roots
from symobs.formula.tree.term import Term, block, identity
from symobs.ground.dataclass import dataclass
from symobs.proof.certificate.claims import Claim, verify
from symobs.proof.derivation import CaseStep, Conclude, Equal, Step
from symobs.proof.derivation.builder import Builder, relation, sentence, shows
from symobs.proof.derivation.facts import on_stratum
from symobs.stability.criteria.stability import on_boundary, stability
from symobs.system.conditions import sign_of
from symobs.tasks.analysis.page_parts import (
    as_written,
    conditions_of,
    formula_of_factored,
    redefined_letters,
    undecided,
)
from symobs.tasks.analysis.rank.observability import Controllability, Observability
from symobs.tasks.analysis.strata.rank_stratification import maximal_minors
from symobs.tasks.analysis.strata.strata import (
    carried,
    common_zeros,
    constancy,
    constancy_claims,
    holds_where,
    systems_of,
)
from symobs.tasks.result import Case, Result, equality, holds

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator, Mapping

    from symobs.exact import Ideal
    from symobs.system import StateSpace
    from symobs.system.conditions import Condition
    from symobs.tasks.analysis.rank.observability import RankResult
    from symobs.tasks.analysis.strata.strata import RankConstancy, System


#: Up to this order a rank at an eigenvalue is proved by a minor there; with parameters up to the second.
_MINORS, _MINORS_WITH_PARAMETERS = 6, 4
#: With parameters an extension of higher degree is left to the polynomial of the fixed modes.
_DEGREE_WITH_PARAMETERS = 2
TESTS: dict[str, type[RankResult]] = {"observability": Observability, "controllability": Controllability}


@dataclass
class Eigenvalues:
    """The roots of one irreducible factor of χ, and the pencil [A − λI; C] at them.

    `matrix` has a number, or a function of the parameters, for λ where the factor is linear, else the generator of
    `EIGENVALUE`; `witness` is (rows, columns, kernel, free): a minor that does not vanish and a basis of the kernel with a
    minor of its own, None where the rank is left to the polynomial of the fixed modes.
    """

    factor: Scalar
    power: int
    roots: tuple[Root, ...]
    matrix: Matrix
    witness: tuple[tuple[int, ...], tuple[int, ...], Matrix, tuple[int, ...]] | None

    @property
    def relation(self) -> Scalar:
        """What vanishes at the eigenvalue, λ being the unknown."""
        (variable,) = {root.variable for root in self.roots}
        return self.factor.substitute({variable: Scalar.symbol(EIGENVALUE)})

    @property
    def value(self) -> Scalar:
        """λ: a value where the factor is linear, else its generator."""
        return self.roots[0].centre if len(self.roots) == 1 else Scalar.symbol(EIGENVALUE)


def has_open_cases(test: RankResult) -> bool:
    """Return whether the rank is another one somewhere."""
    return bool(test.case_tree) or (test.answer["rank"] == test.plant.order and test.verdict != "yes")


def eigenvalues(A: Matrix, C: Matrix, form: Factored, variable: str) -> tuple[Eigenvalues, ...]:
    """Return the eigenvalues by the factors of χ, with the pencil of the pair at each."""
    found = []
    for factor, power in form.factors:
        roots = roots_of(factor, variable)
        value = roots[0].centre if len(roots) == 1 else Scalar.symbol(EIGENVALUE)
        pencil = Matrix.block([[A - Matrix.identity(A.shape[0]) * value], [C]]).normal()
        found.append(Eigenvalues(factor, power, roots, pencil, _witness(pencil, factor, variable)))
    return tuple(found)


def _witness(
    pencil: Matrix, factor: Scalar, variable: str
) -> tuple[tuple[int, ...], tuple[int, ...], Matrix, tuple[int, ...]] | None:
    order, degree = pencil.shape[1], factor.degree(variable)
    parametric = bool(pencil.names - {EIGENVALUE})
    if order > (_MINORS_WITH_PARAMETERS if parametric else _MINORS):
        return None
    if degree == 1:
        columns, vectors = echelon(pencil)
        kernel = Matrix.of([[v[i, 0] for v in vectors] for i in range(order)], len(vectors))
        rows = independent_rows(pencil.select(range(pencil.shape[0]), columns))
        return rows, columns, kernel, independent_rows(kernel)
    if parametric and degree > _DEGREE_WITH_PARAMETERS:
        return None
    field = AlgebraicExtension(factor.substitute({variable: Scalar.symbol(EIGENVALUE)}), EIGENVALUE)
    columns, kernel = field.echelon(pencil)
    rows = field.echelon(pencil.select(range(pencil.shape[0]), columns).T)[0]
    return rows, columns, kernel, tuple(j for j in range(order) if j not in columns)


def factors_of(chi: Scalar, fixed: Scalar, plant: StateSpace) -> Factored:
    """Return the factors of χ; on a stratum those of the fixed modes and those of the others, which may fall apart there."""
    if not plant.equations:
        return factored(chi, plant.variable)
    powers: dict[Scalar, int] = {}
    for part in (fixed, plant.simplified(remainder(chi, fixed, plant.variable)[0])):
        for factor, power in factored(part, plant.variable).factors:
            powers[factor] = powers.get(factor, 0) + power
    return Factored(Scalar.of(1), tuple(powers.items()))


def hidden_dimension(X: Matrix, factor: Scalar, variable: str, ideal: Ideal | None = None) -> int:
    """Return how many independent eigenvectors of X belong to one root of an irreducible factor of its polynomial."""
    return (X.shape[0] - rank(polynomial_of(factor, variable, X), ideal)) // factor.degree(variable)


def polynomial_of(polynomial: Scalar, variable: str, X: Matrix) -> Matrix:
    """Return the polynomial at a matrix, by Horner's rule."""
    total = Matrix.zeros(*X.shape)
    for coefficient in polynomial.coefficients(variable):
        total = (total @ X + Matrix.identity(X.shape[0]) * coefficient).normal()
    return total


# -- stability of single modes ----------------------------------------------------------------------------------------


def stable_modes(roots: tuple[Root, ...], signs: Mapping[str, str], *, discrete: bool) -> tuple[bool | None, ...]:
    """Return for the roots of one factor whether each is asymptotically stable; None where the parameters decide."""
    factor, variable = roots[0].factor, roots[0].variable
    if stability(factor, variable, signs, discrete=discrete).verdict == "yes":
        return (True,) * len(roots)
    if factor.names <= {variable}:
        if roots[0].is_closed:
            return tuple(_is_stable(root, discrete=discrete) for root in roots)
        if on_boundary(factor, variable, signs, discrete=discrete):
            return (False,) * len(roots)
        return stable_roots(factor, variable, discrete=discrete)
    if len(roots) == 1 and stability(factor, variable, signs, discrete=discrete).verdict == "no":
        return (False,)
    return _by_signs(factor, variable, signs, discrete=discrete) or (None,) * len(roots)


def _by_signs(factor: Scalar, variable: str, signs: Mapping[str, str], *, discrete: bool) -> tuple[bool, ...]:
    """Decide factors in continuous time whose coefficients show it: all roots beyond the axis, or one on each side."""
    if discrete:
        return ()
    coefficients = factor.coefficients(variable)
    mirrored = factor.substitute({variable: -Scalar.symbol(variable)})
    if stability(mirrored, variable, signs, discrete=False).verdict == "yes":
        return (False,) * (len(coefficients) - 1)
    if len(coefficients) == 3 and sign_of(coefficients[2] / coefficients[0], signs) == "negative":
        return (False, True)  # the roots with +√ and with −√
    if len(coefficients) == 3 and coefficients[1].is_zero and sign_of(coefficients[2], signs) == "positive":
        return (False, False)  # on the imaginary axis
    return ()


def _is_stable(root: Root, *, discrete: bool) -> bool:
    """Decide a number c ± √r."""
    c, r = root.centre.fraction(), root.radicand.fraction()
    if r < 0:
        return c * c - r < 1 if discrete else c < 0

    def is_negative(shifted: Any) -> bool:  # c ± √r with another c
        return (
            bool(shifted < 0 and shifted * shifted > r) if root.sign > 0 else bool(shifted < 0 or shifted * shifted < r)
        )

    if not discrete:
        return is_negative(c) if r else c < 0
    if not r:
        return abs(c) < 1
    above_minus_one = not is_negative(c + 1) and (c + 1) ** 2 != r
    return is_negative(c - 1) and above_minus_one


# -- the results ------------------------------------------------------------------------------------------------------


@dataclass
class ModeResult(Result):
    """χ, the rank of the pencil at each of its factors, and the polynomial of the fixed modes.

    Claims: det(sI − A) = χ = the product of the factors; at each factor q, where q(λ) = 0: a minor of the pencil that
    does not vanish and a basis of its kernel, or the rank of q(X); det(sI − X) is the polynomial of the fixed modes, X
    being A on ker 𝒪, whose own claims belong to `test`.
    """

    @property
    def kind(self) -> str:
        """`observability` or `controllability`."""
        raise NotImplementedError

    @staticmethod
    def answer_of(plant: StateSpace, kind: str) -> dict[str, Any]:
        """Return χ, the ranks with the strata outside which they hold, and the polynomial of the fixed modes."""
        test = TESTS[kind].of(plant, "rank")
        A, _ = test.pair(plant)
        variable, X = plant.variable, test.answer["restricted"]
        chi = plant.simplified(A.characteristic_polynomial(variable))
        fixed = plant.simplified(X.characteristic_polynomial(variable)) if X.shape[0] else Scalar.of(1)
        factors = [factor for factor, _ in factors_of(chi, fixed, plant).factors]
        dimensions = [hidden_dimension(X, factor, variable, plant.ideal) for factor in factors]
        others = systems_of(test.case_tree)
        return {
            "polynomial": chi,
            "ranks": tuple(plant.order - dimension for dimension in dimensions),
            "constancy": tuple(
                None if others is None else constancy(X, factor, dimension, plant, others)
                for factor, dimension in zip(factors, dimensions, strict=True)
            ),
            "fixed_polynomial": fixed,
        }

    @cached_property
    def test(self) -> RankResult:
        """The rank test of the pair: 𝒪 or 𝒞."""
        return TESTS[self.kind].of(self.plant, "rank")

    @cached_property
    def spectrum(self) -> tuple[Eigenvalues, ...]:
        """The eigenvalues, factor by factor."""
        form = factors_of(self.answer["polynomial"], self.answer["fixed_polynomial"], self.plant)
        found = eigenvalues(*self.test.pair(self.plant), form, self.plant.variable)
        return tuple(replace(part, witness=None) for part in found) if self.plant.equations else found

    @property
    def parts(self) -> Iterator[tuple[Eigenvalues, int, RankConstancy | None]]:
        """The eigenvalues by factors, each with its rank and where that holds."""
        return zip(self.spectrum, self.answer["ranks"], self.answer["constancy"], strict=True)

    @property
    def all_certificates(self) -> tuple[Any, ...]:
        """The certificates of this result and of the rank test below it."""
        return (*self.certificates, *self.test.all_certificates)

    def claims(self) -> Iterator[Claim]:
        """Yield the spectrum, the rank at each eigenvalue, the polynomial of the fixed modes."""
        A, _ = self.test.pair(self.plant)
        order, X = self.plant.order, self.test.answer["restricted"]
        e = Environment(variable=self.plant.variable, values={"A": A, "X": X, "chi": self.answer["polynomial"]})
        chi = e["chi"]
        yield holds(e, "det(pencil(A)) = chi")
        form = Factored(Scalar.of(1), tuple((part.factor, part.power) for part in self.spectrum))
        yield equality(chi, Term(formula_of_factored(form), e), e)
        counts = len(self.answer["ranks"]), len(self.answer["constancy"])
        yield Claim(relation(*counts, len(self.spectrum)), e, "one rank for each factor")
        for part, found, where in self.parts:
            yield from self._rank_claims(part, found, e)
            if where is not None:
                yield from constancy_claims(where, X, part.factor, order - found, self.plant)
        fixed = e["X"].pencil.apply("det") if X.shape[0] else Term(Literal(Scalar.of(1)), e)
        yield equality(fixed, self.answer["fixed_polynomial"], e)

    def _rank_claims(self, part: Eigenvalues, found: int, e: Environment) -> Iterator[Claim]:
        order, where = self.plant.order, f"{part.relation} = 0"
        if part.witness is None:
            values = {**e.values, "phi": part.factor}
            inner = Environment(variable=e.variable, values=values)
            hidden = self.test.answer["restricted"].shape[0]
            degree = len(part.roots)
            if not hidden:
                yield equality(found, order, inner, f"rank = n where {where}, since ker O = 0")
                return
            value, size = inner["X"].apply("phi_at"), hidden - degree * (order - found)
            if self.plant.is_stratum or not self.plant.relations:
                yield holds(inner, "rank(phi_at(X)) = {size}", f"rank q(X) gives the rank where {where}", size=size)
            else:  # relations between functions of the parameters: not at each of their points, but in general
                yield from self._general_rank_claims(value, size, f"q(X) where {where}")
            return
        rows, columns, kernel, free = part.witness
        inner = Environment(
            variable=e.variable,
            values={**e.values, "M": part.matrix},
            signs=self.plant.symbols.signs,
            relations=(part.relation,) if len(part.roots) > 1 else (),
        )
        M = inner["M"]
        C = self.test.pair(self.plant)[1]
        pencil = [[inner["A"] - identity(order, inner) * part.value], [Term(Literal(C), inner)]]
        yield equality(M, block(pencil), inner, f"where {where}")
        yield Claim(
            relation(found, len(rows), len(columns)), inner, f"the minor has the order of the rank where {where}"
        )
        yield Claim(
            relation(order - found, kernel.shape[1], len(free)), inner, f"the kernel has n - rank where {where}"
        )
        operator = "!=" if not (part.matrix.names - {EIGENVALUE}) else "!=="
        if found:
            minor = Term(Literal(part.matrix.select(rows, columns)), inner).apply("det")
            yield Claim(relation(minor, operator, 0), inner, f"a minor of M is not zero where {where}")
        if kernel.shape[1]:
            N = Term(Literal(kernel), inner)
            yield holds(inner, "M {N} = 0", f"where {where}", N=N)
            minor = Term(Literal(kernel.select(free, range(kernel.shape[1]))), inner).apply("det")
            yield Claim(relation(minor, operator, 0), inner, f"rank N = n - rank M where {where}")

    def _general_rank_claims(self, value: Term, size: int, says: str) -> Iterator[Claim]:
        """Yield that a square matrix has a rank in general: by a minor, and a basis of its kernel."""
        e, ideal, Q = value.environment, self.plant.ideal, value.value.normal()
        columns, vectors = echelon(Q, ideal)
        rows = independent_rows(Q.select(range(Q.shape[0]), columns), ideal)
        yield Claim(relation(size, len(columns), len(rows), Q.shape[0] - len(vectors)), e, f"the rank of {says}")
        if size:
            minor = Term(Literal(Q.select(rows, columns)), e).apply("det")
            yield equality(value, Q, e, f"the matrix {says}")
            yield Claim(relation(minor, "!==", 0), e, f"a minor of {says} is not zero")
        if vectors:
            N = Matrix.of([[v[i, 0] for v in vectors] for i in range(Q.shape[0])], len(vectors))
            free = Term(Literal(N.select(independent_rows(N, ideal), range(len(vectors)))), e).apply("det")
            yield equality(value @ Term(Literal(N), e), N * 0, e, f"the kernel of {says}")
            yield Claim(relation(free, "!==", 0), e, f"the basis of the kernel of {says}")

    # -- fields -------------------------------------------------------------------------------------------------------

    def modes_of(self, *, with_matrix: bool) -> list[dict[str, Any]]:
        """Return the modes with multiplicity: eigenvalue, stable, observable or controllable, rank, matrix.

        The rank holds wherever the mode's `conditions` do; where it holds is not known where they are None.
        """
        seen = "observable" if self.kind == "observability" else "controllable"
        signs, listed = self.plant.symbols.signs, []
        for part, found, where in self.parts:
            stable = stable_modes(part.roots, signs, discrete=self.plant.is_discrete)
            for root, verdict in [pair for pair in zip(part.roots, stable, strict=True) for _ in range(part.power)]:
                mode: dict[str, Any] = {"eigenvalue": root, "stable": verdict}
                mode |= {seen: found == self.plant.order, "rank": found}
                mode["conditions"] = None if where is None else holds_where(where)
                listed.append(mode | ({"matrix": self._pencil_at(root)} if with_matrix else {}))
        return listed

    def _pencil_at(self, root: Root) -> list[list[Any]]:
        """Return [A − λI; C], or [A − λI, B], at one eigenvalue."""
        m, n = self.plant.matrices, self.plant.order
        rows: list[list[Any]] = [list(row) for row in m.A.rows]
        for i in range(n):
            rows[i][i] = (
                m.A[i, i] - root.centre if root.is_closed and root.radicand.is_zero else Shifted(m.A[i, i], root)
            )
        if self.kind == "observability":
            return rows + [list(row) for row in m.C.rows]
        return [[*row, *m.B.rows[i]] for i, row in enumerate(rows)]

    def cases_by(self, solve: Callable[[StateSpace], Result]) -> tuple[Case, ...]:
        """Return the cases of the rank test with the answers of this task there."""
        return carried(self.plant, self.test.case_tree, lambda plant, _: solve(plant))

    def meetings_by(self, solve: Callable[[StateSpace], Result], *further: System) -> tuple[Case, ...]:
        """Return the cases of the other strata on which a rank is not the generic one, and of further ones."""
        known = systems_of(self.test.case_tree)
        if known is None:
            return ()
        found = [system for where in self.answer["constancy"] if where is not None for system in where.systems]
        new = dict.fromkeys(system for system in (*found, *further) if system not in known)
        cases = [case for system in new for case in common_zeros(self.plant, system, lambda plant, _: solve(plant))]
        open_ones = (Case((), {}, None),) if None in self.answer["constancy"] else ()
        return (*{frozenset(case.when): case for case in cases}.values(), *open_ones)


# Parts of pages about single modes: the spectrum, the pencil at each eigenvalue, the modes that cannot be moved.


def show_spectrum(page: Builder, result: ModeResult) -> None:
    """Write χ with its factors, and its roots."""
    plant, chi = page.plant, result.answer["polynomial"]
    form = factored(chi, plant.variable)
    product = page.term(formula_of_factored(form))
    members = [page["det(pencil(A))"], page.value(chi)]
    if len(form.factors) > 1 or form.factors[0][1] > 1:
        members.append(product)
    page.define("chi", *members, say="eigenvalue_polynomial", closing=False)
    page.conclude("eigenvalues", roots=Roots(page["chi"].formula, roots_of(chi, plant.variable)))
    if any(not part.roots[0].is_closed for part in result.spectrum):
        page.remark("eigenvalues_open")


def pencil_of(page: Builder, result: ModeResult, value: Scalar | None = None) -> Term:
    """Return [A − λI; C], or [A − λI, B], as a formula."""
    eigenvalue = page.value(Scalar.symbol(EIGENVALUE) if value is None else value)
    shifted = page("A - {eigenvalue} I", eigenvalue=eigenvalue)
    if result.kind == "observability":
        return page("[{shifted}; C]", shifted=shifted)
    return page("[{shifted}, B]", shifted=shifted)


def at_eigenvalues(page: Builder, result: ModeResult, parts: Iterable[Eigenvalues]) -> bool:
    """Write one matrix and one rank for each eigenvalue, and where the rank is too low the vectors that show it.

    With parameters they hold under the conditions that are told with the eigenvalue.  Return whether all were written.
    """
    wanted, complete = {part.factor for part in parts}, True
    for part, found, where in result.parts:
        if part.factor not in wanted:
            continue
        known = part.witness is not None and where is not None
        steps = _at(page, result, part, found, holds_where(where)) if known else []  # type: ignore[arg-type]
        page.steps += steps
        complete = complete and bool(steps)
    return complete


def _at(page: Builder, result: ModeResult, part: Eigenvalues, rank: int, conditions: list[Condition]) -> list[Step]:
    dual = result.kind == "controllability"
    unknown = page.value(Scalar.symbol(EIGENVALUE))
    pencil, matrix = pencil_of(page, result), part.matrix.T if dual else part.matrix
    at = relation(unknown, part.value) if len(part.roots) == 1 else relation(part.relation, 0)
    ranks = relation(pencil.apply("rank"), page("rank({matrix})", matrix=matrix), rank)

    def where(kept: list[Condition]) -> Relation | Conjunction:
        return Conjunction((at, *map(as_written, kept))) if kept else at

    for condition in conditions:
        fewer = [each for each in conditions if each is not condition]
        if verify(ranks, on_stratum(where(fewer), {}, page.environment))[0]:
            conditions = fewer
    when = where(conditions)
    if part.matrix.names - {EIGENVALUE} and not shows([ranks], on_stratum(when, {}, page.environment)):
        return []  # it is shown by the minors of X − λI, and too long to be shown by those of the whole matrix
    steps: list[Step] = [Equal((ranks,))]
    singular = page("det(A - {unknown} I)", unknown=unknown)
    steps.append(Conclude(None, (relation(pencil, matrix), relation(singular, 0))))
    kernel: Matrix = part.witness[2]  # type: ignore[index]
    shown = kernel.shape[1] if _are_independent(kernel, on_stratum(when, {}, page.environment)) else 0
    for j in range(shown):
        vector = kernel.select(range(page.plant.order), [j])
        first = next((entry for entry in vector.entries if entry), Scalar.of(1))
        v = page.value(-vector if first.is_constant and first.fraction() < 0 else vector)
        zero = Matrix.zeros(part.matrix.shape[0], 1)
        image = relation(v.T @ pencil, zero.T) if dual else relation(pencil @ v, zero)
        low = sentence(f"pbh_low_{result.kind}", {"rank": Evaluated(ranks.members[0], ranks.members[-1])})
        steps.append(Equal((image,), low if not j else None))
    return [CaseStep(when, (), tuple(steps))]


def _are_independent(vectors: Matrix, here: Environment) -> bool:
    """Return whether eigenvectors are independent at every point, none of them 0."""
    minors = Matrix.column(maximal_minors(vectors)) if vectors.shape[1] else Matrix.of([[1]])
    return bool(verify(relation(minors, "!=", minors * 0), here)[0])


def meeting_steps(page: Builder, result: ModeResult) -> Iterator[Step]:
    """Yield a case for each stratum on which only eigenvectors are others than in general, with the ranks there."""
    for case in result.meeting_cases:
        yield undecided(page, case) if case.result is None else eigenvectors_there(page, case, "ranks_meet")[0]


def eigenvectors_there(page: Builder, case: Case, say: str = "", *, closing: str = "") -> tuple[Step, bool]:
    """Return a case with the ranks below n at eigenvalues, and whether all of them could be written."""
    found: Any = case.result
    inner = Builder(found.plant)
    values = {name: getattr(found.plant.matrices, name) for name in "ABC" if name in page.environment.values}
    inner.environment = page.environment.extended_by(values=values)
    low = [part for part, rank, _ in found.parts if rank < found.plant.order]
    is_whole = at_eigenvalues(inner, found, low)
    if closing:
        inner.conclude(closing)
    inner.steps += meeting_steps(inner, found)
    anew = redefined_letters(page.environment, inner.environment)
    words = sentence(say, {}) if say else None
    step = CaseStep(conditions_of(case), tuple(case.substitution.items()), tuple(inner.steps), words, anew)
    return step, is_whole


def fixed_modes(page: Builder, result: ModeResult) -> None:
    """Establish N and X with A N = N X, C N = 0, and write the polynomial of the fixed modes."""
    test = result.test
    page.set("N", test.answer["kernel"])
    page.set("X", test.answer["restricted"])
    show_hidden(page, result, "fixed_modes")


def show_hidden(page: Builder, result: ModeResult, words: str) -> None:
    """Show N and X, which are established, and what makes the eigenvalues of X the fixed modes."""
    test = result.test
    A = page["A"] if result.kind == "observability" else page["A.T"]
    page.equal(
        relation(page["N"], test.answer["kernel"]),
        page.line("{A} N = N X", A=A),
        relation(page["X"], test.answer["restricted"]),
        say=f"{words}_{result.kind}",
    )


def stack_of(page: Builder, kind: str) -> Term:
    """Return [C; CA; …] or [B, AB, …] as a formula."""
    powers = range(1, page.plant.order)
    if kind == "observability":
        return block([[page["C"]], *([page["C"] @ page["A"] ** k] for k in powers)])
    return block([[page["B"], *(page["A"] ** k @ page["B"] for k in powers)]])
