"""What a model refuses."""

import pytest

from burridge_knopoff import Chain, FormulaLaw, Model


def test_a_law_has_to_be_analytic_up_to_the_velocity_of_the_driver():
    law = FormulaLaw(0.1, "1/(1 + a*u) + 0.0001*log(1 - u/16)")
    assert Model(Chain(3), law, 12.0).v == 12.0
    with pytest.raises(ValueError, match="^v: 20.0 is not allowed: the law formula is not analytic up to that speed$"):
        Model(Chain(3), law, 20.0)
