"""Which tasks there are, read from the sources without importing them: a list of names costs no kernel.

The registry of `method` is what counts; this says the same of it, faster.
"""

from __future__ import annotations

import re
from pathlib import Path

_HERE = Path(__file__).parent
#: A task as it stands in its module: the decorator, the name, and the first line of the docstring.
_TASK = re.compile(r'^@task(?:_in_time)?\ndef (\w+)\(.*?\) -> \w+:\n    """(.*?)(?:"""|\n)', re.MULTILINE | re.DOTALL)


def task_summaries(packages: tuple[str, ...]) -> dict[str, str]:
    """Return the tasks of some packages of symobs with what each does, in a line."""
    found: dict[str, str] = {}
    for package in packages:
        for path in _HERE.joinpath(*package.split(".")[1:]).glob("*.py"):
            source = path.read_text(encoding="utf-8")
            if "\n@task" in source:
                found |= dict(_TASK.findall(source))
    return dict(sorted(found.items()))
