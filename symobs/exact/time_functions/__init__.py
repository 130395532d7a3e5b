"""Exponentials, sines and cosines of time: quasipolynomials, their integrals, and e^{At}."""
