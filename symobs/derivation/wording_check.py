"""Whether the relation in a sentence is the one that its words speak of, not just any that is true (trusted).

A pair of poles overshoots by exp(−π σ/ω), and by no other number below a bound; a pair is observable because the rank is
that of a matrix of full rank, and not because of 1 = 1.
"""

from __future__ import annotations

from fractions import Fraction
from itertools import takewhile
from typing import TYPE_CHECKING, Any

from symobs.certificate.claims import as_scalar
from symobs.certificate.pointwise import Pointwise
from symobs.exact import Scalar, rank
from symobs.exact.kernel.generators import PI, function
from symobs.formula import Apply, Exact, Letter, Predicate, Product, Relation, Roots, agree, evaluate

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    from symobs.formula import Environment, Fact, Formula


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


#: What e is raised to in the relations of sentences, from the values of the letters.
EXPONENTS: dict[str, Callable[[Mapping[str, Any]], Scalar]] = {
    "decayed": lambda of: -of["sigma_d"] * of["T_s"],
    "overshoot_held": lambda of: -Scalar.symbol(PI) * of["sigma_d"] / of["omega_d"],
    "overshoot_close": lambda of: -Scalar.symbol(PI) / _one_higher((of["omega_d"] / of["sigma_d"]).fraction()),
}


#: Sentences that say of a rank that it is full, and those that say that it is not.
_RANKS_OF = {f"{key}_{of}" for key in ("full_rank", "generic_rank") for of in ("observability", "controllability")}
FULL_RANK = _RANKS_OF | {"stack_yes", "case_stack_yes"}
_LOW_EVERYWHERE = {"no_observability", "no_controllability"}
_LOW_IN_GENERAL = {"generic_low_observability", "generic_low_controllability"}
LOW_RANK = _LOW_EVERYWHERE | _LOW_IN_GENERAL | {"stack_no", "case_stack"}


_KINDS, _VERDICTS = ("observability", "controllability"), ("detectability", "stabilizability")
#: Sentences that a fact of their step holds up: a full rank, a lower one, hidden modes that are stable or are not.
OF_FULL_RANK = {f"{key}_{kind}" for key in ("pbh_yes", "no_fixed_modes") for kind in _KINDS} | {"no_feedforward_zero"}
OF_LOW_RANK = {f"pbh_no_{kind}" for kind in _KINDS}
OF_STABLE_MODES, OF_UNSTABLE_MODES = ({f"{answer}_{verdict}" for verdict in _VERDICTS} for answer in ("yes", "no"))
OF_STABLE_LOOP = {"compensator_unstable_alone", "compensator_unstable_low_alone", "minimal_unstable_alone"}
OF_DEFECTIVE_POLE = {"defective", "defective_instead"}


def rests(key: str, facts: Sequence[Fact], environment: Environment) -> bool:
    """Tell whether the facts of a step, which are true, are such as its sentence rests on."""

    def is_rank(*, is_full: bool) -> bool:
        return any(_is_of_rank(fact, environment, is_full=is_full) for fact in facts if isinstance(fact, Relation))

    properties = {fact.name for fact in facts if isinstance(fact, Predicate)}
    if key in OF_FULL_RANK | OF_LOW_RANK:
        return is_rank(is_full=key in OF_FULL_RANK)
    if key in OF_STABLE_LOOP:
        return any(_is_of_loop(fact, environment) for fact in facts if isinstance(fact, Predicate))
    if key in OF_DEFECTIVE_POLE:
        return _is_defective(facts, environment)
    if key in OF_STABLE_MODES:
        return bool(properties & {"stable", "marginal"}) or is_rank(is_full=True)
    return key not in OF_UNSTABLE_MODES or "unstable" in properties


def fits(key: str, relation: Formula | Fact | str, environment: Environment) -> bool:
    """Tell whether the relation of a sentence, which is true, is one that its words speak of."""
    if key not in EXPONENTS.keys() | FULL_RANK | LOW_RANK:
        return True
    if not isinstance(relation, Relation):
        return False
    if key in EXPONENTS:
        told = evaluate(relation.members[0], environment, Exact(environment))
        return bool(told == function("exp", EXPONENTS[key](environment.values)))
    if key in _LOW_EVERYWHERE and not _is_everywhere(relation, environment):
        return False
    return _is_of_rank(relation, environment, is_full=key in FULL_RANK)


def _is_of_loop(fact: Predicate, environment: Environment) -> bool:
    """Tell whether a predicate says that the polynomial of the loop, φ_c φ_o, is stable."""
    if fact.name != "stable" or not {"phi_c", "phi_o"} <= environment.values.keys():
        return False
    exact, loop = Exact(environment), Product((Letter("phi_c"), Letter("phi_o")))
    return agree(evaluate(fact.subject, environment, exact), evaluate(loop, environment, exact), exact)


def _is_defective(facts: Sequence[Fact], environment: Environment) -> bool:
    """Tell whether a pole of φ_c is met more often than a matrix X lacks in rank, φ_c(s + pole) being det(sI − X)."""
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
    """Return the matrix of whose rank a relation begins to speak."""
    first = relation.members[0]
    return first.argument if isinstance(first, Apply) and first.function == "rank" else None


def _is_everywhere(relation: Relation, environment: Environment) -> bool:
    """Tell whether the rank that a relation begins with is seen to be the same for all parameters."""
    first = relation.members[0]
    if not isinstance(first, Apply) or not evaluate(first.argument, environment, Exact(environment)).names:
        return True
    try:
        evaluate(first, environment, Pointwise(environment))
    except (ArithmeticError, TypeError):
        return False
    return True


def _is_of_rank(relation: Relation, environment: Environment, *, is_full: bool) -> bool:
    """Tell whether a relation is rank = r with the full r, or with a lower one, followed by nothing but the full one."""
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
