"""Asymmetry of the end blocks beyond the loss of synchrony: in sweeps through a_c, and as a power law."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy

from burridge_knopoff.model.model import ChainState, Model
from burridge_knopoff.periodic_orbits.flow import OrbitError, model_at, state_after
from burridge_knopoff.periodic_orbits.known_orbits import KnownOrbits
from burridge_knopoff.periodic_orbits.pitchfork import displace_end_blocks
from burridge_knopoff.running.runner import Runner
from burridge_knopoff.running.status import Status

# Asymmetry, in units of v, added to the state before each run of a sweep: exact synchrony would persist for ever.
SEED = 1e-5

#: Time of each run of a sweep: at |a − a_c| = 1e-3 perturbations change by a factor of e^20.
SWEEP_TIME = 20_000.0


@dataclass(frozen=True)
class PowerLaw:
    """A fit amplitude = coefficient·offset^exponent, with the standard error of the exponent."""

    exponent: float
    error: float
    coefficient: float


def fit_power_law(offset: np.ndarray, amplitude: np.ndarray) -> PowerLaw:
    """Fit amplitudes at positive offsets, both of shape (n,), by least squares of their logarithms.

    The result is rounded so that it does not depend on the order of summation in the linear-algebra library.
    """
    fit = scipy.stats.linregress(np.log(offset), np.log(amplitude))
    return PowerLaw(*(round(float(value), 10) for value in (fit.slope, fit.stderr, np.exp(fit.intercept))))


def sweep(orbits: KnownOrbits, values: np.ndarray) -> np.ndarray:
    """Return |x_1 − x_N| while both end blocks stick, after a run at each a in turn, shape (n,).

    orbits : the synchronized orbits

    The first run starts near the synchronized orbit, and each further run from the end of the one before, with a small
    asymmetry added. The result is NaN from the first a at which the end blocks no longer stick at the same time.
    """
    amplitude = np.full(len(values), np.nan)
    state = orbits.at(float(values[0])).reference
    for k, a in enumerate(values):
        try:
            state = _settle(model_at(orbits.model, float(a)), displace_end_blocks(state, SEED * orbits.model.v))
        except OrbitError:
            break
        amplitude[k] = abs(state.position[0] - state.position[-1])
    return amplitude


def _settle(model: Model, state: ChainState) -> ChainState:
    """Return the first state after a settling time at which both end blocks have begun to stick."""
    runner, last = Runner(model), model.blocks - 1
    state_after(runner, state, SWEEP_TIME)
    for block in (0, last, 0, last):
        if runner.run(2.0 * SWEEP_TIME, halting_block=block) != Status.HALTED:
            break
        now = runner.state()
        if now.stuck[0] and now.stuck[last]:
            return now
    raise OrbitError(f"a = {model.a!r}: the end blocks no longer stick at the same time")
