"""Check that inequalities hold exactly where a polynomial has a property (trusted)."""

from __future__ import annotations

from itertools import pairwise
from typing import TYPE_CHECKING

from symobs.formula.tree import Exact, evaluate
from symobs.proof.certificate.claims import as_scalar
from symobs.proof.derivation.facts.properties import is_criterion

if TYPE_CHECKING:
    from symobs.exact import Scalar
    from symobs.formula.tree import Environment, HoldsExactlyWhere


def is_exactly(fact: HoldsExactlyWhere, polynomial: Scalar, environment: Environment, *, discrete: bool) -> bool:
    """Return whether a polynomial has a property exactly where some inequalities hold.

    They are those that the criterion asks for, or proved to say the same; with one or two parameters by the region itself.
    """
    arithmetic, name = Exact(environment), fact.property.name
    said: list[tuple[Scalar, str]] = []
    for relation in fact.where:
        values = [as_scalar(evaluate(member, environment, arithmetic)) for member in relation.members]
        for (left, right), operator in zip(pairwise(values), relation.operators, strict=True):
            said.append((right - left if operator[0] == "<" else left - right, operator))
    allowed = {">", "<", "!="} if name == "stable" else {">=", "<="}
    if not {operator for _, operator in said} <= allowed:
        return False
    positive = tuple(value**2 if operator == "!=" else value for value, operator in said)
    if is_criterion(name, polynomial, positive, environment, discrete):
        return True
    if name != "stable" or not said:
        return False
    from symobs.proof.derivation.region_check import holds_exactly, region_of  # noqa: PLC0415 - only pages of regions pay for it
    from symobs.stability.criteria.stability_conditions import is_stable_where  # noqa: PLC0415 - the same

    region = region_of(polynomial, environment, discrete=discrete)
    where = tuple((value, "!=" if operator == "!=" else ">") for value, operator in said)
    if region is not None and holds_exactly(region, where):
        return True
    return is_stable_where(polynomial, environment.variable, positive, environment.signs, discrete=discrete)
