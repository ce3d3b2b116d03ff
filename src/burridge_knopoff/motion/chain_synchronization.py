"""Synchronization of the mirror blocks of a chain, from random initial states and from perturbed symmetric motion.

Blocks i and j = N + 1 − i are mirror blocks. The distance of a pair is J_i = sqrt((U_i' − U_j')² + (U_i − U_j)²), which
is the paper's J for the end blocks; the mirror distance is the largest of these distances. For odd N the middle block
belongs to no pair. The chain must be its own mirror image. `summaries.chains` writes the results to files, and
`figures.chains` draws them.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from enum import IntEnum
from typing import Any

import numpy as np

from burridge_knopoff.model.chain import Chain
from burridge_knopoff.model.initial import InitialState
from burridge_knopoff.model.model import ChainState, Model, at_recorded_a
from burridge_knopoff.model.ranges import Number
from burridge_knopoff.motion.chain_settings import SAMPLE, WATCH, Sample, Watch
from burridge_knopoff.motion.mirror import pair_distances, symmetrized
from burridge_knopoff.periodic_orbits.flow import OrbitError
from burridge_knopoff.running.derivative import missing_derivative
from burridge_knopoff.running.runner import Runner, check_state
from burridge_knopoff.running.settings import DURATION, LONGEST, Settings
from burridge_knopoff.running.simulation import run
from burridge_knopoff.running.status import Status
from burridge_knopoff.values import instance_of


class Outcome(IntEnum):
    """Whether the mirror blocks of a chain have synchronized, numbered as in netCDF files."""

    UNDETERMINED = -1
    NOT_SYNCHRONIZED = 0
    SYNCHRONIZED = 1


# Time between two checks of the distances; not a multiple of the period of the synchronized motion, about 5.6.
INTERVAL = 20.0

# The distance still falls if its maximum over a quarter of the run, divided by that over the quarter before, is below
# this.
DECREASE = 0.5

# Motion closer than this to symmetric motion, for v = 0.1, is judged by the transverse exponent of the symmetric
# motion.
NEAR_SYMMETRY = 0.01
STANDARD_ERRORS = 3.0

# Longest time after which the motion is made symmetric again and its perturbation rescaled to length 1. This time and
# those below are in the chain's own unit.
RENEWAL = 10.0

# Time in which a perturbation aligns with the direction of fastest growth, if the motion itself has settled.
ALIGNMENT = 200.0
BATCHES = 5

# A batch lasts at least RENEWAL, about two periods of the synchronized motion: shorter batches underestimate the error.
SHORTEST_WINDOW = BATCHES * RENEWAL


@dataclass(frozen=True)
class Fate:
    """The fate of a state.

    outcome : synchronized if the mirror distance reached the synchronization distance and the transverse exponent of
        the motion there is negative. Undetermined if this exponent is not negative; if at the time limit the distance
        still falls, or is small while the transverse exponent is not positive beyond its error; or if the run failed.
        Otherwise not synchronized
    time : first of the checks, 20 apart, at which the synchronization distance was reached, NaN if it was not
    distance, mean_distance : largest and mean mirror distance at the checks in the last quarter of the time limit, or
        the distance at `time`
    pairs : number of pairs below the synchronization threshold at the checks in the last quarter; all pairs if
        synchronized
    transverse_exponent : exponent of the symmetric motion that was reached or approached
    """

    outcome: Outcome
    time: float = math.nan
    distance: float = math.nan
    mean_distance: float = math.nan
    pairs: int = 0
    transverse_exponent: float = math.nan


def window_range(chain: Chain) -> Number:
    """Return the range of windows for which the transverse exponent of a chain has an error."""
    return Number(SHORTEST_WINDOW * chain.own_units.time, LONGEST)


def watch_state(runner: Runner, start: ChainState, watch: Watch = WATCH) -> Fate:
    """Watch a state until it has synchronized or the time limit is reached.

    runner : `Runner(model)`, which can be used for many states

    Raises ValueError if the chain is not its own mirror image.
    """
    model = runner.model
    _check_mirror(model)
    runner.begin(start, 0.0)
    history: list[np.ndarray] = []
    for check in range(1, int(watch.time_limit / INTERVAL) + 1):
        if runner.run(check * INTERVAL) != Status.COMPLETED:
            return Fate(Outcome.UNDETERMINED)
        state = runner.state()
        distances = pair_distances(state)
        history.append(distances)
        nearest = float(distances.max())
        if nearest <= watch.synchronization_distance:
            exponent, _ = _exponent(model, state, *_times(model, watch))
            outcome = Outcome.SYNCHRONIZED if exponent < 0.0 else Outcome.UNDETERMINED
            return Fate(outcome, check * INTERVAL, nearest, nearest, len(distances), exponent)
    quarter = len(history) // 4
    last, before = np.array(history[-quarter:]), np.array(history[-2 * quarter : -quarter])
    undetermined = last.max() < DECREASE * before.max()
    exponent = math.nan
    if last.max() < NEAR_SYMMETRY * model.scale:
        exponent, error = _exponent(model, runner.state(), *_times(model, watch))
        undetermined |= not exponent > STANDARD_ERRORS * error
    return Fate(
        Outcome.UNDETERMINED if undetermined else Outcome.NOT_SYNCHRONIZED,
        distance=float(last.max()),
        mean_distance=float(last.max(axis=1).mean()),
        pairs=int(np.count_nonzero(last.max(axis=0) < watch.synchronization_threshold * min(1.0, model.scale))),
        transverse_exponent=exponent,
    )


def transverse_exponent(
    model: Model, state: ChainState, alignment: float | None = None, window: float | None = None
) -> tuple[float, float]:
    """Return the largest transverse Lyapunov exponent of the mirror-symmetric motion from a state, and its error.

    The state is made symmetric, and an antisymmetric perturbation is propagated exactly (see `kernel/tangent.h`). The
    exponent is its mean growth rate over the window, which begins after the alignment time. If it is negative, mirror
    blocks that are close to each other synchronize. It is NaN if the run fails, and −∞ if the perturbation vanishes.
    Raises ValueError if the chain is not its own mirror image and for times that are not allowed. Raises OrbitError, a
    ValueError, where perturbations have no linear growth (see `multipliers`).

    The error combines the standard error of BATCHES equal batches and the effect of the phases at which the window
    begins and ends. If a batch lasts about a whole number of periods, this effect is the same in all batches and does
    not contribute to their scatter.

    model, state : any state of a motion, such as that of `Model.begin` or `PeriodicOrbit.reference`
    alignment, window : times in units of 1/ω, as the exponent is in units of ω; by default 200 and 2500, multiplied by
        the time unit of the chain (`Chain.own_units`), and the window is at least 50 of these units

    >>> from burridge_knopoff import InitialState, Model, transverse_exponent
    >>> model = Model("linearized", a=0.08)
    >>> state = model.begin(InitialState("own", (-0.9, -1.1, -0.9), (0.1, 0.1, 0.1)))
    >>> exponent, error = transverse_exponent(model, state, alignment=500.0, window=2000.0)
    >>> round(exponent, 3), error < 1e-3
    (-0.007, True)
    """
    instance_of(model, Model, "model")
    _check_mirror(model)
    blocks, unit = model.blocks, model.chain.own_units.time
    alignment = ALIGNMENT * unit if alignment is None else DURATION.form(alignment, "alignment")
    window = WATCH.quarter * unit if window is None else window_range(model.chain).form(window, "window")
    scale = model.chain.own_units.state(blocks)[:, None]
    check_state(model, state)
    index = np.arange(2 * blocks)
    # A direction without special symmetry, except antisymmetry.
    perturbation = _antisymmetric(np.cos(1.0 + 2.3 * index)[:, None])
    runner = Runner(model, perturbations=perturbation * scale)
    renewal = RENEWAL * unit
    before, steps = math.ceil(alignment / renewal), BATCHES * math.ceil(window / BATCHES / renewal)
    growth = np.zeros(steps)
    state = symmetrized(state)
    for step in range(-before, steps):
        perturbation[blocks:, 0] *= ~state.stuck
        length = math.sqrt(math.fsum(perturbation[:, 0] ** 2))
        if length == 0.0:
            return -math.inf, math.nan
        perturbation /= length
        runner.carry(perturbation * scale)
        after = runner.state_after(state, alignment / before if step < 0 else window / steps)
        if after is None:
            return math.nan, math.nan
        # Rounding errors grow if the symmetric motion is unstable; they are removed before they matter.
        if reason := missing_derivative(runner, mirror_symmetric=True):
            raise OrbitError(f"state: {reason}, expected a state from which perturbations grow linearly")
        state = symmetrized(after)
        perturbation = _antisymmetric(runner.perturbations / scale)
        if step >= 0:
            growth[step] = 0.5 * math.log(max(math.fsum(perturbation[:, 0] ** 2), 1e-300))
    rate = growth.reshape(BATCHES, -1).sum(axis=1) / (window / BATCHES)
    # The deviation of the growth from its trend depends on the phase; the window has the deviations at both ends.
    by_phase = np.cumsum(growth - growth.mean()).std() * math.sqrt(2.0) / window
    return float(rate.mean()), math.hypot(rate.std(ddof=1) / math.sqrt(BATCHES), by_phase)


def _exponent(model: Model, state: ChainState, alignment: float, window: float) -> tuple[float, float]:
    """Return `transverse_exponent`, and NaN where perturbations have no linear growth."""
    try:
        return transverse_exponent(model, state, alignment, window)
    except OrbitError:
        return math.nan, math.nan


def watch_chain(
    models: Sequence[Model], grid: Sequence[float], sample: Sample = SAMPLE, watch: Watch = WATCH
) -> dict[str, np.ndarray]:
    """Watch all states of a sample under each law at each a of a grid.

    models : one for each law, at any a, all with the same number of blocks
    sample : independent at each a, the same for all laws, so that the laws are compared from the same states and errors
        at neighbouring values of a are uncorrelated

    Returns arrays. Shape (models, grid, states): the fields of `Fate`. Shape (models, grid, symmetric samples):
    `symmetric_exponent`, the largest transverse exponent of symmetric motion over the second quarter of the time limit,
    and `symmetric_error`. Shape (models, grid): `lyapunov_exponent`, the largest Lyapunov exponent of the first state
    over the second half of the time limit, and `lyapunov_error`. Raises ValueError if the chain is not its own mirror
    image.
    """
    shape = (len(models), len(grid))
    results: dict[str, np.ndarray] = {
        **{name: np.full((*shape, sample.samples), np.nan) for name in Fate.__dataclass_fields__},
        **{f"symmetric_{name}": np.full((*shape, sample.symmetric_samples), np.nan) for name in ("exponent", "error")},
        **{f"lyapunov_{name}": np.full(shape, np.nan) for name in ("exponent", "error")},
    }
    for i, law_model in enumerate(models):
        for j, a in enumerate(grid):
            model, initial = at_recorded_a(law_model, a), sample.initial_states(law_model.blocks, a)
            runner = Runner(model)
            for k, state in enumerate(initial):
                fate = watch_state(runner, model.begin(state, sample.start), watch)
                for name in Fate.__dataclass_fields__:
                    results[name][i, j, k] = getattr(fate, name)
            for k, state in enumerate(initial[: sample.symmetric_samples]):
                results["symmetric_exponent"][i, j, k], results["symmetric_error"][i, j, k] = _exponent(
                    model, model.begin(state, sample.start), watch.quarter, _times(model, watch)[1]
                )
            results["lyapunov_exponent"][i, j], results["lyapunov_error"][i, j] = _lyapunov_exponent(
                model, initial[0], sample.start, watch
            )
    return results


def _lyapunov_exponent(model: Model, initial: InitialState, start: str, watch: Watch) -> tuple[float, float]:
    half = 0.5 * watch.time_limit
    options: dict[str, Any] = {"transient": half, "window": half, "batches": BATCHES, "events": "none"}
    output: dict[str, Any] = {"sampling": half, "trajectory": 0.0}
    settings = Settings(start=start, lyapunov_exponents=1, **options, **output)
    trajectory = run(model, initial, settings, section_only=True)
    return float(trajectory.lyapunov_exponent[0]), float(trajectory.lyapunov_error[0])


def _times(model: Model, watch: Watch) -> tuple[float, float]:
    """Return the alignment time, and a quarter of the time limit or the shortest window that gives an error."""
    unit = model.chain.own_units.time
    return ALIGNMENT * unit, max(watch.quarter, SHORTEST_WINDOW * unit)


def _check_mirror(model: Model) -> None:
    if not model.chain.is_mirror_symmetric:
        raise ValueError("chain: expected a chain that is its own mirror image: only such a chain has mirror blocks")


def _antisymmetric(perturbation: np.ndarray) -> np.ndarray:
    """Return the part of a perturbation, shape (2 blocks, 1), that changes its sign under reflection."""
    tables = perturbation.reshape(2, -1)
    return (0.5 * (tables - tables[:, ::-1])).reshape(-1, 1)
