"""Counts of section crossings: none is lost."""

import numpy as np
import pytest
import xarray as xr

from burridge_knopoff.report.charts.sections import BINS, section_counts, sections


def crossings(velocity, count):
    coordinates = {
        "law": ("point", np.repeat(["linearized", "nonlinear"], len(count) // 2)),
        "initial": ("point", ["plus"] * len(count)),
    }
    dataset = xr.Dataset({"crossing_count": ("point", np.asarray(count, dtype="i4"))}, coordinates)
    direction = np.where(np.asarray(velocity) >= 0.0, 1, -1).astype("i1")
    return dataset.assign(crossing_velocity=("crossing", velocity), crossing_direction=("crossing", direction))


@pytest.mark.parametrize("lowest", [-0.3, -2e-9, 0.2])
def test_section_counts_lose_no_crossing(lowest):
    rng = np.random.default_rng(1)
    velocity = np.concatenate([rng.uniform(lowest, 0.4, 900), [lowest, 0.4], np.full(600, 0.25)])
    edges, counts = section_counts(crossings(velocity, [502, 0, 400, 600]))
    assert counts.shape == (2, 1, BINS, 2)
    for run, run_velocity in zip(counts[:, 0], (velocity[:502], velocity[502:]), strict=True):
        assert run[run > 0].sum() == (run_velocity >= 0.0).sum()
        assert -run[run < 0].sum() == (run_velocity < 0.0).sum()
    # 600 crossings in one bin: more than the stored type of the direction could count.
    fullest = counts[1, 0, :, 1].argmax()
    assert edges[fullest] <= 0.25 <= edges[fullest + 1]
    assert counts[1, 0, fullest, 1] >= 600


def test_section_counts_without_crossings():
    _, counts = section_counts(crossings([], [0, 0]))
    assert counts.shape == (2, 1, BINS, 1)
    assert not counts.any()


def test_a_bifurcation_diagram_tells_every_count():
    counts = np.zeros((BINS, 2), dtype=int)
    counts[[3, 200, 201], [0, 0, 1]] = -1, 3, 7
    (cells,) = sections(np.array([0.1, 0.2]), np.linspace(-1.0, 1.0, BINS + 1), counts).data
    filled = np.isfinite(cells.z)
    # The strips of two values of a have a gap between them.
    assert (filled[:, ::2] == (counts != 0)).all()
    assert not filled[:, 1].any()
    assert (cells.z[filled] > 0.0).all()
    assert cells.text[filled].tolist() == [
        "a = 0.1<br>1 of 4 crossings, downward",
        "a = 0.1<br>3 of 4 crossings, upward",
        "a = 0.2<br>7 of 7 crossings, upward",
    ]
    assert cells.z[201, 2] == cells.zmax
