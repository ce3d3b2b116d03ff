"""Attractors: labels hold for whole runs, unstable motions are none, mirror images go together, branches follow a."""

import dataclasses

import numpy as np
import pytest

from burridge_knopoff import Chain, FormulaLaw, InitialState, Model, Settings, law_of, simulate
from burridge_knopoff.model.initial import PAPER_STATES
from burridge_knopoff.model.model import Instant
from burridge_knopoff.stability import attractors
from burridge_knopoff.stability.attractors import Search, find_attractors
from burridge_knopoff.stability.labels import ASYMMETRIC, SYMMETRIC, SYNCHRONIZED, label
from burridge_knopoff.stability.motion import CHAOTIC, QUASIPERIODIC
from burridge_knopoff.stability.motion import SYNCHRONIZED as KIND_SYNCHRONIZED
from burridge_knopoff.stability.sampling import fraction_interval, sample_states, sampled_states
from burridge_knopoff.stability.settings import MOTION, SEARCH, MotionSettings, SearchSettings
from burridge_knopoff.stability.steady import (
    Returns,
    instant_of,
    lies_on,
    measure,
    visit,
)
from tests.stability.stand_in import stand_in

SETTINGS = SearchSettings(transient=2000.0, window=1500.0, seed=3, pushes=8)


def model(law="linearized", a=0.08):
    return Model(Chain(3), law_of(law, a))


def states(count, seed=5):
    return sampled_states(3, count, (-1.5, 1.5), (0.0, 0.2), seed)


@pytest.fixture(scope="module")
def search():
    """The attractors of the linearized law at a = 0.08, found from a few states."""
    found = Search(model(), SETTINGS)
    found.labels([model().begin(state) for state in states(40)])
    return found


def test_labels_hold_for_whole_runs(search):
    """What is decided after some hundred time units is what a run of 8000 ends in."""
    chosen = states(60, seed=11)
    labels, times = label(search.model, search.attractors, [search.model.begin(state) for state in chosen], 20000.0)
    assert (labels >= 0).all()
    assert np.median(times) < 500.0
    reached = set()
    for state, index in zip(chosen, labels, strict=True):
        run = simulate("linearized", 0.08, state, transient=6000.0, window=2000.0, events="none", lyapunov_exponents=0)
        expected = search.attractors[index].motion.mean_distance
        assert run.mean_distance == pytest.approx(expected, abs=2e-4)
        reached.add(index)
    assert len(reached) >= 2


def test_mirrored_states_reach_mirrored_attractors():
    """Beyond the loss of synchrony, at a = 0.1, there is a mirror pair."""
    found = Search(model(a=0.1), SETTINGS)
    starts = [found.model.begin(state) for state in states(30)]
    labels = found.labels(starts)
    partners = np.array([attractor.partner for attractor in found.attractors])
    assert (partners[partners] == np.arange(len(partners))).all()
    assert {ASYMMETRIC, SYMMETRIC} <= {attractor.symmetry for attractor in found.attractors}
    mirrored, _ = label(found.model, found.attractors, [start.mirrored() for start in starts], 20000.0)
    assert (mirrored == partners[labels]).all()
    assert len(set(labels)) >= 3


def test_an_unstable_motion_is_no_attractor():
    """A symmetric state stays symmetric for ever, though the synchronized motion is unstable at a = 0.1."""
    found = Search(model(a=0.1), SETTINGS)
    symmetric = found.model.begin(InitialState("symmetric", (-0.9, -0.95, -0.9), (0.1, 0.1, 0.1)))
    assert measure(found.model, symmetric, 2000.0, 1000.0, MOTION).mean_distance == 0.0
    assert visit(found.model, symmetric, 2000.0, 1000.0).settled(1e-6, 1e-3)
    index = found.reach(symmetric)
    assert found.attractors[index].symmetry == ASYMMETRIC
    assert found.attractors[index].motion.mean_distance == pytest.approx(0.0314, abs=2e-4)
    stable = Search(model(a=0.08), SETTINGS)
    index = stable.reach(symmetric)
    assert stable.attractors[index].symmetry == SYNCHRONIZED


def test_pushes_from_within_the_radius_come_back(search):
    """With other random numbers than those that the radius was set by."""
    generator = np.random.default_rng(99)
    for index, attractor in enumerate(search.attractors):
        narrow = [dataclasses.replace(item, radius=item.radius / 10) for item in search.attractors]
        starts = []
        for k in generator.integers(len(attractor.motion.returns), size=30):
            position, velocity = np.split(attractor.motion.returns[k], 2)
            change = generator.uniform(-attractor.radius, attractor.radius, 6)
            moving = np.abs(velocity) > 1e-12
            pushed = np.where(moving, np.maximum(velocity + change[3:], 0.0), 0.0)
            starts.append(Instant(position + change[:3], pushed, ~moving))
        labels, _ = label(search.model, narrow, starts, 50000.0)
        assert (labels == index).all()


def test_a_motion_lies_on_its_own_attractor_only(search):
    for index, attractor in enumerate(search.attractors):
        again = visit(search.model, attractor.motion.instant(), 500.0, 1000.0)
        others = [other.motion for k, other in enumerate(search.attractors) if k not in (index, attractor.partner)]
        assert lies_on(again, attractor.motion, 1e-3, 1e-6)
        assert search.reach(again.instant()) in (index, attractor.partner)
        assert not any(lies_on(again, other, 1e-3, 1e-6) for other in others)


def test_a_closed_orbit_in_the_midst_of_chaos_is_told_from_it():
    """Nonlinear law, a = 0.2075: `minus` ends on an orbit of period 11 returns, most neighbours in chaos around it."""
    found = Search(model("nonlinear", 0.2075), dataclasses.replace(SETTINGS, transient=3000.0, window=3000.0))
    starts = [found.model.begin(state) for state in (*states(30), PAPER_STATES["minus"], PAPER_STATES["plus"])]
    labels = found.labels(starts)
    means = [attractor.motion.mean_distance for attractor in found.attractors]
    for initial, index in (("minus", labels[-2]), ("plus", labels[-1])):
        run = simulate("nonlinear", 0.2075, initial, transient=20000.0, window=4000.0, lyapunov_exponents=0)
        expected = means[index]
        assert run.mean_distance == pytest.approx(expected, abs=max(1e-3, 4 * run.mean_distance_error))
    assert labels[-2] != labels[-1]


@pytest.mark.parametrize("v", [0.001, 5.0])
def test_the_linearized_law_is_the_same_at_any_driver_velocity(v):
    """All positions and velocities are in proportion to v."""
    reference = Search(model(a=0.05), SETTINGS)
    motion = MotionSettings(synchronization_threshold=1e-6 * v / 0.1)
    scaled = Search(Model(Chain(3), law_of("linearized", 0.05), v), SETTINGS, motion)
    starts = [reference.model.begin(state) for state in states(25)]
    factor = v / 0.1
    others = [Instant(factor * start.position, factor * start.velocity, start.stuck) for start in starts]
    first, second = reference.labels(starts), scaled.labels(others)
    assert len(reference.attractors) == len(scaled.attractors) >= 2
    assert (first == second).mean() > 0.95


def test_nothing_is_reached_where_nothing_ever_stops():
    """Without weakening of friction, near uniform sliding, no block ever stops."""
    found = Search(model(a=0.0), SETTINGS)
    sliding = InitialState("sliding", (-0.83, -0.66, -0.84), (0.1, 0.1, 0.1))
    assert found.labels([found.model.begin(sliding)]).tolist() == [-1]
    assert found.attractors == []


@pytest.mark.parametrize(
    ("spacing", "symmetric", "drifts", "windows", "transients", "found"),
    [
        (1e-7, False, [0.0], [1], [1], True),
        # A set that is no closed orbit has to fill: its own mirror image soon, any other in the longest window.
        (0.01, True, [0.0] * 3, [1, 2, 4], [1, 1, 1], True),
        (0.01, False, [0.0] * 5, [1, 2, 4, 8, 16], [1] * 5, True),
        (0.01, True, [1.0, 1.0, 0.0], [1, 2, 4], [1, 2, 4], True),
        # What has not settled has twice the time, and is let go if it drifts by more than ten resolutions.
        (1e-7, False, [2e-5, 0.0], [1, 1], [1, 2], True),
        (1e-7, False, [9e-3] * 5, [1] * 5, [1, 2, 4, 8, 16], True),
        (1e-7, False, [1.1e-2] * 5, [1] * 5, [1, 2, 4, 8, 16], False),
        (1e-7, False, [1.0, None], [1, 1], [1, 2], False),
    ],
)
def test_a_motion_is_given_time_to_settle(monkeypatch, spacing, symmetric, drifts, windows, transients, found):
    returns, asked = np.array([[1.0, 0.0, 0.0, 0.0, 0.1, 0.1]]), []

    def scripted(of_model, start, transient, window):
        asked.append((transient / SETTINGS.transient, window / SETTINGS.window))
        drift = drifts[len(asked) - 1]
        return None if drift is None else Returns(returns, returns if symmetric else -returns, spacing, drift)

    monkeypatch.setattr(attractors, "visit", scripted)
    settled = Search(model(), SETTINGS)._settle(instant_of(returns[0]))
    assert (settled is not None) == found
    assert asked == list(zip(transients, windows, strict=True))


CLOSED, WIDE = 1e-7, 0.01
ONE, OTHER = np.array([[1.0, 0.0, 0.0, 0.0, 0.1, 0.1]]), np.array([[2.0, 0.0, 0.0, 0.0, 0.1, 0.1]])


@pytest.fixture
def scripted(monkeypatch):
    """Return how a motion is added: what it is measured to be, where it is after a while, and the radii that are found.

    What is asked for is kept in `asked`, transients and windows in those of the settings.
    """
    asked = []

    def add(measured, lasting, radii, found_model=None, mirror=OTHER, spacing=CLOSED):
        measured, radii = list(measured), list(radii)

        def measure(of_model, start, transient, window, motion):
            asked.append(("measure", transient / SETTINGS.transient, window / SETTINGS.window))
            return measured.pop(0)

        def visit(of_model, start, transient, window):
            asked.append(("visit", transient / SETTINGS.transient, window / SETTINGS.window))
            return lasting

        def captured(of_model, known, index, least, tolerance, settings):
            asked.append(("captured", index, least))
            return radii.pop(0)

        for name, item in (("measure", measure), ("visit", visit), ("captured", captured)):
            monkeypatch.setattr(attractors, name, item)
        monkeypatch.setattr(attractors, "bounded", lambda of_model, known, tolerance: list(known))
        monkeypatch.setattr(attractors, "midst", lambda known, index, tolerance: [])
        monkeypatch.setattr(
            attractors, "spread", lambda of_model, motion, settings: dataclasses.replace(motion, returns=ONE)
        )
        search = Search(found_model or model(), SETTINGS)
        added = search._add(Returns(ONE, mirror, spacing, 0.0))
        assert not measured
        assert not radii
        assert added == bool(search.attractors)
        return search.attractors, asked

    return add


def motion(mean_distance=0.1, **told):
    return stand_in(ASYMMETRIC, mean_distance, 0, returns=ONE, mirror_returns=OTHER, **told).motion


def test_a_motion_is_added_with_its_mirror_image(scripted):
    pair, asked = scripted([motion()], None, [0.02])
    assert [(item.symmetry, item.partner, item.radius) for item in pair] == [
        (ASYMMETRIC, 1, 0.02),
        (ASYMMETRIC, 0, 0.02),
    ]
    assert [item.motion.returns.tolist() for item in pair] == [ONE.tolist(), OTHER.tolist()]
    assert asked == [("measure", 1, 1), ("captured", 0, attractors.SMALLEST_RADIUS)]
    # Within the resolution of its mirror image it is its own.
    (own,), _ = scripted([motion()], None, [0.02], mirror=ONE + 9e-4)
    assert (own.symmetry, own.partner) == (SYMMETRIC, 0)
    assert own.motion.returns.tolist() == [*ONE.tolist(), *OTHER.tolist()]
    (still,), _ = scripted([motion(9e-7)], None, [0.02])
    assert (still.symmetry, still.partner) == (SYNCHRONIZED, 0)
    unequal = Model(Chain(3, threshold=(1.0, 1.0, 0.9)), law_of("linearized", 0.08))
    (alone,), _ = scripted([motion(9e-7)], None, [0.02], found_model=unequal, mirror=ONE[:0])
    assert (alone.symmetry, alone.partner) == (ASYMMETRIC, 0)


def test_chaos_has_to_last(scripted):
    chaos = motion(kind=CHAOTIC)
    closed, open_still = (Returns(OTHER, ONE, spacing, 0.0) for spacing in (CLOSED, WIDE))
    (first, _), asked = scripted([chaos], open_still, [0.02], spacing=WIDE)
    assert first.motion is chaos
    assert asked == [("measure", 1, 4), ("visit", 33, 1), ("captured", 0, attractors.SMALLEST_RADIUS)]
    orbit = motion()
    (first, _), _ = scripted([chaos, orbit], closed, [0.02], spacing=WIDE)
    assert first.motion is orbit
    assert scripted([chaos], None, [], spacing=WIDE)[0] == []
    # A closed orbit is none, and needs not last; what cannot be measured is nothing.
    assert len(scripted([chaos], None, [0.02])[0]) == 2
    assert scripted([None], None, [])[0] == []


def test_what_attracts_as_a_whole_is_a_slow_set(scripted):
    smallest, tiny = attractors.SMALLEST_RADIUS, attractors.TINY_RADIUS
    (slow,), asked = scripted([motion()], None, [0.0, 0.02])
    assert (slow.slow, slow.symmetry, slow.partner, slow.motion.returns.tolist()) == (True, SYMMETRIC, 0, ONE.tolist())
    assert asked[1:] == [("captured", 0, smallest)] * 2
    # A closed orbit may attract from one side only; next to synchrony what does not attract is unstable.
    pair, asked = scripted([motion()], None, [0.0, 0.0, 1e-7])
    assert (len(pair), asked[-1]) == (2, ("captured", 0, tiny))
    assert scripted([motion()], None, [0.0, 0.0], spacing=WIDE)[0] == []
    assert scripted([motion(9.9e-3)], None, [0.0])[0] == []
    assert len(scripted([motion(1.01e-2)], None, [0.0, 0.02])[0]) == 1


@pytest.fixture
def told_search(monkeypatch):
    """A search that knows a mirror pair and a slow set, and whose trajectories reach what is told."""
    search = Search(model(), SETTINGS)
    pair = [stand_in(ASYMMETRIC, 0.1, partner, returns=place, radius=0.01) for partner, place in ((1, ONE), (0, OTHER))]
    search.attractors = [*pair, stand_in(SYMMETRIC, 0.2, 2, returns=3.0 * ONE, slow=True, radius=0.01)]
    search.told, search.followed = [], []

    def reach(start):
        search.followed.append(start)
        answer = search.told.pop(0)
        if answer == "new":
            search.attractors = [*search.attractors, search.attractors[2]]
        return answer

    monkeypatch.setattr(search, "reach", reach, raising=False)
    return search


@pytest.mark.parametrize(
    ("place", "spacing", "expected"),
    [(ONE, CLOSED, 0), (OTHER + 5e-4, CLOSED, 1), (3.0 * ONE, CLOSED, 2), (5.0 * ONE, WIDE, -1)],
)
def test_what_a_state_reaches(told_search, monkeypatch, place, spacing, expected):
    sizes = []
    monkeypatch.setattr(attractors, "pushed", lambda start, size, generator: sizes.append(size) or start)
    monkeypatch.setattr(told_search, "_settle", lambda start: Returns(place, -place, spacing, 0.0))
    monkeypatch.setattr(told_search, "_add", lambda found: False)
    assert Search.reach(told_search, None) == expected
    # Off a motion that is none it is pushed twice, by a tenth of the resolution.
    assert sizes == pytest.approx([1e-4, 1e-4] if expected < 0 else [])
    monkeypatch.setattr(told_search, "_settle", lambda start: None)
    assert Search.reach(told_search, None) == -1


def test_states_are_followed_until_something_is_found(told_search):
    told_search.told = [-1, 0, "new", -1, -1, -1, 0]
    assert told_search._discover("abcd")
    assert (told_search.followed, told_search.vain) == (["a", "b", "c"], 2)
    # No more than three at a time, and six in all, in vain.
    assert not told_search._discover("efgh")
    assert (told_search.followed[3:], told_search.vain) == (["e", "f", "g"], 5)
    assert not told_search._discover("ij")
    assert (told_search.followed[6:], told_search.vain) == (["i"], 6)


def test_labels_are_verified_much_closer_to_the_attractors(told_search, monkeypatch):
    narrow = []

    def label(of_model, known, starts, time_limit):
        narrow.append([item.radius for item in known])
        return np.array([0, 2, 1, 0, 2]), None

    monkeypatch.setattr(attractors, "label", label)
    labels = np.array([0, 1, 1, -1, 2])
    for answer in (1, -1):
        told_search.told = [answer]
        assert told_search._verified("abcde", labels)
    assert told_search.followed == ["b", "b"]
    assert narrow[0] == pytest.approx([0.001, 0.001, 0.001])
    # One that settles elsewhere halves the radius of what it was ascribed to, and of its mirror image.
    told_search.told = [2]
    assert not told_search._verified("abcde", labels)
    assert [item.radius for item in told_search.attractors] == [0.005, 0.005, 0.01]


def test_states_that_are_ascribed_to_chaos_are_followed(told_search):
    chaos = stand_in(SYMMETRIC, 0.2, 2, kind=CHAOTIC)
    told_search.attractors[1:] = [chaos, dataclasses.replace(chaos, slow=True)]
    told_search.told = [1] * 6
    assert told_search._single("abcdefghij", np.array([1, 0, 1, 1, 1, 2, 1, 1, 1, 1]))
    assert told_search.followed == list("acdegh")
    told_search.told = ["new"]
    assert not told_search._single("ab", np.array([0, 1]))


def test_samples_and_intervals():
    position, velocity = sample_states(4, 500, (-1.5, 1.5), (0.0, 0.2), 7)
    assert position.shape == velocity.shape == (500, 4)
    assert position.min() >= -1.5
    assert velocity.max() <= 0.2
    assert abs(position.mean()) < 0.1
    shorter, _ = sample_states(4, 20, (-1.5, 1.5), (0.0, 0.2), 7)
    assert (shorter == position[:20]).all()
    # Wilson's formula by hand, z = 1.959964.
    fraction, low, high = fraction_interval(9, 10)
    z = 1.959963984540054
    centre = (0.9 + z * z / 20) / (1 + z * z / 10)
    half = z / (1 + z * z / 10) * np.sqrt(0.9 * 0.1 / 10 + z * z / 400)
    assert (fraction, low, high) == pytest.approx((0.9, centre - half, centre + half))
    assert np.isnan(fraction_interval(0, 0)).all()


def test_weak_chaos_is_told_from_a_torus():
    """λ1 is 0.0019 at a = 0.1325: in the usual window its error hides it, and the motion looks like one on a torus."""
    weak = model(a=0.1325)
    steady = measure(weak, weak.begin(PAPER_STATES["minus"]), 20_000.0, 3000.0, MOTION)
    run = simulate("linearized", 0.1325, "plus", transient=100_000, window=60_000, batches=12)
    assert steady.kind == CHAOTIC
    assert run.lyapunov_exponent[0] > 4.0 * run.lyapunov_error[0]
    assert steady.exponent[0] == pytest.approx(run.lyapunov_exponent[0], abs=6e-4)
    assert abs(steady.mean_distance - run.mean_distance) < 2e-4
    torus = model(a=0.05)
    steady = measure(torus, torus.begin(PAPER_STATES["plus"]), 20_000.0, 3000.0, MOTION)
    assert steady.kind == QUASIPERIODIC


@pytest.mark.parametrize(
    "found_model",
    [
        Model(Chain(3), law_of("stribeck", 0.1)),
        Model(Chain(3), FormulaLaw(0.1, "s + (1 - s)/(1 + a*u/(1 - s))**2", s=0.5)),
        Model(Chain(3, coupling=(1.0, 1.3), threshold=(1.0, 0.9, 1.1)), law_of("nonlinear", 0.1)),
        Model(Chain(4, ends="ring", pulling=1.5), law_of("exponential", 0.1)),
    ],
    ids=["stribeck", "formula", "asymmetric", "ring"],
)
def test_attractors_of_any_model_are_what_runs_end_in(found_model):
    """Whole runs from drawn states have the mean distance of the attractor that each is said to reach."""
    settings = dataclasses.replace(SETTINGS, samples=12)
    given = InitialState("given", (-0.9,) * found_model.blocks, (0.1,) * found_model.blocks)
    reached, labels = find_attractors(found_model, settings, starts=[given])
    assert labels.shape == (13,)
    assert len(reached) >= 1
    assert (labels >= 0).sum() >= 10
    if not found_model.chain.is_mirror_symmetric:
        assert {(item.symmetry, item.partner) for item in reached} == {(ASYMMETRIC, k) for k in range(len(reached))}
    options = Settings(transient=8000.0, window=3000.0, batches=6, events="none", lyapunov_exponents=0)
    drawn = sampled_states(found_model.blocks, 12, settings.position, settings.velocity, settings.seed)
    for state, index in list(zip(drawn, labels, strict=False))[:5]:
        if index >= 0:
            run = simulate(found_model, state, options)
            expected = reached[index].motion
            error = 5.0 * (run.mean_distance_error + expected.mean_distance_error)
            assert run.mean_distance == pytest.approx(expected.mean_distance, abs=1e-3 + error)


def test_synchrony_of_a_long_period_is_synchrony():
    """Strong coupling: the outer blocks move as one, and the middle block repeats after many of their periods only."""
    strong = Model(Chain(3, coupling=2.0), FormulaLaw(0.03, "1/(1 + a*u)**2"))
    reached, _ = find_attractors(strong, dataclasses.replace(SEARCH, samples=10))
    as_one = [item for item in reached if item.symmetry == SYNCHRONIZED]
    assert len(as_one) == 1
    assert as_one[0].motion.section_period == 0
    assert as_one[0].motion.kind == KIND_SYNCHRONIZED
