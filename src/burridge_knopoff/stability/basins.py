"""Basins of attraction: which attractor each state of a plane of initial states reaches.

`summaries.basins` makes maps of them and `figures.basins` draws these.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
import xarray

from burridge_knopoff.model.model import Instant, Model
from burridge_knopoff.periodic_orbits.symmetry import Symmetry
from burridge_knopoff.stability.attractor import Attractor, spread
from burridge_knopoff.stability.labels import UNDETERMINED
from burridge_knopoff.stability.motion import MotionKind
from burridge_knopoff.stability.settings import MotionSettings, SearchSettings
from burridge_knopoff.stability.settling import Settling
from burridge_knopoff.stability.steady import measure_once
from burridge_knopoff.stability.tuning import TUNING


@dataclass(frozen=True, eq=False)
class KnownAttractors:
    """The attractors of one model, with the branch and the side of each, shape (attractors,)."""

    model: Model
    attractors: list[Attractor]
    branch: np.ndarray
    side: np.ndarray


def known_attractors(
    summary: xarray.Dataset, model: Model, settings: SearchSettings, motion: MotionSettings
) -> KnownAttractors:
    """Return the attractors of a model from their summary; their returns are computed again from its states.

    summary : `attractors.nc`, which has the law of the model, by its name, and its a
    settings, motion : those that the summary was made with

    Raises ValueError if an attractor of the summary does not last.
    """
    law, a = model.law.name, model.a
    found = summary.sel(law=law, a=a)
    slots = np.flatnonzero(found["branch"].values != UNDETERMINED)
    branch, side = found["branch"].values[slots], found["side"].values[slots]
    settling, attractors = Settling(model, settings, motion), []
    for index, slot in enumerate(slots):
        one = found.isel(attractor=slot)
        velocity = one["velocity"].values
        start = Instant(one["position"].values - model.sliding_offset, velocity, velocity == 0.0)
        closed = None if math.isnan(one["period"].item()) else settling.settle(start)
        window = TUNING.filling * settings.window if closed is None else settling.window_of(closed)
        # The search has seen which kind it is, in longer windows.
        steady = measure_once(model, start, settings.transient, window, motion.at_speed(model.v), TUNING)
        if steady is None:
            raise ValueError(
                f"attractors.nc: branch {one['branch'].item()} of the {law} law at a = {a} is not an attractor: its "
                "motion does not complete, or its blocks hardly ever stop"
            )
        error = 5.0 * (one["mean_distance_error"].item() + steady.mean_distance_error) + TUNING.same_mean * model.scale
        if abs(steady.mean_distance - one["mean_distance"].item()) > error:
            raise ValueError(
                f"attractors.nc: branch {one['branch'].item()} of the {law} law at a = {a} has <J> "
                f"{steady.mean_distance:.5f} now and {one['mean_distance'].item():.5f} in the file: motion that does "
                "not last has no basin; leave this a out of basins and phases"
            )
        steady, slow = replace(steady, kind=MotionKind(one["kind"].item())), bool(one["slow"].item())
        if slow:
            steady = spread(model, steady, settings)
        if one["symmetry"].item() == Symmetry.SYMMETRIC:
            steady = steady.symmetrized()
        fixed = {name: one[name].item() for name in ("radius", "close_returns", "patience")}
        images = np.flatnonzero((branch == branch[index]) & (side == -side[index]))
        partner = int(images[0]) if side[index] and len(images) else index
        attractors.append(Attractor(steady, Symmetry(one["symmetry"].item()), partner, slow=slow, **fixed))
    return KnownAttractors(model, attractors, branch, side)


def plane(
    position: Sequence[float], first: np.ndarray, last: np.ndarray, velocity: Sequence[float]
) -> tuple[np.ndarray, np.ndarray]:
    """Return the initial states of a plane, U(0) and U'(0), each of shape (len(last) len(first), blocks).

    The state given by `position` and `velocity`, but for U_1(0) from `first` and U_N(0) from `last`; `first` runs
    faster.
    """
    return states(position, np.tile(first, len(last)), np.repeat(last, len(first)), velocity)


def states(
    position: Sequence[float], first: np.ndarray, last: np.ndarray, velocity: Sequence[float]
) -> tuple[np.ndarray, np.ndarray]:
    """Return initial states, U(0) and U'(0), each of shape (n, blocks): a given one but for U_1(0) and U_N(0), (n,)."""
    positions = np.tile(np.array(position, dtype=float), (len(first), 1))
    positions[:, 0], positions[:, -1] = first, last
    return positions, np.tile(np.array(velocity, dtype=float), (len(first), 1))


def pixel_centres(interval: Sequence[float], pixels: int) -> np.ndarray:
    """Return the middles of equal pixels that fill an interval (low, high), shape (pixels,)."""
    low, high = interval
    return low + (high - low) * (np.arange(pixels) + 0.5) / pixels
