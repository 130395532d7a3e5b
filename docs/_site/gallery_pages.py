"""The gallery: every worked example solved, in parallel and kept, held against what it expects, and a page for each."""

from __future__ import annotations

import hashlib
import json
import re
import tomllib
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass, replace
from functools import cache
from html import escape
from pathlib import Path
from typing import Any

ROOT = Path(__file__).parents[2]
#: Its page is larger than all others together.
LARGE = {"cart_pole"}


@dataclass(frozen=True)
class WorkedExample:
    """A worked example."""

    path: Path
    text: str
    data: dict[str, Any]

    @property
    def name(self) -> str:
        """Its name."""
        return self.path.stem

    @property
    def title(self) -> str:
        """Its title."""
        return str(self.data.get("title", self.name))

    @property
    def task(self) -> str:
        """The task it leads to."""
        names = self.data.get("tasks") or [self.data["task"]]
        return str(names[-1])

    @property
    def link(self) -> str:
        """Its state in a link."""
        from symobs.applications.live.request import link_of  # noqa: PLC0415 - only where there is a live page

        return link_of(self.data)


@cache
def example(name: str) -> WorkedExample:
    """Return a worked example."""
    path = ROOT / "worked_examples" / f"{name}.toml"
    text = path.read_text("utf-8")
    return WorkedExample(path, text, tomllib.loads(text, parse_float=str))


def examples(names: str = "") -> list[WorkedExample]:
    """Return those of a list of names, or all."""
    every = [path.stem for path in sorted((ROOT / "worked_examples").glob("*.toml"))]
    return [example(name) for name in (names.split(",") if names else every)]


def solve(name: str) -> str:
    """Return the derivation of an example as HTML; raises `ValueError` where it is not what the example expects."""
    from symobs.problem import read  # noqa: PLC0415
    from symobs.problem.expect import mismatches  # noqa: PLC0415 - in the process that solves
    from symobs.tasks.result import render  # noqa: PLC0415

    found = example(name)
    problem = read(found.text, found.path.name, found.path.parent)
    results = problem.solve()
    unmet = mismatches(problem.viewed(results), problem.expect)
    if unmet:
        raise ValueError(f"{name}: {'; '.join(unmet)}")
    return str(render(replace(problem.document(results), title=""), "html_fragment"))


def solved(shown: list[WorkedExample], folder: Path) -> dict[str, str]:
    """Return the derivations by name; those whose example and code did not change are kept in a folder."""
    code = hashlib.sha256()
    for path in sorted((ROOT / "symobs").rglob("*")):
        if path.suffix in {".py", ".css", ".json", ".toml"}:
            code.update(path.read_bytes())
    folder.mkdir(exist_ok=True)
    kept: dict[str, str] = {}
    files = {}
    for each in shown:
        if each.name not in LARGE:
            digest = hashlib.sha256(code.digest() + each.text.encode()).hexdigest()[:16]
            files[each.name] = folder / f"{each.name}-{digest}.json"
    for old in set(folder.glob("*.json")) - set(files.values()):
        old.unlink()
    with ProcessPoolExecutor() as pool:
        waiting = {name: pool.submit(solve, name) for name, path in files.items() if not path.exists()}
        for name, path in files.items():
            if name in waiting:
                path.write_text(json.dumps(waiting[name].result()), "utf-8")
            kept[name] = json.loads(path.read_text("utf-8"))
    return kept


def pages(shown: list[WorkedExample], fragments: dict[str, str]) -> dict[str, str]:
    """Return the pages of the gallery by path: one a task, with the first picture of each example, and one an example."""
    from symobs.tasks.result import tasks  # noqa: PLC0415 - the registry imports all tasks

    by_task: dict[str, list[WorkedExample]] = {}
    for each in shown:
        by_task.setdefault(each.task, []).append(each)
    found = {f"gallery/examples/{each.name}.md": _page(each) for each in shown}
    for task, listed in by_task.items():
        cards = "\n".join(_card(each, fragments.get(each.name, "")) for each in listed)
        found[f"gallery/{task}.md"] = (
            f"# {task.replace('_', ' ').capitalize()}\n\n{_escaped(tasks()[task].summary)}\n\n"
            f'```{{raw}} html\n<div class="gallery">\n{cards}\n</div>\n```\n'
        )
    listed = "\n".join(f"| [{task.replace('_', ' ')}]({task}.md) | {len(by_task[task])} |" for task in sorted(by_task))
    entries = "\n".join(sorted(by_task))
    found["gallery/index.md"] = (
        f"# Gallery\n\n{len(shown)} worked examples from the literature and from lectures. Each was solved when this\n"
        "site was built, every line of its derivation checked, and its answers compared with those of its source.\n\n"
        f"| task | examples |\n|---|---:|\n{listed}\n\n```{{toctree}}\n:hidden:\n\n{entries}\n```\n"
    )
    return found


def _page(each: WorkedExample) -> str:
    source = f"*{_escaped(str(each.data['source']))}*\n\n" if "source" in each.data else ""
    # outside of the tree of contents, which every page repeats
    return f"---\norphan: true\n---\n\n# {_escaped(each.title)}\n\n{source}```{{symobs-example}} {each.name}\n```\n"


def _card(each: WorkedExample, fragment: str) -> str:
    pictures = re.findall(r"<svg\b.*?</svg>", fragment, re.DOTALL)
    picture = re.sub(r' (?:width|height)="[\d.]+"', "", pictures[0], count=2) if pictures else ""
    return f'<a href="examples/{each.name}.html"><span>{escape(each.title)}</span>{picture}</a>'


def _escaped(text: str) -> str:
    return re.sub(r"([\\`*_{}\[\]<>$|])", r"\\\1", " ".join(text.split()))
