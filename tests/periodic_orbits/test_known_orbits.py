"""Orbits over a: their continuation where Newton's method needs a nearby orbit as a guess."""

import re

import numpy as np
import pytest

from burridge_knopoff import InitialState, Model, limit_cycle, synchronized_orbit
from burridge_knopoff.periodic_orbits import known_orbits as orbits_over_a
from burridge_knopoff.periodic_orbits.flow import OrbitError
from burridge_knopoff.periodic_orbits.known_orbits import KnownOrbits, nearby_orbit
from tests.normal_forms import CRITICAL, on_line, orbit_at


@pytest.fixture
def branch():
    return KnownOrbits(synchronized_orbit(Model("linearized", a=0.05)))


@pytest.fixture(scope="module")
def asymmetric():
    """An orbit whose end blocks stop six and three times, at a = 0.12."""
    model = Model("linearized", a=0.12)
    start = model.begin(InitialState("one", (-0.989, -0.993, -0.991), (0.099, 0.1012, 0.1023)))
    return limit_cycle(model, start, settling=10_000.0)


def distant(slope, a):
    """Return orbits x = slope·a, at one a; Newton's method corrects x by less than 0.5."""
    form = on_line(lambda x, mu: 0.9 * x + 0.1 * slope * (mu + CRITICAL), lambda x, mu: 0.9)
    return KnownOrbits(orbit_at(form, a - CRITICAL, slope * a))


def test_steps_are_halved_until_the_orbit_is_found():
    """From 0.02 to 0.0025, which is kept."""
    orbits = distant(150.0, 0.05)
    assert orbits.at(0.07).model.parameter("a") == 0.07
    assert sorted(orbits.orbits) == pytest.approx(np.arange(0.05, 0.0701, 0.0025))


def test_a_lost_orbit_is_an_error_after_the_smallest_step(asymmetric):
    """The branch has a turning point at a = 0.13247, before which steps are halved repeatedly."""
    branch = KnownOrbits(asymmetric)
    with pytest.raises(OrbitError, match=r"^a = 0\.1324\d+: .*\ba = 0\.14$") as lost:
        branch.at(0.14)
    values = list(branch.orbits)
    assert values[0] == 0.12
    steps = np.log2(0.02 / np.diff(values))
    assert steps == pytest.approx(np.round(steps), abs=1e-6)
    assert (np.diff(steps) > 0.5).all()
    tried = float(re.search(r"0\.1324\d+", str(lost.value))[0])
    assert 1.0 <= (tried - values[-1]) / orbits_over_a.SMALLEST_STEP < 2.0


def test_steps_become_shorter_near_0():
    """There a stick may vanish with a, and with it the range of convergence of Newton's method."""
    assert distant(1.5e6, 1e-4).at(0.99e-4).model.parameter("a") == 0.99e-4


def test_an_orbit_of_another_period_is_not_on_the_branch(branch):
    """From a guess that traverses the orbit twice, Newton's method converges to the doubled orbit."""
    (orbit,) = branch.orbits.values()
    assert nearby_orbit(orbit, orbit.a + 1e-3).period == pytest.approx(orbit.period, rel=1e-2)
    with pytest.raises(OrbitError, match="near the guess"):
        nearby_orbit(orbit, 0.3)


def test_continued_orbits_are_those_on_which_runs_settle(asymmetric):
    """At both values of a an independent run ends on the orbit."""
    orbit = KnownOrbits(asymmetric).at(0.121)
    again = limit_cycle(orbit.model, asymmetric.reference, settling=10_000.0)
    assert (orbit.stop_counts, orbit.symmetry) == (again.stop_counts, again.symmetry)
    assert orbit.period == pytest.approx(again.period, abs=1e-9)
    assert orbit.residual < 1e-13
