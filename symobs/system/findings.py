"""Memory of one problem: the plant and the answer on every stratum, each computed once, within a budget."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

if TYPE_CHECKING:
    from collections.abc import Callable, Hashable

#: What may be spent on the strata of one problem: an elimination of a rank costs one, an answer one and one for each of the
#: first terms of its equations.  The same is spent on every machine; what is left of the strata then is undecided.
_BUDGET = 2_000


class _Failed(NamedTuple):
    """A failure, kept with its error."""

    reason: Exception


class Findings:
    """A table that the plants of all strata of one problem share; it is freed with them.

    Two threads may find the same at the same time: what is kept is the first, and both have equal values.
    """

    def __init__(self) -> None:
        """Start with nothing found."""
        self._found: dict[Hashable, Any] = {}
        self.left = _BUDGET

    @property
    def are_over(self) -> bool:
        """Whether the budget is spent; the remaining strata are undecided."""
        return self.left <= 0

    def spend(self, cost: int) -> None:
        """Take away what something cost."""
        self.left -= cost

    def once(self, key: Hashable, cost: int, find: Callable[[], Any]) -> Any:
        """Return the value stored under a key, or compute it at this cost; a failure is stored, too."""
        known = self._found.get(key)
        if known is None:
            self.spend(cost)
            try:
                known = find()
            except Exception as error:  # noqa: BLE001 - it is raised again
                known = _Failed(error)
            known = self._found.setdefault(key, known)
        if isinstance(known, _Failed):
            raise known.reason.with_traceback(None)
        return known

    def same(self, value: Any) -> Any:
        """Return the first stored value equal to this one, so that later comparisons are by identity."""
        return self._found.setdefault(("value", value), value)
