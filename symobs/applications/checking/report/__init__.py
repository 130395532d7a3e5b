"""The report on an answer, and how it is written."""
