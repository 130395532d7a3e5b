"""The stub of the package, from the registry and from what the worked examples answer: `python -m tests.programs.typed_face`.

Type checkers read `symobs/__init__.pyi`; at run time tasks are discovered, so that a new one is files in one place.
"""

from __future__ import annotations

import inspect
from collections.abc import Mapping
from typing import Any

import symobs
from symobs.exact import Complex, Factored, Matrix, Root, Scalar, Shifted
from symobs.ground import errors
from symobs.problem import read
from symobs.tasks.result import Result, Task, result_type, tasks
from tests.support.paths import ROOT

STUB = ROOT / "symobs" / "__init__.pyi"
#: What a keyword of each kind takes.
KINDS = {
    "Poles": "str | Sequence[_Number] | Mapping[str, Any] | MatrixBase",
    "PolynomialText": "str | Expr",
    "TransferFunctionText": "_Number",
    "GainText": "_Matrix",
    "MatrixText": "_Matrix",
    "IntervalText": "str | Sequence[_Number]",
    "SignalText": "_Number | _Matrix",
    "TimeFunctions": "_Number | _Matrix",
    "Name": "str",
    "Horizon": "_Number",
    "Intensity": "_Number | _Matrix",
    "Sign": "int",
    "Entries": "str | Sequence[object]",
    "Quantity": "_Number",
    "Names": "str | Sequence[str]",
}
HEAD = '''"""What type checkers and editors know of `symobs`; `python -m tests.programs.typed_face` writes it."""

from collections.abc import Mapping, Sequence
from decimal import Decimal
from fractions import Fraction
from typing import Any, TypeAlias, overload

from sympy import Expr, ImmutableMatrix
from sympy.matrices import MatrixBase

'''
NAMES = """
_Number: TypeAlias = str | float | complex | Fraction | Decimal | Expr
_IsPlant: TypeAlias = _CanonicalFormResult | _DecompositionResult | _DualResult | _ZeroOrderHoldResult
_Plant: TypeAlias = StateSpace | _IsPlant | tuple[Sequence[_Number], Sequence[_Number]] | Mapping[str, Any]
_Matrix: TypeAlias = str | Sequence[object] | MatrixBase

TASK_PACKAGES: tuple[str, ...]
FORMAT_PACKAGE: str
PICTURES: str
FUNCTIONS: dict[str, str]
SYNONYMS: dict[str, str]
__version__: str
"""


def answered() -> dict[str, list[Result]]:
    """The results of the worked examples, by task."""
    found: dict[str, list[Result]] = {name: [] for name in sorted(tasks())}
    for path in sorted((ROOT / "worked_examples").glob("*.toml")):
        for result in read(path.read_text("utf-8"), path.name, path.parent).solve():
            found[result.task].append(result)
    if missing := [name for name, results in found.items() if not results]:
        raise SystemExit(
            f"write worked_examples/{missing[0]}.toml first: what a task answers is read from its examples"
        )
    return found


def type_of(value: Any) -> str:
    """What a type checker is told of a field, from one of its values; nothing of None, which stands for none."""
    if value is None:
        return ""
    for kind, text in _TYPES.items():
        if isinstance(value, kind):
            return text
    if isinstance(value, (list, tuple)):
        rows = [row for row in value if isinstance(row, tuple) and row and isinstance(row[0], Factored)]
        if rows and len(rows) == len(value):
            return "ImmutableMatrix"
        return "tuple[str, ...]" if value and all(isinstance(each, str) for each in value) else "tuple[Any, ...]"
    return "Any"


_TYPES: dict[Any, str] = {
    Matrix: "ImmutableMatrix",
    (Scalar, Complex, Factored, Root, Shifted): "Expr",
    bool: "bool",
    int: "int",
    str: "str",
    Mapping: "Mapping[str, Any]",
}


def shared_class(results: list[Result]) -> type[Result]:
    """The nearest class that all results of a task belong to."""
    first, *others = dict.fromkeys(type(result) for result in results)
    return next(kind for kind in first.__mro__ if all(issubclass(other, kind) for other in others))


def own_class(task: Task) -> str:
    """What type checkers call the result of a task."""
    return "_" + "".join(word.title() for word in task.name.split("_")) + "Result"


def result_class(task: Task, results: list[Result]) -> tuple[str, str]:
    """The import of a task's result class, and the class with its answers as properties."""
    main = [result for result in results if isinstance(result, result_type(task.name))]
    results = main if 2 * len(main) > len(results) else results  # loops with a dead time answer beside those without
    kind = shared_class(results)
    own = own_class(task)
    types: dict[str, set[str]] = {}
    for result in results:
        for name, value in result.fields.items():
            if not hasattr(kind, name):
                types.setdefault(name, set()).add(type_of(value))
    lines = [f"class {own}(_{kind.__name__}):", f'    """What `{task.name}` returns."""', ""]
    for name, found in types.items():
        vague = {"tuple[Any, ...]"} if "tuple[str, ...]" in found else set()  # an empty one
        told = " | ".join(sorted(found - {""} - vague)) or "Any"
        lines += ["    @property", f"    def {name}(self) -> {told}: ..."]
    return f"from {kind.__module__} import {kind.__name__} as _{kind.__name__}", "\n".join(lines)


def signature(task: Task) -> str:
    """A task as a function of the package."""
    parameters = inspect.signature(task.function).parameters
    by_place = [str(p) for p in parameters.values() if p.kind is p.POSITIONAL_OR_KEYWORD]
    plant = ", ".join(text.replace("'", "").replace("StateSpace", "_Plant") for text in by_place)
    keywords = []
    for name, kind in task.keywords.items():
        default = parameters[name].default
        optional = " | None" if default is None else ""
        keywords.append(f"    {name}: {KINDS[kind]}{optional} = {default!r},".replace("'", '"'))
    keywords += ["    floats: str | None = None,", "    pade: int | str | None = None,"]
    own = own_class(task)
    told = f'    """{task.summary}"""'
    star = "    *,\n" if keywords else ""
    if task.name in symobs.FUNCTIONS:  # it takes a design as well
        kinds = ("state_feedback", "observer", "compensator", "lqr", "kalman")
        designs = " | ".join(own_class(tasks()[name]) for name in kinds)
        told = f"@overload\ndef {task.name}(design: {designs}) -> {own}: ...\n"
        return told + f"@overload\ndef {task.name}(\n    {plant},\n{star}" + "\n".join(keywords) + f"\n) -> {own}: ..."
    return f"def {task.name}(\n    {plant},\n{star}" + "\n".join(keywords) + f"\n) -> {own}:\n{told}"


def stub() -> str:
    """The whole stub."""
    found = answered()
    classes = {name: result_class(tasks()[name], results) for name, results in found.items()}
    raised = sorted(name for name in vars(errors) if isinstance(getattr(errors, name), type) and name[0].isupper())
    raised = [name for name in raised if issubclass(getattr(errors, name), errors.SymobsError)]
    imports = {line for line, _ in classes.values()} | {"from symobs.system import StateSpace as StateSpace"}
    imports |= {
        f"from {module} import {name} as {name}" for name, module in symobs.FUNCTIONS.items() if name not in found
    }
    imports |= {f"from symobs.ground.errors import {name} as {name}" for name in raised}
    bodies = [f"{classes[name][1]}\n\n{signature(tasks()[name])}" for name in found]
    return HEAD + "\n".join(sorted(imports)) + "\n" + NAMES + "\n" + "\n\n".join(bodies) + "\n"


if __name__ == "__main__":
    STUB.write_text(stub(), "utf-8")
