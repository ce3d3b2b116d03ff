"""Studies: a config, and everything derived from it."""
