"""Unobservable and uncontrollable modes: the PBH test, detectability and stabilizability."""
