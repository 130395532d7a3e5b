"""Numbers in words: how many things there are, and which of the real roots is meant."""

from __future__ import annotations

_NUMBERS = ("no", "one", "two", "three", "four", "five", "six", "seven", "eight", "nine", "ten", "eleven", "twelve")
_ORDINALS = ("first", "second", "third", "fourth", "fifth", "sixth")


def _number(count: int) -> str:
    return _NUMBERS[count] if count < len(_NUMBERS) else str(count)


def counted(count: int, thing: str) -> str:
    """Return `one interval`, `two intervals`, …."""
    return f"{_number(count)} {thing}{'' if count == 1 else 's'}"


def in_words(count: int, among: int) -> str:
    """Return `none of them is`, `one of them is`, `three of them are`, `all of them are`."""
    if count == 0:
        return "none of them is"
    if count == among:
        return "all of them are"
    return f"{_number(count)} of them {'is' if count == 1 else 'are'}"


def root_in_words(index: int, count: int) -> str:
    """Return which of the real roots is meant, counted from the left."""
    if count == 1:
        return "the only real root"
    return f"the {_ORDINALS[index] if index < len(_ORDINALS) else f'{index + 1}th'} real root from the left"


def roots_lie(count: int) -> str:
    """Return `no root lies`, `one root lies`, `two roots lie`, …."""
    return f"{_number(count)} root lies" if count < 2 else f"{_number(count)} roots lie"


def changes_sign(count: int) -> str:
    """Return `does not change sign`, `changes sign once`, `changes sign twice`, `changes sign three times`, …."""
    if count == 0:
        return "does not change sign"
    return f"changes sign {('once', 'twice')[count - 1] if count < 3 else f'{_number(count)} times'}"
