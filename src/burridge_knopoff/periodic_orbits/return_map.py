"""The return map of a chain: the state after a time, reflected if the symmetry requires it.

An orbit that is its own mirror image after half its period is closed by the return after half a period, followed by a
reflection. The return map of the whole period is the square of this map. It does not distinguish perturbations that
break the symmetry (a multiplier −1 of the half return) from those that preserve it (+1).

Reference: J. W. Swift and K. Wiesenfeld, "Suppression of period doubling in symmetric systems", Phys. Rev. Lett. 52
(1984) 705.
"""

from __future__ import annotations

from functools import cached_property

import numpy as np

from burridge_knopoff.model.model import ChainState, Model
from burridge_knopoff.periodic_orbits.flow import OrbitError, new_runner, rate, state_after
from burridge_knopoff.periodic_orbits.parameter_line import ParameterLine
from burridge_knopoff.periodic_orbits.symmetry import Symmetry
from burridge_knopoff.running.derivative import missing_derivative
from burridge_knopoff.running.runner import Runner

# Largest and smallest step for the derivative of a return. The error is of the order of the step, which is small enough
# for Newton's method and for tangents.
STEP = 1e-7
SMALLEST_STEP = 1e-13


class ReturnMap:
    """The return map of one model, with a reflection for a motion that is its own mirror image half a period later.

    symmetry : SYNCHRONIZED (mirror blocks move synchronously; no reflection), SYMMETRIC or ASYMMETRIC
    """

    def __init__(self, model: Model, symmetry: Symmetry) -> None:
        self.model = model
        self.symmetry = symmetry
        self._free = np.eye(2 * model.blocks)

    @cached_property
    def _runner(self) -> Runner:
        # Creating a runner takes longer than most returns.
        return new_runner(self.model, self._free)

    def end(self, start: ChainState, time: float) -> ChainState:
        """Return the end of a return from a state; raises OrbitError if the run does not complete."""
        return self._mirrored(state_after(self._runner, start, time))

    def end_and_tangent(self, start: ChainState, time: float) -> tuple[ChainState, np.ndarray]:
        """Return the end of a return and the linearized return map, shape (2 blocks, 2 blocks).

        Velocities of stuck blocks cannot be perturbed: their columns are 0. Where `missing_derivative` says so, the map
        is one of several directional derivatives.
        """
        self._runner.carry(self._free * np.concatenate([np.ones(len(start.stuck)), ~start.stuck]))
        end = self.end(start, time)
        return end, self._mirrored_rows(self._runner.perturbations)

    @property
    def missing_derivative(self) -> str:
        """Why the last return has no derivative; empty if it has one."""
        return missing_derivative(self._runner, mirror_symmetric=self.symmetry == Symmetry.SYNCHRONIZED)

    def event_rows(self) -> np.ndarray:
        """Return time, block (0 …) and kind (0 stop, 1 start) of each event of the last return, without reflection."""
        return np.stack(self._runner.events(), axis=1)

    def parameter_derivative(
        self, start: ChainState, time: float, end: ChainState, events: np.ndarray, line: ParameterLine
    ) -> np.ndarray:
        """Return the derivative of the end of a return along a line of parameters, shape (2 blocks,).

        start, time, end : of the return; events : blocks and kinds of its events in order, shape (n, 2)

        The derivative is a finite difference. At a grazing, where it jumps, the side of the orbit is used. It does not
        jump where two blocks stop at the same time and their order changes. Raises OrbitError if every step changes the
        stops and starts, or leads to no model.
        """
        step, coordinate, failure = STEP, line.coordinate(self.model), "no model at any step of this parameter"
        while step > SMALLEST_STEP:
            for neighbour in (coordinate + step, coordinate - step):
                try:
                    model = line.model(self.model, neighbour)
                except OrbitError:
                    continue
                failure = "stops and starts change at every step of this parameter"
                runner = new_runner(model)
                moved = self._mirrored(state_after(runner, start, time))
                if np.array_equal(_by_block(np.stack(runner.events()[1:], axis=1)), _by_block(events)):
                    return (moved.vector() - end.vector()) / (neighbour - coordinate)
            step *= 0.1
        raise OrbitError(f"{line.place(self.model)}: {failure}")

    def time_derivative(self, end: ChainState) -> np.ndarray:
        """Return the derivative of the end with respect to the time, shape (2 blocks,)."""
        return rate(self.model, end)

    def _mirrored(self, instant: ChainState) -> ChainState:
        return instant.mirrored() if self.symmetry == Symmetry.SYMMETRIC else instant

    def _mirrored_rows(self, matrix: np.ndarray) -> np.ndarray:
        return matrix[mirror_order(self.model.blocks)] if self.symmetry == Symmetry.SYMMETRIC else matrix


def _by_block(events: np.ndarray) -> np.ndarray:
    """Return events sorted by block, and for each block in order of time, shape (n, 2)."""
    return events[np.argsort(events[:, 0], kind="stable")]


def mirror_order(blocks: int) -> np.ndarray:
    """Return the indices of positions and velocities in the mirror image of a state."""
    order = np.arange(blocks)[::-1]
    return np.concatenate([order, blocks + order])


def allowed_directions(stuck: np.ndarray, symmetry: Symmetry) -> np.ndarray:
    """Return an orthonormal basis of the allowed changes of a state as columns, shape (2 blocks, free).

    Velocities of stuck blocks do not change. If mirror blocks move synchronously, changes are mirror-symmetric.
    """
    free = np.concatenate([np.ones(len(stuck), dtype=bool), ~stuck])
    basis = np.eye(2 * len(stuck))
    if symmetry != Symmetry.SYNCHRONIZED:
        return basis[:, free]
    order = mirror_order(len(stuck))
    together = (basis + basis[order])[:, free & (order >= np.arange(2 * len(stuck)))]
    return together / np.linalg.norm(together, axis=0)


def symmetry_breaking_directions(stuck: np.ndarray) -> np.ndarray:
    """Return an orthonormal basis of symmetry-breaking changes as columns, without velocities of stuck blocks."""
    count = 2 * len(stuck)
    free = np.concatenate([np.ones(len(stuck), dtype=bool), ~stuck])
    order, basis = mirror_order(len(stuck)), np.eye(count)
    return (basis - basis[order])[:, free & (order > np.arange(count))] / np.sqrt(2.0)
