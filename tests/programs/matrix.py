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
from symobs.pages.drawings.plot_file import pictures_of
from symobs.problem.expect import mismatches
from symobs.problem.question import question_of
from symobs.problem.validation import validate
from symobs.tasks.result import tasks
from symobs.tasks.result.writers import formats, render
from tests.support.paths import ROOT

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Mapping, Sequence

#: What a door says of a task that has nothing to do there, before the reason.
NOTHING = "–"
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
            if key == "dt":  # the equations of a sampled plant do not hold its period
                continue
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
    if sample.checked.report("\n".join(_line(*each) for each in answers.items())).verdict != "right":
        return "its own answer as lines is not right"
    for name, value in answers.items():
        is_of_a_basis = (
            name in sample.result.in_coordinates
        )  # another entry may be that of another basis, zeros are not
        zeros = re.sub(r"[^\s;\[\]]+", "0", str(value))
        other = zeros if is_of_a_basis and zeros != value else _other(value)
        if sample.checked.report({"answer": {**answers, name: other}}).verdict == "right":
            return f"another {name} is right"
    return ""


def _line(name: str, value: Any) -> str:
    """Return an answer as a line of a text."""
    if isinstance(value, dict):
        return f"{name} = {', '.join(f'{key}: {each}' for key, each in value.items())}"
    if isinstance(value, list) and name in {"conditions", "stable_if"} and value != ["False"]:
        return "\n".join(map(str, value))
    if isinstance(value, list):
        return f"{name} = [{', '.join(map(str, value))}]"
    return f"{name} = {value}"


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
    if value == "False":
        return "1 > 0"
    if relation := re.search("[<>]|!=", value):
        return f"{value[: relation.start()]}+ 7 {value[relation.start() :]}"
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
    own = [_LINES[sample.task]] if sample.task in _LINES else []
    for text in (*own, *(each.claim.rpartition(": ")[2] for each in sample.result.certificates)):
        left, equals, right = text.partition("=")
        if equals and not re.search(r"[<>:]|!=", text):
            verdicts = [_verdict_of_line(sample, line) for line in (text, f"{left} = -({right})")]
            if verdicts == ["true", "false"]:
                return ""
    return "no defining equation is a true line"


def _verdict_of_line(sample: Sample, line: str) -> str:
    report = sample.checked.report("\n".join([line, *(_line(*each) for each in sample.answers.items())]) + "\n")
    return report.lines[0].verdict if report.lines else ""


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
    for table in ("plant", "specification"):
        for key, value in sample.data.get(table, {}).items():
            for found in _numbers(text := json.dumps(value)):
                changed = {**sample.data[table], key: json.loads(f"{text[: found.start()]}v{text[found.end() :]}")}
                varied = {"parameters": {"v": {"set": [str(number) for number in range(1, 10)]}}}
                try:
                    made = list(
                        symobs.variants(toml_text({**sample.data, table: changed, "variants": varied}), 2, workers=1)
                    )
                except SymobsError as error:
                    why = str(error)
                    continue
                return "" if made[0] != made[1] else "two that are one"
    return why


def values(sample: Sample) -> str:
    """At values of its letters, given or put for a number, there is an answer, and arrays of it."""
    letters, problem = _letters(sample), sample.problem
    if not letters:
        varied = _with_a_letter(sample)
        if varied is None:
            return "no number to vary"
        letters, problem = {"v": varied[1]}, validate(varied[0])
    (result,) = problem.solve()
    there = result.at(**letters)
    if json.loads(there.to_json())["results"][0]["verdict"] == "undecided":
        return "undecided there"
    if not any(_is_numeric(there, name) for name in there.fields_asked(there.specification)):
        return ""  # of words, polynomials and functions of time `at` is all there can be
    found = result.evaluate({name: [float(value), float(value) + 1] for name, value in letters.items()})
    return "" if found else "evaluate is empty"


def _is_numeric(result: Any, name: str) -> bool:
    """Whether an answer is made of numbers where its letters have values."""
    value = result.decimals.get(name)
    return value is not None and not isinstance(value, str)


def _letters(sample: Sample) -> dict[str, int]:
    """Return a value for each letter of the data; a horizon is one of them where nothing is said of it."""
    own = [*sample.data.get("symbols", {}), *(name for name in ("T", "k", "omega_0") if name in sample.result.symbols)]
    return dict(zip(dict.fromkeys(own), range(2, 100), strict=False))


def _numbers(text: str) -> Iterator[re.Match[str]]:
    """Yield the whole numbers of a text of JSON in whose place a letter may stand: in a text, or alone in quotes."""
    yield from re.finditer(r'(?<![\w.^/*"-])[1-9]\d*(?![\w.*/"])|(?<=")[1-9]\d*(?=")', text)


def _with_a_letter(sample: Sample) -> tuple[dict[str, Any], int] | None:
    """Return the problem with the letter v for a number of its matrices, and that number."""
    for key in sample.data.get("plant", {}).keys() & {"A", "B", "C"}:
        text = json.dumps(sample.data["plant"][key])
        for found in _numbers(text):
            changed = json.loads(f"{text[: found.start()]}v{text[found.end() :]}")
            symbols = {**sample.data.get("symbols", {}), "v": "positive"}
            return {**sample.data, "plant": {**sample.data["plant"], key: changed}, "symbols": symbols}, int(found[0])
    return None


def programs(sample: Sample) -> str:
    """There is a program in every language, or what answers the task is there as numbers of programs."""
    result = sample.result.at(**_letters(sample)) if _letters(sample) else sample.result
    given = {} if result.plant.is_discrete else {"period": "1/100"}
    try:
        return "" if all(result.to(kind, **given) for kind in ("python", "matlab", "c", "modelica")) else "empty"
    except SymobsError as error:
        why = str(error)
    if not all(_is_numeric(result, name) for name in result.fields_asked(result.specification) or [""]):
        return f"{NOTHING} its answers are words, polynomials or functions: {why}"
    printed = replace(sample.problem.document((result,)), printed=result.fields_asked(result.specification))
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


def is_drawn(sample: Sample) -> bool:
    """Whether the plots of a page, which has other figures, too, are a figure of matplotlib."""
    pictures = pictures_of(sample.result)
    return not pictures or len(sample.result.plot().axes) == len(pictures)


def python_face(sample: Sample) -> str:
    """`repr` shows the answer, `plot` is there."""
    said = repr(sample.result)
    fields = [name for name in sample.result.answered_by if sample.result.fields.get(name) is not None]
    missing = [name for name in fields if f"{name}=" not in said]
    if missing:
        return f"repr does not show {missing}"
    if "<figure" in str(sample.result.to("html")) and not is_drawn(sample):
        return "no plot()"
    return ""


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
#: Defining equations as students write them, of tasks whose certificates are written for programs.
_LINES = {
    "dual": "A' = [0 0; 1 -1]",
    "feedforward": "F = -1/(C (A - B K)^-1 B)",
    "initial_state": "x0 = [x10; x20]",
    "initial_state_covariance": "det(sI - A) = s + a",
    "kalman": "L V = P C'",
    "lyapunov": "A'PA - P = -Q",
    "observability": "rank O = 2",
    "response": "x'(t) = A x + B u",
    "stabilizability": "rank(B) = 1",
    "tracking": "B K_d = A - A_d",
    "transfer_function": "P(s) = C(sI - A)^-1 B",
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
                way = symobs.bounded(partial(DOORS[door], sample), timeout=600)
            except SymobsError as error:
                way = f"{type(error).__name__}: {error}"
            except Exception as error:  # noqa: BLE001 - it is what is looked for
                way = f"CRASH {type(error).__name__}: {error}"
        if door in ONE_IS_ENOUGH and not way:
            return ""
        if way.startswith(NOTHING):
            return way
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
        print(f"{task:28}", *(f"{_sign(found[door]):8}" for door in doors), flush=True)
        shut += [(task, door, why) for door, why in found.items() if _sign(why) == "."]
    for task, door, why in shut:
        print(f"{task} {door}: {why[:300]}")
    print(f"+ passes, {NOTHING} nothing to do there, . does not pass: {len(shut)}")
    return int(bool(shut))


def _sign(way: str) -> str:
    """Return the sign of a cell."""
    return (NOTHING if way.startswith(NOTHING) else ".") if way else "+"


if __name__ == "__main__":
    sys.exit(main())
