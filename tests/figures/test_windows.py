"""Windows of a: how wide the bars are."""

import numpy as np
import pytest
import xarray as xr

from burridge_knopoff.figures.windows import draw


def test_a_bar_ends_halfway_to_the_next_value_and_goes_on_where_only_others_were_looked_for():
    # Branch 0 ends between 0.15 and 0.16; branch 1 was not looked for there, but goes on; the last value is padding.
    a = [0.0, 0.1, 0.15, 0.16, 0.2, 0.3, np.nan]
    branch = [[0, 1], [0, 1], [0, -1], [-1, -1], [1, -1], [1, -1], [-1, -1]]
    names = ("law", "value", "attractor")
    refined = xr.Dataset(
        {
            "a": (names[:2], [a]),
            "in_grid": (names[:2], [[1, 1, 0, 0, 1, 1, 0]]),
            "branch": (names, [branch]),
            "kind": (names, np.ones((1, 7, 2), dtype=int)),
            "mean_distance": (names, np.full((1, 7, 2), 0.1)),
            "branch_number": ("number", [0, 1]),
            "branch_name": ("number", ["synchronized", "alternating (1)"]),
        },
        {"law": ["linearized"]},
    )
    bars = draw(refined).axes[1].patches
    first, second = ([bar for bar in bars if round(bar.get_y() + 0.4) == row] for row in (0, 1))
    assert [bar.get_x() for bar in first] == pytest.approx([0.0, 0.05, 0.125])
    assert first[-1].get_x() + first[-1].get_width() == pytest.approx(0.155)
    assert [bar.get_x() for bar in second] == pytest.approx([0.0, 0.05, 0.15, 0.25])
    assert second[1].get_x() + second[1].get_width() == pytest.approx(0.15)
    assert second[-1].get_x() + second[-1].get_width() == pytest.approx(0.3)
