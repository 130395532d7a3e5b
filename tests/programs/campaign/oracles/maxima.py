"""Maxima: answers with their parameters in place, gains by Ackermann's formula."""

from __future__ import annotations

import re
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING
from zlib import crc32

from tests.programs.campaign.asked import to_toml
from tests.programs.campaign.running import System
from tests.programs.campaign.symbolic import NOT_SYMBOLIC, Judge
from tests.programs.campaign.writing import Language, Unsupported

if TYPE_CHECKING:
    from collections.abc import Sequence

    from tests.programs.campaign.algebra import Claim, Term
    from tests.programs.campaign.asked import Asked, Difference, Tables

NAME = "Maxima"
COMMAND = "maxima"

_PREAMBLE = (Path(__file__).parents[1] / "systems" / "maxima.mac").read_text(encoding="utf-8")
_CONSTANTS = re.compile(r"\b(I|pi)\b")


def covers(problem: Tables) -> bool:
    """Tell whether the answer is a matter of identities; of those in numbers alone every eighth is taken."""
    if problem["task"] in NOT_SYMBOLIC:
        return False
    return bool(problem["symbols"]) or crc32(to_toml(problem).encode()) % 8 == 1


@cache
def _scalar(text: str) -> str:
    if "CRootOf" in text or "RootSum" in text:
        raise Unsupported("a root without a closed form")
    written = _CONSTANTS.sub(lambda found: {"I": "%i", "pi": "%pi"}[found.group()], text).replace("**", "^")
    return f"({written})"


def _matrix(table: list[list[str]]) -> str:
    return f"matrix({','.join('[' + ','.join(row) + ']' for row in table)})"


def _block(term: Term, parts: list[str]) -> str:
    across, down = term.parts[1], term.parts[2]
    return f"block_({parts[0]},{across.start},{down.start},{len(across)},{len(down)})"


_LANGUAGE = Language(
    scalar=_scalar,
    matrix=_matrix,
    operations={
        "plus": lambda _, parts: f"plain_({parts[0]}+{parts[1]})",
        "minus": lambda _, parts: f"plain_({parts[0]}-{parts[1]})",
        "times": lambda _, parts: f"plain_({parts[0]}*{parts[1]})",
        "over": lambda _, parts: f"plain_({parts[0]}/{parts[1]})",
        "dot": lambda _, parts: f"plain_({parts[0]}.{parts[1]})",
        "transpose": lambda _, parts: f"transpose({parts[0]})",
        "inverse": lambda _, parts: f"plain_(invert({parts[0]}))",
        "determinant": lambda _, parts: f"plain_(determinant({parts[0]}))",
        "entry": lambda term, parts: f"{parts[0]}[{term.parts[1] + 1},{term.parts[2] + 1}]",
        "block": _block,
        "stack": lambda _, parts: f"addrow({','.join(parts)})",
        "beside": lambda _, parts: f"addcol({','.join(parts)})",
        "derivative": lambda term, parts: f"diff({parts[0]},{term.parts[1]})",
        "at": lambda term, parts: f"subst({term.parts[2]},{term.parts[1]},{parts[0]})",
    },
    assigned=lambda name, text: f"{name}:{text},",
)


def _condition(claim: Claim, parts: list[str], variable: str) -> str:
    match claim.kind:
        case "never":
            return "false"
        case "is":
            return str(bool(claim.data)).lower()
        case "zero":
            return f"zero_({parts[0]})"
        case "rank":
            return f"is(rank({parts[0]})={claim.data})"
        case "trivial":
            return f"is(zero_({parts[0]}-1)={str(claim.data).lower()})"
        case "full":
            return f"is(is(rank({parts[0]})={claim.data[0]})={str(claim.data[1]).lower()})"
        case "ackermann":
            return f"ackermann_({','.join(parts)},{variable})"
    raise Unsupported(claim.kind)


def _question(tests: Sequence[tuple[list[str], str, int]]) -> str:
    body = "".join("".join([*lines, f"if not {condition} then w_:endcons({k},w_),"]) for lines, condition, k in tests)
    names = ",".join(dict.fromkeys(re.findall(r"\bv\d+\b", body)))
    return (
        f"f_():=block([w_:[]{',' if names else ''}{names}],{body}w_)$\n"
        'r_:errcatch(f_())$\nprint("#",{},"#",if r_=[] then "error" else r_[1],"#")$'
    )


_JUDGE = Judge(System(("maxima", "--very-quiet"), _PREAMBLE), _LANGUAGE, _condition, _question)


def differences(batch: Sequence[Asked]) -> list[Difference]:
    """Judge a batch in one process."""
    return _JUDGE.differences(batch)
