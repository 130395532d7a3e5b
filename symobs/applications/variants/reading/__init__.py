"""The table `[variants]` of a problem file, and a problem with values in place of its letters."""
