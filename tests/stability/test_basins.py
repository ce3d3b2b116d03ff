"""Basins: the same labels with any threads and tiles; uncertainty exponents of known boundaries."""

import numpy as np
import pytest

from burridge_knopoff.initial import InitialState
from burridge_knopoff.simulation import simulate
from burridge_knopoff.stability.uncertainty import uncertain_fraction, uncertainty_exponent
from burridge_knopoff.summaries import attractors, basins
from tests.sections import MOTION
from tests.stability.test_attractors import SETTINGS

CONFIG = {
    "v": 0.1,
    "contact": "one_sided",
    "start": "moving",
    "synchronization_threshold": 1e-6,
    "motion": MOTION,
    "attractors": {**SETTINGS, "samples": 25, "position": [-1.5, 1.5], "velocity": [0.0, 0.2]},
    "initial": {
        "minus": {"position": [-0.989, -0.993, -0.991], "velocity": [0.099, 0.1012, 0.1023]},
        "plus": {"position": [0.989, -0.993, -0.991], "velocity": [0.099, 0.1012, 0.1023]},
    },
    "basins": {
        "linearized": [0.08],
        "nonlinear": [],
        "pixels": 16,
        "initial": "minus",
        "first_position": [-1.5, 1.5],
        "last_position": [-1.5, 1.5],
        "tiles": 1,
        "threads": 1,
    },
}


@pytest.fixture(scope="module")
def known():
    return attractors.merge([attractors.one_law("linearized", [0.08, 0.1], CONFIG["initial"], CONFIG)])


def whole(known, tiles, threads):
    config = {**CONFIG, "basins": {**CONFIG["basins"], "tiles": tiles, "threads": threads}}
    parts = [basins.tile(known, "linearized", 0.08, number, config, threads) for number in range(tiles)]
    return basins.merge([("linearized", 0.08, parts)], config)


def test_any_number_of_threads_and_tiles_gives_the_same_labels(known):
    first = whole(known, 1, 1)
    for tiles, threads in ((3, 1), (1, 3), (5, 2)):
        assert first.identical(whole(known, tiles, threads)), (tiles, threads)
    assert first["undetermined_count"].item() == 0
    assert len(np.unique(first["branch"])) >= 2


def test_pixels_are_what_whole_runs_end_in(known):
    """Every pixel of the diagonal, and the plane's axes: the first index is U_N(0)."""
    found = whole(known, 1, 1)
    for k in range(0, 16, 3):
        for m in (k, (5 * k + 2) % 16):
            one = found.isel(map=0, first_position=m, last_position=k)
            position = (one["first_position"].item(), -0.993, one["last_position"].item())
            state = InitialState("pixel", position, (0.099, 0.1012, 0.1023))
            run = simulate(
                "linearized", 0.08, state, transient=6000.0, window=1000.0, events="none", lyapunov_exponents=0
            )
            there = known.sel(law="linearized", a=0.08)
            mean = there["mean_distance"].values[there["branch"].values == one["branch"].item()][0]
            assert run.mean_distance == pytest.approx(mean, abs=2e-4), position


def test_runs_of_the_paper_end_on_the_branch_that_is_told(known):
    """`initial_branch` under every convention against the mean distance of the run itself."""
    for contact in ("one_sided", "symmetric"):
        for start in ("moving", "tested"):
            for initial in ("minus", "plus"):
                run = simulate(
                    "linearized",
                    0.08,
                    initial,
                    contact=contact,
                    start=start,
                    transient=6000.0,
                    window=1000.0,
                    events="none",
                    lyapunov_exponents=0,
                )
                there = known.sel(law="linearized", a=0.08)
                branch = there["initial_branch"].sel(contact=contact, start=start, initial=initial).item()
                mean = there["mean_distance"].values[there["branch"].values == branch][0]
                assert run.mean_distance == pytest.approx(mean, abs=2e-4), (contact, start, initial)


def test_exponent_of_a_straight_boundary():
    """A smooth curve has α = 1."""
    x, y = np.meshgrid(np.arange(256), np.arange(256))
    alpha, error = uncertainty_exponent((x > 0.4 * y + 60.3).astype(int))
    assert alpha == pytest.approx(1.0, abs=0.03)
    assert error < 0.03


def test_exponent_of_a_cantor_boundary():
    """Strips between the gaps of the middle-third Cantor set: D = 1 + log 2/log 3, α = 1 − log 2/log 3 = 0.369."""
    x = (np.arange(729) + 0.5) / 729
    level = np.zeros(729, dtype=int)
    for k in range(1, 6):
        digit = np.floor(x * 3**k).astype(int) % 3
        level[(level == 0) & (digit == 1)] = k
    # Each gap has the parity of its level, and what no gap has taken a label of its own.
    labels = np.tile(np.where(level > 0, level % 2, 2), (729, 1))
    alpha, _ = uncertainty_exponent(labels)
    # Columns alone carry the boundary; pairs along them never differ and halve f at every separation alike.
    assert alpha == pytest.approx(1.0 - np.log(2) / np.log(3), abs=0.1)


def test_undetermined_pixels_and_single_basins_are_left_out():
    labels = np.zeros((128, 128), dtype=int)
    assert np.isnan(uncertainty_exponent(labels)[0])
    assert (uncertain_fraction(labels) == 0.0).all()
    labels[:, 64:] = -1
    assert (uncertain_fraction(labels) == 0.0).all()
    labels[:] = -1
    assert np.isnan(uncertain_fraction(labels)).all()
    assert np.isnan(uncertainty_exponent(np.eye(8, dtype=int))).all()


def test_digests_say_what_the_data_say(known):
    lines = attractors.digest(known).splitlines()
    assert lines[0].startswith("linearized, synchronized: at 1 of 2 values of a, 0.08 to 0.08; <J> 0.0000 to 0.0000")
    assert lines[-1].startswith("linearized: 0 of 50 sampled states are undetermined")
    assert len(lines) == 1 + len({int(n) for n in np.unique(known["branch"]) if n >= 0})
    line = basins.digest(whole(known, 1, 1)).strip()
    assert line.startswith("linearized, a = 0.08: ")
    shares = [float(part.split()[-2]) for part in line.split(": ")[1].split(";")[0].split(", ")]
    assert sum(shares) == pytest.approx(100.0, abs=0.05)
