"""Periodic orbits: how they are found and followed, their multipliers, and the bifurcations at which they change."""
