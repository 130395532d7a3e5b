"""Conventions by name: those of the package, and those of a folder or a file."""

from __future__ import annotations

from pathlib import Path

from symobs.formula.convention.convention import STANDARD, Convention
from symobs.ground.errors import ProblemErrors, UsageError

PROFILES = Path(__file__).parent / "profiles"


#: Short names that stay readable.
ALIASES = {
    "S0": "minusK-minusLC-gramianM",
    "S1": "plusK-plusMC",
    "S2": "minusK-minusLC-estimate-x0",
    "S3": "minusK-minusLC",
    "S4": "plusK-minusHC",
}
_SHOWN = 40


def convention_named(name: str, folder: Path | None = None) -> Convention:
    """Return a convention: one of the package, of a law, `NAME.toml` in `folder`, or the file of a path ending in .toml.

    A law is control law and observer matrix, "u = K x_hat, A + M C"; the first convention of the package that has both
    is taken, with its letters, else one that differs from the standard one in them alone.

    Raises `UsageError` naming those that exist, and `ProblemErrors` with everything that is wrong in a file.
    """
    if name == STANDARD.name:
        return STANDARD
    from symobs.formula.convention.convention_file import is_name, of_file  # noqa: PLC0415 - the standard convention is in no file

    if "=" in name:
        return _of_law(name)
    name = ALIASES.get(name, name)
    if name.endswith(".toml"):
        return of_file(Path(name))
    for place in (PROFILES, folder):
        path = None if place is None or not is_name(name) else place / f"{name}.toml"
        if path is not None and path.is_file():
            return of_file(path)
    beside = f", or write {name}.toml beside the problem file" if is_name(name) else ""
    raise UsageError(f'"{name[:_SHOWN]}" is not a convention', repair=f"use one of {', '.join(conventions())}{beside}")


def _of_law(text: str) -> Convention:
    """Return the convention of a control law and an observer matrix; raises `UsageError`."""
    from symobs.formula.convention.convention_file import read_convention  # noqa: PLC0415 - the standard convention is in no file

    law, _, matrix = text.partition(",")
    try:
        found = read_convention({"name": "own", "feedback": law, "observer": matrix}, "law")
    except ProblemErrors as error:
        reasons = "; ".join(str(each) for each in error.errors)
        message = f'"{text[:_SHOWN]}" is not a control law and an observer matrix: {reasons}'
        raise UsageError(message, repair='write for example "u = K x_hat, A + M C"') from None
    same = (each for each in conventions().values() if _laws(each) == _laws(found))
    return next(same, found)


def _laws(convention: Convention) -> tuple[str, str]:
    """Return the control law and the observer matrix."""
    return convention.law, convention.observer_matrix


def conventions() -> dict[str, Convention]:
    """Return the conventions that come with the package, by name."""
    from symobs.formula.convention.convention_file import of_file  # noqa: PLC0415 - the standard convention is in no file

    return {STANDARD.name: STANDARD} | {path.stem: of_file(path) for path in sorted(PROFILES.glob("*.toml"))}
