"""Steps along a branch lead forward to orbits on it, whichever reference state they start from."""

import numpy as np
import pytest

from burridge_knopoff.periodic_orbits.flow import flow
from burridge_knopoff.periodic_orbits.parameter_line import line_along_a
from burridge_knopoff.periodic_orbits.periodic import orbit_of, refine_orbit, safe_offset
from burridge_knopoff.periodic_orbits.pseudo_arclength import begin_branch, step_along, tangent_of, weights

LENGTH = 1e-3


@pytest.mark.parametrize("upward", [True, False])
@pytest.mark.parametrize("share", [0.0, 0.05, 0.35, 0.6, 0.95])
def test_a_step_ends_at_an_orbit_far_from_events_whatever_its_reference(families, upward, share):
    usual = families["nonlinear"].at(0.05)
    state = flow(usual.model, usual.reference, share * usual.period).state()
    orbit = refine_orbit(orbit_of(usual.model, state, usual.period, usual.symmetry))
    line = line_along_a(orbit.model.chain)
    point = step_along(begin_branch(orbit, upward, line), LENGTH)
    assert (point.orbit.a > orbit.a) == upward
    # Forward, and of length 1.
    assert (point.tangent[-1] > 0.0) == upward
    assert weights(orbit.model, line) @ point.tangent**2 == pytest.approx(1.0)
    assert np.abs(point.tangent) == pytest.approx(np.abs(tangent_of(point.orbit, line)))
    assert point.orbit.period == pytest.approx(families["nonlinear"].at(point.orbit.a).period, abs=1e-12)
    assert safe_offset(point.orbit) == 0.0
