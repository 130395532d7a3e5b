"""Check that the relation in a sentence is the one its words state, not just a true one (trusted).

A pair of poles overshoots by exp(−π σ/ω), and by no other number below a bound; a pair is observable because the rank is
that of a matrix of full rank, and not because of 1 = 1.  Which sentence owes what is declared beside its words, in the
`DEMANDS` of `phrases`; what an obligation means is defined here, without a name of any phrase.  It is a name, with the
letters it is about, `observable C A` or of the dual `observable Bᵀ Aᵀ`; what it asserts of them is evaluated where the
sentence stands.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from symobs.exact import Scalar
from symobs.exact.core.generators import PI
from symobs.formula.phrases import DEMANDS
from symobs.formula.tree import (
    Apply,
    Exact,
    Formula,
    Letter,
    Negative,
    Power,
    Product,
    Relation,
    Roots,
    evaluate,
)
from symobs.formula.tree.plain_text import plain
from symobs.proof.certificate.claims import UNREADABLE, as_scalar
from symobs.proof.derivation.facts import reject
from symobs.proof.derivation.sentence_context import (
    WEAKER,
    SentenceContext,
    are_about,
    characteristic_of,
    is_shown_in,
    letter_of,
    number_of,
    sizes_of,
    stack_of,
    vanishes,
)
from symobs.proof.derivation.steps import everything_in
from symobs.proof.derivation.wording_of_equations import (
    annuls,
    are_minors,
    encloses,
    exceeds,
    has_asymptotes,
    has_dead_time,
    has_margins,
    has_nyquist,
    is_blocked,
    is_lower_rank,
    is_lyapunov,
    is_nonsingular,
    is_of_pairs,
    is_on_locus,
    is_optimal,
    is_real_point,
    leads_with,
    misses_phase,
    reaches,
    refutes_lyapunov,
    refutes_regulator,
    reverses,
    shares_kernel,
    solves_homogeneous,
    spans_kernel,
    splits,
    sums,
    vanishes_of,
)
from symobs.proof.derivation.wording_of_pairs import (
    are_duals,
    are_modes,
    are_seen,
    are_stable,
    are_unseen,
    are_unstable,
    counts_free,
    exhausts,
    fixes,
    has_freedom,
    has_no_gain,
    has_rank,
    is_bounded,
    is_canonical,
    is_chained,
    is_exact,
    is_observable,
    is_of_low_rank,
    is_on_boundary,
    is_regular_at,
    is_test,
    is_unobservable,
    misses,
    moves_integrators,
    of_pair,
    repairs,
    says_rank,
)
from symobs.proof.derivation.wording_of_polynomials import (
    counts_degree,
    counts_dominant,
    counts_names,
    counts_steps,
    degree_of,
    exponential,
    is_defective,
    is_of_damping,
    is_of_loop,
    one_higher,
    shares_roots,
    shows_it,
    substitutes_law,
)

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from symobs.formula.tree import Environment
    from symobs.proof.derivation.steps import Sentence


#: What every slot of a sentence must be: a relation of which this is true.
_OF_SLOTS: dict[str, Callable[..., bool]] = {
    "says_rank_full": says_rank(is_full=True),
    "says_rank_low": says_rank(is_full=False),
    "says_observable": of_pair(is_full=True),
    "says_observable_everywhere": of_pair(is_full=True, everywhere=True),
    "says_unobservable": of_pair(is_full=False),
    "says_unobservable_everywhere": of_pair(is_full=False, everywhere=True),
    "says_regular_at": is_regular_at,
    "says_decay": exponential(lambda of: -of["sigma_d"] * of["T_s"]),
    "says_overshoot": exponential(lambda of: -Scalar.symbol(PI) * of["sigma_d"] / of["omega_d"]),
    "says_overshoot_above": exponential(
        lambda of: -Scalar.symbol(PI) / one_higher((of["omega_d"] / of["sigma_d"]).fraction())
    ),
}


#: What must be so where a sentence stands, of its facts, its slots and the letters that the obligation names.
_OF_STEP: dict[str, Callable[..., bool]] = {
    "observable": is_observable,
    "moves_integrators": moves_integrators,
    "unobservable": is_unobservable,
    "unseen": are_unseen,
    "spans_unseen": lambda said, *names: are_unseen(said, *names, all_of_them=True),
    "repairs": repairs,
    "modes": are_modes,
    "exhausts": exhausts,
    "seen": are_seen,
    "bounded": is_bounded,
    "chained": is_chained,
    "modes_stable": are_stable,
    "modes_unstable": are_unstable,
    "fixes": fixes,
    "eigenvalues_of": lambda said, of: all(
        is_shown_in(said.environment, told.polynomial, "=", characteristic_of(of, said.environment))
        for told in said.of(Roots)
    ),
    "spectrum": lambda said, of: are_about(said, characteristic_of(of, said.environment)),
    "about": lambda said, letter, *names: are_about(said, Letter(letter), *names),
    "zero": lambda said, *names: any(
        name in said.environment.values and vanishes(said.environment, Letter(name)) for name in names
    ),
    "is_characteristic": lambda said, letter, of: is_shown_in(
        said.environment, Letter(letter), "=", characteristic_of(of, said.environment)
    ),
    "reverses": lambda said, letter, of: reverses(said.environment, letter, of),
    "of_pairs": is_of_pairs,
    "ends": lambda said, operator: all(
        (told.operators[-1], told.members[-1]) == (operator, number_of(0)) for told in said.of(Relation)
    ),
    "solves": lambda said, M, x, b: is_shown_in(said.environment, Product((Letter(M), Letter(x))), "=", Letter(b)),
    "solves_homogeneous": solves_homogeneous,
    "refutes_lyapunov": refutes_lyapunov,
    "refutes_regulator": refutes_regulator,
    "blocked": lambda said, of: is_blocked(said, of, everywhere=True),
    "blocked_there": lambda said, of: is_blocked(said, of, everywhere=False),
    "has_margins": has_margins,
    "has_nyquist": has_nyquist,
    "has_dead_time": has_dead_time,
    "misses_phase": misses_phase,
    "real_point": is_real_point,
    "on_locus": is_on_locus,
    "leads_with": leads_with,
    "has_asymptotes": has_asymptotes,
    "minors": are_minors,
    "solves_lyapunov": is_lyapunov,
    "optimal": is_optimal,
    "encloses": encloses,
    "exceeds": exceeds,
    "reaches": reaches,
    "splits": splits,
    "on_boundary": is_on_boundary,
    "vanishes": vanishes_of,
    "annuls": annuls,
    "one_rank": lambda said, C, E: is_shown_in(
        said.environment, Apply("rank", Product((letter_of(C), letter_of(E)))), "=", Apply("rank", letter_of(E))
    ),
    "lower_rank": is_lower_rank,
    "nonsingular": is_nonsingular,
    "duals": are_duals,
    "sums_powers": lambda said: sums(said, "M"),
    "shares_kernel": shares_kernel,
    "spans_kernel": spans_kernel,
    "needs_rank_full": lambda said: has_rank(said, is_full=True),
    "loop": is_of_loop,
    "shown": shows_it,
    "exactly": is_exact,
    "canonical": is_canonical,
    "no_gain": has_no_gain,
    "not_unique": lambda said, row, of: has_freedom(said, row, of) > 0,
    "dimension": lambda said, row, of: said.slots["count"] == str(has_freedom(said, row, of)),
    "single": lambda said, row: sizes_of(row, said.environment)[0] == 1,
    "poles_of": lambda said, letter: all(
        formula == Letter(letter)
        for formula in (*(told.polynomial for told in said.of(Roots)), *(r.members[0] for r in said.of(Relation)))
    ),
    "no_effect": lambda said, C, A, B: vanishes(
        said.environment, Product((stack_of(C, A, said.environment), Letter(B)))
    ),
    "no_feedthrough": lambda said: "D" not in said.environment.values or vanishes(said.environment, Letter("D")),
    "is": lambda said, left, right: is_shown_in(said.environment, letter_of(left), "=", letter_of(right)),
    "is_negative": lambda said, left, right: is_shown_in(
        said.environment, letter_of(left), "=", Negative(letter_of(right))
    ),
    "is_constant": lambda said, letter: (
        as_scalar(said.environment.values[letter]).degree(said.environment.variable) == 0
    ),
    "tests": is_test,
    "finding": lambda _: False,  # of a table or a region: it is said below one, where the check finds it itself
    "continuous_time": lambda said: said.environment.variable != "z",
    "discrete_time": lambda said: said.environment.variable == "z",
    "zeros_of": lambda said, letter: all(
        formula == Power(Letter(letter), -1) for formula in (*said.subjects(), *(t.polynomial for t in said.of(Roots)))
    ),
    "pole_defective": is_defective,
    "of_damping": is_of_damping,
    "of_low_rank": is_of_low_rank,
    "free_parts": counts_free,
    "misses": misses,
    "shared_roots": shares_roots,
    "counts_degree": counts_degree,
    "counts_dominant": counts_dominant,
    "counts_names": counts_names,
    "counts_steps": counts_steps,
    "substitutes_law": substitutes_law,
    "introduces_degree_one": lambda said: degree_of(said.introduced, said.environment) == 1,
}


#: Sentences that set the limit to which a boundary is moved, or what stability means, and the name of what is remembered.
_SETS = {"sets_margin": "sought margin", "sets_radius": "sought radius", "sets_meaning": WEAKER}


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


def relation_fits(key: str, relation: object, environment: Environment) -> bool:
    """Return whether the true relation of a sentence is the one its words state."""
    owed = _owed(key, _OF_SLOTS)
    return not owed or (isinstance(relation, Relation) and _are_met(owed, relation, environment))


def meets_obligations(key: str, said: SentenceContext) -> bool:
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
        limit = formula_in(sentence, "limit") if name != WEAKER else number_of(1)
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
