"""The gain of a pole placement, L or K: its result type, its cases, and its pages."""
