"""Stick-slip cycles: which blocks are shown, and their ratios."""

import numpy as np
import pytest
import xarray as xr

from burridge_knopoff.figures.stick_slip import draw
from burridge_knopoff.figures.style import write_figure


def cycles(blocks):
    """A summary of stick-slip cycles with other numbers for every block, and a gap for one that never stops."""
    a = np.array([0.0, 0.1, 0.2])
    labels = {"law": ["linearized", "nonlinear"], "initial": ["minus"], "a": a, "block": np.arange(1, blocks + 1)}
    block = np.tile(np.arange(1.0, blocks + 1) * (1.0 + a[:, None]), (2, 1, 1, 1))
    names = ("stop_rate", "cycle_time", "cycle_time_error", "stick_fraction", "velocity_frequency")
    dataset = xr.Dataset({name: (tuple(labels), block.copy()) for name in names}, labels)
    dataset["cycle_time"][:, :, 0, 0] = np.nan
    dataset["stop_rate"][:, :, 0] = 0.0
    correlation = xr.full_like(dataset["stop_rate"].isel(block=0, drop=True), -0.5)
    error = xr.full_like(dataset["stop_rate"], 0.01)
    return dataset.assign(velocity_frequency_error=error, velocity_correlation=correlation)


@pytest.mark.parametrize(("blocks", "shown"), [(3, [1, 2, 3]), (6, [1, 3, 6])])
def test_stick_slip_shows_the_first_the_middle_and_the_last_block(tmp_path, blocks, shown):
    dataset = cycles(blocks)
    figure = draw(dataset, "nonlinear", has_paper_chain=False)
    panels = figure.axes
    assert len(panels) == 2
    drawn = [line.get_ydata(orig=False) for line in panels[0].get_lines() if len(line.get_ydata()) == 3]
    expected = dataset["cycle_time"].sel(law="nonlinear", initial="minus")
    for values, block in zip(drawn, shown, strict=True):
        assert np.array_equal(values, expected.sel(block=block), equal_nan=True)
    middle = (blocks + 1) // 2
    ends = [block / middle for block in shown if block != middle]
    *ratios, correlation = [line.get_ydata() for line in panels[1].get_lines() if len(line.get_ydata()) == 3]
    assert np.array(ratios) == pytest.approx(np.outer(ends, [1.0, 1.0, 1.0]))
    assert correlation.tolist() == [-0.5] * 3
    write_figure(figure, tmp_path / "figure.png")


def test_the_statements_of_the_paper_stand_at_its_chain_only():
    for has_paper_chain in (True, False):
        figure = draw(cycles(3), "nonlinear", has_paper_chain)
        bands = [len(panel.patches) for panel in figure.axes]
        words = [text.get_text() for text in figure.legends[0].get_texts() if "paper" in text.get_text()]
        assert bands == [int(has_paper_chain), 0]
        assert words == ["stated in the paper: 2 to 3", "stated in the paper: 1/2"] * has_paper_chain


def test_two_blocks_have_no_ratio_to_a_middle_one():
    figure = draw(cycles(2), "nonlinear", has_paper_chain=False)
    assert [panel.get_ylabel() for panel in figure.axes] == ["time between stops", "correlation"]
    assert {text.get_text() for text in figure.legends[0].get_texts()} == {
        "block 1",
        "block 2",
        "correlation of $U_1$′ with $U_{2}$′",
    }
