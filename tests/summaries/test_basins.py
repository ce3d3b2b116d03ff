"""Maps of basins from hand-made tiles, and pairs of states labelled by a known rule."""

from dataclasses import replace

import numpy as np
import pytest
import xarray as xr

from burridge_knopoff import Model
from burridge_knopoff.attractors.settings import SEARCH
from burridge_knopoff.attractors.stored_returns import KnownAttractors
from burridge_knopoff.basins.pair_separation import SEPARATIONS, follow_pairs
from burridge_knopoff.basins.settings import BasinSettings
from burridge_knopoff.basins.uncertainty import ExponentKind, uncertainty_exponent
from burridge_knopoff.model.initial import PAPER_STATES
from burridge_knopoff.summaries import basins
from burridge_knopoff.summaries.map_rows import count_symmetric_undetermined

PLANE = BasinSettings(pixels=4, first_position=(-1.0, 3.0), last_position=(0.0, 2.0), pairs=50, tiles=2)
MODELS = [Model(law, a=a, v=0.2, contact="symmetric") for law, a in (("nonlinear", 0.1), ("linearized", 0.3))]


@pytest.fixture
def ruled(monkeypatch):
    """States are decided by a rule, at a time of 100 + U_1."""

    def label_states(model, attractors, position, velocity, *, start, time_limit, cores):
        assert (start, time_limit, cores) == ("moving", SEARCH.label_limit, 1)
        middle, speed = model.initial_coordinates(PAPER_STATES["minus"])
        assert (position[:, 1] == middle[1]).all()
        assert (velocity == speed).all()
        return rule(position), 100.0 + position[:, 0]

    monkeypatch.setattr(basins, "label_states", label_states)


#: Two attractors that only the rule distinguishes.
KNOWN = KnownAttractors(MODELS[0], [None, None], np.array([0, 5]), np.array([0, -1]))


def rule(position):
    """Return 1 where U_1 + U_3 > 1.2, otherwise 0; −1 where U_3 > 1.7."""
    return np.where(position[:, 2] > 1.7, -1, (position[:, 0] + position[:, 2] > 1.2).astype(int))


def test_a_tile_is_a_band_of_rows(ruled):
    tiles = [basins.tile(KNOWN, number, PLANE, SEARCH.label_limit, "moving") for number in (0, 1)]
    # Pixels lie in the middle of equal parts of [−1, 3] for the first position and of [0, 2] for the last.
    for tile, last in zip(tiles, ([0.25, 0.75], [1.25, 1.75]), strict=True):
        assert tile["first_position"].values.tolist() == [-0.5, 0.5, 1.5, 2.5]
        assert tile["last_position"].values.tolist() == last
        assert (tile.attrs["law"], tile.attrs["a"]) == ("nonlinear", 0.1)
    assert tiles[0]["branch"].values.tolist() == [[0, 0, 5, 5], [0, 5, 5, 5]]
    assert tiles[1]["branch"].values.tolist() == [[0, 5, 5, 5], [-1, -1, -1, -1]]
    assert tiles[1]["side"].values.tolist() == [[0, -1, -1, -1], [0, 0, 0, 0]]
    assert tiles[1]["decision_time"].values[0].tolist() == [99.5, 100.5, 101.5, 102.5]
    assert np.isnan(tiles[1]["decision_time"].values[1]).all()


def test_pairs_are_those_of_the_plane(ruled):
    dataset = basins.pairs(KNOWN, PLANE, SEARCH.label_limit, SEARCH.seed, "moving")

    def label(points):
        return rule(np.insert(points, 1, 0.0, axis=1))

    counts = follow_pairs(label, (-1.0, 3.0), (0.0, 2.0), 50, SEARCH.seed)
    expected = uncertainty_exponent(counts)
    assert dataset["uncertain_count"].values.tolist() == counts.different_count.tolist()
    assert dataset["pair_count"].values.tolist() == counts.labelled_count.tolist()
    parts = (expected.fraction, expected.local, expected.alpha, expected.change)
    names = ("uncertain_fraction", "local_exponent", "uncertainty_exponent", "exponent_change")
    for name, part in zip(names, parts, strict=True):
        np.testing.assert_array_equal(dataset[name].values, part[0])
        np.testing.assert_array_equal(dataset[f"{name}_error"].values, part[1])
    assert dataset["exponent_kind"].item() == expected.kind
    assert dataset["exponent_kind"].attrs["flag_meanings"] == "unknown varying single"
    # Parts of the width 4 of the first range.
    assert dataset["separation"].values == pytest.approx(4.0 * np.array(SEPARATIONS))
    assert dataset["separation"].values[[0, -1]] == pytest.approx([0.4, 0.4 / 3**12])


def test_maps_are_merged_and_described(ruled):
    candidates, limit = [replace(KNOWN, model=model) for model in MODELS], SEARCH.label_limit
    near = [basins.pairs(candidate, PLANE, limit, SEARCH.seed, "moving") for candidate in candidates]
    tiles = [[basins.tile(candidate, k, PLANE, limit, "moving") for k in (0, 1)] for candidate in candidates]
    maps = list(zip(MODELS, tiles, near, strict=True))
    near[0]["uncertainty_exponent"][...], near[0]["uncertainty_exponent_error"][...] = 0.8125, 0.025
    near[0]["exponent_kind"][...] = ExponentKind.SINGLE
    near[0]["exponent_change"][...], near[0]["exponent_change_error"][...] = -0.25, 0.125
    near[1]["exponent_change"][...], near[1]["exponent_change_error"][...] = 0.4375, 0.0625
    near[1]["exponent_kind"][...] = ExponentKind.VARYING
    attractors = xr.Dataset(
        {"branch_number": ("number", [0, 5]), "branch_name": ("number", ["synchronized", "pair (5)"])}
    )
    dataset = basins.merge(maps, attractors, PLANE, 7.0, "moving")
    assert dataset["branch"].values.tolist() == [[[0, 0, 5, 5], [0, 5, 5, 5], [0, 5, 5, 5], [-1] * 4]] * 2
    assert dataset["last_position"].values.tolist() == [0.25, 0.75, 1.25, 1.75]
    assert dataset["first_position"].values.tolist() == [-0.5, 0.5, 1.5, 2.5]
    assert dataset["undetermined_count"].values.tolist() == [4, 4]
    for name in basins.PAIR_VARIABLES:
        np.testing.assert_array_equal(dataset[name].values, [pairs[name].values for pairs in near])
    assert dataset["local_exponent"].dims == ("map", "separation_step")
    assert dataset["separation"].values == pytest.approx(4.0 * np.array(SEPARATIONS))
    assert (dataset["law"].values.tolist(), dataset["a"].values.tolist()) == (["nonlinear", "linearized"], [0.1, 0.3])
    assert dataset["decision_time"].values[0, 2].tolist() == [99.5, 100.5, 101.5, 102.5]
    expected = {"v": 0.2, "contact": "symmetric", "start": "moving", "label_limit": 7.0}
    assert {key: dataset.attrs[key] for key in expected} == expected
    assert [dataset.attrs[f"{name}_range"].tolist() for name in ("first", "last")] == [[-1.0, 3.0], [0.0, 2.0]]
    shares = "undetermined 25.00 %, synchronized 25.00 %, pair (5−) 50.00 %"
    decided = f"mean decision time {np.nanmean(dataset['decision_time'].values[0]):.0f}"
    varying = (
        "no single uncertainty exponent: from the largest separation to the smallest it changes by 0.4375 +- 0.0625"
    )
    single = (
        "uncertainty exponent 0.812 +- 0.025: if initial states are known 10 times as precisely, the fraction of them "
        "whose attractor is uncertain is divided by 6.5 (by 10 if the basin boundary is smooth)"
    )
    assert basins.digest(dataset) == (
        f"nonlinear, a = 0.1: {shares}; {single}; {decided}\nlinearized, a = 0.3: {shares}; {varying}; {decided}\n"
    )
    dataset["exponent_kind"][...] = ExponentKind.UNKNOWN
    assert basins.digest(dataset).count("; uncertainty exponent undetermined: too few pairs ") == 2


@pytest.mark.parametrize(("velocity", "alike"), [([0.1, 0.2, 0.1], 2), ([0.1, 0.2, 0.3], 0)])
def test_undetermined_states_that_are_their_own_mirror_images_are_counted(velocity, alike):
    """The states of one row and another one are undetermined; two of them lie where U_1 = U_N."""
    branch = np.array([[-1, -1, -1], [0, 0, -1], [0, 0, -1]])
    places = {name: [0.5, 1.5, 2.5] for name in ("last_position", "first_position")}
    plane = {"plane_position": np.array([1.0, 3.0, 2.0]), "plane_velocity": np.array(velocity)}
    assert count_symmetric_undetermined(xr.Dataset({"branch": (tuple(places), branch)}, places, plane)) == alike
    # All inner positions must be mirror-symmetric.
    four = {"plane_velocity": np.full(4, 0.1)}
    for inner, expected in (([3.0, 3.0], 2), ([3.0, 2.0], 0)):
        four["plane_position"] = np.array([1.0, *inner, 2.0])
        assert count_symmetric_undetermined(xr.Dataset({"branch": (tuple(places), branch)}, places, four)) == expected
