"""parse(print(x)) = x: exact values, the texts symobs prints of them, and the same values read from these texts."""

from __future__ import annotations

import re
from fractions import Fraction
from typing import TYPE_CHECKING, Any

from symobs.exact import Complex, Matrix, Scalar, factored
from symobs.exact.algebraic.polynomial_roots import roots_of
from symobs.exact.core.generators import function, square_root
from symobs.formula.expression import parse_matrix, parse_poles, parse_polynomial, parse_scalar
from symobs.formula.notation import GREEK_LETTERS, symbol_text
from symobs.formula.tree import Literal
from symobs.ground.errors import BudgetExceeded
from symobs.pages.printers.text_printer import TextPrinter
from symobs.tasks.result.conversions import to_json

if TYPE_CHECKING:
    from collections.abc import Iterable
    from random import Random

_GREEK = sorted(GREEK_LETTERS)
_WORDS: tuple[str, ...] = (
    "a",
    "b",
    "m",
    "g",
    "h1",
    "h2",
    "x_1",
    "k_12",
    "tau_f",
    "mass",
    "b_z",
    "e",
    "E2",
    "i",
    "j",
    "t",
    "A",
    "K",
    "z",
)
_WORDS += ("e1", "x1_2_max", "alpha_beta", "Omega", "a" * 64, "x_", "e_3", "oo_", "sinus", "exp1", "l", "O0")
_SUPERSCRIPTS = str.maketrans("⁰¹²³⁴⁵⁶⁷⁸⁹⁻", "0123456789-")


class Unlike(AssertionError):
    """A text reads as something else than what it was printed from."""


def roundtrip(source: Random) -> str:
    """Print a random value in one of the ways there are, read it, and compare; raises `Unlike`.

    What is longer than the grammar reads, or has more digits, is left out, and said to be.
    """
    try:
        source.choice(_WAYS)(source)
    except BudgetExceeded:
        return "larger than is read"
    return "read back"


def compare(value: object, text: object, read: object) -> None:
    """Raise `Unlike` unless what was read is the value."""
    if read != value:
        raise Unlike(f"{str(value)[:300]} printed as {str(text)[:300]} reads as {str(read)[:300]}")


def names(source: Random, most: int = 5) -> list[str]:
    """Return names of parameters: letters, words, Greek ones, with digits and subscripts; no two print alike."""
    found: dict[str, str] = {}
    for _ in range(source.randrange(1, most + 1)):
        name = source.choice(_WORDS) if source.random() < 0.6 else source.choice(_GREEK)
        name += source.choice(("", "", "", "0", "12", "_1", "_a", "_max"))
        if len(name) <= 64 and name not in {"pi", "lambda"}:
            found.setdefault(symbol_text(name).translate(_PLAIN), name)
    return list(found.values()) or ["a"]


_PLAIN = str.maketrans("₀₁₂₃₄₅₆₇₈₉", "0123456789")


def number(source: Random) -> Fraction:
    """Return a rational number, seldom a huge one."""
    digits = source.choice((1, 1, 2, 5, 20, 100, 400))
    below = source.choice((1, 1, source.randrange(1, 100), source.randrange(1, 10 ** source.choice((1, 9, 90)))))
    return Fraction(source.randrange(-(10**digits), 10**digits + 1), below)


def polynomial(source: Random, known: list[str], terms: int = 4, degree: int = 4) -> Scalar:
    """Return a polynomial."""
    total = Scalar.of(number(source))
    for _ in range(source.randrange(terms)):
        term = Scalar.of(number(source) if source.random() < 0.3 else source.randrange(-9, 10))
        for name in source.sample(known, source.randrange(1, min(3, len(known)) + 1)):
            term = term * Scalar.symbol(name) ** source.choice((1, 1, 1, 2, source.randrange(1, degree + 1)))
        total = total + term
    return total


def rational(source: Random, known: list[str]) -> Scalar:
    """Return a rational function: a fraction, a power of one, or a sum of two."""
    above, below = polynomial(source, known), polynomial(source, known, 3)
    value = above if below.is_zero or source.random() < 0.4 else above / below
    if source.random() < 0.2:
        value = value ** source.choice((2, 3))
    if source.random() < 0.2:
        other = polynomial(source, known, 2)
        value = value + (other if other.is_zero else Scalar.of(1) / other)
    return value


def of_time(source: Random) -> Scalar:
    """Return a function of time: powers of t, exponentials, waves and roots, with rational coefficients."""
    known = [name for name in names(source, 2) if name not in {"i", "j", "t"}] or ["a"]  # i is the imaginary unit here
    t = Scalar.symbol("t")
    total = Scalar.of(0)
    for _ in range(source.randrange(1, 4)):
        term = rational(source, known) if source.random() < 0.4 else Scalar.of(source.randrange(-5, 6))
        for _ in range(source.randrange(3)):
            rate = polynomial(source, known, 2, 2) if source.random() < 0.5 else Scalar.of(source.randrange(-4, 5))
            match source.randrange(4):
                case 0:
                    term = term * t ** source.randrange(4)
                case 1:
                    term = term * function("exp", rate * t)
                case 2:
                    term = term * function(source.choice(("sin", "cos", "sinh", "cosh")), rate * t)
                case 3:
                    term = term * square_root(Scalar.of(source.randrange(1, 60)) * Scalar.symbol(source.choice(known)))
        total = total + term
    return total


# -- the ways ---------------------------------------------------------------------------------------------------------


def _declared(known: Iterable[str]) -> dict[str, str]:
    return dict.fromkeys(known, "real")


def _scalar(source: Random) -> None:
    known = names(source)
    value = rational(source, known)
    text = str(value)
    compare(value, text, parse_scalar(text, _declared(known)))


def _matrix(source: Random) -> None:
    known = names(source, 3)
    rows, columns = source.randrange(1, 4), source.randrange(1, 4)
    value = Matrix.of([[rational(source, known) for _ in range(columns)] for _ in range(rows)])
    text, listed = str(value), to_json(value)
    compare(value, text, parse_matrix(text, _declared(known)))
    compare(value, listed, parse_matrix(listed, _declared(known)))


def _polynomial(source: Random) -> None:
    known = names(source, 3)
    variable = source.choice("sz")
    known = [name for name in known if name != variable] or ["a"]
    s, total = Scalar.symbol(variable), Scalar.of(0)
    for power in range(source.randrange(2, 9)):
        total = total + (rational(source, known) if source.random() < 0.3 else Scalar.of(number(source))) * s**power
    text = str(total)
    if total.is_polynomial_in(variable) and total.degree(variable) > 0:
        compare(total, text, parse_polynomial(text, variable, _declared(known)))


def _product(source: Random) -> None:
    known = names(source, 2)
    value = Scalar.of(1)
    for _ in range(source.randrange(1, 4)):
        factor = polynomial(source, known, 3, 2)
        value = value if factor.is_zero else value * factor ** source.choice((1, 1, 2, -1))
    name = source.choice(known)
    form = factored(value, name)
    compare(value, form, parse_scalar(str(form), _declared(known)))


def _poles(source: Random) -> None:
    known = names(source, 2)
    value = tuple(
        Complex(rational(source, known), Scalar.of(number(source)) if source.random() < 0.5 else Scalar.of(0))
        for _ in range(source.randrange(1, 5))
    )
    text = ", ".join(map(str, value))
    listed = to_json(value)
    compare(value, text, parse_poles(text, _declared(known)))
    compare(value, listed, parse_poles(listed, _declared(known)))


def _roots(source: Random) -> None:
    s = Scalar.symbol("s")
    for root in roots_of(s * s + s * source.randrange(-20, 21) + Scalar.of(number(source)), "s"):
        if root.is_closed and abs(root.radicand.fraction()) < 10**9:
            outside, inside, is_imaginary = root.surd()
            length = square_root(Scalar.of(inside)) * outside * root.sign
            zero = Scalar.of(0)
            value = Complex(root.centre, length) if is_imaginary else Complex(root.centre + length, zero)
            compare((value,), root, parse_poles([str(root)], {}, functions=True))


def _function_of_time(source: Random) -> None:
    value = of_time(source)
    text = str(value)
    compare(value, text, parse_scalar(text, functions=True))
    compare(Matrix.of([[value]]), text, parse_matrix([[text]], functions=True))


def _terminal(source: Random) -> None:
    """The text for terminals: superscripts, subscripts and Greek letters typed as a user types them."""
    known = [name for name in names(source, 3) if not name.endswith("_")] or ["a"]
    value = rational(source, known)
    printed = TextPrinter().inline(Literal(value))
    text = typed(printed, known)
    compare(value, printed, parse_scalar(text, _declared(known)))


def typed(printed: str, known: Iterable[str]) -> str:
    """Return a line of mathematics for terminals as a user types it."""
    written = {symbol_text(name): name for name in known}
    forms = "|".join(re.escape(form) for form in sorted(written, key=len, reverse=True))
    powers = re.sub(r"[⁰¹²³⁴⁵⁶⁷⁸⁹⁻]+", lambda found: f"^({found[0].translate(_SUPERSCRIPTS)})", printed)
    spaced = re.sub(
        rf"(?<![A-Za-z_])(?:{forms})(?![A-Za-z_])" if forms else "$^", lambda found: f" {written[found[0]]} ", powers
    )
    return spaced.replace("·", "*")


def _with_sympy(source: Random) -> None:
    """The text of the SymPy object that a Python user sees."""
    from symobs.exact.sympy_bridge.conversion import scalar_to_sympy  # noqa: PLC0415 - one way of many

    known = [name for name in names(source, 3) if name not in {"i", "j"}] or ["a"]
    value = rational(source, known)
    text = str(scalar_to_sympy(value))
    compare(value, text, parse_scalar(text, _declared(known)))


def _answers(source: Random) -> None:
    """The fields of a result, as JSON has them."""
    import symobs  # noqa: PLC0415 - one way of many

    a, b = (source.choice(("0", "1", "-2", "a", "b", "a*b", "1/2")) for _ in range(2))
    plant = symobs.StateSpace(f"[0 1; {a} {b}]", "[0; 1]", f"[1 {source.choice((0, 1, 'c'))}]")
    asked = source.choice(({"poles": "-1, -p"}, {"polynomial": "s^2 + q s + 4"}))
    design: Any = source.choice((symobs.observer, symobs.state_feedback))(plant, **asked)
    for name, value in design.answer.items():
        known = _declared(("a", "b", "c", "p", "q", "s"))
        if isinstance(value, Scalar):
            compare(value, name, parse_scalar(to_json(value), known))
        elif isinstance(value, Matrix) and value.entries:
            compare(value, name, parse_matrix(to_json(value), known))


_WAYS = (
    *(_scalar,) * 12,
    *(_matrix,) * 4,
    *(_polynomial,) * 5,
    *(_product,) * 3,
    *(_poles,) * 5,
    *(_roots,) * 4,
    *(_function_of_time,) * 6,
    *(_terminal,) * 7,
    _with_sympy,
    _answers,
)
