"""The paper's linearized law: friction falls linearly with speed, so that the motion has a closed form."""

from burridge_knopoff.laws.law import Law


class Linearized(Law):
    """Φ = 1 − aU' (the paper's Section II)."""

    formula = "1 - a*u"
    text = "Φ = 1 − aU′"
