"""TODO symobs/exact/linear_algebra."""
