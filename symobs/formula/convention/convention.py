"""Conventions: the letters and signs of pages, of input, and of expected answers.

The mathematics is the same in all of them; the standard one is u = −K x̂, A − L C, e = x − x̂.  Those of the source
documents come with the package as small TOML files (`profiles/`), and a user adds one by writing another (`reading`).

Reading a convention from a small TOML file.

name = "lecture"
title = "our lecture notes"
feedback = "u = K x_hat"          # or "u = -K x_hat"
observer = "A + M C"              # the observer matrix: the letter of its gain, and the sign
pair = "[A, C]"                   # brackets and order of the pair that is observable
[letters]                         # standard letter = what is written in its place
e = "x_bar"
[letters_of_reduced_order]        # besides, where a reduced-order observer has F, G, H, M of its own
M_z = "S"
"""

from __future__ import annotations

import re
import tomllib
from dataclasses import field
from functools import cache, cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any
from unicodedata import normalize

from symobs.formula.notation import FUNCTIONS, GREEK_LATEX, GREEK_LETTERS, LETTERS, SUBSCRIPTS, LetterForm
from symobs.formula.parser_limits import refuse_costly
from symobs.ground.dataclass import dataclass
from symobs.ground.errors import InputError, ProblemErrors, UsageError, reason_of

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence


# Forms of the letters of a convention: from the typed letter to LaTeX and to the terminal.


_ACCENTS = {"bar": "\N{COMBINING MACRON}", "tilde": "\N{COMBINING TILDE}", "hat": "\N{COMBINING CIRCUMFLEX ACCENT}"}
_ARGUMENT = re.compile(r"\(.*\)$")


def letter_form(name: str, standard: LetterForm) -> LetterForm:
    """Return the form of a typed letter such as `M`, `x_bar` or `r_o`.

    What the standard letter is a function of stays behind it: `r_o` for φ(s) is r_o(s).
    """
    stem, *marks = name.split("_")
    letters = stem.rstrip("0123456789")
    latex, text = GREEK_LATEX.get(letters) or _slanted(letters), GREEK_LETTERS.get(letters, letters)
    for accent in [mark for mark in marks if mark in _ACCENTS]:
        latex = rf"\{accent} {latex}" if len(latex) == 1 else rf"\{accent}{{{latex}}}"
        text = normalize("NFC", text + _ACCENTS[accent])
    below = ",".join(filter(None, [stem[len(letters) :], *(mark for mark in marks if mark not in _ACCENTS)]))
    if below.isdigit():
        latex, text = latex + (f"_{below}" if len(below) == 1 else f"_{{{below}}}"), text + below.translate(SUBSCRIPTS)
    elif below:
        latex, text = rf"{latex}_{{\mathrm{{{below}}}}}", f"{text}_{below}"
    behind = _ARGUMENT.search(standard.text)
    argument = behind[0] if behind else ""
    return LetterForm(latex + argument, text + argument, standard.spoken)


def _slanted(letters: str) -> str:
    return letters if len(letters) == 1 else rf"\mathit{{{letters}}}"


def of_polynomial(name: str, sign: int, factors: Sequence[LetterForm]) -> dict[str, LetterForm]:
    """Return the forms of the polynomial of A plus or minus a product, as a letter and as a function."""
    mark, spoken = "+" if sign > 0 else "-", LETTERS[name].spoken
    latex = rf"\chi_{{A{mark}{''.join(factor.latex for factor in factors)}}}"
    text = f"χ_(A{mark}{''.join(factor.text for factor in factors)})"
    return {
        name: LetterForm(f"{latex}({{v}})", f"{text}({{v}})", spoken),
        f"{name}_at": LetterForm(latex, text, spoken),
    }


def of_determinant(gramian: LetterForm) -> dict[str, LetterForm]:
    """Return the form of the determinant of the Gramian up to t."""
    return {"det_W": LetterForm(rf"\det {gramian.latex}", f"det {gramian.text}", LETTERS["det_W"].spoken)}


# Conventions: the letters and signs of pages, of input, and of expected answers.
#
# The mathematics is the same in all of them; the standard one is u = −K x̂, A − L C, e = x − x̂. Those of the source
# documents come with the package as small TOML files (`profiles/`), and a user adds one by writing another (`reading`).


#: The letters whose meaning changes its sign with the control law, and those with the observer matrix.
FEEDBACK_GAINS = frozenset({"K", "K_1", "K_2", "K_0", "K_s", "K_G", "K_y", "K_r"})
OBSERVER_GAINS = frozenset({"L", "L_0", "L_s", "L_G", "L_r"})
#: Letters that a page has only where it speaks of an observer whose state is no estimate of x, of reduced order mostly.
OF_REDUCED_ORDER = frozenset({"F_z", "G_z", "H_z", "M_z", "A_12", "H_d"})


@dataclass
class Convention:
    """Letters and signs.

    feedback_sign   of K x̂ in the control law, −1 in u = −K x̂
    observer_sign   of L C in the observer matrix, −1 in A − L C
    brackets        around a pair of matrices; with `state_first` the observable pair is A, C and not C, A
    letters         key of `notation.LETTERS` → what is written in its place
    reduced         the same, on pages with a reduced-order observer besides
    """

    name: str
    title: str = ""
    feedback_sign: int = -1
    observer_sign: int = -1
    brackets: tuple[str, str] = ("(", ")")
    state_first: bool = False
    letters: Mapping[str, str] = field(default_factory=dict)
    reduced: Mapping[str, str] = field(default_factory=dict)

    @property
    def is_standard(self) -> bool:
        """Whether this is the standard convention."""
        return self == STANDARD

    @cached_property
    def turned(self) -> frozenset[str]:
        """The letters that denote the negative of their standard meaning."""
        feedback = FEEDBACK_GAINS if self.feedback_sign > 0 else frozenset()
        return feedback | (OBSERVER_GAINS if self.observer_sign > 0 else frozenset())

    def written(self, *, reduced: bool) -> Mapping[str, str]:
        """Return the forms of the letters that differ; with `reduced` those of a reduced-order observer."""
        return {**self.letters, **self.reduced} if reduced else self.letters

    def forms(self, *, reduced: bool) -> Mapping[str, LetterForm]:
        """Return the forms of the letters that differ from the standard convention."""
        changed = self._with_components(self.written(reduced=reduced))
        forms = {name: letter_form(text, LETTERS[name]) for name, text in changed.items()}
        forms |= {f"{name}_at": form.alone for name, form in forms.items() if f"{name}_at" in FUNCTIONS}
        for name, sign, factors in (("chi_K", self.feedback_sign, "BK"), ("chi_L", self.observer_sign, "LC")):
            if sign > 0 or not changed.keys().isdisjoint(factors):
                forms |= of_polynomial(name, sign, [forms.get(letter, LETTERS[letter]) for letter in factors])
        return forms | of_determinant(forms["W_t"]) if "W_t" in forms else forms

    @staticmethod
    def _with_components(written: Mapping[str, str]) -> Mapping[str, str]:
        """Return the letters with those of the components of the estimate: x_01, x_02 for the estimate x_0."""
        estimate = written.get("x_hat", "")
        numbered = estimate if estimate[-1:].isdigit() else f"{estimate}_"
        components = {name: f"{numbered}{name[-1]}" for name in ("x_hat_1", "x_hat_2") if estimate}
        digits = {f"{name}_r": f"{written[name]}_hat" for name in ("K", "L") if name in written}
        return {**components, **digits, **written}

    @property
    def law(self) -> str:
        """The control law, as typed."""
        return f"u = {'-' * (self.feedback_sign < 0)}{self.letters.get('K', 'K')} x_hat"

    @property
    def observer_matrix(self) -> str:
        """The observer matrix, as typed."""
        return f"A {'-' if self.observer_sign < 0 else '+'} {self.letters.get('L', 'L')} C"

    @property
    def pair(self) -> str:
        """The observable pair."""
        opening, closing = self.brackets
        return f"{opening}{'A, C' if self.state_first else 'C, A'}{closing}"


STANDARD = Convention("standard", "the standard convention of the field")


# Conventions by name: those of the package, and those of a folder or a file.


PROFILES = Path(__file__).parent / "profiles"


#: Short names that stay readable.
ALIASES = {
    "S0": "minusK-minusLC-gramianM",
    "S1": "plusK-plusMC",
    "S2": "minusK-minusLC-estimate-x0",
    "S3": "minusK-minusLC",
    "S4": "plusK-minusHC",
}


def convention_named(name: str, folder: Path | None = None) -> Convention:
    """Return a convention: one of the package, of a law, `NAME.toml` in `folder`, or the file of a path ending in .toml.

    A law is control law and observer matrix, "u = K x_hat, A + M C"; the first convention of the package that has both
    is taken, with its letters, else one that differs from the standard one in them alone.

    Raises `UsageError` naming those that exist, and `ProblemErrors` with everything that is wrong in a file.
    """
    if name == STANDARD.name:
        return STANDARD

    if "=" in name:
        return _of_law(name)
    name = ALIASES.get(name, name)
    if name.endswith(".toml"):
        return of_file(Path(name))
    for place in (PROFILES, folder):
        path = None if place is None or not is_name(name) else place / f"{name}.toml"
        if path is not None and path.is_file():
            return of_file(path)
    beside = f", or write {name}.toml beside the problem file" if is_name(name) else ""
    raise UsageError(f'"{name[:_SHOWN]}" is not a convention', repair=f"use one of {', '.join(conventions())}{beside}")


def _of_law(text: str) -> Convention:
    """Return the convention of a control law and an observer matrix; raises `UsageError`."""
    law, _, matrix = text.partition(",")
    try:
        found = read_convention({"name": "own", "feedback": law, "observer": matrix}, "law")
    except ProblemErrors as error:
        reasons = "; ".join(str(each) for each in error.errors)
        message = f'"{text[:_SHOWN]}" is not a control law and an observer matrix: {reasons}'
        raise UsageError(message, repair='write for example "u = K x_hat, A + M C"') from None
    same = (each for each in conventions().values() if _laws(each) == _laws(found))
    return next(same, found)


def _laws(convention: Convention) -> tuple[str, str]:
    """Return the control law and the observer matrix."""
    return convention.law, convention.observer_matrix


def conventions() -> dict[str, Convention]:
    """Return the conventions that come with the package, by name."""
    return {STANDARD.name: STANDARD} | {path.stem: of_file(path) for path in sorted(PROFILES.glob("*.toml"))}


_MOST_BYTES = 20_000
_SHOWN = 40
_NAME = re.compile(r"[A-Za-z][A-Za-z0-9_-]{0,39}")
_SPELLING = r"[A-Za-z]+[0-9]*(?:_[A-Za-z0-9]+)*"
_LETTER = re.compile(_SPELLING)
#: The same in a law, no longer than a letter may be.
_GAIN = rf"(?=\w{{1,{_SHOWN}}}\b)({_SPELLING})"


#: Each key with the pattern of its text, what stands there where it is left out, and what to write.
_TEXTS = {
    "name": (_NAME, None, 'write name = "lecture"'),
    "title": (re.compile(r"[^\x00-\x1f]{0,200}"), "", "write a short text in quotes"),
    "feedback": (
        re.compile(rf"\s*u\s*=\s*([-+−]?)\s*{_GAIN}\s*x_hat\s*"),
        "u = -K x_hat",
        'write "u = -K x_hat" or "u = K x_hat"',
    ),
    "observer": (
        re.compile(rf"\s*A\s*([-+−])\s*{_GAIN}\s+C\s*"),
        "A - L C",
        'write for example "A - L C" or "A + M C"',
    ),
    "pair": (
        re.compile(r"(?:(\()|(\[)|(\{))\s*(A\s*,\s*C|C\s*,\s*A)\s*(?(1)\))(?(2)\])(?(3)\})"),
        "(C, A)",
        'write for example "(C, A)" or "[A, C]"',
    ),
}


_TABLES = ("letters", "letters_of_reduced_order")
#: Letters that nearly every page speaks of: no other letter may be written like one of them.
_COMMON = ("A", "B", "C", "D", "K", "L", "x", "x_hat", "u", "y", "e", "F", "T")


def is_name(text: str) -> bool:
    """Return whether a text can be the name of a convention."""
    return _NAME.fullmatch(text) is not None


@cache
def of_file(path: Path) -> Convention:
    """Return the convention of a file; raises `ProblemErrors` with every error in it."""
    where = path.name[:200]
    try:
        with path.open("rb") as stream:
            raw = stream.read(_MOST_BYTES + 1)
        if len(raw) > _MOST_BYTES:
            raise ValueError(f"it is longer than {_MOST_BYTES} bytes")  # noqa: TRY301 - said like every other reason
        text = raw.decode()
        refuse_costly(text, _MOST_BYTES)
        table = tomllib.loads(text)
    except (OSError, ValueError, RecursionError) as error:
        message = f"no convention can be read: {reason_of(error)}"
        raise ProblemErrors((InputError(message, where=where, repair="write a small TOML file"),)) from None
    return read_convention(table, where)


def read_convention(table: Mapping[str, Any], where: str) -> Convention:
    """Return the convention of a table; raises `ProblemErrors` with every error in it."""
    errors: list[InputError] = []
    known = (*_TEXTS, *_TABLES)
    repair = f"known keys are {', '.join(known)}"
    errors += [InputError("unknown key", where=key[:_SHOWN], repair=repair) for key in table if key not in known]
    texts = {key: _text(table, key, errors) for key in _TEXTS}
    letters, reduced = (_letters(table, key, errors) for key in _TABLES)
    law, matrix, pair = texts["feedback"], texts["observer"], texts["pair"]
    if law and matrix:
        gains = {standard: found[2] for standard, found in (("K", law), ("L", matrix)) if found[2] != standard}
        letters = {**gains, **letters}
        errors += [*_shared(letters, _TABLES[0]), *_shared({**letters, **reduced}, _TABLES[1])]
    if errors or not (law and matrix and pair and texts["name"] and texts["title"]):
        for error in errors:
            error.where = f"{where}, {error.where}"
        raise ProblemErrors(tuple({str(error): error for error in errors}.values()))
    brackets = next(both for both, found in zip(("()", "[]", "{}"), pair.groups(), strict=False) if found)
    return Convention(
        texts["name"][0],
        texts["title"][0],
        1 if law[1] in {"", "+"} else -1,
        1 if matrix[1] == "+" else -1,
        (brackets[0], brackets[1]),
        state_first=pair[4].startswith("A"),
        letters=letters,
        reduced=reduced,
    )


def _text(table: Mapping[str, Any], key: str, errors: list[InputError]) -> re.Match[str] | None:
    """Return the match of the text of a key; an error is recorded if there is none."""
    pattern, usual, repair = _TEXTS[key]
    value = table.get(key, usual)
    found = pattern.fullmatch(value) if isinstance(value, str) else None
    if found is None:
        errors.append(InputError("this cannot be read" if key in table else "it is missing", where=key, repair=repair))
    return found


def _letters(table: Mapping[str, Any], key: str, errors: list[InputError]) -> dict[str, str]:
    """Return a table of letters; errors are recorded."""
    value = table.get(key, {})
    if not isinstance(value, dict):
        errors.append(InputError("a table is expected", where=key, repair=f"write [{key}] and the letters below it"))
        return {}
    found: dict[str, str] = {}
    for name, text in value.items():
        place = f"{key}.{name[:_SHOWN]}"
        if name not in LETTERS or name == "s":
            errors.append(InputError("the standard convention has no such letter", where=place, repair=_nearest(name)))
        elif not isinstance(text, str) or not _LETTER.fullmatch(text) or len(text) > _SHOWN:
            repair = 'write for example "M", "x_bar" or "r_o"'
            errors.append(InputError("a letter is expected", where=place, repair=repair))
        else:
            found[name] = text
    return found


def _nearest(name: str) -> str:
    from difflib import get_close_matches  # noqa: PLC0415 - needed for messages only

    near = get_close_matches(name[:_SHOWN], LETTERS, 1)
    return f"did you mean {near[0]}?" if near else "write a letter of the standard convention, such as K, L or e"


def _shared(written: Mapping[str, str], key: str) -> list[InputError]:
    """Return an error for each letter with the form of another letter of the pages."""
    errors: list[InputError] = []
    for name, text in written.items():
        others = [other for other in _COMMON if other != name and written.get(other, other) == text]
        if others:
            message = f"{text} would stand for {name} and for {others[0]}"
            errors.append(InputError(message, where=f"{key}.{name}", repair="give each a letter of its own"))
    return errors


# The list of conventions: laws, observers and letters, or the file of one.


_HEAD = ("name", "control law", "observer matrix", "observable pair")


_OF_STANDARD = """\
# The standard convention. Write a file like this one for another.
name = "standard"
title = "the standard convention of the field"
feedback = "u = -K x_hat"
observer = "A - L C"
pair = "(C, A)"

[letters]  # standard letter = what is written in its place

[letters_of_reduced_order]  # the same, on pages with a reduced-order observer
"""


def listed() -> str:
    """Return a table of all conventions, and below it their letters that differ from the standard ones."""
    known = conventions()
    rows = [
        _HEAD,
        *((name, _shown(found.law), _shown(found.observer_matrix), found.pair) for name, found in known.items()),
    ]
    widths = [max(len(row[column]) for row in rows) for column in range(len(_HEAD))]
    lines = ["   ".join(cell.ljust(width) for cell, width in zip(row, widths, strict=True)).rstrip() for row in rows]
    lines.insert(1, "   ".join("─" * width for width in widths))
    for name, found in known.items():
        lines += ["", f"{name}: {found.title}", *_listed_letters(found)]
    lines += ["", "The error is x − x̂ and the compensator F(s) stands in negative feedback, in all of them."]
    lines += [
        "`symobs conventions NAME` prints the file of one, from which to make your own: NAME.toml beside the problem."
    ]
    return "\n".join(lines) + "\n"


def _shown(typed: str) -> str:
    """Return a law as printed."""
    return typed.replace("x_hat", "x̂").replace("-", "−")


def _listed_letters(found: Convention) -> list[str]:
    """Return the lines on the letters that differ from the standard convention."""
    lines: list[str] = []
    for letters, reduced in ((found.letters, False), (found.reduced, True)):
        forms, where = found.forms(reduced=reduced), " (with a reduced-order observer)" if reduced else ""
        for letter in letters:
            usual, own = (form.text.replace("{v}", "s") for form in (LETTERS[letter], forms[letter]))
            stays = " stays" if own == usual else f" for {usual}"
            lines.append(f"    {own}{stays}, {LETTERS[letter].spoken}{where}")
    return lines


def file_of(name: str) -> str:
    """Return the TOML of a convention; raises `UsageError` naming those that exist."""
    found = convention_named(name).name
    if found == STANDARD.name:
        return _OF_STANDARD
    path = Path(name) if name.endswith(".toml") else PROFILES / f"{found}.toml"
    if not path.is_file():
        raise UsageError("no convention of the package has this law", repair="write a file like that of standard")
    return path.read_text("utf-8")
