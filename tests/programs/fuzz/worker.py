"""One process that runs inputs of one target, in order, and tells what became of them."""

from __future__ import annotations

import faulthandler
import os
import signal
import sys
import tempfile
import traceback
from collections import Counter
from dataclasses import dataclass, field
from pathlib import Path
from random import Random
from typing import TYPE_CHECKING, Any

from symobs.ground.errors import SymobsError
from tests.programs.fuzz import targets
from tests.programs.fuzz.watch import Trespass, Watch, memory, processor_time
from tests.support.paths import ROOT

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

    from tests.programs.fuzz.targets import Target

MEGABYTE = 1 << 20
#: After so many seconds of the clock an input hangs: a call into C is not interrupted, the process is ended.
HANGS = 120.0
_SHOWN = 1_000


@dataclass
class Tally:
    """What became of the inputs so far."""

    inputs: int = 0
    became: Counter[str] = field(default_factory=Counter)
    seconds: float = 0.0
    slowest: float = 0.0
    slowest_input: str = ""
    megabytes: float = 0.0
    largest_input: str = ""
    faults: list[str] = field(default_factory=list)

    def add(self, other: Tally) -> None:
        """Add what became of further inputs."""
        self.inputs += other.inputs
        self.became += other.became
        self.seconds += other.seconds
        if other.slowest > self.slowest:
            self.slowest, self.slowest_input = other.slowest, other.slowest_input
        if other.megabytes > self.megabytes:
            self.megabytes, self.largest_input = other.megabytes, other.largest_input
        self.faults += other.faults


def prepared() -> Watch:
    """Return the watch of this process: everything loaded, a folder of its own, the hook in its place."""
    folder = Path(os.path.realpath(tempfile.mkdtemp(prefix="fuzz-")))
    os.chdir(folder)
    targets.begin(folder)
    watch = Watch()
    watch.install()
    return watch


def allow(watch: Watch, target: Target) -> None:
    """Let the watch allow what the target is for: the files of the project, and those a user names."""
    root = str(ROOT)
    watch.works = target.name in {"command_line", "live"}  # both write whole documents, by templates
    watch.reads = ("/",) if target.name == "command_line" else (root, sys.prefix, sys.base_prefix)
    watch.writes = str(targets.FOLDER) if target.writes else ""


def run(target: Target, numbers: Iterable[int], watch: Watch, base: int) -> Tally:
    """Run inputs and return what became of them; `base` is the memory held before the first."""
    allow(watch, target)
    tally = Tally()
    for number in numbers:
        one(target, number, watch, base, tally)
    return tally


def one(target: Target, number: int, watch: Watch, base: int, tally: Tally) -> None:
    """Run one input."""
    case = target.case(number)
    before, start = memory(), processor_time()
    became, fault = outcome(target.run, case, watch)
    took, held = processor_time() - start, memory()
    tally.inputs += 1
    tally.became[became] += 1
    tally.seconds += took
    if took > tally.slowest:
        tally.slowest, tally.slowest_input = took, shown(case)
    if held > before and (held - base) / MEGABYTE > tally.megabytes:
        tally.megabytes, tally.largest_input = (held - base) / MEGABYTE, shown(case)
    if took > target.seconds:
        fault += f" took {took:.2f} s of the processor"
    if held > before and held - base > target.megabytes * MEGABYTE and held - before > MEGABYTE:
        fault += f" held {(held - base) / MEGABYTE:.0f} MB"
    if fault:
        tally.faults.append(f"{target.name} {number}:{fault}\n    input: {shown(case)}")


def outcome(run: Callable[[Any], str], case: Any, watch: Watch) -> tuple[str, str]:
    """Return in a word what became of an input, and what is wrong about that."""
    try:
        with watch.looks():
            return run(case), ""
    except SymobsError as error:
        return ("refused", "") if error.exit_code != 1 else ("crash", f" {type(error).__name__}: {error}")
    except Trespass as reached:
        return "trespass", f" reached {reached}"
    except Exception as error:  # noqa: BLE001 - whatever it is, it is what is looked for
        where = traceback.extract_tb(error.__traceback__)[-3:]
        places = " < ".join(f"{Path(frame.filename).name}:{frame.lineno}" for frame in reversed(where))
        return "crash", f" {type(error).__name__}: {str(error)[:_SHOWN]} at {places}"


def shown(case: Any) -> str:
    """Return an input, or its beginning."""
    text = "a generator" if isinstance(case, Random) else repr(case)
    return text if len(text) <= _SHOWN else f"{text[:_SHOWN]}… ({len(text)} characters)"


def work(name: str, first: int, last: int, skipped: frozenset[int], place: Any, tell: Any) -> None:
    """Run the inputs `first` … `last` − 1 of a target; `place` holds the number of the one that runs, for who waits.

    An input that hangs ends the process: the alarm is not caught.
    """
    target = targets.TARGETS[name]
    faulthandler.enable()
    watch = prepared()
    allow(watch, target)
    base = memory()
    signal.signal(signal.SIGALRM, signal.SIG_DFL)
    tally = Tally()
    for number in range(first, last):
        if number not in skipped:
            place.value = number
            signal.setitimer(signal.ITIMER_REAL, HANGS)
            one(target, number, watch, base, tally)
        if tally.seconds > 2 or (number + 1 - first) % 1_000 == 0 or number + 1 == last:
            signal.setitimer(signal.ITIMER_REAL, 0)
            tell.send((number + 1, tally))
            tally = Tally()
    tell.close()
