"""Sentences and questions of stability regions."""

from __future__ import annotations

PHRASES: dict[str, str] = {
    "stability_region": "Stability region.",
    "open_loop_asked": "This is the polynomial of $P$ itself, in which no parameter stands. The loop with unity feedback is asked for by polynomial = {polynomial}.",
    "gain_open": "The gain is left free,",
    "sought_continuous": "Find all values of {names} for which every root has negative real part.",
    "sought_discrete": "Find all values of {names} for which every root lies in the open unit disc.",
    "sought_margin": "Find all values of {names} for which every root has real part less than {limit}; such roots are called stable here.",
    "sought_radius": "Find all values of {names} for which every root has modulus less than {limit}; such roots are called stable here.",
    "wanted_margin": "Every root shall have real part less than {limit}; such roots are called stable here.",
    "wanted_radius": "Every root shall have modulus less than {limit}; such roots are called stable here.",
    "polynomial_of_loop": "The characteristic polynomial is",
    "moved_right": "Shifting the roots to the right by {by} gives the polynomial",
    "enlarged": "Dividing the roots by {by} gives the polynomial",
    "left_half_plane": "all of whose roots must lie in the open left half-plane.",
    "unit_disc": "all of whose roots must lie in the open unit disc.",
    "root_on_circle": "For no values of the parameters do all roots lie in the open unit disc:",
    "mapped": "The bilinear transformation from $w$ to {image} maps the open left half-plane onto the open unit disc, so all roots lie in the disc if and only if all roots of the following polynomial lie in the left half-plane:",
    "mapped_from_v": "The bilinear transformation from $v$ to {image} maps the open left half-plane onto the open unit disc, so all roots lie in the disc if and only if all roots of the following polynomial lie in the left half-plane:",
    "crossing_one": "As {names} {vary}, the root can leave the left half-plane only through the origin, that is, where the following vanishes.",
    "crossing": "As {names} {vary}, roots can leave the left half-plane only through the origin or in pairs through the imaginary axis, that is, where one of the following vanishes.",
    "crossing_infinite": "As {names} {vary}, roots can leave the left half-plane only through the origin, in pairs through the imaginary axis, or through infinity (where the leading coefficient vanishes), that is, where one of the following vanishes. Values at which the degree drops are excluded.",
    "crossing_one_discrete": "As {names} {vary}, the root can leave the disc only at 1 or at −1, that is, where one of the following vanishes.",
    "crossing_discrete": "As {names} {vary}, roots can leave the disc only at 1, at −1 or in conjugate pairs through the unit circle, that is, where one of the following vanishes.",
    "always_critical": "One of them vanishes identically: there is always a root that is not stable.",
    "region_is": "Hence all roots are stable if and only if",
    "region_empty": "The stability region is empty.",
    "region_everywhere": "Hence all roots are stable for all values of {names}.",
    "points_decide": "Between {points} on the line the number of stable roots is constant, so one rational test value per interval suffices: all roots are stable on {stable}.",
    "point_decides": "On either side of this point the number of stable roots is constant, so one rational test value per side suffices: all roots are stable on {stable}.",
    "cells_decide": "These curves, together with the lines {lines} = constant through their turning points and intersections, divide the plane into {cells}. In each of them the number of stable roots is constant, so one rational test point suffices: {stable} stable.",
    "point_missing": "The value {name} = {point} is excluded.",
    "criterion": "By the Liénard–Chipart criterion, all roots are stable if and only if",
    "criterion_long": "The Liénard–Chipart criterion requires {count} polynomials to be positive.",
    "shortened": "Conditions implied by the others and by the declared signs are omitted. Hence all roots are stable if and only if",
    "case_region": "All roots are stable if and only if",
    "case_everywhere": "All roots are stable.",
    "box_bounded": "The region is a product of intervals: it is connected, convex and bounded.",
    "box_unbounded": "The region is a product of intervals: it is connected, convex and unbounded.",
    "not_divided": "The curves on which stability can change are too many or of too high a degree for a decomposition of the plane: the inequalities are exact, but the shape of the region is not described.",
    "connected_bounded": "The region is connected and bounded.",
    "connected_unbounded": "The region is connected and unbounded.",
    "pieces": "The region has {count} (connected components); {bounded} bounded.",
    "hole": "The isolated point ({first}, {second}) = ({x}, {y}) is excluded, although the region surrounds it.",
    "curve_missing": "The curve {curve} is excluded, although the region lies on both sides of part of it.",
    "number_is_root": "Here {number} is {which} of {equation}.",
    "poles_move": "The root locus for increasing {names}.",
    "parts_are": "Solving for the parameters gives",
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
    "also stability_region margin": "Every root must lie more than {margin} to the left of the imaginary axis.",
    "also stability_region radius": "Every root must have modulus less than {radius}.",
}

ASSERTS: dict[str, tuple[str, ...]] = {
    "case_everywhere": ("stable",),
}

DEMANDS: dict[str, str] = {
    "sought_margin": "sets_margin",
    "sought_radius": "sets_radius",
    "wanted_margin": "sets_margin",
    "wanted_radius": "sets_radius",
    "moved_right": "moves_by_margin",
    "enlarged": "scales_by_radius",
    "mapped": "applies_image",
    "mapped_from_v": "applies_image",
    "crossing": "counts_names",
    "crossing_one": "counts_names",
    "crossing_infinite": "counts_names",
    "crossing_discrete": "counts_names",
    "crossing_one_discrete": "counts_names",
    "region_empty": "finding",
    "region_everywhere": "finding",
    "points_decide": "finding",
    "point_decides": "finding",
    "cells_decide": "finding",
    "point_missing": "finding",
    "box_bounded": "finding",
    "box_unbounded": "finding",
    "connected_bounded": "finding",
    "connected_unbounded": "finding",
    "pieces": "finding",
    "hole": "finding",
    "curve_missing": "finding",
    "number_is_root": "finding",
}

RESTS_ON: dict[str, str] = {
    "mapped": "bilinear",
    "mapped_from_v": "bilinear",
    "cells_decide": "collins",
    "points_decide": "sturm",
    "point_decides": "sturm",
    "crossing": "orlando",
    "crossing_infinite": "orlando",
    "crossing_discrete": "orlando",
    "criterion": "lienard_chipart",
    "criterion_long": "lienard_chipart",
}

THEOREMS: dict[str, str] = {
    "bilinear": "jury1964",
    "sturm": "sturm1829",
    "orlando": "orlando1911",
    "collins": "collins1975",
    "lienard_chipart": "lienard1914",
}

NAMING = (
    "moved_right",
    "enlarged",
    "sought_margin",
    "sought_radius",
    "wanted_margin",
    "wanted_radius",
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

#: Phrases that go on with the sentence before them.
CONTINUES = (
    "left_half_plane",
    "unit_disc",
)
