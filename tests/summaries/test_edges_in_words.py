"""Edge states in words: whether a boundary is fractal, with the depth of the search."""

import numpy as np
import xarray as xr

from burridge_knopoff.motion.kind import MotionKind
from burridge_knopoff.summaries.edges_in_words import edges_in_words


def edges_of(reached, crossing, has_crossing, high):
    """Return edge states at several a with so many displaced states; two attractors are reached from each side."""
    count = len(crossing)
    reached_count = np.full((count, 2, 3), -1)
    reached_count[:, :, :2] = np.array(reached)[:, None, None] * np.eye(2, dtype=int)
    columns = {
        "law": np.full(count, "linearized"),
        "a": 0.05 + 0.01 * np.arange(count),
        "kind": np.full(count, int(MotionKind.QUASIPERIODIC)),
        "symmetry": np.full(count, 1),
        "has_crossing": np.array(has_crossing),
        "crossing_low": np.zeros(count),
        "crossing_high": np.array(high),
        "period": np.full(count, np.nan),
        "multiplier": np.full(count, np.nan),
        "lifetime": np.full(count, 20.0),
    }
    data = {name: ("edge", values) for name, values in columns.items()}
    data["stops"] = (("edge", "block"), np.zeros((count, 3), int))
    for name in ("branch", "side"):
        data[name] = (("edge", "bank"), np.tile([1, 2], (count, 1)))
    data["crossing_count"] = (("edge", "bank"), np.array(crossing))
    data["reached_count"] = (("edge", "bank", "attractor"), reached_count)
    return xr.Dataset(data, attrs={"laws": "linearized"})


def test_where_no_state_crosses_it_is_undecided_at_a_depth():
    """Nothing is settled by 400 states: a study that looks deeper may see a crossing."""
    law, *lines = edges_in_words(edges_of([500, 200], [[0, 0], [0, 0]], [0, 0], [0.0038, 0.0095])).splitlines()
    assert law.endswith(
        "; undecided at this depth: no crossing that leads back is seen with at least 400 displaced states, of which "
        "up to 0.95 % may cross."
    )
    assert lines[1].endswith("; undecided whether fractal: crossed by 0 of 400 displaced states (95 %: 0 to 0.95 %).")
    assert "none fractal" not in law


def test_a_crossing_is_told_with_its_depth():
    law, *lines = edges_in_words(edges_of([5000, 500], [[3, 0], [0, 0]], [1, 0], [0.00088, 0.0038])).splitlines()
    assert "; fractal boundary at a = 0.05; otherwise undecided at this depth: " in law
    assert lines[0].endswith(
        "; fractal boundary, crossed by 3 of 10000 displaced states (95 %: 0 to 0.088 %): of far fewer than 3333 none "
        "may cross."
    )


def test_a_crossing_of_another_part_of_the_boundary_does_not_decide():
    _, line = edges_in_words(edges_of([500], [[7, 0]], [0], [0.0144])).splitlines()
    assert line.endswith("; another part of the boundary is crossed by 7 of 1000 displaced states (95 %: 0 to 1.4 %).")


def test_if_every_boundary_is_fractal_nothing_is_left_undecided():
    law, *_ = edges_in_words(edges_of([500], [[7, 0]], [1], [0.0144])).splitlines()
    assert law.endswith("; fractal boundary at a = 0.05.")
