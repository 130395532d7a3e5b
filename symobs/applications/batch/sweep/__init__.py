"""Sweeps: one problem at many points, every one of them exact and checked."""

from symobs.applications.batch.sweep.plan import SweepTable, sweep

__all__ = ["SweepTable", "sweep"]
