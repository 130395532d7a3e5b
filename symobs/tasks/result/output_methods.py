"""The output methods of results: formats, SymPy objects, arrays of numbers, systems of python-control."""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING, Any, Self

from symobs.tasks.result.conversions import signs, to_sympy

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

#: Answers of more terms than this are not written out by `repr`.
_TERMS_SHOWN = 500


class OutputMethods:
    """The output methods of a result, its answers as SymPy objects, and its display in a notebook."""

    def to(self, format_name: str, *, convention: str = "standard", language: str = "en") -> str | bytes:
        """Return the result in a format, in a convention and a language."""
        raise NotImplementedError

    @property
    def symbols(self) -> dict[str, str]:
        """Every symbol of the result with its sign."""
        return signs(self.plant, self.answer.values())

    def to_latex(self, *, language: str = "en") -> str:
        """Return the derivation as a LaTeX article."""
        return str(self.to("latex", language=language))

    def to_html(self, *, language: str = "en") -> str:
        """Return the derivation as a complete HTML page."""
        return str(self.to("html", language=language))

    def to_markdown(self, *, language: str = "en") -> str:
        """Return the derivation as Markdown."""
        return str(self.to("markdown", language=language))

    def to_json(self) -> str:
        """Return the result as JSON."""
        return str(self.to("json"))

    def _repr_latex_(self) -> str:
        return str(self.to("fragment"))

    def _repr_mimebundle_(self, **_: Any) -> dict[str, str]:
        kinds = {"plain": "text", "markdown": "markdown", "latex": "fragment", "html": "html_fragment"}
        return {f"text/{kind}": str(self.to(name)) for kind, name in kinds.items()}

    def at(self, values: Mapping[Any, Any] | None = None, /, **named: Any) -> Self:
        """Return the same result where parameters have values: `result.at(k=4, m="1/2")`, or `result.at({k: 4})`.

        The task is put anew to the plant and the specification at these values, exact as everywhere, so that conditions
        are decided, the case that applies is the answer, and the constructor checks it; of gains that are not unique the
        value of the chosen one is kept.  Other parameters stay.  Raises `InputError` for what is no parameter, for a value
        that the declared sign excludes, and where there is no plant.
        """
        from symobs.tasks.result.at_values import at_values  # noqa: PLC0415 - a result that is not moved does not pay for it

        found: Self = at_values(self, {**(values or {}), **named})
        return found

    def evaluate(self, points: Mapping[Any, Any]) -> dict[str, Any]:
        """Return a NumPy array for each field at arrays of points: `result.evaluate({"k": np.linspace(1, 2, 100)})`.

        Arrays of points are broadcast to one shape S; a matrix field has the shape S + (rows, columns).  Where a condition
        of the result, or a declared sign, fails, there stands what holds in that case, else `nan`.  Floating-point points
        are read as their shortest decimals where a condition is decided.  Fields that depend on time or on the variable
        of polynomials, and words, are left out.  Raises `InputError` where a parameter has no value, and where no field is
        left.
        """
        from symobs.tasks.result.evaluation import evaluate  # noqa: PLC0415 - it needs NumPy

        return evaluate(self, points)

    def to_control(self) -> dict[str, Any]:
        """Return the systems of a design by name as state-space systems of python-control.

        plant         u → y
        observer      (u, y) → x_hat
        compensator   y → w = F y, so that u = v − w closes the loop
        closed_loop   v → y
        servo         r → y, the closed loop with integral action

        Entries are the nearest doubles; `StateSpace.from_control` reads each system back exactly.  Raises `InputError`
        where a parameter has no value, naming it, and `UsageError` where python-control is not installed.
        """
        from symobs.tasks.result.control_systems import to_control  # noqa: PLC0415 - it needs python-control

        return to_control(self)

    def __getattr__(self, name: str) -> Any:
        """Return an answer as SymPy objects; Python also comes here after a failed property."""
        for kind in type(self).__mro__:
            if name in vars(kind):
                return vars(kind)[name].__get__(self)  # its own error, not that there is no such name
        if name.startswith("_") or name not in self.fields:
            message = f"{type(self).__name__} has no attribute {name!r}"
            raise AttributeError(message)
        if name not in self._objects:
            self._objects[name] = to_sympy(self.fields[name], self.plant.symbols.objects)
        return self._objects[name]

    @cached_property
    def _objects(self) -> dict[str, Any]:
        """The answers as SymPy objects, converted at first use: large ones take seconds."""
        return {}

    def __dir__(self) -> Iterable[str]:
        own = (name for name in super().__dir__() if not name.startswith("_"))
        return sorted({*own, *self.fields})

    def __repr__(self) -> str:
        """Show the answers in short; of one with many terms their number, for a display may not take seconds."""
        parts = {name: value for name, value in self.answer.items() if value is not None}
        long = {name: size for name, value in parts.items() if (size := getattr(value, "size", 0)) > _TERMS_SHOWN}
        shown = [f"{name}=<{long[name]} terms>" if name in long else f"{name}={value}" for name, value in parts.items()]
        verdict = "" if long else f", verdict={self.verdict!r}"
        return f"{type(self).__name__}({', '.join(shown)[:200]}{verdict})"
