"""The paper's nonlinear law, that of J. M. Carlson and J. S. Langer without a drop at the start."""

from burridge_knopoff.laws.law import Law


class Nonlinear(Law):
    """Φ = 1/(1 + aU'), the paper's Eq. 2."""

    formula = "1/(1 + a*u)"
    text = "Φ = 1/(1 + aU′)"
