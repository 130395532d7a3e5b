"""The house keeps its floors: who may import whom, what is imported late, what is never called, how long a file is."""

from __future__ import annotations

import ast
import subprocess
import sys
from collections import Counter
from typing import TYPE_CHECKING

import pytest

from tests.support.paths import ROOT
from tests.support.tools.imports import Sources, circles, folders, imports

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

SYMOBS = ROOT / "symobs"
SOURCES = sorted(SYMOBS.rglob("*.py"))
MOST_MODULES = 12
#: The lines of all modules that say "(trusted)" at their beginning: whoever audits the checks reads these.
MOST_TRUSTED = 4750

# A module imports from strictly lower floors; a package may import from itself, where its folders keep an order.
FLOORS = {
    "errors": 0,
    "_dataclass": 0,
    "_on_demand": 0,
    "child_processes": 0,
    "parser_limits": 1,
    "exact": 1,
    "notation": 1,
    "phrases": 2,
    "convention": 3,
    "expression": 3,
    "formula": 3,
    "conditions": 3,
    "system": 4,
    "figures": 4,
    "specification": 5,
    "certificate": 6,
    "stability": 6,
    "derivation": 7,
    "result": 8,
    "analysis": 9,
    "design": 10,
    "render": 10,
    "expect": 11,
    "problem": 12,
    "audit": 13,
    "batching": 13,
    "live": 13,
    "checking": 14,
    "variation": 15,
    "exporting": 15,
    "cli": 16,
    "__main__": 17,
}
# The package itself (`__init__.py`) stands above all floors. It lists the modules in which methods and formats
# register, and two modules may look at it or load by name: the registry (the only way up) and the command line.
# The catalogue of phrases may load by name too: `…_phrases.py` contain data only, which `test_phrases.py` holds them to.
LOADS_DATA = "symobs.phrases.catalogue"
# So may the table of kinds of work, in the processes that do the work: what makes jobs imports the engine, and is not
# imported by it.
LOADS_WORK = "symobs.batching.kinds"
WAYS_UP = {"result", "cli"}
BY_NAME = {"importlib", "pkgutil", "runpy"}
FILES_OF_PACKAGES = {"importlib.metadata", "importlib.resources"}

ONLY_IN_EXACT = {"flint", "sympy.polys"}  # in annotations too: the kernel's types never leak
LATE = {"control", "distributed", "matplotlib", "mpmath", "numpy", "pandas", "pyarrow", "scipy", "sympy", "z3"}
SYMPY_BORDER = ("symobs.exact.sympy_bridge.sympy_import", "sympy")  # imported only where SymPy objects come or go
NEVER_NAMED = {"lambdify", "literal_eval", "parse_expr", "sympify"}
NEVER_CALLED = {"S", "__import__", "compile", "eval", "exec"}  # S: sympy.S("…") executes its text
METHODS_SO_CALLED = {"compile"}  # re.compile is harmless


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
    """What is wrong with the imports and calls of `module`, a dotted name such as `symobs.exact.core.matrix`."""
    tree = ast.parse(source)
    _, *below = module.split(".")
    name = below[0] if below else ""
    if name and name not in FLOORS:
        return [f"{module}: `{name}` has no floor: place it in FLOORS of tests/contracts/test_floors.py"]
    found = []
    for line, target, when in imports(tree, ("symobs", *below[:-1])):
        inside = within(target, {"symobs"})
        fault = fault_inside(name, target) if inside else fault_outside(name, target, when)
        if (module, target) == SYMPY_BORDER or (module in {LOADS_DATA, LOADS_WORK} and within(target, BY_NAME)):
            fault = ""
        found += [f"{module}:{line}: imports `{target}`: {fault}"] if fault else []
    return found + [f"{module}:{place}" for place in forbidden(tree)]


def test_no_folder_is_crowded() -> None:
    crowded = Counter(path.parent for path in SOURCES if path.name != "__init__.py")
    assert {str(folder): count for folder, count in crowded.items() if count > MOST_MODULES} == {}


def test_folders_import_in_one_direction() -> None:
    assert circles(folders(Sources(SYMOBS).graph())) == []


def test_modules_import_in_one_direction() -> None:
    assert circles(Sources(SYMOBS).graph()) == []


def test_a_circle_is_seen(tmp_path: Path) -> None:
    package = tmp_path / "symobs"
    for folder in ("one", "two"):
        package.joinpath(folder).mkdir(parents=True)
        package.joinpath(folder, "__init__.py").touch()
    package.joinpath("one", "a.py").write_text("def f():\n    from symobs.two import b\n")
    package.joinpath("two", "b.py").write_text("if TYPE_CHECKING:\n    from symobs.one import A\n")
    assert circles(Sources(package).graph()) == []
    package.joinpath("one", "__init__.py").write_text("from symobs.one.a import A\n")
    assert circles(Sources(package).graph()) == [["symobs.one.a", "symobs.two.b"]]
    assert circles(folders(Sources(package).graph())) == [["symobs.one", "symobs.two"]]


def dotted(path: Path) -> str:
    """The name under which Python imports the file at `path`; a package is named by its `__init__`."""
    return ".".join(path.relative_to(ROOT).with_suffix("").parts)


@pytest.mark.parametrize("path", SOURCES, ids=dotted)
def test_every_module_keeps_its_floor(path: Path) -> None:
    module = dotted(path).replace("symobs.__init__", "symobs")
    assert violations(module, path.read_text(encoding="utf-8")) == []


def test_what_is_trusted_stays_small() -> None:
    texts = {path: path.read_text(encoding="utf-8") for path in SOURCES}
    trusted = {path: len(text.splitlines()) for path, text in texts.items() if "(trusted)" in text.partition("\n")[0]}
    assert {"check.py", "claims.py", "result.py", "wording_check.py"} <= {path.name for path in trusted}
    assert sum(trusted.values()) <= MOST_TRUSTED, trusted


def test_there_is_something_to_look_at() -> None:
    assert {dotted(path) for path in SOURCES} >= {"symobs.__init__", "symobs.errors", "symobs.exact.__init__"}


@pytest.mark.parametrize(
    ("module", "source"),
    [
        ("symobs.exact.core.matrix", "from symobs.system import StateSpace"),
        ("symobs.exact.core.matrix", "from ...system import StateSpace"),
        ("symobs.exact.core.matrix", "from symobs import system"),
        ("symobs.exact.core.matrix", "def f():\n    import symobs.system"),
        ("symobs.exact.core.matrix", "if TYPE_CHECKING:\n    from symobs.system import StateSpace"),
        ("symobs.exact.core.matrix", "from symobs import notation"),
        ("symobs.render.formats.latex", "from symobs.design import observer"),
        ("symobs.design.full_order.observer", "from symobs.render import narrator"),
        ("symobs.design.full_order.observer", "from symobs import StateSpace"),
        ("symobs.design.full_order.observer", "import symobs"),
        ("symobs.design.full_order.observer", "import importlib"),
        ("symobs.design.full_order.observer", "from importlib import import_module"),
        ("symobs.phrases.languages", "from importlib import import_module"),
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
        ("symobs.exact.core.matrix", "from symobs.exact import ring\nfrom symobs.errors import SymobsError"),
        ("symobs.exact.core.matrix", "from .ring import determinant\nimport flint"),
        ("symobs.exact.border", "def f():\n    import sympy\n    from sympy.polys.domains import QQ"),
        ("symobs.system", "if TYPE_CHECKING:\n    from sympy import ImmutableMatrix"),
        ("symobs.render.plot", "def f():\n    import numpy as np"),
        ("symobs.render.formats.latex", "from importlib.resources import files\nimport re\nre.compile('x')"),
        ("symobs.result", "import symobs\nfrom importlib import import_module"),
        ("symobs.phrases.catalogue", "from importlib import import_module"),
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
