"""Mutation testing of the trusted floors: `python -m tests.mutation [--only FILE] [--every N] [--log PATH]`."""

from __future__ import annotations

import argparse
import os
import resource
import signal
import sys
import tomllib
from collections import Counter
from importlib.abc import Loader, MetaPathFinder
from importlib.machinery import ModuleSpec
from importlib.util import spec_from_loader
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest

from tests.mutation.mutants import Mutant, mutants_of
from tests.mutation.trial import HERE, KILLED, MEMORY, SURVIVED, Short, Trial, module_name, run_until_failure

if TYPE_CHECKING:
    from collections.abc import Sequence
    from types import ModuleType

#: The trusted floors, and the tests that stand for them.
TRUSTED = [
    HERE / "symobs" / "certificate.py",
    *sorted((HERE / "symobs" / "derivation").glob("*.py")),
    *sorted((HERE / "symobs" / "method").glob("*.py")),
]
#: The tests that stand for each of their files, by the end of its path; small and direct ones, so that all can be tried.
TESTS = {
    "certificate.py": "certificate trusted_floors",
    "check.py": "derivation trusted_steps trusted_floors",
    "steps.py": "derivation trusted_steps",
    "strata.py": "derivation trusted_steps trusted_floors",
    "properties.py": "derivation trusted_steps stability",
    "region_claims.py": "derivation trusted_steps region_conditions",
    "regions.py": "trusted_steps stability_region region_bounds",
    "flows.py": "derivation trusted_steps diagrams",
    "places.py": "pictures trusted_steps",
    "pictures.py": "pictures trusted_steps",
    "pole_paths.py": "pictures trusted_steps",
    "responses.py": "time_responses trusted_steps",
    "tables.py": "routh trusted_steps",
    "translation.py": "conventions derivation trusted_steps",
    "rejection.py": "derivation trusted_steps",
    "registry.py": "trusted_results trusted_steps",
    "result.py": "derivation trusted_results",
}
EQUIVALENT = Path(__file__).with_name("equivalent.toml")


def main(arguments: Sequence[str]) -> int:
    """Try the mutants asked for, and print what became of them; 1 where one survives that is not known to be equal."""
    parser = argparse.ArgumentParser(prog="python -m tests.mutation", description=__doc__)
    parser.add_argument("--only", action="append", default=[], help="a part of a file's name, like check.py")
    parser.add_argument("--every", type=int, default=1, help="every N-th mutant only")
    parser.add_argument("--match", default="", help="a part of the mutant's text")
    parser.add_argument("--again", type=Path, help="all but those that were found in this log")
    parser.add_argument("--log", type=Path, help="a file to which each mutant is written as it was tried")
    parser.add_argument("--map", type=Path, default=Path("/tmp/symobs-mutation-map.json"), help="where the map is kept")  # noqa: S108
    chosen = parser.parse_args(arguments)
    paths = [path for path in TRUSTED if not chosen.only or any(part in str(path) for part in chosen.only)]
    equivalent = known_equivalent()
    mutants = [m for path in paths for m in mutants_of(path)]
    if chosen.again:
        lines = [line.split("\t") for line in chosen.again.read_text(encoding="utf-8").splitlines()]
        killed = {(where.split(":")[0], key) for outcome, where, key, _ in lines if outcome == KILLED}
        mutants = [m for m in mutants if (m.path.relative_to(HERE).as_posix(), m.key) not in killed]
    log = chosen.log.open("a", encoding="utf-8") if chosen.log else sys.stdout
    counts: dict[str, Counter[str]] = {path.relative_to(HERE).as_posix(): Counter() for path in paths}
    output = os.dup(1)

    def report(mutant: Mutant, outcome: str, by: str) -> None:
        name = mutant.path.relative_to(HERE).as_posix()
        known = (name, mutant.key) in equivalent
        counts[name]["equivalent" if known and outcome != KILLED else outcome] += 1
        if known and outcome == KILLED:
            outcome = "NOT EQUIVALENT"
            counts[name][outcome] += 1
        if chosen.log or outcome != KILLED:
            os.write(
                output if not chosen.log else log.fileno(),
                f"{'equivalent' if known and outcome != 'NOT EQUIVALENT' else outcome}\t{name}:{mutant.line}\t{mutant.key}\t{by}\n".encode(),
            )

    wanted = [m for m in mutants if chosen.match in m.key][:: chosen.every]
    names = sorted({name for path in paths for name in TESTS.get(path.name, "").split()})
    tests = [str(path) for name in names if (path := HERE / "tests" / f"test_{name}.py").exists()]
    trial = Trial(TRUSTED, wanted, report, chosen.map)
    options = ["-q", "--no-header", "--tb=no", "-p", "no:cacheprovider"]
    code = pytest.main([*options, *tests], plugins=[Short(), trial])
    total: Counter[str] = Counter()
    for name, count in counts.items():
        total += count
        if count:
            print(f"{name}: {_said(count)}")
    print(f"all: {_said(total)}")
    return int(code) or int(total[SURVIVED] + total["no test touches it"] + total["NOT EQUIVALENT"] > 0)


def _said(count: Counter[str]) -> str:
    tried = sum(n for name, n in count.items() if name != "NOT EQUIVALENT")
    return f"{tried} tried, " + ", ".join(f"{n} {name}" for name, n in sorted(count.items()))


def known_equivalent() -> set[tuple[str, str]]:
    """Return the mutants that are known to say the same."""
    if not EQUIVALENT.exists():
        return set()
    found = tomllib.loads(EQUIVALENT.read_text(encoding="utf-8"))
    return {(name, key) for name, keys in found.items() for key in keys}


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
    files = sorted({str(HERE / name.split("::")[0]) for name in names})
    options = ["-q", "--no-header", "--tb=no", "-p", "no:cacheprovider"]
    code = pytest.main([*options, *files], plugins=[Short(), some])
    print(some.found or f"exit {int(code)}")
    return 1 if some.found or code not in {0, 5} else 0


if __name__ == "__main__":
    sys.exit(one(*sys.argv[2:]) if sys.argv[1:2] == ["--one"] else main(sys.argv[1:]))
