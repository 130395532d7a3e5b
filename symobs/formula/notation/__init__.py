"""The vocabulary: every letter with its LaTeX and plain form, and the names of functions."""

from symobs.formula.notation.letters import (
    FUNCTIONS,
    GREEK,
    GREEK_LATEX,
    GREEK_LETTERS,
    LETTERS,
    OPERATORS,
    SIGNALS,
    SUBSCRIPTS,
    TIMED,
    LetterForm,
    is_of_time,
    printed_alike,
    sans_serif,
    shows_time,
    symbol_latex,
    symbol_text,
)

__all__ = [
    "FUNCTIONS",
    "GREEK",
    "GREEK_LATEX",
    "GREEK_LETTERS",
    "LETTERS",
    "OPERATORS",
    "SIGNALS",
    "SUBSCRIPTS",
    "TIMED",
    "LetterForm",
    "is_of_time",
    "printed_alike",
    "sans_serif",
    "shows_time",
    "symbol_latex",
    "symbol_text",
]
