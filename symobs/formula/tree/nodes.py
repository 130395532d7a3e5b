"""The formula tree: the lines of a derivation as written by their author.

Fifteen kinds of node, frozen, never rewritten: `A - L C` stays `A - L C`.  A formula has a value only in an
environment (`evaluate`), and is printed only by a format.
"""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING, Any, TypeAlias, TypeVar

from symobs.exact.core.generators import all_roots
from symobs.ground.dataclass import dataclass

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from symobs.exact import Matrix, Root, Scalar
    from symobs.exact.core.generators import Function


Found = TypeVar("Found")


@dataclass
class Letter:
    """A named quantity of the derivation, such as A, L, x̂ or χ; `name` is its key in `notation`."""

    name: str


@dataclass
class Literal:
    """An exact value written out."""

    value: Scalar | Matrix


@dataclass
class Decimals:
    """Decimals written out, as digits and not as fractions: exact where they follow `=`, rounded where they follow `≈`."""

    value: Scalar | Matrix


@dataclass
class Numeral:
    """An exact number that is not negative, and the decimals printed for it: `0.33333`, `1.2346e-7`, or exactly `10.78`.

    It stands on pages only, never in a derivation: `decimals_check` holds what is printed against the exact line.
    """

    value: Scalar
    text: str


@dataclass
class Identity:
    """The identity matrix I."""

    order: int


@dataclass
class Sum:
    """terms[0] + terms[1] + …; a `Negative` term is printed with a minus sign."""

    terms: tuple[Formula, ...]


@dataclass
class Negative:
    """The negative of an operand."""

    operand: Formula


@dataclass
class Product:
    """factors[0] · factors[1] · …, in this order."""

    factors: tuple[Formula, ...]


@dataclass
class Power:
    """base to an integer exponent; −1 is the inverse."""

    base: Formula
    exponent: int


@dataclass
class Transpose:
    """operandᵀ."""

    operand: Formula


@dataclass
class Quotient:
    """numerator / denominator, the denominator a scalar."""

    numerator: Formula
    denominator: Formula


@dataclass
class Apply:
    """A function of one argument: det, adj, rank."""

    function: str
    argument: Formula


@dataclass
class Block:
    """A matrix (or stacked signal) put together from blocks."""

    rows: tuple[tuple[Formula, ...], ...]


@dataclass
class Derivative:
    """d/dt of a signal or of a function of time, d/d(name) of a value; the shift x(k+1) of a signal in discrete time."""

    operand: Formula
    name: str = "t"


@dataclass
class At:
    """The operand with the generator `name` (a time) replaced by `instant`."""

    operand: Formula
    name: str
    instant: Scalar


@dataclass
class Integral:
    """∫ integrand d(name) from `lower` to `upper`; `primitive` is the witness, whose derivative is the integrand."""

    integrand: Formula
    primitive: Formula
    name: str
    lower: Scalar
    upper: Scalar


Formula: TypeAlias = (
    Letter
    | Literal
    | Decimals
    | Numeral
    | Identity
    | Sum
    | Negative
    | Product
    | Power
    | Transpose
    | Quotient
    | Apply
    | Block
    | Derivative
    | At
    | Integral
)


@dataclass
class Relation:
    """members[0] operators[0] members[1] …: a chain of equations and comparisons, each link a claim.

    Operators are `=`, `!=`, `<`, `>`, `<=`, `>=`, `~` between matrices whose rows span the same space, and
    `≈` before decimals that are rounded.
    """

    members: tuple[Formula, ...]
    operators: tuple[str, ...]

    @cached_property
    def texts(self) -> dict[str, str]:
        """Its text by the variable it was written with: the claims of a type are one relation."""
        return {}

    @cached_property
    def derived_by(self) -> frozenset[str]:
        """The names of the variables of its derivatives."""
        return frozenset().union(*map(derived_by, self.members))

    @cached_property
    def is_of_instants(self) -> bool:
        """Whether it contains a value at an instant, or an integral."""
        return any(map(is_of_instants, self.members))


@dataclass
class Predicate:
    """A property of a value other than an equation: `stable`, `strictly_proper`, `never_zero`."""

    name: str
    subject: Formula


@dataclass
class Roots:
    """The roots of a monic polynomial (of a rational function: its poles), with multiplicity; printed as their list."""

    polynomial: Formula
    values: tuple[Root, ...]


#: Significant digits of roots in decimals on a page of exact numbers.
ROOT_DIGITS = 5


@dataclass
class RoundedRoots(Roots):
    """The same in decimals: (real part, imaginary part, whether one is rounded) for each root."""

    texts: tuple[tuple[str, str, bool], ...]


@dataclass
class HoldsExactlyWhere:
    """A property of a value holds if and only if these inequalities do; printed as their list."""

    property: Predicate
    where: tuple[Relation, ...]


@dataclass
class Conjunction:
    """The conjunction of several relations; printed as their list."""

    relations: tuple[Relation, ...]


@dataclass
class Evaluated:
    """The value of a formula, printed without the formula."""

    formula: Formula
    value: Formula


@dataclass
class SymbolList:
    """A list of parameters in a sentence, without a claim."""

    names: tuple[str, ...]


@dataclass
class LetterList:
    """A list of letters that a sentence asks for: they need not be known, and nothing is claimed of them."""

    letters: tuple[Formula, ...]


Fact: TypeAlias = Relation | Predicate | Roots | HoldsExactlyWhere | Conjunction | Evaluated | SymbolList


#: Where the formulas directly below a node stand; asked for more often than anything else of a formula.
_BELOW: dict[type, Callable[[Any], tuple[Formula, ...]]] = {
    Sum: lambda node: node.terms,
    Product: lambda node: node.factors,
    Quotient: lambda node: (node.numerator, node.denominator),
    Negative: lambda node: (node.operand,),
    Transpose: lambda node: (node.operand,),
    Derivative: lambda node: (node.operand,),
    At: lambda node: (node.operand,),
    Apply: lambda node: (node.argument,),
    Power: lambda node: (node.base,),
    Integral: lambda node: (node.integrand, node.primitive),
    Block: lambda node: tuple(entry for row in node.rows for entry in row),
}


def children(formula: Formula) -> tuple[Formula, ...]:
    """Return the formulas directly below."""
    below = _BELOW.get(type(formula))
    return () if below is None else below(formula)


def with_children(formula: Formula, parts: tuple[Formula, ...]) -> Formula:
    """Return the node with other children."""
    match formula:
        case Sum():
            return Sum(parts)
        case Product():
            return Product(parts)
        case Quotient():
            return Quotient(parts[0], parts[1])
        case Negative():
            return Negative(parts[0])
        case Transpose():
            return Transpose(parts[0])
        case Derivative(_, name):
            return Derivative(parts[0], name)
        case At(_, name, instant):
            return At(parts[0], name, instant)
        case Integral(_, _, name, lower, upper):
            return Integral(parts[0], parts[1], name, lower, upper)
        case Apply(function, _):
            return Apply(function, parts[0])
        case Power(_, exponent):
            return Power(parts[0], exponent)
        case Block(rows):
            entries = iter(parts)
            return Block(tuple(tuple(next(entries) for _ in row) for row in rows))
        case _:
            return formula


def contains(formula: Formula, kinds: tuple[type, ...]) -> bool:
    """Return whether a formula has a node of one of these kinds."""
    return isinstance(formula, kinds) or any(contains(part, kinds) for part in children(formula))


def is_rational(formula: Formula) -> bool:
    """Return whether a value is made of those of the leaves by arithmetic, inverses, determinants and adjugates alone."""
    if isinstance(formula, (At, Derivative, Integral)) or (isinstance(formula, Apply) and formula.function == "rank"):
        return False
    return all(map(is_rational, children(formula)))


def divisors(formula: Formula) -> Iterator[Formula]:
    """Yield the denominators of a formula."""
    match formula:
        case Quotient(_, below):
            yield below
        case Power(base, exponent) if exponent < 0:
            yield base
    for part in children(formula):
        yield from divisors(part)


def _kept(find: Callable[[Formula], Found]) -> Callable[[Formula], Found]:
    """Keep what is found in a formula beside its parts: the formula cannot be changed."""
    name = f"_{find.__name__}"

    def kept(formula: Formula) -> Found:
        own = formula.__dict__
        if name not in own:
            own[name] = find(formula)
        found: Found = own[name]
        return found

    kept.__doc__ = find.__doc__
    return kept


@_kept
def derived_by(formula: Formula) -> frozenset[str]:
    """Return the names of the variables of all derivatives in a formula."""
    own = {formula.name} if isinstance(formula, Derivative) else set()
    return frozenset(own).union(*(derived_by(part) for part in children(formula)))


@_kept
def is_of_instants(formula: Formula) -> bool:
    """Return whether a formula contains a value at an instant, or an integral."""
    return isinstance(formula, (At, Integral)) or any(is_of_instants(part) for part in children(formula))


@_kept
def roots_written(formula: Formula) -> frozenset[Function]:
    """Return the square roots in the values written out in a formula, also in arguments of functions."""
    own = all_roots(formula.value) if isinstance(formula, Literal) else ()
    return frozenset(own).union(*(roots_written(part) for part in children(formula)))


@_kept
def letters(formula: Formula) -> frozenset[str]:
    """Return the names of all letters in a formula."""
    if isinstance(formula, Letter):
        return frozenset((formula.name,))
    return frozenset().union(*(letters(part) for part in children(formula)))
