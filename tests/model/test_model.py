"""Models that are refused."""

from burridge_knopoff import Chain, FormulaLaw, Model, law_of
from tests.refused import refused


def test_a_law_must_be_analytic_up_to_the_driver_velocity():
    law = FormulaLaw(0.1, "1/(1 + a*u) + 0.0001*log(1 - u/16)")
    assert Model(Chain(3), law, 1.5).v == 1.5
    with refused("v: 2.0", "analytic"):
        Model(Chain(3), law, 2.0)


def test_a_model_requires_a_chain_and_a_law():
    for arguments, key in (((3, law_of("linearized", 0.1)), "chain"), ((Chain(3), "linearized"), "law")):
        with refused(key, key.capitalize()):
            Model(*arguments)
