"""Results as a convention writes them: the names and signs of its letters, for answers, expectations and input.

A name of the standard convention that a convention uses for nothing else keeps its standard meaning.
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import cached_property
from typing import TYPE_CHECKING, Any, TypeAlias

from symobs.exact import Matrix
from symobs.ground.dataclass import dataclass

if TYPE_CHECKING:
    from symobs.formula.convention import Convention
    from symobs.system import StateSpace
    from symobs.system.conditions import Condition
    from symobs.tasks.result.result import Result

#: The fields that hold a letter's value: gains everywhere, and the matrices of a reduced-order observer in its task.
_GAINS = {"K": "K", "L": "L"}
_OF_OBSERVER = {"F": "F_z", "G": "G_z", "H": "H_z", "M": "M_z"}


def names_in(convention: Convention, task: str = "", *, reduced: bool = False) -> dict[str, tuple[str, int]]:
    """Return the names of letter fields in a convention: its name → (standard name, sign of its value)."""
    letters = _GAINS | (_OF_OBSERVER if task == "reduced_order_observer" else {})
    written = convention.written(reduced=reduced)
    return {
        written.get(letter, name): (name, -1 if letter in convention.turned else 1) for name, letter in letters.items()
    }


@dataclass
class ResultInConvention:
    """A result in the names and signs of a convention."""

    result: Result
    convention: Convention

    @cached_property
    def names(self) -> dict[str, tuple[str, int]]:
        """The convention's names of those fields that the result has."""
        named = names_in(self.convention, self.task, reduced=self.result.has_reduced_observer)
        return {own: (name, sign) for own, (name, sign) in named.items() if name in self.result.fields}

    @property
    def task(self) -> str:
        """The result's task."""
        return self.result.task

    @property
    def verdict(self) -> str:
        """The result's verdict."""
        return self.result.verdict

    @property
    def plant(self) -> StateSpace:
        """The result's plant."""
        return self.result.plant

    @property
    def claimed(self) -> tuple[str, ...]:
        """The result's fields that many values meet."""
        return self.result.claimed

    @property
    def in_time(self) -> bool:
        """Whether the answers are functions of time."""
        return self.result.in_time

    @property
    def argument(self) -> str:
        """What the answers are functions of."""
        return self.result.argument

    @property
    def holds_where(self) -> tuple[Condition, ...]:
        """The result's conditions."""
        return self.result.holds_where

    @cached_property
    def fields(self) -> Mapping[str, Any]:
        """The fields in the convention's names and signs, and in standard ones where these mean nothing else."""
        return {**self.result.fields, **self.renamed_fields}

    @cached_property
    def numbers(self) -> Mapping[str, Any]:
        """The fields as programs use them."""
        return {**self.result.numbers, **self._own(self.result.numbers)}

    @cached_property
    def renamed_fields(self) -> Mapping[str, Any]:
        """The fields in the convention's names and signs."""
        return self._own(self.result.fields)

    @cached_property
    def answer(self) -> Mapping[str, Any]:
        """The answers, named as the fields are."""
        return {**self.result.answer, **self._own(self.result.answer)}

    def _own(self, values: Mapping[str, Any]) -> dict[str, Any]:
        standard = {name: (own, sign) for own, (name, sign) in self.names.items()}
        return {
            standard.get(name, (name, 1))[0]: self._signed(value, standard.get(name, (name, 1))[1])
            for name, value in values.items()
        }

    def _signed(self, value: Any, sign: int) -> Any:
        """Return a value with its sign; a family is a gain of its own."""
        if isinstance(value, Mapping):
            return self._own(value)
        return -value if sign < 0 and isinstance(value, Matrix) else value

    def standard(self, name: str) -> tuple[str, int]:
        """Return the standard name and the sign of a field; a standard name that means nothing else is its own."""
        return self.names.get(name, (name, 1))

    def letter_of(self, name: str) -> str:
        """Return what the convention calls a field."""
        return next((own for own, (standard, _) in self.names.items() if standard == name), name)

    def with_answer(self, name: str, value: Any) -> ResultInConvention:
        """Return the result with another answer; raises `CertificateRejected` unless it holds too."""
        own, sign = self.standard(name)
        return ResultInConvention(self.result.with_answer(own, self._signed(value, sign)), self.convention)


#: Whatever has answers to hold against others.
Answered: TypeAlias = "Result | ResultInConvention"
