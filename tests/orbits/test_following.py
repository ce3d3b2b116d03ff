"""Where a branch has come to one of simpler orbits and gone past, and where it turns a corner."""

from types import SimpleNamespace

import numpy as np
import pytest

from burridge_knopoff import Chain, Instant, Model, closed_motion, follow, law_of
from burridge_knopoff.orbits import following
from burridge_knopoff.orbits.edge_kind import EdgeKind


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
