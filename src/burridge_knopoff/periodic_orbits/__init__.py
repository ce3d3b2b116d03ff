"""Closed orbits: how they are found and followed, their multipliers, and the edges at which they change."""
