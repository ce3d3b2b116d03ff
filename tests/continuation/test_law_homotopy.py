"""Matching branches of two laws: attractors of the paper's chain, followed from one law to the other."""

import numpy as np
import pytest

from burridge_knopoff import Model, SearchSettings, find_attractors
from burridge_knopoff.continuation import law_homotopy
from burridge_knopoff.continuation.law_homotopy import STEPS, follow_law, match_branches
from burridge_knopoff.continuation.matching import SAME_SET
from burridge_knopoff.motion.set_distance import minimum_distance
from tests.motion.stand_in import section

SETTINGS = SearchSettings(samples=40, transient=1500.0, window=1500.0, perturbations=4)
A = 0.06


@pytest.fixture(scope="module")
def models():
    return [Model(law, a=A) for law in ("linearized", "nonlinear")]


@pytest.fixture(scope="module")
def attractors_of_laws(models):
    """The attractors of each: synchrony, one on which block 2 never sticks, and one on which it does."""
    result = []
    for model in models:
        attractors, _ = find_attractors(model, SETTINGS)
        result.append(sorted(attractors, key=lambda item: item.motion.mean_distance))
        assert len(attractors) == 3
    return result


def test_an_attractor_is_followed_to_the_one_of_the_other_law(models, attractors_of_laws):
    for first, second in zip(*attractors_of_laws, strict=True):
        end = follow_law(*models, first.motion.state(), SETTINGS)
        assert end is not None
        assert minimum_distance(end.returns, second.motion.returns) < 1e-3


def test_branches_are_joined_whatever_their_numbers(models, attractors_of_laws):
    first, second = ([item.motion.state() for item in part] for part in attractors_of_laws)
    states = {0: {0: first[0]}, 1: {0: first[1]}, 2: {0: first[2]}}
    others = {0: {0: second[0]}, 1: {0: second[2]}, 4: {0: second[1]}}
    for there, expected in (
        (others, {0: 0, 1: 2, 4: 1}),
        # A branch that does not exist at that a, or lies elsewhere, is not matched.
        ({0: others[0], 4: others[4]}, {0: 0, 4: 1}),
        ({0: others[0], 1: others[1]}, {0: 0, 1: 2}),
        ({0: others[0]}, {0: 0}),
    ):
        assert match_branches([models[0]], [models[1]], states, there, SETTINGS) == expected


def test_mirror_images_are_one_branch():
    """Each of them as in a file: a state at a stop of block 1."""
    model = Model("linearized", a=0.1)
    attractors, _ = find_attractors(model, SETTINGS)
    first, second = (item.motion.state() for index, item in enumerate(attractors) if item.partner != index)
    assert np.abs(first.vector() - second.vector()).max() > 0.01
    for there in (first, second):
        assert match_branches([model], [model], {1: {0: first}}, {4: {0: there}}, SETTINGS) == {0: 0, 4: 1}


@pytest.mark.parametrize(("v", "expected"), [(0.1, {0: 0}), (0.2, {0: 0, 3: 1})])
def test_the_distance_within_which_branches_match_grows_with_the_velocity(v, expected, attractors_of_laws, monkeypatch):
    models = [Model(law, a=A, v=v) for law in ("linearized", "nonlinear")]
    first, second = (part[1].motion.state() for part in attractors_of_laws)
    near = second.vector()[None] + 1.5 * SAME_SET
    monkeypatch.setattr(law_homotopy, "follow_law", lambda *_, **__: section(near, near, 0.0, 0.0))
    assert match_branches([models[0]], [models[1]], {1: {0: first}}, {3: {0: second}}, SETTINGS) == expected


@pytest.fixture
def follow(script_answers):
    """Return a function that calls `follow_law` with scripted sets at each step; None where no motion settles."""

    def follow_places(places):
        sets = [None if place is None else np.full((10, 6), place) for place in places]
        calls = script_answers(
            law_homotopy, "visit", [None if points is None else section(points, points, 0.0, 0.0) for points in sets]
        )
        pair = [Model(law, a=0.5, v=0.2, contact="symmetric") for law in ("linearized", "nonlinear")]
        start = section(np.full((1, 6), 7.0), np.zeros((0, 6)), 0.0, 0.0).state()
        return follow_law(*pair, start, SETTINGS), calls

    return follow_places


def test_a_law_is_changed_in_even_steps(follow):
    places = [0.01 * step for step in range(STEPS + 1)]
    end, calls = follow(places)
    assert end.returns[0, 0] == pytest.approx(places[-1])
    models, starts, transients, *_ = zip(*calls, strict=True)
    assert [float(model.law(1.0)) for model in models] == pytest.approx(np.linspace(0.5, 1 / 1.5, len(places)).tolist())
    assert models[-1].law.name == "nonlinear"
    # Each step continues from the state of the one before.
    assert [float(start.position[0]) for start in starts] == pytest.approx([7.0, *places[:-1]])
    assert set(transients) == {1500.0}
    # Nothing else of the model changes.
    assert {(model.v, model.contact) for model in models} == {(0.2, "symmetric")}


def test_a_torus_may_be_locked_on_the_way(follow):
    """The orbit lies on the torus, although most of the torus is far from the orbit."""
    torus = np.linspace(0.0, 0.9, 10)[:, None]
    assert follow([torus, 0.3, *[torus] * 15])[0] is not None


def test_if_two_branches_arrive_at_one_the_longer_is_matched(monkeypatch):
    """Each is followed at three of the values of a at which it exists; the longer one arrives from two of them."""
    models = [[Model(law, a=0.1 * k) for k in range(6)] for law in ("linearized", "nonlinear")]
    near, far = (section(np.full((1, 6), place), np.zeros((0, 6)), 0.0, 0.0) for place in (0.0, 9.0))
    calls = []

    def follow(first, second, start, **_):
        assert first.parameter("a") == second.parameter("a")
        calls.append((start is there_on_it, first.parameter("a")))
        return None if calls[-1] == (True, 0.0) else near

    on_it, there_on_it = near.state(), far.state()
    monkeypatch.setattr(law_homotopy, "follow_law", follow)
    states = {1: dict.fromkeys(range(3), on_it), 2: dict.fromkeys(range(6), there_on_it)}
    assert match_branches(*models, states, {7: dict.fromkeys(range(6), on_it)}, SETTINGS) == {0: 0, 7: 2}
    expected = [(False, a) for a in (0.0, 0.1, 0.2)] + [(True, a) for a in (0.0, 0.2, 0.5)]
    assert [long for long, _ in sorted(calls)] == [long for long, _ in expected]
    assert [a for _, a in sorted(calls)] == pytest.approx([a for _, a in expected])


def test_motion_that_jumps_between_steps_is_not_followed_further(follow):
    """A set may move by SAME_SET in a step, which scales with v, and not by more."""
    limit = 2.0 * SAME_SET
    assert follow([0.0, 0.99 * limit, *[0.99 * limit] * 20])[0] is not None
    for places in ([0.0, 1.01 * limit], [0.0, 0.0, None]):
        end, calls = follow(places)
        assert end is None
        assert len(calls) == len(places)
