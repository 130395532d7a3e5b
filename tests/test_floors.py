"""The house keeps its floors: who may import whom, what is imported late, what is never called, how long a file is."""

from __future__ import annotations

import ast
import subprocess
import sys
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

import pytest

if TYPE_CHECKING:
    from collections.abc import Iterator

ROOT = Path(__file__).parent.parent
SYMOBS = ROOT / "symobs"
SOURCES = sorted(SYMOBS.rglob("*.py"))
LONGEST = 400

# A module imports from strictly lower floors; the modules of one package folder may import one another.
FLOORS = {
    "errors": 0,
    "processes": 0,
    "contents": 0,
    "record": 0,
    "bounds": 1,
    "exact": 1,
    "notation": 1,
    "convention": 2,
    "phrases": 1,
    "expression": 2,
    "formula": 2,
    "conditions": 2,
    "pointwise": 3,
    "stability": 3,
    "picture": 3,
    "flow": 3,
    "face": 3,
    "error_bounds": 3,
    "system": 3,
    "specification": 4,
    "certificate": 4,
    "region": 4,
    "derivation": 5,
    "page": 6,
    "method": 7,
    "analysis": 8,
    "sheet": 8,
    "design": 9,
    "render": 9,
    "viewed": 8,
    "expect": 10,
    "output": 11,
    "problem": 11,
    "audit": 12,
    "cli": 13,
    "teaching": 13,
    "__main__": 14,
}
# The package itself (`__init__.py`) stands above all floors. It lists the modules in which methods and formats
# register, and two modules may look at it or load by name: the registry (the only way up) and the command line.
WAYS_UP = {"method", "cli"}
BY_NAME = {"importlib", "pkgutil", "runpy"}
FILES_OF_PACKAGES = {"importlib.metadata", "importlib.resources"}

ONLY_IN_EXACT = {"flint", "sympy.polys"}  # in annotations too: the kernel's types never leak
LATE = {"control", "matplotlib", "mpmath", "numpy", "scipy", "sympy", "z3"}
SYMPY_BORDER = ("symobs.exact.whole_sympy", "sympy")  # imported only where SymPy objects come or go
NEVER_NAMED = {"lambdify", "literal_eval", "parse_expr", "sympify"}
NEVER_CALLED = {"S", "__import__", "compile", "eval", "exec"}  # S: sympy.S("…") executes its text
METHODS_SO_CALLED = {"compile"}  # re.compile is harmless


class Import(NamedTuple):
    """One imported name, and when the import happens."""

    line: int
    target: str
    when: str  # "at import", "in a function" or "for annotations"


def imports(tree: ast.AST, package: tuple[str, ...], when: str = "at import") -> Iterator[Import]:
    """Every import below `tree`, with absolute names; `package` is the one that relative imports start from."""
    for node in ast.iter_child_nodes(tree):
        if isinstance(node, ast.Import):
            yield from (Import(node.lineno, alias.name, when) for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            base = package[: len(package) + 1 - node.level] if node.level else ()
            source = ".".join([*base, *([node.module] if node.module else [])])
            yield from (Import(node.lineno, f"{source}.{alias.name}", when) for alias in node.names)
        elif isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef):
            yield from imports(node, package, "in a function" if when == "at import" else when)
        elif isinstance(node, ast.If) and ast.unparse(node.test) in {"TYPE_CHECKING", "typing.TYPE_CHECKING"}:
            yield from imports(ast.Module(node.body, []), package, "for annotations")
            yield from imports(ast.Module(node.orelse, []), package, when)
        else:
            yield from imports(node, package, when)


def within(target: str, names: set[str]) -> bool:
    """Whether the dotted name `target` is one of `names` or lies in one of them."""
    return any(target == name or target.startswith(f"{name}.") for name in names)


def fault_inside(name: str, target: str) -> str:
    """What is wrong when the module `name` imports `target` of symobs; empty when nothing is."""
    other = target.split(".")[1] if "." in target else ""
    if not name:
        return ""
    if other not in FLOORS:
        return "" if name in {*WAYS_UP, "__main__"} else "nothing below may import the package itself"
    if other == name or FLOORS[other] < FLOORS[name]:
        return ""
    return f"floor {FLOORS[name]} may not import `{other}` of floor {FLOORS[other]}"


def fault_outside(name: str, target: str, when: str) -> str:
    """What is wrong when the module `name` imports `target` of another package; empty when nothing is."""
    if within(target, ONLY_IN_EXACT) and name != "exact":
        return "only exact/ imports this"
    if within(target, {"sympy"}) and when != "for annotations" and name not in {"exact", ""}:
        return "only exact/ imports SymPy; elsewhere it may stand in annotations"
    if within(target, LATE) and when == "at import":
        return "import it inside the function that needs it"
    if within(target, BY_NAME) and not within(target, FILES_OF_PACKAGES) and name not in {"", *WAYS_UP}:
        return "only the registry and the command line load modules by name"
    return ""


def forbidden(tree: ast.AST) -> Iterator[str]:
    """Every place that could turn text into running code."""
    for node in ast.walk(tree):
        match node:
            case ast.Name(id=word) | ast.Attribute(attr=word) | ast.alias(name=word) if word in NEVER_NAMED:
                yield f"{node.lineno}: names `{word}`"
            case ast.Call(func=ast.Name(id=word)) if word in NEVER_CALLED:
                yield f"{node.lineno}: calls `{word}`"
            case ast.Call(func=ast.Attribute(attr=word)) if word in NEVER_CALLED - METHODS_SO_CALLED:
                yield f"{node.lineno}: calls `{word}`"
            case _:
                pass


def violations(module: str, source: str) -> list[str]:
    """What is wrong with the imports and calls of `module`, a dotted name such as `symobs.exact.matrix`."""
    tree = ast.parse(source)
    _, *below = module.split(".")
    name = below[0] if below else ""
    if name and name not in FLOORS:
        return [f"{module}: `{name}` has no floor: place it in FLOORS of tests/test_floors.py"]
    found = []
    for line, target, when in imports(tree, ("symobs", *below[:-1])):
        inside = within(target, {"symobs"})
        fault = fault_inside(name, target) if inside else fault_outside(name, target, when)
        if (module, target) == SYMPY_BORDER:
            fault = ""
        found += [f"{module}:{line}: imports `{target}`: {fault}"] if fault else []
    return found + [f"{module}:{place}" for place in forbidden(tree)]


def dotted(path: Path) -> str:
    """The name under which Python imports the file at `path`; a package is named by its `__init__`."""
    return ".".join(path.relative_to(ROOT).with_suffix("").parts)


@pytest.mark.parametrize("path", SOURCES, ids=dotted)
def test_every_module_keeps_its_floor(path: Path) -> None:
    module = dotted(path).replace("symobs.__init__", "symobs")
    assert violations(module, path.read_text(encoding="utf-8")) == []


@pytest.mark.parametrize("path", SOURCES, ids=dotted)
def test_no_file_is_long(path: Path) -> None:
    lines = len(path.read_text(encoding="utf-8").splitlines())
    assert lines <= LONGEST, f"{dotted(path)} has {lines} lines: split it"


def test_there_is_something_to_look_at() -> None:
    assert {dotted(path) for path in SOURCES} >= {"symobs.__init__", "symobs.errors", "symobs.exact.__init__"}


@pytest.mark.parametrize(
    ("module", "source"),
    [
        ("symobs.exact.matrix", "from symobs.system import StateSpace"),
        ("symobs.exact.matrix", "from ..system import StateSpace"),
        ("symobs.exact.matrix", "from symobs import system"),
        ("symobs.exact.matrix", "def f():\n    import symobs.system"),
        ("symobs.exact.matrix", "if TYPE_CHECKING:\n    from symobs.system import StateSpace"),
        ("symobs.exact.matrix", "from symobs import notation"),
        ("symobs.render.latex", "from symobs.design import observer"),
        ("symobs.design.observer", "from symobs.render import narrator"),
        ("symobs.design.observer", "from symobs import StateSpace"),
        ("symobs.design.observer", "import symobs"),
        ("symobs.design.observer", "import importlib"),
        ("symobs.design.observer", "from importlib import import_module"),
        ("symobs.helpers", ""),
        ("symobs.helpers.deep", ""),
        ("symobs.system", "if TYPE_CHECKING:\n    from flint import fmpz"),
        ("symobs.system", "if TYPE_CHECKING:\n    from sympy import polys"),
        ("symobs.system", "from sympy.polys.matrices import DomainMatrix"),
        ("symobs.system", "def f():\n    import sympy"),
        ("symobs.exact.border", "import sympy"),
        ("symobs.exact.border", "class Border:\n    from sympy import Expr"),
        ("symobs.exact.border", "try:\n    import numpy as np\nexcept ImportError:\n    pass"),
        ("symobs", "import sympy"),
        ("symobs", "import matplotlib.pyplot"),
        ("symobs.exact.border", "eval('1')"),
        ("symobs.exact.border", "import builtins\nbuiltins.exec('1')"),
        ("symobs.exact.border", "compile('1', '', 'eval')"),
        ("symobs.exact.border", "read = sympy.sympify"),
        ("symobs.exact.border", "def f():\n    from sympy import lambdify as numeric"),
        ("symobs.exact.border", "sympy.S('x')"),
        ("symobs.exact.border", "__import__('os')"),
    ],
)
def test_a_trespass_is_seen(module: str, source: str) -> None:
    assert violations(module, source)


@pytest.mark.parametrize(
    ("module", "source"),
    [
        ("symobs.exact.matrix", "from symobs.exact import ring\nfrom symobs.errors import SymobsError"),
        ("symobs.exact.matrix", "from .ring import determinant\nimport flint"),
        ("symobs.exact.border", "def f():\n    import sympy\n    from sympy.polys.domains import QQ"),
        ("symobs.system", "if TYPE_CHECKING:\n    from sympy import ImmutableMatrix"),
        ("symobs.render.plot", "def f():\n    import numpy as np"),
        ("symobs.render.latex", "from importlib.resources import files\nimport re\nre.compile('x')"),
        ("symobs.method", "import symobs\nfrom importlib import import_module"),
        ("symobs.cli", "from symobs import problem, __version__"),
        ("symobs", "from symobs.system import StateSpace\nimport importlib"),
    ],
)
def test_what_is_allowed_passes(module: str, source: str) -> None:
    assert violations(module, source) == []


def test_importing_symobs_imports_nothing_heavy() -> None:
    code = f"import sys, symobs; print(*sorted(set({sorted(LATE)!r}) & sys.modules.keys()))"
    run = subprocess.run([sys.executable, "-c", code], cwd=ROOT, capture_output=True, text=True, check=True)
    assert run.stdout.split() == []
