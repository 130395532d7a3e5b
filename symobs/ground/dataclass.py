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
    from collections.abc import Callable
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
    taken = (*names, *(name for name, part in parts.items() if part.init and part.kw_only))
    defaults = {name: part.default for name, part in parts.items() if part.default is not _MISSING}
    made = [(name, part.default_factory) for name, part in parts.items() if part.default_factory is not _MISSING]
    most, total = len(names), len({*taken, *defaults, *(name for name, _ in made)})
    open_to_names = [frozenset(taken) - set(names[:count]) for count in range(most + 1)]
    rests = [{name: defaults[name] for name in names[count:] if name in defaults} for count in range(most + 1)]
    whole = [most == total and count + len(rest) == most for count, rest in enumerate(rests)]
    finish = getattr(cls, "__post_init__", None)

    def initialise(self: Any, *values: Any, **named: Any) -> None:
        own = self.__dict__  # a frozen class refuses to be written to in any other way
        count = len(values)
        if not named and count <= most and whole[count]:
            for name, value in zip(names, values):  # noqa: B905 - as many as were counted; the quickest way by far
                own[name] = value
            if count < most:
                own.update(rests[count])
            if finish is not None:
                finish(self)
            return
        if defaults:
            own.update(defaults)
        for name, value in zip(names, values):  # noqa: B905 - how many there are is looked at below
            own[name] = value
        if named:
            own.update(named)
        for name, make in made:
            if name not in own:
                own[name] = make()
        if count > most or len(own) != total or not named.keys() <= open_to_names[count]:
            given = ", ".join((*map(repr, values), *named))
            raise TypeError(f"{cls.__qualname__} takes {', '.join(taken)}, not {given}")
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
