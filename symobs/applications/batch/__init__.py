"""Many problems at once: jobs, their store, and the processes that work on them, on one machine or a cluster."""

from symobs.applications.batch.run import Batch, batch

__all__ = ["Batch", "batch"]
