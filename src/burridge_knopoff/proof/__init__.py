"""Proofs in ball arithmetic: the synchronized orbit, its multipliers and where it loses stability."""
