"""Tries mutants one by one: a process forked for each, in which the tests that touch its line run until one fails.

Everything is imported and collected once.  A mutant's functions get their new code in place, so that whoever imported
them has it too; what runs when a module is imported (classes, decorators, defaults) is tried in a process of its own.
Time is counted by the processor, not by the clock: a mutant that goes on far longer than its tests do counts as found.
"""

from __future__ import annotations

import ast
import functools
import gc
import importlib
import json
import os
import resource
import signal
import subprocess
import sys
from collections import defaultdict
from types import FunctionType
from typing import TYPE_CHECKING, Any

import coverage
import pytest

from tests.support.paths import ROOT

if TYPE_CHECKING:
    from collections.abc import Callable, Collection, Iterable, Sequence
    from pathlib import Path
    from types import CodeType

    from tests.programs.mutation.mutants import Mutant

#: Seconds of processor time beyond those its tests take; and bytes of memory.
GRACE, MEMORY = 15, 4 * 2**30
#: The tests of one mutant take at most this many seconds, the quickest first.  They are seconds of the map, whose traces make
#: a test of judgement five times as long: with fewer most of what survived had never met the test that was written for it.
LONGEST = 40.0
#: And those of one that is known to say the same, which were all asked when it was found to.
LONGEST_OF_KNOWN = 1.0
#: A test that takes longer than this is not asked.
LONGEST_TEST = 15.0
#: Tests that have found a mutant of the same function lately are asked first.
_REMEMBERED = 6

KILLED, SURVIVED, UNTRIED = "killed", "survived", "no test touches it"


class Trial:
    """What pytest runs instead of all tests: the map of which touch which lines, then every mutant."""

    def __init__(
        self,
        paths: Sequence[Path],
        mutants: Iterable[Mutant],
        report: Callable[[Mutant, str, str], None],
        kept: Path,
        known: Collection[tuple[str, str]],
    ) -> None:
        self.paths, self.mutants, self.report, self.kept, self.known = paths, mutants, report, kept, known
        self.seconds: dict[str, float] = {}
        self.touching: dict[str, dict[int, list[str]]] = {}
        self.lately: dict[str, list[str]] = defaultdict(list)

    @pytest.hookimpl(tryfirst=True)
    def pytest_runtestloop(self, session: pytest.Session) -> bool:
        """Try all mutants."""
        items = {item.nodeid: item for item in session.items}
        for path in self.paths:
            importlib.import_module(module_name(path))
        self.mapped(items)
        functions_by_file()
        gc.freeze()
        for mutant in self.mutants:
            names = self.names_for(mutant, items)
            if not names:
                self.report(mutant, UNTRIED, "")
            else:
                self.report(mutant, *self.tried(mutant, [items[name] for name in names]))
        return True

    # -- which tests touch which lines ---------------------------------------------------------------------------------

    def mapped(self, items: dict[str, pytest.Item]) -> None:
        """Find out which tests touch which lines, and how long they take, in a process whose traces are not kept."""
        known = (
            json.loads(self.kept.read_text(encoding="utf-8")) if self.kept.exists() else {"seconds": {}, "touching": {}}
        )
        new = [item for name, item in items.items() if name not in known["seconds"]]
        if new:
            pid = os.fork()
            if pid == 0:
                _quietly()
                _map(new, self.paths, known, self.kept)
            _, status = os.waitpid(pid, 0)
            if status:
                raise RuntimeError("the tests could not be mapped")
            known = json.loads(self.kept.read_text(encoding="utf-8"))
        self.seconds = known["seconds"]
        self.touching = {path: {int(k): v for k, v in lines.items()} for path, lines in known["touching"].items()}

    def names_for(self, mutant: Mutant, items: dict[str, pytest.Item]) -> list[str]:
        """Return the tests that touch a mutant's lines, the quickest first.

        Of what runs on import they are those that touch where its names are read, or else any line of the module.
        """
        lines = self.touching.get(str(mutant.path), {})
        touched = range(mutant.line, mutant.last_line + 1) if mutant.is_inside else _lines_that_read(mutant) or lines
        found = {name for line in touched for name in lines.get(line, ())} & items.keys()
        last = self.lately[mutant.where]
        order = sorted(found, key=lambda name: (-last.index(name) - 1 if name in last else 0, self.seconds[name]))
        longest = LONGEST_OF_KNOWN if (mutant.file, mutant.key) in self.known else LONGEST
        chosen: list[str] = []
        total = 0.0
        for name in order:
            if self.seconds[name] > LONGEST_TEST:
                continue
            total += self.seconds[name]
            if chosen and total > longest:
                break
            chosen.append(name)
        return chosen

    # -- one mutant ----------------------------------------------------------------------------------------------------

    def tried(self, mutant: Mutant, items: list[pytest.Item]) -> tuple[str, str]:
        """Return whether a test finds the mutant, and which."""
        limit = GRACE + 3 * int(sum(self.seconds[item.nodeid] for item in items))
        told, tell = os.pipe()
        pid = os.fork()
        if pid == 0:
            os.close(told)
            _quietly()
            signal.signal(signal.SIGPROF, signal.SIG_DFL)
            signal.setitimer(signal.ITIMER_PROF, limit)
            resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
            _child(mutant, items, tell)
        os.close(tell)
        with os.fdopen(told) as pipe:
            said = pipe.read()
        _, status = os.waitpid(pid, 0)
        if os.WIFSIGNALED(status):
            return KILLED, "time" if os.WTERMSIG(status) == signal.SIGPROF else f"signal {os.WTERMSIG(status)}"
        if said == "in a process of its own":
            return cold(mutant, [item.nodeid for item in items], limit)
        if os.WEXITSTATUS(status) == 0:
            return SURVIVED, f"{len(items)} tests"
        if said in self.seconds:
            last = self.lately[mutant.where]
            self.lately[mutant.where] = [*[name for name in last if name != said][1 - _REMEMBERED :], said]
        return KILLED, said


def _quietly() -> None:
    nowhere = os.open(os.devnull, os.O_RDWR)
    for stream in (0, 1, 2):
        os.dup2(nowhere, stream)


def _child(mutant: Mutant, items: list[pytest.Item], tell: int) -> None:
    """Put the mutant in and run the tests; leaves the process."""
    try:
        is_in = put_in(mutant)
    except Exception as error:  # noqa: BLE001 - whatever does not even compile is found
        os.write(tell, f"{type(error).__name__}: {error}".encode())
        os._exit(1)
    if not is_in:
        os.write(tell, b"in a process of its own")
        os._exit(0)
    found = run_until_failure(items)
    os.write(tell, found.encode())
    os._exit(1 if found else 0)


def run_until_failure(items: list[pytest.Item]) -> str:
    """Run tests until one fails; return its name, "" where none does."""

    class Failures:
        name = ""

        @pytest.hookimpl(tryfirst=True)
        def pytest_runtest_makereport(self, item: pytest.Item, call: pytest.CallInfo[None]) -> None:
            if call.excinfo is not None and not isinstance(call.excinfo.value, pytest.skip.Exception):
                raise _Found(item.nodeid)

    for item in items:
        item.config.pluginmanager.register(Failures(), "failures") if item is items[0] else None
        try:
            item.config.hook.pytest_runtest_protocol(item=item, nextitem=None)
        except _Found as found:
            return str(found)
        except BaseException:  # noqa: BLE001 - a mutant may raise anything, and is found by it
            return item.nodeid
    return ""


class _Found(BaseException):
    """A test has failed."""


# -- mutants in place ---------------------------------------------------------------------------------------------------


def put_in(mutant: Mutant) -> bool:
    """Give the living module the mutant's code; False where only importing it anew does."""
    if not mutant.is_inside:
        statement = _assignment(mutant)
        if statement is not None:
            mutant.code()
            _assign(statement, mutant.path)
        return statement is not None
    code = mutant.code()
    new = {(c.co_qualname, c.co_firstlineno): c for c in _codes(code)}
    for function in _functions(mutant.path):
        fresh = new.get((function.__code__.co_qualname, function.__code__.co_firstlineno))
        if fresh is not None and fresh != function.__code__:
            if fresh.co_freevars != function.__code__.co_freevars:
                return False
            function.__code__ = fresh
    return True


def _lines_that_read(mutant: Mutant) -> set[int]:
    """Return the lines of functions that read a name to which the mutated statement at the top of a module gives its value."""
    names = {
        name
        for statement in mutant.tree.body
        if isinstance(statement, (ast.Assign, ast.AnnAssign))
        and statement.lineno <= mutant.line <= (statement.end_lineno or 0)
        for name in _defined(statement)
    }
    functions = [node for node in ast.walk(mutant.tree) if isinstance(node, ast.FunctionDef)]
    inside = [node for function in functions for part in function.body for node in ast.walk(part)]
    return {node.lineno for node in inside if isinstance(node, ast.Name) and node.id in names}


def _assignment(mutant: Mutant) -> ast.Assign | ast.AnnAssign | None:
    """Return the mutated statement where it gives a name at the top of a module its value."""
    for statement in mutant.tree.body:
        if statement.lineno <= mutant.line <= (statement.end_lineno or 0):
            if _is_a_default(statement, mutant.tree) or _is_read_on_import(statement, mutant.tree):
                return None
            is_named = isinstance(statement, ast.Assign) and isinstance(statement.targets[0], (ast.Name, ast.Tuple))
            if is_named or isinstance(statement, ast.AnnAssign):
                return statement  # type: ignore[return-value]
    return None


def _is_a_default(statement: ast.stmt, tree: ast.Module) -> bool:
    """Tell whether a name that a statement defines is the default of an argument, which the function keeps."""
    names = _defined(statement)
    functions = [node.args for node in ast.walk(tree) if isinstance(node, ast.FunctionDef)]
    defaults = [default for head in functions for default in (*head.defaults, *head.kw_defaults) if default]
    return any(isinstance(node, ast.Name) and node.id in names for default in defaults for node in ast.walk(default))


def _is_read_on_import(statement: ast.stmt, tree: ast.Module) -> bool:
    """Tell whether another name at the top of the module, or a class, gets its value from one that a statement defines."""
    names = _defined(statement)
    others = [node for node in tree.body if node is not statement and not isinstance(node, ast.FunctionDef)]
    return any(isinstance(node, ast.Name) and node.id in names for other in others for node in ast.walk(other))


def _defined(statement: ast.stmt) -> set[str]:
    return {node.id for node in ast.walk(statement) if isinstance(node, ast.Name) and isinstance(node.ctx, ast.Store)}


def _assign(statement: ast.Assign | ast.AnnAssign, path: Path) -> None:
    """Give names at the top of a module their new values, wherever they were imported to."""
    module = sys.modules[module_name(path)]
    target = statement.targets[0] if isinstance(statement, ast.Assign) else statement.target
    names = [ast.unparse(part) for part in (target.elts if isinstance(target, ast.Tuple) else [target])]
    scope = dict(vars(module))
    exec(compile(ast.Module([statement], []), str(path), "exec"), scope)  # noqa: S102 - our own source
    for name in names:
        old = vars(module)[name]
        for other in list(sys.modules.values()):
            if vars(other).get(name) is old:
                vars(other)[name] = scope[name]


def module_name(path: Path) -> str:
    """Return the name by which a file of the package is imported."""
    return ".".join(path.relative_to(ROOT).with_suffix("").parts).removesuffix(".__init__")


def _codes(code: CodeType) -> Iterable[CodeType]:
    yield code
    for constant in code.co_consts:
        if hasattr(constant, "co_code"):
            yield from _codes(constant)


@functools.cache
def functions_by_file() -> dict[str, list[FunctionType]]:
    found: dict[str, list[FunctionType]] = defaultdict(list)
    for thing in gc.get_objects():
        if isinstance(thing, FunctionType):
            found[thing.__code__.co_filename].append(thing)
    return found


def _functions(path: Path) -> list[FunctionType]:
    return functions_by_file()[str(path)]


# -- the map ------------------------------------------------------------------------------------------------------------


def _map(items: list[pytest.Item], paths: Sequence[Path], known: dict[str, Any], kept: Path) -> None:
    """Write down what the tests touch; leaves the process."""
    caches = [
        thing
        for thing in gc.get_objects()
        if isinstance(thing, functools._lru_cache_wrapper)
        and thing.__module__.startswith(("symobs.proof.derivation", "test"))
    ]
    tracer = coverage.Coverage(include=[str(path) for path in paths], data_file=None, config_file=False)
    tracer.start()
    for item in items:
        for cache in caches:
            cache.cache_clear()
        tracer.switch_context(item.nodeid)
        begun = _seconds()
        passed = _passes(item)
        spent = _seconds() - begun
        if passed:
            known["seconds"][item.nodeid] = round(spent, 3)
    tracer.stop()
    data = tracer.get_data()
    for path in data.measured_files():
        lines = known["touching"].setdefault(path, {})
        for line, names in data.contexts_by_lineno(path).items():
            lines.setdefault(str(line), []).extend(name for name in names if name in known["seconds"])
    kept.write_text(json.dumps(known), encoding="utf-8")
    os._exit(0)


def _seconds() -> float:
    """Return the processor time spent until now, by programs that were called too."""
    spent = os.times()
    return spent.user + spent.system + spent.children_user + spent.children_system


def _passes(item: pytest.Item) -> bool:
    reports = []

    class Reports:
        def pytest_runtest_logreport(self, report: pytest.TestReport) -> None:
            reports.append(report)

    plugin = Reports()
    item.config.pluginmanager.register(plugin)
    item.config.hook.pytest_runtest_protocol(item=item, nextitem=None)
    item.config.pluginmanager.unregister(plugin)
    return all(report.passed for report in reports)


# -- a process of its own -----------------------------------------------------------------------------------------------


def cold(mutant: Mutant, names: list[str], limit: int) -> tuple[str, str]:
    """Try a mutant that only importing anew puts in."""
    command = [sys.executable, "-m", "tests.programs.mutation", "--one", str(mutant.path), mutant.key, str(limit)]
    done = subprocess.run(
        command, cwd=ROOT, input="\n".join(names), text=True, capture_output=True, check=False, env=dict(os.environ)
    )
    if done.returncode == 0:
        return SURVIVED, f"{len(names)} tests"
    return KILLED, done.stdout.strip().splitlines()[-1] if done.stdout.strip() else f"exit {done.returncode}"


class Short:
    """Makes runs short: no shrinking of what Hypothesis found, few examples where a test does not ask for more."""

    @pytest.hookimpl(trylast=True)
    def pytest_configure(self) -> None:
        """Load the profile after that of the tests."""
        from hypothesis import HealthCheck, Phase, settings  # noqa: PLC0415 - pytest wants to import it first

        settings.register_profile(
            "mutation",
            derandomize=True,
            database=None,
            deadline=None,
            max_examples=15,
            phases=(Phase.explicit, Phase.generate),
            suppress_health_check=list(HealthCheck),
        )
        settings.load_profile("mutation")
