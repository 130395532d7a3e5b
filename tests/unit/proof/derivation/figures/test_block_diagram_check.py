"""What a block diagram says, node by node: the equations are those that one reads off the figure by hand."""

from __future__ import annotations

from dataclasses import replace
from typing import TypeAlias

import pytest

from symobs.exact import Scalar
from symobs.formula.figures import Wire, figure_of
from symobs.formula.tree import (
    Conjunction,
    Derivative,
    Environment,
    Formula,
    Letter,
    Literal,
    Negative,
    Product,
    Relation,
    Sum,
)
from symobs.formula.tree.plain_text import plain_relation
from symobs.ground.errors import DerivationRejected
from symobs.proof.derivation import Derivation, Diagram
from symobs.proof.derivation.figures_check import equations_of
from tests.kit import tabled

A, B, C, F, G, H, K, L, M, P, T = map(Letter, "ABCFGHKLMPT")
x, x_hat, u, v, y, y_hat, z = (Letter(name) for name in ("x", "x_hat", "u", "v_r", "y", "y_hat", "z_o"))
MINUS = Negative(Literal(Scalar.of(1)))
Labels: TypeAlias = dict[str, Formula | Conjunction]
KNOWN = Environment(signals=dict.fromkeys(("x", "x_hat", "u", "y", "v_r", "e", "w"), None), sizes={"u": 2, "x": 2})


def said(name: str, **labels: Formula | Conjunction) -> list[str]:
    return [plain_relation(relation, "s") for relation in equations_of(name, labels, KNOWN)]


def equal(left: Formula, right: Formula) -> Relation:
    return Relation((left, right), ("=",))


RATE = equal(Derivative(x), Sum((Product((A, x)), Product((B, u)))))
PLANT = Conjunction((RATE, equal(y, Product((C, x)))))


def test_a_loop_without_end_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    figure = figure_of("loop")
    wires = (*figure.wires, Wire("u", ">", "a"), Wire("a", ">", "u"))
    endless = replace(figure, places=(*figure.places, ("a", (0, 2))), wires=wires)
    monkeypatch.setattr("symobs.proof.derivation.figures_check.figure_of", lambda _: endless)
    start = Environment(values={"P": 1 / Scalar.symbol("s"), "F": Scalar.of(1), "T": 1 / (Scalar.symbol("s") - 1)})
    diagram = Diagram("loop", (("P", P), ("F", F), ("response", T)))
    with pytest.raises(DerivationRejected, match="Diagram cannot be read"):
        Derivation((diagram,), start).check()
    monkeypatch.undo()
    Derivation((diagram,), start).check()


def test_a_box_may_take_in_several_signals() -> None:
    found = said("minimal_order_observer", F=F, G=G, H=H, M=M, x=x_hat, u=u, y=y, z=z)
    assert found == ["d/dt z_o = G*u + H*y + F*z_o", "x_hat = M*[y; z_o]"]


@pytest.mark.parametrize(
    "equations",
    [
        (RATE,),
        (RATE, equal(y, Product((C, x_hat)))),
        (equal(Derivative(x), Product((A, x))), equal(y, Product((C, x)))),
        (RATE, equal(y, Product((C, x))), equal(v, v)),
        (equal(x, u), equal(y, Product((C, x)))),
    ],
)
def test_a_whole_system_speaks_of_the_signals_at_its_box(equations: tuple[Relation, ...]) -> None:
    observer: Labels = {"A": A, "B": B, "K": K, "L": L, "x": x_hat, "u": u, "y": y}
    with pytest.raises(ValueError, match="the box Plant, whose equations do not speak of the signals around it"):
        said("observer_controller", Plant=Conjunction(equations), **observer)


def test_signals_at_a_whole_system_are_letters() -> None:
    observer: Labels = {"A": A, "B": B, "K": K, "L": L, "x": x_hat, "u": Product((G, v)), "y": y}
    with pytest.raises(ValueError, match="the box Plant, around which not all signals are letters"):
        said("observer_controller", Plant=PLANT, **observer)
    observer |= {"u": u, "y": Product((C, x))}
    with pytest.raises(ValueError, match="the box Plant, around which not all signals are letters"):
        said("observer_controller", Plant=PLANT, **observer)


def test_two_systems_share_what_lies_between_them() -> None:
    equation = equal(Derivative(x_hat), Sum((Product((A, x_hat)), Product((B, u)), Product((L, y)))))
    labels: Labels = {"Plant": PLANT, "Observer": Conjunction((equation,)), "K": K, "v": v, "x": x_hat, "u": u, "y": y}
    found = said("estimated_state_feedback", **labels)
    system = ["d/dt x = A*x + B*u", "y = C*x", "y = y", "d/dt x_hat = A*x_hat + B*u + L*y"]
    assert found == ["u = K*x_hat", *system]
    deaf = Conjunction((equal(Derivative(x_hat), Product((A, x_hat))),))
    with pytest.raises(ValueError, match="the box Observer, whose equations do not speak"):
        said("estimated_state_feedback", **{**labels, "Observer": deaf})


SPECIAL: Labels = {"a plant": PLANT, "-1": MINUS, "-P": Negative(P), "T": T}


@tabled
def test_what_cannot_be_read_is_refused(name: str, labels: dict[str, str], match: str) -> None:
    read: Labels = {label: SPECIAL.get(formula, Letter(formula)) for label, formula in labels.items()}
    with pytest.raises(ValueError, match=match):
        said(name, **read)
