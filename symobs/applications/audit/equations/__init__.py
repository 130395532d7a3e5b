"""Printed equations: their grammar, the values of letters and signals, and their evaluation."""
