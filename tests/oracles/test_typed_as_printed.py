"""Problems of books and courses in the notation of seven languages, typed as printed: right at the first try, or refused."""

from __future__ import annotations

import json
import re
import tomllib
from pathlib import Path
from typing import Any

import pytest
import sympy

from symobs.ground.errors import SymobsError
from symobs.problem import validate

PROBLEMS: list[dict[str, Any]] = tomllib.loads(Path(__file__).with_name("typed_as_printed.toml").read_text("utf-8"))[
    "problems"
]
#: Values of the parameters at which answers that SymPy does not see to be equal are compared.
POINTS = ((1.37, 0.71, 2.3, 0.9, 1.9, 3.1, 0.4, 0.6), (2.11, 1.3, 0.57, 1.7, 0.8, 0.33, 2.9, 1.1))


def read(text: str) -> Any:
    """A printed value as SymPy's, with real letters."""
    names = {
        name: sympy.Symbol(name, real=True) for name in re.findall(r"[A-Za-z_]\w*", text) if not hasattr(sympy, name)
    }
    names |= {name: sympy.Symbol(name, real=True) for name in ("beta", "gamma", "zeta", "S", "N", "Q")}
    return sympy.sympify(text.replace("^", "**"), locals=names)  # noqa: TID251 - texts of the table, and answers


def agree(printed: str, ours: str, form: str) -> bool:
    """Whether two values are equal, or the one to the digits of the other."""
    difference = read(printed) - read(ours)
    letters = sorted(difference.free_symbols, key=str)
    if letters:
        bound = 5e-3 if form == "decimal" else 1e-9
        at = [dict(zip(letters, point, strict=False)) for point in POINTS]
        sizes = [1 + abs(complex(read(printed).subs(values))) for values in at]
        gaps = [abs(complex(difference.subs(values).evalf(30))) for values in at]
        return all(gap < bound * size for gap, size in zip(gaps, sizes, strict=True))
    size, digits = abs(complex(difference.evalf(30))), re.search(r"\.(\d+)", printed)
    if form == "decimal":
        return bool(size <= (1.1 * 10 ** -len(digits[1]) if digits else 5e-3 * abs(float(read(printed))) + 1e-9))
    return bool(size < 1e-12)


def entries(value: Any) -> list[str]:
    """The entries of a matrix of an answer, row by row."""
    return [each for part in value for each in entries(part)] if isinstance(value, list) else [str(value)]


def printed_entries(text: str) -> list[str]:
    """The entries of a printed matrix."""
    return re.split(r"[;,](?![^(]*\))", text.strip().strip("[]"))


@pytest.mark.slow
@pytest.mark.parametrize("number", range(len(PROBLEMS)))
def test_a_problem_typed_as_printed_has_the_printed_answer(number: int) -> None:
    problem = PROBLEMS[number]
    file = {"title": "x", **tomllib.loads(problem["typed"])}
    if "refused" in problem:
        with pytest.raises(SymobsError, match=problem["refused"]):
            validate(file).solve()
        return
    assert problem["answers"]
    found = {result.task: json.loads(result.to_json())["results"][0] for result in validate(file).solve()}
    for task, field, printed, form, _how in problem["answers"]:
        answer = {**found[task].get("decimals", {}), **{k: v for k, v in found[task].items() if v is not None}}
        answer |= {k: v for k, v in found[task].get("fields", {}).items() if v is not None}
        ours = answer[field]
        if isinstance(ours, list) and not any(sign in printed for sign in '<>!"'):
            pairs = list(zip(printed_entries(printed), entries(ours), strict=True))
            assert all(agree(*pair, form) for pair in pairs), (field, printed, ours)
        elif isinstance(ours, list):
            assert ours in (json.loads(printed) if printed.startswith("[") else None, [printed]), field
        else:
            plain = printed.strip("[]")
            same = plain.lower() in {str(ours).lower(), {True: "yes", False: "no"}.get(ours, "")}
            assert same or agree(plain, str(ours), form), (field, printed, ours)


def test_nine_of_ten_are_read_at_the_first_try() -> None:
    assert sum("refused" not in problem for problem in PROBLEMS) >= 0.9 * len(PROBLEMS)
