"""TODO symobs/design/page_parts."""
