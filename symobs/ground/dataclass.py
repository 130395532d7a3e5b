"""The standard library's `dataclass` for classes that are made at every start: the same, in a twentieth of the time.

A page needs some 140 classes of named parts.  The standard library writes and compiles six functions for each, which
together takes as long as all the mathematics of a small page; here they are closures over the names, and nothing is
compiled.  `dataclasses.replace` and `dataclasses.fields` work on what is made here.
"""

from __future__ import annotations

import dataclasses
from operator import attrgetter
from typing import TYPE_CHECKING, Any, TypeVar, dataclass_transform, overload

if TYPE_CHECKING:
    from collections.abc import Callable

__all__ = ["dataclass"]

Class = TypeVar("Class", bound=type)

_MISSING = dataclasses.MISSING
#: Where a class keeps whether it is compared and written part by part.
_OPTIONS = "__compared_and_written__"
#: Where an object keeps its hash.
_HASH = "__hash_of_parts__"
_PART: Any = vars(dataclasses)["_FIELD"]  # by this mark `replace` and `fields` know a part


@overload
def dataclass(cls: Class) -> Class: ...
@overload
def dataclass(*, frozen: bool = True, eq: bool = True, repr: bool = True) -> Callable[[Class], Class]: ...
@dataclass_transform(frozen_default=True, field_specifiers=(dataclasses.field,))
def dataclass(cls: Any = None, *, frozen: bool = True, eq: bool | None = None, repr: bool | None = None) -> Any:  # noqa: A002
    """Give a class the methods that its annotated parts call for; the options are those of the standard library.

    Where nothing else is said data are frozen, and compared and written like those of the base.
    """

    def make(cls: Any) -> Any:
        bases = (vars(base).get(_OPTIONS) for base in cls.__mro__[1:])
        usual = next(filter(None, bases), (True, True))
        is_compared, is_written = (u if given is None else given for u, given in zip(usual, (eq, repr), strict=True))
        parts = _parts(cls)
        by_place = tuple(name for name, part in parts.items() if part.init and not part.kw_only)
        methods: dict[str, Any] = {"__dataclass_fields__": parts, "__match_args__": by_place}
        methods["__init__"] = _initialiser(cls, parts, by_place)
        methods[_OPTIONS] = is_compared, is_written
        if is_compared:
            methods |= _comparison(parts, hashed=frozen)
        if is_written:
            methods["__repr__"] = _written
        if frozen:
            methods |= {"__setattr__": _refuse, "__delattr__": _refuse}
        own = vars(cls)
        if "__eq__" in own and own["__hash__"] is None:  # Python's doing, not the author's
            del cls.__hash__
        for name in methods.keys() - own.keys():
            setattr(cls, name, methods[name])
        return cls

    return make if cls is None else make(cls)


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
    """Return `__eq__`, and `__hash__` where data are frozen: two of the same class are compared part by part.

    A hash is kept beside the parts, but not when they are copied or sent to another process, where texts hash otherwise.
    """
    compared = _values_of([name for name, part in parts.items() if part.compare])
    told = _values_of([name for name, part in parts.items() if (part.compare if part.hash is None else part.hash)])

    def equal(self: Any, other: object) -> Any:
        if self is other:
            return True
        return compared(self) == compared(other) if other.__class__ is self.__class__ else NotImplemented

    def hash_of(self: Any) -> int:
        own = self.__dict__
        if _HASH not in own:
            own[_HASH] = hash(told(self))
        found: int = own[_HASH]
        return found

    if not hashed:
        return {"__eq__": equal, "__hash__": None}
    return {"__eq__": equal, "__hash__": hash_of, "__getstate__": _without_hash}


def _without_hash(self: Any) -> dict[str, Any]:
    return {name: value for name, value in self.__dict__.items() if name != _HASH}


def _values_of(names: list[str]) -> Callable[[Any], Any]:
    return attrgetter(*names) if names else lambda _: ()


def _written(self: Any) -> str:
    parts = ", ".join(
        f"{name}={getattr(self, name)!r}" for name, part in self.__dataclass_fields__.items() if part.repr
    )
    return f"{type(self).__qualname__}({parts})"


def _refuse(self: Any, name: str, *_: object) -> None:
    raise dataclasses.FrozenInstanceError(f"{type(self).__qualname__}.{name} cannot be changed")
