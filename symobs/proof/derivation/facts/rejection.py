"""Rejection of a line of a derivation."""

from __future__ import annotations

from typing import NoReturn

from symobs.ground.errors import DerivationRejected

BUG = "please report this: it is a bug of symobs"


def reject(line: str) -> NoReturn:
    """Raise `DerivationRejected`."""
    message = f"the line {line} is not true"
    raise DerivationRejected(message, repair=BUG, line=line)
