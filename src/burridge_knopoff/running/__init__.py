"""Runs: a solver of a model, its settings, and the trajectory that it leaves."""
