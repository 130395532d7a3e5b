"""Constructions: problems made from their answers, so that whole numbers stand in every line of the working.

Each is a function from draws and a shape to the matrices of the plant and what the specification needs.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

from symobs.applications.variants.drawing import (
    Poly,
    Rows,
    block,
    companion,
    identity,
    inverse,
    of_poles,
    plus,
    rank,
    rows_of,
    times,
    transposed,
    unimodular,
    unit_numerators,
    zeros,
)
from symobs.applications.variants.parameters import Poles

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    from symobs.applications.variants.drawing import Draw, Draws

    Shape = Mapping[str, Any]


class Made(NamedTuple):
    """What a construction makes: the matrices of a plant, and parts of the specification by name."""

    plant: Mapping[str, Rows]
    specification: Mapping[str, Any]


def unit_system(draws: Draws, shape: Shape, name: str = "", poles: Poles | None = None) -> tuple[Rows, Rows, Rows]:
    """Return A, B, C with |det 𝒪| = |det 𝒞| = 1, the controllable form of b/χ with Res(χ, b) = ±1.

    det 𝒪 det 𝒞 is ±Res(χ, b), so both inverses are whole, and with them K, L and every matrix on the page.
    """
    chosen = poles or _plant_poles(draws[f"{name}plant poles"], shape)
    chi = of_poles(chosen.pairs)
    numerator: Poly = draws[f"{name}numerator"].one_of(unit_numerators(chi, tuple(chosen.pairs)))
    return companion(chi), transposed(identity(len(chi) - 1)[-1:]), (numerator,)


def _plant_poles(draw: Draw, shape: Shape) -> Poles:
    """Return distinct poles in the interval of the shape, the asked number of pairs among them."""
    low, high = shape["plant_poles"]
    pairs = shape.get("pairs", 0)
    real = [(value, 0) for value in draw.some_of(range(low, high + 1), shape["order"] - 2 * pairs)]
    size = max(-low, high)
    complex_ = [(draw.one_of(range(low, high + 1)), 1 + draw.below(size)) for _ in range(pairs)]
    return Poles(tuple(sorted((*real, *complex_), reverse=True)))


def _some_poles(draw: Draw, ends: Sequence[int], count: int) -> Poles:
    """Return so many poles in an interval, perhaps repeated."""
    low, high = ends
    return Poles(tuple(sorted(((low + draw.below(high - low + 1), 0) for _ in range(count)), reverse=True)))


def _in_coordinates(T: Rows, A: Rows, B: Rows, C: Rows) -> dict[str, Rows]:
    """Return T⁻¹ A T, T⁻¹ B, C T."""
    back = inverse(T)
    return {"A": times(times(back, A), T), "B": times(back, B), "C": times(C, T)}


def _moved(draws: Draws, shape: Shape, A: Rows, B: Rows, C: Rows) -> dict[str, Rows]:
    return _in_coordinates(unimodular(draws["T"], len(A), shape["steps"]), A, B, C)


def compensator(draws: Draws, shape: Shape) -> Made:
    """Return a plant with one input and one output all of whose gains are whole, and poles for both halves."""
    return Made(_moved(draws, shape, *unit_system(draws, shape)), _both_poles(draws, shape, shape["order"]))


def _both_poles(draws: Draws, shape: Shape, order: int) -> dict[str, Poles]:
    """Return poles of the control, and poles of the observer left of them; distinct ones where there is a choice of them."""
    control = _chosen(draws["control poles"], shape["control_poles"], order)
    low, high = shape["observer_poles"]
    left = min(high, control.pairs[-1][0] - 1)
    observer = _chosen(draws["observer poles"], (low, left if left >= low else high), order)
    return {"control_poles": control, "observer_poles": observer}


def _chosen(draw: Draw, ends: Sequence[int], count: int) -> Poles:
    low, high = ends
    if high - low < count:
        return _some_poles(draw, ends, count)
    return Poles(tuple(sorted(((value, 0) for value in draw.some_of(range(low, high + 1), count)), reverse=True)))


def one_half(draws: Draws, shape: Shape) -> Made:
    """Return the same plant, and poles of which a task reads those of one half."""
    plant = _moved(draws, shape, *unit_system(draws, shape))
    names = ("control_poles", "observer_poles")
    return Made(
        plant, {name: _some_poles(draws[name.replace("_", " ")], shape[name], shape["order"]) for name in names}
    )


def member(draws: Draws, shape: Shape) -> Made:
    """Return a plant of several outputs (inputs) made from A − LC (A − BK), which is V⁻¹JV with V unimodular."""
    order, width = shape["order"], shape["outputs"]
    poles = _some_poles(draws["observer poles"], shape["observer_poles"], order)
    J = [[poles.pairs[i][0] if i == j else 0 for j in range(order)] for i in range(order)]
    upper = draws["J"]
    for i in range(order):
        for j in range(i + 1, order):
            J[i][j] = upper.below(2)
    closed = _in_coordinates(unimodular(draws["V"], order, shape["steps"]), rows_of(J), *_empty(order))["A"]
    C = _of_full_rank(draws["C"], width, order)
    L = _entries(draws["L"], order, width, 2)
    B = _entries(draws["B"], order, 1, 1)
    if shape["of"] == "state_feedback":
        plant = {"A": transposed(plus(closed, times(L, C))), "B": transposed(C), "C": transposed(B)}
        return Made(plant, {"control_poles": poles})
    return Made({"A": plus(closed, times(L, C)), "B": B, "C": C}, {"observer_poles": poles})


def decomposition(draws: Draws, shape: Shape) -> Made:
    """Return a plant with parts of the given sizes in Kalman's pattern, the blocks of coprime polynomials.

    In the order co, c_no, nc_o, nc_no an entry stands where the part of its row may be driven by that of its column.
    """
    sizes: Sequence[int] = shape["sizes"]
    low, high = shape["plant_poles"]
    poles = [(value, 0) for value in draws["plant poles"].some_of(range(low, high + 1), sum(sizes))]
    if "hidden" in shape:
        poles = _hidden(draws["hidden poles"], shape, poles)
    seen, blocks, inputs, outputs = 0, [], [], []
    for part, size in enumerate(sizes):
        own = Poles(tuple(poles[seen : seen + size]))
        seen += size
        A, B, C = unit_system(draws, shape, f"part {part} ", own) if size else ((), (), ((),))
        blocks.append(A)
        inputs.append(B if part in {0, 1} else zeros(size, 1))
        outputs.append(C if part in {0, 2} else zeros(1, size))
    driven = {(0, 2), (1, 0), (1, 2), (1, 3), (3, 2)}
    links = draws["links"]
    table = []
    for i in range(4):
        row: list[Rows] = []
        for j in range(4):
            if i == j:
                row.append(blocks[i])
            elif (i, j) in driven:
                row.append(_entries(links, sizes[i], sizes[j], 1))
            else:
                row.append(zeros(sizes[i], sizes[j]))
        table.append(row)
    there = [i for i in range(4) if sizes[i]]
    A = block([[table[i][j] for j in there] for i in there])
    B = block([[inputs[i]] for i in there])
    C = block([[outputs[i] for i in there]])
    return Made(_moved(draws, shape, A, B, C), {})


def _hidden(draw: Draw, shape: Shape, poles: list[tuple[int, int]]) -> list[tuple[int, int]]:
    """Return poles whose unobservable ones are all stable, or all unstable, apart from the others."""
    low, high = shape["plant_poles"]
    seen = [shape["sizes"][0] + shape["sizes"][1], sum(shape["sizes"])]
    first, last = shape["sizes"][0], seen[0]
    wanted = range(low, 0) if shape["hidden"] == "stable" else range(1, high + 1)
    hidden = [(value, 0) for value in draw.some_of(wanted, last - first)]
    others = [value for value in range(low, high + 1) if (value, 0) not in hidden]
    rest = [(value, 0) for value in draw.some_of(others, len(poles) - len(hidden))]
    return [*rest[:first], *hidden, *rest[first:]]


def modal(draws: Draws, shape: Shape) -> Made:
    """Return A = V⁻¹ΛV with whole eigenvalues and eigenvectors."""
    order = shape["order"]
    poles = _plant_poles(draws["plant poles"], {**shape, "pairs": 0})
    diagonal = rows_of((pole[0] if i == j else 0 for j in range(order)) for i, pole in enumerate(poles.pairs))
    B, C = (_nonzero(draws[name], *size) for name, size in (("B", (order, 1)), ("C", (1, order))))
    return Made(_moved(draws, shape, diagonal, B, C), {})


def second_order(draws: Draws, shape: Shape) -> Made:
    """Return the controllable form of a plant of second order with whole roots σ₁, σ₂, or σ ± iω."""
    chi = of_poles(_plant_poles(draws["plant poles"], {**shape, "order": 2}).pairs)
    return Made({"A": companion(chi), "B": ((0,), (1,)), "C": ((1, 0),)}, _both_poles(draws, shape, 2))


def region(draws: Draws, shape: Shape) -> Made:
    """Return a polynomial with two gains whose region has whole corners, or is bounded by h₁h₂ = c.

    triangle   z² + fz + g is stable in the triangle with the corners (±2, 1), (0, −1); [f; g] = Uh + c with U unimodular
    wedge      s³ + a s² + fs + g is stable where g > 0 and af > g; both sides go through a whole corner
    curve      s³ + fs² + gs + c with [f; g] = h − p is stable where fg > c and f > 0
    """
    draw = draws["region"]
    low, high = shape["corners"]
    corner = [low + draw.below(high - low + 1) for _ in range(2)]
    if shape["region"] == "curve":
        first, second = (_linear(row, corner, 0) for row in ((1, 0), (0, 1)))
        return Made({}, _of_gains(f"s^3 + {first} s^2 + {second} s + {1 + draw.below(12)}"))
    if shape["region"] == "triangle":
        U = unimodular(draws["U"], 2, 2)
        first, second = (_linear(row, corner, at) for row, at in zip(U, (0, -1), strict=True))
        return Made({}, {**_of_gains(f"z^2 + {first} z + {second}"), "dt": True})
    a = 1 + draw.below(3)
    normals = [(0, 0), (0, 0)]
    while normals[0][0] * normals[1][1] == normals[0][1] * normals[1][0]:
        normals = [(draw.below(5) - 2, draw.below(5) - 2) for _ in range(2)]
    first, second = (_linear(normal, corner, 0) for normal in normals)
    return Made({}, _of_gains(f"s^3 + {a} s^2 + {first} s + {second}".replace(" 1 s^2", " s^2")))


def _of_gains(polynomial: str) -> dict[str, Any]:
    return {"polynomial": polynomial, "parameters": ["h1", "h2"]}


def _linear(normal: Sequence[int], corner: Sequence[int], value: int) -> str:
    """Return the linear form of h₁ and h₂ with these coefficients and this value at a corner, in parentheses."""
    constant = value - sum(n * c for n, c in zip(normal, corner, strict=True))
    terms = [(normal[0], " h1"), (normal[1], " h2"), (constant, "")]
    text = " ".join(f"{'-' if factor < 0 else '+'} {abs(factor)}{name}" for factor, name in terms if factor)
    text = text.replace(" 1 h", " h")
    return f"({f'-{text[2:]}' if text.startswith('-') else text[2:]})"


# -- parts ------------------------------------------------------------------------------------------------------------


def _empty(order: int) -> tuple[Rows, Rows]:
    return zeros(order, 1), zeros(1, order)


def _entries(draw: Draw, height: int, width: int, size: int) -> Rows:
    """Return a matrix of entries from −size to size."""
    return rows_of((draw.below(2 * size + 1) - size for _ in range(width)) for _ in range(height))


def _nonzero(draw: Draw, height: int, width: int) -> Rows:
    return rows_of((draw.one_of((-1, 1)) for _ in range(width)) for _ in range(height))


def _of_full_rank(draw: Draw, height: int, width: int) -> Rows:
    """Return a matrix of −1, 0 and 1 whose rows are independent."""
    while rank(found := _entries(draw, height, width, 1)) < height:
        pass
    return found


# -- the table --------------------------------------------------------------------------------------------------------


_POLES = {"plant_poles": [-3, 3], "control_poles": [-3, -1], "observer_poles": [-4, -1]}
#: Of control and observer together: those of the observer have to lie left of the others.
_BOTH = {"plant_poles": [-3, 3], "control_poles": [-5, -1], "observer_poles": [-9, -2]}
_FULL = {"order": 3, **_POLES, "pairs": 0, "steps": 2}
_MODAL = {"order": 3, "plant_poles": [-3, 3], "steps": 2}
_DECAYING = {"order": 2, "plant_poles": [-4, -1], "steps": 1}
_MEMBER = {"order": 3, "outputs": 2, "observer_poles": [-3, -1], "steps": 2, "of": "observer"}
_PARTS = {"sizes": [1, 1, 1, 0], "plant_poles": [-4, 4], "steps": 2}


#: Each construction: what makes it, and the keys of its shape with the values they have where nothing is said.
CONSTRUCTIONS: dict[str, tuple[Callable[[Draws, Shape], Made], dict[str, Any]]] = {
    "compensator": (compensator, {**_FULL, **_BOTH}),
    "observer": (one_half, _FULL),
    "state_feedback": (one_half, _FULL),
    "canonical_form": (one_half, _FULL),
    "member": (member, _MEMBER),
    "gain": (member, {**_MEMBER, "outputs": 1}),
    "decomposition": (decomposition, _PARTS),
    "ranks": (decomposition, {**_PARTS, "sizes": [1, 1, 0, 0], "hidden": "stable"}),
    "modal": (modal, _MODAL),
    "gramian": (modal, _DECAYING),
    "matrix_exponential": (modal, {**_DECAYING, "plant_poles": [-3, 2]}),
    "second_order": (second_order, {**_BOTH, "pairs": 0}),
    "region": (region, {"region": "triangle", "corners": [-5, 5]}),
}
