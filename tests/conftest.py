"""What all tests share: reproducible Hypothesis runs, and tools that may be missing at home but not in CI."""

from __future__ import annotations

import os
import shutil
from typing import TYPE_CHECKING

import pytest
from hypothesis import HealthCheck, settings

from symobs.formula.phrases import PHRASES
from tests.support.problems.steps import OWN_PHRASES

if TYPE_CHECKING:
    from collections.abc import Callable, Generator

SKIPS_FAIL = os.environ.get("SYMOBS_REQUIRE_TOOLS") == "1"

# The same examples in every run, and nothing that depends on how fast the machine is.
settings.register_profile(
    "symobs",
    derandomize=True,
    database=None,
    deadline=None,
    print_blob=True,
    suppress_health_check=[HealthCheck.too_slow],
)
settings.load_profile("symobs")


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


@pytest.fixture
def own_phrases(monkeypatch: pytest.MonkeyPatch) -> None:
    """Put in the phrases that steps written by hand use."""
    for key, phrase in OWN_PHRASES.items():
        monkeypatch.setitem(PHRASES, key, phrase)


# With SYMOBS_REQUIRE_TOOLS=1 every skip is a failure, whoever asked for it: nothing is left out in silence.


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
