"""Observability and controllability by rank, and minimal sets of additional measurements."""
