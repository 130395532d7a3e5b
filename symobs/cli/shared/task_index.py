"""Index of tasks and formats, read from the sources without importing them.

The registry of `method` is what counts; this says the same of it, faster.
"""

from __future__ import annotations

import re
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterator

_HERE = Path(__file__).parents[2]
#: A task as it stands in its module: the decorator, the name, and the first line of the docstring.
_TASK = re.compile(
    r'^@task(?:_in_time)?\n(?:@poles_of\([^\n]*\)\n)?def (\w+)\(.*?\) -> \w+:\n    """(.*?)(?:"""|\n)',
    re.MULTILINE | re.DOTALL,
)
_FORMAT = re.compile(r'name: ClassVar\[str\] = "(\w+)"\n    suffix: ClassVar\[str\] = "(\.\w+)"')


def task_summaries(packages: tuple[str, ...]) -> dict[str, str]:
    """Return the tasks of some packages of symobs with their summaries."""
    found: dict[str, str] = {}
    for package in packages:
        for source in _sources(package, "\n@task"):
            found |= dict(_TASK.findall(source))
    return dict(sorted(found.items()))


def format_suffixes(package: str) -> dict[str, str]:
    """Return the output formats of a package of symobs with the suffixes of their files."""
    found = [pair for source in _sources(package, "\n@output_format") for pair in _FORMAT.findall(source)]
    return dict(sorted(found))


def _sources(package: str, mark: str) -> Iterator[str]:
    """Yield the sources of a package that contain a mark."""
    for path in _HERE.joinpath(*package.split(".")[1:]).rglob("*.py"):
        source = path.read_text("utf-8")
        if mark in source:
            yield source
