"""Problems with printed equations, made for the tests of the audit."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING

from symobs.applications.audit import audit
from symobs.problem import read

if TYPE_CHECKING:
    from symobs.applications.audit import Finding

SERVO = {"A": "[0 1; 0 -1]", "B": "[0; 1]", "C": "[1 0]"}


def problem(*relations: str, convention: str = "standard", plant: dict[str, str] | None = None, **rest: object) -> str:
    """Return the text of a problem, by default the servo's observer with poles -10, -10, in which these are printed."""
    data: dict[str, object] = {
        "title": "printed",
        "tasks": ["observer"],
        "plant": plant or SERVO,
        "specification": {"poles": [-10, -10]},
        "convention": convention,
        "printed": [{"relation": relation} for relation in relations],
    }
    return json.dumps(data | rest)


def findings(*relations: str, **rest: object) -> list[Finding]:
    """Return what the audit finds among equations printed of the servo."""
    return list(audit(read(problem(*relations, **rest))).findings)  # type: ignore[arg-type]


def finding(relation: str, **rest: object) -> Finding:
    """Return the one finding of an equation."""
    (found,) = findings(relation, **rest)
    return found
