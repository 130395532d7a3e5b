"""The table of a sweep as CSV or Parquet, written as it is read: memory does not grow with it."""

from __future__ import annotations

import csv
import hashlib
import json
import random
import re
import signal
from collections.abc import Iterable, Mapping
from contextlib import contextmanager, suppress
from fractions import Fraction
from functools import lru_cache
from math import prod
from typing import TYPE_CHECKING, Any, Protocol

from symobs.applications.batch.jobs import canonical, fingerprint, read_payload
from symobs.applications.batch.recheck import Beyond, fault_at
from symobs.applications.batch.solving import given_for
from symobs.applications.batch.store import write_whole
from symobs.applications.batch.sweep.program import MARGINS, MARGINS_STATUS, Program
from symobs.exact import Matrix, RealNumber, Scalar
from symobs.exact.algebraic.loop_distances import nearest_double
from symobs.exact.core.generators import substitute
from symobs.ground.dataclass import dataclass
from symobs.ground.errors import BudgetExceeded, InputError, ProblemErrors, SymobsError, UsageError, reason_of
from symobs.proof.derivation.figures_check import ALLOWS
from symobs.tasks.analysis.stability_region.margins import NotRational, margins_of

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence
    from pathlib import Path


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
    from symobs.exact.floating.sampled import nearest_double  # noqa: PLC0415 - few tables have such numbers
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


# Grids of points: names with exact values each, `l=0.1:0.1:10, m=[1,2,5]`; the last name runs fastest.


#: More points need somebody who says that they are meant.
MOST_POINTS = 10**8
_ENTRY = re.compile(r"\s*([A-Za-z][A-Za-z0-9_]*)\s*=\s*(.+?)\s*", re.DOTALL)
_EXAMPLE = "write for example l=0.1:0.1:10, m=[1, 2, 5], k=0:1/11 (11 points) or g=decade(1e-3:1e3)"


@dataclass
class Axis:
    """A name and its values: a start, a step and a count, or a list."""

    name: str
    count: int
    start: Fraction = Fraction(0)
    step: Fraction = Fraction(0)
    listed: tuple[Fraction, ...] = ()

    def at(self, place: int) -> Fraction:
        """Return the value at a place, counted from 0."""
        return self.listed[place] if self.listed else self.start + place * self.step

    @property
    def data(self) -> list[Any]:
        """The axis as plain JSON."""
        return [self.name, self.count, str(self.start), str(self.step), [str(value) for value in self.listed]]

    @staticmethod
    def of(data: Any) -> Axis:
        """Return the axis of plain JSON."""
        name, count, start, step, listed = data
        return Axis(name, int(count), Fraction(start), Fraction(step), tuple(map(Fraction, listed)))


@dataclass
class Grid:
    """The points of a sweep."""

    axes: tuple[Axis, ...]

    @property
    def names(self) -> tuple[str, ...]:
        """The names, the fastest last."""
        return tuple(axis.name for axis in self.axes)

    @property
    def size(self) -> int:
        """How many points there are."""
        return prod(axis.count for axis in self.axes)

    def point(self, index: int) -> tuple[Fraction, ...]:
        """Return the point of an index, counted from 0."""
        places: list[Fraction] = []
        for axis in reversed(self.axes):
            index, place = divmod(index, axis.count)
            places.append(axis.at(place))
        return tuple(reversed(places))

    def told(self) -> str:
        """Return the count, the first and the last value of every name."""
        parts = (f"{a.name}: {a.count} from {a.at(0)} to {a.at(a.count - 1)}" for a in self.axes)
        return f"{self.size} points; {'; '.join(parts)}"


def read_grid(over: str | Mapping[str, Any], signs: Mapping[str, str], *, unbounded: bool = False) -> Grid:
    """Return the grid of a text, or of a mapping from names to values; raises all its errors together.

    Every name must be one of `signs`, and every value must have that sign.
    """
    entries = _entries(over) if isinstance(over, str) else list(over.items())
    axes: list[Axis] = []
    errors: list[SymobsError] = []
    for name, given in entries:
        try:
            if name in {axis.name for axis in axes}:
                raise _wrong(name, "it stands twice", "name it once")
            axes.append(_require_signs(_axis(str(name), given), signs))
        except InputError as error:
            errors.append(error)
    if not entries:
        errors.append(InputError("no name is swept", where="over", repair=_EXAMPLE))
    if errors:
        raise ProblemErrors(tuple(errors))
    grid = Grid(tuple(axes))
    if grid.size > MOST_POINTS and not unbounded:
        repair = "take larger steps, or say --yes"
        raise InputError(f"{grid.size} points, more than {MOST_POINTS}", where="over", repair=repair)
    return grid


def _entries(text: str) -> list[tuple[str, str]]:
    """Return the names and what is said of each; commas in brackets part no entries."""
    found: list[tuple[str, str]] = []
    for part in re.split(r",(?![^\[(]*[\])])", text):
        entry = _ENTRY.fullmatch(part)
        if entry is None:
            raise InputError(f'"{part.strip()[:40]}" is no name with values', where="over", repair=_EXAMPLE)
        found.append((entry[1], entry[2]))
    return found


def _axis(name: str, given: Any) -> Axis:
    if not isinstance(given, str):
        listed = given if isinstance(given, Iterable) else [given]
        return _listed(name, [_number(name, each) for each in listed])
    if given.startswith("[") and given.endswith("]"):
        return _listed(name, [_number(name, each) for each in re.split(r"[,\s]+", given[1:-1].strip())])
    if given.startswith("log("):
        raise _wrong(name, "values on a logarithmic scale are no fractions", "write decade(1e-3:1e3): 1, 2, 5, 10, …")
    if found := re.fullmatch(r"decade\((.+):(.+)\)", given):
        return _listed(name, _decades(name, _number(name, found[1]), _number(name, found[2])))
    parts = given.split(":")
    if len(parts) == 1:
        return _listed(name, [_number(name, given)])
    if len(parts) == 2:
        stop, slash, count = parts[1].rpartition("/")
        if not slash or not count.strip().isdigit() or int(count) < 2:
            raise _wrong(name, f'"{given[:40]}" has neither a step nor a count', _EXAMPLE)
        start, end, number = _number(name, parts[0]), _number(name, stop), int(count)
        return Axis(name, number, start, (end - start) / (number - 1))
    if len(parts) != 3:
        raise _wrong(name, f'"{given[:40]}" is no start:step:stop', _EXAMPLE)
    start, step, stop_at = (_number(name, part) for part in parts)
    if step == 0 or (stop_at - start) / step < 0:
        raise _wrong(name, f"steps of {step} do not lead from {start} to {stop_at}", "write start:step:stop")
    return Axis(name, int((stop_at - start) / step) + 1, start, step)


def _listed(name: str, values: list[Fraction]) -> Axis:
    if not values:
        raise _wrong(name, "it has no values", _EXAMPLE)
    return Axis(name, len(values), listed=tuple(values))


def _decades(name: str, low: Fraction, high: Fraction) -> list[Fraction]:
    if not 0 < low <= high:
        raise _wrong(name, f"there are no decades from {low} to {high}", "write decade(1e-3:1e3)")
    power = Fraction(1)
    while power > low:
        power /= 10
    while power * 10 <= low:
        power *= 10
    found: list[Fraction] = []
    while power <= high:
        found += [value for value in (power, 2 * power, 5 * power) if low <= value <= high]
        power *= 10
    return found


def _number(name: str, given: Any) -> Fraction:
    """Return an exact number; floats are refused."""
    if isinstance(given, (int, Fraction)) and not isinstance(given, bool):
        return Fraction(given)
    if isinstance(given, str) and len(given) <= 100 and not re.search(r"[eE][-+]?[0-9]{4}", given):
        try:
            return Fraction(given.strip().replace("\N{MINUS SIGN}", "-").replace(" ", ""))
        except (ValueError, ZeroDivisionError):
            pass
    raise _wrong(
        name,
        f"{str(given)[:40]!r} is not an exact number",
        'write 1/10, or "0.1" in quotes: decimals of texts are exact',
    )


def _require_signs(axis: Axis, signs: Mapping[str, str]) -> Axis:
    if axis.name not in signs:
        known = ", ".join(sorted(signs)) or "none"
        raise _wrong(axis.name, "it is not declared in [symbols]", f"declare it, or name one of {known}")
    ends = axis.listed or (axis.at(0), axis.at(axis.count - 1))
    wanted = signs[axis.name]
    wrong = [value for value in ends if not ALLOWS[wanted](value)]
    if wanted == "nonzero" and not axis.listed and axis.step and 0 <= -axis.start / axis.step < axis.count:
        place = -axis.start / axis.step
        wrong += [Fraction(0)] if place.denominator == 1 else []
    if wrong:
        raise _wrong(
            axis.name, f"it is declared {wanted}, and {wrong[0]} is not", "leave the value out, or declare another sign"
        )
    return axis


def _wrong(name: str, message: str, repair: str) -> InputError:
    return InputError(message, where=f"over.{name}", repair=repair)


# The work of a sweep: a block of consecutive points, each checked exactly.


#: Points of a block that are looked at again.
_LOOKED_AT = 3


def run(payload: Mapping[str, Any]) -> dict[str, Any]:
    """Return the row of a block: how each point went, its case, and the columns as exact texts."""
    grid, program = grid_of(payload), _program(canonical(payload["program"]))
    outer: tuple[Fraction, ...] | None = None
    rows = []
    for index in range(payload["first"], payload["first"] + payload["count"]):
        point = grid.point(index)
        if point[:-1] != outer:
            outer = point[:-1]
            program.line(outer)
        rows.append(program.at(point))
    whole = {name: [row.values[k] for row in rows] for k, name in enumerate(program.columns())}
    columns = {name: whole[name] for name in payload["columns"] if name in whole}
    result: dict[str, Any] = {
        "status": [row.status for row in rows],
        "case": [row.case for row in rows],
        "columns": columns,
    }
    if MARGINS_STATUS in payload["columns"]:
        result["nearest"] = _add_margins(columns, whole, program, grid, payload)
    return {"status": "undecided" if "undecided" in result["status"] else "done", "result": result}


def _add_margins(
    columns: dict[str, Any], whole: Mapping[str, list[Any]], program: Program, grid: Grid, payload: Mapping[str, Any]
) -> dict[str, dict[str, float]]:
    """Add the margins to the columns; return by column and place the binary numbers nearest to what is no fraction."""
    names = [name for name in (*MARGINS, MARGINS_STATUS) if name in payload["columns"]]
    columns |= {name: [None] * payload["count"] for name in names}
    nearest: dict[str, dict[str, float]] = {}
    for place in range(payload["count"]):
        entries = {name: column[place] for name, column in whole.items()}
        if None in entries.values():
            continue
        cells, doubles = cells_at(program, grid.point(payload["first"] + place), entries)
        for name in names:
            columns[name][place] = cells.get(name)
            if name in doubles:
                nearest.setdefault(name, {})[str(place)] = doubles[name]
    return nearest


def grid_of(payload: Mapping[str, Any]) -> Grid:
    """Return the grid of a block's data."""
    return Grid(tuple(Axis.of(axis) for axis in payload["over"]))


@lru_cache(maxsize=4)
def _program(text: str) -> Program:
    """Return the program of all blocks of a sweep: read once by a process."""
    data = read_payload(text)
    return Program(data["problem"], data["names"], data["answer"], with_F=data["with_F"])


def recheck(payload: Mapping[str, Any], row: Mapping[str, Any]) -> str | None:
    """Return what does not hold at some points of a block, in plain fractions; None where all that is looked at does."""
    if "result" not in row:
        return None
    result, grid = row["result"], grid_of(payload)
    program = _program(canonical(payload["program"]))
    given = given_for(program.problem, program.task)
    places = [k for k, status in enumerate(result["status"]) if status == "done"]
    drawn = random.Random(row["key"])  # noqa: S311 - no secret
    for place in drawn.sample(places, min(_LOOKED_AT, len(places))):
        point = grid.point(payload["first"] + place)
        here = dict(zip(grid.names, point, strict=True))
        answer = _answer(program, {name: column[place] for name, column in result["columns"].items()})
        try:
            found = fault_at(here, program.task.name, given, answer)
        except Beyond:
            continue
        if found is not None:
            return f"{found}, at {json.dumps({name: str(value) for name, value in here.items()})}"
    return None


def _answer(program: Program, cells: Mapping[str, str]) -> dict[str, Any]:
    """Return the matrices and F of a row of the table."""
    shapes = {"K": (program.m, program.n), "L": (program.n, program.p)}
    answer: dict[str, Any] = {}
    for gain in program.gains:
        rows, columns = shapes[gain]
        names = [[f"{gain}[{i + 1},{j + 1}]" for j in range(columns)] for i in range(rows)]
        if all(name in cells for row in names for name in row):
            answer[gain] = [[cells[name] for name in row] for row in names]
    parts = [[cells.get(f"F.{part}[{k}]") for k in range(program.n + 1)] for part in ("num", "den")]
    if all(entry is not None for part in parts for entry in part):
        above, below = (" + ".join(f"({c})*{program.variable}**{k}" for k, c in enumerate(part)) for part in parts)
        answer["F"] = f"({above})/({below})"
    return answer


# The margins of the loop of each point of a sweep, as cells of its table.


#: Seconds of the processor that a point is allowed.
_SECONDS = 2.0


def require_one_loop(program: Program) -> None:
    """Raise `UsageError` for a problem whose loop is no single one."""
    at, count = ("output", program.p) if program.gains == ("L",) else ("input", program.m)
    if count != 1:
        message = f"margins are those of a loop with one {at}, and there are {count}"
        raise UsageError(message, where="--columns", repair="leave the margins out, or take a plant with one")


def margins_at(program: Program, point: Sequence[Fraction], gains: Mapping[str, Matrix]) -> dict[str, Any]:
    """Return the margins of a point by column, exact numbers as real numbers, certain decimals as texts."""
    values = dict(zip(program.names, map(Scalar.of, point), strict=True))
    plant = program.problem.plant
    closed, opened = _polynomials(program, values, gains)
    found = margins_of(closed, opened, plant.variable, plant.dt)
    return found | {MARGINS_STATUS: "done" if "gain_up" in found else "unstable"}


def _polynomials(program: Program, values: Mapping[str, Scalar], gains: Mapping[str, Matrix]) -> tuple[Scalar, Scalar]:
    """Return P + N and P at a point."""
    m, s = program.problem.plant.matrices, program.variable
    there = {"A": True, "B": m.has_input, "C": m.has_output, "D": m.has_input and m.has_output}
    at = {name: substitute(getattr(m, name), values) for name, is_there in there.items() if is_there}
    A = at["A"]
    moved = [A - at["B"] @ gains["K"]] if "K" in gains else []
    moved += [A - gains["L"] @ at["C"]] if "L" in gains else []
    closed, opened = Scalar.of(1), A.characteristic_polynomial(s)
    for matrix in moved:
        closed *= matrix.characteristic_polynomial(s)
    if len(moved) == 2:
        K, L = gains["K"], gains["L"]
        own = moved[0] - L @ at["C"] + L @ at["D"] @ K
        opened *= own.characteristic_polynomial(s)
    return closed, opened


# -- cells ------------------------------------------------------------------------------------------------------------


def cells_at(
    program: Program, point: Sequence[Fraction], texts: Mapping[str, str]
) -> tuple[dict[str, str], dict[str, float]]:
    """Return the cells of a point, given those of its gains, and the binary numbers nearest to what is no fraction."""
    try:
        entries = {name: Fraction(text) for name, text in texts.items()}
    except ValueError:  # margins are those of loops with rational numbers
        return {MARGINS_STATUS: "undecided"}, {}
    shapes = {"K": (program.m, program.n), "L": (program.n, program.p)}
    gains = {
        gain: Matrix.of([[entries[f"{gain}[{i + 1},{j + 1}]"] for j in range(width)] for i in range(height)])
        for gain, (height, width) in shapes.items()
        if gain in program.gains
    }
    found: dict[str, Any] = {}
    with suppress(_TimeOver, NotRational, BudgetExceeded), _within(_SECONDS):
        found = margins_at(program, point, gains)
    if not found or None in found.values():
        return {MARGINS_STATUS: "undecided"}, {}
    numbers = {name: value for name, value in found.items() if isinstance(value, RealNumber)}
    doubles = {name: nearest_double(value) for name, value in numbers.items() if not value.is_rational}
    return {name: value.text() if name in numbers else value for name, value in found.items()}, doubles


class _TimeOver(BaseException):
    """Raised by the alarm; a BaseException so that `except Exception` cannot swallow it."""


@contextmanager
def _within(seconds: float) -> Iterator[None]:
    """Raise `_TimeOver` when so much time of the processor is used; without a limit where the system has no such alarm."""

    def leave(_: int, __: object) -> None:
        raise _TimeOver

    try:
        before = signal.signal(signal.SIGVTALRM, leave)
    except (AttributeError, ValueError):  # Windows, or a thread: that has no limits
        yield
        return
    signal.setitimer(signal.ITIMER_VIRTUAL, seconds)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_VIRTUAL, 0)
        signal.signal(signal.SIGVTALRM, before)
