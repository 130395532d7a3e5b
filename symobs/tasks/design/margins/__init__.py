"""Margins of loops."""
