"""Rendering of checked derivations: narrator, printers of formulas, and one file per format."""
