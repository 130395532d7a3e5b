"""Pole placement algorithms: from an observable pair and a desired polynomial to the gain."""
