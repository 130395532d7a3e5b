"""What checking, the screen, variants and export ask of a task: it stands on the type of its results, and nowhere else."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, ClassVar, Self

from symobs.exact import Matrix
from symobs.exact.core.generators import substitute
from symobs.ground.errors import CertificateRejected
from symobs.system.specification import in_common_field
from symobs.tasks.result.output_methods import OutputMethods

if TYPE_CHECKING:
    from collections.abc import Collection, Iterable, Mapping

    from symobs.exact import Scalar
    from symobs.system import StateSpace


class TaskTraits(OutputMethods):
    """The fields of a task that are asked for, its gains, its letters, and what follows from other gains."""

    #: The fields that answer the task; none means its verdict.
    answered_by: ClassVar[tuple[str, ...]] = ()
    #: The fields that answer it where the specification gives all of these.
    answered_where_given: ClassVar[tuple[str, ...]] = ()
    #: The gains: each is right where its claim holds, those that are one only together, and the other fields follow.
    gains: ClassVar[tuple[str, ...]] = ()
    gains_are_one: ClassVar[bool] = False
    #: Fields besides gains that many values meet, given the gains: their claim decides.
    claimed: ClassVar[tuple[str, ...]] = ()
    #: A field A − L C, or T A − L C, from which a gain L follows.
    shows_gain: ClassVar[str] = ""
    #: Fields of which one value is right, whatever else is answered: a grader outside symobs compares it.
    only_value: ClassVar[tuple[str, ...]] = ()
    #: Earlier parts besides gains, in their order, from which other fields follow.
    leads: ClassVar[tuple[str, ...]] = ()
    #: Fields that are right in many coordinates.
    in_coordinates: ClassVar[tuple[str, ...]] = ()
    #: What a page calls a function of time, without spaces and signs of products, and its field.
    functions_of_time: ClassVar[Mapping[str, str]] = {}
    #: What a field with a card is called, a letter, det O or A - B K; the cards open at first, all where none are named.
    letters: ClassVar[Mapping[str, str]] = {}
    cards: ClassVar[tuple[str, ...]] = ()
    #: What the screen shows above the cards.
    panels: ClassVar[tuple[str, ...]] = ()

    @property
    def as_plant(self) -> StateSpace | None:
        """The plant that the answer is, in other coordinates or times; None for any other answer.

        Raises `InputError` where there is none.
        """
        return None

    @property
    def called(self) -> Mapping[str, str]:
        """The fields by what a page calls them, without spaces and signs of products."""
        return self.functions_of_time

    @property
    def named_data(self) -> Mapping[str, Any]:
        """The data and answers of the task by the letters of its equations, such as Q and R; they go before the plant's."""
        return {}

    @property
    def loop_matrix(self) -> Matrix | None:
        """The closed loop of an answer whose poles are found and not asked for; None for any other answer."""
        return None

    @classmethod
    def fields_asked(cls, given: Collection[str]) -> tuple[str, ...]:
        """Return the fields that are asked for where the specification has these keys; none means the verdict."""
        return tuple(name for name in cls.answered_by if name not in given) or cls.answered_where_given

    def has_one_value(self, name: str) -> bool:
        """Whether one value of a field is right."""
        return name in self.only_value

    def __dir__(self) -> Iterable[str]:
        """List what users ask for: these are of the task, and not of its answer."""
        return [name for name in super().__dir__() if name not in TaskTraits.__annotations__]

    def with_answer(self, name: str, value: object) -> Self:
        """Return the same result with one answer replaced; raises `CertificateRejected` unless it holds too."""
        raise NotImplementedError

    def with_gains(self, gains: Mapping[str, Matrix]) -> Self:
        """Return the result with other gains; raises `CertificateRejected` unless they meet their claim."""
        found = self
        for name, gain in gains.items():
            found = found.with_answer(name, gain)
        return found

    def with_gains_of(self, main: Any, values: Mapping[str, Scalar]) -> Self:
        """Return the result with the gains of the main line at values of its parameters, where they serve here."""
        found = self
        for letters in [main.gains] if main.gains_are_one else [(letter,) for letter in main.gains]:
            chosen = {letter: main.fields.get(letter) for letter in letters}
            here = {letter: found.fields.get(letter) for letter in letters}
            if not all(isinstance(gain, Matrix) for gain in (*chosen.values(), *here.values())):
                continue
            try:
                _, kept = in_common_field(found.plant, *(substitute(gain, values) for gain in chosen.values()))
                gains = dict(zip(letters, kept, strict=True))
                if gains != here and all(map(found.plant.admits, kept)):
                    found = found.with_gains(gains)
            except (ZeroDivisionError, CertificateRejected):  # it divides by zero here, or serves in general only
                continue
        return found

    def following_from(self, gains: Mapping[str, Matrix]) -> Self:  # noqa: ARG002 - for those that have gains
        """Return what follows from given gains, wherever they place the poles."""
        return self

    def consequences(self, given: Mapping[str, Any]) -> Mapping[str, Any]:  # noqa: ARG002 - for those with `leads`
        """Return the fields that follow from given values of earlier parts, right or wrong."""
        return {}

    def design_of(self, gain: str) -> Any:
        """Return the design that owns the claim of a gain."""
        raise KeyError(gain)
