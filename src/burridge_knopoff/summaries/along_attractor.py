"""What a run along an attractor shows of it: its points on the section W = 0, and how the velocities oscillate."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from burridge_knopoff.model.model import ChainState, Model
from burridge_knopoff.motion.frequency import leading_frequency
from burridge_knopoff.running.section import SUM, Section
from burridge_knopoff.running.settings import Settings
from burridge_knopoff.running.simulation import run
from burridge_knopoff.summaries.correlation import correlation

#: Time for which each attractor is followed.
FOLLOWED = 1000.0

# Velocities on the section within which two of its points are one.
SAME_VELOCITY = 1e-6

# Of the samples of the velocity every so many are enough for its spectrum.
THINNED = 8


@dataclass(frozen=True)
class AlongAttractor:
    """What a run along an attractor shows.

    section : W' where W = 0 is crossed upward, shape (n,)
    velocity_correlation : Pearson correlation of the velocities of the end blocks, NaN if one is constant
    velocity : U' of each block at equidistant times, shape (samples, blocks)
    """

    section: np.ndarray
    velocity_correlation: float
    velocity: np.ndarray

    @property
    def velocity_frequency(self) -> np.ndarray:
        """Frequency of the highest peak of the spectrum of U', shape (blocks,); see `leading_frequency`."""
        return np.array([leading_frequency(one[::THINNED], FOLLOWED) for one in self.velocity.T])


def along_attractor(model: Model, start: ChainState, seen_on: Section = SUM) -> AlongAttractor:
    """Follow an attractor from one of its states; seen_on : the section that is kept."""
    settings = Settings(
        transient=0.0, window=FOLLOWED, batches=2, sampling=FOLLOWED, trajectory=FOLLOWED, events="none",
        lyapunov_exponents=0, section=seen_on,
    )  # fmt: skip
    found = run(model, start, settings)
    section = found.crossing_velocity[found.crossing_direction > 0]
    return AlongAttractor(section, correlation(found.velocity[:, 0], found.velocity[:, -1]), found.velocity)


def distinct(velocity: np.ndarray) -> int:
    """Return how many section points W', shape (n,), differ by more than SAME_VELOCITY."""
    return int(np.count_nonzero(np.diff(np.sort(velocity)) > SAME_VELOCITY)) + 1 if len(velocity) else 0
