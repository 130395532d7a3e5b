"""Sentences of every page: titles, questions of problem sheets, and captions."""
