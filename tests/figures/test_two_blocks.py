"""The figure of two blocks: states for which the laws disagree can be seen where symbols coincide as well."""

import numpy as np
import pytest
import xarray
from matplotlib.colors import to_rgb

from burridge_knopoff.figures.two_blocks import ANSWERS, draw
from burridge_knopoff.summaries.two_blocks import CHAINS


@pytest.mark.parametrize("a", [[0.05], [0.05, 0.1, 0.3]])
def test_each_state_for_which_the_laws_disagree_is_marked(a):
    agrees = np.ones((2, 1, 2, len(a)), dtype=np.int8)
    agrees[1, 0, 1, -1] = 0
    agrees[1, 0, 0, -1] = -1
    summary = xarray.Dataset(
        {
            "agrees": (("chain", "other_law", "state", "a"), agrees),
            "mean_distance": (("chain", "law", "state", "a"), np.full((2, 2, 2, len(a)), 0.1)),
        },
        {"a": a, "chain": list(CHAINS), "law": ["linearized", "nonlinear"]},
    )
    figure = draw(summary)
    # The strips of several values have gaps between them.
    train, both_pulled = (figure.axes[k].collections[0].get_array()[:, ::2] for k in (1, 3))
    assert (train == 1.0).all()
    assert both_pulled.shape == (2, len(a), 3)
    assert [tuple(row[-1]) for row in both_pulled] == [to_rgb(ANSWERS[answer][0]) for answer in (-1, 0)]
    assert (both_pulled[:, :-1] == 1.0).all()
    (legend,) = figure.legends
    words = [text.get_text() for text in legend.get_texts()]
    assert words == ["linearized law", "nonlinear law", "undecided", "the laws disagree"]
