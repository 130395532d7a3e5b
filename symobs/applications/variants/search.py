"""Variants: candidates are drawn in their order, tested from cheap to dear, and the first ones that pass are taken.

The i-th variant is the i-th accepted candidate, however many are asked for and whoever does the work.
"""

from __future__ import annotations

import json
from collections import Counter, deque
from fractions import Fraction
from pathlib import Path
from statistics import median
from typing import TYPE_CHECKING, Any, NamedTuple

from symobs.applications.batch.engine import Settings, work, workforce
from symobs.applications.batch.jobs import USUAL_BUDGET, Job, canonical, digest, job, own_convention
from symobs.applications.checking.report import decimal
from symobs.applications.variants.acceptance import (
    Candidate,
    Cheap,
    base_candidate,
    candidate,
    cheap,
    data_key,
    keys_of,
    kind_of,
)
from symobs.applications.variants.constraints import UNLIKE, unlike
from symobs.applications.variants.drawing import LARGEST_SEED, VERSION
from symobs.applications.variants.files import SCHEMA, About, Variant, manifest, write_folder
from symobs.applications.variants.table import Table, read_table
from symobs.formula.expression.source import shown
from symobs.formula.phrases.languages import ENGLISH, language_named
from symobs.ground.errors import CertificateRejected, InputError, OutOfBudget, ProblemErrors, SymobsError, UsageError
from symobs.problem import parse
from symobs.problem.fields import is_integer

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Mapping

    from symobs.applications.batch.engine import Workforce


MOST = 10_000
#: Seconds of work handed over at a time: what is begun beyond the last variant is done for nothing.
_CHUNK = 0.05
#: Where so many times as many candidates as there are data repeat what was drawn, there is nothing else to be drawn.
_REPEATS = 30
_SAME = "the same as another variant"
_OF_ONE_KIND = "the first one is of a rare kind: draw distinct poles, or take another seed"
PROFILES = ("loose", "strict")


class TooFew(SymobsError):
    """There are not so many variants among the candidates that were tried; `facts["rejected"]` says why."""

    exit_code = 4


class Variants:
    """Variants of a problem: iterate over them, or take one by its place."""

    def __init__(
        self,
        text: str,
        count: int,
        seed: int = 0,
        *,
        where: str = "problem",
        folder: Path | None = None,
        profile: str = "loose",
        attempts: int | None = None,
        workers: int | None = None,
        in_process: bool = False,
    ) -> None:
        """Read the table of the file; raises `ProblemErrors` with all that is wrong with it."""
        if not is_integer(count) or not 1 <= count <= MOST:
            raise UsageError(f"{count!r} variants cannot be made", where="count", repair=f"ask for 1 to {MOST}")
        if not is_integer(seed) or not 0 <= seed <= LARGEST_SEED:
            repair = f"take a whole number from 0 to {LARGEST_SEED}"
            raise UsageError(f"{seed!r} is no seed", where="seed", repair=repair)
        if profile not in PROFILES:
            raise UsageError(
                f"{profile[:40]!r} is no profile", where="profile", repair=f"write {' or '.join(PROFILES)}"
            )
        self.table: Table = read_table(text, where)
        self.count, self.seed, self.is_strict = count, seed, profile == "strict"
        self.attempts = attempts or self.table.attempts
        self.problem_hash = digest(canonical(parse(text, where)))
        self.told: Callable[[int, int], None] = lambda _found, _tried: None
        self._convention = own_convention(self.table.base, folder)
        self._who = {"workers": workers, "in_process": in_process}
        self._found: list[Variant] = []
        self._last, self._was_read = -1, False
        self._reasons: list[tuple[int, str]] = []
        self._reference: tuple[Mapping[str, Any], Mapping[str, Any]] | None = None
        self._keys: set[str] = set()
        self._taken: set[str] = set()
        self._refused: dict[str, str] = {}
        self._running: Iterator[Variant] | None = None

    def __len__(self) -> int:
        return self.count

    def __iter__(self) -> Iterator[Variant]:
        """Yield the variants as they are found; raises `TooFew` where there are not so many."""
        for place in range(self.count):
            yield self[place]

    def __getitem__(self, place: int) -> Variant:
        """Return a variant by its place, the first one being 0."""
        if not 0 <= place < self.count:
            raise IndexError(place)
        if self._running is None:
            self._running = self._search()
        while len(self._found) <= place:
            self._found.append(next(self._running))
        return self._found[place]

    @property
    def found(self) -> tuple[Variant, ...]:
        """The variants found so far."""
        return tuple(self._found)

    @property
    def rejected(self) -> dict[str, int]:
        """How many candidates were left out before the last one taken, by the reason."""
        return self._counted(self._last)

    def _counted(self, last: int) -> dict[str, int]:
        counts = Counter(reason for number, reason in self._reasons if number < last)
        return dict(sorted(counts.items(), key=lambda item: (-item[1], item[0])))

    @property
    def manifest(self) -> dict[str, Any]:
        """What was made, as JSON: all data and answers, so that old variants depend on no program."""
        return manifest(self._about, list(self))

    @property
    def _about(self) -> About:
        return About(self.problem_hash, self.seed, self.rejected)

    def write(self, folder: str | Path, *, report: bool = False) -> None:
        """Write what was found so far: problem files and the manifest, all of them or none."""
        write_folder(Path(folder), self._about, self.found, report=report)

    # -- the search ---------------------------------------------------------------------------------------------------

    def _search(self) -> Iterator[Variant]:
        """Yield the variants.  The first one, or the file's own plant, is what the others have to be like."""
        start = 0
        with workforce(**self._who) as force:  # type: ignore[arg-type]
            if self.table.like == "base":
                self._measure_base(force)
            while len(self._found) < self.count:
                is_first, before = self._reference is None, len(self._found)
                for found, outcome in self._judged(force, start):
                    start = found.number + 1
                    reason = outcome if isinstance(outcome, str) else self._refusal(found, outcome)
                    if reason is not None:
                        self._reasons.append((found.number, reason))
                        self._refused[data_key(found)] = reason
                        continue
                    self._last = found.number
                    yield self._accepted(found, outcome)
                    if is_first or len(self._found) == self.count:
                        break
                else:
                    if len(self._found) == before:
                        raise self._too_few(start)

    def _judged(self, force: Workforce, start: int) -> Iterator[tuple[Candidate, str | dict[str, Any]]]:
        """Yield candidates in their order from `start` on, each with the cheap reason against it or what became of it."""
        waiting: deque[tuple[Candidate, str | None, str]] = deque()
        rows: dict[str, dict[str, Any]] = {}
        ordered: dict[str, str] = {}  # by their data: what is drawn again is not solved again

        def jobs() -> Iterator[Job]:
            number = newest = start
            seen: set[str] = set()
            while number <= self._last + self.attempts and number <= newest + _REPEATS * (len(seen) + 1):
                found = candidate(self.table, self.seed, number)
                if data_key(found) not in seen:
                    seen.add(data_key(found))
                    newest = number
                test, data = cheap(self.table, found, self._reference and self._reference[0]), data_key(found)
                reason = test.reason or (_SAME if data in self._taken else self._refused.get(data))
                order = None if reason or data in ordered else self._job(found, test)
                if order is not None:
                    ordered[data] = order.key
                waiting.append((found, reason, "" if reason else ordered[data]))
                number += 1
                if number % 1000 == 0:
                    self.told(len(self._found), number)
                if order is not None:
                    yield order

        settings = Settings(chunk_seconds=_CHUNK)
        for chunk in work(jobs(), force, settings):
            rows |= {row["key"]: row for row in chunk.rows}
            while waiting and (waiting[0][1] or waiting[0][2] in rows):
                found, reason, key = waiting.popleft()
                self.told(len(self._found), found.number)
                yield found, reason or rows[key]
        for found, reason, key in waiting:
            yield found, reason or rows[key]

    def _job(self, found: Candidate, test: Cheap) -> Job:
        payload = {
            "candidate": found.number,
            "problem": found.data,
            "constraints": self.table.constraints,
            "gains": test.gains,
            **self._convention,
        }
        return job("variant", payload, f"candidate {found.number}")

    def _refusal(self, found: Candidate, row: Mapping[str, Any]) -> str | None:
        """Return why a solved candidate is no variant, None where it is one."""
        match row["status"]:
            case "undecided":
                message = f"candidate {found.number} takes more than {USUAL_BUDGET.seconds:g} seconds"
                raise OutOfBudget(message, repair="draw smaller ones: a slow one would not be the same elsewhere")
            case "failed":
                error = "; ".join(row["error"])[:500]
                raise CertificateRejected(f"candidate {found.number} of seed {self.seed}: {error}")
            case "unreadable":
                if not self._was_read:  # what the first one has, all have
                    raise ProblemErrors(tuple(InputError(line) for line in row["error"]))
                return "it cannot be read"
        self._was_read, result = True, row["result"]
        _raise_unknown(result)
        if result["reason"] is not None:
            return str(result["reason"])
        if self._reference is not None:
            load = self.table.load / 2 if self.is_strict else self.table.load
            difference = unlike(result["profile"], self._reference[1], load, same_peak=self.is_strict)
            if difference is not None:
                return difference
        return _SAME if keys_of(found, _values(result["answers"]), self.table.distinct) & self._keys else None

    def _accepted(self, found: Candidate, row: Any) -> Variant:
        """Return the variant that a candidate has become."""
        result = row["result"]
        self._keys |= keys_of(found, _values(result["answers"]), self.table.distinct)
        self._taken.add(data_key(found))
        if self._reference is None:
            self._reference = kind_of(found), result["profile"]
        index = len(self._found) + 1
        phrases = language_named(found.data.get("language", ENGLISH.code)).phrases
        own_title = str(found.data.get("title", ""))
        title = phrases["variant_of" if own_title else "variant"].format(title=own_title, number=index)
        data = {**found.data, "title": title[:1].upper() + title[1:]}
        own = {key: value for key, value in data.items() if key != "expect"}
        told = (result["answers"], result["profile"], result["expect"])
        return Variant(index, data_key(found)[:12], found.number, own, *told, own_title)

    def _measure_base(self, force: Workforce) -> None:
        """Take the profile of the file's own plant as the one to be like; no variant is the same as it."""
        base = base_candidate(self.table)
        order = self._job(base, Cheap())
        (chunk,) = work(iter([order]), force, Settings())
        row = chunk.rows[0]
        if row["status"] == "done":
            _raise_unknown(row["result"])
        if row["status"] != "done" or "profile" not in row["result"]:
            lines = row.get("error") or [row["result"]["reason"]]
            raise ProblemErrors(tuple(InputError(line, where="the file's own plant") for line in lines))
        self._reference = kind_of(base), row["result"]["profile"]
        self._keys |= keys_of(base, _values(row["result"]["answers"]), self.table.distinct)
        self._taken.add(data_key(base))

    def _too_few(self, tried: int) -> TooFew:
        counts = self._counted(tried)
        most, often = next(iter(counts.items()), ("", 0))
        message = f"{len(self._found)} of {self.count} variants were found among {tried} candidates"
        share = 100 * often / max(1, sum(counts.values()))
        mend = _OF_ONE_KIND if most == UNLIKE else "widen that, or draw from more"
        repair = f"most often ({share:.0f} %): {most}; {mend}"
        return TooFew(message, where="variants", repair=repair, rejected=counts)


def _values(answers: list[Any]) -> list[Any]:
    """Return what answers say: no method or certificate makes two of them differ."""
    return [{key: each[key] for key in each if key not in {"method", "certificates"}} for each in answers]


def _raise_unknown(result: Mapping[str, Any]) -> None:
    """Raise `ProblemErrors` where the constraints name what no candidate has."""
    found = result.get("unknown", ())
    if found:
        raise ProblemErrors(tuple(InputError(message, where=where, repair=repair) for where, message, repair in found))


# What the answers of a class say of variants: whether one of them was harder, or easier, than the others.


SUMMARY_SCHEMA = "symobs-check-summary/1"
#: A mean that is off by more standard errors than these is no accident.
ERRORS = 3
#: So many marks more than variants are needed for the spread of the marks to be known.
FEWEST = 10


class AnsweredVariant(NamedTuple):
    """How a variant was answered: how many have marks, their mean, and how it stands to the others: easier, harder or same."""

    name: str
    students: int
    mean: Fraction
    compared: str = "same"


def responses_of(text: str, where: str) -> tuple[AnsweredVariant, ...]:
    """Return how each variant of a class was answered, from the `summary.json` of `symobs check`.

    A variant with n marks of mean m, N being those of the others, M the median of all means and s² the variance of marks within
    variants, is off where (m − M)² > 9 s² (1/n + 1/N), which fractions decide.  Raises `InputError` where the text is no such
    summary or its marks are too few.
    """
    found = _read(text, where)
    students = sum(count for count, _, _ in found.values())
    if len(found) < 2 or students - len(found) < FEWEST:
        message = f"{students} marks of {len(found)} variants are too few to compare"
        raise InputError(message, where=where, repair=f"{FEWEST} marks more than variants are needed, and two variants")
    usual = median(mean for _, mean, _ in found.values())
    variance = sum((squares for _, _, squares in found.values()), Fraction(0)) / (students - len(found))
    listed = []
    for name, (count, mean, _) in found.items():
        bound = ERRORS**2 * variance * (Fraction(1, count) + Fraction(1, students - count))
        word = "easier" if mean > usual else "harder"
        listed.append(AnsweredVariant(name, count, mean, word if (mean - usual) ** 2 > bound else "same"))
    return tuple(listed)


def _read(text: str, where: str) -> dict[str, tuple[int, Fraction, Fraction]]:
    """Return of each variant its marks: how many, their mean, and the sum of the squared differences from it."""
    found: dict[str, tuple[int, Fraction, Fraction]] = {}
    try:
        data = json.loads(text)
        found = {
            shown(str(name), 40): (int(each["students"]), Fraction(each["mean"]), Fraction(each["squares"]))
            for name, each in data["variants"].items()
        }
        usable = data["schema"] == SUMMARY_SCHEMA and all(count > 0 for count, _, _ in found.values())
    except (ValueError, RecursionError, LookupError, TypeError, AttributeError, ZeroDivisionError):
        usable = False
    if not usable:
        repair = "name the summary.json that `symobs check --submissions ... --variants ...` wrote"
        raise InputError("this is no summary of a class", where=where, repair=repair)
    return found


def as_text(listed: tuple[AnsweredVariant, ...]) -> str:
    """Return the table: a line a variant."""
    width = max(len(each.name) for each in listed)
    off = [each for each in listed if each.compared != "same"]
    lines = [
        f"{each.name:<{width}}  {each.students:4} students  {decimal(each.mean):>8} marks"
        + (f"  {each.compared} than the others" if each in off else "")
        for each in listed
    ]
    said = f"{len(off)} of {len(listed)} variants" if off else "no variant"
    verb = "differ" if len(off) > 1 else "differs"
    return "\n".join([*lines, f"{said} {verb} from the others by more than {ERRORS} standard errors", ""])


# The JSON schema of the manifest of variants.


_TEXT: dict[str, Any] = {"type": "string"}
_COUNT: dict[str, Any] = {"type": "integer", "minimum": 0}
_ANY: dict[str, Any] = {"type": "object"}


def _table(**properties: Any) -> dict[str, Any]:
    return {
        "type": "object",
        "properties": properties,
        "required": list(properties),
        "additionalProperties": False,
    }


def schema() -> dict[str, Any]:
    """Return the JSON schema of the manifest that `symobs variants` writes."""
    variant = _table(
        id={"type": "string", "pattern": "^[0-9a-f]{12}$"},
        file={"type": "string", "pattern": "^variants/v[0-9]{3,}[.]toml$"},
        candidate=_COUNT,
        data=_ANY,
        answers=_ANY,
        profile=_table(load=_COUNT, peak=_COUNT, fractions=_COUNT, lines=_COUNT),
        certificates=_COUNT,
    )
    whole = _table(
        schema={"const": SCHEMA},
        engine=_TEXT,
        problem={"type": "string", "pattern": "^[0-9a-f]{64}$"},
        version={"const": VERSION},
        seed={"type": "integer", "minimum": 0, "maximum": LARGEST_SEED},
        count=_COUNT,
        variants={"type": "array", "items": variant},
        rejected={"type": "object", "additionalProperties": _COUNT},
    )
    return {"$schema": "https://json-schema.org/draft/2020-12/schema", "title": "symobs variants", **whole}
