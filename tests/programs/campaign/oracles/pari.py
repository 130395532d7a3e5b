"""PARI/GP: every task, with numbers in place of parameters, and identities with the parameters themselves.

Rational work is exact there; what is not rational is held to 90 digits.
"""

from __future__ import annotations

import re
from fractions import Fraction
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Any

from tests.programs.campaign.asked import Untold
from tests.programs.campaign.branch import CROOT, Moments
from tests.programs.campaign.claims import claims
from tests.programs.campaign.points import NotRational, Uncovered, answer_at, points_for, texts_at
from tests.programs.campaign.running import System, answers
from tests.programs.campaign.writing import Language, Sheet, Unsupported

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from tests.programs.campaign.algebra import Claim, Term
    from tests.programs.campaign.asked import Asked, Difference, Tables

NAME = "PARI"
COMMAND = "gp"

_PREAMBLE = (Path(__file__).parents[1] / "systems" / "pari.gp").read_text(encoding="utf-8")
_GP = System(("gp", "-q", "-f", "-s", "400M"), _PREAMBLE)
#: Functions of time are looked at in one moment, the same as in the preamble.
_MOMENT = {"matrix_exponential": {"t": Fraction(7, 10)}}
_VARIABLE = re.compile(r"\b[sz]\b")
_ROOT_SUM = re.compile(r"RootSum\(((?:[^(),]|\([^()]*\))*), Lambda\((\w+), ")


def covers(problem: Tables) -> bool:
    """Every task."""
    return "task" in problem


# -- the language ------------------------------------------------------------------------------------------------------


@cache
def _scalar(text: str) -> str:
    if text.lstrip("-").isdigit():
        return text if text.isdigit() else f"({text})"
    if "CRootOf" in text:
        raise Unsupported("a root without a closed form")
    text = _ROOT_SUM.sub(
        lambda found: f"rootsum(subst({found.group(1)}, {found.group(2)}, 'x), ({found.group(2)} -> ", text
    )
    # The bracket of a Lambda closes that of its function; the variable is named behind it where there are others.
    text = re.sub(r"\), lam\)", "))", text) if "rootsum" in text else text
    text = re.sub(r"\bpi\b", "Pi", text)
    return f"({_VARIABLE.sub('x', text).replace('**', '^')})"


def _matrix(table: list[list[str]]) -> str:
    # One row between brackets would be a vector.
    text = f"[{';'.join(','.join(row) for row in table)}]"
    return f"Mat({text})" if len(table) == 1 else text


def _range(part: range) -> str:
    return f"{part.start + 1}..{part.stop}"


def _block(term: Term, parts: list[str]) -> str:
    return f"{parts[0]}[{_range(term.parts[1])},{_range(term.parts[2])}]"


_LANGUAGE = Language(
    scalar=_scalar,
    matrix=_matrix,
    operations={
        "plus": lambda _, parts: f"({parts[0]}+{parts[1]})",
        "minus": lambda _, parts: f"({parts[0]}-{parts[1]})",
        "times": lambda _, parts: f"({parts[0]}*{parts[1]})",
        "over": lambda _, parts: f"({parts[0]}/{parts[1]})",
        "dot": lambda _, parts: f"({parts[0]}*{parts[1]})",
        "transpose": lambda _, parts: f"({parts[0]}~)",
        "inverse": lambda _, parts: f"({parts[0]}^-1)",
        "determinant": lambda _, parts: f"matdet({parts[0]})",
        "entry": lambda term, parts: f"{parts[0]}[{term.parts[1] + 1},{term.parts[2] + 1}]",
        "block": _block,
        "stack": lambda _, parts: f"matconcat([{';'.join(parts)}])",
        "beside": lambda _, parts: f"matconcat([{','.join(parts)}])",
        "derivative": lambda term, parts: f"deriv({parts[0]},'{term.parts[1]})",
        "at": lambda term, parts: f"subst({parts[0]},{_VARIABLE.sub('x', term.parts[1])},{term.parts[2]})",
        "monic": lambda _, parts: f"monic({parts[0]})",
    },
    assigned=lambda name, text: f"my({name}={text});",
)

#: Questions whose function takes the terms, the data after them.
_FUNCTIONS = {
    "hidden": "hidden",
    "radical": "radical",
    "trivial": "trivial",
    "bounded": "bounded",
    "hurwitz": "hurwitz",
    "full": "full",
    "divides": "divides",
    "ackermann": "ackermann",
    "separation": "separation",
    "unit_gain": "unitgain",
    "contains": "contains",
    "decays": "decays",
    "exponential": "exponential",
    "gramian": "isgramian",
    "steps": "issteps",
    "poles_and_zeros": "polesandzeros",
    "plant_zero": "isplantzero",
    "on_circle": "oncircle",
    "explains": "explains",
    "unexplained": "unexplained",
    "output_part": "outputpart",
    "input_part": "inputpart",
    "stable_transfer": "stabletransfer",
}


def _judged(sheet: Sheet, claim: Claim) -> str:
    """Return the condition under which a claim holds."""
    match claim.kind:
        case "never":
            return "0"
        case "is":
            return str(int(claim.data))
        case "modes":
            A, C = (sheet.write(term) for term in claim.terms)
            branch, seen = claim.data
            discrete = int(branch.variable == "z")
            return f"modes({A},{C},{discrete},[{','.join(_entries(branch, seen))}])"
    parts = [sheet.write(term) for term in claim.terms]
    match claim.kind:
        case "zero":
            return f"zero({parts[0]})"
        case "rank":
            return f"(matrank({parts[0]})=={claim.data})"
    function = _FUNCTIONS.get(claim.kind)
    if function is None:
        raise Unsupported(claim.kind)
    return f"{function}({','.join([*parts, *_data(claim.data)])})"


def _data(data: Any) -> Iterator[str]:
    if isinstance(data, tuple):
        for entry in data:
            yield from _data(entry)
    elif isinstance(data, Moments):
        moments = (f"[{moment},{_matrix([[_scalar(text)] for text in texts])}]" for moment, texts in data.values)
        yield f"[{','.join(moments)}]"
    elif isinstance(data, bool):
        yield str(int(data))
    elif isinstance(data, str) and data in {"s", "z"}:
        yield str(int(data == "z"))
    elif isinstance(data, str):
        yield _scalar(data)
    elif data is not None:
        yield str(data)


def _entries(branch: Any, seen: str) -> Iterator[str]:
    """Yield the modes of a list, those without a closed form as one: polynomial, how many stable, rank, seen."""
    sets: dict[str, list[Any]] = {}
    for mode in branch.answer["modes"]:
        found = CROOT.fullmatch(mode["eigenvalue"])
        text = f"monic({_scalar(found.group(1))})" if found else f"('x-{_scalar(mode['eigenvalue'])})"
        sets.setdefault(text, []).append(mode)
    for text, group in sets.items():
        stable = -1 if any(mode["stable"] is None for mode in group) else sum(mode["stable"] for mode in group)
        if not text.startswith("monic"):
            stable = min(stable, 1)
        yield f"[{text},{stable},{group[0]['rank']},{int(group[0][seen])}]"


# -- judging -----------------------------------------------------------------------------------------------------------


def _question(found: Sequence[Claim]) -> tuple[str, list[str]]:
    """Return the program that answers with the numbers of the claims that fail, and what was left out."""
    sheet, tests, left = Sheet(_LANGUAGE), [], []
    for k, claim in enumerate(found):
        try:
            judged = _judged(sheet, claim)
        except Unsupported as error:
            left.append(f"{claim.name}: {error}")
            continue
        tests.append("".join([*sheet.lines, f"if(!{judged},listput(w,{k}));"]))
        sheet.lines.clear()
    body = f"f()={{my(w=List());{''.join(tests)}Vec(w)}}"
    return f'{body};\nprint("#{{}}#",iferr(alarm(20,f()),E,Str("error ",E)),"#");', left


def _posed(asked: Asked) -> Iterator[tuple[str, list[Claim]]]:
    """Yield where a branch is looked at, and its claims there."""
    for point in points_for(asked):
        where = ", ".join(f"{name} = {number}" for name, number in point.items())
        try:
            branch, moment = answer_at(asked.answer, point), _MOMENT.get(asked.task, {})
            if branch is None:
                continue
            problem = {**texts_at(asked.problem, point), "symbols": {}} | ({"parameters": point} if point else {})
            found = claims(problem, texts_at(branch, {**moment, **point}))
            if moment:
                found = [claim for claim in found if claim.kind != "zero"]
        except Uncovered as error:
            raise Uncovered(f"{where}: {error}") from error
        except (NotRational, ZeroDivisionError):
            continue
        yield where, found


#: What is said beside a verdict with parameters in general position, without the points at which it is otherwise:
#: ranks of modes where two of them meet, and what is hidden besides where a verdict is no anyhow.
_IN_GENERAL = {
    **dict.fromkeys(("detectability", "stabilizability", "pbh"), frozenset({"modes"})),
    **dict.fromkeys(("state_feedback", "observer", "reduced_order_observer"), frozenset({"fixed modes"})),
    "gramian": frozenset({"rank", "kernel", "dimension of the kernel", "independent kernel"}),
}


def differences(batch: Sequence[Asked]) -> list[Difference]:
    """Judge a batch in one process."""
    posed: list[tuple[int, str, list[Claim], str]] = []
    judged: list[Difference] = [Untold("nothing it claims can be asked here")] * len(batch)
    for index, asked in enumerate(batch):
        try:
            for where, found in _posed(asked):
                program, _left = _question(found)
                if found and "if(!" in program:
                    posed.append((index, where, found, program))
        except (KeyError, TypeError, ValueError, AssertionError) as error:
            judged[index] = Untold(f"the answer cannot be read: {error!r}")
        except Uncovered as error:
            judged[index] = Untold(f"the answer says nothing there: {error}")
    replies = answers(_GP, [program for *_, program in posed], 40)
    for (index, where, found, _), reply in zip(posed, replies, strict=True):
        if isinstance(judged[index], str):
            continue
        if reply == "[]":
            judged[index] = None if not _untold(judged[index]) else judged[index]
        elif reply is None or reply.startswith("error"):
            judged[index] = Untold(f"{where} {reply or 'no answer in time'}".strip())
        else:
            wrong = [found[int(k)].name for k in re.findall(r"\d+", reply)]
            if where and set(wrong) <= _IN_GENERAL.get(batch[index].task, frozenset()):
                judged[index] = Untold(f"said of parameters in general, not true at a point: {', '.join(wrong)}")
            else:
                judged[index] = f"{where + ': ' if where else ''}{', '.join(wrong)}"
    return judged


def _untold(judgement: Difference) -> bool:
    """Tell whether a judgement already says that something failed to be told, beside having nothing to ask yet."""
    return isinstance(judgement, Untold) and not judgement.reason.startswith("nothing it claims")
