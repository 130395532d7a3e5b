"""Sentences of the design tasks: gains, compensators, reduced-order observers, tracking and feedforward."""
