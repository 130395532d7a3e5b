"""What a format renders: results under a title, and how all is told and set."""

from __future__ import annotations

from dataclasses import field
from functools import cached_property
from typing import TYPE_CHECKING, Any

from symobs._dataclass import dataclass
from symobs.convention import STANDARD
from symobs.derivation import translated
from symobs.result.web_page import PLAIN

if TYPE_CHECKING:
    from pathlib import Path

    from symobs.convention import Convention
    from symobs.derivation import Derivation
    from symobs.result.result import Result
    from symobs.result.web_page import WebPage


@dataclass(frozen=True)
class Document:
    """What a format renders: a title, its source, results, the problem in words, and how all is told and set."""

    title: str
    source: str
    results: tuple[Result, ...]
    convention: Convention = STANDARD
    text: str = ""
    detail: str = field(default="full", kw_only=True)
    #: The code of the language of the page.
    language: str = field(default="en", kw_only=True)
    templates: Path | None = field(default=None, kw_only=True)
    #: For a format that is a program: the sampling period, and how the input is held.
    period: object = field(default=None, kw_only=True)
    hold: str = field(default="zoh", kw_only=True)
    #: The answers that are printed alone, by name; none means the whole document.
    printed: tuple[str, ...] = field(default=(), kw_only=True)
    #: The significant digits of the numbers on a page: 0 writes them exactly, None does as the data are typed.
    digits: int | None = field(default=None, kw_only=True)
    #: What a sheet adds to each part of a question: its points, in words, and the room for an answer.
    handout: tuple[Any, ...] = field(default=(), kw_only=True)
    #: What a page of HTML offers besides its text.
    web: WebPage = field(default=PLAIN, kw_only=True)

    @cached_property
    def derivations(self) -> tuple[Derivation, ...]:
        """The checked derivations of the results, in the signs of the convention."""
        return tuple(translated(result.derivation, self.convention) for result in self.results)
