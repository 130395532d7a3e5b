"""The command `examples`: the worked examples that are installed with the package."""

from __future__ import annotations

import tomllib
from pathlib import Path

import click

from symobs.cli.shared.options import AFile, OneOf, quoted
from symobs.cli.shared.output import copied, write
from symobs.ground.errors import UsageError

_PACKAGE = Path(__file__).parents[2]


def _examples() -> dict[str, Path]:
    """Return the worked examples by name: inside an installed package, beside it in a checkout."""
    inside = _PACKAGE / "worked_examples"
    folder = inside if inside.is_dir() else _PACKAGE.parent / "worked_examples"
    return {path.stem: path for path in sorted(folder.glob("*.toml"))}


@click.command("examples")
@click.argument("name", required=False, type=OneOf(_examples))
@click.option(
    "--copy", "folder", type=AFile("dir"), metavar="FOLDER", help="Copy the one called NAME, or all, to FOLDER."
)
def command(name: str | None, folder: str | None) -> None:
    """List the worked examples, or print the one called NAME."""
    known = _examples()
    chosen = None if name is None else name.removesuffix(".toml")
    if chosen is not None and chosen not in known:
        like = [found for found in known if chosen in found][:5]
        repair = f"did you mean {' or '.join(like)}?" if like else "`symobs examples` lists them"
        raise UsageError(f"there is no worked example {quoted(name or '')}", repair=repair)
    if folder is not None:
        copied([known[chosen]] if chosen else list(known.values()), folder)
    elif chosen is not None:
        write(known[chosen].read_text("utf-8"))
    else:
        width = max(map(len, known), default=0)
        write("".join(f"{found.ljust(width)}  {_title(path)}\n" for found, path in known.items()))


def _title(path: Path) -> str:
    return str(tomllib.loads(path.read_text("utf-8")).get("title", ""))
