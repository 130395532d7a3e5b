"""The picture of a response: the input is the output of an exosystem, so state and input have a linear equation."""

from __future__ import annotations

from fractions import Fraction
from math import pi
from typing import TYPE_CHECKING, NamedTuple

from symobs.exact import Matrix, Scalar, companion
from symobs.exact.core.generators import normal_form
from symobs.exact.time_functions.quasipolynomial import Quasipolynomial, table_of
from symobs.proof.derivation.builder import Builder, relation
from symobs.tasks.analysis.time_response.courses import TIMES, Signals, plot_courses, rounded_up, rows_of
from symobs.tasks.analysis.time_response.damping_cases import rate_of

if TYPE_CHECKING:
    from symobs.formula.tree import Relation
    from symobs.proof.derivation.builder import Builder
    from symobs.system import StateSpace


#: More courses cannot be told from one another.
_MOST_COURSES = 6
#: What is drawn of an undamped oscillation, in periods; of growth, in time constants; and where nothing has a time scale.
_PERIODS, _GROWTHS, _ANY = 3, 3.0, Fraction(10)
_NEAR_ZERO = 1e-9


class InputModel(NamedTuple):
    """ẇ = S w, u = V w, w(0) = w₀, with w the inputs and their derivatives, also as functions of t."""

    S: Matrix
    V: Matrix
    start: Matrix
    w: Matrix


def input_model(u: Matrix) -> InputModel | None:
    """Return the exosystem of an input that is not 0; None where it is no system of rational numbers."""
    if u.is_zero:
        return None
    found = exosystem(u)
    return None if found.S.names or found.start.names else found


def exosystem(u: Matrix) -> InputModel:
    """Return the least exosystem of each input, of which one at least is not 0."""
    blocks: list[tuple[Matrix, list[Scalar]]] = []
    functions: list[list[Scalar]] = []
    for (entry,) in table_of(u):
        if entry.is_zero:
            blocks.append((Matrix.zeros(0, 0), []))
            continue
        coefficients = [normal_form(c) for c in _annihilator(entry).coefficients("s")]
        start, derivative = [], entry
        for _ in coefficients[1:]:
            start.append(derivative.at_zero)
            functions.append([derivative.value_at(Scalar.symbol("t"))])
            derivative = derivative.derivative()
        blocks.append((companion(coefficients[1:]), start))
    sizes = [len(start) for _, start in blocks]
    zeros = [[Matrix.zeros(a, b) for b in sizes] for a in sizes]
    S = Matrix.block([[*row[:i], blocks[i][0], *row[i + 1 :]] for i, row in enumerate(zeros) if sizes[i]])
    first = [sum(sizes[:i]) if size else None for i, size in enumerate(sizes)]
    V = Matrix.of([[Scalar.of(int(j == at)) for j in range(sum(sizes))] for at in first])
    return InputModel(S, V, Matrix.column([value for _, start in blocks for value in start]), Matrix.of(functions))


def _annihilator(entry: Quasipolynomial) -> Scalar:
    """Return the least polynomial q with q(d/dt) u = 0."""
    powers: dict[tuple[Scalar, Scalar], int] = {}
    for key in entry.terms:
        mode = key.rate, key.frequency
        powers[mode] = max(powers.get(mode, 0), key.power + 1)
    found, s = Scalar.of(1), Scalar.symbol("s")
    for (rate, frequency), power in powers.items():
        factor = s - rate if frequency.is_zero else (s - rate) ** 2 + frequency**2
        found = found * factor**power
    return found


def plot_response(page: Builder, begins: Matrix, model: InputModel | None) -> None:
    """Plot state and output from x(0); plant and input have numbers."""
    order = page.plant.order
    states: tuple[str, ...] = ("x",)
    starts: tuple[tuple[Fraction, ...], ...] = (_numbers(begins),)
    whole, row, say = page["A"], Matrix.identity(order), ""
    slots: dict[str, Relation] = {}
    if model is not None:
        w, V, S = page["w_e"], page.value(model.V), page.value(model.S)
        page.dynamics("w_e", S @ w, silent=True)
        page.signal("u", V @ w, silent=True)
        functions = page.value(model.w)
        page.conclude_silently(
            relation(rate_of(functions), S @ functions),
            relation(functions.at("t", 0), model.start),
            relation(page["u_t"], V @ functions),
        )
        whole = page("[A, B {V}; {value}, {S}]", V=V, value=Matrix.zeros(model.S.shape[0], order), S=S)
        row = Matrix.block([[row, Matrix.zeros(order, model.S.shape[0])]])
        states, starts = ("x", "w_e"), (*starts, _numbers(model.start))
        slots = {"input": relation(page["u"], w if Matrix.identity(V.value.shape[1]) == model.V else V @ w)}
        say = "plot_response_constant"
        if not model.S.is_zero:
            slots["exosystem"] = relation(w.derivative, S @ w)
            say = "plot_response_forced"
    elif page.plant.matrices.has_input:
        page.signal("u", page("{value} x", value=Matrix.zeros(page.plant.inputs, order)), silent=True)
    if signals := _signals(page.plant, row, model):
        plot_courses(page, states, starts, whole, signals, _end(whole.value), say, **slots)


def _signals(plant: StateSpace, row: Matrix, model: InputModel | None) -> Signals:
    """Return the state, and the output where it is no component of the state, up to a number of courses."""
    m, order = plant.matrices, plant.order
    found = [("x", row, False)] if order <= _MOST_COURSES else []
    if m.has_output and m.C.shape[0] <= _MOST_COURSES - (order if found else 0):
        seen = m.C @ row
        if model is not None and m.has_feedthrough:
            seen = seen + Matrix.block([[Matrix.zeros(m.C.shape[0], order), m.D @ model.V]])
        if not found or not set(rows_of(seen)) <= set(rows_of(row)):
            found.append(("y", seen, False))
    return found


def _numbers(start: Matrix) -> tuple[Fraction, ...]:
    return tuple(entry.fraction() for entry in start.entries)


def _end(matrix: Matrix) -> Fraction:
    """Return when decay is over, or oscillation and growth have been seen."""
    from symobs.exact.time_functions.matrix_exponential import eigenvalues_near  # noqa: PLC0415 - only pages with responses pay for it

    found = eigenvalues_near(matrix)
    near = _NEAR_ZERO * max(map(abs, found))
    if (fastest := max(root.real for root in found)) > near:
        return rounded_up(_GROWTHS / fastest)
    times = [TIMES / -root.real for root in found if root.real < -near]
    times += [2 * pi * _PERIODS / abs(root.imag) for root in found if abs(root.real) <= near < abs(root.imag)]
    return rounded_up(max(times)) if times else _ANY
