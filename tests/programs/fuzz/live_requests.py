"""Requests to a live page: problems in order and out of order with everything else that a request can hold, as bytes."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any

from symobs.applications.live.assets import MOST_BYTES, SCHEMA
from symobs.applications.live.child import respond
from symobs.applications.live.request import DETAILS, EXPORTS, WANTS
from tests.programs.fuzz import corpus, mutate, problems, texts

if TYPE_CHECKING:
    from random import Random

_STATUSES = {"done", "no", "bad", "undecided"}
_NAMES = (*("a", "b", "omega", "h1", "h2", "k1", "p", "T") * 3, "x", "lambda", "K", "L", "__class__", "a" * 70, "é")
_KEYS = (
    "schema",
    "id",
    "want",
    "problem",
    "task",
    "at",
    "cards",
    "cards_at",
    "courses",
    "cases",
    "format",
    "detail",
    "as",
)
_MARKUP = "<img src=x onerror=alert(1)><script>alert(1)</script>"


def request(source: Random) -> bytes:
    """Return the bytes of a request."""
    whole: dict[str, Any] = {
        "schema": SCHEMA,
        "id": source.randrange(99),
        "want": source.choice(("answer", "answer", "page", *WANTS[:-1])),
    }
    whole["problem"] = problems.small(source) if source.random() < 0.8 else problems.wrong(source)
    if source.random() < 0.1 and isinstance(whole["problem"], dict):
        whole["problem"]["title"] = _MARKUP
    offered: tuple[tuple[str, Any], ...] = (
        ("at", {source.choice(_NAMES): _value(source) for _ in range(source.choice((0, 1, 1, 2)))}),
        ("cards", source.sample(_NAMES, source.randrange(4))),
        ("cards_at", source.random() < 0.5),
        ("cases", True),
        ("courses", {"start": _value(source), "estimate": _value(source), "count": source.choice((2, 33, 129, 1025))}),
        ("detail", source.choice(DETAILS)),
        ("as", source.choice(EXPORTS)),
    )
    whole |= {key: value for key, value in offered if source.random() < 0.15}
    if source.random() < 0.1:
        whole = mutate.table(source, whole, _KEYS, corpus.expressions())
    text = mutate.as_json(whole)
    match source.randrange(15):
        case 0:
            return problems.json(source)[: MOST_BYTES + 9]
        case 1:
            return mutate.binary(source, text)
        case 2 | 3:
            return mutate.text(source, text).encode("utf-8", "surrogatepass")
    return text.encode("utf-8", "surrogatepass")


def _value(source: Random) -> Any:
    exact = (
        "0",
        "1",
        "1",
        "3",
        "1/4",
        "-2",
        "1/2",
        "-7/3",
        "sqrt(2)",
        "1/0",
        "1, 1",
        "[1; 0]",
        "",
        "1e400",
        "9" * 250,
        3,
        True,
        0.5,
    )
    return source.choice(exact) if source.random() < 0.8 else texts.anything(source)


def answered(body: bytes) -> str:
    """Answer a request; it has one of the answers of the protocol, of at most 1 MB, in which no markup is the user's."""
    content = respond(body)
    found = json.loads(content)
    assert found["status"] in _STATUSES, f"status {found['status']}: {found.get('message')}"
    assert found["schema"] == SCHEMA, found["schema"]
    assert len(content) <= 1 << 20, len(content)
    assert all("<img" not in text and "<script" not in text for text in _markup(found)), "markup of a user"
    return str(found["status"])


def _markup(found: Any) -> list[str]:
    """Return what a page puts into itself as markup."""
    if isinstance(found, dict):
        own = [value for key, value in found.items() if key in {"html", "mathml", "svg"} and isinstance(value, str)]
        return own + [text for value in found.values() for text in _markup(value)]
    return [text for each in found for text in _markup(each)] if isinstance(found, list) else []
