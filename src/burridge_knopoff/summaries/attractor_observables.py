"""Observables of a run along an attractor: its points on the section W = 0, and how the velocities oscillate."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from burridge_knopoff.model.model import ChainState, Model
from burridge_knopoff.motion.frequency import leading_frequency, starts_of_blocks
from burridge_knopoff.periodic_orbits.grazing_distances import longest_spacing
from burridge_knopoff.running.section import SUM, Section
from burridge_knopoff.running.settings import Settings
from burridge_knopoff.running.simulation import run
from burridge_knopoff.summaries.correlation import correlation

#: Time for which each attractor is followed.
DURATION = 1000.0

# The velocity is sampled PER_SPACING times in the interval that resolves the motion of the chain. The spectrum uses
# every THINNING-th sample and extends to three times the frequency of the fastest mode.
PER_SPACING, THINNING = 2, 8


@dataclass(frozen=True)
class AttractorObservables:
    """Observables of a run along an attractor.

    section : W' at upward crossings of W = 0, shape (n,)
    velocity_correlation : Pearson correlation of the velocities of the end blocks, NaN if one is constant
    velocity : U' of each block at equidistant times, shape (samples, blocks)
    starts : times of the starts of each block, None for a block that never stops
    """

    section: np.ndarray
    velocity_correlation: float
    velocity: np.ndarray
    starts: Sequence[np.ndarray | None]

    @property
    def velocity_frequency(self) -> np.ndarray:
        """Frequency of the highest peak of the spectrum of U', shape (blocks,); see `leading_frequency`."""
        of_blocks = zip(self.velocity[::THINNING].T, self.starts, strict=True)
        return np.array([leading_frequency(series, DURATION, starts) for series, starts in of_blocks])


def follow_attractor(model: Model, start: ChainState, section: Section = SUM) -> AttractorObservables:
    """Follow an attractor from one of its states; section : the section whose crossings are recorded."""
    settings = Settings(
        transient=0.0, window=DURATION, batches=2, sampling=DURATION, trajectory=DURATION, event_window=0.0,
        trajectory_sampling=longest_spacing(model.chain) / PER_SPACING, lyapunov_exponents=0, section=section,
    )  # fmt: skip
    trajectory = run(model, start, settings)
    events = trajectory.earlier_event_time, trajectory.earlier_event_block, trajectory.earlier_event_kind
    crossings = trajectory.crossing_velocity[trajectory.crossing_direction > 0]
    return AttractorObservables(
        crossings,
        correlation(trajectory.velocity[:, 0], trajectory.velocity[:, -1]),
        trajectory.velocity,
        starts_of_blocks(*events, model.blocks),
    )
