"""A nonlinear plant and its linearisation at an equilibrium, as the page states them."""

from __future__ import annotations

from typing import TYPE_CHECKING

from symobs.exact import Matrix, Scalar
from symobs.exact.core.generators import PIECES, all_roots, functions_in, substitute
from symobs.formula.tree import At, Block, Conjunction, Derivative, Letter, Literal, SymbolList
from symobs.proof.derivation.builder import relation
from symobs.system.decided_signs import by_signs
from symobs.tasks.analysis.motion_page import state_motion

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from symobs.formula.tree import Formula
    from symobs.formula.tree.term import Term
    from symobs.proof.derivation.builder import Builder
    from symobs.system.reading import Nonlinear

#: Partial derivatives of more terms are not written out before the equilibrium is inserted.
_LONGEST = 8


def state_nonlinear(page: Builder, given: Nonlinear, *further: Matrix | Scalar, is_question: bool = False) -> None:
    """State the equations of motion, and f and h; `further` values of the same functions may follow.

    A question does not show the f that follows from equations of motion.
    """
    if given.motion is not None:
        state_motion(page, given.motion, is_question=is_question)
    functions = [function for function in (given.f, given.h) if function is not None]
    page.in_time(*functions, *further)
    time = "discrete" if page.plant.is_discrete else "continuous"
    states, arguments = SymbolList(given.states), SymbolList((*given.states, *given.inputs))
    page.remark(f"nonlinear_{'state_' if given.h is None else ''}{time}", states=states, arguments=arguments)
    page.assume_positive(_radicands(given, functions))
    law = relation(page.set("f_x", given.f), given.f)
    shown = [] if is_question and given.motion is not None else [law]
    if given.h is not None:
        shown.append(relation(page.set("h_x", given.h), given.h))
    if shown:
        page.given(*shown)


def state_linearisation(page: Builder, *, is_question: bool = False) -> None:
    """State f and h, hold f to its equilibrium, and derive A, B, C and D as partial derivatives there.

    A question states what was given alone: the rest is its first step, which `ask_to_linearise` asks for.
    """
    plant, given = page.plant, page.plant.nonlinear
    assert given is not None  # noqa: S101 - the caller has looked
    m = plant.matrices
    functions = [function for function in (given.f, given.h) if function is not None]
    jacobians = [
        given.jacobian(function, names) for function in functions for names in (given.states, given.inputs) if names
    ]
    moved = [_at_equilibrium(given, function) for function in (*functions, *jacobians)]
    further: list[Matrix | Scalar] = [*moved, *(value for _, value in given.equilibrium), m.A, m.B, m.C, m.D]
    state_nonlinear(page, given, *further, is_question=is_question)
    page.where(*_pieces_by_signs(moved, plant.symbols.signs))
    page.assume_positive(given.positive)
    f, time = page["f_x"], "discrete" if plant.is_discrete else "continuous"
    rest = Matrix.of([[dict(given.equilibrium)[name] if plant.is_discrete else Scalar.of(0)] for name in given.states])
    at_rest = f.formula
    for name, there in given.equilibrium:
        at_rest = At(at_rest, name, there)
    rests = relation(page.term(at_rest), rest)
    if is_question:
        page.conclude_silently(rests)
        return
    page.equal(rests, say=f"equilibrium_{time}")
    lines = []
    for letter, function, name in (("A", given.f, "f_x"), ("C", given.h, "h_x")):
        for matrix, names in ((letter, given.states), ({"A": "B", "C": "D"}[letter], given.inputs)):
            value: Matrix = getattr(m, matrix)
            if function is None or not names or (matrix == "D" and not m.has_feedthrough):
                continue
            jacobian = given.jacobian(function, names)
            page.set(matrix, value)
            columns = _there(page, given, partial_derivatives(name, jacobian, names))
            is_told = jacobian != value and max(entry.size for entry in jacobian.entries) <= _LONGEST
            between = [_there(page, given, Literal(jacobian))] if is_told else []
            lines.append(relation(page[matrix], columns, *between, value))
    page.equal(*lines, say="linearised")


def ask_to_linearise(page: Builder) -> None:
    """Ask for the linearisation, and say what its letters are; what the equilibrium leaves free has no value there."""
    plant, given = page.plant, page.plant.nonlinear
    assert given is not None  # noqa: S101 - the caller has looked
    fixed = [(name, value) for name, value in given.equilibrium if name not in given.free] or given.equilibrium
    names, values = zip(*fixed, strict=True)
    laws = [page.line("x' = A x + B u" if plant.matrices.has_input else "x' = A x")]
    if plant.matrices.has_output:
        laws.append(page.line("y = C x + D u" if plant.matrices.has_feedthrough else "y = C x"))
    there = Matrix.row(values) if len(values) > 1 else values[0]
    page.remark("linearise", names=SymbolList(names), values=there, laws=Conjunction(tuple(laws)))


def _pieces_by_signs(values: Sequence[Matrix], signs: Mapping[str, str]) -> list[Scalar]:
    """Return what vanishes since the signs of the parameters decide |x| and the signs that occur."""
    pieces = [f.value for f in functions_in(values) if f.kind in PIECES]
    return [piece - decided for piece in pieces if (decided := by_signs(piece, signs)) != piece]


def _at_equilibrium(given: Nonlinear, value: Matrix) -> Matrix:
    for name, instead in given.equilibrium:
        value = substitute(value, {name: instead})
    return value


def _radicands(given: Nonlinear, functions: Sequence[Matrix]) -> list[Scalar]:
    """Return what stands under roots with states or inputs: positive at the equilibrium, and therefore near it."""
    names = {*given.states, *given.inputs}
    found = sorted((root for root in all_roots(*functions) if root.symbols & names), key=lambda root: root.text)
    return [root.argument for root in found]


def partial_derivatives(name: str, jacobian: Matrix, names: Sequence[str]) -> Formula:
    """Return the row of the partial derivatives; one by what does not occur is written as 0."""
    columns = [Matrix.of([[entry] for entry in column]) for column in zip(*jacobian.rows, strict=True)]
    parts = [
        Literal(column) if column.is_zero else Derivative(Letter(name), by)
        for column, by in zip(columns, names, strict=True)
    ]
    return parts[0] if len(parts) == 1 else Block((tuple(parts),))


def _there(page: Builder, given: Nonlinear, formula: Formula) -> Term:
    """Return a formula at the equilibrium."""
    for name, value in given.equilibrium:
        if name not in given.free:
            formula = At(formula, name, value)
    return page.term(formula)
