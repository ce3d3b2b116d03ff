"""Laws in which friction rises near rest, which does not affect the motion while a block slips fast."""

import pytest

from burridge_knopoff import FormulaLaw, Model
from burridge_knopoff.model.initial import PAPER_STATES
from burridge_knopoff.running.ensemble import new_ensemble
from burridge_knopoff.running.runner import Runner
from tests.kernel.test_ensemble import check_against_scalar

# Speeds of slip are about 0.1.
FORMULAS = {
    "exponential": "0.95 + 0.05*exp(-u/w) - a*u",
    "tanh": "1 - 0.05*tanh(u/w) - a*u",
    "gaussian": "0.95 + 0.05*exp(-(u/w)**2) - a*u",
    "lorentzian": "0.95 + 0.05/(1 + (u/w)**2) - a*u",
    "logarithmic": "1 - 0.01*log(1 + u/w)",
    "power": "0.95 + 0.05*(1 + u/w)**-3.5 - a*u",
}


@pytest.mark.parametrize("w", [1e-2, 1e-3, 1e-4])
@pytest.mark.parametrize("name", FORMULAS)
def test_lanes_against_one_state(name, w):
    """The orders of their series differ, and so do their steps."""
    model = Model(FormulaLaw(FORMULAS[name], w=w, **{"a": 0.1} if "a*u" in FORMULAS[name] else {}))
    assert check_against_scalar(model, new_ensemble(model), 20, 6.0) > 50


def test_a_negligible_exponential_costs_no_steps():
    """Its argument changes by millions while the block slips."""
    model = Model(FormulaLaw(FORMULAS["gaussian"], a=0.1, w=1e-4))
    runner = Runner(model)
    runner.begin(model.begin(PAPER_STATES["minus"]))
    runner.run(20.0)
    assert runner.kernel.steps < 2000
