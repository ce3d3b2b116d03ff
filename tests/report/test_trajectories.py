"""The trajectories in a report: the positions of the point files, and no chain where the blocks form none."""

import base64
import zlib
from pathlib import Path

import numpy as np
import pytest

from burridge_knopoff.report import trajectories
from burridge_knopoff.report.trajectories import EVERY, embedded_trajectories
from burridge_knopoff.study.load import load_study
from burridge_knopoff.study.study import all_points
from burridge_knopoff.summaries.points import read_point
from tests.small_study import SMALL, STUDIES


def test_the_blocks_move_as_in_the_point_files(poor):
    embedded = embedded_trajectories(poor.study, poor.folder)
    steps = np.frombuffer(zlib.decompress(base64.b64decode(embedded["packed"])), "i1")
    start, moved = 0, 0
    for number, point in enumerate(all_points(poor.study)):
        run = read_point(poor.study, poor.folder, point, ("position", "velocity"))
        position, velocity = (run[name][::-EVERY][: embedded["frames"][number] + 1][::-1] for name in run)
        count, unit = embedded["frames"][number], embedded["units"][number]
        increments = steps[start : start + 2 * count].reshape(2, count).T.astype(int)
        start += increments.size
        ground = np.array(embedded["first"][number]) + unit * np.vstack([np.zeros(2), increments.cumsum(axis=0)])
        relative = ground - embedded["v"] * embedded["interval"] * np.arange(count + 1)[:, None]
        assert relative == pytest.approx(position, rel=0.0, abs=0.6 * unit + 1e-5)
        sticks = (velocity[1:] == 0.0) & (velocity[:-1] == 0.0)
        moved += np.count_nonzero(increments)
        # Between two instants of rest a block may slip, but it hardly ever does.
        assert np.mean(increments[sticks] == 0) > 0.9
    assert start == steps.size
    assert moved > 0


def test_a_large_study_has_the_runs_at_some_values_of_a(poor, monkeypatch):
    monkeypatch.setattr(trajectories, "LARGEST", 1)
    embedded = embedded_trajectories(poor.study, poor.folder)
    assert embedded["every"] >= len(poor.study.grid)
    assert len(embedded["units"]) == len(poor.study.laws) * len(poor.study.initial)


def test_a_ring_is_not_drawn_as_a_chain():
    study = load_study({**SMALL, **STUDIES["ring"]}, "ring.yaml")
    assert embedded_trajectories(study, Path("results")) is None
