"""Proofs: the synchronized orbit, its multipliers and its loss under the paper's laws, enclosed in ball arithmetic."""
