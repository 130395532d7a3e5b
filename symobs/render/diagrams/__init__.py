"""Block diagrams: their layout, and a writer for each format."""
