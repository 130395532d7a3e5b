"""Texts, bytes and tables made wrong: what a slip of the hand does, and what somebody does who means harm."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence
    from random import Random

    Value = Any

#: Pieces that meant trouble somewhere once: to numbers, to brackets, to readers of text, to terminals, to TeX and HTML.
PIECES = (
    *("9" * 400, "1e400", "1e-999999", "1e99999999999", "0x1F", "0b2", "1_000", "007", "-0", "+-+-1", ".5.", "1.e5"),
    *("9^9^9^9", "((10^64)^64)^64", "(a+b)^1000", "(a+b+c)^60", "1/0", "a/(a-a)", "2^-1001", "(1/3)^999", "i^999"),
    *("((((", "))))", "[[[[", "]]]]", "[", "]", "(", ")", "{", "}", ";", ";;", ",", ",,", "'", "''", '"', '"""', "'''"),
    *(
        "\x00",
        "\x07",
        "\x1b[2J",
        "\x7f",
        "\r",
        "\r\n",
        "\n",
        "\t",
        "\x0b",
        "\x0c",
        "\x85",
        "\u2028",
        "\ufeff",
        "\ufffe",
    ),
    *(
        "\u202e",
        "\u200b",
        "\u00a0",
        "\ud800",
        "\udfff",
        "😀",
        "ω",
        "π",
        "ﬁ",
        "½",
        "²",
        "−",
        "×",
        "٣",
        "\N{FULLWIDTH LATIN CAPITAL LETTER A}",
        "e\u0301",
    ),
    *("\u0301" * 30, "İ", "ß", "ǅ", "𝒪", "ℵ", "\U0010ffff"),
    *("sqrt(-1)", "sqrt(2)", "exp(", "sin(t)", "cosh(a t)", "exp(exp(exp(t)))", "t", "s", "z", "I", "oo", "inf", "nan"),
    *("pi", "lambda", "None", "True", "__class__", "__import__('os')", "().__class__", "eval(1)", "exec", "x" * 65),
    *(
        "a.b",
        "a.b.c.d.e.f.g.h.i.j.k = 1",
        "[a.b]",
        "[[a]]",
        "[plant]",
        "[[printed]]",
        "= 1",
        "#",
        "\\",
        "\\u0000",
        "//",
    ),
    *("\\input{/etc/passwd}", "$", "%", "^^5c", "\\VAR{x}", "<script>", "&lt;", "{{7*7}}", "\\end{document}"),
    *("true", "false", "null", "inf", "-nan", "1979-05-27", "07:32:00", "NaN", "Infinity", "[]", "{}", '""'),
)


def text(source: Random, original: str, others: Sequence[str] = ()) -> str:
    """Return a text with a few things done to it."""
    for _ in range(source.choice((1, 1, 1, 2, 2, 3, 6))):
        original = source.choice(_OF_TEXT)(source, original, others)
        if len(original) > 300_000:
            break
    return original


def _places(source: Random, original: str) -> tuple[int, int]:
    first = source.randint(0, len(original))
    return first, min(len(original), first + source.choice((0, 1, 1, 2, 5, 20, 200)))


def _cut(source: Random, original: str, _: Sequence[str]) -> str:
    first, last = _places(source, original)
    return original[:first] + original[last:]


def _doubled(source: Random, original: str, _: Sequence[str]) -> str:
    first, last = _places(source, original)
    times = source.choice((2, 2, 3, 50, 2000))
    return original[:first] + original[first:last] * times + original[last:]


def _pieced(source: Random, original: str, _: Sequence[str]) -> str:
    first, last = _places(source, original)
    return original[:first] + source.choice(PIECES) * source.choice((1, 1, 1, 1, 3, 100)) + original[last:]


def _flipped(source: Random, original: str, _: Sequence[str]) -> str:
    if not original:
        return original
    place = source.randrange(len(original))
    code = ord(original[place]) ^ (1 << source.choice((0, 0, 1, 2, 3, 4, 5, 6, 7, 9, 15)))
    return original[:place] + chr(min(code, 0x10FFFF)) + original[place + 1 :]


def _swapped(source: Random, original: str, _: Sequence[str]) -> str:
    words = original.split(" ")
    i, j = source.randrange(len(words)), source.randrange(len(words))
    words[i], words[j] = words[j], words[i]
    return " ".join(words)


def _lines_swapped(source: Random, original: str, _: Sequence[str]) -> str:
    lines = original.split("\n")
    i, j = source.randrange(len(lines)), source.randrange(len(lines))
    lines[i], lines[j] = lines[j], lines[i]
    return "\n".join(lines)


def _spliced(source: Random, original: str, others: Sequence[str]) -> str:
    other = source.choice(others) if others else original[::-1]
    return original[: source.randint(0, len(original))] + other[source.randint(0, len(other)) :]


def _nested(source: Random, original: str, _: Sequence[str]) -> str:
    first, last = _places(source, original)
    pair = source.choice(("()", "[]", "{}", "--", "''", '""', "^-", "(("))
    depth = source.choice((2, 20, 99, 101, 500, 5000))
    return original[:first] + pair[0] * depth + original[first:last] + pair[1] * depth + original[last:]


def _typed(source: Random, original: str, _: Sequence[str]) -> str:
    return source.choice((str.upper, str.lower, str.title, lambda t: t.replace("\n", "\r\n"), lambda t: "\ufeff" + t))(
        original
    )


_OF_TEXT: tuple[Callable[[Random, str, Sequence[str]], str], ...] = (
    *(
        _cut,
        _doubled,
        _pieced,
        _pieced,
        _pieced,
        _flipped,
        _flipped,
        _swapped,
        _lines_swapped,
        _spliced,
        _nested,
        _typed,
    ),
)


def binary(source: Random, original: str) -> bytes:
    """Return the bytes of a text with some of them changed; what comes out need not be UTF-8."""
    data = bytearray(original.encode("utf-8", "surrogatepass"))
    for _ in range(source.choice((0, 1, 1, 2, 8))):
        if data:
            data[source.randrange(len(data))] = source.choice((0, 0xFF, 0x80, 0xC0, 0xED, source.randrange(256)))
    prefix = source.choice((b"", b"", b"", b"", b"\xef\xbb\xbf", b"\xff\xfe", b"\xfe\xff"))
    return prefix + bytes(data)


# -- tables -----------------------------------------------------------------------------------------------------------


def table(source: Random, original: dict[str, Value], keys: Sequence[str], texts: Sequence[str]) -> dict[str, Value]:
    """Return a table with keys lost, swapped, misspelt or of another task, and with values of every kind."""
    found: dict[str, Value] = {
        key: dict(value) if isinstance(value, dict) else value for key, value in original.items()
    }
    for _ in range(source.choice((1, 1, 2, 3))):
        tables = [found, *(value for value in found.values() if isinstance(value, dict))]
        chosen = source.choice(tables)
        own = list(chosen)
        key = source.choice(own) if own and source.random() < 0.7 else source.choice((*keys, *PIECES[-60:]))
        match source.randrange(6):
            case 0:
                chosen.pop(key, None)
            case 1 if own:
                other = source.choice(own)
                chosen[key], chosen[other] = chosen.get(other), chosen.get(key)
            case 2:
                chosen[source.choice(keys)] = chosen.pop(key, value(source, texts))
            case 3 if isinstance(chosen.get(key), str):
                chosen[key] = text(source, chosen[key], texts)
            case _:
                chosen[key] = value(source, texts)
    return found


def value(source: Random, texts: Sequence[str], depth: int = 0) -> Value:
    """Return a value of any kind that a file can hold."""
    match source.randrange(12):
        case 0:
            return source.choice((0, 1, -1, 2, 10**18, -(10**300), 10**999, 10**1001, 256, source.randrange(-9, 99)))
        case 1:
            return source.choice((0.5, 1e300, -0.0, 0.1, 1e-320))
        case 2:
            return source.choice((True, False, None))
        case 3 | 4 | 5:
            return source.choice(texts) if texts else ""
        case 6:
            return text(source, source.choice(texts), texts) if texts else ""
        case 7:
            return source.choice(PIECES)
        case 8 if depth < 4:
            names = ("a", "sign", "latex", "A", "poles", "relation", "x\ny", "")
            return {source.choice(names): value(source, texts, depth + 1) for _ in range(source.randrange(3))}
        case _ if depth < 4:
            return [value(source, texts, depth + 1) for _ in range(source.choice((0, 1, 2, 2, 3)))]
    return "x"


def as_json(data: Value) -> str:
    """Return a table as JSON; floats that JSON does not have are written as Python writes them."""
    return json.dumps(data, ensure_ascii=False)


def as_toml(data: dict[str, Value]) -> str:
    """Return a table as TOML, its own tables under headers."""
    plain = {key: each for key, each in data.items() if not isinstance(each, dict) and each is not None}
    lines = [f"{_key(key)} = {_toml(each)}" for key, each in plain.items()]
    for key, each in data.items():
        if isinstance(each, dict):
            lines += [f"[{_key(key)}]", *(f"{_key(k)} = {_toml(v)}" for k, v in each.items() if v is not None)]
    return "\n".join(lines) + "\n"


def _key(key: str) -> str:
    return key if key and key.isascii() and key.replace("_", "").replace("-", "").isalnum() else _quoted(key)


def _quoted(string: str) -> str:
    return '"' + "".join(c if c.isprintable() and c not in '"\\' else f"\\U{ord(c):08X}" for c in string) + '"'


def _toml(data: Value) -> str:
    if isinstance(data, bool):
        return str(data).lower()
    if isinstance(data, str):
        return _quoted(data)
    if isinstance(data, list):
        return f"[{', '.join(_toml(each) for each in data if each is not None)}]"
    if isinstance(data, dict):
        return f"{{{', '.join(f'{_key(key)} = {_toml(each)}' for key, each in data.items() if each is not None)}}}"
    return str(data)
