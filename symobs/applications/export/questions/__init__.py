"""Problems as questions: what is asked, what decides about each part, and what a page says."""
