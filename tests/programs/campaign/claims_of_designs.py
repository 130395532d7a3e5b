"""What designs claim: gains, observers of both orders, compensators, tracking."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from tests.programs.campaign.algebra import (
    Claim,
    Term,
    beside,
    columns_of,
    identity,
    matrix,
    rank,
    rows_of,
    same,
    scalar,
    stack,
    zero,
    zeros,
)
from tests.programs.campaign.asked import Tables, rows

if TYPE_CHECKING:
    from collections.abc import Iterator

from tests.programs.campaign.branch import Branch, as_matrix, from_roots, stability_claims, transfer

# -- gains -------------------------------------------------------------------------------------------------------------


def gain(b: Branch) -> Iterator[Claim]:
    """State feedback and observers: the same claims about a pair and its dual."""
    feedback = b.problem["task"] == "state_feedback"
    letter, loop = ("K", "closed_loop_matrix") if feedback else ("L", "A")
    wanted = b.desired()
    A, C = b.dual() if feedback else (b.A, b.C)
    if wanted is not None:
        yield zero("polynomial", wanted - b.field("polynomial"))
        yield Claim("verdict", "divides", (A, C, wanted), b.verdict != "no")
        fixed = b.answer["fixed_modes"]
        yield Claim("fixed modes", "hidden", (A, C, from_roots(b.variable, fixed)))
    yield from stability_claims(b, b.field("polynomial"))
    if b.verdict == "no":
        return
    yield zero("poles", b.field("polynomial") - from_roots(b.variable, b.answer["poles"]))
    gain = b.field(letter)
    if wanted is None:
        yield same("the gain given", gain, matrix(rows(b.specification[letter])))
    closed = b.A - b.B @ gain if feedback else b.A - gain @ b.C
    yield same("closed loop", closed, b.field(loop))
    yield zero("closed-loop polynomial", closed.characteristic(b.s) - b.field("polynomial"))
    if not feedback:
        yield same("B_u", b.B - gain @ b.D, b.field("B_u"))
        yield same("B_y", gain, b.field("B_y"))
    if wanted is not None and rows_of(C) == 1:
        yield Claim("Ackermann", "ackermann", (A, C, wanted, gain.T if feedback else gain))
    if b.has("family") and b.answer["family"].get(letter):
        yield from _family(b, b.answer["family"], letter)


def _family(b: Branch, family: Tables, letter: str) -> Iterator[Claim]:
    """A member of the family, at small numbers for its parameters."""
    values = {name: str((7 * k) % 5 + k + 2) for k, name in enumerate(family["parameters"])}
    names = re.compile("|".join(rf"\b{name}\b" for name in values)) if values else None
    put = (lambda text: names.sub(lambda name: f"({values[name.group()]})", text)) if names else str
    member = matrix([[put(entry) for entry in row] for row in family[letter]])
    closed = b.A - b.B @ member if letter == "K" else b.A - member @ b.C
    yield zero("a member of the family", closed.characteristic(b.s) - b.field("polynomial"))


def reduced_order_observer(b: Branch) -> Iterator[Claim]:
    wanted = b.desired()
    assert wanted is not None
    yield zero("polynomial", wanted - b.field("polynomial"))
    yield Claim("verdict", "divides", (b.A, b.C, wanted), b.verdict != "no")
    yield Claim("fixed modes", "hidden", (b.A, b.C, from_roots(b.variable, b.answer["fixed_modes"])))
    p, n = rows_of(b.C), b.order
    yield same("T begins with C", b.field("T").upper(p), b.C)
    yield rank("T is invertible", b.field("T"), n)
    if b.verdict == "no":
        return
    F, G, H, M, L, T = (b.field(name) for name in "FGHMLT")
    P = T.lower(p) - L @ b.C
    yield same("M [C; P] = I", M @ stack(b.C, P), identity(n))
    yield same("P A − F P = H C", P @ b.A - F @ P, H @ b.C)
    yield same("G = P B − H D", G, P @ b.B - H @ b.D)
    yield zero("polynomial of F", F.characteristic(b.s) - wanted)
    yield zero("poles", wanted - from_roots(b.variable, b.answer["poles"]))


# -- compensators ------------------------------------------------------------------------------------------------------


def reduced(b: Branch, L: Term, T: Term) -> tuple[Term, Term, Term, Term, Term]:
    """Return F, G, H of the reduced-order observer with this gain, and M in two parts, found from T = [C; R]."""
    p, n = rows_of(b.C), b.order
    P = T.lower(p) - L @ b.C
    M = stack(b.C, P).inverse
    both = P @ b.A @ M
    H, F = both.block(range(n - p), range(p)), both.block(range(n - p), range(p, n))
    return F, P @ b.B - H @ b.D, H, M.block(range(n), range(p)), M.block(range(n), range(p, n))


def compensator_of(b: Branch) -> tuple[Term, Term, Term, Term]:
    """Return u = C_c z + D_c y, z' = A_c z + B_c y of the compensator with the gains of the answer."""
    K, L = b.field("K"), b.field("L")
    if b.specification.get("observer") != "minimal" and b.problem["task"] != "tracking":
        return b.A - b.B @ K - L @ b.C + L @ b.D @ K, L, zeros(rows_of(K), b.order) - K, zeros(rows_of(K), rows_of(b.C))
    F, G, H, M1, M2 = reduced(b, L, b.field("T"))
    around = (identity(rows_of(K)) - K @ M1 @ b.D).inverse
    out, through = zeros(rows_of(K), columns_of(F)) - around @ K @ M2, zeros(rows_of(K), rows_of(b.C)) - around @ K @ M1
    return F + G @ out, H + G @ through, out, through


def _separated(b: Branch) -> Iterator[Claim]:
    """The two gains do what was asked of them, each by itself, or one of them cannot."""
    control, observer = b.desired("control_"), b.desired("observer_")
    assert control is not None
    assert observer is not None
    if _is_ill_posed(b):
        return
    yield Claim("verdict", "separation", (b.A, b.B, b.C, control, observer), b.verdict != "no")


def _is_ill_posed(b: Branch) -> bool:
    """Both gains exist, and the output of a reduced-order loop contains the input before it is known."""
    reduced_order = b.specification.get("observer") == "minimal" or b.problem["task"] == "tracking"
    return reduced_order and b.verdict == "no" and b.has("K") and b.has("L") and "D" in b.problem["plant"]


def _loops(b: Branch) -> Iterator[Claim]:
    control, observer = b.desired("control_"), b.desired("observer_")
    assert control is not None
    assert observer is not None
    if b.has("K"):
        yield zero("polynomial of the control", (b.A - b.B @ b.field("K")).characteristic(b.s) - control)
    if b.has("L") and b.specification.get("observer") != "minimal" and b.problem["task"] != "tracking":
        yield zero("polynomial of the observer", (b.A - b.field("L") @ b.C).characteristic(b.s) - observer)


def compensator(b: Branch) -> Iterator[Claim]:
    yield from _separated(b)
    yield from _loops(b)
    if b.verdict == "no":
        if _is_ill_posed(b) and b.has("T"):
            _, _, _, M1, _ = reduced(b, b.field("L"), b.field("T"))
            yield zero("no loop", (identity(columns_of(b.B)) - b.field("K") @ M1 @ b.D).determinant)
        return
    control, observer = b.desired("control_"), b.desired("observer_")
    assert control is not None
    assert observer is not None
    whole = control * observer
    Ac, Bc, Cc, Dc = compensator_of(b)
    minus_u = transfer(b, Ac, Bc, zeros(*shape_of(Cc)) - Cc, zeros(*shape_of(Dc)) - Dc)
    yield same("F", as_matrix(b, "F"), minus_u)
    if b.answer["F_stable"] in {"yes", "no"}:
        yield Claim("F is stable", "stable_transfer", (Ac, Bc, Cc), (b.variable, b.answer["F_stable"] == "yes"))
    yield zero("closed-loop polynomial", whole - b.field("closed_loop_polynomial"))
    yield zero("closed-loop matrix", b.field("closed_loop_matrix").characteristic(b.s) - whole)
    yield zero("closed-loop matrix (estimate)", b.field("closed_loop_matrix_estimate").characteristic(b.s) - whole)
    if (rows_of(b.C), columns_of(b.B)) == (1, 1):
        plant, F = transfer(b, b.A, b.B, b.C, b.D).entry(0, 0), scalar(b.answer["F"])
        yield zero("closed loop", b.field("closed_loop") * (scalar(1) + F * plant) - plant)
        if b.has("closed_loop_unity"):
            yield zero(
                "closed loop with F before the plant",
                b.field("closed_loop_unity") * (scalar(1) + F * plant) - F * plant,
            )


def shape_of(term: Term) -> tuple[int, int]:
    return rows_of(term), columns_of(term)


def feedforward(b: Branch) -> Iterator[Claim]:
    yield from _loops(b)
    steady = "1" if b.variable == "z" else "0"
    control, observer = b.desired("control_"), b.desired("observer_")
    assert control is not None
    assert observer is not None
    if b.verdict == "no" and b.specification.get("observer") == "minimal" and "D" in b.problem["plant"]:
        return  # perhaps because the law cannot be solved for u, and the answer does not hold what would tell
    yield Claim("verdict", "unit_gain", (b.A, b.B, b.C, b.D, control, observer), (steady, b.verdict != "no"))
    if b.verdict == "no":
        return
    F, found = b.field("F"), b.field("transfer_function")
    K = b.field("K")
    loop = transfer(b, b.A - b.B @ K, b.B, b.C - b.D @ K, b.D).entry(0, 0) * F
    yield zero("transfer function", loop - found)
    yield zero("unit gain", found.at(b.variable, steady) - scalar(1))
    yield zero("closed-loop polynomial", b.field("polynomial") - control * observer)
    yield zero("closed-loop matrix", b.field("closed_loop_matrix").characteristic(b.s) - control * observer)


def tracking(b: Branch) -> Iterator[Claim]:
    yield from _loops(b)
    control, observer = b.desired("control_"), b.desired("observer_")
    assert control is not None
    assert observer is not None
    reference = matrix(rows(b.specification["reference_matrix"]))
    yield Claim("solvable", "contains", (b.B, b.A - reference), b.answer["solvable"])
    if b.answer["solvable"] and _is_ill_posed(b):
        pass
    elif b.answer["solvable"]:
        yield Claim("verdict", "separation", (b.A, b.B, b.C, control, observer), b.verdict != "no")
    else:
        yield Claim("verdict", "is", (), b.verdict == "no")
    if b.has("K_d"):
        yield zero("K_d", reference - b.A + b.B @ b.field("K_d"))
    if b.has("error_matrix"):
        yield zero("error matrix", b.field("error_matrix").characteristic(b.s) - control * observer)
        yield zero("polynomial", b.field("polynomial") - control * observer)


def integral_action(b: Branch) -> Iterator[Claim]:
    wanted, n, p, own = b.desired(), b.order, rows_of(b.C), scalar(int(b.variable == "z"))
    assert wanted is not None
    A = stack(beside(b.A, zeros(n, p)), beside(zeros(p, n) - b.C, own * identity(p)))
    B = stack(b.B, zeros(p, columns_of(b.B)) - b.D)
    at_rest = stack(beside(b.A - own * identity(n), b.B), beside(b.C, b.D))
    yield zero("polynomial", wanted - b.field("polynomial"))
    yield Claim("verdict", "divides", (A.T, B.T, wanted), b.verdict != "no")
    yield Claim("fixed modes", "hidden", (A.T, B.T, from_roots(b.variable, b.answer["fixed_modes"])))
    yield Claim("solvable", "full", (at_rest,), (n + p, b.answer["solvable"]))
    yield from stability_claims(b, b.field("polynomial"))
    if b.verdict == "no":
        return
    closed = A - B @ beside(b.field("K"), zeros(columns_of(b.B), p) - b.field("k_I"))
    yield zero("assigned", closed.characteristic(b.s) - wanted)
    yield same("closed loop", closed, b.field("closed_loop_matrix"))
    yield zero("poles", wanted - from_roots(b.variable, b.answer["poles"]))


def unknown_input_observer(b: Branch) -> Iterator[Claim]:
    wanted, E = b.desired(), matrix(rows(b.specification["E"]))
    assert wanted is not None
    seen = b.C @ E
    yield zero("polynomial", wanted - b.field("polynomial"))
    yield Claim("solvable", "contains", (seen.T, E.T), b.answer["solvable"])
    if not b.answer["solvable"]:
        yield Claim("verdict", "is", (), b.verdict == "no")
        return
    H, T = as_matrix(b, "H"), b.field("T")
    yield same("decoupled", H @ seen, E)
    yield same("T", T, identity(b.order) - H @ b.C)
    yield Claim("verdict", "divides", (T @ b.A, b.C, wanted), b.verdict != "no")
    yield Claim("fixed modes", "hidden", (T @ b.A, b.C, from_roots(b.variable, b.answer["fixed_modes"])))
    if b.verdict == "no":
        return
    F, B_y = b.field("F"), b.field("B_y")
    yield same("error without x", T @ b.A - F @ T, B_y @ b.C)
    yield same("error without u", T @ b.B - B_y @ b.D, b.field("B_u"))
    yield zero("assigned", F.characteristic(b.s) - wanted)


def disturbance_observer(b: Branch) -> Iterator[Claim]:
    wanted, E, n = b.desired(), matrix(rows(b.specification["E"])), b.order
    assert wanted is not None
    q = columns_of(E)
    S = matrix(rows(b.specification["S"])) if "S" in b.specification else scalar(int(b.variable == "z")) * identity(q)
    order = 2 if "S" in b.specification else q
    A = stack(beside(b.A, E if order == q else beside(E, zeros(n, 1))), beside(zeros(order, n), S))
    C = beside(b.C, zeros(rows_of(b.C), order))
    yield zero("polynomial", wanted - b.field("polynomial"))
    yield Claim("verdict", "divides", (A, C, wanted), b.verdict != "no")
    yield Claim("fixed modes", "hidden", (A, C, from_roots(b.variable, b.answer["fixed_modes"])))
    if b.verdict == "no":
        return
    closed = A - stack(b.field("L_x"), b.field("L_w")) @ C
    yield same("observer", closed, b.field("A"))
    yield zero("assigned", closed.characteristic(b.s) - wanted)
