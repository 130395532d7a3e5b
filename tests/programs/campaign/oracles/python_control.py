"""python-control, with slycot below it where that is installed: `place`, `acker`, `feedback`, `minreal`, responses."""

from __future__ import annotations

import warnings
from contextlib import suppress
from typing import TYPE_CHECKING, Any

import control  # type: ignore[import-untyped, unused-ignore]
import numpy as np
from control.exception import ControlNotImplemented, ControlSlycot  # type: ignore[import-untyped, unused-ignore]
from scipy import linalg  # type: ignore[import-untyped, unused-ignore]

from tests.programs.campaign.asked import Untold
from tests.programs.campaign.numeric import COPIES, PLACES, SHAKEN, compared, covered, prepared
from tests.programs.campaign.numeric_cases import Case, shown

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    from tests.programs.campaign.asked import Asked, Difference, Tables
    from tests.programs.campaign.numbers import Numbers
    from tests.programs.campaign.numeric import Found

NAME = "python-control"
COMMAND: str | None = None

#: What the tools of this system raise where they give up.
_GIVES_UP = (ControlSlycot, ControlNotImplemented, np.linalg.LinAlgError, ValueError, ArithmeticError, OverflowError)


def covers(problem: Tables) -> bool:
    """Tell whether there are claims that python-control can judge."""
    return covered(problem) and problem["task"] in _FINDERS


def differences(batch: Sequence[Asked]) -> list[Difference]:
    """Judge one after the other, in this process."""
    with warnings.catch_warnings(), np.errstate(all="ignore"):
        warnings.simplefilter("ignore")
        return [_difference(asked) for asked in batch]


def _difference(asked: Asked) -> Difference:
    read = prepared(asked)
    if isinstance(read, Untold):
        return read
    case, claims = read
    random = np.random.default_rng(1)
    found: list[Found] = []
    try:
        for copy in range(COPIES + 1):
            data = {name: _shaken(random, value.real) if copy else value.real for name, value in claims.given.items()}
            found.append(_FINDERS[case.task](case, data, claims.exact))
    except _GIVES_UP as error:
        return Untold(f"python-control: {' '.join(str(error).split())[:80]}")
    difference = compared(claims, found)
    where = f" at {shown(case.point)}" if case.point else ""
    return f"{difference}{where}" if isinstance(difference, str) else difference


def _shaken(random: Any, matrix: Any) -> Any:
    size = np.abs(matrix).max(initial=0.0)
    signs = random.choice([-1.0, 1.0], matrix.shape)
    return matrix + SHAKEN * size * signs * (0.5 + random.random(matrix.shape) / 2)


# -- what it finds -----------------------------------------------------------------------------------------------------

Data = dict[str, Any]


def _polynomial(matrix: Any) -> Numbers:
    return np.atleast_1d(np.poly(matrix))[None, :].astype(complex) if matrix.size else np.ones((1, 1), dtype=complex)


def _row(values: Any) -> Numbers:
    return np.atleast_1d(np.asarray(values, dtype=complex))[None, :]


def _singular(matrix: Any) -> Numbers:
    return _row(np.linalg.svd(matrix, compute_uv=False)) if matrix.size else np.zeros((1, 0))


def _divided(matrix: Any) -> Any:
    return matrix / np.linalg.norm(matrix, 1) if matrix.any() else matrix


def _hidden(A: Any, C: Any) -> tuple[Numbers, Numbers]:
    """Singular values of the scaled observability matrix, and the polynomial of what is not seen."""
    _, s, V = np.linalg.svd(control.obsv(_divided(A), _divided(C)))
    s = np.concatenate([s, np.zeros(len(A) - len(s))])
    N = V[int(np.sum(s > 1e-9 * s[0])) :].T
    return _row(s), _polynomial(N.T @ A @ N)


def _left(phi: Numbers, A: Any, C: Any) -> Numbers:
    """Return 1 where the polynomial of what is not seen does not divide another, else 0."""
    q = _hidden(A, C)[1][0]
    if len(q) > phi.size:
        return _row(1)
    return _row(float(np.linalg.norm(np.polydiv(phi[0], q)[1]) > 1e-6 * np.linalg.norm(phi)))


def _rank_test(case: Case, g: Data, exact: Data) -> Found:
    observed = case.task == "observability"
    A, C = (g["A"], g["C"]) if observed else (g["A"].T, g["B"].T)
    matrix = control.obsv(A, C) if observed else control.ctrb(g["A"], g["B"])
    s, hidden = _hidden(A, C)
    found = {"matrix": matrix.astype(complex), "rank": s, "hidden": hidden}
    if "N" in exact:
        found["kernel"] = (matrix if observed else matrix.T) @ exact["N"]
        found["kernel's rank"] = _singular(exact["N"])
    if "size" in exact:
        found["determinant"] = _row(np.linalg.det(matrix)) / exact["size"]
    return found


def _modes(_: Case, g: Data, exact: Data) -> Found:
    observed = "C" in g
    A, C = (g["A"], g["C"]) if observed else (g["A"].T, g["B"].T)
    s, hidden = _hidden(A, C)
    found = {"polynomial": _row(np.poly(control.ss(A, A[:, :1], C[:1], 0).poles())), "hidden": hidden, "rank": s}
    found["polynomial as said"] = found["polynomial"]
    for k, mode in enumerate(exact["modes"][0]):
        shifted = A - mode * np.eye(len(A))
        matrix = np.vstack([shifted, C])
        found[f"rank at mode {k + 1}"] = _singular(matrix)
        found[f"matrix at mode {k + 1}"] = matrix if observed else matrix.T
    return found


def _transfer_function(case: Case, g: Data, _: Data) -> Found:
    plant = _system(case, *(g[letter] for letter in "ABCD"))
    found = {"values": _values(plant)}
    with suppress(ControlSlycot, TypeError):  # the latter is what `minreal` raises where slycot is missing
        least = control.minreal(plant, 1e-8, verbose=False)
        found["poles"] = _row(np.poly(least.poles())) if least.nstates else np.ones((1, 1))
        if g["D"].size == 1:
            found["zeros"] = _row(np.poly(least.zeros())) if least.nstates else np.ones((1, 1))
    return found


def _system(case: Case, A: Any, B: Any, C: Any, D: Any) -> Any:
    return control.ss(A, B, C, D, True if case.discrete else 0, remove_useless_states=False)


def _values(system: Any) -> Numbers:
    return np.vstack([system(place, squeeze=False) for place in PLACES])


def _gain(_: Case, g: Data, exact: Data) -> Found:
    feedback = "C" not in g
    letter = "K" if feedback else "L"
    A, B = (g["A"], g["B"]) if feedback else (g["A"].T, g["C"].T)
    if letter not in g:
        return {"no gain": _left(exact["phi"], A.T, B.T)}
    gain = g[letter] if feedback else g[letter].T
    closed = A - B @ gain
    found = {
        "polynomial": _polynomial(closed),
        "assigned": _polynomial(closed),
        "poles": _row(np.poly(np.linalg.eigvals(closed))),
        "closed_loop_matrix" if feedback else "A": closed if feedback else closed.T,
    }
    if not feedback:
        found |= {"B_u": g["B"] - g["L"] @ g["D"], "B_y": g["L"]}
    if "member" in g:
        found["assigned by the member"] = _polynomial(A - B @ (g["member"] if feedback else g["member"].T))
    if "phi" in exact and B.shape[1] == 1 and 1 / np.linalg.cond(control.ctrb(_divided(A), _divided(B))) > 1e-8:
        placed = _placed(A, B, exact["phi"][0])
        found["gain"] = placed if feedback else placed.T
    return found


def _placed(A: Any, B: Any, phi: Any) -> Any:
    """The gain by `place` where the poles are simple, by `acker` where they are not."""
    poles = np.roots(phi)
    apart = min((abs(a - b) for i, a in enumerate(poles) for b in poles[:i]), default=1.0)
    if apart > 1e-2:
        with suppress(*_GIVES_UP):
            return control.place(A, B, poles)
    return np.atleast_2d(control.acker(A, B, poles))


def _reduced(case: Case, g: Data, exact: Data) -> Found:
    if "L" not in g:
        T = np.vstack([g["C"], _unit_rows(case.plant("C").real)])
        return {"no gain": _left(exact["phi"], g["A"], g["C"]), "T": T}
    p = len(g["C"])
    At, Bt = g["T"] @ g["A"] @ np.linalg.inv(g["T"]), g["T"] @ g["B"]
    A11, A12, A21, A22, L = At[:p, :p], At[:p, p:], At[p:, :p], At[p:, p:], g["L"]
    F = A22 - L @ A12
    found = {
        "F": F,
        "assigned": _polynomial(F),
        "polynomial": _polynomial(g["F"]),
        "poles": _polynomial(F),
        "T": np.vstack([g["C"], _unit_rows(case.plant("C").real)]),
        "H": A21 - L @ A11 + F @ L,
        "G": Bt[p:] - L @ Bt[:p] - (A21 - L @ A11 + F @ L) @ g["D"],
        "M": np.linalg.inv(np.vstack([g["C"], g["T"][p:] - L @ g["C"]])),
        "rank of T": _singular(g["T"]),
    }
    if p == 1 and 1 / np.linalg.cond(control.obsv(_divided(A22), _divided(A12))) > 1e-8:
        found["L"] = _placed(A22.T, A12.T, exact["phi"][0]).T
    return found


def _estimator(case: Case, g: Data) -> tuple[Any, Any]:
    """From (u, y) to −K x̂ as a system, and what its L assigns."""
    A, B, C, D, K, L = (g[letter] for letter in ("A", "B", "C", "D", "K", "L"))
    m, p = B.shape[1], len(C)
    if case.specification.get("observer") != "minimal":
        inner = _system(case, A - L @ C, np.hstack([B - L @ D, L]), -K, np.zeros((m, m + p)))
        return inner, _polynomial(A - L @ C)
    T = g["T"] if "T" in g else np.vstack([C, _unit_rows(case.plant("C").real)])
    At, Bt = T @ A @ np.linalg.inv(T), T @ B
    F = At[p:, p:] - L @ At[:p, p:]
    H = At[p:, :p] - L @ At[:p, :p] + F @ L
    G = Bt[p:] - L @ Bt[:p] - H @ D
    M = np.linalg.inv(np.vstack([C, T[p:] - L @ C]))
    direct = np.hstack([K @ M[:, :p] @ D, -K @ M[:, :p]])
    return _system(case, F, np.hstack([G, H]), -K @ M[:, p:], direct), _polynomial(F)


def _unit_rows(C: Any) -> Any:
    """Unit rows of the columns that do not raise the rank."""
    rows, taken = [], 0
    for k in range(C.shape[1]):
        rank = np.linalg.matrix_rank(C[:, : k + 1])
        if rank == taken:
            rows.append(np.eye(C.shape[1])[k])
        taken = rank
    return np.array(rows).reshape(-1, C.shape[1])


def _connected(case: Case, g: Data, gain: Any) -> Any:
    """From v to y, where u = −K x̂ + F v reaches the plant and the observer: `append` and `connect` by matrices."""
    inner, _ = _estimator(case, g)
    plant = _system(case, *(g[letter] for letter in "ABCD"))
    m, p = g["B"].shape[1], len(g["C"])
    open_loop = control.append(plant, inner)  # in: u, (u, y); out: y, −K x̂
    back = np.zeros((2 * m + p, p + m))
    back[:m, p:] = back[m : 2 * m, p:] = np.eye(m)
    back[2 * m :, :p] = np.eye(p)
    entering = np.vstack([gain, gain, np.zeros((p, gain.shape[1]))])
    system = control.feedback(open_loop, control.ss([], [], [], back, open_loop.dt), 1)
    leaving = np.hstack([np.eye(p), np.zeros((p, m))])
    return leaving * system * entering


def _compensator(case: Case, g: Data, exact: Data) -> Found:
    if "K" not in g or "L" not in g:
        found = {
            "no K": _row(0) if "K" in g else _left(exact["phi_c"], g["A"].T, g["B"].T),
            "no L": _row(0) if "L" in g else _left(exact["phi_o"], g["A"], g["C"]),
        }
        if "K" in g:
            found["assigned by K"] = _polynomial(g["A"] - g["B"] @ g["K"])
        if "L" in g:
            found["assigned by L"] = _estimator(case, g | {"K": np.zeros(g["B"].T.shape)})[1]
        return found
    inner, assigned = _estimator(case, g)
    closed = g["A"] - g["B"] @ g["K"]
    found = {"assigned by K": _polynomial(closed), "assigned by L": assigned}
    error = inner.A if case.specification.get("observer") == "minimal" else g["A"] - g["L"] @ g["C"]
    driven = -g["B"] @ inner.C  # u = −K x + (what the estimator's state is off) · what its state does to −u
    found["in the error"] = np.vstack(
        [np.hstack([closed, driven]), np.hstack([np.zeros((len(error), len(closed))), error])]
    )
    if case.task == "feedforward":
        if "F" in g:
            whole = _connected(case, g, g["F"])
            found["gain at rest"] = np.atleast_2d(whole.dcgain()).astype(complex)
            found["from v to y"] = _values(whole)
            found["polynomial"] = _row(np.poly(whole.poles()))
        else:
            A, B, C, D, K = (g[letter] for letter in "ABCDK")
            found["nothing at rest"] = np.atleast_2d(_system(case, A - B @ K, B, C - D @ K, D).dcgain()).astype(complex)
        return found
    m, p = g["B"].shape[1], len(g["C"])
    plant = _system(case, *(g[letter] for letter in "ABCD"))
    around = np.hstack([np.eye(m), np.zeros((m, p))]).T  # the estimator's u is what it puts out itself
    entering = np.vstack([np.zeros((m, p)), np.eye(p)])
    own = -control.feedback(inner, control.ss([], [], [], around, inner.dt), 1) * entering
    loop = control.feedback(plant, own)
    found["loop"] = found["polynomial"] = _row(np.poly(loop.poles()))
    found["own"], found["in the estimate"] = own.A, loop.A
    found["values of F"], found["closed loop"] = _values(own), _values(loop)
    if m == p == 1:
        found["unity loop"] = _values(control.feedback(plant * own, 1))
    return found


def _matrix_exponential(_: Case, g: Data, exact: Data) -> Found:
    return {f"exponential {k + 1}": linalg.expm(g["A"] * t) for k, t in enumerate(exact["times"][0].real)}


def _gramian(case: Case, g: Data, exact: Data) -> Found:
    observed = "C" in g
    A, C = (g["A"], g["C"]) if observed else (g["A"].T, g["B"].T)
    if "horizon" not in exact:
        matrix = control.gram(_system(case, A, np.zeros((len(A), 1)), C, np.zeros((len(C), 1))), "o")
        name = "infinite gramian"
    else:
        horizon, name = exact["horizon"][0, 0].real, "finite gramian"
        matrix = _sum(A, C, round(horizon)) if case.discrete else _integral(A, C, horizon)
    found = {name: matrix, "finite sum": _sum(A, C, len(A))}
    if "size" in exact:
        found["determinant"] = _row(np.linalg.det(matrix)) / exact["size"]
    return found | {"rank": _hidden(A, C)[0]}


def _sum(A: Any, C: Any, steps: int) -> Any:
    powers = [C @ np.linalg.matrix_power(A, k) for k in range(steps)]
    return sum((part.T @ part for part in powers), np.zeros(A.shape))


def _integral(A: Any, C: Any, horizon: float) -> Any:
    """Gauss's rule with many points on pieces in which e^{At} grows little."""
    pieces = int(1 + np.linalg.norm(A, 1) * horizon / 4)
    places, weights = np.polynomial.legendre.leggauss(16)
    step = horizon / pieces
    inner = [C @ linalg.expm(A * step * (1 + place) / 2) for place in places]
    one = sum(weight * step / 2 * part.T @ part for weight, part in zip(weights, inner, strict=True))
    total, power, whole = np.zeros(A.shape), np.eye(len(A)), linalg.expm(A * step)
    for _ in range(pieces):
        total += power.T @ one @ power
        power = whole @ power
    return total


def _initial_state(case: Case, g: Data, exact: Data) -> Found:
    found = {"rank": _hidden(g["A"], g["C"])[0]}
    if "x0" in g:
        plant = _system(case, g["A"], np.zeros((len(g["A"]), 1)), g["C"], np.zeros((len(g["C"]), 1)))
        columns = []
        for t in exact["times"][0].real:
            response = control.initial_response(plant, np.array([0.0, t]), g["x0"][:, 0])
            columns.append(np.reshape(response.outputs, (len(g["C"]), -1))[:, -1])
        found["output"] = np.array(columns).T
    return found


def _decomposition(case: Case, g: Data, _: Data) -> Found:
    plant = _system(case, *(g[letter] for letter in "ABCD"))
    moved = control.similarity_transform(plant, g["T"])
    found = {f"new {letter}": getattr(moved, letter) for letter in "ABCD"}
    return found | {
        "rank of T": _singular(g["T"]),
        "observability": _hidden(g["A"], g["C"])[0],
        "controllability": _hidden(g["A"].T, g["B"].T)[0],
        "values": _values(plant),
    }


def _canonical_form(case: Case, g: Data, _: Data) -> Found:
    if "T" not in g:
        pairs = {"not controllable": (g["A"].T, g["B"].T), "not observable": (g["A"], g["C"])}
        found = {name: _row(float(abs(_hidden(*pair)[0][0, -1]) < 1e-9)) for name, pair in pairs.items()}
        return found | {"polynomial": _polynomial(g["A"])}
    plant = _system(case, *(g[letter] for letter in "ABCD"))
    moved = control.similarity_transform(plant, g["T"])
    found = {f"new {letter}": getattr(moved, letter) for letter in "ABCD"}
    if case.specification["kind"] == "controllable" and g["B"].shape[1] == 1:
        theirs, _ = control.reachable_form(plant)  # the same with the states in the other order
        found["controllable companion"], found["controllable input"] = theirs.A[::-1, ::-1], theirs.B[::-1]
        found["new C"] = theirs.C[:, ::-1]
    return found | {"rank of T": _singular(g["T"]), "polynomial": _polynomial(g["A"])}


_FINDERS: Mapping[str, Callable[[Case, Data, Data], Found]] = {
    "observability": _rank_test,
    "controllability": _rank_test,
    "detectability": _modes,
    "stabilizability": _modes,
    "pbh": _modes,
    "transfer_function": _transfer_function,
    "canonical_form": _canonical_form,
    "decomposition": _decomposition,
    "matrix_exponential": _matrix_exponential,
    "gramian": _gramian,
    "initial_state": _initial_state,
    "state_feedback": _gain,
    "observer": _gain,
    "reduced_order_observer": _reduced,
    "compensator": _compensator,
    "feedforward": _compensator,
}
