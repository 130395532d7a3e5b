"""The extension of the site: pages written from the code, and worked examples solved when the site is built."""

from __future__ import annotations

import re
from pathlib import Path
from typing import TYPE_CHECKING, Any

import gallery_pages
import reference_pages
from docutils import nodes
from pygments.lexers.special import TextLexer
from sphinx.util.docutils import SphinxDirective

if TYPE_CHECKING:
    from sphinx.application import Sphinx

#: What lies beside the folder of the documents has its page elsewhere.
LINKS = {
    "../CONTRIBUTING.md": "contributing.md",
    "../CHANGELOG.md": "changelog.md",
    "../worked_examples/": "gallery/index.md",
    "../symobs/tasks/": "reference/tasks.md",
    "../symobs/cli/": "reference/command_line.md",
    "../symobs/problem/": "reference/problem_file.md",
    "../symobs/pages/formats/json.py": "reference/json.md",
    "../symobs/__init__.pyi": "reference/python.md",
    "docs/": "",
}


class Example(SphinxDirective):
    """A worked example: how to run it, its problem file, and its derivation, solved and held against `[expect]`."""

    required_arguments = 1

    def run(self) -> list[nodes.Node]:
        """Return the nodes."""
        name = self.arguments[0]
        example = gallery_pages.example(name)
        self.env.note_dependency(str(example.path))
        fragment = self.env.app.symobs_fragments.get(name, "")
        told = [nodes.raw("", fragment, format="html")] if fragment else []
        run = f"symobs examples {name} > {name}.toml\nsymobs solve {name}.toml -o {name}.html\nsymobs serve {name}.toml"
        parts: list[nodes.Node] = [nodes.literal_block(run, run, language="sh")]
        address = self.config.symobs_live
        if address:
            link = nodes.reference("", "Open live", refuri=f"{address}#{example.link}")
            parts.append(nodes.paragraph("", "", link))
        file = example.text.partition("\n[[printed]]")[0]  # what its source prints is for `symobs audit`
        return [*parts, nodes.literal_block(file, file, language="toml"), *told]


def write_pages(app: Sphinx) -> None:
    """Write the pages that come from the code, those that are as they were left alone, and solve the examples."""
    folder = Path(app.srcdir)
    shown = gallery_pages.examples(app.config.symobs_examples)
    app.symobs_fragments = gallery_pages.solved(shown, folder / "_cache")
    pages = {**reference_pages.pages(), **gallery_pages.pages(shown, app.symobs_fragments)}
    for name in ("changelog", "contributing"):
        pages[f"{name}.md"] = linked((folder.parent / f"{name.upper()}.md").read_text("utf-8"))
    for old in {str(path.relative_to(folder)) for path in folder.glob("gallery/**/*.md")} - set(pages):
        (folder / old).unlink()
    for name, text in pages.items():
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        if not path.exists() or path.read_text("utf-8") != text:
            path.write_text(text, "utf-8")


def linked(text: str) -> str:
    """Return a page of the repository with links that lead to pages of the site."""
    for there, here in LINKS.items():
        text = text.replace(f"]({there}", f"]({here}")
    return text


#: A part of the first page: its title and the pages in it.
_PART = re.compile(r"^## (.*)\n\n((?:- \[.*\]\(.*\.md\)\n)+)", re.MULTILINE)


def relink(_: Sphinx, name: str, source: list[str]) -> None:
    """Let the links of a page lead to pages of the site; those of the first page are its table of contents."""
    source[0] = re.sub(r"^<!--.*?-->\n", "", linked(source[0]), flags=re.DOTALL)
    if name == "index":
        source[0] = _PART.sub(_table_of_contents, source[0])


def _table_of_contents(part: re.Match[str]) -> str:
    pages = "\n".join(re.findall(r"\]\((.*)\.md\)", part[2]))
    return f"```{{toctree}}\n:caption: {part[1]}\n:maxdepth: 1\n\n{pages}\n```\n"


def setup(app: Sphinx) -> dict[str, Any]:
    """Register all of it."""
    app.add_config_value("symobs_examples", default="", rebuild="env", types=[str])
    app.add_config_value("symobs_live", default="", rebuild="env", types=[str])
    app.add_directive("symobs-example", Example)
    app.add_lexer("report", TextLexer)
    app.connect("builder-inited", write_pages)
    app.connect("source-read", relink)
    return {"parallel_read_safe": False, "parallel_write_safe": True}
