"""Check that the relation in a sentence is the one its words state, not just a true one (trusted).

A pair of poles overshoots by exp(−π σ/ω), and by no other number below a bound; a pair is observable because the rank is
that of a matrix of full rank, and not because of 1 = 1.  Which sentence owes what is declared beside its words, in the
`DEMANDS` of `phrases`; what an obligation means is defined here, without a name of any phrase.
"""

from __future__ import annotations

from fractions import Fraction
from itertools import dropwhile, takewhile
from typing import TYPE_CHECKING, Any, TypeAlias

from symobs.exact import Matrix, Scalar, from_coefficients, rank, unit_rows
from symobs.exact.core.generators import PI, function
from symobs.formula.phrases import DEMANDS
from symobs.formula.phrases.spoken import Counted
from symobs.formula.tree import (
    Apply,
    Block,
    Derivative,
    Exact,
    Formula,
    Letter,
    Literal,
    Negative,
    Predicate,
    Product,
    Relation,
    Roots,
    SymbolList,
    agree,
    evaluate,
)
from symobs.formula.tree.plain_text import plain
from symobs.proof.certificate.claims import as_scalar, verify
from symobs.proof.certificate.pointwise import Pointwise
from symobs.proof.derivation.facts.properties import PREDICATES
from symobs.proof.derivation.facts.rejection import reject
from symobs.proof.derivation.steps import everything_in

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    from symobs.formula.phrases.spoken import StateChoice
    from symobs.formula.tree import Environment, Fact
    from symobs.proof.derivation.steps import Sentence

_Slots: TypeAlias = "Mapping[str, Formula | Fact | Counted | StateChoice | str]"


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


def _of_pair(letter: str, **says: bool) -> Callable[[Relation, Environment], bool]:
    """Return the check of a rank that is said of a pair: it is that of the pair's own test matrix."""
    is_such = _rank(**says)

    def is_said(relation: Relation, environment: Environment) -> bool:
        return is_such(relation, environment) and _is_test_matrix(letter, relation, environment)

    return is_said


def _is_test_matrix(letter: str, relation: Relation, environment: Environment) -> bool:
    """Return whether the matrix whose rank is said is [C; CA; …; CAⁿ⁻¹], or [B, AB, …, Aⁿ⁻¹B]."""
    matrix, pair = _ranked(relation), _pair(letter, environment)
    if matrix is None or pair is None:
        return False
    A, C = pair
    found = evaluate(matrix, environment, Exact(environment))
    X = found if letter == "C" else found.T
    outputs, order = C.shape
    if X.shape != (outputs * order, order):
        return False
    first, above, below = (X.select(rows, range(order)) for rows in _blocks(outputs, outputs * order))
    return _equal(first, C, environment) and _equal(below, above @ A, environment)


def _blocks(size: int, height: int) -> tuple[range, range, range]:
    """Return the rows of the first block, of all blocks but the last, and of all but the first."""
    return range(size), range(height - size), range(size, height)


def _matrix(letter: str, environment: Environment) -> Matrix | None:
    """Return the matrix that a letter stands for, None where it is not established or a number."""
    value = environment.values.get(letter)
    return value if isinstance(value, Matrix) else None


def _pair(letter: str, environment: Environment) -> tuple[Matrix, Matrix] | None:
    """Return (A, C), or (Aᵀ, Bᵀ), where its letters are established."""
    A, other = _matrix("A", environment), _matrix(letter, environment)
    if A is None or other is None:
        return None
    return (A, other) if letter == "C" else (A.T, other.T)


def _sums_powers(letter: str, environment: Environment) -> bool:
    """Return whether M = Σ (Aᵀ)ᵏ Cᵀ C Aᵏ with all n powers, as its theorem demands."""
    pair, M = _pair(letter, environment), _matrix("M", environment)
    if pair is None or M is None:
        return False
    A, row = pair
    total = row.T @ row
    for _ in range(A.shape[0] - 1):
        row = row @ A
        total = total + row.T @ row
    return _equal(M, total, environment)


def _shares_kernel(letter: str, environment: Environment) -> bool:
    """Return whether W has the kernel of M, the sum over n powers: as an integral, or as a sum over all steps.

    An integral over any time has it; a sum has it where it solves W − AᵀWA = CᵀC, and not over every number of steps.
    """
    pair, W = _pair(letter, environment), _matrix("W", environment)
    if pair is None or not _sums_powers(letter, environment):
        return False
    A, C = pair
    return environment.variable != "z" or (W is not None and _equal(A.T @ W @ A - W, -(C.T @ C), environment))


def _is_nonsingular(environment: Environment) -> bool:
    """Return whether det W ≠ 0 here."""
    letter = Letter("W")
    return "W" in environment.values and _is_true(Apply("det", letter), "!=", 0, environment)


def _spans_kernel(environment: Environment) -> bool:
    """Return whether the columns of v (or N) are a basis of the kernel of W."""
    W, N = _matrix("W", environment), _matrix("v" if "v" in environment.values else "N", environment)
    if W is None or N is None:
        return False
    order, vectors = N.shape
    return (
        _equal(W @ N, N * 0, environment)
        and _is_true(Apply("rank", Literal(N)), "=", vectors, environment)
        and _is_true(Apply("rank", Letter("W")), "=", order - vectors, environment)
    )


def _equal(left: Matrix, right: Matrix, environment: Environment) -> bool:
    """Return whether two matrices are equal, if need be modulo what is known here."""
    if agree(left, right, Exact(environment)):
        return True
    return (
        bool(environment.relations) and verify(Relation((Literal(left), Literal(right)), ("=",)), environment)[0] != ""
    )


def _is_true(formula: Formula, operator: str, value: int, environment: Environment) -> bool:
    return verify(Relation((formula, Literal(Scalar.of(value))), (operator,)), environment)[0] != ""


def _properties(facts: Sequence[Fact]) -> set[str]:
    return {fact.name for fact in facts if isinstance(fact, Predicate)}


def _has_rank(facts: Sequence[Fact], environment: Environment, *, is_full: bool) -> bool:
    return any(_is_of_rank(fact, environment, is_full=is_full) for fact in facts if isinstance(fact, Relation))


def _has_test_rank(letter: str, facts: Sequence[Fact], environment: Environment, *, is_full: bool = True) -> bool:
    is_said = _of_pair(letter, is_full=is_full)
    return any(is_said(fact, environment) for fact in facts if isinstance(fact, Relation))


def _is_of_loop(fact: Predicate, environment: Environment) -> bool:
    """Return whether a predicate is the stability of the loop's polynomial φ_c φ_o."""
    if fact.name != "stable" or not {"phi_c", "phi_o"} <= environment.values.keys():
        return False
    exact, loop = Exact(environment), Product((Letter("phi_c"), Letter("phi_o")))
    return agree(evaluate(fact.subject, environment, exact), evaluate(loop, environment, exact), exact)


def _is_defective(facts: Sequence[Fact], environment: Environment) -> bool:
    """Return whether a pole of φ_c is met more often than a matrix X lacks in rank, φ_c(s + pole) being det(sI − X)."""
    ranked = [_ranked(fact) for fact in facts if isinstance(fact, Relation)]
    matrices = [formula for formula in ranked if formula is not None]
    poles = [root.centre for fact in facts if isinstance(fact, Roots) for root in fact.values]
    if len(matrices) != 1 or len(poles) != 1 or "phi_c" not in environment.values:
        return False
    (matrix,), (pole,), variable = matrices, poles, environment.variable
    X, phi = (evaluate(formula, environment, Exact(environment)) for formula in (matrix, Letter("phi_c")))
    polynomial = phi.substitute({variable: Scalar.symbol(variable) + pole})
    if X.characteristic_polynomial(variable) != polynomial:
        return False
    times = sum(1 for _ in takewhile(lambda c: c.is_zero, reversed(polynomial.coefficients(variable))))
    lacking: int = polynomial.degree(variable) - rank(X)
    return lacking < times


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


#: What every slot of a sentence must be: a relation of which this is true.
_OF_SLOTS: dict[str, Callable[[Relation, Environment], bool]] = {
    "says_rank_full": _rank(is_full=True),
    "says_rank_low": _rank(is_full=False),
    "says_observable": _of_pair("C", is_full=True),
    "says_controllable": _of_pair("B", is_full=True),
    "says_unobservable": _of_pair("C", is_full=False),
    "says_uncontrollable": _of_pair("B", is_full=False),
    "says_unobservable_everywhere": _of_pair("C", is_full=False, everywhere=True),
    "says_uncontrollable_everywhere": _of_pair("B", is_full=False, everywhere=True),
    "says_decay": _exponential(lambda of: -of["sigma_d"] * of["T_s"]),
    "says_overshoot": _exponential(lambda of: -Scalar.symbol(PI) * of["sigma_d"] / of["omega_d"]),
    "says_overshoot_above": _exponential(
        lambda of: -Scalar.symbol(PI) / _one_higher((of["omega_d"] / of["sigma_d"]).fraction())
    ),
}

#: What must be among the facts of the step in which a sentence stands.
_OF_FACTS: dict[str, Callable[[Sequence[Fact], Environment], bool]] = {
    "needs_rank_full": lambda facts, environment: _has_rank(facts, environment, is_full=True),
    "needs_unobservable": lambda facts, environment: _has_test_rank("C", facts, environment, is_full=False),
    "needs_uncontrollable": lambda facts, environment: _has_test_rank("B", facts, environment, is_full=False),
    "needs_observable": lambda facts, environment: _has_test_rank("C", facts, environment),
    "needs_controllable": lambda facts, environment: _has_test_rank("B", facts, environment),
    "sums_powers": lambda _, environment: any(_sums_powers(letter, environment) for letter in ("C", "B")),
    "shares_kernel_observability": lambda _, environment: _shares_kernel("C", environment),
    "shares_kernel_controllability": lambda _, environment: _shares_kernel("B", environment),
    "needs_nonsingular": lambda _, environment: _is_nonsingular(environment),
    "spans_kernel": lambda _, environment: _spans_kernel(environment),
    "needs_modes_stable": lambda facts, environment: (
        bool(_properties(facts) & {"stable", "marginal"}) or _has_rank(facts, environment, is_full=True)
    ),
    "needs_modes_unstable": lambda facts, _: "unstable" in _properties(facts),
    "needs_loop_stable": lambda facts, environment: any(
        _is_of_loop(fact, environment) for fact in facts if isinstance(fact, Predicate)
    ),
    "needs_pole_defective": _is_defective,
}


def _degree(relation: Relation | None, environment: Environment) -> int | None:
    """Return the degree of the polynomial that a definition introduces, None where there is no such."""
    if relation is None:
        return None
    value = as_scalar(evaluate(relation.members[0], environment, Exact(environment)))
    return len(value.coefficients(environment.variable)) - 1


def _counts_degree(slots: _Slots, relation: Relation | None, environment: Environment) -> bool:
    return slots["count"] == Counted("number", _degree(relation, environment) or 0)


def _counts_dominant(slots: _Slots, relation: Relation | None, environment: Environment) -> bool:
    """Return whether beside the pair −σ ± iω the nearest root has the real part −factor σ."""
    factor = slots["factor"]
    if not _counts_degree(slots, relation, environment) or relation is None or not isinstance(factor, Counted):
        return False
    whole = as_scalar(evaluate(relation.members[0], environment, Exact(environment)))
    sigma, omega = (as_scalar(environment.values[name]) for name in ("sigma_d", "omega_d"))
    s = Scalar.symbol(environment.variable)
    others = whole / ((s + sigma) * (s + sigma) + omega * omega)
    moved = others.substitute({environment.variable: s - sigma * factor.count}).coefficients(environment.variable)
    left = tuple(reversed([*dropwhile(lambda c: c.is_zero, reversed(moved))]))
    is_stable = PREDICATES["stable"](from_coefficients(left, environment.variable), environment, False)  # noqa: FBT003
    return factor == Counted("number", factor.count) and len(left) < len(moved) and is_stable


def _counts_names(slots: _Slots, _: Relation | None, __: Environment) -> bool:
    names = slots["names"]
    return isinstance(names, SymbolList) and slots["vary"] == Counted("varies", len(names.names))


def _substitutes_law(slots: _Slots, _: Relation | None, __: Environment) -> bool:
    """Return whether the slots are equations for the input and for the rate of the estimate."""
    law, rate = slots["law"], slots["rate"]
    firsts = [slot.members[0] for slot in (law, rate) if isinstance(slot, Relation)]
    return firsts == [Letter("u"), Derivative(Letter("x_hat"))]


#: What the slots of a sentence must be together, some of them by the definition in which it stands.
_OF_STEP: dict[str, Callable[[_Slots, Relation | None, Environment], bool]] = {
    "counts_degree": _counts_degree,
    "counts_dominant": _counts_dominant,
    "counts_names": _counts_names,
    "substitutes_law": _substitutes_law,
    "introduces_degree_one": lambda _, relation, environment: _degree(relation, environment) == 1,
}

#: Sentences that set the limit to which a boundary is moved, and the name under which it is remembered.
_SETS = {"sets_margin": "sought margin", "sets_radius": "sought radius"}

#: What the definition in which a sentence stands must apply: the slot, and the limit that it must move the boundary to.
_APPLIES: dict[str, tuple[str, str]] = {
    "moves_by_margin": ("by", "sought margin"),
    "scales_by_radius": ("by", "sought radius"),
    "applies_image": ("image", ""),
}

#: Every obligation that a phrase may declare in its `DEMANDS`.
OBLIGATIONS = frozenset({*_OF_SLOTS, *_OF_FACTS, *_OF_STEP, *_SETS, *_APPLIES})


def require_known(demands: Mapping[str, str]) -> None:
    """Refuse obligations that nothing here checks; raises ValueError naming the phrases."""
    unknown = {key: name for key, name in demands.items() if name not in OBLIGATIONS}
    if unknown:
        message = f"no check is known for what these phrases demand: {unknown}; write it in {__name__}"
        raise ValueError(message)


require_known(DEMANDS)


def fits(key: str, relation: object, environment: Environment) -> bool:
    """Return whether the true relation of a sentence is the one its words state."""
    is_said = _OF_SLOTS.get(DEMANDS.get(key, ""))
    return is_said is None or (isinstance(relation, Relation) and is_said(relation, environment))


def rests(key: str, facts: Sequence[Fact], environment: Environment) -> bool:
    """Return whether the facts of a step, which are true, are such as its sentence rests on."""
    is_held = _OF_FACTS.get(DEMANDS.get(key, ""))
    return is_held is None or is_held(facts, environment)


def are_added(choice: StateChoice, facts: Sequence[Fact]) -> bool:
    """Return whether the facts are, set by set, the full rank of a test matrix with these states' unit rows below it."""
    if len(facts) != len(choice.sets):
        return False
    for numbers, fact in zip(choice.sets, facts, strict=True):
        match fact:
            case Relation(
                (Apply("rank", Block(((_,), (Literal(Matrix() as rows),), *_))), Literal(Scalar() as order)), ("=",)
            ):
                wanted = unit_rows(rows.shape[1], tuple(number - 1 for number in numbers))
                if rows != wanted or order != Scalar.of(rows.shape[1]):
                    return False
            case _:
                return False
    return True


def reject_other_slots(sentence: Sentence, relation: Relation | None, environment: Environment) -> None:
    """Reject a sentence that counts otherwise than its slots or the definition around it, or names other equations."""
    is_said = _OF_STEP.get(DEMANDS.get(sentence.key, ""))
    if is_said is not None and not is_said(dict(sentence.slots), relation, environment):
        reject(f"{sentence.key}, of another number or equation,")


def with_limit(sentence: Sentence, environment: Environment) -> Environment:
    """Remember the limit that a sentence sets: where the boundary is moved, it is moved to this one."""
    name = _SETS.get(DEMANDS.get(sentence.key, ""))
    if name is None:
        return environment
    return environment.extended_by(
        values={name: evaluate(formula_in(sentence, "limit"), environment, Exact(environment))}
    )


def reject_other_map(sentence: Sentence, relation: Relation | None, environment: Environment) -> None:
    """Reject a map that the definition does not apply, or that does not move the boundary to the limit set."""
    applied = _APPLIES.get(DEMANDS.get(sentence.key, ""))
    if applied is None:
        return
    slot, limit = applied
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
