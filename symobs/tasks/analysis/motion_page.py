"""Equations of motion as the page states them: energies, Lagrange's equations, and the highest derivatives."""

from __future__ import annotations

from typing import TYPE_CHECKING

from symobs.exact import Matrix, Scalar
from symobs.exact.core.generators import derivative
from symobs.formula.tree import Derivative, Letter, Literal, Product, Sum, SymbolList
from symobs.proof.derivation.builder import relation
from symobs.system.motion import rate_of, simplified

if TYPE_CHECKING:
    from symobs.formula.tree import Formula, Relation
    from symobs.proof.derivation.builder import Builder
    from symobs.system.motion import Motion

ZERO = Scalar.of(0)
#: As many generalised momenta have letters, with which Lagrange's equations are held to the energies.
MOST_MOMENTA = 9


def state_motion(page: Builder, motion: Motion, *, is_question: bool = False) -> None:
    """State the equations as given, or derive them from the energies, and solve them for the highest derivatives.

    These mean what they are solved for: each equation is held to that.  A question derives and solves nothing.
    """
    M, rest = motion.mass, motion.rest
    solved = Matrix.column([simplified(value) for value in M.solve(-rest).entries])
    page.in_time(M, rest, solved, *motion.equations, *motion.energies)
    w = Matrix.column([page.name_coefficient(*pair) for pair in zip(motion.highest, solved.entries, strict=True)])
    several = len(motion.equations) > 1
    if motion.kinetic is not None:
        _state_energies(page, motion)
        if is_question:
            return
        _tell_slopes(page, motion)
        law = relation(page.value(M) @ page.value(w), -rest) if several else relation(M[0, 0] * w[0, 0], -rest[0, 0])
        page.equal(law, say="lagrange")
        if len(motion.coordinates) <= MOST_MOMENTA:
            page.conclude_silently(*_lagrange(page, motion))
    else:
        sides = (relation(left, right) for left, right in motion.sides)
        page.equal(*sides, say="equations_of_motion", coordinates=SymbolList(motion.coordinates))
        if is_question:
            return
    if any(not M[i, j].is_zero for i in range(len(w.entries)) for j in range(len(w.entries)) if i != j):
        page.set("M_q", M)
        determinant = simplified(M.determinant())
        page.equal(relation(page["M_q"], M), relation(page("det(M_q)"), determinant), say="mass_determinant")
        page.remark("solved_for_highest", derivatives=SymbolList(motion.highest))


def _state_energies(page: Builder, motion: Motion) -> None:
    assert motion.kinetic is not None  # noqa: S101 - the caller has looked
    assert motion.potential is not None  # noqa: S101
    page.remark(
        "energies" if any(motion.forces) else "energies_without_forces", coordinates=SymbolList(motion.coordinates)
    )
    shown = [relation(page.set("T_q", motion.kinetic), motion.kinetic)]
    shown.append(relation(page.set("V_q", motion.potential), motion.potential))
    if any(motion.forces):
        forces = Matrix.column(motion.forces)
        shown.append(relation(page.set("Q_q", forces), forces))
    page.given(*shown)


def _tell_slopes(page: Builder, motion: Motion) -> None:
    assert motion.kinetic is not None  # noqa: S101 - as above
    assert motion.potential is not None  # noqa: S101
    lines = [
        relation(page.term(Derivative(Letter(letter), name)), slope)
        for q in motion.coordinates
        for letter, energy, name in (
            ("T_q", motion.kinetic, rate_of(q)),
            ("T_q", motion.kinetic, q),
            ("V_q", motion.potential, q),
        )
        if not (slope := derivative(energy, name)).is_zero
    ]
    page.equal(*lines, say="slopes_of_energies")


def _lagrange(page: Builder, motion: Motion) -> list[Relation]:
    """Return that each equation is d/dt ∂T/∂q′ − ∂T/∂q + ∂V/∂q − Q, with d/dt by the chain rule."""
    found = []
    for number, (q, equation, force) in enumerate(
        zip(motion.coordinates, motion.equations, motion.forces, strict=True), 1
    ):
        momentum = page.set(f"p_q{number}", derivative(motion.kinetic or ZERO, rate_of(q))).formula
        parts: list[Formula] = [
            Product((Derivative(momentum, rate_of(p, times)), Literal(Scalar.symbol(rate_of(p, times + 1)))))
            for p in motion.coordinates
            for times in (0, 1)
            if not derivative(derivative(motion.kinetic or ZERO, rate_of(q)), rate_of(p, times)).is_zero
        ]
        total = page.term(Sum(tuple(parts))) if len(parts) > 1 else page.term(parts[0]) if parts else page.value(ZERO)
        for letter, energy, sign in (("T_q", motion.kinetic, -1), ("V_q", motion.potential, 1)):
            if energy is not None and not derivative(energy, q).is_zero:
                slope = page.term(Derivative(Letter(letter), q))
                total = total + slope if sign > 0 else total - slope
        found.append(relation(total - page.value(force), equation))
    return found
