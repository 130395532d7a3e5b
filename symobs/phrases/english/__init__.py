"""The English sentences of the pages, by key."""
