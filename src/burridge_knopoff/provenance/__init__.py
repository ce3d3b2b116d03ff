"""Where a result comes from: sources and their fingerprint, the command of a run, seals, and files written whole."""
