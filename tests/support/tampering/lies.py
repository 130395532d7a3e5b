"""Tells a design's lies: every change of its answers, witnesses and lines is tried, and must be rejected or be true as well.

A change that makes another true statement is proved to be one in plain fractions or by SymPy, and counted apart.
"""

from __future__ import annotations

from contextlib import nullcontext
from dataclasses import dataclass, field, replace
from fractions import Fraction
from functools import partial
from math import prod
from typing import TYPE_CHECKING, Any

from symobs.exact import Matrix, Scalar
from symobs.exact.core.generators import symbols_in
from symobs.formula.figures import TimeResponse
from symobs.formula.tree import Conjunction, Letter, Literal, Relation
from symobs.ground.errors import CertificateRejected, DerivationRejected
from symobs.proof.derivation import Conclude, Given, Plot, Sentence
from symobs.proof.derivation.check import after_all
from symobs.proof.derivation.steps import everything_in
from symobs.stability.inequalities.proof import Combined, Opposite
from symobs.tasks.analysis.rank.observability import RankResult
from symobs.tasks.analysis.stability_region.stability_region import StabilityRegion
from symobs.tasks.design.compensator.compensator import CompensatorDesign
from symobs.tasks.design.gain.gain_design import GainDesign
from symobs.tasks.design.reference.tracking import TrackingDesign
from tests.support.algebra import (
    determinant,
    divides,
    hidden,
    identity,
    inverse,
    is_stable,
    multiply,
    observability_rows,
    rank_of,
    transposed,
    value_at,
)
from tests.support.claims.claims import HOLDS, Setting
from tests.support.claims.claims_in_time import FUNCTIONS_OF_TIME
from tests.support.derivations import World, plus, still_true, times
from tests.support.regions.region_facts import is_table, loop_polynomial, moved_at, points
from tests.support.sampling import FULL
from tests.support.tampering.mutations import WORDS, Change, Line, answer_changes, changes, lines_of
from tests.support.tools.remembered import remembered

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    from symobs.formula.tree import Environment
    from symobs.proof.derivation import Derivation, Step
    from symobs.tasks.design.pole_placement.single_output import ObserverPair
    from symobs.tasks.result import Result
    from tests.support.algebra import Rows

#: How many changes are tried by default: of one answer, and of all the lines of a page together at least.
OF_AN_ANSWER, OF_LINES = (10**9, 10**9) if FULL else (8, 80)
#: Of a region, an interval or a map of poles at least so many: what the check asks of its other places is kept.
OF_A_PICTURE = 40
#: Where the lines are so few or so short that fewer changes than this would be tried, more are tried of each.
LEAST = 70


def sample(found: Sequence[Change], most: int) -> Sequence[Change]:
    """Return all, or some at even distances."""
    if len(found) <= most:
        return found
    return [found[index * len(found) // most] for index in range(most)]


@dataclass
class Count:
    """What became of the changes that were tried."""

    tried: int = 0
    rejected: int = 0
    true: int = 0
    lies: list[str] = field(default_factory=list)

    def attempt(self, where: str, make: Callable[[], object], is_so: Callable[[], bool]) -> None:
        """Make what was changed; where nothing objects, it must be so."""
        self.tried += 1
        try:
            make()
        except (CertificateRejected, DerivationRejected):
            self.rejected += 1
            return
        if is_so():
            self.true += 1
        else:
            self.lies.append(where)


# -- answers -----------------------------------------------------------------------------------------------------------


def try_answers(part: Result, where: str, count: Count, most: int = OF_AN_ANSWER) -> None:
    for name, value in part.answer.items():
        for change in sample(list(answer_changes(value)), most):
            answer = {**part.answer, name: change.value}
            make = partial(replace, part, answer=answer)
            count.attempt(f"{where}: {name}{change.where}", make, partial(holds, part, answer))


def holds(part: Result, answer: Mapping[str, Any]) -> bool:
    """Tell in plain fractions whether an answer is right at random points."""
    worlds = [World(seed, part.plant.variable, part.plant.symbols.signs) for seed in range(3)]
    conditions = getattr(getattr(part, "piece", None), "conditions", ())
    equations = part.plant.equations or [c.expression for c in conditions if c.operator == "=="]
    for world in worlds:
        world.move_to(equations)
    try:
        return all(_holds_at(part, answer, world) for world in worlds)
    except (ArithmeticError, LookupError, TypeError, ValueError):
        return False


def _holds_at(part: Result, answer: Mapping[str, Any], world: World) -> bool:
    if part.task in FUNCTIONS_OF_TIME:
        return _holds_in_time(part, answer, world)
    m = part.plant.matrices
    A, B, C, D = (world.value(matrix) for matrix in (m.A, m.B, m.C, m.D))
    s = world.number(part.plant.variable)
    if isinstance(part, RankResult):
        if part.task == "controllability":
            A, C = transposed(A), transposed(B)
        return _is_rank(A, C, answer, world)
    if isinstance(part, StabilityRegion):
        return _is_region(part, answer, world)
    if isinstance(part, GainDesign):
        gain = world.value(answer[part.letter])
        moved = multiply(gain, C) if part.letter == "L" else multiply(B, gain)
        wanted = [world.value(answer["polynomial"])]
        wanted += [world.value(part.desired.polynomial)] if part.desired is not None else []
        return {determinant(pencil(s, plus(A, times(Fraction(-1), moved))))} == set(wanted)
    if isinstance(part, CompensatorDesign):
        K, L = world.value(answer["K"]), world.value(answer["L"])
        own = [world.value(part.feedback.answer["K"]), world.value(part.estimator.answer["L"])]
        moved = plus(plus(multiply(B, K), multiply(L, C)), times(Fraction(-1), multiply(L, multiply(D, K))))
        F = multiply(K, multiply(inverse(plus(pencil(s, A), moved)), L))
        found = world.value(answer["F"])
        return own == [K, L] and (found if isinstance(found, list) else [[found]]) == F
    if isinstance(part, TrackingDesign):
        return _is_followed(part, answer, A, B, world)
    if part.task == "reduced_order_observer" and answer["L"] is None and part.plant.equations:
        return _is_no_reduced_order(part, answer, A, C, world)
    return _holds_by_definition(part, answer, world)


def _is_no_reduced_order(part: Any, answer: Mapping[str, Any], A: Rows, C: Rows, world: World) -> bool:
    """Tell whether T completes C, as any complement does, and modes that are not seen are not among the poles."""
    T, phi = world.value(answer["T"]), world.coefficients(part.desired.polynomial)[::-1]
    return (
        T[: len(C)] == C
        and determinant(T) != 0
        and not any(answer[name] is not None for name in "LFGHM")
        and not divides(hidden(A, C), phi)
    )


def _holds_by_definition(part: Result, answer: Mapping[str, Any], world: World) -> bool:
    """Hold what a result would say with these answers to the plant, and to the polynomial asked for, at a point."""
    told = replace(part, answer=answer)
    values = [value for value in answer.values() if isinstance(value, (Matrix, Scalar))]
    values += part.data.values()
    names = set(part.plant.field.names).union(*(value.names for value in values)) - {part.plant.variable}
    desired = getattr(part, "desired", None)
    wanted = {} if desired is None else {"polynomial": desired.polynomial}
    try:
        HOLDS[part.task](told, Setting.of(part.plant, wanted, {name: world.number(name) for name in names}))
    except AssertionError:
        return False
    return True


def _is_region(part: StabilityRegion, answer: Mapping[str, Any], world: World) -> bool:
    """Tell whether χ is that of the loop, the table its own, and the inequalities hold where its roots are stable."""
    chi = answer["polynomial"]
    if chi is None or answer["routh"] is None or world.value(chi) != loop_polynomial(part, world):
        return False
    discrete, signs = part.plant.is_discrete, part.plant.symbols.signs
    samples = points(sorted(chi.names - {part.plant.variable}), signs, world.seed, 200)
    bounds = answer["bounds"]
    return (
        is_table(part, answer["routh"], world)
        and all(inside(bounds, point) == is_stable(moved_at(part, point), discrete=discrete) for point in samples)
        and proof_holds(answer["proof"], world)
    )


def inside(bounds: Sequence[Any] | None, point: Mapping[str, Fraction]) -> bool:
    """Tell whether inequalities hold at a point; nowhere, where there are none."""
    if bounds is None:
        return False
    values = [(value_at(bound.polynomial, point), bound.operator) for bound in bounds]
    return all(value > 0 if operator == ">" else value != 0 for value, operator in values)


def proof_holds(proof: Any, world: World) -> bool:
    """Tell whether every product in a proof is equal to what it is compared with, and no coefficient is negative."""
    steps = [] if proof is None else [*proof.forward, *proof.backward]
    while steps:
        step = steps.pop()
        if isinstance(step, Opposite):
            steps += step.steps
        elif isinstance(step, Combined):
            left, right = (_products(terms, world) for terms in (step.multiplier, step.total))
            if world.value(step.value) * sum(left) != sum(right):
                return False
            if any(world.value(c) < 0 for c, _ in (*step.multiplier, *step.total)):
                return False
    return True


def _products(terms: Sequence[Any], world: World) -> list[Fraction]:
    return [world.value(c) * prod((world.value(f) for f in factors), start=Fraction(1)) for c, factors in terms]


def _is_followed(part: TrackingDesign, answer: Mapping[str, Any], A: Rows, B: Rows, world: World) -> bool:
    """Tell whether B K_d = A − A_d on what the reference passes through, or a row annuls B and not A − A_d there."""
    difference = plus(A, times(Fraction(-1), world.value(part.reference)))
    wanted = multiply(difference, world.value(part.passed))
    if answer["K_d"] is not None:
        followed: Rows = multiply(multiply(B, world.value(answer["K_d"])), world.value(part.passed))
        return bool(followed == wanted)
    row = world.value(answer["w"])
    return not any(map(any, multiply(row, B))) and any(map(any, multiply(row, wanted)))


def _holds_in_time(part: Result, answer: Mapping[str, Any], world: World) -> bool:
    """Hold what a result would say with these answers to the plant; a closed form left out says less, not another thing."""
    told = replace(part, answer=answer)
    values = [value for value in answer.values() if isinstance(value, (Matrix, Scalar))]
    names = {"t", "t0", "T"}.union(part.plant.field.names, *map(symbols_in, values))
    point = {name: world.number(name) for name in names - set("s")}
    at = Setting.of(part.plant, {}, point)
    try:
        HOLDS[part.task](told, at)
    except AssertionError:
        return False
    if "rank" in answer and not isinstance(answer["rank"], int):
        return _is_rank(*at.pair(dual=answer.get("of") == "controllability"), answer["rank"], world)
    return True


def _is_rank(A: Rows, C: Rows, answer: Mapping[str, Any], world: World) -> bool:
    O = observability_rows(A, C)
    N, X = world.value(answer["kernel"]), world.value(answer["restricted"])
    minor = [[O[i][j] for j in answer["columns"]] for i in answer["rows"]]
    return (
        world.value(answer["matrix"]) == O
        and answer["rank"] == rank_of(O) == len(minor) == len(answer["columns"])
        and determinant(minor) != 0
        and len(answer["free"]) == len(N[0]) == len(A) - rank_of(O)
        and determinant([N[i] for i in answer["free"]]) != 0
        and not any(map(any, multiply(O, N)))
        and multiply(A, N) == multiply(N, X)
    )


def pencil(s: Fraction, table: Rows) -> Rows:
    found: Rows = plus(times(s, identity(len(table))), times(Fraction(-1), table))
    return found


# -- witnesses ---------------------------------------------------------------------------------------------------------


def tampered(thing: Any, name: str, value: object) -> Any:
    """Return a copy of something whose attribute was computed once, with another value for it."""
    copy = object.__new__(type(thing))
    copy.__dict__.update(thing.__dict__)
    copy.__dict__[name] = value
    return copy


def try_witnesses(part: Result, where: str, count: Count, most: int = OF_AN_ANSWER) -> None:
    """Change the family of gains, and where no gain exists the subspace that proves it."""
    if not isinstance(part, GainDesign):
        return
    if part.gain_family is not None:
        for change in sample(list(changes(part.gain_family[part.letter])), most):
            family = {**part.gain_family, part.letter: change.value}
            make = tampered(part, "gain_family", family).__post_init__
            count.attempt(f"{where}: family{change.where}", make, partial(_is_family, part, family))
    if part.answer[part.letter] is None:
        for name in ("kernel", "restricted", "fixed_polynomial"):
            for change in sample(list(changes(getattr(part.pair, name))), most):
                pair = tampered(part.pair, name, change.value)
                make = tampered(part, "pair", pair).__post_init__
                count.attempt(f"{where}: {name}{change.where}", make, partial(_is_hidden, part, pair))


def _is_family(part: GainDesign, family: Mapping[str, Any]) -> bool:
    """Tell whether every member meets φ, and the members fill a space of the dimension of ker 𝒪.

    For several outputs the members fill no linear space: that φ is met at random points of the parameters has to do.
    """
    if part.chart is not None:
        return holds(part, {**part.answer, part.letter: family[part.letter]})
    gain, names = family[part.letter], family["parameters"]
    world = World(0, part.plant.variable, part.plant.symbols.signs)

    def member(chosen: str) -> list[Fraction]:
        """Return the entries of the member at a point, one parameter moved on by 1."""
        point = {name: world.number(name) + int(name == chosen) for name in names}
        table = world.value(gain.substitute({name: Scalar.of(value) for name, value in point.items()}))
        return [entry for row in table for entry in row]

    directions = [[x - y for x, y in zip(member(name), member(""), strict=True)] for name in names]
    return rank_of(directions) == len(names) and holds(part, {**part.answer, part.letter: gain})


def _is_hidden(part: GainDesign, pair: ObserverPair) -> bool:
    """Tell whether N is a basis of an unseen invariant subspace whose polynomial is the one stated."""
    world = World(0, part.plant.variable, part.plant.symbols.signs)
    A, C, N, X = (world.value(matrix) for matrix in (pair.A, pair.c, pair.kernel, pair.restricted))
    unseen = not any(map(any, multiply(C, N))) and multiply(A, N) == multiply(N, X)
    fixed = determinant(pencil(world.number(part.plant.variable), X)) == world.value(pair.fixed_polynomial)
    return rank_of(N) == len(N[0]) > 0 and unseen and fixed


# -- derivations -------------------------------------------------------------------------------------------------------


def try_lines(result: Result, count: Count, of_lines: int = OF_LINES) -> None:
    lines = lines_of(result.derivation)
    found = [[] if _is_unread(line) else list(changes(line.step)) for line in lines]
    most = -(-of_lines // len(lines))
    while sum(min(len(some), most) for some in found) < min(LEAST, of_lines, sum(map(len, found))):
        most += 1
    for number, (line, some) in enumerate(zip(lines, found, strict=True)):
        is_drawn = isinstance(line.step, Plot) and not isinstance(line.step.picture, TimeResponse)
        with remembered() if is_drawn else nullcontext():
            chosen = sample(some, max(most, OF_A_PICTURE) if is_drawn else most)
            _try_line(line, f"{result.task}, line {number}", chosen, count)


def _try_line(line: Line, where: str, some: Sequence[Change], count: Count) -> None:
    meant, kind = (line.alone(line.step), line.told(line.step)), type(line.step).__name__
    for change in some:
        alone = line.alone(change.value)
        is_so: Callable[[], bool] = partial(_is_true, line, alone, *meant)
        make, is_so = partial(_check, line, alone), (lambda: False) if change.where.endswith(WORDS) else is_so
        count.attempt(f"{where}, {kind}: {change.where}", make, is_so)


def _check(line: Line, alone: Derivation) -> None:
    """Check a changed line, and what follows where something else is established by it: else it is as it was."""
    after = _walked(alone)
    if after != line.after:
        _walked(line.followed(after))


def _walked(derivation: Derivation) -> Environment:
    """Check lines by themselves; that the cases follow which they promise is a matter of the whole page."""
    return after_all(derivation.steps, derivation.start, derivation.discrete)


def _is_unread(line: Line) -> bool:
    """Tell whether a line sets a letter silently that nothing after it is written in: it says nothing."""
    match line.step:
        case Given(relations=(Relation(members=(Letter(name), *_)),), silent=True):
            return not any(item == Letter(name) for item in everything_in(line.rest))
        case _:
            return False


def _is_as_positive(one: Step, other: Step) -> bool:
    """Tell whether signs that are declared are those of a positive multiple: 4 g h > 0 for 2 g h > 0."""
    match one, other:
        case Conclude(Sentence("declared", ((_, Conjunction(first)),))), Conclude(
            Sentence("declared", ((_, Conjunction(last)),))
        ):
            pairs = [(a, b) for a, b in zip(first, last, strict=True) if a != b]
            return all(
                a.operators == b.operators
                and a.members[1] == b.members[1] == Literal(Scalar.of(0))
                and _ratio(a, b) > 0
                for a, b in pairs
            )
        case _:
            return False


def _ratio(one: Relation, other: Relation) -> Fraction:
    found = other.members[0].value / one.members[0].value  # type: ignore[union-attr, operator]
    return found.fraction() if found.is_constant else Fraction(0)


def _is_true(line: Line, alone: Derivation, meant: Derivation, rest: Derivation) -> bool:
    """Tell whether a changed line is true, and what follows where something else is established by it."""
    if _is_as_positive(line.step, *alone.steps):
        return True
    if _walked(alone) == line.after:
        return still_true(alone, meant)
    return still_true(line.told(*alone.steps), rest)
