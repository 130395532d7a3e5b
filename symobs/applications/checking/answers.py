"""What a student hands in: the answer file, and its values."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterable, Mapping, Sequence
from contextlib import suppress
from dataclasses import field
from fractions import Fraction
from itertools import takewhile
from typing import Any, NamedTuple

from symobs.applications.checking.handwriting import (
    as_entries,
    coefficients_of,
    plain_line,
    readable,
    squashed,
    without_drawings,
    without_marks,
    without_words,
)
from symobs.applications.checking.wording import PROPERTIES, Said, in_inequalities, verdict_of, what_is_said
from symobs.exact import Factored, Matrix, Scalar
from symobs.formula.expression import declared_name, parse_matrix, parse_scalar, without_latex
from symobs.formula.expression.parse import ROW, ROWS
from symobs.formula.expression.source import shown
from symobs.ground.dataclass import dataclass
from symobs.ground.errors import InputError, ProblemErrors, SymobsError
from symobs.problem import parse
from symobs.problem.expect import factored_table
from symobs.problem.landmarks import without_landmarks

# Definitions as students write them: NAME = value, chains of equal values, several of them on a line.


_NAME = r"[ \t]*([A-Za-z\u0391-\u03c9][A-Za-z0-9_.\u2080-\u2089]*)((?:[ \t]*\([szt]\))?)[ \t]*(?::=|==?|≈)(?![=<>])"
#: What gives a letter its value, or a function of s, z or t: F(s) = 1/s.
_DEFINITION = re.compile(rf"{_NAME}(.*)", re.DOTALL)
_NEXT = re.compile(rf"(?:[;,]|\b(?:and|und|with|mit)\b)(?={_NAME})")
_EQUALS = re.compile(r"(?<![<>!=:])==?(?![=<>])")
_IS_INEQUALITY = re.compile(r"[<>]|!=")


class Definition(NamedTuple):
    """A letter, its argument as it was written, and the text of its value; `is_chain` where equal values led to it."""

    name: str
    argument: str
    value: str
    is_chain: bool


def statements(line: str) -> list[str]:
    """Return the definitions that stand on one line behind each other: K = [4 3]; L = [19; 81]."""
    return [line] if " where " in line else _apart(_NEXT, line)


def definition(line: str) -> Definition | None:
    """Return the definition that a line is; its value is the last member of a chain, or the one before a last 0."""
    found = _DEFINITION.fullmatch(line)
    if not found:
        return None
    name, argument, right = found.groups()
    said = right.partition(" where ")[0]
    members = [said] if _IS_INEQUALITY.search(said) else [_exactly(member) for member in _apart(_EQUALS, said)]
    if len(members) > 1 and members[-1] == "0":
        members.pop()
        return Definition(name, argument, members[-1], is_chain=True)
    # behind a last "=" nothing stands: the whole cannot be read, and takes the place of what was written before
    return Definition(name, argument, members[-1] or right, is_chain=len(members) > 1 or said != right)


def _exactly(member: str) -> str:
    """Return a member of a chain without its decimals, 1/3 ≈ 0.333, and the comma behind it."""
    return (member.partition("≈")[0].strip() or member.strip()).rstrip(", ")


def value_of(letter: str, text: str) -> str:
    """Return the value in a text that defines a letter; another text as it is."""
    found = definition(text) if len(statements(text)) == 1 else None
    return found.value if found and found.name.rpartition(".")[2] == letter else text


def is_of_conditions(line: str) -> bool:
    """Return whether a line has inequalities and no equation."""
    return bool(_IS_INEQUALITY.search(line)) and not _EQUALS.search(line) and " where " not in line


def _apart(separator: re.Pattern[str], text: str) -> list[str]:
    """Return the parts of a text between separators that stand in no bracket."""
    parts, start, seen, depth = [], 0, 0, 0
    for found in separator.finditer(text):
        between, seen = text[seen : found.start()], found.start()
        depth += sum(map(between.count, "([{")) - sum(map(between.count, ")]}"))
        if depth == 0:
            parts.append(text[start : found.start()])
            start = found.end()
    return [*parts, text[start:]]


# The values of an answer: texts, lists and numbers, always exact.


#: A decimal number, not a part of a name or of a longer number.
DECIMAL = re.compile(
    r"(?<![A-Za-z0-9_.])(?:(?:[0-9]+\.[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]{1,3})?|[0-9]+[eE][+-]?[0-9]{1,3})(?![A-Za-z0-9_.])"
)
#: A decimal comma stands between two digits, with no space around it.
_COMMA = re.compile(r"(?<![0-9.,])([0-9]+),([0-9]+)(?![0-9.,])")


#: What editors and web pages put in place of the minus and of nothing.
_TYPED = str.maketrans(
    dict.fromkeys("\u2212\u2010\u2011\u2013", "-")
    | dict.fromkeys("\u200b\u2060\ufeff")
    | {"\u00a0": " "}
    | {"\u2264": "<=", "\u2265": ">=", "\u2260": "!="}
)


#: What NumPy and SymPy call a matrix.
_CALL = re.compile(
    r"(?:[A-Za-z]+\.)?(array|asarray|matrix|Matrix|ImmutableMatrix)\(\s*(\[.*\])\s*(?:,\s*dtype\s*=\s*[\w.]+\s*)?\)",
    re.DOTALL,
)


#: A matrix of SymPy by its size and the entries of its rows.
_OF_SIZE = re.compile(r"(?:[A-Za-z]+\.)?(?:Immutable)?Matrix\(\s*(\d{1,2})\s*,\s*(\d{1,2})\s*,\s*\[([^][;]*)\]\s*\)")
_FLAT = re.compile(r"\[([^][;]*)\]")
_QUOTED = re.compile(r"""(["'])([^"']*)\1""")
_QUOTE, _ORDER = re.compile(r"[\"']"), re.compile(r"[<>]")


_BETWEEN = re.compile(r"\s*(?:[,;\n]|&&|\u2227|\b(?:and|und)\b)\s*")

_OPERATOR = re.compile(r"!=|<=|>=|<|>")


def as_conditions(value: Any) -> Any:
    """Return the conditions of a text as a list: a != 1 and a != 2, or a != 1, 2."""
    if isinstance(value, list):
        return [each for entry in value for each in as_conditions(entry)]
    if not isinstance(value, str):
        return [value]
    text = in_inequalities(value).strip().strip("[]").replace("<>", "!=").replace("/=", "!=")
    found: list[str] = []
    for part in filter(None, _BETWEEN.split(text)):
        left = _OPERATOR.split(found[-1])[0] if found else ""
        found.append(part if _OPERATOR.search(part) or not left else f"{left.strip()} != {part}")
    return found


#: What stands between a value and the conditions under which it is that.
_WHERE = re.compile(r"\s+(?:where|for|if|für|falls|wenn)\s+(?=.*(?:[<>]|!=))")


def typed(text: str) -> str:
    """Return a text with the minus, the spaces and the byte order mark of ASCII."""
    return text.translate(_TYPED)


def as_value(text: str) -> str | list[str]:
    """Return the text of a value without its quotes and the semicolon that ends a statement, and rows in brackets as rows.

    A vector of NumPy, which is neither row nor column, is the list of its entries; one of SymPy is a column.
    """
    value = text.strip().removesuffix(";").rstrip()
    if quoted := _QUOTED.fullmatch(value):
        value = quoted[2].strip()
    value = readable(value)
    if sized := _OF_SIZE.fullmatch(value):
        columns, entries = int(sized[2]), sized[3].split(",")
        if len(entries) != int(sized[1]) * columns or not columns:
            return value
        return f"[{'; '.join(', '.join(entries[i : i + columns]) for i in range(0, len(entries), columns))}]"
    called = _CALL.fullmatch(value)
    flat = _FLAT.fullmatch(called[2]) if called else None
    if called and flat:
        entries = [entry.strip() for entry in flat[1].split(",") if entry.strip()]
        if called[1] in {"array", "asarray"}:
            return entries
        return f"[{(', ' if called[1] == 'matrix' else '; ').join(entries)}]"
    quote = _QUOTE.search(value)
    if quote and _ORDER.search(value, quote.end()):  # conditions in quotes
        return value
    rows = ROWS.fullmatch(called[2] if called else value)
    return f"[{'; '.join(row.strip() for row in ROW.findall(rows[1]))}]" if rows else value


def plain(value: Any) -> Any:
    """Return a value as texts, integers and lists of them: arrays and SymPy objects are written out.

    A float stays one, so that whoever reads it refuses it and says what to write.
    """
    if isinstance(value, str):
        return as_value(typed(value))
    if hasattr(value, "tolist"):
        return plain(value.tolist())
    if isinstance(value, Mapping):
        return {str(key): plain(entry) for key, entry in value.items()}
    if isinstance(value, (list, tuple)):
        return [plain(entry) for entry in value]
    if hasattr(value, "free_symbols"):
        return str(value)
    return value


def has_decimals(value: Any) -> bool:
    """Return whether a decimal stands in a value."""
    if isinstance(value, Mapping):
        return any(map(has_decimals, value.values()))
    if isinstance(value, list):
        return any(map(has_decimals, value))
    return isinstance(value, str) and DECIMAL.search(value) is not None


def decimal_comma(value: Any) -> str:
    """Return the number with a decimal comma in a text, empty where there is none."""
    found = _COMMA.search(value) if isinstance(value, str) else None
    return found[0] if found else ""


def has_decimal_commas(value: Any, names: Any, shape: tuple[int, int]) -> bool:
    """Return whether a matrix has the right size, or its transpose, if the commas between its digits are of decimals."""
    if not decimal_comma(value):
        return False
    with suppress(SymobsError):
        return parse_matrix(_COMMA.sub(r"\1.\2", value), names).shape in {shape, shape[::-1]}
    return False


def exact(value: Any) -> Any:
    """Return the same value with every decimal as the fraction that it is: 0.333 is 333/1000."""
    if isinstance(value, Mapping):
        return {key: exact(entry) for key, entry in value.items()}
    if isinstance(value, list):
        return [exact(entry) for entry in value]
    return DECIMAL.sub(lambda found: f"({Fraction(found[0])})", value) if isinstance(value, str) else value


def written_text(value: Any) -> str:
    """Return a value as a student may have written it."""
    if isinstance(value, list):
        rows = [" ".join(map(written_text, row)) if isinstance(row, list) else written_text(row) for row in value]
        return f"[{('; ' if any(isinstance(row, list) for row in value) else ', ').join(rows)}]"
    if isinstance(value, Mapping):
        return "{" + ", ".join(f"{key} = {written_text(entry)}" for key, entry in value.items()) + "}"
    return str(value)


def read_like(found: Any, value: Any, names: Any, variable: str, where: str) -> Matrix | Scalar | None:
    """Return the value of an answer as a matrix or a number, as the right one is; None where that is neither.

    Raises what reading it raises.
    """
    table = factored_table(found)
    right = found.value if isinstance(found, Factored) else table if table is not None else found
    if isinstance(right, int) and not isinstance(right, bool):
        right = Scalar.of(right)
    if not isinstance(right, (Matrix, Scalar)):
        return None
    free = None if names is not None and variable in names else variable
    read = parse_matrix if isinstance(right, Matrix) else parse_scalar
    return read(exact(value), names, variable=free, where=where, functions=True)


# The file of an answer: TOML, JSON, or a text of lines; nothing of it is executed.


MAX_BYTES, MAX_LINES = 64 * 1024, 200
MAX_NAME = 200
#: The keys of an answer file.
KEYS = ("student", "convention", "symbols", "let", "answer", "step")
_STEP = ("relation", "where", "let")
#: What tells a file of tables from a text of lines.
_TABLES = re.compile(r"(?m)^[ \t]*(\[\[?[ \t]*(answer|step)\b|(student|convention|symbols|let)[ \t]*=[ \t]*[\"'\[{])")
#: What to write where it is not known what is asked for.
EXAMPLE = "write for example L = [19; 81]"
#: What begins a remark.
_REMARK = re.compile(r"[#%]")
_RELATION = re.compile(r"[=<>]|!=")
#: The left side of a characteristic equation, in the variable alone.
_OF_ROOTS = re.compile(r"(?=.*(?<![A-Za-z])(?:s|z|λ|lambda)(?![A-Za-z]))(?:[\d\s^*+()./-]|s|z|λ|lambda|²|³)+")
#: A formula in letters of matrices, R^-1 B' P, which is a line, and gives no value in place of an earlier one.
_IN_LETTERS = re.compile(
    r"(?<![A-Za-z_])[A-ZΠΓ]'|(?<![A-Za-z_])[A-ZΠΓ]\s*\^\s*\(?-1|(?<![A-Za-z_])[A-ZΠΓ]\s+[A-ZΠΓ](?!\w)"
)
#: What begins a case, whose answers do not replace those of the main line, and what ends it.
_CASE, _SECTION = re.compile(r"(?:Case|Fall)\b"), re.compile(r"\d+\. ")
#: Several numbers in a row, and the bar of a quotient, as MATLAB displays them below a name.
_NUMBERS, _BAR = re.compile(r"[-+]?[\d.][\d.eE/+-]*(?:\s+[-+]?[\d.][\d.eE/+-]*)+"), re.compile(r"-{3,}")


@dataclass
class Step:
    """One line of a derivation, its place, and what letters stand for in it."""

    relation: str
    where: str
    let: Mapping[str, str] = field(default_factory=dict)


@dataclass
class Answer:
    """What a student hands in.

    values    by field, or by task a table by field; `loose` where some may be lines of a derivation only
    symbols   letters of the student's own, which are real
    note      how the file was read, where that is worth a word
    said      what sentences say: observable, P is positive definite
    written   what the student wrote for a value, by its name, or task.name, where that is known
    repeated  the values that a text gives one letter, in their order
    """

    student: str = ""
    convention: str = ""
    symbols: tuple[str, ...] = ()
    let: Mapping[str, str] = field(default_factory=dict)
    values: Mapping[str, Any] = field(default_factory=dict)
    steps: tuple[Step, ...] = ()
    loose: bool = False
    note: str = ""
    said: tuple[Said, ...] = ()
    written: Mapping[str, str] = field(default_factory=dict)
    repeated: Mapping[str, tuple[Any, ...]] = field(default_factory=dict)


def read_answer(given: str | Mapping[str, Any], where: str = "answer") -> Answer:
    """Return the answer of a text, or of a mapping from fields to values; raises `ProblemErrors` with every error."""
    if isinstance(given, Mapping):
        tables = set(given) & {"answer", "step"}
        return _of_tables(given if tables else {"answer": given})
    if len(given.encode(errors="surrogatepass")) > MAX_BYTES:
        message = f"the answer is larger than {MAX_BYTES // 1024} kB"
        raise ProblemErrors((InputError(message, where=where, repair="hand in the answer alone"),))
    text = typed(_LONG_WORD.sub("…", given))
    if is_of_tables(text):
        data = parse(text, where)
        if text.lstrip().startswith("{") and not {"answer", "step"} & data.keys():  # values by name alone
            about = {key: value for key, value in data.items() if key in {"student", "convention", "symbols", "let"}}
            data = {**about, "answer": {key: value for key, value in data.items() if key not in about}}
        return _of_tables(data)
    found = without_latex(without_drawings(without_marks(text)))
    own, lines = text.splitlines(), found.splitlines()
    return _of_lines(found, where, own if len(own) == len(lines) else lines)


def is_of_tables(text: str) -> bool:
    """Return whether a text is a file of tables, TOML or JSON, and not one of lines."""
    return bool(re.match(r"\s*\{\s*[\"}]", text) or _TABLES.search(text))


def bare_value(text: str) -> str:
    """Return the value that a text is, without words before it: s^2 + 5 s + 6 of "the polynomial is s^2 + 5 s + 6."."""
    return as_value(without_words(without_latex(without_drawings(without_marks(typed(text)))).strip()))  # type: ignore[return-value]


def states(text: str) -> bool:
    """Return whether a text says what something is, and is not a value alone."""
    return bool(_RELATION.search(text)) or ":" in text or text.lstrip().startswith("{")


def _of_lines(text: str, where: str, own: Sequence[str]) -> Answer:
    """Return the answer of lines: the last `NAME = value` of a name is the answer, and every line is a step.

    `own` are the lines as the student wrote them.  Lines of conditions are the answer to a region that none names.
    What is no relation is a line that cannot be read; raises `ProblemErrors` where there are no others.
    """
    kept, said = _without_sentences(_lines(text, where))
    kept, exceptions = _without_exceptions(kept)
    kept, landmarks = without_landmarks(kept)
    values: dict[str, Any] = {**landmarks}
    steps: list[Step] = []
    conditions: list[str] = []
    errors: list[SymobsError] = []
    functions: set[str] = set()
    written: dict[str, str] = {}
    repeated: dict[str, tuple[Any, ...]] = {}
    in_case = False
    for number, line in kept:
        place = f"line {number}"
        in_case = bool(_CASE.match(line)) or (in_case and not _SECTION.match(line))
        defined = definition(line)
        if not defined:
            relation, found = _of_relation(line, functions)
            steps.append(Step(relation, place))
            values |= found
            if not _RELATION.search(line):
                message = f'"{shown(line, 60)}" is no relation'
                errors.append(InputError(message, where=place, repair=EXAMPLE))
            elif is_of_conditions(line):
                conditions.append(line)
            continue
        value = as_value(defined.value)
        is_new = bool(defined.argument) and defined.name not in functions
        functions |= {defined.name} if is_new else set()
        task, _, name = defined.name.rpartition(".")
        table = values.setdefault(task, {}) if task else values
        is_kept = name in table and (in_case or _IN_LETTERS.search(defined.value) is not None)
        if value and (is_new or not is_kept):
            table[name] = value
            repeated[defined.name] = (*repeated.get(defined.name, ()), value)
            written[defined.name] = _own_text(own[number - 1], defined)
        if not task and isinstance(value, str) and _is_relation(name, value):
            steps.append(Step(line if defined.is_chain else f"{name}{defined.argument} = {value}", place))
    if errors and len(errors) == len(kept):
        raise ProblemErrors(tuple(errors))
    if conditions and not any("stable_if" in table for table in (values, values.get("stability_region", {}))):
        values["stable_if"] = conditions
    if exceptions or conditions:
        values.setdefault("conditions", exceptions or conditions)
    more: dict[str, Any] = {"said": tuple(said), "written": written, "repeated": repeated}
    return Answer(values=values, steps=tuple(steps), loose=True, **more)


def _of_relation(line: str, functions: Collection[str]) -> tuple[str, dict[str, Any]]:
    """Return the relation that a line without a definition is, and the values that it may give, by what stands beside them."""
    left, *members = (part.lstrip("=").strip() for part in _apart(_EQUALS, line))
    if members == ["0"] and _OF_ROOTS.fullmatch(left):
        return f"chi(s) = {left}", {"chi": as_value(left)}
    if len(members) > 1 and members[-1] == "0":
        members.pop()
        line = " = ".join([left, *members])
    is_equation = members[-1:] == ["0"] and left.startswith(("det", "|"))  # of the eigenvalues
    if not members or not members[-1] or is_equation or _IS_INEQUALITY.search(line):
        return line, {}
    found = {name: as_value(text) for name, text in coefficients_of(members).items() if name not in functions}
    return line, {squashed(members[-1]): as_value(left), squashed(left): as_value(members[-1]), **found}


def _own_text(line: str, defined: Definition) -> str:
    """Return the value in a student's own line, the whole of a line where it is not plain which value that is."""
    found = _DEFINITION.fullmatch(line.strip())
    is_whole = not defined.is_chain and len(statements(line)) == 1 and not _opened(line)
    if not is_whole or not (found or "\\begin" in line):
        return defined.value
    return found[3].strip() if found and found[1] == defined.name and found[3].strip() else line.strip()


def _without_sentences(lines: Iterable[tuple[int, str]]) -> tuple[list[tuple[int, str]], list[Said]]:
    """Return lines without sentences that say what has a property, and what they say."""
    kept: list[tuple[int, str]] = []
    said: list[Said] = []
    for number, line in lines:
        rest, found = what_is_said(line)
        said += found
        if rest:
            kept.append((number, rest))
    return kept, said


def _without_exceptions(lines: Iterable[tuple[int, str]]) -> tuple[list[tuple[int, str]], list[str]]:
    """Return lines without the conditions under which a rank or a verdict is said to hold, and these conditions."""
    kept: list[tuple[int, str]] = []
    exceptions: list[str] = []
    for number, line in lines:
        alone, *under = _WHERE.split(line, maxsplit=1)
        defined = definition(alone)
        name, said = (defined.name, defined.value) if defined else ("verdict", alone)
        is_yes = name.rpartition(".")[2] == "verdict" and verdict_of(said, *PROPERTIES) == "yes"
        if line.startswith("conditions"):
            exceptions.append(line.removeprefix("conditions").lstrip(" :="))
        elif under and (is_yes or (defined and name.rpartition(".")[2] in _OF_PARAMETERS)):
            exceptions += under
            kept.append((number, f"{name} = conditional" if is_yes else alone))
        else:
            kept.append((number, line))
    return kept, exceptions


#: No name and no number of anybody: the time in which patterns look for them grows with the square of the length.
_LONG_WORD = re.compile(r"[^\W\d_]\w{300,}|\d{4300,}")
#: What is so for some values of the parameters.
_OF_PARAMETERS = {"rank", "verdict"}


def _is_relation(name: str, value: str) -> bool:
    """Return whether a definition is a relation of a derivation, as a verdict and a region are not."""
    return name != "stable_if" and verdict_of(value, *PROPERTIES) is None


def _lines(text: str, where: str) -> list[tuple[int, str]]:
    """Return the lines that say something, with their numbers; a matrix that is not closed goes on in the lines below it."""
    lines = enumerate(text.splitlines(), start=1)
    split = [(i, plain_line(in_inequalities(_REMARK.split(line, maxsplit=1)[0].strip()))) for i, line in lines]
    written = [(i, line) for i, line in split if line]
    _at_most(len(written), where)
    found: list[tuple[int, str]] = []
    while written:
        number, line = written.pop(0)
        if (named := definition(line)) and not named.value:
            line = f"{line} {_displayed(written)}"
        below, is_open = 0, _opened(line)
        while is_open > 0 and below < len(written) and not _RELATION.search(written[below][1]):
            is_open += _opened(written[below][1])
            below += 1
        if is_open == 0:
            line = "\n".join([line, *(part for _, part in written[:below])])
            del written[:below]
        while written and written[0][1].startswith(("=", "≈", "·", "/")):  # a chain goes on
            line = f"{line} {written.pop(0)[1]}"
        found += [(number, part.strip()) for part in statements(line)]
    _at_most(len(found), where)
    return found


def _displayed(written: list[tuple[int, str]]) -> str:
    """Take what is displayed below its name: a quotient over its bar, the rows of a matrix, or one expression."""
    lines = [line for _, line in takewhile(lambda each: not _RELATION.search(each[1]), written)]
    scale = lines[0] if len(lines) > 1 and lines[0].endswith("*") else ""  # MATLAB's common factor 1.0e+03 *
    if scale:
        del written[0]
        return f"{scale} {_displayed(written)}"
    if len(lines) > 2 and _BAR.fullmatch(lines[1]):
        del written[:3]
        return f"({lines[0]})/({lines[2]})"
    del written[: len(lines)]
    if len(lines) == 1 and not _NUMBERS.fullmatch(lines[0]):
        return lines[0]
    return f"[{'; '.join(line.strip('[] ') for line in lines)}]" if lines else ""


def _at_most(lines: int, where: str) -> None:
    if lines > MAX_LINES:
        message = f"{lines} lines, more than {MAX_LINES}"
        raise ProblemErrors((InputError(message, where=where, repair="hand in what leads to the answer"),))


def _opened(line: str) -> int:
    """Return how many brackets a line leaves open."""
    return line.count("[") - line.count("]")


def _of_tables(data: Mapping[str, Any]) -> Answer:
    """Return the answer of the tables of a file."""
    errors: list[SymobsError] = []

    def note(message: str, where: str, repair: str) -> None:
        errors.append(InputError(message, where=where, repair=repair))

    def table(source: Mapping[str, Any], name: str, where: str) -> Mapping[str, Any]:
        value = source.get(name, {})
        if isinstance(value, Mapping):
            return value
        note("a table is expected", where, f"write [{name}] and its keys below")
        return {}

    def text(source: Mapping[str, Any], name: str, where: str, most: int = MAX_NAME) -> str:
        value = source.get(name, "")
        if isinstance(value, str) and len(value) <= most:
            return typed(value)
        note(f"a text of at most {most} characters is expected", where, "write it in quotes")
        return ""

    def letters(source: Mapping[str, Any], where: str) -> dict[str, str]:
        found = table(source, "let", where)
        for name, meaning in found.items():
            if not isinstance(meaning, str):
                note("a text is expected", f"{where}.{shown(name, 40)}", 'write let = { M = "[m1; m2]" }')
        return {name: typed(str(meaning)) for name, meaning in found.items()}

    for key in data:
        if key not in KEYS:
            note("unknown key", shown(str(key), 40), f"known keys are {', '.join(KEYS)}; answers belong to [answer]")
    symbols = data.get("symbols", [])
    if not isinstance(symbols, list) or not all(isinstance(name, str) for name in symbols):
        note("a list of names is expected", "symbols", 'write symbols = ["m1", "m2"]')
        symbols = []
    for i, name in enumerate(symbols):
        try:
            declared_name(name, f"symbols[{i}]")
        except SymobsError as error:
            errors.append(error)
    steps = data.get("step", [])
    if not isinstance(steps, list) or len(steps) > MAX_LINES:
        note(f"a list of at most {MAX_LINES} steps is expected", "step", "write [[step]], one a line")
        steps = []
    read: list[Step] = []
    for i, step in enumerate(steps, start=1):
        place = f"step[{i - 1}]"
        if not isinstance(step, Mapping) or not set(step) <= set(_STEP) or not isinstance(step.get("relation"), str):
            note("a table with relation is expected", place, f"known keys are {', '.join(_STEP)}")
            continue
        said = text(step, "where", f"{place}.where") or f"line {i}"
        relation = text(step, "relation", f"{place}.relation", MAX_BYTES)
        read.append(Step(relation, said, letters(step, f"{place}.let")))
    student, convention = text(data, "student", "student"), text(data, "convention", "convention")
    given = table(data, "answer", "answer")
    values = {str(key): plain(value) for key, value in given.items()}
    let = letters(data, "let")
    if errors:
        raise ProblemErrors(tuple(errors))
    tables = {f"{key}.": value for key, value in given.items() if isinstance(value, Mapping)} | {"": given}
    written = {
        f"{at}{name}": text for at, each in tables.items() for name, text in each.items() if isinstance(text, str)
    }
    return Answer(student, convention, tuple(symbols), let, values, tuple(read), written=written)


# Lists as students write them: numbers in brackets, vectors, nothing; a comma between two digits has two readings.


_LIST = re.compile(r"\[[^][{}]*\]|\{[^][{}]*\}")
_NOTHING = re.compile(r"none|keine|\[\s*\]|\{\s*\}|\u2205", re.IGNORECASE)
_VECTOR = re.compile(r"\[[^][]*\]|\((?=[^()]*[,;])[^()]*\)")
#: What stands around the vectors of a space: span{…}, <…>, {…}.
_SPAN = re.compile(
    r"(?:(?:span|lin|image|im|bild)\s*(?=[({<\[]))?\s*(?:\{(.*)\}|<(.*)>|⟨(.*)⟩|\((?=\s*[\[(])(.*)\)|(.*))", re.DOTALL
)
#: What sets numbers apart besides a comma: the blanks of "1,5 -2,5", not those of "1 - 2".
_APART = r"[;\n]|(?<=\d)\s+(?=[-+]?\d)"


def as_list(value: Any) -> Any:
    """Return the entries of a text in brackets, [1, 2] or [1; 2] or {1, 2}, or with semicolons; another value as it is.

    So is one whose commas stand between digits while something else sets its entries apart: [1,5; 2,5].
    """
    if not isinstance(value, str):
        return value
    if _NOTHING.fullmatch(value.strip()):
        return []
    is_bare = ";" in value and not re.search(r"[][{}]", value)
    if not (is_bare or _LIST.fullmatch(value.strip())) or has_two_readings(value):
        return value
    inside = value.strip() if is_bare else value.strip()[1:-1].strip()
    parts = re.split(r"[,;\n]" if re.search(r"[,;\n]", inside) else r"\s+", inside)
    return [part.strip() for part in parts if part.strip()]


def has_two_readings(value: Any, length: int | None = None) -> bool:
    """Return whether the commas of a list may be those of decimals: something else sets its entries apart as well.

    For a list that is wrong `length` is that of the right one, which the reading with decimals may have.
    """
    if isinstance(value, list) and any(map(decimal_comma, value)):
        return True
    if length is None:
        parts = re.split(_APART, value.strip()) if isinstance(value, str) else []
        return len(parts) > 1 and any(map(decimal_comma, parts))
    entries = value.split(",") if isinstance(value, str) else value if isinstance(value, list) else []
    if len(entries) != 2 * length or not length or not all(isinstance(entry, str) for entry in entries):
        return False
    return all(map(decimal_comma, map(",".join, zip(entries[::2], entries[1::2], strict=True))))


def as_kernel(value: Any, order: int) -> Any:
    """Return the vectors of a kernel as a list, none for {0}; the text of a single one as it is."""
    if isinstance(value, (str, int)):
        text = readable(_MATRIX_CALL.sub(r"\1", str(value).strip()))
        inside = next(part for part in _SPAN.fullmatch(text).groups() if part is not None).strip()  # type: ignore[union-attr]
        if _NOTHING.fullmatch(text) or inside in {"0", ""}:
            return []
        value = _vectors_in(inside, order)
    elif isinstance(value, list) and len(value) == order:
        if not any(isinstance(entry, list) or "[" in str(entry) for entry in value):
            value = [value]  # the entries of a single vector
        elif order > 1 and all(isinstance(entry, list) and len(entry) == 1 for entry in value):
            value = [[entry for (entry,) in value]]  # a column
    vectors = value if isinstance(value, list) else [value]
    return [] if all(_is_zero(vector, order) for vector in vectors) else value


#: Calls of SymPy and NumPy within a list of vectors.
_MATRIX_CALL = re.compile(r"(?:\w+\.)?(?:Matrix|array|vector)\(\s*(\[[^][]*\])\s*\)")


def _vectors_in(text: str, order: int) -> Any:
    """Return the vectors of a text as lists of entries: those in brackets of their own, or the rows or columns of a matrix.

    A text that is neither is unreadable: raises `InputError`.
    """
    inside = text[1:-1].strip() if re.fullmatch(r"\[\s*[\[(].*[\])]\s*\]", text, re.DOTALL) else text
    found = _VECTOR.findall(inside)
    rows = [[_entries_in(row) for row in vector[1:-1].split(";")] for vector in found]
    if found and not _VECTOR.sub("", inside).strip(" ,;\n"):
        if len(rows) == 1 and len(rows[0]) > 1 and len(rows[0][0]) > 1:  # a matrix
            (matrix,) = rows
            if len({*map(len, matrix)}) == 1 and len(matrix) == order:
                return [[*column] for column in zip(*matrix, strict=True)]
            return matrix
        vectors = [[entry for row in vector for entry in row] for vector in rows]
        if all(len(vector) == order for vector in vectors):
            return vectors
        message = f"vectors of {order} entries are expected"
    elif order == 1 or re.fullmatch(r"[^][(){}]*", inside):
        return text
    else:
        message = f'"{shown(text, 60)}" is no list of vectors'
    example = ", ".join(str(int(k == 0)) for k in range(order))
    raise InputError(message, repair=f"write for example span{{({example})}}")


def _entries_in(row: str) -> list[str]:
    parts = row.split(",") if "," in row else row.split()
    return [part.strip() for part in parts if part.strip()]


def as_sizes(value: Any, names: Iterable[str]) -> Any:
    """Return sizes that are named, co: 1, c_no = 1, as a table, those left out being 0; another value as it is."""
    if not isinstance(value, str):
        return value
    found = dict(re.findall(r"(\w+)['\"]?\s*[:=]\s*(\d+)", value))
    known = [*names]
    return {name: found.get(name, "0") for name in known} if found and {*found} <= {*known} else value


def _is_zero(vector: Any, order: int) -> bool:
    return re.findall(r"[^][\s,;]+", written_text(vector)) == ["0"] * order


def in_a_line(value: Any, shape: tuple[int, int]) -> Any:
    """Return a list of as many entries as a row or a column has as that one; another value as it is."""
    value = as_entries(value, shape[0] * shape[1]) if 1 in shape and not has_two_readings(value) else value
    is_flat = isinstance(value, list) and not any(isinstance(entry, (list, Mapping)) for entry in value)
    if not is_flat or 1 not in shape or len(value) != shape[0] * shape[1]:
        return value
    return [value] if shape[0] == 1 else [[entry] for entry in value]
