"""Attractors along a parameter: matched into branches, refined; followed along a to their bifurcations."""
