"""Observers and compensators as programs, and the numbers of an answer alone."""
