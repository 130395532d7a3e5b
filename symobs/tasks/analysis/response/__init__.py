"""The response of a plant to its initial state and its input."""
