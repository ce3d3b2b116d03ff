"""Exponential weakening: friction falls towards 0 and never changes its sign."""

from burridge_knopoff.laws.law import Law


class Exponential(Law):
    """Φ = exp(−aU'), whose slope at the start is that of the paper's laws."""

    formula = "exp(-a*u)"
    text = "Φ = exp(−aU′)"
