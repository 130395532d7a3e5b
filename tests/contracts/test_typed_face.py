"""The face that type checkers and editors see: every task with its signature and answers, and nothing that is not there."""

from __future__ import annotations

import ast
import importlib
import pydoc
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

import symobs
from symobs.ground import errors
from symobs.tasks.result import tasks
from tests.programs import typed_face
from tests.support.paths import ROOT

pytestmark = pytest.mark.slow

USES = """
import symobs
import sympy
plant = symobs.StateSpace("[0 1; 0 -1]", "[0; 1]", "[1 0]")
symobs.StateSpace([[0, 1], [0, -1]], dt=True, symbols={"a": "positive"})
symobs.StateSpace.from_transfer_function("1/(s^2 + s)")
design = symobs.observer(plant, poles=[-10, -10])
symobs.observer(plant, poles="-10, -10")
symobs.observer(([1], [1, 2, 0]), poles=[-1.5, -2 + 0j], floats="decimal")
bounded: object = symobs.bounded(lambda: symobs.observer(plant, poles=[-1, -2]), timeout=60, memory=2000).L
symobs.observer(plant, polynomial="(s + 10)^2", method="ackermann")
symobs.observer(plant, L="[19; 81]")
symobs.observer(plant, poles=[sympy.Symbol("p"), "-q"], zero="(1, 1)")
feedback = symobs.state_feedback(plant, poles=[-2, -2])
loop = symobs.compensator(plant, control_poles=[-2, -2], observer_poles=[-10, -10], observer="minimal")
test = symobs.observability(plant)
symobs.controllability(plant)
detectable = symobs.detectability(plant, meaning="lyapunov")
symobs.stabilizability(plant)
symobs.pbh(plant, of="controllability")
symobs.characteristic_polynomial(plant)
symobs.transfer_function(plant)
canonical = symobs.canonical_form(plant, kind="observable")
symobs.dual(plant, sign=-1)
symobs.decomposition(plant)
exponential = symobs.matrix_exponential(plant)
symobs.gramian(plant, horizon="T")
symobs.initial_state(plant, horizon=1, output="t")
symobs.reduced_order_observer(plant, poles=[-10])
symobs.feedforward(plant, control_poles=[-2, -2], observer_poles=[-10, -10])
symobs.tracking(plant, control_poles=[-2, -2], observer_poles=[-9, -9], reference_matrix="[0 1; -1 0]")
symobs.pole_advice(plant, radius="omega_0")
symobs.observer(plant, poles={"damping": "0.7", "natural_frequency": 4})
integral: object = symobs.integral_action(plant, poles=[-1, -2, -3]).k_I
region = symobs.stability_region(polynomial="s^2 + h s + 1", parameters=["h"])
page: str = design.to_latex()
verdict: str = design.verdict
dictated: str | bytes = design.to("text", convention="S1", detail="outline")
rank: int = test.rank
stable: str = loop.F_stable
same: bool = design == feedback
number: int = hash(plant)
order: int = plant.order
error: type[Exception] = symobs.InputError
version: str = symobs.__version__
"""
MISUSES = """
symobs.nonsense
symobs.observr(plant, poles=[-1, -2])
symobs.observer(plant, pols=[-1, -2])
symobs.observer()
symobs.observer(plant, [-1, -2])
symobs.observer(plant, poles=[-1, -2], metod="ackermann")
symobs.observer("[0 1; 0 -1]", poles=[-1, -2])
symobs.compensator(plant, control_pole=[-2, -2], observer_poles=[-10, -10])
symobs.dual(plant, sign="minus")
symobs.pbh(plant, of=1)
symobs.StateSpace("[0 1; 0 -1]", E="[1 0]")
test.rank + "1"
design.verdict + 1
design.to("text", detail=2)
plant.ordr
"""


def test_the_stub_says_what_the_registry_does() -> None:
    assert typed_face.STUB.read_text("utf-8") == typed_face.stub(), "run python -m tests.programs.typed_face"


def wrong_lines(folder: Path, *command: str) -> set[int]:
    """The lines, counted from those of the misuses, in which a type checker finds an error."""
    file = folder / "uses.py"
    file.write_text(USES.strip() + "\n" + MISUSES, "utf-8")
    run = subprocess.run([*command, str(file)], cwd=ROOT, capture_output=True, text=True, timeout=600, check=False)
    first = len(USES.strip().splitlines())
    found = re.findall(r"uses\.py:(\d+):(?:\d+:?)? (?:- )?error", run.stdout)
    assert found, run.stdout + run.stderr
    return {int(line) - first - 1 for line in found}


@pytest.mark.parametrize("checker", ["mypy", "pyright"])
def test_uses_are_accepted_and_misuses_refused(checker: str, tmp_path: Path) -> None:
    command = [sys.executable, "-m", "mypy", "--no-incremental", "--follow-imports=silent"]
    if checker == "pyright":
        found = shutil.which("pyright", path=f"{Path(sys.executable).parent}") or shutil.which("pyright")
        if found is None or shutil.which("node") is None:
            pytest.skip("pyright is not there")
        command = [found, "--pythonpath", sys.executable]
    misuses = MISUSES.strip().splitlines()
    assert len(USES.strip().splitlines()) >= 40
    assert len(misuses) == 15
    assert wrong_lines(tmp_path, *command) == set(range(1, 16))


def test_only_public_names_are_listed_each_documented() -> None:
    raised = {name for name, kind in vars(errors).items() if isinstance(kind, type) and issubclass(kind, Exception)}
    assert set(dir(symobs)) == {"StateSpace", "__version__", *raised, *symobs.FUNCTIONS, *tasks()}
    for name in dir(symobs):
        if name != "__version__":
            assert pydoc.getdoc(getattr(symobs, name)), name
    design = symobs.observer(symobs.StateSpace("[0 1; 0 -1]", C="[1 0]"), poles=[-1, -2])
    assert {"L", "polynomial", "conditions", "cases", "verdict", "to_latex"} <= set(dir(design))
    assert not [name for name in dir(design) if name.startswith("_")]
    for name in dir(design):
        kind = getattr(type(design), name, None)
        assert kind is None or isinstance(kind, str | tuple | bool | type) or pydoc.getdoc(kind), name


@pytest.mark.parametrize("name", sorted(tasks()))
def test_a_task_is_described_by_its_parts(name: str) -> None:
    """A sentence of one line, the plant, every keyword, what is returned and raised, and the source."""
    text = pydoc.getdoc(tasks()[name].function)
    assert re.match(r"[A-Z][a-z]+ .*\.$", text.split("\n", 1)[0]), text
    parts = [r"^plant .*(states|a plant)", r"\bReturns ", r"\bRaises `", r"\bSource: "]
    parts += [rf"\b{keyword}\b" for keyword in tasks()[name].keywords if keyword != "method"]
    assert [part for part in parts if not re.search(part, text, re.MULTILINE)] == []


def test_what_the_face_names_is_there() -> None:
    """Every public name of the stub is one of the package, and every name that it imports one of its module."""
    tree = ast.parse((ROOT / "symobs" / "__init__.pyi").read_text("utf-8"))
    for node in tree.body:
        if isinstance(node, ast.ImportFrom):
            module = importlib.import_module(node.module or "")
            assert [each.name for each in node.names if not hasattr(module, each.name)] == []
        elif isinstance(node, (ast.FunctionDef, ast.ClassDef)):
            assert node.name.startswith("_") or hasattr(symobs, node.name), node.name
