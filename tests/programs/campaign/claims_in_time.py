"""What functions of time, pole advice and regions claim."""

from __future__ import annotations

import re
from fractions import Fraction
from typing import TYPE_CHECKING

from tests.programs.campaign.algebra import (
    Claim,
    identity,
    matrix,
    observability_matrix,
    rank,
    same,
    scalar,
    stack,
    vectors,
    zero,
)
from tests.programs.campaign.asked import rows
from tests.programs.campaign.points import holds

if TYPE_CHECKING:
    from collections.abc import Iterator

from tests.programs.campaign.branch import TIME, Branch, Moments, from_roots, rank_and_kernel

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
        yield Claim("sum over the steps", "steps", (A, C, W), int(horizon))
    elif horizon == "T":
        # At a point T is a number there, so that only a term with T itself has a derivative.
        yield Claim("integral", "gramian", (A, C, W), "T")
    else:
        yield Claim("integral", "gramian", (A, C, W), horizon)


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
    Q, R = (matrix(rows(b.specification[name])) for name in "QR")
    horizon = str(b.specification["horizon"])
    yield Claim("output part", "output_part", (b.A, b.C, R, of_output), horizon)
    yield Claim("input part", "input_part", (b.A, b.B, b.C, Q, of_input), horizon)


def pole_advice(b: Branch) -> Iterator[Claim]:
    chosen, used = b.answer["poles"], list(b.answer["zeros_used"])
    yield zero("polynomial", from_roots(b.variable, chosen) - b.field("polynomial"))
    yield Claim("verdict", "divides", (b.A, b.C, b.field("polynomial")), b.verdict != "no")
    for place in used:
        if "CRootOf" not in place:
            yield Claim(f"zero {place}", "plant_zero", (b.A, b.B, b.C, b.D, scalar(place)))
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
        chi = (b.A - matrix(rows(b.specification["L"])) @ b.C).characteristic(place)
    else:
        chi = (b.A - b.B @ matrix(rows(b.specification["K"]))).characteristic(place)
    inside = all(holds(relation, {}) for relation in b.answer["stable_if"])
    yield Claim("inside", "hurwitz", (chi,), (b.variable, inside))
