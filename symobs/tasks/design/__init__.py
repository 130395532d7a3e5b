"""Things built for a plant; each module registers its tasks and methods."""
