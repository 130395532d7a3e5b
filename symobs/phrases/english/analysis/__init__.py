"""Sentences of the analysis tasks: rank tests, modes, realisations, time response and time-varying plants."""
