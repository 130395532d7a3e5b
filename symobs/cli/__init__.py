"""The command line: `symobs solve FILE`, one command a task, and the lists a user looks up."""

from symobs.cli.command_line import cli, main

__all__ = ["cli", "main"]
