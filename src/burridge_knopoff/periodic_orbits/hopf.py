"""Hopf bifurcations of uniform sliding along a parameter, in closed form, and the periodic orbits that begin there.

A perturbation of uniform sliding obeys δU'' = −M⁻¹K δU + (G − M⁻¹C) δU', with the diagonal matrices M of the masses and
G of −threshold·dΦ(w U')/dU'/m at U' = v, and C of the dashpots. At a Hopf bifurcation a pair of eigenvalues ±iω of this
Jacobian crosses the imaginary axis, and a branch of periodic orbits without stops begins, with the period 2π/ω. No real
eigenvalue crosses 0, since K is positive definite. Under a law that is linear in speed the bifurcation is degenerate:
all these orbits exist at the critical value only, and are neutral.

Reference: Y. A. Kuznetsov, "Elements of Applied Bifurcation Theory" (Springer 2004), Section 3.4.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from scipy.optimize import brentq

from burridge_knopoff.model.model import ChainState, Model
from burridge_knopoff.model.ranges import Number
from burridge_knopoff.model.uniform_sliding import jacobian, sliding_state
from burridge_knopoff.periodic_orbits.flow import OrbitError
from burridge_knopoff.periodic_orbits.following import interval_ends
from burridge_knopoff.periodic_orbits.periodic import Constraint, PeriodicOrbit, missing_isolation_of, solve_return
from burridge_knopoff.periodic_orbits.pseudo_arclength import line_of
from burridge_knopoff.periodic_orbits.return_map import mirror_order
from burridge_knopoff.periodic_orbits.symmetry import Symmetry
from burridge_knopoff.values import instance_of

# Number of parts of an interval, at the ends of which the signs of growth rates are compared.
PARTS = 256

# Growth rates, times the period, up to this one are rounding errors.
ROUNDING = 1e-10

# Accuracy of the critical value, relative to the interval or to the value.
TOLERANCE = 4.0 * float(np.finfo(float).eps)

# Largest difference of a mode from its mirror image, or from its negative, that is a rounding error.
PARITY = 1e-8

AMPLITUDE = Number(0.0, 0.1, above=True)


@dataclass(frozen=True, eq=False)
class HopfBifurcation:
    """A Hopf bifurcation of uniform sliding.

    parameter, value : the parameter along which it was found, and its critical value
    model : the model there
    period : 2π/ω, of the orbits that begin there
    mode : the eigenvector, positions and velocities, complex, shape (2 blocks,); the largest velocity is 1

    >>> from burridge_knopoff import Model, hopf_bifurcations
    >>> model = Model({"formula": "1 - a*u + b*u**3"}, a=0.5, b=0.3, blocks=1, pulling=1)
    >>> (at,) = hopf_bifurcations(model, (0.5, 1), parameter="v")
    >>> round(at.value, 9), round(at.period, 9), at.orbit().model.v < at.value
    (0.745355992, 6.283185307, True)
    """

    parameter: str
    value: float
    model: Model
    period: float
    mode: np.ndarray

    def __repr__(self) -> str:
        return f"<HopfBifurcation at {self.parameter} = {self.value:.12g}, period {self.period:.9g}>"

    @property
    def symmetry(self) -> Symmetry:
        """The symmetry of the orbits that begin there."""
        if self.model.chain.is_mirror_symmetric and self.model.blocks > 1:
            image = self.mode[mirror_order(self.model.blocks)]
            for sign, symmetry in ((1.0, Symmetry.SYNCHRONIZED), (-1.0, Symmetry.SYMMETRIC)):
                if np.abs(image - sign * self.mode).max() <= PARITY * np.abs(self.mode).max():
                    return symmetry
        return Symmetry.ASYMMETRIC

    def orbit(self, amplitude: float = 0.02) -> PeriodicOrbit:
        """Return the orbit on the branch that begins there at which a velocity varies by an amplitude, relative to v.

        Its model has the value of the parameter at which it exists. Raises OrbitError if the bifurcation is degenerate,
        as under a law that is linear in speed, or if no orbit is found, and ValueError for an amplitude out of range.
        """
        amplitude = AMPLITUDE.form(amplitude, "amplitude")
        model, blocks, units = self.model, self.model.blocks, self.model.chain.own_units
        sliding, scale = sliding_state(model).vector(), units.state(model.blocks)
        change = amplitude * model.v * self.mode.real
        start = ChainState((sliding + change)[:blocks], (sliding + change)[blocks:], np.zeros(blocks, dtype=bool))
        time = self.period * (0.5 if self.symmetry == Symmetry.SYMMETRIC else 1.0)
        at = PeriodicOrbit(model, self.symmetry, start, time, start, np.eye(2 * blocks))
        line = line_of(at, self.parameter)
        along = np.concatenate([change / scale**2, [0.0, 0.0]]) / np.linalg.norm(change / scale)
        constraint = Constraint(
            along, float(np.linalg.norm(change / scale)), (sliding, time, line.coordinate(model)), line
        )
        orbit = solve_return(model, start, time, self.symmetry, constraint)
        if reason := missing_isolation_of(orbit):
            raise OrbitError(f"{self.parameter} = {self.value!r}: the Hopf bifurcation is degenerate: {reason}")
        return orbit


def hopf_bifurcations(model: Model, interval: tuple[float, float], *, parameter: str) -> list[HopfBifurcation]:
    """Return the Hopf bifurcations of uniform sliding along a parameter, in ascending order of the parameter.

    interval : (low, high) of the parameter; parameter : see `follow`

    The eigenvalues of the Jacobian at uniform sliding are compared at 257 values of the parameter. In a uniform chain
    without dashpots all modes cross at one value. `orbit` of each bifurcation begins its branch of periodic orbits,
    which `follow` continues.

    Raises ValueError, one line, for an interval that is not finite or a name that is not a parameter of the model.

    >>> from burridge_knopoff import Model, hopf_bifurcations
    >>> law = {"formula": "mud + (mus - mud)*exp(-u/v0)", "mus": 1.0, "mud": 0.5, "v0": 0.5}
    >>> model = Model(law, blocks=1, pulling=1, pulling_damping=0.1, contact="symmetric")
    >>> (at,) = hopf_bifurcations(model, (0.5, 2), parameter="v")
    >>> round(at.value, 12)
    1.151292546497
    """
    low, high = interval_ends(interval)
    if not math.isfinite(low) or not math.isfinite(high):
        raise ValueError(f"interval: got ({low:g}, {high:g}), expected finite ends")
    instance_of(model, Model, "model").law.check_complete(parameter)
    if parameter not in model.law.missing:
        model.parameter(parameter)
    values = np.linspace(low, high, PARTS + 1).tolist()
    spectra = [_oscillations(model, parameter, value) for value in values]
    # Modes with equal damping cross at one value.
    critical: list[float] = []
    found = []
    for index in range(model.blocks):
        before: tuple[float, float] | None = None
        for value, oscillations in zip(values, spectra, strict=True):
            rate = _rate(oscillations, index)
            if math.isnan(rate):
                before = None
            elif abs(rate) > ROUNDING:
                if before is not None and (before[1] > 0.0) != (rate > 0.0):
                    root = _critical_value(model, parameter, (before[0], value), index, critical)
                    found += [(root, index)] if root is not None else []
                before = value, rate
    bifurcations = []
    for root in {root for root, _ in found}:
        bifurcations += _bifurcations_at(model, parameter, root, [index for at, index in found if at == root])
    return sorted(bifurcations, key=lambda bifurcation: (bifurcation.value, -bifurcation.period))


def _oscillations(model: Model, parameter: str, value: float) -> np.ndarray | None:
    """Return the eigenvalues with a positive imaginary part, the fastest first; None if there is no such model."""
    try:
        values = np.linalg.eigvals(jacobian(model.at(**{parameter: float(value)})))
    except ValueError:
        return None
    values = values[values.imag > 0.0]
    return values[np.argsort(-values.imag, kind="stable")]


def _rate(oscillations: np.ndarray | None, index: int) -> float:
    """Return the growth of an oscillation in a radian; NaN if there is none of this index."""
    if oscillations is None or index >= len(oscillations):
        return math.nan
    return float(oscillations[index].real / oscillations[index].imag)


def _critical_value(
    model: Model, parameter: str, bracket: tuple[float, float], index: int, critical: list[float]
) -> float | None:
    """Return the value in a bracket at which an oscillation neither grows nor decays; None if there is none.

    critical : those of other oscillations, which are tried first; a new one is added
    """

    def rate(value: float) -> float:
        return _rate(_oscillations(model, parameter, value), index)

    low, high = bracket
    for value in critical:
        if low <= value <= high and abs(rate(value)) <= ROUNDING:
            return value
    root = float(brentq(rate, low, high, xtol=TOLERANCE * (high - low), rtol=TOLERANCE))
    # Where two oscillations exchange their order, the sign changes in a jump.
    if not abs(rate(root)) <= ROUNDING:
        return None
    critical.append(root)
    return root


def _bifurcations_at(model: Model, parameter: str, value: float, indices: list[int]) -> list[HopfBifurcation]:
    """Return the bifurcations of some oscillations, numbered from the fastest, at a critical value."""
    at = model.at(**{parameter: value})
    values, modes = np.linalg.eig(jacobian(at))
    order = np.flatnonzero(values.imag > 0.0)
    bifurcations = []
    for chosen in order[np.argsort(-values[order].imag, kind="stable")][indices]:
        velocity = modes[model.blocks :, chosen]
        mode = modes[:, chosen] / velocity[np.abs(velocity).argmax()]
        bifurcations.append(HopfBifurcation(parameter, value, at, 2.0 * math.pi / float(values[chosen].imag), mode))
    return bifurcations
