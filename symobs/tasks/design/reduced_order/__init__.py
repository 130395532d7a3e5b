"""Reduced-order observers, and their pages."""
