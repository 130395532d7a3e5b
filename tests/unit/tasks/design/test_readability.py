"""How long a thing may be on a design page is said in one module."""

from __future__ import annotations

import ast
from typing import TYPE_CHECKING

import pytest

from tests.support.paths import ROOT

if TYPE_CHECKING:
    from pathlib import Path

DESIGN = ROOT / "symobs" / "tasks" / "design"
PAGES = sorted(DESIGN.rglob("*_page.py"))
#: Numbers of mathematics: the degree of a conjugate pair's factor, the order up to which signs decide stability.
NO_LIMITS = {"_PAIR", "_DECIDED_BY_SIGNS"}


def numbers(path: Path) -> set[str]:
    """The names of a module that stand for whole numbers."""
    found: set[str] = set()
    for statement in ast.parse(path.read_text(encoding="utf-8")).body:
        if isinstance(statement, ast.Assign) and any(
            isinstance(part, ast.Constant) and type(part.value) is int
            for part in (statement.value, *getattr(statement.value, "elts", ()))
        ):
            found |= {
                name.id for target in statement.targets for name in ast.walk(target) if isinstance(name, ast.Name)
            }
    return found


@pytest.mark.parametrize("path", PAGES, ids=lambda path: path.stem)
def test_a_page_has_no_limits_of_its_own(path: Path) -> None:
    assert numbers(path) <= NO_LIMITS


def test_every_limit_is_used() -> None:
    limits = numbers(DESIGN / "page_parts" / "readability.py")
    sources = "".join(path.read_text(encoding="utf-8") for path in DESIGN.rglob("*.py"))
    assert limits
    assert {limit for limit in limits if f"readability.{limit}" not in sources} == set()
