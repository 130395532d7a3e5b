"""The grader that goes with an exported question: the standard library alone, one module for every question."""
