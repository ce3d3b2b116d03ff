"""A Stribeck law: friction weakens with speed as a lubricant film builds up, then strengthens by viscosity.

Reference: B. Armstrong-Hélouvry, P. Dupont and C. Canudas de Wit, "A survey of models, analysis tools and compensation
methods for the control of machines with friction", Automatica 30 (1994) 1083-1138.
"""

from types import MappingProxyType

from burridge_knopoff.laws.law import Law


class Stribeck(Law):
    """Φ = 1 − σ(1 − exp(−aU'/σ)) + ηaU'.

    `sigma` is σ, the largest drop in friction; `eta` is η, the viscosity as a fraction of the initial slope.
    For η < 1 friction is least at U' = (σ/a) ln(1/η).
    """

    formula = "1 - sigma*(1 - exp(-a*u/sigma)) + eta*a*u"
    text = "Φ = 1 − σ(1 − exp(−aU′/σ)) + ηaU′"
    defaults = MappingProxyType({"sigma": 0.05, "eta": 0.2})
