"""The command line: `symobs solve FILE`, one command a task, and the lists a user looks up."""

from symobs.cli.commands import cli, main

__all__ = ["cli", "main"]
