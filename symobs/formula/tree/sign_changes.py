"""Sign reversal: formulas in a convention in which a letter denotes the negative of its standard meaning.

Where L becomes −M, `A − L C` becomes `A + M C`, and `L = [3; 2]` becomes `M = [−3; −2]`.  Nothing else is rewritten, and
whoever asks for it has the lines checked again.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from symobs.exact import Matrix
from symobs.formula.tree.nodes import (
    At,
    Block,
    Decimals,
    Derivative,
    Formula,
    Integral,
    Letter,
    Literal,
    Negative,
    Power,
    Product,
    Quotient,
    Relation,
    Sum,
    Transpose,
    children,
    letters,
    with_children,
)
from symobs.ground.dataclass import dataclass

if TYPE_CHECKING:
    from collections.abc import Collection, Iterator, Sequence

_TURNED_AROUND = {"<": ">", ">": "<", "<=": ">=", ">=": "<="}


@dataclass
class SignReversal:
    """The letters with reversed sign, and their values; a matrix written out that equals one of these is reversed too."""

    names: frozenset[str]
    values: Collection[Matrix] = ()

    def concerns(self, formula: Formula) -> bool:
        """Return whether a formula contains one of the letters."""
        return not self.names.isdisjoint(letters(formula))

    # -- formulas -------------------------------------------------------------------------------------------------

    def formula(self, formula: Formula) -> Formula:
        """Return the formula in the new letters; a letter alone, which only names, is kept."""
        if isinstance(formula, Letter) or (isinstance(formula, Transpose) and isinstance(formula.operand, Letter)):
            return formula
        return self.whole(formula) if self.concerns(formula) else formula

    def whole(self, formula: Formula) -> Formula:
        """Return the formula in the new letters, with its sign in front."""
        negative, turned = self.signed(formula)
        return Negative(turned) if negative else turned

    def signed(self, formula: Formula, *, written: bool = False) -> tuple[bool, Formula]:
        """Return (whether a sign is extracted, the rest of the formula in the new letters).

        With `written` the values of the letters turn as the letters do.
        """
        match formula:
            case Letter(name):
                return name in self.names, formula
            case Literal(Matrix() as value) if written and value in self.values:
                return True, Literal(-value)
            case Negative(operand):
                negative, inner = self.signed(operand, written=written)
                return not negative, inner
        if not self.concerns(formula) and not (written and self._writes(formula)):
            return False, formula
        parts = [self.signed(part, written=written) for part in children(formula)]
        inner = with_children(formula, tuple(part for _, part in parts))
        signs = [negative for negative, _ in parts]
        match formula:
            case Product() | Quotient():
                return sum(signs) % 2 == 1, inner
            case Transpose() | Derivative() | At():
                return signs[0], inner
            case Power(_, exponent):
                return signs[0] and exponent % 2 == 1, inner
            case Integral() if signs[0] == signs[1]:
                return signs[0], inner
            case Sum() if all(signs):
                return True, inner
            case Block():
                shown = [sign for sign, (_, part) in zip(signs, parts, strict=True) if not _is_zero(part)]
                if all(shown) and shown:
                    return True, inner
        return False, with_children(formula, tuple(self._term(*part) for part in parts))

    def _term(self, negative: bool, formula: Formula) -> Formula:  # noqa: FBT001 - as `signed` returns them
        """Return one of several terms: + N x for − (−N) x, where N is the old value of a letter."""
        match formula:
            case Product((Literal(Matrix() as table), *rest)) if negative and -table in self.values:
                return Product((Literal(-table), *rest))
        return _with_sign(negative, formula)

    def _absorbed(self, formula: Formula) -> Formula:
        """Return −N x as (−N) x where N is the old value of a letter, since its new value is −N."""
        match formula:
            case Negative(Product((Literal(Matrix() as table), *rest))) | Product(
                (Negative(Literal(Matrix() as table)), *rest)
            ) if table in self.values:
                return Product((Literal(-table), *rest))
        return formula

    def _writes(self, formula: Formula) -> bool:
        """Return whether the value of one of the letters is written out in a formula."""
        if isinstance(formula, Literal):
            return isinstance(formula.value, Matrix) and formula.value in self.values
        return any(self._writes(part) for part in children(formula))

    # -- relations ------------------------------------------------------------------------------------------------

    def relation(self, relation: Relation) -> Relation:
        """Return the chain in the new letters; if its first member is a negative, all members change sign."""
        if not any(map(self.concerns, relation.members)):
            first, *rest = relation.members
            return Relation((first, *map(self._absorbed, rest)), relation.operators)
        signed = [self.signed(member, written=place > 0) for place, member in enumerate(relation.members)]
        if not signed[0][0]:
            members = [_member(*part) for part in signed]
            return Relation(tuple(_in_step(relation.members, members)), relation.operators)
        members = [part if negative else negated(part) for negative, part in signed]
        return Relation(tuple(members), tuple(_TURNED_AROUND.get(sign, sign) for sign in relation.operators))


def _with_sign(negative: bool, formula: Formula) -> Formula:  # noqa: FBT001 - as `signed` returns them
    return Negative(formula) if negative else formula


def _member(negative: bool, formula: Formula) -> Formula:  # noqa: FBT001 - as `signed` returns them
    """Return one side of a relation, a sum without parentheses."""
    match formula:
        case Sum(terms) if negative:
            return Sum(tuple(part.operand if isinstance(part, Negative) else Negative(part) for part in terms))
        case _:
            return _with_sign(negative, formula)


def negated(formula: Formula) -> Formula:
    """Return the negative, with the sign moved inwards to the first factor or the terms."""
    match formula:
        case Negative(operand):
            return operand
        case Literal(value):
            return Literal(-value)
        case Decimals(value):
            return Decimals(-value)
        case Sum((first, Negative(second))):
            return Sum((second, negated(first) if isinstance(first, Negative) else Negative(first)))
        case Sum(terms):
            return Sum(tuple(map(negated, terms)))
        case Block(rows):
            return Block(tuple(tuple(part if _is_zero(part) else negated(part) for part in row) for row in rows))
        case Product((Literal(Matrix() as unit), *_)) if all(entry.is_zero or entry.is_one for entry in unit.entries):
            return Negative(formula)
        case Product((Literal(Matrix()) | Block() as first, *rest)):
            return Product((negated(first), *rest))
        case Transpose(operand) if not isinstance(operand, Letter):
            return Transpose(negated(operand))
        case _:
            return Negative(formula)


def _in_step(before: Sequence[Formula], members: Sequence[Formula]) -> Iterator[Formula]:
    """Yield the members, each matrix written out with the sign of the product that it is the value of.

    After `A − L C = A₀ − N`, which has become `A + M C = A₀ − N`, the last member is `A₀ + (−N)`.
    """
    shown = members[0]
    yield shown
    for old, following in zip(before, members[1:], strict=False):
        match old, shown, following:
            case Sum(olds), Sum(news), Sum(values) if len(olds) == len(news) == len(values):
                shown = Sum(tuple(map(_value_in_step, olds, news, values)))
            case _:
                shown = following
        yield shown


def _value_in_step(old: Formula, new: Formula, value: Formula) -> Formula:
    """Return a term −N as (−N) if the minus of the corresponding term is absorbed."""
    match old, value:
        case Negative(), Negative(Literal(Matrix() as table)) if not isinstance(new, Negative):
            return Literal(-table)
    return value


def _is_zero(formula: Formula) -> bool:
    return isinstance(formula, Literal) and formula.value.is_zero
