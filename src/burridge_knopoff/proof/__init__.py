"""Proofs: orbits, multipliers and transitions of the linearized law enclosed in ball arithmetic."""
