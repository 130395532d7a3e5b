"""The narrator: from the steps of a checked derivation to blocks of text and formulas."""
