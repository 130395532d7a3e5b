"""Sweeps: one problem at the points of a grid, solved once with symbols where that is possible, else point by point."""

from __future__ import annotations

import json
import re
import shutil
from collections import Counter
from fractions import Fraction
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

from symobs.applications.batch.engine import CHILD, Settings
from symobs.applications.batch.jobs import USUAL_BUDGET, job, read_payload, solve_job
from symobs.applications.batch.run import Batch, one_problem
from symobs.applications.batch.store import work_folder
from symobs.applications.batch.sweep.grid import Grid, read_grid
from symobs.applications.batch.sweep.program import GAINS, MARGINS, MARGINS_STATUS, Program, names_used, with_values
from symobs.applications.batch.sweep.table import check_target, write_table
from symobs.ground.child_processes.budget import Budget
from symobs.ground.child_processes.child import Died, started
from symobs.ground.errors import InputError, SymobsError, UsageError, raise_all
from symobs.problem.file_tables import Errors

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping
    from concurrent.futures import Executor

    from symobs.applications.batch.jobs import Job

#: Consecutive points of one job.
BLOCK = 1024
#: Columns of rounded decimals and of words.
_TEXTS = {"phase_deg", "modulus", MARGINS_STATUS}
#: What the one solution with symbols may take.


class Plan:
    """What a sweep is about to do: the grid, the way, the columns, and the jobs."""

    def __init__(
        self,
        problem: str | Path,
        over: str | Mapping[str, Any],
        columns: str | None = None,
        *,
        way: str = "auto",
        unbounded: bool = False,
    ) -> None:
        """Read problem, grid and columns.

        Raises `ProblemErrors` with all that is wrong with either, and `InputError` for a task that is no design of gains.
        """
        text, name, folder = one_problem(problem)
        payload = read_payload(solve_job(text, name, folder).payload)
        if "problem" not in payload:
            from symobs.problem import parse  # noqa: PLC0415 - it raises what is wrong

            parse(text, name)
        self.tables = {key: value for key, value in payload["problem"].items() if key != "expect"}
        bare = Program(self.tables, (), None)
        if bare.task.name not in GAINS or bare.problem.specification.get("observer") == "minimal":
            message = f"a sweep is of {', '.join(sorted(GAINS))} with an observer of full order"
            raise InputError(message, where="task", repair="name one of these tasks")
        errors = Errors()
        with errors:
            self.grid: Grid = read_grid(over, bare.problem.plant.symbols.signs, unbounded=unbounded)
            self.tables = _with_values_of_file(self.tables, self.grid)
            bare = Program(self.tables, (), None)
            _require_values(bare, self.grid)
        with errors:
            self.columns = _chosen(bare.columns(), columns)
            if MARGINS_STATUS in self.columns:
                from symobs.applications.batch.sweep.margins import require_one_loop  # noqa: PLC0415 - only where asked for

                require_one_loop(bare)
        raise_all(errors.found)
        self.name, self._asked_way = name, way

    @cached_property
    def answer(self) -> dict[str, Any] | None:
        """The solution with the swept names as symbols, None where every point is solved by itself."""
        return self._once() if self._asked_way != "each" else None

    @property
    def way(self) -> str:
        """`once` or `each`."""
        return "each" if self.answer is None else "once"

    def _once(self) -> dict[str, Any] | None:
        """Return the answer with the swept names as symbols, None where there is none to evaluate."""
        asked = job("solve", {"problem": self.tables, "fields": "cases", "formats": []})
        child = started(CHILD, asked.kind, megabytes=USUAL_BUDGET.megabytes)
        try:
            row = json.loads(child.ask((asked.key, asked.kind, asked.payload), USUAL_BUDGET.seconds))
        except (TimeoutError, Died):
            return None
        finally:
            child.end()
        if row["status"] == "unreadable":
            raise InputError("; ".join(row["error"]), where="the problem", repair="see that `symobs solve` works on it")
        answer = row["result"][0] if "result" in row else {}
        if any(answer.get(gain) is None for gain in GAINS[str(answer.get("task", "observer"))]):
            return None
        kept = {name: answer[name] for name in ("conditions", *GAINS[answer["task"]])}
        kept["cases"] = [{"when": case["when"]} for case in answer["cases"]]
        try:
            Program(self.tables, self.grid.names, kept)
        except (ValueError, SymobsError):  # roots or other functions in the answer, or other names
            return None
        return kept

    def jobs(self) -> Iterator[Job]:
        """Yield the blocks, in the order of their points."""
        program: dict[str, Any] = {"problem": self.tables, "names": list(self.grid.names), "answer": self.answer}
        program["with_F"] = any(column.startswith("F.") for column in self.columns)
        shared = {"program": program, "over": [axis.data for axis in self.grid.axes], "columns": self.columns}
        for first in range(0, self.grid.size, BLOCK):
            count = min(BLOCK, self.grid.size - first)
            yield job(
                "sweep-block", {**shared, "first": first, "count": count}, f"points {first + 1} to {first + count}"
            )

    @property
    def blocks(self) -> int:
        """How many jobs there are."""
        return -(-self.grid.size // BLOCK)


def _with_values_of_file(tables: dict[str, Any], grid: Grid) -> dict[str, Any]:
    """Return the problem at its [values], but for the names that run."""
    values = {name: value for name, value in tables.get("values", {}).items() if name not in grid.names}
    return {key: value for key, value in with_values(tables, values).items() if key != "values"}


def _require_values(bare: Program, grid: Grid) -> None:
    """Raise an error for names of the problem that have no values: no point would have a number."""
    errors = Errors()
    for name in sorted(names_used(bare.tables) & bare.problem.plant.symbols.signs.keys() - {*grid.names}):
        errors.note(f"{name} has no values", "over", f"add {name}=… or write {name} in [values]")
    raise_all(errors.found)


def _chosen(there: list[str], wanted: str | None) -> list[str]:
    """Return the columns asked for: names of columns, or of what they are entries of."""
    if wanted is None:
        return there
    parts = re.split(r"[;,](?![^\[]*\])", wanted)  # commas in brackets part no names
    names = [part.replace(" ", "") for part in parts if part.strip()]
    group = {column: column.partition("[")[0].partition(".")[0] for column in there} | dict.fromkeys(MARGINS, "margins")
    chosen = [column for column in group if column in names or group[column] in names]
    strange = [name for name in names if not any(name in pair for pair in group.items())]
    if strange or not chosen:
        known = ", ".join(dict.fromkeys(group.values()))
        message = f"{' and '.join(strange) or 'nothing'} {'are' if len(strange) > 1 else 'is'} no column"
        entry = next((name for name in there if "[" in name), "K[1,2]")
        repair = f"name some of {known}, or entries such as {entry}, counted from 1"
        raise UsageError(message, where="--columns", repair=repair)
    return [*chosen, MARGINS_STATUS] if set(chosen) & set(MARGINS) else chosen


def exact(text: str) -> Fraction | str:
    """Return a number as a fraction where it is one, else its text: `sqrt(2)`, `CRootOf(...)`, `oo`."""
    try:
        return Fraction(text)
    except ValueError:
        return text


class SweepTable:
    """The table of a sweep: iterate over it for rows of exact numbers, or take it to Arrow or pandas."""

    def __init__(self, plan: Plan, run: Batch) -> None:
        """Take the plan and the run whose store holds the blocks, or gives them as they come."""
        self.plan, self.run = plan, run
        self._counts: Counter[str] = Counter()

    @property
    def grid(self) -> Grid:
        """The grid of points."""
        return self.plan.grid

    def blocks(self) -> Iterator[tuple[int, dict[str, Any]]]:
        """Yield the first index and the result of every block, in the order of the points."""
        store = self.run.store
        assert store is not None  # noqa: S101 - `sweep` gives it one
        self._counts.clear()
        for first, result in store.in_order(self.plan.jobs()):
            self._counts.update(result["status"])
            yield first, result

    def told(self) -> str:
        """Return how the points went that were read last: `3 points: 2 done, 1 no`."""
        parts = ", ".join(f"{count} {status}" for status, count in sorted(self._counts.items()))
        return f"{self._counts.total()} points: {parts}"

    def __iter__(self) -> Iterator[dict[str, Any]]:
        """Yield the rows: the names and the columns as fractions, other numbers as texts, `status` and `case`."""
        for first, result in self.blocks():
            columns = result["columns"]
            for place, (status, case) in enumerate(zip(result["status"], result["case"], strict=True)):
                point = dict(zip(self.grid.names, self.grid.point(first + place), strict=True))
                cells = {
                    name: column[place] if column[place] is None or name in _TEXTS else exact(column[place])
                    for name, column in columns.items()
                }
                yield {
                    "index": first + place,
                    **point,
                    **cells,
                    "status": status,
                    "case": case,
                    "checked": status == "done",
                }

    def to_arrow(self, *, decimals: bool = False) -> Any:
        """Return the table as an Arrow table, exact numbers as texts; needs the extra `table`."""
        from symobs.applications.batch.sweep.arrow import arrow_table  # noqa: PLC0415 - needs pyarrow

        return arrow_table(self, decimals=decimals)

    def to_pandas(self) -> Any:
        """Return the table as a pandas frame, exact numbers as texts; needs pandas as well."""
        return self.to_arrow().to_pandas()


def sweep(
    problem: str | Path,
    over: str | Mapping[str, Any],
    *,
    columns: str | None = None,
    out: str | Path | None = None,
    decimals: bool = False,
    way: str = "auto",
    workers: int | None = None,
    scheduler: str | None = None,
    executor: Executor | None = None,
    timeout: float | None = 600.0,
    memory: float | None = 2000.0,
) -> SweepTable:
    """Design at every point of a grid: K, L and F as exact numbers, each checked at its point.

    problem    the path or the text of a problem of state_feedback, observer or compensator
    over       `"l=0.1:0.1:10, m=[1,2,5]"` (start:step:stop, lists, a:b/N, decade(a:b)), or names with their values; the
               last name runs fastest
    columns    `"K, L"`: those wanted, all of K, L, F without it; `margins`: how far the loop is from instability
    out        a .csv or .parquet file, or a folder of Parquet files; a run that was ended goes on
    decimals   for every exact column a second one of the nearest binary numbers
    way        `each` solves every point by itself; else the problem is solved once with symbols where that succeeds

    Returns the table.  Raises `ProblemErrors` for the problem or the grid, `InputError` for another task, `Unfinished`
    when nobody is left to do the work.
    """
    plan = Plan(problem, over, columns, way=way)
    if out is not None:
        check_target(Path(out))
    plan.answer  # noqa: B018 - what cannot be solved is said before a folder is made
    folder = _folder_for(plan) if out is None else work_folder(Path(out))
    who = {"workers": workers, "scheduler": scheduler, "executor": executor}
    run = Batch(plan.jobs, folder, settings=Settings(Budget(timeout, memory)), **who).finish()  # type: ignore[arg-type]
    table = SweepTable(plan, run)
    if out is not None:
        write_table(table, Path(out), decimals=decimals)
    return table


def _folder_for(plan: Plan) -> Path:
    """Return a folder that is there as long as the plan, which its table keeps."""
    import tempfile  # noqa: PLC0415 - only without a place for the table
    import weakref  # noqa: PLC0415

    folder = Path(tempfile.mkdtemp(prefix="symobs-sweep-"))
    weakref.finalize(plan, shutil.rmtree, folder, ignore_errors=True)
    return folder


__all__ = ["Plan", "SweepTable", "sweep"]
