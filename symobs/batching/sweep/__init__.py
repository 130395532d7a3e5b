"""Sweeps: one problem at many points, every one of them exact and checked."""

from symobs.batching.sweep.sweep import SweepTable, sweep

__all__ = ["SweepTable", "sweep"]
