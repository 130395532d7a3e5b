"""Independent systems that judge our answers: every module of `oracles/` is one, found by itself.

An oracle is a module with `NAME`, `COMMAND` (the program it needs on PATH, or None), `covers(problem)`, which tells
whether it can judge answers to a problem, and `differences(batch)`, which judges many at once, so that a program is
started once for hundreds: None agrees, a text is a disagreement in one line, `Untold` tells why it cannot tell.
A module that imports a package which is not installed counts as missing.
"""

from __future__ import annotations

import importlib
import pkgutil
import shutil
from pathlib import Path
from typing import TYPE_CHECKING, Protocol, cast

from tests.programs.campaign.asked import Untold

if TYPE_CHECKING:
    from collections.abc import Sequence

    from tests.programs.campaign.asked import Asked, Difference, Tables

FOLDER = Path(__file__).parent / "oracles"
#: Oracles that compute in doubles, whose rank of a large matrix can be wrong, and the exact one that is asked then.
IN_DOUBLES = {"Octave control", "python-control"}
EXACT = "PARI"


class Oracle(Protocol):
    """What a module of that folder offers."""

    NAME: str
    COMMAND: str | None

    def covers(self, problem: Tables) -> bool:
        """Tell whether answers to this problem can be judged."""

    def differences(self, batch: Sequence[Asked]) -> list[Difference]:
        """Return one judgement for each."""


def found() -> tuple[dict[str, Oracle], dict[str, str]]:
    """Return the oracles that can run here, by name, and why each other one cannot."""
    oracles: dict[str, Oracle] = {}
    missing: dict[str, str] = {}
    for name in sorted(module.name for module in pkgutil.iter_modules([str(FOLDER)])):
        try:
            oracle = cast("Oracle", importlib.import_module(f"tests.programs.campaign.oracles.{name}"))
        except ModuleNotFoundError as error:
            missing[name] = f"{error.name} is not installed"
            continue
        if oracle.COMMAND is not None and shutil.which(oracle.COMMAND) is None:
            missing[oracle.NAME] = f"{oracle.COMMAND} is not on PATH"
        else:
            oracles[oracle.NAME] = oracle
    return oracles, missing


def judged(oracle: Oracle, batch: Sequence[Asked]) -> list[Difference]:
    """Return an oracle's judgements; where one in doubles disagrees and the exact one agrees, rounding misled it."""
    judgements = oracle.differences(batch) if batch else []
    if oracle.NAME not in IN_DOUBLES or not any(isinstance(judgement, str) for judgement in judgements):
        return judgements
    exact = found()[0].get(EXACT)
    disputed = [asked for asked, said in zip(batch, judgements, strict=True) if isinstance(said, str)]
    if exact is None or not all(exact.covers(asked.problem) for asked in disputed):
        return judgements
    second = iter(exact.differences(disputed))
    return [
        Untold(f"{EXACT} agrees where doubles say otherwise")
        if isinstance(said, str) and next(second) is None
        else said
        for said in judgements
    ]
