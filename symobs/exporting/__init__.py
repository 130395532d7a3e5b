"""Questions for learning platforms: each with a grader that accepts what `symobs check` accepts, or refused."""
