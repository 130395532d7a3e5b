"""Answers judged with their parameters in place, by a system that is told terms and asked whether they vanish."""

from __future__ import annotations

import re
from dataclasses import dataclass
from fractions import Fraction
from typing import TYPE_CHECKING

from tests.programs.campaign.asked import Untold
from tests.programs.campaign.claims import claims
from tests.programs.campaign.points import NotRational, texts_at
from tests.programs.campaign.running import System, answers
from tests.programs.campaign.writing import Language, Sheet, Unsupported

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from tests.programs.campaign.algebra import Claim
    from tests.programs.campaign.asked import Asked, Difference, Tables

#: Tasks whose claims are not identities.
NOT_SYMBOLIC = {"stability_region", "initial_state", "initial_state_covariance"}
_PRIMES = (101, 137, 173, 211, 251, 293, 331, 373)


@dataclass(frozen=True)
class Judge:
    """A system, its language, the condition under which it confirms a claim, and how a question is put."""

    system: System
    language: Language
    condition: Callable[[Claim, list[str], str], str]
    question: Callable[[Sequence[tuple[list[str], str, int]]], str]
    seconds: float = 30

    def differences(self, batch: Sequence[Asked]) -> list[Difference]:
        """Judge a batch in one process; a system that disagrees is asked again with numbers in place of the parameters.

        Normal forms of several variables have errors of their own: giac 1.9 adds some fractions wrongly.
        """
        judged = self._judged([(asked.problem, _in_general(asked)) for asked in batch])
        doubtful = [k for k, said in enumerate(judged) if isinstance(said, str) and batch[k].problem["symbols"]]
        again = self._judged([_at_numbers(batch[k]) for k in doubtful]) if doubtful else []
        for k, said in zip(doubtful, again, strict=True):
            if said is None:
                judged[k] = Untold(f"not equal in its normal form, equal in numbers: {judged[k]}")
        return judged

    def _judged(self, batch: Sequence[tuple[Tables, Tables]]) -> list[Difference]:
        judged: list[Difference] = [Untold("nothing it claims can be asked here")] * len(batch)
        posed: list[tuple[int, list[Claim], str]] = []
        for index, (problem, answer) in enumerate(batch):
            try:
                found = claims(problem, answer)
            except NotRational:
                continue
            except (KeyError, TypeError, ValueError, AssertionError) as error:
                judged[index] = Untold(f"the answer cannot be read: {error!r}")
                continue
            program = self._program(found, "z" if problem["plant"].get("dt") else "s")
            if program:
                posed.append((index, found, program))
        replies = answers(self.system, [program for *_, program in posed], self.seconds)
        for (index, found, _), reply in zip(posed, replies, strict=True):
            judged[index] = _read(found, reply)
        return judged

    def _program(self, found: Sequence[Claim], variable: str) -> str:
        sheet = Sheet(self.language)
        tests: list[tuple[list[str], str, int]] = []
        for k, claim in enumerate(found):
            try:
                parts = [sheet.write(term) for term in claim.terms]
                tests.append((list(sheet.lines), self.condition(claim, parts, variable), k))
            except Unsupported:
                continue
            sheet.lines.clear()
        return self.question(tests) if any(found[k].kind not in {"is", "never"} for _, _, k in tests) else ""


def _in_general(asked: Asked) -> Tables:
    """Return the answer for parameters in general position."""
    return asked.answer | ({"verdict": "yes"} if asked.verdict == "conditional" else {})


def _at_numbers(asked: Asked) -> tuple[Tables, Tables]:
    """Return problem and answer for numbers that are in general position."""
    signs = {name: -1 if sign in {"negative", "nonpositive"} else 1 for name, sign in asked.problem["symbols"].items()}
    point = {name: Fraction(sign * prime, 7) for (name, sign), prime in zip(signs.items(), _PRIMES, strict=False)}
    return {**texts_at(asked.problem, point), "parameters": point}, texts_at(_in_general(asked), point)


def _read(found: Sequence[Claim], reply: str | None) -> Difference:
    if reply is None:
        return Untold("no answer")
    if reply == "[]":
        return None
    numbers = re.findall(r"\d+", reply)
    if not re.fullmatch(r"\[[\d,]*\]", reply):
        return Untold(reply[:80])
    return ", ".join(found[int(k)].name for k in numbers)
