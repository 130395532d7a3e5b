"""Questions for learning platforms: each with a grader that accepts what `symobs check` accepts, or refused.

A platform that cannot hold what decides about an answer is refused the question; nothing is rounded or compared by a tolerance.
"""

from symobs.applications.export.platforms import FOLDERS, PLATFORMS, export
from symobs.applications.export.questions import Exercise, ExerciseSet, exercises

__all__ = ["FOLDERS", "PLATFORMS", "Exercise", "ExerciseSet", "exercises", "export"]
