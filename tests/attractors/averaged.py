"""Amplitudes of the modes of the sliding chain at small a: averaged equations, and simulations.

`python -m tests.attractors.averaged 1000` compares them from as many random states (docs/attractors.md).
"""

from __future__ import annotations

import math
import sys
from itertools import combinations

import numpy as np
from scipy.optimize import nnls

from burridge_knopoff import Chain, Model
from burridge_knopoff.model.model import ChainState
from burridge_knopoff.model.sampling import fraction_interval
from burridge_knopoff.running.runner import Runner

V = 0.1
#: U_2/U_1 of the fast symmetric mode is −(1 + √3), its frequency √(3 + √3).
FAST = 1.0 + np.sqrt(3.0)
#: Columns are the slow symmetric, the antisymmetric and the fast symmetric mode, with 1 at block 1; their frequencies.
SQUARE, SHAPE = np.linalg.eigh(Chain(3).stiffness)
SHAPE = SHAPE / SHAPE[0]
FREQUENCY, WEIGHT = np.sqrt(SQUARE), (SHAPE**2).sum(axis=0)
# No block sticks where FACES A ≤ EDGE, in units of v: end blocks, middle block, and A ≥ 0.
FACES, EDGE = np.concatenate([np.abs(SHAPE[:2]), -np.eye(3)]), np.array([1.0, 1.0, 0.0, 0.0, 0.0])
SYNCHRONY, BRANCH_2 = np.array([1.0, 0.0, 0.0]), np.array([0.0, 1.0, 0.0])
BRANCH_1 = np.array([0.0, 1.0 - 1.0 / FAST, 1.0 / FAST])
ATTRACTORS = np.array([SYNCHRONY, BRANCH_2, BRANCH_1])

# Random states are compared at this a and these times: until nearly all have arrived.
A = 0.001
TIMES = np.arange(250.0, 12001.0, 250.0)


def vertices() -> dict[tuple[int, ...], np.ndarray]:
    """Return the vertices of the polyhedron of amplitudes, by the three faces on which each lies."""
    corners = {}
    for faces in combinations(range(5), 3):
        rows = FACES[list(faces)]
        if abs(np.linalg.det(rows)) > 1e-9:
            vertex = np.linalg.solve(rows, EDGE[list(faces)])
            if (FACES @ vertex <= EDGE + 1e-9).all():
                corners[faces] = vertex
    return corners


def averaged_amplitudes(amplitude: np.ndarray, a: float, times: np.ndarray) -> np.ndarray:
    """Return amplitudes of the averaged equations at some times, by steps of up to 2 that are projected back."""
    amplitudes, clock = [], 0.0
    for time in times:
        steps = math.ceil((time - clock) / 2.0)
        step = (time - clock) / steps
        for _ in range(steps):
            rate = 0.5 * a * amplitude
            active = FACES[:2][FACES[:2] @ amplitude >= 1.0 - 1e-12]
            if len(active):
                push = active / WEIGHT
                rate = rate - nnls((push * np.sqrt(WEIGHT)).T, rate * np.sqrt(WEIGHT))[0] @ push
            amplitude = np.maximum(amplitude + step * rate, 0.0)
            amplitude = amplitude / max(1.0, float((FACES[:2] @ amplitude).max()))
        clock = time
        amplitudes.append(amplitude)
    return np.array(amplitudes)


def simulated_amplitudes(amplitude: np.ndarray, a: float, times: np.ndarray) -> np.ndarray:
    """Return amplitudes of a simulation, means over the 40 time units before each time."""
    phase = np.random.default_rng(0).uniform(0.0, 2.0 * np.pi, 3)
    position, velocity = SHAPE @ (V * amplitude / FREQUENCY * np.sin(phase)), SHAPE @ (V * amplitude * np.cos(phase))
    runner = Runner(Model("linearized", a=a, v=V))
    runner.begin(ChainState(position, V + velocity, np.zeros(3, dtype=bool)))
    amplitudes = []
    for time in times:
        rows = []
        for at in time - 40.0 + np.arange(40.0):
            runner.run(at)
            state = runner.state()
            rows.append(
                np.hypot(FREQUENCY * np.linalg.solve(SHAPE, state.position), np.linalg.solve(SHAPE, state.velocity - V))
            )
        amplitudes.append(np.mean(rows, axis=0) / V)
    return np.array(amplitudes)


def random_amplitudes(rng: np.random.Generator) -> np.ndarray:
    """Return amplitudes of a state without sticks, uniform in the polyhedron."""
    while True:
        amplitude = rng.uniform(0.0, [1.0, 1.0, 1.0 / FAST])
        if (FACES @ amplitude <= EDGE).all():
            return amplitude


def compare_random_state(seed: int) -> tuple[float, bool]:
    """Return the largest difference of an amplitude at TIMES, in units of v, and whether both reach the same vertex."""
    start = random_amplitudes(np.random.default_rng(seed))
    both = [of(start, A, TIMES) for of in (averaged_amplitudes, simulated_amplitudes)]
    first, second = (np.abs(ATTRACTORS - amplitudes[-1]).max(axis=1).argmin() for amplitudes in both)
    return float(np.abs(both[1] - both[0]).max()), bool(first == second)


def main(count: int) -> None:
    """Print how many random states follow the averaged equations, with 95 % Wilson intervals."""
    differences, same = zip(*map(compare_random_state, range(count)), strict=True)
    print(
        f"largest difference of an amplitude: median {np.median(differences):.3f} v, largest {max(differences):.2f} v"
    )
    below = {f"difference below {limit:g} v": int(np.sum(np.less(differences, limit))) for limit in (0.1, 0.2)}
    for words, hits in {**below, "the same vertex": sum(same)}.items():
        fraction, low, high = fraction_interval(hits, count)
        print(f"{words}: {hits} of {count}, {100 * fraction:.1f} % ({100 * low:.1f} to {100 * high:.1f} %)")


if __name__ == "__main__":
    main(int(sys.argv[1]))
