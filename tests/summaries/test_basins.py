"""Maps of basins put together from hand-made tiles, and pairs of states labelled by a rule that is known."""

import numpy as np
import pytest
import xarray

from burridge_knopoff import Chain, Model, law_of
from burridge_knopoff.model.initial import PAPER_STATES
from burridge_knopoff.stability.basins import KnownAttractors
from burridge_knopoff.stability.settings import MOTION, SEARCH, BasinSettings
from burridge_knopoff.stability.uncertainty import SEPARATIONS, sample_pairs, uncertainty_exponent
from burridge_knopoff.summaries import basins

PLANE = BasinSettings(pixels=4, first_position=(-1.0, 3.0), last_position=(0.0, 2.0), pairs=50, tiles=2)
FOUND = (PLANE, SEARCH, MOTION, "moving")
MODELS = [Model(Chain(3), law_of(law, a), 0.2, "symmetric") for law, a in (("nonlinear", 0.1), ("linearized", 0.3))]


@pytest.fixture
def ruled(monkeypatch):
    """States are decided by a rule, at a time of 100 + U_1."""

    def label_states(model, attractors, position, velocity, *, start, time_limit, threads):
        assert (start, time_limit, threads) == ("moving", SEARCH.time_limit, 1)
        assert (position[:, 1] == PAPER_STATES["minus"].position[1]).all()
        assert (velocity == PAPER_STATES["minus"].velocity).all()
        return rule(position), 100.0 + position[:, 0]

    def known(attractors, model, settings, motion):
        return KnownAttractors(model, [None, None], np.array([0, 5]), np.array([0, -1]))

    monkeypatch.setattr(basins, "label_states", label_states)
    monkeypatch.setattr(basins, "known_attractors", known)


def rule(position):
    """Return 1 where U_1 + U_3 > 1.2, else 0; −1 where U_3 > 1.7."""
    return np.where(position[:, 2] > 1.7, -1, (position[:, 0] + position[:, 2] > 1.2).astype(int))


def test_a_tile_is_a_band_of_rows(ruled):
    tiles = [basins.tile(None, MODELS[0], number, *FOUND) for number in (0, 1)]
    # Pixels of the first position in the middles of [−1, 3], of the last one in those of [0, 2].
    for tile, last in zip(tiles, ([0.25, 0.75], [1.25, 1.75]), strict=True):
        assert tile["first_position"].values.tolist() == [-0.5, 0.5, 1.5, 2.5]
        assert tile["last_position"].values.tolist() == last
        assert (tile.attrs["law"], tile.attrs["a"]) == ("nonlinear", 0.1)
    assert tiles[0]["branch"].values.tolist() == [[0, 0, 5, 5], [0, 5, 5, 5]]
    assert tiles[1]["branch"].values.tolist() == [[0, 5, 5, 5], [-1, -1, -1, -1]]
    assert tiles[1]["side"].values.tolist() == [[0, -1, -1, -1], [0, 0, 0, 0]]
    assert tiles[1]["decision_time"].values[0].tolist() == [99.5, 100.5, 101.5, 102.5]
    assert np.isnan(tiles[1]["decision_time"].values[1]).all()


def test_pairs_are_counted_at_each_separation(ruled):
    found = basins.pairs(None, MODELS[0], *FOUND)
    points, partners = sample_pairs((-1.0, 3.0), (0.0, 2.0), 50, SEARCH.seed)
    labels, others = (rule(np.insert(x, 1, 0.0, axis=-1).reshape(-1, 3)) for x in (points, partners))
    others = others.reshape(5, 50)
    for k, name in enumerate(("uncertain_count", "pair_count")):
        expected = [
            sum(i >= 0 and j >= 0 and (k == 1 or i != j) for i, j in zip(labels, row, strict=True)) for row in others
        ]
        assert found[name].values.tolist() == expected
    assert found["pair_count"].values.max() < 50
    # Parts of the width 4 of the first range.
    assert found["separation"].values == pytest.approx([0.012, 0.004, 0.0012, 0.0004, 0.00012], rel=1e-12)


def test_pairs_lie_apart_by_parts_of_the_width():
    points, partners = sample_pairs((-1.0, 3.0), (0.0, 2.0), 2000, 3)
    assert (points >= [-1.0, 0.0]).all()
    assert (points <= [3.0, 2.0]).all()
    assert points.mean(axis=0) == pytest.approx([1.0, 1.0], abs=0.1)
    shift = partners - points
    np.testing.assert_allclose(np.hypot(*shift.T).T, np.outer(SEPARATIONS, [4.0] * 2000), rtol=1e-9)
    # In every direction, and in one for all separations.
    direction = shift / (4.0 * np.array(SEPARATIONS)[:, None, None])
    assert np.ptp(direction, axis=0).max() < 1e-9
    assert np.abs(direction[0].mean(axis=0)).max() < 0.05
    assert np.histogram(np.arctan2(*direction[0].T), 8, (-np.pi, np.pi))[0].min() > 190
    assert [part.shape for part in sample_pairs((0.0, 1.0), (0.0, 1.0), 0, 3)] == [(0, 2), (5, 0, 2)]


def test_the_exponent_is_that_of_a_weighted_line():
    """f = c ε^0.4, but for the last digit of the counts; the error from the binomial weights of a line, by hand."""
    known = np.array([10**7] * 5)
    share = 3.0 * np.array(SEPARATIONS) ** 0.4
    different = np.round(known * share).astype(int)
    weight = different / (1.0 - different / known)
    x = np.log(SEPARATIONS)
    error = np.sqrt(1.0 / (weight * (x - np.average(x, weights=weight)) ** 2).sum())
    assert uncertainty_exponent(different, known) == pytest.approx((0.4, error), abs=1e-6)
    # Three separations with eight pairs that differ are enough, two are not.
    counts = np.array([80, 40, 8, 7, 3])
    alpha, _ = uncertainty_exponent(counts, np.full(5, 1000))
    slope = np.polyfit(x[:3], np.log(counts[:3] / 1000), 1, w=np.sqrt(counts[:3] / (1 - counts[:3] / 1000)))[0]
    assert alpha == pytest.approx(slope, abs=1e-9)
    assert np.isnan(uncertainty_exponent(np.array([80, 40, 7, 7, 3]), np.full(5, 1000))).all()
    # Where all pairs differ nothing is told of the separation.
    assert np.isnan(uncertainty_exponent(np.array([1000, 40, 8, 7, 3]), np.full(5, 1000))).all()


def test_maps_are_put_together_and_told(ruled):
    maps = [
        (MODELS[n], [basins.tile(None, MODELS[n], k, *FOUND) for k in (0, 1)], counted(*c))
        for n, c in enumerate(COUNTS)
    ]
    found = basins.merge(maps, ["linearized", "nonlinear"], PLANE, 7.0, "moving")
    assert found["branch"].values.tolist() == [[[0, 0, 5, 5], [0, 5, 5, 5], [0, 5, 5, 5], [-1] * 4]] * 2
    assert found["last_position"].values.tolist() == [0.25, 0.75, 1.25, 1.75]
    assert found["first_position"].values.tolist() == [-0.5, 0.5, 1.5, 2.5]
    assert found["undetermined_count"].values.tolist() == [4, 4]
    for k, (different, known) in enumerate(COUNTS):
        assert found["uncertain_count"].values[k].tolist() == different
        assert found["pair_count"].values[k].tolist() == known
        told = [found[f"uncertainty_exponent{end}"].values[k] for end in ("", "_error")]
        assert told == pytest.approx(uncertainty_exponent(np.array(different), np.array(known)), nan_ok=True)
    assert found["separation"].values == pytest.approx(4.0 * np.array(SEPARATIONS))
    assert found["law"].values.tolist() == [1, 0]
    assert found["a"].values.tolist() == [0.1, 0.3]
    assert found.attrs["first_range"].tolist() == [-1.0, 3.0]
    assert found.attrs["last_range"].tolist() == [0.0, 2.0]
    assert found["decision_time"].values[0, 2].tolist() == [99.5, 100.5, 101.5, 102.5]
    expected = {"v": 0.2, "contact": "symmetric", "start": "moving", "time_limit": 7.0}
    assert {key: found.attrs[key] for key in expected} == expected
    alpha, error = (found[f"uncertainty_exponent{end}"].values[0] for end in ("", "_error"))
    shares = "undetermined 25.00 %, synchronized 25.00 %, branch 5 (-) 50.00 %"
    decided = f"decided at tau = {np.nanmean(found['decision_time'].values[0]):.0f} in the mean"
    assert basins.digest(found) == (
        f"nonlinear, a = 0.1: {shares}; uncertainty exponent {alpha:.3f} +- {error:.3f}; {decided}\n"
        f"linearized, a = 0.3: {shares}; uncertainty exponent nan +- nan; {decided}\n"
    )


COUNTS = [([80, 40, 20, 10, 3], [1000, 1000, 1000, 1000, 999]), ([0, 0, 0, 0, 0], [50, 50, 50, 50, 49])]


def counted(different, known):
    return xarray.Dataset({"uncertain_count": ("separation", different), "pair_count": ("separation", known)})
