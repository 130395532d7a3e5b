"""Lines on the way to a linearisation: equations of motion, M(q) and f, and the energies, held against the nonlinear plant.

An equation is true where both sides are equal once the highest derivatives are those of the plant, or of its linearisation.
"""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from symobs.applications.checking.answers import Step, exact, typed
from symobs.applications.checking.handwriting import in_letters, readable, without_drawings, without_marks
from symobs.applications.checking.report import Line
from symobs.exact import Matrix, Scalar
from symobs.exact.core.generators import symbols_in
from symobs.formula.expression import parse_matrix, without_latex
from symobs.ground.errors import InputError, SymobsError
from symobs.problem.agreement import functions_agree
from symobs.system.motion import rate_of, simplified, typed_derivatives

if TYPE_CHECKING:
    from collections.abc import Mapping

    from symobs.system import StateSpace
    from symobs.system.reading import Nonlinear

_LONGEST = 5_000
_MASS = re.compile(r"M(?:\s*\([^()=]*\))?")
_RIGHT_SIDE = re.compile(r"f(?:\s*\([^()=]*\))?")
_ENERGIES = {"kinetic": re.compile(r"T|E_?kin|K_?E"), "potential": re.compile(r"V|U|E_?pot|P_?E")}
#: What is left of LaTeX's derivatives where its commands are read.
_LEFT_OF_LATEX = re.compile(r"(?<![A-Za-z])(d{1,2})ot\s*\{?\s*([A-Za-z]\w*)\s*\}?")


def of_motion(relation: str, plant: StateSpace) -> Line | None:
    """Return a line that speaks of the nonlinear plant, with its verdict; None for any other."""
    given = plant.nonlinear
    if given is None or len(relation) > _LONGEST or relation.count("=") != 1:
        return None
    variables = given.states if given.motion is None else given.motion.coordinates
    text = _LEFT_OF_LATEX.sub(lambda f: f"{f[2]}{chr(39) * len(f[1])} ", typed(relation))
    try:
        text = without_latex(without_drawings(without_marks(typed_derivatives(text, variables, ""))))
        left, right = (side.strip() for side in text.split("="))
        return _of_sides(relation, left, right, plant, given, has_rates="_dot" in text or "_ddot" in text)
    except (SymobsError, ZeroDivisionError):
        return None


def without_motion(text: str, plant: StateSpace) -> tuple[tuple[Step, ...], str]:
    """Return the lines of a text that speak of the nonlinear plant as steps, and the text without them."""
    kept, steps = list[str](), list[Step]()
    for number, line in enumerate(text.splitlines(), start=1):
        is_of_motion = of_motion(line.strip(), plant) is not None
        kept.append("" if is_of_motion else line)
        steps += [Step(line.strip(), f"line {number}")] if is_of_motion else []
    return tuple(steps), "\n".join(kept)


def _of_sides(
    relation: str, left: str, right: str, plant: StateSpace, given: Nonlinear, *, has_rates: bool
) -> Line | None:
    """Return the line of two sides with its verdict; raises `SymobsError` where they are not read."""
    own = {*plant.symbols.signs}
    motion = given.motion
    if motion is not None and "M" not in own and _MASS.fullmatch(left):
        return _of_matrix(relation, _read(right, plant, given), motion.mass, "the matrix of the highest derivatives")
    if "f" not in own and _RIGHT_SIDE.fullmatch(left) and "[" in right:
        return _of_matrix(relation, _read(right, plant, given), given.f, "f")
    if motion is not None and motion.kinetic is not None:
        for name, pattern in _ENERGIES.items():
            if pattern.fullmatch(left) and left not in own and "[" not in right:
                mine = _read(right, plant, given)[0, 0]
                is_energy = symbols_in(mine) & {*given.states}
                return _of_energy(relation, mine, name, given, plant) if is_energy else None
    rests = dict(given.equilibrium).get(re.sub(r"(?:_?[0e])?(?:\s*\^?\s*\*)?$", "", left))
    if rests is not None and left not in own and functions_agree(_read(right, plant, given)[0, 0], rests):
        return Line("", relation, "true")
    if not has_rates:
        return None
    sides = [_read(side, plant, given) for side in (left, right)]
    if any(side.shape != (1, 1) for side in sides):
        return None
    difference = sides[0][0, 0] - sides[1][0, 0]
    if any(_vanishes(difference, rates, plant) for rates in _rates(plant, given)):
        return Line("", relation, "true")
    return Line("", relation, "false", reason="it does not follow from the equations of motion")


def _read(text: str, plant: StateSpace, given: Nonlinear) -> Matrix:
    """Return a side as a matrix, in the letters of the plant and its derivatives."""
    names = plant.symbols.names
    signals = {*given.states, *given.inputs}
    variables = given.states if given.motion is None else given.motion.coordinates
    signals |= {rate_of(name, times) for name in variables for times in (1, 2)}
    known = None if names is None else {**names, **dict.fromkeys(sorted(signals), "real")}
    text = in_letters(readable(text), {*plant.symbols.signs, *signals}, plant.variable)
    return parse_matrix(exact(text), known, functions=True, nonlinear=True)


def _rates(plant: StateSpace, given: Nonlinear) -> list[dict[str, Scalar]]:
    """Return the highest derivatives by name, those of the plant and those of its linearisation."""
    at = [given.f.entries]
    if plant.inputs == len(given.inputs) and given.equilibrium:
        signals = Matrix.column([Scalar.symbol(name) for name in (*given.states, *given.inputs)])
        at.append((Matrix.block([[plant.matrices.A, plant.matrices.B]]) @ signals).entries)
    named = [f"{name.removesuffix('_dot')}_ddot" if name.endswith("_dot") else rate_of(name) for name in given.states]
    return [dict(zip(named, values, strict=True)) for values in at]


def _vanishes(difference: Scalar, rates: Mapping[str, Scalar], plant: StateSpace) -> bool:
    states = {name for name in rates if name in symbols_in(difference)}
    moved = difference.substitute({name: rates[name] for name in states})
    return functions_agree(simplified(moved), Scalar.of(0), plant.symbols.signs)


def _of_matrix(relation: str, mine: Matrix, right: Matrix, what: str) -> Line:
    if mine.shape != right.shape:
        raise InputError("another shape")
    wrong = [
        f"({i + 1}, {j + 1})" if right.shape[1] > 1 else str(i + 1)
        for i, row in enumerate(mine.rows)
        for j, entry in enumerate(row)
        if not functions_agree(simplified(entry - right[i, j]), Scalar.of(0))
    ]
    if not wrong:
        return Line("", relation, "true")
    return Line("", relation, "false", reason=f"entry {', '.join(wrong[:3])} of {what} is another")


def _of_energy(relation: str, mine: Scalar, name: str, given: Nonlinear, plant: StateSpace) -> Line:
    """Return the verdict on T or V, where a constant counts for nothing."""
    motion = given.motion
    assert motion is not None  # noqa: S101 - asked for energies alone
    right = getattr(motion, name)
    right = Scalar.of(0) if right is None else right
    difference = simplified(mine - right)
    signals = {*given.states, *given.inputs}
    if not symbols_in(difference) & signals and (name == "potential" or difference.is_zero):
        return Line("", relation, "true")
    if functions_agree(mine, right, plant.symbols.signs):
        return Line("", relation, "true")
    return Line("", relation, "false", reason=f"the {name} energy is another")
