"""Uses of the tasks: auditing, checking, variants, export, batch runs, the live page."""
