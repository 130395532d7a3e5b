"""What sentences say of a problem, observable or P is positive definite, and conditions that are no chain: h ∈ (−3, 6).

Each is rewritten as a verdict or as inequalities, which are judged as all others are.
"""

from __future__ import annotations

import re
from typing import NamedTuple

from symobs.applications.grader.claims import WORDS as VERDICTS

# -- sentences ---------------------------------------------------------------------------------------------------------


#: What a sentence may say, the words for it, and what has it: a task, or a field that is yes or no.
PROPERTIES = {
    "observability": r"observable|beobachtbar",
    "controllability": r"controllable|reachable|steuerbar|erreichbar",
    "detectability": r"detectable|detektierbar|entdeckbar",
    "stabilizability": r"stabili[sz]able|stabilisierbar",
    "positive_definite": r"positive[- ]definite|positiv(?:e|er)? definit",
    "stable": r"(?:asymptotically |asymptotisch )?(?:stable|stabil)",
}
_ANY = "|".join(PROPERTIES.values())
_NOT = r"(?:\b(?:not|nicht|isn't)\s+|\b(?:un|in)(?=[a-z]))"
_ADVERBS = r"(?:(?:completely|fully|state|vollständig|zustands?-?|thus|hence|therefore|also|damit|somit)\s+)*"
_SUBJECT = (
    r"(?:(?:so|thus|hence|therefore|also|damit|somit)\s+)?"
    r"(?:(?:the|this|das|die|der)\s+)?(?:(?:system|plant|pair|strecke|paar|state|zustand|matrix|(?-i:[A-Z])|\([^()]{1,9}\))\s+)?"
    r"(?:(?:is|ist)\s+)?(?:(?:the|das|die)\s+(?:system|plant|strecke|matrix)\s+)?"
)
_SENTENCE = re.compile(rf"{_SUBJECT}{_ADVERBS}(?P<no>{_NOT})?{_ADVERBS}(?P<what>{_ANY})[.!]?", re.IGNORECASE)
#: A remark behind a value: P = [...], P is positive definite; P = [...] > 0.
_BEHIND = re.compile(
    rf"[,;]?\s*(?:\b(?:and|und)\s+)?(?:\b(?:it|which|also|(?-i:[A-Z]))\s+)?(?:is|ist)\s+(?P<no>{_NOT})?(?P<what>{_ANY})[.!]?$",
    re.IGNORECASE,
)
_IS_POSITIVE = re.compile(r"(?P<value>[A-Z]\s*=\s*[^<>=]*[\])]|[A-Z])\s*(?:>|≻|\\succ)\s*0")
#: A number behind a value that only says what it is not: det O = 1 ≠ 0, rank O = 1 < 3.
_COMPARED = re.compile(
    r"(?!.*\b(?:where|for|if|für|falls|wenn)\b)((?:det|rank)\b[^=<>!]*=[^=<>!]*?)\s*(?:!=|≠|<=?|>=?)\s*-?\w+"
)


def verdict_of(text: str, *asked: str) -> str | None:
    """Return yes, no or conditional as a text says it of the task or field asked, `not observable`; None where it does not."""
    word = " ".join(text.replace('"', " ").lower().split())
    found = _SENTENCE.fullmatch(word) if len(word) <= _LONGEST else None
    if found and {_said(found).name, f"F_{_said(found).name}"} & {*asked}:
        return "yes" if _said(found).holds else "no"
    return VERDICTS.get(word)


#: Longer lines are no sentences, and no conditions in words: words of many kinds would be tried against them for long.
_LONGEST = 500


class Said(NamedTuple):
    """What a sentence says has a property, or has it not."""

    name: str
    holds: bool


def _said(found: re.Match[str]) -> Said:
    name = next(name for name, words in PROPERTIES.items() if re.fullmatch(words, found["what"], re.IGNORECASE))
    return Said(name, not found["no"])


def what_is_said(line: str) -> tuple[str, list[Said]]:
    """Return a line without what a sentence in it says, and that; a line of other words is as it was."""
    text = line.strip()
    if len(text) > _LONGEST:
        return line, []
    if found := _SENTENCE.fullmatch(text):
        return "", [_said(found)]
    if found := _IS_POSITIVE.fullmatch(text):
        return (found["value"] if "=" in found["value"] else ""), [Said("positive_definite", holds=True)]
    if "=" in text and (found := _BEHIND.search(text)):
        return text[: found.start()], [_said(found)]
    found = _COMPARED.fullmatch(text)
    return (found[1] if found else line), []


# -- conditions --------------------------------------------------------------------------------------------------------


_IF = (
    r"(?:if and only if|iff|if|exactly (?:if|when|where|for)|where|for(?: all)?|when|provided(?: that)?"
    r"|genau dann,?\s*wenn|genau für|für|falls|wenn|<=>|⇔|⟺)"
)
_CONDITION = r"(?=.*(?:[<>∈∉≠\\|]|!=|\bin\b|except))"
_HEAD = re.compile(
    rf"^(?:(?:routh|hurwitz|jury|(?:conditions?|bedingung(?:en)?)(?: of (?:routh|hurwitz))?)\s*[:=]\s*{_CONDITION}"
    rf"|{_SUBJECT}{_ADVERBS}(?:{_ANY})\s*(?:,\s*)?{_IF}\s*,?\s*{_CONDITION})",
    re.IGNORECASE,
)
_LETTER = r"(?<![\w.])([A-Za-z]\w*)"
_EXCEPT = re.compile(rf"{_LETTER}\s*(?:∉|(?:\\)?notin\b|not\s+in\b|nicht\s+in\b)\s*(?:\\)?\{{([^{{}}]*?)\\?\}}")
_REALS = re.compile(rf"{_LETTER}\s*(?:∈|\bin\b)\s*(?:R|ℝ|reals)\s*(?:\\|-|setminus|without|ohne)\s*\{{([^{{}}]*)\}}")
_ALL_BUT = re.compile(
    rf"(?:all\s+|alle\s+)?(?:real\s+|reellen?\s+)?{_LETTER}\s+(?:except|außer|apart from)\s+(?:for\s+)?(.*)",
    re.IGNORECASE,
)
_LOST = re.compile(
    rf"{_SUBJECT}{_ADVERBS}{_NOT}{_ADVERBS}(?:{_ANY})\s+(?:if and only if|iff|exactly for|for|where|if|für|falls|genau für)\s+"
    rf"((?:{_LETTER}\s*=\s*[^=]+))",
    re.IGNORECASE,
)
_INTERVAL = re.compile(
    rf"{_LETTER}\s*(?:∈|\bin\b|\\in\b)\s*([(\[\]])\s*([^,;()\[\]]+?)\s*[,;]\s*([^,;()\[\]]+?)\s*([)\[\]])"
)
_ABSOLUTE = re.compile(
    r"(?:\|([^|<>]+)\||(?<!\w)abs\(((?:[^()]|\([^()]*\))*)\))\s*(<=|>=|<|>)\s*([^<>|,;&]+?)(?=\s*(?:$|[,;&]|\band\b|\bor\b|\bund\b))"
)
#: A space by its vectors, ⟨v, w⟩, with the signs of inequalities.
_OF_ANGLES = re.compile(r"<\s*([(\[][^<>]*[)\]])\s*>")
_INFINITE = re.compile(r"[-+]?\s*(?:oo|inf|infinity|∞)")


def in_inequalities(line: str) -> str:
    """Return conditions as inequalities: -3 < h < 6 for h ∈ (-3, 6), a != 1, a != 2 for a ∉ {1, 2}, without words before."""
    if len(line) > _LONGEST:
        return line
    text = _OF_ANGLES.sub(r"span{\1}", line.replace("~=", "!=").replace("≠", "!="))
    if lost := _LOST.fullmatch(text.strip().rstrip(".")):
        parts = re.split(r"\s*(?:,|\bor\b|\boder\b|\band\b|\bund\b)\s*", lost[1])
        return ", ".join(part.replace("=", "!=", 1) for part in parts if "=" in part) or line
    text = _HEAD.sub("", text)
    if (but := _ALL_BUT.fullmatch(text.strip().rstrip("."))) is not None:
        values = re.sub(rf"(?<!\w){but[1]}\s*=\s*", "", but[2])
        values = re.sub(r"\s*(?:\band\b|\bund\b|,|\bor\b|\boder\b)\s*", ", ", values).strip("{} ")
        text = f"{but[1]} ∉ {{{values}}}"
    for pattern in (_REALS, _EXCEPT):
        text = pattern.sub(lambda f: ", ".join(f"{f[1]} != {value.strip()}" for value in f[2].split(",")), text)
    text = re.sub(r"\\?\b[lr]vert\b", "|", text)
    return _ABSOLUTE.sub(_without_bars, _INTERVAL.sub(_chain, text))


def _chain(found: re.Match[str]) -> str:
    """Return the inequalities of an interval; brackets that open outwards leave their ends out."""
    name, begin, low, high, end = found.groups()
    left = f"{low} {'<=' if begin == '[' else '<'} " if not _INFINITE.fullmatch(low) else ""
    right = f" {'<=' if end == ']' else '<'} {high}" if not _INFINITE.fullmatch(high) else ""
    return f"{left}{name}{right}" if left or right else found[0]


def _without_bars(found: re.Match[str]) -> str:
    """Return |x| < c as -c < x < c, and |x| > c as one of two conditions."""
    inside, order, bound = found[1] or found[2], found[3], found[4].strip()
    if order in {"<", "<="}:
        return f"-({bound}) {order} {inside.strip()} {order} {bound}"
    turned = order.replace(">", "<")
    return f"({inside.strip()} {order} {bound} or {inside.strip()} {turned} -({bound}))"
