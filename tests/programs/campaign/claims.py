"""What an answer claims, task by task, in terms any system can be told: written from the contract, not from our code.

A problem and an answer come here as texts, with parameters or with numbers in their place; one branch at a time.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from typing import TYPE_CHECKING

from tests.programs.campaign.terms import (
    Claim,
    Term,
    beside,
    identity,
    matrix,
    observability_matrix,
    product,
    rank,
    same,
    scalar,
    stack,
    vectors,
    zero,
    zeros,
)
from tests.support.algebra import holds
from tests.support.problems.random_problems import Tables, listed, rows

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Sequence

#: A root that has no closed form: its polynomial and its number.
CROOT = re.compile(r"CRootOf\((.*), (\d+)\)")
TIME = re.compile(r"\bt\b")


@dataclass(frozen=True)
class Moments:
    """Values of outputs at moments, as texts."""

    values: Sequence[tuple[Fraction, list[str]]]


@dataclass(frozen=True)
class Branch:
    """A problem with one branch of its answer, and the plant as terms."""

    problem: Tables
    answer: Tables

    @property
    def specification(self) -> Tables:
        return dict(self.problem["specification"])

    @property
    def verdict(self) -> str:
        return str(self.answer["verdict"])

    @property
    def variable(self) -> str:
        return "z" if self.problem["plant"].get("dt") else "s"

    @property
    def s(self) -> Term:
        return scalar(self.variable)

    def __getattr__(self, letter: str) -> Term:
        """Return A, B or C of the plant."""
        if letter not in self.problem["plant"] or letter not in set("ABC"):
            raise AttributeError(letter)
        found = self.__dict__[letter] = matrix(rows(self.problem["plant"][letter]))
        return found

    @cached_property
    def D(self) -> Term:
        given = self.problem["plant"].get("D")
        return zeros(self.C.rows, self.B.columns) if given is None else matrix(rows(given))

    @property
    def order(self) -> int:
        return self.A.rows

    def field(self, name: str) -> Term:
        """Return a field of the answer: a table is a matrix, a text is a scalar."""
        found = self.answer[name]
        return matrix(found) if isinstance(found, list) else scalar(found)

    def has(self, name: str) -> bool:
        return self.answer.get(name) not in (None, [])

    def desired(self, prefix: str = "") -> Term:
        """Return the polynomial that was asked for, from the problem alone."""
        asked = self.specification
        if f"{prefix}polynomial" in asked:
            return scalar(asked[f"{prefix}polynomial"].replace("^", "**"))
        return product([self.s - scalar(pole) for pole in listed(asked[f"{prefix}poles"])])

    def given(self, name: str) -> Term:
        """Return a matrix of the specification."""
        return matrix(rows(self.specification[name]))

    @property
    def both(self) -> tuple[Term, Term]:
        """Return the polynomials asked for of control and observer."""
        return self.desired("control_"), self.desired("observer_")

    @property
    def is_minimal(self) -> bool:
        return self.specification.get("observer") == "minimal" or self.problem["task"] == "tracking"

    @property
    def pole(self) -> Term:
        """Return the place at rest: 0, or 1 in discrete time."""
        return scalar(int(self.variable == "z"))

    def dual(self) -> tuple[Term, Term]:
        """Return the pair whose observability is this plant's controllability."""
        return self.A.T, self.B.T


def from_roots(variable: str, roots: Sequence[str]) -> Term:
    """Return Π (s − root); roots without a closed form come in whole sets, whose product is their polynomial."""
    factors: list[Term] = []
    sets: dict[str, list[int]] = {}
    for root in roots:
        found = CROOT.fullmatch(root)
        if found is None:
            factors.append(scalar(variable) - scalar(root))
        else:
            sets.setdefault(found.group(1), []).append(int(found.group(2)))
    for text, numbers in sets.items():
        once = sorted(set(numbers))
        times = len(numbers) // len(once)
        if sorted(numbers) != sorted(once * times):
            raise ValueError(roots)
        factors += [Term("monic", data={"text": text})] * times
    return product(factors)


def rank_and_kernel(b: Branch, found: Term) -> Iterator[Claim]:
    yield rank("rank", found, b.answer["rank"])
    kernel = b.answer["kernel"]
    yield Claim("dimension of the kernel", "is", (), len(kernel) == b.order - b.answer["rank"])
    if kernel:
        yield zero("kernel", found @ vectors(kernel))
        yield rank("independent kernel", vectors(kernel), len(kernel))


def stability_claims(b: Branch, polynomial: Term) -> Iterator[Claim]:
    stable = b.answer.get("stable")
    if stable == "conditional" and not b.problem["symbols"]:
        stable = "yes" if all(holds(relation, {}) for relation in b.answer["stable_if"]) else "no"
    if stable in {"yes", "no"}:
        yield Claim("stable", "hurwitz", (polynomial,), (b.variable, stable == "yes"))


def transfer(b: Branch, A: Term, B: Term, C: Term, D: Term) -> Term:
    """Return C (sI − A)⁻¹ B + D."""
    return C @ (b.s * identity(A.rows) - A).inverse @ B + D


def as_matrix(b: Branch, name: str) -> Term:
    found = b.answer[name]
    return matrix(found) if isinstance(found, list) else matrix([[found]])


# -- ranks -------------------------------------------------------------------------------------------------------------


def observability(b: Branch) -> Iterator[Claim]:
    A, C, rows_wise = (b.A, b.C, True) if b.problem["task"] == "observability" else (*b.dual(), False)
    found = b.field("matrix") if rows_wise else b.field("matrix").T
    yield same("matrix", found, observability_matrix(A, C))
    yield from rank_and_kernel(b, observability_matrix(A, C))
    if b.has("determinant"):
        yield zero("determinant", b.field("matrix").determinant - b.field("determinant"))
    yield Claim("verdict", "is", (), (b.verdict == "yes") == (b.answer["rank"] == b.order))
    modes = b.answer["unobservable_modes" if rows_wise else "uncontrollable_modes"]
    yield Claim("hidden modes", "hidden", (A, C, from_roots(b.variable, modes)))
    for states in b.answer.get("missing_measurements" if rows_wise else "missing_inputs", []):
        units = matrix([[int(k + 1 == state) for k in range(b.order)] for state in states])
        yield rank(f"with {states} as well", observability_matrix(A, stack(C, units)), b.order)


def modes(b: Branch) -> Iterator[Claim]:
    """Detectability, stabilizability and the PBH test: every mode with its rank."""
    task = b.problem["task"]
    seen = task == "detectability" or b.specification.get("of") == "observability"
    A, C = (b.A, b.C) if seen else b.dual()
    yield zero("characteristic polynomial", A.characteristic(b.s) - b.field("polynomial"))
    yield Claim("fixed polynomial", "hidden", (A, C, b.field("fixed_polynomial")))
    listed_modes = [mode["eigenvalue"] for mode in b.answer["modes"]]
    yield Claim("modes", "modes", (A, C), (b, "observable" if seen else "controllable"))
    yield Claim("all modes", "radical", (A.characteristic(b.s), from_roots(b.variable, listed_modes)))
    if "rank" in b.answer:
        yield rank("rank", observability_matrix(A, C), b.answer["rank"])
    if task == "pbh":
        yield Claim("verdict", "trivial", (b.field("fixed_polynomial"),), b.verdict == "yes")
        for k, mode in enumerate(b.answer["modes"]):
            if "CRootOf" not in mode["eigenvalue"]:
                I = identity(b.order)
                pencil = b.A - scalar(mode["eigenvalue"]) * I
                whole = stack(pencil, b.C) if seen else beside(pencil, b.B)
                yield same(f"matrix of mode {k + 1}", matrix(mode["matrix"]), whole)
    elif b.specification.get("meaning") == "lyapunov":
        yield Claim("verdict", "bounded", (A, C), (b.variable, b.verdict == "yes"))
    else:
        yield Claim("verdict", "hurwitz", (b.field("fixed_polynomial"),), (b.variable, b.verdict == "yes"))


# -- the plant by itself -----------------------------------------------------------------------------------------------


def characteristic_polynomial(b: Branch) -> Iterator[Claim]:
    chi = b.A.characteristic(b.s)
    yield zero("polynomial", chi - b.field("polynomial"))
    factors = [scalar(text) for text, power in b.answer["factors"] for _ in range(power)]
    yield zero("factors", chi - product(factors))
    yield zero("roots", chi - from_roots(b.variable, b.answer["roots"]))
    yield from stability_claims(b, b.field("polynomial"))


def transfer_function(b: Branch) -> Iterator[Claim]:
    yield same("transfer function", as_matrix(b, "transfer_function"), transfer(b, b.A, b.B, b.C, b.D))
    plant = (b.A, b.B, b.C, b.D)
    if not isinstance(b.answer.get("poles"), list) or not isinstance(b.answer.get("zeros"), list):
        return
    found = (from_roots(b.variable, b.answer["poles"]), from_roots(b.variable, b.answer["zeros"]))
    # Poles and zeros that are found with parameters may cancel at some of their values.
    yield Claim("poles and zeros", "poles_and_zeros", (*plant, *found), "parameters" not in b.problem)


def _similar(b: Branch) -> Iterator[Claim]:
    """T carries the plant over to the new coordinates."""
    T = b.field("T")
    yield rank("T is invertible", T, b.order)
    yield same("A", T @ b.A, b.field("A") @ T)
    yield same("B", T @ b.B, b.field("B"))
    yield same("C", b.C, b.field("C") @ T)
    yield same("D", b.D, b.field("D"))


def canonical_form(b: Branch) -> Iterator[Claim]:
    kind = b.specification["kind"]
    yield zero("polynomial", b.A.characteristic(b.s) - b.field("polynomial"))
    if kind != "modal":
        A, C = b.dual() if kind == "controllable" else (b.A, b.C)
        yield Claim("verdict", "full", (observability_matrix(A, C),), (b.order, b.verdict == "yes"))
    if b.verdict == "no":
        return
    yield from _similar(b)
    n = b.order
    companion, vector = (b.field("A"), b.field("B")) if kind == "controllable" else (b.field("A").T, b.field("C").T)
    if kind != "modal":
        yield same("last unit vector", vector, matrix([[int(k == n - 1)] for k in range(n)]))
        if n > 1:
            shift = matrix([[int(j == i + 1) for j in range(n)] for i in range(n - 1)])
            yield same("companion matrix", companion.upper(n - 1), shift)


def dual(b: Branch) -> Iterator[Claim]:
    sign = scalar(b.specification["sign"])
    yield same("A", b.field("A"), sign * b.A.T)
    yield same("B", b.field("B"), b.C.T)
    yield same("C", b.field("C"), b.B.T)
    yield same("D", b.field("D"), b.D.T)
    seen, moved = observability_matrix(b.A, b.C), observability_matrix(*b.dual())
    yield rank("observability", seen, b.answer["observability_rank"])
    yield rank("controllability", moved, b.answer["controllability_rank"])
    crossed = [b.answer[name] for name in ("dual_controllability_rank", "dual_observability_rank")]
    yield Claim(
        "ranks change places", "is", (), crossed == [b.answer["observability_rank"], b.answer["controllability_rank"]]
    )


def decomposition(b: Branch) -> Iterator[Claim]:
    yield from _similar(b)
    sizes = b.answer["sizes"]
    co, c_no, nc_o, nc_no = (sizes[name] for name in ("co", "c_no", "nc_o", "nc_no"))
    seen, moved = observability_matrix(b.A, b.C), observability_matrix(*b.dual())
    yield rank("controllable", moved, co + c_no)
    yield rank("observable", seen, co + nc_o)
    yield rank("controllable and observable", seen @ moved.T, co)
    yield Claim("all states", "is", (), co + c_no + nc_o + nc_no == b.order and b.answer["minimal_order"] == co)
    ends = [0, co, co + c_no, co + c_no + nc_o, b.order]
    part = [range(ends[k], ends[k + 1]) for k in range(4)]
    A, B, C = b.field("A"), b.field("B"), b.field("C")
    for row, column in [(0, 1), (0, 3), (2, 0), (2, 1), (2, 3), (3, 0), (3, 1)]:
        if part[row] and part[column]:
            yield zero(f"block {row + 1} {column + 1} of A", A.block(part[row], part[column]))
    for k in (2, 3):
        if part[k]:
            yield zero(f"block {k + 1} of B", B.block(part[k], range(B.columns)))
    for k in (1, 3):
        if part[k]:
            yield zero(f"block {k + 1} of C", C.block(range(C.rows), part[k]))
    yield same("transfer function", as_matrix(b, "transfer_function"), transfer(b, b.A, b.B, b.C, b.D))


# -- gains -------------------------------------------------------------------------------------------------------------


def gain(b: Branch) -> Iterator[Claim]:
    """State feedback and observers: the same claims about a pair and its dual."""
    feedback = b.problem["task"] == "state_feedback"
    letter, loop = ("K", "closed_loop_matrix") if feedback else ("L", "A")
    wanted = None if letter in b.specification else b.desired()
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
        yield same("the gain given", gain, b.given(letter))
    closed = b.A - b.B @ gain if feedback else b.A - gain @ b.C
    yield same("closed loop", closed, b.field(loop))
    yield zero("closed-loop polynomial", closed.characteristic(b.s) - b.field("polynomial"))
    if not feedback:
        yield same("B_u", b.B - gain @ b.D, b.field("B_u"))
        yield same("B_y", gain, b.field("B_y"))
    if wanted is not None and C.rows == 1:
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
    yield zero("polynomial", wanted - b.field("polynomial"))
    yield Claim("verdict", "divides", (b.A, b.C, wanted), b.verdict != "no")
    yield Claim("fixed modes", "hidden", (b.A, b.C, from_roots(b.variable, b.answer["fixed_modes"])))
    p, n = b.C.rows, b.order
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
    p, n = b.C.rows, b.order
    P = T.lower(p) - L @ b.C
    M = stack(b.C, P).inverse
    both = P @ b.A @ M
    H, F = both.block(range(n - p), range(p)), both.block(range(n - p), range(p, n))
    return F, P @ b.B - H @ b.D, H, M.block(range(n), range(p)), M.block(range(n), range(p, n))


def compensator_of(b: Branch) -> tuple[Term, Term, Term, Term]:
    """Return u = C_c z + D_c y, z' = A_c z + B_c y of the compensator with the gains of the answer."""
    K, L = b.field("K"), b.field("L")
    if not b.is_minimal:
        return b.A - b.B @ K - L @ b.C + L @ b.D @ K, L, -K, zeros(K.rows, b.C.rows)
    F, G, H, M1, M2 = reduced(b, L, b.field("T"))
    around = (identity(K.rows) - K @ M1 @ b.D).inverse
    out, through = -(around @ K @ M2), -(around @ K @ M1)
    return F + G @ out, H + G @ through, out, through


def _separated(b: Branch) -> Iterator[Claim]:
    """The two gains do what was asked of them, each by itself, or one of them cannot."""
    control, observer = b.both
    if _is_ill_posed(b):
        return
    yield Claim("verdict", "separation", (b.A, b.B, b.C, control, observer), b.verdict != "no")


def _is_ill_posed(b: Branch) -> bool:
    """Both gains exist, and the output of a reduced-order loop contains the input before it is known."""
    return b.is_minimal and b.verdict == "no" and b.has("K") and b.has("L") and "D" in b.problem["plant"]


def _loops(b: Branch) -> Iterator[Claim]:
    control, observer = b.both
    if b.has("K"):
        yield zero("polynomial of the control", (b.A - b.B @ b.field("K")).characteristic(b.s) - control)
    if b.has("L") and not b.is_minimal:
        yield zero("polynomial of the observer", (b.A - b.field("L") @ b.C).characteristic(b.s) - observer)


def compensator(b: Branch) -> Iterator[Claim]:
    yield from _separated(b)
    yield from _loops(b)
    if b.verdict == "no":
        if _is_ill_posed(b) and b.has("T"):
            _, _, _, M1, _ = reduced(b, b.field("L"), b.field("T"))
            yield zero("no loop", (identity(b.B.columns) - b.field("K") @ M1 @ b.D).determinant)
        return
    control, observer = b.both
    whole = control * observer
    Ac, Bc, Cc, Dc = compensator_of(b)
    yield same("F", as_matrix(b, "F"), transfer(b, Ac, Bc, -Cc, -Dc))
    if b.answer["F_stable"] in {"yes", "no"}:
        yield Claim("F is stable", "stable_transfer", (Ac, Bc, Cc), (b.variable, b.answer["F_stable"] == "yes"))
    yield zero("closed-loop polynomial", whole - b.field("closed_loop_polynomial"))
    yield zero("closed-loop matrix", b.field("closed_loop_matrix").characteristic(b.s) - whole)
    yield zero("closed-loop matrix (estimate)", b.field("closed_loop_matrix_estimate").characteristic(b.s) - whole)
    if (b.C.rows, b.B.columns) == (1, 1):
        plant, F = transfer(b, b.A, b.B, b.C, b.D).entry(0, 0), scalar(b.answer["F"])
        yield zero("closed loop", b.field("closed_loop") * (scalar(1) + F * plant) - plant)
        if b.has("closed_loop_unity"):
            yield zero(
                "closed loop with F before the plant",
                b.field("closed_loop_unity") * (scalar(1) + F * plant) - F * plant,
            )


def feedforward(b: Branch) -> Iterator[Claim]:
    yield from _loops(b)
    steady = "1" if b.variable == "z" else "0"
    control, observer = b.both
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
    control, observer = b.both
    reference = b.given("reference_matrix")
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
    wanted, n, p, own = b.desired(), b.order, b.C.rows, b.pole
    A = stack(beside(b.A, zeros(n, p)), beside(zeros(p, n) - b.C, own * identity(p)))
    B = stack(b.B, zeros(p, b.B.columns) - b.D)
    at_rest = stack(beside(b.A - own * identity(n), b.B), beside(b.C, b.D))
    yield zero("polynomial", wanted - b.field("polynomial"))
    yield Claim("verdict", "divides", (A.T, B.T, wanted), b.verdict != "no")
    yield Claim("fixed modes", "hidden", (A.T, B.T, from_roots(b.variable, b.answer["fixed_modes"])))
    yield Claim("solvable", "full", (at_rest,), (n + p, b.answer["solvable"]))
    yield from stability_claims(b, b.field("polynomial"))
    if b.verdict == "no":
        return
    closed = A - B @ beside(b.field("K"), zeros(b.B.columns, p) - b.field("k_I"))
    yield zero("assigned", closed.characteristic(b.s) - wanted)
    yield same("closed loop", closed, b.field("closed_loop_matrix"))
    yield zero("poles", wanted - from_roots(b.variable, b.answer["poles"]))


def unknown_input_observer(b: Branch) -> Iterator[Claim]:
    wanted, E = b.desired(), b.given("E")
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
    wanted, E, n = b.desired(), b.given("E"), b.order
    q = E.columns
    S = b.given("S") if "S" in b.specification else b.pole * identity(q)
    order = 2 if "S" in b.specification else q
    A = stack(beside(b.A, E if order == q else beside(E, zeros(n, 1))), beside(zeros(order, n), S))
    C = beside(b.C, zeros(b.C.rows, order))
    yield zero("polynomial", wanted - b.field("polynomial"))
    yield Claim("verdict", "divides", (A, C, wanted), b.verdict != "no")
    yield Claim("fixed modes", "hidden", (A, C, from_roots(b.variable, b.answer["fixed_modes"])))
    if b.verdict == "no":
        return
    closed = A - stack(b.field("L_x"), b.field("L_w")) @ C
    yield same("observer", closed, b.field("A"))
    yield zero("assigned", closed.characteristic(b.s) - wanted)


# -- in time -----------------------------------------------------------------------------------------------------------


def matrix_exponential(b: Branch) -> Iterator[Claim]:
    found = b.field("matrix")
    yield zero("derivative", found.derivative("t") - b.A @ found)
    yield zero("at 0", found.at("t", "0") - identity(b.order))
    yield Claim("series", "exponential", (b.A, found))


def gramian(b: Branch) -> Iterator[Claim]:
    A, C = (b.A, b.C) if b.specification["of"] == "observability" else b.dual()
    seen = observability_matrix(A, C)
    yield from rank_and_kernel(b, seen)
    if b.has("finite_sum"):
        yield same("finite sum", b.field("finite_sum"), seen.T @ seen)
    horizon = str(b.specification["horizon"])
    if horizon == "inf":
        yield Claim("verdict", "decays", (A, C), (b.variable, b.has("matrix") and b.verdict != "no"))
    if not b.has("matrix") or b.verdict == "no":
        return
    W = b.field("matrix")
    if b.has("determinant"):
        yield zero("determinant", W.determinant - b.field("determinant"))
    if horizon == "inf" and b.variable == "s":
        yield zero("Lyapunov's equation", A.T @ W + W @ A + C.T @ C)
    elif horizon == "inf":
        yield zero("Stein's equation", A.T @ W @ A - W + C.T @ C)
    elif b.variable == "z":
        yield Claim("sum over the steps", "is_steps", (A, C, W), int(horizon))
    else:
        yield Claim("integral", "is_gramian", (A, C, W), horizon)


def time_varying(b: Branch) -> Iterator[Claim]:
    A, parts = b.A, [b.C]
    for _ in range(len(b.answer["stack"]) - 1):
        parts.append(parts[-1].derivative("t") + parts[-1] @ A)
    for k, (mine, theirs) in enumerate(zip(parts, b.answer["stack"], strict=True)):
        yield same(f"N{k}", mine, matrix(theirs))
    yield rank("rank", stack(*parts), b.answer["rank"])
    yield Claim("verdict", "is", (), (b.verdict == "yes") == (b.answer["rank"] == b.order))


def initial_state(b: Branch) -> Iterator[Claim]:
    """Outputs without an input: looked at in some moments, at which they are numbers."""
    seen = observability_matrix(b.A, b.C)
    kernel = b.answer["kernel"]
    yield rank("kernel", seen, b.order - len(kernel))
    if kernel:
        yield zero("kernel", seen @ vectors(kernel))
        yield rank("independent kernel", vectors(kernel), len(kernel))
    explained = b.has("x0")
    yield Claim("verdict", "is", (), (b.verdict == "yes") == (explained and not kernel))
    given = b.specification["output"]
    outputs = given if isinstance(given, list) else [given]
    moments = [Fraction(k, 5) for k in range(1, 2 * b.order + 4)]
    data = [(moment, [TIME.sub(f"({moment})", text).replace("^", "**") for text in outputs]) for moment in moments]
    if explained:
        yield Claim("the outputs", "explains", (b.A, b.C, vectors([b.answer["x0"]])), Moments(data))
    else:
        yield Claim("no initial state", "unexplained", (b.A, b.C), Moments(data))


def initial_state_covariance(b: Branch) -> Iterator[Claim]:
    yield Claim("verdict", "full", (observability_matrix(b.A, b.C),), (b.order, b.verdict == "yes"))
    if not b.has("covariance"):
        return
    whole, of_input, of_output = (b.field(name) for name in ("covariance", "input_part", "output_part"))
    yield same("sum", whole, of_input + of_output)
    Q, R = map(b.given, "QR")
    horizon = str(b.specification["horizon"])
    yield Claim("output part", "output_part", (b.A, b.C, R, of_output), horizon)
    yield Claim("input part", "input_part", (b.A, b.B, b.C, Q, of_input), horizon)


def pole_advice(b: Branch) -> Iterator[Claim]:
    chosen, used = b.answer["poles"], list(b.answer["zeros_used"])
    yield zero("polynomial", from_roots(b.variable, chosen) - b.field("polynomial"))
    yield Claim("verdict", "divides", (b.A, b.C, b.field("polynomial")), b.verdict != "no")
    for place in used:
        if "CRootOf" not in place:
            yield Claim(f"zero {place}", "is_plant_zero", (b.A, b.B, b.C, b.D, scalar(place)))
    if "radius" in b.specification:
        yield Claim("as many poles as states", "is", (), len(chosen) == b.order)
        for place in (place for place in chosen if place not in used and "CRootOf" not in place):
            yield Claim(f"pole {place}", "on_circle", (scalar(place), scalar(b.specification["radius"])))


def stability_region(b: Branch) -> Iterator[Claim]:
    """At a point: whether it lies in the region, and whether all roots of the polynomial lie where they should."""
    if b.problem["symbols"]:
        return
    moved = {"margin": f"({b.variable}-{{}})", "radius": f"({b.variable}*{{}})"}
    text = b.variable
    for name, form in moved.items():
        if name in b.specification:
            text = form.format(f"({b.specification[name]})")
    place = scalar(text)
    if "polynomial" in b.specification:
        given = b.specification["polynomial"].replace("^", "**")
        chi = scalar(re.sub(rf"\b{b.variable}\b", text, given))
    elif "L" in b.specification:
        chi = (b.A - b.given("L") @ b.C).characteristic(place)
    else:
        chi = (b.A - b.B @ b.given("K")).characteristic(place)
    inside = all(holds(relation, {}) for relation in b.answer["stable_if"])
    yield Claim("inside", "hurwitz", (chi,), (b.variable, inside))


# -- all tasks ---------------------------------------------------------------------------------------------------------

_CLAIMS: dict[str, Callable[[Branch], Iterator[Claim]]] = {
    **dict.fromkeys(("observability", "controllability"), observability),
    **dict.fromkeys(("detectability", "stabilizability", "pbh"), modes),
    **dict.fromkeys(("state_feedback", "observer"), gain),
    "time_varying_observability": time_varying,
    **{
        function.__name__: function
        for function in (
            characteristic_polynomial,
            transfer_function,
            canonical_form,
            dual,
            decomposition,
            reduced_order_observer,
            compensator,
            feedforward,
            tracking,
            integral_action,
            unknown_input_observer,
            disturbance_observer,
            matrix_exponential,
            gramian,
            initial_state,
            initial_state_covariance,
            pole_advice,
            stability_region,
        )
    },
}


def claims(problem: Tables, answer: Tables) -> list[Claim]:
    """Return what a branch claims; none where it claims nothing that is put here."""
    return [] if answer["verdict"] == "undecided" else list(_CLAIMS[problem["task"]](Branch(problem, answer)))
