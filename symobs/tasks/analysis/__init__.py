"""Facts about a plant; each module registers its tasks and methods."""
