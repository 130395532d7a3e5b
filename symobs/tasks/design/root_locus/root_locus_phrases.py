"""The root locus of a loop."""

from __future__ import annotations

PHRASES: dict[str, str] = {
    "root_locus": "Root locus.",
    "locus_controller": "The loop is closed by the controller, times the gain $k$,",
    "locus_gain": "The loop is closed by the gain $k$.",
    "locus_poles": "The denominator of the loop, without any cancelling, is",
    "locus_zeros": "its numerator, with the sign of the feedback, is",
    "locus_moved": "so that the poles of the closed loop are the roots of",
    "locus_begin": "Rule 1. For $k = 0$ the branches begin at the poles of the loop, {roots}.",
    "locus_end": "Rule 2. As the gain grows, branches end at the zeros of the loop, {roots}.",
    "locus_axis_odd": "Rule 3. A point of the real axis belongs to the locus if the number of poles and zeros to its right is odd.",
    "locus_axis_even": "Rule 3. A point of the real axis belongs to the locus if the number of poles and zeros to its right is even.",
    "locus_asymptotes": "Rule 4. The number of poles exceeds that of the zeros by {excess}: as many branches go to infinity, along asymptotes through {centroid}.",
    "locus_branch": "Rule 5. Branches meet at {real} for the gain {k}, rounded to six digits after the point: there the polynomial has a multiple root§.",
    "locus_branch_pair": "Rule 5. Branches meet at the pair with the real part {real} and the imaginary parts ±{imaginary} for the gain {k}, rounded to six digits after the point: there the polynomial has multiple roots§.",
    "locus_departure": "Rule 6. From the pole with real part {real} and imaginary part {imaginary} the branch departs at {angle} degrees, rounded to six digits after the point§.",
    "locus_arrival": "Rule 7. At the zero with real part {real} and imaginary part {imaginary} the branch arrives at {angle} degrees, rounded to six digits after the point§.",
    "locus_crossing": "Rule 8. A branch meets the imaginary axis at ±j{omega} for the gain {k}, rounded to six digits after the point§.",
    "locus_crossing_discrete": "Rule 8. A branch meets the unit circle at the angles ±{omega} for the gain {k}, rounded to six digits after the point§.",
    "locus_stability": "Rule 9. For which gains all roots are stable, follows from where they meet the boundary of stability.",
}

QUESTIONS: dict[str, str] = {
    "ask root_locus": "Sketch the root locus of the loop for gains from 0 on: find where branches meet, where they cross the boundary of stability, and for which gains the closed loop is stable.",
    "ask root_locus controller": "Sketch the root locus of the loop of the plant and the controller {controller}, times a gain, for gains from 0 on: find where branches meet, where they cross the boundary of stability, and for which gains the closed loop is stable.",
    "also root_locus gain_sign=-1": "The feedback is positive.",
}

DEMANDS: dict[str, str] = {
    "locus_begin": "poles_of chi_o",
    "locus_branch": "on_locus branch chi_o q",
    "locus_branch_pair": "on_locus branch chi_o q",
    "locus_departure": "on_locus departure chi_o q",
    "locus_arrival": "on_locus arrival chi_o q",
    "locus_crossing": "on_locus crossing chi_o q, continuous_time",
    "locus_crossing_discrete": "on_locus crossing chi_o q, discrete_time",
    "locus_axis_odd": "leads_with q positive",
    "locus_axis_even": "leads_with q negative",
    "locus_asymptotes": "has_asymptotes chi_o q",
}

RESTS_ON: dict[str, str] = {
    "locus_branch": "root_locus_rules",
    "locus_branch_pair": "root_locus_rules",
    "locus_departure": "root_locus_rules",
    "locus_arrival": "root_locus_rules",
    "locus_crossing": "root_locus_rules",
    "locus_crossing_discrete": "root_locus_rules",
}

THEOREMS: dict[str, str] = {
    "root_locus_rules": "ogata2010, ch. 6",
}

#: Phrases that go on with the sentence before them.
CONTINUES = ("locus_zeros", "locus_moved")

NAMING = (
    "locus_asymptotes",
    "locus_branch",
    "locus_branch_pair",
    "locus_departure",
    "locus_arrival",
    "locus_crossing",
    "locus_crossing_discrete",
)
