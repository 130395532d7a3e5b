"""Claims of results, their certificates, and the error bounds of randomised checks (trusted)."""
