"""Attractors as sets of returns with a radius, and which of them a trajectory reaches."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from burridge_knopoff.kernel.clouds import Clouds
from burridge_knopoff.model.model import Instant, Model
from burridge_knopoff.running.together import new_ensemble
from burridge_knopoff.stability.settings import SearchSettings
from burridge_knopoff.stability.steady import Returns, SteadyMotion, instant_of, orbit_length, visit

UNDETERMINED = -1

# Successive returns near an attractor after which a trajectory counts as captured.
CLOSE_RETURNS = 8

# The same near a set that another attractor lies in: long enough for most trajectories to come to that one first.
PATIENT_RETURNS = 2000

SYNCHRONIZED, SYMMETRIC, ASYMMETRIC = 0, 1, 2
SYMMETRIES = {SYNCHRONIZED: "synchronized", SYMMETRIC: "symmetric", ASYMMETRIC: "asymmetric"}


# States that show a slow set, how far they are pushed, in resolutions, and how long they are left to fall back, in
# transients.
PUSHED = 12
PUSHED_BY = 5.0
PUSHED_FOR = 0.3

# Longest orbit, in returns, that has to be gone round.
LONGEST_ORBIT = 100


def close_returns(found: Returns, tolerance: float) -> int:
    """Return how many successive returns have to be close to a motion: twice round it if it is a closed orbit."""
    if not found.closed(tolerance):
        return CLOSE_RETURNS
    return max(CLOSE_RETURNS, 2 * orbit_length(found.returns, 10.0 * tolerance, LONGEST_ORBIT))


@dataclass(frozen=True, eq=False)
class Attractor:
    """A settled motion with what tells it from others.

    symmetry : synchronized (mirror blocks move as one), symmetric (the set is its own mirror image) or asymmetric, as
        all are in a chain that is not its own mirror image
    partner : index, among the attractors of the same a, of its mirror image; its own where that is the same set, or
        where there is none
    radius : distance from its returns within which trajectories are captured
    slow : whether the motion on the set is too slow to settle, so that its returns are those of pushed states
    close_returns : successive returns within the radius after which a trajectory counts as captured
    """

    motion: SteadyMotion
    symmetry: int
    partner: int
    radius: float = np.inf
    slow: bool = False
    close_returns: int = CLOSE_RETURNS


def pushed(start: Instant, size: float, generator: np.random.Generator) -> Instant:
    """Return a state with all positions and all velocities of slipping blocks changed by at most `size` at random."""
    blocks = len(start.position)
    change = generator.uniform(-size, size, 2 * blocks)
    velocity = np.where(start.stuck, 0.0, np.maximum(start.velocity + change[blocks:], 0.0))
    return Instant(start.position + change[:blocks], velocity, start.stuck)


def spread(model: Model, motion: SteadyMotion, settings: SearchSettings) -> SteadyMotion:
    """Return a motion with the returns of trajectories that were pushed off it, and their mirror images, for its own.

    Near a resonance the motion on a torus is locked, or nearly so, to orbits that attract next to nothing. The torus
    itself attracts; pushed states, which fall back on it and drift along, show more of it than a settled one.
    """
    generator = np.random.default_rng(settings.seed)
    clouds = [motion.returns, motion.mirror_returns]
    for k in generator.integers(len(motion.returns), size=PUSHED):
        size = PUSHED_BY * settings.resolution * model.scale
        start = pushed(instant_of(motion.returns[k]), size, generator)
        found = visit(model, start, PUSHED_FOR * settings.transient, settings.window)
        if found is not None:
            clouds += [found.returns, found.mirror_returns]
    return motion.with_returns(np.concatenate(clouds))


def label(
    model: Model, attractors: Sequence[Attractor], starts: Sequence[Instant], time_limit: float
) -> tuple[np.ndarray, np.ndarray]:
    """Return which attractor each state reaches and when that was certain.

    −1 where no attractor is reached by the time limit.
    """
    if not len(attractors) or not len(starts):
        return np.full(len(starts), UNDETERMINED, dtype=np.intc), np.zeros(len(starts))
    return label_together(
        model,
        attractors,
        np.array([start.position for start in starts]),
        np.array([start.velocity for start in starts]),
        np.array([start.stuck for start in starts]),
        time_limit,
    )


def label_together(
    model: Model,
    attractors: Sequence[Attractor],
    position: np.ndarray,
    velocity: np.ndarray,
    stuck: np.ndarray,
    time_limit: float,
) -> tuple[np.ndarray, np.ndarray]:
    """Do the work of `label` for states x_i, U_i' and which blocks stick, each of shape (n, blocks).

    A state has reached an attractor when enough of its successive returns, at the stops of the first block, lie within
    the attractor's radius of one of its returns.
    """
    clouds = Clouds(
        [attractor.motion.returns for attractor in attractors],
        2 * model.blocks,
        [attractor.radius for attractor in attractors],
    )
    returns = [attractor.close_returns for attractor in attractors]
    labels, times = new_ensemble(model).label(position, velocity, stuck.astype(np.intc), clouds, returns, time_limit)
    return labels, times
