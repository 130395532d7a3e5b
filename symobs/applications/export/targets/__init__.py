"""One module a learning platform: each says what it cannot hold, and writes its files."""
