"""Texts by the grammar of expressions, and texts that look like them."""

from __future__ import annotations

from typing import TYPE_CHECKING

from tests.programs.fuzz import corpus, mutate

if TYPE_CHECKING:
    from random import Random

NAMES = ("a", "b", "omega", "h1", "x_1", "M", "tau_f", "lam", "phi", "K", "e", "p", "a", "b", "s", "t", "i", "I")
FUNCTIONS = ("sqrt", "exp", "sin", "cos", "sinh", "cosh")
_SPACES = ("", "", "", " ", "  ", "\t", "\n")
#: Texts that ask for much in few characters, each for a depth.
_TOWERS = (
    lambda n: "(" * n + "a" + ")" * n,
    lambda n: "[" * n + "1" + "]" * n,
    lambda n: "-" * n + "1",
    lambda n: "1^" * n + "1",
    lambda n: "a*" * n + "a",
    lambda n: "+".join(f"a{k}" for k in range(n)),
    lambda n: "(a+b)" * n,
    lambda n: "1/(1+" * n + "a" + ")" * n,
    lambda n: "sqrt(" * n + "4" + ")" * n,
    lambda n: "exp(" * n + "t" + ")" * n,
    lambda n: "[" + "1;" * n + "]",
    lambda n: "[" + "1 " * n + "]",
    lambda n: "," * n,
    lambda n: "a" * n,
    lambda n: "9" * n,
    lambda n: f"1/{'7' * n}" * 3,
    lambda n: "(" + "a+" * n + "b)^2",
    lambda n: f"(a+b+{n})^{n}",
    lambda n: f"(a^{n}-1)/(a^{max(1, n - 1)}-1)",
    lambda n: f"a^{n}+b^{n}",
    lambda n: "A" + "'" * n,
    lambda n: "2*" + "-" * n + "A",
    lambda n: "A" + "^2" * n,
    lambda n: "1" + "-1" * n,
    lambda n: "[" * min(n, 90) + "A" + "]" * min(n, 90) + "'" * n,
    lambda n: " = ".join("A" * n),
)


#: The kinds of expression, the calls last.
_KINDS = (*range(9), 10, *range(9), *range(7), 10, *(9,) * 6)


def expression(source: Random, depth: int = 4, *, calls: bool = True) -> str:
    """Return an expression by the grammar, with or without calls of functions; not every one has a value."""
    kind = source.choice(_KINDS if calls else _KINDS[:-6]) if depth else source.randrange(3)
    space = source.choice(_SPACES)

    def inner() -> str:
        return expression(source, depth - 1, calls=calls)

    if calls and source.random() < 0.03:
        return source.choice(("pi", "pi/7", "pi t", "2 pi/5"))
    match kind:
        case 0:
            return str(source.choice((0, 1, 2, 3, 10, source.randrange(10**6), source.randrange(10**30))))
        case 1:
            return source.choice(NAMES)
        case 2:
            return f"{source.randrange(1000)}.{source.randrange(100)}{source.choice(('', '', 'e3', 'E-12'))}"
        case 3 | 4:
            return f"{inner()}{space}{source.choice('+-')}{space}{inner()}"
        case 5:
            return f"{inner()}{space}{source.choice(('*', '/', ' ', ''))}{space}{inner()}"
        case 6:
            return f"({inner()}){space}{source.choice(('*', '/', '', ' '))}({inner()})"
        case 7:
            return f"({inner()}){source.choice(('^', '**', ' ^ '))}{source.choice((2, 2, 2, 3, 3, -1, 0, 7, 40, 1000))}"
        case 8:
            return f"{source.choice('+-')}{inner()}"
        case 9:
            return f"{source.choice(FUNCTIONS)}({inner()})"
    return f"({inner()})"


def matrix(source: Random, *, calls: bool = True) -> str:
    """Return a matrix, seldom one with rows of different lengths."""
    columns = source.choice((1, 1, 2, 2, 3, 4))
    rows = [
        source.choice((" ", ", ", "  ")).join(
            expression(source, 2, calls=calls) for _ in range(columns + (source.random() < 0.03))
        )
        for _ in range(source.choice((1, 1, 2, 2, 3)))
    ]
    return f"[{source.choice((';', '; ', chr(10))).join(rows)}]"


def tower(source: Random) -> str:
    """Return a text that asks for much."""
    return str(source.choice(_TOWERS)(source.choice((3, 30, 99, 101, 333, 1000, 4999, 9999))))


def anything(source: Random, *, calls: bool = True) -> str:
    """Return an expression, a matrix, a text of the examples, each whole or made wrong, or no text at all."""
    match source.randrange(14):
        case 0 | 1 | 12:
            return expression(source, calls=calls)
        case 2 | 13:
            return matrix(source, calls=calls)
        case 3:
            return source.choice(corpus.expressions())
        case 4 | 5 | 6:
            return mutate.text(source, source.choice(corpus.expressions()), corpus.expressions())
        case 7:
            return mutate.text(source, expression(source), corpus.expressions())
        case 8:
            return mutate.text(source, matrix(source), corpus.expressions())
        case 9:
            return "".join(source.choices("0123456789.eEabsijI+-*/^()[],; \n\t'_=", k=source.randrange(60)))
        case 10:
            return "".join(
                chr(source.choice((source.randrange(128), source.randrange(0x110000))))
                for _ in range(source.randrange(20))
            )
    return (
        tower(source)
        if source.random() < 0.25
        else ", ".join(expression(source, 2) for _ in range(source.randrange(5)))
    )


def relation(source: Random) -> str:
    """Return a printed equation, whole or made wrong."""
    match source.randrange(8):
        case 0 | 1:
            return f"{_printed(source)} = {_printed(source)}"
        case 2:
            return source.choice(corpus.relations())
        case 3 | 4 | 5:
            return mutate.text(source, source.choice(corpus.relations()), corpus.relations())
        case 6:
            return mutate.text(source, f"{_printed(source)} = {_printed(source)}", corpus.relations())
    return tower(source) if source.random() < 0.25 else anything(source)


_LETTERS = (
    "A",
    "B",
    "C",
    "L",
    "V",
    "O",
    "x",
    "e",
    "u",
    "y",
    "x_hat",
    "x_1",
    "I",
    "0",
    "1",
    "2.5",
    "s",
    "phi_o",
    "t",
    "K",
)
_SHAPES: tuple[str, ...] = (
    "{}'",
    "-{}",
    "{}^-1",
    "{}^2",
    "det({})",
    "rank({})",
    "size({})",
    "({} + {})",
    "{} {}",
    "[{} {}]",
    "[{}; {}]",
)
_SHAPES += ("{} - {}", "{}/{}", "ctrb({}, {})", "obsv({}, {})", "eigenvalues({})", "rref({})", "place({}, {}, {})")
_SHAPES += ("adj({})", "trace({})", "Phi({}, {})", "integral({}, {}, {}, {})", "exp({})", "sqrt({})")


def _printed(source: Random, depth: int = 3) -> str:
    if depth == 0 or source.random() < 0.4:
        return source.choice(_LETTERS)
    shape = source.choice(_SHAPES)
    return shape.format(*(f"({_printed(source, depth - 1)})" for _ in range(shape.count("{}"))))
