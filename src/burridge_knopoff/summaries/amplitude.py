"""Asymmetry of the end blocks beyond the loss of synchrony: in sweeps through a_c, and as a power law."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from burridge_knopoff.laws.law import recorded_a
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
    """A fit amplitude = coefficient·offset^exponent·(1 + O(offset)) near offset 0, with the errors of both numbers."""

    exponent: float
    error: float
    coefficient: float
    coefficient_error: float


def fit_power_law(offset: np.ndarray, amplitude: np.ndarray, offset_error: float = 0.0) -> PowerLaw:
    """Fit amplitudes at positive offsets ε, both of shape (n,), n ≥ 6, with the next order of their expansion.

    offset_error : error that all offsets share, that of a_c

    The fit is ln amplitude = ln coefficient + exponent·ln ε + k ε by least squares. The errors combine three parts: the
    standard errors of the fit; the largest change of its result if the range of ε ends two values earlier or begins two
    values later, which shows the orders beyond; and its change by the error of ε.

    The result is rounded so that it does not depend on the order of summation in the linear-algebra library.
    """
    order = np.argsort(offset)
    x, y = offset[order], np.log(amplitude[order])
    whole, errors = _fit_with_next_order(x, y)
    others = np.array([_fit_with_next_order(x[part], y[part])[0] for part in (slice(-2), slice(2, None))])
    shifted, _ = _fit_with_next_order(x + offset_error, y)
    errors = np.sqrt(errors**2 + np.abs(others - whole).max(axis=0) ** 2 + (shifted - whole) ** 2)
    (intercept, exponent), (intercept_error, exponent_error) = whole, errors
    coefficient = np.exp(intercept)
    values = exponent, exponent_error, coefficient, coefficient * intercept_error
    return PowerLaw(*(round(float(value), 10) for value in values))


def _fit_with_next_order(x: np.ndarray, y: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return constant and slope of y = constant + slope·ln x + k x, and their standard errors, each of shape (2,)."""
    scale = x.max()
    design = np.stack([np.ones(len(x)), np.log(x / scale), x / scale], axis=1)
    values, squares, _, _ = np.linalg.lstsq(design, y)
    covariance = np.linalg.pinv(design.T @ design) * (squares[0] if len(squares) else 0.0) / (len(x) - design.shape[1])
    # From ln(x / scale) back to ln x.
    back = np.array([[1.0, -np.log(scale), 0.0], [0.0, 1.0, 0.0]])
    return back @ values, np.sqrt(np.diag(back @ covariance @ back.T))


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
    raise OrbitError(f"a = {recorded_a(model.law)!r}: the end blocks no longer stick at the same time")
