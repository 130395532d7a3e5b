r"""LaTeX templates: their location, and their values.

Jinja2 with marks that LaTeX leaves alone: `\VAR{…}` prints, `\BLOCK{…}` directs, a line that begins with `%%` is a
directive and one with `%#` a comment.  A name that is not there is an error, never an empty place.  A template of the
user's takes the place of the built-in one of its name, which it can still extend under `symobs/NAME`.
"""

from __future__ import annotations

from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING

from symobs.ground.errors import InputError, reason_of

if TYPE_CHECKING:
    from collections.abc import Mapping

    from jinja2 import Environment

_PACKAGE = Path(__file__).parents[2]


def template_folder() -> Path:
    """Return the folder of the built-in templates: inside an installed package, beside it in a checkout."""
    inside = _PACKAGE / "latex_templates"
    return inside if inside.is_dir() else _PACKAGE.parent / "latex_templates"


def check_folder(folder: Path) -> None:
    """Raise `InputError` unless a folder has a template with the name of a built-in one."""
    names = sorted(path.name for path in template_folder().glob("*.tex"))
    if not any((folder / name).is_file() for name in names):
        message = f"none of the templates {', '.join(names)} is there"
        repair = "name a folder with one of them; `symobs templates copy FOLDER` makes one"
        raise InputError(message, where=str(folder)[:200], repair=repair)


def fill(template: str, values: Mapping[str, object], *, folder: Path | None = None) -> str:
    """Return the template with values put in; `folder` is searched for templates before the built-in ones.

    Raises `InputError` naming template and line where a template of the user's cannot be used.
    """
    from jinja2 import TemplateError  # noqa: PLC0415 - as below

    try:
        environment = _environment(folder) if folder else _of_built_in()
        return environment.get_template(template).render(values).lstrip("\n")
    except RecursionError:
        message = "the template extends itself"
        repair = f'begin it with \\BLOCK{{extends "{_BUILT_IN}/{template}"}}'
        raise InputError(message, where=template, repair=repair) from None
    except (TemplateError, ArithmeticError, AttributeError, LookupError, TypeError, ValueError) as error:
        raise InputError(_reason(error), where=_place(error, template), repair=_REPAIR) from error


#: Under this name the built-in templates can be reached from a template with the same name as one of them.
_BUILT_IN = "symobs"
_REPAIR = "compare it with the built-in one: `symobs templates copy FOLDER`"


def _reason(error: Exception) -> str:
    """Return the error of a template on one line."""
    from jinja2 import TemplateNotFound  # noqa: PLC0415 - as below

    if isinstance(error, TemplateNotFound):
        return f"there is no template {' '.join(str(error).split())[:80]!r} in this folder or among the built-in ones"
    return f"the template cannot be used: {reason_of(error)[:200]}"


def _place(error: Exception, template: str) -> str:
    """Return the name of the template of an error, and the line."""
    name = Path(getattr(error, "filename", None) or template).name
    line = getattr(error, "lineno", None)
    trace = error.__traceback__ if line is None else None
    while trace is not None:
        file = Path(trace.tb_frame.f_code.co_filename)
        if file.suffix == ".tex":
            name, line = file.name, trace.tb_lineno
        trace = trace.tb_next
    return f"{name}, line {line}" if line is not None else name


@cache
def _of_built_in() -> Environment:
    """Return the environment of the built-in templates, compiled once in a process."""
    return _environment(None)


def _environment(folder: Path | None) -> Environment:
    # Imported late: no other format needs it. Sandboxed: a template handed on by somebody else stays a template.
    from jinja2 import ChoiceLoader, FileSystemLoader, PrefixLoader, StrictUndefined  # noqa: PLC0415
    from jinja2.sandbox import ImmutableSandboxedEnvironment  # noqa: PLC0415

    built_in = FileSystemLoader(template_folder())
    own = [FileSystemLoader(folder)] if folder else []
    return ImmutableSandboxedEnvironment(
        loader=ChoiceLoader([*own, built_in, PrefixLoader({_BUILT_IN: built_in})]),
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
