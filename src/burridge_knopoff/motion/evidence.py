"""What a run shows of its kind of motion besides its exponents: repetition, stops, and whether the motion changes."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from burridge_knopoff.motion.period import ROUNDING, SECTION, Repetition, repetition_length, repetition_of
from burridge_knopoff.motion.settings import MotionSettings

#: The arrays of a run that are needed, by their names in point files.
RECORD = (*SECTION, "batch_mean_distance")

# Factor by which the distance between successive cycles, or between the end blocks, grows if a run leaves an unstable
# orbit.
DIVERGENCE = 2.0

# Relative difference between the halves of a window above which a motion still changes: of ⟨J⟩ and, without stops, of
# the largest W' at section points. Settled tori differed by at most 4e-3 in windows of 1000 to 7000; in one of 7000 an
# amplitude that changes at a rate of 3e-6 differs by more.
CHANGE = 0.01

# The last section points, as a fraction of all, that show whether chaos has ended in the window.
LAST_PART = 0.125


@dataclass(frozen=True)
class Evidence:
    """What a run shows of its kind of motion.

    repetition : of the state of all blocks
    stops : whether a block stops among the recorded events
    drifts : whether the motion still changes, if it is regular: ⟨J⟩ differs between parts of the window by more than
        it does on a periodic orbit or a torus, J grows from synchrony, or, without stops, the amplitude differs
    settles : whether section points that do not repeat do so in the last part of the window
    """

    repetition: Repetition
    stops: bool = False
    drifts: bool = False
    settles: bool = False


def evidence_of(run: Mapping[str, np.ndarray], mean_distance: float, settings: MotionSettings) -> Evidence:
    """Return the evidence of a completed run.

    run : arrays of a run named in RECORD; the events must include all stops
    mean_distance : ⟨J⟩; infinite if the chain is not its own mirror image
    """
    repetition = repetition_of(run, mean_distance, settings)
    stops, repeats = len(run["event_time"]) > 0, repetition.is_observed
    velocity = run["crossing_velocity"][run["crossing_direction"] > 0]
    drifts = _changes_distance(run, repetition, mean_distance, settings)
    # Blocks without stops may move although W and J are rounding.
    drifts |= (
        not stops and max(velocity.max(initial=0.0), run["batch_mean_distance"].max()) <= settings.period_tolerance
    )
    if not repeats:
        # A single block has no torus.
        drifts |= run["event_position"].shape[1] == 1 or (not stops and _changes_amplitude(velocity, settings))
    last = velocity[len(velocity) - int(LAST_PART * len(velocity)) :]
    settles = not repeats and repetition_length(last, settings.period_tolerance, len(last)) > 0
    return Evidence(repetition, stops, bool(drifts), settles)


def _changes_distance(
    run: Mapping[str, np.ndarray], repetition: Repetition, mean_distance: float, settings: MotionSettings
) -> bool:
    """Return whether the mean J of two parts of a window differs by more than it does in steady regular motion.

    Over a time H the mean of J ≥ 0 of period P differs from ⟨J⟩ by at most ⟨J⟩ P/H. A repetition is that of the second
    half of the window.
    """
    batch = run["batch_mean_distance"]
    count, allowed = len(batch), CHANGE
    if repetition.is_observed:
        batch = batch[min(count // 2, count - 2) :]
    part = len(batch) // 2
    first, last = float(batch[:part].mean()), float(batch[-part:].mean())
    if mean_distance < settings.synchronization_threshold:
        return last > DIVERGENCE * max(first, ROUNDING * settings.period_tolerance)
    if repetition.is_observed:
        time = run["crossing_time"] if len(run["crossing_time"]) else run["event_time"]
        upward = time[run["crossing_direction"] > 0] if repetition.points else time
        period = upward[-1] - upward[-1 - repetition.points] if repetition.points else repetition.period
        allowed = max(allowed, 2.0 * period * count / (part * (time[-1] - time[0])))
    return abs(first - last) > allowed * max(first, last)


def _changes_amplitude(velocity: np.ndarray, settings: MotionSettings) -> bool:
    """Return whether the largest W' at upward section points, shape (n,), differs between the halves of a run."""
    first, second = (float(half.max(initial=0.0)) for half in np.array_split(velocity, 2))
    return abs(first - second) > max(CHANGE * max(first, second), settings.period_tolerance)
