"""Observables of steady motion, of whole runs and of hand-made motions."""

from dataclasses import replace

import numpy as np
import pytest

from burridge_knopoff import (
    Model,
    MotionKind,
    SearchSettings,
    Settings,
    find_attractors,
    simulate,
)
from burridge_knopoff.model.initial import PAPER_STATES
from burridge_knopoff.model.sampling import sample_initial_states
from burridge_knopoff.motion.classification import Classifier
from burridge_knopoff.motion.observables import is_on_attractor
from burridge_knopoff.motion.section_returns import visit
from burridge_knopoff.motion.settings import MOTION
from tests.motion.stand_in import ROWS, nearest, section, stand_in

#: Some of them occur repeatedly.
ROUND = np.tile(ROWS[:5], (8, 1))


def model(threshold=1.0):
    return Model("linearized", a=0.08, threshold=threshold)


@pytest.mark.parametrize("threshold", [1.0, (1.0, 1.0, 0.9)])
def test_returns_are_the_stops_of_the_first_block(threshold):
    chain = model(threshold)
    start = chain.begin(PAPER_STATES["plus"])
    run = simulate(
        chain, initial=PAPER_STATES["plus"], settings=Settings(transient=500.0, window=300.0, batches=6, events="all")
    )
    visited = visit(chain, start, 500.0, 300.0)
    stops = [(run.event_time >= 500.0) & (run.event_block == block) & (run.event_kind == 0) for block in (1, 2, 3)]
    state = run.event_position - chain.sliding_offset, run.event_velocity
    assert visited.returns == pytest.approx(np.hstack([part[stops[0]] for part in state]), abs=1e-9)
    mirrored = np.hstack([part[stops[2], ::-1] for part in state])[: None if threshold == 1.0 else 0]
    assert visited.mirror_returns == pytest.approx(mirrored, abs=1e-9)
    first, second = np.array_split(visited.returns, 2)
    assert visited.spacing == pytest.approx(np.quantile(nearest(second, second, 1), 0.95))
    ways = [
        np.quantile(nearest(points, reference, 0), 0.95) for points, reference in ((first, second), (second, first))
    ]
    assert visited.drift == pytest.approx(max(ways))
    assert visited.state().vector().tolist() == visited.returns[-1].tolist()

    motion = Classifier(chain, 500.0, 300.0, MOTION).measure(start)
    assert motion.returns == pytest.approx(visited.returns, abs=1e-9)
    assert motion.spacing == pytest.approx(visited.spacing, abs=1e-9)
    assert motion.stop_rate.tolist() == [np.sum(chosen) / 300.0 for chosen in stops]
    assert motion.mean_distance == pytest.approx(run.mean_distance, abs=1e-9)
    assert motion.mean_distance_error == pytest.approx(run.mean_distance_error, abs=1e-9)
    assert motion.exponent.shape == (3,)
    assert motion.state().vector().tolist() == motion.returns[-1].tolist()
    # Too few returns show nothing.
    assert visit(chain, start, 500.0, 20.0) is None
    assert Classifier(chain, 500.0, 20.0, MOTION).measure(start) is None


def test_attractors_whose_end_blocks_never_stop_are_recognized():
    """Of four blocks at a = 0.02 some states reach motion in which only the middle blocks stop."""
    settings = SearchSettings(samples=40)
    chain = Model("linearized", a=0.02, blocks=4)
    attractors, labels = find_attractors(chain, settings)
    assert (labels >= 0).all()
    assert {item.motion.block for item in attractors} == {1, 2}
    box = settings.position, settings.velocity
    drawn = sample_initial_states(4, settings.samples, *box, settings.seed)
    for index in set(labels.tolist()):
        motion, state = attractors[index].motion, drawn[labels.tolist().index(index)]
        run = simulate(chain, initial=state, transient=60_000, window=6000, lyapunov_exponents=0)
        assert run.mean_distance == pytest.approx(motion.mean_distance, abs=2e-4)
        stops = np.bincount(run.event_block[run.event_kind == 0], minlength=5)[1:]
        assert (stops > 0).tolist() == (motion.stop_rate > 0.0).tolist()
        assert np.flatnonzero(stops)[0] == motion.block - 1


def test_mirror_images_of_a_motion():
    motion = stand_in(stop_rate=np.array([0.1, 0.2, 0.3])).motion
    mirrored = motion.mirrored()
    assert mirrored.returns is motion.mirror_returns
    assert mirrored.mirror_returns is motion.returns
    assert mirrored.stop_rate.tolist() == [0.3, 0.2, 0.1]
    whole, both = motion.symmetrized(), [*motion.returns.tolist(), *(-motion.returns).tolist()]
    assert whole.returns.tolist() == whole.mirror_returns.tolist() == both
    assert whole.spacing == pytest.approx(np.quantile(nearest(whole.returns, whole.returns, 1), 0.95))
    alone = replace(motion, mirror_returns=np.zeros((0, 6)))
    assert alone.symmetrized().mirror_returns.shape == (0, 6)


@pytest.mark.parametrize(
    ("found", "kind", "spacing", "own_spacing", "expected"),
    [
        (ROWS + 0.9e-3, MotionKind.PERIODIC, 0.0, 0.0, True),
        (ROWS + 1.1e-3, MotionKind.PERIODIC, 0.0, 0.0, False),
        (ROWS + 0.029, MotionKind.CHAOTIC, 0.01, 0.1, True),  # three spacings of the attractor
        (ROWS + 0.031, MotionKind.CHAOTIC, 0.01, 0.1, False),
        (ROUND, MotionKind.CHAOTIC, 0.01, 0.0, False),  # a periodic orbit is not part of chaos
        (ROUND, MotionKind.CHAOTIC, 1e-7, 0.0, True),  # but it is part of chaos so thin that it looks like an orbit
        (ROWS, MotionKind.CHAOTIC, 0.01, 0.0, True),  # chaos observed for so long that it looks like an orbit
        (ROUND, MotionKind.QUASIPERIODIC, 0.01, 0.0, True),
    ],
)
def test_which_motions_lie_on_an_attractor(found, kind, spacing, own_spacing, expected):
    attractor = stand_in(returns=ROWS, kind=kind, spacing=spacing).motion
    assert is_on_attractor(section(found, ROWS, own_spacing, 0.0), attractor, 1e-3, 1e-6) == expected


def test_a_motion_seen_from_the_other_end_stops_at_the_other_block():
    motion = replace(stand_in().motion, block=1, mirror_block=3)
    assert (motion.mirrored().block, motion.mirrored().mirror_block) == (3, 1)


def test_motions_with_returns_at_other_blocks_differ():
    attractor = stand_in(returns=ROWS).motion
    motion = section(ROWS, ROWS, 0.0, 0.0)
    assert is_on_attractor(motion, attractor, 1e-3, 1e-6)
    assert not is_on_attractor(replace(motion, block=2), attractor, 1e-3, 1e-6)
