"""One variant: a problem of its own, with its answers and its profile."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

from symobs.applications.variants.reading.substitution import toml_text

if TYPE_CHECKING:
    from collections.abc import Mapping


class Variant(NamedTuple):
    """A problem of its own: solved, checked, and like the others in what it takes to work it out."""

    number: int
    id: str
    candidate: int
    data: Mapping[str, Any]
    answers: list[Any]
    profile: Mapping[str, Any]
    expect: Mapping[str, Any]

    @property
    def name(self) -> str:
        """The name of its file."""
        return f"v{self.number:03d}"

    @property
    def text(self) -> str:
        """The problem file: numbers in place, and the checked answers as what is expected."""
        return toml_text({**self.data, "variant": self.id, "expect": self.expect})

    @property
    def certificates(self) -> int:
        """How many claims were checked for it."""
        return sum(len(answer["certificates"]) for answer in self.answers)

    def as_data(self) -> dict[str, Any]:
        """Return it as JSON."""
        return {
            "id": self.id,
            "file": f"variants/{self.name}.toml",
            "candidate": self.candidate,
            "data": dict(self.data),
            "answers": dict(self.expect),
            "profile": {key: self.profile[key] for key in ("load", "peak", "fractions", "lines")},
            "certificates": self.certificates,
        }
