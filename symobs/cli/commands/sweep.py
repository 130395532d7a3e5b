"""The command `sweep`: a design at every point of a grid, into a table."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from symobs.applications.batch.store import discard_work, work_folder
from symobs.applications.batch.sweep.picture import drawn_columns, write_picture
from symobs.applications.batch.sweep.plan import Plan, SweepTable
from symobs.applications.batch.sweep.table import check_target, write_table
from symobs.cli.commands.batch import batch_of, finish, of_a_run
from symobs.cli.shared.common import write_message
from symobs.cli.shared.options import options
from symobs.cli.shared.outcome import check_targets
from symobs.ground.child_processes.budget import Budget
from symobs.ground.errors import UsageError, raise_all
from symobs.problem.file_tables import Errors

#: What a block of points is allowed where nothing else is said.
_SECONDS, _MEGABYTES = 600.0, 2000.0


@click.command("sweep")
@click.argument("problem")
@click.option(
    "--over",
    "several",
    required=True,
    multiple=True,
    metavar="GRID",
    help="l=0.1:0.1:10, m=[1,2,5], k=0:1/11 (11 points), g=decade(1e-3:1e3)",
)
@click.option("--out", metavar="PATH", help="The table: .csv, .parquet, or a folder of Parquet files.")
@click.option("--plot", metavar="PATH", help="A picture of the columns: .svg, .png, .pdf or .tex.")
@click.option(
    "--columns", metavar="NAMES", help="K, L, F, or single entries such as K[1,2]; all without it.  Or margins."
)
@click.option("--decimals", is_flag=True, help="Beside every exact column one of the nearest binary numbers.")
@click.option("--each", is_flag=True, help="Solve every point by itself, not once with symbols.")
@click.option("--yes", is_flag=True, help="Take more than a hundred million points.")
@options("timeout", "memory")
@of_a_run
def command(
    problem: str,
    several: tuple[str, ...],
    out: str | None,
    plot: str | None,
    columns: str | None,
    decimals: bool,  # noqa: FBT001 - click's signature
    each: bool,  # noqa: FBT001
    yes: bool,  # noqa: FBT001
    timeout: float | None,
    memory: float | None,
    **run: Any,
) -> None:
    """Design at every point of a grid, each exact and checked, into a table or a picture.

    The problem is solved once with symbols where that succeeds, and the formulas are evaluated at every point, where all
    claims are checked again.  --timeout and --memory are for 1024 points.  Run the same command again after a run that
    was ended: it goes on.  The picture shows columns over one name, or lines of equal values of one column over two.
    """
    errors = Errors()
    over = ", ".join(several)
    with errors:
        if out is None and plot is None:
            repair = "write --out table.csv or --out table.parquet, or --plot picture.svg"
            raise UsageError("no table and no picture is named", where="--out", repair=repair)
    with errors:
        if out is not None:
            check_target(Path(out))
    with errors:
        check_targets(None, plot)
    with errors:
        plan = Plan(Path(problem), over, columns, way="each" if each else "auto", unbounded=yes)
        if plot is not None:
            drawn_columns(plan)
    raise_all(errors.found)
    way = plan.way
    target = Path(out or plot or "")
    if not run["quiet"]:
        write_message(f"{plan.grid.told()}; solved {way}")
    work = batch_of(plan.jobs, work_folder(target), Budget(timeout or _SECONDS, memory or _MEGABYTES), run)

    def write() -> str:
        table = SweepTable(plan, work)
        if out is not None:
            write_table(table, Path(out), decimals=decimals)
        if plot is not None:
            write_picture(table, Path(plot))
        discard_work(target)
        return table.told()

    finish(work, plan.blocks, quiet=run["quiet"], done=write, unit="blocks of points")
