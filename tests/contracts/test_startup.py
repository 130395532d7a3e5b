"""What a run imports: SymPy and its kin only where their objects are asked for, nothing that a command does not need."""

from __future__ import annotations

import re
import subprocess
import sys
from importlib import import_module

import pytest

from tests.support.paths import ROOT
from tests.support.tools.command_line import EXAMPLES, SAFETY, SERVO, environment

HEAVY = {"control", "matplotlib", "mpmath", "numpy", "scipy", "sympy", "z3"}
KERNEL = {"flint", "jinja2"}
_COMMAND = """
import sys
from symobs.cli import main
sys.argv = ["symobs", *sys.argv[1:]]
try:
    main()
finally:
    print(*sys.modules, sep="\\n", file=sys.stderr)
"""


def imported(code: str, *arguments: str, exit_code: int = 0) -> set[str]:
    """The modules that stand in memory after a program, as it prints them on standard error."""
    run = subprocess.run(
        [sys.executable, "-c", code, *arguments],
        env=environment(),
        capture_output=True,
        text=True,
        timeout=SAFETY,
        check=False,
    )
    assert run.returncode == exit_code, run.stderr
    return set(run.stderr.splitlines())


def after(*arguments: str) -> set[str]:
    """The modules in memory after a command of symobs."""
    return imported(_COMMAND, *arguments)


@pytest.mark.parametrize(
    "arguments",
    [
        ["--help"],
        ["methods"],
        ["schema"],
        ["templates"],
        ["observer", "--help"],
        ["solve", str(SERVO)],
        ["solve", str(SERVO), "--format", "text"],
        ["solve", str(SERVO), "--format", "json"],
        ["solve", str(SERVO), "--format", "html"],
        ["solve", str(SERVO), "--format", "markdown"],
        ["observer", "--A", "[0 1; 0 -b]", "--C", "[1 0]", "--poles", "-p, -q"],
    ],
    ids=" ".join,
)
def test_no_command_imports_what_is_heavy(arguments: list[str]) -> None:
    found = after(*arguments)
    assert "symobs.cli" in found
    assert found & HEAVY == set()


def test_a_budget_costs_nothing_where_there_is_none() -> None:
    machinery = {"multiprocessing", "resource", "select", "signal", "subprocess", "symobs.cli.shared.time_and_memory"}
    assert after("solve", str(SERVO), "--format", "json") & machinery == set()
    assert "symobs.cli.shared.time_and_memory" in after("solve", str(SERVO), "--format", "json", "--timeout", "1000")


@pytest.mark.slow
def test_no_worked_example_imports_what_is_heavy() -> None:
    several = f"""
import sys
from symobs.cli import main
for file in {[str(path) for path in EXAMPLES if path.stem != "cart_pole"]!r}:
    sys.argv = ["symobs", "solve", file, "--format", "json"]
    try:
        main()
    except SystemExit as end:
        assert end.code == 0, file
print(*sys.modules, sep="\\n", file=sys.stderr)
"""
    # NumPy is for the search of a small gain of several inputs or outputs
    assert imported(several) & HEAVY <= {"numpy"}


def test_the_version_needs_neither_kernel_nor_tasks() -> None:
    found = after("--version")
    assert found & (HEAVY | KERNEL) == set()
    own = {name for name in found if name.startswith("symobs")}
    own_modules = {
        "symobs.ground.child_processes",
        "symobs.cli",
        "symobs.cli.command_line",
        "symobs.cli.shared",
        "symobs.cli.shared.common",
        "symobs.cli.shared.output",
    }
    assert own == {"symobs", "symobs.ground", "symobs.ground.errors"} | own_modules


def test_importing_symobs_imports_nothing_else_of_it() -> None:
    found = imported("import sys, symobs; print(*sys.modules, sep='\\n', file=sys.stderr)")
    assert found & (HEAVY | KERNEL) == set()
    assert {name for name in found if name.startswith("symobs")} == {"symobs"}


def test_a_design_from_python_imports_sympy_when_its_objects_are_asked_for() -> None:
    design = """
import sys, symobs
design = symobs.observer(symobs.StateSpace("[0 1; 0 -1]", C="[1 0]"), poles=[-10, -10])
design.to_latex(), design.to_json(), design.verdict, repr(design)
"""
    shown = "print(*sys.modules, sep='\\n', file=sys.stderr)"
    assert imported(design + shown) & HEAVY == set()
    assert "sympy" in imported(f"{design}design.L\n{shown}")


@pytest.mark.slow
def test_only_latex_needs_its_templates() -> None:
    for form in ("json", "text", "html", "markdown"):
        assert "jinja2" not in after("solve", str(SERVO), "--format", form)


#: The tasks in the modules that the solution of an example loads: its own, those beside it, and what it stands on.
_RANKS = {"controllability", "observability"}
_STANDS_ON = {
    "detectable": _RANKS | {"detectability", "stabilizability"},
    "lyapunov": {"lyapunov"},
    "servo_observer": _RANKS | {"observer"},
    "zero_order_hold": {"zero_order_hold", "matrix_exponential"},
}


@pytest.mark.parametrize("example", _STANDS_ON)
def test_a_solution_loads_the_modules_of_its_task_alone(example: str) -> None:
    found = after("solve", str(EXAMPLES[0].with_stem(example)), "--format", "json")
    assert {task for module in found for task in _tasks_in(module)} == _STANDS_ON[example]


def _tasks_in(module: str) -> list[str]:
    """The tasks that stand in a module of symobs."""
    if not module.startswith("symobs.tasks."):
        return []
    path = ROOT.joinpath(*module.split(".")).with_suffix(".py")
    source = path.read_text("utf-8") if path.exists() else ""
    return re.findall(r"^@task[^\n]*\n(?:@[^\n]*\n)*def (\w+)\(", source, re.MULTILINE)


def test_tasks_and_formats_are_listed_without_importing_one() -> None:
    import symobs  # noqa: PLC0415 - what the list is held against
    from symobs.cli import command_line  # noqa: PLC0415
    from symobs.cli.shared import task_index  # noqa: PLC0415
    from symobs.tasks import result  # noqa: PLC0415

    tasks = {name: task.summary for name, task in sorted(result.tasks().items())}
    assert task_index.task_summaries(symobs.TASK_PACKAGES) == tasks
    formats = {name: kind.suffix for name, kind in sorted(result.formats().items())}
    assert task_index.format_suffixes(symobs.FORMAT_PACKAGE) == formats
    for name, summary in command_line.COMMANDS.items():
        module = import_module(command_line.place_of(name))
        assert module.command.name == name
        assert " ".join(module.command.help.partition("\n\n")[0].split()) == summary
    found = after("--help")
    assert not {name for name in found if name.startswith(("symobs.tasks.analysis", "symobs.tasks.design", "flint"))}
