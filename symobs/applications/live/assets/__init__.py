"""What every page is made of, whoever hands it out: its script with the words of all languages, and its style."""

from __future__ import annotations

import json
import re
from collections.abc import Mapping
from pathlib import Path

from symobs.formula.phrases.languages import ENGLISH, Language, language_named, languages

#: The protocol that the script speaks; a request is at most so long.
SCHEMA, MOST_BYTES = "symobs-live/1", 64 * 1024
ASSETS = Path(__file__).parent
#: The style of derivations, read where it lies: who hands out pages need not import what writes them.
_OF_DOCUMENTS = ASSETS.parents[2] / "pages" / "formats" / "html_body.css"
#: The modules of the script, each behind those that it imports, and how it imports them.
MODULES = ("numbers.js", "link.js", "elements.js", "curves.js", "symobs-live.js")
_IMPORT = re.compile(r'^import \{[^}]*\} from "\./[a-z-]+\.js";\n', re.MULTILINE)
#: The phrases that the script shows.
_PREFIX = "live_"


def words() -> dict[str, dict[str, str]]:
    """Return the words of the script in every language, by its code; with them the mark of decimals."""
    found = {}
    for code in languages():
        language = language_named(code)
        own = {key.removeprefix(_PREFIX): text for key, text in language.phrases.items() if key.startswith(_PREFIX)}
        found[code] = own | {"decimal_mark": language.words["decimal_mark"]}
    return found


def language_asked(request: object) -> Language:
    """Return the language that the problem of a request names, English where it names none that there is."""
    problem = request.get("problem") if isinstance(request, Mapping) else None
    code = problem.get("language") if isinstance(problem, Mapping) else None
    return language_named(code) if isinstance(code, str) and code in languages() else ENGLISH


def script() -> str:
    """Return the script as one module, which begins with the words of no language."""
    parts = [_IMPORT.sub("", (ASSETS / name).read_text(encoding="utf-8")) for name in MODULES]
    return f"{''.join(parts)}Object.assign(LANGUAGES, {json.dumps(words(), ensure_ascii=False)});\n"


def style() -> str:
    """Return the style of the page and of the derivations in it."""
    return "\n".join(path.read_text(encoding="utf-8") for path in (ASSETS / "live.css", _OF_DOCUMENTS))
