"""Where a branch has come to one of simpler orbits and gone past, told of made-up orbits."""

from types import SimpleNamespace

import pytest

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
