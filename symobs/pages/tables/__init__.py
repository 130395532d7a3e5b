"""The Routh array as a table, fitted to the line, in every format."""
