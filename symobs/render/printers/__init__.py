"""TODO symobs/render/printers."""
