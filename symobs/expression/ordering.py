"""Second step: the order of computation.  Tokens become postfix steps, operands first, by precedence alone.

    sum     product, then + or - and a product, from the left
    product signed, then * or / and a signed, from the left
    signed  ± signed, or an atom, or atom ^ signed: -2^2 is -(2^2), 2^-1 is 1/2, and powers associate to the right
    atom    a value, (sum), f(sum), or [row; row; …] with a row of sums set apart by commas

A parser generator reads this grammar too, but takes longer to be made than the command line has for a whole page.
Nothing recurses: a text may hold a thousand signs in a row.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from symobs.expression.source import shown

if TYPE_CHECKING:
    from collections.abc import Sequence

    from symobs.errors import InputError
    from symobs.expression.source import Source
    from symobs.expression.tokens import Token

_BINDING = {"ADD": 1, "MULTIPLY": 2, "sign": 3, "POWER": 4}
_OPERAND_STARTS = ("VALUE", "FUNCTION", "_OPEN", "LEFT")


class Step(NamedTuple):
    """One step on the stack of operands: `VALUE` puts one there, the others take theirs and put the result.

    `sign`, `ADD`, `MULTIPLY`, `POWER` and `FUNCTION` are operations; `LEFT` makes a matrix of rows as long as `rows` says.
    """

    kind: str
    token: Token
    rows: tuple[int, ...] = ()


def postfix(tokens: Sequence[Token], source: Source) -> list[Step]:
    """Return the steps that compute the tokens, and leave the text's entries on the stack; raises ExpressionError.

    Brackets are matched already, and between two operands there is an operator or a comma (`tokens`).
    """
    steps: list[Step] = []
    waiting: list[Step] = []  # operators whose right operand is not complete, and brackets still open
    lengths = [[1]]  # how many entries each row has so far, for the whole text and for every [ still open
    operand = False  # whether one has just ended
    for token in tokens:
        kind = token.type
        begins = kind in _OPERAND_STARTS or (kind == "ADD" and not operand)
        if begins is operand:
            raise _unexpected(token, source)
        match kind:
            case "VALUE":
                steps.append(Step(kind, token))
            case "FUNCTION" | "_OPEN" | "LEFT":
                waiting.append(Step(kind, token))
                if kind == "LEFT":
                    lengths.append([1])
            case "ADD" | "MULTIPLY" | "POWER":
                if operand:
                    _complete(steps, waiting, _BINDING[kind] + (kind == "POWER"))
                waiting.append(Step(kind if operand else "sign", token))
            case _:
                _complete(steps, waiting)
                _close(kind, steps, waiting, lengths)
        operand = kind in ("VALUE", "_CLOSE", "_RIGHT")
    if not operand:
        raise _unexpected(None, source)
    _complete(steps, waiting)
    return steps


def _complete(steps: list[Step], waiting: list[Step], binding: int = 0) -> None:
    """Write the operators, back to the last open bracket, that bind at least as strongly as the one that comes."""
    while waiting and _BINDING.get(waiting[-1].kind, -1) >= binding:
        steps.append(waiting.pop())


def _close(kind: str, steps: list[Step], waiting: list[Step], lengths: list[list[int]]) -> None:
    """Take what ends an entry: a comma, the end of a row, a closing bracket."""
    if kind == "_COMMA":
        lengths[-1][-1] += 1
    elif kind == "_END":
        lengths[-1].append(1)
    elif kind == "_RIGHT":
        steps.append(Step("LEFT", waiting.pop().token, tuple(lengths.pop())))
    else:
        waiting.pop()
        if waiting and waiting[-1].kind == "FUNCTION":
            steps.append(waiting.pop())


def _unexpected(token: Token | None, source: Source) -> InputError:
    place = "at the end" if token is None else f'before "{shown(token)}"'
    position = len(source.text) if token is None else token.start
    return source.error(f'a number, a name or "(" is expected {place}', position, "write one there")
