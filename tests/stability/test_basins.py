"""Basins: the same labels with any threads and tiles, and those of whole runs."""

from contextlib import nullcontext
from dataclasses import replace
from itertools import product

import numpy as np
import pytest

from burridge_knopoff import Chain, InitialState, Model, MotionKind, Symmetry, law_of, simulate
from burridge_knopoff.model.initial import PAPER_STATES
from burridge_knopoff.model.model import CONTACTS, STARTS
from burridge_knopoff.stability import basins as stability_basins
from burridge_knopoff.stability import settling
from burridge_knopoff.stability.basins import known_attractors, pixel_centres, plane
from burridge_knopoff.stability.continuation import continue_attractors
from burridge_knopoff.stability.settings import MOTION, BasinSettings, Refine
from burridge_knopoff.summaries import all_laws, attractors, basins
from tests.stability.stand_in import shown
from tests.stability.test_attractors import SETTINGS

SEARCH = replace(SETTINGS, samples=25, fraction_width=0.18)
PLANE = BasinSettings(pixels=16, pairs=300, tiles=1)
MODEL = Model(Chain(3), law_of("linearized", 0.08))
FOUND = (SEARCH, MOTION, "moving")


@pytest.fixture(scope="module")
def known():
    states = list(PAPER_STATES.values())
    found = continue_attractors([MODEL, MODEL.at(0.1)], SEARCH, MOTION, Refine(1.0), starts=states)
    parts = [attractors.one_law(found, states, *FOUND)]
    return all_laws.merge(parts, all_laws.branch_numbers(parts, [MODEL], SEARCH))


def whole(known, tiles, threads, model=MODEL):
    basin_settings = replace(PLANE, tiles=tiles, threads=threads)
    parts = [basins.tile(known, model, number, basin_settings, *FOUND) for number in range(tiles)]
    near = basins.pairs(known, model, basin_settings, *FOUND)
    return basins.merge(
        [(model, parts, near)], known, ["linearized", "other"], basin_settings, SEARCH.label_limit, "moving"
    )


@pytest.fixture(scope="module")
def found(known):
    return whole(known, 1, 1)


def test_any_number_of_threads_and_tiles_gives_the_same_labels(known, found):
    for tiles, threads in ((3, 1), (1, 3), (5, 2)):
        assert found.identical(whole(known, tiles, threads)), (tiles, threads)
    assert found["undetermined_count"].item() == 0
    assert len(np.unique(found["branch"])) >= 2


def check_run(known, state, branch, **conventions):
    """Hold the branch that a state is said to reach against the mean distance of a whole run."""
    options = {"transient": 6000.0, "window": 1000.0, "events": "none", "lyapunov_exponents": 0}
    run = simulate("linearized", 0.08, state, **options, **conventions)
    there = known.sel(law="linearized", a=0.08)
    mean = there["mean_distance"].values[there["branch"].values == branch.item()][0]
    assert run.mean_distance == pytest.approx(mean, abs=2e-4), (state, conventions)


def test_pixels_are_what_whole_runs_end_in(known, found):
    """Every pixel of the diagonal, and the plane's axes: the first index is U_N(0)."""
    for k in range(0, 16, 3):
        for m in (k, (5 * k + 2) % 16):
            one = found.isel(map=0, first_position=m, last_position=k)
            position = (one["first_position"].item(), -0.993, one["last_position"].item())
            check_run(known, InitialState("pixel", position, (0.099, 0.1012, 0.1023)), one["branch"])


def test_runs_of_the_paper_end_on_the_branch_that_is_told(known):
    for contact, start, initial in product(CONTACTS, STARTS, PAPER_STATES):
        branch = known["initial_branch"].sel(law="linearized", a=0.08, contact=contact, start=start, initial=initial)
        check_run(known, initial, branch, contact=contact, start=start)


@pytest.mark.parametrize(
    ("v", "share", "lasts"),
    [(0.1, 0.99, True), (0.1, -0.99, True), (0.1, 2.0, False), (0.2, 1.98, True), (0.2, 4.0, False)],
)
def test_an_attractor_that_does_not_last_is_told(known, v, share, lasts):
    """Its state is followed once more: what it shows now has to be what the summary says, to 0.001 and five errors.

    Twice that at twice the speed, at which under the linearized law all positions and velocities are twice as large.
    """
    altered, model = known.copy(deep=True), Model(Chain(3), MODEL.law, v)
    altered["position"][...] = model.sliding_offset + v / 0.1 * (known["position"].values - MODEL.sliding_offset)
    for name in ("velocity", "mean_distance"):
        altered[name][...] = v / 0.1 * known[name].values
    here = {"law": 0, "a": 0, "attractor": 1}
    altered["mean_distance_error"][here] = 0.0
    altered["mean_distance"][here] += share * 1e-3
    words = r"branch \d+ of the linearized law at a = 0.08 has <J> 0\.\d{5} now and 0\.\d{5} in the file: motion that"
    with nullcontext() if lasts else pytest.raises(ValueError, match=words):
        known_attractors(altered, model, SEARCH, MOTION)


def test_a_plane_of_states():
    first = pixel_centres((-1.0, 1.0), 4)
    assert first.tolist() == [-0.75, -0.25, 0.25, 0.75]
    position, velocity = plane((5.0, 6.0, 7.0), first, np.array([8.0, 9.0]), (0.1, 0.2, 0.3))
    assert position.tolist() == [[one, 6.0, last] for last in (8.0, 9.0) for one in first]
    assert velocity.tolist() == [[0.1, 0.2, 0.3]] * 8


@pytest.mark.parametrize(("a", "pairs"), [(0.08, 0), (0.1, 1)])
def test_known_attractors_are_those_of_the_summary(known, a, pairs):
    found = known_attractors(known, MODEL.at(a), SEARCH, MOTION)
    one = known.sel(law="linearized", a=a)
    there = one["branch"].values >= 0
    assert found.branch.tolist() == one["branch"].values[there].tolist()
    assert found.side.tolist() == one["side"].values[there].tolist()
    for name in ("symmetry", "radius", "slow", "close_returns", "patience"):
        assert [getattr(item, name) for item in found.attractors] == one[name].values[there].tolist()
    for index, item in enumerate(found.attractors):
        image = found.attractors[item.partner]
        assert found.branch[item.partner] == found.branch[index]
        assert found.side[item.partner] == -found.side[index]
        assert (item.partner == index) == (found.side[index] == 0)
        assert found.attractors[image.partner] is item
    assert np.count_nonzero(found.side) == 2 * pairs
    for item, mean, state in zip(found.attractors, one["mean_distance"].values, one["position"].values, strict=False):
        assert item.motion.mean_distance == pytest.approx(mean, abs=1e-4)
        # What is no closed orbit is seen for four times as long, and a set that is its own mirror image holds both.
        closed = item.motion.kind in (MotionKind.SYNCHRONIZED, MotionKind.PERIODIC)
        time = SEARCH.window * (1 if closed else 4) * (2 if item.symmetry == Symmetry.SYMMETRIC else 1)
        assert len(item.motion.returns) == pytest.approx(time * item.motion.stop_rate[item.motion.block - 1], rel=0.02)
        assert (item.motion.returns is item.motion.mirror_returns) == (item.symmetry == Symmetry.SYMMETRIC)
        assert np.abs(item.motion.returns[:, :3] - (state - MODEL.at(a).sliding_offset)).max(axis=1).min() < 2e-2


def test_a_long_orbit_is_seen_for_as_long_as_it_takes_to_close(known, tell):
    """As in the search: in a shorter window its returns would not repeat."""
    rows = np.ones((20, 6))
    tell(settling, "visit", [shown(rows, rows, 0.1, 0.0), shown(rows, rows, 0.0, 0.0, window=12_000.0)])
    asked = tell(stability_basins, "measure_once", [None])
    with pytest.raises(ValueError, match="is not an attractor"):
        known_attractors(known, MODEL, SEARCH, MOTION)
    assert asked[0][3] == 12_000.0


def test_a_slow_set_is_shown_by_pushed_states_once_more(known):
    altered = known.copy(deep=True)
    altered["slow"][{"law": 0, "a": 0, "attractor": 1}] = True
    plain, slow = (known_attractors(summary, MODEL, SEARCH, MOTION).attractors for summary in (known, altered))
    assert [len(slow[k].motion.returns) > 5 * len(plain[k].motion.returns) for k in (0, 1)] == [False, True]


def test_without_attractors_nothing_is_determined(known):
    none = known.sel(a=[0.08]).assign_coords(a=[0.0])
    none["branch"].values[...] = -1
    merged = whole(none, 1, 1, MODEL.at(0.0))
    assert (merged["branch"] == -1).all()
    assert merged["undetermined_count"].item() == 16 * 16
    assert (merged["pair_count"] == 0).all()
    assert np.isnan(merged["decision_time"]).all()
    assert np.isnan(merged["uncertainty_exponent"].item())
