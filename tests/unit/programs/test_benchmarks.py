"""The benchmarks on small sizes: that they run, and that what they time is the same work.  No time is tested."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

import pytest

import symobs
from tests.kit import tabled
from tests.programs.benchmarks import __main__ as benchmarks
from tests.programs.benchmarks import designs, measuring, models, other_systems, raw_flint, raw_numeric
from tests.support.paths import ROOT

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

pytestmark = pytest.mark.slow

needs_giac = pytest.mark.skipif(not other_systems.available("giac"), reason="giac is not installed")
needs_maxima = pytest.mark.skipif(not other_systems.available("maxima"), reason="maxima is not installed")
needs_gp = pytest.mark.skipif(not other_systems.available("gp"), reason="gp is not installed")


@pytest.mark.parametrize("order", [2, 3])
def test_flint_alone_finds_the_gain_of_symobs(order: int) -> None:
    model = models.generic(order)
    _, entries = raw_flint.seconds(model, order)
    found = [(str(above), str(below)) for above, below in entries]
    wanted = [(str(e.numerator_part), str(e.denominator_part)) for e in designs.solve(model).answer["L"].entries]
    opposite = [(str(-above), str(-below)) for above, below in entries]
    assert all(entry in pair for entry, pair in zip(wanted, zip(found, opposite, strict=True), strict=True))


@pytest.mark.parametrize("order", [2, 3])
def test_subjects_take_turns_and_one_that_gives_up_is_left_out(order: int) -> None:
    calls: list[str] = []

    def subject(name: str, seconds: float | None) -> Callable[[], float | None]:
        def run() -> float | None:
            calls.append(name)
            return seconds

        return run

    found = measuring.medians(order, {"a": subject("a", 1.0), "b": subject("b", None), "c": subject("c", 2.0)})
    assert found == {"a": 1.0, "c": 2.0}
    assert calls == ["a", "b", "c", *["a", "c"] * (order - 1)]


def test_the_table_has_a_ratio_in_every_compared_row() -> None:
    rows = [
        measuring.Row("work", 0.002, "other", 0.1, ">= 40"),
        measuring.Row("work", 0.002, "base", 0.001, "<= 4", inverted=True),
        measuring.Row("alone", 1.5),
        measuring.Row("beyond", 0.01, "slow", 60, beyond=True),
        measuring.Row("sheets", 9.25, unit="problems/s"),
    ]
    lines = [re.split(r" {2,}", line) for line in measuring.table(rows).splitlines()]
    assert lines[1:] == [
        ["work", "2 ms", "other", "100 ms", "50", ">= 40"],
        ["work", "2 ms", "base", "1 ms", "2", "<= 4"],
        ["alone", "1.5 s"],
        ["beyond", "10 ms", "slow", "> 60 s", "> 6000"],
        ["sheets", "9.25 problems/s"],
    ]
    marked = measuring.markdown(rows).splitlines()
    assert marked[1] == "| --- | ---: | --- | ---: | ---: |"
    assert marked[2] == "| work | 2 ms | other | 100 ms | 50 |"
    assert len(marked) == len(rows) + 2


def test_the_table_of_the_page_is_written_by_one_command(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    page, told = tmp_path / "page.md", (ROOT / "docs" / "measurements.md").read_text("utf-8")
    page.write_text(told, "utf-8")
    for seconds in (0.002, 1.5):
        row = measuring.Row("work", seconds)
        group = type("group", (), {"rows": staticmethod(lambda _, row=row: [row])})
        monkeypatch.setattr(benchmarks, "groups", lambda group=group: {"a": group})
        monkeypatch.setattr(benchmarks, "PAGE", page)
        benchmarks.main(["--write"])
    above, below = told.partition("<!-- benchmarks -->\n")[0], told.partition("<!-- end -->\n")[2]
    found = page.read_text("utf-8")
    assert found.startswith(above)
    assert found.endswith(below)
    table = found.removeprefix(above).removesuffix(below)
    assert "| work | 1.5 s |  |  |  |" in table
    assert "2 ms" not in table
    with pytest.raises(SystemExit):
        benchmarks.main(["--write", "--only", "a"])


def test_flint_alone_finds_the_gain_of_numbers() -> None:
    A, C, poles = models.rational(5)
    _, found = raw_numeric.seconds(A, C, poles)
    design = symobs.observer(symobs.StateSpace(A, None, C), poles=poles)
    assert [str(entry) for entry in found.entries()] == [str(entry) for entry in design.answer["L"].entries]


def test_every_group_of_symobs_alone_has_rows() -> None:
    known = benchmarks.groups()
    spent = known["sheets"].spent_on(ROOT / "worked_examples" / "servo_observer.toml")
    assert set(spent) == {"html", "text", "json", "latex"}
    first = next(known["pages"].compensators(1))
    assert next(known["pages"].compensators(4)) == first
    assert "\\begin{document}" in known["pages"].page(first)
    little, much = known["memory"].peak("pass", 60), known["memory"].peak("x = bytearray(10**8)", 60)
    assert little is None or 90 < much - little < 110
    rows = list(designs.beside_flint("generic 2x2", 2, 1, "<= 4", lambda: models.generic(2)))
    assert [(row.work, row.asked, row.inverted) for row in rows] == [("generic 2x2", "<= 4", True)]


MODELS = {"generic_": lambda: models.generic(3), "cart_pole_": models.cart_pole, "two_masses_": models.two_masses}


@needs_maxima
@tabled
def test_maxima_agrees_and_a_difference_would_be_seen(stem: str, formulation: str, tmp_path: Path) -> None:
    model = MODELS[stem]()
    wanted = designs.differences_at_points(model, designs.solve(model))
    path = other_systems.formulations("maxima", stem)[formulation]
    assert other_systems.agrees(path, wanted, tmp_path)
    assert not other_systems.agrees(path, [*wanted[:-1], wanted[-1] + "+s"], tmp_path)


@needs_giac
@tabled
def test_giac_agrees_and_a_difference_would_be_seen(stem: str, formulation: str, tmp_path: Path) -> None:
    model = MODELS[stem]()
    wanted = designs.differences(model, designs.solve(model))
    path = other_systems.formulations("giac", stem)[formulation]
    assert other_systems.agrees(path, wanted, tmp_path)
    assert not other_systems.agrees(path, [*wanted[:-1], wanted[-1] + "+s"], tmp_path)


@needs_gp
@tabled
def test_gp_finds_the_gain_of_symobs(formulation: str, tmp_path: Path) -> None:
    path = other_systems.formulations("pari", "")[formulation]
    program = tmp_path / path.name
    program.write_text(path.read_text("utf-8") + "print(Vec(L[,1]));\n", "utf-8")
    A, C, poles = models.rational(4)
    design = symobs.observer(symobs.StateSpace(A, None, C), poles=poles)
    done = other_systems.gp(program, 4, 60)
    assert done is not None
    assert done.output.strip() == str([str(entry) for entry in design.answer["L"].entries]).replace("'", "")
