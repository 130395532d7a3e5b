"""The blocks of Modelica 3.6 that symobs writes, read line by line and run: declarations, a sampled `when`, and equations.

A line has to be one of the few forms of the language specification, appendix A, that such blocks need; any other is an error.
"""

from __future__ import annotations

import json
import re
from typing import Any

import numpy as np

_BLOCK = re.compile(
    r"block (\w+)\n((?:(?:input|output) Real .*;\n)*)(?:protected\n((?:(?:constant |discrete )?Real .*;\n)*))?"
    r"equation\n(?:when sample\(0, (\d[\d.e-]*)\) then\n((?:.* = .*;\n)*)end when;\n|((?:.* = .*;\n)*))end \1;"
)
_DECLARED = re.compile(
    r"(?:(input|output|constant|discrete) )?Real (\w+)\[(\d+(?:, \d+)*)\](\(each start = 0, each fixed = true\))?"
    r"(?: = (\{[-\d.eE+, {}]*\}))?;"
)
_EQUATION = re.compile(r"(x|der\(x\)|\w+) = (\w+) \* (pre\(x\)|x) \+ (\w+) \* (?:cat\(1, (\w+(?:, \w+)+)\)|(\w+));")


class Block:
    """A block that was read: its signals, its matrices, its equations, and the period of its `when`."""

    def __init__(self, text: str) -> None:
        lines = (line.strip() for line in text.splitlines())
        name, signals, own, period, sampled, always = _read(
            _BLOCK, "\n".join(line for line in lines if line and not line.startswith("//"))
        )
        self.period = None if period is None else float(period)
        self.kinds: dict[str, str] = {}
        self.constants: dict[str, Any] = {}
        for line in (signals + (own or "")).splitlines():
            kind, name, sizes, start, value = _read(_DECLARED, line)
            self.kinds[name] = kind or "Real"
            if kind == "constant":
                table = np.array(json.loads(value.replace("{", "[").replace("}", "]")), dtype=float)
                if list(table.shape) != json.loads(f"[{sizes}]"):
                    raise SyntaxError(f"{name} has another size")
                self.constants[name] = table
            elif (start is not None) != (name == "x"):
                raise SyntaxError(line)
        self.equations = [self._equation(line) for line in (sampled or always).splitlines()]

    def _equation(self, line: str) -> tuple[str, str, str, str, list[str]]:
        left, of_state, state, of_inputs, several, one = _read(_EQUATION, line)
        inputs = several.split(", ") if several else [one]
        if (state == "x") != (self.period is None) or not {of_state, of_inputs} <= self.constants.keys():
            raise SyntaxError(line)
        if not {left.removeprefix("der(").removesuffix(")"), *inputs} <= self.kinds.keys():
            raise SyntaxError(line)
        return left, of_state, state, of_inputs, inputs

    def run(self, inputs: list[dict[str, list[float]]]) -> list[list[float]]:
        """Return the output at each sample: in a `when`, `pre` is what was before it, and all equations hold at once."""
        state = np.zeros(len(self.constants["A"]))
        output = next(name for name, kind in self.kinds.items() if kind == "output")
        found = []
        for given in inputs:
            new = {
                left: self.constants[of_state] @ state
                + self.constants[of_inputs] @ np.concatenate([given[name] for name in names])
                for left, of_state, _, of_inputs, names in self.equations
            }
            assert set(new) == {"x", output}
            found.append([float(entry) for entry in new[output]])
            state = new["x"]
        return found


def _read(form: re.Pattern[str], text: str) -> tuple[Any, ...]:
    found = form.fullmatch(text)
    if found is None:
        raise SyntaxError(text)
    return found.groups()
