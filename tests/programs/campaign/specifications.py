"""What is asked about a plant: the specification of every task, drawn at random."""

from __future__ import annotations

from fractions import Fraction
from typing import TYPE_CHECKING, Any

from tests.programs.campaign import regions, shapes
from tests.programs.campaign.asked import text_of
from tests.programs.campaign.signals import output_of, time_varying

if TYPE_CHECKING:
    from collections.abc import Callable
    from random import Random

    from tests.programs.campaign.shapes import Shape

Drawn = dict[str, Any] | None

#: How often each task is asked.
TASKS: dict[str, float] = {
    "observability": 8,
    "controllability": 8,
    "detectability": 6,
    "stabilizability": 6,
    "pbh": 5,
    "characteristic_polynomial": 4,
    "transfer_function": 6,
    "canonical_form": 6,
    "dual": 3,
    "decomposition": 6,
    "matrix_exponential": 4,
    "gramian": 3,
    "initial_state": 2,
    "initial_state_covariance": 0.3,
    "time_varying_observability": 2,
    "state_feedback": 10,
    "observer": 10,
    "reduced_order_observer": 7,
    "compensator": 7,
    "feedforward": 3,
    "tracking": 4,
    "integral_action": 3,
    "unknown_input_observer": 3,
    "disturbance_observer": 3,
    "pole_advice": 2,
    "stability_region": 2,
}


def specification(random: Random, task: str, shape: Shape) -> Drawn:
    """Return a specification of the task for a plant, None where it is not asked for such a plant.

    Beside the keys of the task it may hold `symbols` to be declared, and a `plant` in place of the one drawn.
    """
    asked = _SPECIFICATIONS.get(task)
    return asked(random, shape) if asked is not None else {}


# -- desired polynomials -----------------------------------------------------------------------------------------------


def poles(random: Random, shape: Shape, count: int, *, complex_pairs: bool = True) -> str | None:
    """As many desired poles: real, repeated, in conjugate pairs, at hidden modes, symbolic."""
    found: list[str] = []
    wanted = [mode for mode in shape.hidden if random.random() < 0.6][:count]
    while len(found) + len(wanted) < count:
        if complex_pairs and count - len(found) - len(wanted) >= 2 and random.random() < 0.3:
            real, imaginary = _place(random, shape), random.randint(1, 3)
            found += [f"{real}+{imaginary}*I", f"{real}-{imaginary}*I"]
        elif found and "I" not in found[-1] and random.random() < 0.15:
            found.append(found[-1])
        else:
            found.append(_place(random, shape))
    found = wanted + found
    random.shuffle(found)
    return ", ".join(found) if found else None


def _place(random: Random, shape: Shape) -> str:
    if shape.discrete:
        return random.choice(["0", "0", "1/2", "-1/2", "1/4", "-1/3", "2/5"])
    return str(-random.randint(0 if random.random() < 0.05 else 1, 6)) if random.random() < 0.95 else "-1/2"


def polynomial(random: Random, shape: Shape, degree: int) -> str:
    """A monic polynomial written out, not always with roots that can be named."""
    s = "z" if shape.discrete else "s"
    names = list(shape.signs)
    terms = [f"{s}^{degree}"]
    for power in range(degree - 1, -1, -1):
        value = random.choice(["1/4", "-1/2", "0"]) if shape.discrete else str(random.randint(1, 9))
        if names and random.random() < 0.2:
            value = random.choice(names)
        terms.append(f"({value})*{s}^{power}")
    return " + ".join(terms)


def desired(random: Random, shape: Shape, count: int, prefix: str = "") -> Drawn:
    """Poles or a polynomial of this degree, under the keys with this prefix."""
    if count < 0:
        return None
    if count and random.random() < 0.2:
        return {f"{prefix}polynomial": polynomial(random, shape, count)}
    text = poles(random, shape, count)
    if text is None:
        return None
    if shape.signs and random.random() < 0.25:
        parts = text.split(", ")
        if "I" not in parts[-1]:
            return {f"{prefix}poles": ", ".join([*parts[:-1], "-p"]), "symbols": {"p": "positive"}}
    return {f"{prefix}poles": text}


def _joined(*parts: Drawn) -> Drawn:
    whole: dict[str, Any] = {}
    for part in parts:
        if part is None:
            return None
        whole = {**whole, **part, "symbols": {**whole.get("symbols", {}), **part.get("symbols", {})}}
    return whole


# -- the tasks ---------------------------------------------------------------------------------------------------------


def _state_feedback(random: Random, shape: Shape) -> Drawn:
    if random.random() < 0.1:
        return {"K": text_of(shapes.texts(shapes.dense(random, shape.inputs, shape.order)))}
    return desired(random, shape, shape.order)


def _observer(random: Random, shape: Shape) -> Drawn:
    if random.random() < 0.1:
        return {"L": text_of(shapes.texts(shapes.dense(random, shape.order, shape.outputs)))}
    return desired(random, shape, shape.order)


def _reduced_order_observer(random: Random, shape: Shape) -> Drawn:
    if shape.outputs >= shape.order:
        return None
    return desired(random, shape, shape.order - shape.outputs)


def _compensator(random: Random, shape: Shape) -> Drawn:
    if shape.order > 6:
        return None
    minimal = random.random() < 0.4 and shape.outputs < shape.order
    observer = desired(random, shape, shape.order - shape.outputs * minimal, "observer_")
    kind = {"observer": "minimal" if minimal else "full"} if minimal or random.random() < 0.5 else {}
    return _joined(desired(random, shape, shape.order, "control_"), observer, kind)


def _feedforward(random: Random, shape: Shape) -> Drawn:
    if (shape.inputs, shape.outputs) != (1, 1):
        return None
    return _compensator(random, shape)


def _integral_action(random: Random, shape: Shape) -> Drawn:
    """The modes of the plant that no gain moves are asked for like those of the plant alone."""
    return desired(random, shape, shape.order + shape.outputs) if shape.order + shape.outputs <= 7 else None


def _unknown_input_observer(random: Random, shape: Shape) -> Drawn:
    """One or two disturbances, that the outputs do not always see."""
    if shape.order > 5:
        return None
    E = shapes.dense(random, shape.order, random.choice([1, 1, min(2, shape.outputs)]), 0)
    return _joined(desired(random, shape, shape.order), {"E": text_of(shapes.texts(E))})


def _disturbance_observer(random: Random, shape: Shape) -> Drawn:
    """A constant disturbance, two of them, or a sinusoid."""
    q = random.choice([1, 1, min(2, shape.outputs)])
    E, model, more = shapes.dense(random, shape.order, q, 0), {}, q
    if q == 1 and random.random() < 0.5:
        model, more = {"S": random.choice(["[0 2; -2 0]", "[0 1; -1 0]", "[-1 1; 0 0]"])}, 2
    if shape.order + more > 6:
        return None
    return _joined(desired(random, shape, shape.order + more), {"E": text_of(shapes.texts(E))}, model)


def _tracking(random: Random, shape: Shape) -> Drawn:
    """A reference that can be followed more often than not: A_d = A − B X."""
    minimal = shape.outputs < shape.order
    if not minimal or shape.order > 6:
        return None
    reference = shapes.dense(random, shape.order, shape.order, 0)
    if random.random() < 0.7 and not shape.signs:
        A, B = ([[Fraction(entry) for entry in row] for row in table] for table in (shape.A, shape.B))
        moved = shapes.times(B, shapes.dense(random, shape.inputs, shape.order, 0))
        reference = [[a - b for a, b in zip(p, q, strict=True)] for p, q in zip(A, moved, strict=True)]
    asked = {"reference_matrix": text_of(shapes.texts(reference))}
    degree = shape.order - shape.outputs
    return _joined(desired(random, shape, shape.order, "control_"), desired(random, shape, degree, "observer_"), asked)


def _gramian(random: Random, shape: Shape) -> Drawn:
    of = {"of": random.choice(["observability", "controllability"])}
    if shape.discrete:
        return {**of, "horizon": random.choice(["2", "3", str(shape.order), "inf"])}
    if random.random() < 0.5:
        return {**of, "horizon": "inf"}
    return {**of, "horizon": "T", "symbols": {"T": "positive"}} if random.random() < 0.7 else {**of, "horizon": "2"}


def _matrix_exponential(_random: Random, shape: Shape) -> Drawn:
    return None if shape.order > 5 or shape.discrete else {}


def _initial_state_covariance(random: Random, shape: Shape) -> Drawn:
    if shape.discrete or max(shape.inputs, shape.outputs) > 1:
        return None
    size, outputs = shape.inputs, shape.outputs
    Q = [["0"] * size for _ in range(size)]
    R = [["0"] * outputs for _ in range(outputs)]
    for k in range(size):
        Q[k][k] = random.choice(["1", "2", "q"])
    for k in range(outputs):
        R[k][k] = random.choice(["1", "3", "r"])
    asked = {"Q": text_of(Q), "R": text_of(R), "horizon": "T"}
    return {**asked, "symbols": {"q": "positive", "r": "positive", "T": "positive"}}


def _initial_state(random: Random, shape: Shape) -> Drawn:
    if shape.discrete:
        return None
    return output_of(random, shape)


def _time_varying(random: Random, shape: Shape) -> Drawn:
    return None if shape.discrete else {"plant": time_varying(random, shape)}


def _pole_advice(random: Random, shape: Shape) -> Drawn:
    if (shape.inputs, shape.outputs) != (1, 1) or shape.signs or shape.discrete:
        return None
    if random.random() < 0.7:
        return {"radius": random.choice(["3", "10", "1/2", "r"]), "symbols": {"r": "positive"}}
    return {"settling_time": random.choice(["1", "2", "1/2"]), "overshoot": random.choice(["1/20", "1/10", "1/5"])}


def _one_of(name: str, *values: Any) -> Callable[[Random, Shape], Drawn]:
    return lambda random, _shape: {name: random.choice(values)}


_SPECIFICATIONS: dict[str, Callable[[Random, Shape], Drawn]] = {
    "detectability": _one_of("meaning", "asymptotic", "asymptotic", "lyapunov"),
    "stabilizability": _one_of("meaning", "asymptotic", "asymptotic", "lyapunov"),
    "pbh": _one_of("of", "observability", "controllability"),
    "canonical_form": _one_of("kind", "controllable", "observable", "modal"),
    "dual": _one_of("sign", 1, -1),
    "matrix_exponential": _matrix_exponential,
    "gramian": _gramian,
    "initial_state": _initial_state,
    "initial_state_covariance": _initial_state_covariance,
    "time_varying_observability": _time_varying,
    "state_feedback": _state_feedback,
    "observer": _observer,
    "reduced_order_observer": _reduced_order_observer,
    "compensator": _compensator,
    "feedforward": _feedforward,
    "tracking": _tracking,
    "integral_action": _integral_action,
    "unknown_input_observer": _unknown_input_observer,
    "disturbance_observer": _disturbance_observer,
    "pole_advice": _pole_advice,
    "stability_region": regions.drawn,
}
