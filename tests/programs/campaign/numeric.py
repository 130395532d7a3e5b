"""What an answer says in numbers, and how it is held against what a numeric system finds.

`claims` lists what is said, under names, and what the other system starts from.  The other system works everything out
again from slightly shaken data: how far its numbers then move is what they are worth, and where they move too far it
could not tell.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

from tests.programs.campaign.asked import Untold, rows
from tests.programs.campaign.numbers import UnreadableError, array, real, value
from tests.programs.campaign.numeric_cases import at_a_point

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    from tests.programs.campaign.asked import Asked, Difference, Tables
    from tests.programs.campaign.numbers import Numbers
    from tests.programs.campaign.numeric_cases import Case

#: Where transfer functions are compared, and times at which functions of time are.
PLACES = (1.3 + 0.7j, -0.6 + 2.1j, 0.45 + 0j)
TIMES = (0.4, 0.9)

#: By how much data are shaken, relative to the largest entry of a matrix, and how often.
SHAKEN = 1e-13
COPIES = 1

_WORTH = 1000  # what the numbers may be off by, in units of how far they moved
_ROUNDING = 1e-11
_WORTHLESS = 1e-3  # relative to the largest entry
_ZERO, _NONZERO = 1e-10, 1e-7  # of singular values, relative to the largest
_NOTHING = 1e-4  # the largest singular value of what is not 0 but for rounding, entries being about 1


@dataclass
class Claims:
    """`values` are compared, `ranks` with singular values; `given` is shaken, `exact` is not."""

    given: dict[str, Numbers] = field(default_factory=dict)
    exact: dict[str, Numbers] = field(default_factory=dict)
    values: dict[str, Numbers] = field(default_factory=dict)
    ranks: dict[str, int] = field(default_factory=dict)
    #: What the answer contradicts itself in, its ranks being right.
    wrong: list[str] = field(default_factory=list)


Found = dict[str, "Numbers"]


def compared(claims: Claims, found: Sequence[Found]) -> Difference:
    """Hold what is claimed against what was found, first from the data themselves, then from shaken ones."""
    if claims.wrong:
        return claims.wrong[0]
    untold: Untold | None = None
    first, *others = found
    for name in first:
        copies = [copy.get(name) for copy in others]
        if any(copy is None or copy.shape != first[name].shape for copy in copies):
            untold = untold or Untold(f"{name} depends on rounding")
            continue
        values = [copy for copy in copies if copy is not None]
        if name in claims.ranks:
            judged = _rank(name, claims.ranks[name], first[name])
        elif name in claims.values:
            judged = _same(name, claims.values[name], first[name], values)
        else:
            continue
        if isinstance(judged, str):
            return judged
        untold = untold or judged
    if untold is None and not any(name in claims.ranks or name in claims.values for name in first):
        return Untold("nothing was found to compare")
    return untold


def _rank(name: str, claimed: int, singular: Numbers) -> Difference:
    sizes = np.abs(singular).ravel()
    top = sizes.max(initial=0.0)
    if not np.isfinite(top):
        return Untold(f"{name} is not finite")
    relative = sizes / max(top, _NOTHING)
    if np.any((relative > _ZERO) & (relative < _NONZERO)):
        return Untold(f"{name} is not clear")
    there = int(np.sum(relative >= _NONZERO))
    return None if there == claimed else f"{name} is {there}, not {claimed}"


def _same(name: str, ours: Numbers, theirs: Numbers, shaken: Sequence[Numbers]) -> Difference:
    if not np.all(np.isfinite(theirs)):
        return Untold(f"{name} is not finite")
    if ours.shape != theirs.shape:
        return f"{name} has the shape {theirs.shape}, not {ours.shape}"
    if not ours.size:
        return None
    moved = np.max([np.abs(copy - theirs) for copy in shaken], axis=0)
    size = float(np.abs(theirs).max())
    bars = _WORTH * np.maximum(moved, moved.max() / 10) + _ROUNDING * (1 + size)
    if not bars.max() < _WORTHLESS * max(1.0, size):
        return Untold(f"{name} is ill-conditioned")
    excess = np.abs(ours - theirs) / bars
    if np.all(excess <= 1):
        return None
    i, j = np.unravel_index(int(excess.argmax()), excess.shape)
    return f"{name}[{i}, {j}] is {theirs[i, j]:.12g}, not {ours[i, j]:.12g} (within {bars[i, j]:.1g})"


# -- what is claimed ---------------------------------------------------------------------------------------------------


def prepared(asked: Asked) -> tuple[Case, Claims] | Untold:
    """Return an answer at a point and what it says there; worked out once for all systems that judge it."""
    known = _KEPT.get(id(asked))
    if known is None or known[0] is not asked:
        if len(_KEPT) > _MOST_KEPT:
            _KEPT.clear()
        known = _KEPT[id(asked)] = asked, _prepared(asked)
    return known[1]


_LONG = 3000  # characters of a family's gain, beyond which none of its members is judged
_MOST_KEPT = 2000
_KEPT: dict[int, tuple[Asked, tuple[Case, Claims] | Untold]] = {}


def _prepared(asked: Asked) -> tuple[Case, Claims] | Untold:
    case = at_a_point(asked)
    if isinstance(case, Untold):
        return case
    claims = Claims()
    try:
        _CLAIMS[case.task](case, claims)
    except (UnreadableError, ZeroDivisionError) as error:
        return Untold(f"not read: {error}")
    if not claims.values and not claims.ranks and not claims.wrong:
        return Untold("the answer holds nothing to judge in numbers")
    return case, claims


def covered(problem: Tables) -> bool:
    """Tell whether there are claims for the task."""
    return problem["task"] in _CLAIMS


def _plant(case: Case, claims: Claims, letters: str = "ABCD") -> int:
    for letter in letters:
        claims.given[letter] = case.plant(letter)
    return int(claims.given["A"].shape[0])


def _rank_test(case: Case, claims: Claims) -> None:
    observed = case.task == "observability"
    order = _plant(case, claims, "AC" if observed else "AB")
    if not case.has("matrix"):
        return
    matrix = case.matrix("matrix")
    claims.values["matrix"] = matrix
    claims.ranks["rank"] = rank = int(case.answer["rank"])
    kernel = np.array([case.row(each)[0] for each in case.answer["kernel"]]).reshape(-1, order).T
    claims.exact["N"] = kernel
    claims.values["kernel"] = np.zeros((matrix.shape[0] if observed else matrix.shape[1], kernel.shape[1]))
    claims.ranks["kernel's rank"] = order - rank
    modes = case.answer["unobservable_modes" if observed else "uncontrollable_modes"]
    claims.values["hidden"] = case.polynomial_of(modes)
    if case.has("determinant"):
        _determinant(case, claims, matrix)
    if len(kernel.T) != order - rank:
        claims.wrong.append(f"{len(kernel.T)} vectors span the kernel of a matrix of rank {rank} and order {order}")
    if case.verdict in {"yes", "no"} and (case.verdict == "yes") != (rank == order):
        claims.wrong.append(f"the verdict is {case.verdict}, the rank {rank}, the order {order}")


def _determinant(case: Case, claims: Claims, matrix: Numbers) -> None:
    """The determinant in units of what rounding is relative to: the norm to the power of the order."""
    size = max(float(np.linalg.norm(matrix)), 1e-6) ** len(matrix)
    claims.exact["size"] = np.array([[complex(size)]])
    claims.values["determinant"] = case.row([case.answer["determinant"]]) / size


def _modes(case: Case, claims: Claims) -> None:
    of = case.specification.get("of", "observability")
    observed = case.task == "detectability" or (case.task == "pbh" and of == "observability")
    order = _plant(case, claims, "AC" if observed else "AB")
    modes = case.answer["modes"]
    numbers = [case.number(mode["eigenvalue"]) for mode in modes]
    claims.exact["modes"] = np.array([[complex(number) for number in numbers]]).reshape(1, -1)
    claims.values["polynomial"] = case.polynomial_of([mode["eigenvalue"] for mode in modes])
    claims.values["hidden"] = case.polynomial(case.answer["fixed_polynomial"])
    claims.values["polynomial as said"] = case.polynomial(case.answer["polynomial"])
    if "rank" in case.answer:
        claims.ranks["rank"] = int(case.answer["rank"])
    flag = "observable" if observed else "controllable"
    fixed_stable = True
    for k, (mode, number) in enumerate(zip(modes, numbers, strict=True)):
        claims.ranks[f"rank at mode {k + 1}"] = int(mode["rank"])
        if mode[flag] != (mode["rank"] == order):
            claims.wrong.append(f"{flag} is {mode[flag]} at rank {mode['rank']}")
        inside = 1 - abs(number) if case.discrete else -real(number.real)
        if abs(inside) > real(10) ** -30 and case.specification.get("meaning") != "lyapunov":
            fixed_stable = fixed_stable and (mode[flag] or inside > 0)
            if mode["stable"] in {True, False} and mode["stable"] != (inside > 0):
                claims.wrong.append(f"stable is {mode['stable']} at {mode['eigenvalue']}")
        if "matrix" in mode:
            claims.values[f"matrix at mode {k + 1}"] = array(mode["matrix"], 0, case.point)
    if case.asked.verdict in {"yes", "no"} and not fixed_stable and case.asked.verdict == "yes" and case.task != "pbh":
        claims.wrong.append("the verdict is yes, and a mode that is not seen is not stable")


def _characteristic_polynomial(case: Case, claims: Claims) -> None:
    _plant(case, claims, "A")
    claims.values["polynomial"] = case.polynomial(case.answer["polynomial"])
    claims.values["polynomial of the roots"] = case.polynomial_of(case.answer["roots"])


def _transfer_function(case: Case, claims: Claims) -> None:
    _plant(case, claims)
    claims.values["values"] = case.values(case.answer["transfer_function"], PLACES)
    if case.point and claims.given["D"].size > 1:
        return  # of several inputs or outputs poles and zeros are those of the parameters in general
    if case.answer.get("poles") is not None:
        claims.values["poles"] = case.polynomial_of(case.answer["poles"])
    if case.answer.get("zeros") is not None and claims.given["D"].size == 1 and claims.values["values"].any():
        claims.values["zeros"] = case.polynomial_of(case.answer["zeros"])


def _canonical_form(case: Case, claims: Claims) -> None:
    order = _plant(case, claims)
    kind = case.specification["kind"]
    if case.has("polynomial"):
        claims.values["polynomial"] = case.polynomial(case.answer["polynomial"])
    if not case.has("T"):
        if kind in {"controllable", "observable"} and case.verdict == "yes":
            claims.wrong.append("the verdict is yes, and there is no T")
        elif kind in {"controllable", "observable"}:
            claims.values[f"not {kind}"] = np.ones((1, 1))
        return
    T = claims.given["T"] = case.matrix("T")
    for letter in "ABCD":
        claims.values[f"new {letter}"] = case.matrix(letter, 1)
    claims.ranks["rank of T"] = order
    if kind == "controllable":
        claims.values["controllable companion"] = claims.values["new A"]
        claims.values["controllable input"] = claims.values["new B"]
    if kind == "observable":
        claims.values["observable companion"] = claims.values["new A"]
        claims.values["observable output"] = claims.values["new C"]
    if T.shape != (order, order):
        claims.wrong.append(f"T has the shape {T.shape}")


def _dual(case: Case, claims: Claims) -> None:
    _plant(case, claims)
    claims.exact["sign"] = np.array([[complex(case.specification.get("sign", 1))]])
    for letter in "ABCD":
        claims.values[f"new {letter}"] = case.matrix(letter, 1)
    for kind in ("observability", "controllability"):
        claims.ranks[kind] = int(case.answer[f"{kind}_rank"])
        claims.ranks[f"dual {kind}"] = int(case.answer[f"dual_{kind}_rank"])


def _decomposition(case: Case, claims: Claims) -> None:
    order = _plant(case, claims)
    claims.given["T"] = case.matrix("T")
    for letter in "ABCD":
        claims.values[f"new {letter}"] = case.matrix(letter, 1)
    sizes = case.answer["sizes"]
    co, c_no, nc_o, nc_no = (int(sizes[name]) for name in ("co", "c_no", "nc_o", "nc_no"))
    claims.ranks.update(
        {
            "rank of T": order,
            "observability": co + nc_o,
            "controllability": co + c_no,
            "minimal order": co,
        }
    )
    if co != int(case.answer["minimal_order"]) or co + c_no + nc_o + nc_no != order:
        claims.wrong.append(f"the sizes {sizes} do not fit")
        return
    kinds = np.repeat(["co", "c_no", "nc_o", "nc_no"], [co, c_no, nc_o, nc_no])
    A, B, C = (claims.values[f"new {letter}"] for letter in "ABC")
    moved, seen = np.isin(kinds, ["co", "c_no"]), np.isin(kinds, ["co", "nc_o"])
    zero = (A[np.ix_(~moved, moved)], A[np.ix_(seen, ~seen)], B[~moved, :], C[:, ~seen])
    if any(np.any(np.abs(block) > 1e-30) for block in zero):
        claims.wrong.append("a block that has to vanish does not")
    claims.values["values"] = case.values(case.answer["transfer_function"], PLACES)


def _matrix_exponential(case: Case, claims: Claims) -> None:
    _plant(case, claims, "A")
    for k, time in enumerate(TIMES):
        claims.values[f"exponential {k + 1}"] = array(case.answer["matrix"], 0, {**case.point, "t": real(time)})
    claims.exact["times"] = np.array([TIMES], dtype=complex)


def _gramian(case: Case, claims: Claims) -> None:
    observed = case.specification.get("of", "observability") == "observability"
    _plant(case, claims, "AC" if observed else "AB")
    if not case.has("matrix"):
        return
    horizon = case.specification["horizon"]
    kind = "infinite" if horizon == "inf" else "finite"
    if kind == "finite":
        claims.exact["horizon"] = case.row([str(horizon).replace("^", "**")])
    claims.values[f"{kind} gramian"] = case.matrix("matrix")
    if case.has("determinant"):
        _determinant(case, claims, claims.values[f"{kind} gramian"])
    if "rank" in case.answer:
        claims.ranks["rank"] = int(case.answer["rank"])
    if case.has("finite_sum"):
        claims.values["finite sum"] = case.matrix("finite_sum")


def _initial_state(case: Case, claims: Claims) -> None:
    order = _plant(case, claims, "AC")
    if case.verdict != "yes" or not case.has("x0"):
        return
    claims.given["x0"] = case.row(case.answer["x0"]).T
    output = case.specification["output"]
    texts = output if isinstance(output, list) else [output]
    claims.values["output"] = np.array(
        [[complex(_at(case, text, time)) for time in TIMES] for text in texts], dtype=complex
    )
    claims.exact["times"] = np.array([TIMES], dtype=complex)
    claims.ranks["rank"] = order - len(case.answer.get("kernel") or ())


def _at(case: Case, text: str, time: float) -> Any:
    return value(text.replace("^", "**"), {**case.point, "t": real(time)})


def _gain(case: Case, claims: Claims) -> None:
    feedback = case.task == "state_feedback"
    order = _plant(case, claims, "AB" if feedback else "ABCD")
    letter = "K" if feedback else "L"
    other = claims.given["B" if feedback else "C"]
    width = other.shape[1] if feedback else other.shape[0]
    given = letter in case.specification
    if not given:
        claims.exact["phi"] = case.desired()
    if not case.has(letter):
        if not given:
            claims.values["no gain"] = np.ones((1, 1))
            _as_desired(case, claims)
        return
    gain = claims.given[letter] = case.matrix(letter)
    claims.values["polynomial"] = case.polynomial(case.answer["polynomial"])
    if not given:
        claims.values["assigned"] = claims.exact["phi"]
    if width == 1 and not given and not case.answer["fixed_modes"]:
        claims.values["gain"] = gain
    if case.has("poles"):
        claims.values["poles"] = case.polynomial_of(case.answer["poles"])
    for name in ("closed_loop_matrix", "A", "B_u", "B_y"):
        if case.has(name):
            claims.values[name] = case.matrix(name)
    if gain.shape != ((width, order) if feedback else (order, width)):
        claims.wrong.append(f"{letter} has the shape {gain.shape}")
    _member(case, claims, letter)
    _stable(case, claims)


def _as_desired(case: Case, claims: Claims) -> None:
    """Where there is no gain the polynomial and the poles are those that were asked for."""
    said = [case.polynomial(case.answer["polynomial"])] if case.has("polynomial") else []
    said += [case.polynomial_of(case.answer["poles"])] if case.answer.get("poles") else []
    phi = claims.exact["phi"]
    for each in said:
        if each.shape != phi.shape or not np.allclose(each, phi, rtol=1e-9, atol=1e-12):
            claims.wrong.append(f"{each[0]} is said to be asked for, {phi[0]} is")


def _member(case: Case, claims: Claims, letter: str) -> None:
    """One gain of the family, at small numbers for its parameters."""
    family = case.answer.get("family")
    if not family or not family.get(letter) or sum(len(entry) for row in family[letter] for entry in row) > _LONG:
        return
    small = {name: real(3 * k - 4) / (k + 2) for k, name in enumerate(family["parameters"])}
    try:
        claims.given["member"] = array(family[letter], 0, {**case.point, **small})
    except ZeroDivisionError:
        return
    claims.values["assigned by the member"] = claims.exact["phi"]


def _stable(case: Case, claims: Claims) -> None:
    """`stable` is what the closed-loop poles are."""
    stable = _inside(case, np.roots(claims.values["polynomial"][0]))
    if case.answer.get("stable") in {"yes", "no"} and stable is not None and (case.answer["stable"] == "yes") != stable:
        claims.wrong.append(f"stable is {case.answer['stable']}, and the polynomial {claims.values['polynomial']}")


def _inside(case: Case, roots: Numbers) -> bool | None:
    """Tell whether all roots are stable, None where doubles do not show it."""
    inside = 1 - np.abs(roots) if case.discrete else -roots.real
    bar = 1e-3 * (1 + np.abs(roots))
    if np.any(inside < -bar):
        return False
    return True if np.all(inside > bar) else None


def _reduced_order_observer(case: Case, claims: Claims) -> None:
    order = _plant(case, claims)
    claims.exact["phi"] = case.desired()
    if not case.has("L"):
        claims.values["no gain"] = np.ones((1, 1))
        _as_desired(case, claims)
        if case.has("T") and not case.point:
            claims.values["T"] = case.matrix("T")
        return
    outputs = claims.given["C"].shape[0]
    for letter in "LTFGHM":
        claims.given[letter] = case.matrix(letter, order - outputs)
        claims.values[letter] = claims.given[letter]
    claims.values["assigned"] = claims.exact["phi"]
    claims.values["polynomial"] = case.polynomial(case.answer["polynomial"])
    claims.values["poles"] = case.polynomial_of(case.answer["poles"])
    claims.ranks["rank of T"] = order
    if outputs > 1 or case.answer.get("fixed_modes"):
        del claims.values["L"]
    if case.asked.problem.get("symbols"):
        del claims.values["T"]


def _loop(case: Case, claims: Claims) -> bool:
    """What compensators and the designs that stand on them share; tell whether both gains are there."""
    _plant(case, claims)
    claims.exact["phi_c"], claims.exact["phi_o"] = case.desired("control_"), case.desired("observer_")
    there = [letter for letter in "KL" if case.has(letter)]
    minimal = case.specification.get("observer") == "minimal" or case.task == "tracking"
    if len(there) < 2:
        for letter in "KL":
            claims.values[f"no {letter}"] = np.array([[complex(letter not in there)]])
    if case.has("T"):
        claims.given["T"] = case.matrix("T")
    elif minimal and _coordinates_unsaid(case):
        there = there[: there.count("K")]
    for letter in there:
        claims.given[letter] = case.matrix(letter)
        claims.values[f"assigned by {letter}"] = claims.exact["phi_c" if letter == "K" else "phi_o"]
    return len(there) == 2


def _coordinates_unsaid(case: Case) -> bool:
    """Tell whether L may belong to other coordinates than those of the numbers: constant pivots are preferred."""
    return any(name in case.asked.plant["C"] for name in case.point)


def _both(claims: Claims) -> Numbers:
    return np.convolve(claims.exact["phi_c"][0], claims.exact["phi_o"][0])[None, :]


def _compensator(case: Case, claims: Claims) -> None:
    if not _loop(case, claims) or not case.has("F"):
        return
    claims.values["loop"] = _both(claims)
    claims.values["values of F"] = case.values(case.answer["F"], PLACES)
    claims.values["closed loop"] = case.values(case.answer["closed_loop"], PLACES)
    if case.has("closed_loop_unity"):
        claims.values["unity loop"] = case.values(case.answer["closed_loop_unity"], PLACES)
    claims.values["own"] = case.matrix("compensator_matrix")
    claims.values["in the error"] = case.matrix("closed_loop_matrix")
    claims.values["in the estimate"] = case.matrix("closed_loop_matrix_estimate")
    claims.values["polynomial"] = case.polynomial(case.answer["closed_loop_polynomial"])
    table = case.answer["F"] if isinstance(case.answer["F"], list) else [[case.answer["F"]]]
    under = [np.array(case.ratio(entry).under, dtype=complex) for row in table for entry in row]
    stable = _inside(case, np.concatenate([np.roots(each) for each in under]))
    if case.answer["F_stable"] in {"yes", "no"} and stable is not None and (case.answer["F_stable"] == "yes") != stable:
        claims.wrong.append(f"F_stable is {case.answer['F_stable']}, and the denominators are {under}")


def _feedforward(case: Case, claims: Claims) -> None:
    if not _loop(case, claims):
        return
    if case.has("closed_loop_matrix"):
        claims.values["in the error"] = case.matrix("closed_loop_matrix")
        claims.values["polynomial"] = case.polynomial(case.answer["polynomial"])
    if not case.has("F"):
        if claims.given["D"].size == 1:
            claims.values["nothing at rest"] = np.zeros((1, 1))
        return
    claims.given["F"] = case.matrix("F") if isinstance(case.answer["F"], list) else case.row([case.answer["F"]])
    claims.values["gain at rest"] = np.eye(claims.given["C"].shape[0], dtype=complex)
    claims.values["from v to y"] = case.values(case.answer["transfer_function"], PLACES)


def _tracking(case: Case, claims: Claims) -> None:
    both = _loop(case, claims)
    reference = claims.given["Ad"] = array(rows(case.specification["reference_matrix"]), 0, case.point)
    if case.answer["solvable"] in {True, False}:
        claims.values["solvable"] = np.array([[complex(case.answer["solvable"])]])
    if case.has("K_d"):
        claims.given["Kd"] = case.matrix("K_d")
        claims.values["A - Ad"] = claims.given["A"] - reference
    if both and case.has("error_matrix"):
        claims.values["error matrix"] = case.matrix("error_matrix")
        claims.values["polynomial"] = case.polynomial(case.answer["polynomial"])


_CLAIMS: Mapping[str, Callable[[Case, Claims], None]] = {
    "observability": _rank_test,
    "controllability": _rank_test,
    "detectability": _modes,
    "stabilizability": _modes,
    "pbh": _modes,
    "characteristic_polynomial": _characteristic_polynomial,
    "transfer_function": _transfer_function,
    "canonical_form": _canonical_form,
    "dual": _dual,
    "decomposition": _decomposition,
    "matrix_exponential": _matrix_exponential,
    "gramian": _gramian,
    "initial_state": _initial_state,
    "state_feedback": _gain,
    "observer": _gain,
    "reduced_order_observer": _reduced_order_observer,
    "compensator": _compensator,
    "feedforward": _feedforward,
    "tracking": _tracking,
}
