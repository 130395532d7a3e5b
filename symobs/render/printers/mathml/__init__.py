"""TODO symobs/render/printers/mathml."""
