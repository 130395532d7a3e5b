"""Terms written out in the language of a system, every shared part once."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from tests.programs.campaign.algebra import Term

#: How an operation is written: from the term and its parts as written.
Writer = Callable[[Any, list[str]], str]


class Unsupported(Exception):
    """A system has no way to be asked this."""


@dataclass(frozen=True)
class Language:
    """How scalars, matrices of texts and every operation are written, and how a name is given to a part."""

    scalar: Callable[[str], str]
    matrix: Callable[[list[list[str]]], str]
    operations: Mapping[str, Writer]
    assigned: Callable[[str, str], str]


@dataclass
class Sheet:
    """The parts of one question, in order, each with a name."""

    language: Language
    lines: list[str] = field(default_factory=list)
    _names: dict[int, str] = field(default_factory=dict)
    _kept: list[Term] = field(default_factory=list)

    def write(self, term: Term) -> str:
        """Return the text of a term; what is no plain scalar gets a name."""
        if id(term) in self._names:
            return self._names[id(term)]
        match term.operation:
            case "scalar":
                text = self.language.scalar(term.parts[0])
            case "matrix":
                text = self.language.matrix([[self.language.scalar(entry) for entry in row] for row in term.parts])
            case operation:
                writer = self.language.operations.get(operation)
                if writer is None:
                    raise Unsupported(operation)
                parts = [self.write(part) for part in term.parts if hasattr(part, "operation")]
                text = writer(term, parts)
        if term.operation != "scalar":
            name = f"v{len(self._names)}"
            self.lines.append(self.language.assigned(name, text))
            text = name
        self._names[id(term)] = text
        # A name stands for an object: it has to live as long as the sheet.
        self._kept.append(term)
        return text
