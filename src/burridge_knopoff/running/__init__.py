"""Runs: settings, the solver that integrates a model, and the resulting trajectory."""
