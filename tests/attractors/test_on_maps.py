"""The search for attractors on maps whose attractors and basins are known in closed form."""

import numpy as np
import pytest

from burridge_knopoff import InitialState, MotionKind, SearchSettings
from burridge_knopoff.attractors.lifetime import lifetimes
from burridge_knopoff.attractors.search import Search
from tests.maps import CIRCLE, LOGISTIC, TWO_WELLS

SEARCH = SearchSettings(
    samples=30, position=(0.05, 0.95), transient=400.0, window=480.0, time_limit=1000.0, lifetime=2000.0
)


def search_map(model, settings=SEARCH):
    search = Search(model, settings)
    starts = search.starts((), "moving")
    return search, np.array([start.position[0] for start in starts]), search.labels(starts)


@pytest.mark.parametrize(
    ("r", "period"),
    [(2.5, 1), (3.2, 2), (3.5, 4), (3.55, 8), (3.835, 3)],
)
def test_the_periodic_orbit_of_the_logistic_map_is_its_only_attractor(maps, r, period):
    """This holds in the window of period 3 too, in which chaos is transient."""
    search, _, labels = search_map(LOGISTIC.at(r))
    (attractor,) = search.attractors
    assert (attractor.motion.kind, attractor.motion.section_period) == (MotionKind.PERIODIC, period)
    assert (labels == 0).all()
    orbit = LOGISTIC.at(r).orbit(0.3, 20_000)[-period:]
    assert np.sort(attractor.motion.returns[-period:, 0]) == pytest.approx(np.sort(orbit), abs=1e-6)
    # The multiplier of the orbit.
    multiplier = np.abs(LOGISTIC.slope(orbit, r)).prod()
    assert attractor.motion.exponent[1] == pytest.approx(np.log(multiplier) / period, abs=1e-6)


def test_chaos_of_the_logistic_map_is_a_single_attractor_that_lasts(maps):
    """At r = 4 the exponent is ln 2, and no trajectory leaves [0, 1]."""
    search, _, labels = search_map(LOGISTIC.at(3.999999))
    (attractor,) = search.attractors
    assert attractor.motion.kind == MotionKind.CHAOTIC
    assert (labels == 0).all()
    assert attractor.motion.exponent[0] == pytest.approx(np.log(2.0), abs=0.02)
    (life,) = lifetimes(search.model, search.attractors, SEARCH)
    assert life.is_longer_than(SEARCH.lifetime)


def test_motion_that_never_returns_is_quasiperiodic(maps):
    search, _, labels = search_map(CIRCLE)
    (attractor,) = search.attractors
    assert attractor.motion.kind == MotionKind.QUASIPERIODIC
    assert (labels == 0).all()


@pytest.mark.parametrize("mu", [0.0, 0.2, -0.3])
def test_states_are_labelled_by_the_well_that_they_reach(maps, mu):
    """The unstable fixed point between the wells separates their basins."""
    model = TWO_WELLS.at(1.0 + mu)
    settings = SearchSettings(samples=60, position=(-1.2, 1.2), transient=100.0, window=100.0, time_limit=400.0)
    search, x, labels = search_map(model, settings)
    roots = np.sort(np.roots([-1.0, 0.0, 1.0, mu]).real)
    wells = np.array([item.motion.state().position[0] for item in search.attractors])
    assert np.sort(wells) == pytest.approx(roots[[0, 2]], abs=1e-9)
    assert (wells[labels] == np.where(x < roots[1], wells.min(), wells.max())).all()
    # No radius extends beyond the point that separates the basins.
    for item, well in zip(search.attractors, wells, strict=True):
        assert 0.0 < item.radius < abs(well - roots[1])


def test_the_attractors_do_not_depend_on_the_order_of_the_states(maps):
    settings = SearchSettings(samples=40, position=(-1.2, 1.2), transient=100.0, window=100.0, time_limit=400.0)
    model = TWO_WELLS.at(1.1)
    first = Search(model, settings)
    starts = first.starts((), "moving")
    second = Search(model, settings)
    wells = []
    for search, states in ((first, starts), (second, starts[::-1])):
        labels = search.labels(states)
        wells.append(np.array([search.attractors[k].motion.state().position[0] for k in labels]))
    assert wells[0] == pytest.approx(wells[1][::-1], abs=1e-9)


def test_a_trajectory_next_to_an_unstable_fixed_point_falls_into_a_well(maps):
    settings = SearchSettings(samples=0, position=(-1.2, 1.2), transient=100.0, window=100.0, time_limit=400.0)
    search = Search(TWO_WELLS, settings)
    for x in (1e-9, -1e-9):
        index = search.reach(TWO_WELLS.begin(InitialState("next", (x,), (0.1,))))
        assert search.attractors[index].motion.state().position[0] == pytest.approx(np.sign(x))
    assert len(search.attractors) == 2
