"""The check of a page in decimals against its exact steps (trusted).

The exact steps have been checked before.  What is printed differs from them in nothing but numbers: every decimal is the
correct rounding of the exact number that stands there, or that number; `≈` stands for `=` beside a rounded one and
nowhere else.  What conditions an answer is rounded beside the exact number, a value without a relation sign before it never.
"""

from __future__ import annotations

from dataclasses import fields, is_dataclass, replace
from fractions import Fraction
from itertools import pairwise
from operator import ge, gt, le, lt, ne
from typing import Any

from symobs.exact import Matrix, Scalar, is_correctly_written
from symobs.exact.algebraic.root_parts import in_modes, vanishes
from symobs.exact.core.generators import identities
from symobs.exact.numerals.rounded_roots import are_rounded_roots
from symobs.formula.figures import letter_for, without_sign
from symobs.formula.tree import (
    Block,
    Environment,
    Evaluated,
    Exact,
    Formula,
    HoldsExactlyWhere,
    Identity,
    Letter,
    Literal,
    Negative,
    Numeral,
    Power,
    Product,
    Quotient,
    Relation,
    RoundedRoots,
    Sum,
    Transpose,
    children,
    evaluate,
    exact_meaning,
    is_rounded,
    with_children,
)
from symobs.ground.errors import DerivationRejected
from symobs.proof.certificate.claims import UNREADABLE, verify
from symobs.proof.derivation.facts import BUG, reject
from symobs.proof.derivation.steps import CaseStep, Diagram, Given, Inequalities, literals

_ORDER = {"<": lt, ">": gt, "<=": le, ">=": ge, "!=": ne}


def check_decimals(exact: object, shown: object, variable: str, digits: int) -> None:
    """Raise `DerivationRejected` unless the steps in decimals are the exact steps, correctly rounded."""
    try:
        _Comparison(variable, digits).compare(exact, shown)
    except UNREADABLE as error:
        message = f"a step in decimals cannot be read: {error}"
        raise DerivationRejected(message, repair=BUG, line=str(shown)) from error


class _Comparison:
    """The comparison of a page with its exact steps; `variable` is that of polynomials."""

    def __init__(self, variable: str, digits: int) -> None:
        self.environment = Environment(variable=variable)
        self.digits = digits

    def compare(self, exact: Any, shown: Any, *, exactly: bool = False) -> None:
        """Compare steps, sentences, facts or formulas; `exactly` where nothing may be rounded."""
        if isinstance(exact, Relation) and isinstance(shown, Relation):
            self._relation(exact, shown, exactly=exactly)
        elif isinstance(shown, RoundedRoots):
            if shown.polynomial != exact.polynomial or shown.values != exact.values:
                reject(f"{shown}, which are other roots,")
            if not are_rounded_roots(shown.values, shown.texts, self.digits):
                reject(f"that the roots are about {shown.texts}")
        elif isinstance(exact, Formula):
            self._formula(exact, shown)
            if is_rounded(shown):
                reject(f"{shown}, rounded without a sign that says so,")
        elif isinstance(exact, tuple) and isinstance(shown, tuple) and len(exact) == len(shown):
            for one, other in zip(exact, shown, strict=True):
                self.compare(one, other, exactly=exactly)
        elif isinstance(exact, Diagram) and isinstance(shown, Diagram):
            if exact.name != shown.name or dict(exact.labels).keys() != dict(shown.labels).keys():
                reject(f"{shown}, another figure,")
            self.compare(exact.sentence, shown.sentence, exactly=exactly)
            for (place, label), (_, other) in zip(exact.labels, shown.labels, strict=True):
                if isinstance(label, Negative) and without_sign(label)[0] != without_sign(other)[0]:
                    reject(f"{other}, without the sign of {label} at its junction,")
                if other != letter_for(exact.name, place, label):  # which a format may draw for any label
                    self.compare(label, other, exactly=exactly)
        elif is_dataclass(exact) and type(exact) is type(shown):
            exactly = exactly or isinstance(exact, Given | Inequalities | HoldsExactlyWhere | Evaluated)
            for part in fields(exact):
                conditions = isinstance(exact, CaseStep) and part.name == "when"
                one, other = getattr(exact, part.name), getattr(shown, part.name)
                self.compare(one, other, exactly=exactly or conditions)
        elif exact != shown:
            reject(f"{shown}, in place of {exact},")

    def _relation(self, exact: Relation, shown: Relation, *, exactly: bool) -> None:
        """Compare chains, members perhaps once exactly and once in decimals, and every sign between members."""
        for place, sign in enumerate(shown.operators):
            first, rest = exact.members[: place + 1], exact.members[place:]
            if (
                sign == "≈"
                and first[-1] in shown.members[place : place + 2]
                and exact.operators[place : place + 1] != ("=",)
            ):
                exact = Relation((*first, *rest), (*exact.operators[:place], "=", *exact.operators[place:]))
        if len(exact.members) != len(shown.members) or len(exact.operators) != len(shown.operators):
            reject(f"{shown}, a chain of another length,")
        for one, other in zip(exact.members, shown.members, strict=True):
            self._formula(one, other)
        rounded = [is_rounded(member) for member in shown.members]
        near = [a == b and c != d for (a, b), (c, d) in zip(pairwise(exact.members), pairwise(rounded), strict=True)]
        if exactly and any(one and not any(two) for one, two in zip(rounded, pairwise((0, *near, 0)), strict=True)):
            reject(f"{shown}, a condition that is rounded,")
        if not is_in_order(shown):
            reject(f"{shown}, whose decimals are not in this order,")
        for before, operator, beside in zip(exact.operators, shown.operators, pairwise(rounded), strict=True):
            if operator != ("≈" if before == "=" and any(beside) else before):
                reject(f"{shown}, where {operator} stands for {before},")
        for member, signs in zip(rounded, pairwise(("", *shown.operators, "")), strict=True):
            if member and "≈" not in signs and not _ORDER.keys().isdisjoint(signs):
                reject(f"{shown}, a comparison with a rounded number that no ≈ says to be one,")

    def _formula(self, exact: Formula, shown: Formula) -> None:
        """Compare formulas: values by what they are, whatever their form, and others part by part."""
        if exact == shown:
            return
        if _is_value(exact) and _is_value(shown):
            arithmetic = Exact(self.environment)
            self._digits(shown)
            meant = exact_meaning(shown)
            value, read = (evaluate(each, self.environment, arithmetic) for each in (exact, meant))
            is_same = value == read or _are_modes(value, read, self.digits)
            if not is_same and not self._are_equal_in_time(exact, meant):
                reject(f"{shown}, whose value is not that of {exact},")
            return
        parts = children(shown)
        if type(exact) is not type(shown) or len(parts) != len(children(exact)) or with_children(exact, parts) != shown:
            reject(f"{shown}, in place of {exact},")
        for one, other in zip(children(exact), parts, strict=True):
            self._formula(one, other)

    def _are_equal_in_time(self, exact: Formula, shown: Formula) -> bool:
        """Return whether functions of time are equal by their dependences: e^{−2aT} is the square of e^{−aT}."""
        meanings, vanishing = identities(literals((exact, shown)))
        start = replace(self.environment, coefficients=meanings).with_relations(vanishing)
        return bool(meanings or vanishing) and verify(Relation((exact, shown), ("=",)), start)[0] != ""

    def _digits(self, shown: Formula) -> None:
        """Reject a decimal that is not the correct rounding of its number."""
        if isinstance(shown, Numeral) and not is_correctly_written(shown.value, shown.text, self.digits):
            reject(f"{shown.value} ≈ {shown.text}")
        for part in children(shown):
            self._digits(part)


def _are_modes(exact: Any, shown: Any, digits: int) -> bool:
    """Return whether the second value is the first with its sums over roots mode by mode."""
    if isinstance(exact, Matrix) and isinstance(shown, Matrix) and exact.shape == shown.shape:
        pairs = zip(exact.entries, shown.entries, strict=True)
        return all(one == other or _are_modes(one, other, digits) for one, other in pairs)
    modes = in_modes(exact, digits) if isinstance(exact, Scalar) else None
    return modes is not None and vanishes(modes - shown)


def is_in_order(shown: Relation) -> bool:
    """Return whether a comparison with a rounded number holds for the numbers that are read."""
    for operator, (left, right) in zip(shown.operators, pairwise(shown.members), strict=True):
        if operator in _ORDER and (is_rounded(left) or is_rounded(right)):
            first, second = _read(left), _read(right)
            if first is None or second is None or not _ORDER[operator](first, second):
                return False
    return True


def _is_value(formula: Formula) -> bool:
    """Return whether a formula is arithmetic of values written out, and of the variable."""
    arithmetic = Literal, Numeral, Sum, Negative, Product, Quotient, Power, Block, Transpose, Identity
    return formula == Letter("s") or (isinstance(formula, arithmetic) and all(map(_is_value, children(formula))))


def _read(shown: Formula) -> Fraction | None:
    """Return the number that a reader reads, None where it is no number."""
    match shown:
        case Numeral(text=text):
            return Fraction(text)
        case Negative(operand):
            size = _read(operand)
            return None if size is None else -size
        case Literal(Scalar() as value) if value.is_constant:
            return value.fraction()
    return None
