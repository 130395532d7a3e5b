"""Signals of a source: the equations of plant, observer and control law, in its names."""

from __future__ import annotations

from dataclasses import field
from typing import TYPE_CHECKING, Any

from symobs.applications.audit.equations.letter_values import (
    MEASURED,
    PlantMatrices,
    answers_of,
    blocks_of,
    leading_block,
)
from symobs.exact import Matrix
from symobs.formula.convention import STANDARD
from symobs.formula.tree import Block, Environment, Formula, Letter, Literal, Negative, Product, Sum
from symobs.ground.dataclass import dataclass

if TYPE_CHECKING:
    from collections.abc import Collection, Mapping, Sequence

    from symobs.formula.convention import Convention
    from symobs.system import StateSpace
    from symobs.tasks.result import Result


@dataclass()
class _Signals:
    """The signals of an environment, collected one by one."""

    formulas: dict[str, Formula | None] = field(default_factory=dict)
    sizes: dict[str, int] = field(default_factory=dict)
    dynamics: dict[str, Formula] = field(default_factory=dict)

    def free(self, name: str, size: int, rate: Formula | None = None) -> None:
        self.formulas[name], self.sizes[name] = None, size
        if rate is not None:
            self.dynamics[name] = rate

    def stacked(self, name: str, size: int, rate: Formula, mentioned: Collection[str]) -> None:
        """Add a signal, stacked from its components if the equation contains one of them."""
        parts = [f"{name}_{i + 1}" for i in range(size)]
        if not set(parts) & set(mentioned):
            self.free(name, size, rate)
            self.formulas |= {part: _row(i, size, name) for i, part in enumerate(parts)}
            return
        for i, part in enumerate(parts):
            self.free(part, 1, Product((Literal(_unit(i, size)), rate)))
        self.formulas[name] = Block(tuple((Letter(part),) for part in parts))


def _unit(index: int, size: int) -> Matrix:
    return Matrix.unit(size, index).T


def _row(index: int, size: int, name: str) -> Formula:
    return Product((Literal(_unit(index, size)), Letter(name)))


def _times(matrix: Matrix, signal: str) -> Formula:
    return Product((Literal(matrix), Letter(signal)))


def telling(plant: StateSpace, convention: Convention) -> frozenset[str]:
    """Return the letters on which it depends, where they stand in an equation, which signals are free in it."""
    called = _called(convention)
    components = {f"{name}_{i + 1}" for name in ("x", called["x_hat"]) for i in range(plant.order)}
    return frozenset({"x", "u", "y", "z", "x_hat", *called.values(), *components})


def _called(convention: Convention) -> dict[str, str]:
    """Return the names of errors and estimates in a convention."""
    called = {key: convention.letters.get(key, key) for key in ("e", "e_2", "e_d", "x_hat")}
    return {**called, "x_hat_2": convention.letters.get("x_2_hat", "x_hat_2")}


def signals(
    plant: StateSpace,
    results: Sequence[Result],
    convention: Convention,
    mentioned: Collection[str],
    right: Collection[str],
) -> Environment:
    """Return the environment of the signals of an equation.

    y stands by itself where nothing of x is `mentioned`, u where it is; the error replaces the estimate where it stands
    on the `right`.
    """
    m, answers, called = PlantMatrices.of(plant), answers_of(results), _called(convention)
    K, L, known = answers.get("K"), answers.get("L"), _Signals()
    first, p = leading_block(m.C), 0 if m.C is None else m.C.shape[0]
    reduced = first is not None and L is not None and L.shape == (plant.order - p, p)
    states = {"x", called["e"], called["e_2"], called["e_d"], *(f"x_{i + 1}" for i in range(plant.order))}
    measured = m.C is not None and not states & set(mentioned)
    if measured:
        known.free("y", p, Letter("y'"))
        known.free("y'", p)
    fed_back = K is not None and "u" not in right and (L is not None or "x_hat" not in mentioned)
    if m.B is not None and not fed_back:
        known.free("u", m.B.shape[1], Letter("u'"))
        known.free("u'", m.B.shape[1])
    rate = _sum(_times(m.A, "x"), _times(m.B, "u") if m.B is not None else None)
    if first is not None and (reduced or convention.name in MEASURED):
        _partitioned(known, plant, (L, first), rate, called, right)
    else:
        known.stacked("x", plant.order, rate, mentioned)
    if L is not None and L.shape == (plant.order, p):
        _full_order(known, m, L, called, (mentioned, right))
    if (L is not None or "K_d" in answers) and called["x_hat"] not in known.formulas:
        known.free(called["x_hat"], plant.order)  # the law needs it, its equations are not known
    if m.C is not None and not measured:
        through = None if m.D is None or m.D.is_zero else _times(m.D, "u")
        known.formulas["y"] = _sum(_times(m.C, "x"), through)
    if "K_d" in answers:
        _tracking(known, answers, called, right)
    elif fed_back and m.B is not None:
        law = -K  # type: ignore[operator]
        known.formulas["u"] = _times(law, called["x_hat"] if L is not None else "x")
    return Environment(variable=plant.variable, signals=known.formulas, sizes=known.sizes, dynamics=known.dynamics)


def _sum(*terms: Formula | None) -> Formula:
    there = tuple(term for term in terms if term is not None)
    return there[0] if len(there) == 1 else Sum(there)


def _full_order(
    known: _Signals,
    m: PlantMatrices,
    L: Matrix,
    called: Mapping[str, str],
    letters: tuple[Collection[str], Collection[str]],
) -> None:
    """Add x̂ and e = x - x̂, one of which has equations of its own."""
    mentioned, right = letters
    estimate, error = called["x_hat"], called["e"]
    through = None if m.D is None or m.D.is_zero else m.D
    inputs = None if m.B is None else _times(m.B if through is None else m.B - L @ through, "u")
    closed = m.A if m.C is None else m.A - L @ m.C
    rate = _sum(_times(closed, estimate), inputs, _times(L, "y"))
    if error in right and estimate not in right:
        driven = None if m.B is None else _times(m.B, "u")
        known.free(error, m.A.shape[0], _sum(_times(m.A, "x"), Negative(rate), driven))
        known.formulas[estimate] = Sum((Letter("x"), Negative(Letter(error))))
    else:
        known.stacked(estimate, m.A.shape[0], rate, mentioned)
        known.formulas[error] = Sum((Letter("x"), Negative(Letter(estimate))))


def _partitioned(
    known: _Signals,
    plant: StateSpace,
    gains: tuple[Matrix | None, Matrix],
    rate: Formula,
    called: Mapping[str, str],
    right: Collection[str],
) -> None:
    """Add x = [x₁; x₂], and z, x̂₂ and e₂ of a minimal-order observer, one of which has equations of its own."""
    m, (L, first) = PlantMatrices.of(plant), gains
    n, p = plant.order, first.shape[0]
    for name, rows in (("x_1", range(p)), ("x_2", range(p, n))):
        known.free(name, len(rows), Product((Literal(Matrix.identity(n).select(rows, range(n))), rate)))
    known.formulas["x"] = Block(((Letter("x_1"),), (Letter("x_2"),)))
    if L is None or L.shape != (n - p, p):
        return
    found = blocks_of(plant, None, L, STANDARD)
    estimate, error = called["x_hat_2"], called["e_2"]
    own = next((name for name in ("z", estimate, error) if name in right), "z")
    inputs = None if m.B is None else _times(found["G_u"], "u")  # type: ignore[arg-type]
    z_rate = _sum(_times(found["F_z"], "z"), inputs, _times(found["G_y"], "y"))  # type: ignore[arg-type]
    if own == "z":
        known.free("z", n - p, z_rate)
        known.formulas[estimate] = Sum((Letter("z"), _times(L, "y")))
    else:
        known.formulas["z"] = Sum((Letter(estimate), Negative(_times(L, "y"))))
        output = _times(L, "y'") if "y" in known.sizes else Product((Literal(L @ first), known.dynamics["x_1"]))
        estimate_rate = Sum((z_rate, output))
        if own == estimate:
            known.free(estimate, n - p, estimate_rate)
        else:
            known.free(error, n - p, Sum((known.dynamics["x_2"], Negative(estimate_rate))))
            known.formulas[estimate] = Sum((Letter("x_2"), Negative(Letter(error))))
    known.formulas.setdefault(error, Sum((Letter("x_2"), Negative(Letter(estimate)))))
    measured = _times(first.inverse(), "y")
    known.formulas[called["x_hat"]] = Block(((measured,), (Letter(estimate),)))
    known.formulas.setdefault("x_hat_1", measured)


def _tracking(known: _Signals, answers: Mapping[str, Any], called: Mapping[str, str], right: Collection[str]) -> None:
    """Add the reference x_d, the error e = x_d - x and the law u = K (x_d - x₀) - K_d x_d."""
    order = answers["K_d"].shape[1]
    known.free("x_d", order, Product((Letter("A_d"), Letter("x_d"))))
    if "u" not in known.sizes:
        apart = Sum((Letter("x_d"), Negative(Letter(called["x_hat"]))))
        law = (Product((Literal(answers["K"]), apart)), Negative(_times(answers["K_d"], "x_d")))
        known.formulas["u"] = Sum(law)
    if (error := called["e_d"]) in right:
        parts = (range(known.sizes["x_1"]), range(known.sizes["x_1"], order))
        rates = [known.dynamics[name] for name in ("x_1", "x_2")]
        known.free(error, order, Sum((known.dynamics["x_d"], Negative(Block(tuple((rate,) for rate in rates))))))
        for name, rows in zip(("x_1", "x_2"), parts, strict=True):
            chosen = Literal(Matrix.identity(order).select(rows, range(order)))
            known.formulas[name] = Product((chosen, Sum((Letter("x_d"), Negative(Letter(error))))))
    else:
        known.formulas[error] = Sum((Letter("x_d"), Negative(Letter("x"))))
