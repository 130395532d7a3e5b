"""The table of a sweep as Arrow batches and as Parquet, one file or parts."""

from __future__ import annotations

import hashlib
import json
from typing import TYPE_CHECKING, Any

from symobs.applications.batch.jobs import fingerprint
from symobs.applications.batch.store import write_whole
from symobs.applications.batch.sweep.columns import PART, ROW_GROUP, SCHEMA, Swept, columns_of
from symobs.applications.batch.sweep.program import MARGINS_STATUS
from symobs.ground.errors import InputError

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path


def arrow() -> Any:
    """Return pyarrow; raises `InputError` where it is not installed."""
    try:
        import pyarrow as pa
        import pyarrow.parquet
    except ImportError:
        repair = "install it with pip install 'symobs[table]', or write .csv"
        raise InputError("pyarrow is not installed", where="--out", repair=repair) from None
    return pa


def _schema(table: Swept, *, decimals: bool) -> Any:
    pa = arrow()
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
    pa = arrow()
    schema = _schema(table, decimals=decimals)
    for first, result in table.blocks():
        columns = columns_of(table, first, result, decimals=decimals)
        arrays = [pa.array(columns[field.name], field.type) for field in schema]
        yield pa.record_batch(arrays, schema=schema)


def arrow_table(table: Swept, *, decimals: bool) -> Any:
    """Return the whole table in memory."""
    pa = arrow()
    return pa.Table.from_batches(arrow_batches(table, decimals=decimals), schema=_schema(table, decimals=decimals))


def write_parquet(table: Swept, out: Path, *, decimals: bool) -> None:
    """Write one Parquet file."""
    temporary = out.with_name(f".{out.name}.tmp")
    try:
        _one_file(arrow_batches(table, decimals=decimals), temporary, _schema(table, decimals=decimals))
        temporary.replace(out)
    finally:
        temporary.unlink(missing_ok=True)


def _one_file(batches: Iterator[Any], place: Path, schema: Any) -> None:
    """Write record batches in groups of rows."""
    pa = arrow()
    with pa.parquet.ParquetWriter(place, schema, compression="zstd") as writer:
        waiting: list[Any] = []
        for batch in batches:
            waiting.append(batch)
            if sum(each.num_rows for each in waiting) >= ROW_GROUP:
                writer.write_table(pa.Table.from_batches(waiting, schema=schema), row_group_size=ROW_GROUP)
                waiting = []
        if waiting:
            writer.write_table(pa.Table.from_batches(waiting, schema=schema), row_group_size=ROW_GROUP)


def write_parts(table: Swept, out: Path, *, decimals: bool) -> None:
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
