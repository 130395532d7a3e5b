"""From a checked derivation to a page: narrator, printers of formulas, one file per format."""
