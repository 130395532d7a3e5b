"""Block diagrams and plots as data, before any format draws them."""
