"""The discrete-time plant of a plant behind a zero-order hold."""
