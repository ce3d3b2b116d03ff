"""Attractors: labels agree with full runs, unstable motions are rejected, and mirror images have mirrored labels."""

import dataclasses
from itertools import pairwise

import numpy as np
import pytest
from scipy.stats import binomtest

from burridge_knopoff import Chain, ChainState, FormulaLaw, InitialState, Model, Settings, Symmetry, simulate
from burridge_knopoff.attractors import search as search_module
from burridge_knopoff.attractors.capture_radius import Capture
from burridge_knopoff.attractors.labels import label, label_arrays
from burridge_knopoff.attractors.lifetime import lifetimes
from burridge_knopoff.attractors.search import Search, find_attractors
from burridge_knopoff.attractors.settings import SEARCH, SearchSettings
from burridge_knopoff.model.initial import PAPER_STATES
from burridge_knopoff.model.sampling import fraction_interval, sample_initial_states, sample_states
from burridge_knopoff.motion.classification import Classifier
from burridge_knopoff.motion.kind import MotionKind
from burridge_knopoff.motion.observables import is_on_attractor
from burridge_knopoff.motion.section_returns import visit
from burridge_knopoff.motion.settings import MOTION, MotionSettings
from tests.conftest import quick_first

SYNCHRONIZED, SYMMETRIC, ASYMMETRIC = Symmetry
SETTINGS = SearchSettings(transient=2000.0, window=1500.0, seed=3, perturbations=8)


def model(law="linearized", a=0.08):
    return Model(law, a=a)


def states(count, seed=5):
    return sample_initial_states(3, count, (-1.5, 1.5), (0.0, 0.2), seed)


@pytest.fixture(scope="module")
def search():
    """The attractors of the linearized law at a = 0.08, found from a few states."""
    whole = Search(model(), SETTINGS)
    whole.labels([model().begin(state) for state in states(40)])
    return whole


@pytest.mark.slow
def test_labels_hold_for_whole_runs(search):
    """A label after some hundred time units is that of the motion in which a run of 8000 ends."""
    chosen = states(60, seed=11)
    labels, times = label(search.model, search.attractors, [search.model.begin(state) for state in chosen], 20000.0)
    assert (labels >= 0).all()
    assert np.median(times) < 500.0
    reached = set()
    for state, index in zip(chosen, labels, strict=True):
        run = simulate(
            Model("linearized", a=0.08), state, transient=6000.0, window=2000.0, events="none", lyapunov_exponents=0
        )
        expected = search.attractors[index].motion.mean_distance
        assert run.mean_distance == pytest.approx(expected, abs=2e-4)
        reached.add(index)
    assert len(reached) >= 2


def test_a_discovery_is_compared_with_undecided_states_only(monkeypatch):
    """No state is compared twice with an attractor that it has not reached, until all labels are made at the end.

    A state that was followed until it settled is decided as well, so that nothing is left to compare with the last one.
    """
    calls = []

    def recorded(model, attractors, position, *rest):
        whole = label_arrays(model, attractors, position, *rest)
        calls.append(([item.motion for item in attractors], len(position), int((whole[0] < 0).sum()), rest[-1]))
        return whole

    monkeypatch.setattr(search_module, "label_arrays", recorded)
    whole = Search(model(), SETTINGS)
    labels = whole.labels([model().begin(state) for state in states(40)], check=False)
    assert len(whole.attractors) >= 3
    quick = [call for call in calls if call[3] == 0.3 * SETTINGS.transient]
    compared = [motion for motions, *_ in quick for motion in motions]
    assert len({*map(id, compared)}) == len(compared)
    followed = [left - count for (_, _, left, _), (_, count, *_) in pairwise(quick)]
    # Each call takes the states that the one before has left, but for the one that led to the next attractor.
    assert quick[0][1] == 39
    assert set(followed) <= {1, 2, 3}
    assert (labels >= 0).all()
    assert (whole.known_labels([model().begin(state) for state in states(40)]) == labels).all()


def test_mirrored_states_reach_mirrored_attractors():
    """Beyond the loss of synchrony, at a = 0.1, there is a mirror pair."""
    whole = Search(model(a=0.1), SETTINGS)
    starts = [whole.model.begin(state) for state in states(30)]
    labels = whole.labels(starts)
    partners = np.array([attractor.partner for attractor in whole.attractors])
    assert (partners[partners] == np.arange(len(partners))).all()
    assert {ASYMMETRIC, SYMMETRIC} <= {attractor.symmetry for attractor in whole.attractors}
    mirrored, _ = label(whole.model, whole.attractors, [start.mirrored() for start in starts], 20000.0)
    assert (mirrored == partners[labels]).all()
    assert len(set(labels)) >= 3


def test_an_unstable_motion_is_not_an_attractor():
    """A symmetric state stays symmetric, although the synchronized motion is unstable at a = 0.1."""
    unstable, stable = (Search(model(a=a), SETTINGS) for a in (0.1, 0.08))
    symmetric = unstable.model.begin(InitialState("symmetric", (-0.9, -0.95, -0.9), (0.1, 0.1, 0.1)))
    assert Classifier(unstable.model, 2000.0, 1000.0, MOTION).measure(symmetric).mean_distance == 0.0
    assert visit(unstable.model, symmetric, 2000.0, 1000.0).is_settled(1e-6, 1e-3)
    index = unstable.reach(symmetric)
    attractor = unstable.attractors[index]
    assert attractor.symmetry == ASYMMETRIC
    assert attractor.motion.mean_distance == pytest.approx(0.0314, abs=2e-4)
    index = stable.reach(symmetric)
    assert stable.attractors[index].symmetry == SYNCHRONIZED


def test_perturbations_within_the_capture_radius_return(search):
    """The random numbers differ from those that determined the radius."""
    generator = np.random.default_rng(99)
    for index, attractor in enumerate(search.attractors):
        narrow = [dataclasses.replace(item, radius=item.radius / 10) for item in search.attractors]
        starts = []
        for k in generator.integers(len(attractor.motion.returns), size=30):
            position, velocity = np.split(attractor.motion.returns[k], 2)
            change = generator.uniform(-attractor.radius, attractor.radius, 6)
            moving = np.abs(velocity) > 1e-12
            pushed = np.where(moving, np.maximum(velocity + change[3:], 0.0), 0.0)
            starts.append(ChainState(position + change[:3], pushed, ~moving))
        labels, _ = label(search.model, narrow, starts, 50000.0)
        assert (labels == index).all()


def test_a_motion_lies_on_its_own_attractor_only(search):
    for index, attractor in enumerate(search.attractors):
        again = visit(search.model, attractor.motion.state(), 500.0, 1000.0)
        motions = [other.motion for k, other in enumerate(search.attractors) if k not in (index, attractor.partner)]
        assert is_on_attractor(again, attractor.motion, 1e-3, 1e-6)
        assert search.reach(again.state()) in (index, attractor.partner)
        assert not any(is_on_attractor(again, other, 1e-3, 1e-6) for other in motions)


@pytest.mark.slow
def test_an_orbit_embedded_in_chaos_is_distinguished_from_it():
    """Nonlinear law, a = 0.2075: `minus` ends on an orbit of 11 returns, most nearby states in the chaos around it."""
    embedded = Search(model("nonlinear", 0.2075), dataclasses.replace(SETTINGS, transient=3000.0, window=3000.0))
    starts = [embedded.model.begin(state) for state in (*states(5), PAPER_STATES["minus"], PAPER_STATES["plus"])]
    labels = embedded.labels(starts)
    means = [attractor.motion.mean_distance for attractor in embedded.attractors]
    for initial, index in (("minus", labels[-2]), ("plus", labels[-1])):
        run = simulate(Model("nonlinear", a=0.2075), initial, transient=20000.0, window=4000.0, lyapunov_exponents=0)
        assert run.mean_distance == pytest.approx(means[index], abs=max(1e-3, 4 * run.mean_distance_error))
    assert labels[-2] != labels[-1]


@pytest.mark.slow
def test_chaos_of_high_dimension_is_an_attractor():
    """Its returns are so far apart that few states are close to one of them; its lifetime is 1.8 million."""
    chain = Chain(4, 1.657, [1.459, 0.817, 0.902, 0.501], [1.036, 1.205, 1.448, 1.439])
    high = Search(Model("carlson_langer", a=0.525, sigma=0.1, chain=chain), SearchSettings(samples=10))
    labels = high.labels(high.starts((), "moving"))
    (chaos,) = high.attractors
    assert chaos.motion.kind == MotionKind.CHAOTIC
    assert chaos.radius == chaos.motion.spacing > Capture().largest
    assert (labels == 0).all()
    (lived,) = lifetimes(high.model, high.attractors, high.settings)
    assert lived.ends == 0


@pytest.mark.parametrize("v", [0.001, 5.0])
def test_the_linearized_law_is_the_same_at_any_driver_velocity(v):
    """All positions and velocities are proportional to v."""
    reference = Search(model(a=0.05), SETTINGS)
    motion = MotionSettings(synchronization_threshold=1e-6 * v / 0.1)
    scaled = Search(Model("linearized", a=0.05, v=v), SETTINGS, motion)
    starts = [reference.model.begin(state) for state in states(25)]
    factor = v / 0.1
    rescaled = [ChainState(factor * start.position, factor * start.velocity, start.stuck) for start in starts]
    first, second = reference.labels(starts), scaled.labels(rescaled)
    assert len(reference.attractors) == len(scaled.attractors) >= 2
    assert (first == second).mean() > 0.95


def test_no_attractor_is_reached_if_no_block_ever_stops():
    """Without weakening of friction, near uniform sliding, no block ever stops."""
    still = Search(model(a=0.0), SETTINGS)
    sliding = InitialState("sliding", (-0.83, -0.66, -0.84), (0.1, 0.1, 0.1))
    assert still.labels([still.model.begin(sliding)]).tolist() == [-1]
    assert still.attractors == []


def test_samples_and_intervals():
    position, velocity = sample_states(4, 500, (-1.5, 1.5), (0.0, 0.2), 7)
    assert position.shape == velocity.shape == (500, 4)
    assert position.min() >= -1.5
    assert velocity.max() <= 0.2
    assert abs(position.mean()) < 0.1
    shorter, _ = sample_states(4, 20, (-1.5, 1.5), (0.0, 0.2), 7)
    assert (shorter == position[:20]).all()
    for hits, count in ((9, 10), (0, 7), (5000, 5000), (1, 3), (1841, 5000)):
        expected = binomtest(hits, count).proportion_ci(0.95, method="wilson")
        assert fraction_interval(hits, count) == pytest.approx((hits / count, expected.low, expected.high), abs=1e-15)
    assert np.isnan(fraction_interval(0, 0)).all()


def test_weak_chaos_is_distinguished_from_a_torus():
    """λ1 is 0.0019 at a = 0.1325: in the usual window its error hides it, and the motion looks like one on a torus."""
    weak = model(a=0.1325)
    begun = weak.begin(PAPER_STATES["minus"])
    run = simulate(Model("linearized", a=0.1325), "plus", transient=100_000, window=60_000, batches=12)
    assert run.lyapunov_exponent[0] > 4.0 * run.lyapunov_error[0]
    # About one run in thirty stays near a weakly repelling orbit for the whole window and is not recognised as chaos.
    motions = [
        Classifier(weak, 20_000.0, 3000.0, MOTION).measure(
            ChainState(begun.position + shift * np.array([1.0, -0.3, 0.4]), begun.velocity, begun.stuck)
        )
        for shift in (2e-12, 3e-12, 4e-12)
    ]
    chaotic = [motion for motion in motions if motion.kind == MotionKind.CHAOTIC]
    assert len(chaotic) >= 2
    assert not any(motion.kind == MotionKind.QUASIPERIODIC for motion in motions)
    for motion in chaotic:
        assert motion.exponent[0] == pytest.approx(run.lyapunov_exponent[0], abs=8e-4)
        assert abs(motion.mean_distance - run.mean_distance) < 2e-4


@pytest.mark.parametrize(("law", "a", "closes"), [("linearized", 0.05, False), ("nonlinear", 0.07, True)])
def test_a_weakly_attracting_orbit_is_distinguished_from_a_torus(law, a, closes):
    """λ2 is -0.0004 at a = 0.07 (nonlinear), which no window of the usual length distinguishes from 0."""
    chosen = model(law, a)
    steady = Classifier(chosen, 3000.0, 12_000.0, MOTION).measure(chosen.begin(PAPER_STATES["plus"]))
    assert abs(steady.exponent[1]) < MOTION.zero_exponent
    assert steady.kind == (MotionKind.PERIODIC if closes else MotionKind.QUASIPERIODIC)
    later = visit(chosen, steady.state(), 300_000.0, 12_000.0)
    assert (later.spacing < 1e-9) == closes


@pytest.mark.slow
def test_orbits_to_which_perturbations_return_quickly_are_not_a_slow_set():
    """Linearized law, a = 0.2125: two mirror pairs, of periods 20 and 40, within 0.005 of each other."""
    chosen = model(a=0.2125)
    attractors, _ = find_attractors(chosen, dataclasses.replace(SEARCH, samples=60))
    pairs = [item for item in attractors if item.motion.section_period in (20, 40)]
    assert [item.symmetry for item in pairs] == [ASYMMETRIC] * 4
    assert not any(item.slow for item in attractors)
    for item in pairs:
        later = visit(chosen, item.motion.state(), 50_000.0, 3000.0)
        assert later.has_periodic_spacing(1e-9)
        assert is_on_attractor(later, item.motion, 1e-9, 1e-9)
        assert not any(is_on_attractor(later, other.motion, 1e-5, 1e-5) for other in pairs if other is not item)


@pytest.mark.parametrize(
    "found_model",
    quick_first(
        [
            Model("nonlinear", a=0.1, coupling=(1.0, 1.3), threshold=(1.0, 0.9, 1.1)),
            Model("stribeck", a=0.1),
            Model(FormulaLaw("s + (1 - s)/(1 + a*u/(1 - s))**2", a=0.1, s=0.5)),
            Model("exponential", a=0.1, blocks=4, ends="ring", pulling=1.5),
        ],
        1,
    ),
    ids=["asymmetric", "stribeck", "formula", "ring"],
)
def test_runs_of_any_model_end_on_its_attractors(found_model):
    settings = dataclasses.replace(SETTINGS, samples=12)
    initial = InitialState("given", (-0.9,) * found_model.blocks, (0.1,) * found_model.blocks)
    reached, labels = find_attractors(found_model, settings, starts=[initial])
    assert labels.shape == (13,)
    assert len(reached) >= 1
    assert (labels >= 0).sum() >= 10
    if not found_model.chain.is_mirror_symmetric:
        assert {(item.symmetry, item.partner) for item in reached} == {(ASYMMETRIC, k) for k in range(len(reached))}
    options = Settings(transient=8000.0, window=3000.0, batches=6, events="none", lyapunov_exponents=0)
    drawn = sample_initial_states(found_model.blocks, 12, settings.position, settings.velocity, settings.seed)
    for state, index in list(zip(drawn, labels, strict=False))[:5]:
        if index >= 0:
            run = simulate(found_model, initial=state, settings=options)
            expected = reached[index].motion
            error = 5.0 * (run.mean_distance_error + expected.mean_distance_error)
            assert run.mean_distance == pytest.approx(expected.mean_distance, abs=1e-3 + error)


@pytest.mark.slow
@pytest.mark.parametrize(("coupling", "section_period"), [(1.5, 0), (2.0, 104)])
def test_synchrony_of_a_long_period_is_synchrony(coupling, section_period):
    """Strong coupling: the end blocks move as one, and the middle block repeats only after many of their periods.

    Section points do not show the longer period; a longer window shows the other one.
    """
    strong = Model(FormulaLaw("1/(1 + a*u)**2", a=0.03), coupling=coupling)
    reached, _ = find_attractors(strong, dataclasses.replace(SEARCH, samples=10))
    (as_one,) = [item.motion for item in reached if item.symmetry == SYNCHRONIZED]
    assert as_one.section_period == section_period
    assert as_one.kind == MotionKind.SYNCHRONIZED
