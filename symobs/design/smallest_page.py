"""The page of the smallest gain: the gain and its multipliers, and why no other gain with these poles is smaller."""

from __future__ import annotations

from functools import reduce
from operator import add
from typing import TYPE_CHECKING

from symobs.design.names import fresh_names, taken_names
from symobs.design.smallest import proof_of, quadratics, smallest, stacked
from symobs.design.stationary import LeastStationary
from symobs.exact import Matrix, Scalar
from symobs.exact.functions import known, roots_in
from symobs.exact.real import RealRoot
from symobs.formula import Decimals
from symobs.formula.term import Term, block
from symobs.page import Page, predicate, relation

if TYPE_CHECKING:
    from collections.abc import Sequence

    from symobs.design.assignment import Pair
    from symobs.design.gain import GainDesign
    from symobs.design.gain_pages import Side
    from symobs.formula import Relation
    from symobs.specification import DesiredPolynomial

#: A gain, a multiplier or a polynomial with more terms is not written out: of the first two the decimals are.
_GAIN, _MULTIPLIER, _POLYNOMIAL = 40, 8, 24
#: A matrix Q of higher order is not written out.
_WIDE = 6


def write_smallest(page: Page, design: GainDesign, side: Side) -> None:
    """Write the smallest gain of several outputs (inputs), and the proof that it is."""
    desired, gain, pair = design.desired, design.answer[side.gain], design._pair  # noqa: SLF001 - the witness
    assert desired is not None  # noqa: S101 - poles are asked for
    if not any(gain.entries):
        page.define(side.gain, gain, say=f"smallest_zero_{side.kind}", answer=True)
        return
    found = smallest(pair, desired, page.plant.symbols.signs)
    if isinstance(found, LeastStationary):
        _least_stationary(page, design, side)
        return
    multipliers = found.multipliers
    page.with_roots(gain, *multipliers)
    page.remark(f"smallest_wanted_{side.kind}")
    _root(page, r"\mu", "smallest_root", gain, *multipliers)
    _gain(page, side, gain)
    names = [f"lambda_{k + 1}" for k in range(len(multipliers))]
    terms = [page.set(name, value) for name, value in zip(names, multipliers, strict=True)]
    page.equal(*(_shown(page, term) for term in terms), say="smallest_multipliers")
    _proof(page, design, side, (pair, desired), terms)


def _least_stationary(page: Page, design: GainDesign, side: Side) -> None:
    """Write the gain whose sum of squares is the least root of the polynomial that all stationary sums obey."""
    gain = design.answer[side.gain]
    page.with_roots(gain)
    page.remark(f"smallest_wanted_{side.kind}")
    page.remark(f"smallest_stationary_{side.kind}")
    _root(page, r"\rho", "smallest_sum", gain)
    _gain(page, side, gain)
    entries = page.set("entries_g", stacked(design.oriented(gain)))
    (rho,) = gain.names
    page.equal(relation(entries.T @ entries, Scalar.symbol(rho)), say="smallest_sum_of_gain")


def _root(page: Page, form: str, say: str, *values: Scalar | Matrix) -> None:
    """Introduce μ, the real root of which the answer is made, where it has no closed form."""
    found = {root for value in values for name in value.names if isinstance(root := known(name), RealRoot)}
    for root in found:
        mu = Scalar.symbol(root.name)
        page.forms[root.name] = form
        low, high = root.number.between()
        polynomial = root.argument.substitute(dict.fromkeys(root.argument.names, mu))
        ends = [page.term(Decimals(Scalar.of(end))) for end in (low, high)]
        bounds = relation(ends[0], "<", page.value(mu), "<", ends[1])
        page.equal(relation(page.value(polynomial), 0), bounds, say=say)


def _gain(page: Page, side: Side, gain: Matrix) -> None:
    """Write the gain; where it is long its decimals, and letters for its entries, in which the page goes on."""
    near = page.decimals(gain)
    if gain.size <= _GAIN or not near:
        page.define(side.gain, gain, answer=True)
        if near:
            page.equal(relation(page[side.gain], *near), say="in_decimals")
        return
    rows, columns = gain.shape
    names = [f"{side.gain.lower()}_{i + 1}{j + 1}" for i in range(rows) for j in range(columns)]
    if not taken_names(page).isdisjoint(names):
        names = list(fresh_names(f"{side.gain.lower()}_", len(names), taken_names(page)))
    letters = [page.name_coefficient(name, entry) for name, entry in zip(names, gain.entries, strict=True)]
    named = Matrix.of([letters[i * columns : (i + 1) * columns] for i in range(rows)])
    say = "smallest_long_with_roots" if roots_in(gain) else "smallest_long"
    page.define(side.gain, named, *near, say=say, answer=True)


def _shown(page: Page, term: Term) -> Relation:
    """Return a multiplier with its value, or with its decimals."""
    near = page.decimals(term.value)
    if near and term.value.size > _MULTIPLIER:
        return relation(term, *near)
    return relation(term, term.shown, *near)


def _proof(
    page: Page, design: GainDesign, side: Side, asked: tuple[Pair, DesiredPolynomial], multipliers: Sequence[Term]
) -> None:
    """Write the identity for every change Δ of the gain, and that its last part is never negative."""
    gain = design.oriented(design.answer[side.gain])
    proof = proof_of(*asked, gain, [term.value for term in multipliers])
    count, order = len(multipliers), page.plant.order
    change = page.set("Delta_g", design.oriented(proof.change))
    deviations = [page.set(f"d_{k + 1}", value) for k, value in enumerate(proof.deviation)]
    weighted = reduce(add, (d @ page.s ** (count - 1 - k) if k < count - 1 else d for k, d in enumerate(deviations)))
    moved = page[side.gain] + change
    moved = moved @ page["C"] if side.gain == "L" else page["B"] @ moved
    determinant = (page.s @ page.identity(order) - page["A"] + moved).apply("det")
    page.equal(relation(determinant, page[side.phi] + weighted), say=f"smallest_deviation_{side.kind}")
    entries, added = page.set("entries_g", stacked(gain)), page.set("entries_D", stacked(proof.change))
    wide = proof.hessian.shape[0] > _WIDE
    say = "" if wide else "smallest_matrix"
    Q = page.define("Q_g", _hessian(page, asked, multipliers), silent=wide, closing=False, say=say)
    sizes = (entries + added).T @ (entries + added)
    lagrangian = reduce(add, (term @ d for term, d in zip(multipliers, deviations, strict=True)), sizes)
    page.equal(
        relation(lagrangian, entries.T @ entries + added.T @ Q @ added),
        say="smallest_identity_of_derivatives" if wide else "smallest_identity",
    )
    polynomial = (page.s @ page.identity(proof.hessian.shape[0]) + Q).apply("det")
    rising = polynomial.shown
    if rising.value.size <= _POLYNOMIAL:
        page.equal(relation(polynomial, rising), say="smallest_rising")
    positive = predicate("no_negative_coefficient", polynomial)
    page.conclude("smallest_proved", relation(Q, Q.T), positive)


def _hessian(page: Page, asked: tuple[Pair, DesiredPolynomial], multipliers: Sequence[Term]) -> Term:
    """Return I + Σ λₖ Qₖ with the multipliers as letters."""
    forms = [q.form for q in quadratics(*asked)]
    size = forms[0].shape[0]

    def entry(i: int, j: int) -> Term:
        parts = [page.value(int(i == j))] if i == j else []
        for form, term in zip(forms, multipliers, strict=True):
            factor = form[i, j]
            if factor:
                parts.append(term if factor.is_one else page.value(factor) @ term)
        return reduce(add, parts) if parts else page.value(0)

    return block([[entry(i, j) for j in range(size)] for i in range(size)])
