"""Faults of a value that is the only one: compared with the right one entry by entry, coefficient by coefficient."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING

from symobs.audit import differences
from symobs.checking.faults.fault import Explained, Fault, first_kind
from symobs.exact import Matrix, Scalar

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

#: The slips that a comparison of matrices names, by what it says of them.
_SAID = {"every entry is multiplied": "factor", "exchanged": "exchanged", "the inverse is printed": "inverse"}


def explain_value(
    value: Matrix | Scalar,
    right: Matrix | Scalar,
    letter: str,
    variable: str,
    others: Mapping[str, tuple[Matrix | Scalar, str]],
    *,
    rounded: bool,
) -> Explained:
    """Return why a value is wrong; `others` are the values of known slips in the way to it, by slip, with their reason."""
    mine, exact = differences.as_matrix(value), differences.as_matrix(right)
    if mine.shape != exact.shape:
        if exact == mine.T:
            return Explained("transposed", f"the transpose of {letter} is right")
        sizes = " and ".join(f"{a}x{b}" for a, b in (exact.shape, mine.shape))
        return Explained(None, f"{letter} is {sizes.replace(' and ', ' here, yours is ')}")
    kinds = [partial(_rounded, letter)] if rounded else []
    kinds += [
        partial(_sign, mine, exact, letter),
        partial(_entry, mine, exact, letter, variable),
        partial(_known, value, others),
        partial(_specialised, mine, exact, letter, variable),
        partial(_whole, mine, exact, letter),
    ]
    return first_kind(kinds)


def _rounded(letter: str) -> Iterator[Fault]:
    yield Fault("rounded", f"{letter} is rounded, and its exact value is asked for")


def _sign(mine: Matrix, exact: Matrix, letter: str) -> Iterator[Fault]:
    if mine == -exact:
        slip = "sign_convention" if letter == "F" and exact.shape == (1, 1) else "sign"
        yield Fault(slip, f"-{letter} is right" if slip == "sign" else f"-{letter} is right with positive feedback")
        return
    if exact == mine.T:
        yield Fault("transposed", f"the transpose of {letter} is right")
        return
    off = [(a, b) for a, b in zip(mine.entries, exact.entries, strict=True) if a != b]
    if len(off) > 1 and all(a == -b for a, b in off):
        yield Fault("sign_entries", f"{len(off)} entries of {letter} have the other sign")


def _entry(mine: Matrix, exact: Matrix, letter: str, variable: str) -> Iterator[Fault]:
    """Yield the one entry, or the one coefficient of a polynomial, that is another one."""
    if exact.shape == (1, 1):
        one, other = mine[0, 0], exact[0, 0]
        if one.is_polynomial_in(variable) and other.is_polynomial_in(variable) and other.degree(variable) > 0:
            said = differences.polynomial_reason(one, other, variable)
            powers = [
                k
                for k in range(max(one.degree(variable), other.degree(variable)) + 1)
                if _at(one, k, variable) != _at(other, k, variable)
            ]
            if len(powers) == 1:
                yield Fault("one_coefficient", said, {"coefficient": powers[0]})
        return
    wrong = differences.wrong_entries(mine, exact, whole=letter)
    if len(wrong) == 1:
        places = [(i, j) for i in range(exact.shape[0]) for j in range(exact.shape[1]) if mine[i, j] != exact[i, j]]
        yield Fault("entry", str(wrong[0]), [places[0][0] + 1, places[0][1] + 1])


def _at(polynomial: Scalar, power: int, variable: str) -> Scalar:
    coefficients = polynomial.coefficients(variable)
    return coefficients[len(coefficients) - 1 - power] if power < len(coefficients) else Scalar.of(0)


def _known(value: Matrix | Scalar, others: Mapping[str, tuple[Matrix | Scalar, str]]) -> Iterator[Fault]:
    for slip, (wrong, reason) in others.items():
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
