"""For which parameters are all roots of a polynomial stable: conditions, exact regions, and their proofs."""
