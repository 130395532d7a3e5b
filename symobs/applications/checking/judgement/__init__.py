"""What an answer is held against: the claims of the results, and regions."""
