"""The output methods of results: formats, SymPy objects, arrays of numbers, systems of python-control."""

from __future__ import annotations

import re
from dataclasses import replace
from functools import cached_property
from importlib import import_module
from typing import TYPE_CHECKING, Any, Self, TypedDict

import symobs
from symobs.exact import Complex, Factored, Matrix, Root, Scalar, Shifted
from symobs.exact.algebraic.enclosure import is_number
from symobs.exact.core.generators import PI, symbols_named
from symobs.exact.floating.sampled import nearest_double
from symobs.formula.convention import convention_named
from symobs.formula.expression.source import shown
from symobs.formula.phrases import PHRASES
from symobs.ground.dataclass import dataclass
from symobs.ground.errors import UsageError
from symobs.system.conditions import Condition, SumOfSquares
from symobs.system.reading import has_decimals

if TYPE_CHECKING:
    from collections.abc import Container, Iterable, Mapping

    from matplotlib.figure import Figure

    from symobs.system import StateSpace


# Conversion of exact values to SymPy and JSON.


_IMAGINARY = re.compile(r"\bI\b")
_RELATIONS = {"!=": "!=", "=": "==", "==": "==", ">": ">", ">=": ">=", "<": "<", "<=": "<="}


def signs(plant: StateSpace, values: Iterable[Any] = ()) -> dict[str, str]:
    """Return every symbol of a plant and of some values with its sign."""
    names = {*plant.symbols.signs, *plant.matrices.symbols}.union(*(getattr(value, "names", ()) for value in values))
    names = {plain for name in names for plain in symbols_named(name)} - {plant.variable, "t", PI}
    return {name: plant.symbols.sign(name) for name in sorted(names)}


def to_json(value: Any, symbols: Container[str] = ()) -> Any:
    """Return JSON of a value: exact strings, nested lists, JSON integers and booleans.

    Beside a symbol I the imaginary unit is sqrt(-1).
    """
    if isinstance(value, (str, int, Scalar)):
        return str(value) if isinstance(value, Scalar) else value
    if isinstance(value, Matrix):
        return [[str(entry) for entry in row] for row in value.rows]
    if isinstance(value, (Complex, Root, Shifted)) and "I" in symbols and "sqrt(-1)" not in str(value):
        return _IMAGINARY.sub("sqrt(-1)", str(value)) if "I" not in value.names else str(value)
    if isinstance(value, (Complex, Factored, Root, Shifted)):
        return str(value)
    if isinstance(value, Condition):
        return f"{value.expression} {_RELATIONS[value.operator]} 0"
    if isinstance(value, (list, tuple)):
        return [to_json(entry, symbols) for entry in value]
    if isinstance(value, dict):
        return {key: to_json(entry, symbols) for key, entry in value.items()}
    return value


def vector(value: Matrix) -> list[str]:
    """Return a column as a flat list."""
    return [str(entry) for entry in value.entries]


def to_sympy(value: Any, objects: Mapping[str, Any]) -> Any:
    """Return the SymPy object of a value; what has none (texts, integers) stays."""
    from symobs.exact.sympy_bridge import conversion  # noqa: PLC0415 - SymPy only when asked for

    if isinstance(value, Matrix):
        return conversion.matrix_to_sympy(value, objects)
    if isinstance(value, Scalar):
        return conversion.scalar_to_sympy(value, objects)
    if isinstance(value, Factored):
        return conversion.factored_to_sympy(value, objects)
    if isinstance(value, Complex):
        return conversion.complex_to_sympy(value, objects)
    if isinstance(value, Root):
        return conversion.root_to_sympy(value, objects)
    if isinstance(value, Shifted):
        return conversion.scalar_to_sympy(value.value, objects) - conversion.root_to_sympy(value.root, objects)
    if isinstance(value, Condition):
        expression, operator = value.expression, value.operator
        parts = expression.parts if isinstance(expression, SumOfSquares) and operator == "!=" else (expression,)
        return conversion.relation_to_sympy(parts, operator, objects)
    if isinstance(value, tuple) and value and all(isinstance(row, tuple) and _are_factored(row) for row in value):
        return conversion.table_to_sympy(value, objects)
    if isinstance(value, (list, tuple)):
        return tuple(to_sympy(entry, objects) for entry in value)
    if isinstance(value, dict):
        return {key: to_sympy(entry, objects) for key, entry in value.items()}
    return value


def _are_factored(row: tuple[Any, ...]) -> bool:
    return bool(row) and all(isinstance(entry, Factored) for entry in row)


def doubles_of(fields: Mapping[str, Any]) -> dict[str, Any]:
    """Return the nearest doubles of those answers that are numbers; a complex number as [real, imaginary]."""
    found = {name: _double(value) for name, value in fields.items()}
    return {name: value for name, value in found.items() if value is not None}


def _double(value: Any) -> Any:
    """Return the nearest doubles of numbers, matrices and lists of them, None where one has letters or is none."""
    if isinstance(value, Matrix):
        return _all([_all([_double(entry) for entry in row]) for row in value.rows])
    if isinstance(value, (list, tuple)) and value and all(isinstance(entry, (Root, Scalar)) for entry in value):
        return _all([_double(entry) for entry in value])
    if isinstance(value, Root):
        value = value.exact()
    if isinstance(value, Complex):
        return _all([_double(value.real), _double(value.imaginary)]) if not value.is_real else _double(value.real)
    if not isinstance(value, Scalar) or not is_number(value):
        return None
    try:
        return nearest_double(value)
    except ValueError:  # too large, or not written by roots and exponentials
        return None


def _all(values: list[Any]) -> list[Any] | None:
    return None if any(value is None for value in values) else values


#: Answers of more terms than this are not written out by `repr`.
_TERMS_SHOWN = 500
#: So many characters of an answer are written out by it.
_SHOWN = 200


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

    def plot(self) -> Figure:
        """Return the pictures of the page as a figure of matplotlib, below each other; a notebook shows it.

        Raises `UsageError` for a result without pictures, and where matplotlib is missing.
        """
        found: Figure = import_module(symobs.PICTURES).figure(self)
        return found

    def to_json(self) -> str:
        """Return the result as JSON."""
        return str(self.to("json"))

    def _repr_mimebundle_(self, **_: Any) -> dict[str, str]:
        # no LaTeX: its pictures need TikZ, which a converted notebook does not load
        kinds = {"markdown": "markdown", "html": "html_fragment"}
        return {"text/plain": repr(self), **{f"text/{kind}": str(self.to(name)) for kind, name in kinds.items()}}

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

    @property
    def decimals(self) -> dict[str, Any]:
        """The nearest doubles of the answers that are numbers, also of those without a closed form, as JSON has them."""
        return doubles_of(self.fields)

    @property
    def numbers(self) -> Mapping[str, Any]:
        """The fields as programs use them: certain digits, as rational numbers, stand for what has no closed form."""
        found: Mapping[str, Any] = self.fields
        return found

    @property
    def scope(self) -> dict[str, str]:
        """What an answer about a linearisation proves of the nonlinear plant, and what it does not; nothing for others."""
        if self.plant.nonlinear is None:
            return {}
        proves, leaves_open = ("linearisation_proves", "linearisation_leaves_open")
        return {"of": "linearisation", "proves": PHRASES[proves], "does_not_prove": PHRASES[leaves_open]}

    def decimals_to(self, digits: int) -> dict[str, Any]:  # noqa: ARG002 - for results that can find more of them
        """Return the decimals with so many digits where more can be found."""
        return self.decimals

    def evaluate(self, points: Mapping[Any, Any]) -> dict[str, Any]:
        """Return a NumPy array for each field at arrays of points: `result.evaluate({"k": np.linspace(1, 2, 100)})`.

        Arrays of points are broadcast to one shape S; a matrix field has the shape S + (rows, columns).  Where a condition
        of the result, or a declared sign, fails, there stands what holds in that case, else `nan`.  Floating-point points
        are read as their shortest decimals where a condition is decided, or where terms cancel: values have ten certain
        digits.  Fields that depend on time or on the variable of polynomials, and words, are left out.  Raises
        `InputError` where a parameter has no value, and where no field is left.
        """
        from symobs.tasks.result.at_values import evaluate  # noqa: PLC0415 - it needs NumPy

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
            raise AttributeError(f"{type(self).__name__} has no attribute {name!r}")
        if name not in self._objects:
            self._objects[name] = to_sympy(self.numbers[name], self.plant.symbols.objects)
        return self._objects[name]

    @cached_property
    def _objects(self) -> dict[str, Any]:
        """The answers as SymPy objects, converted at first use: large ones take seconds."""
        return {}

    def __dir__(self) -> Iterable[str]:
        own = (name for name in super().__dir__() if not name.startswith("_"))
        return sorted({*own, *self.fields})

    def __repr__(self) -> str:
        """Show what answers the task; of what has many terms their number, for a display may not take seconds."""
        found = {name: self.fields[name] for name in self.answered_by if self.fields.get(name) is not None}
        if self.numbers is not self.fields:  # their digits, where they have no closed form
            rows = {
                name: self.decimals[name] for name in self.answered_by if name not in found and name in self.decimals
            }
            found |= {name: f"[{'; '.join(' '.join(row) for row in value)}]" for name, value in rows.items()}
        long = {name: size for name, value in found.items() if (size := getattr(value, "size", 0)) > _TERMS_SHOWN}
        shown = [f"{name}={_in_short(value, long.get(name, 0))}" for name, value in found.items()]
        verdict = [] if long else [f"verdict={self.verdict!r}"]
        return f"{type(self).__name__}({', '.join(shown + verdict)})"


def _in_short(value: Any, terms: int) -> str:
    """Return a value on one line, cut where it is long; of one with many terms their number."""
    if terms:
        return f"<{terms} terms>"
    text = str(to_json(value)) if isinstance(value, (list, tuple, dict)) else str(value)
    return text if len(text) <= _SHOWN else f"{text[:_SHOWN]}…"


# Number format of a page: exact, or with a number of significant digits.


#: The significant digits of a page whose data are typed as decimals, and the most that can be asked for.
DIGITS, MOST_DIGITS = 5, 40
#: How the literature is told below a page.
REFERENCES = ("none", "short", "full")


class PageOptions(TypedDict, total=False):
    """Options of `result.to`: significant digits, or exact numbers."""

    convention: str
    detail: str
    language: str
    references: str
    digits: int | None
    exact: bool


def document_options(
    *,
    convention: str = "standard",
    detail: str = "full",
    language: str = "en",
    references: str = "short",
    digits: int | None = None,
    exact: bool = False,
    **unknown: object,
) -> dict[str, Any]:
    """Return the options of a page as those of a document.

    Raises `UsageError` for a convention that does not exist, and for an option that no page has.
    """
    if unknown:
        repair = f"known options are {', '.join(PageOptions.__annotations__)}"
        raise UsageError("no page has this option", where=shown(next(iter(unknown)), 40), repair=repair)
    asked = digits_asked(digits, exact=exact)
    if references not in REFERENCES:
        message, repair = f"{shown(str(references), 40)!r} is no way to cite", f"use one of {', '.join(REFERENCES)}"
        raise UsageError(message, where="references", repair=repair)
    told = {"detail": detail, "language": language, "references": references, "digits": asked}
    return {"convention": convention_named(convention), **told}


def detail_of(format_name: str) -> str:
    """Return the level of detail of a format where none is asked for."""
    return "outline" if format_name == "beamer" else "full"


def digits_asked(digits: object = None, *, exact: bool = False, where: str = "digits") -> int | None:
    """Return the digits of a document: 0 for exact numbers, None by default.

    Raises `UsageError` for what is no number of digits, and where exact numbers are asked for as well.
    """
    if digits is None:
        return 0 if exact else None
    if exact:
        raise UsageError("digits and exact numbers are both asked for", where=where, repair="keep one of them")
    if isinstance(digits, bool) or not isinstance(digits, int) or not 1 <= digits <= MOST_DIGITS:
        message = f"{shown(str(digits), 40)!r} is not a number of significant digits"
        raise UsageError(message, where=where, repair=f"write a whole number from 1 to {MOST_DIGITS}, for example 5")
    return digits


def shown_digits(document: Any) -> int:
    """Return the significant digits of the numbers of a document, 0 where they are exact.

    They are decimals where data are, and where answers are numbers without a closed form.
    """
    if document.digits is not None:
        return int(document.digits)
    typed = any(
        result.plant.is_in_decimals or has_decimals([*result.specification.values()]) or result.is_told_in_decimals
        for result in document.results
    )
    return DIGITS if typed else 0


# Interactive parts of an HTML page.


@dataclass
class WebPage:
    """All levels of detail to choose from, buttons that copy LaTeX, the address of the problem on a live page."""

    details: bool = False
    copy: bool = False
    live: str = ""

    @property
    def of_question(self) -> WebPage:
        """What the page of a question may offer: nothing that leads to the solution."""
        return replace(self, details=False, live="")


#: A page that is complete as it is.
PLAIN = WebPage()
