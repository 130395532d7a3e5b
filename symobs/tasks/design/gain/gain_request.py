"""The common part of both gain tasks: reading the specification, choosing the method and its page."""

from __future__ import annotations

from typing import TYPE_CHECKING

from symobs.ground.errors import InputError
from symobs.system.specification import desired_polynomial, over_common_data, read_entries, read_gain, reject_both
from symobs.tasks.design.page_parts import readability
from symobs.tasks.result import choose

if TYPE_CHECKING:
    from symobs.system import StateSpace
    from symobs.system.specification import Entries, GainText, Name, Poles, PolynomialText
    from symobs.tasks.design.gain.gain_design import GainDesign
    from symobs.tasks.result import Result

#: The members of the family of gains that can be asked for by name.
MEMBERS = ("simple", "decoupled")


def design_gain(
    kind: type[GainDesign],
    plant: StateSpace,
    *,
    poles: Poles,
    polynomial: PolynomialText,
    given: GainText,
    zero: Entries,
    member: Name,
    method: Name,
) -> Result:
    """Return the design: with a given gain, with zeros, the requested member of the family, or by a method."""
    if member not in MEMBERS:
        message = f"{member[:40]!r} is no member of the family that has a name"
        raise InputError(message, where="specification.member", repair=f"write one of {', '.join(MEMBERS)}")
    gain, is_observer = kind.letter, kind.letter == "L"
    plant = plant.knowing(poles, polynomial, given)
    plant.require("C" if is_observer else "B", task=kind.task)
    reject_both(gain, given, poles, polynomial)
    reject_both(gain, given, zero, None, other="zero")
    reject_both(gain, given, None if member == "simple" else member, None, other="member")
    several = plant.outputs if is_observer else plant.inputs
    shape = (plant.order, several) if is_observer else (several, plant.order)
    if given is not None:
        return kind.of_given(plant, read_gain(given, plant, gain, shape))
    desired = desired_polynomial(plant, poles, polynomial)
    assert desired is not None  # noqa: S101 - required
    plant, (desired,) = over_common_data(plant, desired)
    chosen = choose(kind.task, method, "ackermann" if several == 1 else "sylvester")
    if member != "simple":
        reject_both("member", member, zero, None, other="zero")
        return kind.of(plant, desired, chosen.name, decoupled=True).asked(method)
    if zero is not None:
        return kind.of(plant, desired, chosen.name, read_entries(zero, "zero", shape)).asked(method)
    return chosen.solve(plant, desired).asked(method)


def page_style(method_name: str, plant: StateSpace, *, several: bool = False) -> str:
    """Return the method of the page: by default canonical form for small plants."""
    if method_name != "auto":
        return method_name
    if several:
        return "sylvester"
    readable = (
        readability.CANONICAL_FORM_ORDER if not plant.field.names else readability.PARAMETRIC_CANONICAL_FORM_ORDER
    )
    return "canonical_form" if plant.order <= readable else "ackermann"
