"""Values by name, each found when it is asked for."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator


class OnDemand(Mapping[str, Any]):
    """A mapping whose values are found when they are first asked for."""

    def __init__(self, found: Mapping[str, Callable[[], Any]]) -> None:
        self._found = found
        self._known: dict[str, Any] = {}

    def __getitem__(self, name: str) -> Any:
        if name not in self._known:
            self._known[name] = self._found[name]()
        return self._known[name]

    def __contains__(self, name: object) -> bool:
        return name in self._found

    def __iter__(self) -> Iterator[str]:
        return iter(self._found)

    def __len__(self) -> int:
        return len(self._found)

    def __repr__(self) -> str:
        return f"{{{', '.join(f'{name!r}: {value!r}' for name, value in self.items())}}}"

    def __or__(self, further: Mapping[str, Any]) -> dict[str, Any]:
        return {**self, **further}

    def __ror__(self, further: Mapping[str, Any]) -> dict[str, Any]:
        return {**further, **self}

    def __reduce__(self) -> tuple[object, ...]:
        return dict, (dict(self),)

    def with_further(self, found: Mapping[str, Callable[[], Any]]) -> OnDemand:
        """Return this with further values that are found when they are asked for."""
        return OnDemand({**self._found, **found})
