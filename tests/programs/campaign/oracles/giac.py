"""giac: answers with their parameters in place, hidden modes by reduced row echelon forms, gains by Ackermann's formula."""

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

    from tests.programs.campaign.algebra import Claim
    from tests.programs.campaign.asked import Asked, Difference, Tables

NAME = "giac"
COMMAND = "giac"

_IMAGINARY = re.compile(r"\bI\b")
_PREAMBLE = (Path(__file__).parents[1] / "systems" / "giac.txt").read_text(encoding="utf-8")


def covers(problem: Tables) -> bool:
    """Tell whether the answer is a matter of identities; of those in numbers alone every fourth is taken."""
    if problem["task"] in NOT_SYMBOLIC:
        return False
    return bool(problem["symbols"]) or crc32(to_toml(problem).encode()) % 4 == 0


@cache
def _scalar(text: str) -> str:
    if "CRootOf" in text or "RootSum" in text:
        raise Unsupported("a root without a closed form")
    written = _IMAGINARY.sub("i", text).replace("**", "^")
    return f"({written})"


def _matrix(table: list[list[str]]) -> str:
    return f"[{','.join('[' + ','.join(row) + ']' for row in table)}]"


_LANGUAGE = Language(
    scalar=_scalar,
    matrix=_matrix,
    operations={
        "plus": lambda _, parts: f"normal({parts[0]}+{parts[1]})",
        "minus": lambda _, parts: f"normal({parts[0]}-{parts[1]})",
        "times": lambda _, parts: f"normal({parts[0]}*{parts[1]})",
        "over": lambda _, parts: f"normal({parts[0]}/{parts[1]})",
        "dot": lambda _, parts: f"normal({parts[0]}*{parts[1]})",
        "transpose": lambda _, parts: f"tran({parts[0]})",
        "inverse": lambda _, parts: f"normal(inv({parts[0]}))",
        "determinant": lambda _, parts: f"normal(det({parts[0]}))",
        "entry": lambda term, parts: f"{parts[0]}[{term.parts[1]},{term.parts[2]}]",
        "block": lambda term, parts: (
            f"subMat({parts[0]},{term.parts[1].start},{term.parts[2].start},{term.parts[1].stop - 1},{term.parts[2].stop - 1})"
        ),
        "stack": lambda _, parts: f"blockmatrix({len(parts)},1,[{','.join(parts)}])",
        "beside": lambda _, parts: f"blockmatrix(1,{len(parts)},[{','.join(parts)}])",
        "derivative": lambda term, parts: f"diff({parts[0]},{term.parts[1]})",
        "at": lambda term, parts: f"subst({parts[0]},{term.parts[1]}={term.parts[2]})",
    },
    assigned=lambda name, text: f"{name}:={text};",
)


def _condition(claim: Claim, parts: list[str], variable: str) -> str:
    match claim.kind:
        case "never":
            return "0"
        case "is":
            return str(int(claim.data))
        case "zero":
            return f"zero_({parts[0]})"
        case "rank":
            return f"(rank({parts[0]})=={claim.data})"
        case "hidden":
            return f"zero_(hidden_({parts[0]},{parts[1]},{variable})-{parts[2]})"
        case "trivial":
            return f"(zero_({parts[0]}-1)=={int(claim.data)})"
        case "full":
            return f"(when(rank({parts[0]})=={claim.data[0]},1,0)=={int(claim.data[1])})"
        case "ackermann":
            return f"ackermann_({','.join(parts)},{variable})"
        case "divides":
            return f"divides_({','.join(parts)},{variable},{int(claim.data)})"
    raise Unsupported(claim.kind)


def _question(tests: Sequence[tuple[list[str], str, int]]) -> str:
    body = "".join("".join([*lines, f"if (!{condition}) {{ w_:=append(w_,{k}); }}"]) for lines, condition, k in tests)
    names = ",".join(dict.fromkeys(re.findall(r"\bv\d+\b", body))) or "v0"
    return (
        f"f_():={{ local w_,{names}; w_:=[]; {body} return w_; }}:;\n"
        'try { r_:=f_(); } catch (e_) { r_:="error"; }:;\nprint(hash_+"{}"+hash_+string(r_)+hash_):;'
    )


_JUDGE = Judge(System(("giac",), _PREAMBLE, by_file=True), _LANGUAGE, _condition, _question)


def differences(batch: Sequence[Asked]) -> list[Difference]:
    """Judge a batch in one process."""
    return _JUDGE.differences(batch)
