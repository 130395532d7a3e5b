"""From the text of a file to its tables.  What would cost a parser too much is refused before it is parsed."""

from __future__ import annotations

import json
import re
import tomllib
from collections.abc import Callable, Collection, Mapping
from dataclasses import replace
from difflib import get_close_matches
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeGuard
from unicodedata import category

from symobs.exact import Scalar
from symobs.exact.algebraic.real_algebraic import roots_of_scalar
from symobs.exact.core.generators import PI, function_named
from symobs.formula.convention import STANDARD, Convention
from symobs.formula.expression import declared_name, parse_polynomial, parse_scalar, typed_name
from symobs.formula.expression.source import shown
from symobs.formula.parser_limits import refuse_costly
from symobs.ground.errors import InputError, ProblemErrors, SymobsError, reason_of
from symobs.problem.expect import COUNTED
from symobs.system.reading import require_known
from symobs.tasks.result.in_convention import names_in

if TYPE_CHECKING:
    from contextlib import AbstractContextManager

    from symobs.system import Symbols


MAX_BYTES = 256 * 1024


def is_text(given: str) -> bool:
    """Return whether this is the text of a file rather than its path."""
    return "\n" in given or "=" in given or given.lstrip().startswith("{") or not given.strip()


def text_of(given: str | Path, limit: int = MAX_BYTES) -> tuple[str, Path | None]:
    """Return the text of a path, with its folder, or a text itself.  Raises `InputError` where it cannot be read."""
    if isinstance(given, str) and is_text(given):
        return given, None
    path = Path(given)
    try:
        with path.open("rb") as stream:
            return stream.read(limit + 1).decode("utf-8-sig"), path.parent
    except (OSError, ValueError) as error:
        repair = "give the path of a file, or its text"
        raise InputError(reason_of(error), where=shown(str(given), 200), repair=repair) from None


class Decimal(str):
    """A decimal of a file, kept as its text, so that it is read exactly."""

    __slots__ = ()


def parse(text: str, where: str = "problem") -> dict[str, Any]:
    """Return the file's tables, decimals as `Decimal` texts.  Raises `ProblemErrors`."""
    text = text.removeprefix("\ufeff")
    try:
        refuse_costly(text, MAX_BYTES)
        return _parse_json(text) if text.lstrip().startswith("{") else _parse_toml(text)
    except InputError as error:
        error.where = f"{shown(where, 200)}, {error.where}" if error.where else shown(where, 200)
        raise ProblemErrors((error,)) from None


def _parse_json(text: str) -> dict[str, Any]:
    def refuse_constant(name: str) -> Any:
        raise InputError(f"{name} is not a number", repair="write a finite exact value")

    def unique(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
        found: dict[str, Any] = {}
        for key, value in pairs:
            if key in found:
                raise InputError(f'the key "{shown(key, 40)}" stands twice in one table', repair="keep one of them")
            found[key] = value
        return found

    try:
        data: dict[str, Any] = json.loads(
            text, parse_float=Decimal, parse_constant=refuse_constant, object_pairs_hook=unique
        )
    except json.JSONDecodeError as error:
        place = f"line {error.lineno}, column {error.colno}"
        repair = "check quotes, commas and brackets there"
        raise InputError(f"this is not JSON: {error.msg}", where=place, repair=repair) from None
    return data


def _parse_toml(text: str) -> dict[str, Any]:
    try:
        return tomllib.loads(text, parse_float=Decimal)
    except ValueError as error:  # a TOMLDecodeError, or a date that does not exist
        message, _, place = str(error).partition(" (at ")
        place = place.rstrip(")").replace("end of document", "its end")
        number = re.match("line ([0-9]+)", place)
        line = text.split("\n")[int(number[1]) - 1] if number else ""
        repair = _toml_repair(message, line, text)
        raise InputError(f"this is not TOML: {message}", where=place, repair=repair) from None


def _toml_repair(message: str, line: str, text: str) -> str:
    lines = (each.strip() for each in text.split("\n"))
    beginning = next((each for each in lines if each and not each.startswith("#")), "")
    if re.match(r"---|- |[A-Za-z_]+:(\s|$)", beginning):
        return "YAML is not read: write `key = value` lines under [tables]"
    if re.match(r'\[\s*["{\d]|\[\s*$', beginning):
        return "a problem in JSON begins with {"
    if "overwrite" in message or "twice" in message:
        return "keep one of them"
    if re.search("[“”„‟«»]", line):
        return 'write straight quotes: "'
    if "newline" not in message and (message.startswith("Illegal character '\\n'") or "Unterminated" in message):
        return 'close the quotes on their line; write a matrix on one line, with ; between its rows, "[0 1; 0 -1]"'
    if "\\" in message and "\\" in line:
        return "write LaTeX in single quotes: A = '\\begin{bmatrix} … \\end{bmatrix}'"
    if re.match(r"\s*[\w.]+\s*:", line):
        return "write = in place of the colon"
    if re.search(r"%(?!\S)|%\s", line.rpartition('"')[2]):
        return "a remark begins with #"
    brackets = re.search(r"""=\s*\[([^"']*)""", line)
    if brackets and re.search(r"""[^,;\s\[][ ;]+[-+\w(]""", brackets[1]):
        return 'write commas between the entries, or the matrix in quotes: "[0 1; 0 -1]"'
    if brackets and re.search(r"[A-Za-z]", brackets[1]):
        return 'write what has letters in quotes: [-2, "-1+i", "-omega"]'
    return "write `key = value` lines under [tables], texts in quotes"


def came(value: object) -> str:
    """Return the kind of a value of a file, in words."""
    if value is None:
        return "null"
    words = {bool: "true or false", Decimal: "a number", int: "a number", str: "a text", list: "a list"}
    return "a table" if isinstance(value, Mapping) else words.get(type(value), "a date or a time")


# The constants of a problem file: names for numbers, `r = "sqrt(3)"` or `c = "cos(theta)"`, that texts may use.


_MAX_CONSTANTS = 100


def with_constants(table: Mapping[str, Any], symbols: Symbols, errors: AbstractContextManager[Any, Any]) -> Symbols:
    """Return the symbols with named constants; `errors` collects the faults."""
    for name, value in list(table.items())[: _MAX_CONSTANTS + 1]:
        before = symbols
        with errors:
            symbols = _with_constant(name, value, symbols)
        if symbols is before and name not in symbols.signs:  # what uses it is no second error
            symbols = replace(symbols, constants={**symbols.constants, name: Scalar.of(1)})
    return symbols


def _with_constant(name: str, value: Any, symbols: Symbols) -> Symbols:
    """Return the symbols with one more name for a number; those before it may occur in its text.

    Raises `InputError` where the name is a symbol too, and where the value is no number.
    """
    where, known = f"constants.{shown(name, 40)}", symbols.constants
    name = declared_name(typed_name(name), where)
    if len(known) == _MAX_CONSTANTS:
        message = f"more than {_MAX_CONSTANTS} constants are declared"
        raise InputError(message, where="constants", repair="write the numbers themselves")
    if name in symbols.signs:
        raise InputError(f"{name} is declared as a symbol, too", where=where, repair="keep one of the two declarations")
    if not isinstance(value, (str, int)) or isinstance(value, bool):
        raise InputError(f"a number is expected, but {came(value)} came", where=where, repair='write r = "sqrt(3)"')
    found = _counted(value, where) or parse_scalar(value, {**symbols.signs, **known}, where=where, functions=True)
    if any(function_named(part) is None for part in found.names - {PI}):
        message = f"{name} contains a symbol that is not inside a function, and a constant is a number"
        raise InputError(message, where=where, repair="write the expression where it is needed")
    require_known([found], symbols.signs, where)
    return replace(symbols, constants={**known, name: found})


def _counted(value: object, where: str) -> Scalar | None:
    """Return the real root that `CRootOf(x^3 - x - 1, 0)` names, counted from the least; None for another text."""
    written = COUNTED.fullmatch(value) if isinstance(value, str) else None
    if written is None:
        return None
    roots = roots_of_scalar(parse_polynomial(written[1], "x", {}, where=where), "x")
    if int(written[2]) >= len(roots):
        message = f"the polynomial has {len(roots)} real roots, and the first of them is number 0"
        raise InputError(message, where=where, repair='write r = "CRootOf(x^3 - x - 1, 0)"')
    return roots[int(written[2])].scalar()


# The errors of a file, noted at their places until all are known, and the reading of its tables and texts.


_MAX_TEXT = 2000
_MAX_UNKNOWN = 20


class Errors:
    """Collects errors: `with errors:` keeps what its block raises and goes on behind it."""

    def __init__(self) -> None:
        self.found: list[SymobsError] = []

    def note(self, message: str, where: str, repair: str) -> None:
        """Keep an error that was not raised."""
        self.found.append(InputError(message, where=where, repair=repair))

    def __enter__(self) -> None:
        pass

    def __exit__(self, _kind: object, error: BaseException | None, _traceback: object) -> bool:
        self.found += error.errors if isinstance(error, ProblemErrors) else ()
        if isinstance(error, SymobsError) and not isinstance(error, ProblemErrors):
            self.found.append(error)
        return isinstance(error, SymobsError)

    def add_elsewhere(self, others: Errors) -> None:
        """Add errors of the others at places without an error."""
        taken = {error.where for error in self.found}
        self.found += [error for error in others.found if error.where not in taken]

    def move(self, places: Mapping[str, str]) -> None:
        """Say of every error where it stands in the file."""
        for error in self.found:
            whole, cell = re.fullmatch(r"([^\[]*)(.*)", error.where, re.DOTALL).groups()  # type: ignore[union-attr]
            error.where = places.get(whole, whole) + cell

    def together(self, convention: Convention = STANDARD) -> ProblemErrors:
        """Return all of them, each once, at places named as the convention names them."""
        for own, (name, _) in names_in(convention).items():
            for error in self.found:
                error.where = re.sub(rf"^specification\.{name}\b", f"specification.{own}", error.where)
        return ProblemErrors(tuple({str(error): error for error in self.found}.values()))


def nearest(key: str, known: Collection[str]) -> str | None:
    """Return the known name that a key may have meant."""
    return next(iter(get_close_matches(key[:64], known, 1)), None)


def _meant(key: str, known: Collection[str], _where: str) -> str:
    near = nearest(key, known)
    return f"did you mean {near}?" if near else f"known keys are {', '.join(known)}"


def report_unknown(
    table: Mapping[str, Any],
    known: Collection[str],
    where: str,
    errors: Errors,
    repair: Callable[[str, Collection[str], str], str] = _meant,
) -> None:
    """Note every key that is not known, with the key or the place that was meant."""
    unknown = [key for key in table if key not in known]
    for key in unknown[:_MAX_UNKNOWN]:
        errors.note("unknown key", f"{where}.{shown(key, 40)}".lstrip("."), repair(key, known, where))
    if len(unknown) > _MAX_UNKNOWN:
        errors.note(f"{len(unknown) - _MAX_UNKNOWN} more unknown keys", where or "the file", "leave them out")


def table_of(data: Mapping[str, Any], name: str, errors: Errors) -> Mapping[str, Any]:
    """Return a table of the file, an empty one where it is missing or no table."""
    value = data.get(name, {})
    return value if is_table(value, name, errors) else {}


def is_table(value: object, where: str, errors: Errors) -> TypeGuard[Mapping[str, Any]]:
    """Return whether a value is a table, and note it if not."""
    if isinstance(value, Mapping):
        return True
    header = re.sub(r"^(.*)\[[0-9]+\]$", r"[\1]", where)
    repair = "write { … }" if "]." in header else f"write [{header}] and its keys below"
    errors.note(f"a table is expected, but {came(value)} came", where, repair)
    return False


def checked_text(table: Mapping[str, Any], name: str, errors: Errors) -> str:
    """Return a text of the file, an empty one where it is missing."""
    value = table.get(name, "")
    check_text(value, name, errors)
    return value if isinstance(value, str) and not isinstance(value, Decimal) else ""


def check_text(value: object, where: str, errors: Errors) -> None:
    """Note a value that is no text, too long, or not printable."""
    if not isinstance(value, str) or isinstance(value, Decimal):
        errors.note(f"a text is expected, but {came(value)} came", where, "write it in quotes")
        return
    if len(value) > _MAX_TEXT:
        errors.note(f"the text has more than {_MAX_TEXT} characters", where, "shorten it")
    for character in value[:_MAX_TEXT]:
        if category(character) in {"Cc", "Cs"} and character not in "\t\n":
            errors.note(f"the character U+{ord(character):04X} cannot be printed", where, "leave it out")
            break
