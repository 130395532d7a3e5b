"""What is fuzzed: how an input of each kind is made, what is done with it, and what it may cost.

An input comes from a generator seeded by its target and number, so that any one of them can be made again alone.
`run` returns in a word what became of the input; a `SymobsError` is a refusal, and anything else that is raised a crash.
"""

from __future__ import annotations

import sys
import tempfile
from contextlib import suppress
from dataclasses import dataclass
from io import BytesIO, TextIOWrapper
from pathlib import Path
from random import Random
from typing import TYPE_CHECKING, Any
from unittest.mock import patch

from symobs.applications.audit.equations.grammar import read_relation
from symobs.applications.audit.printed_entries import printed_entries
from symobs.cli import main
from symobs.formula.convention.convention_file import of_file
from symobs.formula.expression import declared_name, parse_matrix, parse_poles, parse_polynomial, parse_scalar
from symobs.ground.errors import SymobsError
from symobs.problem import Problem, parse, validate
from symobs.problem.question import question_of
from symobs.system.specification import read_entries, read_names
from symobs.tasks.result import formats, tasks
from symobs.tasks.result.in_convention import names_in
from tests.programs.fuzz import answers, corpus, live_requests, mutate, printing, problems, texts

if TYPE_CHECKING:
    from collections.abc import Callable

MEGABYTE = 1 << 20


class Broken(AssertionError):
    """A run ended in a way no input may bring about."""


@dataclass(frozen=True)
class Target:
    """One target: of a thousand inputs `share` are its own; an input may take so many seconds of the processor, and memory.

    writes  whether files may be written, in the target's own folder
    """

    name: str
    share: int
    make: Callable[[Random], Any]
    run: Callable[[Any], str]
    seconds: float = 1.0
    megabytes: int = 200
    writes: bool = False

    def case(self, number: int) -> Any:
        """Return the input of that number."""
        return self.make(Random(f"{self.name} {number}"))  # noqa: S311 - repeatable by design


# -- the grammar ------------------------------------------------------------------------------------------------------

_DECLARED = dict.fromkeys(
    ("a", "b", "omega", "h1", "x_1", "M", "tau_f", "i", "lam", "phi", "K", "e", "p", "q", "s", "t"), "real"
)


def _without(names: dict[str, str] | None, name: str) -> dict[str, str] | None:
    return None if names is None else {each: sign for each, sign in names.items() if each != name}


_READERS: dict[str, Callable[[Any, Any], object]] = {
    "scalar": lambda value, names: parse_scalar(value, names, where="plant.dt"),
    "matrix": lambda value, names: parse_matrix(value, names, where="plant.A"),
    "poles": lambda value, names: parse_poles(value, names, where="specification.poles"),
    "polynomial": lambda value, names: parse_polynomial(
        value, "s", _without(names, "s"), where="specification.polynomial"
    ),
    "time": lambda value, names: parse_matrix(value, names, where="specification.input", functions=True),
    "time scalar": lambda value, names: parse_scalar(value, _without(names, "t"), variable="t", functions=True),
    "name": lambda value, _: declared_name(value),
    "names": lambda value, _: read_names(value, "parameters"),
    "entries": lambda value, _: read_entries(value, "zero", (2, 3)),
}


def _grammar(source: Random) -> Any:
    kind = source.choice((*("scalar", "matrix", "matrix", "poles", "polynomial", "time", "time scalar") * 3, *_READERS))
    names = source.choice((None, None, _DECLARED, _DECLARED, _DECLARED, {}))
    calls, likely = kind.startswith("time"), source.random()
    if likely < 0.5:
        return kind, _fitting(source, kind, calls=calls), names
    if likely < 0.98:
        return kind, texts.anything(source, calls=calls), names
    return kind, mutate.value(source, corpus.expressions()), names


def _fitting(source: Random, kind: str, *, calls: bool) -> Any:
    """Return what a reader is made for: a text by the grammar, or lists of such texts."""

    def entry() -> str:
        return texts.expression(source, source.choice((1, 2, 3, 4)), calls=calls)

    match kind:
        case "matrix" | "time":
            columns = source.randrange(1, 4)
            rows = [[entry() for _ in range(columns)] for _ in range(source.randrange(1, 4))]
            return rows if source.random() < 0.3 else texts.matrix(source, calls=calls)
        case "poles":
            poles = [entry() for _ in range(source.randrange(1, 4))]
            return poles if source.random() < 0.5 else ", ".join(poles)
        case "polynomial":
            return " + ".join(
                f"({texts.expression(source, 2, calls=False)}) s^{k}" for k in range(source.randrange(2, 5))
            )
        case "name" | "names":
            return ", ".join(source.choices(texts.NAMES, k=1 if kind == "name" else source.randrange(1, 4)))
        case "entries":
            return source.choice(("(1, 2), (2, 3)", "[* 0 *; * * 0]", "1 1; 2 2", [[1, 2]], [["*", 0, "*"]] * 2))
    return entry()


def _read_expression(case: Any) -> str:
    kind, text, names = case
    _READERS[kind](text, names)
    return "read"


# -- files ------------------------------------------------------------------------------------------------------------


def _decoded(raw: bytes) -> str:
    """Return the text, as the command line reads it; what is no UTF-8 keeps its place, as in a text from Python."""
    try:
        return raw.decode("utf-8-sig")
    except UnicodeDecodeError:
        return raw.decode("utf-8", "surrogateescape")


def _unsolved(problem: Problem, report: object = None) -> tuple[()]:  # noqa: ARG001 - the signature of what it replaces
    """In the place of solving, which reading a file with errors in it does to find more of them."""
    question_of(problem)
    return ()


def _read_problem(raw: bytes) -> str:
    """Read a file and everything in it, without solving: what its question needs, and what it prints."""
    with patch.object(Problem, "solve", _unsolved):
        problem = validate(parse(_decoded(raw)))
    question_of(problem)
    printed_entries(problem.printed, problem.convention, problem.plant.symbols.signs)
    return "read"


def _read_convention(raw: bytes) -> str:
    FOLDER.joinpath("own.toml").write_bytes(raw)
    found = of_file.__wrapped__(FOLDER / "own.toml")
    for reduced in (False, True):
        assert all(form.latex.isascii() and form.text for form in found.forms(reduced=reduced).values()), "a letter"
        names_in(found, "reduced_order_observer", reduced=reduced)
    assert all((found.law, found.observer_matrix, found.pair)), "a law"
    return "read"


def _relation(source: Random) -> Any:
    return problems.printed_file(source) if source.random() < 0.01 else texts.relation(source)


def _read_printed(case: Any) -> str:
    """Read an equation, and its text again; or audit a file in which it stands."""
    if isinstance(case, bytes):
        from symobs.applications.audit import REPORTS, audit, report  # noqa: PLC0415 - a share of the inputs

        found = audit(validate(parse(_decoded(case))))
        for name in REPORTS:
            report({"own.json": found}, name)
        return "audited"
    members = read_relation(case, "printed[0].relation")
    written = " = ".join(map(str, members))
    if len(written) <= len(case) + 200 and read_relation(written, "") != members:
        raise Broken(f"{written[:300]} does not read as it was written")
    return "read"


# -- the command line -------------------------------------------------------------------------------------------------

#: A folder of this process alone, in which the command line is run; `begin` makes it.
FOLDER = Path(tempfile.gettempdir())
_CODES = {0, 2, 3, 4, 5}
_FORMATS = ("latex", "json", "json", "text", "markdown", "html", "fragment", "beamer", "html_fragment", "x", "", "JSON")
_FILES = ("own.toml", "own.toml", "own.json", "-", "none.toml", "", ".", "ünï\u202e.toml", "a\nb", "-x", "own.toml/x")


@dataclass(frozen=True)
class Call:
    """One call of the command line, and the file that lies there."""

    arguments: tuple[str, ...]
    file: bytes = b""


def _call(source: Random) -> Call:
    toml = source.random() < 0.6
    made = problems.small(source) if source.random() < 0.5 else problems.wrong(source)
    writer = mutate.as_toml if toml else mutate.as_json
    file = writer(made).encode("utf-8", "surrogatepass")
    if source.random() < 0.3:
        file = (problems.toml if toml else problems.json)(source)
    match source.randrange(10):
        case 0 | 1 | 2:
            arguments = ["solve", source.choice(_FILES[:4]), *_options(source)]
        case 3:
            arguments = ["sheet", *source.choices(_FILES[:4], k=source.choice((1, 1, 2))), *_options(source)]
            arguments += source.choice(([], ["--questions"], ["--solutions"], ["--title", mutate.text(source, "x")]))
        case 4:
            arguments = ["audit", source.choice(_FILES), *source.choice(([], ["--format", "json"], ["--format", "x"]))]
            file = problems.printed_file(source)
        case 5:
            lists = ("methods", "conventions", "schema", "templates", "conventions S1", "conventions none", "--version")
            arguments = source.choice(
                (*lists, "templates copy new", "--help", "solve --help", "observer -h", "")
            ).split()
        case 6:
            arguments = [mutate.text(source, source.choice((*tasks(), "solve", "sheet"))), *_options(source)]
        case _:
            arguments = _task(source)
    if source.random() < 0.1:
        arguments.insert(
            source.randint(0, len(arguments)), source.choice((*mutate.PIECES, "--", "-", "--x=1", "-o", ""))
        )
    return Call(tuple(_possible(argument) for argument in arguments), file)


def _possible(argument: str) -> str:
    """Return what a program can be called with: no null byte, and what is no UTF-8 as Python hands it on."""
    return argument[:100_000].replace("\x00", "").encode("utf-8", "surrogatepass").decode("utf-8", "surrogateescape")


def _options(source: Random) -> list[str]:
    """Return some of the options that every command has."""
    offered = (
        ("--format", _FORMATS),
        ("-o", ("out.json", "out.tex", "out.txt", "-", "own/none.tex", ".", "out.x", "o\u202eut.md", "")),
        ("--detail", ("full", "outline", "answer", "x")),
        ("--convention", ("S0", "S1", "S2", "S4", "none", "own.toml", "../own.toml", "")),
        ("--task", ("observer", "observability", "x")),
        ("--plot", ("out.svg", "out.x", "")),
        ("--templates", (".", "none", "")),
    )
    chosen = [(name, source.choice(values)) for name, values in offered if source.random() < 0.2]
    if source.random() < 0.05:  # each of them asks for a process of its own, where it has a meaning
        budgets = ("--timeout", "--memory")
        chosen.append(
            (source.choice(budgets), source.choice(("60", "2000", "x", "-1", "0", "nan", "inf", "1e999", "", "1")))
        )
    return [part for option in chosen for part in option]


def _task(source: Random) -> list[str]:
    """Return the call of a task without a file."""
    whole = problems.small(source)
    arguments = [whole["tasks"][0].replace("_", source.choice("_-"))]
    for name, value in (*whole["plant"].items(), *whole["specification"].items()):
        text = ", ".join(map(str, value)) if isinstance(value, list) else str(value)
        text = mutate.text(source, text, corpus.expressions()) if source.random() < 0.1 else text
        arguments += [f"--{name}", text] if source.random() < 0.97 else [f"--{name}"]
    if source.random() < 0.2:
        arguments += [
            "--symbol",
            source.choice(("a=positive", "a", "=", "omega=x", "1=real", "a=positive=b", "lambda")),
        ]
    return [*arguments, *(_options(source) if source.random() < 0.4 else ["--format", "json"])]


def _run_command(call: Call) -> str:
    """Call the command line as its script does, in this process; raises `Broken` for an exit code that says a bug."""
    for name in ("own.toml", "own.json"):
        FOLDER.joinpath(name).write_bytes(call.file)
    out, err = BytesIO(), BytesIO()
    streams: Any = {
        "argv": ["symobs", *call.arguments],
        "stdin": TextIOWrapper(BytesIO(call.file), encoding="utf-8"),
        "stdout": TextIOWrapper(out, encoding="utf-8", write_through=True),
        "stderr": TextIOWrapper(err, encoding="utf-8", write_through=True),
    }
    with patch.multiple(sys, **streams):
        try:
            main()
        except SystemExit as left:
            code = left.code
    said = err.getvalue().decode("utf-8", "replace")
    if code not in _CODES or "Traceback" in said or "internal error" in said:
        raise Broken(f"exit code {code}: {said[-600:]}")
    if code in {2, 3} and not said.strip():
        raise Broken(f"exit code {code} without a word")
    return f"exit code {code}"


# -- all --------------------------------------------------------------------------------------------------------------

TARGETS = {
    target.name: target
    for target in (
        Target("grammar", 690, _grammar, _read_expression),
        Target("problem_toml", 55, problems.toml, _read_problem),
        Target("problem_json", 55, problems.json, _read_problem),
        Target("command_line", 6, _call, _run_command, seconds=20.0, megabytes=500, writes=True),
        Target("printing", 34, lambda source: source, printing.roundtrip),
        Target("audit", 90, _relation, _read_printed, seconds=5.0),
        Target("check", 10, answers.submission, answers.checked, seconds=5.0, megabytes=400),
        Target("live", 10, live_requests.request, live_requests.answered, seconds=20.0, megabytes=500),
        Target("convention", 50, problems.convention, _read_convention, writes=True),
    )
}


def begin(folder: Path) -> None:
    """Make everything ready that is made when it is first needed, with the examples: modules, parsers, registries."""
    global FOLDER  # noqa: PLW0603 - one folder a process, as the working folder is one
    FOLDER = folder
    formats(), tasks()
    for target in TARGETS.values():
        for number in range(-3, 0):
            with suppress(SymobsError, AssertionError):
                target.run(target.case(number))
    with suppress(SymobsError):
        _read_problem(corpus.example_texts()[0].encode())
