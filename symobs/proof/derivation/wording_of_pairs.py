"""What sentences say of a pair of matrices: its rank, its hidden modes, its dual, its gains (trusted)."""

from __future__ import annotations

from re import findall
from typing import TYPE_CHECKING

from symobs.exact import Ideal, Matrix, Scalar, companion, echelon, independent_rows, unit_rows
from symobs.formula.phrases.languages import Counted, StateChoice
from symobs.formula.tree import (
    Apply,
    At,
    Block,
    Evaluated,
    Exact,
    Formula,
    HoldsExactlyWhere,
    Letter,
    Literal,
    Negative,
    Power,
    Product,
    Quotient,
    Relation,
    Roots,
    Sum,
    Transpose,
    evaluate,
)
from symobs.formula.tree.calculus import TIME
from symobs.formula.tree.written import written
from symobs.proof.certificate.claims import as_scalar, verify
from symobs.proof.certificate.pointwise import Pointwise
from symobs.proof.derivation.sentence_context import (
    WEAKER,
    SentenceContext,
    are_about,
    characteristic_of,
    is_not_zero,
    is_shown_in,
    is_value,
    letter_of,
    number_of,
    sizes_of,
    stack_of,
    vanishes,
)
from symobs.stability.criteria.stability import on_boundary

if TYPE_CHECKING:
    from collections.abc import Callable

    from symobs.formula.tree import Environment


def says_rank(*, is_full: bool, everywhere: bool = False) -> Callable[[Relation, Environment], bool]:
    """Return the check that a relation is of a rank that is full, or lower, and that it is the same everywhere."""

    def is_said(relation: Relation, environment: Environment) -> bool:
        if everywhere and not _is_everywhere(relation, environment):
            return False
        return _is_of_rank(relation, environment, is_full=is_full)

    return is_said


def of_pair(**says: bool) -> Callable[..., bool]:
    """Return the check of a rank that is said of a pair: it is that of the pair's own test matrix."""
    is_such = says_rank(**says)

    def is_said(relation: Relation, environment: Environment, row: str, of: str) -> bool:
        matrix, stack = ranked_matrix(relation), stack_of(row, of, environment)
        if matrix is None or not is_such(relation, environment):
            return False
        return is_shown_in(environment, Transpose(matrix) if row.endswith("ᵀ") else matrix, "=", stack)

    return is_said


def is_observable(said: SentenceContext, row: str, of: str) -> bool:
    """Return whether the pair is observable for all parameters; where it varies, at almost every time."""
    here, stack = said.environment, stack_of(row, of, said.environment)
    order = sizes_of(of, here)[0]
    if here.variable == TIME:
        value = evaluate(stack, here, Exact(here))
        rows = independent_rows(value, Ideal.where(here.relations))
        return len(rows) == order and is_not_zero(here, Apply("det", Literal(value.select(rows, range(order)))))
    rank_is = Relation((Apply("rank", stack), number_of(order)), ("=",))
    return verify(rank_is, here)[0] != "" and _is_everywhere(rank_is, here)


def moves_integrators(said: SentenceContext) -> bool:
    """Return whether the input moves plant and integrators of r − y, or moves the plant, which has no zero where they stand."""
    if is_observable(said, "B_hatᵀ", "A_hatᵀ"):
        return True
    here = said.environment
    A, B, C, whole, entering = (evaluate(Letter(x), here, Exact(here)) for x in ("A", "B", "C", "A_hat", "B_hat"))
    (n, m), p = B.shape, C.shape[0]
    z, D = whole[n, n], evaluate(Letter("D"), here, Exact(here)) if "D" in here.values else Matrix.zeros(p, m)
    extended = Matrix.block([[A, Matrix.zeros(n, p)], [-C, Matrix.identity(p) * z]]), Matrix.block([[B], [-D]])
    system = Literal(Matrix.block([[A - Matrix.identity(n) * z, B], [C, D]]))
    ranks = ((stack_of("Bᵀ", "Aᵀ", here), n), (system, n + p))
    told = [Relation((Apply("rank", matrix), number_of(rank)), ("=",)) for matrix, rank in ranks]
    is_seen = all(verify(each, here)[0] != "" and _is_everywhere(each, here) for each in told)
    return is_seen and z in {Scalar.of(0), Scalar.of(1)} and (whole, entering) == extended


def is_unobservable(said: SentenceContext, row: str, of: str) -> bool:
    """Return whether a vector other than 0 lies in the kernel of the test matrix."""
    here = said.environment
    stack = evaluate(stack_of(row, of, here), here, Exact(here))
    vectors = map(Literal, echelon(stack, Ideal.where(here.relations))[1])
    return any(vanishes(here, Product((Literal(stack), vector))) and is_not_zero(here, vector) for vector in vectors)


def is_regular_at(relation: Relation, environment: Environment, row: str, of: str) -> bool:
    """Return whether a relation is that the determinant of the test matrix at an instant is not 0."""
    first, last = relation.members[0], relation.members[-1]
    matrix = first.argument if isinstance(first, Apply) and first.function == "det" else first
    if not isinstance(matrix, At) or matrix.name != TIME or (relation.operators[-1], last) != ("!=", number_of(0)):
        return False
    return is_shown_in(environment, matrix.operand, "=", stack_of(row, of, environment))


def _is_part(said: SentenceContext, row: str, of: str, N: str, X: str) -> bool:
    """Return whether the columns of N are independent, C N = 0 and A N = N X: they span unobservable states."""
    return said.holds(f"rank({N}) = {said.size(N)[1]}", f"{row} {N} = 0", f"({of}) {N} = {N} {X}")


def _is_whole(said: SentenceContext, row: str, of: str, N: str, X: str) -> bool:
    """Return whether the columns of N are a basis of the unobservable subspace, on which A is X."""
    seen = said.size(N)[0] - said.size(N)[1]
    return _is_part(said, row, of, N, X) and said.holds(f"rank({{stack}}) = {seen}", stack=said.stack(row, of))


def fixes(said: SentenceContext, row: str, of: str, N: str, X: str, phi: str) -> bool:
    """Return whether no gain moves the modes told, and what is said of the quotient of φ by their polynomial is said of it.

    A quotient that is a polynomial nowhere is φ's; one that is one nowhere but where a remainder vanishes is that of the
    remainder.
    """
    here, fixed, wanted = said.environment, characteristic_of(X, said.environment), letter_of(phi)
    told = [slot.polynomial for name, slot in said.slots.items() if isinstance(slot, Roots) and name != "missing"]
    told += [roots.polynomial for roots in said.facts if isinstance(roots, Roots)]
    told += [slot.formula for name, slot in said.slots.items() if name == "fixed" and isinstance(slot, Evaluated)]
    told += [slot.members[0] for slot in said.slots.values() if isinstance(slot, Relation)]
    rest = said.slots.get("rest")
    if isinstance(rest, Evaluated):
        whole = Quotient(Sum((wanted, Negative(rest.formula))), fixed)
        if not is_value(here, "polynomial", whole):
            return False
        wanted = rest.formula
    return (
        _is_part(said, row, of, N, X)
        and all(is_shown_in(here, polynomial, "=", fixed) for polynomial in told)
        and all(is_shown_in(here, Product((subject, fixed)), "=", wanted) for subject in said.subjects())
    )


def misses(said: SentenceContext, X: str, phi: str) -> bool:
    """Return whether the roots told as missing are eigenvalues of X, and none of them is a root of φ for any parameters."""
    here, told = said.environment, said.slots["missing"]
    if not isinstance(told, Roots):
        return False
    value = as_scalar(evaluate(told.polynomial, here, Exact(here)))
    factors = [Literal(f) for f, _ in value.numerator.factors()[1] if f.degree(here.variable)]
    is_part = is_value(here, "polynomial", Quotient(characteristic_of(X, here), told.polynomial))
    return is_part and all(is_value(here, "not_polynomial", Quotient(letter_of(phi), factor)) for factor in factors)


def are_modes(said: SentenceContext, row: str, of: str, *letters_of: str) -> bool:
    """Return whether the unobservable modes are the eigenvalues of X, and are those told."""
    here, told = said.environment, [roots.polynomial for roots in said.of(Roots)]
    return any(
        N in here.values
        and _is_whole(said, row, of, N, X)
        and all(is_shown_in(here, polynomial, "=", characteristic_of(X, here)) for polynomial in told)
        for N, X in zip(letters_of[::2], letters_of[1::2], strict=True)
    )


def exhausts(said: SentenceContext, row: str, of: str, N: str, X: str, phi: str) -> bool:
    """Return whether φ is the polynomial of modes that no gain moves."""
    return _is_part(said, row, of, N, X) and said.holds(f"{phi} = det(pencil({X}))")


def are_seen(said: SentenceContext, row: str, of: str, N: str, X: str) -> bool:
    """Return whether a property is said of the polynomial of all observable modes."""
    if N in said.environment.values:
        seen = written(f"det(pencil({of})) / det(pencil({X}))", said.environment).formula
        return _is_whole(said, row, of, N, X) and are_about(said, seen)
    full = said.holds(f"rank({{stack}}) = {said.size(of)[0]}", stack=said.stack(row, of))
    return full and are_about(said, characteristic_of(of, said.environment))


def are_stable(said: SentenceContext, row: str, of: str, N: str, X: str, mu: str) -> bool:
    """Return whether there are no unobservable modes, or all are stable, in the sense in which it is meant."""
    here = said.environment
    if N not in here.values:
        return is_observable(said, row, of)
    told = said.subjects("stable")
    stable = any(is_shown_in(here, subject, "=", characteristic_of(X, here)) for subject in told)
    weaker = WEAKER in here.values and Letter(mu) in said.subjects("marginal")
    return _is_whole(said, row, of, N, X) and (stable or (weaker and is_bounded(said, X, mu)))


def are_unstable(said: SentenceContext, row: str, of: str, N: str, X: str, mu: str) -> bool:
    """Return whether an unobservable mode is not stable, in the sense in which it is meant."""
    here, weaker = said.environment, WEAKER in said.environment.values
    told = said.subjects("beyond" if weaker else "unstable")
    beyond = any(is_shown_in(here, subject, "=", characteristic_of(X, here)) for subject in told)
    return _is_part(said, row, of, N, X) and (beyond or (weaker and is_chained(said, X, mu)))


def is_bounded(said: SentenceContext, X: str, mu: str) -> bool:
    """Return whether μ(X) = 0, and all repeated roots of μ are stable: modes on the boundary are semisimple."""
    here = said.environment
    factors = as_scalar(here.values[mu]).numerator.factors()[1]
    repeated = [factor for factor, power in factors if power > 1 and factor.degree(here.variable)]
    stable = all(is_value(here, "stable", Literal(factor)) for factor in repeated)
    return stable and vanishes(here, Apply(f"{mu}_at", Letter(X)))


def is_chained(said: SentenceContext, X: str, mu: str) -> bool:
    """Return whether μ(X) is not 0, though no root of χ/μ is stable: one of them is in a chain."""
    here, zero = said.environment, Product((number_of(0), Letter(X)))
    left = as_scalar(evaluate(Quotient(characteristic_of(X, here), Letter(mu)), here, Exact(here)))
    factors = [factor for factor, _ in left.numerator.factors()[1] if factor.degree(here.variable)]
    unstable = left.is_polynomial_in(here.variable) and all(is_value(here, "unstable", Literal(f)) for f in factors)
    return unstable and is_shown_in(here, Apply(f"{mu}_at", Letter(X)), "!=", zero)


def are_unseen(said: SentenceContext, row: str, of: str, *, all_of_them: bool = False) -> bool:
    """Return whether the vectors on which products end, transposed those with which they begin, are unobservable."""
    here, products = said.environment, [fact.members[0] for fact in said.facts if isinstance(fact, Relation)]
    ends = [product.factors for product in products if isinstance(product, Product)]
    vectors = [
        first.operand if isinstance(first, Transpose) and isinstance(first.operand, Literal) else last
        for first, *_, last in ends
    ]
    stack = stack_of(row, of, here)
    for vector in vectors:
        order, count = evaluate(vector, here, Exact(here)).shape
        ranks = [(vector, count), (stack, order - count)] if all_of_them else []
        whole = all(is_shown_in(here, Apply("rank", matrix), "=", number_of(value)) for matrix, value in ranks)
        if not (whole and vanishes(here, Product((stack, vector))) and is_not_zero(here, vector)):
            return False
    return 0 < len(ends) == len(products)


def repairs(said: SentenceContext, row: str, of: str) -> bool:
    """Return whether the facts are, set by set, that the test matrix has full rank with these states measured too."""
    here, (choice,) = said.environment, said.of(StateChoice)
    order, A = sizes_of(of, here)[0], letter_of(of)
    for numbers, fact in zip(choice.sets, said.facts, strict=True):
        rows: Formula = Literal(unit_rows(order, tuple(number - 1 for number in numbers)))
        parts = [stack_of(row, of, here), rows, *(Product((rows, Power(A, k))) for k in range(1, order))]
        wanted, matrix = (
            Block(tuple((part,) for part in parts)),
            ranked_matrix(fact) if isinstance(fact, Relation) else None,
        )
        if not isinstance(fact, Relation) or matrix is None or not _is_of_rank(fact, here, is_full=True):
            return False
        if not is_shown_in(here, matrix, "=", wanted):
            return False
    return True


def are_duals(said: SentenceContext, *pairs: str) -> bool:
    """Return whether one pair is (C, A), the other (B_dualᵀ, A_dualᵀ) up to the sign of A, and the ranks are theirs."""
    here, (row, of, other, by) = said.environment, pairs
    image, A = letter_of(by), letter_of(of)
    ranks = [ranked_matrix(Relation((part,), ())) for slot in said.of(Relation) for part in slot.members[:2]]
    own = (
        Transpose(stack_of(row, of, here)),
        stack_of(row, of, here),
        Transpose(stack_of(other, by, here)),
        stack_of(other, by, here),
    )
    return (
        is_shown_in(here, letter_of(row), "=", letter_of(other))
        and (is_shown_in(here, image, "=", A) or is_shown_in(here, image, "=", Negative(A)))
        and len(ranks) == 2
        and all(rank is not None and any(is_shown_in(here, rank, "=", stack) for stack in own) for rank in ranks)
    )


def is_on_boundary(said: SentenceContext, row: str, of: str, N: str, X: str) -> bool:
    """Return whether N is hidden, and the eigenvalues of X lie on the boundary."""
    here, v = said.environment, said.environment.variable
    factors = as_scalar(evaluate(characteristic_of(X, here), here, Exact(here))).numerator.factors()[1]
    on = [on_boundary(factor, v, here.signs, discrete=v == "z") for factor, _ in factors if factor.degree(v)]
    return _is_part(said, row, of, N, X) and bool(on) and all(on)


def has_rank(said: SentenceContext, *, is_full: bool) -> bool:
    """Return whether a fact is a full rank, or one that is not full."""
    return any(
        _is_of_rank(fact, said.environment, is_full=is_full) for fact in said.facts if isinstance(fact, Relation)
    )


def is_test(said: SentenceContext, row: str, of: str) -> bool:
    """Return whether what is introduced or shown first is the test matrix of the pair."""
    first = [said.introduced, *said.of(Relation)]
    shown = next(relation.members[0] for relation in first if relation is not None)
    return is_shown_in(
        said.environment, Transpose(shown) if row.endswith("ᵀ") else shown, "=", stack_of(row, of, said.environment)
    )


def is_exact(said: SentenceContext, row: str, of: str, N: str, X: str) -> bool:
    """Return whether it was said last where the polynomial of the unobservable modes, all of them, is stable."""
    here = said.environment
    fixed = characteristic_of(X, here)
    found = [fact.property.subject for fact in here.shown if isinstance(fact, HoldsExactlyWhere)]
    return bool(found) and _is_whole(said, row, of, N, X) and all(is_shown_in(here, each, "=", fixed) for each in found)


def has_freedom(said: SentenceContext, row: str, of: str) -> int:
    """Return of what dimension the gains are that place the same poles: n p, less the rank of the test matrix."""
    here = said.environment
    outputs, order = sizes_of(row, here)
    stack = evaluate(stack_of(row, of, here), here, Exact(here))
    return outputs * order - len(echelon(stack, Ideal.where(here.relations))[0])


def counts_free(said: SentenceContext, row: str, of: str) -> bool:
    """Return whether r(p − 1) parameters are said to be free and (n − r)p entries, r the rank of the test matrix."""
    outputs, order = sizes_of(row, said.environment)
    seen = outputs * order - has_freedom(said, row, of)
    told = Counted("free_parameter", seen * (outputs - 1)), Counted("free_entry", (order - seen) * outputs)
    return (said.slots["free"], said.slots["rest"]) == told


def is_of_low_rank(said: SentenceContext) -> bool:
    """Return whether the rank told is that of the matrix whose kernel, or left kernel, a vector is shown to be in."""
    rank_of = said.slots["rank"]
    matrix = rank_of.formula.argument if isinstance(rank_of, Evaluated) and isinstance(rank_of.formula, Apply) else None
    shown = [fact.members[0] for fact in said.facts if isinstance(fact, Relation)]
    return matrix is not None and all(isinstance(each, Product) and matrix in each.factors for each in shown)


def is_canonical(said: SentenceContext) -> bool:
    """Return whether (A, B) is in controllable canonical form."""
    A, B = (evaluate(Letter(name), said.environment, Exact(said.environment)) for name in "AB")
    order, variable = A.shape[0], said.environment.variable
    chi = A.characteristic_polynomial(variable).coefficients(variable)
    return bool(companion(chi[1:]) == A and Matrix.unit(order, order - 1) == B)


def has_no_gain(said: SentenceContext) -> bool:
    """Return whether what has to vanish, or 1, lies in the ideal of det(sI − A + LC) − φ, with zeros at the places of L."""
    places = [tuple(int(part) - 1 for part in pair) for pair in findall(r"\((\d+), (\d+)\)", str(said.slots["places"]))]
    value = said.slots.get("when", number_of(1))
    return isinstance(value, Formula) and any(
        {row.rstrip("ᵀ"), phi} <= said.environment.values.keys() and _lacks_gain(said, value, row, of, phi, places)
        for row, of, phi in (("C", "A", "phi_o"), ("Bᵀ", "Aᵀ", "phi_c"))
    )


def _lacks_gain(
    said: SentenceContext, value: Formula, row: str, of: str, phi: str, places: list[tuple[int, ...]]
) -> bool:
    here, variable = said.environment, said.environment.variable
    A, C, wanted = (evaluate(letter_of(name), here, Exact(here)) for name in (of, row, phi))
    empty = {place[::-1] if row.endswith("ᵀ") else place for place in places}
    rows = [
        [Scalar.of(0) if (i, j) in empty else Scalar.symbol(f"_l{i}_{j}") for j in range(C.shape[0])]
        for i in range(A.shape[0])
    ]
    chi = (A - Matrix.of(rows, C.shape[0]) @ C).normal().characteristic_polynomial(variable)
    return is_shown_in(here.with_relations((chi - wanted).coefficients(variable)), value, "=", number_of(0))


def ranked_matrix(relation: Relation) -> Formula | None:
    """Return the matrix whose rank is the first member of a relation."""
    first = relation.members[0]
    return first.argument if isinstance(first, Apply) and first.function == "rank" else None


def _is_everywhere(relation: Relation, environment: Environment) -> bool:
    """Return whether the rank that a relation begins with is seen to be the same for all parameters."""
    first = relation.members[0]
    if not isinstance(first, Apply) or not evaluate(first.argument, environment, Exact(environment)).names:
        return True
    try:
        evaluate(first, environment, Pointwise(environment))
    except (ArithmeticError, TypeError):
        return False
    return True


def _is_of_rank(relation: Relation, environment: Environment, *, is_full: bool) -> bool:
    """Return whether a relation is rank = r with the full r, or with a lower one, followed by nothing but the full one."""
    matrix, others = ranked_matrix(relation), relation.members[1:]
    if matrix is None:
        return False
    full = min(evaluate(matrix, environment, Exact(environment)).shape)
    ranks = [as_scalar(evaluate(member, environment, Exact(environment))).fraction() for member in others]
    if is_full:
        return relation.operators == ("=",) and ranks == [full]
    if relation.operators == ("<",):
        return ranks == [full]
    return ranks[0] < full and (relation.operators, ranks[1:]) in [(("=",), []), (("=", "<"), [full])]
