"""Every task through every door: python -m tests.programs.matrix prints the matrix.

Tasks are found by themselves, and so are their problems: the worked examples, each cut down to one task.  A door is a
function below: it returns nothing where the problem went through, and else what stood in the way.
"""

from __future__ import annotations

import argparse
import json
import re
import sys
import tomllib
import warnings
from dataclasses import replace
from functools import lru_cache, partial
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING, Any

import symobs
from symobs.applications.checking.checker import Checked
from symobs.applications.export import PLATFORMS, exercises, export
from symobs.applications.live.answering import answer as live_answer
from symobs.applications.variants.acceptance import expected
from symobs.applications.variants.parameters import toml_text
from symobs.ground.dataclass import dataclass
from symobs.ground.errors import InputError, SymobsError, SymobsWarning
from symobs.problem.expect import mismatches
from symobs.problem.question import question_of
from symobs.problem.validation import validate
from symobs.tasks.result import tasks
from symobs.tasks.result.writers import formats, render
from tests.support.paths import ROOT

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Mapping, Sequence

#: So many problems of a task, the shortest ones, are looked at.
PROBLEMS = 3


@dataclass(frozen=True)
class Sample:
    """A problem of one task, solved."""

    name: str
    task: str
    data: Mapping[str, Any]
    checked: Checked

    @property
    def result(self) -> Any:
        """The result of the task."""
        return self.checked.results[-1]

    @property
    def problem(self) -> Any:
        """The problem that was read."""
        return self.checked.problem

    @property
    def answers(self) -> dict[str, Any]:
        """Its own answers as a file has them."""
        return dict(expected(self.problem, self.checked.results))


@lru_cache(maxsize=64)
def samples(task: str) -> tuple[Sample, ...]:
    """Return the shortest worked examples of a task."""
    found: list[Sample] = []
    for path in sorted((ROOT / "worked_examples").glob("*.toml"), key=lambda each: (each.stat().st_size, each.name)):
        data = tomllib.loads(path.read_text("utf-8"))
        if task in data.get("tasks", [data.get("task")]) and len(found) < PROBLEMS:
            kept = {
                key: value for key, value in data.items() if key not in {"tasks", "expect", "marking", "convention"}
            }
            known = {*tasks()[task].keywords, "method"}
            kept["specification"] = {
                key: data["specification"][key] for key in data.get("specification", {}) if key in known
            }
            try:
                checked = Checked.of(validate({**kept, "task": task}))
            except SymobsError:  # its specification is that of several tasks
                continue
            found.append(Sample(path.stem, task, {**kept, "task": task}, checked))
    return tuple(found)


# The doors.


def json_of_the_answer(sample: Sample) -> str:
    """JSON names the task, its verdict, and every field that answers it."""
    (found,) = json.loads(sample.result.to_json())["results"]
    missing = [name for name in sample.result.answered_by if name not in found and sample.result.verdict == "yes"]
    return f"no {missing}" if missing or found["task"] != sample.task or not found["verdict"] else ""


def pages(sample: Sample) -> str:
    """The page is there in every format and both languages."""
    document = sample.problem.document(sample.checked.results)
    kinds = [
        name
        for name, kind in formats().items()
        if not hasattr(kind, "is_program") and name not in {"pdf", "csv", "numpy"}
    ]
    for language in ("en", "de"):
        for kind in kinds:
            if not render(replace(document, language=language), kind):
                return f"{kind} is empty"
    return ""


def question(sample: Sample) -> str:
    """No entry of the specification, and none of the plant, can be another without the question being another."""
    text = str(render(question_of(sample.problem), "text"))
    unseen = []
    for place, others in _altered(sample.data):
        said = None
        for other in others:
            try:
                said = str(render(question_of(validate(other)), "text"))
            except SymobsError:
                continue
            break
        if said == text:
            unseen.append(place)
    return f"does not show {', '.join(unseen)}" if unseen else ""


def _altered(data: Mapping[str, Any]) -> Iterator[tuple[str, list[dict[str, Any]]]]:
    """Yield the place of each number of plant and specification, with problems that have another number there."""
    for table in ("plant", "specification"):
        for key, value in data.get(table, {}).items():
            text = json.dumps(value)
            for found in re.finditer(r"(?<![\w.])\d+(?![\w.])", text):
                others = [f"{text[: found.start()]}{number}{text[found.end() :]}" for number in (7, 3, 0, 12)]
                tables = [{**data[table], key: json.loads(each)} for each in others if each != text]
                yield f"{table}.{key}", [{**data, table: each} for each in tables]


def asked_is_marked(sample: Sample) -> str:
    """The question names each part that is marked, and nothing else."""
    if sample.result.verdict == "no":  # there is nothing of what is asked, which is the answer
        return ""
    named = set(question_of(sample.problem).asked[sample.task]) or {"verdict"}
    marked = {name for _, name in sample.checked.asked(sample.checked.views())} - {"conditions"}
    return "" if named == marked else f"asks for {sorted(named)}, marks {sorted(marked)}"


def own_answer(sample: Sample) -> str:
    """The own answer as a text has all marks, and with one entry changed not."""
    answers = sample.answers
    if not answers:
        return "has no answer in a file"
    report = sample.checked.report({"answer": answers})
    if report.verdict != "right":
        return f"its own answer is {report.verdict}"
    if (
        sample.checked.report("\n".join(f"{name} = {_line(value)}" for name, value in answers.items())).verdict
        != "right"
    ):
        return "its own answer as lines is not right"
    for name, value in answers.items():
        report = sample.checked.report({"answer": {**answers, name: _other(value)}})
        if report.verdict == "right":
            return f"another {name} is right"
    return ""


def _line(value: Any) -> str:
    if isinstance(value, dict):
        return ", ".join(f"{key}: {each}" for key, each in value.items())
    return ", ".join(map(str, value)) if isinstance(value, list) else str(value)


def _other(value: Any) -> Any:
    """Return another value of the same kind."""
    if isinstance(value, bool):
        return not value
    if isinstance(value, int):
        return value + 1
    if isinstance(value, list):
        return [_other(value[0]), *value[1:]] if value else ["1"]
    if isinstance(value, dict):
        key = next(iter(value))
        return {**value, key: _other(value[key])}
    words = {"yes": "no", "no": "yes", "conditional": "no"}
    if value in words:
        return words[value]
    if re.search("[<>]|!=", value):
        return value.replace("<", "#").replace(">", "<").replace("#", ">")
    if value.startswith("["):
        end = re.search(r"[\s;\]]", value[1:])
        assert end is not None
        return f"[{value[1 : end.start() + 1]}+1{value[end.start() + 1 :]}"
    return f"{value} + 1"


def expectation(sample: Sample) -> str:
    """The own answers are met in [expect], another one is not."""
    answers = sample.answers
    views = sample.problem.viewed(sample.checked.results)
    if not answers or mismatches(views, answers):
        return "its own answer is not met"
    for name, value in answers.items():
        if not mismatches(views, {**answers, name: _other(value)}):
            return f"another {name} is met"
    return ""


def lines(sample: Sample) -> str:
    """A defining equation is true as a line, and with a sign changed it is not."""
    for text in (each.claim.rpartition(": ")[2] for each in sample.result.certificates):
        if "=" in text and not re.search(r"[<>:]|!=", text):
            whole = sample.checked.report({"answer": sample.answers, "step": [{"relation": text}]})
            if not whole.lines or whole.lines[0].verdict != "true":
                continue
            left, _, right = text.partition("=")
            changed = f"{left} = -({right})"
            bent = sample.checked.report({"answer": sample.answers, "step": [{"relation": changed}]})
            if bent.lines[0].verdict == "false":
                return ""
    return "no defining equation is a true line"


def exported(sample: Sample) -> str:
    """The question goes to some platform, and the others refuse it with their reason."""
    refused = []
    with TemporaryDirectory() as folder:
        path = Path(folder) / "problem.toml"
        path.write_text(toml_text(sample.data), "utf-8")
        for platform in PLATFORMS:
            try:
                if not export(platform, exercises([str(path)])):
                    return f"{platform}: nothing"
            except InputError as error:
                refused.append(f"{platform}: {error}")
    return refused[0] if len(refused) == len(PLATFORMS) else ""


def variants(sample: Sample) -> str:
    """A number of the plant or of the specification varies."""
    why = "no number to vary"
    for where, key in [(w, key) for w in ("plant", "specification") for key in sample.data.get(w, {})]:
        text = str(sample.data[where][key])
        for found in re.finditer(r"(?<![\w.^/])\d+(?![\w.])", text):
            changed = {**sample.data[where], key: f"{text[: found.start()]}v{text[found.end() :]}"}
            varied = {"parameters": {"v": {"set": [str(number) for number in range(1, 10)]}}}
            try:
                made = list(
                    symobs.variants(toml_text({**sample.data, where: changed, "variants": varied}), 2, workers=1)
                )
                if made[0] != made[1]:
                    return ""
            except SymobsError as error:
                why = str(error)
    return why


def values(sample: Sample) -> str:
    """With a letter for a number of the plant, `at`, `evaluate` and `sweep` give back what was."""
    for key, text in sample.data.get("plant", {}).items():
        for found in re.finditer(r"(?<![\w.^/])\d+(?![\w.])", str(text)):
            if key not in {"A", "B", "C"} or int(found[0]) == 0:
                continue
            changed = {**sample.data["plant"], key: f"{text[: found.start()]}v{text[found.end() :]}"}
            symbols = {**sample.data.get("symbols", {}), "v": "positive"}
            data = {**sample.data, "plant": changed, "symbols": symbols}
            problem = validate(data)
            (result,) = problem.solve()
            there = result.at(v=int(found[0]))
            if json.loads(there.to_json())["results"][0]["verdict"] != sample.result.verdict:
                return "another verdict there"
            evaluated = result.evaluate({"v": [float(found[0]), float(found[0]) + 1]})
            if not evaluated and sample.result.decimals:
                return "evaluate is empty"
            return ""
    return "no number to vary"


def programs(sample: Sample) -> str:
    """There is a program in every language, or what answers the task is there as numbers of programs."""
    given = {} if sample.result.plant.is_discrete else {"period": "1/100"}
    try:
        return "" if all(sample.result.to(kind, **given) for kind in ("python", "matlab", "c", "modelica")) else "empty"
    except SymobsError as error:
        why = str(error)
    printed = replace(sample.problem.document(sample.checked.results), printed=sample.result.answered_by)
    try:
        return "" if all(render(printed, kind) for kind in ("numpy", "matlab", "csv")) else "empty"
    except SymobsError as error:
        return f"{why}; {error}"


def live(sample: Sample) -> str:
    """The screen shows it, without an error."""
    request = {"schema": "symobs-live/1", "id": 1, "want": "view", "problem": dict(sample.data)}
    for want in ("view", "answer", "page"):
        found = live_answer({**request, "want": want})
        if found["status"] not in {"done", "no"}:
            return f"{want}: {found}"[:200]
    return ""


def python_face(sample: Sample) -> str:
    """`repr` shows the answer, `plot` is there."""
    said = repr(sample.result)
    fields = [name for name in sample.result.answered_by if sample.result.fields.get(name) is not None]
    missing = [name for name in fields if f"{name}=" not in said]
    if missing:
        return f"repr does not show {missing}"
    return "" if hasattr(sample.result, "plot") else "no plot()"


DOORS: dict[str, Callable[[Sample], str]] = {
    "json": json_of_the_answer,
    "pages": pages,
    "question": question,
    "asked": asked_is_marked,
    "answer": own_answer,
    "lines": lines,
    "expect": expectation,
    "export": exported,
    "variants": variants,
    "values": values,
    "programs": programs,
    "live": live,
    "python": python_face,
}
#: Doors that are open where one problem of the task goes through: the others may have letters, or no answer.
ONE_IS_ENOUGH = {"export", "variants", "values", "programs", "lines"}


def cell(task: str, door: str) -> str:
    """Return nothing where a task goes through a door, and else what stands in the way."""
    ways = []
    for sample in samples(task):
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", SymobsWarning)
            try:
                way = symobs.bounded(partial(DOORS[door], sample), timeout=30)
            except SymobsError as error:
                way = f"{type(error).__name__}: {error}"
            except Exception as error:  # noqa: BLE001 - it is what is looked for
                way = f"CRASH {type(error).__name__}: {error}"
        if door in ONE_IS_ENOUGH and not way:
            return ""
        ways += [f"{sample.name}: {way}"] if way else []
    if not samples(task):
        return "no worked example"
    return " | ".join(ways)


def main(arguments: Sequence[str] | None = None) -> int:
    """Print the matrix, and below it what stands in the way."""
    parser = argparse.ArgumentParser(prog="python -m tests.programs.matrix", description=__doc__)
    parser.add_argument("--task", action="append", choices=sorted(tasks()))
    parser.add_argument("--door", action="append", choices=sorted(DOORS))
    options = parser.parse_args(arguments)
    doors = options.door or list(DOORS)
    print(" " * 28, *(f"{door[:8]:8}" for door in doors))
    shut = []
    for task in options.task or sorted(tasks()):
        found = {door: cell(task, door) for door in doors}
        print(f"{task:28}", *(f"{'.' if found[door] else '+':8}" for door in doors), flush=True)
        shut += [(task, door, why) for door, why in found.items() if why]
    for task, door, why in shut:
        print(f"{task} {door}: {why[:300]}")
    return int(bool(shut))


if __name__ == "__main__":
    sys.exit(main())
