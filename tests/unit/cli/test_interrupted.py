"""What an interrupt or a time limit leaves behind: nothing half done that the next question would stumble over."""

from __future__ import annotations

import importlib
import subprocess
import sys
from typing import TYPE_CHECKING

import pytest

from symobs.tasks.result import registry, writers
from tests.kit import tabled

if TYPE_CHECKING:
    from types import ModuleType

#: Ends the first import of a module of SymPy as Ctrl-C would, and asks the same question again.
SCRIPT = """
import sys
import symobs
class Interrupt:
    def find_spec(self, name, path=None, target=None):
        if name == {module!r}:
            sys.meta_path.remove(self)
            raise KeyboardInterrupt
plant = symobs.StateSpace("[-1 0 1 -2; -1 0 -1 2; -2 0 0 -1; 0 -3 2 3]", None, "[1 -3 0 -1]")
found = symobs.pbh(plant)
assert "sympy" not in sys.modules
sys.meta_path.insert(0, Interrupt())
try:
    found.modes
except KeyboardInterrupt:
    print("interrupted")
print(found.modes[0]["rank"], type(found.fixed_polynomial).__module__.split(".")[0])
"""


@tabled
def test_an_import_of_sympy_that_is_interrupted_is_made_anew(module: str) -> None:
    # module 'sympy' has no attribute 'polys', for as long as the session lasted.
    run = subprocess.run(
        [sys.executable, "-c", SCRIPT.format(module=module)], capture_output=True, text=True, check=False
    )
    assert (run.stdout.split(), run.returncode) == (["interrupted", "4", "sympy"], 0), run.stderr[-2000:]


def test_a_discovery_that_is_interrupted_goes_on_the_next_time(monkeypatch: pytest.MonkeyPatch) -> None:
    # The package counted as seen, and the tasks of its other modules were unknown.
    monkeypatch.setattr(writers, "_DISCOVERED", set())
    asked: list[str] = []
    importing = importlib.import_module

    def interrupted(name: str) -> ModuleType:
        asked.append(name)
        if len(asked) == 4:
            raise KeyboardInterrupt
        return importing(name)

    monkeypatch.setattr(importlib, "import_module", interrupted)
    with pytest.raises(KeyboardInterrupt):
        registry.tasks()
    before = len(asked)
    registry.tasks()
    assert len(asked) > before + 20
