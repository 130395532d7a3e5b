"""Classes of named parts behave as those of the standard library: each case is made both ways and asked the same."""

from __future__ import annotations

import dataclasses
import pickle
from functools import cached_property, partial
from pathlib import Path
from typing import Any, ClassVar

import pytest

import symobs.ground.dataclass as ours
from tests.contracts.test_floors import SOURCES
from tests.kit import tables

MAKERS = {"symobs": ours.dataclass, "library": dataclasses.dataclass}


def made(by: Any) -> dict[str, Any]:
    """Return classes of every kind the project has, made by one of the two."""

    @by(frozen=True)
    class Point:
        x: int
        y: int = 2
        kind: ClassVar[str] = "point"

        @cached_property
        def total(self) -> int:
            return self.x + self.y

    @by(frozen=True)
    class Named(Point):
        name: str = dataclasses.field(default="p", kw_only=True)
        seen: dict[str, int] = dataclasses.field(default_factory=dict, hash=False)
        note: str = dataclasses.field(default="", compare=False, repr=False)

    @by(frozen=True)
    class Finished:
        value: int
        doubled: int = dataclasses.field(init=False)

        def __post_init__(self) -> None:
            if self.value < 0:
                raise ValueError("negative")
            object.__setattr__(self, "doubled", 2 * self.value)

    @by(frozen=False)
    class Open:
        items: list[int] = dataclasses.field(default_factory=list)

    @by(frozen=True, eq=False, repr=False)
    class Single:
        value: int

    @by(frozen=True)
    class Own:  # noqa: PLW1641 - frozen gives it the hash of its parts
        value: int

        def __eq__(self, other: object) -> bool:
            return isinstance(other, Own) and self.value % 3 == other.value % 3

        def __repr__(self) -> str:
            return "own"

    @by(frozen=True)
    class Empty:
        pass

    return {kind.__name__: kind for kind in (Point, Named, Finished, Open, Single, Own, Empty)}


CALLS = tables(Path(__file__))["calls"]


def result(call: Any) -> Any:
    """Return what a call gives, or the type of what it raises."""
    try:
        return call()
    except (TypeError, ValueError, AttributeError) as raised:
        return type(raised)


def told(item: Any) -> Any:
    """Return what can be seen of an object, without its place in memory."""
    if isinstance(item, type):
        return item
    parts = [(part.name, getattr(item, part.name), part.init, part.kw_only) for part in dataclasses.fields(item)]
    seen = None if type(item).__name__ == "Single" else repr(item)
    hashed = isinstance(result(lambda: hash(item)), int)
    return type(item).__name__, parts, seen, type(item).__match_args__, hashed


def test_objects_are_made_and_seen_alike() -> None:
    ours, theirs = (made(by) for by in MAKERS.values())
    for name, values, named in CALLS:
        pair = [told(result(partial(kind, *values, **named))) for kind in (ours[name], theirs[name])]
        assert pair[0] == pair[1], (name, values, named)


@pytest.mark.parametrize("by", MAKERS)
def test_what_is_frozen_stays(by: str) -> None:
    point = made(MAKERS[by])["Point"](1)
    with pytest.raises(dataclasses.FrozenInstanceError):
        point.x = 5
    with pytest.raises(dataclasses.FrozenInstanceError):
        del point.x
    assert point.total == 3
    assert (point.x, point.kind) == (1, "point")


@ours.dataclass
class Kept:
    """At the top of a module, since only such a class is pickled."""

    value: int
    text: str = "t"


def test_objects_are_pickled_and_matched() -> None:
    kept = Kept(3)
    hash(kept)  # which another process would not give to the same text
    other = pickle.loads(pickle.dumps(kept))  # noqa: S301 - our own bytes
    assert (other, vars(other)) == (kept, {"value": 3, "text": "t"})
    match Kept(3, "u"):
        case Kept(value, text):
            assert (value, text) == (3, "u")


def test_every_class_of_parts_is_made_this_way() -> None:
    wrong = [path for path in SOURCES if "from dataclasses import dataclass" in path.read_text("utf-8")]
    assert wrong == []


def test_parts_are_compared_and_written_as_those_of_the_base() -> None:
    @ours.dataclass(eq=False, repr=False)
    class Single:
        value: int

    @ours.dataclass
    class Further(Single):
        more: int

    @ours.dataclass(eq=True, repr=True)
    class Alike(Further):
        pass

    assert Further(1, 2) != Further(1, 2)
    assert "value=" not in repr(Further(1, 2))
    assert Alike(1, 2) == Alike(1, 2)
    assert repr(Alike(1, 2)).endswith("Alike(value=1, more=2)")
    assert hash(Alike(1, 2)) == hash(Alike(1, 2))
