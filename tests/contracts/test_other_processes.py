"""What a value means is a part of it: in another process, in a thread, and after thousands of other values."""

from __future__ import annotations

import functools
import gc
import pickle
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from threading import Event
from typing import TYPE_CHECKING, Any

import pytest
from flint import ctx

import symobs
from symobs.exact import Field, Matrix, Scalar
from symobs.exact.core.generators import function
from symobs.exact.core.ring import Precision
from symobs.tasks.result import tasks
from tests.kit import tables
from tests.support.claims.asking import specification
from tests.support.tools.another_process import Account, account_of, read_in_another_process

if TYPE_CHECKING:
    from collections.abc import Iterator

pytestmark = pytest.mark.slow

#: Plants whose functions of time are exponentials, an oscillation with a root, and sums over roots of a cubic.
PLANTS = tables(Path(__file__))["plants"]
IN_TIME = ("gramian", "initial_state", "matrix_exponential")
NAMES = [(plant, task) for plant in PLANTS for task in (sorted(tasks()) if plant == "decaying" else IN_TIME)]


def design(number: int) -> tuple[Any, Any]:
    """Return an observer and a matrix exponential for symbols that no design before had."""
    a, b, p = (f"{letter}{number}" for letter in "abp")
    plant = symobs.StateSpace([["0", a], ["1", b]], [["1"], ["0"]], [["1", b]])
    decaying = symobs.StateSpace([[f"-{p}", "1"], ["0", f"-2*{p}"]], [["0"], ["1"]], [["1", "0"]])
    return symobs.observer(plant, poles=[f"-{p}", "-1"]), symobs.matrix_exponential(decaying)


def example(name: tuple[str, str]) -> Any:
    A, poles = PLANTS[name[0]]
    order = len(A)
    B = [["0"]] * (order - 1) + [["1"]]
    plant = symobs.StateSpace(A, B, [["1"] + ["0"] * (order - 1)])
    return tasks()[name[1]].function(plant, **specification(name[1], poles))


@pytest.fixture(scope="module")
def results() -> dict[tuple[str, str], Any]:
    return {name: example(name) for name in NAMES}


@pytest.fixture(scope="module")
def accounts(results: dict[tuple[str, str], Any]) -> dict[tuple[str, str], Account]:
    return {name: account_of(result) for name, result in results.items()}


def test_functions_of_time_mean_the_same_in_another_process(results: Any, accounts: Any) -> None:
    elsewhere = read_in_another_process(results)
    moving = [name for name in NAMES if any("exp" in str(value) for value in accounts[name]["values"])]
    assert len(moving) >= 3
    assert any("RootSum" in str(accounts[name]["values"]) for name in moving)
    for name in NAMES:
        assert elsewhere[name] == accounts[name], name


def test_a_bare_matrix_keeps_its_derivative_in_another_process() -> None:
    t = Scalar.symbol("t")
    matrix = Matrix.of([[function("exp", -2 * t), function("cos", 3 * t)]])
    program = (
        "import pickle, sys; from symobs.exact import derivative\n"
        "print(derivative(pickle.load(sys.stdin.buffer), 't'))\n"
    )
    run = subprocess.run([sys.executable, "-c", program], input=pickle.dumps(matrix), check=True, capture_output=True)
    assert run.stdout.decode().strip() == "[-2*exp(-2*t) -3*sin(3*t)]"


def test_a_function_is_not_a_name_alone() -> None:
    with pytest.raises(ValueError, match=r"exp\(-unheard_of\*t\) is a function"):
        Scalar.symbol("exp(-unheard_of*t)")


@pytest.mark.usefixtures("quick_switches")
def test_four_threads_give_the_answers_of_one(accounts: Any) -> None:
    with ThreadPoolExecutor(4) as threads:
        found = list(threads.map(lambda name: account_of(example(name)), NAMES))
    for name, account in zip(NAMES, found, strict=True):
        assert account == accounts[name], name


def test_a_thread_keeps_its_precision() -> None:
    inside, disturbed, seen, before = Event(), Event(), Event(), ctx.prec

    def disturb() -> None:
        inside.wait()
        with Precision(512):
            disturbed.set()
            seen.wait()

    with ThreadPoolExecutor(1) as other:
        other.submit(disturb)
        with Precision(64):
            inside.set()
            disturbed.wait(0.1)
            found = ctx.prec
            seen.set()
    assert found == 64
    assert ctx.prec == before


@pytest.fixture
def quick_switches() -> Iterator[None]:
    """Let threads change places so often that what they share is met half done."""
    before = sys.getswitchinterval()
    sys.setswitchinterval(1e-6)
    yield
    sys.setswitchinterval(before)


@pytest.mark.filterwarnings("ignore:Generating overly large repr")  # of other test modules' data, seen on the way
def test_fresh_symbols_leave_nothing_behind(monkeypatch: pytest.MonkeyPatch) -> None:
    """Every cache has a bound, and no other table of the process holds a symbol of a design that is gone."""
    caches = [each for each in gc.get_objects() if isinstance(each, functools._lru_cache_wrapper)]
    caches = [each for each in caches if each.__module__.startswith("symobs")]
    unbounded = {each.__qualname__ for each in caches if each.cache_parameters()["maxsize"] is None}
    assert unbounded <= {
        *("of_file", "_made_of", "_of_built_in", "GainDesign.assignment", "fingerprint"),
        *("_folders", "_read", "_starter", "examples"),  # languages, and the one way to start a child
    }
    monkeypatch.setattr("symobs.exact.core.field._ROUTES", 8)
    numbers = range(7000, 7030)  # names that nothing else in the process has
    for number in numbers:
        design(number)
        fresh = Scalar.symbol(f"p{number}")
        assert (Scalar.symbol("s") + fresh - fresh).within(Field.of(["s"])) == Scalar.symbol("s")
    for each in caches:
        each.cache_clear()
    gc.collect()
    tables = [each for each in gc.get_objects() if isinstance(each, dict | list | set) and len(each) > 20]
    assert [table for table in tables if all(f"p{number}" in str(list(table)) for number in numbers)] == []
