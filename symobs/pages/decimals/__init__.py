"""Pages in decimals: exact lines, written with the decimals of their numbers."""
