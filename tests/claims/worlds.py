"""Summaries of a world in which the paper is right in every word: what each claim's judge should call «holds»."""

from __future__ import annotations

import numpy as np
import xarray

from burridge_knopoff.claims.evidence import Evidence
from burridge_knopoff.model.initial import PAPER_STATES
from burridge_knopoff.stability.motion import CHAOTIC, PERIODIC, QUASIPERIODIC, SYNCHRONIZED
from burridge_knopoff.study.paper import PAPER_LAWS as LAWS
from tests.grids import PAPER_MODELS
from tests.sections import MOTION

# Fine where the paper's edges of synchrony are.
A = np.array(sorted([0.0, 0.0025, 0.0046, 0.084, *(round(0.005 * k, 3) for k in range(1, 61))]))
STATES = ("minus", "plus")
POINT = ("law", "initial", "a")
PAIR = ("other_law", "initial", "a")
SHAPE = (2, 2, len(A))
BLOCKS = np.array([1, 2, 3])
SYNCHRONY = (A >= 0.005) & (A <= 0.08)
CONFIG = {
    "v": 0.1,
    "contact": "one_sided",
    "start": "moving",
    "transient": 3000,
    "window": 7000,
    "motion": MOTION,
    **{key: PAPER_MODELS[key] for key in ("laws", "chain")},
    "initial": {
        name: {"position": list(state.position), "velocity": list(state.velocity)}
        for name, state in PAPER_STATES.items()
    },
}

Summaries = dict[str, xarray.Dataset]


def evidence(summaries: Summaries, **config: object) -> Evidence:
    """Return the summaries with the paper's setting, or another in part."""
    return Evidence(summaries, {**CONFIG, **config})


def paper_world() -> Summaries:
    """Return all summaries, made new at each call so that a test may spoil them."""
    world = {
        "mean_distance": _mean_distance(),
        "lyapunov": _lyapunov(),
        "bifurcation": _bifurcation(),
        "agreement": _agreement(),
        "attractors": _attractors(),
        "orbits": _orbits(),
        "stick_slip": _stick_slip(),
        "equilibrium": _equilibrium(),
        "solvers": _solvers(),
        "two_blocks": _two_blocks(),
    }
    for name, dataset in world.items():
        # No two numbers are the same, so that it shows where one is taken for another.
        for values in (dataset[key].values for key in dataset.data_vars if dataset[key].dtype == float):
            if name != "equilibrium":
                values *= np.linspace(1.0, 1.001, values.size).reshape(values.shape)
    return world


def _points(variables: dict, **coordinates: object) -> xarray.Dataset:
    return xarray.Dataset(
        {name: (dimensions, np.array(values)) for name, (dimensions, values) in variables.items()},
        {"law": list(LAWS), "initial": list(STATES), "a": A, **coordinates},
    )


def _by_state(minus: np.ndarray, plus: np.ndarray) -> np.ndarray:
    """Return values over (law, initial, a), the same for both laws."""
    return np.stack([np.stack([minus, plus])] * 2)


def _mean_distance() -> xarray.Dataset:
    mean = _by_state(np.where(SYNCHRONY, 0.0, 0.05), np.full(len(A), 0.14))
    return _points(
        {
            "mean_distance": (POINT, mean),
            "mean_distance_error": (POINT, np.full(SHAPE, 1e-4)),
            "synchronized": (POINT, (mean < 1e-6).astype("i1")),
            "least_friction": (POINT, np.full(SHAPE, 0.9)),
            "settling_time": ((*POINT, "level"), np.full((*SHAPE, 3), 3900.0)),
            "status": (POINT, np.zeros(SHAPE, "i1")),
        },
        level=[0.01, 0.001, 1e-6],
    )


def _lyapunov() -> xarray.Dataset:
    plus = np.where(A > 0.1, CHAOTIC, QUASIPERIODIC)
    minus = np.where((A > 0.0) & (A < 0.1), SYNCHRONIZED, plus)
    exponent = np.zeros((*SHAPE, 3))
    exponent[..., 0] = np.where(A > 0.1, 0.05, 1e-5)
    return _points(
        {
            "kind": (POINT, _by_state(minus, plus).astype("i1")),
            "section_period": (POINT, _by_state(np.where(A < 0.1, 1, 0), np.zeros(len(A))).astype("i2")),
            "lyapunov_exponent": ((*POINT, "exponent"), exponent),
            "lyapunov_error": ((*POINT, "exponent"), np.full((*SHAPE, 3), 1e-4)),
            "status": (POINT, np.zeros(SHAPE, "i1")),
        }
    )


def _bifurcation() -> xarray.Dataset:
    cloud = np.linspace(0.2, 0.4, 100)
    velocity, law, initial, a = [], [], [], []
    for i in range(2):
        for j in range(2):
            for value in A:
                velocity.append(cloud if j else np.full(100, 0.5))
                law.append(i)
                initial.append(j)
                a.append(value)
    return xarray.Dataset(
        {
            "crossing_velocity": ("crossing", np.concatenate(velocity)),
            "crossing_direction": ("crossing", np.ones(100 * len(a), "i1")),
            "crossing_count": ("point", np.full(len(a), 100, "i4")),
        },
        {
            "law": ("point", np.array(law, "i1"), {"flag_values": [0, 1], "flag_meanings": " ".join(LAWS)}),
            "initial": ("point", np.array(initial, "i2"), {"flag_values": [0, 1], "flag_meanings": " ".join(STATES)}),
            "a": ("point", np.array(a)),
        },
    )


def _agreement() -> xarray.Dataset:
    dataset = _points(
        {
            "agrees": (PAIR, np.ones((1, *SHAPE[1:]), "i1")),
            "difference": (PAIR, np.full((1, *SHAPE[1:]), 1e-5)),
            "parting_a": (PAIR[:2], np.full((1, 2), np.nan)),
        },
        other_law=["nonlinear"],
    )
    dataset.attrs["synchronization_threshold"] = 1e-6
    return dataset


def _attractors() -> xarray.Dataset:
    """Return three attractors at each a: synchrony, another one, which plus reaches, and a third.

    minus reaches the third where it does not synchronize, and the second beyond 0.1.
    """
    slots = ("law", "a", "attractor")
    shape = (2, len(A), 3)
    kind = np.empty(shape, "i1")
    kind[..., 0] = SYNCHRONIZED
    kind[..., 1] = np.where(A > 0.1, CHAOTIC, QUASIPERIODIC)
    kind[..., 2] = PERIODIC
    rate = np.full((*shape, 3), 0.17)
    rate[..., 1] = 0.34
    reached = np.zeros((2, 2, 2, 2, len(A)), "i2")
    reached[...] = np.stack([np.select([SYNCHRONY, A < 0.1], [0, 2], 1), np.ones(len(A))])
    conventions = ("law", "contact", "start", "initial", "a")
    return _points(
        {
            "branch": (slots, np.broadcast_to(np.array([0, 1, 2], "i2"), shape)),
            "side": (slots, np.zeros(shape, "i1")),
            "kind": (slots, kind),
            "mean_distance": (slots, np.broadcast_to([0.0, 0.14, 0.1], shape)),
            "basin_count": (slots, np.full(shape, 100, "i4")),
            "basin_fraction": (slots, np.full(shape, 0.5)),
            "stop_rate": ((*slots, "block"), rate),
            "initial_branch": (conventions, reached),
            "initial_side": (conventions, np.zeros_like(reached, dtype="i1")),
        },
        contact=["one_sided", "symmetric"],
        start=["moving", "tested"],
        block=BLOCKS,
    )


def _orbits() -> xarray.Dataset:
    return xarray.Dataset(
        {
            "critical_a": ("law", [0.0801, 0.0802]),
            "critical_a_error": ("law", [1e-9, 1e-9]),
            "transverse_multiplier": (("law", "a"), np.full((2, len(A)), 1.1)),
        },
        {"law": list(LAWS), "a": A},
    )


def _stick_slip() -> xarray.Dataset:
    block = (*POINT, "block")
    rate = np.full((*SHAPE, 3), 0.17)
    rate[..., 1] = 0.34
    return _points(
        {
            "stop_rate": (block, rate),
            "cycle_time": (block, np.full((*SHAPE, 3), 2.5)),
            "velocity_frequency": (block, rate),
            "velocity_frequency_error": (block, np.full((*SHAPE, 3), 0.01)),
            "velocity_correlation": (POINT, np.full(SHAPE, -0.9)),
        },
        block=BLOCKS,
    )


def _equilibrium() -> xarray.Dataset:
    slope = A
    eigenvalue = np.zeros((2, len(A), 6, 2))
    eigenvalue[..., 0] = slope[:, None]
    eigenvalue[..., 1] = [1.0, 1.0, 2.0, 2.0, 3.0, 3.0]
    position = -np.outer(1.0 - 0.1 * A, [5 / 6, 2 / 3, 5 / 6])
    return xarray.Dataset(
        {
            "equilibrium_position": (("law", "a", "block"), np.stack([position] * 2)),
            "equilibrium_drift": (("law", "a"), np.full((2, len(A)), 1e-15)),
            "eigenvalue": (("law", "a", "mode", "part"), eigenvalue),
            # Half the rate in the world as it is.
            "growth_rate": (("law", "a"), np.stack([slope] * 2)),
        },
        {"law": list(LAWS), "a": A, "block": BLOCKS, "part": ["real", "imaginary"]},
    )


def _solvers() -> xarray.Dataset:
    grid = [0.02, 0.05, 0.08]
    shape = (2, 3, 2, 3)
    axes = ("law", "solver", "initial", "a")
    steps = np.full(shape, 10_000)
    steps[:, 2] = 4_000_000
    difference = np.full(shape, 1e-7)
    # The map does not know the nonlinear law.
    steps[1, 0] = -1
    difference[1, 0] = np.nan
    return xarray.Dataset(
        {
            "mean_distance": (axes, np.full(shape, 0.14)),
            "difference": (axes, difference),
            "difference_error": (axes, np.full(shape, 1e-5)),
            "step_count": (axes, steps),
            "end_time": (axes, np.full(shape, 10_000.0)),
        },
        {"law": list(LAWS), "solver": ["map", "series", "rk4"], "initial": list(STATES), "a": grid},
    )


def _two_blocks() -> xarray.Dataset:
    grid = np.linspace(0.02, 0.4, 20).round(2)
    return xarray.Dataset(
        {"agrees": (("other_law", "state", "a"), np.ones((1, 4, 20), "i1"))}, {"other_law": ["nonlinear"], "a": grid}
    )
