"""What a fresh process makes of pickled results: it reads them back, which checks their claims, and says what it sees."""

from __future__ import annotations

import pickle
import subprocess
import sys
from typing import TYPE_CHECKING, Any, TypeVar

from symobs.exact import Matrix, Scalar, derivative
from tests.support.paths import ROOT

if TYPE_CHECKING:
    from collections.abc import Hashable, Mapping

Name = TypeVar("Name", bound="Hashable")
#: What is asked of a result in both processes.
Account = dict[str, Any]


def account_of(result: Any) -> Account:
    """Return what a result says of itself, and how its values move."""
    values = [value for value in result.answer.values() if isinstance(value, Matrix | Scalar)]
    return {
        "json": result.to("json"),
        "text": result.to("text"),
        "cases": [case.when for case in result.case_tree],
        "answer": dict(result.answer),
        "values": values,
        "derivatives": [derivative(value) for value in values],
    }


def read_in_another_process(results: Mapping[Name, Any]) -> dict[Name, Account]:
    """Return the accounts that a fresh interpreter gives of pickled results; it has seen no plant and no generator."""
    run = subprocess.run(
        [sys.executable, "-m", __name__],
        cwd=ROOT,
        input=pickle.dumps(dict(results)),
        check=False,
        capture_output=True,
    )
    assert run.returncode == 0, run.stderr.decode()
    accounts: dict[Name, Account] = pickle.loads(run.stdout)  # noqa: S301 - our own bytes
    return accounts


if __name__ == "__main__":
    given = pickle.load(sys.stdin.buffer)  # noqa: S301 - our own bytes
    sys.stdout.buffer.write(pickle.dumps({name: account_of(result) for name, result in given.items()}))
