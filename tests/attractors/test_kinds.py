"""Kinds of attractors do not depend on the window, and motion that still drifts is not an attractor."""

from dataclasses import replace

import numpy as np
import pytest

from burridge_knopoff import Chain, InitialState, Model, MotionKind, SearchSettings, find_attractors, simulate
from burridge_knopoff.attractors.search import Search
from burridge_knopoff.attractors.settings import SEARCH
from burridge_knopoff.model.initial import PAPER_STATES
from burridge_knopoff.motion.kind import motion_of_run
from burridge_knopoff.motion.settings import MOTION
from burridge_knopoff.periodic_orbits.symmetry import Symmetry
from tests.conftest import quick_first
from tests.flows import weakly_repelling


@pytest.mark.parametrize(
    ("law", "a", "kind", "points", "period"),
    quick_first(
        [
            ("linearized", 0.0775, "QUASIPERIODIC", 0, 2424.83),
            ("linearized", 0.08, "PERIODIC", 48, 157.245),
            ("nonlinear", 0.17, "PERIODIC", 134, 794.862),
            ("nonlinear", 0.08, "QUASIPERIODIC", 0, 28_991.98),
            ("linearized", 0.0275, "QUASIPERIODIC", 0, 3935.21),
            ("linearized", 0.0575, "QUASIPERIODIC", 0, 2447.61),
        ],
        3,
    ),
)
def test_motion_locked_to_a_period_longer_than_any_run_is_not_periodic(law, a, kind, points, period):
    search = Search(Model(law, a=a), growth_window=0.0)
    index = search.reach(search.model.begin(PAPER_STATES["plus"]))
    motion = search.attractors[index].motion
    assert (motion.kind.name, motion.section_period) == (kind, points)
    assert motion.period == pytest.approx(period, rel=1e-5)
    assert (np.diff(motion.exponent) <= 0.0).all()


@pytest.mark.slow
@pytest.mark.parametrize(
    ("law", "a", "coupling", "blocks", "mean"),
    [
        ("linearized", 0.2, 1e-6, 2, None),
        ("nonlinear", 0.3, 1e-5, 2, 0.284064),
        ("nonlinear", 0.3, 1e-4, 2, 0.284029),
        ("nonlinear", 0.3, 1e-5, 3, None),
    ],
)
def test_motion_that_still_drifts_is_not_an_attractor(law, a, coupling, blocks, mean):
    """Blocks on weak springs reach antiphase in a time of about 1/coupling, or are undetermined."""
    weak = Model(law, a=a, blocks=blocks, coupling=coupling, pulling=1.0)
    attractors, labels = find_attractors(weak, SearchSettings(samples=6))
    listed = [item.motion.mean_distance for item in attractors]
    assert listed == ([] if mean is None else [pytest.approx(mean, abs=3e-6)])
    assert set(labels.tolist()) <= {-1, 0}


def test_a_state_on_an_unstable_orbit_reaches_the_chaos_around_it():
    orbit = weakly_repelling()
    position = tuple(orbit.reference.position + orbit.model.sliding_offset)
    start = InitialState("near", position, tuple(orbit.reference.velocity))
    attractors, labels = find_attractors(orbit.model, SearchSettings(samples=0), starts=[start])
    assert [item.motion.kind.name for item in attractors] == ["CHAOTIC", "CHAOTIC"]
    assert labels.tolist() in ([0], [1])


@pytest.mark.slow
def test_chaos_with_end_blocks_that_move_as_one_is_a_kind_of_its_own():
    strong = Model("nonlinear", a=1.0, coupling=8.0, pulling=(1.0, 4.0, 1.0), v=0.5)
    run = simulate(strong, initial="minus", transient=3000.0, window=3000.0)
    assert (run.mean_distance, run.lyapunov_exponent[0] > 0.1) == (0.0, True)
    assert motion_of_run(vars(run), True, MOTION).kind == MotionKind.SYNCHRONIZED_CHAOS
    (attractor,), labels = find_attractors(strong, SearchSettings(samples=4))
    assert (attractor.motion.kind, attractor.symmetry) == (MotionKind.SYNCHRONIZED_CHAOS, Symmetry.SYNCHRONIZED)
    assert (labels == 0).all()
    assert np.isfinite(attractor.radius)
    assert SEARCH.resolution > attractor.motion.mean_distance


@pytest.mark.slow
@pytest.mark.parametrize("law", ["linearized", "nonlinear"])
@pytest.mark.parametrize(
    ("chain", "a", "settings"),
    [
        (Chain(5), 0.02, SearchSettings(samples=4, transient=1000, window=1000, time_limit=5000, perturbations=4)),
        (Chain(3, coupling=1.5), 0.115, SearchSettings(samples=4, transient=1000, window=1000)),
    ],
)
def test_synchrony_on_a_torus_is_synchrony(chain, a, settings, law):
    """Runs and attractors have one kind, whether the torus is locked or not, and whatever the period."""
    model = Model(law, a=a, chain=chain)
    attractors, _ = find_attractors(model, settings)
    (synchrony,) = [item for item in attractors if item.symmetry == Symmetry.SYNCHRONIZED]
    assert synchrony.motion.kind == MotionKind.SYNCHRONIZED
    assert not synchrony.motion.period <= 400.0
    # A state off the symmetric subspace comes back; its exponents are those of a torus, or nearly.
    state = synchrony.motion.state()
    generator = np.random.default_rng(1)
    away = replace(state, position=state.position + 1e-4 * generator.uniform(-1.0, 1.0, chain.blocks))
    run = simulate(model, initial=away, transient=4000.0, window=7000.0)
    assert run.mean_distance < 1e-6
    assert run.kind == MotionKind.SYNCHRONIZED
    assert abs(run.lyapunov_exponent[1]) < 1e-3
