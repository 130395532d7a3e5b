"""Interactive parts of an HTML page: levels of detail, buttons that copy LaTeX, a link to a live page.

Levels are radio buttons and a rule of style.  The buttons are made by the one script, which the policy of the page names by
its hash: where scripts do not run, there is no button and nothing is missing.
"""

from __future__ import annotations

import base64
import hashlib
from html import escape
from pathlib import Path
from typing import TYPE_CHECKING

from symobs.formula.phrases.languages import language_named
from symobs.pages.page.detail_level import DETAILS

if TYPE_CHECKING:
    from collections.abc import Mapping

    from symobs.tasks.result.web_page import WebPage

_FOLDER = Path(__file__).parent


def style_of(web: WebPage) -> str:
    """Return the style sheet of the interactive parts."""
    return (_FOLDER / "html_web.css").read_text(encoding="utf-8") if web.details or web.copy or web.live else ""


def script_of(web: WebPage, language: str) -> tuple[str, str]:
    """Return the script with its words, as elements, and the policy that allows it and no other."""
    if not web.copy:
        return "", ""
    text = (_FOLDER / "html_copy.js").read_text(encoding="utf-8")
    mark = base64.b64encode(hashlib.sha256(text.encode()).digest()).decode()
    phrases = language_named(language).phrases
    words = " ".join(f'data-{word}="{escape(phrases[f"web_{word}"])}"' for word in ("copy", "copied", "refused"))
    return f'<div hidden="" id="words" {words}></div>\n<script>{text}</script>\n', f"; script-src 'sha256-{mark}'"


def switch(web: WebPage, chosen: str, language: str) -> str:
    """Return the choice of the level of detail, if there is one."""
    if not web.details:
        return ""
    phrases, checked = language_named(language).phrases, ' checked="checked"'
    buttons = [
        f'<label><input type="radio" name="detail" value="{name}"{checked * (name == chosen)}/> '
        f"{phrases[f'web_{name}']}</label>"
        for name in DETAILS
    ]
    lines = ['<fieldset class="details">', f"<legend>{phrases['web_detail']}</legend>", *buttons, "</fieldset>"]
    return "\n".join(lines)


def levels(bodies: Mapping[str, str]) -> str:
    """Return the bodies of all levels, of which the choice shows one."""
    return "\n".join(f'<div data-detail="{name}">\n{body}\n</div>' for name, body in bodies.items())


def live_link(web: WebPage, language: str) -> str:
    """Return the link to the live page, if there is one."""
    if not web.live:
        return ""
    return f'<p class="live"><a href="{escape(web.live)}">{language_named(language).phrases["web_live"]}</a></p>'


def folded(solution: str, language: str) -> str:
    """Return a solution that is shown when it is opened."""
    word = language_named(language).phrases["web_solution"]
    return f'<details class="solution">\n<summary>{word}</summary>\n{solution}\n</details>'
