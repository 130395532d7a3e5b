r"""LaTeX templates: where they lie, and how a page is filled in.

Jinja2 with marks that LaTeX leaves alone: `\VAR{…}` prints, `\BLOCK{…}` directs, a line that begins with `%%` is a
directive and one with `%#` a comment.  A name that is not there is an error, never an empty place.
"""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Mapping

    from jinja2 import Environment

_PACKAGE = Path(__file__).parent.parent


def template_folder() -> Path:
    """Return the folder of the built-in templates: inside an installed package, beside it in a checkout."""
    inside = _PACKAGE / "latex_templates"
    return inside if inside.is_dir() else _PACKAGE.parent / "latex_templates"


def fill(template: str, values: Mapping[str, object], *, folder: Path | None = None) -> str:
    """Return the template with values put in; `folder` is searched for templates before the built-in ones."""
    return _environment(folder).get_template(template).render(values).lstrip("\n")


def _environment(folder: Path | None) -> Environment:
    # Imported late: no other format needs it. Sandboxed: a template handed on by somebody else stays a template.
    from jinja2 import FileSystemLoader, StrictUndefined  # noqa: PLC0415
    from jinja2.sandbox import ImmutableSandboxedEnvironment  # noqa: PLC0415

    folders = [folder, template_folder()] if folder else [template_folder()]
    return ImmutableSandboxedEnvironment(
        loader=FileSystemLoader(folders),
        undefined=StrictUndefined,
        autoescape=False,  # LaTeX, not HTML: text among the values has been through `escape`
        block_start_string=r"\BLOCK{",
        block_end_string="}",
        variable_start_string=r"\VAR{",
        variable_end_string="}",
        comment_start_string=r"\COMMENT{",
        comment_end_string="}",
        line_statement_prefix="%%",
        line_comment_prefix="%#",
        trim_blocks=True,
        lstrip_blocks=True,
        keep_trailing_newline=True,
    )
