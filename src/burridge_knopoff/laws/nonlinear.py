"""The paper's nonlinear law, that of J. M. Carlson and J. S. Langer without the drop at the start of a slip."""

from burridge_knopoff.laws.law import Law


class Nonlinear(Law):
    """Φ = 1/(1 + aU') (the paper's Eq. 2)."""

    formula = "1/(1 + a*u)"
    text = "Φ = 1/(1 + aU′)"
