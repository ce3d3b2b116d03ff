"""Models that are refused."""

from burridge_knopoff import Chain, FormulaLaw, Model
from tests.refused import refused


def test_a_law_must_be_analytic_up_to_the_driver_velocity():
    law = FormulaLaw("1/(1 + a*u) + 0.0001*log(1 - u/16)", a=0.1)
    assert Model(law, v=1.5).v == 1.5
    with refused("v: 2.0", "analytic"):
        Model(law, v=2.0)


def test_a_model_requires_a_chain_and_a_law():
    for arguments, key in (({"law": "linearized", "chain": 3}, "chain"), ({"law": 3, "chain": Chain(3)}, "law")):
        with refused(f"{key}: 3"):
            Model(**arguments)
