"""Where a branch has come to one of simpler orbits and gone past, and where it turns a corner."""

from types import SimpleNamespace

import numpy as np
import pytest

from burridge_knopoff import Chain, Instant, Model, closed_motion, follow, law_of
from burridge_knopoff.orbits import corner as corner_module
from burridge_knopoff.orbits import following
from burridge_knopoff.orbits.edge_kind import EdgeKind
from burridge_knopoff.orbits.edges import locate_edges
from burridge_knopoff.orbits.pseudo_arclength import BranchOrbit


@pytest.mark.parametrize(
    ("slopes", "values", "simpler", "expected"),
    [
        ((1.0, -1.0), (0.5, 0.5), "simpler", "simpler"),
        ((-0.1, 0.1), (-0.5, -0.5), "simpler", "simpler"),
        # It goes on; it turns at a fold; there is no simpler orbit.
        ((1.0, 1.0), (0.5, 0.5), "simpler", None),
        ((1.0, -1.0), (0.5, -0.5), "simpler", None),
        ((1.0, -1.0), (0.5, 0.5), "own", None),
    ],
)
def test_a_branch_turns_without_a_fold_where_it_touches_a_simpler_one(monkeypatch, slopes, values, simpler, expected):
    key = EdgeKind.FOLD, "keeping"
    monkeypatch.setattr(following, "critical_values", lambda orbit, value: {key: value})
    monkeypatch.setattr(following, "simplest", lambda orbit, _: orbit if simpler == "own" else simpler)
    points = (
        SimpleNamespace(orbit="own", tangent=[slope], multipliers=v) for slope, v in zip(slopes, values, strict=True)
    )
    assert following._passed(*points) == expected


def test_several_turns_of_another_orbit_are_no_way_around_a_corner():
    """At a = 0.11226 an orbit of 29 stops grazes; 3e-5 below it one of a single stop ends, which it does not become."""
    model = Model(Chain(3), law_of("linearized", 0.112265625))
    position = np.array([0.10663254, 0.07868783, 0.06869955])
    start = Instant(position, np.array([0.0, 0.06015978, 0.02200926]), np.array([True, False, False]))
    branch = follow(closed_motion(model, start), (0.1122, 0.1123), upward=False, enough=lambda points: len(points) > 12)
    corner = next(number for number, point in enumerate(branch) if point.corner)
    assert {point.orbit.signature for point in branch[: corner + 1]} == {(29, 29, 10)}
    assert {point.orbit.signature for point in branch[corner + 1 :]} == {(29, 29, 9)}
    # Both kinds of orbit lie on one side: the branch turns back, and beyond the corner it is unstable.
    assert all(point.orbit.a > branch[corner].orbit.a for point in branch[corner + 1 :])
    assert [point.multipliers.unstable for point in branch] == [0] * (corner + 1) + [1] * (len(branch) - corner - 1)


def doubled(a):
    """Return the orbit of (12, 26, 26) stops, which has begun as twice (6, 13, 13) at a = 0.136416."""
    model = Model(Chain(3), law_of("linearized", a))
    position = np.array([-0.01583146, -0.00898694, -0.04390718])
    start = Instant(position, np.array([0.21336224, 0.16773024, 0.2330488]), np.zeros(3, dtype=bool))
    return closed_motion(model, closed_motion(model.at(0.135), start, settling=3000.0).reference, settling=6000.0)


@pytest.mark.parametrize("a", [0.135, 0.1355, 0.136])
def test_no_step_leaps_to_a_simpler_orbit(a):
    """From two of them the long step past the grazing used to end on the simple orbit, which is not near there."""
    orbit = doubled(a)
    assert orbit.signature == (12, 26, 26)
    branch = follow(orbit, (0.1345, 0.137), upward=False)
    corner = next(point for point in branch if point.corner)
    assert corner.orbit.a == pytest.approx(0.1348243355, abs=1e-10)
    assert all(point.joined is None for point in branch)
    # The other way it does join it.
    branch = follow(orbit, (0.1345, 0.137))
    assert branch[-1].joined.signature == (6, 13, 13)
    (edge,) = locate_edges(branch)
    assert edge.kind == EdgeKind.FLIP
    assert edge.a == pytest.approx(0.136416049, abs=1e-9)
    assert edge.at.multipliers.keeping == pytest.approx(edge.at.multipliers.keeping.real)
    assert np.abs(edge.at.multipliers.keeping + 1.0).min() < 1e-8


@pytest.mark.parametrize(
    ("values", "length", "expected"),
    [
        ((0.5, 0.25), 0.1, 0.1),
        ((-0.3, -0.2), 0.1, 0.2),
        ((0.2, 0.3), 0.1, np.inf),
        ((0.2, 0.2), 0.1, np.inf),
        ((0.2,), 0.1, np.inf),
    ],
)
def test_a_joint_lies_ahead_where_a_multiplier_comes_to_1(monkeypatch, values, length, expected):
    key = EdgeKind.FOLD, "keeping"
    monkeypatch.setattr(corner_module, "critical_values", lambda orbit, value: {key: value})
    way = [SimpleNamespace(orbit=None, multipliers=value, length=length) for value in values]
    assert corner_module._joint_ahead(way) == pytest.approx(expected)
    # A longer way has the same end.
    ahead = corner_module._joint_ahead([SimpleNamespace(orbit=None, multipliers=9.0, length=9.0), *way])
    assert ahead == pytest.approx(expected) or len(way) == 1


@pytest.mark.parametrize(("ahead", "joins"), [(0.19, True), (0.21, False), (np.inf, False)])
def test_a_simpler_orbit_ends_a_branch_only_where_it_joins_it(monkeypatch, ahead, joins):
    signature = SimpleNamespace(signature=(2, 2))
    found = BranchOrbit(signature, np.zeros(4))
    monkeypatch.setattr(corner_module, "step_along", lambda point, length: found)
    monkeypatch.setattr(corner_module, "simpler_orbit", lambda orbit: "simpler")
    monkeypatch.setattr(corner_module, "_joint_ahead", lambda way: ahead)
    step = corner_module.smooth_step([SimpleNamespace(orbit=signature)], 0.1)
    assert (step is not None) == joins
    if joins:
        assert step.joined == "simpler"
