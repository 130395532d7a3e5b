"""The reference, written from the code: tasks with their keywords, methods and answers, commands, files, Python."""

from __future__ import annotations

import ast
import inspect
import json
import re
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

import symobs
from symobs.cli.command_line import COMMANDS
from symobs.cli.commands.schema import SCHEMAS
from symobs.ground import errors
from symobs.problem import read
from symobs.system.specification import CHOICES, KINDS
from symobs.tasks.result import Result, methods, render, tasks

if TYPE_CHECKING:
    from symobs.tasks.result import Task

ROOT = Path(__file__).parents[2]


def pages() -> dict[str, str]:
    """Return the pages by path."""
    return {
        "reference/tasks.md": tasks_page(),
        "reference/command_line.md": command_line_page(),
        "reference/problem_file.md": problem_file_page(),
        "reference/json.md": json_page(),
        "reference/python.md": python_page(),
    }


# -- tasks ------------------------------------------------------------------------------------------------------------


def tasks_page() -> str:
    """Every task: its function, what it takes, its methods, what it answers."""
    fields = answers()
    parts = ["# Tasks\n\nA task is a function, a command and a word of problem files, with the same keywords.\n"]
    for name, task in sorted(tasks().items()):
        parts += [f"## {name}\n", function(name, task.function), _keywords(task), _methods(task), _fields(fields[name])]
        if name in symobs.FUNCTIONS:
            parts.append(f"Of a design, in Python:\n\n{told(_called(name))}")
    return "\n".join(filter(None, parts))


def answers() -> dict[str, dict[str, str]]:
    """The fields of the result of each task with their types, as the stub of the package has them."""
    tree = ast.parse((ROOT / "symobs" / "__init__.pyi").read_text("utf-8"))
    kinds = {
        node.name: {f.name: ast.unparse(f.returns) for f in node.body if isinstance(f, ast.FunctionDef) and f.returns}
        for node in tree.body
        if isinstance(node, ast.ClassDef)
    }
    functions = {
        node.name: ast.unparse(node.returns) for node in tree.body if isinstance(node, ast.FunctionDef) and node.returns
    }
    return {name: kinds[functions[name]] for name in tasks()}


def _keywords(task: Task) -> str:
    if not task.keywords:
        return ""
    rows = []
    for name, kind in task.keywords.items():
        words = CHOICES.get(name, ()) if kind == "Name" else ()
        known = ["auto", *(m.name for m in methods(task.name).values())] if name == "method" else words
        told = ", ".join(f"`{word}`" for word in known) or escaped(KINDS[kind]["description"])
        rows.append(f"| `{name}` | {told} |")
    return "| keyword | |\n|---|---|\n" + "\n".join(rows) + "\n"


def _methods(task: Task) -> str:
    rows = [f"| `{m.name}` | {escaped(m.summary)} | {escaped(m.source)} |" for m in methods(task.name).values()]
    return "| method | | source |\n|---|---|---|\n" + "\n".join(rows) + "\n" if rows else ""


def _fields(found: dict[str, str]) -> str:
    if not found:
        return ""
    rows = [f"| `{name}` | `{kind.replace('|', 'or')}` |" for name, kind in found.items()]
    return "| answer | in Python |\n|---|---|\n" + "\n".join(rows) + "\n"


# -- commands and files -----------------------------------------------------------------------------------------------


def command_line_page() -> str:
    """What every command says of itself."""
    parts = [
        "# Command line\n\nEvery [task](tasks.md) is a command, too: `symobs observer --help` says what it takes.\n",
        "## symobs\n",
        _help(main_group(), "symobs"),
    ]
    for name in COMMANDS:
        command = main_group().get_command(click.Context(main_group()), name)
        parts += [f"## symobs {name}\n", _help(command, f"symobs {name}")]
    return "\n".join(parts)


def main_group() -> Any:
    """The group of all commands."""
    from symobs.cli import command_line  # noqa: PLC0415 - looked up by its kind, whatever it is called

    return next(found for found in vars(command_line).values() if isinstance(found, click.Group))


def _help(command: click.Command, name: str) -> str:
    context = click.Context(command, info_name=name, max_content_width=100, terminal_width=100)
    return f"```text\n{command.get_help(context)}\n```\n"


def problem_file_page() -> str:
    """The keys of a problem file."""
    schema = SCHEMAS["problem"]()
    rows = [
        f"| `{key}` | {escaped(str(about.get('description', '')))} |" for key, about in schema["properties"].items()
    ]
    text = json.dumps(schema, indent=1, ensure_ascii=False)
    return (
        "# Problem file\n\nA problem file is TOML, or JSON with the same keys; how to write one is in the\n"
        "[user guide](../guide.md).\n\n"
        "| key | |\n|---|---|\n" + "\n".join(rows) + "\n\n## Its schema\n\n"
        f"`symobs schema` prints it.\n\n```json\n{text}\n```\n"
    )


def json_page() -> str:
    """What JSON has, by an example."""
    path = ROOT / "worked_examples" / "servo_observer.toml"
    problem = read(path.read_text("utf-8"), path.name, path.parent)
    text = str(render(problem.document(problem.solve()), "json"))
    return (
        "# Results in JSON\n\n`symobs solve FILE --format json` prints an object with a result for every task, whatever its\n"
        "verdict. Numbers and expressions are exact texts that SymPy reads, matrices lists of rows; letters and signs are the\n"
        "standard ones, u = −K x̂ and A − L C. The fields of each task are those of [its answers](tasks.md).\n\n"
        f"The result of `symobs examples servo_observer`:\n\n```json\n{text.strip()}\n```\n"
    )


# -- Python -----------------------------------------------------------------------------------------------------------


def python_page() -> str:
    """Plants, results, functions that are no tasks, and errors."""
    parts = ["# Python\n", "The functions of the tasks are on the page of [tasks](tasks.md).\n", "## Plants\n"]
    parts += [_class("StateSpace", symobs.StateSpace), "## Results\n", _class("Result", Result), "## Other functions\n"]
    parts += [function(name, _called(name)) for name in sorted(symobs.FUNCTIONS.keys() - tasks())]
    parts.append("## Errors\n")
    for name, kind in sorted(vars(errors).items()):
        if isinstance(kind, type) and issubclass(kind, errors.SymobsError):
            parts.append(f"````{{py:exception}} {name}\n:module: symobs\n\n{told(kind)}````\n")
    return "\n".join(parts)


def _called(name: str) -> Any:
    found = getattr(symobs, name)
    return found if inspect.isfunction(found) else getattr(found, name)


def _class(name: str, kind: type) -> str:
    parts = [f"`````{{py:class}} {name}{_signature(kind)}\n:module: symobs\n\n{told(kind)}"]
    inherited = {m: f for base in kind.__mro__[-2:0:-1] for m, f in vars(base).items() if m not in vars(kind)}
    for member, found in (*sorted(vars(kind).items()), *sorted(inherited.items())):
        plain = getattr(found, "__func__", found)
        if member.startswith("_") or not inspect.getdoc(found):
            continue
        if inspect.isfunction(plain):
            parts.append(f"````{{py:method}} {member}{_signature(plain, own=True)}\n\n{told(plain)}````\n")
        elif isinstance(found, property) or type(found).__name__ == "cached_property":
            parts.append(f"````{{py:property}} {member}\n\n{told(found)}````\n")
    return "\n".join([*parts, "`````\n"])


def function(name: str, called: Any) -> str:
    """A function with its signature and what it says of itself."""
    return f"````{{py:function}} {name}{_signature(called)}\n:module: symobs\n\n{told(called)}````\n"


def _signature(called: Any, *, own: bool = False) -> str:
    signature = inspect.signature(called)
    given = list(signature.parameters.values())[own:]
    if given and given[0].name in {"cls", "self"}:
        given = given[1:]
    plain = [p.replace(annotation=inspect.Parameter.empty) for p in given]
    return str(signature.replace(parameters=plain, return_annotation=inspect.Signature.empty))


def told(described: Any) -> str:
    """A docstring as Markdown: what is set in columns stays as it is."""
    parts = []
    for paragraph in (inspect.getdoc(described) or "").split("\n\n"):
        columns = any(re.search(r"\S {3,}\S", line) or line.startswith("    ") for line in paragraph.split("\n"))
        parts.append(f"```text\n{paragraph}\n```" if columns else escaped(paragraph))
    return "\n\n".join(parts) + "\n"


def escaped(text: str) -> str:
    """Text as Markdown that means it literally; between backticks it is code already."""
    parts = re.split(r"(`[^`\n]+`)", " ".join(text.split()))
    plain = [re.sub(r"([\\`*_{}\[\]<>$|~#])", r"\\\1", part) for part in parts[::2]]
    return "".join(a + b for a, b in zip(plain, [*parts[1::2], ""], strict=True))
