"""The standard library's `dataclass` for classes that are made at every start: the same, in a twentieth of the time.

A page needs some 140 classes of named parts.  The standard library writes and compiles six functions for each, which
together takes as long as all the mathematics of a small page; here they are closures over the names, and nothing is
compiled.  `dataclasses.replace` and `dataclasses.fields` work on what is made here.
"""

from __future__ import annotations

import dataclasses
from operator import attrgetter
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable
    from dataclasses import dataclass

__all__ = ["dataclass"]

_MISSING = dataclasses.MISSING
_PART: Any = vars(dataclasses)["_FIELD"]  # by this mark `replace` and `fields` know a part


def _dataclass(*, frozen: bool = False, eq: bool = True, repr: bool = True) -> Callable[[Any], Any]:  # noqa: A002
    """Give a class the methods that its annotated parts call for; the options are those of the standard library."""

    def make(cls: Any) -> Any:
        parts = _parts(cls)
        by_place = tuple(name for name, part in parts.items() if part.init and not part.kw_only)
        methods: dict[str, Any] = {"__dataclass_fields__": parts, "__match_args__": by_place}
        methods["__init__"] = _initialiser(cls, parts, by_place)
        if eq:
            methods |= _comparison(parts, hashed=frozen)
        if repr:
            methods["__repr__"] = _written
        if frozen:
            methods |= {"__setattr__": _refuse, "__delattr__": _refuse}
        own = vars(cls)
        if "__eq__" in own and own["__hash__"] is None:  # Python's doing, not the author's
            del cls.__hash__
        for name in methods.keys() - own.keys():
            setattr(cls, name, methods[name])
        return cls

    return make


def _parts(cls: Any) -> dict[str, Any]:
    """Return the named parts of a class, those of its bases first; a default stays on the class."""
    found: dict[str, Any] = {}
    for base in reversed(cls.__mro__[1:]):
        found |= vars(base).get("__dataclass_fields__", {})
    for name, annotation in cls.__annotations__.items():
        if annotation.startswith("ClassVar"):
            continue
        given = vars(cls).get(name, _MISSING)
        part: Any = given if isinstance(given, dataclasses.Field) else dataclasses.field(default=given)
        part.name, part.type, part._field_type, part.kw_only = name, annotation, _PART, part.kw_only is True  # noqa: SLF001
        if part.default is not _MISSING:
            setattr(cls, name, part.default)
        elif part is given:
            delattr(cls, name)
        found[name] = part
    return found


def _initialiser(cls: Any, parts: dict[str, Any], names: tuple[str, ...]) -> Callable[..., None]:
    """Return `__init__`, which takes the parts by place, as `names` go, or by name."""
    taken = [name for name, part in parts.items() if part.init]
    defaults = {name: part.default for name, part in parts.items() if part.default is not _MISSING}
    factories = {name: part.default_factory for name, part in parts.items() if part.default_factory is not _MISSING}
    needed = set(taken) - defaults.keys() - factories.keys()
    put = object.__setattr__
    count, finish = len(names), getattr(cls, "__post_init__", None)
    all_by_place = count == len(parts)

    def complete(values: tuple[Any, ...], named: dict[str, Any]) -> Iterable[tuple[str, Any]]:
        given = dict(zip(names, values, strict=False))
        twice = given.keys() & named.keys()
        given |= named
        if len(values) > count or twice or given.keys() - set(taken) or needed - given.keys():
            raise TypeError(f"{cls.__qualname__} takes {', '.join(taken)}, not {', '.join(given)}")
        made = {name: make() for name, make in factories.items() if name not in given}
        return (defaults | made | given).items()

    def initialise(self: Any, *values: Any, **named: Any) -> None:
        if all_by_place and len(values) == count and not named:
            given: Iterable[tuple[str, Any]] = zip(names, values, strict=True)
        else:
            given = complete(values, named)
        for name, value in given:
            put(self, name, value)
        if finish is not None:
            finish(self)

    return initialise


def _comparison(parts: dict[str, Any], *, hashed: bool) -> dict[str, Any]:
    """Return `__eq__` and `__hash__`: two of the same class are compared part by part."""
    compared = _values_of([name for name, part in parts.items() if part.compare])
    told = _values_of([name for name, part in parts.items() if (part.compare if part.hash is None else part.hash)])

    def equal(self: Any, other: object) -> Any:
        return compared(self) == compared(other) if other.__class__ is self.__class__ else NotImplemented

    def hash_of(self: Any) -> int:
        return hash(told(self))

    return {"__eq__": equal, "__hash__": hash_of if hashed else None}


def _values_of(names: list[str]) -> Callable[[Any], Any]:
    return attrgetter(*names) if names else lambda _: ()


def _written(self: Any) -> str:
    parts = ", ".join(
        f"{name}={getattr(self, name)!r}" for name, part in self.__dataclass_fields__.items() if part.repr
    )
    return f"{type(self).__qualname__}({parts})"


def _refuse(self: Any, name: str, *_: object) -> None:
    raise dataclasses.FrozenInstanceError(f"{type(self).__qualname__}.{name} cannot be changed")


if not TYPE_CHECKING:
    dataclass = _dataclass
