"""What the modules of symobs import, when, and the circles in it: read from the sources, nothing is imported."""

from __future__ import annotations

import ast
from collections import defaultdict
from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping
    from pathlib import Path

Graph = dict[str, set[str]]


class Import(NamedTuple):
    """One imported name, and when the import happens."""

    line: int
    target: str
    when: str  # "at import", "in a function" or "for annotations"


def imports(tree: ast.AST, package: tuple[str, ...], when: str = "at import") -> Iterator[Import]:
    """Every import below `tree`, with absolute names; `package` is the one that relative imports start from."""
    for node in ast.iter_child_nodes(tree):
        if isinstance(node, ast.Import):
            yield from (Import(node.lineno, alias.name, when) for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            base = package[: len(package) + 1 - node.level] if node.level else ()
            source = ".".join([*base, *([node.module] if node.module else [])])
            yield from (Import(node.lineno, f"{source}.{alias.name}", when) for alias in node.names)
        elif isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef):
            yield from imports(node, package, "in a function" if when == "at import" else when)
        elif isinstance(node, ast.If) and ast.unparse(node.test) in {"TYPE_CHECKING", "typing.TYPE_CHECKING"}:
            yield from imports(ast.Module(node.body, []), package, "for annotations")
            yield from imports(ast.Module(node.orelse, []), package, when)
        else:
            yield from imports(node, package, when)


class Sources:
    """The modules below a folder by dotted name; what a package's `__init__` re-exports is followed to its module."""

    def __init__(self, folder: Path) -> None:
        self.paths = {_dotted(path, folder.parent): path for path in sorted(folder.rglob("*.py"))}
        self.imports = {
            name: [*imports(ast.parse(path.read_text(encoding="utf-8")), tuple(name.split(".")[:-1]))]
            for name, path in self.paths.items()
        }
        self.faces = {name for name, path in self.paths.items() if path.name == "__init__.py"}

    def module(self, target: str) -> str:
        """The module in which an imported name is defined; empty for what is no module of these."""
        package, _, name = target.rpartition(".")
        if package in self.faces and target not in self.paths:
            sources = [one.target for one in self.imports[package] if one.target.endswith(f".{name}")]
            return self.module(sources[0]) if sources and sources[0] != target else package
        return target if target in self.paths else package if package in self.paths else ""

    def graph(self) -> Graph:
        """Which module imports which, whenever it does; faces are left out, they only pass on."""
        found: Graph = {}
        for name in self.paths.keys() - self.faces:
            reached = {self.module(one.target) for one in self.imports[name]}
            found[name] = {other for other in reached if other not in {"", name} and other not in self.faces}
        return found


def folders(graph: Mapping[str, Iterable[str]]) -> Graph:
    """Which folder imports from which; a module that lies in no folder of the package stands for itself."""
    found: defaultdict[str, set[str]] = defaultdict(set)
    for name, others in graph.items():
        found[_folder(name)] |= {_folder(other) for other in others} - {_folder(name)}
    return dict(found)


def circles(graph: Mapping[str, Iterable[str]]) -> list[list[str]]:
    """The strongly connected parts of more than one member, by Tarjan's algorithm."""
    index: dict[str, int] = {}
    low: dict[str, int] = {}
    stack: list[str] = []
    found: list[list[str]] = []

    def visit(one: str) -> None:
        index[one] = low[one] = len(index)
        stack.append(one)
        for other in graph.get(one, ()):
            if other not in index:
                visit(other)
            if other in stack:
                low[one] = min(low[one], low[other])
        if low[one] == index[one]:
            part = stack[stack.index(one) :]
            del stack[stack.index(one) :]
            if len(part) > 1:
                found.append(sorted(part))

    for one in graph:
        if one not in index:
            visit(one)
    return sorted(found)


def _dotted(path: Path, root: Path) -> str:
    return ".".join(path.relative_to(root).with_suffix("").parts).removesuffix(".__init__")


def _folder(name: str) -> str:
    return name.rpartition(".")[0] if name.count(".") > 1 else name
