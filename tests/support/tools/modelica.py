"""The part of Modelica 3.6 that blocks of symobs use, read and run: declarations, a sampled `when`, and equations.

Its grammar is that of the language specification, appendix A, cut down to blocks of real signals, constant matrices, sums and
products, `pre`, `der` and `cat`.  Whatever is not in it is an error.
"""

from __future__ import annotations

import re
from typing import Any

import numpy as np

_TOKEN = re.compile(
    r"\s*(?:(?P<comment>//[^\n]*)|(?P<number>\d+(?:\.\d*)?(?:[eE][+-]?\d+)?)|(?P<name>[A-Za-z_]\w*)|(?P<sign>[-+*=,;()\[\]{}]))"
)
_KEYWORDS = {"block", "input", "output", "Real", "protected", "constant", "discrete", "equation", "when", "then", "end"}


class Block:
    """A block that was read: sizes of its signals, its matrices, its equations, and the period of its `when`."""

    def __init__(self, text: str) -> None:
        self.tokens = _tokens(text)
        self.at = 0
        self.sizes: dict[str, list[int]] = {}
        self.kinds: dict[str, str] = {}
        self.constants: dict[str, Any] = {}
        self.equations: list[tuple[Any, Any]] = []
        self.period: float | None = None
        self._block()

    # -- reading ------------------------------------------------------------------------------------------------------

    def _take(self, *wanted: str) -> str:
        token = self.tokens[self.at]
        if wanted and token not in wanted:
            raise SyntaxError(f"{wanted} expected, but {token!r} came")
        self.at += 1
        return token

    def _name(self) -> str:
        name = self._take()
        if not re.fullmatch(r"[A-Za-z_]\w*", name) or name in _KEYWORDS:
            raise SyntaxError(f"a name expected, but {name!r} came")
        return name

    def _block(self) -> None:
        self._take("block")
        self.name = self._name()
        while self.tokens[self.at] != "equation":
            if self.tokens[self.at] == "protected":
                self._take()
            self._declaration()
        self._take("equation")
        if self.tokens[self.at] == "when":
            self._when()
        while self.tokens[self.at] != "end":
            self._equation()
        self._take("end")
        self._take(self.name)
        self._take(";")
        if self.at != len(self.tokens):
            raise SyntaxError("text behind the end")

    def _declaration(self) -> None:
        prefix = self._take() if self.tokens[self.at] in {"input", "output", "constant", "discrete"} else ""
        self._take("Real")
        name = self._name()
        self._take("[")
        self.sizes[name] = [int(size) for size in self._listed("]")]
        self.kinds[name] = prefix or "Real"
        if self.tokens[self.at] == "(":  # modifiers of the start
            self._take("(")
            modifiers = [" ".join(self._take() for _ in range(4)), self._take(",")]
            modifiers.append(" ".join(self._take() for _ in range(4)))
            self._take(")")
            if modifiers != ["each start = 0", ",", "each fixed = true"]:
                raise SyntaxError(f"other modifiers: {modifiers}")
        if prefix == "constant":
            self._take("=")
            self.constants[name] = np.array(self._array(), dtype=float)
            if list(self.constants[name].shape) != self.sizes[name]:
                raise SyntaxError(f"{name} has another size")
        self._take(";")

    def _listed(self, closing: str) -> list[str]:
        found = [self._take()]
        while self._take(",", closing) == ",":
            found.append(self._take())
        return found

    def _array(self) -> Any:
        if self.tokens[self.at] != "{":
            sign = -1.0 if self.tokens[self.at] == "-" and self._take() else 1.0
            return sign * float(self._take())
        self._take("{")
        rows = [self._array()]
        while self._take(",", "}") == ",":
            rows.append(self._array())
        return rows

    def _when(self) -> None:
        for token in ("when", "sample", "(", "0", ","):
            self._take(token)
        self.period = float(self._take())
        for token in (")", "then"):
            self._take(token)
        while self.tokens[self.at] != "end":
            self._equation()
        for token in ("end", "when", ";"):
            self._take(token)

    def _equation(self) -> None:
        left = self._factor()
        self._take("=")
        self.equations.append((left, self._sum()))
        self._take(";")

    def _sum(self) -> Any:
        found = self._product()
        while self.tokens[self.at] == "+":
            self._take()
            found = ("+", found, self._product())
        return found

    def _product(self) -> Any:
        found = self._factor()
        while self.tokens[self.at] == "*":
            self._take()
            found = ("*", found, self._factor())
        return found

    def _factor(self) -> Any:
        if self.tokens[self.at] in {"der", "pre"}:
            call = self._take()
            self._take("(")
            inner = self._name()
            self._take(")")
            return (call, inner)
        if self.tokens[self.at] == "cat":
            for token in ("cat", "(", "1", ","):
                self._take(token)
            return ("cat", *self._listed(")"))
        name = self._name()
        if name not in self.sizes:
            raise SyntaxError(f"{name} is not declared")
        return name

    # -- running ------------------------------------------------------------------------------------------------------

    def run(self, inputs: list[dict[str, list[float]]]) -> list[list[float]]:
        """Return the output at each sample: in a `when`, `pre` is what was before it, and all equations hold at once."""
        state = np.zeros(self.sizes["x"])
        output = next(name for name, kind in self.kinds.items() if kind == "output")
        found = []
        for given in inputs:
            known = {**self.constants, **{name: np.array(value) for name, value in given.items()}}
            new = {left: self._value(right, known, state) for left, right in self.equations}
            assert set(new) == {"x", output}
            found.append([float(entry) for entry in new[output]])
            state = new["x"]
        return found

    def _value(self, node: Any, known: dict[str, Any], state: Any) -> Any:
        match node:
            case str():
                return known[node]
            case ("pre", "x"):
                return state
            case ("cat", *names):
                return np.concatenate([known[str(name)] for name in names])
            case ("+", left, right):
                return self._value(left, known, state) + self._value(right, known, state)
            case ("*", left, right):
                return self._value(left, known, state) @ self._value(right, known, state)
        raise ValueError(node)


def _tokens(text: str) -> list[str]:
    found, place, text = [], 0, text.rstrip()
    while place < len(text):
        token = _TOKEN.match(text, place)
        if token is None:
            raise SyntaxError(f"no token at {text[place : place + 20]!r}")
        if token.lastgroup != "comment":
            found.append(token.group(str(token.lastgroup)))
        place = token.end()
    return found
