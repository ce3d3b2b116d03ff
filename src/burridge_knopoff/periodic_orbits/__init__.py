"""Periodic orbits: their computation and continuation, their multipliers and their bifurcations."""
