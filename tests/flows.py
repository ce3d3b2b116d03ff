"""Runs of the kernel, their events as (time, block from 1, 0 stop | 1 start), and starts that many tests use."""

import numpy as np

from burridge_knopoff import Model, Symmetry, find_periodic_orbit, multipliers
from burridge_knopoff.kernel._core import Exponents
from burridge_knopoff.model.initial import InitialState
from burridge_knopoff.model.model import ChainState
from burridge_knopoff.running.runner import Runner
from burridge_knopoff.running.status import Status

SYMMETRIC = InitialState("symmetric", (-0.99, -0.993, -0.99), (0.1, 0.101, 0.1))


def wave(blocks, amplitude=0.1):
    """Return a state in which no two blocks are alike."""
    return InitialState("wave", tuple(-0.9 + amplitude * np.sin(1.0 + 2.0 * np.arange(blocks))), (0.1,) * blocks)


def weakly_repelling():
    """Return a periodic orbit embedded in weak chaos, with multiplier -1.054 over a period of 75."""
    model = Model("linearized", a=0.1325)
    position = np.array([-0.86490860, -0.66580172, -0.83500781]) - model.sliding_offset
    near = ChainState(position, np.array([0.23419014, 0.16806155, 0.21475228]), np.zeros(3, dtype=bool))
    orbit = find_periodic_orbit(model, near, 74.6583856, Symmetry.ASYMMETRIC)
    assert (orbit.stop_counts, round(multipliers(orbit).whole[0].real, 4)) == ((13, 13, 6), -1.0536)
    return orbit


def listed(run):
    """Return the events of a trajectory."""
    return list(zip(run.event_time.tolist(), run.event_block.tolist(), run.event_kind.tolist(), strict=True))


def check_events(events, expected, tolerance):
    """Require the same stops and starts in the same order, at the same times within the tolerance."""
    assert [event[1:] for event in events] == [event[1:] for event in expected]
    error = max((abs(event[0] - other[0]) for event, other in zip(events, expected, strict=True)), default=0.0)
    assert error <= tolerance, float(error)


def carry(model, start, end, perturbations=None, solver="series"):
    """Return the solver at time `end`, and the events until then."""
    runner = Runner(model, solver, keep_events=True, perturbations=perturbations)
    runner.begin(start)
    assert runner.run(end) == Status.COMPLETED
    time, block, kind = runner.events()
    return runner, list(zip(time.tolist(), (block + 1).tolist(), kind.tolist(), strict=True))


def later(model, start, end):
    """Return the instant that a state reaches at time `end`."""
    reached = Runner(model).state_after(start, end)
    assert reached is not None
    return reached


def directions(start):
    """Return all perturbations that the state allows, as columns: the velocity of a stuck block cannot be perturbed."""
    return np.diag(np.concatenate([np.ones(len(start.stuck)), ~start.stuck]))


def _by_block(events, blocks):
    """Return the kinds of event of each block in their order: blocks that stop together may come in either order."""
    return [[kind for _, block, kind in events if block == i + 1] for i in range(blocks)]


def differences(model, start, end, step):
    """Return the tangent map from central differences, extrapolated once, and how far step and half a step differ.

    None where a perturbed run does not have the same events: the flow is not smooth between the two.
    """
    blocks = model.blocks
    expected = _by_block(carry(model, start, end)[1], blocks)
    estimates = []
    for size in (step, step / 2):
        columns = []
        for direction in directions(start).T:
            ends = []
            for side in (size, -size):
                shifted = start.vector() + side * direction
                if (start.velocity * shifted[blocks:] < 0.0).any():
                    return None
                runner, events = carry(model, ChainState(shifted[:blocks], shifted[blocks:], start.stuck), end)
                if _by_block(events, blocks) != expected:
                    return None
                ends.append(runner.state().vector())
            columns.append((ends[0] - ends[1]) / (2.0 * size))
        estimates.append(np.array(columns).T)
    coarse, fine = estimates
    return (4.0 * fine - coarse) / 3.0, np.abs(fine - coarse).max()


def growth_from(model, start, end, vectors):
    """Return the kernel's exponents after a run from `start` to `end`, in a single batch from τ = 0."""
    exponents = Exponents(model.blocks, vectors, 0.0, np.array([0.0, end]))
    runner = Runner(model, exponents=exponents)
    runner.begin(start)
    assert runner.run(end) == Status.COMPLETED
    return exponents.results()
