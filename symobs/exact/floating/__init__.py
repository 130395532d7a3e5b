"""Exact values in floating point: arrays of points, nearest doubles, and proofs about what rounding does."""
