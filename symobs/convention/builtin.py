"""Conventions by name: those of the package, and those of a folder or a file."""

from __future__ import annotations

from pathlib import Path

from symobs.convention.convention import STANDARD, Convention
from symobs.errors import UsageError

PROFILES = Path(__file__).parent / "profiles"


_SHOWN = 40


def convention_named(name: str, folder: Path | None = None) -> Convention:
    """Return a convention: one of the package, `NAME.toml` in `folder`, or the file of a path ending in .toml.

    Raises `UsageError` naming those that exist, and `ProblemErrors` with everything that is wrong in a file.
    """
    if name == STANDARD.name:
        return STANDARD
    from symobs.convention.convention_file import is_name, of_file  # noqa: PLC0415 - the standard convention is in no file

    if name.endswith(".toml"):
        return of_file(Path(name))
    for place in (PROFILES, folder):
        path = None if place is None or not is_name(name) else place / f"{name}.toml"
        if path is not None and path.is_file():
            return of_file(path)
    beside = f", or write {name}.toml beside the problem file" if is_name(name) else ""
    raise UsageError(f'"{name[:_SHOWN]}" is not a convention', repair=f"use one of {', '.join(conventions())}{beside}")


def conventions() -> dict[str, Convention]:
    """Return the conventions that come with the package, by name."""
    from symobs.convention.convention_file import of_file  # noqa: PLC0415 - the standard convention is in no file

    return {STANDARD.name: STANDARD} | {path.stem: of_file(path) for path in sorted(PROFILES.glob("*.toml"))}
