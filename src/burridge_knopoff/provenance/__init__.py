"""The origin of a result: its sources and their fingerprint, the command of a run, seals, and atomic writing."""
