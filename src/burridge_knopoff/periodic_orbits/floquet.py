"""Floquet multipliers of a periodic orbit, without that of the flow, and functions that vanish at its bifurcations.

For an orbit that is its own mirror image after half a period, everything is computed from the half return: its
multipliers ν give those of the whole period, μ = ν². ν = −1 breaks the symmetry (a pitchfork, μ = +1), and ν = +1 is a
fold. A single μ = −1 would require both ν = i and ν = −i. Such orbits therefore lose the symmetry before they can
double their period.

If mirror blocks move synchronously, symmetric and symmetry-breaking perturbations do not mix: +1 is a fold among the
former and a pitchfork among the latter, and −1 is a period doubling among both.

References: Y. A. Kuznetsov, "Elements of Applied Bifurcation Theory" (Springer 2004), Sections 5.4, 7.4 and 10.2;
J. W. Swift and K. Wiesenfeld, Phys. Rev. Lett. 52 (1984) 705.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from burridge_knopoff.periodic_orbits.flow import OrbitError, rate
from burridge_knopoff.periodic_orbits.periodic import PeriodicOrbit
from burridge_knopoff.periodic_orbits.return_map import allowed_directions, symmetry_breaking_directions
from burridge_knopoff.periodic_orbits.symmetry import Symmetry
from burridge_knopoff.periodic_orbits.without_stops import is_sliding
from burridge_knopoff.values import instance_of


@dataclass(frozen=True, eq=False)
class Multipliers:
    """Complex multipliers of a return, without that of the flow; largest modulus first.

    symmetry_preserving : of all perturbations, or only of the mirror-symmetric ones if mirror blocks move synchronously
    symmetry_breaking : of the symmetry-breaking perturbations; empty unless mirror blocks move synchronously
    power : number of returns in a period

    >>> from burridge_knopoff import Model, limit_cycle, multipliers, simulate
    >>> model = Model("linearized", a=0.08)
    >>> run = simulate(model, initial="plus", transient=0, window=10)
    >>> orbit = limit_cycle(model, model.begin(run.initial), settling=1000.0)
    >>> found = multipliers(orbit)
    >>> abs(found.whole).round(4).tolist(), found.unstable_count
    ([0.3786, 0.0, 0.0, 0.0, 0.0], 0)
    """

    symmetry_preserving: np.ndarray
    symmetry_breaking: np.ndarray
    power: int

    def __repr__(self) -> str:
        leading = ", ".join(f"{value:.6g}" for value in self.whole[:3])
        return f"<Multipliers of a period: {leading}{', ...' * (len(self.whole) > 3)}; {self.unstable_count} unstable>"

    @property
    def whole(self) -> np.ndarray:
        """All multipliers of a whole period, largest modulus first."""
        both = np.concatenate([self.symmetry_preserving, self.symmetry_breaking]) ** self.power
        return both[np.argsort(-np.abs(both), kind="stable")]

    @property
    def transverse(self) -> complex:
        """Leading multiplier of symmetry-breaking perturbations; NaN unless mirror blocks move synchronously."""
        return complex(self.symmetry_breaking[0]) if len(self.symmetry_breaking) else complex(np.nan)

    @property
    def attracts_within_synchrony(self) -> bool:
        """Whether mirror-symmetric perturbations of a synchronized orbit decay; False for other orbits.

        If they grow, nearby synchronized motion leaves the orbit, and `transverse` does not decide whether synchrony
        attracts: synchronized motion of another period may.
        """
        return len(self.symmetry_breaking) > 0 and bool((np.abs(self.symmetry_preserving) < 1.0).all())

    @property
    def unstable_count(self) -> int:
        """Number of multipliers outside the unit circle."""
        return int((np.abs(np.concatenate([self.symmetry_preserving, self.symmetry_breaking])) > 1.0).sum())


def multipliers(orbit: PeriodicOrbit) -> Multipliers:
    """Return the Floquet multipliers of an orbit; the velocities of stuck blocks have multiplier 0.

    The direction of the flow is an eigenvector of the return with eigenvalue 1. The restriction to its orthogonal
    complement has the other eigenvalues, however close to 1 they are.

    orbit : of any chain; the multiplier 1 of the flow is excluded

    Raises OrbitError, a ValueError, where the return has no derivative but one for each order in which blocks stop and
    start: blocks that a dashpot joins change at one instant, and friction drops at a start.

    Source: Y. A. Kuznetsov, "Elements of Applied Bifurcation Theory" (Springer 2004), Sections 5.4, 7.4 and 10.2.

    >>> from burridge_knopoff import Model, limit_cycle, multipliers, simulate
    >>> model = Model("linearized", a=0.08)
    >>> run = simulate(model, initial="plus", transient=0, window=10)
    >>> orbit = limit_cycle(model, model.begin(run.initial), settling=1000.0)
    >>> multipliers(orbit).unstable_count == 0
    True
    """
    # In the chain's own units: otherwise positions would outweigh velocities in slow chains.
    nothing = np.zeros(instance_of(orbit, PeriodicOrbit, "orbit").model.blocks, dtype=bool)
    check_derivative(orbit)
    keeping, breaking = allowed_directions(nothing, orbit.symmetry), symmetry_breaking_directions(nothing)
    if orbit.symmetry != Symmetry.SYNCHRONIZED:
        breaking = breaking[:, :0]
    units = orbit.model.chain.own_units
    scale = units.state(orbit.model.blocks)
    flow = (rate(orbit.model, orbit.reference) * units.time / scale) @ keeping
    if is_sliding(orbit.model, orbit.reference):
        # Uniform sliding has no flow; at its Hopf bifurcation the multiplier 1 has two directions.
        values, directions = np.linalg.eig(orbit.monodromy * scale / scale[:, None])
        flow = directions[:, np.abs(values - 1.0).argmin()].real @ keeping
    across = keeping @ np.linalg.svd(flow[:, None])[0][:, 1:]
    monodromy = orbit.monodromy * scale / scale[:, None]
    kept, broken = (_sorted(np.linalg.eigvals(basis.T @ monodromy @ basis)) for basis in (across, breaking))
    return Multipliers(kept, broken, power=2 if orbit.symmetry == Symmetry.SYMMETRIC else 1)


def check_derivative(orbit: PeriodicOrbit) -> None:
    """Raise OrbitError if the return of an orbit has no derivative."""
    if orbit.missing_derivative:
        raise OrbitError(
            f"orbit: {orbit.missing_derivative}, expected an orbit whose return has a derivative; the growth of a "
            f"perturbation depends on its direction: follow a perturbed state"
        )


def unstable_count(orbit: PeriodicOrbit) -> int | None:
    """Return the number of multipliers outside the unit circle; None where the return has no derivative."""
    return None if orbit.missing_derivative else multipliers(orbit).unstable_count


def _sorted(values: np.ndarray) -> np.ndarray:
    values = values.astype(complex)
    return values[np.lexsort((-values.imag, -values.real, -np.abs(values)))]
