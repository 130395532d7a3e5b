"""Poles by what they are to do: a pair by its damping, frequency, settling time or overshoot, or those of a filter.

A pattern is written as a table, {damping = "1/2", natural_frequency = 3}, or as a text, "damping = 1/2, natural_frequency = 3".
Beside a pair, and beside a filter of lower order, stand `others`, poles as they are always written.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from fractions import Fraction
from math import factorial, floor, log, log10, pi
from typing import TYPE_CHECKING, Any

from symobs.exact import Scalar, product_of
from symobs.exact.algebraic.real_algebraic import roots_of_scalar
from symobs.exact.algebraic.rounded_decimals import is_in_kernel
from symobs.exact.core.generators import PI, NotWritten, function, symbols_in
from symobs.exact.time_functions.antiderivative import butterworth, butterworth_angles
from symobs.ground.dataclass import dataclass
from symobs.ground.errors import InputError
from symobs.system.conditions import sign_of

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

OTHERS, OVERSHOOT = "others", "overshoot"
#: What may be given together.
PAIRS = (("damping", "natural_frequency"), ("damping", "settling_time"), ("settling_time", "overshoot"))
FILTERS = ("butterworth", "bessel", "itae")
KEYS = (*dict.fromkeys(name for pair in PAIRS for name in pair), *FILTERS, OTHERS)
#: The letters of books.
_OF_BOOKS = dict.fromkeys(("zeta", "ζ"), "damping") | dict.fromkeys(("t_s", "T_s"), "settling_time")
_OF_BOOKS |= dict.fromkeys(("omega_n", "ω_n", "ωn", "omega_0", "ω_0", "ω₀", "w_n", "wn"), "natural_frequency")
#: The highest degree of a Butterworth polynomial whose coefficients are written with one root.
MOST_OF_ONE_ROOT = 12
#: After 4/σ a mode with the real part −σ has decayed to exp(−4), less than 2 %.
TIME_CONSTANTS = 4
#: A pair for less overshoot is real in practice, for more it hardly decays.
OVERSHOOTS = Fraction(1, 10**6), Fraction(99, 100)
#: The coefficients of the polynomials that minimise ∫ t |e| dt of the step response, for ω₀ = 1, as they are tabulated.
ITAE = {
    1: "1",
    2: "1.4 1",
    3: "1.75 2.15 1",
    4: "2.1 3.4 2.7 1",
    5: "2.8 5.0 5.5 3.4 1",
    6: "3.25 6.60 8.60 7.45 3.95 1",
}


@dataclass
class PolePattern:
    """What is asked for, by name, with its exact values; and the polynomial that it means, as factors."""

    variable: str
    values: tuple[tuple[str, Scalar], ...]
    factors: tuple[Scalar, ...]

    @property
    def kind(self) -> str:
        """The first name that is given."""
        return self.values[0][0]

    @property
    def polynomial(self) -> Scalar:
        """The polynomial, multiplied out."""
        return product_of(self.factors)


def is_pattern(value: object) -> bool:
    """Return whether poles are given by what they are to do."""
    return isinstance(value, Mapping) or (isinstance(value, str) and "=" in value)


def named_parts(value: Any, where: str) -> dict[str, Any]:
    """Return what is given by name; raises `InputError` for a name that is not known and for what does not go together."""
    given = _parts_of_text(value, where) if isinstance(value, str) else dict(value)
    parts = {_OF_BOOKS.get(name, name): part for name, part in given.items()}
    unknown = [str(name)[:40] for name in parts if name not in KEYS]
    if unknown:
        raise InputError(f"poles have no {unknown[0]!r}", where=where, repair=f"known names are {', '.join(KEYS)}")
    asked = {name for name in parts if name != OTHERS}
    if asked not in [set(pair) for pair in PAIRS] and not (len(asked) == 1 and asked <= {*FILTERS}):
        message = f"{' and '.join(sorted(asked)) or 'nothing'} given, which does not say where the poles are"
        pairs = ", ".join(" and ".join(pair) for pair in PAIRS)
        raise InputError(message, where=where, repair=f"give one of {', '.join(FILTERS)}, or two of a kind: {pairs}")
    return parts


def _parts_of_text(text: str, where: str) -> dict[str, Any]:
    """Return the values of a text by their names; commas set apart the values, and poles among the others."""
    found: dict[str, Any] = {}
    if text.strip()[:1] == "{":  # a table of a problem file
        text = re.sub(r"[][{}\"']", "", text)
    for piece in text.split(","):
        name, sign, value = (part.strip() for part in piece.partition("="))
        if not sign and OTHERS in found and list(found)[-1] == OTHERS:
            found[OTHERS] += f", {name}"
        elif not sign or name in found:
            message = f"{name[:40]!r} is given twice" if sign else f"{name[:40]!r} has no name"
            repair = 'write "damping = 1/2, natural_frequency = 3, others = -10", the other poles last'
            raise InputError(message, where=where, repair=repair)
        else:
            found[name] = value
    return found


def pattern_of(
    values: Mapping[str, Scalar], count: int, variable: str, where: str, signs: Mapping[str, str], others: int = 0
) -> PolePattern:
    """Return the pattern of `count` poles, beside others; raises `InputError` where some values of symbols have none."""
    for asked, given in values.items():
        require_positive(asked, given, signs, f"{where}.{asked}")
    if {*values} == {"damping", "settling_time"}:
        _require_less_than_one(values["damping"], signs, f"{where}.damping")
    ordered = tuple((name, values[name]) for name in KEYS if name in values)
    name, value = ordered[0]
    if name in FILTERS:
        if count < 1:
            raise InputError(f"no pole is left for {name}", where=where, repair=_without(others, 1 - count))
        return PolePattern(variable, ordered, _POLYNOMIALS[name](count, value, variable, where))
    if count != 2:
        poles = ", ".join(str(-10 - number) for number in range(count - 2))
        message = f"a pair of poles given, but {max(count, 0)} {'is' if count == 1 else 'are'} to be placed so"
        repair = f'name {count - 2} more: others = "{poles}"' if poles else _without(others, 2 - count)
        raise InputError(message, where=where, repair=repair, given=2)
    sigma, square = rate_and_square(values, where)
    s = Scalar.symbol(variable)
    return PolePattern(variable, ordered, (s**2 + 2 * sigma * s + square,))


def require_positive(name: str, value: Scalar, signs: Mapping[str, str], where: str) -> None:
    """Raise `InputError` unless the declared signs make a value positive: where it is not, poles are on the right.

    An overshoot is a number within bounds of its own, and others are poles.
    """
    if name in {OVERSHOOT, OTHERS} or sign_of(value, signs) == "positive":
        return
    undeclared = sorted(symbol for symbol in symbols_in(value) if signs.get(symbol) != "positive")
    repair = f"give a positive {name}"
    if sign_of(value, {**signs, **dict.fromkeys(undeclared, "positive")}) == "positive":
        repair = f"declare {' and '.join(undeclared)} positive in symbols"
    raise InputError(f"{name} is {value}, which need not be positive", where=where, repair=repair)


def _require_less_than_one(damping: Scalar, signs: Mapping[str, str], where: str) -> None:
    """Raise `InputError` unless a pair is complex: only then is σ = 4/T the rate at which it decays."""
    below = sign_of(1 - damping, signs)
    if below == "positive":
        return
    which = "is" if below in {"zero", "negative", "nonpositive"} else "may be"
    message = (
        f"damping is {damping}, which {which} 1 or more, and such a pair does not decay like exp(-4 t/settling_time)"
    )
    repair = "give a number less than 1, or natural_frequency instead of settling_time"
    raise InputError(message, where=where, repair=repair)


def _without(others: int, too_many: int) -> str:
    """Return the repair where there are more poles than the order."""
    if others < too_many:
        return "name the pole itself"
    return "leave the others out" if others == too_many else f"leave {too_many} of the others out"


def refuse_names_of_patterns(value: object, declared: Iterable[str], where: str) -> None:
    """Raise `InputError` where a pole is a letter with a name that says what poles are to do: an = is missing."""
    texts = [part for part in (value if isinstance(value, (list, tuple)) else [value]) if isinstance(part, str)]
    named = [name for text in texts for name in re.findall(r"[A-Za-z_]\w*", text) if name in KEYS]
    for name in named:
        if name not in declared:
            message = f"{name} is no letter of a pole"
            raise InputError(message, where=where, repair=f'write what the poles are to do: "{name} = …"')


def rate_and_square(values: Mapping[str, Scalar], where: str) -> tuple[Scalar, Scalar]:
    """Return σ and ω₀² of the pair s² + 2 σ s + ω₀²."""
    if "natural_frequency" in values:
        frequency = values["natural_frequency"]
        return values["damping"] * frequency, frequency**2
    sigma = TIME_CONSTANTS / values["settling_time"]
    if "damping" in values:
        return sigma, (sigma / values["damping"]) ** 2
    return sigma, sigma**2 * (1 + pair_ratio(overshoot_within(values["overshoot"], where)) ** 2)


def overshoot_within(overshoot: Scalar, where: str) -> Scalar:
    """Return an overshoot; raises `InputError` unless it is a number that a pair can have."""
    least, most = OVERSHOOTS
    if not overshoot.is_constant or not least <= overshoot.fraction() <= most:
        message = (
            f"the overshoot is {overshoot}, which is not {'between' if overshoot.is_constant else 'a number between'}"
        )
        raise InputError(f"{message} {least} and {most}", where=where, repair='write 5 % as "0.05"')
    return overshoot


def pair_ratio(overshoot: Scalar) -> Scalar:
    """Return the largest q of three digits with exp(−π/q) ≤ M, found by decimals and proved by an enclosure.

    With ω = qσ the overshoot exp(−πσ/ω) is at most M.
    """
    unit = third_digit(pi / -log(overshoot.fraction()))
    steps = floor(pi / -log(overshoot.fraction()) / unit)
    while sign_of(overshoot - overshoot_of(Scalar.of(steps * unit)), {}) != "positive":
        steps -= 1
    return Scalar.of(steps * unit)


def third_digit(value: float | Fraction) -> Fraction:
    """Return what one unit in the third digit of a positive number is worth."""
    return Fraction(10) ** (floor(log10(value)) - 2)


def overshoot_of(ratio: Scalar) -> Scalar:
    """Return exp(−π/q), how far the step response of a pair −σ ± iqσ goes beyond its end."""
    return function("exp", -Scalar.symbol(PI) / ratio)


# -- filters ----------------------------------------------------------------------------------------------------------


def bessel(count: int, frequency: Scalar, variable: str) -> Scalar:
    """Return ω₀ⁿ θₙ(s/ω₀), θₙ the reverse Bessel polynomial Σ (2n−k)!/(2ⁿ⁻ᵏ k! (n−k)!) xᵏ: θ₂ = x² + 3x + 3.

    The delay of θₙ(0) ω₀ⁿ over it is 1/ω₀ at low frequencies, maximally flat.
    """
    s, total = Scalar.symbol(variable), Scalar.of(0)
    for k in range(count + 1):
        rest = count - k
        number = factorial(count + rest) // (2**rest * factorial(k) * factorial(rest))
        total = total + number * frequency**rest * s**k
    return total


def _butterworth(count: int, radius: Scalar, variable: str, where: str) -> tuple[Scalar, ...]:
    try:
        found = butterworth(count, radius, variable)
        if all(map(is_in_kernel, found)):
            return found
    except NotWritten:
        pass
    if count > MOST_OF_ONE_ROOT:
        message = (
            f"Butterworth polynomials have degree {MOST_OF_ONE_ROOT} or less here, and {count} poles are to be placed"
        )
        raise InputError(message, where=where, repair="take bessel, or fewer poles and others beside them")
    return _in_one_root(count, radius, variable)


def _in_one_root(count: int, radius: Scalar, variable: str) -> tuple[Scalar, ...]:
    """Return Butterworth's polynomial with r = 2 cos θ, θ = π/2n, the largest zero of 2 Tₙ(x/2).

    2 cos (k+1)θ = 2r cos kθ − 2 cos (k−1)θ writes the other cosines by it.
    """
    cosines = [Scalar.of(2), Scalar.symbol("x")]
    while len(cosines) <= count:
        cosines.append(cosines[1] * cosines[-1] - cosines[-2])
    root = {"x": roots_of_scalar(cosines[count], "x")[-1].scalar()}
    s = Scalar.symbol(variable)
    half_turns = (int(turns * 2 * count) for turns in butterworth_angles(count))
    pairs = [s**2 + cosines[k].substitute(root) * radius * s + radius**2 for k in half_turns]
    return (product_of([*([s + radius] if count % 2 else []), *pairs]),)


def _bessel(count: int, frequency: Scalar, variable: str, _: str) -> tuple[Scalar, ...]:
    return (bessel(count, frequency, variable),)


def _itae(count: int, frequency: Scalar, variable: str, where: str) -> tuple[Scalar, ...]:
    if count not in ITAE:
        message = f"ITAE polynomials are tabulated up to degree {max(ITAE)}, and {count} poles are to be placed"
        raise InputError(message, where=where, repair='name further poles: others = "-50", or take bessel')
    s, total = Scalar.symbol(variable), Scalar.symbol(variable) ** count
    for k, decimal in enumerate(ITAE[count].split(), 1):
        total = total + Scalar.of(Fraction(decimal)) * frequency**k * s ** (count - k)
    return (total,)


_POLYNOMIALS: dict[str, Callable[[int, Scalar, str, str], tuple[Scalar, ...]]] = {
    "butterworth": _butterworth,
    "bessel": _bessel,
    "itae": _itae,
}
