"""The words of a page that belong to no phrase, and how things are counted.

`WORDS` has the code of the language (that of HTML), its name for LaTeX's babel where it needs one, the decimal mark,
numbers in words from 0, the parts of a list, what the page calls its own parts, the words of references (`{ordinal}` of
an edition is `3rd`, `{number}` 3), and dates: the months from January, and how a day is written.  Each table of `COUNTS` says how many of a thing there are: under the number itself, `all` where it is all of them, or `other`.
`{word}` is the number in words, `{digits}` in digits.
"""

from __future__ import annotations

WORDS: dict[str, str] = {
    "code": "en",
    "babel": "",
    "decimal_mark": ".",
    "numbers": "no one two three four five six seven eight nine ten eleven twelve",
    "rank": "rank",
    "and": " and ",
    "rounded": " and, rounded, ",
    "state": "state {number}",
    "or": " or ",
    "one_of_states": "any one of the states {numbers}",
    "states": "states {choices}",
    "or_states": ", or ",
    "conventions": "Notation:",
    "observer_matrix": "observer matrix",
    "error": "error",
    "case": "Case",
    "caution": "Remark.",
    "sources": "References",
    "authors": " and ",
    "edition": "{ordinal} ed.",
    "chapter": "ch.",
    "section": "sec.",
    "months": "January February March April May June July August September October November December",
    "date": "{day} {month} {year}",
    "date_and_time": "{date}, {time}",
}

COUNTS: dict[str, dict[str, str]] = {
    "number": {"other": "{word}"},
    "varies": {"1": "varies", "other": "vary"},
    "interval": {"1": "one interval", "other": "{word} intervals"},
    "plane": {"0": "the plane", "other": "the admissible part of the plane"},
    "cell": {"1": "one cell", "other": "{word} cells"},
    "stable_cell": {
        "0": "in none of them are all roots stable",
        "all": "in each of them all roots are stable",
        "1": "in exactly one cell all roots are stable",
        "other": "in exactly {word} cells all roots are stable",
    },
    "on_interval": {"0": "none of them", "all": "all of them", "1": "one of them", "other": "{word} of them"},
    "piece": {"1": "one piece", "other": "{word} pieces"},
    "of_them": {
        "0": "none of them is",
        "all": "all of them are",
        "1": "one of them is",
        "other": "{word} of them are",
    },
    "only_real_root": {"other": "the only real root"},
    "real_root": {
        "1": "the first real root from the left",
        "2": "the second real root from the left",
        "3": "the third real root from the left",
        "4": "the fourth real root from the left",
        "5": "the fifth real root from the left",
        "6": "the sixth real root from the left",
        "other": "the {digits}th real root from the left",
    },
    "free_parameter": {
        "0": "no parameter is free",
        "1": "one parameter is free",
        "other": "{word} parameters are free",
    },
    "free_entry": {"1": "one entry is arbitrary", "other": "{word} entries are arbitrary"},
    "step": {"1": "one step", "other": "{word} steps"},
    "root_lies": {"0": "no root lies", "1": "one root lies", "other": "{word} roots lie"},
    "sign_changes": {
        "0": "does not change sign",
        "1": "changes sign once",
        "2": "changes sign twice",
        "other": "changes sign {word} times",
    },
}
