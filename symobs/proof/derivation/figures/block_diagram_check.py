"""Check of block diagrams (trusted): the equation at every node is compared with the established ones.

What leaves a node is the label there, or else the sum of what comes in; a box multiplies it by its gain.  So a labelled
point says that its label is this sum, an integrator that the derivative of its output is, and a box of a whole system
that its equations hold and that the signals which enter and leave it are those they speak of.  In a figure of transfer
functions the input is 1 and the output is what the label `response` says.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from symobs.exact import Scalar
from symobs.formula.figures.block_diagram import Figure, figure_of, is_box, is_integrator, key, without_sign
from symobs.formula.tree import (
    Block,
    Conjunction,
    Derivative,
    Environment,
    Formula,
    Identity,
    Letter,
    Literal,
    Product,
    Relation,
    Sum,
    children,
    letters,
)

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from symobs.formula.figures.block_diagram import Label, Wire


def equations_of(name: str, labels: Mapping[str, Label], environment: Environment) -> Iterator[Relation]:
    """Yield the equations of a diagram.  Raises `ValueError` where nothing can be read."""
    figure = figure_of(name).without_missing(labels)
    unused = {*labels} - {key(node) for node in figure.place} - {wire.gain for wire in figure.wires} - {"response"}
    is_named = {signal for signal, _ in figure_of(name).signals}
    if unused - is_named:
        raise ValueError(f"a label {min(unused - is_named)}, which is not in the figure")
    flow = _Flow(figure, labels, environment)
    for label, letter in figure.letters:
        yield Relation((Letter(letter), without_sign(flow.label(label))[1]), ("=",))
    for node in figure.place:
        yield from flow.said_at(node)


class _Flow:
    """A figure with its labels, in an environment."""

    def __init__(self, figure: Figure, labels: Mapping[str, Label], environment: Environment) -> None:
        self.figure, self.labels, self.environment = figure, labels, environment
        self.output = {node for node in figure.place if figure.response and not figure.out_of(node)}

    def label(self, name: str) -> Formula:
        """Return a label that must be there."""
        found = self.labels.get(name)
        if found is None or isinstance(found, Conjunction):
            raise ValueError(f"no formula for {name}")
        return found

    def said_at(self, node: str) -> Iterator[Relation]:
        """Yield the equation of a node, if it has one."""
        wires = self.figure.into(node)
        label = self.labels.get(key(node))
        if isinstance(label, Conjunction):
            yield from label.relations
            self.hold_to_its_signals(node, label)
        elif is_integrator(node):
            yield Relation((Derivative(self.label(key(node))), self.total(wires)), ("=",))
        elif self.figure.response:
            if key(node) in self.output:
                yield Relation((self.label("response"), self.total(wires)), ("=",))
        elif not is_box(node) and label is not None and wires and not self.is_from_system(wires):
            yield Relation((label, self.total(wires)), ("=",))

    def leaving(self, node: str) -> Formula:
        """Return what leaves a node.  A loop with neither an integrator nor a signal in it has no end: RecursionError."""
        wires = self.figure.into(node)
        if self.figure.response and not wires:
            return Identity(self.environment.sizes.get("u", 1))
        if key(node) in self.output:
            return self.label("response")
        if is_box(node):
            arriving = [self.through(wire) for wire in wires]
            entering = arriving[0] if len(wires) == 1 else Block(tuple((part,) for part in arriving))
            return Product((self.label(key(node)), entering))
        if not self.figure.response and (key(node) in self.labels or not wires):
            return self.label(key(node))
        return self.total(wires)

    def total(self, wires: list[Wire]) -> Formula:
        """Return the sum of what arrives on some wires."""
        arriving = tuple(self.through(wire) for wire in wires)
        return arriving[0] if len(arriving) == 1 else Sum(arriving)

    def through(self, wire: Wire) -> Formula:
        """Return the signal on a wire; a gain ±1 is a sign."""
        arriving = self.leaving(wire.begin)
        if not wire.gain:
            return arriving
        gain = self.label(wire.gain)
        if without_sign(gain)[1] != Literal(Scalar.of(1)):
            raise ValueError("a gain on a wire, where only a sign is drawn")
        return Product((gain, arriving))

    def is_from_system(self, wires: list[Wire]) -> bool:
        """Return whether wires come from the box of a whole system, whose equations define its outputs."""
        return any(isinstance(self.labels.get(wire.begin), Conjunction) for wire in wires)

    def hold_to_its_signals(self, node: str, equations: Conjunction) -> None:
        """Reject a system with signals other than those at its box and its own state."""
        members = [member for relation in equations.relations for member in relation.members]
        spoken = {name for member in members for name in letters(member)} & self.environment.signals.keys()
        states = {name for member in members for name in _differentiated(member)}
        around = [self.leaving(wire.begin) for wire in self.figure.into(node)]
        around += [self.label(key(wire.end)) for wire in self.figure.out_of(node)]
        at_box = {signal.name for signal in around if isinstance(signal, Letter)}
        if not all(isinstance(signal, Letter) for signal in around):
            raise ValueError(f"the box {node}, around which not all signals are letters")
        if spoken - states != at_box - states:
            raise ValueError(f"the box {node}, whose equations do not speak of the signals around it")


def _differentiated(formula: Formula) -> frozenset[str]:
    """Return the signals whose derivative stands in a formula."""
    own = letters(formula.operand) if isinstance(formula, Derivative) else frozenset[str]()
    return own.union(*(_differentiated(part) for part in children(formula)))
