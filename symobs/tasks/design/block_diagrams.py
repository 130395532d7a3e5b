"""Block diagrams of the pages of designs, with gains and signs from the formulas of the page."""

from __future__ import annotations

from typing import TYPE_CHECKING

from symobs.formula.tree import Conjunction, Negative, Quotient
from symobs.formula.tree.term import Term, block
from symobs.proof.derivation.builder import Builder, relation

if TYPE_CHECKING:
    from symobs.proof.derivation.builder import Member


def draw_copy(page: Builder) -> None:
    """Draw the observer as a copy of the plant: y − ŷ through L."""
    m = page.plant.matrices
    page.signal("y_hat", "C x_hat", silent=True)
    gains: dict[str, Member] = {name: page[name] for name in ("A", "C", "L")}
    if m.has_input:
        gains["B"] = page["B"]
    if m.has_feedthrough:
        gains["D"] = page["-D"]
    page.diagram("observer_copy", say="drawn_copy", **gains)


def draw_collected(page: Builder) -> None:
    """Draw the observer as one loop around A − LC."""
    gains: dict[str, Member] = {"A": page["A - L C"], "L": page["L"]}
    if page.plant.matrices.has_input:
        gains["B"] = _driven(page)
    say = "drawn_collected" if "B" in gains else "drawn_collected_free"
    page.diagram("observer_closed", say=say, **gains)


def draw_compensator(page: Builder) -> None:
    """Draw plant, observer and feedback: in full with one input, one output and no feedthrough, else the plant as one box."""
    A, C, K, L = (page[name] for name in "ACKL")
    plant = page.plant
    if plant.inputs == plant.outputs == 1 and not plant.matrices.has_feedthrough:
        page.signal("y_hat", "C x_hat", silent=True)
        page.diagram("observer_compensator", say="drawn_compensator", A=A, B=page["B"], C=C, K=-K, L=L)
        return
    gains = {"A": page["A - L C"], "B": _driven(page), "K": -K, "L": L}
    page.diagram("observer_controller", say="drawn_compensator", Plant=_plant(page), **gains)


def _whole(page: Builder, label: Member) -> Member:
    """Return what stands in a box with its own minus inside: one in front of it would be read as a sign of the figure."""
    match label:
        case Term(Negative(Quotient(above, below))):
            return page.term(Quotient(Negative(above), below))
        case Term(Negative()):
            return page.value(label.value)
    return label


def draw_loop(page: Builder, plant: Member, compensator: Term) -> None:
    """Draw the compensator in the return path."""
    page.diagram("loop", say="drawn_loop", P=_whole(page, plant), F=-compensator, response=page["G_cl"])


def draw_unity_loop(page: Builder, plant: Member, compensator: Member) -> None:
    """Draw the compensator before the plant, unity feedback."""
    page.diagram("unity_loop", say="drawn_unity_loop", P=_whole(page, plant), F=compensator, response=page["G_r"])


def draw_feedforward(page: Builder, *, minimal: bool) -> None:
    """Draw feedback from the estimate, and the feedforward."""
    observer = _minimal_order_observer(page) if minimal else _observer(page)
    gains = {"K": page["-K"], "F": page["F_v"]}
    say = "drawn_feedforward_minimal" if minimal else "drawn_feedforward"
    page.diagram("estimated_state_feedback", say=say, Plant=_plant(page), Observer=observer, **gains)


def draw_state_feedforward(page: Builder) -> None:
    """Draw feedback from the state, and the feedforward."""
    gains = {"K": page["-K"], "F": page["F_v"]}
    page.diagram("state_feedforward", say="drawn_state_feedforward", Plant=_plant(page), **gains)


def draw_integral_action(page: Builder) -> None:
    """Draw feedback from the state and from the integral of the control error."""
    page.diagram("integral_loop", say="drawn_integral", Plant=_plant(page), K=page["-K"], Ki=page["k_I"])


def draw_tracking(page: Builder, *, minimal: bool) -> None:
    """Draw the generator of the reference, K and K_d, plant and observer."""
    observer = _minimal_order_observer(page) if minimal else _observer(page)
    gains = {"K": page["K"], "Kd": page["-K_d"], "Ad": page["A_ref"]}
    say = "drawn_tracking_minimal" if minimal else "drawn_tracking"
    page.diagram("tracking_loop", say=say, Plant=_plant(page), Observer=observer, **gains)


def draw_minimal_order(page: Builder) -> None:
    """Draw the observer of what is not measured, and the estimate put together; a feedthrough is taken off the output."""
    gains: dict[str, Member] = {name[0]: page[name] for name in ("F_z", "H_z", "M_z")}
    if page.plant.matrices.has_input:
        gains["G"] = page["G_z"]
    figure = "minimal_order_observer"
    if page.plant.matrices.has_feedthrough:
        figure, gains["D"] = "minimal_order_feedthrough", page["-D"]
        gains["G"] = page["G_z + H_z D"]  # H is fed what is measured of the state
    page.diagram(figure, say="drawn_minimal_order", z=_state(page), **gains)


def _driven(page: Builder) -> Term:
    return page["B - L D"] if page.plant.matrices.has_feedthrough else page["B"]


def _plant(page: Builder) -> Conjunction:
    output = page["C x"]
    if page.plant.matrices.has_feedthrough:
        output = output + page["D u"]
    return Conjunction((page.line("x' = A x + B u"), relation(page["y"], output)))


def _observer(page: Builder) -> Conjunction:
    x_hat = page["x_hat"]
    rate = page("(A - L C) x_hat + {driven} u + L y", driven=_driven(page))
    return Conjunction((relation(x_hat.derivative, rate),))


def _minimal_order_observer(page: Builder) -> Conjunction:
    z, y = _state(page), page["y"]
    rate = page("F_z {z} + G_z u + H_z y", z=z)
    known = page["y - D u"] if page.plant.matrices.has_feedthrough else y
    estimate = page["M_z"] @ block([[known], [z]])
    return Conjunction((relation(z.derivative, rate), relation(page["x_hat"], estimate)))


def _state(page: Builder) -> Term:
    """Return z, but w in discrete time, where z is the variable."""
    return page["w_o" if page.plant.is_discrete else "z_o"]
