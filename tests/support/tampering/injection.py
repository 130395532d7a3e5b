r"""Texts by which somebody would make TeX, a browser, a template or a terminal do something, and how to see that none did.

`python -m tests.support.tampering.injection` puts all of them on sheets, typesets these with TeX, opens them
in a browser, and prints what
it found; `tests/contracts/test_injection.py` does so with a part of them.

A canary is a file whose contents no page may show; `owned` is a file that no run may make.  Every text is put wherever
text from outside is printed, and must come out as the characters it is.
"""

from __future__ import annotations

import re
import shutil
import subprocess
import sys
import tempfile
import time
import tomllib
import unicodedata
from pathlib import Path
from typing import TYPE_CHECKING

from symobs.ground.errors import SymobsError
from symobs.pages.formats.pdf import compiled
from tests.support.tools.browser import Watched, launched
from tests.support.tools.command_line import inside

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Sequence

#: What the canary says; in the texts, CANARY stands for its path and OWNED for that of the file to be made.
SECRET = "SECRETCANARYCONTENT"  # noqa: S105 - no password

_DATA = tomllib.loads(Path(__file__).with_suffix(".toml").read_text("utf-8"))
#: The same behind what could open the way for them, and among other words.
WRAPPERS = _DATA.pop("wrappers")
_TEX = _DATA["tex"]
_LONG = (
    "x" * 1500,
    r"\x" * 700,
    "{" * 500 + "}" * 500,
    "$" * 1000,
    "word " * 300,
    "^^5c" * 300,
    "é" * 900,
    "-" * 900,
    "_" * 900,
)

TEXTS: tuple[str, ...] = tuple(dict.fromkeys(text for texts in _DATA.values() for text in texts))


def corpus(folder: Path) -> tuple[str, ...]:
    """Return every text once, in every wrapper; the paths among them lie in `folder`."""
    wrapped = [wrapper.format(text) for wrapper in WRAPPERS for text in TEXTS]
    texts = [text.replace("CANARY", str(folder / "canary")).replace("OWNED", str(folder / "owned")) for text in wrapped]
    return tuple(dict.fromkeys((*texts, *_LONG)))


def quoted(text: str) -> str:
    """Return a text as TOML writes it."""
    return '"' + "".join(c if c.isprintable() and c not in '"\\' else f"\\U{ord(c):08X}" for c in text) + '"'


def problem(title: str, source: str = "", text: str = "") -> str:
    """Return the smallest of problems, with texts that are printed."""
    printed = {"title": title, "source": source, "text": text}
    lines = [f"{name} = {quoted(value)}" for name, value in printed.items() if value]
    return "\n".join([*lines, 'task = "characteristic_polynomial"', "[plant]", 'A = "[-2]"', ""])


# -- what a page shows ------------------------------------------------------------------------------------------------

_SAME = str.maketrans(
    {
        "\N{MODIFIER LETTER CIRCUMFLEX ACCENT}": "^",
        "\N{SMALL TILDE}": "~",
        "\N{ACUTE ACCENT}": "'",
        "−": "-",
        "–": "-",
        "—": "-",
        "\N{SINGLE LOW-9 QUOTATION MARK}": ",",
        "\N{TILDE OPERATOR}": "~",
        "\N{SET MINUS}": "\\",
        "\N{HYPHEN}": "-",
    }
)
_QUOTES = re.compile("[\"'`“”„\N{LEFT SINGLE QUOTATION MARK}\N{RIGHT SINGLE QUOTATION MARK}\N{GRAVE ACCENT}]")


def skeleton(words: str) -> str:
    """Return what is left of words when a page has broken, hyphenated and set them.

    No spaces, hyphens and quotes; no underscores, which TeX draws as rules; of characters of one meaning, one.
    """
    plain = unicodedata.normalize("NFKC", words.translate(_SAME)).translate(_SAME)
    return _QUOTES.sub("", re.sub(r"[-_\s\u00ad\x0c]", "", plain))


def lost(texts: Iterable[str], page: str) -> list[str]:
    """Return the texts of ASCII that a page does not show as they are."""
    shown = skeleton(page)
    return [text for text in texts if text.isascii() and skeleton(text) not in shown]


def printable(text: str) -> bool:
    """Whether a problem file may have this text; others are refused before they are printed."""
    return len(text) <= 2000 and not any(unicodedata.category(c) in {"Cc", "Cs"} and c not in "\t\n" for c in text)


# -- all places at once -----------------------------------------------------------------------------------------------


def files(texts: Sequence[str], folder: Path) -> list[str]:
    """Write a problem for each text, which is its title, its source and its words; return the names of the files."""
    folder.joinpath("canary").write_text(SECRET, "utf-8")
    names = [f"{number}.toml" for number in range(len(texts))]
    for name, text in zip(names, texts, strict=True):
        folder.joinpath(name).write_text(problem(text, text, text), "utf-8")
    return names


def faults_of_pdf(texts: Sequence[str], folder: Path) -> Iterator[str]:
    """Yield what is wrong about the PDF of a sheet on which each text is a title, a source and words of a problem."""
    names = files(texts, folder)
    before = set(folder.iterdir())
    run = inside("sheet", *names, "--title", texts[0].replace("\0", ""), "-o", "out.pdf", folder=folder)
    yield from _faults_of_run(run.code, run.err)
    yield from faults_of_folder(folder, before)
    if run.code == 0:
        words = words_of((folder / "out.pdf").read_bytes())
        yield from (f"not shown as it is: {text!r}" for text in lost(texts, words))
        yield from ([f"the canary is shown among {texts!r}"] if SECRET in words else [])


def faults_of_folder(folder: Path, before: set[Path]) -> Iterator[str]:
    """Yield every file that was made and should not be."""
    for path in sorted(set(folder.iterdir()) - before):
        if path.name not in {"out.pdf", "out.html", "out.md", "out.tex"}:
            yield f"{path.name} was made"


def _faults_of_run(code: int, said: str) -> Iterator[str]:
    if code:
        yield f"exit code {code}: {said[:1000]}"


def words_of(page: bytes) -> str:
    """Return the words of a PDF."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "page.pdf"
        path.write_bytes(page)
        run = subprocess.run(["pdftotext", "-layout", str(path), "-"], capture_output=True, check=True)
    return run.stdout.decode()


#: What a page says of itself: whether something ran, what it holds that could run or load, and what its titles are.
_RAN = "typeof window.owned !== 'undefined'"
_ALIVE = "document.querySelectorAll('script,iframe,img,object,embed,form,input,base,link,[onclick],[onload],[onerror]').length"
_WORDS = "document.body.innerText"
_POLICY = re.compile(r'<meta http-equiv="Content-Security-Policy"[^>]*>')


def faults_of_web(texts: Sequence[str], folder: Path, browser: Watched) -> Iterator[str]:
    """Yield what is wrong about the page of the same sheet in a browser, with and without the page's own policy."""
    names = files(texts, folder)
    run = inside("sheet", *names, "--title", texts[0].replace("\0", ""), "-o", "out.html", folder=folder)
    yield from _faults_of_run(run.code, run.err)
    page = folder / "out.html"
    written = page.read_text("utf-8")
    for open_to_all in (False, True):
        if open_to_all:
            assert _POLICY.search(written)
            page.write_text(_POLICY.sub("", written), "utf-8")
        browser.open(page)
        yield from (f"the browser complains: {complaint[:500]}" for complaint in browser.complaints)
        yield from (f"{request} was asked for" for request in browser.requests if request != page.as_uri())
        if browser.page.evaluate(_RAN):
            yield "a script ran"
        if browser.page.evaluate(_ALIVE):
            yield "an element came from a text"
        yield from (f"not shown as it is: {text!r}" for text in lost(texts, str(browser.page.evaluate(_WORDS))))


#: A character that means something to Markdown; what `\` stands before is only shown.
MEANS = re.compile(r"(?<!\\)(?:\\\\)*[`*_\[\]<>|~$]|&(?!(?:lt|gt|amp);)")
#: A line that would be part of a list, or make a heading of the line above.
_BEGINS = re.compile(r" {0,3}(?:[-+]|\d+[.)]|-+|=+)(?=\s|$)")


def faults_of_markdown(texts: Sequence[str], folder: Path) -> Iterator[str]:
    """Yield the titles and sources of a Markdown sheet in which something means more than itself."""
    names = files(texts, folder)
    run = inside("sheet", *names, "--questions", "--format", "markdown", folder=folder)
    yield from _faults_of_run(run.code, run.err)
    for line in run.out.splitlines():
        title = line.removeprefix("### ").partition(". ")[2] if line.startswith("### ") else ""
        if MEANS.search(title) or _BEGINS.match(line):
            yield f"it means something: {line!r}"


def faults_of_bare_tex(texts: Iterable[str], folder: Path) -> Iterator[str]:
    """Yield what TeX, as the package calls it, reads, writes or runs where nothing at all is escaped."""
    folder.joinpath("canary").write_text(SECRET, "utf-8")
    before = set(folder.iterdir())
    for text in texts:
        source = rf"\documentclass{{article}}\begin{{document}}x {text} \end{{document}}"
        try:
            words = words_of(compiled(source, time_limit=20))
        except (SymobsError, subprocess.SubprocessError):
            continue
        yield from ([f"the canary is shown by {text!r}"] if SECRET in words else [])
    yield from (f"{path.name} was made" for path in sorted(set(folder.iterdir()) - before))


def main() -> int:
    """Put the whole corpus on sheets of a hundred, as PDF, on the web and in Markdown; return 1 where something is wrong."""
    start, faults, count, pages = time.monotonic(), 0, 0, 0
    with tempfile.TemporaryDirectory() as name, launched(str(shutil.which("chromium"))) as chromium:
        folder, browser = Path(name), Watched(chromium)
        texts = [text for text in corpus(folder) if printable(text)]
        for first in range(0, len(texts), 100):
            chunk = texts[first : first + 100]
            for found in (
                faults_of_pdf(chunk, folder),
                faults_of_web(chunk, folder, browser),
                faults_of_markdown(chunk, folder),
            ):
                for fault in found:
                    faults += 1
                    print(fault, flush=True)  # noqa: T201 - what it is for
                pages += 1
            count += len(chunk)
            print(f"{count} texts on {pages} pages, {faults} faults, {time.monotonic() - start:.0f} s", flush=True)  # noqa: T201
        bare = [text.replace("CANARY", f"{folder}/canary").replace("OWNED", f"{folder}/owned") for text in _TEX]
        for fault in faults_of_bare_tex(bare, folder):
            faults += 1
            print(fault, flush=True)  # noqa: T201
        print(f"{len(bare)} texts in TeX with nothing escaped, {faults} faults, {time.monotonic() - start:.0f} s")  # noqa: T201
    return int(faults > 0)


if __name__ == "__main__":
    sys.exit(main())
