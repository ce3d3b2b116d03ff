"""Labels where a closed orbit lies in the midst of another attractor, which has patience."""

import dataclasses

import numpy as np
import pytest

from burridge_knopoff import Chain, Model, law_of
from burridge_knopoff.model.initial import PAPER_STATES
from burridge_knopoff.running.processes import shared_out
from burridge_knopoff.stability import fractions
from burridge_knopoff.stability.attractor import Symmetry
from burridge_knopoff.stability.attractors import Search
from burridge_knopoff.stability.labels import UNDETERMINED, label_states
from burridge_knopoff.stability.motion import MotionKind
from burridge_knopoff.stability.sampling import sample_states
from burridge_knopoff.stability.settings import SearchSettings
from tests.stability.stand_in import stand_in

MODEL = Model(Chain(3), law_of("linearized", 0.08))
END = 1000.0


@pytest.fixture(scope="module")
def found():
    """Return synchrony, and how sampled states reach it alone."""
    search = Search(MODEL, SearchSettings(transient=1000.0, window=500.0))
    search.reach(MODEL.begin(PAPER_STATES["minus"]))
    (orbit,) = search.attractors
    states = sample_states(3, 100, (-1.5, 1.5), (0.0, 0.2), 5)
    return orbit, states, label_states(MODEL, [orbit], *states, time_limit=END)


@pytest.mark.parametrize("patience", [0.0, 120.0, 200.0, 1e9])
def test_what_comes_to_an_orbit_within_the_patience_is_labelled_so(found, patience):
    orbit, states, (alone, reached_at) = found
    wide = dataclasses.replace(orbit, radius=1.0, close_returns=2, patience=patience)
    for order in ([wide, orbit], [orbit, wide]):
        chaos, synchrony = order.index(wide), order.index(orbit)
        labels, times = label_states(MODEL, order, *states, time_limit=END)
        near, near_at = label_states(MODEL, [wide], *states, time_limit=END)
        comes = (alone == 0) & (reached_at < patience)
        # Without patience the wide one is always reached first.
        expected = np.where(comes, synchrony, np.where(near == 0, chaos, UNDETERMINED))
        assert labels.tolist() == expected.tolist()
        np.testing.assert_allclose(times, np.where(comes, reached_at, near_at))
    shares = {0.0: (0.0, 0.0), 120.0: (0.1, 0.6), 200.0: (0.3, 0.95), 1e9: (0.5, 1.0)}
    assert shares[patience][0] <= comes.mean() <= shares[patience][1]


@pytest.mark.parametrize(("came", "expected"), [([300.0, 100.0], 900.0), ([4000.0, 100.0], 10_000.0), ([], 10_000.0)])
def test_patience_is_spared_where_a_sample_comes_early(monkeypatch, came, expected):
    chaos = stand_in(Symmetry.SYMMETRIC, 0.1, 0, 0.05, kind=MotionKind.CHAOTIC, spacing=1.0, patience=10_000.0)
    orbit = stand_in(Symmetry.SYMMETRIC, 0.1, 1, 0.0)
    labels, times = np.array([1] * len(came) + [0, -1]), np.array([*came, 5000.0, 20_000.0])
    asked = []

    def told(model, known, position, velocity, stuck, time_limit):
        asked.append(len(position))
        return (labels, times) if len(asked) == 1 else (np.zeros(len(position), dtype=int), None)

    monkeypatch.setattr(fractions, "label_together", told)
    search = Search(MODEL, SearchSettings(samples=20, fraction_samples=50), attractors=[chaos, orbit])
    with shared_out(1) as each:
        (search,), _ = fractions.fraction_labels([search], "moving", each)
    assert [item.patience for item in search.attractors] == [expected, 0.0]
    assert asked == [20, 50]
