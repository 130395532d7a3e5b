"""Block diagrams: what is drawn is what the page says, found by elimination; and what is drawn can be read."""

from __future__ import annotations

import xml.etree.ElementTree as ET
from dataclasses import replace
from itertools import combinations, pairwise
from typing import TYPE_CHECKING, Any

import pytest
import sympy
from sympy.polys.matrices import DomainMatrix

import symobs
from symobs.exact import Matrix, Scalar
from symobs.formula.figures import figure_of, is_box, is_integrator, key
from symobs.formula.phrases import PHRASES
from symobs.formula.tree import Conjunction, Exact, Letter, Literal, Negative, evaluate
from symobs.ground.errors import DerivationRejected
from symobs.pages.drawings.diagram_layout import diagram_scene
from symobs.pages.drawings.svg import metrics_of, svg, svg_scene
from symobs.pages.drawings.text import cells_of, sketch
from symobs.pages.drawings.tikz import metrics_for, tikz, tikz_scene
from symobs.pages.page.blocks import Drawing
from symobs.pages.page.narrator import narrate
from symobs.pages.printers.latex_printer import LatexPrinter
from symobs.pages.printers.text_printer import TextPrinter
from symobs.proof.derivation import Derivation, Diagram, Section
from symobs.system import StateSpace
from tests.support.independent_algebra.second_reader import sympy_scalar

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Mapping, Sequence

    from symobs.formula.figures import Figure, Label
    from symobs.formula.tree import Environment
    from symobs.pages.drawings.diagram_layout import Metrics
    from symobs.pages.drawings.scene import Scene
    from symobs.proof.derivation import Step
    from symobs.tasks.result import Result

s = sympy.Symbol("s")

# The servo of S0, Example 4.1, with its gains for -2, -2 and -10, -10 (S0, Example 4.2), and what it is with D = 1.
A, B, C = sympy.Matrix([[0, 1], [0, -1]]), sympy.Matrix([0, 1]), sympy.Matrix([[1, 0]])
K, L = sympy.Matrix([[4, 3]]), sympy.Matrix([19, 81])
SERVO = ("[0 1; 0 -1]", "[0; 1]", "[1 0]")
POLES: dict[str, Any] = {"control_poles": [-2, -2], "observer_poles": [-10, -10]}
LOOP = (s + 2) ** 2 * (s + 10) ** 2


def servo(D: str = "[0]", dt: int | bool = 0) -> StateSpace:  # noqa: FBT001
    return StateSpace(*SERVO, D, dt=dt)


def diagrams(result: Result) -> list[tuple[Diagram, Environment]]:
    """All diagrams of a page, with what is established at its end."""
    return [(step, result.derivation.check()) for step in within(result.derivation.steps) if isinstance(step, Diagram)]


def within(steps: tuple[Step, ...]) -> Iterator[Step]:
    for step in steps:
        yield step
        if isinstance(step, Section):
            yield from within(step.steps)


def drawn(result: Result, name: str) -> tuple[Diagram, Environment]:
    (found,) = [(step, known) for step, known in diagrams(result) if step.name == name]
    return found


# -- elimination ------------------------------------------------------------------------------------------------------


class Graph:
    """The signal-flow graph that is drawn, read from nodes and wires alone, as linear equations in Laplace transforms."""

    def __init__(self, step: Diagram, known: Environment, boxes: Mapping[str, Any], sizes: Mapping[str, int]) -> None:
        labels = dict(step.labels)
        self.figure: Figure = figure_of(step.name).without_missing(labels)
        self.gains = {
            node: boxes[node] if node in boxes else self.gain(labels[key(node)], known)
            for node in self.figure.place
            if is_box(node)
        }
        self.signs = {
            wire: self.gain(labels[wire.gain], known)[0, 0] if wire.gain else sympy.Integer(1)
            for wire in self.figure.wires
        }
        self.sizes = self.all_sizes(dict(sizes))
        self.unknown = {
            node: sympy.Matrix(size, 1, lambda i, _, node=node: sympy.Symbol(f"{node}_{i}"))
            for node, size in self.sizes.items()
        }
        self.inputs = [node for node in self.figure.place if not self.figure.into(node)]

    @staticmethod
    def gain(label: Any, known: Environment) -> sympy.Matrix:
        value = evaluate(label, known, Exact(known))
        rows = value.rows if isinstance(value, Matrix) else [[value]]
        return sympy.Matrix([[sympy_scalar(entry, {"s": s}) for entry in row] for row in rows])

    def all_sizes(self, sizes: dict[str, int]) -> dict[str, int]:
        """A box gives as many signals as its gain has rows; points and integrators what comes in."""
        sizes |= {node: gain.rows for node, gain in self.gains.items()}
        while len(sizes) < len(self.figure.place):
            before = len(sizes)
            for wire in self.figure.wires:
                if wire.begin in sizes and wire.end not in sizes:
                    sizes[wire.end] = sizes[wire.begin]
            assert len(sizes) > before, "a signal of unknown size"
        return sizes

    def equations(self) -> Iterator[Any]:
        for node in self.figure.place:
            arriving = [self.signs[wire] * self.unknown[wire.begin] for wire in self.figure.into(node)]
            if not arriving:
                continue
            entering = sympy.Matrix.vstack(*arriving) if is_box(node) else sum(arriving[1:], arriving[0])
            value = self.gains[node] * entering if is_box(node) else entering
            yield from self.unknown[node] - (value / s if is_integrator(node) else value)

    def transfer(self, begin: str, end: str) -> sympy.Matrix:
        """From one input to a node, the other inputs 0."""
        zero = [entry for node in self.inputs if node != begin for entry in self.unknown[node]]
        equations = [equation.subs(dict.fromkeys(zero, 0)) for equation in self.equations()]
        others = [entry for node in self.unknown if node not in self.inputs for entry in self.unknown[node]]
        (solution,) = sympy.linsolve(equations, others)
        found = dict(zip(others, solution, strict=True))
        columns = [[sympy.diff(found[entry], of) for of in self.unknown[begin]] for entry in self.unknown[end]]
        return sympy.Matrix(columns).applyfunc(sympy.cancel)

    def has_poles(self, loop: Any, opened: Any) -> bool:
        """Whether the loop has these poles, without input, the boxes and integrators by themselves those of `opened`.

        The determinant of the equations is the quotient of the two polynomials, up to its sign; it is held to that at
        more points than it has zeros and poles.
        """
        others = [entry for node in self.unknown if node not in self.inputs for entry in self.unknown[node]]
        jacobian = sympy.Matrix(list(self.equations())).jacobian(others)
        points = [
            sympy.Rational(2 * k + 1, 3) for k in range(1, 3 + int(sympy.degree(loop, s) + sympy.degree(opened, s)))
        ]
        ratios = {
            DomainMatrix.from_Matrix(jacobian.subs(s, at)).to_field().det() * (opened / loop).subs(s, at)
            for at in points
        }
        return ratios in ({1}, {-1})


def same(left: Any, right: Any) -> bool:
    difference = sympy.Matrix([left]) - sympy.Matrix([right])
    return bool(difference.applyfunc(sympy.cancel).is_zero_matrix)


def resolvent(matrix: Any) -> Any:
    return (s * sympy.eye(matrix.rows) - matrix).inv()


@pytest.mark.parametrize("name", ["observer_copy", "observer_closed"])
@pytest.mark.parametrize("d", [0, 1])
def test_the_observer_is_drawn(name: str, d: int) -> None:
    graph = Graph(*drawn(symobs.observer(servo(f"[{d}]"), poles=[-10, -10]), name), {}, {"u": 1, "y": 1})
    estimate = resolvent(A - L * C)
    assert same(graph.transfer("y", "x"), estimate * L)
    assert same(graph.transfer("u", "x"), estimate * (B - L * d))
    assert graph.has_poles((s + 10) ** 2, s**2)


def test_an_observer_without_input_is_drawn_without_it() -> None:
    plant = StateSpace("[0 -1 0; 1 0 1; 0 0 0]", None, "[1 0 0]")
    for name in ("observer_copy", "observer_closed"):
        step, known = drawn(symobs.observer(plant, poles=[-1, -1, -1]), name)
        assert Graph(step, known, {}, {"y": 1}).inputs == ["y"]


def test_the_compensator_is_drawn() -> None:
    graph = Graph(*drawn(symobs.compensator(servo(), **POLES), "observer_compensator"), {}, {"u": 1})
    assert graph.inputs == []
    assert graph.has_poles(LOOP, s**4)


def test_the_compensator_is_drawn_with_feedthrough() -> None:
    """D = 1: the plant as one box, the observer with B - LD."""
    step, known = drawn(symobs.compensator(servo("[1]"), **POLES), "observer_controller")
    plant = C * resolvent(A) * B + sympy.Matrix([[1]])
    graph = Graph(step, known, {"Plant": plant}, {"u": 1})
    assert graph.has_poles(LOOP, s * (s + 1) * s**2)


def test_both_loops_are_drawn() -> None:
    """The closed-loop functions of S0, Example 4.2, and its unity-feedback variant."""
    page = symobs.compensator(servo(), **POLES)
    loop, unity = (Graph(*drawn(page, name), {}, {"r": 1}) for name in ("loop", "unity_loop"))
    assert same(loop.transfer("r", "y"), (s**2 + 23 * s + 161) / LOOP)
    assert same(unity.transfer("r", "y"), (319 * s + 400) / LOOP)


def test_the_loop_of_example_4_4_is_drawn() -> None:
    page = symobs.compensator(servo(), control_poles=[-2, -2], observer_poles=[-10], observer="minimal")
    loop, unity = (Graph(*drawn(page, name), {}, {"r": 1}) for name in ("loop", "unity_loop"))
    assert same(loop.transfer("r", "y"), (s + 13) / ((s + 2) ** 2 * (s + 10)))
    assert same(unity.transfer("r", "y"), (31 * s + 40) / ((s + 2) ** 2 * (s + 10)))


def test_the_feedforward_is_drawn() -> None:
    """F = 4 gives 4/(s + 2)^2 from v to y (S3, section G, with the data of S0, Example 4.2)."""
    step, known = drawn(symobs.feedforward(servo(), **POLES), "estimated_state_feedback")
    boxes = {"Plant": C * resolvent(A) * B, "Observer": resolvent(A - L * C) * sympy.Matrix.hstack(B, L)}
    graph = Graph(step, known, boxes, {"v": 1})
    assert same(graph.transfer("v", "y"), 4 / (s + 2) ** 2)


def test_the_feedforward_of_a_measured_state_is_drawn() -> None:
    """A plant 1/(s + 1) whose state is its output: K = 1 and F = 2 give 2/(s + 2)."""
    step, known = drawn(symobs.feedforward(StateSpace("[-1]", "[1]", "[1]"), control_poles=[-2]), "state_feedforward")
    graph = Graph(step, known, {"Plant": sympy.Matrix([[1 / (s + 1)]])}, {"v": 1})
    assert same(graph.transfer("v", "y"), 2 / (s + 2))


def test_the_tracking_loop_is_drawn() -> None:
    """S2: with K_d = [w^2 -1] for an oscillator the reference leaves the error, and y follows its first component."""
    page = symobs.tracking(servo(), **POLES, reference_matrix="[0 1; -4 0]", observer="full")
    step, known = drawn(page, "tracking_loop")
    boxes = {"Plant": C * resolvent(A) * B, "Observer": resolvent(A - L * C) * sympy.Matrix.hstack(B, L)}
    graph = Graph(step, known, boxes, {"u": 1, "∫r": 2})
    assert graph.has_poles((s**2 + 4) * LOOP, s**2 * s * (s + 1) * (s + 10) ** 2)


def test_the_minimal_order_observer_is_drawn() -> None:
    """S0, Example 4.3 with an input: F, H and the assembly as printed there."""
    plant = StateSpace("[0 -1 0; 1 0 1; 0 0 0]", "[1; 2; 3]", "[1 0 0]")
    step, known = drawn(symobs.reduced_order_observer(plant, poles=[-1, -1]), "minimal_order_observer")
    graph = Graph(step, known, {}, {"y": 1, "u": 1})
    F, H, M = (sympy.Matrix(rows) for rows in ([[-2, 1], [-1, 0]], [[4], [2]], [[1, 0, 0], [-2, 1, 0], [-1, 0, 1]]))
    G = sympy.Matrix([2, 3]) - sympy.Matrix([-2, -1])
    z = resolvent(F)
    assert same(graph.transfer("y", "x"), M * sympy.Matrix.vstack(sympy.eye(1), z * H))
    assert same(graph.transfer("u", "x"), M * sympy.Matrix.vstack(sympy.zeros(1), z * G))


# -- what is refused --------------------------------------------------------------------------------------------------

PAGES: dict[str, Callable[[], Result]] = {
    "observer": lambda: symobs.observer(servo(), poles=[-10, -10]),
    "observer with feedthrough": lambda: symobs.observer(servo("[1]"), poles=[-10, -10]),
    "discrete observer": lambda: symobs.observer(servo(dt=True), poles=[0, 0]),
    "by ansatz": lambda: symobs.observer(servo(), poles=[-10, -10], method="existence"),
    "compensator": lambda: symobs.compensator(servo(), **POLES),
    "compensator with feedthrough": lambda: symobs.compensator(servo("[1]"), **POLES),
    "minimal-order compensator": lambda: symobs.compensator(
        servo(), control_poles=[-2, -2], observer_poles=[-10], observer="minimal"
    ),
    "parametric compensator": lambda: symobs.compensator(
        StateSpace("[0 1 0; 0 0 1; -a -b -c]", "[0; 0; 1]", "[1 d 0]"),
        control_poles=["-p", "-q", "-w"],
        observer_poles=["-p", "-q", "-w"],
    ),
    "several": lambda: symobs.compensator(
        StateSpace("[0 1; 0 -1]", "[1 0; 0 2]", "[1 1; 0 1]"), control_poles=[-2, -3], observer_poles=[-10, -11]
    ),
    "feedforward": lambda: symobs.feedforward(servo(), **POLES),
    "feedforward of a measured state": lambda: symobs.feedforward(servo("[2]"), control_poles=[-2, -2]),
    "feedforward with feedthrough": lambda: symobs.feedforward(
        servo("[1]"), control_poles=[-2, -2], observer_poles=[-10], observer="minimal"
    ),
    "tracking": lambda: symobs.tracking(
        servo(), control_poles=[-2, -2], observer_poles=[-10], observer="minimal", reference_matrix="[0 1; -4 0]"
    ),
    "minimal-order observer": lambda: symobs.reduced_order_observer(servo(), poles=[-10]),
    "minimal-order observer with feedthrough": lambda: symobs.reduced_order_observer(servo("[2]"), poles=[-10]),
    "discrete minimal-order observer": lambda: symobs.reduced_order_observer(servo(dt=True), poles=["1/2"]),
}
every_page = pytest.mark.parametrize("page", PAGES.values(), ids=PAGES.keys())


@pytest.mark.slow
@every_page
def test_no_spoiled_diagram_is_accepted(page: Callable[[], Result]) -> None:
    """The other sign, one gain in the place of another, a box left out: none of it is what the page says."""
    derivation = page().derivation
    derivation.check()
    steps = [step for step in within(derivation.steps) if isinstance(step, Diagram)]
    assert steps
    for step in steps:
        for spoiled in spoilt(step):
            with pytest.raises(DerivationRejected):
                replaced(derivation, step, spoiled).check()


def spoilt(step: Diagram) -> Iterator[Diagram]:
    labels = dict(step.labels)
    drawn_names = {key(node) for node in figure_of(step.name).place} | {
        wire.gain for wire in figure_of(step.name).wires
    }
    names = [name for name in labels if name in drawn_names | {"response"}]
    is_named_only = figure_of(step.name).response
    for name in names:
        label = labels[name]
        if is_named_only and name[0].islower() and name != "response":
            continue
        if isinstance(label, Conjunction):
            first, *rest = label.relations
            wrong = replace(first, members=(first.members[0], Negative(first.members[1])))
            yield replace(step, labels=tuple({**labels, name: Conjunction((wrong, *rest))}.items()))
            continue
        yield replace(step, labels=tuple({**labels, name: Negative(label)}.items()))
        if name[0].isupper():
            yield replace(step, labels=tuple((other, text) for other, text in labels.items() if other != name))
    gains = [name for name in names if name[0].isupper() and not isinstance(labels[name], Conjunction)]
    for one, other in combinations(gains, 2):
        if labels[one] != labels[other]:
            yield replace(step, labels=tuple({**labels, one: labels[other], other: labels[one]}.items()))


def replaced(derivation: Derivation, old: Diagram, new: Diagram) -> Derivation:
    def through(steps: tuple[Step, ...]) -> tuple[Step, ...]:
        return tuple(
            replace(step, steps=through(step.steps)) if isinstance(step, Section) else new if step is old else step
            for step in steps
        )

    return Derivation(through(derivation.steps), derivation.start, derivation.symbols, derivation.discrete)


# -- what can be read -------------------------------------------------------------------------------------------------


@every_page
def test_nothing_runs_through_anything(page: Callable[[], Result]) -> None:
    """In every format: boxes apart, no wire through a box, wires that cross only where a branch is drawn."""
    result = page()
    discrete = result.derivation.discrete
    variable = result.derivation.variable
    latex = LatexPrinter(variable, discrete=discrete)
    text = TextPrinter(variable, discrete=discrete)
    for step, _ in diagrams(result):
        drawing = Drawing(step.name, step.labels)
        for metrics in (metrics_for(latex), metrics_of(text), cells_of(text, 4), cells_of(text, 2)):
            assert list(collisions(diagram_scene(drawing, metrics, 1000, discrete=discrete), metrics)) == []


def collisions(found: Scene, metrics: Metrics) -> Iterator[str]:
    boxes = [(box.centre[0], box.centre[1], *box.size) for box in found.boxes]
    boxes += [(*sign.place, metrics.junction, metrics.junction) for sign in found.signs if sign.kind == "junction"]
    for one, other in combinations(boxes, 2):
        if all(abs(one[k] - other[k]) < (one[k + 2] + other[k + 2]) / 2 for k in (0, 1)):
            yield f"{one} and {other} overlap"
    stretches = [(index, *pair) for index, line in enumerate(found.strokes) for pair in pairwise(line.points)]
    for _, begin, end in stretches:
        (left, right), (top, bottom) = sorted((begin[0], end[0])), sorted((begin[1], end[1]))
        for x, y, width, height in boxes:
            is_beside = left > x + width / 2 - 0.01 or right < x - width / 2 + 0.01
            if not is_beside and top < y + height / 2 - 0.01 and bottom > y - height / 2 + 0.01:
                yield f"a wire from {begin} to {end} through the box at {x, y}"
    branches = {sign.place for sign in found.signs if sign.kind == "branch"}
    for (i, *first), (j, *second) in combinations(stretches, 2):
        if i != j and (place := crossing(first, second)) and place not in branches:
            yield f"wires cross at {place}"
    for x, y in (text.place for text in found.texts if text.anchor == "above"):
        if any(abs(x - bx) < width / 2 and abs(y - by) < height / 2 for bx, by, width, height in boxes):
            yield f"something is written over the box at {x, y}"


def crossing(one: Sequence[Any], other: Sequence[Any]) -> tuple[float, float] | None:
    """Where a horizontal and a vertical stretch cross, both in their inside."""
    if one[0][0] == one[1][0]:
        one, other = other, one
    if one[0][1] != one[1][1] or other[0][0] != other[1][0]:
        return None
    x, y = other[0][0], one[0][1]
    is_inside = min(one[0][0], one[1][0]) < x < max(one[0][0], one[1][0])
    return (x, y) if is_inside and min(other[0][1], other[1][1]) < y < max(other[0][1], other[1][1]) else None


@every_page
def test_a_sketch_fits_a_terminal(page: Callable[[], Result]) -> None:
    result = page()
    printer = TextPrinter(result.derivation.variable, discrete=result.derivation.discrete)
    for step, _ in diagrams(result):
        lines = sketch(Drawing(step.name, step.labels), printer, 76).splitlines()
        assert max(map(len, lines)) <= 77
        whole = "\n".join(lines)
        assert whole.count("┌") == whole.count("┐") or "┐" in whole
        assert whole.count("▶") + whole.count("◀") + whole.count("▲") + whole.count("▼") == heads(step)


def heads(step: Diagram) -> int:
    """Arrows end at boxes, junctions and outputs."""
    figure = figure_of(step.name).without_missing(dict(step.labels))
    ends = [wire.end for wire in figure.wires]
    return sum(
        is_box(node) or is_integrator(node) or figure.is_junction(node) or not figure.out_of(node) for node in ends
    )


@every_page
def test_svg_is_well_formed_and_asks_for_nothing(page: Callable[[], Result]) -> None:
    result = page()
    printer = TextPrinter(result.derivation.variable, discrete=result.derivation.discrete)
    for block in narrate(symobs_document(result)):
        if not isinstance(block, Drawing):
            continue
        written = svg(svg_scene(block, printer), printer, PHRASES["block_diagram"])
        root = ET.fromstring(written)  # noqa: S314 - our own text
        tags = {element.tag.rpartition("}")[2] for element in root.iter()}
        assert tags <= {"svg", "title", "path", "rect", "circle", "text", "tspan"}
        assert "href" not in written
        assert "id=" not in written
        left, top, width, height = map(float, root.attrib["viewBox"].split())
        for element in root.iter("{http://www.w3.org/2000/svg}text"):
            assert left < float(element.attrib["x"]) < left + width
            assert top < float(element.attrib["y"]) < top + height


def symobs_document(result: Result) -> Any:
    from symobs.tasks.result import Document  # noqa: PLC0415

    return Document("", "", (result,))


def test_a_sign_stands_where_the_formula_has_it() -> None:
    """The same law in another convention, u = K x: the box loses its minus, a junction has a plus."""
    printer = TextPrinter()
    labels: dict[str, Label] = {
        "A": Letter("A"),
        "B": Letter("B"),
        "C": Letter("C"),
        "L": Negative(Letter("L")),
        "U": Negative(one()),
    }
    labels |= {"x": Letter("x_hat"), "u": Letter("u"), "y": Letter("y"), "w": Letter("y_hat")}
    negative = sketch(Drawing("observer_copy", tuple(labels.items())), printer, 76)
    positive = sketch(Drawing("observer_copy", tuple({**labels, "L": Letter("L")}.items())), printer, 76)
    assert negative.count("−") == positive.count("−") + 1 == 2
    assert "│ L │" in negative
    assert "-L" not in negative


def one() -> Literal:
    return Literal(Scalar.of(1))


def test_tikz_draws_every_wire_and_box() -> None:
    step, _ = drawn(symobs.compensator(servo(), **POLES), "observer_compensator")
    printer = LatexPrinter()
    written = tikz(tikz_scene(Drawing(step.name, step.labels), printer), printer)
    figure = figure_of(step.name)
    assert written.count(r"\draw[->]") == heads(step)
    assert written.count("rectangle") == sum(is_box(node) or is_integrator(node) for node in figure.place)
    assert written.count("circle[radius=0.45]") == 3
    assert r"$\displaystyle -K$" in written
