"""One place each: a method, a task and an output format are each one new file, found by the command line at once."""

from __future__ import annotations

import json
import shutil
import subprocess
import sys
from typing import TYPE_CHECKING

import pytest

from tests.support.claims.claims import HOLDS
from tests.support.paths import ROOT
from tests.support.tools.command_line import Run, environment, fresh

if TYPE_CHECKING:
    from pathlib import Path

pytestmark = pytest.mark.slow

METHOD = '''
"""A second way to a gain."""

from symobs.tasks.design.full_order.observer import ObserverDesign
from symobs.tasks.result import method
from symobs.system.specification import DesiredPolynomial
from symobs.system import StateSpace


@method("observer/dummy", source="nobody, Theorem 0")
def dummy(plant: StateSpace, desired: DesiredPolynomial) -> ObserverDesign:
    """Take what Ackermann's formula gives."""
    return ObserverDesign.of(plant, desired, "dummy")
'''

LIAR = METHOD.replace(
    'return ObserverDesign.of(plant, desired, "dummy")',
    'right = ObserverDesign.of(plant, desired, "dummy")\n'
    '    return right.with_answer("L", right.answer["L"] + right.answer["L"])',
)

TASK = '''
"""A task that asks what another answers."""

from __future__ import annotations

from symobs.tasks.analysis.rank.observability import Observability
from symobs.tasks.result import Result, method, task
from symobs.system.specification import Name, Poles
from symobs.system import StateSpace


@method("dummy_task/direct", source="nobody, Theorem 1")
def direct(plant: StateSpace) -> Observability:
    """Look at the rank."""
    return Observability.of(plant, "direct")


@task
def dummy_task(plant: StateSpace, *, dummy_poles: Poles = None, method: Name = "auto") -> Result:
    """Decide what nobody asked."""
    plant.require("C", task="dummy_task")
    return direct(plant)
'''

FORMAT = '''
"""A format for the hurried."""

from typing import ClassVar

from symobs.tasks.result import Document
from symobs.tasks.result import output_format


@output_format
class Dummy:
    """One line a result."""

    name: ClassVar[str] = "dummy"
    suffix: ClassVar[str] = ".dum"

    def render(self, document: Document) -> str:
        """Return task, method and verdict of every result."""
        return "".join(f"{result.task} {result.method} {result.verdict}\\n" for result in document.results)
'''

#: A task in a folder of its own: what the result is, its page, its phrases with question, theorem and figure, an example;
#: and the words of the other language, and what checks its claims without symobs, each a file found by its name.
FOLDER = "symobs/tasks/analysis/trace"

TRACE = '''
"""The trace of A."""

from __future__ import annotations

from typing import TYPE_CHECKING, ClassVar, TypedDict

from symobs.ground.dataclass import dataclass
from symobs.proof.certificate.claims import Claim
from symobs.proof.derivation.builder import relation
from symobs.exact import Matrix
from symobs.formula.tree import Environment
from symobs.formula.tree.term import letter
from symobs.tasks.result import Result, choose, method, task

if TYPE_CHECKING:
    from collections.abc import Iterator

    from symobs.system.specification import Name
    from symobs.system import StateSpace


class TraceAnswer(TypedDict):
    """M."""

    M: Matrix


@dataclass
class Trace(Result):
    """A matrix M with M = A."""

    answer: TraceAnswer
    task: ClassVar[str] = "trace"

    def claims(self) -> Iterator[Claim]:
        """Yield M = A."""
        e = Environment(values={"A": self.plant.matrices.A, "M": self.answer["M"]})
        yield Claim(relation(letter("M", e), letter("A", e)), e)


@method("trace/direct", source="kalman1963a")
def direct(plant: StateSpace) -> Trace:
    """Look at it."""
    return Trace(plant, "direct", {"M": plant.matrices.A})


@task
def trace(plant: StateSpace, *, method: Name = "auto") -> Trace:
    """Find what is on the diagonal.

    plant         A with n states
    Returns M with M = A.  Raises `InputError` for an unknown method.
    Source: R. E. Kalman (1963).
    """
    return choose("trace", method, "direct").solve(plant)
'''

TRACE_PAGE = '''
"""The page of the trace."""

from __future__ import annotations

from typing import TYPE_CHECKING

from symobs.tasks.analysis.page_parts import given
from symobs.tasks.analysis.trace.trace import Trace
from symobs.tasks.result import page_of

if TYPE_CHECKING:
    from symobs.proof.derivation.builder import Builder


@page_of(Trace)
def write_trace(page: Builder, result: Trace) -> None:
    """Draw the plant and say what stands on its diagonal."""
    given(page)
    with page.section("trace"):
        if not page.plant.matrices.has_input:
            page.diagram("free_motion", say="trace_drawn", A=page["A"])
        page.define("M", page["A"], say="trace_is", answer=True)
'''

TRACE_PHRASES = '''
"""The trace of a matrix."""

from __future__ import annotations

PHRASES: dict[str, str] = {
    "trace": "The diagonal.",
    "trace_drawn": "The plant left alone moves as follows.",
    "trace_is": "Its diagonal is that of",
}

QUESTIONS: dict[str, str] = {"ask trace": "What stands on the diagonal of $A$?"}

RESTS_ON: dict[str, str] = {"trace_is": "trace_theorem"}

THEOREMS: dict[str, str] = {"trace_theorem": "kalman1963a"}

FIGURES: dict[str, dict[str, object]] = {
    "free_motion": {
        "grid": """
        j  ∫x  a  x
        .  A   .  .
        """,
        "routes": ("j > ∫x > a > x", "a |- A -| j"),
        "signals": {"x": "x"},
    },
}
'''

TRACE_IN_GERMAN = """
trace = "Die Diagonale."
trace_drawn = "Sich selbst überlassen bewegt sich die Strecke wie folgt."
trace_is = "Ihre Diagonale ist die von"
"ask trace" = "Was steht auf der Diagonale von $A$?"
"""

TRACE_CLAIMS = '''
"""The matrix is A."""

from typing import Any

from tests.support.algebra import matrix_at


def holds(result: Any, at: Any) -> None:
    """Check M = A at a point."""
    assert matrix_at(result.answer["M"], at.point) == at.A
'''

TRACE_EXAMPLE = """
title = "A diagonal"
source = "nobody, Exercise 1"
task = "trace"
[plant]
A = "[0 1; 0 -1]"
C = "[1 0]"
[expect]
M = "[0 1; 0 -1]"
"""

PROBLEM = """
task = "observer"
[plant]
A = "[0 1; 0 -1]"
C = "[1 0]"
[specification]
poles = [-10, -10]
"""


class Copy:
    """A copy of the checkout, to which files are added, and a folder to run it in."""

    def __init__(self, folder: Path) -> None:
        self.checkout, self.folder = folder / "checkout", folder / "elsewhere"
        self.folder.mkdir(parents=True)
        for part in ("symobs", "latex_templates", "worked_examples", "tests", "pyproject.toml"):
            if (ROOT / part).is_file():
                shutil.copy(ROOT / part, self.checkout / part)
                continue
            shutil.copytree(ROOT / part, self.checkout / part, ignore=shutil.ignore_patterns("__pycache__"))

    def add(self, path: str, text: str) -> None:
        assert not (self.checkout / path).exists()
        (self.checkout / path).parent.mkdir(exist_ok=True)
        (self.checkout / path).write_text(text.lstrip(), "utf-8")

    def run(self, *arguments: str, stdin: str = "") -> Run:
        return fresh(*arguments, folder=self.folder, checkout=self.checkout, stdin=stdin.encode())

    def kept(self, which: str, *further: str) -> str:
        """Run the contract tests of a task in the copy, or further ones; return what they print."""
        files = [f"tests/contracts/{name}.py" for name in ("test_phrases", "test_floors", *further)]
        arguments = [*files, "-k", which, "-q", "-p", "no:cacheprovider"]
        run = subprocess.run(
            [sys.executable, "-m", "pytest", *arguments],
            cwd=self.checkout,
            env=environment(self.checkout),
            capture_output=True,
            text=True,
            check=False,
        )
        return run.stdout


@pytest.fixture(name="copy")
def copied(tmp_path: Path) -> Copy:
    return Copy(tmp_path)


def test_a_method_is_one_new_file(copy: Copy) -> None:
    assert "dummy" not in copy.run("methods").out
    refused = copy.run("solve", "-", stdin=f'{PROBLEM}method = "dummy"\n')
    assert refused.code == 3
    assert "specification.method: 'dummy' is not a method of observer" in refused.err

    copy.add("symobs/tasks/design/dummy.py", METHOD)
    listed = copy.run("methods")
    assert "    dummy: Take what Ackermann's formula gives.\n        nobody, Theorem 0\n" in listed.out
    solved = copy.run("solve", "-", "--format", "json", stdin=f'{PROBLEM}method = "dummy"\n[expect]\nL = "[19; 81]"\n')
    assert (solved.code, solved.err) == (0, "")
    assert json.loads(solved.out)["results"][0]["method"] == "dummy"
    option = copy.run("observer", "--A", "[0]", "--C", "[1]", "--poles", "-1", "--method", "dummy")
    assert option.code == 0
    assert option.out.startswith("\\documentclass")


def test_a_method_tells_its_own_page_or_none(copy: Copy) -> None:
    """Without one the gain and the check of its claim are printed; no other method's story is borrowed."""
    page = 'page=lambda page, design, side, desired: page.define("L", design.answer["L"], say="gain_with_roots")'
    copy.add("symobs/tasks/design/dummy.py", METHOD)
    copy.add("symobs/tasks/design/second.py", METHOD.replace("dummy", "second").replace('0"', f'0", {page}'))
    told = {
        name: copy.run("solve", "-", "--format", "text", stdin=f'{PROBLEM}method = "{name}"\n').out
        for name in ("ackermann", "dummy", "second")
    }
    assert "Ackermann" in told["ackermann"]
    assert "Ackermann" not in told["dummy"] + told["second"]
    for text in told.values():
        assert "✓ det(sI - A + L C) = s² + 20s + 100" in text
    assert "A gain that assigns it is" in told["dummy"]
    assert "With the prescribed entries zero" in told["second"]
    assert "A gain that assigns it is" not in told["second"] + told["ackermann"]


def test_a_method_that_lies_cannot_answer(copy: Copy) -> None:
    copy.add("symobs/tasks/design/dummy.py", LIAR)
    run = copy.run("solve", "-", stdin=f'{PROBLEM}method = "dummy"\n')
    assert (run.code, run.out) == (1, "")
    assert run.err.startswith("the claim det(s*I - A + L*C) = phi(s) does not hold")


@pytest.mark.parametrize(
    "text",
    [TASK, TASK.replace("from __future__ import annotations\n", "").replace("Poles = None", "Poles | None = None")],
)
def test_a_task_is_one_new_file(copy: Copy, text: str) -> None:
    copy.add("symobs/tasks/design/dummy_task.py", text)
    assert "  dummy_task " in copy.run("--help").out
    assert "dummy_task: Decide what nobody asked.\n    direct: Look at the rank.\n" in copy.run("methods").out
    schema = json.loads(copy.run("schema").out)
    assert "dummy_task" in schema["properties"]["task"]["enum"]
    assert schema["properties"]["specification"]["properties"]["dummy_poles"]["tasks"] == ["dummy_task"]
    file = 'tasks = ["observability", "dummy_task"]\n[plant]\nA = "[0 1; 0 -1]"\nC = "[1 0]"\n'
    solved = copy.run("solve", "-", "--format", "json", stdin=f'{file}[specification]\ndummy_poles = "-1"\n')
    assert (solved.code, solved.err) == (0, "")
    option = copy.run("dummy-task", "--A", "[0 1; 0 -1]", "--C", "[0 1]", "--dummy-poles", "-1", "--format", "json")
    assert option.code == 4
    sheet = copy.run("sheet", "-", "--format", "text", stdin=file)
    assert (sheet.code, sheet.err) == (0, "")
    assert "Decide what nobody asked." in sheet.out
    assert "Is the pair (C, A) observable?" in sheet.out
    unknown = copy.run("solve", "-", stdin=f"{file}[specification]\ndummy_pole = 1\n")
    assert unknown.err == "specification.dummy_pole: unknown key; did you mean dummy_poles?\n"


def test_a_task_is_one_new_folder_and_an_example(copy: Copy) -> None:
    copy.add(f"{FOLDER}/__init__.py", '"""The trace."""\n')
    copy.add(f"{FOLDER}/trace.py", TRACE)
    missing = copy.kept("trace")
    assert f"write {FOLDER}/trace_phrases.py with QUESTIONS" in missing
    assert "write worked_examples/trace.toml" in missing
    copy.add(f"{FOLDER}/trace_phrases.py", TRACE_PHRASES)
    copy.add("worked_examples/trace.toml", TRACE_EXAMPLE)
    assert f"write {FOLDER}/trace_page.py" in copy.kept("trace")
    copy.add(f"{FOLDER}/trace_page.py", TRACE_PAGE)
    with pytest.raises(AssertionError, match=r"write tests/support/claims/claims_of_trace\.py with `holds\("):
        HOLDS["trace"]
    copy.add("symobs/formula/phrases/german/trace.toml", TRACE_IN_GERMAN)
    copy.add("tests/support/claims/claims_of_trace.py", TRACE_CLAIMS)
    others = "every_phrase or theorem or literature or language_has or (trace/direct and survives)"
    told = copy.kept(f"{others} or (trace and not trace/)", "test_languages", "test_tasks_and_methods")
    assert " failed" not in told, told
    assert " passed" in told
    example = str(copy.checkout / "worked_examples" / "trace.toml")
    page = copy.run("solve", example)
    assert (page.code, page.err) == (0, "")
    for words in ("Its diagonal is that of", "moves as follows", r"\begin{tikzpicture}", "Kalman"):
        assert words in page.out
    sheet = copy.run("sheet", example, "--questions", "--format", "text")
    assert "What stands on the diagonal of A?" in sheet.out
    problem = {"task": "trace", "plant": {"A": "[0 1; 0 -1]", "C": "[1 0]"}}
    request = {"schema": "symobs-live/1", "id": 1, "want": "answer", "problem": problem}
    asked = f"import symobs, json; print(json.dumps(symobs.live.answer({request})))"
    run = subprocess.run(
        [sys.executable, "-c", asked], cwd=copy.folder, env=environment(copy.checkout), capture_output=True, check=True
    )
    answer = json.loads(run.stdout)
    assert (answer["status"], answer["says"]) == ("done", "Trace found")


def test_a_format_is_one_new_file(copy: Copy) -> None:
    refused = copy.run("solve", "-", "--format", "dummy", stdin=PROBLEM)
    assert refused.code == 2
    copy.add("symobs/pages/formats/dummy.py", FORMAT)
    solved = copy.run("solve", "-", "--format", "dummy", stdin=PROBLEM)
    assert (solved.code, solved.err) == (0, "")
    assert solved.out.startswith("observer ")
    assert solved.out.endswith(" yes\n")
    assert copy.run("solve", "-", "-o", "page.dum", stdin=PROBLEM).code == 0
    assert (copy.folder / "page.dum").read_text("utf-8") == solved.out
    assert "dummy" in copy.run("solve", "-", "--format", "hug", stdin=PROBLEM).err
