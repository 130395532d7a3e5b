"""The axes of responses over time, on paper and on a terminal."""

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
    """Return the name of a response: the letter of its signal, with the index of its component."""
    return Letter(f"{response.signal}[{response.component}" if response.component else response.signal)


def style_of(response: Response) -> str:
    """Return the style of its line."""
    return "estimate" if response.dashed else "path"


def sign_of(response: Response) -> str:
    """Return the sign of its values in discrete time: a ring for an estimate."""
    return "ring" if response.dashed else "dot"


def axis_of(picture: TimeResponse) -> str:
    """Return the name of the time axis."""
    return "k" if picture.discrete else "t"
