"""Running the command line as a user does: within the process of the test, or in a fresh one with bounded memory."""

from __future__ import annotations

import os
import subprocess
import sys
from io import BytesIO, TextIOWrapper
from typing import TYPE_CHECKING, NamedTuple

import pytest

from symobs.cli import main
from tests.support import examples
from tests.support.paths import COMPILED, ROOT

if TYPE_CHECKING:
    from pathlib import Path

EXAMPLES = examples.EXAMPLES
SERVO = ROOT / "worked_examples" / "output_feedback_servo.toml"
SAFETY = 300  # seconds; ends a run that hangs, measures nothing
MEGABYTES = 1024  # of addresses, libraries included; the run of a worked example takes about a third of it
_BOUNDED = f"""
import resource, runpy, sys
resource.setrlimit(resource.RLIMIT_AS, ({MEGABYTES} << 20, {MEGABYTES} << 20))
sys.argv[0] = "symobs"
runpy.run_module("symobs", run_name="__main__", alter_sys=True)
"""


class Run(NamedTuple):
    """What a run left behind."""

    code: int
    out: str
    err: str

    @property
    def lines(self) -> list[str]:
        """The lines of standard error."""
        return self.err.splitlines()


def environment(checkout: Path = ROOT) -> dict[str, str]:
    """The environment in which `python -m symobs` is the symobs of a checkout, in every folder."""
    compiled = str(checkout / COMPILED)
    return {**os.environ, "PYTHONPATH": str(checkout), "PYTHONPYCACHEPREFIX": compiled, "XDG_STATE_HOME": os.devnull}


def fresh(*arguments: str, folder: Path, checkout: Path = ROOT, stdin: bytes = b"") -> Run:
    """Run symobs in a process of its own, in `folder`."""
    run = subprocess.run(
        [sys.executable, "-c", _BOUNDED, *arguments],
        cwd=folder,
        env=environment(checkout),
        input=stdin,
        capture_output=True,
        timeout=SAFETY,
        check=False,
    )
    return Run(run.returncode, run.stdout.decode(), run.stderr.decode())


def inside(*arguments: str, folder: Path = ROOT, stdin: bytes = b"") -> Run:
    """Run symobs in this process, in `folder`."""
    out, err = BytesIO(), BytesIO()
    with pytest.MonkeyPatch.context() as patch:
        patch.chdir(folder)
        patch.setattr(sys, "argv", ["symobs", *arguments])
        patch.setattr(sys, "stdin", TextIOWrapper(BytesIO(stdin), encoding="utf-8"))
        patch.setattr(sys, "stdout", TextIOWrapper(out, encoding="utf-8", write_through=True))
        patch.setattr(sys, "stderr", TextIOWrapper(err, encoding="utf-8", write_through=True))
        with pytest.raises(SystemExit) as left:
            main()
        code, written = left.value.code, Run(0, out.getvalue().decode(), err.getvalue().decode())
    assert isinstance(code, int)
    return written._replace(code=code)
