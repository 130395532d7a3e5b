"""Sentences on stability regions and the Routh array."""
