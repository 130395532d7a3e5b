"""Stability regions: what is asked, where roots can cross, and what the region looks like."""

from __future__ import annotations

PHRASES: dict[str, str] = {
    "stability_region": "Stability region.",
    "polynomial_given": "The polynomial is",
    "gain_open": "The gain is left open,",
    "sought_continuous": "Sought are all values of {names} for which every root has a negative real part.",
    "sought_discrete": "Sought are all values of {names} for which every root lies in the open unit disc.",
    "sought_margin": "Sought are all values of {names} for which every root has a real part below {limit}; a root that has is called stable here.",
    "sought_radius": "Sought are all values of {names} for which every root has an absolute value below {limit}; a root that has is called stable here.",
    "polynomial_of_loop": "The characteristic polynomial is",
    "moved_right": "Moved to the right by {by}, the roots are those of",
    "enlarged": "Divided by {by}, the roots are those of",
    "left_half_plane": "which must have all of them in the open left half plane.",
    "unit_disc": "which must have all of them in the open unit disc.",
    "root_on_circle": "Whatever the values, not all roots lie in the open unit disc:",
    "mapped": "The map from $w$ to {image} carries the open left half plane to the open unit disc, so all roots lie in the disc exactly where those "
    "of this polynomial lie in the left half plane:",
    "mapped_from_v": "The map from $v$ to {image} carries the open left half plane to the open unit disc, so all roots lie in the disc exactly where those "
    "of this polynomial lie in the left half plane:",
    "crossing_one": "As {names} {vary}, the root leaves the left half plane only through 0: where this vanishes.",
    "crossing": "As {names} {vary}, a root leaves the left half plane only through 0 or with another one through the imaginary axis: where one of these "
    "vanishes.",
    "crossing_infinite": "As {names} {vary}, a root leaves the left half plane only through 0, with another one through the imaginary axis or through infinity, "
    "where the leading coefficient vanishes: where one of these is zero. Values at which a root is lost in this way do not count.",
    "crossing_one_discrete": "As {names} {vary}, the root leaves the disc only at 1 or at −1: where one of these vanishes.",
    "crossing_discrete": "As {names} {vary}, a root leaves the disc only at 1, at −1 or with another one through the circle: where one of these vanishes.",
    "hurwitz_determinant": "with the determinant of Hurwitz",
    "always_critical": "One of them is zero whatever the values: there is always a root that is not stable.",
    "region_is": "So all roots are stable exactly where",
    "region_empty": "There are no such values.",
    "region_everywhere": "So all roots are stable for all values of {names}.",
    "points_decide": "Between {points} on the line nothing changes, so one rational value decides for a whole interval: all roots are stable on {stable}.",
    "point_decides": "On either side of this point nothing changes, so one rational value decides for a whole side: all roots are stable on {stable}.",
    "cells_decide": "These curves, with lines through the points where they turn or meet, cut the plane into {cells}. Inside one nothing changes, so one "
    "rational point decides for all of it: {stable} stable.",
    "point_missing": "The value {name} = {point} itself is not among them.",
    "criterion": "By the criterion of Liénard and Chipart all roots are stable exactly where",
    "criterion_long": "The criterion of Liénard and Chipart asks for {count} polynomials to be positive.",
    "shortened": "What the others and the declared signs imply can be left out. So all roots are stable exactly where",
    "case_region": "All roots are stable exactly where",
    "case_everywhere": "All roots are stable.",
    "case_nowhere": "Not all roots are stable, whatever the values.",
    "box_bounded": "The region is a product of intervals: it is connected, convex and bounded.",
    "box_unbounded": "The region is a product of intervals: it is connected and convex, and not bounded.",
    "not_divided": "The curves on which stability can change are too many or of too high a degree for the plane to be divided here: the "
    "inequalities are exact, the shape of the region is not described.",
    "connected_bounded": "The region is connected and bounded.",
    "connected_unbounded": "The region is connected and not bounded.",
    "pieces": "The region has {count} that are not connected; {bounded} bounded.",
    "hole": "The single point ({first}, {second}) = ({x}, {y}) does not belong to it, though everything around it does.",
    "curve_missing": "The curve {curve} does not belong to it, though the region lies on both sides of a part of it.",
    "number_is_root": "Here {number} is {which} of {equation}.",
    "poles_move": "As {names} grows, the roots move like this.",
    "parts_are": "Solved for the parameters:",
}

QUESTIONS: dict[str, str] = {
    "ask stability_region": "Is the polynomial $chi_p$ stable?",
    "ask stability_region K": "Is the loop with the feedback gain $K$ stable?",
    "ask stability_region L": "Is the observer with the gain $L$ stable?",
    "ask stability_region K L": "Is the loop with the feedback gain $K$ and the observer gain $L$ stable?",
    "ask stability_region parameters": "For which {parameters} is the polynomial $chi_p$ stable?",
    "ask stability_region K parameters": "For which {parameters} is the loop with the feedback gain $K$ stable?",
    "ask stability_region L parameters": "For which {parameters} is the observer with the gain $L$ stable?",
    "ask stability_region K L parameters": "For which {parameters} is the loop with the feedback gain $K$ and the observer gain $L$ stable?",
    "also stability_region polynomial": "The polynomial is {polynomial}.",
    "also stability_region margin": "Every root is to lie to the left of the imaginary axis by more than {margin}.",
    "also stability_region radius": "Every root is to have an absolute value below {radius}.",
}

ASSERTS: dict[str, tuple[str, ...]] = {
    "case_everywhere": ("stable",),
    "case_nowhere": ("unstable",),
}

DEMANDS: dict[str, str] = {
    "sought_margin": "sets_margin",
    "sought_radius": "sets_radius",
    "moved_right": "moves_by_margin",
    "enlarged": "scales_by_radius",
    "mapped": "applies_image",
    "mapped_from_v": "applies_image",
}

RESTS_ON: dict[str, str] = {
    "cells_decide": "collins",
    "points_decide": "sturm",
    "point_decides": "sturm",
    "crossing": "orlando",
    "crossing_infinite": "orlando",
    "crossing_discrete": "orlando",
    "criterion": "lienard_chipart",
    "criterion_long": "lienard_chipart",
}

THEOREMS: dict[str, tuple[str, str]] = {
    "sturm": ("Sturm's theorem", "C. Sturm, 1829"),
    "orlando": ("Orlando's formula", "L. Orlando, Math. Ann. 71 (1911), 233-245"),
    "collins": ("cylindrical decomposition", "G. E. Collins, 1975"),
    "lienard_chipart": (
        "criterion of Liénard and Chipart",
        "A. Liénard and M. H. Chipart, J. Math. Pures Appl. 10 (1914), 291-346",
    ),
}

NAMING = (
    "moved_right",
    "enlarged",
    "sought_margin",
    "sought_radius",
    "mapped",
    "mapped_from_v",
)

EXPLAINS = (
    "left_half_plane",
    "unit_disc",
    "crossing",
    "crossing_one",
    "crossing_infinite",
    "crossing_discrete",
    "cells_decide",
    "points_decide",
    "point_decides",
)
