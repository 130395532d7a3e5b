"""The matrix exponential, the observability Gramian, and the initial state from measurements."""
