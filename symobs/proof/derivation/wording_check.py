"""Check that the relation in a sentence is the one its words state, not just a true one (trusted).

A pair of poles overshoots by exp(−π σ/ω), and by no other number below a bound; a pair is observable because the rank is
that of a matrix of full rank, and not because of 1 = 1.  Which sentence owes what is declared beside its words, in the
`DEMANDS` of `phrases`; what an obligation means is defined here, without a name of any phrase.  It is a name, with the
letters it is about, `observable C A` or of the dual `observable Bᵀ Aᵀ`; what it asserts of them is evaluated where the
sentence stands.
"""

from __future__ import annotations

from dataclasses import field, replace
from fractions import Fraction
from itertools import dropwhile, takewhile
from re import findall
from typing import TYPE_CHECKING, Any, TypeAlias

from symobs.exact import (
    EIGENVALUE,
    Ideal,
    Matrix,
    Scalar,
    companion,
    echelon,
    from_coefficients,
    independent_rows,
    rank,
    unit_rows,
)
from symobs.exact.algebraic.loop_distances import INFINITE, MARGIN_DIGITS, Loop
from symobs.exact.core.generators import PI, function
from symobs.exact.floating.riccati_check import Regulator, excess, is_proved
from symobs.exact.time_functions.matrix_power import modes_of
from symobs.formula.phrases import DEMANDS
from symobs.formula.phrases.languages import Counted, StateChoice
from symobs.formula.tree import (
    Apply,
    At,
    Block,
    Decimals,
    Derivative,
    Evaluated,
    Exact,
    Formula,
    HoldsExactlyWhere,
    Identity,
    Letter,
    Literal,
    Negative,
    Power,
    Predicate,
    Product,
    Quotient,
    Relation,
    Roots,
    Sum,
    SymbolList,
    Transpose,
    evaluate,
    letters,
)
from symobs.formula.tree.calculus import TIME
from symobs.formula.tree.plain_text import plain
from symobs.formula.tree.term import Term
from symobs.formula.tree.written import written, written_relation
from symobs.ground.dataclass import dataclass
from symobs.proof.certificate.claims import UNREADABLE, as_scalar, verify
from symobs.proof.certificate.pointwise import Pointwise
from symobs.proof.derivation.facts import PREDICATES, leading_minors, reject
from symobs.proof.derivation.steps import everything_in, literals
from symobs.stability.criteria.stability import on_boundary
from symobs.system.conditions import sign_of

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Mapping, Sequence

    from symobs.formula.tree import Environment, Fact
    from symobs.proof.derivation.steps import Sentence

_Slots: TypeAlias = "Mapping[str, Formula | Fact | Counted | StateChoice | str]"

#: The name under which it is remembered that stability is meant in the sense of Lyapunov from here on.
_WEAKER = "stable in the sense of Lyapunov"


@dataclass
class Said:
    """Where a sentence stands: the facts and relations of its step, and what fills its slots."""

    facts: Sequence[Fact]
    environment: Environment
    slots: _Slots = field(default_factory=dict)
    introduced: Relation | None = None

    def subjects(self, *names: str) -> list[Formula]:
        """Return what has one of these properties, or any, also what has it exactly where something holds."""
        facts = [fact.property if isinstance(fact, HoldsExactlyWhere) else fact for fact in self.of(*_PROPERTIES)]
        return [fact.subject for fact in facts if isinstance(fact, Predicate) and (not names or fact.name in names)]

    def of(self, *kinds: type) -> list[Any]:
        """Return the facts and the slots of some kinds."""
        return [part for part in (*self.facts, *self.slots.values()) if isinstance(part, kinds)]

    def holds(self, *texts: str, **slots: Any) -> bool:
        """Return whether relations written as text hold where the sentence stands."""
        return all(
            _is_shown_true(written_relation(text, self.environment, **slots), self.environment) for text in texts
        )

    def stack(self, row: str, of: str) -> Term:
        """Return the term of the observability matrix."""
        return Term(_stack(row, of, self.environment), self.environment)

    def told(self, slot: str) -> Term:
        """Return the term in a slot; raises TypeError where there is none."""
        found = self.slots[slot]
        if not isinstance(found, Formula):
            raise TypeError(slot)
        return Term(found, self.environment)

    def size(self, text: str) -> tuple[int, int]:
        """Return the rows and columns of a term; raises TypeError where it stands for no matrix."""
        return written(text, self.environment).value.shape  # type: ignore[no-any-return]


def _is_shown_true(relation: Relation, environment: Environment) -> bool:
    left, right = relation.members[0], relation.members[-1]
    return (relation.operators == ("=",) and left == right) or verify(relation, environment)[0] != ""


_PROPERTIES = (Predicate, HoldsExactlyWhere)


def _one_higher(value: Fraction) -> Fraction:
    """Return a positive number with its third digit one higher.  Raises ValueError for another number."""
    if value <= 0:
        raise ValueError(value)
    unit = Fraction(1)
    while value >= 1000 * unit:
        unit *= 10
    while value < 100 * unit:
        unit /= 10
    return value + unit


def _exponential(exponent: Callable[[Mapping[str, Any]], Scalar]) -> Callable[[Relation, Environment], bool]:
    """Return the check that a relation begins with e to this power, given by the values of the letters."""

    def is_said(relation: Relation, environment: Environment) -> bool:
        stated = evaluate(relation.members[0], environment, Exact(environment))
        return bool(stated == function("exp", exponent(environment.values)))

    return is_said


def _rank(*, is_full: bool, everywhere: bool = False) -> Callable[[Relation, Environment], bool]:
    """Return the check that a relation is of a rank that is full, or lower, and that it is the same everywhere."""

    def is_said(relation: Relation, environment: Environment) -> bool:
        if everywhere and not _is_everywhere(relation, environment):
            return False
        return _is_of_rank(relation, environment, is_full=is_full)

    return is_said


def _of_pair(**says: bool) -> Callable[..., bool]:
    """Return the check of a rank that is said of a pair: it is that of the pair's own test matrix."""
    is_such = _rank(**says)

    def is_said(relation: Relation, environment: Environment, row: str, of: str) -> bool:
        matrix, stack = _ranked(relation), _stack(row, of, environment)
        if matrix is None or not is_such(relation, environment):
            return False
        return _holds(environment, Transpose(matrix) if row.endswith("ᵀ") else matrix, "=", stack)

    return is_said


# -- what is asserted, in letters --------------------------------------------------------------------------------------


def _letter(text: str) -> Formula:
    """Return the formula of a letter, of its transpose, or of a difference of letters."""
    if "−" in text:
        first, second = text.split("−")
        return Sum((Letter(first), Negative(Letter(second))))
    return Transpose(Letter(text[:-1])) if text.endswith("ᵀ") else Letter(text)


def _number(value: int) -> Formula:
    return Literal(Scalar.of(value))


def _sizes(of: str, environment: Environment) -> tuple[int, int]:
    """Return the rows and columns of a letter; raises TypeError where it stands for no matrix."""
    return evaluate(_letter(of), environment, Exact(environment)).shape  # type: ignore[no-any-return]


def _holds(environment: Environment, left: Formula, operator: str, right: Formula) -> bool:
    same = operator == "=" and left == right
    return same or verify(Relation((left, right), (operator,)), environment)[0] != ""


def _vanishes(environment: Environment, formula: Formula) -> bool:
    return _holds(environment, formula, "=", Product((_number(0), formula)))


def _differs(environment: Environment, formula: Formula) -> bool:
    """Return whether a formula is not 0: nowhere, or where that cannot be seen not everywhere."""
    return _holds(environment, formula, "!==", Product((_number(0), formula)))


def _stack(row: str, of: str, environment: Environment) -> Formula:
    """Return [C; CA; …; CAⁿ⁻¹]; where A and C depend on time, each block is the last one times A plus its derivative."""
    first, A, order = _letter(row), _letter(of), _sizes(of, environment)[0]
    if environment.variable != TIME:
        powers = [A, *(Power(A, k) for k in range(2, order))][: order - 1]
        return Block(((first,), *((Product((first, power)),) for power in powers)))
    blocks = [first]
    while len(blocks) < order:
        blocks.append(Sum((Product((blocks[-1], A)), Derivative(blocks[-1]))))
    return Block(tuple((block,) for block in blocks))


def _is_observable(said: Said, row: str, of: str) -> bool:
    """Return whether the pair is observable for all parameters; where it varies, at almost every time."""
    here, stack = said.environment, _stack(row, of, said.environment)
    order = _sizes(of, here)[0]
    if here.variable == TIME:
        value = evaluate(stack, here, Exact(here))
        rows = independent_rows(value, Ideal.where(here.relations))
        return len(rows) == order and _differs(here, Apply("det", Literal(value.select(rows, range(order)))))
    rank_is = Relation((Apply("rank", stack), _number(order)), ("=",))
    return verify(rank_is, here)[0] != "" and _is_everywhere(rank_is, here)


def _is_unobservable(said: Said, row: str, of: str) -> bool:
    here = said.environment
    stack = evaluate(_stack(row, of, here), here, Exact(here))
    vectors = map(Literal, echelon(stack, Ideal.where(here.relations))[1])
    return any(_vanishes(here, Product((Literal(stack), vector))) and _differs(here, vector) for vector in vectors)


def _is_regular_at(relation: Relation, environment: Environment, row: str, of: str) -> bool:
    """Return whether a relation is that the determinant of the test matrix at an instant is not 0."""
    first, last = relation.members[0], relation.members[-1]
    matrix = first.argument if isinstance(first, Apply) and first.function == "det" else first
    if not isinstance(matrix, At) or matrix.name != TIME or (relation.operators[-1], last) != ("!=", _number(0)):
        return False
    return _holds(environment, matrix.operand, "=", _stack(row, of, environment))


def _characteristic(of: str, environment: Environment) -> Formula:
    """Return det(sI − A)."""
    unknown = Product((Letter("s"), Identity(_sizes(of, environment)[0])))
    return Apply("det", Sum((unknown, Negative(_letter(of)))))


def _is_part(said: Said, row: str, of: str, N: str, X: str) -> bool:
    """Return whether the columns of N are independent, C N = 0 and A N = N X: they span unobservable states."""
    return said.holds(f"rank({N}) = {said.size(N)[1]}", f"{row} {N} = 0", f"({of}) {N} = {N} {X}")


def _is_whole(said: Said, row: str, of: str, N: str, X: str) -> bool:
    """Return whether the columns of N are a basis of the unobservable subspace, on which A is X."""
    seen = said.size(N)[0] - said.size(N)[1]
    return _is_part(said, row, of, N, X) and said.holds(f"rank({{stack}}) = {seen}", stack=said.stack(row, of))


def _fixes(said: Said, row: str, of: str, N: str, X: str, phi: str) -> bool:
    """Return whether no gain moves the modes told, and what is said of the quotient of φ by their polynomial is said of it.

    A quotient that is a polynomial nowhere is φ's; one that is one nowhere but where a remainder vanishes is that of the
    remainder.
    """
    here, fixed, wanted = said.environment, _characteristic(X, said.environment), _letter(phi)
    told = [slot.polynomial for name, slot in said.slots.items() if isinstance(slot, Roots) and name != "missing"]
    told += [roots.polynomial for roots in said.facts if isinstance(roots, Roots)]
    told += [slot.formula for name, slot in said.slots.items() if name == "fixed" and isinstance(slot, Evaluated)]
    told += [slot.members[0] for slot in said.slots.values() if isinstance(slot, Relation)]
    rest = said.slots.get("rest")
    if isinstance(rest, Evaluated):
        whole = Quotient(Sum((wanted, Negative(rest.formula))), fixed)
        if not _is(here, "polynomial", whole):
            return False
        wanted = rest.formula
    return (
        _is_part(said, row, of, N, X)
        and all(_holds(here, polynomial, "=", fixed) for polynomial in told)
        and all(_holds(here, Product((subject, fixed)), "=", wanted) for subject in said.subjects())
    )


def _misses(said: Said, X: str, phi: str) -> bool:
    """Return whether the roots told as missing are eigenvalues of X, and none of them is a root of φ for any parameters."""
    here, told = said.environment, said.slots["missing"]
    if not isinstance(told, Roots):
        return False
    value = as_scalar(evaluate(told.polynomial, here, Exact(here)))
    factors = [Literal(f) for f, _ in value.numerator.factors()[1] if f.degree(here.variable)]
    is_part = _is(here, "polynomial", Quotient(_characteristic(X, here), told.polynomial))
    return is_part and all(_is(here, "not_polynomial", Quotient(_letter(phi), factor)) for factor in factors)


def _is(here: Environment, name: str, formula: Formula) -> bool:
    """Return whether a formula has a property, whatever the names of coefficients stand for."""
    value = as_scalar(evaluate(formula, here, Exact(here)))
    return PREDICATES[name](value, replace(here, coefficients={}), here.variable == "z")


def _are_modes(said: Said, row: str, of: str, *letters_of: str) -> bool:
    """Return whether the unobservable modes are the eigenvalues of X, and are those told."""
    here, told = said.environment, [roots.polynomial for roots in said.of(Roots)]
    return any(
        N in here.values
        and _is_whole(said, row, of, N, X)
        and all(_holds(here, polynomial, "=", _characteristic(X, here)) for polynomial in told)
        for N, X in zip(letters_of[::2], letters_of[1::2], strict=True)
    )


def _exhausts(said: Said, row: str, of: str, N: str, X: str, phi: str) -> bool:
    """Return whether φ is the polynomial of modes that no gain moves."""
    return _is_part(said, row, of, N, X) and said.holds(f"{phi} = det(pencil({X}))")


def _are_seen(said: Said, row: str, of: str, N: str, X: str) -> bool:
    """Return whether a property is said of the polynomial of all observable modes."""
    if N in said.environment.values:
        seen = written(f"det(pencil({of})) / det(pencil({X}))", said.environment).formula
        return _is_whole(said, row, of, N, X) and _are_about(said, seen)
    full = said.holds(f"rank({{stack}}) = {said.size(of)[0]}", stack=said.stack(row, of))
    return full and _are_about(said, _characteristic(of, said.environment))


def _are_stable(said: Said, row: str, of: str, N: str, X: str, mu: str) -> bool:
    """Return whether there are no unobservable modes, or all are stable, in the sense in which it is meant."""
    here = said.environment
    if N not in here.values:
        return _is_observable(said, row, of)
    told = said.subjects("stable")
    stable = any(_holds(here, subject, "=", _characteristic(X, here)) for subject in told)
    weaker = _WEAKER in here.values and Letter(mu) in said.subjects("marginal")
    return _is_whole(said, row, of, N, X) and (stable or (weaker and _is_bounded(said, X, mu)))


def _are_unstable(said: Said, row: str, of: str, N: str, X: str, mu: str) -> bool:
    """Return whether an unobservable mode is not stable, in the sense in which it is meant."""
    here, weaker = said.environment, _WEAKER in said.environment.values
    told = said.subjects("beyond" if weaker else "unstable")
    beyond = any(_holds(here, subject, "=", _characteristic(X, here)) for subject in told)
    return _is_part(said, row, of, N, X) and (beyond or (weaker and _is_chained(said, X, mu)))


def _is_bounded(said: Said, X: str, mu: str) -> bool:
    """Return whether μ(X) = 0, and all repeated roots of μ are stable: modes on the boundary are semisimple."""
    here = said.environment
    factors = as_scalar(here.values[mu]).numerator.factors()[1]
    repeated = [factor for factor, power in factors if power > 1 and factor.degree(here.variable)]
    stable = all(_is(here, "stable", Literal(factor)) for factor in repeated)
    return stable and _vanishes(here, Apply(f"{mu}_at", Letter(X)))


def _is_chained(said: Said, X: str, mu: str) -> bool:
    """Return whether μ(X) is not 0, though no root of χ/μ is stable: one of them is in a chain."""
    here, zero = said.environment, Product((_number(0), Letter(X)))
    left = as_scalar(evaluate(Quotient(_characteristic(X, here), Letter(mu)), here, Exact(here)))
    factors = [factor for factor, _ in left.numerator.factors()[1] if factor.degree(here.variable)]
    unstable = left.is_polynomial_in(here.variable) and all(_is(here, "unstable", Literal(f)) for f in factors)
    return unstable and _holds(here, Apply(f"{mu}_at", Letter(X)), "!=", zero)


def _are_unseen(said: Said, row: str, of: str, *, all_of_them: bool = False) -> bool:
    """Return whether the vectors on which products end, transposed those with which they begin, are unobservable."""
    here, products = said.environment, [fact.members[0] for fact in said.facts if isinstance(fact, Relation)]
    ends = [product.factors for product in products if isinstance(product, Product)]
    vectors = [
        first.operand if isinstance(first, Transpose) and isinstance(first.operand, Literal) else last
        for first, *_, last in ends
    ]
    stack = _stack(row, of, here)
    for vector in vectors:
        order, count = evaluate(vector, here, Exact(here)).shape
        ranks = [(vector, count), (stack, order - count)] if all_of_them else []
        whole = all(_holds(here, Apply("rank", matrix), "=", _number(value)) for matrix, value in ranks)
        if not (whole and _vanishes(here, Product((stack, vector))) and _differs(here, vector)):
            return False
    return 0 < len(ends) == len(products)


def _repairs(said: Said, row: str, of: str) -> bool:
    """Return whether the facts are, set by set, that the test matrix has full rank with these states measured too."""
    here, (choice,) = said.environment, said.of(StateChoice)
    order, A = _sizes(of, here)[0], _letter(of)
    for numbers, fact in zip(choice.sets, said.facts, strict=True):
        rows: Formula = Literal(unit_rows(order, tuple(number - 1 for number in numbers)))
        parts = [_stack(row, of, here), rows, *(Product((rows, Power(A, k))) for k in range(1, order))]
        wanted, matrix = Block(tuple((part,) for part in parts)), _ranked(fact) if isinstance(fact, Relation) else None
        if not isinstance(fact, Relation) or matrix is None or not _is_of_rank(fact, here, is_full=True):
            return False
        if not _holds(here, matrix, "=", wanted):
            return False
    return True


def _vanishes_of(said: Said, *names: str) -> bool:
    """Return whether the step has a product of these letters alone, the last one's columns independent, that is 0."""
    basis = _letter(names[-1] if names[-1] in said.environment.values else "N")
    here, relations = said.environment, said.of(Relation)
    products = [first for first in (relation.members[0] for relation in relations) if isinstance(first, Product)]
    wanted = {*names[:-1], *letters(basis)}
    found = [each for each in products if letters(each) == wanted and next(literals(each), None) is None]
    columns = Apply("rank", basis), _number(evaluate(basis, here, Exact(here)).shape[1])
    return any(_vanishes(here, each) for each in found) and _holds(here, columns[0], "=", columns[1])


def _annuls(said: Said, *names: str) -> bool:
    """Return whether a row times a matrix is 0, the row is not, nor is its product with the matrices that follow."""
    row, first, *others = names
    return said.holds(f"{row} ({first}) = 0", f"{row} !== 0", *(f"{row} ({other}) !== 0" for other in others))


def _is_lower_rank(said: Said, C: str, E: str) -> bool:
    """Return whether C E w = 0 and E w ≠ 0 are told: the kernel of C E is then larger than that of E."""
    unseen, differs = (relation.members[0] for relation in said.of(Relation))
    along = differs.factors if isinstance(differs, Product) else (differs,)
    names_them = unseen == Product((_letter(C), *along)) and along[0] == _letter(E)
    return names_them and _vanishes(said.environment, unseen) and _differs(said.environment, differs)


def _are_duals(said: Said, *pairs: str) -> bool:
    """Return whether one pair is (C, A), the other (B_dualᵀ, A_dualᵀ) up to the sign of A, and the ranks are theirs."""
    here, (row, of, other, by) = said.environment, pairs
    image, A = _letter(by), _letter(of)
    ranks = [_ranked(Relation((part,), ())) for slot in said.of(Relation) for part in slot.members[:2]]
    own = (
        Transpose(_stack(row, of, here)),
        _stack(row, of, here),
        Transpose(_stack(other, by, here)),
        _stack(other, by, here),
    )
    return (
        _holds(here, _letter(row), "=", _letter(other))
        and (_holds(here, image, "=", A) or _holds(here, image, "=", Negative(A)))
        and len(ranks) == 2
        and all(rank is not None and any(_holds(here, rank, "=", stack) for stack in own) for rank in ranks)
    )


def _sums(said: Said, letter: str, count: int | None = None) -> bool:
    """Return whether a letter is Σ (Aᵀ)ᵏ Cᵀ C Aᵏ, or that of the dual, over so many powers: all n where none is given."""
    return any(_is_sum(said, letter, row, of, count) for row, of in (("C", "A"), ("Bᵀ", "Aᵀ")))


def _is_sum(said: Said, letter: str, row: str, of: str, count: int | None = None) -> bool:
    if not {letter, row.rstrip("ᵀ")} <= said.environment.values.keys():
        return False
    powers = [row, *(f"({row} {of}^{k})" for k in range(1, said.size(of)[0] if count is None else count))]
    return said.holds(f"{letter} = " + " + ".join(f"{power}ᵀ {power}" for power in powers))


def _shares_kernel(said: Said, row: str, of: str) -> bool:
    """Return whether W has the kernel of M, the sum over n powers: as an integral, or as a sum over all steps.

    An integral over any time has it; a sum has it where it solves W − AᵀWA = CᵀC, and not over every number of steps.
    """
    is_sum = said.environment.variable == "z"
    return _is_sum(said, "M", row, of) and (not is_sum or said.holds(f"{of}ᵀ W {of} - W = -({row}ᵀ {row})"))


def _is_nonsingular(said: Said, letter: str) -> bool:
    return said.holds(f"det({letter}) != 0")


def _spans_kernel(said: Said) -> bool:
    """Return whether the columns of v (or N) are a basis of the kernel of W."""
    N = "v" if "v" in said.environment.values else "N"
    order, vectors = said.size(N)
    return said.holds(f"rank(W) = {order - vectors}", f"rank({N}) = {vectors}", f"W {N} = 0")


def _left_side(said: Said, of: str, P: str) -> str:
    """Return AᵀP + PA, in discrete time AᵀPA − P."""
    return f"{of}ᵀ {P} {of} - {P}" if said.environment.variable == "z" else f"{of}ᵀ {P} + {P} {of}"


def _reverses(here: Environment, letter: str, of: str) -> bool:
    """Return whether a polynomial has the coefficients of another in reverse order."""
    own, other = (as_scalar(here.values[name]) for name in (letter, of))
    coefficients = tuple(reversed(other.coefficients(here.variable)))
    return own == sum(
        (c * Scalar.symbol(here.variable) ** k for k, c in enumerate(reversed(coefficients))), Scalar.of(0)
    )


def _is_of_pairs(said: Said, of: str) -> bool:
    """Return whether what is told is det χ(−A), in discrete time det χ*(A)."""
    discrete, told = said.environment.variable == "z", said.of(Relation)
    image = written(f"det(chi_r_at({of}))" if discrete else f"det(chi_at(-{of}))", said.environment).formula
    known = said.holds(f"chi = det(pencil({of}))") and (not discrete or _reverses(said.environment, "chi_r", "chi"))
    return known and bool(told) and all(relation.members[0] == image for relation in told)


def _solves_homogeneous(said: Said, of: str, N: str) -> bool:
    """Return whether a symmetric matrix other than 0 solves Lyapunov's equation with 0 on the right."""
    return said.holds(f"{N} = {N}ᵀ", f"{_left_side(said, of, N)} = 0", f"{N} !== 0")


def _trace(said: Said, left: str, right: str) -> Scalar:
    """Return the trace of a product of two letters."""
    pair = (written(text, said.environment).value.entries for text in (f"{left}ᵀ", right))
    return sum((a * b for a, b in zip(*pair, strict=True)), Scalar.of(0))


def _refutes_lyapunov(said: Said, of: str, Q: str, X: str) -> bool:
    """Return whether X, symmetric, solves the transposed homogeneous equation and the trace told is that of Q X, and not 0."""
    adjoint = f"{of} {X} {of}ᵀ - {X} = 0" if said.environment.variable == "z" else f"{of} {X} + {X} {of}ᵀ = 0"
    slots = {"told": said.told("trace"), "trace": _trace(said, Q, X)}
    return said.holds(f"{Q} = {Q}ᵀ", f"{X} = {X}ᵀ", adjoint, "{told} = {trace}", "{trace} !== 0", **slots)


def _refutes_regulator(said: Said, *disturbs: str) -> bool:
    """Return whether U A + V C = S U, U B + V D = 0, and what is told is tr UE − tr VQ (tr VQ where E is 0), and not 0."""
    known = said.environment.values
    if not disturbs and "E_d" in known and said.holds("E_d !== 0"):
        return False
    trace = _trace(said, "V_r", "Q_r")
    trace = _trace(said, "U_r", *disturbs) - trace if disturbs else trace
    slots = {"told": said.told("trace"), "trace": trace}
    driven = "U_r B + V_r D = 0" if "D" in known else "U_r B = 0"
    return said.holds("U_r A + V_r C = S_w U_r", driven, "{told} = {trace}", "{trace} !== 0", **slots)


def _is_blocked(said: Said, of: str, *, everywhere: bool) -> bool:
    """Return whether [A − sI, B; C, D] has less than n + p independent rows at the roots told, eigenvalues of a matrix.

    Where that is not so for every s, these are zeros of the plant.
    """
    here, told, s = said.environment, said.slots["modes"], Scalar.symbol(said.environment.variable)
    A, B, C = (evaluate(Letter(name), here, Exact(here)) for name in "ABC")
    D = evaluate(Letter("D"), here, Exact(here)) if "D" in here.values else Matrix.zeros(C.shape[0], B.shape[1])
    full = A.shape[0] + C.shape[0]
    own = Matrix.block([[A - Matrix.identity(A.shape[0]) * s, B], [C, D]])
    shown = all(
        isinstance(slot := said.slots[name], Formula) and _holds(here, slot, "=", Literal(value))
        for name, value in (("pencil", own), ("size", Scalar.of(full)))
    )
    if not shown or not isinstance(told, Roots) or (everywhere == (rank(own, _ideal(here.relations)) == full)):
        return False
    polynomial = as_scalar(evaluate(told.polynomial, here, Exact(here)))
    eigenvalue = {here.variable: Scalar.symbol(EIGENVALUE)}
    there = own.substitute(eigenvalue)
    factors = [f.substitute(eigenvalue) for f, _ in polynomial.numerator.factors()[1] if here.variable in f.names]
    lost = all(rank(there, _ideal((*here.relations, factor))) < full for factor in factors)
    return bool(factors) and lost and _is(here, "polynomial", Quotient(_characteristic(of, here), told.polynomial))


def _ideal(relations: tuple[Scalar, ...]) -> Ideal | None:
    return Ideal.of(relations) if relations else None


def _has_margins(said: Said, closed: str, opened: str) -> bool:
    """Return whether angle, distance and peak are told of a stable loop as they round; no angle where there is none."""
    here, discrete = said.environment, said.environment.variable == "z"
    known = (as_scalar(evaluate(Letter(name), here, Exact(here))) for name in (closed, opened))
    parts = [[entry.fraction() for entry in value.coefficients(here.variable)] for value in known]
    loop = Loop.of(*parts, discrete=discrete)
    found = {"modulus": loop.modulus(MARGIN_DIGITS), "peak": loop.peak(MARGIN_DIGITS)}
    phase = loop.phase(MARGIN_DIGITS)
    found |= {} if phase == INFINITE else {"phase": phase}
    told = {name: slot.value for name, slot in said.slots.items() if isinstance(slot, Decimals)}
    right = {name: None if text is None else Scalar.of(Fraction(text)) for name, text in found.items()}
    return told == right and told.keys() == said.slots.keys() and _is(here, "stable", Letter(closed))


def _are_minors(said: Said, of: str) -> bool:
    """Return whether Δ₁, Δ₂, … are the leading principal minors of a matrix."""
    here, order = said.environment, _sizes(of, said.environment)[0]
    matrix = evaluate(Letter(of), here, Exact(here))
    parts = [matrix.select(range(k), range(k)) for k in range(1, order + 1)]
    names = [name for name in here.values if name.startswith("Delta_")]
    return len(names) == order and all(
        _holds(here, Letter(f"Delta_{k}"), "=", Apply("det", Literal(part))) for k, part in enumerate(parts, 1)
    )


def _is_lyapunov(said: Said, P: str, Q: str, of: str) -> bool:
    """Return whether P solves Lyapunov's equation, Q is said to be positive definite, and χ to be stable or not."""
    told = said.subjects("positive_definite"), said.subjects("stable", "unstable")
    solves = said.holds(f"{_left_side(said, of, P)} = -{Q}", f"chi = det(pencil({of}))")
    return solves and told == ([Letter(Q)], [Letter("chi")])


def _is_optimal(said: Said, of: str, by: str, Q: str, R: str, N: str, P: str, K: str, chi: str) -> bool:
    """Return whether P solves Riccati's equation, weights have their signs, and χ, said to be stable, is of the loop with K."""
    here, discrete = said.environment, said.environment.variable == "z"
    problem = Regulator(*(written(each, here).value for each in (of, by, Q, R, N)), discrete)  # type: ignore[call-arg]
    signs = {sign_of(c, here.signs) for c in (-problem.uncrossed[2]).characteristic_polynomial("s").coefficients("s")}
    definite = all(sign_of(minor, here.signs) == "positive" for minor in leading_minors(problem.R))
    inner = f"({R} + {by}ᵀ {P} {by})" if discrete else R
    coupled = f"{by}ᵀ {P} {of} + {N}ᵀ" if discrete else f"{by}ᵀ {P} + {N}ᵀ"
    solves = said.holds(f"{_left_side(said, of, P)} + {Q} = {K}ᵀ {inner} {K}", f"{P} = {P}ᵀ")
    loops = (
        said.holds(f"{inner} {gain} = {coupled}", f"{chi} = det(pencil({of}) + {by} {gain})")
        for gain in (K, f"(-{K})")  # minus the gain in the signs of some conventions: the result holds its own letter
    )
    known = definite and signs <= {"positive", "nonnegative", "zero"} and said.subjects("stable") == [Letter(chi)]
    return known and solves and any(loops)


def _encloses(said: Said, *names: str) -> bool:
    """Return whether P and K, or −K, are those of the stabilising solution, rounded to the decimal places told."""
    return any(_rounded_optima(said, _told_number(said, "radius"), names))


def _rounded_optima(said: Said, unit: Fraction, names: Sequence[str]) -> Iterator[tuple[Regulator, Matrix, Matrix]]:
    """Yield the problem with P and K or −K, where these are the solution, rounded to multiples of a power of ten."""
    here = said.environment
    *data, P, K = (evaluate(_letter(name), here, Exact(here)) for name in names)
    problem = Regulator(*data, here.variable == "z")  # type: ignore[call-arg]
    ends = str(1 / unit).strip("0") == "1" and not any(1 / unit % M.common_denominator().fraction() for M in (P, K))
    told = [[[(entry.fraction(), unit / 2) for entry in row] for row in M.rows] for M in (P, K, -K)]
    for gain, rows in zip((K, -K), told[1:], strict=True):
        if ends and is_proved(problem, P, unit, told[0], rows):
            yield problem, P, gain


def _told_number(said: Said, slot: str) -> Fraction:
    here = said.environment
    return as_scalar(evaluate(said.slots[slot], here, Exact(here))).fraction()  # type: ignore[arg-type]


def _exceeds(said: Said, *names: str) -> bool:
    """Return whether the bound told is the smallest power of ten found for the cost of K, or −K, rounded as told."""
    unit, told = _told_number(said, "radius"), _told_number(said, "bound")
    return any(excess(problem, P, gain, unit) == told for problem, P, gain in _rounded_optima(said, unit, names))


def _splits(said: Said, even: str, of: str) -> bool:
    """Return whether a polynomial is that of the stable monic p times its mirror image, up to a number."""
    here, v = said.environment, said.environment.variable
    whole, p = (as_scalar(here.values[name]) for name in (even, of))
    s, is_monic = Scalar.symbol(v), p.coefficients(v)[0].is_one
    product = p * (p.substitute({v: 1 / s}) * s ** p.degree(v) if v == "z" else p.substitute({v: -s}))
    number = whole.coefficients(v)[0] / product.coefficients(v)[0]
    same = _holds(here, Letter(even), "=", Literal(number * product))
    return is_monic and same and _is(here, "stable", Letter(of))


def _is_on_boundary(said: Said, row: str, of: str, N: str, X: str) -> bool:
    """Return whether N is hidden, and the eigenvalues of X lie on the boundary."""
    here, v = said.environment, said.environment.variable
    factors = as_scalar(evaluate(_characteristic(X, here), here, Exact(here))).numerator.factors()[1]
    on = [on_boundary(factor, v, here.signs, discrete=v == "z") for factor, _ in factors if factor.degree(v)]
    return _is_part(said, row, of, N, X) and bool(on) and all(on)


def _has_rank(said: Said, *, is_full: bool) -> bool:
    return any(
        _is_of_rank(fact, said.environment, is_full=is_full) for fact in said.facts if isinstance(fact, Relation)
    )


def _are_about(said: Said, formula: Formula, *names: str) -> bool:
    """Return whether all properties with these names are said of a formula, and there are some."""
    found = said.subjects(*names)
    return bool(found) and all(_holds(said.environment, subject, "=", formula) for subject in found)


def _is_of_loop(said: Said, name: str) -> bool:
    """Return whether a property of the loop's polynomial φ_c φ_o is among the facts."""
    here, loop = said.environment, Product((Letter("phi_c"), Letter("phi_o")))
    return any(_holds(here, subject, "=", loop) for subject in said.subjects(name))


def _is_shown(said: Said) -> bool:
    """Return whether the properties, or roots, are of a polynomial that was displayed, or spoken of, last before."""
    last = [member for fact in said.environment.shown if isinstance(fact, Relation) for member in fact.members]
    about = [*said.subjects(), *(told.polynomial for told in said.of(Roots))]
    return bool(about) and all(subject in last for subject in about)


def _is_test(said: Said, row: str, of: str) -> bool:
    """Return whether what is introduced or shown first is the test matrix of the pair."""
    first = [said.introduced, *said.of(Relation)]
    shown = next(relation.members[0] for relation in first if relation is not None)
    return _holds(
        said.environment, Transpose(shown) if row.endswith("ᵀ") else shown, "=", _stack(row, of, said.environment)
    )


def _is_exact(said: Said, row: str, of: str, N: str, X: str) -> bool:
    """Return whether it was said last where the polynomial of the unobservable modes, all of them, is stable."""
    here = said.environment
    fixed = _characteristic(X, here)
    found = [fact.property.subject for fact in here.shown if isinstance(fact, HoldsExactlyWhere)]
    return bool(found) and _is_whole(said, row, of, N, X) and all(_holds(here, each, "=", fixed) for each in found)


def _has_freedom(said: Said, row: str, of: str) -> int:
    """Return of what dimension the gains are that place the same poles: n p, less the rank of the test matrix."""
    here = said.environment
    outputs, order = _sizes(row, here)
    stack = evaluate(_stack(row, of, here), here, Exact(here))
    return outputs * order - len(echelon(stack, Ideal.where(here.relations))[0])


def _counts_free(said: Said, row: str, of: str) -> bool:
    """Return whether r(p − 1) parameters are said to be free and (n − r)p entries, r the rank of the test matrix."""
    outputs, order = _sizes(row, said.environment)
    seen = outputs * order - _has_freedom(said, row, of)
    told = Counted("free_parameter", seen * (outputs - 1)), Counted("free_entry", (order - seen) * outputs)
    return (said.slots["free"], said.slots["rest"]) == told


def _is_of_low_rank(said: Said) -> bool:
    """Return whether the rank told is that of the matrix whose kernel, or left kernel, a vector is shown to be in."""
    rank_of = said.slots["rank"]
    matrix = rank_of.formula.argument if isinstance(rank_of, Evaluated) and isinstance(rank_of.formula, Apply) else None
    shown = [fact.members[0] for fact in said.facts if isinstance(fact, Relation)]
    return matrix is not None and all(isinstance(each, Product) and matrix in each.factors for each in shown)


def _is_canonical(said: Said) -> bool:
    """Return whether (A, B) is in controllable canonical form."""
    A, B = (evaluate(Letter(name), said.environment, Exact(said.environment)) for name in "AB")
    order, variable = A.shape[0], said.environment.variable
    chi = A.characteristic_polynomial(variable).coefficients(variable)
    return bool(companion(chi[1:]) == A and Matrix.unit(order, order - 1) == B)


def _has_no_gain(said: Said) -> bool:
    """Return whether what has to vanish, or 1, lies in the ideal of det(sI − A + LC) − φ, with zeros at the places of L."""
    places = [tuple(int(part) - 1 for part in pair) for pair in findall(r"\((\d+), (\d+)\)", str(said.slots["places"]))]
    value = said.slots.get("when", _number(1))
    return isinstance(value, Formula) and any(
        {row.rstrip("ᵀ"), phi} <= said.environment.values.keys() and _lacks_gain(said, value, row, of, phi, places)
        for row, of, phi in (("C", "A", "phi_o"), ("Bᵀ", "Aᵀ", "phi_c"))
    )


def _lacks_gain(said: Said, value: Formula, row: str, of: str, phi: str, places: list[tuple[int, ...]]) -> bool:
    here, variable = said.environment, said.environment.variable
    A, C, wanted = (evaluate(_letter(name), here, Exact(here)) for name in (of, row, phi))
    empty = {place[::-1] if row.endswith("ᵀ") else place for place in places}
    rows = [
        [Scalar.of(0) if (i, j) in empty else Scalar.symbol(f"_l{i}_{j}") for j in range(C.shape[0])]
        for i in range(A.shape[0])
    ]
    chi = (A - Matrix.of(rows, C.shape[0]) @ C).normal().characteristic_polynomial(variable)
    return _holds(here.with_relations((chi - wanted).coefficients(variable)), value, "=", _number(0))


def _is_defective(said: Said) -> bool:
    """Return whether a pole of φ_c is met more often than a matrix X lacks in rank, φ_c(s + pole) being det(sI − X)."""
    ranked = [_ranked(fact) for fact in said.facts if isinstance(fact, Relation)]
    matrices = [formula for formula in ranked if formula is not None]
    poles = [root.centre for told in said.of(Roots) for root in told.values]
    environment = said.environment
    if len(matrices) != 1 or len(poles) != 1 or "phi_c" not in environment.values:
        return False
    (matrix,), (pole,), variable = matrices, poles, environment.variable
    X, phi = (evaluate(formula, environment, Exact(environment)) for formula in (matrix, Letter("phi_c")))
    polynomial = phi.substitute({variable: Scalar.symbol(variable) + pole})
    if X.characteristic_polynomial(variable) != polynomial:
        return False
    times = sum(1 for _ in takewhile(lambda c: c.is_zero, reversed(polynomial.coefficients(variable))))
    lacking: int = polynomial.degree(variable) - rank(X)
    told = tuple(said.slots[name] for name in ("mode", "times"))
    return lacking < times and told == tuple(map(Literal, modes_of_double(pole, variable)))


def modes_of_double(pole: Scalar, variable: str) -> tuple[Scalar, Scalar]:
    """Return e^{λt} and t e^{λt}, in discrete time λᵏ and k λᵏ."""
    if variable == "z":
        first, second = modes_of((Scalar.symbol("z") - pole) ** 2, "z")
        return first, second
    mode = function("exp", pole * Scalar.symbol(TIME))
    return mode, Scalar.symbol(TIME) * mode


def _is_of_damping(said: Said) -> bool:
    """Return whether the factor s² + 2ζω s + ω² is there, of the damping ratio and the frequency told."""
    damping, frequency, s = said.slots["damping"], said.slots["frequency"], Letter("s")
    if not isinstance(damping, Formula) or not isinstance(frequency, Formula):
        return False
    pair = Sum((Power(s, 2), Product((_number(2), damping, frequency, s)), Power(frequency, 2)))
    return pair in everything_in(said.slots["pair"])


def _shares_roots(said: Said, of: str, phi: str) -> bool:
    """Return whether the polynomials of the roots told divide φ and det(sI − A)."""
    here, both = said.environment, (_letter(phi), _characteristic(of, said.environment))
    return all(_is(here, "polynomial", Quotient(each, told.polynomial)) for told in said.of(Roots) for each in both)


def _ranked(relation: Relation) -> Formula | None:
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
    matrix, others = _ranked(relation), relation.members[1:]
    if matrix is None:
        return False
    full = min(evaluate(matrix, environment, Exact(environment)).shape)
    ranks = [as_scalar(evaluate(member, environment, Exact(environment))).fraction() for member in others]
    if is_full:
        return relation.operators == ("=",) and ranks == [full]
    if relation.operators == ("<",):
        return ranks == [full]
    return ranks[0] < full and (relation.operators, ranks[1:]) in [(("=",), []), (("=", "<"), [full])]


def _degree(relation: Relation | None, environment: Environment) -> int | None:
    """Return the degree of the polynomial that a definition introduces, None where there is no such."""
    if relation is None:
        return None
    value = as_scalar(evaluate(relation.members[0], environment, Exact(environment)))
    return len(value.coefficients(environment.variable)) - 1


def _counts_degree(said: Said) -> bool:
    return said.slots["count"] == Counted("number", _degree(said.introduced, said.environment) or 0)


def _counts_dominant(said: Said) -> bool:
    """Return whether beside the pair −σ ± iω the nearest root has the real part −factor σ."""
    factor, relation, environment = said.slots["factor"], said.introduced, said.environment
    if not _counts_degree(said) or relation is None or not isinstance(factor, Counted):
        return False
    whole = as_scalar(evaluate(relation.members[0], environment, Exact(environment)))
    sigma, omega = (as_scalar(environment.values[name]) for name in ("sigma_d", "omega_d"))
    s = Scalar.symbol(environment.variable)
    others = whole / ((s + sigma) * (s + sigma) + omega * omega)
    moved = others.substitute({environment.variable: s - sigma * factor.count}).coefficients(environment.variable)
    left = tuple(reversed([*dropwhile(lambda c: c.is_zero, reversed(moved))]))
    is_stable = PREDICATES["stable"](from_coefficients(left, environment.variable), environment, False)  # noqa: FBT003
    return factor == Counted("number", factor.count) and len(left) < len(moved) and is_stable


def _counts_names(said: Said) -> bool:
    names = said.slots["names"]
    return isinstance(names, SymbolList) and said.slots["vary"] == Counted("varies", len(names.names))


def _counts_steps(said: Said) -> bool:
    steps = said.slots["steps"]
    return isinstance(steps, Counted) and steps == Counted("step", steps.count) and _sums(said, "W", steps.count)


def _substitutes_law(said: Said) -> bool:
    """Return whether the slots are equations for the input and for the rate of the estimate."""
    firsts = [slot.members[0] for slot in (said.slots["law"], said.slots["rate"]) if isinstance(slot, Relation)]
    return firsts == [Letter("u"), Derivative(Letter("x_hat"))]


#: What every slot of a sentence must be: a relation of which this is true.
_OF_SLOTS: dict[str, Callable[..., bool]] = {
    "says_rank_full": _rank(is_full=True),
    "says_rank_low": _rank(is_full=False),
    "says_observable": _of_pair(is_full=True),
    "says_observable_everywhere": _of_pair(is_full=True, everywhere=True),
    "says_unobservable": _of_pair(is_full=False),
    "says_unobservable_everywhere": _of_pair(is_full=False, everywhere=True),
    "says_regular_at": _is_regular_at,
    "says_decay": _exponential(lambda of: -of["sigma_d"] * of["T_s"]),
    "says_overshoot": _exponential(lambda of: -Scalar.symbol(PI) * of["sigma_d"] / of["omega_d"]),
    "says_overshoot_above": _exponential(
        lambda of: -Scalar.symbol(PI) / _one_higher((of["omega_d"] / of["sigma_d"]).fraction())
    ),
}

#: What must be so where a sentence stands, of its facts, its slots and the letters that the obligation names.
_OF_STEP: dict[str, Callable[..., bool]] = {
    "observable": _is_observable,
    "unobservable": _is_unobservable,
    "unseen": _are_unseen,
    "spans_unseen": lambda said, *names: _are_unseen(said, *names, all_of_them=True),
    "repairs": _repairs,
    "modes": _are_modes,
    "exhausts": _exhausts,
    "seen": _are_seen,
    "bounded": _is_bounded,
    "chained": _is_chained,
    "modes_stable": _are_stable,
    "modes_unstable": _are_unstable,
    "fixes": _fixes,
    "eigenvalues_of": lambda said, of: all(
        _holds(said.environment, told.polynomial, "=", _characteristic(of, said.environment)) for told in said.of(Roots)
    ),
    "spectrum": lambda said, of: _are_about(said, _characteristic(of, said.environment)),
    "about": lambda said, letter, *names: _are_about(said, Letter(letter), *names),
    "zero": lambda said, *names: any(
        name in said.environment.values and _vanishes(said.environment, Letter(name)) for name in names
    ),
    "is_characteristic": lambda said, letter, of: _holds(
        said.environment, Letter(letter), "=", _characteristic(of, said.environment)
    ),
    "reverses": lambda said, letter, of: _reverses(said.environment, letter, of),
    "of_pairs": _is_of_pairs,
    "ends": lambda said, operator: all(
        (told.operators[-1], told.members[-1]) == (operator, _number(0)) for told in said.of(Relation)
    ),
    "solves": lambda said, M, x, b: _holds(said.environment, Product((Letter(M), Letter(x))), "=", Letter(b)),
    "solves_homogeneous": _solves_homogeneous,
    "refutes_lyapunov": _refutes_lyapunov,
    "refutes_regulator": _refutes_regulator,
    "blocked": lambda said, of: _is_blocked(said, of, everywhere=True),
    "blocked_there": lambda said, of: _is_blocked(said, of, everywhere=False),
    "has_margins": _has_margins,
    "minors": _are_minors,
    "solves_lyapunov": _is_lyapunov,
    "optimal": _is_optimal,
    "encloses": _encloses,
    "exceeds": _exceeds,
    "splits": _splits,
    "on_boundary": _is_on_boundary,
    "vanishes": _vanishes_of,
    "annuls": _annuls,
    "one_rank": lambda said, C, E: _holds(
        said.environment, Apply("rank", Product((_letter(C), _letter(E)))), "=", Apply("rank", _letter(E))
    ),
    "lower_rank": _is_lower_rank,
    "nonsingular": _is_nonsingular,
    "duals": _are_duals,
    "sums_powers": lambda said: _sums(said, "M"),
    "shares_kernel": _shares_kernel,
    "spans_kernel": _spans_kernel,
    "needs_rank_full": lambda said: _has_rank(said, is_full=True),
    "loop": _is_of_loop,
    "shown": _is_shown,
    "exactly": _is_exact,
    "canonical": _is_canonical,
    "no_gain": _has_no_gain,
    "not_unique": lambda said, row, of: _has_freedom(said, row, of) > 0,
    "dimension": lambda said, row, of: said.slots["count"] == str(_has_freedom(said, row, of)),
    "single": lambda said, row: _sizes(row, said.environment)[0] == 1,
    "poles_of": lambda said, letter: all(
        formula == Letter(letter)
        for formula in (*(told.polynomial for told in said.of(Roots)), *(r.members[0] for r in said.of(Relation)))
    ),
    "no_effect": lambda said, C, A, B: _vanishes(
        said.environment, Product((_stack(C, A, said.environment), Letter(B)))
    ),
    "no_feedthrough": lambda said: "D" not in said.environment.values or _vanishes(said.environment, Letter("D")),
    "is": lambda said, left, right: _holds(said.environment, _letter(left), "=", _letter(right)),
    "is_negative": lambda said, left, right: _holds(said.environment, _letter(left), "=", Negative(_letter(right))),
    "is_constant": lambda said, letter: (
        as_scalar(said.environment.values[letter]).degree(said.environment.variable) == 0
    ),
    "tests": _is_test,
    "finding": lambda _: False,  # of a table or a region: it is said below one, where the check finds it itself
    "continuous_time": lambda said: said.environment.variable != "z",
    "discrete_time": lambda said: said.environment.variable == "z",
    "zeros_of": lambda said, letter: all(
        formula == Power(Letter(letter), -1) for formula in (*said.subjects(), *(t.polynomial for t in said.of(Roots)))
    ),
    "pole_defective": _is_defective,
    "of_damping": _is_of_damping,
    "of_low_rank": _is_of_low_rank,
    "free_parts": _counts_free,
    "misses": _misses,
    "shared_roots": _shares_roots,
    "counts_degree": _counts_degree,
    "counts_dominant": _counts_dominant,
    "counts_names": _counts_names,
    "counts_steps": _counts_steps,
    "substitutes_law": _substitutes_law,
    "introduces_degree_one": lambda said: _degree(said.introduced, said.environment) == 1,
}

#: Sentences that set the limit to which a boundary is moved, or what stability means, and the name of what is remembered.
_SETS = {"sets_margin": "sought margin", "sets_radius": "sought radius", "sets_meaning": _WEAKER}

#: What the definition in which a sentence stands must apply: the slot, and the limit that it must move the boundary to.
_APPLIES: dict[str, tuple[str, str]] = {
    "moves_by_margin": ("by", "sought margin"),
    "scales_by_radius": ("by", "sought radius"),
    "applies_image": ("image", ""),
}

#: Every obligation that a phrase may declare in its `DEMANDS`, several of them parted by commas.
OBLIGATIONS = frozenset({*_OF_SLOTS, *_OF_STEP, *_SETS, *_APPLIES, "promises_cases", "leaves_undecided"})


def obligations(demanded: str) -> list[list[str]]:
    """Return the names of obligations, each with its letters."""
    return [each.split() for each in demanded.split(",") if each]


def require_known(demands: Mapping[str, str]) -> None:
    """Refuse obligations that nothing here checks; raises ValueError naming the phrases."""
    unknown = {
        key: each for key, each in demands.items() if not OBLIGATIONS.issuperset(n for n, *_ in obligations(each))
    }
    if unknown:
        message = f"no check is known for what these phrases demand: {unknown}; write it in {__name__}"
        raise ValueError(message)


require_known(DEMANDS)


def demands(key: str, name: str) -> bool:
    """Return whether a phrase has an obligation."""
    return [name] in obligations(DEMANDS.get(key, ""))


def _owed(key: str, table: Mapping[str, Any]) -> list[tuple[Any, list[str]]]:
    """Return what a table has for the obligations of a phrase, with their letters."""
    return [(table[name], names) for name, *names in obligations(DEMANDS.get(key, "")) if name in table]


def fits(key: str, relation: object, environment: Environment) -> bool:
    """Return whether the true relation of a sentence is the one its words state."""
    owed = _owed(key, _OF_SLOTS)
    return not owed or (isinstance(relation, Relation) and _are_met(owed, relation, environment))


def rests(key: str, said: Said) -> bool:
    """Return whether what a sentence asserts is so where it stands."""
    return _are_met(_owed(key, _OF_STEP), said)


def _are_met(owed: list[tuple[Any, list[str]]], *where: object) -> bool:
    """Return whether obligations are met; one that cannot be evaluated is not."""
    try:
        return all(is_met(*where, *names) for is_met, names in owed)
    except UNREADABLE:
        return False


def with_limit(sentence: Sentence, environment: Environment) -> Environment:
    """Remember the limit that a sentence sets, or that stability is meant otherwise from here on."""
    for name, _ in _owed(sentence.key, _SETS):
        limit = formula_in(sentence, "limit") if name != _WEAKER else _number(1)
        environment = environment.extended_by(values={name: evaluate(limit, environment, Exact(environment))})
    return environment


def reject_other_map(sentence: Sentence, relation: Relation | None, environment: Environment) -> None:
    """Reject a map that the definition does not apply, or that does not move the boundary to the limit set."""
    for (slot, limit), _ in _owed(sentence.key, _APPLIES):
        mapping = formula_in(sentence, slot)
        is_there = relation is not None and any(mapping in everything_in(member) for member in relation.members)
        if not is_there or (limit and not _moves_to(limit, mapping, environment)):
            reject(f"{sentence.key} by {plain(mapping, environment.variable)}")


def _moves_to(limit: str, mapping: Formula, environment: Environment) -> bool:
    """Return whether this is the limit remembered: a radius itself, a margin as the shift that takes it away."""
    wanted = environment.values.get(limit)
    moved = Negative(mapping) if limit == "sought margin" else mapping
    return wanted is not None and wanted == evaluate(moved, environment, Exact(environment))


def formula_in(sentence: Sentence, name: str) -> Formula:
    """Return the formula in a slot; rejects what is none."""
    found = dict(sentence.slots)[name]
    if not isinstance(found, Formula):
        reject(f"{found} in a sentence, where a formula stands,")
    return found
