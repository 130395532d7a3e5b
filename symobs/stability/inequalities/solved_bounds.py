"""Conditions as bounds of the parameters: h₁ < 1, h₂ > −b, and their box if they are uncoupled."""

from __future__ import annotations

from itertools import product
from typing import TYPE_CHECKING

from symobs.exact import Scalar
from symobs.ground.dataclass import dataclass
from symobs.stability.inequalities.prover import prove
from symobs.stability.inequalities.written_form import as_inequality
from symobs.system.conditions import sign_of

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

ZERO = Scalar.of(0)
#: A longer condition is left as it is where its coefficients have no sign of their own.
_HELPED_UP_TO = 60


def solved(
    positive: Sequence[Scalar],
    signs: Mapping[str, str],
    parameters: Sequence[str] = (),
    beside: Sequence[Scalar] = (),
) -> list[tuple[Scalar, str, Scalar]]:
    """Return each condition > 0 as (left, operator, right), solved for a parameter if it is linear in one.

    Its coefficient has a certain sign by the declared signs, or where `beside` and the other conditions are positive.
    """
    found = {value: as_inequality(value, signs, parameters) for value in positive}
    wanted = [value for value in positive if not _is_solved(found[value], signs, parameters)]
    plain = list(positive)  # what is said without the help of a condition that is itself said with help
    for value in wanted:
        others = [*beside, *(other for other in plain if other != value)]
        helped = _with_help(value, signs, parameters, others)
        if helped is not None:
            found[value] = helped
            plain.remove(value)
    return [found[value] for value in positive]


def _is_solved(relation: tuple[Scalar, str, Scalar], signs: Mapping[str, str], parameters: Sequence[str]) -> bool:
    name = str(relation[0])
    return relation[1] == "!=" or name in parameters or (not parameters and name in relation[0].names - set(signs))


def _with_help(
    value: Scalar, signs: Mapping[str, str], parameters: Sequence[str], others: Sequence[Scalar]
) -> tuple[Scalar, str, Scalar] | None:
    if value.size > _HELPED_UP_TO:
        return None
    relation = as_inequality(value, signs, parameters, others)
    if _is_solved(relation, signs, parameters):
        return relation
    for name in sorted(value.names.intersection(parameters) or value.names - set(signs)):
        if value.degree(name) == 1:
            lead, rest = value.coefficients(name)
            for sign, operator in ((1, ">"), (-1, "<")):
                if prove(sign * lead, others, signs) is not None:
                    return Scalar.symbol(name), operator, -rest / lead
    return None


@dataclass(frozen=True)
class IntervalBox:
    """A product of open intervals: a parameter lies above all its `lower` and below all its `upper` bounds.

    It is convex, so in one piece, and not empty exactly where all of `needs` are > 0; `sample` is a point of it, None
    where none was proven to be one.
    """

    lower: Mapping[str, tuple[Scalar, ...]]
    upper: Mapping[str, tuple[Scalar, ...]]
    needs: tuple[Scalar, ...]
    sample: Mapping[str, Scalar] | None

    @property
    def bounded(self) -> bool:
        """Whether every parameter has bounds on both sides."""
        return all(self.lower[name] and self.upper[name] for name in self.lower)


def box(conditions: Sequence[Scalar], parameters: Sequence[str], signs: Mapping[str, str]) -> IntervalBox | None:
    """Return the box of the conditions > 0, None if one of them is nonlinear or couples parameters."""
    lower: dict[str, list[Scalar]] = {name: [] for name in parameters}
    upper: dict[str, list[Scalar]] = {name: [] for name in parameters}
    needs = []
    for value in conditions:
        inside = [name for name in parameters if name in value.names]
        if not inside:
            needs.append(value)
            continue
        (name, *others) = inside
        bound = None if others else _bound(value, name, signs)
        if bound is None:
            return None
        (lower if bound[0] == ">" else upper)[name].append(bound[1])
    for name in parameters:
        lower[name] += [ZERO] * (signs.get(name) == "positive")
        upper[name] += [ZERO] * (signs.get(name) == "negative")
        if signs.get(name, "real") not in {"positive", "negative", "real"}:
            return None
        needs += [high - low for low, high in product(lower[name], upper[name])]
    open_ = tuple(dict.fromkeys(value for value in needs if sign_of(value, signs) != "positive"))
    found = {name: _between(lower[name], upper[name], signs) for name in parameters}
    sample = {name: value for name, value in found.items() if value is not None}
    proven = len(sample) == len(found) and all(_holds(value, sample, open_, signs) for value in conditions)
    below, above = ({name: tuple(dict.fromkeys(v)) for name, v in side.items()} for side in (lower, upper))
    return IntervalBox(below, above, open_, sample if proven else None)


def _bound(value: Scalar, name: str, signs: Mapping[str, str]) -> tuple[str, Scalar] | None:
    if value.degree(name) != 1 or not value.is_polynomial_in(name):
        return None
    lead, rest = value.coefficients(name)
    operator = {"positive": ">", "negative": "<"}.get(sign_of(lead, signs))
    return None if operator is None else (operator, -rest / lead)


def _between(lower: Sequence[Scalar], upper: Sequence[Scalar], signs: Mapping[str, str]) -> Scalar | None:
    """Return a value above all lower and below all upper bounds, if the signs order them."""
    below, above = _greatest(lower, signs), _greatest([-value for value in upper], signs)
    if (lower and below is None) or (upper and above is None):
        return None
    if below is not None and above is not None:
        return (below - above) / 2
    if below is not None:
        return ZERO if sign_of(-below, signs) == "positive" else below + 1
    if above is not None:
        return ZERO if sign_of(-above, signs) == "positive" else -above - 1
    return ZERO


def _greatest(values: Sequence[Scalar], signs: Mapping[str, str]) -> Scalar | None:
    weak = {"positive", "nonnegative", "zero"}
    return next((v for v in values if all(sign_of(v - other, signs) in weak for other in values)), None)


def _holds(value: Scalar, sample: Mapping[str, Scalar], needs: Sequence[Scalar], signs: Mapping[str, str]) -> bool:
    """Return whether a condition holds at a symbolic point where the needs are positive."""
    there = value.substitute(sample)
    return sign_of(there, signs) == "positive" or any(sign_of(there / need, signs) == "positive" for need in needs)
