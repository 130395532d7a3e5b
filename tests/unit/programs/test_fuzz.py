"""A slice of the fuzzing, and the fuzzer itself: what it must notice, it notices.

All of it: `python -m tests.programs.fuzz --inputs 1000000`; guided by coverage: `python -m tests.programs.fuzz.guided`.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
from random import Random
from typing import TYPE_CHECKING

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from symobs.exact import Scalar
from symobs.formula.expression import parse_matrix, parse_poles, parse_polynomial, parse_scalar
from symobs.ground.errors import InputError
from tests.programs.fuzz import printing
from tests.programs.fuzz.targets import TARGETS
from tests.programs.fuzz.worker import Tally
from tests.support.paths import ROOT

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

pytestmark = pytest.mark.slow

#: Of a slice, so many inputs a target.
SLICE = {
    "grammar": 1000,
    "problem_toml": 300,
    "problem_json": 300,
    "command_line": 40,
    "printing": 120,
    "audit": 400,
    "check": 150,
    "live": 60,
    "convention": 300,
}
#: The slice runs apart from the tests: the hook that watches it stays for the life of its process.
_RUN = """
import json, sys
from tests.programs.fuzz.worker import memory, prepared, run
from tests.programs.fuzz.targets import TARGETS
watch = prepared()
for name, count in json.loads(sys.argv[1]).items():
    tally = run(TARGETS[name], range(10**9, 10**9 + count), watch, memory())
    print(json.dumps([name, tally.inputs, tally.became, tally.faults]))
"""


def test_a_slice_of_every_target_ends_as_it_may() -> None:
    found = [json.loads(line) for line in apart(_RUN, json.dumps(SLICE)).splitlines()]
    assert {name: faults for name, _, _, faults in found if faults} == {}
    assert {name: count for name, count, _, _ in found} == SLICE
    for name, count, became, _ in found:
        useful = count - became.get("refused", 0)
        assert useful > count / 10, (
            name,
            became,
        )  # else the inputs are noise, and nothing behind the readers is reached


def apart(program: str, *arguments: str, folder: Path = ROOT) -> str:
    """Run a program in a process of its own and return what it prints."""
    environment = {**os.environ, "PYTHONPATH": str(ROOT)}
    command = [sys.executable, "-c", program, *arguments]
    run = subprocess.run(command, cwd=folder, env=environment, capture_output=True, text=True, check=False)
    assert run.returncode == 0, run.stdout + run.stderr
    return run.stdout


# -- what is printed reads back ---------------------------------------------------------------------------------------


@given(st.integers(0, 2**64).map(Random))
@settings(max_examples=150)
def test_what_is_printed_reads_back(source: Random) -> None:
    printing.roundtrip(source)


def test_what_reads_as_something_else_is_seen(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(printing, "parse_scalar", lambda *args, **named: -parse_scalar(*args, **named))
    with pytest.raises(printing.Unlike, match="reads as"):
        [printing.roundtrip(Random(seed)) for seed in range(50)]  # noqa: S311 - repeatable by design


# -- texts by the grammar itself --------------------------------------------------------------------------------------


_ATOMS = st.sampled_from(["1", "2.5", "1e-3", "a", "omega", "h1", "i", "s", "t", "9" * 50, "0"])


def _larger(part: st.SearchStrategy[str]) -> st.SearchStrategy[str]:
    """Texts one rule of the grammar above their parts."""
    several = st.lists(part, min_size=1, max_size=3)
    return st.one_of(
        st.tuples(part, st.sampled_from(["+", "-", " - ", " -", "*", "/", " / ", " ", ""]), part).map("".join),
        st.tuples(part, st.sampled_from(["^", "**"]), st.sampled_from(["2", "-1", "0", "(3-1)", "1/2", "a"])).map(
            "".join
        ),
        st.tuples(st.sampled_from(["-", "+", "sqrt", "exp", "sin", "cosh", ""]), part).map(
            lambda both: f"{both[0]}({both[1]})"
        ),
        st.lists(several.map(" ".join), min_size=1, max_size=3).map(lambda rows: f"[{'; '.join(rows)}]"),
        several.map(", ".join),
    )


@given(st.recursive(_ATOMS, _larger, max_leaves=12))
@settings(max_examples=300)
def test_what_the_grammar_makes_is_read_or_refused(text: str) -> None:
    readers: tuple[Callable[[str], object], ...] = (
        parse_scalar,
        lambda each: parse_matrix(each, functions=True),
        parse_poles,
        lambda each: parse_polynomial(each, "s"),
    )
    for read in readers:
        try:
            value = read(text)
        except InputError:
            continue
        if isinstance(value, Scalar) and read is parse_scalar:
            assert parse_scalar(str(value)) == value


# -- the fuzzer notices -----------------------------------------------------------------------------------------------

_BAD: dict[str, tuple[str, str]] = {
    "code": ("eval('1')", "reached compile"),
    "a program": ("__import__('os').system('true')", "reached os.system"),
    "another process": ("__import__('subprocess').run(['true'])", "reached subprocess.Popen"),
    "a file": ("open('/etc/hostname')", "reached open of '/etc/hostname'"),
    "a file to write": ("open('made', 'w')", "reached open of"),
    "a socket": ("__import__('socket').socket()", "reached socket"),
    "a module": ("__import__('antigravity_of_nobody')", "reached import of antigravity_of_nobody"),
    "a crash": ("1 // 0", "ZeroDivisionError"),
    "a file, in silence": ("kept()", "reached open of '/etc/hostname'"),
    "depth": ("deep(1)", "RecursionError"),
    "a bug that is told": ("bug()", "CertificateRejected"),
    "time": ("[0 for _ in iter(lambda: __import__('time').process_time() > start + 0.4, True)]", "of the processor"),
    "nothing wrong": ("1 + 1", ""),
    "memory": ("len(b'x' * (90 << 20))", "held"),
}
_NOTICED = """
import json, sys, time
from symobs.ground.errors import CertificateRejected
from tests.programs.fuzz.targets import Target
from tests.programs.fuzz.watch import Watch
from tests.programs.fuzz.worker import Tally, memory, one

def kept():
    try:
        open('/etc/hostname')
    except BaseException:
        return

def deep(n):
    return deep(n + 1) + 1

def bug():
    raise CertificateRejected('no')

watch = Watch()
watch.install()
for case, source in json.loads(sys.argv[1]).items():
    code = compile(f'def run(_): return str({source})', case, 'exec')
    exec(code)
    start, tally = time.process_time(), Tally()
    one(Target('bad', 1, str, run, seconds=0.3, megabytes=50), 1, watch, memory(), tally)
    print(json.dumps([case, tally.faults]))
"""


def test_what_an_input_may_not_do_is_noticed(tmp_path: Path) -> None:
    lines = apart(_NOTICED, json.dumps({case: source for case, (source, _) in _BAD.items()}), folder=tmp_path)
    found: dict[str, list[str]] = dict(json.loads(line) for line in lines.splitlines())
    assert list(found) == list(_BAD)
    for case, (_, says) in _BAD.items():
        assert any(says in fault for fault in found[case]) == bool(says), (case, found[case])
    assert list(tmp_path.iterdir()) == []


def test_an_input_is_the_same_whenever_it_is_made() -> None:
    for target in TARGETS.values():
        first, second = target.case(7), target.case(7)
        assert repr(first) == repr(second) or isinstance(first, Random)


def test_the_shares_are_a_thousand() -> None:
    assert sum(target.share for target in TARGETS.values()) == 1000


def test_a_tally_adds_up() -> None:
    """The slowest and the largest of several processes are kept with their inputs."""
    whole = Tally()
    for seconds, megabytes, text in ((1.0, 5.0, "a"), (3.0, 2.0, "b"), (2.0, 9.0, "c")):
        part = Tally(
            inputs=2, seconds=seconds, slowest=seconds, slowest_input=text, megabytes=megabytes, largest_input=text
        )
        part.became["read"] += 2
        whole.add(part)
    assert (whole.inputs, whole.slowest_input, whole.largest_input, whole.became["read"]) == (6, "b", "c", 6)
