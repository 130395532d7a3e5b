"""The observer or compensator in C99, without allocation: the format `c`."""

from __future__ import annotations

from typing import TYPE_CHECKING, ClassVar

from symobs.pages.formats.code.program import program_of
from symobs.tasks.result import output_format

if TYPE_CHECKING:
    from symobs.tasks.result import Document

_TEMPLATE = """/*
{lines}
 */

typedef struct {{
    double x[{order}];
}} {name}_state;

static const double {name}_A[{order}][{order}] = {A};
static const double {name}_B[{order}][{width}] = {B};
static const double {name}_C[{outputs}][{order}] = {C};
static const double {name}_D[{outputs}][{width}] = {D};
{rests}
/* Begin with the state 0. */
void {name}_start({name}_state *state)
{{
    for (int i = 0; i < {order}; i++)
        state->x[i] = 0.0;
}}

/* Once a period: {output} from {inputs}. */
void {name}_step({name}_state *state, {arguments}, double {output}[{outputs}])
{{
    double inputs[{width}], next[{order}];
{gathered}
    for (int i = 0; i < {outputs}; i++) {{
        double sum = {begin};
        for (int j = 0; j < {order}; j++)
            sum += {name}_C[i][j] * state->x[j];
        for (int j = 0; j < {width}; j++)
            sum += {name}_D[i][j] * inputs[j];
        {output}[i] = sum;
    }}
    for (int i = 0; i < {order}; i++) {{
        double sum = 0.0;
        for (int j = 0; j < {order}; j++)
            sum += {name}_A[i][j] * state->x[j];
        for (int j = 0; j < {width}; j++)
            sum += {name}_B[i][j] * inputs[j];
        next[i] = sum;
    }}
    for (int i = 0; i < {order}; i++)
        state->x[i] = next[i];
}}
"""


@output_format
class C:
    """The observer or compensator in C99: a struct with the state and one step function; needs a period."""

    name: ClassVar[str] = "c"
    suffix: ClassVar[str] = ".c"
    is_program: ClassVar[bool] = True

    def render(self, document: Document) -> str:
        """Return a translation unit."""
        program = program_of(document)
        start, gathered, is_moved = 0, [], program.at_rest is not None
        for name, size in program.inputs:
            place = f"{start} + i" if start else "i"
            less = f" - {program.name}_inputs_at_rest[{place}]" if is_moved else ""
            gathered.append(f"    for (int i = 0; i < {size}; i++)\n        inputs[{place}] = {name}[i]{less};")
            start += size
        rests = "".join(
            f"static const double {program.name}_{which}_at_rest[{len(values)}] = {{ {', '.join(map(repr, values))} }};\n"
            for which, values in zip(("inputs", "output"), program.at_rest or (), strict=False)
        )
        return _TEMPLATE.format(
            **program.slots(_rows, " * "),
            inputs=" and ".join(name for name, _ in program.inputs),
            arguments=", ".join(f"const double {name}[{size}]" for name, size in program.inputs),
            gathered="\n".join(gathered),
            rests=rests,
            begin=f"{program.name}_output_at_rest[i]" if is_moved else "0.0",
        )


def _rows(table: list[list[str]]) -> str:
    rows = ",\n".join(f"    {{ {', '.join(row)} }}" for row in table)
    return f"{{\n{rows}\n}}"
