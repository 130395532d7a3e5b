"""Time-varying plants: the transition matrix and observability on an interval."""
