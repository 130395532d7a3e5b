"""Following a page of the documentation to the letter: its files are saved, its lines run, its values compared."""

from __future__ import annotations

import re
import shlex
from itertools import takewhile
from typing import TYPE_CHECKING, Any

from tests.support.paths import ROOT
from tests.support.tools.command_line import inside

if TYPE_CHECKING:
    from pathlib import Path

#: A block, its language, and the file that the words before it say to save it as.
BLOCK = re.compile(r"(?:`([\w.]+)`:\n\n)?^```(\w+)\n(.*?)^```", re.MULTILINE | re.DOTALL)
#: What opens a browser, and what needs a notebook.
INTERACTIVE = re.compile(r"^symobs serve$|symobs\.live\(", re.MULTILINE)


def text_of(page: str) -> str:
    """The text of a page, which is named from the folder `docs`."""
    return (ROOT / "docs" / f"{page}.md").read_text("utf-8")


def blocks(page: str) -> list[tuple[str, str, str]]:
    """The blocks of a page: file, language, text."""
    return BLOCK.findall(text_of(page))


def follow(page: str, folder: Path) -> None:
    """Do what a page says in a folder; what it shows has to be what is printed."""
    names: dict[str, Any] = {}
    printed: str | None = None
    for file, language, block in blocks(page):
        if file:
            (folder / file).write_text(block, "utf-8")
        elif INTERACTIVE.search(block):
            printed = None
        elif language == "sh":
            printed = run(block, folder)
        elif language == "text" and printed is not None:
            without_margin = re.sub(r"^ +", "", printed, flags=re.MULTILINE)
            assert block in printed or block in without_margin, f"{block}\n{printed}"
        elif language == "python":
            exec(block, names)  # noqa: S102 - the text of our own page
            for expression, value in re.findall(r"^(\S.*?)  # (.+)$", block, re.MULTILINE):
                shown = re.sub(r",\s+", ", ", repr(eval(expression, names)))  # noqa: S307
                assert re.sub(r"([\[(])\s+", r"\1", shown) == value, expression


def run(block: str, folder: Path) -> str:
    """What the lines of a shell print: `symobs` with `>`, `| grep` and `|| test $? =`, and `cat` with and without a text."""
    printed, lines = "", iter(block.splitlines())
    for line in lines:
        if text := re.fullmatch(r"cat (>>?) (\S+) <<'END'", line):
            with (folder / text[2]).open("a" if text[1] == ">>" else "w", encoding="utf-8") as file:
                file.writelines(f"{each}\n" for each in takewhile(lambda each: each != "END", lines))
        elif line.startswith("cat "):
            printed += (folder / line[4:]).read_text("utf-8")
        elif line:
            command, _, code = re.sub(r"\s+#.*", "", line).partition(" || test $? = ")
            command, _, wanted = command.partition(" | grep ")
            words, _, target = command.partition(" > ")
            ran = inside(*shlex.split(words)[1:], folder=folder)
            assert words.startswith("symobs ")
            assert (ran.code, line) == (int(code or 0), line), ran.err
            assert wanted.removeprefix("-i ").lower() in ran.out.lower()
            if target:
                (folder / target).write_text(ran.out, "utf-8")
            else:
                printed += ran.out + ran.err
    return printed
