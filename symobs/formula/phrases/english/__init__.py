"""The tables of phrases that no single task owns, and numbers in words."""
