"""A block on a belt whose friction falls with speed, a law without a: y'' + 0.1 y' + y = -0.5 - 0.5 exp(-U'/0.5).

Published: M. Stender and N. Hoffmann, "bSTAB: an open-source software for computing the basin stability of multi-stable
dynamical systems", Nonlinear Dyn. 107 (2022) 1451-1468.
"""

from burridge_knopoff import Chain, FormulaLaw, Model

FORMULA = "mud + (mus - mud)*exp(-u/v0)"
NUMBERS = {"mus": 1.0, "mud": 0.5, "v0": 0.5}
CHAIN = Chain(1, pulling=1.0, pulling_damping=0.1)

#: Fraction of the states in BOX that end in uniform sliding, by v.
SLIDING = {1.4: 0.213, 1.5: 0.304, 1.7: 0.498, 1.775: 0.568}
BOX = {"position": (-2.0, 2.0), "velocity": ("v - 2", "v")}
#: A search that is long enough for it.
QUICK = {"samples": 12, "transient": 300.0, "window": 300.0, "perturbations": 8, "time_limit": 1000.0}


def oscillator(v):
    return Model(FormulaLaw(FORMULA, **NUMBERS), chain=CHAIN, v=v, contact="symmetric")
