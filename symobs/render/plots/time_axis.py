"""Courses over time: where they stand on paper, and how a terminal shows them."""

from __future__ import annotations

from typing import TYPE_CHECKING

from symobs.formula import Letter

if TYPE_CHECKING:
    from symobs.figures.plot import Response, TimeResponse
    from symobs.formula import Formula

#: Height of the frame, in points.
HEIGHT = 90.0
#: What a terminal draws with, course by course.
CHARACTERS = "*o+x#@"


def name_of(course: Response) -> Formula:
    """Return what a course is called: the letter of its signal, with the number of its component."""
    return Letter(f"{course.signal}[{course.component}" if course.component else course.signal)


def style_of(course: Response) -> str:
    """Return the style of its line."""
    return "estimate" if course.dashed else "path"


def sign_of(course: Response) -> str:
    """Return the sign of its values in discrete time: a ring for an estimate."""
    return "ring" if course.dashed else "dot"


def axis_of(picture: TimeResponse) -> str:
    """Return what time is called."""
    return "k" if picture.discrete else "t"
