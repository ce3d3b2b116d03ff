"""Labels of many states together are those of each alone, on real attractors."""

import numpy as np
import pytest

from burridge_knopoff import Model, MotionSettings, SearchSettings, label_states
from burridge_knopoff.attractors.search import Search
from burridge_knopoff.kernel._core import Clouds
from burridge_knopoff.model.sampling import sample_initial_states, sample_states
from burridge_knopoff.running.runner import Runner
from burridge_knopoff.running.status import Status

SETTINGS = SearchSettings(transient=1000.0, window=1000.0, seed=3, perturbations=8)


def label_one_by_one(model, attractors, starts, end):
    """Follow each state alone, from stop to stop of each attractor's block; return labels and their times."""
    solver = Runner(model)
    labels, times = np.full(len(starts), -1), np.full(len(starts), end)
    for k, start in enumerate(starts):
        for index, item in enumerate(attractors):
            solver.begin(start)
            streak = 0
            while streak < item.close_returns and solver.run(times[k], item.motion.block - 1) == Status.HALTED:
                vector = solver.state().vector()
                near = (np.abs(item.motion.returns - vector) <= item.radius).all(axis=1).any()
                streak = streak + 1 if near else 0
            if streak >= item.close_returns and solver.clock < times[k]:
                labels[k], times[k] = index, solver.clock
    return labels, times


@pytest.mark.slow
@pytest.mark.parametrize(
    ("blocks", "a", "share", "first", "last"),
    [
        (3, 0.08, 1.0, 150.0, 1500.0),
        (3, 0.15, 0.98, 150.0, 1500.0),
        (4, 0.02, 1.0, 1500.0, 4000.0),
    ],
)
def test_labels_are_those_of_one_by_one(law, blocks, a, share, first, last):
    """In chaos the two kernels diverge, so a state near a basin boundary may end on the other side."""
    model = Model(law, a=a, blocks=blocks)
    search = Search(model, SETTINGS, MotionSettings())
    box = (-1.5, 1.5), (0.0, 0.2)
    position, velocity = sample_states(blocks, 100 if blocks > 3 else 200, *box, 5)
    starts = [model.begin(state) for state in sample_initial_states(blocks, len(position), *box, 5)]
    for start in starts[:12]:
        search.reach(start)
    assert search.attractors
    decided, when = label_one_by_one(model, search.attractors, starts, last)
    for end in (first, last):
        expected = np.where(when <= end, decided, -1)
        labels, times = label_states(model, search.attractors, position, velocity, time_limit=end)
        same = labels == expected
        assert same.mean() >= share
        assert (expected >= 0).mean() > (0.2 if end == first else 0.5)
        assert np.mean(np.abs(times - np.minimum(when, end))[same] < 1e-9) >= share - 0.05
        assert (times[labels < 0] == end).all()


def test_the_distance_from_a_cloud_is_exact_to_the_last_bit():
    """The result agrees with the differences from each return, also exactly at the radius."""
    generator = np.random.default_rng(2)
    orbit = np.repeat(generator.uniform(-1, 1, (5, 6)), 40, axis=0) + 1e-9 * generator.normal(size=(200, 6))
    clouds = [generator.uniform(-0.3, 0.3, (500, 6)), np.zeros((0, 6)), orbit, generator.uniform(-1, 1, (1, 6))]
    radius = [0.1, 1.0, 0.02, 0.25]
    kernel = Clouds(clouds, 6, radius)
    count = 0
    for index, (cloud, limit) in enumerate(zip(clouds, radius, strict=True)):
        states = generator.uniform(-0.4, 0.4, (300, 6))
        if len(cloud):
            edge = generator.choice([-limit, limit, np.nextafter(limit, 9.0), 0.3 * limit], (300, 6))
            states = np.concatenate([states, cloud[generator.integers(len(cloud), size=300)] + edge])
        for state in states:
            first = (cloud[:, 0] >= state[0] - limit) & (cloud[:, 0] <= state[0] + limit)
            expected = bool(((np.abs(cloud - state)[:, 1:] <= limit).all(axis=1) & first).any())
            assert kernel.is_near(index, state) == expected
            count += expected
    assert count > 50
