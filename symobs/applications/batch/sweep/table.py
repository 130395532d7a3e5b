"""The table of a sweep as CSV or Parquet, written as it is read: memory does not grow with it."""

from __future__ import annotations

import csv
import hashlib
import json
from typing import TYPE_CHECKING, Any, Protocol

from symobs.applications.batch.jobs import fingerprint
from symobs.applications.batch.store import write_whole
from symobs.applications.batch.sweep.program import MARGINS_STATUS
from symobs.ground.errors import InputError, UsageError, reason_of

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

    from symobs.applications.batch.sweep.grid import Grid


class Swept(Protocol):
    """What a table is written from: a plan, its grid, and the blocks in the order of their points."""

    plan: Any

    @property
    def grid(self) -> Grid:
        """The points."""

    def blocks(self) -> Iterator[tuple[int, dict[str, Any]]]:
        """Yield the first index and the result of every block."""


SCHEMA = "symobs-sweep/1"
MOST_CSV_ROWS = 10**6
ROW_GROUP = 65_536
PART = 2**20
_LAST_COLUMNS = ("status", "case", "checked")


def check_target(out: Path) -> None:
    """Raise an error, before any work, for a table that cannot be written."""
    if not out.name:
        raise UsageError("no table is named", where="--out", repair="write for example --out table.csv")
    if out.suffix in {".parquet", ""}:
        _arrow()
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
            _write_parquet(table, out, decimals=decimals)
        else:
            _write_parts(table, out, decimals=decimals)
    except OSError as error:
        raise InputError(
            reason_of(error), where=str(out), repair="make room there, or name another place with --out"
        ) from None


def columns_of(table: Swept, first: int, result: dict[str, Any], *, decimals: bool) -> dict[str, list[Any]]:
    """Return a block as columns: the index, the names, the exact entries with their decimals, how it went."""
    count = len(result["status"])
    points = [table.grid.point(first + place) for place in range(count)]
    found: dict[str, list[Any]] = {"index": list(range(first, first + count))}
    exact = {name: [str(point[k]) for point in points] for k, name in enumerate(table.grid.names)}
    for name, column in {**exact, **result["columns"]}.items():
        found[name] = column
        if decimals and name != MARGINS_STATUS:
            found[f"{name}.d"] = nearest_of(name, {**result, "columns": {name: column}})
    checked = [status == "done" for status in result["status"]]
    return {**found, "status": result["status"], "case": result["case"], "checked": checked}


def nearest_of(name: str, result: dict[str, Any]) -> list[float | None]:
    """Return the binary numbers nearest to the entries of a column of a block."""
    known = result.get("nearest", {}).get(name, {})
    return [
        known[str(place)] if str(place) in known else None if entry is None else nearest(entry)
        for place, entry in enumerate(result["columns"][name])
    ]


def nearest(text: str) -> float | None:
    """Return the binary number nearest to an exact one, None beyond their range."""
    above, _, below = text.partition("/")
    try:
        if "." in text or text == "oo":
            return float(text.replace("oo", "inf"))
        return int(above) / int(below or 1)  # Python rounds the quotient of integers correctly
    except OverflowError:
        return None
    except ValueError:
        return _nearest_irrational(text)


def _nearest_irrational(text: str) -> float | None:
    from symobs.exact.floating.doubles import nearest_double  # noqa: PLC0415 - few tables have such numbers
    from symobs.formula.expression import parse_scalar  # noqa: PLC0415

    try:
        return nearest_double(parse_scalar(text, {}, functions=True))
    except (InputError, ValueError):
        return None


def _header(table: Swept, *, decimals: bool) -> list[str]:
    exact = [*table.grid.names, *table.plan.columns]
    named = [
        each for name in exact for each in ((name, f"{name}.d") if decimals and name != MARGINS_STATUS else (name,))
    ]
    return ["index", *named, *_LAST_COLUMNS]


def _write_csv(table: Swept, out: Path, *, decimals: bool) -> None:
    if table.grid.size > MOST_CSV_ROWS:
        repair = "write .parquet, or a folder"
        raise InputError(f"{table.grid.size} rows are too many for one CSV file", where="--out", repair=repair)
    temporary = out.with_name(f".{out.name}.tmp")
    try:
        with temporary.open("w", encoding="utf-8", newline="") as stream:
            lines = csv.writer(stream, lineterminator="\n")
            lines.writerow(_header(table, decimals=decimals))
            for first, result in table.blocks():
                columns = columns_of(table, first, result, decimals=decimals)
                lines.writerows(zip(*columns.values(), strict=True))
        temporary.replace(out)
    finally:
        temporary.unlink(missing_ok=True)


# -- Arrow and Parquet ------------------------------------------------------------------------------------------------


def _arrow() -> Any:
    try:
        import pyarrow as pa
        import pyarrow.parquet
    except ImportError:
        repair = "install it with pip install 'symobs[table]', or write .csv"
        raise InputError("pyarrow is not installed", where="--out", repair=repair) from None
    return pa


def _schema(table: Swept, *, decimals: bool) -> Any:
    pa = _arrow()
    exact = [*table.grid.names, *table.plan.columns]
    fields = [pa.field("index", pa.int64())]
    for name in exact:
        fields.append(pa.field(name, pa.string()))
        if decimals and name != MARGINS_STATUS:
            fields.append(pa.field(f"{name}.d", pa.float64()))
    fields += [pa.field("status", pa.string()), pa.field("case", pa.int32()), pa.field("checked", pa.bool_())]
    told = {"schema": SCHEMA, "fingerprint": fingerprint(), "way": table.plan.way}
    told["problem"] = json.dumps(table.plan.tables, sort_keys=True, ensure_ascii=False)
    told["over"] = json.dumps(_over(table))
    return pa.schema(fields, metadata=told)


def _over(table: Swept) -> list[Any]:
    return [axis.data for axis in table.grid.axes]


def arrow_batches(table: Swept, *, decimals: bool) -> Iterator[Any]:
    """Yield the table in record batches, a block each."""
    pa = _arrow()
    schema = _schema(table, decimals=decimals)
    for first, result in table.blocks():
        columns = columns_of(table, first, result, decimals=decimals)
        arrays = [pa.array(columns[field.name], field.type) for field in schema]
        yield pa.record_batch(arrays, schema=schema)


def arrow_table(table: Swept, *, decimals: bool) -> Any:
    """Return the whole table in memory."""
    pa = _arrow()
    return pa.Table.from_batches(arrow_batches(table, decimals=decimals), schema=_schema(table, decimals=decimals))


def _write_parquet(table: Swept, out: Path, *, decimals: bool) -> None:
    temporary = out.with_name(f".{out.name}.tmp")
    try:
        _one_file(arrow_batches(table, decimals=decimals), temporary, _schema(table, decimals=decimals))
        temporary.replace(out)
    finally:
        temporary.unlink(missing_ok=True)


def _one_file(batches: Iterator[Any], place: Path, schema: Any) -> None:
    """Write record batches in groups of rows."""
    pa = _arrow()
    with pa.parquet.ParquetWriter(place, schema, compression="zstd") as writer:
        waiting: list[Any] = []
        for batch in batches:
            waiting.append(batch)
            if sum(each.num_rows for each in waiting) >= ROW_GROUP:
                writer.write_table(pa.Table.from_batches(waiting, schema=schema), row_group_size=ROW_GROUP)
                waiting = []
        if waiting:
            writer.write_table(pa.Table.from_batches(waiting, schema=schema), row_group_size=ROW_GROUP)


def _write_parts(table: Swept, out: Path, *, decimals: bool) -> None:
    """Write parts of equal length in the order of their points, and what they are last."""
    out.mkdir(exist_ok=True)
    schema, batches = _schema(table, decimals=decimals), arrow_batches(table, decimals=decimals)
    parts: dict[str, Any] = {}
    for number in range(-(-table.grid.size // PART)):
        rows = min(PART, table.grid.size - number * PART)
        name = f"part-{number:05}.parquet"
        temporary = out / f".{name}.tmp"
        _one_file(_taken(batches, rows), temporary, schema)
        temporary.replace(out / name)
        parts[name] = {"rows": rows, "sha256": hashlib.sha256((out / name).read_bytes()).hexdigest()}
    told = {
        "schema": SCHEMA,
        "fingerprint": fingerprint(),
        "over": _over(table),
        "columns": [*schema.names],
        "parts": parts,
    }
    write_whole(out / "manifest.json", [(json.dumps(told, indent=2, sort_keys=True) + "\n").encode()])


def _taken(batches: Iterator[Any], rows: int) -> Iterator[Any]:
    """Yield batches until they have so many rows; blocks divide parts."""
    while rows > 0:
        batch = next(batches)
        rows -= batch.num_rows
        yield batch
