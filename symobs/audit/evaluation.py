"""What a printed tree is worth: an exact value or a signal, or a `Misfit` that says which sizes do not fit."""

from __future__ import annotations

from typing import TYPE_CHECKING, TypeAlias

from symobs.audit.functions import (
    MOST_BITS,
    MOST_DEGREE,
    MOST_TERMS,
    Misfit,
    Unknown,
    applied,
    integrated,
    no_fit,
    require_small,
    sized,
    too_large,
)
from symobs.audit.grammar import Node
from symobs.audit.letters import INSTANTS
from symobs.certificate import EVALUATION_ERRORS, verify
from symobs.errors import InputError
from symobs.exact import Matrix, Scalar, rank
from symobs.exact.functions import identities
from symobs.formula import Environment, Letter, Literal, Relation, Signal
from symobs.formula.term import Term, block
from symobs.record import dataclass

if TYPE_CHECKING:
    from collections.abc import Sequence


@dataclass(frozen=True)
class Flexible:
    """A multiple of the identity matrix whose order its neighbours decide; 0 is the zero matrix of any size."""

    factor: Scalar


Printed: TypeAlias = Term | Flexible


def value_of(node: Node, environment: Environment) -> Printed:
    """Return what a tree is worth; raises Misfit, Unknown and BudgetExceeded."""
    found = _value(node, environment)
    if isinstance(found, Term):
        _bounded(found)
    return found


def _bounded(term: Term) -> None:
    value = term.value
    for part in value.coefficients.values() if isinstance(value, Signal) else (value,):
        if part.size > MOST_TERMS or max(part.lengths()) > MOST_BITS or max(part.degrees()) > MOST_DEGREE:
            raise too_large()


def _value(node: Node, environment: Environment) -> Printed:
    parts = node.parts
    match node.kind:
        case "number":
            assert node.value is not None  # noqa: S101 - an invariant of the grammar
            return Term(Literal(node.value), environment)
        case "letter":
            return _letter(node.text, environment)
        case "sum":
            return _sum(parts, environment)
        case "negative":
            inner = value_of(parts[0], environment)
            return Flexible(-inner.factor) if isinstance(inner, Flexible) else -inner
        case "product":
            total = value_of(parts[0], environment)
            for i, part in enumerate(parts[1:], start=1):
                total = _times(total, value_of(part, environment), Node("product", parts[:i]), part)
                if isinstance(total, Term):
                    _bounded(total)
            return total
        case "quotient":
            return _quotient(parts, environment)
        case "power":
            return _power(parts[0], int(node.text), environment)
        case "primed":
            return _primed(parts[0], environment)
        case "block":
            return _block([row.parts for row in parts], environment)
        case _:
            return _call(node, environment)


def _letter(name: str, environment: Environment) -> Printed:
    if environment.knows(name) and name != "s":
        return Term(Letter(name), environment)
    if name == environment.variable:
        return Term(Literal(Scalar.symbol(name)), environment)
    if name == "I":
        return Flexible(Scalar.of(1))
    if name in INSTANTS:
        return Term(Literal(Scalar.symbol(name)), environment)
    raise Unknown(name)


def shape(term: Term) -> tuple[int, int] | None:
    """Return rows and columns of a value or a signal, None for a number."""
    value = term.value
    if isinstance(value, Signal):
        return value.size, 1
    return value.shape if isinstance(value, Matrix) else None


def is_signal(printed: Printed) -> bool:
    """Whether a value is made of signals."""
    return isinstance(printed, Term) and isinstance(printed.value, Signal)


def fitted(flexible: Flexible, like: Term) -> Term:
    """Return a multiple of the identity in the size of another value; raises Misfit where that is not square."""
    size = shape(like)
    if is_signal(like):
        raise no_fit("the identity matrix stands beside a signal")
    if size is None or size == (1, 1):
        return Term(Literal(flexible.factor), like.environment)
    if flexible.factor.is_zero:
        return Term(Literal(Matrix.zeros(*size)), like.environment)
    if size[0] != size[1]:
        raise no_fit(f"the identity matrix is square, but {sized(size)} stands beside it")
    return Term(Literal(Matrix.identity(size[0]) * flexible.factor), like.environment)


def _sum(parts: Sequence[Node], environment: Environment) -> Printed:
    found = [value_of(part, environment) for part in parts]
    terms = [(part, value) for part, value in zip(parts, found, strict=True) if isinstance(value, Term)]
    if not terms:
        return Flexible(sum((value.factor for value in found if isinstance(value, Flexible)), Scalar.of(0)))
    if any(isinstance(value, Flexible) for value in found) and all(shape(value) is None for _, value in terms):
        raise no_fit("a number stands beside the identity matrix")
    (head, first) = next(((part, value) for part, value in terms if shape(value) is not None), terms[0])
    total: Term | None = None
    for part, value in zip(parts, found, strict=True):
        term = fitted(value, first) if isinstance(value, Flexible) else value
        if not _alike(term, first):
            raise no_fit(f"{_unsigned(head)} {kind_of(first)}, but {_unsigned(part)} {kind_of(term)}")
        total = term if total is None else total + term
    assert total is not None  # noqa: S101 - a sum has parts
    return total


def kind_of(term: Term) -> str:
    """Return what size a value has, in words."""
    size = shape(term)
    if size is not None and is_signal(term):
        return f"has {size[0]} component{'s' if size[0] > 1 else ''}"
    return f"is {sized(size)}"


def _unsigned(part: Node) -> Node:
    return part.parts[0] if part.kind == "negative" else part


def _alike(left: Term, right: Term) -> bool:
    single = ((1, 1), None)
    if is_signal(left) != is_signal(right):
        return False
    return shape(left) == shape(right) or (shape(left) in single and shape(right) in single)


def _times(left: Printed, right: Printed, before: Node, behind: Node) -> Printed:
    if isinstance(left, Flexible):
        if isinstance(right, Flexible):
            return Flexible(left.factor * right.factor)
        return right * left.factor if left.factor != Scalar.of(1) else right
    if isinstance(right, Flexible):
        if shape(left) is None:
            return Flexible(right.factor * left.value)
        return left * right.factor if right.factor != Scalar.of(1) else left
    if is_signal(left):
        if is_signal(right) or shape(right) not in (None, (1, 1)):
            raise Misfit(f"{before} is a signal; {behind} has to stand before it")
        return Term(Literal(right.scalar), right.environment) @ left
    first, second = shape(left), shape(right)
    if first is not None and second is not None and first[1] != second[0]:
        raise no_fit(f"{before} {kind_of(left)} and {behind} {kind_of(right)}")
    return left @ right


def _quotient(parts: Sequence[Node], environment: Environment) -> Printed:
    above, below = (value_of(part, environment) for part in parts)
    if isinstance(below, Flexible) or is_signal(below) or shape(below) not in (None, (1, 1)):
        raise Misfit(f"{parts[1]} is no number to divide by")
    divisor = below.scalar
    if divisor.is_zero:
        raise Misfit(f"{parts[1]} is 0")
    return Flexible(above.factor / divisor) if isinstance(above, Flexible) else above / below


def _power(base: Node, exponent: int, environment: Environment) -> Printed:
    value = value_of(base, environment)
    if isinstance(value, Flexible):
        return value
    size = shape(value)
    if is_signal(value) or (size is not None and size[0] != size[1]):
        raise no_fit(f"{base} {kind_of(value)}: only square matrices have powers and inverses")
    if exponent < 0:
        if isinstance(value.value, Matrix):
            require_small(value.value)
        singular = value.scalar.is_zero if size in (None, (1, 1)) else rank(value.value) < size[0]
        if singular:
            raise Misfit(f"{base} has no inverse")
        value, exponent = value.inverse, -exponent
    total: Term = value
    for _ in range(exponent - 1):
        total = total @ value
        _bounded(total)
    return total if exponent else Term(Literal(Scalar.of(1)), environment)


def _primed(base: Node, environment: Environment) -> Printed:
    value = value_of(base, environment)
    if isinstance(value, Flexible):
        return value
    if not is_signal(value):
        return value if shape(value) is None else value.T
    rate = value.derivative
    try:
        rate.value  # noqa: B018 - whether there is one
    except EVALUATION_ERRORS:
        raise Misfit(f"the derivative of {base} is not known here") from None
    return rate


# -- blocks -----------------------------------------------------------------------------------------------------------


def _block(rows: Sequence[Sequence[Node]], environment: Environment) -> Printed:
    found = [[value_of(entry, environment) for entry in row] for row in rows]
    found = [[_zero(value) for value in row] for row in found] if _in_blocks(found) else found
    heights: list[int | None] = [None] * len(rows)
    widths: list[int | None] = [None] * len(rows[0])
    for i, row in enumerate(found):
        for j, value in enumerate(row):
            if isinstance(value, Term):
                height, width = shape(value) or (1, 1)
                for sizes, index, size, what in ((heights, i, height, "row"), (widths, j, width, "column")):
                    if sizes[index] not in (None, size):
                        plural = f"{what}{'s' if size != 1 else ''}"
                        message = (
                            f"{rows[i][j]} has {size} {plural}, but another entry of its {what} has {sizes[index]}"
                        )
                        raise no_fit(message)
                    sizes[index] = size
    _spread(found, heights, widths)
    order = environment.values["A"].shape[0] if "A" in environment.values else 1  # type: ignore[union-attr]
    terms = []
    for i, row in enumerate(found):
        line = []
        for j, value in enumerate(row):
            room = (heights[i] or order, widths[j] or order)
            line.append(value if isinstance(value, Term) else _of_size(value, room, environment))
        terms.append(line)
    if any(is_signal(term) for line in terms for term in line) and not all(
        len(line) == 1 and is_signal(line[0]) for line in terms
    ):
        raise Misfit("signals are stacked in one column, with nothing else beside them")
    return block([list(line) for line in terms])


def _in_blocks(found: Sequence[Sequence[Printed]]) -> bool:
    """Whether a bracket holds matrices, so that a number 0 stands for a zero matrix."""
    values = [value for row in found for value in row]
    return any(isinstance(value, Flexible) or shape(value) not in (None, (1, 1)) for value in values)


def _zero(value: Printed) -> Printed:
    if isinstance(value, Term) and isinstance(value.value, Scalar) and value.value.is_zero:
        return Flexible(Scalar.of(0))
    return value


def _spread(found: Sequence[Sequence[Printed]], heights: list[int | None], widths: list[int | None]) -> None:
    """Let identity matrices carry the height of their row to the width of their column, and back, until all is said."""
    for _ in range(len(heights) + len(widths)):
        for i, row in enumerate(found):
            for j, value in enumerate(row):
                if isinstance(value, Flexible) and not value.factor.is_zero:
                    heights[i] = heights[i] or widths[j]
                    widths[j] = widths[j] or heights[i]


def _of_size(value: Flexible, size: tuple[int, int], environment: Environment) -> Term:
    if value.factor.is_zero:
        return Term(Literal(Matrix.zeros(*size)), environment)
    if size[0] != size[1]:
        raise no_fit(f"the identity matrix stands where a {sized(size)} block belongs")
    return Term(Literal(Matrix.identity(size[0]) * value.factor), environment)


# -- functions --------------------------------------------------------------------------------------------------------


def _call(node: Node, environment: Environment) -> Printed:
    if node.text == "integral":
        return _integral(node.parts, environment)
    found = [value_of(part, environment) for part in node.parts]
    if node.text == "size":
        return _size(node.parts[0], found[0], environment)
    arguments = [_argument(part, value) for part, value in zip(node.parts, found, strict=True)]
    return Term(Literal(applied(node, arguments, environment)), environment)


def _argument(part: Node, value: Printed) -> Matrix:
    if isinstance(value, Flexible) or is_signal(value):
        raise Misfit(f"{part} is no matrix here")
    return value.value if isinstance(value.value, Matrix) else Matrix.of([[value.value]])


def _size(part: Node, value: Printed, environment: Environment) -> Term:
    if isinstance(value, Flexible):
        raise Misfit(f"{part} has any size")
    return Term(Literal(Matrix.row(list(shape(value) or (1, 1)))), environment)


def _integral(parts: Sequence[Node], environment: Environment) -> Term:
    if parts[1].kind != "letter":
        raise Misfit(f"{parts[1]} is no time to integrate over")
    integrand, begin, end = (_argument(part, value_of(part, environment)) for part in (parts[0], *parts[2:]))
    found = integrated(integrand, parts[1].text, (begin[0, 0], end[0, 0]))
    if found is None:
        raise InputError(f"the integral of {parts[0]} has no closed form here", repair="leave the entry out")
    return Term(Literal(found), environment)


# -- comparison -------------------------------------------------------------------------------------------------------


def common(left: Printed, right: Printed, environment: Environment) -> tuple[Term, Term]:
    """Return two sides in one size; raises Misfit where they have none."""
    if isinstance(left, Flexible) or isinstance(right, Flexible):
        if isinstance(left, Term):
            return left, fitted(right, left)  # type: ignore[arg-type]
        if isinstance(right, Term):
            return fitted(left, right), right
        return tuple(Term(Literal(side.factor), environment) for side in (left, right))  # type: ignore[return-value]
    if not _alike(left, right) and (_is_zero(left) or _is_zero(right)):
        return (left, left - left) if _is_zero(right) else (right - right, right)
    if not _alike(left, right):
        raise no_fit(f"the left side {kind_of(left)}, the right side {kind_of(right)}")
    return left, right


def _is_zero(term: Term) -> bool:
    return isinstance(term.value, Scalar) and term.value.is_zero


def equal(left: Term, right: Term) -> bool:
    """Tell whether two sides are equal, by a certificate."""
    environment = left.environment
    exact = [value for value in (left.value, right.value) if isinstance(value, (Scalar, Matrix))]
    meanings, relations = identities(exact)
    if meanings or relations:
        environment = Environment(environment.variable, coefficients=meanings, relations=relations)
        return bool(verify(Relation((Literal(exact[0]), Literal(exact[1])), ("=",)), environment)[0])
    return bool(verify(Relation((left.formula, right.formula), ("=",)), environment)[0])


def holds(left: Node, right: Node, environment: Environment) -> bool:
    """Tell whether an equation is true; one whose sizes do not fit is not."""
    try:
        return equal(*common(value_of(left, environment), value_of(right, environment), environment))
    except (Misfit, Unknown, *EVALUATION_ERRORS):  # InputError is a ValueError
        return False
