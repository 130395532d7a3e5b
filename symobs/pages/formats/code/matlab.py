"""The observer or compensator as a function of MATLAB and Octave, or the numbers alone: the format `matlab`."""

from __future__ import annotations

from typing import TYPE_CHECKING, ClassVar

from symobs.pages.formats.code.program import number_rows, program_of
from symobs.tasks.result import output_format

if TYPE_CHECKING:
    from collections.abc import Sequence

    from symobs.tasks.result import Document

_TEMPLATE = """function [{output}, state] = {name}_step(state, {arguments})
{lines}
%
% Call it once a period with columns ({sizes}) and the state it returned before; [] is the state 0.
% Save it as {name}_step.m.
A = {A};
B = {B};
C = {C};
D = {D};
if isempty(state)
    state = zeros({order}, 1);
end
inputs = [{joined}]{less};
{output} = C * state + D * inputs{plus};
state = A * state + B * inputs;
end
"""


@output_format
class Matlab:
    """The observer or compensator as a function of MATLAB and Octave; needs a period.  With --print the numbers alone."""

    name: ClassVar[str] = "matlab"
    suffix: ClassVar[str] = ".m"
    is_program: ClassVar[bool] = True

    def render(self, document: Document) -> str:
        """Return a function file."""
        program = program_of(document)
        return _TEMPLATE.format(
            **program.slots(_rows, "% "),
            arguments=", ".join(name for name, _ in program.inputs),
            joined="; ".join(f"{name}(:)" for name, _ in program.inputs),
            less=f" - {_column(program.at_rest[0])}" if program.at_rest else "",
            plus=f" + {_column(program.at_rest[1])}" if program.at_rest else "",
        )

    def answers(self, document: Document) -> str:
        """Return the numbers as assignments."""
        rows = number_rows(document, "a matrix of MATLAB")
        return "".join(f"{name} = {_rows(table)};\n" for name, table in rows.items())


def _column(values: Sequence[float]) -> str:
    return f"[{'; '.join(map(repr, values))}]"


def _rows(table: list[list[str]]) -> str:
    return "[" + "; ".join(" ".join(row) for row in table) + "]"
