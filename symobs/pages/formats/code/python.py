"""The observer or compensator as a class of Python, without further packages: the format `python`."""

from __future__ import annotations

from typing import TYPE_CHECKING, ClassVar

from symobs.pages.formats.code.program import program_of
from symobs.tasks.result import output_format

if TYPE_CHECKING:
    from symobs.pages.formats.code.program import CodeProgram
    from symobs.tasks.result import Document

_TEMPLATE = '''"""{lines}"""

A = {A}
B = {B}
C = {C}
D = {D}
{rests}

class {kind}:
    """{kind} with its state; call step once a period."""

    def __init__(self, state=None):
        """Begin with a state of {order} numbers, with zeros where none is given."""
        self.state = [0.0] * {order} if state is None else [float(entry) for entry in state]

    def step(self, {arguments}):
        """Return {output} from lists of numbers ({sizes}), and go on by one period."""
        state, inputs = self.state, {inputs}
        self.state = [_dot(a, state) + _dot(b, inputs) for a, b in zip(A, B)]
        return [{begin}_dot(c, state) + _dot(d, inputs) for {each} in zip({tables})]


def _dot(row, column):
    return sum(entry * number for entry, number in zip(row, column))
'''


@output_format
class Python:
    """The observer or compensator as a class of plain Python with one method, step; needs a period."""

    name: ClassVar[str] = "python"
    suffix: ClassVar[str] = ".py"
    is_program: ClassVar[bool] = True

    def render(self, document: Document) -> str:
        """Return a module."""
        program = program_of(document)
        return _TEMPLATE.format(
            **program.slots(_rows) | {"lines": "\n\n".join(program.lines) + "\n"},
            arguments=", ".join(name for name, _ in program.inputs),
            **_at_rest(program),
        )


def _at_rest(program: CodeProgram) -> dict[str, str]:
    """Return what differs where the equation is one of deviations."""
    joined = f"[{', '.join(f'*{name}' for name, _ in program.inputs)}]"
    if program.at_rest is None:
        return {"rests": "", "inputs": joined, "begin": "", "each": "c, d", "tables": "C, D"}
    inputs, output = ([*values] for values in program.at_rest)
    return {
        "rests": f"INPUTS_AT_REST = {inputs}\nOUTPUT_AT_REST = {output}\n",
        "inputs": f"[value - rest for value, rest in zip({joined}, INPUTS_AT_REST)]",
        "begin": "rest + ",
        "each": "rest, c, d",
        "tables": "OUTPUT_AT_REST, C, D",
    }


def _rows(table: list[list[str]]) -> str:
    """Return a matrix as a list of rows, one a line."""
    return "[\n" + "".join(f"    [{', '.join(row)}],\n" for row in table) + "]"
