"""Conjugates of complex numbers with square roots, and polynomials from which the roots have gone."""

from __future__ import annotations

from typing import TYPE_CHECKING

from symobs.exact.algebraic.complex import Complex
from symobs.exact.algebraic.enclosure import is_number, sign_of_number
from symobs.exact.algebraic.polynomial_roots import rational_sqrt
from symobs.exact.core.generators import Function, all_roots, function_named, normal_form, roots_in, square_root
from symobs.exact.core.scalar import Scalar

if TYPE_CHECKING:
    from collections.abc import Sequence


def tidied(value: Complex) -> Complex:
    """Return a complex number with both parts in normal form."""
    return Complex(normal_form(value.real), normal_form(value.imaginary))


def conjugates(value: Complex, *, of_numbers: bool) -> tuple[Complex, ...]:
    """Return the distinct images of a number under changes of the signs of i and its roots, itself first.

    Roots of numbers keep their signs unless `of_numbers` is set.
    """
    roots = dict.fromkeys(root for part in (value.real, value.imaginary) for root in roots_in(part))
    found = [value]
    for root in roots:
        if of_numbers or not is_number(root.argument):
            found += [_with_sign_changed(image, root) for image in found]
    return tuple(dict.fromkeys([*found, *(image.conjugate() for image in found)]))


def _with_sign_changed(value: Complex, root: Function) -> Complex:
    images: dict[str, Scalar] = {root.name: -root.value}
    return tidied(Complex(value.real.substitute(images), value.imaginary.substitute(images)))


def product_of_linear(variable: str, roots: Sequence[Complex]) -> Scalar | None:
    """Return Π (s − root), multiplied out; None unless its coefficients are real, and have no roots but of primes."""
    product = Complex.of(1)
    for root in roots:
        product = product * (Complex.of(Scalar.symbol(variable)) - root)
    product = tidied(product)
    return product.real if product.is_real and all(root.square for root in all_roots(product.real)) else None


def is_in_kernel(value: Scalar) -> bool:
    """Return whether the only functions of a value are roots of primes."""
    functions = (function_named(name) for name in value.names)
    return all(function is None or function.square for function in functions)


def root_in_field(number: Scalar) -> Scalar | None:
    """Return the positive square root of a positive number where it is one of a field Q(√2, √3, …).

    √(3 + 2 √2) = 1 + √2, and √(2 + √3) = (√6 + √2)/2.
    """
    if number.is_constant:
        root = square_root(number)
        return root if is_in_kernel(root) else None
    if not is_number(number) or not is_in_kernel(number) or sign_of_number(number) != "positive":
        return None
    variable = "x"
    found = (Scalar.symbol(variable) ** 2 - number).factors()[1]
    if len(found) == 1:
        return _sum_of_two_roots(number)
    if found[0][0].degree(variable) != 1:  # as of 1/pi
        return None
    lead, constant = found[0][0].coefficients(variable)
    root = constant / lead
    return root if sign_of_number(root) == "positive" else -root


def _sum_of_two_roots(number: Scalar) -> Scalar | None:
    """Return √(a + b √d) as √((a + e)/2) ± √((a − e)/2) where e² = a² − b² d is the square of a rational number."""
    field = number.field
    names = [field.names[index] for index, _ in field.roots if field.names[index] in number.names]
    if len(names) != 1:
        return None
    other = number.substitute({names[0]: -Scalar.symbol(names[0])})
    norm, mean = (number * other).fraction(), ((number + other) / 2).fraction()
    size = rational_sqrt(norm) if norm >= 0 else None
    if size is None:
        return None
    first, second = (square_root(Scalar.of((mean + part) / 2)) for part in (size, -size))
    found = next(total for total in (first + second, first - second) if total**2 == number)
    return found if is_in_kernel(found) else None
