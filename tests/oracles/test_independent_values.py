"""Every value of the worked examples' derivations and answers equals a computation with plain SymPy matrices.

The problems come from `problems_by_hand`, written a second time; derivations are read by `second_reader`.
"""

from __future__ import annotations

import itertools
from typing import TYPE_CHECKING, Any

import pytest
import sympy

from symobs.formula.expression import parse_scalar
from symobs.proof.derivation import CaseStep
from symobs.proof.derivation.steps import everything_in
from symobs.tasks.result.output_methods import to_sympy
from tests.support.examples import results_of
from tests.support.paths import ROOT
from tests.support.problems.problems_by_hand import (
    BY_HAND,
    CLAIMED,
    FAMILIES,
    FREE_ENTRIES,
    Disturbed,
    Integral,
    MinimalOrder,
    Modelled,
    canonical_transformation,
    characteristic,
    common_denominator,
    compare,
    entries,
    fixed,
    inverse,
    is_stable,
    is_zero,
    modes,
    observability_matrix,
    sylvester_letters,
)
from tests.support.problems.problems_by_hand import (
    hand as hand_of,
)
from tests.support.problems.problems_by_hand import points as points_of
from tests.support.problems.problems_in_time import NAMES_IN_TIME, VARYING
from tests.support.sampling import every
from tests.support.second_reader import Reader, sympy_scalar, walks

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Mapping

    from tests.support.problems.problems_by_hand import Hand

pytestmark = pytest.mark.slow

FOLDER = ROOT / "worked_examples"


def points(name: str, count: int) -> Iterator[dict[Any, Any]]:
    return points_of(name, hand_of(name), count)


def known_letters(hand: Hand) -> dict[str, Any]:
    """Return what the letters of a derivation must be worth."""
    if isinstance(hand, (MinimalOrder, Integral, Disturbed, Modelled)):
        return hand.letters()
    A, B, C, s_ = hand.A, hand.B, hand.C, hand.variable
    known: dict[str, Any] = {"A": A, "chi": characteristic(A, s_), "D": hand.feedthrough, **hand.functions}
    rates = {"x": A}
    if B is not None:
        reach = observability_matrix(A.T, B.T).T
        known |= {"B": B, "Ctr": reach}
        rates["u"] = B
        if hand.control is not None or hand.K is not None:
            known |= {"K": hand.feedback_gain, **entries("k", hand.feedback_gain)}
            if B.cols > 1:
                known |= sylvester_letters(A, B, hand.feedback_gain, hand.control, s_, "c")
            else:
                known |= {"V_c": canonical_transformation(A, reach, s_), "q_c": inverse(reach)[-1, :]}
    if C is not None:
        seen = observability_matrix(A, C)
        known |= {"C": C, "O": seen}
        known["y"] = {"x": C, "u": hand.feedthrough} if hand.D is not None else {"x": C}
        if hand.observer is not None or hand.L is not None:
            known |= {"L": hand.observer_gain, **entries("l", hand.observer_gain), **entries("h", hand.observer_gain)}
            if C.rows > 1:
                known |= sylvester_letters(A.T, C.T, hand.observer_gain.T, hand.observer, s_, "o")
            else:
                known |= {"V_o": canonical_transformation(A, seen.T, s_), "q_o": inverse(seen)[:, -1]}
            innovation = hand.observer_gain * C
            copy = {"x_hat": A - innovation, "x": innovation}
            known["x_hat'"] = copy if B is None else copy | {"u": B}
            known["e"] = {"x": sympy.eye(A.rows), "x_hat": -sympy.eye(A.rows)}
            known["y_hat"] = {"x_hat": C}
            known |= {f"x_hat_{k + 1}": {"x_hat": sympy.eye(A.rows)[k, :]} for k in range(A.rows)}
    known["x'"] = rates
    for letter, stem, polynomial in (("phi_c", "alpha_", hand.control), ("phi_o", "beta_", hand.observer)):
        if polynomial is not None:
            known |= {letter: polynomial, f"{letter}_at": polynomial}
            coefficients = sympy.Poly(polynomial, s_).all_coeffs()
            known |= {f"{stem}{k}": coefficients[k] for k in range(1, len(coefficients))}
    if B is not None and C is not None:
        known["P"] = hand.plant_transfer
    if hand.advice is not None:
        known |= advised_letters(hand)
    if "K" in known and "L" in known:
        known |= letters_of_loop(hand)
    if "L" in known and "K" not in known and B is not None:
        L = hand.observer_gain
        known |= {"F_x": A - L * C, "G_x": B - L * hand.feedthrough, "H_x": L}
        known |= entries("f", known["F_x"]) | entries("g", known["G_x"]) | entries("h", L)
    if hand.follows:
        F = hand.gain_at_rest.inv()
        known |= {"F_v": F, "G_0": hand.gain_at_rest, "T_v": hand.followed}
        known["u"] = {"x" if hand.observer is None else "x_hat": -hand.feedback_gain, "v_r": F}
    return known


def letters_of_loop(hand: Hand) -> dict[str, Any]:
    """Return the letters of compensator and loop."""
    B, C, s_ = hand.B, hand.C, hand.variable
    known: dict[str, Any] = {
        "A_c": hand.compensator_matrix,
        "F": hand.compensator,
        "A_cl": hand.loop_matrix,
        "G_cl": hand.loop,
        "G_r": hand.unity_loop,
        "u": {"x_hat": -hand.feedback_gain},
    }
    if B.cols == C.rows == 1:
        above, below = (sympy.Poly(part, s_) for part in hand.compensator.as_numer_denom())
        for stem, part in (("n", above), ("d", below)):
            ascending = [value / below.LC() for value in reversed(part.all_coeffs())]
            known |= {f"{stem}_{k}": value for k, value in enumerate(ascending)}
    return known


def advised_letters(hand: Hand) -> dict[str, Any]:
    """Return the letters of a page on where to put poles."""
    advice = hand.advice
    assert advice is not None
    known = {"b_P": sympy.cancel(hand.plant_transfer * characteristic(hand.A, hand.variable))}
    known |= {"phi_z": advice.zeros, "phi_r": advice.rest, "phi_o": advice.zeros * advice.rest}
    known |= {"b_P_at": known["b_P"], "phi_r_at": known["phi_r"]}
    if advice.settling_time is not None:
        known |= {"T_s": advice.settling_time, "M_p": advice.overshoot}
        known |= {"sigma_d": 4 / advice.settling_time, "omega_d": advice.omega_d}
    return known


def known_to(name: str) -> Callable[[Reader], Mapping[str, Any]]:
    """Return how the letters of a page are known where a reader stands: in symbols, or found anew where these are many."""
    hand = hand_of(name)
    if not hand.large and not isinstance(hand, (Integral, Disturbed, Modelled)):
        in_symbols = known_letters(hand)
        return lambda _: in_symbols
    found: dict[tuple[Any, ...], Mapping[str, Any]] = {}

    def known(reader: Reader) -> Mapping[str, Any]:
        point = reader.point(map(sympy.Symbol, hand.signs))
        key = tuple(point.values())
        if key not in found:
            found[key] = known_letters(hand.at(point))
        return found[key]

    return known


@pytest.mark.parametrize("name", every(4, BY_HAND))
def test_every_line_of_every_derivation(name: str) -> None:
    hand = hand_of(name)
    for result in results_of(name):
        cases = [part for part in everything_in(result.derivation.steps) if isinstance(part, CaseStep)]
        seen = list[CaseStep]()
        free = FREE_ENTRIES if hand.is_several else {}
        for reader, told in walks(result.derivation, known_to(name), range(6 if cases and not hand.large else 2), free):
            assert reader.compared
            assert set(reader.unknown) <= WITNESSES, "every other letter has an independent value"
            said_and_assumed(hand, reader, told)
            seen += reader.cases
        assert all(any(case is met for met in seen) for case in cases)


def is_positive(factor: sympy.Poly, signs: Mapping[str, str]) -> bool:
    """Whether a factor is a sum of positive terms with a constant one."""
    positive = {signs.get(str(name)) for name in factor.free_symbols} == {"positive"}
    return positive and all(c > 0 for c in factor.coeffs()) and factor.eval(dict.fromkeys(factor.gens, 0)) > 0


def said_and_assumed(hand: Hand, reader: Reader, told: list[tuple[str, Any]]) -> None:
    """Hold what sentences mention, and what is assumed from some line on, against the problem."""
    words = ""
    for kind, content in told:
        words = content if kind == "words" else words
        if kind == "shown":  # the transients of a repeated pole
            assert words in {"defective", "defective_instead"}
            assert sympy.discriminant(hand.control, hand.variable) == 0
    if reader.assumed:
        left, right = ([sympy_scalar(r.members[k].value, {}) for r in reader.assumed] for k in (0, 1))  # type: ignore[union-attr, arg-type]
        above = sympy.Poly(sympy.fraction(sympy.cancel(hand.decisive))[0], *sorted(hand.decisive.free_symbols, key=str))
        assert {sympy.Poly(a - b, *above.gens).monic() for a, b in zip(left, right, strict=True)} == {
            factor.monic() for factor, _ in above.factor_list()[1] if not is_positive(factor, hand.signs)
        }


def repairs(A: Any, C: Any) -> tuple[tuple[int, ...], ...]:
    """Return the smallest sets of states, counted from 1, whose measurement beside C makes A observable."""
    for count in range(A.rows + 1):
        found = []
        for states in itertools.combinations(range(A.rows), count):
            measured = sympy.eye(A.rows).extract(list(states), list(range(A.rows)))
            if observability_matrix(A, C.col_join(measured)).rank() == A.rows:
                found.append(tuple(state + 1 for state in states))
        if found:
            return tuple(found) if count else ()
    return ()


# -- answers -----------------------------------------------------------------------------------------------------------


def answers(hand: Hand, task: str) -> dict[str, Any]:
    """Return every field of a task's answer by the textbook's formula."""
    if isinstance(hand, (MinimalOrder, Integral, Disturbed, Modelled)):
        return hand.answers(task)
    A, B, C, variable = hand.A, hand.B, hand.C, hand.variable
    match task:
        case "observability":
            test = observability_matrix(A, C)
            return {
                "matrix": test,
                "rank": test.rank(),
                "kernel": tuple(tuple(v) for v in test.nullspace()),
                "unobservable_modes": tuple(sympy.roots(fixed(A, C, variable), variable, multiple=True)),
                "determinant": test.det() if test.is_square else None,
                "missing_measurements": repairs(A, C),
            }
        case "pbh" | "detectability" | "stabilizability":
            pair = (A.T, B.T) if task == "stabilizability" else (A, C)
            return {
                "modes": modes(*pair),
                "fixed_polynomial": fixed(*pair, variable),
                "polynomial": characteristic(A, variable),
            }
        case "dual":
            return dual_answers(hand)
        case "canonical_form":
            T = canonical_transformation(A.T, observability_matrix(A, C).T, variable).T
            moved = {"T": T, "A": T * A * T.inv(), "B": T * B, "C": C * T.inv(), "D": hand.feedthrough}
            return moved | {"polynomial": characteristic(A, variable)}
        case "decomposition":
            reach = observability_matrix(A.T, B.T).T
            order = (observability_matrix(A, C) * reach).rank()
            return {"transfer_function": sympy.cancel(hand.plant_transfer), "minimal_order": order}
        case "controllability":
            test = observability_matrix(A.T, B.T).T
            return {
                "matrix": test,
                "rank": test.rank(),
                "kernel": (),
                "uncontrollable_modes": (),
                "determinant": test.det(),
                "missing_inputs": repairs(A.T, B.T),
            }
        case "characteristic_polynomial":
            polynomial = characteristic(A, variable)
            return {"polynomial": polynomial, "factors": polynomial, "roots": polynomial}
        case "transfer_function":
            above, below = hand.plant_transfer.as_numer_denom()
            return {"transfer_function": hand.plant_transfer, "poles": below, "zeros": above}
        case "pole_advice":
            known = advised_letters(hand)
            found = {"polynomial": known["phi_o"], "poles": known["phi_o"], "zeros_used": known["phi_z"]}
            return found | {{"sigma_d": "sigma"}.get(n, n): known[n] for n in ("sigma_d", "omega_d") if n in known}
        case "observer":
            polynomial = characteristic(A - hand.observer_gain * C, variable)
            driven = None if B is None else B - hand.observer_gain * hand.feedthrough
            own = {"L": hand.observer_gain, "A": A - hand.observer_gain * C, "B_u": driven, "B_y": hand.observer_gain}
        case "feedforward":
            whole = {"polynomial": characteristic(hand.loop_matrix, variable), "closed_loop_matrix": hand.loop_matrix}
            gains = {"K": hand.feedback_gain} | ({} if hand.observer is None else {"L": hand.observer_gain})
            return gains | whole | {"F": hand.gain_at_rest.inv()[0], "transfer_function": hand.followed}
        case "state_feedback":
            polynomial = characteristic(A - B * hand.feedback_gain, variable)
            own = {"K": hand.feedback_gain, "closed_loop_matrix": A - B * hand.feedback_gain}
        case _:
            return {
                "K": hand.feedback_gain,
                "L": hand.observer_gain,
                "F": hand.compensator,
                "compensator_matrix": hand.compensator_matrix,
                "closed_loop": hand.loop,
                "closed_loop_unity": hand.unity_loop,
                "closed_loop_polynomial": characteristic(hand.loop_matrix, variable),
                "closed_loop_matrix": hand.loop_matrix,
                "closed_loop_matrix_estimate": hand.loop_matrix_estimate,
                "family": hand.families,
            }
    return own | {"polynomial": polynomial, "poles": polynomial, "fixed_modes": (), "family": None}


def dual_answers(hand: Hand) -> dict[str, Any]:
    A, B, C = hand.A, hand.B, hand.C
    found = {"A": hand.sign * A.T, "B": C.T, "C": B.T, "D": hand.feedthrough.T, "sign": hand.sign}
    found["observability_rank"] = observability_matrix(A, C).rank()
    found["controllability_rank"] = observability_matrix(A.T, B.T).rank()
    found["dual_controllability_rank"] = observability_matrix(hand.sign * A, C).rank()
    found["dual_observability_rank"] = observability_matrix(hand.sign * A.T, B.T).rank()
    return found


#: Fields that list the roots of the polynomial (or rational function's part) that stands in `answers`.
ROOTS = {"roots", "poles", "zeros", "zeros_used"}
#: Verdicts about stability, which `test_verdicts_of_stability` decides by numeric roots.
#: Letters of a case that are free to choose: a basis N of the kernel and X with A N = N X, which the page states.
#: With row reduction the null vectors, of which f Psi^-1 is the gain.
WITNESSES = {
    "N",
    "X",
    "N_K",
    "X_K",
    "w_0",
    "mu",
    "S",
    "T",
    *(f"{part}_{of}" for part in "ABCO" for of in ("bar", "co", "dual")),
    "Ctr_dual",
}
WITNESSES |= {"Psi", "f_psi", *(f"xi_{k}{i}" for k in range(1, 5) for i in ("", *range(1, 9)))}
VERDICTS = {"stable", "stable_if", "F_stable", "F_stable_if", "compensator_stable"}
#: What was asked for, the basis of a decomposition and what it makes of the plant: `test_modes` holds these to identities.
#: Warnings are texts, which `test_pole_advice` holds to plants that call for them.
FREE = {
    "pbh": {"of"},
    "detectability": {"meaning", "rank"},
    "stabilizability": {"meaning", "rank"},
    "canonical_form": {"kind"},
    "decomposition": {*"TABCD", "sizes"},
    "pole_advice": {"warnings"},
    "unknown_input_observer": {"family"},
}


@pytest.mark.parametrize("name", every(4, BY_HAND, 1))
def test_every_answer(name: str) -> None:
    hand = hand_of(name)
    for result in results_of(name):
        for point in points(name, 2) if hand.large else [{}]:
            expected = answers(hand.at(point), result.task)
            if result.task == "compensator" and "poles" in result.fields:  # found for given gains
                expected = {**expected, "poles": expected["closed_loop_polynomial"]}
            free = FREE.get(result.task, set())
            assert set(result.fields) == set(expected) | ((VERDICTS | free) & set(result.fields))
            for field_name, wanted in expected.items():
                found = to_sympy(result.fields[field_name], {})
                assert same(field_name, found, wanted, hand.variable, point), (result.task, field_name, found, wanted)


def same(field_name: str, found: Any, wanted: Any, variable: Any, point: Mapping[Any, Any]) -> bool:
    if field_name in ROOTS:
        product = sympy.prod(variable - root.xreplace(point) for root in found)
        return is_zero(product - sympy.Poly(wanted, variable).monic().as_expr())
    if field_name == "modes":
        told = [(mode["eigenvalue"], mode["rank"]) for mode in found]
        return sorted(told, key=str) == sorted(((sympy.expand(v), r) for v, r in wanted), key=str)
    if field_name == "factors":
        return is_zero(sympy.prod(factor**power for factor, power in found) - wanted)
    if field_name == "family" and found is not None:
        return is_family(found, wanted, variable)
    if isinstance(found, tuple) and isinstance(wanted, sympy.MatrixBase):
        found = sympy.Matrix(found)
    if isinstance(found, sympy.MatrixBase):
        return found.shape == wanted.shape and all(map(is_zero, found.xreplace(point) - wanted))
    if isinstance(found, sympy.Expr):
        return is_zero(found.xreplace(point) - wanted)
    return bool(found == wanted)


def is_family(found: Mapping[str, Any], wanted: Mapping[str, Any], variable: Any) -> bool:
    """Tell whether members of the families of gains have the polynomials wanted: (A, B, polynomial) of each letter."""
    for letter, (A, B, polynomial) in wanted.items():
        general = found[letter][letter]
        if general is None:  # too large to be given
            continue
        names = list(map(sympy.Symbol, found[letter]["parameters"]))
        assert general.free_symbols == set(names)
        for draw in range(3):
            member = general.subs({name: sympy.Rational(7 * k + draw, 5 + 2 * draw) for k, name in enumerate(names)})
            moved = B * (member if letter == "K" else member.T)
            if not is_zero(characteristic(A - moved, variable) - polynomial):
                return False
    return set(found) == set(wanted)


def test_attributes_are_never_of_the_kernel() -> None:
    for name in BY_HAND:
        for result in results_of(name):
            for field_name in result.fields:
                assert not type(getattr(result, field_name)).__module__.startswith("symobs"), field_name


@pytest.mark.parametrize("name", every(4, BY_HAND))
def test_verdicts_of_stability(name: str) -> None:
    """Hold verdicts, and the inequalities that come with them, against numeric roots at sample points."""
    asked = ("stable", "F_stable", "compensator_stable")
    for result, verdict in ((result, name) for result in results_of(name) for name in asked if name in result.fields):
        seen = set()
        for point in points(name, 10 if hand_of(name).large else 60):
            hand = hand_of(name).at(point)
            if verdict == "F_stable":
                polynomial = common_denominator(hand.compensator)
            elif verdict == "compensator_stable":
                polynomial = characteristic(hand.compensator_matrix, hand.variable)
            else:
                expected = answers(hand, result.task)
                polynomial = expected.get("polynomial", expected.get("closed_loop_polynomial"))
            stable = is_stable(polynomial, hand.variable, discrete=hand.discrete)
            where = result.fields.get("stable_if")
            assert where is None or stable == all(true_at(relation, point) for relation in where)
            seen.add(stable)
        outcome = "conditional" if len(seen) == 2 else "yes" if seen == {True} else "no"
        assert result.fields[verdict] == outcome


def true_at(relation: str, point: Mapping[Any, Any]) -> bool:
    if relation == "False":
        return False
    left, operator, right = relation.partition("<" if "<" in relation else ">")
    names = {str(parameter): value for parameter, value in point.items()}
    return compare(sympy_scalar(parse_scalar(left), names) - sympy_scalar(parse_scalar(right), names), operator)


#: Regions are held to the roots at points, and to QEPCAD: see `test_region_points` and `regions_in_plain_fractions`.
REGIONS = {path.stem for path in FOLDER.glob("*.toml") if "stability_region" in path.read_text("utf-8")}


def test_every_worked_example_is_written_out_here() -> None:
    written = {*BY_HAND, *NAMES_IN_TIME, *VARYING, *FAMILIES, *REGIONS, *CLAIMED}
    assert {path.stem for path in FOLDER.glob("*.toml")} == written
