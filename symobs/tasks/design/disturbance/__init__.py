"""Observers of plants with disturbances: decoupled from an unknown input, or with a model of the disturbance."""
