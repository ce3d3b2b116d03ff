"""Returns of a motion that has settled, from which its periodic orbit is found."""

import numpy as np
import pytest

from burridge_knopoff import Model, OrbitError, multipliers
from burridge_knopoff.model.initial import PAPER_STATES
from burridge_knopoff.model.model import ChainState
from burridge_knopoff.motion import limit_cycle as module
from burridge_knopoff.motion.limit_cycle import _close_returns, limit_cycle
from burridge_knopoff.motion.synchronized_orbit import synchronized_orbit
from burridge_knopoff.periodic_orbits.periodic import find_periodic_orbit
from burridge_knopoff.periodic_orbits.symmetry import Symmetry
from burridge_knopoff.running.runner import Runner


@pytest.mark.parametrize(
    ("initial", "a", "symmetry"), [("minus", 0.08, Symmetry.SYNCHRONIZED), ("plus", 0.08, Symmetry.SYMMETRIC)]
)
def test_a_state_returns_after_the_stated_time(initial, a, symmetry):
    model = Model("linearized", a=a)
    runner = Runner(model, keep_events=True, events_from=5000.0)
    runner.begin(model.begin(PAPER_STATES[initial]))
    runner.run(5500.0)
    candidates = list(_close_returns(model, runner.log.events.times(), runner.log.events.values()))
    assert {returned for _, _, returned, _ in candidates} == {symmetry}
    for start, time, _, size in candidates:
        assert time > 1.0
        end = Runner(model).state_after(start, time)
        image = end.mirrored() if symmetry == Symmetry.SYMMETRIC else end
        assert np.abs(image.vector() - start.vector()).max() <= 2.0 * size


@pytest.mark.parametrize(("v", "mirrored"), [(0.1, [2.0, 1.1, 1.1, 1.1]), (0.2, [1.1, 1.1, 1.1, 1.1])])
def test_the_first_of_equally_close_states_is_the_return(v, mirrored):
    """The distance scales with v; the mirror block first stops too soon, or too far from the required place."""
    state = np.array([0.1, 0.2, 0.3, 0.0, 0.05, 0.06])
    image = state[[2, 1, 0, 5, 4, 3]]
    stops = [(0.0, 1, state), (0.05, 3, image), (0.5, 3, image + 0.5), (1.0, 1, state + 0.5)]
    stops += [(1.1, 3, image + 1.5e-7), (2.0, 1, state), (3.0, 1, state)]
    values = np.array([[block, 0, *at] for _, block, at in stops])
    candidates = list(_close_returns(Model("linearized", a=0.08, v=v), np.array([time for time, *_ in stops]), values))
    assert [time for _, time, *_ in candidates] == [2.0, *mirrored]
    kinds = {2.0: Symmetry.ASYMMETRIC, 1.1: Symmetry.SYMMETRIC}
    assert [symmetry for *_, symmetry, _ in candidates] == [kinds[time] for _, time, *_ in candidates]
    assert all(np.array_equal(start.vector(), state) for start, *_ in candidates)


def test_a_distant_orbit_is_not_the_orbit_of_a_motion(monkeypatch):
    """Newton's method may converge to any orbit, here to synchrony from motion in opposite phases."""
    model = Model("linearized", a=0.08)
    elsewhere = limit_cycle(model, synchronized_orbit(model).reference)
    monkeypatch.setattr(module, "find_periodic_orbit", lambda *_: elsewhere)
    with pytest.raises(OrbitError, match="no periodic orbit"):
        limit_cycle(model, model.begin(PAPER_STATES["plus"]), 2000.0, 500.0)


@pytest.mark.parametrize(
    ("blocks", "law", "a", "position"),
    [(3, "nonlinear", 0.19, [0.0, -0.04, -0.9]), (2, "linearized", 0.08, [0.0, -0.5])],
)
def test_chaos_lies_on_none_of_the_orbits_that_it_passes_by(blocks, law, a, position, monkeypatch):
    """Newton's method finds unstable orbits near the chaos of three blocks and the thin chaos of two."""
    passed = []

    def find(*arguments):
        passed.append(find_periodic_orbit(*arguments))
        return passed[-1]

    monkeypatch.setattr(module, "find_periodic_orbit", find)
    model = Model(law, a=a, blocks=blocks)
    start = ChainState(np.array(position), np.full(blocks, 0.1), np.zeros(blocks, dtype=bool))
    with pytest.raises(OrbitError, match="no periodic orbit"):
        limit_cycle(model, start, settling=2000.0)
    assert passed
    assert all(multipliers(orbit).unstable_count for orbit in passed)


@pytest.mark.parametrize(
    ("settling", "window", "words"),
    [
        (0.0, 3.0, "from the stops within 3, after 0 to settle: no block reaches them twice"),
        (100.0, 50.0, "from the stops within 50, after 100 to settle: the closest return is at a distance of"),
        (500.0, 8000.0, "; the distance from the stable orbit of period 157.245 there goes from"),
    ],
)
def test_an_error_says_what_was_tried(settling, window, words, monkeypatch):
    model = Model("linearized", a=0.08)
    if window == 8000.0:
        monkeypatch.setattr(module, "_is_on_orbit", lambda *_: False)
    with pytest.raises(OrbitError) as caught:
        limit_cycle(model, model.begin(PAPER_STATES["plus"]), settling, window)
    assert str(caught.value).startswith("a = 0.08: no periodic orbit found from the stops within ")
    assert words in str(caught.value)
    assert "\n" not in str(caught.value)


def test_an_unstable_orbit_is_that_of_a_motion_that_never_leaves_it():
    model = Model("linearized", a=0.09)
    orbit = limit_cycle(model, synchronized_orbit(model).reference)
    assert (orbit.symmetry, multipliers(orbit).unstable_count) == (Symmetry.SYNCHRONIZED, 1)


@pytest.mark.parametrize("apart", [0.0, 1e-11, 1e-10, 1e-9, 3e-9, 1e-8])
def test_synchrony_that_is_not_exact_is_periodic_too(apart):
    """The end blocks stop almost together, which is not a return of one to the other."""
    model = Model("linearized", a=0.0865)
    orbit = synchronized_orbit(model)
    start = orbit.reference
    position = start.position + np.array([0.5, 0.0, -0.5]) * apart
    cycle = limit_cycle(model, ChainState(position, start.velocity, start.stuck))
    assert cycle.period == pytest.approx(orbit.period, abs=1e-9)
    assert cycle.symmetry == Symmetry.SYNCHRONIZED


def test_an_orbit_of_a_long_period_is_found():
    model = Model("linearized", a=0.0575)
    orbit = limit_cycle(model, model.begin(PAPER_STATES["plus"]), settling=100_000.0)
    assert orbit.period == pytest.approx(2447.61, abs=0.01)
