"""The rotation number of motion that is its own mirror image: cycles of the end blocks per cycle of the middle block.

By symmetry both end blocks of such motion have the same frequency, whether or not it is locked. The ratio of the two
oscillations can lock: the oscillation of the distance between the end blocks, which is antisymmetric, and that of the
middle block, which is symmetric. On a torus the ratio changes with a. If the torus is locked, the ratio is rational and
constant throughout a tongue: a plateau.

References: R. S. MacKay and C. Tresser, Physica D 19 (1986) 206 (rotation numbers); S. Das, Y. Saiki, E. Sander and
J. A. Yorke, Nonlinearity 30 (2017) 4111 (weighted averages, which converge faster than any power on a torus).
"""

from __future__ import annotations

import math

import numpy as np

from burridge_knopoff.model.model import ChainState, Model
from burridge_knopoff.periodic_orbits.grazing_distances import longest_spacing
from burridge_knopoff.running.ensemble import new_ensemble

# Phase changes below this between successive samples have an unambiguous sign. An oscillation that passes through its
# centre has larger changes, and no phase.
MAX_PHASE_STEP = 0.5 * math.pi


def rotation_number(model: Model, start: ChainState, duration: float) -> tuple[float, float]:
    """Return the rotation number of the motion from a state, and its error; NaN if an oscillation has no phase.

    The phases are those of x_1 − x_N + i(U_1' − U_N') and of x_m + i(U_m' − v), with m the middle block, or the sum of
    both middle blocks. The error is the difference between the two halves of the time, which are less accurate than the
    whole.
    """
    count = 2 * math.ceil(0.5 * duration / longest_spacing(model.chain))
    state = (start.position[None], start.velocity[None], start.stuck[None].astype(bool))
    motion = new_ensemble(model).run(*state, np.linspace(0.0, duration, count + 1).tolist())
    states = motion["position"][0] + 1j * (motion["velocity"][0] - model.v)
    middle = states[:, [(model.blocks - 1) // 2, model.blocks // 2]].sum(axis=1)
    oscillations = np.stack([states[:, 0] - states[:, -1], middle])
    with np.errstate(divide="ignore", invalid="ignore"):
        phase_steps = np.angle(oscillations[:, 1:] / oscillations[:, :-1])
    if not (np.abs(phase_steps) <= MAX_PHASE_STEP).all():
        return math.nan, math.nan
    halves = phase_steps[:, : count // 2], phase_steps[:, count // 2 :]
    whole, first, second = map(_rate_ratio, (phase_steps, *halves))
    return whole, abs(first - second)


def mean_rotation(returns: np.ndarray) -> float:
    """Return the mean number of turns, at most ½, about the centre of a closed curve from one return to the next.

    returns : successive states on the curve, shape (n, coordinates); turns are counted in the plane of its largest
        extents, in which the curve has to surround its centre
    """
    around = returns - returns.mean(axis=0)
    plane = around @ np.linalg.svd(around, full_matrices=False)[2][:2].T
    angle = np.arctan2(plane[:, 1], plane[:, 0])
    steps = np.angle(np.exp(1j * np.diff(angle)))
    weight = _weights(len(steps))
    return float(abs((steps * weight).sum() / weight.sum()) / (2.0 * math.pi))


def _rate_ratio(phase_steps: np.ndarray) -> float:
    """Return the ratio of the mean rates of two phases from their changes in equal time steps, shape (2, n)."""
    ends, middle = (phase_steps * _weights(phase_steps.shape[1])).sum(axis=1)
    return float(ends / middle) if middle else math.nan


def _weights(count: int) -> np.ndarray:
    """Return the weights of a number of equal time steps, with which averages on a torus converge fastest."""
    time = (np.arange(count) + 0.5) / count
    return np.exp(-1.0 / (time * (1.0 - time)))
