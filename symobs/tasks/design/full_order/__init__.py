"""Full-order observers and state feedback, and the existence of an asymptotic observer."""
