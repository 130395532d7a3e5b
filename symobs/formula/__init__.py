"""Formulas and words: the tree, reading, letters, conventions, phrases, figures."""
