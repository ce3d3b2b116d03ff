"""The figure of end blocks of unequal mass, from hand-made data."""

import numpy as np
import xarray

from burridge_knopoff.figures.detuning import draw


def rotation(parted):
    """Return two branches at three values of a and two detunings; those where `parted` have two frequencies."""
    axes = ("law", "value", "branch", "detuning")
    shape = (1, 3, 2, 2)
    frequency = np.tile([0.22, 0.34, 0.22], (*shape, 1))
    frequency[..., 2] = np.where(parted, 0.15, frequency[..., 2])
    data = {
        "a": (axes[:2], [[0.02, 0.04, 0.06]]),
        "in_grid": (axes[:2], [[1, 1, 1]]),
        "detuned_frequency": ((*axes, "block"), frequency),
        "detuned_end_ratio": (axes, np.tile([0.83, 0.58], (*shape[:3], 1))),
        "detuned_mode_share": ((*axes, "mode"), np.tile([0.01, 0.99, 0.0], (*shape, 1))),
        "mode_end_ratio": (("detuning", "mode"), [[1.2, -0.82, 0.7], [1.6, -0.57, 0.3]]),
    }
    return xarray.Dataset(data, {"law": ["linearized"], "branch": [1, 2], "detuning": [0.1, 0.3]})


def test_ratios_are_drawn_where_there_is_one_frequency_with_the_mode_of_most_energy():
    parted = np.zeros((1, 3, 2, 2), dtype=bool)
    parted[:, :, 1, 1] = parted[:, 0, 0, 0] = True
    (panel,) = draw(rotation(parted)).axes
    points = [line for line in panel.lines if line.get_linestyle() == "None"]
    assert [(line.get_label(), list(line.get_xdata()), set(line.get_ydata())) for line in points] == [
        ("branch 1", [0.04, 0.06], {0.83}),
        ("branch 2", [0.02, 0.04, 0.06], {0.83}),
        ("branch 1", [0.02, 0.04, 0.06], {0.58}),
    ]
    modes = [line for line in panel.lines if line not in points]
    assert {(line.get_label(), line.get_ydata()[0]) for line in modes} == {("normal mode", 0.82), ("normal mode", 0.57)}


def test_without_a_common_frequency_the_panel_says_so():
    (panel,) = draw(rotation(np.ones((1, 3, 2, 2), dtype=bool))).axes
    assert not panel.lines
    assert "branch" in panel.texts[0].get_text()
