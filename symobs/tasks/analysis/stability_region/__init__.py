"""The stability region of a polynomial or matrix in its parameters."""
