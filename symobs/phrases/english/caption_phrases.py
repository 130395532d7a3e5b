"""What stands below a picture."""

from __future__ import annotations

PHRASES: dict[str, str] = {
    "picture_region": "Stable for ({first}, {second}) in the shaded region; its boundary does not belong to it.",
    "picture_region_everywhere": "Stable for ({first}, {second}) in the shaded region.",
    "picture_region_nowhere": "Nothing is shaded: for no ({first}, {second}) shown here is it stable.",
    "picture_line_one": "Stable for {parameter} on the thick interval; its ends do not belong to it.",
    "picture_line": "Stable for {parameter} on the thick intervals; their ends do not belong to them.",
    "picture_line_everywhere": "Stable for every {parameter} shown here.",
    "picture_line_nowhere": "Stable for no {parameter} shown here.",
    "picture_poles": "The poles move from the crosses to the circles as {parameter} goes from {begin} to {end}.",
    "picture_half_plane": "The shaded half-plane is {where}.",
    "picture_disc": "The shaded disc has the radius {radius}.",
    "picture_samples": "Dots are stable points, crosses unstable ones.",
    "picture_stable": "Dots are stable points.",
    "picture_unstable": "Crosses are unstable points.",
    "picture_excluded": "Open circles do not belong to it.",
    "picture_dashed": "Dashed curves divide the plane and are no boundary.",
    "picture_curve": "Curve (1) is {curve}.",
    "picture_curves": "The curves are",
    "picture_response": "The course from {start}.",
    "picture_estimates": "A hat tells the estimates.",
    "picture_samples_only": "There are values at the instants 0, 1, 2 and so on alone.",
    "picture_drawn_for": "Drawn for {values}.",
}
