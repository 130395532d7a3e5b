"""Linear algebra over Q(parameters): elimination, Krylov rows, Smith–McMillan form and transfer functions."""
