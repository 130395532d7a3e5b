"""The fixed words of a problem sheet: its head, its table of points, and the titles at its end."""

from __future__ import annotations

PHRASES: dict[str, str] = {
    "sheet_number": "Sheet",
    "sheet_instructor": "Instructor",
    "sheet_due": "Due",
    "sheet_name": "Name",
    "sheet_student_number": "Student number",
    "sheet_point": "point",
    "sheet_points": "points",
    "sheet_points_row": "Points",
    "sheet_score_row": "Score",
    "sheet_total": "Total",
    "sheet_hints": "Hints",
    "sheet_answers": "Final answers",
    "sheet_one_solution": "Solution",
    "sheet_version": "Version",
    "sheet_step": "Step",
    "sheet_verdict": "yes or no",
}

#: They claim nothing.
NAMING = (
    "sheet_number",
    "sheet_instructor",
    "sheet_due",
    "sheet_name",
    "sheet_student_number",
    "sheet_point",
    "sheet_points",
    "sheet_points_row",
    "sheet_score_row",
    "sheet_total",
    "sheet_hints",
    "sheet_answers",
    "sheet_one_solution",
    "sheet_version",
    "sheet_step",
    "sheet_verdict",
)

#: They go on with a sentence, or stand within one.
CONTINUES = ("sheet_point", "sheet_points", "sheet_verdict")
