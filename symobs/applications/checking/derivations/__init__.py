"""The lines of a derivation: the first false one, and what follows from it."""
