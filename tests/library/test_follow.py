"""A branch of orbits from a model or a law, compared with the branch from the orbit itself."""

import numpy as np
import pytest

from burridge_knopoff import (
    Chain,
    ContinuationSettings,
    Model,
    OrbitError,
    Symmetry,
    follow,
    limit_cycle,
    locate_bifurcations,
    simulate,
)
from tests.refused import refused

MODEL = Model("linearized", a=0.08)
ENDS = (0.0799, 0.0802)


@pytest.fixture(scope="module")
def orbit():
    return limit_cycle(MODEL, simulate(MODEL, initial="plus", transient=1000, window=10).final)


def values(branch):
    return [(point.value, point.orbit.period) for point in branch]


def test_a_model_or_a_law_gives_the_branch_of_the_orbit_on_which_the_motion_settles(orbit):
    """In every form of model, state and interval; the period is that of the orbit to rounding."""
    steps = ContinuationSettings(largest_step=1e-4)
    expected = np.array(values(follow(orbit, ENDS, steps, parameter="a")))
    run = simulate(MODEL, initial="plus", transient=0, window=10)
    for branch in (
        follow(Model("linearized", a=0.08), ENDS, steps, initial="plus", parameter="a"),
        follow(MODEL, ENDS, steps, initial=run, parameter="a"),
        follow(MODEL, interval=ENDS, settings=steps, initial=run.final, settling=2000.0, parameter="a"),
        follow(Model({"formula": "1 - a*u"}, a=0.08, blocks=3, v=0.1), ENDS, steps, initial="plus", parameter="a"),
    ):
        np.testing.assert_allclose(values(branch), expected, atol=1e-9)


def test_each_state_leads_to_the_branch_of_its_attractor():
    """Synchrony, which loses stability at a = 0.0870, and the alternating orbit, which grazes at 0.0813."""
    steps = ContinuationSettings(largest_step=2.5e-3)
    for initial, symmetry, at in (("minus", Symmetry.SYNCHRONIZED, 0.086973), ("plus", Symmetry.SYMMETRIC, 0.081329)):
        branch = follow(Model("linearized", a=0.08), (0.08, 0.088), steps, initial=initial, parameter="a")
        assert branch[0].orbit.symmetry == symmetry
        assert next(iter(locate_bifurcations(branch))).a == pytest.approx(at, abs=1e-6)


def test_the_parameters_of_the_law_are_those_of_the_orbit():
    branch = follow(
        Model("stribeck", a=0.05, sigma=0.2), (0.98, 1.0), initial="minus", parameter="coupling", upward=False
    )
    assert branch[0].orbit.model.law.parameters["sigma"] == 0.2
    assert branch[-1].value <= 0.98


def test_a_motion_without_stops_has_a_branch_as_well():
    law, state = {"formula": "1 - a*u + b*u**3", "b": 0.3}, {"name": "own", "position": -0.6, "velocity": (0.5, 0.9)}
    branch = follow(Model(law, a=0.5, v=0.7, blocks=2), (0.69, 0.71), initial=state, parameter="v")
    assert {point.orbit.stop_counts for point in branch} == {(0, 0)}
    assert branch[-1].value >= 0.71


def test_a_motion_that_has_not_settled_is_on_no_orbit():
    with pytest.raises(OrbitError, match="no periodic orbit"):
        follow(MODEL, ENDS, initial="plus", settling=0.0, parameter="a")


@pytest.mark.parametrize(
    ("call", "place"),
    [
        (lambda orbit: follow(MODEL, ENDS, parameter="a"), "initial"),
        (lambda orbit: follow(Model("linearized", a=0.08), ENDS, parameter="a"), "initial"),
        (lambda orbit: follow(Model("linearized"), initial="plus", parameter="a"), "interval"),
        (lambda orbit: follow(Model("linearized"), ENDS, initial="plus", parameter="v"), "a: missing"),
        (lambda orbit: follow(orbit, ENDS, initial="plus", parameter="a"), "initial"),
        (lambda orbit: follow(orbit, ENDS, ENDS, parameter="a"), "settings"),
        (lambda orbit: follow(MODEL, ENDS, initial="plus", chain=Chain(3), parameter="a"), "chain"),
        (lambda orbit: follow(MODEL, ENDS, initial="plus", parameter="sigma"), "sigma"),
        (lambda orbit: follow(orbit, 0.08, parameter="a"), "interval"),
    ],
)
def test_arguments_that_do_not_go_together_are_refused(orbit, call, place):
    with refused(place):
        call(orbit)


def test_a_closed_branch_ends_where_it_began():
    """The isola of `plus`: two grazings, each found once."""
    branch = follow(Model("linearized", a=0.08), (0.078, 0.084), initial="plus", parameter="a")
    assert len(branch) < 200
    bifurcations = [*locate_bifurcations(branch)]
    assert sorted(round(item.value, 5) for item in bifurcations) == [0.07938, 0.08133]
    again = follow(branch[0].orbit, (0.078, 0.084), upward=False, parameter="a")
    assert sorted(round(item.value, 5) for item in locate_bifurcations(again)) == [0.07938, 0.08133]


def test_lengths_of_steps_by_name():
    assert (
        len(
            follow(
                Model("linearized", a=0.08), (0.078, 0.084), initial="plus", upward=True, max_orbits=4, parameter="a"
            )
        )
        == 4
    )
