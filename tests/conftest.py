"""What all tests share: reproducible Hypothesis runs, tools that may be missing at home, and which tests share a worker."""

from __future__ import annotations

import os
import re
import shutil
import signal
import sys
from functools import cache
from pathlib import Path
from types import CodeType, FunctionType, ModuleType
from typing import TYPE_CHECKING, Any

import pytest
from hypothesis import HealthCheck, settings

from symobs.formula.phrases import PHRASES
from tests.support.examples import example_of
from tests.support.paths import COMPILED, ROOT
from tests.support.problems.steps import OWN_PHRASES
from tests.support.sampling import FULL
from tests.support.tools.browser import launched

if TYPE_CHECKING:
    from collections.abc import Callable, Generator, Iterator

SKIPS_FAIL = os.environ.get("SYMOBS_REQUIRE_TOOLS") == "1"

# The same examples in every run, and nothing that depends on how fast the machine is.
settings.register_profile(
    "symobs",
    max_examples=100 if FULL else 20,
    derandomize=True,
    database=None,
    deadline=None,
    print_blob=True,
    suppress_health_check=[HealthCheck.too_slow],
)
settings.load_profile("symobs")

# What is compiled once is compiled for the hundreds of processes that tests start, whatever the environment says.
sys.dont_write_bytecode, sys.pycache_prefix = False, str(ROOT / COMPILED)
os.environ.pop("PYTHONDONTWRITEBYTECODE", None)
os.environ["PYTHONPYCACHEPREFIX"] = sys.pycache_prefix

# A shell's background jobs begin with it ignored, and so would every process that a test starts and interrupts.
if signal.getsignal(signal.SIGINT) is signal.SIG_IGN:
    signal.signal(signal.SIGINT, signal.default_int_handler)


def require_tool(name: str) -> str:
    """Return the path of the command `name`; without it skip the test, or fail where SYMOBS_REQUIRE_TOOLS=1."""
    path = shutil.which(name)
    if path is None:
        message = f"{name} is not on PATH"
        if SKIPS_FAIL:
            pytest.fail(message, pytrace=False)
        pytest.skip(message)
    return path


@pytest.fixture(name="require_tool", scope="session")
def require_tool_fixture() -> Callable[[str], str]:
    """Offer `require_tool` to tests without an import."""
    return require_tool


@pytest.fixture(scope="module")
def chromium(require_tool: Callable[[str], str]) -> Iterator[Any]:
    """Return a headless Chromium that is driven by playwright."""
    pytest.importorskip("playwright.sync_api", reason="needs playwright: pip install symobs[browser-test]")
    with launched(require_tool("chromium")) as browser:
        yield browser


@pytest.fixture
def own_phrases(monkeypatch: pytest.MonkeyPatch) -> None:
    """Put in the phrases that steps written by hand use."""
    for key, phrase in OWN_PHRASES.items():
        monkeypatch.setitem(PHRASES, key, phrase)


# -- which tests -------------------------------------------------------------------------------------------------------

#: Tests that were measured and take long, by file and name.
SLOW = {*Path(__file__).with_name("slow.txt").read_text("utf-8").splitlines()}
_ALL_SLOW = re.compile(r"^pytestmark = pytest\.mark\.slow$", re.MULTILINE)


def pytest_ignore_collect(collection_path: Path, config: pytest.Config) -> bool | None:
    """Leave out files of which nothing is chosen without importing them."""
    chosen = config.option.markexpr
    if collection_path.suffix != ".py" or not chosen or config.args != config.getini("testpaths"):
        return None
    text = collection_path.read_text("utf-8")
    left_out = "not slow" in chosen and _ALL_SLOW.search(text)
    return True if left_out else None


@pytest.hookimpl(tryfirst=True)
def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Mark the tests that take long or start processes; those of one worked example or one shared fixture share a worker."""
    for item in items:
        if item.nodeid.partition("[")[0].removeprefix("tests/") in SLOW:
            item.add_marker(pytest.mark.slow)
        if not isinstance(item, pytest.Function):
            continue
        fixtures = [fixture for found in item._fixtureinfo.name2fixturedefs.values() for fixture in found]
        if example := example_of(list(item.callspec.params.values()) if hasattr(item, "callspec") else []):
            item.add_marker(pytest.mark.xdist_group(example))
        elif any(fixture.scope == "module" for fixture in fixtures):
            item.add_marker(pytest.mark.xdist_group(item.path.name))
        if any(map(starts_process, (item.function, *(fixture.func for fixture in fixtures)))):
            item.add_marker(pytest.mark.process)


#: What starts a process: modules, and functions of symobs.
_STARTS = {"subprocess", "multiprocessing", "require_tool", "compiled", "Popen", "fork"}


@cache
def starts_process(function: Any) -> bool:
    """Tell whether a function of the tests, or one that it calls, starts a process."""
    left, seen = [function], set[int]()
    while left:
        found = left.pop()
        found = getattr(found, "__wrapped__", found)
        if id(found) in seen or not str(getattr(found, "__module__", "")).startswith("tests"):
            continue
        seen.add(id(found))
        if isinstance(found, type):
            left += vars(found).values()
        elif isinstance(found, FunctionType):
            names = {*_names(found.__code__)}
            values = [found.__globals__[name] for name in names if name in found.__globals__]
            own = [
                vars(value) for value in values if isinstance(value, ModuleType) and value.__name__.startswith("tests")
            ]
            values += [scope[name] for scope in own for name in names if name in scope]
            if names & _STARTS or {value.__name__ for value in values if isinstance(value, ModuleType)} & _STARTS:
                return True
            left += values
    return False


def _names(code: CodeType) -> Iterator[str]:
    yield from code.co_names
    yield from code.co_varnames[: code.co_argcount]
    for constant in code.co_consts:
        if isinstance(constant, CodeType):
            yield from _names(constant)


# -- with SYMOBS_REQUIRE_TOOLS=1 every skip is a failure, whoever asked for it: nothing is left out in silence -----------


@pytest.hookimpl(wrapper=True, tryfirst=True)
def pytest_runtest_makereport() -> Generator[None, pytest.TestReport, pytest.TestReport]:
    report = yield
    if SKIPS_FAIL and report.skipped and not hasattr(report, "wasxfail"):
        report.outcome = "failed"
        report.longrepr = f"skipped, where a skip is a failure: {report.longrepr}"
    return report


@pytest.hookimpl(wrapper=True, tryfirst=True)
def pytest_make_collect_report() -> Generator[None, pytest.CollectReport, pytest.CollectReport]:
    report = yield
    if SKIPS_FAIL and report.skipped:
        report.outcome = "failed"
        report.longrepr = f"skipped, where a skip is a failure: {report.longrepr}"
    return report
