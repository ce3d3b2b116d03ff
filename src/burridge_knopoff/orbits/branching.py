"""What takes the place of the synchronized orbit beyond a_c: the orbits that branch off where its multiplier is 1.

Such an orbit is sought by its asymmetry d = x_1 − x_3 (while blocks 1 and 3 both stick). For given d and a the
mirror-symmetric components of φ_T(z) = z are solved; what is then left of the antisymmetric one, over d, is

    g(a, d) = μ(a) − 1 + c d² + …,

even in d by mirror symmetry, and its root in a is where the orbit exists (Lyapunov-Schmidt reduction). The synchronized
orbit d = 0 has been divided out, so that this is well conditioned however small d is. Roots a > a_c near d = 0 make the
pitchfork supercritical.

Reference: Y. A. Kuznetsov, "Elements of Applied Bifurcation Theory" (Springer 2004), Section 7.4.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
import scipy
from scipy.optimize import root_scalar

from burridge_knopoff.model.model import Instant
from burridge_knopoff.orbits.family import Family
from burridge_knopoff.orbits.orbit import (
    ALL_DIRECTIONS,
    SYMMETRIC_DIRECTIONS,
    Orbit,
    OrbitError,
    after,
    find_orbit,
    solve,
)
from burridge_knopoff.orbits.transition import TOLERANCE, apart
from burridge_knopoff.running.runner import Runner
from burridge_knopoff.running.status import Status

# Rounding of positions, which g carries divided by the asymmetry.
ROUNDING = 1e-16

# Largest g that is left at a root, before rounding.
SOLVED = 1e-12

# An orbit that branches off is looked for no farther from a_c than this share of it.
FARTHEST = 0.5

# Asymmetry, in units of v, given to a state before each run of a sweep: exact synchrony would never be left.
SEED = 1e-5

#: Time of each run of a sweep: at |a − a_c| = 1e-3 perturbations change by a factor of e^20.
SWEEP_TIME = 20_000.0


def branch_orbit(family: Family, critical: float, asymmetry: float) -> Orbit:
    """Return the orbit of a given small asymmetry that branches off at a_c; its model has the a at which it exists.

    Raises OrbitError if it is not found.
    """

    def constrained(a: float) -> tuple[Instant, float]:
        near = family.at(a)
        return solve(near.model, apart(near.reference, asymmetry), near.period, SYMMETRIC_DIRECTIONS)

    def reduced(a: float) -> float:
        if not abs(a - critical) < FARTHEST * critical:
            raise OrbitError(f"asymmetry = {asymmetry!r}: no orbit found near a = {critical!r}")
        a = float(a)
        state, period = constrained(a)
        end = after(Runner(family.model_at(a)), state, period)
        return float(end.position[0] - end.position[2]) / asymmetry - 1.0

    noise = ROUNDING / abs(asymmetry)
    second = critical + (asymmetry / family.model.v) ** 2 * critical
    found = root_scalar(reduced, x0=critical, x1=second, method="secant", xtol=noise, rtol=TOLERANCE)
    if not math.isfinite(found.root) or abs(reduced(found.root)) > SOLVED + 100.0 * noise:
        raise OrbitError(f"asymmetry = {asymmetry!r}: no orbit found near a = {critical!r}")
    a = float(found.root)
    state, period = constrained(a)
    return find_orbit(family.model_at(a), state, period, ALL_DIRECTIONS)


def leading_modulus(orbit: Orbit) -> float:
    """Return the largest modulus of the multipliers other than that of the flow, to eight digits."""
    values = np.linalg.eigvals(orbit.monodromy)
    others = np.delete(values, np.abs(values - 1.0).argmin())
    return round(float(np.abs(others).max()), 8)


@dataclass(frozen=True)
class PowerLaw:
    """A fit amplitude = coefficient·offset^exponent, with the standard error of the exponent."""

    exponent: float
    error: float
    coefficient: float


def fit_power_law(offset: np.ndarray, amplitude: np.ndarray) -> PowerLaw:
    """Fit amplitudes at positive offsets, both of shape (n,), by least squares of their logarithms.

    The digits kept do not depend on the order in which a linear-algebra library adds.
    """
    fit = scipy.stats.linregress(np.log(offset), np.log(amplitude))
    return PowerLaw(*(round(float(value), 10) for value in (fit.slope, fit.stderr, np.exp(fit.intercept))))


def sweep(family: Family, values: np.ndarray) -> np.ndarray:
    """Return |x_1 − x_3| (while both stick) after a run at each a in turn, shape (n,).

    Each run goes on from the last one, with a small asymmetry added; the first begins near the synchronized orbit. NaN
    from the a on at which blocks 1 and 3 no longer stick at the same time.
    """
    found = np.full(len(values), np.nan)
    state = family.at(float(values[0])).reference
    for k, a in enumerate(values):
        try:
            state = _settled(family, float(a), apart(state, SEED * family.model.v))
        except OrbitError:
            break
        found[k] = abs(state.position[0] - state.position[2])
    return found


def _settled(family: Family, a: float, state: Instant) -> Instant:
    """Return the first state after a time at a in which blocks 1 and 3 have both just come to stick."""
    runner = Runner(family.model_at(a))
    after(runner, state, SWEEP_TIME)
    for block in (0, 2, 0, 2):
        if runner.run(2.0 * SWEEP_TIME, halting_block=block) != Status.HALTED:
            break
        now = runner.instant()
        if now.stuck[0] and now.stuck[2]:
            return now
    raise OrbitError(f"a = {a!r}: blocks 1 and 3 no longer stick at the same time")
