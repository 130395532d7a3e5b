"""No lie survives: every answer entry, witness entry and derivation line of every worked example, changed, is rejected.

A change that makes another true statement is proved to be one in plain fractions or by SymPy, and counted apart.  By
default a stratified sample of the changes is tried, the same in every run; with SYMOBS_FULL=1 all of them are.
"""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from random import Random
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

import symobs
from symobs import StateSpace, compensator, observability, observer, state_feedback
from symobs.exact import Matrix, Scalar
from symobs.formula.phrases import DEMANDS, slots_of
from symobs.formula.tree import Letter, Relation
from symobs.ground.errors import CertificateRejected, DerivationRejected, SymobsError
from symobs.problem import read
from symobs.proof.derivation import CaseStep, Conclude, Diagram, Section, Sentence
from symobs.proof.derivation.builder import Builder
from symobs.proof.derivation.steps import everything_in
from symobs.proof.derivation.wording_check import obligations
from symobs.tasks.design.compensator.output_feedback import OutputFeedback
from symobs.tasks.design.gain.gain_design import GainDesign
from tests.kit import SERVO, tabled
from tests.support.algebra import determinant, multiply, observability_rows, rank_of, transposed
from tests.support.derivations import World, is_true, plus, still_true, times
from tests.support.examples import EXAMPLES, results_of
from tests.support.problems.random_problems import problem, to_toml
from tests.support.sampling import FULL, every
from tests.support.second_reader import check_lines
from tests.support.tampering.lies import Count, tampered, try_answers, try_lines, try_witnesses
from tests.support.tampering.mutations import changes, lines_of, parts_of

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Sequence
    from pathlib import Path

    from symobs.formula.tree import Environment
    from symobs.proof.derivation import Derivation, Step
    from symobs.tasks.result import Result
    from tests.support.algebra import Rows

pytestmark = pytest.mark.slow

#: Pages of nothing but ranks and modes: a rank, a product that is 0 and a property say the same when they are doubled or
#: negated, and b >= 0 is as true as b > 0, so a larger share of the changes of their lines is true.
OF_RANKS = {"observability", "controllability", "pbh", "detectability", "stabilizability"}

#: Regions with edges parallel to an axis: a corner that is moved along its edge leaves the picture as it is.
OF_STRAIGHT_EDGES = {"pendulum_feedback_region", "region_without_one_point", "region_disconnected"}


def results(path: Path) -> tuple[Result, ...]:
    return results_of(path.stem)


#: Examples whose answer leaves entries free: K_d beside one trajectory, the row that shows there is none.
NOT_UNIQUE = {"cart_tracking", "cart_tracking_impossible"}
#: Fractions know no functions of time, so what stays true of such an answer is not told here; 50 digits hold it elsewhere.
IN_FUNCTIONS = {"time_varying_fading_sensor", "time_varying_rotating_sensor"}


#: What plain fractions do not know: an arccosine, which is real in its case alone.
IN_ANGLES = {"hoop_equilibria", "hoop_over_its_speed"}


@pytest.mark.parametrize("path", every(6, EXAMPLES), ids=lambda path: path.stem)
def test_no_lie_survives(path: Path, record_property: Callable[[str, object], None]) -> None:
    answers, lines = Count(), Count()
    for result in results(path):
        for where, part in () if path.stem in IN_FUNCTIONS else parts_of(result):
            try_answers(part, where, answers)
            try_witnesses(part, where, answers)
        try_lines(result, lines)
    for name, count in (("answers and witnesses", answers), ("lines", lines)):
        numbers = f"{count.tried} tried, {count.rejected} rejected, {count.true} other true ones"
        record_property(name, numbers)
        print(f"{path.stem}: {name}: {numbers}")  # noqa: T201 - shown by pytest -rP
        assert count.lies == []
        if path.stem in IN_FUNCTIONS and count is answers:
            continue
        assert count.tried == count.rejected + count.true
        of_ranks = count is lines and {result.task for result in results(path)} <= OF_RANKS
        of_points = {result.task for result in results(path)} == {"equilibria"}  # -x is one where x is
        is_free = count is answers and (path.stem in NOT_UNIQUE or of_points)
        is_straight = count is lines and path.stem in OF_STRAIGHT_EDGES
        assert count.rejected > (0.75 if of_ranks else 0.6 if is_straight else 0.4 if is_free else 0.8) * count.tried
    assert lines.tried >= 60


#: Tasks with a plant whose claims are held in plain fractions or by SymPy.
ASKED = (
    *("observer", "state_feedback", "compensator", "observability", "controllability", "reduced_order_observer"),
    *("tracking", "detectability", "stabilizability", "transfer_function", "characteristic_polynomial"),
    *("canonical_form", "decomposition", "dual", "pbh", "feedforward"),
)
KINDS = ("numeric", "parametric", "defective", "hidden", "discrete", "feedthrough", "several")


def test_no_lie_about_a_random_design_survives() -> None:
    """Every answer and witness, and of the lines of each page a few at even distances."""
    answers, lines, designs, total = Count(), Count(), 0, 1000 if FULL else 40
    for number in range(total):
        kind, task = KINDS[number % len(KINDS)], ASKED[number // len(KINDS) % len(ASKED)]
        kinds = [kind if (task, kind) != ("feedforward", "several") else "numeric"]
        try:
            (result,) = read(to_toml(problem(Random(f"design {number}"), [task], kinds))).solve()  # noqa: S311
        except SymobsError:
            continue
        designs += 1
        assert is_true(result.derivation)
        for where, part in parts_of(result, f"design {number} "):
            try_answers(part, where, answers, 10**9)
            try_witnesses(part, where, answers, 10**9)
        try_lines(result, lines, 25)
    assert designs > 0.85 * total
    for count in (answers, lines):
        assert count.lies == []
        assert count.tried == count.rejected + count.true
        assert count.tried > 500
        assert count.rejected > 0.8 * count.tried


@pytest.mark.parametrize("path", every(6, EXAMPLES, 1), ids=lambda path: path.stem)
def test_every_line_holds_in_plain_fractions(path: Path) -> None:
    for result in results(path) if path.stem not in IN_ANGLES else ():
        check_lines(result.derivation, range(3))


@tabled
def test_a_lie_that_survived_once_is_rejected(stem: str, key: str, where: str) -> None:
    (path,) = (path for path in EXAMPLES if path.stem == stem)
    told = [
        line.told(change.value)
        for result in results(path)
        for line in lines_of(result.derivation)
        if getattr(getattr(line.step, "sentence", None), "key", None) == key
        for change in changes(line.step)
        if change.where == where
    ]
    assert told
    for derivation in told:
        with pytest.raises(DerivationRejected):
            derivation.check()


@tabled
def test_a_sign_before_a_gain_of_zero_may_be_any(stem: str, *, is_another: bool) -> None:
    """With L = 0 nothing of y − C x̂ reaches the integrator, nor of y + C x̂."""
    (path,) = (path for path in EXAMPLES if path.stem == stem)
    lines = [line for result in results(path) for line in lines_of(result.derivation)]
    drawn = [(line, line.step) for line in lines if isinstance(line.step, Diagram)]
    ((line, place),) = ((line, list(dict(step.labels)).index("U")) for line, step in drawn if "U" in dict(step.labels))
    signs = [change for change in changes(line.step) if change.where.startswith(f".labels[{place}]")]
    assert len(signs) == 4
    for change in signs:
        assert still_true(line.alone(change.value), line.alone(line.step)) is is_another, change.where


def test_every_line_of_a_random_design_holds_in_plain_fractions() -> None:
    # the rank on the stratum 2 k² + 9 k − 27 = 0, whose points are not rational
    assert is_true(symobs.observability(symobs.StateSpace("[k+1 1; -3 -2]", None, "[-k -3]")).derivation)
    # stable exactly where …, of an F that means nothing at k = −1
    plant = symobs.StateSpace("[1 1; -k 0]", "[-3; -2]", "[k+1 0]")
    assert is_true(symobs.compensator(plant, control_poles="-5/2, -3", observer_poles="-5/2, -3").derivation)


# -- sentences on another page -----------------------------------------------------------------------------------------


def _table(world: World, letter: str) -> Rows:
    if "−" in letter:
        first, second = (_table(world, name) for name in letter.split("−"))
        return plus(first, times(Fraction(-1), second))  # type: ignore[no-any-return]
    found: Rows = world.value(Letter(letter.rstrip("ᵀ")))
    return transposed(found) if letter.endswith("ᵀ") else found


def _is_seen(world: World, row: str, of: str) -> bool:
    A = _table(world, of)
    return rank_of(observability_rows(A, _table(world, row))) == len(A)


def _are_hidden(world: World, row: str, of: str, N: str, *_: str) -> bool:
    A, basis = _table(world, of), _table(world, N)
    rows = observability_rows(A, _table(world, row))
    return not any(map(any, multiply(rows, basis))) and rank_of(basis) == len(basis[0])


def _are_all_hidden(world: World, row: str, of: str, N: str, *_: str) -> bool:
    A = _table(world, of)
    count = len(A) - rank_of(observability_rows(A, _table(world, row)))
    return _are_hidden(world, row, of, N) and len(_table(world, N)[0]) == count


def _unstable_modes(world: World, row: str, of: str) -> int:
    """Count the eigenvalues on or beyond the boundary at which [A − λI; C] has no full column rank, in floats."""
    A, C = (np.array([[float(entry) for entry in line] for line in _table(world, name)]) for name in (of, row))
    values = np.linalg.eigvals(A)
    far = np.abs(values) - 1 if world.variable == "z" else values.real
    pencils = [
        np.vstack([A - value * np.eye(len(A)), C]) for value, side in zip(values, far, strict=True) if side > -1e-6
    ]
    return sum(1 for pencil in pencils if np.linalg.matrix_rank(pencil, 1e-6) < len(A))


#: What obligations say of their letters, in plain fractions at a point.
TRUTH: dict[str, Callable[..., bool]] = {
    "observable": _is_seen,
    "says_observable": _is_seen,
    "says_observable_everywhere": _is_seen,
    "unobservable": lambda world, *pair: not _is_seen(world, *pair),
    "says_unobservable": lambda world, *pair: not _is_seen(world, *pair),
    "says_unobservable_everywhere": lambda world, *pair: not _is_seen(world, *pair),
    "modes": lambda world, row, of, *letters: any(
        _are_all_hidden(world, row, of, N) for N in letters[::2] if N in world.letters
    ),
    "fixes": _are_hidden,
    "exhausts": _are_hidden,
    "modes_stable": lambda world, row, of, *_: _unstable_modes(world, row, of) == 0,
    "modes_unstable": lambda world, row, of, *_: _unstable_modes(world, row, of) > 0,
    "annuls": lambda world, row, by, *left: (
        any(map(any, _table(world, row)))
        and not any(map(any, multiply(_table(world, row), _table(world, by))))
        and all(any(map(any, multiply(_table(world, row), _table(world, each)))) for each in left)
    ),
    "one_rank": lambda world, C, E: rank_of(multiply(_table(world, C), _table(world, E))) == rank_of(_table(world, E)),
    "lower_rank": lambda world, C, E: rank_of(multiply(_table(world, C), _table(world, E))) < rank_of(_table(world, E)),
    "single": lambda world, row: len(_table(world, row)) == 1,
    "not_unique": lambda world, row, of: len(_table(world, row)) > 1 or not _is_seen(world, row, of),
    "zero": lambda world, *letters: not any(map(any, _table(world, next(n for n in letters if n in world.letters)))),
    "nonsingular": lambda world, letter: determinant(_table(world, letter)) != 0,
}


def _placed() -> Iterator[tuple[str, Step, Derivation]]:
    """Yield the steps of all worked examples, of cases too, whose sentences owe something of TRUTH."""
    for path in EXAMPLES:
        for result in results(path):
            for part in everything_in(result.derivation.steps):
                key = getattr(getattr(part, "sentence", None), "key", "")
                if {name for name, *_ in obligations(DEMANDS.get(key, ""))} & TRUTH.keys():
                    yield key, part, result.derivation


def test_a_sentence_on_the_page_of_another_plant_is_rejected_or_true() -> None:
    """Every sentence that says something of the letters of its page is moved to every other page that has these letters.

    So are the sentences of the dual, and those that no example has and that have no slots: theirs are the facts of others.
    """
    steps = {(key, type(step)): step for key, step, _ in _placed()}
    said = {key for key, _ in steps}
    steps |= {
        (key, Conclude): Conclude(Sentence(key))
        for key, owed in DEMANDS.items()
        if key not in said and not slots_of(key) and {name for name, *_ in obligations(owed)} <= TRUTH.keys()
    }
    pages = [result.derivation for path in EXAMPLES for result in results(path)]
    pages = [page for page in pages if page.variable != "t" and not page.start.relations]
    accepted, rejected, lies = 0, 0, []
    for page in pages:
        here = page.check()
        for (key, _), step in steps.items():
            owed = [each for each in obligations(DEMANDS[key]) if each[0] in TRUTH]
            if not {name.rstrip("ᵀ") for _, *pair in owed for name in pair[:2]} <= here.values.keys():
                continue
            try:
                replace(page, steps=(step,), start=here).check()
            except DerivationRejected:
                rejected += 1
                continue
            accepted += 1
            if not all(_is_so(each, World.of(here, seed)) for each in owed for seed in range(2)):
                lies.append(f"{key} where {plain_values(here)}")
    assert not lies
    assert accepted > 500
    assert rejected > 1000


def _is_so(obligation: Sequence[str], world: World) -> bool:
    """Tell whether an obligation is met at a point; not where its letters mean nothing, or no such matrices."""
    name, *letters = obligation
    try:
        return TRUTH[name](world, *letters)
    except (KeyError, TypeError, ValueError):
        return False


def plain_values(here: Environment) -> str:
    return ", ".join(f"{name} = {here.values[name]}" for name in "ABC" if name in here.values)


# -- lies that agree with each other -----------------------------------------------------------------------------------

HIDDEN = StateSpace("[-1 0; 0 -2]", "[0; 1]", "[0 1]")


def test_another_gain_with_its_own_polynomial_is_not_the_one_asked_for() -> None:
    asked, other = observer(SERVO, poles=[-1, -2]), observer(SERVO, poles=[-3, -4])
    with pytest.raises(CertificateRejected, match="asked for"):
        replace(asked, answer=other.answer)


def test_a_rank_cannot_be_lowered_with_its_witnesses() -> None:
    result = observability(SERVO)
    with pytest.raises(CertificateRejected):
        replace(result, answer={**result.answer, "rank": 1, "rows": (0,), "columns": (0,)})
    with pytest.raises(CertificateRejected):
        replace(result, answer={**result.answer, "rank": 0, "rows": (), "columns": ()})


def test_a_kernel_cannot_be_enlarged_by_a_dependent_vector() -> None:
    result = observability(HIDDEN)
    kernel, X = result.answer["kernel"], result.answer["restricted"]
    lie = result.answer | {
        "kernel": Matrix.block([[kernel, kernel]]),
        "free": (0, 1),
        "rank": 0,
        "rows": (),
        "columns": (),
    }
    with pytest.raises(CertificateRejected):
        replace(result, answer={**lie, "restricted": Matrix.block([[X, X * 0], [X * 0, X]])})


def test_a_compensator_cannot_be_denied_nor_made_of_other_gains() -> None:
    asked = compensator(SERVO, control_poles=[-1, -1], observer_poles=[-2, -2])
    other = compensator(SERVO, control_poles=[-3, -3], observer_poles=[-4, -4])
    with pytest.raises(CertificateRejected):
        replace(asked, answer={**asked.answer, "F": None})
    with pytest.raises(CertificateRejected):
        replace(asked, answer=other.answer)


@tabled
def test_a_compensator_cannot_be_made_of_gains_for_another_plant(observer: str, poles: list[int]) -> None:
    """F may follow from the gains: the polynomial of the loop is false all the same."""
    rest = ("[0 0; 1 0; 0 0; 0 1]", "[1 0 0 0; 0 0 1 0]")
    own = StateSpace("[0 1 0 0; 2 0 1 0; 0 0 0 1; 1 0 -1 0]", *rest)
    foreign = StateSpace("[0 1 0 0; 3 0 1 0; 0 0 0 1; 1 0 -1 0]", *rest)
    wishes: dict[str, Any] = {"control_poles": [-1, -2, -2, -3], "observer_poles": poles, "observer": observer}
    asked, other = (compensator(plant, **wishes) for plant in (own, foreign))
    assert isinstance(other, OutputFeedback)
    for name, part in (("feedback", other.feedback), ("estimator", other.estimator)):
        gain = {part.letter: part.answer[part.letter]}
        with pytest.raises(CertificateRejected, match="another plant"):
            replace(asked, answer={**asked.answer, **gain}, **{name: part})  # type: ignore[arg-type]


def test_a_kernel_is_no_basis_when_a_column_is_zero() -> None:
    """Over Q(k, m) the determinant of a single row was taken for that of a minor."""
    plant = StateSpace("[1 k/m; 0 0]", "[k/m; 0]", "[0 1]")
    (case,) = (case for case in state_feedback(plant, poles=["-1+2i", "-1-2i"]).case_tree if case.result is not None)
    impossible = case.result
    assert isinstance(impossible, GainDesign)
    assert impossible.answer["K"] is None
    for column in range(2):
        kernel = Matrix.of([[Scalar.of(int(i == j != column)) for j in range(2)] for i in range(2)])
        pair = tampered(impossible.pair, "kernel", kernel * (Scalar.symbol("k") / Scalar.symbol("k")))
        with pytest.raises(CertificateRejected):
            tampered(impossible, "pair", pair).__post_init__()


def test_a_determinant_is_that_of_a_square() -> None:
    for entry in (Scalar.of(1), Scalar.symbol("k")):
        with pytest.raises(ValueError):  # noqa: PT011 - FLINT's own message where there is no parameter
            Matrix.of([[entry, Scalar.of(0)]]).determinant()


def test_impossibility_needs_a_subspace_of_the_plant_itself() -> None:
    impossible = observer(HIDDEN, poles=[-3, -4])
    assert isinstance(impossible, GainDesign)
    assert impossible.answer["L"] is None
    nothing = tampered(impossible.pair, "kernel", Matrix.zeros(2, 1))
    with pytest.raises(CertificateRejected):
        tampered(impossible, "pair", nothing).__post_init__()
    possible = observer(SERVO, poles=[-3, -4])
    foreign = tampered(tampered(possible, "answer", impossible.answer), "pair", impossible.pair)
    with pytest.raises(CertificateRejected):
        replace(possible, pair=impossible.pair)
    with pytest.raises(CertificateRejected):
        foreign.__post_init__()


def test_a_page_cannot_speak_of_another_plant() -> None:
    result = observability(SERVO)
    other = StateSpace("[0 1; 0 -3]", "[0; 1]", "[1 0]")
    result.derivation.check()

    def write(page: Builder) -> None:
        aside = Builder(other)
        observability(other).write(aside)
        page.steps = aside.steps

    liar = tampered(result, "write", write)
    liar.__dict__.pop("derivation")
    with pytest.raises(DerivationRejected, match="another A"):
        _ = liar.derivation


@pytest.mark.parametrize("name", ["hoop_equilibria", "hoop_over_its_speed", "predator_and_prey"])
@pytest.mark.parametrize("operator", ["<", ">=", "!=", "="])
def test_the_case_of_an_equilibrium_is_where_it_is_real_and_has_its_signs(name: str, operator: str) -> None:
    (result,) = results_of(name)

    def turned(steps: tuple[Any, ...]) -> tuple[Any, ...]:
        for place, step in enumerate(steps):
            if isinstance(step, CaseStep) and isinstance(step.when, Relation):
                return (
                    *steps[:place],
                    replace(step, when=replace(step.when, operators=(operator,))),
                    *steps[place + 1 :],
                )
            if isinstance(step, Section) and (inside := turned(step.steps)) != step.steps:
                return (*steps[:place], replace(step, steps=inside), *steps[place + 1 :])
        return steps

    result.derivation.check()
    with pytest.raises(DerivationRejected):
        replace(result.derivation, steps=turned(result.derivation.steps)).check()


def test_a_declared_sign_is_seen_in_a_denominator() -> None:
    """x = 1/(a + b) < 0 is one where a + b < 0: the case stays, without a warning that it failed its check."""
    (result,) = read(
        'task = "equilibria"\n[symbols]\na = "real"\nb = "real"\nx = "negative"\n'
        '[plant]\nstates = ["x"]\nf = ["1 - a*x - b*x"]\nh = ["x"]\n',
        "signs.toml",
    ).solve()
    assert "-a - b > 0" in result.to("text").replace("−", "-")
