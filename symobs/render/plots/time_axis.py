"""Courses over time: where they stand on paper, and how a terminal shows them."""

from __future__ import annotations

from typing import TYPE_CHECKING

from symobs.formula import Letter

if TYPE_CHECKING:
    from symobs.figures.plot import Response, TimeResponse
    from symobs.formula import Formula

#: Height of the frame, in points.
HEIGHT = 90.0
#: What a terminal draws with, response by response.
CHARACTERS = "*o+x#@"


def name_of(response: Response) -> Formula:
    """Return what a response is called: the letter of its signal, with the number of its component."""
    return Letter(f"{response.signal}[{response.component}" if response.component else response.signal)


def style_of(response: Response) -> str:
    """Return the style of its line."""
    return "estimate" if response.dashed else "path"


def sign_of(response: Response) -> str:
    """Return the sign of its values in discrete time: a ring for an estimate."""
    return "ring" if response.dashed else "dot"


def axis_of(picture: TimeResponse) -> str:
    """Return what time is called."""
    return "k" if picture.discrete else "t"
