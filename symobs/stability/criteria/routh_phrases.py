"""Sentences on Routh's table: remarks beside its rows, and its findings."""

from __future__ import annotations

PHRASES: dict[str, str] = {
    "routh_table": "The Routh array of {polynomial} is",
    "routh_row_epsilon": "{epsilon} in place of 0",
    "routh_row_auxiliary": "derivative of {auxiliary}",
    "routh_row_derivative": "derivative of the row above",
    "routh_where": "where",
    "routh_positive": "All entries of the first column are positive, so all roots lie in the open left half-plane.",
    "routh_negative": "All entries of the first column are negative, so all roots lie in the open left half-plane.",
    "routh_criterion_positive": "All roots lie in the open left half-plane if and only if all entries of the first column are positive.",
    "routh_criterion_negative": "All roots lie in the open left half-plane if and only if all entries of the first column are negative.",
    "routh_criterion_where": "If {leading}, all roots lie in the open left half-plane if and only if all entries of the first column have the same sign.",
    "routh_epsilon": "The first entry of a row is zero, but the row is not; the entry is replaced by a small {epsilon}.",
    "routh_zero_row": "An entire row is zero; it is replaced by the derivative of the auxiliary polynomial, whose coefficients are in the row above.",
    "routh_divides": "The auxiliary polynomial {auxiliary} divides the polynomial; its roots are symmetric about the origin.",
    "routh_not_stable": "A zero in the first column means that not all roots lie in the open left half-plane.",
    "routh_changes": "The first column {changes}, so {right} in the open right half-plane.",
    "routh_changes_axis": "The first column {changes}, so {right} in the open right half-plane; {axis} on the imaginary axis.",
    "routh_misleads": "Here the signs of the first column for small {epsilon} do not give the number of right-half-plane roots; an exact count gives: {right} in the open right half-plane, and {axis} on the imaginary axis.",
}

DEMANDS: dict[str, str] = {
    "routh_positive": "finding",
    "routh_negative": "finding",
    "routh_criterion_positive": "finding",
    "routh_criterion_negative": "finding",
    "routh_criterion_where": "finding",
    "routh_epsilon": "finding",
    "routh_zero_row": "finding",
    "routh_divides": "finding",
    "routh_not_stable": "finding",
    "routh_changes": "finding",
    "routh_changes_axis": "finding",
    "routh_misleads": "finding",
}

RESTS_ON: dict[str, str] = {
    "routh_positive": "routh",
    "routh_negative": "routh",
    "routh_criterion_positive": "routh",
    "routh_criterion_negative": "routh",
    "routh_criterion_where": "routh",
    "routh_not_stable": "routh",
    "routh_changes": "routh",
    "routh_changes_axis": "routh",
}

THEOREMS: dict[str, str] = {
    "routh": "routh1877",
}

EXPLAINS = (
    "routh_criterion_positive",
    "routh_divides",
    "routh_epsilon",
    "routh_zero_row",
)

#: Phrases that go on with the sentence before them.
CONTINUES = (
    "routh_row_auxiliary",
    "routh_row_derivative",
    "routh_where",
)
