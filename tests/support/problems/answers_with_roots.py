"""Answers with roots of letters in many forms, and near misses of them: made by SymPy, held against numbers with mpmath."""

from __future__ import annotations

from random import Random
from typing import TYPE_CHECKING, NamedTuple

import sympy as sp

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

LETTERS = {name: sp.Symbol(name, positive=True) for name in ("a", "b", "g", "h", "q", "r", "w")}
a, b, g, h, q, r, w = LETTERS.values()
t = sp.Symbol("t", real=True)
root = sp.sqrt


class Problem(NamedTuple):
    """A problem file and its answer, which was worked out by hand, entry by entry."""

    name: str
    text: str
    field: str
    rows: tuple[tuple[sp.Expr, ...], ...]


def _file(task: str, plant: str, specification: str, letters: str) -> str:
    declared = "\n".join(f'{name} = "positive"' for name in letters.split())
    return f'task = "{task}"\n[symbols]\n{declared}\n[plant]\n{plant}\n[specification]\n{specification}\n'


_DOUBLE = 'A = "[0 1; 0 0]"\nB = "[0; 1]"'
_MEASURED = 'A = "[0 1; 0 0]"\nC = "[1 0]"'
#: x'' = -h² x + u, cost x² and r u²: with c = √(h⁴ + 1/r) the gain is [c − h², √(2 (c − h²))].
_c = root(h**4 + 1 / r)

PROBLEMS = (
    Problem("scalar", _file("lqr", 'A = "[0]"\nB = "[1]"', 'Q = "q"\nR = "r"', "q r"), "K", ((root(q / r),),)),
    Problem(
        "scalar_moving",  # 2 a p − p²/r + q = 0
        _file("lqr", 'A = "[a]"\nB = "[1]"', 'Q = "q"\nR = "r"', "a q r"),
        "K",
        ((a + root(a**2 + q / r),),),
    ),
    Problem(
        "scalar_with_input",
        _file("lqr", 'A = "[-a]"\nB = "[b]"', 'Q = "q"\nR = "r"', "a b q r"),
        "K",
        (((-a + root(a**2 + b**2 * q / r)) / b,),),
    ),
    Problem(
        "position",
        _file("lqr", _DOUBLE, 'Q = "[q 0; 0 0]"\nR = "r"', "q r"),
        "K",
        ((root(q / r), root(2) * (q / r) ** sp.Rational(1, 4)),),
    ),
    Problem(
        "both_states",
        _file("lqr", _DOUBLE, 'Q = "[1 0; 0 1]"\nR = "r"', "r"),
        "K",
        ((1 / root(r), root(1 / r + 2 / root(r))),),
    ),
    Problem(
        "both_weights",
        _file("lqr", _DOUBLE, 'Q = "[q 0; 0 w]"\nR = "r"', "q w r"),
        "K",
        ((root(q / r), root(w / r + 2 * root(q / r))),),
    ),
    Problem(
        "oscillator",
        _file("lqr", 'A = "[0 1; -h^2 0]"\nB = "[0; 1]"', 'Q = "[1 0; 0 0]"\nR = "r"', "h r"),
        "K",
        ((_c - h**2, root(2 * (_c - h**2))),),
    ),
    Problem(
        "filter",
        _file("kalman", 'A = "[-a]"\nC = "[g]"', 'W = "w"\nV = "r"', "a g w r"),
        "L",
        (((-a + root(a**2 + g**2 * w / r)) / g,),),
    ),
    Problem(
        "filter_of_position",
        _file("kalman", _MEASURED, 'W = "[0 0; 0 w]"\nV = "r"', "w r"),
        "L",
        ((root(2) * (w / r) ** sp.Rational(1, 4),), (root(w / r),)),
    ),
    Problem(
        "growing",
        _file("matrix_exponential", 'A = "[0 a; b 0]"', "", "a b"),
        "matrix",
        (
            (sp.cosh(root(a * b) * t), root(a / b) * sp.sinh(root(a * b) * t)),
            (root(b / a) * sp.sinh(root(a * b) * t), sp.cosh(root(a * b) * t)),
        ),
    ),
    Problem(
        "turning",
        _file("matrix_exponential", 'A = "[0 a; -b 0]"', "", "a b"),
        "matrix",
        (
            (sp.cos(root(a * b) * t), root(a / b) * sp.sin(root(a * b) * t)),
            (-root(b / a) * sp.sin(root(a * b) * t), sp.cos(root(a * b) * t)),
        ),
    ),
    Problem(
        "placed",  # poles −√(a/b) twice: (s + √(a/b))²
        _file("state_feedback", _DOUBLE, 'poles = "-sqrt(2), -3*sqrt(2)"', "a"),
        "K",
        ((sp.Integer(6), 4 * root(2)),),
    ),
)


def _is_equal(one: sp.Expr, other: sp.Expr, draw: Random) -> bool | None:
    """Whether two entries are equal at points to forty digits; None where a number is not real."""
    for _ in range(3):
        letters = sorted(one.free_symbols | other.free_symbols, key=str)
        at = {name: sp.Rational(draw.randint(3, 40), draw.randint(3, 40)) for name in letters}
        left, right = (entry.evalf(60, subs=at) for entry in (one, other))
        if not (left.is_real and right.is_real):
            return None
        if abs(left - right) > sp.Float("1e-40") * (1 + abs(right)):
            return False
    return True


def _conjugate(entry: sp.Expr, draw: Random) -> sp.Expr:
    """The entry times x/x, where x is 1 plus a root, and the numerator multiplied out."""
    x = 1 + root(draw.choice(sorted(entry.free_symbols, key=str) or [sp.Integer(3)]))
    above, below = sp.fraction(sp.together(entry))
    return sp.expand(above * x) / sp.expand(below * x)


def _parted(entry: sp.Expr, draw: Random) -> sp.Expr:
    """√u written √(u x)/√x."""
    x = draw.choice(sorted(entry.free_symbols - {t}, key=str) or [sp.Integer(5)])
    return entry.replace(
        lambda e: e.is_Pow and e.exp == sp.Rational(1, 2), lambda e: root(sp.expand(e.base * (x + 1))) / root(x + 1)
    )


def _rooted(entry: sp.Expr, draw: Random) -> sp.Expr:
    """A letter written as the square of its root."""
    letter = draw.choice(sorted(entry.free_symbols - {t}, key=str) or [sp.Symbol("x")])
    new = sp.Symbol("new", positive=True)
    return sp.expand(entry.subs(letter, new**2)).subs(new, root(letter))


_REWRITINGS: tuple[Callable[[sp.Expr, Random], sp.Expr], ...] = (
    lambda e, _: sp.powdenest(e, force=True),
    lambda e, _: sp.powsimp(e, force=True),
    lambda e, _: sp.expand_power_base(e, force=True),
    lambda e, _: sp.expand_power_exp(e),
    lambda e, _: sp.radsimp(e),
    lambda e, _: sp.together(e),
    lambda e, _: sp.expand(e),
    lambda e, _: sp.factor(e),
    lambda e, _: sp.sqrtdenest(e),
    lambda e, _: sp.simplify(e),
    lambda e, _: 1 / sp.radsimp(1 / e) if e != 0 else e,
    lambda e, _: sp.apart(e, min(e.free_symbols, key=str)) if e.free_symbols and e.is_rational_function() else e,
    lambda e, _: root(sp.expand(e**2)) if e.is_positive else e,
    lambda e, _: sp.Pow(sp.expand(e**4), sp.Rational(1, 4)) if e.is_positive and not e.has(sp.Add) else e,
    lambda e, _: e.rewrite(sp.exp) if e.has(sp.cosh, sp.sinh) else e,
    _conjugate,
    _parted,
    _rooted,
)


def _misses(entry: sp.Expr, draw: Random) -> sp.Expr:
    """An entry with one thing changed: a sign, a coefficient, a radicand, an exponent, a letter."""
    nodes = [node for node in sp.preorder_traversal(entry) if node.free_symbols or node.is_Number]
    node = draw.choice(nodes)
    changes = [-node, 2 * node, node / 2, node + 1, node * sp.Rational(101, 100)]
    if node.is_Add:
        first, *rest = node.args
        changes += [-first + sp.Add(*rest), 2 * first + sp.Add(*rest)]
    if node.is_Pow:
        changes += [node.base, sp.Pow(node.base, -node.exp), sp.Pow(2 * node.base, node.exp)]
    if node.is_Symbol and node != t:
        changes += [sp.Symbol(other, positive=True) for other in map(str, entry.free_symbols - {t, node})]
    missed = entry.xreplace({node: draw.choice(changes)})
    return missed if all(power.exp in _EXPONENTS or power.exp.free_symbols for power in missed.atoms(sp.Pow)) else entry


#: The exponents of letters that answers may have.
_EXPONENTS = {sp.Rational(k, 4) for k in range(-24, 25)}


def _written(rows: list[list[sp.Expr]]) -> str:
    return "[" + "; ".join(", ".join(str(entry) for entry in row) for row in rows) + "]"


def forms(count: int, seed: str, *, right: bool) -> Iterator[tuple[Problem, str]]:
    """Yield problems with answers that are right, in other forms, or that are not."""
    draw = Random(seed)  # noqa: S311 - forms, no secrets
    made: set[tuple[str, str]] = set()
    while len(made) < count:
        problem = PROBLEMS[draw.randrange(len(PROBLEMS))]
        rows = [list(row) for row in problem.rows]
        for row in rows:
            for j, entry in enumerate(row):
                for _ in range(draw.randint(1, 3)):
                    form = draw.choice(_REWRITINGS)(row[j], draw)
                    if len(str(form)) < 300 and not form.has(sp.log) and _is_equal(form, entry, draw):
                        row[j] = form
        if not right:
            i, j = draw.randrange(len(rows)), draw.randrange(len(rows[0]))
            missed = _misses(rows[i][j], draw)
            if _is_equal(missed, problem.rows[i][j], draw) is not False:
                continue
            rows[i][j] = missed
        text = _written(rows)
        if (problem.name, text) not in made:
            made.add((problem.name, text))
            yield problem, text
