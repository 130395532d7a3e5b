"""Check of an answer against a problem: any valid one is right, and what is wrong is explained only if that reproduces it.

The claims of the results decide (`judgement`), never a comparison with the one answer that symobs gives where there are
many.  Slips are looked for in `faults`, lines of a derivation are judged in `derivations`, `answers` reads what students hand
in, and `report` holds and writes what is said of it.
"""

from symobs.applications.checking.checker import Checked, check
from symobs.applications.checking.report import SHOW, CheckReport, Line, Part

__all__ = ["SHOW", "CheckReport", "Checked", "Line", "Part", "check"]
