"""`python -m symobs`."""

from symobs.cli import main

main()
