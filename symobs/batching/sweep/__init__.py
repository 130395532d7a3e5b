"""Sweeps: one problem at many points, every one of them exact and checked."""

from symobs.batching.sweep.plan import SweepTable, sweep

__all__ = ["SweepTable", "sweep"]
