"""Realisations: canonical and modal forms, Kalman decomposition, duality and the transfer function."""
