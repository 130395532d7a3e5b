"""Landmarks of a loop, such as branch points with their gain: lists in any order, one of a conjugate pair for both.

What is expected of one may be a table, `{s = "-0.423", k = "0.385"}`, a text with the same names, `s = -0.423, k = 0.385`, or
the number that stands alone.  Angles count modulo 360°; a landmark at k = 0, where a multiple pole is, may be left out.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from contextlib import suppress
from fractions import Fraction
from typing import TYPE_CHECKING, Any

from symobs.exact import Complex, Root, Scalar
from symobs.exact.algebraic.real_algebraic import roots_of_scalar
from symobs.exact.algebraic.root_loci import enclosed
from symobs.formula.expression import parse_poles, parse_scalar
from symobs.ground.errors import InputError, SymobsError
from symobs.problem.agreement import agrees

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

#: The fields that are lists of landmarks, with the names of their numbers, the one that stands alone first.
LANDMARKS = {
    "breakaway": ("s", "k"),
    "crossings": ("k", "omega"),
    "departure": ("angle", "s"),
    "arrival": ("angle", "s"),
    "axis_crossings": ("value", "omega"),
}
#: What the numbers are called besides.
_CALLED = {"w": "omega", "ω": "omega", "K": "k", "z": "s", "theta": "angle", "phi": "angle", "φ": "angle", "θ": "angle"}
#: How a text says that there are none.
NOTHING = ("none", "no", "keine", "kein", "-")
#: What a line begins with that tells landmarks.
_WORDS = {
    "breakaway": r"break-?\s?away|break-?\s?in|branch\s?points?|verzweigungs\w*",
    "crossings": r"crossings?|schnittpunkte?|durchtritte?",
    "departure": r"(?:angles? of )?departure|austrittswinkel",
    "arrival": r"(?:angles? of )?arrival|eintrittswinkel",
}
_LINE = {
    name: re.compile(
        rf"\s*(?:the )?(?:{words})(?:[\s-]+(?:points?|angles?|and|at|is|are|of|the|imaginary|axis))*\s*[:=]?\s*(?P<rest>.*)",
        re.IGNORECASE,
    )
    for name, words in _WORDS.items()
}
_OTHER_WORDS = re.compile(r"\b(?!sqrt|acos|omega|angle|none|keine|multiplicity|CRootOf|and|und)[A-Za-z]{3,}")
#: A further number of the landmark before it.
_FURTHER = re.compile(r"\s*(?:[kKswzω]|omega|angle)\s*=")
_COUNTED = re.compile(r"\s*CRootOf\((.*),\s*([0-9]+)\)\s*", re.DOTALL)
_WORKING_BITS = 256


def without_landmarks(lines: Sequence[tuple[int, str]]) -> tuple[list[tuple[int, str]], dict[str, str]]:
    """Return numbered lines without those that tell landmarks, and what these tell, by field: texts with semicolons."""
    left, told = list[tuple[int, str]](), dict[str, str]()
    last, field = 0, ""
    for number, line in lines:
        found = _told_in(line)
        if found is not None:
            last, field = number, found[0]
            told[field] = f"{told[field]}; {found[1]}" if field in told else found[1]
        elif number == last and _FURTHER.match(line):
            told[field] += f", {line}"
        else:
            left.append((number, line))
    return left, told


def _told_in(line: str) -> tuple[str, str] | None:
    """Return the field and the numbers of a line such as "breakaway points: s = -0.423 at k = 0.385"."""
    for name, pattern in _LINE.items():
        if (found := pattern.fullmatch(line)) is not None and found["rest"]:
            rest = re.sub(r"\b(?:at|for|with|bei|für|mit)\b", ",", found["rest"])
            return None if _OTHER_WORDS.search(rest) else (name, rest)
    return None


def landmarks_agree(name: str, found: list[Any], expected: Any, names: Any, where: str) -> bool:
    """Return whether each landmark expected is one that was found, and each that was found is expected."""
    wanted = [_as_table(entry, name, f"{where}[{i}]") for i, entry in enumerate(_entries(expected))]
    missing = list(found)
    for table in wanted:
        met = [one for one in found if _is_landmark(one, table, names, where)]
        if not met:
            return False
        missing = [one for one in missing if one not in met]
    return not any(_is_owed(one) for one in missing)


def _is_owed(found: Mapping[str, Any]) -> bool:
    return "multiplicity" not in found or str(found["k"]) != "0"


def _entries(expected: Any) -> list[Any]:
    """Return the landmarks of a list, or of a text in which semicolons, lines or braces part them."""
    if not isinstance(expected, str):
        return list(expected) if isinstance(expected, list) else [expected]
    inside = re.sub(r"\}\s*,\s*\{", ";", expected.strip().removeprefix("[").removesuffix("]"))
    inside = re.sub(r"[{}\"']", "", re.sub(r"(\w+)[\"']?\s*:", r"\1 =", inside))
    parted = re.split(r";|\n", inside) if re.search(r"[=;\n]", inside) else inside.split(",")
    return [part.strip() for part in parted if part.strip() and part.strip() not in NOTHING]


def _as_table(entry: Any, name: str, where: str) -> dict[str, str]:
    """Return the numbers of a landmark by name."""
    if isinstance(entry, str) and "=" in entry:
        parts = [part.partition("=") for part in re.split(r",|\band\b|\bund\b", entry) if part.strip()]
        entry = {left.strip() if sign else _alone(name, left): (right or left).strip() for left, sign, right in parts}
    if not isinstance(entry, Mapping):
        return {_alone(name, str(entry)): str(entry)}
    table = {_CALLED.get(str(key), str(key)): str(value) for key, value in entry.items()}
    table = {
        key: value
        for key, value in table.items()
        if key.removesuffix("_decimal") not in table or key in LANDMARKS[name]
    }
    unknown = [key for key in table if key not in {*LANDMARKS[name], "multiplicity", "s"}]
    if unknown or not table:
        listed = ", ".join(f'{each} = "…"' for each in LANDMARKS[name])
        raise InputError(
            f"{unknown[0] if unknown else entry} is no number of {name}", where=where, repair=f"write {{{listed}}}"
        )
    return table


def _alone(name: str, text: str) -> str:
    """Return what a number without a name is; a complex one is s."""
    is_complex = re.search(r"[\dij)]\s*[ij]\b|\b[ij]\s*\d|\b[ijI]\b", text)
    return "s" if is_complex else "k or omega" if name == "crossings" else LANDMARKS[name][0]


def _is_landmark(found: Mapping[str, Any], table: Mapping[str, str], names: Any, where: str) -> bool:
    """Return whether all numbers told are those found, or those of its conjugate."""
    for conjugate in (False, True):
        if all(_is_number(found, key, text, names, where, conjugate=conjugate) for key, text in table.items()):
            return True
    return False


def _is_number(found: Mapping[str, Any], key: str, text: str, names: Any, where: str, *, conjugate: bool) -> bool:
    is_as_written = not (conjugate and key in {"s", "angle"})
    if (str(found.get(key)) == text and is_as_written) or key == "multiplicity":
        return str(found.get(key)) == text
    (read,) = parse_poles(text.replace("±", ""), names, where=where, functions=True, rounding=True)[:1]
    if key == "s" and key not in found:  # a crossing by its root on the axis
        return read.real.is_zero and any(
            agrees(side, value) for side in (read.imaginary, -read.imaginary) for value in _values(found, "omega")
        )
    if key == "s":
        pairs = [
            (read.real, value.real, read.imaginary, -value.imaginary if conjugate else value.imaginary)
            for value in _places(found[key])
        ]
        return any(agrees(a, b) and agrees(c, d) for a, b, c, d in pairs)
    if not read.is_real:
        return False
    if key == "angle":
        turns = [Scalar.of(360 * turn) for turn in (-2, -1, 0, 1, 2)]
        sign = -1 if conjugate else 1
        return any(agrees(read.real + turn, value * sign) for value in _values(found, key) for turn in turns)
    return any(agrees(read.real, value) for each in key.split(" or ") for value in _values(found, each))


def _places(root: Any) -> Iterator[Complex]:
    """Yield a root exactly where it has a closed form, else by an enclosure that no decimal typed comes near."""
    if isinstance(root, Scalar):
        yield Complex.of(root)
    elif isinstance(root, Root) and root.is_closed:
        yield from parse_poles(str(root), functions=True)[:1]
    else:
        ball = enclosed(root, _WORKING_BITS)
        parts = [Fraction(str(part.mid().fmpq())) for part in (ball.real, ball.imag)]
        yield Complex(*map(Scalar.of, parts))


def _values(found: Mapping[str, Any], key: str) -> Iterator[Scalar]:
    """Yield a number that was found: exactly, and its certain digits where it has no closed form."""
    value = found.get(key)
    if isinstance(value, Scalar):
        yield value
        return
    counted = _COUNTED.fullmatch(str(value))
    if counted is not None:
        polynomial = parse_scalar(counted[1], None)
        (variable,) = polynomial.names
        yield roots_of_scalar(polynomial, variable)[int(counted[2])].scalar(variable)
        return
    with suppress(SymobsError):
        yield parse_scalar(str(value), None, functions=True)
    if f"{key}_decimal" in found:
        yield Scalar.of(Fraction(found[f"{key}_decimal"]))
