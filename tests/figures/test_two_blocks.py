"""The figure of two blocks: what is shaded can be seen."""

import numpy as np
import pytest
import xarray

from burridge_knopoff.figures.two_blocks import draw


@pytest.mark.parametrize("a", [[0.05], [0.05, 0.1, 0.3]])
def test_where_the_laws_disagree_is_shaded_halfway_to_the_neighbours(a):
    agrees = np.ones((1, 1, len(a)), dtype=np.int8)
    agrees[..., -1] = 0
    summary = xarray.Dataset(
        {
            "agrees": (("other_law", "state", "a"), agrees),
            "mean_distance": (("law", "state", "a"), np.full((2, 1, len(a)), 0.1)),
        },
        {"a": a, "law": ["linearized", "nonlinear"]},
    )
    (shaded,) = draw(summary).axes[0].patches
    (left, right) = shaded.get_extents().transformed(shaded.axes.transData.inverted()).intervalx
    if len(a) == 1:
        assert 0.0 < left < a[0] < right
    else:
        assert (left, right) == pytest.approx((0.2, 0.3))
