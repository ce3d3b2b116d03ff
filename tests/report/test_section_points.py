"""Counts of section crossings: none is lost."""

import numpy as np
import pytest
import xarray as xr

from burridge_knopoff.report.section_points import BINS, section_counts


def sections(velocity, count):
    laws = {"flag_values": [0, 1], "flag_meanings": "linearized nonlinear"}
    states = {"flag_values": [0], "flag_meanings": "plus"}
    coordinates = {
        "law": ("point", np.repeat([0, 1], len(count) // 2), laws),
        "initial": ("point", np.zeros(len(count), dtype="i2"), states),
    }
    found = xr.Dataset({"crossing_count": ("point", np.asarray(count, dtype="i4"))}, coordinates)
    direction = np.where(np.asarray(velocity) >= 0.0, 1, -1).astype("i1")
    return found.assign(crossing_velocity=("crossing", velocity), crossing_direction=("crossing", direction))


@pytest.mark.parametrize("lowest", [-0.3, -2e-9, 0.2])
def test_section_counts_lose_no_crossing(lowest):
    rng = np.random.default_rng(1)
    velocity = np.concatenate([rng.uniform(lowest, 0.4, 900), [lowest, 0.4], np.full(600, 0.25)])
    counts = section_counts(sections(velocity, [502, 0, 400, 600]))
    low, high = counts["bifurcations"]
    runs = [counts["runs"][law][0] for law in (0, 1)]
    for run, own in zip(runs, (velocity[:502], velocity[502:]), strict=True):
        assert sum(count for count in run["count"] if count > 0) == (own >= 0.0).sum()
        assert -sum(count for count in run["count"] if count < 0) == (own < 0.0).sum()
    # 600 crossings in one bin: more than the stored type of the direction could count.
    a, bin_number = divmod(np.cumsum(runs[1]["index"]), BINS)
    fullest = int(np.argmax(runs[1]["count"]))
    assert low + (high - low) * (bin_number[fullest] + np.array([0, 1])) / BINS == pytest.approx(0.25, abs=0.01)
    assert set(a.tolist()) == {0, 1}
    assert runs[1]["count"][fullest] >= 600


def test_section_counts_without_crossings():
    assert section_counts(sections([], [0, 0]))["runs"] == [[{"index": [], "count": []}]] * 2
