"""Inputs that coverage guides: `python -m tests.programs.fuzz.guided grammar -runs=100000` (or problem_toml, problem_json, …).

Needs atheris, which has no wheel for every platform and is no dependency: `pip install atheris`.  What follows the
target's name goes to libFuzzer, which prints what it covers and keeps an input that crashes in a file `crash-…`.  The
corpus it begins with are the worked examples; every input is held to what the target of the same name holds it to.
"""

from __future__ import annotations

import sys
import tempfile
from pathlib import Path
from random import Random
from typing import Any

import atheris  # type: ignore[import-not-found, import-untyped, unused-ignore]

from symobs.ground.errors import SymobsError

_KINDS = ("scalar", "matrix", "poles", "polynomial", "time", "time scalar", "name", "names", "entries")


def main() -> None:
    """Fuzz one target until libFuzzer has run enough."""
    with atheris.instrument_imports(include=["symobs", "tomllib", "json"], enable_loader_override=False):
        from tests.programs.fuzz import corpus, targets, worker  # noqa: PLC0415 - what is imported here is instrumented

    name, *options = sys.argv[1:]
    target = targets.TARGETS[name]
    seeds = Path(tempfile.mkdtemp(prefix="seeds-"))
    texts: dict[str, tuple[str, ...]] = {
        "grammar": corpus.expressions(),
        "audit": corpus.relations(),
        "convention": corpus.profile_texts(),
    }
    for number, text in enumerate(texts.get(name, corpus.example_texts())):
        seeds.joinpath(str(number)).write_bytes(text.encode())
    watch = worker.prepared()
    worker.allow(watch, target)

    def one(data: bytes) -> None:
        became, fault = worker.outcome(target.run, _case(name, data, target), watch)
        if fault:
            raise SymobsError(f"{became}: {fault}")

    atheris.Setup([sys.argv[0], "-timeout=60", "-rss_limit_mb=1500", "-max_len=4096", *options, str(seeds)], one)
    atheris.Fuzz()


def _case(name: str, data: bytes, target: Any) -> Any:
    """Return the input of a target that libFuzzer's bytes stand for."""
    if name == "grammar":
        text = data[1:].decode("utf-8", "surrogateescape")
        names = None if data[:1] and data[0] & 64 else dict.fromkeys(("a", "b", "omega", "h1", "s", "t", "i"), "real")
        return _KINDS[(data[0] if data else 0) % len(_KINDS)], text, names
    if name == "audit":
        return data.decode("utf-8", "surrogateescape")
    if name in {"printing", "command_line"}:  # their inputs are made, not read: the bytes choose how
        return target.make(Random(data))  # noqa: S311 - repeatable by design
    return data


if __name__ == "__main__":
    main()
