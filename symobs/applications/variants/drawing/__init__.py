"""What variants are drawn from: a stream of numbers that is the same for ever, parameters, and constructions."""
