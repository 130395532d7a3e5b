"""Many problems of the same kind from one file: drawn, solved, checked, and alike in what they take to work out."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from symobs.applications.variants.files import Variant
from symobs.applications.variants.search import TooFew, Variants
from symobs.formula.phrases.languages import ENGLISH, language_named
from symobs.ground.errors import InputError, UsageError, reason_of

__all__ = ["TooFew", "Variant", "Variants", "variant_of", "variants"]


def variants(problem: str | Path, count: int, seed: int = 0, *, workers: int | None = None) -> Variants:
    """Return variants of a problem file with a table `[variants]`: plants, poles and numbers of their own, alike in load.

    problem  a problem file: its path, or its text
    count    how many; the first ten of thirty are the ten of ten
    seed     a whole number from 0 to 2⁶³ − 1; the same seed gives the same variants on every machine
    workers  how many processes of this machine do the work; as many as it has processors
    The value is worked out as it is iterated over; `manifest`, `rejected` and `write(folder)` need all of it.
    Raises `ProblemErrors` for a file that cannot be used, and `TooFew` (exit code 4) where there are not so many.
    """
    if isinstance(problem, str) and ("\n" in problem or problem.lstrip().startswith("{")):
        return Variants(problem, count, seed, workers=workers)
    if not isinstance(problem, (str, Path)):
        message = f"a problem file is expected, but a value of type {type(problem).__name__} came"  # type: ignore[unreachable]  # of Python without types
        raise UsageError(message, where="problem", repair="give the path of a problem file, or its text")
    path = Path(problem)
    try:
        text = path.read_text(encoding="utf-8-sig")
    except (OSError, ValueError) as error:
        repair = "give the path of a problem file, or its text"
        raise InputError(reason_of(error), where=str(path)[:200], repair=repair) from None
    return Variants(text, count, seed, where=str(path), folder=path.parent, workers=workers)


def variant_of(text: str, where: str, number: int) -> dict[str, Any]:
    """Return the tables of the variant of this number, of seed 0; its text says so."""
    found = Variants(text, number, where=where, folder=Path(where).parent, in_process=True)[number - 1]
    said = language_named(found.data.get("language", ENGLISH.code)).phrases["variant_of_seed"].format(number=number)
    return {**found.data, "text": f"{found.data['text']} {said}" if found.data.get("text") else said}
