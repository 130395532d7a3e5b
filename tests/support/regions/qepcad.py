"""QEPCAD B as a judge of regions: what it is asked, how long it takes, and its answer read back as a formula.

It is asked in two ways.  The quick one gives it Liénard and Chipart's strict inequalities, made in plain fractions by
`tests.support.regions.region_algebra`; the slow one gives it roots: some x + iy with x ≥ 0 (|z|
≥ 1) and χ(x + iy) = 0, quantified.

Debian's `qepcad` needs no environment variable.  It ends in a segmentation fault where its input ends early, so an
answer counts only where it is printed whole.
"""

from __future__ import annotations

import re
import tempfile
from dataclasses import dataclass
from fractions import Fraction
from itertools import permutations, product
from pathlib import Path
from typing import TYPE_CHECKING

from tests.programs.benchmarks import other_systems
from tests.support.regions.region_algebra import (
    FALSE,
    TRUE,
    All,
    Atom,
    Polynomial,
    Some,
    atoms,
    names_of,
    opposite,
    without_not,
)
from tests.support.regions.region_texts import formula

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from tests.support.regions.region_algebra import Formula
    from tests.support.regions.region_problem import Problem

_ANSWER = re.compile(r"An equivalent quantifier-free formula:\s*(.*?)\s*(?:=====|Before Solution)", re.DOTALL)
_REPEATED = (8, 100)  # more where it is quick: two starts differ by some milliseconds
_LONG = 0.05
_CELLS = 20_000_000  # of saclib, where the default does not suffice: reserving them takes 0.1 s


@dataclass(frozen=True)
class Question:
    """A prenex formula: the free variables first, then those bound by `quantifier`, E or A."""

    free: tuple[str, ...]
    bound: tuple[str, ...]
    matrix: Formula
    quantifier: str = "E"

    def text(self) -> str:
        """Return it as QEPCAD reads it; it knows no constant truth values."""
        prefix = "".join(f"({self.quantifier} {name})" for name in self.bound)
        some = (*self.free, *self.bound)[0]
        body = (
            written(folded(self.matrix)) or {TRUE: f"{some}^2 + 1 > 0", FALSE: f"{some}^2 + 1 < 0"}[folded(self.matrix)]
        )
        names = ",".join((*self.free, *self.bound))
        return f"[ region ]\n({names})\n{len(self.free)}\n{prefix}[ {body} ].\n"


@dataclass(frozen=True)
class Reply:
    """The solution formula, and the run it took."""

    formula: Formula
    text: str
    run: other_systems.Run


def folded(found: Formula) -> Formula:
    """Return a set without negations and without atoms that have no variable."""
    match without_not(found):
        case Atom(value, op) as atom:
            constant = value.constant
            if constant is None:
                return atom
            holds = {"=": constant == 0, "!=": constant != 0, ">": constant > 0, "<": constant < 0}
            return TRUE if holds.get(op, holds["="] or holds.get(op[0], False)) else FALSE
        case All(parts):
            kept = tuple(part for part in map(folded, parts) if part != TRUE)
            return FALSE if FALSE in kept else kept[0] if len(kept) == 1 else All(kept)
        case Some(parts):
            kept = tuple(part for part in map(folded, parts) if part != FALSE)
            return TRUE if TRUE in kept else kept[0] if len(kept) == 1 else Some(kept)
        case other:
            raise TypeError(other)


def written(found: Formula) -> str:
    """Return a folded set as text; empty for everything and for nothing."""
    match found:
        case Atom(value, op):
            return f"{value.integral()} {op.replace('!=', '/=')} 0"
        case All(parts):
            return " /\\ ".join(f"[ {written(part)} ]" for part in parts)
        case Some(parts):
            return " \\/ ".join(f"[ {written(part)} ]" for part in parts)
        case other:
            raise TypeError(other)


def _program(question: Question, times: int) -> str:
    if times == 1:
        return f"{question.text()}finish\n"
    return f"{question.text()}go\ngo\ngo\nsolution T\ncontinue\n" * (times - 1) + _program(question, 1)


def _run(question: Question, limit: float, times: int = 1, options: Sequence[str] = ()) -> other_systems.Run | None:
    with tempfile.TemporaryDirectory() as folder:
        return other_systems.run(["qepcad", "-noecho", *options], limit, _program(question, times), folder=Path(folder))


def ask(question: Question, limit: float = 60) -> Reply | None:
    """Return QEPCAD's answer; None where it gives none in time, or gives up."""
    for options in ((), (f"+N{_CELLS}",)):
        run = _run(question, limit, options=options)
        if run is None:
            return None
        match = _ANSWER.search(run.output)
        if match is not None:
            text = " ".join(match.group(1).split())
            return Reply(formula(text), text, run)
    return None


def seconds(question: Question, limit: float = 60) -> float | None:
    """Return the processor time of a question alone: many in one process less one, divided."""
    one = _run(question, limit)
    found = None
    for times in _REPEATED:
        many = _run(question, limit, times + 1)
        if one is None or many is None or len(_ANSWER.findall(many.output)) != times + 1:
            break
        found = max(many.seconds - one.seconds, 0.0) / times
        if found > _LONG:
            break
    return found


# -- what is asked --------------------------------------------------------------------------------------------------


def inequalities(problem: Problem) -> Iterator[tuple[str, Question]]:
    """Yield the quick questions that mean the same: both forms of the conditions, all orders of the variables."""
    orders = permutations(problem.parameters)
    for form, order in product(("even", "odd"), orders):
        matrix = All((assumptions(problem), problem.stable(form)))
        yield f"{form}, {' '.join(order)}", Question((*problem.symbols, *order), (), matrix)


def roots_outside(problem: Problem) -> Iterator[Question]:
    """Yield questions which together are: where has χ a root that is not stable, or a lower degree?

    For a real root χ(x) = 0; for a pair x ± i√u the real part of χ, and the imaginary part divided by √u, are
    polynomials in x and u, of half the degree in u; u is put in where it has a constant coefficient.
    """
    coefficients = problem.coefficients()
    x, u = Polynomial.symbol("x"), Polynomial.symbol("u")
    real, imaginary = Polynomial.of(0), Polynomial.of(0)
    a, b = Polynomial.of(1), Polynomial.of(0)  # (x + i√u)ᵏ = a + i√u b
    for c in reversed(coefficients):
        real, imaginary = real + c * a, imaginary + c * b
        a, b = a * x - b * u, a + b * x
    outside = Atom(x * x + u - 1, ">=") if problem.discrete else Atom(x, ">=")
    real_outside = Atom(outside.value.at({"u": Fraction(0)}), ">=")
    given = assumptions(problem)
    if coefficients[0].constant is None:
        yield Question(problem.names, (), All((given, Atom(coefficients[0], "="))))
    line = All((given, real_outside, Atom(real.at({"u": Fraction(0)}), "=")))
    yield Question(problem.names, ("x",), line)
    parts = imaginary.coefficients("u")
    if len(parts) == 2 and parts[0].constant:
        solved = parts[1] * (-1 / parts[0].constant)
        pair = (outside.value.at({"u": solved}), solved, real.at({"u": solved}))
        matrix = All((given, *(Atom(v, op) for v, op in zip(pair, (">=", ">", "="), strict=True))))
        yield Question(problem.names, ("x",), matrix)
    elif len(coefficients) > 2:
        plane = All((given, outside, Atom(u, ">"), Atom(real, "="), Atom(imaginary, "=")))
        yield Question(problem.names, ("x", "u"), plane)


def assumptions(problem: Problem) -> Formula:
    """Return what the declared signs say."""
    if any(sign != "positive" for sign in problem.symbols.values()):
        raise NotImplementedError(problem.symbols)
    return All(tuple(Atom(Polynomial.symbol(name), ">") for name in problem.symbols))


def region(problem: Problem, limit: float = 60) -> Reply | None:
    """Return QEPCAD's region by the quick question."""
    _, question = next(inequalities(problem))
    return ask(question, limit)


def region_by_roots(problem: Problem, limit: float = 60) -> Formula | None:
    """Return QEPCAD's region by the questions about roots; None where one has no answer in time."""
    found: list[Formula] = [assumptions(problem)]
    for question in roots_outside(problem):
        reply = ask(question, limit)
        if reply is None:
            return None
        found.append(opposite(reply.formula))
    return All(tuple(found))


def is_empty(found: Formula, limit: float = 60) -> bool | None:
    """Return whether no real point lies in a set; None where QEPCAD does not say."""
    names = sorted(names_of(found), key=lambda name: (max(atom.value.degree(name) for atom in atoms(found)), name))
    if not names:
        return folded(found) == FALSE
    reply = ask(Question((), tuple(names), found), limit)
    return None if reply is None else {TRUE: False, FALSE: True}.get(folded(reply.formula))
