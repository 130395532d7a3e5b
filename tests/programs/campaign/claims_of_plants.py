"""What answers about a plant claim: ranks and modes, polynomials, forms and parts."""

from __future__ import annotations

from typing import TYPE_CHECKING

from tests.programs.campaign.algebra import (
    Claim,
    Term,
    columns_of,
    identity,
    matrix,
    observability_matrix,
    product,
    rank,
    rows_of,
    same,
    scalar,
    stack,
    zero,
)

if TYPE_CHECKING:
    from collections.abc import Iterator

from tests.programs.campaign.branch import Branch, as_matrix, from_roots, rank_and_kernel, stability_claims, transfer

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
                whole = (
                    stack(pencil, b.C) if seen else Term("beside", (pencil, b.B), (b.order, b.order + columns_of(b.B)))
                )
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
            yield zero(f"block {k + 1} of B", B.block(part[k], range(columns_of(B))))
    for k in (1, 3):
        if part[k]:
            yield zero(f"block {k + 1} of C", C.block(range(rows_of(C)), part[k]))
    yield same("transfer function", as_matrix(b, "transfer_function"), transfer(b, b.A, b.B, b.C, b.D))
