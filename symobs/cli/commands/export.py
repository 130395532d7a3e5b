"""The command `export`: problems as questions of a learning platform."""

from __future__ import annotations

from fractions import Fraction
from pathlib import Path
from typing import TYPE_CHECKING

import click

from symobs.applications.export import FOLDERS, PLATFORMS, exercises, export
from symobs.cli.shared.common import run_work
from symobs.cli.shared.options import LIMITS, options, quoted
from symobs.cli.shared.outcome import Outcome
from symobs.cli.shared.output import check_target
from symobs.ground.errors import UsageError

if TYPE_CHECKING:
    from symobs.cli.shared.time_and_memory import Progress


@click.command("export")
@click.argument("sources", nargs=-1, metavar="SOURCE...")
@click.option("--to", "platform", required=True, metavar="NAME", help=f"The platform: {', '.join(PLATFORMS)}.")
@click.option("-o", "target", required=True, metavar="PATH", help=f"Write to PATH, a folder for {', '.join(FOLDERS)}.")
@click.option("--asked", multiple=True, metavar="PART", help="Ask for task.field; may be given several times.")
@click.option("--points", metavar="N", help="The marks of an answer that is right.")
@options(*LIMITS)
def command(
    sources: tuple[str, ...],
    platform: str,
    target: str,
    asked: tuple[str, ...],
    points: str | None,
    timeout: float | None,
    memory: float | None,
) -> None:
    """Export problems as questions of a learning platform, which accept what `symobs check` accepts.

    SOURCE is a problem file, or a folder of them; variants become one question. A question that the platform cannot hold
    as it is ends the command with exit code 3, and nothing is written.
    """
    if not sources:
        raise UsageError(
            "no problem file is named", repair="write for example `symobs export a.toml --to stack -o a.xml`"
        )
    if platform not in PLATFORMS:
        question = "did you mean ipynb? " if platform == "nbgrader" else ""
        raise UsageError(
            f"{quoted(platform)} is no platform", where="--to", repair=f"{question}take {', '.join(PLATFORMS)}"
        )
    total = None if points is None else _number(points)
    in_folder = platform in FOLDERS
    if in_folder and Path(target).is_file():
        raise UsageError("this is a file", where="-o", repair=f"name a folder: {platform} takes one")
    if not in_folder:
        check_target(target)

    def work(report_progress: Progress) -> Outcome:
        found = export(platform, exercises(sources, asked, total, report_progress))
        places = {name: Path(target) / name if in_folder else Path(target) for name in found}
        folders = (
            {folder for place in places.values() for folder in _below(place.parent, Path(target))}
            if in_folder
            else set()
        )
        outputs = tuple((content, str(places[name])) for name, content in found.items())
        return Outcome(outputs, folders=tuple(sorted(folders, key=lambda folder: len(folder.parts))))

    run_work(work, timeout, memory, "SOURCE")


def _below(folder: Path, top: Path) -> list[Path]:
    """Return a folder and those above it, up to the one that was named."""
    return [each for each in (folder, *folder.parents) if each == top or top in each.parents]


def _number(text: str) -> Fraction:
    try:
        number = Fraction(text)
    except (ValueError, ZeroDivisionError):
        number = Fraction(0)
    if number <= 0:
        raise UsageError(
            f"{quoted(text)} is no number of marks", where="--points", repair="write for example --points 10"
        )
    return number
