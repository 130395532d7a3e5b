"""Audit of printed equations against the checked answers, with the right value and the reason of an error.

A problem file carries `[[printed]]` entries (`auditor`).  Each is an equation in the letters of the source
(`equations`), evaluated exactly (`evaluation`); where it is false, the simplest slip that reproduces what is printed
is looked for (`slips` in a formula, `differences` between values).
"""

from symobs.applications.audit.auditor import Audited, Finding, audit
from symobs.applications.audit.report import REPORTS, report

__all__ = ["REPORTS", "Audited", "Finding", "audit", "report"]
