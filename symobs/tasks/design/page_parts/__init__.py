"""Parts shared by the pages of designs: block diagrams, component equations, time responses and remarks on poles."""
