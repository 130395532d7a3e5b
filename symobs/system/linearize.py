"""The linearisation of ẋ = f(x, u), y = h(x, u) at an equilibrium, from what a user gives."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import replace
from fractions import Fraction
from functools import partial
from itertools import islice, product
from typing import TYPE_CHECKING, Any

from symobs.exact import Ideal, Matrix, Scalar
from symobs.exact.core.generators import PI, NotWritten, identities, square_root, symbols_in, symbols_named
from symobs.formula.expression import declared_name, parse_matrix, typed_name, without_latex
from symobs.formula.expression.source import shown
from symobs.ground.errors import InputError, ShapeMismatch, together
from symobs.system.reading import Nonlinear, has_decimals, read_time, read_values
from symobs.system.state_space import StateSpace
from symobs.system.symbols import Symbols, is_sympy

if TYPE_CHECKING:
    from collections.abc import Iterator

#: π to more digits than a value is given with.
_PI = Fraction(3141592653589793238, 10**18)
_EXAMPLE = 'equilibrium = { theta = "pi", omega = 0, u = 0 }'


def linearize(
    f: object,
    h: object = None,
    *,
    states: str | Sequence[Any],
    inputs: str | Sequence[Any] = (),
    equilibrium: Mapping[Any, Any],
    dt: object = 0,
    symbols: Mapping[str, Any] | Symbols | None = None,
) -> StateSpace:
    """Return the plant of the deviations from an equilibrium of ẋ = f(x, u), y = h(x, u).

    A = ∂f/∂x, B = ∂f/∂u, C = ∂h/∂x and D = ∂h/∂u at the equilibrium, where f = 0 (f(x, u) = x in discrete time,
    x(k+1) = f(x, u)); pages begin with that.

    f, h         n and p functions of the states and inputs: a text such as "[omega; g/l*sin(theta) + u]", a list or a
                 SymPy matrix, rational in exp, sin, cos, tan, sinh, cosh, tanh and sqrt
    states       their names in the order of x, "theta, omega"; `inputs` likewise
    equilibrium  a value for each of them: {"theta": "pi", "omega": 0, "u": 0}
    dt, symbols  as for `StateSpace`; states and inputs need not be declared
    Raises `InputError` where f does not vanish at that point or is not differentiable there, and for unknown names;
    `ShapeMismatch` where f has not a component for each state.
    """
    x, u = _names(states, "states"), _names(inputs, "inputs")
    known = (symbols if isinstance(symbols, Symbols) else Symbols.of(symbols)).seen([f, h, equilibrium])
    variable = read_time(dt, known).variable
    if taken := sorted({name for name in x + u if (x + u).count(name) > 1 or name in {variable, "t"}}):
        message = f"{taken[0]} stands for something else, too"
        raise InputError(message, where="plant.states", repair=f"give {taken[0]} another name")
    signals = {name: known.sign(name) for name in x + u}
    inside = replace(known, signs={**known.signs, **signals})
    right, output, point = together(
        partial(_column, f, inside, "plant.f"),
        partial(_column, h, inside, "plant.h"),
        partial(_point, equilibrium, x + u, inside),
    )
    if right.shape[0] != len(x):
        message = f"f has {right.shape[0]} components, and there are {len(x)} states"
        raise ShapeMismatch(message, where="plant.f", repair="write the rate of change of each state, in their order")
    given = Nonlinear(right, output, x, u, point)
    A, B, C, D = _linearised(given, is_discrete=variable == "z")
    plant = StateSpace(A, B, C, D, dt, symbols=known)
    plant.nonlinear, plant.is_in_decimals = given, has_decimals([f, h, equilibrium])
    return plant


def _linearised(given: Nonlinear, *, is_discrete: bool) -> tuple[Matrix | None, ...]:
    """Return A, B, C, D; raises `InputError` where the point is no equilibrium, or f has no derivative there."""
    try:
        rest = _left_over(given, is_discrete=is_discrete)
        parts = [
            given.there(given.jacobian(function, names)) if function is not None and names else None
            for function in (given.f, given.h)
            for names in (given.states, given.inputs)
        ]
        is_at_rest = _vanishes(rest)
    except NotWritten as error:
        raise InputError(str(error), where="plant.equilibrium", repair="declare a symbol for it") from None
    except ZeroDivisionError:
        message = "f or h is not differentiable there: a denominator is 0"
        raise InputError(message, where="plant.equilibrium", repair="give an equilibrium inside their domain") from None
    if not is_at_rest:
        what, wanted = ("f(x, u) - x", "f(x, u) = x") if is_discrete else ("f(x, u)", "f(x, u) = 0")
        message = f"this is no equilibrium: {what} is [{'; '.join(map(str, rest.entries))}] there"
        repair = f"give values for which {wanted}"
        if exact := _exact_nearby(given, is_discrete=is_discrete):
            listed = ", ".join(f'{name} = "{value}"' for name, value in exact)
            repair += f": these are rounded ones of the equilibrium {{ {listed} }}"
        raise InputError(message, where="plant.equilibrium", repair=repair)
    return tuple(parts)


def _left_over(given: Nonlinear, *, is_discrete: bool) -> Matrix:
    """Return f at the point, in discrete time less the point."""
    rest = given.there(given.f)
    return rest - Matrix.of([[dict(given.equilibrium)[name]] for name in given.states]) if is_discrete else rest


def _vanishes(rest: Matrix) -> bool:
    """Return whether all entries are 0, by the identities of their functions."""
    meanings, vanishing = identities([rest])
    ideal = Ideal.of(vanishing)
    left = (entry.substitute(meanings) if meanings else entry for entry in rest.entries)
    return all(ideal.simplified(entry).is_zero for entry in left)


# An exact equilibrium that has the given values when rounded.


#: How many points are tried, and the largest denominator of a multiple of π.
_TRIED, _PARTS_OF_PI = 200, 12


def _exact_nearby(given: Nonlinear, *, is_discrete: bool) -> tuple[tuple[str, Scalar], ...]:
    """Return an equilibrium that differs in the last digit at most; nothing where none is found.

    Its values are fractions, square roots and multiples of π; one of them may solve an equation of degree 2.
    """
    meant = [_meant(value) for _, value in given.equilibrium]
    names = [name for name, _ in given.equilibrium]
    points = list(islice(product(*meant), _TRIED))
    solving = [(point, place) for place in range(len(names)) for point in points if len(meant[place]) > 1]
    for point, place in [*((point, None) for point in points), *solving[:_TRIED]]:
        at = list(point)
        try:
            if place is not None:
                at[place] = Scalar.symbol(names[place])
                moved = replace(given, equilibrium=tuple(zip(names, at, strict=True)))
                rest = _left_over(moved, is_discrete=is_discrete)
                value = given.equilibrium[place][1]
                root = next(_roots_near(rest, names[place], value), None)
                if root is None:
                    continue
                at[place] = root
            moved = replace(given, equilibrium=tuple(zip(names, at, strict=True)))
            if _vanishes(_left_over(moved, is_discrete=is_discrete)):
                return moved.equilibrium
        except (NotWritten, ZeroDivisionError):
            continue
    return ()


def _step(value: Scalar) -> Fraction | None:
    """Return a unit of the last decimal of a number; None for what is no decimal of one digit or more."""
    if not value.is_constant:
        return None
    number, step = value.fraction(), Fraction(1)
    while number % step and step > Fraction(1, 10**12):
        step /= 10
    return step if step < 1 and not number % step else None


def _meant(value: Scalar) -> list[Scalar]:
    """Return a value, and what it may be rounded from."""
    step, found = _step(value), [value]
    if step is None:
        return found
    number = value.fraction()
    for turned, scale in ((number / _PI, Scalar.symbol(PI)), (number, None)):
        near = turned.limit_denominator(_PARTS_OF_PI if scale is not None else max(1, int(1 / step / 10)))
        exact = near * (_PI if scale is not None else 1)
        if abs(exact - number) <= step and near:
            found.append(Scalar.of(near) if scale is None else scale * near)
    squared = (number * number).limit_denominator(max(1, int(1 / step / 10)))
    if squared and abs(float(squared) ** 0.5 - abs(float(number))) <= step:
        found.append(square_root(Scalar.of(squared)) * (1 if number > 0 else -1))
    return list(dict.fromkeys(found))


def _roots_near(rest: Matrix, name: str, value: Scalar) -> Iterator[Scalar]:
    """Yield the roots by square roots, near a value, of the first entry that is not 0."""
    number, step = float(value.fraction()), float(_step(value) or 0)
    entry = next((entry for entry in rest.entries if name in entry.names), None)
    if entry is None or any(name in symbols_named(other) for other in entry.names if other != name):
        return
    for factor, _ in entry.numerator.factors()[1]:
        if factor.names != {name} or factor.degree(name) > 2:
            continue
        *lead, b, c = factor.coefficients(name)
        roots = [-c / b]
        if lead:
            half, distance = -b / (2 * lead[0]), b * b / (4 * lead[0] * lead[0]) - c / lead[0]
            if distance.fraction() < 0:
                continue
            root = square_root(distance)
            roots = [half + root, half - root] if distance else [half]
            near = [float(half.fraction()) + sign * float(distance.fraction()) ** 0.5 for sign in (1, -1)]
        else:
            near = [float(roots[0].fraction())]
        yield from (root for root, at in zip(roots, near, strict=False) if abs(at - number) <= step)


def _names(given: object, where: str) -> tuple[str, ...]:
    """Return the names in a text or a list."""
    listed = re.split(r"[,;\s]+", given.strip(" []")) if isinstance(given, str) else given
    if not isinstance(listed, Sequence):
        raise InputError("names are expected", where=f"plant.{where}", repair=f'write {where} = "x1, x2"')
    names = tuple(declared_name(typed_name(str(name)), f"plant.{where}") for name in listed if str(name))
    if not names and where == "states":
        raise InputError("no state is named", where="plant.states", repair='write states = "theta, omega"')
    return names


def _column(value: object, symbols: Symbols, where: str) -> Matrix | None:
    """Return functions of the states and inputs as a column; h may be left out."""
    if value is None and where == "plant.f":
        raise InputError("f is missing", where=where, repair='give it, for example f = "[omega; -sin(theta) + u]"')
    if value is None:
        return None
    rows: Any = value.tolist() if hasattr(value, "tolist") else value
    if not isinstance(rows, str):
        rows = [rows] if not isinstance(rows, (list, tuple)) else rows
        rows = [[_text(entry) for entry in (row if isinstance(row, (list, tuple)) else [row])] for row in rows]
    try:
        read = parse_matrix(rows, symbols.names, where=where, functions=True)
    except ShapeMismatch:
        if not isinstance(rows, str) or "," in rows or not re.search(r"[-+*/^(]|\b(?:sin|cos|tan|exp|sqrt)\b", rows):
            raise
        read = _by_rows(rows, symbols, where)
    read = read.T if read.shape[0] == 1 else read
    if read.shape[1] != 1:
        message = f"a column is expected, but a matrix of {read.shape[0]}×{read.shape[1]} came"
        raise ShapeMismatch(message, where=where, repair="set its components apart by semicolons")
    return read


def _by_rows(text: str, symbols: Symbols, where: str) -> Matrix:
    """Return a column whose rows are expressions with blanks for products: [x2; -a sin x1 - b x2]."""
    rows = [[row] for row in without_latex(text).strip().strip("[]").split(";")]
    return parse_matrix(rows, symbols.names, where=where, functions=True)


def _text(entry: object) -> object:
    return str(entry) if is_sympy(entry) else entry


def _point(given: object, names: tuple[str, ...], symbols: Symbols) -> tuple[tuple[str, Scalar], ...]:
    """Return the value of each state and input at the equilibrium, in their order."""
    if not isinstance(given, Mapping):
        message = "a value for each state and input is expected"
        raise InputError(message, where="plant.equilibrium", repair=f"write {_EXAMPLE}")
    values = {str(getattr(key, "name", key)): value for key, value in given.items()}
    missing, unknown = [n for n in names if n not in values], [n for n in values if n not in names]
    if missing or unknown:
        said = [f"{', '.join(missing)} has no value"] if missing else []
        said += [f"{shown(', '.join(unknown), 40)} is neither a state nor an input"] if unknown else []
        message = " and ".join(said)
        raise InputError(message, where="plant.equilibrium", repair=f"give a value for each of {', '.join(names)}")
    try:
        found = read_values(values, symbols, names)
    except InputError as error:
        error.where = error.where.replace("substitute", "plant.equilibrium")
        raise
    inside = sorted({name for value in found.values() for name in symbols_in(value) & set(names)})
    if inside:
        message = f"{inside[0]} is a state or an input, and the equilibrium does not depend on it"
        raise InputError(message, where="plant.equilibrium", repair="give the value, with a parameter such as theta0")
    return tuple((name, found[name]) for name in names)
