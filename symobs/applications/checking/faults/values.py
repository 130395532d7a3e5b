"""Faults of a value that is the only one: compared with the right one entry by entry, coefficient by coefficient."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING

from symobs.applications.audit import differences
from symobs.applications.checking.faults.fault import Explained, Fault, first_kind, is_empty_but_for
from symobs.exact import Matrix, Scalar

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

#: The slips that a comparison of matrices names, by what it says of them.
_SAID = {"every entry is multiplied": "factor", "exchanged": "exchanged", "the inverse is printed": "inverse"}


def explain_value(
    value: Matrix | Scalar,
    right: Matrix | Scalar,
    letter: str,
    variable: str,
    others: Iterable[tuple[str, Matrix | Scalar, str]],
    *,
    rounded: bool,
    in_loop: bool = False,
) -> Explained:
    """Return why a value is wrong; `others` are known slips in the way to it, each with its value and reason.

    With `in_loop` the value stands in a feedback loop, where its sign is a convention.
    """
    mine, exact = differences.as_matrix(value), differences.as_matrix(right)
    if mine.shape != exact.shape:
        if exact == mine.T:
            return Explained("transposed", f"the transpose of {letter} is right")
        sizes = " and ".join(f"{a}x{b}" for a, b in (exact.shape, mine.shape))
        return Explained(None, f"{letter} is {sizes.replace(' and ', ' here, yours is ')}")
    kinds = [partial(_rounded, letter)] if rounded else []
    kinds += [
        partial(_sign, mine, exact, letter, in_loop=in_loop),
        partial(_entry, mine, exact, letter, variable),
        partial(_known, value, others),
        partial(_specialised, mine, exact, letter, variable),
        partial(_whole, mine, exact, letter),
    ]
    return first_kind(kinds)


def _has_functions(mine: Matrix, exact: Matrix, variable: str) -> bool:
    """Return whether exponentials, sines and cosines of the time stand in one of two values."""
    return variable == "t" and not all(name.isidentifier() for name in mine.names | exact.names)


def _rounded(letter: str) -> Iterator[Fault]:
    yield Fault("rounded", f"{letter} is rounded, and its exact value is asked for")


def _sign(mine: Matrix, exact: Matrix, letter: str, *, in_loop: bool) -> Iterator[Fault]:
    if mine == -exact:
        if in_loop:
            yield Fault("sign_convention", f"-{letter} is right: yours is that of positive feedback")
        else:
            yield Fault("sign", f"-{letter} is right")
        return
    if exact == mine.T:
        yield Fault("transposed", f"the transpose of {letter} is right")
        return
    off = [(a, b) for a, b in zip(mine.entries, exact.entries, strict=True) if a != b]
    if len(off) > 1 and all(a == -b for a, b in off):
        yield Fault("sign_entries", f"{len(off)} entries of {letter} have the other sign")


def _entry(mine: Matrix, exact: Matrix, letter: str, variable: str) -> Iterator[Fault]:
    """Yield the one entry, or the one coefficient of a polynomial or a fraction, that is another one."""
    if exact.shape == (1, 1):
        if _has_functions(mine, exact, variable):  # they have no coefficients
            return
        off = _coefficients_off(mine[0, 0], exact[0, 0], variable)
        if len(off) == 1:
            ((of, power, came, right),) = off
            name = (
                "the constant term" if not power else f"the coefficient of {variable}{f'^{power}' if power > 1 else ''}"
            )
            place = {"coefficient": power} | ({"of": of} if of else {})
            yield Fault("one_coefficient", f"{name}{f' of the {of}' if of else ''} is {right}, not {came}", place)
        return
    wrong = differences.wrong_entries(mine, exact, whole=letter)
    if len(wrong) == 1:
        places = [(i, j) for i in range(exact.shape[0]) for j in range(exact.shape[1]) if mine[i, j] != exact[i, j]]
        (i, j), said = places[0], str(wrong[0])
        if is_empty_but_for(mine, i, j):  # to tell the entry would be to tell the value
            said = f"entry ({i + 1}, {j + 1}) is wrong"
        yield Fault("entry", said, [i + 1, j + 1])


def _coefficients_off(mine: Scalar, exact: Scalar, variable: str) -> list[tuple[str, int, Scalar, Scalar]]:
    """Return where two polynomials, or two fractions with monic denominators, differ: the part, the power, both values."""
    if variable not in exact.names:
        return []
    pairs = [_parts(value, variable) for value in (mine, exact)]
    whole = all(below.is_one for _, below in pairs)
    found = []
    for place, of in enumerate(("",) if whole else ("numerator", "denominator")):
        one, other = pairs[0][place], pairs[1][place]
        for power in range(max(one.degree(variable), other.degree(variable)) + 1):
            came, right = _at(one, power, variable), _at(other, power, variable)
            if came != right:
                found.append((of, power, came, right))
    return found


def _parts(value: Scalar, variable: str) -> tuple[Scalar, Scalar]:
    """Return numerator and monic denominator."""
    if value.is_polynomial_in(variable):
        return value, Scalar.of(1)
    lead = value.denominator.coefficients(variable)[0]
    return value.numerator / lead, value.denominator / lead


def _at(polynomial: Scalar, power: int, variable: str) -> Scalar:
    coefficients = polynomial.coefficients(variable)
    return coefficients[len(coefficients) - 1 - power] if power < len(coefficients) else Scalar.of(0)


def _known(value: Matrix | Scalar, others: Iterable[tuple[str, Matrix | Scalar, str]]) -> Iterator[Fault]:
    for slip, wrong, reason in others:
        if type(wrong) is type(value) and wrong == value:
            yield Fault(slip, reason)


def _specialised(mine: Matrix, exact: Matrix, letter: str, variable: str) -> Iterator[Fault]:
    """Yield that 1 was put in place of the symbols."""
    names = exact.names - {variable, "t"}
    if names and not mine.names & names:
        try:
            at_one = exact.substitute({name: Scalar.of(1) for name in names if name.isidentifier()})
        except ZeroDivisionError:
            return
        if at_one == mine:
            yield Fault("specialised", f"{letter} is right for one value of the symbols only")


def _whole(mine: Matrix, exact: Matrix, letter: str) -> Iterator[Fault]:
    """Yield what is wrong with a matrix as a whole: a factor, an exchange, the inverse."""
    said = differences.reasons(mine, exact, letter)
    for words, slip in _SAID.items():
        if words in said:
            yield Fault(slip, said.split(";")[0])
            return
