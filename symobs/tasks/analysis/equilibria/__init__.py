"""The equilibria of a nonlinear plant."""
