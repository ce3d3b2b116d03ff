"""The law of Carlson, Langer and Shaw: friction drops by σ when a slip starts, then weakens with speed.

Reference: J. M. Carlson, J. S. Langer and B. E. Shaw, "Dynamics of earthquake faults", Rev. Mod. Phys. 66 (1994) 657,
where 2α is our a.
"""

from types import MappingProxyType

from burridge_knopoff.laws.law import Law


class CarlsonLanger(Law):
    """Φ = (1 − σ)/(1 + aU'/(1 − σ)); `sigma` is σ, in [0, 1)."""

    formula = "(1 - sigma)/(1 + a*u/(1 - sigma))"
    text = "Φ = (1 − σ)/(1 + aU′/(1 − σ))"
    defaults = MappingProxyType({"sigma": 0.01})
