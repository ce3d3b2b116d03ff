"""Labels of states, in particular if an attractor has a patience because a periodic orbit is embedded in it."""

from dataclasses import replace

import numpy as np
import pytest

from burridge_knopoff import Model, MotionKind, SearchSettings, label_states
from burridge_knopoff.attractors.labels import UNDETERMINED
from burridge_knopoff.attractors.search import Search
from burridge_knopoff.basins import fractions
from burridge_knopoff.model.initial import PAPER_STATES
from burridge_knopoff.model.sampling import sample_states
from burridge_knopoff.running.processes import parallel_map
from burridge_knopoff.running.runner import Runner
from tests.motion.stand_in import stand_in

MODEL = Model("linearized", a=0.08)
END = 1000.0


@pytest.fixture(scope="module")
def reached():
    """Return synchrony, sampled states, and the labels and times with synchrony as the only attractor."""
    search = Search(MODEL, SearchSettings(transient=1000.0, window=500.0))
    search.reach(MODEL.begin(PAPER_STATES["minus"]))
    (orbit,) = search.attractors
    states = sample_states(3, 100, (-1.5, 1.5), (0.0, 0.2), 5)
    return orbit, states, label_states(MODEL, [orbit], *states, time_limit=END)


@pytest.mark.parametrize(
    ("patience", "least", "most"), [(0.0, 0.0, 0.0), (120.0, 0.1, 0.6), (200.0, 0.3, 0.95), (1e9, 0.5, 1.0)]
)
def test_a_state_that_reaches_an_orbit_within_the_patience_is_assigned_to_it(reached, patience, least, most):
    orbit, states, (alone, reached_at) = reached
    wide = replace(orbit, radius=1.0, close_returns=2, patience=patience)
    near, near_at = label_states(MODEL, [wide], *states, time_limit=END)
    # Without patience the wide attractor is always reached first.
    comes = (alone == 0) & (reached_at < patience)
    for order in ([wide, orbit], [orbit, wide]):
        labels, times = label_states(MODEL, order, *states, time_limit=END)
        expected = np.where(comes, order.index(orbit), np.where(near == 0, order.index(wide), UNDETERMINED))
        assert labels.tolist() == expected.tolist()
        np.testing.assert_allclose(times, np.where(comes, reached_at, near_at))
    assert least <= comes.mean() <= most


@pytest.mark.parametrize(("came", "expected"), [([300.0, 100.0], 900.0), ([4000.0, 100.0], 10_000.0), ([], 10_000.0)])
def test_patience_is_reduced_if_a_sample_arrives_early(script_answers, came, expected):
    chaos = stand_in(ahead=0.05, kind=MotionKind.CHAOTIC, spacing=1.0, patience=10_000.0)
    labels, times = np.array([1] * len(came) + [0, -1]), np.array([*came, 5000.0, 20_000.0])
    calls = script_answers(fractions, "label_arrays", [(labels, times, None), (np.zeros(50, dtype=int), None, None)])
    attractors = [chaos, stand_in(partner=1, ahead=0.0)]
    search = Search(MODEL, SearchSettings(samples=20, fraction_width=0.134), attractors=attractors)
    with parallel_map(1) as pool:
        (search,), _ = fractions.fraction_labels([search], "moving", pool)
    assert [item.patience for item in search.attractors] == [expected, 0.0]
    assert [(len(position), limit) for _, _, position, _, _, limit in calls] == [(20, 20_000.0), (50, 200_000.0)]


def sticking(position):
    """Return which blocks have a spring force −(K U) of at most the threshold."""
    return position @ np.array([[-2.0, 1.0, 0.0], [1.0, -4.0, 1.0], [0.0, 1.0, -2.0]]) <= 1.0


def test_states_of_the_basin_fractions_obey_the_start_convention(script_answers):
    """With a tested start blocks stick if the spring force is too small; the states at each a are independent."""
    calls = script_answers(fractions, "label_arrays", [(np.zeros(50, dtype=int), None, None)] * 3)
    settings = SearchSettings(samples=0, fraction_width=0.134)
    for a, start in ((0.08, "tested"), (0.08, "moving"), (0.09, "tested")):
        with parallel_map(1) as pool:
            fractions.fraction_labels([Search(MODEL.at(a=a), settings, attractors=[stand_in()])], start, pool)
    positions, velocities, sticks = zip(*(arguments[2:5] for arguments in calls), strict=True)
    expected = sticking(positions[0] + MODEL.sliding_offset)
    assert 0.2 < expected.mean() < 0.9
    assert sticks[0].tolist() == (velocities[0] == 0.0).tolist() == expected.tolist()
    assert not sticks[1].any()
    assert velocities[1].min() > 0.0
    assert (positions[0] == positions[1]).all()
    assert abs(np.corrcoef(positions[0].ravel(), positions[2].ravel())[0, 1]) < 0.3


def test_states_obey_the_start_convention(reached):
    """With a tested start such blocks begin at rest."""
    orbit, (position, velocity), (_, moving) = reached
    labels, times = label_states(MODEL, [orbit], position, velocity, start="tested", time_limit=END)
    expected = label_states(MODEL, [orbit], position, np.where(sticking(position), 0.0, velocity), time_limit=END)
    assert labels.tolist() == expected[0].tolist()
    np.testing.assert_allclose(times, expected[1], atol=1e-6)
    assert np.mean(np.abs(times - moving) > 1e-3) > 0.3


def test_blocks_may_slip_backward_under_a_symmetric_contact():
    model = Model("linearized", a=0.08, contact="symmetric")
    labels, _ = label_states(model, [], np.full((2, 3), -0.9), np.full((2, 3), -0.1))
    assert labels.tolist() == [UNDETERMINED] * 2


@pytest.mark.parametrize("cores", [1, 2, 3, 7, 101])
def test_labels_do_not_depend_on_the_number_of_cores(reached, cores):
    orbit, states, (labels, times) = reached
    shared = label_states(MODEL, [orbit], *states, time_limit=END, cores=cores)
    assert shared[0].tolist() == labels.tolist()
    assert shared[1].tolist() == times.tolist()
    assert len({*labels.tolist()}) == 2


def test_an_attractor_is_reached_at_the_stops_of_its_own_block(reached):
    """Returns of the middle block never agree with states at stops of the first one."""
    orbit, states, (labels, _) = reached
    inner = returns_at(MODEL, orbit.motion.state(), 2)
    few = [part[:20] for part in states]
    other = replace(orbit, motion=replace(orbit.motion, returns=inner, block=2))
    assert label_states(MODEL, [other], *few, time_limit=END + 100.0)[0].tolist() == labels[:20].tolist()
    wrong = replace(orbit, motion=replace(orbit.motion, returns=inner))
    assert {*label_states(MODEL, [wrong], *few, time_limit=END + 100.0)[0].tolist()} == {UNDETERMINED}


def returns_at(model, start, block):
    """Return the states at the stops of a block."""
    runner = Runner(model, keep_events=True)
    runner.begin(start)
    runner.run(500.0)
    events = runner.log.events.values()
    return events[(events[:, 0] == block) & (events[:, 1] == 0), 2:]


@pytest.mark.filterwarnings("ignore:the matrix subclass")
def test_states_may_be_a_matrix_of_numpy(reached):
    orbit, states, (labels, _) = reached
    few = [np.matrix(values[:20]) for values in states]
    assert label_states(MODEL, [orbit], *few, time_limit=END)[0].tolist() == labels[:20].tolist()
