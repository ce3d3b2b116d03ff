"""Steps along a branch lead forward to orbits on it, whichever reference state the tangent belongs to."""

import numpy as np
import pytest

from burridge_knopoff import Symmetry, find_periodic_orbit
from burridge_knopoff.periodic_orbits import pseudo_arclength
from burridge_knopoff.periodic_orbits.flow import flow
from burridge_knopoff.periodic_orbits.parameter_line import line_along_a
from burridge_knopoff.periodic_orbits.pseudo_arclength import begin_branch, step_along, tangent_of, weights

LENGTH = 1e-3


@pytest.mark.parametrize("upward", [True, False])
@pytest.mark.parametrize("share", [0.1, 0.35, 0.6, 0.85])
def test_a_step_ends_at_an_orbit_whatever_its_reference(families, monkeypatch, upward, share):
    synchronized = families["nonlinear"].at(0.05)
    orbit = find_periodic_orbit(synchronized.model, synchronized.reference, synchronized.period, Symmetry.SYNCHRONIZED)
    point = begin_branch(orbit, upward, line_along_a(orbit.model.chain))
    usual = step_along(point, LENGTH)
    monkeypatch.setattr(pseudo_arclength, "safe_offset", lambda solution: share * solution.period)
    moved = step_along(point, LENGTH)
    for following in (usual, moved):
        assert (following.orbit.a > orbit.a) == upward
        # Forward, and of length 1.
        assert (following.tangent[-1] > 0.0) == upward
        assert weights(orbit.model, line_along_a(orbit.model.chain)) @ following.tangent**2 == pytest.approx(1.0)
    assert moved.orbit.a == usual.orbit.a == pytest.approx(families["nonlinear"].at(usual.orbit.a).model.a)
    assert moved.orbit.period == pytest.approx(families["nonlinear"].at(usual.orbit.a).period, abs=1e-12)
    there = flow(usual.orbit.model, usual.orbit.reference, share * usual.orbit.period)[0].state()
    np.testing.assert_allclose(moved.orbit.reference.vector(), there.vector(), atol=1e-12)
    assert np.abs(moved.tangent) == pytest.approx(np.abs(tangent_of(moved.orbit, line_along_a(orbit.model.chain))))
