"""The commands that list what there is, one module each."""
