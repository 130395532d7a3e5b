"""Sweeps: the same table by formulas as point by point, on strata too; tables that say exactly what was found."""

from __future__ import annotations

import csv
import json
import math
import random
from fractions import Fraction
from typing import TYPE_CHECKING, Any

import pytest

import symobs
from symobs.applications.batch.jobs import read_payload
from symobs.applications.batch.store import work_folder
from symobs.applications.batch.sweep import points as block
from symobs.applications.batch.sweep.grid import read_grid
from symobs.applications.batch.sweep.plan import Plan
from symobs.ground.errors import CertificateRejected, InputError, ProblemErrors
from tests.kit import tabled
from tests.support.tools.command_line import inside

if TYPE_CHECKING:
    from pathlib import Path

pytestmark = pytest.mark.slow

CART = """
task = "compensator"
[symbols]
m = "positive"
l = "positive"
[plant]
A = [[0, 1, 0, 0], [0, "-1/10", "-10 m", 0], [0, 0, 0, 1], [0, "1/(10 l)", "10 (1 + m)/l", 0]]
B = [[0], ["1"], [0], ["-1/l"]]
C = [[1, 0, 0, 0]]
[specification]
control_poles = [-1, -2, -3, -4]
observer_poles = [-5, -6, -7, -8]
"""


def problem(task: str, symbols: str, plant: str, specification: str) -> str:
    signs = "".join(f'{name} = "{sign}"\n' for name, sign in (entry.split(":") for entry in symbols.split()))
    return f'task = "{task}"\n[symbols]\n{signs}[plant]\n{plant}\n[specification]\n{specification}\n'


#: Problems with two swept names each, and a grid on which conditions fail and cases of their own begin.
PROBLEMS = {
    "cart": (CART, "l=1/10:1/10:3, m=1/10:1/10:3"),
    "hidden mode": (
        problem("observer", "l:real m:real", 'A = "[0 1; -2 -3]"\nC = "[1 l+m]"', 'poles = "-1, -5"'),
        "l=-1:1/4:2, m=-1:1/4:2",  # at l + m = 1/2 the mode -2, at l + m = 1 the mode -1 is not seen
    ),
    "fixed mode": (
        problem("state_feedback", "a:real b:real", 'A = "[1 a; 0 -2]"\nB = "[b; a + b]"', 'poles = "-2, -3"'),
        "a=-2:1/2:2, b=-2:1/2:2",
    ),
    "asked for by a name": (
        problem(
            "state_feedback", "w:positive p:positive", 'A = "[0 1; -w^2 -2w]"\nB = "[0; 1/w]"', 'poles = "-p, -2p"'
        ),
        "w=1/3:1/3:4, p=[1, 5/2, 7]",
    ),
    "polynomial": (
        problem("observer", "c:real d:real", 'A = "[0 1 0; 0 0 1; c d 1]"\nC = "[1 0 c]"', 'polynomial = "(s + 1)^3"'),
        "c=-1:1/2:2, d=-1:1/2:3/2",
    ),
    "feedthrough": (
        problem(
            "compensator",
            "d:real k:positive",
            'A = "[0 1; k -1]"\nB = "[0; 1]"\nC = "[1 0]"\nD = "d"',
            'control_poles = "-1, -2"\nobserver_poles = "-3+i, -3-i"',
        ),
        "d=-2:1/2:2, k=1/2:1/2:4",
    ),
}


def rows_of(payload: dict[str, Any]) -> list[dict[str, Any]]:
    """The rows of a block, worked on here."""
    result = block.run(payload)["result"]
    return [
        {"status": result["status"][k], **{name: column[k] for name, column in result["columns"].items()}}
        for k in range(payload["count"])
    ]


def compared(text: str, over: str, points: int) -> list[dict[str, Any]]:
    """The rows of a sweep by formulas, of which some points are held against their own solution."""
    once, each = Plan(text, over), Plan(text, over, way="each")
    assert (once.way, each.way) == ("once", "each")
    assert once.grid.size <= 1024
    ((job,), (alone,)) = list(once.jobs()), list(each.jobs())
    rows = rows_of(read_payload(job.payload))
    assert block.recheck(read_payload(job.payload), {"key": "k", **block.run(read_payload(job.payload))}) is None
    for index in random.Random(over).sample(range(len(rows)), min(points, len(rows))):  # noqa: S311
        (wanted,) = rows_of({**read_payload(alone.payload), "first": index, "count": 1})
        assert rows[index] == wanted, once.grid.point(index)
    return rows


@pytest.mark.parametrize("name", PROBLEMS)
def test_formulas_and_single_solutions_agree(name: str) -> None:
    compared(*PROBLEMS[name], points=25)


def test_a_block_that_was_changed_is_found() -> None:
    (job,) = Plan(CART, "l=1:1:20, m=1/10:1/10:2").jobs()
    payload = read_payload(job.payload)
    row = {"key": "some", **block.run(payload)}
    assert block.recheck(payload, row) is None
    for column in ("K[1,2]", "L[4,1]", "F.num[1]"):
        changed = {**row["result"]["columns"], column: [f"{entry}1" for entry in row["result"]["columns"][column]]}
        assert block.recheck(payload, {**row, "result": {**row["result"], "columns": changed}}) is not None


def test_numbers_put_in_wrongly_are_seen(monkeypatch: pytest.MonkeyPatch) -> None:
    from symobs.applications.batch.sweep import program  # noqa: PLC0415

    wrong = program.Program(Plan(CART, "l=1, m=1", way="each").tables, ("l", "m"), None)
    put_in = program._put_in
    monkeypatch.setattr(program, "_put_in", lambda value, values: put_in(value, {**values, "l": Fraction(7)}))
    with pytest.raises(CertificateRejected, match="the plant of a point has another A"):
        wrong.alone((Fraction(1), Fraction(1)), None)


# -- tables -----------------------------------------------------------------------------------------------------------


def test_tables_say_exactly_what_was_found(tmp_path: Path) -> None:
    pq = pytest.importorskip("pyarrow.parquet")
    (tmp_path / "cart.toml").write_text(CART, "utf-8")
    sweep = ["sweep", "cart.toml", "--over", "l=0.1:0.1:4, m=[1/3, 2, 5e-1]", "--workers", "2", "--quiet"]
    for out in ("t.csv", "t.parquet", "parts"):
        assert inside(*sweep, "--out", out, "--columns", "K,L", "--decimals", folder=tmp_path).code == 0
        assert not work_folder(tmp_path / out).exists()
    with (tmp_path / "t.csv").open(encoding="utf-8", newline="") as stream:
        lines = list(csv.DictReader(stream))
    table = pq.read_table(tmp_path / "t.parquet")
    assert [str(value) for value in table["K[1,3]"].to_pylist()] == [line["K[1,3]"] for line in lines]
    assert pq.read_table(tmp_path / "parts" / "part-00000.parquet").equals(table)
    manifest = json.loads((tmp_path / "parts" / "manifest.json").read_text("utf-8"))
    assert manifest["parts"]["part-00000.parquet"]["rows"] == 120
    held = symobs.sweep(CART, "l=0.1:0.1:4, m=[1/3, 2, 5e-1]", columns="K,L", workers=1)
    rows = list(held)
    assert len(rows) == len(lines) == 120
    for row, line in zip(rows, lines, strict=True):
        for name in ("l", "m", "K[1,1]", "L[4,1]"):
            assert row[name] == Fraction(line[name])
            assert float(line[f"{name}.d"]) == float(row[name])
        assert row["checked"] is True
    assert (rows[4]["l"], rows[4]["m"]) == (Fraction(1, 5), Fraction(2))
    assert held.to_arrow()["L[2,1]"].to_pylist() == table["L[2,1]"].to_pylist()
    assert json.loads(table.schema.metadata[b"over"])[0][:2] == ["l", 40]


# -- grids and what cannot be done --------------------------------------------------------------------------------------


def test_grids_are_exact() -> None:
    signs = dict.fromkeys("abcde", "real")
    grid = read_grid("a=0.1:0.1:1, b=1:-1/3:0, c=0:1/3, d=[1, 2/7 -3], e=decade(1e-1:3)", signs)
    values = {axis.name: [axis.at(k) for k in range(axis.count)] for axis in grid.axes}
    assert values["a"] == [Fraction(k, 10) for k in range(1, 11)]
    assert values["b"] == [1, Fraction(2, 3), Fraction(1, 3), 0]
    assert values["c"] == [0, Fraction(1, 2), 1]
    assert values["d"] == [1, Fraction(2, 7), -3]
    assert values["e"] == [Fraction(1, 10), Fraction(1, 5), Fraction(1, 2), 1, 2]
    assert grid.size == 10 * 4 * 3 * 3 * 5
    assert len({grid.point(k) for k in range(grid.size)}) == grid.size
    assert grid.point(1)[-1] == Fraction(1, 5)
    assert read_grid({"a": [1, Fraction(1, 3)], "b": "0:2:4"}, signs).size == 6


@tabled
def test_what_is_no_grid_is_said(over: str, where: str, says: str) -> None:
    with pytest.raises(InputError) as refused:
        read_grid(over, {"l": "positive", "m": "positive"})
    errors = refused.value.errors if isinstance(refused.value, ProblemErrors) else (refused.value,)
    assert [error.where for error in errors] == [where]
    assert says in str(refused.value)
    with pytest.raises(ProblemErrors, match="not an exact number"):
        read_grid({"l": [0.5]}, {"l": "positive"})


@tabled
def test_what_cannot_be_swept_is_said(arguments: list[str], code: int, says: str, tmp_path: Path) -> None:
    (tmp_path / "cart.toml").write_text(CART, "utf-8")
    left = inside("sweep", "cart.toml", "--over", "l=1:1:3, m=1", *arguments, folder=tmp_path)
    assert left.code == code
    assert says in left.err


def test_functions_of_swept_names_are_solved_point_by_point_and_points_are_counted(tmp_path: Path) -> None:
    text = problem("state_feedback", "w:real", 'A = "[0 1; 0 0]"\nB = "[0; w]"', 'poles = "-exp(-w), -1"')
    (tmp_path / "e.toml").write_text(text, "utf-8")
    words = ["--over", "w=[1/10, 0, 1]", "--out", "e.csv", "--decimals", "--in-process"]
    left = inside("sweep", "e.toml", *words, folder=tmp_path)
    assert left.err.splitlines()[-1] == "3 points: 2 done, 1 no"
    with (tmp_path / "e.csv").open(encoding="utf-8", newline="") as stream:
        rows = list(csv.DictReader(stream))
    assert [row["status"] for row in rows] == ["done", "no", "done"]
    assert float(rows[0]["K[1,1].d"]) == pytest.approx(math.exp(-0.1) / 0.1, rel=1e-15)
    assert float(rows[2]["K[1,2].d"]) == pytest.approx(math.exp(-1) + 1, rel=1e-15)


def test_the_values_of_the_file_are_those_of_all_points() -> None:
    """K = [w² + w, 2 z w] for A = [0 1; w 0]: at w = 2 and z = 3/5 the poles have the real part -6/5."""
    pair = 'poles = { damping = "z", natural_frequency = "w" }'
    text = problem("state_feedback", "z:positive w:positive", 'A = "[0 1; w 0]"\nB = "[0; 1]"', pair)
    for w, K, slowest in (("2", [6, Fraction(12, 5)], Fraction(-6, 5)), ("sqrt(2)", ["sqrt(2) + 2", None], None)):
        (row,) = symobs.sweep(f'{text}[values]\nw = "{w}"\n', "z=3/5", columns="K, margins", workers=1)
        assert row["K[1,1]"] == K[0]
        assert row["slowest"] == slowest
        assert row["margins_status"] == ("done" if slowest else "undecided")
    (row,) = symobs.sweep(f'{text}[values]\nw = "2"\nz = "9"\n', "z=3/5", columns="K", workers=1)
    assert row["K[1,2]"] == Fraction(12, 5)


def test_a_point_without_a_plant_is_undefined_and_loses_no_other() -> None:
    text = problem("observer", "l:real", 'A = "[0 1; 1/l -3]"\nC = "[1 0]"', 'poles = "-1, -5"')
    (job,) = Plan(text, "l=-1:1:1").jobs()
    result = block.run(read_payload(job.payload))["result"]
    assert result["status"] == ["done", "undefined", "done"]
    assert result["columns"]["L[2,1]"] == ["-5", None, "-3"]


def test_other_tasks_are_refused() -> None:
    text = problem("observability", "l:real", 'A = "[0 1; l -3]"\nC = "[1 0]"', "")
    with pytest.raises(InputError, match="a sweep is of"):
        Plan(text, "l=1")
