"""The problem and the values of letters that a link of the live page holds."""

from __future__ import annotations

from typing import Any
from urllib.parse import unquote


def problem_of(link: str) -> tuple[dict[str, Any], dict[str, str]]:
    """Read the problem and the values of letters out of a link, or out of its part after `#`."""
    given = dict(pair.split("=", 1) for pair in unquote(link.rpartition("#")[2]).split("&"))
    table = {
        name: dict(pair.split(":") for pair in given.pop(name, "").split(",") if pair) for name in ("symbols", "at")
    }
    long = {"control": "control_poles", "observer": "observer_poles", "order": "observer"}
    told = {"task": given["task"], "symbols": table["symbols"]}
    told |= {name: given[name] for name in ("convention", "language") if name in given}
    told["plant"] = {name: given[name] for name in ("A", "B", "C", "D", "transfer_function", "dt") if name in given}
    other = {"v", "task", "snap", "closed", "detail", "x0", "xh0", "step", "goal", *told, *told["plant"]}
    told["specification"] = {long.get(name, name): text for name, text in given.items() if name not in other}
    return told, table["at"]
