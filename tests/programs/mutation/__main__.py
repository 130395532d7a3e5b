"""Mutation testing: `python -m tests.programs.mutation [--only FILE] [--every N] [--log PATH]`.

Of the trusted floors, and of what decides about the answers of students.  Every mutant must be found by a test, or stand in
`equivalent.toml` with the reason why it says the same.
"""

from __future__ import annotations

import argparse
import os
import resource
import signal
import sys
import tempfile
import tomllib
from collections import Counter
from importlib.abc import Loader, MetaPathFinder
from importlib.util import spec_from_loader
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest

from tests.programs.mutation.mutants import Mutant, mutants_of
from tests.programs.mutation.trial import KILLED, MEMORY, Short, Trial, module_name, run_until_failure
from tests.support.paths import ROOT

if TYPE_CHECKING:
    from collections.abc import Sequence
    from importlib.machinery import ModuleSpec
    from types import ModuleType

#: The trusted floors.
TRUSTED = [
    ROOT / "symobs" / "proof" / "certificate" / "claims.py",
    *sorted(path for path in (ROOT / "symobs" / "proof" / "derivation").rglob("*.py") if path.name != "builder.py"),
    ROOT / "symobs" / "tasks" / "result" / "registry.py",
    ROOT / "symobs" / "tasks" / "result" / "result.py",
    ROOT / "symobs" / "tasks" / "result" / "writers.py",
]
#: What decides whether an answer is right: the claims of the check, and the grader that goes with an exported question.
MARKING = [
    *sorted((ROOT / "symobs" / "applications" / "checking" / "judgement").glob("[a-z]*.py")),
    *sorted((ROOT / "symobs" / "applications" / "export" / "grader").glob("[a-z]*.py")),
]
#: The tests that stand for each of their files, by the end of its path; small and direct ones, so that all mutants can be
#: tried.
TESTS = {
    "judgement/as_asked.py": "as_students_write claims_decide coordinates gains_of_each_task judgement",
    "judgement/conditions.py": "claims_decide conditions_as_written regions",
    "judgement/coordinates.py": "coordinates judgement",
    "judgement/gains.py": "claims_decide coordinates faults gains_of_each_task judgement observers_of_disturbances",
    "judgement/judge.py": "as_students_write claims_decide coordinates faults functions_of_time gains_of_each_task judgement",
    "judgement/other_compensators.py": "claims_decide gains_of_each_task judgement",
    "judgement/parts.py": "claims_decide coordinates functions_of_time gains_of_each_task judgement observers_of_disturbances",
    "judgement/regions.py": "regions",
    "grader/claims.py": "grader prairielearn",
    "grader/values.py": "grader_values grader",
    "claims.py": "claims refusals",
    "decimals_check.py": "pages_in_decimals",
    "check.py": "check steps_refused refusals",
    "steps.py": "plot_check steps_refused",
    "restriction.py": "check steps_refused",
    "properties.py": "properties",
    "exact_where.py": "properties",
    "region_check.py": "region_check",
    "block_diagram_check.py": "block_diagram_check",
    "plot_points.py": "region_plot_check plot_check",
    "plot_check.py": "region_plot_check plot_check",
    "region_plot_check.py": "region_plot_check plot_check",
    "root_locus_check.py": "plot_check",
    "time_response_check.py": "plot_check",
    "routh_check.py": "routh_table",
    "convention_signs.py": "convention_signs",
    "sign_translation.py": "convention_signs",
    "wording_check.py": "wording_check sentences",
    "rejection.py": "check steps_refused",
    "registry.py": "registry result",
    "result.py": "check result",
    "writers.py": "registry result",
}
EQUIVALENT = Path(__file__).with_name("equivalent.toml")
OPTIONS = ["-q", "--no-header", "--tb=no", "-p", "no:cacheprovider"]


def main(arguments: Sequence[str]) -> int:
    """Try the mutants asked for, and print what became of them; 1 where one survives that is not known to be equal."""
    parser = argparse.ArgumentParser(prog="python -m tests.programs.mutation", description=__doc__)
    parser.add_argument("--only", action="append", default=[], help="a part of a file's path, like check.py")
    parser.add_argument("--every", type=int, default=1, help="every N-th mutant only")
    parser.add_argument("--match", default="", help="a part of the mutant's text")
    parser.add_argument("--again", type=Path, help="all but those that were found in this log")
    parser.add_argument("--log", type=Path, help="a file to which each mutant is written as it was tried")
    parser.add_argument("--map", type=Path, help="where to keep which tests touch which lines, for the next run")
    chosen = parser.parse_args(arguments)
    paths = [path for path in (*TRUSTED, *MARKING) if not chosen.only or any(part in str(path) for part in chosen.only)]
    mutants = [m for path in paths for m in mutants_of(path) if chosen.match in m.key][:: chosen.every]
    if chosen.again:
        lines = [line.split("\t") for line in chosen.again.read_text(encoding="utf-8").splitlines()]
        found = {(where.split(":")[0], key) for outcome, where, key, _ in lines if outcome == KILLED}
        mutants = [m for m in mutants if (m.file, m.key) not in found]
    report = Report(chosen.log)
    names = sorted({name for path in paths for name in standing_for(path)})
    tests = [str(next((ROOT / "tests").rglob(f"test_{name}.py"))) for name in names]
    with tempfile.TemporaryDirectory() as folder:
        trial = Trial(paths, mutants, report, chosen.map or Path(folder) / "map.json", report.known)
        os.environ.pop("PYTEST_ADDOPTS", None)  # what runs these tests may itself be run by several workers
        code = pytest.main([*OPTIONS, *tests], plugins=[Short(), trial])
    report.close()
    return int(code) or int(report.is_bad)


def standing_for(path: Path) -> list[str]:
    """Return the names of the tests that stand for a file: those of the longest end of its path that is listed."""
    ends = [end for end in TESTS if path.as_posix().endswith(f"/{end}")]
    return TESTS[max(ends, key=len)].split() if ends else []


class Report:
    """Counts what became of the mutants of each file, and writes down each as it was tried."""

    def __init__(self, log: Path | None) -> None:
        self.known = {(name, key) for name, keys in known_equivalent().items() for key in keys}
        self.counts: dict[str, Counter[str]] = {}
        self.is_all = log is not None
        self.log = log.open("a", encoding="utf-8") if log else os.fdopen(os.dup(1), "w", encoding="utf-8")

    def __call__(self, mutant: Mutant, outcome: str, by: str) -> None:
        """Note one; a mutant that was thought to say the same and is found does not."""
        if (mutant.file, mutant.key) in self.known:
            outcome = "equivalent" if outcome != KILLED else "found, though thought equivalent"
        self.counts.setdefault(mutant.file, Counter())[outcome] += 1
        if self.is_all or outcome not in {KILLED, "equivalent"}:
            print(f"{outcome}\t{mutant.file}:{mutant.line}\t{mutant.key}\t{by}", file=self.log, flush=True)

    @property
    def total(self) -> Counter[str]:
        """What became of all."""
        return sum(self.counts.values(), Counter())

    @property
    def is_bad(self) -> bool:
        """Whether one was neither found nor is equivalent."""
        return not self.total.keys() <= {KILLED, "equivalent"}

    def close(self) -> None:
        """Print the figures of each file, and of all."""
        self.log.close()
        for name, count in (*self.counts.items(), ("all", self.total)):
            said = ", ".join(f"{number} {outcome}" for outcome, number in sorted(count.items()))
            print(f"{name}: {count.total()} tried, {said}")


def known_equivalent() -> dict[str, dict[str, str]]:
    """Return the mutants that are known to say the same, with the reasons, by file."""
    return dict(tomllib.loads(EQUIVALENT.read_text(encoding="utf-8")))


# -- a process of its own -----------------------------------------------------------------------------------------------


class _Importer(MetaPathFinder, Loader):
    """Imports one module of the package with the mutant in it."""

    def __init__(self, mutant: Mutant) -> None:
        self.mutant, self.name = mutant, module_name(mutant.path)

    def find_spec(self, fullname: str, *_: Any) -> ModuleSpec | None:
        if fullname != self.name:
            return None
        is_package = self.mutant.path.name == "__init__.py"
        return spec_from_loader(fullname, self, origin=str(self.mutant.path), is_package=is_package)

    def exec_module(self, module: ModuleType) -> None:
        exec(self.mutant.code(), vars(module))  # noqa: S102 - our own source


class _Some:
    """Runs some tests until one fails."""

    def __init__(self, names: list[str]) -> None:
        self.names, self.found = names, "nothing was collected"

    @pytest.hookimpl(tryfirst=True)
    def pytest_runtestloop(self, session: pytest.Session) -> bool:
        items = {item.nodeid: item for item in session.items}
        self.found = run_until_failure([items[name] for name in self.names if name in items])
        return True


def one(path: str, key: str, limit: str) -> int:
    """Import everything with one mutant in it and run the tests named on standard input."""
    signal.setitimer(signal.ITIMER_PROF, int(limit) + 30)
    resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
    (mutant,) = [mutant for mutant in mutants_of(Path(path)) if mutant.key == key]
    sys.meta_path.insert(0, _Importer(mutant))
    names = sys.stdin.read().split("\n")
    some = _Some(names)
    files = sorted({str(ROOT / name.split("::")[0]) for name in names})
    code = pytest.main([*OPTIONS, *files], plugins=[Short(), some])
    print(some.found or f"exit {int(code)}")
    return 1 if some.found or code not in {0, 5} else 0


if __name__ == "__main__":
    sys.exit(one(*sys.argv[2:]) if sys.argv[1:2] == ["--one"] else main(sys.argv[1:]))
