"""Which candidates become variants: the cheap tests, the constraints, the profile and the keys of what is distinct."""
