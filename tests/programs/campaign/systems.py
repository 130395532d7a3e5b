"""Computer algebra systems as judges: each is told terms in its own language and asked whether the claims hold.

PARI and Octave are asked at rational points of the parameters, giac and Maxima with the parameters in place.  What PARI
finds is exact, or held to 90 digits; Octave computes in doubles, with its control package.
"""

from __future__ import annotations

import os
import re
import selectors
import signal
import subprocess
import tempfile
import time
from dataclasses import dataclass, field
from fractions import Fraction
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeAlias

from tests.programs.campaign.claims import CROOT, Moments, claims
from tests.programs.campaign.points import Uncovered, answer_at, general_point, points_for, texts_at
from tests.programs.campaign.terms import Sheet, Unsupported
from tests.support.algebra import Unreadable

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Mapping, Sequence

    from tests.programs.campaign.terms import Claim
    from tests.support.problems.random_problems import Tables

FOLDER = Path(__file__).parent / "systems"


@dataclass(frozen=True)
class Untold:
    """An oracle could not tell whether an answer is right: what stood in its way."""

    reason: str


#: None: the oracle agrees.  A text: where it does not, in one line.
Difference: TypeAlias = str | Untold | None

# -- one process -------------------------------------------------------------------------------------------------------


@dataclass
class Process:
    """A system that stays for the next question; one that dies or takes too long is started again."""

    command: Sequence[str]
    first: str
    running: subprocess.Popen[bytes] | None = None
    asked: int = 0

    def ask(self, question: str, seconds: float = 40) -> str | None:
        """Return what a question printed between `#number#` and `#`, without blanks; `{}` in it is the number."""
        if self.running is None:
            self.running = subprocess.Popen(
                self.command,
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE,
                stderr=subprocess.STDOUT,
                cwd=tempfile.gettempdir(),
                start_new_session=True,
            )
            question = f"{self.first}\n{question}"
        self.asked += 1
        assert self.running.stdin is not None
        try:
            self.running.stdin.write(question.replace("{}", str(self.asked)).encode() + b"\n")
            self.running.stdin.flush()
            found = self._read(self.running, re.compile(rf"#{self.asked}#([^#]*)#"), time.monotonic() + seconds)
        except BrokenPipeError:
            found = None
        if found is None:
            self.end()
        return found

    @staticmethod
    def _read(running: subprocess.Popen[bytes], answer: re.Pattern[str], until: float) -> str | None:
        assert running.stdout is not None
        text = ""
        with selectors.DefaultSelector() as selector:
            selector.register(running.stdout, selectors.EVENT_READ)
            while (left := until - time.monotonic()) > 0 and selector.select(left):
                part = os.read(running.stdout.fileno(), 65536)
                text += re.sub(r"\s", "", part.decode("utf-8", "replace"))
                if found := answer.search(text):
                    return found.group(1)
                if not part:
                    break
        return None

    def end(self) -> None:
        """End it, with what it has started itself."""
        if self.running is not None:
            with self.running:
                os.killpg(self.running.pid, signal.SIGKILL)
            self.running = None


# -- one system --------------------------------------------------------------------------------------------------------


@dataclass(frozen=True)
class System:
    """A system: how it is run, its language, and how a claim of each kind is put as a condition.

    `question` gets the conditions, each a text of assignments and a number, and the names that are assigned.
    """

    NAME: str
    process: Process
    scalar: Callable[[str], str]
    operations: Mapping[str, str]
    assigned: str
    conditions: Mapping[str, str]
    test: str
    question: str
    at_points: bool
    truth: tuple[str, str] = ("0", "1")
    skipped: frozenset[str] = field(default_factory=frozenset)

    @property
    def COMMAND(self) -> str:
        return self.process.command[0]

    def covers(self, problem: Tables) -> bool:
        """Tell whether it is asked about answers to a problem."""
        return problem["task"] not in self.skipped and (self.at_points or bool(problem["symbols"]))

    def difference(self, problem: Tables, answer: Tables) -> Difference:
        """Judge one answer; one system that disagrees with parameters in place is asked again with numbers.

        Normal forms of several variables have errors of their own: giac 1.9 adds some fractions wrongly.
        """
        if self.at_points:
            return self._at_points(problem, answer)
        said = self._asked(problem, in_general(answer))
        if isinstance(said, str):
            point = general_point(problem)
            again = self._asked({**texts_at(problem, point), "parameters": point}, texts_at(in_general(answer), point))
            return Untold(f"not equal in its normal form, equal in numbers: {said}") if again is None else said
        return said

    def _at_points(self, problem: Tables, answer: Tables) -> Difference:
        """Judge the branches of an answer at points, each with numbers in the place of the parameters."""
        untold: Difference = Untold("nothing it claims can be asked here")
        moment = {"t": Fraction(7, 10)} if problem["task"] == "matrix_exponential" else {}
        for point in points_for(problem, answer):
            where = ", ".join(f"{name} = {number}" for name, number in point.items())
            try:
                branch = answer_at(answer, point)
                if branch is None:
                    continue
                there = {**texts_at(problem, point), "symbols": {}} | ({"parameters": point} if point else {})
                said = self._asked(there, texts_at(branch, {**moment, **point}), "zero" if moment else "")
            except Uncovered as error:
                return Untold(f"the answer says nothing there: {where}: {error}")
            except (Unreadable, ZeroDivisionError):
                continue
            if isinstance(said, str):
                wrong = set(said.split(", "))
                if not where or not wrong <= IN_GENERAL.get(problem["task"], frozenset()):
                    return f"{where}: {said}" if where else said
                said = Untold(f"said of parameters in general, not true at a point: {said}")
            if said is None:
                untold = untold if isinstance(untold, Untold) and "nothing it claims" not in untold.reason else None
            else:
                untold = said
        return untold

    def _asked(self, problem: Tables, answer: Tables, left_out: str = "") -> Difference:
        try:
            found = [claim for claim in claims(problem, answer) if claim.kind != left_out]
        except Unreadable as error:
            return Untold(f"not rational: {error}")
        except (KeyError, TypeError, ValueError, AssertionError) as error:
            return Untold(f"the answer cannot be read: {error!r}")
        question = self.program(found, "z" if problem["plant"].get("dt") else "s")
        if not question:
            return Untold("nothing it claims can be asked here")
        reply = self.process.ask(question)
        if reply is None:
            return Untold("no answer in time")
        if not re.fullmatch(r"\[[\d,]*\]", reply):
            return Untold(reply[:80])
        return ", ".join(found[int(k)].name for k in re.findall(r"\d+", reply)) or None

    def program(self, found: Sequence[Claim], variable: str) -> str:
        """Return the question which of these claims fail; empty where none of them can be put."""
        sheet = Sheet(self.scalar, self.operations, self.assigned)
        tests, put = [], 0
        for k, claim in enumerate(found):
            try:
                condition = self._condition(sheet, claim, variable)
            except Unsupported:
                continue
            tests.append("".join(sheet.lines) + self.test.format(condition, k))
            sheet.lines.clear()
            put += claim.kind != "is"
        names = ",".join(sheet.names.values()) or "v0"
        return self.question.replace("NAMES", names).replace("TESTS", "".join(tests)) if put else ""

    def _condition(self, sheet: Sheet, claim: Claim, variable: str) -> str:
        if claim.kind == "is":
            return self.truth[bool(claim.data)]
        if claim.kind not in self.conditions:
            if "" not in self.conditions:
                raise Unsupported(claim.kind)
            if claim.kind == "modes":
                parts = [sheet.write(term) for term in claim.terms]
                branch, seen = claim.data
                told = f"[{','.join(_entries(branch, seen, self.scalar))}]"
                return f"modes({','.join([*parts, str(int(variable == 'z')), told])})"
        parts = [sheet.write(term) for term in claim.terms]
        arguments = [*parts, *self._data(claim.data)]
        form = self.conditions.get(claim.kind, self.conditions.get("", ""))
        return form.format(*arguments, all=",".join(arguments), kind=claim.kind.replace("_", ""), x=variable)

    def _data(self, data: Any) -> Iterator[str]:
        match data:
            case tuple():
                for entry in data:
                    yield from self._data(entry)
            case Moments(values):
                rows = (f"[{moment},Mat([{';'.join(map(self.scalar, texts))}])]" for moment, texts in values)
                yield f"[{','.join(rows)}]"
            case bool():
                yield self.truth[data]
            case "s" | "z":
                yield str(int(data == "z"))
            case str():
                yield self.scalar(data)
            case int():
                yield str(data)


def in_general(answer: Tables) -> Tables:
    """Return the answer for parameters in general position."""
    return answer | ({"verdict": "yes"} if answer["verdict"] == "conditional" else {})


#: What is said beside a verdict with parameters in general position, without the points at which it is otherwise:
#: ranks of modes where two of them meet, and what is hidden besides where a verdict is no anyhow.
IN_GENERAL = {
    **dict.fromkeys(("detectability", "stabilizability", "pbh"), frozenset({"modes"})),
    **dict.fromkeys(("state_feedback", "observer", "reduced_order_observer"), frozenset({"fixed modes"})),
    "gramian": frozenset({"rank", "kernel", "dimension of the kernel", "independent kernel"}),
}


def _entries(branch: Any, seen: str, scalar: Callable[[str], str]) -> Iterator[str]:
    """Yield the modes of a list, those without a closed form as one: polynomial, how many stable, rank, seen."""
    sets: dict[str, list[Any]] = {}
    for mode in branch.answer["modes"]:
        found = CROOT.fullmatch(mode["eigenvalue"])
        text = f"monic({scalar(found.group(1))})" if found else f"('x-{scalar(mode['eigenvalue'])})"
        sets.setdefault(text, []).append(mode)
    for text, group in sets.items():
        stable = -1 if any(mode["stable"] is None for mode in group) else sum(mode["stable"] for mode in group)
        stable = stable if text.startswith("monic") else min(stable, 1)
        yield f"[{text},{stable},{group[0]['rank']},{int(group[0][seen])}]"


# -- the languages -----------------------------------------------------------------------------------------------------


def _written(names: Mapping[str, str], text: str) -> str:
    """Return a scalar with other names for some constants."""
    if "CRootOf" in text or "RootSum" in text:
        raise Unsupported("a root without a closed form")
    return (
        "("
        + re.sub(r"\b(I|pi|Abs)\b", lambda found: names.get(found.group(), found.group()), text).replace("**", "^")
        + ")"
    )


_ROOT_SUM = re.compile(r"RootSum\(((?:[^(),]|\([^()]*\))*), Lambda\((\w+), ")


def _in_pari(text: str) -> str:
    if "CRootOf" in text:
        raise Unsupported("a root without a closed form")
    text = _ROOT_SUM.sub(lambda f: f"rootsum(subst({f.group(1)}, {f.group(2)}, 'x), ({f.group(2)} -> ", text)
    # The bracket of a Lambda closes that of its function; the variable is named behind it where there are others.
    text = re.sub(r"\), lam\)", "))", text) if "rootsum" in text else text
    text = re.sub(r"\b[sz]\b", "x", re.sub(r"\bpi\b", "Pi", text))
    return f"({text.replace('**', '^')})"


def _plain(form: str) -> dict[str, str]:
    """Return the operations whose results are brought to a form."""
    found = {"plus": "{0}+{1}", "minus": "{0}-{1}", "times": "{0}*{1}", "dot": "{0}*{1}"}
    return {name: form.replace("X", text) for name, text in found.items()}


PARI = System(
    "PARI",
    Process(("gp", "-q", "-f", "-s", "400M"), f'read("{FOLDER / "pari.gp"}");'),
    _in_pari,
    {
        **_plain("(X)"),
        "matrix": "Mat([{rows}])",
        "row": "{}|;",
        "transpose": "({0}~)",
        "inverse": "({0}^-1)",
        "determinant": "matdet({0})",
        "entry": "{0}[{i1},{j1}]",
        "block": "{0}[{top1}..{bottom},{left1}..{right}]",
        "stack": "matconcat([{semicolons}])",
        "beside": "matconcat([{commas}])",
        "derivative": "deriv({0},'{name})",
        "at": "subst({0},x,{value})",
        "monic": "monic({text})",
    },
    "my({0}={1});",
    {"zero": "zero({0})", "rank": "(matrank({0})=={1})", "": "{kind}({all})"},
    "if(!{0},listput(w,{1}));",
    'f()=my(w=List());TESTSVec(w);\nprint("#{}#",iferr(alarm(20,f()),E,Str("error ",E)),"#");',
    at_points=True,
)
#: Tasks whose claims are not identities.
_NOT_SYMBOLIC = frozenset({"stability_region", "initial_state", "initial_state_covariance"})
GIAC = System(
    "giac",
    Process(("giac",), f'read("{FOLDER / "giac.txt"}"):;'),
    lambda text: _written({"I": "i", "Abs": "abs"}, text),
    {
        **_plain("normal(X)"),
        "matrix": "[{rows}]",
        "row": "[{}]|,",
        "transpose": "tran({0})",
        "inverse": "normal(inv({0}))",
        "determinant": "normal(det({0}))",
        "entry": "{0}[{i},{j}]",
        "block": "subMat({0},{top},{left},{last},{edge})",
        "stack": "blockmatrix({count},1,[{commas}])",
        "beside": "blockmatrix(1,{count},[{commas}])",
        "derivative": "diff({0},{name})",
        "at": "subst({0},{name}={value})",
    },
    "{0}:={1};",
    {
        "zero": "zero_({0})",
        "rank": "(rank({0})=={1})",
        "hidden": "zero_(hidden_({0},{1},{x})-{2})",
        "trivial": "(zero_({0}-1)=={1})",
        "full": "(when(rank({0})=={1},1,0)=={2})",
        "ackermann": "ackermann_({0},{1},{2},{3},{x})",
        "divides": "divides_({0},{1},{2},{x},{3})",
    },
    "if (!{0}) {{ w_:=append(w_,{1}); }}",
    'f_():={ local w_,NAMES; w_:=[]; TESTS return w_; }:;\ntry { r_:=f_(); } catch (e_) { r_:="error"; }:;\n'
    'print(hash_+"{}"+hash_+string(r_)+hash_):;',
    at_points=False,
    skipped=_NOT_SYMBOLIC,
)
MAXIMA = System(
    "Maxima",
    Process(("maxima", "--very-quiet"), f'load("{FOLDER / "maxima.mac"}")$'),
    lambda text: _written({"I": "%i", "pi": "%pi", "Abs": "abs"}, text),
    {
        **_plain("plain_(X)"),
        "dot": "plain_({0}.{1})",
        "matrix": "matrix({rows})",
        "row": "[{}]|,",
        "transpose": "transpose({0})",
        "inverse": "plain_(invert({0}))",
        "determinant": "plain_(determinant({0}))",
        "entry": "{0}[{i1},{j1}]",
        "block": "block_({0},{top},{left},{high},{wide})",
        "stack": "addrow({commas})",
        "beside": "addcol({commas})",
        "derivative": "diff({0},{name})",
        "at": "subst({value},{name},{0})",
    },
    "{0}:{1},",
    {
        "zero": "zero_({0})",
        "rank": "is(rank({0})={1})",
        "trivial": "is(zero_({0}-1)={1})",
        "full": "is(is(rank({0})={1})={2})",
        "ackermann": "ackermann_({0},{1},{2},{3},{x})",
    },
    "if not {0} then w_:endcons({1},w_),",
    'f_():=block([w_:[],NAMES],TESTSw_)$\nr_:errcatch(f_())$\nprint("#",{},"#",if r_=[] then "error" else r_[1],"#")$',
    at_points=False,
    truth=("false", "true"),
    skipped=_NOT_SYMBOLIC,
)
OCTAVE = System(
    "Octave",
    Process(("octave-cli", "--norc", "--no-history", "--quiet"), f'source("{FOLDER / "octave.m"}");'),
    lambda text: _written({"I": "1i", "Abs": "abs"}, text),
    {
        **_plain("(X)"),
        "matrix": "[{rows}]",
        "row": "{}|;",
        "transpose": "({0}.')",
        "inverse": "inv({0})",
        "determinant": "det({0})",
        "entry": "{0}({i1},{j1})",
        "block": "{0}({top1}:{bottom},{left1}:{right})",
        "stack": "[{semicolons}]",
        "beside": "[{commas}]",
    },
    "{0}=keep_({1});",
    {
        "zero": "zero_({0})",
        "rank": "(rank_({0})=={1})",
        "hidden": "zero_(hidden_({0},{1})-{2})",
        "trivial": "(zero_({0}-1)=={1})",
        "full": "((rank_({0})=={1})=={2})",
        "contains": "((rank_({0})==rank_([{0},{1}]))=={2})",
        "exponential": "zero_({1}-keep_(expm(({0})*0.7)))",
        "is_gramian": "zero_({2}-keep_(gramian_({0},{1},{3})))",
        "is_steps": "zero_({2}-keep_(steps_({0},{1},{3})))",
        "stable_transfer": "(stable_({0},{1},{2},{3})=={4})",
    },
    "if !{0}, w_(end+1)={1}; end;",
    'begin_(); try, w_=[]; TESTS printf("#{}#[%s]#\\n",sprintf("%d,",w_)); catch e_, printf("#{}#error#\\n"); end; '
    "fflush(stdout);",
    at_points=True,
    skipped=frozenset({"stability_region", "initial_state", "initial_state_covariance", "time_varying_observability"}),
)
SYSTEMS = (PARI, GIAC, MAXIMA, OCTAVE)
