"""Periodic orbits with dashpots, compared with an equivalent chain without them, with SciPy and with differences.

Dashpots γ m_i to the driver turn the linearized law 1 − aU' into one with a − γ in place of a (masses and thresholds of
1): positions relative to uniform sliding move as without them.
"""

import numpy as np
import pytest

from burridge_knopoff import (
    BifurcationKind,
    Chain,
    ChainState,
    Model,
    find_periodic_orbit,
    follow,
    limit_cycle,
    locate_bifurcations,
    multipliers,
    synchronized_orbit,
)
from burridge_knopoff.model.initial import PAPER_STATES
from burridge_knopoff.periodic_orbits.flow import rate
from burridge_knopoff.periodic_orbits.grazing_distances import _derivatives
from tests.flows import differences
from tests.scipy_flow import model_events

GAMMA = 0.05
#: a_c of the paper's chain, from interval arithmetic.
CRITICAL = 0.0869729046660773


def test_dashpots_to_the_driver_shift_the_loss_of_synchrony():
    damped = Model("linearized", a=0.08 + GAMMA, pulling_damping=GAMMA)
    orbit, other = (synchronized_orbit(model) for model in (damped, Model("linearized", a=0.08)))
    assert orbit.period == pytest.approx(other.period, rel=1e-13)
    assert np.allclose(multipliers(orbit).whole[:2], multipliers(other).whole[:2], rtol=1e-12)
    (bifurcation,) = locate_bifurcations(follow(orbit, (0.07 + GAMMA, 0.1 + GAMMA), parameter="a"))
    assert bifurcation.kind == BifurcationKind.PITCHFORK
    assert bifurcation.a == pytest.approx(CRITICAL + GAMMA, abs=1e-11)


@pytest.fixture(scope="module")
def orbit():
    """Return an asymmetric orbit of a chain with unequal dashpots."""
    model = Model("nonlinear", a=0.12, damping=(0.05, 0.02), pulling_damping=(0.0, 0.01, 0.02))
    return limit_cycle(model, model.begin(PAPER_STATES["plus"]), settling=3000.0)


def test_an_orbit_returns_by_scipy(orbit):
    events, end = model_events(orbit.model, orbit.reference, orbit.period)
    assert sum(kind == 0 for _, _, kind in events) == sum(orbit.stop_counts)
    assert np.abs(end - orbit.reference.vector()).max() < 1e-8


def test_multipliers_are_those_of_differences(orbit):
    quotients = differences(orbit.model, orbit.reference, orbit.period, 1e-5)
    assert quotients is not None
    expected = np.linalg.eigvals(quotients[0])
    order = np.argsort(-np.abs(expected))[:4]
    whole = np.abs(multipliers(orbit).whole)
    # The flow has the multiplier 1, which is excluded.
    assert np.sort(np.append(whole, 1.0))[-4:] == pytest.approx(np.sort(np.abs(expected[order])), abs=1e-5)


def test_an_orbit_is_followed_to_other_dashpots():
    model = Model("nonlinear", a=0.08, damping=0.03)
    start = synchronized_orbit(model)
    branch = follow(start, (0.01, 0.03), parameter="damping", upward=False)
    reached = branch[-1].orbit
    assert reached.model.chain.damping == pytest.approx(0.01, abs=1e-3)
    again = find_periodic_orbit(reached.model, reached.reference, reached.period, reached.symmetry)
    assert again.period == pytest.approx(reached.period, rel=1e-11)


@pytest.mark.parametrize("start", [0.0, 1e-9, 1e-4, 2e-3])
def test_dashpots_grow_from_0_as_a_falls(start):
    """The orbit at γ is that at a − γ without dashpots: loss of synchrony, and a branch that turns at a grazing."""
    synchronized = synchronized_orbit(Model("linearized", a=CRITICAL + 0.0075, pulling_damping=start))
    branch = follow(synchronized, (0.0, 0.02), parameter="pulling_damping")
    assert 0.0 <= branch[0].value <= min(start, 1e-9)
    assert branch[-1].value > 0.02
    assert len(branch) < 250
    (bifurcation,) = locate_bifurcations(branch)
    assert (bifurcation.kind, bifurcation.at.value) == (BifurcationKind.PITCHFORK, pytest.approx(0.0075, abs=2e-11))
    for point in branch[::10]:
        plain = synchronized_orbit(Model("linearized", a=CRITICAL + 0.0075 - point.value))
        assert point.orbit.period == pytest.approx(plain.period, rel=1e-11)


@pytest.fixture(scope="module")
def plain():
    """Return the orbit of (20, 54, 20) stops that the paper's second state reaches at a = 0.08."""
    model = Model("linearized", a=0.08)
    return limit_cycle(model, model.begin(PAPER_STATES["plus"]), settling=1000.0)


def test_a_branch_that_turns_back_to_0_is_that_along_a(plain):
    """Without dashpots it begins and ends, on either side of the grazing at which it turns."""
    branch = follow(plain, (0.0, 0.2), parameter="pulling_damping")
    along_a = follow(plain, (0.07, 0.08), upward=False, parameter="a")
    turns = [next(point.value for point in points if point.is_grazing) for points in (branch, along_a)]
    assert turns[0] == pytest.approx(0.08 - turns[1], abs=1e-9)
    assert branch[-1].value < 1e-9
    back = next(point for point in along_a[::-1] if point.orbit.stop_counts == branch[-1].orbit.stop_counts)
    again = find_periodic_orbit(plain.model, back.orbit.reference, back.orbit.return_time, back.orbit.symmetry)
    assert branch[-1].orbit.period == pytest.approx(again.period, rel=1e-9)


@pytest.mark.slow
@pytest.mark.parametrize("parameter", ["damping", "damping[1]", "pulling_damping[2]", "pulling[2]"])
def test_a_parameter_grows_from_0(parameter):
    """Motion settles on the orbits of the branch. Steps were once a share of the parameter, or failed at 0."""
    start = synchronized_orbit(Model("linearized", a=0.05).at(**{parameter: 0.0}))
    branch = follow(start, (0.0, 0.02), parameter=parameter)
    assert branch[0].value == 0.0
    assert branch[-1].value > 0.02
    for point in branch[1::20]:
        orbit = point.orbit
        assert orbit.period == pytest.approx(limit_cycle(orbit.model, orbit.reference, 3000.0).period, rel=1e-9)


def test_derivatives_along_the_motion():
    """Force, acceleration and their rates, with a stuck block among slipping ones."""
    chain = Chain(4, damping=0.3, pulling_damping=0.1, mass=(1.0, 2.0, 1.0, 1.0), weakening=(1.0, 1.0, -0.2, 0.5))
    model = Model("nonlinear", a=0.3, chain=chain, v=0.2)
    stuck = np.array([False, True, False, False])
    position, velocity = np.array([0.1, -0.2, 0.05, 0.2]), np.array([0.3, 0.0, 0.2, 0.1])
    force, force_rate, acceleration, jerk = (
        values[0] for values in _derivatives(model, position[None], velocity[None], stuck[None])
    )
    slips = ~stuck
    derivative = rate(model, ChainState(position, velocity, stuck))
    assert np.allclose(derivative[4:][slips], acceleration[slips], rtol=1e-13)
    step = 1e-6
    ahead = (position + step * (velocity - 0.2))[None], (velocity + step * np.where(stuck, 0.0, acceleration))[None]
    later = _derivatives(model, *ahead, stuck[None])
    assert np.allclose((later[0][0] - force) / step, force_rate, atol=1e-5)
    assert np.allclose(((later[2][0] - acceleration) / step)[slips], jerk[slips], atol=1e-5)
