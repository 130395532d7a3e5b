"""Formulas as text, in the one notation of claims, lines of pages, obligations and phrases: `A.T P + P A = -Q`.

Side by side (or with `*`) is a product; `.T` and `ᵀ` the transpose, `x'` and `d/dt x` the derivative, `^` and `**` a power,
`f(t = 0)` a value at an instant, `[A, B; C, D]` a matrix of blocks, `pencil(M)` is s I − M, `#X` the value of X and a lone `#`
that of the first member, `{name}` a value or a term that is handed in.  0 and I have the shape that their place demands.

A text is read once.  Where it has no part that depends on an environment, all relations of it are one object.
"""

from __future__ import annotations

import re
from functools import lru_cache
from typing import TYPE_CHECKING, Any, NoReturn, TypeAlias, TypeVar

from symobs.exact import Matrix, Scalar, product_of
from symobs.formula.tree.nodes import (
    Apply,
    At,
    Block,
    Decimals,
    Derivative,
    Formula,
    Identity,
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
    with_children,
)
from symobs.formula.tree.term import Environment, Term, factors_of, terms_of
from symobs.ground.dataclass import dataclass

Found = TypeVar("Found", Formula, Relation)

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    #: Rows and columns; none of a scalar, None where only the place can tell.
    Shape: TypeAlias = tuple[int, ...] | None

OPERATORS = ("!==", "!=", ">=", "<=", "=", ">", "<", "~", "≈")
_TOKEN = re.compile(
    r"\s*(d/d[a-z]\w*|\d+|[A-Za-z_]\w*|\{\w+\}|\.T|ᵀ|\*\*|!==|!=|>=|<=|[-+*/^=<>~≈()\[\],;'#])", re.ASCII
)
_ZERO = Literal(Scalar.of(0))
#: What is known only where a formula stands: a value, a matrix pencil, and the order of I.
_VALUE, _PENCIL, _UNIT = "#", "pencil", Identity(0)


def written(text: str, environment: Environment, **slots: Any) -> Term:
    """Return the term of a text; a slot is a value or a term for `{name}`, or the letter that stands for one of the text.

    Raises `ValueError` where the text is no formula, or a value has the name of a letter in it.
    """
    found = _with_places(read_formula, text, slots)
    return Term(_Place(environment, slots).put(found) if _depends(found, slots) else found, environment)


def written_relation(text: str, environment: Environment, **slots: Any) -> Relation:
    """Return the relation of a text, with slots."""
    found = _with_places(read_relation, text, slots)
    return _Place(environment, slots).relation(found) if any(_depends(m, slots) for m in found.members) else found


@lru_cache(maxsize=4096)
def read_formula(text: str) -> Formula:
    """Return the formula of a text, with its slots and units still open."""
    reader = _Reader(text)
    found = reader.sum()
    return found if not reader.left else reader.refuse()


@lru_cache(maxsize=4096)
def read_relation(text: str) -> Relation:
    """Return the relation of a text, with its slots and units still open."""
    reader = _Reader(text)
    members, operators = [reader.sum()], list[str]()
    while operator := reader.take(*OPERATORS):
        operators.append(operator)
        alone = reader.next == _VALUE and (len(reader.left) == 1 or reader.left[-2] in OPERATORS)
        members.append(Apply(reader.take(_VALUE), members[0]) if alone else reader.sum())
    return Relation(tuple(members), tuple(operators)) if operators and not reader.left else reader.refuse()


def _with_places(read: Callable[[str], Found], text: str, slots: Mapping[str, Any]) -> Found:
    for name, slot in slots.items():
        if not isinstance(slot, str) and re.search(rf"(?<!{{)\b{name}\b", text):
            raise ValueError(f"{text!r} has a letter {name}, and a value of that name")
    return read(text)


def stacked(row: str, of: str, count: int, *, across: bool = False) -> str:
    """Return the text of [C; CA; CA²; …], or of [B, AB, A²B, …] across."""
    powers = (f"{of}^{k} {row}" if across else f"{row} {of}^{k}" for k in range(1, count))
    return f"[{(', ' if across else '; ').join((row, *powers))}]"


class _Reader:
    """A text that is read from left to right."""

    def __init__(self, text: str) -> None:
        self.text, tokens, place = text.strip().replace("−", "-"), list[str](), 0
        while place < len(self.text):
            found = _TOKEN.match(self.text, place) or self.refuse()
            tokens.append(found[1])
            place = found.end()
        self.left = tokens[::-1]

    def refuse(self) -> NoReturn:
        raise ValueError(f"{self.text!r} is no formula")

    @property
    def next(self) -> str:
        return self.left[-1] if self.left else ""

    def take(self, *wanted: str) -> str:
        return self.left.pop() if self.next in wanted and self.left else ""

    def demand(self, wanted: str) -> None:
        if not self.take(wanted):
            self.refuse()

    def sum(self) -> Formula:
        total = Negative(self.product()) if self.take("-") else self.product()
        while sign := self.take("+", "-"):
            part = self.product()
            total = Sum((*terms_of(total), *(terms_of(part) if sign == "+" else (Negative(part),))))
        return total

    def product(self) -> Formula:
        total = self.factor()
        while self.next not in {"", "+", "-", ")", "]", ",", ";", *OPERATORS}:
            if self.take("/"):
                total = Quotient(total, self.factor())
            else:
                self.take("*")
                total = Product((*factors_of(total), *factors_of(self.factor())))
        return total

    def factor(self) -> Formula:
        if self.next.startswith("d/d"):
            name = self.left.pop().removeprefix("d/d")
            return Derivative(self.factor(), name)
        found = self.base()
        while True:
            if self.take(".T", "ᵀ"):
                found = Transpose(found)
            elif self.take("'"):
                found = Derivative(found)
            elif self.take("^", "**"):
                exponent = self.exponent()
                found = found if exponent == 1 else Power(found, exponent)
            elif self.next == "(" and self.left[-3:-2] == ["="]:
                self.left.pop()
                name = self.left.pop()
                self.demand("=")
                found = At(found, name, _instant(self.sum()))
                self.demand(")")
            else:
                return found

    def exponent(self) -> int:
        closing = bool(self.take("("))
        sign = -1 if self.take("-") else 1
        if not self.next.isdigit():
            self.refuse()
        found = sign * int(self.left.pop())
        if closing:
            self.demand(")")
        return found

    def base(self) -> Formula:
        part = self.left.pop() if self.left else self.refuse()
        if part == "(":
            found = self.sum()
            self.demand(")")
        elif part == "[":
            found = self.block()
        elif part == _VALUE:
            found = Apply(part, self.factor())
        elif part.isdigit():
            found = Literal(Scalar.of(int(part)))
        elif not (part.isidentifier() or part[0] == "{"):
            self.refuse()
        elif part == "I":
            found = _UNIT
        elif part == "integral" and self.take("("):
            found = self.integral()
        elif self.next == "(" and self.left[-3:-1] in ([")", "s"], [")", "z"]):  # φ(s) is φ
            found, self.left[-3:] = Letter(part), []
        elif (part in {"det", "rank", "adj", _PENCIL} or part.endswith("_at")) and self.take("("):
            found = Apply(part, self.sum())
            self.demand(")")
        else:
            found = Letter(part)
        return found

    def block(self) -> Formula:
        rows = [[self.sum()]]
        while sign := self.take(",", ";"):
            if sign == ";":
                rows.append([])
            rows[-1].append(self.sum())
        self.demand("]")
        return Block(tuple(map(tuple, rows)))

    def integral(self) -> Formula:
        """Read what follows `integral(`: the integrand, the variable, the ends, and a primitive if there is one."""
        parts = [self.sum()]
        while self.take(","):
            parts.append(self.sum())
        self.demand(")")
        integrand, variable, lower, upper, *primitive = parts
        name = variable.name if isinstance(variable, Letter) else self.refuse()
        whole = primitive[0] if primitive else integrand
        return Integral(integrand, whole, name, _instant(lower), _instant(upper))


@dataclass
class _Place:
    """Where a formula stands: what its letters and slots mean, and so how large 0 and I are."""

    environment: Environment
    slots: Mapping[str, Any]

    def relation(self, found: Relation) -> Relation:
        shapes = [self.shape(member) for member in found.members]
        shape = next((s for s in shapes if s), None)
        members = [self.put(found.members[0], shape)]
        for member in found.members[1:]:
            is_zero = member == _ZERO and shapes[0]
            members.append(Literal(Matrix.zeros(*shapes[0])) if is_zero and shapes[0] else self.put(member, shape))
        return Relation(tuple(members), found.operators)

    def put(self, found: Formula, shape: Shape = None) -> Formula:
        """Return a formula with its slots filled, in a place of some shape."""
        match found:
            case Letter(name):
                return self.letter(name)
            case Identity(0):
                return Identity((shape or self.shape(Letter("A")) or (0,))[0])
            case Apply(function, argument) if function in {_VALUE, _PENCIL}:
                inner = self.put(argument)
                if function == _VALUE:
                    return Literal(Term(inner, self.environment).value)
                return Sum((Product((Letter("s"), Identity((self.shape(inner) or (0,))[0]))), Negative(inner)))
            case Sum(terms):
                own = next((s for s in map(self.shape, terms) if s), shape)
                return Sum(tuple(part for term in terms for part in terms_of(self.put(term, own))))
            case Product(factors):
                return Product(tuple(part for factor in factors for part in factors_of(self.put(factor, shape))))
            case _:
                return with_children(found, tuple(self.put(part, shape) for part in children(found)))

    def letter(self, name: str) -> Formula:
        slot = self.slots[name[1:-1]] if name[0] == "{" else self.slots.get(name, name)
        slot = slot if name[0] == "{" or isinstance(slot, str) else name
        if isinstance(slot, str):
            return Letter("s" if slot == self.environment.variable and not self.environment.defines(slot) else slot)
        return slot.formula if isinstance(slot, Term) else Literal(Scalar.of(slot) if isinstance(slot, int) else slot)

    def shape(self, found: Formula) -> Shape:
        """Return the shape of a formula without its value."""
        match found:
            case Letter(name):
                formula = self.letter(name)
                name = formula.name if isinstance(formula, Letter) else ""
                if name:
                    return getattr(self.environment.values.get(name, _ZERO), "shape", ())
                return self.shape(formula)
            case Literal(value) | Decimals(value):
                return getattr(value, "shape", ())
            case Identity(order):
                return (order, order) if order else None
            case Sum(terms):
                return next((s for s in map(self.shape, terms) if s is not None), None)
            case Product(factors):
                shapes = [s for s in map(self.shape, factors) if s != ()]
                first, last = (shapes[0], shapes[-1]) if shapes else ((), ())
                return () if not shapes else None if first is None or last is None else (first[0], last[1])
            case Transpose(operand):
                return (self.shape(operand) or ())[::-1]
            case Apply("det" | "rank"):
                return ()
            case Block(rows):
                heights, widths = [self.shape(row[0]) for row in rows], [self.shape(entry) for entry in rows[0]]
                return sum((s or (1,))[0] for s in heights), sum((s or (1, 1))[1] for s in widths)
            case _:
                return self.shape(children(found)[0])


def _depends(found: Formula, slots: Mapping[str, Any]) -> bool:
    """Return whether a formula has a part that depends on where it stands."""
    match found:
        case Letter(name):
            return name[0] == "{" or name in slots or name == "z"
        case Identity() | Apply("#" | "pencil"):
            return True
        case Literal(value):
            return value == 0
        case _:
            return any(_depends(part, slots) for part in children(found))


def _instant(found: Formula) -> Scalar:
    """Return a number or an expression of parameters as the instant that a text names."""
    parts = [Scalar.symbol(found.name)] if isinstance(found, Letter) else [*map(_instant, children(found))]
    match found:
        case Letter() | Sum():
            return sum(parts[1:], parts[0])
        case Literal(Scalar() as value):
            return value
        case Negative():
            return -parts[0]
        case Product():
            return product_of(parts)
        case Quotient():
            return parts[0] / parts[1]
        case Power(_, exponent):
            return parts[0] ** exponent
    raise ValueError(f"{found} is no instant")
