"""Printers of formulas: LaTeX, Unicode text and MathML, with line breaking."""
