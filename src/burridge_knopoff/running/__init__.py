"""Runs: settings, the solver that moves a model, and the resulting trajectory."""
