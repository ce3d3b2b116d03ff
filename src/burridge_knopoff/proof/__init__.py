"""Proofs in ball arithmetic: the synchronized orbit, its multipliers and its loss under the paper's laws."""
