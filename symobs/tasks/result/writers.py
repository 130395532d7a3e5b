"""The registries of page writers and output formats, and the import of the modules that fill registries.

This module is below the type of results, which therefore has no name here.
"""

from __future__ import annotations

import importlib
import pkgutil
from functools import lru_cache
from importlib.util import find_spec
from typing import TYPE_CHECKING, Any, NoReturn, TypeVar

import symobs
from symobs.ground.errors import UsageError

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Mapping

    from symobs.proof.derivation.builder import Builder

Kind = TypeVar("Kind", bound=type)
Writer = TypeVar("Writer", bound="Callable[[Builder, Any], None]")

_FORMATS: dict[str, Any] = {}
_PAGES: dict[type, Callable[[Builder, Any], None]] = {}
_DISCOVERED: set[str] = set()


def page_of(kind: type) -> Callable[[Writer], Writer]:
    """Register the function that writes the page of a result type.

    It stands beside the type, in the module of the same name with `_page` after it, and is imported when first needed.
    """

    def register(writer: Writer) -> Writer:
        _PAGES[kind] = writer
        return writer

    return register


def writer_of(kind: type) -> Callable[[Builder, Any], None]:
    """Return what writes the page of a result type: its own, or that of the type it is derived from."""
    for base in kind.__mro__:
        if base not in _PAGES and find_spec(f"{base.__module__}_page") is not None:
            importlib.import_module(f"{base.__module__}_page")
        if base in _PAGES:
            return _PAGES[base]
    message = f"no page is registered for {kind.__name__}: write {kind.__module__.replace('.', '/')}_page.py"
    raise NotImplementedError(message)


def output_format(kind: Kind) -> Kind:
    """Register an output format: a class with `name`, `suffix` and `render(document)`."""
    _FORMATS[kind.name] = kind()  # type: ignore[attr-defined]
    return kind


def formats() -> Mapping[str, Any]:
    """Return all output formats by name."""
    discover(symobs.FORMAT_PACKAGE)
    return _FORMATS


def render(document: Any, format_name: str) -> str | bytes:
    """Return a document in a format, or the answers that are to be printed alone.

    Raises `UsageError` naming the formats that exist, or those that print answers alone or are programs.
    """
    chosen = format_named(format_name)
    if document.period is not None and not hasattr(chosen, "is_program"):
        _refuse("a period belongs to a program", "--period", "is_program")
    if document.printed and not hasattr(chosen, "answers"):
        _refuse(f"{format_name} prints no answers alone", "--print", "answers")
    rendered: str | bytes = chosen.answers(document) if document.printed else chosen.render(document)
    return rendered


def _refuse(message: str, where: str, having: str) -> NoReturn:
    """Raise `UsageError` naming the formats that have an attribute."""
    names = ", ".join(sorted(name for name, found in formats().items() if hasattr(found, having)))
    raise UsageError(message, where=where, repair=f"use --format with one of {names}")


def format_named(name: str) -> Any:
    """Return a format; raises `UsageError` naming those that exist.

    A module with the format's name is looked at first, so that a run which needs one format does not pay for all.
    """
    import_named(symobs.FORMAT_PACKAGE, name)
    if name not in _FORMATS and name not in formats():
        message = f"{name[:40]!r} is not an output format"
        meant = [
            found
            for found in sorted(_FORMATS, key=lambda each: (each != "latex", each))
            if _FORMATS[found].suffix == f".{name}"
        ]
        nearest = f"did you mean {meant[0]}? " if meant else ""
        raise UsageError(message, repair=f"{nearest}use one of {', '.join(sorted(_FORMATS))}")
    return _FORMATS[name]


def discover(package: str) -> None:
    """Import every module of a package and of its folders, once: of what was interrupted the rest follows next time."""
    if package not in _DISCOVERED:
        for name in _modules(package):
            importlib.import_module(name)
        _DISCOVERED.add(package)


@lru_cache(maxsize=8)
def _modules(package: str) -> tuple[str, ...]:
    """Return the modules of a package and of its folders by dotted name, without importing them."""
    return tuple(name for path in importlib.import_module(package).__path__ for name in _below(path, package))


def _below(folder: str, package: str) -> Iterator[str]:
    for found in pkgutil.iter_modules([folder]):
        name = f"{package}.{found.name}"
        if found.ispkg:
            yield from _below(f"{folder}/{found.name}", name)
        else:
            yield name


def import_named(package: str, name: str) -> None:
    """Import the modules of this name below a package, wherever they lie."""
    for found in _modules(package):
        if found.rpartition(".")[2] == name:
            importlib.import_module(found)
