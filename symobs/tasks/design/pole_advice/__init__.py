"""Advice on observer poles: candidates and warnings from the zeros and poles of the plant."""
