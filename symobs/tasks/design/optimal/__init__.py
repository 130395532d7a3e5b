"""Optimal gains: the linear-quadratic regulator, and the steady-state Kalman filter."""
