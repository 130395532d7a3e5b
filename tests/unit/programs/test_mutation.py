"""Mutation testing itself is tested, and a slice of it runs: of the mutants of the trusted floors, and of lies about designs.

The whole: `python -m tests.programs.mutation` and `python -m tests.programs.mutation.claims --designs 1000`.
"""

from __future__ import annotations

import os
import subprocess
import sys
from typing import TYPE_CHECKING

import pytest

from tests.programs.mutation.__main__ import MARKING, TRUSTED, known_equivalent, standing_for
from tests.programs.mutation.claims import ASKED, KINDS, drawn, tried
from tests.programs.mutation.mutants import mutants_of
from tests.support.paths import ROOT
from tests.support.tampering.lies import Count

if TYPE_CHECKING:
    from pathlib import Path

    from tests.programs.mutation.mutants import Mutant

pytestmark = pytest.mark.slow


CHECK = '''
def is_small(values: list[int], most: int = 3) -> bool:
    """Tell whether all are small."""
    if not values:
        raise ValueError("nothing to be small")
    return all(0 < value < most for value in values)
'''


@pytest.fixture(name="found")
def mutants_of_a_check(tmp_path: Path) -> list[Mutant]:
    path = tmp_path / "check.py"
    path.write_text(CHECK, encoding="utf-8")
    return mutants_of(path)


def test_every_way_to_weaken_a_check_is_found(found: list[Mutant]) -> None:
    changes = {mutant.key.removeprefix("is_small: ") for mutant in found}
    assert changes == {
        *("3 -> 4", "3 -> 2"),
        *("if not values -> True", "if not values -> False", "not values -> values"),
        "raise ValueError('nothing to be small') -> pass",
        "return all((0 < value < most for value in values)) -> pass",
        "return all((0 < value < most for value in values)) -> True",
        "return all((0 < value < most for value in values)) -> False",
        "all((0 < value < most for value in values)) -> any((0 < value < most for value in values))",
        "all((0 < value < most for value in values)) -> (0 < value < most for value in values)",
        *("0 < value < most -> 0 <= value < most", "0 < value < most -> 0 >= value < most"),
        *("0 < value < most -> 0 < value <= most", "0 < value < most -> 0 < value >= most"),
        *("0 -> 1", "0 -> -1"),
    }


def test_a_mutant_is_code_that_differs_in_one_place(found: list[Mutant]) -> None:
    weaker = next(mutant for mutant in found if mutant.key.endswith("-> 0 < value <= most"))
    names: dict[str, object] = {}
    exec(weaker.code(), names)  # noqa: S102 - the text above
    assert names["is_small"]([3])  # type: ignore[operator]
    assert not names["is_small"]([0])  # type: ignore[operator]


def test_equivalent_mutants_are_still_there_and_have_reasons() -> None:
    files = {path.relative_to(ROOT).as_posix(): path for path in (*TRUSTED, *MARKING)}
    for name, reasons in known_equivalent().items():
        keys = {mutant.key for mutant in mutants_of(files[name])}
        assert reasons.keys() <= keys
        assert all(len(reason) > 20 for reason in reasons.values())


def test_every_trusted_file_has_its_tests() -> None:
    for path in (*TRUSTED, *MARKING):
        assert standing_for(path) or not mutants_of(path)
        assert all(any((ROOT / "tests").rglob(f"test_{name}.py")) for name in standing_for(path))


@pytest.mark.parametrize(("name", "every"), [("certificate.py", 25), ("strata.py", 10)])
def test_no_mutant_of_a_check_survives(name: str, every: int) -> None:
    command = [sys.executable, "-m", "tests.programs.mutation", "--only", name, "--every", str(every)]
    environment = {**os.environ, "PYTHONPATH": str(ROOT)}
    done = subprocess.run(command, cwd=ROOT, env=environment, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr
    assert "tried" in done.stdout


def test_no_lie_about_a_random_design_survives() -> None:
    answers, lines, designs = Count(), Count(), 0
    for _, of_answers, of_lines in tried(range(40), most_lines=25):
        designs += 1
        for count, more in ((answers, of_answers), (lines, of_lines)):
            count.tried += more.tried
            count.rejected += more.rejected
            count.true += more.true
            count.lies += more.lies
    assert designs >= 35
    for count in (answers, lines):
        assert count.lies == []
        assert count.tried == count.rejected + count.true
        assert count.tried > 500
        assert count.rejected > 0.8 * count.tried


def test_designs_are_of_all_kinds_and_the_same_in_every_run() -> None:
    designs = [drawn(number) for number in range(len(KINDS) * len(ASKED))]
    assert {design.kind for design in designs} == set(KINDS)
    assert {design.asked for design in designs} == set(ASKED)
    assert repr(drawn(5).plant) == repr(designs[5].plant)
