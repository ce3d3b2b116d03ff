"""Attractors along a: matched into branches, refined, followed to their bifurcations."""
