"""Lyapunov's equation."""
