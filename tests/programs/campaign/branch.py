"""A problem with one branch of its answer as terms, and the claims that several tasks share.

A problem and an answer come here as texts, with parameters or with numbers in their place; one branch at a time.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

from tests.programs.campaign.algebra import (
    Claim,
    Term,
    columns_of,
    identity,
    matrix,
    product,
    rank,
    rows_of,
    scalar,
    vectors,
    zero,
    zeros,
)
from tests.programs.campaign.asked import Tables, is_discrete, listed, rows
from tests.programs.campaign.points import holds

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence
    from fractions import Fraction

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
        return "z" if is_discrete(self.problem) else "s"

    @property
    def s(self) -> Term:
        return scalar(self.variable)

    @cached_property
    def A(self) -> Term:
        return matrix(rows(self.problem["plant"]["A"]))

    @cached_property
    def B(self) -> Term:
        return matrix(rows(self.problem["plant"]["B"]))

    @cached_property
    def C(self) -> Term:
        return matrix(rows(self.problem["plant"]["C"]))

    @cached_property
    def D(self) -> Term:
        given = self.problem["plant"].get("D")
        return zeros(rows_of(self.C), columns_of(self.B)) if given is None else matrix(rows(given))

    @property
    def order(self) -> int:
        return rows_of(self.A)

    def field(self, name: str) -> Term:
        """Return a field of the answer: a table is a matrix, a text is a scalar."""
        found = self.answer[name]
        return matrix(found) if isinstance(found, list) else scalar(found)

    def has(self, name: str) -> bool:
        return self.answer.get(name) not in (None, [])

    def desired(self, prefix: str = "") -> Term | None:
        """Return the polynomial that was asked for, from the problem alone."""
        asked = self.specification
        if f"{prefix}polynomial" in asked:
            return scalar(asked[f"{prefix}polynomial"].replace("^", "**"))
        if f"{prefix}poles" in asked:
            return product([self.s - scalar(pole) for pole in listed(asked[f"{prefix}poles"])])
        return None

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
        factors += [Term("monic", (scalar(text), variable, len(once)))] * times
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
    return C @ (b.s * identity(rows_of(A)) - A).inverse @ B + D


def as_matrix(b: Branch, name: str) -> Term:
    found = b.answer[name]
    return matrix(found) if isinstance(found, list) else matrix([[found]])
