"""A study: its config, and what follows from it."""
