"""The observer or compensator as a block of Modelica, in continuous time or sampled: the format `modelica`."""

from __future__ import annotations

from typing import TYPE_CHECKING, ClassVar

from symobs.ground.errors import UsageError
from symobs.pages.formats.code.program import program_of
from symobs.tasks.result import output_format

if TYPE_CHECKING:
    from symobs.tasks.result import Document

_TEMPLATE = """block {kind}
{lines}
{signals}
protected
  constant Real A[{order}, {order}] = {A};
  constant Real B[{order}, {width}] = {B};
  constant Real C[{outputs}, {order}] = {C};
  constant Real D[{outputs}, {width}] = {D};
{rests}  {state} x[{order}](each start = 0, each fixed = true);
equation
{equations}
end {kind};
"""
_CONTINUOUS = """  der(x) = A * x + B * {inputs};
  {output} = C * x + D * {inputs}{plus};"""
_SAMPLED = """  when sample(0, {period}) then
    {output} = C * pre(x) + D * {inputs}{plus};
    x = A * pre(x) + B * {inputs};
  end when;"""


@output_format
class Modelica:
    """The observer or compensator as a block of Modelica; without a period in continuous time."""

    name: ClassVar[str] = "modelica"
    suffix: ClassVar[str] = ".mo"
    is_program: ClassVar[bool] = True

    def render(self, document: Document) -> str:
        """Return a block; raises `UsageError` for a plant in discrete time whose period is not known."""
        program = program_of(document, in_continuous_time=True)
        plant = document.results[0].plant
        period = program.period if program.period is not None or not plant.is_discrete else plant.dt
        if period is True:
            message = "a block of Modelica is called in time, and the period of the plant is not known"
            raise UsageError(message, where="plant.dt", repair="give dt the period, for example 1/100")
        inputs = ", ".join(name for name, _ in program.inputs)
        joined = f"cat(1, {inputs})" if len(program.inputs) > 1 else inputs
        signals = [f"  input Real {name}[{size}];" for name, size in program.inputs]
        equations = (_CONTINUOUS if period is None else _SAMPLED).format(
            inputs=f"({joined} - inputs_at_rest)" if program.at_rest else joined,
            output=program.output[0],
            period="" if period is None else repr(float(period)),
            plus=" + output_at_rest" if program.at_rest else "",
        )
        rests = "".join(
            f"  constant Real {which}_at_rest[{len(values)}] = {{{', '.join(map(repr, values))}}};\n"
            for which, values in zip(("inputs", "output"), program.at_rest or (), strict=False)
        )
        return _TEMPLATE.format(
            **program.slots(_rows, "  // "),
            signals="\n".join([*signals, f"  output Real {program.output[0]}[{program.output[1]}];"]),
            state="Real" if period is None else "discrete Real",
            equations=equations,
            rests=rests,
        )


def _rows(table: list[list[str]]) -> str:
    return "{" + ", ".join(f"{{{', '.join(row)}}}" for row in table) + "}"
