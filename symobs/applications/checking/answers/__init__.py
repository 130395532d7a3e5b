"""What a student hands in: the answer file, and its values."""
