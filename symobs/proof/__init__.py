"""Claims and derivations: what is trusted."""
