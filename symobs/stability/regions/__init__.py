"""Exact stability regions in one and two parameters, and their descriptions by inequalities."""
