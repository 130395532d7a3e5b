"""What is found in packages written for the purpose, and what is imported on the way to it."""

from __future__ import annotations

import importlib
import sys
from typing import TYPE_CHECKING, Any

import pytest

import symobs
from symobs.ground.errors import InputError, UsageError
from symobs.tasks.result import (
    choose,
    format_named,
    formats,
    method,
    registry,
    task_named,
    tasks,
    writers,
)

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

#: Two packages with tasks and one with formats, of two modules each: one that is called like what it holds, one that is not.
MODULES = {
    "tasks_of_one.first": """
from symobs.tasks.result import method, task

@task
def first(plant, *more, of: "Of | None" = None):
    "The first."
    return (plant, *more, of)

@method("first/way", source="here")
def way():
    "A way."

@method("first/other", source="here")
def other():
    "Another."
""",
    "tasks_of_one.more": """
from symobs.tasks.result import method, task

@task
def third(plant):
    "The third."

@method("third/way", source="there")
def third_way():
    "Its way."
""",
    "tasks_of_two.second": """
from symobs.tasks.result import task, task_in_time

@task
def second(plant):
    "The second."

@task_in_time
def fourth(plant):
    "The fourth."
""",
    "formats_of_three.plain": """
from symobs.tasks.result import output_format

@output_format
class Plain:
    name = "plain"
    suffix = ".plain"
""",
    "formats_of_three.others": """
from symobs.tasks.result import output_format

@output_format
class Odd:
    name = "odd"
    suffix = ".odd"
""",
}
PACKAGES = {name.split(".")[0] for name in MODULES}


@pytest.fixture(autouse=True)
def packages(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    """Let nothing be registered, and all of these be there to be found."""
    for name, text in MODULES.items():
        package, module = name.split(".")
        (tmp_path / package).mkdir(exist_ok=True)
        (tmp_path / package / "__init__.py").touch()
        (tmp_path / package / f"{module}.py").write_text(text, "utf-8")
    monkeypatch.syspath_prepend(tmp_path)
    monkeypatch.setattr(symobs, "TASK_PACKAGES", ("tasks_of_one", "tasks_of_two"))
    monkeypatch.setattr(symobs, "FORMAT_PACKAGE", "formats_of_three")
    for name, empty in (("_TASKS", {}), ("_METHODS", {}), ("_FORMATS", {}), ("_IN_TIME", []), ("_DISCOVERED", set())):
        monkeypatch.setattr(registry if hasattr(registry, name) else writers, name, empty)
    yield
    for name in [name for name in sys.modules if name.split(".")[0] in PACKAGES]:
        del sys.modules[name]
    importlib.invalidate_caches()


def imported() -> set[str]:
    """Return the modules of these packages that were imported."""
    return sys.modules.keys() & MODULES.keys()


ONE, TWO = {"tasks_of_one.first", "tasks_of_one.more"}, {"tasks_of_two.second"}
THREE = {"formats_of_three.plain", "formats_of_three.others"}


def test_all_tasks_are_found() -> None:
    assert list(tasks()) == ["first", "third", "second", "fourth"]
    assert imported() == ONE | TWO


def test_a_task_that_has_a_module_of_its_name_costs_no_other() -> None:
    for name, module in (("first", "tasks_of_one.first"), ("second", "tasks_of_two.second")):
        before = imported()
        found = task_named(name)
        assert found is not None
        assert found.name == name
        assert imported() == {*before, module}


def test_any_other_task_is_found_among_all() -> None:
    found = task_named("third")
    assert found is not None
    assert found.summary == "The third."
    assert task_named("no-name") is None


def test_a_method_is_looked_for_where_it_is_not_known(monkeypatch: pytest.MonkeyPatch) -> None:
    assert choose("first", "way", "other").summary == "A way."
    assert choose("first", "auto", "other").summary == "Another."
    with pytest.raises(InputError) as caught:
        choose("first", "third", "way")
    assert caught.value.repair == "write one of auto, way, other"

    @method("own/known", source="")
    def known() -> Any: ...

    monkeypatch.setattr(registry, "tasks", lambda: pytest.fail("it is known"))
    assert choose("own", "known", "").solve.__name__ == "known"


def test_formats_are_found() -> None:
    assert format_named("plain") is writers._FORMATS["plain"]
    assert imported() == {"formats_of_three.plain"}
    assert format_named("odd").name == "odd"
    assert imported() == THREE
    assert list(formats()) == ["plain", "odd"]
    with pytest.raises(UsageError, match="'even' is not an output format; use one of odd, plain"):
        format_named("even")
