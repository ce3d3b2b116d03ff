"""Exponential weakening: friction decays to 0 and stays positive."""

from burridge_knopoff.laws.law import Law


class Exponential(Law):
    """Φ = exp(−aU'), with the same slope at U' = 0 as the paper's laws."""

    formula = "exp(-a*u)"
    text = "Φ = exp(−aU′)"
