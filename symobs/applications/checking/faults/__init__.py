"""Why an answer is wrong: the slips that reproduce it."""
