"""The commands, one a module, imported when they are called; the table of them is in `symobs.cli.main`."""
