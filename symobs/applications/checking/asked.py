"""What an answer may hold: an empty answer file, with the shape of everything that is asked for."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from symobs.exact import Factored, Matrix, Scalar
from symobs.problem.expect.structure import factored_table

if TYPE_CHECKING:
    from symobs.applications.checking.checker import Checked
    from symobs.formula.convention import Convention


def answer_file(checked: Checked, convention: Convention | None = None) -> str:
    """Return an empty answer file: one line for each part that counts, with its shape, none of them filled in."""
    views = checked.views(convention)
    name = (convention or checked.problem.convention).name
    lines = ['student    = ""', f'convention = "{name}"', ""]
    asked = checked.asked(views)
    fields = [field for _, field in asked]
    for view in dict.fromkeys(view.task for view, _ in asked):
        alone = all(fields.count(field) == 1 for each, field in asked if each.task == view)
        lines.append("[answer]" if alone and len(views) == 1 else f"[answer.{view}]")
        for each, field in asked:
            if each.task == view:
                letter = next((own for own, (standard, _) in each.names.items() if standard == field), field)
                weight = checked.problem.marking.parts.get(f"{view}.{field}")
                marks = f", weight {weight}" if weight is not None else ""
                lines.append(f'# {letter} = ""    # {_shape(each.result.fields.get(field), field)}{marks}')
        lines.append("")
    lines += ["# [[step]]", '# relation = ""   # a line of the derivation, in order', ""]
    return "\n".join(lines)


def _shape(right: Any, field: str) -> str:
    """Return what is expected, without a word on its value."""
    table = factored_table(right)
    matrix = right if isinstance(right, Matrix) else table
    if isinstance(matrix, Matrix):
        return f"a {matrix.shape[0]}x{matrix.shape[1]} matrix"
    if isinstance(right, (Scalar, Factored)):
        return "an expression"
    if isinstance(right, int) and not isinstance(right, bool):
        return "an integer"
    if field == "verdict":
        return "yes, no or conditional"
    if field == "stable_if":
        return "conditions: h1 > 3 and h2 > 0"
    return "a list" if isinstance(right, (list, tuple)) else "a value"
