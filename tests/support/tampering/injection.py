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
import unicodedata
from pathlib import Path
from typing import TYPE_CHECKING

from symobs.ground.errors import SymobsError
from symobs.pages.formats.pdf import compiled
from tests.support.tools.browser import Browser
from tests.support.tools.command_line import inside

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Sequence

#: What the canary says; in the texts, CANARY stands for its path and OWNED for that of the file to be made.
SECRET = "SECRETCANARYCONTENT"  # noqa: S105 - no password

_TEX = (
    *(
        r"\input{CANARY}",
        r"\input CANARY ",
        r"\@@input CANARY ",
        r"\include{CANARY}",
        r"\InputIfFileExists{CANARY}{}{}",
    ),
    *(
        r"\verbatiminput{CANARY}",
        r"\lstinputlisting{CANARY}",
        r"\csname @@input\endcsname CANARY ",
        r"\input|cat CANARY",
    ),
    *(r"\newread\f\openin\f=CANARY \read\f to\x \x", r"\openin5=CANARY \loop\unless\ifeof5 \read5 to\x\x\repeat"),
    *(
        r"\includegraphics{CANARY}",
        r"\pdfximage{CANARY}",
        r"\pdffiledump length 99{CANARY}",
        r"\pdfmdfivesum file{CANARY}",
    ),
    *(r"\pdfobj stream file{CANARY}", r"\usepackage{CANARY}", r"\documentclass{CANARY}", r"\bibliography{CANARY}"),
    *(
        r"\write18{touch OWNED}",
        r"\immediate\write18{touch OWNED}",
        r"\ShellEscape{touch OWNED}",
        r"\directlua{os.exit()}",
    ),
    *(
        r"\newwrite\f\immediate\openout\f=OWNED \immediate\write\f{x}",
        r"\immediate\openout3=OWNED",
        r"\input|'touch OWNED'",
    ),
    *(r"\begin{filecontents*}{OWNED}x\end{filecontents*}", r"\immediate\write-1{x}", r"\special{ps: (OWNED) (w) file}"),
    *(
        r"\catcode`\%=12 \catcode`\#=0",
        r"\catcode`\\=12",
        r"\catcode`X=0 Xinput{CANARY}",
        r"\lccode`\~=`\\ \lowercase{~input}",
    ),
    *(r"\end{document}", r"\end{document}\input{CANARY}", r"\endinput", r"\stop", r"\enddocument", r"\@@end", r"\dump"),
    *(
        r"\def\x{\x\x}\x",
        r"\loop\iftrue\repeat",
        r"\def\title{}\let\par\relax",
        r"\let\end\relax",
        r"\renewcommand\answer[1]{}",
    ),
    *(
        r"\begin{verbatim}",
        r"\verb|x",
        r"\verb+\input{CANARY}+",
        r"\iffalse",
        r"\fi\fi",
        r"\else",
        r"\begingroup",
        r"\egroup",
    ),
    *(r"\csname input\endcsname{CANARY}", r"\expandafter\input\expandafter{CANARY}", r"\scantokens{\input{CANARY}}"),
    *(
        "^^5cinput{CANARY}",
        "^^5Cinput{CANARY}",
        "^^M^^M",
        "^^@",
        "^^?^^A",
        "^^^^005cinput{CANARY}",
        "x^^5e^5cinput{CANARY}",
    ),
    *(
        r"\^^M",
        r"\char92 input",
        r"\jobname",
        r"\the\year",
        r"\meaning\x",
        r"\detokenize{x}",
        r"\fontname\font",
        r"\TeX",
    ),
    *(
        "$",
        "$$",
        "$x^2$",
        r"\(x\)",
        r"\[x\]",
        "$x",
        "%",
        "100 % of it",
        r"%\end{document}",
        "#1",
        "##",
        "&",
        "& & &",
        "~",
        "_",
        "^",
    ),
    *(
        "{",
        "}",
        "{{{{",
        "}}}}",
        "}{",
        r"\{",
        r"\}",
        "a}b{c",
        r"}\input{CANARY}{",
        r"\\",
        "\\",
        "x\\",
        r"\\[9999pt]",
        r"\ ",
    ),
    *(
        r"\begin{tikzpicture}\node{x};\end{tikzpicture}",
        r"/pgf/.code={\input{CANARY}}",
        r"\pgfkeys{/x/.code=\y}",
        "node[above]{x}",
    ),
    *(
        r"\begin{align*}",
        r"\begin{equation}x",
        r"\item",
        r"\section{x}",
        r"\label{x}\ref{x}",
        r"\cite{x}",
        r"\footnote{x}",
        r"\hline",
    ),
    *(
        r"\href{javascript:alert(1)}{x}",
        r"\url{http://x}",
        r"\pdfbookmark{x}{y}",
        r"\hypertarget{x}{y}",
        r"\Gin@extensions",
    ),
    *(
        "?`",
        "!`",
        "``x''",
        '"quoted" words',
        "--- -- -",
        "<<x>>",
        ",,x''",
        "fi ffi fl ff",
        "'''",
        "`",
        "\N{ACUTE ACCENT}",
        "|",
        "<",
        ">",
        '"',
    ),
)
_JINJA = (
    *(
        r"\VAR{body}",
        r"\VAR{title.__class__}",
        r"\BLOCK{raw}",
        r"\BLOCK{include 'CANARY'}",
        r"\BLOCK{endblock}",
        "%% x",
        "%# x",
    ),
    *(
        "{{7*7}}",
        "{% raw %}",
        "{{ config }}",
        "${7*7}",
        "$title $body ${style}",
        "#{7*7}",
        "%s %d {0} {x}",
        r"\VAR{7*7}}",
    ),
)
_WEB = (
    *(
        "<script>window.owned=1</script>",
        "</title><script>window.owned=1</script>",
        "<img src=x onerror=window.owned=1>",
    ),
    *(
        "</style><script>window.owned=1</script>",
        "<svg onload=window.owned=1>",
        "<iframe src=file:CANARY></iframe>",
        "<b>x</b>",
    ),
    *(
        "<a href=javascript:window.owned=1>x</a>",
        "javascript:window.owned=1",
        "&lt;script&gt;window.owned=1&lt;/script&gt;",
    ),
    *(
        '" onmouseover="window.owned=1',
        "' autofocus onfocus='window.owned=1",
        "<!-- x",
        "-->",
        "<![CDATA[ x ]]>",
        "]]>",
        "&#60;",
    ),
    *(
        "&#x3c;script>",
        "&amp;lt;",
        "&copy",
        "<math><mtext></mtext></math>",
        "</math><script>window.owned=1</script>",
        "<?php x ?>",
    ),
    *(
        "</svg></figure><script>window.owned=1</script>",
        "<base href=//x/>",
        "<meta http-equiv=refresh content=0;url=//x>",
    ),
    *(
        "<link rel=stylesheet href=//x>",
        "<style>@import url(//x)</style>",
        "<object data=CANARY>",
        "<form action=//x><input>",
    ),
    *(
        "url(//x)",
        "expression(window.owned=1)",
        "<x/onclick=window.owned=1>",
        "<script src=//x></script>",
        "\\u003cscript\\u003e",
    ),
)
_MARKDOWN = (
    *(
        "[x](javascript:window.owned=1)",
        "![x](http://x/y.png)",
        "[x]: http://x",
        "<http://x>",
        "# x",
        "> x",
        "- x",
        "1. x",
        "+ x",
    ),
    *(
        "```",
        "~~~",
        "`x`",
        "**x**",
        "__x__",
        "~~x~~",
        "***",
        "---",
        "===",
        "| a | b |",
        "x | y",
        "$x$",
        "$$x$$",
        "\\[x\\]",
        "&nbsp;",
    ),
    *(
        "<details><summary>x</summary>",
        "<img src=http://x>",
        "a  ",
        "    code",
        "[^1]",
        "- [ ] x",
        ":smile:",
        "@everyone",
        "#1 GH-1",
    ),
)
#: Characters that few fonts have, that turn the direction of writing, that look like others, or are none at all.
_UNICODE = (
    *(
        "\N{FULLWIDTH REVERSE SOLIDUS}input{CANARY}",
        "\N{SET MINUS}input{CANARY}",
        "\N{SMALL REVERSE SOLIDUS}end{document}",
    ),
    *(
        "\u202egnp.exe",
        "\u2066x\u2069",
        "\u200bzero\u200bwidth",
        "\ufeffbom",
        "\u00adsoft",
        "a\u0300\u0301\u0302\u0303",
        "\u0301x",
    ),
    *(
        "Łódź, Zürich, naïve",
        "東京",
        "Привет",
        "שלום",
        "مرحبا",
        "😀",
        "𝒪𝒞",
        "ω₀², −1 ≤ ½",
        "ﬁ ﬂ",
        "\ufffd",
        "\ue000",
        "\U0010fffd",
    ),
    *(
        "\u2028line",
        "\u0085next",
        "a\tb",
        "first\nsecond",
        "first\n\nsecond",
        "\u00a0",
        "\u3000",
        "x\u0338",
        "\N{FULLWIDTH DIGIT ONE}\N{FULLWIDTH DIGIT TWO}",
        "\N{FULLWIDTH LATIN CAPITAL LETTER A}\N{FULLWIDTH REVERSE SOLIDUS}\N{FULLWIDTH LATIN CAPITAL LETTER B}",
        "\N{LEFT SINGLE QUOTATION MARK}x\N{RIGHT SINGLE QUOTATION MARK} “y”",
    ),
    *(
        "\N{GREEK QUESTION MARK}",
        "\N{DIVISION SLASH}etc",
        "\N{DOLLAR SIGN}\N{SMALL DOLLAR SIGN}",
        "\N{FULLWIDTH PERCENT SIGN}",
        "ǅ",
    ),
)
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

TEXTS: tuple[str, ...] = tuple(dict.fromkeys((*_TEX, *_JINJA, *_WEB, *_MARKDOWN, *_UNICODE)))
#: The same behind what could open the way for them, and among other words.
WRAPPERS = (
    "{}",
    "}}{}",
    "${}",
    "%\n{}",
    "\\{}",
    "x {} y",
    "{}%",
    "{{{}",
    "\\end{{document}}{}",
    '"{}',
    "`{}",
    "^^M{}",
    "<{}",
)


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
    folder.joinpath("canary").write_text(SECRET, encoding="utf-8")
    names = [f"{number}.toml" for number in range(len(texts))]
    for name, text in zip(names, texts, strict=True):
        folder.joinpath(name).write_text(problem(text, text, text), encoding="utf-8")
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


def faults_of_web(texts: Sequence[str], folder: Path, browser: Browser) -> Iterator[str]:
    """Yield what is wrong about the page of the same sheet in a browser, with and without the page's own policy."""
    names = files(texts, folder)
    run = inside("sheet", *names, "--title", texts[0].replace("\0", ""), "-o", "out.html", folder=folder)
    yield from _faults_of_run(run.code, run.err)
    page = folder / "out.html"
    written = page.read_text(encoding="utf-8")
    for open_to_all in (False, True):
        if open_to_all:
            assert _POLICY.search(written)
            page.write_text(_POLICY.sub("", written), encoding="utf-8")
        browser.open(page)
        yield from (f"the browser complains: {complaint[:500]}" for complaint in browser.complaints())
        yield from (f"{request} was asked for" for request in browser.requests() if request != page.as_uri())
        if browser.value(_RAN):
            yield "a script ran"
        if browser.value(_ALIVE):
            yield "an element came from a text"
        yield from (f"not shown as it is: {text!r}" for text in lost(texts, str(browser.value(_WORDS))))


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
    folder.joinpath("canary").write_text(SECRET, encoding="utf-8")
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
    with tempfile.TemporaryDirectory() as name, Browser(str(shutil.which("chromium"))) as browser:
        folder = Path(name)
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
