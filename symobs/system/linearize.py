"""The linearisation of ẋ = f(x, u), y = h(x, u) at an equilibrium, from what a user gives.

Chapters: f and h, or equations of motion; the equilibrium, given, or found where values are left out; an exact equilibrium
near to rounded values; what is typed.
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import replace
from fractions import Fraction
from functools import partial
from itertools import islice, product
from typing import TYPE_CHECKING, Any

from symobs.exact import Ideal, Matrix, Scalar
from symobs.exact.core.generators import (
    PI,
    PIECES,
    NotWritten,
    functions_in,
    identities,
    normal_form,
    square_root,
    substitute,
    symbols_in,
    symbols_named,
)
from symobs.formula.expression import declared_name, parse_matrix, typed_name, without_latex
from symobs.formula.expression.source import shown
from symobs.ground.errors import InputError, ShapeMismatch, together
from symobs.system.conditions import sign_of
from symobs.system.decided_signs import by_signs
from symobs.system.equilibria import Equilibria, Equilibrium, equilibria, real_where
from symobs.system.motion import (
    Motion,
    equations_of,
    from_energies,
    rates_of,
    read_states,
    simplified,
    states_of,
    typed_derivatives,
    with_primes,
    without_primes,
)
from symobs.system.reading import Nonlinear, has_decimals, read_time, read_values
from symobs.system.state_space import StateSpace
from symobs.system.symbols import Symbols, is_sympy

if TYPE_CHECKING:
    from collections.abc import Iterator

#: π to more digits than a value is given with.
_PI = Fraction(3141592653589793238, 10**18)
_EXAMPLE = 'equilibrium = { theta = "pi", omega = 0, u = 0 }'


def linearize(
    f: object = None,
    h: object = None,
    *,
    states: str | Sequence[Any] = "",
    inputs: str | Sequence[Any] = (),
    equilibrium: Mapping[Any, Any] | None = None,
    coordinates: str | Sequence[Any] = "",
    equations: str | Sequence[Any] | None = None,
    kinetic: object = None,
    potential: object = None,
    forces: Mapping[str, Any] | None = None,
    dt: object = 0,
    symbols: Mapping[str, Any] | Symbols | None = None,
) -> StateSpace:
    """Return the plant of the deviations from an equilibrium of ẋ = f(x, u), y = h(x, u).

    A = ∂f/∂x, B = ∂f/∂u, C = ∂h/∂x and D = ∂h/∂u at the equilibrium, where f = 0 (f(x, u) = x in discrete time,
    x(k+1) = f(x, u)); pages begin with that.

    f, h         n and p functions of the states and inputs: a text such as "[omega; g/l*sin(theta) + u]", a list or a
                 SymPy matrix, of exp, sin, cos, tan, sinh, cosh, tanh, sqrt, log, asin, acos, atan, abs and sign
    states       their names in the order of x, "theta, omega"; `inputs` likewise
    coordinates  instead of f: q, with `equations` of motion, ["m*x'' + k*x = F"], or with energies; the states are then
                 the coordinates and their rates, "x, x'", or `states`, and h the coordinates where it is left out
    kinetic      T(q, q'), with `potential` V(q) and `forces` {"x": "F"} by coordinate: Lagrange's equations
    equilibrium  a value for each of them: {"theta": "pi", "omega": 0, "u": 0}; what is left out is found
    dt, symbols  as for `StateSpace`; states and inputs need not be declared
    Raises `InputError` where f does not vanish at that point or is not differentiable there, where there is no equilibrium
    or more than one, and for unknown names; `ShapeMismatch` where f has not a component for each state.
    """
    typed = (f, equations, kinetic, potential)
    given, known = nonlinear_plant(
        f, h, states, inputs, coordinates, equations, kinetic, potential, forces, dt, symbols, equilibrium
    )
    is_discrete = read_time(dt, known).variable == "z"
    if is_discrete and given.motion is not None:
        repair = "leave dt out, and sample the plant by the task zero_order_hold"
        raise InputError("equations of motion are those of continuous time", where="plant.dt", repair=repair)
    given, known = at_equilibrium(given, equilibrium, known, is_discrete=is_discrete)
    given, (A, B, C, D) = _linearised(given, known, is_discrete=is_discrete)
    plant = StateSpace(A, B, C, D, dt, symbols=known.naming(sorted(given.new_names), "plant.equilibrium"))
    plant.nonlinear, plant.is_in_decimals = given, has_decimals([*typed, h, equilibrium])
    plant.positive, plant.nonzero = given.positive, (*plant.nonzero, *given.nonzero)
    return plant


_TYPED = ("f", "h", "states", "inputs", "coordinates", "equations", "kinetic", "potential", "forces")


def without_equilibrium(
    *,
    equilibrium: Mapping[Any, Any] | None = None,
    dt: object = 0,
    symbols: Mapping[str, Any] | Symbols | None = None,
    **typed: Any,
) -> StateSpace:
    """Return a nonlinear plant whose equilibria are asked for: there is no linearisation, and A is 0.

    The keywords are those of `linearize`.  Raises `InputError` for any other.
    """
    if unknown := sorted(typed.keys() - _TYPED):
        message = f"{shown(unknown[0], 40)} is no part of a nonlinear plant"
        raise InputError(message, where="plant", repair=f"it has {', '.join(_TYPED)}, equilibrium, dt and symbols")
    parts = {name: typed.get(name) for name in _TYPED} | {
        "states": typed.get("states", ""),
        "inputs": typed.get("inputs", ()),
    }
    given, known = nonlinear_plant(**parts, dt=dt, symbols=symbols, equilibrium=equilibrium)
    names = given.states + given.inputs
    signs = {**known.signs, **{name: known.sign(name) for name in names}}
    point = _point({} if equilibrium is None else equilibrium, names, replace(known, signs=signs), given)
    held = tuple((name, point[name]) for name in given.inputs if name in point)
    plant = StateSpace(Matrix.zeros(len(given.states), len(given.states)), dt=dt, symbols=known)
    plant.nonlinear = replace(given, held=held)
    plant.is_in_decimals = has_decimals([*typed.values(), equilibrium])
    return plant


def nonlinear_plant(
    f: object,
    h: object,
    states: object,
    inputs: object,
    coordinates: object,
    equations: object,
    kinetic: object,
    potential: object,
    forces: object,
    dt: object,
    symbols: Mapping[str, Any] | Symbols | None,
    equilibrium: object = None,
) -> tuple[Nonlinear, Symbols]:
    """Return ẋ = f(x, u), y = h(x, u) without an equilibrium, and the symbols with those of SymPy objects."""
    moves = coordinates or equations is not None or kinetic is not None
    u = _names(inputs, "inputs")
    q = _names(coordinates, "coordinates") if coordinates else ()
    x, orders = (
        read_states(_listed(states, "states"))
        if moves and states
        else (_names(states, "states") if not moves else (), {})
    )
    known = symbols if isinstance(symbols, Symbols) else Symbols.of(symbols)
    known = known.seen([f, h, equilibrium] if not moves else [equilibrium])
    variable = read_time(dt, known).variable
    q = q or tuple(orders)
    if taken := sorted({name for name in x + u if (x + u).count(name) > 1 or name in {variable, "t"}}):
        message = f"{taken[0]} stands for something else, too"
        raise InputError(message, where="plant.states", repair=f"give {taken[0]} another name")
    if both := sorted({*q} & {*u}):
        message = f"{both[0]} is a coordinate and an input"
        raise InputError(message, where="plant.coordinates", repair="give one of them another name")
    signals = {name: known.sign(name) for name in (*x, *q, *u)}
    inside = replace(known, signs={**known.signs, **signals})
    if not moves:
        right, output = together(partial(_column, f, inside, "plant.f"), partial(_column, h, inside, "plant.h"))
        if right.shape[0] != len(x):
            message = f"f has {right.shape[0]} components, and there are {len(x)} states"
            raise ShapeMismatch(
                message, where="plant.f", repair="write the rate of change of each state, in their order"
            )
        return Nonlinear(right, output, x, u, ()), known
    motion = _motion(q, u, inside, orders, equations, kinetic, potential, forces)
    x = _ordered(x, states_of(motion))
    inside = inside.naming(x, "plant.states")
    output = list(q) if h is None else h
    if isinstance(output, str):
        output = typed_derivatives(output, q, "plant.h")
    elif isinstance(output, (list, tuple)):
        output = [typed_derivatives(str(entry), q, "plant.h") for entry in output]
    return Nonlinear(rates_of(motion, x), _column(output, inside, "plant.h"), x, u, (), motion), known


def _motion(
    q: tuple[str, ...],
    u: tuple[str, ...],
    symbols: Symbols,
    orders: Mapping[str, int],
    equations: object,
    kinetic: object,
    potential: object,
    forces: object,
) -> Motion:
    """Return the equations of motion that are given, or those of the energies."""
    if not q:
        repair = 'write coordinates = ["x", "theta"]'
        raise InputError("the coordinates have no names", where="plant.coordinates", repair=repair)
    energies = [
        name
        for name, value in (("kinetic", kinetic), ("potential", potential), ("forces", forces))
        if value is not None
    ]
    if equations is not None and energies:
        message = f"both equations and {energies[0]} are given"
        raise InputError(message, where="plant.equations", repair="keep one of them")
    if equations is not None:
        return equations_of(equations, q, u, symbols, orders)
    return from_energies(kinetic, potential, forces, q, u, symbols)


def _ordered(given: tuple[str, ...], found: tuple[str, ...]) -> tuple[str, ...]:
    """Return the states in the order of those that are given, if any."""
    if given and set(given) != set(found):
        message = f"the states of these equations are {', '.join(map(with_primes, found))}"
        raise InputError(message, where="plant.states", repair="name these, in any order, or leave states out")
    return given or found


# The equilibrium: given, or found where values are left out.


def at_equilibrium(
    given: Nonlinear, equilibrium: object, symbols: Symbols, *, is_discrete: bool
) -> tuple[Nonlinear, Symbols]:
    """Return the plant with its equilibrium; raises `InputError` where there is none, or more than one."""
    names = given.states + given.inputs
    signs = {**symbols.signs, **{name: symbols.sign(name) for name in names}}
    point = _point({} if equilibrium is None else equilibrium, names, replace(symbols, signs=signs), given)
    given = replace(given, held=tuple((name, point[name]) for name in given.inputs if name in point))
    if len(point) == len(names):
        above = real_where(point.values(), signs)
        return replace(given, equilibrium=tuple((name, point[name]) for name in names), positive=above), symbols
    found = all_equilibria(given, point, signs, is_discrete=is_discrete)
    generic = [point for point in found.points if not any(c.operator == "==" for c in point.conditions)]
    if len(generic) != 1 or generic[0].within is not None:
        raise _not_one(replace(found, points=tuple(generic or found.points)), given)
    (there,) = generic
    apart = tuple(c.expression for c in there.conditions if c.operator == "!=")
    values = {**point, **there.values}
    conditions = (c.expression for c in there.conditions if c.operator in {">", ">="})
    above = tuple(dict.fromkeys((*conditions, *real_where(point.values(), signs))))
    point_there = tuple((name, values[name]) for name in names)
    return replace(given, equilibrium=point_there, positive=above, nonzero=apart), symbols


def all_equilibria(
    given: Nonlinear, known: Mapping[str, Scalar], signs: Mapping[str, str], *, is_discrete: bool
) -> Equilibria:
    """Return the equilibria with these values of some of the states and inputs."""
    unknown = [name for name in given.states + given.inputs if name not in known]
    return equilibria(given.at_rest(known, is_discrete=is_discrete), unknown, signs)


def _not_one(found: Equilibria, given: Nonlinear) -> InputError:
    """Return the error of a plant that has no equilibrium, or several."""
    where = "plant.equilibrium"
    if not found.points and found.are_all:
        message = "there is no equilibrium: f(x, u) = 0 has no real solution"
        return InputError(message, where=where, repair="check the equations and the signs of the parameters")
    if not found.points:
        message = f"the equilibrium has no closed form here: {shown(str(found.open_equations[0]), 80)} = 0"
        return InputError(message, where=where, repair="give values for which f(x, u) = 0")
    listed = "; ".join(told_point(point, given) for point in found.points)
    if any(point.within is not None for point in found.points):
        listed = "; ".join(told_point(point, given) for point in found.points)
        message = f"an equilibrium has no closed form: {listed}"
        repair = "ask for the task equilibria, which encloses it"
        if given.inputs:
            repair = "give a state that is exact, and leave the input out, which then follows"
        return InputError(message, where=where, repair=repair)
    message = f"there are {len(found.points)} equilibria{'' if found.are_all else ' or more'}: {listed}"
    telling = next(
        (n for n in given.states + given.inputs if len({str(p.values.get(n)) for p in found.points}) > 1),
        given.states[0],
    )
    repair = f"say which: equilibrium = {{ {with_primes(telling)} = {_quoted(found.points[0].values[telling])} }}"
    return InputError(message, where=where, repair=repair)


def told_point(point: Equilibrium, given: Nonlinear) -> str:
    """Return a solution as a text: theta = pi, F = 0; free unknowns and rates, which are 0, are left out."""
    values = {n: v for n, v in point.values.items() if n not in point.free and not is_rate(n, given)}
    if point.within is not None:
        return ", ".join(f"{name} = {point.digits(name)}..." for name in values)
    text = ", ".join(f"{name} = {value}" for name, value in values.items())
    return text + (f" where {' and '.join(map(str, point.conditions))}" if point.conditions else "")


def is_rate(name: str, given: Nonlinear) -> bool:
    """Return whether a state is the rate of a coordinate, which is 0 at rest."""
    return given.motion is not None and name not in given.motion.coordinates and name in given.states


def _quoted(value: Scalar) -> str:
    return str(value) if value.is_constant and value.fraction().denominator == 1 else f'"{value}"'


def _linearised(
    given: Nonlinear, symbols: Symbols, *, is_discrete: bool
) -> tuple[Nonlinear, tuple[Matrix | None, ...]]:
    """Return the plant and A, B, C, D; raises `InputError` where the point is no equilibrium, or f has no derivative there.

    What is free at the equilibrium keeps its name unless a matrix depends on it: then it is a parameter of its own.
    """
    try:
        parts = _matrices(given, symbols)
        dependent = [n for n in given.free if any(part is not None and n in symbols_in(part) for part in parts)]
        if dependent:
            named = {name: Scalar.symbol(_free_name(name, symbols)) for name in dependent}
            point = tuple((name, substitute(value, named)) for name, value in given.equilibrium)
            positive = tuple(substitute(value, named) for value in given.positive)
            new = frozenset(str(value) for value in named.values())
            given = replace(given, equilibrium=point, positive=positive, new_names=new)
            parts = _matrices(given, symbols)
        rest = _left_over(given, is_discrete=is_discrete)
        is_at_rest = _vanishes(rest, symbols)
    except NotWritten as error:
        raise InputError(str(error), where="plant.equilibrium", repair="declare a symbol for it") from None
    except ZeroDivisionError:
        message = "f or h is not differentiable there: a denominator is 0"
        raise InputError(message, where="plant.equilibrium", repair="give an equilibrium inside their domain") from None
    if not is_at_rest:
        what, wanted = ("f(x, u) - x", "f(x, u) = x") if is_discrete else ("f(x, u)", "f(x, u) = 0")
        message = f"this is no equilibrium: {what} is [{'; '.join(map(str, rest.entries))}] there"
        repair = f"give values for which {wanted}"
        if exact := _exact_nearby(given, symbols, is_discrete=is_discrete):
            listed = ", ".join(f'{name} = "{value}"' for name, value in exact)
            repair += f": these are rounded ones of the equilibrium {{ {listed} }}"
        raise InputError(message, where="plant.equilibrium", repair=repair)
    return given, parts


def _matrices(given: Nonlinear, symbols: Symbols) -> tuple[Matrix | None, ...]:
    """Return A, B, C and D at the point.  Raises `InputError` at a corner of |x|, where there is no derivative."""
    for piece in functions_in([part for part in (given.f, given.h) if part is not None]):
        if piece.kind in PIECES:
            argument = by_signs(substitute(piece.argument, dict(given.equilibrium)), symbols.signs)
            if (sign := sign_of(argument, symbols.signs)) in {"positive", "negative"}:
                continue
            message = f"{piece.text} is not differentiable where {piece.argument} = 0"
            repair = "give an equilibrium where it is not 0"
            if sign != "zero":
                message = f"the sign of {argument} is not known, and {piece.text} has a corner at 0"
                repair = "declare the signs of its symbols"
            raise InputError(message, where="plant.equilibrium", repair=repair)

    def there(function: Matrix, names: Sequence[str]) -> Matrix:
        value = given.there(given.jacobian(function, names))
        rows = [[simplified(normal_form(by_signs(entry, symbols.signs))) for entry in row] for row in value.rows]
        return Matrix.of(rows, len(names))

    return tuple(
        there(function, names) if function is not None and names else None
        for function in (given.f, given.h)
        for names in (given.states, given.inputs)
    )


def _free_name(name: str, symbols: Symbols) -> str:
    """Return the name of the value at the equilibrium: theta_0, or with s where there is one already."""
    return next(taken for index in ("0", "s", "eq", "e") if (taken := f"{name}_{index}") not in symbols.signs)


def _left_over(given: Nonlinear, *, is_discrete: bool) -> Matrix:
    """Return f at the point, in discrete time less the point."""
    rest = given.there(given.f)
    return rest - Matrix.of([[dict(given.equilibrium)[name]] for name in given.states]) if is_discrete else rest


def _vanishes(rest: Matrix, symbols: Symbols) -> bool:
    """Return whether all entries are 0, by the identities of their functions and the signs under roots."""
    rest = Matrix.of([[by_signs(entry, symbols.signs) for entry in row] for row in rest.rows])
    meanings, vanishing = identities([rest])
    ideal = Ideal.of(vanishing)
    left = (entry.substitute(meanings) if meanings else entry for entry in rest.entries)
    return all(ideal.simplified(entry).is_zero for entry in left)


# An exact equilibrium that has the given values when rounded.


#: How many points are tried, and the largest denominator of a multiple of π.
_TRIED, _PARTS_OF_PI = 200, 12


def _exact_nearby(given: Nonlinear, symbols: Symbols, *, is_discrete: bool) -> tuple[tuple[str, Scalar], ...]:
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
            if _vanishes(_left_over(moved, is_discrete=is_discrete), symbols):
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


def _listed(given: object, where: str) -> list[str]:
    """Return the names in a text or a list as they are typed; x(t) of SymPy is x."""
    listed = re.split(r"[,;\s]+", given.strip(" []")) if isinstance(given, str) else given
    if not isinstance(listed, Sequence):
        raise InputError("names are expected", where=f"plant.{where}", repair=f'write {where} = "x1, x2"')
    return [str(name).removesuffix("(t)") for name in listed if str(name)]


def _names(given: object, where: str) -> tuple[str, ...]:
    """Return the names in a text or a list."""
    listed = _listed(given, where)
    names = tuple(declared_name(typed_name(name), f"plant.{where}") for name in listed)
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
        read = parse_matrix(rows, symbols.names, where=where, functions=True, nonlinear=True)
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
    return parse_matrix(rows, symbols.names, where=where, functions=True, nonlinear=True)


def _text(entry: object) -> object:
    return str(entry) if is_sympy(entry) else entry


def _point(given: object, names: tuple[str, ...], symbols: Symbols, plant: Nonlinear) -> dict[str, Scalar]:
    """Return the values that are given; the rates of coordinates, which rest, are 0."""
    if not isinstance(given, Mapping):
        message = "a value for each state and input is expected"
        raise InputError(message, where="plant.equilibrium", repair=f"write {_EXAMPLE}")
    typed = {str(getattr(key, "name", key)): value for key, value in given.items()}
    values = {
        without_primes(key) if plant.motion is not None else typed_name(key): value for key, value in typed.items()
    }
    if unknown := [name for name in values if name not in names]:
        message = f"{shown(', '.join(unknown), 40)} is neither a state nor an input"
        repair = f"give values of {', '.join(map(with_primes, names) if plant.motion else names)}"
        raise InputError(message, where="plant.equilibrium", repair=repair)
    try:
        found = read_values(values, symbols, names, nonlinear=True)
    except InputError as error:
        error.where = error.where.replace("substitute", "plant.equilibrium")
        raise
    inside = sorted({name for value in found.values() for name in symbols_in(value) & set(names)})
    if inside:
        message = f"{inside[0]} is a state or an input, and the equilibrium does not depend on it"
        raise InputError(message, where="plant.equilibrium", repair="give the value, with a parameter such as theta0")
    at_rest = {name: Scalar.of(0) for name in names if is_rate(name, plant)}
    return {**at_rest, **found}
