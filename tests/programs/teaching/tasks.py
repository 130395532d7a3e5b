"""Each entry of our own answers changed by one: right for `check` only where the claim holds by SymPy, and the reverse."""

from __future__ import annotations

import copy
import tomllib
from collections import Counter
from typing import TYPE_CHECKING, Any

import sympy as sp

from symobs.applications.checking import Checked
from symobs.formula.expression import parse_matrix
from symobs.problem import read
from symobs.tasks.result.output_methods import to_sympy
from tests.unit.applications.checking.test_judgement import EXAMPLES, own_answer

if TYPE_CHECKING:
    from collections.abc import Iterator

#: So many examples a task are gone through, and so many entries of a value.
_EXAMPLES, _ENTRIES = 2, 16
_WORDS = ("yes", "no", "conditional")
_LEFT_OUT = {"cart_pole"}  # its F is longer than an answer may be


def main(_count: int, only: str) -> bool:
    """Print a line a task; False where `check` and SymPy differ."""
    told: dict[str, Counter[str]] = {}
    seen: Counter[str] = Counter()
    for path in sorted(EXAMPLES.glob("*.toml")):
        data = tomllib.loads(path.read_text(encoding="utf-8"))
        tasks = {data.get("task", "")} | {*data.get("tasks", [])}
        if path.stem in _LEFT_OUT or all(seen[task] >= _EXAMPLES for task in tasks) or only not in {"", *tasks}:
            continue
        seen.update(tasks)
        checked = Checked.of(read(path.read_text(encoding="utf-8"), path.name, EXAMPLES))
        own = own_answer(checked)
        for task, values in own.items():
            for letter, value in values.items():
                for changed in _changes(value):
                    _try(checked, data, task, letter, changed, own, told.setdefault(task, Counter()), path.stem)
    for task, count in sorted(told.items()):
        print(f"{task}: {', '.join(f'{number} {what}' for what, number in sorted(count.items()))}", flush=True)
    every = sum(told.values(), Counter())
    print(f"{len(told)} tasks, {every.total()} changed answers, {every['differ']} of them differ from the claim")
    return not every["differ"]


def _try(
    checked: Checked, data: Any, task: str, letter: str, changed: Any, own: Any, count: Counter[str], name: str
) -> None:
    """Count what becomes of a changed value among ours, and alone."""
    for alone in (False, True):
        given = {task: {letter: changed}} if alone else {**own, task: {**own[task], letter: changed}}
        report = checked.report({"answer": given})
        (part,) = (part for part in report.parts if part.part.startswith(f"{task}.") and part.letter == letter)
        view = next(view for view in checked.views() if view.task == task)
        held = _holds(view, data, part.part.partition(".")[2], letter, changed, own[task], alone=alone)
        right = part.verdict == "right"
        if right != held:
            print(f"{name} {part.part} = {changed}: {part.verdict}, though the claim {'holds' if held else 'fails'}")
        count["differ" if right != held else "right" if right else "wrong"] += 1


def _changes(value: Any) -> Iterator[Any]:
    """Yield a value with one entry more and less by one, or another word."""
    for path, leaf in list(_leaves(value))[:_ENTRIES]:
        if leaf in _WORDS:
            yield from (_put(value, path, word) for word in _WORDS if word != leaf)
        elif isinstance(leaf, int) and not isinstance(leaf, bool):
            yield from (_put(value, path, leaf + step) for step in (1, -1))
        elif isinstance(leaf, str) and not any(sign in leaf for sign in "<>="):
            yield from (_put(value, path, f"({leaf}) {sign} 1") for sign in "+-")


def _leaves(value: Any, path: tuple[Any, ...] = ()) -> Iterator[tuple[tuple[Any, ...], Any]]:
    if isinstance(value, (list, dict)):
        for key, entry in value.items() if isinstance(value, dict) else enumerate(value):
            yield from _leaves(entry, (*path, key))
    else:
        yield path, value


def _put(value: Any, path: tuple[Any, ...], entry: Any) -> Any:
    if not path:
        return entry
    found = copy.deepcopy(value)
    place = found
    for key in path[:-1]:
        place = place[key]
    place[path[-1]] = entry
    return found


# -- the claims, by SymPy ---------------------------------------------------------------------------------------------


def _holds(view: Any, data: Any, name: str, letter: str, changed: Any, own: Any, *, alone: bool) -> bool:
    """Return whether a changed value meets the claim of its task; where there is one right value, no changed one does."""
    m = view.plant.matrices
    A, B, C = (sp.Matrix(to_sympy(part, {})) for part in (m.A, m.B, m.C))
    is_matrix = name in {"K", "L", "K_d", "M", "T", "A", "B", "C"}
    new, old = (_matrix(rows) if is_matrix else sp.Matrix() for rows in (changed, own[letter]))
    match view.task, name:
        case ("state_feedback" | "compensator", "K"):
            return bool(
                _polynomial(A + _sign(view, letter) * B * new) == _polynomial(A + _sign(view, letter) * B * old)
            )
        case ("observer" | "compensator", "L"):
            return bool(
                _polynomial(A + _sign(view, letter) * new * C) == _polynomial(A + _sign(view, letter) * old * C)
            )
        case "tracking", "K_d":
            asked = data["specification"]
            moves = _matrix(asked["reference_matrix"])
            start = _matrix(asked["reference_start"]) if "reference_start" in asked else sp.eye(A.rows)
            courses = sp.Matrix.hstack(*[moves**k * start for k in range(A.rows)])
            return bool(sp.simplify(B * (new - old) * courses).is_zero_matrix)
        case "reduced_order_observer", "M" if alone:
            outputs = C.rows
            if new.det() == 0 or new.inv()[:outputs, :] != C:
                return False
            P = new.inv()[outputs:, :]
            return bool(_polynomial(P * A * new[:, outputs:]) == _polynomial(_matrix(own["F"])))
        case "canonical_form", _ if alone and data["specification"]["kind"] in {"controllable", "observable"}:
            return any(new == form["TABC".index(name)] for form in _layouts(A, B, C, data["specification"]["kind"]))
        case "decomposition", "T":
            return bool(new.det() != 0) and _is_in_blocks(new, A, B, C, list(own["sizes"].values()))
    return False


def _matrix(rows: Any) -> sp.Matrix:
    return sp.Matrix(to_sympy(parse_matrix(rows, None), {}))


def _sign(view: Any, letter: str) -> int:
    return -int(view.standard(letter)[1])


def _polynomial(matrix: sp.Matrix) -> sp.Expr:
    return sp.simplify(matrix.charpoly(sp.Symbol("lambda")).as_expr())


def _layouts(A: sp.Matrix, B: sp.Matrix, C: sp.Matrix, kind: str) -> Iterator[tuple[sp.Matrix, ...]]:
    """Yield T, A, B and C of the four layouts, for one input respectively one output."""
    n = A.rows
    turned = sp.Matrix(n, n, lambda i, j: int(i + j == n - 1))
    coefficients = A.charpoly(sp.Symbol("lambda")).all_coeffs()[1:]
    last_row = sp.Matrix(n, n, lambda i, j: -coefficients[n - 1 - j] if i == n - 1 else int(j == i + 1))
    first, last = sp.eye(n)[:, 0], sp.eye(n)[:, n - 1]
    pairs = [(last_row, last), (turned * last_row * turned, first)]
    pairs += [(last_row.T, first), (turned * last_row.T * turned, last)]
    for matrix, unit in pairs:
        if kind == "controllable":
            T = _krylov(matrix, unit) * _krylov(A, B).inv()
        else:
            T = _krylov(matrix, unit).T.inv() * _krylov(A.T, C.T).T
        yield T, T * A * T.inv(), T * B, C * T.inv()


def _krylov(A: sp.Matrix, b: sp.Matrix) -> sp.Matrix:
    return sp.Matrix.hstack(*[A**k * b for k in range(A.rows)])


def _is_in_blocks(T: sp.Matrix, A: sp.Matrix, B: sp.Matrix, C: sp.Matrix, sizes: list[int]) -> bool:
    """Return whether the zero blocks stand where the decomposition has them: co, c_no, nc_o, nc_no."""
    ends = [sum(sizes[:k]) for k in range(5)]
    at = [slice(ends[k], ends[k + 1]) for k in range(4)]
    inside, entering, leaving = T * A * T.inv(), T * B, C * T.inv()
    zero = [inside[at[i], at[j]] for i, j in ((0, 1), (0, 3), (2, 0), (2, 1), (2, 3), (3, 0), (3, 1))]
    zero += [entering[at[2], :], entering[at[3], :], leaving[:, at[1]], leaving[:, at[3]]]
    return all(block.is_zero_matrix or 0 in block.shape for block in zero)
