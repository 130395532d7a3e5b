"""What stands below a picture."""

from __future__ import annotations

PHRASES: dict[str, str] = {
    "picture_region": "Shaded: stable values of ({first}, {second}), boundary excluded.",
    "picture_region_everywhere": "Shaded: stable values of ({first}, {second}).",
    "picture_region_nowhere": "No value of ({first}, {second}) in the range shown is stable.",
    "picture_line_one": "Thick interval: stable values of {parameter}, endpoints excluded.",
    "picture_line": "Thick intervals: stable values of {parameter}, endpoints excluded.",
    "picture_line_everywhere": "All values of {parameter} shown are stable.",
    "picture_line_nowhere": "No value of {parameter} shown is stable.",
    "picture_poles": "The roots move from the crosses, where {parameter} is {begin}, the lower end of what is drawn, to the circles, where it is {end}, the upper end.",
    "picture_half_plane": "Shaded half-plane: {where}.",
    "picture_disc": "The shaded disc has radius {radius}.",
    "picture_samples": "Dots: stable test points; crosses: unstable ones.",
    "picture_stable": "Dots: stable test points.",
    "picture_unstable": "Crosses: unstable test points.",
    "picture_excluded": "Open circles: excluded points.",
    "picture_dashed": "Dashed: curves that are not part of the boundary.",
    "picture_curve": "Curve (1) is {curve}.",
    "picture_curves": "The curves are",
    "picture_response": "Response to the initial condition {start}.",
    "picture_samples_only": "The signals are defined at the sampling instants 0, 1, 2, … only.",
    "picture_sweep": "Checked values at {count} points, joined by straight lines.",
    "picture_map": "Lines of equal {column}, between checked values at {count} points.",
    "picture_infinite": "Infinite at all points: {column}.",
    "picture_gaps": "Shaded: no finite value, or a case of its own.",
    "picture_drawn_for": "Plotted for {values}.",
}
