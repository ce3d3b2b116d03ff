"""Stick-slip cycles: which blocks are shown, and their ratios."""

import numpy as np
import pytest
import xarray as xr

from burridge_knopoff.figures.stick_slip import draw
from burridge_knopoff.figures.style import write_figure


def cycles(blocks, initial=("minus",)):
    """A summary of stick-slip cycles with other numbers for every block, and a gap for one that never stops."""
    a = np.array([0.0, 0.1, 0.2])
    names = ("law", "initial", "a", "block")
    shape = (2, len(initial), 3, blocks)
    block = np.arange(1.0, blocks + 1)
    values = {
        name: (names, np.broadcast_to(block * (1.0 + a[:, None]), shape).copy())
        for name in ("stop_rate", "cycle_time", "cycle_time_error", "stick_fraction", "velocity_frequency")
    }
    values["velocity_frequency_error"] = (names, np.full(shape, 0.01))
    values["cycle_time"][1][:, :, 0, 0] = np.nan
    values["stop_rate"][1][:, :, 0] = 0.0
    values["velocity_correlation"] = (names[:3], np.full(shape[:3], -0.5))
    labels = {"law": ["linearized", "nonlinear"], "initial": list(initial), "a": a, "block": np.arange(1, blocks + 1)}
    return xr.Dataset(values, labels)


@pytest.mark.parametrize(("blocks", "shown"), [(2, [1, 2]), (3, [1, 2, 3]), (6, [1, 3, 6])])
def test_stick_slip_shows_the_first_the_middle_and_the_last_block(tmp_path, blocks, shown):
    dataset = cycles(blocks)
    figure = draw(dataset, "nonlinear")
    panels = figure.axes
    assert len(panels) == 4
    drawn = [line.get_ydata(orig=False) for line in panels[0].get_lines() if len(line.get_ydata()) == 3]
    expected = dataset["cycle_time"].sel(law="nonlinear", initial="minus")
    for values, block in zip(drawn, shown, strict=True):
        assert np.array_equal(values, expected.sel(block=block), equal_nan=True)
    middle = (blocks + 1) // 2
    ratios = [line.get_ydata() for line in panels[1].get_lines() if len(line.get_ydata()) == 3]
    ends = [block for block in shown if block != middle]
    for number, block in enumerate(ends):
        assert ratios[2 * number] == pytest.approx([block / middle] * 3)
        # Where the middle block never stops there is no ratio of stops.
        assert ratios[2 * number + 1] == pytest.approx([np.nan, block / middle, block / middle], nan_ok=True)
    assert len(ratios) == 2 * len(ends)
    assert panels[1].get_ylabel() == f"ratio to block {middle}"
    write_figure(figure, tmp_path / "figure.png")
