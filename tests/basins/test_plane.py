"""Basins: labels do not depend on cores and tiles, and agree with full runs."""

from dataclasses import replace
from itertools import product

import numpy as np
import pytest

from burridge_knopoff import Chain, InitialState, Model, law_of, simulate
from burridge_knopoff.attractors.stored_returns import known_attractors, returns_of_law
from burridge_knopoff.basins.plane import pixel_centres, plane
from burridge_knopoff.basins.settings import BasinSettings
from burridge_knopoff.continuation.attractor_continuation import continue_attractors
from burridge_knopoff.continuation.settings import RefinementSettings
from burridge_knopoff.model.initial import PAPER_STATES
from burridge_knopoff.model.model import CONTACTS, STARTS
from burridge_knopoff.motion.settings import MOTION
from burridge_knopoff.summaries import attractors, basins, branch_numbering
from tests.attractors.test_attractors import SETTINGS
from tests.refused import refused

SEARCH = replace(SETTINGS, samples=25, fraction_width=0.18)
PLANE = BasinSettings(pixels=16, pairs=300, tiles=1)
MODEL = Model("linearized", a=0.08)


@pytest.fixture(scope="module")
def searched():
    states = list(PAPER_STATES.values())
    continuation = continue_attractors([MODEL, MODEL.at(a=0.1)], SEARCH, MOTION, RefinementSettings(1.0), starts=states)
    parts = [attractors.one_law(continuation, states, SEARCH, MOTION, "moving")]
    rows = [continuation.rows(place) for place in continuation.grid]
    whole = branch_numbering.merge(parts, branch_numbering.branch_numbers(parts, [MODEL], SEARCH))
    return whole, returns_of_law([continuation.models[k] for k in continuation.grid], rows, parts[0].attrs), rows


@pytest.fixture(scope="module")
def table(searched):
    return searched[0]


def whole(table, attractors_at_a, tiles, cores):
    basin_settings = replace(PLANE, tiles=tiles, cores=cores)
    settings = basin_settings, SEARCH.label_limit
    parts = [basins.tile(attractors_at_a, number, *settings, "moving") for number in range(tiles)]
    near = basins.pairs(attractors_at_a, *settings, SEARCH.seed, "moving")
    maps = [(attractors_at_a.model, parts, near)]
    return basins.merge(maps, table, basin_settings, SEARCH.label_limit, "moving")


@pytest.fixture(scope="module")
def attractors_at_a(searched):
    return known_attractors(*searched[:2], MODEL)


@pytest.fixture(scope="module")
def basin_maps(table, attractors_at_a):
    return whole(table, attractors_at_a, 1, 1)


@pytest.mark.slow
def test_any_number_of_cores_and_tiles_gives_the_same_labels(table, attractors_at_a, basin_maps):
    for tiles, cores in ((3, 1), (1, 3), (5, 2)):
        assert basin_maps.identical(whole(table, attractors_at_a, tiles, cores)), (tiles, cores)
    assert basin_maps["undetermined_count"].item() == 0
    assert len(np.unique(basin_maps["branch"])) >= 2


def check_run(table, state, branch, contact="one_sided", **conventions):
    """Compare the branch that a state reaches with the mean distance of a full run."""
    options = {"transient": 6000.0, "window": 1000.0, "events": "none", "lyapunov_exponents": 0}
    run = simulate(Model("linearized", a=0.08, contact=contact), state, **options, **conventions)
    there = table.sel(law="linearized", a=0.08)
    mean = there["mean_distance"].values[there["branch"].values == branch.item()][0]
    assert run.mean_distance == pytest.approx(mean, abs=2e-4), (state, conventions)


@pytest.mark.slow
def test_runs_end_on_the_branches_of_their_pixels(table, basin_maps):
    """Every pixel of the diagonal, and the plane's axes: the first index is U_N(0)."""
    for k in range(0, 16, 3):
        for m in (k, (5 * k + 2) % 16):
            pixel = basin_maps.isel(map=0, first_position=m, last_position=k)
            position = (pixel["first_position"].item(), -0.993, pixel["last_position"].item())
            check_run(table, InitialState("pixel", position, (0.099, 0.1012, 0.1023)), pixel["branch"])


def test_runs_of_the_paper_end_on_the_branch_in_the_table(table):
    for contact, start, initial in product(CONTACTS, STARTS, PAPER_STATES):
        branch = table["initial_branch"].sel(law="linearized", a=0.08, contact=contact, start=start, initial=initial)
        check_run(table, initial, branch, contact=contact, start=start)


def test_a_plane_of_states():
    first = pixel_centres((-1.0, 1.0), 4)
    assert first.tolist() == [-0.75, -0.25, 0.25, 0.75]
    position, velocity = plane((5.0, 6.0, 7.0), first, np.array([8.0, 9.0]), (0.1, 0.2, 0.3))
    assert position.tolist() == [[x, 6.0, last] for last in (8.0, 9.0) for x in first]
    assert velocity.tolist() == [[0.1, 0.2, 0.3]] * 8


@pytest.mark.parametrize(("place", "pairs"), [(0, 0), (1, 1)])
def test_attractors_are_read_back_unchanged(searched, place, pairs):
    """This includes returns, mirror images and all values that determine a label."""
    table, returns, rows = searched
    model = MODEL.at(a=(0.08, 0.1)[place])
    restored, expected = known_attractors(table, returns, model), [row.attractor for row in rows[place]]
    assert restored.side.tolist() == [row.side for row in rows[place]]
    assert np.count_nonzero(restored.side) == 2 * pairs
    order = [row.index for row in rows[place]]
    for attractor, other in zip(restored.attractors, expected, strict=True):
        assert order[attractor.partner] == other.partner
        for name in ("symmetry", "radius", "slow", "close_returns", "patience"):
            assert getattr(attractor, name) == getattr(other, name)
        for name in ("kind", "block", "mirror_block", "spacing", "mean_distance", "section_period"):
            assert getattr(attractor.motion, name) == getattr(other.motion, name)
        # Positions are stored relative to the driver.
        assert attractor.motion.returns == pytest.approx(other.motion.returns, abs=1e-15)
        assert attractor.motion.mirror_returns == pytest.approx(other.motion.mirror_returns, abs=1e-15)


@pytest.mark.parametrize(
    ("other", "message"),
    [
        (replace(MODEL, law=law_of("nonlinear", a=0.08)), "model.law: 'nonlinear'"),
        (MODEL.at(a=0.09), "model.a: 0.09"),
        (replace(MODEL, v=0.2), "model.v: 0.2"),
        (replace(MODEL, contact="symmetric"), "model.contact: 'symmetric'"),
        (replace(MODEL, chain=Chain(4)), "model.blocks: 4"),
    ],
)
def test_files_of_another_model_are_refused(searched, other, message):
    with refused(message):
        known_attractors(*searched[:2], other)


def test_returns_of_another_law_are_refused(searched):
    table, returns, _ = searched
    with refused("model.law: 'linearized'"):
        known_attractors(table, returns.assign_attrs(law="nonlinear"), MODEL)


def test_without_attractors_all_states_are_undetermined(searched):
    table, returns, _ = searched
    none = table.sel(a=[0.08]).assign_coords(a=[0.0])
    none["branch"].values[...] = -1
    merged = whole(none, known_attractors(none, returns, MODEL.at(a=0.0)), 1, 1)
    assert (merged["branch"] == -1).all()
    assert merged["undetermined_count"].item() == 16 * 16
    assert (merged["pair_count"] == 0).all()
    assert np.isnan(merged["decision_time"]).all()
    assert np.isnan(merged["uncertainty_exponent"].item())
