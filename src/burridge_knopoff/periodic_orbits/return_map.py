"""The return of a chain to where it was: after a time, and seen from the other end of the chain where that closes it.

An orbit that is its own mirror image after half its period is closed by the return after half a period composed with
the mirror image. The map of the whole period is the square of this one, and does not tell
apart what breaks the symmetry (a multiplier −1 of the half) from what keeps it (+1).

Reference: J. W. Swift and K. Wiesenfeld, "Suppression of period doubling in symmetric systems", Phys. Rev. Lett. 52
(1984) 705.
"""

from __future__ import annotations

from functools import cached_property

import numpy as np

from burridge_knopoff.model.model import ChainState, Model
from burridge_knopoff.periodic_orbits.flow import OrbitError, after, model_at, rate
from burridge_knopoff.periodic_orbits.symmetry import Symmetry
from burridge_knopoff.running.runner import Runner

# Step in a for the derivative of a return, which is good to about as much: enough for Newton's method and for tangents.
STEP = 1e-7
LEAST_STEP = 1e-13


class ReturnMap:
    """States of one model after a time, mirrored where the symmetry is that of a motion that is its own mirror image.

    symmetry : SYNCHRONIZED (mirror blocks move as one: no mirror needed), SYMMETRIC or ASYMMETRIC
    """

    def __init__(self, model: Model, symmetry: Symmetry) -> None:
        self.model = model
        self.symmetry = symmetry
        self._free = np.eye(2 * model.blocks)

    @cached_property
    def _runner(self) -> Runner:
        # To make one takes longer than most returns do.
        return Runner(self.model, keep_events=True, perturbations=self._free)

    def end(self, start: ChainState, time: float) -> ChainState:
        """Return the state that a state comes to; raises OrbitError if the run does not complete."""
        return self._mirrored(after(self._runner, start, time))

    def with_tangent(self, start: ChainState, time: float) -> tuple[ChainState, np.ndarray]:
        """Return the same and how perturbations of the start return, shape (2 blocks, 2 blocks).

        Velocities of stuck blocks have no perturbation: their columns are 0.
        """
        self._runner.carry(self._free * np.concatenate([np.ones(len(start.stuck)), ~start.stuck]))
        end = self.end(start, time)
        return end, self._mirrored_rows(self._runner.perturbations)

    def event_rows(self) -> np.ndarray:
        """Return time, block (0 …) and kind (0 stop, 1 start) of each event of the last return, not mirrored."""
        return np.stack(self._runner.events(), axis=1)

    def a_derivative(self, start: ChainState, time: float, end: ChainState, events: np.ndarray) -> np.ndarray:
        """Return how the end of a return changes with a, shape (2 blocks,).

        start, time, end : of the return; events : blocks and kinds of its events in their order, shape (n, 2)

        From a finite difference: next to a grazing, where the derivative jumps, on the side of the orbit. Raises
        OrbitError if there is none.
        """
        step = STEP
        while step > LEAST_STEP:
            for a in (self.model.a + step, self.model.a - step):
                try:
                    model = model_at(self.model, a)
                except OrbitError:
                    continue
                runner = Runner(model, keep_events=True)
                moved = self._mirrored(after(runner, start, time))
                if np.array_equal(np.stack(runner.events()[1:], axis=1), events):
                    return (moved.vector() - end.vector()) / (a - self.model.a)
            step *= 0.1
        raise OrbitError(f"a = {self.model.a!r}: stops and starts change however little a does")

    def time_derivative(self, end: ChainState) -> np.ndarray:
        """Return how the end changes with the time, shape (2 blocks,)."""
        return rate(self.model, end)

    def _mirrored(self, instant: ChainState) -> ChainState:
        return instant.mirrored() if self.symmetry == Symmetry.SYMMETRIC else instant

    def _mirrored_rows(self, matrix: np.ndarray) -> np.ndarray:
        return matrix[mirror(self.model.blocks)] if self.symmetry == Symmetry.SYMMETRIC else matrix


def mirror(blocks: int) -> np.ndarray:
    """Return the order of positions and velocities in a state seen from the other end of the chain."""
    order = np.arange(blocks)[::-1]
    return np.concatenate([order, blocks + order])


def directions(stuck: np.ndarray, symmetry: Symmetry) -> np.ndarray:
    """Return an orthonormal basis of the changes of a state as columns, shape (2 blocks, free).

    Velocities of stuck blocks do not change; if mirror blocks move as one, only what keeps them together does.
    """
    free = np.concatenate([np.ones(len(stuck), dtype=bool), ~stuck])
    basis = np.eye(2 * len(stuck))
    if symmetry != Symmetry.SYNCHRONIZED:
        return basis[:, free]
    order = mirror(len(stuck))
    together = (basis + basis[order])[:, free & (order >= np.arange(2 * len(stuck)))]
    return together / np.linalg.norm(together, axis=0)


def parting(stuck: np.ndarray) -> np.ndarray:
    """Return an orthonormal basis of the changes that part mirror blocks, as columns, those of stuck velocities not."""
    count = 2 * len(stuck)
    free = np.concatenate([np.ones(len(stuck), dtype=bool), ~stuck])
    order, basis = mirror(len(stuck)), np.eye(count)
    return (basis - basis[order])[:, free & (order > np.arange(count))] / np.sqrt(2.0)
