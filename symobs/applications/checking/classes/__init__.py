"""The answers of a class: read from a table or a folder, checked one by one, counted."""
