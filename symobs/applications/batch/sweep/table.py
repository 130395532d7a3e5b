"""The table of a sweep as CSV or Parquet, written as it is read: memory does not grow with it."""

from __future__ import annotations

import csv
from typing import TYPE_CHECKING

from symobs.applications.batch.sweep.arrow import arrow, write_parquet, write_parts
from symobs.applications.batch.sweep.columns import Swept, columns_of, header
from symobs.ground.errors import InputError, UsageError, reason_of

if TYPE_CHECKING:
    from pathlib import Path


MOST_CSV_ROWS = 10**6


def check_target(out: Path) -> None:
    """Raise an error, before any work, for a table that cannot be written."""
    if not out.name:
        raise UsageError("no table is named", where="--out", repair="write for example --out table.csv")
    if out.suffix in {".parquet", ""}:
        arrow()
    if out.suffix not in {".csv", ".parquet", ""}:
        raise UsageError(
            f'the suffix "{out.suffix}" names no kind of table',
            where="--out",
            repair="write .csv, .parquet or a folder",
        )
    if not out.absolute().parent.is_dir():
        raise InputError(
            f"there is no folder {out.absolute().parent}", where="--out", repair="make it, or name another"
        )


def write_table(table: Swept, out: Path, *, decimals: bool = False) -> None:
    """Write the table whole or not at all: .csv, .parquet, or a folder of parts with a manifest."""
    try:
        if out.suffix == ".csv":
            _write_csv(table, out, decimals=decimals)
        elif out.suffix == ".parquet":
            write_parquet(table, out, decimals=decimals)
        else:
            write_parts(table, out, decimals=decimals)
    except OSError as error:
        raise InputError(
            reason_of(error), where=str(out), repair="make room there, or name another place with --out"
        ) from None


def _write_csv(table: Swept, out: Path, *, decimals: bool) -> None:
    if table.grid.size > MOST_CSV_ROWS:
        repair = "write .parquet, or a folder"
        raise InputError(f"{table.grid.size} rows are too many for one CSV file", where="--out", repair=repair)
    temporary = out.with_name(f".{out.name}.tmp")
    try:
        with temporary.open("w", encoding="utf-8", newline="") as stream:
            lines = csv.writer(stream, lineterminator="\n")
            lines.writerow(header(table, decimals=decimals))
            for first, result in table.blocks():
                columns = columns_of(table, first, result, decimals=decimals)
                lines.writerows(zip(*columns.values(), strict=True))
        temporary.replace(out)
    finally:
        temporary.unlink(missing_ok=True)
