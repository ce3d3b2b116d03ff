"""The equation of motion with masses, m U'' = s − θ Φ(U'), in the computation of orbits."""

import numpy as np

from burridge_knopoff import Chain, ChainState, Model
from burridge_knopoff.periodic_orbits.flow import rate
from burridge_knopoff.periodic_orbits.grazing_distances import _derivatives

LIGHT = Model("nonlinear", a=0.3, coupling=2.0, threshold=(1.0, 1.5, 0.7), v=0.2)
HEAVY = Model(LIGHT.law, coupling=2.0, threshold=(1.0, 1.5, 0.7), mass=(1.0, 4.0, 0.5), v=0.2)
SLIPPING = np.zeros((1, 3), dtype=bool)
POSITION, VELOCITY = np.array([0.1, -0.2, 0.05]), np.array([0.3, 0.1, 0.2])


def test_forces_are_divided_by_masses():
    state = ChainState(POSITION, VELOCITY, np.zeros(3, dtype=bool))
    light, heavy = rate(LIGHT, state), rate(HEAVY, state)
    assert (heavy[:3] == light[:3]).all()
    assert np.allclose(heavy[3:], light[3:] / HEAVY.chain.masses, rtol=1e-14)
    force, force_rate, acceleration, jerk = (
        values[0] for values in _derivatives(HEAVY, POSITION[None], VELOCITY[None], SLIPPING)
    )
    assert np.allclose(acceleration, heavy[3:], rtol=1e-13)
    # The jerk is the rate of the acceleration along the motion.
    step = 1e-6
    ahead = _derivatives(
        HEAVY, (POSITION + step * (VELOCITY - 0.2))[None], (VELOCITY + step * acceleration)[None], SLIPPING
    )
    assert np.allclose((ahead[0][0] - force) / step, force_rate, atol=1e-5)
    assert np.allclose((ahead[2][0] - acceleration) / step, jerk, atol=1e-5)


def test_the_scale_of_a_is_that_of_damping():
    """In suitable units of time and a, a block of mass m moves as one of mass 1."""
    assert Chain(3, mass=4.0).a_unit == 2.0 * Chain(3).a_unit
